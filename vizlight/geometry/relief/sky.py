"""The share of a uniform sky that each node of a height field sees, with an error that is measured.

The sky is the upper half space, its light is weighted by the cosine with the normal. Per azimuth
the integral over elevation is closed, so that one horizon per node and azimuth is left: its slope
t. Small fields are crossed cell by cell from all nodes at once by NumPy, others by compiled scan
lines; which of them depends on the field and the error alone.

By scan lines the cells near a node are crossed one by one on the bilinear surface. The terrain
behind them is read from two lines beside the node that run along the azimuth: a line is swept once,
against the azimuth, and keeps the upper convex hull of the nodes it has passed, so that an azimuth
costs O(n).

The error is measured, not modelled: at random nodes horizons are followed through every cell, also
toward more and other azimuths, until 95 of 100 nodes are close enough.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check, _compiled, _pool
from vizlight._types import Array, Indices, Slice
from vizlight.geometry.relief import crossings, height_field
from vizlight.geometry.relief.crossings import NONE, between, crossed


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def seen(t: float, rise: float, upright: float, openness: bool) -> float:
    """Return the visible sky above a horizon of slope t from ground that rises toward it."""
    t = max(t, 0.0)
    if openness:
        return math.atan2(1.0, t)
    t = max(t, rise)
    square = 1 / (1 + t * t)
    return upright * (square - rise * (math.atan2(1.0, t) - t * square))


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def tangent(hx: Array, hz: Array, top: int, at: float, height: float) -> float:
    """Return the largest slope from a point to a hull with its nearest vertex last."""
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


@_compiled.kernel(inline=True)
def side_of(first: float, spacing: float, line: int, aside: float) -> float:
    """Return the place of a scan line: by the same sums for all, so that a node is between two."""
    return (first + line * spacing) + aside


@_compiled.kernel(inline=True)
def under(nodes: Array, k: int, side: float) -> int:
    """Return the index of the last node below a side, at most k."""
    while k >= 0 and nodes[k] >= side:
        k -= 1
    return k


@_compiled.kernel(rounding=_compiled.ROUNDING)
def azimuth(
    z: Array, x: Array, y: Array, p: Array, q: Array, slope: float, grid: tuple[float, float],
    some: tuple[int, int], near: int, crowd: int, openness: bool, local: Array, swapped: bool,
    out: Array,
) -> None:  # fmt: skip
    """Write the sky that the nodes between some scan lines see toward an azimuth.

    ``z`` is padded by ``near`` nodes; ``p`` and ``q``, the slopes of the ground along columns and
    rows, are not. ``grid`` has the height of scan line 0 at column 0 and the distance of lines,
    ``crowd`` is the largest number of nodes of a column between two of them. ``local`` has for each
    row, or with ``swapped`` for each column, the length of a unit along it, that of one along the
    azimuth, and the change of local azimuths.
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
                        rise = (right + slope * up) / length
                        at = i - near if swapped else k - near
                        right, up = (
                            (right, up / local[0, at]) if swapped else (right / local[0, at], up)
                        )
                        upright = 1 / math.sqrt(1 + right * right + up * up)
                        share = seen(t / local[1, at], rise / local[1, at], upright, openness)
                        out[k - near, i - near] = share * local[2, at]
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


#: First and largest number of azimuths.
FEWEST, MOST = 16, 1024
#: Turn of all azimuths, as a share of the widest spacing: off axes and diagonals, where a grid is
#: special.
TURN = 0.37
#: Numbers of columns that are crossed cell by cell before scan lines, and before NumPy's steps;
#: thereafter all cells are.
NEAR, NEAR_BY_STEPS = (4, 16, 64), (32, 128)
#: Number of random nodes whose horizons are followed through every cell, and shift of the azimuths
#: of their reference.
SAMPLES, REFERENCE = 256, 0.7
#: Number of nodes up to which NumPy is used at an error of SMALL_ERROR or more; fewer at a smaller
#: one, in proportion. To compile takes seconds, once on a machine.
SMALL, SMALL_ERROR = 1 << 15, 0.01
#: Share of the error that NumPy may miss of distant terrain or between two crossings.
MISSED = 1 / 20
#: Scan lines, or nodes, that one thread follows.
LINES, NODES = 128, 1 << 14
#: Steps of NumPy's far horizons grow by a factor, to a distance of this many diagonals.
GROWTH, BEYOND = 1.1, 8
#: Largest error that may be asked for, and the least that is tried for.
LARGEST, LEAST = 0.5, 1e-4


