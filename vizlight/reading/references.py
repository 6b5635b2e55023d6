"""Files that a file names and that are read with it."""

from __future__ import annotations

import os
import re
from pathlib import Path
from urllib.parse import unquote

#: Patterns of the names of other files in the formats that have them, by suffix.
_NAMED = {
    **dict.fromkeys(
        (".vtm", ".vtmb", ".vtpd", ".pvd", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"),
        rb"\s(?:file|Source)\s*=\s*[\"']([^\"']+)[\"']",
    ),
    ".gltf": rb"\"uri\"\s*:\s*\"(?!data:)([^\"]+)\"",
    **dict.fromkeys((".xmf", ".xdmf"), rb">\s*([^<>:\s]+)\s*:/"),
    ".inp": rb"(?im)^\*(?:INCLUDE|NODE|ELEMENT)\b[^\n]*?\bINPUT\s*=\s*\"?([^\s,\"]+)",
    ".case": rb"(?im)^\s*(?:model|measured|match|boundary)\s*:\s*(?:\d+\s+)*(\S+)",
    ".series": rb"\"name\"\s*:\s*\"([^\"]+)\"",
    ".mhd": rb"(?im)^ElementDataFile\s*=\s*(?!LOCAL|LIST)(\S+)",
    ".nhdr": rb"(?im)^data ?file:\s*(?!LIST)(\S+)",
}


def named(path: Path) -> dict[Path, str]:
    """Return the files that a file takes, with their names in it; links are not followed."""
    pattern = _NAMED.get(path.suffix.lower())
    if pattern is None:
        return {}
    names = {unquote(os.fsdecode(name)) for name in re.findall(pattern, path.read_bytes())}
    folder = path.parent.absolute()
    return {Path(os.path.normpath(folder / name)): name for name in names}


def outside(path: Path) -> list[str]:
    """Return the names of the files that a file takes from elsewhere than its own folder."""
    # By the words alone, as links within the folder are its owner's.
    folder = path.parent.absolute()
    return sorted(name for place, name in named(path).items() if not place.is_relative_to(folder))
