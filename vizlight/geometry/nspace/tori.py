"""Products of circles, curves on them, and the Hopf fibres of the 3-sphere."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.geometry.nspace import lattice
from vizlight.geometry.nspace.parametric import Manifold, manifold

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from vizlight._types import Array

TURN = 2 * np.pi
#: Largest radius whose square is well within the range of float64.
LARGEST_RADIUS = 1e150


def torus(*radii: float, resolution: int | Sequence[int] = 64) -> Manifold:
    """Return the product of 1 to 3 circles, a k-torus in 2k-space.

    ``torus(r1, r2)`` is the torus of Banks, section 3, a surface in 4-space:
    ``(r1 cos t, r1 sin t, r2 cos f, r2 sin f)``; ``torus(r1, r2, r3)`` is the 3-torus in 6-space.

    Parameters
    ----------
    *radii : float
        Radii of the circles, above 0, in any unit.
    resolution : int or one for each circle, default: 64
        Number of samples on a circle, 3 or more.

    Returns
    -------
    Manifold
        Segments, quadrilaterals or hexahedra without a boundary.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The tangents are orthonormal by construction. The error of points, relative to the largest
    radius, and of tangents is 8 eps per component, including the error of the angle. Source: Banks,
    section 3.
    """
    if not 1 <= len(radii) <= 3:
        raise ValueError(_check.message("radii", "1 to 3 radii", len(radii)))
    sizes = [radius_of(f"radii[{i}]", radius) for i, radius in enumerate(radii)]
    k = len(sizes)
    shape = lattice.resolution(resolution, k, [True] * k)
    angles = np.meshgrid(*(circle(count) for count in shape), indexing="ij")
    points = np.empty((angles[0].size, 2 * k))
    tangents = np.zeros((len(points), k, 2 * k))
    for i, (radius, angle) in enumerate(zip(sizes, angles, strict=True)):
        cosine, sine = np.cos(angle.ravel()), np.sin(angle.ravel())
        points[:, 2 * i], points[:, 2 * i + 1] = radius * cosine, radius * sine
        tangents[:, i, 2 * i], tangents[:, i, 2 * i + 1] = -sine, cosine
    return Manifold(points, tangents, lattice.cells(shape, [True] * k))


def clifford_torus(*, radius: float = 1.0, resolution: int | Sequence[int] = 64) -> Manifold:
    """Return the torus of two equal circles that lies in a 3-sphere.

    Parameters
    ----------
    radius : float, default: 1.0
        Radius of the 3-sphere, in any unit.
    resolution : int or 2 of them, default: 64
        Number of samples on each circle.

    Raises
    ------
    TypeError, ValueError
        As :func:`torus`.
    """
    half = radius_of("radius", radius) / np.sqrt(2)
    return torus(half, half, resolution=resolution)


def torus_curve(
    ratio: float | Fraction,
    /,
    *,
    r1: float = 1.0,
    r2: float = 1.0,
    turns: int | None = None,
    resolution: int = 1024,
) -> Manifold:
    """Return the curve ``f = A t`` on the product torus in 4-space.

    Parameters
    ----------
    ratio : float or Fraction
        Number A of turns of the second circle per turn of the first.
    r1, r2 : float, default: 1.0
        Radii of the circles, above 0, in any unit.
    turns : int, optional
        Number of turns of the first circle. Default: the denominator of A, which closes the curve,
        if it is at most 1000; for any other ratio the number is required.
    resolution : int, default: 1024
        Number of samples on the curve.

    Returns
    -------
    Manifold
        Segments of a curve that is closed where ``turns * A`` is an integer, otherwise open.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The error of points, relative to the larger radius, and of tangents is ``8 eps`` per component
    plus 2 eps times the larger of the angles, ``2 pi turns max(1, A)``.
    Source: Banks, section 3.
    """
    number = _check.number("ratio", ratio)
    r1, r2 = radius_of("r1", r1), radius_of("r2", r2)
    if turns is None:
        exact_ratio = ratio if isinstance(ratio, Fraction) else Fraction(number)
        turns = exact_ratio.limit_denominator(1000).denominator
        product = turns * number
        # In doubles 1/3 times 3 is exactly 1, but 5/49 times 49 need not be exactly 5.
        miss = abs(Fraction(number) * turns - round(product))
        if product != round(product) and miss >= Fraction(1, 2**40):
            expected = "a fraction with a denominator of at most 1000"
            raise ValueError(_check.message("ratio", expected, number, "pass turns="))
    turns = _check.integer("turns", turns, low=1)
    whole = round(turns * number)
    closed = abs(turns * number - whole) < 1e-9
    (count,) = lattice.resolution(resolution, 1, [closed])
    part = np.arange(count) / (count if closed else count - 1)
    t = TURN * turns * part
    f = TURN * whole * part if closed else number * t
    zero = np.zeros_like(t)
    points = np.stack([r1 * np.cos(t), r1 * np.sin(t), r2 * np.cos(f), r2 * np.sin(f)], axis=1)
    along = np.stack([-r1 * np.sin(t), r1 * np.cos(t), zero, zero], axis=1)
    around = np.stack([zero, zero, -r2 * np.sin(f), r2 * np.cos(f)], axis=1)
    rows = (along + number * around)[:, np.newaxis]
    return manifold(points, rows, lattice.cells((count,), [closed]))


def hopf_fibres(
    base: ArrayLike | None = None,
    /,
    *,
    fibres: int = 24,
    radius: float = 1.0,
    resolution: int = 96,
) -> Manifold:
    """Return fibres of the Hopf map: great circles of the 3-sphere that do not intersect.

    Parameters
    ----------
    base : array_like, shape (m, 3), optional
        Points of the 2-sphere, of any length but 0, whose fibres are returned. Default: points
        spread evenly over the sphere.
    fibres : int, default: 24
        Number of fibres, if no base is given.
    radius : float, default: 1.0
        Radius of the 3-sphere, in any unit.
    resolution : int, default: 96
        Number of samples on a fibre, 3 or more.

    Returns
    -------
    Manifold
        Closed curves in 4-space, one after the other.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    For a point (a, b, c) of the unit sphere let ``z1 = sqrt((1 + c)/2)`` and
    ``z2 = sqrt((1 - c)/2) (a - i b)/|a - i b|``. The fibre is ``e^(i t) (z1, z2)``; the Hopf map
    ``(2 Re(z1 z2*), 2 Im(z1 z2*), |z1|^2 - |z2|^2)`` maps it to (a, b, c). The tangent is i times
    the point, of unit length by construction. The error of both, relative to the radius, is 8 eps
    per component.
    """
    radius = radius_of("radius", radius)
    if base is None:
        fibres = _check.integer("fibres", fibres, low=1)
        _check.holds("fibres", (fibres, 4))
        base = _spread(fibres)
    places = _check.vectors("base", base, n=3).astype(np.float64)
    places = places.reshape(-1, 3)
    largest = np.abs(places).max(axis=1, keepdims=True, initial=0.0)
    if not np.all((largest > 0) & np.isfinite(largest)):
        expected = "points of the sphere, finite and not at its centre"
        raise ValueError(_check.message("base", expected, places))
    places = places / largest
    a, b, c = (places / np.linalg.norm(places, axis=1, keepdims=True)).T
    across = np.hypot(a, b)
    # |z1|^2 = (1 + c)/2 without cancellation where c is near -1, and z2 likewise.
    near, far = 1 + np.abs(c), across**2 / (1 + np.abs(c))
    z1 = np.sqrt(np.where(c >= 0, near, far) / 2)
    z2 = np.sqrt(np.where(c >= 0, far, near) / 2) * np.exp(-1j * np.arctan2(b, a))
    (count,) = lattice.resolution(resolution, 1, [True])
    turning = np.exp(1j * circle(count))
    pairs = np.stack([np.outer(z1, turning).ravel(), np.outer(z2, turning).ravel()], axis=1)
    cells = lattice.cells((count,), [True]) + count * np.arange(len(a))[:, np.newaxis, np.newaxis]
    points = radius * pairs.view(np.float64)
    return manifold(points, (1j * pairs).view(np.float64)[:, np.newaxis], cells.reshape(-1, 2))


def circle(count: int) -> Array:
    """Return ``count`` evenly spaced angles around a circle, from 0 and without 2 pi."""
    return TURN * np.arange(count) / count


def radius_of(name: str, value: object) -> float:
    """Return a radius above 0 whose square does not overflow."""
    return _check.positive(name, value, high=LARGEST_RADIUS)


def _spread(count: int) -> Array:
    """Return points on the unit sphere along a spiral of golden angles."""
    i = np.arange(count) + 0.5
    height, angle = 1 - 2 * i / count, np.pi * (1 + np.sqrt(5)) * i
    width = np.sqrt(1 - height**2)
    return np.stack([width * np.cos(angle), width * np.sin(angle), height], axis=1)
