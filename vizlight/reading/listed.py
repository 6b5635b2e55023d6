"""Values in a list, each with a place: cells by their bounds, as CF has them, or points."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np
import pyvista as pv
import scipy

from vizlight._types import Array, Bools, Foreign, Indices, Raw
from vizlight.mesh import georeference, globes, meaning, polylines, unrolled

#: Dimensions of cells of several faces, and of their corners.
CELLS = ("cell", "corner")
#: Least and largest number of points that are joined, degrees of latitude that they must span, and
#: the largest radius of a hole between them, in distances of even points.
FEWEST, MOST_JOINED, TALL, HOLE = 100, 1_000_000, 150.0, 2.0
#: Decimals of corners that are one, in degrees or in metres.
_SAME = 6
#: Step in longitude from which a track goes on at the other side of a map.
HALF_WAY = 180.0


@dataclass(frozen=True)
class Listed:
    """Names of the coordinates that give the values of a list their places.

    ``dim`` is the dimension of the list, ``x`` and ``y`` those of each value, and the bounds those
    of the corners of each cell, empty for none.
    """

    dim: str
    x: str
    y: str
    x_bounds: str
    y_bounds: str


def listed(file: Foreign, letter_of: Callable[[str, Mapping[str, Foreign]], str]) -> Listed | None:
    """Return the list with the most values of a dataset, None without a list.

    ``letter_of`` takes the name and the attributes of coordinates to x, y or an empty text.
    """
    places: dict[str, dict[str, str]] = {}
    for key, variable in file.variables.items():
        name = str(key)
        if len(variable.dims) == 1 and variable.dims[0] != name and variable.dtype.kind in "iuf":
            letter = letter_of(name, variable.attrs)
            if letter:
                places.setdefault(str(variable.dims[0]), {}).setdefault(letter, name)
    lists = []
    for dim, pair in places.items():
        sizes = [
            variable.size
            for name, variable in file.data_vars.items()
            if dim in variable.dims and name not in pair.values()
        ]
        if len(pair) == 2 and sizes:
            bounds = [_bounds(file, pair[letter]) for letter in "xy"]
            bounds = bounds if all(bounds) else ["", ""]
            lists.append((bool(bounds[0]), max(sizes), Listed(dim, pair["x"], pair["y"], *bounds)))
    return max(lists, key=lambda entry: entry[:2])[2] if lists else None


def joined(
    file: Foreign, letter_of: Callable[[str, Mapping[str, Foreign]], str], chosen: Collection[str]
) -> Foreign:
    """Return a dataset with the cells on all faces of a cube in one list, with their corners.

    One without places of the corners on several faces is returned as it is; ``chosen`` are
    dimensions that are no faces, or of which one is chosen.
    """
    pairs: dict[tuple[str, ...], dict[str, str]] = {}
    for key, variable in file.variables.items():
        letter = letter_of(str(key), variable.attrs) if variable.ndim == 3 else ""
        if letter and variable.dtype.kind == "f" and variable.dims[0] not in chosen:
            pairs.setdefault(variable.dims, {})[letter] = str(key)
    for dims, middles in pairs.items():
        for around, corners in pairs.items():
            more = [file.sizes[a] - file.sizes[b] for a, b in zip(around, dims, strict=True)]
            if more == [0, 1, 1] and len(middles) == len(corners) == 2:
                return _in_list(file, dims, {middles[key]: corners[key] for key in middles})
    return file


def _in_list(file: Foreign, dims: tuple[str, ...], corners: Mapping[str, str]) -> Foreign:
    """Return a dataset with all that has some dimensions along one, in place of these.

    ``corners`` has the name of the places of corners for each of the middles of cells.
    """
    cell, corner = CELLS
    variables = {
        name: variable.stack({cell: dims}) if {*dims} <= {*variable.dims} else variable
        for name, variable in file.variables.items()
        if {*dims} <= {*variable.dims} or not {*dims} & {*variable.dims}
    }
    for middle, name in corners.items():
        at = file[name].values
        around = [at[:, :-1, :-1], at[:, :-1, 1:], at[:, 1:, 1:], at[:, 1:, :-1]]
        variables[name] = ((cell, corner), np.stack(around, axis=-1).reshape(-1, 4))
        variables[middle].attrs["bounds"] = name
    return type(file)(variables, attrs=file.attrs)


def _bounds(file: Foreign, name: str) -> str:
    """Return the name of the corners of cells, of three or more each, an empty text for none."""
    # xarray may have moved it from the attributes. SCRIP tells centres and corners by their names.
    corner = name.replace("center", "corner")
    bounds = str((file[name].encoding | file[name].attrs).get("bounds", corner))
    if bounds not in file.variables:
        return ""
    array = file[bounds]
    corners = array.ndim == 2 and array.dims[0] == file[name].dims[0] and array.shape[1] > 2
    return bounds if corners and array.dtype.kind == "f" else ""


def cells(x: Array, y: Array, *, degrees: bool) -> tuple[unrolled.Faces, Bools]:
    """Return cells in the plane, and a mask of those that have three corners or more.

    The coordinates (N, K) of the corners of each cell are NaN for none.
    """
    there = np.isfinite(x) & np.isfinite(y)
    x, y = np.round(x % 360.0 if degrees else x, _SAME), np.round(y, _SAME)
    x = x % 360.0 if degrees else x
    # As complex numbers, which are sorted faster than rows.
    nodes, number = np.unique(x[there] + 1j * y[there], return_inverse=True)
    ids: Indices = np.zeros(x.shape, dtype=np.intp)
    ids[there] = np.ravel(number)
    # A cell of fewer corners than others repeats one.
    there[:, 1:] &= (ids[:, 1:] != ids[:, :-1]) | ~there[:, :-1]
    there[:, -1] &= ids[:, -1] != ids[:, 0]
    whole = there.sum(axis=1) > 2
    laid = unrolled.unrolled if degrees else unrolled.plain
    return laid(nodes.real, nodes.imag, ids[whole], there[whole]), whole


def points(
    x: Array, y: Array, *, degrees: bool
) -> tuple[pv.PolyData | pv.RectilinearGrid, Indices]:
    """Return points in the plane, and the row of the list of each; a grid if they stand on one.

    Points that are not finite are left out.
    """
    kept = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    x, y = x[kept], y[kept]
    if degrees:
        x = x - 360.0 * np.ceil((x - 180.0) / 360.0)
        # No region is parted: longitudes begin behind the widest gap between any two.
        ticks = np.unique(x)
        gaps = np.diff(ticks, append=ticks[:1] + 360.0)
        widest = int(gaps.argmax()) if gaps.size else 0
        if gaps.size and gaps[widest] > 2 * gaps[-1]:
            x = np.where(x <= ticks[widest], x + 360.0, x)
            x = x - 360.0 * np.ceil(((x.min() + x.max()) / 2 - 180.0) / 360.0)
    order = _rows_and_columns(x, y)
    if order is None:
        return pv.PolyData(np.column_stack([x, y, np.zeros(len(x))])), kept
    return pv.RectilinearGrid(x[order[0]], y[order[:, 0]], np.zeros(1)), kept[order.ravel()]


@dataclass(frozen=True)
class Around:
    """Triangles between points that cover the earth.

    Poles that lie in a ring of one parallel come after the points, and ``rings`` has the points
    around each; triangles are counted around as seen from above.
    """

    lon: Array
    lat: Array
    triangles: Indices
    rings: list[Indices]

    def faces(self) -> unrolled.Faces:
        """Return the triangles on a map."""
        whole = np.ones(self.triangles.shape, np.bool_)
        return unrolled.unrolled(self.lon, self.lat, self.triangles, whole)

    def rows(self, values: Raw) -> Raw:
        """Return the values of points and poles by those of the points."""
        means = [values[ring].mean(axis=0, keepdims=True) for ring in self.rings]
        return np.concatenate([values, *means]).astype(values.dtype)


def around_earth(lon: Array, lat: Array) -> Around | None:
    """Return Delaunay's triangles between points that cover the earth evenly, None for others.

    Places are in degrees, such as those of a reduced Gaussian grid.
    """
    if not FEWEST <= len(lon) <= MOST_JOINED or np.ptp(lat) < TALL:
        return None
    ball = globes.directions(np.column_stack([lon, lat]))[:, 2]
    try:
        hull = scipy.spatial.ConvexHull(ball)
    except scipy.spatial.QhullError:
        return None
    # The plane of a triangle is the nearer to the centre, the larger the hole without points is.
    hole = float(np.arccos(np.clip(-hull.equations[:, 3].max(), -1, 1)))
    if hole > HOLE * math.sqrt(4 * math.pi / len(lon)):
        return None
    sides = np.asarray(hull.simplices, dtype=np.intp)
    a, b, c = (ball[corner] for corner in sides.T)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    sides = np.where(inward[:, np.newaxis], sides[:, ::-1], sides)
    # Triangles within the last parallel before a pole have no area on a map: the pole joins it.
    level = np.ptp(lat[sides], axis=1) == 0
    triangles, rings = [sides[~level]], []
    for pole in (90.0, -90.0):
        ring = np.unique(sides[level & (lat[sides[:, 0]] * pole > 0)])
        if len(ring):
            ring = ring[np.argsort(lon[ring])][:: int(math.copysign(1, pole))]
            middle = np.full(len(ring), len(lon))
            triangles.append(np.stack([ring, np.roll(ring, -1), middle], axis=1))
            rings.append(ring)
            lon, lat = np.append(lon, 0.0), np.append(lat, pole)
    return Around(lon, lat, np.concatenate(triangles), rings)


def with_turned_rows(rows: Raw, width: int) -> Raw:
    """Return a list of which every second row of a grid runs back, with all rows alike.

    ``width`` is the number of values of a row.
    """
    turned = rows.reshape(-1, width).copy()
    turned[1::2] = turned[1::2, ::-1]
    return turned.ravel()


def _rows_and_columns(x: Array, y: Array) -> Indices | None:
    """Return the indices of points that stand row by row on a grid, shape (ny, nx), else None."""
    for slow, fast in ((y, x), (x, y)):
        turns = np.flatnonzero(np.diff(slow)) + 1
        width = int(turns[0]) if turns.size else 0
        if width < 2 or len(slow) % width:
            continue
        rows, columns = slow.reshape(-1, width), fast.reshape(-1, width)
        if np.ptp(rows, axis=1).any() or np.ptp(columns, axis=0).any():
            continue
        by_row, by_column = np.argsort(rows[:, 0]), np.argsort(columns[0])
        if np.diff(rows[by_row, 0]).all() and np.diff(columns[0, by_column]).all():
            order = np.arange(len(slow)).reshape(rows.shape)[np.ix_(by_row, by_column)]
            return order if fast is x else order.T
    return None


def seem_radians(x: Array, y: Array) -> bool:
    """Return whether angles without a unit are in radians: all around the globe, and no further."""
    around = 0.9 * 2 * math.pi < np.ptp(x) < 1.01 * 2 * math.pi
    return bool(around and 0.9 * math.pi < np.ptp(y) and np.abs(y).max() < 1.01 * math.pi / 2)


def tracks(file: Foreign, dim: str) -> Indices | None:
    """Return the number of the track of each value of a list, None if there are no tracks.

    These are the trajectories of the CF conventions, as ragged arrays, contiguous or with indices,
    or a single one.
    """
    if str(file.attrs.get("featureType", "")).lower() not in ("trajectory", "trajectoryprofile"):
        return None
    size = int(file.sizes[dim])
    for variable in file.variables.values():
        if variable.attrs.get("sample_dimension") == dim:
            counts = np.asarray(variable.values).astype(np.intp)
            if counts.sum() == size:
                return np.repeat(np.arange(len(counts)), counts)
        has_id = variable.attrs.get("cf_role") == "trajectory_id"
        if variable.dims == (dim,) and (has_id or "instance_dimension" in variable.attrs):
            return np.unique(variable.values, return_inverse=True)[1]
    return np.zeros(size, np.intp)


def height_of_track(file: Foreign, dim: str) -> tuple[str, Array] | None:
    """Return the name and the heights in metres, above 0 or below it, of the values of a track.

    None where the dataset has none that differ, in a unit of length.
    """
    for key, variable in file.variables.items():
        standard, way = (variable.attrs.get(word, "") for word in ("standard_name", "positive"))
        metres = meaning.metres(str(variable.attrs.get("units", "")))
        is_height = way in ("up", "down") or standard in ("depth", "height", "altitude")
        if (
            variable.dims != (dim,)
            or variable.dtype.kind not in "iuf"
            or not (is_height and metres)
        ):
            continue
        sign = -1.0 if way == "down" or (standard == "depth" and way != "up") else 1.0
        heights = sign * metres * np.asarray(variable.values, dtype=np.float64)
        if np.isfinite(heights).any() and np.nanmin(heights) < np.nanmax(heights):
            return str(key), heights
    return None


def section(x: Array, y: Array, heights: Array, *, degrees: bool) -> tuple[pv.PolyData, Indices]:
    """Return a track as a line over its length in metres, and the row of the list of each point.

    Heights in metres are y of the line. Coordinates are in degrees or else in metres.
    """
    kept = np.flatnonzero(np.isfinite(x) & np.isfinite(y) & np.isfinite(heights))
    x, y = np.diff(x[kept]), y[kept]
    if degrees:
        x = (x + HALF_WAY) % (2 * HALF_WAY) - HALF_WAY
        x = x * np.cos(np.radians((y[1:] + y[:-1]) / 2)) * georeference.METRES
        y = y * georeference.METRES
    along = np.append(0.0, np.cumsum(np.hypot(x, np.diff(y))))
    points = np.column_stack([along, heights[kept], np.zeros(len(kept))])
    return polylines.polydata(points, np.array([0, len(kept)])), kept


def with_tracks(points: pv.PolyData, numbers: Indices) -> pv.PolyData:
    """Return points with lines along their tracks, which end where they leave the map."""
    order = np.argsort(numbers, kind="stable")
    steps = np.abs(np.diff(points.points[order, 0]))
    ends = np.flatnonzero((np.diff(numbers[order]) != 0) | (steps > HALF_WAY)) + 1
    parts = [part for part in np.split(order, ends) if len(part) > 1]
    lines = [number for part in parts for number in (len(part), *part.tolist())]
    return pv.PolyData(points.points, lines=lines)
