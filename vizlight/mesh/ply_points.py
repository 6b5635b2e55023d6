"""Points of PLY files in float64, which VTK's reader rounds to float32."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from vizlight._types import Array

#: Types of NumPy by those of PLY.
_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_HEAD = 100_000


def exact(path: Path) -> Array | None:
    """Return the places of the vertices of a PLY file, None where they are not float64 in it.

    Parameters
    ----------
    path : pathlib.Path
        File that VTK has read, and whose header is whole.

    Returns
    -------
    ndarray of float64, shape (N, 3), or None
    """
    with path.open("rb") as file:
        head = re.match(rb"ply\s.*?^end_header\r?\n", file.read(_HEAD), re.DOTALL | re.MULTILINE)
        if head is None:
            return None
        lines = [line.split() for line in head[0].decode("latin-1").splitlines()]
        form = next((words[1] for words in lines if words[:1] == ["format"]), "")
        elements = [i for i, words in enumerate(lines) if words[:1] == ["element"]]
        if not elements or lines[elements[0]][1] != "vertex":
            return None  # what stands before the vertices may have lists of any length
        count = int(lines[elements[0]][2])
        own = lines[elements[0] + 1 : elements[1] if len(elements) > 1 else None]
        kinds = [(words[2], _TYPES.get(words[1])) for words in own if words[:1] == ["property"]]
        columns = {name: (i, kind) for i, (name, kind) in enumerate(kinds)}
        at = [columns.get(axis, (0, None)) for axis in "xyz"]
        if any(kind is None for _, kind in kinds) or any(kind != "f8" for _, kind in at):
            return None
        file.seek(head.end())
        if form == "ascii":
            rows = (next(file).split() for _ in range(count))
            return np.array([[float(row[i]) for i, _ in at] for row in rows]).reshape(-1, 3)
        order = ">" if "big" in form else "<"
        row = np.dtype([(name, f"{order}{kind}") for name, kind in kinds])
        table = np.frombuffer(file.read(count * row.itemsize), dtype=row, count=count)
        return np.column_stack([table[axis] for axis in "xyz"]).astype(np.float64)
