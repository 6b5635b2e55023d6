"""Curves, surfaces and 3-manifolds in 4-space and beyond, with exact tangents.

Every shape is a :class:`~vizlight.geometry.parametric.Manifold`: points, orthonormal tangent
frames, cells. Closed directions share their points, so nothing has a seam.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.geometry import lattice
from vizlight.geometry.parametric import Manifold, manifold, parametric

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.floating[Any]]

__all__ = [
    "Manifold",
    "clifford_torus",
    "complex_curve",
    "hopf_fibres",
    "klein_bottle",
    "parametric",
    "sphere3",
    "torus",
    "torus_curve",
    "veronese",
]

TURN = 2 * np.pi
#: Squares of larger ones leave the range of the type.
LARGEST_RADIUS = 1e150
#: Multiplication of a quaternion (x, y, z, w) of the unit sphere by i, j and k: row by row the
#: place and the sign of each component.
_UNITS = (
    ((3, 2, 1, 0), (1, -1, 1, -1)),
    ((2, 3, 0, 1), (1, 1, -1, -1)),
    ((1, 0, 3, 2), (-1, 1, 1, -1)),
)


def torus(*radii: float, resolution: Any = 64) -> Manifold:
    """Return the product of 1 to 3 circles, a k-torus in 2k-space.

    ``torus(r1, r2)`` is the torus of Banks, section 3, a surface in 4-space:
    ``(r1 cos t, r1 sin t, r2 cos f, r2 sin f)``; ``torus(r1, r2, r3)`` the 3-torus in 6-space.

    Parameters
    ----------
    *radii : float
        Above 0, in any unit.
    resolution : int or one for each circle, default: 64
        Samples on a circle, 3 or more.

    Returns
    -------
    Manifold
        k segments, quadrilaterals or hexahedra without a boundary.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    The tangents are unit and orthogonal as they come. Error of points, as a part of the largest
    radius, and of tangents: 8 eps a component, that of the angle included.
    Source: Banks, section 3.
    """
    if not 1 <= len(radii) <= 3:
        raise ValueError(_check.message("radii", "1 to 3 radii", len(radii)))
    sizes = [_radius(f"radii[{i}]", radius) for i, radius in enumerate(radii)]
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


def clifford_torus(*, radius: float = 1.0, resolution: Any = 64) -> Manifold:
    """Return the torus of two equal circles that lies in the 3-sphere of a radius.

    Parameters
    ----------
    radius : float, default: 1.0
        Of the 3-sphere, in any unit.
    resolution : int or 2 of them, default: 64

    Raises
    ------
    TypeError, ValueError
        As :func:`torus`.
    """
    half = _radius("radius", radius) / np.sqrt(2)
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
    """Return the curve ``f = A t`` wound on the product torus in 4-space.

    Parameters
    ----------
    ratio : float or Fraction
        A: turns of the second circle to one of the first.
    r1, r2 : float, default: 1.0
        The radii, above 0, in any unit.
    turns : int, optional
        Of the first circle. Default: as many as close the curve, the denominator of A, if that
        is at most 1000; a ratio that is not such a fraction needs a number.
    resolution : int, default: 1024
        Samples on the curve.

    Returns
    -------
    Manifold
        Segments: closed where ``turns * A`` is whole, else open at both ends.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    Error of points and tangents: ``8 eps`` a component and eps times the larger of the angles,
    ``2 pi turns max(1, A)``, on top.
    Source: Banks, section 3.
    """
    number = _check.number("ratio", float(ratio) if isinstance(ratio, Fraction) else ratio)
    r1, r2 = _radius("r1", r1), _radius("r2", r2)
    if turns is None:
        turns = Fraction(ratio).limit_denominator(1000).denominator
        if turns * number != round(turns * number):
            # The nearest double of 1/3 times 3 is 1, but that of 5/49 times 49 need not be 5.
            exact = abs(Fraction(number) * turns - round(turns * number)) < Fraction(1, 2**40)
            if not exact:
                remedy = "pass turns="
                expected = "a fraction of a denominator up to 1000"
                raise ValueError(_check.message("ratio", expected, number, remedy))
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
    base: Any = None, /, *, fibres: int = 24, radius: float = 1.0, resolution: int = 96
) -> Manifold:
    """Return fibres of the Hopf map: great circles of the 3-sphere, no two of which meet.

    Parameters
    ----------
    base : array_like, shape (m, 3), optional
        Points of the 2-sphere, any length but 0, whose fibres are wanted. Default: points
        spread evenly over it.
    fibres : int, default: 24
        How many, if no base is given.
    radius : float, default: 1.0
        Of the 3-sphere, in any unit.
    resolution : int, default: 96
        Samples on a fibre, 3 or more.

    Returns
    -------
    Manifold
        Closed curves in 4-space, one after the other.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    With a point (a, b, c) of the unit sphere and ``z1 = sqrt((1 + c)/2)``,
    ``z2 = sqrt((1 - c)/2) (a - i b)/|a - i b|`` the fibre is ``e^(i t) (z1, z2)``; the Hopf map
    ``(2 Re(z1 z2*), 2 Im(z1 z2*), |z1|^2 - |z2|^2)`` takes it to (a, b, c). The tangent is i
    times the point, unit as it comes; error of both 8 eps a component.
    """
    radius = _radius("radius", radius)
    if base is None:
        base = _spread(_check.integer("fibres", fibres, low=1))
    places = _check.vectors("base", base, n=3).astype(np.float64)
    size = np.linalg.norm(places.reshape(-1, 3), axis=1, keepdims=True)
    if not np.all((size > 0) & np.isfinite(size)):
        expected = "points of the sphere, finite and not 0"
        raise ValueError(_check.message("base", expected, _check.describe(places)))
    a, b, c = (places.reshape(-1, 3) / size).T
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


def klein_bottle(*, major: float = 2.0, minor: float = 1.0, resolution: Any = (96, 48)) -> Manifold:
    """Return the Klein bottle in 4-space, where it does not meet itself.

    A circle of radius ``minor`` goes around one of radius ``major`` and turns over in the zw
    plane on its way: ``((R + r cos v) cos u, (R + r cos v) sin u, r sin v cos(u/2),
    r sin v sin(u/2))``.

    Parameters
    ----------
    major, minor : float
        R > r > 0, in any unit.
    resolution : int or 2 of them, default: (96, 48)
        Samples around and across.

    Returns
    -------
    Manifold
        Quadrilaterals; where u comes back, v comes back reversed, point for point.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    Error of points and of what the frame spans: 12 eps a component.
    """
    major, minor = _radius("major", major), _radius("minor", minor)
    if minor >= major:
        raise ValueError(_check.message("minor", f"less than major = {major:g}", minor))
    shape = lattice.resolution(resolution, 2, [True, True])
    u, v = (x.ravel() for x in np.meshgrid(*(circle(count) for count in shape), indexing="ij"))
    out = major + minor * np.cos(v)
    up, half = minor * np.sin(v), u / 2
    points = np.stack(
        [out * np.cos(u), out * np.sin(u), up * np.cos(half), up * np.sin(half)], axis=1
    )
    along = np.stack(
        [-out * np.sin(u), out * np.cos(u), -up * np.sin(half) / 2, up * np.cos(half) / 2], axis=1
    )
    inward, lift = -minor * np.sin(v), minor * np.cos(v)
    across = np.stack(
        [inward * np.cos(u), inward * np.sin(u), lift * np.cos(half), lift * np.sin(half)], axis=1
    )
    cells = lattice.cells(shape, [True, True], twisted=True)
    return manifold(points, np.stack([along, across], axis=1), cells)


def veronese(*, radius: float = 1.0, resolution: int = 24) -> Manifold:
    """Return the Veronese surface in 4-space: the projective plane, which does not meet itself.

    The image of the sphere under ``(x y, x z, y z, (x^2 - y^2)/2)``, which takes opposite points
    to one.

    Parameters
    ----------
    radius : float, default: 1.0
        Of the sphere; coordinates are in the square of its unit.
    resolution : int, default: 24
        Cells along an edge of the cube whose half skin, made round, is the sphere.

    Returns
    -------
    Manifold
        Quadrilaterals without a boundary; opposite points are one.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    Error of points and of what the frame spans: 12 eps a component.
    """
    radius = _radius("radius", radius)
    size = _check.integer("resolution", resolution, low=2)
    corners, cells = lattice.cube_skin(3, size, opposite=True)
    place = _round(corners, size)
    x, y, z = place.T
    zero = np.zeros_like(x)
    # The derivative of the map at the place, and two directions across it.
    rows = np.stack(
        [
            np.stack([y, x, zero], axis=1),
            np.stack([z, zero, x], axis=1),
            np.stack([zero, z, y], axis=1),
            np.stack([x, -y, zero], axis=1),
        ],
        axis=1,
    )
    across = _across(place)
    points = radius**2 * np.stack([x * y, x * z, y * z, (x - y) * (x + y) / 2], axis=1)
    return manifold(points, np.einsum("bij,bkj->bki", rows, across), cells)


def complex_curve(
    function: Callable[[Any], Any],
    /,
    *,
    domain: Sequence[Sequence[float]] = ((-1.0, 1.0), (-1.0, 1.0)),
    derivative: Callable[[Any], Any] | None = None,
    resolution: Any = 64,
) -> Manifold:
    """Return the graph ``w = f(z)`` of a complex function, a surface (Re z, Im z, Re w, Im w).

    Parameters
    ----------
    function : callable
        Takes and returns a complex array; analytic on the domain.
    domain : ((low, high), (low, high))
        Of the real and the imaginary part of z.
    derivative : callable, optional
        f'. Default: differences around z.
    resolution : int or 2 of them, default: 64

    Returns
    -------
    Manifold
        Quadrilaterals; a surface with a boundary.

    Raises
    ------
    TypeError
        If the function does not take or return what is asked for.
    ValueError
        If an argument does not fit, the function is not finite on its domain, or not analytic
        (its differences along both axes disagree).

    Notes
    -----
    Tangents ``(1, 0, Re f', Im f')`` and ``(0, 1, -Im f', Re f')``, orthogonal as they come.
    Without a derivative ``(f(z+h) - f(z-h) - i f(z+ih) + i f(z-ih)) / (4 h)``, whose error is
    ``h^4 |f^(5)| / 120 + eps |f| / h``: about 1e-12 of the extent with h = 1e-3 of the domain's
    larger side.
    The inverse of f, a root or a logarithm, has the same surface: turn z and w by ``project``.
    """
    sides = _check.floats("domain", domain)
    if sides.shape != (2, 2):
        raise ValueError(_check.message("domain", "two pairs (low, high)", f"shape {sides.shape}"))
    h = 1e-3 * float(np.ptp(sides, axis=1).max())

    def value(z: Any) -> Any:
        w = np.asarray(function(z))
        if w.dtype.kind not in "iubfc":
            raise TypeError(_check.message("function", "one that returns numbers", w.dtype))
        return w + np.zeros_like(z)

    def slope(z: Any) -> Any:
        if derivative is not None:
            return np.asarray(derivative(z)) + np.zeros_like(z)
        along, up = (value(z + d) - value(z - d) for d in (h, 1j * h))
        size = np.abs(along) + np.abs(up)
        if not np.all(np.abs(along + 1j * up) <= 1e-2 * size.max(initial=0.0)):
            got = "one whose differences along both axes disagree"
            raise ValueError(_check.message("function", "an analytic one", got))
        return (along - 1j * up) / (4 * h)

    def place(x: Array, y: Array) -> Any:
        w = value(x + 1j * y)
        return x, y, w.real, w.imag

    def tangents(x: Array, y: Array) -> Any:
        with np.errstate(all="ignore"):
            d = slope(x + 1j * y)
        return (1.0, 0.0, d.real, d.imag), (0.0, 1.0, -d.imag, d.real)

    with np.errstate(all="ignore"):
        return parametric(place, domain, 4, resolution=resolution, tangents=tangents, closed=False)


def sphere3(*, radius: float = 1.0, resolution: int = 8) -> Manifold:
    """Return the 3-sphere in 4-space as hexahedra.

    Parameters
    ----------
    radius : float, default: 1.0
        In any unit.
    resolution : int, default: 8
        Cells along an edge of each of the 8 cubes that, made round, are the sphere.

    Returns
    -------
    Manifold
        ``8 resolution^3`` hexahedra without a boundary; k = 3.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    The frame is the point, as a quaternion, times i, j and k: orthonormal and the same function
    everywhere, which no 2-sphere has. Error 4 eps a component.
    """
    radius = _radius("radius", radius)
    size = _check.integer("resolution", resolution, low=1)
    corners, cells = lattice.cube_skin(4, size)
    place = _round(corners, size)
    frame = np.stack([place[:, order] * sign for order, sign in _UNITS], axis=1)
    return Manifold(radius * place, frame, cells)


def circle(count: int) -> Array:
    """Return angles evenly around a circle, from 0, without the last."""
    return TURN * np.arange(count) / count


def _radius(name: str, value: Any) -> float:
    number = _check.number(name, value, low=0.0, high=LARGEST_RADIUS)
    if number == 0:
        raise ValueError(_check.message(name, "a number above 0", value))
    return number


def _round(corners: NDArray[np.intp], size: int) -> Array:
    """Return unit vectors through the lattice points of a cube, spread to equal angles."""
    place = np.tan(np.pi / 4 * (corners / size))
    unit: Array = place / np.linalg.norm(place, axis=1, keepdims=True)
    return unit


def _across(place: Array) -> Array:
    """Return two directions (N, 2, 3) across each unit vector, without a pole.

    The axis farthest from the vector is crossed with it, and the result once more.
    """
    axis = np.eye(3)[np.argmin(np.abs(place), axis=1)]
    first = np.cross(place, axis)
    return np.stack([first, np.cross(place, first)], axis=1)


def _spread(count: int) -> Array:
    """Return points spread over the sphere along a spiral of golden angles."""
    i = np.arange(count) + 0.5
    height, angle = 1 - 2 * i / count, np.pi * (1 + np.sqrt(5)) * i
    width = np.sqrt(1 - height**2)
    return np.stack([width * np.cos(angle), width * np.sin(angle), height], axis=1)
