"""vizlight: lit by the velocity."""

import pyvista as pv

from vizlight import Light, Material, Scene

surface = pv.read("surface.vtp")
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.5)),
    material=Material(ambient=0.15, diffuse=0.8, specular=0.35, shininess=20),
)
plotter = pv.Plotter()
plotter.vizlight.add_mesh(
    surface, scene=scene, tangents="V", conditioned=True, scalars="speed", cmap="coolwarm",
    show_scalar_bar=False,
)  # fmt: skip
