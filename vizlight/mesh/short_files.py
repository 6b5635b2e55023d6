"""Files that are shorter than they state, and meshes that contradict themselves.

Readers say most of what is wrong with a file. This is what they take for whole, or crash on.
"""

from __future__ import annotations

import math
import re
import struct
from typing import TYPE_CHECKING, BinaryIO, Literal

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkGenericCell

from vizlight.mesh import blocks, series
from vizlight.vtk.cells import cell_arrays, connectivity

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from vtkmodules.vtkCommonDataModel import vtkCellArray

__all__ = ["contradiction", "missing_part"]

#: Bytes of the numbers of PLY by the first letters of their types.
_SIZES = {"char": 1, "uchar": 1, "int8": 1, "uint8": 1, "short": 2, "ushort": 2, "int16": 2,
          "uint16": 2, "double": 8, "float64": 8}  # fmt: skip
_WORD = 4
#: Bytes at the start and at the end of a file in which its header and its last words stand.
_HEAD, _END = 100_000, 512


def missing_part(path: Path, /) -> str:
    """Return what a file lacks of the size or the end that it states.

    These are the XML files of VTK, netCDF, HDF5, DEM, PLY, STL, SU2 and Medit.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.

    Returns
    -------
    str
        Reason why the file cannot be whole; empty if it may be, or is of another format.
    """
    lacks = _FORMATS.get(path.suffix.lower())
    if lacks is None:
        return ""
    with path.open("rb") as file:
        try:
            return lacks(file)
        except (IndexError, ValueError, struct.error) as error:
            return f"its header cannot be read: {error}"


def _size(file: BinaryIO, least: int) -> str:
    """Compare the size of a file with the least that it states."""
    size = file.seek(0, 2)
    return f"{size} of {least} bytes are there" if size < least else ""


def _last(file: BinaryIO) -> bytes:
    """Return the last bytes of a file."""
    file.seek(-min(_END, file.seek(0, 2)), 2)
    return file.read()


def _xml(file: BinaryIO) -> str:
    """Look for the end of a file, which stands after its data."""
    if not file.read(100).lstrip().startswith((b"<?xml", b"<VTKFile")):
        return ""  # VTK's reader says so
    return "" if b"</VTKFile>" in _last(file) else "its end is missing"


#: First bytes of netCDF 3 files that SciPy maps, of others, and of HDF5 files.
_CLASSIC, _LARGE, _HDF = (b"CDF\x01", b"CDF\x02"), b"CDF\x05", b"\x89HDF\r\n\x1a\n"
#: Place of the end of the file in the first block of HDF5, by the version of the block.
_HDF_END = {0: 40, 1: 44, 2: 28, 3: 28}


def _netcdf(file: BinaryIO) -> str:
    """Map each variable of a netCDF 3 file; the library of netCDF takes what is missing for 0."""
    head = file.read(64)
    if head.startswith(_HDF):
        at = _HDF_END.get(head[8] if len(head) > 8 else -1, len(head))
        end = int.from_bytes(head[at : at + 8], "little")
        return _size(file, end) if end else "its header is not whole"
    if head.startswith(_LARGE):
        return ""
    if not head.startswith(_CLASSIC):
        return "neither netCDF nor HDF5"
    from scipy.io import netcdf_file

    try:
        netcdf_file(file.name).close()
    except Exception as error:  # noqa: BLE001 - of any type, by the place of the cut
        return f"a variable is not whole: {error}"
    return ""


#: Bytes of the header of a binary STL file with its count, and of each triangle.
_STL_HEAD, _STL_TRIANGLE = 84, 50


def _stl(file: BinaryIO) -> str:
    head = file.read(_STL_HEAD)
    if len(head) < _STL_HEAD:
        return ""  # VTK's reader says so
    if head.lstrip()[:5].lower() == b"solid" and b"\0" not in head:
        return "" if b"endsolid" in _last(file).lower() else "its end is missing"
    return _size(file, _STL_HEAD + _STL_TRIANGLE * struct.unpack("<I", head[-4:])[0])


def _ply(file: BinaryIO) -> str:
    """Compare the lines or the bytes after the header with its counts."""
    whole = re.match(rb"ply\s.*?^end_header\r?\n", file.read(_HEAD), re.DOTALL | re.MULTILINE)
    file.seek(0)
    if whole is None:
        return "its header is not whole" if file.read(3) == b"ply" else ""  # VTK's reader says so
    file.seek(whole.end())
    form, elements = "", list[tuple[int, list[list[str]]]]()
    for words in (line.split() for line in whole[0].decode("latin-1").splitlines()):
        if words[:1] == ["format"]:
            form = words[1]
        elif words[:1] == ["element"] and words[-1].isdecimal():
            elements.append((int(words[-1]), []))
        elif words[:1] == ["property"] and elements:
            elements[-1][1].append(words[1:-1])
    elements = [(count, kinds) for count, kinds in elements if count]
    if form != "ascii":
        order: Literal["big", "little"] = "big" if "big" in form else "little"
        return _size(file, whole.end() + _least_bytes(file.read(), elements, order))
    lines = sum(count for count, _ in elements)
    rows = [line for line in file if line.strip()]
    if len(rows) < lines:
        return f"{len(rows)} of {lines} lines are there"
    last, kinds = rows[-1].split() if rows else [], elements[-1][1] if elements else []
    least = len(kinds)
    if least == 1 and kinds[0][0] == "list" and last[0].isdigit():
        least += int(last[0])
    return f"{len(last)} of {least} numbers of its last line are there" if len(last) < least else ""


