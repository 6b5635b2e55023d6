"""Which way a field runs, read off strokes: arrows, LIC, streamlines, and the light of a preset.

The winds of July on the globe, 640 x 640 pixels. A machine reads the way of strokes at each pixel
from the gradients around it (the structure tensor), in a window of the width that reads best, from
2 to 32 pixels; a light is read by its key (:func:`vizlight.legibility`). Places at the rim of the
globe are not asked for. 45 degrees is chance. The time is that of the strokes and of a first frame
with them.
"""

from __future__ import annotations

import importlib
import time
from functools import cache, partial

import numpy as np
import pyvista as pv
from scipy.ndimage import binary_erosion, gaussian_filter

import vizlight
from studies import Row, Study
from vizlight import Scene, View, presets, render

#: Widths of the window in which strokes are read, and of the picture, in pixels.
WIDTHS, SIZE = (2, 4, 6, 8, 16, 24, 32), 640
#: Widths of the rim of the globe that is not asked for, in pixels.
RIM = 25
FIELD = {"tangents": "wind", "exponent": 2}


@cache
def winds():
    """Return the winds and the camera of the picture."""
    wind = vizlight.load_example("winds_of_july.vtp")
    wind.set_active_vectors("wind")
    return wind, render.camera_on(wind.bounds, (0.42, 1, 0.1), zoom=1.75)


def ways(mesh, vectors, camera, size):
    """Return the way on the screen at each pixel as right and up, of length 1.

    It is 0 where vectors point at the eye or at several ways, and NaN beside the mesh. Lines are
    drawn 2 pixels wide.
    """
    mesh = mesh.copy()
    across = np.asarray(mesh[vectors]) @ View.from_camera(camera).axes()[:2].T
    with np.errstate(invalid="ignore"):
        across /= np.linalg.norm(across, axis=1, keepdims=True)
    mesh["way"] = np.insert(0.5 + 0.5 * np.nan_to_num(across), 2, 0.0, axis=1)
    plotter = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.background_color = pv.Color("blue")
    plotter.add_mesh(mesh, scalars="way", rgb=True, lighting=False, line_width=2)
    plotter.camera = camera
    plotter.disable_anti_aliasing()
    drawn = np.asarray(plotter.screenshot(return_img=True)) / 127.5 - 1
    plotter.close()
    right, up, beside = np.moveaxis(drawn, 2, 0)
    clear = abs(np.hypot(right, up) - 1) < 0.1
    way = np.stack([right, up], axis=-1) * clear[..., np.newaxis]
    return np.where(beside[..., np.newaxis] < 0, way, np.nan)


def read_off(picture, way, rim):
    """Return the median error in degrees of a machine that follows the strokes of a picture.

    Pixels whose way is not known, and a rim of some pixels, are not asked for.
    """
    inside = binary_erosion(np.isfinite(way[..., 0]), iterations=rim) & (way != 0).any(axis=2)
    y, x = np.gradient(gaussian_filter(picture.mean(axis=2), 1.0))
    true = np.arctan2(-way[..., 1], way[..., 0])[inside]
    medians = []
    for width in WIDTHS:
        xx, xy, yy = (gaussian_filter(part, width)[inside] for part in (x * x, x * y, y * y))
        read = np.pi / 2 + np.arctan2(2 * xy, xx - yy) / 2
        off = (read - true + np.pi / 2) % np.pi - np.pi / 2
        medians.append(float(np.degrees(np.median(abs(off)))))
    return min(medians)


def arrows(tolerance, plotter):
    """Draw arrows of one size, as PyVista does."""
    made = winds()[0].glyph(orient="wind", scale=False, factor=2 * tolerance, tolerance=tolerance)
    plotter.add_mesh(made, color="black")


def lic(steps, plotter):
    """Smear noise along the field by VTK's line integral convolution."""
    mapper = importlib.import_module("vtkmodules.vtkRenderingLICOpenGL2").vtkSurfaceLICMapper()
    mapper.SetInputDataObject(winds()[0])
    mapper.ScalarVisibilityOff()
    mapper.GetLICInterface().SetNumberOfSteps(steps)
    plotter.add_actor(pv.Actor(mapper=mapper))


def seeded(count, plotter):
    """Draw VTK's streamlines on the surface from seeds at random."""
    wind, _ = winds()
    places = np.random.default_rng(0).choice(wind.n_points, count, replace=False)
    made = wind.streamlines_from_source(
        pv.PolyData(np.asarray(wind.points)[places]), vectors="wind", surface_streamlines=True,
        max_length=1.0,
    )  # fmt: skip
    plotter.add_mesh(made.scale(1.005), color="black", line_width=4)


def spaced(spacing, plotter):
    """Draw evenly spaced lines."""
    made = vizlight.streamlines(winds()[0], tangents="wind", spacing=spacing)
    plotter.add_mesh(made.scale(1.005), color="black", line_width=4)


def first_frame(fill):
    """Return the picture of what a function adds to a plotter, and the time that it took."""
    start = time.process_time()
    plotter = pv.Plotter(off_screen=True, window_size=[SIZE, SIZE])
    fill(plotter)
    plotter.camera = winds()[1]
    picture = np.asarray(plotter.screenshot(return_img=True), np.float64)
    spent = time.process_time() - start
    plotter.close()
    return picture, 1e3 * spent


def measure(way, parameter, draw):
    """Return the row of strokes that a function draws on the globe."""
    wind, camera = winds()

    def fill(plotter):
        plotter.add_mesh(wind.scale(0.995), color="lightsteelblue", smooth_shading=True)
        draw(plotter)

    picture, spent = first_frame(fill)
    true = ways(wind, "wind", camera, (SIZE, SIZE))
    return [Row(way, parameter, read_off(picture, true, RIM), spent)]


def lit(way, scene):
    """Return the row of a light that is read by its key."""
    wind, camera = winds()
    _, spent = first_frame(lambda p: p.vizlight.add_mesh(wind, scene=scene, **FIELD))
    found = vizlight.legibility(wind, scene, view=camera, **FIELD).direction
    return [Row(way, "", found.median, spent)]


def steps(quick):
    """Return one function for each row."""
    few = slice(1, 2) if quick else slice(None)
    made = [partial(measure, "plain", "", lambda _: None)]
    drawn = (
        ("arrows, PyVista", arrows, (0.08, 0.045, 0.03)),
        ("LIC, VTK", lic, (5, 20, 60)),
        ("streamlines at random, VTK", seeded, (100, 300, 1000)),
        ("streamlines(spacing)", spaced, (0.12, 0.06, 0.03)),
    )
    for way, draw, settings in drawn:
        made += [partial(measure, way, s, partial(draw, s)) for s in settings[few]]
    made += [partial(lit, "white light", Scene())]
    return [*made, partial(lit, "presets.direction", presets.direction())]


STUDY = Study(
    approximates="which way a field on a surface runs on the screen",
    reference="the field itself, at the pixels that show it; 45 degrees is chance",
    parameter="spacing, steps or number",
    error="median error in degrees",
    cost="processor time to the first frame, ms",
    steps=steps,
)
