"""Balls, a ring with its normals and tangents, lines, and shapes in 4-space with exact tangents."""

import numpy as np
import pyvista as pv
from vectors import unit

from vizlight.geometry.nspace import lattice, manifolds


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


def clifford_torus(resolution):
    """Return the torus of two equal circles that lies in the unit 3-sphere."""
    return manifolds.torus(0.5**0.5, 0.5**0.5, resolution=resolution)


def torus_curve(ratio, turns=1, radii=(1.0, 1.0), resolution=50):
    """Return a closed curve on a torus, which turns ``ratio`` times as often the second way."""
    pairs = (radii[0], 1), (radii[1], ratio)
    return manifolds.parametric(
        lambda t: [r * f(w * t) for r, w in pairs for f in (np.cos, np.sin)],
        [(0, 2 * np.pi * turns)], 4, resolution=resolution,
    )  # fmt: skip


def klein_bottle(rows=96, columns=48):
    """Return a Klein bottle: a circle about another, flipped in the zw plane on its way."""
    u, v = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in (rows, columns)), indexing="ij")
    x, y, z, w = (f(k * u) for k in (1, 0.5) for f in (np.cos, np.sin))
    out, up = 2 + np.cos(v), np.sin(v)
    places = np.stack([out * x, out * y, up * z, up * w], axis=-1)
    along = np.stack([-out * y, out * x, -up * w / 2, up * z / 2], axis=-1)
    across = np.stack([-up * x, -up * y, np.cos(v) * z, np.cos(v) * w], axis=-1)
    # Where u returns to its start, column -j stands for j.
    index = np.arange(rows * columns).reshape(rows, columns)
    index = np.append(index, np.roll(index[0, ::-1], 1))
    cells = index[lattice.cells((rows + 1, columns), (False, True))]
    tangents = np.stack([along, across], axis=-2).reshape(-1, 2, 4)
    return manifolds.manifold(places.reshape(-1, 4), tangents, cells)


def sphere3(size):
    """Return the 3-sphere as 8 cubes of cells; frames are the place, a quaternion, by i, j, k."""
    steps = 2 * np.arange(size + 1) - size
    within = np.stack(np.meshgrid(*[steps] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    sides = [np.insert(within, axis, side, axis=1) for axis in range(4) for side in (-size, size)]
    corners, number = np.unique(np.concatenate(sides), axis=0, return_inverse=True)
    local = lattice.cells((size + 1,) * 3, (False,) * 3)
    cells = np.concatenate([local + i * len(within) for i in range(len(sides))])
    places = unit(np.tan(np.pi / 4 * corners / size))
    x, y, z, w = places.T
    rows = np.array([[w, -z, y, -x], [z, w, -x, -y], [-y, x, w, -z]])
    return manifolds.Manifold(places, np.moveaxis(rows, 2, 0), number.reshape(-1)[cells])
