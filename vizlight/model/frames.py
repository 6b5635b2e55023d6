"""Tangent spaces in n-space: orthonormalise what spans them, split a direction by them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.model import kernels, layout

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


__all__ = ["orthonormalize", "split"]


def default_rtol(n: int, dtype: np.dtype[Any]) -> float:
    """Return the relative distance from a span below which a vector counts as within it."""
    return float(8 * np.sqrt(n) * np.finfo(dtype).eps)


def orthonormalize(vectors: ArrayLike, /, *, rtol: float | None = None) -> tuple[Any, Any]:
    """Return an orthonormal frame of the space that k vectors span, and its rank.

    The rows keep their order: row 0 is along the first good vector, and so on. A vector is
    dropped when it is zero, not finite, or no further from the span of those before it than
    ``rtol`` times its own length. Rows 0 to rank - 1 of the frame are orthonormal; those from
    rank on are zero, so that projections on the frame are right whatever the rank.

    Parameters
    ----------
    vectors : array_like, shape (..., k, n)
        k vectors a point, k < n or k = n, of any scale (lengths from the smallest to the
        largest number of the type).
    rtol : float, optional
        Relative distance, unitless. Default ``8 sqrt(n) eps``.

    Returns
    -------
    frame : ndarray, shape (..., k, n)
    rank : ndarray of int, shape (...)

    Raises
    ------
    TypeError
        If the vectors are not real numbers.
    ValueError
        If the shape is not (..., k, n) with k <= n, or rtol is negative.

    Notes
    -----
    Gram-Schmidt with every projection made twice. ``|F F^T - 1| <= 6 eps`` for n up to 8, also
    for vectors 1e-8 apart in float64; what they span is then known to eps over the angle
    between them.

    Examples
    --------
    >>> from vizlight.model import frames
    >>> frame, rank = frames.orthonormalize([[3.0, 0.0, 0.0], [1.0, 1e-200, 0.0]])
    >>> int(rank)
    1
    """
    array = layout.as_rows("vectors", vectors, full=True)
    k, n = array.shape[-2:]
    if rtol is None:
        rtol = default_rtol(n, array.dtype)
    rtol = _check.number("rtol", rtol, low=0.0)
    rows = np.ascontiguousarray(array.reshape(-1, k, n).transpose(1, 2, 0))
    frame, rank = kernels.orthonormalize(rows, rtol)
    shape = array.shape[:-2]
    return (
        np.ascontiguousarray(frame.transpose(2, 0, 1)).reshape(*shape, k, n),
        rank.reshape(shape),
    )


def split(direction: ArrayLike, frame: ArrayLike, /) -> tuple[Any, Any]:
    """Split a direction x into its part in the tangent space and the length of the rest.

    Parameters
    ----------
    direction : array_like, shape (..., n)
        Vectors x; they need not be unit.
    frame : array_like, shape (..., k, n)
        Orthonormal rows (or zero rows past the rank), k < n.

    Returns
    -------
    coefficients : ndarray, shape (..., k)
        ``x . t_j`` for every row t_j.
    normal : ndarray, shape (...)
        ``|x_N|``, the length of ``x - sum_j (x . t_j) t_j``: sin(a) of a unit x. Both are NaN
        where x is not finite.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If shapes do not fit or the rows are not orthonormal.

    Notes
    -----
    Absolute error at most ``10 eps |x|`` (k up to 7, n up to 8), what rounded rows miss of being
    orthonormal included, also where x lies along the tangent: the residual is measured, not
    ``sqrt(1 - cos^2)``.
    Source: Banks, section 2 (parts in T and N).
    """
    rows = layout.as_frame(frame)
    x = _check.vectors("direction", direction, n=rows.shape[-1])
    shape, rows, (x,) = layout.batch(rows, x)
    x = np.where(np.isfinite(x).all(axis=0), x, np.nan)
    along, normal = kernels.split(x, rows)
    return np.ascontiguousarray(along.T).reshape(*shape, len(along)), normal.reshape(shape)
