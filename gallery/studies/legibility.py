"""What a reader reads back: lights by question, and what each option of the light gains.

Each row compares the error of a question under some light with that under another one: a light
with the default of the library, or an option with the light that it changes. Data sets and views
are those that no light was chosen on.
"""

from __future__ import annotations

import dataclasses
from functools import cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from studies import Row, Study
from studies._readable import LINES, VIEWS, known
from vizlight import DepthCue, Light, Material, Scene, View, illuminate
from vizlight.filters import lighting
from vizlight.filters.tint import color_table
from vizlight.observers import record
from vizlight.observers.colors import shown
from vizlight.observers.samples import parts_of, places_of, seen_from
from vizlight.scene.presets import PRESETS, brightest_normal
from vizlight.shading.options import LightOptions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vizlight.observers.samples import Part, Sample

NOISE = 2 / 255
#: Gain of an error that is not one of the sample: share, degrees, bits.
LEAST = {
    "direction": 0.01, "key": 1.0, "slope": 0.05, "heading": 0.5, "shape": 1.0, "value": 0.01,
    "value, viridis": 0.01,
}  # fmt: skip
#: What the error of each question is.
ERRORS = {
    "direction": "share off by over 10 degrees",
    "key": "degrees, by the key",
    "slope": "bits of 4 that lack",
    "heading": "degrees in space",
    "shape": "degrees of the normal",
    "value": "share of the range, 95 %",
    "value, viridis": "share of the range, 95 %",
}
#: Light by which each question is asked best.
BEST = {name: name for name in ("direction", "slope", "heading", "shape", "value")}
BEST |= {"key": "direction", "value, viridis": "value"}


class Option(NamedTuple):
    """A change of a scene, or of how it is shaded."""

    scene: Callable[[Scene], Scene] = lambda scene: scene
    how: tuple[tuple[str, Any], ...] = ()
    lines: bool | None = None


def _of_material(**fields: Any) -> Option:
    return Option(
        lambda scene: scene.replace(material=dataclasses.replace(scene.material, **fields))
    )


OPTIONS = {
    "model='blinn'": Option(how=(("model", "blinn"),)),
    "model='cylinder'": Option(how=(("model", "cylinder"),), lines=True),
    "conditioned=True": Option(how=(("conditioned", True),), lines=False),
    "exponent=1": Option(how=(("exponent", 1.0),)),
    "exponent=2": Option(how=(("exponent", 2.0),)),
    "specular=0": _of_material(specular=0.0),
    "specular=0.4": _of_material(specular=0.4, shininess=20.0),
    "specular=0.4, shininess=5": _of_material(specular=0.4, shininess=5.0),
    "specular=0.4, shininess=80": _of_material(specular=0.4, shininess=80.0),
    "ambient=0.3": _of_material(ambient=0.3),
    "ambient=0": _of_material(ambient=0.0),
    "color": _of_material(color=(0.9, 0.6, 0.4)),
    "specular_color": _of_material(specular=0.4, specular_color=(1.0, 0.6, 0.2)),
    "depth_cue": Option(lambda scene: scene.replace(depth_cue=DepthCue(back_scale=0.5))),
    "ambient_color": Option(lambda scene: scene.replace(ambient_color=(0.6, 0.7, 1.0))),
    "bundle=True": Option(lines=True),
    "lamps nearby": Option(),
}


def _white() -> Scene:
    """Return three white lamps around the eye, as bright as the preset of shape."""
    turns = np.radians([90.0, 210.0, 330.0])
    ways = np.stack([np.cos(turns), np.sin(turns), np.ones(3)], axis=1) / np.sqrt(2)
    brightest = brightest_normal([(way, np.ones(3)) for way in ways])
    lamps = [Light(direction=way, follows_view=True, intensity=1 / brightest) for way in ways]
    return Scene(lights=lamps, material=Material(ambient=0.08, diffuse=0.92, specular=0.0))


def _eye() -> Scene:
    """Return a white lamp at the eye, with a highlight."""
    material = Material(ambient=0.1, diffuse=0.5, specular=0.4)
    return Scene(lights=Light.headlight(), material=material)


