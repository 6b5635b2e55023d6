"""PyVista: tubes with ambient occlusion (SSAO)."""

import pyvista as pv

tubes = pv.read("lines.vtp").tube(radius=0.025, n_sides=12)
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(1, -0.6, 0.9), light_type="scene light"))
plotter.add_mesh(
    tubes, scalars="Temp", cmap="coolwarm", show_scalar_bar=False, smooth_shading=True,
    ambient=0.2, specular=0.4, specular_power=25,
)  # fmt: skip
plotter.enable_ssao(radius=2.5, bias=0.05, kernel_size=128)
