"""Meshes of SU2: the cells of each zone, without the markers of its boundary.

Source: "Mesh File" in the documentation of SU2. A line holds a point or a cell, and may end with
its number.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Array, Indices
from vizlight.reading import file_parts

#: Number of corners of each kind of cell, by VTK's number of it, which SU2 has too.
_CORNERS = {3: 2, 5: 3, 9: 4, 10: 4, 12: 8, 13: 6, 14: 5}


class _Zone:
    """Points, cells and markers of a zone, as rows of words."""

    def __init__(self) -> None:
        self.dimensions = 0
        self.points: list[list[bytes]] | None = None
        self.cells: list[list[bytes]] = []
        self.markers: dict[str, list[list[bytes]]] = {}

    def blocks(self) -> dict[str, pv.UnstructuredGrid]:
        """Return the cells, or without cells the markers by name."""
        if self.dimensions not in (2, 3) or self.points is None:
            raise ValueError("no NDIME of 2 or 3, or no NPOIN")
        short = [row for row in self.points if len(row) < self.dimensions]
        if short:
            raise ValueError(f"{len(short[0])} of {self.dimensions} coordinates of a point")
        places: Array = np.zeros((len(self.points), 3))
        for axis in range(self.dimensions):
            places[:, axis] = [float(row[axis]) for row in self.points]
        of = {"": self.cells} if self.cells else self.markers
        return {name: pv.UnstructuredGrid(_by_kind(rows), places) for name, rows in of.items()}


def read(path: Path) -> pv.MultiBlock:
    """Return the zones of a file, each as a block."""
    zones, marker = [_Zone()], ""
    data = path.read_bytes()
    file_parts.warn_of_last_line(path, data)
    lines = iter([line for text in data.splitlines() if (line := text.partition(b"%")[0].strip())])
    for line in lines:
        word, sign, value = (part.strip() for part in line.partition(b"="))
        if not sign:
            continue  # what belongs to a keyword that says nothing of cells
        if word == b"IZONE" and zones[-1].points is not None:
            zones.append(_Zone())
        elif word == b"NDIME":
            zones[-1].dimensions = _count(word, value)
        elif word == b"NPOIN":
            zones[-1].points = _rows(lines, word, value)
        elif word == b"NELEM":
            zones[-1].cells = _rows(lines, word, value)
        elif word == b"MARKER_TAG":
            marker = value.decode("latin-1")
        elif word == b"MARKER_ELEMS":
            zones[-1].markers[marker] = _rows(lines, word, value)
    blocks = pv.MultiBlock()
    for i, zone in enumerate(zones):
        for name, grid in zone.blocks().items():
            blocks.append(grid, f"zone {i} {name}".strip())
    return blocks


def _count(word: bytes, value: bytes) -> int:
    """Return the number of a keyword, of which more may stand after the first."""
    first = value.split()[:1]
    if not first or not first[0].isdigit():
        raise ValueError(f"{value.decode('latin-1')[:20]!a} is no number of {word.decode()}")
    return int(first[0])


def _rows(lines: Iterator[bytes], word: bytes, value: bytes) -> list[list[bytes]]:
    """Return the words of as many lines as a keyword says."""
    count = _count(word, value)
    rows = [line.split() for line in itertools.islice(lines, count)]
    there = sum(1 for _ in itertools.takewhile(lambda row: b"=" not in b"".join(row), rows))
    if there < count:
        raise ValueError(f"{there} of {count} lines of {word.decode()} are there")
    return rows


def _by_kind(rows: list[list[bytes]]) -> dict[int, Indices]:
    """Return the corners of cells by their kind."""
    corners_by_kind: dict[int, list[list[int]]] = {}
    for row in rows:
        kind = int(row[0])
        corners = _CORNERS.get(kind)
        if corners is None:
            raise ValueError(f"{kind} is no kind of cell")
        if len(row) <= corners:
            raise ValueError(f"{len(row) - 1} of {corners} corners of a cell are there")
        corners_by_kind.setdefault(kind, []).append([int(word) for word in row[1 : corners + 1]])
    return {kind: np.array(corners, dtype=np.int64) for kind, corners in corners_by_kind.items()}
