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
    material=Material(ambient=0.55, diffuse=0.5, specular=0.2, shininess=25),
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


panels = [
    render.Panel(turned(angle), "rgb", f"turned by {angle}°{name}")
    for angle, name in ((0, ": graph of Re w"), (20, ""), (45, ""), (70, ""), (90, ": the inverse"))
]
meshes = pv.MultiBlock([block for panel in panels for block in panel.mesh])
camera = render.camera_on(meshes, (0.5, -1, 0.7), aspect=1.0, zoom=0.92)
# A key of the phase, which faces the eye.
axis = -np.array(camera.direction)
ring = pv.Disc(inner=0.6, outer=1.1, normal=axis, r_res=8, c_res=180)
right = np.cross(camera.up, axis) / np.linalg.norm(np.cross(camera.up, axis))
up = np.cross(axis, right)
phase = np.arctan2(ring.points @ up, ring.points @ right)
ring["rgb"] = wheel(phase / (2 * np.pi) + 0.5)[:, :3]
panels.append(render.Panel(ring, "rgb", "phase of w"))
look = {"rows": 2, "size": (1650, 1160), "background": "white", "line_width": 1.5}
plotter = render.make_plotter(panels, camera=camera, **look)
places = [1.5 * (np.cos(turn) * right + np.sin(turn) * up) for turn in np.arange(4) * np.pi / 2]
words = {
    "shape": None,
    "show_points": False,
    "font_size": 30,
    "bold": False,
    "always_visible": True,
}
words["text_color"] = "black"
words |= {"justification_horizontal": "center", "justification_vertical": "center"}
plotter.add_point_labels(np.array(places), ["0", r"$\pi/2$", r"$\pi$", r"$-\pi/2$"], **words)
plotter.show()
