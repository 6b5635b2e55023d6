"""Round numbers along bars and axes, and their digits."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

#: Most numbers whose steps are 1, 2, 2.5 or 5; those of more are 1, 2, 4 or 5.
FEW = 5
#: Most numbers along a bar with other ends.
USUAL = 7
#: Most numbers along a bar that has some at its ends, and length of such a bar at most, in that of
#: its values.
MOST, WASTE = 10, 1.1


def even_levels(low: float, high: float, most: int = 5) -> list[float]:
    """Return at most some round numbers within a range."""
    if not low < high:
        return [low]
    rough = (high - low) / max(most - 1, 1)
    power = 10.0 ** math.floor(math.log10(rough))
    steps = (1, 2, 4, 5, 10, 20) if most > FEW else (1, 2, 2.5, 5, 10, 20)
    step = next(s * power for s in steps if _count(low, high, s * power) <= most)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    # A whole multiple of the step without a rest of rounding.
    return [float(f"{i * step:.12g}") for i in range(first, last + 1)]


def round_length(most: float) -> float:
    """Return the largest round number up to a positive one: 1, 2 or 5 with zeros."""
    power = 10.0 ** math.floor(math.log10(most))
    return next(s * power for s in (5, 2, 1) if s * power <= most)


def numerals_of(values: Sequence[float]) -> list[str]:
    """Return the digits of round numbers with even steps, with as many places as these need.

    Thousands are parted where a number has more than four digits before the point.
    """
    size = max(abs(value) for value in values)
    if size >= 1e6 or 0 < size < 1e-3:
        words = [_power(value) for value in values]
        # Places of large numbers may differ in their last digits.
        return words if len({*words}) == len(words) else [f"{value:,.12g}" for value in values]
    comma, digits = (",", 6) if size >= 1e4 else ("", 4)
    if len(values) < 2:
        return [f"{value:{comma}.{digits}g}" for value in values]
    step = min(abs(b - a) for a, b in itertools.pairwise(values))
    places = next(n for n in range(12) if abs(step - round(step, n)) < 1e-6 * step)
    return [f"{value:{comma}.{places}f}" for value in values]


def even_numbers(low: float, high: float, most: int = 5) -> list[tuple[float, str]]:
    """Return at most some round numbers within a range, and their digits; see `even_levels`."""
    levels = even_levels(low, high, most)
    return list(zip(levels, numerals_of(levels), strict=True))


def even_ends(low: float, high: float) -> tuple[float, float]:
    """Return the ends of a bar: round numbers just outside of a range, where they waste little."""
    for most in range(FEW, MOST):
        levels = even_levels(low, high, most)
        if len(levels) < 2:
            continue
        step = levels[1] - levels[0]
        if not step:  # rounding alone tells the ends apart
            continue
        first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
        if last - first < MOST and (last - first) * step <= WASTE * (high - low):
            return float(f"{first * step:.12g}"), float(f"{last * step:.12g}")
    return low, high


def along_bar(low: float, high: float) -> list[tuple[float, str]]:
    """Return numbers along a bar and their digits: those at both ends too if these are round."""
    for most in range(FEW, MOST + 1):
        ticks = even_numbers(low, high, most)
        if ticks and (ticks[0][0], ticks[-1][0]) == (low, high):
            return ticks
    return even_numbers(low, high, USUAL)


def _count(low: float, high: float, step: float) -> int:
    return math.floor(high / step + 1e-9) - math.ceil(low / step - 1e-9) + 1


def _power(value: float) -> str:
    """Return a large or small number in few digits: 2e5, 0."""
    if value == 0:
        return "0"
    digits, power = f"{value:.3e}".split("e")
    return f"{float(digits):g}e{int(power)}"
