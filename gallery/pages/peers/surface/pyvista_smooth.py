"""PyVista: smooth shading."""

import pyvista as pv

surface = pv.read("surface.vtp")
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(1, 0.9, 0.5), light_type="scene light"))
plotter.add_mesh(
    surface, scalars="speed", cmap="coolwarm", smooth_shading=True, ambient=0.2, specular=0.4,
    specular_power=20, show_scalar_bar=False,
)  # fmt: skip
