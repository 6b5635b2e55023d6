"""
Which end of a line is near?
============================

The fibres of the example of slope, and three coloured lamps close around the eye
(``vizlight.presets.heading``). Lightness tells how steeply a fibre runs toward you, and hue where
its near end points on the screen: follow a fibre, and its hue on the disc says which of the two
ways comes toward you. In white light it is a coin's toss which end is near. The figures below are
read from the picture at the width of a column in print.
"""

import pyvista as pv

import vizlight
from vizlight import Material, presets, render

fibres = vizlight.load_example("fibre_bundle.vtp")

scene = presets.heading().replace(material=Material(ambient=0.16, diffuse=0.84, specular=0))
plotter = pv.Plotter(off_screen=True, window_size=(1400, 800))
plotter.set_background("#14181d")
plotter.vizlight.add_mesh(fibres, scene=scene, line_diameter=0.21, halo=0.3)
plotter.vizlight.add_key(scene, question="heading", size=0.32)
text = {"position": (0.46, 0.5), "font_size": 15, "color": "white", "viewport": True}
plotter.add_text("dark: steep\nhue: near end", **text)
plotter.camera = render.camera_on(fibres, (1, -0.5, 0.3), aspect=1.36, zoom=1.02)
plotter.enable_anti_aliasing("ssaa")
plotter.show(auto_close=False)

# %%
# What can be read in this light, and in white light from the eye:

for light in (scene, presets.slope()):
    print(vizlight.legibility(fibres, light, view=plotter.camera, line_diameter=0.21))
