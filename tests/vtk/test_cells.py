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
