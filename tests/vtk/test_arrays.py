"""Points of grids by slice, and means of cells at points."""

import numpy as np
import pyvista as pv

from vizlight.vtk import arrays


def test_points_of_a_turned_image_with_an_extent():
    grid = pv.ImageData(dimensions=(4, 5, 6), spacing=(0.5, 1, 2), origin=(1, 2, 3))
    angle = np.radians(30)
    grid.direction_matrix = [
        [np.cos(angle), -np.sin(angle), 0],
        [np.sin(angle), np.cos(angle), 0],
        [0, 0, 1],
    ]
    grid.extent = (2, 5, -1, 3, 0, 5)
    rows = arrays.GridPoints(grid)
    np.testing.assert_allclose(rows[0 : grid.n_points], grid.points, atol=1e-12)
    np.testing.assert_allclose(rows[7:23], grid.points[7:23], atol=1e-12)


def test_points_of_a_rectilinear_grid():
    grid = pv.RectilinearGrid([0.0, 1, 4], [2.0, 3], [5.0, 7, 8, 9])
    rows = arrays.GridPoints(grid)
    assert rows.shape == (24, 3)
    np.testing.assert_array_equal(rows[0:24], grid.points)
    np.testing.assert_array_equal(rows[5:9], grid.points[5:9])


def test_hidden_points_of_a_grid_do_not_change_the_means_of_its_cells():
    """VTK's filter returns what stood in memory beside such points."""
    grid = pv.ImageData(dimensions=(6, 5, 4)).cast_to_structured_grid()
    rows = np.random.default_rng(0).random((grid.n_cells, 2))
    expected = arrays.means(grid, rows)
    np.testing.assert_allclose(expected[[0, -1]], rows[[0, -1]])
    grid.point_data["vtkGhostType"] = np.full(grid.n_points, 2, np.uint8)
    np.testing.assert_array_equal(arrays.means(grid, rows), expected)
