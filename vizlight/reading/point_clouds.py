"""PCD files of the Point Cloud Library: points with colours, normals and values."""

from __future__ import annotations

import io
import itertools
import re
import struct
import warnings
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign, Raw
from vizlight.mesh import meaning
from vizlight.reading import file_parts, molecules

#: Fields of places and of normals, and those whose four bytes are a colour.
_PLACES, _NORMALS = ("x", "y", "z"), ("normal_x", "normal_y", "normal_z")
_COLORS = ("rgb", "rgba")
#: Types of numbers by their letters.
_KINDS = {"F": "f", "I": "i", "U": "u"}
#: Line of the header of a file, and what ends it.
_LINE = re.compile(rb"(?m)^([A-Z]+)[ \t]+(.+?)[ \t\r]*$")
_DATA = re.compile(rb"(?m)^DATA[ \t]+(\w+)[ \t\r]*\n")


def read_pcd(path: Path) -> pv.PolyData:
    """Return the points of a PCD file that have a place."""
    content = path.read_bytes()
    end = _DATA.search(content)
    if end is None:
        raise ValueError("it has no line DATA that ends a header")
    head = {key.decode(): words.split() for key, words in _LINE.findall(content[: end.end()])}
    names = [word.decode("latin-1") for word in head["FIELDS"]]
    counts = [*map(int, head.get("COUNT", [b"1"] * len(names)))]
    formats = [
        f"{count}<{_KINDS[letter.decode()]}{int(size)}"
        for count, letter, size in zip(counts, head["TYPE"], head["SIZE"], strict=True)
    ]
    # Fields that fill up bytes have one name, so that of each is its number.
    kind = np.dtype([(str(i), form) for i, form in enumerate(formats)])
    n_points = int(head["POINTS"][0])
    body, form = content[end.end() :], end[1].decode()
    fields: list[Raw]
    if form == "ascii":
        rows = np.loadtxt(io.BytesIO(body), ndmin=2, max_rows=n_points)
        columns = np.split(rows, np.cumsum(counts)[:-1], axis=1)
        fields = [part.astype(kind[i].base) for i, part in enumerate(columns)]
    elif form == "binary":
        table: Foreign = np.frombuffer(body[: n_points * kind.itemsize], dtype=kind)
        fields = [table[name] for name in table.dtype.names]
    else:
        # Field after field.
        sizes = [n_points * kind[i].itemsize for i in range(len(names))]
        whole = _unpacked(body[8 : 8 + int.from_bytes(body[:4], "little")])
        parts = np.split(np.frombuffer(whole, np.uint8), np.cumsum(sizes)[:-1])
        fields = [part.view(kind[i].base) for i, part in enumerate(parts)]
    rows_of = [part.reshape(-1, count) for part, count in zip(fields, counts, strict=True)]
    values = dict(zip(names, rows_of, strict=True))
    if (least := min(map(len, values.values()))) < n_points:
        raise ValueError(f"{least} of {n_points} points are there")
    return _cloud(values, is_image=int(head.get("HEIGHT", [b"1"])[0]) > 1)


def _cloud(values: dict[str, Raw], *, is_image: bool) -> pv.PolyData:
    """Return the points by the fields of their names; those of an image are turned upright."""
    if not {*_PLACES} <= {*values}:
        raise ValueError(f"its fields are {', '.join(values)}; expected x, y and z among them")
    points: Array = np.hstack([values.pop(name) for name in _PLACES])
    known = np.isfinite(points).all(axis=1)
    points, axes = points[known], ["x", "y", "z"]
    turn = np.eye(3, dtype=points.dtype)
    if is_image and len(points) and (points[:, 2] > 0).all() and points[-1, 1] > points[0, 1]:
        # By the convention of cameras, y is down and z away from them.
        turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], dtype=points.dtype)
        axes = [*meaning.CAMERA]
    mesh = pv.PolyData(points @ turn)
    meaning.attach(mesh, meaning.Meaning(axes=axes))
    if {*_NORMALS} <= {*values}:
        normals: Foreign = np.hstack([values.pop(name) for name in _NORMALS])[known]
        mesh.point_data["Normals"] = normals @ turn
        mesh.point_data.active_normals_name = "Normals"
    for name, rows in values.items():
        if name in _COLORS and rows.itemsize == 4:
            packed: Foreign = np.ascontiguousarray(rows[known, 0]).view(np.uint32)
            mesh.point_data["color"] = np.stack(
                [packed >> shift & 255 for shift in (16, 8, 0)], axis=1
            ).astype(np.uint8)
        elif name != "_":
            mesh.point_data[name] = rows[known, 0] if rows.shape[1] == 1 else rows[known]
    return mesh


