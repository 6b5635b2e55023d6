"""Normals of a mesh: an array that it has or those of its surface, and the side that is seen."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import pyvista as pv
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from vizlight import _check, _pool
from vizlight._version import __version__
from vizlight.mesh import point_arrays, records
from vizlight.mesh.blocks import has_faces
from vizlight.mesh.hull import outer_surface, scattered
from vizlight.mesh.point_arrays import unit_rows, vectors_of
from vizlight.scene import View

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import TypeVar

    from numpy.typing import NDArray

    from vizlight._types import Array, Bools, Indices
    from vizlight.scene import Scene
    from vizlight.shading.inputs import ArraySource
    from vizlight.shading.options import Facing, FeatureAngle, LightOptions

    SurfaceT = TypeVar("SurfaceT")

#: A piece counts as nearly closed if the sum of the area vectors of its faces is shorter than this
#: share of its area.
NEARLY_CLOSED = 0.2
#: Angle in degrees between the normals of two faces above which their common edge is sharp.
SHARP = 30.0
#: Least height of a triangle that has a direction, as a share of its longest side.
NARROWEST = 1e-5
#: Share of sharp edges, of all edges of a mesh, from which a warning names the remedy.
MANY_SHARP = 0.02
#: Name under which a user's array keeps out of the way of VTK's.
_OWN = "vizlight own"
#: Sharp edges are creases if at most this many times as many edges are half as sharp or more.
STAND_APART = 0.5
#: They also are if of those above twice the angle, at least MANY_SHARP of all edges, there are more
#: than of those between by this factor: corners stand apart from coarse arcs.
CORNERS_APART = 0.7
#: Most that a normal may lean, as a sine. Where faces around a point differ by more, its surface is
#: too rough or too coarse to tell bumps from hollows: without the limit 15 % of the corners that
#: are visible on a noisy isosurface would be lit on the side that is not seen, with it 3 %.
MOST_LEAN = 0.1
#: Number of points or triangles that are worked on at once, and of edges.
BLOCK, EDGES = 1 << 16, 1 << 21
#: Name of the point array in which normals that had to be computed stay with a result: three
#: components of the normal, its lean, and 1 on an open piece.
KEPT = "vizlight_normals"


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
        longer than the first where it is concave (negative), but by :data:`MOST_LEAN` at most.
        None: 0 everywhere.
    open : ndarray of bool, shape (n_points,), or bool
        Points of pieces with a border, of which either side may be seen.
    sharp : float
        Share of edges that are creases, across which normals were averaged.
    kept : bool
        Whether the normals come from an earlier result.
    computed : bool
        Whether they are those of the surface, not an array of the user.
    inside : int
        Number of points of a volume that are not on its surface.
    """

    vectors: Array
    lean: Array | None = None
    open: Bools | bool = False
    sharp: float = 0.0
    kept: bool = False
    computed: bool = False
    inside: int = 0

    @property
    def any_open(self) -> bool:
        """Whether a piece has a border."""
        return bool(np.any(self.open))

    def facts(self) -> Array:
        """Return for each point its lean, and 1 on a piece with a border."""
        lean = np.zeros(len(self.vectors)) if self.lean is None else self.lean
        border = np.broadcast_to(self.open, len(self.vectors))
        return np.stack([lean, border], axis=1).astype(np.float64)

    def facing(self, facing: Facing, points: ArraySource, view: View | None) -> Array:
        """Return the normals turned to a side; the normals themselves are not changed."""
        if facing not in ("auto", "eye") or view is None or len(self.vectors) == 0:
            return self.vectors
        if facing == "auto" and not self.any_open:
            return self.vectors
        turned = np.empty_like(self.vectors)
        for block in _pool.blocks(len(turned), BLOCK):
            own = self.vectors[block]
            lean = None if self.lean is None else self.lean[block]
            averted = _averted(own, points[block], view, lean)
            if facing == "auto":
                averted &= self.open[block] if isinstance(self.open, np.ndarray) else self.open
            turned[block] = np.where(averted[:, np.newaxis], -own, own)
        return turned


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


