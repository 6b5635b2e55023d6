"""Files of meshers and solvers, by meshio and by VTK's reader of AVS."""

from __future__ import annotations

import math
import re
import threading
import warnings
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv

from vizlight import _check, _supervise
from vizlight._types import Foreign
from vizlight.mesh import meaning
from vizlight.reading import file_parts, series

#: Words for the arrays of gmsh.
_GMSH = {"gmsh:physical": "Physical group", "gmsh:geometrical": "Geometrical entity"}
#: Header of the elements of gmsh in text.
_ELEMENTS = re.compile(rb"\n\$Elements\r?\n(\d+)(?:[ \t]+(\d+)[ \t]+\d+[ \t]+\d+)?[ \t]*\r?\n")


def read(path: Path) -> pv.DataSet:
    """Return a mesh by the first reader of meshio that takes a file.

    ``meshio.read`` prints the messages of its readers, and ends the process. Names of parts are
    left out: gmsh's sets are not of the form that PyVista takes, and their numbers are cell data.
    """
    import meshio

    # The class is replaced for the whole process: meshio makes a console for each message.
    meshio._common.Console, _SAID.texts = _Console, []
    kinds = meshio.extension_to_filetypes.get(path.suffix.lower(), ["med"])
    for kind in kinds:
        reader = getattr(meshio, kind)
        try:
            with warnings.catch_warnings():
                # NumPy warns of lines without numbers, which the reader counts, and of others.
                warnings.simplefilter("ignore")
                warnings.filterwarnings("error", "string or file could not be read to its end")
                data = _with_short_fields(path, reader) if kind == "nastran" else reader.read(path)
        except (meshio.ReadError, LookupError, ValueError) as error:
            if str(error).startswith("Incompatible cell data"):
                data = _without_data(path, reader)
                break
            # Several formats may have one suffix: only the last of them tells what is wrong.
            if kind == kinds[-1]:
                raise
        else:
            break
    if not data.cells:
        raise ValueError("it has no cells")
    content = path.read_bytes()
    if path.suffix.lower() == ".msh" and (head := _ELEMENTS.search(content)):
        # Before version 4 their number stands alone, and since then between others.
        stated = int(head[2] or head[1])
        file_parts.warn_of_less(path, sum(len(part.data) for part in data.cells), stated, "cells")
    if b"\0" not in content:
        file_parts.warn_of_last_line(path, content)
    data.cell_sets = {}
    _drop_short(data)
    for name in data.point_data.keys() & data.cell_data.keys():
        # A name stands for one array, and those of cells are the materials.
        data.point_data[f"{name} of points"] = data.point_data.pop(name)
    # PyVista adds one axis that is missing, and not two.
    data.points = np.pad(data.points, ((0, 0), (0, max(3 - data.points.shape[1], 0))))
    try:
        mesh = pv.from_meshio(data)
    except KeyError as error:
        raise ValueError(f"it has cells {error.args[0]!r}, which VTK has not") from None
    words = {name: {"long_name": _GMSH[name]} for name in mesh.cell_data if name in _GMSH}
    if words:
        meaning.attach(mesh, meaning.Meaning(arrays=words))
    if _SAID.texts:
        more = f" (the first of {len(_SAID.texts)} warnings)" if len(_SAID.texts) > 1 else ""
        _check.warn(f"file: '{path}': {_SAID.texts[0]}{more}")
    return mesh


#: An element of Nastran in lines of four long fields, and one of the lines after its first.
_LONG_ELEMENT = re.compile(rb"(?m)^(C[A-Z0-9]+)\*(.*\n(?:\*.*\n)*)")


def _with_short_fields(path: Path, reader: Foreign) -> Foreign:
    """Return what meshio reads of a file of Nastran, of which it takes elements in short fields."""
    content = path.read_bytes()
    if not _LONG_ELEMENT.search(content):
        return reader.read(path)
    with _supervise.folder(path) as folder:
        draft = folder / path.name
        draft.write_bytes(_LONG_ELEMENT.sub(_in_short_fields, content))
        return reader.read(draft)


