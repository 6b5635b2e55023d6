"""Measurement of time and memory."""

from __future__ import annotations

import contextlib
import contextvars
import time
import tracemalloc
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

Key = TypeVar("Key")

#: Spread of repeats beyond which times do not support a verdict.
MOST_SPREAD = 0.15
_SPREADS: contextvars.ContextVar[list[float] | None] = contextvars.ContextVar(
    "spreads", default=None
)


def take_turns(ways: Mapping[Key, Callable[[], object]], repeats: int) -> dict[Key, float]:
    """Return the shortest processor time in seconds of each function, of all its threads together.

    The functions are called in turn, so a busy machine slows all of them. The minimum of three
    or more repeats excludes the extra cost of a first call. Three or more repeats are up to doubled
    until the two shortest times of each function agree.
    """
    times: dict[Key, list[float]] = {way: [] for way in ways}
    for turn in range(2 * repeats if repeats > 2 else repeats):
        if turn >= repeats and all(spread(each) <= MOST_SPREAD for each in times.values()):
            break
        for way, work in ways.items():
            start = time.process_time()
            work()
            times[way].append(time.process_time() - start)
    for each in times.values():
        note_spread(each)
    return {way: min(each) for way, each in times.items()}


def note_spread(times: list[float]) -> None:
    """Add the spread of three or more repeats to the list of :func:`noted_spreads`."""
    noted = _SPREADS.get()
    if noted is not None and len(times) > 2:
        noted.append(spread(times))


def spread(times: list[float]) -> float:
    """Return by how much the second shortest of repeats exceeds the shortest, as a share of it."""
    shortest, second = sorted(times)[:2]
    return second / shortest - 1 if shortest > 0 else 0.0


@contextlib.contextmanager
def noted_spreads() -> Iterator[list[float]]:
    """Yield a list to which :func:`take_turns` and :func:`note_spread` add spreads."""
    spreads: list[float] = []
    token = _SPREADS.set(spreads)
    try:
        yield spreads
    finally:
        _SPREADS.reset(token)


def peak_memory(work: Callable[[], object]) -> int:
    """Return the peak of the bytes that Python and NumPy allocate during a call."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
