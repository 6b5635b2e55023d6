"""Files of glTF with parts that do not fit those that they name."""

from __future__ import annotations

import graphlib
import json
import math
import re
import struct
from pathlib import Path
from typing import BinaryIO
from urllib.parse import unquote

import numpy as np
import pyvista as pv

from vizlight._types import Foreign, Keywords, Raw
from vizlight.reading import file_parts

#: Numbers in an element of glTF, and bytes of a number.
_ELEMENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_COMPONENTS = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
#: What a view of a buffer is for: points, or the numbers of them.
_TARGETS = (34962, 34963)


def missing_part(file: BinaryIO) -> str:
    """Return the reason why a file is refused, or ""."""
    head, text = file.read(20), b""
    if head.startswith(b"glTF"):
        whole, length = struct.unpack("<8xII4x", head)
        if lacks := file_parts.missing_bytes(file, whole):
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
        if view.get("target", _TARGETS[0]) not in _TARGETS:
            return f"a view has the target {view['target']!r}"  # VTK ends the process
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


#: Ends of names of files of glTF, and their array of colours.
GLTF, GLTF_COLORS = (".glb", ".gltf"), "COLOR_0"
#: Arrays by which VTK's reader of glTF has the shapes of an animation.
_SHAPES = re.compile(r"target\d+_")


def finished(mesh: pv.DataSet) -> list[str]:
    """Make colours of glTF bytes and drop the shapes of an animation; return notes."""
    if GLTF_COLORS in mesh.point_data:
        mesh.point_data[GLTF_COLORS] = _as_bytes(mesh.point_data[GLTF_COLORS])
    # They are differences to other shapes, and no vectors of this one.
    shapes = [name for name in mesh.point_data if _SHAPES.match(name)]
    for name in shapes:
        del mesh.point_data[name]
    return [f"shapes of its animation are left out: {', '.join(shapes)}"] if shapes else []


def _as_bytes(colors: Raw) -> Raw:
    """Return colours of glTF, which are linear in light, as bytes in sRGB."""
    if colors.dtype.kind != "f":
        return colors
    light = np.clip(np.asarray(colors, np.float64), 0, 1)
    light[:, :3] = np.where(
        light[:, :3] <= 0.0031308, 12.92 * light[:, :3], 1.055 * light[:, :3] ** (1 / 2.4) - 0.055
    )
    return np.rint(255 * light).astype(np.uint8)
