"""Lines that turn back or have no length."""

import numpy as np
import pyvista as pv

from vizlight.mesh import polylines


def test_lines_without_length_are_taken_out_with_their_data():
    points = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]])
    mesh = pv.PolyData()
    mesh.points = points
    mesh.lines = [2, 0, 1, 2, 2, 3, 1, 4]
    mesh["i"] = np.arange(5)
    mesh.cell_data["c"] = [7, 8, 9]
    clean = polylines.before_turning_back(mesh)
    np.testing.assert_array_equal(clean["i"], [2, 3])
    np.testing.assert_array_equal(clean.lines, [2, 0, 1])
    np.testing.assert_array_equal(clean.cell_data["c"], [8])
    assert polylines.before_turning_back(clean) is clean


def test_segments_between_two_labels_are_cut_in_half():
    mesh = pv.PolyData()
    mesh.points = np.array([[0.0, 0, 0], [2, 0, 0], [4, 0, 0], [9, 9, 9]])
    mesh.lines = [3, 0, 1, 2, 2, 2, 3]
    mesh["k"] = [1, 1, 5, 5]
    halves = polylines.by_end(mesh, "k")
    ends = np.asarray(halves.points).reshape(-1, 2, 3)
    np.testing.assert_array_equal(ends[:, :, 0], [[0, 2], [2, 3], [4, 9], [3, 4]])
    np.testing.assert_array_equal(np.asarray(halves["k"]).reshape(-1, 2)[:, 0], [1, 1, 5, 5])
    assert (np.ptp(np.asarray(halves["k"]).reshape(-1, 2), axis=1) == 0).all()
    mesh["k"] = [3, 3, 3, 3]
    assert polylines.by_end(mesh, "k") is mesh
