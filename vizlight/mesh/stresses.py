"""Stresses of solids: which array has their tensors, and the von Mises stress."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check

if TYPE_CHECKING:
    from vizlight._types import Array

__all__ = ["with_von_mises"]

#: Name of the array of von Mises stress, and names of arrays of tensors of stress.
VON_MISES = "von Mises stress"
_STRESS = re.compile(r"(.*[^a-z])?(s|stress(es)?|sigma|cauchy)([^a-z].*)?")
#: Names of displacements in a mesh with stresses.
_DISPLACEMENT = re.compile(r"(.*[^a-z])?(u|d(e?pl|isp\w*)|deform\w*)([^a-z].*)?")
#: Columns of the normal and of the shear stresses by the number of columns: in a plane with that
#: across it, in space, and of a whole tensor.
_COLUMNS = {4: ((0, 1, 2), (3,)), 6: ((0, 1, 2), (3, 4, 5)), 9: ((0, 4, 8), (1, 2, 5))}


def tensors_of(mesh: pv.DataSet) -> str | None:
    """Return the name of the first array of tensors of stress, None without one."""
    for data in (mesh.point_data, mesh.cell_data):
        for name in data:
            columns = data[name].shape[1:]
            if columns in {(4,), (6,), (9,)} and _STRESS.fullmatch(name.lower()):
                return name
    return None


def displacement(mesh: pv.DataSet) -> tuple[str, float] | None:
    """Return the point array of displacements and the longest one, None where none has a length."""
    for name in mesh.point_data:
        rows = np.asarray(mesh.point_data[name])
        if rows.shape[1:] in {(2,), (3,)} and _DISPLACEMENT.fullmatch(name.lower()):
            longest = float(np.sqrt((rows.astype(np.float64) ** 2).sum(axis=1)).max())
            if 0 < longest < np.inf:
                return name, longest
    return None


def are_in(mesh: pv.DataSet) -> bool:
    """Return whether a mesh has stresses: their tensors, or that of von Mises."""
    return any(map(is_von_mises, mesh.array_names)) or tensors_of(mesh) is not None


def is_von_mises(name: str) -> bool:
    """Return whether an array has the name of von Mises."""
    return "mises" in name.lower()


def with_von_mises(mesh: pv.DataSet, name: str, /) -> pv.DataSet:
    """Return a mesh with the von Mises stress of its tensors, as its active array.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed.
    name : str
        Name of an array of points or of cells: of 4 columns for the stresses xx, yy, zz and xy of
        a plane, of 6 for xx, yy, zz and the three shear stresses in any order, or of 9 for a
        tensor by rows.

    Returns
    -------
    pyvista.DataSet
        Mesh with the array ``"von Mises stress"``, in the unit of the tensors.

    Raises
    ------
    TypeError, ValueError
        If it is no dataset, or has no such array.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> bar = pv.ImageData(dimensions=(2, 2, 2))
    >>> bar["stress"] = [[7.0, 0, 0, 0, 0, 0]] * 8
    >>> float(files.with_von_mises(bar, "stress")["von Mises stress"][0])
    7.0
    """
    _check.instance("mesh", mesh, pv.DataSet, "a pyvista.DataSet")
    name = _check.text("name", name, expected="the name of an array of tensors")
    of_points = name in mesh.point_data
    data = mesh.point_data if of_points else mesh.cell_data
    names = [key for key in mesh.array_names if mesh[key].shape[1:] in {(4,), (6,), (9,)}]
    if name not in data or name not in names:
        expected = f"an array of tensors of 4, 6 or 9 columns, {_check.one_of(names)}"
        raise _check.value_error("name", expected, repr(name))
    tensors: Array = np.asarray(data[name], dtype=np.float64)
    normal, shear = _COLUMNS[tensors.shape[1]]
    differences = tensors[:, normal] - tensors[:, np.roll(normal, 1)]
    squares = 0.5 * (differences**2).sum(axis=1) + 3 * (tensors[:, shear] ** 2).sum(axis=1)
    strained = mesh.copy(deep=False)
    (strained.point_data if of_points else strained.cell_data)[VON_MISES] = np.sqrt(squares)
    strained.set_active_scalars(VON_MISES, preference="point" if of_points else "cell")
    return strained
