"""The filter on every kind of mesh, with good and bad arrays."""

import contextlib
import warnings

import numpy as np
import pytest
import pyvista as pv
from fields import several_kinds
from lamps import SHINY, SHOULDER, shiny
from refusals import refusals
from vectors import unit

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, engine, illuminate, presets

SCENE = Scene(lights=Light(direction=(0.3, 0.2, 1)), view=View(position=(0, 0, 20)), material=SHINY)


def image():
    grid = pv.ImageData(dimensions=(5, 4, 3), spacing=(0.5, 1, 2), origin=(1, 2, 3))
    grid["V"] = swirl(grid.points)
    return grid


def swirl(points):
    x, y, z = np.asarray(points, dtype=float).T
    return np.stack([-y - 1, x + 2, 0.3 * z + 1], axis=1)


def meshes():
    grid = image()
    plane = pv.Plane(i_resolution=6, j_resolution=5)
    plane["V"] = swirl(plane.points)
    return {
        "PolyData": plane,
        "UnstructuredGrid": grid.cast_to_unstructured_grid(),
        "StructuredGrid": grid.cast_to_structured_grid(),
        "RectilinearGrid": grid.cast_to_rectilinear_grid(),
        "ImageData": grid,
    }


@pytest.mark.parametrize("kind", meshes())
def test_tangents_on_every_kind_of_mesh(kind):
    mesh = meshes()[kind]
    scene = SCENE.replace(lights=[Light(position=(4, 5, 6))])
    before = mesh.copy()
    lit = illuminate(mesh, scene, tangents="V")
    assert type(lit) is type(mesh)
    assert lit.active_scalars_name == "luminance"
    assert set(lit.point_data) - set(mesh.point_data) == {"luminance"}
    expected = engine.shade(np.asarray(mesh.points), np.asarray(mesh["V"]), scene).luminance
    np.testing.assert_allclose(lit["luminance"], expected, atol=1e-12)
    assert mesh == before


def test_named_normals_win():
    plane = pv.Plane(i_resolution=2, j_resolution=2)
    plane["down"] = np.tile([0, 0, -1.0], (plane.n_points, 1))
    lit = illuminate(plane, SCENE, normals="down", facing="as given")
    np.testing.assert_allclose(lit["luminance"], 0.1)
    given = illuminate(plane, SCENE, normals=-np.asarray(plane["down"]))
    assert given["luminance"].min() > 0.3


def test_a_volume_is_lit_on_its_outside():
    grid = pv.ImageData(dimensions=(4, 4, 4))
    words = r"of the edges are sharper than 30 degrees.*extract_surface\(\)"
    with pytest.warns(UserWarning, match=words) as caught:
        lit = illuminate(grid, SCENE)
    assert len(caught) == 1
    inside = np.all((grid.points > 0) & (grid.points < 3), axis=1)
    np.testing.assert_array_equal(lit["luminance_valid"].astype(bool), ~inside)
    np.testing.assert_allclose(lit["luminance"][inside], 0.1)


def test_conditioned_inherits_the_self_shadow():
    sphere = pv.Sphere(theta_resolution=30, phi_resolution=30)
    normals = np.asarray(sphere["Normals"])
    sphere["V"] = np.cross(normals, np.float32([0.1, 0.2, 1.0]))
    free = illuminate(sphere, SCENE, tangents="V", components=True)
    shadowed = illuminate(sphere, SCENE, tangents="V", conditioned=True, components=True)
    facing = np.maximum(normals @ unit([0.3, 0.2, 1]), 0)
    for term in ("diffuse", "specular"):
        np.testing.assert_allclose(shadowed[term], facing * free[term], atol=1e-6)
    assert np.all(shadowed["luminance"][facing == 0] == np.float32(0.1))
    assert np.any(free["luminance"][facing == 0] > 0.2)


def test_a_line_gets_a_surface_contrast_unless_told_otherwise():
    line = pv.Line((0, 0, 0), (1, 0, 0), resolution=4)
    line["T"] = np.tile([1.0, 0, 0], (5, 1))
    material = Material(ambient=0, diffuse=1, specular=0)
    scene = Scene(lights=Light(direction=(1, 0, 1)), material=material)
    default, plain = (
        illuminate(line, scene, tangents="T", **options)["luminance"]
        for options in ({}, {"exponent": 1})
    )
    np.testing.assert_allclose(default, 0.5 ** (4.7635 / 2), rtol=1e-4)
    np.testing.assert_allclose(plain, 0.5**0.5, rtol=1e-12)


