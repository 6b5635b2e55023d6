"""Parts of a structured grid, one after the other, with the faces of its outer surface there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkImageData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
)

from vizlight.reading.arrays import points_of
from vizlight.reading.cells import GHOSTS, as_numpy, as_vtk, connectivity, places
from vizlight.reading.hull import outer_surface

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import TypeGuard

    from numpy.typing import NDArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from vizlight._types import Bools, Dataset, Foreign, Indices

    Grid: TypeAlias = vtkImageData | vtkRectilinearGrid | vtkStructuredGrid

#: Number of points of a part. Its surface takes some 200 bytes for each of them.
PART = 1 << 14
#: Share of the points of a grid on its surface up to which that takes little memory as a whole.
FEW = 1 / 16


class Part(NamedTuple):
    """The outer surface of some layers of a grid, with the layer before and the one after them.

    Attributes
    ----------
    surface : vtkPolyData
        Faces around all points of those layers.
    origin : ndarray of int
        Point of the grid that each point of the surface is.
    side : ndarray of int8
        0 for points of those layers, -1 in the layer before, 1 in the layer after.
    """

    surface: vtkPolyData
    origin: Indices
    side: NDArray[np.int8]


def in_parts(mesh: Dataset) -> TypeGuard[Grid]:
    """Return whether a mesh is a grid, all of it seen, whose surface takes much memory."""
    if not isinstance(mesh, vtkImageData | vtkRectilinearGrid | vtkStructuredGrid):
        return False
    size = np.array(dimensions(mesh))
    count = size.prod()
    # Without two axes along which it extends a grid has no faces.
    if count <= PART or np.count_nonzero(size > 1) < 2:
        return False
    # A cube has few points on its surface; a sheet has all of them there.
    if count - np.maximum(size - 2, 0).prod() <= FEW * count:
        return False
    return not any(data.HasArray(GHOSTS) for data in (mesh.GetPointData(), mesh.GetCellData()))


def dimensions(mesh: Grid) -> tuple[int, int, int]:
    """Return the number of points of a grid along each of its axes."""
    low, high = np.reshape(mesh.GetExtent(), (3, 2)).T.tolist()
    i, j, k = (b - a + 1 for a, b in zip(low, high, strict=True))
    return i, j, k


def parts(mesh: Grid) -> Iterator[Part]:
    """Yield the surface of a grid by layers across its longest axis."""
    size = dimensions(mesh)
    axis = max(range(3), key=lambda i: (size[i], i))
    count = size[axis]
    layers = max(PART * count // mesh.GetNumberOfPoints(), 1)
    for start in range(0, count, layers):
        stop = min(start + layers, count)
        low, high = max(start - 1, 0), min(stop + 1, count)
        # A layer more on either side: normals and borders at the cut are then those of the whole.
        surface, own = outer_surface(_layers(mesh, axis, low, high))
        inner = (*size[:axis], high - low, *size[axis + 1 :])
        index = list(np.unravel_index(own, inner, order="F"))
        index[axis] = layer = index[axis] + low
        side = (layer >= stop).astype(np.int8) - (layer < start)
        _keep_around(surface, side == 0)
        yield Part(surface, np.ravel_multi_index(index, size, order="F"), side)


def _layers(mesh: Grid, axis: int, low: int, high: int) -> Foreign:
    """Return some layers of a grid across an axis as a grid."""
    found: Foreign = mesh.NewInstance()
    extent = list(mesh.GetExtent())
    extent[2 * axis : 2 * axis + 2] = extent[2 * axis] + low, extent[2 * axis] + high - 1
    own = slice(low, high)
    if isinstance(mesh, vtkStructuredGrid):
        points = vtkPoints()
        kept = tuple(own if i == axis else slice(None) for i in (2, 1, 0))
        cube = places(mesh).reshape(*dimensions(mesh)[::-1], 3)
        points.SetData(as_vtk(cube[kept].reshape(-1, 3)))
        found.SetExtent(extent)
        found.SetPoints(points)
        return found
    found.CopyStructure(mesh)
    found.SetExtent(extent)
    if isinstance(mesh, vtkRectilinearGrid):
        stored = (mesh.GetXCoordinates, mesh.GetYCoordinates, mesh.GetZCoordinates)[axis]()
        put = (found.SetXCoordinates, found.SetYCoordinates, found.SetZCoordinates)[axis]
        put(as_vtk(as_numpy(stored)[own]))
    return found


def _keep_around(surface: vtkPolyData, points: Bools) -> None:
    """Take the faces, all of four corners, that have none of some points from a surface."""
    quads = connectivity(surface.GetPolys())[0].reshape(-1, 4)
    kept = as_vtk(quads[points[quads].any(axis=1)].ravel())
    cells = vtkCellArray()
    cells.SetData(4, kept)
    surface.SetPolys(cells)


def rim(mesh: Grid) -> list[NDArray[np.generic]]:
    """Return the points along the four borders of a sheet; none for a grid that fills space."""
    size = dimensions(mesh)
    if 1 not in size:
        return []
    row, _ = (n for n in size if n > 1)
    points, last = points_of(mesh, None), mesh.GetNumberOfPoints()
    lines = slice(row), slice(last - row, last), slice(0, last, row), slice(row - 1, last, row)
    return [points[line] for line in lines]
