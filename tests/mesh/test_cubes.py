"""Cube files: values at their places in angstroms."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import files
from vizlight.files import FileError
from vizlight.mesh import meaning
from vizlight.mesh.cubes import BOHR

#: Values 0 to 23 of a grid of 2 x 3 x 4 points, the last index fastest.
VALUES = " ".join(map(str, range(24)))


def written(folder, counts=(2, 3, 4), atoms=1, values=VALUES, orbitals=""):
    sides = np.diag([0.5, 1.0, 2.0])
    axes = [
        f"{count} {' '.join(map(str, side))}" for count, side in zip(counts, sides, strict=True)
    ]
    path = folder / "psi.cube"
    lines = [
        "water",
        "OUTER LOOP: X, MIDDLE LOOP: Y, INNER LOOP: Z",
        f"{atoms} 1.0 2.0 3.0",
        *axes,
        "8 8.0 0.5 1.5 4.0",
        orbitals,
        values,
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_values_are_at_their_places_in_angstroms(tmp_path):
    mesh = vizlight.read(written(tmp_path))
    point = mesh.find_closest_point(BOHR * np.array([1.5, 3.0, 9.0]))
    np.testing.assert_allclose(mesh.points[point], BOHR * np.array([1.5, 3.0, 9.0]))
    assert mesh["psi"][point] == 12 + 4 + 3
    # Negative numbers of points are those of angstroms.
    plain = vizlight.read(written(tmp_path, counts=(-2, -3, -4)))
    np.testing.assert_allclose(plain.points, mesh.points / BOHR)
    np.testing.assert_array_equal(plain["psi"], mesh["psi"])


def test_orbitals_are_arrays_of_their_numbers(tmp_path):
    values = " ".join(map(str, range(48)))
    mesh = vizlight.read(written(tmp_path, atoms=-1, values=values, orbitals="2 5 6"))
    assert meaning.line(mesh) == "x in angstroms, y, z"
    assert mesh["orbital 5"].max() == 46
    np.testing.assert_array_equal(mesh["orbital 6"], mesh["orbital 5"] + 1)


def test_atoms_are_in_the_space_of_the_values(tmp_path):
    atoms = files.atoms_in(vizlight.read(written(tmp_path)))
    assert atoms["atom_type"].tolist() == [8]
    np.testing.assert_allclose(atoms.points, [[0.5 * BOHR, 1.5 * BOHR, 4.0 * BOHR]], rtol=1e-6)
    with pytest.raises(ValueError, match="volume: expected the volume of a cube file"):
        files.atoms_in(pv.ImageData(dimensions=(2, 2, 2)))
    with pytest.raises(TypeError, match="volume: expected a pyvista.DataSet"):
        files.atoms_in("psi.cube")


def test_a_cube_that_is_cut_short_is_refused(tmp_path):
    with pytest.raises(FileError, match="23 of 24 values are there"):
        vizlight.read(written(tmp_path, values=VALUES[:-3]))


DX = """# a potential
object 1 class gridpositions counts 2 3 4
origin 1.0 2.0 3.0
delta 0.5 0 0
delta 0 1.0 0
delta 0 0 2.0
object 2 class gridconnections counts 2 3 4
object 3 class array type double rank 0 items 24 data follows
{}
attribute "dep" string "positions"
"""


def test_values_of_opendx_are_at_their_places(tmp_path):
    path = tmp_path / "potential.dx"
    path.write_text(DX.format(VALUES))
    mesh = vizlight.read(path)
    assert mesh["potential"][mesh.find_closest_point([1.5, 3.0, 9.0])] == 12 + 4 + 3
    path.write_text(
        DX.format(VALUES).replace("rank 0", "rank 1 shape 3").replace(VALUES, "0 1 2 " * 24)
    )
    assert vizlight.read(path)["potential"].tolist() == [[0, 1, 2]] * 24
    path.write_text(DX.format("1 2"))
    with pytest.raises(FileError, match="of 24 values are there"):
        vizlight.read(path)
    path.write_text("object 1 class array type float rank 1 shape 2 items 1 data follows\n1 2\n")
    with pytest.raises(FileError, match="it is no regular grid in space"):
        vizlight.read(path)
