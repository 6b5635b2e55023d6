"""The plain script against one point at a time in 50 digits: it must be a reference."""

import numpy as np
import oracles
import pytest

from studies import _script as reference
from vizlight import Light, Scene, View

SCENE = Scene(
    lights=[Light(position=(1, 4, 2)), Light(direction=(0, 1, 1), intensity=0.5)],
    view=View(position=(0, 1, 6)),
)


@pytest.mark.parametrize("what", ["line", "surface", "conditioned"])
def test_script(what, random):
    points, tangents, normals = random.standard_normal((3, 30, 3))
    exponent = 1.0 if what == "surface" else 4.7635
    tangent = None if what == "surface" else tangents
    normal = None if what == "line" else normals
    found = reference.light(points, tangent, SCENE, normals=normal, exponent=exponent)
    for i in range(30):
        true = oracles.shade(
            points[i],
            None if tangent is None else tangent[i : i + 1],
            None if normal is None else normal[i],
            SCENE,
            exponent=exponent,
        )[3]
        assert abs(found[i] - float(true)) < 1e-13


def test_a_headlight_is_taken_from_the_view(random):
    points, tangents = random.standard_normal((2, 10, 3))
    fixed = Scene(lights=Light(position=(0, 1, 6)), view=SCENE.view)
    found = reference.light(points, tangents, Scene(view=SCENE.view))
    np.testing.assert_array_equal(found, reference.light(points, tangents, fixed))


def test_parallel_view_and_single_precision(random):
    points, tangents = random.standard_normal((2, 30, 3))
    scene = SCENE.replace(view=View(position=(0, 0, 1), direction=(0, 1, 1), parallel=True))
    high = reference.light(points, tangents, scene)
    low = reference.light(points, tangents, scene, dtype=np.float32)
    assert low.dtype == np.float32
    np.testing.assert_allclose(low, high, atol=1e-5)
