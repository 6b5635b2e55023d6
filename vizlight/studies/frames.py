"""Frames of a function by differences and by a complex step, against exact ones.

A torus in 4-space with waves on it, whose differences are not exact. Central differences fall with
the square of the step until rounding takes over; the complex step has no such end.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.geometry.nspace import manifolds
from vizlight.geometry.nspace.parametric import CENTRAL_STEP
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.studies._framework import PIXEL, Row, Study, holding, order, words
from vizlight.studies._measuring import take_turns

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight.geometry.nspace.manifolds import Manifold

R1, R2 = 1.5, 0.75
DOMAIN = [(0.0, 2 * np.pi)] * 2
SCENE = Scene(
    lights=Light(direction=(0.7, 0.6, 0.38, 0.2)), view=View(direction=(0.1, 0.3, 0.9, -0.2))
)
#: The default of differences, and steps tried, of the domain.
DEFAULT = float(f"{CENTRAL_STEP:.2g}")
CENTRAL = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, DEFAULT, 1e-8, 1e-10, 1e-12)
COMPLEX = (1e-4, 1e-8, 1e-30)


def wavy(t: Any, f: Any) -> tuple[Any, ...]:
    """Return a torus in 4-space with waves on it, whose differences are not exact."""
    r = R2 * (1 + 0.2 * np.cos(3 * t))
    return R1 * np.cos(t), R1 * np.sin(t), r * np.cos(f), r * np.sin(f)


def wavy_tangents(t: Any, f: Any) -> tuple[tuple[Any, ...], ...]:
    """Return the tangents of :func:`wavy`."""
    r, slope = R2 * (1 + 0.2 * np.cos(3 * t)), -0.6 * R2 * np.sin(3 * t)
    return (
        (-R1 * np.sin(t), R1 * np.cos(t), slope * np.cos(f), slope * np.sin(f)),
        (0.0, 0.0, -r * np.sin(f), r * np.cos(f)),
    )


def frame_errors(resolution: int = 128, repeats: int = 3) -> list[Row]:
    """Return the error of frames by the way they are made."""

    def sample(**options: Any) -> Manifold:
        return manifolds.parametric(wavy, DOMAIN, 4, resolution=resolution, closed=True, **options)

    exact = sample(tangents=wavy_tangents)
    ways: dict[tuple[str, float], dict[str, Any]] = {("exact", 0.0): {"tangents": wavy_tangents}}
    ways |= {("central differences", step): {"step": step} for step in CENTRAL}
    ways |= {("complex step", step): {"tangents": "complex", "step": step} for step in COMPLEX}
    seconds = take_turns({w: partial(sample, **o) for w, o in ways.items()}, repeats)
    truth = engine.shade(exact.points, exact.frame, SCENE).luminance
    found = []
    for (way, step), options in ways.items():
        shape = sample(**options)
        space = np.abs(_projector(shape) - _projector(exact)).max()
        light = np.abs(engine.shade(shape.points, shape.frame, SCENE).luminance - truth).max()
        cost = 1e9 * seconds[way, step] / len(shape.points)
        found.append(Row(way, step, float(light), cost, {"error of the space": float(space)}))
    return found


def _projector(shape: Manifold) -> Any:
    return np.einsum("bki,bkj->bij", shape.frame, shape.frame)


def verdict(rows: Sequence[Row]) -> str:
    """Return which way to take, its step, and the order of differences."""
    central = [row for row in rows if row.way.startswith("central")]
    best = min(central, key=lambda row: row.error)
    above = [row for row in central if float(row.parameter) >= float(best.parameter)]
    coarse = holding(above)
    said = (
        f"at 1/255 of error any step from {best.parameter:g} to {coarse.parameter:g} of the domain "
        "will do" if coarse
        else f"no step of central differences is within 1/255, the best leaves "
        f"{words(best.error / PIXEL)} of 255"
    )  # fmt: skip
    own = next((row for row in central if row.parameter == DEFAULT), best)
    # Between two steps that were tried the best one is not known.
    said += (
        f"; leave the step at its default, {own.parameter:g} (error {own.error:.1g}"
        if own.error <= 10 * best.error
        else f"; set the step to {best.parameter:g} (error {best.error:.1g}, that of the default "
        f"{own.error:.1g}"
    )
    smooth = [row for row in above if float(row.parameter) > 10 * float(best.parameter)]
    if len(smooth) > 1:
        said += f"; of order {order(smooth):.2f} above it, in theory 2"
    step = min((row for row in rows if row.way.startswith("complex")), key=lambda row: row.error)
    if step.error >= own.error:
        return f"{said}); tangents='complex' is no nearer: error {step.error:.1g}"
    return (
        f"{said}), and use tangents='complex' where the function takes complex numbers: error "
        f"{step.error:.1g} at {words(step.cost / own.cost)} times the time"
    )


STUDY = Study(
    approximates="tangents of a torus in 4-space with waves on it, and its light",
    reference="exact tangents",
    parameter="step / domain",
    error="largest error of luminance",
    cost="ns a point",
    steps=lambda quick: [partial(frame_errors, 64 if quick else 128, 3 if quick else 5)],
    verdict=verdict,
    axes=("parameter", "error"),
)
