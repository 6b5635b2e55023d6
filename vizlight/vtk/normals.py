"""Normals of a dataset: its own array or the surface's normals, and the side that is seen."""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from vizlight import _check
from vizlight._types import Array, Bools, Dataset, Facing, Foreign, Indices, Raw, Rows, Slice
from vizlight.model import kernels
from vizlight.scene import View
from vizlight.shading.inputs import ArraySource
from vizlight.shading.results import digest
from vizlight.vtk import cells as vtk_cells
from vizlight.vtk import corners as vtk_corners
from vizlight.vtk import hull, orientation
from vizlight.vtk.arrays import vectors_of
from vizlight.vtk.hull import Grid, dimension, scattered, surface_of
from vizlight.vtk.memory import once, recalled
from vizlight.vtk.topology import (
    are_closed,
    edge_numbers,
    inner_edges,
    place_numbers,
    runs,
    single_edges,
    topology,
)

#: Least number of points, where there are as many, by which the side of a height field is found.
SEEN = 1 << 16
#: Number of neighbours through which the plane of a point of a scan is laid.
NEIGHBOURS = 12


@dataclass(frozen=True)
class Sided:
    """Normals of the points of a mesh, and the facts that tell which side of them is seen.

    ``vectors`` are outward on closed pieces, in agreement with each other on others. ``lean`` is
    the sine of the largest angle between a normal and a face around its point, negative where the
    surface is concave; None is 0 everywhere, see :meth:`leaning`. ``open`` is 1 for points of
    pieces with a border, or with faces that have no common side, as in a Klein bottle: either side
    may be seen; from 2 on it is the number of such a piece that is a height field, and 0 for
    others. ``sharp`` is the share of edges that are creases, across which normals were averaged,
    and ``inside`` the number of points of a volume that are not on its surface, where these are the
    points of several blocks one of each. ``kept`` normals come from an earlier result, ``computed``
    ones from the surface, not an array of the user. ``averted`` are, by the numbers of ``open``,
    the height fields that show the eye their back, where that is known from a whole of which these
    points are a part; a single one says that none is open.
    """

    vectors: Array
    lean: Array | None = None
    open: Indices | int = 0
    sharp: float | Array = 0.0
    kept: bool = False
    computed: bool = False
    inside: int | Indices = 0
    averted: Bools | None = None

    @property
    def any_open(self) -> bool:
        """Whether a piece has a border."""
        return bool(np.any(self.open)) if self.averted is None else len(self.averted) > 1

    def at(self, rows: Indices, /) -> Sided:
        """Return the normals of some points, with repetitions if any."""
        lean = None if self.lean is None else self.lean[rows]
        border = self.open[rows] if isinstance(self.open, np.ndarray) else self.open
        return dataclasses.replace(self, vectors=self.vectors[rows], lean=lean, open=border)

    def of_blocks(self, chosen: Bools, rows: Indices) -> Sided:
        """Return the normals of some of several blocks, which have some of the points."""
        part = self.at(rows)
        if isinstance(part.sharp, np.ndarray):
            part = dataclasses.replace(part, sharp=part.sharp[chosen])
        if isinstance(part.inside, np.ndarray):
            part = dataclasses.replace(part, inside=part.inside[chosen])
        return part

    def of_block(self, number: int, rows: Slice) -> Sided:
        """Return the normals of one of several blocks, which has some of the points."""
        border = self.open
        if isinstance(border, np.ndarray):
            # The height fields of a block have numbers one after the other.
            border = border[rows]
            first = np.min(border, where=border > 1, initial=len(self.vectors) + 2)
            border = np.where(border > 1, border - first + 2, border)
        sharp, inside = (
            each[number] if isinstance(each, np.ndarray) else each
            for each in (self.sharp, self.inside)
        )
        lean = None if self.lean is None else self.lean[rows]
        return dataclasses.replace(
            self, vectors=self.vectors[rows], lean=lean, open=border,
            sharp=float(sharp), inside=int(inside),
        )  # fmt: skip

    def facts(self) -> Array:
        """Return for each point its lean, and its number of :attr:`open`."""
        lean = np.zeros(len(self.vectors)) if self.lean is None else self.lean
        border = np.broadcast_to(self.open, len(self.vectors))
        return np.stack([lean, border], axis=1).astype(np.float64)

    def facing(self, facing: Facing, points: ArraySource, view: View | None) -> Array | Turned:
        """Return the normals turned to a side; the normals themselves are not changed."""
        if facing not in ("auto", "eye") or view is None or len(self.vectors) == 0:
            return self.vectors
        # Closed pieces show an eye their outer side alone: nothing to turn.
        if facing == "auto" and not self.any_open:
            return self.vectors
        return Turned(self, points, view, facing, self.averted_fields(points, view))

    def averted_fields(self, points: ArraySource, view: View | None) -> Bools:
        """Return by the numbers of :attr:`open` the height fields that show an eye their back.

        It is the side that takes up less of the eye's view, by the sum of ``N . w / d^2`` over
        some of the points, with ``w`` the direction toward the eye and ``d`` the distance from it.
        Without a view they are seen from above.
        """
        if self.averted is not None:
            return self.averted
        most = int(np.max(self.open, initial=1))
        if most < 2 or self.lean is None:
            return np.zeros(most + 1, dtype=np.bool_)
        count = len(self.vectors)
        some = slice(0, count, max(count // SEEN, 1))
        number = np.broadcast_to(self.open, count)[some]
        # A height field shows an eye above it more of its upper side, whatever its borders do.
        shown = facing_of(self.vectors[some], points[some], view)
        averted: Bools = np.bincount(number, shown, most + 1) < 0
        # Numbers 0 and 1 are no height fields: these are never turned, or point by point.
        averted[:2] = False
        return averted

    def leaning(self, facing: Facing, averted: Bools, rows: Rows = slice(None)) -> Array | None:
        """Return the sine by which normals may lean away from an eye that sees their own side.

        Faces around a point are seen until the last of them is averted where the surface is convex,
        and no longer than the first where it is concave, but by
        :data:`~vizlight.vtk.orientation.MOST_LEAN` at most. On a height field under ``"auto"``
        all visible parts of the side that an eye sees most of are lit on that side, and visible
        parts of the other side, below a border, on the other. ``averted`` are
        :meth:`averted_fields`.
        """
        if self.lean is None:
            return None
        lean, number = self.lean[rows], np.asarray(self.open)
        limited = np.clip(lean, -orientation.MOST_LEAN, orientation.MOST_LEAN)
        number = number[rows] if number.ndim else number
        field = number > 1
        if facing != "auto" or not field.any():
            return limited
        # The side that shows most takes in what leans to it; the other side gives that up.
        size = np.abs(lean)
        return np.where(field, np.where(averted[number], -size, size), limited)


class Vote(NamedTuple):
    """Decision of the whole about the pieces of a part, see :mod:`vizlight.vtk.sides`.

    ``sign`` is 1 or -1, by which the normals of the part are multiplied; ``number`` and ``averted``
    are as :attr:`Sided.open` and :attr:`Sided.averted`, and ``side`` as that of SurfaceShape, of
    the points of a mesh of cells that fill space.
    """

    sign: Array
    number: Indices
    averted: Bools
    side: NDArray[np.int8] | None = None


def facing_of(normals: Array, points: Raw, view: View | None) -> Array:
    """Return how large the side of each normal appears to an eye: ``N . w / d^2``."""
    if view is None:
        shown = normals[:, 2]
    else:
        toward, far = kernels.unit(orientation.toward_eye(view, points))
        # The solid angle of a patch about the eye; divided twice, as the square of a tiny distance
        # would underflow.
        with np.errstate(all="ignore"):
            shown = kernels.dot(normals.T, toward) / far / far
    # A point at the eye itself has no direction toward it, and one that is not finite no place.
    return np.where(np.isfinite(shown), shown, 0.0)


class Turned:
    """Normals turned to the side that an eye sees, made for each slice and not stored."""

    def __init__(
        self, sided: Sided, points: ArraySource, view: View, facing: Facing, fields: Bools
    ) -> None:
        self.shape, self.dtype = sided.vectors.shape, sided.vectors.dtype
        self._sided, self._points, self._view = sided, points, view
        self._facing, self._fields = facing, fields

    def __getitem__(self, rows: Rows, /) -> Array:
        """Return a slice of the normals."""
        sided, vectors = self._sided, self._sided.vectors[rows]
        lean = sided.leaning(self._facing, self._fields, rows)
        averted = _averted(vectors, self._points[rows], self._view, lean)
        if self._facing == "auto":
            border = sided.open
            averted &= (border[rows] if isinstance(border, np.ndarray) else border) > 0
        return np.where(averted[:, np.newaxis], -vectors, vectors)


def _averted(vectors: Array, points: Raw, view: View, lean: Array | None) -> Bools:
    """Return the points with normals that point away from the eye, by more than they lean."""
    toward = orientation.toward_eye(view, points)
    # Across the lean a normal of a coarse mesh points away while its faces are still seen: turning
    # it there would draw a dark rim.
    least = 0.0 if lean is None else -lean * np.sqrt(kernels.dot(toward, toward))
    return np.asarray(kernels.dot(vectors.T, toward) < least, dtype=np.bool_)


def sided_normals(
    mesh: Dataset,
    value: object,
    n: int,
    facing: Facing,
    *,
    kept: Callable[[Foreign], Sided | None] | None = None,
    vote: Vote | None = None,
    block: Indices | None = None,
) -> Sided:
    """Return normals with their sides: those in ``value``, of the mesh, or of its surface.

    ``kept`` is a function of the mesh that returns normals of its surface which are known already,
    or None. ``vote`` is the decision of the whole, of which the mesh is a part, about its sides.
    ``block`` is the number of the block of each point, where the mesh is several.
    """
    vectors = given_normals(mesh, value, n)
    if vectors is None:
        if facing == "as given":
            return computed_normals(mesh, as_wound=True, sides=False, block=block)
        if vote is not None:
            return computed_normals(mesh, vote=vote)
        return (kept and kept(mesh)) or computed_normals(mesh, block=block)
    # Integers without a sign, such as normals in bytes, could not be turned over.
    if vectors.dtype.kind != "f":
        vectors = vectors.astype(np.float64)
    # These two need no pieces; in n-space there is no order of corners that tells a side.
    if facing in ("eye", "as given") or n != 3:
        return Sided(vectors)
    if vote is None and hull.in_parts(mesh):
        return _sided_grid(mesh, vectors)
    surface, origin = _skin(mesh)
    if surface is None:
        return Sided(vectors)
    on_surface = vectors if origin is None else vectors[origin]
    of = block if block is None or origin is None else block[origin]
    if vote is None:
        inward, border = _of_given(surface, on_surface, of)
        # Given normals agree with each other by themselves, so that a block counts as one piece.
        number = orientation.sides_of(vectors, block, border)
    else:
        inward, number = vote.sign[:1] < 0, vote.number
    if inward.any():
        vectors = (
            -vectors if block is None else np.where(inward[block, np.newaxis], -vectors, vectors)
        )
    lean = None
    if np.any(number > 1):
        lean = lean_of_given(surface, on_surface)
        lean = lean if origin is None else scattered(lean, origin, len(vectors))
        lean = lean if block is None else np.where(number[block] > 1, lean, 0)
    side = int(number[0]) if block is None else number[block]
    return Sided(vectors, lean, open=side, averted=None if vote is None else vote.averted)


def _of_given(surface: vtkPolyData, normals: Array, block: Indices | None) -> tuple[Bools, Bools]:
    """Return which blocks of a surface have normals that point inside, and which have a border."""
    closed, alike = are_closed(surface, block)
    of, count = np.zeros(len(normals), dtype=np.intp) if block is None else block, len(closed)
    doubtful = closed & ~alike
    if doubtful.any():
        # A closed surface whose faces have no common side, such as Boy's, has no outside.
        shape = orientation.SurfaceShape(surface, block=of)
        _wound(surface, shape, as_wound=False)
        inside_out = np.bincount(of, shape.inside_out[shape.piece], count) > 0
        closed = closed & (alike | ~inside_out)
    if not closed.any():
        return closed, ~closed
    ids = np.flatnonzero(vtk_cells.used(surface))
    return closed & _inward(vtk_cells.places(surface)[ids], normals[ids], of[ids], count), ~closed


def lean_of_given(surface: vtkPolyData, normals: Array) -> Array:
    """Return :func:`.orientation.lean_of`, computed once for a surface and its normals."""
    return once(surface, f"lean {digest(normals)}", lambda: orientation.lean_of(surface, normals))


def are_of_faces(surface: vtkPolyData, normals: Array) -> bool:
    """Return whether normals fit the faces around all but few corners of a surface of triangles.

    Points that are split at sharp edges would then have normals near those that they have.
    """
    if surface.GetNumberOfStrips() or surface.GetPolys().IsHomogeneous() != orientation.CORNERS:
        return False
    apart = lean_of_given(surface, normals) > np.sin(np.radians(vtk_corners.SHARP / 2))
    # A point is split into at most as many as it has corners.
    return int(
        np.count_nonzero(apart[vtk_cells.triangles(surface)])
    ) <= vtk_corners.MANY_SHARP * len(normals)


def _inward(points: Array, normals: Array, block: Indices, count: int) -> Bools:
    """Return of which closed blocks the normals at the outermost points point inside."""
    finite = np.isfinite(points).all(axis=1) & np.isfinite(normals).all(axis=1)
    if not finite.all():
        points, normals, block = points[finite], normals[finite], block[finite]
    if np.any(block[1:] < block[:-1]):
        order = np.argsort(block, kind="stable")
        points, normals, block = points[order], normals[order], block[order]
    start, number = runs(block)
    outward = np.zeros(count)
    # At the outermost points along each axis an outward normal points along it: six votes.
    for axis in range(3):
        for end in (np.maximum, np.minimum) if len(start) else ():
            along = points[:, axis]
            most = np.repeat(end.reduceat(along, start), np.diff(start, append=len(block)))
            at = np.flatnonzero(along == most)
            # The first of several in each block.
            at = at[runs(block[at])[0]]
            sign = 1 if end is np.maximum else -1
            outward[number] += sign * normals[at, axis]
    return outward < 0


def _sided_grid(mesh: Grid, vectors: Array) -> Sided:
    """Return normals of a grid with their sides, found part by part."""
    # Edges that are not on the border of a sheet have two faces.
    edges = [edge_numbers(x[:-1], x[1:]) for x in map(place_numbers, hull.rim(mesh))]
    if any(np.bitwise_xor.reduce(np.concatenate([[np.uint64(0)], *edges]), keepdims=True)):
        side = int(orientation.sides_of(vectors, None, np.ones(1, dtype=np.bool_))[0])
        if side < 2:
            return Sided(vectors, open=side)
        lean = np.zeros(len(vectors), dtype=np.float32)
        for part in hull.parts(mesh):
            on = part.side == 0
            lean[part.origin[on]] = orientation.lean_of(part.surface, vectors[part.origin])[on]
        return Sided(vectors, lean, open=side)
    points, normals = [], []
    for part in hull.parts(mesh):
        where = vtk_cells.places(part.surface)
        rows = vectors[part.origin]
        valid = np.isfinite(where).all(axis=1) & np.isfinite(rows).all(axis=1) & (part.side == 0)
        where, rows = where[valid], rows[valid]
        # Only the outermost points of a part can be the outermost ones of the whole.
        ends = [f(axis) for axis in where.T for f in (np.argmax, np.argmin) if len(where)]
        points.append(where[ends])
        normals.append(rows[ends])
    outermost, rows = np.concatenate(points), np.concatenate(normals)
    inward = _inward(outermost, rows, np.zeros(len(rows), dtype=np.intp), 1)[0]
    return Sided(-vectors if inward else vectors)


def given_normals(mesh: Dataset, value: object, n: int) -> Array | None:
    """Return the normals in ``value`` or the active ones of the mesh, None if they are computed.

    Where active ones have no length, or are not finite, those of the faces stand in their place.
    """
    if value is not None:
        return vectors_of(mesh, "normals", value, n)
    if n != 3:
        expected = f"a point array of {n} components for {n}-space"
        remedy = "without one pass tangents=, conditioned by the name of the surface's tangents"
        raise _check.value_error("normals", expected, None, remedy)
    carried = mesh.GetPointData().GetNormals()
    if carried is None:
        return None
    vectors = vectors_of(mesh, "normals", carried.GetName() or vtk_cells.as_numpy(carried), 3)
    longest = np.abs(vectors).max(axis=1, initial=0)
    valid = (longest > 0) & (longest < np.inf)
    if valid.all():
        return vectors
    # Files have normals of no length, or NaN, where their writer knew none: the faces do.
    if not valid.any():
        return None
    of_faces = computed_normals(mesh, sides=False).vectors
    against = np.einsum("ij,ij->", of_faces[valid], kernels.unit_rows(vectors[valid])) < 0
    return np.where(valid[:, np.newaxis], vectors, -of_faces if against else of_faces)


def computed_normals(
    mesh: Dataset,
    *,
    view: View | None = None,
    as_wound: bool = False,
    sides: bool = True,
    vote: Vote | None = None,
    owner: vtkPolyData | None = None,
    block: Indices | None = None,
) -> Sided:
    """Return the normals of a mesh's outer surface, zero at points that are not on it.

    They are means by the corners of the faces around each point, see
    :func:`~vizlight.vtk.corners.corner_normals`, in float32. They point outward on a closed surface
    and on a connected piece that is nearly closed. Any other piece has no outside: its normals are
    flipped together if on average they point away from the eye, or toward the centroid of the
    piece. Points that slivers join, with a side of at most :data:`~vizlight.vtk.corners.NEAR` of
    the longest, as isosurfaces through nodes of a grid have them, have one normal, where their own
    are within :data:`~vizlight.vtk.corners.SHARP` degrees of it. Open pieces are turned to the eye
    of ``view`` as a whole; with ``as_wound`` normals have the sides that the order of the corners
    of each face gives them. ``sides`` asks for lean and share of sharp edges, ``vote`` is the
    decision of the whole, of which this is a part, about the pieces, and ``block`` the number of
    the block of each point, where the mesh is several that have nothing in common. Normals are kept
    as long as the points of ``owner``, by default the mesh.

    Normals of a surface with the defaults are computed once, see :func:`~vizlight.vtk.memory.once`,
    and may not be changed.
    """
    if view is None and sides and vote is None and not as_wound:
        name = "normals" if block is None else f"normals {digest(block)}"
        return once(mesh, name, lambda: _frozen(_computed(mesh, block=block)), owner)
    return _computed(mesh, view=view, as_wound=as_wound, sides=sides, vote=vote, block=block)


def known_normals(mesh: vtkPolyData) -> Sided | None:
    """Return what :func:`computed_normals` keeps of a surface, None where it keeps nothing."""
    sided = recalled(mesh, "normals")
    return sided if isinstance(sided, Sided) else None


def remember(mesh: vtkPolyData, sided: Sided) -> None:
    """Keep normals of a surface, found together with others, as if they were computed alone."""
    once(mesh, "normals", lambda: _frozen(sided))
    once(mesh, "creases", lambda: float(sided.sharp))


def _frozen(sided: Sided) -> Sided:
    """Return normals with arrays that cannot be written."""
    for array in (sided.vectors, sided.lean, sided.open):
        if isinstance(array, np.ndarray):
            array.setflags(write=False)
    return sided


def _computed(
    mesh: Dataset,
    *,
    view: View | None = None,
    as_wound: bool = False,
    sides: bool = True,
    vote: Vote | None = None,
    outer: Outer | None = None,
    block: Indices | None = None,
) -> Sided:
    """Compute normals; see :func:`computed_normals`."""
    count = mesh.GetNumberOfPoints()
    if count == 0:
        return Sided(np.zeros((0, 3), dtype=np.float32), computed=True)
    if vote is None and hull.in_parts(mesh):
        return _of_grid(mesh, view, as_wound=as_wound, sides=sides)
    part = None if vote is None else vote.side
    is_whole = vote is None and outer is None and block is None
    if is_whole and sides and not as_wound:
        on_map = _of_map(mesh, view)
        if on_map is not None:
            return on_map
    if block is not None:
        outer = outer_shape(mesh, block=block)
    # First normals that agree with each other on each piece, then the side of each piece as a
    # whole.
    wound = wound_normals(mesh, as_wound=as_wound, side=part, outer=outer)
    if wound is None and is_scan(mesh):
        return _of_cloud(mesh, view)
    if wound is None:
        expected, got = "a surface, whose normals are lit", f"a {type(mesh).__name__} without faces"
        remedy = "name its tangent vectors by tangents= or its normals by normals="
        raise _check.value_error("mesh", expected, got, remedy)
    shape, vectors, first, origin = wound
    lean, border = None, shape.open | shape.inside_out
    side: Indices = border.astype(np.intp)
    sharp: float | Array = 0.0
    inside: int | Indices = 0
    if sides or not as_wound:
        sums, leaning = shape.survey(vectors)
        if vote is not None:
            shape.turn(vote.sign < 0, vectors, leaning)
        elif not as_wound:
            shape.orient(vectors, sums, leaning, view)
        if sides:
            lean = leaning if first is None else leaning[first]
            side = (
                orientation.sides_of(vectors, shape.piece, border) if vote is None else vote.number
            )
            # What has no two sides is no height field, even where its normals fit in a half space.
            side = np.where(shape.inside_out, 1, side)
            share = vtk_corners.crease_share(shape.edges)
            sharp = float(share) if block is None else share
    number = side[shape.piece]
    if origin is not None:
        if dimension(mesh) == 3 or not isinstance(mesh, vtkUnstructuredGrid):
            # Points inside a volume or of hidden cells have no normal; they are no fault.
            inside = count - len(origin)
            if block is not None:
                inside = np.bincount(block) - np.bincount(block[origin], minlength=block[-1] + 1)
        vectors = scattered(vectors, origin, count)
        number = scattered(number, origin, count)
        lean = None if lean is None else scattered(lean, origin, count)
    averted = None if vote is None else vote.averted
    return Sided(vectors, lean, number, sharp, computed=True, inside=inside, averted=averted)


def wound_normals(
    mesh: Dataset,
    *,
    as_wound: bool = False,
    side: NDArray[np.int8] | None = None,
    outer: Outer | None = None,
) -> tuple[orientation.SurfaceShape, Array, Indices | None, Indices | None] | None:
    """Return the outer surface of a mesh and the normals of its points, None where it has none.

    The normals agree with each other on each piece, and are zero where no face is. After them come
    the first of the points that slivers join with each, None without slivers, and the
    point of the mesh that each point of the surface is, None for a surface.

    With ``side`` the mesh is a part of another, see :attr:`SurfaceShape.side`. ``outer`` is
    :func:`outer_shape` where that is known.
    """
    outer = outer or outer_shape(mesh, side)
    if outer is None:
        return None
    shape, surface, origin = outer
    wound = _wound(surface, shape, as_wound=as_wound)
    vectors = vtk_corners.surface_normals(wound)
    if shape.seam.any() and not as_wound:
        _mend_seams(wound, shape, vectors)
    # Isosurfaces have points a rounding apart; each would have the normal of its own sliver.
    slivers = shape.slivers
    if not shape.triangular:
        slivers = vtk_corners.all_slivers(shape.points, vtk_corners.faces_of_three(surface))
    first = vtk_corners.joined(shape.points, slivers)
    if first is not None:
        least = float(np.cos(np.radians(vtk_corners.SHARP)))
        vectors, first = vtk_corners.common_normals(
            shape.points, shape.triangles, vectors, first, least
        )
        # The faces around joined points meet at the first of them, where the survey then looks at
        # all of them for one lean.
        shape.join(first)
    return shape, vectors, first, origin


def _of_map(mesh: Dataset, view: View | None) -> Sided | None:
    """Return the normals of a map, one height field without an edge; None for another mesh."""
    if not isinstance(mesh, vtkPolyData) or (normal := orientation.normal_of_map(mesh)) is None:
        return None
    if view is not None and len(view.position or view.direction or ()) == 3:
        # Across its plane all points are at one place.
        axis = np.flatnonzero(normal)
        toward = orientation.toward_eye(view, vtk_cells.places(mesh)[:1])[axis, 0]
        normal[axis] = np.where(normal[axis] * toward < 0, -normal[axis], normal[axis])
    # A point without a face has no normal.
    vectors: Array = np.where(vtk_cells.used(mesh)[:, np.newaxis], normal, 0.0).astype(np.float32)
    lean = np.zeros(len(vectors), dtype=np.float32)
    return Sided(vectors, lean, np.full(len(vectors), 2), computed=True)


class Outer(NamedTuple):
    """The outer surface of a mesh.

    ``origin`` is the point of the mesh that each point of the surface is, None for a surface.
    """

    shape: orientation.SurfaceShape
    surface: vtkPolyData
    origin: Indices | None


def outer_shape(
    mesh: Dataset, side: NDArray[np.int8] | None = None, block: Indices | None = None
) -> Outer | None:
    """Return the outer surface of a mesh, None where it has none; see :func:`wound_normals`."""
    if side is None:
        surface, origin = surface_of(mesh)
        if not vtk_cells.has_faces(surface):
            return None
        block = block if block is None or origin is None else block[origin]
        # Faces that are there twice are rare, and the edges tell that there are none.
        bare = vtk_cells.finite_faces(vtk_cells.bare_faces(surface))
        shape = orientation.SurfaceShape(bare, block=block)
        if not shape.doubtful or vtk_cells.first_twins(surface.GetPolys()) is None:
            return Outer(shape, bare, origin)
    skin, origin = _skin(mesh)
    if skin is None:
        return None
    if side is not None and origin is not None:
        # From here on the points are those of the surface, which may have others or another order.
        side = side[origin]
        if dimension(mesh) == 3:
            # Where the part is cut from the others faces arise that join what is apart.
            around = vtk_cells.finite_faces(skin, side == 0)
            skin = around if vtk_cells.has_faces(around) else skin
    return Outer(orientation.SurfaceShape(skin, side, block), skin, origin)


def creases(mesh: vtkPolyData, *, has_normals: bool = False) -> float:
    """Return the share of edges that are creases, see :func:`~.corners.crease_share`.

    Without any, normals are computed beside it, and found by :func:`computed_normals`, unless the
    mesh ``has_normals``.
    """
    return once(mesh, "creases", lambda: _creases(mesh, has_normals))


def _creases(mesh: vtkPolyData, has_normals: bool) -> float:
    if orientation.normal_of_map(mesh) is not None:
        return 0.0
    outer = outer_shape(mesh)
    share = 0.0 if outer is None else float(vtk_corners.crease_share(outer.shape.edges))
    if not share and not has_normals:
        once(mesh, "normals", lambda: _frozen(_computed(mesh, outer=outer)))
    return share


def _mend_seams(surface: vtkPolyData, shape: orientation.SurfaceShape, vectors: Array) -> None:
    """Make normals anew where faces around a point have no common side, as on a Möbius strip.

    The others take the side of the first.
    """
    fans = []
    for rows in vtk_corners.corners_by_size(surface):
        # Each corner of each face with the one ahead of it and the one behind it.
        corners = np.stack([np.roll(rows, -i, axis=1).ravel() for i in (0, 1, -1)])
        fans.append(corners[:, shape.seam[corners[0]]])
    fan = np.concatenate(fans, axis=1)
    at, ahead, behind = (shape.points[ends].T.astype(np.float64) for ends in fan)
    across = kernels.unit(kernels.cross(ahead - at, behind - at))[0]
    _, first, number = np.unique(fan[0], return_index=True, return_inverse=True)
    turned = kernels.dot(across, across[:, first[number]]) < 0
    # Ahead and behind change places: the corner is wound as the first at its point.
    fan[1:, turned] = fan[:0:-1, turned]
    # Each corner becomes a triangle with two ends of its own, whose normals nobody asks for.
    apart = np.arange(fan[1:].size).reshape(2, -1) + len(first)
    points = shape.points[np.concatenate([fan[0, first], *fan[1:]])]
    mended = vtk_corners.corner_normals(points, [np.stack([number, *apart], axis=1)])
    vectors[fan[0, first]] = mended[: len(first)]


def is_scan(mesh: Dataset) -> bool:
    """Return whether a mesh is a scan: points in space that no cells join."""
    bare = not mesh.GetNumberOfCells()
    if isinstance(mesh, vtkPolyData):
        bare = mesh.GetNumberOfVerts() == mesh.GetNumberOfCells()
    elif isinstance(mesh, vtkUnstructuredGrid):
        bare = hull.dimension(mesh) == 0
    return mesh.GetNumberOfPoints() >= NEIGHBOURS and bare


def _of_cloud(mesh: Dataset, view: View | None) -> Sided:
    """Return normals of planes through neighbouring points, which face the eye."""
    from vtkmodules.vtkFiltersPoints import vtkPCANormalEstimation

    estimate = vtkPCANormalEstimation()
    estimate.SetSampleSize(NEIGHBOURS)
    # A plane has no side: each takes the side of a neighbour which was turned before.
    estimate.SetNormalOrientationToGraphTraversal()
    normals = vtk_cells.result(estimate, mesh).GetPointData().GetNormals()
    unit = np.array(vtk_cells.as_numpy(normals))
    unit[~np.isfinite(unit).all(axis=1)] = 0
    # Where an eye is known it decides, point by point: no side of a scan is the outer one for sure.
    if view is not None:
        unit = np.where(
            _averted(unit, vtk_cells.places(mesh), view, None)[:, np.newaxis], -unit, unit
        )
    return Sided(unit, open=True, computed=True)


def _of_grid(mesh: Grid, view: View | None, *, as_wound: bool, sides: bool) -> Sided:
    """Return the normals of a grid's outer surface, which is one piece, part by part."""
    count = mesh.GetNumberOfPoints()
    vectors = np.zeros((count, 3), dtype=np.float32)
    lean = np.zeros(count if sides else 0, dtype=np.float32)
    low, high, total = np.full(3, np.inf), np.full(3, -np.inf), np.zeros(3)
    size = on_surface = 0
    # A first walk for centroid and size of the whole, about which the second one takes its sums; to
    # hold all parts would take the memory that is saved by them.
    for part in hull.parts(mesh):
        points = vtk_cells.places(part.surface)[part.side == 0]
        on_surface += len(points)
        points = points[np.all(np.isfinite(points), axis=1)].astype(np.float64)
        low = np.minimum(low, points.min(axis=0, initial=np.inf))
        high = np.maximum(high, points.max(axis=0, initial=-np.inf))
        total, size = total + points.sum(axis=0), size + len(points)
    middle = total / max(size, 1)
    # Lengths are scaled, since products of huge or of tiny ones leave the range of numbers.
    scale = float(np.maximum(high - middle, middle - low).max()) if size else 1.0
    lines = [place_numbers(line) for line in hull.rim(mesh)]
    # Edges of the rim that one part has alone are a border, unless another part has them too.
    single, ends = single_edges(lines)
    sums, counts = [], np.zeros(4, dtype=np.intp)
    for part in hull.parts(mesh):
        surface, inner = part.surface, part.side == 0
        normals = vtk_corners.surface_normals(surface)
        shape = orientation.PartShape(surface, part.side, middle, scale or 1.0)
        # Normals in the added layers lack the faces beyond; the next part has these points as its
        # own.
        vectors[part.origin[inner]] = normals[inner]
        own_sums, own_lean = shape.survey(normals)
        sums.append(own_sums._replace(score=shape.score(normals, view)))
        if sides:
            lean[part.origin[inner]] = own_lean[inner]
            counts += shape.edges
        if len(single):
            single = np.setdiff1d(single, inner_edges(shape.points, shape.triangles, ends))
    border = np.array([len(single) > 0])
    whole = orientation.Sums(*(np.sum(each, axis=0) for each in zip(*sums, strict=True)))
    if not as_wound and whole.turned(border)[0]:
        vectors *= -1
        lean *= -1
    side: Indices = border.astype(np.intp)
    if sides:
        side = orientation.sides_of(vectors, None, border)
    return Sided(
        vectors,
        lean if sides else None,
        int(side[0]),
        float(vtk_corners.crease_share(counts)) if sides else 0.0,
        computed=True,
        inside=count - on_surface,
    )


def _wound(surface: vtkPolyData, shape: orientation.SurfaceShape, *, as_wound: bool) -> vtkPolyData:
    """Return a surface with faces wound alike, by VTK where they are not.

    ``shape`` takes the faces as VTK winds them.
    """
    if as_wound or shape.alike:
        return surface
    orient: Foreign = vtkPolyDataNormals()
    # Split points would be new ones, and the faces no longer those of the points here.
    orient.SplittingOff()
    # ParaView's VTK may be older than the one of 9.4 that brought the other class.
    with contextlib.suppress(ImportError):
        from vtkmodules.vtkFiltersCore import vtkOrientPolyData

        orient = vtkOrientPolyData()
        orient.AutoOrientNormalsOff()
    # Across an edge of three faces or more there is no winding to carry on.
    orient.NonManifoldTraversalOff()
    output: vtkPolyData = vtk_cells.result(orient, surface)
    strips = surface.GetNumberOfStrips() or output.GetNumberOfStrips()
    cells = [vtk_cells.connectivity(each.GetPolys()) for each in (surface, output)]
    if strips or not all(np.array_equal(a, b) for a, b in zip(*cells, strict=True)):
        shape.rewind(output)
    return output


def piece_numbers(mesh: Dataset) -> Indices:
    """Return for each point the number of its connected piece; 0 where it is on no surface."""
    count = mesh.GetNumberOfPoints()
    surface, origin = _skin(mesh)
    if surface is None:
        return np.zeros(count, dtype=np.intp)
    piece = topology(vtk_cells.triangles(surface), vtk_cells.places(surface)).piece
    return piece if origin is None else scattered(piece, origin, count)


def _skin(mesh: Dataset) -> tuple[vtkPolyData | None, Indices | None]:
    """Return the faces of the outer surface and its points' indices, None where it has none."""
    surface, origin = surface_of(mesh)
    return (
        vtk_cells.finite_faces(vtk_cells.faces_only(surface))
        if vtk_cells.has_faces(surface)
        else None
    ), origin
