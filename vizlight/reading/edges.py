"""Edges of surfaces by the places of their ends, told apart by numbers of 64 bits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _pool
from vizlight.reading.cells import mixed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight._types import Indices

#: Number of points or triangles that are worked on at once.
BLOCK = 1 << 16
#: Odd numbers of 64 bits.
_FACTORS = tuple(np.uint64(x) for x in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))


def place_numbers(points: NDArray[np.generic]) -> NDArray[np.uint64]:
    """Return numbers of 64 bits made of the coordinates of points."""
    number = np.zeros(len(points), dtype=np.uint64)
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(points), BLOCK):
            # The sum with 0 makes one of the two zeros.
            where = np.ascontiguousarray(points[block].astype(np.float64) + 0.0)
            for axis, factor in zip(where.view(np.uint64).T, _FACTORS, strict=True):
                number[block] = mixed(number[block] ^ (axis * factor))
    return number


def edge_numbers(a: NDArray[np.uint64], b: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers of edges, made of the numbers of their ends; 0 for edges of no length."""
    with np.errstate(all="ignore"):
        return np.where(a == b, np.uint64(0), mixed((a + b) ^ mixed(a ^ b)))


def single_edges(lines: list[NDArray[np.uint64]]) -> tuple[NDArray[np.uint64], ...]:
    """Return the edges along lines at whose place there is no other of them, and all places."""
    none = np.empty(0, dtype=np.uint64)
    edges = np.concatenate([none, *(edge_numbers(line[:-1], line[1:]) for line in lines)])
    numbers, times = np.unique(edges, return_counts=True)
    return numbers[(times == 1) & (numbers != 0)], np.unique(np.concatenate([none, *lines]))


def inner_edges(
    points: NDArray[np.generic], triangles: Indices, ends: NDArray[np.uint64]
) -> NDArray[np.uint64]:
    """Return the edges between some places that have two faces."""
    number, size = place_numbers(points), len(points)
    near = np.isin(number, ends)
    rows = triangles[np.count_nonzero(near[triangles], axis=1) > 1]
    a, b = rows.ravel(), rows[:, [1, 2, 0]].ravel()
    keys = np.minimum(a, b).astype(np.int64) * size + np.maximum(a, b)
    keys, times = np.unique(keys, return_counts=True)
    lower, upper = np.divmod(keys[times > 1], max(size, 1))
    return edge_numbers(number[lower], number[upper])
