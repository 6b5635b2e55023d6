"""Closed directions have no seam."""

import numpy as np
import pytest
from lattices import faces_around
from refusals import refusals

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
