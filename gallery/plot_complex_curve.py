"""
A complex curve turning in 4-space
==================================

The graph of ``w = z^3 / 3 - z / 2``, a surface in 4-space (Re z, Im z, Re w, Im w), rotated in the
plane of x and w and lit in 4-space before it is projected to 3-space. The graph of Re w, on the
left a sheet with two saddles, becomes the graph of the inverse function after a quarter turn. The
three sheets of the inverse cross in the projection, although the surface in 4-space does not
intersect itself. Colours show the phase of w, and meet at its three zeros; the lines are those of
equal Re z and of equal Im z.
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
curve["Re z"], curve["Im z"] = curve["position"][:, 0], curve["position"][:, 1]
curve["phase of w"] = np.angle(np.asarray(curve["position"]) @ [0, 0, 1, 1j])
hues = ["#e05a47", "#e8c34a", "#5bb06a", "#4aa3c8", "#7f6fd0", "#c65a9a", "#e05a47"]
wheel = colors.LinearSegmentedColormap.from_list("wheel", hues)
scene = Scene(
    lights=Light(direction=(-0.4, -0.9, 0.9, 0.4)),
    view=View(direction=(0.5, -1, 0.7, 0)),
    material=Material(ambient=0.45, diffuse=0.6, specular=0.2, shininess=25),
)
levels = np.linspace(-1.2, 1.2, 9)


def turned(degrees):
    """Return the curve in 3-space after a turn, lit before it is projected, and its lines."""
    turn = ("xw", np.radians(degrees))
    lit = vizlight.project(curve, rotation=turn, scene=scene, light="before")
    lit = vizlight.tint(lit, "phase of w", cmap=wheel, clim=(-np.pi, np.pi))
    lines = pv.merge([lit.contour(levels, scalars=name) for name in ("Re z", "Im z")])
    lines["rgb"] = np.full((lines.n_points, 3), 0.15)
    return pv.MultiBlock([lit, lines])


angles = (0, 30, 60, 90)
panels = [render.Panel(turned(angle), "rgb", f"turned by {angle} degrees") for angle in angles]
meshes = pv.MultiBlock([block for panel in panels for block in panel.mesh])
camera = render.camera_on(meshes, (0.5, -1, 0.7), aspect=0.78, zoom=0.86)
look = {"size": (2000, 640), "background": "white", "line_width": 1}
plotter = render.make_plotter(panels, camera=camera, **look)
plotter.show()

# %%
# Halfway through the quarter turn. The eye that sees the light stays in 4-space.

lit, lines = turned(45)
plotter = pv.Plotter(off_screen=True, window_size=(1200, 1000))
plotter.background_color = "white"
bar = {
    "title": "phase of w, radians\n", "color": "black", "vertical": True, "n_labels": 3,
    "height": 0.5, "position_x": 0.82, "position_y": 0.25, "fmt": "%.2f",
}  # fmt: skip
plotter.vizlight.add_mesh(lit, scalar_bar_args=bar)
drawn = plotter.add_mesh(lines, color="#262626", line_width=2, lighting=False)
# The lines lie in the surface: shift them slightly toward the viewer.
drawn.mapper.SetResolveCoincidentTopologyToPolygonOffset()
drawn.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-4, -4)
plotter.camera = render.camera_on(lit, (0.5, -1, 0.7), aspect=1.2, zoom=0.95)
plotter.enable_anti_aliasing("ssaa")
plotter.show()
