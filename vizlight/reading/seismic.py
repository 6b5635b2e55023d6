"""Traces of SEG-Y files at the places that their headers have, a survey of lines as a volume."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign

#: Ends of names of the files.
SUFFIXES = (".segy", ".sgy")
#: Distance of traces from which a line ends between them, in that of most.
_NEXT_LINE = 1.5
#: Size of the headers up to the first trace, and places in them of the number of samples, of their
#: format, and of the number of samples of that trace; formats that VTK reads.
_HEADERS, _COUNTS, _FORMATS = 3840, (3220, 3224, 3714), {1, 2, 3, 5, 8}


def read(path: Path) -> pv.DataSet:
    """Return the traces of a file by the places of their sources, else of their depth points.

    VTK's reader takes the former alone, which are 0 in files of stacked traces. Where both are, the
    number of a trace is its place.

    Raises
    ------
    ValueError
        If VTK lacks the format of the samples, or the headers differ: it ends the process then.
    """
    # The module loads a large part of VTK.
    from vtkmodules.vtkIOSegY import vtkSegYReader

    with path.open("rb") as file:
        head = file.read(_HEADERS)
    if len(head) == _HEADERS:
        samples, form, in_trace = (int.from_bytes(head[at : at + 2], "big") for at in _COUNTS)
        if form not in _FORMATS:
            raise ValueError(f"samples of the format {form} of SEG-Y; segyio reads them")
        if in_trace and in_trace != samples:
            counts = f"{samples} samples by its header, {in_trace} by that of a trace"
            raise ValueError(f"{counts}; segyio reads it: segyio.open(file, strict=False)")
    reader = vtkSegYReader()
    reader.SetFileName(str(path))
    mesh = _updated(reader)
    if not isinstance(mesh, pv.StructuredGrid) or _has_places(mesh):
        return mesh
    reader.SetXYCoordModeToCDP()
    mesh = _updated(reader)
    count, depths = mesh.dimensions[0], mesh.dimensions[2]
    if not _has_places(mesh):
        np.asarray(mesh.points)[:, 0] = np.tile(np.arange(count), mesh.n_points // count)
        _check.warn(f"file: '{path}': its traces have no places, and stand in a row by number")
        return mesh
    steps: Array = np.linalg.norm(np.diff(mesh.points[:count, :2], axis=0), axis=1)
    ends = np.flatnonzero(steps > _NEXT_LINE * np.median(steps)) + 1
    if len(ends) and np.array_equal(ends, np.arange(ends[0], count, ends[0])):
        mesh.dimensions = (int(ends[0]), count // int(ends[0]), depths)
    return mesh


def _updated(reader: Foreign) -> pv.DataSet:
    reader.Update()
    mesh: pv.DataSet = pv.wrap(reader.GetOutput())
    return mesh


def _has_places(mesh: pv.DataSet) -> bool:
    """Return whether the traces of a file are at several places."""
    return max(mesh.bounds_size[:2]) > 0
