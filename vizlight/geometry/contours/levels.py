"""A picture of one channel as nested areas, each of all that is at least as light as its level.

Areas are painted from dark to light and the background last, with the surfaces as its holes. Each
border between two levels is then written once, and one painter's order leaves no seam at any scale.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from vizlight._types import Array, Bools, Indices
from vizlight.geometry.contours import rings
from vizlight.geometry.contours.banding import ranges
from vizlight.geometry.contours.faces import Face
from vizlight.geometry.contours.palette import JUMP, Palette
from vizlight.geometry.contours.steady import slopes

#: Distance in pixels to which areas reach beneath the background, and share of the distance from
#: it by which their borders there may lie elsewhere.
BENEATH, FREE = 6, 0.6
#: Reach of a border beneath lighter areas, in pixels: tried from the largest; the share of it by
#: which the border may lie elsewhere.
REACHES, SLACK = (5.0, 2.5, 1.2, 0.6), 0.6
#: Parts of the reach at which it is looked for what covers it.
PARTS = (0.4, 0.7, 1.0, 1.3, 1.6)
#: Pixels between two borders below which not all are drawn.
CROWD = 0.8
#: Least and largest distance that a tolerance of values allows, in pixels.
NEAR, BROAD = 0.2, 1.5
#: Share of the error by which steep borders may be off.
MIXED = 0.9


def levels(palette: Palette, samples: Array, scale: int, tolerance: float = 0.0) -> Iterator[Face]:
    """Yield the areas of samples in the order in which they are painted, the background last.

    As :func:`~vizlight.geometry.contours.faces.faces`, for samples of one channel and colours from
    dark to light.
    """
    if not np.any(palette.labels):
        return
    pad = BENEATH * scale + 2
    rows, columns = palette.labels.shape
    box = np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)]) / scale
    yield Face(palette.colors[1], [box])
    shown = _padded(palette.labels, pad)
    values = np.pad(samples, ((pad, pad), (pad, pad), (0, 0)), mode="edge")
    labels, depth = _beneath(shown, BENEATH * scale)
    steep = np.pad(slopes(samples, scale), pad, mode="edge").ravel()
    borders = _rings(labels, 1)
    mine, its = palette.centres[borders.area], palette.centres[borders.area - 1]
    jump = JUMP * max(palette.error, 0.5)
    points, sharp = rings.vertices(borders, values, mine, its, jump)
    at = labels.ravel()[borders.inner].astype(np.intp)
    under = depth.ravel()[borders.inner]
    slope = np.maximum(steep[borders.inner], steep[borders.outer])
    cover = _covers(borders.area, at, slope, palette.error, sharp=sharp)
    cover[under > 0] = 0
    points, reach = rings.beneath(points, borders.starts, labels, cover, REACHES, PARTS, scale)
    limit = _limits(slope, palette.error, tolerance)
    limit = np.where(sharp, rings.STAIR / scale, limit)
    limit = np.where(under > 0, FREE * under / scale, limit)
    limit = np.maximum(limit, SLACK * reach)
    every = rings.corners_of((points - pad + 0.5) / scale, borders.starts, limit)
    which = borders.area[borders.starts[:-1]]
    for level in range(2, len(palette.colors)):
        kept = [every[i] for i in np.flatnonzero(which == level) if len(every[i])]
        if kept:
            yield Face(palette.colors[level], kept)
    ground = _rings((shown == 0).astype(np.int32), 0)
    blank = np.zeros((len(ground.area), 1))
    # All of it is between surfaces.
    points, _ = rings.vertices(ground, values, blank, blank, -1.0)
    limit = np.full(len(points), rings.STAIR / scale)
    kept = [
        r for r in rings.corners_of((points - pad + 0.5) / scale, ground.starts, limit) if len(r)
    ]
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


def _rings(labels: NDArray[np.int32], lowest: int) -> rings.Rings:
    """Return the rings around all that is above each level from the lowest on."""
    at, corner = rings.squares(labels)
    square, level = ranges(np.maximum(corner.min(axis=1), lowest) + 1, corner.max(axis=1) + 1)
    return rings.traced(at[square], level, corner[square] >= level[:, np.newaxis], labels)


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
