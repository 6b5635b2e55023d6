"""What made an array is kept with it, through files, and makes it again."""

import json
from fractions import Fraction

import numpy as np
import pytest
import pyvista as pv
from lamps import HEADLIT, SHINY, shiny

import vizlight
from vizlight import Light, Scene, View

SCENE = Scene(
    lights=[Light(position=(1, 2, 9), color="red"), Light.headlight(intensity=0.5)],
    material=shiny(color="wheat", shininess=12.5),
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
        vizlight.illuminate(mesh, Scene(**HEADLIT, view=View(direction=(0, 0, 1))), inplace=True)
    np.testing.assert_array_equal(mesh["rgb"], 7)
    np.testing.assert_array_equal(mesh["diffuse"], np.arange(mesh.n_points))
    with pytest.raises(ValueError, match=r"name: expected one .* got 'rgb'"):
        vizlight.illuminate(mesh, SCENE)


def test_lighting_again_leaves_nothing_stale():
    lit = vizlight.illuminate(lit_mesh(), Scene(**HEADLIT, view=View(direction=(0, 0, 1))))
    assert {"luminance", "V"} <= set(lit.point_data)
    assert not {"rgb", "diffuse", "specular", "ambient"} & set(lit.point_data)


def test_the_users_own_mark_of_what_is_valid_is_not_replaced():
    mesh = pv.Sphere()
    mesh["luminance_valid"] = np.arange(mesh.n_points)
    with pytest.raises(ValueError, match="got 'luminance_valid'"):
        vizlight.illuminate(mesh, SCENE)


def test_numbers_of_any_type_are_written_as_numbers():
    mesh = pv.PolyData(np.eye(3))
    given = np.eye(3, dtype=np.longdouble)
    lit = vizlight.illuminate(mesh, SCENE, tangents=given, feature_angle=Fraction(61, 2))
    told = vizlight.provenance(lit)["options"]
    assert told["feature_angle"] == 30.5
    np.testing.assert_array_equal(told["tangents"], np.eye(3))


STRANGE = [
    "{}", "[]", "1", "null", '"text"', "not JSON", "[" * 100_000, "{" * 1000, "\0", "NaN",
    '{"arrays": ["own", "luminance"]}',
    '{"vizlight": "1", "filter": "f", "arrays": ["own", "luminance"]}',
    '{"vizlight": "1", "filter": "f", "arrays": {"own": "842:0", "luminance": 5}}',
    '{"vizlight": "1", "filter": "f", "arrays": {"own": "842:0", "luminance": "x"}}',
    '{"vizlight": "1", "filter": "f", "arrays": {}, "options": 5}',
    '{"vizlight": "1", "filter": "f", "arrays": {}, "inside": -1, "sharp": 1e999}',
]  # fmt: skip


@pytest.mark.parametrize("text", STRANGE, ids=range(len(STRANGE)))
def test_a_record_of_unknown_origin_costs_the_user_no_array(text):
    mesh = pv.Sphere()
    own = {"own": np.arange(842), "luminance": np.arange(842.0), "projected_V": mesh["Normals"]}
    for name, array in own.items():
        mesh[name] = array
    for name in ("luminance", "light", "vizlight_normals", "vizlight_tangents", "projection"):
        mesh.field_data[f"{name}_provenance"] = [text]
    with pytest.raises(ValueError, match="name: expected one under which .* got 'luminance'"):
        vizlight.illuminate(mesh, SCENE)
    lit = vizlight.illuminate(mesh, SCENE, name="light")
    for name, array in own.items():
        np.testing.assert_array_equal(lit[name], array)
    assert vizlight.provenance(lit, "light")["filter"] == "illuminate"


@pytest.mark.parametrize("value", [[1.5, 2], np.zeros(0), np.zeros((2, 3), np.uint8)])
def test_a_record_that_is_no_text_is_none(value):
    mesh = pv.Sphere()
    mesh.field_data["luminance_provenance"] = value
    with pytest.raises(ValueError, match="mesh: expected one with an array by vizlight, got none"):
        vizlight.provenance(mesh)
    assert "luminance" in vizlight.illuminate(mesh, SCENE).point_data


def test_light_that_the_user_changed_is_the_users():
    lit = lit_mesh()
    lit["luminance"][7] += 0.5
    with pytest.raises(ValueError, match="got 'luminance', changed since it was computed"):
        vizlight.illuminate(lit, SCENE)
    part = lit_mesh().extract_points(np.arange(100), adjacent_cells=False)
    with pytest.raises(ValueError, match="changed since it was computed; .* delete it"):
        vizlight.illuminate(part, SCENE)


def test_kept_normals_of_unknown_origin_are_computed_again():
    mesh = pv.Sphere()
    mesh.clear_data()
    lit = vizlight.illuminate(mesh, SCENE)
    right = np.array(lit["luminance"])
    lit["vizlight_normals"][:] = 1
    assert "vizlight_normals" in lit.point_data
    np.testing.assert_array_equal(vizlight.illuminate(lit, SCENE)["luminance"], right)
    record = json.loads(lit.field_data["vizlight_normals_provenance"][0])
    record["inside"], record["sharp"] = 10**9, -5
    lit.field_data["vizlight_normals_provenance"] = [json.dumps(record)]
    np.testing.assert_array_equal(vizlight.illuminate(lit, SCENE)["luminance"], right)


def test_filters_take_their_own_light_along():
    mesh = pv.Plane(i_resolution=3, j_resolution=3)
    mesh.clear_data()
    scene = Scene(
        lights=Light(position=(0.2, 0.1, 0.5)), view=View(direction=(0, 0, 1)), material=SHINY
    )
    fine = vizlight.refine(mesh, scene, components=True)
    again = vizlight.refine(vizlight.illuminate(mesh, scene, components=True), scene)
    assert "diffuse" in fine.point_data
    assert "diffuse" not in again.point_data
    cube = pv.Cube().triangulate().clean()
    cube.clear_data()
    with pytest.warns(UserWarning, match="of the edges are sharper"):
        cube = vizlight.illuminate(cube, scene, components=True)
    split = vizlight.illuminate(cube, scene, feature_angle=30)
    assert split.n_points == 24
    assert "diffuse" not in split.point_data
