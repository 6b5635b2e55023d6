"""Tangents of polylines, computed for all lines at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.model import kernels

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices

__all__ = ["polyline_tangents"]


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
        points without a tangent: points of no line, of a line whose points all coincide, next to a
        point that is not finite, or where a line reverses its direction. A point of several lines
        has the tangent of the last of them.

    Raises
    ------
    TypeError
        If the points are not real numbers, or an index is not an integer.
    ValueError
        If a shape is wrong, or an index or offset is out of range.

    Notes
    -----
    The tangent is the derivative by arc length of the parabola through a point and its two
    neighbours. With segments of lengths h0, h1 and directions u0, u1 it is
    ``(h1 u0 + h0 u1) / (h0 + h1)`` inside a line and ``u0 + (u0 - u1) h0 / (h0 + h1)`` at an end.
    Its error decreases with the square of the spacing, also at ends and for unequal spacing. A line
    that ends where it starts is closed and has neighbours across the seam. Repeated points count as
    one and share one tangent. Differences are taken in float64. The error for a line of two points
    is at most 1 eps of the points' type plus 1 of float64; for other lines it is at most 1 and 4,
    divided by the length of the tangent before it is normalised.
    """
    positions = _check.vectors("points", points)
    if positions.ndim != 2:
        raise ValueError(_check.message("points", "shape (N, n)", positions))
    count = len(positions)
    ids = np.arange(count)
    if connectivity is not None:
        ids = _check.indices("connectivity", connectivity, count)
    starts = np.array([0, len(ids)])
    if offsets is not None:
        starts = _check.indices("offsets", offsets, len(ids) + 1)
    if len(starts) == 0 or starts[0] != 0 or starts[-1] != len(ids) or np.any(np.diff(starts) < 0):
        raise ValueError(_check.message("offsets", f"rising indices from 0 to {len(ids)}", starts))
    tangents = np.zeros_like(positions)
    line = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    place = positions[ids].astype(np.float64, copy=False)
    # A point is a new vertex of its line unless it repeats the previous point.
    fresh = np.ones(len(ids), dtype=np.bool_)
    fresh[1:] = (line[1:] != line[:-1]) | np.any(place[1:] != place[:-1], axis=1)
    vertex = np.cumsum(fresh) - 1
    with np.errstate(all="ignore"):
        found = _vertex_tangents(place[fresh], line[fresh])
    found[~np.all(np.isfinite(found), axis=1)] = 0
    tangents[ids] = found[vertex]
    return tangents


def _vertex_tangents(place: Array, line: Indices) -> Array:
    """Return the tangents at vertices of lines without repeated points."""
    count = len(place)
    tangent = np.zeros_like(place)
    if count < 2:
        return tangent
    step = place[1:] - place[:-1]
    inside = line[1:] == line[:-1]
    direction, size = kernels.unit(np.ascontiguousarray(step.T))
    unit = direction.T

    # Segment i runs from vertex i to i + 1; -1 means that a vertex has no segment on that side.
    after, before = np.full(count, -1), np.full(count, -1)
    after[:-1][inside] = np.flatnonzero(inside)
    before[1:][inside] = np.flatnonzero(inside)
    first = np.flatnonzero((before < 0) & (after >= 0))
    last = np.flatnonzero((after < 0) & (before >= 0))
    closed = np.all(place[first] == place[last], axis=1) & (last - first > 2)
    before[first[closed]] = before[last[closed]]
    after[last[closed]] = after[first[closed]]

    both = np.flatnonzero((before >= 0) & (after >= 0))
    part = _share(size[before[both]], size[after[both]])
    tangent[both] = (1 - part) * unit[before[both]] + part * unit[after[both]]
    _ends(tangent, unit, size, first[~closed], last[~closed])
    length = np.linalg.norm(tangent, axis=1, keepdims=True)
    return tangent / np.where(length > 0, length, 1)


def _share(h0: Array, h1: Array) -> Array:
    """Return h0 / (h0 + h1) as a column, also where the sum would overflow."""
    larger = np.maximum(h0, h1)
    share: Array = (h0 / larger) / (h0 / larger + h1 / larger)
    return share[:, np.newaxis]


def _ends(tangent: Array, unit: Array, size: Array, first: Indices, last: Indices) -> None:
    """Fill in the tangents at the ends of open lines; a single segment gives its direction."""
    long = last - first > 1
    for end, near, far in ((first, first, first + 1), (last, last - 1, last - 2)):
        tangent[end] = unit[near]
        near, far = near[long], far[long]
        part = _share(size[near], size[far])
        tangent[end[long]] += (unit[near] - unit[far]) * part
