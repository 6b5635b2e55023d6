"""Inputs on which careless code loses its digits: directed at each singularity, and at random."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]
    Random = np.random.Generator

#: Names of the ways in which a direction stands to a tangent space.
DIRECTIONS = ("random", "along the tangent", "one ulp off it", "near it", "across", "near across")
#: Names of the ways in which an eye stands to a light.
EYES = ("random", "at the mirror", "near it", "one ulp off it", "at the light", "opposite")


def units(random: Random, count: int, n: int) -> Array:
    """Return unit vectors in all directions."""
    v = random.standard_normal((count, n))
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def steps(random: Random, count: int, low: float = -17.0, high: float = -0.5) -> Array:
    """Return small numbers of any size, shape (count, 1)."""
    return np.asarray(10 ** random.uniform(low, high, (count, 1)))


def frames(random: Random, count: int, k: int, n: int, dtype: Any) -> Array:
    """Return orthonormal frames, shape (count, k, n), rounded to the type."""
    q, _ = np.linalg.qr(random.standard_normal((count, n, k)))
    return np.asarray(np.swapaxes(q, 1, 2).astype(dtype))


def nudged(random: Random, v: Array) -> Array:
    """Return vectors with one component each moved by one unit in the last place."""
    out = v.copy()
    at = np.arange(len(v)), random.integers(v.shape[1], size=len(v))
    out[at] = np.nextafter(v[at], v.dtype.type(random.choice([-np.inf, np.inf])))
    return out


def directions(random: Random, frame: Array, kind: str) -> Array:
    """Return a direction for each frame, in the frame's precision, of some length."""
    count, k, n = frame.shape
    rows = frame.astype(np.float64)
    along = np.einsum("bk,bkn->bn", units(random, count, k) if k > 1 else np.ones((count, 1)), rows)
    other = units(random, count, n)
    across = other - np.einsum("bkn,bk->bn", rows, np.einsum("bkn,bn->bk", rows, other))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    made = {
        "random": other,
        "along the tangent": along,
        "one ulp off it": along,
        "near it": along + steps(random, count) * across,
        "across": across,
        "near across": across + steps(random, count) * along,
    }[kind].astype(frame.dtype)
    if kind == "one ulp off it":
        made = nudged(random, made)
    # Lengths are powers of two: the direction is the same, the scale is not.
    limit = 30 if frame.dtype == np.float32 else 300
    return np.asarray(np.ldexp(made, random.integers(-limit, limit, (count, 1))))


def eyes(random: Random, wi: Array, frame: Array, kind: str) -> Array:
    """Return a direction toward the eye for each light and frame."""
    light, rows = wi.astype(np.float64), frame.astype(np.float64)
    light /= np.abs(light).max(axis=1, keepdims=True)
    light /= np.linalg.norm(light, axis=1, keepdims=True)
    count, n = light.shape

    def across(v: Array) -> Array:
        return np.asarray(v - np.einsum("bkn,bk->bn", rows, np.einsum("bkn,bn->bk", rows, v)))

    normal = across(across(units(random, count, n)))
    size = np.linalg.norm(across(light), axis=1, keepdims=True)
    mirror = normal * size / np.linalg.norm(normal, axis=1, keepdims=True) - (light - across(light))
    made = {
        "random": units(random, count, n),
        "at the mirror": mirror,
        "near it": mirror + steps(random, count) * units(random, count, n),
        "one ulp off it": mirror,
        "at the light": light,
        "opposite": steps(random, count, -9) * units(random, count, n) - light,
    }[kind].astype(wi.dtype)
    return nudged(random, made) if kind == "one ulp off it" else np.asarray(made)
