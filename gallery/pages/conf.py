"""Sphinx configuration: ``sphinx-build -W gallery/pages build/gallery``, drawn offscreen."""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path

# PyVista reads these on import, here and in the worker processes that draw.
os.environ["PYVISTA_BUILDING_GALLERY"] = "true"
os.environ["PYVISTA_OFF_SCREEN"] = "true"

import pyvista as pv

import vizlight

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

project = "vizlight"
author = "the vizlight developers"
copyright = author
version = release = vizlight.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx_gallery.gen_gallery",
    "numpydoc",
    "sphinx_design",
    "_front",
    "_guide",
    "_light",
    "_mathml",
    "_peers",
    "_scenes",
    "_social",
    "_studies",
]
templates_path = ["_templates"]
# The table of run times loads a script from the network.
exclude_patterns = ["_build", "**sg_execution_times.rst"]
html_theme = "pydata_sphinx_theme"
html_title = "vizlight"
# Without it the theme complains on the console of the browser.
html_context = {"default_mode": "auto"}
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_js_files = [("scenes.js", {"defer": "defer"})]
html_favicon = "_static/icon.svg"
html_theme_options = {
    "show_prev_next": False,
    "secondary_sidebar_items": {
        "**": ["page-toc"],
        "index": [],
        "examples/index": [],
        "peers": [],
        "timed": [],
        # Code needs the width; a second pattern that matches a page would be a warning.
        **{f"guide/{page.stem}": [] for page in (HERE / "guide").glob("*.rst")},
    },
    "navbar_align": "left",
    "navbar_end": ["theme-switcher"],
    "navbar_persistent": ["search-button"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "logo": {"text": "vizlight"},
}
html_show_sourcelink = False
html_sidebars = {
    "index": [],
    "formulas": [],
    "architecture": [],
    "studies": [],
    "studies/**": [],
    "readers": [],
    "bounds": [],
    "sources": [],
    "pyvista": [],
    "data": [],
    "peers": [],
    "timed": [],
    "scaling": [],
    "robustness": [],
    "examples/**": [],
}
html_math_renderer = "mathml"
nitpicky = False

autosummary_generate = True
autosummary_ignore_module_all = False
autodoc_typehints = "none"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

sphinx_gallery_conf = {
    "examples_dirs": "..",
    "gallery_dirs": "examples",
    "filename_pattern": r"plot_",
    "ignore_pattern": r"__init__\.py|/pages/|/studies/",
    "within_subsection_order": "_scenes.Order",
    "image_scrapers": ("_scenes.scrape",),
    "reset_modules": ("_scenes.reset",),
    "remove_config_comments": True,
    "download_all_examples": False,
    "nested_sections": False,
    "show_memory": False,
    "write_computation_times": False,
    "min_reported_time": 0,
    "plot_gallery": "True",
    "abort_on_example_error": False,
    "thumbnail_size": (480, 320),
    "doc_module": ("vizlight",),
    "backreferences_dir": "examples/backreferences",
    "inspect_global_variables": False,
    # Scenes that turn need a server and more packages: notebooks show pictures below their cells.
    "first_notebook_cell": (
        "# Needs vizlight, and for some examples its extras: pip install 'vizlight[movie,solids]'\n"
        "import pyvista\n\n"
        'pyvista.set_jupyter_backend("static")'
    ),
}

pv.global_theme.notebook = False
# A warning of vizlight in a script is an error; other warnings stand on its page, without paths.
warnings.filterwarnings("error", module=r"vizlight(\.|$)")
warnings.formatwarning = lambda message, category, *_: f"{category.__name__}: {message}\n"
