"""A picture of samples as faces of one colour each, with smooth borders.

Each sample has the colour of the palette that is nearest to its own; a face is all that has one
colour. Faces are painted in the order of the palette, each reaching a little beneath those that
come later, so that no gap shows between them at any scale. It is the rendering by filled
polygons in the painter's order of Conway and Cottingham, The Isoluminance Contour Model, for any
surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vizlight._types import Array, Bools, Indices
from vizlight.geometry.contours.palette import JUMP, Palette
from vizlight.geometry.contours.rings import (
    END,
    SEEN,
    STAIR,
    WAYS,
    area_of,
    shifted,
    simplified,
    smoothed,
    walked,
)
from vizlight.geometry.contours.steady import slopes

__all__ = ["Face", "faces"]

#: Samples around those of the picture.
PAD = 2
#: Reach of a face beneath a later one, in pixels: tried from the largest.
REACHES = (1.5, 1.0, 0.6, 0.3)
#: Largest distance of a border from what is written of it where a later face hides it, as a share
#: of its reach.
SLACK = 0.55
#: Largest distance that a tolerance of colours allows.
BROAD = 1.0


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
    slope : ndarray, shape (n,)
        Largest change of a channel per pixel.
    """

    points: Array
    face: Indices
    other: Indices
    starts: Indices
    sharp: Bools
    slope: Array


def faces(palette: Palette, samples: Array, scale: int, tolerance: float = 0.0) -> Iterator[Face]:
    """Yield the faces of samples in the order in which they are painted.

    Parameters
    ----------
    palette : Palette
        Colours of the samples.
    samples : ndarray, shape (rows, columns, c)
    scale : int
        Samples for each pixel, along a side.
    tolerance : float
        Difference of colours up to which a border may lie where samples have others than it.

    Yields
    ------
    Face
        Background has none. A border that is seen is within 0.1 pixels of its place between
        samples, at which colours that change steadily are crossed linearly; where two surfaces meet
        it is half way between two samples.
    """
    if not np.any(palette.labels):
        return
    rows, columns = palette.labels.shape
    shown = palette.labels > 0
    # Specks between three faces show the mean colour; the background covers the rest.
    mean = np.mean(palette.colors[palette.labels[shown]], axis=0)
    box = np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)]) / scale
    yield Face(mean, [box])
    last = len(palette.colors)
    padded = np.pad(np.where(shown, palette.labels, np.int32(last)), 1, mode="edge")
    padded = np.pad(padded, 1, constant_values=last)
    borders = _borders(padded, samples, palette, scale)
    points, reach = _spread(borders, padded, scale)
    pixels = (points - PAD + 0.5) / scale
    limit = np.clip(tolerance / np.maximum(borders.slope, 1e-6), SEEN, BROAD)
    limit = np.where(borders.sharp, max(SEEN, STAIR / scale), limit)
    kept = simplified(pixels, borders.starts, np.maximum(limit, SLACK * reach))
    which = borders.face[borders.starts[:-1]]
    # What is painted later covers a hole all around which it lies.
    later = np.logical_and.reduceat(borders.other > borders.face, borders.starts[:-1])
    for face in range(1, last + 1):
        rings: list[Array] = []
        for ring in np.flatnonzero(which == face):
            span = slice(*borders.starts[ring : ring + 2])
            corners = pixels[span][kept[span]]
            if len(corners) > 2 and not (later[ring] and area_of(corners) < 0):
                rings.append(corners)
        if face == last:
            rings.insert(0, box)
        if rings:
            yield Face(palette.colors[face % last], rings)


def _borders(padded: NDArray[np.int32], samples: Array, palette: Palette, scale: int) -> Borders:
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
    walk, starts = walked(follows)
    chosen = order[walk]
    first, face = first[chosen], face[chosen]
    other = padded.ravel()[first[:, 1]].astype(np.intp)
    row, column = np.divmod(first, width)
    # Those beyond the border are as those at it.
    within = tuple(
        np.clip(at - PAD, 0, count - 1)
        for at, count in zip((row, column), samples.shape[:2], strict=True)
    )
    colors = samples[within].astype(np.float64)
    kinds = len(palette.centres)
    share = _crossings(colors, *(palette.centres[side % kinds] for side in (face, other)))
    step = np.abs(colors[:, 0] - colors[:, 1]).max(axis=1)
    sharp = step > JUMP * max(palette.error, 0.5)
    ends = np.stack([column, row], axis=2).astype(np.float64)
    points = ends[:, 0] + share[:, np.newaxis] * (ends[:, 1] - ends[:, 0])
    slope = slopes(samples, scale)[within].max(axis=1)
    return Borders(smoothed(points, sharp, starts), face, other, starts, sharp, slope)


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


def _spread(borders: Borders, padded: NDArray[np.int32], scale: int) -> tuple[Array, Array]:
    """Return the vertices of borders, moved into later faces that cover them, and the distances.

    Vertices are in samples, distances in pixels.
    """
    points, starts = borders.points, borders.starts
    span = np.maximum(np.minimum(np.diff(starts), 4 * scale) // 3, 1)
    way = points[shifted(starts, span)] - points[shifted(starts, -span)]
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
    least = np.minimum.reduce([moved[shifted(starts, step * unit)] for step in range(-2, 3)])
    moved = np.where(hidden, least, 0.0)
    return points + scale * moved[:, np.newaxis] * out, moved
