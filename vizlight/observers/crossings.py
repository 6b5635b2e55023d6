"""Crossings of lines in a picture, and how a reader tells there which line is nearer.

The nearer line goes on across a crossing, and the other is interrupted by it, by its own colour or
by a gap beside it, or by its darker border: a T on either side (Rubin, Perception 30, 2001).
Crossings that a third line disturbs are left out.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from vizlight.observers.eye import ROUNDING
from vizlight.observers.lines import SEEN

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.observers.eye import SeenPicture
    from vizlight.observers.lines import Segments

#: Sine of the least angle between lines that cross: 30 degrees.
STEEP = 0.5
#: Length in pixels along a line beyond which it is another one, that may cross the first.
APART = 40.0
#: Distances in pixels beyond the border of a line at which its border is looked for, and the one
#: inside, where tubes and outlined lines are darker.
BESIDE, INSIDE = (1.0, 2.0, 3.0, 5.0), (-1.0,)
#: Cosine of the angle by which lines turn at most within the farthest of these: 30 degrees.
STRAIGHT = 0.866
#: Distance in pixels around both lines in which there is no third.
CLEAR = 5.5
#: Distance in pixels within which two crossings are one.
SAME = 3.0
#: Largest number of pairs of pixels that are looked at for each crossing that is asked for.
TRIES = 8


class Crossings(NamedTuple):
    """Crossings at which both lines are seen on both sides, the nearer one in the middle.

    Attributes
    ----------
    at : ndarray, shape (N, 2)
        Places in pixels from the upper left corner, to the right and down.
    front, back : ndarray of int, shape (N,)
        Segments of the nearer line and of the other.
    """

    at: Array
    front: Indices
    back: Indices


def crossings_of(lines: Segments, count: int, random: np.random.Generator) -> Crossings:
    """Return crossings of the lines of a picture.

    Parameters
    ----------
    lines : Segments
        Lines of the picture.
    count : int
        Largest number of crossings.
    random : numpy.random.Generator
        Generator that chooses where there are more.
    """
    number = lines.number
    pairs = []
    for a, b in ((number[:, :-1], number[:, 1:]), (number[:-1], number[1:])):
        there = (a >= 0) & (b >= 0)
        there[there] = _apart(lines, a[there], b[there])
        pairs.append(np.column_stack([a[there], b[there]]))
    pair = np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)
    pair = random.permutation(pair)[: TRIES * count]
    first, second = pair.T
    # Both lines go straight on across the crossing.
    u, v = _unit(lines.way[first]), _unit(lines.way[second])
    sine = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    steep = np.abs(sine) >= STEEP
    first, second, u, v, sine = first[steep], second[steep], u[steep], v[steep], sine[steep]
    away = lines.start[second] - lines.start[first]
    at = lines.start[first]
    at = at + ((away[:, 0] * v[:, 1] - away[:, 1] * v[:, 0]) / sine)[:, np.newaxis] * u
    shown = _number(lines, at)
    front = np.where(_near(lines, shown, first), first, second)
    back = np.where(front == first, second, first)
    found = Crossings(at, front, back)
    keep = _near(lines, shown, front)
    for one, other in ((front, back), (back, front)):
        keep &= _straight(lines, at, one, other)
    for one, other in ((front, back), (back, front)):
        for side in _arms(lines, found, one, other):
            numbers = [_number(lines, places) for places in side]
            seen = [_near(lines, each, one) for each in numbers]
            # A line of a pixel may be drawn beside a place on it.
            keep &= np.any(seen, axis=0)
            keep &= np.all([near | (n < 0) for near, n in zip(seen, numbers, strict=True)], axis=0)
    found = _taken(found, keep)
    found = _taken(found, _clear(lines, found))
    return _taken(found, _first_of_each(found.at))


def told(crossings: Crossings, lines: Segments, seen: SeenPicture, noise: float) -> Array:
    """Return what a reader says at crossings: 1 the nearer line, -1 the other, 0 neither.

    The nearer line is the one whose borders are seen on both sides: differences of 3 deviations of
    the noise at least, and by half as much more than at the borders of the other.

    Parameters
    ----------
    crossings : Crossings
        Crossings.
    lines : Segments
        Lines of the picture.
    seen : SeenPicture
        What the eye sees of the picture.
    noise : float
        Noise of the eye in CIELAB.
    """
    middle = _read(seen, crossings.at)
    borders = []
    for one, other in ((crossings.back, crossings.front), (crossings.front, crossings.back)):
        arms = _arms(lines, crossings, one, other, INSIDE + BESIDE)
        sides = [[middle, *(_read(seen, places) for places in side)] for side in arms]
        # A border, or a gap, is where it is seen best; both sides are needed.
        borders.append(np.min([_largest(side) for side in sides], axis=0))
    nearer, other = borders
    gain = np.sign(nearer - other)
    # The noise is that of a difference of two colours.
    least = SEEN * np.hypot(noise, ROUNDING)
    clear = (np.maximum(nearer, other) >= least) & (np.abs(nearer - other) > least / 2)
    return np.asarray(gain * clear)


def _largest(stations: list[Array]) -> Array:
    """Return the largest difference in CIELAB of two stations of a line."""
    found = [np.linalg.norm(a - b, axis=1) for a, b in combinations(stations, 2)]
    return np.asarray(np.max(found, axis=0))


def _arms(
    lines: Segments,
    found: Crossings,
    one: Indices,
    other: Indices,
    distances: tuple[float, ...] = BESIDE,
) -> Array:
    """Return places on a line at distances from the borders of the other, shape (2, D, N, 2)."""
    u, v = _unit(lines.way[one]), _unit(lines.way[other])
    sine = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    # Inside of a narrow line there is but its middle.
    far = np.maximum(lines.width[other] / 2 + np.array(distances)[:, np.newaxis], 0.0) / sine
    step = far[..., np.newaxis] * u
    return np.stack([found.at + step, found.at - step])


def _straight(lines: Segments, at: Array, one: Indices, other: Indices) -> Bools:
    """Return whether lines go straight on through crossings, as far as they are looked at."""
    u, v = _unit(lines.way[one]), _unit(lines.way[other])
    sine = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    reach = (lines.width[other] / 2 + BESIDE[-1]) / sine
    place = lines.along[one] + np.einsum("ij,ij->i", at - lines.start[one], u)
    straight = np.ones(len(one), dtype=np.bool_)
    for far in (place - reach, place + reach):
        there = np.clip(np.searchsorted(lines.along, far, side="right") - 1, 0, None)
        way = _unit(lines.way[there])
        straight &= np.einsum("ij,ij->i", way, u) >= STRAIGHT
    return straight


def _read(seen: SeenPicture, places: Array) -> Array:
    """Return what the eye sees at places, shape (N, 3) in CIELAB."""
    column, row = np.floor(places).astype(np.intp).T
    return seen.colors_at(row, column)


def _number(lines: Segments, places: Array) -> Indices:
    """Return the segments that are seen at places, -1 without one and outside the picture."""
    height, width = lines.number.shape
    column, row = np.floor(np.clip(np.nan_to_num(places, nan=-1.0), -1, 1e9)).astype(np.intp).T
    inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
    found = np.full(len(places), -1, dtype=np.intp)
    found[inside] = lines.number[row[inside], column[inside]]
    return found


def _apart(lines: Segments, one: Indices, other: Indices) -> Bools:
    """Return whether segments belong to different lines, or to far places of one."""
    return np.asarray(np.abs(lines.along[one] - lines.along[other]) > APART)


def _near(lines: Segments, shown: Indices, one: Indices) -> Bools:
    """Return whether what is seen is a line, and the one asked for."""
    return (shown >= 0) & ~_apart(lines, shown, one)


def _clear(lines: Segments, found: Crossings) -> Bools:
    """Return whether there is no third line around crossings."""
    width = np.maximum(lines.width[found.front], lines.width[found.back])
    reach = np.ceil(width / 2 + CLEAR - 0.5)
    clear = np.ones(len(width), dtype=np.bool_)
    largest = int(reach.max(initial=0.0))
    for down in range(-largest, largest + 1):
        for right in range(-largest, largest + 1):
            rows = np.flatnonzero((max(abs(down), abs(right)) <= reach) & clear)
            shown = _number(lines, found.at[rows] + (right, down))
            own = [_near(lines, shown, line[rows]) for line in (found.front, found.back)]
            clear[rows] = (shown < 0) | own[0] | own[1]
    return clear


def _first_of_each(at: Array) -> Indices:
    """Return the first of all places that are as good as one."""
    if not len(at):
        return np.zeros(0, dtype=np.intp)
    near = cKDTree(at).query_pairs(SAME, output_type="ndarray")
    graph = coo_array((np.ones(len(near)), near.T), shape=(len(at), len(at)))
    label = connected_components(graph, directed=False)[1]
    return np.asarray(np.unique(label, return_index=True)[1])


def _taken(found: Crossings, rows: Bools | Indices) -> Crossings:
    return Crossings(found.at[rows], found.front[rows], found.back[rows])


def _unit(vectors: Array) -> Array:
    length = np.hypot(vectors[:, 0], vectors[:, 1])
    return np.asarray(vectors / np.maximum(length, 1e-12)[:, np.newaxis])
