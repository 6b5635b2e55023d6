"""Readers of a picture: the meaning of colours by a key, and how much they tell of the data.

A reader matches the colour that the eye has of a place with the colours of a key, knows the noise
of the eye, and gives the likeliest answer. It knows no normal, no lamp and no formula of light.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight.filters.key import color_below
from vizlight.geometry.lines.simplices import Columns
from vizlight.model.kernels import unit_rows
from vizlight.observers.eye import (
    OPPONENT,
    ROUNDING,
    XYZ,
    lab,
    lab_of_opponent,
    lab_of_xyz,
    linear,
    xyz_of_lab,
)
from vizlight.observers.samples import dots
from vizlight.shading import display

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import pyvista as pv

    from vizlight._types import Array, Indices
    from vizlight.observers.eye import SeenPicture
    from vizlight.observers.samples import Sample
    from vizlight.shading.display import Bytes

#: Number of candidates of a direction, one for each degree.
ANGLES = 180
#: Least length of a unit tangent in the picture whose direction there is read.
SHORTEST = 0.35
#: Logarithm of the likelihood of a course along a perfect grain, over that without any grain: a
#: posterior of 3.7 degrees, which a lower sharpness makes wider.
BELIEF = 60.0
#: Number of classes of a magnitude, largest number of classes of a signal, and least number of
#: places in each of the latter. With 128 places in 32 classes noise alone would tell 1.8 bits.
CLASSES, SIGNALS, EACH = 16, 32, 32
#: Number of candidates for a normal; where there are tangents, fewer, each with some of those.
ALONE, WITH_TANGENTS = (900, 1), (300, 72)
#: Number of courses in the picture and of slopes of the key of lines.
COURSES, SLOPES = 90, 180
#: Shares of the light of a key that lines may have, since their edges are smoothed.
SHARES = (1.0, 0.8, 0.65, 0.5, 0.4, 0.3)
#: Number of colours of a bar, and of the amounts of light on each, for a reader of values.
BAR, AMOUNTS = 128, 12
#: Number of pairs of place and candidate that are matched at once: what fits a processor's cache.
BLOCK = 1 << 16
#: Least share of a channel that a place itself has; below, its colour is its neighbours'.
LEAST_COVER = 0.05
#: Shares of answers that have nothing to do with the picture, and sharpnesses of what a reader
#: believes, of which the best is taken.
LAPSES = (0.02, 0.1, 0.3, 0.6, 1.0)
SHARPNESS = (1.0, 0.4, 0.15, 0.05)


@dataclass(frozen=True)
class Colors(Columns):
    """Colours that a reader has of places.

    They are in CIELAB, without the share of the background, with the standard deviation of each
    component.
    """

    lab: Array
    deviation: Array

    def lightness(self) -> Colors:
        """Return the colours for a reader who goes by lightness alone."""
        return Colors(self.lab, self.deviation * np.array([1.0, np.inf, np.inf]))


def colors_at(
    seen: SeenPicture, row: Indices, column: Indices, random: np.random.Generator, noise: float,
    share: Array | None = None,
) -> Colors:  # fmt: skip
    """Return the colours that a reader has of pixels, with the noise of the eye.

    The eye mixes small things with the background and with their neighbours. A reader knows the
    background, and takes off its share, by which the noise grows. The neighbours of a point add as
    much as colours differ in the picture, for all that is drawn but ``share``, its own share of
    each channel. Lines run beside others like them.
    """
    mixed = seen.colors_at(row, column)
    noise_free = xyz_of_lab(mixed) @ OPPONENT.T
    noisy = xyz_of_lab(mixed + random.normal(0.0, noise, mixed.shape)) @ OPPONENT.T
    cover = np.maximum(seen.cover[row, column], LEAST_COVER)
    # Beside a bright background the filter leaves dark colours less than no light, which CIELAB
    # has not: they differ once the background is taken off.
    channels = seen.channels[row, column] + noisy - noise_free
    alone = (channels - (1 - cover) * seen.ground) / cover
    colors = lab_of_opponent(alone)
    # CIELAB is steeper in dark colours, by the power 2/3 of luminance that lightness is from.
    steeper = np.maximum((mixed[:, :1] + 16) / (colors[:, :1] + 16), 1.0) ** 2
    deviation = math.hypot(noise, ROUNDING) / np.minimum(cover, 1.0) * steeper
    if share is not None:
        beside = np.clip(1 - share / cover, 0.0, 1.0)
        deviation = np.hypot(deviation, beside * colors.std(axis=0))
    return Colors(colors, deviation)


class Reading(NamedTuple):
    """Answers of a reader at some places.

    ``truth`` (S, M) is the probability that the reader gives to the right candidate, for each
    sharpness. The other two are the same compared with the data of other places, at random: the
    result of guessing where data are alike.
    """

    error: Array
    truth: Array
    candidates: int
    other_error: Array
    other_truth: Array

    @property
    def elsewhere(self) -> Reading:
        """Answers as they are compared with the data of other places."""
        error, truth = self.other_error, self.other_truth
        return Reading(error, truth, self.candidates, error, truth)


def elsewhere(count: int) -> Indices:
    """Return for each place another one, at random but always the same."""
    return np.random.default_rng(count).permutation(count)


def likelihood(colors: Colors, tables: Array) -> Array:
    """Return the logarithm of the likelihood of each candidate at each place, shape (M, A).

    ``tables`` (L, A, 3) are colours of the candidates in CIELAB, each in any of L lights, with
    their likelihoods summed.
    """
    logarithms = np.empty((len(colors.lab), tables.shape[1]))
    for rows, each in _in_lights(colors, tables):
        best = each.max(axis=1)
        each -= best[:, np.newaxis]
        np.exp(each, out=each)
        logarithms[rows] = best + np.log(each.sum(axis=1))
    return logarithms


def _in_lights(colors: Colors, tables: Array) -> Iterator[tuple[Indices, Array]]:
    """Yield rows of places, and the logarithms of their likelihoods, shape (rows, L, A)."""
    lights, count, _ = tables.shape
    precision = 1 / colors.deviation**2
    square = (precision * colors.lab**2).sum(axis=1, keepdims=True)
    # (a - b)^2 = a^2 + b^2 - 2 a b: one product of matrices in place of all differences.
    places = np.hstack([precision, -2 * precision * colors.lab, square]) / -2
    table = tables.reshape(-1, 3)
    candidates = np.hstack([table**2, table, np.ones((len(table), 1))]).T
    step = max(1, BLOCK // len(table))
    for start in range(0, len(places), step):
        rows = np.arange(start, min(start + step, len(places)))
        yield rows, (places[rows] @ candidates).reshape(-1, lights, count)


def of_truth(logarithms: Array, *truths: Indices) -> Array:
    """Return the probability of right candidates for each sharpness, shape (T, S, M).

    Candidates are equally likely before; their probabilities at a place have the sum 1.
    ``logarithms`` (M, A) are of their likelihoods; right candidates come in T ways.
    """
    below = logarithms - logarithms.max(axis=1, keepdims=True)
    probabilities = np.empty((len(truths), len(SHARPNESS), len(below)))
    rows, buffer = np.arange(len(below)), np.empty_like(below)
    for i, sharpness in enumerate(SHARPNESS):
        np.exp(np.multiply(below, sharpness, out=buffer), out=buffer)
        total = buffer.sum(axis=1)
        for truth, probability in zip(truths, probabilities[:, i], strict=True):
            probability[:] = buffer[rows, truth] / total
    return probabilities


def _compared(
    error: Array, other_error: Array, logarithms: Array, right: Indices, other: Indices
) -> Reading:
    """Return answers compared with the truth at their places, and at the other places."""
    truth, other_truth = of_truth(logarithms, right, right[other])
    return Reading(error, truth, logarithms.shape[1], other_error, other_truth)


def information(readings: list[Reading]) -> float:
    """Return the bits that a picture tells of candidates that are equally likely before.

    It is ``log2(A) + E[log2(q)]``, q the probability that the reader gives to the right one of A
    candidates: the reader's belief counts only as far as it is true (logarithmic score, Good
    1952). The reader knows how far the picture is to be trusted, so that the best sharpness and
    the best share of lapses are taken; with lapses alone the bits are 0.
    """
    best = 0.0
    for level in range(len(SHARPNESS)):
        gains = [reading.candidates * reading.truth[level] for reading in readings]
        gain = np.concatenate(gains)
        for lapse in LAPSES:
            best = max(best, float(np.log2((1 - lapse) * gain + lapse).mean()))
    return best


def bits_told(readings: list[Reading]) -> float:
    """Return the bits that a picture tells of its places, beyond those common to all places."""
    return max(
        0.0, information(readings) - information([reading.elsewhere for reading in readings])
    )


def most_told(readings: list[Reading]) -> float:
    """Return the bits of readers who are sure of the right candidate at each place."""
    bits = [math.log2(reading.candidates) for reading in readings]
    return float(np.average(bits, weights=[len(reading.error) for reading in readings]))


def read_direction(sample: Sample, middle: Array, colors: Colors, start: float) -> Reading:
    """Return the answers of a reader who matches hues with a disc of directions.

    The disc faces the eye at ``middle`` and has tangents in all directions. The chroma of a place
    may be less than that of the disc, since tangents that leave the picture are paler. Places have
    one tangent each, which has a length in the picture; ``start``, the angle of the first candidate
    in degrees, should be random. Errors are angles in degrees, from 0 to 90, between directions in
    the picture.
    """
    hues = lab(shown(key(sample, middle, np.radians(start + np.arange(ANGLES)))))[:, 1:]
    chroma = np.linalg.norm(hues, axis=1)
    hues = hues / np.maximum(chroma, 1e-12)[:, np.newaxis]
    along = colors.lab[:, 1:] @ hues.T
    radius = np.clip(along, 0.0, chroma)
    # |c - r h|^2 = |c|^2 - 2 r c.h + r^2, of which |c|^2 is alike for all.
    gain = (2 * radius * along - radius**2) / 2
    logarithms = gain / (colors.deviation[:, 1:] ** 2).mean(axis=1)[:, np.newaxis]
    return _angles(logarithms, np.degrees(course(sample)), start)


def read_grain(grain: Array, angle: Array, start: float) -> Reading:
    """Return the answers of a reader who takes the grain of a picture for the course of tangents.

    The more of all change is across the grain, the more the reader believes it. ``grain`` is that
    of :func:`vizlight.observers.lines.along_grain`, ``angle`` the true directions in degrees, from
    right toward up; the rest is as for :func:`read_direction`.
    """
    candidates = np.exp(-2j * np.radians(start + np.arange(ANGLES)))
    return _angles(BELIEF * np.outer(grain, candidates).real, angle, start)


def _angles(logarithms: Array, angle: Array, start: float) -> Reading:
    """Return answers of candidates a degree apart, compared with directions without a sign."""
    right = np.rint(angle - start).astype(np.intp) % ANGLES
    other = elsewhere(len(angle))
    off = start + _drawn(logarithms) - np.stack([angle, angle[other]])
    # Directions repeat after 180 degrees.
    error, other_error = np.abs((off + 90) % 180 - 90)
    return _compared(error, other_error, logarithms, right, other)


def _drawn(logarithms: Array) -> Indices:
    """Return the likeliest candidate of each place; of those that are alike the middle one."""
    best = logarithms >= logarithms.max(axis=1, keepdims=True) - 1e-9
    rank = np.cumsum(best, axis=1)
    middle: Indices = np.argmax(rank >= (rank[:, -1:] + 1) // 2, axis=1)
    return middle


def course(sample: Sample) -> Array:
    """Return the directions of single tangents in the picture, as angles from right toward up."""
    tangent = _single(sample)
    return np.arctan2(*(dots(tangent, axis) for axis in (sample.up, sample.right)))


def in_picture(sample: Sample) -> Array:
    """Return the lengths that single unit tangents have in the picture."""
    tangent = _single(sample)
    return np.hypot(*(dots(tangent, axis) for axis in (sample.right, sample.up)))


def _single(sample: Sample) -> Array:
    assert sample.tangents is not None
    return sample.tangents[:, 0]


def _nearest(sample: Sample, middle: Array, count: int) -> Sample:
    """Return the place nearest to the middle, some times: lamps shine on it as on a key."""
    nearest = np.argmin(((sample.points - middle) ** 2).sum(axis=1))
    return sample[np.full(count, nearest)]


def key(sample: Sample, middle: Array, angles: Array) -> Array:
    """Return the light of a disc that faces the eye at a place, for tangents at some angles."""
    place = _nearest(sample, middle, len(angles))
    across = np.cos(angles)[:, np.newaxis] * place.right + np.sin(angles)[:, np.newaxis] * place.up
    return place.light(across[:, np.newaxis], place.eye)


def shown(rgb: Array) -> Array:
    """Return the colours of light, 0 or more, in the range of a screen."""
    return display.displayable(np.maximum(rgb, 0.0))


def read_heading(
    sample: Sample, middle: Array, colors: Colors, shares: Sequence[float] = SHARES
) -> list[Reading]:
    """Return the answers of readers who know the course of lines and a key of all directions.

    Edges that are smoothed, and halos, leave less light of lines than the key has. Each reader
    expects one of the ``shares`` of the light of the key of all lines. Errors are angles in
    degrees, from 0 to 90, between the tangents, which have a length in the picture, and the
    likeliest of 180 directions in space that have their course in it.
    """
    ways = _ways()
    place = _nearest(sample, middle, len(ways))
    axes = np.stack([place.right, place.up, place.eye], axis=1)
    lit = place.light(np.einsum("ij,ijk->ik", ways, axes)[:, np.newaxis], None)
    light = linear(shown(lit))
    tables = [lab_of_xyz(share * light @ XYZ.T) for share in shares]
    return [_along(sample, middle, colors, table[np.newaxis]) for table in tables]


def read_axes(sample: Sample, middle: Array, colors: Colors) -> Reading:
    """Return the answers of a reader who knows the course of lines, and hues of the axes.

    A hue is that of up to four directions. Lightness and chroma tell nothing, since light and the
    ground between lines, dark or white, are mixed with the hues. Arguments and errors are those of
    :func:`read_heading`.
    """
    place = _nearest(sample, middle, 1)
    axes = np.stack([place.right[0], place.up[0], place.eye[0]])
    hues = np.abs(_ways() @ axes)
    amounts = np.linspace(0.0, 1.0, AMOUNTS, endpoint=False)
    tables = [lab(hues), *(lab(amount * hues) for amount in amounts[1:])]
    pale = [lab_of_xyz((amount + (1 - amount) * linear(hues)) @ XYZ.T) for amount in amounts[1:]]
    return _along(sample, middle, colors, np.stack(tables + pale))


def _ways() -> Array:
    """Return the directions of the key of lines in the frame of the eye: courses times slopes."""
    turns, slopes = np.pi * np.arange(COURSES) / COURSES, np.radians(np.arange(SLOPES) - 90 + 0.5)
    turn, slope = (grid.ravel() for grid in np.meshgrid(turns, slopes, indexing="ij"))
    return np.stack([np.cos(slope) * np.cos(turn), np.cos(slope) * np.sin(turn), np.sin(slope)], 1)


def _along(sample: Sample, middle: Array, colors: Colors, tables: Array) -> Reading:
    """Return the answers by the course of lines and by colours, in any of some lights.

    Colours are of shape (L, COURSES SLOPES, 3) for L lights.
    """
    # The key tells slopes toward the eye from its own place.
    eye = _nearest(sample, middle, 1).eye[0]
    angle, toward = course(sample), _single(sample) @ eye
    # A line has no sign: it is taken upward in the picture, and from right to left never.
    angle = np.where(angle == np.pi, -np.pi, angle)
    steps = np.rint(angle % np.pi / np.pi * COURSES).astype(np.intp)
    down = (angle < 0) ^ (steps == COURSES)
    toward = np.degrees(np.arcsin(np.clip(np.where(down, -toward, toward), -1, 1)))
    logarithms = np.empty((len(sample), SLOPES))
    of_courses = tables.reshape(-1, COURSES, SLOPES, 3)
    for step in np.unique(steps % COURSES):
        rows = steps % COURSES == step
        logarithms[rows] = likelihood(colors[rows], of_courses[:, step])
    right = np.clip(np.floor(toward + 90), 0, SLOPES - 1).astype(np.intp)
    answer = _drawn(logarithms) - 90 + 0.5
    other = elsewhere(len(toward))
    off = np.abs(answer - np.stack([toward, toward[other]]))
    error, other_error = np.minimum(off, 180 - off)
    return _compared(error, other_error, logarithms, right, other)


def read_normal(sample: Sample, middle: Array, colors: Colors, phase: float) -> Reading:
    """Return the answers of a reader who matches colours with a ball.

    The candidates are even on the disc that a ball shows, so that each is as likely as it is large
    in a picture of all normals. Tangents, if any, may have any direction. They are turned by the
    ``phase`` in radians. Errors are angles in degrees between the side of the surface that is seen
    and the mean of the candidates by their probability: the likeliest one would be worse than no
    look at the picture where the colour tells little.
    """
    assert sample.normals is not None
    count, turns = ALONE if sample.tangents is None else WITH_TANGENTS
    disc, along = candidates(count, turns, phase)
    place = _nearest(sample, middle, len(disc))
    table = lab(shown(_ball(place, disc, along)))
    # A ball tells normals in the frame of its own place, wherever the colour is found again.
    axes = np.stack([place.right[0], place.up[0], place.eye[0]])
    seen_side = np.where(dots(sample.normals, sample.eye) < 0, -1.0, 1.0)
    truth = seen_side[:, np.newaxis] * sample.normals @ axes.T
    other = elsewhere(len(sample))
    # The tangent is unknown: a normal is as likely as all of its tangents together.
    logarithms = likelihood(colors, table.reshape(turns, count, 3))
    likely = np.exp(logarithms - logarithms.max(axis=1, keepdims=True))
    mean = unit_rows(likely @ disc[:count])
    error, other_error = (
        np.degrees(np.arccos(np.clip(dots(mean, normals), -1.0, 1.0)))
        for normals in (truth, truth[other])
    )
    right = np.argmax(truth @ disc[:count].T, axis=1)
    return _compared(error, other_error, logarithms, right, other)


def candidates(count: int, turns: int, phase: float) -> tuple[Array, Array]:
    """Return candidates in the frame of the eye: normals and tangents, shape (turns count, 3)."""
    i = np.arange(count) + 0.5
    # Fibonacci's spiral, even in area.
    radius, angle = np.sqrt(i / count), i * np.pi * (3 - 5**0.5) + phase
    height = np.sqrt(1 - radius * radius)
    normals = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    # Any direction that is nowhere along a normal: the edge of the disc is not a candidate.
    first = unit_rows(np.cross(normals, [np.cos(phase), np.sin(phase), 0.0]))
    second = np.cross(normals, first)
    turn = (np.pi * np.arange(turns) / turns)[:, np.newaxis, np.newaxis]
    tangents = np.cos(turn) * first + np.sin(turn) * second
    return np.tile(normals, (turns, 1)), tangents.reshape(-1, 3)


def _ball(places: Sample, normals: Array, tangents: Array) -> Array:
    """Return the light of candidates, given in the frame of the eye, at places."""
    axes = np.stack([places.right, places.up, places.eye], axis=1)
    facing = np.einsum("ij,ijk->ik", normals, axes)
    frames = None
    if places.tangents is not None:
        frames = np.einsum("ij,ijk->ik", tangents, axes)[:, np.newaxis]
        # Of a plane of tangents the second is across the first.
        if places.tangents.shape[1] == 2:
            frames = np.concatenate([frames, np.cross(facing, frames[:, 0])[:, np.newaxis]], axis=1)
    return places.light(frames, facing)


def read_value(colors: Colors, positions: Array, table: pv.LookupTable, *, lit: bool) -> Reading:
    """Return the answers of a reader who looks colours up on a bar.

    Positions of the values on the bar are from 0 to 1, less than 0 where they are below the bar, in
    a colour of their own; if ``lit``, the reader takes colours for those of the bar in some light,
    from 0.3 to 1 of it. Errors are distances on the bar, as shares of its length.
    """
    logarithms, count, first = _on_bar(colors, table, lit=lit)
    # What is below the bar is one step below it.
    positions = np.maximum(positions, -0.5 / count)
    right = np.minimum(np.floor(positions * count).astype(np.intp), count - 1) + first
    other = elsewhere(len(positions))
    answer = (_drawn(logarithms) - first + 0.5) / count
    error, other_error = np.abs(answer - np.stack([positions, positions[other]]))
    return _compared(error, other_error, logarithms, right, other)


def places_on_bar(colors: Colors, table: pv.LookupTable, *, lit: bool) -> Array:
    """Return where colours stand on a bar most likely, from 0 to 1, and less below it."""
    logarithms, count, first = _on_bar(colors, table, lit=lit)
    return np.asarray((logarithms.argmax(axis=1) - first + 0.5) / count)


def _on_bar(colors: Colors, table: pv.LookupTable, *, lit: bool) -> tuple[Array, int, int]:
    """Return the logarithms of the likelihoods of the colours of a bar, and their number.

    The last number is the first of these colours: 1 where one stands below the bar, else 0.
    """
    whole = np.asarray(table.values)[:, :3]
    count = min(BAR, len(whole))
    bar = whole[((np.arange(count) + 0.5) / count * len(whole)).astype(np.intp)]
    below = color_below(table)
    if below is not None:
        bar = np.concatenate([np.rint(255 * below[np.newaxis]).astype(np.uint8), bar])
    amounts = np.linspace(display.LEAST, 1.0, AMOUNTS) if lit else np.ones(1)
    return likelihood(colors, lab(_in_amounts(bar, amounts))), count, len(bar) - count


def light_of(colors: Colors, table: pv.LookupTable) -> Colors:
    """Return the grays of the light on colours of a bar, as a reader takes it from them."""
    bar = np.asarray(table.values)[:, :3]
    bar = bar[((np.arange(BAR) + 0.5) / BAR * len(bar)).astype(np.intp)]
    amounts = np.linspace(display.LEAST, 1.0, 3 * AMOUNTS)
    lighted = lab(_in_amounts(bar, amounts))
    best = [each.max(axis=2).argmax(axis=1) for _, each in _in_lights(colors, lighted)]
    grays = np.repeat(amounts[np.concatenate(best), np.newaxis], 3, axis=1)
    return Colors(lab(grays), colors.deviation)


def _in_amounts(bar: Bytes, amounts: Array) -> Array:
    """Return the colours of a bar in amounts of light, shape (amounts, colours, 3)."""
    return np.stack([display.on_colors(bar, np.full(len(bar), a)) / 255.0 for a in amounts])


def steepness(sample: Sample) -> Array:
    """Return the cosine, 0 or more, of the angle between tangents and the line of sight."""
    return np.abs(dots(_single(sample), sample.eye))


def ranks(values: Array) -> Array:
    """Return the ranks of values from 1; equal values have the mean of theirs."""
    _, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(counts) - (counts - 1) / 2)[inverse.ravel()])


def rank_correlation(a: Array, b: Array) -> float:
    """Return Spearman's rank correlation; 0 where one of the two is constant."""
    if np.ptp(a) == 0 or np.ptp(b) == 0:
        return 0.0
    return float(np.corrcoef(ranks(a), ranks(b))[0, 1])


