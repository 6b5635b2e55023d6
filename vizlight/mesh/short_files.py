"""Files that end too early, of which VTK's reader invents the rest, or ends the process."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["missing_part"]

_SIZES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "int32", "uint32", "float", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
#: Numbers for each point or cell that follow a header of a legacy file.
_PER_ROW = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6}
_TYPES = frozenset(
    [
        "char",
        "unsigned_char",
        "short",
        "unsigned_short",
        "int",
        "unsigned_int",
        "long",
        "unsigned_long",
        "vtktypeint64",
        "vtktypeuint64",
        "vtkIdType",
        "float",
        "double",
    ]
)
#: Least number of corners of a face.
_CORNERS = 3
_LONGEST_HEADER = 10_000


def missing_part(path: Path, /) -> str:
    """Return what a PLY file or a legacy VTK file of text lacks of what its headers count.

    A cut is not seen where it leaves out whole arrays, and in binary PLY files with faces of more
    than three corners.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.

    Returns
    -------
    str
        Reason why the file cannot be whole; empty if it may be, or is of another format.
    """
    suffix = path.suffix.lower()
    if suffix not in (".ply", ".vtk"):
        return ""
    with path.open("rb") as file:
        return _ply(file, path) if suffix == ".ply" else _legacy(file)


def _ply(file: BinaryIO, path: Path) -> str:
    if file.readline().strip() != b"ply":
        return ""  # VTK's reader says so
    text, lines, size = False, 0, 0
    count, faces = 0, False
    for _ in range(_LONGEST_HEADER):
        words = file.readline().decode(errors="replace").split()
        if not words:
            return ""
        if words[0] == "end_header":
            return _short(file, path, lines if text else None, size)
        if words[0] == "format":
            text = words[1:2] == ["ascii"]
        if words[0] == "element" and len(words) == 3 and words[2].isdecimal():
            count, faces = int(words[2]), words[1] == "face"
            lines += count
        if words[0] == "property" and len(words) > 2:
            size += count * _least_size(words, corners=_CORNERS if faces else 0)
    return ""


def _least_size(words: list[str], *, corners: int) -> int:
    """Return the least number of bytes of a property."""
    if words[1] != "list":
        return _SIZES.get(words[1], 1)
    return sum(n * _SIZES.get(word, 1) for n, word in zip((1, corners), words[2:4], strict=False))


def _short(file: BinaryIO, path: Path, lines: int | None, size: int) -> str:
    """Return what is missing after the header: lines of a text, bytes of a binary file."""
    if lines is None:
        there = path.stat().st_size - file.tell()
        return f"{there} of at least {size} bytes are there" if there < size else ""
    found = sum(1 for line in file if line.strip())
    return f"{found} of {lines} lines are there" if found < lines else ""


def _legacy(file: BinaryIO) -> str:
    """Compare the numbers after the last header line of a text with its count."""
    if b"ASCII" not in file.readline() + file.readline() + file.readline():
        return ""
    rows, expected, found, last = 0, 0, 0, ""
    for line in file:
        words = line.decode(errors="replace").split()
        if not words:
            continue
        if not (words[0][0].isalpha() or (len(words) == 4 and words[3] in _TYPES)):
            found += len(words)
            continue
        if words[0] in ("POINT_DATA", "CELL_DATA") and len(words) > 1 and words[1].isdecimal():
            rows = int(words[1])
        if words[0] != "LOOKUP_TABLE":
            expected, found, last = _count(words, rows), 0, " ".join(words[:2])
    return f"{found} of {expected} numbers of {last!r} are there" if found < expected else ""


def _count(words: list[str], rows: int) -> int:
    """Return how many numbers follow a header line."""
    numbers = [int(word) for word in words[1:] if word.isdecimal()]
    name = words[0]
    if name in _PER_ROW:
        return _PER_ROW[name] * rows
    if name == "SCALARS":
        return rows * (numbers[-1] if len(words) > 3 and numbers else 1)
    if name == "POINTS" and numbers:
        return 3 * numbers[0]
    if name in ("X_COORDINATES", "Y_COORDINATES", "Z_COORDINATES", "CELL_TYPES") and numbers:
        return numbers[0]
    if name in ("OFFSETS", "CONNECTIVITY"):
        return 1
    if len(words) == 4 and words[3] in _TYPES and len(numbers) >= 2:
        return numbers[-1] * numbers[-2]
    return 0
