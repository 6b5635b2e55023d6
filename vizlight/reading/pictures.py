"""Pictures that are shorter than their width and height, or damaged: PNG, BMP and PNM."""

from __future__ import annotations

import re
import struct
import zlib
from pathlib import Path
from typing import BinaryIO

from vizlight.reading import file_parts

#: Bytes in which a header stands that has no end of its own.
_HEAD = 4096


def missing_of_png(file: BinaryIO) -> str:
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


def missing_of_bmp(file: BinaryIO) -> str:
    """Compare a picture with its width and height, of which VTK's reader makes room."""
    if file.read(2) != b"BM":
        return ""  # VTK's reader says so
    start, length, width, height, bits = struct.unpack("<8xIIii2xH", file.read(28))
    if length < 40:
        return ""  # of the oldest kind, with sizes of 2 bytes
    if width < 1:
        return f"it is {width} pixels wide"
    # Rows are filled up to 4 bytes.
    return file_parts.missing_bytes(file, start + (width * bits + 31) // 32 * 4 * abs(height))


def missing_of_pnm(file: BinaryIO) -> str:
    """Compare a picture with its width and height."""
    head = file.read(_HEAD)
    gap = rb"(?:\s|#[^\n]*\n)+"
    match = re.match(rb"P([1-6])" + gap + rb"(\d+)" + gap + rb"(\d+)\s(?:\s*(\d+)\s)?", head)
    if not match:
        return "its width and height are missing"
    kind, columns, rows, most = (int(word or 0) for word in match.groups())
    if kind in _CHANNELS and most:
        width = _CHANNELS[kind] * (1 if most < 256 else 2)
        end = match.end() + columns * rows * width
        file_parts.warn_of_more(Path(file.name), file.seek(0, 2) - end, "bytes")
        return file_parts.missing_bytes(file, end)
    # A bit is the least for each pixel.
    return file_parts.missing_bytes(file, columns * rows // 8)


#: Numbers of a pixel of binary pictures in gray and in colours.
_CHANNELS = {5: 1, 6: 3}
