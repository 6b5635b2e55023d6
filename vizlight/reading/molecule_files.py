"""Molecules in files with columns: GROMACS (.gro), Tripos (.mol2) and MDL (.mol, .sdf)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Indices
from vizlight.mesh import meaning
from vizlight.reading import file_parts, molecules

#: Angstroms of a nanometre, and first column of the places of GROMACS.
_NANOMETRE, _FIRST = 10.0, 20
#: First letters of names of atoms that are elements, and ions that are a residue of one atom.
_ELEMENTS = {*"HBCNOFPSIK"}
_IONS = {
    "LI", "NA", "K", "RB", "CS", "MG", "CA", "SR", "BA", "MN", "FE", "CO", "NI", "CU", "ZN", "CD",
    "F", "CL", "BR", "I", "HE", "NE", "AR", "KR", "XE",
}  # fmt: skip
#: Begin of a line of a bond, or of an atom.
_NUMBERS = re.compile(r"\s*-?\d+[\d.]*\s+-?\d")


def of_gro(path: Path) -> pv.PolyData:
    """Return the first frame of a GROMACS file in angstroms, its bonds by the distances of atoms.

    The names of atoms give their elements. Where no atoms are joined they are beads, which have no
    element, and the usual distance to the nearest one as their radius. Bonds and atoms are as of
    :func:`.molecules.of_pdb`, with ``residue_name`` and, where the file has it, ``velocity`` in
    nm/ps.
    """
    lines = _lines(path)
    count = _count(lines[1] if len(lines) > 1 else "")
    atoms = lines[2 : 2 + count]
    if len(atoms) < count or len(lines) < count + 3:
        raise ValueError(f"{max(len(lines) - 3, 0)} of {count} atoms and their box are there")
    if (states := len(lines) // (count + 3)) > 1:
        molecules.warn_of_states(path, states)
    more = sum(1 for line in lines[states * (count + 3) :] if line.strip())
    file_parts.warn_of_more(path, more, "lines")
    # Decimal points are as far apart as columns are wide.
    points = [i for i, letter in enumerate(atoms[0] if atoms else "") if letter == "."]
    wide = points[1] - points[0] if len(points) > 1 else 1
    starts = [_FIRST + i * wide for i in range(6 if len(points) > 5 else 3)]
    rows = molecules.numbers_of([[line[i : i + wide] for i in starts] for line in atoms])
    names = [(line[5:10].strip(), line[10:15].strip()) for line in atoms]
    elements = [_element(*pair) for pair in names]
    mesh = molecules.joined(elements, _NANOMETRE * rows[:, :3])
    residues = molecules.numbers_of([line[:5] for line in atoms])
    mesh.point_data["residue"] = residues.astype(np.intp)
    if rows.shape[1] > 3:
        mesh.point_data["velocity"] = rows[:, 3:]
        said = meaning.of(mesh)
        said.add_array("velocity", {"units": "nm/ps"})
        meaning.attach(mesh, said)
    molecules.attach_chains(
        mesh,
        ["A"] * count,
        [(name, element) for (_, name), element in zip(names, elements, strict=True)],
        [residue for residue, _ in names],
    )
    if not mesh.n_lines:
        del mesh.point_data["atom_type"]
        apart = molecules.apart(np.asarray(mesh.points)) if count > 1 else _NANOMETRE
        mesh.point_data["radius"] = np.full(count, apart)
        mesh.set_active_scalars(molecules.RESIDUE)
    return mesh


def _element(residue: str, name: str) -> str:
    """Return the element of an atom by its name, an empty text where that tells none."""
    letters, of_residue = (re.sub("[^A-Z]", "", text.upper()) for text in (name, residue))
    if letters in _IONS and of_residue in (letters, "ION"):
        return letters
    return letters[:1] if letters[:1] in _ELEMENTS else ""


def of_mol2(path: Path) -> pv.PolyData:
    """Return the first molecule of a Tripos file with its bonds and charges, if it has these."""
    first, *others = "\n".join(_lines(path)).split("@<TRIPOS>MOLECULE")[1:] or [""]
    if others:
        molecules.warn_of_states(path, 1 + len(others), "molecules")
    rows = {
        head.strip(): [line.split() for line in body.splitlines() if line.strip()]
        for head, _, body in (part.partition("\n") for part in first.split("@<TRIPOS>")[1:])
    }
    atoms, bonds = rows.get("ATOM", []), rows.get("BOND", [])
    # The counts stand below the name of the molecule.
    lines = [line for line in first.splitlines() if not line.startswith("#")]
    _check_counts(lines[2:3], atoms, bonds)
    elements = [_of_type(" ".join(row[5:6])) for row in atoms]
    pairs = _pairs([row[0] for row in atoms], [row[1:3] for row in bonds])
    places = molecules.numbers_of([row[2:5] for row in atoms])
    mesh = molecules.joined(elements, places, pairs, name=" ".join(lines[1:2]))
    if all(len(row) > 8 for row in atoms):
        mesh.point_data["charge"] = molecules.numbers_of([row[8:9] for row in atoms])[:, 0]
    return mesh


def _of_type(word: str) -> str:
    """Return the element of a type of Tripos, such as ``C.ar``, or of Amber's GAFF, as ``ca``."""
    symbol = word.partition(".")[0]
    return symbol[: 2 if symbol in ("br", "cl") else 1].upper() if symbol.islower() else symbol


