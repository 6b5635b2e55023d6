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
from functools import partial

import numpy as np
import pyvista as pv

from studies import SHINY, Curve, Row, Study, take_turns
from vizlight.data import load_example
from vizlight.draw import render
from vizlight.filters.illuminate import illuminate
from vizlight.filters.streamlines import streamlines
from vizlight.model import brightness, cylinder, highlights, reflection
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

SHININESS = 20.0
SIDES = (3, 4, 6, 8, 12, 20, 40)
#: Nodes of the quadrature along a face.
NODES = 16


def directions(count, *, headlight):
    """Return reproducible random unit vectors: toward light, toward eye, tangents."""
    random = np.random.default_rng(2005)
    v = random.standard_normal((3, count, 3))
    v /= np.linalg.norm(v, axis=-1, keepdims=True)
    return (v[1] if headlight else v[0]), v[1], v[2]


def tube(wi, wo, tangent, sides, *, shininess=SHININESS):
    """Return the mean diffuse and specular light over the width of tubes."""
    random = np.random.default_rng(sides)

    def across(v):
        return v - np.sum(v * tangent, axis=1, keepdims=True) * tangent

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


def measure(count=20_000, repeats=3):
    """Return the errors and costs of each model, for random lights and for a headlight.

    The parameter is the number of sides of a tube, or 0.
    """
    rows = []
    costs = _costs(repeats)
    for setting in ("random", "headlight"):
        wi, wo, t = directions(count, headlight=setting == "headlight")
        frame, phong = t[:, np.newaxis], float(highlights.phong_from_blinn(SHININESS))
        shine = partial(reflection.specular, wi, wo, frame)
        compensated = reflection.diffuse(wi, frame, exponent=brightness.exponent(1, 3))
        found = {
            "diffuse": [
                ("exact", 0, "cylinder", cylinder.diffuse(wi, wo, t)),
                ("Banks, p = 1", 0, "line", reflection.diffuse(wi, frame)),
                ("Banks, p(1, 3)", 0, "line", compensated),
            ],
            "specular": [
                ("exact", 0, "cylinder", cylinder.specular(wi, wo, t, shininess=SHININESS)),
                ("Blinn", 0, "line, Blinn", shine(shininess=SHININESS, model="blinn")),
                (f"Banks' Phong, power {phong:g}", 0, "line", shine(shininess=phong)),
            ],
        }
        for sides in SIDES:
            for term, value in zip(found, tube(wi, wo, t, sides), strict=True):
                found[term].append(("tube", sides, f"tube {sides}", value))
        for term, own in found.items():
            exact = own[0][-1]
            for model, sides, cost, value in own:
                way = f"{model}, {term}, {setting}"
                rows.append(_row(way, sides, value, exact, *costs[cost]))
    return rows


def _row(way, sides, value, exact, seconds, size):
    """Return the errors of one model, without and with the best common factor."""
    factor = float(np.sum(value * exact) / np.sum(value * value))
    plain, scaled = value - exact, factor * value - exact
    more = {
        "largest error with the best factor": float(np.abs(scaled).max()),
        "RMS error without factor": float(np.sqrt(np.mean(plain * plain))),
        "largest error without factor": float(np.abs(plain).max()),
        "bytes per point": size,
    }
    return Row(way, sides, float(np.sqrt(np.mean(scaled * scaled))), seconds, more)


def _costs(repeats, count=200_000):
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

    def size(mesh):
        """Return the bytes per point of the line, including the light of the mesh in float32."""
        return (1024 * mesh.actual_memory_size + 4 * mesh.n_points) / line.n_points

    costs = {way: (each[way], size(line)) for way in ("line", "line, Blinn", "cylinder")}
    for sides in SIDES:
        costs[f"tube {sides}"] = (sides * each["surface"], size(line.tube(n_sides=sides)))
    return costs


def drawn(seeds=300, repeats=5):
    """Return the rows of lit streamlines and of their tubes: points, memory, time of a frame."""
    flow = load_example()
    camera = render.camera_on(flow.bounds, (1, 0.5, 0.3))
    scene = Scene(lights=Light(direction=(1, 0.9, 0.5)), view=View.from_camera(camera))
    bare = streamlines(flow, scene, tangents="V", seeds=seeds)
    bare.clear_data()
    tubes = bare.tube(radius=flow.length / 800, n_sides=20)
    rows = []
    for way, mesh, model in ("streamlines", bare, "cylinder"), ("their tubes", tubes, "phong"):
        lit = illuminate(mesh, scene, model=model)
        plotter = render.make_plotter(
            lit, camera=camera, size=(800, 800), anti_aliasing=None, light="points"
        )
        plotter.show(auto_close=False)

        def turn(plotter=plotter):
            plotter.camera.azimuth += 1.0
            plotter.render()

        spent = take_turns({"": turn}, repeats)[""]
        plotter.close()
        more = {"points": lit.n_points, "MB": lit.actual_memory_size / 1e3, "ms": 1e3 * spent}
        rows.append(Row(way, 20 * (mesh is tubes), np.nan, np.nan, more))
    return rows


def _curve(row):
    """Return the curve of a row with random lights."""
    model, _, rest = row.way.rpartition(", ")[0].rpartition(", ")
    return Curve(model, rest) if row.way.endswith("random") else None


STUDY = Study(
    approximates=f"diffuse and specular light of thin lines, N.H to the power {SHININESS:g}",
    reference="the exact light of a thin cylinder",
    parameter="sides of a tube, 0 for a line",
    error="RMS error of the term with its best factor",
    cost="ns per point",
    steps=lambda quick: [
        lambda: measure(4000 if quick else 20_000, 3),
        lambda: drawn(30 if quick else 300, 3 if quick else 5),
    ],
    curve=_curve,
)
