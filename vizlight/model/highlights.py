"""Conversion between the exponents of Phong and Blinn, and the error that remains.

L, E and N of the source are ``wi``, ``wo`` and the normal. rho is the angle from the reflection R
to the eye, nu the angle from N to the half vector H, 2 beta the angle from L to E, and theta the
angle from N to the perpendicular of L and E. Pixel errors are differences of two highlights whose
peak is 255.

All results follow from one pair of bounds. With ``x = |h_T|^2 = 1 - |h_N|^2``, in any codimension::

    V.R = 1 - 2 cos^2(beta) x - (|wi_N| - |wo_N|)^2 / 2                       (9')
    1 - 2 x  <=  V.R  <=  1 - 2 cos^2(beta) x

(9') follows from ``|wi + wo|^2 = 4 cos^2(beta)``; in codimension 1 it is Fisher and Woo's (9). The
upper bound is reached where ``|wi_N| = |wo_N|``. The lower bound is reached where wi, wo and a
normal are coplanar; it holds because Banks' reflection is the nearest to the eye of a set that
contains the reflection about h_N. A highlight of Phong therefore lies between two of Blinn, whose
exponents are 4 cos^2(beta) and 4 times its own, and the worst error is a maximum over x alone.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array
from vizlight.model.brightness import dimensions
from vizlight.model.frames import result

__all__ = [
    "MaximumError", "best_factor", "blinn_from_phong", "exchange_rate", "max_pixel_error",
    "phong_from_blinn", "pixel_error", "required_factor", "simple_factor", "sphere_error",
]  # fmt: skip


Measure = Literal["worst", "rms", "volume"]


class MaximumError(NamedTuple):
    """Largest error by magnitude, with its sign, and the normal at which it occurs.

    Attributes
    ----------
    error : ndarray
        Phong minus Blinn, in pixel values, with the sign as in Fisher and Woo's table 3.
    theta, phi : ndarray
        Angles of the normal ``(-sin theta cos phi, cos theta, sin theta sin phi)``, in radians,
        where E is along +z and L in the xz plane with x <= 0 (figure 4).
    """

    error: Array
    theta: Array
    phi: Array


def required_factor(rho: ArrayLike, /) -> Array:
    """Return the factor f with ``cos(rho)^r = cos(rho / 2)^(f r)`` for coplanar L, N and E.

    Parameters
    ----------
    rho : array_like, shape (...)
        Angle from the reflection to the eye, in radians, from 0 to pi.

    Returns
    -------
    ndarray, shape (...)
        4 at 0, growing to infinity at pi / 2; infinity beyond, where Phong's highlight is 0.

    Raises
    ------
    TypeError, ValueError
        If an angle is not a real number from 0 to pi.

    Notes
    -----
    Source: Fisher and Woo (5) and table 1. Relative error at most 8 eps up to an angle of 1.5;
    nearer to pi / 2 the rounding of the angle itself is magnified by ``1 / (pi / 2 - rho)``.
    """
    angle = _angles("rho", rho)
    with np.errstate(divide="ignore", invalid="ignore", under="ignore"):
        small, sine = np.cos(angle), np.sin(angle)
        # Near 1 a cosine has lost the digits of its logarithm, which the sine still has.
        numerator = np.where(
            small > 0.7, 0.5 * np.log1p(-(sine * sine)), np.log(np.maximum(small, 0))
        )
        half = np.sin(angle / 2)
        factor = numerator / (0.5 * np.log1p(-(half * half)))
    factor = np.where(small > 0, factor, np.inf)
    # Below this angle the squares of sines underflow, and f differs from 4 only by rho^2.
    tiny = angle < np.sqrt(np.finfo(angle.dtype).eps) / 16
    return result(np.where(tiny, 4, factor).astype(angle.dtype, copy=False))


def pixel_error(rho: ArrayLike, r: ArrayLike, /, *, factor: ArrayLike = 4.0) -> Array:
    """Return Blinn's highlight minus Phong's where L, N and E are coplanar.

    Parameters
    ----------
    rho : array_like, shape (...)
        Angle from the reflection to the eye, in radians, from 0 to pi.
    r : array_like, shape (...)
        Phong's shininess, from 0 to 1e9.
    factor : array_like, shape (...), default: 4.0
        Ratio of Blinn's shininess ``factor * r`` to Phong's, from 0 to 1e9.

    Returns
    -------
    ndarray, shape (...)
        ``255 (cos(rho/2)^(f r) - max(0, cos rho)^r)``, in pixel values.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    The cosine of an angle beyond pi / 2 counts as 0. Absolute error at most ``255 (3 eps)`` for f
    of 1 or more, for every exponent. Source: Fisher and Woo (6). The last digit of their table 2 is
    off by one in some places of its first row and at 20 degrees, r = 30, where it is 1.162.
    """
    angle, r, factor = _angles("rho", rho), _powers("r", r), _powers("factor", factor)
    angle, r, factor = _check.together(rho=angle, r=r, factor=factor)
    q = factor * r
    with np.errstate(divide="ignore", invalid="ignore", under="ignore"):
        # cos^2(rho / 2) = 1 - x and cos(rho) = 1 - 2 x: both logarithms are of deficits.
        x = np.square(np.sin(angle / 2))
        # Beyond a right angle the cosine itself is accurate.
        log = np.where(x < 0.5, np.log1p(-x) / 2, np.log(np.cos(angle / 2)))
        blinn = np.where(q == 0, 1, np.exp(q * log))
        phong = np.where(r == 0, 1, np.exp(r * np.log1p(-np.minimum(2 * x, 1))))
    return result(PEAK * (blinn - phong))


def max_pixel_error(
    light_eye_angle: ArrayLike, r: ArrayLike, /, *, factor: ArrayLike = 4.0, lit: bool = False
) -> MaximumError:
    """Return the largest difference between Phong and Blinn over all normals, and its location.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    r, factor
        As for :func:`pixel_error`.
    lit : bool, default: False
        Whether only normals that face the light are searched; otherwise all that face the eye.

    Returns
    -------
    MaximumError
        ``error``, ``theta`` and ``phi``, each of shape (...). The mirror image of the normal in
        the plane of light and eye has the same error; at angle 0 a whole circle of normals has it.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    By the bounds of this module, Phong exceeds Blinn most where ``|wi_N| = |wo_N|`` and falls short
    most where the three vectors are coplanar. In both cases the error is
    ``(1 - a x)^r - (1 - x)^(f r / 2)`` with a = 2 cos^2(beta) or a = 2. The logarithm of the ratio
    of its derivative's two terms has one turning point, so each side of that point holds at most
    one root, which bisection finds to the last digit; there is no starting value and no local
    optimum. The result bounds the error **in every codimension**; for an eye or a lamp at a
    position the largest over the angles that occur is a bound (study ``highlights``). The absolute
    error of ``error`` is at most ``255 (4 eps)`` for every exponent. As r goes to infinity with
    f = 4 it tends to ``255 (1 - C) C^(C / (1 - C))``, C = cos^2(beta). Source: Fisher and Woo,
    table 3, where some last digits are off by one.
    """
    angle = _angles("light_eye_angle", light_eye_angle)
    r, factor = _powers("r", r), _powers("factor", factor)
    beta, r, factor = _check.together(light_eye_angle=angle / 2, r=r, factor=factor)
    more, less, at_more, at_less = extremes(beta, r, factor, lit=_check.boolean("lit", lit))
    phong_wins = more >= less
    # Phong exceeds most where N leans from H toward the perpendicular of light and eye, and falls
    # short most where it leans in their plane.
    theta = np.where(phong_wins, np.pi / 2 - np.arcsin(np.sqrt(at_more)), np.pi / 2)
    phi = np.pi / 2 - beta + np.where(phong_wins, 0, np.arcsin(np.sqrt(at_less)))
    error = PEAK * np.where(phong_wins, more, -less)
    return MaximumError(result(error), result(theta), result(phi))


def best_factor(light_eye_angle: ArrayLike, r: ArrayLike, /, *, by: Measure = "worst") -> Array:
    """Return the factor f for which Blinn with exponent f r is nearest to Phong with exponent r.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    r : array_like, shape (...)
        Phong's shininess, from 0.5 to 1e6.
    by : {"worst", "rms", "volume"}
        Error that is minimised over the normals that face both light and eye: the largest error,
        the root mean square, or the mean absolute error (the volume between both highlights).

    Returns
    -------
    ndarray, shape (...)
        Factor from 1e-3 to 16; at 180 degrees, where no normal faces both, an end of that range.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    See Also
    --------
    simple_factor : 4 cos(beta), the limit of the factor for ``by="worst"``.

    Notes
    -----
    As f grows Phong exceeds Blinn by more and falls short by less, so the worst error is least
    where both are equal, a root that bisection finds. The other two measures are quadratures over
    normals, minimised over f to 1e-4 by SciPy's bounded minimiser; that of the volume, which has
    kinks, moves f by up to 2 %.
    """
    _check.choice("by", by, get_args(Measure))
    angle = _angles("light_eye_angle", light_eye_angle).astype(np.float64)
    r = _powers("r", r, low=0.5, high=1e6).astype(np.float64)
    beta, r = _check.together(light_eye_angle=angle / 2, r=r)
    if by == "worst":
        # Bisection of the logarithm has the same relative error for small and large factors.
        low, high = np.full(beta.shape, np.log(1e-3)), np.full(beta.shape, np.log(16.0))
        for _ in range(36):
            middle = (low + high) / 2
            more, less, _, _ = extremes(beta, r, np.exp(middle), lit=True)
            low, high = np.where(more < less, middle, low), np.where(more < less, high, middle)
        return result(np.exp(low))
    from scipy.optimize import minimize_scalar

    best = np.empty(beta.shape)
    for at in np.ndindex(beta.shape):
        b, s = float(beta[at]), float(r[at])
        minimum = minimize_scalar(
            lambda log, b=b, s=s: sphere_errors(b, s, float(np.exp(log)))[by],
            bounds=(np.log(1e-3), np.log(16.0)),
            method="bounded",
            options={"xatol": 1e-5},
        )
        best[at] = np.exp(minimum.x)
    return result(best)


def simple_factor(light_eye_angle: ArrayLike, r: ArrayLike | None = None, /) -> Array:
    """Return 4 cos(beta), a better factor than 4; beta is half the angle between light and eye.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    r : array_like, shape (...), optional
        Phong's shininess, from 0.5 to 1e9. If given, the factor is corrected for small exponents:
        ``4 cos(beta) (1 + (2 cos(beta) - 1) / (3 r))``.

    Returns
    -------
    ndarray, shape (...)
        Factor; without r from 4 to 0 and equal to ``2 |wi + wo|``, which needs no angle.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid, or the shapes do not broadcast.

    Notes
    -----
    For large exponents Phong's highlight lies between the Gaussians of 4 cos^2(beta) and of 4.
    Their geometric mean makes the errors of both signs equal, ``255 (1 - c) c^(c / (1 - c))`` with
    c = cos(beta) instead of cos^2(beta): 63.75 at 120 degrees instead of 120.5. On a surface it is
    also the factor for which both highlights contain the same amount of light. The correction is
    fitted to :func:`best_factor`: from r = 10 on and up to 120 degrees its worst error is within a
    tenth, or half a pixel value, of the least, and at most 0.1 above the error of the factor 4.
    """
    angle = _angles("light_eye_angle", light_eye_angle)
    if r is None:
        return result(4 * np.cos(angle / 2))
    angle, power = _check.together(light_eye_angle=angle, r=_powers("r", r, low=0.5))
    cosine = np.cos(angle / 2)
    return result(4 * cosine * (1 + (2 * cosine - 1) / (3 * power)))


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
        Ratio of Blinn's shininess ``factor * r`` to Phong's, from 1e-3 to 1e3.
    by : {"rms", "volume", "worst"}
        Measure of the error: the root mean square or the mean absolute error over the normals that
        face both light and eye, with equal weight, or the largest absolute error.

    Returns
    -------
    float

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    Gauss-Legendre quadrature in panels scaled to the highlight. The relative error is below 1e-4
    for exponents of 5 or more and angles up to 170 degrees, where both models stay smooth.
    """
    angle = _check.number("light_eye_angle", light_eye_angle, low=0.0, high=float(np.pi))
    r = _check.number("r", r, low=0.5, high=1e6)
    factor = _check.number("factor", factor, low=1e-3, high=1e3)
    _check.choice("by", by, get_args(Measure))
    if by == "worst":
        return float(abs(max_pixel_error(angle, r, factor=factor, lit=True).error))
    return sphere_errors(angle / 2, r, factor)[by]


