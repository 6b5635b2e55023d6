"""Tables of text: points by columns of places, and columns of values for the points of a mesh."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array
from vizlight.mesh import georeference, meaning

#: Ends of names of tables, and what may stand between their columns.
SUFFIXES, SEPARATORS = (".csv", ".tsv"), ",;\t"
#: Names of columns of places, in lower case and without units, and those that are in degrees.
_PLACES = (
    ("x", "y", "z"), ("points:0", "points:1", "points:2"), ("points_0", "points_1", "points_2"),
    ("x coordinate", "y coordinate", "z coordinate"), ("easting", "northing", ""),
)  # fmt: skip
_DEGREES = (("longitude", "latitude", ""), ("lon", "lat", ""), ("long", "lat", ""),
            ("lng", "lat", ""))  # fmt: skip
#: Unit after a name, and words for a number that is missing.
_UNIT = re.compile(r"\s*[(\[].*$")
_MISSING = {"", "na", "n/a", "nan", "null", "none", "-"}


def read(path: Path) -> pv.PolyData:
    """Return the points of a table by its columns of places, with their values.

    Raises
    ------
    ValueError
        If its first line names none, or it has no rows.
    """
    columns, left_out = _columns(path)
    plain = {_UNIT.sub("", name).strip().lower(): name for name in reversed(columns)}
    places = next((names for names in (*_PLACES, *_DEGREES) if {*names[:2]} <= {*plain}), None)
    if places is None:
        there = ", ".join(map(repr, [*columns, *left_out]))
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
    if places in _DEGREES:
        mesh.field_data[georeference.UNIT] = [georeference.DEGREE]
        axis_words = ["x longitude in degrees by its name", "y latitude in degrees by its name"]
        meaning.attach(mesh, meaning.Meaning(axes=axis_words))
    notes = [f"columns of text: {', '.join(left_out)}"] if left_out else []
    notes += [f"{np.sum(~known)} rows without a place"] if not known.all() else []
    if notes:
        _check.warn(f"file: '{path}': left out are {'; '.join(notes)}")
    return mesh


def add(mesh: pv.DataSet, path: Path) -> None:
    """Add the columns of a table to the points of a mesh, row by row.

    A first line of numbers is a row, in a table that would else lack one; columns are then named
    after the file.

    Raises
    ------
    ValueError
        If it has another number of rows, with both numbers, or is no table.
    """
    try:
        columns, _ = _columns(path)
        sizes = {len(rows) for rows in columns.values()}
        if mesh.n_points not in sizes and _numbers([*columns], comma=False) is not None:
            columns, _ = _columns(path, named=False)
    except ValueError as error:
        raise ValueError(f"its overlay '{path}' is no table: {error}") from error
    for name, rows in columns.items():
        if len(rows) != mesh.n_points:
            got = f"{len(rows)} rows for a mesh of {mesh.n_points} points"
            raise ValueError(f"its overlay '{path}' has {got}")
        mesh.point_data[name] = rows


def _columns(path: Path, *, named: bool = True) -> tuple[dict[str, Array], list[str]]:
    """Return the columns of numbers by their names, and the names of those of text.

    ``named`` says whether the first line has names.
    """
    with path.open(encoding="utf-8-sig", newline="", errors="replace") as file:
        first = file.readline()
        separator = max(SEPARATORS, key=first.count)
        names = next(csv.reader([first.lstrip("# ")], delimiter=separator), [])
        rows = [row for row in csv.reader(file, delimiter=separator) if any(map(str.strip, row))]
    if not named:
        rows = [names, *rows]
        single = len(names) == 1
        names = [path.stem if single else f"{path.stem} {i + 1}" for i in range(len(names))]
    if rows and all(len(row) == len(names) + 1 and not row[-1].strip() for row in rows):
        # Some programs end each row, but not the first line, by a separator.
        rows = [row[:-1] for row in rows]
    uneven = next((row for row in rows if len(row) != len(names)), None)
    if uneven is not None:
        raise ValueError(f"a row has {len(uneven)} columns for {len(names)} names: {uneven}")
    if not rows:
        raise ValueError("it has no rows below its first line")
    columns: dict[str, Array] = {}
    of_text = []
    for i, name in enumerate(names):
        values = _numbers([row[i].strip() for row in rows], comma=separator == ";")
        if values is None:
            of_text.append(name.strip())
        else:
            columns[name.strip() or f"column {i + 1}"] = values
    return columns, of_text


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
