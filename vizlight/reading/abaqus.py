"""Input files of Abaqus and CalculiX: nodes and elements of parts, as instances place them.

Source: "Abaqus Keywords Guide" and "CalculiX CrunchiX User's Manual". A line of a keyword begins
with one asterisk, a comment with two; lines of data follow a keyword.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.vtk.cells import TYPES

#: Names of elements, in which the number of their nodes stands, by the dimension of their cells.
_FAMILIES = {
    3: re.compile(r"(?:C|AC|DC|DCC|EMC|CIN|COH|GK|F|Q)3D(\d+)|(?:SC|CSS)(\d+)"),
    2: re.compile(
        r"(?:CPS|CPE|CPEG|CAX|CGAX|CAXA|DC2D|AC2D|DCC2D|DCAX|DCCAX|ACAX|COH2D|COHAX"
        r"|S|DS|M3D|R3D|SFM3D|STRI)(\d)"
    ),
    1: re.compile(r"(?:B[23]|T[23]D|PIPE[23]|F[23]D|R[2A][DX]|M?SAX|DSAX|MAX)(\d)"),
}
#: Keywords by which nodes and elements are made of others.
_MADE = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBMODEL"}
#: Files in files.
_DEEPEST = 16


@dataclass
class _Part:
    """Nodes and elements, as listed in the file."""

    row_of: dict[int, int] = field(default_factory=dict)
    points: list[list[float]] = field(default_factory=list)
    cells: dict[int, list[list[int]]] = field(default_factory=dict)

    def grid(self) -> pv.UnstructuredGrid:
        """Return the cells of the elements."""
        cells: dict[int, Indices] = {}
        for kind, rows in self.cells.items():
            try:
                corners = np.array([[self.row_of[node] for node in row] for row in rows])
            except KeyError as error:
                raise ValueError(f"an element has the node {error}, which is not there") from None
            # An edge of three nodes has the one in the middle as the second.
            cells[kind] = corners[:, [0, 2, 1]] if kind == pv.CellType.QUADRATIC_EDGE else corners
        return pv.UnstructuredGrid(cells, np.array(self.points).reshape(-1, 3))


class _Model:
    """Parts of a file and of those that it includes."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.parts: dict[str, _Part] = {"": _Part()}
        self.instances: dict[str, tuple[str, list[list[str]]]] = {}
        self.part = ""
        self.left: set[str] = set()

    def take(self, keyword: str, parameters: dict[str, str], rows: list[list[str]]) -> None:
        """Take a keyword with its parameters and its lines of data."""
        name = parameters.get("NAME", "").upper()
        if keyword in ("PART", "END PART", "END INSTANCE"):
            self.part = name if keyword == "PART" else ""
            self.parts.setdefault(self.part, _Part())
        elif keyword == "INSTANCE":
            part_name = parameters.get("PART", "").upper()
            if part_name not in self.parts:
                raise ValueError(f"*INSTANCE of the part {part_name!r}, which is not there")
            self.instances[name] = part_name, rows
        elif keyword == "NODE":
            if parameters.get("SYSTEM", "R").upper() != "R":
                raise ValueError("*NODE, SYSTEM= other than R is not read: write x, y and z")
            self._nodes(rows)
        elif keyword == "ELEMENT":
            self._elements(parameters.get("TYPE", "").upper(), rows)
        elif keyword in _MADE:
            raise ValueError(f"*{keyword} is not read: write the mesh with each node and element")

    def _nodes(self, rows: list[list[str]]) -> None:
        part = self.parts[self.part]
        for row in rows:
            place = [float(word) for word in row[1:4] if word]
            part.row_of[int(row[0])] = len(part.points)
            part.points.append(place + [0.0] * (3 - len(place)))

    def _elements(self, kind: str, rows: list[list[str]]) -> None:
        size, cell = _kind(kind)
        if not cell:
            self.left.add(kind)
            return
        words = [int(word) for row in rows for word in row if word]
        if len(words) % (size + 1):
            raise ValueError(f"{len(words)} numbers are no elements of {kind}, of {size} nodes")
        cells = self.parts[self.part].cells.setdefault(cell, [])
        cells += [words[i + 1 : i + size + 1] for i in range(0, len(words), size + 1)]

    def blocks(self) -> pv.MultiBlock:
        """Return the parts as their instances place them, and the parts of no instance."""
        blocks = pv.MultiBlock()
        for name, (part_name, rows) in self.instances.items():
            if self.parts[part_name].cells:
                blocks.append(_placed(self.parts[part_name].grid(), rows), name)
        for name, part in self.parts.items():
            if part.cells and (not name or not self.instances):
                blocks.append(part.grid(), name or "mesh")
        if self.left:
            names = ", ".join(sorted(self.left))
            _check.warn(f"file: '{self.path}': elements without cells are left out: {names}")
        return blocks


