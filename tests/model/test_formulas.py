"""The scalar formulas, and the manifolds that are made of them, are the oracle's."""

import math

import bounds
import numpy as np
import oracles
import pytest

from vizlight import DepthCue
from vizlight.model import formulas
from vizlight.model.manifolds import Arrays, Cylinder, Frame, Highlight, Surface
from vizlight.verify.oracle import FLOATS

EPS = float(np.finfo(float).eps)
W = Arrays(np.dtype(float))


def unit(random, count):
    rows = random.normal(size=(3, count))
    return rows / np.linalg.norm(rows, axis=0)


@pytest.fixture
def scene(random):
    """Directions to light and eye, and a tangent."""
    return [unit(random, 50) for _ in range(3)]


def close(value, reference, eps=8):
    assert np.abs(value - np.asarray(reference)).max() <= eps * EPS


@pytest.mark.parametrize("s", [0.0, 0.3, 1.0, 7.5, 20.0, 64.0, 100.5, 1e6])
def test_reflection(scene, s):
    wi, wo, t = scene
    frame, surface = Frame(W, [t], s), Surface(W, t, s, both=True)
    lit, eye = frame.split(wi), frame.split(wo)
    allowed = bounds.specular_bound(s, EPS) / EPS
    near = np.minimum(1, np.linalg.norm(wi + wo, axis=0).min())
    rows = [oracles.exact([wi[:, i], wo[:, i], t[:, i]]) for i in range(wi.shape[1])]
    units = [[oracles.unit(v) for v in row] for row in rows]

    def true(function):
        return np.array([float(function(*row)) for row in units])

    def specular(model):
        return true(lambda a, b, c: oracles.digits.specular(a, b, [c], oracles.exact(s), model))

    with np.errstate(under="ignore"):
        diffuse = true(lambda a, _, c: oracles.digits.across(a, [c]) ** oracles.exact(s))
        close(frame.diffuse(lit, None), diffuse, bounds.diffuse_bound(s, EPS) / EPS)
        for model, more in (("phong", 1), ("blinn", 1 / near)):
            found = frame.specular(lit, eye, Highlight(model, s))
            close(found, specular(model), allowed * more)
        if s >= 2:
            close(formulas.blinn_of_unit(lit.along[0] ** 2, s), diffuse, allowed)
        dots = true(lambda a, _, c: abs(oracles.dot(a, c)) ** oracles.exact(s))
        close(surface.diffuse(surface.split(wi), None), dots, allowed)


@pytest.mark.parametrize("s", [8.0, 20.0, 333.0])
def test_cylinder(scene, s):
    wi, wo, t = scene
    line = Cylinder(W, [t])
    lit, eye = line.split(wi), line.split(wo)
    light, shine = line.diffuse(lit, eye), line.specular(lit, eye, Highlight("cylinder", s))
    for i in range(wi.shape[1]):
        true = oracles.line_light(wi[:, i], wo[:, i], t[:, i], s)
        assert abs(light[i] - float(true[0])) < 1e-14
        assert abs(shine[i] - float(true[1])) < 1e-13


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
    for smooth in (False, True):
        cue = DepthCue(**ends, cue=0.7, smooth=smooth)
        value = formulas.depth_cue(0.4, formulas.depth_scale(d, **ends, smooth=smooth), 0.7)
        close(value, [FLOATS.depth_cue(0.4, x, cue) for x in d])


def test_highlights_of_a_surface():
    cosine = np.array([-0.5, 0.0, 0.05, 0.1, 0.5])
    side = Surface(W, None, 1.0).side(cosine)
    np.testing.assert_array_equal(side, [0, 0, 0.05, 0.1, 0.5])
    both = Surface(W, None, 1.0, both=True).side(cosine)
    np.testing.assert_array_equal(both, [0.5, 0, 0.05, 0.1, 0.5])
    close(formulas.shadowed_highlight(0.7, 0.25, side), [0, 0, 0.7, 0.7, 0.35])


def test_plain_numbers():
    assert formulas.phong(0.0, 0.6, 0.6, 20.0) == 1
    assert formulas.power(0.0, 1.0, 0.0) == 1
    assert formulas.power(0.0, 1.0, 2.0) == 0
    assert formulas.blinn(0.0, 0.0, 5.0) == 0
