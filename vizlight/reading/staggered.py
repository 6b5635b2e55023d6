"""Values at the sides of the cells of a grid, averaged to the middles of the cells."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from vizlight._types import Array, Foreign

#: Distance of a place from the middle of two others, as a share of their distance.
MIDDLE = 0.01


def alike(
    file: Foreign, letters: Mapping[str, str], ticks: Mapping[str, Array | None]
) -> dict[str, str]:
    """Return the dimension of the middles of cells for each dimension of their sides.

    A dimension of sides is longer or shorter by one, or as long, as ``eta_u`` and ``eta_rho``. The
    dimension of the middles is the one along the same axis that most variables have. Coordinates
    must agree; without coordinates the names begin alike, such as ``west_east_stag`` and
    ``west_east``, ``xi_u`` and ``xi_rho``. ``letters`` has the axis of each dimension.
    """
    counts = {
        dim: sum(dim in variable.dims for variable in file.variables.values() if variable.ndim > 1)
        for dim in letters
    }
    middles: list[str] = []
    result: dict[str, str] = {}
    for dim in sorted(letters, key=lambda name: -counts[name]):
        if letters[dim] not in ("x", "y", "z"):
            continue
        for middle in middles:
            if letters[middle] == letters[dim] and _beside(file.sizes, ticks, dim, middle):
                result[dim] = middle
                break
        else:
            middles.append(dim)
    return result


def _beside(
    sizes: Mapping[str, int], ticks: Mapping[str, Array | None], dim: str, middle: str
) -> bool:
    """Return whether a dimension is that of the sides of the cells of another."""
    more = sizes[dim] - sizes[middle]
    at, of = ticks[dim], ticks[middle]
    if abs(more) > 1 or min(sizes[dim], sizes[middle]) < 2:
        return False
    if at is None and of is None:
        pairs = zip(dim, middle, strict=False)
        start = sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], pairs))
        return 2 * start >= min(len(dim), len(middle))
    if at is None or of is None or not more:
        return False
    long, short = (at, of) if more > 0 else (of, at)
    middles, steps = (long[1:] + long[:-1]) / 2, np.abs(np.diff(long))
    # Steps may be unequal.
    inside = (short - long[:-1]) * (long[1:] - short) > 0
    near = np.abs(short - middles) < MIDDLE * steps
    return bool(inside.all() and np.mean(near) >= 0.5)


def to_middles(
    values: Foreign, dims: Sequence[str], middles: Mapping[str, str], sizes: Mapping[str, int]
) -> Foreign | None:
    """Return values on other dimensions of the same cells, None where these are not related.

    Where the sides are fewer than the middles, the first and the last middle have no value.
    ``middles`` are those of :func:`alike`, and ``dims`` the dimensions of the middles.
    """
    target = [middles.get(str(dim), str(dim)) if dim not in dims else dim for dim in values.dims]
    more = [values.sizes[dim] - sizes[to] for dim, to in zip(values.dims, target, strict=True)]
    if {*target} != {*dims} or not any(more):
        return None
    result = values.variable
    for dim, to, change in zip(values.dims, target, more, strict=True):
        if change:
            left, right = result.isel({dim: slice(None, -1)}), result.isel({dim: slice(1, None)})
            result = 0.5 * (left + right)
        if change < 0:
            result = result.pad({dim: 1}, constant_values=np.nan)
        result = type(result)([to if name == dim else name for name in result.dims], result.data)
    result.attrs = values.attrs
    return result
