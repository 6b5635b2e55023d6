"""Segments and triangles of a mesh, split without T-junctions, and a mesh made of the parts."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pyvista as pv
import scipy
from vtkmodules.vtkCommonDataModel import vtkCellArray

from vizlight import _check
from vizlight._types import Array, Bools, Indices, Raw, Sparse
from vizlight.mesh import blocks, records
from vizlight.model import kernels
from vizlight.verify.between import Places, are_unit
from vizlight.vtk import hull, polylines
from vizlight.vtk.cells import connectivity, has_faces
from vizlight.vtk.cells import triangles as triangles_of
from vizlight.vtk.hull import as_lagrange

#: Number of bits of the smaller number of a pair.
HALF = 31
#: Name of a temporary cell array, chosen not to clash with a user's array.
CELLS = "vizlight cells"
#: Name of the point array in which the tangents of refined lines stay with a result.
TANGENTS = "vizlight_tangents"


def simplices(mesh: pv.DataSet) -> Indices:
    """Return the triangles of the surface of a mesh, or its segments if it has only lines.

    They are points of the mesh, in rows of 3 or 2, without rows if it has neither. Polygons are
    taken as triangles; of volumes the outer surface is taken.
    """
    if not mesh.n_points or not mesh.n_cells:
        return np.empty((0, 3), np.intp)
    surface, origin = hull.surface_of(mesh)
    lines = not has_faces(surface)
    corners = polylines.segments(surface.GetLines()) if lines else triangles_of(surface)
    if origin is None:
        return corners.astype(np.intp, copy=False)
    corners = origin[corners]
    # Curved cells have points on their surface that are none of the mesh.
    return corners[(corners >= 0).all(axis=1)]


def as_polydata(mesh: pv.DataSet) -> pv.PolyData:
    """Return a mesh of faces or lines as PolyData with the same points in the same order."""
    if mesh.GetMaxSpatialDimension() == 3:
        remedy = "take the mesh's extract_surface() or a contour"
        raise _check.value_error(
            "mesh", "faces or lines to refine", "cells that fill space", remedy
        )
    if isinstance(mesh, pv.PolyData):
        polydata = mesh
    else:
        # Of cells of Bezier the control points are not on the surface.
        mesh = pv.wrap(as_lagrange(mesh)) if isinstance(mesh, pv.UnstructuredGrid) else mesh
        surface, origin = blocks.outer_surface(mesh)
        polydata = pv.PolyData()
        polydata.points = np.asarray(mesh.points)
        for get, put in (
            (surface.GetVerts, polydata.SetVerts),
            (surface.GetLines, polydata.SetLines),
            (surface.GetPolys, polydata.SetPolys),
        ):
            ids, offsets = connectivity(get())
            if len(offsets) > 1:
                # The surface numbers its points anew; cells get the numbers of the mesh again.
                put(blocks.cell_array(origin[ids], offsets))
        for key, array in surface.cell_data.items():
            polydata.cell_data[key] = np.asarray(array)
        polydata.GetPointData().ShallowCopy(mesh.GetPointData())
        polydata.GetFieldData().DeepCopy(mesh.GetFieldData())
    if not (has_faces(polydata) or polydata.n_lines):
        remedy = "between points alone there is no light to refine"
        raise _check.value_error("mesh", "faces or lines", "points alone", remedy)
    return polydata


class SplitCells:
    """Segments or triangles that are split step by step.

    ``parents`` (P, s) are segments, s = 2, or triangles, s = 3, of the mesh. ``corners`` are the
    points of the parts: first the mesh's own, then new ones in the order of their making;
    ``parent`` is the cell that each part lies in, ``twin`` a number of each point that points at
    equal positions share, and ``steps`` are the new points of each step, on the edges between two
    earlier ones.
    """

    def __init__(self, points: Array, parents: Indices) -> None:
        self.count, self.size = len(points), parents.shape[1]
        self.parents = self.corners = parents
        self.parent = np.arange(len(parents))
        # By place, so that triangles which share no index are split alike and no gap opens between
        # them.
        _, twin = np.unique(points, axis=0, return_inverse=True)
        self.twin = np.asarray(twin.reshape(-1), dtype=np.intp)
        self.steps: list[Places] = []

    def edges(self, cells: Indices) -> tuple[Indices, Bools]:
        """Return a number for each edge of parts, the same for twins, and its direction.

        Edges, in rows of 1 or 3, begin at each corner; the mask is of those that run from the twin
        of the larger number to that of the smaller.
        """
        start = self.twin[self.corners[cells]]
        stop = np.roll(start, -1, axis=1)
        if self.size == 2:
            start, stop = start[:, :1], stop[:, :1]
        return _pairs(start, stop), start > stop

    def split(self, chosen: Indices, share: Array) -> Indices:
        """Split edges, and all parts at them, and return the indices of the new parts.

        ``chosen`` are numbers of edges, sorted, at least one; ``share`` is where each is split,
        from its end of the smaller number.
        """
        touched = np.zeros(self.twin.max() + 1, np.bool_)
        # Both ends of an edge are packed in its number.
        touched[chosen >> HALF] = touched[chosen & ((1 << HALF) - 1)] = True
        # Only parts with two touched corners can have a chosen edge: a cheap test before the exact
        # one.
        near = np.flatnonzero(np.count_nonzero(touched[self.twin[self.corners]], axis=1) > 1)
        codes, reverse = self.edges(near)
        at = np.minimum(np.searchsorted(chosen, codes), len(chosen) - 1)
        marked = chosen[at] == codes
        hit = marked.any(axis=1)
        rows, marked, at, reverse = near[hit], marked[hit], at[hit], reverse[hit]
        part, side = np.nonzero(marked)
        edge = at[part, side]
        ends = self.corners[rows[part], side], self.corners[rows[part], (side + 1) % self.size]
        # A share counts from the end of the smaller number; the part may run the other way.
        t = np.where(reverse[part, side], 1 - share[edge], share[edge])
        # A point for each pair of ends, a twin for each edge.
        _, first, point = np.unique(_pairs(*ends), return_index=True, return_inverse=True)
        middles = np.full(marked.shape, -1)
        middles[part, side] = len(self.twin) + point.reshape(-1)
        self.steps.append(
            Places(np.stack(ends, axis=1)[first], np.stack([1 - t, t], axis=1)[first])
        )
        _, twin = np.unique(edge[first], return_inverse=True)
        self.twin = np.concatenate([self.twin, self.twin.max() + 1 + twin.reshape(-1)])
        return self._replace(rows, middles)

    def _replace(self, rows: Indices, middles: Indices) -> Indices:
        """Replace parts by smaller ones, given new points on some edges."""
        old = self.corners[rows]
        if self.size == 2:
            parts = np.concatenate([
                np.column_stack([old[:, 0], middles[:, 0]]),
                np.column_stack([middles[:, 0], old[:, 1]]),
            ])  # fmt: skip
            owner = np.tile(np.arange(len(rows)), 2)
        else:
            from vizlight.geometry.solids import triangle_mesh

            parts, owner = triangle_mesh.split(old, middles)
        # One part takes the place of the old one, the others stand at the end.
        _, first = np.unique(owner, return_index=True)
        more = np.ones(len(parts), np.bool_)
        more[first] = False
        before = len(self.corners)
        self.corners = np.concatenate([self.corners, parts[more]])
        self.parent = np.concatenate([self.parent, self.parent[rows][owner[more]]])
        self.corners[rows] = parts[first]
        return np.concatenate([rows, np.arange(before, len(self.corners))])

    def shares(self) -> Sparse:
        """Return the weights of the points of the mesh in all points, shape (N + new, N)."""
        numbers = np.arange(self.count + 1)
        matrix = scipy.sparse.csr_array((np.ones(self.count), numbers[:-1], numbers))
        for step in self.steps:
            weights = np.asarray(step.weights.ravel(), dtype=np.float64)
            ends = np.arange(0, len(weights) + 1, 2)
            size = len(step.corners), matrix.shape[0]
            # New points lie between earlier ones, which may be new themselves: products of the
            # weights lead back to the points of the mesh.
            between = scipy.sparse.csr_array((weights, step.corners.ravel(), ends), shape=size)
            matrix = scipy.sparse.csr_array(
                scipy.sparse.vstack([matrix, between @ matrix], format="csr")
            )
        return matrix


def _pairs(a: Indices, b: Indices) -> Indices:
    """Return a number for each pair of numbers, whatever their order."""
    return np.asarray((np.minimum(a, b).astype(np.int64) << HALF) + np.maximum(a, b))


def rebuilt(
    mesh: pv.PolyData,
    parts: SplitCells,
    origin: Indices | None,
    new_rows: Mapping[str, Array],
    *,
    places: str | None = None,
) -> pv.PolyData:
    """Return a mesh with split segments or triangles, with its data.

    ``origin`` is the cell of the mesh that each triangle was taken from, None for segments;
    ``new_rows`` has the rows of the new points by the name of their array, and ``places`` names a
    point array of places, which lie on their cells like the points. The points of the mesh come
    first, with their index. Other point arrays are interpolated; unit vectors keep their length.
    Integers, which may be labels, booleans and words are taken from the nearest corner. Cell arrays
    are carried to all parts of a cell.
    """
    out = pv.PolyData()
    shares = parts.shares()
    new = shares[parts.count :]
    points = np.asarray(mesh.points)
    out.points = np.concatenate([points, _interpolated(points, new, places=True)])
    others = mesh.n_verts + mesh.n_lines
    out.SetVerts(mesh.GetVerts())
    if origin is None:
        out.SetLines(_split_lines(mesh.GetLines(), parts, shares))
        cells = np.arange(others)
    else:
        out.SetLines(mesh.GetLines())
        # Parts of one cell stand together, in the order of the cells, as their arrays do.
        order = np.argsort(parts.parent, kind="stable")
        triangles = np.asarray(parts.corners[order], dtype=int)
        out.SetPolys(pv.CellArray.from_regular_cells(triangles))
        cells = np.concatenate([np.arange(others), origin[parts.parent[order]]])
    for key, array in mesh.cell_data.items():
        out.cell_data[key] = np.asarray(array)[cells]
    for key, array in mesh.point_data.items():
        rows = np.asarray(array)
        given_rows = new_rows.get(key)
        added = _interpolated(rows, new, places=key == places) if given_rows is None else given_rows
        records.attach_rows(out, key, np.concatenate([rows, added.astype(rows.dtype)]))
    out.GetFieldData().DeepCopy(mesh.GetFieldData())
    records.carry_active(mesh, out)
    return out


def with_sides(mesh: pv.PolyData, most: float) -> pv.PolyData:
    """Return a surface with triangle sides of at most a length, and all its arrays.

    Points at equal places stay apart; values between them are interpolated as by :func:`rebuilt`.
    """
    parents, origin = triangles(mesh)
    points = np.asarray(mesh.points, dtype=np.float64)
    cells, places = SplitCells(points, parents), points
    fresh = np.arange(len(parents))
    while len(fresh):
        numbers, _ = cells.edges(fresh)
        # Only new parts can still be too long.
        corners = places[cells.corners[fresh]]
        away = corners - np.roll(corners, -1, axis=1)
        chosen = np.unique(numbers[np.einsum("ijk,ijk->ij", away, away) > most * most])
        if not len(chosen):
            break
        fresh = cells.split(chosen, np.full(len(chosen), 0.5))
        step = cells.steps[-1]
        # All shares are 1/2, so the mean of both ends is the new point.
        places = np.concatenate([places, places[step.corners].mean(axis=1)])
    return rebuilt(mesh, cells, origin, {})


def by_corner(mesh: pv.PolyData, name: str) -> pv.PolyData:
    """Return a surface with cells that have the labels of their points, split at side middles.

    Colours that run from one label to another would show those between them. Here each polygon with
    different corners is split: every corner has the part between it, the middles of its two sides
    and the middle of the polygon. NaN is a label. Polygons that are whole come first, then the
    parts, with other arrays as :func:`rebuilt` carries them.
    """
    if mesh.n_strips:
        mesh = mesh.triangulate()
    ids, offsets = connectivity(mesh.GetPolys())
    # Labels as whole numbers, of which NaN is the last.
    labels, number = np.unique(np.asarray(mesh.point_data[name]), return_inverse=True)
    number = number.reshape(-1)[ids]
    start, size = offsets[:-1], np.diff(offsets)
    mixed = np.maximum.reduceat(number, start) != np.minimum.reduceat(number, start)
    corner = np.flatnonzero(np.repeat(mixed, size))
    polygon = np.repeat(np.arange(mixed.sum()), size[mixed])
    first, count = np.repeat(start[mixed], size[mixed]), np.repeat(size[mixed], size[mixed])
    following = first + (corner - first + 1) % count
    before = first + (corner - first - 1) % count
    sides, side = np.unique(_pairs(ids[corner], ids[following]), return_inverse=True)
    at = np.full(len(ids), -1)
    at[corner] = mesh.n_points + side.reshape(-1)
    middle = mesh.n_points + len(sides) + polygon
    parts = np.stack([ids[corner], at[corner], middle, at[before]], axis=1)
    ends = np.column_stack([sides >> HALF, sides & ((1 << HALF) - 1)])
    shares = scipy.sparse.csr_array(
        scipy.sparse.vstack([
            _means(ends.ravel(), np.full(len(sides), 2), mesh.n_points),
            _means(ids[corner], size[mixed], mesh.n_points),
        ], format="csr")
    )  # fmt: skip
    whole = np.repeat(~mixed, size)
    out = pv.PolyData()
    points = np.asarray(mesh.points)
    out.points = np.concatenate([points, _interpolated(points, shares, places=True)])
    all_ids = np.concatenate([ids[whole], parts.ravel()])
    all_sizes = np.concatenate([size[~mixed], np.full(len(parts), 4)])
    out.SetPolys(blocks.cell_array(all_ids, np.concatenate([[0], np.cumsum(all_sizes)])))
    origin = np.concatenate([np.flatnonzero(~mixed), np.flatnonzero(mixed)[polygon]])
    others = mesh.n_verts + mesh.n_lines
    for key, array in mesh.cell_data.items():
        out.cell_data[key] = np.asarray(array)[others + origin]
    for key, array in mesh.point_data.items():
        if key != name:
            rows = np.asarray(array)
            records.attach_rows(out, key, np.concatenate([rows, _interpolated(rows, shares)]))
    out.GetFieldData().DeepCopy(mesh.GetFieldData())
    out.cell_data[name] = labels[np.concatenate([number[start[~mixed]], number[corner]])]
    return out


def _means(ids: Indices, size: Indices, count: int) -> Sparse:
    """Return the weights by which the means of points follow from a number of points."""
    ends = np.concatenate([[0], np.cumsum(size)])
    weights = np.repeat(1 / size, size)
    return scipy.sparse.csr_array((weights, ids, ends), shape=(len(size), count))


def _split_lines(lines: vtkCellArray, parts: SplitCells, shares: Sparse) -> pv.CellArray:
    """Return polylines with the new points of their segments."""
    if not len(parts.corners):  # lines of one point
        copied = pv.CellArray()
        copied.DeepCopy(lines)
        return copied
    ids, offsets = connectivity(lines)
    # The segments of a line stand one after the other; its last point follows.
    # How far along its segment each part begins: the share of the segment's end in its first
    # point.
    along = shares[parts.corners[:, 0], parts.parents[parts.parent, 1]]
    order = np.lexsort((np.asarray(along).ravel(), parts.parent))
    start = parts.corners[order, 0]
    size = np.diff(offsets)
    line = np.repeat(np.arange(len(size)), np.maximum(size - 1, 0))
    owner = np.concatenate([line[parts.parent[order]], np.flatnonzero(size)])
    points = np.concatenate([start, ids[offsets[1:][size > 0] - 1]])
    last = np.arange(len(points)) >= len(start)
    # The last point of each line comes after its parts.
    place = np.lexsort((last, owner))
    ends = np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=len(size)))])
    return blocks.cell_array(points[place], ends)


def _interpolated(rows: Raw, shares: Sparse, *, places: bool = False) -> Raw:
    """Return values of a point array at new points, given the shares of the mesh's points.

    Places are not directions, although they may have the length 1, as on a sphere.
    """
    # Bytes with three or four components are colours; other integers may be labels.
    colour = rows.dtype == np.uint8 and rows.ndim == 2 and rows.shape[1] in (3, 4)
    if rows.dtype.kind != "f" and not colour:
        order = np.lexsort(
            (shares.data, np.repeat(np.arange(shares.shape[0]), np.diff(shares.indptr)))
        )
        # With entries sorted by share, the last of each row is the nearest corner.
        return np.asarray(rows[shares.indices[order][shares.indptr[1:] - 1]])
    values = rows.reshape(len(rows), -1).astype(np.float64)
    with np.errstate(all="ignore"):
        means = np.asarray(shares @ values)
        if not places and are_unit(values):
            means = kernels.unit_rows(means)
    # Colours are whole numbers: a type of integers would cut their fractions off.
    means = np.rint(means) if colour else means
    return np.asarray(means.reshape(-1, *rows.shape[1:]).astype(rows.dtype))


def kept_tangents(mesh: pv.DataSet) -> Array | None:
    """Return the tangents that were kept of lines, if the mesh has not changed since.

    New points of a refined line lie on its segments, with directions that are not the line's.
    """
    rows = records.kept(mesh, TANGENTS, 3)
    return None if rows is None else rows[0]


def triangles(mesh: pv.PolyData) -> tuple[Indices, Indices]:
    """Return the triangles of polygons and strips, and the cell that each is taken from."""
    # Without vertices and lines, which VTK would pass on among the triangles.
    bare = pv.PolyData()
    bare.SetPoints(mesh.GetPoints())
    bare.SetPolys(mesh.GetPolys())
    bare.SetStrips(mesh.GetStrips())
    # Cells are numbered by VTK's kinds: vertices and lines first.
    before = mesh.n_verts + mesh.n_lines
    bare.cell_data[CELLS] = np.arange(before, before + bare.n_cells)
    if not bare.is_all_triangles:
        bare = bare.triangulate()
    corners = np.asarray(bare.regular_faces, dtype=np.intp).reshape(-1, 3)
    return corners, np.asarray(bare.cell_data[CELLS], dtype=np.intp)
