"""Triangles of faces are those of VTK."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.vtk import cells


@pytest.mark.parametrize("far", [0.0, 1e3])
def test_quadrilaterals_have_the_halves_of_vtk(random, far):
    """They have the shorter diagonal in common, wherever the surface stands."""
    rows, columns = 12, 9
    x, y = np.meshgrid(np.arange(columns, dtype=float), np.arange(rows, dtype=float))
    x, y = (axis + random.uniform(-0.3, 0.3, axis.shape) for axis in (x, y))
    z = 0.1 * random.normal(size=x.shape)
    grid = pv.StructuredGrid(x + far, y + far, z)
    surface = grid.extract_surface(algorithm="geometry")
    found = np.sort(cells.triangles(surface), axis=1)
    whole = np.sort(surface.triangulate().regular_faces, axis=1)
    np.testing.assert_array_equal(np.unique(found, axis=0), np.unique(whole, axis=0))
    assert len(found) == 2 * surface.n_cells


def test_cells_with_fewer_points_than_their_type_needs_are_refused():
    grid = pv.UnstructuredGrid(np.array([4, 0, 1, 2, 3]), np.array([10], np.uint8), np.eye(4, 3))
    cells.check_whole(grid, "mesh")
    types = grid.celltypes
    types[0] = pv.CellType.QUADRATIC_WEDGE
    with pytest.raises(ValueError, match="expected cells of type 26 with 15 points, got one of"):
        cells.check_whole(grid, "mesh")
    types[0] = 255
    with pytest.raises(ValueError, match="expected cells of types that VTK has, got one of type"):
        cells.check_whole(grid, "mesh")


def test_columns_are_those_of_the_rows_one_after_the_other_in_memory(random):
    rows, ids = random.normal(size=(9, 3)).astype(np.float32), random.integers(9, size=20)
    columns = cells.columns_at(rows, ids)
    np.testing.assert_array_equal(columns.T, rows[ids])
    assert columns.dtype == np.float64
    assert columns.flags.c_contiguous
