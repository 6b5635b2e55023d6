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


def plain(names, fill, place=(0, 0)):
    """Return a plain plotter with what a function adds, seen as a panel of a script, and an actor.

    Parameters
    ----------
    names : dict
        Names of the script.
    fill : callable
        Function that adds to the plotter, and returns an actor or None.
    place : (int, int)
        Row and column of the panel.
    """
    ours = names["plotter"]
    ours.subplot(*place)
    plotter = pv.Plotter(off_screen=True, window_size=ours.renderer.GetSize(), border=False)
    plotter.background_color = ours.background_color
    plotter.camera = ours.camera
    actor = fill(plotter)
    plotter.enable_anti_aliasing("ssaa")
    return plotter, actor


def read(plotter, mesh=None, key=None, **how):
    """Return what the meter reads of the picture of a plotter, in a column of print.

    A mesh and a key are for what the plotter does not know of its picture.
    """
    if mesh is None:
        return plotter.vizlight.legibility()
    return vizlight.legibility(
        mesh, picture=kept.panel(plotter), camera=plotter.camera, key=key, **how
    )


def figure_of(figure, name, times=1.0):
    """Return an error, or a correlation, of what is read; a word where nothing is."""
    return "unreadable" if figure.unreadable else times * getattr(figure, name)


def bare(mesh):
    """Return a mesh without arrays."""
    mesh = mesh.copy()
    mesh.clear_data()
    return mesh


def winds():
    """Compare the light of direction and lines with arrows."""
    names, picture = drawn("winds")

    def fill(plotter):
        plotter.add_mesh(names["air"].scale(0.995), color="lightsteelblue", smooth_shading=True)
        strokes.arrows(0.045, plotter)

    beside, _ = plain(names, fill)
    figures = [figure_of(read(each).direction, "median") for each in (names["plotter"], beside)]
    return *figures, picture, None


def tubes(name, radius, question, figure, place):
    """Compare lines with PyVista's tubes as wide, whose light is the mean over their width."""
    names, picture = drawn(name)
    lines = bare(names["fibres"])
    beside, actor = plain(
        names,
        lambda plotter: plotter.add_mesh(
            lines.tube(radius=radius), color="tan", smooth_shading=True
        ),
        place,
    )
    key = Scene.from_plotter(beside, actor=actor)
    of_tubes = read(beside, lines, key, line_diameter=2 * radius, model="cylinder")
    figures = [
        figure_of(getattr(each, question), figure) for each in (read(names["plotter"]), of_tubes)
    ]
    return *figures, picture, None


def cortex():
    """Compare the light of shape and sky with smooth shading."""
    names, picture = drawn("read_shape")
    mesh, own = names["cortex"], names["plotter"]
    light = read(own, mesh, names["scene"]).shape
    own.subplot(0, 0)
    smooth = read(own, mesh, names["plain"], feature_angle=None).shape
    return figure_of(light, "median"), figure_of(smooth, "median"), picture, None


def islands():
    """Compare sun, blue light and sky with smooth shading."""
    names, picture = drawn("terrain")
    ends = (-5800, 2860)
    look = {"cmap": names["tints"], "clim": ends, "show_scalar_bar": False}
    ground = names["ground"]
    beside, actor = plain(
        names,
        lambda plotter: plotter.add_mesh(ground, scalars="elevation", smooth_shading=True, **look),
    )
    shown = bare(ground)
    shown["elevation"] = ground["elevation"]
    colors = {"scalars": "elevation", "feature_angle": None}
    figures = [
        figure_of(read(each, shown, [scene, (names["tints"], ends)], **colors).shape, "median")
        for each, scene in (
            (names["plotter"], names["scene"]), (beside, Scene.from_plotter(beside, actor=actor)),
        )
    ]  # fmt: skip
    return *figures, picture, kept.panel(beside)


def blood():
    """Compare lines in colours of one lightness with tubes in viridis."""
    names, picture = drawn("carotid")

    def fill(plotter):
        wide = names["blood"].tube(radius=0.12)
        plotter.add_mesh(
            wide, scalars="speed", cmap="viridis", smooth_shading=True, show_scalar_bar=False
        )
        plotter.add_mesh(bare(names["vessel"]), color="white", opacity=0.15, smooth_shading=True)
        plotter.enable_depth_peeling(8)

    beside, _ = plain(names, fill)
    figures = [figure_of(read(each).value, "p95", 100) for each in (names["plotter"], beside)]
    return *figures, picture, kept.panel(beside)


