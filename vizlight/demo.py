"""Demonstration from file to picture: measured winds, lit so that hue is their direction."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import writing
from vizlight.data import load_example
from vizlight.draw import render
from vizlight.draw.backends import Backend, choose_backend, window_class
from vizlight.filters.illuminate import illuminate
from vizlight.filters.streamlines import streamlines
from vizlight.observers.check import check
from vizlight.observers.figures import Direction
from vizlight.observers.legibility import legibility
from vizlight.scene import Scene, View, presets
from vizlight.shading import engine

EYE = (0.42, 1.0, 0.2)
#: Distance between lines, and length of arrows, as shares of the globe's radius.
SPACING = 0.06
#: Distance of the lines above the globe, whose triangles would hide parts of them.
ABOVE = 1.004


@dataclass(frozen=True)
class Demo:
    """Results of the demonstration.

    ``rows`` are, for a white light, and for the light by direction: name, terms, cost in
    milliseconds, largest error against the second implementation, and how much a reader reads in
    it. ``plan`` has the terms that were computed, in words.
    """

    globe: pv.PolyData
    lines: pv.PolyData
    scene: Scene
    camera: pv.Camera
    rows: list[tuple[str, str, float, float, Direction]]
    plan: str


def light_winds() -> Demo:
    """Light the mean wind of July by its direction, and measure how much can be read of it."""
    globe = load_example("winds_of_july.vtp").compute_normals(
        cell_normals=False, split_vertices=False, auto_orient_normals=True
    )
    camera = render.camera_on(globe.bounds, EYE, zoom=1.35)
    view = View.from_camera(camera)
    points, wind = np.asarray(globe.points), np.asarray(globe["wind"])
    rows = []
    for title, scene in (
        ("a white lamp at the eye", Scene(view=view)),
        ("presets.direction", presets.direction(view)),
    ):
        globe = illuminate(globe, scene, tangents="wind", exponent=2)
        error = check(globe, sample=globe.n_points).error
        runs = [engine.shade(points, wind, scene, exponent=2) for _ in range(5)]
        plan = runs[0].plan
        terms = " + ".join(plan.terms)
        milliseconds = 1e3 * float(np.median([run.seconds for run in runs]))
        read = legibility(globe, scene, tangents="wind", exponent=2, view=camera).direction
        assert read is not None
        rows.append((title, terms, milliseconds, error, read))
    lines = streamlines(globe, scene, tangents="wind", spacing=SPACING)
    lines.points = ABOVE * np.asarray(lines.points)
    return Demo(globe, lines, scene, camera, rows, plan.explain())


def save_picture(
    demo: Demo, path: Path, /, *, size: tuple[int, int], backend: Backend | None = None
) -> Path:
    """Draw PyVista's picture of the winds beside the lit one, with its key.

    The size is in pixels; for ``backend`` see :func:`vizlight.render.choose_backend`.
    """
    with window_class(choose_backend(backend)):
        plotter = pv.Plotter(
            off_screen=True, shape=(1, 2), window_size=render.pixels_of(size), border=False
        )
    with contextlib.closing(plotter):
        arrows = demo.globe.glyph(orient="wind", scale=False, factor=SPACING, tolerance=SPACING / 2)
        plotter.add_mesh(demo.globe, color="lightsteelblue", smooth_shading=True)
        plotter.add_mesh(arrows, color="black")
        _panel(plotter, "PyVista: shape by light, direction by arrows")
        plotter.camera = demo.camera.copy()  # type: ignore[no-untyped-call]
        plotter.subplot(0, 1)
        plotter.vizlight.add_mesh(demo.globe, scene=demo.scene, tangents="wind", exponent=2)
        plotter.add_mesh(demo.lines, color="black", opacity=0.5, line_width=2)
        plotter.vizlight.add_key(demo.scene, exponent=2)
        wrong = demo.rows[-1][-1].median
        _panel(plotter, f"vizlight: hue is the direction, read to {wrong:.1f}\N{DEGREE SIGN}")
        plotter.camera = demo.camera.copy()  # type: ignore[no-untyped-call]
        return writing.replace_file(path, plotter.screenshot, doing="draw")


def _panel(plotter: pv.Plotter, text: str) -> None:
    plotter.background_color = pv.Color("white")
    # VTK before 9.7 draws several supersampled panels in one place.
    plotter.enable_anti_aliasing("ssaa" if render.SUPERSAMPLES_PARTS else "msaa")
    words = plotter.add_text(text, position="upper_edge", font_size=9, color="black")
    words.GetTextProperty().SetLineOffset(8)
