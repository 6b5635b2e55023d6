"""Files of STL: their end, and the number of their triangles."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

from vizlight.reading import file_parts

#: Bytes of the header of a binary STL file with its count, and of each triangle.
_STL_HEAD, _STL_TRIANGLE = 84, 50


def missing_part(file: BinaryIO) -> str:
    """Return the part that a file lacks of its triangles, or the last word of its text."""
    head = file.read(_STL_HEAD)
    if len(head) < _STL_HEAD:
        return ""  # VTK's reader says so
    if _is_text_of_stl(head):
        return "" if b"endsolid" in file_parts.last(file).lower() else "its end is missing"
    return file_parts.missing_bytes(file, _STL_HEAD + _STL_TRIANGLE * _stl_count(head))


def _is_text_of_stl(head: bytes) -> bool:
    """Return whether a file is text; binary ones may begin with this word, but have bytes of 0."""
    return head.lstrip()[:5].lower() == b"solid" and b"\0" not in head


def _stl_count(head: bytes) -> int:
    return int.from_bytes(head[_STL_HEAD - 4 : _STL_HEAD], "little")


#: Word after each triangle of a text, and number of bytes of it that are looked at at once.
_END_OF_FACET, _STL_BLOCK = b"endfacet", 1 << 20


def triangles(path: Path, /) -> int:
    """Return the number of triangles of an STL file, of which VTK leaves out those without area."""
    with path.open("rb") as file:
        block = file.read(_STL_HEAD)
        if not _is_text_of_stl(block):
            return _stl_count(block)
        count, rest = 0, b""
        while block:
            # A word may begin at the end of the block before.
            text = rest + block.lower()
            count, rest = count + text.count(_END_OF_FACET), text[1 - len(_END_OF_FACET) :]
            block = file.read(_STL_BLOCK)
    return count
