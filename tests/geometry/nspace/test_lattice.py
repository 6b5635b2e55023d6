"""Closed directions have no seam; the skin of a cube is a sphere, or a projective space."""

import itertools

import numpy as np
import pytest
from refusals import refusals

from vizlight.geometry.nspace import lattice

_RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
_EDGES = {
    4: _RING,
    8: [*_RING, *[(a + 4, b + 4) for a, b in _RING], *[(i, i + 4) for i in range(4)]],
}
_FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def pieces(cells, groups):
    return np.concatenate([np.sort(cells[:, list(group)], axis=1) for group in groups])


def faces_around(cells):
    """Return the number of cells on each facet: 2 everywhere if there is no boundary."""
    size = cells.shape[1]
    groups = {2: [(0,), (1,)], 4: _EDGES.get(size, []), 8: _FACES}[size]
    return np.unique(pieces(cells, groups), axis=0, return_counts=True)[1]


def euler(cells):
    size = cells.shape[1]
    edges = len(np.unique(pieces(cells, _EDGES[size]), axis=0))
    number = len(np.unique(cells)) - edges
    if size == 4:
        return number + len(cells)
    return number + len(np.unique(pieces(cells, _FACES), axis=0)) - len(cells)


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
    """Walk from face to face and turn each to match; say whether all match in the end."""
    ways = {}
    for number, cell in enumerate(cells):
        for a, b in _EDGES[4]:
            ways.setdefault(frozenset((cell[a], cell[b])), []).append((number, cell[a] < cell[b]))
    side, todo = {0: True}, [0]
    joined = {number: [] for number in range(len(cells))}
    for (one, way), (other, back) in ways.values():
        joined[one].append((other, way != back))
        joined[other].append((one, way != back))
    while todo:
        number = todo.pop()
        for other, same in joined[number]:
            wanted = side[number] == same
            if other not in side:
                side[other] = wanted
                todo.append(other)
            elif side[other] != wanted:
                return False
    return True


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
    for a, b in _EDGES[8]:
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
