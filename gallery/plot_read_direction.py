"""
Which way does the field run?
=============================

The mean wind of July over the Indian Ocean. Left: PyVista's light shows the globe, and arrows show
the wind where they stand. Right: the wind itself is lit, by three lamps around the eye whose
colours are equally bright (``vizlight.presets.direction``). Hue is the direction of the wind
on the screen at every place: find it on the disc in the corner. Where hue changes at once, winds
meet.

The meter below the script says how well it can be read: an ideal observer is wrong by more than
10 degrees on less than 1 % of the picture, and a reader with the disc by 2.5 degrees in the
median. Under the white light of ``Scene()`` it is 45 % and 46 degrees, which is chance. White
places run toward the eye or away from it. Which of two opposite ways the wind blows is not told:
lines have no sense.
"""

import pyvista as pv

import vizlight
from vizlight import presets, render

wind = vizlight.load_example("winds_of_july.vtp")
wind = wind.compute_normals(cell_normals=False, auto_orient_normals=True)
lines = vizlight.streamlines(wind, vectors="wind", spacing=0.06)
lines.points *= 1.004  # above the triangles, which would hide parts of them
scene = presets.direction()

plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1400, 640), border=False)
plotter.add_mesh(wind, color="lightsteelblue", smooth_shading=True)
arrows = wind.glyph(orient="wind", scale=False, factor=0.06, tolerance=0.03)
plotter.add_mesh(arrows, color="black")
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(wind, scene=scene, tangents="wind", exponent=2)
plotter.add_mesh(lines, color="black", opacity=0.5)
plotter.vizlight.add_key(scene, corner="lower right", exponent=2)
plotter.link_views()
plotter.camera = render.camera_on(wind.bounds, (0.42, 1, 0.2), zoom=1.35)
plotter.enable_anti_aliasing("msaa")
plotter.show(auto_close=False)

# %%
# What can be read in the light on the right, and in the default light, which is white:

for light in (scene, vizlight.Scene()):
    print(vizlight.legibility(wind, light, tangents="wind", exponent=2, view=plotter.camera))
