"""The pixels of a picture and the cells that they show.

The visible cells are those of one offscreen drawing in which each cell has its number as a colour.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - what draws registers itself
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkBoundingBox, vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from vizlight import _pool
from vizlight.draw.backends import choose_backend, window_class
from vizlight.draw.cameras import footprint
from vizlight.draw.live import in_view
from vizlight.draw.strokes import lay_on_surfaces
from vizlight.model.kernels import unit_rows
from vizlight.vtk.cells import as_numpy, as_vtk

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vtkmodules.vtkCommonCore import vtkPoints

    from vizlight._types import Array, Bools, Indices
    from vizlight.shading.display import Bytes

#: Bits of the three channels.
BITS = 24
#: Number of cells that are drawn at once, so that memory goes by pixels.
BLOCK = 1 << 19


class Cells(NamedTuple):
    """Cells of one mesh as they are drawn.

    Attributes
    ----------
    points : vtkPoints
        Points of the mesh.
    corners : ndarray of int, shape (C, s)
        Points, segments or triangles.
    width : float
        Width of points and of lines in pixels, the least width of lines that have a diameter.
    diameter : float or None
        Diameter of lines in the unit of the mesh.
    """

    points: vtkPoints
    corners: Indices
    width: float
    diameter: float | None = None

    def data(self) -> vtkPolyData:
        """Return the points, segments or triangles as a mesh of VTK."""
        kind = self.corners.shape[1]
        cells, data = vtkCellArray(), vtkPolyData()
        cells.SetData(kind, as_vtk(self.corners.ravel()))
        data.SetPoints(self.points)
        (data.SetVerts, data.SetLines, data.SetPolys)[kind - 1](cells)
        return data

    def blocks(self) -> Iterator[tuple[Cells, int]]:
        """Yield the cells, many of them in parts with points of their own, and each first one."""
        count = len(self.corners)
        for block in _pool.blocks(count, BLOCK):
            if block == slice(0, count):
                yield self, 0
                continue
            ids, corners = np.unique(self.corners[block], return_inverse=True)
            points = pv.vtk_points(as_numpy(self.points.GetData())[ids])
            corners = corners.reshape(-1, self.corners.shape[1]).astype(np.int32)
            yield self._replace(points=points, corners=corners), block.start

    def widths(self, camera: pv.Camera, height: int) -> Array:
        """Return the widths in pixels at the corners' beginnings, in a picture of some height."""
        count = len(self.corners)
        if self.diameter is None:
            return np.full(count, self.width)
        points = as_numpy(self.points.GetData()).astype(np.float64)[self.corners[:, 0]]
        return np.asarray(np.maximum(self.diameter / footprint(camera, points, height), self.width))

    def bands(self, camera: pv.Camera, height: int) -> Cells:
        """Return lines of a diameter as bands that face the eye, two triangles for each segment.

        They are nearer to the eye by half of their width, as a tube is.
        """
        points = as_numpy(self.points.GetData()).astype(np.float64)
        size = footprint(camera, points, height)
        toward = toward_eye(camera, points)
        radius = np.maximum(self.diameter or 0.0, self.width * size)[:, np.newaxis] / 2
        start, end = self.corners.T
        along = points[end] - points[start]
        corners = []
        for ids in (start, end):
            across = radius[ids] * unit_rows(np.cross(toward[ids], along))
            near = points[ids] + radius[ids] * toward[ids]
            corners += [near - across, near + across]
        first = np.arange(len(start)) * 4
        triangles = np.stack([first, first + 1, first + 2, first + 1, first + 3, first + 2], axis=1)
        bands = pv.vtk_points(np.stack(corners, axis=1).reshape(-1, 3))
        return Cells(bands, triangles.reshape(-1, 3), self.width)


class Pixels(NamedTuple):
    """Pixels of a picture that show a cell.

    Attributes
    ----------
    row, column : ndarray of int, shape (M,)
        Places of the pixels, from the upper left.
    part : ndarray of int, shape (M,)
        Number of the mesh that each pixel shows.
    cell : ndarray of int, shape (M,)
        Number of the cell of that mesh.
    size : (int, int)
        Width and height of the picture.
    """

    row: Indices
    column: Indices
    part: Indices
    cell: Indices
    size: tuple[int, int]

    @property
    def at(self) -> Array:
        """Places of the middles of the pixels, to the right and up, in halves of the height."""
        width, height = self.size
        right = (2 * self.column + 1 - width) / height
        up = (height - 2 * self.row - 1) / height
        return np.stack([right, up], axis=1)

    def take(self, rows: Indices | Bools) -> Pixels:
        """Return some of the pixels."""
        places = self.row[rows], self.column[rows]
        return Pixels(*places, self.part[rows], self.cell[rows], self.size)


