"""The tangents of a mesh's own lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight.geometry.curves import polyline_tangents

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.floating[Any]]


def has_lines_only(mesh: pv.DataSet) -> bool:
    """Tell whether a mesh consists of lines (and perhaps loose points), without a surface."""
    if isinstance(mesh, pv.PolyData):
        no_faces = not (mesh.GetNumberOfPolys() or mesh.GetNumberOfStrips())
        return no_faces and mesh.n_lines > 0
    if isinstance(mesh, pv.UnstructuredGrid):
        kinds = set(np.unique(mesh.celltypes).tolist())
        lines = {pv.CellType.LINE, pv.CellType.POLY_LINE}
        points = {pv.CellType.VERTEX, pv.CellType.POLY_VERTEX}
        return bool(kinds & lines) and kinds <= lines | points
    return False


def line_tangents(mesh: pv.DataSet) -> Array:
    """Return the unit tangents of a mesh of lines, zero at points of no line.

    Segments that follow each other, such as contour lines come in, are joined first.
    """
    if not isinstance(mesh, pv.PolyData):
        surface = mesh.extract_surface(algorithm="geometry", pass_pointid=True, pass_cellid=False)
        tangents = np.zeros((mesh.n_points, 3), dtype=mesh.points.dtype)
        tangents[np.asarray(surface.point_data["vtkOriginalPointIds"])] = line_tangents(surface)
        return tangents
    lines = mesh.GetLines()
    ids, offsets = _cells(lines)
    if np.any(np.diff(offsets) == 2) and len(np.unique(ids)) < len(ids):
        bare = pv.PolyData()
        bare.SetPoints(mesh.GetPoints())
        bare.SetLines(lines)
        ids, offsets = _cells(bare.strip(join=True, max_length=mesh.n_points + 1).GetLines())
    found: Array = polyline_tangents(np.asarray(mesh.points), connectivity=ids, offsets=offsets)
    return found


def without_degenerate(mesh: pv.PolyData) -> pv.PolyData:
    """Return a mesh of lines without those whose points all coincide; each point has one line."""
    ids, offsets = _cells(mesh.GetLines())
    tangents = polyline_tangents(np.asarray(mesh.points), connectivity=ids, offsets=offsets)
    size = np.diff(offsets)
    line = np.repeat(np.arange(len(size)), size)
    moving = np.any(tangents[ids] != 0, axis=1)
    line_keep = np.bincount(line[moving], minlength=len(size)) > 0
    keep = np.zeros(mesh.n_points, dtype=np.bool_)
    keep[ids[np.repeat(line_keep, size)]] = True
    if keep.all():
        return mesh
    if not keep.any():
        return pv.PolyData()
    number: Any = np.cumsum(keep) - 1
    out = pv.PolyData()
    out.points = np.asarray(mesh.points)[keep]
    out.SetLines(
        pv.CellArray.from_arrays(
            np.concatenate([[0], np.cumsum(size[line_keep])]),
            number[ids[np.repeat(line_keep, size)]],
        )
    )
    for key, array in mesh.point_data.items():
        out.point_data[key] = np.asarray(array)[keep]
    for key, array in mesh.cell_data.items():
        out.cell_data[key] = np.asarray(array)[line_keep]
    return out


def _cells(cells: Any) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    return (
        pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False),
        pv.convert_array(cells.GetOffsetsArray()).astype(np.intp, copy=False),
    )
