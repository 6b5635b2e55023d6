"""Points that light between points takes: uniform refinement against splitting where it bends.

The meshes are measured or modelled: an isosurface of a gas flow, lit as a surface and by the flow,
fibres of a human brain, an aeroplane, an ant and the globe. Uniform refinement divides each segment
and each side of a triangle evenly, and lights all new points with interpolated, normalised vectors.
"""

from __future__ import annotations

import warnings
from functools import cache, partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv

from studies import PIXEL, SHINY, Curve, Row, Study
from vizlight import data
from vizlight.filters.refine import refine
from vizlight.mesh import splitting
from vizlight.mesh.batches import inputs_of
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.shading.options import LightOptions
from vizlight.verify.between import Between, Places, columns, error_between, random_places

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array, Indices

SCENE = Scene(
    lights=Light(direction=(0.7, 0.6, 0.38)), view=View(direction=(0.1, 0.3, 0.9)), material=SHINY
)
#: Number of random places at which errors are measured.
PLACES = 4096
#: Numbers of equal parts of each side, and errors allowed.
PARTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
ERRORS = (0.1, 0.05, 0.02, 0.01, PIXEL)
UNIFORM, ADAPTIVE = "uniform", "adaptive"


class Sample(NamedTuple):
    """One mesh, and the name of the point array of its tangents."""

    mesh: pv.PolyData
    tangents: str | None = None


def _isosurface() -> pv.PolyData:
    flow = data.load_example()
    surface: pv.PolyData = flow.contour([600.0], scalars="Temp")
    return surface


def _fibres() -> pv.PolyData:
    mesh = data.load_example("fibre_bundle.vtp")
    assert isinstance(mesh, pv.PolyData)
    return mesh


def _file(name: str) -> pv.PolyData:
    from pyvista import examples

    mesh = pv.read(getattr(examples, name))
    assert isinstance(mesh, pv.PolyData)
    # Coincident points of a texture or of separate parts have one normal.
    triangles: pv.PolyData = mesh.clean().triangulate()
    return triangles


SAMPLES: dict[str, Callable[[], Sample]] = {
    "isosurface": lambda: Sample(_isosurface()),
    "flow on it": lambda: Sample(_isosurface(), "V"),
    "fibres": lambda: Sample(_fibres()),
    "aeroplane": lambda: Sample(_file("planefile")),
    "ant": lambda: Sample(_file("antfile")),
    "globe": lambda: Sample(_file("globefile")),
}


@cache
def sample(name: str) -> Sample:
    """Return a mesh of the study by its name."""
    return SAMPLES[name]()


def uniform_size(cells: Indices, parts: int) -> int:
    """Return the number of points of cells whose sides are divided evenly."""
    used, size = len(np.unique(cells)), cells.shape[1]
    if size == 2:
        return used + len(cells) * (parts - 1)
    sides = np.sort(cells[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges = len(np.unique(sides, axis=0))
    return used + edges * (parts - 1) + len(cells) * (parts - 1) * (parts - 2) // 2


def uniform_error(between: Between, light: Array, places: Places, parts: int) -> Array:
    """Return the error at places where the sides of all cells have so many equal parts."""
    if parts == 1:
        return error_between(between, light, places)
    within, share = sub_cells(places.weights, parts)
    true = between.light(places)
    shown = np.zeros_like(true)
    for i in range(share.shape[1]):
        shown += share[:, i : i + 1] * between.light(Places(places.corners, within[:, i]))
    return np.asarray(np.abs(true - shown).max(axis=1, initial=0))


def sub_cells(weights: Array, factor: int) -> tuple[Array, Array]:
    """Return the cell around each place where the sides of all cells are divided evenly.

    Parameters
    ----------
    weights : ndarray, shape (M, s)
        Places by the shares of the corners of their cells.
    factor : int
        Number of parts of a side.

    Returns
    -------
    ndarray, shape (M, s, s)
        Weights of the corners of the smaller cells, one per row.
    ndarray, shape (M, s)
        Weights of those corners in the places.
    """
    s = weights.shape[1]
    whole = np.minimum(np.floor(weights * factor), factor)
    rest = weights * factor - whole
    # Of a triangle's parts those that stand on a tip have shares that add up to 2.
    turned = (rest.sum(axis=1) > 1.5)[:, np.newaxis] if s == 3 else np.zeros((1, 1), np.bool_)
    steps = np.where(turned[..., np.newaxis], 1 - np.eye(s), np.eye(s))
    share = np.where(turned, 1 - rest, rest)
    return (whole[:, np.newaxis] + steps) / factor, share


def measure(name: str, errors: Sequence[float], parts: Sequence[int]) -> list[Row]:
    """Return the rows of one mesh: its uniform refinements, then its adaptive ones."""
    mesh, tangents = sample(name)
    # Where an open surface turns to the eye its light jumps, whatever the points.
    surface = tangents is None and not mesh.n_lines
    options = LightOptions(tangents=tangents, facing="outward" if surface else "auto")
    inputs = inputs_of(mesh, "", SCENE, options)
    shading = engine.run(inputs, SCENE, options)
    between, cells = Between(inputs, SCENE, options), splitting.simplices(mesh)
    cells = cells[shading.valid[cells].all(axis=1)]
    places, _ = random_places(between.points, cells, PLACES, np.random.default_rng(0))
    light, rows = columns(shading), []
    for count in parts:
        off = uniform_error(between, light, places, count)
        rows.append(_row(name, UNIFORM, count, off, uniform_size(cells, count)))
        if off.max() < min(errors) / 2:
            break
    for error in errors:
        with warnings.catch_warnings():
            # What is left where light jumps is measured below.
            warnings.simplefilter("ignore", UserWarning)
            fine = refine(mesh, SCENE, error=error, tangents=tangents, facing=options.facing)
        new = inputs_of(fine, "", SCENE, options)
        lit = engine.run(new, SCENE, options)
        own, field = splitting.simplices(fine), Between(new, SCENE, options)
        own = own[lit.valid[own].all(axis=1)]
        places, _ = random_places(field.points, own, PLACES, np.random.default_rng(1))
        off = error_between(field, columns(lit), places)
        rows.append(_row(name, ADAPTIVE, error, off, len(np.unique(own))))
    return rows


def _row(name: str, how: str, parameter: float, off: np.ndarray, points: int) -> Row:
    """Return a row; fewer than 0.1 % of all places are worse, with a confidence of 95 %."""
    more = {
        "99 % of the places": float(np.quantile(off, 0.99)),
        "RMS error": float(np.sqrt(np.mean(off * off))),
        "above 1/255": float(np.mean(off > PIXEL)),
    }
    return Row(f"{name}, {how}", parameter, float(off.max()), float(points), more)


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return one step for each mesh."""
    errors = ERRORS[1::2] + ERRORS[-1:] if quick else ERRORS
    parts = PARTS[:10] if quick else PARTS
    return [partial(measure, name, errors, parts) for name in SAMPLES]


def curve(row: Row) -> Curve:
    """Return the curve of a row: a colour for each mesh, a line style for each refinement."""
    name, _, how = row.way.rpartition(", ")
    return Curve(name, how)


STUDY = Study(
    approximates="light between the points of real meshes by interpolation",
    reference="light of the interpolated, normalised vectors at 4,096 random places",
    parameter="parts of a side, or error allowed",
    error="largest error of luminance",
    cost="points",
    steps=steps,
    curve=curve,
)
