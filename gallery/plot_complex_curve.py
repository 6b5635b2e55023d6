"""
A complex curve turning in 4-space
==================================

The graph of ``w = z^3 / 3 - z / 2``, a surface in 4-space (Re z, Im z, Re w, Im w), rotated in the
plane of x and w and lit in 4-space before it is projected to 3-space. The graph of Re w, on the
left a sheet with two saddles, becomes the graph of the inverse function after a quarter turn. The
three sheets of the inverse cross in the projection, although the surface in 4-space does not
intersect itself. Colours show the phase of w, and meet at its three zeros.
"""

# sphinx_gallery_thumbnail_number = 2
import matplotlib.colors as colors
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.geometry import manifolds


def place(x, y):
    """Return the points (z, w) for z = x + i y."""
    z = x + 1j * y
    w = z**3 / 3 - z / 2
    return x, y, w.real, w.imag


def tangents(x, y):
    """Return the derivatives by x and by y: dw is (z^2 - 1/2) dz."""
    slope = (x + 1j * y) ** 2 - 0.5
    return (1, 0, slope.real, slope.imag), (0, 1, -slope.imag, slope.real)


domain = ((-1.35, 1.35),) * 2
curve = vizlight.manifold(manifolds.parametric(place, domain, 4, tangents=tangents, resolution=220))
curve["phase of w"] = np.angle(np.asarray(curve["position"]) @ [0, 0, 1, 1j])
hues = ["#e05a47", "#e8c34a", "#5bb06a", "#4aa3c8", "#7f6fd0", "#c65a9a", "#e05a47"]
wheel = colors.LinearSegmentedColormap.from_list("wheel", hues)
scene = Scene(
    lights=Light(direction=(-0.4, -0.9, 0.9, 0.4)),
    view=View(direction=(0.5, -1, 0.7, 0)),
    material=Material(ambient=0.15, diffuse=0.8, specular=0.3, shininess=25),
)
camera = render.camera_on((-1.3, 1.3, -1.3, 1.3, -1.2, 1.2), (0.5, -1, 0.7), zoom=0.66)


def turned(degrees):
    """Return the curve in 3-space after a turn, lit before it is projected."""
    turn = ("xw", np.radians(degrees))
    lit = vizlight.project(curve, rotation=turn, scene=scene, light="before")
    return vizlight.tint(lit, "phase of w", cmap=wheel, clim=(-np.pi, np.pi))


panels = [render.Panel(turned(degrees), "rgb", f"{degrees} degrees") for degrees in (0, 30, 60, 90)]
plotter = render.make_plotter(panels, camera=camera, size=(2000, 560), background="#203048")
plotter.show()

# %%
# Halfway through the quarter turn. The eye that sees the light stays in 4-space.

plotter = pv.Plotter(off_screen=True, window_size=(1000, 700))
plotter.background_color = "#203048"
bar = {"color": "white", "vertical": True, "n_labels": 3, "height": 0.4, "position_y": 0.3}
plotter.vizlight.add_mesh(turned(45), scalar_bar_args=bar)
plotter.camera = camera
plotter.show()
