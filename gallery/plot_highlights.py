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
    paint = Material(ambient=0.4, diffuse=0.25, specular=0.5, shininess=power, color="#6aa2f0")
    lamp = Light(direction=(-np.sin(angle), 0, np.cos(angle)))
    scene = Scene(lights=lamp, view=View(direction=(0, 0, 1)), material=paint)
    return vizlight.illuminate(mesh, scene, model=model)


def show(solids, bounds, labels, size):
    """Draw solids from above, with labels centred at their places."""
    camera = render.camera_on(bounds, (0, 0, 1), parallel=True)
    camera.parallel_scale = (bounds[3] - bounds[2]) / 2
    look = {"background": "#14181d", "light": "points", "size": size, "anti_aliasing": "ssaa"}
    plotter = render.make_plotter(render.Panel(solids, "rgb"), camera=camera, **look)
    plotter.add_point_labels(
        np.array([(x, y, 1) for x, y, _ in labels]), [text for *_, text in labels],
        always_visible=True, text_color="white", font_size=28, bold=False, shape=None,
        show_points=False, justification_horizontal="center", justification_vertical="center",
    )  # fmt: skip
    plotter.show()


ball = pv.Sphere(radius=1, theta_resolution=400, phi_resolution=400)
ball["Normals"] = np.array(ball.points)
ball.point_data.active_normals_name = "Normals"
rows = {"Phong, power 8": None, **{f"Blinn, power {8 * f}": f for f in (1, 2, 4, 6)}}
rows["Blinn, 32 cos(a/2)"] = "rule"
angles = (0, 45, 90, 135, 160)
balls, labels = pv.MultiBlock(), [(-2.6, 1.45, "lamp to eye, a =")]
labels += [(2.2 * column, 1.45, f"{degrees}°") for column, degrees in enumerate(angles)]
for row, (name, factor) in enumerate(rows.items()):
    labels.append((-2.6, -2.2 * row, name))
    for column, degrees in enumerate(angles):
        rule = highlights.simple_factor(np.radians(degrees)) if factor == "rule" else factor or 1.0
        lit = shiny(ball, degrees, "blinn" if factor else "phong", 8 * rule)
        balls.append(lit.translate((2.2 * column, -2.2 * row, 0)))
show(balls, (-4.6, 10.0, -12.2, 2.0, 0, 0), labels, (1240, 1205))

# %%
# Three shapes under a lamp 45 degrees from the eye, by powers beside the rows: both models look
# alike.

turn, down = np.meshgrid(np.linspace(0, 2 * np.pi, 400), np.linspace(1e-9, 1, 120))
along = down * np.pi / 2
wide = np.sin(along) ** 0.5 * (1 + 0.05 * down**6 * np.cos(21 * turn))
cap = pv.StructuredGrid(wide * np.cos(turn), wide * np.sin(turn), 0.7 * np.cos(along) ** 0.5)
cap = cap.extract_surface(algorithm="dataset_surface").clean().compute_normals(feature_angle=180)
rod = pv.Cylinder(radius=0.5, height=1.9, direction=(0, 1, 0), resolution=200, capping=False)
shapes = cap.rotate_x(-35), rod.compute_normals(split_vertices=False).rotate_x(8), ball
solids, labels = pv.MultiBlock(), []
for left, model, factor in ((0, "phong", 1), (8, "blinn", 4)):
    labels.append((left + 2.2, 1.45, model.title()))
    for row, power in enumerate((4, 8, 16, 32)):
        labels.append((left - 1.7, -2.2 * row, f"power\n{factor * power}"))
        for column, shape in enumerate(shapes):
            lit = shiny(shape, 45, model, factor * power)
            solids.append(lit.translate((left + 2.2 * column, -2.2 * row, 0)))
show(solids, (-2.3, 13.7, -7.9, 2.0, 0, 0), labels, (1600, 990))

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
figure, axes = plt.subplots(figsize=(9, 5), layout="constrained")
drawn = axes.contourf(*np.degrees([theta, phi]), error, levels=np.arange(8, 65, 8), cmap="Reds")
bar = figure.colorbar(drawn, shrink=0.8, aspect=16)
bar.set_label("difference, 255 is white", fontsize=15, labelpad=10)
axes.set_xlabel(r"$\theta$ of the normal, degrees; 90: in the plane of lamp and eye", fontsize=15)
axes.set_ylabel(r"$\varphi$, degrees; 0: lamp, 90: eye", fontsize=15)
axes.set(aspect="equal", xlim=(54, 126), ylim=(24, 66))
axes.set(xticks=range(60, 121, 15), yticks=range(30, 61, 15))
axes.set_title("Phong's highlight of power 10 less Blinn's of 40", fontsize=15)
for each in (axes, bar.ax):
    each.tick_params(labelsize=13)
plt.show()
