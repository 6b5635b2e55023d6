"""Steps of luminance: a count, explicit values or the error that is allowed."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TypeAlias

    from vizlight._types import Array, Indices

    Levels: TypeAlias = int | float | Sequence[float] | Array

#: The largest number of steps: a float32 picture cannot show more.
MOST = 1 << 20
#: The share of an allowed error that is left to contours drawn with chords.
CHORDS = 0.05


@dataclass(frozen=True)
class Steps:
    """Steps of luminance between two bounds.

    Attributes
    ----------
    edges : ndarray, shape (n + 1,)
        Rising luminance of the contours, the lowest and the highest luminance among them.
    values : ndarray, shape (n + 1,)
        Of the bands: the lowest luminance itself for what is not brighter than it, then the
        mid value of each step.
    """

    edges: Array
    values: Array

    @property
    def error(self) -> float:
        """The worst error of a band's value: half the largest step."""
        return float(np.diff(self.edges).max(initial=0)) / 2

    def band(self, luminance: Array) -> Indices:
        """Return the band of each luminance: 0 up to the lowest, k in (edges[k-1], edges[k]]."""
        found = np.searchsorted(self.edges, luminance, side="left")
        return np.minimum(found, len(self.edges) - 1)


def check(levels: Any) -> None:
    """Check the three forms of ``levels``.

    Raises
    ------
    TypeError
        If it is neither a number nor numbers.
    ValueError
        If a count is less than 1, an error not positive, or values are not finite.
    """
    expected = "a count (int), luminance values (a sequence) or an allowed error (float)"
    if isinstance(levels, bool | str) or levels is None:
        raise TypeError(_check.message("levels", expected, _check.describe(levels)))
    error = allowed(levels)
    if isinstance(levels, numbers.Integral):
        if not 1 <= int(levels) <= MOST:
            raise ValueError(_check.message("levels", f"a count from 1 to {MOST}", levels))
    elif error is not None:
        if error >= 2 and error.is_integer():
            remedy = f"write {int(error)} for a count"
            raise ValueError(_check.message("levels", expected, repr(levels), remedy))
        if not (error > 0 and math.isfinite(error)):
            raise ValueError(
                _check.message("levels", "an allowed error above 0", _check.describe(levels))
            )
    else:
        values = _check.floats("levels", levels)
        if values.ndim != 1 or not np.all(np.isfinite(values)):
            raise ValueError(
                _check.message("levels", "finite values in one row", _check.describe(levels))
            )


def allowed(levels: Any) -> float | None:
    """Return the allowed error, None where a count or values are given."""
    if isinstance(levels, numbers.Real) and not isinstance(levels, numbers.Integral):
        return float(levels)
    return None


def steps(levels: Levels, low: float, high: float, /, *, exact: bool = False) -> Steps:
    """Return the steps between the lowest and the highest luminance.

    Parameters
    ----------
    levels : int, float or sequence of float
        A count n: equal steps. An allowed error e: the smallest count whose half step is at
        most e (95 % of it, unless ``exact``: the rest is for contours drawn with chords).
        Values: contours there; those outside the bounds draw nothing.
    low, high : float
        Bounds of the luminance.
    exact : bool, default: False
        Whether contours are drawn without any error.

    Returns
    -------
    Steps

    Raises
    ------
    TypeError, ValueError
        As :func:`check`, or if an allowed error asks for more than 2^20 steps.

    Notes
    -----
    A band's value is mid between its two contours, so no luminance in it is farther away than
    half a step; of all values this is the best. The lowest luminance has a band of its own:
    what no light reaches is exact. Source: Isoluminance, Representing a Sphere.
    """
    check(levels)
    span, error = high - low, allowed(levels)
    if not span > 0:
        edges = np.array([low])
    elif isinstance(levels, numbers.Integral):
        edges = np.linspace(low, high, int(levels) + 1)
    elif error is not None:
        ratio = span / (2 * error * (1 if exact else 1 - CHORDS))
        if ratio > MOST:
            raise ValueError(
                _check.message("levels", f"an error that {MOST} steps can keep", repr(levels))
            )
        # Up to rounding of the ratio itself, a whole ratio needs no further step.
        edges = np.linspace(low, high, max(1, math.ceil(ratio * (1 - 1e-12))) + 1)
    else:
        given = np.unique(np.asarray(levels, dtype=np.float64))
        inside = given[(given > low) & (given < high)]
        edges = np.concatenate([[low], inside, [high]])
    middle = edges[:-1] + np.diff(edges) / 2
    return Steps(edges, np.concatenate([edges[:1], middle]))
