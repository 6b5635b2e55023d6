"""Normals of a dataset: an array that it has or those of its surface, and the side that is seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from vizlight import _check, _pool
from vizlight.reading import grids
from vizlight.reading.arrays import vectors_of
from vizlight.reading.cells import as_numpy, connectivity, has_faces, places, triangles, used
from vizlight.reading.hull import dimension, outer_surface, scattered
from vizlight.reading.orientation import (
    BLOCK,
    Owners,
    PartShape,
    Shape,
    Sums,
    crease_share,
    pieces,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vizlight._types import Array, Bools, Dataset, Indices
    from vizlight.reading.grids import Grid
    from vizlight.scene import View
    from vizlight.shading.inputs import ArraySource
    from vizlight.shading.options import Facing


@dataclass(frozen=True)
class Sided:
    """Normals of the points of a mesh, and what tells which side of them is seen.

    Attributes
    ----------
    vectors : ndarray, shape (n_points, n)
        Normals: outward on closed pieces, in agreement with each other on others.
    lean : ndarray of float32, shape (n_points,), or None
        Sine by which a normal may lean away from the eye while its own side is seen: faces around
        a point are seen until the last of them is averted where the surface is convex, and no
        longer than the first where it is concave (negative), but by
        :data:`~vizlight.reading.orientation.MOST_LEAN` at most. None: 0 everywhere.
    open : ndarray of bool, shape (n_points,), or bool
        Points of pieces with a border, of which either side may be seen.
    sharp : float or ndarray
        Share of edges that are creases, across which normals were averaged; one for each mesh of
        a batch.
    kept : bool
        Whether the normals come from an earlier result.
    computed : bool
        Whether they are those of the surface, not an array of the user.
    inside : int or ndarray
        Number of points of a volume that are not on its surface; one for each mesh of a batch.
    """

    vectors: Array
    lean: Array | None = None
    open: Bools | bool = False
    sharp: float | Array = 0.0
    kept: bool = False
    computed: bool = False
    inside: int | Indices = 0

    @property
    def any_open(self) -> bool:
        """Whether a piece has a border."""
        return bool(np.any(self.open))

    def part(self, i: int, rows: slice, /) -> Sided:
        """Return what belongs to a mesh of a batch, by its number and its points."""
        return Sided(
            self.vectors[rows],
            None if self.lean is None else self.lean[rows],
            self.open[rows] if isinstance(self.open, np.ndarray) else self.open,
            float(self.sharp[i]) if isinstance(self.sharp, np.ndarray) else self.sharp,
            self.kept,
            self.computed,
            int(self.inside[i]) if isinstance(self.inside, np.ndarray) else self.inside,
        )

    def facts(self) -> Array:
        """Return for each point its lean, and 1 on a piece with a border."""
        lean = np.zeros(len(self.vectors)) if self.lean is None else self.lean
        border = np.broadcast_to(self.open, len(self.vectors))
        return np.stack([lean, border], axis=1).astype(np.float64)

    def facing(self, facing: Facing, points: ArraySource, view: View | None) -> Array | Turned:
        """Return the normals turned to a side; the normals themselves are not changed."""
        if facing not in ("auto", "eye") or view is None or len(self.vectors) == 0:
            return self.vectors
        if facing == "auto" and not self.any_open:
            return self.vectors
        return Turned(self, points, view, only_open=facing == "auto")


class Turned:
    """Normals turned to the side that an eye sees, made for each slice and not stored."""

    def __init__(self, sided: Sided, points: ArraySource, view: View, *, only_open: bool) -> None:
        self.shape, self.dtype = sided.vectors.shape, sided.vectors.dtype
        self._sided, self._points, self._view, self._only_open = sided, points, view, only_open

    def __getitem__(self, rows: slice, /) -> Array:
        """Return a slice of the normals."""
        sided = self._sided
        own, lean, border = sided.vectors[rows], sided.lean, sided.open
        lean = None if lean is None else lean[rows]
        averted = _averted(own, self._points[rows], self._view, lean)
        if self._only_open:
            averted &= border[rows] if isinstance(border, np.ndarray) else border
        return np.where(averted[:, np.newaxis], -own, own)


def _averted(vectors: Array, points: NDArray[np.generic], view: View, lean: Array | None) -> Bools:
    """Return the points whose normals point away from the eye, by more than they lean."""
    if view.parallel:
        toward = np.asarray(view.direction, dtype=np.float64)
        cosine = vectors @ toward / np.linalg.norm(toward)
        least: Array | float = 0.0 if lean is None else -lean
        return np.asarray(cosine < least, dtype=np.bool_)
    away = np.asarray(view.position) - np.asarray(points, dtype=np.float64)
    cosine = np.einsum("ij,ij->i", vectors, away)
    least = 0.0 if lean is None else -lean * np.sqrt(np.einsum("ij,ij->i", away, away))
    return np.asarray(cosine < least, dtype=np.bool_)


def sided_normals(
    mesh: Dataset,
    value: object,
    n: int,
    facing: Facing,
    *,
    kept: Callable[[Any], Sided | None] | None = None,
    starts: Indices | None = None,
) -> Sided:
    """Return normals with their sides: those in ``value``, of the mesh, or of its surface.

    With ``starts`` the mesh is a batch of members that stay apart. ``kept`` is a function of
    the mesh that returns normals of its surface which are known already, or None.

    Raises
    ------
    TypeError, ValueError
        If there are none, or an array does not fit.
    """
    given = given_normals(mesh, value, n)
    if given is None:
        if facing == "as given":
            return computed_normals(mesh, as_wound=True, sides=False, starts=starts)
        return (kept and kept(mesh)) or computed_normals(mesh, starts=starts)
    if given.dtype.kind != "f":
        given = given.astype(np.float64)
    if facing in ("eye", "as given") or n != 3:
        return Sided(given)
    if grids.in_parts(mesh):
        return _sided_grid(mesh, given)
    surface, origin = _skin(mesh)
    if surface is None:
        return Sided(given)
    own = given if origin is None else np.where(origin[:, np.newaxis] < 0, 0, given[origin])
    owners = Owners(starts, origin)
    closed = _closed(surface, owners)
    inward = closed & _inward(places(surface), np.flatnonzero(used(surface)), own, owners)
    if starts is None:
        return Sided(-given if inward[0] else given, open=not closed[0])
    signs = np.repeat(np.where(inward, -1, 1).astype(given.dtype), np.diff(starts))
    return Sided(signs[:, np.newaxis] * given, open=np.repeat(~closed, np.diff(starts)))


def _closed(surface: vtkPolyData, owners: Owners) -> Bools:
    """Return of each mesh whether each of its edges has an even number of faces.

    Places make an edge. The numbers of the edges, made from the coordinates of their ends,
    cancel by pairs.
    """
    rows, number = triangles(surface), _place_numbers(places(surface))
    odd = np.zeros(owners.count, np.uint64)
    for block in _pool.blocks(len(rows), BLOCK):
        a, b = number[rows[block].ravel()], number[rows[block][:, [1, 2, 0]].ravel()]
        edges = _edge_numbers(a, b)
        if owners.of is None:
            odd ^= np.bitwise_xor.reduce(edges)
        else:
            np.bitwise_xor.at(odd, np.repeat(owners.of[rows[block][:, 0]], 3), edges)
    return np.asarray(odd == 0)


def _place_numbers(points: NDArray[np.generic]) -> NDArray[np.uint64]:
    """Return numbers of 64 bits made of the coordinates of points."""
    number = np.zeros(len(points), dtype=np.uint64)
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(points), BLOCK):
            # The sum with 0 makes one of the two zeros.
            where = np.ascontiguousarray(points[block].astype(np.float64) + 0.0)
            for axis, factor in zip(where.view(np.uint64).T, _FACTORS, strict=True):
                number[block] = _mixed(number[block] ^ (axis * factor))
    return number


def _edge_numbers(a: NDArray[np.uint64], b: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers of edges, made of those of their ends; 0 for edges of no length."""
    with np.errstate(all="ignore"):
        return np.where(a == b, np.uint64(0), _mixed((a + b) ^ _mixed(a ^ b)))


