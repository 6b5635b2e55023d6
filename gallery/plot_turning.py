"""
Turning in 4-space
==================

A torus in 4-space rotates in the xw plane, while light, eye and camera stay fixed. In the upper
row it is lit in 4-space, before the projection: the light moves over it as over a rigid body,
although its projection to 3-space swells, passes through itself and turns inside out. In the lower
row the projected surface is lit in 3-space, after the projection. The paint is the fourth
coordinate before the turn.

``vizlight.movie.turn(mesh, "turn.gif", scene=scene, distance=3.0)`` writes the whole turn.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.geometry import manifolds

torus = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=(192, 128)))
material = Material(ambient=0.08, diffuse=0.8, specular=0.27, shininess=25)
camera = render.camera_on((-3, 3, -2, 2, -1, 1), (0.3, -1, 0.8), zoom=1.6)
in_3 = Scene(
    lights=Light(direction=(0.2, -0.8, 0.9)), view=View.from_camera(camera), material=material
)
in_4 = Scene(
    lights=Light(direction=(0.2, -0.8, 0.9, 0.3)),
    view=View(direction=(0.3, -1, 0.8, 0)),
    material=material,
)

fourth = np.asarray(torus["position"])[:, 3].copy()
panels = []
for light, scene in (("before", in_4), ("after", in_3)):
    for angle in (0, 30, 60, 90, 120):
        turned = vizlight.project(
            torus, rotation=("xw", np.radians(angle)), distance=3.0, scene=scene, light=light
        )
        painted = vizlight.tint(turned, fourth, cmap="RdYlBu_r")
        panels.append(render.Panel(painted, "rgb", f"{light}, {angle} degrees"))

plotter = render.make_plotter(panels, camera=camera, rows=2, size=(2000, 760), background="#203048")
plotter.show()
