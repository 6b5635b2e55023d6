"""Workers on the pieces: a ``map`` that repeats failed calls, and processes of one's own."""

from __future__ import annotations

import contextlib
import functools
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

from vizlight import _check, _progress, _supervise
from vizlight._types import Foreign
from vizlight.pieces.sources import PieceError

#: ``map``, the ``map`` of an executor, an executor, or a client of Dask.
Map = Foreign

T = TypeVar("T")

#: Number of times that a piece is tried again after an error of the operating system.
RETRIES = 2
#: Number of processes that may end one after the other before the call that they did fails.
LOST = 3


class RetryingMap:
    """A map of functions over pieces that repeats calls after errors of the system.

    ``map`` is a function, or an object with such a method; its results may be futures. A call is
    repeated at most ``retries`` times.
    """

    def __init__(self, map: Map, retries: int, show: bool) -> None:
        if not (callable(map) or callable(getattr(map, "map", None))):
            raise _check.type_error("map", "map, an executor or a client of Dask", map)
        self.map, self.show = map, show
        self.retries = _check.integer("retries", retries, low=0)

    def each(
        self, function: Callable[..., T], calls: Sequence[tuple[Foreign, ...]], what: str
    ) -> list[T]:
        """Return the results of calls in their order; the error of a worker names its piece."""
        values: list[T] = []
        results: Iterator[Foreign] = iter(())
        start: Foreign = getattr(self.map, "map", self.map)
        # Dask takes calls of the same arguments for one.
        more = {"pure": False} if hasattr(self.map, "gather") else {}
        with _progress.progress(what, len(calls), show=self.show) as report:
            try:
                for number, arguments in enumerate(calls):
                    with _naming(arguments[0].name):
                        # A map may fail as soon as it is called, and then the first piece is named.
                        if not number:
                            call = functools.partial(repeated, function, self.retries)
                            results = iter(start(call, calls, **more))
                        value = next(results)
                        # Dask returns futures, and the map of an executor results.
                        values.append(value.result() if hasattr(value, "result") else value)
                    report(len(values))
            finally:
                if hasattr(self.map, "cancel"):
                    with contextlib.suppress(Exception):  # a cluster that is gone cancels nothing
                        self.map.cancel([*results], force=True)
        return values


def repeated(function: Callable[..., T], retries: int, arguments: tuple[Foreign, ...]) -> T:
    """Call a function, and some more times after errors of the operating system."""
    for _ in range(retries):
        try:
            return function(*arguments)
        except PieceError as error:
            cause: BaseException | None = error
            # The error of a piece may be caused by one of the system, which may pass.
            while cause is not None and not isinstance(cause, OSError):
                cause = cause.__cause__
            if cause is None:
                raise
    return function(*arguments)


@contextlib.contextmanager
def _naming(name: str) -> Iterator[None]:
    """Turn the errors of workers into one that names the piece."""
    try:
        yield
    except (ValueError, TypeError):
        # These name their piece or their argument already.
        raise
    except Exception as error:
        text = f"{type(error).__name__}: {error}"
        if isinstance(error, BrokenProcessPool) or type(error).__name__ == "KilledWorker":
            text = "workers ended while they did it, perhaps for lack of memory; cut it smaller"
        elif isinstance(error, CancelledError | OSError):
            text = f"its workers went away before it was done ({text})"
        raise PieceError(f"piece {name}: {text}") from error


class Processes:
    """A ``map`` that runs its calls in processes on this machine.

    Parameters
    ----------
    count : int
        Number of processes. They start with the first call and end with this object.

    Raises
    ------
    TypeError, ValueError
        If the count is not an integer above 0.

    Notes
    -----
    The processes are spawned and talk by pipes; none of them listens on a socket. The calls of a
    process that ends before they are done are made again by another, three times at most. A script
    need not be guarded by ``if __name__ == "__main__"``.

    Examples
    --------
    >>> import vizlight
    >>> list(vizlight.pieces.Processes(1)(abs, [-1, 2]))
    [1, 2]
    """

    def __init__(self, count: int) -> None:
        self._pool: ProcessPoolExecutor | None = None
        self.count = _check.integer("count", count, low=1)

    def __call__(self, function: Callable[[Foreign], T], calls: Iterable[Foreign]) -> Iterator[T]:
        """Yield the results of calls in their order. The function can be pickled."""
        left, lost = list(calls), 0
        while left:
            try:
                if self._pool is None:
                    # Spawned, because a fork has no threads but copies the locks that they hold.
                    spawn = multiprocessing.get_context("spawn")
                    self._pool = ProcessPoolExecutor(self.count, spawn, _begin, (os.getpid(),))
                with _main_apart():
                    results = self._pool.map(function, left)
                for value in results:
                    # Finished calls are not repeated when a process ends.
                    left.pop(0)
                    lost = 0
                    yield value
            except BrokenProcessPool:
                self._end()
                lost += 1
                if lost == LOST:
                    raise

    def _end(self) -> None:
        """End the processes, and wait for that.

        A process of Python that ends while the thread of an executor closes its pipes, as that
        thread does once its executor is gone, may write to a pipe that is closed.
        """
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown()

    __del__ = _end


def _begin(parent: int) -> None:
    """Leave Ctrl-C to the parent, and end with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux":
        _supervise.end_with(parent)


@contextlib.contextmanager
def _main_apart() -> Iterator[None]:
    """Keep a script from being run again by each process that it starts.

    Processes are spawned, and each would import the script, which need not be guarded by
    ``if __name__ == "__main__"``: the functions that they call are in this package.
    """
    main = sys.modules["__main__"]
    path = getattr(main, "__file__", None)
    if path is None or getattr(main, "__spec__", None) is not None:
        yield
        return
    # Without a file a spawned process finds no script to import.
    del main.__file__
    try:
        yield
    finally:
        main.__file__ = path
