"""Rotation in n-space and projection to 3-space, of positions and of the vectors at them."""

from __future__ import annotations

import math
import numbers
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.model import frames
from vizlight.model.frames import default_rtol, orthonormalize

__all__ = [
    "image_and_depth", "perspective", "plane_rotation", "push_forward", "push_frame",
    "rotation", "turn",
]  # fmt: skip

AXES = "xyzw"
#: Matrices whose rows deviate more than this from orthonormality are rejected. A matrix that was
#: written as text with 7 digits passes.
SLACK = 2e-7
#: Least distance of an eye; one over it is the largest.
NEAREST = 1e-200
#: Below this volume of a frame's image the rank comes from singular values, because the volume has
#: lost half its digits.
DOUBTFUL = 1e-6


def plane_rotation(n: int, plane: str | Sequence[int], angle: float, /) -> Array:
    """Return the rotation of n-space in a coordinate plane.

    Parameters
    ----------
    n : int
        Dimension of the space, 2 or more.
    plane : str or (int, int)
        Two axes, as letters of ``xyzw``, such as ``"xw"``, or indices from 0, such as ``(0, 3)``;
        the first rotates toward the second.
    angle : float
        Angle in radians.

    Returns
    -------
    ndarray, shape (n, n)
        Matrix R of ``x -> R x``.

    Raises
    ------
    TypeError, ValueError
        If the axes are equal or out of range, or the angle is not finite.
    """
    n = _dimension(n)
    i, j = _axes(plane, n)
    angle = _check.number("angle", angle)
    matrix = np.eye(n)
    matrix[i, i] = matrix[j, j] = math.cos(angle)
    # The first axis turns toward the second.
    matrix[j, i] = math.sin(angle)
    matrix[i, j] = -matrix[j, i]
    return matrix


def rotation(n: int, turns: object, /) -> Array:
    """Return a rotation of n-space as a matrix.

    Parameters
    ----------
    n : int
        Dimension of the space, 2 or more.
    turns : array_like, shape (n, n), or ``(plane, angle)``, or a list of these
        Matrix of SO(n), a plane and an angle as for :func:`plane_rotation`, or several of these;
        the first is applied first.

    Returns
    -------
    ndarray, shape (n, n)
        Matrix R of ``x -> R x``.

    Raises
    ------
    TypeError, ValueError
        If ``turns`` is none of these, or the matrix is a reflection or not orthogonal to 2e-7.
    """
    n = _dimension(n)
    # JSON turns the tuple (plane, angle) into a list.
    if (
        isinstance(turns, list | tuple)
        and len(turns) == 2
        and isinstance(turns[1], numbers.Real)
        and (isinstance(turns, tuple) or isinstance(turns[0], str) or _is_row(turns[0]))
    ):
        return plane_rotation(n, *turns)
    if isinstance(turns, list) and turns and not all(_is_row(part) for part in turns):
        matrix = np.eye(n)
        for part in turns:
            # From the left: the first of the list is applied first.
            matrix = rotation(n, part) @ matrix
        return matrix
    return _special_orthogonal(n, turns)


def _is_row(part: object) -> bool:
    """Return whether an element of a list is a row of numbers rather than a rotation."""
    if isinstance(part, np.ndarray):
        return part.ndim == 1 and part.dtype.kind in "iuf"
    return isinstance(part, list | tuple) and all(isinstance(x, numbers.Real) for x in part)


def _special_orthogonal(n: int, value: object) -> Array:
    expected = f"a matrix of shape ({n}, {n}), (plane, angle) or a list of them"
    try:
        matrix = _check.floats("rotation", value).astype(np.float64)
    except TypeError as error:
        raise _check.type_error("rotation", expected, value) from error
    if matrix.shape != (n, n):
        raise _check.value_error("rotation", expected, f"shape {matrix.shape}")
    if not np.all(np.isfinite(matrix)):
        raise _check.value_error("rotation", "finite numbers", "NaN or infinity")
    # Clipped, so that the squares of very large numbers do not overflow.
    small = np.clip(matrix, -2, 2)
    # R R^T is the unit matrix for rotations and reflections; the sign of the determinant tells
    # which.
    miss = float(np.abs(small @ small.T - np.eye(n)).max())
    if miss > SLACK:
        got = f"rows off by {miss:.2g}"
        remedy = "pass the nearest one, scipy.linalg.polar(matrix)[0]"
        raise _check.value_error("rotation", "an orthogonal matrix", got, remedy)
    if np.linalg.det(matrix) < 0:
        remedy = "change the sign of one row"
        raise _check.value_error("rotation", "a rotation", "a reflection", remedy)
    return matrix


def _axes(plane: str | Sequence[int], n: int) -> tuple[int, int]:
    expected = f"two different axes of {n}-space, as 'xy' or (0, 1)"
    if isinstance(plane, str):
        # A letter that is none gives -1, which is no axis.
        axes = tuple(AXES.find(letter) for letter in plane)
    else:
        try:
            axes = tuple(_check.integer("plane", axis, low=0) for axis in plane)
        except TypeError as error:
            raise _check.type_error("plane", expected, plane) from error
    if len(axes) != 2 or axes[0] == axes[1] or not all(0 <= axis < n for axis in axes):
        raise _check.value_error("plane", expected, repr(plane))
    return axes[0], axes[1]


