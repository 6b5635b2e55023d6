"""Splits of segments and triangles: what is covered, what is shared, what is refused."""

import numpy as np
import pytest
import pyvista as pv
from vectors import areas

from vizlight.mesh import subdivision
from vizlight.mesh.subdivision import SplitCells


def split_at_random(points, cells, random, rounds=6):
    """Return cells whose edges are split at random, and the points of the result."""
    parts, fresh = SplitCells(points, cells), np.arange(len(cells))
    for _ in range(rounds):
        codes = np.unique(parts.edges(fresh)[0])
        chosen = np.sort(random.choice(codes, max(len(codes) // 4, 1), replace=False))
        fresh = parts.split(chosen, random.uniform(0.2, 0.8, len(chosen)))
    return parts, parts.shares() @ points


def test_triangles_stay_conforming_and_cover_their_cells(random):
    mesh = pv.Icosphere(nsub=1)
    points, cells = np.asarray(mesh.points, dtype=np.float64), mesh.regular_faces
    parts, places = split_at_random(points, cells, random)
    assert len(parts.corners) > 3 * len(cells)
    assert np.array_equal(places[: len(points)], points)
    made = pv.PolyData.from_regular_faces(places, parts.corners)
    assert made.n_open_edges == 0
    assert made.is_manifold
    covered = np.bincount(parts.parent, areas(places[parts.corners]))
    np.testing.assert_allclose(covered, areas(points[cells]), rtol=1e-12)
    assert areas(places[parts.corners]).min() > 0
    # The faces keep their side.
    normal = np.cross(*(places[parts.corners[:, i]] - places[parts.corners[:, 0]] for i in (1, 2)))
    middle = places[parts.corners].mean(axis=1)
    assert np.einsum("ij,ij->i", normal, middle).min() > 0


def test_no_point_lies_on_an_edge_of_another_part(random):
    """A T-junction would be a point on the inner side of an edge."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    parts, places = split_at_random(points, np.array([[0, 1, 2], [0, 2, 3]]), random, 5)
    start, stop = parts.corners.ravel(), np.roll(parts.corners, -1, axis=1).ravel()
    for point in range(len(places)):
        way, gap = places[stop] - places[start], places[point] - places[start]
        along = np.einsum("ij,ij->i", gap, way) / np.einsum("ij,ij->i", way, way)
        off = np.linalg.norm(gap - along[:, None] * way, axis=1)
        assert not np.any((off < 1e-9) & (along > 1e-6) & (along < 1 - 1e-6))


def test_twins_are_split_at_the_same_places(random):
    """Triangles that share no point, but places, have the same new places on their edges."""
    mesh = pv.Icosphere(nsub=1)
    corners = mesh.regular_faces
    points = np.asarray(mesh.points, dtype=np.float64)[corners.ravel()]
    parts, places = split_at_random(points, np.arange(corners.size).reshape(-1, 3), random)
    made = pv.PolyData.from_regular_faces(places, parts.corners).clean(tolerance=1e-9)
    assert made.n_open_edges == 0
    assert made.is_manifold


def test_shares_are_those_of_the_corners_of_a_cell(random):
    mesh = pv.Icosphere(nsub=1)
    points = np.asarray(mesh.points, dtype=np.float64)
    parts, _ = split_at_random(points, mesh.regular_faces, random)
    shares = parts.shares()
    np.testing.assert_allclose(shares.sum(axis=1), 1)
    assert shares.data.min() >= 0
    for part, parent in zip(parts.corners, parts.parent, strict=True):
        for corner in part:
            row = shares[[corner]]
            assert set(row.indices) <= set(mesh.regular_faces[parent])


def test_lines_that_share_points_and_segments(random):
    points = random.standard_normal((6, 3))
    mesh = pv.PolyData(points, lines=[4, 0, 1, 2, 3, 3, 4, 1, 2, 1, 5, 2, 3, 0])
    parts = SplitCells(points, subdivision.simplices(mesh))
    assert parts.parents.tolist() == [[0, 1], [1, 2], [2, 3], [4, 1], [1, 2], [3, 0]]
    for _ in range(3):
        codes = np.unique(parts.edges(np.arange(len(parts.corners)))[0])
        parts.split(codes, random.uniform(0.2, 0.8, len(codes)))
    made = subdivision.rebuilt(mesh, parts, None, {})
    sizes, at = [], 0
    while at < len(made.lines):
        sizes.append(made.lines[at])
        at += made.lines[at] + 1
    assert sizes == [25, 17, 1, 9]
    # The segment from 1 to 2 is one for both lines.
    assert made.n_points == 6 + 7 * 5
    first, second = made.lines[1:26], made.lines[27:44]
    assert first[0] == 0
    assert [int(i) for i in first[::8]] == [0, 1, 2, 3]
    assert np.array_equal(first[8:17], second[8:17])
    steps = np.linalg.norm(np.diff(made.points[first], axis=0), axis=1)
    whole = np.linalg.norm(np.diff(points[:4], axis=0), axis=1)
    np.testing.assert_allclose(steps.sum(), whole.sum(), rtol=1e-6)


def test_triangles_of_every_kind_of_face():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
    mesh = pv.PolyData(points, [4, 0, 1, 2, 3])
    mesh = mesh.append_polydata(pv.PolyData(points, strips=[4, 1, 4, 2, 5]))
    found, cell = subdivision.triangles(mesh)
    assert len(found) == 4
    assert sorted(cell) == [0, 0, 1, 1]
    assert areas(np.asarray(mesh.points)[found]).sum() == pytest.approx(2)


def test_simplices_of_every_kind_of_mesh():
    grid = pv.ImageData(dimensions=(3, 3, 3))
    hull = subdivision.simplices(grid)
    assert hull.shape == (48, 3)
    assert 13 not in hull
    assert subdivision.simplices(pv.PolyData()).shape == (0, 3)
    assert subdivision.simplices(pv.PointSet(np.eye(3))).shape[0] == 0
    assert subdivision.simplices(pv.PolyData(np.eye(3))).shape[0] == 0
    lines = pv.MultipleLines(np.eye(3)).cast_to_unstructured_grid()
    assert subdivision.simplices(lines).tolist() == [[0, 1], [1, 2]]


def test_flat_grids_become_polydata_with_the_same_points():
    grid = pv.ImageData(dimensions=(4, 3, 1)).cast_to_unstructured_grid()
    grid["a"] = np.arange(12.0)
    grid.cell_data["c"] = np.arange(6)
    grid.field_data["f"] = [1]
    made = subdivision.as_polydata(grid)
    assert np.array_equal(made.points, grid.points)
    assert np.array_equal(made["a"], grid["a"])
    assert np.array_equal(np.sort(made.cell_data["c"]), np.arange(6))
    assert made.field_data["f"][0] == 1
    middle = made.cell_centers().points[np.argsort(made.cell_data["c"])]
    np.testing.assert_allclose(middle, grid.cell_centers().points)
