"""
Which way does the field run?
=============================

The winds of July in six ways, with the median error in degrees at which a place is read; 45 is
chance. Arrows, LIC and lines are read by a machine that follows strokes, the lights by their keys:
the study *strokes* measures all six. LIC and evenly spaced lines are read better than the light of
``presets.direction``, in which every place reads on its own, also where no line runs; white light
has no key to the direction. Both together are in the example *The winds of July*.
"""

import pyvista as pv
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

from vizlight import Scene, load_example, render, streamlines

wind, field = load_example("winds_of_july.vtp"), {"tangents": "wind", "exponent": 2}
# Strokes at the limb are crowded.
limb = {"normal": (0.42, 1, 0.1), "origin": (0.19, 0.45, 0.045), "invert": False}
arrows = wind.glyph(orient="wind", scale=False, factor=0.09, tolerance=0.045).clip(**limb)
lines = streamlines(wind, tangents="wind", spacing=0.06).scale(1.01).clip(**limb)
lic = vtkSurfaceLICMapper(input_data_object=wind, scalar_visibility=False)

sheet = {"shape": (2, 4), "col_weights": (1, 1, 1, 0.4), "groups": [((0, 1), 3)]}
plotter = pv.Plotter(off_screen=True, window_size=(1800, 1140), border=False, **sheet)
ways = {
    "plain: 42": lambda: None,
    "arrows: 18": lambda: plotter.add_mesh(arrows, color="black"),
    "LIC: 3.4": lambda: plotter.add_actor(pv.Actor(mapper=lic, prop=pv.Property(ambient=0.6))),
    "lines: 2.6": lambda: plotter.add_mesh(lines, color="black", line_width=3),
    "white light: 45": lambda: plotter.vizlight.add_mesh(wind, scene=Scene(), **field),
    "light of direction: 4.5": lambda: plotter.vizlight.add_mesh(wind, scene="direction", **field),
}
for number, (title, draw) in enumerate(ways.items()):
    plotter.subplot(*divmod(number, 3))
    plotter.add_mesh(wind.scale(0.995), color="lightsteelblue", smooth_shading=True)
    draw()
    plotter.add_text(f"\n{title}°", position="upper_edge", color="black", font_size=14)
    plotter.camera = render.camera_on(wind.bounds, limb["normal"], aspect=1, zoom=1.33)
plotter.subplot(0, 3)
plotter.vizlight.add_key("direction", exponent=2)
plotter.show()
