"""
Turning in 4-space
==================

A torus in 4-space rotates in the xw plane, while light, eye and camera stay fixed. In the upper
row it is lit in 4-space, before the projection: the light moves over it as over a rigid body,
although its projection to 3-space swells, passes through itself and turns inside out. In the lower
row the projected surface is lit in 3-space, after the projection.

``vizlight.movie.turn(mesh, "turn.gif", scene=scene, distance=3.0)`` writes the whole turn.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.geometry import manifolds

torus = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=(192, 128)))
material = Material(ambient=0.08, diffuse=0.65, specular=0.27, shininess=25)
camera = render.camera_on((-3, 3, -2, 2, -1, 1), (0.3, -1, 0.8), zoom=1.6)
in_3 = Scene(
    lights=Light(direction=(0.2, -0.8, 0.9)), view=View.from_camera(camera), material=material
)
in_4 = Scene(
    lights=Light(direction=(0.2, -0.8, 0.9, 0.3)),
    view=View(direction=(0.3, -1, 0.8, 0)),
    material=material,
)

angles = np.radians([0, 30, 60, 90, 120])
panels = [
    render.Panel(
        vizlight.project(torus, rotation=("xw", a), distance=3.0, scene=scene, light=light),
        title=f"{light}, {np.degrees(a):.0f} degrees",
    )
    for light, scene in (("before", in_4), ("after", in_3))
    for a in angles
]

plotter = render.make_plotter(panels, camera=camera, rows=2, size=(2000, 760), background="#203048")
plotter.show()
