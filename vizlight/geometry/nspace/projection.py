"""Turning in n-space and projecting to 3-space, positions and the vectors on them together."""

from __future__ import annotations

import math
import numbers
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.model.frames import default_rtol, orthonormalize

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array

__all__ = [
    "image_and_depth",
    "perspective",
    "plane_rotation",
    "push_forward",
    "push_frame",
    "rotation",
    "turn",
]

AXES = "xyzw"
#: Matrices whose rows miss orthonormality by more than this are refused: text keeps 7 digits.
SLACK = 2e-7
#: Images of a frame that span less are looked at closely: their volume loses half the digits.
DOUBTFUL = 1e-6


def plane_rotation(n: int, plane: Any, angle: float, /) -> Array:
    """Return the rotation of n-space in a coordinate plane.

    Parameters
    ----------
    n : int
        Dimension of the space, 2 or more.
    plane : str or (int, int)
        Two axes, the first of which turns toward the second: letters of ``xyzw``, ``"xw"``, or
        numbers from 0, ``(0, 3)``.
    angle : float
        In radians.

    Returns
    -------
    ndarray, shape (n, n)
        The matrix R of ``x -> R x``.

    Raises
    ------
    TypeError, ValueError
        If the axes are equal or out of range, or the angle is not finite.
    """
    n = _check.integer("n", n, low=2)
    i, j = _axes(plane, n)
    angle = _check.number("angle", angle)
    matrix = np.eye(n)
    matrix[i, i] = matrix[j, j] = math.cos(angle)
    matrix[j, i] = math.sin(angle)
    matrix[i, j] = -matrix[j, i]
    return matrix


def rotation(n: int, turns: Any, /) -> Array:
    """Return a rotation of n-space as a matrix.

    Parameters
    ----------
    n : int
    turns : array_like, shape (n, n), or ``(plane, angle)``, or a list of these
        A matrix of SO(n), a turn as for :func:`plane_rotation`, or several, the first done first.

    Returns
    -------
    ndarray, shape (n, n)

    Raises
    ------
    TypeError, ValueError
        If it is none of these, the matrix is not orthogonal to 2e-7, or it is a reflection.
    """
    pair = isinstance(turns, list | tuple) and len(turns) == 2
    # JSON keeps a pair as a list.
    pair = pair and (isinstance(turns, tuple) or isinstance(turns[0], str) or _is_row(turns[0]))
    if pair and isinstance(turns[1], numbers.Real):
        return plane_rotation(n, *turns)
    if isinstance(turns, list) and turns and not all(_is_row(part) for part in turns):
        matrix = np.eye(n)
        for part in turns:
            matrix = rotation(n, part) @ matrix
        return matrix
    return _special_orthogonal(n, turns)


def _is_row(part: Any) -> bool:
    """Tell whether a part of a list is a row of a matrix: numbers, and no turn of its own."""
    return isinstance(part, list | tuple | np.ndarray) and all(
        isinstance(number, numbers.Real) for number in part
    )


def _special_orthogonal(n: int, value: Any) -> Array:
    expected = f"a matrix of shape ({n}, {n}), (plane, angle) or a list of them"
    try:
        matrix = _check.floats("rotation", value).astype(np.float64)
    except TypeError as error:
        raise TypeError(_check.message("rotation", expected, _check.describe(value))) from error
    if matrix.shape != (n, n):
        raise ValueError(_check.message("rotation", expected, f"shape {matrix.shape}"))
    if not np.all(np.isfinite(matrix)):
        raise ValueError(_check.message("rotation", "finite numbers", "NaN or infinity"))
    # Clipped, so that the squares of numbers that are far too large do not overflow.
    small = np.clip(matrix, -2, 2)
    miss = float(np.abs(small @ small.T - np.eye(n)).max())
    if miss > SLACK:
        remedy = "scipy.linalg.polar(matrix)[0] is the nearest"
        raise ValueError(
            _check.message("rotation", "an orthogonal matrix", f"rows off by {miss:.2g}", remedy)
        )
    if np.linalg.det(matrix) < 0:
        remedy = "change the sign of one row"
        raise ValueError(_check.message("rotation", "a rotation", "a reflection", remedy))
    return matrix


def _axes(plane: Any, n: int) -> tuple[int, int]:
    expected = f"two different axes of {n}-space, as 'xy' or (0, 1)"
    if isinstance(plane, str):
        axes = tuple(AXES.find(letter) for letter in plane)
    else:
        try:
            axes = tuple(_check.integer("plane", axis, low=0) for axis in plane)
        except TypeError as error:
            raise TypeError(_check.message("plane", expected, _check.describe(plane))) from error
    if len(axes) != 2 or axes[0] == axes[1] or not all(0 <= axis < n for axis in axes):
        raise ValueError(_check.message("plane", expected, repr(plane)))
    return axes[0], axes[1]


