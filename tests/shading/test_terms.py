"""The light of the terms is that of the oracle within the stated bounds.

``python tests/differential.py`` compares many more plans.
"""

# A formula that is changed in a test is read as in its file.
from __future__ import annotations

import dataclasses
import math

import differential
import numpy as np
import pytest

from vizlight.model import formulas


@pytest.fixture(scope="module")
def cases():
    """60 random cases of as many forms, with their light in 50 digits."""
    found = []
    for number in range(10_000, 10_060):
        random = np.random.default_rng(number)
        made = differential.case(differential.frame(random), random)
        found.append((made, differential.truth(made)))
    return found


def test_light_is_that_of_the_oracle_within_the_stated_bounds(cases):
    counted = 0
    for made, true in cases:
        ratio, points = differential.compare(made, true)
        assert ratio <= 1, made
        counted += points
    assert counted > 60 * differential.POINTS * 0.8


@pytest.mark.sampled(5)
@pytest.mark.parametrize("size", [1e-42, 1e-25, 1e15, 1e25, 1e39, 1e120])
@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_lamps_out_of_the_range_of_float32_have_the_light_of_the_oracle(size, precision):
    counted = 0
    for number in range(10):
        random = np.random.default_rng((3, number))
        form = differential.frame(random)
        form = form._replace(options=dataclasses.replace(form.options, precision=precision))
        made = differential.case(form, random)
        place = tuple(size * random.normal(size=form.n))
        lights = [
            light if light.position is None else dataclasses.replace(light, position=place)
            for light in made.scene.lights
        ]
        made = made._replace(scene=made.scene.replace(lights=lights))
        true = differential.truth(made)
        ratio, points = differential.compare(made, true)
        assert ratio <= 1, made
        counted += points
    assert counted > 10 * differential.POINTS * 0.6


@pytest.mark.sampled(4)
@pytest.mark.parametrize("shininess", [0, 0.3, 1, 2, 5, 7.5])
def test_a_cylinder_of_low_shininess_has_the_light_of_the_oracle(shininess):
    for number in range(6):
        random = np.random.default_rng((4, number))
        form = differential.frame(random)
        while form.kind != "cylinder":
            form = differential.frame(random)
        made = differential.case(form, random)
        material = dataclasses.replace(made.scene.material, shininess=shininess)
        made = made._replace(scene=made.scene.replace(material=material))
        ratio, _ = differential.compare(made, differential.truth(made))
        assert ratio <= 1, made


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("phong", "sine_i - sine_o", "sine_i + sine_o"),
        ("blinn", "0.5 * shininess", "0.25 * shininess"),
        ("attenuation", "linear + distance", "linear - distance"),
        ("depth_scale", "3.0 - 2.0 * t", "2.0 - t"),
        ("fur_path", "height / sine", "height * sine"),
    ],
)
def test_a_wrong_formula_is_found(name, old, new, cases, monkeypatch):
    """The comparison can fail: one term of one formula is broken."""
    import inspect

    text = inspect.getsource(getattr(formulas, name))
    assert old in text
    scope = dict(vars(formulas))
    exec(text.replace(old, new), scope)
    monkeypatch.setattr(formulas, name, scope[name])
    assert worst_of(cases) > 1


def worst_of(cases):
    """Return the largest error of the light, up to the first beyond the bound.

    It is infinite where points without light are others than those of the oracle.
    """
    worst = 0.0
    for made, true in cases:
        try:
            worst = max(worst, differential.compare(made, true)[0])
        except AssertionError:
            worst = math.inf
        if worst > 1:
            break
    return worst
