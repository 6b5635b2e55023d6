"""Compiled code that puts rays in order: by integer keys, and by their levels."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vizlight import _compiled

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

#: Smallest range of values that is divided into buckets.
LEAST = 1e-300


@_compiled.kernel()
def group(key: Indices, ends: Indices, order: Indices) -> None:
    """Write the order of rays by their integer keys, the first ray of each key, and the end."""
    for k in range(len(ends)):
        ends[k] = 0
    for k in range(len(key)):
        ends[key[k]] += 1
    total = 0
    for k in range(len(ends)):
        total += ends[k]
        ends[k] = total
    for k in range(len(key) - 1, -1, -1):
        ends[key[k]] -= 1
        order[ends[key[k]]] = k


@_compiled.kernel()
def sort(values: Array, key: Array, order: Indices, ends: Indices) -> float:
    """Write values in rising order, their old indices, and the first index of each bucket.

    There are as many buckets of equal width as values; return their number per unit of the values.
    Inside the buckets values are sorted by gaps that are less than the fullest of them.
    """
    count = len(values)
    low, high = math.inf, -math.inf
    for k in range(count):
        low, high = min(low, values[k]), max(high, values[k])
    rate = (count - 1) / (high - low) if high - low > LEAST else 0.0
    for bucket in range(count + 1):
        ends[bucket] = 0
    for k in range(count):
        ends[int((values[k] - low) * rate)] += 1
    total, fullest = 0, 0
    for bucket in range(count + 1):
        fullest = max(fullest, ends[bucket])
        total += ends[bucket]
        ends[bucket] = total
    for k in range(count - 1, -1, -1):
        bucket = int((values[k] - low) * rate)
        ends[bucket] -= 1
        order[ends[bucket]], key[ends[bucket]] = k, values[k]
    gap = 1
    while 3 * gap + 1 < fullest:
        gap = 3 * gap + 1
    while gap > 0:
        for k in range(gap, count):
            i, value, j = order[k], key[k], k
            while j >= gap and key[j - gap] > value:
                order[j], key[j] = order[j - gap], key[j - gap]
                j -= gap
            order[j], key[j] = i, value
        gap //= 3
    return rate


@_compiled.kernel(inline=True)
def below(key: Array, ends: Indices, rate: float, value: float) -> int:
    """Return how many of the values that :func:`sort` has written are less than another one."""
    count = len(key)
    if value <= key[0]:
        return 0
    if value > key[count - 1]:
        return count
    bucket = int((value - key[0]) * rate)
    low, high = int(ends[bucket]), int(ends[bucket + 1])
    while low < high:
        middle = (low + high) >> 1
        if key[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low
