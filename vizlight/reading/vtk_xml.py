"""Files of VTK's XML that are cut, or hold other numbers than they state."""

from __future__ import annotations

import base64
import math
import mmap
import re
from collections.abc import Iterator
from typing import BinaryIO, Literal

import numpy as np

from vizlight.reading import file_parts

#: Most letters of a number.
_LONGEST = 100
#: Largest ratio of data to what a compressor of VTK makes of them.
_PACKED = 8000


def missing_part(file: BinaryIO) -> str:
    """Return the reason why a file of points and cells is refused, or ""."""
    if not file.read(100).lstrip().startswith((b"<?xml", b"<VTKFile")):
        return ""  # VTK's reader says so
    if b"</VTKFile>" not in file_parts.last(file):
        return "its end is missing"
    # What is packed is at most so much larger.
    most, wrong = _PACKED * file.seek(0, 2), ""
    with file_parts.mapped(file) as text:
        for start in (b" NumberOf", b" index="):
            for match in (_COUNT.match(text, at) for at in file_parts.places(text, start)):
                # Each block takes some bytes, but for those that are empty.
                limit = len(text) if start == b" index=" else most
                if match and not 0 <= int(match[2]) <= limit:
                    wrong = f"{match[1].decode()} is {match[2].decode()}"
        return wrong or next(filter(None, _too_long(text)), "")


