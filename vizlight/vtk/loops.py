"""Loops over the faces of a surface that are compiled where that pays, beside those in NumPy."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from vizlight import _compiled
from vizlight._types import Array, Bools, Indices, Raw

#: Seconds that a kernel saves per corner of a face, per triangle in the two next, and per edge.
CORNER_SAVED, DIRECTION_SAVED, SURVEY_SAVED, EDGE_SAVED = 2.5e-8, 3.5e-8, 7e-8, 2e-8
#: Number of edges at a point from which these are sorted by a merge rather than by insertion.
_MANY = 64
#: Squares of lengths between which no digit is lost.
_LOW, _HIGH = float(np.finfo(np.float64).tiny / np.finfo(np.float64).eps), 1.7e308


@_compiled.kernel(inline=True)
def _unit(x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """Return a unit vector and the length that the vector had, as :func:`.kernels.unit`."""
    square = x * x + y * y + z * z
    if _LOW <= square <= _HIGH:
        size = math.sqrt(square)
        return x / size, y / size, z / size, size
    largest = max(abs(x), abs(y), abs(z))
    if not 0 < largest < np.inf:
        return 0.0, 0.0, 0.0, 0.0 if largest == 0 else np.nan
    x, y, z = x / largest, y / largest, z / largest
    size = math.sqrt(x * x + y * y + z * z)
    return x / size, y / size, z / size, size * largest


@_compiled.kernel(inline=True)
def _find_sides(place: Array, side: Array, square: Array, length: Array) -> tuple[float, float]:
    """Find the sides of a face, and return the largest and the least of their squares."""
    s, longest, shortest = len(place), 0.0, np.inf
    for i in range(s):
        j = i + 1 if i + 1 < s else 0
        total = 0.0
        for k in range(3):
            side[i, k] = place[j, k] - place[i, k]
            total += side[i, k] * side[i, k]
        square[i], length[i] = total, math.sqrt(total)
        # A comparison with NaN is false, which must not hide it.
        longest = total if not total <= longest else longest
        shortest = min(shortest, total)
    return longest, shortest


@_compiled.kernel(inline=True)
def _area(place: Array) -> tuple[float, float, float, float]:
    """Return the direction of a face, and the length of twice its area vector."""
    x = y = z = 0.0
    u, v, w = place[0, 0], place[0, 1], place[0, 2]
    for i in range(1, len(place) - 1):
        a, b, c = place[i, 0] - u, place[i, 1] - v, place[i, 2] - w
        d, e, f = place[i + 1, 0] - u, place[i + 1, 1] - v, place[i + 1, 2] - w
        x, y, z = x + b * f - c * e, y + c * d - a * f, z + a * e - b * d
    return _unit(x, y, z)


@_compiled.kernel(inline=True)
def _find_backs(before: Indices, square: Array) -> None:
    """Find the side before each corner, but for sides of no length in a face that has others."""
    s = len(before)
    for i in range(s):
        before[i] = i - 1 if i else s - 1
    # Of a point that a face names twice in turn the last counts, and the side before both.
    if s > 3:
        for _ in range(2):
            for i in range(s):
                if square[before[i]] == 0:
                    before[i] = before[i - 1 if i else s - 1]


@_compiled.kernel(seconds=2.0)
def add_corners(total: Array, points: Raw, ids: Indices, s: int, flat: float, least: float) -> None:
    """Add the weighted normals of the corners of faces of ``s`` corners.

    See :func:`~vizlight.vtk.corners.corner_normals`; arrays are flat, ``total`` by points. ``flat``
    and ``least`` are its ``FLAT`` and ``LEAST``.
    """
    place, side = np.empty((s, 3)), np.empty((s, 3))
    square, length, before = np.empty(s), np.empty(s), np.empty(s, dtype=np.int64)
    for face in range(len(ids) // s):
        for i in range(s):
            at = 3 * ids[face * s + i]
            for k in range(3):
                place[i, k] = points[at + k]
        longest, shortest = _find_sides(place, side, square, length)
        # A face with a corner that is not finite says nothing.
        if not 0 < longest < np.inf or not shortest >= 0:
            continue
        fx, fy, fz, area = _area(place)
        height = min(area / (flat * longest), 1.0)
        _find_backs(before, square)
        for i in range(s):
            back = before[i]
            a, b, c = side[i, 0], side[i, 1], side[i, 2]
            d, e, f = -side[back, 0], -side[back, 1], -side[back, 2]
            x, y, z, size = fx, fy, fz, area
            if s > 3:
                p, q, r, size = _unit(b * f - c * e, c * d - a * f, a * e - b * d)
                # Sides in one line have no plane of their own, and at a dent their product points
                # to the back of the face.
                if size > flat * max(square[i], square[back]):
                    sign = -1.0 if p * fx + q * fy + r * fz < 0 else 1.0
                    x, y, z = sign * p, sign * q, sign * r
            near = length[i] * length[back]
            if near == 0:
                weight = least * height / math.sqrt(longest)
            else:
                # A straight corner has no sine, but an angle.
                angle = math.atan2(size, a * d + b * e + c * f)
                weight = math.sqrt(angle * max(size, flat * near)) * height / near
            if math.isfinite(weight):
                at = 3 * ids[face * s + i]
                total[at] += x * weight
                total[at + 1] += y * weight
                total[at + 2] += z * weight


@_compiled.kernel(seconds=1.5)
def find_directions(
    unit: NDArray[np.float32], full: Bools, points: Raw, ids: Indices, narrowest: float, near: float
) -> int:  # fmt: skip
    """Find the directions of triangles, and which have one; return the number of slivers.

    Arrays but ``unit``, of shape (3, n), are flat. See :class:`.orientation.SurfaceShape`.
    """
    slivers = 0
    for face in range(len(full)):
        i, j, k = 3 * ids[3 * face], 3 * ids[3 * face + 1], 3 * ids[3 * face + 2]
        px, py, pz = np.float64(points[i]), np.float64(points[i + 1]), np.float64(points[i + 2])
        a, b, c = points[j] - px, points[j + 1] - py, points[j + 2] - pz
        d, e, f = points[k] - px, points[k + 1] - py, points[k + 2] - pz
        x, y, z, size = _unit(b * f - c * e, c * d - a * f, a * e - b * d)
        unit[0, face], unit[1, face], unit[2, face] = x, y, z
        first, other = a * a + b * b + c * c, d * d + e * e + f * f
        third = (d - a) ** 2 + (e - b) ** 2 + (f - c) ** 2
        longest = max(first, other, third)
        full[face] = size > narrowest * longest
        slivers += min(first, other, third) <= near * near * longest
    return slivers


@_compiled.kernel(seconds=2.0)
def survey(
    sums: Array, bend: Array, least: NDArray[np.float32], points: Raw, ids: Indices,
    normals: Array, finite: Bools, full: Bools, piece: Indices, middle: Array, largest: float,
) -> None:  # fmt: skip
    """Add the triangles of a surface up; see :meth:`~vizlight.vtk.orientation.SurfaceShape.survey`.

    Rows of ``sums`` are volume, area and the area vector of each piece, those of ``middle`` its
    centroid; other arrays are flat.
    """
    at, place, way = np.empty(3, dtype=np.int64), np.empty((3, 3)), np.empty((3, 3))
    for face in range(len(full)):
        valid = True
        for i in range(3):
            at[i] = ids[3 * face + i]
            valid = valid and finite[at[i]]
            for k in range(3):
                place[i, k] = points[3 * at[i] + k]
        if not valid:
            continue
        number = piece[at[0]]
        a, b, c = (
            (place[1, 0] - place[0, 0]) / largest,
            (place[1, 1] - place[0, 1]) / largest,
            (place[1, 2] - place[0, 2]) / largest,
        )
        d, e, f = (
            (place[2, 0] - place[0, 0]) / largest,
            (place[2, 1] - place[0, 1]) / largest,
            (place[2, 2] - place[0, 2]) / largest,
        )
        x, y, z = b * f - c * e, c * d - a * f, a * e - b * d
        p, q, r, size = _unit(x, y, z)
        sums[number, 0] += (
            (place[0, 0] - middle[number, 0]) / largest * x
            + (place[0, 1] - middle[number, 1]) / largest * y
            + (place[0, 2] - middle[number, 2]) / largest * z
        )
        sums[number, 1] += size
        sums[number, 2] += x
        sums[number, 3] += y
        sums[number, 4] += z
        # Three times the way from each corner to the centre of its triangle.
        way[0, 0], way[0, 1], way[0, 2] = a + d, b + e, c + f
        way[1, 0], way[1, 1], way[1, 2] = d - 2 * a, e - 2 * b, f - 2 * c
        way[2, 0], way[2, 1], way[2, 2] = a - 2 * d, b - 2 * e, c - 2 * f
        for i in range(3):
            n = 3 * at[i]
            u, v, w = normals[n], normals[n + 1], normals[n + 2]
            bend[at[i]] += u * way[i, 0] + v * way[i, 1] + w * way[i, 2]
            if full[face]:
                cosine = np.float32(u * p + v * q + w * r)
                # A normal that is not finite makes the least one so, as in NumPy.
                if not cosine >= least[at[i]]:
                    least[at[i]] = cosine


@_compiled.kernel(inline=True)
def _sort(begin: Indices, keys: NDArray[np.int64], places: Indices, forward: Bools) -> None:
    """Sort the edges from each point on by their keys; those of one key stay in order."""
    for i in range(len(begin) - 1):
        low, beyond = begin[i], begin[i + 1]
        if beyond - low > _MANY:
            order = low + np.argsort(keys[low:beyond], kind="mergesort")
            values, whole, ahead = keys[order], places[order], forward[order]
            keys[low:beyond], places[low:beyond], forward[low:beyond] = values, whole, ahead
            continue
        for j in range(low + 1, beyond):
            key, place, way = keys[j], places[j], forward[j]
            k = j
            while k > low and keys[k - 1] > key:
                keys[k], places[k], forward[k] = keys[k - 1], places[k - 1], forward[k - 1]
                k -= 1
            keys[k], places[k], forward[k] = key, place, way


@_compiled.kernel(seconds=1.5)
def sort_edges(
    ids: Indices, spans: NDArray[np.int64], low: int, high: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], Bools]:
    """Return edges of triangles, as :func:`~vizlight.vtk.topology.sorted_edges` yields them.

    Those with a lower end from ``low`` on and below ``high``, of triangles of which the flat
    ``ids`` are the corners. A row of ``spans`` is the first of some triangles and the one after.
    """
    begin = np.zeros(high - low + 1, dtype=np.int64)
    for span in range(len(spans)):
        for at in range(3 * spans[span, 0], 3 * spans[span, 1], 3):
            for i in range(3):
                a, b = ids[at + i], ids[at + (i + 1 if i < 2 else 0)]
                lower = min(a, b)
                if a != b and low <= lower < high:
                    begin[lower - low + 1] += 1
    for i in range(high - low):
        begin[i + 1] += begin[i]
    n = begin[high - low]
    keys, places = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    forward, end = np.empty(n, dtype=np.bool_), begin.copy()
    for span in range(len(spans)):
        for at in range(3 * spans[span, 0], 3 * spans[span, 1], 3):
            for i in range(3):
                a, b = np.int64(ids[at + i]), np.int64(ids[at + (i + 1 if i < 2 else 0)])
                lower = min(a, b)
                if a != b and low <= lower < high:
                    to = end[lower - low]
                    end[lower - low] = to + 1
                    keys[to], places[to], forward[to] = lower << 32 | max(a, b), at + i, a == lower
    _sort(begin, keys, places, forward)
    return keys, places, forward
