"""What works on the pieces: this process, local processes, or a cluster of Dask."""

from __future__ import annotations

import contextlib
import importlib.util
import sys
from typing import TYPE_CHECKING, Any

from vizlight import _check, _pool, _progress
from vizlight.pieces.kinds import PieceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

#: Number of workers that a piece may end before it counts as the cause.
LOST = 3


@contextlib.contextmanager
def runner(
    client: Any, workers: int | None, retries: int, count: int
) -> Iterator[Callable[..., Iterator[tuple[int, Any]]]]:
    """Yield a function that calls another for many arguments, and yields results as they come.

    They come with the index of their arguments; an error names the piece, the first argument.
    """
    if workers is not None and client is not None:
        raise ValueError(_check.message("workers", "client= or workers=", "both"))
    if client is None:
        number = (
            _pool.workers(None) if workers is None else _check.integer("workers", workers, low=1)
        )
        number = min(number, count)
        if number == 1 or (workers is None and not _has_dask()):
            yield _one_by_one(retries)
            return
    if not _has_dask():
        what = "workers" if client is None else "client"
        raise ImportError(f"{what}= needs Dask: run pip install 'vizlight[scale]'")
    import distributed

    with contextlib.ExitStack() as stack:
        if client is None:
            stack.enter_context(_main_apart())
            cluster = stack.enter_context(
                distributed.LocalCluster(
                    n_workers=number,
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=None,
                    silence_logs=50,
                )
            )
            client = stack.enter_context(distributed.Client(cluster))
        elif isinstance(client, str):
            try:
                client = stack.enter_context(distributed.Client(client, timeout=10))
            except (OSError, TimeoutError) as error:
                got = f"{client!r} ({error})"
                remedy = "start one by 'dask scheduler', or leave client= out"
                text = _check.message("client", "the address of a scheduler", got, remedy)
                raise PieceError(text) from error
        elif not isinstance(client, distributed.Client):
            expected = "a distributed.Client or the address of a scheduler"
            raise TypeError(_check.message("client", expected, type(client).__name__))
        yield _on_cluster(client, retries)


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


def _one_by_one(retries: int) -> Callable[..., Iterator[tuple[int, Any]]]:
    def run(function: Callable[..., Any], calls: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        for i, arguments in enumerate(calls):
            yield i, tried(function, retries, *arguments)

    return run


def tried(function: Callable[..., Any], retries: int, *arguments: Any) -> Any:
    """Call a function, again after an error of the operating system."""
    for _ in range(retries):
        try:
            return function(*arguments)
        except PieceError as error:
            if not isinstance(error.__cause__, OSError):
                raise
    return function(*arguments)


def _on_cluster(client: Any, retries: int) -> Callable[..., Iterator[tuple[int, Any]]]:
    import distributed

    def run(function: Callable[..., Any], calls: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        futures = [client.submit(tried, function, retries, *one, pure=False) for one in calls]
        order = {future.key: i for i, future in enumerate(futures)}
        try:
            for future in distributed.as_completed(futures):
                i = order[future.key]
                if future.status == "finished":
                    yield i, future.result()
                    continue
                raise _fault(calls[i][0].name, future)
        finally:
            with contextlib.suppress(Exception):  # a cluster that went away has nothing to cancel
                client.cancel(futures, force=True)

    return run


def _fault(name: str, future: Any) -> Exception:
    """Return the error of a piece that was not done."""
    if future.status != "error":
        text = "the cluster went away before it was done; the same call goes on from here"
        return PieceError(f"piece {name}: {text}")
    error = future.exception()
    if isinstance(error, ValueError | TypeError):
        return error
    if type(error).__name__ == "KilledWorker":
        text = f"{LOST + 1} workers ended while they did it, perhaps for lack of memory"
        return PieceError(f"piece {name}: {text}; cut it smaller")
    return PieceError(f"piece {name}: {type(error).__name__}: {error}")


def collected(
    results: Iterator[tuple[int, Any]], count: int, what: str, *, show: bool
) -> list[Any]:
    """Return results in the order of the calls, with progress shown as they come."""
    found: list[Any] = [None] * count
    with _progress.progress(what, count, show=show) as report:
        for number, (i, value) in enumerate(results, start=1):
            found[i] = value
            report(number)
    return found
