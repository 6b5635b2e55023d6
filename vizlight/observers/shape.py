"""How surfaces stand: an ideal observer of normals, to whom tangents are unknown."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.model.kernels import unit_rows
from vizlight.observers.colors import information, posterior, seen, shown
from vizlight.observers.direction import Found

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.observers.samples import Sample

#: Number of candidates for a normal; where there are tangents, fewer, each with some of those. With
#: 24 directions of tangents the bits would be up to 0.8 too many, with 72 at most 0.15.
ALONE, WITH_TANGENTS = (900, 1), (300, 72)
#: Largest number of candidates that are lit where each place has its own, and matched in all.
LIT, MATCHED = 1 << 22, 1 << 25
#: Number of candidates that are matched at once.
BLOCK = 1 << 20


def most(sample: Sample) -> int:
    """Return the largest number of places that are asked for."""
    each, turns = ALONE if sample.tangents is None else WITH_TANGENTS
    return max(64, (LIT if sample.local else MATCHED) // (each * turns))


def ideal(sample: Sample, random: np.random.Generator, noise: float) -> Found:
    """Return the errors of an observer who knows lamps and material.

    The candidates are even on the disc that a smooth body shows, so that each is as likely as it
    is large in a picture of all normals. Tangents, if there are any, may have any direction.

    Parameters
    ----------
    sample : Sample
        Places with normals.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    Found
        Angle in degrees between the side of the surface that is seen and the mean of the
        candidates by their probability, and the bits that the colour tells of the candidates. The
        likeliest one would be worse than no look at the picture where the colour tells little.
    """
    assert sample.normals is not None
    count, turns = ALONE if sample.tangents is None else WITH_TANGENTS
    disc, along = _disc(count, turns, random.uniform(0.0, 2 * np.pi))
    observed = seen(sample.own_light(), random, noise)
    facing = np.einsum("ij,ij->i", sample.normals, sample.eye)[:, np.newaxis]
    truth = np.where(facing < 0, -sample.normals, sample.normals)
    errors, bits = [], []
    step = max(1, BLOCK // len(disc))
    table: Array | None = None
    for start in range(0, len(sample), step):
        own = sample.take(slice(start, start + step))
        if sample.local or table is None:
            lit = own if sample.local else own.take(np.zeros(1, dtype=np.intp))
            table = _table(lit, disc, along)
            table = table if sample.local else table[0]
        likely = posterior(observed[start : start + step], table, noise)
        normal = likely.reshape(len(own), turns, count).sum(axis=1)
        best = unit_rows(normal @ disc[:count])
        cosine = np.einsum("ij,ij->i", _in_space(own, best), truth[start : start + step])
        errors.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
        bits.append(information(normal))
    return Found(np.concatenate(errors), np.concatenate(bits))


def _disc(count: int, turns: int, phase: float) -> tuple[Array, Array]:
    """Return candidates in the frame of the eye: normals and tangents, shape (turns count, 3)."""
    i = np.arange(count) + 0.5
    # Fibonacci's spiral, even in area.
    radius, angle = np.sqrt(i / count), i * np.pi * (3 - 5**0.5) + phase
    height = np.sqrt(1 - radius * radius)
    normals = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    # Any direction that is nowhere along a normal: the edge of the disc is not a candidate.
    first = unit_rows(np.cross(normals, [np.cos(phase), np.sin(phase), 0.0]))
    second = np.cross(normals, first)
    turn = (np.pi * np.arange(turns) / turns)[:, np.newaxis, np.newaxis]
    tangents = np.cos(turn) * first + np.sin(turn) * second
    return np.tile(normals, (turns, 1)), tangents.reshape(-1, 3)


def _in_space(sample: Sample, local: Array) -> Array:
    """Return vectors in the frame of the eye, one for each place, in space."""
    axes = np.stack([sample.right, sample.up, sample.eye], axis=1)
    return np.asarray(np.einsum("ij,ijk->ik", local, axes))


def _table(sample: Sample, normals: Array, tangents: Array) -> Array:
    """Return the colours of candidates, shape (M, A, 3)."""
    m, a = len(sample), len(normals)
    axes = np.stack([sample.right, sample.up, sample.eye], axis=1)
    every = np.einsum("aj,ijk->iak", normals, axes).reshape(-1, 3)
    frames = None
    if sample.tangents is not None:
        frames = np.einsum("aj,ijk->iak", tangents, axes).reshape(-1, 1, 3)
        if sample.tangents.shape[1] == 2:
            frames = np.concatenate([frames, np.cross(every, frames[:, 0])[:, np.newaxis]], axis=1)
    return shown(sample.light(frames, every, a)).reshape(m, a, 3)
