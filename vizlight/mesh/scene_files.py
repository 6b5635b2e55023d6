"""Files of scenes, VRML and 3DS: each shape placed by its transforms."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check

if TYPE_CHECKING:
    from pathlib import Path

    from vizlight._types import Foreign, Raw

SUFFIXES = (".wrl", ".vrml", ".3ds")
#: VTK's parser of VRML keeps its state in variables of the process.
_LOCK = threading.Lock()


def read(path: Path) -> pv.MultiBlock:
    """Return the shapes of a scene that have points, in the space of the whole.

    Parameters
    ----------
    path : pathlib.Path
        Path of a file with a suffix among ``SUFFIXES``.
    """
    from vtkmodules.vtkIOImport import vtk3DSImporter, vtkVRMLImporter

    of_3ds = path.suffix.lower() == ".3ds"
    importer: Foreign = vtk3DSImporter() if of_3ds else vtkVRMLImporter()
    importer.SetFileName(str(path))
    shapes, empty = pv.MultiBlock(), 0
    with _LOCK:
        importer.Update()
        actors = importer.GetRenderer().GetActors()
        every = [actors.GetItemAsObject(i) for i in range(actors.GetNumberOfItems())]
        for actor in every:
            if (shape := _placed(actor)) is not None:
                shapes.append(shape)
            else:
                empty += 1
    if empty and shapes.n_blocks:
        _check.warn(f"file: '{path}': {empty} of {len(every)} shapes are left out: no points")
    return shapes


def _placed(actor: Foreign) -> pv.PolyData | None:
    """Return the shape of an actor where it stands, None if it has no points."""
    mapper = actor.GetMapper()
    if mapper is None:
        return None
    mapper.Update()
    shape = mapper.GetInput()
    if shape is None or not shape.GetNumberOfPoints():
        return None
    colors = _colors(shape, mapper.GetLookupTable())
    if colors is not None:
        shape.GetPointData().SetScalars(None)
    # Normals are turned as normals, which a scale of unequal factors leaves upright.
    placed: pv.PolyData = pv.wrap(shape).transform(
        pv.array_from_vtkmatrix(actor.GetMatrix()), transform_all_input_vectors=False, inplace=False
    )
    if colors is not None:
        placed.point_data["color"] = colors
    return placed


def _colors(shape: Foreign, table: Foreign) -> Raw | None:
    """Return the colours of the points of a shape, which VTK numbers, one or more too many."""
    scalars = shape.GetPointData().GetScalars()
    # Without colours in the file the table is empty.
    colors: Raw = pv.convert_array(table.GetTable())
    if scalars is None or not 0 < shape.GetNumberOfPoints() <= scalars.GetNumberOfTuples():
        return None
    numbers = pv.convert_array(scalars)[: shape.GetNumberOfPoints()].astype(np.intp)
    if numbers.ndim > 1 or not 0 <= numbers.min() <= numbers.max() < len(colors):
        return None
    return np.asarray(colors[numbers, :3])
