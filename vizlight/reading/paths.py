"""Paths of files, and the error of one that cannot be read or written."""

from __future__ import annotations

import contextlib
import errno
from pathlib import Path

from vizlight import _check
from vizlight.reading import cf_grids, series


class FileError(ValueError):
    """A file cannot be read or written."""


def wrong(name: str, expected: str, got: object, remedy: str = "") -> FileError:
    """Return the error of an argument that names a file."""
    return FileError(_check.message(name, expected, got, remedy))


def is_file(path: Path) -> bool:
    """Return whether a path is a file, also one with a name that the system does not take."""
    with contextlib.suppress(OSError, ValueError):
        return path.is_file()
    return False


def no_file(path: Path) -> str:
    """Return why a path is no file that can be read, an empty text if it is one.

    A store of Zarr is a folder, and so is a case of OpenFOAM.
    """
    if path.is_file() or (path.is_dir() and path.suffix.lower() in cf_grids.ZARR):
        return ""
    if series.is_case(path):
        return ""
    return "a folder" if path.is_dir() else "a pipe or device" if path.exists() else "no such file"


def checked_path(name: str, value: object) -> Path:
    """Return a path that the system takes, whether or not the file exists."""
    path = _check.path(name, value)
    try:
        path.stat()
    except OSError as error:
        # The system reports other errors, such as a name that is too long; the check for a missing
        # file comes later.
        if error.errno not in (errno.ENOENT, errno.ENOTDIR, errno.EACCES):
            got = f"{_check.describe(str(path))} ({error.strerror})"
            raise wrong(name, "a path that the system takes", got) from error
    return path
