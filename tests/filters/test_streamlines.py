"""Streamlines: on the field, on the surface, lit by their tangents, conditioned by normals."""

import os
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from vectors import parts, unit

import vizlight
from vizlight import Light, Material, Scene, View, streamlines
from vizlight.mesh import records

SCENE = Scene(lights=Light(direction=(1, -1, 0.8)), view=View(direction=(0.2, -1, 0.3)))


def ball(resolution=60, radius=0.5):
    sphere = pv.Sphere(radius=radius, theta_resolution=resolution, phi_resolution=resolution)
    normals = np.asarray(sphere["Normals"], dtype=float)
    sphere["V"] = np.array([0, 0, 1.0]) - normals[:, 2:] * normals
    return sphere


def lengths(lines):
    return np.array([np.linalg.norm(np.diff(p, axis=0), axis=1).sum() for p in parts(lines)])


def channel(start=-1):
    return pv.ImageData(dimensions=(21, 5, 5), origin=(start, 0, 0), spacing=(0.1, 0.1, 0.1))


def vortex():
    grid = pv.ImageData(dimensions=(21, 21, 5), origin=(-1, -1, 0), spacing=(0.1, 0.1, 0.1))
    x, y, _ = grid.points.T
    grid["V"] = np.stack([-y, x, 0 * x], axis=1)
    return grid


def test_free_lines_follow_the_field():
    lines = streamlines(
        vortex(), SCENE, tangents="V", seeds=[[0.5, 0, 0.2], [0, 0.3, 0.2]], max_length=3.0
    )
    radius = np.hypot(*np.asarray(lines.points[:, :2]).T)
    assert np.min([abs(radius - 0.5), abs(radius - 0.3)], axis=0).max() < 1e-3
    again = vizlight.illuminate(lines, SCENE, tangents="V", name="by_field")
    np.testing.assert_allclose(lines["luminance"], again["by_field"], atol=5e-3)
    assert "drift" not in lines.field_data


def test_confined_lines_stay_on_the_surface_and_follow_meridians():
    sphere = ball()
    before = sphere.copy()
    lines = streamlines(sphere, SCENE, tangents="V", seeds=20)
    assert lines.field_data["drift"][0] < 1e-6
    distance = np.abs(lines.compute_implicit_distance(sphere)["implicit_distance"])
    assert distance.max() < 1e-6
    for x, y, _ in (points.T for points in parts(lines)):
        away = np.hypot(x, y) > 0.1
        if away.sum() > 2:
            turn = np.exp(1j * np.arctan2(y[away], x[away]))
            assert np.abs(turn - turn[0]).max() < 0.02
    assert sphere == before


def test_a_surface_conditions_the_lines():
    sphere = ball()
    dark = SCENE.replace(material=Material(ambient=0.1))
    free = streamlines(sphere, dark, tangents="V", conditioned=False, seeds=20)
    shadowed = streamlines(sphere, dark, tangents="V", seeds=20)
    np.testing.assert_allclose(free.points, shadowed.points)
    outward = np.asarray(shadowed.points) / 0.5
    cosine = outward @ unit([1, -1, 0.8])
    expected = 0.1 + np.maximum(cosine, 0) * (free["luminance"] - 0.1)
    np.testing.assert_allclose(shadowed["luminance"], expected, atol=0.02)
    dark = cosine < -0.05
    np.testing.assert_allclose(shadowed["luminance"][dark], 0.1, rtol=1e-6)
    assert free["luminance"][dark].max() > 0.2


@pytest.mark.parametrize("question", ["direction", "slope", "heading"])
def test_light_that_tells_how_lines_run_has_no_self_shadow_unless_asked(question):
    """The record says so too, by which the light is computed anew."""
    sphere, scene = ball(24), getattr(vizlight.presets, question)(SCENE.view)
    lines, free, shadowed = (
        streamlines(sphere, scene, tangents="V", seeds=20, conditioned=conditioned)
        for conditioned in (None, False, True)
    )
    np.testing.assert_array_equal(lines["luminance"], free["luminance"])
    assert np.median(lines["luminance"]) > 1.2 * np.median(shadowed["luminance"])
    assert records.read(lines, "luminance")["options"]["conditioned"] is False


def test_lines_of_a_volume_on_an_isosurface():
    flow = vizlight.load_example()
    iso = flow.contour([400.0], scalars="Temp")
    lines = streamlines(
        flow, SCENE, tangents="V", surface=iso, confined=True, seeds=40, max_length=10.0
    )
    assert lines.field_data["drift"][0] < 1e-5