def read(path: Path) -> pv.MultiBlock:
    """Return the parts of a file, each as a block."""
    model = _Model(path)
    keyword, parameters, rows = "", dict[str, str](), list[list[str]]()
    for line in _lines(path, path.parent, 0):
        if not line.startswith("*"):
            rows.append([word.strip() for word in line.split(",")])
            continue
        model.take(keyword, parameters, rows)
        (keyword, parameters), rows = _keyword(line), []
    model.take(keyword, parameters, rows)
    return model.blocks()


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    """Return the word of a line of a keyword, and its parameters."""
    word, *parameters = line.lstrip("*").split(",")
    pairs = [part.partition("=") for part in parameters]
    values = {name.strip().upper(): value.strip().strip("\"'") for name, _, value in pairs}
    return " ".join(word.upper().split()), values


def _lines(path: Path, folder: Path, depth: int) -> Iterator[str]:
    """Yield the lines of a file without comments, and those of the files that it includes."""
    if depth > _DEEPEST:
        raise ValueError(f"'{path.name}' includes itself, or more than {_DEEPEST} files in files")
    with path.open(encoding="latin-1") as file:
        for text in file:
            line = text.strip()
            if not line or line.startswith("**"):
                continue
            keyword, words = _keyword(line) if line.startswith("*") else ("", {})
            if keyword != "INCLUDE":
                yield line
            if "INPUT" in words and keyword in ("INCLUDE", "NODE", "ELEMENT"):
                inner = folder / words["INPUT"]
                if not inner.is_file():
                    raise ValueError(f"*{keyword} of '{words['INPUT']}': no such file beside it")
                yield from _lines(inner, folder, depth + 1)


def _kind(name: str) -> tuple[int, int]:
    """Return the number of nodes and the cell of a type of elements, zeros where it has none."""
    for dimension, family in _FAMILIES.items():
        if match := family.match(name):
            size = int(next(filter(None, match.groups())))
            # Beams and shells of revolution have their order there, of which the third has two
            # nodes; trusses and rigid links have the number of nodes.
            if dimension == 1 and name[0] not in "RT":
                size = {1: 2, 2: 3, 3: 2}.get(size, 0)
            return size, TYPES.get((dimension, size), 0)
    return 0, 0


def _placed(grid: pv.UnstructuredGrid, rows: list[list[str]]) -> pv.UnstructuredGrid:
    """Return a grid moved by a first line and turned by a second: two points and an angle."""
    numbers = [[float(word) for word in row if word] for row in rows]
    points: Array = np.array(grid.points, dtype=np.float64)
    if numbers:
        points += (numbers[0] + [0.0] * 3)[:3]
    if len(numbers) > 1:
        if len(numbers[1]) != 7:
            raise ValueError(f"{len(numbers[1])} of 7 numbers of the turn of an *INSTANCE")
        start, end = np.reshape(numbers[1][:6], (2, 3))
        axis = (end - start) / np.linalg.norm(end - start)
        turn = scipy.spatial.transform.Rotation.from_rotvec(np.radians(numbers[1][6]) * axis)
        points = turn.apply(points - start)
        points += start
    grid.points = points
    return grid
