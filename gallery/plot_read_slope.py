"""
How steeply do lines run toward you?
====================================

300 fibres of a brain's white matter. Left: PyVista draws lines without light, so that the bundle
is a flat shape. Right: under one lamp at the eye (``vizlight.presets.slope``) a line is white
where it runs across the view and dark where it runs toward you or away from you, as the bar tells.

Lightness orders the places of the fibres by their slope: the rank correlation is -0.98. Which of
its ends is nearer is not told; heading tells that
too.
"""

import pyvista as pv

import vizlight
from vizlight import presets

fibres = vizlight.load_example("fibre_bundle.vtp")
scene = presets.slope()

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
# What can be read in this light; flat lines give no information:

print(vizlight.legibility(fibres, scene, view=plotter.camera))
