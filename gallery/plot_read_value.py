"""
What is the value?
==================

The speed of a gas on an isosurface of its temperature. Left: PyVista's light and highlight on
``viridis``: many colours of the picture are on no bar. Right: light that keeps the colour
(``vizlight.presets.value``) on a map of one lightness and one chroma (``vizlight.maps.even``). Each
pixel is read by the colour of the bar that is nearest to it. Half of the places are read worse with
``viridis`` in the same light, because its own lightness is taken for light; both figures are
printed below.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Material, presets

surface = vizlight.load_example().contour([600], scalars="Temp").subdivide(2, "loop")
surface["speed"] = np.linalg.norm(surface["V"], axis=1)
scene = presets.value().replace(material=Material(ambient=0.7, diffuse=0.3, specular=0))
words = {"position": "upper_edge", "color": "black", "font_size": 14}
bar = {
    "color": "black",
    "n_labels": 3,
    "fmt": "%.0f",
    "width": 0.6,
    "height": 0.12,
    "title_font_size": 26,
    "label_font_size": 24,
}
bar |= {"position_x": 0.2, "position_y": 0.02}
title = "speed, unit of the simulation\n"

plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(1600, 760), border=False)
plotter.add_mesh(
    surface, scalars="speed", cmap="viridis", smooth_shading=True, specular=0.4,
    scalar_bar_args=bar | {"title": title},
)  # fmt: skip
plotter.add_text("\nPyVista: viridis and a highlight", **words)
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(
    surface, scene=scene, scalars="speed", scalar_bar_args=bar | {"title": f" {title} "}
)
plotter.add_text("\nvizlight: a map of one lightness", **words)
plotter.link_views()
plotter.view_vector((1, 0.5, 0.6), (0, 0, 1))
plotter.camera.zoom(1.44)
plotter.camera.SetWindowCenter(0, -0.25)
plotter.enable_anti_aliasing("msaa")
plotter.show(auto_close=False)

# %%
# What can be read of the speed on the right, with its own map and with ``viridis``:

for cmap in (None, "viridis"):
    print(vizlight.legibility(surface, scene, scalars="speed", cmap=cmap, view=plotter.camera))
