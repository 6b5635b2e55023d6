"""PyVista: lines rendered as tubes."""

import pyvista as pv

lines = pv.read("lines.vtp")
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(1, -0.6, 0.9), light_type="scene light"))
plotter.add_mesh(
    lines, scalars="Temp", cmap="coolwarm", line_width=5, show_scalar_bar=False,
    render_lines_as_tubes=True, specular=0.4, specular_power=25,
)  # fmt: skip
