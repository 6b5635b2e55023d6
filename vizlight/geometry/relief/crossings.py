"""Horizons of nodes of a height field toward an azimuth, through every cell in the way.

A field is turned so that the azimuth goes toward rising columns and rows, by ``slope`` along y per
length along x. Between two crossings of cell sides the height along the ray is a quadratic; its arc
may rise above its chord. Beyond the border the heights of the border continue.

:func:`sweep` looks from all nodes of an even field at once, :func:`follow` from some nodes of any
field, both by NumPy; :func:`exact` is the compiled code for some nodes of any field.
"""

from __future__ import annotations

import math

import numpy as np

from vizlight import _compiled
from vizlight._types import Array, Bools, Indices

#: Stands for the slope of a horizon without terrain.
NONE = -1e300
#: Distance in columns up to which NumPy finds the top of an arc; beyond it the arc's middle counts.
ARCS = 12
#: Columns after which NumPy looks whether the rest is too low to count, and rounding of float32.
LOOK, SINGLE = 8, 1e-6


def sweep(z: Array, widths: tuple[float, float], slope: float, near: int, least: float) -> Array:
    """Return slopes of the horizons of all nodes of an even field, 0 or more.

    ``z`` (ny, nx) is NaN in holes, ``widths`` are the distances of columns and of rows, and
    ``slope`` is that of the azimuth, from 0 to a row per column. The walk ends at ``near`` columns;
    it goes to the border from the number of columns. ``least`` is the share of the sky that may be
    missed, by arcs over their chords and by distant terrain.
    """
    rows, columns = z.shape
    top = float(np.nanmax(z))
    # Half as many bytes take half the time, where rounding is well below what may be missed.
    if SINGLE * (top - float(np.nanmin(z))) < least * min(widths):
        z = z.astype(np.float32)
    # From every node the ray crosses the same sides at the same distances, so that one event of
    # all nodes is a difference of two parts of the field.
    padded = np.pad(z, [(0, rows), (0, columns)], mode="edge")
    twist = z[1:, 1:] - z[1:, :-1] - z[:-1, 1:] + z[:-1, :-1]
    most = float(np.nanmax(np.abs(twist), initial=0.0)) if np.isfinite(twist).any() else 0.0
    # In cells: rows per column, and the length of the ray per column.
    per = slope * widths[0] / widths[1]
    length = widths[0] * math.hypot(1.0, slope)
    t: Array = np.zeros(z.shape, z.dtype)
    a = b = 0
    before, u, v = 0.0, 0.0, 0.0
    last: Array = z
    while True:
        # Beyond the last column heights change with the rows alone, and the other way round.
        to_column = a + 1.0 if a < columns - 1 else math.inf
        to_row = (b + 1) / per if b < rows - 1 and per > 0 else math.inf
        now = min(to_column, to_row)
        if math.isinf(now) or (now > near and near < columns):
            return t
        if to_column <= to_row:
            # Rounding may put a row that is just reached on either side.
            u1, v1 = 1.0, 1.0 if to_column == to_row else min(max(now * per - b, 0.0), 1.0)
            low, high = (padded[k : k + rows, a + 1 : columns] for k in (b, min(b + 1, rows)))
            place = low if v1 == 0 else high if v1 == 1 else low + v1 * (high - low)
        else:
            u1, v1 = min(max(now - a, 0.0), 1.0), 1.0
            low, high = (padded[b + 1 : rows, k : k + columns] for k in (a, min(a + 1, columns)))
            place = low if u1 == 0 else high if u1 == 1 else low + u1 * (high - low)
        part = t[: place.shape[0], : place.shape[1]]
        # fmax passes over NaN: a hole blocks nothing.
        rise: Array = place - z[: place.shape[0], : place.shape[1]]
        rise *= 1 / (now * length)
        np.fmax(part, rise, out=part)
        size, bend = (max(rows - 1 - b, 0), max(columns - 1 - a, 0)), (u1 - u) * (v1 - v)
        middle = (before + now) / 2
        if min(size) > 0 and bend * most > 4 * least * middle * length:
            inner = np.s_[: size[0], : size[1]]
            ends = last[inner] - z[inner], place[inner] - z[inner]
            curve = bend * twist[b:, a:]
            if now <= ARCS:
                rise = _arc(*ends, (before, now), curve) / length
            else:
                rise = ((ends[0] + ends[1]) * 2 - curve) * (1 / (4 * middle * length))
            np.fmax(t[inner], rise, out=t[inner])
        before, u, v, last = now, u1, v1, place
        if to_column <= to_row:
            a, u = a + 1, 0.0
        if to_row <= to_column:
            b, v = b + 1, 0.0
        # The share falls with the square of the slope: what is far and low does not count.
        if a % LOOK == 0 and u == 0:
            highest = (top - z) * (1 / (now * length))
            if not np.any(highest * highest - t * t > least):
                return t


