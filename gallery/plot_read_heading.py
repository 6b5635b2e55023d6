"""
Which end of a line is near?
============================

The fibres of the example of slope, now with three
coloured lamps close around the eye (``vizlight.presets.heading``). Lightness tells how steeply
a fibre runs toward you, and hue where its near end points on the screen: follow a fibre on the
screen, and its hue on the disc says which of the two ways comes toward you.

With the course on the screen known, the direction in space is read with a median error below half
a degree. In white light it is a coin's toss which end is near.
"""

import pyvista as pv

import vizlight
from vizlight import presets

fibres = vizlight.load_example("fibre_bundle.vtp")
scene = presets.heading()

plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1400, 560), border=False)
plotter.set_background("black", all_renderers=True)
plotter.add_mesh(fibres, color="tan", line_width=3)
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(fibres, scene=scene, line_width=3)
plotter.vizlight.add_key(scene)
plotter.link_views()
plotter.view_vector((1, -0.55, 0.2), (0, 0, 1))
plotter.camera.zoom(1.8)
plotter.enable_anti_aliasing("msaa")
plotter.show(auto_close=False)

# %%
# What can be read in this light, and in white light from the eye:

for light in (scene, presets.slope()):
    print(vizlight.legibility(fibres, light, view=plotter.camera))
