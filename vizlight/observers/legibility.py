"""The public meter: what a reader can read back from a lit picture of a mesh, and its figures."""

from __future__ import annotations

import dataclasses
import html
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.filters import lighting
from vizlight.filters.tint import color_table
from vizlight.mesh import blocks
from vizlight.observers import readers
from vizlight.observers.samples import parts_of, places_of, seen_from
from vizlight.scene import Scene
from vizlight.shading.options import LightOptions

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pyvista as pv
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Function, Keywords, Vector
    from vizlight.filters.tint import ColorMap
    from vizlight.observers.samples import Part, Sample
    from vizlight.scene.conversion import AnyView
    from vizlight.shading.options import Exponent, Model

#: Standard deviation of the noise of each channel.
NOISE = 2 / 255
HEAD = ("question", "figure", "found", "chance")
#: Rows of the table: question, figure, its words, its form and what guessing gives.
ROWS = (
    ("direction", "within_10", "within 10 degrees", "{:.1%}", "11.1%"),
    ("direction", "median", "median error", "{:.2f} degrees", "45"),
    ("direction", "bits", "information", "{:.2f} bits", "0"),
    ("direction", "legend_median", "median error by the key", "{:.2f} degrees", "45"),
    ("slope", "spearman", "rank correlation", "{:+.2f}", "0"),
    ("slope", "bits", "information", "{:.2f} bits", "0"),
    ("slope", "within_10", "in space, within 10 degrees", "{:.1%}", ""),
    ("slope", "median", "in space, median error", "{:.2f} degrees", ""),
    ("shape", "median", "median error of the normal", "{:.2f} degrees", "45 degrees"),
    ("shape", "bits", "information", "{:.2f} bits", "0"),
    ("value", "p95", "95 % of the errors, nearest colour", "{:.1%} of the range", ""),
    ("value", "median", "median error", "{:.1%}", ""),
    ("value", "largest", "largest error", "{:.1%}", ""),
    ("value", "p95_chromaticity", "95 % by chromaticity", "{:.1%} of the range", ""),
    ("value", "median_chromaticity", "median by chromaticity", "{:.1%}", ""),
    ("value", "largest_chromaticity", "largest by chromaticity", "{:.1%}", ""),
)


@dataclass(frozen=True, kw_only=True)
class Direction:
    """Which way tangents run, of single tangents on surfaces and at points.

    Attributes
    ----------
    within_10 : float
        Share of the places where the ideal observer is wrong by 10 degrees at most; 1/9 by chance.
    median : float
        Median error of the ideal observer in degrees; 45 by chance.
    bits : float
        Information that the colour of a pixel gives of 180 directions, 7.5 bits at most.
    legend_median : float or None
        Median error in degrees of a reader who knows no normal and matches the hue with the key
        beside the picture; 45 by chance. None where all tangents run along the line of sight.
    samples : int
        Number of places.
    """

    within_10: float
    median: float
    bits: float
    legend_median: float | None
    samples: int


@dataclass(frozen=True, kw_only=True)
class Slope:
    """How steeply lines run toward the eye.

    Attributes
    ----------
    spearman : float
        Rank correlation of lightness with steepness, the cosine of the angle between a line and
        the line of sight; -1 or 1 where lightness orders all lines, 0 by chance.
    bits : float
        Information that lightness in 32 classes gives of steepness in 16, 4 bits at most; less from
        fewer than 4096 places, because each class of lightness has 128 or more.
    within_10, median : float or None
        Share of the places where the direction in space is wrong by 10 degrees at most, and the
        median error in degrees, for an ideal observer who knows the course of the line in the
        picture. None where all lines run along the line of sight.
    samples : int
        Number of places.
    """

    spearman: float
    bits: float
    within_10: float | None
    median: float | None
    samples: int


@dataclass(frozen=True, kw_only=True)
class Shape:
    """How surfaces stand.

    Attributes
    ----------
    median : float
        Median error in degrees of the normal, for an ideal observer to whom tangents are unknown,
        who answers with the mean of what may be; 45 if the picture of a ball tells nothing.
    bits : float
        Information that the colour of a pixel gives of 900 normals, 9.8 bits at most; where there
        are tangents, of 300 normals, 8.2 bits at most.
    samples : int
        Number of places.
    """

    median: float
    bits: float
    samples: int


@dataclass(frozen=True, kw_only=True)
class Value:
    """Values as they are read off the colour bar, as shares of the range of the bar.

    Attributes
    ----------
    median, p95, largest : float
        Median, 95 % quantile and largest error of a reader who takes the nearest colour of the
        bar, in CIELAB.
    median_chromaticity, p95_chromaticity, largest_chromaticity : float
        Errors of a reader who takes the nearest chromaticity, which light does not change.
    samples : int
        Number of places.
    """

    median: float
    p95: float
    largest: float
    median_chromaticity: float
    p95_chromaticity: float
    largest_chromaticity: float
    samples: int


