"""Rays through a height field, from square to square of cells on a hierarchy of their heights.

:func:`march` follows many rays at once by NumPy, :func:`walk` one after the other by compiled
code. Both cross squares of 2^l x 2^l cells at once where all of them are above or below a ray, and
find the crossings with the bilinear surface of a cell in closed form.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.relief.height_field import Bounds


#: Represents infinity on a ray; unlike infinity it gives 0 when multiplied by 0.
FAR = 1e300
#: Processor time that a compiled ray saves compared with one of :func:`march`, in seconds.
SAVED = 5e-6


def march(
    start: Array, way: Array, reach: Array, x: Array, y: Array, corners: Array, bounds: Bounds,
    walls: bool, out: Array,
) -> None:  # fmt: skip
    """Write the length of rays inside the solid; infinity where it is unbounded.

    Parameters
    ----------
    start, way : ndarray, shape (3, N)
        Starts of rays relative to the field's origin, and unit directions, in float64.
    reach : ndarray, shape (N,)
        Lengths of the rays, at most FAR.
    x, y, corners, bounds
        Edges, heights and bounds of a :class:`~vizlight.geometry.relief.height_field.Field`.
    walls : bool
        Whether some cells have no solid.
    out : ndarray, shape (N,)
        Result.
    """
    out[:] = 0
    top = bounds.largest[-1]
    # Above the highest node there is nothing to meet. With a rise near 0 its distance exceeds FAR.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        place = (top - start[2]) / way[2]
    # A falling ray begins where it comes down to that height, a rising one ends where it reaches
    # it.
    first = np.where(way[2] < 0, np.maximum(place, 0.0), 0.0)
    end = np.where(way[2] > 0, np.minimum(place, reach), reach)
    # A level ray never reaches that height: above all nodes it is left out.
    row = np.flatnonzero((first < end) & ~((way[2] == 0) & (start[2] >= top)))
    rays = _MarchingRays(
        start[:, row], way[:, row], first[row], end[row], (x, y), corners, bounds, walls
    )
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        while len(row):
            # Each ray has its own row, so no addition is lost.
            out[row] += rays.step()
            going = rays.s < rays.end
            # To drop rays copies all that is kept of the others, so it waits until a fifth is done.
            if np.count_nonzero(going) < 0.8 * len(row):
                rays.keep(going)
                row = row[going]
    out[out >= 0.5 * FAR] = np.inf


class _MarchingRays:
    """Rays in progress, each in a square of 2^l x 2^l cells; every step advances all of them."""

    def __init__(
        self, start: Array, way: Array, s: Array, end: Array, edges: tuple[Array, Array],
        corners: Array, bounds: Bounds, walls: bool,
    ) -> None:  # fmt: skip
        self.start, self.way, self.s, self.end = start, way, s, end
        self.edges, self.corners, self.bounds = edges, corners, bounds
        self.top = len(bounds.offset) - 1
        self.level = np.zeros(len(s), np.int32)
        place = start[:2] + s * way[:2]
        # The outermost edges are infinite; the number of inner ones before a place is its cell.
        inner = [np.searchsorted(edges[a][1:-1], place[a], side="right") for a in (0, 1)]
        self.cell = np.stack(inner).astype(np.int32)
        #: Whether rays run in a plane of nodes, and so beside two cells, one of them perhaps empty.
        at = np.stack([edges[a][self.cell[a]] for a in (0, 1)])
        self.beside = walls & (way[:2] == 0) & (start[:2] == at)

    def keep(self, going: Bools) -> None:
        """Drop the rays that have reached their end."""
        for name in ("start", "way", "cell", "s", "end", "level", "beside"):
            setattr(self, name, getattr(self, name)[..., going])

    def step(self) -> Array:
        """Move each ray through its square or into a quarter of it; return the length inside."""
        (x, y), (i, j), level, s = self.way[:2], self.cell, self.level, self.s
        cross_x, cross_y = self._cross(0), self._cross(1)
        by_x = cross_x <= cross_y
        # Never backwards: rounding may put an edge just behind the ray that has crossed it.
        leave = np.minimum(np.maximum(np.where(by_x, cross_x, cross_y), s), self.end)
        z0 = self.start[2] + s * self.way[2]
        z1 = self.start[2] + leave * self.way[2]
        square = self._own_cell()
        at = self.bounds.offset[level] + square[1] * self.bounds.columns[level] + square[0]
        # A ray is straight, so that its heights at both ends of the way are its bounds.
        below = np.maximum(z0, z1) <= self.bounds.least[at]
        clear = below | (np.minimum(z0, z1) >= self.bounds.largest[at])
        inside = np.where(below, leave - s, 0.0)
        # A single cell that the ray is neither above nor below: its surface itself is looked at.
        leaf = np.flatnonzero(~clear & (level == 0))
        inside[leaf] = self._in_cell(leaf, square[:, leaf], leave[leaf])

        descend = ~clear & (level > 0)
        onward = ~descend & (leave < self.end)
        # Rays move on into the next square of their level ...
        i += np.where(by_x & onward, np.where(x >= 0, 1, -1), 0).astype(np.int32)
        j += np.where(onward & ~by_x, np.where(y >= 0, 1, -1), 0).astype(np.int32)
        np.copyto(s, leave, where=~descend)
        # ... or into the square twice as wide, if both begin at the same place ...
        entry = np.where(by_x, i ^ (x < 0), j ^ (y < 0)) & 1
        low = (level < self.top) & ~self.beside.any(axis=0)
        ascend = (onward & (entry == 0) & low).astype(np.int32)
        i >>= ascend
        j >>= ascend
        level += ascend
        # ... or down into the quarter that contains the ray.
        self._descend(np.flatnonzero(descend))
        return inside

    def _own_cell(self) -> Indices:
        """Return the squares of rays; in a plane of nodes the one beside it that is not empty."""
        cells: Indices = self.cell.astype(np.intp)
        rows = np.flatnonzero(self.beside.any(axis=0))
        # Up to four cells meet at a vertical ray through a node; they are tried until one has a
        # solid.
        for back in ((0, 0), (1, 0), (0, 1), (1, 1)):
            i, j = cells[:, rows]
            empty = np.isneginf(self.bounds.largest[j * self.bounds.columns[0] + i])
            allowed = np.all(np.array(back, np.bool_) <= self.beside[:, rows].T, axis=1)
            other = rows[empty & allowed]
            cells[:, other] = self.cell[:, other] - np.array(back)[:, np.newaxis]
        return cells

    def _cross(self, axis: int) -> Array:
        """Return the distances at which rays leave their square along an axis."""
        way, edges = self.way[axis], self.edges[axis]
        # The number of an edge of a wide square, in cells; the last square may reach past the
        # field.
        out = np.minimum((self.cell[axis] + (way >= 0)) << self.level, len(edges) - 1)
        return np.where(way == 0, np.inf, (edges[out] - self.start[axis]) / way)

    def _descend(self, which: Indices) -> None:
        level = self.level[which] - 1
        for axis in (0, 1):
            edges = self.edges[axis]
            place = self.start[axis, which] + self.s[which] * self.way[axis, which]
            left = self.cell[axis, which] << 1
            # Where a square reaches past the field its middle may be infinite: the first half has
            # the ray.
            middle = edges[np.minimum((left + 1) << level, len(edges) - 1)]
            self.cell[axis, which] = left + (place >= middle)
        self.level[which] = level

    def _in_cell(self, which: Indices, square: Indices, leave: Array) -> Array:
        """Return the length below the bilinear surface of one cell, where f = h - z > 0."""
        (i, j), s, corners = square, self.s[which], self.corners
        z00, z10 = corners[j, i], corners[j + 1, i]
        (u, du), (v, dv) = (self._share(axis, square[axis], which, s) for axis in (0, 1))
        # h = z00 + u a + v b + u v c, where u and v are linear in the distance along the ray.
        a, b = corners[j, i + 1] - z00, z10 - z00
        c = (corners[j + 1, i + 1] - z10) - a
        z = self.start[2, which] + s * self.way[2, which]
        # With s from the place where the ray enters the cell, h - z is f0 + f1 s + f2 s^2.
        f0 = (z00 - z) + u * a + v * (b + u * c)
        f1 = du * (a + v * c) + dv * (b + u * c) - self.way[2, which]
        return _positive(f0, f1, du * dv * c, leave - s)

    def _share(self, axis: int, cell: Indices, which: Indices, s: Array) -> tuple[Array, Array]:
        """Return relative positions of rays in their cells and their rates of change.

        Both are 0 in an unbounded cell.
        """
        edges, way = self.edges[axis], self.way[axis, which]
        low, width = edges[cell], edges[cell + 1] - edges[cell]
        place = self.start[axis, which] + s * way
        ends = np.isfinite(width)
        return np.where(ends, (place - low) / width, 0.0), np.where(ends, way / width, 0.0)


def _positive(f0: Array, f1: Array, f2: Array, end: Array) -> Array:
    """Return the length of the part of [0, end] where f0 + f1 s + f2 s^2 > 0."""
    square = f1 * f1 - 4 * f0 * f2
    # Both roots without cancellation; where f2 is 0 one of them is infinite. The sum makes -0 to 0.
    q = -0.5 * (f1 + np.copysign(np.sqrt(np.maximum(square, 0)), f1))
    first, second = (np.minimum(np.maximum(root, 0), end) for root in (f0 / q, q / (f2 + 0.0)))
    between = np.abs(first - second)
    # A parabola that opens upward is positive outside its roots, any other between them.
    length = np.where(f2 >= 0, end - between, between)
    # Without a root, or for a constant f, the sign is the same everywhere.
    whole = (square < 0) | (q == 0)
    return np.where(whole, np.where(np.maximum(f0, f0 + f2) > 0, end, 0.0), length)


@_compiled.kernel(inline=True)
def positive(f0: float, f1: float, f2: float, end: float) -> float:
    """Return the length of the part of [0, end] where f0 + f1 s + f2 s^2 > 0."""
    square = f1 * f1 - 4 * f0 * f2
    # Both terms have one sign, so that no digits cancel; the roots are f0 / q and q / f2.
    q = -0.5 * (f1 + math.copysign(math.sqrt(max(square, 0.0)), f1))
    if (square < 0) | (q == 0):
        return end if max(f0, f0 + f2) > 0 else 0.0
    first, second = min(max(f0 / q, 0.0), end), min(max(q / (f2 + 0.0), 0.0), end)
    between = abs(first - second)
    return end - between if f2 >= 0 else between


@_compiled.kernel(inline=True)
def locate(edges: Array, place: float) -> int:
    """Return the index of the interval of rising edges, the first and last unbounded."""
    low, high = 0, len(edges) - 1
    while high - low > 1:
        middle = (low + high) >> 1
        if edges[middle] <= place:
            low = middle
        else:
            high = middle
    return low


@_compiled.kernel(inline=True)
def relative(edges: Array, cell: int, place: float, way: float) -> tuple[float, float]:
    """Return a relative position in a cell and its rate of change; 0 in an unbounded cell."""
    width = edges[cell + 1] - edges[cell]
    return ((place - edges[cell]) / width, way / width) if width < math.inf else (0.0, 0.0)


@_compiled.kernel(inline=True)
def crossing(edges: Array, cell: int, level: int, start: float, way: float) -> float:
    """Return the distance at which a ray leaves its square along one axis."""
    if way == 0:
        return math.inf
    out = min((cell + (1 if way > 0 else 0)) << level, len(edges) - 1)
    distance: float = (edges[out] - start) / way
    return distance


@_compiled.kernel(inline=True)
def child(edges: Array, cell: int, level: int, place: float) -> int:
    """Return the half of a square, along one axis, that contains a position."""
    left = cell << 1
    return left + (1 if place >= edges[min((left + 1) << level, len(edges) - 1)] else 0)


@_compiled.kernel(inline=True)
def beside(largest: Array, at: int, before_x: int, before_y: int) -> tuple[int, int]:
    """Return steps back to a cell that is not empty, of those at both sides of a ray's planes."""
    if largest[at] > -math.inf or before_x + before_y == 0:
        return 0, 0
    if before_x > 0 and largest[at - 1] > -math.inf:
        return 1, 0
    if before_y > 0 and largest[at - before_y] > -math.inf:
        return 0, 1
    # Of the four cells at a vertical ray through a node the one across is left.
    return (1, 1) if before_x > 0 and before_y > 0 else (0, 0)


