"""The light of the sky: error against time, for fields and for surfaces, beside other packages.

Fields are fractal ground of a root mean square slope; the truth at random nodes follows 1,024
azimuths through every cell. Surfaces are a bumpy ball; the truth at its points has 16 times the
rays of the finest row. Packages beside vizlight are measured where they are installed, each against
its own definition: RVT's sky-view factor weighs the sky by solid angle, without the cosine, and so
does libigl's ambient occlusion; trimesh follows the same rays as vizlight by the same Embree.
"""

from __future__ import annotations

import time
from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

import vizlight
from studies import Row, Study, foreign
from vizlight import _compiled
from vizlight.geometry.relief import sky as fields
from vizlight.mesh import sky as meshes

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array, Indices

#: Nodes along a side of a field, and its slopes; errors that are asked for.
SIDE, SLOPES, ASKED = 512, (0.3, 1.0), (0.02, 0.01, 0.005, 0.002)
#: Places and azimuths of the truth of a field, rays of the truth of a surface for libigl.
PLACES, AZIMUTHS, RAYS = 100, 1024, 1 << 14
#: Directions and radii of RVT, rays of libigl and of trimesh.
RVT, IGL, TRIMESH = ((16, 10), (16, 50), (32, 100)), (64, 256, 1024), (64, 256)


def ground(side: int, slope: float, seed: int = 1) -> Array:
    """Return fractal heights of a root mean square slope, spacing 1."""
    random = np.random.default_rng(seed)
    wave = np.fft.fftfreq(side)[:, None] ** 2 + np.fft.rfftfreq(side) ** 2
    wave[0, 0] = 1
    z = np.fft.irfft2(np.fft.rfft2(random.normal(size=(side, side))) / wave**0.9, s=(side, side))
    return np.asarray(z * slope / np.sqrt(np.mean(np.diff(z, axis=0) ** 2)))


def bumpy(points: int) -> pv.PolyData:
    """Return a ball with bumps, of about a number of points."""
    count = max(int(np.sqrt(points)), 8)
    ball = pv.Sphere(radius=1.0, theta_resolution=count, phi_resolution=count)
    x, y, z = np.asarray(ball.points, np.float64).T
    high = 1 + 0.25 * np.sin(7 * x) * np.sin(6 * y + 1) * np.sin(8 * z + 2)
    ball.points = np.asarray(ball.points) * high[:, np.newaxis]
    made: pv.PolyData = ball.compute_normals(split_vertices=False, cell_normals=False)
    return made


