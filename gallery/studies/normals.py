"""Normals of surfaces without any: VTK's means over faces, and means by the corners of faces.

The surfaces are those of functions, whose gradients are the exact normals: isosurfaces through
volumes of n nodes along the axis that has most, warped grids of n by n nodes, even and sheared, and
triangulations of random points.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pyvista as pv
from scipy.spatial import ConvexHull, Delaunay

from studies import Curve, Row, Study, take_turns
from vizlight.vtk.corners import surface_normals

NODES = (20, 40, 80)


def ellipsoid(x, y, z):
    """Return a function that is 0 on an ellipsoid."""
    return x * x + y * y + 0.5 * z * z - 1.5


def gyroid(x, y, z):
    """Return a function that is 0 on a gyroid."""
    found = np.zeros_like(x)
    for a, b in ((x, y), (y, z), (z, x)):
        found += np.sin(3 * a) * np.cos(3 * b)
    return found


def hills(x, y, z):
    """Return a function that is 0 on a warped grid."""
    return z - 0.5 * np.sin(2 * x) * np.cos(3 * y)


def gradient(function, points, step=1e-5):
    """Return the gradients of a function by central differences."""
    places = np.asarray(points, dtype=float)
    ends = ([places + side * step * axis for side in (1, -1)] for axis in np.eye(3))
    return np.stack([function(*ahead.T) - function(*behind.T) for ahead, behind in ends], axis=1)


def angles(found, exact):
    """Return the angles in degrees between vectors, whatever their sides."""
    across = np.linalg.norm(np.cross(found, exact), axis=1)
    return np.asarray(np.degrees(np.arctan2(across, np.abs(np.einsum("ij,ij->i", found, exact)))))


def isosurface(function, n, random, *, longest=1, noise=0.0):
    """Return an isosurface through voxels, and its normals.

    Voxels are ``longest`` times as long along z; points are off by ``noise`` times an edge.
    """
    counts = np.array([n, n, max(n // longest, 4)])
    place = random.uniform(-0.3, 0.3, 3)
    volume = pv.ImageData(dimensions=counts, spacing=4 / (counts - 1), origin=(-2, -2, -2))
    volume["f"] = function(*(np.asarray(volume.points) + place).T)
    mesh = volume.contour([0.0], scalars="f", compute_normals=False)
    exact = gradient(function, mesh.points + place)
    mesh.points += noise * 4 / n * random.standard_normal(mesh.points.shape)
    return mesh, exact


def grid(n, random, *, shear=0.0, size=4):
    """Return a warped grid of triangles or quads, sheared in its plane, and its normals."""
    x, y = np.meshgrid(np.linspace(-2, 2, n), np.linspace(-2, 2, n))
    first = np.arange(n * n).reshape(n, n)[:-1, :-1].ravel()
    quads = np.stack([first, first + 1, first + n + 1, first + n], axis=1)
    faces = quads if size == 4 else np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return _raised(np.column_stack([(x + shear * y).ravel(), y.ravel()]), faces, random)


def rounded(n, random):
    """Return a part of two planes and a rounded edge of n quads between them, and its normals."""
    angle, radius = np.linspace(0, np.pi / 2, n + 1), random.uniform(0.05, 0.2)
    along, out = np.append(0, np.sin(angle)), np.append(np.cos(angle), 0)
    x, z = np.append(-1, radius * np.sin(angle)), np.append(radius * np.cos(angle), -1)
    x, z = np.append(x, radius), np.append(radius, z)
    along, out = np.append(along, 1), np.append(1, out)
    y = np.linspace(0, 2, 8)
    places = np.stack(np.broadcast_arrays(x, y[:, np.newaxis], z), axis=-1).reshape(-1, 3)
    normal = np.stack(np.broadcast_arrays(along, 0 * y[:, np.newaxis], out), axis=-1)
    first = np.arange(len(places)).reshape(8, -1)[:-1, :-1].ravel()
    quads = np.stack([first, first + 1, first + len(x) + 1, first + len(x)], axis=1)
    return pv.PolyData.from_regular_faces(places, quads), normal.reshape(-1, 3)


def scattered(n, random):
    """Return a warped triangulation of n x n random points of the plane, and its normals."""
    places = random.uniform(-2, 2, (n * n, 2))
    return _raised(places, Delaunay(places).simplices, random)


def _raised(places, faces, random):
    """Return faces in the plane at the heights of hills, and their normals."""
    place = np.append(random.uniform(-1, 1, 2), 0)
    flat = np.column_stack([places, 0 * places[:, 0]])
    points = flat - np.outer(hills(*(flat + place).T), (0, 0, 1))
    return pv.PolyData.from_regular_faces(points, faces), gradient(hills, points + place)


def ball(n, random, *, stretch=1.0):
    """Return the hull of n x n random points of a ball, stretched along z, and its normals."""
    unit = random.standard_normal((n * n, 3))
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    hull = ConvexHull(unit)
    outward = np.einsum("ij,ij->i", hull.equations[:, :3], _across(unit[hull.simplices])) > 0
    faces = np.where(outward[:, np.newaxis], hull.simplices, hull.simplices[:, ::-1])
    return pv.PolyData.from_regular_faces(unit * (1, 1, stretch), faces), unit / (1, 1, stretch)


def _across(corners):
    """Return twice the area vectors of triangles."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


#: Surfaces by name: functions of n and a generator.
SURFACES = {
    "ellipsoid": partial(isosurface, ellipsoid),
    "gyroid": partial(isosurface, gyroid),
    "gyroid, voxels 3 times as long": partial(isosurface, gyroid, longest=3),
    "gyroid, voxels 5 times as long": partial(isosurface, gyroid, longest=5),
    "gyroid, off by 1 % of an edge": partial(isosurface, gyroid, noise=0.01),
    "grid of triangles": partial(grid, size=3),
    "grid of quads": grid,
    "grid sheared by 1": partial(grid, shear=1.0),
    "grid of triangles sheared by 2": partial(grid, shear=2.0, size=3),
    "planes with a rounded edge": rounded,
    "random points of the plane": scattered,
    "random points of a ball": ball,
    "random points of an ellipsoid": partial(ball, stretch=2.5),
}


def by_vtk(mesh):
    """Return VTK's normals, which are means over the faces around each point."""
    bare = pv.PolyData(mesh.points, mesh.faces)
    made = bare.compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False)
    return np.asarray(made.point_data["Normals"])


def normal_errors(name, n, repeats=3, seed=0):
    """Return the mean errors of normals of one surface, one row for each way."""
    mesh, exact = SURFACES[name](n, random=np.random.default_rng(seed))
    ways = {"VTK": partial(by_vtk, mesh), "by corners": partial(surface_normals, mesh)}
    seconds = take_turns(ways, repeats)
    found = []
    for way, work in ways.items():
        off = angles(work(), exact)
        more = {"99 %": float(np.percentile(off, 99))}
        cost = 1e9 * seconds[way] / mesh.n_points
        found.append(Row(f"{name}, {way}", n, float(off.mean()), cost, more))
    return found


STUDY = Study(
    approximates="normals of isosurfaces, grids and triangulations of random points",
    reference="gradients of their functions",
    parameter="nodes each way",
    error="mean error, degrees",
    cost="ns per point",
    steps=lambda quick: [
        partial(normal_errors, name, n, 3 if quick else 5)
        for name in SURFACES
        for n in (NODES[:2] if quick else NODES)
    ],
    axes=("parameter", "error"),
    curve=lambda row: Curve(*row.way.rsplit(", ", 1)),
)