@_compiled.kernel(seconds=1.4)
def walk(
    start: Array, way: Array, reach: Array, x: Array, y: Array, corners: Array, bounds: Bounds,
    walls: bool, out: Array,
) -> None:  # fmt: skip
    """Write the lengths of rays inside the solid, as :func:`march` does."""
    largest, least, offset, columns = bounds
    top = largest[-1]
    for ray in range(len(out)):
        px, py, pz = start[0, ray], start[1, ray], start[2, ray]
        wx, wy, wz = way[0, ray], way[1, ray], way[2, ray]
        # Above the highest node there is nothing to meet.
        place = (top - pz) / wz if wz != 0 else 0.0
        s, end = max(place, 0.0) if wz < 0 else 0.0, reach[ray]
        # A level ray above all nodes ends at 0, so that nothing is walked.
        if wz > 0 or (wz == 0 and pz >= top):
            end = min(end, place)
        # A ray begins in its own cell and climbs to larger squares as it goes.
        i, j, level, length = locate(x, px + s * wx), locate(y, py + s * wy), 0, 0.0
        # Steps back to the cell before a plane of nodes, in the flat array of level 0: 1 along x,
        # and a whole row along y.
        before_x = 1 if walls and wx == 0 and px == x[i] else 0
        before_y = columns[0] if walls and wy == 0 and py == y[j] else 0
        # A ray in a plane of nodes goes from cell to cell.
        highest = len(offset) - 1 if before_x + before_y == 0 else 0
        while s < end:
            # The nearer of the two edges of the square is where the ray leaves it.
            cross_x, cross_y = crossing(x, i, level, px, wx), crossing(y, j, level, py, wy)
            # Never backwards: rounding may put an edge just behind the ray that has crossed it.
            leave = min(max(min(cross_x, cross_y), s), end)
            z, last = pz + s * wz, pz + leave * wz
            at = offset[level] + j * columns[level] + i
            back_x, back_y = beside(largest, at, before_x, before_y)
            at -= back_x + back_y * columns[0]
            # Wholly below the square: all of the way is inside, without a look at its cells.
            if max(z, last) <= least[at]:
                length += leave - s
            # Neither below nor above: into the quarter that contains the ray, down to a single
            # cell.
            elif min(z, last) < largest[at]:
                if level > 0:
                    level -= 1
                    i = child(x, i, level, px + s * wx)
                    j = child(y, j, level, py + s * wy)
                    continue
                # The crossing with the bilinear surface of a single cell, as for many rays at once.
                column, row = i - back_x, j - back_y
                u, du = relative(x, column, px + s * wx, wx)
                v, dv = relative(y, row, py + s * wy, wy)
                z00, z10 = corners[row, column], corners[row + 1, column]
                a, b = corners[row, column + 1] - z00, z10 - z00
                c = (corners[row + 1, column + 1] - z10) - a
                f0 = (z00 - z) + u * a + v * (b + u * c)
                f1 = du * (a + v * c) + dv * (b + u * c) - wz
                length += positive(f0, f1, du * dv * c, leave - s)
            if leave >= end:
                break
            s = leave
            # On into the next square, or one twice as wide if both begin at the same place.
            if cross_x <= cross_y:
                i += 1 if wx > 0 else -1
                # A ray that goes forward enters a pair of squares at its even number, another at
                # its odd one.
                rise = (i ^ int(wx < 0)) & 1 == 0
            else:
                j += 1 if wy > 0 else -1
                rise = (j ^ int(wy < 0)) & 1 == 0
            if rise and level < highest:
                i, j, level = i >> 1, j >> 1, level + 1
        # A way that has grown to FAR has never left the solid.
        out[ray] = length if length < 0.5 * FAR else math.inf
