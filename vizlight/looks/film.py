"""Movies of the steps of a series, all drawn in one range of colours and from one place."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

import vizlight
from vizlight import _check, files
from vizlight._types import Array, Foreign, Given, Keywords
from vizlight.draw import movie
from vizlight.draw.ticks import even_levels
from vizlight.looks import map_parts
from vizlight.looks import options as look_options
from vizlight.looks.contents import Contents
from vizlight.looks.options import READ
from vizlight.looks.ranges import range_shown
from vizlight.looks.recipes import fields
from vizlight.looks.recipes.drawing import BANDS, GROUND, ON_BANDS, ON_GROUND, Layer, colors_in
from vizlight.looks.recipes.maps import classes
from vizlight.looks.steps import Step, in_order
from vizlight.looks.wishes import Wishes
from vizlight.mesh import meaning
from vizlight.mesh.particles import Drift
from vizlight.model import kernels
from vizlight.reading import series

Picture = NDArray[np.uint8]

__all__ = ["save"]

#: Seconds that a movie takes, and its least and largest number of steps a second.
LASTS, SLOWEST, FASTEST = 8.0, 2.0, 24.0
#: Most values of a step that count for the range of all.
MOST_VALUES = 100_000
#: Most a stroke moves from picture to picture, as the inverse of a share of its length.
PER_LENGTH = 16.0
#: Share of the pace of a field from which strokes move with it.
AT_PACE = 0.99
#: Share of a range, as its inverse, to which its ends are rounded.
FINE = 1000


def save(
    data: str | Path | Foreign,
    path: str | Path,
    question: str = "auto",
    /,
    *,
    fps: float | None = None,
    per_step: int = 1,
    times: Sequence[float] | None = None,
    progress_bar: bool = False,
    **options: Given,
) -> list[Path]:
    """Save a movie of all steps of a series, each drawn as :func:`vizlight.look` draws it.

    ``vizlight.look(data).save("movie.mp4")`` calls it with the array, the range of colours and the
    camera that suit all steps.

    Parameters
    ----------
    data : path or xarray object
        Series, of which one step at a time is in memory.
    path : path
        Path of a movie or of a sequence of PNGs, as for :func:`vizlight.movie.turn`.
    question : str, default: "auto"
        Question that each picture answers, as for :func:`vizlight.look`.
    fps : float, optional
        Steps per second. Default: such that the movie takes 8 s, between 2 and 24.
    per_step : int, default: 1
        Pictures from step to step, if strokes of a flat field or of one in a volume are drawn: they
        are carried by vectors linear in time, and keep their places from picture to picture. On
        other data the pictures of a step are alike.
    times : sequence of float, optional
        Times of the steps that are shown. Default: those of all.
    progress_bar : bool, default: False
        Show progress on standard error.
    **options
        Options of :func:`vizlight.look`. Without ``clim`` each step has a range of its own.

    Returns
    -------
    list of pathlib.Path
        Paths of the files written.

    Raises
    ------
    MovieError, BackendError, TypeError, ValueError
        As for :func:`vizlight.movie.turn`; also if the data have no steps.
    """
    read = {name: options[name] for name in READ if name in options}
    if "time" in read:
        raise _check.value_error("time", "none beside a movie of all steps", "one")
    every = series.of(files.read(data, **read))
    if not every:
        raise _check.value_error("data", "a series of steps", "one mesh")
    chosen = every if times is None else [float(time) for time in times]
    if not chosen or not {*chosen} <= {*every}:
        raise _check.value_error("times", f"some of {series.listed(every)}", repr(times))
    _check.integer("per_step", per_step, low=1, high=100)
    fps = _pace(chosen) if fps is None else _check.number("fps", fps, low=0.01, high=100.0)
    pictures = _Pictures(_looks(data, question, chosen, options), chosen, per_step)
    return movie.save(pictures, path, fps=fps * per_step, progress_bar=progress_bar)


class _Pictures:
    """Pictures of the steps of a series, each drawn when it is asked for.

    Where a step has several pictures, strokes are carried from step to step by the vectors.
    """

    def __init__(
        self, looks: Iterator[vizlight.Look], times: Sequence[float], per_step: int
    ) -> None:
        self._looks, self._times, self._per_step = looks, times, per_step

    def __len__(self) -> int:
        return (len(self._times) - 1) * self._per_step + 1

    def __iter__(self) -> Iterator[Picture]:
        drift: Drift | None = None
        lasts = np.inf
        look, flow = self._next()
        while look is not None:
            after, then = self._next()
            if flow is None:
                yield from _drawn(look.plotter(), [None])
            else:
                # The last step has the pace of the step before it.
                lasts = lasts if then is None else then.time - flow.time
                if drift is None or not drift.fits(flow.mesh):
                    size = flow.spacing, flow.length
                    drift = Drift(flow.mesh, flow.vectors, *size, flow.tangents)
                yield from flow.pictures(drift, then, lasts, self._per_step)
            look, flow = after, then

    def _next(self) -> tuple[vizlight.Look | None, _Flow | None]:
        """Return the look at the next step, and its strokes if they move."""
        look = next(self._looks, None)
        return look, None if look is None or self._per_step == 1 else _Flow.of(look)


def _looks(
    data: str | Path | Foreign, question: str, times: Sequence[float], options: Keywords
) -> Iterator[vizlight.Look]:
    """Yield the looks at the steps, without those that cannot be drawn alike."""
    left_out: list[float] = []
    error: ValueError | None = None
    for time in times:
        try:
            yield vizlight.look(data, question, time=time, **options)
        except ValueError as reason:
            # Fields at rest, or without a value of the level, at the first step for instance.
            left_out, error = [*left_out, time], reason
    if error is not None:
        if len(left_out) == len(times):
            raise error
        _check.warn(f"steps are left out, at {series.listed(left_out)}: {error}")


@dataclass(frozen=True)
class _Flow:
    """Strokes of a look at one step that can be carried, on a sheet or in a volume."""

    look: vizlight.Look
    layer: Layer
    mesh: pv.DataSet

    @classmethod
    def of(cls, look: vizlight.Look) -> _Flow | None:
        """Return the strokes of a look, None where it has none that can be carried."""
        for layer in look.drawing.layers:
            if "width" in layer.keywords and fields.have_sense(layer.mesh):
                source: Foreign = layer.mesh.arguments[0]
                mesh = source.run()
                volume = mesh.GetMaxSpatialDimension() == 3
                return cls(look, layer, mesh) if volume or look.drawing.is_flat else None
        return None

    @property
    def vectors(self) -> Array:
        """Vectors at the points."""
        return np.asarray(self.mesh.point_data[self.tangents], dtype=np.float64)

    @property
    def tangents(self) -> str:
        """Name of the vectors."""
        return str(self.layer.mesh.keywords["tangents"])

    @property
    def length(self) -> float:
        """Length of a stroke."""
        length: Foreign = self.layer.mesh.keywords["stroke_length"]
        return float(length)

    @property
    def spacing(self) -> float:
        """Distance between strokes."""
        spacing: Foreign = self.layer.mesh.keywords.get("spacing")
        return self.length / fields.LONG if spacing is None else float(spacing)

    @property
    def time(self) -> float:
        """Time of the step."""
        return float(self.mesh.field_data[series.TIME][0])

    def pictures(
        self, drift: Drift, then: _Flow | None, lasts: float, count: int
    ) -> Iterator[Picture]:
        """Yield the pictures from this step to before the next, one of the last step.

        The drift has strokes as they are at this step, ``then`` those of the next; ``lasts`` is the
        time of a step, and ``count`` the number of pictures from step to step.
        """
        here = self.vectors
        at = here if then is None else then.vectors
        drift.between(here, at if at.shape == here.shape else here)
        move = min(lasts / count, drift.duration / PER_LENGTH)
        ratio = move * count / lasts
        pace = "with it" if ratio > AT_PACE else f"at {ratio:.2g} of its pace"
        rest = [layer for layer in self.look.drawing.layers if layer is not self.layer]
        ground = replace(fields.with_words(self.look.drawing, f"strokes move {pace}"), layers=rest)
        speed = self.layer.keywords.get("scalars")

        def strokes() -> Iterator[Layer]:
            for i in range(count if then is not None else 1):
                lines = drift.strokes(self.tangents)
                if speed is not None:
                    sizes = np.linalg.norm(lines.point_data[self.tangents], axis=1)
                    lines.point_data[str(speed)] = sizes
                yield replace(self.layer, mesh=Step("strokes", "-", lines))
                drift.advance(i / count, 1 / count, move)

        yield from _drawn(replace(self.look, drawing=ground).plotter(), strokes())


def _drawn(plotter: pv.Plotter, layers: Iterable[Layer | None]) -> Iterator[Picture]:
    """Yield the pictures of a plotter with each of some layers, and close it."""
    with contextlib.closing(plotter):
        for layer in layers:
            actor = None
            if layer is not None:
                # Otherwise the picture is drawn after each change.
                layer = replace(layer, keywords={**layer.keywords, "render": False})
                actor = layer.added(Step("plotter", "-", plotter)).run()
                plotter.render()
            yield np.array(plotter.screenshot(return_img=True))
            if actor is not None:
                plotter.remove_actor(actor, render=False)


def step(look: vizlight.Look, path: Path) -> Step | None:
    """Return the step that saves a movie of all steps of the series of a look, None without one."""
    reads = [each for each in in_order([look.drawing.lit]) if each.path == "vizlight.read"]
    chosen = look.wishes.steps
    if len(reads) != 1 or (reads[0].keywords.get("time") is not None and not chosen):
        return None
    read = reads[0]
    times = chosen or series.of(read.run())
    if len(times) < 2:
        return None
    question = [look.wishes.question] if look.wishes.question != "auto" else []
    options = _settings(look, read, times)
    if chosen:
        options["times"] = [*chosen]
    if _Flow.of(look) is not None and (count := round(FASTEST / _pace(times))) > 1:
        options["per_step"] = count
    saved = Step("", "film.save", read.arguments[0], path, *question, **options)
    # What a picture of one step says of it, a movie of all does not.
    saved.note = series.note(read.run())
    return saved


def _pace(times: Sequence[float]) -> float:
    """Return the number of steps a second that suits a series."""
    return float(np.clip(len(times) / LASTS, SLOWEST, FASTEST))


def _settings(look: vizlight.Look, read: Step, times: Sequence[float]) -> Keywords:
    """Return the options with which all steps of a series are drawn as one of them is."""
    wishes, drawing = look.wishes, look.drawing
    groups = {**wishes.part, **wishes.light, **wishes.eye, **wishes.picture}
    options: Keywords = {name: value for name, value in groups.items() if value is not None}
    for name in ("frames", "time"):
        options.pop(name, None)
    if not options.get("globe"):
        options.pop("globe", None)
    for name in ("view", "size", "style"):
        if (value := getattr(wishes, name)) != getattr(Wishes, name):
            options[name] = value
    if not drawing.is_flat:
        options["view"] = drawing.camera
        if wishes.make_scene is not None or drawing.scene.path == ".replace":
            # The light of one step is that of all.
            options["scene"] = drawing.scene
    drawn = [
        name
        for name in map_parts.PARTS
        if any(map_parts.is_of(name, layer.mesh) for layer in drawing.layers)
    ]
    if "isolines" in drawn:
        # So that each step has them.
        options.setdefault("map_parts", drawn)
    array = look.array
    for each in in_order([drawing.lit]):
        if each.keywords.get("level") is not None:
            options |= {name: each.keywords[name] for name in ("contour", "level")}
            array = drawing.layers[0].keywords.get("scalars")
        elif each.path == "files.without_corner" and each.arguments[2] is not None:
            options["level"] = each.arguments[2]
    if array is not None:
        options["array"] = array
        if "clim" not in options and any("clim" in key for key in drawing.keys):
            options |= _colors(look, read, times, array)
    return options


def _colors(look: vizlight.Look, read: Step, times: Sequence[float], array: str) -> Keywords:
    """Return the colour map and the range that suit the values of an array at all steps."""
    values, vectors = [], False
    for time in times:
        step = Step("", read.path, *read.arguments, **read.keywords | {"time": time})
        # Of a volume that is shown as a map, one layer is seen.
        mesh = look_options.layer(step, Contents(step.run()), look.wishes)[0].run()
        if "," in array:
            mesh = files.with_vectors(mesh, array)
        if array not in mesh.array_names:
            continue
        rows: Array = np.asarray(mesh[array])
        vectors = rows.ndim == 2
        rows = kernels.length_rows(rows) if vectors else rows.astype(np.float64)
        rows = rows[np.isfinite(rows)]
        values.append(rows[:: 1 + len(rows) // MOST_VALUES])
        # The sample may miss them.
        values += [np.array([rows.min(), rows.max()])] if len(rows) else []
    drawn: Foreign = look.drawing.layers[0].keywords.get("cmap")
    has_ground = isinstance(drawn, Step) and GROUND in drawn.keywords.values()
    every = np.concatenate(values)
    unit, _ = meaning.usual_unit(read.run(), array, float(np.abs(every).max()))
    if isinstance(drawn, Step) and drawn.path == BANDS and not (vectors or has_ground):
        return _in_bands(every / unit, unit)
    shown = range_shown(every / unit, lengths=vectors, amounts=has_ground)
    shown = shown.around_zero(every / unit) if shown.is_signed else shown
    if shown.words(array):
        if isinstance(drawn, Step):
            # The colours of a step stay those of the movie.
            names = [part for part in drawn.arguments if isinstance(part, str)]
            drawn = ON_GROUND if shown.ground else [*names, ON_BANDS][0]
        return colors_in(shown, look.wishes.picture.get("cmap") or drawn, unit)
    shown = shown._replace(low=shown.low * unit, high=shown.high * unit)
    step = 10.0 ** np.floor(np.log10((shown.high - shown.low) / FINE or 1.0))
    ends = np.floor(shown.low / step) * step, np.ceil(shown.high / step) * step
    return {"clim": tuple(float(f"{end:.9g}") for end in ends)}


def _in_bands(values: Array, unit: float) -> Keywords:
    """Return the range of the bands between isolines that hold values, read in a unit."""
    ends = float(values.min()), float(values.max())
    edges = classes(even_levels(*ends, map_parts.LEVELS[0]), ends)
    return {"clim": (float(f"{unit * edges[0]:.12g}"), float(f"{unit * edges[-1]:.12g}"))}
