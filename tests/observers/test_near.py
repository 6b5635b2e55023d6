"""What is near some triangles of a large surface has the light of the whole of it."""

import dataclasses
from functools import partial

import numpy as np
import pytest
import pyvista as pv

import vizlight
from studies import peak_memory
from vizlight import Light, Scene, View
from vizlight.draw.sources import with_sharp_edges
from vizlight.mesh.subdivision import simplices
from vizlight.observers import legibility, samples
from vizlight.observers import near as near_cells
from vizlight.observers.near import near
from vizlight.shading.options import LightOptions
from vizlight.vtk.arrays import tangents_of
from vizlight.vtk.drawn import DrawnSegments, DrawnTriangles

FACES = "Triangle", "Quadrilateral"
SCENE = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(1, 2, 2)))


def slivers():
    """Return an isosurface through nodes of its grid."""
    grid = pv.ImageData(dimensions=(16, 16, 16), origin=(-7.5, -7.5, -7.5))
    grid["r"] = np.linalg.norm(grid.points, axis=1)
    level = grid["r"][np.ravel_multi_index((2, 5, 8), (16, 16, 16))]
    surface = grid.contour([level], scalars="r")
    surface.clear_data()
    return surface


def swirl(points):
    return points[:, [1, 0, 2]] * (-1, 1, 0) + 1.0


def flow():
    plane = pv.Plane(i_resolution=12, j_resolution=12)
    plane.points[:, 2] = 0.1 * np.sin(9 * plane.points[:, 0])
    plane.clear_data()
    plane.point_data["V"] = swirl(plane.points)
    plane.cell_data["W"] = swirl(plane.cell_centers().points)
    plane["u"], plane["v"] = plane["V"][:, 0], plane["V"][:, 1]
    return plane


def bare(mesh):
    mesh.clear_data()
    return mesh


def welded(mesh):
    """Return a surface with one point at each place, and faces that are wound both ways."""
    mesh = bare(mesh.clean().triangulate())
    first = mesh.irregular_faces
    faces = [np.insert(f if i % 3 else f[::-1], 0, len(f)) for i, f in enumerate(first)]
    return pv.PolyData(mesh.points, np.concatenate(faces))


def grid():
    x, y = np.meshgrid(np.linspace(0, 3, 20), np.linspace(0, 2, 16), indexing="ij")
    return pv.StructuredGrid(x, y, 0.3 * np.sin(2 * x) * np.cos(3 * y))


CASES = {
    "slivers": (slivers, {}),
    "edges": (lambda: welded(pv.Box(level=6)), {"feature_angle": "auto"}),
    "rims": (lambda: welded(pv.Cylinder(resolution=24)), {"feature_angle": 30.0}),
    "normals": (pv.Sphere, {"feature_angle": "auto"}),
    "given": (flow, {"normals": "V"}),
    "vectors": (flow, {"tangents": "V"}),
    "cells": (lambda: flow().cast_to_unstructured_grid(), {"tangents": "W"}),
    "names": (flow, {"tangents": "u,v"}),
    "rows": (flow, {"tangents": np.random.default_rng(0).normal(size=(169, 3))}),
    "grid": (grid, {"feature_angle": 1.0}),
}


def both(monkeypatch, mesh, light, **how):
    """Return a mesh as a whole, and as one whose surroundings are made near what is read."""
    parts = []
    for whole in (1 << 17, 0):
        monkeypatch.setattr(samples, "WHOLE", whole)
        parts.append(samples.part_on(mesh, SCENE, light, **how))
    return parts


def assert_alike(parts, *names, atol=2e-6):
    """Assert that the inputs at the cells of parts are alike, but for their sides."""
    for name in names:
        rows, expected = (getattr(part.inputs, name)[:][part.cells[:]] for part in parts)
        np.testing.assert_allclose(np.abs(rows), np.abs(expected), atol=atol)


