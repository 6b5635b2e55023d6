"""Pathlines and streaklines of a flow that changes with time, lit at each step."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal, get_args

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check, _progress
from vizlight._types import Array, Exponent, Facing, Foreign, Model, Precision
from vizlight.filters.illuminate import light_mesh
from vizlight.filters.streamlines import OWN_TANGENTS, TANGENTS, seeds_of
from vizlight.mesh import georeference, meaning, records
from vizlight.mesh.particles import Carrier, Rows
from vizlight.reading import cf_grids
from vizlight.reading.series import TIME, Series
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene
from vizlight.shading.options import Bundle, LightOptions

#: Kinds of lines in a flow that changes with time.
Kind = Literal["pathlines", "streaklines"]
#: Largest number of points of a streak, and of steps between two times of a streak. Both bound the
#: work, which grows with the product: particles in a vortex never leave.
MOST, MOST_STEPS = 256, 100
#: Name of the point array of times.
TIMES = "Time"


@dataclass(frozen=True, kw_only=True)
class PathlineOptions(LightOptions):
    """Options of particles that are carried, and of the light of their lines.

    The fields are keywords of :func:`vizlight.pathlines`.
    """

    DECIDED: ClassVar = frozenset({"positions", "feature_angle"})
    kind: Kind = "pathlines"
    times: ArrayLike | None = None
    tangents: str | None = None
    seeds: int | ArrayLike | pv.DataSet = 200
    seed: int = 0
    tail: float | None = None
    step: float = 0.3

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.choice("kind", self.kind, get_args(Kind))
        _check.fields(self, _check.number, "step", low=1e-3)
        _check.fields(self, _check.integer, "seed", low=0)
        names: object = self.tangents
        if isinstance(names, list | tuple):
            _check.set_fields(self, tangents=",".join(map(str, names)))
        records.refuse_unnamed("tangents", self.tangents)
        if self.conditioned and not isinstance(self.conditioned, str) and self.normals is None:
            expected = "the name of normals by normals= beside it, for lines have no surface"
            raise _check.value_error("conditioned", expected, "none")
        _check.fields(self, _check.positive, "tail", optional=True)


@named
def pathlines(
    series: Sequence[pv.DataSet] | Foreign,
    /,
    scene: AnyScene | None = None,
    *,
    kind: Kind = "pathlines",
    times: ArrayLike | None = None,
    tangents: str | None = None,
    seeds: int | ArrayLike | pv.DataSet = 200,
    seed: int = 0,
    tail: float | None = None,
    step: float = 0.3,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    conditioned: bool | str | None = False,
    line_field: bool = False,
    bundle: bool | Bundle = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    progress_bar: bool = False,
) -> Iterator[pv.PolyData]:
    """Carry particles by vectors that change with time, and light their lines at each step.

    Parameters
    ----------
    series : sequence of meshes, reader, or path
        Meshes with the same points at rising times, such as a list; a reader of PyVista with
        ``time_values``; or the path of its file, such as ``flow.pvd``. Only two steps of a reader
        are in memory at a time.
    scene : Scene or str, optional
        Scene, the same at each step, by default ``Scene()``.
    kind : {"pathlines", "streaklines"}
        Kind of lines: the way of each particle that leaves its seed at the first time; or, like
        smoke, the present places of particles that have left a seed one after the other.
    times : array_like, shape (S,), optional
        Times of a sequence of meshes, rising. Default: their field array ``TimeValue``.
    tangents : str, optional
        Name of a point array of 3 components, of the same name at each step, or of components,
        such as ``"u,v"``. Default: the active vectors of the first, or its only components. On a
        map in degrees they are in the unit of their file, else metres a second, east and north.
    seeds : int or array_like, shape (M, 3), or mesh, default: 200
        Points at which particles start; a number stands for points of the mesh, drawn without
        repetition from those that move at the first time.
    seed : int, default: 0
        Seed of the random numbers.
    tail : float, optional
        Duration that the lines show, in the unit of the times. Default: all since the first time.
    step : float, default: 0.3
        Largest step of the integration, in cell lengths; lines have a point at each.
    normals, facing, conditioned, line_field, bundle, occlusion, name, exponent, model, components
        As for :func:`vizlight.illuminate`.
    precision
        As for :func:`vizlight.illuminate`.
    progress_bar
        As for :func:`vizlight.illuminate`.

    Yields
    ------
    pyvista.PolyData
        Lines of the second step, of the third and so on, with the point arrays ``luminance``, the
        vectors that carry the particle, and ``Time``: when the particle was at the point, on
        pathlines, or when it left its seed, on streaklines. Pathlines are lit by the vectors
        (``Tangents``), streaklines by their own tangents. The field array ``TimeValue`` is the time
        of the step. :func:`vizlight.draw.movie.save` makes a movie of them.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, before anything is traced; or if a step has other points than
        the first, or lacks the vectors, which the message names.

    Notes
    -----
    The method of Runge and Kutta of order 4 in vectors that VTK interpolates in the cells and that
    are linear in time between two steps: the error is of order 2 in the time between steps. Plane
    grids and volumes are meant: on a curved surface particles leave it at once. A line ends less
    than a step before the boundary. Where a flow pulls a streak apart, particles that left one
    after the other are joined by a chord. A streak has at most 256 points at a time, and is carried
    in at most 100 steps between two times, with a warning if these are longer than ``step``.

    VTK's vtkParticlePathFilter and vtkStreaklineFilter (9.7) are of order 1 in the time between
    steps: they use the vectors of its end.

    Examples
    --------
    >>> import numpy as np
    >>> import pyvista as pv
    >>> import vizlight
    >>> times, steps = np.linspace(0, 1, 5), []
    >>> for t in times:
    ...     step = pv.ImageData(dimensions=(9, 9, 9))
    ...     step["V"] = np.tile([1.0, np.cos(t), 0.0], (step.n_points, 1))
    ...     steps.append(step)
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> frames = list(vizlight.pathlines(steps, scene, times=times, tangents="V", seeds=20))
    >>> len(frames), "luminance" in frames[-1].point_data
    (4, True)
    """
    options = PathlineOptions.of(locals())
    scene = as_scene(scene)
    # Steps of a netCDF file are read with their meaning.
    if isinstance(series, str | Path) and Path(series).suffix.lower() in cf_grids.SUFFIXES:
        series = cf_grids.Steps(Path(series))
    steps = Series(series, options.times)
    first = steps.mesh(0)
    named = options.tangents
    if named is None:
        named = first.point_data.active_vectors_name or meaning.only_vectors(first)
    if named is None:
        raise _check.value_error("tangents", "the name of a point array of 3 components", None)
    seeds = _seeds(first, steps.vectors(0, named), options)
    options = dataclasses.replace(options, tangents=named)

    # A generator of its own: arguments are checked at the call, and not when the first frame is
    # asked for.
    def lit() -> Iterator[pv.PolyData]:
        with _progress.progress("carry", len(steps.times) - 1, show=progress_bar) as report:
            for lines, light in _lines(steps, seeds, options, report):
                yield light_mesh(lines, scene, light, inplace=True)

    return lit()


def _seeds(mesh: pv.DataSet, vectors: Array, options: PathlineOptions) -> Array:
    """Return the points at which particles start."""
    count, places = seeds_of(options.seeds)
    if places is not None:
        return places
    moving = np.flatnonzero(np.any(vectors != 0, axis=1))
    if not len(moving):
        name = repr(options.tangents)
        raise _check.value_error("seeds", "points at which the vectors are not zero", name)
    random = np.random.default_rng(options.seed)
    chosen = np.sort(random.choice(moving, min(count, len(moving)), replace=False))
    starts: Array = np.asarray(mesh.points, dtype=np.float64)[chosen]
    return starts


def _lines(
    steps: Series, seeds: Array, options: PathlineOptions, report: Callable[[int], None]
) -> Iterator[tuple[pv.PolyData, LightOptions]]:
    """Yield the lines of each step, and the options of their light."""
    name, streaks = str(options.tangents), options.kind == "streaklines"
    # A pathline follows one particle, whose velocity is the tangent; a streak joins several
    # particles.
    tangents = None if streaks else TANGENTS if name != TANGENTS else OWN_TANGENTS
    light = LightOptions.of(vars(options) | {"tangents": tangents})
    first, times = steps.mesh(0), steps.times
    carrier = Carrier(first, name)
    rows = Rows(np.empty((0, *seeds.shape)), np.empty((0, *seeds.shape)), np.empty(0))
    before, coarse = steps.vectors(0, name), 0.0
    for i in range(1, len(times)):
        after = steps.vectors(i, name)
        carrier.between(before, after)
        before, start, duration = after, float(times[i - 1]), float(times[i] - times[i - 1])
        if i == 1:
            rows = rows.joined(Rows(seeds[None], carrier.at(seeds, 0.0)[None], np.array([start])))
        # Of a streak all points move, of a pathline only the newest.
        here = rows.places.reshape(-1, 3) if streaks else rows.places[-1]
        count = carrier.count(here, duration, options.step)
        if streaks and count > MOST_STEPS:
            crossed = options.step * count / MOST_STEPS
            coarse, count = max(coarse, crossed), MOST_STEPS
        for j in range(count):
            moved = carrier.moved(here, j / count, 1 / count, duration / count)
            share = (j + 1) / count
            # The last time of the step is the given one, to the bit.
            time = float(times[i]) if j + 1 == count else start + share * duration
            if streaks:
                # Particles that have left the mesh stay as a gap in the streak.
                rows = Rows(moved.reshape(-1, *seeds.shape), rows.vectors, rows.times).thinned(MOST)
                # Vectors of a streak are looked up once, when it has arrived at the end of the
                # step.
                none = np.full((1, *seeds.shape), np.nan)
                rows = rows.joined(Rows(seeds[None], none, np.array([time])))
                here = rows.places.reshape(-1, 3)
            else:
                new = Rows(moved[None], carrier.at(moved, share)[None], np.array([time]))
                rows, here = rows.joined(new), moved
            if options.tail is not None:
                rows = rows[rows.times >= time - options.tail]
                here = rows.places.reshape(-1, 3) if streaks else here
        if streaks:
            rows.vectors = carrier.at(here, 1.0).reshape(rows.places.shape)
        lines = rows.lines(name, TIMES)
        if i == 1 and not lines.n_points:
            expected = "points inside the mesh where the vectors are not zero"
            name = "seeds" if options.tail is None else "seeds, tail"
            raise _check.value_error(name, expected, "no line")
        if tangents is not None:
            records.attach_rows(lines, tangents, np.asarray(lines.point_data[name]))
        georeference.place_alike(lines, first)
        lines.field_data[TIME] = [float(times[i])]
        report(i)
        yield lines, light
    if coarse:
        _check.warn(
            f"the flow crosses up to {MOST_STEPS * coarse:.0f} cells between two times: streaklines"
            f" are carried in steps of up to {coarse:.1f} cells; write more times of the flow"
        )
