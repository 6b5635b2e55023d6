"""
Blood in a vessel of glass
==========================

The flow in arteries of a head, from a magnetic resonance scan, whose source names no unit of the
speed. Lines are coloured by speed on a map of one lightness (``vizlight.maps.even``) and lit as
cylinders across their width, so that bends and depth are seen. The wall is clear where it faces
the eye, as glass is. How well values are read from the bar, with this map and with ``viridis`` in
the same light, is printed below.
"""

import numpy as np
import pyvista as pv

from vizlight import Scene, legibility, load_example, render, streamlines

scan = load_example("carotid.vti")
scan["speed"] = np.linalg.norm(scan["velocity"], axis=1)
seeds = scan.points[(scan["brightness"] > 200) & (scan["speed"] > 2)][::15]
blood = streamlines(scan, tangents="velocity", seeds=seeds, max_length=80)
blood = blood.clip_scalar(scalars="brightness", value=150, invert=False)
blood = blood.clip_scalar(scalars="speed", value=0.5, invert=False)
blood = blood.remove_cells(blood.compute_cell_sizes()["Length"] < 18)
vessel = scan.contour([145], scalars="brightness").connectivity("specified", region_ids=[0, 1])
vessel = vessel.smooth_taubin(n_iter=40, pass_band=0.05).subdivide(2, "loop").compute_normals()
plotter = pv.Plotter(off_screen=True, window_size=(1500, 1000))
plotter.camera = render.camera_on((8, 76, 2, 46, 0, 44), (1, -0.9, 0.25), aspect=1.5, zoom=1.7)
# 1 where the wall is seen edge-on.
rim = 1 - np.abs(np.asarray(vessel["Normals"]) @ plotter.camera.direction)
vessel["glass"] = (rim[:, np.newaxis] ** 3 * [0, 0, 0, 150] + [205, 228, 255, 6]).astype("u1")

plotter.set_background("#14181d")
bar = {"title": "speed, unit of the scan\n", "color": "white", "n_labels": 3, "fmt": "%.0f"}
bar |= {"position_x": 0.62, "position_y": 0.85, "width": 0.33, "height": 0.09}
look = {"line_diameter": 0.3, "render_lines_as_tubes": True, "clim": (0, 8), "halo": 0.6}
plotter.vizlight.add_mesh(blood, scalars="speed", scalar_bar_args=bar, **look)
plotter.add_mesh(vessel, scalars="glass", rgb=True, lighting=False)
plotter.enable_depth_peeling(8)
plotter.enable_anti_aliasing("ssaa")
plotter.show(auto_close=False)

# %%
# What can be read of the speed, with the map of one lightness and with ``viridis``:

for cmap in (None, "viridis"):
    print(legibility(blood, Scene(), scalars="speed", cmap=cmap, view=plotter.camera, **look))