def in_order(part, chosen=slice(None)):
    """Return a part with the corners of some triangles in the order of their places."""
    cells = part.cells[chosen]
    order = np.argsort(part.mesh.points[cells] @ (1, np.sqrt(2), np.pi), axis=1)
    return dataclasses.replace(part, cells=np.take_along_axis(cells, order, axis=1))


@pytest.mark.parametrize("name", CASES)
def test_inputs_near_triangles_are_those_of_the_whole(name, monkeypatch):
    make, how = CASES[name]
    mesh, light = make(), LightOptions(**how)
    chosen = np.random.default_rng(1).permutation(len(DrawnTriangles.of(mesh)))[:30]
    # Without sharp edges the whole has its own points.
    split = with_sharp_edges(mesh, light)
    whole = samples.part_on(split, SCENE, light)
    monkeypatch.setattr(samples, "WHOLE", 0)
    part = samples.part_on(mesh, SCENE, light)
    assert part.inputs.normals is None
    assert part.has_tangents == whole.has_tangents
    found = part.near(chosen)
    assert found.mesh.n_points < whole.mesh.n_points or name in ("edges", "rims", "slivers")
    found, same = in_order(found), in_order(whole, chosen).cells
    np.testing.assert_array_equal(found.mesh.points[found.cells], split.points[same])
    normals, expected = (
        p.inputs.sides().normals[cells] for p, cells in ((found, found.cells), (whole, same))
    )
    turned = np.sign(np.einsum("ijk,ijk->i", normals, expected))[:, np.newaxis, np.newaxis]
    # Of a triangle all normals are on one side; which is not known near it.
    np.testing.assert_allclose(turned * normals, expected, atol=2e-6)
    if part.has_tangents:
        rows = found.inputs.tangents[:][found.cells]
        np.testing.assert_allclose(rows, whole.inputs.tangents[:][same], atol=1e-6)
        assert found.inputs.line_field == whole.inputs.line_field


