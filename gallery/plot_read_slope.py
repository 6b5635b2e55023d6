"""
How steeply do lines run toward you?
====================================

300 fibres of a brain's white matter. Left: PyVista's tubes under its light. Right: under one lamp
at the eye (``vizlight.presets.slope``) a fibre is white where it runs across the view and dark
where it runs toward you or away, as the bar tells: the top of the arch points at you. The rank
correlation of lightness with slope in the picture is printed below. Which of its ends is near is
not told; the example of heading tells that too.
"""

import pyvista as pv

import vizlight
from vizlight import presets, render

fibres = vizlight.load_example("fibre_bundle.vtp")
scene = presets.slope()

plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1800, 720), border=False)
plotter.set_background("#2c4358", all_renderers=True)
plotter.add_mesh(fibres, color="tan", line_width=3, render_lines_as_tubes=True)
plotter.camera = render.camera_on(fibres.bounds, (0.3, -1, 0.2), aspect=1.25, zoom=1.66)
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(fibres, scene=scene, line_diameter=0.22)
plotter.vizlight.add_key(scene)
plotter.link_views()
plotter.enable_anti_aliasing("ssaa")
plotter.show(auto_close=False)

# %%
# What can be read in this light:

print(vizlight.legibility(fibres, scene, view=plotter.camera, line_diameter=0.22))
