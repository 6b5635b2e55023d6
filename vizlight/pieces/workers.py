"""What works on the pieces: this process, local processes, or a cluster of Dask."""

from __future__ import annotations

import contextlib
import importlib.util
import sys
from collections import deque
from concurrent.futures import CancelledError
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from vizlight import _check, _pool, _progress
from vizlight.pieces.kinds import PieceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

T = TypeVar("T")

#: Number of workers that a piece may end before it counts as the cause.
LOST = 3


@dataclass(frozen=True)
class Workers:
    """What calls functions, each with a piece first: a cluster, or this process without one.

    Attributes
    ----------
    client : distributed.Client or None
        Client of the cluster.
    retries : int
        Number of times that a call is repeated after an error of the operating system.
    """

    client: Any
    retries: int

    @property
    def number(self) -> int:
        """Number of calls that run at a time."""
        return 1 if self.client is None else max(sum(self.client.nthreads().values()), 1)

    def run(
        self, function: Callable[..., T], calls: Iterable[tuple[Any, ...]], ahead: int | None = None
    ) -> Iterator[T]:
        """Yield the results of calls in their order; an error names the piece.

        Calls are taken from the iterable no more than ``ahead`` before the first whose result
        has not been taken; None: all at once.
        """
        if self.client is None:
            for arguments in calls:
                yield tried(function, self.retries, *arguments)
            return
        waiting: deque[tuple[str, Any]] = deque()
        try:
            for arguments in calls:
                name = arguments[0].name
                with _naming(name):
                    future = self.client.submit(
                        tried, function, self.retries, *arguments, pure=False
                    )
                waiting.append((name, future))
                if len(waiting) == ahead:
                    yield _next(waiting)
            while waiting:
                yield _next(waiting)
        finally:
            if waiting:
                with contextlib.suppress(Exception):  # a cluster that is gone cancels nothing
                    self.client.cancel([future for _, future in waiting], force=True)


@contextlib.contextmanager
def workers_of(client: Any, workers: int | None, retries: int, count: int) -> Iterator[Workers]:
    """Yield what works on at most so many pieces at a time: a cluster or processes of its own."""
    if workers is not None and client is not None:
        raise ValueError(_check.message("workers", "client= or workers=", "both"))
    if client is None:
        number = (
            _pool.workers(None) if workers is None else _check.integer("workers", workers, low=1)
        )
        number = min(number, count)
        if number == 1 or (workers is None and not _has_dask()):
            yield Workers(None, retries)
            return
    if not _has_dask():
        what = "workers" if client is None else "client"
        raise ImportError(f"{what}= needs Dask: run pip install 'vizlight[scale]'")
    import distributed

    with contextlib.ExitStack() as stack:
        if client is None:
            stack.enter_context(_main_apart())
            client = stack.enter_context(
                distributed.Client(stack.enter_context(local_cluster(number)))
            )
        elif isinstance(client, str):
            try:
                client = stack.enter_context(distributed.Client(client, timeout=10))
            except (OSError, TimeoutError, ValueError) as error:
                got = f"{client!r} ({error})"
                remedy = "start one by 'dask scheduler', or leave client= out"
                text = _check.message("client", "the address of a scheduler", got, remedy)
                raise PieceError(text) from error
        elif not isinstance(client, distributed.Client):
            expected = "a distributed.Client or the address of a scheduler"
            raise TypeError(_check.message("client", expected, type(client).__name__))
        yield Workers(client, retries)


def local_cluster(count: int) -> Any:
    """Return a cluster of so many processes, without a dashboard, beside any others here."""
    import distributed

    return distributed.LocalCluster(
        n_workers=count, threads_per_worker=1, processes=True, dashboard_address=None,
        scheduler_kwargs={"dashboard_address": ":0"}, silence_logs=50,
    )  # fmt: skip


@contextlib.contextmanager
def _main_apart() -> Iterator[None]:
    """Keep a script from being run again by each process that it starts.

    Processes are spawned, and each would import the script, which need not be guarded by
    ``if __name__ == "__main__"``: what they call is in this package.
    """
    main = sys.modules["__main__"]
    path = getattr(main, "__file__", None)
    if path is None or getattr(main, "__spec__", None) is not None:
        yield
        return
    del main.__file__
    try:
        yield
    finally:
        main.__file__ = path


def _has_dask() -> bool:
    return importlib.util.find_spec("distributed") is not None


def tried(function: Callable[..., Any], retries: int, *arguments: Any) -> Any:
    """Call a function, again after an error of the operating system."""
    for _ in range(retries):
        try:
            return function(*arguments)
        except PieceError as error:
            cause: BaseException | None = error
            while cause is not None and not isinstance(cause, OSError):
                cause = cause.__cause__
            if cause is None:
                raise
    return function(*arguments)


def _next(waiting: deque[tuple[str, Any]]) -> Any:
    """Return the result of the first call that waits, which then waits no more."""
    name, future = waiting[0]
    with _naming(name):
        result = future.result()
    waiting.popleft()
    return result


@contextlib.contextmanager
def _naming(name: str) -> Iterator[None]:
    """Turn the errors of a cluster into one that names the piece."""
    import distributed

    try:
        yield
    except (ValueError, TypeError):
        raise
    except distributed.KilledWorker as error:
        text = f"{LOST + 1} workers ended while they worked on it, perhaps for lack of memory"
        raise PieceError(f"piece {name}: {text}; cut it smaller") from error
    except (CancelledError, OSError) as error:
        text = "the cluster went away before it was done; the same call goes on from here"
        raise PieceError(f"piece {name}: {text}") from error
    except Exception as error:
        raise PieceError(f"piece {name}: {type(error).__name__}: {error}") from error


def collected(results: Iterable[T], count: int, what: str, *, show: bool) -> list[T]:
    """Return results, with progress shown as they come."""
    found: list[T] = []
    with _progress.progress(what, count, show=show) as report:
        for value in results:
            found.append(value)
            report(len(found))
    return found
