"""Light inside bundles of lines: the medium against rays among real tubes.

Rays by Embree start across the width of a line and pass their own tube. The error is that of the
mean share of light over many points of the lines: the medium has no single tubes, so the share at
one point differs by the RMS error in the table. Points and rays are random, with an error of the
mean of about 0.002.
"""

from __future__ import annotations

import time
from collections import namedtuple
from functools import cache, partial

import numpy as np

from studies import Row, Study
from vizlight.geometry.lines import bundle as geometry
from vizlight.mesh import closed_meshes

KINDS = ("isotropic", "aligned", "layered", "along the light")
#: Number of sides of a tube; its radius is such that its mean width is that of a cylinder.
SIDES = 8
LENGTH, TUBES, DIAMETER = 0.5, 4000, 0.006
TOWARD = np.array([0.3, -0.4, 0.866]) / np.linalg.norm([0.3, -0.4, 0.866])
LAMP = np.array([0.1, 0.05, -0.08])
#: Rays per point to each light, and to all sides.
ACROSS, AROUND = 8, 16
#: Start of a ray beyond a hit of its own tube, and number of such hits.
PASS, HITS = 1e-5, 8


#: Straight lines in the unit ball or in layers, points on them, and the tubes as triangles.
Tubes = namedtuple("Tubes", "middles tangents own places corners")
#: Shares of light by rays, at points: of a far light, of a light inside, from all sides.
Truth = namedtuple("Truth", "tubes far near around")


def tubes(kind, points, *, seed=3):
    """Return lines of a kind, with points on them."""
    random = np.random.default_rng(seed)
    tangents = _unit(random.normal(size=(TUBES, 3)))
    middles = _unit(random.normal(size=(TUBES, 3))) * random.uniform(size=(TUBES, 1)) ** (1 / 3)
    if kind == "aligned":
        tangents = _unit([1, 0, 0] + 0.1 * tangents)
    elif kind == "along the light":
        tangents = _unit(TOWARD + 0.1 * tangents)
    elif kind == "layered":
        layer = random.integers(6, size=TUBES)
        middles = random.uniform(-0.8, 0.8, (TUBES, 3))
        middles[:, 2] = (layer - 2.5) / 4 + random.uniform(-0.04, 0.04, TUBES)
        tangents = 0.05 * tangents + np.eye(3)[layer % 2]
        tangents[:, 2] *= 0.2
        tangents = _unit(tangents)
    own = random.integers(TUBES, size=points)
    along = random.uniform(-0.45, 0.45, (points, 1)) * LENGTH
    places = middles[own] + along * tangents[own]
    return Tubes(middles, tangents, own, places, _triangles(middles, tangents))


def _unit(rows):
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def _triangles(middles, tangents):
    """Return the triangles of open prisms, shape (T, 3, 3), 2 SIDES for each line."""
    u = _unit(np.cross(tangents, np.eye(3)[np.argmin(np.abs(tangents), axis=1)]))
    v = np.cross(tangents, u)
    angle = np.arange(SIDES + 1) * 2 * np.pi / SIDES
    radius = np.pi * DIAMETER / (2 * SIDES * np.sin(np.pi / SIDES))
    ring = radius * (
        np.cos(angle)[:, None, None] * u + np.sin(angle)[:, None, None] * v
    )  # (SIDES + 1, lines, 3)
    low, high = (middles + s * LENGTH / 2 * tangents + ring for s in (-1, 1))
    first = np.stack([low[:-1], low[1:], high[:-1]], axis=2)
    second = np.stack([high[:-1], low[1:], high[1:]], axis=2)
    both = np.stack([first, second], axis=0).transpose(2, 0, 1, 3, 4)
    return both.reshape(-1, 3, 3)


