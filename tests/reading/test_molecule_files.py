"""Molecules in files with columns: atoms at their places in angstroms, bonds of the file."""

import numpy as np
import pytest
from refusals import refused_files, saved

import vizlight
from vizlight.mesh import meaning

GRO = """water and an ion
4
    1SOL     OW    1   0.000   0.000   0.000  0.1000  0.0000 -0.2000
    1SOL    HW1    2   0.096   0.000   0.000  0.0000  0.0000  0.0000
    1SOL    HW2    3  -0.024   0.093   0.000  0.0000  0.0000  0.0000
    2CA      CA    4   1.500   0.000  -1.250  0.0000  0.3000  0.0000
   2.00000   2.00000   2.00000
"""
MOL2 = """# by hand
@<TRIPOS>MOLECULE
carbon monoxide
2 1
SMALL
@<TRIPOS>ATOM
7 C1 0 0 0 C.3 1 UNL 0.25
9 O1 1.1 0 2.5 O.2 1 UNL -0.25
@<TRIPOS>BOND
1 7 9 2
"""
MOL = """far apart

 a comment
  3  1  0  0  0  0  0  0  0  0999 V2000
    0.0000    0.0000    0.0000 C   0  0
    5.0000    0.0000    1.5000 Cl  0  0
    9.0000    0.0000    0.0000 H   0  0
  1  2  1  0
M  END
"""
V3000 = """far apart

 a comment
  0  0  0     0  0            999 V3000
M  V30 BEGIN CTAB
M  V30 COUNTS 3 1 0 0 0
M  V30 BEGIN ATOM
M  V30 4 C 0 0 0 0
M  V30 5 Cl 5 0 1.5 0
M  V30 6 H 9 0 0 0
M  V30 END ATOM
M  V30 BEGIN BOND
M  V30 1 1 4 5
M  V30 END BOND
M  V30 END CTAB
M  END
"""


def written(folder, text, name):
    return saved(folder / name, text)


def test_atoms_of_gromacs_are_in_angstroms_with_their_elements(tmp_path):
    mesh = vizlight.read(written(tmp_path, GRO, "a.gro"))
    assert mesh["atom_type"].tolist() == [8, 1, 1, 20]
    assert (mesh.n_lines, mesh.n_verts) == (2, 1)
    np.testing.assert_allclose(mesh.points[3], (15, 0, -12.5))
    np.testing.assert_allclose(mesh["velocity"][0], (0.1, 0, -0.2))
    assert meaning.of(mesh).arrays["velocity"] == {"units": "nm/ps"}
    assert meaning.flags(mesh, "residue_name") == {0: "CA", 1: "SOL"}
    with pytest.warns(UserWarning, match="the first of 2 states of a molecule is read"):
        first = vizlight.read(written(tmp_path, GRO + GRO, "two.gro"))
    assert first.n_points == 4


def test_beads_of_gromacs_are_points_of_residues(tmp_path):
    beads = [
        "    1DPPC   NC3    1   0.000   0.000   0.000",
        "    2CHOL   ROH    2   0.400   0.000   0.3",
    ]
    mesh = vizlight.read(written(tmp_path, "\n".join(["", "2", *beads, "1 1 1", ""]), "a.gro"))
    assert "atom_type" not in mesh.point_data
    assert mesh.active_scalars_name == "residue_name"
    # Balls touch each other, and are lit.
    np.testing.assert_allclose(mesh["radius"], 5)
    look = vizlight.look(mesh)
    assert look.shown == "molecule"
    np.testing.assert_allclose(np.ptp(look.mesh.points, axis=0), (9, 5, 8), atol=0.1)


def test_lines_of_gromacs_beyond_its_count(tmp_path):
    with pytest.warns(UserWarning, match="has 1 lines more than it states"):
        vizlight.read(written(tmp_path, GRO.replace("\n4\n", "\n3\n"), "a.gro"))


def test_bonds_and_charges_are_those_of_tripos(tmp_path):
    mesh = vizlight.read(written(tmp_path, MOL2, "a.mol2"))
    assert mesh.lines.tolist() == [2, 0, 1]
    assert mesh["atom_type"].tolist() == [6, 8]
    np.testing.assert_allclose(mesh.points[1], (1.1, 0, 2.5))
    assert mesh["charge"].tolist() == [0.25, -0.25]


def test_types_of_force_fields_tell_their_elements(tmp_path):
    text = MOL2.replace("2 1\n", "4 0\n").replace("C.3", "ca").replace("O.2", "Na")
    text = text.replace("@<TRIPOS>BOND\n1 7 9 2\n", "3 X 5 0 0 cl 1 UNL\n4 X 9 0 0 h1 1 UNL\n")
    assert vizlight.read(written(tmp_path, text, "a.mol2"))["atom_type"].tolist() == [6, 11, 17, 1]


@pytest.mark.parametrize(
    ("text", "name", "title"),
    [
        (MOL, "a.mol", "far apart"),
        (MOL.replace("far apart", "ligand|mol|1"), "a.mol", "ligand mol 1"),
        (MOL.replace("far apart", "2519"), "a.mol", "a"),
        (MOL2, "b.mol2", "carbon monoxide"),
    ],
)
def test_the_title_is_the_name_of_the_molecule_or_of_its_file(text, name, title, tmp_path):
    assert vizlight.look(written(tmp_path, text, name)).key[0]["title"] == title


@pytest.mark.parametrize("text", [MOL, V3000])
def test_bonds_are_those_of_mdl(text, tmp_path):
    mesh = vizlight.read(written(tmp_path, text, "a.mol"))
    assert mesh.lines.tolist() == [2, 0, 1]
    assert mesh["atom_type"].tolist() == [6, 17, 1]
    np.testing.assert_allclose(mesh.points[1], (5, 0, 1.5))
    with pytest.warns(UserWarning, match="the first of 2 molecules is read"):
        vizlight.read(written(tmp_path, 2 * f"{text}$$$$\n", "two.sdf"))


test_a_molecule_that_is_not_whole_is_refused = refused_files(
    lambda folder, name, text: vizlight.read(written(folder, text, name)),
    ("a.gro", GRO.replace("\n4\n", "\n6\n"), "4 of 6 atoms and their box"),
    ("a.gro", GRO.replace("1.500", "  abc"), "words where its numbers are"),
    ("a.mol2", MOL2.replace("1 7 9 2", "1 7 8 2"), "a bond has the atom 8, which is not"),
    ("a.mol2", "@<TRIPOS>MOLECULE\n", "it has no atoms"),
    ("a.mol2", MOL2.replace("\n2 1", "\n3 1"), "2 of 3 atoms are there"),
    ("a.mol", V3000.replace("COUNTS 3 1", "COUNTS 3 2"), "1 of 2 bonds are there"),
    ("a.mol", MOL.replace("  1  2  1  0\nM  END\n", ""), "3 of 4 atoms and bonds are there"),
    ("a.mol", MOL.replace("  3  1", "  3  0"), "it has more than 3 atoms and 0 bonds"),
    ("a.sdf", "<sdf version='1.6'>\n", "no number of atoms or bonds in ''"),
)


def test_a_formula_is_seen_from_above(tmp_path):
    flat = MOL.replace("1.5000 Cl", "0.0000 Cl").replace("9.0000    0.0000", "2.0000    3.0000")
    look = vizlight.look(written(tmp_path, flat, "a.mol"), size=(240, 160))
    np.testing.assert_allclose(look.view.direction, (0, 0, -1), atol=1e-6)
