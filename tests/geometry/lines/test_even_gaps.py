"""The largest gap between evenly spaced lines is that of the farthest place, found by halving."""

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import cKDTree
from vectors import parts, waves

from vizlight import streamlines
from vizlight.mesh.normals import NORMALS, with_normals


def gyroid():
    n = 30
    grid = pv.ImageData(dimensions=(n, n, n), spacing=3 * (2 * np.pi / (n - 1),))
    x, y, z = np.asarray(grid.points).T
    grid["f"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    return grid.contour([0.13], scalars="f")


SURFACES = {
    "plane": (lambda: pv.Plane(i_resolution=20, j_resolution=20).triangulate(), 3, 0, 0.08),
    "sphere": (lambda: pv.Sphere(radius=1, theta_resolution=40, phi_resolution=40), 2, 1, 0.15),
    "torus": (lambda: pv.ParametricTorus(1, 0.4, u_res=60, v_res=60, w_res=60), 2, 2, 0.15),
    "gyroid": (gyroid, 1, 3, 0.4),
}


def embedded(points, normals, spacing):
    """Return positions and half a spacing times unit normals."""
    size = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.concatenate([points, spacing / 2 * normals / size], axis=-1)


def farthest(surface, lines, spacing):
    """Return the largest distance of a dense sample of a surface from the segments of lines.

    Places are the centres of ever smaller triangles, 200 per spacing at last, and left out where
    their corners tell that no place of them is farther than the farthest one.
    """
    tracks = []
    for cell in range(lines.n_cells):
        ids = lines.get_cell(cell).point_ids
        ends = embedded(lines.points[ids].astype(float), lines["Normals"][ids], spacing)
        share = np.linspace(0, 1, 60)[:, np.newaxis, np.newaxis]
        tracks.append(((1 - share) * ends[:-1] + share * ends[1:]).reshape(-1, 6))
    tree = cKDTree(np.concatenate(tracks))
    faces = surface.regular_faces
    parts = np.concatenate([surface.points[faces], surface[NORMALS][faces]], axis=2).astype(float)
    best = 0.0
    while len(parts):
        middle = parts.mean(axis=1)
        at = embedded(middle[:, :3], middle[:, 3:], spacing)
        corners = embedded(parts[..., :3], parts[..., 3:], spacing)
        radius = np.linalg.norm(corners - at[:, np.newaxis], axis=2).max(axis=1)
        far = tree.query(at)[0]
        best = max(best, far.max())
        a, b, c = np.moveaxis(parts[(far + 1.1 * radius > best) & (radius > spacing / 400)], 1, 0)
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        parts = np.concatenate([np.stack(corner, axis=1) for corner in quarters])
    return best / spacing


@pytest.mark.slow
@pytest.mark.parametrize("name", SURFACES)
def test_the_largest_gap_on_a_surface(name, seed, claim):
    make, frequency, number, spacing = SURFACES[name]
    mesh = make()
    mesh["V"] = waves(np.asarray(mesh.points, float), frequency, number + seed)
    lines = streamlines(mesh, tangents="V", spacing=spacing)
    expected = farthest(with_normals(mesh, None, None), lines, spacing)
    found = lines.field_data["largest_gap"][0]
    claim(expected - found, 0.01)
    assert found <= expected + 0.005


@pytest.mark.parametrize("n", [1, 30])
def test_the_largest_gap_between_parallel_lines(n, claim):
    """Where all places midway are about as far, on large triangles and on small ones."""
    plane = pv.Plane(i_resolution=n, j_resolution=n).triangulate()
    plane["V"] = np.tile([1.0, 0, 0], (plane.n_points, 1))
    lines = streamlines(plane, tangents="V", spacing=0.05)
    y = np.unique([lines.get_cell(i).points[0, 1] for i in range(lines.n_cells)])
    expected = max(y[0] + 0.5, 0.5 - y[-1], np.diff(y).max() / 2) / 0.05
    claim(abs(lines.field_data["largest_gap"][0] - expected), 0.01)


def test_the_largest_gap_in_a_volume(seed, claim):
    grid, spacing = pv.ImageData(dimensions=(9, 9, 9), spacing=(0.125, 0.125, 0.125)), 0.2
    grid["V"] = waves(np.asarray(grid.points), 6, seed)
    lines = streamlines(grid, tangents="V", spacing=spacing)
    share = np.linspace(0, 1, 20)[:, np.newaxis, np.newaxis]
    tree = cKDTree(
        np.concatenate(
            [((1 - share) * p[:-1] + share * p[1:]).reshape(-1, 3) for p in parts(lines)]
        )
    )
    random = np.random.default_rng(0)
    places = random.random((100_000, 3))
    for size in spacing * 0.5 ** np.arange(1, 8):
        far = tree.query(places)[0]
        top = places[np.argsort(-far)[:300]]
        around = top[:, np.newaxis] + random.uniform(-size, size, (300, 100, 3))
        places = np.concatenate([top, np.clip(around.reshape(-1, 3), 0, 1)])
    expected = tree.query(places)[0].max() / spacing
    claim(abs(lines.field_data["largest_gap"][0] - expected), 0.01)
