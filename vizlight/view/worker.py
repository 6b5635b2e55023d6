"""The process that reads the file, contours and traces, so that the page stays responsive."""

from __future__ import annotations

import multiprocessing
import os
import signal
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from vizlight import _check, _supervise
from vizlight.cli.output import one_line
from vizlight.cli.script import Step
from vizlight.files import FileError

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from vizlight.view.state import Facts, State
    from vizlight.view.steps import Eye

__all__ = ["Answer", "Worker"]

#: Lit meshes that are kept, so that undo does not trace again.
KEPT = 6


class Answer(NamedTuple):
    """What was made, or why not; and the warnings that came with it."""

    result: Any = None
    error: str = ""
    warnings: tuple[str, ...] = ()


class Worker:
    """A child process that holds the mesh of one file.

    Parameters
    ----------
    file : pathlib.Path
        File that is read.
    salvage : bool
        Whether what could be read of a damaged file is used.
    """

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        self.file, self._salvage = file, salvage
        self._process: Any = None
        self._connection: Connection | None = None

    def begin(self) -> None:
        """Start the process, which then reads the file."""
        self.stop()
        context = multiprocessing.get_context("spawn")
        self._connection, theirs = context.Pipe()
        self._process = context.Process(
            target=_work, args=(theirs, os.getpid(), self.file, self._salvage), daemon=True
        )
        self._process.start()
        theirs.close()

    def facts(self) -> Facts:
        """Wait until the file is read, and return what it offers.

        Raises
        ------
        FileError
            If the file cannot be read, or its reader crashes or does not end.
        """
        assert self._connection is not None
        limit = _supervise.read_limit(self.file.stat().st_size if self.file.exists() else 0)
        reason = f"not read within {limit:.0f} s"
        if self._connection.poll(limit):
            answer = self._answer("its reader was")
            if answer.result is not None:
                for text in answer.warnings:
                    _check.warn(text)
                facts: Facts = answer.result
                return facts
            reason = answer.error
        self.stop()
        if reason.startswith("file: "):
            raise FileError(reason)
        got = f"'{self.file}' ({reason}; the file may be damaged)"
        raise FileError(_check.message("file", "a file that can be read", got))

    def light(self, state: State) -> Answer:
        """Return the lit mesh of a state; blocks until it is made or the process ends."""
        return self._ask("light", state)

    def picture(self, state: State, eye: Eye, size: tuple[int, int]) -> Answer:
        """Return the bytes of the picture that the script of a state makes."""
        return self._ask("picture", state, eye, size)

    def _ask(self, *request: object) -> Answer:
        if self._process is None or not self._process.is_alive():
            try:
                self.begin()
                self.facts()
            except FileError as error:
                return Answer(error=one_line(error))
        assert self._connection is not None
        try:
            self._connection.send(request)
        except OSError:
            return Answer(error="the process that computes has ended; try again")
        return self._answer("the process that computes was")

    def _answer(self, who: str) -> Answer:
        assert self._connection is not None
        try:
            answer: Answer = self._connection.recv()
        except (EOFError, OSError):
            self._process.join()
            code = self._process.exitcode or 0
            name = signal.Signals(-code).name if code < 0 else f"exit code {code}"
            return Answer(error=f"{who} ended by {name}")
        return answer

    def stop(self) -> None:
        """End the process, whatever it does; the next request starts another one."""
        if self._process is not None and self._process.is_alive():
            self._process.kill()
            self._process.join()
        if self._connection is not None:
            self._connection.close()
        self._process = self._connection = None


def _work(connection: Connection, parent: int, file: Path, salvage: bool) -> None:
    """Read a file and answer requests until the other side is gone."""
    # Ctrl-C in a terminal is for the page, which ends this process.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _supervise.end_with(parent)
    maker = _Maker(file, salvage=salvage)
    connection.send(_guarded(maker.read))
    while True:
        try:
            name, *arguments = connection.recv()
        except (EOFError, OSError):
            return
        connection.send(_guarded(getattr(maker, name), *arguments))


def _guarded(make: Any, *arguments: Any) -> Answer:
    """Return what a function makes, or its error, and its warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", UserWarning)
        try:
            result = make(*arguments)
        except MemoryError:
            return Answer(error="not enough memory")
        except Exception as error:  # noqa: BLE001 - the page shows it and goes on
            kind = "" if isinstance(error, ValueError | TypeError) else f"{type(error).__name__}: "
            return Answer(error=f"{kind}{one_line(error)}")
    return Answer(result, "", tuple(one_line(each.message) for each in caught))


class _Maker:
    """Mesh of a file, and what was made of it last."""

    def __init__(self, file: Path, *, salvage: bool) -> None:
        options = {"salvage": True} if salvage else {}
        self._read = Step("data", "vizlight.read", file, **options)
        self._made: dict[tuple[object, ...], Any] = {}

    def read(self) -> Facts:
        """Read the file and return what it offers."""
        from vizlight.view import state, steps

        self.facts = state.facts_of(self._read.run())
        self._mesh = steps.data(self._read, self.facts)
        return self.facts

    def light(self, state: State) -> Any:
        """Return the lit mesh of a state; its camera and lights are put in where it is drawn."""
        from vizlight.view import steps

        if state.built not in self._made:
            made = steps.lit(state, self.facts, self._mesh, steps.any_scene()).run()
            while len(self._made) >= KEPT:
                del self._made[next(iter(self._made))]
            self._made[state.built] = made
        return self._made[state.built]

    def picture(self, state: State, eye: Eye, size: tuple[int, int]) -> bytes:
        """Return the bytes of the picture of a state."""
        from vizlight.view import steps

        with tempfile.TemporaryDirectory(prefix="vizlight-") as folder:
            path = Path(folder) / "picture.png"
            for step in steps.picture(state, self.facts, self._mesh, eye, size, path):
                step.run()
            return path.read_bytes()
