"""Ten pictures of the gallery beside PyVista's best in ten lines.

``python gallery/pages/peers/plain.py`` runs each script of the gallery, draws the same data by
PyVista alone with the same camera, size and background, and asks the same meter of both. It writes
the figures to ``plain.csv`` and pairs of pictures as ``plain_NAME.webp`` beside this file.
"""

from __future__ import annotations

import csv
import runpy
import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image
from scipy.stats import spearmanr

HERE = Path(__file__).resolve().parent
GALLERY = HERE.parents[1]
sys.path[:0] = [str(GALLERY), str(HERE.parent)]
from peers import kept  # noqa: E402

import vizlight  # noqa: E402
from studies import strokes  # noqa: E402
from vizlight import Scene, View  # noqa: E402

TABLE = HERE / "plain.csv"
COLUMNS = ("picture", "question", "figure", "vizlight", "PyVista", "lines of the script")
HEIGHT = 520


def drawn(name):
    """Run a script of the gallery; return its names and its last picture."""
    pv.Plotter.show = lambda plotter, **_: plotter.render()
    names = runpy.run_path(str(GALLERY / f"plot_{name}.py"))
    return names, names["plotter"].screenshot(return_img=True)


def plain(names, fill):
    """Return the scene of what a function adds to a plain plotter, and the picture."""
    own = names["plotter"]
    plotter = pv.Plotter(off_screen=True, window_size=own.window_size)
    plotter.background_color = own.background_color
    plotter.camera = own.camera
    actor = fill(plotter)
    plotter.enable_anti_aliasing("ssaa")
    picture = plotter.screenshot(return_img=True)
    return Scene.from_plotter(plotter, actor=actor), picture


def asked(mesh, scene, names, **options):
    """Return what the meter finds of a mesh in the view of a script."""
    return vizlight.legibility(mesh, scene, view=names["plotter"].camera, **options)


def told(figure, name, times=1.0):
    """Return an error, or a correlation, of what is read; a word where nothing is."""
    return "unreadable" if figure.unreadable else times * getattr(figure, name)


def bare(mesh):
    """Return a mesh without arrays."""
    mesh = mesh.copy()
    mesh.clear_data()
    return mesh


def winds():
    """Compare the light of direction with arrows, read as strokes."""
    names, picture = drawn("winds")
    lit = asked(names["air"], names["scene"], names, tangents="wind", exponent=2).direction
    (row,) = strokes.measure("arrows", 0.045, lambda plotter: strokes.arrows(0.045, plotter))
    return told(lit, "median"), row.error, picture, None


def tubes(name, radius, question, figure):
    """Compare lines with PyVista's tubes as wide, whose light is the mean over their width."""
    names, picture = drawn(name)
    lines = bare(names["fibres"])
    scene, beside = plain(
        names,
        lambda plotter: plotter.add_mesh(
            lines.tube(radius=radius), color="tan", smooth_shading=True
        ),
    )
    wide = {"line_diameter": 2 * radius}
    found = [
        told(getattr(asked(lines, light, names, **wide, **options), question), figure)
        for light, options in ((names["scene"], {}), (scene, {"model": "cylinder"}))
    ]
    return *found, picture, beside


def cortex():
    """Compare the light of shape and sky with smooth shading."""
    names, picture = drawn("read_shape")
    found = [
        told(asked(mesh, light, names).shape, "median")
        for mesh, light in ((names["lit"], names["scene"]), (names["cortex"], names["plain"]))
    ]
    return *found, picture, None


def islands():
    """Compare sun, blue light and sky with smooth shading."""
    names, picture = drawn("terrain")
    look = {"cmap": names["tints"], "clim": (-5800, 2860), "show_scalar_bar": False}
    ground = names["ground"]
    scene, beside = plain(
        names,
        lambda plotter: plotter.add_mesh(ground, scalars="elevation", smooth_shading=True, **look),
    )
    shown = bare(ground)
    shown["elevation"] = ground["elevation"]
    colors = {"scalars": "elevation", "cmap": look["cmap"], "clim": look["clim"]}
    found = [
        told(asked(shown, light, names, **colors).shape, "median")
        for light in (names["scene"], scene)
    ]
    return *found, picture, beside


def blood():
    """Compare lines in colours of one lightness with tubes in viridis."""
    names, picture = drawn("carotid")
    made = names["blood"].tube(radius=0.12)
    look = {"scalars": "speed", "cmap": "viridis"}

    def fill(plotter):
        actor = plotter.add_mesh(made, smooth_shading=True, show_scalar_bar=False, **look)
        plotter.add_mesh(bare(names["vessel"]), "white", opacity=0.15, smooth_shading=True)
        plotter.enable_depth_peeling(8)
        return actor

    scene, beside = plain(names, fill)
    wide = {"line_diameter": 0.24}
    found = [
        told(asked(mesh, light, names, **how).value, "p95", 100)
        for mesh, light, how in (
            (names["blood"], Scene(), {"scalars": "speed", **wide}), (made, scene, look),
        )
    ]  # fmt: skip
    return *found, picture, beside


def six():
    """Take the figures of the study of strokes: the light of direction, and VTK's best, LIC."""
    _, picture = drawn("read_direction")
    (lic,) = strokes.measure("LIC", 20, lambda plotter: strokes.lic(20, plotter))
    (lit,) = strokes.lit("light", vizlight.presets.direction())
    return lit.error, lic.error, picture, None


