"""The range of values that a bar of colours shows: all of it, clipped, or logarithmic."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight._types import Array, Bools
from vizlight.draw.ticks import even_ends
from vizlight.maps import TWO_SIDED

#: Distances of a quartile from the median at which values are far outside, 3 deviations of a normal
#: distribution, the largest share of them that is clipped, and the share of the bar that they take;
#: share up to which they are a few, and the shares of the bar that more of them take, on one side
#: of the others and on both.
FENCE, MOST_OUTSIDE, LEAST_FREED, FEW, FREED_BY_MANY = 4.5, 0.1, 0.32, 0.002, (0.75, 0.45)
#: Percentiles of values between two tails of many values far outside.
BETWEEN_TAILS = (5, 95)
#: Percentile of lengths and amounts above which they are peaks, and the share of the bar that these
#: take at least where it ends below them.
BELOW_PEAKS, FREED_BY_PEAKS = 99.5, 0.3
#: Ratio of the 98th percentile to the median from which lengths have a logarithmic bar, and the
#: ratio of its ends at most.
SKEWED, DECADES = 10.0, 100.0
#: Percentiles of positive values, and the ratio between them from which a bar is logarithmic.
ENDS, WIDE = (2, 98), 10.0
#: Share of the values that are one value far outside, from which it stands for a region apart, and
#: its least distance from others: as a share of the bar, and where it is any share of the values in
#: lengths of the others' range.
APART, GAP, FAR = 0.01, 0.1, 20.0
#: Share of a mesh beyond the ends, away from its borders, from which it is a region and no noise,
#: and the most that the whole range of values is of that of most.
REGION, STRETCHED = 0.01, 20.0
#: Percentile of the values of a scan from which on they are white.
BRIGHTEST = 99
#: Share of amounts that are 0, or too small for a logarithmic bar, from which these are the ground
#: of a map, and the least amount that is none as a share of the largest, on other bars.
MOSTLY_NONE, LEAST_AMOUNT = 0.1, 0.05
#: Share of the largest amount below 0, or of the range of all values, that is an error of rounding.
NOISE = 1e-6
#: First digits of the classes of a logarithmic bar, whose ratios are much alike.
DIGITS = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)


class Range(NamedTuple):
    """Range of a bar of colours.

    Equal ratios have equal lengths if it is ``logarithmic``; ``clipped``: values lie below the
    lower, and above the upper end. Those below are nearly all one value ``apart``, such as a 0
    where nothing was measured, or amounts of nearly nothing, a ``ground``, such as rain where it is
    dry.
    """

    low: float
    high: float
    logarithmic: bool = False
    clipped: tuple[bool, bool] = (False, False)
    apart: bool = False
    ground: bool = False

    @property
    def classes(self) -> list[float]:
        """Ends of the classes of a logarithmic bar, of the round numbers between them too."""
        powers = range(*np.floor(np.log10([self.low, 10 * self.high])).astype(int))
        inner = [float(f"{digit * 10.0**power:.6g}") for power in powers for digit in DIGITS]
        return [self.low, *(level for level in inner if self.low < level < self.high), self.high]

    @property
    def is_signed(self) -> bool:
        """Whether it reaches far to both sides of 0, which is then the middle of its values."""
        ends = sorted((-self.low, self.high))
        return not (self.logarithmic or self.apart) and ends[0] >= TWO_SIDED * ends[1] > 0

    def around_zero(self, values: Array) -> Range:
        """Return the range of some values with 0 in its middle."""
        end = max(-self.low, self.high)
        clipped = bool(values.min() < -end), bool(values.max() > end)
        return self._replace(low=-end, high=end, clipped=clipped)

    def words(self, name: str) -> str:
        """Return the words that say how the range differs from that of the values, if it does."""
        less = f"; less than {self.low:.3g} is white" * self.ground
        if self.logarithmic:
            return f"colours of {name} are logarithmic from {self.low:.3g} to {self.high:.3g}{less}"
        if not any(self.clipped):
            return ""
        ends = f"{self.low:.3g} to {self.high:.3g}"
        words = f"colours of {name} run from {ends}" + (less or ", where most values are")
        return words + "; one value below, in a region apart, is grey" * self.apart


def range_of_turn(values: Array) -> Range | None:
    """Return the whole turn in degrees that directions are in, None where they are in no such.

    Values are finite, one at least.
    """
    low, high = float(values.min()), float(values.max())
    first = 0.0 if low >= 0 else -180.0
    is_turn = first <= low and high - low > 180 and high <= first + 360
    return Range(first, first + 360) if is_turn else None


def range_of_scan(values: Array) -> Range:
    """Return the range of a bar of the values of a scan in grey: its brightest hundredth is white.

    Values are finite, one at least.
    """
    low, high = float(values.min()), float(values.max())
    end = float(np.percentile(values, BRIGHTEST))
    step = (end - low) / 10 or 1.0
    end = _rounded(end, step, np.ceil)
    return Range(_rounded(low, step, np.floor), end, clipped=(False, high > end))


def range_shown(
    values: Array, *, lengths: bool = False, amounts: bool = False, decades: bool = False
) -> Range:
    """Return the range of a bar that shows values.

    It is from the least to the largest finite value, or round numbers near them; of most values
    alone where few others take much of the bar; of decades where ``lengths`` of vectors are skewed,
    and where ``decades``, such as permeabilities, differ by much. ``amounts`` on a map have such a
    bar too, and a ground where they are 0.
    """
    low, high = float(values.min()), float(values.max())
    others = values[values > low]
    if len(values) - len(others) > APART * len(values) and len(others):
        next_low = float(others.min())
        if next_low - low > FAR * (high - next_low) > 0:
            shown = range_shown(others, lengths=lengths, amounts=amounts, decades=decades)
            return shown._replace(clipped=(True, shown.clipped[1]), apart=True)
    first, median, third = np.percentile(values, (25, 50, 75))
    if (lengths or amounts) and low >= -NOISE * high < 0:
        usual, top = np.percentile(values[values > 0], (50, 98))
        # Ends of which a bar tells one, two or three in a decade.
        end = next(end for end in _of_decades(high) if end >= high)
        if top > SKEWED * usual:
            bottom = max(end / DECADES, low)
            ground = amounts and float(np.mean(values < bottom)) > MOSTLY_NONE
            return Range(bottom, end, True, clipped=(low < bottom, False), ground=ground)
        if amounts and np.mean(values <= 0) > MOSTLY_NONE:
            bottom, first, top = np.percentile(values[values > 0], (2, 5, 99.5))
            if first > high / 2 > 0.5:
                # 0 is far from nearly all amounts, and these no shares: salinity on land.
                step = (top - bottom) / 10
                bottom, top = _rounded(bottom, step, np.floor), _rounded(top, step, np.ceil)
                return Range(bottom, top, clipped=(True, high > top), apart=True)
            end = even_ends(0.0, high)[1]
            return Range(LEAST_AMOUNT * end, end, clipped=(True, False), ground=True)
    if decades and low > 0:
        first, last = np.percentile(values, ENDS)
        if last > WIDE * first:
            bottom = max(end for end in _of_decades(first) if end <= first)
            top = next(end for end in _of_decades(high) if end >= high)
            return Range(bottom, top, True, clipped=(low < bottom, False))
    fences = (
        max(low, median + FENCE * (first - median)), min(high, median + FENCE * (third - median)),
    )  # fmt: skip
    step = (fences[1] - fences[0]) / 10 if first < median < third else 0.0
    below, above = values < fences[0], values > fences[1]
    cut = bool(below.any()), bool(above.any())
    outside = np.mean(below | above)
    if outside > FEW and third - first < NOISE * (high - low):
        # Most values differ by rounding alone: the others are the data.
        step = 0.0
    if step and all(cut) and outside > MOST_OUTSIDE:
        return _between_tails(values)
    least = np.isclose(values, low, atol=0.01 * (fences[1] - fences[0]))
    apart = least.sum() > max(APART * len(values), 0.5 * below.sum())
    is_near = np.any(~least & (values < low + GAP * (fences[1] - fences[0])))
    is_apart = cut[0] and bool(apart) and not is_near
    freed = 1 - (fences[1] - fences[0]) / ((high - low) or 1.0)
    needed = LEAST_FREED if outside <= FEW else FREED_BY_MANY[all(cut)]
    if not step or outside > MOST_OUTSIDE or (freed < needed and not is_apart):
        top = float(np.percentile(values, BELOW_PEAKS))
        if (lengths or amounts) and high - top > FREED_BY_PEAKS * (high - low):
            step = (top - low) / 10
            ends = _rounded(low, step, np.floor), _rounded(top, step, np.ceil)
            return Range(*ends, clipped=(False, True))
        return Range(*even_ends(low, high))
    ends = (
        _rounded(fences[0] if cut[0] else low, step, np.floor),
        _rounded(fences[1] if cut[1] else high, step, np.ceil),
    )
    return Range(*ends, clipped=cut, apart=is_apart)


def with_regions(shown: Range, values: Array, beyond: Callable[[Range], float]) -> Range:
    """Return a range that ends where most values do, or that of all where regions lie beyond.

    ``beyond`` returns the share of the mesh in regions beyond the ends of a range.
    """
    if not any(shown.clipped) or shown.logarithmic or shown.apart or shown.ground:
        return shown
    whole = Range(*even_ends(float(values.min()), float(values.max())))
    is_near = whole.high - whole.low < STRETCHED * (shown.high - shown.low)
    return whole if is_near and beyond(shown) > REGION else shown


def share_beyond(mesh: pv.DataSet, beyond: Bools, *, of_cells: bool) -> float:
    """Return the share of a mesh in cells whose points, and their cells, are all beyond an end.

    Values of noise are alone, so that their cells have others too.
    """
    flags = mesh.copy(deep=False)
    flags.clear_data()
    if of_cells:
        flags.cell_data["beyond"] = beyond.astype(np.float64)
        beyond = np.asarray(flags.cell_data_to_point_data()["beyond"]) > 1 - NOISE
    flags.clear_data()
    flags.point_data["beyond"] = beyond.astype(np.float64)
    inside = np.asarray(flags.point_data_to_cell_data()["beyond"]) > 1 - NOISE
    sized = flags.compute_cell_sizes()
    for name in ("Volume", "Area", "Length"):
        sizes = np.abs(np.asarray(sized.cell_data[name]))
        if total := float(sizes.sum()):
            return float(sizes[inside].sum()) / total
    return 0.0


def _between_tails(values: Array) -> Range:
    """Return the range of values with long tails of many on both sides: that between the tails.

    The range is that of all values where the tails would free too little of the bar.
    """
    low, high = float(values.min()), float(values.max())
    first, last = map(float, np.percentile(values, BETWEEN_TAILS))
    if last - first > (1 - FREED_BY_MANY[0]) * (high - low):
        return Range(*even_ends(low, high))
    step = (last - first) / 10
    ends = _rounded(first, step, np.floor), _rounded(last, step, np.ceil)
    return Range(*ends, clipped=(low < ends[0], high > ends[1]))


def _of_decades(value: float) -> list[float]:
    """Return the round numbers of the decade of a value, and the first of the next."""
    power = 10.0 ** np.floor(np.log10(value))
    return [float(f"{digit * power:.6g}") for digit in (1, 2, 3, 5, 10)]


def _rounded(value: float, step: float, way: np.ufunc) -> float:
    step = 10.0 ** np.floor(np.log10(step) + 1e-9)
    return float(f"{way(value / step) * step:.6g}")
