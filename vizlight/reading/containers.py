"""Containers of data that are cut: gzip, zip, HDF5, netCDF and GRIB."""

from __future__ import annotations

import gzip
import struct
import zipfile
import zlib
from typing import BinaryIO

from vizlight.reading import file_parts

#: First bytes of netCDF 3 files that SciPy maps, of others, and of HDF5 files.
_CLASSIC, _LARGE, _HDF = (b"CDF\x01", b"CDF\x02"), b"CDF\x05", b"\x89HDF\r\n\x1a\n"
#: Places in the first block of HDF5, by its version, of the number of bytes of a place in the file,
#: and of three places, of which the last is the end of the file.
_HDF_PLACES = {0: (13, 24), 1: (13, 28), 2: (9, 12), 3: (9, 12)}


def missing_of_gzip(file: BinaryIO) -> str:
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


def missing_of_zip(file: BinaryIO) -> str:
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


def missing_of_vtkhdf(file: BinaryIO) -> str:
    """Return the part that a file of VTKHDF lacks, or the group that VTK reads."""
    if lacks := missing_of_netcdf(file):
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


def missing_of_netcdf(file: BinaryIO) -> str:
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


#: Bytes of the section at the begin of a message of GRIB with its length, by its edition.
_GRIB_HEAD = {1: 8, 2: 16}
#: Bytes by which the length of a large message of edition 1 may be rounded, in which it is counted.
_GRIB_UNIT = 120


def missing_of_grib(file: BinaryIO) -> str:
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