def sided_normals(mesh: pv.DataSet, value: object, n: int, facing: Facing) -> Sided:
    """Return normals with their sides: those in ``value``, of the mesh, or of its surface.

    Raises
    ------
    TypeError, ValueError
        If there are none, or an array does not fit.
    """
    given = _given(mesh, value, n)
    if given is None:
        if facing == "as given":
            return computed_normals(mesh, as_wound=True, sides=False)
        return _kept(mesh) or computed_normals(mesh)
    if given.dtype.kind != "f":
        given = given.astype(np.float64)
    if facing in ("eye", "as given") or n != 3:
        return Sided(given)
    surface, origin = _skin(mesh)
    if surface is None:
        return Sided(given)
    if not _is_closed(surface):
        return Sided(given, open=True)
    own = given if origin is None else np.where(origin[:, np.newaxis] < 0, 0, given[origin])
    return Sided(-given if _is_inward(surface, own) else given)


def are_computed(mesh: pv.DataSet, options: LightOptions) -> bool:
    """Return whether the normals of a mesh are those of its surface, not an array."""
    return options.normals is None and mesh.point_data.active_normals is None


def _is_closed(surface: pv.PolyData) -> bool:
    """Return whether each edge of a surface has an even number of faces; places make an edge.

    The numbers of the edges, made from the coordinates of their ends, cancel by pairs.
    """
    points, rows = np.asarray(surface.points), _triangles(surface)
    number, odd = np.zeros(len(points), dtype=np.uint64), np.uint64(0)
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(points), BLOCK):
            # The sum with 0 makes one of the two zeros.
            places = np.ascontiguousarray(points[block].astype(np.float64) + 0.0)
            for axis, factor in zip(places.view(np.uint64).T, _FACTORS, strict=True):
                number[block] = _mixed(number[block] ^ (axis * factor))
        for block in _pool.blocks(len(rows), BLOCK):
            a, b = number[rows[block].ravel()], number[rows[block][:, [1, 2, 0]].ravel()]
            edges = _mixed((a + b) ^ _mixed(a ^ b))
            odd ^= np.bitwise_xor.reduce(np.where(a == b, np.uint64(0), edges))
    return not odd


#: Odd numbers of 64 bits, and those of the finaliser of splitmix64.
_FACTORS = tuple(np.uint64(x) for x in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))
_MIX = tuple(np.uint64(x) for x in (0xBF58476D1CE4E5B9, 0x94D049BB133111EB))


