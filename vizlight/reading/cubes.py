"""Values on a grid in text: cube files of quantum chemistry, with their atoms, and OpenDX."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Array
from vizlight.mesh import meaning
from vizlight.reading import molecules
from vizlight.reading.brains import of_affine

#: A bohr in angstroms, by CODATA 2018.
BOHR = 0.529177210903

#: Comments that name no values: of the program, its version and date, or of numbers alone; and a
#: name with its unit in parentheses.
_NO_NAME = re.compile(
    r"version|generated|written|created|\bcube\b|\bdate\b|^[^A-Za-z]*$", re.IGNORECASE
)
_WITH_UNIT = re.compile(r"(.+?)(?:\s*\(([^()]*)\))?")


def read(path: Path) -> pv.ImageData | pv.StructuredGrid:
    """Return the values of a cube file at their places in angstroms, its atoms as field arrays.

    VTK's reader loses origin and spacing. Orbitals are arrays of their numbers.
    """
    with path.open(encoding="latin-1") as file:
        head = [file.readline() for _ in range(6)]
        first, *origin = head[2].split()[:4]
        axes = [line.split()[:4] for line in head[3:]]
        n_atoms = abs(int(first))
        atoms: Array = np.array([file.readline().split()[:5] for _ in range(n_atoms)], np.float64)
        words = file.read().split()
    counts = [int(axis[0]) for axis in axes]
    # A negative number of voxels says that lengths are in angstroms.
    unit = 1.0 if counts[0] < 0 else BOHR
    shape = tuple(map(abs, counts))
    numbers = ["0"]
    # A negative number of atoms says that a line with the numbers of orbitals follows them, which
    # Molden writes after a positive number too.
    has_orbitals = int(first) < 0 or len(words) == np.prod(shape) + 2
    if has_orbitals:
        count = int(words[0])
        numbers, words = words[1 : 1 + count], words[1 + count :]
    affine: Array = np.eye(4)
    affine[:3, :3] = unit * np.array([axis[1:] for axis in axes], dtype=np.float64).T
    affine[:3, 3] = unit * np.array(origin, dtype=np.float64)
    values = np.array(words, dtype=np.float64)
    size = int(np.prod(shape)) * len(numbers)
    if values.size != size:
        raise ValueError(f"{values.size} of {size} values are there")
    grid = of_affine(affine, shape)
    # The second comment names the values or repeats the order of the indices; some programs have
    # their version in it, and the name in the first.
    comments = [line.strip() for line in ([] if "loop" in head[1].lower() else head[1::-1])]
    stem = path.name.partition(".")[0]
    title = next((line for line in comments if line and not _NO_NAME.search(line)), stem)
    match = _WITH_UNIT.fullmatch(title)
    assert match is not None
    title, value_unit = match.groups()
    # The last index runs fastest, of orbitals that of the orbital.
    for number, rows in zip(numbers, values.reshape(-1, len(numbers)).T, strict=True):
        name = f"orbital {number}" if has_orbitals else title
        grid.point_data[name] = rows.reshape(shape).ravel(order="F")
    if n_atoms:
        grid.field_data[molecules.NUMBERS] = atoms[:, 0].astype(np.intp)
        grid.field_data[molecules.PLACES] = unit * atoms[:, 2:]
    said = meaning.Meaning(["x in angstroms", "y", "z"])
    if value_unit and not has_orbitals:
        said.add_array(title, {"units": value_unit})
    return meaning.attach(grid, said)


#: Lines of comments of OpenDX, the lines of its grid, and that of its values.
_COMMENTS = re.compile(r"(?m)^\s*#.*$")
_COUNTS = re.compile(r"gridpositions\s+counts\s+(\d+)\s+(\d+)\s+(\d+)\s")
_ORIGIN, _DELTA = (re.compile(rf"(?m)^\s*{word}\s+(\S+)\s+(\S+)\s+(\S+)\s*$")
                   for word in ("origin", "delta"))  # fmt: skip
_ITEMS = re.compile(r"\srank\s+\d+(?:\s+shape\s+(\d+))?\s+items\s+(\d+)\s+(data\s+)?follows")


def read_dx(path: Path) -> pv.ImageData | pv.StructuredGrid:
    """Return the values of an OpenDX file with one regular grid, such as an electric potential."""
    text = _COMMENTS.sub("", path.read_text(encoding="latin-1"))
    counts, origin, deltas = _COUNTS.search(text), _ORIGIN.search(text), _DELTA.findall(text)
    items = _ITEMS.search(text)
    if counts is None or origin is None or items is None or len(deltas) != 3:
        raise ValueError("it is no regular grid in space with values that follow in text")
    shape, components = tuple(map(int, counts.groups())), int(items[1] or 1)
    affine: Array = np.eye(4)
    affine[:3, :3] = np.array(deltas, dtype=np.float64).T
    affine[:3, 3] = origin.groups()
    size = int(np.prod(shape)) * components
    words = text[items.end() :].split(maxsplit=size)[:size]
    if len(words) != size or size != int(items[2]) * components:
        raise ValueError(f"{len(words)} of {size} values are there")
    grid = of_affine(affine, shape)
    rows = np.array(words, dtype=np.float64).reshape(*shape, components)
    # The last index runs fastest.
    flat = rows.transpose(2, 1, 0, 3).reshape(-1, components)
    grid.point_data[path.name.partition(".")[0]] = flat[:, 0] if components == 1 else flat
    return grid
