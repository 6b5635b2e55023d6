"""Legacy files of VTK that are shorter than they state, or contradict themselves.

VTK's reader makes numbers up that are missing, and ends the process at numbers of corners.
"""

from __future__ import annotations

import collections
import itertools
import mmap
import re
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON

from vizlight._types import Indices
from vizlight.reading import file_parts, series
from vizlight.vtk.cells import cell_arrays, connectivity, points_of_type

#: Bytes in which the lines before the data stand.
_HEAD = 4096
#: Version and title, and the word for text after them, before which empty lines may stand.
_TEXT = re.compile(rb"[^\n]*\n[^\n]*\n\s*(?i:ASCII)")
#: Version in the first line, and words before cells that are rows until version 5.
_VERSION = re.compile(rb"# vtk DataFile Version\s+(\d+)\.\d")
_CELLS = (b"VERTICES ", b"LINES ", b"POLYGONS ", b"TRIANGLE_STRIPS ", b"CELLS ")
#: Words before lists of cells, of their offsets, and of their types.
_LISTS = re.compile(rb"\n(%s)" % b"|".join([*_CELLS, b"OFFSETS ", b"CELL_TYPES "]))
#: Numbers of cells and of all numbers of them.
_COUNTS = re.compile(rb"\s\w+[ \t]+(-?\d+)[ \t]+(-?\d+)[ \t]*\r?\n")
#: The first word after numbers.
_LETTER = re.compile(rb"[a-zA-Z]")
#: What begins with an array of points or cells in a legacy file, or stands in its place.
_ATTRIBUTES = (
    b"SCALARS", b"VECTORS", b"NORMALS", b"TENSORS", b"TENSORS6", b"TEXTURE_COORDINATES",
    b"COLOR_SCALARS", b"LOOKUP_TABLE", b"FIELD", b"GLOBAL_IDS", b"PEDIGREE_IDS", b"EDGE_FLAGS",
    b"METADATA", b"POINT_DATA", b"CELL_DATA",
)  # fmt: skip
#: Headers of arrays of the ends of cells and of their corners, and of the types of cells.
_ENDS = re.compile(rb"\nCELLS[ \t]+(\d+)[ \t]+(\d+)\s+OFFSETS[ \t]+\w*?(32|64)[ \t]*\r?\n")
_IDS = re.compile(rb"\nCONNECTIVITY[ \t]+\w+[ \t]*\r?\n")
_TYPES = re.compile(rb"\n\w+[ \t]+(\d+)[ \t]*\r?\n")
#: The first word after a number of points or cells, and the number of arrays of a field.
_FIRST = re.compile(rb"\n\w+[ \t]+\d+\s+(\S+)")
_FIELD = re.compile(rb"\sFIELD[ \t]+\S+\s+(\d+)(?=\s)")
#: Headers of arrays with a name.
_HEADS = re.compile(rb"\n(?:SCALARS|VECTORS|NORMALS|TENSORS|COLOR_SCALARS)[ \t]+(\S+)[ \t]")
#: Headers of points, and of an array of some components.
_POINTS = re.compile(rb"\nPOINTS[ \t]+(\d+)[ \t]+(\w+)[ \t]*\r?\n")
_SCALARS = re.compile(rb"\nSCALARS[ \t]+\S+[ \t]+\w+[ \t]+(\d+)[ \t]*\r?\n")
#: Header of an array of a field in a legacy file, with what VTK knows of the array before it.
_ARRAY = re.compile(
    rb"(?:\s*METADATA\b.*?\n\r?\n)?\s*\S+\s+(\d+)\s+(\d+)\s+(\w+)[^\n]*\n", re.DOTALL
)
#: Largest numbers of types, and number of words that are looked at at once.
_LARGEST = {
    "float": 3.4028235e38, "double": 1.7976931348623157e308, "short": 2.0**15,
    "unsigned_short": 2.0**16 - 1, "int": 2.0**31, "unsigned_int": 2.0**32 - 1,
}  # fmt: skip
_WORDS = 1 << 16
#: What is no part of a number in text, such as -inf, and a line that does not begin with one.
_ODD = re.compile(rb"(?i)[^\s\d.+einfaty-]|[ \t](?!nan|inf)[a-z_]")
_WORD = re.compile(rb"(?mi)^[ \t]*(?!(?:nan|inf|infinity)\b)[a-z_%]")


def missing_part(file: BinaryIO) -> str:
    """Return the reason why a file is refused, or ""."""
    head = file.read(_HEAD)
    is_text = _TEXT.match(head) is not None
    version = _VERSION.match(head)
    # Since version 5 cells are arrays of ends and of corners.
    keywords = _CELLS if version is None or int(version[1]) < 5 else ()
    with file_parts.mapped(file) as data:
        fields = (_field(data, at, is_text) for at in file_parts.places(data, b"\nFIELD "))
        cells = (
            _cells(data, at, is_text)
            for word in keywords
            for at in file_parts.places(data, b"\n" + word)
        )
        types = (_types(data, at, is_text) for at in file_parts.places(data, b"\nCELL_TYPES "))
        named = (
            _named(data, at)
            for word in (b"\nPOINT_DATA ", b"\nCELL_DATA ")
            for at in file_parts.places(data, word)
        )
        wide = (_components(data, at) for at in file_parts.places(data, b"\nSCALARS "))
        ends = (_after_points(data, at, is_text) for at in file_parts.places(data, b"\nPOINTS "))
        others = map(_headless, [data])
        return next(
            filter(None, itertools.chain(fields, ends, cells, types, named, wide, others)), ""
        )


