"""The output of the scripts: pictures, their thumbnails, and interactive scenes.

PyVista's own scenes have the light of one eye, and its viewer fetches them, which browsers do not
allow for files on disk. Each scene is therefore a page of its own with light that follows the eye.
"""

from __future__ import annotations

import html
import json
import re
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import pyvista as pv
from PIL import Image, ImageOps, ImageSequence
from pyvista.plotting.utilities.sphinx_gallery import generate_images
from sphinx_gallery.scrapers import figure_rst, matplotlib_scraper
from vtkmodules.vtkRenderingAnnotation import vtkCornerAnnotation

import vizlight

#: Scripts with an interactive scene: views of meshes of a few megabytes.
INTERACTIVE = (
    "plot_winds", "plot_read_direction", "plot_principal_lines", "plot_satin", "plot_read_slope",
    "plot_read_heading", "plot_depth", "plot_read_shape", "plot_sky", "plot_read_value",
    "plot_carotid", "plot_terrain", "plot_bas_relief", "plot_seeping_light", "plot_codimension",
    "plot_complex_curve",
)  # fmt: skip
#: What the page of one view runs: it tells the others beside it how its camera was moved.
LINK = (Path(__file__).parent / "link.js").read_text("utf-8")

#: Sections of the gallery, their scripts, and what a reader who cannot see the pictures is told.
SECTIONS = {
    "Which way does it run?": {
        "plot_winds": "Globe of winds in hues of their direction, with arrows, coasts and a disc",
        "plot_read_direction": "Six globes: plain, arrows, LIC, lines, white light, and hues",
        "plot_principal_lines": "Gyroid, plain and engraved by lines of its curvature",
        "plot_satin": "Satin ball lit by its threads, with a highlight across them",
    },
    "How steep is it, and which end is near?": {
        "plot_read_slope": "Arch of nerve fibres: tan tubes, and pale to brown by slope",
        "plot_read_heading": "Arch of nerve fibres in hues of the near end, with their key",
        "plot_depth": "Thread wound on a ball, twice: bright all over, and fading with depth",
        "plot_fur": "Head and shoulders of a golden dog whose hair lies back",
    },
    "What is the shape?": {
        "plot_read_shape": "Folds of a brain in gray, and in hues of their slopes under a sky",
        "plot_sky": "Terrain, brain, coral and part: in gray, and in hues with dark folds",
        "plot_highlights": "Balls in six rows, with round highlights and some that wrap around",
        "plot_isoluminance": "Solids in bands of equal luminance between black contours",
    },
    "What is the value?": {
        "plot_read_value": "A surface in viridis and in a map of one lightness, with their bars",
        "plot_carotid": "Lines of blood by speed inside arteries of clear glass",
    },
    "How deep is the shadow?": {
        "plot_terrain": "Hawaii on a blue sea floor with shadows, a bar of heights, north, 100 km",
        "plot_terrain_day": "Ridges at five hours of a day, and the mean sunlight of each slope",
        "plot_bas_relief": "Relief of a dog under one moving light, and with deeper shadows",
        "plot_seeping_light": "Dog before a light, whose ears glow as if of wax",
    },
    "What is there in 4-space?": {
        "plot_codimension": "Eight tori and curves on tori, uncompensated and compensated",
        "plot_complex_curve": "Graph of a complex function at five steps of a turn",
    },
    "How does it move?": {
        "plot_turning": "Three tori of linked circles in six steps of a turn, bright across it",
        "plot_streaklines": "Smoke rolls up in vortices that drift to the right",
    },
}
#: Descriptions of the scripts, in the order of the gallery.
ALTS = {script: alt for scripts in SECTIONS.values() for script, alt in scripts.items()}
ORDER = list(ALTS)

#: Scripts whose thumbnail is made from the first picture; others have it from the last.
FIRST = (
    "plot_bas_relief", "plot_depth", "plot_highlights", "plot_principal_lines",
    "plot_read_direction", "plot_satin", "plot_seeping_light",
)  # fmt: skip