def test_free_lines_near_a_surface_get_its_nearest_normals():
    flow = vortex()
    sphere = ball(40, radius=0.7).translate((0, 0, 0.2), inplace=False)
    lines = streamlines(flow, SCENE, tangents="V", surface=sphere, seeds=30, max_length=1.0)
    outward = np.asarray(lines.points) - [0, 0, 0.2]
    size = np.linalg.norm(outward, axis=1)
    far = size > 0.1
    cosine = np.sum(lines["Normals"] * outward, axis=1)[far] / size[far]
    assert cosine.min() > 0.99


def test_embedded_flow_is_lit_with_the_active_vectors():
    flow = vizlight.load_example()
    flow.set_active_vectors("V")
    lines = streamlines(flow, SCENE, seeds=30, seed=3)
    same = streamlines(flow, SCENE, tangents="V", seeds=30, seed=3)
    other = streamlines(flow, SCENE, tangents="V", seeds=30, seed=4)
    np.testing.assert_array_equal(lines["luminance"], same["luminance"])
    assert lines.n_points != other.n_points
    assert np.ptp(lines["luminance"]) > 0.3


def test_options_reach_the_light():
    lines = streamlines(
        vortex(), SCENE, tangents="V", seeds=9, name="x", components=True, precision="float64"
    )
    assert {"x", "x_diffuse"} <= set(lines.point_data)
    assert lines["x"].dtype == np.float64


test_bad_input = refusals(
    lambda make, options: streamlines(make(), SCENE, **options),
    (vortex, {"tangents": "U"}, "tangents: expected the name of an array"),
    (pv.ImageData, {}, "tangents: expected a mesh with an array of 3 components"),
    (vortex, {"tangents": "V", "confined": True}, "surface: expected a surface for confined"),
    (vortex, {"tangents": "V", "conditioned": True}, "surface: .* conditioned lines"),
    (vortex, {"tangents": "V", "surface": pv.Line()}, "surface: expected a surface with faces"),
    (vortex, {"tangents": "V", "seeds": 0}, "seeds: expected an integer of at least 1"),
    (vortex, {"tangents": "V", "seeds": [1.0, 2.0]}, "seeds: expected"),
    (vortex, {"tangents": "V", "seeds": [[99.0, 0, 0]]}, "seeds: expected points inside"),
    (vortex, {"tangents": "V", "seeds": [[np.nan, 0, 0]]}, "seeds: expected finite"),
    (vortex, {"tangents": "V", "seeds": [[1, 2, 3], [1, 2]]}, "seeds: expected num", TypeError),
    (vortex, {"tangents": "V", "seed": -1}, "seed: expected an integer of at"),
    (vortex, {"tangents": np.ones((2205, 3))}, "tangents: expected the name of a", TypeError),
    (vortex, {"tangents": "V", "inplace": True}, "inplace: expected an option of", TypeError),
    (vortex, {"tangents": "V", "step": 0}, "step: expected"),
    (vortex, {"tangents": "V", "max_length": -1}, "max_length: expected"),
    (lambda: np.ones(3), {"tangents": "V"}, "mesh: expected a PyVista dataset", TypeError),
)


def test_far_from_the_origin():
    """Metres north of the equator: lines are traced near the mesh, not at 5e6 in float32."""
    offset = np.array([4e5, 5e6, 1e3])
    seeds = np.array([[0.5, 0, 0.2], [0, 0.3, 0.2]])
    near = streamlines(vortex(), SCENE, tangents="V", seeds=seeds)
    flow = vortex()
    flow.origin = tuple(np.array(flow.origin) + offset)
    far = streamlines(flow, SCENE, tangents="V", seeds=seeds + offset)
    assert far.points.dtype == np.float64
    np.testing.assert_allclose(far.points - offset, near.points, atol=1e-6)
    np.testing.assert_allclose(far["luminance"], near["luminance"], atol=1e-4)

    sphere = ball()
    moved = sphere.copy()
    moved.points = np.asarray(sphere.points, float) + offset
    # Within triangles: on an edge rounding decides in which one a line begins.
    seeds = np.asarray(sphere.cell_centers().points, float)[1000:1006]
    here = streamlines(sphere, SCENE, tangents="V", seeds=seeds)
    there = streamlines(moved, SCENE, tangents="V", seeds=seeds + offset)
    assert there.field_data["drift"][0] < 1e-6
    drawn = streamlines(moved, SCENE, tangents="V", seeds=15)
    assert drawn.n_lines == streamlines(sphere, SCENE, tangents="V", seeds=15).n_lines
    assert drawn.field_data["drift"][0] < 1e-6
    np.testing.assert_allclose(there.points - offset, here.points, atol=1e-5)
    np.testing.assert_allclose(there["luminance"], here["luminance"], atol=1e-3)


