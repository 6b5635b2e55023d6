"""OFF and MESH files of Geomview: polygons, colours, normals, and surfaces in 4-space.

Source: the manual of Geomview, "OFF Files" and "MESH Files". A line holds a vertex or a face.
"""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from vizlight._types import Array, Bools, Indices
from vizlight.geometry.nspace import lattice
from vizlight.mesh import blocks
from vizlight.mesh.nspace import POSITION
from vizlight.reading import file_parts

#: Words at the start of a file, and the meaning of each letter before OFF and MESH for a vertex.
_OFF = re.compile(rb"\s*(?:#.*\n\s*)*(ST)?(C)?(N)?(4)?(n)?OFF\b")
_MESH = re.compile(rb"\s*(?:#.*\n\s*)*(U)?(C)?(N)?(Z)?(4)?(u)?(v)?MESH\b")
_HEAD = 4096


def is_mesh(path: Path) -> bool:
    """Return whether a file is a MESH of Geomview; other formats share the suffix."""
    return _MESH.match(file_parts.first_bytes(path, _HEAD)) is not None


def read_off(path: Path) -> pv.PolyData:
    """Return the surface of an OFF file, with places in 4-space as the array ``position``."""
    data = path.read_bytes()
    start = _OFF.match(data)
    textured, coloured, normal, four, n = start.groups() if start else (None,) * 5
    rows = _rows(data[start.end() :] if start else data)
    width = 4 if four else 3
    if n:
        width = _count(rows[0][0], "dimension") + bool(four)
        rows[0] = rows[0][1:]
    rows = [row for row in rows if row]
    if not rows or len(rows[0]) < 2:
        raise ValueError("no numbers of vertices and faces in an OFF file")
    points, faces = (_count(word, "number of vertices and faces") for word in rows[0][:2])
    if len(rows) - 1 < points + faces:
        words = [*rows[0][3:], *(word for row in rows[1:] for word in row)]
        size = width + 3 * bool(normal) + 4 * bool(coloured) + 2 * bool(textured)
        rows[1:] = _broken(words, points, faces, size)
    file_parts.warn_of_more(path, len(rows) - 1 - points - faces, "lines")
    table = _table(rows[1 : points + 1])
    mesh = _with_vertices(table, width, bool(normal), bool(coloured), bool(textured))
    ids, ends, colors = [], [0], []
    for row in rows[points + 1 : points + 1 + faces]:
        size = _count(row[0], "number of corners")
        if len(row) < size + 1:
            raise ValueError(f"{len(row) - 1} of {size} corners of a face are there")
        ids += [_count(word, "number of a vertex") for word in row[1 : size + 1]]
        ends.append(len(ids))
        colors.append(row[size + 1 :])
    sizes, corners = np.diff(ends), np.array(ids, dtype=int)
    file_parts.warn_of_less(path, int(np.count_nonzero(sizes)), faces, "faces")
    mesh.SetPolys(_of_sizes(corners, sizes, sizes > 2))
    mesh.SetLines(_of_sizes(corners, sizes, sizes == 2))
    mesh.SetVerts(_of_sizes(corners, sizes, sizes == 1))
    if not faces:
        mesh.SetVerts(blocks.cell_array(np.arange(points), np.arange(points + 1)))
    if colors and mesh.GetNumberOfPolys() == faces and {len(row) for row in colors} in ({3}, {4}):
        mesh.cell_data["color"] = _bytes(_table(colors))
    return mesh


def _of_sizes(corners: Indices, sizes: Indices, chosen: Bools) -> pv.CellArray:
    """Return some of the cells that follow one another among corners."""
    ends = np.concatenate([[0], np.cumsum(sizes[chosen])])
    return blocks.cell_array(corners[np.repeat(chosen, sizes)], ends)


