"""Point arrays attached to a mesh, and the names of those that a filter takes."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.reading.arrays import is_of_cells
from vizlight.reading.cells import as_vtk, cell_data, point_data

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight._types import Foreign

DataSetT = TypeVar("DataSetT", bound=pv.DataSet)
#: Number of values below which an array is sooner copied than shared.
_SMALL = 1 << 12


def refuse_unnamed(name: str, value: object) -> None:
    """Raise TypeError for anything but a name of an array or None."""
    if value is not None and not isinstance(value, str):
        remedy = "attach the array to the mesh and pass its name"
        got = _check.describe(value)
        raise TypeError(_check.message(name, "the name of a point array", got, remedy))
    if value is not None:
        _check.text(name, value, expected="the name of a point array")


def averaged(mesh: DataSetT, *names: object) -> DataSetT:
    """Return a mesh with cell arrays averaged to its points, where no point array has the name.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed.
    *names : object
        Names of arrays; what is no name is ignored.

    Returns
    -------
    pyvista.DataSet
        The mesh itself, or a copy that shares its arrays and has the means too.
    """
    wanted = {name for name in names if isinstance(name, str) and is_of_cells(mesh, name)}
    if not wanted:
        return mesh
    only, out = mesh.copy(deep=False), mesh.copy(deep=False)
    only.clear_data()
    for name in wanted:
        only.cell_data[name] = mesh.cell_data[name]
    mean = only.cell_data_to_point_data()
    for name in wanted:
        out.point_data[name] = mean.point_data[name]
    return out


def attach_rows(mesh: pv.DataSet, name: str, array: NDArray[np.generic]) -> None:
    """Attach a point array; a part of a larger array is copied."""
    if array.dtype in (np.float32, np.float64) or not len(array):
        # By VTK itself: PyVista's way takes longer than the light of a small mesh, and refuses an
        # array without rows.
        part = getattr(array.base, "nbytes", 0) > array.nbytes
        copied = part or array.size < _SMALL
        own = as_vtk(array, name) if copied else pv.convert_array(array, name)
        point_data(mesh).AddArray(own)
    elif array.dtype == np.bool_:
        # Without the search for active scalars that assignment adds.
        mesh.point_data.set_array(cast("Foreign", array), name)
    else:
        mesh.point_data[name] = array


def activate(mesh: pv.DataSet, name: str) -> None:
    """Make a point array the active scalars of a mesh, even if a cell array was active."""
    point_data(mesh).SetActiveScalars(name)
    # PyVista's search takes longer than that by VTK, and finds no other where no cells are active.
    if (
        cell_data(mesh).GetScalars() is not None
        and mesh.GetNumberOfPoints()
        and mesh.active_scalars_info.association != pv.FieldAssociation.POINT
    ):
        mesh.set_active_scalars(name, preference="point")


def carry_active(mesh: pv.DataSet, derived: pv.DataSet) -> None:
    """Make the arrays that are active at the points of a mesh active on one with the same names."""
    for attribute in ("Normals", "Vectors", "Scalars", "Tangents", "TCoords"):
        active = getattr(point_data(mesh), f"Get{attribute}")()
        if active is not None:
            getattr(point_data(derived), f"SetActive{attribute}")(active.GetName())
