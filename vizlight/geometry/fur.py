"""Fibres on a triangulated surface: where they stand, how they bend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.floating[Any]]
    Index = NDArray[np.intp]

#: Seeds drawn at once; each block has random numbers of its own, whatever thread draws it.
SEED_BLOCK = 1 << 15


def seeds(points: ArrayLike, faces: ArrayLike, count: int, /, *, seed: int = 0) -> tuple[Any, Any]:
    """Return places on triangles, uniform in area and jittered.

    The area, laid out triangle after triangle, is cut into ``count`` equal pieces; each piece
    has one place, at random in it. Equal areas thus have equal numbers to within a few, however
    the surface is triangulated.

    Parameters
    ----------
    points : array_like, shape (N, 3)
    faces : array_like of int, shape (T, 3)
    count : int
        0 or more.
    seed : int, default: 0
        The same seed gives the same places.

    Returns
    -------
    face : ndarray of int, shape (count,)
        The triangle of each place, rising.
    weights : ndarray of float32, shape (count, 3)
        Barycentric coordinates in it.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or the surface has no area.

    Notes
    -----
    A place has the share f of its triangle's area before it: with r uniform in [0, 1] the
    weights are ``(1 - sqrt(f), sqrt(f) (1 - r), sqrt(f) r)``.
    Source: Banks, section 5 (jittered interpolated samples).
    """
    vertices = _check.vectors("points", points, n=3)
    triangles = np.asarray(faces)
    if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu":
        raise ValueError(
            _check.message("faces", "integers of shape (T, 3)", _check.describe(triangles))
        )
    count = _check.integer("count", count, low=0)
    total = areas(vertices, triangles)
    if count and not (len(total) and total[-1] > 0):
        raise ValueError(_check.message("faces", "a surface of some area", "none"))
    face, weights = np.empty(count, np.intp), np.empty((count, 3), np.float32)
    for start in range(0, count, SEED_BLOCK):
        block = slice(start, min(start + SEED_BLOCK, count))
        face[block], weights[block] = seed_block(total, block, count, seed)
    return face, weights


def areas(vertices: Array, triangles: Index) -> Array:
    """Return the running sum of the areas of triangles, 0 for those that are not finite."""
    a, b, c = (vertices[triangles[:, i]].astype(np.float64) for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.cumsum(np.where(np.isfinite(area), area, 0))


def seed_block(total: Array, block: slice, count: int, seed: int) -> tuple[Index, Array]:
    """Return the seeds of one block, which starts at a multiple of SEED_BLOCK."""
    random = np.random.default_rng([seed, block.start // SEED_BLOCK])
    place = np.arange(block.start, block.stop, dtype=np.float64)
    place += random.random(len(place))
    place *= total[-1] / count
    # Places rise, so triangles are counted, not looked up place by place.
    first, last = np.minimum(np.searchsorted(total, place[[0, -1]], side="right"), len(total) - 1)
    ends = np.searchsorted(place, total[first:last], side="left")
    counts = np.diff(ends, prepend=0, append=len(place))
    face = np.repeat(np.arange(first, last + 1), counts)
    edges = np.concatenate([[total[first - 1] if first else 0.0], total[first : last + 1]])
    area = np.diff(edges)
    share = (place - np.repeat(edges[:-1], counts)) / np.repeat(np.where(area > 0, area, 1), counts)
    root = np.sqrt(np.clip(share, 0, 1)).astype(np.float32)
    weights = np.empty((len(place), 3), np.float32)
    weights[:, 0] = 1 - root
    weights[:, 2] = random.random(len(place), dtype=np.float32) * root
    weights[:, 1] = root - weights[:, 2]
    return face, weights


def grow(
    roots: Array,
    directions: Array,
    lengths: Array | float,
    /,
    *,
    segments: int,
    toward: Array | None = None,
    bend: float = 0.0,
    curl: float = 0.0,
    turns: float = 1.0,
    phase: Array | None = None,
    out: Array | None = None,
) -> Any:
    """Return the points of fibres that grow from their roots.

    Parameters
    ----------
    roots : ndarray, shape (F, 3)
    directions : ndarray, shape (F, 3)
        Unit directions at the root.
    lengths : ndarray, shape (F,), or float
        Along the fibre, in the unit of the roots.
    segments : int
        S of 1 or more; all of one length.
    toward : ndarray, shape (F, 3), optional
        Unit directions that fibres bend to.
    bend : float, default: 0.0
        How much of ``toward`` is added to the direction at the tip; it grows from 0 at the root.
    curl : float, default: 0.0
        How much of a turning sideways direction is added; 1 leans 45 degrees.
    turns : float, default: 1.0
        Turns of the curl from root to tip.
    phase : ndarray, shape (F,), optional
        Where the curl starts, in radians.
    out : ndarray, shape (F, S + 1, 3), optional
        Written and returned.

    Returns
    -------
    ndarray, shape (F, S + 1, 3)
        From root to tip, of the type of the roots.
    """
    if out is None:
        out = np.empty((len(roots), segments + 1, 3), roots.dtype)
    step = np.asarray(lengths, roots.dtype) / segments
    out[:, 0] = roots
    if curl:
        side, up = _across(directions)
    for j in range(segments):
        t = (j + 0.5) / segments
        way = directions
        if bend and toward is not None:
            way = way + roots.dtype.type(bend * t) * toward
        if curl:
            start: Any = 0.0 if phase is None else phase
            angle = np.broadcast_to(start + 2 * np.pi * turns * t, len(roots))
            angle = angle[:, np.newaxis].astype(roots.dtype)
            way = way + roots.dtype.type(curl) * (np.cos(angle) * side + np.sin(angle) * up)
        if way is not directions:
            size = np.sqrt(np.einsum("ij,ij->i", way, way))[:, np.newaxis]
            way = way / np.where(size > 0, size, 1)
        # One component at a time: NumPy is slow where the innermost axis has three.
        for i in range(3):
            np.multiply(way[:, i], step, out=out[:, j + 1, i])
            out[:, j + 1, i] += out[:, j, i]
    return out


def _across(directions: Array) -> tuple[Array, Array]:
    """Return two unit directions across each direction and each other."""
    least = np.zeros_like(directions)
    np.put_along_axis(least, np.abs(directions).argmin(axis=1)[:, np.newaxis], 1, axis=1)
    side: Array = np.cross(directions, least)
    size = np.sqrt(np.einsum("ij,ij->i", side, side))[:, np.newaxis]
    side /= np.where(size > 0, size, 1)
    return side, np.cross(directions, side)
