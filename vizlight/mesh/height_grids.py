"""Take a height field from a grid: nodes that rise, heights by row and column, and the way back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh.point_arrays import GridPoints

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

Grid = pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid
#: The rise of a level grid, as a share of its size: that of directions kept in float32.
LEVEL = 1e-6
REMEDY = "sample it on a pv.ImageData, or pass its surface with thickness="


@dataclass(frozen=True)
class Heights:
    """A height field and where its nodes are among a grid's points.

    Attributes
    ----------
    x, y : ndarray, shapes (nx,), (ny,)
    z : ndarray, shape (ny, nx)
    place : ndarray of int, shape (ny, nx)
        The point that each node is.
    turn : ndarray, shape (3, 3), optional
        Takes the mesh's directions and places to those of x, y and z, if the mesh is turned
        about the vertical.
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


def heights_of(grid: Any, elevation: str | None, factor: float) -> Heights:
    """Return the height field of a grid of one layer.

    Raises
    ------
    TypeError, ValueError
        If it has more than one layer, no such elevation, is tilted, or x and y are not those of
        a grid.
    """
    factor = _check.number("factor", factor)
    if grid.n_points == 0:
        raise ValueError(_check.message("mesh", "a grid of points", "an empty one"))
    nx, ny, nz = grid.dimensions
    if nz != 1:
        raise ValueError(
            _check.message("mesh", "a grid of one layer, nx x ny x 1", f"{nx} x {ny} x {nz}")
        )
    points = GridPoints(grid)[:] if not isinstance(grid, pv.StructuredGrid) else grid.points
    places: Array = np.asarray(points, dtype=np.float64).reshape(ny, nx, 3)
    # A structured grid has places of its own, which may rise with its heights.
    if not isinstance(grid, pv.StructuredGrid):
        sides = np.ptp(places.reshape(-1, 3), axis=0)
        if sides[2] > LEVEL * np.linalg.norm(sides):
            _refuse_tilted()
    if elevation is None and isinstance(grid, pv.StructuredGrid):
        z = places[..., 2]
    else:
        z = _elevation(grid, elevation).reshape(ny, nx)
    place = np.arange(nx * ny).reshape(ny, nx)
    # Coordinates have the rounding of the largest of them.
    coarse = np.asarray(points).dtype == np.float32
    eps = np.finfo(np.float32 if coarse else np.float64).eps
    rounding = float(eps * np.nanmax(np.abs(places[..., :2])))
    turn = _turn(places, rounding)
    if turn is not None:
        places = places @ turn.T
    x, y = places[..., 0], places[..., 1]
    if np.ptp(x[0]) < np.ptp(x[:, 0]):
        x, y, z, place = x.T, y.T, z.T, place.T
    for nodes in (x[0], y[:, 0]):
        if len(nodes) > 1 and np.ptp(nodes) <= 4 * rounding:
            _refuse_tilted()
    wide = 8 * rounding
    if not (np.ptp(x, axis=0).max() <= wide and np.ptp(y, axis=1).max() <= wide):
        raise ValueError(
            _check.message(
                "mesh", "rows and columns that are straight and square", "others", REMEDY
            )
        )
    x, y = x[0], y[:, 0]
    if x[0] > x[-1]:
        x, z, place = x[::-1], z[:, ::-1], place[:, ::-1]
    if y[0] > y[-1]:
        y, z, place = y[::-1], z[::-1], place[::-1]
    return Heights(x, y, np.asarray(z, dtype=np.float64) * factor, place, turn)


def _refuse_tilted() -> NoReturn:
    remedy = "lay it level and turn the light as much, or pass its surface with thickness="
    raise ValueError(_check.message("mesh", "a grid that lies level", "a tilted one", remedy))


def _turn(places: Array, rounding: float) -> Array | None:
    """Return the turn about the vertical that lays rows along x; None where they lie along an axis.

    Places have shape (ny, nx, 3); each coordinate may be off by their rounding.
    """
    along, across = (places[end][:2] - places[0, 0, :2] for end in ((0, -1), (-1, 0)))
    # The longer side tells the angle to more digits.
    longer = np.hypot(*along) >= np.hypot(*across)
    x, y = along if longer else (across[1], -across[0])
    if not min(abs(x), abs(y)) > 2 * rounding:
        return None
    size = np.hypot(x, y)
    return np.asarray(np.array([[x, y, 0], [-y, x, 0], [0, 0, size]]) / size)


def _elevation(grid: Any, name: str | None) -> Array:
    """Return heights from a point array of one component: the one named, or the active one."""
    if name is None:
        name = grid.point_data.active_scalars_name
    there = [key for key in grid.point_data if np.ndim(grid.point_data[key]) == 1]
    if name is None and len(there) == 1:
        name = there[0]
    if name not in there:
        raise ValueError(
            _check.message(
                "elevation", f"a point array of one component, {_check.one_of(there)}", repr(name)
            )
        )
    return _check.floats("elevation", np.asarray(grid.point_data[name]))
