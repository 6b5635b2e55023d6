"""Trials: a file is first read in another process, which it may end.

Libraries in C end the process at some damaged files, or read them without end. In Python a fork of
this process reads a file first. Where threads run a fork is not safe, and other systems than Linux
have none that is: then a process is started at the first file, and kept for those that follow.
"""

from __future__ import annotations

import atexit
import contextlib
import faulthandler
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, TypeAlias

from vtkmodules.vtkCommonCore import vtkSMPTools

from vizlight import _supervise

#: A function that loads what reads a file, one that returns why it refuses the file, or "", and the
#: time that this one has.
Request: TypeAlias = tuple[Callable[[], None], Callable[[], str], float]

__all__ = ["are_needed", "refusal", "serve"]

#: Time that a file may take, in seconds, and what each megabyte adds.
SECONDS, SECONDS_PER_MB = 15.0, 0.5
#: Whether a fork is safe in a process without other threads.
_FORKS = sys.platform.startswith("linux")
#: Program that tries the files of another process: it finds packages where that does.
_PROGRAM = (
    "import sys; sys.path[:] = sys.argv[1:]; import vizlight.files; "
    "from vizlight import _trials; _trials.serve()"
)
#: What a process says when it has loaded all that reads files, or has come to the end of one.
_READY = b"+"
#: Libraries need no threads there, which a fork would lose.
_ALONE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
#: Windows opens a console for each program without this flag.
_HIDDEN = getattr(subprocess, "CREATE_NO_WINDOW", 0)
_is_trial = False


def are_needed() -> bool:
    """Return whether this process has to go on whatever a file does.

    The command line has a process for that already. A program that is frozen has no Python that
    could be started.
    """
    is_program = bool(sys.executable) and not getattr(sys, "frozen", False)
    return is_program and not (_is_trial or _supervise.has_parent())


def refusal(load: Callable[[], None], read: Callable[[], str], path: Path, size: int) -> str:
    """Return why a file is refused that another process reads first, or "".

    Parameters
    ----------
    load : callable
        Function that imports the packages of ``read``, once for all files of a process.
    read : callable
        Function that returns why it refuses the file, or "".
    path : pathlib.Path
        Path of the file.
    size : int
        Number of bytes that are read.

    Returns
    -------
    str
        Result of ``read``, or a message on how it ended the process.
    """
    limit = _supervise.read_limit(size, SECONDS, SECONDS_PER_MB)
    request = load, read, limit
    if _FORKS and threading.active_count() == 1:
        code, text = _forked(request)
    else:
        code, text = _helpers.setdefault(os.getpid(), _Helper()).tried(request)
    return text if code == 0 else _supervise.unreadable(str(path), code, limit)


def _forked(request: Request) -> tuple[int, str]:
    """Return the exit code of a fork, and its answer."""
    request[0]()
    parent, (reader, writer) = os.getpid(), os.pipe()
    with os.fdopen(reader, "rb") as said, os.fdopen(writer, "wb") as answer, _scratch() as folder:
        with warnings.catch_warnings():
            # Of threads that libraries keep, which do not read files.
            warnings.simplefilter("ignore")
            try:
                child = os.fork()
            except OSError:  # no more processes: the file is read without a trial
                return 0, ""
        if not child:
            _try(request, parent, answer, folder)
        answer.close()
        try:
            text = said.read()
        except BaseException:
            os.kill(child, signal.SIGKILL)
            raise
        finally:
            code = 1
            # Where the user ignores the end of children their codes are lost.
            with contextlib.suppress(ChildProcessError):
                code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return (
        (0, text[1:].decode("utf-8", "surrogateescape")) if text.startswith(_READY) else (code, "")
    )


