"""The figures of legibility, and how they are printed."""

from __future__ import annotations

import dataclasses
import html
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from vizlight import _check

if TYPE_CHECKING:
    from vizlight._types import Keywords, Vector

#: Least information in bits of a question that can be read.
FLOOR = 0.3
HEAD = ("question", "figure", "read", "chance")


@dataclass(frozen=True, kw_only=True)
class Figure:
    """Figure of one question.

    Attributes
    ----------
    bits : float
        Information that the picture, as the eye sees it, gives about equally likely candidates.
    most : float
        Bits that a reader has who is sure of the right candidate everywhere, the most possible:
        the logarithm of the number of candidates, of their classes where they are ranked.
    readable : float
        Share of the drawn places at which the answer is right within a tolerance, less that of
        guessing (Abbott 1925): 0 is chance, 1 is all of the picture.
    samples : int
        Number of places.
    reason : str
        Why the question is unreadable, empty where it is not. The errors are then those of chance.
    chance : float
        Result of guessing: the median error of angles and values, the rank correlation of a
        magnitude, the share of right answers of two.
    """

    bits: float
    most: float
    readable: float
    samples: int
    reason: str = ""
    chance: float = 0.0

    #: Share of answers that are within the tolerance by chance.
    guessed: ClassVar[float] = 0.3
    #: Rows of the table: attribute, words, form, and what guessing gives.
    ROWS: ClassVar[tuple[tuple[str, str, str, str], ...]] = ()

    @property
    def unreadable(self) -> bool:
        """Whether the picture tells less than 0.3 bits of the question."""
        return bool(self.reason)

    @property
    def score(self) -> float:
        """Bits in those of an answer within the tolerance, the figure by which questions compare.

        A reader has room for ``1 / guessed`` answers that far apart, and needs ``-log2(guessed)``
        bits to tell one from the others. The score is 0 where a question is unreadable, and above 1
        for a picture that tells more than is asked.
        """
        return 0.0 if self.unreadable else self.bits / -math.log2(self.guessed)

    def rows(self) -> list[tuple[str, str, str]]:
        """Return words, figure and chance of each row of the table; ``chance`` if unreadable."""
        more = (
            ("bits", "information", f"{{:.2f}} of {self.most:.1f} bits", "0"),
            ("readable", "readable share of the picture", "{:.0%}", "0%"),
        )
        answers = [
            (words, "chance" if self.unreadable else form.format(getattr(self, name)), chance)
            for name, words, form, chance in self.ROWS
        ]
        return answers + [
            (words, form.format(getattr(self, name)), chance) for name, words, form, chance in more
        ]


@dataclass(frozen=True, kw_only=True)
class Direction(Figure):
    """Course of tangents in the picture, read by hues of the key or by the form of marks.

    Attributes
    ----------
    within_10 : float
        Share of the places where the answer is wrong by 10 degrees at most; 1/9 by chance.
    median : float
        Median error in degrees; 45 by chance.
    """

    within_10: float
    median: float
    chance: float = 45.0

    guessed = 1 / 6
    ROWS = (
        ("within_10", "within 10 degrees", "{:.1%}", "11.1%"),
        ("median", "median error", "{:.1f} degrees", "45"),
    )


@dataclass(frozen=True, kw_only=True)
class Slope(Figure):
    """How steeply lines run toward the eye, told by lightness.

    Attributes
    ----------
    spearman : float
        Rank correlation of lightness with steepness, the cosine of the angle between a line and
        the line of sight; -1 or 1 where lightness orders all lines, 0 by chance. ``bits`` compare
        32 classes of lightness with 16 of steepness, and are 4 at most.
    """

    spearman: float

    ROWS = (("spearman", "rank correlation", "{:+.2f}", "0"),)


@dataclass(frozen=True, kw_only=True)
class Heading(Direction):
    """Direction of lines in space, including which end is nearer.

    The reader knows the course of a line in the picture, and finds its colour on a key of all
    directions. ``within_10`` and ``median`` are those of angles in space.
    """


