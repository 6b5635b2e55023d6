"""Laws of light in n-space that no formula of this package is needed to state."""

import math

import numpy as np
import pytest
from lamps import shiny
from refusals import refusals
from scipy.stats import special_ortho_group

from vizlight import Light, Material, Scene, View, engine
from vizlight.model import brightness

#: Gauss nodes from 0 to a right angle, close together at both ends, where powers have kinks.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(500)
NODES = np.pi / 4 * (NODES + 1)
NODES, WEIGHTS = np.pi / 2 * np.sin(NODES) ** 2, WEIGHTS * np.sin(2 * NODES)

MATTE = Material(ambient=0.0, diffuse=1.0, specular=0.0)
PAIRS = [(1, 2), (1, 3), (2, 3), (1, 4), (2, 4), (3, 4), (2, 5), (3, 6), (4, 8), (7, 8), (5, 12)]


def scene_of(random, n, turn, **options):
    """Return lights near and far and an eye, all turned."""
    near, far, eye, back = 5 * random.standard_normal((4, n))
    return Scene(
        lights=[Light(position=turn @ near, attenuation=(1, 0.1, 0)), Light(direction=turn @ far)],
        view=View(position=turn @ eye) if options.get("near") else View(direction=turn @ back),
        material=Material(ambient=0.1, diffuse=0.6, specular=0.7, shininess=15),
    )


@pytest.mark.parametrize("model", ["phong", "blinn"])
@pytest.mark.parametrize(("k", "n"), PAIRS)
def test_turning_object_light_and_eye_changes_nothing(k, n, model):
    turn = (
        special_ortho_group.rvs(n, random_state=n) if n > 2 else np.array([[0.6, -0.8], [0.8, 0.6]])
    )
    for near in (True, False):
        light = []
        for matrix in (np.eye(n), turn):
            random = np.random.default_rng(k)
            points, tangents = random.standard_normal((300, n)), random.standard_normal((300, k, n))
            scene = scene_of(random, n, matrix, near=near)
            light.append(
                engine.shade(points @ matrix.T, tangents @ matrix.T, scene, model=model).luminance
            )
        assert np.ptp(light[0]) > 0.1
        # Rounding alone is left; where points are must not matter beyond it.
        assert np.abs(light[1] - light[0]).max() < 1e-12


@pytest.mark.parametrize("n", range(2, 13))
def test_the_exponent_gives_a_mean_of_one_half(n):
    """Quadrature and uniform directions, each for all k < n up to 12."""
    count = 100_000
    x = np.random.default_rng(n).standard_normal((count, n)) ** 2
    for k in range(1, n):
        p = brightness.exponent(k, n)
        sine = np.sqrt(x[:, k:].sum(axis=1) / x.sum(axis=1)) ** p
        assert abs(sine.mean() - 0.5) < 5 * sine.std() / math.sqrt(count)
        # The angle a is spread as sin^(c-1) cos^(k-1) where directions are uniform.
        density = WEIGHTS * np.sin(NODES) ** (n - k - 1) * np.cos(NODES) ** (k - 1)
        mean = np.sum(density * np.sin(NODES) ** p) / np.sum(density)
        assert mean == pytest.approx(0.5, abs=1e-9)


def test_a_plan_tells_the_brightness_of_what_carries_a_field():
    scene = Scene(lights=Light(direction=(1, 2, 0.5, -1)), material=MATTE)
    carrier = np.eye(4)[None, :2]
    found = engine.shade(np.zeros((1, 4)), carrier[:, 0], scene, base_tangents=carrier)
    assert "base tangents: brightness |wi_N| to the power 2" in found.plan.explain()


FIVE = np.ones((5, 4))
test_bad_carriers = refusals(
    lambda tangents, carrier, normals: engine.shade(
        FIVE, tangents, Scene(lights=Light(direction=(1, 0, 0, 0)), material=MATTE),
        base_tangents=np.ones(carrier), normals=normals,
    ),
    (None, (5, 8), FIVE, "base_tangents: expected tangents"),
    (FIVE, (5, 8), FIVE, "base_tangents: expected tangents .* no normals"),
    (np.ones((5, 8)), (5, 4), None, "base_tangents: expected from k = 2"),
    (FIVE, (5, 16), None, "base_tangents: expected shape"),
    (FIVE, (5, 7), None, "base_tangents: expected shape"),
    (FIVE, (4, 8), None, "base_tangents: expected shape"),
)  # fmt: skip


def test_dependent_tangents_of_a_carrier_are_marked(random):
    carrier = random.standard_normal((4, 2, 4))
    carrier[1, 1] = 3 * carrier[1, 0]
    carrier[2] = np.nan
    scene = Scene(lights=Light(direction=(1, 2, 0.5, -1)), material=shiny(specular=0))
    lit = engine.shade(np.zeros((4, 4)), carrier[[0, 0, 0, 0], 0], scene, base_tangents=carrier)
    np.testing.assert_array_equal(lit.valid, [True, False, False, True])
    np.testing.assert_array_equal(lit.luminance[1:3], 0.1)