@pytest.mark.parametrize("flat", [False, True])
def test_values_go_with_the_points_or_the_cells(flat, monkeypatch):
    monkeypatch.setattr(samples, "WHOLE", 0)
    mesh = bare(pv.Box(level=3))
    values = np.arange(mesh.n_cells if flat else mesh.n_points, dtype=float)
    light = LightOptions(feature_angle="auto")
    part = samples.part_on(mesh, SCENE, light, values=values, flat=flat)
    chosen = np.array([7, 1, 100])
    found = part.near(chosen)
    if flat:
        np.testing.assert_array_equal(found.values, chosen // 2)
    else:
        points = mesh.points[found.values.astype(int)]
        np.testing.assert_array_equal(points, found.mesh.points)


def test_wrong_arrays_are_refused_near_triangles_too(monkeypatch):
    monkeypatch.setattr(samples, "WHOLE", 0)
    mesh = flow()
    for how, words in (
        ({"tangents": "X"}, "tangents: expected the name"),
        ({"tangents": np.ones((3, 3))}, "tangents: expected 169 rows"),
        ({"normals": "u"}, "normals: expected vectors"),
    ):
        part = samples.part_on(mesh, SCENE, LightOptions(**how), "block 2")
        with pytest.raises(ValueError, match=words):
            part.near(np.array([3]))


def test_colors_without_light_need_no_normals(monkeypatch):
    for whole in (1 << 17, 0):
        monkeypatch.setattr(samples, "WHOLE", whole)
        part = samples.part_on(pv.Sphere(), SCENE, LightOptions(), lit=False)
        assert part.near(np.array([3, 5])).inputs.normals is None


def curls(*sizes):
    """Return curved lines that have some points in common, the last closed."""
    points = np.random.default_rng(3).normal(size=(60, 3)).cumsum(axis=0)
    ids = [np.random.default_rng(size).permutation(60)[:size] for size in sizes]
    ids[-1][-1] = ids[-1][0]
    return pv.PolyData(points, lines=np.concatenate([[len(x), *x] for x in ids]))


@pytest.mark.parametrize("block", [1, 40, 1 << 16])
def test_tangents_of_lines_are_those_of_the_whole(block, monkeypatch):
    mesh = curls(20, 3, 30, 12, 25)
    mesh["v"] = np.arange(60.0)
    chosen = np.array([80, 3, 4, 20, 3])
    monkeypatch.setattr(near_cells, "BLOCK", block)
    whole, part = both(monkeypatch, mesh, LightOptions(line_field=True), values=mesh["v"])
    assert part.inputs.tangents is None
    assert part.has_tangents
    whole, part = whole.near(chosen), part.near(chosen)
    assert part.inputs.line_field
    for rows, expected in (
        (part.inputs.tangents, whole.inputs.tangents),
        (part.inputs.points, whole.inputs.points),
        (part.values, whole.values),
    ):
        np.testing.assert_array_equal(rows[part.cells], expected[whole.cells])


@pytest.mark.parametrize("how", [{"tangents": "V"}, {"positions": "V"}, {"conditioned": True}, {}])
def test_tangents_that_are_given_or_joined_are_those_of_the_whole(how, monkeypatch):
    monkeypatch.setattr(samples, "WHOLE", 0)
    mesh = curls(20, 30) if how else curls(20, 2, 30)
    mesh["V"] = mesh.points[::-1].copy()
    mesh.point_data.active_normals_name = "V"
    assert samples.part_on(mesh, SCENE, LightOptions(**how)).inputs.tangents is not None


def scan():
    """Return points around a ball, no two pairs of which are equally far apart."""
    ball = bare(pv.Sphere(theta_resolution=40, phi_resolution=30))
    noise = np.random.default_rng(0).normal(0, 3e-3, ball.points.shape)
    return pv.PolyData(np.asarray(ball.points) + noise)


@pytest.mark.parametrize("block", [37, 1 << 16])
def test_neighbours_are_the_nearest_of_all_points(block, monkeypatch):
    monkeypatch.setattr(near_cells, "BLOCK", block)
    points = np.random.default_rng(2).normal(size=(900, 3))
    points[[5, 700], 1] = np.nan, np.inf
    ids = np.arange(0, 900, 23)
    far = np.linalg.norm(points[:, None] - points[ids], axis=2)
    expected = np.unique(np.argsort(np.where(np.isfinite(far), far, np.inf), axis=0)[:7])
    np.testing.assert_array_equal(near_cells.neighbours(points, ids, 7), expected)
    # Fewer points than neighbours are all of them.
    assert len(near_cells.neighbours(points[:6], ids[:1], 7)) == 5


def test_normals_of_points_of_a_scan_are_those_of_the_whole(monkeypatch):
    mesh, chosen = scan(), np.array([8, 900, 3])
    mesh["v"] = np.arange(float(mesh.n_points))
    whole, part = both(monkeypatch, mesh, LightOptions(), values=mesh["v"])
    assert part.inputs.normals is None
    found = part.near(chosen)
    assert found.mesh.n_points < 40
    rows = found.cells[:, 0]
    np.testing.assert_array_equal(found.values[rows], chosen)
    np.testing.assert_array_equal(found.mesh.points[rows], mesh.points[chosen])
    assert_alike((found, whole.near(chosen)), "normals", atol=1e-6)
    assert samples.part_on(mesh, SCENE, LightOptions(), lit=False).inputs.normals is None
    mesh["n"] = np.asarray(mesh.points)
    mesh.point_data.active_normals_name = "n"
    assert samples.part_on(mesh, SCENE, LightOptions()).inputs.normals is not None


def test_many_solid_cells_are_split_on_their_surface_with_the_colours_of_their_cells(monkeypatch):
    monkeypatch.setattr(legibility, "WHOLE", 0)
    ball = pv.SolidSphere(theta_resolution=20, phi_resolution=20, radius_resolution=3)
    ball.clear_data()
    ball.cell_data["c"] = np.arange(ball.n_cells)
    smooth = LightOptions(feature_angle=None)
    split = legibility._split(ball, smooth)
    assert isinstance(split, pv.PolyData)
    surface = ball.extract_surface(algorithm="geometry")
    assert dict(zip(map(tuple, split.cell_centers().points), split["c"], strict=True)) == dict(
        zip(map(tuple, surface.cell_centers().points), surface["c"], strict=True)
    )


def test_many_solid_cells_with_conditioned_vectors_are_split_as_their_surface_is(monkeypatch):
    light = LightOptions(tangents="W", conditioned=True, feature_angle="auto")
    cube = with_vectors(pv.ImageData(dimensions=(4, 5, 6)).cast_to_unstructured_grid())
    ball = with_vectors(pv.SolidSphere(theta_resolution=30, phi_resolution=30, radius_resolution=3))
    whole = [legibility._split(mesh, light) for mesh in (cube, ball)]
    monkeypatch.setattr(legibility, "WHOLE", 0)
    split, same = (legibility._split(mesh, light) for mesh in (cube, ball))
    # Of a ball no point is split, and the means are those of the cells inside too.
    assert same is whole[1] is ball
    assert split.n_points == whole[0].n_points > 120 - 2 * 3 * 4
    rows, expected = (
        np.column_stack([mesh.points, tangents_of(mesh, "W", 3)]) for mesh in (split, whole[0])
    )
    order, other = (np.lexsort(np.round(x, 6).T) for x in (rows, expected))
    np.testing.assert_allclose(rows[order], expected[other], atol=1e-9)


@pytest.mark.parametrize("whole", [0, samples.WHOLE])
def test_colours_of_cells_go_with_their_faces_and_lines(whole, monkeypatch):
    monkeypatch.setattr(samples, "WHOLE", whole)
    image = pv.ImageData(dimensions=(4, 3, 5))
    lines = pv.PolyData()
    lines.points = np.random.default_rng(0).random((9, 3))
    lines.verts, lines.lines = [1, 0], [4, 0, 1, 2, 3, 3, 4, 5, 6, 2, 7, 8]
    for mesh in (image, image.cast_to_unstructured_grid(), image.to_tetrahedra(5), lines):
        middles = np.asarray(mesh.cell_centers().points)
        values = middles @ (1.0, 10.0, 100.0)
        part = samples.part_on(mesh, SCENE, LightOptions(), values=values, flat=True, lit=False)
        found = part.near(np.arange(len(part.cells)))
        points = part.inputs.points[:][part.cells[:]]
        for corners, value in zip(points, found.values, strict=True):
            cell = np.asarray(mesh.get_cell(int(np.flatnonzero(values == value)[0])).points)
            for corner in corners:
                assert np.abs(cell - corner).sum(axis=1).min() == 0
    # Cells of no surface have the means at their points.
    cloud = pv.PolyData(lines.points)
    part = samples.part_on(
        cloud, SCENE, LightOptions(), values=np.arange(9.0), flat=True, lit=False
    )
    assert not part.flat
    np.testing.assert_array_equal(part.values, np.arange(9.0))


def test_tangents_of_single_segments_are_those_of_the_joined_lines(monkeypatch):
    ball = bare(pv.Sphere())
    ball["z"] = np.sin(4 * ball.points[:, 0]) + np.cos(3 * ball.points[:, 1])
    mesh = bare(ball.contour(6, scalars="z"))
    # Points that repeat, as where an isoline goes through a point of its surface.
    ids = mesh.lines.reshape(-1, 3)[:, 1:]
    mesh.points[ids[40, 1]] = mesh.points[ids[40, 0]]
    chosen = np.array([4, 39, 41, 200])
    monkeypatch.setattr(near_cells, "BLOCK", 3)
    whole, part = both(monkeypatch, mesh, LightOptions())
    assert part.inputs.tangents is None
    found, same = part.near(chosen), whole.near(chosen)
    rows, expected = (p.inputs.tangents[:][p.cells] for p in (found, same))
    sign = np.sign(np.einsum("ijk,ijk->i", rows, expected))[:, np.newaxis, np.newaxis]
    np.testing.assert_array_equal(sign * rows, expected)
    assert found.mesh.n_points == mesh.n_points


def test_points_that_repeat_along_single_segments_have_the_tangent_of_the_whole(monkeypatch):
    ids, points = np.arange(14), curls(14).points[:14].copy()
    points[5:8] = points[4]
    mesh = pv.PolyData(points, lines=np.column_stack([0 * ids[1:] + 2, ids[:-1], ids[1:]]).ravel())
    parts = [part.near(np.array([3])) for part in both(monkeypatch, mesh, LightOptions())]
    assert_alike(parts, "tangents", atol=0)


MATRIX = np.array([[0.8, -0.6, 0, 3], [0.6, 0.8, 0, -1], [0, 0.3, 2, 0], [0, 0, 0, 1.0]])


def curls_with_vectors():
    lines = curls(20, 3, 30)
    lines["V"] = np.random.default_rng(2).normal(size=(lines.n_points, 3))
    return lines


@pytest.mark.parametrize(
    ("make", "lit"),
    [(flow, True), (scan, True), (scan, False), (lambda: curls(20, 3, 30), True),
     (curls_with_vectors, True)],
)  # fmt: skip
def test_a_large_mesh_is_moved_near_the_places_that_are_read(make, lit, monkeypatch):
    mesh, chosen = make(), np.array([3, 20])
    light = LightOptions(tangents="V" if "V" in mesh.array_names else None)
    whole, part = both(monkeypatch, mesh, light, matrix=MATRIX, lit=lit)
    assert part.mesh is mesh
    expected = np.asarray(whole.drawn.points[:])
    np.testing.assert_allclose(part.drawn.points[:], expected, atol=1e-6)
    found, same = part.near(chosen), whole.near(chosen)
    for name in ("points", "tangents", "normals"):
        rows, others = (getattr(p.inputs, name) for p in (found, same))
        assert (rows is None) == (others is None)
        if rows is not None:
            assert_alike((found, same), name)


def test_solid_cells_are_read_on_their_surface_with_the_rows_of_their_arrays():
    image = pv.ImageData(dimensions=(5, 4, 6))
    grid = image.cast_to_unstructured_grid()
    vectors = np.random.default_rng(1).normal(size=(grid.n_points, 3))
    values = np.arange(float(grid.n_points))
    for mesh in (image, grid):
        part = samples.part_on(mesh, SCENE, LightOptions(tangents=vectors), values=values)
        rows = part.values.astype(int)
        assert part.mesh.n_points == 120 - 3 * 2 * 4
        np.testing.assert_array_equal(part.mesh.points, grid.points[rows])
        np.testing.assert_array_equal(part.inputs.tangents[:], vectors[rows])
        assert part.cells.shape == (2 * 2 * (4 * 3 + 3 * 5 + 4 * 5), 3)


def solids():
    image = pv.ImageData(dimensions=(6, 5, 7))
    grids = image, image.cast_to_structured_grid(), image.to_tetrahedra(5)
    explicit = pv.ExplicitStructuredGrid(image.cast_to_structured_grid())
    return [*grids, image.cast_to_unstructured_grid(), explicit]


def with_vectors(mesh):
    """Return a mesh with vectors of its cells, also by components."""
    mesh.clear_data()
    mesh.cell_data["W"] = np.random.default_rng(1).normal(size=(mesh.n_cells, 3))
    for i, name in enumerate("uvw"):
        mesh.cell_data[name] = np.array(mesh.cell_data["W"][:, i])
    return mesh


@pytest.mark.parametrize("name", ["W", "u,v,w"])
def test_tangents_of_solid_cells_are_means_of_those_inside_too(name):
    for mesh in map(with_vectors, solids()):
        values = np.arange(float(mesh.n_points))
        part = samples.part_on(mesh, SCENE, LightOptions(tangents=name), values=values)
        assert part.mesh.n_points == len(part.values) == 210 - 4 * 3 * 5
        expected = tangents_of(mesh, name, 3)[part.values.astype(int)]
        np.testing.assert_allclose(part.inputs.tangents[:], expected, atol=1e-12)
        assert part.inputs.line_field == (name == "W")
        conditioned = LightOptions(tangents=name, conditioned=True)
        same = samples.part_on(mesh, SCENE, conditioned)
        for rows in ("points", "tangents", "normals"):
            np.testing.assert_array_equal(
                getattr(same.inputs, rows)[:], getattr(part.inputs, rows)[:]
            )
    mesh.cell_data["W"] = np.ones((mesh.n_cells, 4))
    with pytest.raises(ValueError, match="block 2: tangents: expected a point array of 3"):
        samples.part_on(mesh, SCENE, LightOptions(tangents="W"), "block 2")


@pytest.mark.parametrize("marks", [[1, 8], [1, 2, 8, 32, 33], [32] * 40])
def test_means_at_points_of_a_structured_grid_leave_blank_cells_out(marks, monkeypatch):
    mesh = with_vectors(pv.ImageData(dimensions=(6, 5, 7)).cast_to_structured_grid())
    random = np.random.default_rng(2)
    mesh.cell_data["vtkGhostType"] = random.choice([0] * 20 + marks, mesh.n_cells).astype(np.uint8)
    points, expected = np.arange(3, mesh.n_points), tangents_of(mesh, "W", 3)[3:]
    for block in (near_cells.BLOCK, 40):
        monkeypatch.setattr(near_cells, "BLOCK", block)
        parts = list(near_cells.stars(mesh, points, LightOptions(tangents="W")))
        assert max(part.n_cells for part, _ in parts) < block + 8
        tangents = np.concatenate([tangents_of(part, own.tangents, 3) for part, own in parts])
        np.testing.assert_allclose(np.abs(tangents), np.abs(expected), atol=1e-9)


@pytest.mark.parametrize("name", ["W", "u,v,w"])
@pytest.mark.parametrize("block", [20, 1 << 16])
def test_tangents_of_the_cells_of_lines_and_points_are_those_of_the_whole(name, block, monkeypatch):
    lines, points = curls(20, 3, 2, 30), np.random.default_rng(1).normal(size=(60, 3))
    mixed = pv.PolyData(lines.points, verts=np.insert(np.arange(9), range(9), 1), lines=lines.lines)
    monkeypatch.setattr(near_cells, "BLOCK", block)
    for mesh in map(with_vectors, (lines, mixed, pv.PolyData(points))):
        light, values = LightOptions(tangents=name), np.arange(60.0)
        for matrix in (None, MATRIX):
            whole, part = both(monkeypatch, mesh, light, values=values, matrix=matrix)
            assert part.inputs.tangents is None
            assert part.has_tangents
            chosen = np.array([40, 3, 4, 20, 3])
            found, same = part.near(chosen), whole.near(chosen)
            assert found.inputs.line_field == whole.inputs.line_field == (name == "W")
            np.testing.assert_array_equal(found.values[found.cells], same.values[same.cells])
            for rows in ("points", "tangents"):
                near_rows, whole_rows = (
                    getattr(p.inputs, rows)[:][p.cells].reshape(-1, 3) for p in (found, same)
                )
                np.testing.assert_allclose(near_rows, whole_rows, atol=1e-6)
            if part.kind == "line":
                ahead = part.ahead(chosen)
                np.testing.assert_array_equal(ahead, whole.ahead(chosen))
                # Means of cells have no sign, and those of components have.
                assert ahead.any() == (name != "W")
    lines["n"] = np.asarray(lines.points)
    for how in ({"conditioned": True, "normals": "n"}, {"conditioned": "n"}):
        parts = both(monkeypatch, lines, LightOptions(tangents=name, **how))
        assert [part.inputs.tangents is None for part in parts] == [False, True]
        parts = [part.near(chosen) for part in parts]
        names = "tangents", "normals" if "normals" in how else "base_tangents"
        assert_alike(parts, *names, atol=1e-6)
    with pytest.raises(ValueError, match="without faces"):
        samples.part_on(lines, SCENE, LightOptions(tangents=name, conditioned=True))


@pytest.mark.parametrize("kind", [k + n for k in ("Quadratic", "BiQuadratic") for n in FACES])
def test_curved_faces_are_near_what_they_are_in_the_whole(kind, monkeypatch):
    cell = getattr(pv.examples.cells, kind)()
    cells = [cell.translate((i, j, 0.2 * i * j)) for i in range(3) for j in range(3)]
    mesh = with_vectors(pv.merge(cells, merge_points=True).cast_to_unstructured_grid())
    mesh.points[:, 2] += 0.2 * np.sin(5 * mesh.points[:, 0])
    np.testing.assert_array_equal(DrawnTriangles.of(mesh)[:], simplices(mesh))
    for light in (LightOptions(tangents="W"), LightOptions(tangents="u,v,w"), LightOptions()):
        parts = both(monkeypatch, mesh, light, values=np.arange(9.0), flat=True)
        assert [part.large for part in parts] == [False, True]
        parts = [part.near(np.arange(len(part.cells))[::-2]) for part in parts]
        np.testing.assert_array_equal(parts[0].values, parts[1].values)
        names = ("points", "normals", "tangents")[: 2 + (light.tangents is not None)]
        assert_alike(parts, *names)


@pytest.mark.parametrize("name", ["W", "u,v,w"])
def test_faces_beside_lines_are_near_what_they_are_in_the_whole(name, monkeypatch):
    plane = flow()
    rim = pv.PolyData(plane.points, lines=[2, 0, 1, 2, 40, 70, 2, 70, 71, 2, 100, 20])
    plane.lines = rim.lines
    grid = pv.merge([flow().cast_to_unstructured_grid(), rim.cast_to_unstructured_grid()])
    light, chosen = LightOptions(tangents=name), np.arange(0, 288, 7)
    for mesh in map(with_vectors, (plane, grid)):
        values = np.arange(float(mesh.n_cells))
        parts = both(monkeypatch, mesh, light, values=values, flat=True)
        assert [part.large for part in parts] == [False, True]
        parts = [part.near(chosen) for part in parts]
        np.testing.assert_array_equal(parts[0].values, parts[1].values)
        assert_alike(parts, "points", "tangents", "normals")
        assert parts[0].inputs.line_field == parts[1].inputs.line_field == (name == "W")


@pytest.mark.parametrize("name", ["W", "u,v,w"])
def test_a_moved_mesh_has_the_means_of_its_cells(name):
    for mesh in (*solids()[:3], pv.Plane(i_resolution=4, j_resolution=3), curls(20, 3)):
        with_vectors(mesh)
        part = samples.part_on(mesh, SCENE, LightOptions(tangents=name), matrix=MATRIX)
        origin = np.arange(mesh.n_points)
        if part.mesh.n_points < mesh.n_points:
            origin = samples.hull.outer_faces(mesh)[1]
        expected = tangents_of(mesh, name, 3)[origin] @ MATRIX[:3, :3].T
        np.testing.assert_allclose(part.inputs.tangents[:], expected, atol=1e-6)
        assert part.inputs.line_field == (name == "W")


@pytest.mark.parametrize("marked", ["cells", "points"])
def test_the_surroundings_of_hidden_cells_are_those_of_the_whole(marked, monkeypatch):
    mesh, random = with_vectors(grid()), np.random.default_rng(0)
    data, count = mesh.cell_data, mesh.n_cells
    if marked == "points":
        data, count = mesh.point_data, mesh.n_points
    data["vtkGhostType"] = random.choice([0] * 25 + [1, 2, 8, 32], count).astype(np.uint8)
    whole, part = both(monkeypatch, mesh, LightOptions(tangents="W"))
    corners = part.cells[:]
    chosen = random.permutation(np.flatnonzero((corners != corners[:, :1]).any(axis=1)))[:99]
    found = part.near(chosen)
    assert_alike((found, whole.near(chosen)), "tangents", "normals")
    assert found.inputs.line_field


def test_memory_goes_by_the_points_and_not_by_the_cells_around_them():
    grid = pv.ImageData(dimensions=(60, 60, 60)).cast_to_unstructured_grid()
    grid.cell_data["W"] = np.ones((grid.n_cells, 3), np.float32)
    light, points = LightOptions(tangents="W"), np.arange(0, grid.n_points, 9000)
    near_cells.around_points(grid, points, light)
    assert peak_memory(partial(near_cells.around_points, grid, points, light)) < 10e6


def test_options_that_do_not_fit_lines_are_refused_near_their_segments_too(monkeypatch):
    monkeypatch.setattr(samples, "WHOLE", 0)
    part = samples.part_on(curls(20, 30), SCENE, LightOptions(normals="V"), "block 2")
    with pytest.raises(ValueError, match="block 2: normals: expected no normals"):
        part.near(np.array([3]))


@pytest.mark.opengl
def test_a_large_surface_is_read_like_a_small_one(monkeypatch):
    mesh, scene = bare(pv.Box(level=20)), vizlight.presets.shape()
    found = []
    for whole in (1 << 17, 0):
        monkeypatch.setattr(samples, "WHOLE", whole)
        found.append(vizlight.legibility(mesh, scene, samples=128, size_mm=30))
    assert found[0] == found[1]


def curved(n):
    """Return an uneven sheet of biquadratic faces, on 2 n + 1 rows of nodes."""
    i = np.arange((2 * n + 1) ** 2).reshape(2 * n + 1, -1)
    steps = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    nodes = np.stack([i[a : a + 2 * n : 2, b : b + 2 * n : 2] for a, b in steps], axis=-1)
    x, y = np.divmod(i.ravel(), 2 * n + 1) / np.float64(n)
    points = np.column_stack([x, y, 0.1 * np.sin(9 * x)])
    return pv.UnstructuredGrid({pv.CellType.BIQUADRATIC_QUAD: nodes.reshape(-1, 9)}, points)


def with_segment(mesh):
    faces = mesh.regular_faces
    return pv.UnstructuredGrid({9: faces, 3: np.array([[0, 1]])}, mesh.points)


def test_memory_goes_by_the_triangles_and_not_by_the_surface():
    plane = bare(pv.Plane(i_resolution=400, j_resolution=400))
    for mesh in (plane, with_segment(plane), curved(200)):
        surface = DrawnTriangles.of(mesh)
        near(mesh, surface, np.array([3]), LightOptions())
        some = np.arange(0, len(surface), 9000)
        # A table of a megabyte, and blocks of 2^16 polygons, whose corners may be made.
        assert peak_memory(partial(near, mesh, surface, some, LightOptions())) < 13e6


def test_memory_goes_by_the_segments_and_not_by_the_lines():
    ids = np.arange(1 << 19).reshape(-1, 1 << 12)
    mesh = pv.PolyData()
    mesh.points = np.random.default_rng(0).random((ids.size, 3), dtype=np.float32)
    mesh.lines = np.insert(ids, 0, ids.shape[1], axis=1).ravel()
    lines = DrawnSegments.of(mesh)
    tangents = partial(near_cells.tangents_at, mesh, lines, ids[:, 3])
    assert peak_memory(lambda: tangents(lambda part: np.asarray(part.points))) < 16e6
