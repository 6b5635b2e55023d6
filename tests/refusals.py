"""Tests that what does not fit is refused, in words that name it."""

import functools
import re

import pytest

import vizlight
from vizlight.files import FileError


def refusals(call, *rows, kind=ValueError):
    """Return a test for rows of the arguments of a call and the words of its error.

    A row ends with the error's type where it is another than ``kind``.
    """

    def test():
        missed = []
        for row in rows:
            *arguments, words, error = row if isinstance(row[-1], type) else (*row, kind)
            said = None
            try:
                call(*arguments)
            except error as caught:
                said = str(caught)
            if said is None or not re.search(words, said):
                missed.append(f"expected {words!r}, got {said!r}")
        assert not missed, missed

    return test


def refused_files(read, *rows):
    """Return a test for rows of what a function writes into a folder and reads, and the words."""

    def test(tmp_path):
        refusals(functools.partial(read, tmp_path), *rows, kind=FileError)()

    return test


def saved(path, content):
    """Return the path of a file with some content, text or bytes."""
    (path.write_text if isinstance(content, str) else path.write_bytes)(content)
    return path


def refused(path, words):
    """Check that a file is not read, and the words of the error."""
    with pytest.raises(FileError, match=words):
        vizlight.read(path)


def read_warned(path, words):
    """Return what a file has, and check the words of a warning."""
    with pytest.warns(UserWarning, match=words):
        return vizlight.read(path)
