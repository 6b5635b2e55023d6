"""Light inside a bundle of lines: the lines as a medium of thin cylinders.

A line of diameter d takes from light of direction w the share ``d |w x t|`` per length of line and
area across w, and each of its free ends ``pi / 8 d^2 |w . t|``, half of the disc that closes it.
The share of the light that is left is the exponential of minus the sum on its way (Beer and
Lambert). The sum is taken on a grid in the light's own frame: each piece of a line is spread over
the 8 voxels around it, the voxels are summed along the light, and the sum is read at a point from
the 8 voxels around that. All lengths are in voxels.

Two corrections are made. A point of a line does not shade itself: the share of both halves of its
line in its depth follows from the hat functions of the voxels, from the place of the point in its
voxel, from the direction of each half and from the place where it ends, and so does that of its
free ends. And lines are spread at random within a voxel, so the mean of the exponential is above
the exponential of the mean, which a factor of the depth makes up for: it grows with the diameter of
a line and with its length across the light, both in voxels (:func:`crowding`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vizlight import _pool
from vizlight._types import Array, Bools, Indices, Slice, VectorLike
from vizlight.geometry import axial

#: Number of places that NumPy spreads at once.
AT_ONCE = 1 << 19
#: Place in a voxel of a line through the origin: there its hat functions have their mean over all
#: places, so that a single straight line adds to its own depth what is subtracted.
ASIDE = (1 - 1 / 3**0.5) / 2


def cut(middles: Array, vectors: Array, parts: Indices) -> tuple[Array, Array]:
    """Return pieces, given by columns, each cut to some parts of equal lengths."""
    owner = np.repeat(np.arange(len(parts)), parts)
    # Counts from 0 within each piece, so that parts of all pieces are made without a loop.
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = 1 / parts[owner]
    # Middles of the parts, in lengths of the piece from its middle: from -1/2 to 1/2.
    place = (number + 0.5) * share - 0.5
    vectors = np.take(vectors, owner, axis=1)
    return np.take(middles, owner, axis=1) + place * vectors, vectors * share


def box(rows: Array) -> tuple[Array, tuple[int, int, int]]:
    """Return the lower corner and the shape of a grid around places, with a margin of zeros."""
    if not rows.size:
        return np.zeros((3, 1), np.float32), (3, 3, 3)
    # An empty layer before all pieces and two behind: a place outside is clipped to one, where it
    # finds no line beside it, or the whole sum behind the last.
    low = np.floor(rows.min(axis=1, keepdims=True) + ASIDE) - np.float32(1 + ASIDE)
    i, j, k = (int(n) + 4 for n in (rows.max(axis=1) - low[:, 0]))
    return low, (i, j, k)


def _corners(cells: Array, shape: tuple[int, ...]) -> Iterator[tuple[Indices, Array]]:
    """Yield the flat index and the weight of each of the 8 corners around places in a grid."""
    low = np.floor(cells).astype(np.intp)
    high = cells - low
    base = (low[0] * shape[1] + low[1]) * shape[2] + low[2]
    # Trilinear: the weight of a corner is the product of three shares, one along each axis.
    weights = (1 - high, high)
    for a in (0, 1):
        for b in (0, 1):
            plane = weights[a][0] * weights[b][1]
            for c in (0, 1):
                yield base + (a * shape[1] + b) * shape[2] + c, plane * weights[c][2]


def spread(cells: Array, values: Array, shape: tuple[int, int, int], /) -> Array:
    """Return a grid to which values are added at places, each over the 8 voxels around it.

    ``cells`` (3, N) are places in units of voxels, from 0 to the shape less 2.
    """
    values = values.astype(np.float32, copy=False)
    size = shape[0] * shape[1] * shape[2]
    flat = np.zeros(size)
    for start in range(0, len(values), AT_ONCE):
        part = slice(start, start + AT_ONCE)
        indices, weights = zip(*_corners(cells[:, part], shape), strict=True)
        shares = np.concatenate(weights).reshape(8, -1) * values[part]
        # Unlike an indexed sum this adds all that falls on one voxel, and it does so in float64.
        flat += np.bincount(np.concatenate(indices), shares.reshape(-1), minlength=size)
    return flat.astype(np.float32).reshape(shape)


def read(grid: Array, cells: Array, /) -> Array:
    """Return the values of a grid at places, from the 8 voxels around each.

    ``cells`` (3, N) are places in units of voxels, from 0 to the shape less 2.
    """
    values = np.zeros(cells.shape[1], np.float32)
    flat = grid.reshape(-1)
    for index, weight in _corners(cells, grid.shape):
        values += weight * flat[index]
    return values


def summed(grid: Array) -> Array:
    """Replace each voxel by the sum of those before it and half of it; return the sum of all."""
    # A sum is read at the middle of a voxel, before which half of its own content lies.
    half = grid * np.float32(0.5)
    np.cumsum(grid, axis=2, dtype=np.float32, out=grid)
    # Before the halves are taken off: the last running sum covers the whole row.
    total = grid[:, :, -1].copy()
    grid -= half
    return total


#: Places along half a line from -1 to 1, and weights, by which its own depth is summed.
NODES = (*zip(*np.polynomial.legendre.leggauss(4), strict=True),)
#: Half of the area of a disc of diameter 1, and how far a half of a line may bend for its free end
#: to count as ahead, as a share of its length.
DISC, STRAIGHT = np.pi / 8, 0.05
#: Least side of a voxel in diameters.
LEAST_VOXEL = 2.0
#: Voxels along a side of the blocks by which pieces are sorted, and more blocks than there are.
BLOCK, FINEST = 8, 1 << 20
#: Golden angle of the Fibonacci directions.
GOLDEN = np.pi * (3 - np.sqrt(5))
#: Largest coordinate in voxels of a place: farther points are as dark as those there.
FARTHEST = 1e6


def directions(count: int, /) -> Array:
    """Return half of some directions that fill the sphere evenly; their opposites are the others.

    They are (count // 2, 3) unit vectors of a hemisphere, on a Fibonacci spiral.
    """
    number = np.arange(max(1, count // 2))
    # Bands of equal height have equal areas on a sphere (Archimedes), so even heights spread
    # evenly.
    z = (number + 0.5) / len(number)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(GOLDEN * number), r * np.sin(GOLDEN * number), z], axis=1)


class VoxelColumns(NamedTuple):
    """The voxels at points, which stand in columns toward a light.

    ``place`` (2, N) is that of each point in its voxel, across the light, from 0 to 1. ``axes``,
    (4, 3) or (4, 3, N), turns a vector from a point into voxels across the light, into its part
    toward the light, and into the share by which a voxel is wider at its end than at the point.
    ``area`` is that of a voxel across the light, in voxels of the medium.
    """

    place: Array
    axes: Array
    area: Array | float = 1.0

    def of(self, vectors: Array) -> Array:
        """Return vectors in columns, in voxels across the light and toward it."""
        rows: Array = np.einsum("ki...,i...->k...", self.axes.reshape(4, 3, -1), vectors)
        return rows


class Targets(NamedTuple):
    """Points that a medium dims, in voxels from its origin; see :meth:`Medium.targets`.

    ``places`` and ``vectors``, unit tangents of lines or unit normals of a surface, have the shape
    (3, N); points that are not finite are not dimmed. ``halves`` (2, 4, N) has vectors along both
    halves of the line of the medium that a point belongs to, as long as these, 0 for none, and 1
    where it is straight to a free end, else 0; it is None for a surface, which light reaches from
    the side of its normals alone.
    """

    places: Array
    finite: Bools
    vectors: Array | None = None
    halves: Array | None = None

    def facing(self, toward: Array) -> Array:
        """Return the share of light from a direction that points receive, for both its ends.

        Shape (2, N): ``|w x t|`` of a line, ``max(0, N . w)`` of a surface, 1 of a point without
        vectors.
        """
        if self.vectors is None:
            return np.ones((2, self.places.shape[1]), np.float32)
        # A thin cylinder shows a lamp its diameter times the sine of the angle between them.
        cosine = np.einsum("i...,i...->...", toward.reshape(3, -1), self.vectors)
        # A surface is lit on the side of its normal alone, so both ends of the direction differ.
        if self.halves is None:
            return np.maximum([cosine, -cosine], 0)
        # A line is lit alike from either end. Rounding may leave a cosine just above 1.
        sine = np.sqrt(np.maximum(1 - cosine * cosine, 0))
        return np.stack([sine, sine])

    def ordered(self, order: Indices) -> Targets:
        """Return the points in another order."""
        return Targets(
            np.take(self.places, order, axis=1),
            self.finite[order],
            None if self.vectors is None else np.take(self.vectors, order, axis=1),
            None if self.halves is None else np.take(self.halves, order, axis=2),
        )

    def own_depth(self, columns: VoxelColumns, thick: float = 0.0) -> Array | float:
        """Return the depth per diameter that the line of a point adds at the point itself.

        Depths (2, N) are toward the light and away from it; ``thick`` is the diameter of the lines
        in voxels, 0 for lines without free ends.
        """
        if self.halves is None:
            return 0.0
        depths = np.zeros((2, self.places.shape[1]), np.float32)
        disc: Array | float = 0.0
        if thick and self.vectors is not None:
            disc = DISC * thick * np.abs(columns.of(self.vectors)[2])
        side = np.sqrt(columns.area, dtype=np.float32)
        whole = np.sqrt((self.halves[:, :3] ** 2).sum(axis=1)).sum(axis=0)
        for *rows, free in self.halves:
            half = np.stack(rows)
            x, y, along, wider = columns.of(half)
            square = np.einsum("ij,ij->j", half, half)
            across = np.sqrt(np.maximum(square - along * along, 0))
            reach = whole * across / np.sqrt(np.maximum(square, NARROWEST))
            # Beyond two voxels to a side nothing is read. In perspective even steps across the
            # light are uneven along it.
            aside = np.maximum(np.abs(x), np.abs(y)) / 2
            part = 1 / np.maximum(aside, np.maximum(1 + wider, NARROWEST))
            middle = side / np.maximum(1 - wider * part / 2, NARROWEST)
            across *= part * _own_factor(thick, reach, middle)
            for node, weight in NODES:
                step = np.float32(node / 2 + 0.5) * part
                near = 1 / np.maximum(1 - wider * step, NARROWEST)
                depth = np.float32(weight / 2) * across / near
                depths += _parted(columns.place, step * x, step * y, step * along * near, depth)
            if thick:
                near = np.maximum(1 + wider, NARROWEST)
                end = free * disc / near**2 * _own_factor(thick, reach, side * near)
                depths += _parted(columns.place, x / near, y / near, along, end)
        return depths / columns.area


def _own_factor(thick: float, length: Array, cone: Array | float) -> Array:
    """Return the factor of the depth of a line at its own points, for voxels of a width."""
    # Lines wider than half a voxel are spread over their width.
    wide = np.sqrt(np.maximum((thick / cone) ** 2 - 1 / 4, NARROWEST**2))
    factor: Array = crowding(thick / cone, length / cone) * (3 * _central(wide / 2) / wide)
    return factor


def _parted(place: Array, x: Array, y: Array, along: Array, depth: Array) -> Array:
    """Return the depth read at places of a piece a step away, before it and behind it, in rows.

    Along the light it is that of a spread and a reading by hat functions in the mean over all
    places, the sum of a cubic B-spline.
    """
    depth = depth * _met(place[0], x) * _met(place[1], y)
    ahead = depth * (0.5 + _central(along))
    # What is ahead of a point in one direction is behind it in the other.
    return np.stack([ahead, depth - ahead])


def _met(place: Array, step: Array) -> Array:
    """Return the value read at a place in a voxel, of 1 that is spread a step from it."""
    at = place + step
    low, high = np.maximum(1 - np.abs(at), 0), np.maximum(1 - np.abs(at - 1), 0)
    depth: Array = (1 - place) * low + place * high
    return depth


def _central(along: Array) -> Array:
    """Return the integral of the cubic B-spline from 0 to places."""
    # Beyond two voxels the whole of a piece is on one side.
    s = np.minimum(np.abs(along), 2)
    square, left = s * s, (2 - s) * (2 - s)
    # Products: NumPy's powers above the second take several times as long.
    inner, outer = s * (2 / 3 + square * (s / 8 - 1 / 3)), 1 / 2 - left * left / 24
    return np.copysign(np.where(s < 1, inner, outer), along)


@dataclass(frozen=True)
class Medium:
    """Lines cut to pieces that are no longer than a voxel.

    ``middles`` and ``vectors`` (3, M) of the pieces are in voxels from the ``origin``, the centre
    of the lines; ``voxel`` is a voxel's side in the unit of the lines. ``free`` is the number of
    free ends of the line in each piece over the length of the piece, ``lengths`` the length of its
    ``line`` in lengths of the piece.
    """

    middles: Array
    vectors: Array
    free: Array
    lengths: Array
    origin: Array
    voxel: float
    line: Indices

    def targets(
        self, points: Array, vectors: Array | None = None, halves: Array | None = None, /
    ) -> Targets:
        """Return points that the medium dims.

        Points are in the unit of the lines. Vectors are tangents of lines or normals of a surface,
        of any length; for tangents, ``halves`` (N, 2, 4) are those of :func:`line_halves`.
        """
        # Centred in float64: float32 would lose the digits of lines far from the origin.
        places = (points.T.astype(np.float64) - self.origin[:, np.newaxis]) / self.voxel
        finite: Bools = np.asarray(np.isfinite(places).all(axis=0))
        # Beyond this, float32 has no fractions of a voxel left; farther points are as dark.
        places = np.where(finite, np.clip(places, -FARTHEST, FARTHEST), 0).astype(np.float32)
        unit = None
        if vectors is not None:
            rows = vectors.T.astype(np.float64)
            largest = np.abs(rows).max(axis=0, initial=0)
            with np.errstate(invalid="ignore", divide="ignore"):
                # By the largest component first: squares of tiny or huge vectors leave the range.
                rows = rows / largest
                rows /= np.sqrt((rows * rows).sum(axis=0))
            unit = np.where(np.isfinite(rows), rows, 0).astype(np.float32)
        if halves is not None:
            halves = halves.transpose(1, 2, 0) / np.array([*3 * [self.voxel], 1])[:, np.newaxis]
            halves = np.ascontiguousarray(np.clip(halves, -FARTHEST, FARTHEST), np.float32)
        return Targets(np.ascontiguousarray(places), finite, unit, halves)

    def depths(
        self, places: Array, toward: VectorLike, thick: float = 0.0, /
    ) -> tuple[Array, Array, VoxelColumns]:
        """Return the optical depth per diameter toward a direction and toward its opposite.

        Places are those of :class:`Targets`, the direction is of any length, and ``thick`` is the
        diameter of the lines in voxels, 0 for lines without free ends. The point's own line is
        included; diameters and depths are in voxels.
        """
        frame = _frame(toward).astype(np.float32)
        # For so few rows a product of matrices takes twice as long.
        turned, at = (np.einsum("ij,jk->ik", frame, rows) for rows in (self.middles, places))
        low, shape = box(turned)
        # A cylinder takes from the light by |w x t|, the length of its part in the plane across w.
        u, v = np.einsum("ij,jk->ik", frame[:2], self.vectors)
        across = np.sqrt(u * u + v * v)
        if thick:
            factor = crowding(thick, across * self.lengths)
            # Few pieces are the last of their line.
            last = np.flatnonzero(self.free)
            along = np.abs(np.einsum("i,ij->j", frame[2], self.vectors[:, last]))
            across[last] += np.float32(DISC * thick) * self.free[last] * along
            across *= factor
        grid = spread(turned - low, across, shape)
        total = summed(grid)
        cells = np.clip(at - low, 0, np.array(shape, np.float32)[:, np.newaxis] - 2)
        back = read(grid, cells)
        # The sums of all stand in two layers, so that they are read like a grid.
        cells[2] = 0
        forth = read(np.stack([total, total], axis=2), cells) - back
        rows = np.concatenate([frame, np.zeros((1, 3), np.float32)])
        return forth, back, VoxelColumns(cells[:2] - np.floor(cells[:2]), rows)

    def dimmed(
        self,
        targets: Targets,
        diameter: float,
        lights: Sequence[tuple[VectorLike, bool]],
        *,
        progress: Callable[[int], None] | None = None,
    ) -> Array:
        """Return the share of each light that is left at points.

        Shares (N, L) are in [0, 1]. A light is the direction toward it, or its position and True;
        the diameter is in the unit of the lines, and ``progress`` takes the number of grids that
        are done.
        """
        # Points in the order of blocks read voxels that are in the cache.
        thick, order = diameter / self.voxel, _by_blocks(targets.places)
        targets = targets.ordered(order)
        left = np.empty((targets.places.shape[1], len(lights)), np.float32)

        # A part is one light, which writes a column of its own, so that threads need no lock.
        def work(part: Slice) -> int:
            left[order, part.start] = self._light(targets, thick, *lights[part.start])
            return int(part.start)

        for number in _pool.run(work, _pool.blocks(len(lights), 1)):
            if progress is not None:
                progress(number + 1)
        # Points that are not finite are not dimmed; until here they stood at the origin.
        left[order[~targets.finite]] = 1
        return left

    def sky(self, targets: Targets, diameter: float, count: int) -> Array:
        """Return the share of light from all sides that is left at points.

        Shares (N,) are in [0, 1]; each of ``count`` directions is weighted by
        :meth:`Targets.facing`.
        """
        thick, order = diameter / self.voxel, _by_blocks(targets.places)
        targets = targets.ordered(order)
        ways = directions(count)
        pairs: dict[int, tuple[Array, Array]] = {}

        def work(part: Slice) -> int:
            pairs[part.start] = self._pair(targets, thick, ways[part.start])
            return int(part.start)

        # Each direction serves its opposite too: one grid, summed from either end.
        total = np.zeros((2, targets.places.shape[1]))
        for number in _pool.run(work, _pool.blocks(len(ways), 1)):
            # In the order of the parts, so that sums do not depend on the threads.
            total += pairs.pop(number)
        with np.errstate(invalid="ignore"):
            sides = (total[0] / total[1]).astype(np.float32)
        # A point with a normal of zero faces no direction: it is not dimmed, rather than 0 / 0.
        sides[~targets.finite | (total[1] == 0)] = 1
        share: Array = np.empty_like(sides)
        # Back from the order of blocks to the points' own.
        share[order] = sides
        return share

    def _light(self, targets: Targets, thick: float, place: VectorLike, near: bool) -> Array:
        """Return the share of a light that is left."""
        if near:
            # A lamp at a place has a fan of rays: voxels of a cube map around it, not of a box.
            lamp = (np.asarray(place, np.float64) - self.origin) / self.voxel
            depth, columns = depths(self, targets.places, lamp, thick)
        else:
            depth, _, columns = self.depths(targets.places, place, thick)
        return _left(depth, _ahead(targets.own_depth(columns, thick)), thick)

    def _pair(self, targets: Targets, thick: float, toward: Array) -> tuple[Array, Array]:
        """Return the weighted share of light from a direction and its opposite, and the weight."""
        toward = toward.astype(np.float32)
        facing = targets.facing(toward)
        *depths, columns = self.depths(targets.places, toward, thick)
        own_depths = targets.own_depth(columns, thick)
        forth, back = _left(np.stack(depths), own_depths, thick)
        # Light from each end counts by the share of it that the point would receive.
        return facing[0] * forth + facing[1] * back, facing.sum(axis=0)

    def crowded(self, targets: Targets, count: int) -> float:
        """Return the median over points of the depth per diameter, as a mean over directions."""
        total = np.zeros(targets.places.shape[1])
        ways = directions(count)
        for way in ways:
            forth, back, columns = self.depths(targets.places, way)
            # Without the point's own line, which does not dim it however crowded the lines are.
            total += (forth + back) / 2 - np.mean(targets.own_depth(columns), axis=0)
        return float(np.median(total[targets.finite]) / len(ways)) if targets.finite.any() else 0.0


def medium(points: Array, connectivity: Indices, offsets: Indices, /, *, voxel: float) -> Medium:
    """Return the medium of some polylines.

    ``offsets`` has the start of each line in the connectivity, followed by its length; ``voxel`` is
    the side of a voxel in the unit of the points. Pieces are of the segments with finite ends.
    """
    first = segment_starts(connectivity, offsets)
    ends = points[connectivity].astype(np.float64)
    finite: Bools = np.asarray(np.isfinite(ends).all(axis=1))
    # A segment with an end that is not finite takes no light; its neighbours do.
    first = first[finite[first] & finite[first + 1]]
    origin: Array = np.zeros(3)
    if finite.any():
        # Half of each before the sum: the sum of two huge coordinates may overflow.
        origin = ends[finite].min(axis=0) / 2 + ends[finite].max(axis=0) / 2
    start = (ends[first] - origin) / voxel
    vector = (ends[first + 1] - origin) / voxel - start
    # Pieces no longer than a voxel, so that the spread over 8 voxels is a fair hat.
    parts = np.maximum(1, np.ceil(np.linalg.norm(vector, axis=1) - 1e-9)).astype(np.intp)
    middles, vectors = cut((start + vector / 2).T, vector.T, parts)
    free = _free_ends(connectivity, offsets)
    last = np.cumsum(parts) - 1
    ends_of = np.zeros(middles.shape[1])
    ends_of[last - parts + 1] += free[first]
    ends_of[last] += free[first + 1]
    length = size(vectors)
    ends_of = np.divide(ends_of, length, out=np.zeros_like(length), where=length > 0)
    # Pieces near each other are spread one after the other, on voxels that are in the cache.
    order = _by_blocks(middles)
    middles, vectors = (
        np.take(rows.astype(np.float32), order, axis=1) for rows in (middles, vectors)
    )
    number = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    line: Indices = np.repeat(number[first], parts)
    whole = np.bincount(line, length)[line] if len(line) else length
    lengths = np.divide(whole, length, out=np.zeros_like(length), where=length > 0)
    tips, shares = (rows[order].astype(np.float32) for rows in (ends_of, lengths))
    return Medium(middles, vectors, tips, shares, origin, voxel, line[order])


def _free_ends(connectivity: Indices, offsets: Indices) -> Bools:
    """Return which places of the connectivity are ends of lines that no line goes on from."""
    free: Bools = np.zeros(len(connectivity), np.bool_)
    some = np.diff(offsets) > 0
    ends = np.concatenate([offsets[:-1][some], offsets[1:][some] - 1])
    # The seam of a closed line, and a point where lines meet, are no ends.
    free[ends] = np.bincount(connectivity)[connectivity[ends]] == 1
    return free


def _by_blocks(places: Array) -> Indices:
    """Return the order of places in voxels in which those near each other follow one another."""
    # Clipped, so that three numbers of blocks fit into one integer of 64 bits.
    x, y, z = np.clip(np.floor(places / BLOCK), -FINEST / 2, FINEST / 2).astype(np.int64)
    return np.argsort((x * FINEST + y) * FINEST + z, kind="stable")


def segment_starts(connectivity: Indices, offsets: Indices, /) -> Indices:
    """Return the indices in the connectivity at which a segment starts; the next one is its end."""
    inside = np.ones(len(connectivity), np.bool_)
    # The last point of each line starts no segment.
    inside[offsets[1:][np.diff(offsets) > 0] - 1] = False
    return np.flatnonzero(inside)


def line_halves(points: Array, connectivity: Indices, offsets: Indices, /) -> Array:
    """Return both halves of the longest line that each point belongs to, shape (N, 2, 4).

    Each is a vector along the segment beside the point, as long as the line from the point to its
    end and to its start; 0 at an end of a line. The fourth component is 1 where the half is
    straight to a free end, else 0.
    """
    first = segment_starts(connectivity, offsets)
    ends = points[connectivity].astype(np.float64)
    with np.errstate(over="ignore", invalid="ignore"):
        vectors = ends[first + 1] - ends[first]
        size = np.linalg.norm(vectors, axis=1)
    # The running sum would carry NaN from one line to all that follow.
    good = np.isfinite(size) & (size > 0)
    steps, ways = np.zeros(len(connectivity)), np.zeros((len(connectivity), 3))
    steps[first[good]] = size[good]
    ways[first[good]] = vectors[good] / size[good, np.newaxis]
    along = np.concatenate([[0.0], np.cumsum(steps)])
    line = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    place = along[:-1]
    ahead, behind = along[offsets[1:]][line] - place, place - along[offsets[:-1]][line]
    halves = np.zeros((len(connectivity), 2, 4))
    halves[:, 0, :3] = ahead[:, np.newaxis] * ways
    # The segment before a point begins at the point before it, of the same line.
    before = np.concatenate([np.zeros((1, 3)), ways[:-1]])
    before[offsets[:-1][np.diff(offsets) > 0]] = 0
    halves[:, 1, :3] = -behind[:, np.newaxis] * before
    free = _free_ends(connectivity, offsets)
    for side, tips in enumerate((offsets[1:] - 1, offsets[:-1])):
        tip, half = tips[line], halves[:, side, :3]
        with np.errstate(over="ignore", invalid="ignore"):
            off = np.abs(ends[tip] - ends - half).max(axis=1, initial=0)
            straight = off <= STRAIGHT * np.abs(half).max(axis=1, initial=0)
        halves[:, side, 3] = free[tip] & straight
    longest = np.zeros((len(points), 2, 4))
    # Of equal indices the last value stays: that of the longest line.
    order = np.argsort(ahead + behind, kind="stable")
    longest[connectivity[order]] = halves[order]
    return longest


def _ahead(depths: Array | float) -> Array | float:
    """Return the first of two rows of depths."""
    return depths if isinstance(depths, float) else depths[0]


def _left(depth: Array, own_depth: Array | float, thick: float, /) -> Array:
    """Return the share of light that is left behind lines of a diameter, in voxels."""
    # Beer and Lambert: what is left is the exponential of minus the depth of all other lines.
    others = depth - own_depth
    others *= -thick
    # More light than all comes of rounding alone.
    left: Array = np.exp(np.minimum(others, 0, out=others), out=others)
    return left


def _frame(toward: VectorLike) -> Array:
    """Return an orthonormal frame, in rows, with a direction as the last row."""
    w = np.asarray(toward, np.float64) / np.linalg.norm(toward)
    return np.stack([*axial.frame(w), w])


#: Largest number of parts of a piece near a light, along it and over its width.
MOST_PARTS = 512
#: Largest number of pieces that are added by such cuts.
MOST_PIECES = 2_000_000
#: Largest share of a voxel that a line takes from the light.
WIDEST = 0.99
#: Least width of a voxel near a light, and least distance from it, in voxels.
NARROWEST = 1e-6


def depths(
    medium: Medium, places: Array, lamp: VectorLike, thick: float = 0.0, /
) -> tuple[Array, VoxelColumns]:
    """Return the optical depth per diameter between points and a light nearby.

    The grid has the light in its centre: on each of the six faces of a cube around it, voxels are
    cones that widen with the distance. Near the light they are narrower than a line, which is then
    spread over the width that it shows, and opaque where it covers a cone.

    Places and the lamp, which may be outside the bundle, are in voxels; depths are as for
    :meth:`Medium.depths`.
    """
    centre = np.asarray(lamp, np.float64)[:, np.newaxis]
    # A face of the cube is turned to the middle of the pieces: from afar it is the box of a light
    # at infinity, and no direction in space is preferred.
    ahead = -centre[:, 0]
    if medium.middles.size:
        ahead += np.mean(medium.middles, axis=1, dtype=np.float64)
    frame = _frame(ahead) if np.linalg.norm(ahead) > NARROWEST else np.eye(3)
    at, middles, vectors = (
        np.einsum("ij,jk->ik", frame, rows)
        for rows in (places - centre, medium.middles - centre, medium.vectors)
    )
    # Distances of the pieces and of the points from the light.
    gone, far = size(middles), size(at)
    out = np.zeros(at.shape[1], np.float32)
    place, axes = np.zeros((2, at.shape[1]), np.float32), np.zeros((4, 3, at.shape[1]), np.float32)
    area: Array = np.ones(at.shape[1], np.float32)
    # A point at the light itself has no direction toward it, and nothing is divided by 0.
    axes[2] = -at / np.maximum(far, NARROWEST)
    if not gone.size:
        return out, VoxelColumns(place, axes, area)
    # Width of a cone at distance 1: it grows to a voxel at the median distance of the pieces, or at
    # 1 where that is less.
    width = 1 / max(float(np.median(gone)), 1.0)
    close = np.full(int(medium.line.max()) + 1, np.inf)
    np.minimum.at(close, medium.line, _nearest(middles, vectors))
    rows = np.stack([DISC * thick * medium.free, medium.lengths, close[medium.line]])
    middles, vectors, share, (discs, lengths, _) = _for_cones(middles, vectors, width, thick, rows)
    gone = size(middles)
    # |w x t| times the length of a piece, for a direction w that differs from piece to piece.
    across = size(np.cross(vectors, middles, axis=0)) / np.maximum(gone, NARROWEST)
    # Lines crowd by their diameter and length in widths of the cones there, not in voxels.
    # Toward the edges of the cube they are narrower, by the root of the area in a pyramid.
    slant = gone / np.maximum(np.abs(middles).max(axis=0), NARROWEST)
    cone = np.maximum(width * gone / slant**1.5, NARROWEST)
    factor = crowding(thick / cone, across * lengths / cone)
    last = np.flatnonzero(discs)
    along = np.abs((vectors[:, last] * middles[:, last]).sum(axis=0))
    across[last] += discs[last] * along / np.maximum(gone[last], NARROWEST)
    across *= share * factor
    # As in a cube map the largest component tells through which face the light sees a point.
    face = np.argmax(np.abs(at), axis=0)
    for axis in range(3):
        others = [i for i in range(3) if i != axis]
        for side in (1, -1):
            rows = np.flatnonzero((face == axis) & (side * at[axis] > 0))
            # The half space, not the pyramid alone: pieces just beyond its edges spread into its
            # cones.
            held = np.flatnonzero(side * middles[axis] > 0)
            if rows.size and held.size:
                # Tangents of the two angles under which the light sees points and pieces.
                seen, pieces = (
                    v[others] / (side * v[axis] * width) for v in (at[:, rows], middles[:, held])
                )
                out[rows], place[:, rows] = _in_pyramid(
                    seen, far[rows], pieces, gone[held], across[held], width
                )
                height = np.maximum(side * at[axis, rows], NARROWEST)
                for row, other in enumerate(others):
                    axes[row, other, rows] = 1 / (width * height)
                    axes[row, axis, rows] = -side * seen[row] / height
                axes[3, axis, rows] = side / height
                # The area that a cone has across the light at the point, as for pieces below.
                area[rows] = (width * height) ** 2 * height / np.maximum(far[rows], NARROWEST)
    axes = np.einsum("ijk,jl->ilk", axes, frame).astype(np.float32)
    return out, VoxelColumns(place, axes, np.maximum(area, NARROWEST**2))


def _in_pyramid(
    seen: Array, far: Array, held: Array, gone: Array, across: Array, width: float
) -> tuple[Array, Array]:
    """Return the depth between a light and points, for pieces, in one of six pyramids around it.

    And the places of the points in their voxels, across the light.

    Points and pieces are given by the tangents under which the light sees them, in widths of the
    cones into which the pyramid is cut, and by their distances from it.
    """
    reach = far.max()
    # A piece spreads over one cone to each side and a point reads as far: others are not met.
    low = seen.min(axis=1, keepdims=True) - 2
    high = seen.max(axis=1, keepdims=True) + 2
    # Pieces that are farther from the light than every point stand in nobody's way.
    inside = ((held > low) & (held < high)).all(axis=0) & (gone < reach + 2)
    if not inside.any():
        return np.zeros(len(far), np.float32), np.zeros_like(seen)
    held, gone, across = held[:, inside], gone[inside], across[inside]
    # Height over the light of the plane that is divided into squares, in voxels.
    slant = np.sqrt(1 + width**2 * (held * held).sum(axis=0))
    # A cone's square at the height of a piece is seen aslant; this is its area across the light.
    area = (width * gone) ** 2 / slant**3
    # The third axis is the distance from the light, along which the grid is summed.
    rows = np.concatenate([held, gone[np.newaxis]])
    low, shape = box(rows)
    grid = spread((rows - low).astype(np.float32), across / area, shape)
    summed(grid)
    cells = np.concatenate([seen, far[np.newaxis]]) - low
    limits = np.array(shape, np.float64)[:, np.newaxis] - 2
    cells = np.clip(cells, 0, limits).astype(np.float32)
    return read(grid, cells), cells[:2] - np.floor(cells[:2])


def size(rows: Array) -> Array:
    """Return the lengths of vectors in columns."""
    size: Array = np.sqrt((rows * rows).sum(axis=0))
    return size


def crowding(thick: Array | float, lengths: Array) -> Array:
    """Return the factor of the depth of lines, of a diameter and a length across the light.

    Both are in voxels. Lines lie at random in voxels: the mean of exp(-q) over places is above the
    exponential of the mean of the depth q that a line adds. Let s be the mean of q^2 over that of
    q, nearly ``f(d) f(L)`` with ``f(x) = 1 - 4 / (4 + x (2 + x))`` for hat functions: x / 2 where
    a line is short or thin, 1 where it covers voxels. The factor is ``1 - log(1 - s) / 2``.
    """
    thin, short = (4 / (4 + x * (2 + x)) for x in (thick, lengths))
    # 1 - s, which the product of two numbers near 1 would round to 0.
    factor: Array = 1 - np.log(thin + short - thin * short) / 2
    return factor


def _for_cones(
    middles: Array, vectors: Array, width: float, thick: float, rows: Array
) -> tuple[Array, Array, Array, Array]:
    """Return pieces cut again where cones from a light are narrower, shares, and rows of each.

    A piece is cut along its length, and into parallel pieces over the width of the line. Of the
    rows the second is the length of its line in lengths of the piece, and the third the distance
    of its line from the light.
    """
    # No piece longer than a cone is wide where the piece comes nearest to the light.
    parts = _limited(size(vectors) / (width * _nearest(middles, vectors)))
    middles, vectors = cut(middles, vectors, parts)
    rows = np.repeat(rows, parts, axis=1)
    rows[1] *= np.repeat(parts, parts)
    # Across both the line and the light: the direction in which the line shows its width.
    across = np.cross(vectors, middles, axis=0)
    reach = np.maximum(size(across), NARROWEST**2)
    # The two planes that touch a cylinder are farther apart than its diameter where it is near.
    sine = thick / (2 * rows[2])
    # A light inside the line would have a sine above 1, and no plane that touches the line.
    wider = 1 / np.sqrt(1 - np.minimum(sine, WIDEST) ** 2)
    # From here on as long as the width that the line shows to the light.
    across *= thick * wider / reach
    # Two parallel pieces for each cone that the line's width covers.
    parts = _limited(2 * thick * wider / (width * _nearest(middles, vectors)))
    middles, across = cut(middles, across, parts)
    # The parallel pieces share what the whole line takes from the light.
    share = np.repeat(wider / parts, parts)
    return middles, np.repeat(vectors, parts, axis=1), share, np.repeat(rows, parts, axis=1)


def _nearest(middles: Array, vectors: Array) -> Array:
    """Return the least distances of pieces from the light."""
    square = np.maximum((vectors * vectors).sum(axis=0), NARROWEST**4)
    # The foot of the perpendicular from the light, kept between the ends of the piece.
    place = np.clip(-(middles * vectors).sum(axis=0) / square, -0.5, 0.5)
    return np.maximum(size(middles + place * vectors), NARROWEST)


def _limited(parts: Array) -> Indices:
    """Return whole numbers of parts, reducing the largest where the pieces would be too many."""
    most = MOST_PARTS
    while True:
        # A lower limit takes parts only from the pieces that have most, those nearest to the light.
        number = np.ceil(np.clip(parts, 1, most)).astype(np.intp)
        if most <= 1 or number.sum() <= len(number) + MOST_PIECES:
            return number
        most //= 2
