"""Tangents of polylines, computed for all lines at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Indices, Slice
from vizlight.model import kernels

__all__ = ["polyline_tangents"]

#: Number of vertices whose tangents are computed at once.
BLOCK = 1 << 17


def polyline_tangents(
    points: ArrayLike, /, *, connectivity: ArrayLike | None = None, offsets: ArrayLike | None = None
) -> Array:
    """Return the unit tangent at every point of polylines.

    Parameters
    ----------
    points : array_like, shape (N, n)
        Positions, in any unit.
    connectivity : array_like of int, shape (M,), optional
        Indices of the points of each line, one line after the other. Default: all points in order.
    offsets : array_like of int, shape (L + 1,), optional
        Start of each line in the connectivity, followed by its length. Default: a single line.

    Returns
    -------
    ndarray, shape (N, n)
        Unit tangents in the direction of the line, of the type of the points. They are zero at
        points without a tangent: points of no line, of a line of coincident points, next to a point
        that is not finite, or where a line turns back by a segment as long as the one before. A
        point that lines pass several times has the tangent of the last pass.

    Raises
    ------
    TypeError
        If the points are not real numbers, or an index is not an integer.
    ValueError
        If a shape is wrong, or an index or offset is out of range.

    Notes
    -----
    The tangent is the derivative of the parabola through a point and its two neighbours by the
    length along the segments. With segments of lengths h0, h1 and directions u0, u1 it is
    ``(h1 u0 + h0 u1) / (h0 + h1)`` inside a line and ``u0 + (u0 - u1) h0 / (h0 + h1)`` at an end.
    On a smooth curve its error decreases with the square of the spacing, also at ends and for
    unequal spacing. A line of three segments or more that ends where it starts is closed and has
    neighbours across the seam. Points that repeat the one before them count as one with it and
    share its tangent. Differences are taken in float64. The error for a line of two points
    is at most 1 eps of the points' type plus 1 of float64; for other lines it is at most 1 and 4,
    divided by the length of the tangent before it is normalised.
    """
    positions = _check.vectors("points", points)
    if positions.ndim != 2:
        raise _check.value_error("points", "shape (N, n)", positions)
    count = len(positions)
    ids = np.arange(count)
    if connectivity is not None:
        ids = _check.indices("connectivity", connectivity, count)
    starts = np.array([0, len(ids)])
    if offsets is not None:
        starts = _check.indices("offsets", offsets, len(ids) + 1)
    if len(starts) == 0 or starts[0] != 0 or starts[-1] != len(ids) or np.any(np.diff(starts) < 0):
        raise _check.value_error("offsets", f"rising indices from 0 to {len(ids)}", starts)
    lines = _Lines(positions, ids, starts)
    tangents = np.zeros_like(positions)
    with np.errstate(all="ignore"):
        for first in range(0, len(lines.vertices), BLOCK):
            block = slice(first, min(first + BLOCK, len(lines.vertices)))
            block_tangents = lines.tangents(block)
            # A point that is not finite spoils the tangents of its neighbours; none is better than
            # NaN.
            block_tangents[~np.all(np.isfinite(block_tangents), axis=1)] = 0
            rows, vertex = lines.rows(block)
            # Repeated points share their vertex's tangent; where lines meet, the last one written
            # stays.
            tangents[ids[rows]] = block_tangents[vertex]
    return tangents


class _Lines:
    """Lines by their vertices: the points in a line that do not repeat the previous one.

    Memory beyond a number for each vertex does not grow with the lines.
    """

    def __init__(self, positions: Array, ids: Indices, starts: Indices) -> None:
        self.positions, self.ids, self.starts = positions, ids, starts
        fresh = np.empty(len(ids), dtype=np.bool_)
        for i in range(0, len(ids), BLOCK):
            # One point before the block, with which its first one is compared.
            place = positions[ids[max(i - 1, 0) : i + BLOCK]]
            fresh[max(i, 1) : i + BLOCK] = np.any(place[1:] != place[:-1], axis=1)
        filled = starts[:-1] < starts[1:]
        # Also where a line begins in the place in which the line before it ends.
        fresh[starts[:-1][filled]] = True
        #: Place of each vertex in ids.
        self.vertices = np.flatnonzero(fresh)
        first = np.searchsorted(self.vertices, starts[:-1][filled])
        last = np.append(first, len(self.vertices))[1:] - 1
        same = np.all(self.place(first) == self.place(last), axis=1)
        # A line that goes there and back ends where it starts, too, but goes around nothing.
        closed = same & (last - first > 2)
        #: First and last vertex of each closed line, in ascending order.
        self.closed = first[closed], last[closed]

    def place(self, vertices: Indices | Slice) -> Array:
        """Return the positions of vertices in float64."""
        return self.positions[self.ids[self.vertices[vertices]]].astype(np.float64, copy=False)

    def tangents(self, block: Slice) -> Array:
        """Return the tangents at a block of vertices."""
        # Two more vertices on each side decide on the tangents of the block.
        wide = slice(max(block.start - 2, 0), min(block.stop + 2, len(self.vertices)))
        line = np.searchsorted(self.starts, self.vertices[wide], side="right")
        inside = slice(block.start - wide.start, block.stop - wide.start)
        tangents = _vertex_tangents(self.place(wide), line)[inside]
        # The neighbour across the seam is at the line's other end, which may be far from this
        # block.
        for end in self.closed:
            low, high = np.searchsorted(end, (block.start, block.stop))
            tangents[end[low:high] - block.start] = self._seams(slice(low, high))
        return tangents

    def _seams(self, lines: Slice) -> Array:
        """Return the tangents where closed lines begin and end."""
        first, last = (end[lines] for end in self.closed)
        # Before the seam, on it and after it, as a line of its own whose middle vertex is wanted.
        corners = np.stack([last - 1, first, first + 1], axis=1).ravel()
        return _vertex_tangents(self.place(corners), np.repeat(first, 3))[1::3]

    def rows(self, block: Slice) -> tuple[Slice, Indices]:
        """Return the places in ids of a block of vertices, and the vertex in the block of each."""
        # A vertex stands for all points up to the next vertex, since these repeat it.
        ends = np.append(self.vertices[block], len(self.ids))
        if block.stop < len(self.vertices):
            ends[-1] = self.vertices[block.stop]
        return slice(ends[0], ends[-1]), np.repeat(np.arange(len(ends) - 1), np.diff(ends))


def _vertex_tangents(place: Array, line: Indices) -> Array:
    """Return the tangents at vertices of open lines without repeated points."""
    count = len(place)
    tangent = np.zeros_like(place)
    if count < 2:
        return tangent
    step = place[1:] - place[:-1]
    inside = line[1:] == line[:-1]
    # The kernel takes columns, and rescales steps whose squares would leave float64.
    direction, size = kernels.unit(np.ascontiguousarray(step.T))
    unit = direction.T

    # Segment i runs from vertex i to i + 1; -1 means that a vertex has no segment on that side.
    after, before = np.full(count, -1), np.full(count, -1)
    after[:-1][inside] = np.flatnonzero(inside)
    before[1:][inside] = np.flatnonzero(inside)
    first = np.flatnonzero((before < 0) & (after >= 0))
    last = np.flatnonzero((after < 0) & (before >= 0))

    both = np.flatnonzero((before >= 0) & (after >= 0))
    # The parabola weighs a direction by the other segment's length: the shorter one is nearer.
    part = _share(size[before[both]], size[after[both]])
    tangent[both] = (1 - part) * unit[before[both]] + part * unit[after[both]]
    _ends(tangent, unit, size, first, last)
    length = np.linalg.norm(tangent, axis=1, keepdims=True)
    return tangent / np.where(length > 0, length, 1)


def _share(h0: Array, h1: Array) -> Array:
    """Return h0 / (h0 + h1) as a column, also where the sum would overflow."""
    larger = np.maximum(h0, h1)
    share: Array = (h0 / larger) / (h0 / larger + h1 / larger)
    return share[:, np.newaxis]


def _ends(tangent: Array, unit: Array, size: Array, first: Indices, last: Indices) -> None:
    """Fill in the tangents at the ends of open lines; a single segment gives its direction."""
    # A line of one segment has no second one by which its curvature could be told.
    long = last - first > 1
    for end, near, far in ((first, first, first + 1), (last, last - 1, last - 2)):
        tangent[end] = unit[near]
        near, far = near[long], far[long]
        # Beyond the near segment the parabola turns on by this part of the turn between the two.
        part = _share(size[near], size[far])
        tangent[end[long]] += (unit[near] - unit[far]) * part
