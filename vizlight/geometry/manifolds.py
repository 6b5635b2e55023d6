"""Curves, surfaces and 3-manifolds in 4-space and beyond, with exact tangents.

Every shape is a :class:`~vizlight.geometry.parametric.Manifold`: points, orthonormal tangent
frames, cells. Closed directions share their points, so nothing has a seam.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.geometry import lattice
from vizlight.geometry.parametric import Manifold, check_callable, manifold, parametric
from vizlight.geometry.tori import (
    circle,
    clifford_torus,
    hopf_fibres,
    radius_of,
    torus,
    torus_curve,
)

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

#: Multiplication of a quaternion (x, y, z, w) of the unit sphere by i, j and k: row by row the
#: place and the sign of each component.
_UNITS = (
    ((3, 2, 1, 0), (1, -1, 1, -1)),
    ((2, 3, 0, 1), (1, 1, -1, -1)),
    ((1, 0, 3, 2), (-1, 1, 1, -1)),
)


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
    radius = radius_of("radius", radius)
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
    check_callable("function", function)
    if derivative is not None:
        check_callable("derivative", derivative)
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
        d = slope(x + 1j * y)
        return (1.0, 0.0, d.real, d.imag), (0.0, 1.0, -d.imag, d.real)

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
    radius = radius_of("radius", radius)
    size = _check.integer("resolution", resolution, low=1)
    corners, cells = lattice.cube_skin(4, size)
    place = _round(corners, size)
    frame = np.stack([place[:, order] * sign for order, sign in _UNITS], axis=1)
    return Manifold(radius * place, frame, cells)


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