#: Part of a picture that its thumbnail shows: left, top, right and bottom as shares of 1. Other
#: thumbnails show the whole.
PARTS = {
    "plot_bas_relief": (0.03, 0.05, 0.47, 0.45),
    "plot_codimension": (0.0, 0.58, 0.5, 1.0),
    "plot_complex_curve": (0.67, 0.03, 1.0, 0.47),
    "plot_depth": (0.5, 0.09, 1.0, 0.96),
    "plot_highlights": (0.23, 0.06, 0.99, 0.37),
    "plot_isoluminance": (0.24, 0.56, 0.46, 1.0),
    "plot_principal_lines": (0.5, 0.07, 1.0, 1.0),
    "plot_read_direction": (0.6, 0.575, 0.87, 0.975),
    "plot_read_heading": (0.02, 0.06, 0.8, 0.92),
    "plot_read_shape": (0.44, 0.09, 0.88, 0.92),
    "plot_read_slope": (0.42, 0.11, 0.85, 0.94),
    "plot_read_value": (0.5, 0.1, 1.0, 0.82),
    "plot_satin": (0.5, 0.54, 1.0, 0.99),
    "plot_seeping_light": (0.55, 0.1, 0.95, 0.8),
    "plot_sky": (0.46, 0.58, 0.68, 0.98),
    "plot_turning": (0.68, 0.55, 1.0, 1.0),
    "plot_terrain_day": (0.61, 0.05, 0.89, 0.48),
}

#: Width of the thumbnails of movies in pixels.
MOVIE = 240


class Order:
    """Sort scripts in the order of ``ORDER``."""

    def __init__(self, folder):
        self.folder = folder

    def __repr__(self):
        return "<Order>"

    def __call__(self, name):
        return ORDER.index(Path(name).stem)


class _Export:
    """What PyVista exports scenes by: a page for each view of a plotter that has live light."""

    def __init__(self, plotter, wanted):
        self.plotter, self.wanted = plotter, wanted

    def export_vtksz(self, filename=None):  # noqa: ARG002 (as PyVista calls it)
        """Return titles and pages; PyVista takes an ImportError for what cannot be exported."""
        if not self.wanted:
            raise ImportError("this plotter has no interactive scene")
        with TemporaryDirectory() as folder:
            path = Path(folder) / "scene.html"
            pages = []
            for renderer in self.plotter.renderers:
                title = _title(renderer)
                if _export(self.plotter, renderer, path, title):
                    pages.append((title, path.read_text("utf-8")))
        if not pages:
            raise ImportError("no view has light of vizlight")
        return json.dumps(pages).encode()


def _export(plotter, renderer, path, title):
    """Write the page of one view; return whether it has light of vizlight."""
    views, figures = plotter.renderers, pv.plotting.plotter._ALL_PLOTTERS
    active, known = views.active_index, list(figures)
    views.set_active_renderer(*views.index_to_loc(list(views).index(renderer)))
    try:
        with warnings.catch_warnings():
            # Outlines and letters are left out.
            warnings.simplefilter("ignore")
            plotter.vizlight.export_html(path, title=title, panel=False)
    except ValueError:
        # The view shows light as it is kept with the mesh, such as that for an eye in 4-space.
        mappers = [one.mapper for one in renderer.actors.values() if isinstance(one, pv.Actor)]
        meshes = [getattr(m, "dataset", None) for m in mappers if m.GetScalarVisibility()]
        lit = [m for m in meshes if "luminance_provenance" in getattr(m, "array_names", ())]
        if not lit:
            return False
        look = {"camera": renderer.camera, "background": renderer.background_color}
        mesh = lit[0] if len(lit) == 1 else pv.MultiBlock(lit)
        vizlight.live_html(mesh, path, title=title, panel=False, **look)
    finally:
        views.set_active_renderer(*views.index_to_loc(active))
        for made in set(figures) - set(known):
            del figures[made]
    return True


def _title(renderer):
    """Return the text at the upper edge of a view."""
    texts = [prop for prop in renderer.actors.values() if isinstance(prop, pv.CornerAnnotation)]
    words = [text.GetText(vtkCornerAnnotation.UpperEdge) or "" for text in texts]
    return " ".join(" ".join(words).split())


def reset(_conf, script):
    """Write pages for the scripts that have interactive scenes."""
    pv.close_all()
    wanted = Path(script).stem in INTERACTIVE
    pv.Plotter._trame_component = lambda plotter: _Export(plotter, wanted)


def scrape(block, block_vars, gallery_conf):
    """Return reST for the pictures and scenes that a block of a script has drawn."""
    about = ALTS[Path(block_vars["src_file"]).stem]
    if plt.get_fignums():
        # The script shows a chart; what its study has drawn is not shown.
        pv.close_all()
        chart = matplotlib_scraper(block, block_vars, gallery_conf)
        return re.sub(r"(?<=:alt: )plot [\w ]+$", about, chart, flags=re.MULTILINE)
    figures = pv.plotting.plotter._ALL_PLOTTERS
    for name, plotter in [*figures.items()]:
        # What a measurement drew and closed is no picture of the script.
        if plotter.render_window is None and plotter.last_image is None:
            del figures[name]
    names = generate_images(block_vars["image_path_iterator"], dynamic=True)
    return "\n".join(_tabs(Path(name), Path(gallery_conf["src_dir"]), about) for name in names)


