"""What is kept of the pictures of peers: the scripts, their table, the names of their pictures."""

from __future__ import annotations

import ast
import csv
from pathlib import Path

HERE = Path(__file__).resolve().parent
TABLE = HERE / "measurements.csv"
#: Tools in the order of the page: the first words of the names of scripts.
TOOLS = ("pyvista", "paraview", "matplotlib", "vizlight")
#: Scripts of the first row of a scene, to which the others are compared.
FIRST = ("pyvista_lines", "pyvista_smooth")
#: Scenes with the scripts of another folder, seen by another camera.
SEEN_AGAIN = {
    "near": ("lines/pyvista_as_tubes.py", "lines/pyvista_tubes.py", "lines/vizlight_as_tubes.py"),
}
COLUMNS = (
    "scene", "script", "code_lines", "points", "pieces", "cpu_s", "wall_s", "frame_cpu_s",
    "memory_mb", "tool", "date", "system",
)  # fmt: skip


def todo():
    """Return pairs of a scene and a script, in the order of the page."""
    scripts = sorted(
        HERE.glob("*/*.py"),
        key=lambda path: (TOOLS.index(tool(path)), path.stem not in FIRST, path.stem),
    )
    own = [(path.parent.name, path) for path in scripts]
    return own + [(scene, HERE / name) for scene, names in SEEN_AGAIN.items() for name in names]


def tool(script):
    """Return the tool of a script, the first word of its name."""
    return script.stem.partition("_")[0]


def code_lines(script):
    """Return the number of lines of code: neither empty, nor a comment, nor the docstring."""
    text = script.read_text(encoding="utf-8")
    docstring = ast.parse(text).body[0].end_lineno
    lines = [line.strip() for line in text.splitlines()[docstring:]]
    return sum(bool(line) and not line.startswith("#") for line in lines)


def picture(scene, script):
    """Return the path of the picture of a script in a scene."""
    name = script.stem if scene == script.parent.name else f"{scene}_{script.stem}"
    return script.with_name(f"{name}.webp")


def read():
    """Return the rows of the table that is kept, by scene and script."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return {(row["scene"], row["script"]): row for row in csv.DictReader(file)}


def panel(plotter):
    """Return the picture of the active renderer of a plotter."""
    (left, low), (wide, high) = plotter.renderer.GetOrigin(), plotter.renderer.GetSize()
    whole = plotter.screenshot(return_img=True)
    top = len(whole) - low - high
    return whole[top : top + high, left : left + wide]


def side_by_side(name, titles, pictures):
    """Keep pictures of one height beside each other, with their titles."""
    from PIL import Image, ImageDraw, ImageFont

    width, height = sum(part.width for part in pictures), pictures[0].height
    sheet = Image.new("RGB", (width, height + 34), "white")
    pen, font, left = ImageDraw.Draw(sheet), ImageFont.load_default(20), 0
    for title, part in zip(titles, pictures, strict=True):
        sheet.paste(part, (left, 34))
        pen.text((left + 8, 5), title, "black", font)
        left += part.width
    sheet.save(HERE / f"{name}.webp", quality=80, method=6)
