"""The pictures of the first page: what a look makes of embedded data of six kinds."""

from __future__ import annotations

from pathlib import Path

import pyvista as pv

import vizlight

#: Names of pictures, and of the data that they show.
LOOKS = {
    "winds": "winds_of_july.vtp",
    "flow": "rotating_disk.vtu",
    "terrain": "jacksboro_fault.vti",
    "tracts": "fibre_bundle.vtp",
    "brain": "brain.vti",
    "earth": "earth_relief.vti",
}
SIZE = (600, 400)


def write(app):
    """Write the pictures."""
    folder = Path(app.srcdir) / "guide" / "pictures" / "front"
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in LOOKS.items():
        vizlight.look(vizlight.load_example(data), size=SIZE).save(folder / f"{name}.jpg")
    pv.close_all()


def setup(app):
    """Register with Sphinx: after the guide, which empties the folder of pictures."""
    app.connect("builder-inited", write, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
