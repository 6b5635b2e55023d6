"""Meshes of TetGen and Triangle, by the examples of their formats."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refused_files

import vizlight

SQUARE = "# a square\n4 2 1 1  # of numbers\n1 0 0 5 1\n2 1 0 6 1\n3 1 1 7 0\n4 0 1 8 0\n"
TWO = "2 3 1\n1 1 2 3 9\n2 1 3 4 8\n# by hand\n"
TETRAHEDRON = "4\t3\t0\t0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n"


def written(folder, nodes, cells=None):
    (folder / "a.node").write_text(nodes)
    if cells is not None:
        (folder / "a.ele").write_text(cells)
    return folder / "a.node"


def test_triangles_in_the_plane(tmp_path):
    path = written(tmp_path, SQUARE, TWO)
    for mesh in map(vizlight.read, (path, path.with_suffix(".ele"))):
        np.testing.assert_array_equal(mesh.cells_dict[pv.CellType.TRIANGLE], [[0, 1, 2], [0, 2, 3]])
        np.testing.assert_array_equal(mesh.bounds, (0, 1, 0, 1, 0, 0))
        assert mesh["attribute"].tolist() == [5, 6, 7, 8]
        assert mesh["marker"].tolist() == [1, 1, 0, 0]
        assert mesh.cell_data["region"].tolist() == [9, 8]


def test_middles_of_sides_are_opposite_to_the_corners(tmp_path):
    places = (0, 0), (2, 0), (0, 2), (1, 1), (0, 1), (1, 0)
    nodes = "6 2 0 0\n" + "".join(f"{i} {x} {y}\n" for i, (x, y) in enumerate(places))
    mesh = vizlight.read(written(tmp_path, nodes, "1 6 0\n0 0 1 2 3 4 5\n"))
    expected = [[0, 1, 2, 5, 3, 4]]
    np.testing.assert_array_equal(mesh.cells_dict[pv.CellType.QUADRATIC_TRIANGLE], expected)


def test_tetrahedra_and_points_alone(tmp_path):
    path = written(tmp_path, TETRAHEDRON)
    assert vizlight.read(path).n_points == 4
    written(tmp_path, TETRAHEDRON, "1 4\n1 0 1 2 3\n")
    assert vizlight.read(path).volume == pytest.approx(1 / 6)


test_what_is_not_whole_is_refused = refused_files(
    lambda folder, nodes, cells: vizlight.read(written(folder, nodes, cells)),
    ("# written by a program\n\n", TWO, "'a.node' has no numbers"),
    (SQUARE.replace("\n4 0 1 8 0", ""), TWO, "15 of 20 numbers of 'a.node' are there"),
    (SQUARE.replace("\n4 2", "\n900 2"), TWO, "20 of 4500 numbers"),
    (SQUARE.replace("\n4 2", "\n-4 2"), TWO, "the first line '-4 2 1 1'"),
    (SQUARE.replace("\n4 2", "\n4 7"), TWO, "20 of 40 numbers"),
    (SQUARE.replace("\n3 1", "\n9 1"), TWO, "rows of 'a.node' are not numbered"),
    (SQUARE, TWO.replace("2 3 1", "2 4 0"), "'a.ele' has cells of 4 corners"),
    (SQUARE, TWO.replace("1 3 4", "1 3 5"), "a cell of 'a.ele' has a point that is not there"),
    ("1 1 0 0\n0 0\n", TWO, "points of 1 coordinates"),
)