def test_vectors_that_are_not_finite_stop_a_line():
    sphere = ball()
    sphere["V"][np.asarray(sphere.points)[:, 2] > 0.2] = np.nan
    lines = streamlines(sphere, SCENE, tangents="V", seeds=40)
    assert np.all(np.isfinite(lines["luminance"]))
    assert np.asarray(lines.points)[:, 2].max() < 0.25


@pytest.mark.parametrize("scale", [1e-30, 1e-7, 1e12, 1e30])
def test_lines_do_not_depend_on_the_unit(scale):
    """Neither of the lengths nor of the speeds."""
    sphere = ball(30)
    places = np.asarray(sphere.points, float)
    places = places[np.abs(places[:, 2]) < 0.1][:20]
    expected = streamlines(sphere, SCENE, tangents="V", seeds=places, max_length=0.3)
    other = sphere.copy()
    other.points = np.asarray(sphere.points, float) * scale
    other["V"] = sphere["V"] / scale**5
    found = streamlines(other, SCENE, tangents="V", seeds=places * scale, max_length=0.3 * scale)
    assert found.n_lines == expected.n_lines
    np.testing.assert_allclose(lengths(found) / scale, lengths(expected), atol=1e-3)
    np.testing.assert_allclose(found.field_data["drift"] / scale, 0, atol=1e-6)


def test_one_large_vector_does_not_stop_the_lines():
    flow = vortex()
    few = streamlines(flow, SCENE, tangents="V", seeds=20, max_length=1.0)
    flow["V"][0] = 1e20
    assert streamlines(flow, SCENE, tangents="V", seeds=20, max_length=1.0).n_lines == few.n_lines


def test_a_line_ends_where_it_turns_back():
    """Where the flow meets itself a line would jump from one side to the other for ever."""
    grid = channel()
    x = grid.points[:, 0]
    grid["V"] = np.stack([-np.sign(x), 0 * x, 0 * x], axis=1)
    lines = streamlines(grid, SCENE, tangents="V", seeds=[[0.52, 0.2, 0.2], [-0.71, 0.2, 0.2]])
    assert lines.n_points < 200
    for points in parts(lines):
        along = np.diff(points[:, 0])
        assert np.all(along > 0) or np.all(along < 0)


def test_a_mesh_that_was_lit_before():
    sphere = vizlight.illuminate(ball(30), SCENE, components=True)
    lines = streamlines(sphere, SCENE, tangents="V", seeds=20)
    assert "luminance" in lines.point_data
    assert "diffuse" not in lines.point_data


@pytest.mark.slow
def test_carotid_artery():
    """Measured flow with walls: every point of a line is lit."""
    if not Path(os.environ.get("PYVISTA_DATA", "")).is_dir() or "PYVISTA_DATA" not in os.environ:
        pytest.skip("PYVISTA_DATA names no folder with carotid.vtk")
    flow = pv.examples.download_carotid()
    lines = streamlines(flow, SCENE, tangents="vectors", seeds=60)
    assert lines.n_lines == 60
    assert "luminance_valid" not in lines.point_data
    wall = flow.contour([150.0], scalars="scalars")
    lines = streamlines(flow, SCENE, tangents="vectors", surface=wall, confined=True, seeds=30)
    assert lines.field_data["drift"][0] < 1e-2 * wall.length
    assert np.all(np.isfinite(lines["luminance"]))


def test_arrays_of_words_and_active_arrays_stay_as_they_are():
    flow = vortex()
    flow["words"] = np.array(["a"] * flow.n_points)
    flow["s"] = np.arange(flow.n_points, dtype=float)
    flow.set_active_scalars("s")
    lines = streamlines(flow, SCENE, tangents="V", seeds=9)
    assert lines.n_points
    assert flow.active_scalars_name == "s"
    assert "words" in flow.point_data


