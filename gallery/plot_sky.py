"""
Light of the sky
================

The Jacksboro fault in Tennessee under sun and sky, its heights five times as they are. The sun
casts shadows, ``t``; the ambient term is what each point sees of an even sky, so that valleys are
darker than ridges also where the sun does not reach. Both come from one call, with errors that are
measured: ``relief_shadow(..., lit=True, occlusion="sky")``.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, presets, render

terrain = vizlight.load_example("jacksboro_fault.vti").extract_subset((60, 340, 40, 250, 0, 0))
STEEP = 5.0


def lit_by(occlusion, ambient):
    """Return the terrain as it stands, lit by sun and sky."""
    scene = Scene(
        lights=Light(direction=(-0.7, 0.7, 0.42)),
        material=Material(ambient=ambient, diffuse=0.75, specular=0, color="#f2e6d0"),
    )
    lit = vizlight.relief_shadow(
        terrain,
        scene,
        lit=True,
        elevation="elevation",
        exaggeration=STEEP,
        depth=40,
        occlusion=occlusion,
    )
    ground = lit.cast_to_structured_grid()
    ground.points[:, 2] = STEEP * np.asarray(lit["elevation"])
    return ground


both = lit_by("sky", 0.6)
camera = render.camera_on(both.bounds, (0.1, -1, 1.05), aspect=1.5, zoom=1.6)
plotter = render.make_plotter(
    render.Panel(both, "rgb"), camera=camera, size=(1500, 1000), background="#dfe8ee"
)
plotter.show()

# %%
# The same sun with an ambient term that is the same everywhere, and with the sky.

panels = [
    render.Panel(lit_by(None, 0.42), "rgb", "sun, ambient constant"),
    render.Panel(both, "rgb", "sun and sky"),
]
plotter = render.make_plotter(panels, camera=camera, size=(1500, 560), background="#dfe8ee")
plotter.show()

# %%
# A coral: an isosurface of waves. Left: PyVista with the ambient occlusion of the screen (SSAO),
# which is lost in a file and changes with the camera. Right: lamps that tell the shape, and a sky
# all round, as point scalars with an error of 0.02.

block = pv.ImageData(dimensions=(130,) * 3, spacing=(0.02,) * 3, origin=(-1.29,) * 3)
x, y, z = 5.5 * np.asarray(block.points).T
wave = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
ball = 7 * (1.15 - np.linalg.norm(block.points, axis=1))
wall = 3 * (0.5 - np.abs(wave + 0.25 * np.sin(0.7 * x + 1) * np.sin(0.6 * z)))
# A soft minimum of both, so that there are no creases.
block["solid"] = -np.log(np.exp(-3 * ball) + np.exp(-3 * wall)) / 3
coral = block.contour([0.0], scalars="solid").connectivity("largest")
coral = coral.compute_normals(auto_orient_normals=True, split_vertices=False)

plotter = pv.Plotter(shape=(1, 2), window_size=(1500, 800), border=False)
plotter.set_background("#14181d", all_renderers=True)
plotter.add_mesh(coral, color="white", smooth_shading=True)
plotter.enable_ssao(radius=0.4, bias=0.005, kernel_size=128)
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(
    coral,
    scene=presets.shape().replace(material=Material(ambient=0.4, diffuse=0.5, specular=0)),
    occlusion="sky",
)
plotter.link_views()
plotter.view_vector((1, 0.6, 0.5), (0, 0, 1))
plotter.camera.zoom(1.45)
plotter.show()
