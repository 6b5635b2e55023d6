"""Normals of surfaces without any: by the corners of faces, and by the usual weights of these.

The surfaces are those of functions, whose gradients are the exact normals: isosurfaces through
volumes of n nodes along the axis that has most, warped grids of n by n nodes, even, uneven and
sheared, triangulations of random points, borders and creases of these, and places with noise. The
usual weights are VTK's means over faces, equal ones, and those by area, by angle and by Max.
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


def lattice(rows, columns, *, size=4, around=False):
    """Return the faces between rows of points: quads, or triangles; ``around`` joins their ends."""
    first = np.arange(rows * columns).reshape(rows, columns)
    ahead = np.roll(first, -1, axis=1)
    corners = np.stack([first[:-1], ahead[:-1], ahead[1:], first[1:]], axis=-1)
    quads = (corners if around else corners[:, :-1]).reshape(-1, 4)
    return quads if size == 4 else np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def grid(n, random, *, shear=0.0, size=4, steep=1.0, rows=1):
    """Return a warped grid of triangles or quads, sheared in its plane, and its normals.

    It has ``rows`` as many times as long cells, and is ``steep`` times as high.
    """
    x, y = np.meshgrid(np.linspace(-2, 2, max(n // rows, 4)), np.linspace(-2, 2, n))
    places = np.column_stack([(x + shear * y).ravel(), y.ravel()])
    return _raised(places, lattice(*x.shape, size=size), random, steep)


def obtuse(n, random):
    """Return a warped grid of obtuse triangles, and its normals."""
    x, y = np.meshgrid(np.linspace(-2, 2, n), np.linspace(-0.7, 0.7, 2 * n))
    x[1::2] += 2 / (n - 1)
    places = np.column_stack([x.ravel(), y.ravel()])
    return _raised(places, lattice(*x.shape, size=3), random)


def meridians(n, random):
    """Return a long ellipsoid between even circles and meridians, and its normals."""
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False) + random.uniform()
    turn, down = np.meshgrid(turn, np.pi * np.linspace(0.01, 0.99, n))
    places = [np.sin(down) * np.cos(turn), np.sin(down) * np.sin(turn), np.cos(down)]
    places = np.stack(places, axis=-1).reshape(-1, 3)
    faces = lattice(n, n, size=3, around=True)
    return pv.PolyData.from_regular_faces(places * (1, 1, 8), faces), places / (1, 1, 8)


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


def uneven_ball(n, random):
    """Return a ball between circles and meridians at uneven steps, and its normals."""
    steps = np.exp(0.6 * random.standard_normal((2, n)))
    turn, down = (np.cumsum(step) / step.sum() for step in steps)
    turn, down = np.meshgrid(2 * np.pi * turn, np.pi * (0.02 + 0.96 * down))
    places = [np.sin(down) * np.cos(turn), np.sin(down) * np.sin(turn), np.cos(down)]
    places = np.stack(places, axis=-1).reshape(-1, 3)
    return pv.PolyData.from_regular_faces(places, lattice(n, n, around=True)), places.copy()


def ridge(n, random):
    """Return two bent slopes that meet at a sharp ridge, whose normals are between theirs."""
    x, y = np.meshgrid(np.linspace(-1, 1, 2 * (n // 2) + 1), np.linspace(0, 2, n))
    faces, x, y = lattice(*x.shape, size=3), x.ravel(), y.ravel()
    slope, place = random.uniform(0.6, 1.0), random.uniform(0, 3)
    z = 0.1 * x * x - slope * np.abs(x) + 0.1 * np.sin(3 * y + place)
    tilt = slope * np.sign(x) - 0.2 * x
    exact = np.column_stack([tilt, -0.3 * np.cos(3 * y + place), np.ones_like(x)])
    return pv.PolyData.from_regular_faces(np.column_stack([x, y, z]), faces), exact


def border(surface, n, random):
    """Return a surface, and its normals at the border, NaN elsewhere."""
    mesh, exact = surface(n, random)
    faces = mesh.regular_faces
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    inner = np.setdiff1d(np.arange(mesh.n_points), edges[count == 1])
    exact[inner] = np.nan
    return mesh, exact


def noisy(surface, share, n, random):
    """Return a surface with points off by a share of an edge, and the normals without noise."""
    mesh, exact = surface(n, random)
    ends = np.asarray(mesh.points)[mesh.regular_faces[:, :2]]
    size = share * np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    mesh.points += size * random.standard_normal(mesh.points.shape)
    return mesh, exact


def scattered(n, random):
    """Return a warped triangulation of n x n random points of the plane, and its normals."""
    places = random.uniform(-2, 2, (n * n, 2))
    return _raised(places, Delaunay(places).simplices, random)


def _raised(places, faces, random, steep=1.0):
    """Return faces in the plane at the heights of hills, and their normals."""
    place = np.append(random.uniform(-1, 1, 2), 0)
    flat = np.column_stack([places, 0 * places[:, 0]])
    points = flat - np.outer(hills(*(flat + place).T), (0, 0, 1))
    exact = gradient(hills, points + place) * (steep, steep, 1)
    return pv.PolyData.from_regular_faces(points * (1, 1, steep), faces), exact


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
    "ellipsoid, voxels 3 times as long": partial(isosurface, ellipsoid, longest=3),
    "border of a gyroid": partial(border, partial(isosurface, gyroid)),
    "gyroid, off by 1 % of a voxel": partial(isosurface, gyroid, noise=0.01),
    "gyroid, off by 5 % of an edge": partial(noisy, partial(isosurface, gyroid), 0.05),
    "grid of triangles": partial(grid, size=3),
    "grid of quads": grid,
    "steep grid of quads": partial(grid, steep=5.0),
    "grid of quads sheared by 1": partial(grid, shear=1.0),
    "grid of quads sheared by 3": partial(grid, shear=3.0),
    "grid of triangles sheared by 2": partial(grid, shear=2.0, size=3),
    "border of a grid sheared by 2": partial(border, partial(grid, shear=2.0, size=3)),
    "steep grid of quads sheared by 2": partial(grid, shear=2.0, steep=3.0),
    "grid of obtuse triangles": obtuse,
    "grid of long triangles": partial(grid, size=3, rows=4),
    "grid of triangles, off by 5 % of an edge": partial(noisy, partial(grid, size=3), 0.05),
    "two slopes with a ridge": ridge,
    "planes with a rounded edge": rounded,
    "random points of the plane": scattered,
    "border of random points": partial(border, scattered),
    "random points, off by 5 % of an edge": partial(noisy, scattered, 0.05),
    "ball of uneven steps": uneven_ball,
    "ellipsoid 8 times as long, between meridians": meridians,
    "random points of a ball": ball,
    "random points of an ellipsoid": partial(ball, stretch=2.5),
    "random points of a long ellipsoid": partial(ball, stretch=20.0),
}


def by_vtk(mesh):
    """Return VTK's normals, which are means over the faces around each point."""
    bare = pv.PolyData(mesh.points, mesh.faces)
    made = bare.compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False)
    return np.asarray(made.point_data["Normals"])


