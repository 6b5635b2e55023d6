"""Atoms in dumps of LAMMPS: the first step, at their places in its box."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Array
from vizlight.mesh import meaning
from vizlight.reading import file_parts, molecules

#: Columns of places, the last two in shares of the box; those of vectors; those of numbers.
_PLACES = (("x", "y", "z"), ("xu", "yu", "zu"), ("xs", "ys", "zs"), ("xsu", "ysu", "zsu"))
_VECTORS = {"velocity": ("vx", "vy", "vz"), "force": ("fx", "fy", "fz")}
_NUMBERS = {"q": "charge", "mol": "molecule_id", "mass": "mass"}
#: Begin of a step.
_STEP = "ITEM: TIMESTEP"


def read(path: Path) -> pv.PolyData | None:
    """Return the atoms of the first step of a dump; None where it is no dump in text.

    Where the dump has elements, bonds and atoms are as of :func:`.molecules.of_xyz`. Else points
    are in the unit of the simulation with ``atom_type``, its type in the simulation, and
    ``radius``, the median distance of nearest neighbours. Further arrays are ``velocity``,
    ``force``, ``charge``, ``molecule_id`` and ``mass``, as far as the dump has them.
    """
    data = path.read_bytes()
    if not data.lstrip().startswith((b"ITEM: TIMESTEP", b"ITEM: UNITS", b"ITEM: TIME")):
        return None
    file_parts.warn_of_last_line(path, data)
    text = data.decode("latin-1")
    if (states := text.count(_STEP)) > 1:
        molecules.warn_of_states(path, states)
    first = text[text.index(_STEP) :].split(_STEP)[1]
    items = {
        head.strip(): body.splitlines()
        for head, _, body in (part.partition("\n") for part in f"\n{first}".split("\nITEM: ")[1:])
    }
    names = {re.split(r"[^A-Z ]", head)[0].strip(): head for head in items}
    if not {"NUMBER OF ATOMS", "ATOMS"} <= {*names}:
        raise ValueError("it has no atoms")
    columns = names["ATOMS"].split()[1:]
    count, rows = items["NUMBER OF ATOMS"], [line.split() for line in items[names["ATOMS"]] if line]
    if not count or not count[0].strip().isdigit() or int(count[0]) != len(rows):
        raise ValueError(f"{len(rows)} of {' '.join(count)} atoms are there")
    if any(len(row) != len(columns) for row in rows):
        raise ValueError(f"an atom has not the {len(columns)} columns of the dump")
    table = dict(zip(columns, zip(*rows, strict=True), strict=True))
    if "id" in table:
        # Processes write their atoms in any order.
        order = np.argsort(molecules.numbers_of(table["id"]), kind="stable")
        table = {name: tuple(np.array(words)[order].tolist()) for name, words in table.items()}
    box = names.get("BOX BOUNDS", "")
    return _mesh(table, _places(table, box, items.get(box, [])))


def _places(table: dict[str, tuple[str, ...]], head: str, box: list[str]) -> Array:
    """Return the places of atoms, of those in shares of the box by its sides and tilts."""
    axes = next((names for names in _PLACES if {*names} <= {*table}), None)
    if axes is None:
        raise ValueError(f"it has no columns of places, such as x y z, among {' '.join(table)}")
    places = np.column_stack([molecules.numbers_of(table[name]) for name in axes])
    if axes in _PLACES[:2]:
        return places
    bounds = np.array([molecules.numbers_of(line.split()) for line in box[:3]])
    if "abc" in head or bounds.shape not in ((3, 2), (3, 3)):
        raise ValueError("places in shares of a box need its bounds as three rows xlo xhi")
    xy, xz, yz = bounds[:, 2] if bounds.shape[1] > 2 else (0.0, 0.0, 0.0)
    # The bounds of a tilted box are those around it.
    along = (0.0, xy, xz, xy + xz), (0.0, yz), (0.0,)
    low = bounds[:, 0] - [min(tilts) for tilts in along]
    sides = bounds[:, 1] - [max(tilts) for tilts in along] - low
    cell = np.array([[sides[0], xy, xz], [0, sides[1], yz], [0, 0, sides[2]]])
    return np.asarray(low + places @ cell.T)


def _mesh(table: dict[str, tuple[str, ...]], places: Array) -> pv.PolyData:
    """Return atoms with the columns of a dump as arrays."""
    if "element" in table:
        mesh = molecules.joined(table["element"], places)
    else:
        mesh = pv.PolyData(places)
        types = molecules.numbers_of(table.get("type", ("1",) * len(places))).astype(np.intp)
        mesh.point_data["atom_type"] = types
        apart = molecules.apart(places) if len(places) > 1 else 0.0
        mesh.point_data["radius"] = np.full(len(places), apart or 1.0)
        mesh.set_active_scalars("atom_type")
        said = meaning.Meaning()
        said.add_kinds("atom_type", [(i, f"type {i}", ()) for i in sorted({*types.tolist()})])
        said.arrays["atom_type"]["long_name"] = "atom type"
        meaning.attach(mesh, said)
    for name, names in _VECTORS.items():
        if {*names} <= {*table}:
            mesh.point_data[name] = molecules.numbers_of([table[each] for each in names]).T
    for column, name in _NUMBERS.items():
        if column in table:
            numbers = molecules.numbers_of(table[column])
            mesh.point_data[name] = numbers.astype(np.intp) if column == "mol" else numbers
    return mesh
