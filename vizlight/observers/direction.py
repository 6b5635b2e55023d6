"""Which way tangents run: an ideal observer, and a reader who matches hues to a key."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight.model.kernels import unit_rows
from vizlight.observers.colors import information, lab, posterior, seen, shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array
    from vizlight.observers.samples import Sample

#: Number of candidates, one for each degree.
ANGLES = 180
#: Number of places that are matched at once.
BLOCK = 1024
#: Least length of a unit tangent in the picture whose direction there is asked for.
SHORTEST = 0.35


class Found(NamedTuple):
    """Errors in degrees and bits of each place; see :func:`ideal`."""

    error: Array
    bits: Array


def ideal(sample: Sample, random: np.random.Generator, noise: float) -> Found:
    """Return the errors of an observer who knows lamps, material and normal.

    The candidates are the tangent turned about the normal, or about the line of sight for a
    point without one, by each degree from a random angle.

    Parameters
    ----------
    sample : Sample
        Places with one tangent each.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    Found
        Angle in degrees, from 0 to 90, between the tangent and the likeliest candidate, and the
        bits that the colour tells of the 180 candidates.
    """
    errors, bits = [], []
    for start in range(0, len(sample), BLOCK):
        own = sample.take(slice(start, start + BLOCK))
        assert own.tangents is not None
        m = len(own)
        tangent = own.tangents[:, 0]
        axis = own.eye if own.normals is None else own.normals
        along = np.einsum("ij,ij->i", tangent, axis)[:, np.newaxis] * axis
        flat = tangent - along
        if own.normals is not None:
            # Interpolation leaves a tangent a little off the surface.
            along, flat = 0 * along, unit_rows(flat)
            tangent = flat
        # Candidates start anywhere: ties must not favour the true one.
        offset = random.uniform(0.0, 180.0, m)
        turn = (np.arange(ANGLES) + offset[:, np.newaxis])[..., np.newaxis]
        across = np.cross(axis, flat)[:, np.newaxis]
        every = np.cos(np.radians(turn)) * flat[:, np.newaxis] + np.sin(np.radians(turn)) * across
        every = (every + along[:, np.newaxis]).reshape(-1, 1, 3)
        repeated = None if own.normals is None else np.repeat(own.normals, ANGLES, axis=0)
        table = shown(own.light(every, repeated, ANGLES)).reshape(m, ANGLES, 3)
        observed = seen(own.light(tangent[:, np.newaxis], own.normals), random, noise)
        likely = posterior(observed, table, noise)
        off = (likely.argmax(axis=1) + offset) % 180
        errors.append(np.minimum(off, 180 - off))
        bits.append(information(likely))
    return Found(np.concatenate(errors), np.concatenate(bits))


def by_key(sample: Sample, middle: Array, random: np.random.Generator, noise: float) -> Array:
    """Return the errors of a reader who knows no normal and matches hues to a key.

    The key is a small disc at ``middle`` that faces the eye, with tangents in all directions.

    Parameters
    ----------
    sample : Sample
        Places with one tangent each.
    middle : ndarray, shape (3,)
        Place of the key.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    ndarray
        Angle in degrees, from 0 to 90, between the directions in the picture, of the tangents
        that have a length there.
    """
    assert sample.tangents is not None
    tangent = sample.tangents[:, 0]
    x, y = (np.einsum("ij,ij->i", tangent, axis) for axis in (sample.right, sample.up))
    own = sample.take(np.hypot(x, y) > SHORTEST)
    if not len(own):
        return np.empty(0)
    start = random.uniform(0.0, 180.0)
    disc = key(own, middle, np.radians(start + np.arange(ANGLES)))
    hues = _hue(shown(disc), random)
    found = _hue(seen(own.own_light(), random, noise), random) @ hues.T
    course = np.degrees(np.arctan2(y, x))[np.hypot(x, y) > SHORTEST]
    off = start + found.argmax(axis=1) - course
    return np.asarray(np.abs((off + 90) % 180 - 90))


def key(sample: Sample, middle: Array, angles: Array) -> Array:
    """Return the light of a disc that faces the eye at a place, for tangents at some angles."""
    nearest = np.argmin(((sample.points - middle) ** 2).sum(axis=1))
    one = sample.take(np.full(len(angles), nearest))
    across = np.cos(angles)[:, np.newaxis] * one.right + np.sin(angles)[:, np.newaxis] * one.up
    return one.light(across[:, np.newaxis], one.eye)


def _hue(rgb: Array, random: np.random.Generator) -> Array:
    """Return hues as unit vectors in the plane of CIELAB's a and b; gray has a random one."""
    plane = lab(rgb)[:, 1:]
    return unit_rows(plane + random.normal(0.0, 1e-6, plane.shape))


def directed(samples: Sequence[Sample]) -> list[Sample]:
    """Return the places whose direction is asked for: single tangents of surfaces and of points."""
    return [
        one.take(one.valid)
        for one in samples
        if one.kind != "line" and one.tangents is not None and one.tangents.shape[1] == 1
    ]
