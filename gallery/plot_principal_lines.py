"""
A field on a surface
====================

A piece of the gyroid, a minimal surface, and its lines of principal curvature. Left: the surface,
lit by its normals. Right: evenly spaced lines along the direction in which it bends most, lit by
that direction and shadowed by the surface. Highlights run across the lines, as the strokes of an
engraving do. A principal direction has no sign, so there are points around which it makes half a
turn: ``line_field=True`` lets lines pass around them.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

count, reach = 64, 1.15 * np.pi
grid = pv.ImageData(dimensions=[count] * 3, spacing=[2 * reach / (count - 1)] * 3)
grid.origin = (-reach, -reach, -reach)


def gyroid(points):
    """Return sin x cos y + sin y cos z + sin z cos x, its gradient and its second derivatives."""
    s, c = np.sin(points), np.cos(points)
    value = np.sum(s * np.roll(c, -1, axis=1), axis=1)
    gradient = c * np.roll(c, -1, axis=1) - s * np.roll(s, 1, axis=1)
    second = np.zeros((len(points), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        second[:, i, i] = -s[:, i] * c[:, j] - s[:, k] * c[:, i]
        second[:, i, j] = second[:, j, i] = -c[:, i] * s[:, j]
    return value, gradient, second


grid["gyroid"] = gyroid(np.asarray(grid.points))[0]
ball = pv.Sphere(radius=3.4, theta_resolution=80, phi_resolution=80)
surface = grid.contour([0], scalars="gyroid").clip_surface(ball).triangulate()
_, gradient, second = gyroid(np.asarray(surface.points, dtype=float))
normals = gradient / np.linalg.norm(gradient, axis=1, keepdims=True)
across = np.eye(3) - normals[:, :, np.newaxis] * normals[:, np.newaxis]
surface["Normals"] = normals
surface.point_data.active_normals_name = "Normals"
surface["bend"] = np.linalg.eigh(across @ second @ across)[1][:, :, 2]

# %%
# The lines are ribbons of a width in the unit of the mesh, so nearer ones are wider.

camera = render.camera_on(surface, (1, -0.75, 0.55), aspect=0.97, zoom=0.96)
scene = Scene(
    lights=[Light(direction=(0.1, -0.75, 1)), Light(direction=(1, 0.2, 0.3), intensity=0.5)],
    view=View.from_camera(camera),
    material=Material(
        ambient=0.35, diffuse=0.65, specular=0.5, shininess=30, color=(0.95, 0.72, 0.38)
    ),
)
before = vizlight.illuminate(surface, scene)
lines = vizlight.streamlines(
    surface, scene, tangents="bend", line_field=True, spacing=0.11, facing="eye"
)
# Their square ends stay on the surface.
lines = lines.clip_surface(ball.scale(0.985))
blue = Material(ambient=0.45, diffuse=0.55, specular=0, color=(0.16, 0.26, 0.52))
after = pv.MultiBlock([vizlight.illuminate(surface, scene.replace(material=blue)), lines])

panels = [
    render.Panel(before, "rgb", "the surface, lit by its normals"),
    render.Panel(after, "rgb", "its lines of curvature, lit by direction"),
]
look = {"size": (1700, 880), "background": "#14181d", "line_diameter": 0.036, "halo": "#1c2f60"}
plotter = render.make_plotter(panels, camera=camera, **look)
plotter.show()
