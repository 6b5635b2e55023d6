"""PyVista: lines."""

import pyvista as pv

lines = pv.read("lines.vtp")
plotter = pv.Plotter()
plotter.add_mesh(lines, scalars="Temp", cmap="coolwarm", line_width=3, show_scalar_bar=False)