def _in_short_fields(element: re.Match[bytes]) -> bytes:
    # Lines begin with a field of eight: the first with the name, of which the star is left.
    lines = (b" " * (len(element[1]) + 1) + element[2]).splitlines()
    fields = [line[at : at + 16].strip() for line in lines for at in (8, 24, 40, 56)]
    words = [b"%-8b" % field for field in fields]
    starts = [element[1], *[b"+"] * len(words)]
    return b"".join(
        b"%-8b%b\n" % (start, b"".join(words[8 * k : 8 * k + 8]).rstrip())
        for k, start in enumerate(starts[: -(-len(words) // 8)])
    )


#: Values of cells in a file of gmsh, which need not be those of all cells.
_OF_SOME_CELLS = re.compile(rb"(?s)\$(Element(?:Node)?Data)\b.*?\$End\1\s*")


def _without_data(path: Path, reader: Foreign) -> Foreign:
    """Return what meshio reads of a file whose values are those of some cells alone."""
    with _supervise.folder(path) as folder:
        draft = folder / path.name
        draft.write_bytes(_OF_SOME_CELLS.sub(b"", path.read_bytes()))
        data = reader.read(draft)
    _check.warn(f"file: '{path}': its values of some cells alone are left out")
    return data


def _drop_short(data: Foreign) -> None:
    """Leave out arrays without a row for each cell: meshio skips the groups of bars of Nastran."""
    n_cells = sum(len(cells.data) for cells in data.cells)
    for name, rows in [*data.cell_data.items()]:
        if (count := sum(map(len, rows))) != n_cells:
            del data.cell_data[name]
            _check.warn(f"file: {name!r} has {count} rows for {n_cells} cells, and is left out")


#: Messages of meshio, by thread.
_SAID = threading.local()


class _Console:
    """Stands for the console on which meshio prints: its messages are kept, by thread."""

    def __init__(self, **_options: object) -> None:
        pass

    def print(self, text: str, **_options: object) -> None:
        """Keep a text without its marks of style."""
        plain = " ".join(re.sub(r"\[/?[a-z]+\]|Warning:", "", text).split())
        _SAID.texts = [*getattr(_SAID, "texts", ()), plain]


def read_avs(path: Path) -> pv.DataSet:
    """Return the mesh of an AVS UCD file, without the comments before its counts."""
    lines = path.read_bytes().splitlines(keepends=True)
    with _supervise.folder(path) as folder:
        draft = folder / "draft.avs"
        draft.write_bytes(b"".join(line for line in lines if not line.startswith(b"#")))
        mesh: pv.DataSet = series.unchecked(pv.AVSucdReader(draft))
    return mesh


#: Reason why a file is none of Tecplot.
NO_TECPLOT = (
    "no VARIABLES and ZONE are in it; a table is read as .csv whose first line names its columns, "
    "such as x, y, z, p"
)
#: Corners of a cell of Tecplot by its name.
_CORNERS = {b"TRIANGLE": 3, b"QUADRILATERAL": 4, b"TETRAHEDRON": 4, b"BRICK": 8}


def missing_of_tecplot(file: BinaryIO) -> str:
    """Compare the counts of zones with the numbers in the file."""
    data = file.read()
    names = re.search(rb"(?is)VARIABLES\s*=(.*?)^\s*ZONE", data, re.MULTILINE)
    zones = re.findall(rb"(?im)^\s*ZONE\b([^\n]*(?:\n[^\n]*=[^\n]*)*)", data)
    if names is None:
        return NO_TECPLOT
    if data.count(b'"') % 2:
        return "a name in it has no end, for which VTK's reader waits"
    # Some zones share variables, have some at cells, or repeat numbers.
    if re.search(rb"(?i)\*|VARSHARE|VARLOCATION", data):
        return ""
    columns = len(re.findall(rb'"[^"]*"|[^\s,"]+', names[1]))
    least = 0
    for zone in zones:
        pairs = re.findall(rb"(?i)\b(N|NODES|E|ELEMENTS|I|J|K)\s*=\s*(-?\d+)", zone)
        counts = {key.upper(): int(word) for key, word in pairs}
        if min(counts.values(), default=0) < 0:
            return "a count of a zone is negative"
        kind = re.search(rb"(?i)\bET\s*=\s*(\w+)", zone)
        corners = _CORNERS.get(kind[1].upper(), 0) if kind else 0
        points = counts.get(b"N", counts.get(b"NODES", math.prod(counts.get(k, 1) for k in _IJK)))
        cells = counts.get(b"E", counts.get(b"ELEMENTS", 0))
        least += points * columns + cells * corners
    rows = re.findall(rb"(?m)^[ \t]*[-+.\d].*", data.replace(b",", b" "))
    there = sum(len(row.split()) for row in rows)
    return f"{there} of {least} numbers are there" if there < least else ""


_IJK = (b"I", b"J", b"K")


def missing_of_avs(file: BinaryIO) -> str:
    """Count the lines of points and cells of AVS, whose header states both."""
    data = file.read()
    if data.lstrip()[:1] in (b"*", b"\7"):
        return ""  # a file of Abaqus, or a binary one
    lines = [line for line in data.splitlines() if not line.lstrip().startswith(b"#")]
    words = lines[0].split() if lines else []
    if len(words) != 5 or not all(map(bytes.isdigit, words)):
        return "its first line is no five counts, as that of AVS is"
    least = 1 + int(words[0]) + int(words[1])
    if len(lines) < least:
        return f"{len(lines)} of {least} lines of points and cells are there"
    return "" if len(lines[least - 1].split()) > 3 else "a cell is not whole"
