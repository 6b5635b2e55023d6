"""Meshes of TetGen and Triangle: a file of points and one of cells beside it.

Source: H. Si, "TetGen", and J. R. Shewchuk, "Triangle", file formats ``.node`` and ``.ele``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Array

#: Ends of names of the two files.
SUFFIXES = (".node", ".ele")
#: VTK's type of a cell, and the order of its corners, by the dimension and their number: Triangle
#: has the middle of a side by the corner that is opposite.
_CELLS = {
    (2, 3): (pv.CellType.TRIANGLE, [0, 1, 2]),
    (2, 6): (pv.CellType.QUADRATIC_TRIANGLE, [0, 1, 2, 5, 3, 4]),
    (3, 4): (pv.CellType.TETRA, [0, 1, 2, 3]),
}


def read(path: Path) -> pv.UnstructuredGrid | pv.PolyData:
    """Return the mesh of a file, or its points where no cells are beside it.

    The path is one of the two files.
    """
    nodes, cells = (path.with_suffix(suffix) for suffix in SUFFIXES)
    (_, size, n_values, n_marks), rows = _table(nodes, 4)
    if size not in (2, 3):
        raise ValueError(f"'{nodes.name}' has points of {size} coordinates")
    points = np.zeros((len(rows), 3))
    points[:, :size] = rows[:, 1 : 1 + size]
    if cells.is_file():
        (_, n_corners, n_regions), table = _table(cells, 3)
        if (size, n_corners) not in _CELLS:
            raise ValueError(f"'{cells.name}' has cells of {n_corners} corners")
        kind, order = _CELLS[size, n_corners]
        # Points are numbered from 0 or from 1.
        first = rows[0, 0] if len(rows) else 0
        ids = (table[:, 1 : 1 + n_corners] - first).astype(np.int64)[:, order]
        if ids.size and not 0 <= ids.min() <= ids.max() < len(rows):
            raise ValueError(f"a cell of '{cells.name}' has a point that is not there")
        mesh = pv.UnstructuredGrid({kind: ids}, points)
        _attach(mesh.cell_data, table[:, 1 + n_corners :], ["region"] * n_regions)
    else:
        mesh = pv.PolyData(points)
    _attach(mesh.point_data, rows[:, 1 + size :], ["attribute"] * n_values + ["marker"] * n_marks)
    return mesh


def _table(path: Path, n_head: int) -> tuple[list[int], Array]:
    """Return the numbers of the first line, a count and those of columns, and the rows after it."""
    lines = path.read_text("latin-1").splitlines()
    words = [line.partition("#")[0].split() for line in lines]
    numbers: Array = np.array([word for row in words for word in row], dtype=np.float64)
    if not len(numbers):
        raise ValueError(f"'{path.name}' has no numbers")
    # Attributes and markers may be left out of the first line.
    first = next(row for row in words if row)
    if not 2 <= len(first) <= n_head or not all(map(str.isdigit, first)):
        raise ValueError(f"'{path.name}' has the first line {' '.join(first)[:40]!r}")
    head = [*map(int, first), *[0] * (n_head - len(first))]
    width = 1 + sum(head[1:])
    rest, size = numbers[len(first) :], head[0] * width
    if len(rest) != size:
        raise ValueError(f"{len(rest)} of {size} numbers of '{path.name}' are there")
    rows = rest.reshape(head[0], width)
    if len(rows) and not np.array_equal(rows[:, 0], rows[0, 0] + np.arange(len(rows))):
        raise ValueError(f"the rows of '{path.name}' are not numbered one after the other")
    return head, rows


def _attach(data: pv.DataSetAttributes, columns: Array, names: list[str]) -> None:
    """Attach columns, each by a name, with a number from the second on."""
    for i, name in enumerate(names):
        number = names[: i + 1].count(name)
        data[name if number == 1 else f"{name}{number}"] = columns[:, i].copy()
