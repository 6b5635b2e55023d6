"""The guide: the code of each page runs where the pages are built, and writes its pictures."""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
from pathlib import Path

import pyvista as pv


def blocks(text, language="python"):
    """Return the code blocks of one language in a text of reStructuredText."""
    pattern = rf"^\.\. code-block:: {language}\n\n((?:   .*\n|\n)+)"
    found = re.findall(pattern, text, re.MULTILINE)
    return [re.sub(r"^   ", "", block, flags=re.MULTILINE) for block in found]


def shown(page):
    """Return the files that a page shows and its code writes, in the order of the page."""
    return re.findall(rf":: pictures/{page.stem}/(\S+)$", page.read_text(encoding="utf-8"), re.M)


def run(page, folder):
    """Run the code of a page as one script in a folder; return its names.

    What block number 3 prints is written to the file ``3.txt``.
    """
    names = {"__name__": "guide"}
    before, gallery = Path.cwd(), pv.BUILDING_GALLERY
    os.chdir(folder)
    # In a gallery PyVista writes a scene of each plotter that is shown, by a server.
    pv.BUILDING_GALLERY = False
    try:
        for i, block in enumerate(blocks(page.read_text(encoding="utf-8")), 1):
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                exec(compile(block, f"{page.name}, block {i}", "exec"), names)
            if printed.getvalue():
                Path(f"{i}.txt").write_text(printed.getvalue(), encoding="utf-8")
    finally:
        os.chdir(before)
        pv.BUILDING_GALLERY = gallery
        pv.close_all()
    return names


def write(app):
    """Write the pictures of all pages of the guide."""
    from sphinx.util.display import status_iterator

    guide = Path(app.srcdir) / "guide"
    pages = {page.stem: page for page in sorted(guide.glob("*.rst"))}
    shutil.rmtree(guide / "pictures", ignore_errors=True)
    for name in status_iterator(pages, "drawing the guide... ", "darkgreen", len(pages)):
        page, folder = pages[name], guide / "pictures" / name
        folder.mkdir(parents=True)
        run(page, folder)


def setup(app):
    """Register with Sphinx."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
