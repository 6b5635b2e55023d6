"""From a picture and the data behind it to figures: places, colours, readers, reasons."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt

from vizlight import _check
from vizlight.draw.cameras import footprint
from vizlight.filters.key import color_below
from vizlight.geometry.lines.simplices import Columns
from vizlight.observers import crossings, readers
from vizlight.observers.eye import Eye, means
from vizlight.observers.figures import (
    FLOOR,
    Direction,
    Figure,
    Heading,
    Legibility,
    Order,
    Scale,
    Sense,
    Shape,
    Slope,
    Speed,
    TwoSided,
    Value,
)
from vizlight.observers.lines import (
    CHANNELS,
    SEEN,
    above_ground,
    ahead_of,
    along_grain,
    glyphs_of,
    grain_of,
    lengths_of,
    segments_of,
    strokes_of,
    turned_lines,
    two_sides,
)
from vizlight.observers.pixels import Pixels, courses, visible
from vizlight.observers.samples import sample
from vizlight.shading import display

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkActor

    from vizlight._types import Array, Bools, Indices, Keywords, Vector
    from vizlight.observers.eye import SeenPicture
    from vizlight.observers.lines import Glyphs, Segments, Strokes
    from vizlight.observers.readers import Colors, Reading
    from vizlight.observers.samples import Sample, SeenMesh

#: Largest number of places at which normals are read, each among 900 or more.
NORMALS = 1024
#: Structure in arc minutes below which data turn too fast for the hues of a picture: half of the
#: period at which the eye passes half of the contrast of red and green.
FAST = 6.0
#: Angle in degrees through which data turn in a structure.
TURN = 90.0
#: Length in pixels from which on a structure is none.
LONGEST = 1 << 12
#: Least number of places of a class of structure, and least readable share of it.
FEW, HALF = 32, 0.5
#: Share of the error of chance above which an answer is chance.
NEAR = 0.9
#: Distance in arc minutes from another mesh beyond which that hardly changes a colour (the
#: filter of lightness is 2.8 wide at half height), and how far away a reader looks for such a
#: place.
BLURRED, CLOSE = 2.5, 10.0
#: Length in arc minutes of a piece of a line that is seen as one colour.
PIECE = 8.0
#: Number of pixels that are part of no whole; those of pieces of lines are less.
NO_THING = -1
#: Least number of strokes that are asked for their sense.
STROKES = 8
#: Tolerance of an answer that is right: degrees of directions, degrees of normals, share of a bar,
#: share of the ranks.
TOLERANCE = {"direction": 15.0, "heading": 15.0, "shape": 20.0, "value": 0.1, "rank": 0.15}
#: Figures of the questions that are answered by matched colours.
MATCHED: dict[str, type[Figure]] = {
    "direction": Direction,
    "heading": Heading,
    "shape": Shape,
    "value": Value,
}


@dataclass(frozen=True)
class SeenPlaces(Columns):
    """Places of one mesh in the picture.

    ``here``, ``right`` and ``up`` are data at the places, and a pixel beside and above or below
    them; ``apart`` says that both neighbours show the same mesh. ``unit`` is the size of a pixel in
    the unit of the mesh, ``grain`` that of :func:`vizlight.observers.lines.along_grain`, ``course``
    the directions of single tangents in the picture in degrees, from right toward up, ``thing`` the
    numbers of the things seen as a whole, ``NO_THING`` on surfaces, and ``length`` the lengths in
    pixels at which glyphs are seen.
    """

    part: SeenMesh
    here: Sample
    right: Sample
    up: Sample
    apart: Bools
    colors: Colors
    unit: Array
    grain: Array
    course: Array
    thing: Indices
    length: Array | None = None

    def structure(self, turn: Callable[[Sample], Array], times: int = 1) -> Array:
        """Return the length in pixels within which data turn by 90 degrees, NaN where flat.

        ``turn`` takes a sample to unit vectors; angles between these are ``times`` those of the
        data.
        """
        here = turn(self.here)
        steps = []
        for other in (self.right, self.up):
            cosine = np.einsum("ij,ij->i", here, turn(other))
            steps.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
        change = np.hypot(*steps) / times
        # What is longer than any picture is flat.
        change[~self.apart | (change < TURN / LONGEST)] = np.nan
        return np.asarray(TURN / change)


def measure(
    picture: Array,
    parts: Sequence[SeenMesh],
    camera: pv.Camera,
    *,
    size_mm: float,
    distance_mm: float,
    noise: float,
    samples: int,
    seed: int,
    occluders: Sequence[vtkActor] = (),
    notes: Sequence[str] = (),
) -> Legibility:
    """Return the figures of a picture.

    The picture (H, W, 3) has sRGB values from 0 to 1; ``size_mm`` is its width, ``distance_mm``
    that of the eye, and ``noise`` that of the eye in CIELAB. ``occluders`` hide the meshes, and
    ``notes`` are on data that are left out already.
    """
    height, width = picture.shape[:2]
    eye = Eye.at(width, size_mm, distance_mm, noise)
    pixels = visible([part.drawn for part in parts], camera, (width, height), occluders)
    if not len(pixels.row):
        remedy = "pass view= with a direction, or a camera that looks at the mesh"
        raise ValueError(_check.message("mesh", "a point that the eye sees", "none", remedy))
    number = np.full((height, width), -1, dtype=np.intp)
    number[pixels.row, pixels.column] = np.arange(len(pixels.row))
    lines, glyphs = segments_of(parts, pixels, camera), glyphs_of(parts, pixels, camera)
    seen = eye.look(picture, number >= 0)
    ahead, areas, lengths = _of_glyphs(glyphs, lines, seen, eye)
    thing = _things(pixels, parts, lines, glyphs, eye)
    random = np.random.default_rng(seed)
    has_marks = any(part.by_form and part.has_tangents for part in parts)
    grain = grain_of(seen, eye, seed) if has_marks else np.zeros((height, width, CHANNELS, 3))
    has = _Seen(pixels, number, camera, eye, thing, *_as_things(seen, grain, pixels, thing), random)
    chosen = np.sort(random.permutation(len(pixels.row))[:samples])
    groups = []
    for i, part in enumerate(parts):
        ids = chosen[pixels.part[chosen] == i]
        if len(ids):
            places = has.places(part, number[_between(pixels, number, i, ids, eye)])
            if glyphs is not None and part.glyph is not None:
                glyph = places.thing - (len(parts) << 40)
                places = dataclasses.replace(places, length=lengths[glyph])
            groups.append(places)
    reader = _PictureReader(groups, seed, eye, list(notes))
    figures = reader.figures()
    answers = ahead[np.isfinite(ahead)]
    weights = areas[np.isfinite(ahead)]
    if lines is not None:
        at_crossings = crossings.crossings_of(lines, samples, np.random.default_rng(seed))
        figures["order"] = _order(crossings.answers(at_crossings, lines, seen, noise))
        if figures["order"] is None:
            reader.notes.append(_without_order(at_crossings.left_out))
        strokes = strokes_of(lines, turned_lines(parts, pixels, camera, occluders), seen, eye)
        answers = np.concatenate([answers, _of_strokes(strokes, noise)])
        weights = np.concatenate([weights, strokes.pixels])
    figures["sense"] = _sense(answers, weights)
    return Legibility(
        **figures,
        scale=reader.scale,
        pixels=len(pixels.row),
        size=(width, height),
        size_mm=size_mm,
        distance_mm=distance_mm,
        toward_eye=toward(camera),
        noise=noise,
        seed=seed,
        notes=tuple(reader.notes),
    )


class _Seen(NamedTuple):
    """A picture as a reader has it."""

    pixels: Pixels
    number: Indices
    camera: pv.Camera
    eye: Eye
    thing: Indices
    things: SeenPicture
    tensor: Array
    random: np.random.Generator

    def places(self, part: SeenMesh, ids: Indices) -> SeenPlaces:
        """Return the places of some pixels, all of which show one mesh."""
        pixels, camera = self.pixels, self.camera
        chosen = pixels[ids]
        share = self.eye.share(part.width) if part.kind == "point" else None
        colors = readers.colors_at(
            self.things, chosen.row, chosen.column, self.random, self.eye.noise, share
        )
        beside = [_beside(pixels, self.number, ids, step) for step in ((0, 1), (1, 0))]
        places = sample(part, pixels[np.concatenate([ids, *beside])], camera)
        here, right, up = (places[np.arange(len(ids)) + i * len(ids)] for i in range(3))
        course = np.zeros(len(ids))
        if here.tangents is not None and here.has_one_tangent:
            way = courses(camera, pixels.size, here.points, here.tangents[:, 0])
            course = np.degrees(np.arctan2(-way[:, 1], way[:, 0]))
        return SeenPlaces(
            part=part, here=here, right=right, up=up, colors=colors, course=course,
            apart=(beside[0] != ids) & (beside[1] != ids), thing=self.thing[ids],
            unit=footprint(camera, here.points, pixels.size[1]),
            grain=along_grain(self.tensor[chosen.row, chosen.column]),
        )  # fmt: skip


def _as_things(
    seen: SeenPicture, grain: Array, pixels: Pixels, thing: Indices
) -> tuple[SeenPicture, Array]:
    """Return the picture and its grain with one colour and one grain for all of each thing."""
    whole = thing != NO_THING
    row, column = pixels.row[whole], pixels.column[whole]
    group = np.unique(thing[whole], return_inverse=True)[1]
    own = grain[row, column].reshape(len(row), 3 * CHANNELS)
    grain[row, column] = means(own, group)[group].reshape(len(row), CHANNELS, 3)
    return seen.pooled(row, column, group), grain


def toward(camera: pv.Camera) -> Vector:
    """Return the direction from the middle of a picture toward the eye."""
    x, y, z = camera.GetDirectionOfProjection()
    return -x, -y, -z


def _things(
    pixels: Pixels,
    parts: Sequence[SeenMesh],
    lines: Segments | None,
    glyphs: Glyphs | None,
    eye: Eye,
) -> Indices:
    """Return numbers of the things seen as a whole: a point, a glyph, a piece of a line.

    Pixels of surfaces have none, ``NO_THING``.
    """
    row, column = pixels.row, pixels.column
    thing = np.full(len(row), NO_THING, dtype=np.int64)
    point = np.array([part.kind == "point" for part in parts])[pixels.part]
    thing[point] = (pixels.part[point] << 40) + pixels.cell[point]
    if lines is not None:
        line = lines.number[row, column] >= 0
        segment, along = lines.places(row[line], column[line])
        piece = np.nan_to_num(along * 60 / eye.pixels_per_degree // PIECE).astype(np.intp)
        thing[line] = NO_THING - 1 - (lines.line[segment] << 40) - piece
    if glyphs is not None:
        glyph = glyphs.number[row, column]
        thing[glyph >= 0] = (len(parts) << 40) + glyph[glyph >= 0]
    return thing


def _of_glyphs(
    glyphs: Glyphs | None, lines: Segments | None, seen: SeenPicture, eye: Eye
) -> tuple[Array, Array, Array]:
    """Return the senses that glyphs tell, their numbers of pixels, and their lengths in pixels."""
    if glyphs is None:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    covered = glyphs.number >= 0
    if lines is not None:
        covered |= lines.number >= 0
    # Ground is where no glyph would be either if it were turned.
    ink = np.linalg.norm(above_ground(seen, covered | (glyphs.turned >= 0), eye), axis=2)
    ahead = ahead_of(glyphs.number, glyphs.turned, ink, ~covered, eye)
    pixels = np.bincount(glyphs.number[glyphs.number >= 0], minlength=len(ahead))
    return ahead, pixels.astype(np.float64), lengths_of(glyphs, ink, SEEN * eye.noise)


def _between(
    pixels: Pixels, number: Indices, part: int, ids: Indices, eye: Eye
) -> tuple[Indices, Indices]:  # fmt: skip
    """Return where a reader looks at pixels of a mesh: close by, but not beside another mesh.

    Things over a surface, such as lines, colour their surroundings; a reader looks between.
    Without a place within 10 arc minutes that is free of the other the pixel itself is taken.
    """
    row, column = pixels.row[ids], pixels.column[ids]
    others = pixels.part != part
    if not others.any():
        return row, column
    other = np.zeros(number.shape, dtype=np.bool_)
    other[pixels.row[others], pixels.column[others]] = True
    alone = (number >= 0) & ~other
    minute = eye.pixels_per_degree / 60
    free = alone & (distance_transform_edt(~other) > BLURRED * minute)
    if not free.any():
        return row, column
    far, near = distance_transform_edt(~free, return_indices=True)
    close = far[row, column] <= CLOSE * minute
    rows = np.where(close, near[0][row, column], row)
    return rows, np.where(close, near[1][row, column], column)


def _beside(pixels: Pixels, number: Indices, ids: Indices, step: tuple[int, int]) -> Indices:
    """Return the pixels one step on either side of pixels, of the same mesh; else themselves."""
    beside = ids.copy()
    for sign in (-1, 1):
        row = np.clip(pixels.row[ids] + sign * step[0], 0, number.shape[0] - 1)
        column = np.clip(pixels.column[ids] + sign * step[1], 0, number.shape[1] - 1)
        other = number[row, column]
        fits = (other >= 0) & (pixels.part[np.maximum(other, 0)] == pixels.part[ids])
        # Beyond the border of the picture there is only the pixel itself.
        beside = np.where(fits & (other != ids), other, beside)
    return np.asarray(beside)


def _order(answers: Array) -> Order | None:
    """Return the figure of answers at crossings: 1 is right, -1 wrong, 0 none."""
    if not len(answers):
        return None
    return Order(**_two_sided(answers, "draw halos, or lines of colours that differ"))


def _without_order(left_out: int) -> str:
    """Return why a picture of lines has no figure of order."""
    if not left_out:
        return "order: not measured, since no two lines are seen to cross at 30 degrees or more"
    crossings = "crossing is" if left_out == 1 else "crossings are"
    return (
        f"order: not measured, since no crossing without a third line was found; {left_out} "
        f"{crossings} beside one, or where a line ends"
    )


def _of_strokes(strokes: Strokes, noise: float) -> Array:
    """Return answers of sense by the lightness of both ends of strokes, or by their form."""
    answers = []
    for difference in (strokes.light, SEEN * noise * strokes.form):
        answer = np.sign(difference) * (np.abs(difference) >= SEEN * noise)
        # By the key or by some places a reader knows which end is which.
        answers.append(-answer if (answer * strokes.pixels).sum() < 0 else answer)
    return max(answers, key=lambda answer: float((answer * strokes.pixels).sum()))


def _sense(answers: Array, pixels: Array) -> Sense | None:
    """Return the figure of answers of strokes and glyphs: 1 is right, -1 wrong, 0 none."""
    if len(answers) < STROKES:
        return None
    remedy = "draw strokes that are tapered or have heads"
    return Sense(**_two_sided(answers, remedy, pixels / pixels.mean()))


def _two_sided(answers: Array, remedy: str, weights: Array | float = 1.0) -> Keywords:
    """Return the figures of answers of two sides; where they are chance the reason has counts."""
    right, wrong = (float(((sign * answers > 0) * weights).sum()) for sign in (1, -1))
    bits = two_sides(right, wrong, len(answers))
    common = {"bits": bits, "samples": len(answers)}
    if bits >= FLOOR:
        told, wrongly = right / len(answers), wrong / len(answers)
        return common | {"told": told, "wrongly": wrongly, "readable": told - wrongly}
    silent = right + wrong < len(answers) / 2
    why = "most places look alike on both sides" if silent else "too many places tell it wrongly"
    reason = f"{why}, {right:.0f} right and {wrong:.0f} wrong of {len(answers)}; {remedy}"
    shares = dict.fromkeys(("told", "wrongly"), TwoSided.chance)
    return common | shares | {"readable": 0.0, "reason": reason}


class _PictureReader:
    """The figures of places, question by question."""

    def __init__(self, groups: list[SeenPlaces], seed: int, eye: Eye, notes: list[str]) -> None:
        self.groups, self.eye, self.notes = groups, eye, notes
        self.random = np.random.default_rng(seed)
        # The key lies amid what it explains, since the light of near lamps depends on the place.
        self.middle = np.concatenate([p.here.points for p in groups]).mean(axis=0)
        self.scale: Scale | None = None

    def figures(self) -> Keywords:
        """Return the figures by their questions."""
        questions: dict[str, Callable[[], Figure | None]] = {
            "direction": self.direction, "value": self.value, "shape": self.shape,
            "slope": self.slope, "heading": self.heading, "speed": self.speed,
        }  # fmt: skip
        return {name: function() for name, function in questions.items()}

    def _with(self, question: str, has_it: Callable[[SeenPlaces], bool]) -> list[SeenPlaces]:
        """Return the places where a question of light has an answer, and note those without."""
        lit = [p for p in self.groups if p.part.lit or p.part.by_axes]
        some = [p for p in lit if has_it(p)]
        kept = [p[p.here.valid] for p in some]
        total, left = (sum(len(p.here) for p in each) for each in (some, kept))
        if left < total:
            text = "places have no direction of tangents or normals, left out"
            self.notes.append(f"{question}: {total - left} of {total} {text}")
        return [p for p in kept if len(p.here)]

    def _common(
        self, question: str, groups: list[SeenPlaces], readings: list[Reading], lengths: Array
    ) -> Keywords:
        """Return the common part of all figures of matched colours, and find the scale."""
        error = _errors(readings)
        bits = readers.bits_told(readings)
        right = error <= TOLERANCE[question]
        other = np.concatenate([reading.other_error for reading in readings])
        guessed = max(MATCHED[question].guessed, float((other <= TOLERANCE[question]).mean()))
        unit = np.concatenate([p.unit for p in groups])
        chance = MATCHED[question].chance
        unread = bits < FLOOR or float(np.median(error)) > NEAR * chance
        if self.scale is None and np.isfinite(lengths).any():
            # Where a question is unreadable, no structure is read but by chance.
            self.scale = _scale(question, lengths, unit, right & (not unread), guessed)
        return {
            "bits": bits,
            "most": readers.most_told(readings),
            "readable": 0.0 if unread else _beyond_chance(right, guessed),
            "samples": len(error),
            "reason": self._reason(question, groups, lengths) if unread else "",
        }

    def _reason(self, question: str, groups: list[SeenPlaces], lengths: Array) -> str:
        """Return why a question is unreadable."""
        finite = lengths[np.isfinite(lengths)]
        minutes = 60 / self.eye.pixels_per_degree
        if len(finite) and float(np.median(finite)) * minutes < FAST:
            turns = max(1, round(float(np.median(finite))))
            return f"the data turn within {turns} pixels; show less of them, or lines"
        by_form = question == "direction" and groups[0].part.by_form
        by_light = question in ("direction", "heading", "shape") and not by_form
        if by_light and any(p.part.values is not None for p in groups):
            return "the colours show values; draw the light without scalars"
        deviation = np.concatenate([p.colors.deviation for p in groups])
        colors = np.concatenate([p.colors.lab for p in groups])
        if float(np.median(deviation)) > 3 * self.eye.noise:
            return "what is drawn is finer than an eye resolves; draw it wider, or less of it"
        if by_form:
            return "marks are too fine or too faint, cross, or do not follow the data"
        # The standard deviation by the 10 % and 90 % quantiles, but for places at borders.
        spread = np.ptp(np.quantile(colors, (0.1, 0.9), axis=0), axis=0) / 2.563
        beyond = spread**2 - np.median(deviation, axis=0) ** 2
        if float(np.sqrt(beyond.max(initial=0.0))) < self.eye.noise:
            return "the colours differ by less than an eye tells apart"
        return "the colours do not follow the data as the key says; choose a light or a map for it"

    def direction(self) -> Direction | None:
        """Return which way tangents run in the picture, by hue or by form, whichever tells more."""
        by_hue = self._with("direction", lambda p: not p.part.by_form and p.here.has_one_tangent)
        some = [p for p in self.groups if p.part.by_form and p.here.has_one_tangent]
        by_form = _kept(some, lambda p: p.here.valid)
        start = float(self.random.uniform(0.0, 180.0)) if by_hue or by_form else 0.0
        by_hue, by_form = (
            _kept(groups, lambda p: readers.in_picture(p.here) > readers.SHORTEST)
            for groups in (by_hue, by_form)
        )
        # Whether marks are fine or coarse is seen by the whole picture.
        ways = [
            (by_form, [readers.read_grain(p.grain[:, i], p.course, start) for p in by_form])
            for i in range(CHANNELS if by_form else 0)
        ]
        if by_hue:
            hues = [readers.read_direction(p.here, self.middle, p.colors, start) for p in by_hue]
            ways.insert(0, (by_hue, hues))
        if not ways:
            return None
        groups, readings = max(ways, key=lambda way: readers.bits_told(way[1]))
        # Beside a place on a line or a glyph there is often another one.
        spread = [p.part.kind != "line" and p.part.glyph is None for p in groups]
        lengths = np.concatenate(
            [
                p.structure(_doubled, 2) if there else np.full(len(p.here), np.nan)
                for p, there in zip(groups, spread, strict=True)
            ]
        )
        common = self._common("direction", groups, readings, lengths)
        return Direction(**_angles(readings, common), **common)

    def slope(self) -> Slope | None:
        """Return how steeply lines run."""
        # Hues of the axes tell directions, and no steepness.
        groups = self._with("slope", lambda p: not p.part.by_axes and _is_line_in_light(p))
        if not groups:
            return None
        steep = np.concatenate([readers.steepness(p.here) for p in groups])
        light = np.concatenate([p.colors.lab[:, 0] for p in groups])
        return Slope(**self._ranked(steep, light, groups))

    def heading(self) -> Heading | None:
        """Return the direction of lines in space."""
        groups = self._with("heading", _is_line_in_light)
        groups = _kept(groups, lambda p: readers.in_picture(p.here) > 1e-6)
        if not groups:
            return None
        ways = [
            [readers.read_axes(p.here, self.middle, p.colors)] * len(readers.SHARES)
            if p.part.by_axes
            else readers.read_heading(p.here, self.middle, p.colors)
            for p in groups
        ]
        # How much darker than the key lines are drawn is seen by the whole picture.
        readings = max(map(list, zip(*ways, strict=True)), key=readers.bits_told)
        none = np.full(sum(len(p.here) for p in groups), np.nan)
        common = self._common("heading", groups, readings, none)
        return Heading(**_angles(readings, common), **common)

    def shape(self) -> Shape | None:
        """Return how surfaces stand."""
        groups = self._with("shape", lambda p: p.part.kind != "line" and p.here.normals is not None)
        share = NORMALS / max(1, sum(len(p.here) for p in groups))
        groups = _kept(groups, lambda p: self.random.uniform(size=len(p.here)) < share)
        if not groups:
            return None
        phase = float(self.random.uniform(0.0, 2 * np.pi))
        readings = []
        for p in groups:
            here, colors = p.here, p.colors
            if p.part.table is not None:
                # Light is what colours of data have less than those of the bar.
                here = dataclasses.replace(here, scene=display.for_colors(here.scene))
                colors = readers.light_of(colors, p.part.table)
            readings.append(readers.read_normal(here, self.middle, colors, phase))
        lengths = np.concatenate([p.structure(lambda s: np.asarray(s.normals)) for p in groups])
        common = self._common("shape", groups, readings, lengths)
        error = _errors(readings)
        median = Shape.chance if common["reason"] else float(np.median(error))
        return Shape(median=median, **common)

    def value(self) -> Value | None:
        """Return values as they are read off the bar."""
        groups: list[SeenPlaces] = []
        places: list[Array] = []
        for p in self.groups:
            if p.part.values is None or p.part.table is None:
                continue
            low, high = p.part.table.scalar_range
            if not low < high:
                self.notes.append(f"value: the scalars are constant, {low:g}, and have one colour")
                return None
            values = np.asarray(p.here.values)
            # Places without light have the colour of what is not data.
            has_value = np.isfinite(values) & p.here.valid
            if left := int(np.count_nonzero(~has_value)):
                text = f"value: {left} of {len(values)} places have no value, left out"
                self.notes.append(text)
            if has_value.any():
                groups.append(p[has_value])
                # Values beyond the ends have the colours of the ends.
                places.append(_shares(p.part.table, values[has_value]))
        if not groups:
            return None
        colors = [p.colors for p in groups]
        ways = [
            [
                readers.read_value(each, at, _table(p), lit=lit)
                for each, p, at in zip(some, groups, places, strict=True)
            ]
            for lit in (False, True)
            # Hues are mixed in fine structure, and gone in gray print; lightness may be left.
            for some in (colors, [each.lightness() for each in colors])
        ]
        # Whether there is light on the colours is seen by the whole picture, and so are hues.
        readings = max(ways, key=readers.bits_told)
        lengths = np.concatenate([p.structure(_position(_table(p))) for p in groups])
        common = self._common("value", groups, readings, lengths)
        error = _errors(readings)
        if common["reason"]:
            return Value(median=Value.chance, p95=0.475, largest=0.5, **common)
        p95, largest = float(np.quantile(error, 0.95)), float(error.max())
        return Value(median=float(np.median(error)), p95=p95, largest=largest, **common)

    def speed(self) -> Speed | None:
        """Return how colours rank the lengths of vectors, on the mesh where they tell most."""
        groups = []
        for p in self.groups:
            # Vectors may differ by the lengths of marks, by light, or by colours of values.
            by_color = p.part.values is not None or p.part.scene.lights
            if p.here.magnitude is not None and (p.length is not None or by_color):
                # One place of each point and glyph, which has one colour, and all of the others.
                whole = p.part.kind == "point" or p.part.glyph is not None
                groups.append(p[np.unique(p.thing, return_index=True)[1]] if whole else p)
        groups = _kept(groups, lambda p: np.isfinite(np.asarray(p.here.magnitude)))
        figures = []
        for p in groups:
            length, color = np.asarray(p.here.magnitude), p.colors.lab
            if np.ptp(length) > 1e-3 * length.max():
                signals = [color[:, 0], np.hypot(color[:, 1], color[:, 2])]
                signals += [] if p.length is None else [p.length]
                if p.part.table is not None:
                    signals += [
                        readers.places_on_bar(p.colors, p.part.table, lit=lit)
                        for lit in (False, True)
                    ]
                figures += [Speed(**self._ranked(length, signal, [p])) for signal in signals]
        return max(figures, key=lambda each: each.bits, default=None)

    def _ranked(self, magnitude: Array, signal: Array, groups: list[SeenPlaces]) -> Keywords:
        """Return the figures of a magnitude that a signal ranks."""
        bits = readers.mutual_information(magnitude, signal)
        right = readers.ranked_error(magnitude, signal) <= TOLERANCE["rank"]
        unread = bits < FLOOR
        none = np.full(len(signal), np.nan)
        return {
            "spearman": 0.0 if unread else readers.rank_correlation(signal, magnitude),
            "bits": bits,
            "most": readers.most_ranked(len(signal)),
            "readable": 0.0 if unread else _beyond_chance(right, Figure.guessed),
            "samples": len(signal),
            "reason": self._reason("rank", groups, none) if unread else "",
        }


def _is_line_in_light(places: SeenPlaces) -> bool:
    """Return whether places are on lines in the colours of light, and not of values."""
    part = places.part
    return part.kind == "line" and part.values is None and places.here.has_one_tangent


def _kept(groups: list[SeenPlaces], rule: Callable[[SeenPlaces], Bools]) -> list[SeenPlaces]:
    """Return the places that a rule keeps, of the meshes that have any."""
    return [places for places in (p[rule(p)] for p in groups) if len(places.here)]


def _angles(readings: list[Reading], common: Keywords) -> Keywords:
    """Return the share of errors of 10 degrees at most, and their median."""
    if common["reason"]:
        return {"within_10": 1 / 9, "median": Direction.chance}
    error = _errors(readings)
    return {"within_10": float((error <= 10).mean()), "median": float(np.median(error))}


def _errors(readings: list[Reading]) -> Array:
    return np.concatenate([reading.error for reading in readings])


def _beyond_chance(right: Bools, guessed: float) -> float:
    """Return the share of right answers without those that are guessed (Abbott 1925)."""
    return max(0.0, (float(right.mean()) - guessed) / max(1 - guessed, 1e-9))


def _scale(
    question: str, lengths: Array, unit: Array, right: Bools, guessed: float
) -> Scale:  # fmt: skip
    """Return the finest structure that is read; each octave of structure is judged as a whole."""
    there = np.isfinite(lengths)
    lengths, unit, right = lengths[there], unit[there], right[there]
    octave = np.floor(np.log2(np.maximum(lengths, 0.5)))
    finest: float | None = None
    for step in np.unique(octave)[::-1]:
        rows = octave == step
        if np.count_nonzero(rows) < FEW:
            continue
        if _beyond_chance(right[rows], guessed) < HALF:
            break
        finest = float(max(2.0**step, lengths[rows].min()))
    length = None if finest is None else finest * float(np.median(unit))
    return Scale(question=question, pixels=finest, length=length, median=float(np.median(lengths)))


def _doubled(here: Sample) -> Array:
    """Return directions in the picture as unit vectors that do not depend on their sign."""
    angle = 2 * readers.course(here)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _position(table: pv.LookupTable) -> Callable[[Sample], Array]:
    """Return the function from values to vectors that turn by 180 degrees along a bar."""

    def turn(here: Sample) -> Array:
        at = np.maximum(_shares(table, np.asarray(here.values)), 0.0)
        return np.stack([np.cos(np.pi * at), np.sin(np.pi * at)], axis=1)

    return turn


def _shares(table: pv.LookupTable, values: Array) -> Array:
    """Return the places of values on a bar, from 0 to 1, and -1 below it in a colour of its own."""
    ends, below = np.array(table.scalar_range), values < table.scalar_range[0]
    if table.log_scale:
        # VTK has no logarithm of what is not positive, and takes the lower end.
        ends, values = np.log(ends), np.log(np.maximum(values, ends[0]))
    shares: Array = np.clip((values - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0)
    return shares if color_below(table) is None else np.where(below, -1.0, shares)


def _table(places: SeenPlaces) -> pv.LookupTable:
    assert places.part.table is not None
    return places.part.table
