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
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight import _check, _compiled, _pool
from vizlight.geometry.relief import height_field

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices, Slice

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
    progress: Callable[[int], None] = lambda _: None,
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
    # With the other border holes would be filled, and so block the sky.
    field = height_field.make(x, y, np.asarray(z), border="wall")
    there, done = np.isfinite(field.heights), 0
    fast = _compiled.active() and azimuth.pays(SAVED * FEWEST * there.size)
    near = 0 if not fast else NEAR if error < ROUGHLY else NEAR // 2
    random = np.random.default_rng(0)
    # Nodes at the crossings of some rows and columns, so that NumPy can take them at once.
    rows, columns = (np.sort(random.choice(n, min(n, SAMPLES), replace=False)) for n in there.shape)
    # All of them may lie in holes; then a single node stands for the field.
    if not there[np.ix_(rows, columns)].any():
        known = np.argwhere(there)
        rows, columns = known[len(known) // 2][:, np.newaxis]
    at = np.ix_(rows, columns)
    slopes = height_field.slopes(field)

    def sums(count: int, shift: float) -> Array:
        nonlocal done
        total = np.zeros(there.shape, np.float32)
        view = _View(field, slopes, near)
        for way in _ways(count, shift):
            if fast:
                view.toward(way).add(total, openness)
            else:
                whole = np.arange(there.shape[0]), np.arange(there.shape[1])
                t = _by_steps(field, *whole, way, GROWTH, 0.5)
                total += _seen(t, *slopes, way, openness)
            done += 1
            progress(done)
        return total

    # The reference of the error: at a few nodes, through every cell or in much finer steps.
    wanted = np.zeros((len(rows), len(columns)))
    count = REFERENCE if fast else REFERENCE // 4
    view = _View(field, slopes, near)
    for way in _ways(count, 0.0):
        if fast:
            t = view.toward(way).exact(rows, columns, field.top)
        else:
            t = _by_steps(field, rows, columns, way, 1.02, 0.125)
        wanted += _seen(t, slopes[0][at], slopes[1][at], way, openness) / count
    count, last = FEWEST, math.inf
    total = sums(count, 0.0)
    while True:
        missed = np.sort(np.abs(total[at] / count - wanted)[there[at]])
        # With 95 % confidence the quantile of all nodes is not above this one.
        found = float(missed[len(missed) - 1 - int(0.05 * len(missed) / 2)])
        if found <= error or count >= (MOST if fast else 4 * FEWEST):
            break
        # What error remains is put down to the scan lines, which more near columns replace.
        if found > STALLED * last and 0 < near < FARTHEST_NEAR:
            near, last = 2 * near, math.inf
            total = sums(count, 0.0)
            continue
        last = found
        total += sums(count, 0.5)
        count *= 2
    total /= np.float32(count)
    if not openness:
        np.clip(total, 0, 1, out=total)
    total[~there] = np.nan
    return Sky(total, found, count, near)


def _ways(count: int, shift: float) -> list[tuple[float, float]]:
    turns = 2 * np.pi * (np.arange(count) + shift + TURN * FEWEST / count) / count
    return [(math.cos(turn), math.sin(turn)) for turn in turns]


def _seen(t: Array, p: Array, q: Array, way: tuple[float, float], openness: bool) -> Array:
    """Return what is seen above horizons of slope t from ground of slopes p and q.

    The integral over elevation from the horizon up is closed.
    """
    # The sky ends at the level plane, also where a horizon is lower.
    t = np.maximum(t, 0.0)
    if openness:
        return np.asarray(np.arctan2(1.0, t))
    # Slope of the ground along the azimuth: what rises toward it hides the sky below its own plane.
    rise = p * way[0] + q * way[1]
    t = np.maximum(t, rise)
    square = 1 / (1 + t * t)
    # Twice the integral of (n . w) cos(e) over elevations e above the horizon, so that the mean of
    # all azimuths is V.
    value = (square - rise * (np.arctan2(1.0, t) - t * square)) / np.sqrt(1 + p * p + q * q)
    return np.asarray(value)


def _by_steps(
    field: height_field.Field, rows: Indices, columns: Indices, way: tuple[float, float],
    growth: float, least: float,
) -> Array:  # fmt: skip
    """Return slopes of the horizons of nodes, from heights at growing distances, by NumPy."""
    heights = field.heights
    z = heights[np.ix_(rows, columns)]
    cell = min(field.x[-1] / (len(field.x) - 1), field.y[-1] / (len(field.y) - 1))
    # Beyond the border heights go on, so that even an endless wall is met aslant.
    reach = BEYOND * math.hypot(field.x[-1], field.y[-1])
    t = np.zeros(z.shape)
    step = distance = least * cell
    while distance < reach:
        j, v = _between(field.y, field.y[rows] + distance * way[1])
        i, u = _between(field.x, field.x[columns] + distance * way[0])
        across = _mixed(heights[j], heights[j + 1], v[:, np.newaxis])
        height = _mixed(across[:, i], across[:, i + 1], u)
        # fmax passes over NaN: a hole blocks nothing.
        np.fmax(t, (height - z) / distance, out=t)
        # Far away slopes change less along the ray, so that steps may grow with the distance.
        step = step if distance < NEAR * cell else distance * (growth - 1)
        distance += step
    return t


def _mixed(low: Array, high: Array, share: Array) -> Array:
    """Return heights between two nodes, at one of them whatever the other is: it may be a hole."""
    return np.where(share == 0, low, np.where(share == 1, high, low + share * (high - low)))


def _between(nodes: Array, place: Array) -> tuple[Indices, Array]:
    """Return the nodes before places, which are moved into the range of the nodes, and shares."""
    place = np.clip(place, nodes[0], nodes[-1])
    before = np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, len(nodes) - 2)
    return before, (place - nodes[before]) / (nodes[before + 1] - nodes[before])


