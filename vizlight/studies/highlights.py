"""Phong against Blinn: the tables of Fisher and Woo, the better rule, and higher codimension.

``python -m vizlight.studies.highlights`` prints them all. Errors are pixel values of 255.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cyclopts
import numpy as np

from vizlight import engine
from vizlight.light import Light
from vizlight.model import highlights, reflection
from vizlight.scene import Material, Scene, View
from vizlight.studies._measure import print_table, take_turns

DEGREES = (0.0, 30.0, 60.0, 90.0, 120.0, 150.0)
POWERS = (10.0, 40.0, 200.0)


@dataclass(frozen=True)
class Rule:
    """One rule for Blinn's power over Phong's, at one angle and shininess."""

    degrees: float
    r: float
    rule: str
    factor: float
    worst: float
    rms: float
    volume: float


@dataclass(frozen=True)
class Codimension:
    """Errors over random tangent spaces, light and eye at one angle."""

    k: int
    c: int
    rule: str
    factor: float
    worst: float
    rms: float


def rules(degrees: float, r: float) -> list[Rule]:
    """Return the errors of each rule at one angle between light and eye."""
    angle = float(np.deg2rad(degrees))
    factors = {
        "4": 4.0,
        "4 cos(beta)": float(highlights.simple_factor(angle)),
        "the same, for r": float(highlights.simple_factor(angle, r)),
        "best by worst": float(highlights.best_factor(angle, r)),
        "best by RMS": float(highlights.best_factor(angle, r, by="rms")),
        "best by volume": float(highlights.best_factor(angle, r, by="volume")),
    }
    return [
        Rule(
            degrees,
            r,
            rule,
            factor,
            *(
                highlights.sphere_error(angle, r, factor=factor, by=by)
                for by in ("worst", "rms", "volume")
            ),
        )
        for rule, factor in factors.items()
    ]


def codimension(
    k: int, c: int, degrees: float = 60.0, r: float = 10.0, count: int = 200_000
) -> list[Codimension]:
    """Return the errors of three rules over uniformly random k-spaces in k + c dimensions."""
    random, n = np.random.default_rng(1994), k + c
    beta = np.deg2rad(degrees) / 2
    wi, wo = np.zeros((2, n))
    wi[:2], wo[:2] = (np.cos(beta), np.sin(beta)), (np.cos(beta), -np.sin(beta))
    frame = np.swapaxes(np.linalg.qr(random.standard_normal((count, n, k)))[0], 1, 2)
    phong = reflection.specular(wi, wo, frame, shininess=r)
    found = []
    for rule, factor in (
        ("4", 4.0),
        ("4 cos(beta)", float(highlights.simple_factor(2 * beta))),
        ("equal volume", float(highlights.exchange_rate(2 * beta, k=k, n=n))),
    ):
        blinn = reflection.specular(wi, wo, frame, shininess=factor * r, model="blinn")
        error: Any = 255 * (phong - blinn)
        rms = float(np.sqrt(np.mean(error * error)))
        found.append(Codimension(k, c, rule, factor, float(np.abs(error).max()), rms))
    return found


@dataclass(frozen=True)
class Exchange:
    """Phong's highlight of lines, as asked for and by Blinn's within an error."""

    degrees: float
    shininess: float
    phong: float
    blinn: float
    bound: float
    error: float


def exchange(
    degrees: float, shininess: float, count: int = 1_000_000, repeats: int = 5
) -> Exchange:
    """Return ns a point of both, one thread, float32, and the bound and the error seen."""
    random = np.random.default_rng(20)
    points, tangents = (random.standard_normal((count, 3)).astype(np.float32) for _ in range(2))
    angle = np.deg2rad(degrees)
    scene = Scene(
        lights=Light(direction=(np.sin(angle), 0, np.cos(angle))),
        view=View(direction=(0, 0, 1)),
        material=Material(ambient=0, diffuse=0, specular=1, shininess=shininess),
    )

    def light(allowed: float) -> Any:
        return engine.shade(points, tangents, scene, threads=1, highlight_error=allowed)

    ways = {"phong": lambda: light(0.0), "blinn": lambda: light(255.0)}
    seconds = take_turns(ways, repeats)
    asked, made = light(0.0), light(255.0)
    return Exchange(
        degrees,
        shininess,
        phong=1e9 * seconds["phong"] / count,
        blinn=1e9 * seconds["blinn"] / count,
        bound=made.plan.highlight_error,
        error=255 * float(np.abs(asked.luminance - made.luminance).max()),
    )


def main(count: int = 1_000_000) -> None:
    """Print the tables.

    Parameters
    ----------
    count
        How many points are lit where time is taken.
    """
    rho = (5, 20, 40, 60, 80, 85, 87, 89, 89.5, 89.9)
    required = highlights.required_factor(np.deg2rad(rho))
    print_table(
        "Required f for rho in degrees, any exponent (Fisher and Woo, table 1)",
        ("rho", *(f"{x:g}" for x in rho)),
        [("f", *(f"{f:.4f}" for f in required))],
    )
    r = np.arange(5, 46, 5)
    print_table(
        "Blinn minus Phong, f = 4, light, normal and eye coplanar (table 2)",
        ("rho", *(f"r = {x}" for x in r)),
        [
            (f"{x}", *(f"{e:.3f}" for e in highlights.pixel_error(np.deg2rad(x), r)))
            for x in (10, 20, 30, 40, 50, 60, 70, 80, 85)
        ],
    )
    angles = np.arange(0, 181, 30)
    print_table(
        "Phong minus Blinn, f = 4, the largest of all normals (table 3)",
        ("r", *(f"{x} deg" for x in angles)),
        [
            (
                f"{x}",
                *(f"{e:.2f}" for e in highlights.max_pixel_error(np.deg2rad(angles), x).error),
            )
            for x in (10, 20, 40, 60, 80, 100, 200, 300, 400)
        ],
    )
    print_table(
        "The factor by which Blinn comes nearest to Phong; errors over lit and visible normals",
        ("rule", "[L, E]", "r", "f", "worst", "RMS", "mean size"),
        [
            (
                row.rule,
                f"{row.degrees:g}",
                f"{row.r:g}",
                f"{row.factor:.3f}",
                f"{row.worst:.2f}",
                f"{row.rms:.3f}",
                f"{row.volume:.4f}",
            )
            for degrees in DEGREES
            for r in POWERS
            for row in rules(degrees, r)
        ],
    )
    print_table(
        "k-manifolds of codimension c, light and eye at 60 degrees, r = 10, random tangent spaces",
        ("rule", "k", "c", "f", "worst", "RMS"),
        [
            (
                row.rule,
                f"{row.k}",
                f"{row.c}",
                f"{row.factor:.3f}",
                f"{row.worst:.2f}",
                f"{row.rms:.2f}",
            )
            for c in (1, 2, 3)
            for k in (1, 2, 3)
            for row in codimension(k, c)
        ],
    )
    print_table(
        f"highlight_error=: specular term of {count} lines, float32, one thread, H constant",
        ("[L, E]", "power", "Phong, ns a point", "Blinn, ns a point", "bound", "error seen"),
        [
            (
                f"{row.degrees:g}",
                f"{row.shininess:g}",
                f"{row.phong:.1f}",
                f"{row.blinn:.1f}",
                f"{row.bound:.2f}",
                f"{row.error:.2f}",
            )
            for degrees in (10.0, 30.0, 60.0)
            for s in (20.0, 100.0)
            for row in [exchange(degrees, s, count)]
        ],
    )
    widths = (0.02, 0.05, 0.1, 0.2)
    print_table(
        "terminator=: the most that a smooth end takes from a highlight of Phong of power 20",
        ("[L, E]", *(f"{width:g}" for width in widths)),
        [
            (
                f"{degrees}",
                *(
                    f"{highlights.terminator_error(np.deg2rad(degrees), 20.0, width):.2f}"
                    for width in widths
                ),
            )
            for degrees in (60, 90, 120, 150, 170)
        ],
    )


if __name__ == "__main__":
    cyclopts.run(main)
