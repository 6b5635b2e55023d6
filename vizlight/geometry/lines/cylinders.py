"""Rays through the solid cylinders of a bundle of lines, which tell the error of its medium.

A ray is tested against the pieces beside it alone: points and pieces are sorted into cells across
the light, squares for a light at infinity, cones for a lamp, the wider the nearer a piece is to it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vizlight._types import Array, Bools, Indices, VectorLike
from vizlight.geometry import axial
from vizlight.geometry.lines.bundle import Medium, Targets

#: Number of points from which rays are sent to a light.
SAMPLE = 512
#: Starts of rays across a line, in its diameters from its axis.
STARTS = np.array([-0.375, -0.125, 0.125, 0.375])
#: Distance between a point and the axis of its own line, at most: in diameters, and in voxels.
ON_AXIS, ROUNDING = 0.01, 1e-4
#: Stretch of a cone beside a face of a cube, at most, and number of bits of a table of cells.
STRETCH, TABLE = 1.75, 18
#: Coarsest and finest level of cones, of a width of 2 to the power of minus it.
COARSEST, FINEST = 2, 24
#: Distance behind a point, in voxels, beyond which a line that covers the point is left out.
BEHIND = 8.0
#: Share of the points whose error is stated, and standard errors beside a mean and beside it.
QUANTILE, SURE, SURER = 0.95, 2.0, 3.0
#: Smallest sine of the angle between a ray and a line that it crosses.
LEAST_SINE = 1e-5


class Missed(NamedTuple):
    """Errors of the share of a light that a medium leaves.

    95 of 100 points keep to ``error``; ``mean`` is that of the mean share, two standard errors of
    the sample included.
    """

    error: float
    mean: float


def missed(
    medium: Medium, targets: Targets, diameter: float, light: VectorLike, near: bool, left: Array, /
) -> Missed:
    """Return the errors of shares of a light, as rays from some of the points find them.

    ``light`` is the direction toward the light, or its position if ``near``; ``left`` is the share
    of it that the medium leaves at each point. Errors are zero where no point faces the light.
    """
    count = len(left)
    some: Indices = np.arange(count)
    if count > SAMPLE:
        some = np.random.default_rng(0).integers(count, size=SAMPLE)
    chosen = targets.ordered(some)
    way, _ = _ways(medium, chosen, light, near)
    # Light that a point does not receive is of no account.
    good = np.flatnonzero(chosen.finite & (chosen.facing(way)[0] > 0))
    if not len(good):
        return Missed(0.0, 0.0)
    rays = free_shares(medium, chosen.ordered(good), diameter, light, near)
    off = left[some[good]] - rays
    spread = SURER * np.sqrt(QUANTILE * (1 - QUANTILE) / len(off))
    # A quantile of few points is uncertain: the stated one is that much farther out.
    error = np.quantile(np.abs(off), min(1.0, QUANTILE + spread))
    return Missed(float(error), float(abs(off.mean()) + SURE * off.std() / np.sqrt(len(off))))


def free_shares(
    medium: Medium, targets: Targets, diameter: float, light: VectorLike, near: bool, /
) -> Array:
    """Return the shares of rays from points to a light that no solid cylinder stops.

    Rays start across the width of the line of a point, or at a point of a surface. Lines at random
    overlap: of those that cover the start of a ray, the ones with the middle of the ray's way
    through them ahead of it stop it. The line of a point does not where the ray begins inside it.
    """
    thick, places = diameter / medium.voxel, targets.places.astype(np.float64)
    way, reach = _ways(medium, targets, light, near)
    if near:
        lamp = (np.asarray(light, np.float64) - medium.origin) / medium.voxel
        point, piece = _in_cones(medium.middles - lamp[:, np.newaxis], places, lamp, thick)
    else:
        across = np.stack(axial.frame(way[:, 0])) if way.shape[1] else np.eye(3)[:2]
        point, piece = _in_squares(across @ medium.middles, across @ places, thick)
    pairs = _beside(medium, places, way, (point, piece), thick)
    starts, side = np.zeros(1), np.zeros_like(places)
    if targets.halves is not None and targets.vectors is not None:
        starts, side = STARTS, np.cross(way, targets.vectors, axis=0)
        side = thick * side / np.maximum(np.linalg.norm(side, axis=0), LEAST_SINE)
    hits = _passages(medium, places, way, starts, side, pairs, thick)
    stops = (hits.first + hits.last > 0) & (hits.first + hits.last < 2 * reach[hits.point])
    if targets.halves is not None:
        own_lines = _own_lines(medium, places, pairs, thick)
        key = hits.point * _lines(medium) + hits.line
        stops &= ~(np.isin(key, own_lines) & (hits.first <= thick) & (hits.last >= -thick))
    stopped = np.zeros((places.shape[1], len(starts)), np.bool_)
    stopped[hits.point[stops], hits.start[stops]] = True
    free: Array = 1 - stopped.mean(axis=1)
    return free


def _ways(medium: Medium, targets: Targets, light: VectorLike, near: bool) -> tuple[Array, Array]:
    """Return unit vectors from points to a light, and its distances in voxels."""
    toward = np.asarray(light, np.float64)[:, np.newaxis]
    if not near:
        way = np.repeat(toward / np.linalg.norm(toward), targets.places.shape[1], axis=1)
        return way, np.full(way.shape[1], np.inf)
    way = (toward - medium.origin[:, np.newaxis]) / medium.voxel - targets.places
    reach = np.linalg.norm(way, axis=0)
    return way / np.where(reach > 0, reach, 1), reach


def _lines(medium: Medium) -> int:
    """Return a number above those of all lines."""
    return int(medium.line.max(initial=0)) + 1


def _ball(thick: float) -> float:
    """Return the radius around a piece's middle within which rays of a point may meet the piece."""
    return 0.5 + thick