def visible(
    meshes: Sequence[Cells],
    camera: pv.Camera,
    size: tuple[int, int],
    occluders: Sequence[vtkActor] = (),
) -> Pixels:
    """Return the pixels of a picture that show a cell, and which.

    Parameters
    ----------
    meshes : sequence of Cells
        Cells of each mesh.
    camera : pyvista.Camera
        Camera of the picture; its clipping range is set to show all.
    size : (int, int)
        Width and height in pixels.
    occluders : sequence of vtkActor
        Actors without cells that hide cells.

    Returns
    -------
    Pixels

    Raises
    ------
    BackendError
        If no OpenGL library can draw here.
    """
    starts = np.cumsum([0, *(len(mesh.corners) for mesh in meshes)])
    width, height = size
    with window_class(choose_backend()):
        window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    # A pixel that is mixed of two colours would name a third cell.
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    renderer = vtkRenderer()
    renderer.SetActiveCamera(camera)
    window.AddRenderer(renderer)
    lay_on_surfaces(renderer)
    renderer.ResetCameraClippingRange(_box(meshes, occluders))
    number = np.zeros((height, width), dtype=np.int64)
    # A picture has 24 bits of a cell's number; more cells take more pictures.
    for shift in range(0, max(int(starts[-1]).bit_length(), 1), BITS):
        drawings = _drawings(meshes, starts.tolist(), shift, camera, height, occluders)
        for i, actors in enumerate(drawings):
            renderer.RemoveAllViewProps()
            for actor in actors:
                renderer.AddActor(actor)
            # What was drawn before stays, with its depth.
            renderer.SetPreserveColorBuffer(i > 0)
            renderer.SetPreserveDepthBuffer(i > 0)
            rgb = frame_of(window).astype(np.int64)
        number |= (rgb[..., 0] << 16 | rgb[..., 1] << 8 | rgb[..., 2]) << shift
    window.Finalize()
    # From the lowest row up: places are drawn from them at random.
    from_below, column = np.nonzero(((number > 0) & (number <= starts[-1]))[::-1])
    row = height - 1 - from_below
    cell = number[row, column] - 1
    which = np.searchsorted(starts, cell, side="right") - 1
    return Pixels(row, column, which, cell - starts[which], size)


def frame_of(window: vtkRenderWindow) -> Bytes:
    """Draw a window and return its picture in bytes, shape (H, W, 3), the upper row first."""
    window.Render()
    width, height = window.GetSize()
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 1, pixels, 0)
    # VTK's rows begin at the bottom.
    return as_numpy(pixels).reshape(height, width, 3)[::-1]


def in_pixels(camera: pv.Camera, size: tuple[int, int], points: Array) -> Array:
    """Return where points are in a picture, in pixels from its upper left, to the right and down.

    Points behind the eye have no place in the picture: NaN.
    """
    width, height = size
    places, front = in_view(camera, width / height, points)
    x, y, _ = np.where(front, places.T, np.nan)
    return np.column_stack([(1 + x) / 2 * width, (1 - y) / 2 * height])


def courses(
    camera: pv.Camera, size: tuple[int, int], points: Array, vectors: Array
) -> Array:  # fmt: skip
    """Return the unit directions in a picture, to the right and down, of vectors at points."""
    step = footprint(camera, points, size[1])[:, np.newaxis] * unit_rows(vectors)
    here, there = (in_pixels(camera, size, at) for at in (points, points + step))
    return unit_rows(np.nan_to_num(there - here))


def toward_eye(camera: pv.Camera, points: Array) -> Array:
    """Return the unit directions from points toward the eye of a camera."""
    if camera.GetParallelProjection():
        away = np.array(camera.GetDirectionOfProjection())
        return np.broadcast_to(-away, points.shape).copy()
    return unit_rows(np.array(camera.GetPosition()) - points)


def _box(meshes: Sequence[Cells], occluders: Sequence[vtkActor]) -> tuple[float, ...]:
    """Return the box around the cells of meshes and around actors."""
    box = vtkBoundingBox()
    for mesh in meshes:
        bounds = [0.0] * 6
        mesh.data().GetCellsBounds(bounds)
        around = vtkBoundingBox(bounds)
        around.Inflate((mesh.diameter or 0.0) / 2)
        box.AddBox(around)
    for occluder in occluders:
        box.AddBounds(occluder.GetBounds())
    bounds = [0.0] * 6
    box.GetBounds(bounds)
    return tuple(bounds)


def _drawings(
    meshes: Sequence[Cells], starts: Sequence[int], shift: int, camera: pv.Camera, height: int,
    occluders: Sequence[vtkActor],
) -> Iterator[list[vtkActor]]:  # fmt: skip
    """Yield the actors that are drawn at once, first those that hide cells."""
    actors, count = [*occluders], 0
    for mesh, start in zip(meshes, starts, strict=False):
        for cells, first in mesh.blocks():
            if count >= BLOCK:
                yield actors
                actors, count = [], 0
            actors.append(_actor(cells, start + first, shift, camera, height))
            count += len(cells.corners)
    yield actors


def _actor(
    mesh: Cells, start: int, shift: int, camera: pv.Camera, height: int
) -> vtkActor:  # fmt: skip
    """Return a mesh with the numbers of its cells, from 1, as flat colours; 0 is background."""
    number = np.arange(start + 1, start + 1 + len(mesh.corners)) >> shift
    if mesh.diameter is not None:
        mesh = mesh.bands(camera, height)
        number = np.repeat(number, 2)
    colors = np.stack([number >> place & 255 for place in (16, 8, 0)], axis=1).astype(np.uint8)
    data = mesh.data()
    data.GetCellData().SetScalars(as_vtk(colors, "number"))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToDirectScalars()
    actor = vtkActor()
    actor.SetMapper(mapper)
    style = actor.GetProperty()
    # The colours are numbers, which light must not change.
    style.LightingOff()
    style.SetLineWidth(mesh.width)
    style.SetPointSize(mesh.width)
    return actor