def _dimension(n: object) -> int:
    """Return the dimension of a space; its matrices must fit in memory."""
    size = _check.integer("n", n, low=2)
    _check.holds("n", (size, size))
    return size


def turn(vectors: ArrayLike, matrix: ArrayLike, /) -> Array:
    """Return ``R x`` for vectors or positions x.

    Parameters
    ----------
    vectors : array_like, shape (..., n)
        Vectors or positions x.
    matrix : array_like, shape (n, n)
        Matrix R.

    Returns
    -------
    ndarray, shape (..., n)
        Not finite where a number is not.

    Raises
    ------
    TypeError, ValueError
        If the shapes do not match.

    Notes
    -----
    Absolute error at most ``n eps |x|``.
    """
    rows = _check.vectors("vectors", vectors)
    square = _check.floats("matrix", matrix)
    n = rows.shape[-1]
    if square.shape != (n, n):
        expected = f"shape ({n}, {n}), since vectors have {n} components"
        raise _check.value_error("matrix", expected, f"shape {square.shape}")
    with np.errstate(over="ignore", invalid="ignore"):
        return rows @ square.T


def perspective(points: ArrayLike, /, *, distance: float | None = None) -> Array:
    """Project points to 3-space.

    Parameters
    ----------
    points : array_like, shape (..., n)
        Positions, n of 2 or more; points of the plane get z = 0.
    distance : float, optional
        Distance of the eye from the origin, above 0, in the unit of the points. The eye is on the
        last axis and the image is the hyperplane through the origin perpendicular to it. In more
        than 4 dimensions this is repeated axis by axis, from the last one on. Default: infinity, an
        orthographic projection, which keeps the first three coordinates.

    Returns
    -------
    ndarray, shape (..., 3)
        Image; not finite on the hyperplane of the eye and where a point is not finite, and inverted
        behind the eye (see :func:`image_and_depth`).

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    ``x -> x d / (d - x_n)``. With d the radius of a sphere in 4-space this is the stereographic
    projection from its pole. The relative error is 3 eps for each projected axis, divided by each
    depth ``(d - x)/d`` whose magnitude is less than 1.
    """
    return image_and_depth(points, distance=distance)[0]


