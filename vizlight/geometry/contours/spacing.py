"""Steps of luminance from a count, from explicit values or from an allowed error."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from vizlight import _check
from vizlight._types import Array, Indices

Levels: TypeAlias = int | float | Sequence[float] | Array

#: Largest number of steps; a float32 picture cannot show more.
MOST = 1 << 20
#: Largest and smallest share of an allowed error that is reserved for contours drawn as chords, and
#: largest ratio of the number of steps to the smallest number possible.
CHORDS, LEAST, MORE = 0.05, 0.01, 1.05


@dataclass(frozen=True)
class LuminanceSteps:
    """Steps of luminance between two bounds.

    ``edges`` (n + 1,) is the luminance of the contours in ascending order, the lowest and the
    highest included; ``values`` (n + 1,) that of the bands: the lowest itself for band 0, then the
    midpoint of each step.
    """

    edges: Array
    values: Array

    @property
    def error(self) -> float:
        """The largest error of a band's value, which is half the largest step."""
        return float(np.diff(self.edges).max(initial=0)) / 2

    def band(self, luminance: Array) -> Indices:
        """Return the band of each luminance: 0 up to the lowest, k in (edges[k-1], edges[k]]."""
        index = np.searchsorted(self.edges, luminance, side="left")
        return np.minimum(index, len(self.edges) - 1)


def check(levels: object) -> None:
    """Validate ``levels`` in each of its three forms."""
    expected = "a count (int), luminance values (a sequence) or an allowed error (float)"
    if isinstance(levels, bool | str) or levels is None:
        raise _check.type_error("levels", expected, levels)
    error = allowed(levels)
    if isinstance(levels, numbers.Integral):
        if not 1 <= int(levels) <= MOST:
            raise _check.value_error("levels", f"a count from 1 to {MOST}", levels)
    elif error is not None:
        if error >= 2 and error.is_integer():
            remedy = f"write {int(error)} for a count"
            raise _check.value_error("levels", expected, repr(levels), remedy)
        if not (error > 0 and math.isfinite(error)):
            expected = "an allowed error above 0"
            raise _check.value_error("levels", expected, _check.describe(levels))
    else:
        values = _check.floats("levels", levels)
        if values.ndim != 1 or not np.all(np.isfinite(values)):
            expected = "finite values in one row"
            raise _check.value_error("levels", expected, _check.describe(levels))


def allowed(levels: object) -> float | None:
    """Return the allowed error, or None if ``levels`` is a count or a sequence of values."""
    if isinstance(levels, numbers.Real) and not isinstance(levels, numbers.Integral):
        return float(levels)
    return None


def steps(levels: Levels, low: float, high: float, /, *, exact: bool = False) -> LuminanceSteps:
    """Return the steps between the lowest and the highest luminance.

    For an allowed error e the number of steps is the smallest with a half step of at most e, or up
    to 5 % more unless contours are ``exact``, since 1 to 5 % of e are reserved for contours drawn
    as chords. It is 1 more where the smallest number, below 20, would leave less than 1 %, and at
    most 2^20. Contours outside the bounds are ignored.

    The value of a band is the midpoint of its two contours, which minimises the largest error: no
    luminance in the band differs by more than half a step. The lowest luminance has its own band,
    so that points without light are exact. Source: Isoluminance, Representing a Sphere.
    """
    check(levels)
    span, error = high - low, allowed(levels)
    # A surface of one luminance, or without points, is a single band without contours.
    if not span > 0:
        edges = np.array([low])
    elif isinstance(levels, numbers.Integral):
        edges = np.linspace(low, high, int(levels) + 1)
    elif error is not None:
        # The middle of a step of twice the error is nowhere farther off than the error.
        ratio = span / (2 * error)
        if ratio > MOST * (1 if exact else 1 - CHORDS):
            expected = f"an error that at most {MOST} steps keep"
            raise _check.value_error("levels", expected, repr(levels))
        edges = np.linspace(low, high, _count(ratio, exact) + 1)
    else:
        contours = np.unique(np.asarray(levels, dtype=np.float64))
        inside = contours[(contours > low) & (contours < high)]
        edges = np.concatenate([[low], inside, [high]])
    middle = edges[:-1] + np.diff(edges) / 2
    return LuminanceSteps(edges, np.concatenate([edges[:1], middle]))


def _count(ratio: float, exact: bool) -> int:
    """Return the number of steps for a luminance range in units of twice the allowed error."""

    # An integer ratio needs no further step; the factor covers rounding of the ratio.
    def least(share: float) -> int:
        return max(1, math.ceil(ratio / (1 - share) * (1 - 1e-12)))

    if exact:
        return least(0)
    return min(least(CHORDS), max(math.floor(MORE * least(0)), least(LEAST)))