def follow(
    z: Array, x: Array, y: Array, rows: Indices, columns: Indices, slope: Array, top: float
) -> Array:  # fmt: skip
    """Return slopes of the horizons of some nodes of any field, 0 or more.

    ``z`` (ny, nx) is NaN in holes, x and y rise; ``slope`` is that of the azimuth of each node,
    ``top`` the largest height.
    """
    t: Array = np.zeros(len(rows))
    rays = _Walk(z, x, y, rows, columns, slope)
    while len(rays.row):
        now, place, curve = rays.step()
        going = np.isfinite(now)
        with np.errstate(all="ignore"):
            rise = np.fmax((place - rays.here) / now, _arc(
                rays.last - rays.here, place - rays.here, (rays.before, now), curve
            )) / rays.length  # fmt: skip
        at = rays.row[going]
        t[at] = np.fmax(t[at], rise[going])
        # From here on not even the largest height of the field rises above the horizon.
        going[going] &= (top - rays.here >= t[rays.row] * rays.length * rays.before)[going]
        rays.before, rays.last = now, place
        if not going.all():
            rays.keep(going)
    return t


class _Walk:
    """Rays of some nodes in progress, each from side to side of its own cells."""

    def __init__(
        self, z: Array, x: Array, y: Array, rows: Indices, columns: Indices, slope: Array
    ) -> None:
        self.z, self.x, self.y = z, x, y
        self.slope, self.length = slope, np.hypot(1.0, slope)
        self.row = np.arange(len(rows))
        self.a, self.b = columns.copy(), rows.copy()
        self.x0, self.y0, self.here = x[columns], y[rows], z[rows, columns]
        self.u, self.v = np.zeros(len(rows)), np.zeros(len(rows))
        self.before: Array = np.zeros(len(rows))
        self.last: Array = self.here

    def keep(self, going: Bools) -> None:
        """Drop the rays that have ended."""
        for name in vars(self).keys() - {"x", "y", "z"}:
            setattr(self, name, getattr(self, name)[going])

    def step(self) -> tuple[Array, Array, Array]:
        """Move rays over their cells; return distances along x, with their heights and bends."""
        z, x, y, a, b = self.z, self.x, self.y, self.a, self.b
        # Beyond the border a cell has no width, and no further side along that axis.
        a1, b1 = np.minimum(a + 1, len(x) - 1), np.minimum(b + 1, len(y) - 1)
        with np.errstate(all="ignore"):
            to_column = np.where(a1 > a, x[a1] - self.x0, math.inf)
            to_row = np.where(b1 > b, (y[b1] - self.y0) / self.slope, math.inf)
            now = np.minimum(to_column, to_row)
            u1 = np.where(to_column <= to_row, 1.0, (self.x0 + now - x[a]) / (x[a1] - x[a]))
            v1 = np.where(
                to_row <= to_column, 1.0, (self.y0 + now * self.slope - y[b]) / (y[b1] - y[b])
            )
        u1, v1 = (np.clip(np.nan_to_num(share), 0, 1) for share in (u1, v1))
        z00, z01, z10, z11 = z[b, a], z[b, a1], z[b1, a], z[b1, a1]
        # At a column the ray is between its two nodes, at a row between two others.
        place = np.where(to_column <= to_row, mixed(z01, z11, v1), mixed(z10, z11, u1))
        curve = (z11 - z10 - z01 + z00) * (u1 - self.u) * (v1 - self.v)
        self.u = np.where(to_column <= to_row, 0.0, u1)
        self.v = np.where(to_row <= to_column, 0.0, v1)
        self.a, self.b = np.where(to_column <= to_row, a1, a), np.where(to_row <= to_column, b1, b)
        return now, place, curve


def mixed(low: Array, high: Array, share: Array) -> Array:
    """Return heights between two nodes, at one of them whatever the other is: it may be a hole."""
    return np.where(share == 0, low, np.where(share == 1, high, low + share * (high - low)))


