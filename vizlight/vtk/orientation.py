"""Sides of the pieces of a surface: outside and inside, and how far normals lean from faces."""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from vizlight import _pool
from vizlight._types import Array, Bools, Indices, Raw, Slice
from vizlight.model import kernels
from vizlight.scene import View
from vizlight.vtk.cells import columns_at, connectivity, faces, finite_points, places, triangles
from vizlight.vtk.corners import SHARP, Slivers, slivers_of
from vizlight.vtk.topology import BLOCK, SortedEdges, ends_of, sorted_edges, topology

#: A piece counts as nearly closed if the sum of the area vectors of its faces is shorter than this
#: share of its area.
NEARLY_CLOSED = 0.2
#: Least height of a triangle that has a direction, as a share of its longest side.
NARROWEST = 1e-5
#: Number of corners of a triangle.
CORNERS = 3
#: Number of triangles that are worked on at once, such that their corners fit in the cache.
FEW = 1 << 14
#: Most that a normal may lean, as a sine, but on height fields. Where faces around a point differ
#: by more, its surface is too rough or too coarse to tell bumps from hollows: of the pixels of a
#: noisy isosurface, lit from the side, 26 % are off by more than a tenth of white without the
#: limit, and 6 % with it.
MOST_LEAN = 0.05
#: Number of normals, and of steps, by which the direction of a height field is searched for.
SEARCHED, STEPS = 1 << 14, 32


class Sums(NamedTuple):
    """Sums over each piece of a surface, which tell its sides; sums of parts add up.

    ``score`` sums the agreement of the normals with the directions of a sheet, ``total`` and
    ``area`` the area vectors of the faces, and their lengths; ``volume`` is the enclosed one, times
    6.
    """

    score: Array
    total: Array
    area: Array
    volume: Array

    @classmethod
    def zero(cls, count: int) -> Sums:
        """Return the sums over no faces."""
        return cls(np.zeros(count), np.zeros((count, 3)), np.zeros(count), np.zeros(count))

    def add(self, owner: Indices, corner: Array, across: Array, size: Array) -> None:
        """Add some faces.

        ``owner`` is the piece of each, ``corner`` and ``across`` (3, n) are a corner and the area
        vector, of the length ``size``.
        """
        # Six times the volumes of tetrahedra about the centroid: those of a closed surface add up
        # to what it encloses, by the divergence theorem.
        values = [kernels.dot(across, corner), size, *across]
        for into, value in zip([self.volume, self.area, *self.total.T], values, strict=True):
            into += value.sum() if len(into) == 1 else np.bincount(owner, value, len(into))

    def turned(self, border: Bools) -> Bools:
        """Return the pieces with normals that point inward, or away from the eye.

        For a sheet or a bowl the sign of a sum over its points decides, of three times the cosine
        between N and the direction toward the eye plus the cosine between N and the direction away
        from the centroid of the piece. Points that are not finite are ignored. For other pieces
        the sign of the enclosed volume decides.
        """
        return np.where(self.around(border), self.volume < 0, self.score < 0)

    def around(self, border: Bools) -> Bools:
        """Return the pieces that are closed or nearly closed: their area vectors almost cancel."""
        across = np.linalg.norm(self.total, axis=1)
        is_around: Bools = ~border | (across < NEARLY_CLOSED * self.area)
        return is_around


