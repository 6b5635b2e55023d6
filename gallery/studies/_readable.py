"""Data to read back, none of which a light was chosen on: surfaces with fields, and lines."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv
from pyvista import examples

import vizlight
from vizlight.model.kernels import unit_rows

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array

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


def _surface(mesh: pv.DataSet, field: Callable[[Array, Array], Array], values: Array) -> Readable:
    """Return a surface with a field that is projected to it; a field along normals is zero."""
    surface = mesh.extract_surface(algorithm="dataset_surface")
    made = surface.compute_normals(
        cell_normals=False, split_vertices=False, auto_orient_normals=False
    )
    normals = np.asarray(made["Normals"], np.float64)
    along = field(np.asarray(made.points, np.float64), normals)
    across = along - np.einsum("ij,ij->i", along, normals)[:, np.newaxis] * normals
    made["field"], made["value"] = unit_rows(across), values
    return Readable(made, "field", "value")


def dog() -> Readable:
    """Return a scan of a dog with level lines of its height."""
    mesh = vizlight.load_example("dog.vtp")
    points = np.asarray(mesh.points, np.float64)
    return _surface(mesh, lambda _, n: np.cross(n, [0, 0, 1.0]), points[:, 2])


def earth() -> Readable:
    """Return the relief of the earth, 60 times as high, on a globe, with the way downhill."""
    heights = np.asarray(vizlight.load_example("earth_relief.vti")["elevation"], np.float64)
    heights = heights.reshape(540, 1080)[::3, ::3]
    latitude = np.radians(np.linspace(-89.83, 89.83, 180))[:, np.newaxis]
    longitude = np.radians(np.linspace(-179.8, 179.8, 360))
    radius = 1 + 60 * heights / 6.371e6
    parts = np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)
    x, y, z = (radius * part for part in (*parts, np.sin(latitude) + 0 * longitude))
    grid = pv.StructuredGrid(x[..., np.newaxis], y[..., np.newaxis], z[..., np.newaxis])
    mesh = grid.extract_surface(algorithm="dataset_surface").triangulate()
    return _surface(mesh, lambda p, n: n - unit_rows(p), _order(mesh, x, y, z, heights))


def _order(mesh: pv.PolyData, x: Array, y: Array, z: Array, values: Array) -> Array:
    """Return values of a grid at the points of its surface."""
    from scipy.spatial import cKDTree

    own = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    return np.asarray(values.ravel()[cKDTree(own).query(np.asarray(mesh.points))[1]])


def airplane() -> Readable:
    """Return an airplane with the direction of flight along its hull."""
    mesh = examples.load_airplane()
    points = np.asarray(mesh.points, np.float64)
    return _surface(mesh, lambda p, _: np.tile([0, 1.0, 0], (len(p), 1)), points[:, 0])


def nut() -> Readable:
    """Return a nut with the way around its axis."""
    mesh = examples.load_nut().subdivide(2)
    points = np.asarray(mesh.points, np.float64)
    middle = points.mean(axis=0)
    return _surface(
        mesh,
        lambda p, _: np.cross([0, 1.0, 0], p - middle),
        np.linalg.norm((points - middle)[:, [0, 2]], axis=1),
    )


def gyroid(n: int = 70) -> Readable:
    """Return a gyroid with the Arnold-Beltrami-Childress flow along it, coloured by its speed."""
    grid = _grid(n, 1.5)
    x, y, z = 2 * np.pi * np.asarray(grid.points, np.float64).T
    grid["f"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    mesh = grid.contour([0.0], scalars="f")
    flow = _flow(np.asarray(mesh.points, np.float64))
    return _surface(mesh, lambda p, _: _flow(p), np.linalg.norm(flow, axis=1))


def _grid(n: int, size: float) -> pv.ImageData:
    return pv.ImageData(dimensions=(n, n, n), spacing=(size / (n - 1),) * 3)


def _flow(points: Array) -> Array:
    """Return the Arnold-Beltrami-Childress flow of period 1, A = 1, B = 0.8, C = 0.6."""
    x, y, z = 2 * np.pi * points.T
    return np.stack(
        [
            np.sin(z) + 0.6 * np.cos(y),
            0.8 * np.sin(x) + np.cos(z),
            0.6 * np.sin(y) + 0.8 * np.cos(x),
        ],
        axis=1,
    )


def helens() -> Readable:
    """Return Mount St. Helens, from PyVista's data, with the way downhill."""
    grid = pv.read(Path(os.environ["PYVISTA_DATA"]) / "Data" / "SainteHelens.dem")
    mesh = grid.warp_by_scalar("Elevation").extract_surface(algorithm="dataset_surface")
    mesh = mesh.triangulate()
    return _surface(
        mesh, lambda _, n: np.cross(n, np.cross([0, 0, 1.0], n)), np.asarray(mesh["Elevation"])
    )


def childress() -> Readable:
    """Return lines of the Arnold-Beltrami-Childress flow, in steps of fourth order."""
    return Readable(_traced(_flow, np.random.default_rng(0).uniform(0, 1, (150, 3)), 0.01, 120))


def lorenz() -> Readable:
    """Return paths of Lorenz' system from near its attractor."""

    def system(points: Array) -> Array:
        x, y, z = points.T
        return np.stack([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z], axis=1)

    starts = np.random.default_rng(1).uniform(-8, 8, (60, 3)) + np.array([0, 0, 25])
    return Readable(_traced(system, starts, 0.01, 250))


def _traced(flow: Callable[[Array], Array], starts: Array, step: float, count: int) -> pv.PolyData:
    places = [starts]
    for _ in range(count):
        p = places[-1]
        a = flow(p)
        b = flow(p + step / 2 * a)
        c = flow(p + step / 2 * b)
        d = flow(p + step * c)
        places.append(p + step / 6 * (a + 2 * b + 2 * c + d))
    points = np.stack(places, axis=1)
    lines, size = points.shape[:2]
    cells = np.insert(np.arange(lines * size).reshape(lines, size), 0, size, axis=1)
    return pv.PolyData(points.reshape(-1, 3), lines=cells.ravel())


def hair() -> Readable:
    """Return hair of a ball that is combed to one side."""
    random = np.random.default_rng(2)
    roots = unit_rows(random.normal(size=(1500, 3)))
    t = np.linspace(0, 1, 12)[:, np.newaxis]
    combed = 0.35 * np.cross([0.3, 0.2, 1.0], roots)[:, np.newaxis] * t**2
    points = roots[:, np.newaxis] * (1 + 0.4 * t) + combed
    cells = np.insert(np.arange(12 * len(roots)).reshape(-1, 12), 0, 12, axis=1)
    return Readable(pv.PolyData(points.reshape(-1, 3), lines=cells.ravel()))


SURFACES = {f.__name__: f for f in (dog, earth, airplane, nut, gyroid, helens)}
LINES = {f.__name__: f for f in (childress, lorenz, hair)}


def known() -> dict[str, Callable[[], Readable]]:
    """Return the data sets that there are: Mount St. Helens needs a folder of PyVista's data."""
    folder = os.environ.get("PYVISTA_DATA")
    there = folder is not None and (Path(folder) / "Data" / "SainteHelens.dem").exists()
    return {name: make for name, make in {**SURFACES, **LINES}.items() if name != "helens" or there}
