"""Conversion of ``(..., n)`` arrays to component-first batches and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array

#: Frames whose rows deviate from orthonormality by more than this many sqrt(eps) are rejected.
SLACK = 16.0


def batch(
    name: str, frame: Array, **directions: Array
) -> tuple[tuple[int, ...], Array, list[Array]]:
    """Return the broadcast shape, and a frame and directions as component-first arrays.

    Messages call the frame by ``name``.
    """
    k, n = frame.shape[-2:]
    kind = np.result_type(frame, *directions.values())
    shapes = {key: d.shape[:-1] for key, d in directions.items()}
    shape = _check.broadcast_shape(**{name: frame.shape[:-2]}, **shapes)
    rows = np.broadcast_to(frame, (*shape, k, n)).reshape(-1, k, n).transpose(1, 2, 0)
    columns = [np.broadcast_to(d, (*shape, n)).reshape(-1, n).T for d in directions.values()]
    return (
        shape,
        np.ascontiguousarray(rows, dtype=kind),
        [np.ascontiguousarray(c, dtype=kind) for c in columns],
    )


def as_rows(name: str, value: ArrayLike, *, full: bool) -> Array:
    """Validate k rows of n components, shape (..., k, n), where k < n, or k <= n if ``full``."""
    array = _check.vectors(name, value)
    k, n = array.shape[-2:] if array.ndim > 1 else (0, array.shape[-1])
    if not 0 < k < n + full:
        expected = f"0 < k {'<=' if full else '<'} n rows of n components, shape (..., k, n)"
        remedy = "for one vector per point pass v[..., None, :]"
        raise ValueError(_check.message(name, expected, f"shape {array.shape}", remedy))
    return array


def as_frame(frame: ArrayLike) -> Array:
    """Validate a tangent frame of shape (..., k, n): k < n, and each row orthonormal or zero."""
    array = as_rows("frame", frame, full=False)
    k = array.shape[-2]
    with np.errstate(over="ignore", invalid="ignore"):
        gram = array @ np.swapaxes(array, -1, -2)
    diagonal = np.diagonal(gram, axis1=-2, axis2=-1)
    off = np.abs(gram - np.eye(k) * np.where(diagonal == 0, 0, 1)[..., np.newaxis])
    worst = float(off.max()) if off.size else 0.0
    if not worst <= SLACK * float(np.sqrt(np.finfo(array.dtype).eps)):
        remedy = "call vizlight.model.frames.orthonormalize first"
        got = f"rows off by {worst:.2g}"
        raise ValueError(_check.message("frame", "orthonormal rows", got, remedy))
    return array


def result(value: Array) -> Array:
    """Return an array unchanged, and a 0-dimensional array as a NumPy scalar."""
    found: Array = value[()]
    return found
