"""GRIB: of files with variables at several levels or on several grids, those on one grid."""

from __future__ import annotations

import atexit
import functools
import hashlib
import importlib
import math
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from vizlight._types import Foreign, Keywords


@functools.cache
def _folder() -> str:
    """Return the folder of the indices that cfgrib makes, which the end of the process removes."""
    folder = tempfile.mkdtemp(prefix="vizlight-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def _options(path: Path, errors: str) -> Keywords:
    """Return options of cfgrib, which makes an index of its own for each way to treat errors.

    Beside the file an index of another program would be read, fit for none of its variables, and
    made anew for each.
    """
    name = hashlib.sha256(f"{path.resolve()} {errors}".encode()).hexdigest()[:16]
    # Of grids that cfgrib does not know it returns lists, in which every second row may run back.
    keys = ["alternativeRowScanning"]
    path_of_index = f"{_folder()}/{name}.{{short_hash}}"
    return {"errors": errors, "indexpath": path_of_index, "read_keys": keys}


def opened(path: Path, at: Mapping[str, object]) -> tuple[Foreign, dict[str, object], str]:
    """Return the variables of a file; the first group of them, with all others on the same grid.

    ``at`` has values of coordinates; those of which a group has only one choose the group, such as
    ``{"heightAboveGround": 10}``. Times are numbers, and of two variables with one name the second
    is named by its level. The other results are the values of ``at`` along axes, and words for the
    variables on other grids.
    """
    import xarray

    # cfgrib leaves out variables at other levels, unless errors are raised.
    for errors in ("raise", "warn"):
        options: Keywords = {"engine": "cfgrib", "decode_times": False, "decode_coords": "all"}
        try:
            whole = xarray.open_dataset(path, backend_kwargs=_options(path, errors), **options)
        except Exception as error:
            if type(error).__name__ == "DatasetBuildError":
                return _first_group(path, at)
            if errors == "warn":
                raise
        else:
            break
    return whole, dict(at), ""


def missing_messages(data: Foreign) -> list[str]:
    """Return words for variables that lack messages: those of some steps, levels or members.

    cfgrib has opened the data: where a message is missing they are NaN.
    """
    words = []
    for name, variable in data.variables.items():
        # The array that cfgrib reads from is wrapped several times; it knows where messages are.
        array: Foreign = variable._data
        while hasattr(array, "array"):
            array = array.array
        if hasattr(array, "field_id_index"):
            total = math.prod(array.shape[: -array.geo_ndim])
            count = len(array.field_id_index)
            words += [f"{name} has {count} of the {total} messages of its axes"] * (count < total)
    return words


def _first_group(path: Path, at: Mapping[str, object]) -> tuple[Foreign, dict[str, object], str]:
    """Return the first group of variables of a file of several; see :func:`opened`."""
    # No extra has it: who reads GRIB installs it, and xarray finds it.
    cfgrib: Foreign = importlib.import_module("cfgrib")
    try:
        every: list[Foreign] = cfgrib.open_datasets(
            str(path), _options(path, "raise"), decode_times=False
        )
    except KeyError as error:
        raise ValueError(
            f"ecCodes does not know its grid: {error} is missing, as where the file gives only the "
            "number of a grid in a list of its centre; write it with the grid described, "
            "such as by wgrib2 or cdo"
        ) from error
    groups = [group for group in every if group.data_vars and _fits(group, at)]
    if not groups:
        there = "; ".join(map(_words, every))
        raise ValueError(f"at: no group of variables has {dict(at)}, but there are {there}")
    whole = _without_levels(groups[0], dates=True)
    others = []
    for group in groups[1:]:
        more = _without_levels(group)
        renamed = {
            name: f"{name}_{_level(group)}".replace(" ", "")
            for name in more.data_vars
            if name in whole.data_vars
        }
        try:
            whole = whole.merge(more.rename(renamed), join="exact", compat="equals")
        except ValueError:
            others.append(_words(group))
    along = {name: value for name, value in at.items() if name in whole.sizes}
    return whole, along, f"on other grids: {'; '.join(others)}" if others else ""


def _fits(group: Foreign, at: Mapping[str, object]) -> bool:
    """Return whether a group has all requested coordinates, and the value of single ones.

    The reader of the group looks for values along an axis.
    """
    for name, value in at.items():
        if name in group.sizes:
            continue
        if name not in group.coords or group.coords[name].ndim:
            return False
        coordinate = group.coords[name].item()
        if coordinate != value and f"{coordinate:g}" != str(value):
            return False
    return True


def _without_levels(group: Foreign, *, dates: bool = False) -> Foreign:
    """Return a group without its coordinates of one value, such as a level, or all but dates."""
    single = [name for name, values in group.coords.items() if values.ndim == 0]
    kept = [name for name in single if " since " in str(group[name].attrs.get("units"))]
    return group.drop_vars([*{*single} - {*(kept if dates else ())}])


def _level(group: Foreign) -> str:
    """Return the kind of the level of a group, with its value if it is single."""
    kinds = {str(array.attrs.get("GRIB_typeOfLevel", "")) for array in group.data_vars.values()}
    kind = min(kinds)
    single = kind in group.coords and group.coords[kind].ndim == 0
    return f"{kind} {group.coords[kind].item():g}" if single else kind


def _words(group: Foreign) -> str:
    """Return the names of the variables of a group, and their level."""
    return f"{', '.join(map(str, group.data_vars))} at {_level(group)}"