def test_normals_of_points_that_float32_rounds_are_warned_of():
    """The light itself holds there: with normals of their own nothing is lost."""
    ball = pv.Sphere(theta_resolution=60, phi_resolution=60)
    for offset, warned in ((1e3, False), (1e5, True)):
        at = ball.copy()
        at.points = at.points.astype(np.float32) + np.float32(offset)
        lamp = Light(position=offset + np.array([1.5, 1, 2]))
        scene = Scene(lights=lamp, material=Material(ambient=0.3, diffuse=0.7, specular=0))
        given = illuminate(at, scene)["luminance"]
        way = unit(np.array(lamp.position) - np.asarray(at.points, float))
        cosine = np.einsum("ij,ij->i", way, np.asarray(ball["Normals"], float))
        np.testing.assert_allclose(given, 0.3 + 0.7 * np.maximum(cosine, 0), atol=1e-6)
        at.point_data.clear()
        expected = pytest.warns(UserWarning, match="so far from the origin that they are rounded")
        with expected if warned else contextlib.nullcontext():
            illuminate(at, scene, facing="outward")


def test_points_in_4_space():
    cloud = pv.PolyData(np.zeros((6, 3)))
    random = np.random.default_rng(1)
    cloud["x"] = random.standard_normal((6, 4))
    cloud["frame"] = random.standard_normal((6, 8))
    scene = Scene(lights=Light(position=(1, 2, 3, 4)), view=View(position=(0, 0, 0, 9)))
    lit = illuminate(cloud, scene, tangents="frame", positions="x")
    expected = engine.shade(cloud["x"], np.asarray(cloud["frame"]).reshape(6, 2, 4), scene)
    np.testing.assert_allclose(lit["luminance"], expected.luminance, atol=1e-14)


def test_multiblock_keeps_names_nesting_and_gaps():
    plane, grid = meshes()["PolyData"], meshes()["ImageData"]
    blocks = pv.MultiBlock({"plane": plane, "gap": None, "inner": pv.MultiBlock({"grid": grid})})
    lit = illuminate(blocks, SCENE, tangents="V")
    assert lit.keys() == ["plane", "gap", "inner"]
    assert lit["gap"] is None
    for one, alone in ((lit["plane"], plane), (lit["inner"]["grid"], grid)):
        expected = illuminate(alone, SCENE, tangents="V")["luminance"]
        np.testing.assert_array_equal(one["luminance"], expected)
    assert "luminance" not in blocks["plane"].point_data
    assert "luminance" not in blocks["inner"]["grid"].point_data


def test_multiblock_error_names_the_block_and_changes_nothing():
    blocks = pv.MultiBlock({"good": meshes()["PolyData"], "bad": pv.Sphere()})
    words = "block /bad: tangents: expected the name of a point array"
    with pytest.raises(ValueError, match=words):
        illuminate(blocks, SCENE, tangents="V", inplace=True)
    assert "luminance" not in blocks["good"].point_data


FLATS = [pv.Plane(center=(0, 0, 4)), pv.Plane(center=(0, 0, -6))]
SEEN = Scene(lights=[], view=View(direction=(0, 0, 1)), material=shiny(ambient=1))


def test_one_depth_cue_for_all_blocks():
    scene = SEEN.replace(depth_cue=DepthCue(back_scale=0.25, cue=0))
    lit = illuminate(pv.MultiBlock(FLATS), scene)
    np.testing.assert_allclose(lit[0]["luminance"], 1)
    np.testing.assert_allclose(lit[1]["luminance"], 0.25)
    told = vizlight.provenance(lit[0])["scene"]["depth_cue"]
    assert (told["front"], told["back"]) == (-4, 6)
    np.testing.assert_allclose(illuminate(FLATS[0], scene)["luminance"], 1)


