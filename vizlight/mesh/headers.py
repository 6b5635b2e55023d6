"""Headers that readers of VTK and meshio trust: a wrong number ends the process, or never ends.

Each function takes an open file and returns the reason why it is refused, an empty text if none is.
"""

from __future__ import annotations

import contextlib
import math
import mmap
import os
import re
import struct
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

__all__ = ["FORMATS", "mapped", "places", "size"]

#: Bytes in which a header stands that has no end of its own.
_HEAD = 4096
#: Bytes of a number by a part of the name of its type: the first that is in it.
_BYTES = {
    "64": 8, "32": 4, "16": 2, "int8": 1, "idtype": 4, "char": 1, "short": 2, "long_long": 8,
    "long long": 8, "longlong": 8, "long": 4, "int": 4, "float": 4, "double": 8,
}  # fmt: skip


@contextlib.contextmanager
def mapped(file: BinaryIO) -> Iterator[mmap.mmap | bytes]:
    """Return the content of a file, which is not read at once.

    Parameters
    ----------
    file : binary file
        File that is open.
    """
    if not file.seek(0, 2):
        yield b""
        return
    with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        yield text


def places(text: mmap.mmap | bytes, word: bytes) -> Iterator[int]:
    """Return the places of a word.

    Parameters
    ----------
    text : mmap.mmap or bytes
        Content of a file.
    word : bytes
        Word.
    """
    at = text.find(word)
    while at >= 0:
        yield at
        at = text.find(word, at + 1)


def size(file: BinaryIO, least: int) -> str:
    """Compare the size of a file with the least that it states.

    Parameters
    ----------
    file : binary file
        File that is open.
    least : int
        Least number of bytes.
    """
    count = file.seek(0, 2)
    return f"{count} of {least} bytes are there" if count < least else ""


def _png(file: BinaryIO) -> str:
    """Check the parts of a picture, each of which has a check sum."""
    if file.read(8) != b"\x89PNG\r\n\x1a\n":
        return ""  # VTK's reader says so
    kind = b""
    while kind != b"IEND":
        count, kind = struct.unpack(">I4s", file.read(8))
        part = file.read(count)
        if file.read(4) != zlib.crc32(kind + part).to_bytes(4, "big"):
            return "a check sum is not that of its part"
    return ""