def _too_long(text: mmap.mmap | bytes) -> Iterator[str]:
    """Yield the reason for each array with more numbers than VTK reads of it, or than can be.

    Of the corners of cells it makes room for as many as their last offset says.
    """
    end = text.find(b"<AppendedData")
    appended = text.find(b"_", text.find(b">", end)) + 1
    is_raw = b'"raw"' in text[max(end, 0) : appended]
    head, counts, section = dict[str, str](), dict[str, int](), ""
    corners, last = math.inf, 0
    for tag in _ELEMENT.finditer(text, 0, end if end >= 0 else len(text)):
        name = tag[1].decode()
        words = {key.decode(): word.decode("latin-1") for key, word in _WORDS.findall(tag[2])}
        if name == "VTKFile":
            head = words
        elif name == "Piece":
            counts = {key[8:]: int(word) for key, word in words.items() if key in _NUMBERS}
            counts.setdefault("Cells", sum(counts.get(kind, 0) for kind in _KINDS))
            if extent := [int(word) for word in words.get("Extent", "").split()]:
                sizes = [
                    last - first for first, last in zip(extent[::2], extent[1::2], strict=True)
                ]
                counts["Points"] = math.prod(size + 1 for size in sizes)
                counts["Cells"] = math.prod(max(size, 1) for size in sizes)
        elif name != "DataArray":
            # Keys of information stand within arrays.
            section = section if name == "InformationKey" else name
            corners, last = math.inf, 0
        else:
            # Texts have no bits in their name.
            bits = int((re.findall(r"\d+$", words.get("type", "")) or [8])[0])
            kind = _ROWS.get(section, section if words.get("Name") in _SINGLE else "")
            rows = counts.get(kind, 0) if counts.get("Points") else 0
            expected = rows * int(words.get("NumberOfComponents") or 1)
            if words.get("format") == "ascii":
                numbers = text[tag.end() : text.find(b"<", tag.end())]
                there, ends = file_parts.count_words(numbers), numbers[-_LONGEST:].split()[-1:]
                final = int(ends[0]) if ends and ends[0].isdigit() else 0
            else:
                is_inline = words.get("format") == "binary"
                at = tag.end() if is_inline else appended + int(words.get("offset", 0))
                is_bytes = is_raw and not is_inline
                stated, final = _stated(text, at, head, bits // 8, is_raw=is_bytes)
                there = stated * 8 // max(bits, 1)
                if stated > _PACKED * len(text):
                    yield f"the array {words.get('Name', section)!r} has {stated} bytes"
            if there > expected > 0:
                yield f"the array {words.get('Name', section)!r} has {there} numbers for {expected}"
            corners = there if words.get("Name") == "connectivity" else corners
            last = final if words.get("Name") == "offsets" and expected else last
            if last > corners:
                yield f"the cells have {corners} corners, and end at {last}"


def _stated(
    text: mmap.mmap | bytes, at: int, head: dict[str, str], size: int, *, is_raw: bool
) -> tuple[int, int]:
    """Return the number of bytes of an array, which stands before it, and its last number.

    That is 0 where the array is packed, which has check sums.
    """
    order: Literal["big", "little"] = "big" if head.get("byte_order") == "BigEndian" else "little"
    width = 8 if head.get("header_type") == "UInt64" else 4
    numbers = 3 if head.get("compressor") else 1
    data = text[at : at + numbers * width]
    start = at
    if not is_raw:
        # Three bytes are four letters; a header may end in signs for none.
        letters = text[at : at + 100].partition(b"<")[0]
        start += len(letters) - len(letters.lstrip())
        data = base64.b64decode(letters.lstrip()[: numbers * width // 3 * 4 + 4])
    first, block, last = (
        int.from_bytes(data[width * i : width * (i + 1)], order) for i in range(3)
    )
    if numbers > 1:
        if first > len(text):
            raise ValueError(f"an array of {first} blocks")
        return max(first - bool(last), 0) * block + last, 0
    place = width + first - size
    if is_raw:
        end = text[start + place : start + place + size]
    else:
        letters = text[start + place // 3 * 4 : start + (place + size) // 3 * 4 + 4]
        end = base64.b64decode(letters.partition(b"<")[0])[place % 3 :][:size]
    return first, int.from_bytes(end, order)


#: A count or an index of VTK's XML, an element of it, and its attributes.
_COUNT = re.compile(rb' (\w+)="\s*(-?\d+)')
_ELEMENT = re.compile(rb"<(\w+)([^<>]*)>")
_WORDS = re.compile(rb'(\w+)\s*=\s*"([^"]*)"')
#: Kinds of cells, words for their numbers and that of points, and what has a row for each of them.
_KINDS = ("Verts", "Lines", "Strips", "Polys")
_NUMBERS = [f"NumberOf{kind}" for kind in ("Points", "Cells", *_KINDS)]
_ROWS = {"PointData": "Points", "Points": "Points", "CellData": "Cells"}
#: Arrays of one number for each cell.
_SINGLE = ("offsets", "types")


def missing_piece(file: BinaryIO) -> str:
    """Return the reason why a grid is refused, or "".

    Its pieces should cover the whole: VTK leaves memory that none covers uninitialised, and a huge
    whole takes it long.
    """
    if lacks := missing_part(file):
        return lacks
    with file_parts.mapped(file) as text:
        # Binary data follow.
        end = text.find(b"<AppendedData")
        head = text[:end] if end >= 0 else text[:]
    extents = re.finditer(rb'<(?:(Piece)|\w+)[^<>]*?\s(?:Whole)?Extent="([^"]*)"', head)
    whole, *pieces = [(match[1], [int(word) for word in match[2].split()]) for match in extents]
    boxes = np.array([extent for piece, extent in pieces if piece])
    if len(whole[1]) != 6 or boxes.shape[1:] != (6,):
        return "its extents are no six numbers"
    covered = np.where(np.arange(6) % 2, boxes.max(axis=0), boxes.min(axis=0)).tolist()
    return "" if covered == whole[1] else f"its pieces cover {covered} of {whole[1]}"


def missing_block(file: BinaryIO) -> str:
    """Return the reason why an index of blocks is refused, or "".

    Numbers of blocks should not stand twice: VTK keeps the last one.
    """
    if lacks := missing_part(file):
        return lacks
    file.seek(0)
    numbers = [set[bytes]()]
    for end, words, alone in _TAG.findall(file.read()):
        if end:
            numbers.pop()
            continue
        for number in _INDEX.findall(words):
            if number in numbers[-1]:
                return f"two blocks have the index {number.decode()}"
            numbers[-1].add(number)
        if not alone:
            numbers.append(set())
    return ""


#: Tags of XML, and the numbers of blocks in them.
_TAG = re.compile(rb"<(/?)\w+((?:\s[^<>]*?)?)(/?)>")
_INDEX = re.compile(rb'\sindex="\s*(\d+)')