def _highlight() -> Scene:
    """Return the lamps of the default scene with a highlight."""
    return Scene(material=Material(ambient=0.12, diffuse=0.6, specular=0.2))


LIGHTS: dict[str, Callable[[], Scene]] = {
    "default with a highlight": _highlight,
    "white lamp at the eye": _eye,
    "three white lamps": _white,
    **{f"presets.{name}": make for name, make in PRESETS.items()},
}
#: Number of places on lines for each on a surface: information is counted in classes.
ON_LINES = 8
#: Name of the light of a scene that names none.
DEFAULT = "presets.value"


class Place(NamedTuple):
    """Places of one picture of a data set, and the table of its colours."""

    taken: list[tuple[Sample, Part]]
    lines: bool
    name: str
    view: View


@cache
def _place(name: str, number: int, samples: int) -> Place:
    """Return a random sample of what a view of a data set shows."""
    data, view = known()[name](), View(direction=VIEWS[number])
    own = list(known()).index(name)
    camera, scene = seen_from(data.mesh, Scene(view=view), None)
    options = LightOptions(tangents=data.tangents)
    parts = parts_of(data.mesh, scene, options, data.scalars)
    taken, _, _ = places_of(parts, camera, scene, samples, np.random.default_rng(own))
    return Place(taken, name in LINES, name, view)


def _bundled(place: Place, scene: Scene, samples: int) -> Place:
    """Return the same places in light that lines take from each other."""
    data = known()[place.name]()
    lit = illuminate(data.mesh, scene, bundle=True)
    camera, scene = seen_from(lit, scene, None)
    parts = parts_of(lit, scene, LightOptions(), None)
    own = list(known()).index(place.name)
    taken, _, _ = places_of(parts, camera, scene, samples, np.random.default_rng(own))
    return place._replace(taken=taken)


def _nearby(place: Place, scene: Scene) -> Scene:
    """Return a scene whose lamps stand as far from the middle as the data are large."""
    points = np.concatenate([one.points for one, _ in place.taken])
    middle, size = points.mean(axis=0), float(np.ptp(points, axis=0).max())
    lamps = []
    for light in (one.seen_from(place.view) for one in scene.lights):
        way = np.array(light.direction)
        position = middle + size * way / np.linalg.norm(way)
        lamps.append(Light(position=position, intensity=light.intensity, color=light.color))
    return scene.replace(lights=lamps)


def questions(place: Place) -> list[str]:
    """Return the questions of a data set."""
    return (
        ["slope", "heading"]
        if place.lines
        else ["direction", "key", "shape", "value", "value, viridis"]
    )


def error(
    place: Place, question: str, scene: Scene, how: dict[str, Any], noise: float
) -> tuple[float, float]:
    """Return the error of a question under a light, and the mean gray of the places, 0 to 255."""
    scene = scene.replace(view=place.view)
    scene = lighting.fit_depth_cue(scene, [part.inputs for _, part in place.taken])
    bare = question not in ("direction", "key", "slope", "heading")
    taken = [
        (
            dataclasses.replace(
                sample,
                scene=scene,
                tangents=None if bare else sample.tangents,
                options=dataclasses.replace(
                    sample.options,
                    **how,
                ),
            ),
            part,
        )
        for sample, part in place.taken
    ]
    samples = [sample for sample, _ in taken]
    gray = float(255 * np.mean([shown(one.own_light()).mean() for one in samples]))
    notes: list[str] = []
    if question in ("direction", "key"):
        found = record.of_direction(samples, 0, noise, notes)
        assert found is not None
        assert found.legend_median is not None
        return (1 - found.within_10 if question == "direction" else found.legend_median), gray
    if question in ("slope", "heading"):
        steep = record.of_slope(samples, 0, noise, notes)
        assert steep is not None
        assert steep.median is not None
        return (4 - steep.bits if question == "slope" else steep.median), gray
    if question == "shape":
        normals = record.of_shape(samples, 0, noise, notes)
        assert normals is not None
        return normals.median, gray
    values = [np.asarray(part.values) for _, part in taken]
    cmap = "viridis" if question.endswith("viridis") else None
    read = record.of_value(taken, color_table(values, cmap=cmap), notes)
    assert read is not None
    return read.p95, gray