#: Odd numbers of 64 bits, and those of the finaliser of splitmix64.
_FACTORS = tuple(np.uint64(x) for x in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))
_MIX = tuple(np.uint64(x) for x in (0xBF58476D1CE4E5B9, 0x94D049BB133111EB))


def _mixed(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers of 64 bits in which each bit of the given ones changes half of the others."""
    x = (x ^ (x >> np.uint64(30))) * _MIX[0]
    x = (x ^ (x >> np.uint64(27))) * _MIX[1]
    mixed: NDArray[np.uint64] = x ^ (x >> np.uint64(31))
    return mixed


def _inward(points: Array, ids: Indices, normals: Array, owners: Owners) -> Bools:
    """Return of each closed mesh whether its normals at its outermost points point inside."""
    ids = ids[np.isfinite(points[ids]).all(axis=1) & np.isfinite(normals[ids]).all(axis=1)]
    outward = np.zeros(owners.count)
    if not len(ids):
        return outward < 0
    for axis in range(3):
        for sign in (1, -1):
            along = sign * points[ids, axis]
            if owners.of is None:
                outward += sign * normals[ids[along.argmax()], axis]
                continue
            # The first of the farthest points of each.
            order = np.lexsort((-along, owners.of[ids]))
            own, first = np.unique(owners.of[ids][order], return_index=True)
            outward[own] += sign * normals[ids[order[first]], axis]
    return outward < 0


def _sided_grid(mesh: Grid, given: Array) -> Sided:
    """Return normals of a grid with their sides, found part by part."""
    # Edges that are not on the border of a sheet have two faces.
    edges = [_edge_numbers(x[:-1], x[1:]) for x in map(_place_numbers, grids.rim(mesh))]
    if any(np.bitwise_xor.reduce(np.concatenate([[np.uint64(0)], *edges]), keepdims=True)):
        return Sided(given, open=True)
    points, normals = [], []
    for part in grids.parts(mesh):
        where = places(part.surface)
        own = given[part.origin]
        known = np.isfinite(where).all(axis=1) & np.isfinite(own).all(axis=1) & (part.side == 0)
        where, own = where[known], own[known]
        ends = [f(axis) for axis in where.T for f in (np.argmax, np.argmin) if len(where)]
        points.append(where[ends])
        normals.append(own[ends])
    outermost, own = np.concatenate(points), np.concatenate(normals)
    inward = _inward(outermost, np.arange(len(outermost)), own, Owners())
    return Sided(-given if inward[0] else given)


def given_normals(mesh: Dataset, value: object, n: int) -> Array | None:
    """Return the normals in ``value`` or the active ones of the mesh, None if they are computed."""
    if value is not None:
        return vectors_of(mesh, "normals", value, n)
    if n != 3:
        expected = f"a point array of {n} components for {n}-space"
        remedy = "without one pass tangents=, conditioned by the name of the surface's tangents"
        raise ValueError(_check.message("normals", expected, None, remedy))
    carried = mesh.GetPointData().GetNormals()
    if carried is None:
        return None
    found = vectors_of(mesh, "normals", carried.GetName() or as_numpy(carried), 3)
    known = np.all(np.isfinite(found), axis=1)
    return found if known.all() else np.where(known[:, np.newaxis], found, 0)


def computed_normals(
    mesh: Dataset,
    *,
    view: View | None = None,
    as_wound: bool = False,
    sides: bool = True,
    starts: Indices | None = None,
) -> Sided:
    """Return the normals of a mesh's outer surface, zero at points that are not on it.

    VTK computes them in float32 and orients them consistently. They point outward on a closed
    surface and on a connected piece that is nearly closed. Any other piece has no outside: its
    normals are flipped together if on average they point away from the eye, or toward the
    centroid of the piece.

    Parameters
    ----------
    mesh : vtkDataSet
        Mesh with a surface.
    view : View, optional
        Eye to which open pieces are turned as a whole.
    as_wound : bool
        Whether the normals have the sides that the order of the corners of each face gives them.
    sides : bool
        Whether lean and share of sharp edges are found.
    starts : ndarray of int, optional
        First point of each mesh of a batch, and the number of points.

    Raises
    ------
    ValueError
        If the mesh has no surface.
    """
    count = mesh.GetNumberOfPoints()
    if count == 0:
        return Sided(np.zeros((0, 3), dtype=np.float32), computed=True)
    if grids.in_parts(mesh):
        return _of_grid(mesh, view, as_wound=as_wound, sides=sides)
    surface, origin = _skin(mesh)
    if surface is None:
        expected, got = "a surface, whose normals are lit", f"a {type(mesh).__name__} without faces"
        remedy = "name its tangent vectors by tangents= or its normals by normals="
        raise ValueError(_check.message("mesh", expected, got, remedy))
    # VTK takes the faces of a mesh that has vertices or lines for others.
    bare = vtkPolyData()
    bare.SetPoints(surface.GetPoints())
    bare.SetPolys(surface.GetPolys())
    bare.SetStrips(surface.GetStrips())
    found, vectors = _by_vtk(bare, consistent=not as_wound)
    vectors[~used(bare)] = 0
    if _same_cells(bare, found):
        # VTK's copy of the cells takes as much memory as the mesh.
        found = bare
    del bare
    owners = Owners(starts, origin)
    shape = Shape(found, owners)
    lean, border = None, shape.open[shape.piece]
    sharp: Array = np.zeros(owners.count)
    inside = np.zeros(owners.count, dtype=np.intp)
    if sides:
        lean = shape.lean(vectors)
        sharp = crease_share(shape.edge_counts())
    if not as_wound:
        shape.orient(vectors, lean, view)
    if origin is not None:
        if dimension(mesh) == 3:
            size = [count] if starts is None else np.diff(starts)
            inside = size - owners.counts(np.flatnonzero(origin >= 0))
        vectors = scattered(vectors, origin, count)
        border = scattered(border.astype(np.float32), origin, count) > 0
        lean = None if lean is None else scattered(lean, origin, count)
    all_of = Sided(vectors, lean, border, sharp, computed=True, inside=inside)
    return all_of.part(0, slice(None)) if starts is None else all_of


def _of_grid(mesh: Grid, view: View | None, *, as_wound: bool, sides: bool) -> Sided:
    """Return the normals of a grid's outer surface, which is one piece, part by part."""
    count = mesh.GetNumberOfPoints()
    vectors = np.zeros((count, 3), dtype=np.float32)
    lean = np.zeros(count if sides else 0, dtype=np.float32)
    low, high, total = np.full(3, np.inf), np.full(3, -np.inf), np.zeros(3)
    size = on_surface = 0
    for part in grids.parts(mesh):
        points = places(part.surface)[part.side == 0]
        on_surface += len(points)
        points = points[np.all(np.isfinite(points), axis=1)].astype(np.float64)
        low = np.minimum(low, points.min(axis=0, initial=np.inf))
        high = np.maximum(high, points.max(axis=0, initial=-np.inf))
        total, size = total + points.sum(axis=0), size + len(points)
    middle = total / max(size, 1)
    scale = float(np.maximum(high - middle, middle - low).max()) if size else 1.0
    lines = [_place_numbers(line) for line in grids.rim(mesh)]
    single, ends = _single_edges(lines)
    sums, counts = [], np.zeros((4, 1), dtype=np.intp)
    for part in grids.parts(mesh):
        surface, own = part.surface, part.side == 0
        normals = _by_vtk(surface, consistent=False)[1]
        shape = PartShape(surface, part.side, middle, scale or 1.0)
        vectors[part.origin[own]] = normals[own]
        sums.append(shape.sums(normals, view))
        if sides:
            lean[part.origin[own]] = shape.lean(normals)[own]
            counts += shape.edge_counts()
        single = np.setdiff1d(single, _inner_edges(shape, ends))
    border = np.array([len(single) > 0])
    whole = Sums(*(np.sum(each, axis=0) for each in zip(*sums, strict=True)))
    if not as_wound and whole.turned(border)[0]:
        vectors *= -1
        lean *= -1
    return Sided(
        vectors,
        lean if sides else None,
        bool(border[0]),
        float(crease_share(counts)[0]) if sides else 0.0,
        computed=True,
        inside=count - on_surface,
    )


def _single_edges(lines: list[NDArray[np.uint64]]) -> tuple[NDArray[np.uint64], ...]:
    """Return the edges along lines at whose place there is no other of them, and all places."""
    none = np.empty(0, dtype=np.uint64)
    edges = np.concatenate([none, *(_edge_numbers(line[:-1], line[1:]) for line in lines)])
    numbers, times = np.unique(edges, return_counts=True)
    return numbers[(times == 1) & (numbers != 0)], np.unique(np.concatenate([none, *lines]))


def _inner_edges(shape: Shape, ends: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return the edges between some places that have two faces."""
    number, size = _place_numbers(shape.points), len(shape.points)
    near = np.isin(number, ends)
    rows = shape.triangles[np.count_nonzero(near[shape.triangles], axis=1) > 1]
    a, b = rows.ravel(), rows[:, [1, 2, 0]].ravel()
    keys = np.minimum(a, b).astype(np.int64) * size + np.maximum(a, b)
    keys, times = np.unique(keys, return_counts=True)
    lower, upper = np.divmod(keys[times > 1], max(size, 1))
    return _edge_numbers(number[lower], number[upper])


def _by_vtk(surface: vtkPolyData, *, consistent: bool) -> tuple[vtkPolyData, Array]:
    """Return a surface as VTK's filter gives it, without its normals, and those."""
    normals = vtkPolyDataNormals()
    normals.SplittingOff()
    normals.NonManifoldTraversalOff()
    normals.SetConsistency(consistent)
    normals.SetInputData(surface)
    normals.Update()
    found = normals.GetOutput()
    vectors = np.array(as_numpy(found.GetPointData().GetNormals()))
    found.GetPointData().Initialize()
    return found, vectors


def piece_numbers(mesh: Dataset) -> Indices:
    """Return for each point the number of its connected piece; 0 where it is on no surface."""
    numbers = np.zeros(mesh.GetNumberOfPoints(), dtype=np.intp)
    surface, origin = _skin(mesh)
    if surface is not None:
        own = np.arange(len(numbers)) if origin is None else origin
        numbers[own[own >= 0]] = pieces(surface, Owners()).piece[own >= 0]
    return numbers


def _skin(mesh: Dataset) -> tuple[vtkPolyData | None, Indices | None]:
    """Return the outer surface of a mesh and its points' indices, None where it has no faces."""
    surface, origin = (mesh, None) if isinstance(mesh, vtkPolyData) else outer_surface(mesh)
    return (surface if has_faces(surface) else None), origin


def _same_cells(one: vtkPolyData, other: vtkPolyData) -> bool:
    """Return whether two surfaces of polygons have equal cells."""
    strips = one.GetNumberOfStrips() or other.GetNumberOfStrips()
    cells = [connectivity(surface.GetPolys()) for surface in (one, other)]
    return not strips and all(np.array_equal(a, b) for a, b in zip(*cells, strict=True))
