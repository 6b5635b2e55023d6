"""Curves, surfaces and 3-manifolds in 4 dimensions and more, with exact tangents.

Every shape is a :class:`~vizlight.geometry.nspace.parametric.Manifold` of points, orthonormal
tangent frames and cells. Closed directions share their points, so no shape has a seam.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.geometry.nspace import lattice
from vizlight.geometry.nspace.parametric import (
    ROUNDING,
    Manifold,
    manifold,
    parametric,
)
from vizlight.geometry.nspace.tori import (
    circle,
    clifford_torus,
    hopf_fibres,
    radius_of,
    torus,
    torus_curve,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from vizlight._types import Array, Bools, Indices

    Complex = NDArray[np.complexfloating]
    Function = Callable[[Complex], Complex]

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
    corners, cells = lattice.cube_skin(3, size, opposite=True)
    place = _round(corners, size)
    x, y, z = place.T
    zero = np.zeros_like(x)
    # The derivative of the map at the point, and two directions tangent to the sphere.
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
        If an argument is invalid, or the function is not finite on its domain or not analytic
        there: it depends on the conjugate of z by more than rounding, or has a branch cut between
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

    def slope(z: Complex) -> Complex:
        if derivative is not None:
            found = _complex("derivative", derivative, z)
            if not np.all(np.isfinite(found)):
                expected = "one that is finite on its domain"
                raise ValueError(_check.message("derivative", expected, "NaN or infinity"))
            return found
        return _slope(value, z, side)

    def place(x: Array, y: Array) -> tuple[Array, ...]:
        w = value(x + 1j * y)
        return x, y, w.real, w.imag

    def tangents(x: Array, y: Array) -> tuple[tuple[ArrayLike, ...], ...]:
        d = slope(x + 1j * y)
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
    """Return f' by Cauchy's integral over eight points around z, if f is analytic there.

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
        high = size[..., 5] + size[..., 6]
        floor = ROUNDING * (np.median(high) + eps * (np.abs(w) + np.abs(z) * size[..., 1] / h))
        good = (size[..., 7] <= 8 * high + floor) & (high <= size[..., 1:5].sum(-1) / 99 + floor)
    if not np.all(good):
        got = f"one that depends on the conjugate of z or jumps, at {_first(z, ~good)}"
        raise ValueError(_check.message("function", "an analytic one", got, remedy))
    slope: Complex = part[..., 1] / h
    return slope


def _check_sheets(value: Function, shape: Manifold) -> None:
    """Reject a function that has a branch cut between neighbouring samples.

    Where the step from one sample to the next disagrees with the slopes at both, it is bisected
    repeatedly, always on the side with the larger step; what remains is a jump.
    """
    pairs = [shape.cells[:, [i, (i + 1) % 4]] for i in range(4)]
    ends = np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)
    z, w = shape.points.view(np.complex128).T
    with np.errstate(all="ignore"):
        slope = shape.frame[:, 0, 2:].copy().view(np.complex128)[:, 0] / shape.frame[:, 0, 0]
        a, b = z[ends].T
        at_a, at_b = w[ends].T
        step, rises = np.abs(at_b - at_a), (b - a) * slope[ends].T
        rise = np.abs(rises).sum(axis=0) / 2
        odd = ~(np.abs(at_b - at_a - rises.sum(axis=0) / 2) <= 0.1 * (step + rise))
        a, b, at_a, at_b, whole = (x[odd] for x in (a, b, at_a, at_b, step + rise))
        if not len(a):
            return
        for _ in range(HALVINGS):
            middle = (a + b) / 2
            at = value(middle)
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
    corners, cells = lattice.cube_skin(4, size)
    place = _round(corners, size)
    frame = np.stack([place[:, order] * sign for order, sign in _UNITS], axis=1)
    return Manifold(radius * place, frame, cells)


def _round(corners: Indices, size: int) -> Array:
    """Return unit vectors through the lattice points of a cube, spread at equal angles."""
    place = np.tan(np.pi / 4 * (corners / size))
    unit: Array = place / np.linalg.norm(place, axis=1, keepdims=True)
    return unit


def _across(place: Array) -> Array:
    """Return two directions (N, 2, 3) perpendicular to each unit vector, without a pole.

    The first is the cross product with the coordinate axis farthest from the vector, the second the
    cross product with the first.
    """
    axis = np.eye(3)[np.argmin(np.abs(place), axis=1)]
    first = np.cross(place, axis)
    return np.stack([first, np.cross(place, first)], axis=1)
