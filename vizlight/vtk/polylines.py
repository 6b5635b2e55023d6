"""Lines of a dataset: their cells, segments and tangents."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkStripper

from vizlight._types import Array, Bools, Dataset, Indices
from vizlight.geometry.lines.curves import polyline_tangents
from vizlight.vtk import hull
from vizlight.vtk.cells import as_vtk, connectivity, faces, new_cells, places, result
from vizlight.vtk.memory import once

#: VTK's types of cells: lines, polylines, quadratic edges, cubic lines, and curves of any degree
#: by Lagrange and by Bezier.
LINES = {3, 4, 21, 35, 68, 75}
#: Vertices and their sets.
POINTS = {1, 2}


def has_lines_only(mesh: Dataset) -> bool:
    """Return whether a mesh has lines, possibly vertices, and no other cells."""
    kinds = hull.cell_types(mesh)
    return bool(kinds & LINES) and kinds <= LINES | POINTS


def has_several_kinds(mesh: Dataset) -> bool:
    """Return whether a mesh has lines or vertices beside other cells."""
    kinds = hull.cell_types(mesh)
    thin = kinds & (LINES | POINTS)
    return bool(thin) and thin < kinds


def dimensions(mesh: Dataset, carried: Bools) -> Array | None:
    """Return the kind of each point of a mesh of several kinds of cells, None if all are on faces.

    2 on a face, or where ``carried`` says that a point has a normal of its own, 1 on lines, 0 on
    vertices. A point that a face and a line have in common is the face's.
    """
    surface, origin = _flat(mesh)
    # What is written later counts more: a carried normal than a vertex, a line than both, a face
    # than all.
    codes = np.full(surface.GetNumberOfPoints(), 2.0, dtype=np.float32)
    codes[connectivity(surface.GetVerts())[0]] = 0.0
    is_own = ~carried if origin is None else ~carried[origin]
    codes[~is_own] = 2.0
    codes[connectivity(surface.GetLines())[0]] = 1.0
    for ids, _ in faces(surface):
        codes[ids] = 2.0
    if origin is not None:
        # Points that the surface lacks count as on faces, and without a normal are not lit.
        whole = np.full(mesh.GetNumberOfPoints(), 2.0, dtype=np.float32)
        whole[origin] = codes
        codes = whole
    return codes if np.any(codes < 2) else None


def line_tangents(mesh: Dataset) -> Array:
    """Return the unit tangents of a mesh of lines; zero at points that no line uses.

    Consecutive segments, as in contour lines, are joined first. They are computed once, see
    :func:`~vizlight.vtk.memory.once`, and may not be changed.
    """
    return once(mesh, "tangents", lambda: of_points(mesh, _tangents))


def _tangents(points: Array, ids: Indices, offsets: Indices) -> Array:
    tangents = polyline_tangents(points, connectivity=ids, offsets=offsets)
    tangents.setflags(write=False)
    return tangents


def of_points(mesh: Dataset, function: Callable[[Array, Indices, Indices], Array], /) -> Array:
    """Return, for each point, a function of points, connectivity and offsets of lines.

    Points that no line uses have zero. Consecutive segments are joined first.
    """
    surface, origin = _flat(mesh)
    values = function(*_joined(surface))
    return values if origin is None else hull.scattered(values, origin, mesh.GetNumberOfPoints())


def cells_of(mesh: Dataset, /) -> tuple[Array, Indices, Indices]:
    """Return points, connectivity and offsets of the lines of a mesh, segments joined."""
    return _joined(_flat(mesh)[0])


def _flat(mesh: Dataset) -> tuple[vtkPolyData, Indices | None]:
    """Return the lines of a mesh as polylines, and the index of each of their points in it."""
    surface, origin = hull.surface_of(mesh)
    if hull.is_curved(mesh):
        # VTK turns each curve into a polyline; segments let the curves be joined below.
        ends = segments(surface.GetLines())
        lines = vtkCellArray()
        lines.SetData(2, as_vtk(ends.ravel()))
        surface.SetLines(lines)
    return surface, origin


def _joined(mesh: vtkPolyData) -> tuple[Array, Indices, Indices]:
    """Return points, connectivity and offsets of polylines, consecutive segments joined."""
    lines = mesh.GetLines()
    ids, offsets = connectivity(lines)
    sizes = np.diff(offsets)
    pairs = np.flatnonzero(sizes == 2)
    # At a segment from a point to itself VTK's filter ends the process.
    if (empty := pairs[ids[offsets[pairs]] == ids[offsets[pairs] + 1]]).size:
        ids = np.delete(ids, np.add.outer(offsets[empty], [0, 1]))
        offsets = np.concatenate([[0], np.cumsum(np.delete(sizes, empty))])
        lines = new_cells(ids, offsets)
    # Segments that have an end in common.
    if np.any(np.diff(offsets) == 2) and np.bincount(ids).max() > 1:
        # Lines alone: the filter would also make strips of triangles.
        bare = vtkPolyData()
        bare.SetPoints(mesh.GetPoints())
        bare.SetLines(lines)
        join = vtkStripper()
        join.JoinContiguousSegmentsOn()
        join.SetMaximumLength(mesh.GetNumberOfPoints() + 1)
        ids, offsets = connectivity(result(join, bare).GetLines())
    return places(mesh), ids, offsets


def segments(lines: vtkCellArray) -> Indices:
    """Return the two points of each segment of all lines, shape (M, 2)."""
    ids, offsets = connectivity(lines)
    inside = np.ones(len(ids), dtype=np.bool_)
    # The last point of a line begins no segment.
    inside[offsets[1:] - 1] = False
    start = np.flatnonzero(inside)
    return np.stack([ids[start], ids[start + 1]], axis=1)
