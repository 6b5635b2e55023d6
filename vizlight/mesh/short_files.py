"""Files that end too early or contradict themselves, which VTK takes for whole or crashes on."""

from __future__ import annotations

import math
import re
import struct
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkGenericCell

from vizlight.mesh import blocks

if TYPE_CHECKING:
    from pathlib import Path

    from vtkmodules.vtkCommonDataModel import vtkCellArray

__all__ = ["contradiction", "missing_part"]

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
        "vtkidtype",
        "bit",
        "float",
        "double",
    ]
)
#: Types of arrays of a field that are not counted in numbers.
_TEXTS = frozenset(("string", "utf8_string", "variant"))
_OF_FIELDS = _TYPES | _TEXTS
#: What the header of an image says, each with a number for each axis, by the words that VTK reads.
_IMAGE = {
    b"DIMENSIONS": b"DIMENSIONS", b"ORIGIN": b"ORIGIN", b"SPACING": b"SPACING",
    b"ASPECT_RATIO": b"SPACING",
}  # fmt: skip
_AXES = 3
#: Least number of corners of a face.
_CORNERS = 3
_LONGEST_HEADER = 10_000
#: Bytes of a legacy file in which the header of an image is looked for.
_LARGEST_FIELD = 1 << 24
#: Words of the header of an array of a field: name, components, rows, type.
_FIELD_WORDS = 4
#: Words of a text that stand for numbers.
_NO_NUMBERS = ("nan", "inf", "infinity")


