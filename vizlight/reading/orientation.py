"""Triangles of a surface: connected pieces, their sides, and edges that are sharp."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import scipy

from vizlight import _pool
from vizlight.model import kernels
from vizlight.reading.cells import faces, places, triangles

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from vizlight._types import Array, Bools, Indices
    from vizlight.scene import View

#: A piece counts as nearly closed if the sum of the area vectors of its faces is shorter than this
#: share of its area.
NEARLY_CLOSED = 0.2
#: Angle in degrees between the normals of two faces above which their common edge is sharp.
SHARP = 30.0
#: Least height of a triangle that has a direction, as a share of its longest side.
NARROWEST = 1e-5
#: Share of sharp edges, of all edges of a mesh, from which a warning names the remedy.
MANY_SHARP = 0.02
#: Sharp edges are creases if at most this many times as many edges are half as sharp or more.
STAND_APART = 0.5
#: They also are if of those above twice the angle, at least MANY_SHARP of all edges, there are more
#: than of those between by this factor: corners stand apart from coarse arcs.
CORNERS_APART = 0.7
#: Most that a normal may lean, as a sine. Where faces around a point differ by more, its surface is
#: too rough or too coarse to tell bumps from hollows: of the pixels of a noisy isosurface, lit from
#: the side, 26 % are off by more than a tenth of white without the limit, and 6 % with it.
MOST_LEAN = 0.05
#: Number of points or triangles that are worked on at once, least one of edges, and largest number
#: of parts of these.
BLOCK, EDGES, PARTS = 1 << 16, 1 << 19, 16
#: Number of triangles up to which their area vectors stay in memory.
FEW = 1 << 18


class Owners:
    """Which mesh of a batch each point of a surface belongs to; of one mesh all do.

    Parameters
    ----------
    starts : ndarray of int, or None
        First point of each mesh of a batch, followed by the number of points.
    origin : ndarray of int, or None
        Point of the batch that each point of the surface is.
    """

    def __init__(self, starts: Indices | None = None, origin: Indices | None = None) -> None:
        self.count = 1 if starts is None else len(starts) - 1
        self.of: Indices | None = None
        if starts is not None:
            self.of = np.repeat(np.arange(self.count), np.diff(starts))
            self.of = self.of if origin is None else self.of[origin]

    def counts(self, points: Indices) -> Indices:
        """Return how many of some points belong to each mesh."""
        if self.of is None:
            return np.array([len(points)])
        return np.bincount(self.of[points], minlength=self.count)


class Sums(NamedTuple):
    """Sums over each piece of a surface, which tell its sides; those of parts add up.

    Attributes
    ----------
    score : ndarray, shape (count,)
        Sum of the agreement of the normals with the directions of a sheet.
    total, area : ndarray, shape (count, 3) and (count,)
        Area vectors of the faces, and their lengths.
    volume : ndarray, shape (count,)
        Six times the enclosed volume.
    """

    score: Array
    total: Array
    area: Array
    volume: Array

    def turned(self, border: Bools) -> Bools:
        """Return the pieces whose normals point inward, or away from the eye.

        A piece is nearly closed if the area vectors of its faces almost cancel; then the sign of
        the enclosed volume decides. For a sheet or a bowl the sign of a sum over its points
        decides, of three times the cosine between N and the direction toward the eye plus the
        cosine between N and the direction away from the centroid of the piece. Points that are
        not finite are ignored.
        """
        around = ~border | (np.linalg.norm(self.total, axis=1) < NEARLY_CLOSED * self.area)
        return np.where(around, self.volume < 0, self.score < 0)


class Shape:
    """The triangles of a surface, its connected pieces, and which of those have a border.

    Coincident points are connected, so that triangles that share no point can form one piece.
    What belongs to triangles is computed block by block, where it is needed.
    """

    #: Of a part of a surface: 0 for its own points, 1 for those of the next part, -1 for those of
    #: the one before. Cells belong to the part in which they begin.
    _side: NDArray[np.int8] | None = None
    #: What belongs to the triangles of a small surface.
    _few: list[tuple[Indices, Indices, Array]] | None = None

    def __init__(self, surface: vtkPolyData, owners: Owners) -> None:
        self.points = points = places(surface)
        self.finite: Bools = np.all(np.isfinite(points), axis=1)
        self.owners = owners
        same, self.piece = pieces(surface, owners)
        self.count = int(self.piece.max(initial=-1)) + 1
        self.triangles = triangles(surface)
        #: Whether each piece has an edge of one face only.
        self.open: Bools = np.zeros(self.count, dtype=np.bool_)
        for keys, _ in _edges(self.triangles, len(points), same):
            # Keys of neighbouring faces are in order, which other sorts do not use.
            keys.sort(kind="stable")
            single = np.ones(len(keys), dtype=np.bool_)
            repeats = keys[1:] == keys[:-1]
            single[1:] &= ~repeats
            single[:-1] &= ~repeats
            self.open[self.piece[(keys[single] // len(points)).astype(np.intp)]] = True
        del same
        self._measure()

    def _measure(self) -> None:
        """Place each piece about its centroid, at a size of 1."""
        size = np.maximum(np.bincount(self.piece, self.finite, self.count), 1)
        self.away: Array = np.where(self.finite[:, np.newaxis], self.points, 0).astype(np.float64)
        sums = [np.bincount(self.piece, axis, self.count) for axis in self.away.T]
        middle = np.stack(sums, axis=1) / size[:, np.newaxis]
        for block in _pool.blocks(len(self.away), BLOCK):
            self.away[block] -= middle[self.piece[block]]
        # Lengths are scaled, because products of tiny ones underflow and of huge ones overflow.
        if self.owners.of is None:
            scale = np.maximum(-self.away.min(initial=0.0), self.away.max(initial=0.0))
            self.away /= scale or 1.0
        else:
            scales = np.zeros(self.owners.count)
            np.maximum.at(scales, self.owners.of, np.abs(self.away).max(axis=1))
            scales[scales == 0] = 1.0
            self.away /= scales[self.owners.of][:, np.newaxis]

    def _parts(self, *, own: bool = False) -> Iterator[tuple[Indices, Indices, Array]]:
        """Yield the numbers, the corners and the area vectors of some finite triangles."""
        if self._side is not None or len(self.triangles) > FEW:
            yield from self._found(own=own)
            return
        if self._few is None:
            self._few = list(self._found(own=own))
        yield from self._few

    def _found(self, *, own: bool) -> Iterator[tuple[Indices, Indices, Array]]:
        """Yield what :meth:`_parts` does."""
        all_finite = bool(self.finite.all())
        for block in _pool.blocks(len(self.triangles), BLOCK):
            rows, numbers = self.triangles[block], np.arange(block.start, block.stop)
            if not all_finite or (own and self._side is not None):
                known = self.finite[rows].all(axis=1)
                if own and self._side is not None:
                    known &= self._side[rows].min(axis=1) == 0
                rows, numbers = rows[known], numbers[known]
            a, b, c = (self.away.take(rows[:, i], axis=0) for i in range(3))
            yield numbers, rows, np.cross(b - a, c - a)

    def sums(self, normals: Array, view: View | None) -> Sums:
        """Return what tells the sides of the pieces."""
        scores = self._scores(normals, view)
        score = np.asarray(np.bincount(self.piece, scores, self.count), dtype=np.float64)
        total, area, volume = np.zeros((self.count, 3)), np.zeros(self.count), np.zeros(self.count)
        for _, rows, across in self._parts(own=True):
            owner = self.piece[rows[:, 0]]
            np.add.at(volume, owner, _dots(across, self.away[rows[:, 0]]))
            for axis in range(3):
                np.add.at(total[:, axis], owner, across[:, axis])
            np.add.at(area, owner, np.sqrt(_dots(across, across)))
        return Sums(score, total, area, volume)

    def orient(self, normals: Array, lean: Array | None, view: View | None) -> None:
        """Flip normals, with their lean, of pieces where they point inward or away from the eye."""
        turned = self.sums(normals, view).turned(self.open)
        for block in _pool.blocks(len(normals), BLOCK):
            flipped = turned[self.piece[block]]
            normals[block][flipped] *= -1
            if lean is not None:
                lean[block][flipped] *= -1

    def _scores(self, normals: Array, view: View | None) -> Array:
        """Return how far the normal of each point agrees with the directions of a sheet."""
        scores = np.zeros(len(normals))
        seen = view is not None and len(view.position or view.direction or ()) == 3
        for block in _pool.blocks(len(normals), BLOCK):
            own, away = normals[block], self.away[block]
            score = _dots(own, kernels.unit_rows(away))
            if seen and view is not None:
                score += 3 * _dots(own, kernels.unit_rows(self._toward(view, block)))
            good = self.finite[block] & np.all(np.isfinite(own), axis=1)
            if self._side is not None:
                good &= self._side[block] == 0
            scores[block] = np.where(good, score, 0)
        return scores

    def _toward(self, view: View, block: slice) -> Array:
        """Return vectors from some points toward the eye."""
        if view.parallel:
            return np.broadcast_to(np.asarray(view.direction), self.away[block].shape)
        return np.asarray(view.position) - np.asarray(self.points[block], dtype=np.float64)

    def lean(self, normals: Array) -> Array:
        """Return how far the normal of each point may lean away from the eye; see Sided."""
        n = len(normals)
        bends, least = np.zeros((3, n)), np.ones(n)
        for _, rows, across in self._parts():
            faces = kernels.unit_rows(across)
            corners = [self.away.take(rows[:, i], axis=0) for i in range(3)]
            middle = (corners[0] + corners[1] + corners[2]) / 3
            for i, bend in enumerate(bends):
                at = rows[:, i]
                own = normals.take(at, axis=0).astype(np.float64)
                with np.errstate(invalid="ignore"):
                    np.minimum.at(least, at, _dots(own, faces))
                np.add.at(bend, at, _dots(own, middle - corners[i]))
        bend = bends[0] + bends[1] + bends[2]
        del bends
        sine = np.sqrt(np.clip(1 - least * least, 0, MOST_LEAN * MOST_LEAN))
        found: Array = np.where(np.isfinite(bend), -np.sign(bend) * sine, 0)
        return found.astype(np.float32)

    def edge_counts(self) -> Indices:
        """Return of each mesh the number of edges of two faces, and of sharp ones by three limits.

        Faces without area, which many meshes have at a pole, have no direction and no sharp edges.
        """
        faces = np.empty((len(self.triangles), 3), dtype=np.float32)
        full = np.zeros(len(self.triangles), dtype=np.bool_)
        for numbers, rows, across in self._parts():
            a, b, c = (self.away.take(rows[:, i], axis=0) for i in range(3))
            sides = [_dots(side, side) for side in (a - b, b - c, c - a)]
            longest = np.maximum(np.maximum(sides[0], sides[1]), sides[2])
            full[numbers] = np.sqrt(_dots(across, across)) > NARROWEST * longest
            faces[numbers] = kernels.unit_rows(across)
        least = np.cos(np.radians([2 * SHARP, SHARP, SHARP / 2]))
        counts = np.zeros((4, self.owners.count), dtype=np.intp)
        for keys, edges in _edges(self.triangles, len(self.away)):
            there = full[edges // 3]
            if self._side is not None:
                lower, upper = np.divmod(keys, len(self.away))
                there &= np.minimum(self._side[lower], self._side[upper]) == 0
            keys, edges = keys[there], edges[there]
            order = np.argsort(keys, kind="stable")
            keys, face = keys[order], edges[order] // 3
            twice = np.flatnonzero(keys[1:] == keys[:-1])
            for block in _pool.blocks(len(twice), BLOCK):
                one = face[twice[block]]
                cosine = _dots(faces[one], faces[face[twice[block] + 1]])
                corner = self.triangles[one, 0]
                counts[0] += self.owners.counts(corner)
                for count, limit in zip(counts[1:], least, strict=True):
                    count += self.owners.counts(corner[cosine < limit])
        return counts


class PartShape(Shape):
    """The triangles of a part of a surface of one piece, whose centroid and size are known."""

    def __init__(
        self, surface: vtkPolyData, side: NDArray[np.int8], middle: Array, scale: float
    ) -> None:
        self.points, self._side = places(surface), side
        self.finite = np.all(np.isfinite(self.points), axis=1)
        self.owners, self.count = Owners(), 1
        self.piece = np.zeros(len(self.points), dtype=np.intp)
        self.triangles = triangles(surface)
        self.away = np.where(self.finite[:, np.newaxis], self.points, 0).astype(np.float64)
        self.away -= middle
        self.away /= scale


def crease_share(counts: Indices) -> Array:
    """Return of each mesh the share of sharp edges where these are creases, else 0.

    Creases stand apart: few edges are nearly as sharp. On a coarse mesh of a smooth shape there
    are more of those, and no edge is meant to be seen. ``counts`` are those of
    :meth:`Shape.edge_counts`.
    """
    beyond, share, nearly = counts[1:] / np.maximum(counts[0], 1)
    apart = (beyond >= MANY_SHARP) & (share - beyond <= CORNERS_APART * beyond)
    return np.where(apart | (nearly - share <= STAND_APART * share), share, 0.0)


def _edges(
    triangles: Indices, count: int, same: Indices | None = None
) -> Iterator[tuple[Indices, Indices]]:
    """Yield numbers of some edges of triangles, and their places among the corners.

    An edge that several triangles have is yielded with all of them at once; edges of no length are
    left out. ``same`` has the point that stands for each of the ``count`` points.
    """
    parts = min(-(-3 * len(triangles) // EDGES), PARTS)
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


class Pieces(NamedTuple):
    """For each point the first of those at its place, and the number of its connected piece."""

    same: Indices
    piece: Indices


def pieces(surface: vtkPolyData, owners: Owners) -> Pieces:
    """Return the connected pieces of the points of a surface."""
    points = places(surface)
    n = len(points)
    order = np.lexsort((*points.T,) if owners.of is None else (*points.T, owners.of))
    new = np.ones(n, dtype=np.bool_)
    for block in _pool.blocks(max(n - 1, 0), BLOCK):
        rows = order[block.start : block.stop + 1]
        place = points[rows]
        own = new[block.start + 1 : block.stop + 1]
        own[:] = np.any(place[1:] != place[:-1], axis=1)
        if owners.of is not None:
            own |= owners.of[rows[1:]] != owners.of[rows[:-1]]
    first = np.where(new, np.arange(n), 0)
    np.maximum.accumulate(first, out=first)
    same = np.empty(n, dtype=np.intp)
    same[order] = order[first]
    del order, first
    piece = np.arange(n, dtype=np.int32 if n < 2**31 else np.int64)
    for ids, ends in faces(surface):
        last = np.zeros(len(ids), dtype=np.bool_)
        last[ends - 1] = True
        for block in _pool.blocks(len(ids), max(EDGES, -(-len(ids) // PARTS))):
            follows = np.flatnonzero(~last[block]) + block.start
            a, b = piece[same[ids[follows]]], piece[same[ids[follows + 1]]]
            # Edges between points of two pieces make one of them.
            graph = scipy.sparse.coo_array(
                (np.ones(len(a), np.float32), (a, b)), shape=(int(piece.max(initial=-1)) + 1,) * 2
            )
            piece = scipy.sparse.csgraph.connected_components(graph, directed=False)[1][piece]
    return Pieces(same, np.asarray(piece[same], dtype=np.intp))
