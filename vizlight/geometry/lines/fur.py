"""Fibres on a triangulated surface: the positions of their roots and the shape of each fibre."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check, _pool
from vizlight._types import Array, Indices

__all__ = ["seeds"]

#: Number of seeds per block; each block has its own random generator, independent of threads.
SEED_BLOCK = 1 << 16
#: Number of triangles that are worked on at once, such that their places fit in the cache.
FEW = 1 << 14
#: Step of a Fibonacci lattice, 2 minus the golden ratio: its multiples fill [0, 1) evenly.
TURN = (3 - 5**0.5) / 2


def seeds(
    points: ArrayLike, faces: ArrayLike, count: int, /, *, seed: int = 0
) -> tuple[Indices, Array]:
    """Return random places on triangles, spread evenly over the area.

    The triangles are laid out one after the other, along a Hilbert curve through space, and their
    total area is cut into ``count`` equal pieces. Each piece has one place at a random position.
    The number of places on a triangle is therefore proportional to its area to within one or two.
    The places on a triangle follow a jittered Fibonacci lattice, which keeps them apart on large
    triangles too.

    Parameters
    ----------
    points : array_like, shape (N, 3)
        Vertices of the surface.
    faces : array_like of int, shape (T, 3)
        Indices of the vertices of each triangle.
    count : int
        Number of places, 0 or more.
    seed : int, default: 0
        Seed of the random generator; the same seed gives the same places.

    Returns
    -------
    face : ndarray of int, shape (count,)
        Index of the triangle of each place, in the order of the curve.
    weights : ndarray of float32, shape (count, 3)
        Barycentric coordinates in that triangle.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid, or the surface has no area.

    Notes
    -----
    If the share f of its triangle's area lies before a place, the weights are
    ``(1 - sqrt(f), sqrt(f) (1 - r), sqrt(f) r)``, which preserves areas. From place to place r
    advances by the golden ratio, from a random start in each triangle; on a triangle with m places
    it is jittered by ``1 / sqrt(m)``. Neighbours on the curve are neighbours in space, so places
    are even whatever the order and size of the triangles: the variance of the number of places on
    patches of equal area is at most 0.25 of its mean (1 for independent places), and 0.8 where all
    triangles are slivers 500 times as long as wide. Source: Banks, section 5 (jittered interpolated
    samples).
    """
    vertices = _check.vectors("points", points, n=3)
    triangles = _check.cells("faces", faces, len(vertices), (3,))
    count = _check.integer("count", count, low=0)
    _check.holds("count", (count, 3))
    seed = _check.integer("seed", seed, low=0)
    order, total = laid(vertices, triangles)
    if count and not (len(total) and total[-1] > 0):
        expected = "triangles with an area above 0 between finite points"
        raise _check.value_error("faces", expected, "none")
    face, weights = np.empty(count, np.intp), np.empty((count, 3), np.float32)
    for start in range(0, count, SEED_BLOCK):
        block = slice(start, start + SEED_BLOCK)
        place, weights[block] = seed_block(total, start, count, seed)
        face[block] = order[place]
    return face, weights


def laid(vertices: Array, triangles: Indices) -> tuple[Indices, Array]:
    """Return the order of triangles along a Hilbert curve, and their cumulative areas in it.

    An area that is not finite is 0.
    """
    area, centre = np.empty(len(triangles)), np.empty((len(triangles), 3))
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(triangles), FEW):
            a, b, c = (vertices[corner].astype(np.float64) for corner in triangles[block].T)
            area[block] = np.linalg.norm(np.cross(b - a, c - a), axis=1)
            centre[block] = a + b + c
        # One infinite centre would make the box endless, and the order of all others meaningless.
        centre[~np.all(np.isfinite(centre), axis=1)] = np.nan
        # With an initial value a surface without triangles is no error here.
        low = np.nanmin(centre, axis=0, initial=np.inf)
        side = float(np.nanmax(centre - low, initial=0))
    area[~np.isfinite(area)] = 0
    order = np.arange(len(triangles))
    if 0 < side < np.inf:
        # Enough for 4 cells between neighbours, and no more: sorting grows with the bits.
        bits = min(max(len(triangles).bit_length() // 2 + 2, 4), 20)
        # Triangles without a centre come anywhere: their area is 0, and no seed falls on them.
        index = np.empty(len(triangles), dtype=np.int64)
        for block in _pool.blocks(len(triangles), FEW):
            places = np.nan_to_num((centre[block] - low) / side) * ((1 << bits) - 1)
            index[block] = hilbert(np.ascontiguousarray(places.T).astype(np.int64), bits)
        order = np.argsort(index)
    return order, np.cumsum(area[order])


def hilbert(cell: Indices, bits: int) -> Indices:
    """Return the index on a Hilbert curve of cells (3, N) of a grid of 2^bits cells per axis.

    The bits of each axis are turned and mirrored as J. Skilling, "Programming the Hilbert curve"
    (2004), describes.
    """
    x = cell.copy()
    for bit in range(bits - 1, 0, -1):
        low = (1 << bit) - 1
        for i in range(3):
            # All bits set, or none: with it lower bits of the first axis are mirrored, else
            # exchanged.
            mask = -(x[i] >> bit & 1)
            swapped = (x[0] ^ x[i]) & low & ~mask
            x[0] ^= (low & mask) | swapped
            x[i] ^= swapped
    # A Gray code, by which one axis changes at a time from cell to cell along the curve.
    x[1] ^= x[0]
    x[2] ^= x[1]
    turned = np.zeros_like(x[0])
    for bit in range(bits - 1, 0, -1):
        turned ^= ((1 << bit) - 1) & -(x[2] >> bit & 1)
    x ^= turned
    # The bits of the axes interleaved, from the highest on.
    index: Indices = np.zeros_like(turned)
    for bit in range(bits - 1, -1, -1):
        for i in range(3):
            index = index << 1 | (x[i] >> bit & 1)
    return index


def seed_block(total: Array, start: int, count: int, seed: int) -> tuple[Indices, Array]:
    """Return triangles and weights of the block of seeds that begins at a multiple of SEED_BLOCK.

    ``total`` is the cumulative area of the triangles, and ``count`` the number of all seeds.
    """
    # A generator for each block: blocks can be made in any order and by any thread.
    random = np.random.default_rng([seed, start // SEED_BLOCK])
    number = np.arange(start, min(start + SEED_BLOCK, count), dtype=np.float64)
    mean = float(total[-1] / count)
    # Stratified: one place anywhere in each of the equal pieces of the area.
    place = (number + random.random(len(number))) * mean
    first, last = np.minimum(np.searchsorted(total, place[[0, -1]], side="right"), len(total) - 1)
    starts = random.random(last + 1 - first)
    jitter = random.random(len(place), dtype=np.float32)
    # Places are sorted, so a search per triangle is enough and none per place is needed.
    ends = np.searchsorted(place, total[first:last], side="left")
    counts = np.diff(ends, prepend=0, append=len(place))
    face = np.repeat(np.arange(first, last + 1), counts)
    edges = np.concatenate([[total[first - 1] if first else 0.0], total[first : last + 1]])
    area = np.diff(edges)
    # A triangle without area has no place; its quotient is not used.
    area = np.where(area > 0, area, 1)
    share = (place - np.repeat(edges[:-1], counts)) / np.repeat(area, counts)
    # The square root of the area before a place makes places uniform in the triangle.
    root = np.sqrt(np.clip(share, 0, 1)).astype(np.float32)
    # Each triangle has its own lattice with a random start, so that no pattern spans triangles.
    number = number * TURN + np.repeat(starts, counts)
    # The part of a triangle that lies in another block has the same number of places per area.
    number += np.repeat(np.sqrt(np.minimum(mean / area, 1)), counts) * jitter
    weights = np.empty((len(place), 3), np.float32)
    weights[:, 0] = 1 - root
    weights[:, 2] = (number - np.floor(number)) * root
    # By difference, so that the three weights sum to 1 within rounding.
    weights[:, 1] = root - weights[:, 2]
    return face, weights


def strands(
    directions: Array,
    lengths: Array | float,
    /,
    *,
    segments: int,
    toward: Array | None = None,
    bend: float = 0.0,
    curl: float = 0.0,
    turns: float = 1.0,
    phase: Array | None = None,
) -> Array:
    """Return the points of fibres relative to their roots.

    The result has the shape (S + 1, 3, F), from root to tip, for S ``segments`` of equal length;
    NaN where an array is not finite. Fibres start along unit directions (3, F) and bend ``toward``
    others: ``bend`` times these are added at the tip, growing from 0 at the root. ``curl`` is the
    multiple of a perpendicular direction that rotates by ``turns`` from root to tip, from the angle
    ``phase`` in radians on; 1 leans the fibre by 45 degrees.
    """
    kind = directions.dtype
    out = np.zeros((segments + 1, *directions.shape), kind)
    step = np.asarray(lengths, kind) / segments
    if curl:
        side, up = _across(directions)
    for j in range(segments):
        # The direction of a segment is taken at its middle.
        t = (j + 0.5) / segments
        way = directions
        if bend and toward is not None:
            way = way + kind.type(bend * t) * toward
        if curl:
            start = 0.0 if phase is None else phase
            angle = np.asarray(start + 2 * np.pi * turns * t, kind)
            way = way + kind.type(curl) * (np.cos(angle) * side + np.sin(angle) * up)
        size = np.sqrt(np.einsum("ib,ib->b", way, way))
        # However much bend and curl lengthen the direction, all segments have the same length.
        np.multiply(way, step / np.where(size > 0, size, 1), out=out[j + 1])
        out[j + 1] += out[j]
    return out


def tangents(offsets: Array, ways: Array, /) -> Array:
    """Return tangents, of any length, at the points of fibres.

    They are those of the parabolas through three points; ``offsets`` are as of :func:`strands`, and
    ``ways`` (3, F), the directions in which the fibres would grow, are the tangents of fibres of
    length 0.
    """
    step = np.diff(offsets, axis=0)
    out = np.empty_like(offsets)
    out[0], out[-1] = step[0], step[-1]
    if len(step) > 1:
        # Segments are equal in length: twice the parabola's derivative at an end, as inside below.
        out[0] = 3 * step[0] - step[1]
        out[-1] = 3 * step[-1] - step[-2]
        out[1:-1] = step[1:] + step[:-1]
    return np.where(np.any(out, axis=1, keepdims=True), out, ways)


def _across(directions: Array) -> tuple[Array, Array]:
    """Return two unit directions perpendicular to each direction and to each other."""
    least = np.zeros_like(directions)
    # The axis that a direction has least of is farthest from parallel to it.
    np.put_along_axis(least, np.abs(directions).argmin(axis=0)[np.newaxis], 1, axis=0)
    side: Array = np.cross(directions, least, axis=0)
    size = np.sqrt(np.einsum("ib,ib->b", side, side))
    side /= np.where(size > 0, size, 1)
    return side, np.cross(directions, side, axis=0)
