"""Files that are shorter than their format states, or whose headers contradict their data.

Readers of VTK and meshio report most faults of a file. These are the faults that they overlook, end
the process by, or never end on.
"""

from __future__ import annotations

import gzip
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import BinaryIO

from vizlight import _check
from vizlight.mesh import ensight, file_parts, gltf, legacy_vtk, references, vtk_xml

#: Bytes in which a header stands that has no end of its own.
_HEAD = 4096
#: Ends of names of files that name their pieces, all of which are read.
_INDICES = (".vtm", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu")


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
        except Exception as error:  # noqa: BLE001 - of any type, by what is damaged
            return f"its header cannot be read: {error}"
    return lacking


#: First bytes of netCDF 3 files that SciPy maps, of others, and of HDF5 files.
_CLASSIC, _LARGE, _HDF = (b"CDF\x01", b"CDF\x02"), b"CDF\x05", b"\x89HDF\r\n\x1a\n"
#: Places in the first block of HDF5, by its version, of the number of bytes of a place in the file,
#: and of three places, of which the last is the end of the file.
_HDF_PLACES = {0: (13, 24), 1: (13, 28), 2: (9, 12), 3: (9, 12)}


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
    except (zipfile.BadZipFile, NotImplementedError) as error:
        return str(error)
    return f"the check sum of {bad!r} is not that of its data" if bad else ""


#: Why HDF5 of another program is no mesh, and a way to one of its arrays.
NO_VTKHDF = (
    "it has no group VTKHDF; look at an array of it by xarray: "
    "vizlight.look(xarray.open_dataset(file, group='...'))"
)


def _vtkhdf(file: BinaryIO) -> str:
    if lacks := _netcdf(file):
        return lacks
    with file_parts.mapped(file) as data:
        return "" if data.find(b"VTKHDF") >= 0 else NO_VTKHDF


#: Largest HDF5 file that is searched for heaps, which takes 0.1 s.
_SEARCHED = 1 << 28


def _heaps(file: BinaryIO) -> str:
    """Follow the texts and lists of HDF5, among which its library goes around a free space of 0."""
    if file.seek(0, 2) > _SEARCHED:
        return ""
    with file_parts.mapped(file) as data:
        for place in file_parts.places(data, b"GCOL\1\0\0\0"):
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
        at, start = _HDF_PLACES[head[8]]
        end = int.from_bytes(head[start + 2 * head[at] :][: head[at]], "little")
        return (
            (file_parts.missing_bytes(file, end) or (_heaps(file) if head[at] == 8 else ""))
            if end
            else "its header is not whole"
        )
    # SciPy does not map this version: nothing can be checked.
    if head.startswith(_LARGE):
        return ""
    if not head.startswith(_CLASSIC):
        # Grids of this name are netCDF by GMT alone.
        return "" if file.name.lower().endswith(".grd") else "neither netCDF nor HDF5"
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
    """Return the number of triangles of an STL file, of which VTK leaves out those without area.

    Parameters
    ----------
    path : pathlib.Path
    """
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


#: Bytes of a record of LAS, and of one that stands after the points.
_LAS_RECORD, _LAS_EXTENDED = 54, 60


def _las(file: BinaryIO) -> str:
    """Compare the counts of points and records of a scan, which laspy reads past the end."""
    head = file.read(255)
    if not head.startswith(b"LASF"):
        return ""  # its reader says so
    size, start, records, kind, width, count = struct.unpack_from("<HIIBHI", head, 94)
    if size + _LAS_RECORD * records > start:
        return f"its {records} records end after byte {start}, where its points begin"
    least = start
    if head[25] >= 4:
        first, extended, count = struct.unpack_from("<QIQ", head, 235)
        least = max(least, first + _LAS_EXTENDED * extended if extended else 0)
    # The highest bits stand for points that are packed.
    return file_parts.missing_bytes(file, max(least, start + width * count * (kind < 64)))


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
    return file_parts.missing_bytes(file, start + (width * bits + 31) // 32 * 4 * abs(height))


def _pnm(file: BinaryIO) -> str:
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


def _fields(lines: Sequence[bytes], between: str) -> dict[str, str]:
    texts = [line.decode("utf-8", "surrogateescape").partition(between) for line in lines]
    return {key.strip(): rest.strip() for key, found, rest in texts if found}


def _nrrd(file: BinaryIO) -> str:
    begin = file.read(1 << 16)
    blank = re.search(rb"\r?\n\r?\n", begin)
    head = begin[: blank.start() if blank else None].replace(b"\r\n", b"\n")
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
    if [*fields].index("sizes") < [*fields].index("dimension"):
        return "its sizes stand before their number"
    if fields["encoding"].lower() not in ("raw", "gzip", "gz"):
        return ""
    is_raw = fields["encoding"].lower() == "raw"
    kind = fields.get("kinds", "").partition(" ")[0]
    if len(sizes) == 3 and sizes[0] <= _FEW and kind in ("", "domain", "space"):
        _check.warn(
            f"file: '{file.name}': VTK reads its first axis of {sizes[0]} numbers as components"
        )
    start = 0 if other or blank is None else blank.end()
    skips = "byte skip" in fields or "line skip" in fields
    return _data(file, sizes, fields["type"], other, is_raw, None if skips else start)


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
    start = 0 if other else sum(len(line) + 1 for line in lines[: last[0] + 1])
    skips = "HeaderSize" in fields
    return _data(file, sizes, fields["ElementType"], other, is_raw, None if skips else start)


def _data(
    file: BinaryIO,
    sizes: Sequence[int],
    kind: str,
    other: str,
    is_raw: bool,
    start: int | None,
) -> str:
    """Compare the sizes of an image with those of its data, in this file or another beside it.

    The data begin at ``start``, unless that is None.
    """
    if min(sizes) < 1:
        return f"its sizes are {sizes}"
    width = next((count for word, count in file_parts.BYTES.items() if word in kind.lower()), 1)
    least = math.prod(sizes) * width
    if not is_raw:
        # A zip makes data at most 1032 times smaller.
        least //= 1032
    # A name may be a pattern of several, or a list of them.
    if "%" in other or other.startswith("LIST"):
        return ""
    path = Path(file.name).parent / other if other else Path(file.name)
    if not path.is_file():
        return f"its data in '{other}' are missing"
    end = least + (start or 0)
    if is_raw and start is not None:
        file_parts.warn_of_more(path, path.stat().st_size - end, "bytes")
    with path.open("rb") as data:
        return file_parts.missing_bytes(data, end)


#: Reason why a file is none of Tecplot.
NO_TECPLOT = "no VARIABLES and ZONE are in it"
#: Files that are whole, but of another format than their name says.
OTHERS = {NO_TECPLOT: "a file of Tecplot", NO_VTKHDF: "a mesh of VTK in HDF5"}
#: Corners of a cell of Tecplot by its name.
_CORNERS = {b"TRIANGLE": 3, b"QUADRILATERAL": 4, b"TETRAHEDRON": 4, b"BRICK": 8}


def _tecplot(file: BinaryIO) -> str:
    """Compare the counts of zones with the numbers in the file."""
    data = file.read()
    names = re.search(rb"(?is)VARIABLES\s*=(.*?)^\s*ZONE", data, re.MULTILINE)
    zones = re.findall(rb"(?im)^\s*ZONE\b([^\n]*(?:\n[^\n]*=[^\n]*)*)", data)
    if names is None:
        return NO_TECPLOT
    if data.count(b'"') % 2:
        return "a name in it has no end, for which VTK's reader waits"
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
_CORNERS_OF_OBJ = ((0, b"v", "point"), (2, b"vn", "normal"))


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
    data = file.read()
    if data.lstrip()[:1] in (b"*", b"\7"):
        return ""  # a file of Abaqus, or a binary one
    lines = [line for line in data.splitlines() if not line.lstrip().startswith(b"#")]
    words = lines[0].split() if lines else []
    if len(words) != 5 or not all(map(bytes.isdigit, words)):
        return "its first line is no five counts, as that of AVS is"
    least = 1 + int(words[0]) + int(words[1])
    if len(lines) < least:
        return f"{len(lines)} of {least} lines of points and cells are there"
    return "" if len(lines[least - 1].split()) > 3 else "a cell is not whole"


def _foam(file: BinaryIO) -> str:
    boundary = Path(file.name).parent / "constant" / "polyMesh" / "boundary"
    text = boundary.read_bytes() if boundary.is_file() else b""
    return "the text of its boundary has bytes of 0" if b"\0" in text else ""


def _obj(file: BinaryIO) -> str:
    """Compare the numbers in the corners of faces with the counts of points and of the others."""
    text = file.read()
    if b"\0" in text:
        return "it has bytes of 0, and text has none"
    words = {*b" ".join(re.findall(rb"(?m)^[ \t]*[fl][ \t]([^#\r\n]*)", text)).split()}
    # VTK reads 0x7fffffff as a number, too.
    if odd := next((word for word in words if b"x" in word.lower()), b""):
        return f"a face has the corner {odd.decode('latin-1')!a}"
    corners = [word.split(b"/") for word in words if b"/" in word]
    for i, key, name in _CORNERS_OF_OBJ:
        # At least as many as there are: words may end so, too.
        count = text.count(key + b" ") + text.count(key + b"\t")
        numbers = (
            int(corner[i]) for corner in corners if corner[i : i + 1] and corner[i].isdigit()
        )
        # Where a file has no normals, or too few texture coordinates, they are left out.
        if count < (most := max(numbers, default=0)) and (count or name == "point"):
            return f"a face has the {name} {most} of {count}"
    return ""


#: Bytes of the section at the begin of a message of GRIB with its length, by its edition.
_GRIB_HEAD = {1: 8, 2: 16}
#: Bytes by which the length of a large message of edition 1 may be rounded, in which it is counted.
_GRIB_UNIT = 120


def _grib(file: BinaryIO) -> str:
    """Follow the messages, each of which states its length and ends in four digits."""
    at, count = 0, 0
    with file_parts.mapped(file) as data:
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
    ".case": ensight.missing_part, ".vtk": legacy_vtk.missing_part, ".mdpa": _mdpa, ".obj": _obj,
    ".png": _png, ".stl": _stl, ".gii": _gifti, ".foam": _foam, ".bmp": _bmp, ".trx": _zip,
    ".vtm": vtk_xml.missing_block, **dict.fromkeys((".gz", ".mgz"), _gzip),
    **dict.fromkeys((".hdf", ".vtkhdf"), _vtkhdf),
    **dict.fromkeys((".glb", ".gltf"), gltf.missing_part),
    **dict.fromkeys((".avs", ".inp", ".ucd"), _avs), **dict.fromkeys((".las", ".laz"), _las),
    **dict.fromkeys((".grib", ".grib2", ".grb", ".grb2"), _grib),
    **dict.fromkeys((".nrrd", ".nhdr"), _nrrd),
    **dict.fromkeys((".mha", ".mhd"), _meta),
    **dict.fromkeys((".pnm", ".pgm", ".ppm"), _pnm),
    **dict.fromkeys((".dat", ".tec"), _tecplot),
    **dict.fromkeys((*_INDICES[1:], ".vtp", ".vtu"), vtk_xml.missing_part),
    **dict.fromkeys((".vti", ".vtr", ".vts"), vtk_xml.missing_piece),
    **dict.fromkeys((".nc", ".nc4", ".cdf", ".grd", ".e", ".ex2", ".exo", ".exii"), _netcdf),
}  # fmt: skip