class _View:
    """A field, padded by near cells, turned so that an azimuth goes toward rising columns and rows.

    Columns lie along the axis on which the azimuth runs faster.
    """

    def __init__(self, field: height_field.Field, slopes: tuple[Array, Array], near: int) -> None:
        self.field, self.slopes, self.near = field, slopes, near
        self.turn: tuple[bool, int, int] | None = None

    def toward(self, way: tuple[float, float]) -> _View:
        """Turn the field to an azimuth, if it is not."""
        field = self.field
        widths = [axis[-1] / (len(axis) - 1) for axis in (field.x, field.y)]
        # Compared in cells per length, since the cells of a field need not be square.
        swap = bool(abs(way[1]) * widths[0] > abs(way[0]) * widths[1])
        turn = (swap, 1 if way[0] >= 0 else -1, 1 if way[1] >= 0 else -1)
        rates = abs(way[0]), abs(way[1])
        self.slope = rates[0] / rates[1] if swap else rates[1] / rates[0]
        # Azimuths of one octant share the turned field, and only the slope differs.
        if turn != self.turn:
            self.turn = turn
            axes = _padded(field.x, turn[1], self.near), _padded(field.y, turn[2], self.near)
            # Near cells beyond the border exist, so that a walk through them asks for no bounds.
            turned = np.ascontiguousarray(self.of(field.heights))
            self.z = np.pad(turned, self.near, mode="edge")
            # Along an axis that is turned over slopes change their signs.
            rises = [turn[k] * self.of(self.slopes[k - 1]) for k in (1, 2)]
            self.x, self.y = axes[::-1] if swap else axes
            self.p, self.q = map(np.ascontiguousarray, rises[::-1] if swap else rises)
        return self

    def of(self, values: Array) -> Array:
        """Return values of the nodes of the field as the view has them."""
        assert self.turn is not None
        swap, right, up = self.turn
        # A view and no copy, through which sums are added to the nodes in their own order.
        turned = values[::up, ::right]
        return turned.T if swap else turned

    def add(self, total: Array, openness: bool) -> None:
        """Add what all nodes see toward the azimuth, by compiled code."""
        rows, mean = len(self.y), self.y[-1] / (len(self.y) - 1)
        # Scan lines are parallel to the azimuth, a mean row apart: from below the last node of the
        # first row to above the first one of the last.
        first = -self.slope * self.x[-1] - mean
        count = int((self.y[-1] - first) / mean) + 2
        # Most nodes of a column between two lines: uneven rows may crowd.
        last = np.searchsorted(self.y, self.y + mean * (1 + 1e-9))
        crowd = int(np.max(last - np.arange(rows))) + 1
        out, part = self.of(total), np.zeros(self.p.shape, np.float32)

        # Each node lies between one pair of lines, so that threads write to different nodes.
        def work(lines: Slice) -> int:
            azimuth(
                self.z, self.x, self.y, self.p, self.q, self.slope, (first, mean),
                (int(lines.start), int(lines.stop)), self.near, crowd, openness, part,
            )  # fmt: skip
            return int(lines.stop)

        for _ in _pool.run(work, _pool.blocks(count, LINES)):
            pass
        out += part

    def exact(self, rows: Indices, columns: Indices, top: float) -> Array:
        """Return slopes of the horizons of some nodes, through every cell, by compiled code."""
        some = np.zeros(self.field.heights.shape)
        some[np.ix_(rows, columns)] = 1
        found = np.full(some.shape, np.nan)
        j, i = np.nonzero(self.of(some))
        slopes = np.empty(len(j))
        exact(self.z, self.x, self.y, j + self.near, i + self.near, self.slope, top, slopes)
        self.of(found)[j, i] = slopes
        return np.asarray(found[np.ix_(rows, columns)])


