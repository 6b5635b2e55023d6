"""
A flow over an isosurface
=========================

The isosurface Temp = 600 of the gas over a heated, rotating disk, lit by the velocity on it and
conditioned by the clamped light of the surface itself, and coloured by the speed, from slow
(violet) to fast (yellow). The velocity makes the swirl visible: the bright streak lies where the
mirror cone of the flow meets the eye and turns with it around the axis. Lighting by the surface
normals shows none of this.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render

surface = vizlight.load_example().contour([600], scalars="Temp")
surface = surface.compute_normals(cell_normals=False, auto_orient_normals=True)
# Split each triangle into 16: a highlight is narrower than the triangles of the simulation.
surface = surface.subdivide(2, "linear")

camera = render.camera_on(surface.bounds, (1, 0.5, 0.45), aspect=1.4, zoom=1.7)
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.5)),
    view=View.from_camera(camera),
    material=Material(ambient=0.15, diffuse=0.75, specular=0.3, shininess=20),
)
lit = vizlight.illuminate(surface, scene, tangents="V", conditioned=True)

# %%
# ``luminance`` is an ordinary point array, so the highlight can be located by a threshold.

bright = lit.threshold(0.6, scalars="luminance")
print(f"{bright.n_points} of {lit.n_points} points are brighter than 0.6;")
print(f"their mean temperature is {bright['Temp'].mean():.0f}")

# In the interactive scene the light follows the eye.
lit["speed"] = np.linalg.norm(lit["V"], axis=1)
fastest = lit["speed"].max()
lit = vizlight.tint(lit, "speed", cmap="viridis", clim=(-0.5 * fastest, fastest))
plotter = render.make_plotter(
    render.Panel(lit, "rgb"), camera=camera, size=(1200, 840), background="black"
)
plotter.show()
