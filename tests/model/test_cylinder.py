"""The exact line light: its range, and derivatives by differences in 50 digits."""

import numpy as np
import oracles
import pytest
from oracles import mp
from refusals import refusals

from vizlight.model import cylinder


@pytest.mark.parametrize("s", [0.0, 5.0, 20.0, 1e3, 1e6, 1e9])
def test_values_stay_in_range_however_near_to_degenerate(s, dtype, random):
    t = np.eye(3)[0]
    wi, wo = random.standard_normal((2, 200, 3))
    scale = 10.0 ** random.uniform(-20, 0, (200, 1))
    wi = np.concatenate([t + scale * wi, wi, wi]).astype(dtype)
    wo = np.concatenate([wo, t + scale * wo, -wi[400:] + scale * wo]).astype(dtype)
    for value, top in (
        (cylinder.diffuse(wi, wo, t.astype(dtype)), np.pi / 4),
        (cylinder.specular(wi, wo, t.astype(dtype), shininess=s), 1.0),
    ):
        assert np.isfinite(value).all()
        assert value.min() >= -4 * oracles.eps(dtype)
        assert value.max() <= top + 8 * oracles.eps(dtype)


@pytest.mark.parametrize("s", [0.0, 1.0, 3.5, 20.0, 100.0])
def test_gradients_are_those_of_the_oracle(s, random, claim):
    """By differences, which 50 digits leave 30."""
    step = mp.mpf("1e-20")
    for _ in range(10):
        v = random.standard_normal((3, 3))
        found = (cylinder.diffuse_gradient(*v), cylinder.specular_gradient(*v, shininess=s))
        for j, i in np.ndindex(3, 3):
            ends = []
            for way in (step, -step):
                moved = oracles.exact(v)
                moved[j][i] += way
                ends.append(oracles.line_light(*moved, s))
            for after, before, gradient in zip(*ends, found, strict=True):
                slope = (after - before) / (2 * step)
                claim(abs(slope - oracles.exact(gradient[j][i])), 1e-8)


def test_gradients_of_many_and_where_there_are_none(dtype, random):
    wi, wo, t = random.standard_normal((3, 20, 3)).astype(dtype)
    wi[0], wi[1], wo[2], t[3] = t[0], 0, t[2], np.nan
    for gradient in (
        cylinder.diffuse_gradient(wi, wo, t),
        cylinder.specular_gradient(wi, wo, t, shininess=9),
    ):
        for part, own in zip(gradient, (wi, wo, t), strict=True):
            assert part.shape == (20, 3)
            assert part.dtype == dtype
            assert not np.any(part[:4])
            assert np.all(np.any(part[4:] != 0, axis=1))
            along = np.sum(part[4:] * own[4:], axis=1)
            assert np.abs(along).max() < 1e3 * oracles.eps(dtype)
    # In line with the eye the light has a derivative still: that of a headlight, pi / 4 |wi_N|.
    wi, t = np.array([0.6, 0, 0.8]), np.array([1.0, 0, 0])
    gradient = cylinder.diffuse_gradient(wi, wi, t)
    np.testing.assert_allclose(gradient.tangent, [0, 0, -np.pi / 4 * 0.6 / 0.8 * 0.8], atol=1e-12)


def test_broadcasting_equals_a_loop(dtype, random):
    wi = random.standard_normal((4, 1, 3)).astype(dtype)
    wo = random.standard_normal(3).astype(dtype)
    t = random.standard_normal((5, 3)).astype(dtype)
    value = cylinder.specular(wi, wo, t, shininess=12)
    assert value.shape == (4, 5)
    for i, j in np.ndindex(4, 5):
        one = cylinder.specular(wi[i, 0], wo, t[j], shininess=12)
        np.testing.assert_allclose(value[i, j], one, atol=32 * oracles.eps(dtype))
    assert cylinder.diffuse(np.empty((0, 3)), wo, [1, 0, 0]).shape == (0,)


test_bad_input = refusals(
    lambda call: call(),
    (lambda: cylinder.diffuse([1, 0], [1, 0, 0], [1, 0, 0]), "wi: expected"),
    (lambda: cylinder.diffuse([1, 0, 0], "eye", [1, 0, 0]), "wo: expected", TypeError),
    (lambda: cylinder.diffuse([1, 0, 0], [1, 0, 0], [1, 0]), "tangent: expected"),
    (
        lambda: cylinder.specular([1, 0, 0], [1, 0, 0], [1, 0, 0], shininess=-1),
        "shininess: expected",
    ),
)
