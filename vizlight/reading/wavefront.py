"""Files of Wavefront (.obj), with the parts that VTK's reader leaves out or ends the process by."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv

from vizlight import _check, _supervise
from vizlight._types import Array
from vizlight.vtk.topology import place_numbers

#: Number of a texture coordinate in a corner of a face, before that of its normal.
_TEXTURE = re.compile(rb"(?<=\d)/-?\d+(/?)")
_OF_TEXTURE = re.compile(rb"[ \t]-?\d+/(\d+)")
#: Lines of faces and lines, and slashes at the end of a corner.
_CORNERS = re.compile(rb"(?m)^[ \t]*[fl][ \t].*")
_SLASHES = re.compile(rb"(?<=\d)/+(?=[ \t\r\n]|\Z)")
#: A curve of the first degree, which is a polyline.
_STRAIGHT = re.compile(rb"(?m)^(cstype\s+bspline\s*\ndeg\s+1\s*\n)curv\s+\S+\s+\S+\s")
#: A point with a weight, which counts for curves alone.
_WEIGHT = re.compile(rb"(?m)^([ \t]*v(?:[ \t]+[^\s#]+){3})[ \t]+[^\s#]+(?=[ \t\r]*$)")
_FREE_FORM = re.compile(rb"(?m)^(curv2?|surf)\s")


def has_free_form(path: Path) -> bool:
    """Return whether an OBJ file has curves and surfaces that are not read."""
    return _FREE_FORM.search(_STRAIGHT.sub(b"", path.read_bytes())) is not None


def read(path: Path) -> pv.DataSet | None:
    """Return the mesh of an OBJ file that VTK's reader does not take as it is, else None.

    It leaves out colours of points and curves of the first degree, takes weights for colours, ends
    the process at texture coordinates that are missing, and stops at a slash without a number.
    """
    whole = path.read_bytes()
    data = _WEIGHT.sub(rb"\1", _STRAIGHT.sub(rb"\1l ", whole))
    if _SLASHES.search(data):
        data = _CORNERS.sub(lambda line: _SLASHES.sub(b"", line[0]), data)
    count = len(re.findall(rb"(?m)^[ \t]*vt\s", data))
    corners = b"\n".join(_CORNERS.findall(data)) if count else b""
    most = max(map(int, _OF_TEXTURE.findall(corners)), default=0)
    textured = 0 < count >= most
    if 0 < count < most:
        _check.warn(
            f"file: '{path}': its texture coordinates are left out: a face has number {most} of "
            f"{count}"
        )
    first = _VERTEX.search(data)
    colored = first is not None and len(first[0].split()) == _WITH_COLOR
    if data == whole and not colored and (textured or _TEXTURE.search(data) is None):
        return None
    # What is left of damaged corners may be such numbers, too.
    while not textured and _TEXTURE.search(data):
        data = _TEXTURE.sub(rb"\1\1", data)
    with _supervise.folder(path) as folder:
        draft = folder / "draft.obj"
        draft.write_bytes(data)
        with warnings.catch_warnings():
            # An error says what is wrong, with the name of the file.
            warnings.filterwarnings("ignore", "The VTK reader")
            mesh = pv.read(draft, validate=False)
    if colored and isinstance(mesh, pv.PolyData):
        _attach_colors(mesh, data, path)
    return mesh


#: Lines of points of OBJ, and the words of one with a place and a colour.
_VERTEX = re.compile(rb"(?m)^[ \t]*v[ \t].*")
_WITH_COLOR = 7


def _attach_colors(mesh: pv.PolyData, data: bytes, path: Path) -> None:
    """Attach the colours of the points of an OBJ file, which VTK's reader may have repeated."""
    lines = [line.split()[1:] for line in _VERTEX.findall(data)]
    if any(len(line) != _WITH_COLOR - 1 for line in lines):
        _check.warn(f"file: '{path}' has colours of some points alone, which are left out")
        return
    rows: Array = np.array(lines, dtype=np.float64)
    of_file = place_numbers(rows[:, :3].astype(np.float32))
    of_mesh = place_numbers(np.asarray(mesh.points))
    if np.array_equal(of_file, of_mesh):
        at = np.arange(len(rows))  # points at one place may have colours of their own
    else:
        order = np.argsort(of_file)
        at = order[np.minimum(np.searchsorted(of_file, of_mesh, sorter=order), len(order) - 1)]
    if not np.array_equal(of_file[at], of_mesh):
        _check.warn(f"file: '{path}' has colours of points that are left out")
        return
    colors = rows[at, 3:] * (255 if rows[:, 3:].max() <= 1 else 1)
    mesh.point_data["color"] = np.rint(np.clip(colors, 0, 255)).astype(np.uint8)


#: Words at the begin of lines of OBJ, and what they are, by their place in the corner of a face.
_CORNERS_OF_OBJ = ((0, b"v", "point"), (2, b"vn", "normal"))


def missing_part(file: BinaryIO) -> str:
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