def turn(vectors: ArrayLike, matrix: ArrayLike, /) -> Any:
    """Return ``R x`` of vectors or positions x.

    Parameters
    ----------
    vectors : array_like, shape (..., n)
    matrix : array_like, shape (n, n)

    Returns
    -------
    ndarray, shape (..., n)

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit.

    Notes
    -----
    Absolute error at most ``n eps |x|``.
    """
    rows = _check.vectors("vectors", vectors)
    square = _check.floats("matrix", matrix)
    n = rows.shape[-1]
    if square.shape != (n, n):
        raise ValueError(_check.message("matrix", f"shape ({n}, {n})", f"shape {square.shape}"))
    return rows @ square.T


def perspective(points: ArrayLike, /, *, distance: float | None = None) -> Any:
    """Project points to 3-space.

    Parameters
    ----------
    points : array_like, shape (..., n)
        n of 2 or more; points of the plane get z = 0.
    distance : float, optional
        Of the eye from the origin, in the unit of the points, above 0. The eye is on the last
        axis, the image the hyperplane across it through the origin; in more than 4 dimensions
        one axis after the other is projected away, the last one first. Default: infinity, an
        orthographic projection, which keeps the first three coordinates.

    Returns
    -------
    ndarray, shape (..., 3)
        Not finite on the eye's hyperplane; turned over behind it (see :func:`image_and_depth`).

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    ``x -> x d / (d - x_n)``. With d the radius of a sphere in 4-space this is the stereographic
    projection from its pole. Relative error 3 eps for each axis projected away, over the depths
    ``(d - x)/d`` that are less than 1 by size.
    """
    return image_and_depth(points, distance=distance)[0]


def image_and_depth(points: ArrayLike, /, *, distance: float | None = None) -> tuple[Any, Any]:
    """Project points to 3-space and say how far before the eye they are.

    Parameters
    ----------
    points, distance
        As for :func:`perspective`.

    Returns
    -------
    image : ndarray, shape (..., 3)
    depth : ndarray, shape (...)
        The least of ``(d - x)/d`` over the axes projected away: 0 or less on or behind the
        eye's hyperplane, 1 at most; NaN where a point is not finite.

    Raises
    ------
    TypeError, ValueError
        As :func:`perspective`.

    Notes
    -----
    Error of the image as of :func:`perspective`; of the depth, of 4-space, 2 eps of the larger of
    it and 1.
    """
    positions = _check.vectors("points", points)
    near = np.ones(positions.shape[:-1], dtype=positions.dtype)
    if positions.shape[-1] == 2:
        flat = np.concatenate([positions, np.zeros_like(positions[..., :1])], axis=-1)
        return flat, near
    image = positions[..., :3]
    if distance is not None:
        for factor, seen in _steps(positions, check_distance(distance)):
            image = seen
            with np.errstate(all="ignore"):
                near = np.minimum(near, 1 / factor)
    return np.array(image[..., :3]), near


def push_forward(vectors: ArrayLike, points: ArrayLike, /, *, distance: float | None = None) -> Any:
    """Return the derivative of :func:`perspective` at points, applied to vectors there.

    Parameters
    ----------
    vectors : array_like, shape (..., k, n)
        k vectors a point.
    points : array_like, shape (..., n)
    distance : float, optional
        As for :func:`perspective`.

    Returns
    -------
    ndarray, shape (..., k, 3)
        Zero for a vector that points at the eye; the images of k tangents may be dependent
        although these are not (a silhouette).

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    Of ``y = x d/(d - x_n)``: ``dy = (d/(d - x_n)) (v + y v_n / d)``. Error as of
    :func:`perspective`, of the lengths of both terms together: they cancel for a vector that
    points at the eye.
    """
    rows = _check.vectors("vectors", vectors)
    positions = _check.vectors("points", points, n=rows.shape[-1])
    if rows.ndim < 2 or rows.shape[:-2] != positions.shape[:-1]:
        expected = f"shape (..., k, n) over points of shape {positions.shape}"
        raise ValueError(_check.message("vectors", expected, f"shape {rows.shape}"))
    if rows.shape[-1] == 2:
        return np.concatenate([rows, np.zeros_like(rows[..., :1])], axis=-1)
    if distance is None:
        return np.array(rows[..., :3])
    d = check_distance(distance)
    with np.errstate(all="ignore"):
        for factor, image in _steps(positions, d):
            scale = factor[..., np.newaxis, np.newaxis]
            rows = scale * (rows[..., :-1] + image[..., np.newaxis, :] * (rows[..., -1:] / d))
    return np.array(rows)


