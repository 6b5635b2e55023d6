"""
Phong's and Blinn's highlights on other shapes
==============================================

Figure 3 of Fisher and Woo, *R.E versus N.H Specular Highlights*: a bottle cap, a cylinder and a
sphere under one light at infinity. Left: R.E to the powers 4, 8, 16 and 32, from left to right.
Right: N.H to four times these powers.

The shapes have different distributions of normals, yet the two halves look much alike. The broad
highlights of the smallest power, on the left of each half, differ most.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render


def turned(radius, height):
    """Return the surface of revolution of a profile, given from its foot up, about the y axis."""
    t = np.linspace(0, 2 * np.pi, 181)
    rise, run = np.gradient(height), np.gradient(radius)
    length = np.hypot(rise, run)
    out, up = rise / length, -run / length
    shape = (len(t), len(radius))
    grid = pv.StructuredGrid(
        *(
            np.ascontiguousarray(np.broadcast_to(x, shape))[..., np.newaxis]
            for x in (np.outer(np.cos(t), radius), height, np.outer(np.sin(t), radius))
        )
    )
    normals = (np.outer(np.cos(t), out), np.broadcast_to(up, shape), np.outer(np.sin(t), out))
    grid["Normals"] = np.stack([n.ravel(order="F") for n in normals], axis=1)
    return grid.extract_surface(algorithm="geometry")


edge = np.linspace(0, np.pi / 2, 40)
skirt = np.linspace(1, 0, 30)
profile = [
    (0.5 + 0.06 * skirt**2, -0.22 * skirt),
    (0.33 + 0.17 * np.cos(edge[1:]), 0.17 * np.sin(edge[1:])),
    (np.linspace(0.32, 0, 30), np.linspace(0.17, 0.172, 30)),
]
cap = turned(*np.concatenate(profile, axis=1))
cap = cap.rotate_x(35, transform_all_input_vectors=True)
cylinder = turned(np.full(40, 0.33), np.linspace(-0.45, 0.45, 40))
# Perpendicular to the half vector, so that the highlight runs along the cylinder.
cylinder = cylinder.rotate_z(-50, transform_all_input_vectors=True)
angle = np.linspace(-np.pi / 2, np.pi / 2, 91)
sphere = turned(0.5 * np.cos(angle), 0.5 * np.sin(angle))
for shape in (cap, cylinder, sphere):
    shape.point_data.active_normals_name = "Normals"

sun, view = Light(direction=(-0.6, 0.7, 1)), View(direction=(0, 0, 1))
halves = []
for model, factor in (("phong", 1), ("blinn", 4)):
    half = pv.MultiBlock()
    for column, power in enumerate((4, 8, 16, 32)):
        scene = Scene(
            lights=sun,
            view=view,
            material=Material(ambient=0.1, diffuse=0.25, specular=0.65, shininess=factor * power),
        )
        for row, shape in enumerate((cap, cylinder, sphere)):
            lit = vizlight.illuminate(shape, scene, model=model)
            half.append(lit.translate((1.2 * column, -1.12 * row, 0)))
    halves.append(half)

titles = ("R.E, powers 4 to 32", "N.H, powers 16 to 128")
plotter = render.make_plotter(
    [render.Panel(half, title=title) for half, title in zip(halves, titles, strict=True)],
    camera=render.camera_on(halves[0].bounds, (0, 0, 1), parallel=True, zoom=1.3),
    size=(1600, 640),
    background="#203040",
)
plotter.show()
