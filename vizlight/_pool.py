"""Blocks of rows that threads share."""

from __future__ import annotations

import contextlib
import contextvars
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

from vizlight import _check
from vizlight._types import Slice

#: Size in bytes of a piece of memory that is freed before the first blocks run.
PIECE = (1 << 25) - (1 << 20)
_SETTING: contextvars.ContextVar[str] = contextvars.ContextVar("threads", default="")


@cache
def _keep_memory() -> None:
    """Make the C library of Linux keep memory that blocks free, rather than ask for it again.

    It does so for twice the size of the largest piece that a program has freed. Before that the
    system takes more processor time for a process's first blocks than their arithmetic.
    """
    np.empty(PIECE, np.uint8)


def blocks(count: int, size: int) -> list[Slice]:
    """Return slices of at most ``size`` rows that together cover ``count`` rows."""
    return [slice(i, min(i + size, count)) for i in range(0, count, size)]


def workers() -> int:
    """Return the number of threads that share the work.

    It is ``VIZLIGHT_THREADS``, or else the number of processors that this process may use.
    """
    setting = _SETTING.get() or os.environ.get("VIZLIGHT_THREADS", "")
    if setting:
        if not setting.isdecimal() or not int(setting):
            expected = "an integer of at least 1, or nothing (all processors)"
            raise _check.value_error("VIZLIGHT_THREADS", expected, repr(setting))
        return int(setting)
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # macOS and Windows lack this function
        return os.cpu_count() or 1


@contextlib.contextmanager
def threads(count: int) -> Iterator[None]:
    """Take a number of threads in place of VIZLIGHT_THREADS's while this context is entered."""
    token = _SETTING.set(str(count))
    try:
        yield
    finally:
        _SETTING.reset(token)


def run(work: Callable[[Slice], int], parts: list[Slice]) -> Iterator[int]:
    """Yield the result of ``work`` for each part, in the order of the parts."""
    _keep_memory()
    count = min(workers(), len(parts))
    if count <= 1:
        yield from map(work, parts)
        return
    # NumPy and compiled code let go of Python's lock, so that threads share the processors.
    with ThreadPoolExecutor(count) as pool:
        yield from pool.map(work, parts)
