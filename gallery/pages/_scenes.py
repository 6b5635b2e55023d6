"""Scenes that can be turned in a page opened from disk.

PyVista's own viewer fetches its scene, which browsers refuse for files on disk, so each scene is
written into a page of its own instead, together with the viewer.
"""

from __future__ import annotations

from pathlib import Path

import pyvista as pv
from pyvista.plotting.utilities.sphinx_gallery import generate_images
from sphinx_gallery.scrapers import figure_rst
from trame_vtk.tools.vtksz2html import embed_data_to_viewer_file

#: The scripts with a scene: one view of one mesh, of a few megabytes.
INTERACTIVE = ("plot_flow", "plot_carotid", "plot_fibres", "plot_complex_curve")

# Lines and flows, then surfaces, 4-space, terrain, laws and their errors; what is not named here
# comes last.
ORDER = [
    "plot_flow", "plot_carotid", "plot_lines", "plot_fibres", "plot_satin", "plot_fur",
    "plot_ambient", "plot_depth_cue", "plot_attenuation", "plot_terrain_day", "plot_terrain",
    "plot_earth", "plot_bas_relief", "plot_seeping_light", "plot_codimension", "plot_turning",
    "plot_complex_curve", "plot_shapes", "plot_field_in_4_space", "plot_highlights",
    "plot_highlights_shapes", "plot_highlight_error", "plot_line_models", "plot_errors",
]  # fmt: skip


class Order:
    """Place scripts as ``ORDER`` has them."""

    def __init__(self, folder):
        self.folder = folder

    def __repr__(self):
        return "<Order>"

    def __call__(self, name):
        stem = Path(name).stem
        return (ORDER.index(stem) if stem in ORDER else len(ORDER), stem)


_export = pv.Plotter._trame_component


def reset(_conf, script):
    """Leave scenes away from scripts without one: PyVista would export each in vain."""

    def none(_plotter):
        raise ImportError("no scene is wanted")

    pv.close_all()
    pv.Plotter._trame_component = _export if Path(script).stem in INTERACTIVE else none


def scrape(_block, block_vars, gallery_conf):
    """Return reST for what a block of a script has drawn: its pictures and scenes."""
    names = generate_images(block_vars["image_path_iterator"], dynamic=True)
    return "\n".join(_tabs(Path(name), Path(gallery_conf["src_dir"])) for name in names)


def _tabs(name, source):
    picture = figure_rst([str(name.with_suffix(".png"))], str(source))
    if name.suffix != ".vtksz":
        return picture
    scenes = source / "_static" / "scenes"
    scenes.mkdir(parents=True, exist_ok=True)
    embed_data_to_viewer_file(name.read_bytes(), scenes / f"{name.stem}.html")
    name.unlink()
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
