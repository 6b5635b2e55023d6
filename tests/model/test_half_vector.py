"""N.H and R.E: every relation against the reflection itself."""

import numpy as np
import pytest

from vizlight.model import half_vector


def test_conversions_of_n_h_to_r_e(random):
    wi, wo, normal = random.standard_normal((3, 500, 3))
    wi, wo, normal = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (wi, wo, normal))
    half = wi + wo
    size = np.linalg.norm(half, axis=1)
    half /= size[:, np.newaxis]
    dots = [np.sum(a * b, axis=1) for a, b in ((normal, wi), (normal, wo), (wi, wo))]
    mirror = 2 * dots[0] * dots[1] - dots[2]
    n_h = np.sum(normal * half, axis=1)
    across = np.cross(wi, half)
    triple = np.sum(across * normal, axis=1)
    value = half_vector.reflection_from_half(n_h, triple=triple)
    np.testing.assert_allclose(value, mirror, atol=1e-14 / size.min())
    np.testing.assert_allclose(half_vector.reflection(wi, wo, normal), value, atol=1e-14)
    nu, beta = np.arccos(n_h), np.arcsin(np.linalg.norm(across, axis=1))
    theta = np.arccos(triple / np.sin(beta))
    value = half_vector.reflection_cosine(nu, beta=beta, theta=theta)
    np.testing.assert_allclose(value, mirror, atol=1e-13)
    assert np.abs(half_vector.identity(wi, wo, normal)).max() < 16 * np.finfo(float).eps
    rho = np.linspace(0, 3, 50)
    plane = half_vector.reflection_from_half(np.cos(rho / 2))
    np.testing.assert_allclose(plane, np.cos(rho), atol=1e-15)


def test_reflection_where_there_is_no_half_vector():
    for normal in ([0.0, 1, 0], [0.6, 0.8, 0], [1.0, 0, 0]):
        value = half_vector.reflection([1.0, 0, 0], [-1.0, 0, 0], normal)
        assert value == pytest.approx(1 - 2 * normal[0] ** 2, abs=1e-15)
    assert np.isnan(half_vector.reflection([0.0, 0, 0], [1, 0, 0], [0, 0, 1]))
    assert np.isnan(half_vector.identity([np.nan, 0, 0], [1, 0, 0], [0, 0, 1]))


def test_bad_input():
    with pytest.raises(ValueError, match="wi: expected vectors of shape"):
        half_vector.reflection([1, 0], [1, 0, 0], [1, 0, 0])
    with pytest.raises(TypeError, match="n_h: expected real numbers"):
        half_vector.reflection_from_half("x")
    with pytest.raises(TypeError, match="theta: expected real numbers"):
        half_vector.reflection_cosine(0, beta=0, theta=None)
