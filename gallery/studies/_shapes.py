"""Curves, surfaces and 3-manifolds in 4 dimensions and more, with exact tangents.

Closed directions share their points, so no shape has a seam.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.geometry.nspace import lattice
from vizlight.geometry.nspace.manifolds import (
    LARGEST_RADIUS,
    ROUNDING,
    Manifold,
    manifold,
    parametric,
    torus,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools, Complex, Indices

    Function = Callable[[Complex], Complex]

#: Bisections of a step between two samples, to find out whether it is a jump. Of a step of a square
#: root at 0, the steepest continuous one, 2^-12 remains.
HALVINGS = 24
#: Multiplication of a unit quaternion (x, y, z, w) by i, j and k: for each of the three the source
#: index and the sign of every component.
_UNITS = (
    ((3, 2, 1, 0), (1, -1, 1, -1)),
    ((2, 3, 0, 1), (1, 1, -1, -1)),
    ((1, 0, 3, 2), (-1, 1, 1, -1)),
)
TURN = 2 * np.pi


def radius_of(name: str, value: object) -> float:
    """Return a radius above 0 with a square that does not overflow."""
    return _check.positive(name, value, high=LARGEST_RADIUS)


def circle(count: int) -> Array:
    """Return ``count`` evenly spaced angles around a circle, from 0 and without 2 pi."""
    return TURN * np.arange(count) / count


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
    # Two circles of the radius r / sqrt(2) are at the distance r from the origin.
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
    # From a whole number of turns the curve ends where it began; a rounded ratio would miss it.
    f = TURN * whole * part if closed else number * t
    zero = np.zeros_like(t)
    points = np.stack([r1 * np.cos(t), r1 * np.sin(t), r2 * np.cos(f), r2 * np.sin(f)], axis=1)
    along = np.stack([-r1 * np.sin(t), r1 * np.cos(t), zero, zero], axis=1)
    around = np.stack([zero, zero, -r2 * np.sin(f), r2 * np.cos(f)], axis=1)
    # Of any length: the frame is normalised below.
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
        Points of the 2-sphere, of any length but 0, one for each fibre. Default: points
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
    # By the largest component first, so that no square overflows.
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
    # The real and imaginary parts of both numbers, one after the other, are the four coordinates.
    points = radius * pairs.view(np.float64)
    return manifold(points, (1j * pairs).view(np.float64)[:, np.newaxis], cells.reshape(-1, 2))


def _spread(count: int) -> Array:
    """Return points on the unit sphere along a spiral of golden angles."""
    i = np.arange(count) + 0.5
    # Each point is turned from the one before by 2 pi times the golden ratio.
    height, angle = 1 - 2 * i / count, np.pi * (1 + np.sqrt(5)) * i
    width = np.sqrt(1 - height**2)
    return np.stack([width * np.cos(angle), width * np.sin(angle), height], axis=1)


def klein_bottle(
    *, major: float = 2.0, minor: float = 1.0, resolution: int | Sequence[int] = (96, 48)
) -> Manifold:
    """Return the Klein bottle in 4-space, where it does not intersect itself.

    A circle of radius ``minor`` moves around a circle of radius ``major`` and is flipped in the zw
    plane on its way: ``((R + r cos v) cos u, (R + r cos v) sin u, r sin v cos(u/2),
    r sin v sin(u/2))``.

    Parameters
    ----------
    major, minor : float
        Radii R > r > 0, in any unit.
    resolution : int or 2 of them, default: (96, 48)
        Number of samples along u and along v.

    Returns
    -------
    Manifold
        Quadrilaterals; where u returns to its start, v is reversed, point for point.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The error of points, relative to ``major``, is 12 eps per component. The error of the space that
    the frame spans is ``12 eps R/(R - r)``: near R = r the rounding of the angles rotates the frame
    where the tube passes the axis.
    """
    major, minor = radius_of("major", major), radius_of("minor", minor)
    if minor >= major:
        raise ValueError(_check.message("minor", f"less than major = {major:g}", minor))
    shape = lattice.resolution(resolution, 2, [True, True])
    u, v = (x.ravel() for x in np.meshgrid(*(circle(count) for count in shape), indexing="ij"))
    # Unit circles in the xy and in the zw plane.
    x, y, z, w = np.cos(u), np.sin(u), np.cos(u / 2), np.sin(u / 2)
    out, up = major + minor * np.cos(v), minor * np.sin(v)
    inward, lift = -minor * np.sin(v), minor * np.cos(v)
    points = np.stack([out * x, out * y, up * z, up * w], axis=1)
    # The zw plane turns half as fast, which is the half in the derivative by u.
    along = np.stack([-out * y, out * x, -up * w / 2, up * z / 2], axis=1)
    across = np.stack([inward * x, inward * y, lift * z, lift * w], axis=1)
    # Where u returns to its start, index -j stands for j: reversed, and turned by one, so that 0
    # stays where it is.
    rows, columns = shape
    index = np.arange(rows * columns)
    index = np.append(index, np.roll(index[columns - 1 :: -1], 1))
    cells = index[lattice.cells((rows + 1, columns), [False, True])]
    return manifold(points, np.stack([along, across], axis=1), cells)


def veronese(*, radius: float = 1.0, resolution: int = 24) -> Manifold:
    """Return the Veronese surface in 4-space: the projective plane without self-intersection.

    It is the image of the sphere under ``(x y, x z, y z, (x^2 - y^2)/2)``, which maps opposite
    points to the same point.

    Parameters
    ----------
    radius : float, default: 1.0
        Radius of the sphere; the coordinates are in the square of its unit.
    resolution : int, default: 24
        Number of cells along an edge of the cube, half of whose surface is projected to the sphere.

    Returns
    -------
    Manifold
        Quadrilaterals without a boundary; opposite points are identified.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The error of points and of the space that the frame spans is 12 eps per component.
    """
    radius = radius_of("radius", radius)
    size = _check.integer("resolution", resolution, low=2)
    _check.holds("resolution", (size, size))
    corners, cells = cube_skin(3, size, opposite=True)
    place = _round(corners, size)
    x, y, z = place.T
    zero = np.zeros_like(x)
    # The derivative of the map at the point.
    derivative = np.array([[y, x, zero], [z, zero, x], [zero, z, y], [x, -y, zero]])
    # Two directions tangent to the sphere, without a pole: the cross product with the coordinate
    # axis farthest from the point, and the cross product with that.
    first = np.cross(place, np.eye(3)[np.argmin(np.abs(place), axis=1)])
    across = np.stack([first, np.cross(place, first)], axis=1)
    # The product keeps the digits that x^2 - y^2 loses where both are nearly equal.
    points = radius**2 * np.stack([x * y, x * z, y * z, (x - y) * (x + y) / 2], axis=1)
    return manifold(points, np.einsum("ijb,bkj->bki", derivative, across), cells)


def sphere3(*, radius: float = 1.0, resolution: int = 8) -> Manifold:
    """Return the 3-sphere in 4-space as hexahedra.

    Parameters
    ----------
    radius : float, default: 1.0
        Radius of the sphere, in any unit.
    resolution : int, default: 8
        Number of cells along an edge of each of the 8 cubes that are projected to the sphere.

    Returns
    -------
    Manifold
        ``8 resolution^3`` hexahedra without a boundary; k = 3.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The frame is the point, as a quaternion, times i, j and k: orthonormal and given by one formula
    everywhere, which is impossible on a 2-sphere. The error is 4 eps per component.
    """
    radius = radius_of("radius", radius)
    size = _check.integer("resolution", resolution, low=1)
    _check.holds("resolution", (size, size, size))
    corners, cells = cube_skin(4, size)
    place = _round(corners, size)
    frame = np.stack([place[:, order] * sign for order, sign in _UNITS], axis=1)
    return Manifold(radius * place, frame, cells)


def _round(corners: Indices, size: int) -> Array:
    """Return unit vectors through the lattice points of a cube, spread at equal angles."""
    # Cells of equal size on the cube would be several times larger on the sphere in the middle of a
    # face than at its corners.
    place = np.tan(np.pi / 4 * (corners / size))
    unit: Array = place / np.linalg.norm(place, axis=1, keepdims=True)
    return unit


def cube_skin(dimension: int, size: int, *, opposite: bool = False) -> tuple[Indices, Indices]:
    """Return the lattice points on the surface of a cube, each once, and the cells between them.

    Parameters
    ----------
    dimension : int
        Dimension of the cube, 3 or 4; its surface has one less.
    size : int
        Number of cells along an edge.
    opposite : bool, default: False
        Whether opposite points are identified, which makes the surface a projective space.

    Returns
    -------
    points : ndarray of int, shape (N, dimension)
        Coordinates from ``-size`` to ``size`` in steps of 2.
    cells : ndarray of int, shape (M, 2^(dimension - 1))
    """
    # Twice the coordinates, which are whole numbers about 0 for odd numbers of cells, too.
    steps = 2 * np.arange(size + 1) - size
    within = np.stack(np.meshgrid(*[steps] * (dimension - 1), indexing="ij"), axis=-1)
    within = within.reshape(-1, dimension - 1)
    local = lattice.cells([size + 1] * (dimension - 1), [False] * (dimension - 1))
    places: list[Indices] = []
    faces: list[Indices] = []
    # Of opposite faces one is enough where opposite points are one.
    for axis, side in itertools.product(range(dimension), (1,) if opposite else (1, -1)):
        faces.append(local + len(places) * len(within))
        places.append(np.insert(within, axis, side * size, axis=1))
    corner = np.concatenate(places)
    if opposite:
        # The sign of the first non-zero coordinate decides which of both points is kept.
        first = np.argmax(corner != 0, axis=1)
        corner = corner * np.sign(corner[np.arange(len(corner)), first])[:, np.newaxis]
    # Faces share the points of their edges, which are found by equal coordinates.
    points, number = np.unique(corner, axis=0, return_inverse=True)
    return points, np.asarray(number, dtype=np.intp).reshape(-1)[np.concatenate(faces)]


def complex_curve(
    function: Callable[[Complex], ArrayLike],
    /,
    *,
    domain: Sequence[Sequence[float]] = ((-1.0, 1.0), (-1.0, 1.0)),
    derivative: Callable[[Complex], ArrayLike] | None = None,
    resolution: int | Sequence[int] = 64,
) -> Manifold:
    """Return the graph ``w = f(z)`` of a complex function, a surface (Re z, Im z, Re w, Im w).

    Parameters
    ----------
    function : callable
        Function that takes and returns a complex array. It must be analytic and single-valued on
        the domain and up to a thousandth of its larger side around it.
    domain : ((low, high), (low, high))
        Ranges of the real and the imaginary part of z.
    derivative : callable, optional
        Derivative f', used without a check. Default: Cauchy's integral around z.
    resolution : int or 2 of them, default: 64
        Number of samples in each direction.

    Returns
    -------
    Manifold
        Quadrilaterals; a surface with a boundary.

    Raises
    ------
    TypeError
        If the function does not take or return such arrays.
    ValueError
        If an argument is invalid, or the function is not finite or not analytic on its domain: it
        depends on the conjugate of z by more than rounding, or has a branch cut between
        neighbouring samples (a root or a logarithm around 0).

    Notes
    -----
    The tangents ``(1, 0, Re f', Im f')`` and ``(0, 1, -Im f', Re f')`` are orthogonal by
    construction. Without a derivative f' is the mean of ``f(z + d)/d`` over eight d on a circle of
    radius h, with an error of ``h^8 |f^(9)|/9! + eps ((|f| + |z f'|)/h + 4 |f'|)``. With h =
    eps^(1/5) of the domain's larger side, 7.4e-4, that is 1e-12 of the largest ``|f|`` and ``|f'|``
    unless a pole is nearer than 40 h. The mean of ``f(z + d)/d*`` is the derivative by the
    conjugate, which is 0 if f is analytic. The inverse of f, a root or a logarithm, has the same
    surface with z and w exchanged, which a rotation in ``project`` does.
    """
    _check.function("function", function)
    _check.function("derivative", derivative, optional=True)
    sides = _check.floats("domain", domain)
    if sides.shape != (2, 2):
        raise ValueError(_check.message("domain", "two pairs (low, high)", f"shape {sides.shape}"))
    side = float(np.ptp(sides, axis=1).max())

    def value(z: Complex) -> Complex:
        return _complex("function", function, z)

    def place(x: Array, y: Array) -> tuple[Array, ...]:
        w = value(x + 1j * y)
        return x, y, w.real, w.imag

    def tangents(x: Array, y: Array) -> tuple[tuple[ArrayLike, ...], ...]:
        z = x + 1j * y
        d = _slope(value, z, side) if derivative is None else _complex("derivative", derivative, z)
        if derivative is not None and not np.all(np.isfinite(d)):
            expected = "one that is finite on its domain"
            raise ValueError(_check.message("derivative", expected, "NaN or infinity"))
        return (1.0, 0.0, d.real, d.imag), (0.0, 1.0, -d.imag, d.real)

    shape = parametric(place, domain, 4, resolution=resolution, tangents=tangents, closed=False)
    _check_sheets(value, shape)
    return shape


def _complex(name: str, function: Callable[[Complex], ArrayLike], z: Complex) -> Complex:
    """Return the values of a user's function at z, real or complex, in the shape of z."""
    with np.errstate(all="ignore"):
        returned = function(z)
    expected = "one that returns numbers in the shape of its argument"
    try:
        w = np.broadcast_to(np.asarray(returned), z.shape)
    except ValueError as error:
        raise ValueError(_check.message(name, expected, _check.describe(returned))) from error
    if w.dtype.kind not in "iubfc":
        raise TypeError(_check.message(name, expected, _check.describe(returned)))
    return w


def _slope(value: Function, z: Complex, side: float) -> Complex:
    """Return f' by Cauchy's integral over eight points around z, at which f must be analytic.

    Coefficient m of the discrete Fourier transform of f on the circle is the term
    ``f^(m) d^m / m!`` of the Taylor series. Coefficient 7 is also coefficient -1, the term of the
    conjugate of d.
    """
    w = value(z)
    eps = float(np.finfo(w.dtype if w.dtype.kind in "fc" else np.float64).eps)
    h = eps**0.2 * side
    turns = np.exp(2j * np.pi / 8 * np.arange(8))
    around = np.stack([value(z + h * turn) for turn in turns], axis=-1)
    remedy = "choose a domain away from poles and branch cuts, or pass derivative="
    if not np.all(np.isfinite(around)):
        expected = f"finite values on its domain and up to {h:.2g} outside it"
        raise ValueError(_check.message("function", expected, "NaN or infinity", remedy))
    with np.errstate(all="ignore"):
        part = np.fft.fft(around, axis=-1) / 8
        size = np.abs(part)
        # Terms 5 and 6 are hardly there where f is analytic, and show what noise the others have.
        high = size[..., 5] + size[..., 6]
        floor = ROUNDING * (np.median(high) + eps * (np.abs(w) + np.abs(z) * size[..., 1] / h))
        # Little more of the conjugate than of those, and those small beside the first ones.
        good = (size[..., 7] <= 8 * high + floor) & (high <= size[..., 1:5].sum(-1) / 99 + floor)
    if not np.all(good):
        got = f"one that depends on the conjugate of z or jumps, at {_first(z, ~good)}"
        raise ValueError(_check.message("function", "an analytic one", got, remedy))
    slope: Complex = part[..., 1] / h
    return slope


def _check_sheets(value: Function, shape: Manifold) -> None:
    """Reject a function that has a branch cut between neighbouring samples.

    Where the step from one sample to the next disagrees with the slopes at both, it is bisected
    repeatedly, always on the side with the larger step; a step that remains is a jump.
    """
    pairs = [shape.cells[:, [i, (i + 1) % 4]] for i in range(4)]
    ends = np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)
    z, w = shape.points.view(np.complex128).T
    with np.errstate(all="ignore"):
        # The first row is (1, 0, Re f', Im f') but for its length, which its first component tells.
        slope = shape.frame[:, 0, 2:].copy().view(np.complex128)[:, 0] / shape.frame[:, 0, 0]
        a, b = z[ends].T
        at_a, at_b = w[ends].T
        # By the trapezoidal rule the step is the mean of both slopes times the way.
        step, rises = np.abs(at_b - at_a), (b - a) * slope[ends].T
        rise = np.abs(rises).sum(axis=0) / 2
        # Negated, since NaN, for which no comparison holds, is odd as well.
        odd = ~(np.abs(at_b - at_a - rises.sum(axis=0) / 2) <= 0.1 * (step + rise))
        a, b, at_a, at_b, whole = (x[odd] for x in (a, b, at_a, at_b, step + rise))
        if not len(a):
            return
        for _ in range(HALVINGS):
            middle = (a + b) / 2
            at = value(middle)
            # The half with the larger step holds the jump, if there is one.
            first = np.abs(at - at_a) >= np.abs(at_b - at)
            a, b = np.where(first, a, middle), np.where(first, middle, b)
            at_a, at_b = np.where(first, at_a, at), np.where(first, at, at_b)
        eps = float(np.finfo(at_b.dtype).eps)
        jump = ~(np.abs(at_b - at_a) <= 0.1 * whole + ROUNDING * eps * np.abs(at_a))
    if jump.any():
        got = f"one that jumps at {_first(a, jump)}"
        remedy = "choose a domain without its branch cut"
        raise ValueError(_check.message("function", "an analytic one", got, remedy))


def _first(z: Complex, where: Bools) -> str:
    """Return the first selected number as text."""
    return f"z = {complex(z[where][0]):.3g}"
