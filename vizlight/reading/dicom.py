"""Images of DICOM, as VTK reads them, with what their headers say of the values.

Source: DICOM PS3.5, 7.1, for the elements of a header, and PS3.6 for their tags.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

import pyvista as pv

from vizlight.mesh import meaning
from vizlight.mesh.georeference import UNIT
from vizlight.reading import file_parts, series

#: Bytes of a file in which its header is sought, and before its first element.
_HEAD, _PREAMBLE = 1 << 20, 132
#: Kinds of values whose length has four bytes after two that are reserved.
_LONG = (b"OB", b"OD", b"OF", b"OL", b"OV", b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT", b"UV")
#: Tags of the syntax of the elements, the modality, the number of frames, the unit of values, and
#: of the values themselves, before which the header ends.
_SYNTAX, _MODALITY, _FRAMES, _UNIT_OF_VALUES = (
    (0x0002, 0x0010), (0x0008, 0x0060), (0x0028, 0x0008), (0x0028, 0x1054),
)  # fmt: skip
_VALUES = (0x7FE0, 0x0010)
#: Tags of the distances of pixels, at the detector or in the body.
_SIZES = ((0x0018, 0x1164), (0x0028, 0x0030))
#: Syntaxes in which elements do not name their kinds, and in which the header cannot be read: with
#: the bytes of numbers in the other order, and packed.
_IMPLICIT, _OTHER = "1.2.840.10008.1.2", ("1.2.840.10008.1.2.2", "1.2.840.10008.1.2.1.99")
#: Begins of syntaxes with packed values, which VTK does not unpack.
_PACKED = ("1.2.840.10008.1.2.4", "1.2.840.10008.1.2.5")
#: Group of the parts of a sequence, and length of one that ends by a mark.
_PARTS, _OPEN = 0xFFFE, 0xFFFFFFFF


def read(path: Path) -> pv.DataSet:
    """Return the image of a file, in mm from its lower left corner if its header has their size.

    Values of computed tomography are in Hounsfield units, unless the header has another unit. Of
    several frames the first is read, with a note; packed values are refused.
    """
    header: dict[tuple[int, int], str] = {}
    for tag, value in _elements(file_parts.first_bytes(path, _HEAD)):
        header.setdefault(tag, value)
    if header.get(_SYNTAX, "").startswith(_PACKED):
        way = f"GDCM unpacks them: gdcmconv --raw '{path.name}' '{path.stem}-raw.dcm'"
        raise ValueError(f"its values are packed, as by JPEG or run lengths; {way}")
    image: pv.DataSet = series.unchecked(pv.get_reader(path))  # type: ignore[no-untyped-call]
    modality, unit = (header.get(tag, "") for tag in (_MODALITY, _UNIT_OF_VALUES))
    said = meaning.of(image)
    # Segments and doses are no photographs, whose values are tones.
    if modality not in ("", "SEG", "RTDOSE"):
        said.axes = [*meaning.PAGE]
    if modality == "CT" and unit in ("", "HU"):
        for name in image.point_data:
            said.arrays[name] = {"units": "HU"}
    frames = header.get(_FRAMES, "1")
    if frames.isdigit() and int(frames) > 1:
        said.notes.append(f"the first of {int(frames)} frames, which may be tiles of one image")
    elif not header.keys().isdisjoint(_SIZES):
        image.field_data[UNIT] = ["millimetre"]
    return meaning.attach(image, said)


def _elements(data: bytes) -> Iterator[tuple[tuple[int, int], str]]:
    """Give the tags of a header and their values as text; those in a sequence follow its own."""
    if data[_PREAMBLE - 4 : _PREAMBLE] != b"DICM":
        return
    at, syntax = _PREAMBLE, ""
    while at + 12 <= len(data):
        group, element = struct.unpack_from("<HH", data, at)
        if (group, element) == _VALUES or (group > _SYNTAX[0] and syntax in _OTHER):
            return
        is_named = group != _PARTS and (group == _SYNTAX[0] or syntax != _IMPLICIT)
        if not is_named:
            (size,), start = struct.unpack_from("<I", data, at + 4), at + 8
        elif data[at + 4 : at + 6] in _LONG:
            (size,), start = struct.unpack_from("<I", data, at + 8), at + 12
        else:
            (size,), start = struct.unpack_from("<H", data, at + 6), at + 8
        if group == _PARTS or size == _OPEN:
            at = start
            continue
        at = start + size
        text = data[start:at].decode("latin-1").strip("\0 ")
        if (group, element) == _SYNTAX:
            syntax = text
        yield (group, element), text