def missing_part(path: Path, /) -> str:
    """Return what a file lacks of the size or the end that it states.

    These are the XML files of VTK, netCDF 3, DEM, PLY, STL, SU2 and legacy VTK. A cut is not
    seen where it leaves out whole arrays of a legacy file, and in binary PLY files with faces of
    more than three corners.

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
    if suffix in (".nc", ".cdf"):
        return _netcdf(path)
    if suffix not in (".dem", ".ply", ".stl", ".su2", ".vtk", *_XML):
        return ""
    with path.open("rb") as file:
        if suffix in _XML:
            return _xml(file)
        if suffix == ".dem":
            return _dem(file.read())
        if suffix == ".su2":
            return _su2(file)
        if suffix == ".stl":
            return _stl(file, path)
        return _ply(file, path) if suffix == ".ply" else _legacy(file)


#: Suffixes of the XML files of VTK, whose last element may hold raw data.
_XML = (
    *(".vti", ".vtm", ".vtp", ".vtr", ".vts", ".vtu"),
    *(".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"),
)


def _xml(file: BinaryIO) -> str:
    """Look for the end of a file, which stands after its data."""
    if not file.read(100).lstrip().startswith((b"<?xml", b"<VTKFile")):
        return ""  # VTK's reader says so
    file.seek(-min(512, file.seek(0, 2)), 2)
    return "" if b"</VTKFile>" in file.read() else "its end is missing"


def _netcdf(path: Path) -> str:
    """Map each variable of a netCDF 3 file; the library of netCDF takes what is missing for 0."""
    with path.open("rb") as file:
        if file.read(4) not in (b"CDF\x01", b"CDF\x02"):
            return ""  # HDF5, whose reader compares the size
    from scipy.io import netcdf_file

    try:
        netcdf_file(path).close()
    except Exception as error:  # noqa: BLE001 - of any type, by the place of the cut
        return f"a variable is not whole: {error}"
    return ""


#: Number of points of a cell, by VTK's number of its type; other types have any number.
_POINTS = {
    1: 1, 3: 2, 5: 3, 8: 4, 9: 4, 10: 4, 11: 8, 12: 8, 13: 6, 14: 5, 15: 10, 16: 12,
    21: 3, 22: 6, 23: 8, 24: 10, 25: 20, 26: 15, 27: 13, 28: 9, 29: 27, 30: 6, 31: 12, 32: 18,
    33: 24, 34: 7, 35: 4, 37: 19,
}  # fmt: skip


#: Grids that may be empty.
_GRIDS = (pv.StructuredGrid, pv.RectilinearGrid)
#: Last type of linear cells; those in the table have no more points than that.
_LAST_LINEAR = 16


def contradiction(mesh: object, /) -> str:
    """Return what a mesh lacks of what its cells or its dimensions count; empty for nothing.

    What works on such a mesh reads memory of others, or asks for more than there is.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh as its reader returned it.

    Returns
    -------
    str
        Reason why the mesh cannot be used.
    """
    for block in blocks.all_blocks(mesh):
        if block.n_points > _MOST_POINTS:
            return f"{block.n_points} points, more than memory holds"
        least = 1 if isinstance(block, pv.ImageData) else 0
        if isinstance(block, (pv.ImageData, *_GRIDS)) and min(block.dimensions) < least:
            return f"no points: the dimensions are {block.dimensions}"
        if isinstance(block, pv.UnstructuredGrid):
            reason = _of_cells(block.GetCells(), block.n_points) or _of_types(block)
        elif isinstance(block, pv.PolyData):
            cells = (block.GetVerts(), block.GetLines(), block.GetPolys(), block.GetStrips())
            reason = next(filter(None, (_of_cells(own, block.n_points) for own in cells)), "")
        elif isinstance(block, pv.StructuredGrid):
            there = block.GetPoints().GetNumberOfPoints() if block.GetPoints() else 0
            reason = ""
            if there != math.prod(block.dimensions):
                reason = f"{there} points for the dimensions {tuple(block.dimensions)}"
        else:
            continue
        if reason:
            return reason
    return ""


#: Largest number of points of a mesh: half of the addresses that processors have.
_MOST_POINTS = 1 << 40


def _of_cells(cells: vtkCellArray, count: int) -> str:
    """Return how cells contradict their ``count`` points."""
    ids = pv.convert_array(cells.GetConnectivityArray())
    offsets = pv.convert_array(cells.GetOffsetsArray())
    if ids.size and not 0 <= ids.min() <= ids.max() < count:
        return f"cells of the points {ids.min()} to {ids.max()}, but {count} points are there"
    ends = (offsets[0], offsets[-1]) if len(offsets) else (0, 0)
    if ends != (0, len(ids)) or np.any(offsets[1:] < offsets[:-1]):
        return f"cells that do not follow one another among {len(ids)} corners"
    return ""


def _of_types(grid: pv.UnstructuredGrid) -> str:
    """Return how the types of cells contradict their sizes."""
    kinds = np.asarray(grid.celltypes)
    sizes = np.diff(pv.convert_array(grid.GetCells().GetOffsetsArray()))
    if len(kinds) != len(sizes):
        return f"{len(sizes)} cells of {len(kinds)} types"
    for kind in np.flatnonzero(np.bincount(kinds, minlength=1)).tolist():
        own = sizes[kinds == kind]
        least, most = int(own.min()), int(own.max())
        if kind and vtkGenericCell.InstantiateCell(kind) is None:
            return f"cells of the unknown type {kind}"
        if least < _POINTS.get(kind, 0):
            return f"a cell of type {kind} with {least} points"
        if kind in _POINTS and kind <= _LAST_LINEAR and most > _POINTS[kind]:
            return f"a cell of type {kind} with {most} points"
    return ""


def _su2(file: BinaryIO) -> str:
    """Compare the lines after each count with it."""
    name, expected, found = "", 0, 0
    for line in file:
        words = line.decode(errors="replace").split("%")[0].replace("=", " = ").split()
        if "=" not in words:
            found += bool(words)
            continue
        if found < expected:
            break
        name, number = words[0], words[2] if len(words) > 2 else ""
        counts = name in ("NPOIN", "NELEM", "MARKER_ELEMS") and number.isdecimal()
        expected, found = int(number) if counts else 0, 0
    return f"{found} of {expected} lines of {name!r} are there" if found < expected else ""


#: Bytes of a record of an elevation model, of the words before the elevations of a profile, and of
#: an elevation; elevations in the first record of a profile, and in each that follows.
_DEM_RECORD, _DEM_HEAD, _DEM_WORD, _DEM_FIRST, _DEM_NEXT = 1024, 144, 6, 146, 170


def _dem(data: bytes) -> str:
    """Compare the profiles of an elevation model with their number in the header."""

    def number(at: int) -> int:
        word = data[at : at + _DEM_WORD].strip()
        return int(word) if word.isdigit() else 0

    announced, found, at = number(858), 0, _DEM_RECORD
    while found < announced and (count := number(at + 2 * _DEM_WORD)):
        full, rest = divmod(max(count - _DEM_FIRST, 0), _DEM_NEXT)
        last = _DEM_HEAD + _DEM_WORD * min(count, _DEM_FIRST)
        at += _DEM_RECORD * (full + bool(rest))
        if at + (_DEM_WORD * rest or last) > len(data):
            break
        found, at = found + 1, at + _DEM_RECORD
    return f"{found} of {announced} profiles are there" if found < announced else ""


#: Bytes of the header of a binary STL file with its count, and of each triangle.
_STL_HEAD, _STL_TRIANGLE = 84, 50


def _stl(file: BinaryIO, path: Path) -> str:
    head, size = file.read(_STL_HEAD), path.stat().st_size
    if len(head) < _STL_HEAD:
        return ""  # VTK's reader says so
    if head.lstrip()[:5].lower() == b"solid" and b"\0" not in head:
        file.seek(-min(size, 512), 2)
        last = file.read().split()
        return "" if any(b"endsolid" in word.lower() for word in last) else "its end is missing"
    least = _STL_HEAD + _STL_TRIANGLE * struct.unpack("<I", head[-4:])[0]
    return f"{size} of {least} bytes are there" if size < least else ""


def _ply(file: BinaryIO, path: Path) -> str:
    if file.readline().strip() != b"ply":
        return ""  # VTK's reader says so
    text, lines, size = False, 0, 0
    count, faces, kinds = 0, False, list[str]()
    for _ in range(_LONGEST_HEADER):
        line = file.readline()
        words = line.decode(errors="replace").split()
        if not words or not line.endswith(b"\n"):
            return "its header is not whole"
        if words[0] == "end_header":
            return _short(file, path, lines if text else None, size, kinds)
        if words[0] == "format":
            text = words[1:2] == ["ascii"]
        if words[0] == "element" and len(words) == 3 and words[2].isdecimal():
            count, faces = int(words[2]), words[1] == "face"
            lines += count
            kinds = [] if count else kinds
        if words[0] == "property" and len(words) > 2:
            kinds += [words[1]] * bool(count)
            size += count * _least_size(words, corners=_CORNERS if faces else 0)
    return ""


def _least_size(words: list[str], *, corners: int) -> int:
    """Return the least number of bytes of a property."""
    if words[1] != "list":
        return _SIZES.get(words[1], 1)
    return sum(n * _SIZES.get(word, 1) for n, word in zip((1, corners), words[2:4], strict=False))


def _short(file: BinaryIO, path: Path, lines: int | None, size: int, kinds: list[str]) -> str:
    """Return what is missing after the header: lines of a text, bytes of a binary file.

    The last line of a text has a word for each property of the last element, and the members of a
    list that stands alone.
    """
    if lines is None:
        there = path.stat().st_size - file.tell()
        return f"{there} of at least {size} bytes are there" if there < size else ""
    found, last = 0, b""
    for line in filter(bytes.strip, file):
        found, last = found + 1, line
    words = last.split()
    least = len(kinds)
    if kinds == ["list"] and words and words[0].isdigit():
        least += int(words[0])
    if found == lines and len(words) < least:
        return f"{len(words)} of {least} numbers of its last line are there"
    return f"{found} of {lines} lines are there" if found < lines else ""


def _legacy(file: BinaryIO) -> str:
    """Compare the numbers after the last header line of a text with its count."""
    file.readline()
    file.readline()
    text = b"ASCII" in file.readline().upper()
    start = file.tell()
    if short := _image(file) or _tail(file, start, text=text):
        return short
    if not text:
        return ""
    file.seek(start)
    rows, arrays, expected, found, last = 0, 0, 0, 0, ""
    for line in file:
        words = line.decode(errors="replace").split()
        if not words:
            continue
        of_field = len(words) == _FIELD_WORDS and words[3].lower() in _OF_FIELDS
        if not of_field and (not words[0][0].isalpha() or words[0].lower() in _NO_NUMBERS):
            found += len(words)
            continue
        name = words[0].upper()
        if name in ("POINT_DATA", "CELL_DATA") and len(words) > 1 and words[1].isdecimal():
            rows = int(words[1])
        if name == "FIELD":
            arrays = int(words[2]) if len(words) > 2 and words[2].isdecimal() else 0
        arrays -= of_field
        if name != "LOOKUP_TABLE" or len(words) > 2:
            expected, found, last = _count([name, *words[1:]], rows), 0, " ".join(words[:2])
    if found < expected:
        return f"{found} of {expected} numbers of {last!r} are there"
    return f"{arrays} arrays of 'FIELD' are missing" if arrays > 0 else ""


def _image(file: BinaryIO) -> str:
    """Look for the end of the header of an image, which is text in binary files as well."""
    if b"STRUCTURED_POINTS" not in file.readline().upper():
        return ""
    # Arrays of the file itself may stand before it.
    head = file.read(_LARGEST_FIELD)
    first = re.search(rb"(?im)^(?:DIMENSIONS|ORIGIN|SPACING|ASPECT_RATIO)\b", head)
    found: set[bytes] = set()
    for line in head[first.start() :].splitlines(keepends=True) if first else ():
        words = line.upper().split()
        if words and words[0] not in _IMAGE:
            return ""
        if len(words) > _AXES and line.endswith(b"\n"):
            found.add(_IMAGE[words[0]])
    lacking = sorted(set(_IMAGE.values()) - found)
    return f"its header ends without {lacking[0].decode()}" if lacking else ""


def _tail(file: BinaryIO, start: int, *, text: bool) -> str:
    """Look for a header of an array that is cut at the end, on which VTK ends the process."""
    file.seek(max(start, file.seek(0, 2) - _LONGEST_HEADER))
    lines = file.read().splitlines(keepends=True)
    before, last = [b"", b"", *lines][-2:]
    for line, after in ((before, last), (last, b"")):
        words = line.split()
        cut_after = len(after.split()) < _FIELD_WORDS or not after.endswith(b"\n")
        if cut_after and words and words[0].upper() == b"FIELD" and words[2:] != [b"0"]:
            return "it ends in the header of a field"
    cut = re.fullmatch(rb"[!-~]+ \d+(?: \d+(?: \w*)?)?", last)
    return "it ends in the header of an array" if cut and not text else ""


def _count(words: list[str], rows: int) -> int:
    """Return how many numbers follow a header line."""
    numbers = [int(word) for word in words[1:] if word.isdecimal()]
    name = words[0]
    if name in _PER_ROW:
        return _PER_ROW[name] * rows
    if name == "SCALARS":
        return rows * (numbers[-1] if len(words) > 3 and numbers else 1)
    if name in ("COLOR_SCALARS", "TEXTURE_COORDINATES"):
        return rows * (numbers[-1] if len(words) > 2 and numbers else 1)
    if name == "LOOKUP_TABLE":
        return 4 * (numbers[-1] if numbers else 0)
    if name == "POINTS" and numbers:
        return 3 * numbers[0]
    if name in ("X_COORDINATES", "Y_COORDINATES", "Z_COORDINATES", "CELL_TYPES") and numbers:
        return numbers[0]
    if name in ("OFFSETS", "CONNECTIVITY"):
        return 1
    if len(words) == _FIELD_WORDS and words[3].lower() in _TYPES and len(numbers) >= 2:
        return numbers[-1] * numbers[-2]
    return 0