@pytest.mark.parametrize(
    ("cue", "ends"),
    [
        ({"front": -4}, (-4, 6)),
        ({"front": 0}, (0, 6)),
        ({"back": 3}, (-4, 3)),
        ({"front": 6}, (6, 7)),
        ({"front": 9}, (9, 10)),
        ({"back": -4}, (-5, -4)),
        ({"front": 8, "back": 2}, (8, 2)),
    ],
)
def test_one_end_of_a_depth_cue(cue, ends):
    lit = illuminate(pv.MultiBlock(FLATS), SEEN.replace(depth_cue=DepthCue(**cue)))
    told = vizlight.provenance(lit[0])["scene"]["depth_cue"]
    assert (told["front"], told["back"]) == ends


def test_names_of_results():
    plane = meshes()["PolyData"]
    lit = illuminate(plane, SCENE, tangents="V", name="flow", components=True)
    assert {"flow", "flow_ambient", "flow_diffuse", "flow_specular"} <= set(lit.point_data)
    assert "luminance" not in lit.point_data
    total = lit["flow_ambient"] + lit["flow_diffuse"] + lit["flow_specular"]
    np.testing.assert_allclose(lit["flow"], total, atol=1e-12)


def test_inplace_changes_the_mesh_and_may_be_repeated():
    plane = meshes()["PolyData"]
    zero = plane["V"].copy()
    zero[0] = 0
    plane["W"] = zero
    with pytest.warns(UserWarning, match="1 of"):
        assert illuminate(plane, SCENE, tangents="W", inplace=True, components=True) is plane
    assert "luminance_valid" in plane.point_data
    illuminate(plane, SCENE, tangents="V", inplace=True)
    assert not {"luminance_valid", "diffuse"} & set(plane.point_data)


@pytest.mark.parametrize("name", ["luminance", "diffuse"])
def test_the_users_own_array_is_not_overwritten(name):
    plane = meshes()["PolyData"]
    plane[name] = np.arange(plane.n_points)
    words = f"name: expected one under .* no array of its own, got '{name}'; pass another name="
    with pytest.raises(ValueError, match=words):
        illuminate(plane, SCENE, tangents="V", components=True, inplace=True)
    np.testing.assert_array_equal(plane[name], np.arange(plane.n_points))
    assert (name == "luminance") or "luminance" in illuminate(plane, SCENE, tangents="V").point_data


@pytest.mark.parametrize("as_grid", [False, True])
@pytest.mark.parametrize("seen", [False, True])
def test_faces_lines_and_vertices_of_one_mesh_are_lit_as_such(as_grid, seen):
    mixed, parts = several_kinds()
    faces, lines, vertices = parts
    scene = SCENE.replace(view=View(position=(3, 2, 1)) if seen else None)
    mesh = mixed.cast_to_unstructured_grid() if as_grid else mixed
    # The first point of the lines is the faces' too.
    own = np.arange(faces.n_points - 1, faces.n_points - 1 + lines.n_points)
    lit = illuminate(mesh, scene)
    light = lit["luminance"]
    assert vizlight.check(lit, sample=500).error < 1e-6
    expected = illuminate(faces, scene)["luminance"]
    np.testing.assert_allclose(light[: faces.n_points], expected, atol=1e-6)
    np.testing.assert_allclose(light[own[1:]], illuminate(lines, scene)["luminance"][1:], atol=1e-6)
    toward = (3, 2, 1) - vertices.points if seen else np.ones((vertices.n_points, 3))
    vertices["to the eye"] = toward
    by_eye = illuminate(vertices, scene, normals="to the eye", facing="as given")["luminance"]
    np.testing.assert_allclose(light[own[-1] + 1 :], by_eye, atol=1e-6)


def test_vertices_beside_faces_keep_normals_that_they_have():
    mixed, (faces, lines, vertices) = several_kinds()
    normals = np.array(mixed.points)
    normals[-vertices.n_points :] = (0, 0.6, 0.8)
    mixed.point_data.active_normals = normals
    light = illuminate(mixed, SCENE)["luminance"]
    vertices.point_data.active_normals = np.tile([0.0, 0.6, 0.8], (vertices.n_points, 1))
    own = illuminate(vertices, SCENE)["luminance"]
    np.testing.assert_allclose(light[-vertices.n_points :], own, atol=1e-6)
    along = illuminate(lines, SCENE)["luminance"]
    start = faces.n_points
    np.testing.assert_allclose(light[start : start + lines.n_points - 1], along[1:], atol=1e-6)


