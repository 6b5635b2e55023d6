"""Data to read back, none of which a light was chosen on: surfaces with fields, and lines."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv
from pyvista import examples

import vizlight
from vizlight.model.kernels import unit_rows

#: Directions toward the eye, from all sides.
VIEWS = (
    (1.0, 0.5, 0.4), (-0.7, 1.0, 0.6), (-0.4, -1.0, 0.3), (0.5, -0.6, 1.0),
    (0.2, 1.0, -0.4), (-1.0, -0.1, 0.1), (0.9, -0.8, -0.3), (-0.3, 0.2, 1.0),
)  # fmt: skip


class Readable(NamedTuple):
    """A mesh with what is asked for; lines have tangents of their own and no values."""

    mesh: pv.PolyData
    tangents: str | None = None
    scalars: str | None = None


def _surface(mesh, field, value):
    """Return a surface with a field that is projected to it; a field along normals is zero.

    The field is a function of points and normals, the value an array or a function of points.
    """
    surface = mesh.extract_surface(algorithm="dataset_surface")
    made = surface.compute_normals(
        cell_normals=False, split_vertices=False, auto_orient_normals=False
    )
    points, normals = (np.asarray(a, np.float64) for a in (made.points, made["Normals"]))
    along = field(points, normals)
    across = along - np.einsum("ij,ij->i", along, normals)[:, np.newaxis] * normals
    made["field"] = unit_rows(across)
    made["value"] = made[value] if isinstance(value, str) else value(points)
    return Readable(made, "field", "value")


def _lines(points):
    """Return polylines of rows of points."""
    count, size = points.shape[:2]
    cells = np.insert(np.arange(count * size).reshape(count, size), 0, size, axis=1)
    return Readable(pv.PolyData(points.reshape(-1, 3), lines=cells.ravel()))


def dog():
    """Return a scan of a dog with level lines of its height."""
    mesh = vizlight.load_example("dog.vtp")
    return _surface(mesh, lambda _, n: np.cross(n, [0, 0, 1.0]), lambda p: p[:, 2])


def earth():
    """Return the relief of the earth, 60 times as high, on a globe, with the way downhill."""
    heights = np.asarray(vizlight.load_example("earth_relief.vti")["elevation"], np.float64)
    heights = heights.reshape(540, 1080)[::3, ::3]
    latitude = np.radians(np.linspace(-89.83, 89.83, 180))[:, np.newaxis]
    longitude = np.radians(np.linspace(-179.8, 179.8, 360))
    radius = 1 + 60 * heights / 6.371e6
    parts = np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)
    axes = (radius * part for part in (*parts, np.sin(latitude) + 0 * longitude))
    grid = pv.StructuredGrid(*(axis[..., np.newaxis] for axis in axes))
    grid["height"] = heights.ravel(order="F")
    mesh = grid.extract_surface(algorithm="dataset_surface").triangulate()
    return _surface(mesh, lambda p, n: n - unit_rows(p), "height")


def airplane():
    """Return an airplane with the direction of flight along its hull."""
    mesh = examples.load_airplane()
    return _surface(mesh, lambda p, _: np.tile([0, 1.0, 0], (len(p), 1)), lambda p: p[:, 0])


def nut():
    """Return a nut with the way around its axis."""
    mesh = examples.load_nut().subdivide(2)
    middle = np.asarray(mesh.points, np.float64).mean(axis=0)
    return _surface(
        mesh,
        lambda p, _: np.cross([0, 1.0, 0], p - middle),
        lambda p: np.linalg.norm((p - middle)[:, [0, 2]], axis=1),
    )


def gyroid(n=70):
    """Return a gyroid with the Arnold-Beltrami-Childress flow along it, coloured by its speed."""
    grid = pv.ImageData(dimensions=(n, n, n), spacing=(1.5 / (n - 1),) * 3)
    x, y, z = 2 * np.pi * np.asarray(grid.points, np.float64).T
    grid["f"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    mesh = grid.contour([0.0], scalars="f")
    return _surface(mesh, lambda p, _: _flow(p), lambda p: np.linalg.norm(_flow(p), axis=1))


def _flow(points):
    """Return the Arnold-Beltrami-Childress flow of period 1, A = 1, B = 0.8, C = 0.6."""
    x, y, z = 2 * np.pi * points.T
    u, v = np.sin(z) + 0.6 * np.cos(y), 0.8 * np.sin(x) + np.cos(z)
    return np.stack([u, v, 0.6 * np.sin(y) + 0.8 * np.cos(x)], axis=1)


def helens():
    """Return Mount St. Helens, from PyVista's data, with the way downhill."""
    grid = pv.read(Path(os.environ["PYVISTA_DATA"]) / "Data" / "SainteHelens.dem")
    mesh = grid.warp_by_scalar("Elevation").extract_surface(algorithm="dataset_surface")
    downhill = [0, 0, 1.0]
    return _surface(
        mesh.triangulate(), lambda _, n: np.cross(n, np.cross(downhill, n)), "Elevation"
    )


def childress():
    """Return lines of the Arnold-Beltrami-Childress flow, in steps of fourth order."""
    return _traced(_flow, np.random.default_rng(0).uniform(0, 1, (150, 3)), 0.01, 120)


def lorenz():
    """Return paths of Lorenz' system from near its attractor."""

    def system(points):
        x, y, z = points.T
        return np.stack([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z], axis=1)

    starts = np.random.default_rng(1).uniform(-8, 8, (60, 3)) + np.array([0, 0, 25])
    return _traced(system, starts, 0.01, 250)


def _traced(flow, starts, step, count):
    places = [starts]
    for _ in range(count):
        p = places[-1]
        a = flow(p)
        b = flow(p + step / 2 * a)
        c = flow(p + step / 2 * b)
        d = flow(p + step * c)
        places.append(p + step / 6 * (a + 2 * b + 2 * c + d))
    return _lines(np.stack(places, axis=1))


def hair():
    """Return hair of a ball that is combed to one side."""
    random = np.random.default_rng(2)
    roots = unit_rows(random.normal(size=(1500, 3)))
    t = np.linspace(0, 1, 12)[:, np.newaxis]
    combed = 0.35 * np.cross([0.3, 0.2, 1.0], roots)[:, np.newaxis] * t**2
    return _lines(roots[:, np.newaxis] * (1 + 0.4 * t) + combed)


SURFACES = {f.__name__: f for f in (dog, earth, airplane, nut, gyroid, helens)}
LINES = {f.__name__: f for f in (childress, lorenz, hair)}


def known():
    """Return the data sets that there are: Mount St. Helens needs a folder of PyVista's data."""
    folder = Path(os.environ.get("PYVISTA_DATA", "none"))
    there = (folder / "Data" / "SainteHelens.dem").exists()
    return {name: make for name, make in {**SURFACES, **LINES}.items() if name != "helens" or there}
