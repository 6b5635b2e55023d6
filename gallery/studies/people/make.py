"""Write ``people.html``, a page that asks people what they read in 24 pictures.

``python gallery/studies/people/make.py`` draws data of four kinds (winds on a globe, a gyroid with
a flow, rough hills, curves in space), each as this package shows it and as PyVista does by default,
and marks a place in each picture. The page needs no server: it shows one picture after the other,
in random order, takes answers and times, and saves one CSV. ``trials.json`` has for each trial what
is right and what the meter says of the picture; ``compare.py`` compares both. The figures of the
meter are no claim about people.
"""

from __future__ import annotations

import base64
import html
import io
import json
import math
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw

from vizlight import Scene, load_example, presets
from vizlight.draw.cameras import camera_on
from vizlight.observers.crossings import crossings_of
from vizlight.observers.lines import segments_of
from vizlight.observers.pixels import visible
from vizlight.observers.readers import course
from vizlight.observers.samples import sample
from vizlight.observers.whole import shown_by

HERE = Path(__file__).parent
#: Size of a picture in pixels, and its width on the screen in CSS pixels of 96 per inch.
SIZE, WIDE = (720, 480), 720
#: Distance in pixels of a marked place from where the mesh ends.
MARGIN = 30


def winds():
    """Return a globe with winds, their speed, and its camera."""
    mesh = load_example("winds_of_july.vtp")
    mesh["speed"] = np.linalg.norm(mesh["wind"], axis=1)
    return mesh, "wind", "speed", (0.42, 1, 0.2)


def gyroid():
    """Return a gyroid with a flow along it and a value."""
    grid = pv.ImageData(dimensions=(50, 50, 50), spacing=(0.17,) * 3)
    x, y, z = np.asarray(grid.points, np.float64).T
    grid["f"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    mesh = grid.contour([0.0], scalars="f").compute_normals(cell_normals=False)
    x, y, z = np.asarray(mesh.points, np.float64).T
    axis = np.stack([np.sin(y), np.cos(z), np.sin(x)], axis=1)
    mesh["flow"] = np.cross(mesh.point_data["Normals"], axis)
    mesh["value"] = np.cos(0.7 * x) + np.sin(0.5 * y + z)
    return mesh, "flow", "value", (1, 0.7, 0.5)


def hills():
    """Return rough hills with the way downhill and their height."""
    random = np.random.default_rng(3)
    x, y = np.meshgrid(np.linspace(0, 6, 160), np.linspace(0, 4, 110))
    z, slope = np.zeros_like(x), np.zeros((*x.shape, 2))
    for _ in range(14):
        k, phase = random.normal(0, 1.6, 2), random.uniform(0, 2 * np.pi)
        wave, height = k[0] * x + k[1] * y + phase, 0.35 / (1 + np.hypot(*k))
        z += height * np.sin(wave)
        slope += height * np.cos(wave)[..., np.newaxis] * k
    grid = pv.StructuredGrid(x, y, z)
    mesh = grid.extract_surface(algorithm="dataset_surface").triangulate()
    gradient = np.stack([slope[..., i].ravel(order="F") for i in range(2)], axis=1)
    down = np.column_stack([-gradient, -np.einsum("ij,ij->i", gradient, gradient)])
    mesh["down"], mesh["height"] = down, np.asarray(mesh.points)[:, 2]
    return mesh, "down", "height", (0.1, -0.6, 1)


def curves(seed):
    """Return closed curves in space."""
    random = np.random.default_rng(seed)
    t = np.linspace(0, 2 * np.pi, 300)
    points, cells = [], []
    for i in range(9):
        q = int(random.integers(1, 4))
        radius = 1.2 + 0.25 * i + 0.4 * np.cos(q * t + random.uniform(0, 6))
        turn = t + random.uniform(0, 6)
        tilt = 0.7 * np.sin(q * t + random.uniform(0, 6))
        points.append(np.stack([radius * np.cos(turn), radius * np.sin(turn), tilt], axis=1))
        cells += [300, *range(300 * i, 300 * i + 300)]
    return pv.PolyData(np.concatenate(points), lines=cells)


def drawn(question, mesh, tangents, values, view, ours):
    """Return a plotter that shows data for a question."""
    plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), border=False)
    plotter.background_color = "white"
    plotter.enable_anti_aliasing("ssaa" if question == "order" else "msaa")
    pixel = 2 / 0.9 if question == "order" else 1.0
    add = plotter.vizlight.add_mesh
    if question == "order" and ours:
        add(mesh, scene=presets.heading(), line_width=4 * pixel)
    elif question == "order":
        plotter.add_mesh(mesh, color="tan", line_width=4 * pixel, render_lines_as_tubes=True)
    elif question == "value" and ours:
        add(mesh, scalars=values, show_scalar_bar=False)
    elif question == "value":
        plotter.add_mesh(mesh, scalars=values, show_scalar_bar=False)
    elif question == "direction" and ours:
        add(mesh, scene=presets.direction(), tangents=tangents, exponent=2)
    elif question == "direction":
        add(mesh, scene=Scene(), tangents=tangents)
    elif ours:
        add(mesh, scene=presets.shape())
    else:
        add(mesh)
    plotter.camera = camera_on(mesh, view, aspect=SIZE[0] / SIZE[1])
    return plotter


