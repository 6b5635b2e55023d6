"""The pixels of a picture and the cells that they show.

The visible cells are those of one offscreen drawing in which each cell has its number as a colour.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - what draws registers itself
from vtkmodules.vtkCommonCore import vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkBoundingBox, vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from vizlight import _pool
from vizlight.draw.backends import choose_backend, window_class
from vizlight.draw.cameras import footprint
from vizlight.draw.live import in_view
from vizlight.draw.strokes import lay_on_surfaces
from vizlight.geometry.lines.simplices import Columns
from vizlight.model.kernels import unit_rows
from vizlight.vtk.arrays import MadePoints
from vizlight.vtk.cells import as_numpy, as_vtk

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv

    from vizlight._types import Array, Indices, Slice
    from vizlight.shading.display import Bytes
    from vizlight.shading.inputs import ArraySource
    from vizlight.vtk.drawn import DrawnCells, DrawnPoints

#: Number of cells that are drawn at once, so that memory goes by pixels.
BLOCK = 1 << 19
#: Number of points whose places in a picture are found at once.
FEW = 1 << 14
#: Number of times by which the points between the first and the last of some cells may be more than
#: their corners, so that all of them are taken.
SPARSE = 2


class Cells(NamedTuple):
    """Cells of one mesh as they are drawn.

    ``corners`` (C, s) are points, segments or triangles; ``width`` is that of points and of lines
    in pixels, the least width of lines that have a ``diameter``, in the unit of the mesh.
    ``shares`` of the width, from 0 to 1, are those that lines have at their points; None for one
    width.
    """

    points: ArraySource
    corners: Indices | DrawnCells | DrawnPoints
    width: float
    diameter: float | None = None
    shares: Array | None = None

    @property
    def are_bands(self) -> bool:
        """Whether lines are drawn as bands, two triangles for each segment."""
        return self.diameter is not None or self.shares is not None

    def data(self, rows: Slice, camera: pv.Camera, height: int) -> vtkPolyData:
        """Return some points, segments or triangles as a mesh of VTK, lines as bands if need be.

        Its points are those of these cells.
        """
        ids = np.asarray(self.corners[rows])
        points, corners = with_own_points(self.points, ids)
        if self.are_bands:
            shares = None if self.shares is None else with_own_points(self.shares, ids)[0]
            points, corners = self._bands(points, corners, shares, camera, height)
        kind = corners.shape[1]
        cells, data = vtkCellArray(), vtkPolyData()
        cells.SetData(kind, as_vtk(corners.astype(np.int32).ravel()))
        places = vtkPoints()
        places.SetData(as_vtk(points))
        data.SetPoints(places)
        (data.SetVerts, data.SetLines, data.SetPolys)[kind - 1](cells)
        return data

    def widths(self, cells: Indices, camera: pv.Camera, height: int) -> Array:
        """Return the widths in pixels where some cells begin, in a picture of some height."""
        first = self.corners[cells][:, 0]
        widths = np.full(len(first), self.width)
        if self.diameter is not None:
            points = rows_of(self.points, first).astype(np.float64)
            widths = np.maximum(self.diameter / footprint(camera, points, height), self.width)
        return widths if self.shares is None else widths * self.shares[first]

    def _bands(
        self,
        points: Array,
        corners: Indices,
        shares: Array | None,
        camera: pv.Camera,
        height: int,
    ) -> tuple[Array, Indices]:
        """Return lines as bands that face the eye, two triangles for each segment.

        They are nearer to the eye by half of their whole width, as a tube is.
        """
        points = points.astype(np.float64)
        size = footprint(camera, points, height)
        toward = toward_eye(camera, points)
        radius = np.maximum(self.diameter or 0.0, self.width * size)[:, np.newaxis] / 2
        reach = radius if shares is None else radius * shares[:, np.newaxis]
        start, end = corners.T
        along = points[end] - points[start]
        places = []
        for ids in (start, end):
            across = reach[ids] * unit_rows(np.cross(toward[ids], along))
            near = points[ids] + radius[ids] * toward[ids]
            places += [near - across, near + across]
        first = np.arange(len(start)) * 4
        triangles = np.stack([first, first + 1, first + 2, first + 1, first + 3, first + 2], axis=1)
        return np.stack(places, axis=1).reshape(-1, 3), triangles.reshape(-1, 3)


def rows_of(source: ArraySource, ids: Indices) -> Array:
    """Return rows of points or of an array by their numbers."""
    rows: Array = np.asarray(source.at(ids) if isinstance(source, MadePoints) else source[:][ids])
    return rows


def with_own_points(source: ArraySource, corners: Indices) -> tuple[Array, Indices]:
    """Return points that some cells need, and the corners of the cells among these."""
    low, high = int(corners.min()), int(corners.max()) + 1
    if high - low > SPARSE * corners.size:
        ids, own = np.unique(corners, return_inverse=True)
        return rows_of(source, ids), own.reshape(corners.shape)
    return np.asarray(source[low:high]), corners - low


@dataclass(frozen=True)
class Pixels(Columns):
    """Pixels of a picture that show a cell.

    ``row`` and ``column`` are from the upper left, ``part`` is the number of the mesh that each
    pixel shows, ``cell`` that of the cell of it, and ``center`` the place of the middle of the
    picture from the axis of the view, as in ``at``.
    """

    row: Indices
    column: Indices
    part: Indices
    cell: Indices
    size: tuple[int, int]
    center: tuple[float, float] = (0.0, 0.0)

    @property
    def at(self) -> Array:
        """Places of the pixels from the axis of the view, right and up, in halves of the height."""
        width, height = self.size
        right = (2 * self.column + 1 - width) / height
        up = (height - 2 * self.row - 1) / height
        return np.stack([right, up], axis=1) + self.center


def visible(
    meshes: Sequence[Cells],
    camera: pv.Camera,
    size: tuple[int, int],
    occluders: Sequence[vtkActor] = (),
) -> Pixels:
    """Return the pixels of a picture that show a cell, and which.

    The clipping range of the camera is set to show all; ``occluders`` are actors without cells that
    hide cells. BackendError is raised if no OpenGL library can draw.
    """
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
    blocks = [
        _Block(part, mesh, rows)
        for part, mesh in enumerate(meshes)
        for rows in _pool.blocks(len(mesh.corners), BLOCK)
    ]
    box = vtkBoundingBox()
    for occluder in occluders:
        box.AddBounds(occluder.GetBounds())
    drawings = _drawings(blocks)
    # Cells of several drawings are made again for theirs, since all of them take more memory.
    made: list[vtkPolyData] = []
    for block in blocks:
        data = block.mesh.data(block.rows, camera, height)
        bounds = [0.0] * 6
        data.GetCellsBounds(bounds)
        box.AddBounds(bounds)
        made += [data] if len(drawings) == 1 else []
    bounds = [0.0] * 6
    box.GetBounds(bounds)
    renderer.ResetCameraClippingRange(bounds)
    part, cell = np.full((2, height, width), -1, dtype=np.int32)
    for i, drawing in enumerate(drawings):
        renderer.RemoveAllViewProps()
        for occluder in occluders if i == 0 else ():
            renderer.AddActor(occluder)
        starts = np.cumsum([1, *(block.size for block in drawing)])
        for k, block in enumerate(drawing):
            data = made[k] if made else block.mesh.data(block.rows, camera, height)
            renderer.AddActor(_actor(block, data, int(starts[k])))
        # What was drawn before hides cells by its depth.
        renderer.SetPreserveDepthBuffer(i > 0)
        rgb = frame_of(window).astype(np.int32)
        number = rgb[..., 0] << 16 | rgb[..., 1] << 8 | rgb[..., 2]
        shows = (number > 0) & (number < starts[-1])
        which = np.searchsorted(starts, number[shows], side="right") - 1
        part[shows] = np.array([block.part for block in drawing])[which]
        first = np.array([block.rows.start for block in drawing])
        cell[shows] = number[shows] - starts[which] + first[which]
    window.Finalize()
    # From the lowest row up: places are drawn from them at random.
    from_below, column = np.nonzero(part[::-1] >= 0)
    row = height - 1 - from_below
    which, number = (each[row, column].astype(np.intp) for each in (part, cell))
    right, up = camera.GetWindowCenter()
    return Pixels(row, column, which, number, size, (right * width / height, up))


class _Block(NamedTuple):
    """Some cells of one of several meshes, which are drawn at once."""

    part: int
    mesh: Cells
    rows: Slice

    @property
    def size(self) -> int:
        return self.rows.stop - self.rows.start


def _drawings(blocks: list[_Block]) -> list[list[_Block]]:
    """Return the blocks of each drawing, twice ``BLOCK`` cells at most."""
    drawings, count = list[list[_Block]](), BLOCK
    for block in blocks:
        if count >= BLOCK:
            drawings.append([])
            count = 0
        drawings[-1].append(block)
        count += block.size
    return drawings


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
    pixels = np.empty((len(points), 2))
    for rows in _pool.blocks(len(points), FEW):
        places, front = in_view(camera, width / height, np.asarray(points[rows], np.float64))
        x, y, _ = np.where(front, places.T, np.nan)
        pixels[rows] = np.column_stack([(1 + x) / 2 * width, (1 - y) / 2 * height])
    return pixels


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


def _actor(block: _Block, data: vtkPolyData, start: int) -> vtkActor:
    """Return cells with their numbers, from ``start``, as flat colours; 0 is background."""
    number = np.arange(start, start + block.size, dtype=np.int32)
    if block.mesh.are_bands:
        # A segment is two triangles.
        number = np.repeat(number, 2)
    colors = np.stack([number >> place & 255 for place in (16, 8, 0)], axis=1).astype(np.uint8)
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
    style.SetLineWidth(block.mesh.width)
    style.SetPointSize(block.mesh.width)
    return actor
