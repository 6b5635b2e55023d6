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

from tempfile import mkdtemp

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
scene = Scene(lights=light, view=eye, material=Material(ambient=0.1, diffuse=0.9, specular=0))

plotter = pv.Plotter(off_screen=True, window_size=(440, 390))
plotter.background_color = "#14181d"
plotter.camera = render.camera_on((-1.7, 1.7, -1.7, 1.7, -1.5, 1.5), (0.3, -1, 0.6), zoom=1.55)
plotter.enable_anti_aliasing("ssaa")
plotter.vizlight.add_key(scene, question="slope", size=0.2)
plotter.open_gif(mkdtemp() + "/turning.gif", fps=7)
for angle in np.linspace(0, np.pi, 18, endpoint=False):
    lit = vizlight.project(fibres, scene=scene, rotation=("xw", angle), distance=1.3)
    lit = vizlight.tint(lit, "torus", cmap=["#74adfe", "#f689b3", "#cba656"])
    plotter.vizlight.add_mesh(lit, line_diameter=0.033, name="fibres", show_scalar_bar=False)
    plotter.write_frame()
plotter.show()
