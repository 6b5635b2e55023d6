"""Shapes of highlights and what is refused; values are those of the stability suite."""

import numpy as np
import oracles
import pytest
import scipy.special
from refusals import refusals

from vizlight.model import brightness, cylinder, reflection


def test_shininess_0_is_bright_everywhere():
    frame = [[1.0, 0, 0]]
    assert reflection.specular([1, 0, 1], [1, 0, 1], frame, shininess=0) == 1


def test_the_plain_law_and_phong_are_the_defaults():
    frame, slant = [[0.0, 0, 1]], [1.0, 0, 1]
    assert reflection.diffuse(slant, frame) == pytest.approx(0.5**0.5)
    assert reflection.specular([1, 0, 0], slant, frame, shininess=1) == pytest.approx(0.5**0.5)


@pytest.mark.parametrize(("k", "n"), [(1, 3), (1, 4), (2, 4), (3, 5), (1, 7)])
def test_the_mean_over_the_promoted_manifold_is_the_diffuse_light(k, n, random, claim):
    """Lambert's light over M x S^(c-1), whose normals are the unit vectors of the normal space."""
    frame, wi = oracles.frames(random, 1, k, n, float)[0], random.standard_normal(n)
    normals = random.standard_normal((100_000, n))
    normals -= normals @ frame.T @ frame
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosines = np.maximum(normals @ wi / np.linalg.norm(wi), 0)
    # Half of the mean of a cosine over all directions of the normal space.
    share = brightness.mean_intensity(n - k - 1, n - k) / 2
    error = abs(cosines.mean() / share - reflection.diffuse(wi, frame))
    assert error < 5 * cosines.std() / share / len(normals) ** 0.5
    claim(error, 0.02)


def test_the_mean_over_a_fibre_depends_on_the_eye_as_the_source_says():
    """Kajiya's integral over the lit half, 2 r, by the length that an eye sees: 1 to 2 / pi."""
    wi, line = np.array([0.6, 0.48, 0.64]), np.array([1.0, 0.0, 0.0])
    angle = 2 * np.pi * np.arange(100_000) / 100_000
    normals = np.stack([0 * angle, np.cos(angle), np.sin(angle)], axis=1)
    integral = 2 * np.pi * np.maximum(normals @ wi, 0).mean()
    plain = reflection.diffuse(wi, [line])
    across = np.array([0.0, *wi[1:]]) / np.hypot(*wi[1:])
    half = np.pi * np.linspace(-0.5, 0.5, 20_001)
    lit = np.outer(np.cos(half), across) + np.outer(np.sin(half), np.cross(line, across))
    for between in np.radians([90, 60, 30, 10, 0]):
        eye = np.cos(between) * line + np.sin(between) * across
        seen = lit - np.outer(lit @ eye, eye)
        length = np.linalg.norm(np.diff(seen, axis=0), axis=1).sum()
        # Half of an ellipse: 2 across the line, and pi along it.
        share = 1 / scipy.special.ellipe(np.sin(between) ** 2)
        assert integral / length == pytest.approx(share * plain, abs=1e-6)
    # The exact mean of the visible half, by its projected width.
    assert cylinder.diffuse(wi, wi, line) == pytest.approx(np.pi / 4 * plain)
    assert cylinder.diffuse(wi, line, line) == pytest.approx(1 / np.pi * plain)


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
