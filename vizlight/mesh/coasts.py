"""Coasts of the earth on maps: Natural Earth's, at the scale of 1 to 110 million."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
import pyvista as pv

from vizlight import _check, data
from vizlight._types import Array, Bools, Indices
from vizlight.mesh import charts, georeference, globes, polylines
from vizlight.vtk.cells import connectivity

#: Farthest ends of a map from 0, in degrees.
FARTHEST = 720.0


def coasts(bounds: pv.DataSet | Sequence[float], /) -> pv.PolyData:
    """Return the coasts within a map in degrees, or in lengths of a known projection, as lines.

    The lines are those of Natural Earth at 1:110 million, in the public domain: seas and the
    Caspian Sea, without lakes and without islands below some 2,000 square kilometres. They are
    repeated every 360 degrees, and end at the sides of the map.

    Parameters
    ----------
    bounds : pyvista.DataSet or (float, float, float, float)
        Map, whose highest z the lines get, or its west, east, south and north in degrees, with
        longitudes that may go on beyond 180; z is then 0. A map in lengths has a field array
        ``projection`` or ``crs``.

    Returns
    -------
    pyvista.PolyData
        Lines in the coordinates of the map; empty where no coast is.

    Raises
    ------
    TypeError, ValueError
        If the ends of the map are no finite numbers that ascend, or are farther than 720 degrees
        from 0.

    Examples
    --------
    >>> from vizlight import cartography
    >>> iceland = cartography.coasts((-26, -12, 62, 68))
    >>> iceland.n_lines
    1
    """
    height = 0.0
    if isinstance(bounds, pv.DataSet):
        height = bounds.bounds[5] if bounds.n_points else 0.0
        if (sheet := charts.sheet(bounds)) is not None:
            return _lines(sheet.pieces(_every()), height, georeference.unit_of(bounds))
        bounds = tuple(map(float, charts.box_of(bounds)))
    west, east, south, north = _sides(bounds)
    corner, size = np.array([west, south]), np.array([east - west, north - south])
    points, first = _segments()
    low = math.floor((west - points[..., 0].max()) / georeference.AROUND)
    high = math.ceil((east - points[..., 0].min()) / georeference.AROUND)
    parts = []
    for turn in range(low, high + 1):
        moved = points + np.array([georeference.AROUND * turn, 0.0])
        inside, kept = _clipped(moved, corner, size)
        # A line goes on where a segment begins at the end of the one before.
        goes_on = ~first[kept][1:] & (np.diff(kept) == 1) if len(kept) else np.empty(0, np.bool_)
        goes_on &= np.all(inside[1:, 0] == inside[:-1, 1], axis=1)
        parts += np.split(inside, np.flatnonzero(~goes_on) + 1) if len(inside) else []
    lines = [np.concatenate([part[:1, 0], part[:, 1]]) for part in parts]
    return _lines(lines, height, georeference.DEGREE)


def _lines(lines: list[Array], height: float, unit: str) -> pv.PolyData:
    """Return lines as a mesh."""
    ends: Indices = np.cumsum([0, *map(len, lines)])
    flat = np.concatenate([np.empty((0, 2)), *lines])
    shore = polylines.polydata(np.column_stack([flat, np.full(len(flat), height)]), ends)
    shore.field_data[georeference.UNIT] = [unit]
    return shore


@cache
def _every() -> list[Array]:
    """Return all coasts in degrees, in steps of a degree at most."""
    fine = globes.divided(_data())
    ids, ends = connectivity(fine.GetLines())
    return np.split(np.asarray(fine.points, dtype=np.float64)[ids, :2], ends[1:-1])


def _data() -> pv.PolyData:
    lines = data.load_example("coasts.vtp")
    assert isinstance(lines, pv.PolyData)
    return lines


def _sides(bounds: Sequence[float]) -> Array:
    """Return the west, east, south and north of a map."""
    sides = _check.coordinates("bounds", bounds)
    if sides.shape != (4,) or sides[0] > sides[1] or sides[2] > sides[3]:
        expected = "a mesh, or west, east, south and north in degrees that ascend"
        raise _check.value_error("bounds", expected, _check.describe(bounds))
    if np.abs(sides).max() > FARTHEST:
        expected = f"degrees, no farther than {FARTHEST:g} from 0"
        raise _check.value_error("bounds", expected, _check.describe(bounds))
    return sides


@cache
def _segments() -> tuple[Array, Bools]:
    """Return the ends of the segments of all coasts, (N, 2, 2), and whether each begins a line."""
    lines = _data()
    ids, ends = connectivity(lines.GetLines())
    places = np.asarray(lines.points, dtype=np.float64)[ids, :2]
    begins = np.zeros(len(ids), np.bool_)
    begins[ends[:-1]] = True
    segments = np.stack([places[:-1], places[1:]], axis=1)
    within = ~begins[1:]
    return segments[within], begins[:-1][within]


def _clipped(segments: Array, corner: Array, size: Array) -> tuple[Array, Indices]:
    """Return the parts of segments within a rectangle, and the numbers of these segments."""
    low, high = segments.min(axis=1), segments.max(axis=1)
    near = np.flatnonzero(np.all((high >= corner) & (low <= corner + size), axis=1))
    start, step = segments[near, 0], segments[near, 1] - segments[near, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        # Shares of a segment at which it meets the four sides; NaN where it lies on one.
        shares = np.stack([(corner - start) / step, (corner + size - start) / step])
    enter = np.fmax(np.fmax.reduce(shares.min(axis=0), axis=1), 0.0)
    leave = np.fmin(np.fmin.reduce(shares.max(axis=0), axis=1), 1.0)
    kept = np.flatnonzero(enter < leave)
    ends = np.stack([enter, leave], axis=1)[kept][..., np.newaxis]
    inside = start[kept, np.newaxis] + ends * step[kept, np.newaxis]
    # Whole ends are as they were, so that lines go on.
    inside[:, 0][enter[kept] == 0] = start[kept][enter[kept] == 0]
    whole = leave[kept] == 1
    inside[:, 1][whole] = segments[near, 1][kept][whole]
    return inside, near[kept]