def of_mol(path: Path) -> pv.PolyData:
    """Return the first molecule of an MDL file with its bonds."""
    lines = _lines(path)
    if (states := sum(line.startswith("$$$$") for line in lines)) > 1:
        molecules.warn_of_states(path, states, "molecules")
    counts = lines[3] if len(lines) > 3 else ""
    if "V3000" in counts:
        text = "\n".join(line.removeprefix("M  V30 ") for line in lines)
        parts = {name: rf"(?ms)^BEGIN {name}$(.*?)^END {name}$" for name in ("ATOM", "BOND")}
        atoms, bonds = (
            [line.split() for line in "".join(re.findall(part, text)[:1]).splitlines() if line]
            for part in parts.values()
        )
        _check_counts(re.findall(r"(?m)^COUNTS (.*)", text)[:1], atoms, bonds)
        elements, places = [row[1] for row in atoms], [row[2:5] for row in atoms]
        pairs = _pairs([row[0] for row in atoms], [row[2:4] for row in bonds])
    else:
        n_atoms, n_bonds = _count(counts[:3]), _count(counts[3:6])
        rows = lines[4 : 4 + n_atoms + n_bonds]
        if len(rows) < n_atoms + n_bonds:
            raise ValueError(f"{len(rows)} of {n_atoms + n_bonds} atoms and bonds are there")
        if _NUMBERS.match("".join(lines[4 + n_atoms + n_bonds :][:1])):
            raise ValueError(f"it has more than {n_atoms} atoms and {n_bonds} bonds")
        elements = [line[31:34].strip() for line in rows[:n_atoms]]
        places = [[line[:10], line[10:20], line[20:30]] for line in rows[:n_atoms]]
        ends = [[line[:3].strip(), line[3:6].strip()] for line in rows[n_atoms:]]
        pairs = _pairs([str(i + 1) for i in range(n_atoms)], ends)
    return molecules.joined(elements, molecules.numbers_of(places), pairs, name=lines[0])


def _lines(path: Path) -> list[str]:
    """Return the lines of a text."""
    data = path.read_bytes()
    file_parts.warn_of_last_line(path, data)
    return data.decode("latin-1").splitlines()


def _count(word: str) -> int:
    """Return the number of atoms or bonds that a file states."""
    if not word.strip().isdigit():
        raise ValueError(f"no number of atoms or bonds in {word[:40]!r}")
    return int(word)


def _check_counts(lines: Sequence[str], *parts: Sequence[object]) -> None:
    """Compare the atoms and the bonds with the numbers at the begin of a line, if there is one."""
    stated = " ".join(lines).split()
    for what, rows, count in zip(("atoms", "bonds"), parts, stated, strict=False):
        if _count(count) != len(rows):
            raise ValueError(f"{len(rows)} of {count} {what} are there")


def _pairs(names: Sequence[str], ends: Sequence[Sequence[str]]) -> Indices:
    """Return the rows of the atoms that bonds join by their names."""
    row_of = {name: i for i, name in enumerate(names)}
    if lost := next((name for pair in ends for name in pair if name not in row_of), None):
        raise ValueError(f"a bond has the atom {lost}, which is not there")
    return np.array([[row_of[name] for name in pair] for pair in ends], np.intp).reshape(-1, 2)
