"""Dumps of LAMMPS: atoms of the first step, at their places."""

import numpy as np
import pytest
from refusals import read_warned, refused, refused_files, saved

import vizlight
from vizlight.mesh import meaning

HEAD = "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}\n{}\nITEM: ATOMS {}\n"
BOX = "1 5\n2 6\n3 11"
ROWS = ["2 2 3 4 7 0.5 0 0 1", "1 1 1 2 3 -1 0 0 2", "3 1 5 6 11 0 1 0 0"]
COLUMNS = "id type x y z q vx vy vz"


def written(folder, *steps, name="a.lammpstrj"):
    return saved(folder / name, "".join(f"{head}{chr(10).join(rows)}\n" for head, rows in steps))


@pytest.mark.parametrize("name", ["a.lammpstrj", "a.dump"])
def test_atoms_of_the_first_step_are_in_the_order_of_their_numbers(tmp_path, name):
    step = HEAD.format(0, 3, "pp pp pp", BOX, COLUMNS), ROWS
    later = HEAD.format(9, 3, "pp pp pp", BOX, COLUMNS), ["1 1 0 0 0 0 0 0 0"] * 3
    mesh = read_warned(written(tmp_path, step, later, name=name), "the first of 2 states")
    np.testing.assert_array_equal(mesh.points, [[1, 2, 3], [3, 4, 7], [5, 6, 11]])
    assert mesh["atom_type"].tolist() == [1, 2, 1]
    assert meaning.flags(mesh, "atom_type") == {1: "type 1", 2: "type 2"}
    assert mesh["charge"].tolist() == [-1, 0.5, 0]
    assert mesh["velocity"][2].tolist() == [1, 0, 0]
    np.testing.assert_allclose(mesh["radius"], np.linalg.norm([2, 2, 4]))


def test_shares_of_a_tilted_box_are_places(tmp_path):
    """The bounds are those around the box: xlo = 1, xhi = 5, tilted by xy = 1 and yz = -1."""
    box = "1 6 1\n1 6 0\n3 11 -1"
    head = HEAD.format(0, 4, "xy xz yz pp pp pp", box, "id type xs ys zs")
    rows = ["1 1 0 0 0", "2 1 1 0 0", "3 1 0 1 0", "4 1 0 0 1"]
    mesh = vizlight.read(written(tmp_path, (head, rows)))
    edges = mesh.points[1:] - mesh.points[0]
    np.testing.assert_allclose(mesh.points[0], [1, 2, 3])
    np.testing.assert_allclose(edges, [[4, 0, 0], [1, 4, 0], [0, -1, 8]])


def test_elements_are_joined_by_bonds(tmp_path):
    head = HEAD.format(0, 3, "pp pp pp", BOX, "element xu yu zu")
    mesh = vizlight.read(written(tmp_path, (head, ["O 0 0 0", "H 0.96 0 0", "H -0.24 0.93 0"])))
    assert (mesh["atom_type"].tolist(), mesh.n_lines) == ([8, 1, 1], 2)


test_damaged_dumps_are_refused = refused_files(
    lambda folder, count, columns, rows: vizlight.read(
        written(folder, (HEAD.format(0, count, "pp pp pp", BOX, columns), rows))
    ),
    (4, COLUMNS, ROWS, "3 of 4 atoms are there"),
    (3, "id type", ["1 1"] * 3, "no columns of places"),
    (3, COLUMNS, [*ROWS[:2], "3 1 5"], "an atom has not the 9 columns"),
    (3, COLUMNS, [*ROWS[:2], "3 1 5 6 x 0 1 0 0"], "words where its numbers are"),
)


def test_other_dumps_and_trajectories_are_none(tmp_path):
    for name, words in (("a.dump", "no reader takes '.dump'"), ("a.xtc", r"as \.pdb, \.cif or")):
        refused(saved(tmp_path / name, b"something else\n"), words)