def test_loose_cells_of_a_surface_do_not_matter():
    sphere = ball(30)
    mixed = sphere.append_polydata(pv.Line((2, 0, 0), (3, 0, 0)))
    mixed["Normals"] = np.vstack([sphere["Normals"], np.zeros((2, 3), np.float32)])
    mixed.point_data.active_normals_name = "Normals"
    mixed["V"] = np.vstack([sphere["V"], np.zeros((2, 3))])
    lines = streamlines(mixed, SCENE, tangents="V", seeds=np.asarray(sphere.points)[100:110])
    outward = np.asarray(lines.points) / 0.5
    assert np.sum(lines["Normals"] * outward, axis=1).min() > 0.97


def test_no_line_at_all():
    flow = vortex()
    flow["V"] = np.zeros((flow.n_points, 3))
    with pytest.raises(ValueError, match="seeds: expected points inside the mesh"):
        streamlines(flow, SCENE, tangents="V", seeds=9)


def test_errors_name_the_arrays_that_could_be_traced():
    grid = pv.ImageData(dimensions=(3, 3, 3))
    grid.cell_data["wind"] = np.ones((8, 3))
    with pytest.raises(ValueError, match=r"\('wind'\), got 'wnid'; pass tangents='wind'"):
        streamlines(grid, SCENE, tangents="wnid")
    for name in ("U", "W"):
        grid.point_data[name] = np.ones((27, 3))
    grid.point_data.active_vectors_name = None
    with pytest.raises(ValueError, match="got None; pass tangents='U' or tangents='W' or"):
        streamlines(grid, SCENE)


def test_what_points_out_of_a_surface_does_not_count():
    """The tangential part alone is traced, however large the rest is."""
    sphere = ball(30)
    normals = np.asarray(sphere["Normals"], dtype=float)
    seeds = np.asarray(sphere.points)[100:106]
    along = streamlines(sphere, SCENE, tangents="V", seeds=seeds)
    sphere["V"] = sphere["V"] + normals * np.linspace(-3, 3, sphere.n_points)[:, np.newaxis]
    tilted = streamlines(sphere, SCENE, tangents="V", seeds=seeds)
    np.testing.assert_allclose(tilted.points, along.points, atol=1e-6)
    np.testing.assert_allclose(tilted["luminance"], along["luminance"], atol=1e-5)


def test_lines_run_from_their_seeds_both_ways():
    grid = channel()
    grid["V"] = np.tile([2.0, 0, 0], (grid.n_points, 1))
    lines = streamlines(grid, SCENE, tangents="V", seeds=[[0.3, 0.2, 0.2]], max_length=0.5)
    x = np.asarray(lines.points)[:, 0]
    assert x.min() == pytest.approx(0.3 - 0.5, abs=0.1)
    assert x.max() == pytest.approx(0.3 + 0.5, abs=0.1)


def test_seeds_on_a_surface_are_uniform_in_its_area():
    """A square of two triangles; lines so short that each shows where its seed is."""
    square = pv.Plane(i_resolution=1, j_resolution=1).triangulate()
    square["V"] = np.tile([1.0, 0, 0], (4, 1))
    lines = streamlines(square, SCENE, tangents="V", seeds=640, max_length=0.02, step=0.01)
    seeds = np.array([line.mean(axis=0) for line in parts(lines)])
    assert len(seeds) > 600
    number, _, _ = np.histogram2d(*seeds[:, :2].T, bins=4, range=[[-0.5, 0.5]] * 2)
    chi2 = np.sum((number - len(seeds) / 16) ** 2) / (len(seeds) / 16)
    assert chi2 < 15 + 5 * np.sqrt(2 * 15)


def test_the_array_of_vectors_stays_as_it_was_on_confined_lines():
    sphere = ball()
    normals = np.asarray(sphere["Normals"], dtype=float)
    sphere["V"] = sphere["V"] + 2 * normals
    lines = streamlines(sphere, SCENE, tangents="V", seeds=20)
    outward = np.asarray(lines.points) / 0.5
    along = np.array([0, 0, 1.0]) - outward[:, 2:] * outward
    np.testing.assert_allclose(lines["V"], along + 2 * outward, atol=0.02)
    np.testing.assert_allclose(np.sum(lines["Tangents"] * lines["Normals"], axis=1), 0, atol=1e-6)


