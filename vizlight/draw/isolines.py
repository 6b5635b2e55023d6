"""Isolines of a flat map with their numbers, each in a gap of its line."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check, _words
from vizlight.mesh import polylines, records
from vizlight.vtk import letters as words_of
from vizlight.vtk.cells import connectivity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Indices

__all__ = ["isolines"]

#: Room around a number within its line, and least distance between numbers, in heights of letters.
GAP, APART = 0.35, 4.0
#: Largest length of the arc below a number, in lengths of its chord: where a line is as straight.
STRAIGHT = 1.06
#: Length of lines that count as long, and distance between lines, in heights of letters; share of
#: the length of all in long ones, from which on a field is smooth in its picture.
LONG, SPARSE, SMOOTH = 6.0, 1.0, 0.75
#: Places along a line at which a number may stand.
PLACES = 60
#: Height of digits in the size of a font, and name of the array with the level of a line.
DIGIT, LEVEL = 0.73, "level"


def isolines(
    mesh: pv.DataSet, name: str, levels: Sequence[float], /, letters: float
) -> pv.MultiBlock:
    """Return lines of equal values on a flat map, with their numbers along them.

    Each line that has room has one number, where it is straightest, in a gap of the line; its top
    is toward larger y.

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

    Returns
    -------
    pyvista.MultiBlock
        Blocks ``lines`` and ``numbers``, of polylines and of triangles, with the point array
        ``level``.

    Raises
    ------
    TypeError, ValueError
        If the array is missing or has several components, a level is no finite number, or the
        letters have no positive height.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import cartography
    >>> slope = pv.Plane(i_size=40, j_size=30)
    >>> slope["x"] = slope.points[:, 0]
    >>> cartography.isolines(slope, "x", [-10, 0, 10], letters=1.0)["lines"].n_lines
    6
    """
    letters = _check.positive("letters", letters)
    values = _check.coordinates("levels", levels).ravel()
    pieces, levels_of = _pieces(mesh, name, values)
    drawn: list[tuple[Array, float]] = []
    words: list[tuple[Array, Indices, float]] = []
    taken: list[Array] = []
    for piece, level in sorted(
        zip(pieces, levels_of, strict=True), key=lambda pair: -_length(pair[0])
    ):
        text = f"{level:.6g}"
        word, triangles = words_of.triangles(text)
        width = words_of.width(text)
        place = _place(piece, (width + 2 * GAP) * letters, taken, APART * letters)
        if place is None:
            drawn.append((piece, level))
            continue
        start, end, middle, way = place
        taken.append(middle)
        drawn += [(part, level) for part in _cut(piece, start, end)]
        across = np.array([-way[1], way[0]])
        flat = letters * (word - (width / 2, DIGIT / 2))
        at = middle + flat[:, :1] * way + flat[:, 1:] * across
        words.append((at, triangles, level))
    height = float(mesh.bounds[5])
    return pv.MultiBlock({"lines": _lines(drawn, height), "numbers": _numbers(words, height)})


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
    sizes = [len(points) for points, _, _ in words]
    flat = np.concatenate([points for points, _, _ in words])
    starts = np.cumsum([0, *sizes[:-1]])
    ids = np.concatenate(
        [faces + start for (_, faces, _), start in zip(words, starts, strict=True)]
    )
    corners = np.column_stack([np.full(len(ids), 3), ids]).ravel()
    numbers = pv.PolyData(np.column_stack([flat, np.full(len(flat), height)]), corners)
    numbers.point_data[LEVEL] = np.repeat([level for _, _, level in words], sizes)
    return numbers


def _pieces(mesh: pv.DataSet, name: str, levels: Array) -> tuple[list[Array], list[float]]:
    """Return the connected pieces of isolines, and their levels."""
    if name not in (*mesh.point_data, *mesh.cell_data):
        there = [*mesh.point_data, *mesh.cell_data]
        expected = f"the name of an array, {_words.one_of(there)}"
        raise ValueError(_check.message("name", expected, _check.describe(name)))
    mesh = records.averaged(mesh, name)
    values = np.asarray(mesh.point_data[name], dtype=np.float64)
    if not np.isfinite(values).all():
        mesh = mesh.threshold(
            (np.nanmin(values), np.nanmax(values)), scalars=name, all_scalars=True
        )
    lines = mesh.contour(np.unique(levels).tolist(), scalars=name, compute_normals=False)
    if not lines.n_lines:
        return [], []
    lines = lines.strip(join=True, max_length=100_000)
    order, ends = connectivity(lines.GetLines())
    flat = np.asarray(lines.points, dtype=np.float64)[order, :2]
    pieces = np.split(flat, ends[1:-1])
    # The points of a line have its level.
    at = np.asarray(lines.point_data[name], dtype=np.float64)[order[ends[:-1]]]
    nearest = levels[np.abs(at[:, np.newaxis] - levels).argmin(axis=1)]
    return list(pieces), [float(level) for level in nearest]


def are_smooth(mesh: pv.DataSet, lines: pv.PolyData, letters: float) -> bool:
    """Return whether isolines are few, long and apart: a field is smooth in its picture.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Flat map.
    lines : pyvista.PolyData
        Block ``lines`` of its isolines.
    letters : float
        Height of letters in the unit of x and y.
    """
    ids, ends = connectivity(lines.GetLines())
    flat = np.asarray(lines.points, dtype=np.float64)[ids, :2]
    lengths = np.array([_length(piece) for piece in np.split(flat, ends[1:-1])])
    x, y, _ = mesh.bounds_size
    is_apart = x * y > SPARSE * letters * lengths.sum()
    return bool(is_apart and lengths[lengths > LONG * letters].sum() > SMOOTH * lengths.sum() > 0)


def _length(piece: Array) -> float:
    return float(np.linalg.norm(np.diff(piece, axis=0), axis=1).sum())


def _place(
    piece: Array, room: float, taken: list[Array], apart: float
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
    for other in taken:
        good &= np.linalg.norm(middle - other, axis=1) > apart
    if not good.any():
        return None
    # Where it is straight, and rather level than steep.
    steep = np.abs(b - a)[:, 1] / np.where(chord > 0, chord, 1)
    best = int(np.argmin(np.where(good, bent + 0.1 * steep, math.inf)))
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