class SurfaceShape:
    """The triangles of a surface, its connected pieces, and which of those have a border.

    Coincident points are connected, so that triangles that share no point can form one piece.
    ``block`` is the number of the block of each point, where several are worked on at once: these
    have no piece in common.
    """

    def __init__(
        self,
        surface: vtkPolyData,
        side: NDArray[np.int8] | None = None,
        block: Indices | None = None,
    ) -> None:
        #: Of a part of a surface: 0 for its own points, 1 for points of the next part, -1 for
        #: points of the one before. Cells belong to the part in which they begin.
        self.side = side
        self.block = block
        self.points = places(surface)
        self.finite = finite_points(self.points)
        self.triangles = triangles(surface)
        #: Number of edges of two faces, and of sharp ones by three limits; a row for each block.
        self.edges = np.zeros(4, dtype=np.intp)
        if block is not None:
            self.edges = np.zeros((int(block.max(initial=-1)) + 1, 4), dtype=np.intp)
        #: Whether faces may be there twice: these are folded upon each other.
        self.doubtful = False
        self._find_directions()
        self._find_pieces(surface)

    def _find_pieces(self, surface: vtkPolyData) -> None:
        """Find the connected pieces."""
        is_inner = None if self.side is None else self.side == 0
        pieces = topology(self.triangles, self.points, is_inner, self._count, self.block)
        self.piece, self.open, self.alike, folded, self.same = pieces
        # A polygon and a strip have two triangles less than corners.
        self.triangular = (
            not surface.GetNumberOfStrips() and surface.GetPolys().IsHomogeneous() == CORNERS
        )
        if not self.triangular and len(self.triangles) != sum(
            len(ids) - 2 * len(ends) for ids, ends in faces(surface)
        ):
            # A polygon that cannot be split is wound in a way that is not known.
            self.alike = False
        self.count = len(self.open)
        self._note_folded(folded)

    def rewind(self, surface: vtkPolyData) -> None:
        """Take the faces of a surface at the same points that are wound in another way."""
        self.triangles = triangles(surface)
        self._find_directions()
        edges = sorted_edges(self.triangles, len(self.points), self.same)
        self._note_folded([part.folded() for part in edges])

    def join(self, first: Indices) -> None:
        """Let the faces around points that are joined meet at the first of them."""
        self.triangles = first[self.triangles]
        self._find_directions()

    def _note_folded(self, folded: list[Indices]) -> None:
        """Note the pieces with faces that have no common side, as in a Klein bottle, and where."""
        self.inside_out = np.zeros(self.count, dtype=np.bool_)
        self.seam = np.zeros(len(self.points), dtype=np.bool_)
        for ends in folded:
            self.inside_out[self.piece[ends]] = True
            self.seam[ends] = True
        if self.same is not None:
            self.seam = self.seam[self.same]

    def _find_directions(self) -> None:
        """Find the directions of the triangles, and which of them have one."""
        self._unit = np.zeros((3, len(self.triangles)), dtype=np.float32)
        self._full = np.zeros(len(self.triangles), dtype=np.bool_)
        #: Short sides of the triangles.
        self.slivers: list[Slivers] = []
        for block in _pool.blocks(len(self.triangles), FEW):
            rows = self.triangles[block]
            self._unit[:, block], self._full[block], squares = _directions(self.points, rows)
            with np.errstate(all="ignore"):
                self.slivers.append(slivers_of(rows, squares))

    def _count(self, edges: SortedEdges) -> None:
        """Count edges of two faces, and sharp ones.

        Faces without area, which many meshes have at a pole, have no direction and no sharp edges.
        """
        first = np.flatnonzero(edges.keys[1:] == edges.keys[:-1])
        if self.side is not None:
            lower, upper = ends_of(edges.keys[first])
            first = first[np.minimum(self.side[lower], self.side[upper]) == 0]
        # The limits of corners, of sharp edges and of nearly sharp ones; 2.0 below counts all
        # edges.
        least = np.cos(np.radians([2 * SHARP, SHARP, SHARP / 2]))
        # Edges of three faces.
        self.doubtful |= bool(np.any(first[1:] == first[:-1] + 1))
        for block in _pool.blocks(len(first), BLOCK):
            at = first[block]
            # Corners are numbered triangle by triangle.
            this, other = edges.places[at] // 3, edges.places[at + 1] // 3
            full = self._full[this] & self._full[other]
            # Faces that are wound alike run along their common edge against each other.
            against = edges.forward[at] != edges.forward[at + 1]
            cosine = kernels.dot(self._unit.take(this, axis=1), self._unit.take(other, axis=1))
            cosine = np.where(against, cosine, -cosine)
            kinds = [full & (cosine < beyond) for beyond in (2.0, *least)]
            counts = [np.count_nonzero(kind) for kind in kinds]
            self.doubtful |= bool(counts[0] < len(full) or counts[1])
            if self.block is None:
                self.edges += counts
                continue
            of = self.block[self.triangles[this, 0]]
            for i, kind in enumerate(kinds):
                self.edges[:, i] += np.bincount(of[kind], minlength=len(self.edges))

    @functools.cached_property
    def frame(self) -> tuple[Array, float]:
        """The centroid of each piece, shape (3, n_pieces), and the size of the mesh about them."""
        piece = self.piece
        size = np.maximum(np.bincount(piece, self.finite, self.count), 1)
        middle = np.empty((3, self.count))
        for row, axis in zip(middle, self.points.T, strict=True):
            finite = np.where(self.finite, axis, 0).astype(np.float64)
            row[:] = np.bincount(piece, finite, self.count) / size
        largest = 0.0
        for block in _pool.blocks(len(self.points), BLOCK):
            largest = max(largest, float(np.abs(self._from_middle(block, middle)).max()))
        # Lengths are scaled, because products of tiny ones underflow and of huge ones overflow; by
        # a power of two, which rounds nothing.
        scalable = 0 < largest < np.inf
        return middle, math.ldexp(0.5, math.frexp(largest)[1]) if scalable else largest or 1.0

    def _from_middle(self, rows: Slice, middle: Array) -> Array:
        """Return the ways from the centroids of the pieces to some points."""
        points = self.points[rows]
        if not self.all_finite:
            points = np.where(self.finite[rows, np.newaxis], points, 0)
        away = np.array(points.T, dtype=np.float64, order="C")
        away -= middle[:, self.piece[rows]] if self.count > 1 else middle
        return away

    @functools.cached_property
    def all_finite(self) -> bool:
        """Whether all points are finite."""
        return bool(self.finite.all())

    def survey(self, normals: Array) -> tuple[Sums, Array]:
        """Return the sums of a walk over the triangles, given the normals of the points.

        The score is left 0. The second result is the sine of the largest angle between the normal
        of each point and a face around it, 1 from a right angle on; negative where the surface is
        concave.
        """
        piece, n = self.piece, len(self.points)
        sums = Sums.zero(self.count)
        bend, least = np.zeros(n), np.ones(n, dtype=np.float32)
        middle, largest = self.frame
        for block in _pool.blocks(len(self.triangles), FEW):
            rows: Indices = self.triangles[block]
            narrow = ~self._full[block]
            if not self.all_finite:
                finite = self.finite[rows].all(axis=1)
                rows, narrow = rows[finite], narrow[finite]
            corners = [np.ascontiguousarray(at) for at in rows.T]
            a, b, c = (columns_at(self.points, at) for at in corners)
            u, v = b - a, c - a
            u /= largest
            v /= largest
            across = kernels.cross(u, v)
            unit, size = kernels.unit(across)
            inner = slice(None)
            if self.side is not None:
                inner = self.side[rows].min(axis=1) == 0
            owner = piece[corners[0][inner]]
            corner = a[:, inner] - (middle.take(owner, axis=1) if self.count > 1 else middle)
            sums.add(owner, corner / largest, across[:, inner], size[inner])
            # Three times the way from each corner to the centre of its triangle.
            for at, inward in zip(corners, (u + v, v - 2 * u, u - 2 * v), strict=True):
                normal = columns_at(normals, at)
                with np.errstate(invalid="ignore"):
                    # The direction of a sliver is rounding, which must not count as a face that is
                    # averted.
                    cosine = kernels.dot(normal, unit)
                    cosine[narrow] = 1.0
                    np.minimum.at(least, at, cosine.astype(np.float32))
                np.add.at(bend, at, kernels.dot(normal, inward))
        # The lean takes the place of the least cosines.
        for block in _pool.blocks(n, BLOCK):
            near = least[block]
            sine = np.where(near > 0, np.sqrt(np.clip(1 - near * near, 0, 1)), 1)
            bent = bend[block]
            # Where the surroundings of a point lie above its tangent plane the surface is concave.
            least[block] = np.where(np.isfinite(bent), np.copysign(sine, -bent), 0)
        return sums, least

    def orient(self, normals: Array, sums: Sums, lean: Array, view: View | None) -> None:
        """Flip normals, with their lean, of pieces where they point inward or away from the eye."""
        if not sums.around(self.open).all():
            sums = sums._replace(score=self.score(normals, view))
        self.turn(sums.turned(self.open), normals, lean)

    def turn(self, turned: Bools, normals: Array, lean: Array) -> None:
        """Flip the normals of some pieces, with their lean."""
        if not turned.any():
            return
        for block in _pool.blocks(len(normals), BLOCK):
            flipped = turned[self.piece[block]] if len(turned) > 1 else slice(None)
            normals[block][flipped] *= -1
            lean[block][flipped] *= -1

    def score(self, normals: Array, view: View | None) -> Array:
        """Return how far the normals of each piece agree with the directions of a sheet."""
        scores = np.zeros(self.count)
        middle, largest = self.frame
        seen = view is not None and len(view.position or view.direction or ()) == 3
        for block in _pool.blocks(len(normals), BLOCK):
            columns = normals[block].T.astype(np.float64)
            toward = kernels.unit(self._from_middle(block, middle) / largest)[0]
            if seen and view is not None:
                toward += 3 * kernels.unit(toward_eye(view, self.points[block]))[0]
            score = kernels.dot(columns, toward)
            good = self.finite[block] & np.isfinite(score)
            if self.side is not None:
                good &= self.side[block] == 0
            scores += np.bincount(self.piece[block][good], score[good], self.count)
        return scores