class SkyShares(NamedTuple):
    """The sky of a height field.

    ``share`` (ny, nx) is in [0, 1], or the openness in radians, NaN at holes; 95 of 100 nodes keep
    to ``error``, as measured. ``method`` is "horizons through every cell", "horizons by scan lines"
    or "horizons by steps".
    """

    share: Array
    error: float
    azimuths: int
    method: str


def sky(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    /,
    *,
    error: float = 0.01,
    openness: bool = False,
    stretch: ArrayLike | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> SkyShares:
    """Return the share of the sky that the nodes of a height field see.

    Nodes rise, of any spacing. NaN is a hole, which blocks nothing; beyond the border the heights
    of the border continue. 95 of 100 nodes shall keep to ``error``, from 0.0001 to 0.5, or radians
    of the ``openness``, the mean angle between the zenith and the horizon; the error of the result
    exceeds it where 1024 azimuths do not suffice. ``stretch`` has the lengths of a unit of x in the
    rows, as of degrees of longitude: a node sees the field as if the length were that of its own
    row everywhere. ``progress`` takes the number of azimuths that are done.

    ``V = 1/pi * integral of max(n . w, 0) over the visible sky``: an endless slope of angle b sees
    (1 + cos b) / 2. The study ``sky`` prints its time.
    """
    error = _check.number("error", error, low=LEAST, high=LARGEST)
    # With the other border holes would be filled, and so block the sky.
    field = height_field.make(x, y, np.asarray(z), border="wall", stretch=stretch)
    if _compiled.active() and _large(field, error):
        # Where compiling fails NumPy finds the horizons, only later.
        with contextlib.suppress(_compiled.FailedError):
            return _until(error, _Horizons(field, error, openness, progress, fast=True))
    return _until(error, _Horizons(field, error, openness, progress, fast=False))


def _large(field: height_field.Field, error: float) -> bool:
    """Return whether compiled code, where available, finds the sky of a field."""
    if _compiled.wanted() == "1":
        return True
    # NumPy takes each node of an uneven field by itself, which is ten times as slow.
    share = min(error / SMALL_ERROR, 1.0) * (1.0 if _even(field) else 0.1)
    return field.heights.size > SMALL * share


def _even(field: height_field.Field) -> bool:
    """Return whether the columns of a field, and its rows, have the same distances."""
    steps = [np.diff(axis) for axis in (field.x, field.y)]
    return all(bool(np.ptp(step) <= 1e-6 * step.min()) for step in steps)


def _until(error: float, work: _Horizons) -> SkyShares:
    """Return the first sky with a small enough error, or the one of most effort."""
    nears, count = work.nears(), FEWEST
    # The sky at random nodes gives the number of azimuths before all nodes are computed.
    while count < MOST and _quantile(work.spread(count)) + MISSED * error > error:
        count *= 2
    near = nears.pop(0)
    total = work.sums(count, 0.0, near)
    while True:
        spread = work.spread(count)
        off = np.zeros(len(spread))
        if near is not None:
            off = np.abs(total[work.some] / count - work.samples(count))
        # NumPy leaves out shares smaller than this, and chance may make a difference small.
        measured = _quantile(np.hypot(spread, off)) + MISSED * error
        if measured <= error:
            break
        # Terrain missed between and beyond the scan lines is left to the cells themselves.
        if near is not None and (count >= MOST or _quantile(off) > _quantile(spread)):
            near = nears.pop(0)
            total = work.sums(count, 0.0, near)
        elif count >= MOST:
            break
        else:
            total += work.sums(count, 0.5, near)
            count *= 2
    total /= np.float32(count)
    if not work.openness:
        np.clip(total, 0, 1, out=total)
    total[np.isnan(work.field.heights)] = np.nan
    kind = "through every cell" if near is None else "by scan lines" if work.fast else "by steps"
    return SkyShares(total, measured, count, f"horizons {kind}")


def _quantile(values: Array) -> float:
    """Return a value that, by a sample, 95 of 100 do not exceed with a confidence of 95 %."""
    count = len(values)
    above = int(max(0.05 * count - 1.645 * math.sqrt(0.05 * 0.95 * count), 0.0))
    return float(np.sort(values)[count - 1 - above])


def _ways(count: int, shift: float) -> list[tuple[float, float]]:
    # The turn is the same for any number, so that a shift of a half puts azimuths between others.
    turns = 2 * np.pi * ((np.arange(count) + shift) / count + TURN / FEWEST)
    return [(math.cos(turn), math.sin(turn)) for turn in turns]


def _local(stretch: Array, way: tuple[float, float]) -> tuple[Array, Array]:
    """Return the length of a unit along an azimuth of the grid, and the change of local azimuths.

    Both are those of rows with a stretch: where all are 1, so are these, exactly.
    """
    length: Array = np.sqrt(1 + (stretch * stretch - 1) * (way[0] * way[0]))
    return length, stretch / (length * length)


def _seen(
    t: Array, p: Array, q: Array, stretch: Array, way: tuple[float, float], openness: bool
) -> Array:
    """Return the sky seen above horizons of slope t from ground of slopes p and q.

    The azimuth and t are those of the grid, the slopes those of the ground. The integral over
    elevation from the horizon up is closed.
    """
    length, share = _local(stretch, way)
    # The sky ends at the level plane, also where a horizon is lower.
    t = np.maximum(t / length, 0.0)
    if openness:
        return np.asarray(share * np.arctan2(1.0, t))
    # Slope of the ground along the azimuth: what rises toward it hides the sky below its own plane.
    rise = p * (way[0] * stretch / length) + q * (way[1] / length)
    t = np.maximum(t, rise)
    square = 1 / (1 + t * t)
    # Twice the integral of (n . w) cos(e) over elevations e above the horizon, so that the mean of
    # all azimuths is V.
    value = (square - rise * (np.arctan2(1.0, t) - t * square)) / np.sqrt(1 + p * p + q * q)
    return np.asarray(share * value)


class _Horizons:
    """Sky that the nodes of a field see above their horizons, summed over azimuths."""

    def __init__(
        self, field: height_field.Field, error: float, openness: bool,
        progress: Callable[[int], None], *, fast: bool,
    ) -> None:  # fmt: skip
        self.field, self.error, self.openness, self.fast = field, error, openness, fast
        self.progress, self.done = progress, 0
        self.even = _even(field)
        self.slopes = height_field.slopes(field)
        ground = np.flatnonzero(np.isfinite(field.heights))
        random = np.random.default_rng(0)
        chosen = np.sort(random.choice(ground, min(len(ground), SAMPLES), replace=False))
        #: Rows and columns of random nodes.
        self.some = _nodes(chosen, field)
        self.sampled: dict[tuple[int, float], Array] = {}

    def nears(self) -> list[int | None]:
        """Return numbers of columns that are crossed cell by cell, one after the other to try.

        None stands for all.
        """
        columns = max(self.field.heights.shape)
        if self.fast:
            return [*(near for near in NEAR if near < columns), None]
        if not self.even or self.field.heights.size <= SMALL:
            return [None]
        return [*(near for near in NEAR_BY_STEPS if near < columns), None]

    def sums(self, count: int, shift: float, near: int | None) -> Array:
        """Return the sky that all nodes see, summed over azimuths."""
        total = np.zeros(self.field.heights.shape, np.float32)
        ways = _ways(count, shift)
        if self.fast:
            view = _View(self.field, self.slopes, near or 0)
            for way in ways:
                self._add(total, view.toward(way), way, near)
                self._report(1)
            return total
        parts: list[Array] = [np.empty(0)] * count

        def work(part: Slice) -> int:
            # Threads share azimuths, each with a view of its own.
            for at in range(part.start, part.stop):
                view = _View(self.field, self.slopes, 0).toward(ways[at])
                parts[at] = np.zeros(total.shape, np.float32)
                self._add(parts[at], view, ways[at], near)
            return int(part.stop)

        # Added in one order, so that the sum does not depend on the number of threads.
        for done in _pool.run(work, _pool.blocks(count, 1)):
            total += parts[done - 1]
            parts[done - 1] = np.empty(0)
            self._report(1)
        return total

    def _report(self, count: int) -> None:
        self.done += count
        self.progress(self.done)

    def _add(self, total: Array, view: _View, way: tuple[float, float], near: int | None) -> None:
        """Add the sky that all nodes see toward an azimuth."""
        if self.fast and near is not None:
            view.add(total, self.openness, way)
            return
        heights = self.field.heights
        if self.fast or not self.even:
            every = _nodes(np.arange(heights.size), self.field)
            if self.fast:
                horizons = view.exact(every, self.field.top)
            else:
                horizons = view.followed(every, self.field.top, np.array([view.slope]))[0]
            horizons = horizons.reshape(heights.shape)
        else:
            widths = view.x[-1] / (len(view.x) - 1), view.y[-1] / (len(view.y) - 1)
            columns = len(view.x) if near is None else near
            horizons = np.empty(heights.shape)
            least = MISSED * self.error
            # The openness changes with the slope itself, the share with its square.
            least *= least if self.openness else 1.0
            # A slope of the grid is a steeper one where x is shorter.
            least *= min(float(self.field.stretch.min()), 1.0) ** 2
            view.oriented(horizons)[:] = crossings.sweep(view.z, widths, view.slope, columns, least)
            if near is not None:
                start = near * widths[0] * math.hypot(1.0, view.slope)
                np.fmax(horizons, _by_steps(self.field, way, start), out=horizons)
        stretch = self.field.stretch[:, np.newaxis]
        total += _seen(horizons, *self.slopes, stretch, way, self.openness)

    def spread(self, count: int) -> Array:
        """Return estimates of the errors at the random nodes that a number of azimuths makes.

        An odd number of other azimuths is the reference: structures of a whole field may fall
        alike into a number of azimuths, its half and its double.
        """
        reference = (2 * count + count // 2 + 1, REFERENCE)
        self._sample((FEWEST // 2, 0.0), (count // 2, 0.5), reference)
        mean = self.samples(count)
        off = np.abs(mean - self.sampled[reference])
        return np.maximum(off, np.abs(mean - self.samples(count // 2)) / 2)

    def samples(self, count: int) -> Array:
        """Return the mean sky that the random nodes see, of a number whose spread is known."""
        half = count // 2
        if half < FEWEST // 2:
            return self.sampled[count, 0.0]
        return (self.samples(half) + self.sampled[half, 0.5]) / 2

    def _sample(self, *every: tuple[int, float]) -> None:
        """Keep the mean sky through every cell over azimuths, each of a number and a shift."""
        sets = [each for each in every if each not in self.sampled]
        view = _View(self.field, self.slopes, 0)
        right, up = (slope[self.some] for slope in self.slopes)
        stretch = self.field.stretch[self.some[0]]
        horizons = dict[tuple[float, float], Array]()
        # NumPy follows the rays of all azimuths at once that see the field turned alike.
        azimuths = sorted((way for each in sets for way in _ways(*each)), key=view.turn_of)
        for _, alike in itertools.groupby(azimuths, view.turn_of):
            ways = list(alike)
            horizons |= zip(ways, self._horizons(view, ways), strict=True)
        for count, shift in sets:
            total = np.zeros(len(self.some[0]))
            for way in _ways(count, shift):
                total += _seen(horizons[way], right, up, stretch, way, self.openness)
            self.sampled[count, shift] = total / count

    def _horizons(self, view: _View, ways: list[tuple[float, float]]) -> list[Array]:
        """Return slopes of the horizons of the random nodes toward azimuths of one turn."""
        top = self.field.top
        if self.fast:
            return [view.toward(way).exact(self.some, top) for way in ways]
        slopes = np.array([view.toward(way).slope for way in ways])
        return [*view.followed(self.some, top, slopes)]


def _nodes(numbers: Indices, field: height_field.Field) -> tuple[Indices, Indices]:
    """Return rows and columns of nodes by their numbers."""
    rows, columns = np.divmod(numbers, field.heights.shape[1])
    return rows, columns


def _by_steps(field: height_field.Field, way: tuple[float, float], start: float) -> Array:
    """Return slopes of the horizons of all nodes, from heights at growing distances."""
    heights = field.heights
    # Beyond the border heights go on, so that even an endless wall is met aslant.
    reach = BEYOND * math.hypot(field.x[-1], field.y[-1])
    t, distance = np.zeros(heights.shape), start
    while distance < reach:
        j, v = _between(field.y, field.y + distance * way[1])
        i, u = _between(field.x, field.x + distance * way[0])
        across = crossings.mixed(heights[j], heights[j + 1], v[:, np.newaxis])
        height = crossings.mixed(across[:, i], across[:, i + 1], u)
        # fmax passes over NaN: a hole blocks nothing.
        np.fmax(t, (height - heights) / distance, out=t)
        # Far away slopes change less along the ray, so that steps may grow with the distance.
        distance *= GROWTH
    return t


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
        self.field, self.near = field, near
        # Along the grid, as the azimuth is.
        self.slopes = slopes[0] * field.stretch[:, np.newaxis], slopes[1]
        self.turn: tuple[bool, int, int] | None = None

    def turn_of(self, way: tuple[float, float]) -> tuple[bool, int, int]:
        """Return whether axes are swapped toward an azimuth, and the signs of both."""
        widths = [axis[-1] / (len(axis) - 1) for axis in (self.field.x, self.field.y)]
        # Compared in cells per length, since the cells of a field need not be square.
        swap = bool(abs(way[1]) * widths[0] > abs(way[0]) * widths[1])
        return swap, 1 if way[0] >= 0 else -1, 1 if way[1] >= 0 else -1

    def toward(self, way: tuple[float, float]) -> _View:
        """Turn the field to an azimuth, if it is not."""
        field, turn = self.field, self.turn_of(way)
        swap = turn[0]
        rates = abs(way[0]), abs(way[1])
        self.slope = rates[0] / rates[1] if swap else rates[1] / rates[0]
        # Azimuths of one octant share the turned field, and only the slope differs.
        if turn != self.turn:
            self.turn = turn
            axes = _padded(field.x, turn[1], self.near), _padded(field.y, turn[2], self.near)
            # Near cells beyond the border exist, so that a walk through them asks for no bounds.
            turned = np.ascontiguousarray(self.oriented(field.heights))
            self.z = np.pad(turned, self.near, mode="edge")
            # Along an axis that is turned over slopes change their signs.
            rises = [turn[k] * self.oriented(self.slopes[k - 1]) for k in (1, 2)]
            self.x, self.y = axes[::-1] if swap else axes
            self.p, self.q = map(np.ascontiguousarray, rises[::-1] if swap else rises)
        return self

    def oriented(self, values: Array) -> Array:
        """Return values of the nodes of the field as the view has them."""
        assert self.turn is not None
        swap, right, up = self.turn
        # A view and no copy, through which sums are added to the nodes in their own order.
        turned = values[::up, ::right]
        return turned.T if swap else turned

    def add(self, total: Array, openness: bool, way: tuple[float, float]) -> None:
        """Add the sky that all nodes see toward the azimuth, by compiled code."""
        assert self.turn is not None
        swap, _, up = self.turn
        stretch = self.field.stretch[::up]
        local = np.stack([stretch, *_local(stretch, way)])
        rows, mean = len(self.y), self.y[-1] / (len(self.y) - 1)
        # Scan lines are parallel to the azimuth, a mean row apart: from below the last node of the
        # first row to above the first one of the last.
        first = -self.slope * self.x[-1] - mean
        count = int((self.y[-1] - first) / mean) + 2
        # Most nodes of a column between two lines: uneven rows may crowd.
        last = np.searchsorted(self.y, self.y + mean * (1 + 1e-9))
        crowd = int(np.max(last - np.arange(rows))) + 1
        out, part = self.oriented(total), np.zeros(self.p.shape, np.float32)

        # Each node lies between one pair of lines, so that threads write to different nodes.
        def work(lines: Slice) -> int:
            azimuth(
                self.z, self.x, self.y, self.p, self.q, self.slope, (first, mean),
                (int(lines.start), int(lines.stop)), self.near, crowd, openness,
                local, swap, part,
            )  # fmt: skip
            return int(lines.stop)

        for _ in _pool.run(work, _pool.blocks(count, LINES)):
            pass
        out += part

    def turned(self, nodes: tuple[Indices, Indices]) -> tuple[Indices, Indices]:
        """Return the rows and columns that nodes of the field have here."""
        assert self.turn is not None
        swap, right, up = self.turn
        # A flipped axis counts from its other end.
        ends = (size - 1 for size in self.field.heights.shape)
        j, i = (
            index if way > 0 else end - index
            for index, way, end in zip(nodes, (up, right), ends, strict=True)
        )
        if swap:
            j, i = i, j
        return j + self.near, i + self.near

    def followed(self, nodes: tuple[Indices, Indices], top: float, slopes: Array) -> Array:
        """Return slopes of the horizons of nodes toward azimuths, one in a row, by NumPy."""
        j, i = (np.tile(index, len(slopes)) for index in self.turned(nodes))
        each = np.repeat(slopes, len(nodes[0]))
        horizons = np.empty(len(each))

        def work(part: Slice) -> int:
            horizons[part] = crossings.follow(
                self.z, self.x, self.y, j[part], i[part], each[part], top
            )
            return int(part.stop)

        for _ in _pool.run(work, _pool.blocks(len(each), NODES)):
            pass
        return horizons.reshape(len(slopes), -1)

    def exact(self, nodes: tuple[Indices, Indices], top: float) -> Array:
        """Return slopes of the horizons of nodes, through every cell, by compiled code."""
        j, i = self.turned(nodes)
        slopes = np.empty(len(j))

        # Each node has its own place in the result.
        def work(part: Slice) -> int:
            out = slopes[part]
            crossings.exact(self.z, self.x, self.y, j[part], i[part], self.slope, top, out)
            return int(part.stop)

        for _ in _pool.run(work, _pool.blocks(len(j), NODES)):
            pass
        return slopes


def _padded(nodes: Array, sign: int, near: int) -> Array:
    """Return nodes in a direction from 0, with ``near`` more at both ends, spaced as there."""
    nodes = np.sort(sign * nodes)
    low, high = nodes[1] - nodes[0], nodes[-1] - nodes[-2]
    more = np.arange(1, near + 1)
    wide: Array = np.concatenate([nodes[0] - low * more[::-1], nodes, nodes[-1] + high * more])
    wide -= wide[0]
    return wide