def by_weights(mesh):
    """Return normals by the corners of faces: with equal weights, by area, angle, and Max's."""
    corners = mesh.regular_faces
    at = np.asarray(mesh.points, np.float64)[corners]
    ahead, behind = (np.roll(at, way, axis=1) - at for way in (-1, 1))
    across = np.cross(ahead, behind)
    size, *sides = (np.linalg.norm(v, axis=2) for v in (across, ahead, behind))
    found = []
    with np.errstate(all="ignore"):
        angle = np.arctan2(size, np.einsum("ijk,ijk->ij", ahead, behind))
        for weight in (size**0, size, angle, size / np.prod(sides, axis=0) ** 2):
            total = np.zeros((mesh.n_points, 3))
            parts = across * (weight / size)[..., np.newaxis]
            np.add.at(total, corners, np.nan_to_num(parts, posinf=0, neginf=0))
            found.append(total)
    return found


def mean_angle(found, exact):
    """Return the mean angle in degrees between vectors, of those that are known."""
    return float(np.nanmean(angles(found, exact)))


def normal_errors(name, n, repeats=3, seed=0):
    """Return the mean errors of normals of one surface, one row for each way."""
    mesh, exact = SURFACES[name](n, random=np.random.default_rng(seed))
    ways = {"VTK": partial(by_vtk, mesh), "by corners": partial(surface_normals, mesh)}
    seconds = take_turns(ways, repeats)
    found = []
    for way, work in ways.items():
        off = angles(work(), exact)
        more = {"99 %": float(np.nanpercentile(off, 99))}
        cost = 1e9 * seconds[way] / mesh.n_points
        found.append(Row(f"{name}, {way}", n, float(np.nanmean(off)), cost, more))
    # The weights are code of the study, whose time says nothing.
    off = min((angles(vectors, exact) for vectors in by_weights(mesh)), key=np.nanmean)
    more = {"99 %": float(np.nanpercentile(off, 99))}
    found.append(Row(f"{name}, best weights", n, float(np.nanmean(off)), np.nan, more))
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
    joined=False,
    curve=lambda row: Curve(row.way.rsplit(", ", 1)[1]),
)
