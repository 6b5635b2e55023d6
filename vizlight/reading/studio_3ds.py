"""Files of 3D Studio (.3ds): the points and the triangles of each object.

VTK's importer ends the process at counts that are wrong. A file is a tree of chunks, each with a
number of its kind and its size. Points are in the space of the whole scene.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Foreign

#: Kinds of chunks that hold others: a file, its scene, a mesh; and an object, after its name.
_HOLDERS, _OBJECT = (0x4D4D, 0x3D3D, 0x4100), 0x4000
#: Those of points and of triangles, which begin with the number of their rows.
_POINTS, _TRIANGLES = 0x4110, 0x4120


def read(path: Path) -> pv.MultiBlock:
    """Return the objects of a file that have triangles."""
    data = path.read_bytes()
    shapes, count = pv.MultiBlock(), 0
    points: Foreign = ()
    for kind, begin, end in _chunks(data):
        if kind == _OBJECT:
            points = ()
        elif kind == _POINTS:
            points, count = _rows(data, begin, end, "<f4", 3), count + 1
        elif kind == _TRIANGLES:
            # The fourth number says which edges are seen.
            corners = _rows(data, begin, end, "<u2", 4)[:, :3].astype(np.intp)
            if (last := corners.max(initial=-1)) >= len(points):
                raise ValueError(f"a triangle has the point {last} of {len(points)}")
            if len(corners):
                shapes.append(pv.PolyData.from_regular_faces(points, corners))
    if (empty := count - shapes.n_blocks) > 0 < shapes.n_blocks:
        _check.warn(f"file: '{path}': {empty} of {count} objects are left out: no triangles")
    return shapes


def _chunks(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield the kind of each chunk, and where its content begins and ends."""
    ends, place = [len(data)], 0
    while ends:
        if place + 6 > ends[-1]:
            place = ends.pop()
            continue
        kind, size = struct.unpack_from("<HI", data, place)
        if not 6 <= size <= ends[-1] - place:
            raise ValueError(f"a part of {size} bytes is not within {ends[-1] - place}")
        begin, end = place + 6, place + size
        yield kind, begin, end
        if kind in _HOLDERS or kind == _OBJECT:
            ends.append(end)
            end = data.index(b"\0", begin) + 1 if kind == _OBJECT else begin
        place = end


def _rows(data: bytes, begin: int, end: int, kind: str, width: int) -> Foreign:
    """Return the rows of numbers of a chunk, which are as many as it states."""
    (count,) = struct.unpack_from("<H", data, begin)
    size = np.dtype(kind).itemsize * width * count
    if size > end - begin - 2:
        raise ValueError(f"{count} rows are not within {end - begin - 2} bytes")
    return np.frombuffer(data, kind, width * count, begin + 2).reshape(-1, width)
