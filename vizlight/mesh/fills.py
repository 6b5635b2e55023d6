"""Values that stand for none though nothing says so, such as -9999: one rule for all data."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Raw
from vizlight.mesh import meaning
from vizlight.mesh.blocks import DataSetT

#: Values that stand for none in files that do not say so, beside those whose digits are all 9.
_LIMITS = {-(2.0**15), 1 - 2.0**15, 2.0**15 - 1, 2.0**16 - 1, -(2.0**31), 2.0**31 - 1}
#: Least size of a value that is none, as 1e20, 9.97e36 and 3.4e38 are, and its least multiple of
#: all others where it stands once: masses of stars are as large.
_HUGE, _ALONE = 1e15, 1e9


def _seems_missing(value: float) -> bool:
    """Return whether a number is one of those that stand for none."""
    if value in _LIMITS or abs(value) >= _HUGE:
        return True
    # Of -9.99e8, too, and of none below 1.
    digits = f"{abs(value):.6g}".partition("e+")[0].replace(".", "")
    # 99 may be a number of percents.
    return len(digits) > (1 if value < 0 else 2) and set(digits) == {"9"}


def without_missing(name: str, values: Raw, nodata: float | None = None) -> tuple[Raw, str]:
    """Return values with NaN where they are missing though the file does not say so.

    One value far outside of all others, repeated, that is usual for this: -9999, -32768, 32767,
    1e20, -3.4e38 and the like. ``nodata`` is sought in place of such a value; NaN ends the search.
    Values are copied, in floating point, where one is missing; the words have the value and its
    share.
    """
    if values.dtype.kind not in "iuf" or not values.size:
        return values, ""
    finite: Raw = values[np.isfinite(values)] if values.dtype.kind == "f" else values.ravel()
    missing = [nodata] if nodata is not None else _outliers(finite)
    words = []
    for value in missing:
        if value is None or math.isnan(value):
            continue
        # Floating-point numbers are rounded to the type of the values.
        at = np.isclose(values.astype(np.float64), value, rtol=1e-6, atol=0)
        if not at.any():
            continue
        if values.dtype.kind != "f":
            values = values.astype(np.float32 if values.dtype.itemsize <= 2 else np.float64)
        values = np.where(at, np.nan, values).astype(values.dtype)
        share = at.mean()
        words.append(f"{100 * share:.2g} % of {name!r} are {value:g}")
    return values, " and ".join(words)


def _outliers(finite: Raw) -> list[float]:
    """Return the values at the ends of all others that stand for none."""
    result: list[float] = []
    rest = finite
    for _ in range(2):
        if not rest.size:
            break
        for end in (float(rest.min()), float(rest.max())):
            if not _seems_missing(end):
                continue
            inner = rest[rest != end]
            if not inner.size:
                continue
            low, high = float(inner.min()), float(inner.max())
            gap = low - end if end < low else end - high
            # A single pixel may be a fault of its own, and is seen to be one where it is huge.
            alone = abs(end) >= max(_HUGE, _ALONE * max(abs(low), abs(high)))
            repeated = rest.size - inner.size > 1 or alone
            if repeated and gap > max(high - low, abs(end) / 2):
                result.append(end)
                rest = inner
    return result


def say(path: object, words: Sequence[str]) -> list[str]:
    """Warn of values that were taken for missing, and return notes of them."""
    if words:
        _check.warn(
            f"file: '{path}': {'; '.join(words)}, far from all other values: they are taken for "
            "missing; pass nodata= to name the value, nodata=nan to keep all"
        )
    return [f"{each}, taken for missing" for each in words]


def checked(nodata: object) -> float | None:
    """Return a value that stands for none, NaN for no further one."""
    if nodata is None:
        return None
    if isinstance(nodata, float | np.floating) and math.isnan(nodata):
        return math.nan
    return _check.number("nodata", nodata)


def without_fills(mesh: DataSetT, nodata: float | None = None, /) -> DataSetT:
    """Return a mesh with NaN where values are missing though nothing says so.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed.
    nodata : float, optional
        Value that stands for none. Default: one value far outside of all others and repeated, such
        as -9999, in each array; NaN for none.

    Returns
    -------
    pyvista.DataSet
        Copy that shares the other arrays, with notes of the value and its share; the mesh itself
        where nothing is missing.
    """
    _check.instance("mesh", mesh, pv.DataSet, "a mesh")
    nodata = checked(nodata)
    known, notes = mesh, list[str]()
    for of_cells, data in enumerate((mesh.point_data, mesh.cell_data)):
        for name in data:
            values, missing = without_missing(name, np.asarray(data[name]), nodata)
            if not missing:
                continue
            if known is mesh:
                known = mesh.copy(deep=False)
            (known.cell_data if of_cells else known.point_data)[name] = values
            notes.append(f"{missing}, taken for missing")
    if notes:
        said = meaning.of(mesh)
        said.notes += notes
        meaning.attach(known, said)
    return known
