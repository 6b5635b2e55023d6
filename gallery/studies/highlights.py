"""Blinn's highlight in place of Phong's on a unit ball, with a near eye and a near lamp.

From the centre of the ball, lamp and eye are 90 degrees apart, and the eye or both are at a
distance from there; a near lamp alone has the errors of a near eye, since both models exchange the
two. Fisher and Woo say that the errors of a far eye hold from about 5 units on. The error is the
largest difference of both highlights over the points that face lamp and eye, for Phong's power 40.
Its bound is :func:`vizlight.model.highlights.max_pixel_error` of the largest angle between lamp and
eye at these points.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from studies import Curve, Row, Study, take_turns
from vizlight.model import highlights
from vizlight.scene import Light, Material, Scene, View
from vizlight.shading import engine

POWER = 40.0
ANGLE = np.pi / 2
TOWARD = {"lamp": np.array([np.sin(ANGLE), 0, np.cos(ANGLE)]), "eye": np.array([0.0, 0, 1])}
FACTORS = {"factor 4": 4.0, "factor 4 cos(angle / 2)": float(highlights.simple_factor(ANGLE))}


def ball(count):
    """Return points that are even on a unit ball."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = np.pi * (1 + 5**0.5) * np.arange(count)
    ring = np.sqrt(1 - z * z)
    return np.stack([ring * np.cos(angle), ring * np.sin(angle), z], axis=1)


def place(name, near, distance):
    """Return the keywords of a lamp or an eye: a position if it is near."""
    if name in near and np.isfinite(distance):
        return {"position": distance * TOWARD[name]}
    return {"direction": TOWARD[name]}


def ways(name, near, distance, points):
    """Return unit vectors from points toward a lamp or an eye."""
    keywords = place(name, near, distance)
    if "direction" in keywords:
        return np.broadcast_to(TOWARD[name], points.shape)
    to = keywords["position"] - points
    return to / np.linalg.norm(to, axis=1, keepdims=True)


def measure(near, distance, count, repeats):
    """Return a row for each factor."""
    points = ball(count)
    wi, wo = (ways(name, near, distance, points) for name in TOWARD)
    seen = (np.sum(points * wi, axis=1) > 0) & (np.sum(points * wo, axis=1) > 0)
    points, apart = points[seen], np.linalg.norm((wi - wo)[seen], axis=1)
    angle = 2 * np.arcsin(min(apart.max() / 2, 1.0))

    def light(model, power):
        scene = Scene(
            lights=Light(**place("lamp", near, distance)),
            view=View(**place("eye", near, distance)),
            material=Material(ambient=0, diffuse=0, specular=1, shininess=power),
        )
        return engine.shade(points, None, scene, normals=points, model=model).luminance

    works = {"Phong": partial(light, "phong", POWER), "Blinn": partial(light, "blinn", 4 * POWER)}
    nanoseconds = {way: 1e9 * s / len(points) for way, s in take_turns(works, repeats).items()}
    rows = []
    for rule, factor in FACTORS.items():
        error = 255 * np.abs(light("blinn", factor * POWER) - light("phong", POWER)).max()
        bound = highlights.max_pixel_error(angle, POWER, factor=factor, lit=True).error
        more = {"bound": abs(float(bound)), "Phong, ns per point": nanoseconds["Phong"]}
        rows.append(Row(f"{rule}, {near}", distance, float(error), nanoseconds["Blinn"], more))
    return rows


STUDY = Study(
    approximates="Phong's highlight on a unit ball by Blinn's, eye and lamp at a distance",
    reference="Phong's highlight",
    parameter="distance from the centre",
    error="largest error in pixel values",
    cost="ns per point",
    axes=("parameter", "error"),
    steps=lambda quick: [
        partial(measure, near, distance, 50_000 if quick else 1_000_000, 3)
        for near in ("eye", "eye and lamp")
        for distance in (1.5, 2.0, 3.0, 5.0, 10.0, 20.0, np.inf)
    ],
    curve=lambda row: Curve(*reversed(row.way.rsplit(", ", 1))),
)
