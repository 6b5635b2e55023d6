"""The scene and the pictures of the first page: what a look makes of data of seven kinds.

``python gallery/pages/_front.py`` joins the pictures to that of README, ``gallery/looks.jpg``.
"""

from __future__ import annotations

import base64
import re
import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import Frustum, Material, Scene, render
from vizlight.draw import html

#: Names of pictures, and of the data that they show; the part is a solid.
LOOKS = {
    "winds": "winds_of_july.vtp",
    "flow": "rotating_disk.vtu",
    "terrain": "jacksboro_fault.vti",
    "tracts": "fibre_bundle.vtp",
    "brain": "brain.vti",
    "earth": "earth_relief.vti",
    "part": "",
}
SIZE = (600, 400)
#: The scene: size of its picture, eye, and background, the same on light and on dark pages.
WIDE, EYE, NIGHT = (1152, 480), (0.42, 1, 0.25), "#12141a"
#: What the page of the scene tells the page around it, which then shows it in place of the picture.
READY = "addEventListener('vizlight-ready', () => parent.postMessage('vizlight-ready', '*'));"


def write(app):
    """Write the pictures and the scenes."""
    folder = Path(app.srcdir) / "guide" / "pictures" / "front"
    folder.mkdir(parents=True, exist_ok=True)
    scenes = Path(app.srcdir) / "_static" / "scenes"
    scenes.mkdir(parents=True, exist_ok=True)
    for name in LOOKS.keys() - {"earth"}:  # which README alone shows
        look = vizlight.look(_data(name), size=SIZE)
        look.save(folder / f"{name}.jpg")
        look.save(scenes / f"{name}.html")
    pv.close_all()
    page = scenes / "front.html"
    _divide(page)
    text = page.read_text("utf-8")
    still = re.search(r'id="picture"[^>]*base64,([^"]+)', text)[1]
    (folder / "divided.jpg").write_bytes(base64.b64decode(still))
    page.write_text(text.replace("</body>", f"<script>{READY}</script>\n</body>"), "utf-8")


def _divide(path):
    """Write the page of winds as PyVista draws them, left, and as a look does, right."""
    wind, coast = map(vizlight.load_example, (LOOKS["winds"], "coasts.vtp"))
    look = vizlight.look(wind, size=WIDE, background=NIGHT, key=False)
    plotter = look.plotter()
    globe, right = next(iter(plotter.actors.values())), len(plotter.vizlight.shown())
    plotter.vizlight.add_mesh(
        wind, scalars="wind", cmap="viridis", scalar_bar_args={"title": "wind"}
    )
    left = len(plotter.vizlight.shown())
    plotter.add_scalar_bar("speed, m/s", mapper=globe.mapper)
    east, north = np.radians(np.asarray(coast.points, dtype=float)[:, :2].T)
    ball = np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)
    coast.points = 1.001 * np.stack(ball, axis=1)
    even = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
    thin = {"color": "#7d6a52", "line_width": 1.2, "halo": False, "light": "points"}
    plotter.vizlight.add_mesh(coast, scene=even, **thin)
    plotter.camera = render.camera_on(wind.bounds, EYE, aspect=WIDE[0] / WIDE[1], zoom=1.62)
    plotter.enable_anti_aliasing("ssaa")
    shown = [
        mesh._replace(frame=1 if i < right else 0 if i < left else None)
        for i, mesh in enumerate(plotter.vizlight.shown())
    ]
    names = ("PyVista | vizlight", ("PyVista", "vizlight"))
    html.write_page(path, shown, plotter, frames=names)


def _data(name):
    """Return the data of a picture."""
    if LOOKS[name]:
        return vizlight.load_example(LOOKS[name])
    plate = Frustum((0, 0, 0.14), (0, 0, 0.28), (1.4, 1.4))
    solid = plate | Frustum((0, 0, 0.55), (0, 0, 1.1), (0.55, 0.7))
    bores = [((0, 0, 0), 0.36)]
    bores += [((1.05 * np.cos(a), 1.05 * np.sin(a), 0), 0.13) for a in np.arange(6) * np.pi / 3]
    for center, radius in bores:
        solid -= Frustum(center, (0, 0, 4), (radius, radius))
    mesh = vizlight.to_polydata(solid)
    mesh.clear_data()
    return mesh


def _join(path):
    """Write one picture of the first six."""
    width, height = SIZE
    sheet = Image.new("RGB", (3 * width, 2 * height))
    with tempfile.TemporaryDirectory() as folder:
        for i, name in enumerate([*LOOKS][:6]):
            place = Path(folder) / f"{name}.png"
            vizlight.look(_data(name), size=(900, 600)).save(place)
            with Image.open(place) as picture:
                small = picture.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)
            sheet.paste(small, (i % 3 * width, i // 3 * height))
    sheet.save(path, quality=88)


def setup(app):
    """Register with Sphinx: after the guide, which empties the folder of pictures."""
    app.connect("builder-inited", write, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    _join(Path(__file__).parents[1] / "looks.jpg")
