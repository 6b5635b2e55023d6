"""Common edges of the triangles of a surface: one sort of them tells borders and pieces."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from vizlight import _pool
from vizlight._types import Bools, Indices, Raw, Slice
from vizlight.geometry.lines.simplices import EDGES, components
from vizlight.vtk.cells import firsts, mixed, places, triangles
from vizlight.vtk.memory import once

#: Largest number of parts of edges that are sorted.
PARTS = 16


class SurfaceTopology(NamedTuple):
    """Connected pieces of the points of a surface, and how its triangles are wound.

    Coincident points are in one piece; an ``open`` one has an edge of one triangle only. ``alike``:
    all edges have one triangle, or two that are wound alike; ``folded`` are ends of edges, by
    place, at which two triangles are wound against each other, and ``same`` is the first point at
    the place of each point, None if all places differ.
    """

    piece: Indices
    open: Bools
    alike: bool
    folded: list[Indices]
    same: Indices | None


class SortedEdges(NamedTuple):
    """Some edges of triangles, sorted by their ends; edges of several triangles stand together.

    ``keys`` have the lower end, then the upper end in the lower 32 bits, see :func:`ends_of`;
    ``places`` are the corners at which edges begin, among all corners, ``forward`` where this is
    the lower end.
    """

    keys: NDArray[np.int64]
    places: Indices
    forward: Bools

    def folded(self) -> Indices:
        """Return the ends of edges of two triangles that run along them the same way."""
        new = _new(self.keys)
        # Exactly two: three faces at an edge cannot all run against each other.
        pair = new[:-2] & ~new[1:-1] & new[2:]
        first = np.flatnonzero(pair & (self.forward[1:] == self.forward[:-1]))
        return np.concatenate(ends_of(self.keys[first]))


def sorted_edges(
    corners: Indices, count: int, same: Indices | None = None
) -> Iterator[SortedEdges]:
    """Yield the edges of triangles by ranges of their lower ends; edges of no length are left out.

    ``count`` is the number of points, below 2^31, and ``same`` the point that stands for each.
    """
    # Sorted in ranges of their lower ends: a sort of all edges at once would take memory beyond
    # the bound of a filter.
    parts = min(-(-3 * len(corners) // EDGES), PARTS)
    blocks = _pool.blocks(len(corners), BLOCK)
    ranges = []
    if parts > 1:
        for block in blocks:
            rows = corners[block] if same is None else same[corners[block]]
            ranges.append((int(rows.min()), int(rows.max())))
    for part in range(parts):
        low, high = part * count // parts, (part + 1) * count // parts
        # A block of triangles whose points all lie beside this range has no edge in it.
        near = [
            block
            for number, block in enumerate(blocks)
            if not ranges or (ranges[number][0] < high and ranges[number][1] >= low)
        ]
        if near:
            yield _sorted(corners, same, near, (low, high) if parts > 1 else None)


def _sorted(
    corners: Indices, same: Indices | None, blocks: list[Slice], ends: tuple[int, int] | None
) -> SortedEdges:
    """Return the edges of some triangles, with a range those with their lower end in it."""
    keys, places, forward = [], [], []
    for block in blocks:
        rows = corners[block] if same is None else same[corners[block]]
        a = rows.ravel()
        # An edge ends at the next corner of its triangle, the third one at the first corner.
        b = np.empty_like(a)
        b[:-1], b[2::3] = a[1:], a[::3]
        lower = np.minimum(a, b)
        kept = a != b
        if ends is not None:
            kept &= (lower >= ends[0]) & (lower < ends[1])
        place = np.arange(3 * block.start, 3 * block.stop)
        if not kept.all():
            a, b, lower, place = a[kept], b[kept], lower[kept], place[kept]
        # Both ends in one integer: a plain sort puts the faces of an edge side by side, whichever
        # way each of them runs along it.
        keys.append(lower.astype(np.int64) << 32 | np.maximum(a, b))
        places.append(place)
        forward.append(lower == a)
    key = np.concatenate(keys)
    # The pieces are freed before the sort takes memory of its own.
    keys.clear()
    # Keys of neighbouring faces are in order, which other sorts do not use.
    order = np.argsort(key, kind="stable")
    return SortedEdges(key[order], np.concatenate(places)[order], np.concatenate(forward)[order])


def topology(
    corners: Indices,
    points: Raw,
    inner: Bools | None = None,
    visit: Callable[[SortedEdges], object] = len,
    block: Indices | None = None,
) -> SurfaceTopology:
    """Return the pieces of a surface.

    With ``inner``, a mask of points, only an edge between two of these makes a border. ``visit`` is
    called with all edges, range by range. ``block`` is the number of the block of each point:
    points of two blocks are apart, wherever they are.
    """
    count = len(points)
    # Half the memory where that is enough: the ends of all edges are the largest array here.
    kind = np.int32 if max(count, len(corners)) < 2**31 else np.int64
    same = coincident(points, block)
    single: list[Indices] = []
    folded: list[Indices] = []
    # What is not filled takes no memory.
    ends: Indices = np.empty((2, 3 * len(corners)), dtype=kind)
    alike, edges, different = True, 0, 0
    for part in sorted_edges(corners, count):
        twice = part.keys[1:] == part.keys[:-1]
        edges += len(part.keys)
        # Two faces that run along an edge the same way are wound against each other, and of three
        # or more some must be.
        alike = alike and not (
            np.any(twice & (part.forward[1:] == part.forward[:-1]))
            or np.any(twice[1:] & twice[:-1])
        )
        visit(part)
        if not alike:
            folded.append(part.folded())
        if same is None:
            different += _record(part.keys, ends[:, different:], single, inner)
    # Where points stand twice, the faces on both sides of a seam are neighbours by place alone, so
    # that the edges are sorted again by the first point at each place.
    if same is not None:
        folded.clear()
        for part in sorted_edges(corners, count, same):
            folded.append(part.folded())
            different += _record(part.keys, ends[:, different:], single, inner)
    root = components(ends[0, :different], ends[1, :different], count, kind=kind)
    first_of_all = root == np.arange(count)
    if same is not None:
        # A place with several points is one thing to count, by the first of them.
        first_of_all &= same == np.arange(count)
        root = root[same]
    piece = (np.cumsum(first_of_all) - 1)[root]
    borders = np.zeros(int(np.count_nonzero(first_of_all)), dtype=np.bool_)
    for points_of_part in single:
        borders[piece[points_of_part]] = True
    # A triangle that names a point twice has an edge of no length, and no winding to compare.
    alike = alike and edges == 3 * len(corners)
    return SurfaceTopology(piece, borders, alike, folded, same)


def ends_of(keys: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the lower and the upper end of edges by their keys."""
    return keys >> 32, keys & 0xFFFFFFFF


