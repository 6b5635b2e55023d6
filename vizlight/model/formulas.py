"""The formulas of light as straight lines of arithmetic on numbers, arrays or symbols.

The public functions of this package validate and call them on arrays; the engine's terms
(:mod:`vizlight.shading.terms`) call them on blocks of arrays, and on symbols that write GLSL. The
bodies hold nothing but arithmetic, comparisons as the first argument of ``where`` and ``only``,
NumPy's functions, and calls of each other. Vector algebra, that is dot products, unit vectors and
the part of a vector across a frame, is left to the caller.

Lengths and their squares come from residuals: ``sine`` is the length of wi less its tangential
part, never ``sqrt(1 - along^2)``. Equations and error bounds stand at the public functions.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy import exp, maximum, minimum

from vizlight._types import Array, Bools
from vizlight.model import kernels

Number: TypeAlias = float | Array

#: Shares of red, green and blue in the luma of a colour (Rec. ITU-R BT.709).
LUMA = (0.2126, 0.7152, 0.0722)


def power(x: Number, deficit: Number | None, exponent: float) -> Number:
    """Return x to a power of 0 or more for x in [0, 1], with 0^0 = 1.

    The deficit is 1 - x where that has digits which x has lost.
    """
    if hasattr(x, "power"):  # a symbol
        symbol: Number = x.power(deficit, exponent)
        return symbol
    rest = None if deficit is None else np.asarray(deficit)
    return kernels.power(np.asarray(x), exponent, rest)


def where(test: Bools | bool, yes: Number, no: Number) -> Number:
    """Return ``yes`` where a test holds, else ``no``."""
    if hasattr(test, "select"):  # a symbol
        symbol: Number = test.select(yes, no)
        return symbol
    # A random mask costs NumPy several times a product, and most masks hold everywhere.
    return yes if np.all(test) else np.where(test, yes, no)


def only(test: Bools | bool, value: Number) -> Number:
    """Return a finite value where a test holds, else 0: for NumPy a product, which is faster."""
    return value * test


def clamp(x: Number, low: Number, high: Number) -> Number:
    """Return x within [low, high]."""
    return minimum(maximum(x, low), high)


def phong(along: Number, sine_i: Number, sine_o: Number, shininess: float) -> Number:
    """Return max(0, V.R)^s from |wi_T + wo_T|^2, |wi_N| and |wo_N| (Banks 2, 3).

    On a surface the sines are the cosines to the normal.
    """
    # The deficit is 1 - V.R of unit vectors: near the peak it keeps digits that V.R has lost.
    apart = sine_i - sine_o
    deficit = 0.5 * (along + apart * apart)
    return power(maximum(1.0 - deficit, 0.0), deficit, shininess)


def blinn(along: Number, across: Number, shininess: float) -> Number:
    """Return |h_N|^s from the squared parts of wi + wo; 0 without a half vector."""
    whole = along + across
    scale = 1.0 / where(whole > 0.0, whole, 1.0)
    # |h_N|^2 is the share of |wi + wo|^2 that is across, so its power is s / 2.
    value = power(across * scale, along * scale, 0.5 * shininess)
    return only(whole > 0.0, value)


def blinn_of_unit(along: Number, shininess: float) -> Number:
    """Return |h_N|^s for s of 2 or more from |h_T|^2 of a unit half vector."""
    return power(maximum(1.0 - along, 0.0), along, 0.5 * shininess)


def shadowed_highlight(value: Number, passed: Number, side: Number) -> Number:
    """Return the highlight of a surface under t of a cos-theta shadow: min(1, t / cosine) of it."""
    share = passed / where(side > 0.0, side, 1.0)
    return only(side > 0.0, value * minimum(share, 1.0))


def attenuation(distance: Number, constant: Number, linear: Number, quadratic: Number) -> Number:
    """Return min(1, 1 / (c1 + c2 d + c3 d^2)) (Lecture)."""
    # At most 1: no point gets more than a lamp's intensity, however near the lamp is.
    return 1.0 / maximum(constant + distance * (linear + distance * quadratic), 1.0)


def fur_path(height: Number, sine: Number) -> Number:
    """Return the path h / sin(a) of Banks (7); 0 without fur, also at grazing light."""
    return where(height > 0.0, height / sine, 0.0)


def fur_passes(path: Number, rate: Number) -> Number:
    """Return (1 - rho)^d of Banks (8) from the rate log(1 - rho), which is finite."""
    return exp(path * rate)


def depth_scale(
    depth: Number,
    front: Number,
    back: Number,
    front_scale: Number,
    back_scale: Number,
    *,
    smooth: bool,
) -> Number:
    """Return the scale S of the depth cue (Lecture), linear or as a smooth step."""
    # From 0 at the back to 1 at the front.
    t = clamp((depth - back) / (front - back), 0.0, 1.0)
    # The Lecture's small sigmoid, with a slope of 0 at both ends.
    t = t * t * (3.0 - 2.0 * t) if smooth else t
    return back_scale + (front_scale - back_scale) * t


def depth_cue(value: Number, scale: Number, cue: Number) -> Number:
    """Return S I + (1 - S) Icue (Lecture)."""
    return scale * value + (1.0 - scale) * cue


def color_factor(light: Number, least: Number) -> Number:
    """Return the factor of a colour of data: its light, from ``least`` to 1."""
    return clamp(light, least, 1.0)


#: Exposed light from which the knee bends; below it nothing changes.
KNEE = 0.8


def exposed(largest: Number, exposure: Number) -> Number:
    """Return the factor of light by its largest channel, for an exposure.

    With x = exposure * largest the light becomes x up to K = 0.8, and K + (1 - K) (1 - exp(-t)),
    t = (x - K) / (1 - K), above: smooth in its first derivative, rising, and below 1, to two
    roundings. At x = 1 it is 0.926, within 0.074 of x, which is the most up to there.
    """
    x = exposure * largest
    bent = 1.0 - (1.0 - KNEE) * exp((KNEE - x) * (1.0 / (1.0 - KNEE)))
    # Above the knee x is no 0; below it the quotient is not used.
    return exposure * where(x > KNEE, bent / maximum(x, KNEE), 1.0)


def in_range(channel: Number, largest: Number) -> Number:
    """Return a channel of a colour, over the largest of its channels where that exceeds 1."""
    return channel / maximum(largest, 1.0)
