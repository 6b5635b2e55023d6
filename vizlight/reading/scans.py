"""Scans in files of NRRD and MetaImage, at their places in a body."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import AnyArray, Array
from vizlight.mesh import meaning
from vizlight.reading import brains, file_parts, series

#: Axes of a body that point along x, y and z of a file, as in left-posterior-superior, by their
#: first letters, and signs of those along x to the right, y forward and z up; those of a space of
#: which VTK's reader turns the rows of raw values over.
_SIGNS = {"R": 1.0, "L": -1.0, "A": 1.0, "P": -1.0, "S": 1.0, "I": -1.0}
_TURNED = (-1.0, 1.0, 1.0)
_SPACE = re.compile(r"(?:(right|left)-(anterior|posterior)-(superior|inferior)|([rl][ap][si]))\b")
#: Axes of positions of MetaImage in a body, by ITK, whatever letters its header has for storage.
_LPS = (-1.0, -1.0, 1.0)
_LETTERS = re.compile(r"[RLAPSI]{3}")
#: Bytes in which the header of a file is sought, end of that of NRRD, its word for numbers in
#: letters, and fields of a segment.
_HEAD = 1 << 16
_BLANK, _IN_LETTERS = (
    re.compile(rb"\r?\n\r?\n"),
    re.compile(r"(?mi)^encoding: *(ascii|text|txt)\s*$"),
)
_SEGMENT = re.compile(r"(?m)^Segment(\d+)_(Name|LabelValue|Color):=(.*)$")


def read_nrrd(path: Path) -> pv.DataSet:
    """Return the image of an NRRD file where its space directions say that it is.

    Axes of a body are those of NIfTI: x to the right, y forward and z up. Labels have the names and
    colours of segments, as 3D Slicer writes them. The array of labels is named "segment" if it has
    segments.
    """
    image: pv.DataSet = series.unchecked(pv.get_reader(path))  # type: ignore[no-untyped-call]
    with path.open("rb") as file:
        begin = file.read(_HEAD)
        end = _BLANK.search(begin)
        head = begin[: end.start() if end else None].decode("utf-8", "replace")
        if end and _IN_LETTERS.search(head):
            # VTK's reader takes the letters for bytes of numbers.
            file.seek(end.end())
            (name,) = image.point_data.keys()
            flat = np.asarray(image.point_data[name])
            image.point_data[name] = np.array(file.read().split(), flat.dtype).reshape(flat.shape)
    fields = dict(re.findall(r"(?m)^([a-z ]+):[ \t]+(.*?)\s*$", head))
    words = re.findall(r"none|\([^)]*\)", fields.get("space directions", ""))
    axes = [_numbers(word) for word in words if word != "none"]
    sizes = [
        int(size)
        for size, word in zip(fields.get("sizes", "").split(), words, strict=False)
        if word != "none"
    ]
    origin = _numbers(fields.get("space origin", "(0, 0, 0)"))
    if [len(row) for row in (*axes, origin)] == [3] * 4:
        signs = [
            _SIGNS[word[0].upper()]
            for match in _SPACE.finditer(fields.get("space", "").lower())
            for word in (match[4] or [*match.groups()[:3]])
        ]
        if signs == [*_TURNED] and fields.get("encoding", "").lower() == "raw":
            # VTK's reader begins with the last row of each layer.
            (name,) = image.point_data.keys()
            flat = np.asarray(image.point_data[name])
            image.point_data[name] = _rows_of(image)[:, ::-1].reshape(flat.shape, order="F")
        image = _placed(image, sizes, np.array([*axes, origin]).T, signs, "directions")
    _name_segments(image, head)
    return image


def read_meta(path: Path) -> pv.DataSet:
    """Return the image of a MetaImage file at its place, by the axes of its header.

    Those of a body, if it has an anatomical orientation, are those of NIfTI; as ITK does, places
    are taken for left, posterior, superior.
    """
    image: pv.DataSet = series.unchecked(pv.get_reader(path))  # type: ignore[no-untyped-call]
    begin = file_parts.first_bytes(path, _HEAD)
    head = begin.partition(b"ElementDataFile")[0].decode("utf-8", "replace")
    fields = dict(re.findall(r"(?m)^(\w+)[ \t]*=[ \t]*(.*?)\s*$", head))
    names = ("TransformMatrix", "Rotation", "Orientation")
    rows = next((fields[name] for name in names if name in fields), "1 0 0 0 1 0 0 0 1")
    axes = np.array(_numbers(rows))
    if axes.size == 9 and isinstance(image, pv.ImageData):
        # A row of the header is the direction of an axis of the image.
        columns = axes.reshape(3, 3).T * image.spacing
        is_body = _LETTERS.fullmatch(fields.get("AnatomicalOrientation", "")) is not None
        sizes = [int(size) for size in fields.get("DimSize", "").split()]
        affine = np.column_stack([columns, image.origin])
        image = _placed(image, sizes, affine, _LPS if is_body else (), "matrix")
    return image


def _rows_of(image: pv.DataSet) -> AnyArray:
    """Return the values of the only array of an image, by the numbers of points along its axes."""
    (name,) = image.point_data.keys()
    values: AnyArray = np.asarray(image.point_data[name])
    return values.reshape(*image.dimensions, *values.shape[1:], order="F")


def _numbers(text: str) -> list[float]:
    """Return the numbers of a text, none where one is not finite."""
    words = re.split(r"[\s,]+", text.strip("() \t"))
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return []
    return numbers if np.isfinite(numbers).all() else []


def _placed(
    image: pv.DataSet, sizes: list[int], affine: Array, signs: Sequence[float], word: str
) -> pv.DataSet:
    """Return an image at its place, by 3 x 4 numbers, and signs of the axes of a body, if any.

    One that its reader took for another form than its header says is left.
    """
    is_whole = isinstance(image, pv.ImageData) and [*image.dimensions] == sizes
    if not is_whole or len(image.point_data) != 1 or np.linalg.matrix_rank(affine[:, :3]) < 3:
        return image
    matrix = np.vstack([affine, (0.0, 0.0, 0.0, 1.0)])
    if signs:
        matrix[:3] *= np.reshape(signs, (3, 1))
    (name,) = image.point_data.keys()
    grid = brains.turned(_rows_of(image), matrix, name)
    if signs:
        brains.mark_as_body(grid, word, matrix)
    return grid


def _name_segments(image: pv.DataSet, head: str) -> None:
    """Give labels the names and the colours of the segments in a header."""
    parts: dict[str, dict[str, str]] = {}
    for number, key, value in _SEGMENT.findall(head):
        parts.setdefault(number, {})[key] = value.strip()
    kinds = []
    for part in parts.values():
        try:
            color = [float(word) for word in part["Color"].split()]
            kinds.append((int(part["LabelValue"]), part.get("Name", ""), color))
        except (KeyError, ValueError):
            return  # segments without labels or colours are layers of components
    names = image.point_data.keys()
    if kinds and len(names) == 1 and image.point_data[names[0]].dtype.kind in "iu":
        image.rename_array(names[0], "segment", preference="point")
        said = meaning.of(image)
        said.add_kinds("segment", kinds)
        meaning.attach(image, said)


def _fields(lines: Sequence[bytes], between: str) -> dict[str, str]:
    texts = [line.decode("utf-8", "surrogateescape").partition(between) for line in lines]
    return {key.strip(): rest.strip() for key, found, rest in texts if found}


def missing_of_nrrd(file: BinaryIO) -> str:
    """Compare the header of a scan of NRRD with itself, and its sizes with its data."""
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


def missing_of_meta(file: BinaryIO) -> str:
    """Compare the sizes of a scan of MetaImage with its data."""
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
