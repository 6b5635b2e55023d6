"""The share of a uniform sky that points of surfaces and of tubes see, by rays, point by point.

A point of a surface sees ``1/pi * integral of max(n . w, 0)`` over the directions w in which no
triangle stands. A point of a line sees the mean of that over the circumference of its tube.
Directions are nets that add a constant step to each point (Roberts' R2), which 64 shifts tell apart
from point to point, turned to the normal. Their number grows only for points like which others
are not right enough yet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from vizlight import _check, _pool
from vizlight._types import Array, Bools, Indices, Slice
from vizlight.geometry.lines.bundle import segment_starts
from vizlight.geometry.lines.curves import polyline_tangents
from vizlight.mesh.closed_meshes import Tracer

#: Distance of starts from the surface as a share of the size of the scene: what float32 resolves.
OFFSET = 2e-6
#: Distance of a place beside a point, as a share of the distance of its triangle's middle.
BESIDE = 0.05
#: Length of rays in scenes of size 1.
FAR = 2.0
#: Numbers of rays per point at first and at most, rays that are followed at once, shifts of nets.
FEWEST, MOST, AT_ONCE, SHIFTS = 32, 1 << 14, 1 << 17, 64
#: Steps of additive nets in 2 and 3 dimensions, from the roots of x^3 = x + 1 and x^4 = x + 1.
RATES = {
    2: np.array([0.7548776662466927, 0.5698402909980532]),
    3: np.array([0.8191725133961645, 0.6710436067037893, 0.5497004779019703]),
}
#: Ranges of the share in which points are taken for alike.
CLASSES = 16
#: Error that 95 of 100 points keep to, per root mean square.
QUANTILE = 2.0
#: Square of a net's error times its rays to the power 1.5, per V (1 - V), as a rule, and number of
#: points that this rule stands for.
USUAL, WEIGHT = 2.0, 8
#: Sides of the prism that stands for a tube, its radius for the tube's mean width, and a factor
#: that takes a start outside of its corners.
SIDES = 6
PRISM = np.pi / (SIDES * np.sin(np.pi / SIDES))
OUTSIDE = 1.06


class SkyPlaces(NamedTuple):
    """Points that look at the sky.

    ``ways`` are normals of a surface or tangents of lines; a row that is 0 or not finite has no
    sky. ``radius`` is that of the tubes, None for a surface; a point that sees nothing looks again
    from ``beside``, see :func:`beside`.
    """

    points: Array
    ways: Array
    radius: float | None = None
    beside: tuple[Array, Array] | None = None


class Seen(NamedTuple):
    """Shares of the sky that points see.

    A point is ``valid`` if it has a normal and is not buried inside of the surface; 95 of 100
    points keep to ``error``, as estimated. ``rays`` is the number of rays of all points.
    """

    share: Array
    valid: Bools
    error: float
    rays: int


class Occluders:
    """Triangles that hide the sky, scaled to size 1 about 0 so that float32 loses nothing.

    Their winding tells the outer side from the inner one.
    """

    def __init__(self, points: Array, triangles: Indices) -> None:
        used = points[triangles]
        # Triangles with a corner that is not finite, or as far away, hide nothing.
        used = used[(np.abs(used) <= _check.FARTHEST).all(axis=(1, 2))]
        low = used.min(axis=(0, 1), initial=np.inf) if len(used) else np.zeros(3)
        high = used.max(axis=(0, 1), initial=-np.inf) if len(used) else np.zeros(3)
        self.middle = low / 2 + high / 2
        self.size = float(np.linalg.norm(high - low)) or 1.0
        self.corners = (used - self.middle) / self.size
        a, b, c = self.corners.transpose(1, 0, 2)
        self.normals = np.cross(b - a, c - a)
        self.tracer = Tracer(self.corners)

    def seen(
        self,
        places: SkyPlaces,
        *,
        error: float,
        up: Array | None = None,
        report: Callable[[int], None] = lambda _: None,
    ) -> Seen:
        """Return the share of the sky that points see.

        95 of 100 points shall keep to the error; ``up`` is the direction of the half space that is
        the sky, and ``report`` takes the number of points that are done.
        """
        ways = np.asarray(places.ways, np.float64)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            # By the largest component first, so that no square overflows or vanishes.
            ways = ways / np.abs(ways).max(axis=1, initial=0, keepdims=True)
            ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        points = (np.asarray(places.points, np.float64) - self.middle) / self.size
        near = (np.abs(points) <= _check.FARTHEST).all(axis=1)
        valid: Bools = np.isfinite(ways).all(axis=1) & near
        share = np.zeros(len(points), np.float32)
        if not valid.any():
            return Seen(share, valid, 0.0, 0)
        rows = np.flatnonzero(valid)
        radius = None if places.radius is None else places.radius / self.size
        work = _Rays(self.tracer, points[rows], ways[rows], radius, up)
        share[rows], missed = _until(error, work, report)
        dark = rows[share[rows] == 0]
        if not len(dark) or radius is not None:
            return Seen(share, valid, missed, work.rays)
        if places.beside is None:
            valid[dark] = ~self._buried(points[dark], ways[dark])
            return Seen(share, valid, missed, work.rays)
        near, out = places.beside
        # These have no places beside them, so that they look once more only.
        again = self.seen(SkyPlaces(near[dark], out[dark]), error=error, up=up)
        share[dark], valid[dark] = again.share, again.valid
        return Seen(share, valid, missed, work.rays + again.rays)

    def _buried(self, points: Array, normals: Array) -> Bools:
        """Return whether points see the inner side of triangles in most directions."""
        net = _net(1, 64, 0, line=False)[0]
        behind = np.zeros(len(points))
        for part, start, way in _starts(points, normals, net, 0.0):
            hit = self.tracer.first(start, way, FAR)
            # A ray that hits a triangle along its outward normal comes from inside.
            inner = np.einsum("ij,ij->i", way, self.normals[hit]) > 0
            behind[part] = np.reshape((hit >= 0) & inner, (len(net[0]), -1)).mean(axis=0)
        return np.asarray(behind > 1 / 2)


class _Rays:
    """Rays of points, tubes of a radius or a surface, by parts of their nets."""

    def __init__(
        self, tracer: Tracer, points: Array, ways: Array, radius: float | None, up: Array | None
    ) -> None:
        self.tracer, self.points, self.ways = tracer, points, ways
        self.line, self.away = radius is not None, OUTSIDE * (radius or 0.0)
        self.up = None if up is None else (up / np.linalg.norm(up)).astype(np.float32)
        # Neighbours in the order of points have other shifts.
        self.shift = np.random.default_rng(0).permutation(len(points)) % SHIFTS
        self.rays = 0

    def free(self, rows: Indices, first: int, count: int) -> Array:
        """Return the share of ``count`` rays of each point, from a first one on, that are free."""
        shares = np.empty(len(rows), np.float32)
        self.rays += len(rows) * count
        for number, net in enumerate(_net(SHIFTS, count, first, line=self.line)):
            of_net = np.flatnonzero(self.shift[rows] == number)
            at = rows[of_net]
            for part, start, way in _starts(self.points[at], self.ways[at], net, self.away):
                free = self.tracer.free(start, way, FAR)
                if self.up is not None:
                    # Below the horizon there is no sky, even where nothing stands.
                    free &= way @ self.up > 0
                shares[of_net[part]] = free.reshape(count, -1).mean(axis=0)
        return shares


def _until(error: float, work: _Rays, report: Callable[[int], None]) -> tuple[Array, float]:
    """Return the shares of points, and the error that 95 of 100 of them keep to."""
    # Two halves at first, whose difference tells the error.
    count = added = FEWEST // 2
    going = np.arange(len(work.points))
    first = work.free(going, 0, count)
    share = np.zeros(len(going), np.float32)
    squares = 0.0
    while True:
        other, total = work.free(going, count, added), count + added
        # The square of a net's error falls with the power 1.5 of its rays, which gives that of
        # both parts together from their difference.
        square = (first - other) ** 2 * total**-1.5 / (count**-1.5 + added**-1.5)
        mean = (count * first + added * other) / total
        share[going] = mean
        # Few points tell little: what nets err by as a rule stands for some more of each class.
        rule = USUAL * mean * (1 - mean) * total**-1.5
        kind = np.minimum((mean * CLASSES).astype(np.intp), CLASSES - 1)
        size, sums, usual = (
            np.bincount(kind, rows, minlength=CLASSES) for rows in (None, square, rule)
        )
        pooled = (sums + WEIGHT * usual / np.maximum(size, 1)) / (size + WEIGHT)
        # By classes, since a single point may seem right by chance.
        done = (QUANTILE * np.sqrt(pooled) <= error)[kind] | (total >= MOST)
        squares += float(pooled[kind[done]].sum())
        going, first = going[~done], mean[~done]
        report(len(share) - len(going))
        if not len(going):
            return share, QUANTILE * float(np.sqrt(squares / len(share)))
        count, added = total, total // 2


def _net(shifts: int, count: int, first: int, *, line: bool) -> list[tuple[Array, Array]]:
    """Return shifted parts of a net of directions, weighted by the cosine."""
    net = (np.arange(first, first + count)[:, np.newaxis] + 0.5) * RATES[3 if line else 2]
    parts = []
    for shift in np.random.default_rng(1).random((shifts, net.shape[1])):
        h = (net + shift) % 1
        # Even on the disc below the hemisphere and lifted to it, directions are weighted by the
        # cosine.
        angle, cosine = 2 * np.pi * h[:, 1], np.sqrt(1 - h[:, 0])
        x, y = np.sqrt(h[:, 0]) * np.cos(angle), np.sqrt(h[:, 0]) * np.sin(angle)
        ways, outward = np.stack([x, y, cosine], axis=1), np.tile([0.0, 0.0, 1.0], (count, 1))
        if line:
            # The normal goes round the line, which is the third axis.
            around = 2 * np.pi * h[:, 2]
            c, s = np.cos(around), np.sin(around)
            # The hemisphere stands on the side of the tube, its x along the line.
            ways = np.stack([cosine * c - y * s, cosine * s + y * c, x], axis=1)
            outward = np.stack([c, s, np.zeros(count)], axis=1)
        parts.append((ways.astype(np.float32), outward.astype(np.float32)))
    return parts


def _starts(
    points: Array, ways: Array, net: tuple[Array, Array], away: float
) -> Iterator[tuple[Slice, Array, Array]]:
    """Yield some points, and the starts and directions of their rays, one ray of each at a time."""
    toward, outward = net
    count = len(toward)
    for part in _pool.blocks(len(points), max(1, AT_ONCE // count)):
        # All frames side by side: one product of matrices gives the rays of all points.
        across = _frames(ways[part]).transpose(1, 0, 2).reshape(3, -1)
        way = (toward @ across).reshape(-1, 3)
        start = ((away + OFFSET) * outward @ across).reshape(count, -1, 3)
        yield part, (start + points[part].astype(np.float32)).reshape(-1, 3), way


def _frames(ways: Array) -> Array:
    """Return orthonormal frames of float32, shape (N, 3, 3), with unit vectors as last rows.

    Source: Duff and others, Journal of Computer Graphics Techniques 6 (2017), without branches.
    """
    x, y, z = ways.T
    sign = np.where(z >= 0, 1.0, -1.0)
    a = -1 / (sign + z)
    b = x * y * a
    rows = [1 + sign * x * x * a, sign * b, -sign * x, b, sign + y * y * a, -y, x, y, z]
    return np.stack(rows, axis=1).reshape(-1, 3, 3).astype(np.float32)


def beside(points: Array, triangles: Indices) -> tuple[Array, Array]:
    """Return places close to points, each on the largest triangle of its point, and their normals.

    Where faces meet inward a point is on the wrong side of one of them by rounding, or its mean
    normal takes the start of its rays there: it sees nothing, but the places beside it do.
    Triangles are wound so that their outer side looks at the sky; the normal is 0 where a point has
    no triangle.
    """
    normals = across(points, triangles)
    area = np.nan_to_num(np.einsum("ij,ij->i", normals, normals), posinf=0.0)
    largest = np.full(len(points), -1)
    # Of equal indices the last value stays.
    order = np.argsort(area)
    largest[triangles[order].ravel()] = np.repeat(order, 3)
    there = largest >= 0
    near, out = points.copy(), np.zeros(points.shape)
    triangle = largest[there]
    with np.errstate(invalid="ignore"):  # at points that are infinite
        near[there] += BESIDE * (points[triangles[triangle]].mean(axis=1) - points[there])
    out[there] = normals[triangle]
    return near, out


def turned(points: Array, triangles: Indices, ways: Array) -> Indices:
    """Return triangles wound so that the normals of their points are on their outer side."""
    with np.errstate(all="ignore"):
        inward = np.einsum("ij,ikj->i", across(points, triangles), ways[triangles]) < 0
    return np.where(inward[:, np.newaxis], triangles[:, ::-1], triangles)


def across(points: Array, triangles: Indices) -> Array:
    """Return the normals of triangles, as long as twice their areas."""
    a, b, c = points[triangles].transpose(1, 0, 2)
    with np.errstate(all="ignore"):
        return np.cross(b - a, c - a)


def tubes(points: Array, ids: Indices, offsets: Indices, radius: float) -> tuple[Array, Indices]:
    """Return vertices and triangles of prisms about polylines, of the mean width of round tubes.

    ``ids`` are the points of each line, one line after the other, and ``offsets`` (L + 1,) the
    start of each in it, followed by its length.
    """
    place = points[ids].astype(np.float64)
    tangents = polyline_tangents(place, offsets=offsets)
    # Where there is no tangent no prism is made, and any frame will do.
    frame = _frames(np.where(np.any(tangents, axis=1, keepdims=True), tangents, [0.0, 0.0, 1.0]))
    turn = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = PRISM * radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    vertices = place[:, np.newaxis] + ring @ frame[:, :2].astype(np.float64)
    first = segment_starts(ids, offsets)
    # A line has no tangent where it turns back, and so no ring of corners across it.
    good = np.any(tangents[first], axis=1) & np.any(tangents[first + 1], axis=1)
    first = first[good & np.isfinite(place[first] + place[first + 1]).all(axis=1)]
    # The corner of the next ring that is nearest in angle to the first of this one.
    u, v = (np.einsum("ij,ij->i", frame[first, 0], frame[first + 1, k]) for k in (0, 1))
    shift = np.rint(np.arctan2(v, u) * SIDES / (2 * np.pi)).astype(np.intp)[:, np.newaxis]
    side = np.arange(SIDES)
    near = first[:, np.newaxis] * SIDES
    far = near + SIDES
    a, b = near + side, near + (side + 1) % SIDES
    c, d = far + (side + shift) % SIDES, far + (side + shift + 1) % SIDES
    halves = [np.stack(corners, axis=2).reshape(-1, 3) for corners in ((a, b, d), (a, d, c))]
    return vertices.reshape(-1, 3), np.concatenate(halves)
