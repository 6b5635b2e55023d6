"""Small, valid calls of the functions of arrays, for the walk with adversarial values."""

from __future__ import annotations

import numpy as np
from scipy import sparse

import vizlight
from vizlight import Light, View

UP = (0.3, -0.2, 1.0)


def unit(*shape, seed=0):
    """Return random unit vectors."""
    rows = np.random.default_rng(seed).normal(size=shape)
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def frame(*shape):
    """Return random frames of orthonormal rows."""
    q = np.linalg.qr(np.swapaxes(unit(*shape, seed=1), -1, -2))[0]
    return np.ascontiguousarray(np.swapaxes(q, -1, -2))


def triangles():
    """Return points and triangles of a tetrahedron."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    return points, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def grid():
    """Return axes and heights of a height field."""
    x, y = np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 6)
    return {"x": x, "y": y, "z": 0.2 * np.sin(4 * y)[:, None] * np.cos(3 * x)}


def cylinder(**more):
    """Return arguments of a function of the line light."""
    return lambda: {
        "wi": unit(4, 3),
        "wo": unit(4, 3, seed=2),
        "tangent": unit(4, 3, seed=3),
        **more,
    }


def half():
    """Return arguments of a function of the half vector."""
    return lambda: {
        "wi": unit(4, 3),
        "wo": unit(4, 3, seed=2),
        "normal": unit(4, 3, seed=3),
    }


#: Arguments of a valid call by the name of the callable; positional ones by name too.
CALLS = {
    "geometry.contours.banding.Laminae.order": lambda: {"toward": UP},
    "geometry.contours.isoluminance.truncus": lambda: {
        "center": (0, 0, 0),
        "axis": (0, 0, 1),
        "radii": (1.0, 0.5),
        "height": 1.0,
        "direction": UP,
        "levels": 4,
    },
    "geometry.contours.isoluminance.sphere": lambda: {
        "center": (0, 0, 0),
        "radius": 1.0,
        "direction": UP,
        "levels": 4,
    },
    "geometry.contours.isoluminance.virtual_light": lambda: {
        "center": (0, 0, 0),
        "light": Light(position=(3, 0, 0)),
        "eye": View(position=(0, 4, 0)),
    },
    "geometry.lines.curves.polyline_tangents": lambda: {"points": np.cumsum(unit(5, 3), axis=0)},
    "geometry.lines.fur.seeds": lambda: dict(
        zip(("points", "faces"), triangles(), strict=True), count=5
    ),
    "geometry.nspace.manifolds.complex_curve": lambda: {"function": np.square, "resolution": 4},
    "geometry.nspace.manifolds.klein_bottle": lambda: {"resolution": (6, 5)},
    "geometry.nspace.manifolds.sphere3": lambda: {"resolution": 4},
    "geometry.nspace.manifolds.veronese": lambda: {"resolution": 4},
    "geometry.nspace.parametric.Manifold": lambda: {
        "points": unit(4, 3),
        "frame": frame(4, 2, 3),
        "cells": np.array([[0, 1, 3, 2]]),
    },
    "geometry.nspace.parametric.parametric": lambda: {
        "function": lambda u, v=0.5: (np.cos(u), np.sin(u), v, u * v),
        "domain": ((0.0, 3.0), (0.0, 1.0)),
        "n": 4,
        "resolution": 4,
    },
    "geometry.nspace.projection.image_and_depth": lambda: {"points": unit(5, 4), "distance": 3.0},
    "geometry.nspace.projection.perspective": lambda: {"points": unit(5, 4), "distance": 3.0},
    "geometry.nspace.projection.plane_rotation": lambda: {"n": 4, "plane": "xw", "angle": 0.3},
    "geometry.nspace.projection.push_forward": lambda: {
        "vectors": unit(5, 1, 4),
        "points": unit(5, 4),
        "distance": 3.0,
    },
    "geometry.nspace.projection.push_frame": lambda: {
        "frame": frame(5, 2, 4),
        "points": unit(5, 4),
        "distance": 3.0,
    },
    "geometry.nspace.projection.rotation": lambda: {"n": 4, "turns": ("xw", 0.3)},
    "geometry.nspace.projection.turn": lambda: {"vectors": unit(5, 4), "matrix": np.eye(4)},
    "geometry.nspace.slices.cut": lambda: {
        "values": np.linspace(-1, 1.1, 5),
        "simplices": np.array([[0, 1, 2, 3], [1, 2, 3, 4]]),
    },
    "geometry.nspace.slices.mean_frame": lambda: {
        "frame": frame(3, 2, 4),
        "shares": sparse.csr_array(np.eye(3)),
    },
    "geometry.nspace.slices.slice_frame": lambda: {"frame": frame(3, 2, 4), "normal": unit(4)},
    "geometry.nspace.manifolds.clifford_torus": lambda: {"resolution": (6, 5)},
    "geometry.nspace.manifolds.hopf_fibres": lambda: {"fibres": 3, "resolution": 8},
    "geometry.nspace.manifolds.torus": lambda: {"radii": (1.0, 0.5), "resolution": 6},
    "geometry.nspace.manifolds.torus_curve": lambda: {"ratio": 1.5, "resolution": 16},
    "geometry.relief.depth_map.depth_map": lambda: {
        "x": np.linspace(0, 1, 5),
        "y": np.linspace(0, 1, 4),
        **dict(zip(("points", "triangles"), triangles(), strict=True)),
    },
    "geometry.relief.shadowing.inside_length": lambda: {
        **grid(),
        "points": np.array([[0.5, 0.5, -0.3]]),
        "direction": UP,
    },
    "geometry.relief.shadowing.shadow": lambda: {**grid(), "depth": 0.1, "direction": UP},
    "geometry.relief.sun.directions": lambda: {"latitude": 0.8, "day": 100.0, "hours": [9.0, 12.0]},
    "geometry.relief.sun.disc": lambda: {"direction": UP, "diameter": 0.01, "count": 5},
    "geometry.relief.sun.toward": lambda: {"azimuth": [0.3, 1.0], "altitude": 0.5},
    "geometry.solids.primitives.Boolean": lambda: {
        "operation": "union",
        "first": vizlight.Sphere(),
        "second": vizlight.Block(),
    },
    "geometry.solids.primitives.Solid.contains": lambda: {"points": unit(4, 3)},
    "geometry.solids.primitives.Solid.rotate_vector": lambda: {"vector": UP, "angle": 0.3},
    "geometry.solids.primitives.Solid.rotate_x": lambda: {"angle": 0.3},
    "geometry.solids.primitives.Solid.rotate_y": lambda: {"angle": 0.3},
    "geometry.solids.primitives.Solid.rotate_z": lambda: {"angle": 0.3},
    "geometry.solids.primitives.Solid.scale": lambda: {"factor": 2.0},
    "geometry.solids.primitives.Solid.translate": lambda: {"xyz": (1.0, 0.0, 0.0)},
    "geometry.solids.polyhedra.Polyhedron": lambda: dict(
        zip(("points", "triangles"), triangles(), strict=True)
    ),
    "geometry.solids.polyhedra.Prism": lambda: {"outline": [[0, 0], [1, 0], [0, 1]]},
    "geometry.solids.primitives.Frustum": lambda: {"height": 1.0},
    "geometry.solids.tessellation.tessellate": lambda: {
        "solid": vizlight.Sphere(),
        "tolerance": 0.1,
    },
    "model.brightness.exponent": lambda: {"k": 2, "n": 4},
    "model.brightness.mean_intensity": lambda: {"k": 2, "n": 4, "p": [1.0, 2.0]},
    "model.cylinder.diffuse": cylinder(),
    "model.cylinder.diffuse_gradient": cylinder(),
    "model.cylinder.specular": cylinder(shininess=20.0),
    "model.cylinder.specular_gradient": cylinder(shininess=20.0),
    "model.falloff.depth_cue": lambda: {
        "intensity": [0.5, 1.0],
        "z": [1.0, 2.0],
        "front": 0.5,
        "back": 3.0,
    },
    "model.falloff.distance": lambda: {"d": [0.5, 2.0], "c1": 1.0, "c2": 0.1, "c3": 0.1},
    "model.falloff.fur": lambda: {"height": [0.1, 0.5], "sin_alpha": [0.3, 1.0], "density": 0.3},
    "model.frames.orthonormalize": lambda: {"vectors": unit(4, 2, 3)},
    "model.frames.split": lambda: {"direction": unit(4, 3), "frame": frame(4, 2, 3)},
    "model.half_vector.identity": half(),
    "model.half_vector.reflection": half(),
    "model.half_vector.reflection_cosine": lambda: {"nu": [0.1, 0.2], "beta": 0.3, "theta": 0.4},
    "model.half_vector.reflection_from_half": lambda: {"n_h": [0.5, 0.9], "triple": 0.1},
    "model.highlights.best_factor": lambda: {"light_eye_angle": [1.0], "r": [10.0]},
    "model.highlights.blinn_from_phong": lambda: {"shininess": [10.0], "light_eye_angle": 1.0},
    "model.highlights.exchange_rate": lambda: {"light_eye_angle": [0.5, 1.0]},
    "model.highlights.max_pixel_error": lambda: {"light_eye_angle": [1.0], "r": [10.0]},
    "model.highlights.phong_from_blinn": lambda: {"shininess": [10.0], "light_eye_angle": 1.0},
    "model.highlights.pixel_error": lambda: {"rho": [0.1, 0.2], "r": 10.0},
    "model.highlights.required_factor": lambda: {"rho": [0.1, 0.2]},
    "model.highlights.simple_factor": lambda: {"light_eye_angle": [1.0], "r": [10.0]},
    "model.highlights.sphere_error": lambda: {"light_eye_angle": 1.0, "r": 10.0},
    "model.reflection.diffuse": lambda: {"wi": unit(4, 3), "frame": frame(4, 2, 3)},
    "model.reflection.specular": lambda: {
        "wi": unit(4, 3),
        "wo": unit(4, 3, seed=2),
        "frame": frame(4, 2, 3),
        "shininess": 20.0,
    },
}