@dataclass(frozen=True, kw_only=True)
class Shape(Figure):
    """Normals of surfaces: a reader finds their colours on a ball in the same light.

    Attributes
    ----------
    median : float
        Median error in degrees of the normal; 45 by chance.
    """

    median: float
    chance: float = 45.0

    #: By the direction of the eye as the answer: sin^2.
    guessed = 0.117
    ROWS = (("median", "median error of the normal", "{:.1f} degrees", "45"),)


@dataclass(frozen=True, kw_only=True)
class Value(Figure):
    """Values as they are read off the colour bar, as shares of the range of the bar.

    Attributes
    ----------
    median, p95, largest : float
        Median, 95 % quantile and largest error; 0.25, 0.475 and 0.5 of a reader who always says
        the middle of the bar.
    """

    median: float
    p95: float
    largest: float
    chance: float = 0.25

    guessed = 0.2
    ROWS = (
        ("median", "median error, nearest colour of the bar", "{:.1%} of the range", "25%"),
        ("p95", "95 % of the errors", "{:.1%} of the range", "48%"),
        ("largest", "largest error", "{:.1%} of the range", "50%"),
    )


@dataclass(frozen=True, kw_only=True)
class Speed(Figure):
    """Length of vectors, told by lightness or chroma, or by the length of glyphs.

    Attributes
    ----------
    spearman : float
        Rank correlation of the length with the signal that tells most; 0 by chance.
        ``bits`` compare 32 classes of the signal with 16 of the length, and are 4 at most.
    """

    spearman: float

    ROWS = (("spearman", "rank correlation", "{:+.2f}", "0"),)


@dataclass(frozen=True, kw_only=True)
class TwoSided(Figure):
    """Answers to a question of two sides: right at some places, wrong or none at others.

    ``readable`` is the share of right answers minus the share of wrong ones. ``bits`` is the
    information per place, at most 1, as for a yes or no.

    Attributes
    ----------
    told : float
        Share of the places at which the answer is right; 0.5 by chance, as ``wrongly``. Where the
        question is unreadable the reason has the counts.
    wrongly : float
        Share at which it is wrong.
    """

    told: float
    wrongly: float
    most: float = 1.0
    chance: float = 0.5

    guessed = 0.5
    ROWS = (("told", "told", "{:.0%}", "50%"), ("wrongly", "told wrongly", "{:.0%}", "50%"))


@dataclass(frozen=True, kw_only=True)
class Order(TwoSided):
    """Which of two lines is nearer where they cross: the one that goes on across the crossing.

    Places are crossings at 30 degrees or more without a third line beside them.
    """


