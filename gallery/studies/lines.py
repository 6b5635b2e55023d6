"""Errors of the cheap models of light on lines, compared with the exact line light.

Lines, lights and eyes have random directions, or the light is a headlight. The exact light is that
of :mod:`vizlight.model.cylinder`, with N.H to the power 20. Tubes of N sides are shaded as in VTK:
the normals of the corners are interpolated along a face and normalised at each pixel. The light of
a tube is its mean over the width of the tube, as in a pixel that contains the whole tube, and each
tube is rotated about its line by a random angle. The scaled errors are those after multiplication
of all points by the best common factor, which a coefficient of the material can absorb.

For a headlight, and wherever light, line and eye lie in one plane with light and eye on the same
side of the line, Banks' diffuse term with p = 1 and the Blinn highlight equal the exact light up to
the factors pi / 4 and ``B(s/2 + 1, 1/2) / 2``. They are not exact anywhere else, and the
compensated exponent is not exact anywhere.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from studies import SHINY, Curve, Panel, Row, Study, cheapest, take_turns, words
from vizlight.model import brightness, cylinder, highlights, reflection
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

SHININESS = 20.0
SIDES = (3, 4, 6, 8, 12, 20, 40)
#: Nodes of the quadrature along a face.
NODES = 16


@dataclass(frozen=True)
class Model:
    """Errors of one model of one term, and its cost per point of the line in ns and bytes."""

    setting: str
    term: str
    model: str
    worst: float
    rms: float
    scaled_worst: float
    scaled_rms: float
    nanoseconds: float
    bytes: float


def directions(count: int, *, headlight: bool) -> tuple[Array, Array, Array]:
    """Return reproducible random unit vectors: toward light, toward eye, tangents."""
    random = np.random.default_rng(2005)
    v: Array = random.standard_normal((3, count, 3))
    v /= np.linalg.norm(v, axis=-1, keepdims=True)
    return (v[1] if headlight else v[0]), v[1], v[2]


def tube(
    wi: Array, wo: Array, tangent: Array, sides: int, *, shininess: float = SHININESS
) -> tuple[Array, Array]:
    """Return the mean diffuse and specular light over the width of tubes."""
    random = np.random.default_rng(sides)

    def across(v: Array) -> Array:
        rest: Array = v - np.sum(v * tangent, axis=1, keepdims=True) * tangent
        return rest

    first = across(wo)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(tangent, first)
    half = wi + wo
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    (lx, ly), (hx, hy) = (
        (np.sum(v * first, axis=1), np.sum(v * second, axis=1)) for v in (wi, half)
    )
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    turn = random.uniform(0, 2 * np.pi, len(wi))
    width, diffuse, specular = np.zeros((3, len(wi)))
    for face in range(sides):
        middle = turn + 2 * np.pi * face / sides
        facing = np.maximum(np.cos(middle), 0)
        width += 2 * facing
        for u, w in zip(nodes, weights, strict=True):
            angle = middle + np.arctan(u * np.tan(np.pi / sides))
            x, y = np.cos(angle), np.sin(angle)
            lit = lx * x + ly * y
            diffuse += facing * w * np.maximum(lit, 0)
            shine = np.maximum(hx * x + hy * y, 0) ** shininess
            specular += facing * w * np.where(lit > 0, shine, 0)
    return diffuse / width, specular / width


def measure(count: int = 20_000, repeats: int = 3) -> list[Model]:
    """Return the errors and costs of each model, for random lights and for a headlight."""
    rows = []
    costs = _costs(repeats)
    for setting in ("random", "headlight"):
        wi, wo, t = directions(count, headlight=setting == "headlight")
        frame = t[:, np.newaxis]
        exact = {
            "diffuse": cylinder.diffuse(wi, wo, t),
            "specular": cylinder.specular(wi, wo, t, shininess=SHININESS),
        }
        phong = float(highlights.phong_from_blinn(SHININESS))
        found: list[tuple[str, str, str, Array]] = [
            ("diffuse", "Banks, p = 1", "line", reflection.diffuse(wi, frame)),
            (
                "diffuse",
                "Banks, p(1, 3)",
                "line",
                reflection.diffuse(wi, frame, exponent=brightness.exponent(1, 3)),
            ),
            (
                "specular",
                "Blinn",
                "line, Blinn",
                reflection.specular(wi, wo, frame, shininess=SHININESS, model="blinn"),
            ),
            (
                "specular",
                f"Banks' Phong, power {phong:g}",
                "line",
                reflection.specular(wi, wo, frame, shininess=phong),
            ),
        ]
        for sides in SIDES:
            pair = tube(wi, wo, t, sides)
            for term, value in zip(("diffuse", "specular"), pair, strict=True):
                found.append((term, f"tube of {sides} sides", f"tube {sides}", value))
        for term in ("diffuse", "specular"):
            found.append((term, "exact", "cylinder", exact[term]))
        for term in ("diffuse", "specular"):
            rows += [
                _row(setting, term, model, value, exact[term], costs[cost])
                for own, model, cost, value in found
                if own == term
            ]
    return rows


def _row(
    setting: str, term: str, model: str, value: Array, exact: Array, cost: tuple[float, float]
) -> Model:
    """Return the errors of one model, without and with the best common factor."""
    factor = float(np.sum(value * exact) / np.sum(value * value))
    plain, scaled = value - exact, factor * value - exact
    return Model(
        setting,
        term,
        model,
        float(np.abs(plain).max()),
        float(np.sqrt(np.mean(plain * plain))),
        float(np.abs(scaled).max()),
        float(np.sqrt(np.mean(scaled * scaled))),
        *cost,
    )


def _costs(repeats: int, count: int = 200_000) -> dict[str, tuple[float, float]]:
    """Return ns and bytes per point of each model.

    The time is that of both terms in one thread and float32, for a light and an eye with
    positions.
    """
    random = np.random.default_rng(20)
    points, tangents = (random.standard_normal((count, 3)).astype(np.float32) for _ in range(2))
    scene = Scene(
        lights=Light(position=(4.0, 5.0, 6.0)),
        view=View(position=(0.0, 1.0, 9.0)),
        material=dataclasses.replace(SHINY, shininess=SHININESS),
    )

    light = partial(engine.shade, points, tangents, scene)
    ways = {
        "line": light,
        "line, Blinn": partial(light, model="blinn"),
        "cylinder": partial(light, model="cylinder"),
        "surface": partial(engine.shade, points, None, scene, normals=tangents, model="blinn"),
    }
    seconds = take_turns(ways, repeats)
    each = {way: 1e9 * spent / count for way, spent in seconds.items()}
    line = pv.Spline(np.cumsum(random.standard_normal((20, 3)), axis=0), 2000)
    line.clear_data()

    def size(mesh: pv.PolyData) -> float:
        """Return the bytes per point of the line, including the light of the mesh in float32."""
        whole = 1024 * mesh.actual_memory_size + 4 * mesh.n_points
        return float(whole / line.n_points)

    costs = {way: (each[way], size(line)) for way in ("line", "line, Blinn", "cylinder")}
    for sides in SIDES:
        costs[f"tube {sides}"] = (sides * each["surface"], size(line.tube(n_sides=sides)))
    return costs


def rows(count: int = 20_000, repeats: int = 3) -> list[Row]:
    """Return one row for each model; the parameter is the number of sides of a tube, or 0."""
    found = []
    for m in measure(count, repeats):
        tube_of = m.model.split()[2] if m.model.startswith("tube") else "0"
        more: dict[str, float | str] = {
            "term": m.term,
            "largest error with the best factor": m.scaled_worst,
            "RMS error without factor": m.rms,
            "largest error without factor": m.worst,
            "bytes per point": m.bytes,
        }
        name = "tube" if int(tube_of) else m.model
        way = f"{name}, {m.term}, {m.setting}"
        found.append(Row(way, int(tube_of), m.scaled_rms, m.nanoseconds, more))
    return found


def verdict(rows: Sequence[Row]) -> str:
    """Return which model to use for random lights and for a headlight."""
    choices = []
    for term in ("diffuse", "specular"):
        for setting in ("random", "headlight"):
            own = [r for r in rows if r.way.endswith(f", {term}, {setting}")]
            where = f"{term} with a headlight" if setting == "headlight" else term
            best = cheapest(own)
            least = min(own, key=lambda row: row.error)
            if best is None:
                choices.append(
                    f"{where}: none, '{_model(least)}' has an error of {least.error:.2g}"
                )
                continue
            choices.append(f"{where}: '{_model(best)}' at {words(best.cost)} ns per point")
            cheaper = [r for r in own if r.cost < best.cost and not r.parameter]
            if cheaper:
                near = min(cheaper, key=lambda row: row.error)
                choices[-1] += (
                    f" ('{_model(near)}' at {words(near.cost)} ns has an error of {near.error:.2g})"
                )
    return (
        f"models to use for an RMS error of 1/255, each with its best factor: {'; '.join(choices)}"
    )


def _model(row: Row) -> str:
    """Return the name of a row's model for a sentence."""
    name = row.way.split(f", {row.more['term']}")[0]
    return f"{name} of {row.parameter} sides" if row.parameter else name


def curve_of(term: str) -> Callable[[Row], Curve | None]:
    """Return the function from a row to its curve, for one term with random lights."""
    return lambda row: (
        Curve(row.way.removesuffix(f", {term}, random"), term)
        if row.way.endswith(f"{term}, random")
        else None
    )


STUDY = Study(
    approximates=f"diffuse and specular light of thin lines, N.H to the power {SHININESS:g}",
    reference="the exact light of a thin cylinder",
    parameter="sides of a tube, 0 for a line",
    error="RMS error of the term with its best factor",
    cost="ns per point",
    steps=lambda quick: [lambda: rows(4000 if quick else 20_000, 3)],
    verdict=verdict,
    curve=curve_of("diffuse"),
    beside=(Panel(curve=curve_of("specular")),),
)
