"""The oracle of 50 digits, and inputs on which kernels lose digits.

Inputs are taken as the exact numbers that the floats are.
"""

import math

import mpmath
import numpy as np

from vizlight.verify.oracle import Oracle

mp = mpmath.mp.clone()
mp.dps = 50


def exact(values):
    """Return nested lists of exact numbers."""
    if isinstance(values, mp.mpf):
        return values
    if isinstance(values, np.ndarray):
        values = values.astype(np.float64).tolist()
    if isinstance(values, list | tuple):
        return [exact(v) for v in values]
    return mp.mpf(float(values))


def cosine_integral(angle, power):
    """Return the integral of cos(x)^p from 0 to an angle, by the incomplete beta function."""
    x, q = mp.sin(angle) ** 2, (mp.mpf(power) + 1) / 2
    # What is beyond x is less than (1 - x)^q: no digit of the 50.
    whole = x == 1 or q * mp.log1p(-x) < -140
    value = mp.beta(0.5, q) if whole else mp.betainc(0.5, q, 0, x)
    return mp.sign(angle) * value / 2


digits = Oracle(
    number=exact, pi=+mp.pi, dot=mp.fdot, hypot=lambda *v: mp.sqrt(mp.fdot(v, v)), sin=mp.sin,
    cos=mp.cos, exp=mp.exp, log_gamma=mp.loggamma, atan2=mp.atan2, cosine_integral=cosine_integral,
)  # fmt: skip
dot, orthonormal, mean_intensity = digits.dot, digits.orthonormal, digits.mean_intensity


def unit(v):
    """Return a unit vector; a zero one as it is."""
    return digits.unit(v) or v


def size(v):
    """Return a length."""
    return digits.hypot(*v)


def split(x, frame):
    """Return tangential coefficients and the length of the rest."""
    return [dot(x, t) for t in frame], digits.across(x, frame)


def diffuse(wi, frame, exponent):
    """Return sin(a)^p."""
    return digits.across(unit(exact(wi)), orthonormal(frame)) ** exact(exponent)


def specular(wi, wo, frame, shininess, model):
    """Return max(0, |wi_N||wo_N| - wi_T.wo_T)^s, or |h_N|^q."""
    wi, wo = unit(exact(wi)), unit(exact(wo))
    return digits.specular(wi, wo, orthonormal(frame), exact(shininess), model)


def line_light(wi, wo, tangent, shininess):
    """Return diffuse and specular of a thin cylinder: means over its visible half."""
    return digits.line_light(*(unit(exact(v)) for v in (wi, wo, tangent)), exact(shininess))


def quadrature(wi, wo, tangent, shininess):
    """Return both terms of a thin cylinder by their integrals over normals, in 50 digits."""
    wi, wo, t = (unit(exact(v)) for v in (wi, wo, tangent))
    e1 = unit([x - dot(wo, t) * y for x, y in zip(wo, t, strict=True)])
    e2 = [
        t[1] * e1[2] - t[2] * e1[1],
        t[2] * e1[0] - t[0] * e1[2],
        t[0] * e1[1] - t[1] * e1[0],
    ]
    half = unit([x + y for x, y in zip(wi, wo, strict=True)])
    lx, ly, hx, hy = dot(wi, e1), dot(wi, e2), dot(half, e1), dot(half, e2)
    # A normal at angle x faces the light within a quarter turn of it, and the eye likewise.
    at, s, peak = mp.atan2(ly, lx), exact(shininess), mp.atan2(hy, hx)
    low, high = max(-mp.pi / 2, at - mp.pi / 2), min(mp.pi / 2, at + mp.pi / 2)
    if low >= high or not (lx or ly):
        return mp.mpf(0), mp.mpf(0)

    def lambert(x):
        return (lx * mp.cos(x) + ly * mp.sin(x)) * mp.cos(x) / 2

    def blinn(x):
        return max(hx * mp.cos(x) + hy * mp.sin(x), mp.mpf(0)) ** s * mp.cos(x) / 2

    # Cut at the highlight's place and width, which the quadrature must not miss.
    width = 1 / mp.sqrt(1 + s)
    inner = [peak + j * width for j in (-8, -4, -2, -1, 0, 1, 2, 4, 8)]
    cuts = [low, *(x for x in inner if low < x < high), high]
    return mp.quad(lambert, [low, high]), mp.quad(blinn, cuts)


def shade(point, tangents, normal, scene, **options):
    """Return (ambient, diffuse, specular, luminance, rgb) of one point, term by term."""
    lit = digits.light(point, tangents, normal, scene, apart=0.0, **options)
    return lit.ambient, lit.diffuse, lit.specular, lit.luminance, lit.rgb


def eps(dtype):
    return float(np.finfo(dtype).eps)


def frames(random, count, k, n, dtype):
    """Return random orthonormal frames, rounded to the type."""
    q, _ = np.linalg.qr(random.standard_normal((count, n, k)))
    return np.swapaxes(q, 1, 2).astype(dtype)


def diffuse_bound(p, eps):
    """Return the error stated by :func:`vizlight.model.reflection.diffuse`, absolute."""
    if p < 1:
        return float((8 * eps) ** p)
    return (4 + 2 * p if p <= 128 else 8 + math.sqrt(p)) * eps


def specular_bound(s, eps):
    """Return the error stated by :func:`vizlight.model.reflection.specular`, |wi + wo| >= 1."""
    if s < 1:
        return float((8 * eps) ** s)
    return (4 + s if s <= 128 else 8 + 3 * math.sqrt(s)) * eps
