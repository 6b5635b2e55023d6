"""Frames of a function from differences and from a complex step, compared with exact frames.

The function is a torus in 4-space with waves, for which differences are not exact. The error of
central differences falls with the square of the step until rounding dominates; the complex step
has no such limit.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studies import SHINY, Row, Study, take_turns
from vizlight._types import Array, Numbers
from vizlight.geometry.nspace import manifolds
from vizlight.geometry.nspace.parametric import CENTRAL_STEP
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

if TYPE_CHECKING:
    from vizlight.geometry.nspace.manifolds import Manifold

R1, R2 = 1.5, 0.75
DOMAIN = [(0.0, 2 * np.pi)] * 2
SCENE = Scene(
    lights=Light(direction=(0.7, 0.6, 0.38, 0.2)),
    view=View(direction=(0.1, 0.3, 0.9, -0.2)),
    material=SHINY,
)
#: Default step of the differences, and steps that are measured, as fractions of the domain.
DEFAULT = float(f"{CENTRAL_STEP:.2g}")
CENTRAL = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, DEFAULT, 1e-8, 1e-10, 1e-12)
COMPLEX = (1e-4, 1e-8, 1e-30)

Components: TypeAlias = tuple[Numbers | float, ...]


def wavy(t: Numbers, f: Numbers) -> Components:
    """Return the points of a torus in 4-space with waves."""
    r = R2 * (1 + 0.2 * np.cos(3 * t))
    return R1 * np.cos(t), R1 * np.sin(t), r * np.cos(f), r * np.sin(f)


def wavy_tangents(t: Numbers, f: Numbers) -> tuple[Components, ...]:
    """Return the exact tangents of :func:`wavy`."""
    r, slope = R2 * (1 + 0.2 * np.cos(3 * t)), -0.6 * R2 * np.sin(3 * t)
    return (
        (-R1 * np.sin(t), R1 * np.cos(t), slope * np.cos(f), slope * np.sin(f)),
        (0.0, 0.0, -r * np.sin(f), r * np.cos(f)),
    )


def frame_errors(resolution: int = 128, repeats: int = 3) -> list[Row]:
    """Return the errors of frames, one row for each method and step."""
    sample = partial(manifolds.parametric, wavy, DOMAIN, 4, resolution=resolution, closed=True)
    ways = {("exact", 0.0): partial(sample, tangents=wavy_tangents)}
    ways |= {("central differences", step): partial(sample, step=step) for step in CENTRAL}
    ways |= {
        ("complex step", step): partial(sample, tangents="complex", step=step) for step in COMPLEX
    }
    seconds = take_turns(ways, repeats)
    exact = ways["exact", 0.0]()
    truth = engine.shade(exact.points, exact.frame, SCENE).luminance
    found = []
    for (way, step), work in ways.items():
        shape = work()
        space = np.abs(_projector(shape) - _projector(exact)).max()
        light = np.abs(engine.shade(shape.points, shape.frame, SCENE).luminance - truth).max()
        cost = 1e9 * seconds[way, step] / len(shape.points)
        found.append(Row(way, step, float(light), cost, {"error of the space": float(space)}))
    return found


def _projector(shape: Manifold) -> Array:
    """Return the projection matrices on the tangent spaces, which do not depend on the basis."""
    return np.asarray(np.einsum("bki,bkj->bij", shape.frame, shape.frame))


STUDY = Study(
    approximates="tangents of a torus in 4-space with waves, and its light",
    reference="exact tangents",
    parameter="step / domain",
    error="largest error of luminance",
    cost="ns per point",
    steps=lambda quick: [partial(frame_errors, 64 if quick else 128, 3 if quick else 5)],
    axes=("parameter", "error"),
)
