"""What is done with one piece: read it, light it, cut off the ghost cells, write it whole."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import pyvista as pv

from vizlight import _check, _compiled, _pool, files
from vizlight.draw import cameras
from vizlight.filters.illuminate import illuminate, light_mesh
from vizlight.filters.streamlines import streamlines
from vizlight.mesh import normals, records
from vizlight.pieces.ghosts import GHOST
from vizlight.pieces.kinds import INDEX, SUFFIX, Piece, PieceError
from vizlight.reading import hull, sides
from vizlight.reading.parts import uses_normals
from vizlight.reading.polylines import has_lines_only
from vizlight.shading import engine
from vizlight.shading.options import LightOptions
from vizlight.shading.results import record_key

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from vizlight._types import Array, Foreign, Given
    from vizlight.reading.normals import Told
    from vizlight.scene import Scene

T = TypeVar("T")

#: Filters that light a piece without knowing the others.
FILTERS = {"illuminate": illuminate, "streamlines": streamlines}
#: Name of the gradient of the contoured array, which gives normals that no cut changes.
GRADIENT = "gradient"
#: Name, for a while, of a mask of the points inside a volume, which have no normals.
INSIDE = "vizlight_inside"


@dataclass(frozen=True, kw_only=True)
class Job:
    """What is done with each piece, the same for all."""

    scene: Scene
    filter: str
    options: Mapping[str, Given]
    contour: str | None
    level: float | None
    ghost: int
    suffix: str
    compiled: str = "0"
    threads: int = 1

    @property
    def name(self) -> str:
        """Name of the array of the light."""
        return str(self.options.get("name", "luminance"))


@dataclass(frozen=True)
class Survey:
    """What a first look at a piece finds.

    Attributes
    ----------
    points : int
        Number of points.
    bounds : tuple of 6 float
        Bounding box.
    arrays : dict
        Type and number of components of each array, by "point NAME" and "cell NAME".
    values : tuple of 2 float
        Range of the contoured array.
    lines : bool
        Whether it has lines and no faces.
    """

    points: int
    bounds: tuple[float, ...]
    arrays: dict[str, str]
    values: tuple[float, float] = (np.inf, -np.inf)
    lines: bool = False


@dataclass
class Done:
    """A piece that was lit: its file, if any point of it remains, and what is in it."""

    file: str = ""
    points: int = 0
    cells: int = 0
    bounds: list[float] = field(default_factory=list)
    extent: list[int] = field(default_factory=list)
    grid: dict[str, list[float]] = field(default_factory=dict)
    ranges: dict[str, list[float]] = field(default_factory=dict)
    arrays: dict[str, list[Foreign]] = field(default_factory=dict)
    invalid: int = 0
    sharp: float | None = None
    notes: list[str] = field(default_factory=list)


def survey(piece: Piece, contour: str | None) -> Survey:
    """Return what a first look at a piece finds.

    Raises
    ------
    PieceError
        If it cannot be read.
    """
    mesh = read(piece, 0)
    if not mesh.n_points:
        return Survey(0, (), {})
    arrays = {"type ": type(mesh).__name__}
    for kind, data in (("point", mesh.point_data), ("cell", mesh.cell_data)):
        for name, array in data.items():
            if name != GHOST:
                components = "" if array.ndim == 1 else f" x {array.shape[1]}"
                arrays[f"{kind} {name}"] = f"{array.dtype}{components}"
    if isinstance(mesh, pv.PolyData | pv.UnstructuredGrid | pv.StructuredGrid):
        arrays["points "] = str(np.asarray(mesh.points).dtype)
    values = (np.inf, -np.inf)
    if contour is not None and contour in mesh.point_data and mesh.point_data[contour].ndim == 1:
        rows = np.asarray(mesh.point_data[contour], dtype=np.float64)
        rows = rows[np.isfinite(rows)]
        values = (float(rows.min(initial=np.inf)), float(rows.max(initial=-np.inf)))
    return Survey(mesh.n_points, tuple(mesh.bounds), arrays, values, has_lines_only(mesh))


def outermost(piece: Piece, job: Job, *view: Foreign) -> Array:
    """Return the points of a piece, or of its isosurface, on which a camera depends."""
    if job.contour is None:
        found = _tried(piece, piece.places)
    else:
        found = _tried(piece, lambda: np.asarray(isosurface(read(piece, 0), job).points))
    direction, up, aspect = view
    places = np.empty((0, 3)) if found is None else found
    return cameras.outermost(places, direction, up=up, aspect=aspect)


def depths(piece: Piece, job: Job) -> tuple[float, float]:
    """Return the least and the largest depth of the points of a piece that are lit."""
    mesh = read(piece, 0)
    if job.contour is not None:
        mesh = _tried(piece, partial(isosurface, mesh, job)) or mesh
    return engine.depth_range(np.asarray(mesh.points), job.scene)


def read(piece: Piece, ghost: int) -> pv.DataSet:
    """Return the mesh of a piece, which may have no points."""
    return _tried(piece, partial(piece.read, ghost)) or pv.PolyData()


def _tried(piece: Piece, found: Callable[[], T]) -> T | None:
    """Return what a function reads, None where a piece has no points."""
    try:
        return found()
    except (OSError, ValueError, TypeError, KeyError) as error:
        if isinstance(error, files.FileError) and "(no points)" in str(error):
            return None  # parallel writers make such files
        raise PieceError(f"piece {piece.name}: {error}") from error


def look(piece: Piece, job: Job) -> sides.Look | None:
    """Return what a piece tells of the sides of the whole, None where its light has none."""
    mesh = read(piece, job.ghost)
    if job.contour is not None:
        mesh = _tried(piece, partial(isosurface, mesh, job)) or mesh
    options = LightOptions.of(job.options)
    if not mesh.n_points or not uses_normals(mesh, options):
        return None
    if hasattr(mesh, "GetExtent") and 1 not in mesh.dimensions:
        return None  # a grid that fills space is closed, and so is each slab of it
    return _tried(piece, partial(sides.look, mesh, _others(mesh), options.normals, job.scene.view))


def _others(mesh: pv.DataSet) -> Array:
    """Return the share of the cells around each point that belong to other pieces."""
    around = pv.wrap(mesh.NewInstance())
    around.CopyStructure(mesh)
    around.cell_data[GHOST] = np.asarray(mesh.cell_data[GHOST], dtype=np.float32)
    return np.asarray(around.cell_data_to_point_data().point_data[GHOST])


def light(piece: Piece, job: Job, target: Path, told: Told | None = None) -> Done:
    """Light a piece, of whose sides the whole may have told, and write it to a path.

    The path has no suffix.

    Raises
    ------
    PieceError
        If the piece cannot be read, lit or written.
    """
    mesh = read(piece, job.ghost)
    try:
        ready = _compiled.setting(job.compiled), _pool.threads(job.threads)
        with warnings.catch_warnings(record=True) as caught, ready[0], ready[1]:
            warnings.simplefilter("always", UserWarning)
            if job.contour is not None:
                mesh = isosurface(mesh, job)
            share = job.options.get("occlusion")
            if share is not None and mesh.n_points and share not in mesh.point_data:
                expected, remedy = "a point array that every piece has", "take the whole's sky"
                raise ValueError(_check.message("occlusion", expected, repr(share), remedy))
            lit, sharp = _lit(mesh, piece, job, told)
        del mesh
        done = _described(lit, job)
        done.sharp = sharp
        said = [str(one.message) for one in caught if issubclass(one.category, UserWarning)]
        # Points that could not be lit are counted without ghost cells, creases over all pieces.
        known = ("could not be lit", *(["edges are sharper"] if sharp is not None else []))
        done.notes = [text for text in said if not any(part in text for part in known)]
        if lit.n_points:
            suffix = SUFFIX[type(lit).__name__]
            if suffix != job.suffix:
                expected = f"a name that ends in {INDEX[suffix]} for {type(lit).__name__}"
                raise ValueError(_check.message("out", expected, f"*{INDEX[job.suffix]}"))
            path = files.write_mesh(lit, target.with_suffix(suffix))
            done.file = path.name
    except (OSError, ValueError, TypeError) as error:
        raise PieceError(f"piece {piece.name}: {error}") from error
    return done


def _lit(
    mesh: pv.DataSet, piece: Piece, job: Job, told: Told | None
) -> tuple[Foreign, float | None]:
    """Return the own part of a piece, lit, and its share of sharp edges where that is known."""
    if not mesh.n_points:
        return mesh, None
    lit: Foreign
    if job.filter == "illuminate":
        if told is not None and isinstance(mesh, pv.UnstructuredGrid) and hull.dimension(mesh) == 3:
            told = told._replace(side=sides.side_of(_others(mesh)))
        lit = light_mesh(mesh, job.scene, LightOptions.of(job.options), told=told)
    else:
        lit = streamlines(mesh, job.scene, **job.options)
    record, made = records.read(lit, job.name), records.made(lit, job.name)
    kept = records.read(lit, normals.KEPT)
    sharp = None if kept is None else records.share(kept, "sharp")
    for stale in records.made(lit, normals.KEPT):
        # They belong to the piece with its ghost cells, and would be checked in vain.
        del lit.point_data[stale]
        del lit.field_data[record_key(stale)]
    if not isinstance(lit, pv.PolyData) and hull.dimension(lit) == 3:
        inside = np.ones(lit.n_points, dtype=np.bool_)
        on_surface = hull.outer_surface(lit)[1]
        inside[on_surface[on_surface >= 0]] = False
        lit.point_data[INSIDE] = inside
    own = piece.own(lit) if job.filter == "illuminate" else lit
    valid = f"{job.name}_valid"
    if valid not in own.point_data:
        own.point_data[valid] = np.ones(own.n_points, dtype=np.bool_)
    if own.n_points:
        own.set_active_scalars(job.name)
        assert record is not None
        records.write(own, job.name, record, dict.fromkeys((*made, valid)))
    return own, sharp


def isosurface(mesh: pv.DataSet, job: Job) -> pv.PolyData:
    """Return the isosurface of a piece, with the gradient of its array if normals are that."""
    if not mesh.n_points:
        return pv.PolyData()
    name = str(job.contour)
    if name not in mesh.point_data or mesh.point_data[name].ndim != 1:
        known = [key for key in mesh.point_data if mesh.point_data[key].ndim == 1]
        expected = f"a point array of one component, {_check.one_of(known)}"
        raise ValueError(_check.message("contour", expected, repr(name)))
    assert job.level is not None
    values = mesh.point_data[name]
    if not np.nanmin(values) <= job.level <= np.nanmax(values):  # the gradient takes far longer
        return pv.PolyData()
    if job.options.get("normals") == GRADIENT and GRADIENT not in mesh.point_data:
        mesh = mesh.compute_derivative(scalars=name, gradient=GRADIENT)
    found: pv.PolyData = mesh.contour([job.level], scalars=name)
    return found


def _described(lit: Foreign, job: Job) -> Done:
    """Return what is in a lit piece."""
    inside = np.asarray(lit.point_data.pop(INSIDE, np.zeros(lit.n_points, dtype=np.bool_)))
    done = Done(points=lit.n_points, cells=lit.n_cells)
    if not lit.n_points:
        return done
    done.bounds = [float(x) for x in lit.bounds]
    for kind, data, attributes in (
        ("point", lit.point_data, lit.GetPointData()),
        ("cell", lit.cell_data, lit.GetCellData()),
    ):
        for name, array in data.items():
            own = attributes.GetAbstractArray(name)
            own_type, components = own.GetDataTypeAsString(), own.GetNumberOfComponents()
            done.arrays[f"{kind} {name}"] = [own_type, components]
            if kind == "point" and array.dtype.kind in "fiub" and array.size:
                finite = np.asarray(array, dtype=np.float64)
                finite = finite[np.isfinite(finite)]
                if finite.size:
                    done.ranges[name] = [float(finite.min()), float(finite.max())]
    valid = np.asarray(lit.point_data[f"{job.name}_valid"], dtype=np.bool_)
    done.invalid = int(np.count_nonzero(~valid & ~inside))
    if hasattr(lit, "GetExtent"):
        done.extent = [int(x) for x in lit.GetExtent()]
    if isinstance(lit, pv.ImageData):
        done.grid = {"Origin": list(lit.origin), "Spacing": list(lit.spacing)}
    if isinstance(lit, pv.PolyData | pv.UnstructuredGrid | pv.StructuredGrid):
        done.arrays["points "] = [lit.GetPoints().GetData().GetDataTypeAsString(), 3]
    return done