def six():
    """Compare the panel of the light of direction with that of VTK's LIC."""
    names, picture = drawn("read_direction")
    figures = []
    for place in ((1, 2), (0, 2)):
        names["plotter"].subplot(*place)
        figures.append(figure_of(read(names["plotter"]).direction, "median"))
    return *figures, picture, None


def circles():
    """Compare light in 4-space with tubes in 3-space: lightness and slope in 4-space."""
    names, picture = drawn("turning")
    eye = np.array(names["eye"].direction)
    steep = np.abs(np.asarray(names["lit"]["frame"]) @ eye) / np.linalg.norm(eye)
    lines = bare(names["lit"])
    lines["torus"] = names["fibres"]["torus"]
    look = {"cmap": ["#74adfe", "#f689b3", "#cba656"], "show_scalar_bar": False}
    beside, actor = plain(
        names,
        lambda plotter: plotter.add_mesh(
            lines.tube(radius=0.0165), scalars="torus", smooth_shading=True, **look
        ),
    )
    light = lit_as_tubes(lines, beside, actor)
    figures = [spearmanr(made["luminance"], steep)[0] for made in (names["lit"], light)]
    return *figures, picture, kept.panel(beside)


def lit_as_tubes(lines, plotter, actor):
    """Return lines with the light of an actor, as the mean over the width of a tube."""
    scene = Scene.from_plotter(plotter, actor=actor)
    view = View.from_camera(plotter.camera)
    return vizlight.illuminate(bare(lines), scene.replace(view=view), model="cylinder")


def hair():
    """Compare hairs with tubes on the skin; each is read against its own direction."""
    names, picture = drawn("fur")
    dog, fibres = names["dog"], names["coat"]["fibres"]
    normals = np.asarray(dog.point_data["Normals"])
    way = np.asarray(dog["lie"])
    way = way - np.sum(way * normals, axis=1, keepdims=True) * normals
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
    dog["hair"] = (way + 0.3 * normals) * np.asarray(dog["length"])[:, np.newaxis]
    line = pv.Line((0, 0, 0), (1, 0, 0))
    made = bare(dog.subdivide(1).glyph(orient="hair", scale="hair", geom=line))

    def fill(plotter):
        plotter.add_mesh(bare(dog), color="peru", smooth_shading=True)
        plotter.add_mesh(
            made.tube(radius=0.0007, n_sides=5), color="burlywood", smooth_shading=True
        )

    beside, _ = plain(names, fill)
    figures = [
        figure_of(read(plotter, pv.MultiBlock([bare(dog), mesh]), [], **wide).direction, "median")
        for plotter, mesh, wide in (
            (names["plotter"], bare(fibres), {}), (beside, made, {"line_diameter": 0.0014}),
        )
    ]  # fmt: skip
    return *figures, picture, kept.panel(beside)


def tori():
    """Compare the contrast of a curve in 4-space with that of tubes in 3-space."""
    names, picture = drawn("codimension")
    # The curve alone, without the torus below it.
    shown = names["panels"][5].mesh[1]
    curve = bare(shown)
    beside, actor = plain(
        names,
        lambda plotter: plotter.add_mesh(
            curve.tube(radius=0.018), color="white", smooth_shading=True
        ),
    )
    tube = lit_as_tubes(curve, beside, actor)["luminance"]
    figures = [float(np.std(x) / np.mean(x)) for x in (shown["luminance"], tube)]
    return *figures, picture, kept.panel(beside)


#: Scripts, questions, figures with their units, and what compares them, in the order of the page.
PICTURES = {
    "winds": ("which way on the screen?", "median error, degrees", winds),
    "read_slope": (
        "how steep are fibres?", "rank correlation with lightness",
        lambda: tubes("read_slope", 0.1, "slope", "spearman", (0, 1)),
    ),
    "read_heading": (
        "which end is near?", "median error in space, degrees",
        lambda: tubes("read_heading", 0.105, "heading", "median", (0, 0)),
    ),
    "read_shape": ("what is the shape?", "median error of the normal, degrees", cortex),
    "terrain": ("what is the shape?", "median error of the normal, degrees", islands),
    "carotid": ("what is the speed?", "95 % of the errors, % of the range", blood),
    "read_direction": ("which way on the screen?", "median error, degrees", six),
    "turning": ("how steep, in 4-space?", "rank correlation with lightness", circles),
    "fur": ("which way lies the hair?", "median error, degrees", hair),
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
