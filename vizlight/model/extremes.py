"""Numerics of :mod:`.highlights`: extremes and spherical means of Phong minus Blinn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vizlight._types import Array

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
    wide = 2 * np.square(np.cos(beta))
    more, at_more = _maximum(wide, r, factor * r, np.ones_like(beta), 1.0)
    end = np.minimum(0.5, np.square(np.cos(beta))) if lit else np.full_like(beta, 0.5)
    less, at_less = _maximum(np.full_like(beta, 2.0), r, factor * r, end, -1.0)
    return more, less, at_more, at_less


def _maximum(a: Array, r: Array, q: Array, end: Array, sign: float) -> tuple[Array, Array]:
    """Return the maximum over x from 0 to ``end`` of a signed :func:`difference`, and its x."""
    m = q / 2
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        end = np.minimum(end, 1 / a)

        def slope(x: Array) -> Array:
            return (
                (m - 1) * np.log1p(-x)
                - (r - 1) * np.log1p(-np.minimum(a * x, 1))
                - np.log(r * a / m)
            )

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
    end = np.arctan2(cos_beta, sin_beta * np.sin(psi))
    # The panels grow geometrically; the first one is as wide as the narrower highlight.
    least = min(end.min(), 0.5 / np.sqrt(r * max(factor, 4.0)))
    panels = max(int(np.ceil(np.log2(max(float(end.max()) / least, 1)))) + 1, 2)
    cuts = np.concatenate([[0.0], 2.0 ** np.arange(1 - panels, 1)])
    nodes, weights = np.polynomial.legendre.leggauss(NODES[0])
    u = (cuts[:-1, None] + np.diff(cuts)[:, None] * (1 + nodes) / 2).ravel()
    du = (np.diff(cuts)[:, None] / 2 * weights).ravel()
    nu = np.multiply.outer(end, u)
    sine = np.sin(nu)
    a = 2 * (1 - np.square(sin_beta * np.cos(psi)))[:, np.newaxis]
    error = difference(sine * sine, a, np.asarray(r), np.asarray(factor * r))
    measure = sine * du * (end * round_weights)[:, np.newaxis]
    area = float(measure.sum())
    if area == 0:
        return {"rms": 0.0, "volume": 0.0}
    mean_square = float((error * error * measure).sum() / area)
    return {
        "rms": PEAK * float(np.sqrt(mean_square)),
        "volume": PEAK * float((np.abs(error) * measure).sum() / area),
    }
