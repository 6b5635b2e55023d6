"""Fibres on a triangulated surface: where they stand, how they bend."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices

__all__ = ["grow", "seeds"]

#: Seeds drawn at once; each block has random numbers of its own, whatever thread draws it.
SEED_BLOCK = 1 << 16
#: The turn of a Fibonacci lattice, 2 - the golden ratio: multiples of it fill [0, 1) evenly.
TURN = (3 - 5**0.5) / 2


def seeds(points: ArrayLike, faces: ArrayLike, count: int, /, *, seed: int = 0) -> tuple[Any, Any]:
    """Return places on triangles, uniform in area and jittered.

    The area, laid out triangle after triangle, is cut into ``count`` equal pieces; each piece
    has one place, at random in it. A triangle thus has its share of them to within one or two,
    and within it they follow a jittered Fibonacci lattice: they keep apart also where triangles
    are large.

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
    A place has the share f of its triangle's area before it: the weights are
    ``(1 - sqrt(f), sqrt(f) (1 - r), sqrt(f) r)``, which keeps areas, and r turns by the golden
    ratio from place to place, from a random start in each triangle, jittered by ``1 / sqrt(m)``
    where a triangle has m places.
    Source: Banks, section 5 (jittered interpolated samples).
    """
    vertices = _check.vectors("points", points, n=3)
    triangles = np.asarray(faces)
    if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu":
        raise ValueError(
            _check.message("faces", "integers of shape (T, 3)", _check.describe(triangles))
        )
    if triangles.size and not 0 <= triangles.min() <= triangles.max() < len(vertices):
        raise ValueError(
            _check.message(
                "faces",
                f"numbers of points from 0 to {len(vertices) - 1}",
                f"{triangles.min()} to {triangles.max()}",
            )
        )
    count = _check.integer("count", count, low=0)
    seed = _check.integer("seed", seed, low=0)
    total = areas(vertices, triangles)
    if count and not (len(total) and total[-1] > 0):
        raise ValueError(_check.message("faces", "a surface of some area", "none"))
    face, weights = np.empty(count, np.intp), np.empty((count, 3), np.float32)
    for start in range(0, count, SEED_BLOCK):
        block = slice(start, start + SEED_BLOCK)
        face[block], weights[block] = seed_block(total, start, count, seed)
    return face, weights


def areas(vertices: Array, triangles: Indices) -> Array:
    """Return the running sum of the areas of triangles, 0 for those that are not finite."""
    a, b, c = (vertices[triangles[:, i]].astype(np.float64) for i in range(3))
    with np.errstate(all="ignore"):
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.cumsum(np.where(np.isfinite(area), area, 0))


def seed_block(total: Array, start: int, count: int, seed: int) -> tuple[Indices, Array]:
    """Return the seeds of the block that starts at a multiple of SEED_BLOCK."""
    random = np.random.default_rng([seed, start // SEED_BLOCK])
    number = np.arange(start, min(start + SEED_BLOCK, count), dtype=np.float64)
    place = number.copy()
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
    # A lattice of its own for each triangle, turned at random, so that no pattern runs over many.
    number *= TURN
    number += np.repeat(random.random(len(area)), counts)
    # The part of a triangle that is in another block has as many places for its area.
    spread = np.minimum(total[-1] / (count * np.where(area > 0, area, 1)), 1)
    number += np.repeat(np.sqrt(spread), counts) * random.random(len(place), dtype=np.float32)
    weights = np.empty((len(place), 3), np.float32)
    weights[:, 0] = 1 - root
    weights[:, 2] = (number - np.floor(number)) * root
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

    Returns
    -------
    ndarray, shape (F, S + 1, 3)
        From root to tip, of the type of the roots.
    """
    way = np.ascontiguousarray(directions.T, dtype=roots.dtype)
    target = None if toward is None else np.ascontiguousarray(toward.T, dtype=roots.dtype)
    grown = strands(
        way, lengths, segments=segments, toward=target, bend=bend, curl=curl, turns=turns,
        phase=phase,
    )  # fmt: skip
    return np.ascontiguousarray(grown.transpose(2, 0, 1)) + roots[:, np.newaxis]


def strands(
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
) -> Array:
    """Return the points of :func:`grow` less their roots, (S + 1, 3, F), component by component."""
    kind = directions.dtype
    out = np.zeros((segments + 1, *directions.shape), kind)
    step = np.asarray(lengths, kind) / segments
    if not (bend and toward is not None) and not curl:
        for j in range(1, segments + 1):
            np.multiply(directions, j * step, out=out[j])
        return out
    if curl:
        side, up = _across(directions)
    for j in range(segments):
        t = (j + 0.5) / segments
        way = directions
        if bend and toward is not None:
            way = way + kind.type(bend * t) * toward
        if curl:
            start: Any = 0.0 if phase is None else phase
            angle = np.asarray(start + 2 * np.pi * turns * t, kind)
            way = way + kind.type(curl) * (np.cos(angle) * side + np.sin(angle) * up)
        size = np.sqrt(np.einsum("ib,ib->b", way, way))
        np.multiply(way, step / np.where(size > 0, size, 1), out=out[j + 1])
        out[j + 1] += out[j]
    return out


def _across(directions: Array) -> tuple[Array, Array]:
    """Return two unit directions across each direction and each other."""
    least = np.zeros_like(directions)
    np.put_along_axis(least, np.abs(directions).argmin(axis=0)[np.newaxis], 1, axis=0)
    side: Array = np.cross(directions, least, axis=0)
    size = np.sqrt(np.einsum("ib,ib->b", side, side))
    side /= np.where(size > 0, size, 1)
    return side, np.cross(directions, side, axis=0)
