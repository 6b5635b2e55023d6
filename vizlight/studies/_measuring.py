"""Measurement of time and memory."""

from __future__ import annotations

import math
import time
import tracemalloc
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Key = TypeVar("Key")


def take_turns(ways: Mapping[Key, Callable[[], object]], repeats: int) -> dict[Key, float]:
    """Return the shortest time in seconds of each function.

    The functions are called in turn, so a busy machine slows all of them. The minimum of three
    or more repeats excludes the extra cost of a first call.
    """
    best = dict.fromkeys(ways, math.inf)
    for _ in range(repeats):
        for way, work in ways.items():
            start = time.perf_counter()
            work()
            best[way] = min(best[way], time.perf_counter() - start)
    return best


def peak_memory(work: Callable[[], object]) -> int:
    """Return the peak of the bytes that Python and NumPy allocate during a call."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
