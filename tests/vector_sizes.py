"""Sizes, seconds and errors of vector figures, as a table: ``python tests/vector_sizes.py``.

The pictures are drawn again by ``rsvg-convert`` of Debian's ``librsvg2-bin`` and by Chromium, and
compared with those of the plotters.
"""

import re
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import Block, Frustum, Scene, Sphere
from vizlight.draw.vector.lines import lines_of
from vizlight.draw.vector.samples import enlarged, samples_of
from vizlight.draw.vector.words import words_of
from vizlight.mesh.creases import creases


def plain(mesh, **options):
    """Return a plotter with grey light on a mesh."""
    plotter = pv.Plotter(off_screen=True, window_size=(1200, 800))
    plotter.background_color = "white"
    plotter.enable_anti_aliasing("msaa", multi_samples=8)
    plotter.vizlight.add_mesh(mesh, scene=Scene(), **options)
    return plotter


def solid():
    """Return a solid of primitives."""
    return vizlight.to_polydata(
        (Sphere() | Block((0, 0, -1), (1.6, 1.6, 1))) - Frustum(axis=(0, 0, 4), radii=(0.4, 0.4))
    )


def edged():
    """Return a plotter with a solid of primitives and its edges."""
    plotter = plain(solid())
    plotter.add_mesh(creases(solid()), color="black", line_width=2, lighting=False)
    return plotter


def valued(mesh, values, cmap):
    """Return a plotter with colours of values and light on a mesh."""
    mesh["values"] = values
    return plain(mesh, scalars="values", cmap=cmap, show_scalar_bar=False)


def waves():
    """Return a sheet of waves in the colours of their heights."""
    sheet = pv.Plane(i_size=6, j_size=4, i_resolution=300, j_resolution=200)
    x, y = sheet.points[:, :2].T
    height = np.sin(2 * x) * np.cos(3 * y) * np.exp(-(x**2 + y**2) / 6)
    sheet.points[:, 2] = 0.5 * height
    return valued(sheet, height, "coolwarm")


def torus(question):
    """Return the look of a torus around which vectors run in waves."""
    mesh = pv.ParametricTorus(ringradius=1, crosssectionradius=0.45)
    x, y, _ = mesh.points.T
    mesh["way"] = np.stack([-y, x, np.sin(6 * np.arctan2(y, x))], axis=1)
    return vizlight.look(mesh, question).plotter()


def look(name, *question):
    return vizlight.look(vizlight.load_example(name), *question).plotter()


SCENES = {
    "solid of primitives, grey light": lambda: plain(solid()),
    "solid and its edges": edged,
    "dog, grey light": lambda: plain(vizlight.load_example("dog.vtp")),
    "ball of 10^6 triangles, grey light": lambda: plain(
        pv.Sphere(theta_resolution=708, phi_resolution=708)
    ),
    "solid, colours of values": lambda: valued(solid(), solid().points[:, 2], "viridis"),
    "waves, diverging colours": waves,
    "torus, hues of directions": lambda: torus("direction"),
    "torus, lines of a flow": lambda: torus("flow"),
    "hawaii, heights and shadows": lambda: look("hawaii.vti"),
    "dog, coloured light": lambda: look("dog.vtp"),
    "brain, coloured light": lambda: look("brain.vti"),
    "fault, relief": lambda: look("jacksboro_fault.vti"),
    "earth, map of heights": lambda: look("earth_relief.vti"),
    "winds, values and strokes": lambda: look("winds_of_july.vtp"),
    "carotid, lines of a flow": lambda: look("carotid.vti", "flow"),
    "fibres, lines with halos": lambda: look("fibre_bundle.vtp"),
}


def drawn(path, renderer):
    """Return the picture of an SVG file by an independent renderer."""
    png = path.with_suffix(f".{renderer}.png")
    if renderer == "rsvg-convert":
        command = [renderer, path, "-o", png]
    else:
        page = path.with_suffix(".html")
        page.write_text(f'<body style="margin:0"><img src="{path.name}">')
        command = [
            renderer, "--headless", "--no-sandbox", "--hide-scrollbars", "--window-size=1200,900",
            f"--screenshot={png}", page.as_uri(),
        ]  # fmt: skip
    subprocess.run(command, check=True, capture_output=True)
    return np.asarray(Image.open(png).convert("RGB")).astype(int)[:800]


def smoothed(plotter, scale):
    """Return the picture of a plotter as the means of its samples, some along a pixel."""
    lines = lines_of(plotter, plotter.vizlight._live_of)
    with enlarged(plotter, scale, []):
        for each in lines:
            each.actor.GetProperty().SetLineWidth(scale * each.width)
        colors = samples_of(plotter).colors
    rows, columns = (side // scale for side in colors.shape[:2])
    return colors.reshape(rows, scale, columns, scale, -1).mean(axis=(1, 3))


def row(name, folder):
    """Return size, seconds, kind, error, mean difference, and shares of pixels within the error.

    The last share is that of the plotter's own picture from the means of its samples.

    Words are left out of the comparison, as renderers have other letters.
    """
    plotter = SCENES[name]()
    plotter.screenshot(return_img=True)
    path = folder / "figure.svg"
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        plotter.vizlight.save_graphic(path)
    seconds = time.process_time() - begin
    for prop in words_of(plotter)[1]:
        prop.SetVisibility(False)
    picture = np.asarray(plotter.screenshot(return_img=True)).astype(int)
    other = smoothed(plotter, 4)
    plotter.close()
    text = path.read_text()
    kind = re.search(r"<desc>\d* ?(.*?),? ", text).group(1)
    found = re.search(r"within ([\d.]+) of", text)
    error = float(found.group(1)) if found else 0.0
    bare = folder / "bare.svg"
    bare.write_text(re.sub(r'(?s)<g id="words">.*</g>', "", text))
    away = [
        np.abs(drawn(bare, each) - picture).max(axis=2) for each in ("rsvg-convert", "chromium")
    ]
    return (
        f"{path.stat().st_size / 1000:.0f} kB",
        f"{seconds:.1f} s",
        kind,
        f"{error:.1f}" if found else "none",
        f"{away[0].mean():.2f}",
        *(f"{np.mean(each <= error + 1):.2%}" for each in away),
        f"{np.mean(np.abs(other - picture).max(axis=2) <= error + 1):.2%}",
    )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        for name in sys.argv[1:] or SCENES:
            print(name, *row(name, Path(made)), sep=" | ", flush=True)
