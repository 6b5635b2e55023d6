"""
Two models of a highlight
=========================

The figures of Fisher and Woo, *R.E versus N.H Specular Highlights*. Upper row: Phong's highlight,
of power 8. Below: Blinn's, of 1, 2, 4 and 6 times that power. Four times the power looks like
Phong's up to 45 degrees. With a lamp behind the ball Phong's highlight wraps around it and Blinn's
stays round. Last row: the power times 4 cos(angle / 2).
"""

# sphinx_gallery_thumbnail_number = 1
import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.model import highlights


def shiny(mesh, degrees, model, power):
    """Return a mesh with the highlight of a lamp so far from the eye, which is above it."""
    angle = np.radians(degrees)
    scene = Scene(
        lights=Light(direction=(-np.sin(angle), 0, np.cos(angle))),
        view=View(direction=(0, 0, 1)),
        material=Material(
            ambient=0.4, diffuse=0, specular=0.6, shininess=power, color=(0.28, 0.5, 0.85)
        ),
    )
    return vizlight.illuminate(mesh, scene, model=model)


ball = pv.Sphere(radius=1, theta_resolution=180, phi_resolution=180)
ball["Normals"] = np.array(ball.points)
ball.point_data.active_normals_name = "Normals"
rows = {"Phong, power 8": None, **{f"Blinn, power {8 * f}": f for f in (1, 2, 4, 6)}}
rows["Blinn, 32 cos(a/2)"] = "rule"
angles = (0, 45, 90, 135, 160)
balls = pv.MultiBlock()
for row, factor in enumerate(rows.values()):
    for column, degrees in enumerate(angles):
        rule = highlights.simple_factor(np.radians(degrees)) if factor == "rule" else factor or 1.0
        lit = shiny(ball, degrees, "blinn" if factor else "phong", 8 * rule)
        balls.append(lit.translate((2.2 * column, -2.2 * row, 0)))
camera = render.camera_on(
    (-5, 10.1, -12.2, 2.2, 0, 0), (0, 0, 1), parallel=True, aspect=1.05, zoom=1.38
)
look = {"background": "#14181d", "light": "points"}
plotter = render.make_plotter(render.Panel(balls, "rgb"), camera=camera, size=(1200, 1140), **look)
letters = {"text_color": "white", "font_size": 20, "shape": None, "show_points": False}
places = [(-4.9, -2.2 * row - 0.1, 1) for row in range(len(rows))]
places += [(2.2 * column - 0.3, 1.35, 1) for column in range(len(angles))] + [(-4.9, 1.35, 1)]
names = [*rows, *(f"{degrees}°" for degrees in angles), "from lamp to eye:"]
plotter.add_point_labels(places, names, always_visible=True, **letters)
plotter.show()

# %%
# Three shapes under a lamp 45 degrees from the eye, from above to below with the powers of the
# titles: both models look alike.

turn, down = np.meshgrid(np.linspace(0, 2 * np.pi, 400), np.linspace(1e-9, 1, 120))
along = down * np.pi / 2
wide = np.sin(along) ** 0.5 * (1 + 0.05 * down**6 * np.cos(21 * turn))
cap = pv.StructuredGrid(wide * np.cos(turn), wide * np.sin(turn), 0.7 * np.cos(along) ** 0.5)
cap = cap.extract_surface(algorithm="dataset_surface").clean().compute_normals(feature_angle=180)
rod = pv.Cylinder(radius=0.5, height=1.9, direction=(0, 1, 0), resolution=200, capping=False)
shapes = cap.rotate_x(-35), rod.compute_normals(split_vertices=False).rotate_x(8), ball
panels, powers = [], (4, 8, 16, 32)
for model, factor in (("phong", 1), ("blinn", 4)):
    block = pv.MultiBlock()
    for row, power in enumerate(powers):
        for column, shape in enumerate(shapes):
            lit = shiny(shape, 45, model, factor * power)
            block.append(lit.translate((2.2 * column, -2.2 * row, 0)))
    used = ", ".join(f"{factor * power}" for power in powers)
    panels.append(render.Panel(block, "rgb", f"{model.title()}, powers {used}"))
camera = render.camera_on(block, (0, 0, 1), parallel=True, aspect=0.75, zoom=0.94)
plotter = render.make_plotter(panels, camera=camera, size=(1200, 860), **look)
plotter.show()

# %%
# The difference of both highlights, Phong's less Blinn's of four times the power, over all normals
# that face the eye: the lamp is 90 degrees from it and Phong's power is 10. The two bumps of 64 of
# 255 stand where the normal leans across the plane of lamp and eye.

theta, phi = np.meshgrid(np.radians(np.linspace(0, 180, 181)), np.radians(np.linspace(0, 180, 181)))
normals = np.stack(
    [-np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], axis=-1
)
lamp, eye = np.array([-1.0, 0, 0]), np.array([0.0, 0, 1])
mirror = 2 * normals @ lamp * normals[..., 2] - lamp @ eye
half = normals @ (lamp + eye) / np.linalg.norm(lamp + eye)
error = 255 * (np.maximum(mirror, 0) ** 10 - np.maximum(half, 0) ** 40)
levels = np.arange(-68, 69, 8)
figure, axes = plt.subplots(figsize=(8, 6.4), layout="constrained")
chart = axes.contourf(*np.degrees([phi, theta]), error, levels=levels, cmap="coolwarm")
axes.set(xlabel="phi of the normal, degrees", ylabel="theta of the normal, degrees")
axes.set(aspect="equal", xlim=(0, 90), ylim=(45, 135), xticks=range(0, 91, 15))
figure.colorbar(chart, label="Phong less Blinn, steps of 255", ticks=range(-60, 61, 20))
plt.show()