def _directions(points: Raw, triangles: Indices) -> tuple[Array, Bools, list[Array]]:
    """Return the directions of triangles, which of them have one, and the squares of their sides.

    The first is of shape (3, n); squares are those of the sides that end at each corner.
    """
    a, b, c = (columns_at(points, at) for at in triangles.T)
    sides = a - c, b - a, c - b
    with np.errstate(all="ignore"):
        unit, size = kernels.unit(kernels.cross(sides[1], c - a))
        squares = [kernels.dot(side, side) for side in sides]
        return unit, size > NARROWEST * functools.reduce(np.maximum, squares), squares


def lean_of(surface: vtkPolyData, normals: Array) -> Array:
    """Return the sine of the largest angle between normals and the faces around each point.

    Faces may be wound in any way, and normals be of any length and of either side. The sine is 1
    from a right angle on, and where neighbouring faces are wound against each other; 0 where a
    normal is not finite.
    """
    rows, points = triangles(surface), places(surface)
    # Row by row in memory, of which single rows are taken below.
    vectors = np.ascontiguousarray(kernels.unit_rows(normals))
    least = np.ones(len(points), dtype=np.float32)
    along, against = np.zeros((2, len(points)), dtype=np.bool_)
    for block in _pool.blocks(len(rows), FEW):
        unit, is_full, _ = _directions(points, rows[block])
        for at in rows[block].T:
            normal = columns_at(vectors, at)
            # The direction of a sliver is rounding.
            corner, cosine = at[is_full], kernels.dot(normal, unit)[is_full]
            np.minimum.at(least, corner, np.abs(cosine).astype(np.float32))
            along[corner[cosine > 0]] = True
            against[corner[cosine < 0]] = True
    sine: Array = np.sqrt(np.clip(1 - least * least, 0, 1))
    sine[along & against] = 1
    sine[~np.isfinite(normals).all(axis=1)] = 0
    # It may be kept for others.
    sine.setflags(write=False)
    return sine