def push_frame(
    frame: ArrayLike,
    points: ArrayLike,
    /,
    *,
    distance: float | None = None,
    rtol: float | None = None,
) -> tuple[Any, Any]:
    """Return a frame of the space that tangents are taken to by :func:`push_forward`.

    Parameters
    ----------
    frame : array_like, shape (..., k, n)
        Tangents at each point; orthonormalised here.
    points : array_like, shape (..., n)
    distance : float, optional
        As for :func:`perspective`.
    rtol : float, optional
        The part of a unit vector's image, as a part of the largest that the projection gives
        there, that counts as none. Default: ``8 sqrt(n) eps``.

    Returns
    -------
    frame : ndarray, shape (..., k, 3)
        Orthonormal rows, the first along the image of the first tangent. Where the projection
        takes a direction of the space to nothing (a silhouette) rows past the rank are zero.
    rank : ndarray of int, shape (...)

    Raises
    ------
    TypeError, ValueError
        As :func:`push_forward`.

    Notes
    -----
    The rank is the number of singular values of the image of an orthonormal frame above
    ``rtol`` times a bound on rounding, the product over the axes projected away of
    ``f (1 + |y|/d (1 + f |x_n|/d))`` with ``f = d/(d - x_n)``, 1 if orthographic: what is less is
    rounding. Of orthonormal tangents what the rows span is known to 4 eps over the least
    singular value that counts so.
    """
    rows = orthonormalize(frame)[0]
    k, n = rows.shape[-2:]
    if k > 3:
        raise ValueError(_check.message("frame", "3 tangents or fewer", k))
    tolerance = default_rtol(n, rows.dtype) if rtol is None else rtol
    tolerance = _check.number("rtol", tolerance, low=0.0)
    image = push_forward(rows, points, distance=distance)
    with np.errstate(all="ignore"):
        if distance is not None:
            image /= _rounding(np.asarray(points), float(distance))[..., np.newaxis, np.newaxis]
        found, rank = orthonormalize(image)
        # The volume that the images span is at most the least singular value.
        doubtful = ~(_squared_volume(image) > max(DOUBTFUL, tolerance) ** 2)
    if doubtful.any():
        found[doubtful], rank[doubtful] = _significant(image[doubtful], tolerance)
    return found, rank


def _squared_volume(rows: Any) -> Any:
    """Return the square of the volume that 1 to 3 vectors in 3-space span."""
    if rows.shape[-2] == 3:
        return np.linalg.det(rows) ** 2
    a, b = rows[..., 0, :], rows[..., -1, :]
    square = np.einsum("...i,...i", a, a)
    if rows.shape[-2] == 1:
        return square
    return square * np.einsum("...i,...i", b, b) - np.einsum("...i,...i", a, b) ** 2


def _rounding(points: Any, distance: float) -> Any:
    """Return how much :func:`push_forward` enlarges the rounding of unit vectors and places."""
    bound = np.ones(points.shape[:-1], dtype=points.dtype)
    last = points
    for factor, image in _steps(points, distance):
        aside = np.linalg.norm(image / distance, axis=-1)
        bound *= np.abs(factor) * (1 + aside * (1 + np.abs(factor * last[..., -1] / distance)))
        last = image
    return bound


def _significant(image: Any, tolerance: float) -> tuple[Any, Any]:
    """Return a frame of what images span beyond a tolerance, and their rank."""
    image = np.where(np.all(np.isfinite(image), axis=(-2, -1), keepdims=True), image, 0)
    left, size, right = np.linalg.svd(image, full_matrices=False)
    large = size > tolerance
    full = np.all(large, axis=-1)
    # Along the images rather than against them.
    sign = np.where(np.take_along_axis(left, np.abs(left).argmax(-2)[:, np.newaxis], -2) < 0, -1, 1)
    found = np.where(large[..., np.newaxis], right * sign.swapaxes(-2, -1), 0)
    # The rows' own order is kept where nothing is lost.
    found[full] = orthonormalize(image[full], rtol=0.0)[0]
    return found, np.count_nonzero(large, axis=-1)


def check_distance(distance: Any) -> float:
    """Return a distance of the eye, if it is a number above 0."""
    number = _check.number("distance", distance, low=0.0)
    if number == 0:
        raise ValueError(_check.message("distance", "a number above 0", distance))
    return number


def _steps(points: Any, distance: float) -> Any:
    """Yield the factor and the image of each step that projects the last axis away."""
    image = points
    while image.shape[-1] > 3:
        with np.errstate(all="ignore"):
            factor = 1 / (1 - image[..., -1] / distance)
            image = image[..., :-1] * factor[..., np.newaxis]
        yield factor, image
