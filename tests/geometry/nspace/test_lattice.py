"""Closed directions have no seam; the skin of a cube is a sphere, or a projective space."""

import itertools

import numpy as np
import pytest
from lattices import EDGES, euler, faces_around
from refusals import refusals
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from vizlight.geometry.nspace import lattice


@pytest.mark.parametrize("shape", [(5,), (4, 7), (3, 4, 5)])
def test_closed_lattices_have_no_boundary(shape):
    cells = lattice.cells(shape, [True] * len(shape))
    assert len(cells) == np.prod(shape)
    assert set(faces_around(cells)) == {2}
    np.testing.assert_array_equal(np.unique(cells), np.arange(np.prod(shape)))


def test_open_lattice():
    cells = lattice.cells((3, 2), (False, False))
    np.testing.assert_array_equal(cells, [[0, 2, 3, 1], [2, 4, 5, 3]])
    assert set(faces_around(cells)) == {1, 2}


def test_klein_bottle_is_closed_and_has_no_orientation():
    cells = lattice.cells((6, 5), (True, True), twisted=True)
    assert set(faces_around(cells)) == {2}
    assert euler(cells) == 0
    assert not orientable(cells)
    assert orientable(lattice.cells((6, 5), (True, True)))


def orientable(cells):
    """Return whether the two sides of all faces are apart where neighbours' sides are joined."""
    ends = cells[:, EDGES[4]]
    way = (ends[..., 0] < ends[..., 1]).ravel()
    _, edge = np.unique(np.sort(ends.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    one, other = np.argsort(edge.ravel()).reshape(-1, 2).T
    a, b, turned = one // 4, other // 4, way[one] == way[other]
    count = len(cells)
    rows = np.concatenate([a, a + count]), np.concatenate([b + count * turned, b + count * ~turned])
    links = coo_array((np.ones(len(rows[0])), rows), shape=(2 * count, 2 * count))
    return connected_components(links, directed=False)[0] == 2


@pytest.mark.parametrize(("dimension", "size"), [(3, 1), (3, 4), (4, 1), (4, 3)])
def test_skin_of_a_cube(dimension, size):
    points, cells = lattice.cube_skin(dimension, size)
    assert np.all(np.abs(points).max(axis=1) == size)
    assert len(cells) == 2 * dimension * size ** (dimension - 1)
    assert set(faces_around(cells)) == {2}
    assert euler(cells) == (2 if dimension == 3 else 0)


@pytest.mark.parametrize("size", [2, 3, 6])
def test_opposite_points_of_a_skin_are_one(size):
    points, cells = lattice.cube_skin(3, size, opposite=True)
    assert len(cells) == 3 * size**2
    assert set(faces_around(cells)) == {2}
    assert euler(cells) == 1
    assert not orientable(cells)
    both = {tuple(p) for p in points} & {tuple(-p) for p in points}
    assert not both


def test_cells_are_boxes_of_neighbours():
    """Corners in VTK's order: along an edge of a cell one coordinate steps."""
    points, cells = lattice.cube_skin(4, 3)
    for a, b in EDGES[8]:
        step = np.abs(points[cells[:, a]] - points[cells[:, b]])
        assert np.all(np.sort(step, axis=1) == [0, 0, 0, 2])
    for a, b in itertools.combinations(range(8), 2):
        assert np.all(cells[:, a] != cells[:, b])


test_bad_resolution = refusals(
    lambda value: lattice.resolution(value, 2, (True, False)),
    (2, "resolution: expected an integer of at least 3"),
    ((5, 1), "resolution: expected an integer of at least 2"),
    ((5, 6, 7), "resolution: expected 1 or 2 integers, got 3"),
    (5.0, "resolution: expected an integer", TypeError),
)


def test_resolution():
    assert lattice.resolution(5, 2, (True, False)) == (5, 5)
    assert lattice.resolution((3, 2), 2, (True, False)) == (3, 2)
