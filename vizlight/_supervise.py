"""The command line in a child process: a crash in a library becomes one line and an exit code.

A damaged file can end the process inside a reader, a full disk inside a writer, a missing driver
inside the drawing library. The child says which of these it is doing; the parent waits, removes
the temporary files of a child that was killed, and says what happened.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import select
import shutil
import signal
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

    from vizlight._types import Foreign

__all__ = ["Doing", "end_with", "read_limit", "run", "stage"]

Doing: TypeAlias = Literal["read", "write", "draw"]

#: Exit codes of the command line: a machine that lacks something; bad input.
LACKING, BAD_INPUT = 1, 2
#: Time that a file may take to be read, in seconds, and what each megabyte adds.
READ_SECONDS, READ_SECONDS_PER_MB = 60.0, 1.0
#: Seconds that a child has to end after Ctrl-C.
PATIENCE = 5.0
#: Environment variable that replaces READ_SECONDS.
READ_VARIABLE = "VIZLIGHT_READ_SECONDS"

#: Signals to the parent that end the child. They are blocked until the parent can pass them on.
_PASSED_ON = tuple(
    signal.Signals[name]
    for name in ("SIGTERM", "SIGHUP", "SIGINT")
    if name in signal.Signals.__members__
)
_PR_SET_PDEATHSIG = 1
_channel: int | None = None


def read_limit(size: int) -> float:
    """Return the time that a file may take to be read.

    Parameters
    ----------
    size : int
        Size of the file in bytes.

    Returns
    -------
    float
        Time in seconds: 60, or what the environment variable ``VIZLIGHT_READ_SECONDS`` says, and
        one for each megabyte.
    """
    try:
        base = float(os.environ.get(READ_VARIABLE, ""))
    except ValueError:
        base = READ_SECONDS
    return base + READ_SECONDS_PER_MB * size / 1e6


@contextlib.contextmanager
def stage(
    doing: Doing,
    path: str | os.PathLike[str],
    /,
    *,
    temporary: str = "",
    seconds: float | None = None,
) -> Iterator[None]:
    """Say what the process does while this context is entered; without a parent do nothing.

    Parameters
    ----------
    doing : {"read", "write", "draw"}
        What may crash.
    path : path
        File that is read or written.
    temporary : str, optional
        Folder that is removed if the process is killed.
    seconds : float, optional
        Time after which the process is killed. Default: no limit.
    """
    if _channel is None:
        yield
        return
    place = temporary and str(Path(temporary).absolute())
    # The clock is that of the machine, the same for the parent.
    until = None if seconds is None else time.monotonic() + seconds
    said = {"doing": doing, "path": os.fspath(path), "temporary": place, "seconds": seconds}
    os.write(_channel, json.dumps(said | {"until": until}).encode() + b"\n")
    try:
        yield
    finally:
        os.write(_channel, b"{}\n")


def run(main: Callable[[], int]) -> int:
    """Run a function in a child process and return its exit code; signals are blocked after that.

    Only Linux starts a child; elsewhere, and where threads run already, the function is called.

    Parameters
    ----------
    main : callable
        Function without arguments that returns an exit code.

    Returns
    -------
    int
        Exit code. 2 if a signal or a limit ended the child while it read or wrote a file, 1 if it
        drew a picture or computed.
    """
    global _channel  # noqa: PLW0603 - a process has one parent
    if not sys.platform.startswith("linux") or len([*Path("/proc/self/task").iterdir()]) > 1:
        if signal.getsignal(signal.SIGINT) == signal.SIG_DFL:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        return main()
    _open_standard_streams()
    reader, writer = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    signal.pthread_sigmask(signal.SIG_BLOCK, _PASSED_ON)
    parent, child = os.getpid(), os.fork()
    if child:
        os.close(writer)
        return _Parent(child, reader).wait()
    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
        signal.signal(signal.SIGINT, _interrupt_once)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _PASSED_ON)
    os.close(reader)
    _channel = writer
    _mute_libraries()
    end_with(parent)
    _limit_memory()
    return main()


def _interrupt_once(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt; the next Ctrl-C must not end the process while it reports this."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.default_int_handler(number, frame)


def _mute_libraries() -> None:
    """Leave standard error to Python; what libraries in C print beside their errors is lost."""
    sys.stderr = os.fdopen(os.dup(2), "w", buffering=1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    os.close(nowhere)


def _open_standard_streams() -> None:
    """Open the null device in place of closed standard streams, whose numbers files would take."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    if sys.stdout is None:
        sys.stdout = open(1, "w", closefd=False)  # noqa: SIM115 - as long as the process
    if sys.stderr is None:
        sys.stderr = open(2, "w", closefd=False)  # noqa: SIM115


def end_with(parent: int) -> None:
    """Let the kernel kill this process when its parent is killed.

    Parameters
    ----------
    parent : int
        Number of the process that is the parent.
    """
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != parent:
        os._exit(LACKING)


