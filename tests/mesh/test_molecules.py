"""Molecules: one of several states, with bonds between its own atoms alone."""

import numpy as np
import pytest

import vizlight
from vizlight.mesh import meaning

ATOM = "ATOM  {:5d}  CA  GLY A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C  \n"
WATER = "3\nwater\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n"


def written(folder, text, name):
    path = folder / name
    path.write_text(text)
    return path


def test_the_first_of_several_models_is_read(tmp_path):
    atoms = [ATOM.format(i + 1, i + 1, 1.5 * i, 0, 0) for i in range(4)]
    one = vizlight.read(written(tmp_path, "".join(atoms) + "END\n", "one.pdb"))
    models = "".join(f"MODEL     {k}\n{''.join(atoms)}ENDMDL\n" for k in (1, 2, 3))
    with pytest.warns(UserWarning, match="the first of 3 states of a molecule is read"):
        first = vizlight.read(written(tmp_path, f"{models}END\n", "three.pdb"))
    assert first.n_points == one.n_points == 4
    assert first.n_lines == one.n_lines == 3
    np.testing.assert_array_equal(first.points, one.points)


def test_elements_are_those_of_the_columns_or_of_the_names(tmp_path):
    """Old files have other words in the columns of elements; hydrogen is kept."""
    names = [(" CA ", "ATOM  "), ("HG1 ", "ATOM  "), ("FE  ", "HETATM"), ("1HB ", "ATOM  ")]
    lines = [
        f"{kind}{i + 1:5d} {name} GLY A{i + 1:4d}    {9.0 * i:8.3f}{0:8.3f}{0:8.3f}  0.50 {i:5.2f}"
        for i, (name, kind) in enumerate(names)
    ]
    for end in ("      1HPV 186", ""):
        mesh = vizlight.read(written(tmp_path, "".join(f"{one}{end}\n" for one in lines), "a.pdb"))
        assert mesh["atom_type"].tolist() == [6, 1, 26, 1]
        assert (mesh.n_lines, mesh.n_verts) == (0, 4)
    assert mesh["b_factor"].tolist() == [0, 1, 2, 3]
    assert mesh["residue"].tolist() == [1, 2, 3, 4]
    assert mesh["occupancy"].tolist() == [0.5] * 4


def test_atoms_of_xyz_are_joined_by_their_distances(tmp_path):
    water = vizlight.read(written(tmp_path, WATER, "water.xyz"))
    assert water["atom_type"].tolist() == [8, 1, 1]
    assert sorted(map(sorted, water.lines.reshape(-1, 3)[:, 1:].tolist())) == [[0, 1], [0, 2]]
    assert water.n_verts == 0
    assert meaning.flags(water, "atom_type") == {1: "H", 8: "O"}
    assert meaning.flags(water, "atom_type", "colors") == {1: "#b2b2b2", 8: "#ff0d0d"}
    far = WATER.replace("3", "4", 1) + "Na1 9 9 9\n"
    with pytest.warns(UserWarning, match="the first of 2 states"):
        salt = vizlight.read(written(tmp_path, far + far, "salt.xyz"))
    assert (salt.n_points, salt.n_lines, salt.n_verts) == (4, 2, 1)
    assert salt["atom_type"][3] == 11


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (WATER.replace("3", "5", 1), "3 of 5 atoms are there"),
        (WATER.replace("H 0.96", "Qq 0.96"), "line 4 has no element"),
        (WATER.replace("0.96", "x"), "line 4 has no element"),
        (WATER.replace("0.96", "nan"), "line 4 has no element"),
    ],
)
def test_damaged_molecules_are_refused(tmp_path, text, words):
    with pytest.raises(vizlight.files.FileError, match=words):
        vizlight.read(written(tmp_path, text, "water.xyz"))


def test_points_without_elements_stay_a_scan(tmp_path):
    scan = vizlight.read(written(tmp_path, "0 0 0\n1 0 0\n0 1 0\n", "scan.xyz"))
    assert (scan.n_points, scan.n_lines) == (3, 0)


def test_cations_of_a_crystal_are_not_joined_and_metals_are(tmp_path):
    def atoms(first, second, side):
        places = np.argwhere(np.ones((2, 2, 2)))
        names = [second if sum(place) % 2 else first for place in places]
        rows = [f"{name} {x} {y} {z}" for name, (x, y, z) in zip(names, side * places, strict=True)]
        return written(tmp_path, "8\n\n" + "\n".join(rows) + "\n", "a.xyz")

    oxide = vizlight.read(atoms("Mg", "O", 2.106))
    assert oxide.n_lines == 12
    ends = oxide.lines.reshape(-1, 3)[:, 1:]
    assert (oxide["atom_type"][ends].sum(axis=1) == 20).all()
    # All along edges and faces of the cube.
    copper = vizlight.read(atoms("Cu", "Cu", 2.0))
    assert copper.n_lines >= 12
    assert vizlight.look(copper).shown == "molecule"
