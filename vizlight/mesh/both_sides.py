"""Both sides of a flattened surface, beside each other as blocks that are named by the side."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import pyvista as pv

from vizlight import _check

#: Distance between both sides as a share of the width of one.
APART = 0.08
#: Width over height from which the second side is below the first.
WIDE = 2.2


def both_sides(
    surface: pv.PolyData,
    toward: Sequence[float],
    /,
    *,
    up: Sequence[float] = (0.0, 0.0, 1.0),
    names: Sequence[str],
) -> pv.MultiBlock:
    """Return a surface twice, so that one eye sees both of its sides.

    Parameters
    ----------
    surface : pyvista.PolyData
        Surface, which is not changed.
    toward : vector of 3 components
        Direction toward the eye, from which the first block is seen as it is. The second is turned
        by half a turn about the direction up.
    up : vector of 3 components, default: (0, 0, 1)
        Direction up in the picture, at right angles to ``toward``.
    names : (str, str)
        Names of the two blocks.

    Returns
    -------
    pyvista.MultiBlock
        Two blocks: the second at the right of the first, below it where the surface is wide.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import render
    >>> render.both_sides(pv.Sphere(), (0, -1, 0), names=("front", "back")).keys()
    ['front', 'back']
    """
    _check.instance("surface", surface, pv.PolyData, "a surface")
    carried = surface.point_data.active_normals
    if carried is not None and carried.shape[1:] != (3,):
        raise _check.value_error("surface", "normals of 3 components", _check.describe(carried))
    back, upward = _check.unit("toward", toward), _check.unit("up", up)
    if not isinstance(names, list | tuple) or len(names) != 2:
        raise _check.value_error("names", "two names", _check.describe(names))
    words = [_check.text("names", name) for name in names]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Integer points, vector")
        # Of a copy, since PyVista changes such arrays of the mesh itself.
        turned = surface.copy(deep=False).rotate_vector(
            upward.tolist(), 180, point=surface.center, transform_all_input_vectors=True
        )
    # Whole numbers are colours and labels, which PyVista takes for vectors if there are three.
    for data, other in (
        (surface.point_data, turned.point_data), (surface.cell_data, turned.cell_data)
    ):  # fmt: skip
        for name in data:
            if data[name].dtype.kind != "f":
                other.set_array(data[name], name)
    right = np.cross(upward, back)
    bounds = np.reshape(surface.bounds, (3, 2))
    wide, tall = (float(np.abs(way) @ np.ptp(bounds, axis=1)) for way in (right, upward))
    step = (1 + APART) * wide * right if wide < WIDE * tall else -(1 + APART) * tall * upward
    turned.translate(step.tolist(), inplace=True)
    return pv.MultiBlock(dict(zip(words, (surface.copy(deep=False), turned), strict=True)))
