"""Exact relations between N.H and R.E, the cosines of the half vector and of the reflection.

L, E, R and H are ``wi``, ``wo``, the reflection of wi about the normal N, and the half vector.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array
from vizlight.model import frames, kernels, manifolds

__all__ = ["identity", "reflection", "reflection_cosine", "reflection_from_half"]


def reflection_from_half(n_h: ArrayLike, /, *, triple: ArrayLike = 0.0) -> Array:
    """Return R.E computed exactly from N.H, without an approximate exponent.

    Parameters
    ----------
    n_h : array_like, shape (...)
        Cosines N.H, from -1 to 1.
    triple : array_like, shape (...), default: 0.0
        Triple products ``L x H . N``; they are 0 where the three are coplanar, which leaves (3).

    Returns
    -------
    ndarray, shape (...)

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value is not from -1 to 1, or the shapes do not broadcast.

    Notes
    -----
    ``2 (N.H)^2 - 1 + 2 (L x H . N)^2``. Absolute error at most 4 eps.
    Source: Fisher and Woo (3) and (9).
    """
    half, cross = _check.together(
        n_h=_check.floats_in("n_h", n_h, -1.0, 1.0, "cosines"),
        triple=_check.floats_in("triple", triple, -1.0, 1.0, "triple products of unit vectors"),
    )
    return frames.result(2 * half * half - 1 + 2 * cross * cross)


def reflection_cosine(nu: ArrayLike, /, *, beta: ArrayLike, theta: ArrayLike) -> Array:
    """Return cos(rho) by the general relation ``cos 2 nu + 2 sin^2(beta) cos^2(theta)``.

    Parameters
    ----------
    nu, beta, theta : array_like, shape (...)
        Angles from N to H, from L to H, and from N to the perpendicular of L and E, in radians.

    Returns
    -------
    ndarray, shape (...)

    Raises
    ------
    TypeError
        If an angle is not a real number.
    ValueError
        If an angle is not finite or above 1e9, or the shapes do not broadcast.

    Notes
    -----
    Absolute error at most 8 eps.
    Source: Fisher and Woo (7), which is (8), (9) and (12) in terms of angles.
    """
    nu, beta, theta = _check.together(
        **{
            name: _check.floats_in(name, value, -_check.LARGEST, _check.LARGEST, "angles")
            for name, value in (("nu", nu), ("beta", beta), ("theta", theta))
        }
    )
    return frames.result(np.cos(2 * nu) + 2 * np.square(np.sin(beta) * np.cos(theta)))


def reflection(wi: ArrayLike, wo: ArrayLike, normal: ArrayLike, /) -> Array:
    """Return R.E of directions from N.H and the triple product: Phong's cosine by the half vector.

    Parameters
    ----------
    wi, wo, normal : array_like, shape (..., 3)
        Directions toward light and eye, and the normal; normalised here.

    Returns
    -------
    ndarray, shape (...)
        ``2 (N.H)^2 - 1 + (L x E . N)^2 / (1 + L.E)``. For wi = -wo, where no half vector exists,
        the limit ``2 (N.L)(N.E) - L.E``. NaN where a vector is zero or not finite.

    Raises
    ------
    TypeError, ValueError
        If a vector does not have 3 real components.

    Notes
    -----
    Absolute error at most ``16 eps / |wi + wo|``. Source: Fisher and Woo (8) and (12).
    """
    light, eye, up, shape = _three(wi, wo, normal)
    half, size = kernels.unit(light + eye)
    with np.errstate(invalid="ignore"):
        triple = manifolds.triple(light, half, up)
        value = 2 * np.square(kernels.dot(up, half)) - 1 + 2 * np.square(triple)
        # R.E without the half vector, which has no direction for wi = -wo.
        straight = 2 * kernels.dot(up, light) * kernels.dot(up, eye) - kernels.dot(light, eye)
    return frames.result(np.where(size > 0, value, straight).reshape(shape))


def identity(wi: ArrayLike, wo: ArrayLike, normal: ArrayLike, /) -> Array:
    """Return the left side of an identity of three unit vectors, which is 0 up to rounding.

    Parameters
    ----------
    wi, wo, normal : array_like, shape (..., 3)
        Directions; normalised here.

    Returns
    -------
    ndarray, shape (...)
        ``(L.E)^2 + (E.N)^2 + (N.L)^2 - 2 (L.E)(E.N)(N.L) - 1 + (L x E . N)^2``, at most 16 eps.
        NaN where a vector is zero or not finite.

    Raises
    ------
    TypeError, ValueError
        If a vector does not have 3 real components.

    Notes
    -----
    The determinant of the Gram matrix is the square of the triple product.
    Source: Fisher and Woo (10) and (13).
    """
    light, eye, up, shape = _three(wi, wo, normal)
    le, en, nl = (kernels.dot(a, b) for a, b in ((light, eye), (eye, up), (up, light)))
    value = le * le + en * en + nl * nl - 2 * le * en * nl - 1
    value += np.square(manifolds.triple(light, eye, up))
    return frames.result(value.reshape(shape))


def _three(*vectors: ArrayLike) -> tuple[Array, Array, Array, tuple[int, ...]]:
    """Return three component-first batches of unit vectors and the shape of their batch."""
    names = ("wi", "wo", "normal")
    batches = {name: _check.vectors(name, v, n=3) for name, v in zip(names, vectors, strict=True)}
    arrays = _check.together(**batches)
    units = []
    for v in arrays:
        row, size = kernels.unit(np.ascontiguousarray(v.reshape(-1, 3).T))
        # A vector without a direction makes NaN of all that follows from it.
        units.append(np.where(size > 0, row, np.nan))
    return units[0], units[1], units[2], arrays[0].shape[:-1]
