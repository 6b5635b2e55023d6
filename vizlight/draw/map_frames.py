"""The frame of a map: degrees, or a bar of lengths, as a flat mesh.

It is a mesh and not part of a window, so that it is in pictures, movies and pages alike.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Sequence

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.draw.ticks import even_numbers, round_length
from vizlight.mesh import blocks, charts, dates, georeference, meaning, polylines
from vizlight.vtk import letters
from vizlight.vtk.letters import DIGIT, union

#: Most degrees by which a meridian leans on a map with an arrow toward the north.
MOST_LEANING = 5.0
#: Width of lines, length of ticks, and distance of words from them, in heights of letters.
LINE, TICK, GAP = 0.06, 0.35, 0.3
#: Distance between words of the bottom, in widths of the widest, and of the left, in digits.
BESIDE, ABOVE = 1.6, 3.0
#: Steps between ticks in degrees: whole parts of a right angle, or of a degree.
STEPS = (
    *(s * 10.0**p for p in range(-4, 0) for s in (1, 2, 5)), 1, 2, 5, 10, 15, 20, 30, 45, 60, 90,
)  # fmt: skip
#: Difference of a direction from an axis that is none.
ALMOST = 1e-6
#: Largest number of ticks along a side, and of meridians around a pole.
MOST, MOST_AROUND = 8, 13
#: Width in metres of a map on which lengths are alike everywhere, so that it has a bar.
LIKE_LENGTHS = 2e6
#: Least part of the direction away from a map that is to the left, or down, where a parallel, or a
#: meridian, has its word.
ASIDE = 0.5
#: Points of a line of the graticule, and letters of the words on the map in those beside it.
FINE, SMALL = 721, 0.75
#: Largest length of a bar, as a share of the width of its map, and its height in letters.
BAR, THICK = 0.25, 0.2
#: Letters for degrees above and below 0, by the titles of scales.
SIGNS = {"longitude": "EW", "latitude": "NS"}
#: Length in metres from which on the numbers along a side are in kilometres.
FAR = 12e3
#: Turn of words along a height, which are read from the right.
READ_FROM_RIGHT = np.array([[0.0, 1.0], [-1.0, 0.0]])

#: Corners and triangles of one part of a frame.
Part = tuple["Array", "Indices"]


def frame(mesh: pv.DataSet, /, letters: float, *, up: Sequence[float] = (0.0, 1.0)) -> pv.PolyData:
    """Return the frame of a map: degrees with ticks, or a bar of a round length.

    A map in degrees, and one in lengths with a known projection, has a thin frame with round
    degrees along its left and its lower side. One in lengths has a bar of a round length below it,
    as has one in degrees, if it is less than 2000 km wide or of no known projection. An arrow
    toward the north is beside the bar, unless meridians lean by more than 5 degrees somewhere, and
    below a map without one whose north is not straight up and has no degrees. Nothing is on the
    data but the words of parallels around a pole.

    A vertical section of a file has round numbers along its left and its lower side instead, and
    words for them.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Map, x east and y north. Its field array ``unit`` says ``degree`` or a unit of length, and
        ``projection`` or ``crs`` the projection.
    letters : float
        Height of letters in the unit of x and y.
    up : (float, float), default: (0.0, 1.0)
        Direction on the map, east and north, that points up in the picture.

    Returns
    -------
    pyvista.PolyData
        Triangles at the highest z of the map; empty where neither unit is known and north is up.

    Raises
    ------
    TypeError, ValueError
        If the letters have no positive height, or the direction no length.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import cartography
    >>> europe = pv.ImageData(dimensions=(51, 36, 1), origin=(-10, 35, 0))
    >>> europe = cartography.in_degrees(europe)
    >>> cartography.frame(europe, letters=1.5).n_cells > 100
    True
    """
    letters, turn = _checked(mesh, letters, up)
    box = _box(mesh, turn)
    is_degrees, sheet = georeference.has_degrees(mesh), charts.sheet(mesh)
    straight = np.abs(turn).max() > 1 - ALMOST
    parts: list[Part] = []
    if section := meaning.of(mesh).section:
        # A section that is turned has no side that is its lower one.
        parts = _scales(box, letters, section) if turn[1, 1] > 1 - ALMOST else []
        return _joined(parts, mesh, turn)
    if is_degrees and straight:
        left, right, bottom, top = box
        # In the picture x is 1, 0 or -1 of east.
        x, y = np.rint(turn)
        east, north = _along(left, right, letters, x), _along(bottom, top, letters, y)
        parts += _sides(box, letters, east, north)
    if sheet is not None:
        parts += _around(sheet, letters, turn)
    metres = _bar_unit(mesh, sheet)
    if metres and (straight or not is_degrees):
        if parts:
            # Below the words of degrees.
            box[2] = min(points[:, 1].min() for points, _ in parts) - GAP * letters
        # An image of no place on the earth has no north.
        has_north = not meaning.is_photograph(mesh) and (sheet is None or _is_along_y(sheet))
        arrow = _arrow(box, letters, turn) if has_north else []
        parts += [*_bar(box, letters, metres), *arrow]
    elif turn[1, 1] <= 1 - ALMOST and not (is_degrees and straight):
        parts += _arrow(box, letters, turn)
    return _joined(parts, mesh, turn)


def _joined(parts: Sequence[Part], mesh: pv.DataSet, turn: Array) -> pv.PolyData:
    """Return parts in the picture as one mesh at the highest z of a map."""
    if not parts:
        return pv.PolyData()
    corners, triangles = union(parts)
    flat = np.column_stack([corners @ turn, np.full(len(corners), mesh.bounds[5])])
    return blocks.polydata(flat, triangles)


def graticule(
    mesh: pv.DataSet, /, letters: float, *, up: Sequence[float] = (0.0, 1.0)
) -> pv.PolyData:
    """Return the meridians and parallels of a map in lengths with a known projection, as lines.

    They are those that have a word in :func:`frame` of the same letters.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Map with a field array ``projection`` or ``crs`` of its projection.
    letters : float
        Height of letters in the unit of x and y.
    up : (float, float), default: (0.0, 1.0)
        Direction on the map that points up in the picture.

    Returns
    -------
    pyvista.PolyData
        Lines at the highest z of the map; empty where its projection is not known.

    Raises
    ------
    TypeError, ValueError
        If the letters have no positive height, or the direction no length.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import cartography
    >>> europe = pv.ImageData(dimensions=(51, 36, 1), origin=(-10, 35, 0))
    >>> europe = cartography.chart(cartography.in_degrees(europe))
    >>> cartography.graticule(europe, letters=150e3).n_lines
    14
    """
    letters, _ = _checked(mesh, letters, up)
    sheet = charts.sheet(mesh)
    lines = [] if sheet is None else [line for line, _, _ in _graticule(sheet, letters)]
    flat = np.concatenate([np.empty((0, 2)), *lines])
    ends = np.cumsum([0, *map(len, lines)])
    return polylines.polydata(np.column_stack([flat, np.full(len(flat), mesh.bounds[5])]), ends)


def has_bar(mesh: pv.DataSet) -> bool:
    """Return whether the frame of a map has a bar below its degrees."""
    sheet = charts.sheet(mesh)
    is_known = georeference.has_degrees(mesh) or sheet is not None
    return is_known and _bar_unit(mesh, sheet) > 0


def _checked(mesh: pv.DataSet, letters: float, up: Sequence[float]) -> tuple[float, Array]:
    """Return the height of letters, and the rows right and up in the picture."""
    _check.instance("mesh", mesh, pv.DataSet, "a mesh")
    _check.coordinates("mesh", mesh.bounds)
    letters = _check.positive("letters", letters)
    x, y, _ = _check.unit("up", (*_check.vector("up", up, direction=True, n=2), 0.0))
    return letters, np.array([[y, -x], [x, y]])


def _bar_unit(mesh: pv.DataSet, sheet: charts.MapSheet | None) -> float:
    """Return the length of x in metres on a map that has a bar, 0 on others.

    On a map whose projection is known that is the length on the earth in the middle of the map.
    """
    metres = meaning.metres(georeference.unit_of(mesh)) or 0.0
    if georeference.has_degrees(mesh):
        metres = georeference.METRES * math.cos(math.radians(mesh.center[1]))
    elif sheet is None:
        return metres
    else:
        metres = sheet.unit
    return metres if max(mesh.bounds_size[:2]) * metres < LIKE_LENGTHS else 0.0


def _box(mesh: pv.DataSet, turn: Array) -> Array:
    """Return left, right, bottom and top of a map in the picture."""
    if np.array_equal(turn, np.eye(2)):
        return charts.box_of(mesh)
    flat = np.asarray(mesh.points, dtype=np.float64)[:, :2] @ turn.T
    flat = flat[np.isfinite(flat).all(axis=1)]
    return np.stack([flat.min(axis=0), flat.max(axis=0)], axis=1).ravel()


def _sides(box: Array, size: float, *words: Sequence[tuple[float, str]]) -> list[Part]:
    """Return a frame with ticks and their words: those along its lower and along its left side."""
    left, right, bottom, top = box
    line = LINE * size
    parts = [
        rectangle(left - line, right + line, bottom - line, bottom),
        rectangle(left - line, right + line, top, top + line),
        rectangle(left - line, left, bottom, top),
        rectangle(right, right + line, bottom, top),
    ]
    below, beside = bottom - (TICK + GAP + DIGIT) * size, left - (TICK + GAP) * size
    for value, word in words[0]:
        parts.append(rectangle(value - line / 2, value + line / 2, bottom - TICK * size, bottom))
        parts.append(_word(word, value, below, size, align=0.5))
    for value, word in words[1]:
        parts.append(rectangle(left - TICK * size, left, value - line / 2, value + line / 2))
        parts.append(_word(word, beside, value - DIGIT * size / 2, size, align=1.0))
    return parts


def _scales(box: Array, size: float, section: Sequence[meaning.AxisScale]) -> list[Part]:
    """Return the frame of a section: round numbers along two sides, and what they are."""
    left, right, bottom, top = box
    flat, up = _in_kilometres(section[0], right - left), _in_kilometres(section[1], top - bottom)
    below = _numbers(left, right, size, flat, is_up=False)
    beside = _numbers(bottom, top, size, up, is_up=True)
    widest = max((letters.width(word) for _, word in beside), default=0.0)
    under = bottom - (TICK + 3 * GAP + 2 * DIGIT) * size
    aside = left - (TICK + 3 * GAP + widest) * size
    parts = _sides(box, size, below, beside)
    titles = (
        (_title(flat, below), right - left, np.eye(2), ((left + right) / 2, under)),
        (_title(up, beside), top - bottom, READ_FROM_RIGHT, (aside, (bottom + top) / 2)),
    )
    for title, long, turn, place in titles:
        if title:
            small = min(size, long / letters.width(title))
            points, ids = _word(title, 0.0, 0.0, small, align=0.5)
            parts.append((points @ turn + place, ids))
    return parts


def _in_kilometres(scale: meaning.AxisScale, long: float) -> meaning.AxisScale:
    """Return a scale in kilometres where it is in metres and a side is so long."""
    is_far = scale.unit == "m" and long >= FAR * abs(scale.factor)
    return scale._replace(unit="km", factor=1e3 * scale.factor) if is_far else scale


def _title(scale: meaning.AxisScale, numbers: Sequence[tuple[float, str]]) -> str:
    """Return the words for the numbers along a side, none for those that say it themselves."""
    if scale.title in SIGNS:
        return ""
    words = [word for _, word in numbers] if " since " in scale.unit else []
    if any(re.match(r"\d{4}", word) for word in words):
        return ""
    if any(":" in word for word in words):
        return dates.date(numbers[0][0] / scale.factor, scale.unit)[:10]
    return f"{scale.title} ({scale.unit})" if scale.unit else scale.title


def _numbers(
    low: float, high: float, size: float, scale: meaning.AxisScale, *, is_up: bool
) -> list[tuple[float, str]]:
    """Return the places of round numbers or dates along a side of a section, and their words."""
    first, last = sorted((low / scale.factor, high / scale.factor))
    if scale.title in SIGNS:
        degrees = size / abs(scale.factor)
        round_degrees = ticks(first, last, degrees, SIGNS[scale.title], is_up=is_up)
        return [(scale.factor * value, word) for value, word in round_degrees]
    of_dates = dates.round_dates(first, last, scale.unit, MOST) if scale.title == "time" else ()
    fewer = (even_numbers(first, last, most) for most in range(MOST, 1, -1))
    others = _round_powers(first, last) if scale.is_log else fewer
    for numbers in itertools.chain(of_dates, others):
        places = [(scale.factor * value, word) for value, word in numbers]
        widest = max((letters.width(word) for _, word in places), default=0.0)
        room = size * (DIGIT * ABOVE if is_up else widest * BESIDE)
        if all(abs(b - a) >= room for (a, _), (b, _) in itertools.pairwise(places)):
            return places
    return []


def _round_powers(low: float, high: float) -> Iterator[list[tuple[float, str]]]:
    """Yield the logarithms of round numbers within a range of these, and their digits."""
    powers = range(math.floor(low), math.ceil(high) + 1)
    for digits, step in (((1, 2, 5), 1), ((1, 3), 1), *(((1,), step) for step in range(1, MOST))):
        values = [digit * 10.0**power for power in powers if power % step == 0 for digit in digits]
        every = [(math.log10(value), f"{value:.6g}") for value in values]
        yield [(place, word) for place, word in every if low - ALMOST <= place <= high + ALMOST]


def _graticule(sheet: charts.MapSheet, size: float) -> list[tuple[Array, str, bool]]:
    """Return parts of parallels and meridians, their words, and whether they are meridians."""
    west, east, south, north = sheet.extent
    is_around = sheet.is_around
    # The height of letters in degrees where meridians are farthest apart.
    degrees = size * sheet.metres / georeference.METRES
    least = 0.0 if south <= 0 <= north else min(abs(south), abs(north))
    wide = degrees / math.cos(math.radians(min(least, 80.0)))
    if not is_around:
        # Their words stand at the lower side, which may be shorter.
        corners = sheet.plane.forward(np.array([[west, south], [east, south]]))
        # The corners of the earth as a satellite sees it have no place.
        if np.isfinite(corners).all():
            long = float(np.linalg.norm(corners[1] - corners[0])) / georeference.METRES
            wide = max(wide, 0.8 * degrees * (east - west) / long)
    meridians = ticks(west, east, wide, "EW", MOST_AROUND if is_around else MOST)
    parallels = [tick for tick in ticks(south, north, degrees, "NS") if abs(tick[0]) < 90]
    # Not all meridians meet at a pole.
    ends = [value for value, _ in parallels]
    low = min(ends, default=south) if is_around and south == -90 else south - 1
    high = max(ends, default=north) if is_around and north == 90 else north + 1
    lines, names = [], []
    for value, word in meridians[: len(meridians) - is_around]:
        lat = np.clip(np.linspace(low, high, FINE), -90, 90)
        lines.append(np.column_stack([np.full(FINE, value), lat]))
        names.append((word, True))
    for value, word in parallels:
        lon = np.linspace(west, east, FINE) if is_around else np.linspace(west - 1, east + 1, FINE)
        lines.append(np.column_stack([lon, np.full(FINE, value)]))
        names.append((word, False))
    return [
        (piece, *name)
        for line, name in zip(lines, names, strict=True)
        for piece in sheet.pieces([line])
    ]


def _around(sheet: charts.MapSheet, size: float, turn: Array) -> list[Part]:
    """Return the outline of a map with the words of its graticule where this meets it."""
    outline = sheet.outline @ turn.T
    parts = [_border(outline, LINE * size)]
    is_around = sheet.is_around
    near = charts.EDGE * sheet.size
    # Meridians end below a map, and beside one that lies on its side.
    below, beside = np.array([[0.0, -1.0], [-1.0, 0.0]])
    if abs(turn[1, 0]) > abs(turn[1, 1]):
        below, beside = beside, below
    boxes: list[Array] = []
    for piece, word, is_meridian in _graticule(sheet, size):
        flat = piece @ turn.T
        if is_around and not is_meridian:
            if np.allclose(flat[0], flat[-1], rtol=0, atol=near):
                # A parallel around a pole has its word on its inner side, to the lower right.
                small, middle = SMALL * size, flat.mean(axis=0)
                x, y = flat[int(((flat - middle) @ (1.0, -2.0)).argmax())]
                parts.append(_word(word, x, y + GAP * small, small, align=0.5))
            continue
        for toward in (below, beside) if is_meridian else (beside, below):
            ends = [(*_away(end, outline, 2 * near, toward), end) for end in (flat[0], flat[-1])]
            if is_around:
                break
            # One word for each line, at the end that is farthest to its side, or at another side
            # where it has none.
            ends = sorted(ends, key=lambda crossing: -float(crossing[2] @ toward))
            ends = [crossing for crossing in ends if crossing[0] >= ASIDE][:1]
            if ends:
                break
        for score, way, end in ends:
            if score < -1:
                continue
            half = np.array([letters.width(word), DIGIT]) * size / 2
            middle = _beside(end, way, toward, half, size)
            low, high = middle - half - GAP * size, middle + half + GAP * size
            if any(np.all((low < other[1]) & (other[0] < high)) for other in boxes):
                continue
            boxes.append(np.stack([low, high]))
            parts.append(_tick(end, way, size))
            parts.append(_word(word, middle[0], middle[1] - half[1], size, align=0.5))
    return parts


def _beside(end: Array, way: Array, toward: Array, half: Array, size: float) -> Array:
    """Return the middle of a word at the end of a tick: at the tick's height where there is room.

    ``way`` is that of the tick, ``toward`` the side of the map, ``half`` half of the word's box.
    """
    start, aside, extent = end + way * (TICK + GAP) * size, way @ toward, np.abs(way) @ half
    if aside < ASIDE:
        return np.asarray(start + way * extent)
    # The box is beyond the tick, and beyond the line of the border.
    far = max(np.abs(toward) @ half, (extent - TICK * size) / aside)
    return np.asarray(start + toward * far)


def _away(end: Array, outline: Array, near: float, toward: Array) -> tuple[float, Array]:
    """Return how well the direction away from a map is that to its word, and this direction.

    The share is that of the best of the sides near the end of a line, -inf without any.
    """
    sides = np.roll(outline, -1, axis=0) - outline
    lengths = np.maximum(np.einsum("ij,ij->i", sides, sides), np.finfo(float).tiny)
    shares = np.clip(np.einsum("ij,ij->i", end - outline, sides) / lengths, 0, 1)
    nearest = outline + shares[:, np.newaxis] * sides
    at = np.flatnonzero(np.linalg.norm(nearest - end, axis=1) < near)
    if not len(at):
        return -math.inf, toward
    away = np.column_stack([sides[at, 1], -sides[at, 0]])
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), np.finfo(float).tiny)
    best = int((away @ toward).argmax())
    return float(away[best] @ toward), away[best]


def _border(outline: Array, wide: float) -> Part:
    """Return a band of a width outside of an outline that runs counter-clockwise."""
    kept = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1) > 0
    outline = outline[kept]
    ahead = np.roll(outline, -1, axis=0) - outline
    away = np.column_stack([ahead[:, 1], -ahead[:, 0]])
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    sums = away + np.roll(away, 1, axis=0)
    # A corner goes on to where the bands of its sides meet, if it is not sharp.
    miter = 2 / np.maximum(np.einsum("ij,ij->i", sums, sums), 1.0)
    outer = outline + wide * sums * miter[:, np.newaxis]
    count = len(outline)
    at = np.arange(count)
    ahead_of = (at + 1) % count
    first = np.column_stack([at, at + count, ahead_of + count])
    second = np.column_stack([at, ahead_of + count, ahead_of])
    return np.concatenate([outline, outer]), np.concatenate([first, second])


def _tick(end: Array, way: Array, size: float) -> Part:
    """Return a tick from a place of the outline outward."""
    across = LINE / 2 * size * np.array([way[1], -way[0]])
    far = end + TICK * size * way
    corners = np.array([end - across, far - across, far + across, end + across])
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


def _along(low: float, high: float, size: float, way: Array) -> list[tuple[float, str]]:
    """Return the ticks along a side of the picture, which runs east, north, west or south."""
    sign = float(way.sum())
    low, high = sorted((sign * low, sign * high))
    return [
        (sign * value, word) for value, word in ticks(low, high, size, "EW" if way[0] else "NS")
    ]


def ticks(
    low: float, high: float, size: float, signs: str, most: int = MOST, *, is_up: bool | None = None
) -> list[tuple[float, str]]:
    """Return round places along a side of a map, and their words.

    The ends and ``size``, the height of letters, are in degrees; ``signs``, "EW" or "NS", are
    letters for degrees above and below 0, and ``most`` is the largest number of places. ``is_up``:
    they stand one above the other, as latitudes do by default.
    """
    is_up = signs == "NS" if is_up is None else is_up
    for step in STEPS:
        first, last = math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6)
        if last - first + 1 > most:
            continue
        places = [(i * step, _word_of(i * step, step, signs)) for i in range(first, last + 1)]
        widest = max((letters.width(word) for _, word in places), default=0.0)
        if step >= size * (DIGIT * ABOVE if is_up else widest * BESIDE):
            return places
    return []


def _word_of(value: float, step: float, signs: str) -> str:
    """Return a longitude or a latitude as maps have it, such as 30°E."""
    if signs == "EW":
        value = (value + 180.0) % 360.0 - 180.0
    digits = max(-math.floor(math.log10(step) + 1e-9), 0)
    number = f"{abs(value):.{digits}f}"
    # The meridians of 0 and of 180 degrees have no side.
    sign = "" if float(number) in (0.0, 180.0) else signs[int(value < 0)]
    return f"{number}°{sign}"


#: Units of a bar in metres, the largest first.
_LENGTHS = ((1e3, "km"), (1.0, "m"), (1e-3, "mm"), (0.0, "m"))


def _bar(box: Array, size: float, metres: float) -> list[Part]:
    """Return a bar of a round length below a map, with its words."""
    left, right, bottom, _ = box
    length = round_length(BAR * (right - left) * metres)
    factor, unit = next(pair for pair in _LENGTHS if length >= pair[0])
    word = f"{length / (factor or 1):g} {unit}"
    high = bottom - (GAP + (DIGIT - THICK) / 2) * size
    end = left + length / metres
    return [
        rectangle(left, end, high - THICK * size, high),
        _word(word, end + 2 * GAP * size, bottom - (GAP + DIGIT) * size, size, align=0.0),
    ]


def _is_along_y(sheet: charts.MapSheet) -> bool:
    """Return whether meridians run along y everywhere on the outline of a map, or nearly so."""
    places = sheet.outline * sheet.metres
    earth = sheet.plane.inverse(places)
    ahead = sheet.plane.forward(earth + np.array([0.0, charts.STEP])) - places
    lean = np.degrees(np.arctan2(np.abs(ahead[:, 0]), ahead[:, 1]))
    return bool(np.all(lean[np.isfinite(lean)] <= MOST_LEANING))


def _arrow(box: Array, size: float, turn: Array) -> list[Part]:
    """Return an arrow toward the north with an N, below the right end of a map."""
    north = turn[:, 1]
    across = np.array([north[1], -north[0]])
    middle = np.array([box[1] - 1.2 * size, box[2] - 1.3 * size])
    rows = np.array([[0.0, 1.0], [-0.35, -0.1], [0.0, 0.1], [0.35, -0.1]])
    corners = middle + size * (rows[:, :1] * across + rows[:, 1:] * north)
    x, y = middle - 0.55 * size * north
    head: Part = (corners, np.array([[0, 1, 2], [0, 2, 3]]))
    return [head, _word("N", x, y - DIGIT * size / 2, size, align=0.5)]


def rectangle(left: float, right: float, bottom: float, top: float) -> Part:
    """Return a rectangle as two triangles."""
    corners = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


def _word(word: str, x: float, y: float, size: float, *, align: float) -> Part:
    """Return a word with its left end, middle or right end, by a share, at x, standing on y."""
    points, ids = letters.triangles(word)
    return size * (points - (align * letters.width(word), 0.0)) + (x, y), ids
