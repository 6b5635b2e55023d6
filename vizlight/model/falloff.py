"""Attenuation of light: with distance, with depth from the eye, and in fur."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, FloatType
from vizlight.model import formulas

__all__ = ["depth_cue", "distance", "fur"]

#: Depths beyond this are divided by 4, so that their differences are finite.
LARGEST_DEPTH = 1e300


def distance(d: ArrayLike, c1: float, c2: float, c3: float, /) -> Array:
    """Return the attenuation of a light at distance d.

    Parameters
    ----------
    d : array_like, shape (...)
        Distances from point to light, 0 or more, in the unit of the mesh.
    c1, c2, c3 : float
        Constant, linear and quadratic coefficients, each 0 or more and not all 0, in units of 1,
        1/length and 1/length^2.

    Returns
    -------
    ndarray, shape (...)
        ``min(1, 1 / (c1 + c2 d + c3 d^2))``, in [0, 1]; 0 at infinite distance.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If a distance is negative or NaN, a coefficient is negative, or all coefficients are 0.

    Notes
    -----
    Relative error at most ``2 eps`` where the result is a normal number.
    Source: Lecture, effect of distance.
    """
    lengths = _check.floats("d", d)
    if not np.all(lengths >= 0):
        raise _check.value_error("d", "distances of 0 or more", _check.describe(d))
    factors = [_check.number(name, c) for name, c in (("c1", c1), ("c2", c2), ("c3", c3))]
    return fading(lengths, attenuation("c1, c2, c3", factors))


def attenuation(name: str, value: object) -> tuple[float, float, float]:
    """Return the three coefficients of :func:`distance`, validated."""
    array = _check.floats(name, value)
    if array.shape != (3,) or not np.all(np.isfinite(array) & (array >= 0)) or not array.any():
        expected = "three coefficients (constant, linear, quadratic) of 0 or more, not all 0"
        remedy = "pass (1, 0, 0) for a light without attenuation"
        raise _check.value_error(name, expected, _check.describe(value), remedy)
    c1, c2, c3 = (float(c) for c in array)
    return c1, c2, c3


def fading(d: Array, coefficients: tuple[float, float, float]) -> Array:
    """Return :func:`distance` for distances and coefficients that are already validated."""
    # In float64 for every type of d, because coefficients may exceed the range of float32. 0 times
    # an infinite distance would be NaN.
    wide = np.minimum(d.astype(np.float64, copy=False), np.finfo(np.float64).max)
    with np.errstate(over="ignore", under="ignore"):
        value = formulas.attenuation(wide, *coefficients)
        return np.asarray(value).astype(d.dtype, copy=False)


def depth_cue(
    intensity: ArrayLike,
    z: ArrayLike,
    /,
    *,
    front: float,
    back: float,
    front_scale: float = 1.0,
    back_scale: float = 0.0,
    cue: ArrayLike = 0.0,
    smooth: bool = False,
) -> Array:
    """Return an intensity blended toward a cue intensity with depth.

    Parameters
    ----------
    intensity : array_like, shape (...)
        Intensity I before the blend.
    z : array_like, shape (...)
        Depths, in any unit, growing either toward or away from the eye: front and back say which
        end is near.
    front, back : float
        Depths Zt and Zb between which the scale changes; not equal.
    front_scale, back_scale : float
        Scales St and Sb at and beyond front and back, in [0, 1].
    cue : array_like, default: 0.0
        Intensity Icue (or one channel of the colour) that replaces I where the scale is 0.
    smooth : bool, default: False
        Whether the scale goes from Sb to St by a smooth step, with zero slope at both ends,
        instead of linearly.

    Returns
    -------
    ndarray, shape (...)
        ``S I + (1 - S) Icue``, where S = Sb + (St - Sb) t and t = (z - Zb) / (Zt - Zb), clamped to
        [0, 1]; with ``smooth`` t is replaced by t^2 (3 - 2 t).

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If front equals back, a scale is outside [0, 1], a depth is NaN, or an intensity is not
        finite.

    Notes
    -----
    Absolute error at most ``4 eps max(|I|, |Icue|)`` for exact depths.
    Source: Lecture, atmospheric attenuation; the smooth step is its "small sigmoid".
    """
    front, back = _check.number("front", front), _check.number("back", back)
    if front == back:
        remedy = "pass two different depths"
        raise _check.value_error("front", "a depth other than back", front, remedy)
    depth, light, fade = (
        _check.floats(name, value)
        for name, value in (("z", z), ("intensity", intensity), ("cue", cue))
    )
    if np.any(np.isnan(depth)):
        raise _check.value_error("z", "depths without NaN", _check.describe(z))
    for name, value in (("intensity", light), ("cue", fade)):
        if not np.all(np.isfinite(value)):
            raise _check.value_error(name, "finite light", _check.describe(value))
    depth, light, fade = _check.together(z=depth, intensity=light, cue=fade)
    scales = (
        _check.number(name, value, low=0.0, high=1.0)
        for name, value in (("front_scale", front_scale), ("back_scale", back_scale))
    )
    wide = depth.astype(np.float64, copy=False)
    if max(abs(front), abs(back)) > LARGEST_DEPTH:
        wide, front, back = wide / 4, front / 4, back / 4
    smooth = _check.boolean("smooth", smooth)
    with np.errstate(over="ignore"):
        scale = formulas.depth_scale(wide, front, back, *scales, smooth=smooth)
    return np.asarray(
        formulas.depth_cue(light, np.asarray(scale).astype(depth.dtype, copy=False), fade)
    )


def fur(height: ArrayLike, sin_alpha: ArrayLike, density: float, /) -> Array:
    """Return the share of light that passes through fur, once on its way in or out.

    Parameters
    ----------
    height : array_like, shape (...)
        Fur height h above the point, 0 or more, perpendicular to the surface, in the unit of
        length that the density refers to.
    sin_alpha : array_like, shape (...)
        Sine of the angle between the tangent plane and the direction to the light (in) or to the
        eye (out), in [0, 1].
    density : float
        Share rho of the light that is absorbed per unit of length, in [0, 1].

    Returns
    -------
    ndarray, shape (...)
        ``(1 - rho)^(h / sin a)``, in [0, 1]: 1 at h = 0 for every angle and density; 0 at grazing
        light for every h and density above 0.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If a height is negative or NaN, or a sine or the density is outside [0, 1].

    Notes
    -----
    Absolute error at most ``3 eps`` for a density of 0 or at least 1e-300 (1e-30 in float32).
    Source: Banks (7) and (8).
    """
    density = _check.number("density", density, low=0.0, high=1.0)
    heights = _check.floats("height", height)
    if not np.all(heights >= 0):
        raise _check.value_error("height", "heights of 0 or more", _check.describe(height))
    sines = _check.floats_in("sin_alpha", sin_alpha, 0.0, 1.0, "sines")
    heights, sines = _check.together(height=heights, sin_alpha=sines)
    if density == 0:
        return np.ones_like(sines)
    # log(1 - rho) is infinite: such fur is opaque, except where it has no height.
    if density == 1:
        return np.asarray(heights == 0).astype(sines.dtype)
    rate = fur_rate(density, sines.dtype)
    with np.errstate(all="ignore"):
        return np.asarray(formulas.fur_passes(formulas.fur_path(heights, sines), rate))


def fur_rate(density: float, dtype: FloatType) -> float:
    """Return log(1 - rho), neither 0 nor infinite: 0 times an infinite path is no number."""
    limits = np.finfo(dtype)
    rate = np.log1p(-density) if density < 1 else -limits.max
    return float(min(rate, -limits.tiny))
