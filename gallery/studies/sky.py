"""The light of the sky: error against time, for fields and for surfaces.

Fields are fractal ground of a root mean square slope; the truth at random nodes follows 1,024
azimuths through every cell. Surfaces are a bumpy ball; the truth at its points has 16 times the
rays of the finest row.
"""

from __future__ import annotations

import time
from functools import cache, partial

import numpy as np
import pyvista as pv

import vizlight
from studies import Row, Study
from vizlight import _compiled
from vizlight.geometry.relief import sky as fields
from vizlight.mesh import sky as meshes

#: Nodes along a side of a field, and its slopes; errors that are asked for.
SIDE, SLOPES, ASKED = 512, (0.3, 1.0), (0.02, 0.01, 0.005, 0.002)
#: Places and azimuths of the truth of a field.
PLACES, AZIMUTHS = 100, 1024


def ground(side, slope, seed=1):
    """Return fractal heights of a root mean square slope, spacing 1."""
    random = np.random.default_rng(seed)
    wave = np.fft.fftfreq(side)[:, None] ** 2 + np.fft.rfftfreq(side) ** 2
    wave[0, 0] = 1
    z = np.fft.irfft2(np.fft.rfft2(random.normal(size=(side, side))) / wave**0.9, s=(side, side))
    return np.asarray(z * slope / np.sqrt(np.mean(np.diff(z, axis=0) ** 2)))


def bumpy(points):
    """Return a ball with bumps, of about a number of points."""
    count = max(int(np.sqrt(points)), 8)
    ball = pv.Sphere(radius=1.0, theta_resolution=count, phi_resolution=count)
    x, y, z = np.asarray(ball.points, np.float64).T
    high = 1 + 0.25 * np.sin(7 * x) * np.sin(6 * y + 1) * np.sin(8 * z + 2)
    ball.points = np.asarray(ball.points) * high[:, np.newaxis]
    return ball.compute_normals(split_vertices=False, cell_normals=False)


@cache
def field_truth(side, slope):
    """Return nodes and the share of the sky that they see.

    Heights are the bilinear surface's, at dense distances nearby and wherever a ray crosses a line
    of the grid; beyond the border those there.
    """
    z = ground(side, slope)
    at = np.random.default_rng(9).integers(0, side, (PLACES, 2))
    across, along = np.gradient(z, axis=0), np.gradient(z, axis=1)
    turn = 2 * np.pi * (np.arange(AZIMUTHS) + 0.5) / AZIMUTHS
    x, y = np.cos(turn)[:, np.newaxis], np.sin(turn)[:, np.newaxis]
    # The first stands for the surface right beside the node, where an arc may be steepest.
    near = np.broadcast_to(np.append(1e-6, np.arange(1, 200) / 25), (AZIMUTHS, 200))
    t = np.zeros((PLACES, AZIMUTHS))
    for n, (j, i) in enumerate(at):
        going = np.arange(AZIMUTHS)
        for lines in np.array_split(np.arange(4 * side), side // 8):
            crossed = lines[lines > 0]
            ways = crossed / np.abs(x), crossed / np.abs(y)
            s = np.concatenate([*ways, near] if not lines[0] else ways, axis=1)[going]
            px = np.clip(i + s * x[going], 0, side - 1)
            py = np.clip(j + s * y[going], 0, side - 1)
            a, b = (np.minimum(p.astype(int), side - 2) for p in (px, py))
            u, v = px - a, py - b
            low, high = (z[b + k, a] + u * (z[b + k, a + 1] - z[b + k, a]) for k in (0, 1))
            steep = ((low + v * (high - low) - z[j, i]) / s).max(axis=1)
            t[n, going] = np.maximum(t[n, going], steep)
            going = going[(z.max() - z[j, i]) / (lines[-1] + 1) > t[n, going]]
            if not len(going):
                break
    p, q = along[tuple(at.T)], across[tuple(at.T)]
    rise = p[:, np.newaxis] * np.cos(turn) + q[:, np.newaxis] * np.sin(turn)
    t = np.maximum(t, rise)
    square = 1 / (1 + t * t)
    part = square - rise * (np.arctan2(1, t) - t * square)
    return at, part.mean(axis=1) / np.sqrt(1 + p * p + q * q)


def of_field(side, slope, error):
    """Return the row of an error asked for on a field."""
    z, x = ground(side, slope), np.arange(float(side))
    at, true = field_truth(side, slope)
    # Code is compiled before it is timed.
    fields.sky(x[:64], x[:64], z[:64, :64], error=0.001)
    start = time.process_time()
    made = fields.sky(x, x, z, error=error)
    cost = time.process_time() - start
    missed = np.abs(made.share[tuple(at.T)] - true)
    return [_row(f"field, slope {slope:g}", error, missed, cost / z.size, made.error)]


@cache
def surface_truth(points):
    """Return a bumpy ball and the sky of its points."""
    ball = bumpy(points)
    return ball, np.asarray(vizlight.sky(ball, error=0.0015, feature_angle=None)["sky"], np.float64)


def of_surface(points, error):
    """Return the row of an error asked for on a surface."""
    ball, true = surface_truth(points)
    start = time.process_time()
    (made,) = meshes.skies([ball], error=error)
    cost = time.process_time() - start
    missed = np.abs(made.share - true)
    stated = float(str(made.record["error"]))
    return [_row("surface", error, missed, cost / len(true), stated)]


def _row(way, asked, missed, seconds, stated):
    more = {"stated": stated, "largest": float(missed.max())}
    return Row(way, asked, float(np.quantile(missed, 0.95)), 1e9 * seconds, more)


def steps(quick):
    """Return one function for each row."""
    side, points = (192, 2500) if quick else (SIDE, 16000)
    if not _compiled.active():
        side = 64
    made = [partial(of_field, side, slope, error) for slope in SLOPES for error in ASKED]
    return made + [partial(of_surface, points, error) for error in (0.04, 0.02, 0.01)]


STUDY = Study(
    approximates="the share of a uniform sky that a point sees",
    reference=f"{AZIMUTHS} azimuths through every cell; rays to an error of 0.0015",
    parameter="error asked for",
    error="error of 95 of 100 points",
    cost="processor time in ns per point",
    steps=steps,
)
