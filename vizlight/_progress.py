"""A progress bar on standard error, shown where the caller asks for one."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator

from vizlight import _check


@contextlib.contextmanager
def progress(what: str, total: int, *, show: bool) -> Iterator[Callable[[int], None]]:
    """Yield a function that takes the amount of work done so far, out of ``total``."""
    if not _check.boolean("progress_bar", show):
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True)) as bar:
        task = bar.add_task(what, total=total)
        yield lambda done: bar.update(task, completed=done)