@dataclass(frozen=True, kw_only=True)
class Legibility:
    """What a reader can read back from a lit picture; see :func:`vizlight.legibility`.

    Attributes
    ----------
    direction : Direction or None
        Which way tangents run; None without single tangents on a surface or at points.
    slope : Slope or None
        How steeply lines run toward the eye; None without lines.
    shape : Shape or None
        How surfaces stand; None without a surface or normals.
    value : Value or None
        Values as they are read off the bar; None without scalars.
    pixels : int
        Number of visible pixels, or of points that face the eye.
    drawn : bool
        Whether a picture was drawn. Without OpenGL the places are points that face the eye, also
        those that others hide.
    toward_eye : tuple of float
        Direction from the middle of the picture toward the eye.
    noise : float
        Standard deviation of the noise in each channel, from 0 to 1.
    seed : int
        Seed of the drawing.
    notes : tuple of str
        What has no figure, and what was left out.
    """

    direction: Direction | None
    slope: Slope | None
    shape: Shape | None
    value: Value | None
    pixels: int
    drawn: bool
    toward_eye: Vector
    noise: float
    seed: int
    notes: tuple[str, ...] = ()

    def _rows(self) -> list[tuple[str, ...]]:
        rows, last = list[tuple[str, ...]](), ""
        for question, name, words, form, chance in ROWS:
            value = getattr(getattr(self, question), name, None)
            if value is not None:
                shown = "" if question == last else question
                rows.append((shown, words, form.format(value), chance))
                last = question
        return rows

    def _lines(self) -> list[str]:
        where = "visible pixels" if self.drawn else "points that face the eye; no picture was drawn"
        noise = f"noise {255 * self.noise:g}/255, seed {self.seed}"
        return [
            f"{self.pixels} {where}; {noise}",
            "ideal observers, but for the key: an upper bound of what a person reads",
            *(f"note: {note}" for note in self.notes),
        ]

    def __str__(self) -> str:
        rows = [HEAD, *self._rows()]
        wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
        padded = [map(str.ljust, row, wide) for row in rows]
        return "\n".join([*("  ".join(row).rstrip() for row in padded), *self._lines()])

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in HEAD)
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self._rows()
        )
        below = "<br>".join(html.escape(line) for line in self._lines())
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{below}</p>"

    def to_dict(self) -> dict[str, object]:
        """Return all figures as nested dicts of plain values, for JSON."""
        return dataclasses.asdict(self)


def of_direction(own: list[Sample], random: np.random.Generator, noise: float) -> Direction:
    """Return the figures of direction."""
    found = [readers.find_direction(one, random, noise) for one in own]
    # The key lies amid what it explains, since the light of near lamps depends on the place.
    middle = np.concatenate([one.points for one in own]).mean(axis=0)
    by_key = np.concatenate([readers.by_key(one, middle, random, noise) for one in own])
    error = np.concatenate([each.error for each in found])
    return Direction(
        **_errors(error),
        bits=float(np.concatenate([each.bits for each in found]).mean()),
        legend_median=float(np.median(by_key)) if len(by_key) else None,
        samples=len(error),
    )


def _errors(degrees: Array) -> dict[str, float]:
    """Return the share of errors of 10 degrees at most, and their median."""
    return {"within_10": float((degrees <= 10).mean()), "median": float(np.median(degrees))}


def _with_data(samples: list[Sample], question: str, what: str, notes: list[str]) -> list[Sample]:
    """Return the places where vectors have a direction, and note how many were left out."""
    kept = [one.take(one.valid) for one in samples]
    total, left = sum(map(len, samples)), sum(map(len, kept))
    if left < total:
        notes.append(f"{question}: {total - left} of {total} places have zero {what}, left out")
    return [one for one in kept if len(one)]


def of_slope(own: list[Sample], random: np.random.Generator, noise: float) -> Slope:
    """Return the figures of slope."""
    seen = [readers.seen(one.own_light(), random, noise) for one in own]
    lightness = np.concatenate([readers.lab(colors)[:, 0] for colors in seen])
    steepness = np.concatenate([readers.steepness(one) for one in own])
    error = np.concatenate([readers.find_slope(one, random, noise) for one in own])
    in_space = _errors(error) if len(error) else {"within_10": None, "median": None}
    return Slope(
        spearman=readers.rank_correlation(lightness, steepness),
        bits=readers.mutual_information(steepness, lightness),
        **in_space,
        samples=len(steepness),
    )


