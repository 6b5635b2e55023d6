"""Crossings of lines in a picture, and how a reader tells which line is nearer.

Where two lines cross, the nearer one runs on and interrupts the other by its colour, by a gap
beside it, or by its darker border: a T on either side (Rubin, Perception 30, 2001).
Crossings that a third line disturbs are left out.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from vizlight.model.kernels import unit_rows
from vizlight.observers.eye import ROUNDING
from vizlight.observers.lines import SEEN

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.observers.eye import SeenPicture
    from vizlight.observers.lines import Segments

#: Sine of the least angle between lines that cross: 30 degrees.
STEEP = 0.5
#: Distance in pixels along a line beyond which two of its places count as two lines, since a
#: line may cross itself.
APART = 40.0
#: Distances in pixels beyond the border of a line at which its border is looked for, and the one
#: inside, where tubes and outlined lines are darker.
BESIDE, INSIDE = (1.0, 2.0, 3.0, 5.0), (-1.0,)
#: Cosine of the largest angle by which lines may turn within the farthest of these distances:
#: 30 degrees.
STRAIGHT = 0.866
#: Distance in pixels from both lines within which there is no third line.
CLEAR = 5.5
#: Distance in pixels within which two crossings are one.
SAME = 3.0
#: Largest number of pairs of neighbouring pixels that are tried, for each crossing.
TRIES = 8


class Crossings(NamedTuple):
    """Crossings at which both lines are seen on both sides, the nearer one in the middle.

    ``at`` (N, 2) is in pixels from the upper left corner, to the right and down; ``front`` and
    ``back`` are segments of the nearer line and of the other, and ``left_out`` is the number of
    other places where lines cross: beside a third line, or where one ends.
    """

    at: Array
    front: Indices
    back: Indices
    left_out: int = 0


def crossings_of(lines: Segments, count: int, random: np.random.Generator) -> Crossings:
    """Return crossings of the lines of a picture.

    ``random`` chooses ``count`` among them if they are more.
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
    u, v = unit_rows(lines.way[first]), unit_rows(lines.way[second])
    sine = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    steep = np.abs(sine) >= STEEP
    first, second, u, v, sine = first[steep], second[steep], u[steep], v[steep], sine[steep]
    away = lines.start[second] - lines.start[first]
    at = lines.start[first]
    at = at + ((away[:, 0] * v[:, 1] - away[:, 1] * v[:, 0]) / sine)[:, np.newaxis] * u
    shown = _number(lines, at)
    front = np.where(_near(lines, shown, first), first, second)
    back = np.where(front == first, second, first)
    crossings = Crossings(at, front, back)
    keep = _near(lines, shown, front)
    for line, other in ((front, back), (back, front)):
        keep &= _straight(lines, at, line, other)
    places = len(_first_of_each(at[keep]))
    for line, other in ((front, back), (back, front)):
        for side in _arms(lines, crossings, line, other):
            numbers = [_number(lines, places) for places in side]
            seen = [_near(lines, each, line) for each in numbers]
            # A line of a pixel may be drawn beside a place on it.
            keep &= np.any(seen, axis=0)
            keep &= np.all([near | (n < 0) for near, n in zip(seen, numbers, strict=True)], axis=0)
    crossings = _taken(crossings, keep)
    crossings = _taken(crossings, _clear(lines, crossings))
    crossings = _taken(crossings, _first_of_each(crossings.at))
    return crossings._replace(left_out=places - len(crossings.at))


def answers(crossings: Crossings, lines: Segments, seen: SeenPicture, noise: float) -> Array:
    """Return which line a reader takes for the nearer one: 1 that, -1 the other, 0 neither.

    It is the line with borders that are seen on both sides: differences of 3 deviations of the
    noise at least, and by half as much more than at the borders of the other. The noise is that of
    the eye in CIELAB.
    """
    middle = _read(seen, crossings.at)
    borders = []
    for line, other in ((crossings.back, crossings.front), (crossings.front, crossings.back)):
        arms = _arms(lines, crossings, line, other, INSIDE + BESIDE)
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
    differences = [np.linalg.norm(a - b, axis=1) for a, b in combinations(stations, 2)]
    return np.asarray(np.max(differences, axis=0))