@contextlib.contextmanager
def _scratch() -> Iterator[str]:
    """Make a folder for temporary files, which is removed after a crash, too."""
    folder = ""
    with contextlib.suppress(OSError):  # there is no place for any
        folder = tempfile.mkdtemp(prefix="vizlight-")
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _try(request: Request, parent: int, answer: BinaryIO, folder: str) -> None:
    """Read a file in a fork, and end that."""
    global _is_trial  # noqa: PLW0603 - a process is one or not
    try:
        _is_trial = True
        # The system's timer ends the process also inside a library of C; a crash is no news.
        faulthandler.disable()
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, request[2])
        _supervise.end_with(parent)
        _supervise.limit_memory()
        _silence()
        tempfile.tempdir = folder or tempfile.tempdir
        if vtkSMPTools.GetBackend() != "Sequential":
            vtkSMPTools.SetBackend("Sequential")  # a fork has no threads of the others
        answer.write(_READY + request[1]().encode("utf-8", "surrogateescape"))
        answer.flush()
    finally:
        os._exit(0)


def _silence() -> None:
    """Drop the text of the standard streams."""
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (1, 2):
        os.dup2(nothing, number)
    sys.stdout = sys.stderr = os.fdopen(nothing, "w")


class _Helper:
    """A process that tries files for the threads of this one, in turn."""

    def __init__(self) -> None:
        self._turn = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None

    def tried(self, request: Request) -> tuple[int, str]:
        """Return the exit code of a trial, and its answer."""
        folder = ""
        with contextlib.suppress(OSError):  # the working folder is gone
            folder = str(Path.cwd())
        try:
            data = pickle.dumps((folder, request))
        except (AttributeError, TypeError, pickle.PicklingError):
            return 0, ""  # a value that no file has: it is refused when the file is read
        with self._turn:
            if self._process is None or self._process.poll() is not None:
                self._start()
            process = self._process
            if process is None or process.stdin is None or process.stdout is None:
                return 0, ""
            try:
                process.stdin.write(data)
                process.stdin.flush()
                answer: tuple[int, str] = pickle.load(process.stdout)
            except (EOFError, OSError):
                # The file has ended it.
                answer = process.wait(), ""
                self.end()
            except BaseException:
                self.end()
                raise
            return answer

    def _start(self) -> None:
        """Start the process; where none can be started files are read without a trial."""
        self.end()
        with contextlib.suppress(OSError):
            self._process = subprocess.Popen(
                [sys.executable, "-c", _PROGRAM, *sys.path],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env={**os.environ, **_ALONE},
                creationflags=_HIDDEN,
                # Ctrl-C is for the caller alone.
                start_new_session=True,
            )
        if self._process and self._process.stdout and self._process.stdout.read(1) != _READY:
            self.end()

    def end(self) -> None:
        """End the process, if there is one."""
        process, self._process = self._process, None
        if process:
            # What it has not read may be left in the pipe.
            with contextlib.suppress(BrokenPipeError), process:
                process.terminate()


#: Helpers by the number of the process: a fork does not use those of its parent.
_helpers: dict[int, _Helper] = {}


@atexit.register
def _end() -> None:
    if helper := _helpers.pop(os.getpid(), None):
        helper.end()


def serve() -> None:
    """Try the files that another process names, until that ends."""
    global _is_trial  # noqa: PLW0603 - a process is one or not
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    asked, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    _silence()
    _is_trial = True
    answers.write(_READY)
    answers.flush()
    if _FORKS:
        signal.signal(signal.SIGTERM, _leave)
    said = ""
    with contextlib.suppress(EOFError, SystemExit):
        # Without a fork a damaged file may spoil those after it.
        while _FORKS or not said:
            folder, request = pickle.load(asked)
            with contextlib.suppress(OSError):
                os.chdir(folder)
            code, said = _forked(request) if _FORKS else _here(request)
            pickle.dump((code, said), answers)
            answers.flush()
    os._exit(0)


def _leave(_number: int, _frame: object) -> None:
    """Leave what is under way, with its temporary files."""
    sys.exit()


def _here(request: Request) -> tuple[int, str]:
    """Try a file in this process, which ends with code 1 where the time is over."""
    _, read, limit = request
    faulthandler.dump_traceback_later(limit, exit=True)
    said = read()
    faulthandler.cancel_dump_traceback_later()
    return 0, said
