"""What tells the places of a map: a frame of degrees, or a bar of lengths, as a flat mesh.

It is a mesh and not part of a window, so that it is in pictures, movies and pages alike.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh import georeference, meaning
from vizlight.vtk import letters

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Indices

__all__ = ["frame"]

#: Width of lines, length of ticks, and distance of words from them, in heights of letters.
LINE, TICK, GAP = 0.06, 0.35, 0.3
#: Height of digits, and distance between words of the bottom and of the left, in these.
DIGIT, BESIDE, ABOVE = 0.73, 1.6, 3.0
#: Steps between ticks in degrees: whole parts of a right angle, or of a degree.
STEPS = (
    *(s * 10.0**p for p in range(-4, 0) for s in (1, 2, 5)), 1, 2, 5, 10, 15, 20, 30, 45, 60, 90,
)  # fmt: skip
#: Difference of a direction from an axis that is none.
ALMOST = 1e-6
#: Largest number of ticks along a side.
MOST = 8
#: Largest length of a bar, as a share of the width of its map, and its height in letters.
BAR, THICK = 0.25, 0.2

#: Corners and triangles of one part of a frame.
Part = tuple["Array", "Indices"]


def frame(mesh: pv.DataSet, /, letters: float, *, up: Sequence[float] = (0.0, 1.0)) -> pv.PolyData:
    """Return what stands around a map: degrees with ticks, or a bar of a round length.

    A map in degrees has a thin frame with ticks in round steps along its left and its lower side.
    One in a unit of length has a bar below it. An arrow toward the north is below another map
    whose north is not straight up. Nothing is on the data.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Map, x east and y north, whose field array ``unit`` says ``degree`` or a unit of length.
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
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message("mesh", "a mesh", _check.describe(mesh)))
    _check.coordinates("mesh", mesh.bounds)
    letters = _check.positive("letters", letters)
    x, y, _ = _check.unit("up", (*_check.vector("up", up, direction=True, n=2), 0.0))
    turn = np.array([[y, -x], [x, y]])  # rows: right and up in the picture
    is_degrees = georeference.has_degrees(mesh)
    unit = (
        str(mesh.field_data[georeference.UNIT][0]) if georeference.UNIT in mesh.field_data else ""
    )
    metres = None if is_degrees else meaning.metres(unit)
    box = _box(mesh, turn)
    parts: list[Part] = []
    straight = max(abs(x), abs(y)) > 1 - ALMOST
    if is_degrees and straight:
        parts += _degrees(box, letters, np.rint(turn))
    elif y <= 1 - ALMOST:
        parts += _arrow(box, letters, turn)
    if metres is not None:
        parts += _bar(box, letters, metres)
    corners = np.concatenate([np.empty((0, 2)), *(points for points, _ in parts)])
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    ids = [part + start for (_, part), start in zip(parts, starts, strict=False)]
    triangles = np.concatenate([np.empty((0, 3), np.intp), *ids])
    flat = np.column_stack([corners @ turn, np.full(len(corners), mesh.bounds[5])])
    faces = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
    return pv.PolyData(flat, faces) if len(flat) else pv.PolyData()


def _box(mesh: pv.DataSet, turn: Array) -> Array:
    """Return left, right, bottom and top of a map in the picture."""
    if np.array_equal(turn, np.eye(2)):
        return np.array(mesh.bounds[:4])
    flat = np.asarray(mesh.points, dtype=np.float64)[:, :2] @ turn.T
    flat = flat[np.isfinite(flat).all(axis=1)]
    return np.stack([flat.min(axis=0), flat.max(axis=0)], axis=1).ravel()


def _degrees(box: Array, size: float, turn: Array) -> list[Part]:
    """Return a frame with its ticks and their words; in the picture x is 1, 0 or -1 of east."""
    left, right, bottom, top = box
    line = LINE * size
    parts = [
        _rectangle(left - line, right + line, bottom - line, bottom),
        _rectangle(left - line, right + line, top, top + line),
        _rectangle(left - line, left, bottom, top),
        _rectangle(right, right + line, bottom, top),
    ]
    below, beside = bottom - (TICK + GAP + DIGIT) * size, left - (TICK + GAP) * size
    for value, word in _along(left, right, size, turn[0]):
        parts.append(_rectangle(value - line / 2, value + line / 2, bottom - TICK * size, bottom))
        parts.append(_word(word, value, below, size, align=0.5))
    for value, word in _along(bottom, top, size, turn[1]):
        parts.append(_rectangle(left - TICK * size, left, value - line / 2, value + line / 2))
        parts.append(_word(word, beside, value - DIGIT * size / 2, size, align=1.0))
    return parts


def _along(low: float, high: float, size: float, way: Array) -> list[tuple[float, str]]:
    """Return the ticks along a side of the picture, which runs east, north, west or south."""
    sign = float(way.sum())
    low, high = sorted((sign * low, sign * high))
    return [
        (sign * value, word) for value, word in ticks(low, high, size, "EW" if way[0] else "NS")
    ]


def ticks(low: float, high: float, size: float, signs: str) -> list[tuple[float, str]]:
    """Return round places along a side of a map, and their words.

    Parameters
    ----------
    low, high : float
        Ends of the side in degrees.
    size : float
        Height of letters in degrees.
    signs : {"EW", "NS"}
        Letters for degrees above and below 0.
    """
    for step in STEPS:
        first, last = math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6)
        if last - first + 1 > MOST:
            continue
        places = [(i * step, _word_of(i * step, step, signs)) for i in range(first, last + 1)]
        widest = max((letters.width(word) for _, word in places), default=0.0)
        if step >= size * (widest * BESIDE if signs == "EW" else DIGIT * ABOVE):
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


def _bar(box: Array, size: float, metres: float) -> list[Part]:
    """Return a bar of a round length below a map, with its words."""
    left, right, bottom, _ = box
    most = BAR * (right - left) * metres
    power = 10.0 ** math.floor(math.log10(most))
    length = next(s * power for s in (5, 2, 1) if s * power <= most)
    word = f"{length / 1e3:g} km" if length >= 1e3 else f"{length:g} m"
    high = bottom - (GAP + (DIGIT - THICK) / 2) * size
    end = left + length / metres
    return [
        _rectangle(left, end, high - THICK * size, high),
        _word(word, end + 2 * GAP * size, bottom - (GAP + DIGIT) * size, size, align=0.0),
    ]


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


def _rectangle(left: float, right: float, bottom: float, top: float) -> Part:
    corners = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


def _word(word: str, x: float, y: float, size: float, *, align: float) -> Part:
    """Return a word whose left end, middle or right end, by its share, is at x, standing on y."""
    points, ids = letters.triangles(word)
    return size * (points - (align * letters.width(word), 0.0)) + (x, y), ids