def test_confined_lines_are_lit_by_the_field_and_not_by_their_chords():
    """Light of the exact field on a sphere: order 2 in the size of triangles."""
    errors = []
    for n in (20, 40, 80):
        lines = streamlines(ball(n), SCENE, tangents="V", seeds=30, conditioned=False)
        outward = unit(np.asarray(lines.points, float))
        lines["exact"] = np.array([0, 0, 1.0]) - outward[:, 2:] * outward
        exact = vizlight.illuminate(lines, SCENE, tangents="exact", name="by_field")["by_field"]
        chords = vizlight.illuminate(lines, SCENE, name="by_chords")["by_chords"]
        # At the poles the field has no direction.
        away = np.hypot(*outward[:, :2].T) > 0.2
        errors.append(np.abs(lines["luminance"] - exact)[away].max())
    assert errors[-1] < 2e-3
    assert -np.polyfit(np.log([20, 40, 80]), np.log(errors), 1)[0] > 1.5
    assert np.abs(chords - exact)[away].max() > 3 * errors[-1]


def test_as_many_lines_as_seeds():
    flow = vortex()
    still = np.hypot(*flow.points[:, :2].T) > 0.8
    flow["V"][still] = 0
    lines = streamlines(flow, SCENE, tangents="V", seeds=150, max_length=0.5)
    assert lines.n_lines == 150
    sphere = ball(30)
    sphere["V"][np.asarray(sphere.points)[:, 2] > 0] = 0
    assert streamlines(sphere, SCENE, tangents="V", seeds=40).n_lines == 40
    grid = pv.ImageData(dimensions=(4, 4, 4))
    grid["V"] = np.zeros((64, 3))
    grid["V"][21] = 1
    with pytest.warns(UserWarning, match=r"of 64 lines could be traced"):
        few = streamlines(grid, SCENE, tangents="V", seeds=100)
    assert few.n_lines < 64


@pytest.mark.parametrize("kind", ["structured", "unstructured"])
def test_a_grid_that_is_a_surface_is_taken_as_one(kind):
    u, v = np.meshgrid(np.linspace(0, 1, 12), np.linspace(0, 1, 9), indexing="ij")
    mesh = pv.StructuredGrid(*(x[..., np.newaxis] for x in (u, v, 0.2 * np.sin(3 * u))))
    mesh["V"] = np.tile([1.0, 0.3, 0], (mesh.n_points, 1))
    surface = mesh.extract_surface(algorithm="geometry")
    if kind == "unstructured":
        mesh = mesh.cast_to_unstructured_grid()
    lines = streamlines(mesh, SCENE, tangents="V", seeds=9)
    expected = streamlines(surface, SCENE, tangents="V", seeds=9)
    assert lines.n_lines == 9
    assert "Normals" in lines.point_data
    # Seeds are drawn in float32, and the order of corners can differ.
    np.testing.assert_allclose(lines.points, expected.points, atol=1e-5)
    np.testing.assert_allclose(lines["luminance"], expected["luminance"], atol=1e-4)


def test_four_components_on_a_surface_are_refused():
    surface = ball(12)
    surface["V"] = np.ones((surface.n_points, 4), np.float32)
    with pytest.raises(ValueError, match="tangents: expected 3 components, got 'V' with 4"):
        streamlines(vortex(), tangents="V", surface=surface, confined=True, seeds=3)


@pytest.mark.parametrize("on_surface", [False, True])
def test_tensors_give_their_first_eigenvector(on_surface):
    """6 components, 9, and the eigenvector with random signs: the same lines."""
    mesh = ball(30) if on_surface else vortex()
    vectors = np.array(mesh["V"], float)
    vectors = (vectors if on_surface else vectors + np.array([0, 0, 0.2])) * 3.0
    tensors = np.einsum("ni,nj->nij", vectors, vectors) + 0.1 * np.eye(3)
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    mesh["D9"] = tensors.reshape(-1, 9)
    mesh["D6"] = tensors.reshape(-1, 9)[:, [0, 4, 8, 1, 5, 2]]
    signs = np.random.default_rng(0).choice([-1.0, 1.0], size=length.shape)
    mesh["e"] = signs * vectors / np.where(length > 0, length, 1)
    seeds = np.asarray(mesh.points, float)[[200, 333, 470]] * 0.97
    options = {"seeds": seeds, "max_length": 0.6, "conditioned": False}
    found = []
    for name in ("D9", "D6", "e"):
        # At the poles of the ball the vectors are zero, and the tensors isotropic.
        told = on_surface and name != "e"
        with pytest.warns(UserWarning, match="^2 of 842 tensors") if told else nullcontext():
            found.append(streamlines(mesh, SCENE, tangents=name, line_field=name == "e", **options))
    for measure in (lambda lines: lines["luminance"].mean(), lambda lines: lines.length):
        np.testing.assert_allclose([*map(measure, found)], measure(found[0]), rtol=1e-3)
    assert found[0].n_points > 40


