"""Streamlines, free or confined to a surface, lit and conditioned."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters.illuminate import light_mesh
from vizlight.geometry.lines import fur
from vizlight.mesh import blocks, point_arrays, polylines, records, surfaces
from vizlight.mesh.normals import onlooker
from vizlight.mesh.records import all_made
from vizlight.model import kernels
from vizlight.scene import Scene
from vizlight.shading.options import LightKeywords, LightOptions, accepts

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from vizlight._types import Array

#: Name of the array that is traced; no array of a user has it.
TRACED = "vizlight vectors"


class StreamlineKeywords(LightKeywords, total=False):
    """The fields of :class:`StreamlineOptions` as keyword arguments."""

    vectors: str | None
    surface: pv.PolyData | None
    confined: bool | None
    seeds: int | ArrayLike | pv.DataSet
    seed: int
    step: float
    max_length: float | None
    max_steps: int


@dataclass(frozen=True, kw_only=True)
class StreamlineOptions(LightOptions):
    """How streamlines are traced and lit.

    Parameters
    ----------
    vectors : str, optional
        Name of a point array of 3 components. Default: the active vectors.
    surface : pyvista.PolyData, optional
        Surface whose normals condition the light of the lines near it (Banks 6), and on which
        confined lines stay. Default for a mesh that is a surface: the mesh itself.
    confined : bool, optional
        Whether the lines stay on the surface: the tangential part of the vectors is integrated.
        Default: whether the mesh itself is a surface and no other is given.
    seeds : int or array_like, shape (M, 3), or mesh, default: 200
        Points at which lines start. A number stands for points of the mesh, drawn without
        repetition, or, for confined lines, for places on the surface, uniform in area.
    seed : int, default: 0
        Seed of the random numbers.
    step : float, default: 0.3
        Largest step of the integration, in cell lengths.
    max_length : float, optional
        Largest length of a line, in the unit of the mesh. Default: four diagonals of the bounding
        box.
    max_steps : int, default: 4000
        Largest number of steps of a line.
    conditioned : bool or str, optional
        Whether the lines inherit the self-shadow of the surface, see
        :func:`vizlight.illuminate`. Default: whether there is a surface.
    """

    vectors: str | None = None
    surface: pv.PolyData | None = None
    confined: bool | None = None
    seeds: int | ArrayLike | pv.DataSet = 200
    seed: int = 0
    step: float = 0.3
    max_length: float | None = None
    max_steps: int = 4000
    conditioned: bool | str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.set_fields(
            self,
            step=_check.number("step", self.step, low=1e-6),
            max_steps=int(_check.number("max_steps", self.max_steps, low=1, high=1e9)),
        )


@accepts(StreamlineOptions)
def streamlines(
    mesh: pv.DataSet,
    /,
    scene: Scene,
    *,
    threads: int | None = None,
    progress_bar: bool = False,
    **options: Unpack[StreamlineKeywords],
) -> pv.PolyData:
    """Integrate streamlines by VTK's tracer, light them, condition them by a surface.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh that carries the vectors; not changed.
    scene : Scene
    **options
        Fields of StreamlineOptions.
    threads, progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.PolyData
        The lines that left their seed, with the point array ``luminance`` and the arrays of the
        tracer; with a surface ``Normals``; for confined lines the field array ``drift``, the
        largest distance from the surface before they were put back on it.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or no line could be traced.

    Notes
    -----
    Confined lines are moved to the closest point of the surface after tracing, so that they lie
    on its triangles to rounding: 1e-6 of the surface's size. VTK traces in float32; a mesh far
    from the origin is therefore traced near it, and its lines are returned in float64. Lines end
    where vectors are less than a millionth of the median, zero or not finite, and where a line
    turns back by more than a right angle from one step to the next, as it does at a wall.
    Sources: Banks 4.1 and (6).

    Examples
    --------
    >>> import vizlight
    >>> flow = vizlight.load_example()
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(1, 1, 1)))
    >>> lines = vizlight.streamlines(flow, scene, vectors="V", seeds=20)
    >>> "luminance" in lines.point_data
    True
    """
    return light_lines(
        mesh, scene, StreamlineOptions(**options), threads=threads, progress_bar=progress_bar
    )


def light_lines(
    mesh: pv.DataSet,
    scene: Scene,
    options: StreamlineOptions,
    *,
    threads: int | None,
    progress_bar: bool,
) -> pv.PolyData:
    """Trace and light lines by options that are checked; see :func:`streamlines`."""
    _check_mesh(mesh)
    _check.instance("scene", scene, Scene)
    made = _resolved(mesh, options)
    lines = _traced(mesh, scene, made)
    conditioned = made.surface is not None if made.conditioned is None else made.conditioned
    normals = "Normals" if conditioned is True and made.normals is None else made.normals
    light = dataclasses.replace(made, conditioned=conditioned, normals=normals)
    lit = light_mesh(lines, scene, light, threads=threads, inplace=True, progress_bar=progress_bar)
    recorded = dataclasses.replace(options, vectors=made.vectors)
    records.amend(lit, options.name, "streamlines", recorded)
    return lit


def _check_mesh(mesh: object) -> None:
    """Refuse what lines cannot be traced in."""
    if not isinstance(mesh, pv.DataSet):
        remedy = "join its blocks by mesh.combine()" if isinstance(mesh, pv.MultiBlock) else ""
        raise TypeError(_check.message("mesh", "a PyVista dataset", type(mesh).__name__, remedy))
    if isinstance(mesh, pv.PointSet):
        remedy = "interpolate its vectors onto a grid, between points there are none"
        raise TypeError(_check.message("mesh", "a dataset with cells", "PointSet", remedy))


def _resolved(mesh: pv.DataSet, options: StreamlineOptions) -> StreamlineOptions:
    """Return the options with vectors, surface and whether lines are confined put in."""
    vectors = _vectors_name(mesh, options.vectors)
    surface, confined = options.surface, options.confined
    is_surface = isinstance(mesh, pv.PolyData) and bool(
        mesh.GetNumberOfPolys() or mesh.GetNumberOfStrips()
    )
    if confined is None:
        confined = is_surface and surface is None
    if surface is None and isinstance(mesh, pv.PolyData) and is_surface:
        surface = mesh
    if surface is None and (confined or options.conditioned):
        what = "confined" if confined else "conditioned"
        raise ValueError(_check.message("surface", f"a surface for {what} lines", None))
    return dataclasses.replace(options, vectors=vectors, surface=surface, confined=confined)


def _traced(mesh: pv.DataSet, scene: Scene, options: StreamlineOptions) -> pv.PolyData:
    """Return the lines, put back on the surface that they are confined to."""
    vectors, confined = options.vectors or "", bool(options.confined)
    surface, traced, own = None, mesh, all_made(mesh)
    if options.surface is not None:
        own |= all_made(options.surface)
        surface = surfaces.with_normals(options.surface, onlooker(scene))
        if confined:
            surface = traced = _tangential(surface, mesh, vectors)
    # VTK traces in float32 to an absolute error: near the origin, in a box of size 1.
    origin, size = np.array(blocks.near_origin(traced)), blocks.box(traced)[1]
    traced = blocks.moved(_traceable(traced, vectors, own), -origin, 1 / size)
    seeds = _seeds(traced, options.seeds, options.seed, origin, size, on_surface=confined)
    lines = traced.streamlines_from_source(
        pv.PolyData(seeds),
        vectors=TRACED,
        surface_streamlines=confined,
        integration_direction="both",
        initial_step_length=options.step,
        max_step_length=options.step,
        min_step_length=min(0.01, options.step),
        max_steps=options.max_steps,
        max_length=_max_length(traced, options.max_length, size),
        terminal_speed=1e-6,
        compute_vorticity=False,
    )
    lines = polylines.before_turning_back(lines)
    for key in (surfaces.NORMALS, TRACED):
        if key in lines.point_data:
            del lines.point_data[key]
    if not lines.n_points:
        expected = "points inside the mesh where the vectors are not zero"
        raise ValueError(_check.message("seeds", expected, "no line"))
    places: Array = np.asarray(lines.points, dtype=np.float64)
    if surface is not None:
        nearest, normals = surfaces.closest(blocks.moved(surface, -origin, 1 / size), places)
        if confined:
            drift = size * np.linalg.norm(nearest - places, axis=1).max()
            lines.field_data["drift"] = [drift]
            places = nearest
        lines.point_data["Normals"] = normals.astype(np.float32)
    far = np.any(origin) or not 1e-30 < size < 1e30
    lines.points = (size * places + origin).astype(np.float64 if far else np.float32)
    return lines


def _vectors_name(mesh: pv.DataSet, vectors: str | None) -> str:
    point_arrays.refuse_unnamed("vectors", vectors)
    if vectors is None:
        vectors = mesh.point_data.active_vectors_name
        if vectors is None:
            raise _no_vectors(mesh, None)
    if vectors not in mesh.point_data and vectors not in mesh.cell_data:
        raise _no_vectors(mesh, vectors)
    point_arrays.vectors_of(mesh, "vectors", vectors, 3)
    return vectors


def _no_vectors(mesh: pv.DataSet, got: str | None) -> ValueError:
    """Return an error that names the arrays which could be traced."""
    point, cell = (
        [repr(key) for key in data if np.shape(data[key])[1:] == (3,)]
        for data in (mesh.point_data, mesh.cell_data)
    )
    remedy = ""
    if point:
        remedy = " or ".join(f"vectors={key}" for key in point)
        remedy = f"pass {remedy}"
    elif cell:
        remedy = (
            f"the cells have {', '.join(cell)}: call mesh.cell_data_to_point_data() and pass "
            f"vectors={cell[0]}"
        )
    there = ", ".join(point) or "none"
    expected = f"the name of a point array of 3 components ({there})"
    return ValueError(
        _check.message("vectors", expected, None if got is None else repr(got), remedy)
    )


def _tangential(surface: pv.PolyData, mesh: pv.DataSet, vectors: str) -> pv.PolyData:
    """Return the surface with the tangential part of the vectors, sampled where it lacks them."""
    if vectors in surface.point_data:
        point_arrays.vectors_of(surface, "vectors", vectors, 3)
    else:
        field = pv.PolyData(surface.points).sample(mesh)
        surface.point_data[vectors] = np.asarray(field.point_data[vectors])
    array = np.array(surface.point_data[vectors], dtype=np.float64)
    array[~np.all(np.isfinite(array), axis=1)] = 0
    normal = np.asarray(surface.point_data[surfaces.NORMALS], dtype=np.float64)
    along = array - np.einsum("ij,ij->i", array, normal)[:, np.newaxis] * normal
    surface.point_data[vectors] = along
    return surface


def _traceable(mesh: pv.DataSet, vectors: str, own: set[str]) -> pv.DataSet:
    """Return a mesh that the tracer may change, with the vectors as TRACED.

    Arrays of words, which end the tracer's process, and vizlight's own are left out. The vectors
    are scaled to a median speed of 1: where it is below a millionth a line has come to rest.
    """
    bare = mesh.copy(deep=False)
    for key in list(bare.point_data):
        if key in own or np.asarray(bare.point_data[key]).dtype.kind not in "biuf":
            del bare.point_data[key]
    array = np.array(mesh.point_data[vectors], dtype=np.float64)
    array[~np.all(np.isfinite(array), axis=1)] = 0
    speed = kernels.length(np.ascontiguousarray(array.T))
    moving = speed[(speed > 0) & np.isfinite(speed)]
    scale = float(np.median(moving)) if len(moving) else 1.0
    bare.point_data[TRACED] = np.clip(array / scale, -1e30, 1e30)
    return bare


def _seeds(
    mesh: pv.DataSet, seeds: object, seed: int, origin: Array, size: float, *, on_surface: bool
) -> Array:
    """Return where lines start in a mesh that was moved to the origin and scaled to size 1."""
    if isinstance(seeds, pv.DataSet):
        given: Array = np.asarray(seeds.points, dtype=np.float64)
    else:
        given = _check.floats("seeds", seeds).astype(np.float64)
    if given.ndim:
        places = (_check.vectors("seeds", given, n=3) - origin) / size
        if places.ndim != 2 or not np.all(np.isfinite(places)):
            what = "finite points of shape (M, 3)"
            raise ValueError(_check.message("seeds", what, _check.describe(seeds)))
        return places
    count, seed = _check.integer("seeds", seeds, low=1), _check.integer("seed", seed, low=0)
    points = np.asarray(mesh.points, dtype=np.float64)
    if not on_surface:
        count = min(count, mesh.n_points)
        chosen = np.random.default_rng(seed).choice(mesh.n_points, count, replace=False)
        return points[np.sort(chosen)]
    faces = np.asarray(mesh.regular_faces)
    face, weights = fur.seeds(points, faces, count, seed=seed)
    b, c = weights[:, 1:, np.newaxis].astype(np.float64).transpose(1, 0, 2)
    corner = points[faces[face]]
    places = (1 - b - c) * corner[:, 0] + b * corner[:, 1] + c * corner[:, 2]
    return np.asarray(places)


def _max_length(mesh: pv.DataSet, max_length: float | None, size: float) -> float:
    if max_length is None:
        return 4 * float(mesh.length)
    return _check.number("max_length", max_length, low=np.finfo(float).tiny) / size