def image_and_depth(points: ArrayLike, /, *, distance: float | None = None) -> tuple[Array, Array]:
    """Project points to 3-space and return their relative depth in front of the eye.

    Parameters
    ----------
    points, distance
        As for :func:`perspective`.

    Returns
    -------
    image : ndarray, shape (..., 3)
        Projected points.
    depth : ndarray, shape (...)
        Minimum of ``(d - x)/d`` over the projected axes, at most 1: it is 0 or less on or behind
        the hyperplane of the eye and NaN where a point is not finite.

    Raises
    ------
    TypeError, ValueError
        As :func:`perspective`.

    Notes
    -----
    The image has the error of :func:`perspective`. The error of the depth in 4-space is 2
    eps of the larger of the depth and 1.
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
                # The factor is d / (d - x): its inverse is the depth in units of the eye's
                # distance.
                near = np.minimum(near, 1 / factor)
    return np.array(image[..., :3]), near


def push_forward(
    vectors: ArrayLike, points: ArrayLike, /, *, distance: float | None = None
) -> Array:
    """Return the derivative of :func:`perspective` at points, applied to their vectors.

    Parameters
    ----------
    vectors : array_like, shape (..., k, n)
        k vectors per point.
    points : array_like, shape (..., n)
        Positions of the vectors.
    distance : float, optional
        As for :func:`perspective`.

    Returns
    -------
    ndarray, shape (..., k, 3)
        Images of the vectors; zero for a vector that points at the eye. The images of k independent
        tangents may be dependent (a silhouette). Not finite where points or vectors are not.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    For ``y = x d/(d - x_n)`` it is ``dy = (d/(d - x_n)) (v + y v_n / d)``. It has the error of
    :func:`perspective`, relative to the sum of the lengths of both terms, which cancel for a vector
    that points at the eye.
    """
    rows = _check.vectors("vectors", vectors)
    positions = _check.vectors("points", points, n=rows.shape[-1])
    if rows.ndim < 2 or rows.shape[:-2] != positions.shape[:-1]:
        expected = f"shape (..., k, n) for points of shape {positions.shape}"
        raise _check.value_error("vectors", expected, f"shape {rows.shape}")
    if rows.shape[-1] == 2:
        return np.concatenate([rows, np.zeros_like(rows[..., :1])], axis=-1)
    if distance is None:
        return np.array(rows[..., :3])
    d = check_distance(distance)
    with np.errstate(all="ignore"):
        for factor, image in _steps(positions, d):
            # The quotient rule, one projected axis at a time.
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
) -> tuple[Array, Indices]:
    """Return a frame of the space to which :func:`push_forward` maps tangents.

    Parameters
    ----------
    frame : array_like, shape (..., k, n)
        Tangents at each point; orthonormalised here.
    points : array_like, shape (..., n)
        Positions of the tangents.
    distance : float, optional
        As for :func:`perspective`.
    rtol : float, optional
        Length below which the image of a unit vector counts as zero, relative to a bound on the
        longest image at the point. Default: ``8 sqrt(n) eps``.

    Returns
    -------
    frame : ndarray, shape (..., k, 3)
        Orthonormal rows, the first along the image of the first tangent. Where the projection maps
        a direction of the space to zero (a silhouette) the rows past the rank are zero.
    rank : ndarray of int, shape (...)

    Raises
    ------
    TypeError, ValueError
        As :func:`push_forward`.

    Notes
    -----
    The rank is the number of singular values of the image of an orthonormal frame that exceed
    ``rtol`` times a bound on the rounding. The bound is the product over the projected axes of
    ``f (1 + |y|/d (1 + f |x_n|/d))`` with ``f = d/(d - x_n)``; it is 1 for an orthographic
    projection.
    For orthonormal tangents the space that the rows span is known to 4 eps divided by the smallest
    singular value that is counted.
    """
    rows = orthonormalize(frames.as_rows("frame", frame, full=True))[0]
    k, n = rows.shape[-2:]
    points = _check.floats("points", points)
    if points.shape != (*rows.shape[:-2], n):
        expected = f"shape {(*rows.shape[:-2], n)} for a frame of shape {rows.shape}"
        raise _check.value_error("points", expected, points)
    if k > 3:
        raise _check.value_error("frame", "3 tangents or fewer", k)
    tolerance = default_rtol(n, rows.dtype) if rtol is None else rtol
    tolerance = _check.number("rtol", tolerance, low=0.0, high=_check.LARGEST)
    image = push_forward(rows, points, distance=distance)
    with np.errstate(all="ignore"):
        if distance is not None:
            # What is left of a vector that points at the eye is rounding, magnified by the
            # projection: in units of that bound one tolerance holds for all points.
            image /= _rounding(points, check_distance(distance))[..., np.newaxis, np.newaxis]
        image_frame, rank = orthonormalize(image)
        # The volume that the images span is at most the smallest singular value.
        doubtful = ~(_squared_volume(image) > max(DOUBTFUL, tolerance) ** 2)
    if doubtful.any():
        image_frame[doubtful], rank[doubtful] = _significant(image[doubtful], tolerance)
    return image_frame, rank


def _squared_volume(rows: Array) -> Array:
    """Return the square of the volume that 1 to 3 vectors in 3-space span."""
    # Gram's determinant for one and two vectors; for three the plain one has more digits.
    a, b = rows[..., 0, :], rows[..., -1, :]
    square: Array = np.einsum("...i,...i", a, a)
    if rows.shape[-2] == 3:
        square = np.linalg.det(rows) ** 2
    elif rows.shape[-2] == 2:
        square = square * np.einsum("...i,...i", b, b) - np.einsum("...i,...i", a, b) ** 2
    return square


def _rounding(points: Array, distance: float) -> Array:
    """Return a bound on how :func:`push_forward` magnifies rounding of unit vectors and points."""
    bound = np.ones(points.shape[:-1], dtype=points.dtype)
    last = points
    for factor, image in _steps(points, distance):
        aside = np.linalg.norm(image / distance, axis=-1)
        bound *= np.abs(factor) * (1 + aside * (1 + np.abs(factor * last[..., -1] / distance)))
        last = image
    return bound


def _significant(image: Array, tolerance: float) -> tuple[Array, Indices]:
    """Return frames and ranks of images, where singular values up to a tolerance count as 0."""
    # The decomposition raises an error for numbers that are not finite.
    image = np.where(np.all(np.isfinite(image), axis=(-2, -1), keepdims=True), image, 0)
    # Of a nearly dependent image Gram-Schmidt would make a direction from rounding; singular
    # values tell how many directions there are.
    left, size, right = np.linalg.svd(image, full_matrices=False)
    large = size > tolerance
    full = np.all(large, axis=-1)
    # The sign makes the rows point along the images, not against them.
    sign = np.where(np.take_along_axis(left, np.abs(left).argmax(-2)[:, np.newaxis], -2) < 0, -1, 1)
    basis = np.where(large[..., np.newaxis], right * sign.swapaxes(-2, -1), 0)
    # The rows keep their order where the rank is full.
    basis[full] = orthonormalize(image[full], rtol=0.0)[0]
    return basis, np.count_nonzero(large, axis=-1)


def check_distance(distance: object) -> float:
    """Return the distance of the eye, a number above 0."""
    positive = _check.positive("distance", distance)
    return _check.number("distance", positive, low=NEAREST, high=1 / NEAREST)


def _steps(points: Array, distance: float) -> Iterator[tuple[Array, Array]]:
    """Yield the factor and the image of each step, which projects along the last axis."""
    image = points
    while image.shape[-1] > 3:
        with np.errstate(all="ignore"):
            # The last axis is seen by an eye on it, at the same distance each time.
            factor = 1 / (1 - image[..., -1] / distance)
            image = image[..., :-1] * factor[..., np.newaxis]
        yield factor, image
