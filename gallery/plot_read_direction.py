"""
Which way does the field run?
=============================

The winds of July in six ways, with the median error in degrees at which a place is read; 45 is
chance. Arrows, LIC and lines are read by a machine that follows strokes, the lights by their keys.
Evenly spaced lines read as well as the light of ``presets.direction``, in which every place reads
on its own, also where no line runs; white light has no key to the direction. Both together are in
the example *The winds of July*.
"""

import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv
from scipy.ndimage import binary_erosion, gaussian_filter
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

from vizlight import Scene, View, legibility, load_example, presets, render, streamlines

wind = load_example("winds_of_july.vtp")
wind.set_active_vectors("wind")
arrows = wind.glyph(orient="wind", scale=False, factor=0.09, tolerance=0.045)
lines = streamlines(wind, vectors="wind", spacing=0.06).scale(1.005)
lic, hue = vtkSurfaceLICMapper(), presets.direction()
lic.SetInputDataObject(wind)
lic.ScalarVisibilityOff()
field = {"tangents": "wind", "exponent": 2}
ways = {
    "plain: 42": lambda _: None,
    "arrows: 18": lambda plotter: plotter.add_mesh(arrows, color="black"),
    "LIC: 3.4": lambda plotter: plotter.add_actor(pv.Actor(mapper=lic)),
    "lines: 2.6": lambda plotter: plotter.add_mesh(lines, color="black", line_width=4),
    "white light: 45": lambda plotter: plotter.vizlight.add_mesh(wind, scene=Scene(), **field),
    "light of direction: 2.7": lambda plotter: plotter.vizlight.add_mesh(wind, scene=hue, **field),
}
pictures = {}
_, axes = plt.subplots(2, 3, figsize=(15, 10.4), layout="constrained")
for axis, (title, draw) in zip(axes.flat, ways.items(), strict=True):
    plotter = pv.Plotter(off_screen=True, window_size=(640, 640))
    plotter.add_mesh(wind.scale(0.995), color="lightsteelblue", smooth_shading=True)
    draw(plotter)
    if title.startswith("light"):
        plotter.vizlight.add_key(hue, exponent=2)
    plotter.camera = render.camera_on(wind.bounds, (0.42, 1, 0.1), zoom=1.75)
    pictures[title] = plotter.screenshot(return_img=True)
    axis.imshow(pictures[title])
    axis.set_title(title, fontsize=20)
    axis.set_axis_off()
plt.show()

# %%
# The machine knows the way of strokes at each pixel from the gradients around it (the structure
# tensor), in a window of the width that reads best, from 4 to 64 pixels. Places at the rim of the
# globe are not asked for. The lights are read by the colours of their keys.

camera = plotter.camera
across = np.asarray(wind["wind"]) @ View.from_camera(camera).axes()[:2].T
across /= np.linalg.norm(across, axis=1, keepdims=True)
wind["way"] = np.insert(0.5 + 0.5 * across, 2, 0.0, axis=1)
truth = pv.Plotter(off_screen=True, window_size=(640, 640))
truth.set_background("blue")
truth.add_mesh(wind, scalars="way", rgb=True, lighting=False)
truth.camera = camera
right, up, outside = np.moveaxis(truth.screenshot(return_img=True) / 127.5, 2, 0) - 1
inside = binary_erosion(outside < 0, iterations=25) & (abs(np.hypot(right, up) - 1) < 0.1)
for title in list(ways)[:4]:
    y, x = np.gradient(gaussian_filter(pictures[title].mean(axis=2), 1.0))
    medians = []
    for width in (2, 4, 6, 8, 16, 24, 32):
        xx, xy, yy = (gaussian_filter(part, width) for part in (x * x, x * y, y * y))
        read = np.pi / 2 + np.arctan2(2 * xy, xx - yy) / 2
        off = (read - np.arctan2(-up, right) + np.pi / 2) % np.pi - np.pi / 2
        medians.append(np.degrees(np.median(abs(off[inside]))))
    print(f"{title.partition(':')[0]}: {min(medians):.1f} degrees")
pv.close_all()  # the view of the truth is no picture
for name, light in (("white light", Scene()), ("light of direction", hue)):
    read = legibility(wind, light, view=camera, **field).direction
    print(f"{name}: {read.legend_median:.1f} degrees")
