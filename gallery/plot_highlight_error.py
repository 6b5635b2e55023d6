"""
Where Phong's and Blinn's highlights differ
===========================================

Figure 5 of Fisher and Woo, *R.E versus N.H Specular Highlights*: the difference Phong minus Blinn
for each normal of a sphere, with light and eye at a right angle and r = 10. The angle phi is
measured in the plane of light and eye, theta away from it. Height and colour are the error in
pixel values of 255.

Left: f = 4. Two bumps of 63.75 stand off the plane, on both sides of the highlight at phi = 45
degrees, where Blinn's highlight falls off more rapidly; in the plane the two agree. Right: ``f = 4
cos(beta) = 2.83``. The bumps are half as high, and two dents of the same depth lie in the plane.
The spheres mark the largest error, as found by ``vizlight.model.highlights.max_pixel_error``.
"""

import numpy as np
import pyvista as pv

from vizlight.model import highlights

ANGLE, POWER = np.pi / 2, 10.0
theta, phi = np.meshgrid(np.linspace(0, np.pi, 241), np.linspace(0, np.pi, 241), indexing="ij")
normal = np.stack(
    [-np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], axis=-1
)
light, eye = np.array([-np.sin(ANGLE), 0, np.cos(ANGLE)]), np.array([0.0, 0, 1])
half = (light + eye) / np.linalg.norm(light + eye)
r_e = 2 * (normal @ light) * (normal @ eye) - light @ eye

plotter = pv.Plotter(shape=(1, 2), window_size=(1600, 700), border=False)
for column, factor in enumerate((4.0, float(highlights.simple_factor(ANGLE)))):
    n_h = np.maximum(normal @ half, 0)
    error = 255 * (np.maximum(r_e, 0) ** POWER - n_h ** (factor * POWER))
    degrees = np.rad2deg(phi), np.rad2deg(theta)
    surface = pv.StructuredGrid(*(x[..., np.newaxis] for x in (*degrees, error)))
    surface["error"] = error.ravel(order="F")
    plotter.subplot(0, column)
    plotter.background_color = "white"
    plotter.add_mesh(
        surface, scalars="error", cmap="PuOr_r", clim=(-64, 64), smooth_shading=True,
        specular=0.2,
        scalar_bar_args={
            "title": "Phong minus Blinn, of 255\n", "color": "black", "position_y": 0.84,
        },
    )  # fmt: skip
    plotter.add_text(f"f = {factor:.2f}", color="black", font_size=14)
    worst = highlights.max_pixel_error(ANGLE, POWER, factor=factor)
    place = (np.rad2deg(worst.phi), np.rad2deg(worst.theta), worst.error)
    plotter.add_mesh(pv.Sphere(radius=3, center=place), color="black")
    plotter.add_point_labels(
        [place], [f"  largest error: {worst.error:.2f}"], shape=None, show_points=False,
        text_color="black", font_size=18, always_visible=True, justification_vertical="center",
    )  # fmt: skip
    plotter.show_bounds(
        axes_ranges=[0, 180, 0, 180, -64, 64], bounds=(0, 180, 0, 180, -64, 64),
        xtitle="phi, degrees", ytitle="theta, degrees", ztitle="error", color="black",
        location="outer", n_xlabels=5, n_ylabels=5, n_zlabels=5, fmt="%.0f", font_size=17,
    )  # fmt: skip
    plotter.camera_position = [(-285, -256, 82), (90, 90, 0), (0, 0, 1)]
plotter.show()
