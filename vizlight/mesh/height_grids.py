"""Height fields from grids: ascending nodes, heights by row and column, and the order of points."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight._types import Array, Bools, Indices
from vizlight.geometry.relief import height_field
from vizlight.geometry.relief.depth_map import depth_map
from vizlight.mesh import blocks, georeference, records, subdivision
from vizlight.mesh.sky_rays import across
from vizlight.vtk.arrays import GridPoints, points_of
from vizlight.vtk.cells import dimensions, has_faces

Grid: TypeAlias = pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid
#: Largest extent in z of a level grid, as a share of its size: the rounding of float32 directions.
LEVEL = 1e-6
REMEDY = "pass raster=0 to sample it on an even grid, or its surface with thickness="
#: Least side of a terrain, largest height as a share of it, least number of its slopes, and the
#: step in which these differ.
WIDE, MOST_HIGH, MANY, SLOPE = 100.0, 0.5, 50, 0.01
#: Number of faces that are looked at first, and most of those whose slopes are.
SAMPLE, MOST_STEEP = 2000, 200_000
#: Largest number of nodes of a raster.
LARGEST = 1 << 28


@dataclass(frozen=True)
class Heights:
    """A height field, and the indices of its nodes among the points of the grid.

    ``place`` is the index of each node among the points of the grid, ``stretch`` the length of a
    unit of x in each row of a map in degrees, None where it is 1, and ``turn`` the rotation about
    the vertical from the axes of the mesh to the axes x and y, None where they are the same.
    """

    x: Array
    y: Array
    z: Array
    place: Indices
    stretch: Array | None = None
    turn: Array | None = None

    def covered(self) -> Bools:
        """Return a mask of the points over the grid."""
        return np.ones(self.place.size, np.bool_)

    def to_points(self, values: Array) -> Array:
        """Return values at the nodes, shape (ny, nx, ...), in the order of the points."""
        result = np.empty((self.place.size, *values.shape[2:]), values.dtype)
        # Rows and columns may have been exchanged or turned over: numbers lead back to the points.
        result[self.place] = values
        return result

    def points(self) -> Array:
        """Return the nodes in the order of the points, shape (ny nx, 3)."""
        x, y = np.meshgrid(self.x, self.y)
        nodes = self.to_points(np.stack([x, y, self.z], axis=-1))
        # Rows times a rotation are turned by its transpose, here back to the axes of the mesh.
        return nodes if self.turn is None else nodes @ self.turn


@dataclass(frozen=True)
class Raster(Heights):
    """A height field that was sampled from a surface."""

    surface_points: Array = field(default_factory=lambda: np.empty((0, 3)))

    def covered(self) -> Bools:
        """Return a mask of the points that have a height."""
        finite: Bools = np.all(np.isfinite(self.surface_points), axis=1)
        return finite

    def to_points(self, values: Array) -> Array:
        """Return values at the nodes interpolated to the points, bilinear."""
        # Rows are y: the order is y, x. Points without a place read any node, and are not covered.
        places = np.nan_to_num(self.surface_points[:, 1::-1])
        # By rounding a point may lie beyond the outermost nodes, where the interpolator raises an
        # error.
        beside = np.clip(places, [self.y[0], self.x[0]], [self.y[-1], self.x[-1]])
        between = scipy.interpolate.RegularGridInterpolator((self.y, self.x), values)
        return np.asarray(between(beside))

    def points(self) -> Array:
        """Return the points of the surface, shape (N, 3)."""
        return self.surface_points


def heights_of(
    grid: Grid | pv.PolyData, elevation: str | None, factor: float, raster: float | None = None
) -> Heights:
    """Return the height field of a grid of one layer, or of a surface sampled at a spacing.

    Lengths of a map in degrees are in metres from its centre, and each of its rows has its own
    length of a unit of x, unless its rows are aslant to the parallels.
    """
    # In degrees x and y would be far shorter than the heights in metres: slopes would be walls.
    grid, factor = georeference.in_metres(grid), _check.number("exaggeration", factor)
    if raster is not None:
        return _sampled(grid, elevation, factor, _check.number("raster", raster, low=0.0))
    if isinstance(grid, pv.PolyData):
        raise _check.value_error("raster", "the spacing of the nodes", None)
    nodes, rounding = _nodes(grid)
    z = _elevation(grid, elevation, nodes[..., 2])
    place = np.arange(z.size).reshape(z.shape)
    turn = _turn(nodes, rounding)
    # The grid is turned to the axes in place of the axes to it; lights are turned likewise.
    if turn is not None:
        nodes = nodes @ turn.T
    x, y = nodes[..., 0], nodes[..., 1]
    # Where the first index of the points runs along y, rows are columns.
    if np.ptp(x[0]) < np.ptp(x[:, 0]):
        x, y, z, place = x.T, y.T, z.T, place.T
    _check_square(x, y, rounding)
    x, y = x[0], y[:, 0]
    # Fields need rising nodes, and rows from north to south have falling ones.
    if x[0] > x[-1]:
        x, z, place = x[::-1], z[:, ::-1], place[:, ::-1]
    if y[0] > y[-1]:
        y, z, place = y[::-1], z[::-1], place[::-1]
    stretch = _stretch(grid, y) if turn is None else None
    return Heights(x, y, np.asarray(z, dtype=np.float64) * factor, place, stretch, turn)


def _stretch(mesh: pv.DataSet, y: Array) -> Array | None:
    """Return the length of a unit of x in rows at y of a map that was in degrees, else None."""
    if georeference.LATITUDE not in mesh.field_data:
        return None
    return 1 / georeference.rates(mesh, np.stack([0 * y, y, 0 * y], axis=1))[:, 0]


def _sampled(
    mesh: Grid | pv.PolyData, elevation: str | None, factor: float, spacing: float
) -> Raster:
    """Return the height field of a surface, sampled from above on an even grid."""
    points: Array = np.asarray(points_of(mesh, None)[:], dtype=np.float64)
    z = _elevation(mesh, elevation, points[:, 2])
    points = np.column_stack([points[:, :2], factor * np.asarray(z, dtype=np.float64)])
    # Only to raise errors: a cloud of points and a grid of many layers have no one height.
    if isinstance(mesh, pv.PolyData):
        blocks.surface(mesh, "mesh")
    else:
        _check_layer(mesh)
    triangles = subdivision.simplices(mesh)
    # A face with a corner that has no height is a hole.
    finite = np.all(np.isfinite(points), axis=1)
    triangles = triangles[np.all(finite[triangles], axis=1)]
    if not len(triangles) or triangles.shape[1] < 3:
        raise _check.value_error("mesh", "faces with heights", "none")
    # Points of no face would make the raster larger.
    used = points[np.unique(triangles)]
    low, sides = used.min(axis=0)[:2], np.ptp(used, axis=0)[:2]
    # By default there are about as many nodes as points.
    step = spacing or float(np.sqrt(sides[0] * sides[1] / len(used)))
    if not (step > 0 and step <= sides.min()):
        expected = f"a spacing up to {sides.min():g}, the shorter side of the mesh"
        raise _check.value_error("raster", expected, step)
    with np.errstate(over="ignore"):
        # A tiny spacing gives an infinite number, which is no integer and no help in a message.
        count = np.minimum(np.round(sides / step) + 1, 2 * LARGEST)
    if count[0] * count[1] > LARGEST:
        got = f"{count[0]:g} x {count[1]:g} nodes"
        raise _check.value_error("raster", f"a raster of at most {LARGEST} nodes", got)
    x, y = (np.linspace(low[a], low[a] + sides[a], int(count[a])) for a in (0, 1))
    # Seen from above: of several layers, as at a bridge, the highest counts.
    heights = depth_map(x, y, points, triangles)
    if np.isnan(heights).all():
        raise _check.value_error("raster", "nodes that the mesh covers", "none")
    place = np.arange(heights.size).reshape(heights.shape)
    # Points at the outline interpolate nodes beyond it, which so have the height of the nearest.
    filled, stretch = height_field.filled(heights), _stretch(mesh, y)
    return Raster(x, y, filled, place, stretch, surface_points=points)


def _check_layer(grid: Grid) -> tuple[int, int]:
    """Return the numbers of columns and rows of a grid that has one layer."""
    nx, ny, nz = grid.dimensions
    if nz != 1:
        got = f"{nx} x {ny} x {nz}"
        remedy = "pass one layer of it, or its closed surface, mesh.extract_surface()"
        raise _check.value_error("mesh", "a grid of one layer, nx x ny x 1", got, remedy)
    return nx, ny


def _nodes(grid: Grid) -> tuple[Array, float]:
    """Return the points of a level grid, shape (ny, nx, 3), and the rounding of their x and y."""
    if grid.n_points == 0:
        raise _check.value_error("mesh", "a grid of points", "an empty one")
    nx, ny = _check_layer(grid)
    if isinstance(grid, pv.StructuredGrid):
        points: Array = np.asarray(grid.points)
    else:
        points = GridPoints(grid)[:]
        # Only the points of a StructuredGrid may have the heights as their z.
        sides = [np.ptp(axis) for axis in points.T]
        if sides[2] > LEVEL * np.linalg.norm(sides):
            raise _tilted()
    # Rows that are straight bend by the rounding of their largest coordinate, however near its
    # nodes are to each other.
    eps = np.finfo(np.float32 if points.dtype == np.float32 else np.float64).eps
    nodes: Array = np.asarray(points, dtype=np.float64).reshape(ny, nx, 3)
    return nodes, float(eps * np.nanmax(np.abs(nodes[..., :2])))


def _check_square(x: Array, y: Array, rounding: float) -> None:
    """Check that x depends on the column alone and y on the row alone, up to rounding."""
    for axis in (x[0], y[:, 0]):
        # Rows or columns whose nodes are above one another: the grid stands upright.
        if len(axis) > 1 and np.ptp(axis) <= 4 * rounding:
            raise _tilted()
    # In this form NaN fails, too.
    if not max(np.ptp(x, axis=0).max(), np.ptp(y, axis=1).max()) <= 8 * rounding:
        expected = "rows and columns that are straight and at right angles"
        raise _check.value_error("mesh", expected, "other rows and columns", REMEDY)


def _tilted() -> ValueError:
    remedy = "make it level and rotate the light with it, or pass its surface with thickness="
    return ValueError(_check.message("mesh", "a grid that lies level", "a tilted one", remedy))


def _turn(nodes: Array, rounding: float) -> Array | None:
    """Return the rotation about the vertical that aligns rows with x; None if they follow an axis.

    Nodes have shape (ny, nx, 3); each coordinate may be off by the rounding.
    """
    # From the first node to the last of its row, and to the last of its column.
    along, across = (nodes[end][:2] - nodes[0, 0, :2] for end in ((0, -1), (-1, 0)))
    # The longer side gives more digits of the angle.
    longer = np.hypot(*along) >= np.hypot(*across)
    x, y = along if longer else (across[1], -across[0])
    if not min(abs(x), abs(y)) > 2 * rounding:
        return None
    size = np.hypot(x, y)
    # Takes the direction of the rows to the x axis; heights stay.
    return np.asarray(np.array([[x, y, 0], [-y, x, 0], [0, 0, size]]) / size)


def is_terrain(surface: pv.DataSet) -> bool:
    """Return whether a surface is a terrain by its shape: heights, one above each place of a plain.

    All its faces look up, or all down; it is far wider than high, 100 units at least, as maps in
    metres are, and has many slopes, while parts have walls and few normals.
    """
    wide, long, high = surface.bounds_size
    is_wide = min(wide, long) >= max(WIDE, high / MOST_HIGH) and high > 0
    if not isinstance(surface, pv.PolyData) or not is_wide or not has_faces(surface):
        return False
    triangles = subdivision.simplices(surface)
    some = _areas(surface, triangles[:: max(len(triangles) // SAMPLE, 1)])
    if not _look_alike(some):
        return False
    slopes = np.rint(some[:, :2] / some[:, 2:] / SLOPE)
    _, counts = np.unique(slopes, axis=0, return_counts=True)
    if len(counts) < MANY or counts.max() > len(slopes) / 2:
        return False
    every = _areas(surface, triangles)
    # Faces one above another have more area in the plain than there is.
    area = float(np.abs(every[:, 2]).sum())
    return _look_alike(every) and area <= 2 * wide * long * (1 + LEVEL)


def steep(mesh: pv.DataSet, heights: str, share: float) -> float:
    """Return the slope, as rise over run, that a share of a map does not exceed; 0 without faces.

    The mesh is level; one in degrees is taken in metres. The share is one of a sample of its
    triangles.
    """
    flat = georeference.in_metres(mesh)
    triangles = _some_triangles(flat, MOST_STEEP)
    if not len(triangles) or triangles.shape[1] < 3:
        return 0.0
    points: Array = np.array(points_of(flat, None)[:], dtype=np.float64)
    points[:, 2] = flat.point_data[heights]
    normals = across(points, triangles)
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.hypot(normals[:, 0], normals[:, 1]) / np.abs(normals[:, 2])
    slopes = slopes[np.isfinite(slopes)]
    return float(np.quantile(slopes, share)) if len(slopes) else 0.0


def _some_triangles(mesh: pv.DataSet, most: int) -> Indices:
    """Return the corners of some triangles of a mesh, without all others where it is a grid."""
    sizes = [size for size in dimensions(mesh) if size > 1]
    if len(sizes) != 2:
        triangles = subdivision.simplices(mesh)
        return triangles[:: 1 + len(triangles) // most]
    wide, count = sizes[0], (sizes[0] - 1) * (sizes[1] - 1)
    rows, columns = np.divmod(np.arange(0, count, 1 + 2 * count // most), wide - 1)
    first = rows * wide + columns
    return np.concatenate([
        np.stack([first, first + 1, first + wide + 1], axis=1),
        np.stack([first, first + wide + 1, first + wide], axis=1),
    ])  # fmt: skip


def _areas(surface: pv.PolyData, triangles: Indices) -> Array:
    """Return vectors along the normals of triangles, twice as long as their areas."""
    return across(np.asarray(surface.points, dtype=np.float64), triangles)


def _look_alike(areas: Array) -> bool:
    """Return whether all triangles look up, or all down."""
    return bool(np.all(areas[:, 2] > 0) or np.all(areas[:, 2] < 0))


def raised(grid: Grid) -> Grid:
    """Return a grid of one level layer raised by its heights; any other as it is.

    A grid in degrees becomes one in metres.
    """
    name = elevation_name(grid)
    if name is None or grid.dimensions[2] != 1 or grid.bounds_size[2] > 0:
        return grid
    grid = georeference.in_metres(grid)
    points: Array = np.array(grid.points, dtype=np.float64)
    points[:, 2] = grid.point_data[name]
    return blocks.structured(points, grid.dimensions)


def heights_name(grid: pv.DataSet) -> str | None:
    """Return the name of the point array of heights: the active one, or the only one."""
    there = [key for key in grid.point_data if np.ndim(grid.point_data[key]) == 1]
    active = grid.point_data.active_scalars_name
    # Vectors may be the active array.
    return active if active in there else there[0] if len(there) == 1 else None


def elevation_name(grid: Grid | pv.PolyData) -> str | None:
    """Return the name of the point array of heights, None where the z of the points is taken."""
    name = heights_name(grid)
    if name is not None and isinstance(grid, pv.StructuredGrid | pv.PolyData):
        z = np.asarray(grid.points)[:, 2]
        # Points that differ in z are raised already; level ones need an array.
        return None if np.nanmin(z) < np.nanmax(z) else name
    return name


def _elevation(grid: Grid | pv.PolyData, name: str | None, z: Array) -> Array:
    """Return the heights in a point array, or the z of points that may have heights as their z."""
    if name is None:
        name = elevation_name(grid)
        if name is None and isinstance(grid, pv.StructuredGrid | pv.PolyData):
            return z
    grid = records.averaged(grid, name)
    rows = records.scalars_of(grid, "elevation", name)
    return _check.floats("elevation", rows).reshape(z.shape)