def test_what_is_refined_stays_lines_and_faces():
    mixed, _ = several_kinds()
    light = vizlight.refine(mixed, SCENE, error=0.02)["luminance"]
    expected = illuminate(mixed, SCENE)["luminance"]
    assert len(light) > mixed.n_points
    np.testing.assert_allclose(light[: mixed.n_points], expected, atol=1e-6)


def test_zero_and_nan_vectors_are_marked_with_one_warning():
    plane = meshes()["PolyData"]
    plane["V"][3] = 0
    plane["V"][5] = np.nan
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        lit = illuminate(plane, SCENE, tangents="V")
    (warning,) = caught
    assert f"2 of {plane.n_points} points could not be lit" in str(warning.message)
    assert warning.filename == __file__
    np.testing.assert_array_equal(np.flatnonzero(~lit["luminance_valid"].astype(bool)), [3, 5])
    np.testing.assert_allclose(lit["luminance"][[3, 5]], 0.1)


def test_cell_data_is_averaged_with_a_notice():
    grid = image().cast_to_unstructured_grid()
    grid.cell_data["C"] = np.tile([1.0, 2, 3], (grid.n_cells, 1))
    with pytest.warns(UserWarning, match="tangents: the cell array 'C' is averaged") as caught:
        lit = illuminate(grid, SCENE, tangents="C")
    assert len(caught) == 1
    assert caught[0].filename == __file__
    with pytest.raises(ValueError, match=r"normals: .* 'C'; call mesh.cell_data_to_point_data\(\)"):
        illuminate(grid, SCENE, normals="C")
    grid["P"] = np.tile([1.0, 2, 3], (grid.n_points, 1))
    np.testing.assert_allclose(lit["luminance"], illuminate(grid, SCENE, tangents="P")["luminance"])
    assert "C" not in lit.point_data


def test_precision_follows_the_vectors_unless_asked():
    plane = meshes()["PolyData"]
    assert illuminate(plane, SCENE, tangents="V")["luminance"].dtype == np.float64
    low = illuminate(plane, SCENE, tangents="V", precision="float32")
    assert low["luminance"].dtype == np.float32


@pytest.mark.parametrize("kind", [pv.PolyData, pv.UnstructuredGrid, pv.ImageData])
def test_empty_meshes(kind):
    mesh = kind()
    lit = illuminate(mesh, SCENE)
    assert lit.n_points == mesh.n_points
    assert "luminance" in lit.point_data


def bad_options(options):
    plane = meshes()["PolyData"]
    for name, size in (("S", 1), ("two", 2), ("four", 4), ("nine", 9)):
        plane[name] = np.ones((42, size))
    plane["words"] = np.array(["a"] * 42)
    before = plane.copy()
    try:
        illuminate(plane, SCENE, **options)
    finally:
        assert plane == before


test_bad_options = refusals(
    bad_options,
    ({"tangents": "U"}, r"tangents: expected the name of a point array \('.*'V'.*\), got 'U'"),
    ({"tangents": "S"}, "tangents: expected vectors.*got 'S' with 1 component; name"),
    ({"tangents": "two"}, "tangents: expected a point array of 3 or 6 components.*'two' with 2"),
    ({"tangents": "nine"}, "tangents: .*'nine' with 9"),
    ({"tangents": np.ones((2, 3))}, "tangents: expected 42 rows, one per point"),
    ({"tangents": "V", "normals": "V"}, "normals: expected no normals beside tangents"),
    ({"conditioned": True}, "conditioned: expected tangents to condition"),
    ({"normals": "two"}, "normals: expected 3 components, got 'two' with 2"),
    ({"tangents": "V", "model": "x"}, "model: expected"),
    ({"tangents": "V", "facing": "eye"}, "facing: expected no facing beside tang"),
    ({"facing": "me"}, "facing: expected .*as given.*, got 'me'"),
    ({"feature_angle": -1}, "feature_angle: expected"),
    ({"feature_angle": "30"}, "feature_angle: expected .*'auto' or None, got '30'"),
    ({"tangents": "V", "name": ""}, "name: expected a name"),
    ({"tangents": "V", "precision": "f4"}, "precision: expected"),
    ({"tangents": "V", "positions": "four"}, "tangents: expected a point array of 4 or 8"),
    ({"tangents": "words"}, "tangents: expected real numbers, got 'words'", TypeError),
    ({"positions": "four"}, "normals: expected a point array of 4 components for 4-space"),
    (
        {"tangents": "V", "conditioned": np.eye(3)},
        "conditioned: expected True, False or the name",
        TypeError,
    ),
)


