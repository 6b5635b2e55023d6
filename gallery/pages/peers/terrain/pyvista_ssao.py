"""PyVista: ambient occlusion (SSAO)."""

import pyvista as pv

terrain = pv.read("terrain.vti").warp_by_scalar("height")
plotter = pv.Plotter(lighting="none")
plotter.add_light(pv.Light(position=(-0.66, 0.66, 0.36), light_type="scene light"))
plotter.add_mesh(terrain, color="white", smooth_shading=True, ambient=0.3, diffuse=0.7)
plotter.enable_ssao(radius=2000, bias=20, kernel_size=128)