def _new(keys: Indices) -> Bools:
    """Return whether each of some numbers differs from the one before, and true for the end."""
    new = np.ones(len(keys) + 1, dtype=np.bool_)
    np.not_equal(keys[1:], keys[:-1], out=new[1:-1])
    return new


def _record(
    keys: NDArray[np.int64], ends: Indices, single: list[Indices], inner: Bools | None
) -> int:
    """Write the ends of sorted edges, append those that occur once, return their number."""
    new = _new(keys)
    first = keys[new[:-1]]
    into = ends[:, : len(first)]
    into[0], into[1] = ends_of(first)
    # At a cut the faces beyond are missing: an edge there has one face and yet is no border.
    alone = into[:, new[1:][new[:-1]]]
    single.append(alone[0, inner[alone].all(axis=0)] if inner is not None else alone[0].copy())
    return len(first)


def double_cover(a: Indices, b: Indices, count: int) -> tuple[Indices, Indices]:
    """Return the first thing that pairs connect each with, as it is and turned over.

    Each thing stands twice, the second time turned over, with its number beyond all others. One
    that is connected with its own turned copy has no sides. ``a`` and ``b`` are pairs of things
    that agree, and of one and the turned copy of another.
    """
    # If one agrees with another as it is, so do their turned copies.
    a, b = np.append(a, a + count), np.append(b, (b + count) % (2 * count))
    root = components(np.minimum(a, b), np.maximum(a, b), 2 * count)
    return root[:count], root[count:]


def coincident(points: Raw, block: Indices | None = None) -> Indices | None:
    """Return the first point at the place of each point, None if all places differ.

    Points that are not finite differ from all others, and so do those of another block.
    """
    number = place_numbers(points)
    if block is not None:
        number = mixed(number + mixed(block.astype(np.uint64)))
    same = firsts(number)
    if same is None:
        return None
    again = np.flatnonzero(same != np.arange(len(points)))
    # Two places may have one number by chance, and NaN differs from itself: coordinates decide.
    apart = np.any(points[again] != points[same[again]], axis=1)
    if block is not None:
        apart |= block[again] != block[same[again]]
    same[again[apart]] = again[apart]
    return None if apart.all() else same


