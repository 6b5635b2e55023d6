"""Slices of a volume side by side on one sheet, as radiologists print them."""

from __future__ import annotations

import math

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array
from vizlight.mesh import meaning, records
from vizlight.vtk.cells import dimensions

#: Most slices of a stack, fewest pixels along its slices as a multiple of their number, and least
#: distance of slices in that of their pixels.
MOST, PIXELS, APART = 30, 4, 1.5
#: Width over height of the sheet, and gap between slices as a share of their width.
SHAPE, GAP = 1.5, 0.02


def is_stack(mesh: pv.DataSet) -> bool:
    """Return whether a volume is a stack of few slices, far apart for their pixels."""
    if not isinstance(mesh, pv.ImageData | pv.StructuredGrid) or min(dimensions(mesh)) < 2:
        return False
    count, *others = sorted(dimensions(mesh))
    steps = np.linalg.norm(_steps(mesh), axis=1)
    across = int(np.argmin(dimensions(mesh)))
    apart = steps[across] >= APART * np.delete(steps, across).max()
    return bool(count <= MOST and others[0] >= PIXELS * count and apart)


def side_by_side(volume: pv.DataSet, name: str, /) -> pv.ImageData:
    """Return the slices of a stack on one sheet, in rows from the upper left.

    Slices are seen as they lie in space: x, else y, to the right, and z, else y, up.

    Parameters
    ----------
    volume : pyvista.ImageData or pyvista.StructuredGrid
        Volume, which is not changed; its slices are across its shortest dimension.
    name : str
        Name of a point array of one component.

    Returns
    -------
    pyvista.ImageData
        Sheet with the array, NaN between slices.

    Raises
    ------
    TypeError, ValueError
        If it is no such volume, or has no such array.
    """
    _check.instance("volume", volume, pv.ImageData | pv.StructuredGrid, "an image or a grid")
    _check.text("name", name, expected="the name of a point array")
    values = records.scalars_of(volume, "name", name).astype(np.float32)
    steps, across = _steps(volume), int(np.argmin(dimensions(volume)))
    first, second = (axis for axis in range(3) if axis != across)
    # The axis that rises most is up, and points away from the eye where none does.
    rises = [
        tuple(abs(steps[axis]) / np.linalg.norm(steps[axis]))[::-1] for axis in (first, second)
    ]
    right, up = (first, second) if rises[0] <= rises[1] else (second, first)
    values = values.reshape(dimensions(volume), order="F").transpose(across, up, right)
    for axis, along in ((1, up), (2, right), (0, across)):
        if steps[along][np.argmax(np.abs(steps[along]))] < 0:
            values = np.flip(values, axis)
    wide, high = (float(np.linalg.norm(steps[axis])) for axis in (right, up))
    count, rows, columns = values.shape
    shape = SHAPE * count * (rows * high) / (columns * wide)
    beside = min(max(round(math.sqrt(shape)), 1), count)
    gap = max(round(GAP * columns), 1)
    below = math.ceil(count / beside)
    sheet: Array = np.full(
        (below * (rows + gap) - gap, beside * (columns + gap) - gap), np.nan, "f4"
    )
    for i, part in enumerate(values):
        y, x = (below - 1 - i // beside) * (rows + gap), i % beside * (columns + gap)
        sheet[y : y + rows, x : x + columns] = part
    grid = pv.ImageData(dimensions=(*sheet.shape[::-1], 1), spacing=(wide, high, 1.0))
    grid.point_data[name] = sheet.ravel()
    said = meaning.of(volume)
    said.notes = []
    return meaning.attach(grid, said)


def _steps(mesh: pv.DataSet) -> Array:
    """Return the mean step between points along each dimension of a volume."""
    sizes = np.array(dimensions(mesh))
    strides = np.cumprod([1, *sizes[:-1]])
    points = np.asarray(mesh.points[[0, *((sizes - 1) * strides)]], dtype=np.float64)
    return np.asarray((points[1:] - points[0]) / np.maximum(sizes - 1, 1)[:, np.newaxis])
