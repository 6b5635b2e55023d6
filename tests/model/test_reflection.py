"""Diffuse and specular light of k-manifolds: laws first, then 50 digits."""

import numpy as np
import oracles
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusals
from vectors import unit

from vizlight.model import frames, reflection

SIZES = [(1, 2), (1, 3), (2, 3), (1, 4), (2, 4), (3, 4), (3, 8)]


@pytest.mark.parametrize("model", ["phong", "blinn"])
def test_codimension_1_is_the_textbook_highlight(model, random):
    normal = np.array([0.0, 0, 1])
    frame = np.eye(3)[:2]
    wi, wo = random.standard_normal((2, 300, 3))
    wi[:, 2], wo[:, 2] = np.abs(wi[:, 2]), np.abs(wo[:, 2])
    wi /= np.linalg.norm(wi, axis=1, keepdims=True)
    wo /= np.linalg.norm(wo, axis=1, keepdims=True)
    half = (wi + wo) / np.linalg.norm(wi + wo, axis=1, keepdims=True)
    mirror = 2 * (wi @ normal)[:, np.newaxis] * normal - wi
    base = np.sum(mirror * wo, axis=1) if model == "phong" else half @ normal
    expected = np.maximum(base, 0) ** 7
    value = reflection.specular(wi, wo, frame, shininess=7, model=model)
    np.testing.assert_allclose(value, expected, atol=1e-14)


@pytest.mark.parametrize("model", ["phong", "blinn"])
@pytest.mark.parametrize(("k", "n"), SIZES)
def test_highlight_is_brightest_where_the_reflection_meets_the_eye(model, k, n, random):
    frame = oracles.frames(random, 1, k, n, float)[0]
    wi = unit(random.standard_normal(n))
    along, across = frames.split(wi, frame)
    towards = random.standard_normal(n)
    _, size = frames.split(towards, frame)
    normal = (towards - frame.T @ (frame @ towards)) / size
    if model == "blinn":  # the half vector is normal only where wi_N and wo_N agree
        normal = (wi - frame.T @ along) / across
    mirror = across * normal - frame.T @ along
    peak = reflection.specular(wi, mirror, frame, shininess=50, model=model)
    assert peak == pytest.approx(1.0, abs=1e-12)
    others = mirror + 0.3 * random.standard_normal((200, n))
    assert np.all(reflection.specular(wi, others, frame, shininess=50, model=model) <= 1 + 1e-12)
    same_way = across * normal + frame.T @ along
    if np.linalg.norm(along) > 0.3:
        assert reflection.specular(wi, same_way, frame, shininess=50, model=model) < 0.9 * peak


def test_a_line_reflects_into_a_cone():
    """All eyes at the mirror angle to the line see the full highlight, however far round."""
    tangent = np.array([[0.0, 0, 1]])
    wi = unit([1.0, 0, 0.5])
    angles = np.linspace(0, 2 * np.pi, 17)
    cone = np.stack([np.cos(angles), np.sin(angles), np.full(17, -0.5)], axis=1)
    np.testing.assert_allclose(reflection.specular(wi, cone, tangent, shininess=30), 1, atol=1e-13)


vector = st.tuples(*[st.floats(-1, 1, width=32)] * 4).filter(lambda v: np.linalg.norm(v) > 0.1)


@given(vector, vector, vector, st.sampled_from(["phong", "blinn"]))
def test_light_and_eye_may_change_places(a, wi, wo, model):
    frame, _ = frames.orthonormalize([a])
    there = reflection.specular(wi, wo, frame, shininess=5, model=model)
    back = reflection.specular(wo, wi, frame, shininess=5, model=model)
    assert there == pytest.approx(float(back), abs=1e-13)
    assert 0 <= there <= 1 + 1e-14


def test_shininess_0_is_bright_everywhere():
    frame = [[1.0, 0, 0]]
    assert reflection.specular([1, 0, 1], [1, 0, 1], frame, shininess=0) == 1


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
