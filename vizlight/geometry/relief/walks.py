"""Exact lengths inside a height field by compiled code, for rays toward any light.

:func:`walk` follows the same bilinear surface as :mod:`marching` and finds its crossings in closed
form. It goes through squares of 2^l x 2^l cells, up and down the hierarchy of their heights.
:mod:`strips` is faster for most lights at infinity.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled
from vizlight.geometry.relief.marching import FAR

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

#: Processor time that a compiled ray saves compared with one of :mod:`marching`, in seconds.
SAVED = 5e-6

Triple = tuple[float, float, float]
Levels = tuple["Array", "Array", "Indices", "Indices"]


@_compiled.kernel(inline=True)
def positive(f0: float, f1: float, f2: float, end: float) -> float:
    """Return the length of the part of [0, end] where f0 + f1 s + f2 s^2 > 0."""
    last = f0 + end * (f1 + end * f2)
    if f0 > 0 and last > 0 and f2 <= 0:
        return end
    if f0 < 0 and last < 0 and f2 >= 0:
        return 0.0
    square = f1 * f1 - 4 * f0 * f2
    # Both roots without cancellation; where f2 is 0 one of them is infinite.
    q = -0.5 * (f1 + math.copysign(math.sqrt(max(square, 0.0)), f1))
    if square < 0 or q == 0:
        return end if max(f0, f0 + f2) > 0 else 0.0
    one, other = f0 / q, q / f2 if f2 != 0 else math.copysign(math.inf, q)
    low, high = min(one, other), max(one, other)
    between = min(max(high, 0.0), end) - min(max(low, 0.0), end)
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
def in_cell(corners: Array, i: int, j: int, place: Triple, rate: Triple, length: float) -> float:
    """Return the length inside the solid in one cell.

    ``place`` holds the relative position (u, v) in the cell and the height at its entry, ``rate``
    their changes per unit of length.
    """
    # Bilinear height minus the ray's: with u, v and z linear in the way s, a quadratic f0 + f1 s +
    # f2 s^2, positive where the ray is inside.
    z00, z10 = corners[j, i], corners[j + 1, i]
    a, b = corners[j, i + 1] - z00, z10 - z00
    c = (corners[j + 1, i + 1] - z10) - a
    u, v, z = place
    du, dv, dz = rate
    f0 = (z00 - z) + u * a + v * (b + u * c)
    f1 = du * (a + v * c) + dv * (b + u * c) - dz
    inside: float = positive(f0, f1, du * dv * c, length)
    return inside


@_compiled.kernel(inline=True)
def below_top(top: float, z: float, rise: float, reach: float) -> tuple[float, float]:
    """Return the distances between which a ray is below the highest node."""
    if rise == 0:
        return (0.0, reach) if z < top else (0.0, -1.0)
    place = (top - z) / rise
    return (0.0, min(place, reach)) if rise > 0 else (max(place, 0.0), reach)


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
    return (1, 1) if before_x > 0 and before_y > 0 else (0, 0)


@_compiled.kernel(seconds=1.4)
def walk(
    start: Array, way: Array, reach: Array, x: Array, y: Array, corners: Array, bounds: Levels,
    top: float, walls: bool, out: Array,
) -> None:  # fmt: skip
    """Write the lengths of rays inside the solid, as :func:`marching.march` returns them.

    ``walls`` tells that there are cells without a solid.
    """
    largest, least, offset, columns = bounds
    for ray in range(len(out)):
        px, py, pz = start[0, ray], start[1, ray], start[2, ray]
        wx, wy, wz = way[0, ray], way[1, ray], way[2, ray]
        # Above the highest node there is nothing to meet.
        s, end = below_top(top, pz, wz, reach[ray])
        # A ray begins in its own cell and climbs to larger squares as it goes.
        i, j, level, length = locate(x, px + s * wx), locate(y, py + s * wy), 0, 0.0
        before_x = 1 if walls and wx == 0 and px == x[i] else 0
        before_y = columns[0] if walls and wy == 0 and py == y[j] else 0
        # A ray in a plane of nodes goes from cell to cell.
        highest = len(offset) - 1 if before_x + before_y == 0 else 0
        while s < end:
            # The nearer of the two edges of the square is where the ray leaves it.
            cross_x, cross_y = crossing(x, i, level, px, wx), crossing(y, j, level, py, wy)
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
                u, du = relative(x, i - back_x, px + s * wx, wx)
                v, dv = relative(y, j - back_y, py + s * wy, wy)
                own = in_cell(corners, i - back_x, j - back_y, (u, v, z), (du, dv, wz), leave - s)
                length += own
            if leave >= end:
                break
            s = leave
            # On into the next square, or one twice as wide if both begin at the same place.
            if cross_x <= cross_y:
                i += 1 if wx > 0 else -1
                rise = (i ^ int(wx < 0)) & 1 == 0
            else:
                j += 1 if wy > 0 else -1
                rise = (j ^ int(wy < 0)) & 1 == 0
            if rise and level < highest:
                i, j, level = i >> 1, j >> 1, level + 1
        # A way that has grown to FAR has never left the solid.
        out[ray] = length if length < 0.5 * FAR else math.inf


def levels(bounds: list[tuple[Array, Array]]) -> Levels:
    """Return the bounds of a field as one array each, with the offset and row length of levels."""
    sizes = np.array([largest.size for largest, _ in bounds])
    return (
        np.concatenate([largest.ravel() for largest, _ in bounds]),
        np.concatenate([least.ravel() for _, least in bounds]),
        np.cumsum(sizes) - sizes,
        np.array([largest.shape[1] for largest, _ in bounds]),
    )
