"""What studies share: taking turns and counting memory."""

from __future__ import annotations

import math
import time
import tracemalloc
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Way = TypeVar("Way")


def take_turns(ways: Mapping[Way, Callable[[], Any]], repeats: int) -> dict[Way, float]:
    """Return the best seconds of each way; they take turns, so a busy machine slows all.

    The best of three or more leaves out what a first time costs more.
    """
    best = dict.fromkeys(ways, math.inf)
    for _ in range(repeats):
        for way, work in ways.items():
            start = time.perf_counter()
            work()
            best[way] = min(best[way], time.perf_counter() - start)
    return best


def peak_memory(work: Callable[[], Any]) -> int:
    """Return the bytes that Python and NumPy hold at the peak of work, beyond those before."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
