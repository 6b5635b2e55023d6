"""What made an array is kept with it, through files, and makes it again."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View
from vizlight.geometry import manifolds

SCENE = Scene(
    lights=[Light(position=(1, 2, 9), color="red"), Light.headlight(intensity=0.5)],
    material=Material(color="wheat", shininess=12.5),
    view=View(position=(0, 0, 20)),
)


def lit_mesh():
    mesh = pv.Sphere()
    mesh["V"] = np.cross(mesh["Normals"], np.float32([0.3, 0.1, 1]))
    return vizlight.illuminate(mesh, SCENE, tangents="V", conditioned=True, components=True)


@pytest.mark.parametrize("suffix", [".vtp", ".vtk", ".vtu"])
def test_a_saved_file_can_be_reproduced(suffix, tmp_path):
    lit = lit_mesh()
    saved = lit.cast_to_unstructured_grid() if suffix == ".vtu" else lit
    saved.save(tmp_path / f"lit{suffix}")
    read = pv.read(tmp_path / f"lit{suffix}")
    told = vizlight.provenance(read)
    assert told["vizlight"] == vizlight.__version__
    assert told["terms"] == ["ambient", "diffuse", "specular"]
    assert (told["points"], told["invalid"], told["precision"]) == (lit.n_points, 0, "float32")
    again = vizlight.illuminate(read, Scene.from_dict(told["scene"]), **told["options"])
    np.testing.assert_array_equal(again["luminance"], lit["luminance"])
    np.testing.assert_array_equal(again["rgb"], lit["rgb"])


def test_each_array_has_its_own():
    mesh = vizlight.illuminate(lit_mesh(), SCENE, name="plain")
    assert vizlight.provenance(mesh)["options"]["tangents"] == "V"
    assert vizlight.provenance(mesh, "plain")["options"]["tangents"] is None


def test_an_array_given_as_such_is_described():
    mesh = pv.Sphere()
    lit = vizlight.illuminate(mesh, SCENE, tangents=np.ones((mesh.n_points, 3)))
    told = vizlight.provenance(lit)["options"]["tangents"]
    assert told == f"an array of shape ({mesh.n_points}, 3) and type float64"


def test_blocks_tell_too():
    blocks = vizlight.illuminate(pv.MultiBlock([None, pv.Sphere()]), SCENE)
    assert vizlight.provenance(blocks)["points"] == 842
    with pytest.raises(TypeError, match="mesh: expected a PyVista mesh, got NoneType"):
        vizlight.provenance(None)


def test_unknown_name():
    with pytest.raises(ValueError, match=r"name: expected one of .*\['luminance'\], got 'other'"):
        vizlight.provenance(lit_mesh(), "other")


def test_lighting_again_keeps_the_users_own_arrays():
    mesh = pv.Sphere()
    mesh["rgb"] = np.full((mesh.n_points, 3), 7)
    mesh["diffuse"] = np.arange(mesh.n_points)
    for _ in range(2):
        vizlight.illuminate(mesh, Scene(view=View(direction=(0, 0, 1))), inplace=True)
    np.testing.assert_array_equal(mesh["rgb"], 7)
    np.testing.assert_array_equal(mesh["diffuse"], np.arange(mesh.n_points))
    with pytest.raises(ValueError, match=r"name: expected one .* got 'rgb'"):
        vizlight.illuminate(mesh, SCENE)


def test_lighting_again_leaves_nothing_stale():
    lit = vizlight.illuminate(lit_mesh(), Scene(view=View(direction=(0, 0, 1))))
    assert {"luminance", "V"} <= set(lit.point_data)
    assert not {"rgb", "diffuse", "specular", "ambient"} & set(lit.point_data)


def test_the_users_own_mark_of_what_is_valid_is_not_replaced():
    mesh = pv.Sphere()
    mesh["luminance_valid"] = np.arange(mesh.n_points)
    with pytest.raises(ValueError, match="got 'luminance_valid'"):
        vizlight.illuminate(mesh, SCENE)


def test_several_turns_make_the_light_again():
    torus = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=8))
    scene = Scene(
        lights=Light(direction=(0.7, 0.6, 0.4, 0.2)), view=View(direction=(0, -1, 0.5, 0))
    )
    lit = vizlight.project(torus, rotation=[("xw", 0.5), ("yz", 0.3)], scene=scene)
    told = vizlight.provenance(lit)
    again = vizlight.project(torus, scene=Scene.from_dict(told["scene"]), **told["options"])
    np.testing.assert_array_equal(again["luminance"], lit["luminance"])


def test_numbers_of_any_type_are_written_as_numbers():
    mesh = pv.PolyData(np.eye(3))
    given = np.eye(3, dtype=np.longdouble)
    lit = vizlight.illuminate(mesh, SCENE, tangents=given, tolerance=Fraction(1, 256))
    told = vizlight.provenance(lit)["options"]
    assert told["tolerance"] == 1 / 256
    np.testing.assert_array_equal(told["tangents"], np.eye(3))
