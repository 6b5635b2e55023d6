"""Straight lines as solid cylinders, and rays that are tested against each of them."""

import numpy as np
from vectors import unit

from vizlight.geometry.lines import bundle


def pieces(middles, tangents, length, voxel):
    """Return the medium of straight lines."""
    ends = np.stack([middles - length / 2 * tangents, middles + length / 2 * tangents], axis=1)
    count = len(middles)
    return bundle.medium(
        ends.reshape(-1, 3), np.arange(2 * count), np.arange(0, 2 * count + 1, 2), voxel=voxel
    )


def shaded(origins, toward, own, middles, tangents, length, diameter, reach):
    """Return whether rays meet a solid cylinder other than their own as far as their reach.

    Lines at random overlap: of those that cover the start of a ray the half counts that has the
    middle of the ray's way through them ahead of it.
    """
    found = np.zeros(len(origins), np.bool_)
    turned, own_way = np.cross(middles, tangents), (middles * tangents).sum(axis=1)
    for i, (origin, one) in enumerate(zip(origins, toward, strict=True)):
        # Products with the way from the origin to the middle, of which the axis is a tangent.
        cosine = tangents @ one
        sine = np.sqrt(np.maximum(1 - cosine**2, 1e-24))
        gap = np.abs(turned @ one - tangents @ np.cross(one, origin)) / sine
        near = np.flatnonzero(gap < diameter / 2)
        near = near[near != own[i]]
        c, half = cosine[near], np.sqrt(diameter**2 / 4 - gap[near] ** 2) / sine[near]
        x, y = (middles[near] - origin) @ one, own_way[near] - tangents[near] @ origin
        # Along the ray: between the sides of the cylinder, and between the planes of its ends.
        at, level = (x - c * y) / sine[near] ** 2, y / np.where(c, c, 1e-30)
        depth = length / 2 / np.maximum(np.abs(c), 1e-30)
        first, last = np.maximum(at - half, level - depth), np.minimum(at + half, level + depth)
        found[i] = ((first < last) & (first + last > 0) & (first + last < 2 * reach[i])).any()
    return found


def some_lines(kind, random, count=1200, length=0.5):
    """Return middles and tangents of straight lines, in the unit ball or in layers."""
    middles = unit(random.normal(size=(count, 3))) * random.uniform(size=(count, 1)) ** (1 / 3)
    tangents = unit(random.normal(size=(count, 3)))
    if kind == "aligned":
        tangents = unit([1, 0, 0] + 0.1 * tangents)
    elif kind == "parallel":
        tangents = np.tile([1.0, 0, 0], (count, 1))
    elif kind == "crossing":
        ways = np.where(np.arange(count)[:, np.newaxis] % 2, [1, 0, 0], [0.5, 0.75**0.5, 0])
        tangents = unit(ways + 0.05 * tangents)
    elif kind == "layered":
        layer = random.integers(6, size=count)
        middles = random.uniform(-0.8, 0.8, (count, 3))
        middles[:, 2] = (layer - 2.5) / 4 + random.uniform(-0.04, 0.04, count)
        tangents = unit(np.eye(3)[layer % 2] + 0.05 * tangents * [1, 1, 0.2])
    return middles, tangents


def straight_halves(tangents, length, at):
    """Return the halves of straight lines at places, in lengths from their middles."""
    halves = np.ones((len(tangents), 2, 4))
    halves[:, 0, :3], halves[:, 1, :3] = (0.5 - at) * tangents, -(0.5 + at) * tangents
    halves[:, :, :3] *= length
    return halves
