"""Maps in the plane of a map projection: their points and vectors, outline and graticule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pyvista as pv
from matplotlib.path import Path

from vizlight import _check
from vizlight._types import Array, Bools, Foreign
from vizlight.mesh import blocks, georeference, globes, meaning, projections
from vizlight.mesh.georeference import PROJECTION
from vizlight.mesh.projections import Projection

#: Degrees over which a projection is differentiated.
STEP = 1e-4
#: Share by which lengths on the earth and on a ball may differ.
ROUND = 0.01
#: Distance beyond the outline of a map that counts as on it, as a share of the map's size.
EDGE = 1e-3
#: Room around points, which are drawn as discs, as a share of the longer side of their map.
AROUND_POINTS = 0.02
#: Places along each side of a map at which its longitudes and latitudes are looked at.
SAMPLES = 60
#: Degrees beyond a map within which a line that ends on it has a place.
BESIDE = 3.0
#: Points of the meridian at which a map of the earth ends.
EDGE_POINTS = 90
#: Halvings of a step of a line where it crosses the outline.
HALVINGS = 14
#: Ratio of steps to both sides from which on one crosses the seam of a projection.
TORN = 3.0
#: Longest way of a map, as a share of the way around the earth, that is drawn without a tear.
WHOLE = 0.9


def chart(mesh: pv.DataSet, /, projection: str | None = None) -> pv.DataSet:
    """Return a map in degrees in metres of a map projection.

    Vectors, and components of vectors such as those of a wind, keep their lengths and are turned
    from east and north to where these directions point. On the sphere, the places agree with PROJ's
    to 1e-6 m.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Map, whose field array ``unit`` says ``degree``.
    projection : str, optional
        Keywords of PROJ, such as ``"+proj=lcc +lat_1=30 +lat_2=60 +lon_0=10 +R=6371000"``:
        ``lcc``, ``eqc``, ``eqearth``, ``stere`` about a pole, and ``ob_tran`` of ``eqc``, on a
        sphere; any other reference system needs rasterio, the extra ``maps``. Default: that of the
        file's grid, else a conformal cone through the map, the stereographic projection around a
        pole, or the Equal Earth projection of a grid around the earth.

    Returns
    -------
    pyvista.DataSet
        Map with the field arrays ``unit``, which is ``metre``, and ``projection``. An image or a
        rectilinear grid stays such where the projection is ``eqc``.

    Raises
    ------
    TypeError, ValueError
        If it is no map in degrees, no projection is known, or the map has places beyond it.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import cartography
    >>> europe = pv.ImageData(dimensions=(51, 36, 1), origin=(-10, 35, 0))
    >>> europe = cartography.chart(cartography.in_degrees(europe))
    >>> str(europe.field_data["unit"][0])
    'metre'
    """
    _check.instance("mesh", mesh, pv.DataSet, "a mesh")
    _check.coordinates("mesh", mesh.bounds)
    if not georeference.has_degrees(mesh):
        remedy = "pass it through vizlight.cartography.in_degrees"
        raise _check.value_error("mesh", "a map in degrees", "no such unit", remedy)
    if projection is not None:
        _check.text("projection", projection)
    text = suited(mesh) if projection is None else projection
    plane = projections.of_text(text)
    if plane is None:
        expected = "keywords of PROJ on a sphere, or a reference system and rasterio"
        remedy = "name one, or install vizlight[maps]"
        raise _check.value_error("projection", expected, repr(text), remedy)
    words = projections.keywords(text)
    if words.get("proj") == "eqearth":
        mesh = globes.centred(mesh, float(words.get("lon_0", 0.0)))
    flat = _moved(mesh, plane, is_plane=words.get("proj") == "eqc")
    if not np.isfinite(flat.bounds).all():
        raise _check.value_error("mesh", f"places on the map of {text!r}", "some beyond it")
    flat.field_data[georeference.UNIT] = ["metre"]
    flat.field_data[PROJECTION] = [text]
    return flat


def suited(mesh: pv.DataSet, *, straight: bool = False, north_up: bool = False) -> str:
    """Return the text of the projection in which a map in degrees is best drawn, empty for none.

    Rows and columns of a ``straight`` one stay so; with ``north_up`` a course is to be the same
    angle everywhere on the map, where scales allow it.
    """
    if PROJECTION in mesh.field_data and not straight:
        return str(mesh.field_data[PROJECTION][0])
    if not straight and (middle := globes.middle_of(mesh)) is not None:
        return projections.around(middle)
    return projections.suited(mesh.bounds, straight=straight, north_up=north_up)


def is_torn(mesh: pv.DataSet) -> bool:
    """Return whether a chart reaches around the earth, where its rows would turn back."""
    return float(max(mesh.bounds_size[:2])) > WHOLE * math.tau * projections.RADIUS


def _moved(mesh: pv.DataSet, plane: Projection, *, is_plane: bool) -> pv.DataSet:
    """Return a mesh with its points in the plane, and its vectors turned."""
    named = meaning.with_components(mesh)
    places = np.asarray(named.points, dtype=np.float64)
    middles = np.asarray(named.cell_centers().points) if _has_vectors(named.cell_data) else None
    flat: pv.DataSet
    if is_plane:
        # Longitudes of a map need not be within half a turn of 0.
        middle = np.array(named.center[:2])
        start, end = plane.forward(np.stack([middle, middle + 1]))
        scale = end - start
        flat = blocks.moved(named, np.append(start / scale - middle, 0.0), np.append(scale, 1.0))
    else:
        wide = named if len(named.cell_data) else globes.closed(named)
        is_plain = isinstance(wide, pv.ImageData | pv.RectilinearGrid)
        flat = wide.cast_to_structured_grid() if is_plain else wide.copy(deep=False)
        places = np.asarray(flat.points, dtype=np.float64)
        flat.SetPoints(pv.vtk_points(np.column_stack([plane.forward(places[:, :2]), places[:, 2]])))
    _turn(flat.point_data, places, plane)
    if middles is not None:
        _turn(flat.cell_data, middles, plane)
    return flat


def _has_vectors(data: pv.DataSetAttributes) -> bool:
    return any(meaning.are_vectors(data[name]) for name in data)


def _turn(data: pv.DataSetAttributes, places: Array, plane: Projection) -> None:
    """Turn vectors at places in degrees to where they point in a plane; their lengths stay."""
    names = [name for name in data if meaning.are_vectors(data[name])]
    if not names:
        return
    lon, lat = places[:, 0], np.clip(places[:, 1], -90 + 2 * STEP, 90 - 2 * STEP)
    step = np.full_like(lon, STEP)
    # A degree of longitude is shorter by the cosine of the latitude.
    wide = STEP / np.cos(np.radians(lat))
    zero = np.zeros_like(lon)
    here = plane.forward(np.column_stack([lon, lat]))
    east, north = (
        _slopes(
            plane.forward(np.column_stack([lon + x, lat + y])) - here,
            here - plane.forward(np.column_stack([lon - x, lat - y])),
        )
        for x, y in ((wide, zero), (zero, step))
    )
    for name in names:
        rows = np.asarray(data[name], dtype=np.float64)
        flat = rows[:, :1] * east + rows[:, 1:2] * north
        length = np.linalg.norm(flat, axis=1)
        scale = np.hypot(rows[:, 0], rows[:, 1]) / np.where(length > 0, length, 1.0)
        turned = np.column_stack([flat * scale[:, np.newaxis], rows[:, 2]])
        data[name] = turned.astype(np.asarray(data[name]).dtype)


def _slopes(ahead: Array, behind: Array) -> Array:
    """Return the sums of steps to both sides, twice the shorter one where the other is torn."""
    sizes = [np.linalg.norm(steps, axis=1)[:, np.newaxis] for steps in (ahead, behind)]
    shorter = np.where(sizes[0] < sizes[1], ahead, behind)
    is_torn = np.maximum(*sizes) > TORN * np.minimum(*sizes)
    return np.asarray(np.where(is_torn, 2 * shorter, ahead + behind))


@dataclass(frozen=True)
class MapSheet:
    """Map in a plane, with its projection and its outline.

    The outline (N, 2) is counter-clockwise, each corner once; ``metres`` is the length of a unit of
    x and y.
    """

    plane: Projection
    outline: Array
    metres: float

    @property
    def size(self) -> float:
        """Longer side of the map."""
        return float(np.ptp(self.outline, axis=0).max())

    @cached_property
    def unit(self) -> float:
        """Length on the earth, in metres, of a unit of x in the middle of the map.

        That of the plane where both differ by less than the earth from a ball.
        """
        middle = self.outline.min(axis=0) / 2 + self.outline.max(axis=0) / 2
        step = np.array([self.size * STEP, 0.0])
        ends = self.plane.inverse(np.stack([middle - step, middle + step]) * self.metres)
        east, north = _turns(ends[1, 0] - ends[0, 0]), ends[1, 1] - ends[0, 1]
        degrees = math.hypot(east * math.cos(math.radians(ends[:, 1].mean())), north)
        unit = degrees * georeference.METRES / (2 * step[0])
        is_other = math.isfinite(unit) and abs(unit / self.metres - 1) > ROUND
        return unit if is_other else self.metres

    def holds(self, places: Array) -> Bools:
        """Return which places are within the outline or on it."""
        inside: Bools = Path(self.outline).contains_points(places, radius=EDGE * self.size)
        return inside & np.isfinite(places).all(axis=1)

    def pieces(self, lines: Sequence[Array]) -> list[Array]:
        """Return the parts of lines in degrees that are on the map, in its coordinates."""
        if not lines:
            return []
        sizes = [len(line) for line in lines]
        earth = np.concatenate(lines)
        west, east, south, north = self.extent
        turned = (earth[:, 0] - west + BESIDE) % georeference.AROUND - BESIDE
        is_near = (turned < east - west + BESIDE) & (np.abs(earth[:, 1]) <= 90)
        is_near &= (earth[:, 1] > south - BESIDE) & (earth[:, 1] < north + BESIDE)
        places = np.full_like(earth, np.nan)
        places[is_near] = self.plane.forward(earth[is_near]) / self.metres
        inside = self.holds(places)
        first = np.zeros(len(places), np.bool_)
        first[np.cumsum([0, *sizes[:-1]])] = True
        # A step across the seam of a projection is none of the line.
        with np.errstate(invalid="ignore"):
            steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
        near = np.append(False, steps < self.size / 2) & ~first
        enters = np.flatnonzero(near & inside & ~np.roll(inside, 1))
        leaves = np.flatnonzero(near & ~inside & np.roll(inside, 1))
        starts = dict(zip(enters, self._sides(places[enters], places[enters - 1]), strict=True))
        ends = dict(zip(leaves, self._sides(places[leaves - 1], places[leaves]), strict=True))
        begins = np.flatnonzero(inside & ~(near & np.roll(inside, 1)))
        stops = np.flatnonzero(inside & ~np.append((near & inside)[1:], False)) + 1
        parts = [
            np.concatenate([[starts[a]] if a in starts else places[:0], places[a:b],
                            [ends[b]] if b in ends else places[:0]])
            for a, b in zip(begins, stops, strict=True)
        ]  # fmt: skip
        return [part for part in parts if len(part) > 1]

    def _sides(self, inner: Array, outer: Array) -> Array:
        """Return where steps from within the outline to beyond it cross the outline."""
        outer = np.where(np.isfinite(outer), outer, inner)
        for _ in range(HALVINGS if len(inner) else 0):
            middle = (inner + outer) / 2
            inside = self.holds(middle)[:, np.newaxis]
            inner, outer = np.where(inside, middle, inner), np.where(inside, outer, middle)
        return inner

    @cached_property
    def extent(self) -> tuple[float, float, float, float]:
        """West, east, south and north of the map in degrees; all around where it holds a pole."""
        low, high = self.outline.min(axis=0), self.outline.max(axis=0)
        x, y = (np.linspace(a, b, SAMPLES) for a, b in zip(low, high, strict=True))
        inner = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        places = np.concatenate([self.outline, inner[self.holds(inner)]])
        earth = self.plane.inverse(places * self.metres)
        earth = earth[np.isfinite(earth).all(axis=1)]
        south, north = earth[:, 1].min(), earth[:, 1].max()
        middle = self.plane.inverse((low + high)[np.newaxis] / 2 * self.metres)[0, 0]
        if self.is_around:
            south, north = (south, 90.0) if north > -south else (-90.0, north)
            return middle - 180.0, middle + 180.0, south, north
        east = _turns(earth[:, 0] - middle) + middle
        if np.ptp(east) > georeference.AROUND - 1:
            return middle - 180.0, middle + 180.0, south, north
        return east.min(), east.max(), south, north

    @cached_property
    def is_around(self) -> bool:
        """Whether a pole is within the outline."""
        ring = self.plane.inverse(self.outline * self.metres)[:, 0]
        # The corners of the earth as a satellite sees it are beside it.
        ring = ring[np.isfinite(ring)]
        turns = np.sum(_turns(np.diff(ring, append=ring[:1])))
        return bool(abs(turns) > georeference.AROUND / 2)


def _turns(degrees: Foreign) -> Foreign:
    """Return differences of longitudes, from -180 to 180."""
    return (degrees + 180.0) % georeference.AROUND - 180.0


def sheet(mesh: pv.DataSet) -> MapSheet | None:
    """Return a flat map in lengths as a sheet, None where its projection is not known.

    Its field array ``projection`` or ``crs`` tells of it.
    """
    names = [name for name in (PROJECTION, "crs") if name in mesh.field_data]
    metres = meaning.metres(georeference.unit_of(mesh))
    if not names or metres is None or not georeference.on_earth(mesh):
        return None
    text = str(mesh.field_data[names[0]][0])
    plane = projections.of_text(text)
    if plane is None or not np.ptp(np.reshape(mesh.bounds, (3, 2))[:2], axis=1).all():
        return None
    words = projections.keywords(text)
    if words.get("proj") == "eqearth":
        outline = _outline_of_earth(mesh, plane, metres, float(words.get("lon_0", 0.0)))
    else:
        outline = _outline(mesh)
    return MapSheet(plane, outline, metres)


def box_of(mesh: pv.DataSet) -> Array:
    """Return west, east, south and north of a map, with room around one of points."""
    is_points = isinstance(mesh, pv.PolyData) and mesh.n_verts == mesh.n_cells
    room = AROUND_POINTS * max(mesh.bounds_size[:2]) if is_points else 0.0
    return np.asarray(mesh.bounds[:4]) + room * np.array([-1, 1, -1, 1])


def _outline(mesh: pv.DataSet) -> Array:
    """Return the corners of the outline of a map, counter-clockwise; of no curved grid its box."""
    west, east, south, north = box_of(mesh)
    corners = np.array([[west, south], [east, south], [east, north], [west, north]])
    if not isinstance(mesh, pv.StructuredGrid):
        return corners
    columns, rows = mesh.dimensions[:2]
    if columns * rows != mesh.n_points:
        return corners
    grid = np.asarray(mesh.points, dtype=np.float64)[:, :2].reshape(rows, columns, 2)
    size = np.ptp(corners, axis=0).max()
    if np.allclose(grid[:, 0], grid[:, -1], rtol=0, atol=EDGE * size):
        # Around a pole the outline is the longer one of the outer rows.
        ring = max(grid[0, :-1], grid[-1, :-1], key=lambda row: float(np.ptp(row, axis=0).max()))
    else:
        ring = np.concatenate([grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]])
    turns = ring[:, 0] * np.roll(ring[:, 1], -1) - ring[:, 1] * np.roll(ring[:, 0], -1)
    return ring if turns.sum() > 0 else ring[::-1]


def _outline_of_earth(mesh: pv.DataSet, plane: Projection, metres: float, lon: float) -> Array:
    """Return the outline of a map in Equal Earth about a longitude, of no whole earth its own.

    A map around the earth ends at the meridian opposite to the middle one, however few its rows.
    """
    ends = np.column_stack([np.zeros(2), mesh.bounds[2:4]])
    south, north = plane.inverse(ends * metres)[:, 1]
    lat = np.linspace(south, north, EDGE_POINTS)
    edge = np.full_like(lat, lon + georeference.AROUND / 2)
    side = plane.forward(np.column_stack([edge, lat])) / metres
    ring = np.concatenate([side, side[::-1] * (-1, 1)])
    is_whole = np.ptp(ring[:, 0]) <= (1 + EDGE) * mesh.bounds_size[0]
    return ring if is_whole else _outline(mesh)
