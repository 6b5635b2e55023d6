"""The formulas a second time: one point at a time, mpmath at 50 digits, no code shared.

Inputs are taken as the exact numbers that the floats are; frames and directions are made
orthonormal here, in 50 digits. mpmath comes with the ``test`` extra.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from vizlight.studies._study import LackingError

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
    if not (a and b):
        return mp.nan, mp.nan, a, b, size
    alpha = _angle(rest_i, rest_o)
    lambert = a * (mp.sin(alpha) + (mp.pi - alpha) * mp.cos(alpha)) / 4
    if not (w and size):
        return lambert, mp.mpf(0), a, b, size
    beta, gamma, s = _angle(both, rest_o), _angle(both, rest_i), exact(shininess)
    mean = mp.cos(beta) * (_half(mp.cos(beta), shininess) + _half(mp.cos(gamma), shininess))
    ends = mp.sin(beta) ** (s + 1) - mp.sin(gamma) ** (s + 1)
    mean += mp.sin(beta) * ends / (s + 1)
    return lambert, (w / mp.sqrt(dot(half, half))) ** s * mean / 2, a, b, size


def _angle(u: Any, v: Any) -> Any:
    a, b = unit(u), unit(v)
    apart = [x - y for x, y in zip(a, b, strict=True)]
    near = [x + y for x, y in zip(a, b, strict=True)]
    return 2 * mp.atan2(mp.sqrt(dot(apart, apart)), mp.sqrt(dot(near, near)))


def _half(z: Any, shininess: float) -> Any:
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