def of_shape(own: list[Sample], random: np.random.Generator, noise: float) -> Shape:
    """Return the figures of shape."""
    few = [np.sort(random.permutation(len(one))[: readers.most(one)]) for one in own]
    some = [one.take(rows) for one, rows in zip(own, few, strict=True)]
    found = [readers.find_normal(one, random, noise) for one in some]
    error = np.concatenate([each.error for each in found])
    return Shape(
        median=float(np.median(error)),
        bits=float(np.concatenate([each.bits for each in found]).mean()),
        samples=len(error),
    )


#: What measures each question of light, where it has an answer, and the data of it.
QUESTIONS: dict[str, tuple[Function, Callable[[Sample], bool], str]] = {
    "direction": (
        of_direction,
        lambda one: one.kind != "line" and one.has_one_tangent,
        "tangents or normals",
    ),
    "slope": (of_slope, lambda one: one.kind == "line" and one.has_one_tangent, "tangents"),
    "shape": (
        of_shape,
        lambda one: one.kind != "line" and one.normals is not None,
        "tangents or normals",
    ),
}


def of_value(
    taken: list[tuple[Sample, Part]], table: pv.LookupTable, notes: list[str]
) -> Value | None:
    """Return the figures of value; what has none, or was left out, is added to the notes."""
    low, high = table.scalar_range
    bar = np.asarray(table.values)[:, :3] / 255.0
    if not low < high:
        notes.append(f"value: the scalars are constant, {low:g}, and have one colour")
        return None
    if not np.ptp(bar, axis=0).any():
        notes.append("value: the colour map has one colour")
        return None
    read, left = [], 0
    for one, part in taken:
        values = np.asarray(one.values)
        # Points without light have the colour of what is not data.
        known = np.isfinite(values) & one.valid
        left += int(np.count_nonzero(~known))
        # Values beyond the ends have the colours of the ends.
        positions = np.clip((values[known] - low) / (high - low), 0.0, 1.0)
        colors = readers.lit_colors(part, one.take(known), table)
        read.append(readers.decode(colors, positions, bar))
    total = sum(len(one) for one, _ in taken)
    if left:
        notes.append(f"value: {left} of {total} places have no value, left out")
    if left == total:
        return None
    nearest, chromatic = np.concatenate(read, axis=1)
    figures = {
        f"{name}{by}": float(function(errors))
        for by, errors in (("", nearest), ("_chromaticity", chromatic))
        for name, function in (
            ("median", np.median), ("p95", lambda x: np.quantile(x, 0.95)), ("largest", np.max),
        )
    }  # fmt: skip
    return Value(**figures, samples=len(nearest))