def _tabs(name, source, about):
    kind = ".gif" if name.suffix == ".gif" else ".png"
    picture = figure_rst([str(name.with_suffix(kind))], str(source), about)
    if name.suffix != ".vtksz":
        return picture
    scenes = source / "_static" / "scenes"
    scenes.mkdir(parents=True, exist_ok=True)
    pages = json.loads(name.read_text("utf-8"))
    name.unlink()
    frames = []
    for number, (title, page) in enumerate(pages):
        path = scenes / f"{name.stem}_{number}.html"
        path.write_text(page.replace("</body>", f"<script>{LINK}</script>\n</body>"), "utf-8")
        label = html.escape(f"{about}: {title}" if title else about, quote=True)
        frames.append(f'<iframe data-src="../_static/scenes/{path.name}" title="{label}"></iframe>')
    indented = "\n".join(f"      {line}" for line in picture.splitlines())
    return f"""
.. tab-set::

   .. tab-item:: Picture

{indented}

   .. tab-item:: Interactive scene

      .. raw:: html

         <div class="scene">{"".join(frames)}</div>

"""


def cut_thumbnails(app):
    """Make thumbnails from parts of the pictures, with a border in their colour; shrink movies."""
    folder = Path(app.srcdir) / "examples" / "images"
    size = app.config.sphinx_gallery_conf["thumbnail_size"]
    for script in ORDER:
        thumbnail = folder / "thumb" / f"sphx_glr_{script}_thumb.png"
        pictures = sorted(folder.glob(f"sphx_glr_{script}_[0-9]*.png"))
        if not thumbnail.exists() or not pictures:
            continue
        with Image.open(pictures[0 if script in FIRST else -1]) as whole:
            part = PARTS.get(script, (0, 0, 1, 1))
            ends = [x * side for x, side in zip(part, whole.size * 2, strict=True)]
            cut = whole.convert("RGB").crop([round(x) for x in ends])
        cut = ImageOps.pad(cut, size, color=cut.getpixel((1, 1)))
        # A third of the bytes; at the size of a thumbnail 256 colours look the same.
        cut.quantize(256, dither=Image.Dither.FLOYDSTEINBERG).save(thumbnail, optimize=True)
    for thumbnail in folder.glob("thumb/*.gif"):
        _shrink(thumbnail)


def cut_index(app):
    """Part the page of thumbnails into sections, and describe the thumbnails."""
    page = Path(app.srcdir) / "examples" / "index.rst"
    head, rest = page.read_text("utf-8").split(".. thumbnail-parent-div-open\n")
    tiles, foot = rest.split(".. thumbnail-parent-div-close\n")
    opened = head.rindex(".. raw:: html")
    grid, close = head[opened:], foot[: foot.index("</div>") + 6]
    found = {}
    for tile in tiles.split("\n\n\n"):
        if name := re.search(r"/examples/(\w+)`", tile):
            found[name[1]] = tile.replace(":alt:", f":alt: {ALTS[name[1]]}")
    parts = [
        "\n\n".join([title, "-" * len(title), grid, *map(found.get, scripts), close])
        for title, scripts in SECTIONS.items()
    ]
    text = "\n\n".join([head[:opened], *parts, foot[len(close) :]])
    page.write_text(text.replace("\n\n---", "\n---"), "utf-8")


def load_late(_app, _page, _template, context, _doctree):
    """Let browsers load pictures when they come near, all but the first."""
    first, image, rest = context.get("body", "").partition("<img ")
    context["body"] = first + image + rest.replace("<img ", '<img loading="lazy" ')


def _shrink(path):
    """Draw a movie as small as its thumbnail is shown; sphinx-gallery copies it as it is."""
    with Image.open(path) as movie:
        if movie.width <= MOVIE:
            return
        size = (MOVIE, round(movie.height * MOVIE / movie.width))
        frames = [frame.convert("RGB").resize(size) for frame in ImageSequence.Iterator(movie)]
        times = movie.info.get("duration", 100)
    # Every third frame, for three times the time.
    first, *rest = [frame.quantize(64) for frame in frames[::3]]
    first.save(path, save_all=True, append_images=rest, duration=3 * times, loop=0)


def setup(app):
    """Register with Sphinx, after the gallery is generated."""
    # What is drawn after the scripts, for the studies, needs no page.
    app.connect("builder-inited", lambda _: reset(None, ""))
    app.connect("builder-inited", cut_thumbnails, priority=900)
    app.connect("builder-inited", cut_index, priority=900)
    app.connect("html-page-context", load_late)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
