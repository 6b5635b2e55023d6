"""The surroundings of some triangles of a large surface, of some segments, and of some points."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv
from scipy.spatial import cKDTree

from vizlight import _pool
from vizlight.draw.sources import with_sharp_edges
from vizlight.mesh.blocks import cell_array
from vizlight.observers.pixels import rows_of
from vizlight.vtk.arrays import array_of, points_of
from vizlight.vtk.cells import BLANK, GHOSTS, HIDDEN, finite_points, places, triangles
from vizlight.vtk.corners import all_slivers, joined
from vizlight.vtk.drawn import BLOCK, DrawnCells, DrawnTriangles
from vizlight.vtk.normals import NEIGHBOURS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vizlight._types import Array, Bools, Indices, Keywords
    from vizlight.shading.inputs import ArraySource
    from vizlight.shading.options import LightOptions
    from vizlight.vtk.drawn import DrawnSegments

#: Name of a temporary point array, chosen not to clash with a user's array.
PLACE = "vizlight place"
#: Number of segments on either side of one that tell its tangents, also where some have no length.
RINGS = 4


class Near(NamedTuple):
    """Surroundings of some triangles or points.

    The mesh has all polygons that have a point in common with the triangles, with the arrays of
    their light, or all points that tell the normals of points; ``corners`` are those of the
    triangles, or the points, in it, and ``origin`` is the point of the large mesh that each of its
    points is.
    """

    mesh: pv.PolyData
    light: LightOptions
    corners: Indices
    origin: Indices


def near(mesh: pv.DataSet, surface: DrawnTriangles, cells: Indices, light: LightOptions) -> Near:
    """Return the surroundings of some triangles of a mesh, with the normals of the whole.

    Normals are means over the faces around a point, and over points that slivers join. A part does
    not show which side of the surface is outside. ``feature_angle="auto"`` decides by the edges of
    these surroundings whether sharp edges are creases. The light has the least angle of an edge
    that is sharp.
    """
    corners, polygon = surface[cells], surface.polygon(cells)
    points = np.unique(corners)
    while True:
        around = surface.around(points)
        ids, ends = surface.corners(around)
        origin, ids = np.unique(ids, return_inverse=True)
        part = pv.PolyData()
        part.points = rows_of(points_of(mesh, None), origin)
        part.SetPolys(cell_array(ids, ends))
        first = joined(places(part), all_slivers(places(part), triangles(part)))
        if first is None:
            break
        # The normal of a point is that of all points that are joined with it.
        with_points = np.isin(first, first[np.searchsorted(origin, points)])
        more = np.union1d(points, origin[with_points])
        if len(more) == len(points):
            break
        points = more
    own = _with_rows(part, mesh, light, origin, surface.cells_of(around))
    at = np.searchsorted(origin, corners)
    # Points of a grid are not split.
    is_grid = not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid)
    split = part if is_grid else with_sharp_edges(part, own)
    if not isinstance(split, pv.PolyData) or split is part:
        return Near(part, own, at, origin)
    place: Indices = np.asarray(split.point_data[PLACE])
    at = _corners_of(split, place, np.searchsorted(around, polygon), at)
    return Near(split, own, at, origin[place])


def tangents_at(
    mesh: pv.DataSet,
    lines: DrawnSegments,
    points: Indices,
    tangents_of: Callable[[pv.PolyData], Array],
) -> Array:
    """Return the tangents of lines at some of their points, made of some lines at a time.

    The segments are all of lines of one, or none that may be joined with those of another line;
    ``points`` are rising numbers of points of lines.
    """
    around, tangents = lines.around(points), np.zeros((len(points), 3))
    for _ in range(RINGS if lines.are_single else 0):
        around = lines.around(np.unique(lines.corners(around)[0]))
    # Segments that may be joined stay together.
    for some in np.split(around, _steps(lines.sizes(around) * (not lines.are_single))):
        ids, ends = lines.corners(some)
        origin, ids = np.unique(ids, return_inverse=True)
        part = pv.PolyData()
        part.points = rows_of(points_of(mesh, None), origin)
        part.SetLines(cell_array(ids, ends))
        # A point of several lines has the tangent of the last.
        chosen = np.isin(origin, points)
        tangents[np.searchsorted(points, origin[chosen])] = tangents_of(part)[chosen]
    return tangents


def _steps(sizes: Indices) -> Indices:
    """Return where to split cells of some numbers of corners, so that few are looked at at once."""
    return np.flatnonzero(np.diff(np.cumsum(sizes) // BLOCK)) + 1


def near_points(points: ArraySource, cells: Indices, light: LightOptions) -> Near:
    """Return some points of a scan, shape (M, 1), with all that tell their normals.

    A normal is that of the plane through the nearest points, of which those at one distance have
    no order.
    """
    origin = neighbours(points, cells[:, 0], NEIGHBOURS)
    return Near(pv.PolyData(rows_of(points, origin)), light, np.searchsorted(origin, cells), origin)


def around_points(mesh: pv.DataSet, corners: Indices, light: LightOptions) -> Near:
    """Return some points of a mesh, with the cells around each, of which its tangents are means."""
    origin, at = np.unique(corners, return_inverse=True)
    part, own = _star(mesh, light, origin, *_pairs(mesh, origin))
    return Near(part, own, at.reshape(corners.shape), origin)


def stars(
    mesh: pv.DataSet, points: Indices, light: LightOptions
) -> Iterator[tuple[pv.PolyData, LightOptions]]:  # fmt: skip
    """Yield rising points of a mesh as :func:`around_points` has them, some of them at a time."""
    place, cells = _pairs(mesh, points)
    order = np.argsort(place, kind="stable")
    count = np.bincount(place, minlength=len(points))
    ends = np.concatenate([[0], np.cumsum(count)])
    for rows in np.split(np.arange(len(points)), _steps(count)):
        first, last = rows[0], rows[-1] + 1
        some = order[ends[first] : ends[last]]
        yield _star(mesh, light, points[rows], place[some] - first, cells[some])


def _pairs(mesh: pv.DataSet, points: Indices) -> tuple[Indices, Indices]:
    """Return which of some rising points of a mesh are corners, and the cell of each corner."""
    number = np.int32 if max(mesh.n_points, mesh.n_cells) < 2**31 else np.intp
    every_place, cells = [np.zeros(0, number)], [np.zeros(0, number)]
    for kind in DrawnCells.all_of(mesh):
        around = kind.around(points)
        around = around[~_blank(mesh, kind.cells_of(around))]
        # Lines may have many points.
        for some in np.split(around, _steps(kind.sizes(around))):
            every, ends = kind.corners(some)
            place = np.minimum(np.searchsorted(points, every), len(points) - 1)
            chosen = points[place] == every
            every_place.append(place[chosen].astype(number))
            cells.append(np.repeat(kind.cells_of(some), np.diff(ends))[chosen].astype(number))
    return np.concatenate(every_place), np.concatenate(cells)


def _star(
    mesh: pv.DataSet, light: LightOptions, origin: Indices, place: Indices, cells: Indices
) -> tuple[pv.PolyData, LightOptions]:  # fmt: skip
    """Return points of a mesh with a cell of one point for each corner there, and their light."""
    part = pv.PolyData()
    part.points = rows_of(points_of(mesh, None), origin)
    part.SetVerts(cell_array(place, np.arange(len(place) + 1)))
    return part, _with_rows(part, mesh, light, origin, cells)


def _blank(mesh: pv.DataSet, cells: Indices) -> Bools:
    """Return which cells of a mesh VTK's means leave out."""
    marks = mesh.cell_data.get(GHOSTS) if isinstance(mesh, pv.StructuredGrid) else None
    # Beside blank cells alone, those that finer ones replace are left out too.
    if marks is None or not np.bitwise_or.reduce(marks) & BLANK:
        return np.zeros(len(cells), dtype=np.bool_)
    return np.asarray(marks[cells] & HIDDEN > 0)


