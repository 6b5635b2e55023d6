"""Elementary functions of compiled kernels, as text for float32 and float64."""

from __future__ import annotations

from collections.abc import Iterable

#: Elementary functions: exp of numbers of 0 or less, log of x where d = 1 - x is known, arctan2 of
#: y of 0 or more, and the table of the cylinder's integral. Polynomials are from Cephes.
PRELUDE = """
def log_(x, d):
    bits = F(x).view(I)
    e = I((bits - ROOT) >> MANTISSA)
    m = I(bits - I(e << MANTISSA)).view(F)
    g = -d if e == I(0) else m - F(1)
    z = g * g
    ef = F(e)
{log}
    y = y + ef * LN2_LOW
    y = y - F(0.5) * z
    return (g + y) + ef * LN2_HIGH

def exp_(x):
    x = x if x > LOWEST else LOWEST
    t = x * LOG2_E + MAGIC
    e = I(F(t).view(I) - MAGIC_BITS)
    t = t - MAGIC
    r = x - t * LN2_HIGH
    r = r - t * LN2_LOW
    z = r * r
{exp}
    return I(F(y).view(I) + I(e << MANTISSA)).view(F)

def arctan2_(y, x):
    u = abs(x)
    big = u if u > y else y
    small = y if u > y else u
    t = small / (big if big > F(0) else F(1))
    far = t > F(0.4142135623730950)
    v = (t - F(1)) / (t + F(1)) if far else t
    z = v * v
{arctan}
    a = (F(0.7853981633974483) + p) if far else p
    a = F(1.5707963267948966) - a if y > u else a
    return F(3.141592653589793) - a if x < F(0) else a

def integral_(z, table, cells, scale):
    count = I(cells)
    place = abs(z) * scale
    place = place if place < cells else cells
    cell = I(place)
    cell = cell if cell < count else count - I(1)
    u = place - F(cell)
    v = table[I(5) * count + cell]
    v = v * u + table[I(4) * count + cell]
    v = v * u + table[I(3) * count + cell]
    v = v * u + table[I(2) * count + cell]
    v = v * u + table[count + cell]
    v = v * u + table[cell]
    return -v if z < F(0) else v
"""
HELPERS = ("log_", "exp_", "arctan2_", "integral_")


def _horner(name: str, coefficients: Iterable[float], variable: str, *, monic: bool = False) -> str:
    """Return the lines that evaluate a polynomial, highest power first."""
    first, *rest = coefficients
    lines = [f"    {name} = {variable} + F({first!r})" if monic else f"    {name} = F({first!r})"]
    lines += [f"    {name} = {name} * {variable} + F({c!r})" for c in rest]
    return "\n".join(lines)


def prelude(work: str) -> str:
    """Return the head of a kernel's text: types, constants and elementary functions."""
    if work == "f4":
        # log(1 + g) = g - g^2 / 2 + g^3 y(g), where 1 + g is between the roots of 1/2 and of 2; the
        # square is taken off apart, in the common part of the text.
        log = _horner("y", (
            7.0376836292e-2, -1.1514610310e-1, 1.1676998740e-1, -1.2420140846e-1, 1.4249322787e-1,
            -1.6668057665e-1, 2.0000714765e-1, -2.4999993993e-1, 3.3333331174e-1,
        ), "g")  # fmt: skip
        log += "\n    y = y * g * z"
        # exp(r) = 1 + r + r^2 y(r), where r is what multiples of ln(2) leave.
        exp = _horner("y", (
            1.9875691500e-4, 1.3981999507e-3, 8.3334519073e-3, 4.1665795894e-2, 1.6666665459e-1,
            5.0000001201e-1,
        ), "r")  # fmt: skip
        exp += "\n    y = y * z + r + F(1)"
        # arctan(v) = v + v^3 p(v^2).
        arctan = _horner("p", (
            8.05374449538e-2, -1.38776856032e-1, 1.99777106478e-1, -3.33329491539e-1,
        ), "z")  # fmt: skip
        arctan += "\n    p = p * z * v + v"
        # Bits of the fraction, by which exponents are shifted to and from their place in a number.
        kinds = "F, I, MANTISSA = np.float32, np.int32, np.int32(23)"
        # The magic number is 1.5 times 2^23 (2^52 in float64): a sum with it has no bits left for a
        # fraction, so it is rounded to a whole number, which its last bits hold.
        low, magic = -87.0, 12582912.0
        # ln(2) is in two parts, the first of so few bits that its product with a whole exponent is
        # exact.
        second = -2.12194440e-4
    else:
        # log(1 + g) = g - g^2 / 2 + g^3 P(g) / Q(g).
        log = _horner("p", (
            1.01875663804580931796e-4, 4.97494994976747001425e-1, 4.70579119878881725854,
            1.44989225341610930846e1, 1.79368678507819816313e1, 7.70838733755885391666,
        ), "g")  # fmt: skip
        log += "\n" + _horner("q", (
            1.12873587189167450590e1, 4.52279145837532221105e1, 8.29875266912776603211e1,
            7.11544750618563894466e1, 2.31251620126765340583e1,
        ), "g", monic=True)  # fmt: skip
        log += "\n    y = g * (z * p / q)"
        # exp(r) = 1 + 2 r P(r^2) / (Q(r^2) - r P(r^2)).
        exp = _horner("p", (
            1.26177193074810590878e-4, 3.02994407707441961300e-2, 9.99999999999999999910e-1,
        ), "z")  # fmt: skip
        exp += "\n    p = p * r\n" + _horner("q", (
            3.00198505138664455042e-6, 2.52448340349684104192e-3, 2.27265548208155028766e-1,
            2.00000000000000000009,
        ), "z")  # fmt: skip
        exp += "\n    y = F(1) + F(2) * (p / (q - p))"
        # arctan(v) = v + v^3 P(v^2) / Q(v^2).
        arctan = _horner("p", (
            -8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
            -1.228866684490136173410e2, -6.485021904942025371773e1,
        ), "z")  # fmt: skip
        arctan += "\n" + _horner("q", (
            2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
            4.853903996359136964868e2, 1.945506571482613964425e2,
        ), "z", monic=True)  # fmt: skip
        arctan += "\n    p = v * (z * p / q) + v"
        kinds = "F, I, MANTISSA = np.float64, np.int64, np.int64(52)"
        # At about the least x whose exp is a normal number, which the bits of an exponent can hold.
        low, magic = -708.0, 6755399441055744.0
        second = -2.121944400546905827679e-4
    constants = f"""
import numpy as np
{kinds}
ROOT, MAGIC = F(0.7071067811865476).view(I), F({magic!r})
MAGIC_BITS, LOWEST, LOG2_E = MAGIC.view(I), F({low!r}), F(1.4426950408889634)
LN2_HIGH, LN2_LOW = F(0.693359375), F({second!r})
LEAST_f4 = np.finfo(np.float32).tiny / np.finfo(np.float32).eps
LEAST_f8 = np.finfo(np.float64).tiny / np.finfo(np.float64).eps
MOST_f4, MOST_f8 = np.finfo(np.float32).max, np.finfo(np.float64).max
# Squares in float64 of lengths that float32 holds.
LEAST_f8_of_f4, MOST_f8_of_f4 = 1e-70, 1e70
LOST = F(np.nan)
"""
    return constants + PRELUDE.format(log=log, exp=exp, arctan=arctan)
