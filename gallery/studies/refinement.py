"""Points that light between points takes: uniform refinement against splitting where it bends.

The meshes are measured or modelled: an isosurface of a gas flow, lit as a surface and by the flow,
fibres of a human brain, an aeroplane, an ant and the globe. Uniform refinement divides each segment
and each side of a triangle evenly, and lights all new points with interpolated, normalised vectors.
"""

from __future__ import annotations

import warnings
from functools import partial

import numpy as np
import pyvista as pv
from pyvista import examples

from studies import PIXEL, SHINY, Curve, Row, Study
from vizlight import data
from vizlight.filters.lighting import part_of
from vizlight.filters.refine import refine
from vizlight.mesh import subdivision
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.shading.options import LightOptions
from vizlight.verify.between import Between, Places, columns, error_between, random_places

SCENE = Scene(
    lights=Light(direction=(0.7, 0.6, 0.38)), view=View(direction=(0.1, 0.3, 0.9)), material=SHINY
)
#: Number of random places at which errors are measured.
PLACES = 4096
#: Numbers of equal parts of each side, and errors allowed.
PARTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
ERRORS = (0.1, 0.05, 0.02, 0.01, PIXEL)
UNIFORM, ADAPTIVE = "uniform", "adaptive"


def _isosurface():
    return data.load_example().contour([600.0], scalars="Temp")


def _file(name):
    # Coincident points of a texture or of separate parts have one normal.
    return pv.read(getattr(examples, name)).clean().triangulate()


#: Meshes, each with the name of the point array of its tangents.
SAMPLES = {
    "isosurface": lambda: (_isosurface(), None),
    "flow on it": lambda: (_isosurface(), "V"),
    "fibres": lambda: (data.load_example("fibre_bundle.vtp"), None),
    "aeroplane": lambda: (_file("planefile"), None),
    "ant": lambda: (_file("antfile"), None),
    "globe": lambda: (_file("globefile"), None),
}


def uniform_size(cells, parts):
    """Return the number of points of cells whose sides are divided evenly."""
    used, size = len(np.unique(cells)), cells.shape[1]
    if size == 2:
        return used + len(cells) * (parts - 1)
    sides = np.sort(cells[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges = len(np.unique(sides, axis=0))
    return used + edges * (parts - 1) + len(cells) * (parts - 1) * (parts - 2) // 2


def uniform_error(between, light, places, parts):
    """Return the error at places where the sides of all cells have so many equal parts."""
    if parts == 1:
        return error_between(between, light, places)
    within, share = sub_cells(places.weights, parts)
    true = between.light(places)
    shown = sum(
        share[:, i : i + 1] * between.light(Places(places.corners, within[:, i]))
        for i in range(share.shape[1])
    )
    return np.abs(true - shown).max(axis=1, initial=0)


def sub_cells(weights, factor):
    """Return the cell around each place where the sides of all cells are divided evenly.

    Places have the shares of the corners of their cells, (M, s). Returned are the weights of the
    corners of the smaller cells, (M, s, s), one per row, and the shares of those corners, (M, s).
    """
    s = weights.shape[1]
    whole = np.minimum(np.floor(weights * factor), factor)
    rest = weights * factor - whole
    # Of a triangle's parts those that stand on a tip have shares that add up to 2.
    turned = (rest.sum(axis=1) > 1.5)[:, np.newaxis] if s == 3 else np.zeros((1, 1), bool)
    steps = np.where(turned[..., np.newaxis], 1 - np.eye(s), np.eye(s))
    return (whole[:, np.newaxis] + steps) / factor, np.where(turned, 1 - rest, rest)


def measure(name, errors, parts):
    """Return the rows of one mesh: its uniform refinements, then its adaptive ones."""
    mesh, tangents = SAMPLES[name]()
    # Where an open surface turns to the eye its light jumps, whatever the points.
    surface = tangents is None and not mesh.n_lines
    options = LightOptions(tangents=tangents, facing="outward" if surface else "auto")
    found, cells, light, places = _lit(mesh, options, 0)
    rows = []
    for count in parts:
        off = uniform_error(found, light, places, count)
        rows.append(_row(name, UNIFORM, count, off, uniform_size(cells, count)))
        if off.max() < min(errors) / 2:
            break
    for error in errors:
        with warnings.catch_warnings():
            # What is left where light jumps is measured below.
            warnings.simplefilter("ignore", UserWarning)
            fine = refine(mesh, SCENE, error=error, tangents=tangents, facing=options.facing)
        found, cells, light, places = _lit(fine, options, 1)
        off = error_between(found, light, places)
        rows.append(_row(name, ADAPTIVE, error, off, len(np.unique(cells))))
    return rows


def _lit(mesh, options, seed):
    """Return light between points, the lit cells, the light at points, and random places."""
    inputs = part_of(mesh, "", SCENE, options).inputs
    shading = engine.run(inputs, SCENE, options)
    between, cells = Between(inputs, SCENE, options), subdivision.simplices(mesh)
    cells = cells[shading.valid[cells].all(axis=1)]
    places, _ = random_places(between.points, cells, PLACES, np.random.default_rng(seed))
    return between, cells, columns(shading), places


def _row(name, how, parameter, off, points):
    """Return a row; fewer than 0.1 % of all places are worse, with a confidence of 95 %."""
    more = {
        "99 % of the places": float(np.quantile(off, 0.99)),
        "RMS error": float(np.sqrt(np.mean(off * off))),
        "above 1/255": float(np.mean(off > PIXEL)),
    }
    return Row(f"{name}, {how}", parameter, float(off.max()), float(points), more)


def steps(quick):
    """Return one step for each mesh."""
    errors = ERRORS[1::2] + ERRORS[-1:] if quick else ERRORS
    return [partial(measure, name, errors, PARTS[: 10 if quick else None]) for name in SAMPLES]


STUDY = Study(
    approximates="light between the points of real meshes by interpolation",
    reference="light of the interpolated, normalised vectors at 4,096 random places",
    parameter="parts of a side, or error allowed",
    error="largest error of luminance",
    cost="points",
    steps=steps,
    curve=lambda row: Curve(*row.way.rsplit(", ", 1)),
)
