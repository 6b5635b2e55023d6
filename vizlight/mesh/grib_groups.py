"""Files of GRIB with several grids: the group of variables on one of them."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vizlight._types import Foreign

__all__ = ["first_group"]


def first_group(path: Path, at: Mapping[str, object]) -> tuple[Foreign, dict[str, object], str]:
    """Return the first group with data on one grid, as cfgrib sorts the variables of a file.

    Parameters
    ----------
    path : pathlib.Path
    at : mapping
        Values of coordinates; those that a group has only one value of choose the group.

    Returns
    -------
    xarray.Dataset
        Group, whose times are numbers.
    dict
        The values of ``at`` along its axes.
    str
        Words for the other groups.

    Raises
    ------
    ValueError
        If no group has such values, or the grid of the file is unknown.
    """
    # No extra has it: who reads GRIB installs it, and xarray finds it.
    cfgrib: Foreign = importlib.import_module("cfgrib")
    try:
        groups: list[Foreign] = cfgrib.open_datasets(str(path), decode_times=False)
    except KeyError as error:
        raise ValueError(
            f"ecCodes does not know its grid: {error} is missing, as where the file gives only the "
            "number of a grid in a list of its centre; write it with the grid described, "
            "such as by wgrib2 or cdo"
        ) from error
    groups = [group for group in groups if group.data_vars]
    for i, group in enumerate(groups):
        single = {name for name in at if name in group.coords and group.coords[name].ndim == 0}
        if all(_is(group.coords[name].item(), at[name]) for name in single) and all(
            name in single or name in group.sizes for name in at
        ):
            others = "; ".join(_words(one) for k, one in enumerate(groups) if k != i)
            along = {name: value for name, value in at.items() if name not in single}
            note = f"one of {len(groups)} groups of variables, {_words(group)}; others: {others}"
            return group, along, note
    there = "; ".join(map(_words, groups))
    raise ValueError(f"at: no group of variables has {dict(at)}, but there are {there}")


def _is(value: object, wanted: object) -> bool:
    return str(value) == str(wanted) or value == wanted


def _words(group: Foreign) -> str:
    """Return the names of the variables of a group, and of the level that tells it apart."""
    names = ", ".join(map(str, group.data_vars))
    kinds = {str(one.attrs.get("GRIB_typeOfLevel", "")) for one in group.data_vars.values()}
    levels = [
        f"{kind} {group.coords[kind].item():g}" if group.coords[kind].ndim == 0 else kind
        for kind in sorted(kinds)
        if kind in group.coords
    ]
    return f"{names} at {', '.join(levels)}" if levels else names