def test_lines_end_where_a_tensor_is_isotropic():
    grid = channel(0)
    tensors = np.tile(np.eye(3).ravel(), (grid.n_points, 1))
    tensors[grid.points[:, 0] < 1.05, 0] = 4.0
    grid["D"] = tensors
    with pytest.warns(UserWarning, match="^250 of 525 tensors have no first eigenvector"):
        lines = streamlines(grid, SCENE, tangents="D", seeds=[[0.5, 0.22, 0.21]])
    x = np.asarray(lines.points)[:, 0]
    assert x.min() < 0.01
    assert 1.0 <= x.max() <= 1.1


def test_points_where_a_tensor_is_isotropic_are_marked():
    """The mean of tensors along x and along y is isotropic in the plane, midway between them."""
    grid = pv.ImageData(dimensions=(3, 3, 3), spacing=(0.1, 0.1, 0.1))
    tensors = np.tile(np.diag([2.0, 1, 0]).ravel(), (grid.n_points, 1))
    grid["D"] = tensors
    free = streamlines(grid, SCENE, tangents="D", seeds=[[0.1, 0.1, 0.1]])
    assert "Tangents_valid" not in free.point_data
    tensors[np.isclose(grid.points[:, 0], 0.2)] = np.diag([1.0, 2, 0]).ravel()
    grid["D"] = tensors
    lines = streamlines(grid, SCENE, tangents="D", seeds=[[0.05, 0.1, 0.1]])
    isotropic = np.isclose(np.asarray(lines["D"])[:, 0], np.asarray(lines["D"])[:, 4], rtol=1e-7)
    marked = ~np.asarray(lines.point_data.get("Tangents_valid", ~isotropic))
    np.testing.assert_array_equal(marked, isotropic)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("on_surface", [False, True])
def test_the_own_array_of_a_line_field_does_not_depend_on_signs(kind, on_surface, random):
    """Random signs: the same array along the lines, with the sign of their tangents."""
    mesh = ball(40) if on_surface else vortex()
    vectors = 3 * np.asarray(mesh["V"], kind)
    signs = random.choice([-1, 1], size=(len(vectors), 1)).astype(kind)
    found = []
    for given in (vectors, signs * vectors):
        mesh["e"] = given
        seeds = np.asarray(mesh.points, float)[[200, 333, 470]] * 0.97
        options = {"line_field": True, "seeds": seeds, "max_length": 0.5}
        found.append(streamlines(mesh, SCENE, tangents="e", **options))
    assert found[0].n_points == found[1].n_points > 20
    for lines in found:
        along = np.einsum("ij,ij->i", np.asarray(lines["e"]), np.asarray(lines["Tangents"]))
        size = np.linalg.norm(lines["e"], axis=1)
        assert along.min() >= -1e-6
        np.testing.assert_allclose(along, size, atol=2e-2 * size.max())
    for one, other in zip(found[0].cell, found[1].cell, strict=True):
        a, b = found[0]["e"][one.point_ids], found[1]["e"][other.point_ids]
        # From its other end a line has the other sign.
        if np.linalg.norm(one.points[0] - other.points[0]) > 1e-5:
            b = -b[::-1]
        np.testing.assert_allclose(a, b, atol=1e-5)


@pytest.mark.parametrize("line_field", [True, False])
def test_vectors_sampled_on_a_surface_keep_their_length(line_field):
    """Vectors of a volume, of random signs or of one, on a surface that lacks them."""
    grid = pv.ImageData(dimensions=(9, 9, 9), origin=(-1, -1, -1), spacing=(0.25, 0.25, 0.25))
    signs = [-1.0, 1.0] if line_field else [1.0]
    signs = np.random.default_rng(0).choice(signs, size=(grid.n_points, 1))
    grid["e"] = signs * np.array([[0, 0, 3.0]])
    surface = pv.Sphere(radius=0.7)
    lines = streamlines(
        grid, SCENE, tangents="e", line_field=line_field, surface=surface, confined=True, seeds=9
    )
    np.testing.assert_allclose(np.abs(np.asarray(lines["e"])[:, 2]), 3.0, rtol=1e-5)


