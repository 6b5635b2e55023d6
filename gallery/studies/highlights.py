"""The Blinn model as a substitute for the Phong model: its power, its error and its cost.

Rules for the Blinn power are compared over the lit and visible normals of a sphere, and over random
tangent spaces of several codimensions. Further rows measure the time of the engine's highlights by
both models. Errors are pixel values from 0 to 255.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from studies import Curve, Panel, Row, Study, holding, take_turns, words
from vizlight.model import highlights, reflection
from vizlight.scene import Light, Material, Scene, View
from vizlight.shading import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vizlight.shading.engine import Shading

DEGREES = (10.0, 30.0, 60.0, 90.0, 120.0, 150.0)
POWERS = (10.0, 40.0, 200.0)
#: Rules for the factor: formulas, with the common one first, and the result of a search.
CORRECTED = "4 cos(beta) corrected for r"
FORMULAS, SEARCHED = ("4", "4 cos(beta)", CORRECTED), "best by worst"
#: Power whose rules are drawn, and error of 255 below which a point is not drawn.
DRAWN, SEEN = 40.0, 1e-4


@dataclass(frozen=True)
class Rule:
    """Errors of one rule for the ratio of the Blinn power to the Phong power r, at one angle."""

    degrees: float
    r: float
    rule: str
    factor: float
    worst: float
    rms: float
    volume: float


@dataclass(frozen=True)
class Codimension:
    """Errors of one rule over random tangent spaces, for one angle between light and eye."""

    k: int
    c: int
    rule: str
    factor: float
    worst: float
    rms: float


def rules(degrees: float, r: float) -> list[Rule]:
    """Return the errors of each rule for one angle between light and eye."""
    angle = float(np.deg2rad(degrees))
    factors = {
        "4": 4.0,
        "4 cos(beta)": float(highlights.simple_factor(angle)),
        CORRECTED: float(highlights.simple_factor(angle, r)),
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
    """Return the errors of three rules over uniformly random k-spaces in k + c dimensions.

    The angle between light and eye is given in degrees; ``r`` is the Phong power.
    """
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
        error = 255 * np.asarray(phong - blinn)
        rms = float(np.sqrt(np.mean(error * error)))
        found.append(Codimension(k, c, rule, factor, float(np.abs(error).max()), rms))
    return found


@dataclass(frozen=True)
class Exchange:
    """Cost of the Phong highlight of lines and of its Blinn substitute, and the error."""

    degrees: float
    shininess: float
    phong: float
    blinn: float
    bound: float
    error: float


def exchange(
    degrees: float, shininess: float, count: int = 1_000_000, repeats: int = 5
) -> Exchange:
    """Return the costs in ns per point (one thread, float32), the error bound and the error."""
    random = np.random.default_rng(20)
    points, tangents = (random.standard_normal((count, 3)).astype(np.float32) for _ in range(2))
    angle = np.deg2rad(degrees)
    factor = float(highlights.simple_factor(angle, shininess))

    def light(model: Literal["phong", "blinn"]) -> Shading:
        power = shininess if model == "phong" else factor * shininess
        scene = Scene(
            lights=Light(direction=(np.sin(angle), 0, np.cos(angle))),
            view=View(direction=(0, 0, 1)),
            material=Material(ambient=0, diffuse=0, specular=1, shininess=power),
        )
        return engine.shade(points, tangents, scene, model=model)

    ways = {"phong": lambda: light("phong"), "blinn": lambda: light("blinn")}
    seconds = take_turns(ways, repeats)
    exact, made = (light(model).luminance for model in ("phong", "blinn"))
    return Exchange(
        degrees,
        shininess,
        phong=1e9 * seconds["phong"] / count,
        blinn=1e9 * seconds["blinn"] / count,
        bound=abs(float(highlights.max_pixel_error(angle, shininess, factor=factor).error)),
        error=255 * float(np.abs(exact - made).max()),
    )


def rows_of_rules(degrees: float, r: float) -> list[Row]:
    """Return one row for each rule at one angle."""
    return [
        Row(
            f"rule {row.rule}", degrees, row.worst, np.nan,
            {"power": r, "factor": row.factor, "RMS": row.rms, "mean size": row.volume},
        )
        for row in rules(degrees, r)
    ]  # fmt: skip


def rows_of_codimension(k: int, c: int, count: int) -> list[Row]:
    """Return one row for each rule over random tangent spaces."""
    return [
        Row(
            f"rule {row.rule}, k = {k}, codimension {c}", 60.0, row.worst, np.nan,
            {"power": 10.0, "factor": row.factor, "RMS": row.rms},
        )
        for row in codimension(k, c, count=count)
    ]  # fmt: skip


def rows_of_exchange(degrees: float, shininess: float, count: int) -> list[Row]:
    """Return the rows of the engine's Phong highlight and of Blinn's in its place."""
    made = exchange(degrees, shininess, count)
    return [
        Row(f"engine, Phong of power {shininess:g}", degrees, 0.0, made.phong),
        Row(
            f"engine, Blinn for power {shininess:g}", degrees, made.error, made.blinn,
            {"power": shininess, "bound": made.bound},
        ),
    ]  # fmt: skip


def steps(quick: bool) -> list[Callable[[], Iterable[Row]]]:
    """Return the steps: rules, codimensions, substitution."""
    powers = POWERS[1:2] if quick else POWERS
    sizes = (1, 2) if quick else (1, 2, 3)
    count, many = (20_000, 200_000) if quick else (200_000, 1_000_000)
    found: list[Callable[[], Iterable[Row]]] = []
    found += [partial(rows_of_rules, degrees, r) for degrees in DEGREES for r in powers]
    found += [partial(rows_of_codimension, k, c, count) for c in sizes for k in sizes]
    found += [
        partial(rows_of_exchange, degrees, s, many)
        for s in (20.0, 100.0)
        for degrees in (2.0, 5.0, 10.0, 30.0, 60.0)
    ]
    return found


def verdict(rows: Sequence[Row]) -> str:
    """Return the rule to use, and what the substitution saves at each power."""
    worst = {
        rule: max(row.error for row in rows if row.way == f"rule {rule}")
        for rule in (*FORMULAS, SEARCHED)
    }
    best = min(FORMULAS, key=lambda rule: worst[rule])
    rest = ", ".join(f"{rule}: {worst[rule]:.4g}" for rule in FORMULAS if rule != best)
    return (
        f"use {best} times the Phong power, with a largest error of {worst[best]:.4g} of 255 "
        f"({rest}, the best factor by search: {worst[SEARCHED]:.4g}); {_substitution(rows)}"
    )


def _substitution(rows: Sequence[Row]) -> str:
    """Return up to which angles Blinn's model is within 1 of 255 of Phong's, and the time."""
    blinn: dict[float, list[Row]] = {}
    for row in rows:
        if row.way.startswith("engine, Blinn"):
            bound = row._replace(error=float(row.more["bound"]))
            blinn.setdefault(float(row.more["power"]), []).append(bound)
    ranges, allowed = [], []
    for power, own in sorted(blinn.items()):
        last, first = holding(own, 1.0), min(own, key=lambda row: float(row.parameter))
        if last is None:
            ranges.append(
                f"at no angle for power {power:g} (its bound is {words(first.error)} of 255 at "
                f"{first.parameter:g} degrees)"
            )
            continue
        allowed += [row for row in own if float(row.parameter) <= float(last.parameter)]
        ranges.append(f"up to {last.parameter:g} degrees between light and eye for power {power:g}")
    where = f"Blinn's model is within 1 of 255 of Phong's {', '.join(ranges)}"
    if not allowed:
        return where
    exact = [(f"engine, Phong of power {row.more['power']:g}", row.parameter) for row in allowed]
    phong = sum(row.cost for row in rows if (row.way, row.parameter) in exact)
    ratio = sum(row.cost for row in allowed) / phong
    return f"{where}; its time is {words(ratio)} times that of the Phong model"


def curve_of_rules(row: Row) -> Curve | None:
    """Return the curve of a rule on a sphere for one power."""
    rule = row.way.startswith("rule ") and ", k = " not in row.way
    return Curve(row.way) if rule and row.more["power"] == DRAWN else None


def curve_of_exchange(row: Row) -> Curve | None:
    """Return the curve of a substitution, except for negligible errors."""
    name, _, kind = row.way.partition(" for ")
    return Curve(name, kind) if name == "engine, Blinn" and row.error >= SEEN else None


STUDY = Study(
    approximates="highlight of the Phong model by the Blinn model",
    reference="the Phong model with the same light",
    parameter="angle between light and eye, degrees",
    error="largest error, of 255",
    cost="ns per point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "error"),
    curve=curve_of_rules,
    beside=(Panel(axes=("parameter", "error"), curve=curve_of_exchange),),
)