def _arms(
    lines: Segments,
    crossings: Crossings,
    line: Indices,
    other: Indices,
    distances: tuple[float, ...] = BESIDE,
) -> Array:
    """Return places on a line at distances from the borders of the other, shape (2, D, N, 2)."""
    u, v = unit_rows(lines.way[line]), unit_rows(lines.way[other])
    sine = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    # Inside of a narrow line there is but its middle.
    far = np.maximum(lines.width[other] / 2 + np.array(distances)[:, np.newaxis], 0.0) / sine
    step = far[..., np.newaxis] * u
    return np.stack([crossings.at + step, crossings.at - step])


def _straight(lines: Segments, at: Array, line: Indices, other: Indices) -> Bools:
    """Return whether lines go straight on through crossings, as far as they are looked at."""
    u, v = unit_rows(lines.way[line]), unit_rows(lines.way[other])
    sine = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    reach = (lines.width[other] / 2 + BESIDE[-1]) / sine
    place = lines.along[line] + np.einsum("ij,ij->i", at - lines.start[line], u)
    way = unit_rows(lines.ways_at(np.concatenate([place - reach, place + reach])))
    straight = np.einsum("ij,ij->i", way, np.concatenate([u, u])) >= STRAIGHT
    return np.asarray(straight.reshape(2, -1).all(axis=0))


def _read(seen: SeenPicture, places: Array) -> Array:
    """Return the colours that the eye sees at places, shape (N, 3) in CIELAB."""
    column, row = np.floor(places).astype(np.intp).T
    return seen.colors_at(row, column)


def _number(lines: Segments, places: Array) -> Indices:
    """Return the segments that are seen at places, -1 without one and outside the picture."""
    height, width = lines.number.shape
    column, row = np.floor(np.clip(np.nan_to_num(places, nan=-1.0), -1, 1e9)).astype(np.intp).T
    inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
    segments = np.full(len(places), -1, dtype=np.intp)
    segments[inside] = lines.number[row[inside], column[inside]]
    return segments


def _apart(lines: Segments, first: Indices, second: Indices) -> Bools:
    """Return whether segments belong to different lines, or to far places of one."""
    return np.asarray(np.abs(lines.along[first] - lines.along[second]) > APART)


def _near(lines: Segments, shown: Indices, line: Indices) -> Bools:
    """Return whether segments that are seen are those of some lines."""
    return (shown >= 0) & ~_apart(lines, shown, line)


def _clear(lines: Segments, crossings: Crossings) -> Bools:
    """Return whether no third line is around crossings."""
    width = np.maximum(lines.width[crossings.front], lines.width[crossings.back])
    reach = np.ceil(width / 2 + CLEAR - 0.5)
    clear = np.ones(len(width), dtype=np.bool_)
    largest = int(reach.max(initial=0.0))
    for down in range(-largest, largest + 1):
        for right in range(-largest, largest + 1):
            rows = np.flatnonzero((max(abs(down), abs(right)) <= reach) & clear)
            shown = _number(lines, crossings.at[rows] + (right, down))
            front, back = (_near(lines, shown, line[rows]) for line in crossings[1:3])
            clear[rows] = (shown < 0) | front | back
    return clear


def _first_of_each(at: Array) -> Indices:
    """Return the first place of each group of places that are close together."""
    if not len(at):
        return np.zeros(0, dtype=np.intp)
    near = cKDTree(at).query_pairs(SAME, output_type="ndarray")
    graph = coo_array((np.ones(len(near)), near.T), shape=(len(at), len(at)))
    label = connected_components(graph, directed=False)[1]
    return np.asarray(np.unique(label, return_index=True)[1])


def _taken(crossings: Crossings, rows: Bools | Indices) -> Crossings:
    return Crossings(crossings.at[rows], crossings.front[rows], crossings.back[rows])