def _in_squares(pieces: Array, points: Array, thick: float) -> tuple[Indices, Indices]:
    """Return pairs of points and pieces that are in neighbouring squares across the light."""
    side = 1.001 * _ball(thick)
    low = np.minimum(pieces.min(axis=1, initial=np.inf), points.min(axis=1, initial=np.inf))
    low = np.where(np.isfinite(low), low, 0)[:, np.newaxis]
    i, j = np.floor((pieces - low) / side).astype(np.int64)
    # Points too far out stand beside no piece, and their numbers need no more bits than the grid.
    most = int(max(i.max(initial=0), j.max(initial=0))) + 4
    cells = np.minimum(np.floor((points - low) / side), most - 2).astype(np.int64)
    keys, owners = _neighbours(cells, most)
    return _joined(keys, owners, (i + 1) * most + j + 1)


def _in_cones(pieces: Array, places: Array, lamp: Array, thick: float) -> tuple[Indices, Indices]:
    """Return pairs of points and pieces that are in neighbouring cones of a lamp at 0."""
    ways, ball = places - lamp[:, np.newaxis], _ball(thick)
    far = np.sqrt(np.einsum("ij,ij->j", pieces, pieces))
    # Cells of a width of 1/4, 1/8, ... of a radian on the faces of a cube, by the distance.
    width = STRETCH * ball / np.maximum(far - ball, 1e-9)
    fine = np.minimum(np.floor(-np.log2(width)), FINEST).astype(np.int64)
    near = np.flatnonzero(fine < COARSEST)
    pairs = [(np.repeat(np.arange(ways.shape[1]), len(near)), np.tile(near, ways.shape[1]))]
    axis = np.abs(pieces).argmax(axis=0)
    for number in range(6):
        a, sign = number // 2, 1 - 2 * (number % 2)
        sides = [(a + 1) % 3, (a + 2) % 3]
        of_face = np.flatnonzero((axis == a) & (sign * pieces[a] > 0) & (fine >= COARSEST))
        ahead = np.flatnonzero(sign * ways[a] > 0)
        spots, angles = (
            np.arctan(rows[sides][:, some] / (sign * rows[a, some]))
            for rows, some in ((ways, ahead), (pieces, of_face))
        )
        for level in np.unique(fine[of_face]):
            some = np.flatnonzero(fine[of_face] == level)
            size, middle = 2.0 ** -float(level), 1 << int(level) + 1
            # Two cells more on each side, where cones of other faces reach over the edge.
            beside = np.flatnonzero((np.abs(spots) < np.pi / 4 + 2 * size).all(axis=0))
            cells = np.floor(spots[:, beside] / size).astype(np.int64) + middle
            i, j = np.floor(angles[:, some] / size).astype(np.int64) + middle
            first, second = _joined(*_neighbours(cells, 2 * middle), (i + 1) * 2 * middle + j + 1)
            pairs.append((ahead[beside[first]], of_face[some[second]]))
    points, others = (np.concatenate(rows) for rows in zip(*pairs, strict=True))
    # Pieces well behind a point stop no ray, nor do they belong to a line through its start.
    before = far[others] < np.sqrt((ways * ways).sum(axis=0))[points] + BEHIND
    return points[before], others[before]


def _neighbours(cells: Indices, most: int) -> tuple[Indices, Indices]:
    """Return the numbers of the cells around those of points, and the points."""
    keys = [(cells[0] + a) * most + cells[1] + b for a in range(3) for b in range(3)]
    return np.concatenate(keys), np.tile(np.arange(cells.shape[1]), 9)


def _joined(keys: Indices, owners: Indices, cells: Indices) -> tuple[Indices, Indices]:
    """Return the pairs of points and pieces with equal numbers of cells."""
    # A table of bits first: few pieces are beside one of the points.
    table, mask = np.zeros(1 << TABLE, np.bool_), (1 << TABLE) - 1
    table[keys & mask] = True
    pieces = np.flatnonzero(table[cells & mask])
    order = np.argsort(keys, kind="stable")
    first, last = (np.searchsorted(keys[order], cells[pieces], side) for side in ("left", "right"))
    counts = last - first
    total = np.cumsum(counts)
    place = np.arange(counts.sum()) - np.repeat(total - counts - first, counts)
    return owners[order[place]], np.repeat(pieces, counts)


