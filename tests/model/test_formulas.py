"""The scalar formulas are the oracle's."""

from __future__ import annotations

import math

import bounds
import numpy as np
import oracles
import pytest

from vizlight import DepthCue
from vizlight.model import cylinder_kernels, formulas, kernels
from vizlight.verify.oracle import FLOATS

EPS = float(np.finfo(float).eps)


def unit(random, count):
    rows = random.normal(size=(3, count))
    return rows / np.linalg.norm(rows, axis=0)


@pytest.fixture
def scene(random):
    """Directions, a tangent, and how they are split by it."""
    wi, wo, t = (unit(random, 50) for _ in range(3))
    along_i, rest_i, sine_i = cylinder_kernels.across(wi, t)
    along_o, rest_o, sine_o = cylinder_kernels.across(wo, t)
    return wi, wo, t, along_i, rest_i, sine_i, along_o, rest_o, sine_o


def close(value, reference, eps=8):
    assert np.abs(value - np.asarray(reference)).max() <= eps * EPS


@pytest.mark.parametrize("s", [0.0, 0.3, 1.0, 7.5, 20.0, 64.0, 100.5, 1e6])
def test_reflection(scene, s):
    wi, wo, t, along_i, _, sine_i, along_o, _, sine_o = scene
    allowed = bounds.specular_bound(s, EPS) / EPS
    tangential = (along_i + along_o) ** 2
    normal = np.maximum(2 + 2 * kernels.dot(wi, wo) - tangential, 0)
    near = np.minimum(1, np.linalg.norm(wi + wo, axis=0).min())
    rows = [oracles.exact([wi[:, i], wo[:, i], t[:, i]]) for i in range(wi.shape[1])]
    units = [[oracles.unit(v) for v in row] for row in rows]

    def true(function):
        return np.array([float(function(*row)) for row in units])

    def specular(model):
        return true(lambda a, b, c: oracles.digits.specular(a, b, [c], oracles.exact(s), model))

    with np.errstate(under="ignore"):
        found = formulas.diffuse(sine_i, along_i**2, s)
        diffuse = true(lambda a, _, c: oracles.digits.across(a, [c]) ** oracles.exact(s))
        close(found, diffuse, bounds.diffuse_bound(s, EPS) / EPS)
        close(formulas.phong(tangential, sine_i, sine_o, s), specular("phong"), allowed)
        close(formulas.blinn(tangential, normal, s), specular("blinn"), allowed / near)
        if s >= 2:
            close(formulas.blinn_of_unit(along_i**2, s), diffuse, allowed)
        cosine = np.abs(along_i)
        dots = true(lambda a, _, c: abs(oracles.dot(a, c)) ** oracles.exact(s))
        close(formulas.surface_diffuse(cosine, s), dots, allowed)


@pytest.mark.parametrize("s", [8.0, 20.0, 333.0])
def test_cylinder(scene, s):
    wi, wo, t, along_i, rest_i, a, along_o, rest_o, b = scene
    met = cylinder_kernels.meet(rest_i, a, rest_o, b, t)
    light = cylinder_kernels.diffuse(met)
    shine = cylinder_kernels.specular(met, (along_i + along_o) ** 2, s)
    for i in range(wi.shape[1]):
        true = oracles.line_light(wi[:, i], wo[:, i], t[:, i], s)
        assert abs(light[i] - float(true[0])) < 1e-14
        assert abs(shine[i] - float(true[1])) < 1e-13


def test_cylinder_end_on_and_dark():
    least = 8 * EPS
    assert formulas.cylinder_diffuse(1.0, 0.0, 0.0, 0.0, least) == pytest.approx(1 / math.pi)
    common = (0.2, 0.1, 0.0)
    assert formulas.cylinder_specular(1.0, *common, 0.0, 1.0, 1.0, least, 0.3) == 0
    assert formulas.cylinder_specular(1.0, *common, 1.0, 0.0, 1.0, least, 0.3) == 0.3
    assert formulas.cylinder_specular(1.0, *common, 1.0, 1.0, 0.0, least, 0.3) == 0


def test_falloff(random):
    d = np.concatenate([[0.0], random.uniform(0, 9, 99)])
    for c in ((1, 0, 0), (0, 0.5, 0), (0.2, 0.3, 0.4)):
        close(formulas.attenuation(d, *c), [FLOATS.attenuation(x, c) for x in d])
    height = np.where(d > 4, d, 0)
    sine = random.uniform(0, 1, 100)
    sine[:3] = 0
    with np.errstate(divide="ignore", invalid="ignore"):
        path = formulas.fur_path(height, sine)
    passed = [FLOATS.fur(*pair, 0.2) for pair in zip(height, sine, strict=True)]
    close(formulas.fur_passes(path, math.log1p(-0.2)), passed)
    ends = {"front": 2.0, "back": 6.0, "front_scale": 0.9, "back_scale": 0.1}
    for smooth, function in ((False, formulas.depth_scale), (True, formulas.smooth_depth_scale)):
        cue = DepthCue(**ends, cue=0.7, smooth=smooth)
        value = formulas.depth_cue(0.4, function(d, **ends), 0.7)
        close(value, [FLOATS.depth_cue(0.4, x, cue) for x in d])


def test_highlights_of_a_surface():
    cosine = np.array([-0.5, 0.0, 0.05, 0.1, 0.5])
    np.testing.assert_array_equal(formulas.one_side(cosine), [0, 0, 0.05, 0.1, 0.5])
    np.testing.assert_array_equal(formulas.both_sides(cosine), [0.5, 0, 0.05, 0.1, 0.5])
    np.testing.assert_array_equal(formulas.lit_highlight(0.7, cosine), [0, 0, 0.7, 0.7, 0.7])
    side = formulas.one_side(cosine)
    close(formulas.shadowed_highlight(0.7, 0.25, side), [0, 0, 0.7, 0.7, 0.35])


def test_plain_numbers():
    assert formulas.phong(0.0, 0.6, 0.6, 20.0) == 1
    assert formulas.power(0.0, 1.0, 0.0) == 1
    assert formulas.power(0.0, 1.0, 2.0) == 0
    assert formulas.blinn(0.0, 0.0, 5.0) == 0
