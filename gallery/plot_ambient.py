"""
Ambient light
=============

Spheres lit with increasing ambient light. The ambient term is the product of the material's
ambient coefficient ka, which increases from left to right, and the intensity of the ambient light
Ia, which increases from top to bottom. The ambient term is added to the highlight and to the lit
side, which keep their shape. The dark side receives no other light and loses its shape as it
brightens.

After a figure in a lecture on illumination and shading. Each sphere is lit from the upper left.
"""

import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

ball = pv.Sphere(theta_resolution=120, phi_resolution=120)
view = View(direction=(0, 0, 1))
strengths, lights = (0.0, 0.2, 0.4, 0.6, 0.8), (0.25, 0.5, 0.75, 1.0)

balls = pv.MultiBlock()
for column, strength in enumerate(strengths):
    for row, ambient in enumerate(lights):
        scene = Scene(
            lights=Light(direction=(-0.7, 0.8, 0.9), intensity=0.6),
            view=view,
            ambient_intensity=ambient,
            material=Material(
                ambient=strength,
                diffuse=0.6,
                specular=0.5,
                shininess=40,
                color=(0.9, 0.12, 0.1),
                specular_color="white",
            ),
        )
        lit = vizlight.illuminate(ball, scene)
        balls.append(lit.translate((1.1 * column, -1.1 * row, 0)))

camera = render.camera_on(balls.bounds, (0, 0, 1), parallel=True, zoom=1.18)
camera.focal_point = (2.0, -1.55, 0)
camera.position = (2.0, -1.55, 10)
plotter = render.make_plotter(
    render.Panel(balls, "rgb"), camera=camera, size=(1200, 980), background="#1c2733"
)
style = {"shape": None, "show_points": False, "always_visible": True, "text_color": "white"}
for column, strength in enumerate(strengths):
    where = [(1.1 * column, 0.62, 0)]
    plotter.add_point_labels(
        where, [f"ka = {strength}"], justification_horizontal="center", font_size=24, **style
    )
for row, ambient in enumerate(lights):
    where = [(-0.6, -1.1 * row, 0)]
    plotter.add_point_labels(
        where, [f"Ia = {ambient}"], justification_horizontal="right", font_size=24, **style
    )
plotter.show()
