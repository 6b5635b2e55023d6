"""The visible cells of a picture: one offscreen drawing in which each cell has its own colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - what draws registers itself
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from vizlight.draw.backends import window_class
from vizlight.vtk.cells import as_numpy, as_vtk

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv
    from vtkmodules.vtkCommonCore import vtkPoints

    from vizlight._types import Array, Indices
    from vizlight.draw.backends import Backend

#: Width and height of the picture.
SIZE = 512, 512
#: Width of lines and of points, in pixels.
LINE, POINT = 2.0, 4.0
#: Bits of the three channels.
BITS = 24


class Pixels(NamedTuple):
    """Visible pixels.

    Attributes
    ----------
    part : ndarray of int, shape (M,)
        Number of the mesh that each pixel shows.
    cell : ndarray of int, shape (M,)
        Number of the cell of that mesh.
    at : ndarray, shape (M, 2)
        Place of the pixel's middle in the picture, from -1 at the left and at the bottom to 1.
    """

    part: Indices
    cell: Indices
    at: Array


def visible(
    parts: Sequence[tuple[vtkPoints, Indices]], camera: pv.Camera, backend: Backend | None
) -> Pixels:
    """Return the pixels of a picture that show a cell, and which.

    Parameters
    ----------
    parts : sequence of (vtkPoints, ndarray of int, shape (C, s))
        Points of each mesh, and cells of 1, 2 or 3 of them.
    camera : pyvista.Camera
        Camera of the picture; its clipping range is set to show all.
    backend : {"egl", "osmesa"} or None
        OpenGL library that draws, see :func:`vizlight.draw.backends.choose_backend`.

    Returns
    -------
    Pixels
    """
    starts = np.cumsum([0, *(len(cells) for _, cells in parts)])
    with window_class(backend):
        window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    # A pixel that is mixed of two colours would name a third cell.
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    renderer = vtkRenderer()
    renderer.SetActiveCamera(camera)
    window.AddRenderer(renderer)
    number = np.zeros(SIZE[0] * SIZE[1], dtype=np.int64)
    for shift in range(0, max(int(starts[-1]).bit_length(), 1), BITS):
        renderer.RemoveAllViewProps()
        for (points, cells), start in zip(parts, starts.tolist(), strict=False):
            renderer.AddActor(_actor(points, cells, start, shift))
        renderer.ResetCameraClippingRange()
        window.Render()
        pixels = vtkUnsignedCharArray()
        window.GetPixelData(0, 0, SIZE[0] - 1, SIZE[1] - 1, 1, pixels, 0)
        rgb = as_numpy(pixels).reshape(-1, 3).astype(np.int64)
        number |= (rgb[:, 0] << 16 | rgb[:, 1] << 8 | rgb[:, 2]) << shift
    window.Finalize()
    shown = np.flatnonzero((number > 0) & (number <= starts[-1]))
    cell = number[shown] - 1
    which = np.searchsorted(starts, cell, side="right") - 1
    row, column = np.divmod(shown, SIZE[0])
    at = np.stack([(column + 0.5) / SIZE[0], (row + 0.5) / SIZE[1]], axis=1) * 2 - 1
    return Pixels(which, cell - starts[which], at)


def _actor(points: vtkPoints, corners: Indices, start: int, shift: int) -> vtkActor:
    """Return a mesh whose cells have their numbers, from 1, as flat colours; 0 is background."""
    count, size = corners.shape
    number = np.arange(start + 1, start + 1 + count) >> shift
    colors = np.stack([number >> place & 255 for place in (16, 8, 0)], axis=1).astype(np.uint8)
    cells = vtkCellArray()
    cells.SetData(size, as_vtk(corners.ravel()))
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    (mesh.SetVerts, mesh.SetLines, mesh.SetPolys)[size - 1](cells)
    mesh.GetCellData().SetScalars(as_vtk(colors, "number"))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToDirectScalars()
    actor = vtkActor()
    actor.SetMapper(mapper)
    own = actor.GetProperty()
    own.LightingOff()
    own.SetLineWidth(LINE)
    own.SetPointSize(POINT)
    return actor


def rays(camera: pv.Camera, at: Array) -> tuple[Array, Array]:
    """Return a point on each line of sight through places of a picture, ``Pixels.at``, and its way.

    The way is the unit direction away from the eye.
    """
    away = np.array(camera.GetDirectionOfProjection())
    right = np.cross(away, camera.GetViewUp())
    right /= np.linalg.norm(right)
    across = at[:, :1] * right + at[:, 1:] * np.cross(right, away)
    eye = np.array(camera.GetPosition())
    if camera.GetParallelProjection():
        scale = camera.GetParallelScale()
        return eye + scale * across, np.broadcast_to(away, across.shape)
    way = away + np.tan(np.radians(camera.GetViewAngle() / 2)) * across
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    return np.broadcast_to(eye, way.shape), way


def weights(corners: Array, origin: Array, way: Array) -> Array:
    """Return where lines of sight meet cells, as the share of each corner.

    Parameters
    ----------
    corners : ndarray, shape (M, s, 3)
        Corners of a triangle, a segment or a point for each line of sight.
    origin, way : ndarray, shape (M, 3)
        Lines of sight, as :func:`rays` returns them.

    Returns
    -------
    ndarray, shape (M, s)
        Shares, 0 or more and with sum 1; for a segment, of its point nearest to the line.
    """
    m, s, _ = corners.shape
    if s == 1:
        return np.ones((m, 1))
    start = origin - corners[:, 0]
    # What lies along the line of sight has no part in where it meets a cell.
    flat = [
        flattened(x, way) for x in (start, *(corners[:, i] - corners[:, 0] for i in range(1, s)))
    ]
    if s == 2:
        p, u = flat
        second = np.clip(_ratio(dots(p, u), dots(u, u)), 0.0, 1.0)
        return np.stack([1 - second, second], axis=1)
    p, u, v = flat
    uu, uv, vv, pu, pv_ = dots(u, u), dots(u, v), dots(v, v), dots(p, u), dots(p, v)
    area = uu * vv - uv**2
    second, third = _ratio(vv * pu - uv * pv_, area), _ratio(uu * pv_ - uv * pu, area)
    found = np.maximum(np.stack([1 - second - third, second, third], axis=1), 0.0)
    return np.asarray(found / found.sum(axis=1, keepdims=True))


def flattened(vectors: Array, way: Array) -> Array:
    """Return what of vectors stands across unit directions."""
    return np.asarray(vectors - dots(vectors, way)[:, np.newaxis] * way)


def dots(a: Array, b: Array) -> Array:
    """Return the dot products of rows."""
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _ratio(a: Array, b: Array) -> Array:
    """Return a / b, and 0 for a cell that is seen edge on."""
    return np.divide(a, b, out=np.zeros_like(a), where=b > 0)