def neighbours(points: ArraySource, ids: Indices, count: int) -> Indices:
    """Return the numbers of all points that are among the nearest of some of them.

    ``count`` is the number of points that are nearest to each.
    """
    places = rows_of(points, ids).astype(np.float64)
    far = np.full((len(ids), count), np.inf)
    nearest = np.zeros(far.shape, dtype=np.intp)
    blocks = _pool.blocks(points.shape[0], 4 * BLOCK)
    # Those of its own block tell how far away the nearest of another may be.
    for block, is_own in [(block, own) for own in (True, False) for block in blocks]:
        chosen = np.flatnonzero(((ids >= block.start) & (ids < block.stop)) == is_own)
        rows = np.asarray(points[block], dtype=np.float64)
        finite = np.flatnonzero(finite_points(rows))
        if not len(finite) or not len(chosen):
            continue
        rows, at = rows[finite], places[chosen]
        outside = np.maximum(np.maximum(rows.min(axis=0) - at, at - rows.max(axis=0)), 0.0)
        chosen = chosen[np.linalg.norm(outside, axis=1) <= far[chosen, -1]]
        tree = cKDTree(rows, balanced_tree=False, compact_nodes=False)
        more, number = tree.query(
            places[chosen], count, distance_upper_bound=far[chosen, -1].max(initial=0.0)
        )
        more, number = np.hstack([far[chosen], more]), np.append(finite + block.start, 0)[number]
        number = np.hstack([nearest[chosen], number])
        order = np.argsort(more, axis=1, kind="stable")[:, :count]
        far[chosen] = np.take_along_axis(more, order, axis=1)
        nearest[chosen] = np.take_along_axis(number, order, axis=1)
    return np.unique(nearest[np.isfinite(far)])


def _with_rows(
    part: pv.PolyData, mesh: pv.DataSet, light: LightOptions, origin: Indices, cells: Indices
) -> LightOptions:
    """Give a part of a mesh the rows of the arrays of its light; return the options for it."""
    given: Keywords = {}
    names = {light.positions or "", *(x for x in [light.conditioned] if isinstance(x, str))}
    for name in ("tangents", "normals"):
        value = getattr(light, name)
        if isinstance(value, str):
            names |= {value, *value.split(",")}
        elif value is not None:
            given[name] = array_of(mesh, name, value)[origin]
    carried = mesh.point_data.active_normals_name if light.normals is None else None
    for name in sorted(names | {carried or ""}):
        if name in mesh.point_data:
            part.point_data[name] = np.asarray(mesh.point_data[name])[origin]
        elif name in mesh.cell_data:
            part.cell_data[name] = np.asarray(mesh.cell_data[name])[cells]
    if carried is not None:
        part.GetPointData().SetActiveNormals(carried)
    part.point_data[PLACE] = np.arange(len(origin))
    return dataclasses.replace(light, **given)


def _corners_of(
    split: pv.PolyData, place: Indices, polygon: Indices, corners: Indices
) -> Indices:  # fmt: skip
    """Return the points of triangles after a split of points, given the polygons they are of."""
    ids, ends = DrawnTriangles(split).corners(polygon)
    row = np.repeat(np.arange(len(polygon)), np.diff(ends))
    after = np.empty_like(corners)
    for column, corner in zip(after.T, corners.T, strict=True):
        # A polygon may name a point twice.
        same = np.flatnonzero(place[ids] == corner[row])
        column[:] = ids[same[np.unique(row[same], return_index=True)[1]]]
    return after
