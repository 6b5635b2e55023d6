"""What some kernels are compared with beside the oracle's formulas, in 50 digits."""

import numpy as np
import oracles
from oracles import exact, mp, unit


def cylinder(wi, wo, tangent, shininess):
    """Return diffuse and specular of a thin cylinder, and what their claims are over.

    These are |wi_N|, |wo_N| and |wi + wo|, for powers below 1 |(wi + wo)_N|.
    """
    wi, wo, t = (unit(exact(v)) for v in (wi, wo, tangent))
    half = [x + y for x, y in zip(wi, wo, strict=True)]
    a, b = (oracles.digits.across(v, [t]) for v in (wi, wo))
    size = oracles.digits.across(half, [t]) if shininess < 1 else oracles.size(half)
    return *oracles.digits.line_light(wi, wo, t, exact(shininess)), a, b, size


def largest_differences(angle, r, factor):
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


def _difference(x, a, r, power):
    return max(1 - a * x, mp.mpf(0)) ** r - (1 - x) ** power


def _root(low, high, a, r, power):
    """Return where the difference has a derivative of 0, by Newton's method within bounds."""

    def value(x):
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
