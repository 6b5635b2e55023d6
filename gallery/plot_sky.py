"""
Light of the sky
================

What each point sees of an even sky multiplies its ambient light, so that folds and valleys are
dark. Above: PyVista with the ambient occlusion of the screen (SSAO), which changes with the camera
and is lost in a file. Below: ``occlusion="sky"``, a point array with an error of 0.03, in the light
of ``presets.shape``. The normal is read as well with the sky as without, with a median error of 3
to 4 degrees, as the table shows; in PyVista's light it is 20 and more.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Material, Scene, presets, render

fault = vizlight.load_example("jacksboro_fault.vti").extract_subset((60, 260, 60, 230, 0, 0))
fault = fault.warp_by_scalar("elevation", factor=3).scale(0.001)
cortex = vizlight.load_example("brain.vti").contour([55.5]).connectivity("largest")
# A coral: an isosurface of waves in a ball, by a soft minimum, so that there are no creases.
block = pv.ImageData(dimensions=(110,) * 3, spacing=(0.024,) * 3, origin=(-1.308,) * 3)
x, y, z = 5.5 * np.asarray(block.points).T
wave = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
ball = 7 * (1.15 - np.linalg.norm(block.points, axis=1))
block["solid"] = -np.logaddexp(-3 * ball, -3 * (1.5 - 3 * np.abs(wave))) / 3
coral = block.contour([0.0], scalars="solid").connectivity("largest")

scene = presets.shape().replace(material=Material(ambient=0.4, diffuse=0.6, specular=0))
shown = {
    "terrain": (fault.extract_surface(algorithm="dataset_surface"), (0.2, -1, 0.8)),
    "cortex": (cortex, (-1, 0.25, 0.3)),
    "coral": (coral.compute_normals(auto_orient_normals=True), (1, 0.6, 0.5)),
}
plotter = pv.Plotter(off_screen=True, shape=(2, 3), window_size=(1650, 1000), border=False)
plotter.set_background("#14181d", all_renderers=True)
for column, (name, (surface, toward)) in enumerate(shown.items()):
    camera = render.camera_on(surface.bounds, toward, aspect=1.1, zoom=1.42)
    # Points deep in folds see nothing of the sky: a warning says how many.
    surface = vizlight.sky(surface, error=0.03)
    lit = surface.vizlight.illuminate(scene, occlusion="sky")
    plotter.subplot(0, column)
    actor = plotter.add_mesh(surface, color="white", smooth_shading=True, show_scalar_bar=False)
    plain = Scene.from_plotter(plotter, actor=actor)
    plotter.enable_ssao(radius=0.1 * surface.length, bias=0.003 * surface.length, kernel_size=128)
    plotter.camera = camera
    plotter.subplot(1, column)
    plotter.vizlight.add_mesh(lit)
    plotter.camera = camera
    lights = {"plain": (surface, plain), "no sky": (surface, scene), "sky": (lit, scene)}
    for what, (mesh, light) in lights.items():
        found = vizlight.legibility(mesh, light, view=camera).shape
        print(f"{name}, {what}: {found.median:.1f} degrees, {found.bits:.1f} bits")
plotter.show()
