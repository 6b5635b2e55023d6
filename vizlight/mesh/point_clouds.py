"""PCD files of the Point Cloud Library: points with colours, normals and values."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Array, Foreign, Raw
from vizlight.mesh import meaning

#: Fields of places and of normals, and those whose four bytes are a colour.
_PLACES, _NORMALS = ("x", "y", "z"), ("normal_x", "normal_y", "normal_z")
_COLORS = ("rgb", "rgba")
#: Types of numbers by their letters.
_KINDS = {"F": "f", "I": "i", "U": "u"}
#: Line of the header of a file, and what ends it.
_LINE = re.compile(rb"(?m)^([A-Z]+)[ \t]+(.+?)[ \t\r]*$")
_DATA = re.compile(rb"(?m)^DATA[ \t]+(\w+)[ \t\r]*\n")


def read(path: Path) -> pv.PolyData:
    """Return the points of a PCD file that have a place.

    Raises
    ------
    ValueError
        If its header is none, or points are missing.
    """
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
        axes = ["x to the right", "y away from the camera", "z up"]
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
