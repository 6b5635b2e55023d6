"""
Light that fades with distance
==============================

A light source above the left end of each row of spheres, with the attenuation ``min(1, 1 / (c1 +
c2 d + c3 d^2))`` of the distance d. The first row has no attenuation and is as bright at its end
as at its start. The last row has the inverse square law and is dark after three spheres. The two
rows between them keep the distant spheres legible.
"""

import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

ball = pv.Sphere(theta_resolution=100, phi_resolution=100)
laws = {
    "1": (1.0, 0.0, 0.0),
    "1 / (1 + d / 4)": (1.0, 0.25, 0.0),
    "1 / (1 + d / 10 + d^2 / 20)": (1.0, 0.1, 0.05),
    "1 / d^2": (0.0, 0.0, 1.0),
}

rows = pv.MultiBlock()
for row, attenuation in enumerate(laws.values()):
    scene = Scene(
        lights=Light(position=(-0.4, 0.7 - 1.5 * row, 0.9), attenuation=attenuation),
        view=View(direction=(0, 0, 1)),
        material=Material(ambient=0.04, diffuse=0.85, specular=0.3, shininess=30),
    )
    for column in range(7):
        moved = ball.translate((1.1 * column, -1.5 * row, 0))
        rows.append(vizlight.illuminate(moved, scene))

camera = render.camera_on(rows.bounds, (0, 0, 1), parallel=True, zoom=1.42)
plotter = render.make_plotter(rows, camera=camera, size=(1200, 860), background="#203040")
for row, law in enumerate(laws):
    plotter.add_point_labels(
        [(-0.5, 0.6 - 1.5 * row, 0)], [law], shape=None, show_points=False, always_visible=True,
        text_color="white", font_size=24,
    )  # fmt: skip
plotter.show()
