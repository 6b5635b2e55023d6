"""The share of a uniform sky that each node of a height field sees, with an error that is measured.

The sky is the upper half space, its light is weighted by the cosine with the normal. Per azimuth
the integral over elevation is closed, so that one horizon per node and azimuth is left: its slope
t. The cells near a node are crossed one by one on the bilinear surface. What is behind them is read
from two scan lines beside the node that run along the azimuth: a line is swept once, against the
azimuth, and keeps the upper convex hull of what it has passed, so that an azimuth costs O(n).

The error is measured, not modelled: at random rows and columns the horizons of many azimuths are
followed through every cell, and azimuths double until 95 of 100 of those nodes are close enough.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight import _check, _compiled, _pool
from vizlight.geometry.relief import height_field

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools, Indices

#: First and largest number of azimuths; columns that are crossed one by one at first and at most,
#: and error from which half as many do.
FEWEST, MOST, NEAR, FARTHEST_NEAR, ROUGHLY = 16, 1024, 4, 64, 0.02
#: Turn of all azimuths in their spacing: off axes and diagonals, where a grid is special.
TURN = 0.37
#: Rows and columns of the nodes whose error is measured, and azimuths of their reference.
SAMPLES, REFERENCE = 12, 256
#: Share of the error found beyond which further azimuths do not help, but more near columns do.
STALLED = 0.7
#: Scan lines that one thread follows, seconds per node and azimuth that compiled code saves.
LINES, SAVED = 128, 500e-9
#: Steps of NumPy's horizons: near ones by halves of cells, from there growing by a factor.
#: They end at a distance of this many diagonals.
GROWTH, BEYOND = 1.15, 8
#: Stands for the slope of a horizon without terrain.
NONE = -1e300
#: Largest error that may be asked for, and the least that is tried for.
LARGEST, LEAST = 0.5, 1e-4


class Sky(NamedTuple):
    """The sky of a height field.

    Attributes
    ----------
    share : ndarray of float32, shape (ny, nx)
        Share in [0, 1], or the openness in radians; NaN at holes.
    error : float
        Error that 95 of 100 nodes keep to, as measured.
    azimuths : int
        Number of azimuths.
    near : int
        Number of columns that were crossed cell by cell; 0 by NumPy.
    """

    share: Array
    error: float
    azimuths: int
    near: int


def sky(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    /,
    *,
    error: float = 0.01,
    openness: bool = False,
    progress: Callable[[int], None] | None = None,
) -> Sky:
    """Return the share of the sky that the nodes of a height field see.

    Parameters
    ----------
    x : array_like, shape (nx,)
        Rising nodes, of any spacing.
    y : array_like, shape (ny,)
        Rising nodes.
    z : array_like, shape (ny, nx)
        Heights. NaN is a hole, which blocks nothing; beyond the border heights stay as they are
        there.
    error : float, default: 0.01
        Error that 95 of 100 nodes shall keep to, from 0.0001 to 0.5; of the openness in radians.
    openness : bool, default: False
        Whether the mean angle between the zenith and the horizon is returned, in radians.
    progress : callable, optional
        Function of the number of azimuths that are done.

    Returns
    -------
    Sky

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    ``V = 1/pi * integral of max(n . w, 0) over the visible sky``: an endless slope of angle b sees
    (1 + cos b) / 2. A compiled azimuth takes about 220 ns per node; NumPy takes ten times as long.
    """
    error = _check.number("error", error, low=LEAST, high=LARGEST)
    field = height_field.make(x, y, np.asarray(z), border="wall")
    search = _Search(field, openness=openness, progress=progress)
    return search.until(error)


class _Search:
    """Azimuths of one field, added until the error that is measured is small enough."""

    def __init__(
        self,
        field: height_field.Field,
        *,
        openness: bool,
        progress: Callable[[int], None] | None,
    ) -> None:
        self.x, self.y, self.z = field.x, field.y, field.heights
        self.field = field
        self.top, self.openness = field.top, openness
        self.progress = progress
        self.done = 0
        random = np.random.default_rng(0)
        # Nodes at the crossings of some rows and columns, so that NumPy can take them at once.
        rows, columns = (random.choice(n, min(n, SAMPLES), replace=False) for n in self.z.shape)
        self.at: tuple[Indices, Indices] = (np.sort(rows), np.sort(columns))
        self.there: Bools = np.isfinite(self.z[np.ix_(*self.at)])
        if not self.there.any():
            rows, columns = np.nonzero(np.isfinite(self.z))
            middle = len(rows) // 2
            self.at = (rows[middle : middle + 1], columns[middle : middle + 1])
            self.there = np.ones((1, 1), np.bool_)
        self.quick = _compiled.active() and azimuth.pays(SAVED * FEWEST * self.z.size)

    def until(self, error: float) -> Sky:
        """Return the sky with an error, or the least that is found."""
        near = (NEAR if error < ROUGHLY else NEAR // 2) if self.quick else 0
        count, last = FEWEST, math.inf
        scan = _Scan(self, near) if self.quick else None
        wanted = self._reference(scan)
        total = self._sum(scan, count, 0.0)
        while True:
            share = total[np.ix_(*self.at)] / count
            missed = np.sort(np.abs(share - wanted)[self.there])
            # With 95 % confidence the quantile of all nodes is not above this one.
            rank = len(missed) - 1 - int(0.05 * len(missed) / 2)
            found = float(missed[rank])
            if found <= error or count >= MOST or (not self.quick and count >= 4 * FEWEST):
                break
            if found > STALLED * last and self.quick and near < FARTHEST_NEAR:
                near *= 2
                scan = _Scan(self, near)
                total = self._sum(scan, count, 0.0)
                last = math.inf
                continue
            last = found
            total = total + self._sum(scan, count, 0.5)
            count *= 2
        total /= np.float32(count)
        if not self.openness:
            np.clip(total, 0, 1, out=total)
        total[np.isnan(self.z)] = np.nan
        return Sky(total, found, count, near)

    def _ways(self, count: int, shift: float) -> list[tuple[float, float]]:
        turns = 2 * np.pi * (np.arange(count) + shift + TURN * FEWEST / count) / count
        return [(math.cos(turn), math.sin(turn)) for turn in turns]

    def _sum(self, scan: _Scan | None, count: int, shift: float) -> Array:
        """Return the sum over azimuths at all nodes."""
        ways = self._ways(count, shift)
        if scan is not None:
            return scan.sums(ways, self._report)
        rows, columns = (np.arange(n) for n in self.z.shape)
        total = np.zeros(self.z.shape, np.float32)
        for way in ways:
            total += self._by_steps(rows, columns, way, GROWTH, 0.5)
            self._report()
        return total

    def _report(self) -> None:
        self.done += 1
        if self.progress is not None:
            self.progress(self.done)

    def _reference(self, scan: _Scan | None) -> Array:
        """Return the sky of the sampled nodes, through every cell."""
        if scan is not None:
            rows, columns = np.meshgrid(*self.at, indexing="ij")
            out = np.zeros(rows.size)
            ways = np.array(self._ways(REFERENCE, 0.0))
            z, x, y = scan.fields[False]
            back = (x[-1] - x[::-1], y[-1] - y[::-1])
            exact(
                z.ravel(), x - x[0], y - y[0], back, scan.near, rows.ravel(), columns.ravel(), ways,
                self.top, int(self.openness), out,
            )  # fmt: skip
            return out.reshape(rows.shape) / REFERENCE
        count = REFERENCE // 4
        total = np.zeros(self.there.shape)
        for way in self._ways(count, 0.0):
            total += self._by_steps(*self.at, way, 1.02, 0.125)
        return total / count

    def _by_steps(
        self, rows: Indices, columns: Indices, way: tuple[float, float], growth: float, least: float
    ) -> Array:
        """Return what nodes see toward an azimuth, from heights at growing distances."""
        z, heights = self.z[np.ix_(rows, columns)], self.z
        cell = min(self.x[-1] / (len(self.x) - 1), self.y[-1] / (len(self.y) - 1))
        # Beyond the border heights go on, so that even an endless wall is met aslant.
        reach = BEYOND * math.hypot(self.x[-1], self.y[-1])
        t = np.zeros(z.shape)
        step = distance = least * cell
        while distance < reach:
            j, v = _between(self.y, self.y[rows] + distance * way[1])
            i, u = _between(self.x, self.x[columns] + distance * way[0])
            low, high = heights[j], heights[j + 1]
            v = v[:, np.newaxis]
            across = np.where(v == 0, low, np.where(v == 1, high, low + v * (high - low)))
            left, right = across[:, i], across[:, i + 1]
            height = np.where(u == 0, left, np.where(u == 1, right, left + u * (right - left)))
            np.fmax(t, (height - z) / distance, out=t)
            step = step if distance < NEAR * cell else distance * (growth - 1)
            distance += step
        if self.openness:
            return np.pi / 2 - np.arctan(t)
        normal = self.normals[np.ix_(rows, columns)]
        upright = normal[..., 2]
        rise = -(normal[..., 0] * way[0] + normal[..., 1] * way[1]) / upright
        t = np.maximum(t, rise)
        square = 1 / (1 + t * t)
        return np.asarray(upright * (square - rise * (np.arctan2(1, t) - t * square)))

    @cached_property
    def normals(self) -> Array:
        """Normals at the nodes, for NumPy."""
        return height_field.normals(self.field)


def _between(nodes: Array, place: Array) -> tuple[Indices, Array]:
    """Return the nodes before places, which are moved into the range of the nodes, and shares."""
    place = np.clip(place, nodes[0], nodes[-1])
    before = np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, len(nodes) - 2)
    return before, (place - nodes[before]) / (nodes[before + 1] - nodes[before])


class _Scan:
    """A field that is padded by near cells, and its transposed copy, for compiled code."""

    def __init__(self, search: _Search, near: int) -> None:
        self.near, self.mode = near, int(search.openness)
        self.shape = search.z.shape
        # Near cells beyond the border exist, so that a walk through them asks for no bounds.
        wide = np.pad(search.z, near, mode="edge")
        x, y = (_padded(axis, near) for axis in (search.x, search.y))
        self.fields = {False: (wide, x, y), True: (np.ascontiguousarray(wide.T), y, x)}

    def sums(self, ways: list[tuple[float, float]], report: Callable[[], None]) -> Array:
        """Return the sum over azimuths at all nodes."""
        total = np.zeros(self.shape, np.float32)
        turned = np.zeros(self.shape[::-1], np.float32)
        for dx, dy in ways:
            self._add(dx, dy, total, turned)
            report()
        total += turned.T
        return total

    def _add(self, dx: float, dy: float, total: Array, turned: Array) -> None:
        """Add what the nodes see toward an azimuth to one of two sums."""
        _, x, y = self.fields[False]
        steps = [np.ptp(axis) / (len(axis) - 1) for axis in (x, y)]
        # Columns lie along the axis on which the azimuth runs faster; else the field is transposed.
        swap = bool(abs(dy) * steps[0] > abs(dx) * steps[1])
        if swap:
            dx, dy = dy, dx
        field, x, y = self.fields[swap]
        out = turned if swap else total
        rows, columns = field.shape
        base, row, column = 0, columns, 1
        own, own_row, own_column = 0, out.shape[1], 1
        if dx < 0:
            x, base, column = -x[::-1], base + columns - 1, -1
            own, own_column = own + out.shape[1] - 1, -1
        if dy < 0:
            y, base, row = -y[::-1], base + (rows - 1) * columns, -columns
            own, own_row = own + out.size - out.shape[1], -out.shape[1]
        x, y = x - x[0], y - y[0]
        slope = abs(dy) / abs(dx)
        spacing = y[-1] / (rows - 1)
        # Lines from below the last node of the first row to above the first one of the last.
        # Scan lines are parallel to the azimuth, a row's spacing apart.
        first = -slope * x[-1] - spacing
        count = int((y[-1] - first) / spacing) + 2
        # Most nodes of a column between two lines: uneven rows may crowd.
        crowd = int(np.max(np.searchsorted(y, y + spacing * (1 + 1e-9)) - np.arange(rows)))

        def work(part: slice) -> int:
            azimuth(
                field.ravel(), (base, row, column), x, y, slope, (first, spacing),
                (int(part.start), int(part.stop)), self.near, crowd + 1, self.mode, out.ravel(),
                (own, own_row, own_column),
            )  # fmt: skip
            return int(part.stop)

        for _ in _pool.run(work, _pool.blocks(count, LINES)):
            pass


def _padded(nodes: Array, near: int) -> Array:
    """Return nodes with as many before and after them, in the spacing of the outermost."""
    low, high = nodes[1] - nodes[0], nodes[-1] - nodes[-2]
    more = np.arange(1, near + 1)
    return np.concatenate([nodes[0] - low * more[::-1], nodes, nodes[-1] + high * more])


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def slope_of(before: float, here: float, after: float, low: float, high: float) -> float:
    """Return the slope of the parabola through three nodes; of one side next to a hole."""
    one, other = (here - before) / low, (after - here) / high
    # NaN alone differs from itself: a hole.
    if one != one:
        return 0.0 if other != other else other
    if other != other:
        return one
    return (one * high + other * low) / (low + high)


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def slopes(
    z: Array, way: tuple[int, int, int], x: Array, y: Array, i: int, j: int, near: int
) -> tuple[float, float]:
    """Return the slopes along the columns and the rows at a node of a padded field."""
    base, row, column = way
    at = base + j * row + i * column
    left = z[at - column] if i > near else math.nan
    right = z[at + column] if i < len(x) - 1 - near else math.nan
    low = z[at - row] if j > near else math.nan
    high = z[at + row] if j < len(y) - 1 - near else math.nan
    return (
        slope_of(left, z[at], right, x[i] - x[i - 1], x[i + 1] - x[i]),
        slope_of(low, z[at], high, y[j] - y[j - 1], y[j + 1] - y[j]),
    )


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def seen(t: float, rise: float, upright: float, mode: int) -> float:
    """Return what is seen above a horizon of slope t from ground that rises toward it."""
    t = max(t, 0.0)
    if mode == 1:
        return math.atan2(1.0, t)
    t = max(t, rise)
    square = 1 / (1 + t * t)
    value: float = upright * (square - rise * (math.atan2(1.0, t) - t * square))
    return value


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def tangent(hx: Array, hz: Array, top: int, at: float, height: float) -> float:
    """Return the largest slope from a point to a hull, whose last vertex is the nearest."""
    if top < 0:
        return NONE
    b = top
    best = float((hz[b] - height) / (hx[b] - at))
    tried = 0
    while b > 0:
        t = float((hz[b - 1] - height) / (hx[b - 1] - at))
        if t < best:
            return best
        best, b, tried = t, b - 1, tried + 1
        if tried == 8:
            break
    # The slopes to the vertices of a hull rise and then fall: the rest by bisection.
    low, high = 0, b
    while low < high:
        middle = (low + high + 1) >> 1
        nearer = (hz[middle] - height) / (hx[middle] - at)
        if (hz[middle - 1] - height) / (hx[middle - 1] - at) < nearer:
            low = middle
        else:
            high = middle - 1
    return max(best, float((hz[low] - height) / (hx[low] - at)))


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def pushed(hx: Array, hz: Array, top: int, px: float, pz: float) -> int:
    """Add a point before all others to a hull, and return the index of its last vertex."""
    while top >= 1 and (hz[top] - pz) * (hx[top - 1] - px) <= (hz[top - 1] - pz) * (hx[top] - px):
        top -= 1
    hx[top + 1], hz[top + 1] = px, pz
    return top + 1


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def between(low: float, high: float, share: float) -> float:
    """Return a height between two nodes, at one of them whatever the other is."""
    if share == 0:
        return low
    return high if share == 1 else low + share * (high - low)


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def beyond(
    z: Array, at: int, step: int, nodes: Array, first: int, end: int, origin: float, scale: float,
    here: float, t: float,
) -> float:  # fmt: skip
    """Return the largest slope to the nodes of the last row or column, where a ray leaves it."""
    for m in range(first, end):
        place = z[at + m * step]
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
    c2 = bend / (width * width)
    c1 = (place - last) / width - c2 * (before + now)
    if before == 0:
        return max(t, c1 / length)
    c0 = last - here - before * (c1 + before * c2)
    if c0 < 0:
        peak = math.sqrt(c0 / c2)
        if before < peak < now:
            return max(t, (c1 + 2 * c2 * peak) / length)
    return t


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def crossed(
    z: Array, way: tuple[int, int, int], x: Array, y: Array, i: int, j: int, slope: float,
    end: int, t: float, top: float,
) -> float:  # fmt: skip
    """Return the largest slope from a node to the bilinear surface, up to a column.

    ``top`` is the largest height: the walk ends where nothing can be higher than the horizon.
    """
    base, row, column = way
    here = z[base + j * row + i * column]
    length = math.sqrt(1 + slope * slope)
    inverse = 1 / slope if slope > 0 else math.inf
    a, b, u, v, before, last = i, j, 0.0, 0.0, 0.0, here
    rows = len(y)
    while a < end and b < rows - 1:
        to_column = x[a + 1] - x[i]
        to_row = (y[b + 1] - y[j]) * inverse if slope > 0 else math.inf
        at = base + b * row + a * column
        z00, z01, z10, z11 = z[at], z[at + column], z[at + row], z[at + row + column]
        if to_column < to_row:
            now, u1 = to_column, 1.0
            v1 = min((y[j] + now * slope - y[b]) / (y[b + 1] - y[b]), 1.0) if slope > 0 else 0.0
            place = between(z01, z11, v1)
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
        if (top - here) < t * before * length:
            break
    if b == rows - 1:
        return beyond(z, base + b * row, column, x, a + 1, end + 1, x[i], length, here, t)
    if a == len(x) - 1 and slope > 0:
        scale = inverse * length
        return beyond(z, base + a * column, row, y, b + 1, rows, y[j], scale, here, t)
    return t


@_compiled.kernel(inline=True)
def side_of(first: float, spacing: float, line: int, aside: float) -> float:
    """Return where a scan line is: by the same sums for all, so that a node is between two."""
    return (first + line * spacing) + aside


@_compiled.kernel(inline=True)
def under(nodes: Array, k: int, side: float) -> int:
    """Return the index of the last node below a side, at most k."""
    while k >= 0 and nodes[k] >= side:
        k -= 1
    return k


@_compiled.kernel(rounding=_compiled.ROUNDING, seconds=3.0)
def azimuth(
    z: Array, way: tuple[int, int, int], x: Array, y: Array, slope: float,
    grid: tuple[float, float], some: tuple[int, int], near: int, crowd: int, mode: int, out: Array,
    own: tuple[int, int, int],
) -> None:  # fmt: skip
    """Add what the nodes between some scan lines see toward an azimuth.

    ``way`` and ``own`` have the index of the first node and the steps of the index from row to row
    and from column to column, in ``z``, which is padded by ``near`` nodes, and in ``out``. ``grid``
    has the height of scan line 0 at column 0 and the distance of lines, ``crowd`` is the largest
    number of nodes of a column between two of them.
    """
    base, row, column = way
    first, spacing = grid
    columns, rows = len(x), len(y)
    length = math.sqrt(1 + slope * slope)
    hx, hz = np.empty(columns + rows), np.empty(columns + rows)
    # The hull of the heights along the last column, which begins where a line leaves the field.
    bx, bz = np.empty(rows), np.empty(rows)
    edge, edge_row = -1, rows - 1
    upper = np.empty((2, crowd * columns))
    for line in range(some[1], some[0] - 1, -1):
        start = first + line * spacing
        leaves = start + slope * x[columns - 1]
        while edge_row >= 0 and y[edge_row] > leaves:
            place = z[base + edge_row * row + (columns - 1) * column]
            if place == place and slope > 0:
                edge = pushed(bx, bz, edge, y[edge_row], place)
            edge_row -= 1
        top = edge
        for b in range(edge + 1):
            # Seen from the line, nodes of the border's column are at distances along the azimuth.
            hx[b] = (x[columns - 1] + (bx[b] - leaves) / slope) * length
            hz[b] = bz[b]
        r, above, below = rows - 2, rows - 1, rows - 1
        stored = taken = 0
        for i in range(columns - 1 - near, near - 1, -1):
            m = i + near
            side = min(max(start + slope * x[m], y[0]), y[rows - 1])
            while r > 0 and y[r] > side:
                r -= 1
            # Heights on the line, between the two nodes of a column.
            v = (side - y[r]) / (y[r + 1] - y[r])
            at = base + r * row + m * column
            place = between(z[at], z[at + row], v)
            if place == place:
                top = pushed(hx, hz, top, x[m] * length, place)
            # The node itself lies between two lines; its horizon is taken from both hulls.
            aside = slope * x[i]
            side = side_of(first, spacing, line, aside)
            # Nodes from this line up to the next one, whose horizon on that one is known.
            if line < some[1]:
                above = under(y, above, side_of(first, spacing, line + 1, aside))
                k = above
                while k >= 0 and y[k] >= side:
                    here = z[base + k * row + i * column]
                    if near <= k < rows - near:
                        t = tangent(hx, hz, top, x[i] * length, here)
                        other = upper[(line + 1) & 1, taken]
                        taken += 1
                        share = (y[k] - side) / spacing
                        # Where one line meets no ground there is nothing to interpolate with.
                        t = max(t, other) if min(t, other) == NONE else between(t, other, share)
                        # The hull holds what is beyond the near columns; those are crossed cell by
                        # cell here.
                        t = crossed(z, way, x, y, i, k, slope, m, t, math.inf)
                        p, q = slopes(z, way, x, y, i, k, near)
                        rise = (p + slope * q) / length
                        # The integral over elevation from the horizon up is closed.
                        value = seen(t, rise, 1 / math.sqrt(1 + p * p + q * q), mode)
                        out[own[0] + (k - near) * own[1] + (i - near) * own[2]] += value
                    k -= 1
            # Nodes from the line before up to this one.
            if line > some[0]:
                below = under(y, below, side)
                prior = side_of(first, spacing, line - 1, aside)
                k = below
                while k >= 0 and y[k] >= prior:
                    if near <= k < rows - near:
                        here = z[base + k * row + i * column]
                        upper[line & 1, stored] = tangent(hx, hz, top, x[i] * length, here)
                        stored += 1
                    k -= 1


@_compiled.kernel(seconds=2.0)
def exact(
    z: Array, x: Array, y: Array, back: tuple[Array, Array], near: int, rows: Indices,
    columns: Indices, ways: Array, top: float, mode: int, out: Array,
) -> None:  # fmt: skip
    """Add what some nodes of a padded field see toward azimuths, through every cell.

    ``back`` has the nodes of both axes in the opposite order, from 0.
    """
    across, down = len(x), len(y)
    for n in range(len(out)):
        j, i = rows[n] + near, columns[n] + near
        p, q = slopes(z, (0, across, 1), x, y, i, j, near)
        upright = 1 / math.sqrt(1 + p * p + q * q)
        for k in range(len(ways)):
            dx, dy = ways[k, 0], ways[k, 1]
            a, b, base, row, column = i, j, 0, across, 1
            along, aside = x, y
            if dx < 0:
                along, a, base, column = back[0], across - 1 - i, across - 1, -1
            if dy < 0:
                aside, b, base, row = back[1], down - 1 - j, base + (down - 1) * across, -across
            if abs(dx) >= abs(dy):
                rate = abs(dy) / abs(dx)
                t = crossed(z, (base, row, column), along, aside, a, b, rate, across - 1, NONE, top)
            else:
                rate = abs(dx) / abs(dy)
                t = crossed(z, (base, column, row), aside, along, b, a, rate, down - 1, NONE, top)
            out[n] += seen(t, p * dx + q * dy, upright, mode)
