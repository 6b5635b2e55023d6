"""Cube files of quantum chemistry: values on a grid around the atoms of a molecule."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Array
from vizlight.mesh import meaning, molecules
from vizlight.mesh.brains import of_affine

#: A bohr in angstroms, by CODATA 2018.
BOHR = 0.529177210903


def read(path: Path) -> pv.ImageData | pv.StructuredGrid:
    """Return the values of a cube file at their places in angstroms, its atoms as field arrays.

    VTK's reader loses origin and spacing. Orbitals are arrays of their numbers.

    Raises
    ------
    ValueError
        If a number is missing.
    """
    with path.open(encoding="latin-1") as file:
        head = [file.readline() for _ in range(6)]
        first, *origin = head[2].split()[:4]
        axes = [line.split()[:4] for line in head[3:]]
        # A negative number of atoms says that a line with the numbers of orbitals follows them.
        has_orbitals, n_atoms = int(first) < 0, abs(int(first))
        atoms: Array = np.array([file.readline().split()[:5] for _ in range(n_atoms)], np.float64)
        words = file.read().split()
    numbers = ["0"]
    if has_orbitals:
        count = int(words[0])
        numbers, words = words[1 : 1 + count], words[1 + count :]
    counts = [int(axis[0]) for axis in axes]
    # A negative number of voxels says that lengths are in angstroms.
    unit = 1.0 if counts[0] < 0 else BOHR
    shape = tuple(map(abs, counts))
    affine: Array = np.eye(4)
    affine[:3, :3] = unit * np.array([axis[1:] for axis in axes], dtype=np.float64).T
    affine[:3, 3] = unit * np.array(origin, dtype=np.float64)
    values = np.array(words, dtype=np.float64)
    size = int(np.prod(shape)) * len(numbers)
    if values.size != size:
        raise ValueError(f"{values.size} of {size} values are there")
    grid = of_affine(affine, shape)
    # The second comment names the values, or repeats the order of the indices.
    comment, stem = head[1].strip(), path.name.partition(".")[0]
    title = stem if not comment or "loop" in comment.lower() else comment
    # The last index runs fastest, of orbitals that of the orbital.
    for number, rows in zip(numbers, values.reshape(-1, len(numbers)).T, strict=True):
        name = f"orbital {number}" if has_orbitals else title
        grid.point_data[name] = rows.reshape(shape).ravel(order="F")
    if n_atoms:
        grid.field_data[molecules.NUMBERS] = atoms[:, 0].astype(np.intp)
        grid.field_data[molecules.PLACES] = unit * atoms[:, 2:]
    meaning.attach(grid, meaning.Meaning(["x in angstroms", "y", "z"]))
    return grid
