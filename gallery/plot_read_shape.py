"""
What is the shape?
==================

A mountain fault, three times as high as it is. Left: PyVista's light. Right: three coloured lamps
half way between the eye and the picture plane, and a white one at the eye
(``vizlight.presets.shape``). Each slope has a colour of its own, which the ball in the corner
shows at the place of the same slope; under white lamps many slopes look the same.

The normal of the surface is read with a median error of some 3 degrees, in PyVista's light of more
than 20.
"""

import pyvista as pv

import vizlight
from vizlight import Scene, presets

fault = vizlight.load_example("jacksboro_fault.vti").warp_by_scalar("elevation", factor=3)
fault = fault.extract_surface(algorithm="dataset_surface")
scene = presets.shape()

plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1400, 640), border=False)
terrain = plotter.add_mesh(fault, color="white", smooth_shading=True)
plotter.view_vector((0.3, -1, 1.2), (0, 0, 1))
plain = Scene.from_plotter(plotter, actor=terrain)
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(fault, scene=scene)
plotter.vizlight.add_key(scene, corner="upper right")
plotter.link_views()
plotter.camera.zoom(1.15)
plotter.enable_anti_aliasing("msaa")
plotter.show(auto_close=False)

# %%
# What can be read in this light, and in PyVista's:

for light in (scene, plain):
    print(vizlight.legibility(fault, light, view=plotter.camera))
