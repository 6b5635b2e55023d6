"""Balls, a ring with its normals and tangents, and lines: what pictures are made of."""

import numpy as np
import pyvista as pv
from vectors import unit


def ball(fine=24):
    """Return a sphere with heights and tangents."""
    mesh = pv.Sphere(theta_resolution=fine, phi_resolution=fine)
    mesh["height"] = np.array(mesh.points[:, 2])
    mesh["around"] = np.cross(mesh.points, (0.3, 0.2, 1.0)).astype(np.float32)
    return mesh


def straws(count=300, points=12, seed=1):
    """Return straight lines at random in a ball."""
    random = np.random.default_rng(seed)
    way = unit(random.normal(size=(count, 3)))
    middle = random.uniform(-0.7, 0.7, (count, 3))
    places = middle[:, None] + np.linspace(-0.3, 0.3, points)[:, None] * way[:, None]
    ids = np.arange(count * points).reshape(count, points)
    return pv.PolyData(places.reshape(-1, 3), lines=np.insert(ids, 0, points, axis=1).ravel())


def torus(count=101, centre=(0.0, 0.0, 0.0)):
    """Return a surface in float64: normals ``n``, tangents ``around`` and heights."""
    angles = np.linspace(0, 2 * np.pi, count)
    angles[-1] = 0.0
    u, v = (np.ravel(x) for x in np.meshgrid(angles, angles, indexing="ij"))
    grid = pv.StructuredGrid()
    grid.points, grid.dimensions = on_torus(u, v) + centre, (count, count, 1)
    mesh = grid.extract_surface(algorithm=None)
    mesh["n"] = normals_of(u, v)
    mesh["around"] = np.stack([-np.sin(u), np.cos(u), 0 * u], 1)
    mesh["height"] = np.asarray(mesh.points)[:, 2] - centre[2]
    return mesh


def winding():
    """Return lines on the same torus, with its normals and their own tangents."""
    u = np.linspace(0, 2 * np.pi * 40, 12001)
    mesh = pv.MultipleLines(on_torus(u, u / 40))
    mesh["n"] = normals_of(u, u / 40)
    mesh["T"] = np.gradient(np.asarray(mesh.points, dtype=np.float64), axis=0)
    return mesh


def helix(count, turns=3, rise=0.06):
    t = np.linspace(0, 2 * np.pi * turns, count)
    mesh = pv.MultipleLines(np.stack([np.cos(t), np.sin(t), t * rise - 0.6], 1))
    mesh["height"] = np.array(mesh.points[:, 2])
    return mesh


def on_torus(u, v):
    ring = 1 + 0.4 * np.cos(v)
    return np.stack([ring * np.cos(u), ring * np.sin(u), 0.4 * np.sin(v)], 1)


def normals_of(u, v):
    return np.stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)], 1)
