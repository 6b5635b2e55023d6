"""``mesh.vizlight`` is there without an import, on every kind of mesh."""

from __future__ import annotations

import inspect
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Scene, View

SCENE = Scene(lights=Light(direction=(0, 0, 1)), view=View(direction=(0, 0, 1)))


def test_accessor_lights_as_the_function_does():
    mesh = pv.Sphere()
    lit = mesh.vizlight.illuminate(SCENE, name="x")
    np.testing.assert_array_equal(lit["x"], vizlight.illuminate(mesh, SCENE, name="x")["x"])
    assert lit.vizlight.provenance("x") == vizlight.provenance(lit, "x")


def test_accessor_has_the_signatures_and_words_of_the_functions():
    names = ("illuminate", "isoluminance", "project", "provenance", "satin", "streamlines")
    for name in names:
        method, function = getattr(pv.Sphere().vizlight, name), getattr(vizlight, name)
        assert method.__doc__ == function.__doc__
        expected = list(inspect.signature(function).parameters)[1:]
        assert list(inspect.signature(method).parameters) == expected


def test_warnings_point_at_the_caller():
    mesh = pv.Sphere()
    mesh["V"] = np.zeros((mesh.n_points, 3))
    with pytest.warns(UserWarning, match="could not be lit") as caught:
        mesh.vizlight.illuminate(SCENE, tangents="V")
    assert caught[0].filename == __file__


@pytest.mark.parametrize(
    "name", ["fur", "illuminate", "isoluminance", "refine", "satin", "streamlines"]
)
def test_without_a_scene_it_is_said_how_to_make_one(name):
    """A highlight needs an eye, so only what draws a picture has a default."""
    mesh = pv.Sphere()
    remedy = r"scene: expected a vizlight\.Scene, got None; pass Scene\(view=.*mesh\.vizlight\.plot"
    for call in (getattr(mesh.vizlight, name), lambda: getattr(vizlight, name)(mesh, scene=None)):
        with pytest.raises(TypeError, match=remedy):
            call()


def test_accessor_on_blocks():
    blocks = pv.MultiBlock([pv.Sphere(), pv.Cube()])
    lit = blocks.vizlight.illuminate(SCENE)
    assert all("luminance" in block.point_data for block in lit)


def test_accessor_tells_what_it_can():
    assert repr(pv.Sphere().vizlight).startswith(
        "vizlight of PolyData: bas_relief, fur, illuminate"
    )


def test_accessor_needs_no_import():
    code = "import pyvista as pv; print(type(pv.Sphere().vizlight).__name__)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "Accessor"
