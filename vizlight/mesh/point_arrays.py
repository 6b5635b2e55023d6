"""Point arrays attached to a mesh, and the names of those that a filter takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check

if TYPE_CHECKING:
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
    """Attach a point array; a part of a larger array is copied."""
    if array.dtype in (np.float32, np.float64) or not len(array):
        # By VTK itself: PyVista's way takes longer than the light of a small mesh, and refuses an
        # array without rows.
        part = array.base is not None and array.base.size > array.size
        mesh.GetPointData().AddArray(pv.convert_array(array, name, deep=part))
    else:
        mesh.point_data[name] = array


def activate(mesh: pv.DataSet, name: str) -> None:
    """Make a point array the active scalars of a mesh, even if a cell array was active."""
    mesh.GetPointData().SetActiveScalars(name)
    if mesh.n_points and mesh.active_scalars_info.association != pv.FieldAssociation.POINT:
        mesh.set_active_scalars(name, preference="point")
