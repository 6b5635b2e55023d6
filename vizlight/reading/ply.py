"""PLY files: vertices with all their numbers, faces, edges and strips, in text or binary.

VTK's reader rounds places to float32, leaves out most arrays, and ends the process where elements
are others than vertices and faces. Source: G. Turk, "The PLY Polygon File Format".
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign, Indices, Raw
from vizlight.mesh import blocks
from vizlight.reading import file_parts

#: Types of NumPy by those of PLY.
_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
#: Data begin right after the line break; white space there may already be numbers.
_HEAD = re.compile(rb"(?:ply|PLY)\s.*?^end_header[ \t]*\r?\n", re.DOTALL | re.MULTILINE)
#: Words of other lines of a header.
_OTHER_WORDS = ("ply", "PLY", "comment", "obj_info", "end_header")
#: Begin of a row.
_NUMBER = re.compile(rb"\s*[-+.]?\d")
#: Arrays of several numbers of a vertex or a face, by the names that programs give these.
_TOGETHER = (
    ("RGBA", ("red", "green", "blue", "alpha")),
    ("RGB", ("red", "green", "blue")),
    ("RGB", ("diffuse_red", "diffuse_green", "diffuse_blue")),
    ("Normals", ("nx", "ny", "nz")),
    ("TCoords", ("u", "v")),
    ("TCoords", ("s", "t")),
    ("TCoords", ("texture_u", "texture_v")),
)
#: Elements that hold no part of a mesh.
_BESIDE = ("camera",)


@dataclass
class _Element:
    """Rows of an element: each property has a type, and a list a type of its length, too."""

    name: str
    count: int
    kinds: dict[str, str] = field(default_factory=dict)
    lengths: dict[str, str] = field(default_factory=dict)
    #: Numbers of each property; those of lists one after the other.
    columns: dict[str, Raw] = field(default_factory=dict)
    #: Number of numbers of each list.
    sizes: dict[str, Indices] = field(default_factory=dict)

    def single(self) -> dict[str, Raw]:
        """Return the properties that have one number in each row."""
        return {name: rows for name, rows in self.columns.items() if name not in self.lengths}

    def lacks(self, there: int) -> ValueError:
        """Return the error of an element that is not whole."""
        return ValueError(f"{there} of {self.count} rows of '{self.name}' are there")


def read(path: Path) -> pv.PolyData:
    """Return the mesh of a PLY file."""
    data = path.read_bytes()
    head = _HEAD.match(data)
    if head is None:
        raise ValueError("its header is not whole" if data[:3].lower() == b"ply" else "no PLY file")
    form, elements = _header(head[0].decode("latin-1"))
    if form == "ascii":
        _read_text(data[head.end() :], elements, path)
    else:
        at = head.end()
        for element in elements:
            at = _read_bytes(data, at, element, ">" if "big" in form else "<")
        file_parts.warn_of_more(path, len(data[at:].strip()), "bytes")
    return _mesh({element.name: element for element in elements}, path)


def _header(text: str) -> tuple[str, list[_Element]]:
    """Return the form of the data, and the elements without their rows."""
    form, elements = "", list[_Element]()
    for words in map(str.split, text.splitlines()):
        try:
            if words[:1] == ["format"]:
                form = words[1]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], int(words[2])))
            elif words[:1] == ["property"]:
                *kinds, name = words[2:] if words[1] == "list" else words[1:]
                types = [_TYPES[kind] for kind in kinds]
                elements[-1].kinds[name] = types[-1]
                if words[1] == "list":
                    elements[-1].lengths[name], _ = types
            elif words and words[0] not in _OTHER_WORDS:
                raise ValueError(words[0])
        except (LookupError, ValueError) as error:
            raise ValueError(f"its header has the line {' '.join(words)!r}") from error
    if form not in ("ascii", "binary_little_endian", "binary_big_endian"):
        raise ValueError(f"its header has the format {form!r}")
    if any(element.count < 0 for element in elements):
        raise ValueError("its header has a count below 0")
    return form, elements


def _read_text(data: bytes, elements: list[_Element], path: Path) -> None:
    """Read the rows of lines, each of which holds one row."""
    lines = [line for line in data.splitlines() if line.strip()]
    first = 0
    for element in elements:
        element_lines = lines[first : first + element.count]
        first += element.count
        if len(element_lines) < element.count:
            raise element.lacks(len(element_lines))
        rows = [line.split() for line in element_lines]
        if element.lengths:
            _lists_of_text(element, rows)
        else:
            short = next((row for row in rows if len(row) < len(element.kinds)), None)
            if short is not None:
                raise _short(len(short), len(element.kinds))
            for i, (name, kind) in enumerate(element.kinds.items()):
                element.columns[name] = _numbers([row[i] for row in rows], kind)
        used = len(element.sizes) * element.count + sum(map(len, element.columns.values()))
        file_parts.warn_of_more(path, sum(map(len, rows)) - used, "numbers")
    if first == len(lines) and lines:
        file_parts.warn_of_last_line(path, data)
    # Other lines are comments of other programs.
    more = sum(_NUMBER.match(line) is not None for line in lines[first:])
    file_parts.warn_of_more(path, more, "lines")


def _short(there: int, expected: int) -> ValueError:
    return ValueError(f"{there} of {expected} numbers of a line are there")


def _lists_of_text(element: _Element, rows: list[list[bytes]]) -> None:
    """Take the words of rows, of which some are lists, apart."""
    words: dict[str, list[bytes]] = {name: [] for name in element.kinds}
    sizes: dict[str, list[int]] = {name: [] for name in element.lengths}
    for row in rows:
        at = 0
        for name in element.kinds:
            size = 1
            if name in sizes:
                size = _length(int(row[at]) if at < len(row) else 0, element)
                sizes[name].append(size)
                at += 1
            if len(row) < at + size:
                raise _short(len(row), at + size)
            words[name] += row[at : at + size]
            at += size
    for name, kind in element.kinds.items():
        element.columns[name] = _numbers(words[name], kind)
    element.sizes = {name: np.array(every, dtype=np.intp) for name, every in sizes.items()}


def _length(size: int, element: _Element) -> int:
    if size < 0:
        raise ValueError(f"a list of '{element.name}' has {size} numbers")
    return size


def _numbers(words: list[bytes], kind: str) -> Raw:
    """Return numbers of a type, refused where they are none of it."""
    numbers: Array = np.array(words, dtype=np.float64)
    if kind[0] == "f":
        return numbers.astype(kind)
    limits = np.iinfo(kind)
    if not np.all((numbers >= limits.min) & (numbers <= limits.max)):
        raise ValueError(f"numbers from {numbers.min():g} to {numbers.max():g} as {limits.dtype}")
    return numbers.astype(kind)


def _read_bytes(data: bytes, at: int, element: _Element, order: str) -> int:
    """Read the rows of an element, and return where the next one begins."""
    if not element.kinds:
        return at
    # Most files have lists of one length: that of the first row is tried for all.
    starts, sizes, _ = _walk(data, at, element, order, min(element.count, 1))
    longest = {name: int(every[0]) if len(every) else 0 for name, every in sizes.items()}
    parts = list[tuple[str, str, tuple[int]]]()
    for i, (name, kind) in enumerate(element.kinds.items()):
        if name in longest:
            parts.append((f"n{i}", order + element.lengths[name], (1,)))
        parts.append((f"v{i}", order + kind, (longest.get(name, 1),)))
    row = np.dtype(parts)
    if row.itemsize and len(data) - at >= element.count * row.itemsize:
        table = np.frombuffer(data, row, element.count, at)
        named = list(enumerate(element.kinds))
        if all((table[f"n{i}"] == longest[name]).all() for i, name in named if name in longest):
            element.columns = {name: table[f"v{i}"].ravel() for i, name in named}
            for name, size in longest.items():
                element.sizes[name] = np.full(element.count, size, dtype=np.intp)
            return at + element.count * row.itemsize
    # A row has a byte at least: a damaged count may be in the billions.
    starts, sizes, end = _walk(data, at, element, order, min(element.count, len(data) - at + 1))
    whole = np.frombuffer(data, np.uint8)
    for name, kind in element.kinds.items():
        counts = sizes.get(name, np.ones(element.count, dtype=np.intp))
        width = np.dtype(kind).itemsize
        ends = np.cumsum(counts)
        begins = np.repeat(starts[name] - (ends - counts) * width, counts)
        places = begins + np.arange(ends[-1] if len(ends) else 0) * width
        taken = whole[places[:, np.newaxis] + np.arange(width)]
        element.columns[name] = np.ascontiguousarray(taken).view(order + kind).ravel()
    element.sizes = sizes
    return end


def _walk(
    data: bytes, at: int, element: _Element, order: str, count: int
) -> tuple[dict[str, Indices], dict[str, Indices], int]:
    """Follow rows one by one; return where the numbers of each property begin, and list sizes."""
    begins = {name: np.zeros(count, dtype=np.intp) for name in element.kinds}
    sizes = {name: np.zeros(count, dtype=np.intp) for name in element.lengths}
    each = []
    for name, kind in element.kinds.items():
        length = np.dtype(order + element.lengths.get(name, "u1"))
        if name in sizes and length.kind == "f":
            raise ValueError(f"the lengths of the list '{name}' are no whole numbers")
        each.append((begins[name], np.dtype(kind).itemsize, length, sizes.get(name)))
    endian = "big" if order == ">" else "little"
    for i in range(count):
        for begin, width, length, size in each:
            number = 1
            if size is not None:
                length_bytes = data[at : at + length.itemsize]
                number = int.from_bytes(length_bytes, endian, signed=length.kind == "i")  # type: ignore[arg-type]
                size[i] = min(_length(number, element), len(data))
                at += length.itemsize
            begin[i] = at
            at += number * width
        # A damaged length may be in the billions: missing data are not followed.
        if at > len(data):
            raise element.lacks(i)
    return begins, sizes, at


def _mesh(elements: dict[str, _Element], path: Path) -> pv.PolyData:
    """Return the mesh of elements."""
    vertex = elements.pop("vertex", _Element("vertex", 0))
    vertices = vertex.single()
    if not {*"xyz"} <= vertices.keys():
        raise ValueError("no vertices with x, y and z")
    double = any(vertices[axis].dtype.itemsize > 4 for axis in "xyz")
    kind = np.float64 if double else np.float32
    points = np.column_stack([vertices.pop(axis) for axis in "xyz"]).astype(kind)
    mesh, face = pv.PolyData(), elements.pop("face", _Element("face", 0))
    mesh.points = points
    _attach(mesh.point_data, vertices)
    ids, sizes, used = _lists(face, ("vertex_indices", "vertex_index"))
    corners = face.columns.pop("texcoord", None)
    if corners is not None and len(corners) == 2 * len(ids):
        mesh, ids = _parted(mesh, ids, corners.reshape(-1, 2))
        used.add("texcoord")
    mesh.SetPolys(_cells(ids, sizes))
    edges, strips = elements.pop("edge", None), elements.pop("tristrips", None)
    if edges is not None and {"vertex1", "vertex2"} <= (ends := edges.single()).keys():
        pairs = np.column_stack([ends[f"vertex{i}"] for i in (1, 2)]).astype(np.intp)
        mesh.SetLines(_cells(pairs.ravel(), np.full(len(pairs), 2)))
    if strips is not None:
        mesh.SetStrips(_cells(*_strips(*_lists(strips, ("vertex_indices", "vertex_index"))[:2])))
    if mesh.n_cells == face.count:
        _attach(mesh.cell_data, face.single())
    if not mesh.n_cells:
        mesh.SetVerts(_cells(np.arange(len(points)), np.ones(len(points), dtype=np.intp)))
    left = [name for name in elements if name not in _BESIDE and elements[name].count]
    left += [name for name in (*vertex.lengths, *face.sizes) if name not in used]
    if left:
        _check.warn(f"file: '{path}' has elements and lists that are left out: {', '.join(left)}")
    return mesh


def _lists(element: _Element, names: tuple[str, ...]) -> tuple[Indices, Indices, set[str]]:
    """Return the numbers of points in the lists of one of some names, their sizes, and its name."""
    for name in names:
        if name in element.sizes:
            numbers = element.columns[name]
            whole = numbers.astype(np.int64)
            if not np.array_equal(whole, numbers):
                raise ValueError(f"'{name}' has numbers of points that are not whole")
            return whole, element.sizes[name], {name}
    return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64), set()


def _cells(ids: Indices, sizes: Indices) -> pv.CellArray:
    """Return the cells of lists that are not empty."""
    return blocks.cell_array(ids, np.concatenate([[0], np.cumsum(sizes[sizes > 0])]))


def _strips(ids: Indices, sizes: Indices) -> tuple[Indices, Indices]:
    """Return strips of triangles; within a list -1 ends a strip."""
    ends = np.unique(np.concatenate([np.cumsum(sizes), np.flatnonzero(ids == -1) + 1]))
    lengths = np.diff(np.concatenate([[0], ends]))
    of = np.repeat(np.arange(len(lengths)), lengths)[ids != -1]
    return ids[ids != -1], np.bincount(of, minlength=len(lengths))


def _parted(mesh: pv.PolyData, ids: Indices, corners: Raw) -> tuple[pv.PolyData, Indices]:
    """Return points, repeated where faces have texture coordinates of their own."""
    rows = np.column_stack([ids, corners])
    kept, number = np.unique(rows, axis=0, return_inverse=True)
    of = kept[:, 0].astype(np.intp)
    if len(of) and not 0 <= of.min() <= of.max() < mesh.n_points:
        raise ValueError(f"faces of the points {of.min()} to {of.max()} of {mesh.n_points}")
    parted = pv.PolyData()
    parted.points = np.asarray(mesh.points)[of]
    for name in mesh.point_data:
        parted.point_data[name] = np.asarray(mesh.point_data[name])[of]
    parted.point_data["TCoords"] = kept[:, 1:].astype(np.float32)
    parted.GetPointData().SetActiveTCoords("TCoords")
    return parted, number.ravel()


def _attach(data: pv.DataSetAttributes, columns: dict[str, Raw]) -> None:
    """Attach columns as arrays; related columns become one array of several components."""
    for array, names in _TOGETHER:
        if {*names} <= columns.keys() and array not in data:
            rows = np.column_stack([columns.pop(name) for name in names])
            if array.startswith("RGB") and rows.dtype.kind == "f":
                rows = np.rint(np.clip(rows, 0, 1) * 255)
            elif array.startswith("RGB") and rows.max(initial=0) > 255:
                rows = rows // 256  # of 16 bits
            values: Foreign = rows.astype(np.uint8 if array.startswith("RGB") else np.float32)
            data.set_array(values, array)  # the active scalars stay
    for name, values in columns.items():
        if values.size:
            native: Foreign = np.array(values, dtype=values.dtype.newbyteorder("="))
            data.set_array(native, name)
    if "Normals" in data and data.association == pv.FieldAssociation.POINT:
        data.active_normals_name = "Normals"
    if "TCoords" in data and data.association == pv.FieldAssociation.POINT:
        data.VTKObject.SetActiveTCoords("TCoords")
    colors = next((name for name in ("RGBA", "RGB") if name in data), None)
    if colors:
        data.active_scalars_name = colors
