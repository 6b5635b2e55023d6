"""Shapes of highlights and what is refused; values are those of the stability suite."""

import numpy as np
import oracles
import pytest
from refusals import refusals

from vizlight.model import reflection


def test_shininess_0_is_bright_everywhere():
    frame = [[1.0, 0, 0]]
    assert reflection.specular([1, 0, 1], [1, 0, 1], frame, shininess=0) == 1


def test_the_plain_law_and_phong_are_the_defaults():
    frame, slant = [[0.0, 0, 1]], [1.0, 0, 1]
    assert reflection.diffuse(slant, frame) == pytest.approx(0.5**0.5)
    assert reflection.specular([1, 0, 0], slant, frame, shininess=1) == pytest.approx(0.5**0.5)


def test_broadcasting_equals_a_loop(dtype, random):
    frame = oracles.frames(random, 5, 1, 3, dtype)
    wi = random.standard_normal((4, 1, 3)).astype(dtype)
    wo = random.standard_normal(3).astype(dtype)
    value = reflection.specular(wi, wo, frame, shininess=10)
    assert value.shape == (4, 5)
    for i, j in np.ndindex(4, 5):
        one = reflection.specular(wi[i, 0], wo, frame[j], shininess=10)
        np.testing.assert_allclose(value[i, j], one, atol=16 * oracles.eps(dtype))


test_bad_input = refusals(
    lambda call: call([[1.0, 0, 0]]),
    (lambda f: reflection.diffuse([1, 0, 0], f, exponent=-1), "exponent: expected"),
    (
        lambda f: reflection.diffuse([1, 0, 0], f, exponent="2"),
        "exponent: expected a number",
        TypeError,
    ),
    (lambda f: reflection.diffuse([1, 0], f), "wi: expected vectors"),
    (lambda f: reflection.specular([1, 0, 0], [1, 0], f, shininess=1), "wo: expected"),
    (
        lambda f: reflection.specular([1, 0, 0], [1, 0, 0], f, shininess=float("nan")),
        "shininess: expected",
    ),
    (
        lambda f: reflection.specular([1, 0, 0], [1, 0, 0], f, shininess=1, model="gouraud"),
        "model: expected 'phong' or 'blinn', got 'gouraud'",
    ),
)