def _limit_memory() -> None:
    """Refuse to allocate more than the machine has: counts in damaged files ask for any amount."""
    import resource

    total = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    given = [total, *(limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY)]
    resource.setrlimit(resource.RLIMIT_DATA, (min(given), hard))


class _Parent:
    """The process that waits for a child."""

    def __init__(self, child: int, reader: int) -> None:
        self.child, self.reader = child, reader
        self.stages: list[Foreign] = []
        self.buffer = b""
        self.ended_by: signal.Signals | None = None
        self.interrupted: float | None = None
        self.passed_on = False
        self.late = False

    def wait(self) -> int:
        """Wait for the child and return the exit code."""
        # What the caller ignores, as a shell does for jobs in the background, stays ignored.
        heard = [name for name in _PASSED_ON if signal.getsignal(name) != signal.SIG_IGN]
        kept = {name: signal.signal(name, self.on_signal) for name in heard}
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _PASSED_ON)
        try:
            status = self.listen()
        finally:
            # The child has ended: what comes now would end the process while it reports that.
            signal.pthread_sigmask(signal.SIG_BLOCK, _PASSED_ON)
            for name, handler in kept.items():
                signal.signal(name, handler)
            os.close(self.reader)
        return self.finish(status)

    def on_signal(self, number: int, _frame: FrameType | None) -> None:
        """Pass a signal on; the terminal sends Ctrl-C to the child as well."""
        self.ended_by = signal.Signals(number)
        if number == signal.SIGINT:
            self.interrupted = time.monotonic()
        else:
            os.kill(self.child, signal.SIGKILL)

    def listen(self) -> int:
        """Read what the child says until it ends, and return its status."""
        is_open = True
        while True:
            pid, status = os.waitpid(self.child, os.WNOHANG)
            if pid:
                while is_open and select.select([self.reader], [], [], 0)[0]:
                    is_open = self.read()
                return status
            if is_open:
                if select.select([self.reader], [], [], 0.1)[0]:
                    is_open = self.read()
            else:
                time.sleep(0.002)
            self.check()

    def read(self) -> bool:
        """Take what the child has said; return whether it may say more."""
        data = os.read(self.reader, 65536)
        *lines, self.buffer = (self.buffer + data).split(b"\n")
        for line in lines:
            message = json.loads(line)
            if message:
                self.stages.append(message)
            else:
                self.stages.pop()
        return bool(data)

    def check(self) -> None:
        """Kill a child that is late, or that does not end after Ctrl-C."""
        ends = [stage["until"] for stage in self.stages if stage["until"] is not None]
        if ends and min(ends) < time.monotonic():
            self.late = True
            os.kill(self.child, signal.SIGKILL)
        if self.interrupted is not None:
            waited = time.monotonic() - self.interrupted
            if waited > PATIENCE:
                os.kill(self.child, signal.SIGKILL)
            elif waited > PATIENCE / 10 and not self.passed_on:
                self.passed_on = True
                os.kill(self.child, signal.SIGINT)

    def finish(self, status: int) -> int:
        """Return the exit code; after a kill clean up and say what happened."""
        if os.WIFEXITED(status):
            return os.WEXITSTATUS(status)
        for stage in self.stages:
            if stage["temporary"]:
                shutil.rmtree(stage["temporary"], ignore_errors=True)
        text, code = self.message(signal.Signals(os.WTERMSIG(status)))
        sys.stderr.write(f"vizlight: {text}\n")
        return code

    def message(self, by: signal.Signals) -> tuple[str, int]:
        """Return what happened to a child that was killed, and the exit code."""
        if self.ended_by is not None:
            ended = "interrupted" if self.ended_by == signal.SIGINT else "ended"
            return f"{ended} by {self.ended_by.name}; no partial file is left", BAD_INPUT
        if not self.stages:
            return f"the process was ended by {by.name}{_reason(by)}", LACKING
        stage = self.stages[-1]
        what = f"'{stage['path']}'"
        if stage["doing"] == "read":
            why = f"not read within {stage['seconds']:.0f} s" if self.late else f"by {by.name}"
            ends = "its reader" if self.late else "its reader was ended"
            return (
                f"file: expected a file that can be read, got {what} ({ends} {why}; the file "
                f"may be damaged{'' if not self.late else f', {READ_VARIABLE}= allows more time'})",
                BAD_INPUT,
            )
        if stage["doing"] == "write":
            return (
                f"output: expected a file that can be written, got {what} (its writer was ended "
                f"by {by.name}; is the disk full?); no partial file is left",
                BAD_INPUT,
            )
        return (
            f"no picture: the drawing of {what} was ended by {by.name}{_reason(by)}; "
            "'vizlight doctor' says what draws here",
            LACKING,
        )


def _reason(by: signal.Signals) -> str:
    return " (out of memory?)" if by == signal.SIGKILL else ""
