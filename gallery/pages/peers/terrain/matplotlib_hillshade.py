"""matplotlib: hillshade."""

import matplotlib.pyplot as plt
import pyvista as pv
from matplotlib.colors import LightSource

terrain = pv.read("terrain.vti")
columns, rows = terrain.dimensions[:2]
heights = terrain["height"].reshape(rows, columns)
dx, dy = terrain.spacing[:2]
# Rows run to the north; LightSource has the first row in the north.
shade = LightSource(azdeg=315, altdeg=21).hillshade(heights[::-1], dx=dx, dy=dy)
figure, axes = plt.subplots()
axes.imshow(shade, cmap="gray", vmin=0, vmax=1, extent=terrain.bounds[:4], interpolation="bilinear")