@cache
def truth(kind, points):
    """Return the shares of light by rays among the tubes.

    Raises
    ------
    ImportError
        If embreex is not installed.
    """
    made, random = tubes(kind, points), np.random.default_rng(4)
    scene = closed_meshes.embree_tree(made.corners)
    if scene is None:
        raise ImportError("embreex, for rays, is missing; try: pip install 'vizlight[rays]'")

    def free(toward, reach, x):
        """Return 1 where a ray meets no tube but its own."""
        side = np.cross(toward, made.tangents[made.own])
        side /= np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)
        start, at = made.places + np.reshape(x, (-1, 1)) * DIAMETER * side, np.arange(points)
        gone, out = np.zeros(points), np.ones(points)
        for _ in range(HITS):
            begin = start[at] + gone[at, None] * toward[at]
            found = scene.run(begin.astype(np.float32), toward[at].astype(np.float32), output=True)
            hit = (found["primID"] >= 0) & (gone[at] + found["tfar"] < reach[at])
            mine = hit & (found["primID"] // (2 * SIDES) == made.own[at])
            out[at[hit & ~mine]] = 0
            gone[at[mine]] += found["tfar"][mine] + PASS
            at = at[mine]
            if not len(at):
                break
        return out

    far = np.full(points, np.inf)
    toward = np.broadcast_to(TOWARD, made.places.shape)
    shares = np.linspace(-0.5, 0.5, 2 * ACROSS + 1)[1::2]
    distant = np.mean([free(toward, far, x) for x in shares], axis=0)
    way = LAMP - made.places
    distance = np.linalg.norm(way, axis=1)
    near = np.mean([free(way / distance[:, None], distance, x) for x in shares], axis=0)
    total = weight = np.zeros(points)
    for _ in range(AROUND):
        # Light reaches a cylinder in proportion to the width that it shows.
        ways = _unit(random.normal(size=(points, 3)))
        sine = np.linalg.norm(np.cross(ways, made.tangents[made.own]), axis=1)
        total = total + sine * free(ways, far, random.uniform(-0.5, 0.5, points))
        weight = weight + sine
    return Truth(made, distant, near, total / weight)


def measure(kind, points, grid, count):
    """Return the rows of a kind of lines, for a number of voxels and of directions, one of them 0.

    With a number of directions the light from all sides is measured, else that of two lights.
    """
    true = truth(kind, points)
    made = true.tubes
    ends = np.stack([made.middles + s * LENGTH / 2 * made.tangents for s in (-1, 1)], axis=1)
    ids, offsets = np.arange(2 * TUBES), np.arange(0, 2 * TUBES + 1, 2)
    flat = ends.reshape(-1, 3)
    start = time.process_time()
    voxel = max(float(np.ptp(flat, axis=0).max()) / grid, geometry.LEAST_VOXEL * DIAMETER)
    lines = geometry.medium(flat, ids, offsets, voxel=voxel)
    along, middle = made.tangents[made.own], made.middles[made.own]
    at = np.einsum("ij,ij->i", made.places - middle, along)[:, np.newaxis]
    halves = np.ones((points, 2, 4))
    halves[:, 0, :3], halves[:, 1, :3] = (LENGTH / 2 - at) * along, -(LENGTH / 2 + at) * along
    targets = lines.targets(made.places, along, halves)
    lights = [(TOWARD, False), (LAMP, True)]
    if count:
        sides = lines.sky(targets, DIAMETER, count)
        cost = 1e9 * (time.process_time() - start) / points
        return [_row(f"{kind}, all sides", count, sides - true.around, true.around, cost)]
    left = lines.dimmed(targets, DIAMETER, lights)
    cost = 1e9 * (time.process_time() - start) / points
    return [
        _row(f"{kind}, {name}", grid, left[:, i] - known, known, cost / 2)
        for i, (name, known) in enumerate((("far light", true.far), ("light inside", true.near)))
    ]


def _row(way, parameter, error, true, cost):
    more = {
        "mean share": float(true.mean()),
        "signed error": float(error.mean()),
        "RMS error": float(np.sqrt(np.mean(error * error))),
    }
    return Row(way, parameter, abs(float(error.mean())), cost, more)


def steps(quick):
    """Return one step for each number of voxels and of directions, and each kind of lines."""
    points = 10_000 if quick else 40_000
    grids = (32, 64, 128) if quick else (16, 32, 64, 128, 192)
    counts = (16, 64) if quick else (8, 16, 32, 64, 128)
    return [
        partial(measure, kind, points, grid, count)
        for kind in KINDS
        for grid, count in [(n, 0) for n in grids] + [(128, n) for n in counts]
    ]


STUDY = Study(
    approximates="light among tubes by a medium of lines",
    reference="rays among real tubes (Embree)",
    parameter="voxels along a side, or directions for all sides",
    error="error of the mean share of light",
    cost="ns per point",
    steps=steps,
)
