"""What a meter found: figures of each question, as attributes, text, HTML and a dict."""

from __future__ import annotations

import dataclasses
import html
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight.observers import direction, shape, slope, value
from vizlight.observers.colors import lab, seen

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pyvista as pv

    from vizlight._types import Array, Vector
    from vizlight.observers.samples import Part, Sample


#: A row of the table: question, figure, value and what guessing gives.
Row = tuple[str, str, str, str]


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

    def rows(self) -> Iterator[Row]:
        """Yield rows of the table."""
        yield "direction", "within 10 degrees", f"{self.within_10:.1%}", "11.1%"
        yield "", "median error", f"{self.median:.2f} degrees", "45"
        yield "", "information", f"{self.bits:.2f} bits", "0"
        if self.legend_median is not None:
            yield "", "median error by the key", f"{self.legend_median:.2f} degrees", "45"


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

    def rows(self) -> Iterator[Row]:
        """Yield rows of the table."""
        yield "slope", "rank correlation", f"{self.spearman:+.2f}", "0"
        yield "", "information", f"{self.bits:.2f} bits", "0"
        if self.within_10 is not None:
            yield "", "in space, within 10 degrees", f"{self.within_10:.1%}", ""
        if self.median is not None:
            yield "", "in space, median error", f"{self.median:.2f} degrees", ""


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

    def rows(self) -> Iterator[Row]:
        """Yield rows of the table."""
        yield "shape", "median error of the normal", f"{self.median:.2f} degrees", "45 degrees"
        yield "", "information", f"{self.bits:.2f} bits", "0"


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

    def rows(self) -> Iterator[Row]:
        """Yield rows of the table."""
        yield "value", "95 % of the errors, nearest colour", f"{self.p95:.1%} of the range", ""
        yield "", "median, largest", f"{self.median:.1%}, {self.largest:.1%}", ""
        yield "", "95 % by chromaticity", f"{self.p95_chromaticity:.1%} of the range", ""
        both = f"{self.median_chromaticity:.1%}, {self.largest_chromaticity:.1%}"
        yield "", "median, largest", both, ""


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

    def _rows(self) -> list[Row]:
        asked = (self.direction, self.slope, self.shape, self.value)
        return [row for one in asked if one is not None for row in one.rows()]

    def _lines(self) -> list[str]:
        where = "visible pixels" if self.drawn else "points that face the eye; no picture was drawn"
        noise = f"noise {255 * self.noise:g}/255, seed {self.seed}"
        return [
            f"{self.pixels} {where}; {noise}",
            "ideal observers, but for the key: an upper bound of what a person reads",
            *(f"note: {note}" for note in self.notes),
        ]

    def __str__(self) -> str:
        rows = [("question", "figure", "found", "chance"), *self._rows()]
        wide = [max(len(row[i]) for row in rows) for i in range(3)]
        lines = [
            f"{row[0]:<{wide[0]}}  {row[1]:<{wide[1]}}  {row[2]:<{wide[2]}}  {row[3]}".rstrip()
            for row in rows
        ]
        return "\n".join([*lines, *self._lines()])

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in ("question", "figure", "found", "chance"))
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self._rows()
        )
        below = "<br>".join(html.escape(line) for line in self._lines())
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{below}</p>"

    def to_dict(self) -> dict[str, object]:
        """Return all figures as nested dicts of plain values, for JSON."""
        return dataclasses.asdict(self)


def of_direction(
    samples: list[Sample], seed: int, noise: float, notes: list[str]
) -> Direction | None:
    """Return the figures of direction; what has none, or was left out, is added to the notes."""
    asked = direction.directed(samples)
    own = _with_data(asked, "direction", "tangents or normals", notes)
    if not own:
        return None
    random = np.random.default_rng(seed)
    found = [direction.ideal(one, random, noise) for one in own]
    middle = np.concatenate([one.points for one in own]).mean(axis=0)
    by_key = np.concatenate([direction.by_key(one, middle, random, noise) for one in own])
    error = np.concatenate([each.error for each in found])
    return Direction(
        within_10=float((error <= 10).mean()),
        median=float(np.median(error)),
        bits=float(np.concatenate([each.bits for each in found]).mean()),
        legend_median=float(np.median(by_key)) if len(by_key) else None,
        samples=len(error),
    )


def _with_data(samples: list[Sample], question: str, what: str, notes: list[str]) -> list[Sample]:
    """Return the places where vectors have a direction, and note how many were left out."""
    kept = [one.take(one.valid) for one in samples]
    total, left = sum(map(len, samples)), sum(map(len, kept))
    if left < total:
        notes.append(f"{question}: {total - left} of {total} places have zero {what}, left out")
    return [one for one in kept if len(one)]


def of_slope(samples: list[Sample], seed: int, noise: float, notes: list[str]) -> Slope | None:
    """Return the figures of slope; what has none, or was left out, is added to the notes."""
    asked = [
        one
        for one in samples
        if one.kind == "line" and one.tangents is not None and one.tangents.shape[1] == 1
    ]
    own = _with_data(asked, "slope", "tangents", notes)
    if not own:
        return None
    random = np.random.default_rng(seed)
    steep: list[Array] = []
    light: list[Array] = []
    for one in own:
        steep.append(slope.steepness(one))
        light.append(lab(seen(one.own_light(), random, noise))[:, 0])
    error = np.concatenate([slope.in_space(one, random, noise) for one in own])
    steepness, lightness = np.concatenate(steep), np.concatenate(light)
    return Slope(
        spearman=slope.rank_correlation(lightness, steepness),
        bits=slope.mutual_information(steepness, lightness),
        within_10=float((error <= 10).mean()) if len(error) else None,
        median=float(np.median(error)) if len(error) else None,
        samples=len(steepness),
    )


def of_shape(samples: list[Sample], seed: int, noise: float, notes: list[str]) -> Shape | None:
    """Return the figures of shape; what has none, or was left out, is added to the notes."""
    asked = [one for one in samples if one.kind != "line" and one.normals is not None]
    own = _with_data(asked, "shape", "tangents or normals", notes)
    if not own:
        return None
    random = np.random.default_rng(seed)
    found = []
    for one in own:
        few = random.permutation(len(one))[: shape.most(one)]
        found.append(shape.ideal(one.take(np.sort(few)), random, noise))
    error = np.concatenate([each.error for each in found])
    return Shape(
        median=float(np.median(error)),
        bits=float(np.concatenate([each.bits for each in found]).mean()),
        samples=len(error),
    )


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
    read = []
    left = 0
    for one, part in taken:
        assert one.values is not None
        # Points without light have the colour of what is not data.
        known = np.isfinite(one.values) & one.valid
        left += int(np.count_nonzero(~known))
        own = one.take(known)
        if len(own):
            assert own.values is not None
            positions = np.clip((own.values - low) / (high - low), 0.0, 1.0)
            read.append(value.decode(value.lit_colors(part, own, table), positions, bar))
    if left:
        total = sum(len(one) for one, _ in taken)
        notes.append(f"value: {left} of {total} places have no value, left out")
    if not read:
        return None
    nearest = np.concatenate([each.nearest for each in read])
    chromatic = np.concatenate([each.chromatic for each in read])
    return Value(
        median=float(np.median(nearest)),
        p95=float(np.quantile(nearest, 0.95)),
        largest=float(nearest.max()),
        median_chromaticity=float(np.median(chromatic)),
        p95_chromaticity=float(np.quantile(chromatic, 0.95)),
        largest_chromaticity=float(chromatic.max()),
        samples=len(nearest),
    )