def test_the_surface_of_lines_is_split_at_sharp_edges():
    box = pv.Cube().triangulate().subdivide(3).clean()
    box.clear_data()
    box["V"] = np.cross(box.points, (0.1, 0.2, 1))
    with pytest.warns(UserWarning, match="8% of the edges are sharper than 30 degrees"):
        round_ = streamlines(box, SCENE, tangents="V", seeds=20)
    lines = streamlines(box, SCENE, tangents="V", seeds=20, feature_angle="auto")
    np.testing.assert_allclose(np.abs(lines["Normals"]).max(axis=1), 1, atol=1e-6)
    assert np.abs(round_["Normals"]).max(axis=1).min() < 0.9
    np.testing.assert_allclose(lines.length, round_.length, rtol=1e-2)


def wheel(n=72):
    """Return a torus with meridians and parallels in random order and of any signs and lengths."""
    theta, phi = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(n) / n)
    # The first row and column again: vertices at one position.
    theta, phi = (np.pad(angle, (0, 1), mode="wrap") for angle in (theta, phi))
    ring = 1 + 0.4 * np.cos(theta)
    mesh = pv.StructuredGrid(ring * np.cos(phi), ring * np.sin(phi), 0.4 * np.sin(theta))
    theta, phi = theta.ravel("F"), phi.ravel("F")
    u = [-np.sin(theta) * np.cos(phi), -np.sin(theta) * np.sin(phi), np.cos(theta)]
    v = [-np.sin(phi), np.cos(phi), 0 * phi]
    random = np.random.default_rng(3)
    pairs = np.stack([np.stack(u, axis=1), np.stack(v, axis=1)], axis=1)
    swap = random.random(len(pairs)) < 0.5
    pairs[swap] = pairs[swap][:, ::-1]
    pairs *= random.choice([-1, 1], (len(pairs), 2, 1)) * random.uniform(0.1, 9, (len(pairs), 2, 1))
    mesh["u"], mesh["v"] = pairs[:, 0], pairs[:, 1]
    return mesh


def families(lines):
    """Return lengths of lines of a torus, whether they are parallels, and their largest error."""
    found = []
    for p in parts(lines):
        phi, theta = np.arctan2(p[:, 1], p[:, 0]), np.arctan2(p[:, 2], np.hypot(*p[:, :2].T) - 1)
        across, along = (np.abs(np.angle(np.exp(1j * (a - a[0])))).max() for a in (phi, theta))
        found.append((0.4 * along < across, min(across, 0.4 * along)))
    return lengths(lines), *np.array(found).T


def test_both_families_of_a_cross_field_are_evenly_spaced():
    mesh = wheel()
    before = mesh.copy()
    lines = streamlines(mesh, SCENE, tangents=("u", "v"), line_field=True, spacing=0.2)
    assert mesh == before
    length, parallel, error = families(lines)
    assert error.max() < 0.01
    for family in (parallel == 1, parallel == 0):
        # One line per spacing covers the torus.
        assert length[family].sum() * 0.2 == pytest.approx(1.6 * np.pi**2, rel=0.15)
    assert lines.field_data["largest_gap"][0] < 1.22
    assert lines.field_data["nearest"][0] > 0.5
    assert lines.field_data["closed"][0] > 10
    assert not {"u", "v"} & set(lines.point_data)
    told = vizlight.provenance(lines)["options"]
    assert (told["tangents"], told["line_field"]) == (["u", "v"], True)


def test_two_lines_of_a_cross_field_start_at_a_point():
    seeds = np.array([[1.39, 0, 0.1], [0, 0.98, 0.4]])
    cross = {"tangents": ["u", "v"], "line_field": True, "max_length": 1.0}
    lines = streamlines(wheel(), SCENE, seeds=seeds, **cross)
    _, parallel, error = families(lines)
    assert error.max() < 0.01
    np.testing.assert_array_equal(np.sort(parallel.reshape(2, 2), axis=1), [[0, 1], [0, 1]])
    assert streamlines(wheel(), SCENE, seeds=9, **cross).n_lines == 9


