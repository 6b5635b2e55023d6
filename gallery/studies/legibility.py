"""What a reader reads back under each light, of data and views on which no light was chosen.

Each row compares the mean error of a question under some light with that under the default of the
library, as :func:`vizlight.legibility` measures both. Surfaces are asked for direction with their
tangents, and for shape and value without. Lines are drawn a pixel wide: their smoothed edges leave
about half of the light of the key, which the reader of heading allows for.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from studies import Row, Study
from studies._readable import LINES, VIEWS, known
from vizlight import Light, Material, Scene, View, legibility
from vizlight._questions import QUESTIONS
from vizlight.filters.key import question_of
from vizlight.scene.presets import PRESETS, brightest_normal

#: Noise of the eye in CIELAB, as the meter has it.
NOISE = 2.3
#: Number of places on lines for each on a surface: information is counted in classes.
ON_LINES = 8
#: What the error of each question is.
ERRORS = {
    "direction": "share off by over 10 degrees",
    "slope": "bits of 4 that lack",
    "heading": "degrees in space",
    "shape": "degrees of the normal",
    "value": "share of the range, 95 %",
    "value, viridis": "share of the range, 95 %",
}


def _white():
    """Return three white lamps around the eye, as bright as the preset of shape."""
    turns = np.radians([90.0, 210.0, 330.0])
    ways = np.stack([np.cos(turns), np.sin(turns), np.ones(3)], axis=1) / np.sqrt(2)
    brightest = brightest_normal([(way, np.ones(3)) for way in ways])
    lamps = [Light(direction=way, follows_view=True, intensity=1 / brightest) for way in ways]
    return Scene(lights=lamps, material=Material(ambient=0.08, diffuse=0.92, specular=0.0))


LIGHTS = {
    "default": Scene,
    "default with a highlight": lambda: Scene(
        material=Material(ambient=0.12, diffuse=0.6, specular=0.2)
    ),
    "white lamp at the eye": lambda: Scene(
        lights=Light.headlight(), material=Material(ambient=0.1, diffuse=0.5, specular=0.4)
    ),
    "three white lamps": _white,
    **{f"presets.{name}": make for name, make in PRESETS.items()},
}


def errors(data, scene, view, samples, noise):
    """Return the error of each question that data can be asked."""
    ask = partial(legibility, data.mesh, scene, view=view, samples=samples, noise=noise)
    if data.tangents is None:
        found = ask()
        return {
            "slope": found.slope and 4 - found.slope.bits,
            "heading": found.heading and found.heading.median,
        }
    along = ask(tangents=data.tangents).direction
    if QUESTIONS[question_of(scene)].of_tangents:
        # A surface without tangents is refused in such a light.
        return {"direction": along and 1 - along.within_10}
    bare, shape = ask(scalars=data.scalars), ask().shape
    viridis = ask(scalars=data.scalars, cmap="viridis").value
    return {
        "direction": along and 1 - along.within_10,
        "shape": shape and shape.median,
        "value": bare.value and bare.value.p95,
        "value, viridis": viridis and viridis.p95,
    }


def lights(names, views, samples, noise=NOISE):
    """Return the mean error of each question under each light, beside that under the default."""
    found = {}
    for i, name in enumerate(names):
        data, count = known()[name](), samples * (ON_LINES if name in LINES else 1)
        for number in range(i, i + 4 * views, 4):
            view = View(direction=VIEWS[number % len(VIEWS)])
            for light, make in LIGHTS.items():
                for question, error in errors(data, make(), view, count, noise).items():
                    assert error is not None
                    found.setdefault((light, question), []).append(error)
    said = "" if noise == NOISE else f", noise {noise:g}"
    rows = []
    for (light, question), after in found.items():
        before = found["default", question]
        gains = np.subtract(before, after)
        more = {"error of": ERRORS[question], "best gain": float(gains.max())}
        more["gains on"] = f"{np.count_nonzero(gains > 0)} of {len(gains)}"
        rows.append(
            Row(light + said, question, float(np.mean(after)), float(np.mean(before)), more)
        )
    return rows


def steps(quick):
    """Return the steps: all lights, at one noise or at two."""
    if quick:
        return [partial(lights, ("nut", "childress"), 1, 96)]
    return [partial(lights, tuple(known()), 2, 512, noise) for noise in (NOISE, 2 * NOISE)]


STUDY = Study(
    approximates="what readers read back from pictures of lit data",
    reference="the data",
    parameter="question",
    error="error under the light",
    cost="error under the default",
    steps=steps,
    joined=False,
    diagonal="no gain",
)
