"""The output of the scripts: pictures, their thumbnails, and interactive scenes.

PyVista's own scenes have the light of one eye, and its viewer fetches them, which browsers do not
allow for files on disk. Each scene is therefore a page of its own with light that follows the eye.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import pyvista as pv
from PIL import Image, ImageOps
from pyvista.plotting.utilities.sphinx_gallery import generate_images
from sphinx_gallery.scrapers import figure_rst, matplotlib_scraper

#: Scripts with an interactive scene: one view of one mesh, of a few megabytes.
INTERACTIVE = ("plot_flow", "plot_winds", "plot_complex_curve")

# Lines and flows, then surfaces, terrain, 4-space, formulas and their errors; scripts that are not
# listed come last.
ORDER = [
    "plot_winds", "plot_flow", "plot_live", "plot_lines", "plot_bundle",
    "plot_principal_lines", "plot_streaklines", "plot_tubes", "plot_satin", "plot_fur",
    "plot_ambient", "plot_depth_cue", "plot_attenuation",
    "plot_terrain_day", "plot_terrain", "plot_earth", "plot_bas_relief", "plot_seeping_light",
    "plot_codimension", "plot_turning", "plot_complex_curve", "plot_shapes",
    "plot_field_in_4_space", "plot_highlights", "plot_highlights_shapes", "plot_highlight_error",
    "plot_isoluminance", "plot_isoluminance_painter", "plot_line_models", "plot_errors",
    "plot_tolerance", "plot_isoluminance_speed",
]  # fmt: skip

#: Part of a wide picture that its thumbnail shows: left, top, right and bottom as shares of 1.
PARTS = {
    "plot_bas_relief": (0.01, 0.045, 0.325, 0.46),
    "plot_codimension": (0.25, 0.6, 0.5, 1.0),
    "plot_complex_curve": (0.1, 0.05, 0.9, 1.0),
    "plot_depth_cue": (0.67, 0.06, 1.0, 0.5),
    "plot_earth": (0.02, 0.1, 0.48, 0.9),
    "plot_errors": (0.0, 0.0, 0.5, 1.0),
    "plot_field_in_4_space": (0.667, 0.07, 1.0, 1.0),
    "plot_highlight_error": (0.0, 0.2, 0.45, 0.9),
    "plot_highlights": (0.15, 0.06, 0.9, 0.5),
    "plot_highlights_shapes": (0.0, 0.08, 0.5, 0.92),
    "plot_isoluminance": (0.25, 0.56, 0.5, 1.0),
    "plot_isoluminance_speed": (0.0, 0.0, 0.51, 1.0),
    "plot_line_models": (0.0, 0.0, 0.47, 1.0),
    "plot_lines": (0.5, 0.05, 1.0, 1.0),
    "plot_principal_lines": (0.5, 0.0, 1.0, 1.0),
    "plot_seeping_light": (0.67, 0.06, 1.0, 0.75),
    "plot_shapes": (0.2, 0.07, 0.4, 1.0),
    "plot_terrain_day": (0.37, 0.05, 0.63, 0.49),
    "plot_tolerance": (0.0, 0.2, 0.335, 0.78),
    "plot_tubes": (0.37, 0.08, 1.0, 0.95),
    "plot_turning": (0.4, 0.06, 0.61, 0.5),
}


class Order:
    """Sort scripts in the order of ``ORDER``."""

    def __init__(self, folder):
        self.folder = folder

    def __repr__(self):
        return "<Order>"

    def __call__(self, name):
        stem = Path(name).stem
        return (ORDER.index(stem) if stem in ORDER else len(ORDER), stem)


class _Export:
    """What PyVista exports scenes by: a page, if one view of a plotter has live light."""

    def __init__(self, plotter, wanted):
        self.plotter, self.wanted = plotter, wanted

    def export_vtksz(self, filename=None):  # noqa: ARG002 (as PyVista calls it)
        """Return the page; PyVista takes an ImportError for a scene that cannot be exported."""
        own = self.plotter.vizlight
        if not self.wanted or len(self.plotter.renderers) != 1 or not own.has_live_light:
            raise ImportError("this plotter has no interactive scene")
        with TemporaryDirectory() as folder:
            return own.export_html(Path(folder) / "scene.html", panel=False).read_bytes()


def reset(_conf, script):
    """Write pages for the scripts that have interactive scenes."""
    pv.close_all()
    wanted = Path(script).stem in INTERACTIVE
    pv.Plotter._trame_component = lambda plotter: _Export(plotter, wanted)


def scrape(block, block_vars, gallery_conf):
    """Return reST for the pictures and scenes that a block of a script has drawn."""
    if plt.get_fignums():
        # The script shows a chart; what its study has drawn is not shown.
        pv.close_all()
        return matplotlib_scraper(block, block_vars, gallery_conf)
    names = generate_images(block_vars["image_path_iterator"], dynamic=True)
    return "\n".join(_tabs(Path(name), Path(gallery_conf["src_dir"])) for name in names)


def _tabs(name, source):
    kind = ".gif" if name.suffix == ".gif" else ".png"
    picture = figure_rst([str(name.with_suffix(kind))], str(source))
    if name.suffix != ".vtksz":
        return picture
    scenes = source / "_static" / "scenes"
    scenes.mkdir(parents=True, exist_ok=True)
    name.replace(scenes / f"{name.stem}.html")
    address = f"../_static/scenes/{name.stem}.html"
    indented = "\n".join(f"      {line}" for line in picture.splitlines())
    return f"""
.. tab-set::

   .. tab-item:: Picture

{indented}

   .. tab-item:: Interactive scene

      .. raw:: html

         <iframe class="scene" src="{address}" title="scene" loading="lazy"></iframe>

"""


def cut_thumbnails(app):
    """Crop thumbnails of pictures that would be too small as a whole."""
    folder = Path(app.srcdir) / "examples" / "images"
    size = app.config.sphinx_gallery_conf["thumbnail_size"]
    for script, part in PARTS.items():
        thumbnail = folder / "thumb" / f"sphx_glr_{script}_thumb.png"
        pictures = sorted(folder.glob(f"sphx_glr_{script}_[0-9]*.png"))
        if not thumbnail.exists() or not pictures:
            continue
        with Image.open(pictures[-1]) as whole:
            ends = [x * side for x, side in zip(part, whole.size * 2, strict=True)]
            cut = whole.convert("RGB").crop([round(x) for x in ends])
        ImageOps.pad(cut, size, color=cut.getpixel((1, 1))).save(thumbnail)


def setup(app):
    """Register with Sphinx, after the gallery is generated."""
    app.connect("builder-inited", cut_thumbnails, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
