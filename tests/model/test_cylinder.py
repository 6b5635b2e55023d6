"""The exact line light: laws, then derivatives by a complex step."""

import numpy as np
import oracles
import pytest
from oracles import mp
from refusals import refusals

from vizlight.model import cylinder, reflection

SHININESS = [0.0, 0.5, 1.0, 7.5, 8.0, 10.0, 20.5, 32.0, 100.0, 1000.0, 1e4]

GAUSS = np.polynomial.legendre.leggauss(300)


def rows(values):
    return np.asarray(values)[..., np.newaxis, :]


def parts(wi, wo, tangent):
    """Return |wi_N|, |wo_N|, |wi + wo| of directions."""
    wi, wo, t = (np.asarray(v, dtype=float) / np.linalg.norm(v) for v in (wi, wo, tangent))
    return (
        np.linalg.norm(wi - (wi @ t) * t),
        np.linalg.norm(wo - (wo @ t) * t),
        np.linalg.norm(wi + wo),
    )


@pytest.mark.parametrize("s", SHININESS)
def test_a_headlight_is_the_cheap_forms_up_to_a_factor(s, random):
    """Banks' plain law and Blinn's are exact up to a factor where light and eye agree."""
    wi, t = random.standard_normal((2, 100, 3))
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    plain = reflection.diffuse(wi, rows(t))
    np.testing.assert_allclose(cylinder.diffuse(wi, wi, t), np.pi / 4 * plain, atol=1e-15)
    blinn = reflection.specular(wi, wi, rows(t), shininess=s, model="blinn")
    factor = float(mp.beta(mp.mpf("0.5"), oracles.exact(s) / 2 + 1)) / 2
    value = cylinder.specular(wi, wi, t, shininess=s)
    np.testing.assert_allclose(value, factor * blinn, atol=1e-14)


def test_shininess_0_is_the_lit_share_of_the_width(random):
    """(1 + cos alpha) / 2: the share of a moon's width that is lit."""
    wi, wo, t = random.standard_normal((3, 100, 3))
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    a, b = (v - np.sum(v * t, axis=1, keepdims=True) * t for v in (wi, wo))
    cosine = np.sum(a * b, axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
    value = cylinder.specular(wi, wo, t, shininess=0)
    np.testing.assert_allclose(value, (1 + cosine) / 2, atol=1e-13)


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-7])
def test_light_and_eye_from_opposite_sides(gap):
    """The normal parts of wi and wo nearly cancel: sin^2(gap / 2) of the width is lit and seen."""
    wi, wo = [-np.cos(gap), np.sin(gap), 0.5], [1, 0, 0.5 + 1e-7]
    found = cylinder.specular(wi, wo, [0, 0, 1.0], shininess=0)
    assert abs(found - np.sin(gap / 2) ** 2) < 8 * np.finfo(float).eps / 0.89


def test_invariance(random):
    """Turned, mirrored, with the tangent the other way, of other lengths: the same light."""
    wi, wo, t = random.standard_normal((3, 50, 3))
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    for call in (cylinder.diffuse, lambda *v: cylinder.specular(*v, shininess=30)):
        value = call(wi, wo, t)
        for other in (
            (wi @ turn, wo @ turn, t @ turn),
            (wi, wo, -t),
            (1e150 * wi, 1e-150 * wo, 3 * t),
        ):
            np.testing.assert_allclose(call(*other), value, atol=1e-13)


def test_specular_is_reciprocal_up_to_width(random):
    """Weighed by |wo_N| the lit and visible patch is the same for both; so is the half vector."""
    wi, wo, t = random.standard_normal((3, 50, 3))
    one = cylinder.diffuse(wi, wo, t)
    two = cylinder.diffuse(wo, wi, t)
    a, b = np.array([parts(*v)[:2] for v in zip(wi, wo, t, strict=True)]).T
    np.testing.assert_allclose(one / a, two / b, atol=1e-12)


def test_the_mean_light_of_all_lines(random):
    """The mean of |wi_N| pi / 4 of a headlight is (pi / 4)^2."""
    t = random.standard_normal((400_000, 3))
    value = cylinder.diffuse([0.0, 0, 1], [0, 0, 1], t)
    assert value.mean() == pytest.approx((np.pi / 4) ** 2, abs=1e-3)


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


def integral(wi, wo, t, s):
    """Diffuse and specular by a fixed quadrature that a complex number goes through."""

    def unit(v):
        return v / np.sqrt(np.sum(v * v))

    wi, wo, t = unit(wi), unit(wo), unit(t)
    e1 = unit(wo - np.sum(wo * t) * t)
    e2 = np.cross(t, e1)
    x, y, half = np.sum(wi * e1), np.sum(wi * e2), unit(wi + wo)
    side = np.sign(y.real)
    low = np.log((x + 1j * side * y) / np.sqrt(x * x + y * y)) / 1j - np.pi / 2
    if np.iscomplexobj(wi + wo + t):
        low = low_of(x, side * y)
    nodes, weights = GAUSS
    at = low + (np.pi / 2 - low) * (1 + nodes) / 2
    weights = weights * (np.pi / 2 - low) / 2
    cosine, sine = np.cos(at), side * np.sin(at)
    diffuse = np.sum((x * cosine + y * sine) * cosine * weights) / 2
    h = np.sum(half * e1) * cosine + np.sum(half * e2) * sine
    return diffuse, np.sum(h**s * cosine * weights) / 2


def low_of(x, y):
    """Return the angle of (x, y) less a quarter turn, analytic in both."""
    real = np.arctan2(y.real, x.real)
    square = x.real**2 + y.real**2
    return real - np.pi / 2 + 1j * (x.real * y.imag - y.real * x.imag) / square


@pytest.mark.parametrize("s", [0.0, 1.0, 3.5, 20.0, 100.0])
def test_gradients_by_a_complex_step(s, random):
    step = 1e-30
    for _ in range(10):
        v = random.standard_normal((3, 3))
        found = (cylinder.diffuse_gradient(*v), cylinder.specular_gradient(*v, shininess=s))
        for j in range(3):
            for i in range(3):
                moved = v.astype(complex)
                moved[j, i] += 1j * step
                for value, gradient in zip(integral(*moved, s), found, strict=True):
                    assert abs(value.imag / step - gradient[j][i]) < 1e-8


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
