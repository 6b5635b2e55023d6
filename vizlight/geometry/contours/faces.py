"""A picture of samples as faces of one colour each, with smooth borders.

Each sample has the colour of the palette that is nearest to its own; a face is all that has one
colour. Faces are painted in the order of the palette, each reaching a little beneath those that
come later, so that no gap shows between them at any scale. It is the rendering by filled
polygons in the painter's order of Conway and Cottingham, The Isoluminance Contour Model, for any
surface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import scipy

from vizlight.geometry.contours.palette import JUMP, Palette

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vizlight._types import Array, Bools, Indices

__all__ = ["SEEN", "Face", "faces", "simplified"]

#: Reach of a face beneath a later one, in pixels: tried from the largest.
REACHES = (1.5, 1.0, 0.6, 0.3)
#: Largest distance in pixels of a border from what is written of it where it is seen, and where a
#: later face hides it as a share of its reach.
SEEN, SLACK = 0.1, 0.55
#: The same, in samples, between two surfaces, where a straight border is a stair of samples.
STAIR = 0.6
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


class Face(NamedTuple):
    """All that has one colour.

    Attributes
    ----------
    color : ndarray, shape (c,)
    rings : list of ndarray, shape (n, 2)
        Closed rings in pixels from the upper left, the first point not repeated. The inside is at
        the right hand, so that holes run the other way.
    """

    color: Array
    rings: list[Array]


class Borders(NamedTuple):
    """Rings of borders, one after the other.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        Vertices in samples of the padded picture.
    face : ndarray of int, shape (n,)
        Face at the right hand of each.
    other : ndarray of int, shape (n,)
        Face at the left hand; -1 outside of the picture.
    starts : ndarray of int, shape (r + 1,)
        First vertex of each ring, and the end.
    sharp : ndarray of bool, shape (n,)
        Mask of the vertices at which colours jump.
    """

    points: Array
    face: Indices
    other: Indices
    starts: Indices
    sharp: Bools


def faces(palette: Palette, samples: Array, scale: int) -> Iterator[Face]:
    """Yield the faces of samples in the order in which they are painted.

    Parameters
    ----------
    palette : Palette
        Colours of the samples.
    samples : ndarray, shape (rows, columns, c)
    scale : int
        Samples for each pixel, along a side.

    Yields
    ------
    Face
        Background has none. A border that is seen is within 0.1 pixels of its place between
        samples, at which colours that change steadily are crossed linearly; where two surfaces meet
        it is half way between two samples.
    """
    if not np.any(palette.labels):
        return
    inner = scipy.ndimage.binary_erosion(palette.labels > 0, iterations=scale)
    if palette.error >= 0 and inner.any():
        # Specks between three faces show the mean colour in place of the background's.
        mean = np.mean(palette.colors[palette.labels[inner]], axis=0)
        under = Palette(
            np.array([[0.0], [1.0]]), np.stack([mean, mean]), inner.astype(np.int32), -1
        )
        yield from faces(under, 255 * inner[..., np.newaxis].astype(np.float32), scale)
    padded = np.pad(palette.labels, 1, constant_values=-1)
    borders = _borders(padded, samples, palette)
    points, reach = _spread(borders, padded, scale)
    pixels = (points - 0.5) / scale
    limit = np.where(borders.sharp, max(SEEN, STAIR / scale), SEEN)
    kept = simplified(pixels, borders.starts, np.maximum(limit, SLACK * reach))
    which = borders.face[borders.starts[:-1]]
    for face in range(1, len(palette.colors)):
        rings: list[Array] = []
        for ring in np.flatnonzero(which == face):
            first, last = borders.starts[ring : ring + 2]
            corners = pixels[first:last][kept[first:last]]
            if len(corners) > 2:
                rings.append(corners)
        if rings:
            yield Face(palette.colors[face], rings)


def _borders(padded: NDArray[np.int32], samples: Array, palette: Palette) -> Borders:
    """Return the rings around all faces but the background."""
    width = padded.shape[1]
    corner = padded[:-1, :-1], padded[:-1, 1:], padded[1:, 1:], padded[1:, :-1]
    mixed = (corner[0] != corner[1]) | (corner[1] != corner[2]) | (corner[2] != corner[3])
    row, column = np.nonzero(mixed)
    labels = np.stack([part[row, column] for part in corner], axis=1)
    at = row * width + column
    corners = at[:, np.newaxis] + np.array([0, 1, width + 1, width])
    first, last, face = _segments(labels, corners)
    # A border is known by the face and by the pair of samples that it passes between.
    face_number = face.astype(np.int64) * (2 * padded.size)
    heads, tails = face_number + _edge(first, padded.size), face_number + _edge(last, padded.size)
    order = np.argsort(heads)
    follows = np.searchsorted(heads[order], tails[order])
    walk, starts = _walk(follows.tolist())
    chosen = order[walk]
    first, face = first[chosen], face[chosen]
    other = padded.ravel()[first[:, 1]].astype(np.intp)
    row, column = np.divmod(first, width)
    within = other >= 0
    colors = samples[row[within] - 1, column[within] - 1].astype(np.float64)
    share, sharp = np.full(len(first), 0.5), np.zeros(len(first), dtype=np.bool_)
    share[within] = _crossings(colors, *(palette.centres[side[within]] for side in (face, other)))
    step = np.abs(colors[:, 0] - colors[:, 1]).max(axis=1)
    sharp[within] = step > JUMP * max(palette.error, 0.5)
    ends = np.stack([column, row], axis=2).astype(np.float64)
    points = ends[:, 0] + share[:, np.newaxis] * (ends[:, 1] - ends[:, 0])
    return Borders(_smoothed(points, sharp, starts), face, other, starts, sharp)


def _segments(labels: NDArray[np.int32], corners: Indices) -> tuple[Indices, Indices, Indices]:
    """Return pairs of samples, inside and outside, between which borders enter and leave squares.

    Parameters
    ----------
    labels, corners : ndarray of int, shape (n, 4)
        Faces and numbers of the samples at the corners of squares.

    Returns
    -------
    first, last : ndarray of int, shape (m, 2)
    face : ndarray of int, shape (m,)
    """
    firsts: list[Indices] = []
    lasts: list[Indices] = []
    face: list[Indices] = []
    bits = np.array([1, 2, 4, 8])
    for place in range(4):
        label = labels[:, place]
        new = label > 0
        for before in range(place):
            new &= labels[:, before] != label
        rows = np.flatnonzero(new)
        label = label[rows]
        inside = labels[rows] == label[:, np.newaxis]
        code = inside @ bits
        for number, ways in WAYS.items():
            here = np.flatnonzero(code == number)
            if not len(here):
                continue
            for enter, leave in ways:
                picked = rows[here]
                for edge, ends in ((enter, firsts), (leave, lasts)):
                    a, b = edge, (edge + 1) % 4
                    swap = not inside[here[0], a]
                    pair = corners[picked][:, [b, a] if swap else [a, b]]
                    ends.append(pair)
                face.append(label[here].astype(np.intp))
    return np.concatenate(firsts), np.concatenate(lasts), np.concatenate(face)


def _edge(pair: Indices, size: int) -> Indices:
    """Return a number for each pair of neighbouring samples, whatever its order."""
    low = pair.min(axis=1)
    number: Indices = low + size * (np.abs(pair[:, 1] - pair[:, 0]) > 1)
    return number


def _walk(follows: list[int]) -> tuple[Indices, Indices]:
    """Return the numbers of segments ring after ring, and where each ring begins."""
    seen = bytearray(len(follows))
    walk, starts = [], [0]
    for begin in range(len(follows)):
        at = begin
        if seen[at]:
            continue
        while not seen[at]:
            seen[at] = 1
            walk.append(at)
            at = follows[at]
        starts.append(len(walk))
    return np.array(walk, dtype=np.intp), np.array(starts, dtype=np.intp)


def _crossings(colors: Array, mine: Array, its: Array) -> Array:
    """Return the shares of the ways from samples to others at which the colours of faces balance.

    The difference of the squared distances from two colours is linear in a colour.

    Parameters
    ----------
    colors : ndarray, shape (n, 2, c)
        Colours of the samples inside and outside.
    mine, its : ndarray, shape (n, c)
        Colours of the faces of both.
    """
    way, middle = (its - mine)[:, np.newaxis], (its + mine)[:, np.newaxis]
    balance = np.sum(way * (middle - 2 * colors), axis=2)
    span = balance[:, 0] - balance[:, 1]
    share = np.where(span > 0, balance[:, 0] / np.where(span > 0, span, 1), 0.5)
    return np.clip(share, END, 1 - END)


def _smoothed(points: Array, sharp: Bools, starts: Indices) -> Array:
    """Return vertices, those between two surfaces as means of five that follow each other."""
    count = np.ones(len(starts) - 1, dtype=np.intp)
    every = [_shifted(starts, step * count) for step in range(-2, 3)]
    mean = sum(w * points[at] for w, at in zip(WEIGHTS, every, strict=True))
    within = np.logical_and.reduce([sharp[at] for at in every])
    return np.where(within[:, np.newaxis], mean, points)


def _spread(borders: Borders, padded: NDArray[np.int32], scale: int) -> tuple[Array, Array]:
    """Return the vertices of borders, moved into later faces that cover them, and the distances.

    Vertices are in samples, distances in pixels.
    """
    points, starts = borders.points, borders.starts
    span = np.maximum(np.minimum(np.diff(starts), 4 * scale) // 3, 1)
    way = points[_shifted(starts, span)] - points[_shifted(starts, -span)]
    length = np.hypot(way[:, 0], way[:, 1])
    # The inside is at the right hand of the way on paper, whose rows run downward.
    out = np.stack([way[:, 1], -way[:, 0]], axis=1) / np.maximum(length, 1e-9)[:, np.newaxis]
    hidden = borders.other > borders.face
    moved = np.where(hidden, 0.0, np.inf)
    left = np.flatnonzero(hidden)
    top = np.array(padded.shape)[::-1] - 1
    for reach in REACHES:
        covered = np.ones(len(left), dtype=np.bool_)
        for part in (0.5, 1.0):
            trial = points[left] + part * reach * scale * out[left]
            at = np.clip(np.rint(trial), 0, top).astype(np.intp)
            covered &= padded[at[:, 1], at[:, 0]] > borders.face[left]
        moved[left[covered]] = reach
        left = left[~covered]
    # The least of five that follow each other: a border without teeth takes few vertices.
    unit = np.ones_like(span)
    least = np.minimum.reduce([moved[_shifted(starts, step * unit)] for step in range(-2, 3)])
    moved = np.where(hidden, least, 0.0)
    return points + scale * moved[:, np.newaxis] * out, moved


def _shifted(starts: Indices, steps: Indices) -> Indices:
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

    Parameters
    ----------
    points : ndarray, shape (N, 2)
        Vertices, ring after ring.
    starts : ndarray of int
        Where each ring begins, and the end of the last.
    limit : ndarray, shape (N,)
        Largest distance of each vertex.
    """
    lengths = np.diff(starts)
    first = np.repeat(starts[:-1], lengths)
    # The start of each ring, and the vertex farthest from it.
    away = np.hypot(*(points - points[first]).T)
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
    return np.hypot(away[:, 0], away[:, 1])
