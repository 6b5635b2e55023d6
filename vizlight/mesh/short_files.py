"""Files that are shorter than their format states, or whose headers contradict their data.

Readers of VTK and meshio report most faults of a file. These are the faults that they overlook, end
the process by, or never end on.
"""

from __future__ import annotations

import contextlib
import graphlib
import gzip
import itertools
import json
import math
import mmap
import re
import struct
import subprocess
import sys
import zipfile
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO
from urllib.parse import unquote

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON

from vizlight import _check, _supervise
from vizlight.mesh import ensight, references, series
from vizlight.vtk.cells import cell_arrays, connectivity, points_of_type

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vizlight._types import Foreign, Indices, Keywords

__all__ = ["missing_numbers", "missing_part", "warn_of_last_line"]

#: Bytes in which a header stands that has no end of its own.
_HEAD = 4096
#: Bytes of a number by a part of the name of its type: the first that is in it.
_BYTES = {
    "64": 8, "32": 4, "16": 2, "int8": 1, "idtype": 4, "char": 1, "short": 2, "long_long": 8,
    "long long": 8, "longlong": 8, "long": 4, "int": 4, "float": 4, "double": 8,
}  # fmt: skip
#: Bytes at the end of a file in which its last words stand.
_END = 512
#: Largest ratio of data to what a compressor of VTK makes of them.
_PACKED = 8000
#: Ends of names of files that name their pieces, all of which are read.
_INDICES = (".vtm", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu")


#: Errors of a header that is damaged; a name in it may be none that the system takes.
_UNREADABLE = (AttributeError, LookupError, OSError, TypeError, ValueError, struct.error)


def missing_part(path: Path, /) -> str:
    """Return the part that a file lacks of the size or the end that it states.

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
            if not lacking and path.suffix.lower() in _INDICES:
                pieces = [piece for piece in references.named(path) if piece != path]
                parts = ((at.name, missing_part(at)) for at in pieces if at.is_file())
                lacking = next((f"'{name}': {reason}" for name, reason in parts if reason), "")
        except _UNREADABLE as error:
            return f"its header cannot be read: {error}"
    return lacking


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
    with _mapped(file) as text:
        for start in (b" NumberOf", b" index="):
            for match in (_COUNT.match(text, at) for at in _places(text, start)):
                # Each block takes some bytes, but for those that are empty.
                limit = len(text) if start == b" index=" else most
                if match and not 0 <= int(match[2]) <= limit:
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
    with _mapped(file) as text:
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


def _blocks(file: BinaryIO) -> str:
    """Look for numbers of blocks that stand twice: VTK keeps the last one."""
    if lacks := _xml(file):
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


def _gzip(file: BinaryIO) -> str:
    """Unpack a file to its end, where its check sum stands: readers stop before that."""
    if file.read(2) != b"\x1f\x8b":
        return ""  # its reader says so
    file.seek(0)
    try:
        with gzip.open(file) as packed:
            while packed.read(1 << 20):
                pass
    except (EOFError, OSError, zlib.error) as error:
        return str(error)
    return ""


def _zip(file: BinaryIO) -> str:
    """Compare the check sums of the parts of an archive."""
    try:
        with zipfile.ZipFile(file) as parts:
            bad = parts.testzip()
    except zipfile.BadZipFile as error:
        return str(error)
    return f"the check sum of {bad!r} is not that of its data" if bad else ""


def _vtkhdf(file: BinaryIO) -> str:
    if lacks := _netcdf(file):
        return lacks
    with _mapped(file) as data:
        return "" if data.find(b"VTKHDF") >= 0 else "it has no group VTKHDF, which VTK reads"


#: Largest HDF5 file that is searched for heaps, which takes 0.1 s.
_SEARCHED = 1 << 28


def _heaps(file: BinaryIO) -> str:
    """Follow the texts and lists of HDF5, among which its library goes around a free space of 0."""
    if file.seek(0, 2) > _SEARCHED:
        return ""
    with _mapped(file) as data:
        for place in _places(data, b"GCOL\1\0\0\0"):
            (size,) = struct.unpack_from("<8xQ", data, place)
            at, end = place + 16, min(place + size, len(data))
            while at + 16 <= end:
                number, size = struct.unpack_from("<H6xQ", data, at)
                if not number and not size:
                    return "a heap of HDF5 has a free space of 0 bytes"
                at += 16 + (size + 7) // 8 * 8 if number else size
    return ""


def _netcdf(file: BinaryIO) -> str:
    """Map each variable of a netCDF 3 file; the library of netCDF reads missing data as 0."""
    head = file.read(64)
    if head.startswith(_HDF):
        # A cut within the header leaves no bytes of this number, which then is 0.
        end = int.from_bytes(head[_HDF_END[head[8]] :][:8], "little")
        return (_size(file, end) or _heaps(file)) if end else "its header is not whole"
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


#: Reads a file of Exodus; the exit code is 0 if it has points.
_EXODUS = """
import sys
from vtkmodules.vtkIOExodus import vtkExodusIIReader
reader = vtkExodusIIReader()
reader.SetFileName(sys.argv[1])
reader.UpdateInformation()
for kind in range(20):
    for i in range(reader.GetNumberOfObjectArrays(kind)):
        reader.SetObjectArrayStatus(kind, reader.GetObjectArrayName(kind, i), 1)
reader.Update()
sys.exit(not reader.GetOutput().GetNumberOfPoints())
"""
#: Seconds that it may take, and what each megabyte adds.
_EXODUS_SECONDS, _EXODUS_SECONDS_PER_MB = 15.0, 0.5


def _exodus(file: BinaryIO) -> str:
    """Read a file of HDF5 in another process: one that is damaged ends it, or spoils later ones."""
    lacking, size = _netcdf(file), file.seek(0, 2)
    file.seek(0)
    # The command line is another process.
    alone = _supervise.has_parent() or not sys.executable
    if lacking or alone or file.read(len(_HDF)) != _HDF:
        return lacking
    try:
        run = subprocess.run(
            [sys.executable, "-c", _EXODUS, file.name],
            capture_output=True,
            stdin=subprocess.DEVNULL,
            timeout=_EXODUS_SECONDS + _EXODUS_SECONDS_PER_MB * size / 1e6,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "VTK's reader of Exodus does not come to an end of it"
    return "VTK's reader of Exodus cannot read it to its end" if run.returncode else ""


#: Bytes of the header of a binary STL file with its count, and of each triangle.
_STL_HEAD, _STL_TRIANGLE = 84, 50


def _stl(file: BinaryIO) -> str:
    head = file.read(_STL_HEAD)
    if len(head) < _STL_HEAD:
        return ""  # VTK's reader says so
    # Binary files may begin with this word, too, but a text has no bytes of 0.
    if head.lstrip()[:5].lower() == b"solid" and b"\0" not in head:
        return "" if b"endsolid" in _last(file).lower() else "its end is missing"
    return _size(file, _STL_HEAD + _STL_TRIANGLE * struct.unpack("<I", head[-4:])[0])


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
        warn_of_last_line(path, block[2])
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


@contextlib.contextmanager
def _mapped(file: BinaryIO) -> Iterator[mmap.mmap | bytes]:
    """Return the content of a file, which is not read at once."""
    if not file.seek(0, 2):
        yield b""
        return
    with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as text:
        yield text


def _places(text: mmap.mmap | bytes, word: bytes) -> Iterator[int]:
    """Return the places of a word."""
    at = text.find(word)
    while at >= 0:
        yield at
        at = text.find(word, at + 1)


def _size(file: BinaryIO, least: int) -> str:
    """Compare the size of a file with the least that it states."""
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


def _bmp(file: BinaryIO) -> str:
    """Compare a picture with its width and height, of which VTK's reader makes room."""
    if file.read(2) != b"BM":
        return ""  # VTK's reader says so
    start, length, width, height, bits = struct.unpack("<8xIIii2xH", file.read(28))
    if length < 40:
        return ""  # of the oldest kind, with sizes of 2 bytes
    if width < 1:
        return f"it is {width} pixels wide"
    # Rows are filled up to 4 bytes.
    return _size(file, start + (width * bits + 31) // 32 * 4 * abs(height))


def _pnm(file: BinaryIO) -> str:
    """Compare a picture with its width and height."""
    head = file.read(_HEAD)
    gap = rb"(?:\s|#[^\n]*\n)+"
    match = re.match(rb"P[1-6]" + gap + rb"(\d+)" + gap + rb"(\d+)\s", head)
    if not match:
        return "its width and height are missing"
    # A bit is the least for each pixel.
    return _size(file, int(match[1]) * int(match[2]) // 8)


def _fields(lines: Sequence[bytes], between: str) -> dict[str, str]:
    texts = [line.decode("utf-8", "surrogateescape").partition(between) for line in lines]
    return {key.strip(): rest.strip() for key, found, rest in texts if found}


def _nrrd(file: BinaryIO) -> str:
    head, blank, _ = file.read(1 << 16).replace(b"\r\n", b"\n").partition(b"\n\n")
    lines = [line for line in head.split(b"\n") if not line.startswith(b"#") and b":=" not in line]
    fields = _fields(lines, ": ")
    if not all(b": " in line for line in lines[1:] if line):
        return "a line of its header is no field"
    if len(fields) < sum(b": " in line for line in lines):
        return "a key stands twice"
    sizes = [int(word) for word in fields["sizes"].split()]
    other = fields.get("data file", fields.get("datafile", ""))
    if not (blank or other):
        return "its header has no end"
    if not (blank or head.endswith(b"\n")):
        return "its last line has no line break, for which VTK's reader waits"
    if len(sizes) != int(fields["dimension"]):
        return f"{len(sizes)} sizes for {fields['dimension']} dimensions"
    if fields["encoding"].lower() not in ("raw", "gzip", "gz"):
        return ""
    is_raw = fields["encoding"].lower() == "raw"
    kind = fields.get("kinds", "").partition(" ")[0]
    if len(sizes) == 3 and sizes[0] <= _FEW and kind in ("", "domain", "space"):
        _check.warn(
            f"file: '{file.name}': VTK reads its first axis of {sizes[0]} numbers as components"
        )
    return _data(file, sizes, fields["type"], other, is_raw)


#: Most rows of the first axis of an image of NRRD that VTK takes for components.
_FEW = 9


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
        return _size(file, 0 if other else least)
    path = Path(file.name).parent / other
    if not path.is_file():
        return f"its data in '{other}' are missing"
    with path.open("rb") as data:
        return _size(data, least)


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
    rows = re.findall(rb"(?m)^[ \t]*[-+.\d].*", data.replace(b",", b" "))
    there = sum(len(row.split()) for row in rows)
    return f"{there} of {least} numbers are there" if there < least else ""


_IJK = (b"I", b"J", b"K")
#: Words at the begin of lines of OBJ, and what they are, by their place in the corner of a face.
_CORNERS_OF_OBJ = ((b"v", "point"), (b"vt", "texture coordinate"), (b"vn", "normal"))


def _mdpa(file: BinaryIO) -> str:
    """Compare the ends of blocks with their begins; meshio goes on past the end of the file."""
    blocks, wrong = list[bytes](), "its blocks do not end as they begin"
    for word, name in re.findall(rb"(?m)^[ \t]*(Begin|End)[ \t]+(\w+)", file.read()):
        if word == b"Begin":
            blocks.append(name)
        elif not blocks or blocks.pop() != name:
            return wrong
    return wrong if blocks else ""


def _gifti(file: BinaryIO) -> str:
    """Check the numbers of axes, to which nibabel counts."""
    data = file.read()
    stated = re.search(rb'NumberOfDataArrays="(\d+)"', data)
    if stated and int(stated[1]) != (there := data.count(b"<DataArray")):
        return f"{there} of {int(stated[1])} arrays are there"
    numbers = re.findall(rb'Dimensionality="([^"]*)"', data)
    wrong = [number.decode("latin-1") for number in numbers if number not in _AXES]
    return f"an array of {wrong[0]} axes" if wrong else ""


_AXES = [b"%d" % number for number in range(1, 7)]


def _avs(file: BinaryIO) -> str:
    """Count the lines of points and cells of AVS, whose header states both."""
    lines = [line for line in file.read().splitlines() if not line.lstrip().startswith(b"#")]
    words = lines[0].split() if lines else []
    if len(words) != 5 or not all(map(bytes.isdigit, words)):
        return ""  # a file of Abaqus, or meshio says so
    least = 1 + int(words[0]) + int(words[1])
    if len(lines) < least:
        return f"{len(lines)} of {least} lines of points and cells are there"
    return "" if len(lines[least - 1].split()) > 3 else "a cell is not whole"


def _foam(file: BinaryIO) -> str:
    boundary = Path(file.name).parent / "constant" / "polyMesh" / "boundary"
    text = boundary.read_bytes() if boundary.is_file() else b""
    return "the text of its boundary has bytes of 0" if b"\0" in text else ""


#: Numbers in an element of glTF, and bytes of a number.
_ELEMENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_COMPONENTS = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}


def _gltf(file: BinaryIO) -> str:
    """Compare the parts of glTF with those that they name."""
    head, text = file.read(20), b""
    if head.startswith(b"glTF"):
        whole, length = struct.unpack("<8xII4x", head)
        if lacks := _size(file, whole):
            return lacks
        file.seek(20)
        text = file.read(length)
    else:
        text = head + file.read()
    scene = json.loads(text, parse_float=_finite, parse_constant=_finite)
    lists = {key: part for key, part in scene.items() if isinstance(part, list)}
    nodes = lists.get("nodes", [])
    for key, name in (("mesh", "meshes"), ("children", "nodes"), ("skin", "skins")):
        for node in nodes:
            _parts_of(lists, name, node.get(key, []))
    graphlib.TopologicalSorter({i: n.get("children", ()) for i, n in enumerate(nodes)}).prepare()
    for part in lists.get("scenes", []):
        _parts_of(lists, "nodes", part.get("nodes", []))
    _parts_of(lists, "scenes", scene.get("scene", []))
    for mesh in lists.get("meshes", []):
        for shape in mesh["primitives"]:
            _parts_of(lists, "accessors", [*shape["attributes"].values()])
            _parts_of(lists, "accessors", shape.get("indices", []))
    return _buffers(Path(file.name).parent, lists)


def _buffers(folder: Path, lists: dict[str, list[Keywords]]) -> str:
    """Compare the sizes of the arrays of glTF with those of the buffers in which they are."""
    for buffer in lists.get("buffers", []):
        uri = buffer.get("uri", "")
        path = folder / unquote(uri)
        if uri.startswith("data:"):
            there = len(uri.partition(",")[2]) * 3 // 4
        elif uri and not path.is_file():
            return f"it names {uri!r}, which is missing"
        else:
            there = path.stat().st_size if uri else _whole(buffer, "byteLength")
        if there < _whole(buffer, "byteLength"):
            return f"{there} of {buffer['byteLength']} bytes of a buffer are there"
    for view in lists.get("bufferViews", []):
        (buffer,) = _parts_of(lists, "buffers", view["buffer"])
        end = _whole(view, "byteOffset", 0) + _whole(view, "byteLength")
        if end > buffer["byteLength"]:
            return f"a view ends at {end} of {buffer['byteLength']} bytes of its buffer"
    for array in lists.get("accessors", []):
        step = _ELEMENTS[array["type"]] * _COMPONENTS[array["componentType"]]
        for view in _parts_of(lists, "bufferViews", array.get("bufferView", [])):
            end = _whole(array, "byteOffset", 0) + step
            end += (_whole(array, "count") - 1) * (_whole(view, "byteStride", 0) or step)
            if end > view["byteLength"]:
                return f"an array ends at {end} of {view['byteLength']} bytes of its view"
    return ""


def _finite(word: str) -> float:
    """Return a number of glTF, of which VTK ends the process where it is too large."""
    if not math.isfinite(number := float(word)):
        raise ValueError(f"it has the number {word}")
    return number


def _whole(part: Keywords, key: str, default: int | None = None) -> int:
    """Return a number of glTF that is 0 or more."""
    number = part.get(key, default)
    if type(number) is not int or number < 0:
        raise ValueError(f"its {key} is {number!r}")
    return number


def _parts_of(lists: dict[str, list[Keywords]], name: str, numbers: object) -> list[Keywords]:
    """Return the parts of a list of glTF by their number, or their numbers."""
    every = lists.get(name, [])
    chosen: list[Foreign] = numbers if isinstance(numbers, list) else [numbers]
    for number in chosen:
        if type(number) is not int or not 0 <= number < len(every):
            raise ValueError(f"number {number!r} of {len(every)} {name}")
    return [every[number] for number in chosen]


def _obj(file: BinaryIO) -> str:
    """Compare the numbers in the corners of faces with the counts of points and of the others."""
    text = file.read()
    if b"\0" in text:
        return "it has bytes of 0, and text has none"
    words = {*b" ".join(re.findall(rb"(?m)^[ \t]*[fl][ \t].*", text)).split()}
    corners = [word.split(b"/") for word in words if b"/" in word]
    for i, (key, name) in enumerate(_CORNERS_OF_OBJ):
        # At least as many as there are: words may end so, too.
        count = text.count(key + b" ") + text.count(key + b"\t")
        numbers = (
            int(corner[i]) for corner in corners if corner[i : i + 1] and corner[i].isdigit()
        )
        # Where a file has no texture coordinates or normals, they are left out.
        if count < (most := max(numbers, default=0)) and (count or name == "point"):
            return f"a face has the {name} {most} of {count}"
    return ""


def _legacy(file: BinaryIO) -> str:
    """Count the corners of cells and the arrays of fields, or VTK's reader ends the process."""
    lines = file.read(_HEAD).splitlines()
    is_text = b"ASCII" in b"".join(lines[2:3]).upper()
    version = _VERSION.match(b"".join(lines[:1]))
    # Since version 5 cells are arrays of ends and of corners.
    keywords = _CELLS if version is None or int(version[1]) < 5 else ()
    with _mapped(file) as data:
        fields = (_field(data, at, is_text) for at in _places(data, b"\nFIELD "))
        cells = (
            _cells(data, at, is_text) for word in keywords for at in _places(data, b"\n" + word)
        )
        types = (_types(data, at, is_text) for at in _places(data, b"\nCELL_TYPES "))
        named = (
            _named(data, at)
            for word in (b"\nPOINT_DATA ", b"\nCELL_DATA ")
            for at in _places(data, word)
        )
        return next(filter(None, itertools.chain(fields, cells, types, named)), "")


_VERSION = re.compile(rb"# vtk DataFile Version\s+(\d+)\.\d")
_CELLS = (b"VERTICES ", b"LINES ", b"POLYGONS ", b"TRIANGLE_STRIPS ", b"CELLS ")
_COUNTS = re.compile(rb"\s\w+[ \t]+(-?\d+)[ \t]+(-?\d+)[ \t]*\r?\n")
#: The first word after numbers.
_LETTER = re.compile(rb"[a-zA-Z]")


#: What begins with an array of points or cells in a legacy file, or stands in its place.
_ATTRIBUTES = (
    b"SCALARS", b"VECTORS", b"NORMALS", b"TENSORS", b"TENSORS6", b"TEXTURE_COORDINATES",
    b"COLOR_SCALARS", b"LOOKUP_TABLE", b"FIELD", b"GLOBAL_IDS", b"PEDIGREE_IDS", b"EDGE_FLAGS",
    b"METADATA", b"POINT_DATA", b"CELL_DATA",
)  # fmt: skip


def _named(data: mmap.mmap | bytes, at: int) -> str:
    """Return the reason why no array begins where it should."""
    word = re.compile(rb"\n\w+[ \t]+\d+\s+(\S+)").match(data, at)
    if word is None or word[1].upper() in _ATTRIBUTES:
        return ""
    return f"{word[1][:20]!r} stands where an array begins"


def _types(data: mmap.mmap | bytes, at: int, is_text: bool) -> str:
    """Return the reason why types of cells are none that VTK has."""
    counts = re.compile(rb"\n\w+[ \t]+(\d+)[ \t]*\r?\n").match(data, at)
    if counts is None:
        return ""
    count, start = int(counts[1]), counts.end()
    if is_text:
        end = _LETTER.search(data, start)
        numbers = np.fromstring(data[start : end.start() if end else None], np.int64, sep=" ")
    else:
        there = min(count, (len(data) - start) // 4)
        numbers = np.frombuffer(data, ">i4", there, start)
    unknown = [kind for kind in np.unique(numbers) if points_of_type(int(kind)) is None]
    if unknown:
        return f"VTK has no cells of type {unknown[0]}"
    return _polyhedra(data, at, is_text, np.flatnonzero(numbers == VTK_POLYHEDRON))


_ENDS = re.compile(rb"\nCELLS[ \t]+\d+[ \t]+\d+\s+OFFSETS[ \t]+\w*?(32|64)[ \t]*\r?\n")
_IDS = re.compile(rb"\nCONNECTIVITY[ \t]+\w+[ \t]*\r?\n")


def _polyhedra(data: mmap.mmap | bytes, at: int, is_text: bool, cells: Indices) -> str:
    """Return the reason why cells are not their faces, each with its number of corners before it.

    Since version 5 cells are arrays of ends and of corners, which are before their types.
    """
    if not len(cells):
        return ""
    first = _ENDS.search(data, max(data.rfind(b"\nCELLS ", 0, at), 0))
    middle = _IDS.search(data, first.end()) if first else None
    if first is None or middle is None:
        return ""
    parts, size = (data[first.end() : middle.start()], data[middle.end() : at]), int(first[1]) // 8
    if is_text:
        ends, corners = (np.fromstring(part, np.int64, sep=" ") for part in parts)
    else:
        ends, corners = (np.frombuffer(part, f">i{size}", len(part) // size) for part in parts)
    for cell in cells:
        faces = corners[ends[cell] : ends[cell + 1]].tolist()
        place, count = 1, len(faces)
        for _ in range(min(faces[0], count) if faces else 0):
            place += faces[place] + 1 if place < count and faces[place] >= 0 else count
        if place != count:
            return f"cell {cell} is no polyhedron of whole faces"
    return ""


def _cells(data: mmap.mmap | bytes, at: int, is_text: bool) -> str:
    """Return the reason why cells are not whole, of which each begins with its number of corners.

    VTK takes that number as it is.
    """
    counts = _COUNTS.match(data, at)
    if counts is None:
        return ""  # VTK's reader says so, or it is the name of an array
    count, size, start = int(counts[1]), int(counts[2]), counts.end()
    if is_text:
        end = _LETTER.search(data, start)
        numbers = np.fromstring(data[start : end.start() if end else None], np.int64, sep=" ")
    else:
        there = max(min(size, (len(data) - start) // 4), 0)
        numbers = np.frombuffer(data, ">i4", there, start)
    if len(numbers) < size:
        return f"{len(numbers)} of {size} numbers of cells are there"
    step = int(numbers[0]) + 1 if count > 0 < size else 1
    # Most meshes have cells of one kind.
    if size == count * step and np.all(numbers[:size:step] == step - 1):
        return ""
    corners, place = numbers.tolist(), 0
    for _ in range(count):
        place += corners[place] + 1 if place < size and corners[place] >= 0 else size
    return "" if place == size else f"the corners of {count} cells are not {size} numbers"


def _field(data: mmap.mmap | bytes, at: int, is_text: bool) -> str:
    """Return the reason why a field that begins at a place is not whole."""
    head = re.compile(rb"\sFIELD[ \t]+\S+\s+(\d+)(?=\s)").match(data, at)
    if head is None:
        return "a field has no number of arrays"
    at = head.end()
    for _ in range(int(head[1])):
        array = _ARRAY.match(data, at)
        if array is None:
            return "an array of a field is missing"
        count, kind, at = int(array[1]) * int(array[2]), array[3].decode().lower(), array.end()
        if "string" in kind or kind in ("bit", "long", "unsigned_long", "variant"):
            return ""
        if not any(part in kind for part in _BYTES):
            return f"an array of a field has the type {kind!r}"
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
#: What is no part of a number in text, such as -inf, and a line that does not begin with one.
_ODD = re.compile(rb"(?i)[^\s\d.+einfaty-]|[ \t](?!nan|inf)[a-z_]")
_WORD = re.compile(rb"(?mi)^[ \t]*(?!nan|inf)[a-z_%]")


#: Bytes of the section at the begin of a message of GRIB with its length, by its edition.
_GRIB_HEAD = {1: 8, 2: 16}
#: Bytes by which the length of a large message of edition 1 may be rounded, in which it is counted.
_GRIB_UNIT = 120


def _grib(file: BinaryIO) -> str:
    """Follow the messages, each of which states its length and ends in four digits."""
    at, count = 0, 0
    with _mapped(file) as data:
        while (start := data.find(b"GRIB", at)) >= 0:
            edition = data[start + 7] if start + 7 < len(data) else 0
            head = data[start : start + _GRIB_HEAD.get(edition, 0)]
            if b"7777" in data[at:start] or len(head) < 8:
                return f"the begin of message {count + 1} is missing or damaged"
            count += 1
            size, slack = int.from_bytes(head[8:] if edition == 2 else head[4:7], "big"), 0
            if edition == 1 and size >= 1 << 23:
                size, slack = (size - (1 << 23)) * _GRIB_UNIT + 4, _GRIB_UNIT
            last = data.rfind(b"7777", start + size - slack - 4, start + size)
            if last < 0:
                return f"message {count} does not end where its length of {size} bytes says"
            at = last + 4
        rest = b"7777" in data[at:]
    return f"the begin of message {count + 1} is missing or damaged" if rest else ""


#: Checks of a file that is open, by its suffix: each returns the reason why it is refused, or "".
_FORMATS: dict[str, Callable[[BinaryIO], str]] = {
    ".case": ensight.missing_part, ".vtk": _legacy, ".mdpa": _mdpa, ".obj": _obj, ".png": _png,
    ".stl": _stl, ".gii": _gifti, ".foam": _foam, ".bmp": _bmp, ".trx": _zip,
    ".vtm": _blocks, **dict.fromkeys((".gz", ".mgz"), _gzip),
    **dict.fromkeys((".hdf", ".vtkhdf"), _vtkhdf),
    **dict.fromkeys((".glb", ".gltf"), _gltf),
    **dict.fromkeys((".avs", ".inp"), _avs),
    **dict.fromkeys((".grib", ".grib2", ".grb", ".grb2"), _grib),
    **dict.fromkeys((".nrrd", ".nhdr"), _nrrd),
    **dict.fromkeys((".mha", ".mhd"), _meta),
    **dict.fromkeys((".pnm", ".pgm", ".ppm"), _pnm),
    **dict.fromkeys((".dat", ".tec"), _tecplot),
    **dict.fromkeys((*_INDICES[1:], ".vtp", ".vtu"), _xml),
    **dict.fromkeys((".vti", ".vtr", ".vts"), _grid),
    **dict.fromkeys((".nc", ".nc4", ".cdf"), _netcdf),
    **dict.fromkeys((".e", ".ex2", ".exo", ".exii"), _exodus),
}  # fmt: skip
