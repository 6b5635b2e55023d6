"""The tangents of a mesh's own lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight.geometry.lines.curves import polyline_tangents
from vizlight.mesh import hull

if TYPE_CHECKING:
    from vizlight._types import Array, Indices


LINES = {
    pv.CellType.LINE, pv.CellType.POLY_LINE, pv.CellType.QUADRATIC_EDGE, pv.CellType.CUBIC_LINE,
    pv.CellType.LAGRANGE_CURVE, pv.CellType.BEZIER_CURVE,
}  # fmt: skip
POINTS = {pv.CellType.VERTEX, pv.CellType.POLY_VERTEX}


def has_lines_only(mesh: pv.DataSet) -> bool:
    """Tell whether a mesh consists of lines (and perhaps loose points), without a surface."""
    if isinstance(mesh, pv.PolyData):
        no_faces = not (mesh.GetNumberOfPolys() or mesh.GetNumberOfStrips())
        return no_faces and mesh.n_lines > 0
    if isinstance(mesh, pv.UnstructuredGrid):
        kinds = set(np.unique(mesh.celltypes).tolist())
        return bool(kinds & LINES) and kinds <= LINES | POINTS
    return False


def line_tangents(mesh: pv.DataSet) -> Array:
    """Return the unit tangents of a mesh of lines, zero at points of no line.

    Segments that follow each other, such as contour lines come in, are joined first.
    """
    if not isinstance(mesh, pv.PolyData):
        surface, origin = hull.outer_surface(mesh)
        if mesh.has_nonlinear_cells:
            # Each came as a line of its own.
            surface.SetLines(pv.CellArray.from_regular_cells(segments(surface.GetLines())))
        return hull.scattered(line_tangents(surface), origin, mesh.n_points)
    lines = mesh.GetLines()
    ids, offsets = _cells(lines)
    if np.any(np.diff(offsets) == 2) and len(np.unique(ids)) < len(ids):
        bare = pv.PolyData()
        bare.SetPoints(mesh.GetPoints())
        bare.SetLines(lines)
        ids, offsets = _cells(bare.strip(join=True, max_length=mesh.n_points + 1).GetLines())
    found: Array = polyline_tangents(np.asarray(mesh.points), connectivity=ids, offsets=offsets)
    return found


def segments(lines: Any) -> Any:
    """Return the ends of all segments of lines, shape (M, 2)."""
    ids, offsets = _cells(lines)
    inside = np.ones(len(ids), dtype=np.bool_)
    inside[offsets[1:] - 1] = False
    start = np.flatnonzero(inside)
    return np.stack([ids[start], ids[start + 1]], axis=1)


def before_turning_back(mesh: pv.PolyData) -> pv.PolyData:
    """Return a mesh of lines up to where each turns back or, at its end, moves no more.

    A line turns back where two steps that follow each other are more than a right angle apart.
    Lines without a step are left out; each point is expected to have one line.
    """
    ids, offsets = _cells(mesh.GetLines())
    size = np.diff(offsets)
    line = np.repeat(np.arange(len(size)), size)
    place = np.asarray(mesh.points, dtype=np.float64)[ids]
    step = place[1:] - place[:-1]
    same = line[1:] == line[:-1]
    moving = np.any(step != 0, axis=1) & same
    # Steps that move, each after the one before it on its line.
    at = np.flatnonzero(moving)
    back = np.einsum("ij,ij->i", step[at[1:]], step[at[:-1]]) <= 0
    back &= line[at[1:]] == line[at[:-1]]
    last = np.full(len(size), -1)
    np.maximum.at(last, line[at], at + 1)
    np.minimum.at(last, line[at[1:][back]], at[1:][back])
    keep_line = last >= 0
    kept = (np.arange(len(ids)) <= np.repeat(last, size)) & np.repeat(keep_line, size)
    if kept.size == mesh.n_points and kept.all():
        return mesh
    if not kept.any():
        return pv.PolyData()
    out = pv.PolyData()
    out.points = np.asarray(mesh.points)[ids[kept]]
    length = np.bincount(line[kept], minlength=len(size))[keep_line]
    ends: Any = np.concatenate([[0], np.cumsum(length)])
    numbers: Any = np.arange(len(out.points))
    out.SetLines(pv.CellArray.from_arrays(ends, numbers))
    for key, array in mesh.point_data.items():
        out.point_data[key] = np.asarray(array)[ids[kept]]
    for key, array in mesh.cell_data.items():
        out.cell_data[key] = np.asarray(array)[keep_line]
    return out


def _cells(cells: Any) -> tuple[Indices, Indices]:
    return (
        pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False),
        pv.convert_array(cells.GetOffsetsArray()).astype(np.intp, copy=False),
    )
