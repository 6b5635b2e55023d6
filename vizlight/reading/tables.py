"""Tables of text: points by columns of places, and columns of values for the points of a mesh."""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import AnyArray, Array, Foreign
from vizlight.mesh import georeference, meaning

#: Ends of names of tables, and what may stand between their columns.
SUFFIXES, SEPARATORS = (".csv", ".tsv"), ",;\t"
#: Names of columns of places, in lower case and without units, and those that are in degrees.
_PLACES = (
    ("x", "y", "z"), ("points:0", "points:1", "points:2"), ("points_0", "points_1", "points_2"),
    ("x coordinate", "y coordinate", "z coordinate"), ("easting", "northing", ""),
    ("initial x", "initial y", "initial z"), ("xc", "yc", "zc"),
)  # fmt: skip
_DEGREES = (("longitude", "latitude", ""), ("lon", "lat", ""), ("long", "lat", ""),
            ("lng", "lat", ""))  # fmt: skip
#: Unit after a name, and words for a number that is missing.
_UNIT = re.compile(r"\s*[(\[].*$")
_MISSING = {"", "na", "n/a", "nan", "null", "none", "-"}
#: Least rows in the mean of a kind that a column of text names.
LEAST_OF_KIND = 2
#: Most columns that an error names, and most letters of a name in it.
NAMED = 16
#: Name of a first column without one, by which data frames number their rows, and the name that
#: they give to it when they read it again.
INDEX, _UNNAMED = "index", re.compile(r"(Unnamed: 0)?")


def read(path: Path) -> pv.PolyData:
    """Return the points of a table by its columns of places, with their values."""
    columns, texts, lines = _columns(path)
    plain = {_UNIT.sub("", name).strip().lower(): name for name in reversed(columns)}
    usual = (*_PLACES, *_DEGREES, *_longitudes(plain))
    places = next((names for names in usual if {*names[:2]} <= {*plain}), None)
    if places is None:
        there = ", ".join(repr(name[:NAMED]) for name in [*columns, *texts][:NAMED])
        raise ValueError(
            f"its first line has no names of places (x, y, z or lon, lat) but {there}; name them so"
        )
    axes = [columns.pop(plain[name]) for name in places if name in plain]
    points = np.zeros((len(axes[0]), 3))
    points[:, : len(axes)] = np.column_stack(axes)
    known = np.isfinite(points).all(axis=1)
    if not known.any():
        raise ValueError("it has no rows with places")
    mesh = pv.PolyData(points[known])
    for name, rows in columns.items():
        mesh.point_data[name] = rows[known]
    said = meaning.Meaning()
    left_out = [
        name for name, words in texts.items() if not _add_kinds(mesh, said, name, words[known])
    ]
    if places not in _PLACES:
        mesh.field_data[georeference.UNIT] = [georeference.DEGREE]
        said.axes = ["x longitude in degrees by its name", "y latitude in degrees by its name"]
    if said.axes or said.arrays:
        meaning.attach(mesh, said)
    notes = [f"columns of text: {', '.join(left_out)}"] if left_out else []
    notes += [f"{np.sum(~known)} rows without a place"] if not known.all() else []
    notes += [f"{len(lines)} lines of text at its end, such as '{lines[0]}'"] if lines else []
    if notes:
        _check.warn(f"file: '{path}': left out are {'; '.join(notes)}")
    return mesh


def _longitudes(names: Iterable[str]) -> Iterator[tuple[str, str, str]]:
    """Yield longitudes and latitudes with the same words before them, as in Darwin Core."""
    for lon, lat, _ in _DEGREES:
        for name in names:
            before = name.removesuffix(lon)
            if before != name and (before[-1:] in "_ -" or lon == "longitude"):
                yield name, before + lat, ""


