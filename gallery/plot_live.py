"""
Light that follows the camera
=============================

Blood flow in the carotid arteries: an isosurface of the scan, coloured by the speed of the flow
and lit by one lamp, while the camera goes around it. ``plotter.vizlight.add_mesh`` keeps the light
right for each frame: the highlights stay where lamp and eye put them instead of turning with the
vessels, and colours, nan colours and the scalar bar are those of ``plotter.add_mesh``. In a window
or a notebook the same lines follow the mouse; ``mesh.vizlight.plot(scalars="speed")`` is their
short form.

The light is computed in each fragment, from normals and tangents that the graphics card
interpolates. ``light="points"`` computes it at the points, for every manifold, bit by bit as the
filters do.

The data are downloaded. If they are not available, the flow over a rotating disk is used instead.
"""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pyvista as pv

from vizlight import Light, Material, Scene

try:
    flow = pv.examples.download_carotid()
    surface, name, seen = flow.contour([200], scalars="scalars"), "vectors", (0.2, -1, 0.25)
except Exception as error:  # noqa: BLE001 (a missing network raises many types)
    import vizlight

    print(f"carotid not available ({type(error).__name__}): using a rotating disk")
    surface = vizlight.load_example().contour([600], scalars="Temp")
    name, seen = "V", (1, 0.5, 0.3)

# Small pieces are noise of the scan.
surface = surface.extract_largest()
surface["speed"] = np.linalg.norm(surface[name], axis=1)
scene = Scene(
    lights=[Light(direction=(-0.6, -1, 0.8)), Light.headlight(intensity=0.4)],
    material=Material(ambient=0.2, diffuse=0.8, specular=0.5, shininess=30),
)

plotter = pv.Plotter(off_screen=True, window_size=(480, 440))
plotter.background_color = "black"
plotter.vizlight.add_mesh(
    surface,
    scene=scene,
    scalars="speed",
    cmap="viridis",
    scalar_bar_args={"color": "white", "n_labels": 3, "fmt": "%.0f", "vertical": True},
)
plotter.view_vector(seen)
plotter.camera.zoom(1.2)
plotter.open_gif(Path(mkdtemp()) / "turning.gif", fps=12)
for _ in range(36):
    plotter.camera.azimuth += 10
    plotter.write_frame()
plotter.show()
