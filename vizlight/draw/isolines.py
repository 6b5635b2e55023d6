"""Isolines of a flat map with their numbers, each in a gap of its line, and its highs and lows."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np
import pyvista as pv
import scipy
from matplotlib.path import Path

from vizlight import _check, _words
from vizlight._types import Array, Bools, Indices
from vizlight.mesh import blocks, polylines, records
from vizlight.vtk import letters as words_of
from vizlight.vtk.cells import connectivity
from vizlight.vtk.letters import DIGIT

#: Pieces of isolines, shape (N, 2) each, with their levels.
Pieces: TypeAlias = list[tuple[Array, float]]

#: Room around a number within its line, and least distance between numbers, and what is added
#: to that between numbers of one line, in heights of letters.
GAP, APART, FAR = 0.35, 4.0, 14.0
#: Least height of letters, as a share of the diagonal of the map.
SMALLEST = 1e-5
#: Largest length of the arc below a number, in lengths of its chord: where a line is as straight.
STRAIGHT = 1.06
#: Length of lines that count as long, in heights of letters, and share of the length of all in long
#: ones from which on a field is smooth in its picture.
LONG, SMOOTH = 6.0, 0.75
#: Places along a line at which a number may stand.
PLACES = 60
#: Length of the rest of a line from which on it has a number too, in heights of letters.
AGAIN = 30.0
#: Points across a number at which other lines are looked for, distance of these and step between
#: the points of all lines, in heights of letters, and points that are looked at.
ALONG, CLEAR, STEP, NEIGHBOURS = 5, 0.55, 0.4, 12
#: Share of these points near other lines from which on a number is not readable.
CROSSED = 0.3
#: Distance within which a high or a low is the only one, as a share of the larger side of a map;
#: height of its letter and of its number, and room around each, in heights of letters.
REACH, INITIAL, NUMBER, ROOM = 0.1, 1.7, 1.2, 0.15
#: Neighbours of a point with which it is compared at first.
AROUND = 9
#: Name of the array with the level of a line.
LEVEL = "level"


def isolines(
    mesh: pv.DataSet,
    name: str,
    levels: Sequence[float],
    /,
    letters: float,
    *,
    words: Sequence[str] | None = None,
    clear_of: pv.PolyData | None = None,
    extremes: float | None = None,
) -> pv.MultiBlock:
    """Return lines of equal values on a flat map, with their numbers along them.

    Each line that has room has one number, in a gap of the line; its top is toward larger y. It is
    where no other line is near, and where its own is straightest. Highs and lows, if they are asked
    for, are points within a closed line with the largest or the least value as far as a tenth
    of the larger side of the map.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Flat map in x and y; cells with a value that is missing have no lines.
    name : str
        Name of an array of one component; one of cells is averaged to the points.
    levels : sequence of float
        Values of the lines.
    letters : float
        Height of letters in the unit of x and y.
    words : sequence of str, optional
        Numbers of the levels, such as those in another unit. Default: the levels.
    clear_of : pyvista.PolyData, optional
        Lines of which numbers keep clear, as far as room allows, such as coasts.
    extremes : float, optional
        Unit in which the values of highs and lows are written below their letters, H and L, in that
        of the array: 100 for hPa of an array in Pa. Default: none are marked.

    Returns
    -------
    pyvista.MultiBlock
        Blocks ``lines``, ``numbers`` and ``extremes``, of polylines and of triangles, with the
        point array ``level``, the value of the array.

    Raises
    ------
    TypeError, ValueError
        If the array is missing or has several components, a level is no finite number, the unit is
        not positive, or the letters are too low for a map of this size.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import cartography
    >>> slope = pv.Plane(i_size=40, j_size=30)
    >>> slope["x"] = slope.points[:, 0]
    >>> cartography.isolines(slope, "x", [-10, 0, 10], letters=1.0)["lines"].n_lines
    6
    """
    _check.instance("mesh", mesh, pv.DataSet, "a mesh")
    letters = _check.positive("letters", letters)
    if letters < SMALLEST * mesh.length:
        expected = f"a height of at least {SMALLEST * mesh.length:g}"
        raise _check.value_error("letters", expected, f"{letters:g}")
    values = _check.coordinates("levels", levels).ravel()
    if words is not None:
        _check.iterable("words", words, "a text for each level")
    texts = (
        [f"{level:.6g}" for level in values]
        if words is None
        else [_check.text("words", word) for word in words]
    )
    if len(texts) != len(values):
        expected = f"a word for each of the {len(values)} levels"
        raise _check.value_error("words", expected, len(texts))
    unit = None if extremes is None else _check.positive("extremes", extremes)
    pieces = contoured(mesh, name, values)
    return labelled(
        mesh, name, pieces, letters, dict(zip(values.tolist(), texts, strict=True)), clear_of, unit
    )


def labelled(
    mesh: pv.DataSet,
    name: str,
    pieces: Pieces,
    letters: float,
    text_of: Mapping[float, str],
    clear_of: pv.PolyData | None,
    unit: float | None,
) -> pv.MultiBlock:
    """Return pieces of isolines with their numbers.

    Pieces are those of :func:`contoured`; those of levels without a number in ``text_of`` are left
    out. ``unit`` is that of the values of highs and lows, and the rest is as for :func:`isolines`.
    """
    pieces = [(piece, level) for piece, level in pieces if level in text_of]
    marks = [] if unit is None else _extremes(mesh, name, pieces, letters, unit)
    pieces = _without(pieces, [mark.box for mark in marks], letters)
    is_near = _lines_apart([piece for piece, _ in pieces], clear_of, letters)
    drawn: list[tuple[Array, float]] = []
    numbers: list[tuple[Array, Indices, float]] = []
    taken: list[tuple[Array, int]] = [(mark.box.mean(axis=0), -1) for mark in marks]
    longest = sorted(range(len(pieces)), key=lambda at: -_length(pieces[at][0]))
    left = [(number, pieces[number][0]) for number in longest]
    # Parts of long lines join the end of the queue.
    for number, piece in left:
        level = pieces[number][1]
        text = text_of[level]
        word, triangles = words_of.triangles(text)
        width = words_of.width(text)
        near = partial(is_near, number)
        apart = [(APART + FAR * (owner == number)) * letters for _, owner in taken]
        others = [(place, size) for (place, _), size in zip(taken, apart, strict=True)]
        place = _place(piece, (width + 2 * GAP) * letters, others, near)
        if place is None:
            drawn.append((piece, level))
            continue
        start, end, middle, way = place
        taken.append((middle, number))
        for part in _cut(piece, start, end):
            if _length(part) > AGAIN * letters:
                left.append((number, part))
            else:
                drawn.append((part, level))
        across = np.array([-way[1], way[0]])
        flat = letters * (word - (width / 2, DIGIT / 2))
        at = middle + flat[:, :1] * way + flat[:, 1:] * across
        numbers.append((at, triangles, level))
    height = float(mesh.bounds[5])
    words = [word for mark in marks for word in mark.words]
    return pv.MultiBlock(
        {
            "lines": _lines(drawn, height),
            "numbers": _numbers(numbers, height),
            "extremes": _numbers(words, height),
        }
    )


@dataclass(frozen=True)
class Mark:
    """Letter of a high or a low with its number: triangles with a value, and corners of its box."""

    words: list[tuple[Array, Indices, float]]
    box: Array


def _extremes(
    mesh: pv.DataSet, name: str, pieces: Pieces, letters: float, unit: float
) -> list[Mark]:
    """Return the marks of highs and lows within closed isolines."""
    mesh = records.averaged(mesh, name)
    values = np.asarray(mesh.point_data[name], dtype=np.float64)
    points = np.asarray(mesh.points, dtype=np.float64)[np.isfinite(values), :2]
    values = values[np.isfinite(values)]
    rings = [(Path(piece), level) for piece, level in pieces if np.allclose(piece[0], piece[-1])]
    if not rings or len(points) < AROUND:
        return []
    tree, reach = scipy.spatial.cKDTree(points), REACH * float(np.ptp(points, axis=0).max())
    marks: list[Mark] = []
    for sign, letter in ((1.0, "H"), (-1.0, "L")):
        for at in _peaks(tree, sign * values, reach):
            value = float(values[at])
            mark = _mark(points[at], letter, f"{value / unit:.0f}", value, letters)
            room = np.prod(np.ptp(mark.box, axis=0))
            is_inner = any(
                sign * level < sign * value
                and np.prod(np.ptp(ring.vertices, axis=0)) > room
                and ring.contains_point(points[at])
                for ring, level in rings
            )
            if is_inner and np.all((mark.box[0] > tree.mins) & (mark.box[1] < tree.maxes)):
                marks.append(mark)
    return marks


def _peaks(tree: scipy.spatial.cKDTree, rows: Array, reach: float) -> list[int]:
    """Return the points with the largest value within a distance, one of those with equal ones."""
    _, near = tree.query(tree.data, AROUND)
    peaks: list[int] = []
    for at in np.flatnonzero(rows >= rows[near].max(axis=1)).tolist():
        around = tree.query_ball_point(tree.data[at], reach)
        if rows[at] >= rows[around].max() and not {*peaks} & {*around}:
            peaks.append(at)
    return peaks


def _mark(place: Array, letter: str, number: str, value: float, letters: float) -> Mark:
    """Return a letter above its number, with its place between them."""
    words: list[tuple[Array, Indices, float]] = []
    wide = 0.0
    for word, size, y in (
        (letter, INITIAL * letters, ROOM), (number, NUMBER * letters, -ROOM - NUMBER * DIGIT),
    ):  # fmt: skip
        corners, ids = words_of.triangles(word)
        half = words_of.width(word) / 2
        words.append((size * (corners - (half, 0.0)) + place + (0.0, y * letters), ids, value))
        wide = max(wide, size * half)
    low = np.array([wide + ROOM * letters, (2 * ROOM + NUMBER * DIGIT) * letters])
    high = np.array([wide + ROOM * letters, (2 * ROOM + INITIAL * DIGIT) * letters])
    return Mark(words, np.stack([place - low, place + high]))


def _without(pieces: Pieces, boxes: list[Array], letters: float) -> Pieces:
    """Return the parts of lines outside of some boxes."""
    result: Pieces = []
    for piece, level in pieces:
        crossed = [
            box for box in boxes
            if np.all(piece.max(axis=0) > box[0]) and np.all(piece.min(axis=0) < box[1])
        ]  # fmt: skip
        if not crossed:
            result.append((piece, level))
            continue
        fine = _dense(piece, STEP / 4 * letters)
        inside = np.any([np.all((fine > a) & (fine < b), axis=1) for a, b in crossed], axis=0)
        ends = np.flatnonzero(np.diff(np.concatenate([[True], inside, [True]]).astype(np.int8)))
        parts = [fine[a:b] for a, b in zip(ends[::2], ends[1::2], strict=True)]
        # What is left beside a mark tells nothing of the course of its line.
        result += [(part, level) for part in parts if _length(part) > letters]
    return result


def _lines_apart(
    pieces: list[Array], clear_of: pv.PolyData | None, letters: float
) -> Callable[[int, Array], Bools]:
    """Return the function that tells at which places a line other than a numbered one is near."""
    courses = list(pieces)
    _check.instance("clear_of", clear_of, pv.PolyData | None, "a PolyData")
    if clear_of is not None and clear_of.n_lines:
        ids, ends = connectivity(clear_of.GetLines())
        flat = np.asarray(clear_of.points, dtype=np.float64)[ids, :2]
        courses += np.split(flat, ends[1:-1])
    points = [_dense(course, STEP * letters) for course in courses]
    owners = np.repeat(np.arange(len(points)), [len(part) for part in points])
    if not points:
        return lambda _, places: np.zeros(len(places), np.bool_)
    tree = scipy.spatial.cKDTree(np.concatenate(points))

    def near(number: int, places: Array) -> Bools:
        distance, at = tree.query(places, NEIGHBOURS, distance_upper_bound=CLEAR * letters)
        other = np.isfinite(distance)
        other[other] = owners[np.asarray(at)[other]] != number
        return np.asarray(other.any(axis=1))

    return near


def _dense(course: Array, step: float) -> Array:
    """Return points along a line, no farther apart than a step."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(course, axis=0), axis=1))])
    at = np.linspace(0, along[-1], int(along[-1] / step) + 2)
    return np.column_stack([np.interp(at, along, course[:, axis]) for axis in (0, 1)])


