"""Lines as a picture shows them: their segments in pixels, and which way along them is ahead."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter, uniform_filter

from vizlight.draw.live import matrix_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv

    from vizlight._types import Array, Bools, Indices
    from vizlight.observers.eye import Eye, SeenPicture
    from vizlight.observers.pixels import Pixels
    from vizlight.observers.samples import Part

#: Number of deviations of noise by which a difference is seen (Rose, J. Opt. Soc. Am. 38, 1948: 3
#: at least).
SEEN = 3.0
#: Distance in pixels along a picture between different lines, so that no two are neighbours.
JUMP = 1e6
#: Width in arc minutes of the window in which a reader sees how much of a stroke there is, and
#: width of the one in which what is around it is seen, in widths of the first.
WINDOW, AROUND = 8.0, 4
#: Least number of pixels of either end of a stroke that is asked for its sense.
END = 3


class Segments(NamedTuple):
    """Segments of all lines of a picture, in pixels from the upper left corner.

    Attributes
    ----------
    number : ndarray of int, shape (H, W)
        Segment that each pixel shows, -1 without one.
    start, way : ndarray, shape (S, 2)
        Beginning of each segment, to the right and down, and what leads to its end.
    along : ndarray, shape (S,)
        Length of the line before the segment; different lines are far apart.
    line : ndarray of int, shape (S,)
        Number of the line.
    width : ndarray, shape (S,)
        Width of the line in pixels.
    ahead : ndarray, shape (S,)
        1 where the sense of the data is that of the segment, -1 against it, 0 without a sense.
    """

    number: Indices
    start: Array
    way: Array
    along: Array
    line: Indices
    width: Array
    ahead: Array

    def places(self, row: Indices, column: Indices) -> tuple[Indices, Array]:
        """Return the segments that pixels show, and how far along the lines the pixels are."""
        segment = self.number[row, column]
        way = self.way[segment]
        here = np.column_stack([column + 0.5, row + 0.5]) - self.start[segment]
        square = np.einsum("ij,ij->i", way, way)
        share = np.clip(np.einsum("ij,ij->i", here, way) / np.maximum(square, 1e-12), 0.0, 1.0)
        return segment, self.along[segment] + share * np.sqrt(square)


def segments_of(parts: Sequence[Part], pixels: Pixels, camera: pv.Camera) -> Segments | None:
    """Return the segments of the lines of a picture, None without lines.

    Parameters
    ----------
    parts : sequence of Part
        Meshes that the picture shows.
    pixels : Pixels
        Pixels that show them.
    camera : pyvista.Camera
        Camera of the picture.
    """
    width, height = pixels.size
    number = np.full((height, width), -1, dtype=np.intp)
    project = matrix_of(camera.GetCompositeProjectionTransformMatrix(width / height, -1, 1))
    ends, widths, breaks, ahead = [], [], [], []
    count = 0
    for i, part in enumerate(parts):
        if part.kind != "line":
            continue
        own = pixels.part == i
        number[pixels.row[own], pixels.column[own]] = count + pixels.cell[own]
        points = np.asarray(part.inputs.points[:], dtype=np.float64)
        placed = np.column_stack([points, np.ones(len(points))]) @ project.T
        # What is behind the eye has no place in the picture, and no pixel.
        scale = np.where(placed[:, 3] > 0, placed[:, 3], np.nan)
        x, y = placed[:, 0] / scale, placed[:, 1] / scale
        places = np.column_stack([(1 + x) / 2 * width, (1 - y) / 2 * height])
        cells = part.cells
        ends.append(places[cells])
        widths.append(part.drawn.widths(camera, height))
        breaks.append(np.insert(cells[1:, 0] != cells[:-1, 1], 0, True))
        ahead.append(np.zeros(len(cells)) if part.ahead is None else part.ahead)
        count += len(cells)
    if not count:
        return None
    both, first = np.concatenate(ends), np.concatenate(breaks)
    way = both[:, 1] - both[:, 0]
    length = np.nan_to_num(np.hypot(way[:, 0], way[:, 1]))
    before = np.insert(np.cumsum(length)[:-1], 0, 0.0)
    line = np.cumsum(first) - 1
    return Segments(
        number, both[:, 0], way, before + JUMP * line, line, np.concatenate(widths),
        np.concatenate(ahead),
    )  # fmt: skip


class Strokes(NamedTuple):
    """What a reader has of strokes whose data have a sense.

    Attributes
    ----------
    ink, light : ndarray, shape (N,)
        Contrast with the surroundings and lightness above them, in CIELAB: the end of a stroke
        that is ahead less the other end, each as the mean of a window of 8 arc minutes.
    """

    ink: Array
    light: Array


def strokes_of(lines: Segments, seen: SeenPicture, eye: Eye) -> Strokes:
    """Return the difference of both thirds at the ends of each stroke that is seen.

    Parameters
    ----------
    lines : Segments
        Lines of the picture.
    seen : SeenPicture
        What the eye sees of the picture.
    eye : Eye
        Eye.
    """
    row, column = np.nonzero(lines.number >= 0)
    keep = lines.ahead[lines.number[row, column]] != 0
    row, column = row[keep], column[keep]
    segment, along = lines.places(row, column)
    # Lines by their numbers among those with a sense that are seen.
    names, line = np.unique(lines.line[segment], return_inverse=True)
    low, high = np.full(len(names), np.inf), np.full(len(names), -np.inf)
    np.minimum.at(low, line, along)
    np.maximum.at(high, line, along)
    at = (along - low[line]) / np.maximum(high - low, 1e-9)[line]
    sign = np.sign(np.bincount(line, lines.ahead[segment], len(names)))
    at = np.where(sign[line] < 0, 1 - at, at)
    window = max(1, round(WINDOW / 60 * eye.pixels_per_degree))
    # What is around is seen in a wider window, as far as no line covers it.
    bare = (lines.number < 0)[..., np.newaxis].astype(np.float64)
    around = (AROUND * window, AROUND * window, 1)
    share = uniform_filter(bare, around, mode="nearest")
    ground = uniform_filter(bare * seen.colors, around, mode="nearest") / np.maximum(share, 1e-3)
    stands_out = seen.colors - ground
    ink = uniform_filter(np.linalg.norm(stands_out, axis=2), window, mode="nearest")
    first, last = at < 1 / 3, at > 2 / 3
    enough = np.ones(len(names), dtype=np.bool_)
    for third in (first, last):
        enough &= np.bincount(line[third], minlength=len(names)) >= END
    found = [
        (_mean(values, line, last, len(names)) - _mean(values, line, first, len(names)))[enough]
        for values in (ink[row, column], stands_out[row, column, 0])
    ]
    return Strokes(*found)


def courses_of(
    lines: Segments, seen: SeenPicture, eye: Eye, count: int, random: np.random.Generator
) -> tuple[Array, Array]:
    """Return what a reader who follows strokes has of the course of lines.

    The course is across the direction in which the colours of a window of 8 arc minutes change
    most: the structure tensor (Bigun and Granlund 1987).

    Parameters
    ----------
    lines : Segments
        Lines of the picture.
    seen : SeenPicture
        What the eye sees of the picture.
    eye : Eye
        Eye, whose noise is added to each pixel.
    count : int
        Largest number of places.
    random : numpy.random.Generator
        Source of the places and of the noise.

    Returns
    -------
    seen, true : ndarray, shape (M,)
        Angles in radians, from right toward down, which have no sense.
    """
    row, column = np.nonzero(lines.number >= 0)
    chosen = random.permutation(len(row))[:count]
    row, column = row[chosen], column[chosen]
    way = lines.way[lines.number[row, column]]
    noisy = seen.colors + random.normal(0.0, eye.noise, seen.colors.shape)
    down, right = np.gradient(gaussian_filter(noisy, (1.0, 1.0, 0.0)), axis=(0, 1))
    # A Gaussian of the variance of the window.
    spread = WINDOW / 60 * eye.pixels_per_degree / math.sqrt(12)
    xx, xy, yy = (
        gaussian_filter((a * b).sum(axis=2), spread)[row, column]
        for a, b in ((right, right), (right, down), (down, down))
    )
    across = np.arctan2(2 * xy, xx - yy) / 2
    return across + np.pi / 2, np.arctan2(way[:, 1], way[:, 0])


def _mean(values: Array, line: Indices, rows: Bools, count: int) -> Array:
    """Return the mean of some values for each line."""
    total = np.bincount(line[rows], values[rows], count)
    return np.asarray(total / np.maximum(np.bincount(line[rows], minlength=count), 1))


def two_sides(told: int, wrongly: int, total: int) -> float:
    """Return the bits that answers give of a question of two sides.

    It is the information of a channel that is silent at some places and wrong at others,
    ``(t + w) / n (1 - H(t / (t + w)))``, less the bias of a sample, ``1 / (2 n ln 2)`` (Miller
    1955); 0 where as many answers are wrong as right.

    Parameters
    ----------
    told, wrongly : int
        Numbers of right and of wrong answers.
    total : int
        Number of places, at least 1.
    """
    if told <= wrongly:
        return 0.0
    right = told / (told + wrongly)
    entropy = sum(-p * np.log2(p) for p in (right, 1 - right) if p > 0)
    return max(0.0, float((told + wrongly) / total * (1 - entropy) - 1 / (2 * total * np.log(2))))
