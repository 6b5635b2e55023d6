"""The file that names the files of lit pieces, which VTK and ParaView read as one mesh."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING

from vizlight import files
from vizlight.pieces.kinds import SUFFIX

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight.pieces.task import Done

#: Names of XML files for the types of VTK.
TYPES = {
    "float": "Float32", "double": "Float64", "char": "Int8", "signed char": "Int8",
    "unsigned char": "UInt8", "short": "Int16", "unsigned short": "UInt16", "int": "Int32",
    "unsigned int": "UInt32", "long": "Int64", "unsigned long": "UInt64", "long long": "Int64",
    "unsigned long long": "UInt64", "vtkIdType": "Int64", "string": "String", "bit": "UInt8",
}  # fmt: skip


def write(path: Path, pieces: Sequence[Done], folder: str, scalars: str) -> Path:
    """Write the index of lit pieces, whole or not at all.

    Parameters
    ----------
    path : pathlib.Path
        Path of the index, whose extension gives the kind of its pieces.
    pieces : sequence of Done
        Pieces with points.
    folder : str
        Folder of the files, relative to the index.
    scalars : str
        Name of the active point array.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    first = pieces[0]
    suffix = Path(first.file).suffix
    kind = "P" + next(kind for kind, own in SUFFIX.items() if own == suffix)
    root = ET.Element("VTKFile", type=kind, version="1.0", byte_order="LittleEndian")
    grid = ET.SubElement(root, kind, GhostLevel="0")
    for name, data in (("point", "PPointData"), ("cell", "PCellData")):
        element = ET.SubElement(grid, data, {"Scalars": scalars} if name == "point" else {})
        for own, (kind_of, components) in first.arrays.items():
            of, _, own_name = own.partition(" ")
            if of == name:
                _array(element, own_name, kind_of, components)
    if "points " in first.arrays:
        _array(ET.SubElement(grid, "PPoints"), "Points", *first.arrays["points "])
    if kind == "PRectilinearGrid":
        axes = ET.SubElement(grid, "PCoordinates")
        for axis in "xyz":
            _array(axes, axis, "double", 1)
    if first.extent:
        whole = [
            (min, max)[i % 2](piece.extent[i] for piece in pieces if piece.extent) for i in range(6)
        ]
        grid.set("WholeExtent", " ".join(map(str, whole)))
        for name, values in first.grid.items():
            grid.set(name, " ".join(map(repr, values)))
    for piece in pieces:
        element = ET.SubElement(grid, "Piece", Source=f"{folder}/{piece.file}")
        if piece.extent:
            element.set("Extent", " ".join(map(str, piece.extent)))
    ET.indent(root)
    return files.replace_file(path, ET.ElementTree(root).write)


def _array(parent: ET.Element, name: str, kind: str, components: int) -> None:
    ET.SubElement(
        parent, "PDataArray", type=TYPES.get(kind, "Float64"), Name=name,
        NumberOfComponents=str(components),
    )  # fmt: skip
