"""Height fields from grids: ascending nodes, heights by row and column, and the order of points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh.point_arrays import GridPoints

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

Grid: TypeAlias = pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid
#: Largest extent in z of a level grid, as a share of its size: the rounding of float32 directions.
LEVEL = 1e-6
REMEDY = "sample it on a pv.ImageData, or pass its surface with thickness="


@dataclass(frozen=True)
class Heights:
    """A height field, and the indices of its nodes among the points of the grid.

    Attributes
    ----------
    x, y : ndarray, shapes (nx,), (ny,)
    z : ndarray, shape (ny, nx)
    place : ndarray of int, shape (ny, nx)
        Index of each node among the points of the grid.
    turn : ndarray, shape (3, 3), optional
        Rotation about the vertical from the axes of the mesh to those of x and y; None where they
        are the same.
    """

    x: Array
    y: Array
    z: Array
    place: Indices
    turn: Array | None = None

    def to_points(self, values: Array) -> Array:
        """Return values at the nodes, shape (ny, nx, ...), in the order of the points."""
        result = np.empty((self.place.size, *values.shape[2:]), values.dtype)
        result[self.place] = values
        return result

    def points(self) -> Array:
        """Return the nodes in the order of the points, shape (ny nx, 3)."""
        x, y = np.meshgrid(self.x, self.y)
        found = self.to_points(np.stack([x, y, self.z], axis=-1))
        return found if self.turn is None else found @ self.turn


def heights_of(grid: Grid, elevation: str | None, factor: float) -> Heights:
    """Return the height field of a grid of one layer.

    Raises
    ------
    TypeError, ValueError
        If the grid has more than one layer, is tilted, has no such elevation, or its x and y are
        not those of straight rows and columns at right angles.
    """
    factor = _check.number("factor", factor)
    nodes, rounding = _nodes(grid)
    if elevation is None and isinstance(grid, pv.StructuredGrid):
        z = nodes[..., 2]
    else:
        z = _elevation(grid, elevation).reshape(nodes.shape[:2])
    place = np.arange(z.size).reshape(z.shape)
    turn = _turn(nodes, rounding)
    if turn is not None:
        nodes = nodes @ turn.T
    x, y = nodes[..., 0], nodes[..., 1]
    if np.ptp(x[0]) < np.ptp(x[:, 0]):
        x, y, z, place = x.T, y.T, z.T, place.T
    _check_square(x, y, rounding)
    x, y = x[0], y[:, 0]
    if x[0] > x[-1]:
        x, z, place = x[::-1], z[:, ::-1], place[:, ::-1]
    if y[0] > y[-1]:
        y, z, place = y[::-1], z[::-1], place[::-1]
    return Heights(x, y, np.asarray(z, dtype=np.float64) * factor, place, turn)


def _nodes(grid: Grid) -> tuple[Array, float]:
    """Return the points of a level grid, shape (ny, nx, 3), and the rounding of their x and y."""
    if grid.n_points == 0:
        raise ValueError(_check.message("mesh", "a grid of points", "an empty one"))
    nx, ny, nz = grid.dimensions
    if nz != 1:
        got = f"{nx} x {ny} x {nz}"
        raise ValueError(_check.message("mesh", "a grid of one layer, nx x ny x 1", got, REMEDY))
    if isinstance(grid, pv.StructuredGrid):
        points: Array = np.asarray(grid.points)
    else:
        points = GridPoints(grid)[:]
        # Only the points of a StructuredGrid may have the heights as their z.
        sides = np.ptp(points, axis=0)
        if sides[2] > LEVEL * np.linalg.norm(sides):
            raise _tilted()
    eps = np.finfo(np.float32 if points.dtype == np.float32 else np.float64).eps
    nodes: Array = np.asarray(points, dtype=np.float64).reshape(ny, nx, 3)
    return nodes, float(eps * np.nanmax(np.abs(nodes[..., :2])))


def _check_square(x: Array, y: Array, rounding: float) -> None:
    """Check that x depends on the column alone and y on the row alone, up to rounding."""
    for axis in (x[0], y[:, 0]):
        if len(axis) > 1 and np.ptp(axis) <= 4 * rounding:
            raise _tilted()
    if not max(np.ptp(x, axis=0).max(), np.ptp(y, axis=1).max()) <= 8 * rounding:
        expected = "rows and columns that are straight and at right angles"
        raise ValueError(_check.message("mesh", expected, "other rows and columns", REMEDY))


def _tilted() -> ValueError:
    remedy = "make it level and rotate the light with it, or pass its surface with thickness="
    return ValueError(_check.message("mesh", "a grid that lies level", "a tilted one", remedy))


def _turn(nodes: Array, rounding: float) -> Array | None:
    """Return the rotation about the vertical that aligns rows with x; None if they follow an axis.

    Nodes have shape (ny, nx, 3); each coordinate may be off by the rounding.
    """
    along, across = (nodes[end][:2] - nodes[0, 0, :2] for end in ((0, -1), (-1, 0)))
    # The longer side gives more digits of the angle.
    longer = np.hypot(*along) >= np.hypot(*across)
    x, y = along if longer else (across[1], -across[0])
    if not min(abs(x), abs(y)) > 2 * rounding:
        return None
    size = np.hypot(x, y)
    return np.asarray(np.array([[x, y, 0], [-y, x, 0], [0, 0, size]]) / size)


def _elevation(grid: Grid, name: str | None) -> Array:
    """Return the heights in a point array: the array of that name, the active or the only one."""
    if name is None:
        name = grid.point_data.active_scalars_name
    there = [key for key in grid.point_data if np.ndim(grid.point_data[key]) == 1]
    if name is None and len(there) == 1:
        name = there[0]
    if name not in there:
        expected = f"a point array of one component, {_check.one_of(there)}"
        raise ValueError(_check.message("elevation", expected, repr(name)))
    return _check.floats("elevation", np.asarray(grid.point_data[name]))
