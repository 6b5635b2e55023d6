"""The command line in a child process: a crash in a library becomes one line and an exit code.

A damaged file can end the process inside a reader, a full disk inside a writer, a missing driver
inside the drawing library. The child says which of these it is doing; the parent waits, removes the
temporary files of a child that was killed, and reports the cause.
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
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from vizlight import _words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

    from vizlight._types import Keywords

Doing: TypeAlias = Literal["read", "write", "draw"]

#: Exit codes of the command line: a machine that lacks something; bad input.
LACKING, BAD_INPUT = 1, 2
#: Exit code of a process in which the time of a file is over, where no signal ends it.
LATE = 1
#: Time that a file may take to be read, in seconds, and what each megabyte adds.
READ_SECONDS, READ_SECONDS_PER_MB = 60.0, 1.0
#: Seconds after Ctrl-C until it is passed on to the child, as the terminal itself does at once, and
#: from then until the child is killed.
PASS_ON, PATIENCE = 0.5, 4.5
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


def read_limit(
    size: int, seconds: float = READ_SECONDS, per_mb: float = READ_SECONDS_PER_MB
) -> float:
    """Return the time that a file may take to be read.

    It is ``seconds``, which the environment variable ``VIZLIGHT_READ_SECONDS`` replaces, and
    ``per_mb`` for each megabyte.
    """
    try:
        base = float(os.environ.get(READ_VARIABLE, ""))
    except ValueError:
        base = seconds
    return base + per_mb * size / 1e6


def has_parent() -> bool:
    """Return whether a parent waits for this process, which then may end at a damaged file."""
    return _channel is not None


@contextlib.contextmanager
def stage(
    doing: Doing, path: str | os.PathLike[str], /, *, temporary: str = "", seconds: float = 0.0
) -> Iterator[None]:
    """Report the work of the process while this context is entered; without a parent do nothing.

    ``temporary`` is a folder that is removed if the process is killed, and ``seconds`` the time
    after which the system ends the process, also within a library, 0 for no limit.
    """
    if _channel is None:
        yield
        return
    place = temporary and str(Path(temporary).absolute())
    said = {"doing": doing, "path": os.fspath(path), "temporary": place, "seconds": seconds}
    os.write(_channel, json.dumps(said).encode() + b"\n")
    # The system's timer ends the process also inside a library of C, where handlers of Python wait.
    left = signal.setitimer(signal.ITIMER_REAL, seconds)[0] if seconds else 0.0
    try:
        yield
    finally:
        if seconds:
            # A stage around this one goes on with the time that it had left.
            signal.setitimer(signal.ITIMER_REAL, left)
        os.write(_channel, b"{}\n")


@contextlib.contextmanager
def folder(path: str | os.PathLike[str], /) -> Iterator[Path]:
    """Make a temporary folder to read a file by, which goes also where the process is killed."""
    with tempfile.TemporaryDirectory() as made, stage("read", path, temporary=made):
        yield Path(made)


def run(main: Callable[[], int]) -> int:
    """Run a function in a child process and return its exit code; signals are blocked after that.

    Only Linux starts a child; elsewhere, and where threads run already, the function is called. The
    code is 2 if a signal or a limit ended the child while it read or wrote a file, 1 if it drew a
    picture or computed.
    """
    global _channel  # noqa: PLW0603 - a process has one parent
    # A fork copies the calling thread alone: locks that other threads hold would never be free
    # again.
    if not sys.platform.startswith("linux") or len([*Path("/proc/self/task").iterdir()]) > 1:
        # Until now Ctrl-C ended the process without a traceback; the command line reports it.
        if signal.getsignal(signal.SIGINT) == signal.SIG_DFL:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        return main()
    _open_standard_streams()
    reader, writer = os.pipe()
    # Text that is still in a buffer would be written by both processes.
    sys.stdout.flush()
    sys.stderr.flush()
    # A signal between the fork and the handlers waits until both processes can take it.
    signal.pthread_sigmask(signal.SIG_BLOCK, _PASSED_ON)
    parent, child = os.getpid(), os.fork()
    if child:
        # The pipe ends for the reader when no process can write to it any more.
        os.close(writer)
        return _wait(child, reader)
    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
        signal.signal(signal.SIGINT, _interrupt_once)
    # The limit of a stage ends the process by what the system does at this signal.
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _PASSED_ON)
    os.close(reader)
    _channel = writer
    # Standard error is left to Python; what libraries in C print beside their errors is lost.
    sys.stderr = os.fdopen(os.dup(2), "w", buffering=1)
    with Path(os.devnull).open("wb") as nothing:
        os.dup2(nothing.fileno(), 2)
    end_with(parent)
    limit_memory()
    code = main()
    # All is said: what ends the process while it is taken down is no news.
    os.write(_channel, json.dumps({"code": code}).encode() + b"\n")
    return code


def _interrupt_once(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt; the next Ctrl-C must not end the process while it reports this."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.default_int_handler(number, frame)


def _open_standard_streams() -> None:
    """Open the null device in place of closed standard streams: files would take their numbers."""
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
    """Let the kernel kill this process when its parent is killed."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    # The parent may have ended before it was asked for this.
    if os.getppid() != parent:
        os._exit(LACKING)


