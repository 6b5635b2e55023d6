"""Lines of a mesh: their segments and tangents, and where they turn back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.geometry.lines.curves import polyline_tangents
from vizlight.mesh import blocks, hull

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    from vizlight._types import Array, Indices


LINES = {
    pv.CellType.LINE, pv.CellType.POLY_LINE, pv.CellType.QUADRATIC_EDGE, pv.CellType.CUBIC_LINE,
    pv.CellType.LAGRANGE_CURVE, pv.CellType.BEZIER_CURVE,
}  # fmt: skip
POINTS = {pv.CellType.VERTEX, pv.CellType.POLY_VERTEX}


def has_lines_only(mesh: pv.DataSet) -> bool:
    """Return whether a mesh has lines, possibly vertices, and no other cells."""
    if isinstance(mesh, pv.PolyData):
        return mesh.n_lines > 0 and not blocks.has_faces(mesh)
    if isinstance(mesh, pv.UnstructuredGrid):
        kinds = set(np.unique(mesh.celltypes).tolist())
        return bool(kinds & LINES) and kinds <= LINES | POINTS
    return False


def backdrop(meshes: Iterable[pv.DataSet]) -> str:
    """Return the colour before which meshes stand out: lines alone before black, else white."""
    return "black" if all(has_lines_only(mesh) for mesh in meshes) else "white"


def line_tangents(mesh: pv.DataSet) -> Array:
    """Return the unit tangents of a mesh of lines; zero at points that no line uses.

    Consecutive segments, such as those of contour lines, are joined first.
    """
    return of_points(mesh, _tangents)


def _tangents(points: Array, ids: Indices, offsets: Indices) -> Array:
    return polyline_tangents(points, connectivity=ids, offsets=offsets)


def of_points(mesh: pv.DataSet, function: Callable[[Array, Indices, Indices], Array], /) -> Array:
    """Return what a function of points, connectivity and offsets of lines gives for each point.

    Points that no line uses have zero. Consecutive segments are joined first.
    """
    surface, origin = _flat(mesh)
    found = function(*_joined(surface))
    return found if origin is None else hull.scattered(found, origin, mesh.n_points)


def cells_of(mesh: pv.DataSet, /) -> tuple[Array, Indices, Indices]:
    """Return points, connectivity and offsets of the lines of a mesh, segments joined."""
    return _joined(_flat(mesh)[0])


def _flat(mesh: pv.DataSet) -> tuple[pv.PolyData, Indices | None]:
    """Return the lines of a mesh as polylines, and the index of each of their points in it."""
    if isinstance(mesh, pv.PolyData):
        return mesh, None
    surface, origin = hull.outer_surface(mesh)
    if mesh.has_nonlinear_cells:
        # VTK turns each curve into a polyline; segments let the curves be joined below.
        ends = np.asarray(segments(surface.GetLines()), dtype=int)
        surface.SetLines(pv.CellArray.from_regular_cells(ends))
    return surface, origin


def _joined(mesh: pv.PolyData) -> tuple[Array, Indices, Indices]:
    """Return points, connectivity and offsets of polylines, consecutive segments joined."""
    lines = mesh.GetLines()
    ids, offsets = _cells(lines)
    if np.any(np.diff(offsets) == 2) and _shared(ids, mesh.n_points):
        bare = pv.PolyData()
        bare.SetPoints(mesh.GetPoints())
        bare.SetLines(lines)
        ids, offsets = _cells(bare.strip(join=True, max_length=mesh.n_points + 1).GetLines())
    return np.asarray(mesh.points), ids, offsets


def _shared(ids: Indices, count: int) -> bool:
    """Return whether two corners of lines are the same point."""
    used = np.zeros(count, dtype=np.bool_)
    used[ids] = True
    return bool(np.count_nonzero(used) < len(ids))


def direction_colors(mesh: pv.DataSet, /) -> Array:
    """Return colours of lines by direction: ``(|x|, |y|, |z|)`` of the unit tangent as r, g, b.

    This is the convention of tractography: in the space of a scanner left and right is red, front
    and back green, up and down blue. It does not depend on the sign of a direction.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh of lines, such as a tractogram or the result of :func:`vizlight.streamlines`.

    Returns
    -------
    ndarray, shape (n_points, 3)
        Channels from 0 to 1, zero at points that no line uses.

    Raises
    ------
    TypeError, ValueError
        If it is not a mesh of lines.

    Notes
    -----
    Source: Pajevic and Pierpaoli, Magnetic Resonance in Medicine 42 (1999), the absolute-value
    scheme.
    """
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message("mesh", "a PyVista mesh of lines", type(mesh).__name__))
    if not has_lines_only(mesh):
        remedy = "take its streamlines, or its edges by extract_all_edges()"
        raise ValueError(_check.message("mesh", "a mesh of lines", type(mesh).__name__, remedy))
    return np.abs(line_tangents(mesh))


def segments(lines: vtkCellArray) -> Indices:
    """Return the two points of each segment of all lines, shape (M, 2)."""
    ids, offsets = _cells(lines)
    inside = np.ones(len(ids), dtype=np.bool_)
    inside[offsets[1:] - 1] = False
    start = np.flatnonzero(inside)
    return np.stack([ids[start], ids[start + 1]], axis=1)


def before_turning_back(mesh: pv.PolyData) -> pv.PolyData:
    """Return each line up to the point where it turns back or its last points coincide.

    A line turns back where the angle between two consecutive steps is a right angle or more.
    Lines without a step are left out. Each point must belong to exactly one line.
    """
    ids, offsets = _cells(mesh.GetLines())
    size = np.diff(offsets)
    line = np.repeat(np.arange(len(size)), size)
    place = np.asarray(mesh.points, dtype=np.float64)[ids]
    step = place[1:] - place[:-1]
    same = line[1:] == line[:-1]
    moving = np.any(step != 0, axis=1) & same
    # Indices of the steps of non-zero length.
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
    length = np.bincount(line[kept], minlength=len(size))[keep_line]
    out = polydata(np.asarray(mesh.points)[ids[kept]], np.concatenate([[0], np.cumsum(length)]))
    for key, array in mesh.point_data.items():
        out.point_data[key] = np.asarray(array)[ids[kept]]
    for key, array in mesh.cell_data.items():
        out.cell_data[key] = np.asarray(array)[keep_line]
    return out


def polydata(points: NDArray[np.floating[Any]], ends: Indices, /) -> pv.PolyData:
    """Return a mesh of polylines.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        Points of the lines, one line after the other.
    ends : ndarray of int, shape (L + 1,)
        Start of each line, followed by N.
    """
    out = pv.PolyData()
    if len(points):
        out.points = points
    numbers = np.asarray(np.arange(len(points)), dtype=int)
    out.SetLines(pv.CellArray.from_arrays(np.asarray(ends, dtype=int), numbers))
    return out


def joined_at_seeds(mesh: pv.PolyData) -> pv.PolyData:
    """Return one line for each seed: VTK's tracer gives one forward and one backward from it.

    The mesh has VTK's cell array SeedIds and point array IntegrationTime, negative backward.
    """
    if not mesh.n_lines:
        return mesh
    ids, offsets = _cells(mesh.GetLines())
    seed = np.asarray(mesh.cell_data["SeedIds"])
    time = np.asarray(mesh.point_data["IntegrationTime"])[ids]
    back = np.minimum.reduceat(time, offsets[:-1]) < 0
    runs: dict[int, Indices] = {}
    first: dict[int, int] = {}
    # Those that run backward come first, reversed.
    for line in np.lexsort((~back, seed)).tolist():
        run, key = ids[offsets[line] : offsets[line + 1]], int(seed[line])
        run = run[::-1] if back[line] else run
        runs[key] = np.concatenate([runs[key], run[1:]]) if key in runs else run
        first[key] = line
    rows = np.concatenate([*runs.values()])
    ends = np.concatenate([[0], np.cumsum([len(run) for run in runs.values()])])
    out = polydata(np.asarray(mesh.points)[rows], ends)
    for name, array in mesh.point_data.items():
        out.point_data[name] = np.asarray(array)[rows]
    for name, array in mesh.cell_data.items():
        out.cell_data[name] = np.asarray(array)[[*first.values()]]
    return out


def _cells(cells: vtkCellArray) -> tuple[Indices, Indices]:
    """Return the points of all cells, and the offset of each cell in them."""
    return (
        pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False),
        pv.convert_array(cells.GetOffsetsArray()).astype(np.intp, copy=False),
    )