def normal_of_map(surface: vtkPolyData) -> Array | None:
    """Return the normal of convex faces in a plane across an axis that are all wound alike.

    Such a surface has no edge, no side of its own and no folds, for which others are searched; None
    for these.
    """
    polys, points = surface.GetPolys(), places(surface)
    size = polys.IsHomogeneous()
    if size < CORNERS or surface.GetNumberOfStrips():
        return None
    axes = [0, 1, 2]
    # Few points tell of most surfaces that they lie in no such plane.
    for rows in (points[:FEW], points):
        axes = [i for i in axes if (rows[:, i] == rows[0, i]).all()]
    if len(axes) != 1:
        return None
    across, up = (points[:, (axes[0] + i) % 3].astype(np.float64) for i in (1, 2))
    corners = connectivity(polys)[0].reshape(-1, size)
    turns_left = turns_right = True
    for block in _pool.blocks(len(corners), FEW):
        ends = [np.ascontiguousarray(at) for at in corners[block].T]
        x, y = ([axis.take(at) for at in ends] for axis in (across, up))
        for i in range(size):
            # The side behind a corner and the one ahead.
            turn = (x[i] - x[i - 1]) * (y[i + 1 - size] - y[i])
            turn -= (y[i] - y[i - 1]) * (x[i + 1 - size] - x[i])
            turns_left &= bool((turn > 0).all())
            turns_right &= bool((turn < 0).all())
        if not (turns_left or turns_right):
            return None
    normal = np.zeros(3)
    normal[axes[0]] = 1.0 if turns_left else -1.0
    return normal


