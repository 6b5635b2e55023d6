"""Phong and Blinn at a known exchange rate: the factor between their powers, and what is left.

L, E and N of the source are ``wi``, ``wo`` and the normal; rho is the angle from the reflection R
to the eye, nu that from N to the half vector H, 2 beta that from L to E, theta that from N to the
line across L and E. Pixel errors are differences of two highlights whose peak is 255.

Everything rests on one pair of bounds. With ``x = |h_T|^2 = 1 - |h_N|^2``, in any codimension::

    V.R = 1 - 2 cos^2(beta) x - (|wi_N| - |wo_N|)^2 / 2                       (9')
    1 - 2 x  <=  V.R  <=  1 - 2 cos^2(beta) x

(9') follows from ``|wi + wo|^2 = 4 cos^2(beta)`` and is Fisher and Woo's (9) where the codimension
is 1. The upper bound is reached where ``|wi_N| = |wo_N|``; the lower one, reached where wi, wo and
a normal are coplanar, holds because Banks' reflection is the nearest to the eye and that about
h_N is one of those it was chosen from. So a highlight of Phong lies between two of Blinn, with
powers 4 cos^2(beta) and 4 times its own, and the worst error is a maximum over x alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

import numpy as np

from vizlight import _check
from vizlight.model.extremes import PEAK, extremes, sphere_errors

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array

__all__ = [
    "MaximumError",
    "best_factor",
    "blinn_from_phong",
    "exchange_rate",
    "max_pixel_error",
    "phong_from_blinn",
    "pixel_error",
    "required_factor",
    "simple_factor",
    "sphere_error",
    "terminator_error",
]

Measure = Literal["worst", "rms", "volume"]


class MaximumError(NamedTuple):
    """The largest error by size, with its sign, and the normal that has it.

    Attributes
    ----------
    error : ndarray
        Phong minus Blinn, in pixel values: the sign of Fisher and Woo's table 3.
    theta, phi : ndarray
        The normal is ``(-sin theta cos phi, cos theta, sin theta sin phi)`` for E along +z and L
        in the xz plane, x <= 0 (figure 4), in radians.
    """

    error: Any
    theta: Any
    phi: Any


def required_factor(rho: ArrayLike, /) -> Any:
    """Return the factor f for which ``cos(rho)^r = cos(rho / 2)^(f r)``, L, N and E coplanar.

    Parameters
    ----------
    rho : array_like, shape (...)
        Angle from the reflection to the eye, in radians, from 0 to pi.

    Returns
    -------
    ndarray, shape (...)
        4 at 0, growing to infinity at and beyond pi / 2, where Phong's highlight is 0.

    Raises
    ------
    TypeError, ValueError
        If an angle is not a real number from 0 to pi.

    Notes
    -----
    Source: Fisher and Woo (5) and table 1. Relative error at most 8 eps up to 1.5; nearer to
    pi / 2 the angle's own rounding is magnified by ``1 / (pi / 2 - rho)``.
    """
    angle = _angles("rho", rho)
    with np.errstate(divide="ignore", invalid="ignore", under="ignore"):
        small, sine = np.cos(angle), np.sin(angle)
        numerator = np.where(
            small > 0.7, 0.5 * np.log1p(-(sine * sine)), np.log(np.maximum(small, 0))
        )
        half = np.sin(angle / 2)
        factor = numerator / (0.5 * np.log1p(-(half * half)))
    factor = np.where(small > 0, factor, np.inf)
    # Below this angle the squares of sines leave the range of the type; f differs from 4 by rho^2.
    tiny = angle < np.sqrt(np.finfo(angle.dtype).eps) / 16
    return np.where(tiny, 4, factor).astype(angle.dtype, copy=False)[()]


def pixel_error(rho: ArrayLike, r: ArrayLike, /, *, factor: ArrayLike = 4.0) -> Any:
    """Return Blinn's highlight minus Phong's where L, N and E are coplanar.

    Parameters
    ----------
    rho : array_like, shape (...)
        Angle from the reflection to the eye, in radians, from 0 to pi.
    r : array_like, shape (...)
        Phong's shininess, from 0 to 1e9.
    factor : array_like, shape (...), default: 4.0
        Blinn's shininess is ``factor * r``, from 0 to 1e9.

    Returns
    -------
    ndarray, shape (...)
        ``255 (cos(rho/2)^(f r) - max(0, cos rho)^r)``, pixel values.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    Source: Fisher and Woo (6); their table 2 is off by one in the last digit of some of its first
    row, and of 20 degrees, r = 30, which is 1.162. The cosine of an angle beyond pi / 2 counts as
    0. Absolute error at most ``255 (3 eps)`` for f of 1 or more, whatever the power.
    """
    angle, r, factor = _angles("rho", rho), _powers("r", r), _powers("factor", factor)
    angle, r, factor = _together({"rho": angle, "r": r, "factor": factor})
    q = factor * r
    with np.errstate(divide="ignore", invalid="ignore", under="ignore"):
        x = np.square(np.sin(angle / 2))
        # Beyond a right angle the cosine itself has the digits.
        log = np.where(x < 0.5, np.log1p(-x) / 2, np.log(np.cos(angle / 2)))
        blinn = np.where(q == 0, 1, np.exp(q * log))
        phong = np.where(r == 0, 1, np.exp(r * np.log1p(-np.minimum(2 * x, 1))))
    return (PEAK * (blinn - phong))[()]


def max_pixel_error(
    light_eye_angle: ArrayLike, r: ArrayLike, /, *, factor: ArrayLike = 4.0, lit: bool = False
) -> MaximumError:
    """Return the largest difference between Phong and Blinn over all normals, and where it is.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    r : array_like, shape (...)
        Phong's shininess, from 0 to 1e9.
    factor : array_like, shape (...), default: 4.0
        Blinn's shininess is ``factor * r``, from 0 to 1e9.
    lit : bool, default: False
        Only normals that face the light; else all that face the eye.

    Returns
    -------
    MaximumError
        ``error``, ``theta`` and ``phi``, each of shape (...). The mirror image of the normal in
        the plane of light and eye has the same error; at angle 0 a whole ring has it.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    By the bounds above, Phong exceeds Blinn most where ``|wi_N| = |wo_N|`` and falls short most
    where the three are coplanar. Either way the error is ``(1 - a x)^r - (1 - x)^(f r / 2)`` with
    a = 2 cos^2(beta) or a = 2; the logarithm of its derivative's two terms has one turning point,
    so each side of it holds at most one root, found by halving to the last digit. No start, no
    local optimum. The result bounds the error **in every codimension**.
    Source: Fisher and Woo, table 3, which is off by one in some last digits. Absolute error of
    ``error`` at most ``255 (4 eps)``, whatever the power. For r to infinity and f = 4 it tends to
    ``255 (1 - C) C^(C / (1 - C))``, C = cos^2(beta).
    """
    angle = _angles("light_eye_angle", light_eye_angle)
    r, factor = _powers("r", r), _powers("factor", factor)
    beta, r, factor = _together({"light_eye_angle": angle / 2, "r": r, "factor": factor})
    more, less, at_more, at_less = extremes(beta, r, factor, lit=lit)
    phong_wins = more >= less
    theta = np.where(phong_wins, np.pi / 2 - np.arcsin(np.sqrt(at_more)), np.pi / 2)
    phi = np.pi / 2 - beta + np.where(phong_wins, 0, np.arcsin(np.sqrt(at_less)))
    error = PEAK * np.where(phong_wins, more, -less)
    return MaximumError(error[()], theta[()], phi[()])


def best_factor(light_eye_angle: ArrayLike, r: ArrayLike, /, *, by: Measure = "worst") -> Any:
    """Return the factor f that brings Blinn's highlight of power f r nearest to Phong's of r.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    r : array_like, shape (...)
        Phong's shininess, from 0.5 to 1e6.
    by : {"worst", "rms", "volume"}
        What is made smallest over the normals that face light and eye: the largest error, the
        root of the mean square, or the mean size of the error (the volume of its bumps).

    Returns
    -------
    ndarray, shape (...)
        From 1e-3 to 16; at 180 degrees, where no normal faces both, an end of that range.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    See Also
    --------
    simple_factor : 4 cos(beta), to which the first tends.

    Notes
    -----
    With a growing f Phong exceeds Blinn by more and falls short by less, so the worst error is
    least where both are equal: a root, found by halving. The others are minima over f of a
    quadrature over normals, found to 1e-4 (scipy's bounded minimiser).
    ``vizlight study highlights`` prints the table.
    """
    if by not in get_args(Measure):
        raise ValueError(_check.message("by", "'worst', 'rms' or 'volume'", repr(by)))
    angle = _angles("light_eye_angle", light_eye_angle).astype(np.float64)
    r = _powers("r", r, low=0.5, high=1e6).astype(np.float64)
    beta, r = _together({"light_eye_angle": angle / 2, "r": r})
    if by == "worst":
        low, high = np.full(beta.shape, np.log(1e-3)), np.full(beta.shape, np.log(16.0))
        for _ in range(36):
            middle = (low + high) / 2
            more, less, _, _ = extremes(beta, r, np.exp(middle), lit=True)
            low, high = np.where(more < less, middle, low), np.where(more < less, high, middle)
        return np.exp(low)[()]
    from scipy.optimize import minimize_scalar

    result = np.empty(beta.shape)
    for at in np.ndindex(beta.shape):
        b, s = float(beta[at]), float(r[at])
        found = minimize_scalar(
            lambda log, b=b, s=s: sphere_errors(b, s, float(np.exp(log)))[by],
            bounds=(np.log(1e-3), np.log(16.0)),
            method="bounded",
            options={"xatol": 1e-5},
        )
        result[at] = np.exp(found.x)
    return result[()]


def simple_factor(light_eye_angle: ArrayLike, r: ArrayLike | None = None, /) -> Any:
    """Return 4 cos(beta), beta half the angle between light and eye: a better rule than 4.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        In radians, from 0 to pi.
    r : array_like, shape (...), optional
        Phong's shininess, from 0.5 to 1e9: with it the rule is corrected for small powers, to
        ``4 cos(beta) (1 + (2 cos(beta) - 1) / (3 r))``.

    Returns
    -------
    ndarray, shape (...)
        From 4 to 0 without r: ``2 |wi + wo|``, which needs no angle.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or shapes do not broadcast.

    Notes
    -----
    For large powers Phong's highlight lies between the Gaussians of 4 cos^2(beta) and of 4; their
    geometric mean makes the errors to both sides equal, ``255 (1 - c) c^(c / (1 - c))`` with
    c = cos(beta) in place of cos^2(beta): 63.75 at 120 degrees in place of 120.5. On a surface it
    is also the factor for which both highlights hold the same light. The correction is fitted to
    :func:`best_factor`: from r = 10 on and up to 120 degrees its worst error is within a tenth, or
    half a pixel value, of the least, and no more than 0.1 above that of 4.
    """
    angle = _angles("light_eye_angle", light_eye_angle)
    if r is None:
        return (4 * np.cos(angle / 2))[()]
    angle, power = _together({"light_eye_angle": angle, "r": _powers("r", r, low=0.5)})
    cosine = np.cos(angle / 2)
    return (4 * cosine * (1 + (2 * cosine - 1) / (3 * power)))[()]


def sphere_error(
    light_eye_angle: float, r: float, /, *, factor: float = 4.0, by: Measure = "rms"
) -> float:
    """Return the error of Blinn's highlight over a sphere, in pixel values.

    Parameters
    ----------
    light_eye_angle : float
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    r : float
        Phong's shininess, from 0.5 to 1e6.
    factor : float, default: 4.0
        Blinn's shininess is ``factor * r``, from 1e-3 to 1e3.
    by : {"rms", "volume", "worst"}
        Root of the mean square, or mean size, over the normals that face the light and the eye,
        in equal weight; or the largest size.

    Returns
    -------
    float

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    Gauss-Legendre quadrature in panels scaled to the highlight; relative error
    below 1e-4 for powers of 5 or more and up to 170 degrees, where both models stay smooth.
    """
    angle = _check.number("light_eye_angle", light_eye_angle, low=0.0, high=float(np.pi))
    r = _check.number("r", r, low=0.5, high=1e6)
    factor = _check.number("factor", factor, low=1e-3, high=1e3)
    if by not in get_args(Measure):
        raise ValueError(_check.message("by", "'worst', 'rms' or 'volume'", repr(by)))
    if by == "worst":
        return float(abs(max_pixel_error(angle, r, factor=factor, lit=True).error))
    return sphere_errors(angle / 2, r, factor)[by]


def blinn_from_phong(
    shininess: ArrayLike, /, *, light_eye_angle: ArrayLike | None = None, factor: float = 4.0
) -> Any:
    """Return Blinn's shininess for a highlight like Phong's.

    Parameters
    ----------
    shininess : array_like, shape (...)
        Phong's, from 0 to 1e9.
    light_eye_angle : array_like, shape (...), optional
        Angle between light and eye, in radians, from 0 to pi; where it is known,
        :func:`simple_factor` of it is the factor.
    factor : float, default: 4.0
        The factor where no angle is given, above 0.

    Returns
    -------
    ndarray, shape (...)

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.
    """
    by = np.asarray(_factor(light_eye_angle, factor))
    power, by = _together({"shininess": _powers("shininess", shininess), "light_eye_angle": by})
    return (power * by)[()]


def phong_from_blinn(
    shininess: ArrayLike, /, *, light_eye_angle: ArrayLike | None = None, factor: float = 4.0
) -> Any:
    """Return Phong's shininess for a highlight like Blinn's: back from :func:`blinn_from_phong`.

    Parameters
    ----------
    shininess : array_like, shape (...)
        Blinn's, from 0 to 1e18.
    light_eye_angle, factor
        As there; the angle below pi, where the factor is 0.

    Returns
    -------
    ndarray, shape (...)

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.
    """
    by = _factor(light_eye_angle, factor)
    if np.any(by < 1e-9):
        raise ValueError(
            _check.message("light_eye_angle", "an angle below pi, where a half vector is", "pi")
        )
    power = _powers("shininess", shininess, high=_check.LARGEST**2)
    power, by = _together({"shininess": power, "light_eye_angle": np.asarray(by)})
    return (power / by)[()]


def exchange_rate(light_eye_angle: ArrayLike, /, *, k: int = 2, n: int = 3) -> Any:
    """Return the factor between the powers of Blinn and Phong for a k-manifold in n-space.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    k, n : int
        Dimensions of the manifold and of the space, k < n.

    Returns
    -------
    ndarray, shape (...)
        4 at angle 0, whatever k and n.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    Both models are 1 on the same tangent spaces, those across h. Near one of them let
    ``w = wi + wo``, ``d = wi - wo``, both of which are across each other, and let the tangential
    part w_T be small. Then ``|wi_N|^2 - |wo_N|^2 = -w_T . d_T`` and (9') give::

        -log V.R    = (|w_T|^2 + (w_T . d_T)^2 / (4 - |d_T|^2)) / 2
        -log |h_N|  = |w_T|^2 / (8 cos^2 beta)

    so in k - 1 directions of w_T the ratio is 4 cos^2(beta) and in one, along d_T, it is
    ``4 cos^2(beta) / (1 - m^2 sin^2(beta))``, m the share of d inside the tangent space. In
    codimension 1 all of d is (m = 1): 4 cos^2(beta) and 4. In higher codimension m^2 is spread
    over the bright set as a beta variable of k/2 and (c - 1)/2. The rate returned keeps the volume
    of the highlight, its geometric mean over directions and the bright set::

        4 cos^2(beta) exp(-E[log(1 - m^2 sin^2 beta)] / k)

    which is 4 cos(beta) for a surface in 3-space, 4 for a curve in the plane and
    ``(4 cos(beta) / (1 + cos(beta)))^2`` for a line in 3-space. For the worst error
    :func:`simple_factor` is the best in every codimension but for that curve.
    Relative error at most 1e-12 up to 170 degrees.
    """
    k, n = _check.integer("k", k, low=1), _check.integer("n", n, low=2)
    if k >= n:
        raise ValueError(_check.message("k", f"fewer than n = {n}", k))
    beta = _angles("light_eye_angle", light_eye_angle) / 2
    cosine = np.cos(beta)
    if n - k == 1:
        return (4 * np.power(cosine, 2 - 2 / k))[()]
    from scipy.special import roots_jacobi

    c = n - k
    # With m = cos(u), and equal weight of directions, the density is sin^(c-2) cos^(k-1).
    nodes, weights = roots_jacobi(400, (c - 3) / 2, (k - 2) / 2)
    share = (1 + nodes) / 2
    log = np.log1p(-np.multiply.outer(np.square(np.sin(beta)), share))
    mean = log @ (weights / weights.sum())
    return (4 * np.square(cosine) * np.exp(-mean / k))[()]


def terminator_error(
    light_eye_angle: ArrayLike,
    shininess: ArrayLike,
    width: ArrayLike,
    /,
    *,
    model: Literal["phong", "blinn"] = "phong",
) -> Any:
    """Return the most that a smooth terminator takes from a highlight.

    Both models end sharply where ``N.L = 0``. A smooth terminator multiplies them by the smooth
    step ``t^2 (3 - 2 t)``, ``t = N.L / width`` from 0 to 1.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    shininess : array_like, shape (...)
        The model's own power, from 0 to 1e9.
    width : array_like, shape (...)
        N.L at which the highlight is whole, from 0 to 1.
    model : {"phong", "blinn"}

    Returns
    -------
    ndarray, shape (...)
        The largest loss over all normals that face the light, in pixel values.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    For a given N.L both models are largest where N, L and E are coplanar: cos(alpha - beta) and
    cos(2 alpha - 2 beta). The loss there is log-concave in N.L, so thirds find its maximum.
    The flaw is named by Fisher and Woo beside their figure 3.
    """
    if model not in ("phong", "blinn"):
        raise ValueError(_check.message("model", "'phong' or 'blinn'", repr(model)))
    beta = _angles("light_eye_angle", light_eye_angle) / 2
    s, width = _powers("shininess", shininess), _powers("width", width, high=1.0)
    times = 2.0 if model == "phong" else 1.0

    _together({"light_eye_angle": beta, "shininess": s, "width": width})
    safe = np.where(width > 0, width, 1)

    def log_loss(cosine: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            t = np.minimum(cosine / safe, 1)
            base = np.maximum(np.cos(times * (np.arccos(cosine) - beta)), 0)
            power = np.where(s == 0, 0, s * np.log(base))
            total: Array = 2 * np.log1p(-t) + np.log1p(2 * t) + power
        return total

    # Nearer the terminator than ``low`` there is no highlight to lose.
    reach = np.cos(np.minimum(beta + np.pi / (2 * times), np.pi))
    low = np.where(s == 0, 0.0, np.maximum(reach, 0)) + np.zeros_like(safe)
    high = np.maximum(np.minimum(safe, np.cos(beta)), low)
    for _ in range(90):
        third = (high - low) / 3
        right = log_loss(low + third) < log_loss(high - third)
        low, high = np.where(right, low + third, low), np.where(right, high, high - third)
    with np.errstate(under="ignore"):
        most = np.exp(np.maximum(log_loss(low), log_loss(high)))
    return np.where(width > 0, PEAK * most, 0)[()]


def _factor(light_eye_angle: ArrayLike | None, factor: float) -> Any:
    if light_eye_angle is not None:
        return simple_factor(light_eye_angle)
    return _check.number("factor", factor, low=1e-9, high=_check.LARGEST)


def _together(arrays: dict[str, Array]) -> list[Array]:
    """Return arrays broadcast together; their names are told where shapes do not fit."""
    try:
        return list(np.broadcast_arrays(*arrays.values()))
    except ValueError as error:
        shapes = ", ".join(str(array.shape) for array in arrays.values())
        names = ", ".join(arrays)
        raise ValueError(_check.message(names, "shapes that broadcast", shapes)) from error


def _angles(name: str, value: ArrayLike) -> Array:
    """Return angles from 0 to pi, a rounding of pi in a narrower type included."""
    angle = _check.floats(name, value)
    if not np.all((angle >= 0) & (angle <= np.pi * (1 + 1e-6))):
        raise ValueError(
            _check.message(name, "angles from 0 to pi, in radians", _check.describe(value))
        )
    clamped: Array = np.minimum(angle, angle.dtype.type(np.pi))
    return clamped


def _powers(name: str, value: ArrayLike, low: float = 0.0, high: float = _check.LARGEST) -> Array:
    power = _check.floats(name, value)
    if not np.all((power >= low) & (power <= high)):
        raise ValueError(
            _check.message(name, f"numbers from {low:g} to {high:g}", _check.describe(value))
        )
    return power
