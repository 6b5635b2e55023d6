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

from vizlight._types import Array
from vizlight.geometry.contours import rings
from vizlight.geometry.contours.palette import JUMP, Palette
from vizlight.geometry.contours.steady import slopes

#: Samples around those of the picture.
PAD = 2
#: Reach of a face outward beneath a later one, in pixels, tried from the largest, and the parts of
#: it at which it is looked for the later one.
REACHES, PARTS = (-1.5, -1.0, -0.6, -0.3), (0.5, 1.0)
#: Largest distance of a border from what is written of it where a later face hides it, as a share
#: of its reach.
SLACK = 0.55
#: Largest distance that a tolerance of colours allows.
BROAD = 1.0


class Face(NamedTuple):
    """All that has one colour.

    ``rings`` are closed, of shape (n, 2), in pixels from the upper left, the first point not
    repeated. The inside is at the right hand, so that holes run the other way.
    """

    color: Array
    rings: list[Array]


def faces(palette: Palette, samples: Array, scale: int, tolerance: float = 0.0) -> Iterator[Face]:
    """Yield the faces of samples in the order in which they are painted.

    ``samples`` has the shape (rows, columns, c), with ``scale`` samples for each pixel along a
    side; ``tolerance`` is the difference of colours up to which a border may lie where samples have
    others than it. Background has no face. A border that is seen is within 0.1 pixels of its place
    between samples, at which colours that change steadily are crossed linearly; where two surfaces
    meet it is half way between two samples.
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
    at, labels = rings.squares(padded)
    # Each label that a square has, once.
    equal = labels[:, :, np.newaxis] == labels[:, np.newaxis]
    square, place = np.nonzero((labels > 0) & ~np.tril(equal, -1).any(axis=2))
    area = labels[square, place].astype(np.intp)
    borders = rings.traced(at[square], area, equal[square, place], padded)
    other = padded.ravel()[borders.outer]
    around = ((PAD, PAD), (PAD, PAD), (0, 0))
    mine, its = (palette.centres[side % last] for side in (borders.area, other))
    jump = JUMP * max(palette.error, 0.5)
    points, sharp = rings.vertices(borders, np.pad(samples, around, mode="edge"), mine, its, jump)
    steep = np.pad(slopes(samples, scale), PAD, mode="edge").ravel()
    slope = np.maximum(steep[borders.inner], steep[borders.outer])
    cover = np.where(other > borders.area, borders.area + 1, 0)
    points, reach = rings.beneath(points, borders.starts, padded, cover, REACHES, PARTS, scale)
    limit = np.clip(tolerance / np.maximum(slope, 1e-6), rings.SEEN, BROAD)
    limit = np.where(sharp, max(rings.SEEN, rings.STAIR / scale), limit)
    pixels = (points - PAD + 0.5) / scale
    every = rings.corners_of(pixels, borders.starts, np.maximum(limit, SLACK * reach))
    which = borders.area[borders.starts[:-1]]
    # What is painted later covers a hole all around which it lies.
    later = np.logical_and.reduceat(cover > 0, borders.starts[:-1])
    for face in range(1, last + 1):
        kept = [
            every[ring]
            for ring in np.flatnonzero(which == face)
            if len(every[ring]) and not (later[ring] and rings.area_of(every[ring]) < 0)
        ]
        if face == last:
            kept.insert(0, box)
        if kept:
            yield Face(palette.colors[face % last], kept)