def _lines(drawn: list[tuple[Array, float]], height: float) -> pv.PolyData:
    """Return lines with their levels as a mesh."""
    sizes = [len(piece) for piece, _ in drawn]
    flat = np.concatenate([np.empty((0, 2)), *(piece for piece, _ in drawn)])
    ends = np.cumsum([0, *sizes])
    lines = polylines.polydata(np.column_stack([flat, np.full(len(flat), height)]), ends)
    lines.point_data[LEVEL] = np.repeat([level for _, level in drawn], sizes)
    return lines


def _numbers(words: list[tuple[Array, Indices, float]], height: float) -> pv.PolyData:
    """Return the triangles of numbers with their levels as a mesh."""
    if not words:
        return pv.PolyData()
    flat, corners = words_of.union([(points, faces) for points, faces, _ in words])
    numbers = blocks.polydata(np.column_stack([flat, np.full(len(flat), height)]), corners)
    sizes = [len(points) for points, _, _ in words]
    numbers.point_data[LEVEL] = np.repeat([level for _, _, level in words], sizes)
    return numbers


def contoured(mesh: pv.DataSet, name: str, levels: Array, *, longest: float = math.inf) -> Pieces:
    """Return the connected pieces of isolines, each with its level.

    Arguments are as for :func:`isolines`; if all together are longer than ``longest`` none is
    returned, since to join those of noise takes minutes.
    """
    if name not in (*mesh.point_data, *mesh.cell_data):
        there = [*mesh.point_data, *mesh.cell_data]
        expected = f"the name of an array, {_words.one_of(there)}"
        raise _check.value_error("name", expected, _check.describe(name))
    mesh = records.averaged(mesh, name)
    values = np.asarray(mesh.point_data[name])
    if values.ndim != 1 or values.dtype.kind not in "biuf":
        expected, got = "an array of one component", f"{name!r} of {_check.describe(values)}"
        raise _check.value_error("name", expected, got)
    there = np.isfinite(values) & np.isfinite(mesh.points).all(axis=1)
    if not there.any():
        return []
    if not there.all():
        mesh = mesh.copy(deep=False)
        mesh.point_data[name] = np.where(there, values, np.nan)
        low, high = values[there].min(), values[there].max()
        mesh = mesh.threshold((low, high), scalars=name, all_scalars=True)
    lines = mesh.contour(np.unique(levels).tolist(), scalars=name, compute_normals=False)
    if not lines.n_lines:
        return []
    points = np.asarray(lines.points, dtype=np.float64)
    pairs = connectivity(lines.GetLines())[0].reshape(-1, 2)
    if np.linalg.norm(points[pairs[:, 1]] - points[pairs[:, 0]], axis=1).sum() > longest:
        return []
    # The points of a line have its level.
    at = np.asarray(lines.point_data[name], dtype=np.float64)[pairs[:, 0]]
    nearest = np.abs(at[:, np.newaxis] - levels).argmin(axis=1)
    pieces: Pieces = []
    # Each level by itself: where lines break does not depend on what other levels there are.
    for number in np.unique(nearest):
        ids, corners = np.unique(pairs[nearest == number], return_inverse=True)
        rows = np.insert(corners.reshape(-1, 2), 0, 2, axis=1)
        joined = pv.PolyData(points[ids], lines=rows).strip(join=True, max_length=100_000)
        order, ends = connectivity(joined.GetLines())
        flat = np.asarray(joined.points, dtype=np.float64)[order, :2]
        pieces += [(piece, float(levels[number])) for piece in np.split(flat, ends[1:-1])]
    return pieces


