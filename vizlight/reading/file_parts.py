"""Parts of files that are open: places of words, numbers of bytes, the last words."""

from __future__ import annotations

import contextlib
import mmap
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vizlight import _check

#: Bytes of a number by a part of the name of its type: the first that is in it.
BYTES = {
    "64": 8, "32": 4, "16": 2, "int8": 1, "idtype": 4, "char": 1, "short": 2, "long_long": 8,
    "long long": 8, "longlong": 8, "long": 4, "int": 4, "float": 4, "double": 8,
}  # fmt: skip
#: Bytes at the end of a file in which its last words stand.
_END = 512


def warn_of_last_line(path: Path, data: bytes) -> None:
    """Warn of a text without a line break at its end, which may be cut in its last number."""
    if not data.endswith((b"\n", b"\r", b"End")):
        _check.warn(f"file: '{path}' may be cut in its last line, which has no line break")


def warn_of_more(path: Path, count: int, unit: str) -> None:
    """Warn of a part of a file beyond the size that it states, if there is one.

    ``unit`` is the word for the lines, numbers or bytes counted.
    """
    if count > 0:
        _check.warn(f"file: '{path}' has {count} {unit} more than it states, which are left out")


def warn_of_less(path: Path, count: int, stated: int, unit: str) -> None:
    """Warn where a file gives less than it states. ``unit`` is the word for the parts counted."""
    if count < stated:
        _check.warn(f"file: '{path}' gives {count} of the {stated} {unit} that it states")


@contextlib.contextmanager
def errors_of_gemmi(path: Path) -> Iterator[None]:
    """Raise ValueError in one line for an error of gemmi, with the number of a line of a text."""
    try:
        yield
    except (RuntimeError, ValueError) as error:
        raise ValueError(str(error).replace(f"{path}:", "line ").strip()) from None


def last(file: BinaryIO) -> bytes:
    """Return the last bytes of a file."""
    file.seek(-min(_END, file.seek(0, 2)), 2)
    return file.read()


@contextlib.contextmanager
def mapped(file: BinaryIO) -> Iterator[mmap.mmap | bytes]:
    """Return the content of a file, which is not read at once."""
    if not file.seek(0, 2):
        yield b""
        return
    with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        yield text


def places(text: mmap.mmap | bytes, word: bytes) -> Iterator[int]:
    """Return the places of a word."""
    at = text.find(word)
    while at >= 0:
        yield at
        at = text.find(word, at + 1)


def missing_bytes(file: BinaryIO, least: int) -> str:
    """Return how many bytes a file has of the least that it states, or "" if all."""
    count = file.seek(0, 2)
    return f"{count} of {least} bytes are there" if count < least else ""


def count_words(data: bytes | NDArray[np.uint8]) -> int:
    """Return the number of words of a text."""
    gap = np.frombuffer(data, np.uint8) <= ord(" ")
    return int(np.count_nonzero(gap[:-1] & ~gap[1:])) + bool(len(gap) and not gap[0])


def first_bytes(path: Path, count: int) -> bytes:
    """Return the first bytes of a file."""
    with path.open("rb") as file:
        return file.read(count)