def _broken(words: list[bytes], points: int, faces: int, size: int) -> list[list[bytes]]:
    """Return the rows of words whose lines break anywhere: vertices of one size, then faces."""
    whole = min(points, len(words) // size)
    ends = [size * i for i in range(whole + 1)]
    while whole == points and len(ends) <= points + faces and ends[-1] < len(words):
        ends.append(ends[-1] + 1 + _count(words[ends[-1]], "number of corners"))
    if len(ends) <= points + faces or ends[-1] > len(words):
        there = sum(end <= len(words) for end in ends[1:])
        raise ValueError(f"{there} of {points + faces} vertices and faces are there")
    if more := len(words) - ends[-1]:
        raise ValueError(f"{more} numbers are in no vertex or face")
    return [words[start:end] for start, end in itertools.pairwise(ends)]


def read_mesh(path: Path) -> pv.PolyData:
    """Return the surface of a MESH file, with places in 4-space as the array ``position``."""
    data = path.read_bytes()
    start = _MESH.match(data)
    if start is None:
        raise ValueError("no MESH of Geomview")
    textured, coloured, normal, heights, four, u, v = start.groups()
    words = [word for row in _rows(data[start.end() :]) for word in row]
    if len(words) < 2:
        raise ValueError("no numbers of vertices in a MESH file")
    columns, rows = (_count(word, "number of vertices") for word in words[:2])
    place = 1 if heights else 4 if four else 3
    width = place + 3 * bool(normal) + 4 * bool(coloured) + 3 * bool(textured)
    count = columns * rows
    if len(words) - 2 < count * width:
        raise ValueError(f"{len(words) - 2} of {count * width} numbers are there")
    file_parts.warn_of_more(path, len(words) - 2 - count * width, "numbers")
    table = _table([words[2 : 2 + count * width]]).reshape(count, width)
    if heights:
        grid = np.indices((rows, columns)).reshape(2, -1)[::-1].T
        table, place = np.hstack([grid, table]), 3
    mesh = _with_vertices(table, place, bool(normal), bool(coloured), textured=False)
    corners = lattice.cells((rows, columns), (v is not None, u is not None), by_rows=True)
    mesh.SetPolys(pv.CellArray.from_regular_cells(corners.astype(int, copy=False)))
    return mesh


def _rows(data: bytes) -> list[list[bytes]]:
    """Return the words of each line, without comments."""
    if re.match(rb"\s*BINARY\b", data):
        raise ValueError("a binary file of Geomview, which is not read: save it as text")
    return [line.partition(b"#")[0].split() for line in data.splitlines() if line.strip()] or [[]]


def _count(word: bytes, what: str) -> int:
    if not word.isdigit():
        raise ValueError(f"{word[:20].decode('latin-1')!r} is no {what}")
    return int(word)


def _table(rows: list[list[bytes]]) -> Array:
    """Return numbers, as many in each row."""
    if len({len(row) for row in rows}) > 1:
        raise ValueError("vertices or colours of different numbers of components")
    return np.array(rows, dtype=np.float64) if rows else np.zeros((0, 3))


def _with_vertices(
    table: Array, width: int, normal: bool, coloured: bool, textured: bool
) -> pv.PolyData:
    """Return points with their arrays; a colour has the components that the others leave."""
    rest = table.shape[1] - width - 3 * normal - 2 * textured
    if rest < 3 * coloured:
        raise ValueError(f"{table.shape[1]} components per vertex, which are too few")
    mesh = pv.PolyData()
    places = np.zeros((len(table), 3))
    places[:, : min(width, 3)] = table[:, : min(width, 3)]
    mesh.points = places
    if width > 3:
        mesh.point_data[POSITION] = table[:, :width].copy()
    if normal:
        mesh.point_data["Normals"] = table[:, width : width + 3].copy()
        mesh.point_data.active_normals_name = "Normals"
    first = width + 3 * normal
    if coloured:
        colors = table[:, first : first + min(rest, 4)]
        mesh.point_data["color"] = _bytes(colors)
    return mesh


def _bytes(colors: Array) -> NDArray[np.uint8]:
    """Return colours as bytes: shares from 0 to 1, or whole numbers to 255."""
    scaled = colors if colors.max(initial=0) > 1 else 255 * colors
    return np.clip(np.rint(scaled), 0, 255).astype(np.uint8)
