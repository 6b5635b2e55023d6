"""
A Hopf fibration, turning
=========================

Three tori of the Hopf fibration: 84 circles in 4-space, any two of which are linked once. They
turn in the xw plane, and are lit in 4-space before they are projected, by one lamp at the eye: a
circle is bright where it runs across the view and dark where it runs toward the eye, in 4-space,
although in 3-space it swells, passes through others and turns inside out. The rank correlation of
lightness with that slope is -1.00 all the way; of tubes in PyVista's light, which know nothing of
4-space, it is -0.2 to -0.4. Colours of one lightness tell the tori apart.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

# The fibre over a point of the sphere is e^(i t) (z1, z2): its tangent is i times the point.
number = np.arange(84 * 193).reshape(84, 193)
height, turn, t = number // 5404 * 0.7 - 0.7, number // 193 * np.pi / 14, number % 193 * np.pi / 96
first, second = np.sqrt((1 + height) / 2), np.sqrt((1 - height) / 2) * np.exp(-1j * turn)
pairs = np.stack([first.ravel(), second.ravel()], axis=1) * np.exp(1j * t).reshape(-1, 1)
fibres = pv.PolyData(np.zeros((number.size, 3)), lines=np.insert(number, 0, 193, axis=1))
fibres["position"], fibres["frame"] = pairs.view(float), (1j * pairs).view(float)
fibres["torus"] = height.ravel()
light, eye = (kind(direction=(0.3, -1, 0.6, 0)) for kind in (Light, View))
scene = Scene(lights=light, view=eye, material=Material(ambient=0.15, diffuse=0.85, specular=0))

panels = []
for degrees in range(0, 180, 30):
    turn = ("xw", np.radians(degrees))
    lit = vizlight.project(fibres, scene=scene, rotation=turn, distance=1.3)
    lit = vizlight.tint(lit, "torus", cmap=["#74adfe", "#f689b3", "#cba656"])
    panels.append(render.Panel(lit, "rgb", f"turned by {degrees}° in 4-space"))
camera = render.camera_on((-1.7, 1.7, -1.7, 1.7, -1.5, 1.5), (0.3, -1, 0.6), aspect=1, zoom=1.46)
look = {"rows": 2, "size": (1320, 920), "background": "#14181d", "line_diameter": 0.033}
plotter = render.make_plotter(panels, camera=camera, halo=0.5, **look)
plotter.show()
