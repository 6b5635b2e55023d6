"""The task of one piece: read it, light it, cut off the ghost cells, write it whole."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

import numpy as np
import pyvista as pv

from vizlight import _check, _pool, files
from vizlight._types import Array, Foreign, Given
from vizlight.draw import cameras
from vizlight.filters.illuminate import illuminate, light_mesh
from vizlight.filters.streamlines import streamlines
from vizlight.mesh import blocks, normals, records
from vizlight.pieces.ghosts import GHOST
from vizlight.pieces.sources import INDEX, SUFFIX, Piece, PieceError
from vizlight.scene import Scene
from vizlight.shading import engine
from vizlight.shading.options import LightOptions
from vizlight.shading.results import record_key
from vizlight.vtk import hull, sides
from vizlight.vtk.arrays import means
from vizlight.vtk.normals import Sided, Vote
from vizlight.vtk.parts import uses_normals
from vizlight.vtk.polylines import has_lines_only

T = TypeVar("T")

#: Filters that light a piece without knowing the others.
FILTERS = {"illuminate": illuminate, "streamlines": streamlines}
#: Name of the gradient of the contoured array, which gives normals that no cut changes.
GRADIENT = "gradient"
#: Name, for a while, of a mask of the points inside a volume, which have no normals.
INSIDE = "vizlight_inside"


@dataclass(frozen=True, kw_only=True)
class Job:
    """Options of the task, the same for all pieces."""

    contour: str | None
    level: float | None
    scene: Scene = field(default_factory=Scene)
    filter: str = "illuminate"
    options: Mapping[str, Given] = field(default_factory=dict)
    ghost: int = 0
    suffix: str = ""
    threads: int = 1

    def __post_init__(self) -> None:
        if self.contour is not None:
            _check.text("contour", self.contour, expected="the name of a point array")
        elif self.level is not None:
            raise _check.value_error("level", "contour= beside it", self.level)
        _check.fields(self, _check.number, "level", optional=True)

    @property
    def name(self) -> str:
        """Name of the array of the light."""
        return str(self.options.get("name", "luminance"))


@dataclass
class PieceSummary:
    """Summary of a piece, as it is read or as it was lit.

    ``arrays`` has the type and number of components of each array, by "point NAME" and "cell NAME",
    of the points, and of the mesh; ``ranges`` the smallest and largest finite value of point
    arrays. ``normals`` is the name of the active ones; with ``lines`` it has lines and no faces.
    ``extent`` and ``grid`` are the first and last node of a structured grid, and the place of an
    image. ``file`` is the one that was written, if any point remains; ``invalid`` is the number of
    points that could not be lit, ``sharp`` the share of sharp edges, where that is known, and
    ``notes`` are texts of warnings.
    """

    points: int = 0
    cells: int = 0
    bounds: tuple[float, ...] = ()
    arrays: dict[str, str] = field(default_factory=dict)
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    normals: str = ""
    lines: bool = False
    extent: tuple[int, ...] = ()
    grid: dict[str, list[float]] = field(default_factory=dict)
    file: str = ""
    invalid: int = 0
    sharp: float | None = None
    notes: list[str] = field(default_factory=list)


def survey(piece: Piece, contour: str | None) -> PieceSummary:
    """Return the summary of a piece, with the range of one array."""
    return _described(_read(piece, 0), [contour])


def _described(mesh: Foreign, ranged: list[str | None] | None = None) -> PieceSummary:
    """Return the summary of a mesh, with the ranges of some point arrays, or of all."""
    summary = PieceSummary(points=mesh.n_points, cells=mesh.n_cells)
    if not mesh.n_points:
        return summary
    summary.bounds, summary.lines = tuple(map(float, mesh.bounds)), has_lines_only(mesh)
    summary.normals = mesh.point_data.active_normals_name or ""
    summary.arrays["type "] = type(mesh).__name__
    for kind, data in (("point", mesh.point_data), ("cell", mesh.cell_data)):
        for name, array in data.items():
            if name != GHOST:
                components = "" if array.ndim == 1 else f" x {array.shape[1]}"
                own_type = "text" if array.dtype.kind == "U" else array.dtype
                summary.arrays[f"{kind} {name}"] = f"{own_type}{components}"
    if isinstance(mesh, pv.PolyData | pv.UnstructuredGrid | pv.StructuredGrid):
        summary.arrays["points "] = f"{np.asarray(mesh.points).dtype} x 3"
    for name in mesh.point_data if ranged is None else set(mesh.point_data) & set(ranged):
        array = mesh.point_data[name]
        if array.dtype.kind in "fiub":
            values = np.asarray(array, dtype=np.float64)
            values = values[np.isfinite(values)]
            if values.size:
                summary.ranges[name] = (float(values.min()), float(values.max()))
    if hasattr(mesh, "GetExtent"):
        summary.extent = tuple(map(int, mesh.GetExtent()))
    if isinstance(mesh, pv.ImageData):
        summary.grid = {"Origin": list(mesh.origin), "Spacing": list(mesh.spacing)}
    return summary


def outermost(piece: Piece, job: Job, *view: Foreign) -> Array:
    """Return the points of a piece, or of its isosurface, on which a camera depends."""
    direction, up, aspect = view
    return cameras.outermost(_target(piece, job, 0), direction, up=up, aspect=aspect)


def depths(piece: Piece, job: Job) -> tuple[float, float]:
    """Return the least and the largest depth of the points of a piece that are lit."""
    return engine.depth_range(np.asarray(_target(piece, job, 0).points), job.scene)


def _read(piece: Piece, ghost: int) -> pv.DataSet:
    """Return the mesh of a piece, which may have no points."""
    return _tried(piece, lambda: piece.read(ghost)) or pv.PolyData()


def _target(piece: Piece, job: Job, ghost: int) -> pv.DataSet:
    """Return the lit part of a piece: its mesh, or an isosurface of that."""
    mesh = _read(piece, ghost)
    if job.contour is None or not mesh.n_points:
        return mesh
    return _tried(piece, lambda: _isosurface(mesh, job)) or pv.PolyData()


def _tried(piece: Piece, reader: Callable[[], T]) -> T | None:
    """Return the result of a reader, None where a piece has no points."""
    try:
        return reader()
    except (OSError, ValueError, TypeError, KeyError) as error:
        if isinstance(error, files.FileError) and "(no points)" in str(error):
            return None  # parallel writers make such files
        raise PieceError(f"piece {piece.name}: {error}") from error


def look(piece: Piece, job: Job, target: Path) -> sides.PartFacts | None:
    """Return the facts of a piece about the sides of the whole, None where its light has none.

    Normals of a surface are kept beside the target, and the piece is lit by these.
    """
    mesh = _target(piece, job, job.ghost)
    options = LightOptions.of(job.options)
    if not mesh.n_points or not uses_normals(mesh, options):
        return None
    if hasattr(mesh, "GetExtent") and 1 not in mesh.dimensions:
        return None  # a grid that fills space is closed, and so is each slab of it
    keep = None
    if _are_whole_sides(mesh, job, options):

        def keep(normals: sides.Undecided) -> None:
            np.savez(_kept_beside(target), **normals._asdict())

    return _tried(
        piece, lambda: sides.look(mesh, _others(mesh), options.normals, job.scene.view, keep)
    )


def _are_whole_sides(mesh: pv.DataSet, job: Job, options: LightOptions) -> bool:
    """Return whether the light of a piece needs nothing of others but the sides of its normals."""
    asked = options.normals, options.feature_angle, options.positions, options.tangents
    return (
        isinstance(mesh, pv.PolyData)
        and mesh.n_cells == mesh.GetNumberOfPolys()
        and mesh.point_data.active_normals is None
        and job.contour is None
        and options.facing == "auto"
        and all(option is None for option in asked)
    )


def _kept_beside(target: Path) -> Path:
    """Return the path of the normals that are kept of a piece."""
    return target.with_name(target.name + ".npz")


def _kept(piece: Piece, target: Path, whole_sides: Vote | None) -> tuple[pv.DataSet, Sided] | None:
    """Return a piece without cells of others, and the normals that were kept of it, if any were."""
    path = _kept_beside(target)
    if whole_sides is None or not path.exists():
        return None
    mesh = _read(piece, 0)
    with np.load(path) as arrays:
        found = sides.Undecided(**arrays).decided(whole_sides)
    # Those of other pieces come last.
    found = found.at(np.arange(mesh.n_points))
    # Points that no cell has would be cut off with the cells of other pieces.
    return (mesh, found) if found.vectors.any(axis=1).all() else None


def _others(mesh: pv.DataSet) -> Array:
    """Return the share of the cells around each point that belong to other pieces."""
    return means(mesh, np.asarray(mesh.cell_data[GHOST], dtype=np.float32))


def light(piece: Piece, job: Job, target: Path, whole_sides: Vote | None = None) -> PieceSummary:
    """Light a piece, with sides that the whole may have decided, and write it to a path.

    The path has no suffix.
    """
    kept = _kept(piece, target, whole_sides)
    mesh, known = kept or (_target(piece, job, job.ghost), None)
    try:
        with warnings.catch_warnings(record=True) as caught, _pool.threads(job.threads):
            warnings.simplefilter("always", UserWarning)
            # A piece alone does not know which parts of the sky other pieces hide.
            share = job.options.get("occlusion")
            if share is not None and mesh.n_points and share not in mesh.point_data:
                expected, remedy = "a point array that every piece has", "take the whole's sky"
                raise _check.value_error("occlusion", expected, repr(share), remedy)
            lit, sharp = _lit(mesh, piece, job, whole_sides, known)
        del mesh
        inside = np.asarray(lit.point_data.pop(INSIDE, np.zeros(lit.n_points, dtype=np.bool_)))
        done = _described(lit)
        done.sharp = sharp
        said = [str(entry.message) for entry in caught if issubclass(entry.category, UserWarning)]
        # Points that could not be lit are counted without ghost cells, creases over all pieces.
        counted = ("could not be lit", *(["edges are sharper"] if sharp is not None else []))
        done.notes = [text for text in said if not any(part in text for part in counted)]
        if lit.n_points:
            valid = np.asarray(lit.point_data[f"{job.name}_valid"], dtype=np.bool_)
            done.invalid = int(np.count_nonzero(~valid & ~inside))
            suffix = SUFFIX[type(lit).__name__]
            # An index has pieces of one type of mesh, which its suffix names.
            if suffix != job.suffix:
                expected = f"a name that ends in {INDEX[suffix]} for {type(lit).__name__}"
                raise _check.value_error("out", expected, f"*{INDEX[job.suffix]}")
            done.file = files.write_mesh(lit, target.with_name(target.name + suffix)).name
    except (OSError, ValueError, TypeError) as error:
        raise PieceError(f"piece {piece.name}: {error}") from error
    return done


def _lit(
    mesh: pv.DataSet, piece: Piece, job: Job, turn: Vote | None, known: Sided | None
) -> tuple[Foreign, float | None]:
    """Return the lit part that a piece owns, and its share of sharp edges where that is known."""
    if not mesh.n_points:
        return mesh, None
    lit: Foreign
    if job.filter == "illuminate":
        if turn is not None and isinstance(mesh, pv.UnstructuredGrid) and hull.dimension(mesh) == 3:
            turn = turn._replace(side=sides.side_of(_others(mesh)))
        options = LightOptions.of(job.options)
        turn = turn if known is None else None
        lit = light_mesh(mesh, job.scene, options, inplace=True, vote=turn, known=known)
    else:
        lit = streamlines(mesh, job.scene, **job.options)
    record, names = records.read(lit, job.name), records.made(lit, job.name)
    kept = records.read(lit, normals.KEPT)
    sharp = None if kept is None else records.share(kept, "sharp")
    sharp = sharp if known is None else float(known.sharp)
    for stale in records.made(lit, normals.KEPT):
        # They belong to the piece with its ghost cells, and would be checked in vain.
        del lit.point_data[stale]
        del lit.field_data[record_key(stale)]
    # Found while the ghost cells are there: where they are cut off no surface of the whole begins.
    if not isinstance(lit, pv.PolyData) and hull.dimension(lit) == 3:
        inside = np.ones(lit.n_points, dtype=np.bool_)
        inside[hull.outer_surface(lit)[1]] = False
        lit.point_data[INSIDE] = inside
    part = piece.owned_part(lit) if job.filter == "illuminate" else lit
    valid = f"{job.name}_valid"
    # All pieces of an index have the same arrays, so that each has the mask.
    if valid not in part.point_data:
        part.point_data[valid] = np.ones(part.n_points, dtype=np.bool_)
    if part.n_points:
        part.set_active_scalars(job.name)
        assert record is not None
        # The arrays are recorded without digests, which would not hold where pieces are joined.
        records.write(part, job.name, record, dict.fromkeys((*names, valid)))
    return part, sharp


def _isosurface(mesh: pv.DataSet, job: Job) -> pv.PolyData:
    """Return the isosurface of a piece, with the gradient of its array if normals are that."""
    name = str(job.contour)
    values = records.scalars_of(mesh, "contour", name)
    assert job.level is not None
    if not np.nanmin(values) <= job.level <= np.nanmax(values):  # the gradient takes far longer
        return pv.PolyData()
    if job.options.get("normals") == GRADIENT and GRADIENT not in mesh.point_data:
        mesh = mesh.compute_derivative(scalars=name, gradient=GRADIENT)
    return blocks.isosurface(mesh, name, job.level)
