"""
How steeply do lines run toward you?
====================================

300 fibres of a brain's white matter. Above: PyVista's tubes under its light. Below: under one lamp
at the eye (``vizlight.presets.slope``) a fibre is white where it runs across the view and dark
where it runs toward you or away, as the bar tells: the top of the arch points at you. The rank
correlation of lightness with slope in the picture is printed below. Which of its ends is near is
not told; the example of heading tells that too.
"""

import pyvista as pv

import vizlight
from vizlight import Material, presets, render

fibres = vizlight.load_example("fibre_bundle.vtp")
scene = presets.slope().replace(material=Material(ambient=0.25, diffuse=0.75, specular=0))

plotter = pv.Plotter(off_screen=True, shape=(2, 1), window_size=(1400, 1240), border=False)
plotter.set_background("#14181d", all_renderers=True)
plotter.add_mesh(fibres, color="tan", line_width=4, render_lines_as_tubes=True)
words = {"position": "upper_edge", "color": "white", "font_size": 11}
plotter.add_text("PyVista: tubes in its light", **words)
plotter.camera = render.camera_on(fibres, (0.3, -1, 0.2), aspect=1.95, zoom=0.95)
plotter.subplot(1, 0)
plotter.add_text("vizlight: one lamp at the eye", **words)
plotter.vizlight.add_mesh(fibres, scene=scene, line_diameter=0.2)
plotter.vizlight.add_key(scene, question="slope")
plotter.link_views()
plotter.enable_anti_aliasing("ssaa")
plotter.show(auto_close=False)

# %%
# What can be read in this light:

print(vizlight.legibility(fibres, scene, view=plotter.camera, line_diameter=0.2))