def test_no_scene_is_two_lamps_of_the_isometric_view_without_highlight():
    ball = pv.Sphere()
    normals = np.asarray(ball.point_data.active_normals, float)
    key, fill = (np.maximum(normals @ w, 0) for w in (SHOULDER, 3**-0.5 * np.ones(3)))
    expected = 0.3 + 0.7 * (8 * key + 3 * fill) / 11
    for lit in (illuminate(ball), illuminate(ball, Scene()), ball.vizlight.illuminate()):
        np.testing.assert_allclose(lit["luminance"], expected, atol=1e-6)


def test_integer_normals_are_turned_over_as_numbers():
    mesh = pv.PolyData(np.eye(3), [3, 0, 1, 2])
    mesh["N"] = np.full((3, 3), 255, np.uint8)
    away = SCENE.replace(view=View(direction=(-0.3, -0.2, -1)))
    turned = illuminate(mesh, away, normals="N", facing="eye")
    given = -mesh["N"].astype(float)
    expected = illuminate(mesh, away, normals=given, facing="as given")
    np.testing.assert_array_equal(turned["luminance"], expected["luminance"])


@pytest.mark.parametrize("inplace", [False, True])
def test_light_is_active_where_a_cell_array_was(inplace):
    mesh = pv.Sphere()
    mesh.cell_data["c"] = np.arange(mesh.n_cells)
    mesh.set_active_scalars("c")
    lit = illuminate(mesh, SCENE, inplace=inplace)
    assert lit.active_scalars_name == "luminance"
    assert inplace or mesh.active_scalars_name == "c"


def test_curved_cells_are_lit_at_their_nodes():
    """A plane of one quadratic triangle: the middles of its edges have normals too."""
    points = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    mesh = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TRIANGLE: np.arange(6)[None]}, points)
    scene = SCENE.replace(view=View(direction=(0, 0, 1)))
    expected = illuminate(pv.Plane(), scene)["luminance"][0]
    np.testing.assert_allclose(illuminate(mesh, scene)["luminance"], expected, rtol=1e-6)


@pytest.mark.filterwarnings("ignore:.*of the edges are sharper")
@pytest.mark.parametrize("cell", ["QuadraticTetrahedron", "QuadraticHexahedron", "QuadraticWedge"])
def test_nodes_of_curved_volumes_have_the_light_of_their_place(cell, random):
    """However the points are numbered, and however many cells there are."""
    one = getattr(pv.examples.cells, cell)()
    other = one.translate((3, 0, 0))
    mesh = pv.merge([one, other], merge_points=False)
    order = random.permutation(mesh.n_points)
    cells = np.insert(
        np.argsort(order)[mesh.cell_connectivity],
        mesh.cell_offsets[:-1],
        np.diff(mesh.cell_offsets),
    )
    shuffled = pv.UnstructuredGrid(cells, mesh.celltypes, np.asarray(mesh.points)[order])
    scene = SCENE.replace(view=View(direction=(0, 0, 1)))
    expected = illuminate(one, scene)["luminance"]
    lit = illuminate(shuffled, scene)
    np.testing.assert_allclose(lit["luminance"], np.tile(expected, 2)[order], atol=1e-6)
    assert np.ptp(lit["luminance"]) > 0.1


