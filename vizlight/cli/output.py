"""Text and pictures of the command line, and its exit codes."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from vizlight import _words
from vizlight._supervise import LACKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rich.console import Console

#: Exit code of success, beside those of ``_supervise``.
OK = 0
#: Notes of blocks that have not ended, the innermost last.
_notes: list[list[str]] = []
#: Characters per line where the output is a file or a pipe, which has no width of its own.
WIDTH = 140


def say(text: str) -> None:
    """Write a line to standard output.

    Work goes on where nobody reads it: a closed stream, a pipe that was closed, a full disk.
    """
    _put(sys.stdout, f"{_words.printable(text)}\n")


def _put(stream: TextIO | None, text: str) -> None:
    if stream is None:
        return
    try:
        stream.write(text)
        stream.flush()
    except OSError:
        # The rest in the buffer must not fail once more when the process ends.
        with Path(os.devnull).open("wb") as nothing:
            os.dup2(nothing.fileno(), stream.fileno())


def one_line(error: object) -> str:
    """Return an error on one line, with the library's options named as on the command line."""
    text = " ".join(str(error).split())
    # A name of two words at the start is an option; one of one word may be an array or a file.
    text = re.sub(r"^([a-z]+(?:_[a-z]+)+)(?=:)", _option, text)
    value = r"(?:True|('[^']*'|[\w./-]*\w))?"
    return re.sub(rf"(?<![\w.(])([a-z]+(?:_[a-z]+)*)={value}(?=[ ,;.)]|$)", _option, text)


#: Options that have another name on the command line than in Python.
_NAMES = {"question": "for"}


def _option(match: re.Match[str]) -> str:
    if re.search(r"\w\([^()]*$", match.string[: match.start()]):
        # A call of Python stays what it is.
        return match[0]
    value = (match[2] if match.re.groups > 1 else "") or ""
    name = _NAMES.get(match[1], match[1].replace("_", "-"))
    return f"--{name} {shlex.quote(value.strip(chr(39)))}".removesuffix(" ''")


def complain(text: object) -> None:
    """Write a line to standard error."""
    _put(sys.stderr, f"vizlight: {_words.printable(str(text))}\n")


def add_note(text: object) -> None:
    """Keep a line for standard error until the block of :func:`notes_at_end` ends."""
    _notes[-1].append(one_line(text))


@contextlib.contextmanager
def notes_at_end() -> Iterator[None]:
    """Write the notes of a block when it ends, each once; an error comes without them."""
    _notes.append([])
    ended = False
    try:
        yield
        ended = True
    finally:
        notes = _notes.pop()
        for text in dict.fromkeys(notes) if ended else ():
            complain(text)


def draw(write: Callable[[], Path], kind: str = "picture") -> int:
    """Draw a picture and return the exit code; without a library that draws print a message."""
    from vizlight import render

    try:
        path = write()
    except render.BackendError as error:
        complain(error)
        return LACKING
    say(f"{kind:8} {path}")
    return OK


def console() -> Console:
    """Return a console as wide as the terminal, or ``WIDTH`` wide without a terminal."""
    from rich.console import Console

    # Brackets in the text, as in an extra of a package, are not markup.
    terminal = Console(markup=False)
    return terminal if terminal.is_terminal else Console(width=WIDTH, markup=False)
