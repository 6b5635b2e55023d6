"""PyVista: streamlines on the surface, as tubes."""

import pyvista as pv

surface = pv.read("surface.vtp")
seeds = surface.points[::40]
lines = surface.streamlines_from_source(
    pv.PolyData(seeds), vectors="V", surface_streamlines=True, max_length=2
)
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(1, 0.9, 0.5), light_type="scene light"))
plotter.add_mesh(surface, color="lightgray", smooth_shading=True, ambient=0.2)
plotter.add_mesh(
    lines.tube(radius=0.02), scalars="speed", cmap="coolwarm", ambient=0.2, smooth_shading=True,
    show_scalar_bar=False,
)  # fmt: skip