test_what_cannot_be_lit_is_named = refusals(
    illuminate,
    (np.ones((3, 3)), SCENE, "mesh: expected a PyVista mesh, got ndarray; read files", TypeError),
    (pv.MultiBlock([pv.Table(np.eye(3)), pv.Sphere()]), SCENE, "block /.* got Table", TypeError),
    (pv.PointSet(np.eye(3)), SCENE, "mesh: expected a surface"),
    (pv.PolyData(np.eye(3)), SCENE, "mesh: expected a surface.*tangent vectors by tangents="),
    (pv.Sphere(), SCENE.lights[0], r"scene: expected a vizlight\.Scene or None, got", TypeError),
    (pv.Sphere(), presets.shape, r"scene: .* got <function shape.*; call it: shape\(", TypeError),
    (pv.Sphere(), Scene(depth_cue=DepthCue()), "view: expected a View, which the depth cue needs"),
)


@pytest.mark.parametrize("kind", [pv.PolyData, pv.PointSet])
def test_a_scan_is_lit_by_planes_through_its_neighbours(kind):
    ball = pv.Sphere(theta_resolution=40, phi_resolution=40)
    scene = Scene(view=View(direction=(1, 1, 1)))
    known = illuminate(ball, scene)["luminance"]
    found = illuminate(kind(ball.points), scene)["luminance"]
    front = ball.points @ (1, 1, 1) > 0.2  # what is not averted
    assert np.abs(known - found)[front].max() < 0.05


def test_normals_that_contradict_the_faces_are_told_and_believed():
    ball = pv.Sphere()
    good = vizlight.illuminate(ball, SCENE)
    ball["Normals"] *= -1
    turned = vizlight.illuminate(ball, SCENE)
    np.testing.assert_array_equal(turned["luminance"], good["luminance"])
    ball["Normals"][:] = (0, 0, 1)
    for mesh in (ball, pv.MultiBlock([pv.Cube(), ball])):
        words = r"lean from its faces by .* 4\d% .* clear them"
        with pytest.warns(UserWarning, match=words) as told:
            lit = vizlight.illuminate(mesh, SCENE, components=True)
        assert len(told) == 1
    assert np.ptp(lit[1]["diffuse"]) < 0.05 < np.ptp(good["luminance"])


def test_normals_that_smear_the_edges_of_a_box_are_told():
    words = "averaged across its sharp edges, 67% of all.* clear them: .*feature_angle=30"
    with pytest.warns(UserWarning, match=words):
        vizlight.illuminate(pv.Cube(), SCENE)
    # None of these smears its edges: split ones, and coarse arcs.
    for good in (
        pv.Cube().compute_normals(split_vertices=True),
        pv.Cylinder(resolution=8),
        pv.Sphere(),
    ):
        vizlight.illuminate(good, SCENE)


@pytest.mark.parametrize("of_cells", [False, True])
def test_names_of_components_are_tangents(of_cells):
    grid = pv.ImageData(dimensions=(9, 8, 1))
    count = grid.n_cells if of_cells else grid.n_points
    data = grid.cell_data if of_cells else grid.point_data
    data["u"], data["v"] = np.cos(np.arange(count)), np.sin(np.arange(count) + 0.5)
    points = grid.cell_data_to_point_data() if of_cells else grid
    rows = np.column_stack([points["u"], points["v"], np.zeros(grid.n_points)])
    expected = vizlight.illuminate(grid, SCENE, tangents=rows)["luminance"]
    for names in (("u", "v"), ["u", "v"], "u,v"):
        lit = vizlight.illuminate(grid, SCENE, tangents=names)
        np.testing.assert_array_equal(lit["luminance"], expected)
        assert vizlight.provenance(lit)["options"]["tangents"] == "u,v"
    assert of_cells or vizlight.look(grid, "direction", tangents=("u", "v")).array == "u,v"
    with pytest.raises(
        ValueError, match="tangents: expected names of arrays .* 'q': no such array"
    ):
        vizlight.illuminate(grid, SCENE, tangents="u,q")


def test_a_component_is_named_once():
    grid = pv.ImageData(dimensions=(5, 5, 1))
    grid["u"] = np.cos(np.arange(25.0))
    with pytest.raises(ValueError, match="tangents: expected different arrays, got 'u'"):
        vizlight.streamlines(grid, tangents=("u", "u"), spacing=2.0)
    with pytest.raises(TypeError, match="tangents: expected real numbers"):
        vizlight.illuminate(grid, SCENE, tangents=("u", "u"))