def _row(
    way: str, question: str, light: str, pairs: Sequence[tuple[float, float]], gray: float
) -> Row:
    """Return a row of pairs of errors, without and with what is measured."""
    before, after = np.array(pairs).T
    gain = before - after
    return Row(
        way,
        question,
        float(after.mean()),
        float(before.mean()),
        {
            "error of": ERRORS[question],
            "beside": light,
            "best gain": float(gain.max()),
            "mean gain": float(gain.mean()),
            "gains on": f"{np.count_nonzero(gain > LEAST[question])} of {len(gain)}",
            "mean gray": gray,
        },
    )


def lights(places: Iterable[Place], noise: float = NOISE) -> list[Row]:
    """Return the error of each question under each light, beside that under the default."""
    found = []
    every = list(places)
    for question in ERRORS:
        if question.startswith("value") and noise != NOISE:
            continue  # values are read off the bytes, without noise
        asked = [place for place in every if question in questions(place)]
        base = [error(place, question, Scene(), {}, noise)[0] for place in asked]
        for name, make in LIGHTS.items():
            pairs, grays = [], []
            for place, before in zip(asked, base, strict=True):
                after, gray = error(place, question, make(), {}, noise)
                pairs.append((before, after))
                grays.append(gray)
            way = name if noise == NOISE else f"{name}, noise {255 * noise:g}/255"
            if pairs:
                found.append(_row(way, question, DEFAULT, pairs, float(np.mean(grays))))
    return found


_KNOWN: dict[tuple[str, View, str, str], float] = {}


def _before(place: Place, light: str, question: str) -> float:
    """Return the error under a light as it is, which many options are compared with."""
    key = place.name, place.view, light, question
    if key not in _KNOWN:
        _KNOWN[key] = error(place, question, LIGHTS[light](), {}, NOISE)[0]
    return _KNOWN[key]


def option(name: str, places: Iterable[Place], samples: int) -> list[Row]:
    """Return what an option changes in the best light of each question, and in the default."""
    chosen, every, found = OPTIONS[name], list(places), []
    for question in ERRORS:
        if "conditioned" in dict(chosen.how) and question not in ("direction", "key"):
            continue  # the others are asked of a surface without tangents
        asked = [place for place in every if question in questions(place)]
        asked = [place for place in asked if chosen.lines in (None, place.lines)]
        for light in dict.fromkeys((f"presets.{BEST[question]}", DEFAULT)):
            pairs, grays = [], []
            for place in asked:
                scene = LIGHTS[light]().replace(view=place.view)
                bundled = name.startswith("bundle")
                changed = _bundled(place, scene, samples) if bundled else place
                before = _before(place, light, question)
                other = _nearby(place, scene) if name == "lamps nearby" else chosen.scene(scene)
                after, gray = error(changed, question, other, dict(chosen.how), NOISE)
                pairs.append((before, after))
                grays.append(gray)
            if pairs:
                found.append(_row(name, question, light, pairs, float(np.mean(grays))))
    return found


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return the steps: lights at two noises, and each option."""
    names = ("nut", "childress") if quick else tuple(known())
    count, samples = (1, 96) if quick else (2, 512)

    def places() -> list[Place]:
        return [
            _place(name, (i + 4 * j) % len(VIEWS), samples * (ON_LINES if name in LINES else 1))
            for i, name in enumerate(names)
            for j in range(count)
        ]

    made: list[Callable[[], list[Row]]] = [lambda: lights(places())]
    if not quick:
        made.append(lambda: lights(places(), 4 / 255))
    some = ("model='blinn'", "exponent=2", "specular=0.4") if quick else tuple(OPTIONS)
    return [*made, *(partial(_option, name, places, samples) for name in some)]


def _option(name: str, places: Callable[[], list[Place]], samples: int) -> list[Row]:
    return option(name, places(), samples)


STUDY = Study(
    approximates="what ideal readers read back from pictures of lit data",
    reference="the data",
    parameter="question",
    error="error with it",
    cost="error without it",
    steps=steps,
    joined=False,
    diagonal="no gain",
)
