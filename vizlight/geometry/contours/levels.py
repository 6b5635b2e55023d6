"""A picture of one channel as nested areas, each of all that is at least as light as its level.

Areas are painted from dark to light and the background last, with the surfaces as its holes. Each
border between two levels is then written once, and one painter's order leaves no seam at any scale.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from vizlight._types import Array, Bools, Indices
from vizlight.geometry.contours.faces import Face
from vizlight.geometry.contours.palette import JUMP, Palette
from vizlight.geometry.contours.rings import (
    END,
    STAIR,
    WAYS,
    area_of,
    shifted,
    simplified,
    smoothed,
    walked,
)
from vizlight.geometry.contours.steady import slopes

__all__ = ["levels"]

#: Distance in pixels to which areas reach beneath the background, and share of the distance from
#: it by which their borders there may lie elsewhere.
BENEATH, FREE = 6, 0.6
#: Reach of a border beneath lighter areas, in pixels: tried from the largest; the share of it by
#: which the border may lie elsewhere.
REACHES, SLACK = (5.0, 2.5, 1.2, 0.6), 0.6
#: Parts of the reach at which it is looked for what covers it, and vertices that move alike.
PARTS, AROUND = (0.4, 0.7, 1.0, 1.3, 1.6), 9
#: Pixels between two borders below which not all are drawn.
CROWD = 0.8
#: Least and largest distance that a tolerance of values allows, in pixels.
NEAR, BROAD = 0.2, 1.5
#: Share of the error by which steep borders may be off.
MIXED = 0.9
#: Area in square pixels below which a ring is left out.
SPECK = 0.2


class Rings(NamedTuple):
    """Rings between samples, one after the other.

    Attributes
    ----------
    level : ndarray of int, shape (n,)
        Level that the inside reaches.
    inner, outer : ndarray of int, shape (n,)
        Samples inside and outside, between which a vertex lies.
    starts : ndarray of int, shape (r + 1,)
        First vertex of each ring, and the end.
    """

    level: Indices
    inner: Indices
    outer: Indices
    starts: Indices


def levels(palette: Palette, samples: Array, scale: int, tolerance: float = 0.0) -> Iterator[Face]:
    """Yield the areas of samples in the order in which they are painted, the background last.

    Parameters
    ----------
    palette : Palette
        Colours of the samples, from dark to light.
    samples : ndarray, shape (rows, columns, 1)
    scale : int
        Samples for each pixel, along a side.
    tolerance : float
        Difference from a level that samples may have at its border.

    Yields
    ------
    Face
    """
    if not np.any(palette.labels):
        return
    pad = BENEATH * scale + 2
    rows, columns = palette.labels.shape
    box = np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)]) / scale
    yield Face(palette.colors[1], [box])
    shown = _padded(palette.labels, pad)
    values = np.pad(samples[..., 0], pad, mode="edge")
    labels, depth = _beneath(shown, BENEATH * scale)
    steep = np.pad(slopes(samples, scale), pad, mode="edge").ravel()
    rings = _rings(labels, 1)
    centres = palette.centres[:, 0]
    middle = np.append(0.0, (centres[1:] + centres[:-1]) / 2)
    points, sharp = _vertices(rings, values, middle, palette)
    at = labels.ravel()[rings.inner].astype(np.intp)
    under = depth.ravel()[rings.inner]
    slope = np.maximum(steep[rings.inner], steep[rings.outer])
    cover = _covers(rings.level, at, slope, palette.error, sharp=sharp)
    cover[under > 0] = 0
    points, reach = _drawn_in(rings, points, labels, cover, scale)
    limit = _limits(slope, palette.error, tolerance)
    limit = np.where(sharp, STAIR / scale, limit)
    limit = np.where(under > 0, FREE * under / scale, limit)
    limit = np.maximum(limit, SLACK * reach)
    every = list(_cut(rings, points, limit, pad, scale))
    which = rings.level[rings.starts[:-1]]
    for level in range(2, len(palette.colors)):
        kept = [every[i] for i in np.flatnonzero(which == level) if len(every[i])]
        if kept:
            yield Face(palette.colors[level], kept)
    ground = _rings((shown == 0).astype(np.int32), 0)
    points, sharp = _vertices(ground, values, np.array([0.0, np.nan]), palette)
    limit = np.full(len(points), STAIR / scale)
    kept = [ring for ring in _cut(ground, points, limit, pad, scale) if len(ring)]
    yield Face(palette.colors[0], [box, *kept])


def _padded(labels: NDArray[np.int32], pad: int) -> NDArray[np.int32]:
    """Return labels that reach beyond the picture, where background is around all."""
    wide = np.pad(labels, pad - 1, mode="edge")
    return np.pad(wide, 1)


def _beneath(shown: NDArray[np.int32], reach: int) -> tuple[NDArray[np.int32], NDArray[np.int16]]:
    """Return labels that go on beneath the background, and distances from it in samples."""
    labels = shown.copy()
    flat, width = labels.ravel(), labels.shape[1]
    depth = np.zeros(labels.shape, dtype=np.int16)
    steps = np.array([1, -1, width, -width])
    near = np.zeros(labels.shape, dtype=np.bool_)
    near[1:] |= shown[:-1] > 0
    near[:-1] |= shown[1:] > 0
    near[:, 1:] |= shown[:, :-1] > 0
    near[:, :-1] |= shown[:, 1:] > 0
    near[[0, -1]] = near[:, [0, -1]] = False
    front = np.flatnonzero(near & (shown == 0))
    edge = np.zeros(labels.shape, dtype=np.bool_)
    edge[[0, -1]] = edge[:, [0, -1]] = True
    closed = edge.ravel()
    for layer in range(1, reach + 1):
        beside = flat[front[:, np.newaxis] + steps]
        # The middle of those beside it makes borders straight.
        known = np.sort(np.where(beside > 0, beside, 0), axis=1)
        count = np.count_nonzero(known, axis=1)
        flat[front] = known[np.arange(len(front)), 4 - (count + 1) // 2]
        depth.ravel()[front] = layer
        ahead = np.unique((front[:, np.newaxis] + steps).ravel())
        front = ahead[(flat[ahead] == 0) & ~closed[ahead]]
    return labels, depth


def _rings(labels: NDArray[np.int32], lowest: int) -> Rings:
    """Return the rings around all that is above each level from the lowest on."""
    width = labels.shape[1]
    corner = labels[:-1, :-1], labels[:-1, 1:], labels[1:, 1:], labels[1:, :-1]
    low = np.minimum(np.minimum(corner[0], corner[1]), np.minimum(corner[2], corner[3]))
    high = np.maximum(np.maximum(corner[0], corner[1]), np.maximum(corner[2], corner[3]))
    low = np.maximum(low, lowest)
    row, column = np.nonzero(low < high)
    low, count = low[row, column], (high - low)[row, column]
    square = np.repeat(np.arange(len(row)), count)
    level = low[square] + 1 + np.arange(len(square)) - np.repeat(np.cumsum(count) - count, count)
    at = (row * width + column)[square]
    corners = np.array([0, 1, width + 1, width])
    bits = np.zeros(len(square), dtype=np.int8)
    for i, part in enumerate(corner):
        bits |= (part[row, column][square] >= level).astype(np.int8) << i
    heads: list[Indices] = []
    tails: list[Indices] = []
    inner: list[Indices] = []
    outer: list[Indices] = []
    rank: list[Indices] = []
    for code, ways in WAYS.items():
        here = np.flatnonzero(bits == code)
        for enter, leave in ways:
            ends = []
            for edge in (enter, leave):
                a, b = edge, (edge + 1) % 4
                if not code >> a & 1:
                    a, b = b, a
                ends.append((at[here] + corners[a], at[here] + corners[b]))
            keys = [np.minimum(*pair) + labels.size * (np.abs(pair[0] - pair[1]) > 1)
                    for pair in ends]  # fmt: skip
            heads.append(keys[0] + level[here] * (2 * labels.size))
            tails.append(keys[1] + level[here] * (2 * labels.size))
            inner.append(ends[0][0])
            outer.append(ends[0][1])
            rank.append(level[here])
    head, tail = np.concatenate(heads), np.concatenate(tails)
    order = np.argsort(head, kind="stable")
    follows = order[np.searchsorted(head[order], tail)]
    walk, starts = walked(follows)
    rank_of, inner_of, outer_of = (np.concatenate(part)[walk] for part in (rank, inner, outer))
    return Rings(rank_of, inner_of, outer_of, starts)


def _covers(level: Indices, at: Indices, slope: Array, half: float, *, sharp: Bools) -> Indices:
    """Return the levels whose areas may hide the borders of others, 0 where a border is seen.

    Where several levels cross a pixel, a few are drawn, the highest of them between two surfaces.
    """
    steep = np.maximum(slope * CROWD / (2 * max(half, 1e-6)), 1.0)
    stride = np.left_shift(1, np.log2(steep).astype(np.int64))
    above = (level // stride + 1) * stride
    cover = np.where(level % stride == 0, 0, above)
    return np.where(sharp, np.where(at > level, level + 1, 0), cover)


def _limits(slope: Array, half: float, tolerance: float) -> Array:
    """Return distances in pixels by which borders may be off, from the slopes of the samples.

    Where levels are far apart a sample at the border may differ from its level by the tolerance.
    Where several cross a pixel its mean is what is seen: they leave a part of half a band unused.
    """
    slope, band = np.maximum(slope, 1e-6), 2 * max(half, 1e-6)
    mixed = np.minimum(tolerance / band + slope / (2 * band), MIXED * (half + tolerance) / slope)
    limits: Array = np.clip(np.maximum(tolerance / slope, mixed), NEAR, BROAD)
    return limits


def _vertices(rings: Rings, values: Array, middle: Array, palette: Palette) -> tuple[Array, Bools]:
    """Return the vertices of rings in samples, and which are between two surfaces."""
    width = values.shape[1]
    inside, outside = (values.ravel()[at].astype(np.float64) for at in (rings.inner, rings.outer))
    step = inside - outside
    sharp = np.abs(step) > JUMP * max(palette.error, 2.0)
    level = middle[rings.level]
    linear = (step > 0) & ~sharp & np.isfinite(level)
    share = np.where(linear, (inside - level) / np.where(linear, step, 1), 0.5)
    ends = [np.stack([at % width, at // width], axis=1) for at in (rings.inner, rings.outer)]
    points = ends[0] + np.clip(share, END, 1 - END)[:, np.newaxis] * (ends[1] - ends[0])
    sharp |= ~np.isfinite(level)
    return smoothed(points, sharp, rings.starts), sharp


def _drawn_in(
    rings: Rings, points: Array, labels: NDArray[np.int32], cover: Indices, scale: int
) -> tuple[Array, Array]:
    """Return vertices, those that a lighter area covers moved beneath it, and the distances.

    Vertices are in samples, distances in pixels.
    """
    starts = rings.starts
    span = np.maximum(np.minimum(np.diff(starts), 4 * scale) // 3, 1)
    way = points[shifted(starts, span)] - points[shifted(starts, -span)]
    length = np.hypot(way[:, 0], way[:, 1])
    # The inside is at the right hand of the way on paper, whose rows run downward.
    inward = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.maximum(length, 1e-9)[:, np.newaxis]
    moved = np.zeros(len(points))
    left = np.flatnonzero(cover)
    top = np.array(labels.shape)[::-1] - 1
    for reach in REACHES:
        covered = np.ones(len(left), dtype=np.bool_)
        for part in PARTS:
            trial = points[left] + part * reach * scale * inward[left]
            at = np.clip(np.rint(trial), 0, top).astype(np.intp)
            covered &= labels[at[:, 1], at[:, 0]] >= cover[left]
        moved[left[covered]] = reach
        left = left[~covered]
    # The mean of the least around: a border without teeth takes few vertices.
    moved = scipy.ndimage.minimum_filter1d(moved, AROUND)
    moved = scipy.ndimage.uniform_filter1d(moved, AROUND)
    return points + scale * moved[:, np.newaxis] * inward, moved


def _cut(rings: Rings, points: Array, limit: Array, pad: int, scale: int) -> Iterator[Array]:
    """Yield the corners of rings in pixels; none of those that are specks."""
    pixels = (points - pad + 0.5) / scale
    kept = simplified(pixels, rings.starts, limit)
    ends = np.cumsum(np.add.reduceat(kept, rings.starts[:-1]))
    for corners in np.split(pixels[kept], ends[:-1]):
        yield corners if len(corners) > 2 and abs(area_of(corners)) > SPECK else corners[:0]