class _Passages(NamedTuple):
    """Ways of rays through lines: the point and the start of each ray, the line, both ends."""

    point: Indices
    start: Indices
    line: Indices
    first: Array
    last: Array

    def chosen(self, some: Indices) -> _Passages:
        """Return some of the ways."""
        point, start, line = self.point[some], self.start[some], self.line[some]
        return _Passages(point, start, line, self.first[some], self.last[some])


def _passages(
    medium: Medium, places: Array, way: Array, starts: Array, side: Array,
    pairs: tuple[Indices, Indices], thick: float,
) -> _Passages:  # fmt: skip
    """Return the ways of rays through lines, pieces that follow one another taken together."""
    point, piece = pairs
    toward, out = way[:, point], medium.middles[:, piece] - places[:, point]
    vector = medium.vectors[:, piece].astype(np.float64)
    length = np.sqrt(np.einsum("ij,ij->j", vector, vector))
    tangent = vector / length
    cosine = np.einsum("ij,ij->j", tangent, toward)
    normal = np.cross(tangent, toward, axis=0)
    sine = np.sqrt(np.einsum("ij,ij->j", normal, normal))
    along, beside = sine < LEAST_SINE, np.maximum(sine, LEAST_SINE)
    rows = []
    for number, start in enumerate(starts):
        q = out - start * side[:, point]
        x, y = np.einsum("ij,ij->j", q, toward), np.einsum("ij,ij->j", q, tangent)
        away = q - x * toward
        # Of a ray along a line, the distance between both in place of a quotient of zeros.
        gap = np.where(
            along,
            np.sqrt(np.einsum("ij,ij->j", away, away)),
            np.abs(np.einsum("ij,ij->j", q, normal)) / beside,
        )
        met = np.flatnonzero(gap < thick / 2)
        s, c = beside[met], cosine[met]
        half = np.where(along[met], np.inf, np.sqrt(thick**2 / 4 - gap[met] ** 2) / s)
        middle = np.where(along[met], x[met], (x[met] - c * y[met]) / s**2)
        slant = np.maximum(np.abs(c), 1e-12)
        level, deep = y[met] * np.sign(c) / slant, length[met] / (2 * slant)
        # Square to the axis a ray stays between the planes of both ends, or outside of them.
        first = np.maximum(middle - half, level - deep)
        last = np.minimum(middle + half, level + deep)
        through = first < last
        met = met[through]
        rows.append(
            (point[met], np.full(len(met), number), medium.line[piece[met]].astype(np.int64),
             first[through], last[through])
        )  # fmt: skip
    hits = _Passages(*(np.concatenate(parts) for parts in zip(*rows, strict=True)))
    order = np.lexsort((hits.first, hits.line, hits.start, hits.point))
    hits = hits.chosen(order)
    if not len(order):
        return hits
    new: Bools = np.ones(len(order), np.bool_)
    # At a bend the cylinders of two pieces leave a gap.
    new[1:] = hits.first[1:] > hits.last[:-1] + thick
    for row in hits[:3]:
        new[1:] |= row[1:] != row[:-1]
    at = np.flatnonzero(new)
    last = np.maximum.reduceat(hits.last, at)
    return hits.chosen(at)._replace(last=last)


def _beside(
    medium: Medium, places: Array, way: Array, pairs: tuple[Indices, Indices], thick: float
) -> tuple[Indices, Indices]:
    """Return the pairs of a piece of some length with its axis near the ray of the point."""
    point, piece = pairs
    out = medium.middles[:, piece] - places[:, point].astype(np.float32)
    vector, toward = medium.vectors[:, piece], way[:, point].astype(np.float32)
    normal = np.cross(vector, toward, axis=0)
    square = np.einsum("ij,ij->j", normal, normal)
    # A ray starts at most 3/8 of a diameter beside its point. Of a ray along a line, 0 is left.
    close = np.abs(np.einsum("ij,ij->j", out, normal)) <= thick * np.sqrt(square) + ROUNDING
    some = np.flatnonzero(close & (np.abs(vector).max(axis=0, initial=0) > 0))
    return point[some], piece[some]


def _own_lines(
    medium: Medium, places: Array, pairs: tuple[Indices, Indices], thick: float
) -> Indices:
    """Return the lines through points, as numbers of points and lines."""
    point, piece = pairs
    out = places[:, point] - medium.middles[:, piece]
    vector = medium.vectors[:, piece]
    square = np.maximum(np.einsum("ij,ij->j", vector, vector), 1e-30)
    foot = np.clip(np.einsum("ij,ij->j", out, vector) / square, -0.5, 0.5)
    gap = np.sqrt(((out - foot * vector) ** 2).sum(axis=0))
    on = gap <= ON_AXIS * thick + ROUNDING
    keys: Indices = point[on] * _lines(medium) + medium.line[piece[on]]
    return np.unique(keys)
