"""Triangles as VTK draws them, some at a time, against VTK's own filters."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.mesh.subdivision import simplices
from vizlight.vtk import drawn
from vizlight.vtk.drawn import DrawnCells, DrawnSegments, DrawnTriangles


def polygons():
    """Return a surface of a vertex, a line, polygons of 3 to 6 corners and 2, and a strip."""
    angles = [np.linspace(0, 2 * np.pi, n, endpoint=False) for n in (4, 3, 6, 4, 5, 3)]
    rings = [np.column_stack([3 * i + np.cos(a), np.sin(a), 0 * a]) for i, a in enumerate(angles)]
    # A fan would leave a dented pentagon.
    rings[4][2] *= (1, -0.2, 1)
    ends = np.cumsum([0, *map(len, rings)])
    faces = [[len(r), *range(a, a + len(r))] for a, r in zip(ends, rings, strict=False)]
    faces.insert(2, [2, 0, 1])
    strip = [4, 0, 1, 2, 3]
    return pv.PolyData(
        np.concatenate(rings), verts=[1, 0], lines=[2, 0, 5], faces=np.concatenate(faces),
        strips=strip,
    )  # fmt: skip


def areas(points, triangles):
    a, b, c = points[triangles].swapaxes(0, 1)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_polygons_of_any_corners_are_cut_as_vtk_cuts_them():
    mesh = polygons()
    found = DrawnTriangles(mesh)
    corners, cells = found[:], found.cells(slice(None))
    assert found.shape == corners.shape == (2 + 1 + 4 + 2 + 3 + 1 + 2, 3)
    np.testing.assert_array_equal(cells, np.repeat([2, 3, 5, 6, 7, 8, 9], [2, 1, 4, 2, 3, 1, 2]))
    of_cells = np.bincount(cells, areas(mesh.points, corners), mesh.n_cells)
    sizes = mesh.compute_cell_sizes(length=False, volume=False)["Area"]
    np.testing.assert_allclose(of_cells[2:9], sizes[2:9], rtol=1e-6)
    rows = np.array([14, 0, 5, 5])
    np.testing.assert_array_equal(found[rows], corners[rows])
    np.testing.assert_array_equal(found[3:7], corners[3:7])
    # Quadrilaterals are halved from their first corner, also where the other diagonal is shorter.
    np.testing.assert_array_equal(corners[:2], [[0, 1, 2], [0, 2, 3]])


def test_polygons_without_area_are_no_triangles():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.0]])
    found = DrawnTriangles(pv.PolyData(square, faces=[2, 0, 1, 3, 0, 1, 2]))
    np.testing.assert_array_equal(found[:], [[0, 1, 2]])
    np.testing.assert_array_equal(found.cells(np.array([0])), [1])


@pytest.mark.parametrize("entries", [1 << 20, 7])
def test_polygons_around_points_are_all_that_have_one(monkeypatch, entries):
    monkeypatch.setattr(drawn, "TABLE", entries)
    monkeypatch.setattr(drawn, "BLOCK", 50)
    ball, points = pv.Sphere(), np.array([17, 400, 401])
    for mesh in (ball, pv.Plane(), ball.merge(pv.Plane(i_resolution=20, j_resolution=20))):
        surface = mesh.extract_surface(algorithm=None)
        inside = points % surface.n_points
        faces = surface.irregular_faces
        expected = [i for i, face in enumerate(faces) if np.isin(face, inside).any()]
        found = DrawnTriangles(surface).around(inside)
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("size", [(4, 3, 1), (4, 1, 3), (1, 5, 2)])
def test_grids_of_one_layer_have_the_quadrilaterals_of_their_surface(size):
    image = pv.ImageData(dimensions=size)
    for grid in (image, image.cast_to_structured_grid(), image.cast_to_rectilinear_grid()):
        surface = grid.extract_surface(algorithm=None)
        quads = surface["vtkOriginalPointIds"][surface.regular_faces]
        found = DrawnTriangles.of(grid)
        ids, ends = found.corners(np.arange(found.polygons))
        np.testing.assert_array_equal(ids.reshape(-1, 4), quads)
        np.testing.assert_array_equal(np.diff(ends), 4)
        np.testing.assert_array_equal(found[3:5], [quads[1][[0, 2, 3]], quads[2][:3]])


def test_plain_polygons_of_a_grid_are_a_surface_and_other_meshes_are_not():
    plane = pv.Plane(i_resolution=3, j_resolution=2)
    grid = plane.cast_to_unstructured_grid()
    np.testing.assert_array_equal(DrawnTriangles.of(grid)[:], DrawnTriangles.of(plane)[:])
    both = DrawnTriangles.of(pv.merge([pv.Line().cast_to_unstructured_grid(), grid]))
    assert len(both) == 12
    assert (both.sizes(both.around(np.arange(9))) == 4).all()
    for mesh in (pv.ImageData(dimensions=(3, 3, 3)), pv.Line(), pv.PolyData(np.eye(3)),
                 pv.UnstructuredGrid(), pv.ImageData(dimensions=(5, 1, 1))):  # fmt: skip
        assert DrawnTriangles.of(mesh) is None


@pytest.mark.parametrize("sizes", [(4, 2, 3, 2), (3, 3), (2, 2, 2)])
def test_segments_are_those_of_each_line(sizes):
    ids = np.random.default_rng(0).permutation(sum(sizes))
    lines = [[len(x), *x] for x in np.split(ids, np.cumsum(sizes)[:-1])]
    mesh = pv.PolyData(np.zeros((sum(sizes), 3)), verts=[1, 0], lines=np.concatenate(lines))
    found, expected = DrawnSegments.of(mesh), simplices(mesh)
    assert found.shape == expected.shape
    assert found.may_join == (2 in sizes)
    np.testing.assert_array_equal(found[:], expected)
    np.testing.assert_array_equal(found[1:3], expected[1:3])
    np.testing.assert_array_equal(found[np.array([2, 0])], expected[[2, 0]])
    np.testing.assert_array_equal(found.sizes(np.array([1, 0])), [sizes[1], sizes[0]])


def test_lines_of_a_point_and_lines_beside_faces_have_no_segments_in_memory():
    mesh = pv.PolyData(np.eye(3), lines=[1, 0, 2, 1, 2])
    assert DrawnSegments.of(mesh) is None
    assert DrawnSegments.of(pv.Plane()) is None
    assert DrawnSegments.of(polygons()) is None


@pytest.mark.parametrize("marked", ["cells", "points"])
def test_hidden_cells_are_those_that_vtk_does_not_draw(marked):
    """VTK hides cells of grids of one layer, and draws those of surfaces, lines and flat cells."""
    image, random = pv.ImageData(dimensions=(6, 5, 1)), np.random.default_rng(0)
    plane = pv.Plane(i_resolution=5, j_resolution=4)
    lines = pv.PolyData(plane.points, lines=np.insert(plane.regular_faces, 0, 4, axis=1).ravel())
    grids = image, image.cast_to_structured_grid(), image.cast_to_rectilinear_grid()
    for mesh in (*grids, plane, plane.cast_to_unstructured_grid(), lines):
        mesh.clear_data()
        kind = DrawnSegments if mesh is lines else DrawnTriangles
        every = kind.of(mesh)[:]
        data, marks = mesh.cell_data, [0, 0, 0, 1, 2, 8, 32, 41]
        if marked == "points":
            data, marks = mesh.point_data, [0] * 9 + [1, 2, 3]
        count = mesh.n_points if marked == "points" else mesh.n_cells
        data["vtkGhostType"] = random.choice(marks, count).astype(np.uint8)
        found = kind.of(mesh)
        there = (found[:] != found[:][:, :1]).any(axis=1)
        np.testing.assert_array_equal(found[:][there], every[there])
        cells = np.unique(found.cells(slice(None))[there])
        np.testing.assert_array_equal(found.around(np.arange(mesh.n_points)), cells)
        if mesh in grids:
            surface = mesh.extract_surface(algorithm="geometry", pass_cellid=True)
            np.testing.assert_array_equal(cells, np.sort(surface["vtkOriginalCellIds"]))
            assert 5 < len(cells) < 18
        else:
            assert there.all()


def test_all_cells_of_a_mesh_have_their_corners():
    image = pv.ImageData(dimensions=(4, 3, 5))
    grid, surface = image.cast_to_unstructured_grid(), polygons()
    for mesh in (image, image.cast_to_structured_grid(), grid, surface):
        cells, corners = [], []
        for kind in DrawnCells.all_of(mesh):
            around = kind.around(np.arange(mesh.n_points))
            ids, ends = kind.corners(around)
            cells += kind.cells_of(around).tolist()
            corners += [set(some.tolist()) for some in np.split(ids, ends[1:-1])]
            block = kind.of_block(slice(0, 1))
            np.testing.assert_array_equal(block[0], ids[: ends[1]])
            np.testing.assert_array_equal(block[1], ends[:2])
        assert cells == list(range(mesh.n_cells))
        assert corners == [set(mesh.get_cell(i).point_ids) for i in cells]
