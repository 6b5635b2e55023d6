"""Time that ``tolerance=`` saves, over settings of light, eye, manifold and shininess.

Each setting is lit with the exact forms and with a tolerance of 1/255, in turn, by NumPy and by
compiled code, in one thread. Where nothing is cheaper the plan is that of the exact forms: the gain
is 1 and nothing is timed.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _compiled
from vizlight.scene import Light, Material, Scene, View
from vizlight.shading import engine
from vizlight.shading.decide import decide
from vizlight.shading.inputs import Layout
from vizlight.shading.options import ShadingOptions
from vizlight.studies._framework import PIXEL, Row, Study, words
from vizlight.studies._measuring import take_turns

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vizlight.shading.plan import Plan

FAR = View(direction=(0.2, -0.1, 1.0))
PLACES: dict[str, dict[str, Any]] = {
    "near light": {"lights": Light(position=(4.0, 5.0, 6.0)), "view": View(position=(0, 1.0, 9))},
    "far light": {"lights": Light(direction=(1.0, 2.0, 0.5)), "view": FAR},
    "headlight": {"lights": Light.headlight(), "view": FAR},
}
#: Manifold, options and material of the settings at each place.
KINDS: tuple[tuple[str, dict[str, Any], Material], ...] = (
    ("lines", {}, Material(shininess=20)),
    ("lines", {}, Material(shininess=20.4)),
    ("surface", {}, Material(shininess=20)),
    ("surface", {}, Material(shininess=20.4)),
    ("lines", {"model": "cylinder"}, Material(shininess=20)),
    ("lines", {}, Material(specular=0)),
)
CODES = {"NumPy": "0", "compiled": "1"}


def settings() -> Iterator[tuple[str, Scene, str, dict[str, Any]]]:
    """Yield the name, the scene, the manifold and the options of the 20 settings."""
    cases = [(place, *kind) for place in PLACES for kind in KINDS]
    cases.append(("near light", "lines on a surface", {}, Material(shininess=20)))
    cases.append(("far light", "lines", {"model": "blinn"}, Material(shininess=20.4)))
    for place, manifold, options, material in cases:
        light = f"power {material.shininess:g}" if material.specular else "no highlight"
        name = ", ".join([place, manifold, *options.values(), light])
        yield name, Scene(material=material, **PLACES[place]), manifold, options


def measure(code: str, kind: str, count: int, repeats: int) -> list[Row]:
    """Return one row for each setting, lit by one code in one type."""
    random = np.random.default_rng(5)
    points, tangents, normals = (
        random.standard_normal((count, 3), dtype=np.float32).astype(kind) for _ in range(3)
    )
    rows = []
    with _compiled.setting(CODES[code]):
        for name, scene, manifold, options in settings():
            chosen: dict[str, Any] = {**options, "threads": 1}
            if manifold != "lines":
                chosen["normals"] = normals
            along = None if manifold == "surface" else tangents
            light = partial(engine.shade, points, along, scene, **chosen)
            layout = Layout(3, None if along is None else 1, manifold != "lines")
            plan = decide(
                scene, layout, ShadingOptions(tolerance=PIXEL, **options), narrow=kind == "float32"
            )
            rows.append(_row(f"{code}, {kind}", name, plan, light, count, repeats))
    return rows


def _row(
    way: str, name: str, plan: Plan, light: Callable[..., engine.Shading], count: int, repeats: int
) -> Row:
    """Return the row of a setting, of which exact forms are not timed against themselves."""
    if not plan.choice.cheaper:
        return Row(way, name, 0.0, math.nan, {"gain": 1.0, "chosen": "the exact forms"})
    exact, near = light().luminance, light(tolerance=PIXEL).luminance
    error = float(np.abs(near - exact).max())
    seconds = take_turns({"exact": light, "near": partial(light, tolerance=PIXEL)}, repeats)
    notes = [note.rsplit(", within", 1)[0] for note in plan.choice.notes]
    if plan.highlight_error:
        notes.append("highlight: Blinn's model")
    more: dict[str, float | str] = {
        "gain": seconds["exact"] / seconds["near"], "chosen": "; ".join(notes),
    }  # fmt: skip
    return Row(way, name, error, 1e9 * seconds["near"] / count, more)


def verdict(rows: Sequence[Row]) -> str:
    """Return the gains of each code and type."""
    found = []
    for way in dict.fromkeys(row.way for row in rows):
        gains = [float(row.more["gain"]) for row in rows if row.way == way]
        cheaper = [gain for gain in gains if gain != 1]
        text = f"{way}: nothing is cheaper in {len(gains) - len(cheaper)} of {len(gains)} settings"
        if cheaper:
            text += (
                f", in the others the median gain is {words(float(np.median(cheaper)))} and the "
                f"least {words(min(cheaper))}; over all the median is "
                f"{words(float(np.median(gains)))}"
            )
        found.append(text)
    worst = max(row.error for row in rows)
    kept = "is kept" if worst <= PIXEL else "is not kept"
    return f"a tolerance of 1/255 {kept} (largest difference {worst:.2g}); {'. '.join(found)}"


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return the steps: one for each code and type."""
    count, repeats = (100_000, 5) if quick else (1_000_000, 9)
    codes = [code for code in CODES if code == "NumPy" or _compiled.active()]
    return [
        partial(measure, code, kind, count, repeats)
        for code in codes
        for kind in ("float32", "float64")
    ]


STUDY = Study(
    approximates="light within a tolerance of 1/255 by the cheapest forms",
    reference="the exact forms",
    parameter="setting",
    error="largest difference of luminance",
    cost="processor ns per point",
    steps=steps,
    verdict=verdict,
    joined=False,
)
