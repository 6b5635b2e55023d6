"""
Phong's and Blinn's highlights on spheres
=========================================

Figure 2 of Fisher and Woo, *R.E versus N.H Specular Highlights*. Columns: the angle between light
and eye is 0, 45, 90, 135 and 160 degrees; light, sphere and eye lie in the horizontal plane
through the line of sight. Rows: Phong's R.E to the power 8, and Blinn's N.H to the power 8 f for f
= 1, 2, 4 and 6.

Up to 45 degrees Phong's highlight and Blinn's with f = 4 look alike. At larger angles Phong's
highlight wraps around the sphere and Blinn's stays round. In the column of 135 degrees highlights
end sharply at the terminator. The last row uses f = ``4 cos(beta)``, where beta is half the angle
between light and eye: these highlights are as wide as Phong's.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.model import highlights

SHININESS = 8.0
ball = pv.Sphere(theta_resolution=180, phi_resolution=180, direction=(0, 1, 0))
ball["Normals"] = 2 * np.asarray(ball.points)
ball.point_data.active_normals_name = "Normals"
view = View(direction=(0, 0, 1))

spheres = pv.MultiBlock()
for column, degrees in enumerate((0, 45, 90, 135, 160)):
    angle = np.deg2rad(degrees)
    light = Light(direction=(-np.sin(angle), 0, np.cos(angle)))
    best = float(highlights.simple_factor(angle))
    for row, factor in enumerate((None, 1, 2, 4, 6, best)):
        power = SHININESS if factor is None else factor * SHININESS
        scene = Scene(
            lights=light,
            view=view,
            material=Material(ambient=0.12, diffuse=0, specular=0.88, shininess=power),
        )
        model = "phong" if factor is None else "blinn"
        lit = vizlight.illuminate(ball, scene, model=model)
        spheres.append(lit.translate((1.08 * column, -1.08 * row, 0)))

camera = render.camera_on(spheres.bounds, (0, 0, 1), parallel=True)
plotter = render.make_plotter(spheres, camera=camera, size=(1100, 1200), background="#203040")
for column, degrees in enumerate((0, 45, 90, 135, 160)):
    plotter.add_point_labels(
        [(1.08 * column, 0.62, 0)], [f"{degrees}°"], shape=None, show_points=False,
        always_visible=True,
        text_color="white", justification_horizontal="center", font_size=22,
    )  # fmt: skip
for row, name in enumerate(("R.E", "f = 1", "f = 2", "f = 4", "f = 6", "4 cos beta")):
    plotter.add_point_labels(
        [(-0.6, -1.08 * row, 0)], [name], shape=None, show_points=False,
        always_visible=True,
        text_color="white", justification_horizontal="right", font_size=22,
    )  # fmt: skip
plotter.camera.parallel_scale = 3.6
plotter.camera.focal_point = (1.95, -2.6, 0)
plotter.camera.position = (1.95, -2.6, 10)
plotter.reset_camera_clipping_range()
plotter.show()