def toward_eye(view: View, points: Raw) -> Array:
    """Return vectors from points toward an eye as columns; a single one where all are alike."""
    if view.parallel:
        return np.array(view.direction, dtype=np.float64)[:, np.newaxis]
    eye = np.array(view.position, dtype=np.float64)[:, np.newaxis]
    return np.asarray(eye - np.asarray(points).T.astype(np.float64))


class PartShape(SurfaceShape):
    """The triangles of a part of a surface of one piece, with known centroid and size."""

    def __init__(
        self, surface: vtkPolyData, side: NDArray[np.int8], middle: Array, scale: float
    ) -> None:
        super().__init__(surface, side)
        self.frame = middle[:, np.newaxis], scale

    def _find_pieces(self, surface: vtkPolyData) -> None:  # noqa: ARG002
        self.piece, self.count = np.zeros(len(self.points), dtype=np.intp), 1
        for edges in sorted_edges(self.triangles, len(self.points)):
            self._count(edges)


def sides_of(
    vectors: Array, piece: Indices | None, border: Bools, total: Array | None = None
) -> Indices:
    """Return which pieces have a border, and which of these are height fields.

    Normals are zero or not finite where a point has none, ``piece`` is None for a single one,
    ``border`` masks pieces that may be seen from either side, and ``total`` is the sum of all
    normals of each piece, where these are some. The result is 0 for pieces without a border, 1 for
    those with one, and from 2 on a number of its own for each that is a height field: its normals
    lie within a right angle of an axis, or of a direction that a short search finds.
    """
    side: Indices = border.astype(np.intp)
    if border.any():
        # Along the mean direction and the three axes: the least component, and the least of the
        # opposite.
        low, high = np.full((2, 4, len(border)), np.inf)
        middle = middles(vectors, piece, border, total)
        for block in _pool.blocks(len(vectors), BLOCK):
            rows, of = _normals_of(vectors, piece, block, border)
            if not len(rows):
                continue
            toward = middle[of] if len(middle) > 1 else middle
            for i, along in enumerate((np.einsum("ij,ij->i", rows, toward), *rows.T)):
                if len(middle) == 1:
                    low[i] = min(low[i, 0], along.min())
                    high[i] = min(high[i, 0], -along.max())
                    continue
                np.minimum.at(low[i], of, along)
                np.minimum.at(high[i], of, -along)
        fields = ((low > 0) | (high > 0)).any(axis=0) & np.isfinite(low[0])
        side[fields] = 2 + np.arange(np.count_nonzero(fields))
    return side


def _normals_of(
    vectors: Array, piece: Indices | None, rows: Slice, border: Bools
) -> tuple[Array, Indices]:
    """Return the normals of some points of the pieces with a border, and their pieces."""
    normals = vectors[rows]
    of = np.zeros(len(normals), dtype=np.intp) if piece is None else piece[rows]
    x, y, z = normals.T
    has = (x != 0) | (y != 0) | (z != 0)
    if not np.isfinite(normals).all():
        has &= np.isfinite(normals).all(axis=1)
    if not border.all():
        has &= border[of]
    if not has.all():
        normals, of = normals[has], of[has]
    return normals.astype(np.float64), of


def middles(
    vectors: Array, piece: Indices | None, border: Bools, total: Array | None = None
) -> Array:
    """Return for each piece a direction, within a right angle of all its normals if one is found.

    It begins at their mean, along ``total`` where that is known; some of the vectors that are
    furthest from it draw it to them.
    """
    is_summed = total is not None
    total = np.zeros((len(border), 3)) if total is None else total
    for block in () if is_summed else _pool.blocks(len(vectors), BLOCK):
        rows, of = _normals_of(vectors, piece, block, border)
        if len(border) == 1:
            total += rows.sum(axis=0)
        else:
            total += np.stack([np.bincount(of, axis, len(border)) for axis in rows.T], axis=1)
    middle = kernels.unit_rows(total)
    some = slice(None, None, max(len(vectors) // SEARCHED, 1))
    rows, of = _normals_of(vectors, piece, some, border)
    for _ in range(STEPS):
        along = np.einsum("ij,ij->i", rows, middle[of])
        least = np.zeros(len(border))
        np.minimum.at(least, of, along)
        beyond = (along <= least[of]) & (along <= 0)
        if not beyond.any():
            break
        # The step of a perceptron: what is furthest beyond a right angle draws the direction to it.
        np.add.at(middle, of[beyond], rows[beyond])
    return middle