def limit_memory() -> None:
    """Refuse to allocate more than the machine has: counts in damaged files ask for any amount."""
    import resource

    # Linux promises more memory than there is, and kills a process only when it uses that.
    total = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    limits = [total, *(limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY)]
    resource.setrlimit(resource.RLIMIT_DATA, (min(limits), hard))


def _wait(child: int, reader: int) -> int:
    """Wait for a child and return the exit code; after a kill clean up and report the cause."""
    ended_by: list[signal.Signals] = []

    def on_signal(number: int, _frame: FrameType | None) -> None:
        ended_by.append(signal.Signals(number))
        # A terminal tells the child, too, which may then end by itself before the timer rings.
        if number == signal.SIGINT:
            signal.setitimer(signal.ITIMER_REAL, PASS_ON, PATIENCE)
        else:
            os.kill(child, signal.SIGKILL)

    # The first alarm passes Ctrl-C on, and the next one kills.
    hasten = iter((signal.SIGINT, signal.SIGKILL))
    # What the caller ignores, as a shell does for jobs in the background, stays ignored.
    for name in _PASSED_ON:
        if signal.getsignal(name) != signal.SIG_IGN:
            signal.signal(name, on_signal)
    signal.signal(signal.SIGALRM, lambda *_: os.kill(child, next(hasten, signal.SIGKILL)))
    stages: list[Keywords] = []
    for line in _lines(reader):
        # An empty object says that the innermost stage is over.
        if said := json.loads(line):
            stages.append(said)
        else:
            stages.pop()
    _, status = os.waitpid(child, 0)
    # The child has ended: what comes now would end the process while it reports that.
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.pthread_sigmask(signal.SIG_BLOCK, _PASSED_ON)
    if os.WIFEXITED(status):
        return os.WEXITSTATUS(status)
    if stages and "code" in stages[-1]:
        return int(stages[-1]["code"])
    # A child that was killed could not remove its temporary folders.
    for step in stages:
        if step["temporary"]:
            shutil.rmtree(step["temporary"], ignore_errors=True)
    text, code = _what_happened(signal.Signals(os.WTERMSIG(status)), stages, ended_by)
    sys.stderr.write(f"vizlight: {_words.printable(text)}\n")
    return code


def unreadable(path: str, code: int, seconds: float) -> str:
    """Return the message on a file that ended the process that read it.

    The code is negative for a signal; ``seconds`` is the time that the file had.
    """
    if code == -getattr(signal, "SIGALRM", -LATE) or code == LATE:
        why = f"not read within {seconds:.0f} s; the file may be damaged"
        why += f", {READ_VARIABLE}= allows more time"
    else:
        by = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        why = f"its reader was ended by {by}; the file may be damaged, or of a form that it lacks"
    return f"file: expected a file that can be read, got '{path}' ({why})"


def _lines(reader: int) -> Iterator[bytes]:
    """Yield the lines that a child writes until it ends; signals are let through meanwhile.

    A signal just before a read that waits would be handled only when that returns: it wakes the
    wait by a pipe of its own.
    """
    wake, woken = os.pipe()
    # Python's handler writes to this pipe, and must not wait for a reader.
    os.set_blocking(woken, False)
    signal.set_wakeup_fd(woken)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _PASSED_ON)
    begun = b""
    while True:
        ready, _, _ = select.select([reader, wake], [], [])
        if wake in ready:
            os.read(wake, 1)
        if reader in ready:
            if not (text := os.read(reader, 1 << 16)):
                # No bytes are the end of the pipe: the child has closed it.
                return
            # The last part may be the beginning of a line.
            *lines, begun = (begun + text).split(b"\n")
            yield from lines


def _what_happened(
    by: signal.Signals, stages: list[Keywords], ended_by: list[signal.Signals]
) -> tuple[str, int]:
    """Return the report on a child that was killed, and the exit code."""
    if ended_by:
        ended = "interrupted" if ended_by[-1] == signal.SIGINT else "ended"
        return f"{ended} by {ended_by[-1].name}; no partial file is left", BAD_INPUT
    # The system kills by this signal when memory runs out.
    reason = " (out of memory?)" if by == signal.SIGKILL else ""
    if not stages:
        return f"the process was ended by {by.name}{reason}", LACKING
    last = stages[-1]
    # A file is read by others, which have temporary names.
    first = next(step for step in stages if step["doing"] == last["doing"])
    path = f"'{first['path']}'"
    if last["doing"] == "read":
        seconds = max(step["seconds"] for step in stages)
        return unreadable(first["path"], -by, seconds), BAD_INPUT
    if last["doing"] == "write":
        return (
            f"output: expected a file that can be written, got {path} (its writer was ended "
            f"by {by.name}; is the disk full?); no partial file is left",
            BAD_INPUT,
        )
    return (
        f"no picture: the drawing of {path} was ended by {by.name}{reason}; "
        "'vizlight doctor' says what draws here",
        LACKING,
    )
