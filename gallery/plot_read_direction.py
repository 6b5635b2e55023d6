"""
Which way does the field run?
=============================

The winds of July in six ways, with the median error in degrees at which a place is read; 45 is
chance. Arrows, LIC and lines are read by a machine that follows strokes, the lights by their keys.
White light has no key to the direction. Evenly spaced lines read best, and in the light of
``presets.direction`` every place reads on its own, where no line runs too. Both together make
:doc:`the winds of July <plot_winds>`.
"""

import matplotlib.pyplot as plt
import pyvista as pv
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

from vizlight import Scene, load_example, presets, render, streamlines

wind = load_example("winds_of_july.vtp")
wind.set_active_vectors("wind")
arrows = wind.glyph(orient="wind", scale=False, factor=0.09, tolerance=0.045)
lines = streamlines(wind, vectors="wind", spacing=0.06).scale(1.005)
lic, hue = vtkSurfaceLICMapper(), presets.direction()
lic.SetInputDataObject(wind)
lic.ScalarVisibilityOff()
field = {"tangents": "wind", "exponent": 2}
ways = {
    "plain: 45": lambda _: None,
    "arrows: 13": lambda plotter: plotter.add_mesh(arrows, color="black"),
    "LIC: 3.3": lambda plotter: plotter.add_actor(pv.Actor(mapper=lic)),
    "lines: 1.7": lambda plotter: plotter.add_mesh(lines, color="black", line_width=2.5),
    "white light: 45": lambda plotter: plotter.vizlight.add_mesh(wind, scene=Scene(), **field),
    "light of direction: 2.7": lambda plotter: plotter.vizlight.add_mesh(wind, scene=hue, **field),
}
figure, axes = plt.subplots(2, 3, figsize=(15, 10.4), layout="constrained")
for axis, (title, draw) in zip(axes.flat, ways.items(), strict=True):
    plotter = pv.Plotter(off_screen=True, window_size=(640, 640))
    plotter.add_mesh(wind.scale(0.995), color="lightsteelblue", smooth_shading=True)
    draw(plotter)
    if title.startswith("light"):
        plotter.vizlight.add_key(hue, exponent=2)
    plotter.camera = render.camera_on(wind.bounds, (0.42, 1, 0.1), zoom=1.75)
    axis.imshow(plotter.screenshot(return_img=True))
    axis.set_title(title, fontsize=20)
    axis.set_axis_off()
plt.show()