@dataclass(frozen=True, kw_only=True)
class Sense(TwoSided):
    """Which of two opposite ways a stroke or a glyph runs, told by its form or lightness along it.

    Places are those on strokes and glyphs, which ``samples`` counts. Of all strokes a reader takes
    the same end to be ahead, the wider, the narrower, the lighter or the darker one, whichever is
    right more often. The form of glyphs is known.
    """


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Finest structure of the data that is still read.

    Structure is the length in the picture within which the data turn by 90 degrees, or go through
    half of the range of the bar. By chance none is read.

    Attributes
    ----------
    question : str
        Question about the data.
    pixels : float or None
        Least structure in pixels at which half of the answers are right beyond chance; None where
        none is, and where the question is unreadable.
    length : float or None
        The same in the unit of the mesh.
    median : float
        Median structure of the data in pixels.
    """

    question: str
    pixels: float | None
    length: float | None
    median: float

    def rows(self) -> list[tuple[str, str, str]]:
        """Return words, figure and chance of each row of the table."""
        finest = "none" if self.pixels is None else f"{self.pixels:.3g} pixels"
        if self.length is not None:
            finest += f", {self.length:.3g} of the unit"
        words = f"finest structure read of {self.question}"
        return [(words, finest, "none"), ("median structure", f"{self.median:.3g} pixels", "")]


@dataclass(frozen=True, kw_only=True)
class Legibility:
    """Figures of what a reader can read back from a picture; see :func:`vizlight.legibility`.

    Attributes
    ----------
    direction : Direction or None
        Which way tangents run by hues, or by lines, glyphs and textures; None without lines, and
        without single tangents on a surface or at points.
    slope : Slope or None
        How steeply lines run toward the eye; None without lines.
    heading : Heading or None
        Direction of lines in space, lit or in the colours of its axes; None without lines.
    sense : Sense or None
        Which of two opposite ways strokes and glyphs run; None without glyphs and without lines
        that have a sense by vectors or time of integration, and for fewer than 8 of both.
    order : Order or None
        Which of two crossing lines is nearer; None without crossings.
    shape : Shape or None
        How surfaces stand; None without a surface or normals.
    value : Value or None
        Values as they are read off the bar; None without scalars.
    speed : Speed or None
        Length of vectors; None without vectors of several lengths.
    scale : Scale or None
        Finest structure that is read, of the first of direction, value and shape that has a figure.
    pixels : int
        Number of pixels that show the data.
    size : (int, int)
        Width and height of the picture in pixels.
    size_mm, distance_mm : float
        Width of the picture, and distance of the eye, in mm.
    toward_eye : tuple of float
        Direction from the middle of the picture toward the eye.
    noise : float
        Standard deviation of the noise of the eye in CIELAB.
    seed : int
        Seed of the drawing of places and of the noise.
    notes : tuple of str
        Questions without a figure, and data that were left out.
    """

    direction: Direction | None = None
    slope: Slope | None = None
    heading: Heading | None = None
    sense: Sense | None = None
    order: Order | None = None
    shape: Shape | None = None
    value: Value | None = None
    speed: Speed | None = None
    scale: Scale | None = None
    pixels: int
    size: tuple[int, int]
    size_mm: float
    distance_mm: float
    toward_eye: Vector
    noise: float
    seed: int
    notes: tuple[str, ...] = ()

    @property
    def unreadable(self) -> dict[str, str]:
        """Questions that the picture does not answer, each with the reason."""
        return {
            name: figure.reason
            for name in QUESTIONS
            if isinstance(figure := getattr(self, name), Figure) and figure.unreadable
        }

    def without(self, *questions: str) -> Legibility:
        """Return the figures but for those of some questions, and a scale that is of these.

        Parameters
        ----------
        *questions : str
            Names of figures.

        Returns
        -------
        Legibility

        Raises
        ------
        ValueError
            If no figure has such a name.
        """
        for question in questions:
            _check.choice("questions", question, QUESTIONS)
        names: Keywords = dict.fromkeys(questions)
        if self.scale is not None and self.scale.question in questions:
            names["scale"] = None
        return dataclasses.replace(self, **names)

    def _rows(self) -> list[tuple[str, ...]]:
        rows = list[tuple[str, ...]]()
        for question in QUESTIONS:
            figure: Figure | Scale | None = getattr(self, question)
            if figure is not None:
                for number, row in enumerate(figure.rows()):
                    rows.append(("" if number else question, *row))
        return rows

    def _lines(self) -> list[str]:
        width, height = self.size
        return [
            *(f"{name} is unreadable: {reason}" for name, reason in self.unreadable.items()),
            f"{self.pixels} pixels of {width} x {height}, {self.size_mm:.3g} mm wide, seen from "
            f"{self.distance_mm:.3g} mm; noise of the eye {self.noise:g} in CIELAB, "
            f"seed {self.seed}",
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


#: Figures that are printed, in their order.
QUESTIONS = tuple(entry.name for entry in dataclasses.fields(Legibility) if entry.default is None)