def _unpacked(data: bytes) -> bytes:
    """Return bytes packed by LZF: literals, or the place and length of bytes that came before."""
    out, at = bytearray(), 0
    while at < len(data):
        control = data[at]
        at += 1
        if control < 32:
            out += data[at : at + control + 1]
            at += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += data[at]
            at += 1
        start = len(out) - ((control & 31) << 8) - data[at] - 1
        at += 1
        repeated = out[start : start + length + 2]
        # Bytes may repeat themselves.
        out += (repeated * ((length + 2) // len(repeated) + 1))[: length + 2]
    return bytes(out)


#: Columns of a line of a scan: place, intensity, colour or normal.
_SCAN = (3, 4, 6, 7)
#: Largest difference from 1 of the length of a normal.
_UNIT = 0.02


def read_scan(path: Path) -> pv.PolyData:
    """Return the points of a scan: an optional count, and a line for each point, or a molecule.

    VTK's reader loses the first of them, and ends the process where a line has no numbers.
    """
    with path.open(encoding="latin-1") as file:
        head = [*itertools.islice(file, 3)]
        if len(head) == 3 and path.suffix.lower() == ".xyz":
            molecule = molecules.of_xyz([*head, *file], path)
            if molecule is not None:
                return molecule
        file.seek(0)
        first = file.readline().split()
        count = int(first[0]) if len(first) == 1 else None
        if count is None:
            file.seek(0)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "loadtxt: input contained no data")
            rows = np.loadtxt(file, ndmin=2, comments=("#", "//"))
    if rows.shape[1] not in _SCAN:
        raise ValueError(f"{rows.shape[1]} columns are no places with intensities or colours")
    if count is not None and len(rows) != count:
        raise ValueError(f"{len(rows)} of {count} points are there")
    mesh = pv.PolyData(rows[:, :3].copy())
    if rows.shape[1] == 7 and np.all(rows[:, 6] == 255) and np.ptp(rows[:, 3:6], axis=1).any():
        # Colours with an opacity.
        rows = rows[:, :6]
    if rows.shape[1] in (4, 7):
        mesh.point_data["intensity"] = rows[:, 3]
    if rows.shape[1] > 4:
        _attach_three(mesh, rows[:, -3:], path)
    return mesh


def _attach_three(mesh: pv.PolyData, rows: Array, path: Path) -> None:
    """Attach the last three numbers of points, which are colours or normals by their values."""
    lengths = np.linalg.norm(rows, axis=1)
    if np.all((rows >= 0) & (rows <= 255) & (rows == np.rint(rows))):
        mesh.point_data["color"] = rows.astype(np.uint8)
    elif np.all((np.abs(lengths - 1) < _UNIT) | (lengths == 0)):
        values: Foreign = rows.astype(np.float32)
        mesh.point_data.set_array(values, "Normals")
        mesh.point_data.active_normals_name = "Normals"
    elif np.all((rows >= 0) & (rows <= 1)):
        mesh.point_data["color"] = np.rint(255 * rows).astype(np.uint8)
    else:
        _check.warn(
            f"file: '{path}': the last three columns are left out: they are neither colours from "
            "0 to 255 or from 0 to 1, nor normals of length 1"
        )


def read_las(path: Path) -> pv.PolyData:
    """Return the points of a LAS file with intensity, classification and colours."""
    import laspy

    # Threads that unpacked one file do not live on in the process that tries the next.
    ways = laspy.LazBackend.detect_available()
    alone = [way for way in ways if way is not laspy.LazBackend.LazrsParallel]
    cloud: Foreign = laspy.read(path, laz_backend=alone or None)
    mesh = pv.PolyData(np.asarray(cloud.xyz, dtype=np.float64))
    mesh.point_data["intensity"] = np.asarray(cloud.intensity)
    mesh.point_data["classification"] = np.asarray(cloud.classification)
    names = {*cloud.point_format.dimension_names}
    if {"red", "green", "blue"} <= names:
        colors = np.stack([cloud.red, cloud.green, cloud.blue], axis=1)
        # Colours have 16 bits by the standard, and 8 by many writers.
        depth = 256 if colors.max(initial=0) > 255 else 1
        mesh.point_data["color"] = (colors // depth).astype(np.uint8)
        if np.any(colors):
            # A scan looks like the place that it is of.
            mesh.point_data.active_scalars_name = "color"
    return mesh


#: Bytes of a record of LAS, and of one that stands after the points.
_LAS_RECORD, _LAS_EXTENDED = 54, 60


def missing_of_las(file: BinaryIO) -> str:
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