def _least_bytes(
    data: bytes, elements: list[tuple[int, list[list[str]]]], order: Literal["big", "little"]
) -> int:
    """Return the bytes of binary elements, of which all but the first list have their least."""
    at = 0
    for count, kinds in elements:
        lists = [i for i, kind in enumerate(kinds) if kind[0] == "list"]
        flat = sum(_SIZES.get(kind[0], _WORD) for kind in kinds if kind[0] != "list")
        if not lists:
            at += count * flat
            continue
        before = sum(_SIZES.get(kind[0], _WORD) for kind in kinds[: lists[0]])
        of_count, each = (_SIZES.get(word, _WORD) for word in kinds[lists[0]][1:3])
        for _ in range(count):
            there = data[at + before : at + before + of_count]
            at += flat + of_count + each * int.from_bytes(there, order)
            if at > len(data):
                break
    return at


#: Words before the lines that a count tells of, in SU2 and in Medit.
_COUNT = re.compile(
    rb"(?im)^\s*(NPOIN|NELEM|MARKER_ELEMS|Vertices|Edges|Triangles|Quadrilaterals|Tetrahedra"
    rb"|Hexahedra)[\s=]+(\d+)[^\n]*$"
)


def _counted(file: BinaryIO) -> str:
    """Compare the lines after the last count of a text with it."""
    text = file.read()
    counts = [*_COUNT.finditer(text)]
    for found in counts[-1:]:
        stated = int(found[2])
        there = sum(bool(line.strip()) for line in text[found.end() :].split(b"\n"))
        if there < stated:
            return f"{there} of {stated} lines of {found[1].decode()!r} are there"
    return ""


def _paired(file: BinaryIO) -> str:
    """Look for the end of each part of an MDPA file, which meshio would look for without end."""
    text = file.read()
    begun, ended = (len(re.findall(word, text, re.MULTILINE)) for word in _PAIR)
    return f"{ended} of {begun} parts have an end" if ended < begun else ""


_PAIR = rb"^\s*Begin\s", rb"^\s*End\s+\w"


def _medit(file: BinaryIO) -> str:
    """Follow the sections of a binary Medit file; each names the place of the next."""
    head = file.read(8)
    if len(head) < 8:
        return "its header is not whole"
    order, wide = "<" if head[:1] == b"\1" else ">", head[4] > 2 or head[7] > 2
    section, end, place, size = f"{order}i{'q' if wide else 'i'}", 54, 8, file.seek(0, 2)
    while 0 < place < size:
        file.seek(place)
        words = file.read(struct.calcsize(section))
        if words[:4] == struct.pack(f"{order}i", end):
            return ""
        if len(words) < struct.calcsize(section):
            break
        place = struct.unpack(section, words)[1]
    return f"{size} of more than {place} bytes are there"


#: Bytes of a record of an elevation model, of the words before the elevations of a profile, and of
#: an elevation; elevations in the first record of a profile, and in each that follows.
_DEM_RECORD, _DEM_HEAD, _DEM_WORD, _DEM_FIRST, _DEM_NEXT = 1024, 144, 6, 146, 170


def _dem(file: BinaryIO) -> str:
    """Compare the profiles of an elevation model with their number in the header."""
    data = file.read()

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


_FORMATS: dict[str, Callable[[BinaryIO], str]] = {
    **dict.fromkeys((".vti", ".vtm", ".vtp", ".vtr", ".vts", ".vtu"), _xml),
    **dict.fromkeys((".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"), _xml),
    **dict.fromkeys((".nc", ".cdf", ".e", ".ex2", ".exo", ".exii", ".vtkhdf", ".hdf"), _netcdf),
    **dict.fromkeys((".su2", ".mesh"), _counted),
    ".dem": _dem,
    ".mdpa": _paired,
    ".meshb": _medit,
    ".ply": _ply,
    ".stl": _stl,
}

