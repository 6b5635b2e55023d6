"""
A satin ball, lit in four ways
==============================

The four panels of illustration 2 of Banks, *Illumination in Diverse Codimensions*: a sphere with a
tangent field from north to south, like a ball wound with satin thread: the highlight runs across
the threads, around the ball. The field alone lights the ball also where the lamp cannot reach;
conditioned by the normals, its dark side is as dark as that of the ball. All use the plain cosine
law of the paper (``exponent=1``).
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

ball = pv.Sphere(theta_resolution=120, phi_resolution=121, start_phi=0.5, end_phi=179.5)
normals = 2 * np.asarray(ball.points)
ball["Normals"] = normals
ball.point_data.active_normals_name = "Normals"
ball["satin"] = np.array([0, 0, 1], dtype=np.float32) - normals[:, 2:] * normals

camera = render.camera_on(ball, (0.2, -1, 0.35), aspect=1, zoom=0.9)
scene = Scene(
    lights=Light(direction=(1, -1, 0.8)),
    view=View.from_camera(camera),
    material=Material(ambient=0.15, diffuse=0.7, specular=0.9, color=(1.0, 0.3, 0.33)),
)
# Threads that start at even steps around the equator keep even steps on every circle of latitude.
turn = np.linspace(0, 2 * np.pi, 120, endpoint=False)
equator = 0.5 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
panels = vizlight.satin(ball, scene, tangents="satin", seeds=equator, exponent=1)
dark = pv.Sphere(radius=0.497, theta_resolution=120, phi_resolution=120)
dark["rgb"] = np.full((dark.n_points, 3), 0.02)
panels["curves"] = pv.MultiBlock([panels["curves"], dark])
titles = {
    "curves": "threads, each lit as a line", "surface": "the ball, lit by its normals",
    "field": "the ball, lit by its threads", "conditioned": "threads in the shadow of the ball",
}  # fmt: skip
plotter = render.make_plotter(
    [render.Panel(panels[name], "rgb", title) for name, title in titles.items()],
    camera=camera,
    rows=2,
    size=(1400, 1380),
    background="#14181d",
    line_diameter=0.007,
    halo=0.5,
)
plotter.show()
