"""vizlight: cos-theta shadow."""

import pyvista as pv

from vizlight import relief_shadow

terrain = pv.read("terrain.vti")
shaded = relief_shadow(terrain, sun=(315, 21), depth=30, elevation="height")
plotter = pv.Plotter()
plotter.add_mesh(
    shaded, scalars="t", cmap="gray", clim=(0, 1), lighting=False, show_scalar_bar=False
)
