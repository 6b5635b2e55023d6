"""PyVista: smooth shading."""

import pyvista as pv

terrain = pv.read("terrain.vti").warp_by_scalar("height")
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(-0.66, 0.66, 0.36), light_type="scene light"))
plotter.add_mesh(terrain, color="white", smooth_shading=True)
