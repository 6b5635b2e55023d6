"""Cameras that show a whole mesh, and a light direction relative to a camera."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TypeAlias

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkRenderingCore import vtkCamera

from vizlight import _check
from vizlight._types import Array
from vizlight.mesh.blocks import all_blocks

Mesh: TypeAlias = pv.DataSet | pv.MultiBlock
#: Opening angle of a perspective camera, in degrees, which is VTK's default.
VIEW_ANGLE = 30.0
#: Factor by which the picture is larger than the mesh in it.
MARGIN = 1.05
#: Number of directions in which the outermost points of a turn are sought, and of its steps.
RINGS = 73
#: Number of points that are projected at once.
SOME = 1 << 16
#: Least and largest size of a box that a camera shows; VTK's are no nearer than 1e-20.
SIZES = 1e-15, 1e100


def pixel_sizes(camera: vtkCamera, distance: Array, height: float) -> Array:
    """Return the sizes of a pixel at distances from the plane of the eye, in the unit of the mesh.

    The height of the picture is in pixels.
    """
    if camera.GetParallelProjection():
        return np.full(len(distance), 2 * camera.GetParallelScale() / height)
    return np.asarray(2 * distance * np.tan(np.radians(camera.GetViewAngle() / 2)) / height)


def footprint(camera: pv.Camera, points: Array, height: float) -> Array:
    """Return the size of a pixel at points, in the unit of the mesh.

    The height of the picture is in pixels.
    """
    away = np.array(camera.GetDirectionOfProjection())
    return pixel_sizes(camera, (points - np.array(camera.GetPosition())) @ away, height)


def camera_on(
    bounds: Mesh | ArrayLike,
    direction: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    up: Sequence[float] | None = None,
    parallel: bool = False,
    zoom: float = 1.0,
    aspect: float = 1.0,
    turning: bool = False,
) -> pv.Camera:
    """Return a camera that shows a whole mesh or bounding box; OpenGL is not needed.

    Parameters
    ----------
    bounds : (xmin, xmax, ymin, ymax, zmin, zmax), or mesh
        Box or mesh to show, in the unit of the mesh. A box stays in the picture however it is
        rotated about its centre. A mesh fills the picture: its finite points, projected along
        the view, touch the margins.
    direction : vector of 3 components
        Direction from the centre toward the eye.
    up : vector of 3 components, optional
        Direction that points up in the picture. Default: z, or y for a view along z.
    parallel : bool, default: False
        Whether the projection is parallel instead of perspective.
    zoom : float, default: 1.0
        Magnification, above 0; 2 shows half the width.
    aspect : float, default: 1.0
        Width over height of the picture that a mesh fills.
    turning : bool, default: False
        Whether a mesh stays in the picture while the camera moves about its direction up, through
        its focal point, which is on the axis through the middle of the box of the mesh.

    Returns
    -------
    pyvista.Camera

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.
    """
    aspect = _check.number("aspect", aspect, low=1e-3)
    toward, upward = _directions(direction, up)
    zoom = _check.number("zoom", zoom, low=1e-6)
    box_bounds = common_bounds("bounds", [bounds]) if isinstance(bounds, Mesh) else bounds
    box = _check.coordinates("bounds", box_bounds)
    if box.shape != (6,):
        expected = "a mesh or six finite numbers"
        raise _check.value_error("bounds", expected, _check.describe(bounds))
    box = box.reshape(3, 2)
    centre = box.mean(axis=1)
    if np.any(box[:, 1] < box[:, 0]):
        raise _check.value_error("bounds", "a mesh with finite points", "none")
    # Halved before the difference, which could overflow for the largest coordinates.
    size = float(np.max(box[:, 1] / 2 - box[:, 0] / 2)) * 2
    if size and not SIZES[0] <= size <= SIZES[1]:
        expected = f"a size from {SIZES[0]:g} to {SIZES[1]:g}"
        raise _check.value_error("bounds", expected, f"{size:g}", "scale the mesh")
    # A box without an extent is shown like a ball of radius 1.
    radius = 0.5 * float(np.linalg.norm(box[:, 1] - box[:, 0])) or 1.0
    # At this distance the sphere around the box touches the cone of sight.
    distance, height = radius / math.sin(math.radians(VIEW_ANGLE / 2)), radius
    if isinstance(bounds, Mesh):
        view = _axes(toward, upward), aspect
        if _check.boolean("turning", turning):
            rings = [_rings(some - centre, upward) for some in _coordinates(bounds)]
            shift, distance, height = _fit(np.concatenate(rings), *view, parallel=parallel)
            # The point on the axis that the same eye sees in the middle of the picture.
            along = shift @ view[0][1] / (upward @ view[0][1])
            distance -= along * float(upward @ toward)
            centre = centre + along * upward
        else:
            points = np.concatenate([_outermost(some, *view) for some in _coordinates(bounds)])
            shift, distance, height = _fit(points - centre, *view, parallel=parallel)
            centre = centre + shift
    camera = pv.Camera()  # type: ignore[no-untyped-call]
    camera.view_angle = VIEW_ANGLE
    # A perspective picture grows with a nearer eye, a parallel one by its scale alone.
    distance /= zoom
    camera.focal_point = tuple(centre)
    camera.position = tuple(centre + distance * toward)
    camera.up = tuple(upward)
    camera.parallel_projection = _check.boolean("parallel", parallel)
    camera.parallel_scale = height / zoom
    # The near plane stays off the eye, since a depth buffer spends most of its digits there.
    camera.clipping_range = (max(distance - 2 * radius, distance * 1e-3), distance + 2 * radius)
    return camera


def outermost(
    mesh: Mesh,
    direction: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    up: Sequence[float] | None = None,
    aspect: float = 1.0,
) -> Array:
    """Return the few points of a mesh on which the camera of :func:`camera_on` depends.

    They are at most 16 points of each 65,536, without those that are not finite. :func:`camera_on`
    gives the same camera for a mesh of all points and for one of these, also if they come from
    several parts.
    """
    view = axes_of(direction, up), _check.number("aspect", aspect, low=1e-3)
    extremes = [_outermost(some, *view) for some in _coordinates(mesh)]
    return np.concatenate([np.empty((0, 3)), *extremes])


def _outermost(points: Array, axes: Array, aspect: float) -> Array:
    """Return the points that bound the box, and those at the margins of a view."""
    finite = points[np.all(np.isfinite(points), axis=1)]
    if not len(finite):
        return finite
    along, (z, sides) = np.concatenate([np.eye(3), axes]), (axes[2], _sides(axes, aspect))
    # A camera is made of maxima along these rows, and a single point attains each.
    rows = np.concatenate([along, -along, z + sides, z - sides])
    return finite[[int(np.argmax(finite @ row)) for row in rows]]


def _sides(axes: Array, aspect: float) -> Array:
    """Return the axes of the picture, as long as the margins are nearer for each step of depth.

    A point is in the picture from the distance z + slope |x|, so the largest z + slope x and
    z - slope x of all points are enough, and the same of y.
    """
    slope = MARGIN / math.tan(math.radians(VIEW_ANGLE / 2))
    return np.stack([axes[0] * slope / aspect, axes[1] * slope])


def _directions(direction: object, up: Sequence[float] | None) -> tuple[Array, Array]:
    """Return the unit vectors toward the eye and up."""
    toward = _check.unit("direction", direction)
    # Seen along z, z cannot be up.
    if up is None:
        up = (0.0, 1.0, 0.0) if abs(toward[2]) > 0.999 else (0.0, 0.0, 1.0)
    upward = _check.unit("up", up)
    if np.linalg.norm(np.cross(upward, toward)) < 1e-6:
        raise _check.value_error("up", "a direction across the view", tuple(up))
    return toward, upward


def axes_of(direction: object, up: Sequence[float] | None = None) -> Array:
    """Return the unit vectors to the right and up in the picture, and toward the eye, as rows.

    Arguments are as for :func:`camera_on`.
    """
    return _axes(*_directions(direction, up))


def _axes(toward: Array, up: Array) -> Array:
    """Return the unit vectors to the right and up in the picture, and toward the eye."""
    right = np.cross(up, toward)
    return np.stack([v / np.linalg.norm(v) for v in (right, np.cross(toward, right), toward)])


def _fit(
    points: Array, axes: Array, aspect: float, *, parallel: bool
) -> tuple[Array, float, float]:
    """Return the shift of the centre, the distance and the height at which points fill a view."""
    sides = _sides(axes, aspect)
    rows = np.concatenate([axes, axes[2] + sides, axes[2] - sides])
    low, high = (end(points @ rows.T, axis=0) for end in (np.min, np.max))
    # The centre moves across the view alone; how far the eye is away is a number of its own.
    shift = np.zeros(3)
    half = 0.5 * (high[:2] - low[:2])
    # Half the height of the picture, as VTK's parallel scale is.
    height = MARGIN * float(max(half[0] / aspect, half[1]))
    shift[:2] = 0.5 * (low[:2] + high[:2])
    if not parallel:
        # Both margins of each side are touched at the same distance.
        shift[:2] = 0.5 * (high[3:5] - high[5:]) / np.linalg.norm(sides, axis=1)
    moved = shift[:2] * np.linalg.norm(sides, axis=1)
    distance = float(max(np.max(high[3:5] - moved), np.max(high[5:] + moved)))
    # A single point, or a flat mesh that is seen edge on, has no extent in the picture.
    size = 0.05 * float(high[2] - low[2]) or (0.0 if height else 1.0)
    return shift @ axes, max(distance, float(high[2]) + size), max(height, size)


def _rings(points: Array, up: Array) -> Array:
    """Return the places of the outermost points in a turn about a unit axis at the origin."""
    points = points[np.all(np.isfinite(points), axis=1)]
    if not len(points):
        return points
    heights = points @ up
    radii = np.linalg.norm(points - heights[:, np.newaxis] * up, axis=1)
    ways = np.linspace(0, np.pi, RINGS)
    rows = np.stack([np.cos(ways), np.sin(ways)])
    outer = np.unique(np.argmax(np.stack([heights, radii], axis=1) @ rows, axis=0))
    right = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
    right /= np.linalg.norm(right)
    turns = np.linspace(0, 2 * np.pi, RINGS)[:, np.newaxis]
    circle = np.cos(turns) * right + np.sin(turns) * np.cross(up, right)
    places = heights[outer, np.newaxis, np.newaxis] * up
    rings: Array = places + radii[outer, np.newaxis, np.newaxis] * circle
    return rings.reshape(-1, 3)


def _coordinates(mesh: Mesh) -> Iterator[Array]:
    """Yield the points of a mesh, some at a time; of a grid that fills its box its corners."""
    for block in all_blocks(mesh):
        straight = isinstance(block, pv.RectilinearGrid) or (
            isinstance(block, pv.ImageData) and np.array_equal(block.direction_matrix, np.eye(3))
        )
        # A straight grid fills its box, so that no point of it is farther out than the eight
        # corners.
        corners = [*itertools.product(*np.reshape(block.bounds, (3, 2)))]
        points = np.array(corners) if straight and block.n_points else block.points
        for start in range(0, len(points), SOME):
            yield np.asarray(points[start : start + SOME], dtype=np.float64)


def common_bounds(name: str, meshes: Iterable[Mesh]) -> list[float]:
    """Return the bounds of several meshes together.

    The message of an error names the argument ``name``.
    """
    parts = [part for mesh in meshes for part in all_blocks(mesh)]
    boxes = np.array([part.bounds for part in parts if part.n_points])
    if not boxes.size:
        raise _check.value_error(name, "a mesh with points", "empty meshes")
    low, high = boxes[:, ::2].min(axis=0), boxes[:, 1::2].max(axis=0)
    return [float(x) for pair in zip(low, high, strict=True) for x in pair]


def over_shoulder(camera: pv.Camera) -> tuple[float, float, float]:
    """Return the direction toward a distant light above and to the left of the eye.

    Parameters
    ----------
    camera : pyvista.Camera or vtkCamera
        Camera of the eye.

    Returns
    -------
    (float, float, float)
        Direction, not of unit length.
    """
    if not hasattr(camera, "GetDirectionOfProjection"):
        raise _check.type_error("camera", "a pyvista.Camera or vtkCamera", camera)
    back = -np.array(camera.GetDirectionOfProjection())
    right = np.cross(np.array(camera.GetViewUp()), back)
    right /= np.linalg.norm(right)
    # back x right is up in the picture.
    x, y, z = back - 0.6 * right + 0.6 * np.cross(back, right)
    return float(x), float(y), float(z)
