"""The pictures of the first page: what a look makes of embedded data of six kinds.

``python gallery/pages/_front.py`` joins them to the picture of README, ``gallery/looks.jpg``.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import pyvista as pv
from PIL import Image

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
    _write(folder, SIZE, "jpg")


def _write(folder, size, suffix):
    """Write the pictures into a folder."""
    for name, data in LOOKS.items():
        vizlight.look(vizlight.load_example(data), size=size).save(folder / f"{name}.{suffix}")
    pv.close_all()


def _join(path):
    """Write one picture of all."""
    width, height = SIZE
    sheet = Image.new("RGB", (3 * width, 2 * height))
    with tempfile.TemporaryDirectory() as folder:
        _write(Path(folder), (900, 600), "png")
        for i, name in enumerate(LOOKS):
            with Image.open(Path(folder) / f"{name}.png") as picture:
                small = picture.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)
            sheet.paste(small, (i % 3 * width, i // 3 * height))
    sheet.save(path, quality=88)


def setup(app):
    """Register with Sphinx: after the guide, which empties the folder of pictures."""
    app.connect("builder-inited", write, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    _join(Path(__file__).parents[1] / "looks.jpg")
