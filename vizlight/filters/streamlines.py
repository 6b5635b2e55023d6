"""Streamlines, free or confined to a surface, lit and conditioned."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check, _progress
from vizlight._questions import QUESTIONS
from vizlight._types import Array, Exponent, Facing, FeatureAngle, Indices, Model, Precision
from vizlight.filters.illuminate import light_mesh
from vizlight.geometry.lines.even import evenness
from vizlight.geometry.lines.tracing import Tracing
from vizlight.mesh import blocks, georeference, meaning, records, strokes, tracers
from vizlight.mesh.normals import NORMALS, closest_normals, onlooker, with_normals
from vizlight.mesh.records import all_made
from vizlight.mesh.tracers import TRACED, Vectors
from vizlight.model import kernels, line_fields
from vizlight.scene import Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene, preset_of
from vizlight.shading.options import Bundle, LightOptions
from vizlight.vtk import polylines
from vizlight.vtk.arrays import array_of, vectors_of
from vizlight.vtk.cells import check_whole, has_faces

#: Names of the point arrays of the directions that were integrated, and by which the lines are
#: lit, of the lengths along lines, and of the lengths of vectors.
TANGENTS, AGE, SPEED = "Tangents", "age", "speed"
#: Share of the speed of the fastest points below which a point is at rest, for seeds.
RESTING = 0.01
#: Its name where the traced mesh has an array of that name.
OWN_TANGENTS = "vizlight tangents"
#: Largest length of a line in cell lengths.
REACH = 1200


@dataclass(frozen=True, kw_only=True)
class StreamlineOptions(LightOptions):
    """Options of tracing and lighting streamlines.

    The fields are keywords of :func:`vizlight.streamlines`.
    """

    DECIDED: ClassVar = frozenset({"positions", "normals"})

    tangents: str | tuple[str, str] | None = None
    surface: pv.PolyData | None = None
    confined: bool | None = None
    seeds: int | ArrayLike | pv.DataSet = 200
    seed: int = 0
    spacing: float | None = None
    step: float = 0.3
    min_length: float | None = None
    max_length: float | None = None
    stroke_length: float | None = None
    travel: float | None = None
    conditioned: bool | str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.fields(self, _check.number, "step", low=1e-6, high=1e3)
        _check.fields(self, _check.boolean, "confined", optional=True)
        _check.instance("surface", self.surface, pv.DataSet | None, "a PyVista surface")
        tangents: object = self.tangents
        if isinstance(tangents, list | tuple):
            names = _names_of(tangents, pair=self.line_field)
            # The two of a cross field have no sign; of others these are the components.
            _check.set_fields(self, tangents=names if self.line_field else ",".join(names))
        else:
            records.refuse_unnamed("tangents", tangents)
        _check.fields(self, _check.integer, "seed", low=0)
        for length in ("spacing", "min_length", "stroke_length", "travel"):
            _check.fields(self, _check.positive, length, optional=True)
        if self.travel is not None and self.stroke_length is None:
            remedy = "pass the distance between strokes as stroke_length="
            raise _check.value_error("travel", "stroke_length beside it", "none", remedy)


def _names_of(names: Sequence[object], *, pair: bool) -> tuple[str, ...]:
    """Return the names of the arrays of a cross field, or of the components of vectors."""
    if len(names) not in ((2,) if pair else (2, 3)):
        expected = "one name of a point array, the names of components, or the two of a cross field"
        raise _check.value_error("tangents", expected, f"{len(names)} names")
    checked = tuple(
        _check.text("tangents", name, expected="the names of two point arrays") for name in names
    )
    if len({*checked}) != len(checked):
        remedy = "for a single line field pass its name alone"
        raise _check.value_error("tangents", "different arrays", repr(checked[0]), remedy)
    return checked


@named
def streamlines(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    scene: AnyScene | None = None,
    *,
    tangents: str | tuple[str, str] | None = None,
    line_field: bool = False,
    surface: pv.PolyData | None = None,
    confined: bool | None = None,
    seeds: int | ArrayLike | pv.DataSet = 200,
    seed: int = 0,
    spacing: float | None = None,
    step: float = 0.3,
    min_length: float | None = None,
    max_length: float | None = None,
    stroke_length: float | None = None,
    travel: float | None = None,
    conditioned: bool | str | None = None,
    facing: Facing = "auto",
    feature_angle: FeatureAngle = None,
    bundle: bool | Bundle = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    progress_bar: bool = False,
) -> pv.PolyData:
    """Integrate streamlines, light them by the field, condition them by a surface.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that carries the vectors; not changed. Of a MultiBlock, such as an OpenFOAM case, the
        cells of the highest dimension are taken, without patches.
    scene : Scene or str, optional
        Lights, material and view, by default ``Scene()``.
    tangents : str or tuple of str, optional
        Name of an array of 3, 6 or 9 components, or two names; one of cells is averaged to the
        points. Names of two or three arrays of one component, as a tuple or as ``"u,v"``, are
        those of components. 6 components are a symmetric tensor (XX, YY, ZZ, XY, YZ, XZ, as in
        VTK) and 9 a matrix; the first eigenvector is traced as a line field. Two names, of arrays
        of 3 components and with ``line_field=True``, are a cross field, such as both principal
        directions: lines of either direction are traced. Default: the active vectors, the only
        point array of 3 components, or the only components, by their standard or usual names. On
        a map in degrees vectors are in metres of the place, east and north.
    line_field : bool, default: False
        Whether the vectors are directions without sign, such as principal directions. Each vector
        is then aligned with the one before it on the line. Tensors are always line fields. Of a
        cross field each of the two is continued by whichever of the next two is nearest to it:
        signs, order and lengths do not matter.
    surface : pyvista.PolyData, optional
        Surface with the normals that condition the light of the lines near it (Banks 6), and on
        which confined lines stay. Default for a mesh that is a surface: the mesh itself.
    confined : bool, optional
        Whether the lines stay on the surface: the tangential part of the vectors is integrated.
        Default: whether the mesh itself is a surface and no other is given.
    seeds : int or array_like, shape (M, 3), or mesh, default: 200
        Points at which lines start. A number is the number of lines, from points of the mesh drawn
        without repetition, of those that move where most are at rest, or, for confined lines and
        line fields, from random places, uniform in area or volume. At a given point of a cross
        field two lines start. Has no effect as a number with ``spacing``.
    seed : int, default: 0
        Seed of the random numbers.
    spacing : float, optional
        Distance between evenly spaced lines, in the unit of the mesh, at which they cover the whole
        surface or volume; in a cross field once along each of the two directions. Lines of a cross
        field keep their distance where the angle between them is below 45 degrees.
    step : float, default: 0.3
        Largest step of the integration, in cell lengths.
    min_length : float, optional
        Least length of a line, in the unit of the mesh: shorter ones are left out. Lines are cut at
        kinks, where they turn by more than a right angle within a seventh of this length. The field
        array ``left_out`` is the number of lines no part of which is left. Default: none is.
    max_length : float, optional
        Largest length of a line, in the unit of the mesh. Default: four diagonals of the bounding
        box. A line ends after 1,200 cell lengths in any case.
    stroke_length : float, optional
        Length, in the unit of the mesh, of strokes into which the lines are cut, at points of
        theirs. They have the point array ``width``: at their ends along the vectors a head, from 1
        at its base to 0 at its tip, before it a thin shaft, so that a stroke is an arrow; a head
        is shorter in a volume than on a surface. In a line field both ends are thin.
        ``plotter.vizlight.add_mesh(lines, width="width")`` takes this array; its ``line_width`` is
        the width of the heads. Parts of evenly spaced lines that run along the border of a surface,
        within 0.3 spacings of it, are left out. Default: lines are whole.
    travel : float, optional
        Number of stroke lengths by which strokes move along the lines in a movie, where the vectors
        are as long as their 90th percentile; elsewhere by as much as the vectors say. The lines are
        whole then, with the point arrays ``width``, at the start, ``phase``, ``passing`` (strokes
        in a period, a whole number) and ``grown``, by which ``movie.travel`` moves the strokes, and
        the field array ``period``: the time that the movie shows, in the unit of lengths over that
        of the vectors. Strokes are as long as the way that passes. Default: they stand still.
    conditioned : bool or str, optional
        Whether the lines inherit the self-shadow of the surface, see
        :func:`vizlight.illuminate`. Default: whether a surface is present, but not in the light of
        ``presets.direction``, ``slope`` and ``heading``, which tells how the lines themselves run.
    facing, feature_angle, bundle, occlusion, name, exponent, model, components, precision
        As for :func:`vizlight.illuminate`; edges of the surface are split.
    progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.PolyData
        The lines that left their seed, one per seed, with the point array ``luminance``, the point
        arrays of the mesh, and ``Tangents``, the directions that were integrated and are lit; with
        a surface ``Normals``. Vectors of a line field have the sign of ``Tangents``; the two arrays
        of a cross field, which have no order, are left out. The array
        ``Tangents_valid`` marks points at which a tensor has a first eigenvector, where it is
        isotropic at some. ``age`` is the length of the line from its start to the point along the
        vectors, in the unit of the mesh, and ``speed`` the length of the vectors, in their unit,
        where they are vectors of 3 components; where the mesh has arrays of these names, they are
        ``vizlight age`` and ``vizlight speed``. Confined lines have the field array ``drift``, the
        largest distance from the surface; evenly spaced ones ``closed``, the number of closed
        lines, and, where they are no strokes, ``largest_gap``, the largest distance of any place
        from a line as it is drawn, understated by at most 0.01, and ``nearest``, the distance to
        the next line that 5 % of the places on lines fall below, both in spacings.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or no line could be traced.

    Warns
    -----
    UserWarning
        If fewer lines than the number in ``seeds`` could be traced. With the
        count, if tensors other than zero have no first eigenvector.

    Notes
    -----
    Lines in space are traced by VTK (Runge-Kutta 4-5, float32). Confined lines, line fields and
    evenly spaced lines are traced from triangle to triangle, or from tetrahedron to tetrahedron
    after splitting the cells (about 0.3 kB per tetrahedron), by the midpoint rule: the error of a
    line is of order ``step^2``, and a confined line lies on its triangles to rounding. Lines end
    where vectors are less than a millionth of the median, zero or not finite, where a tensor has no
    first eigenvector, at the boundary, and where a line turns by more than a right angle from one
    step to the next, as it does at a wall. Lines of a cross field also end in the cells of
    singularities of index 1/4; around them they go on, each as a line of the other direction.

    Evenly spaced lines start a spacing beside others and end where they come nearer to one than
    half of it; lines that meet their own start are closed. Lines that others cut short are kept if
    they are two spacings long; in gaps wider than 1.15 spacings 0.7 of that is enough, or 0.35 from
    a boundary. The largest gap is at most 1.5 spacings on surfaces and in volumes with waves of
    vectors, saddles and vortices among them. On a surface distances include half a spacing times
    the difference of normals, so that two sides of a thin sheet are apart.
    Sources: Banks 4.1 and (6); Jobard and Lefer, Creating evenly-spaced streamlines of arbitrary
    density (1997).

    Examples
    --------
    >>> import vizlight
    >>> flow = vizlight.load_example()
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(1, 1, 1)))
    >>> lines = vizlight.streamlines(flow, scene, tangents="V", seeds=20)
    >>> "luminance" in lines.point_data
    True
    """
    return light_lines(mesh, scene, StreamlineOptions.of(locals()), progress_bar=progress_bar)


def light_lines(
    mesh: pv.DataSet | pv.MultiBlock,
    scene: AnyScene | None,
    options: StreamlineOptions,
    *,
    progress_bar: bool,
    argument: str = "mesh",
) -> pv.PolyData:
    """Trace and light lines by options that are checked; see :func:`streamlines`.

    Errors name the mesh by ``argument``.
    """
    if isinstance(mesh, pv.MultiBlock):
        mesh = blocks.one_grid(mesh)
    _check_mesh(mesh, argument)
    mesh, vector_names = meaning.with_named(mesh, options.tangents)
    options = dataclasses.replace(options, tangents=vector_names)
    mesh = records.averaged(mesh, *_names(options.tangents))
    scene = as_scene(scene)
    preset = QUESTIONS.get(preset_of(scene) or "")
    if options.conditioned is None and preset is not None and preset.of_tangents:
        # The self-shadow of a surface would hide how lines run.
        options = dataclasses.replace(options, conditioned=False)
    full = _resolved(mesh, options)
    with _progress.progress("trace", 100, show=progress_bar) as report:
        lines, tangents = _traced(mesh, scene, full, report, argument)
    lines = _as_strokes(lines, mesh, tangents, full)
    georeference.place_alike(lines, mesh)
    # Lines beside a surface have its self-shadow unless it is switched off (Banks 6).
    conditioned = full.surface is not None if full.conditioned is None else full.conditioned
    normals = "Normals" if conditioned is True else None
    light = dataclasses.replace(full, tangents=tangents, conditioned=conditioned, normals=normals)
    # The lines are new and nobody else's, and need no copy.
    lit = light_mesh(lines, scene, light, inplace=True, progress_bar=progress_bar)
    # The record names the vectors that were found, since the active ones of a mesh may change.
    recorded = dataclasses.replace(options, tangents=full.tangents)
    records.amend(lit, options.name, "streamlines", recorded)
    return lit


def _as_strokes(
    lines: pv.PolyData, mesh: pv.DataSet, tangents: str, options: StreamlineOptions
) -> pv.PolyData:
    """Return lines with ages and speeds, without short ones, and cut as the options say."""
    if options.min_length is not None:
        lines = strokes.without_short(lines, options.min_length)
        if not lines.n_lines:
            count = lines.field_data["left_out"][0]
            expected = f"a length that one of the {count} lines has"
            raise _check.value_error("min_length", expected, options.min_length)
    speed = _speed(lines, options)
    point_arrays = {AGE: strokes.ages(lines, lines.point_data[tangents])}
    point_arrays |= {} if speed is None else {SPEED: speed}
    for key, values in point_arrays.items():
        lines.point_data[own_name(mesh, key)] = values
    if options.stroke_length is None:
        return lines
    if options.travel is not None:
        lines = strokes.fine(lines, options.stroke_length)
        strokes.set_moving(
            lines,
            options.stroke_length,
            _velocities(lines, mesh, tangents, options),
            options.travel,
        )
        return lines
    arrow = strokes.FLAT if options.confined else strokes.TUBE
    return strokes.cut(
        lines, options.stroke_length, tangents, None if options.line_field else arrow
    )


def _velocities(
    lines: pv.PolyData, mesh: pv.DataSet, tangents: str, options: StreamlineOptions
) -> Array:
    """Return the parts of the vectors along lines, in the coordinates of the mesh."""
    if options.line_field or not isinstance(options.tangents, str):
        expected = "vectors, which have a sense"
        raise _check.value_error("travel", expected, "a line field", "leave travel out")
    vectors: Array = np.asarray(lines.point_data[options.tangents], dtype=np.float64)
    rows = georeference.motion(mesh, lines, np.nan_to_num(vectors), np.ones(3))
    way = np.asarray(lines.point_data[tangents], dtype=np.float64)
    return np.asarray(np.einsum("ij,ij->i", rows, way)[:, np.newaxis] * way)


def _speed(lines: pv.PolyData, options: StreamlineOptions) -> Array | None:
    """Return the lengths of the vectors at the points of lines, None where they have none."""
    if not isinstance(options.tangents, str):
        return None
    rows = np.asarray(lines.point_data[options.tangents], dtype=np.float64)
    return kernels.length_rows(rows) if rows.ndim == 2 and rows.shape[1] == 3 else None


def own_name(mesh: pv.DataSet, name: str) -> str:
    """Return the name of an array of lines, another one where the traced mesh has that name."""
    return name if name not in mesh.point_data else f"vizlight {name}"


def speed_of(lines: pv.DataSet) -> str | None:
    """Return the name of the speeds of lines, beside which those of the traced mesh may stand."""
    names = (f"vizlight {SPEED}", SPEED)
    return next((name for name in names if name in lines.point_data), None)


def _check_mesh(mesh: object, argument: str) -> None:
    """Refuse meshes in which lines cannot be traced."""
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message(argument, "a PyVista dataset", type(mesh).__name__))
    if isinstance(mesh, pv.PointSet):
        remedy = "interpolate its vectors onto a grid, between points there are none"
        raise TypeError(_check.message(argument, "a dataset with cells", "PointSet", remedy))
    check_whole(mesh, argument)
    if mesh.n_points and not mesh.GetMaxSpatialDimension():
        remedy = "interpolate its vectors onto a grid, between points there are none"
        raise _check.value_error(argument, "a mesh with cells", "vertices alone", remedy)


def _resolved(mesh: pv.DataSet, options: StreamlineOptions) -> StreamlineOptions:
    """Return the options with vectors, surface and whether lines are confined put in."""
    vectors, unsigned = _vectors_name(mesh, options.tangents)
    surface, confined = _as_surface(options.surface), options.confined
    mesh_surface = _as_surface(mesh)
    is_surface = isinstance(mesh_surface, pv.PolyData) and has_faces(mesh_surface)
    if confined is None:
        confined = is_surface and surface is None
    if surface is None and is_surface:
        surface = mesh_surface
    if surface is None and (confined or options.conditioned):
        what = "confined" if confined else "conditioned"
        raise _check.value_error("surface", f"a surface for {what} lines", None)
    return dataclasses.replace(
        options,
        tangents=vectors,
        surface=surface,
        confined=confined,
        line_field=options.line_field or unsigned,
    )


def _as_surface(mesh: object) -> pv.PolyData | None:
    """Return a grid of faces as a surface; others as they are."""
    grid = isinstance(mesh, pv.DataSet) and not isinstance(mesh, pv.PolyData)
    if grid and mesh.n_cells and mesh.GetMaxSpatialDimension() == 2:  # type: ignore[attr-defined]
        return blocks.outer_surface(mesh)[0]  # type: ignore[arg-type]
    return mesh  # type: ignore[return-value]


def _traced(
    mesh: pv.DataSet,
    scene: Scene,
    options: StreamlineOptions,
    report: Callable[[int], None],
    argument: str,
) -> tuple[pv.PolyData, str]:
    """Return the lines, and the name of their array of tangents."""
    confined = bool(options.confined)
    # Light of an earlier result is no datum, and is not carried along the lines.
    surface, traced, lit_names = None, mesh, all_made(mesh)
    if options.surface is not None:
        lit_names |= all_made(options.surface)
        surface = with_normals(options.surface, onlooker(scene), options.feature_angle)
    vectors = _field(mesh, surface if confined else None, options)
    # Confined lines are traced in the triangles of the surface, which have the normals.
    if confined and surface is not None:
        traced = surface
    # VTK traces in float32 to an absolute error: near the origin, in a box of size 1.
    origin, scale = np.array(blocks.near_origin(traced)), georeference.scale_to_one(mesh, traced)
    vectors = georeference.motion(mesh, traced, vectors, scale)
    if surface is not None:
        surface = blocks.moved(surface, -origin, scale)
    traced = tracers.scaled(blocks.moved(_bare(traced, lit_names), -origin, scale), vectors)
    lines = _lines(traced, options, origin, scale, report, argument)
    if not lines.n_points:
        expected = "points inside the mesh where the vectors are not zero"
        name = "seeds" if options.max_length is None else "seeds, max_length"
        raise _check.value_error(name, expected, "no line")
    places: Array = np.asarray(lines.points, dtype=np.float64)
    tangents: Array = np.array(lines.point_data[TRACED], dtype=np.float64) * (scale[0] / scale)
    if surface is not None:
        if confined:
            normals = kernels.unit_rows(lines.point_data[NORMALS])
            # Between corners, interpolated directions lean out of the surface.
            tangents -= np.einsum("ij,ij->i", tangents, normals)[:, np.newaxis] * normals
        else:
            # A line in space is conditioned by the nearest place of the surface.
            normals = closest_normals(surface, places)
        lines.point_data["Normals"] = normals.astype(np.float32)
    # These two served the tracer; the lines have normals and tangents under names of their own.
    for key in (NORMALS, TRACED):
        if key in lines.point_data:
            del lines.point_data[key]
    name = TANGENTS if TANGENTS not in mesh.point_data else OWN_TANGENTS
    tangents = kernels.unit_rows(tangents)
    # Light needs a direction also where the speed is 0, as at the end of a line.
    resting = ~np.any(tangents, axis=1)
    if resting.any():
        # Where a line comes to rest it has the direction in which it came.
        tangents[resting] = polylines.line_tangents(lines)[resting]
    lines.point_data[name] = tangents.astype(np.float32)
    if isinstance(options.tangents, str):
        rows = np.asarray(lines.point_data[options.tangents])
        # The mask tells points without a first eigenvector from those whose tangent is a direction
        # of the field.
        if rows.ndim == 2 and rows.shape[1] in (6, 9):
            isotropic = ~np.any(tracers.principal_directions(rows), axis=1)
            if isotropic.any():
                lines.point_data[f"{name}_valid"] = ~isotropic
    # Far from the origin float32 would lose digits, and at extreme sizes its range.
    far = np.any(origin) or not 1e-30 < scale[0] < 1e30
    exact = places / scale + origin
    lines.points = exact.astype(np.float64 if far else np.float32)
    if confined:
        # The exact places lie on their triangles to rounding in float64: the drift measures the
        # type of the points.
        drift = np.abs(np.asarray(lines.points, dtype=np.float64) - exact).max()
        lines.field_data["drift"] = [drift]
    return lines, name


def _lines(
    mesh: pv.DataSet,
    options: StreamlineOptions,
    origin: Array,
    scale: Array,
    report: Callable[[int], None],
    argument: str,
) -> pv.PolyData:
    """Return the lines of TRACED in a mesh that was moved to the origin and scaled to size 1."""
    length, size = options.max_length, 1 / float(scale[0])
    if length is None:
        length = 4 * float(mesh.length)
    else:
        length = _check.number("max_length", length, low=np.finfo(float).tiny) / size
    # No step is longer than ``step`` cell lengths: their number bounds a line to REACH of these.
    how = Tracing(options.step, length, math.ceil(REACH / options.step), options.seed)
    count, places = seeds_of(options.seeds)
    # Seeds are moved and scaled as the mesh was.
    places = None if places is None else (places - origin) * scale
    # Free lines in space are left to VTK; all others go from cell to cell here.
    if not (options.confined or options.line_field or options.spacing is not None):
        return _in_space(mesh, how, count, places, report)
    # In triangles and tetrahedra, unlike in other cells, interpolated vectors are linear.
    cells: pv.PolyData | pv.UnstructuredGrid = (
        mesh if isinstance(mesh, pv.PolyData) and mesh.is_all_triangles else mesh.triangulate()
    )
    normals = NORMALS if options.confined else None
    tracer = tracers.CellTracer(cells, normals, line_field=options.line_field)
    if not tracer.cells.extent > 0:
        expected = "cells of some area or volume between finite points"
        raise _check.value_error(argument, expected, "none")
    unsigned = options.tangents if options.line_field else None
    located = None if places is None else tracer.located(places)
    if options.spacing is None:
        start = tracer.random(count, options.seed) if located is None else located
        # For seeds that are given no others are drawn where a line fails.
        wanted = count if located is None else None
        lines = tracer.lines(tracer.traced(start, how, wanted, report), unsigned)
        _warn_of_fewer(lines, wanted)
        return lines
    # The spacing is scaled like the mesh, whose longest side is 1 here.
    spacing = options.spacing / size
    tracers.check_spacing(tracer, spacing, size)
    curves, closed = tracer.even(located, how, spacing, report)
    lines = tracer.lines(curves, unsigned)
    facts: dict[str, float] = {"closed": closed}
    if options.stroke_length is None:
        # Strokes are parts of the curves, with gaps between them.
        gap, nearest = evenness(tracer.flow, spacing, curves)
        facts |= {"largest_gap": gap, "nearest": nearest}
    elif options.confined:
        lines = strokes.inside(lines, tracer.cells.border, spacing)
    for key, value in facts.items():
        lines.field_data[key] = [value]
    return lines


def _in_space(
    mesh: pv.DataSet,
    how: Tracing,
    count: int,
    places: Array | None,
    report: Callable[[int], None],
) -> pv.PolyData:
    """Return lines that VTK traces; where seeds of its choice fail others are tried."""
    if places is not None:
        return tracers.in_space(mesh, places, how, report)
    points = np.asarray(mesh.points, dtype=np.float64)
    there = _flowing(np.asarray(mesh.point_data[TRACED]))
    count = min(count, len(points))
    random = np.random.default_rng(how.seed)
    chosen = np.sort(random.choice(there, min(count, len(there)), replace=False))
    rest = random.permutation(np.delete(np.arange(len(points)), chosen))
    # A point at rest starts no line.
    moving = np.any(np.asarray(mesh.point_data[TRACED])[rest] != 0, axis=1)
    rest, lines = rest[moving], tracers.in_space(mesh, points[chosen], how, report)
    while (missing := count - lines.n_lines) > 0 and len(rest):
        # Further seeds, because some failed.
        chosen, rest = np.append(chosen, rest[:missing]), rest[missing:]
        more = tracers.in_space(mesh, points[chosen[-min(missing, len(chosen)) :]], how, report)
        lines = lines.append_polydata(more) if lines.n_lines else more
    _warn_of_fewer(lines, count)
    return lines


def _flowing(vectors: Array) -> Indices:
    """Return the points where the flow is: all, or those that move where most are at rest."""
    speed = kernels.length_rows(vectors)
    # The fast points give the scale of the flow: a median would be small where most points hardly
    # move.
    fast = speed > RESTING * np.percentile(speed[speed > 0], 95) if speed.any() else speed > 0
    # Where most points move, any of them may be a seed.
    return np.flatnonzero(fast if 0 < fast.sum() < len(fast) / 2 else fast | True)


def _warn_of_fewer(lines: pv.PolyData, wanted: int | None) -> None:
    if wanted is not None and 0 < lines.n_lines < wanted:
        _check.warn(
            f"{lines.n_lines} of {wanted} lines could be traced: from other points none leaves "
            "its seed, as the vectors are zero there or point out of the mesh"
        )


def vectors_by_default(mesh: pv.DataSet) -> str | None:
    """Return the name of the active vectors of the points, or of the only ones."""
    there = [key for key in mesh.point_data if np.shape(mesh.point_data[key])[1:] == (3,)]
    return mesh.point_data.active_vectors_name or (there[0] if len(there) == 1 else None)


def _vectors_name(mesh: pv.DataSet, vectors: Vectors | None) -> tuple[Vectors, bool]:
    """Return the names of the traced arrays, and whether these are tensors or a cross field."""
    if vectors is None:
        vectors = vectors_by_default(mesh)
        if vectors is None:
            raise _no_vectors(mesh, None)
    pair = isinstance(vectors, tuple)
    for name in _names(vectors):
        if name not in mesh.point_data:
            raise _no_vectors(mesh, name)
        array = array_of(mesh, "tangents", name)
        # Eigenvectors of tensors have no sign, whatever the option says.
        if array.shape[1] in (6, 9) and not pair:
            return name, True
        vectors_of(mesh, "tangents", name, 3)
    return vectors, pair


def _names(vectors: Vectors | None) -> tuple[str, ...]:
    return (vectors,) if isinstance(vectors, str) else vectors or ()


def _no_vectors(mesh: pv.DataSet, got: str | None) -> ValueError:
    """Return an error that names the arrays which could be traced."""
    point = [
        repr(key)
        for data in (mesh.point_data, mesh.cell_data)
        for key in data
        if np.shape(data[key])[1:] == (3,)
    ]
    if not point:
        expected = "a mesh with an array of 3 components"
        return ValueError(_check.message("tangents", expected, "a mesh without one"))
    remedy = f"pass {' or '.join(f'tangents={key}' for key in point)}"
    expected = f"the name of an array of 3 components ({', '.join(point)})"
    shown = None if got is None else repr(got)
    return ValueError(_check.message("tangents", expected, shown, remedy))


def _field(mesh: pv.DataSet, surface: pv.PolyData | None, options: StreamlineOptions) -> Array:
    """Return the vectors that are traced; on a surface their tangential part.

    They are sampled from the mesh where the surface lacks them, those without sign as tensors. The
    surface then gets the array that was sampled. A cross field has 6 components.
    """
    names = _names(options.tangents)
    if surface is None:
        return np.hstack([_directions(np.asarray(mesh.point_data[name])) for name in names])
    return np.hstack([_on_surface(mesh, surface, name, options) for name in names])


def _on_surface(
    mesh: pv.DataSet, surface: pv.PolyData, name: str, options: StreamlineOptions
) -> Array:
    """Return the tangential part of vectors on a surface; see :func:`_field`."""
    pair = isinstance(options.tangents, tuple)
    if pair and name not in surface.point_data:
        expected = "two point arrays of the surface"
        remedy = "attach both directions of the cross field to the surface"
        raise _check.value_error("tangents", expected, repr(name), remedy)
    if name in surface.point_data:
        rows = array_of(surface, "tangents", name)
        if rows.shape[1] not in ((3,) if pair else (3, 6, 9)):
            vectors_of(surface, "tangents", name, 3)
        array = _directions(rows)
    else:
        # A shallow copy takes the array that is sampled, so that the caller's mesh gets none.
        source = mesh.copy(deep=False)
        array = np.asarray(mesh.point_data[name])
        unsigned = options.line_field and array.shape[1] == 3
        if unsigned:
            # Opposite vectors would cancel where they are interpolated; their outer products do
            # not, and the lengths are sampled beside them.
            products = line_fields.outer(array[:, np.newaxis]).reshape(-1, 9)
            lengths = np.linalg.norm(array, axis=1, keepdims=True)
            source.point_data[TRACED] = np.concatenate([products, lengths], axis=1)
        field = pv.PolyData(surface.points).sample(source)
        if unsigned:
            sampled = np.asarray(field.point_data[TRACED])
            # The eigenvector has length 1, and the sampled length makes a vector of it again.
            array = tracers.principal_directions(sampled[:, :9])
            surface.point_data[name] = array * sampled[:, 9:]
        else:
            rows = np.asarray(field.point_data[name])
            surface.point_data[name] = rows
            array = _directions(rows)
    # Lines end where vectors are zero, as they do where vectors are missing.
    array[~np.all(np.isfinite(array), axis=1)] = 0
    normal = np.asarray(surface.point_data[NORMALS], dtype=np.float64)
    # The part that leads out of the surface is removed: v - (v . n) n.
    return np.asarray(array - np.einsum("ij,ij->i", array, normal)[:, np.newaxis] * normal)


def _directions(rows: Array) -> Array:
    """Return vectors as they are, and tensors as their first eigenvectors."""
    if rows.shape[1] in (6, 9):
        axes = tracers.principal_directions(np.asarray(rows, dtype=np.float64))
        # A tensor of zeros stands for no data, and is not counted.
        lost = int(np.count_nonzero(~np.any(axes, axis=1) & np.any(rows, axis=1)))
        if lost:
            _check.warn(
                f"{lost} of {len(axes)} tensors have no first eigenvector (isotropic or not "
                "finite): lines end there"
            )
        return axes
    return np.array(rows, dtype=np.float64)


def _bare(mesh: pv.DataSet, lit_names: set[str]) -> pv.DataSet:
    """Return a mesh that the tracer may change.

    Arrays of words, which end the tracer's process, and vizlight's own are left out.
    """
    bare = mesh.copy(deep=False)
    for key in list(bare.point_data):
        if key in lit_names or np.asarray(bare.point_data[key]).dtype.kind not in "biuf":
            # PyVista's own way forgets in the mesh, too, that an array is one of flags.
            bare.GetPointData().RemoveArray(key)
    return bare


def seeds_of(seeds: object) -> tuple[int, Array | None]:
    """Return the number of lines, and where they start if that is given."""
    if isinstance(seeds, pv.DataSet):
        positions: Array = np.asarray(seeds.points, dtype=np.float64)
    else:
        positions = _check.floats("seeds", seeds).astype(np.float64)
    if not positions.ndim:
        count = _check.integer("seeds", seeds, low=1)
        _check.holds("seeds", (count, 3))
        return count, None
    places: Array = _check.vectors("seeds", positions, n=3)
    if places.ndim != 2 or not len(places) or not np.all(np.isfinite(places)):
        what = "finite points of shape (M, 3), one or more"
        raise _check.value_error("seeds", what, _check.describe(seeds))
    return len(places), places
