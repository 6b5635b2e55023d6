"""Meshes of Kratos: its elements, or the conditions of a mesh without them, by their properties.

Source: "Input data" and "Mesh node ordering" in the documentation of Kratos Multiphysics.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv

from vizlight._types import Foreign
from vizlight.reading import file_parts
from vizlight.vtk.cells import TYPES

#: Order of the corners of a type in VTK, where it is another.
_ORDERS = {25: [*range(12), *range(16, 20), *range(12, 16)]}
_BLOCK = re.compile(rb"(?ms)^[ \t]*Begin[ \t]+(Nodes|Elements|Conditions)\b([^\n]*)(.*?)\bEnd\b")
#: Names of elements with a dimension less than that of the space they lie in.
_THIN = re.compile(rb"Shell|Membrane|Face|Surface|Triangle|Quadrilateral|Condition")


def read(path: Path) -> pv.UnstructuredGrid:
    """Return the cells of a file; ``property`` is the number of the properties of each."""
    content = path.read_bytes()
    file_parts.warn_of_last_line(path, content)
    blocks = _BLOCK.findall(re.sub(rb"//[^\n]*", b"", content))
    numbers = [body.split() for kind, _, body in blocks if kind == b"Nodes"]
    nodes = np.array([word for words in numbers for word in words], dtype=float).reshape(-1, 4)
    order = np.argsort(nodes[:, 0], kind="stable")
    ids = nodes[order, 0]
    kinds = [kind for kind, *_ in blocks]
    kept = b"Elements" if b"Elements" in kinds else b"Conditions"
    cells: dict[int, list[Foreign]] = {}
    for kind, name, body in blocks:
        rows = [line.split() for line in body.splitlines() if line.strip()]
        if kind == kept and rows:
            table = np.array(rows, dtype=np.int64)
            type_of_cell = _type(name, table.shape[1] - 2)
            corners = table[:, 2:][:, _ORDERS.get(type_of_cell, slice(None))]
            at = np.minimum(np.searchsorted(ids, corners), len(ids) - 1)
            if not len(ids) or not np.array_equal(ids[at], corners):
                raise ValueError("a corner of a cell is no node")
            cells.setdefault(type_of_cell, []).append((order[at], table[:, 1]))
    if not cells:
        raise ValueError("it has no cells")
    by_type = {kind: np.concatenate([part for part, _ in parts]) for kind, parts in cells.items()}
    mesh = pv.UnstructuredGrid(by_type, nodes[:, 1:])
    properties = np.concatenate([rows for parts in cells.values() for _, rows in parts])
    if len(np.unique(properties)) > 1:
        mesh.cell_data["property"] = properties
    return mesh


def _type(name: bytes, corners: int) -> int:
    """Return VTK's type of a cell: of the space's dimension, unless its name says it is thin."""
    space = 2 if b"2D" in name else 3
    for dimension in range(2 if _THIN.search(name) else space, -1, -1):
        if (dimension, corners) in TYPES:
            return TYPES[dimension, corners]
    raise ValueError(f"cells {name.decode('latin-1').strip()!r} with {corners} corners are unknown")


def missing_part(file: BinaryIO) -> str:
    """Compare the ends of blocks with their begins."""
    blocks, wrong = list[bytes](), "its blocks do not end as they begin"
    for word, name in re.findall(rb"(?m)^[ \t]*(Begin|End)[ \t]+(\w+)", file.read()):
        if word == b"Begin":
            blocks.append(name)
        elif not blocks or blocks.pop() != name:
            return wrong
    return wrong if blocks else ""