def _padded(nodes: Array, sign: int, near: int) -> Array:
    """Return nodes in a direction from 0, with ``near`` more at both ends in the spacing there."""
    nodes = np.sort(sign * nodes)
    low, high = nodes[1] - nodes[0], nodes[-1] - nodes[-2]
    more = np.arange(1, near + 1)
    wide: Array = np.concatenate([nodes[0] - low * more[::-1], nodes, nodes[-1] + high * more])
    wide -= wide[0]
    return wide


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def seen(t: float, rise: float, upright: float, openness: bool) -> float:
    """Return what is seen above a horizon of slope t from ground that rises toward it."""
    t = max(t, 0.0)
    if openness:
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
    # Most horizons are near: the nearest vertices are tried first, one by one.
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
    # A vertex that is not above the line from the new point to the vertex behind it leaves the
    # hull.
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
    z: Array, x: Array, y: Array, p: Array, q: Array, slope: float, grid: tuple[float, float],
    some: tuple[int, int], near: int, crowd: int, openness: bool, out: Array,
) -> None:  # fmt: skip
    """Write what the nodes between some scan lines see toward an azimuth.

    ``z`` is padded by ``near`` nodes; ``p`` and ``q``, the slopes of the ground along columns and
    rows, are not. ``grid`` has the height of scan line 0 at column 0 and the distance of lines,
    ``crowd`` is the largest number of nodes of a column between two of them.
    """
    first, spacing = grid
    columns, rows = len(x), len(y)
    length = math.sqrt(1 + slope * slope)
    hx, hz = np.empty(columns + rows), np.empty(columns + rows)
    # The hull of the heights along the last column, which begins where a line leaves the field.
    bx, bz = np.empty(rows), np.empty(rows)
    edge, edge_row = -1, rows - 1
    # Horizons on the line above, in the order in which the line below asks for them.
    upper = np.empty((2, crowd * columns))
    # Nodes between two lines take their horizon from both, so there is one line more than gaps.
    for line in range(some[1], some[0] - 1, -1):
        start = first + line * spacing
        leaves = start + slope * x[columns - 1]
        # Lines come from above, so that the hull of the last column grows by the nodes between two.
        while edge_row >= 0 and y[edge_row] > leaves:
            place = z[edge_row, columns - 1]
            # Along an axis a line goes on over one height beyond the border, and passes no other
            # node there.
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
            # A line falls from column to column on the way back, so that its row never rises.
            while r > 0 and y[r] > side:
                r -= 1
            # Heights on the line, between the two nodes of a column.
            place = between(z[r, m], z[r + 1, m], (side - y[r]) / (y[r + 1] - y[r]))
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
                    if near <= k < rows - near:
                        t = tangent(hx, hz, top, x[i] * length, z[k, i])
                        other = upper[(line + 1) & 1, taken]
                        taken += 1
                        share = (y[k] - side) / spacing
                        # Where one line meets no ground there is nothing to interpolate with.
                        t = max(t, other) if min(t, other) == NONE else between(t, other, share)
                        # The hull holds what is beyond the near columns; those are crossed cell by
                        # cell here.
                        t = crossed(z, x, y, i, k, slope, m, t, math.inf)
                        right, up = p[k - near, i - near], q[k - near, i - near]
                        upright = 1 / math.sqrt(1 + right * right + up * up)
                        rise = (right + slope * up) / length
                        out[k - near, i - near] = seen(t, rise, upright, openness)
                    k -= 1
            # Nodes from the line before up to this one.
            if line > some[0]:
                below = under(y, below, side)
                prior = side_of(first, spacing, line - 1, aside)
                k = below
                while k >= 0 and y[k] >= prior:
                    if near <= k < rows - near:
                        upper[line & 1, stored] = tangent(hx, hz, top, x[i] * length, z[k, i])
                        stored += 1
                    k -= 1


@_compiled.kernel(seconds=2.0)
def exact(
    z: Array, x: Array, y: Array, rows: Indices, columns: Indices, slope: float, top: float,
    out: Array,
) -> None:  # fmt: skip
    """Write slopes of the horizons of some nodes toward an azimuth, through every cell."""
    for n in range(len(out)):
        out[n] = crossed(z, x, y, columns[n], rows[n], slope, len(x) - 1, NONE, top)
