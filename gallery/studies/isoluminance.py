"""Contours of equal luminance on a ball, beside VTK's contours of the light of the same mesh.

The contours of a matte ball under a far light are circles of latitude about the direction of the
light. The error is the largest angle between a point of a contour and its circle. The filter lights
the smooth normals of the triangles, or the solid itself; VTK's contour filter interpolates light
that was computed at the points.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pyvista as pv

import vizlight
from studies import Row, Study, take_turns
from vizlight import Light, Material, Scene

#: Luminances of the contours, none of them at the border of the shadow.
LEVELS = tuple(np.arange(1, 16) / 16)
TOWARD = np.array([0.6, -0.48, 0.64])
SCENE = Scene(
    lights=Light(direction=TOWARD), material=Material(ambient=0.0, diffuse=1.0, specular=0.0)
)


def ball(side):
    """Return a unit ball of triangles with exact normals."""
    mesh = pv.Sphere(radius=1.0, theta_resolution=side, phi_resolution=side)
    mesh.point_data["Normals"] = np.asarray(mesh.points)
    return mesh


def off(contours):
    """Return the largest angle in degrees between points of contours and the nearest circle."""
    points = np.asarray(contours.points, np.float64)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    away = np.arctan2(np.linalg.norm(np.cross(points, TOWARD), axis=1), points @ TOWARD)
    # The filter draws the border of the shadow too.
    circles = np.arccos([0.0, *LEVELS])
    nearest = np.abs(away[:, np.newaxis] - circles).min(axis=1)
    return float(np.degrees(nearest.max()))


def ours(mesh):
    """Return the contours of the filter."""
    return vizlight.isoluminance(mesh, SCENE, levels=LEVELS)["contours"]


def theirs(mesh):
    """Return VTK's contours of the light at the points."""
    return vizlight.illuminate(mesh, SCENE).contour(list(LEVELS), scalars="luminance")


def measure(side, repeats):
    """Return the rows of one mesh."""
    ways = {"isoluminance(mesh)": ours, "contours of the light, VTK": theirs}
    return _rows({way: partial(find, ball(side)) for way, find in ways.items()}, side, repeats)


def of_solid(repeats):
    """Return the row of the solid, whose contours are circles."""
    return _rows({"isoluminance(Sphere)": partial(ours, vizlight.Sphere(radius=1.0))}, "", repeats)


def _rows(ways, side, repeats):
    seconds = take_turns(ways, repeats)
    return [Row(way, side, off(work()), 1e3 * seconds[way]) for way, work in ways.items()]


STUDY = Study(
    approximates="contours of equal luminance of a ball",
    reference="circles of latitude about the light",
    parameter="points along a meridian",
    error="largest error in degrees",
    cost="processor time, ms",
    steps=lambda quick: [
        *(partial(measure, 2**i, 3) for i in range(4, 8 if quick else 10)),
        partial(of_solid, 3),
    ],
)