def _headless(data: mmap.mmap | bytes) -> str:
    """Return the reason why cells are lost, as VTK skips what stands before a word that it knows.

    Since version 5 each list of cells has the word OFFSETS; cells of a grid have types.
    """
    counts = collections.Counter(match[1] for match in _LISTS.finditer(data))
    if counts[b"OFFSETS "] > sum(counts[word] for word in _CELLS):
        return "a list of cells has no number of them"
    if counts[b"CELLS "] != counts[b"CELL_TYPES "] and data.find(b" UNSTRUCTURED_GRID") >= 0:
        return "its cells have no types, or types no cells"
    return ""


def _named(data: mmap.mmap | bytes, at: int) -> str:
    """Return the reason why no array begins where it should."""
    word = _FIRST.match(data, at)
    if word is None or word[1].upper() in _ATTRIBUTES:
        return ""
    return f"{word[1][:20]!r} stands where an array begins"


def _after_points(data: mmap.mmap | bytes, at: int, is_text: bool) -> str:
    """Return the reason why no word is after the points of a binary file; VTK ends the process."""
    head = _POINTS.match(data, at)
    kind = head[2].decode().lower() if head else ""
    width = next((count for part, count in file_parts.BYTES.items() if part in kind), 0)
    if is_text or head is None or not width:
        return ""
    end = head.end() + 3 * int(head[1]) * width
    rest = data[end : end + 80].lstrip()
    return "" if not rest or rest[:1].isalpha() else "no word stands after its points"


def _components(data: mmap.mmap | bytes, at: int) -> str:
    """Return the reason why an array has a number of components for which VTK leaves it out."""
    head = _SCALARS.match(data, at)
    if head is None or 0 < int(head[1]) < len(data):
        return ""
    return f"an array has {int(head[1])} components"


def _numbers(data: mmap.mmap | bytes, at: int, count: int, is_text: bool, size: int = 4) -> Indices:
    """Return whole numbers from a place on: all up to the next word, or a count of a size."""
    if is_text:
        word = _LETTER.search(data, at)
        return np.fromstring(data[at : word.start() if word else None], np.intp, sep=" ")
    there = max(min(count, (len(data) - at) // size), 0)
    return np.frombuffer(data, f">i{size}", there, at).astype(np.intp)


def _types(data: mmap.mmap | bytes, at: int, is_text: bool) -> str:
    """Return the reason why types of cells are none that VTK has."""
    head = _TYPES.match(data, at)
    if head is None:
        return ""
    numbers = _numbers(data, head.end(), int(head[1]), is_text)
    unknown = [kind for kind in np.unique(numbers).tolist() if points_of_type(kind) is None]
    if unknown:
        return f"VTK has no cells of type {unknown[0]}"
    return _polyhedra(data, at, is_text, np.flatnonzero(numbers == VTK_POLYHEDRON))


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
    size = int(first[3]) // 8
    ends = _numbers(data, first.end(), int(first[1]), is_text, size)
    corners = _numbers(data, middle.end(), int(first[2]), is_text, size)
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
    count, size = int(counts[1]), int(counts[2])
    numbers = _numbers(data, counts.end(), size, is_text)
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
    head = _FIELD.match(data, at)
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
        if not any(part in kind for part in file_parts.BYTES):
            return f"an array of a field has the type {kind!r}"
        if is_text:
            word = _WORD.search(data, at)
            end = len(data) if word is None else word.start()
            words = data[at:end].split()
            there = len(words)
            if _ODD.search(data, at, end):
                return "words stand among the numbers of a field"
            if (beyond := _beyond(words[:count], kind)) is not None:
                return f"the number {beyond.decode()} of a field is beyond the type {kind!r}"
        else:
            width = next((count for part, count in file_parts.BYTES.items() if part in kind), 1)
            there, end = (len(data) - at) // width, at + count * width
        if there < count:
            return f"{there} of {count} numbers of an array of a field are there"
        at = end
    return ""


def _beyond(words: list[bytes], kind: str) -> bytes | None:
    """Return the first number that its type does not hold, at which VTK ends the process."""
    if kind not in _LARGEST:
        return None
    for first in range(0, len(words), _WORDS):
        some = words[first : first + _WORDS]
        try:
            sizes = np.abs(np.array(some, dtype="S").astype(np.float64))
        except ValueError:
            continue  # a word that is no number ends the reading, as one that is missing does
        large = np.flatnonzero(sizes > _LARGEST[kind]).tolist()
        wrong = [i for i in large if b"inf" not in some[i].lower()]
        if wrong:
            return some[wrong[0]]
    return None


def missing_numbers(mesh: pv.DataSet, path: Path, /) -> str:
    """Return the numbers that a legacy file of text lacks for its mesh; VTK makes them up.

    A file of another format lacks nothing.
    """
    if path.suffix.lower() != ".vtk":
        return ""
    with path.open("rb") as file:
        with file_parts.mapped(file) as data:
            names = {match[1] for match in _HEADS.finditer(data)}
        there = {*mesh.point_data, *mesh.cell_data}
        if len(there) < len(names):
            return f"{len(there)} of {len(names)} arrays are there"
        # An empty line ends what VTK says of an array.
        block = file_parts.last(file).replace(b"\r", b"").rpartition(b"METADATA")
        if block[1] and b"\n\n" not in block[2]:
            return "its last block is not whole"
        file.seek(0)
        head = _TEXT.match(file.read(_HEAD))
        # Binary files are not looked at.
        if head is None:
            return ""
        file.seek(head.end())
        file_parts.warn_of_last_line(path, block[2])
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
