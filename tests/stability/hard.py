"""Inputs on which careless code loses its digits: directed at each singularity, and at random."""

import numpy as np
from vectors import unit

#: Names of the ways in which a direction stands to a tangent space.
DIRECTIONS = ("random", "along the tangent", "one ulp off it", "near it", "across", "near across")
#: Names of the ways in which an eye stands to a light.
EYES = ("random", "at the mirror", "near it", "one ulp off it", "at the light", "opposite")
#: And how to a power: with any, and with hardly a half vector.
STEEP = ("where it falls", "where it ends", "opposite, where it falls", "opposite, where it ends")


def units(random, count, n):
    """Return unit vectors in all directions."""
    v = random.standard_normal((count, n))
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def steps(random, count, low=-17.0, high=-0.5):
    """Return small numbers of any size, shape (count, 1)."""
    return np.asarray(10 ** random.uniform(low, high, (count, 1)))


def frames(random, count, k, n, dtype):
    """Return frames, shape (count, k, n), orthonormal as far as work in the type goes."""
    q, _ = np.linalg.qr(random.standard_normal((count, n, k)).astype(dtype))
    return np.asarray(np.swapaxes(q, 1, 2))


def nudged(random, v):
    """Return vectors with one component each moved by one unit in the last place."""
    out = v.copy()
    at = np.arange(len(v)), random.integers(v.shape[1], size=len(v))
    out[at] = np.nextafter(v[at], v.dtype.type(random.choice([-np.inf, np.inf])))
    return out


def directions(random, frame, kind, power=1.0):
    """Return a direction for each frame, in the frame's precision, of some length.

    "where it is steepest" is where sin^power changes most: as far from across as that is wide.
    """
    count, k, n = frame.shape
    rows = frame.astype(np.float64)
    along = np.einsum("bk,bkn->bn", units(random, count, k) if k > 1 else np.ones((count, 1)), rows)
    other = units(random, count, n)
    across = unit(other - np.einsum("bkn,bk->bn", rows, np.einsum("bkn,bn->bk", rows, other)))
    made = {
        "random": other,
        "along the tangent": along,
        "one ulp off it": along,
        "near it": along + steps(random, count) * across,
        "across": across,
        "near across": across + steps(random, count) * along,
        "where it is steepest": across + _width(random, count, power) * along,
    }[kind].astype(frame.dtype)
    if kind == "one ulp off it":
        made = nudged(random, made)
    # Lengths are powers of two: the direction is the same, the scale is not.
    limit = 30 if frame.dtype == np.float32 else 300
    return np.asarray(np.ldexp(made, random.integers(-limit, limit, (count, 1))))


def _width(random, count, power):
    """Return lengths about that over which cos^power falls, shape (count, 1)."""
    return np.asarray(np.sqrt(random.uniform(0.1, 4, (count, 1)) / max(power, 4.0)))


def eyes(random, wi, frame, kind, power=1.0):
    """Return a direction toward the eye for each light and frame."""
    light, rows = wi.astype(np.float64), frame.astype(np.float64)
    light /= np.abs(light).max(axis=1, keepdims=True)
    light /= np.linalg.norm(light, axis=1, keepdims=True)
    count, n = light.shape

    def across(v):
        return np.asarray(v - np.einsum("bkn,bk->bn", rows, np.einsum("bkn,bn->bk", rows, v)))

    normal = unit(across(across(units(random, count, n))))
    size = np.linalg.norm(across(light), axis=1, keepdims=True)
    mirror = normal * size - (light - across(light))
    fall = normal + _width(random, count, power) * units(random, count, n)
    along = np.einsum("bk,bkn->bn", units(random, count, rows.shape[1]), rows)
    flat = along + steps(random, count) * units(random, count, n)
    # As far below the line as the light's mirror image is above it: V.R = 0.
    low = light - across(light)
    lies = np.linalg.norm(low, axis=1, keepdims=True)
    low = normal * lies + low * size / np.where(lies > 0, lies, 1)

    def about(half):
        half = half / np.linalg.norm(half, axis=1, keepdims=True)
        return np.asarray(2 * np.sum(half * light, axis=1, keepdims=True) * half - light)

    made = {
        "random": units(random, count, n),
        "at the mirror": mirror,
        "near it": mirror + steps(random, count) * units(random, count, n),
        "one ulp off it": mirror,
        "at the light": light,
        "where it falls": about(fall),
        "where it ends": np.where(
            random.random((count, 1)) < 0.5,
            low + steps(random, count) * units(random, count, n),
            about(flat),
        ),
        "opposite": steps(random, count, -9) * units(random, count, n) - light,
    }[kind].astype(wi.dtype)
    return nudged(random, made) if kind == "one ulp off it" else np.asarray(made)


def pairs(random, frame, light, eye, power=1.0):
    """Return a light and an eye for each frame; ``light`` counts but for opposite steep ones."""
    if not eye.startswith("opposite, "):
        wi = directions(random, frame, light)
        return wi, eyes(random, wi, frame, eye, power)
    count, _, n = frame.shape
    rows = frame.astype(np.float64)
    other = units(random, count, n)
    along = np.einsum("bkn,bk->bn", rows, np.einsum("bkn,bn->bk", rows, other))
    normal = (other - along) / np.linalg.norm(other - along, axis=1, keepdims=True)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    # The half vector is as it is wanted, light and eye hardly more than across it.
    if eye.endswith("falls"):
        half = normal + _width(random, count, power) * along
    else:
        half = along + steps(random, count) * normal
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    across = units(random, count, n)
    across -= np.sum(across * half, axis=1, keepdims=True) * half
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    part = steps(random, count, -6) * half
    return (across + part).astype(frame.dtype), (part - across).astype(frame.dtype)
