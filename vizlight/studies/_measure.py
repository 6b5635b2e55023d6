"""What studies share: taking turns and counting memory."""

from __future__ import annotations

import statistics
import time
import tracemalloc
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Way = TypeVar("Way")


def take_turns(ways: Mapping[Way, Callable[[], Any]], repeats: int) -> dict[Way, float]:
    """Return the median seconds of each way; they take turns, so a busy machine slows all."""
    taken: dict[Way, list[float]] = {way: [] for way in ways}
    for _ in range(repeats):
        for way, work in ways.items():
            start = time.perf_counter()
            work()
            taken[way].append(time.perf_counter() - start)
    return {way: statistics.median(seconds) for way, seconds in taken.items()}


def peak_memory(work: Callable[[], Any]) -> int:
    """Return the bytes that Python and NumPy hold at the peak of work, beyond those before."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
