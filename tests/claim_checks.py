"""Checks of the register of claims: functions of a generator that return what is found.

Each returns pairs of a stated and a found figure, of which none may be larger than the stated one.
"""

from itertools import pairwise

import numpy as np
import oracles
from oracles import exact, mp

from studies import normals
from vizlight import View
from vizlight.geometry import relief
from vizlight.model import highlights
from vizlight.vtk.corners import surface_normals

EPS = float(np.finfo(float).eps)
#: Functions of a generator by name.
CHECKS = {}


def case(check):
    """Add a check to the table."""
    CHECKS[check.__name__] = check
    return check


def exact_length(x, y, z, start, way):
    """Return the length of a ray below a bilinear field, and the number of crossings."""
    ends = [0.0, max((z.max() - start[2]) / way[2], 0.0)]
    for nodes, along, place in zip((x, y), way, start, strict=False):
        if along:
            ends += [s for s in (nodes - place) / along if 0 < s < ends[1]]
    place, steps = exact(start), exact(way)
    total, crossings = mp.mpf(0), 0
    for low, high in pairwise(map(exact, np.unique(ends))):
        middle = start + float(low + high) / 2 * way
        at = [int(np.clip(np.searchsorted(n, p, "right") - 1, 0, len(n) - 2))
              for n, p in zip((x, y), middle, strict=False)]  # fmt: skip

        def above(s, i=at[0], j=at[1]):
            p = [a + s * b for a, b in zip(place, steps, strict=True)]
            u, v = (
                (min(max(c, exact(n[0])), exact(n[-1])) - exact(n[k])) / exact(n[k + 1] - n[k])
                for c, n, k in zip(p, (x, y), (i, j), strict=False)
            )
            (a, b), (c, d) = exact(z[j : j + 2, i : i + 2])
            return a * (1 - u) * (1 - v) + b * u * (1 - v) + c * (1 - u) * v + d * u * v - p[2]

        # The parabola through the heights at both ends and midway.
        first, half, last = above(low), above((low + high) / 2), above(high)
        two, one = 2 * (first - 2 * half + last), 4 * half - 3 * first - last
        square, roots = one * one - 4 * two * first, []
        if abs(two) > mp.mpf(10) ** -30:
            roots = [(-one + e * mp.sqrt(square)) / (2 * two) for e in (-1, 1)] * (square > 0)
        elif one:
            roots = [-first / one]
        shares = sorted([mp.mpf(0), *(r for r in roots if 0 < r < 1), mp.mpf(1)])
        crossings += len(shares) - 2
        for a, b in pairwise(shares):
            at = (a + b) / 2
            total += (high - low) * (b - a) * (first + at * (one + at * two) > 0)
    return total, crossings


@case
def lengths_below_rough_fields(random):
    """Uneven nodes; and heights of integers with rays in the planes of the nodes."""
    found = []
    for whole in (False, True):
        x, y = (np.arange(float(n)) if whole else np.sort(random.uniform(0, 9, n)) for n in (9, 8))
        z = random.integers(0, 5, (8, 9)).astype(float) if whole else random.uniform(0, 4, (8, 9))
        scale = max(map(np.ptp, (x, y, z)))
        for azimuth in (0, 90, 180, 270) if whole else random.uniform(0, 360, 4):
            e, a = np.radians([random.uniform(10, 80), azimuth])
            way = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
            way[np.abs(way) < 1e-15] = 0
            way /= np.linalg.norm(way)
            starts = [random.choice(x, 8), random.choice(y, 8), random.uniform(-1, 4, 8)]
            starts = np.stack(starts, axis=1)
            lengths = relief.inside_length(x, y, z, starts, direction=way)
            for start, length in zip(starts, lengths, strict=True):
                true, crossings = exact_length(x, y, z, start, way)
                stated = 3 * EPS * scale * max(crossings, 1) + 4 * EPS * float(true)
                found.append((stated, float(abs(exact(length) - true))))
    return found


@case
def axes_of_an_eye(random):
    """Scalar products of the axes, which are 0 and 1."""
    found = []
    for n in np.repeat(range(3, 7), 15):
        rows = exact(View(direction=random.standard_normal(n)).axes())
        found += [
            (4 * EPS, float(abs(oracles.dot(one, other) - (one is other))))
            for one in rows
            for other in rows
        ]
    return found


@case
def mean_errors_of_highlights(random):
    """By longitude about the axis across light and eye: what both reach is a lune."""
    nodes, weights = np.polynomial.legendre.leggauss(600)
    pairs = []
    for angle, r in zip(random.uniform(0.2, 2.5, 3), random.uniform(5, 60, 3), strict=True):
        light, eye = (np.array([s * np.sin(angle / 2), 0, np.cos(angle / 2)]) for s in (1, -1))
        t, phi = np.meshgrid(nodes * np.pi / 2, nodes * (np.pi - angle) / 2)
        normal = np.stack([np.cos(t) * np.sin(phi), np.sin(t), np.cos(t) * np.cos(phi)], axis=-1)
        mirror = np.maximum(2 * (normal @ light) * (normal @ eye) - light @ eye, 0) ** r
        off = 255 * (mirror - np.maximum(normal[..., 2], 0) ** (4 * r))
        area = np.outer(weights, weights) * np.cos(t)
        exact_rms = np.sqrt(np.sum(area * off**2) / np.sum(area))
        volume = np.sum(area * np.abs(off)) / np.sum(area)
        for by, true in (("rms", exact_rms), ("volume", volume)):
            pairs.append((1e-4, abs(highlights.sphere_error(angle, r, by=by) / true - 1)))
    return pairs


#: Largest mean errors of normals by corners as shares of those of VTK's.
OF_VTK = {
    "ellipsoid": 0.85, "gyroid": 0.85, "gyroid, voxels 3 times as long": 1.02,
    "gyroid, voxels 5 times as long": 1.02, "gyroid, off by 1 % of an edge": 1.6,
    "grid of triangles": 1.05, "grid of quads": 0.8, "grid sheared by 1": 1.45,
    "grid of triangles sheared by 2": 1.45, "planes with a rounded edge": 1.9, "random points of the plane": 0.75,
    "random points of a ball": 0.5, "random points of an ellipsoid": 0.5,
}  # fmt: skip


@case
def normals_by_corners(random):
    """Mean errors on random surfaces of each kind, over those of VTK's means of faces."""
    found = []
    for name, stated in OF_VTK.items():
        mesh, true = normals.SURFACES[name](int(random.integers(20, 40)), random)
        errors = (normals.angles(by(mesh), true).mean() for by in (surface_normals, normals.by_vtk))
        found.append((stated, np.divide(*errors)))
    return found
