"""The oracle: closed forms by quadrature, floats against 50 digits, and what it cannot light."""

import math

import numpy as np
import oracles
import pytest
from oracles import exact, mp

from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.verify import oracle
from vizlight.verify.oracle import FLOATS

SCENE = Scene(
    lights=[
        Light(direction=(1, 2, 3), intensity=0.7, color="gold"),
        Light(position=(2, 3, 4), attenuation=(0.5, 0.2, 0.05)),
    ],
    view=View(position=(0.5, 1, 6)),
    material=Material(specular_color=(0.2, 1, 0.5), shininess=17.5),
    ambient_color="green",
    depth_cue=DepthCue(front=3.0, back=9.0, back_scale=0.2, cue=0.4, color="navy", smooth=True),
)
OPTIONS = {
    "line": {},
    "blinn": {"model": "blinn"},
    "cylinder": {"model": "cylinder"},
    "plain": {"exponent": 1},
    "surface": {},
    "surface, blinn": {"model": "blinn", "two_sided": True},
    "surface, two-sided": {"two_sided": True},
    "surface, shadow": {"shadow": (0.2, 0.4)},
    "conditioned": {},
    "conditioned, shadow": {"shadow": (0.2, 0.4)},
    "conditioned, fur": {"fur": 0.3, "fur_height": 0.2},
    "conditioned, free": {"conditioned": False, "fur": 0.3, "fur_height": 0.2},
    "conditioned, base": {"base_tangents": [(1, 2, 0), (0, 1, 1)]},
}


@pytest.mark.parametrize("name", OPTIONS)
def test_floats_are_the_digits(name, random):
    for point, tangent, normal in random.standard_normal((4, 3, 3)).tolist():
        lines = None if name.startswith("surface") else [tangent]
        up = normal if name.startswith(("surface", "conditioned")) else None
        found = oracle.light(point, lines, up, SCENE, **OPTIONS[name])
        true = oracles.digits.light(point, lines, up, SCENE, **OPTIONS[name])
        pairs = zip([*found[2:], found.luminance, *found.rgb],
                    [*true[2:], true.luminance, *true.rgb], strict=True)  # fmt: skip
        assert max(abs(a - float(b)) for a, b in pairs) < 1e-13
        assert all(isinstance(number, mp.mpf) for number in (true.luminance, *true.rgb))


@pytest.mark.parametrize("s", [0.0, 1.0, 5.0, 20.0, 20.5, 100.0])
def test_the_line_light_is_its_quadrature(s, random):
    for wi, wo, t in random.standard_normal((2, 3, 3)):
        true = oracles.quadrature(wi, wo, t, s)
        light, shine = oracles.line_light(wi, wo, t, s)
        assert abs(light - true[0]) < 1e-25
        assert abs(shine - true[1]) < 1e-12 * max(1, true[1])


@pytest.mark.parametrize("s", [0.0, 0.5, 7.5, 100.0, 1e4, 1e6])
def test_the_line_light_of_floats(s, random):
    """Also where light and eye meet in the highlight, of lines in any space, and end on."""
    for wi, wo, t in random.standard_normal((20, 3, 4)):
        mirror = 2 * (wi - (wi @ t) / (t @ t) * t) - wi
        for eye in (wo, mirror + wo / (10 * np.sqrt(1 + s)), t):
            w = [FLOATS.unit(v.tolist()) for v in (wi, eye, t)]
            if eye is t:
                found, true = FLOATS.end_on(*w, s), oracles.digits.end_on(*map(exact, w), s)
            else:
                found, true = FLOATS.line_light(*w, s), oracles.line_light(*w, s)
            assert max(abs(a - float(b)) for a, b in zip(found, true, strict=True)) < 1e-12


def test_an_eye_beside_the_line_sees_what_one_along_it_sees_in_the_mean(random):
    """The mean of the line light around a line that is seen almost end on is that end on."""
    line, side, other = np.linalg.qr(random.standard_normal((3, 3)))[0]
    wi = FLOATS.unit((0.3 * line + side).tolist())
    turns = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    eyes = [line + 1e-7 * (np.cos(a) * side + np.sin(a) * other) for a in turns]
    around = [FLOATS.line_light(wi, FLOATS.unit(wo.tolist()), line.tolist(), 9.0) for wo in eyes]
    exactly = FLOATS.end_on(wi, line.tolist(), line.tolist(), 9.0)
    np.testing.assert_allclose(np.mean(around, axis=0), exactly, rtol=1e-3)


def test_exponents():
    for k, n, p in ((2, 3, 1), (2, 4, 2), (3, 6, 2), (2, 9, 7)):
        assert FLOATS.exponent(k, n) == pytest.approx(p, rel=1e-14)
        assert abs(oracles.digits.exponent(k, n) - p) < 1e-45
    for k, n in ((1, 3), (1, 4), (5, 90)):
        true = oracles.digits.exponent(k, n)
        assert abs(2 * oracles.mean_intensity(k, n, true) - 1) < 1e-45
        assert FLOATS.exponent(k, n) == pytest.approx(float(true), rel=1e-13)


def test_directions_of_any_length():
    for v in ((3.0, 4.0), (3e-320, 4e-320), (3e307, 4e307), (3e-200, 4e-200)):
        assert FLOATS.unit(v) == pytest.approx([0.6, 0.8], rel=1e-3 if v[0] < 1e-310 else 1e-15)
    for v in ((0.0, 0.0), (math.nan, 1.0), (1.0, math.nan), (math.inf, 1.0), (1.0, -math.inf)):
        assert FLOATS.unit(v) is None


def test_frames_are_orthonormal(random):
    rows = random.standard_normal((3, 5))
    rows[1] = rows[0] + 1e-7 * rows[1]
    frame = np.array(FLOATS.orthonormal(rows.tolist()))
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-15)
    assert len(FLOATS.orthonormal([rows[0], rows[1], 0 * rows[2]], 1e-6)) == 1


def test_points_that_cannot_be_lit():
    here, line = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    for point, tangents, normal in (
        (here, [here], None), (here, None, here), (here, [line], here), (here, [line, line], None),
        (here, None, None), ((0.0, math.nan, 0.0), [line], None),
    ):  # fmt: skip
        lit = oracle.light(point, tangents, normal, SCENE)
        assert len(lit.rgb) == 3
        assert all(map(math.isnan, (lit.luminance, *lit.rgb, *lit[2:])))
    plain = oracle.light(here, [line], None, Scene(lights=[], material=Material(ambient=0.25)))
    assert plain == (0.25, (), 0.25, 0.0, 0.0)
