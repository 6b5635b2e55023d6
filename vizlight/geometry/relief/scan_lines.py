"""Horizons of all nodes of a height field toward an azimuth, by scan lines, as compiled code.

The cells near a node are crossed one by one on the bilinear surface. The terrain behind them is
read from two lines beside the node that run along the azimuth: a line is swept once, against the
azimuth, and keeps the upper convex hull of the nodes it has passed, so that an azimuth costs O(n).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled
from vizlight.geometry.relief.crossings import NONE, between, crossed

if TYPE_CHECKING:
    from vizlight._types import Array


@_compiled.kernel(inline=True, rounding=_compiled.ROUNDING)
def seen(t: float, rise: float, upright: float, openness: bool) -> float:
    """Return the visible sky above a horizon of slope t from ground that rises toward it."""
    t = max(t, 0.0)
    if openness:
        return math.atan2(1.0, t)
    t = max(t, rise)
    square = 1 / (1 + t * t)
    value: float = upright * (square - rise * (math.atan2(1.0, t) - t * square))
    return value


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


@_compiled.kernel(rounding=_compiled.ROUNDING, seconds=3.0)
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