def test_a_cross_field_in_a_volume():
    grid = pv.ImageData(dimensions=(9, 9, 9), spacing=(0.125, 0.125, 0.125))
    random = np.random.default_rng(0)
    swap = random.random((grid.n_points, 1)) < 0.5
    x, y = np.array([1.0, 0, 0]), np.array([0.3, 2.0, 0])
    grid["u"], grid["v"] = np.where(swap, x, -y), np.where(swap, y, -x)
    seeds = [[0.3, 0.4, 0.52]]
    lines = streamlines(grid, SCENE, tangents=("u", "v"), line_field=True, seeds=seeds)
    ends = np.sort([np.abs(p[-1] - p[0]) for p in parts(lines)], axis=0)
    np.testing.assert_allclose(ends, [[0.15, 0, 0], [1, 1, 0]], atol=1e-5)


def bad_cross_fields(vectors, options):
    mesh = wheel(9)
    mesh["D"] = np.ones((mesh.n_points, 6))
    streamlines(mesh, SCENE, tangents=vectors, **{"line_field": True} | options)


test_bad_cross_fields = refusals(
    bad_cross_fields,
    (("u", "v"), {"line_field": False}, "line_field: expected True .* pass line_field=True"),
    (("u", "v", "u"), {}, "tangents: expected one name .*, got 3 names"),
    (("u", "w"), {}, "tangents: expected the name .*'u', 'v'.*got 'w'"),
    (("u", "u"), {}, "tangents: expected different arrays, got 'u'"),
    (("u", 3), {}, "tangents: expected the names of two point arrays", TypeError),
    (("u", "D"), {}, "tangents: expected .*3 components"),
    (
        ("u", "v"),
        {"surface": pv.Sphere(), "confined": True},
        "tangents: expected two point arrays of the surface, got 'u'; attach both",
    ),
)


def test_two_components_have_no_third():
    mesh = pv.Plane(i_resolution=20, j_resolution=20)
    mesh["U"] = np.asarray(mesh.points)[:, :2] @ [[0, 1], [-1, 0]]
    lines = streamlines(mesh, SCENE, tangents="U", seeds=[[0.3, 0, 0]])
    np.testing.assert_allclose(np.linalg.norm(lines.points, axis=1), 0.3, atol=1e-2)
    assert mesh["U"].shape[1] == 2


def test_a_cloud_has_no_cells():
    cloud = pv.PolyData(np.random.default_rng(0).random((20, 3)))
    cloud["U"] = np.asarray(cloud.points)
    with pytest.raises(ValueError, match="mesh: expected a mesh with cells, got vertices alone"):
        streamlines(cloud, SCENE, tangents="U", seeds=5)


@pytest.mark.parametrize("kind", ["image", "rectilinear"])
def test_flat_grids_are_surfaces(kind):
    grid = pv.ImageData(dimensions=(21, 21, 1), spacing=(0.05, 0.05, 1))
    grid = grid if kind == "image" else grid.cast_to_rectilinear_grid()
    x, y = np.asarray(grid.points)[:, :2].T
    grid["V"] = np.stack([0.5 - y, x - 0.5, 0 * x], axis=1)
    lines = streamlines(grid, SCENE, tangents="V", spacing=0.1)
    assert lines.field_data["largest_gap"][0] < 1.5
    # Vectors are no heights: such a grid is flat below the sky.
    np.testing.assert_allclose(vizlight.sky(grid)["sky"], 1, atol=0.02)


def test_strokes_that_travel_have_whole_lines_and_need_a_length_and_a_sense():
    plane = pv.Plane(i_resolution=20, j_resolution=20)
    plane["V"] = np.tile([3.0, 0, 0], (plane.n_points, 1))
    made = vizlight.streamlines(plane, tangents="V", spacing=0.2, stroke_length=0.25, travel=2.0)
    assert {"width", "phase", "passing", "grown"} <= set(made.point_data)
    assert made.field_data["period"][0] == pytest.approx(2 * 0.25 / 3)
    assert np.all(made["passing"] == 2)
    # The gaps between curves tell nothing of strokes, which are parts of them.
    assert not {"largest_gap", "nearest"} & set(made.field_data.keys())
    with pytest.raises(ValueError, match="travel: expected stroke_length beside it"):
        vizlight.streamlines(plane, tangents="V", travel=2.0)
    with pytest.raises(ValueError, match="travel: expected vectors, which have a sense"):
        vizlight.streamlines(
            plane, tangents="V", line_field=True, stroke_length=0.2, spacing=0.2, travel=2.0
        )
