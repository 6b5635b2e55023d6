"""The user's folder for results found once: compiled code, and backends that draw here."""

from __future__ import annotations

import os
import sys
import tempfile
from functools import lru_cache
from pathlib import Path


def folder(*parts: str) -> Path | None:
    """Return a folder for kept results, made if needed, or None where none can be.

    It is in ``vizlight`` in ``$XDG_CACHE_HOME``, or in the system's folder for caches.
    """
    home = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA", "")
    if not home:
        place = "Library/Caches" if sys.platform == "darwin" else ".cache"
        home = str(Path.home() / place)
    return _writable(Path(home, "vizlight", *parts))


@lru_cache(maxsize=512)
def _writable(path: Path) -> Path | None:
    """Return a folder, made if needed; None if no file can be written to it."""
    # By the specification of XDG a relative path is invalid.
    if not path.is_absolute():
        return None
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
        # A file is made, because permissions do not tell of a full or a read-only disk.
        with tempfile.TemporaryFile(dir=path):
            return path
    except OSError:
        return None
