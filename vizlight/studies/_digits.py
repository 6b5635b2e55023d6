"""The formulas a second time: one point at a time, mpmath at 50 digits, no code shared.

Inputs are taken as the exact numbers that the floats are; frames and directions are made
orthonormal here, in 50 _digits. mpmath comes with the ``test`` extra.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from vizlight.studies._framework import LackingError

try:
    import mpmath
except ImportError as error:
    raise LackingError(
        "mpmath is missing, the reference of 50 digits; pip install 'vizlight[test]'"
    ) from error

mp: Any = mpmath.mp.clone()
mp.dps = 50


def exact(values: Any) -> Any:
    """Return nested lists of exact numbers."""
    if isinstance(values, mp.mpf):
        return values
    if np.ndim(values) == 0:
        return mp.mpf(float(values))
    return [exact(v) for v in values]


def dot(a: Any, b: Any) -> Any:
    """Return a dot product."""
    return mp.fdot(a, b)


def unit(v: Any) -> Any:
    """Return a unit vector; a zero one as it is."""
    size = mp.sqrt(dot(v, v))
    return [x / size for x in v] if size else v


def orthonormal(rows: Any) -> list[Any]:
    """Return orthonormal rows spanning the rows that are not zero."""
    frame: list[Any] = []
    for row in rows:
        for t in frame:
            c = dot(row, t)
            row = [x - c * y for x, y in zip(row, t, strict=True)]
        if any(row):
            frame.append(unit(row))
    return frame


def split(x: Any, frame: Any) -> tuple[list[Any], Any]:
    """Return tangential coefficients and the length of the rest."""
    along = [dot(x, t) for t in frame]
    rest = list(x)
    for c, t in zip(along, frame, strict=True):
        rest = [r - c * y for r, y in zip(rest, t, strict=True)]
    return along, mp.sqrt(dot(rest, rest))


def diffuse(wi: Any, frame: Any, exponent: Any) -> Any:
    """Return sin(a)^p."""
    _, sine = split(unit(exact(wi)), orthonormal(exact(frame)))
    return sine ** exact(exponent)


def specular(wi: Any, wo: Any, frame: Any, shininess: Any, model: str) -> Any:
    """Return max(0, |wi_N||wo_N| - wi_T.wo_T)^s, or |h_N|^q."""
    wi, wo, frame = unit(exact(wi)), unit(exact(wo)), orthonormal(exact(frame))
    if model == "phong":
        along_i, sine_i = split(wi, frame)
        along_o, sine_o = split(wo, frame)
        return max(mp.mpf(0), sine_i * sine_o - dot(along_i, along_o)) ** exact(shininess)
    half = [x + y for x, y in zip(wi, wo, strict=True)]
    if not any(half):
        return mp.mpf(0)
    return split(unit(half), frame)[1] ** exact(shininess)


def mean_intensity(k: int, n: int, p: Any) -> Any:
    """Return I(k, n, p) by the gamma functions themselves."""
    c, p = n - k, exact(p)
    log = (
        mp.loggamma(mp.mpf(n) / 2)
        + mp.loggamma((c + p) / 2)
        - mp.loggamma(mp.mpf(c) / 2)
        - mp.loggamma((n + p) / 2)
    )
    return mp.exp(log)


def cylinder(wi: Any, wo: Any, tangent: Any, shininess: float) -> tuple[Any, Any, Any, Any, Any]:
    """Return diffuse and specular of a thin cylinder, and what their claims are over.

    These are |wi_N|, |wo_N| and |wi + wo|, for powers below 1 |(wi + wo)_N|. By the closed form,
    with the integral by its recurrence for whole powers up to 100 and by mpmath's incomplete beta
    function for others; tests have the closed form from quadrature.
    """
    wi, wo, t = (unit(exact(v)) for v in (wi, wo, tangent))
    rest_i, rest_o = ([x - dot(v, t) * y for x, y in zip(v, t, strict=True)] for v in (wi, wo))
    both = [x + y for x, y in zip(rest_i, rest_o, strict=True)]
    half = [x + y for x, y in zip(wi, wo, strict=True)]
    a, b, w, size = (mp.sqrt(dot(v, v)) for v in (rest_i, rest_o, both, half))
    size = w if shininess < 1 else size
    if not a:
        return mp.mpf(0), mp.mpf(0), a, b, size
    if not b:
        return (*cylinder_end_on(wi, t, shininess), a, b, size)
    alpha = _angle(rest_i, rest_o)
    lambert = a * (mp.sin(alpha) + (mp.pi - alpha) * mp.cos(alpha)) / 4
    if not (w and size):
        return lambert, mp.mpf(0), a, b, size
    beta, gamma, s = _angle(both, rest_o), _angle(both, rest_i), exact(shininess)
    mean = mp.cos(beta) * (
        half_integral(mp.cos(beta), shininess) + half_integral(mp.cos(gamma), shininess)
    )
    ends = mp.sin(beta) ** (s + 1) - mp.sin(gamma) ** (s + 1)
    mean += mp.sin(beta) * ends / (s + 1)
    return lambert, (w / mp.sqrt(dot(half, half))) ** s * mean / 2, a, b, size


def cylinder_end_on(wi: Any, tangent: Any, shininess: float) -> tuple[Any, Any]:
    """Return diffuse and specular of a thin cylinder seen along itself: means over the round."""
    wi, t = (unit(exact(v)) for v in (wi, tangent))
    half = unit([x + y for x, y in zip(wi, t, strict=True)])
    s = exact(shininess)
    mean = mp.gamma((s + 1) / 2) / mp.gamma(s / 2 + 1) / (2 * mp.sqrt(mp.pi))
    return split(wi, [t])[1] / mp.pi, split(half, [t])[1] ** s * mean


def largest_differences(angle: Any, r: float, factor: Any) -> list[Any]:
    """Return the difference of most size of (1 - a x)^r and (1 - x)^(f r / 2), times 255.

    It is positive with a = 2 cos^2(angle / 2), x up to 1, and negative with a = 2, x up to 1/2;
    the larger is returned. A scan finds where; Newton's method on the derivative's logarithm, from
    there, what it is.
    """
    part = np.geomspace(1e-9, 0.5, 150)
    share = np.concatenate([[0.0], part, 1 - part[-2::-1], [1.0]])
    found = []
    for beta, f in zip(np.asarray(angle) / 2, factor, strict=True):
        power = exact(r) * exact(f) / 2
        wide = 2 * mp.cos(exact(beta)) ** 2
        sides = []
        for a, end, sign in ((wide, min(mp.mpf(1), 1 / wide), 1), (mp.mpf(2), mp.mpf(1) / 2, -1)):
            x = share * float(end)
            with np.errstate(divide="ignore"):
                phong = np.exp(r * np.log1p(-np.minimum(float(a) * x, 1)))
                blinn = np.exp(float(power) * np.log1p(-np.minimum(x, 1)))
            at = int(np.argmax(sign * (phong - blinn)))
            low, high = (exact(x[i]) for i in (max(at - 1, 0), min(at + 1, len(x) - 1)))
            places = [mp.mpf(0), end, _root(low, min(high, end), a, exact(r), power)]
            sides.append(max(sign * _difference(x, a, exact(r), power) for x in places))
        more, less = sides
        found.append(255 * (more if more >= less else -less))
    return found


def _difference(x: Any, a: Any, r: Any, power: Any) -> Any:
    return max(1 - a * x, mp.mpf(0)) ** r - (1 - x) ** power


def _root(low: Any, high: Any, a: Any, r: Any, power: Any) -> Any:
    """Return where the difference has a derivative of 0, by Newton's method within bounds."""

    def value(x: Any) -> Any:
        return (power - 1) * mp.log1p(-x) - (r - 1) * mp.log1p(-a * x) - mp.log(r * a / power)

    span = high - low
    low, high = low + span * mp.mpf("1e-30"), high - span * mp.mpf("1e-30")
    rises = value(high) > value(low)
    x = (low + high) / 2
    for _ in range(60):
        y = value(x)
        if (y > 0) == rises:
            high = x
        else:
            low = x
        step = y / ((r - 1) * a / (1 - a * x) - (power - 1) / (1 - x))
        before, x = x, x - step
        if not low < x < high:
            x = (low + high) / 2
        if abs(x - before) <= abs(x) * mp.mpf("1e-13"):
            break
    return x


def _angle(u: Any, v: Any) -> Any:
    a, b = unit(u), unit(v)
    apart = [x - y for x, y in zip(a, b, strict=True)]
    near = [x + y for x, y in zip(a, b, strict=True)]
    return 2 * mp.atan2(mp.sqrt(dot(apart, apart)), mp.sqrt(dot(near, near)))


def half_integral(z: Any, shininess: float) -> Any:
    """Return the integral of (1 - u^2)^(s/2) from 0 to z."""
    if shininess != int(shininess) or shininess > 100:
        whole = mp.betainc(mp.mpf(1) / 2, exact(shininess) / 2 + 1, 0, z * z) / 2
        return mp.sign(z) * whole
    square = 1 - z * z
    odd = int(shininess) % 2
    value = (z * mp.sqrt(square) + mp.asin(z)) / 2 if odd else z
    for s in range(2 + odd, int(shininess) + 1, 2):
        value = (z * square ** (mp.mpf(s) / 2) + s * value) / (s + 1)
    return value