def place(plotter, question, random):
    """Return a place in the picture, up to a share of its size, and what is right there."""
    shown = shown_by(plotter.renderer, plotter.vizlight._live_of)
    camera = plotter.renderer.GetActiveCamera()
    pixels = visible([part.drawn for part in shown.parts], camera, SIZE, shown.occluders)
    if question == "order":
        lines = segments_of(shown.parts, pixels, camera)
        found = crossings_of(lines, 400, random)
        number = int(random.integers(len(found.at)))
        way = lines.way[[found.front[number], found.back[number]]]
        upright = np.abs(way[:, 1]) / np.hypot(way[:, 0], way[:, 1])
        return found.at[number].tolist(), int(upright[0] > upright[1])
    inside = np.zeros((SIZE[1], SIZE[0]), dtype=bool)
    inside[pixels.row, pixels.column] = True
    row, column = pixels.row, pixels.column
    far = (
        (row > MARGIN) & (row < SIZE[1] - MARGIN) & (column > MARGIN) & (column < SIZE[0] - MARGIN)
    )
    choice = random.choice(np.flatnonzero(far))
    here = sample(shown.parts[0], pixels[np.array([choice])], camera)
    at = [float(column[choice]) + 0.5, float(row[choice]) + 0.5]
    if question == "value":
        low, high = shown.parts[0].table.scalar_range
        return at, float(np.clip((here.values[0] - low) / (high - low), 0, 1))
    if question == "direction":
        return at, math.degrees(course(here)[0]) % 180
    axes = np.stack([here.right[0], here.up[0], here.eye[0]])
    normal = axes @ here.normals[0]
    return at, (normal * (1 if normal[2] >= 0 else -1)).tolist()


def picture_of(array):
    """Return a picture as the address of its data, in WebP."""
    image, data = Image.fromarray(array), io.BytesIO()
    image.save(data, "WEBP", quality=86)
    return "data:image/webp;base64," + base64.b64encode(data.getvalue()).decode()


def bar(table):
    """Return the picture of a colour bar."""
    colors = np.asarray(table.values)[:, :3]
    return picture_of(
        np.repeat(colors[np.linspace(0, len(colors) - 1, 400).astype(int)][None], 20, 0)
    )


def ball(scene, tangents):
    """Return the picture of a ball, or of a disc of directions, in a light."""
    plotter = pv.Plotter(off_screen=True, window_size=[160, 160], border=False)
    plotter.background_color = "white"
    if tangents:
        key = pv.Disc(inner=0.02, outer=1, r_res=20, c_res=180).triangulate()
        key["t"] = np.asarray(key.points)
        plotter.vizlight.add_mesh(key, scene=scene, tangents="t", exponent=2)
    else:
        plotter.vizlight.add_mesh(
            pv.Icosphere(nsub=5), **({} if scene is None else {"scene": scene})
        )
    plotter.camera = camera_on((-1, 1, -1, 1, -1, 1), (0, 0, 1), parallel=True)
    plotter.camera.parallel_scale = 1.0
    array = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return picture_of(array)


def key_of(question, plotter, ours):
    """Return the picture of the key that stands beside a picture, empty without one."""
    if question == "value":
        return bar(plotter.mapper.lookup_table)
    if question == "order":
        return ""
    presets_of = {"direction": presets.direction(), "shape": presets.shape()}
    plain = Scene() if question == "direction" else None
    return ball(presets_of[question] if ours else plain, question == "direction")


def trials():
    """Yield what is shown and what is right, with the figures of the meter."""
    random = np.random.default_rng(12)
    surfaces = {"winds": winds(), "gyroid": gyroid(), "hills": hills()}
    data = [
        (q, name, *kind) for q in ("direction", "value", "shape") for name, kind in surfaces.items()
    ]
    data += [("order", f"curves {s}", curves(s), None, None, (0.3, -0.5, 1)) for s in range(3)]
    for question, name, mesh, tangents, values, view in data:
        at = right = None
        for ours in (True, False):
            plotter = drawn(question, mesh, tangents, values, view, ours)
            if at is None:
                at, right = place(plotter, question, random)
            figures = plotter.vizlight.legibility(screen=96)
            array = np.asarray(plotter.screenshot(return_img=True))
            image = Image.fromarray(array)
            x, y = at
            pen = ImageDraw.Draw(image)
            pen.ellipse((x - 12, y - 12, x + 12, y + 12), outline="white", width=4)
            pen.ellipse((x - 11, y - 11, x + 11, y + 11), outline="black", width=2)
            key = key_of(question, plotter, ours)
            plotter.close()
            figure = getattr(figures, question)
            yield {
                "question": question, "data": name, "kind": "vizlight" if ours else "plain",
                "right": right, "bits": figure.bits, "score": figure.score,
                "readable": figure.readable,
                "picture": picture_of(np.asarray(image)), "key": key,
            }  # fmt: skip


def main():
    """Write the page, and beside it what is right."""
    found = [{"trial": number, **trial} for number, trial in enumerate(trials(), 1)]
    shown = [{k: t[k] for k in ("trial", "question", "picture", "key")} for t in found]
    text = (HERE / "page.html").read_text(encoding="utf-8")
    page = text.replace("/*TRIALS*/[]", json.dumps(shown)).replace("WIDE", html.escape(str(WIDE)))
    (HERE / "people.html").write_text(page, encoding="utf-8")
    kept = [{k: v for k, v in t.items() if k not in ("picture", "key")} for t in found]
    (HERE / "trials.json").write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
