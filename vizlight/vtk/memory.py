"""Results of a surface, kept as long as its points are."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from typing import NamedTuple, TypeVar, cast

from vtkmodules.vtkCommonCore import vtkWeakReference
from vtkmodules.vtkCommonDataModel import vtkPolyData

from vizlight._types import Dataset
from vizlight.shading.results import digest
from vizlight.vtk.cells import POLYDATA, as_numpy, places

T = TypeVar("T")

#: Number of points of all surfaces of which something is kept at most, the last ones.
MOST = 1 << 26


class _Kept(NamedTuple):
    """A value, the points as long as which it is kept, and the number of points that it is of."""

    points: vtkWeakReference
    value: object
    size: int


_KEPT: dict[tuple[str, ...], _Kept] = {}
#: Where more things than this are kept, those of deleted points are looked for after so many calls,
#: or after a part of as many as are kept.
_SWEEP = 16
_CALLS = itertools.count()
_LOCK = threading.Lock()


def once(mesh: Dataset, name: str, compute: Callable[[], T], owner: vtkPolyData | None = None) -> T:
    """Return the result of a function of the points and cells of a surface, computed once.

    It is kept for any mesh of the same points and cells, until the points of the surface are
    deleted, and nobody may change it. For another kind of mesh nothing is kept; the points of
    ``owner``, if any, bound the time.
    """
    if not isinstance(mesh, vtkPolyData):
        return compute()
    key = _key(mesh, name)
    if (entry := _KEPT.get(key)) is not None:
        return cast("T", entry.value)
    value = compute()
    points = vtkWeakReference()
    points.Set((mesh if owner is None else owner).GetPoints())
    with _LOCK:
        _KEPT[key] = _Kept(points, value, mesh.GetNumberOfPoints())
        if len(_KEPT) <= _SWEEP or next(_CALLS) % max(_SWEEP, len(_KEPT) // _SWEEP) == 0:
            # Results of deleted points go, and the oldest where they are too many.
            for gone in [each for each, kept in _KEPT.items() if kept.points.Get() is None]:
                del _KEPT[gone]
            size = sum(kept.size for kept in _KEPT.values())
            for oldest in list(_KEPT):
                if size <= MOST:
                    break
                size -= _KEPT.pop(oldest).size
    return value


def recalled(mesh: vtkPolyData, name: str) -> object:
    """Return what :func:`once` keeps of a surface, None where it keeps nothing."""
    entry = _KEPT.get(_key(mesh, name))
    return None if entry is None else entry.value


def _key(mesh: vtkPolyData, name: str) -> tuple[str, ...]:
    """Return what tells a result of a surface from others."""
    # By the values: times of modification do not tell of values that NumPy writes to VTK's memory.
    return name, *_digests(mesh)


def _digests(mesh: vtkPolyData) -> list[str]:
    """Return digests of the points and of the cells of each kind."""
    points = places(mesh)
    texts = [points.dtype.str, digest(points)]
    for count, cells in POLYDATA:
        if count(mesh):
            cell_array = cells(mesh)
            size = cell_array.IsHomogeneous()
            texts.append(digest(as_numpy(cell_array.GetConnectivityArray())))
            # Cells of one size need no offsets, which VTK may hold as a rule alone.
            texts.append(f"{size}" if size > 0 else digest(as_numpy(cell_array.GetOffsetsArray())))
        else:
            texts.append("")
    return texts