#: Largest number of points of a mesh: half of the addresses that processors have.
_MOST_POINTS = 1 << 40
#: Field arrays that a reader adds.
_ADDED = (series.TIME, series.STEPS)
#: Words of a text that stand for numbers.
_NO_NUMBERS = (b"nan", b"inf", b"infinity")
#: Number of points of a cell, by VTK's number of its type; other types have any number.
_POINTS = {
    1: 1, 3: 2, 5: 3, 8: 4, 9: 4, 10: 4, 11: 8, 12: 8, 13: 6, 14: 5, 15: 10, 16: 12,
    21: 3, 22: 6, 23: 8, 24: 10, 25: 20, 26: 15, 27: 13, 28: 9, 29: 27, 30: 6, 31: 12, 32: 18,
    33: 24, 34: 7, 35: 4, 37: 19,
}  # fmt: skip
#: Last type of linear cells; those in the table have no more points than that.
_LAST_LINEAR = 16


def contradiction(mesh: object, path: Path, /) -> str:
    """Return what a mesh lacks of what its cells, its dimensions or its file count.

    What works on such a mesh reads memory of others, or asks for more than there is.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh as its reader returned it.
    path : pathlib.Path
        Its file.

    Returns
    -------
    str
        Reason why the mesh cannot be used; empty if there is none.
    """
    for block in blocks.all_blocks(mesh):
        if block.n_points > _MOST_POINTS:
            return f"{block.n_points} points, more than memory holds"
        least = 1 if isinstance(block, pv.ImageData) else 0
        if hasattr(block, "dimensions") and min(block.dimensions) < least:
            return f"no points: the dimensions are {block.dimensions}"
        if isinstance(block, pv.StructuredGrid):
            there = block.GetPoints().GetNumberOfPoints() if block.GetPoints() else 0
            if there != math.prod(block.dimensions):
                return f"{there} points for the dimensions {tuple(block.dimensions)}"
        reasons = [_of_cells(cells, block.n_points) for cells in cell_arrays(block)]
        if isinstance(block, pv.UnstructuredGrid) and not any(reasons):
            reasons.append(_of_types(block))
        if reason := next(filter(None, reasons), ""):
            return reason
        if path.suffix.lower() == ".vtk" and (reason := _of_text(block, path)):
            return reason
    return ""


def _of_cells(cells: vtkCellArray, count: int) -> str:
    """Return how cells contradict their ``count`` points."""
    ids, offsets = connectivity(cells)
    if len(offsets) > 1 and not ids.size:
        return f"{len(offsets) - 1} cells without a corner"
    if ids.size and not 0 <= ids.min() <= ids.max() < count:
        return f"cells of the points {ids.min()} to {ids.max()}, but {count} points are there"
    ends = (offsets[0], offsets[-1]) if len(offsets) else (0, 0)
    if ends != (0, len(ids)) or np.any(offsets[1:] < offsets[:-1]):
        return f"cells that do not follow one another among {len(ids)} corners"
    return ""


def _of_types(grid: pv.UnstructuredGrid) -> str:
    """Return how the types of cells contradict their sizes."""
    kinds = np.asarray(grid.celltypes)
    sizes = np.diff(connectivity(grid.GetCells())[1])
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


def _of_text(block: pv.DataSet, path: Path) -> str:
    """Compare the numbers of a legacy file of text with its mesh's, which VTK makes up."""
    with path.open("rb") as file:
        head = file.read(_HEAD)
        if isinstance(block, pv.ImageData):
            for words in (b"DIMENSIONS", b"ORIGIN", b"(?:SPACING|ASPECT_RATIO)"):
                if not re.search(rb"(?im)^\s*" + words + rb"(?:\s+\S+){3}\s*\n", head):
                    return "its header is not whole"
        lines = head.split(b"\n", 3)
        if b"ASCII" not in b"".join(lines[2:3]).upper():
            return ""
        file.seek(sum(len(line) + 1 for line in lines[:3]))
        found = sum(
            len(words)
            for words in map(bytes.split, file)
            if words and (not words[0][:1].isalpha() or words[0].lower() in _NO_NUMBERS)
        )
        file.seek(0)
        components = {9: 6} if b"TENSORS6" in file.read() else {}
    stored = cell_arrays(block)
    if isinstance(block, pv.PolyData) and block.n_verts == block.n_cells:
        stored = []  # PyVista makes a vertex of each point that is in no cell
    # A file has the size of each cell, from version 5 on the place of each and the last end.
    more = 0 if b"Version 5" in lines[0] else 1
    expected = sum(len(ids) + len(ends) - more for ids, ends in map(connectivity, stored))
    if isinstance(block, pv.RectilinearGrid):
        expected += sum(block.dimensions)
    elif not isinstance(block, pv.ImageData):
        expected += 3 * block.n_points
    if isinstance(block, pv.UnstructuredGrid):
        expected += block.n_cells
    for data in (block.point_data, block.cell_data, block.field_data):
        for name, values in data.items():
            array = np.asarray(values)
            if array.dtype.kind in "biuf" and name not in _ADDED:
                own = array.shape[1] if array.ndim > 1 else 1
                expected += len(array) * components.get(own, own)
    return f"{found} of {expected} numbers are there" if found < expected else ""