def _add_kinds(mesh: pv.PolyData, said: meaning.Meaning, name: str, words: AnyArray) -> bool:
    """Add a column of text to points as the numbers of its kinds, and return whether it is few."""
    missing = np.array([word.lower() in _MISSING for word in words])
    kinds, numbers = np.unique(words[~missing], return_inverse=True)
    if not 1 < len(kinds) <= min(meaning.MOST_KINDS, len(words) // LEAST_OF_KIND):
        return False
    values = np.full(len(words), np.nan)
    values[~missing] = numbers
    mesh.point_data[name] = values
    said.add_kinds(name, [(i, str(kind), ()) for i, kind in enumerate(kinds)])
    return True


def add(mesh: pv.DataSet, path: Path) -> None:
    """Add the columns of a table to the points of a mesh, row by row.

    A first line of numbers is a row, in a table that would else lack one; columns are then named
    after the file.
    """
    try:
        columns, _, _ = _columns(path)
        sizes = {len(rows) for rows in columns.values()}
        if mesh.n_points not in sizes and _numbers([*columns], comma=False) is not None:
            columns, _, _ = _columns(path, named=False)
    except ValueError as error:
        raise ValueError(f"its overlay '{path}' is no table: {error}") from error
    for name, rows in columns.items():
        if len(rows) != mesh.n_points:
            got = f"{len(rows)} rows for a mesh of {mesh.n_points} points"
            raise ValueError(f"its overlay '{path}' has {got}")
        mesh.point_data[name] = rows


def _columns(
    path: Path, *, named: bool = True
) -> tuple[dict[str, Array], dict[str, AnyArray], list[str]]:
    """Return the columns of numbers and those of text by their names, and lines at the end.

    ``named`` says whether the first line has names; in a file of CFX these follow ``[Data]``.
    """
    with path.open(encoding="utf-8-sig", newline="", errors="replace") as file:
        first = file.readline()
        is_of_cfx = first.startswith("[")
        if is_of_cfx and any(line.startswith("[Data]") for line in file):
            first = file.readline()
        separator = max(SEPARATORS, key=first.count)
        form: Foreign = {"delimiter": separator, "skipinitialspace": True}
        names = next(csv.reader([first.lstrip("# ")], **form), [])
        lines = itertools.takewhile(lambda line: not (is_of_cfx and line.startswith("[")), file)
        rows = [row for row in csv.reader(lines, **form) if any(map(str.strip, row))]
    if not named:
        rows = [names, *rows]
        single = len(names) == 1
        names = [path.stem if single else f"{path.stem} {i + 1}" for i in range(len(names))]
    rows, ends = _without_end(rows, separator)
    if rows and all(len(row) == len(names) + 1 and not row[-1].strip() for row in rows):
        # Some programs end each row, but not the first line, by a separator.
        rows = [row[:-1] for row in rows]
    uneven = next((row for row in rows if len(row) != len(names)), None)
    if uneven is not None:
        raise ValueError(f"a row has {len(uneven)} columns for {len(names)} names: {uneven}")
    if not rows:
        raise ValueError("it has no rows below its first line")
    if len(names) > 1 and _UNNAMED.fullmatch(names[0].strip()):
        names[0] = INDEX
    columns: dict[str, Array] = {}
    texts: dict[str, AnyArray] = {}
    for i, name in enumerate(names):
        cells = [row[i].strip() for row in rows]
        values = _numbers(cells, comma=separator == ";")
        if values is None:
            texts[name.strip()] = np.array(cells)
        else:
            columns[name.strip() or f"column {i + 1}"] = values
    return columns, texts, ends


def _without_end(rows: list[list[str]], separator: str) -> tuple[list[list[str]], list[str]]:
    """Return rows without the last ones that are shorter and begin with a word, and these as lines.

    Programs of flow name the step of a table so, as in ``EXT_ITER= 600``.
    """
    count = len(rows)
    while count > 1 and len(rows[count - 1]) < len(rows[0]) and _is_word(rows[count - 1][0]):
        count -= 1
    return rows[:count], [separator.join(row).strip() for row in rows[count:]]


def _is_word(cell: str) -> bool:
    return _numbers([cell], comma=True) is None


def _numbers(cells: list[str], *, comma: bool) -> Array | None:
    """Return numbers, NaN where they are missing, None where any is text.

    ``comma`` says whether they may have a decimal comma.
    """
    cells = ["nan" if cell.lower() in _MISSING else cell for cell in cells]
    if comma:
        cells = [cell.replace(",", ".") for cell in cells]
    try:
        return np.array(cells, dtype=np.float64)
    except ValueError:
        return None
