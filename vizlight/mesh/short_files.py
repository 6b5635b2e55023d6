"""Files that are shorter than their format states.

Readers report most faults of a file. These are the faults that they overlook, or crash on.
"""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh import headers, references, series
from vizlight.vtk.cells import cell_arrays, connectivity

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

__all__ = ["missing_numbers", "missing_part", "warn_of_last_line"]

#: Bytes at the end of a file in which its last words stand.
_END = 512
#: Largest ratio of data to what a compressor of VTK makes of them.
_PACKED = 8000
#: Ends of names of files that name their pieces, all of which are read.
_INDICES = (".vtm", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu")


def missing_part(path: Path, /) -> str:
    """Return the part that a file lacks of the size or the end that it states.

    These are the XML files of VTK with their pieces, netCDF, HDF5, STL, and what
    :mod:`.headers` has.

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
            lacking = lacks(file)
        except (LookupError, ValueError, struct.error) as error:
            return f"its header cannot be read: {error}"
    if lacking or path.suffix.lower() not in _INDICES:
        return lacking
    pieces = (piece for piece in references.named(path) if piece.is_file() and piece != path)
    parts = ((piece.name, missing_part(piece)) for piece in pieces)
    return next((f"'{name}': {lacking}" for name, lacking in parts if lacking), "")


def warn_of_last_line(path: Path, data: bytes) -> None:
    """Warn of a text without a line break at its end, which may be cut in its last number.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    data : bytes
        Its content.
    """
    if not data.endswith((b"\n", b"\r")):
        _check.warn(f"file: '{path}' may be cut in its last line, which has no line break")


def _last(file: BinaryIO) -> bytes:
    """Return the last bytes of a file."""
    file.seek(-min(_END, file.seek(0, 2)), 2)
    return file.read()


def _xml(file: BinaryIO) -> str:
    """Look for the end of a file, which stands after its data."""
    if not file.read(100).lstrip().startswith((b"<?xml", b"<VTKFile")):
        return ""  # VTK's reader says so
    if b"</VTKFile>" not in _last(file):
        return "its end is missing"
    # What is packed is at most so much larger.
    most, wrong = _PACKED * file.seek(0, 2), ""
    with headers.mapped(file) as text:
        for start in (b" NumberOf", b" index="):
            for match in (_COUNT.match(text, at) for at in headers.places(text, start)):
                if match and not 0 <= int(match[2]) <= most:
                    wrong = f"{match[1].decode()} is {match[2].decode()}"
    return wrong


#: A count or an index of VTK's XML.
_COUNT = re.compile(rb' (\w+)="\s*(-?\d+)')


def _grid(file: BinaryIO) -> str:
    """Compare the extents of the pieces of a grid with that of the whole.

    VTK leaves memory that no piece covers uninitialised, and a huge whole takes it long.
    """
    if lacks := _xml(file):
        return lacks
    with headers.mapped(file) as text:
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


#: First bytes of netCDF 3 files that SciPy maps, of others, and of HDF5 files.
_CLASSIC, _LARGE, _HDF = (b"CDF\x01", b"CDF\x02"), b"CDF\x05", b"\x89HDF\r\n\x1a\n"
#: Place of the end of the file in the first block of HDF5, by the version of the block.
_HDF_END = {0: 40, 1: 44, 2: 28, 3: 28}


def _netcdf(file: BinaryIO) -> str:
    """Map each variable of a netCDF 3 file; the library of netCDF reads missing data as 0."""
    head = file.read(64)
    if head.startswith(_HDF):
        # A cut within the header leaves no bytes of this number, which then is 0.
        end = int.from_bytes(head[_HDF_END[head[8]] :][:8], "little")
        return headers.size(file, end) if end else "its header is not whole"
    # SciPy does not map this version: nothing can be told.
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
    # Binary files may begin with this word, too, but a text has no bytes of 0.
    if head.lstrip()[:5].lower() == b"solid" and b"\0" not in head:
        return "" if b"endsolid" in _last(file).lower() else "its end is missing"
    return headers.size(file, _STL_HEAD + _STL_TRIANGLE * struct.unpack("<I", head[-4:])[0])


_FORMATS: dict[str, Callable[[BinaryIO], str]] = {
    **headers.FORMATS,
    **dict.fromkeys((".vtm", ".vtp", ".vtu"), _xml),
    **dict.fromkeys((".vti", ".vtr", ".vts"), _grid),
    **dict.fromkeys((".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"), _xml),
    **dict.fromkeys(
        (".nc", ".nc4", ".cdf", ".e", ".ex2", ".exo", ".exii", ".vtkhdf", ".hdf"), _netcdf
    ),
    ".stl": _stl,
}


def missing_numbers(mesh: pv.DataSet, path: Path, /) -> str:
    """Return the numbers that a legacy file of text lacks for its mesh; VTK makes them up.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh as its reader returned it.
    path : pathlib.Path
        Its file; one of another format lacks nothing.
    """
    if path.suffix.lower() != ".vtk":
        return ""
    with path.open("rb") as file:
        # An empty line ends what VTK says of an array.
        block = _last(file).replace(b"\r", b"").rpartition(b"METADATA")
        if block[1] and b"\n\n" not in block[2]:
            return "its last block is not whole"
        file.seek(0)
        # The third line says whether numbers are text; binary files are not looked at.
        if b"ASCII" not in [next(file, b"") for _ in range(3)][2].upper():
            return ""
        # Lines of keywords begin with a letter, as does "nan", which is a number.
        count = sum(
            len(words)
            for words in map(bytes.split, file)
            if words
            and (not words[0][:1].isalpha() or words[0].lower().startswith((b"nan", b"inf")))
        )
    arrays = [
        np.asarray(values)
        for data in (mesh.point_data, mesh.cell_data, mesh.field_data)
        for name, values in data.items()
        if name not in (series.TIME, series.STEPS)
    ]
    # A symmetric tensor has six numbers in the file, or nine.
    expected = sum(
        array.size * 6 // 9 if array.shape[1:] == (9,) else array.size
        for array in arrays
        if array.dtype.kind in "biuf"
    )
    if isinstance(mesh, pv.RectilinearGrid):
        expected += sum(mesh.dimensions)
    elif isinstance(mesh, pv.PointSet | pv.PolyData | pv.UnstructuredGrid | pv.StructuredGrid):
        expected += 3 * mesh.n_points
    if not isinstance(mesh, pv.PolyData) or mesh.n_verts != mesh.n_cells:
        # PyVista makes a vertex of each point that is in no cell; a cell begins with its size.
        sizes = [
            len(connectivity(cells)[0]) + cells.GetNumberOfCells() for cells in cell_arrays(mesh)
        ]
        # An unstructured grid has a type for each cell, too.
        expected += sum(sizes) + (mesh.n_cells if isinstance(mesh, pv.UnstructuredGrid) else 0)
    return f"{count} of {expected} numbers are there" if count < expected else ""