def are_smooth(
    mesh: pv.DataSet, pieces: Pieces, levels: Collection[float], letters: float, *, sparse: float
) -> bool:
    """Return whether isolines are few, long and apart: a field is smooth in its picture.

    Pieces are those of :func:`contoured`, looked at where their level is among ``levels``;
    ``sparse`` is the least distance between lines, in heights of letters.
    """
    lengths = np.array([_length(piece) for piece, level in pieces if level in levels])
    x, y, _ = mesh.bounds_size
    is_apart = x * y > sparse * letters * lengths.sum()
    return bool(is_apart and lengths[lengths > LONG * letters].sum() > SMOOTH * lengths.sum() > 0)


def _length(piece: Array) -> float:
    return float(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum())


def _place(
    piece: Array, room: float, taken: list[tuple[Array, float]], near: Callable[[Array], Bools]
) -> tuple[float, float, Array, Array] | None:
    """Return where a number stands: ends along the line, its middle and its direction."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(piece, axis=0), axis=1))])
    if along[-1] < 3 * room:
        return None
    starts = np.linspace(0.5 * room, along[-1] - 1.5 * room, PLACES)
    a, b, middle = (
        np.column_stack([np.interp(starts + shift, along, piece[:, axis]) for axis in (0, 1)])
        for shift in (0.0, room, room / 2)
    )
    chord = np.linalg.norm(b - a, axis=1)
    bent = np.linalg.norm(middle - (a + b) / 2, axis=1) / room
    good = chord * STRAIGHT > room
    for other, apart in taken:
        good &= np.linalg.norm(middle - other, axis=1) > apart
    if not good.any():
        return None
    # Where no other line crosses it, it is straight, and rather level than steep.
    steep = np.abs(b - a)[:, 1] / np.where(chord > 0, chord, 1)
    shares = np.linspace(0.1, 0.9, ALONG)[:, np.newaxis, np.newaxis]
    crossed = near(((1 - shares) * a + shares * b).reshape(-1, 2)).reshape(ALONG, -1).mean(axis=0)
    good &= crossed < CROSSED
    if not good.any():
        return None
    best = int(np.argmin(np.where(good, bent + 0.1 * steep + 2 * crossed, math.inf)))
    way = (b[best] - a[best]) / chord[best]
    if way[0] < 0:
        way = -way
    return float(starts[best]), float(starts[best] + room), (a[best] + b[best]) / 2, way


def _cut(piece: Array, start: float, end: float) -> list[Array]:
    """Return the parts of a line before and after a gap."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(piece, axis=0), axis=1))])

    def at(place: float) -> Array:
        return np.array([[np.interp(place, along, piece[:, axis]) for axis in (0, 1)]])

    return [
        np.concatenate([piece[along < start], at(start)]),
        np.concatenate([at(end), piece[along > end]]),
    ]