def are_closed(surface: vtkPolyData, block: Indices | None = None) -> tuple[Bools, Bools]:
    """Return whether all edges have an even number of faces, and whether these are wound alike.

    Places make an edge. The numbers of the edges, made from the coordinates of their ends, cancel
    by pairs, and with a sign where the two faces are wound alike. Masks are of blocks; without
    ``block`` all points are in one, and the result is kept.
    """
    if block is None:
        every = np.zeros(surface.GetNumberOfPoints(), dtype=np.intp)
        return once(surface, "closed", lambda: are_closed(surface, every))
    count = int(block.max(initial=0)) + 1
    rows, number = triangles(surface), place_numbers(places(surface))
    # Without a sort, which would hold several numbers for each edge at once.
    odd, sums = np.zeros((2, count), dtype=np.uint64)
    for part in _pool.blocks(len(rows), BLOCK):
        a, b = number[rows[part]].ravel(), number[rows[part][:, [1, 2, 0]]].ravel()
        edges = edge_numbers(a, b)
        # The negative number in two's complement, as these integers have no sign.
        signed = np.where(a < b, edges, ~edges + np.uint64(1))
        start, place = runs(block[rows[part, 0]])
        np.bitwise_xor.at(odd, place, np.bitwise_xor.reduceat(edges, 3 * start))
        np.add.at(sums, place, np.add.reduceat(signed, 3 * start))
    return odd == 0, sums == 0


def runs(numbers: Indices) -> tuple[Indices, Indices]:
    """Return where each run of equal numbers begins, and its number."""
    start = np.flatnonzero(_new(numbers)[:-1])
    return start, numbers[start]


#: Number of points or triangles that are worked on at once.
BLOCK = 1 << 16
#: Odd numbers of 64 bits.
_FACTORS = tuple(np.uint64(x) for x in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))


def place_numbers(points: Raw) -> NDArray[np.uint64]:
    """Return numbers of 64 bits made of the coordinates of points."""
    number = np.zeros(len(points), dtype=np.uint64)
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(points), BLOCK):
            # The sum with 0 makes one of the two zeros.
            where = np.ascontiguousarray(points[block].astype(np.float64) + 0.0)
            for axis, factor in zip(where.view(np.uint64).T, _FACTORS, strict=True):
                # A product with an odd number is one-to-one in 64 bits, so that it brings no two
                # coordinates together before the bits are mixed.
                number[block] = mixed(number[block] ^ (axis * factor))
    return number


def edge_numbers(a: NDArray[np.uint64], b: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers of edges, made of the numbers of their ends; 0 for edges of no length."""
    with np.errstate(all="ignore"):
        # Sum and exclusive or are the same in both directions of an edge.
        return np.where(a == b, np.uint64(0), mixed((a + b) ^ mixed(a ^ b)))


def single_edges(lines: list[NDArray[np.uint64]]) -> tuple[NDArray[np.uint64], ...]:
    """Return the edges along lines with no other of them at their place, and all places."""
    none = np.empty(0, dtype=np.uint64)
    edges = np.concatenate([none, *(edge_numbers(line[:-1], line[1:]) for line in lines)])
    numbers, times = np.unique(edges, return_counts=True)
    # An edge that stands twice is a seam where the sheet closes, as along a cylinder; number 0 is
    # an edge of no length, as at a pole.
    return numbers[(times == 1) & (numbers != 0)], np.unique(np.concatenate([none, *lines]))


def inner_edges(points: Raw, triangles: Indices, ends: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return the edges between some places that have two faces."""
    number, size = place_numbers(points), len(points)
    near = np.isin(number, ends)
    # Only a triangle with two corners among the places can have an edge between them.
    rows = triangles[np.count_nonzero(near[triangles], axis=1) > 1]
    a, b = rows.ravel(), rows[:, [1, 2, 0]].ravel()
    keys = np.minimum(a, b).astype(np.int64) * size + np.maximum(a, b)
    keys, times = np.unique(keys, return_counts=True)
    lower, upper = np.divmod(keys[times > 1], max(size, 1))
    return edge_numbers(number[lower], number[upper])
