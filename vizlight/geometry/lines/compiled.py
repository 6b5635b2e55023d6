"""Fibres by compiled code: roots, points, tangents and heights of a block in one pass.

The places of the roots follow from the same random numbers as those of :mod:`fur`, by the same
operations. The shapes are those of :func:`fur.strands`, but for rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices

#: Processor time that compiled code saves per point of a fibre, in seconds.
SAVED = 3e-8
#: Range in which the square of a length is exact to rounding.
LEAST = np.float32(np.finfo(np.float32).tiny / np.finfo(np.float32).eps)
MOST = np.float32(np.finfo(np.float32).max)
ZERO, ONE, TWO_PI = np.float32(0), np.float32(1), 2 * math.pi

Vector = tuple[np.float32, np.float32, np.float32]


@_compiled.kernel(inline=True)
def unit(x: np.float32, y: np.float32, z: np.float32) -> Vector:
    """Return a unit vector; zero for a vector that is zero or not finite."""
    square = x * x + y * y + z * z
    if not (square >= LEAST and square <= MOST):
        largest = max(abs(x), abs(y), abs(z))
        if not (largest > ZERO and abs(x + y + z) < math.inf):
            return ZERO, ZERO, ZERO
        x, y, z = x / largest, y / largest, z / largest
        square = x * x + y * y + z * z
    size = np.sqrt(square)
    return x / size, y / size, z / size


@_compiled.kernel(inline=True)
def across(x: np.float32, y: np.float32, z: np.float32) -> tuple[Vector, Vector]:
    """Return two unit directions perpendicular to a unit direction and to each other."""
    # The cross product with the axis of the least component.
    if abs(x) <= abs(y) and abs(x) <= abs(z):
        a, b, c = ZERO, z, -y
    elif abs(y) <= abs(z):
        a, b, c = -z, ZERO, x
    else:
        a, b, c = y, -x, ZERO
    a, b, c = unit(a, b, c)
    return (a, b, c), (y * c - z * b, z * a - x * c, x * b - y * a)


@_compiled.kernel(inline=True)
def mixed(table: Array, p: int, q: int, r: int, w: Vector) -> Vector:
    """Return the weighted sum of the vectors at three places of a table."""
    return (
        table[p] * w[0] + table[q] * w[1] + table[r] * w[2],
        table[p + 1] * w[0] + table[q + 1] * w[1] + table[r + 1] * w[2],
        table[p + 2] * w[0] + table[q + 2] * w[1] + table[r + 2] * w[2],
    )


@_compiled.kernel(inline=True)
def measures(vertices: Array, triangles: Indices, t: int) -> tuple[float, float, float, float]:
    """Return three times the centre of a triangle, NaN if not finite, and twice its area."""
    a, b, c = 3 * triangles[3 * t], 3 * triangles[3 * t + 1], 3 * triangles[3 * t + 2]
    ox, oy, oz = np.float64(vertices[a]), np.float64(vertices[a + 1]), np.float64(vertices[a + 2])
    ux, uy, uz = vertices[b] - ox, vertices[b + 1] - oy, vertices[b + 2] - oz
    vx, vy, vz = vertices[c] - ox, vertices[c + 1] - oy, vertices[c + 2] - oz
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    size = math.sqrt(x * x + y * y + z * z)
    x, y, z = ox + vertices[b], oy + vertices[b + 1], oz + vertices[b + 2]
    x, y, z = x + vertices[c], y + vertices[c + 1], z + vertices[c + 2]
    if not abs(x) + abs(y) + abs(z) < math.inf:
        x = y = z = math.nan
    return x, y, z, size if size < math.inf else 0.0


@_compiled.kernel(inline=True)
def hilbert(x: int, y: int, z: int, bits: int) -> int:
    """Return the index of a cell on a Hilbert curve, as :func:`fur.hilbert`."""
    for bit in range(bits - 1, 0, -1):
        low = (1 << bit) - 1
        x ^= low & -(x >> bit & 1)
        one = -(y >> bit & 1)
        swapped = (x ^ y) & low & ~one
        x, y = x ^ ((low & one) | swapped), y ^ swapped
        one = -(z >> bit & 1)
        swapped = (x ^ z) & low & ~one
        x, z = x ^ ((low & one) | swapped), z ^ swapped
    y ^= x
    z ^= y
    turned = 0
    for bit in range(bits - 1, 0, -1):
        turned ^= ((1 << bit) - 1) & -(z >> bit & 1)
    x, y, z = x ^ turned, y ^ turned, z ^ turned
    index = 0
    for bit in range(bits - 1, -1, -1):
        index = index << 3 | (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1)
    return index


@_compiled.kernel()
def lay(vertices: Array, triangles: Indices, bits: int, key: Indices, area: Array) -> None:
    """Write twice the areas of triangles, and the indices of their centres on a Hilbert curve.

    Arrays are flat. All indices are 0 where there is one centre alone or none is finite.
    """
    least_x = least_y = least_z = math.inf
    most_x = most_y = most_z = -math.inf
    centres = np.empty((3, len(key)))
    for t in range(len(key)):
        x, y, z, area[t] = measures(vertices, triangles, t)
        centres[0, t], centres[1, t], centres[2, t] = x, y, z
        # NaN compares as false.
        least_x, most_x = x if x < least_x else least_x, x if x > most_x else most_x
        least_y, most_y = y if y < least_y else least_y, y if y > most_y else most_y
        least_z, most_z = z if z < least_z else least_z, z if z > most_z else most_z
    side = max(most_x - least_x, most_y - least_y, most_z - least_z)
    cells = float((1 << bits) - 1)
    for t in range(len(key)):
        x, y, z = centres[0, t], centres[1, t], centres[2, t]
        key[t] = 0
        if 0 < side < math.inf:
            known = x == x
            key[t] = hilbert(
                int((x - least_x) / side * cells) if known else 0,
                int((y - least_y) / side * cells) if known else 0,
                int((z - least_z) / side * cells) if known else 0,
                bits,
            )


@_compiled.kernel(inline=True)
def first_above(total: Array, place: float, low: int) -> int:
    """Return the first triangle from one on that ends above a place, or the last triangle."""
    high = len(total) - 1
    while low < high:
        middle = (low + high) >> 1
        if total[middle] <= place:
            low = middle + 1
        else:
            high = middle
    return low


@_compiled.kernel(inline=True)
def weights(before: float, area: float, mean: float, number: float, jitter: float) -> Vector:
    """Return the barycentric coordinates of a seed, as :func:`fur.seed_block`."""
    area = area if area > 0 else 1.0
    root = np.float32(math.sqrt(min(max(before / area, 0.0), 1.0)))
    number = number + math.sqrt(min(mean / area, 1.0)) * jitter
    last = np.float32((number - math.floor(number)) * root)
    return ONE - root, root - last, last


@_compiled.kernel(inline=True)
def erect(
    way: Vector, normal: Vector, root: Vector, step: np.float32, each: np.float32, segments: int,
    points: Array, tangents: Array, heights: Array, fibre: int,
) -> None:  # fmt: skip
    """Write the points, tangents and heights of a straight fibre."""
    m = segments + 1
    tip = np.float32(segments) * step
    up = (tip * way[0] * normal[0] + tip * way[1] * normal[1] + tip * way[2] * normal[2]) / each
    over = max(up, ZERO)
    for j in range(m):
        size, k = np.float32(j) * step, 3 * (m * fibre + j)
        for i in range(3):
            points[k + i] = root[i] + size * way[i]
            tangents[k + i] = way[i]
    if len(heights):
        for j in range(m):
            heights[m * fibre + j] = over - np.float32(j / segments) * up


@_compiled.kernel(inline=True)
def bend(
    way: Vector, toward: Vector, shape: Array, phase: float, step: np.float32, offset: Array
) -> None:
    """Write the points of a fibre less its root, as :func:`fur.strands`."""
    segments, curl = len(offset) // 3 - 1, np.float32(shape[2])
    side, other = across(way[0], way[1], way[2])
    for j in range(segments):
        share = (j + 0.5) / segments
        lean = np.float32(shape[1] * share)
        angle = np.float32(phase + TWO_PI * shape[3] * share)
        p, q = curl * np.float32(math.cos(angle)), curl * np.float32(math.sin(angle))
        x = way[0] + lean * toward[0] + (p * side[0] + q * other[0])
        y = way[1] + lean * toward[1] + (p * side[1] + q * other[1])
        z = way[2] + lean * toward[2] + (p * side[2] + q * other[2])
        size = np.sqrt(x * x + y * y + z * z)
        size = step / (size if size > ZERO else ONE)
        k = 3 * j
        offset[k + 3] = offset[k] + x * size
        offset[k + 4] = offset[k + 1] + y * size
        offset[k + 5] = offset[k + 2] + z * size


@_compiled.kernel(inline=True)
def tangent(offset: Array, j: int, i: int) -> np.float32:
    """Return a component of the tangent of the parabola through three points of a fibre."""
    last, k = len(offset) // 3 - 1, 3 * j + i
    if last == 1:
        found = offset[3 + i]
    elif j == 0:
        found = np.float32(3) * offset[3 + i] - (offset[6 + i] - offset[3 + i])
    elif j == last:
        found = (offset[k - 6] - offset[k - 3]) - np.float32(3) * (offset[k - 3] - offset[k])
    else:
        found = offset[k + 3] - offset[k - 3]
    result: np.float32 = found
    return result


@_compiled.kernel(inline=True)
def hang(
    way: Vector, normal: Vector, root: Vector, each: np.float32, offset: Array, points: Array,
    tangents: Array, heights: Array, fibre: int,
) -> None:  # fmt: skip
    """Write the points, tangents and heights of a fibre that bends."""
    m = len(offset) // 3
    highest = np.float32(-math.inf)
    for j in range(m):
        k = 3 * (m * fibre + j)
        x, y, z = offset[3 * j], offset[3 * j + 1], offset[3 * j + 2]
        highest = max(highest, (x * normal[0] + y * normal[1] + z * normal[2]) / each)
        lost = True
        for i in range(3):
            points[k + i] = root[i] + offset[3 * j + i]
            tangents[k + i] = tangent(offset, j, i)
            lost = lost and tangents[k + i] == ZERO
        if lost:
            tangents[k], tangents[k + 1], tangents[k + 2] = way
    if len(heights):
        for j in range(m):
            x, y, z = offset[3 * j], offset[3 * j + 1], offset[3 * j + 2]
            up = (x * normal[0] + y * normal[1] + z * normal[2]) / each
            heights[m * fibre + j] = highest - up


# With lay, which is compiled before it.
@_compiled.kernel(seconds=2.9)
def grow(
    total: Array, place: Array, number: Array, jitter: Array, start: Array, triangle: int,
    mean: float, corners: Indices, table: Array, at: Indices, toward: Array, phase: Array,
    shape: Array, segments: int, points: Array, tangents: Array, normals: Array,
    heights: Array, inside: Bools,
) -> None:  # fmt: skip
    """Write a block of fibres.

    Parameters
    ----------
    total : ndarray, shape (T,)
        Cumulative areas of the triangles.
    place, number, jitter : ndarray, shape (F,)
        Seeds: areas before them, in rising order, numbers on the lattice, and random numbers.
    start, triangle
        Random numbers of the triangles from one on, and the index of that triangle.
    mean : float
        Area per fibre.
    corners : ndarray of int, shape (3 T,)
        Corners of the triangles.
    table, at
        Flat table of point arrays, and where its columns are: number of all, first column of the
        vectors, of the direction to which fibres bend and of the lengths, or 0.
    toward : ndarray, shape (3,)
        The direction to which fibres bend, where it is one for all.
    phase : ndarray, shape (F,) or (0,)
        Angles at which the curl starts.
    shape : ndarray, shape (5,)
        Length, bend, curl, turns, unit of heights.
    segments : int
        Number of segments.
    points, tangents, normals, heights : ndarray
        Written, point after point; normals and heights may be empty. Tangents have any length.
    inside : ndarray of bool, shape (F,)
        Written: whether the vector of a fibre points into the surface, where it is reversed.
    """
    m, width = segments + 1, at[0]
    t = first_above(total, place[0], triangle)
    each, length = np.float32(shape[4]), np.float32(shape[0])
    straight = shape[1] == 0 and shape[2] == 0
    target = toward[0], toward[1], toward[2]
    offset = np.zeros(3 * m, np.float32)
    for f in range(len(place)):
        while t < len(total) - 1 and place[f] >= total[t]:
            t += 1
        edge = total[t - 1] if t > 0 else 0.0
        w = weights(
            place[f] - edge, total[t] - edge, mean, number[f] + start[t - triangle], jitter[f]
        )
        a, b, c = width * corners[3 * t], width * corners[3 * t + 1], width * corners[3 * t + 2]
        root = mixed(table, a, b, c, w)
        x, y, z = mixed(table, a + 3, b + 3, c + 3, w)
        normal = unit(x, y, z)
        way = normal
        if at[1]:
            x, y, z = mixed(table, a + at[1], b + at[1], c + at[1], w)
            x, y, z = unit(x, y, z)
            if x != ZERO or y != ZERO or z != ZERO:
                way = x, y, z
            inside[f] = way[0] * normal[0] + way[1] * normal[1] + way[2] * normal[2] < ZERO
            if inside[f]:
                way = -way[0], -way[1], -way[2]
        if at[2]:
            x, y, z = mixed(table, a + at[2], b + at[2], c + at[2], w)
            target = unit(x, y, z)
        if at[3]:
            length = table[a + at[3]] * w[0] + table[b + at[3]] * w[1] + table[c + at[3]] * w[2]
        step = length / np.float32(segments)
        if straight:
            erect(way, normal, root, step, each, segments, points, tangents, heights, f)
        else:
            angle = phase[f] if len(phase) else 0.0
            bend(way, target, shape, angle, step, offset)
            hang(way, normal, root, each, offset, points, tangents, heights, f)
        if len(normals):
            for j in range(m * f, m * f + m):
                for i in range(3):
                    normals[3 * j + i] = normal[i]