def _mixed(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers of 64 bits in which each bit of the given ones changes half of the others."""
    x = (x ^ (x >> np.uint64(30))) * _MIX[0]
    x = (x ^ (x >> np.uint64(27))) * _MIX[1]
    mixed: NDArray[np.uint64] = x ^ (x >> np.uint64(31))
    return mixed


def _is_inward(surface: pv.PolyData, normals: Array) -> bool:
    """Return whether normals of a closed surface point to its inside, at its outermost points."""
    points = np.asarray(surface.points)
    used = np.flatnonzero(_used(surface))
    used = used[np.isfinite(points[used]).all(axis=1) & np.isfinite(normals[used]).all(axis=1)]
    if not len(used):
        return False
    outward = 0.0
    for axis in range(3):
        along = points[used, axis]
        outward += float(normals[used[along.argmax()], axis])
        outward -= float(normals[used[along.argmin()], axis])
    return outward < 0


def _triangles(surface: pv.PolyData) -> Indices:
    """Return the corners of the triangles of a surface."""
    faces = surface if surface.is_all_triangles else surface.triangulate()
    return np.asarray(faces.regular_faces, dtype=np.intp).reshape(-1, 3)


def _given(mesh: pv.DataSet, value: object, n: int) -> Array | None:
    """Return the normals in ``value`` or the active ones of the mesh, None if they are computed."""
    if value is not None:
        return vectors_of(mesh, "normals", value, n)
    if n != 3:
        expected = f"a point array of {n} components for {n}-space"
        remedy = "without one pass tangents=, conditioned by the name of the surface's tangents"
        raise ValueError(_check.message("normals", expected, None, remedy))
    carried = mesh.point_data.active_normals_name
    if carried is None:
        return None
    found = vectors_of(mesh, "normals", carried, 3)
    known = np.all(np.isfinite(found), axis=1)
    return found if known.all() else np.where(known[:, np.newaxis], found, 0)


def normals_of(
    mesh: pv.DataSet, value: object, n: int, view: View | None, *, warn: bool = False
) -> Array:
    """Return normals that agree on a side: those in ``value``, of the mesh, or of its surface.

    Those of the surface point outward on closed and nearly closed pieces, else as a whole to the
    eye and away from the centroid. With ``warn`` a warning is given if they were averaged across
    many sharp edges.
    """
    given = _given(mesh, value, n)
    if given is not None:
        return given
    found = computed_normals(mesh, view=view, sides=warn)
    if warn:
        warn_of_edges(found.sharp, isinstance(mesh, pv.PolyData))
    return found.vectors


def warn_of_edges(share: float, splits: bool) -> None:
    """Warn if a share of the edges is sharp and large; ``splits``: whether points can be split."""
    if share > MANY_SHARP:
        first = "" if splits else "take the extract_surface() of the mesh and "
        _check.warn(
            f"{share:.0%} of the edges are sharper than {SHARP:g} degrees, and light is averaged "
            f"across them; {first}pass feature_angle={SHARP:g} to split the points there"
        )


def surface_normals(mesh: pv.DataSet, view: View | None) -> Array:
    """Return the normals of a mesh's outer surface, zero at points that are not on it.

    VTK computes them in float32 and orients them consistently. They point outward on a closed
    surface and on a connected piece that is nearly closed. Any other piece has no outside: its
    normals are flipped together if on average they point away from the eye, or toward the
    centroid of the piece.

    Raises
    ------
    ValueError
        If the mesh has no surface.
    """
    return computed_normals(mesh, view=view, sides=False).vectors


def computed_normals(
    mesh: pv.DataSet, *, view: View | None = None, as_wound: bool = False, sides: bool = True
) -> Sided:
    """Return the normals of a mesh's outer surface; see :func:`surface_normals`.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh with a surface.
    view : View, optional
        Eye to which open pieces are turned as a whole.
    as_wound : bool
        Whether the normals have the sides that the order of the corners of each face gives them.
    sides : bool
        Whether lean and share of sharp edges are found.
    """
    if mesh.n_points == 0:
        return Sided(np.zeros((0, 3), dtype=np.float32), computed=True)
    surface, origin = _skin(mesh)
    if surface is None:
        expected, got = "a surface, whose normals are lit", f"a {type(mesh).__name__} without faces"
        remedy = "name its tangent vectors by tangents= or its normals by normals="
        raise ValueError(_check.message("mesh", expected, got, remedy))
    bare = pv.PolyData()
    bare.copy_structure(surface)
    found = bare.compute_normals(
        cell_normals=False,
        split_vertices=False,
        consistent_normals=not as_wound,
        auto_orient_normals=False,
        non_manifold_traversal=False,
    )
    vectors = np.array(found.point_data.pop("Normals"))
    vectors[~_used(bare)] = 0
    if _same_cells(bare, found):
        # VTK's copy of the cells takes as much memory as the mesh.
        found = bare
    del bare
    shape = _Shape(found)
    if not as_wound:
        shape.orient(vectors, view)
    lean, border, sharp, inside = None, shape.open[shape.piece], 0.0, 0
    if sides:
        lean = shape.lean(vectors)
        sharp = shape.sharp()
    if origin is not None:
        if mesh.GetMaxSpatialDimension() == 3:
            inside = mesh.n_points - int(np.count_nonzero(origin >= 0))
        vectors = scattered(vectors, origin, mesh.n_points)
        border = scattered(border.astype(np.float32), origin, mesh.n_points) > 0
        lean = None if lean is None else scattered(lean, origin, mesh.n_points)
    return Sided(vectors, lean, border, sharp, computed=True, inside=inside)


def _skin(mesh: pv.DataSet) -> tuple[pv.PolyData | None, Indices | None]:
    """Return the outer surface of a mesh and its points' indices, None where it has no faces."""
    if isinstance(mesh, pv.PointSet):
        mesh = mesh.cast_to_polydata(deep=False)
    if isinstance(mesh, pv.PolyData):
        surface, origin = mesh, None
    else:
        surface, origin = outer_surface(mesh)
    return (surface if has_faces(surface) else None), origin


def _same_cells(one: pv.PolyData, other: pv.PolyData) -> bool:
    """Return whether two surfaces of polygons have equal cells."""
    cells = [
        pv.convert_array(get())
        for surface in (one, other)
        for get in (surface.GetPolys().GetConnectivityArray, surface.GetPolys().GetOffsetsArray)
    ]
    strips = one.GetNumberOfStrips() or other.GetNumberOfStrips()
    return not strips and all(
        np.array_equal(a, b) for a, b in zip(cells[:2], cells[2:], strict=True)
    )


class _Shape:
    """The triangles of a surface, its connected pieces, and which of those have a border.

    Coincident points are connected, so that triangles that share no point can form one piece.
    What belongs to triangles is computed block by block, where it is needed.
    """

    def __init__(self, surface: pv.PolyData) -> None:
        self._points = points = np.asarray(surface.points)
        self.finite: Bools = np.all(np.isfinite(points), axis=1)
        same, self.piece = _pieces(surface)
        self.count = int(self.piece.max(initial=-1)) + 1
        self.triangles = _triangles(surface)
        #: Whether each piece has an edge of one face only.
        self.open: Bools = np.zeros(self.count, dtype=np.bool_)
        for keys, _ in _edges(self.triangles, len(points), same):
            keys.sort()
            single = np.ones(len(keys), dtype=np.bool_)
            repeats = keys[1:] == keys[:-1]
            single[1:] &= ~repeats
            single[:-1] &= ~repeats
            self.open[self.piece[(keys[single] // len(points)).astype(np.intp)]] = True
        del same
        self._measure()

    def _measure(self) -> None:
        """Place each piece about its centroid, and find the volumes of the pieces."""
        size = np.maximum(np.bincount(self.piece, self.finite, self.count), 1)
        self.away: Array = np.where(self.finite[:, np.newaxis], self._points, 0).astype(np.float64)
        sums = [np.bincount(self.piece, axis, self.count) for axis in self.away.T]
        middle = np.stack(sums, axis=1) / size[:, np.newaxis]
        for block in _pool.blocks(len(self.away), BLOCK):
            self.away[block] -= middle[self.piece[block]]
        # Lengths are scaled, because products of tiny ones underflow and of huge ones overflow.
        low, high = self.away.min(initial=0.0), self.away.max(initial=0.0)
        self.scale = np.maximum(-low, high) or 1.0
        self.turned: Bools = np.zeros(self.count, dtype=np.bool_)
        self.volume: Array = np.zeros(self.count)
        for _, rows, across in self._parts():
            height = _dots(across, self.away[rows[:, 0]] / self.scale)
            np.add.at(self.volume, self.piece[rows[:, 0]], height)

    def _parts(self) -> Iterator[tuple[Indices, Indices, Array]]:
        """Yield the numbers, the corners and the area vectors of some finite triangles."""
        for block in _pool.blocks(len(self.triangles), BLOCK):
            rows = self.triangles[block]
            known = np.flatnonzero(self.finite[rows].all(axis=1))
            rows = rows[known]
            a, b, c = (self.away[rows[:, i]] / self.scale for i in range(3))
            across = np.cross(b - a, c - a)
            across[self.turned[self.piece[rows[:, 0]]]] *= -1
            yield known + block.start, rows, across

    def orient(self, normals: Array, view: View | None) -> None:
        """Flip the normals of each piece that point inward, or away from the eye.

        A piece is nearly closed if the area vectors of its faces almost cancel; then the sign of
        the enclosed volume decides. For a sheet or a bowl the sign of a sum over its points
        decides, of three times the cosine between N and the direction toward the eye plus the
        cosine between N and the direction away from the centroid of the piece. Points that are
        not finite are ignored.
        """
        flipped = np.bincount(self.piece, self._scores(normals, view), self.count) < 0
        total, area = np.zeros((self.count, 3)), np.zeros(self.count)
        for _, rows, across in self._parts():
            owner = self.piece[rows[:, 0]]
            for axis in range(3):
                np.add.at(total[:, axis], owner, across[:, axis])
            np.add.at(area, owner, np.linalg.norm(across, axis=1))
        around = ~self.open | (np.linalg.norm(total, axis=1) < NEARLY_CLOSED * area)
        self.turned = np.where(around, self.volume < 0, flipped)
        for block in _pool.blocks(len(normals), BLOCK):
            normals[block][self.turned[self.piece[block]]] *= -1

    def _scores(self, normals: Array, view: View | None) -> Array:
        """Return how far the normal of each point agrees with the directions of a sheet."""
        scores = np.zeros(len(normals))
        seen = view is not None and len(view.position or view.direction or ()) == 3
        for block in _pool.blocks(len(normals), BLOCK):
            own, away = normals[block], self.away[block]
            score = _dots(own, unit_rows(away))
            if seen and view is not None:
                score += 3 * _dots(own, unit_rows(self._toward(view, block)))
            good = self.finite[block] & np.all(np.isfinite(own), axis=1)
            scores[block] = np.where(good, score, 0)
        return scores

    def _toward(self, view: View, block: slice) -> Array:
        """Return vectors from some points toward the eye."""
        if view.parallel:
            return np.broadcast_to(np.asarray(view.direction), self.away[block].shape)
        return np.asarray(view.position) - np.asarray(self._points[block], dtype=np.float64)

    def lean(self, normals: Array) -> Array:
        """Return how far the normal of each point may lean away from the eye; see Sided."""
        n = len(normals)
        bends, least = np.zeros((3, n)), np.ones(n)
        for _, rows, across in self._parts():
            faces = unit_rows(across)
            middle = np.asarray(sum(self.away[rows[:, i]] for i in range(3))) / 3
            for i, bend in enumerate(bends):
                at = rows[:, i]
                own = normals[at].astype(np.float64)
                with np.errstate(invalid="ignore"):
                    np.minimum.at(least, at, _dots(own, faces))
                np.add.at(bend, at, _dots(own, middle - self.away[at]))
        bend = bends[0] + bends[1] + bends[2]
        del bends
        sine = np.sqrt(np.clip(1 - least * least, 0, MOST_LEAN * MOST_LEAN))
        found: Array = np.where(np.isfinite(bend), -np.sign(bend) * sine, 0)
        return found.astype(np.float32)

    def sharp(self) -> float:
        """Return the share of sharp edges where these are creases, else 0.

        Creases stand apart: few edges are nearly as sharp. On a coarse mesh of a smooth shape there
        are more of those, and no edge is meant to be seen. Faces without area, which many meshes
        have at a pole, have no direction and no sharp edges.
        """
        faces, full = np.empty((len(self.triangles), 3)), np.zeros(len(self.triangles), np.bool_)
        for numbers, rows, across in self._parts():
            corners = self.away[rows] / self.scale
            sides = corners - np.roll(corners, -1, axis=1)
            longest = np.einsum("ijk,ijk->ij", sides, sides).max(axis=1, initial=0.0)
            full[numbers] = np.linalg.norm(across, axis=1) > NARROWEST * longest
            faces[numbers] = unit_rows(across)
        least = np.cos(np.radians([2 * SHARP, SHARP, SHARP / 2]))
        pairs, counts = 0, np.zeros(3, dtype=np.intp)
        for keys, edges in _edges(self.triangles, len(self.away)):
            there = full[edges // 3]
            keys, edges = keys[there], edges[there]
            order = np.argsort(keys, kind="stable")
            keys, face = keys[order], edges[order] // 3
            twice = np.flatnonzero(keys[1:] == keys[:-1])
            pairs += len(twice)
            for block in _pool.blocks(len(twice), BLOCK):
                cosine = _dots(faces[face[twice[block]]], faces[face[twice[block] + 1]])
                counts += [int(np.count_nonzero(cosine < limit)) for limit in least]
        if not pairs:
            return 0.0
        beyond, share, nearly = (float(count / pairs) for count in counts)
        apart = beyond >= MANY_SHARP and share - beyond <= CORNERS_APART * beyond
        return share if apart or nearly - share <= STAND_APART * share else 0.0


def _edges(
    triangles: Indices, count: int, same: Indices | None = None
) -> Iterator[tuple[Indices, Indices]]:
    """Yield numbers of some edges of triangles, and their places among the corners.

    An edge that several triangles have is yielded with all of them at once; edges of no length are
    left out. ``same`` has the point that stands for each of the ``count`` points.
    """
    parts = -(-3 * len(triangles) // EDGES)
    for part in range(parts):
        # Edges whose lower point is in a range.
        low, high = part * count // parts, (part + 1) * count // parts
        keys, places = [], []
        for block in _pool.blocks(len(triangles), BLOCK):
            rows = triangles[block] if same is None else same[triangles[block]]
            if parts > 1 and not (rows.min() < high and rows.max() >= low):
                continue
            a, b = rows.ravel(), rows[:, [1, 2, 0]].ravel()
            lower = np.minimum(a, b)
            own = np.flatnonzero((lower >= low) & (lower < high) & (a != b))
            keys.append(lower[own].astype(np.int64) * count + np.maximum(a, b)[own])
            places.append(own + 3 * block.start)
        if keys:
            yield np.concatenate(keys), np.concatenate(places)


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def onlooker(scene: Scene) -> View | None:
    """Return the view that an open surface faces: the scene's, or one from its first light."""
    if scene.view is not None:
        return scene.view
    light = next((light for light in scene.lights if not light.follows_view), None)
    if light is None:
        return None
    return View(position=light.position, direction=light.direction)


def piece_numbers(mesh: pv.DataSet) -> Indices:
    """Return for each point the number of its connected piece; 0 where it is on no surface."""
    numbers = np.zeros(mesh.n_points, dtype=np.intp)
    surface, origin = _skin(mesh)
    if surface is not None:
        own = np.arange(mesh.n_points) if origin is None else origin
        numbers[own[own >= 0]] = _pieces(surface).piece[own >= 0]
    return numbers


class _Pieces(NamedTuple):
    same: Indices
    piece: Indices


def _pieces(surface: pv.PolyData) -> _Pieces:
    """Return for each point the first of those at its place, and the number of its piece."""
    points = np.asarray(surface.points)
    n = len(points)
    order = np.lexsort(points.T)
    new = np.ones(n, dtype=np.bool_)
    for block in _pool.blocks(max(n - 1, 0), BLOCK):
        place = points[order[block.start : block.stop + 1]]
        new[block.start + 1 : block.stop + 1] = np.any(place[1:] != place[:-1], axis=1)
    first = np.where(new, np.arange(n), 0)
    np.maximum.accumulate(first, out=first)
    same = np.empty(n, dtype=np.intp)
    same[order] = order[first]
    del order, first
    piece = np.arange(n, dtype=np.int32 if n < 2**31 else np.int64)
    for ids, ends in _faces(surface):
        last = np.zeros(len(ids), dtype=np.bool_)
        last[ends - 1] = True
        for block in _pool.blocks(len(ids), EDGES):
            follows = np.flatnonzero(~last[block]) + block.start
            a, b = piece[same[ids[follows]]], piece[same[ids[follows + 1]]]
            # Edges between points of two pieces make one of them.
            graph = coo_array(
                (np.ones(len(a), np.float32), (a, b)), shape=(int(piece.max(initial=-1)) + 1,) * 2
            )
            piece = connected_components(graph, directed=False)[1][piece]
    return _Pieces(same, np.asarray(piece[same], dtype=np.intp))


def _faces(surface: pv.PolyData) -> Iterator[tuple[Indices, Indices]]:
    """Yield the corners of all polygons, of all strips, and the end of each face in them."""
    for cells in (surface.GetPolys(), surface.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False)
        if len(ids):
            yield ids, pv.convert_array(cells.GetOffsetsArray())[1:]


def _used(surface: pv.PolyData) -> Bools:
    """Return whether each point is a corner of a face."""
    used = np.zeros(surface.n_points, dtype=np.bool_)
    for ids, _ in _faces(surface):
        used[ids] = True
    return used


def split_where_computed(mesh: SurfaceT, angle: FeatureAngle) -> SurfaceT | pv.PolyData:
    """Return a surface with points split at its sharp edges, if its normals will be computed.

    Anything but a surface, and one with active normals, is returned as it is; see
    :func:`split_edges`.
    """
    if angle is None or not isinstance(mesh, pv.PolyData):
        return mesh
    return mesh if mesh.point_data.active_normals is not None else split_edges(mesh, angle)


def split_edges(mesh: pv.PolyData, angle: float | Literal["auto"]) -> pv.PolyData:
    """Return a surface with points split where faces meet at more than an angle in degrees.

    ``"auto"`` is 30 degrees on a surface whose sharp edges are creases. All arrays go with the
    points; the mesh itself is not changed.
    """
    if not has_faces(mesh) or not mesh.n_points:
        return mesh
    if angle == "auto":
        if not (_kept(mesh) or computed_normals(mesh)).sharp:
            return mesh
        angle = SHARP
    own = mesh.copy(deep=False)
    if "Normals" in own.point_data:
        own.point_data[_OWN] = own.point_data.pop("Normals")
    found: pv.PolyData = own.compute_normals(
        cell_normals=False,
        split_vertices=True,
        feature_angle=angle,
        consistent_normals=True,
        auto_orient_normals=False,
        non_manifold_traversal=False,
    )
    if found.n_points == mesh.n_points:
        return mesh
    del found.point_data["Normals"]
    if _OWN in found.point_data:
        found.point_data["Normals"] = found.point_data.pop(_OWN)
        found.point_data.active_normals_name = None
    records.carry(mesh, found)
    return found


def fingerprint(mesh: pv.DataSet) -> str | None:
    """Return a digest of the points and cells of a mesh, None for a kind that keeps no normals."""
    if isinstance(mesh, pv.PolyData):
        cells = [mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips()]
    elif isinstance(mesh, pv.UnstructuredGrid):
        cells = [mesh.GetCells()]
    else:
        return None
    digest = hashlib.sha256()
    arrays = [np.asarray(mesh.points)]
    for cell in cells:
        arrays += [
            np.asarray(pv.convert_array(cell.GetConnectivityArray())),
            np.asarray(pv.convert_array(cell.GetOffsetsArray())),
        ]
    for array in arrays:
        digest.update(f"{array.dtype}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()


def keep(mesh: pv.DataSet, normals: Sided) -> None:
    """Attach normals that were computed to a mesh, with a digest of what they were computed from.

    Where the user has an array of that name nothing is attached.
    """
    if not normals.computed or normals.kept or normals.lean is None or not mesh.n_points:
        return
    if KEPT in mesh.point_data and KEPT not in records.made(mesh, KEPT):
        return
    source = fingerprint(mesh)
    if source is None:
        return
    rows = np.empty((mesh.n_points, 5), dtype=np.float32)
    rows[:, :3], rows[:, 3], rows[:, 4] = normals.vectors, normals.lean, normals.open
    point_arrays.attach_rows(mesh, KEPT, rows)
    record: records.Record = {
        "vizlight": __version__, "filter": "normals", "source": source, "sharp": normals.sharp,
        "inside": normals.inside,
    }  # fmt: skip
    records.write(mesh, KEPT, record, [KEPT])


def _kept(mesh: pv.DataSet) -> Sided | None:
    """Return the normals that an earlier result kept, if the mesh has not changed since."""
    record = records.read(mesh, KEPT) if KEPT in mesh.point_data else None
    if record is None or KEPT not in records.made(mesh, KEPT):
        return None
    rows = np.asarray(mesh.point_data[KEPT])
    if rows.shape != (mesh.n_points, 5) or rows.dtype != np.float32:
        return None
    if record.get("source") != fingerprint(mesh):
        return None
    return Sided(
        np.ascontiguousarray(rows[:, :3]),
        rows[:, 3],
        rows[:, 4] > 0,
        records.share(record, "sharp"),
        kept=True,
        computed=True,
        inside=records.count(record, "inside", mesh.n_points),
    )
