"""Point arrays attached to a mesh, and the names of those that a filter takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyvista as pv

from vizlight import _check

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def refuse_unnamed(name: str, value: object) -> None:
    """Raise TypeError for anything but a name of an array or None."""
    if value is not None and not isinstance(value, str):
        remedy = "attach the array to the mesh and pass its name"
        got = _check.describe(value)
        raise TypeError(_check.message(name, "the name of a point array", got, remedy))
    if value is not None:
        _check.text(name, value, expected="the name of a point array")


def attach_rows(mesh: pv.DataSet, name: str, array: NDArray[np.generic]) -> None:
    """Attach a point array; PyVista itself refuses an array without rows."""
    if len(array):
        mesh.point_data[name] = array
    else:
        mesh.GetPointData().AddArray(pv.convert_array(array, name))


def activate(mesh: pv.DataSet, name: str) -> None:
    """Make a point array the active scalars of a mesh, even if a cell array was active."""
    mesh.point_data.active_scalars_name = name
    if mesh.n_points:
        mesh.set_active_scalars(name, preference="point")
