"""Rings of vertices, one after the other: their walk around samples, and fewer vertices of them."""

from __future__ import annotations

import numpy as np

from vizlight._types import Array, Bools, Indices

__all__ = ["END", "SEEN", "STAIR", "WAYS", "area_of", "shifted", "simplified", "smoothed", "walked"]

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


def area_of(ring: Array) -> float:
    """Return the area within a ring, negative where it runs around a hole.

    Parameters
    ----------
    ring : ndarray, shape (n, 2)
        Vertices, the inside at the right hand on paper, whose rows run downward.
    """
    x, y = (ring - ring[0]).T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def walked(follows: Indices) -> tuple[Indices, Indices]:
    """Return the numbers of segments ring after ring, and where each ring begins.

    Parameters
    ----------
    follows : ndarray of int, shape (n,)
        Number of the segment after each.

    Returns
    -------
    walk : ndarray of int, shape (n,)
    starts : ndarray of int, shape (r + 1,)
        First of each ring in the walk, and the end.
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

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Vertices, ring after ring.
    sharp : ndarray of bool, shape (n,)
        Mask of those between two surfaces.
    starts : ndarray of int, shape (r + 1,)
        First vertex of each ring, and the end.
    """
    count = np.ones(len(starts) - 1, dtype=np.intp)
    every = [shifted(starts, step * count) for step in range(-2, 3)]
    mean = sum(w * points[at] for w, at in zip(WEIGHTS, every, strict=True))
    within = np.logical_and.reduce([sharp[at] for at in every])
    return np.where(within[:, np.newaxis], mean, points)


def shifted(starts: Indices, steps: Indices) -> Indices:
    """Return for each vertex of rings the number of the one some steps ahead in its ring.

    Parameters
    ----------
    starts : ndarray of int, shape (r + 1,)
        First vertex of each ring, and the end.
    steps : ndarray of int, shape (r,)
        Steps in each ring.
    """
    lengths = np.diff(starts)
    first = np.repeat(starts[:-1], lengths)
    place = np.arange(starts[-1]) - first
    size = np.repeat(lengths, lengths)
    ahead: Indices = first + (place + np.repeat(steps, lengths)) % size
    return ahead


def simplified(points: Array, starts: Indices, limit: Array) -> Bools:
    """Return which vertices of rings are kept: others are within limits of the lines between them.

    It is the method of Douglas and Peucker for all rings at once, a round for each halving.

    Parameters
    ----------
    points : ndarray, shape (N, d)
        Vertices, ring after ring.
    starts : ndarray of int
        Where each ring begins, and the end of the last.
    limit : ndarray, shape (N,)
        Largest distance of each vertex.
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