def legibility(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    scene: Scene,
    *,
    tangents: str | ArrayLike | None = None,
    scalars: str | ArrayLike | None = None,
    cmap: ColorMap = None,
    clim: Sequence[float] | float | None = None,
    conditioned: bool = False,
    exponent: Exponent = "compensated",
    model: Model = "phong",
    view: AnyView = None,
    noise: float = NOISE,
    samples: int = 4096,
    seed: int = 0,
) -> Legibility:
    """Measure what a reader can read back from a lit picture.

    An offscreen picture finds the visible pixels. Each of a random sample of them is lit for the
    data that are there and for every other answer to a question, and an *ideal observer*, who
    knows the lamps, the material and how light is computed, tells by the noisy colour which
    answer is likeliest. No person reads a picture as well: its figures are an **upper bound** of
    what a person can read, and what it cannot read is not in the picture. The errors by the key,
    of ``direction``, and the errors of ``value`` belong to readers who know nothing but what stands
    beside the picture.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh as the picture shows it: surfaces, lines, points, or blocks of them.
    scene : Scene
        Lights, material and view, in the unit of the mesh.
    tangents : str or array_like, optional
        Name of a point array of 3 or 6 components, or its values, as for
        :func:`vizlight.illuminate`.
    scalars : str or array_like, shape (N,) or (N, c), optional
        Point array whose values colour the picture, as for :func:`vizlight.tint`. Default: none,
        and no figures of ``value``.
    cmap : str, list, matplotlib colormap or pyvista.LookupTable, optional
        Colour map of the values. Default: as for :func:`vizlight.tint`.
    clim : (float, float) or float, optional
        Values at the ends of the colour map. Default: smallest and largest value.
    conditioned : bool, default: False
        Whether tangents inherit the self-shadow of the surface (Banks 6).
    exponent : float or "compensated"
        Exponent of the diffuse term, as for :func:`vizlight.illuminate`.
    model : {"phong", "blinn", "cylinder"}
        Reflection model of the highlight.
    view : View or pyvista.Camera, optional
        Eye. Default: the view of the scene, else the isometric view that shows the whole mesh. A
        view with a direction alone shows the whole mesh; a perspective one has an angle of 30
        degrees; a camera is taken as it is.
    noise : float, default: 2/255
        Standard deviation of the noise in each channel that the observers of direction, slope and
        shape get, beside rounding to bytes. Values are read off the bytes of the picture.
    samples : int, default: 4096
        Largest number of pixels that are measured.
    seed : int, default: 0
        Seed of the drawing of pixels and of the noise.

    Returns
    -------
    Legibility
        Figures of ``direction``, ``slope``, ``shape`` and ``value``, each None where the data have
        no such question. It prints as a table.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, an array is missing, no point is visible, or scene and mesh
        are not in 3-space.

    Notes
    -----
    *direction*: the candidates for a tangent are the 180 directions in the tangent plane, which is
    known; for a point without normal those about the line of sight. The reader by the key knows no
    normal: he finds the hue of a pixel on a small disc that faces the eye and has tangents in all
    directions, and takes the direction there; tangents that run toward the eye are not asked for.
    Under a single hue he always takes one direction, which is right where the data have one.
    *slope*: rank correlation and information use CIELAB's lightness alone; an ideal observer
    who knows the course of a line in the picture tells its direction in space.
    *shape*: 900 normals; where there are tangents, which are unknown, 300 with 72 tangents each.
    *value*: the nearest colour of the bar in CIELAB, and the nearest chromaticity.

    The meter is held by cases with known answers. A plane that faces the eye under one oblique
    white lamp leaves the mirror image as likely as the truth: 0.56 of the directions are within 10
    degrees. Two colours 60 degrees apart resolve it; 90 degrees apart they do not, since they are
    mirror images again. A headlight on such a plane tells nothing: 45 degrees, 1/9, 0 bits. The
    light of a cylinder under a headlight falls with the slope, rank correlation -1, but which end
    of a line is near stays unknown. Three lamps at right angles in red, green and blue solve for
    the normal of a ball (photometric stereo, Woodham 1980). Unlit colours are read to half a step
    of the bar, and colours of other values at random, 0.29 of the range.

    A million points take about 6 s of processor time, including 2 s for the picture and 2 s for the
    normals of the surface. Beside what these two need, and points and tangents, memory does not
    depend on the number of points; it is up to 200 MB.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> ball = pv.Sphere()
    >>> lamps = [
    ...     vizlight.Light(direction=way, color=color)
    ...     for way, color in [((1, 0, 0), "red"), ((0, 1, 0), "lime"), ((0, 0, 1), "blue")]
    ... ]
    >>> scene = vizlight.Scene(lights=lamps, material=vizlight.Material(specular=0))
    >>> found = vizlight.legibility(ball, scene, samples=256)
    >>> found.shape.median < 5
    True
    >>> found.direction is None
    True
    """
    _check.instance("scene", scene, Scene)
    noise = _check.number("noise", noise, low=0.0, high=1.0)
    samples = _check.integer("samples", samples, low=1, high=1 << 24)
    seed = _check.integer("seed", seed, low=0)
    if scalars is None and (cmap is not None or clim is not None):
        name = "cmap" if cmap is not None else "clim"
        raise ValueError(_check.message(name, "scalars= beside it", "none"))
    conditioned = _check.boolean("conditioned", conditioned)
    options = LightOptions(
        tangents=tangents, conditioned=conditioned, exponent=exponent, model=model
    )
    blocks.check(mesh)
    camera, scene = seen_from(mesh, scene, view)
    parts = parts_of(mesh, scene, options, scalars)
    scene = lighting.fit_depth_cue(scene, [part.inputs.points for part in parts])
    taken, pixels, drawn = places_of(parts, camera, scene, samples, np.random.default_rng(seed))
    notes: list[str] = []
    lamps = any(light.intensity > 0 for light in scene.lights)
    if not lamps:
        notes.append("the scene has no lamp: light tells no direction, slope or shape")
    asked = [one for one, _ in taken] if lamps else []
    table = None
    if scalars is not None:
        values = [np.asarray(part.values) for part in parts]
        if any(own.ndim == 2 for own in values):
            got, remedy = "colours of three or four bytes", "name the array that they show"
            raise ValueError(_check.message("scalars", "values to read", got, remedy))
        table = color_table(values, cmap=cmap, clim=clim)
    found: Keywords = {}
    for question, (measure, has_it, what) in QUESTIONS.items():
        # Each question begins with the same seed, so that its figures do not depend on the
        # questions before.
        own = _with_data([one for one in asked if has_it(one)], question, what, notes)
        found[question] = measure(own, np.random.default_rng(seed), noise) if own else None
    toward = -np.array(camera.GetDirectionOfProjection())
    return Legibility(
        **found,
        value=None if table is None else of_value(taken, table, notes),
        pixels=pixels,
        drawn=drawn,
        toward_eye=(float(toward[0]), float(toward[1]), float(toward[2])),
        noise=noise,
        seed=seed,
        notes=tuple(notes),
    )
