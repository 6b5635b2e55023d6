"""Normals of surfaces without any: VTK's means over faces, and means by the corners of faces.

The surfaces are those of functions, whose gradients are the exact normals: isosurfaces of an
ellipsoid and of a gyroid through volumes of n nodes each way, and a warped grid of n by n nodes.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pyvista as pv

from studies import Row, Study, take_turns
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


def surface(function, n):
    """Return the surface on which a function is 0."""
    if function is hills:
        x, y = np.meshgrid(np.linspace(-2, 2, n), np.linspace(-2, 2, n))
        field = pv.StructuredGrid(x, y, -hills(x, y, 0 * x))
        return field.extract_surface(algorithm="dataset_surface")
    volume = pv.ImageData(dimensions=(n, n, n), spacing=3 * (4 / (n - 1),), origin=(-2, -2, -2))
    volume["f"] = function(*np.asarray(volume.points).T)
    return volume.contour([0.0], scalars="f", compute_normals=False)


def gradient(function, points, step=1e-5):
    """Return the gradients of a function by central differences."""
    places = np.asarray(points, dtype=float)
    ends = ([places + side * step * axis for side in (1, -1)] for axis in np.eye(3))
    return np.stack([function(*ahead.T) - function(*behind.T) for ahead, behind in ends], axis=1)


def angles(found, exact):
    """Return the angles in degrees between vectors, whatever their sides."""
    across = np.linalg.norm(np.cross(found, exact), axis=1)
    return np.asarray(np.degrees(np.arctan2(across, np.abs(np.einsum("ij,ij->i", found, exact)))))


def by_vtk(mesh):
    """Return VTK's normals, which are means over the faces around each point."""
    bare = pv.PolyData(mesh.points, mesh.faces)
    made = bare.compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False)
    return np.asarray(made.point_data["Normals"])


def normal_errors(function, n, repeats=3):
    """Return the mean errors of normals of one surface, one row for each way."""
    mesh = surface(function, n)
    exact = gradient(function, mesh.points)
    ways = {"VTK": partial(by_vtk, mesh), "by corners": partial(surface_normals, mesh)}
    seconds = take_turns(ways, repeats)
    found = []
    for way, work in ways.items():
        off = angles(work(), exact)
        more = {"99 %": float(np.percentile(off, 99))}
        cost = 1e9 * seconds[way] / mesh.n_points
        found.append(Row(f"{function.__name__}, {way}", n, float(off.mean()), cost, more))
    return found


STUDY = Study(
    approximates="normals of isosurfaces and of a warped grid",
    reference="gradients of their functions",
    parameter="nodes each way",
    error="mean error, degrees",
    cost="ns per point",
    steps=lambda quick: [
        partial(normal_errors, function, n, 3 if quick else 5)
        for function in (ellipsoid, gyroid, hills)
        for n in (NODES[:2] if quick else NODES)
    ],
    axes=("parameter", "error"),
)