def mutual_information(magnitude: Array, signal: Array) -> float:
    """Return the bits that a signal tells of a magnitude, both in classes of equal count.

    Fewer than 1024 places tell less than all: of n, classes of the signal are ``n / 32``. The
    bias of a sample of n is taken off: ``(joint - rows - columns + 1) / (2 n ln 2)``, of the
    numbers of classes that occur (Miller 1955).
    """
    rows, columns = (
        # Quantiles that coincide, as of many equal values, bound one class.
        np.searchsorted(np.unique(np.quantile(x, np.linspace(0, 1, k + 1)[1:-1])), x)
        for x, k in (
            (magnitude, CLASSES), (signal, _signals(len(signal))),
        )
    )  # fmt: skip
    joint = np.bincount(rows * SIGNALS + columns, minlength=CLASSES * SIGNALS)
    share = joint.reshape(CLASSES, SIGNALS) / len(magnitude)
    alone = share.sum(axis=1, keepdims=True) * share.sum(axis=0, keepdims=True)
    there = share > 0
    bits = float((share[there] * np.log2(share[there] / alone[there])).sum())
    classes = int(there.sum()) - int(there.any(axis=1).sum()) - int(there.any(axis=0).sum()) + 1
    return max(0.0, bits - classes / (2 * len(magnitude) * math.log(2)))


def most_ranked(count: int) -> float:
    """Return the bits of a signal that ranks a magnitude at some number of places."""
    return math.log2(min(CLASSES, _signals(count)))


def _signals(count: int) -> int:
    """Return the number of classes of a signal at some number of places."""
    return min(SIGNALS, max(2, count // EACH))


def ranked_error(magnitude: Array, signal: Array) -> Array:
    """Return how far ranks of a magnitude are from the answers of a calibrated reader of a signal.

    The reader answers with the median rank of the places with a signal in the same class.
    """
    rank = (ranks(magnitude) - 0.5) / len(magnitude)
    count = _signals(len(signal))
    bounds = np.unique(np.quantile(signal, np.linspace(0, 1, count + 1)[1:-1]))
    label = np.searchsorted(bounds, signal)
    answers = np.zeros(len(bounds) + 1)
    for number in np.unique(label):
        answers[number] = np.median(rank[label == number])
    return np.abs(answers[label] - rank)