def _arc(
    last: Array, place: Array, ends: tuple[float | Array, float | Array], curve: Array
) -> Array:
    """Return the largest slope to arcs above their chords, NaN where the chord's ends are higher.

    ``last`` and ``place`` are heights above the node at both ends, ``curve`` is the second
    derivative by the distance, halved and times the square of the width.
    """
    before, now = ends
    width = now - before
    with np.errstate(all="ignore"):
        c2 = curve / (width * width)
        c1 = (place - last) / width - c2 * (before + now)
        c0 = last - before * (c1 + before * c2)
        peak = np.sqrt(c0 / c2)
        # From the node itself the slope only falls along the arc: it is largest at its start.
        top = np.where(np.equal(before, 0), c1, c1 + 2 * c2 * peak)
        arched = (c2 < 0) & (np.equal(before, 0) | ((c0 < 0) & (before < peak) & (peak < now)))
    return np.where(arched, top, np.nan)


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def between(low: float, high: float, share: float) -> float:
    """Return a height between two nodes, at one of them whatever the other is."""
    if share == 0:
        return low
    return high if share == 1 else low + share * (high - low)


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def beyond(
    heights: Array, nodes: Array, first: int, end: int, origin: float, scale: float, here: float,
    t: float,
) -> float:  # fmt: skip
    """Return the largest slope to the nodes of the last row or column, where a ray leaves it."""
    for m in range(first, end):
        place = heights[m]
        # False for NaN alone: a hole blocks nothing.
        if place == place:
            t = max(t, (place - here) / ((nodes[m] - origin) * scale))
    return t


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def arc(
    t: float, here: float, length: float, ends: tuple[float, float], heights: tuple[float, float],
    bend: float,
) -> float:  # fmt: skip
    """Return the largest slope to an arc between two places on a ray: a quadratic above its chord.

    ``bend`` is its second derivative by the distance, halved and times the square of the width.
    """
    before, now = ends
    last, place = heights
    width = now - before
    # At a distance s along x the arc is c0 + c1 s + c2 s^2 above the node.
    c2 = bend / (width * width)
    c1 = (place - last) / width - c2 * (before + now)
    # From the node itself the slope only falls along the arc: it is largest at its start.
    if before == 0:
        return max(t, c1 / length)
    c0 = last - here - before * (c1 + before * c2)
    # The slope c0 / s + c1 + c2 s is largest at s = sqrt(c0 / c2), where it is c1 + 2 c2 s.
    if c0 < 0:
        peak = math.sqrt(c0 / c2)
        if before < peak < now:
            return max(t, (c1 + 2 * c2 * peak) / length)
    return t


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def crossed(
    z: Array, x: Array, y: Array, i: int, j: int, slope: float, end: int, t: float, top: float
) -> float:  # fmt: skip
    """Return the largest slope from a node to the bilinear surface, up to a column.

    ``top`` is the largest height: the walk ends where nothing can be higher than the horizon.
    """
    here = z[j, i]
    length = math.sqrt(1 + slope * slope)
    inverse = 1 / slope if slope > 0 else math.inf
    a, b, u, v, before, last = i, j, 0.0, 0.0, 0.0, here
    rows = len(y)
    while a < end and b < rows - 1:
        # Distances are along x here; those along the ray are longer by the factor ``length``.
        to_column = x[a + 1] - x[i]
        to_row = (y[b + 1] - y[j]) * inverse if slope > 0 else math.inf
        z00, z01, z10, z11 = z[b, a], z[b, a + 1], z[b + 1, a], z[b + 1, a + 1]
        if to_column < to_row:
            now, u1 = to_column, 1.0
            v1 = min((y[j] + now * slope - y[b]) / (y[b + 1] - y[b]), 1.0) if slope > 0 else 0.0
            place = between(z01, z11, v1)
        # Through a node: its height alone counts, as one of its neighbours may be a hole.
        elif to_column == to_row:
            now, u1, v1, place = to_column, 1.0, 1.0, z11
        else:
            now, v1 = to_row, 1.0
            u1 = min((x[i] + now - x[a]) / (x[a + 1] - x[a]), 1.0)
            place = z10 + u1 * (z11 - z10)
        if place == place:
            t = max(t, (place - here) / (now * length))
        # Along the ray the height is a quadratic, whose arc may be above its chord.
        bend = (z11 - z10 - z01 + z00) * (u1 - u) * (v1 - v)
        if bend < 0:
            t = arc(t, here, length, (before, now), (last, place), bend)
        before, last, u, v = now, place, u1, v1
        if to_column <= to_row:
            a, u = a + 1, 0.0
        if to_row <= to_column:
            b, v = b + 1, 0.0
        # From here on not even the largest height of the field rises above the horizon.
        if (top - here) < t * before * length:
            break
    # Beyond the border heights stay as they are there: the ray goes on over those of the last row.
    if b == rows - 1:
        return beyond(z[b], x, a + 1, end + 1, x[i], length, here, t)
    if a == len(x) - 1 and slope > 0:
        scale = inverse * length
        return beyond(z[:, a], y, b + 1, rows, y[j], scale, here, t)
    return t


@_compiled.kernel()
def exact(
    z: Array, x: Array, y: Array, rows: Indices, columns: Indices, slope: float, top: float,
    out: Array,
) -> None:  # fmt: skip
    """Write slopes of the horizons of some nodes toward an azimuth, through every cell."""
    for n in range(len(out)):
        out[n] = crossed(z, x, y, columns[n], rows[n], slope, len(x) - 1, 0.0, top)
