"""
Light that passes through a statue
==================================

A closed mesh with the light behind it. A: with the clamped cosine, everything is dark. B and C:
with ``t = d / r`` at two depths, the thin limbs glow, the body stays dark, and one limb casts a
shadow on another.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, render

ant = pv.examples.load_ant().subdivide(2, "butterfly").compute_normals(split_vertices=False)
side = ant.length
camera = render.camera_on(ant.bounds, (0.5, 1.0, 0.35), zoom=1.25)
panels = []
for title, depth in (("A", 0.0), ("B", 0.003), ("C", 0.01)):
    scene = Scene(
        lights=Light(direction=(-0.9, -0.8, 0.45)),
        material=Material(ambient=0.03, diffuse=0.97, specular=0.0, color=(1.0, 0.62, 0.35)),
    )
    lit = vizlight.relief_shadow(ant, scene, depth=depth * side, lit=True)
    lit["rgb"] = np.sqrt(np.clip(lit["rgb"], 0, 1))
    panels.append(render.Panel(lit, "rgb", title))

plotter = render.make_plotter(panels, camera=camera, size=(1800, 600), background="#101418")
plotter.show()
