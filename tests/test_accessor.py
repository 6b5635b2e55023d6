"""``mesh.vizlight`` is there without an import, on every kind of mesh."""

import inspect
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Scene, View
from vizlight.filters.fur import MATERIAL

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
    ("name", "options"),
    [
        ("fur", {"density": 0.02, "fibres": 5}),
        ("illuminate", {}),
        ("isoluminance", {"levels": 3}),
        ("refine", {"max_points": 1000}),
        ("satin", {"tangents": "V", "seeds": 2}),
        ("streamlines", {"tangents": "V", "seeds": 2}),
    ],
)
def test_without_a_scene_there_is_the_default_one(name, options):
    mesh = pv.Sphere()
    mesh["V"] = np.cross(mesh.points, (0, 0, 1.0)) + 1e-3
    found = getattr(mesh.vizlight, name)(**options)
    default = Scene(material=MATERIAL) if name == "fur" else Scene()
    expected = getattr(vizlight, name)(mesh, default, **options)
    for one, other in zip(*map(blocks_of, (found, expected)), strict=True):
        np.testing.assert_array_equal(one.active_scalars, other.active_scalars)


def blocks_of(mesh):
    return list(mesh.recursive_iterator()) if isinstance(mesh, pv.MultiBlock) else [mesh]


def test_accessor_on_blocks():
    blocks = pv.MultiBlock([pv.Sphere(), pv.Plane()])
    lit = blocks.vizlight.illuminate(SCENE)
    assert all("luminance" in block.point_data for block in lit)


def test_accessor_tells_what_it_can():
    kind, _, names = repr(pv.Sphere().vizlight).partition(": ")
    assert kind == "vizlight of PolyData"
    assert {"fur", "illuminate", "plot"} < set(names.split(", "))


def test_accessor_needs_no_import():
    code = "import pyvista as pv; print(type(pv.Sphere().vizlight).__name__)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "Accessor"