def _pnm(file: BinaryIO) -> str:
    """Compare a picture with its width and height."""
    head = file.read(_HEAD)
    gap = rb"(?:\s|#[^\n]*\n)+"
    match = re.match(rb"P[1-6]" + gap + rb"(\d+)" + gap + rb"(\d+)\s", head)
    if not match:
        return "its width and height are missing"
    # A bit is the least for each pixel.
    return size(file, int(match[1]) * int(match[2]) // 8)


def _fields(lines: Sequence[bytes], between: str) -> dict[str, str]:
    texts = [line.decode("utf-8", "surrogateescape").partition(between) for line in lines]
    return {key.strip(): rest.strip() for key, found, rest in texts if found}


def _nrrd(file: BinaryIO) -> str:
    head, blank, _ = file.read(1 << 16).replace(b"\r\n", b"\n").partition(b"\n\n")
    lines = [line for line in head.split(b"\n") if not line.startswith(b"#") and b":=" not in line]
    fields = _fields(lines, ": ")
    if len(fields) < sum(b": " in line for line in lines):
        return "a key stands twice"
    sizes = [int(word) for word in fields["sizes"].split()]
    other = fields.get("data file", fields.get("datafile", ""))
    if not (blank or other):
        return "its header has no end"
    if len(sizes) != int(fields["dimension"]):
        return f"{len(sizes)} sizes for {fields['dimension']} dimensions"
    if fields["encoding"].lower() not in ("raw", "gzip", "gz"):
        return ""
    is_raw = fields["encoding"].lower() == "raw"
    return _data(file, sizes, fields["type"], other, is_raw)


def _meta(file: BinaryIO) -> str:
    # Some have fields for each of many pictures.
    lines = file.read(1 << 20).split(b"\n")
    last = [at for at, line in enumerate(lines) if line.startswith(b"ElementDataFile")]
    if not last:
        return "" if file.read(1) else "its header has no end"
    fields = _fields(lines[: last[0] + 1], "=")
    sizes = [int(word) for word in fields["DimSize"].split()]
    if len(sizes) != int(fields["NDims"]):
        return f"{len(sizes)} sizes for {fields['NDims']} dimensions"
    is_raw = fields.get("CompressedData", "").lower() != "true"
    other = fields["ElementDataFile"]
    other = "" if other.lower() == "local" else other
    sizes.append(int(fields.get("ElementNumberOfChannels", "1")))
    return _data(file, sizes, fields["ElementType"], other, is_raw)


def _data(file: BinaryIO, sizes: Sequence[int], kind: str, other: str, is_raw: bool) -> str:
    """Compare the sizes of an image with those of its data, in this file or another beside it."""
    if min(sizes) < 1:
        return f"its sizes are {sizes}"
    width = next((count for word, count in _BYTES.items() if word in kind.lower()), 1)
    least = math.prod(sizes) * width
    if not is_raw:
        # A zip makes data at most 1032 times smaller.
        least //= 1032
    # A name may be a pattern of several, or a list of them.
    if not other or "%" in other or other.startswith("LIST"):
        return size(file, 0 if other else least)
    path = Path(file.name).parent / other
    if not path.is_file():
        return f"its data in '{other}' are missing"
    with path.open("rb") as data:
        return size(data, least)


def _pdb(file: BinaryIO) -> str:
    """Check the columns of numbers of molecules, whose places are fixed."""
    whole, place = re.compile(rb"\s*[+-]?\d"), re.compile(rb"\s*[+-]?\d+\.?\d*")
    for line in file:
        if line.startswith((b"ATOM", b"HETATM")):
            places = [line[at : at + 8] for at in (30, 38, 46)]
            good = line[:54].isascii() and all(map(place.fullmatch, places))
            good = good and whole.match(line[22:26]) is not None
        elif line.startswith((b"HELIX", b"SHEET")):
            start = 21 if line.startswith(b"HELIX") else 22
            good = all(map(whole.match, (line[start : start + 4], line[33:37])))
        else:
            continue
        if not good:
            return f"no numbers in the columns of the line {line[:60]!r}"
    return ""


#: Corners of a cell of Tecplot by its name.
_CORNERS = {b"TRIANGLE": 3, b"QUADRILATERAL": 4, b"TETRAHEDRON": 4, b"BRICK": 8}


def _tecplot(file: BinaryIO) -> str:
    """Compare the counts of zones with the numbers in the file."""
    data = file.read()
    names = re.search(rb"(?is)VARIABLES\s*=(.*?)^\s*ZONE", data, re.MULTILINE)
    zones = re.findall(rb"(?im)^\s*ZONE\b([^\n]*(?:\n[^\n]*=[^\n]*)*)", data)
    if names is None:
        return "no VARIABLES and ZONE are in it"
    # Some zones share variables, have some at cells, or repeat numbers.
    if re.search(rb"(?i)\*|VARSHARE|VARLOCATION", data):
        return ""
    columns = len(re.findall(rb'"[^"]*"|[^\s,"]+', names[1]))
    least = 0
    for zone in zones:
        pairs = re.findall(rb"(?i)\b(N|NODES|E|ELEMENTS|I|J|K)\s*=\s*(-?\d+)", zone)
        counts = {key.upper(): int(word) for key, word in pairs}
        if min(counts.values(), default=0) < 0:
            return "a count of a zone is negative"
        kind = re.search(rb"(?i)\bET\s*=\s*(\w+)", zone)
        corners = _CORNERS.get(kind[1].upper(), 0) if kind else 0
        points = counts.get(b"N", counts.get(b"NODES", math.prod(counts.get(k, 1) for k in _IJK)))
        cells = counts.get(b"E", counts.get(b"ELEMENTS", 0))
        least += points * columns + cells * corners
    there = len(data.replace(b",", b" ").split())
    return f"{there} of {least} numbers are there" if there < least else ""


_IJK = (b"I", b"J", b"K")


def _mdpa(file: BinaryIO) -> str:
    """Count the ends of blocks."""
    words = re.findall(rb"(?m)^[ \t]*(Begin|End)\b", file.read())
    lacking = words.count(b"Begin") - words.count(b"End")
    return f"the ends of {lacking} of its blocks are missing" if lacking else ""


#: Words of an EnSight case that stand alone in a line.
_SECTIONS = (
    b"FORMAT", b"GEOMETRY", b"VARIABLE", b"TIME", b"FILE", b"MATERIAL", b"BLOCK_CONTINUATION",
    b"SCRIPTS",
)  # fmt: skip


def _ensight(file: BinaryIO) -> str:
    """Check the lines of a case, and the files that it names for their parts."""
    folder, section = Path(file.name).parent, b""
    parts: set[bytes] | None = None
    for line in file.read().splitlines():
        head, colon, rest = line.partition(b"#")[0].partition(b":")
        words = [word for word in rest.split() if not word.isdigit()]
        if head.strip().upper() in _SECTIONS and not colon:
            section = head.strip().upper()
        elif not colon and not re.fullmatch(rb"[\s\d.eE+-]*", head):
            return f"no such section as {line[:40]!r}"
        elif words and section in (b"GEOMETRY", b"VARIABLE"):
            # Stars stand for the digits of a step; numbers without a file, and pairs of files.
            if b"*" in rest or b'"' in rest or re.match(rb"\s*(constant|complex)", head):
                continue
            name = os.fsdecode(words[0 if section == b"GEOMETRY" else -1])
            if not (folder / name).is_file():
                return f"it names {name!r}, which is missing"
            found = _parts(folder / name)
            parts = found if section == b"GEOMETRY" else parts
            if found is not None and parts is not None and (other := found - parts):
                return f"{name!r} has the part {min(other)!r}, which the geometry has not"
    return ""


def _parts(path: Path) -> set[bytes] | None:
    """Return the numbers of the parts in a file of text of EnSight, None of another one."""
    data = path.read_bytes()
    if b"Binary" in data[:80]:
        return None
    return {word.strip() for word in re.findall(rb"(?m)^part[ \t]*\r?$\s?([^\n]*)", data)}


def _obj(file: BinaryIO) -> str:
    with mapped(file) as text:
        return "it has bytes of 0, and text has none" if text.find(b"\0") >= 0 else ""


def _legacy(file: BinaryIO) -> str:
    """Count the numbers of the arrays of fields, without which VTK's reader ends the process."""
    is_text = b"ASCII" in b"".join(file.read(_HEAD).splitlines()[2:3]).upper()
    with mapped(file) as data:
        reasons = (_field(data, at, is_text) for at in places(data, b"\nFIELD "))
        return next(filter(None, reasons), "")


def _field(data: mmap.mmap | bytes, at: int, is_text: bool) -> str:
    """Return the reason why a field that begins at a place is not whole."""
    head = re.compile(rb"\sFIELD[ \t]+\S+[ \t]*(\d*)").match(data, at)
    at = at if head is None else head.end()
    for _ in range(0 if head is None else int(head[1] or 1)):
        array = _ARRAY.match(data, at)
        if array is None:
            return "an array of a field is missing"
        count, kind, at = int(array[1]) * int(array[2]), array[3].decode().lower(), array.end()
        if "string" in kind or kind in ("bit", "long", "unsigned_long"):
            return ""
        if is_text:
            word = _WORD.search(data, at)
            end = len(data) if word is None else word.start()
            there = len(data[at:end].split())
            if _ODD.search(data, at, end):
                return "words stand among the numbers of a field"
        else:
            width = next((count for part, count in _BYTES.items() if part in kind), 1)
            there, end = (len(data) - at) // width, at + count * width
        if there < count:
            return f"{there} of {count} numbers of an array of a field are there"
        at = end
    return ""


#: Header of an array of a field in a legacy file, with what VTK knows of the array before it.
_ARRAY = re.compile(
    rb"(?:\s*METADATA\b.*?\n\r?\n)?\s*\S+\s+(\d+)\s+(\d+)\s+(\w+)[^\n]*\n", re.DOTALL
)
#: What is no part of a number in text, and a line that does not begin with one.
_ODD = re.compile(rb"(?i)[\x80-\xff]|[ \t](?!nan|inf)[a-z_]")
_WORD = re.compile(rb"(?mi)^[ \t]*(?!nan|inf)[a-z_%]")
FORMATS: dict[str, Callable[[BinaryIO], str]] = {
    ".case": _ensight, ".vtk": _legacy, ".mdpa": _mdpa, ".obj": _obj, ".pdb": _pdb, ".png": _png,
    **dict.fromkeys((".nrrd", ".nhdr"), _nrrd),
    **dict.fromkeys((".mha", ".mhd"), _meta),
    **dict.fromkeys((".pnm", ".pgm", ".ppm"), _pnm),
    **dict.fromkeys((".dat", ".tec"), _tecplot),
}  # fmt: skip
