"""Rings of vertices, one after the other: their walk around samples, and fewer vertices of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from vizlight._types import Array, Bools, Indices

#: Largest distance in pixels of a border from what is written of it where it is seen; and in
#: samples, between two surfaces, where a straight border is a stair of samples.
SEEN, STAIR = 0.1, 0.6
#: Weights of the vertices before and behind one between two surfaces, where no interpolation makes
#: a border smooth.
WEIGHTS = (1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16)
#: Farthest from the ends of its edge that a border crosses it, so that no vertex is met twice.
END = 0.02
#: Edge of a square of samples at which a border enters and leaves, by the corners inside (1, 2, 4
#: and 8 from the upper left, clockwise): 0 the upper edge, 1 the right, 2 the lower, 3 the left.
#: The inside is at the right hand. Two opposite corners are joined: of two faces that cross, the
#: later passes over the earlier.
WAYS: dict[int, tuple[tuple[int, int], ...]] = {
    1: ((0, 3),), 2: ((1, 0),), 3: ((1, 3),), 4: ((2, 1),), 6: ((2, 0),), 7: ((2, 3),),
    8: ((3, 2),), 9: ((0, 2),), 11: ((1, 2),), 12: ((3, 1),), 13: ((0, 1),), 14: ((3, 0),),
    5: ((0, 1), (2, 3)), 10: ((1, 2), (3, 0)),
}  # fmt: skip
#: Those edges by way (two corners may have two), enter or leave, and corners; -1 for none.
TURNS = np.full((2, 2, 16), -1)
for _code, _ways in WAYS.items():
    TURNS[: len(_ways), :, _code] = _ways
#: Area in square pixels below which a ring is left out.
SPECK = 0.2
#: Vertices that move alike.
AROUND = 9


class Rings(NamedTuple):
    """Rings between samples, one after the other.

    ``area`` is the number of the area inside, ``inner`` and ``outer`` are the samples between which
    a vertex lies, ``starts`` has the first vertex of each ring, and the end.
    """

    area: Indices
    inner: Indices
    outer: Indices
    starts: Indices


def squares(labels: NDArray[np.int32]) -> tuple[Indices, NDArray[np.int32]]:
    """Return the upper left samples of squares of several labels, and the four labels of each."""
    corner = labels[:-1, :-1], labels[:-1, 1:], labels[1:, 1:], labels[1:, :-1]
    mixed = (corner[0] != corner[1]) | (corner[1] != corner[2]) | (corner[2] != corner[3])
    row, column = np.nonzero(mixed)
    return row * labels.shape[1] + column, np.stack([part[row, column] for part in corner], axis=1)


def traced(at: Indices, area: Indices, inside: Bools, labels: NDArray[np.int32]) -> Rings:
    """Return the rings around areas.

    ``at`` has the upper left samples of squares, each as often as borders of areas pass it,
    ``area`` the number of the area, and ``inside`` (n, 4) masks the corners that are of it.
    """
    size, width = labels.size, labels.shape[1]
    code = inside @ np.array([1, 2, 4, 8])
    way, row = np.nonzero(TURNS[:, 0, code] >= 0)
    corners = at[:, np.newaxis] + np.array([0, 1, width + 1, width, 0])
    enter, leave = TURNS[way, :, code[row]].T
    # A border is known by its area and by the pair of samples that it passes between.
    head, tail = (
        np.minimum(a, b) + size * (np.abs(a - b) > 1) + 2 * size * area[row].astype(np.int64)
        for a, b in ((corners[row, edge], corners[row, edge + 1]) for edge in (enter, leave))
    )
    order = np.argsort(head)
    walk, starts = walked(np.searchsorted(head[order], tail[order]))
    row, enter = row[order[walk]], enter[order[walk]]
    first, second = corners[row, enter], corners[row, enter + 1]
    is_inner = inside[row, enter]
    inner, outer = np.where(is_inner, (first, second), (second, first))
    return Rings(area[row], inner, outer, starts)


def vertices(
    rings: Rings, samples: Array, mine: Array, its: Array, jump: float
) -> tuple[Array, Bools]:
    """Return the vertices of rings in samples, and which of them are between two surfaces.

    The difference of the squared distances from the colours of both sides is linear in a colour.

    ``mine`` and ``its`` are the colours (n, c) of the areas inside and outside; samples that differ
    by more than ``jump`` in a channel are of two surfaces.
    """
    width = samples.shape[1]
    flat = samples.reshape(-1, samples.shape[2])
    inside, outside = (flat[at].astype(np.float64) for at in (rings.inner, rings.outer))
    sharp = np.abs(inside - outside).max(axis=1) > jump
    balance, span = (
        np.einsum("ij,ij->i", its - mine, ends)
        for ends in (its + mine - 2 * inside, 2 * (outside - inside))
    )
    smooth = (span > 0) & ~sharp
    share = np.where(smooth, balance / np.where(smooth, span, 1), 0.5)
    begin, end = (np.stack([at % width, at // width], 1) for at in (rings.inner, rings.outer))
    points = begin + np.clip(share, END, 1 - END)[:, np.newaxis] * (end - begin)
    return smoothed(points, sharp, rings.starts), sharp


def beneath(
    points: Array, starts: Indices, labels: NDArray[np.int32], cover: Indices,
    reaches: Sequence[float], parts: Sequence[float], scale: int,
) -> tuple[Array, Array]:  # fmt: skip
    """Return vertices in samples, moved beneath areas that cover them, and distances in pixels.

    ``cover`` is the least label that covers each vertex, 0 where it is seen; ``reaches`` are
    distances in pixels to the inside, or below 0 to the outside, tried from the first, and labels
    are compared at ``parts`` of a distance.
    """
    span = np.maximum(np.minimum(np.diff(starts), 4 * scale) // 3, 1)
    way = points[shifted(starts, span)] - points[shifted(starts, -span)]
    length = np.hypot(way[:, 0], way[:, 1])
    # The inside is at the right hand of the way on paper, whose rows run downward.
    inward = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.maximum(length, 1e-9)[:, np.newaxis]
    moved = np.zeros(len(points))
    left = np.flatnonzero(cover)
    top = np.array(labels.shape)[::-1] - 1
    for reach in reaches:
        covered = np.ones(len(left), dtype=np.bool_)
        for part in parts:
            trial = points[left] + part * reach * scale * inward[left]
            at = np.clip(np.rint(trial), 0, top).astype(np.intp)
            covered &= labels[at[:, 1], at[:, 0]] >= cover[left]
        moved[left[covered]] = abs(reach)
        left = left[~covered]
    # The mean of the least around: a border without teeth takes few vertices.
    least = scipy.ndimage.minimum_filter1d(moved, AROUND)
    moved = np.asarray(scipy.ndimage.uniform_filter1d(least, AROUND))
    way = np.sign(reaches[0]) * inward
    return points + scale * moved[:, np.newaxis] * way, moved


def corners_of(points: Array, starts: Indices, limit: Array) -> list[Array]:
    """Return the corners of rings that are kept within limits; none of those that are specks.

    Vertices are in pixels; ``limit`` is the largest distance of each.
    """
    kept = simplified(points, starts, limit)
    ends = np.cumsum(np.add.reduceat(kept, starts[:-1]))
    rings = np.split(points[kept], ends[:-1])
    return [ring if len(ring) > 2 and abs(area_of(ring)) > SPECK else ring[:0] for ring in rings]


def area_of(ring: Array) -> float:
    """Return the area within a ring, negative where it runs around a hole.

    The inside is at the right hand on paper, whose rows run downward.
    """
    x, y = (ring - ring[0]).T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def walked(follows: Indices) -> tuple[Indices, Indices]:
    """Return the numbers of segments ring after ring, and where each ring begins.

    ``follows`` is the number of the segment after each.
    """
    ahead = follows.tolist()
    seen = bytearray(len(ahead))
    walk, starts = [], [0]
    for begin in range(len(ahead)):
        at = begin
        if seen[at]:
            continue
        while not seen[at]:
            seen[at] = 1
            walk.append(at)
            at = ahead[at]
        starts.append(len(walk))
    return np.array(walk, dtype=np.intp), np.array(starts, dtype=np.intp)


def smoothed(points: Array, sharp: Bools, starts: Indices) -> Array:
    """Return vertices, those between two surfaces as means of five that follow each other.

    ``sharp`` masks the vertices between two surfaces.
    """
    count = np.ones(len(starts) - 1, dtype=np.intp)
    every = [shifted(starts, step * count) for step in range(-2, 3)]
    mean = sum(w * points[at] for w, at in zip(WEIGHTS, every, strict=True))
    within = np.logical_and.reduce([sharp[at] for at in every])
    return np.where(within[:, np.newaxis], mean, points)


def shifted(starts: Indices, steps: Indices) -> Indices:
    """Return for each vertex of rings the number of the one some steps ahead in its ring."""
    lengths = np.diff(starts)
    first = np.repeat(starts[:-1], lengths)
    place = np.arange(starts[-1]) - first
    size = np.repeat(lengths, lengths)
    ahead: Indices = first + (place + np.repeat(steps, lengths)) % size
    return ahead


def simplified(points: Array, starts: Indices, limit: Array) -> Bools:
    """Return which vertices of rings are kept: others are within limits of the lines between them.

    It is the method of Douglas and Peucker for all rings at once, a round for each halving.

    ``limit`` is the largest distance of each vertex.
    """
    lengths = np.diff(starts)
    first = np.repeat(starts[:-1], lengths)
    # The start of each ring, and the vertex farthest from it.
    away = np.linalg.norm(points - points[first], axis=1)
    kept = np.zeros(len(points), dtype=np.bool_)
    kept[starts[:-1]] = True
    kept[_largest(away, starts)] = True
    active = np.flatnonzero(~kept)
    while len(active):
        anchors = np.flatnonzero(kept)
        segment = np.searchsorted(anchors, active) - 1
        begin = anchors[segment]
        # The last segment of a ring ends where the ring begins.
        after = np.append(anchors[1:], len(points))[segment]
        bound = starts[np.searchsorted(starts, begin, side="right")]
        end = np.where(after < bound, after, first[begin])
        away = _distance(points[active], points[begin], points[end]) / limit[active]
        bounds = np.flatnonzero(np.diff(segment, prepend=-1))
        farthest = np.maximum.reduceat(away, bounds)
        sizes = np.diff(np.append(bounds, len(active)))
        split = np.repeat(farthest > 1, sizes)
        chosen = _largest(away, np.append(bounds, len(active)))
        kept[active[chosen[farthest > 1]]] = True
        split[chosen] = False
        active = active[split]
    return kept


def _largest(values: Array, starts: Indices) -> Indices:
    """Return where each run of values is largest."""
    lengths = np.diff(starts)
    run = np.repeat(np.arange(len(lengths)), lengths)
    top = np.maximum.reduceat(values, starts[:-1])
    places = np.flatnonzero(values == top[run])
    first: Indices = np.unique(run[places], return_index=True)[1]
    return places[first]


def _distance(points: Array, begin: Array, end: Array) -> Array:
    """Return the distances of points from segments."""
    way, away = end - begin, points - begin
    square = np.einsum("ij,ij->i", way, way)
    share = np.einsum("ij,ij->i", away, way) / np.where(square > 0, square, 1)
    away -= np.clip(share, 0, 1)[:, np.newaxis] * way
    distance: Array = np.sqrt(np.einsum("ij,ij->i", away, away))
    return distance