@cache
def horizons(side: int, slope: float) -> tuple[Indices, Array, Array, Array]:
    """Return nodes, the two slopes of the ground there, and the slopes of their horizons.

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
    slopes = np.stack([along[tuple(at.T)], across[tuple(at.T)]], axis=1)
    return at, slopes, t, turn


def field_truth(side: int, slope: float) -> tuple[Indices, Array]:
    """Return nodes and the share of the sky that they see."""
    at, slopes, t, turn = horizons(side, slope)
    p, q = slopes.T
    rise = p[:, np.newaxis] * np.cos(turn) + q[:, np.newaxis] * np.sin(turn)
    t = np.maximum(t, rise)
    square = 1 / (1 + t * t)
    part = square - rise * (np.arctan2(1, t) - t * square)
    return at, part.mean(axis=1) / np.sqrt(1 + p * p + q * q)


def of_field(side: int, slope: float, error: float) -> list[Row]:
    """Return the row of an error asked for on a field."""
    z, x = ground(side, slope), np.arange(float(side))
    at, true = field_truth(side, slope)
    # Code is compiled before it is timed.
    fields.sky(x[:64], x[:64], z[:64, :64], error=0.001)
    start = time.process_time()
    made = fields.sky(x, x, z, error=error)
    cost = time.process_time() - start
    missed = np.abs(made.share[tuple(at.T)] - true)
    row = _row(
        f"field, slope {slope:g}", error, missed, cost / z.size, made.error,
        made.azimuths, f"{1e9 * cost / z.size / made.azimuths:.0f} ns per azimuth",
    )  # fmt: skip
    return [row]


def of_rvt(side: int, slope: float, directions: int, radius: int) -> list[Row]:
    """Return the row of RVT, against its own definition from the same horizons."""
    vis = foreign("rvt.vis")
    if vis is None:
        return []
    z = ground(side, slope)
    at, _, t, _ = horizons(side, slope)
    true = (1 - t / np.sqrt(1 + t * t)).mean(axis=1)
    start = time.process_time()
    made = vis.sky_view_factor(
        dem=z, resolution=1, svf_n_dir=directions, svf_r_max=radius, svf_noise=0
    )["svf"]
    cost = time.process_time() - start
    missed = np.abs(np.asarray(made)[tuple(at.T)] - true)
    asked = f"{directions} directions, radius {radius}"
    return [_row(f"RVT, slope {slope:g}", asked, missed, cost / z.size, np.nan, directions, "")]


@cache
def surface_truth(points: int) -> tuple[pv.PolyData, Array]:
    """Return a bumpy ball and the sky of its points."""
    ball = bumpy(points)
    return ball, np.asarray(vizlight.sky(ball, error=0.0015, feature_angle=None)["sky"], np.float64)


def of_surface(points: int, error: float) -> list[Row]:
    """Return the row of an error asked for on a surface."""
    ball, true = surface_truth(points)
    start = time.process_time()
    (made,) = meshes.skies([ball], error=error)
    cost = time.process_time() - start
    missed = np.abs(made.share - true)
    rays = float(str(made.record["directions"]))
    plain = np.mean(true * (1 - true)) / np.mean(missed**2)
    row = _row(
        "surface", error, missed, cost / len(true), float(str(made.record["error"])), rays,
        f"{plain / rays:.1f} times fewer rays than at random",
    )  # fmt: skip
    return [row]


def of_libigl(points: int, rays: int) -> list[Row]:
    """Return the row of libigl, against its own definition: a sky without the cosine."""
    igl = foreign("igl")
    if igl is None:
        return []
    ball, _ = surface_truth(points)
    vertices, faces = np.asarray(ball.points, np.float64), np.asarray(ball.regular_faces, np.int64)
    normals = np.asarray(ball.point_data["Normals"], np.float64)
    true = igl.ambient_occlusion(vertices, faces, vertices + 2e-6 * normals, normals, RAYS)
    start = time.process_time()
    made = igl.ambient_occlusion(vertices, faces, vertices + 2e-6 * normals, normals, rays)
    cost = time.process_time() - start
    missed = np.abs(np.asarray(made) - np.asarray(true))
    return [_row("libigl", rays, missed, cost / len(vertices), np.nan, rays, "")]


def of_trimesh(points: int, rays: int) -> list[Row]:
    """Return the row of trimesh's rays by Embree, in random directions by the cosine."""
    trimesh = foreign("trimesh")
    if trimesh is None:
        return []
    ball, true = surface_truth(points)
    mesh = trimesh.Trimesh(np.asarray(ball.points), ball.regular_faces, process=False)
    normals = np.asarray(ball.point_data["Normals"], np.float64)
    random = np.random.default_rng(0)
    start = time.process_time()
    shares = np.zeros(len(true))
    for _ in range(rays):
        way = random.normal(size=normals.shape)
        way = normals + way / np.linalg.norm(way, axis=1, keepdims=True)
        hit = mesh.ray.intersects_any(np.asarray(ball.points) + 2e-6 * normals, way)
        shares += ~np.asarray(hit)
    cost = time.process_time() - start
    missed = np.abs(shares / rays - true)
    return [_row("trimesh by Embree", rays, missed, cost / len(true), np.nan, rays, "")]


def _row(
    way: str, asked: float | str, missed: Array, seconds: float, stated: float, count: float,
    beside: str,
) -> Row:  # fmt: skip
    more: dict[str, float | str] = {
        "stated": stated, "root mean square": float(np.sqrt(np.mean(missed**2))),
        "largest": float(missed.max()), "directions": count, "beside": beside,
    }  # fmt: skip
    return Row(way, asked, float(np.quantile(missed, 0.95)), 1e9 * seconds, more)


def steps(quick: bool) -> Sequence[Callable[[], list[Row]]]:
    """Return one function for each row."""
    side, points = (192, 2500) if quick else (SIDE, 16000)
    if not _compiled.active():
        side = 64
    few = 1 if quick else None
    made = [partial(of_field, side, slope, error) for slope in SLOPES for error in ASKED]
    made += [partial(of_rvt, side, slope, *how) for slope in SLOPES for how in RVT[:few]]
    made += [partial(of_surface, points, error) for error in (0.04, 0.02, 0.01)]
    made += [partial(of_libigl, points, rays) for rays in IGL[:few]]
    return made + [partial(of_trimesh, points, rays) for rays in TRIMESH[:few]]


STUDY = Study(
    approximates="the share of a uniform sky that a point sees",
    reference=f"{AZIMUTHS} azimuths through every cell; rays to an error of 0.0015",
    parameter="error asked for, or effort",
    error="error of 95 of 100 points",
    cost="processor time in ns per point",
    steps=steps,
)
