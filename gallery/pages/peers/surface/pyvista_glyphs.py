"""PyVista: arrows."""

import pyvista as pv

surface = pv.read("surface.vtp")
arrow = pv.Arrow(start=(-0.5, 0, 0))
arrows = surface.glyph(orient="V", scale=False, factor=0.55, tolerance=0.04, geom=arrow)
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(1, 0.9, 0.5), light_type="scene light"))
plotter.add_mesh(surface, color="lightgray", smooth_shading=True, ambient=0.2)
plotter.add_mesh(arrows, scalars="speed", cmap="coolwarm", ambient=0.2, show_scalar_bar=False)
