"""Molecules of PDB and XYZ files: one state of their atoms, joined by bonds."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkMolecule

from vizlight import _check, _supervise

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

#: End of the first of several models of a PDB file, and the start of each.
_END, _MODEL = re.compile(rb"^ENDMDL", re.MULTILINE), re.compile(rb"^MODEL ", re.MULTILINE)
#: Line of an atom in an XYZ file: its symbol, and what may follow its place.
_ATOM = re.compile(r"[A-Za-z]{1,3}\d*$")


def of_pdb(path: Path) -> pv.PolyData | None:
    """Return the first of several models; None where there is one, which PyVista reads.

    VTK's reader joins the atoms of all models by bonds with each other.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    """
    data = path.read_bytes()
    count = len(_MODEL.findall(data))
    end = _END.search(data)
    if count < 2 or end is None:
        return None
    with _supervise.folder(path) as folder:
        draft = folder / "first.pdb"
        draft.write_bytes(data[: end.end()] + b"\n")
        mesh = pv.read(draft, validate=False)
    _warn_of_states(path, count)
    assert isinstance(mesh, pv.PolyData)
    return mesh


def of_xyz(lines: Sequence[str], path: Path) -> pv.PolyData | None:
    """Return the first state of a molecule, its bonds by the distances of its atoms.

    Parameters
    ----------
    lines : sequence of str
        Lines of the file: the number of atoms, a comment, and a symbol and a place for each atom.
    path : pathlib.Path
        Path of the file, for messages.

    Returns
    -------
    pyvista.PolyData or None
        Bonds, and points of atoms without any, with ``atom_type``, the atomic number; None where
        the lines are of another form.

    Raises
    ------
    ValueError
        If atoms are missing, or a line has no element or no place.
    """
    words = [line.split() for line in lines]
    third = words[2] if len(words) > 2 else []
    if len(words[0]) != 1 or not words[0][0].isdigit() or not third or not _ATOM.match(third[0]):
        return None
    # Few files need what takes 10 ms to load.
    from vtkmodules.vtkDomainsChemistry import (
        vtkMoleculeToLinesFilter,
        vtkPeriodicTable,
        vtkSimpleBondPerceiver,
    )

    count = int(words[0][0])
    atoms = words[2 : 2 + count]
    if len(atoms) < count:
        raise ValueError(f"{len(atoms)} of {count} atoms are there")
    table, molecule = vtkPeriodicTable(), vtkMolecule()
    for number, atom in enumerate(atoms):
        element = table.GetAtomicNumber(atom[0].rstrip("0123456789")) if atom else 0
        try:
            place = [float(word) for word in atom[1:4]]
        except ValueError:
            place = []
        if element == 0 or len(place) < 3 or not np.isfinite(place).all():
            raise ValueError(f"line {number + 3} has no element with a place of three numbers")
        molecule.AppendAtom(element, *place)
    if len(words) > 2 + count and words[2 + count] == words[0]:
        _warn_of_states(path, len(words) // (count + 2))
    bonds, drawn = vtkSimpleBondPerceiver(), vtkMoleculeToLinesFilter()
    bonds.SetInputData(molecule)
    drawn.SetInputConnection(bonds.GetOutputPort())
    drawn.Update()
    joined = pv.wrap(drawn.GetOutput())
    alone = np.setdiff1d(np.arange(count), joined.lines)
    mesh = pv.PolyData(
        np.asarray(joined.points, dtype=np.float64),
        lines=joined.lines,
        verts=np.column_stack([np.ones_like(alone), alone]),
    )
    mesh.point_data["atom_type"] = [molecule.GetAtomAtomicNumber(i) for i in range(count)]
    return mesh


def _warn_of_states(path: Path, count: int) -> None:
    _check.warn(f"file: '{path}': the first of {count} states of a molecule is read")