def circles():
    """Compare light in 4-space with tubes in 3-space: lightness and slope in 4-space."""
    names, picture = drawn("turning")
    eye = np.array(names["eye"].direction)
    steep = np.abs(np.asarray(names["lit"]["frame"]) @ eye) / np.linalg.norm(eye)
    lines = bare(names["lit"])
    lines["torus"] = names["fibres"]["torus"]
    look = {"cmap": ["#74adfe", "#f689b3", "#cba656"], "show_scalar_bar": False}
    scene, beside = plain(
        names,
        lambda plotter: plotter.add_mesh(
            lines.tube(radius=0.0165), scalars="torus", smooth_shading=True, **look
        ),
    )
    view = View.from_camera(names["plotter"].camera)
    light = vizlight.illuminate(bare(lines), scene.replace(view=view), model="cylinder")
    found = [spearmanr(made["luminance"], steep)[0] for made in (names["lit"], light)]
    return *found, picture, beside


def hair():
    """Compare hairs with tubes on the skin; each is read against its own direction."""
    names, picture = drawn("fur")
    dog, camera, size = names["dog"], names["camera"], names["plotter"].window_size
    fibres = names["coat"]["fibres"].copy()
    points = np.asarray(fibres.points).reshape(-1, 7, 3)
    fibres["way"] = np.gradient(points, axis=1).reshape(-1, 3)
    normals = np.asarray(dog.point_data["Normals"])
    way = np.asarray(dog["lie"])
    way = way - np.sum(way * normals, axis=1, keepdims=True) * normals
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
    dog["hair"] = (way + 0.3 * normals) * np.asarray(dog["length"])[:, np.newaxis]
    line = pv.Line((0, 0, 0), (1, 0, 0))
    made = dog.subdivide(1).glyph(orient="hair", scale="hair", geom=line)
    ends = np.asarray(made.points).reshape(-1, 2, 3)
    made["way"] = np.repeat(ends[:, 1] - ends[:, 0], 2, axis=0)

    def fill(plotter):
        plotter.add_mesh(bare(dog), "peru", smooth_shading=True)
        return plotter.add_mesh(
            bare(made).tube(radius=0.0007, n_sides=5), "burlywood", smooth_shading=True
        )

    _, beside = plain(names, fill)
    found = [
        strokes.read_off(np.asarray(image, float), strokes.ways(mesh, "way", camera, size), 3)
        for image, mesh in ((picture, fibres), (beside, made))
    ]
    return *found, picture, beside


def tori():
    """Compare the contrast of a curve in 4-space with that of tubes in 3-space."""
    names, picture = drawn("codimension")
    # The curve alone, without the torus below it.
    shown = names["panels"][5].mesh[1]
    curve = bare(shown)
    scene, beside = plain(
        names,
        lambda plotter: plotter.add_mesh(curve.tube(radius=0.018), "white", smooth_shading=True),
    )
    view = View.from_camera(names["plotter"].camera)
    tube = vizlight.illuminate(curve, scene.replace(view=view), model="cylinder")["luminance"]
    found = [float(np.std(x) / np.mean(x)) for x in (shown["luminance"], tube)]
    return *found, picture, beside


#: Scripts, questions, figures with their units, and what compares them, in the order of the page.
PICTURES = {
    "winds": ("which way on the screen?", "median error, degrees", winds),
    "read_slope": (
        "how steep are fibres?", "rank correlation with lightness",
        lambda: tubes("read_slope", 0.11, "slope", "spearman"),
    ),
    "read_heading": (
        "which end is near?", "median error in space, degrees",
        lambda: tubes("read_heading", 0.11, "heading", "median"),
    ),
    "read_shape": ("what is the shape?", "median error of the normal, degrees", cortex),
    "terrain": ("what is the shape?", "median error of the normal, degrees", islands),
    "carotid": ("what is the speed?", "95 % of the errors, % of the range", blood),
    "read_direction": ("which way on the screen?", "median error, degrees", six),
    "turning": ("how steep, in 4-space?", "rank correlation with lightness", circles),
    "fur": ("which way lies the hair?", "median error of strokes, degrees", hair),
    "codimension": ("how bright is a curve?", "contrast of its light", tori),
}  # fmt: skip
#: Pictures of which a pair is kept.
PAIRS = ("terrain", "carotid", "turning", "fur", "codimension")


def keep(name, *pictures):
    """Write PyVista's picture and ours side by side."""
    shown = []
    for picture in pictures:
        whole = Image.fromarray(picture).convert("RGB")
        shown.append(whole.resize((HEIGHT * whole.width // whole.height, HEIGHT)))
    kept.side_by_side(f"plain_{name}", ("PyVista", "vizlight"), shown)


def main():
    """Do what the docstring of this file says."""
    rows = []
    for name, (question, figure, compare) in PICTURES.items():
        ours, theirs, picture, beside = compare()
        if name in PAIRS:
            keep(name, beside, picture)
        lines = kept.code_lines(GALLERY / f"plot_{name}.py")
        figures = [x if isinstance(x, str) else f"{x:.2g}" for x in (ours, theirs)]
        rows.append((f":doc:`examples/plot_{name}`", question, figure, *figures, lines))
        print(*rows[-1], sep=", ")
        pv.close_all()
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows])


if __name__ == "__main__":
    main()
