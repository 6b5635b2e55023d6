"""Meshes of SU2: cells without markers, zones, and files that are not whole."""

import numpy as np
import pytest
from refusals import refused_files, saved

import vizlight

HEXA = """\
% a comment
NDIME= 3
NELEM= 2
12 0 1 2 3 4 5 6 7 0
14 4 5 6 7 8 1
NPOIN= 9 9
{points}NMARK= 1
MARKER_TAG= low
MARKER_ELEMS= 2
9 0 1 2 3
9 0 1 5 4
"""
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
CORNERS += [(x, y, 1) for x, y, _ in CORNERS] + [(0.5, 0.5, 2)]
HEXA = HEXA.format(points="".join(f"{x} {y} {z} {i}\n" for i, (x, y, z) in enumerate(CORNERS)))
FLAT = "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n0 1\nNMARK= 1\nMARKER_TAG= a\n"
FLAT += "MARKER_ELEMS= 1\n3 0 1\n"


def read(folder, text):
    return vizlight.read(saved(folder / "a.su2", text))


def test_markers_are_no_cells(tmp_path):
    mesh = read(tmp_path, HEXA)
    assert sorted(mesh.celltypes) == [12, 14]
    np.testing.assert_array_equal(mesh.points, CORNERS)
    # A marker may have cells of the same kind.
    same = FLAT.replace("3 0 1\n", "5 0 1 2\n")
    assert read(tmp_path, same).n_cells == 1
    shell = HEXA.replace("NELEM= 2\n12 0 1 2 3 4 5 6 7 0\n14 4 5 6 7 8 1\n", "NELEM= 0\n")
    with pytest.warns(UserWarning, match="3 of its 9 points are in no cell and left out"):
        assert read(tmp_path, shell).celltypes.tolist() == [9, 9]


def test_zones(tmp_path):
    other = FLAT.replace("NPOIN= 3\n0 0", "NPOIN= 3\n5 5")
    mesh = read(tmp_path, f"NZONE= 2\nIZONE= 1\n{FLAT}IZONE= 2\n{other}")
    assert mesh.n_cells == 2
    assert mesh.bounds[1] == 5


test_a_file_that_is_not_whole = refused_files(
    lambda folder, change: read(folder, FLAT.replace(*change, 1)),
    (("NELEM= 1", "NELEM= x"), "'x' is no number of NELEM"),
    (("NELEM= 1", "NELEM= 2"), "1 of 2 lines of NELEM are there"),
    (("5 0 1 2", "6 0 1 2"), "6 is no kind of cell"),
    (("5 0 1 2", "5 0 1"), "2 of 3 corners of a cell are there"),
    (("5 0 1 2", "5 0 1 7"), "given for cells of type 5"),
    (("1 0\n", "1\n"), "1 of 2 coordinates of a point"),
    (("NDIME= 2", "NDIME= 7"), "no NDIME of 2 or 3"),
)


def test_the_last_line(tmp_path):
    with pytest.warns(UserWarning, match="may be cut in its last line"):
        read(tmp_path, FLAT[:-1])
