"""
Light of the sky
================

What each point sees of an even sky multiplies its ambient light, so that folds and valleys are
dark. Above: PyVista with the ambient occlusion of the screen (SSAO), which changes with the camera
and is lost in a file. Below: ``occlusion="sky"``, a point array with an error of 0.02, in the light
of ``presets.shape``. How well the normal is read in each of them is printed below.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Block, Frustum, Material, Scene, presets, render

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

# A machined part: a plate with a boss and holes.
part = Block(size=(6, 4, 1)) | Frustum((1.4, 0, 1), radii=(1, 0.8), height=2)
for hole in ((-2.1, -1.1, 0), (-2.1, 1.1, 0), (-0.7, -1.1, 0), (-0.7, 1.1, 0)):
    part -= Frustum(hole, radii=(0.45, 0.45), height=2)

scene = presets.shape().replace(material=Material(ambient=0.4, diffuse=0.6, specular=0))
shown = {
    "terrain": (fault.extract_surface(algorithm="dataset_surface"), (0.2, -1, 0.8)),
    "cortex": (cortex, (-1, 0.25, 0.3)),
    "coral": (coral.compute_normals(auto_orient_normals=True), (1, 0.6, 0.5)),
    "part": (vizlight.to_polydata(part), (-0.4, -1, 1)),
}
size = {"window_size": (2200, 1000), "shape": (2, 5), "col_weights": (1, 1, 1, 1, 0.34)}
size["groups"] = [((0, 1), 4)]
plotter = pv.Plotter(off_screen=True, border=False, **size)
plotter.set_background("#14181d", all_renderers=True)
words = {"position": "upper_edge", "color": "white", "font_size": 12}
zooms = {"terrain": 1.04, "cortex": 0.92, "coral": 0.79, "part": 0.95}
for column, (name, (mesh, toward)) in enumerate(shown.items()):
    camera = render.camera_on(mesh, toward, aspect=1, zoom=zooms[name])
    camera.SetWindowCenter(0, 0.1)
    # Points deep in folds see nothing of the sky: a warning says how many.
    lit = vizlight.sky(mesh, error=0.02).vizlight.illuminate(scene, occlusion="sky")
    plotter.subplot(0, column)
    look = {"split_sharp_edges": True} if name == "part" else {}
    actor = plotter.add_mesh(
        mesh, color="white", smooth_shading=True, show_scalar_bar=False, **look
    )
    plain = Scene.from_plotter(plotter, actor=actor)
    plotter.enable_ssao(radius=0.1 * mesh.length, bias=0.003 * mesh.length, kernel_size=128)
    plotter.enable_anti_aliasing("ssaa")
    plotter.add_text(f"\n{name}, PyVista with SSAO", **words)
    plotter.camera = camera
    plotter.subplot(1, column)
    plotter.vizlight.add_mesh(lit)
    plotter.enable_anti_aliasing("ssaa")
    plotter.add_text(f"\n{name}, vizlight with sky", **words)
    plotter.camera = camera
    for what, (own, light) in {
        "plain": (mesh, plain), "no sky": (mesh, scene), "sky": (lit, scene),
    }.items():  # fmt: skip
        found = vizlight.legibility(own, light, view=camera).shape
        print(f"{name}, {what}: {found.median:.1f} degrees, {found.bits:.1f} bits")
plotter.subplot(0, 4)
plotter.vizlight.add_key(scene)
plotter.show()
