"""Demonstration from file to picture: light an isosurface of a simulated flow by its velocity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import files
from vizlight.data import load_example
from vizlight.filters.illuminate import illuminate
from vizlight.pictures import render
from vizlight.reading.normals import sided_normals
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.verify import reference

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv

LEVEL = 600.0
EYE = (1.0, 0.5, 0.45)
TOWARD_LIGHT = (1.0, 0.9, 0.5)


@dataclass(frozen=True)
class Row:
    """Row of the table of the demonstration."""

    light: str
    points: int
    terms: str
    milliseconds: float
    error: float


def flow_surface() -> pv.PolyData:
    """Return the isosurface Temp = 600 of the rotating disk, with normals and velocity ``V``.

    Each triangle is divided into 16, because the triangles of the simulation are too coarse for
    a highlight. Normals and velocities are interpolated.
    """
    surface = files.surface_of(load_example(), "Temp", LEVEL).compute_normals(
        cell_normals=False, split_vertices=False, auto_orient_normals=True
    )
    fine: pv.PolyData = surface.triangulate().subdivide(2, "linear")
    return fine


def flow_scene(bounds: Sequence[float]) -> tuple[Scene, pv.Camera]:
    """Return the scene of the demonstration and the camera of its view.

    Parameters
    ----------
    bounds : (xmin, xmax, ymin, ymax, zmin, zmax)
        Bounds of the surface.
    """
    camera = render.camera_on(bounds, EYE, zoom=1.5)
    scene = Scene(
        lights=Light(direction=TOWARD_LIGHT),
        view=View.from_camera(camera),
    )
    return scene, camera


def light_flow() -> tuple[pv.PolyData, pv.Camera, list[Row], str]:
    """Return the lit surface, its camera, the table, and the explained plan of the flow's light."""
    surface = flow_surface()
    scene, camera = flow_scene(surface.bounds)
    points = np.asarray(surface.points)
    # The surface is open: its normals are turned to the eye.
    normals = sided_normals(surface, None, 3, "auto").facing("auto", points, scene.view)[:]
    rows = []
    for title, name, tangents in (
        ("as a surface", "surface_light", None),
        ("by the flow", "flow_light", "V"),
    ):
        surface = illuminate(
            surface, scene, tangents=tangents, conditioned=tangents is not None, name=name
        )
        vectors = None if tangents is None else np.asarray(surface[tangents])
        runs = [engine.shade(points, vectors, scene, normals=normals) for _ in range(5)]
        plan = runs[0].plan
        exact = reference.light(points, vectors, scene, normals=normals, exponent=plan.exponent)
        error = float(np.abs(surface[name] - exact).max())
        seconds = float(np.median([run.seconds for run in runs]))
        rows.append(Row(title, surface.n_points, " + ".join(plan.terms), 1e3 * seconds, error))
    return surface, camera, rows, plan.explain()


def panels(lit: pv.PolyData) -> list[render.Panel]:
    """Return the two panels of the demonstration: light of the surface, and light of the flow."""
    return [
        render.Panel(lit, "surface_light", "lit as a surface"),
        render.Panel(lit, "flow_light", "lit by the flow"),
    ]
