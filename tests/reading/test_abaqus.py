"""Input files of Abaqus and CalculiX: comments, files in files, parts and instances."""

import numpy as np
import pytest
from refusals import refused_files, saved

import vizlight
from vizlight.reading import abaqus

NODES = "*NODE, NSET=ALL\n1, 0, 0, 0\n** a comment\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
PART = """\
*Heading
 a part
*Part, name=P
*Node
1, 0., 0.
2, 1., 0.
3, 0., 1.
*Element, type=CPS3
1, 1, 2, 3
*End Part
*Instance, name=I, part=P
*End Instance
*Instance, name="J", part="P"
5., 0., 0.
5., 0., 0., 5., 0., 1., 90.
*End Instance
"""


def read(folder, text):
    return vizlight.read(saved(folder / "a.inp", text))


def test_files_in_files_comments_and_lines_that_go_on(tmp_path):
    (tmp_path / "nodes.inp").write_text(NODES)
    (tmp_path / "more.txt").write_text("2, 2, 3,\n4, 5\n")
    text = "*INCLUDE, INPUT=nodes.inp\n*Node\n5, 1, 1, 1\n*Element, type=C3D4\n1, 1, 2, 3, 4\n"
    text += "*ELEMENT, TYPE=C3D4H, INPUT=more.txt\n*ELEMENT, TYPE=MASS\n9, 1\n*NODE FILE\nU\n"
    with pytest.warns(UserWarning, match="elements without cells are left out: MASS"):
        mesh = read(tmp_path, text)
    np.testing.assert_array_equal(mesh.cells, [4, 0, 1, 2, 3, 4, 1, 2, 3, 4])
    np.testing.assert_array_equal(mesh.points[[2, 4]], [[0, 1, 0], [1, 1, 1]])


def test_instances_put_parts(tmp_path):
    mesh = read(tmp_path, PART)
    expected = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [5, 1, 0], [4, 0, 0]]
    np.testing.assert_allclose(mesh.points, expected, atol=1e-12)
    assert mesh.n_cells == 2


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("C3D8R", (8, 12)), ("C3D20", (20, 25)), ("C3D15", (15, 26)), ("C3D6", (6, 13)),
        ("DC3D10", (10, 24)), ("S4R", (4, 9)), ("S8R5", (8, 23)), ("STRI65", (6, 22)),
        ("CPEG6H", (6, 22)), ("M3D3", (3, 5)), ("SC8R", (8, 12)), ("B31", (2, 3)),
        ("B32R", (3, 21)), ("T3D2", (2, 3)), ("T3D3", (3, 21)), ("MASS", (0, 0)), ("S5", (5, 0)),
    ],
)  # fmt: skip
def test_types_of_elements(name, expected):
    assert abaqus._kind(name) == expected


test_what_cannot_be_read = refused_files(
    read,
    ("*INCLUDE, INPUT=none.inp\n", "of 'none.inp': no such file beside it"),
    ("*INCLUDE, INPUT=a.inp\n", "'a.inp' includes itself"),
    (f"{NODES}*NGEN\n1, 9\n", r"\*NGEN is not read: write the mesh with each node"),
    ("*NODE, SYSTEM=C\n1, 0, 0, 0\n", "SYSTEM= other than R is not read"),
    (f"{NODES}*ELEMENT, TYPE=S3\n1, 1, 2\n", "3 numbers are no elements of S3, of 3 nodes"),
    (f"{NODES}*ELEMENT, TYPE=S3\n1, 1, 2, 9\n", "an element has the node 9"),
    ("*INSTANCE, NAME=I, PART=P\n", "of the part 'P', which is not there"),
    (f"{NODES}*ELEMENT, TYPE=S3\n1, 1, 2, x\n", "number should be"),
    (NODES, "no points"),
)


def test_a_file_of_abaqus_may_have_the_name_of_one_of_gmsh(tmp_path):
    path = tmp_path / "a.msh"
    path.write_text(
        "*node, nset=Nall\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
        "*element, type=C3D4, elset=Eall\n1, 1, 2, 3, 4\n"
    )
    assert vizlight.read(path).n_cells == 1