def blinn_from_phong(
    shininess: ArrayLike, /, *, light_eye_angle: ArrayLike | None = None, factor: float = 4.0
) -> Array:
    """Return the shininess that gives Blinn's model a highlight like Phong's.

    Parameters
    ----------
    shininess : array_like, shape (...)
        Phong's shininess, from 0 to 1e9.
    light_eye_angle : array_like, shape (...), optional
        Angle between light and eye, in radians, from 0 to pi. If given, its
        :func:`simple_factor` is used.
    factor : float, default: 4.0
        Factor above 0 that is used if no angle is given.

    Returns
    -------
    ndarray, shape (...)

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.
    """
    by = _factor(light_eye_angle, factor)
    power, by = _check.together(shininess=_powers("shininess", shininess), light_eye_angle=by)
    return result(power * by)


def phong_from_blinn(
    shininess: ArrayLike, /, *, light_eye_angle: ArrayLike | None = None, factor: float = 4.0
) -> Array:
    """Return the shininess for Phong's model, the inverse of :func:`blinn_from_phong`.

    Parameters
    ----------
    shininess : array_like, shape (...)
        Blinn's shininess, from 0 to 1e18.
    light_eye_angle, factor
        As for :func:`blinn_from_phong`, but the angle is less than pi, where the factor is 0.

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
        remedy = "at pi no half vector exists"
        raise _check.value_error("light_eye_angle", "an angle below pi", "pi", remedy)
    power = _powers("shininess", shininess, high=_check.LARGEST**2)
    power, by = _check.together(shininess=power, light_eye_angle=by)
    return result(power / by)


def exchange_rate(light_eye_angle: ArrayLike, /, *, k: int = 2, n: int = 3) -> Array:
    """Return the factor between the exponents of Blinn and Phong for a k-manifold in n-space.

    Parameters
    ----------
    light_eye_angle : array_like, shape (...)
        Angle 2 beta between light and eye, in radians, from 0 to pi.
    k, n : int
        Dimensions of the manifold and of the space, 0 < k < n.

    Returns
    -------
    ndarray, shape (...)
        Factor; 4 at angle 0 for all k and n.

    Raises
    ------
    TypeError, ValueError
        If a value is out of its range.

    Notes
    -----
    Both models are 1 on the same tangent spaces, those perpendicular to h. Near one of them let
    ``w = wi + wo`` and ``d = wi - wo``, which are perpendicular to each other, and let the
    tangential part w_T be small. Then ``|wi_N|^2 - |wo_N|^2 = -w_T . d_T`` and (9') give::

        -log V.R    = (|w_T|^2 + (w_T . d_T)^2 / (4 - |d_T|^2)) / 2
        -log |h_N|  = |w_T|^2 / (8 cos^2 beta)

    In k - 1 directions of w_T the ratio is therefore 4 cos^2(beta), and in the direction of d_T it
    is ``4 cos^2(beta) / (1 - m^2 sin^2(beta))``, where m is the share of d inside the tangent
    space. In codimension 1 all of d is inside (m = 1), which gives 4 cos^2(beta) and 4. In higher
    codimension m^2 is distributed over the bright set as a beta variable of k/2 and (c - 1)/2. The
    returned factor preserves the volume of the highlight, its geometric mean over directions and
    the bright set::

        4 cos^2(beta) exp(-E[log(1 - m^2 sin^2 beta)] / k)

    This is 4 cos(beta) for a surface in 3-space, 4 for a curve in the plane and
    ``(4 cos(beta) / (1 + cos(beta)))^2`` for a line in 3-space. For the worst error
    :func:`simple_factor` is the best factor in every codimension, except for a curve in the plane.
    Relative error at most 1e-11 up to 170 degrees.
    """
    k, n = dimensions(k, n)
    beta = _angles("light_eye_angle", light_eye_angle) / 2
    cosine = np.cos(beta)
    # All of wi - wo is inside near the highlight (m = 1), so that the mean has one value.
    if n - k == 1:
        return result(4 * np.power(cosine, 2 - 2 / k))
    from scipy.special import roots_jacobi

    c = n - k
    # With m = cos(u) and directions of equal weight the density is sin^(c-2) cos^(k-1).
    # The substitution share = m^2 turns the density into Jacobi's weights on [-1, 1].
    nodes, weights = roots_jacobi(400, (c - 3) / 2, (k - 2) / 2)
    share = (1 + nodes) / 2
    log = np.log1p(-np.multiply.outer(np.square(np.sin(beta)), share))
    mean = log @ (weights / weights.sum())
    return result(4 * np.square(cosine) * np.exp(-mean / k))


def _factor(light_eye_angle: ArrayLike | None, factor: float) -> Array:
    if light_eye_angle is not None:
        return np.asarray(simple_factor(light_eye_angle))
    return np.asarray(_check.number("factor", factor, low=1e-9, high=_check.LARGEST))


def _angles(name: str, value: ArrayLike) -> Array:
    """Return angles from 0 to pi; pi rounded up to a narrower type is accepted and clamped."""
    angle = _check.floats(name, value)
    if not np.all((angle >= 0) & (angle <= np.pi * (1 + 1e-6))):
        raise _check.value_error(name, "angles from 0 to pi, in radians", _check.describe(value))
    return np.minimum(angle, angle.dtype.type(np.pi))


def _powers(name: str, value: ArrayLike, low: float = 0.0, high: float = _check.LARGEST) -> Array:
    return _check.floats_in(name, value, low, high)


#: Pixel value of the peak of a highlight.
PEAK = 255.0
#: Bisections of an interval: enough to reach the last digit of a root near 0.
HALVINGS = 64
#: Nodes of the quadrature over normals: radial per panel of the highlight, and around it.
NODES = (40, 96)


def difference(x: Array, a: Array, r: Array, q: Array) -> Array:
    """Return ``max(0, 1 - a x)^r - (1 - x)^(q / 2)``, 0^0 = 1, through logarithms of deficits."""
    with np.errstate(divide="ignore", invalid="ignore", under="ignore", over="ignore"):
        phong = np.where(r == 0, 1, np.exp(r * np.log1p(-np.minimum(a * x, 1))))
        blinn = np.where(q == 0, 1, np.exp(q / 2 * np.log1p(-np.minimum(x, 1))))
    return phong - blinn


def extremes(
    beta: Array, r: Array, factor: Array, *, lit: bool
) -> tuple[Array, Array, Array, Array]:
    """Return the most by which Phong exceeds Blinn and falls short of it, and the x of each."""
    # The bounds of V.R in (9'): the upper one has a = 2 cos^2(beta), the lower one a = 2.
    wide = 2 * np.square(np.cos(beta))
    more, at_more = _maximum(wide, r, factor * r, np.ones_like(beta), 1.0)
    end = np.minimum(0.5, np.square(np.cos(beta))) if lit else np.full_like(beta, 0.5)
    less, at_less = _maximum(np.full_like(beta, 2.0), r, factor * r, end, -1.0)
    return more, less, at_more, at_less


def _maximum(a: Array, r: Array, q: Array, end: Array, sign: float) -> tuple[Array, Array]:
    """Return the maximum over x from 0 to ``end`` of a signed :func:`difference`, and its x."""
    m = q / 2
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        # Beyond 1 / a Phong's highlight is 0 and Blinn's never rises: no difference there is
        # larger.
        end = np.minimum(end, 1 / a)

        # The logarithm of the ratio of both terms of the derivative: 0 where they are equal.
        def slope(x: Array) -> Array:
            return (
                (m - 1) * np.log1p(-x)
                - (r - 1) * np.log1p(-np.minimum(a * x, 1))
                - np.log(r * a / m)
            )

        # Where the derivative of `slope` is 0: on either side of it there is one root at most.
        turn = ((m - 1) - (r - 1) * a) / (a * (m - r))
        turn = np.where((turn > 0) & (turn < end), turn, end)
        best, where = np.zeros_like(end), np.zeros_like(end)
        for low, high in ((np.zeros_like(end), turn), (turn, end)):
            side = slope(low + (high - low) * 1e-300) > 0
            near, far = low, high
            for _ in range(HALVINGS):
                middle = (near + far) / 2
                same = (slope(middle) > 0) == side
                near, far = np.where(same, middle, near), np.where(same, far, middle)
            # A maximum is at the root or at the end of its side.
            for x in (near, high):
                value = sign * difference(x, a, r, q)
                better = value > best
                best, where = np.where(better, value, best), np.where(better, x, where)
    return best, where


def sphere_errors(beta: float, r: float, factor: float) -> dict[str, float]:
    """Return the RMS and the mean absolute error over normals that face both light and eye.

    N = cos(nu) H + sin(nu) (cos(psi) P + sin(psi) Q), where P is perpendicular to light and eye. By
    symmetry psi covers a quarter of the circle; the region ends where N.E or N.L is 0.
    """
    round_nodes, round_weights = np.polynomial.legendre.leggauss(NODES[1])
    psi = np.pi / 4 * (1 + round_nodes)
    cos_beta, sin_beta = np.cos(beta), np.sin(beta)
    # Where N.E or N.L is 0: tan(nu) = cos(beta) / (sin(beta) sin(psi)).
    end = np.arctan2(cos_beta, sin_beta * np.sin(psi))
    # The panels grow geometrically; the first one is as wide as the narrower highlight.
    least = min(end.min(), 0.5 / np.sqrt(r * max(factor, 4.0)))
    panels = max(int(np.ceil(np.log2(max(float(end.max()) / least, 1)))) + 1, 2)
    cuts = np.concatenate([[0.0], 2.0 ** np.arange(1 - panels, 1)])
    nodes, weights = np.polynomial.legendre.leggauss(NODES[0])
    u = (cuts[:-1, None] + np.diff(cuts)[:, None] * (1 + nodes) / 2).ravel()
    du = (np.diff(cuts)[:, None] / 2 * weights).ravel()
    # The panels are shares of nu's range, which ends elsewhere for each psi.
    nu = np.multiply.outer(end, u)
    sine = np.sin(nu)
    # By (9') with |wi_N| - |wo_N| = 2 sin(beta) sin(nu) sin(psi), V.R is 1 - a sin^2(nu).
    a = 2 * (1 - np.square(sin_beta * np.cos(psi)))[:, np.newaxis]
    error = difference(sine * sine, a, np.asarray(r), np.asarray(factor * r))
    # The area on the sphere of normals is sin(nu) dnu dpsi.
    measure = sine * du * (end * round_weights)[:, np.newaxis]
    # Between opposite light and eye no normal faces both.
    area = float(measure.sum())
    if area == 0:
        return {"rms": 0.0, "volume": 0.0}
    mean_square = float((error * error * measure).sum() / area)
    return {
        "rms": PEAK * float(np.sqrt(mean_square)),
        "volume": PEAK * float((np.abs(error) * measure).sum() / area),
    }
