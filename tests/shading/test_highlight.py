"""Which law each highlight is computed by: the one asked for, unless an error is allowed."""

from __future__ import annotations

import numpy as np
import oracles
import pytest

from vizlight import Light, Material, Scene, View, engine
from vizlight.engine import plan
from vizlight.model import cylinder

FAR = View(direction=(0, 0, 1))
SUN, LOW = Light(direction=(1, 1, 1)), Light(direction=(1, 0, -0.7))
NEAR = Light(position=(3, 2, 4))


def manifolds(random, dtype, count=4000):
    """Points, and options of the engine with tangents or normals, in 3 and in 5-space."""
    points = random.standard_normal((count, 3)).astype(dtype)
    vectors = random.standard_normal((count, 3)).astype(dtype)
    yield 3, points, vectors, {}
    yield 3, points, None, {"normals": vectors}
    yield 3, points, None, {"normals": vectors, "two_sided": True}
    yield 3, points, vectors, {"normals": -vectors[::-1], "conditioned": True}
    wide = random.standard_normal((2, count, 5)).astype(dtype)
    yield 5, wide[0], np.concatenate([wide[1], wide[0]], axis=1), {}


def in_space(scene, n):
    """The scene with its directions continued into n-space."""
    more = (0.3,) * (n - 3)
    lights = [Light(direction=light.direction + more) for light in scene.lights]
    return scene.replace(lights=lights, view=View(direction=scene.view.direction + more))


@pytest.mark.parametrize("shininess", [3.0, 20.0, 200.0])
def test_the_bound_holds_and_the_default_is_what_was_asked(shininess, dtype, random):
    scene = Scene(lights=[SUN, LOW], view=FAR, material=Material(diffuse=0, shininess=shininess))
    for n, points, tangents, options in manifolds(random, dtype):
        here = in_space(scene, n)
        asked = engine.shade(points, tangents, here, **options)
        assert asked.plan.highlight_error == 0
        assert all(h.model == "phong" for h in asked.plan.highlights)
        for allowed in (1.0, 10.0, 100.0):
            made = engine.shade(points, tangents, here, highlight_error=allowed, **options)
            off = 255 * np.abs(made.luminance - asked.luminance).max()
            assert made.plan.highlight_error <= allowed
            assert off <= made.plan.highlight_error
        assert made.plan.highlight_error > 0
        assert off > 0.2 * made.plan.highlight_error


def test_the_cheaper_light_first_and_the_sum_kept():
    scene = Scene(lights=[LOW, SUN, NEAR], view=FAR, material=Material(specular=1.0))
    low, sun, near = plan(scene, k=1, highlight_error=1e3).highlights
    assert (low.model, sun.model, near.model) == ("blinn", "blinn", "phong")
    assert low.error > sun.error > 0 == near.error
    some = plan(scene, k=1, highlight_error=low.error)
    assert [h.model for h in some.highlights] == ["phong", "blinn", "phong"]
    assert some.highlights[0].rejected == low.error
    assert some.highlight_error == sun.error
    said = some.explain()
    assert "light 1: Blinn's model of power" in said
    assert f"it would differ by up to {low.error:.3g} of 255" in said
    assert "skip     eye: no split" not in said
    alone = plan(scene.replace(lights=[SUN]), k=1, highlight_error=50)
    assert "eye: no split per point" in alone.explain()
    assert not alone.splits_eye


@pytest.mark.parametrize(
    ("scene", "options"),
    [
        (Scene(lights=[NEAR], view=FAR), {}),
        (Scene(lights=[SUN], view=View(position=(0, 0, 9))), {}),
        (Scene(lights=[SUN], view=FAR, material=Material(shininess=0.2)), {}),
        (Scene(lights=[Light(direction=(0, 0, -1))], view=FAR), {}),
        (Scene(lights=[SUN], view=FAR), {"model": "cylinder"}),
        (Scene(lights=[SUN], view=FAR, material=Material(specular=0)), {}),
    ],
)
def test_no_exchange_where_the_half_vector_moves_or_is_none(scene, options):
    made = plan(scene, k=1, highlight_error=255, **options)
    assert all(h.model == made.model and h.error == 0 for h in made.highlights)


@pytest.mark.parametrize("shininess", [1.0, 20.0, 100.0, 1e4])
@pytest.mark.parametrize("degrees", [0.0, 1e-3, 2.0, 10.0, 100.0])
def test_the_bound_includes_rounding(shininess, degrees, dtype, random):
    """Where the highlights fall both are rounded: at no angle the laws agree, numbers do not."""
    angle = np.deg2rad(degrees)
    way = np.array([np.sin(angle), 0, np.cos(angle)])
    half = way + np.array([0, 0, 1])
    half /= np.linalg.norm(half)
    width = np.sqrt(random.uniform(0, 4, (20_000, 1)) / max(shininess, 4))
    normals = half + width * random.standard_normal((20_000, 3))
    tangents = np.cross(normals, random.standard_normal((20_000, 3))).astype(dtype)
    scene = Scene(
        lights=Light(direction=way), view=FAR,
        material=Material(ambient=0, diffuse=0, specular=1, shininess=shininess),
    )  # fmt: skip
    asked = engine.shade(tangents, tangents, scene)
    made = engine.shade(tangents, tangents, scene, highlight_error=255)
    off = 255 * np.abs(made.luminance - asked.luminance.astype(float)).max()
    assert 0 < off <= made.plan.highlight_error
    law = plan(scene, k=1, highlight_error=255, dtype="float64").highlight_error
    assert made.plan.highlight_error < law + 255 * (20 + 12 * shininess) * oracles.eps(dtype)


def test_intensity_and_coefficient_weigh_the_error():
    scene = Scene(lights=[SUN], view=FAR, material=Material(specular=0.5))
    one = plan(scene, k=1, highlight_error=255).highlight_error
    bright = scene.replace(lights=[Light(direction=(1, 1, 1), intensity=3.0)])
    assert plan(bright, k=1, highlight_error=255).highlight_error == pytest.approx(3 * one)


@pytest.mark.parametrize("shininess", [0.5, 8.0, 30.0, 1e4])
@pytest.mark.parametrize("view", [FAR, View(position=(0, 1, 9))])
@pytest.mark.parametrize("light", [SUN, NEAR])
def test_cylinder_of_the_engine_is_the_model(light, view, shininess, dtype, random):
    points = random.standard_normal((500, 3)).astype(dtype)
    tangents = random.standard_normal((500, 3)).astype(dtype)
    material = Material(ambient=0, diffuse=0.7, specular=0.3, shininess=shininess)
    scene = Scene(lights=light, view=view, material=material)
    shading = engine.shade(points, tangents, scene, model="cylinder", components=True, block=64)

    def toward(owner):
        if owner.position is None:
            return np.asarray(owner.direction, dtype=float)
        return np.asarray(owner.position) - points.astype(float)

    wi, wo, t = toward(light), toward(view), tangents.astype(float)
    diffuse = 0.7 * cylinder.diffuse(wi, wo, t)
    specular = 0.3 * cylinder.specular(wi, wo, t, shininess=shininess)
    slack = 2000 * oracles.eps(dtype)
    np.testing.assert_allclose(shading.diffuse, diffuse, atol=slack)
    np.testing.assert_allclose(shading.specular, specular, atol=slack)
    assert shading.luminance.dtype == dtype
    wi, wo = (np.broadcast_to(way, points.shape) for way in (wi, wo))
    true = oracles.line_light(wi[7], wo[7], t[7], shininess)
    assert shading.diffuse[7] == pytest.approx(0.7 * float(true[0]), abs=slack)
    assert shading.specular[7] == pytest.approx(0.3 * float(true[1]), abs=slack)


def test_hard_points_of_cylinders(dtype):
    """Zero, NaN and infinite tangents and points, light and eye on a point, along the line."""
    points = np.array(
        [
            [0, 0, 0],
            [0, 0, 0],
            [0, 0, 0],
            [np.nan, 0, 0],
            [3, 2, 4],
            [0, 1, 9],
            [1, 1, 1],
            [0, 0, 0],
        ]
    ).astype(dtype)
    tangents = np.array(
        [[0, 0, 0], [np.nan, 1, 0], [np.inf, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0],
         [0, 1, 9]]
    ).astype(dtype)  # fmt: skip
    scene = Scene(lights=[NEAR, SUN], view=View(position=(0, 1, 9)))
    for shininess in (0.0, 5.0, 1e6):
        here = scene.replace(material=Material(shininess=shininess))
        shading = engine.shade(points, tangents, here, model="cylinder")
        assert shading.valid.tolist() == [False] * 4 + [True] * 4
        assert np.isfinite(shading.luminance).all()
        assert shading.luminance[:4] == pytest.approx(0.1)
        assert np.all(shading.luminance[4:] > 0.1)


def test_cylinder_in_words_and_what_it_needs():
    said = plan(Scene(lights=SUN, view=FAR), k=1, model="cylinder").explain()
    assert "diffuse: Lambert's law averaged over the visible half of a thin cylinder" in said
    assert "specular: cylinder, shininess 20 averaged over the visible half" in said
    dull = Scene(lights=SUN, material=Material(specular=0))
    with pytest.raises(ValueError, match="view: expected a View, which the cylinder's visible"):
        plan(dull, k=1, model="cylinder")
    for options in ({"k": 2}, {"normals": True}, {"k": 1, "n": 4}):
        with pytest.raises(ValueError, match="model: expected lines in 3-space for 'cylinder'"):
            plan(Scene(lights=[]), model="cylinder", **options)


def test_smooth_terminator(dtype, random):
    """Off by default; it fades the highlight alone, and on one-sided surfaces alone."""
    points = np.zeros((2000, 3), dtype=dtype)
    normals = random.standard_normal((2000, 3)).astype(dtype)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    scene = Scene(lights=LOW, view=FAR, material=Material(shininess=5.0))
    facing = normals @ np.asarray(LOW.direction) / np.linalg.norm(LOW.direction)
    for model in ("phong", "blinn"):
        options = {"normals": normals, "model": model, "components": True}
        sharp = engine.shade(points, None, scene, **options)
        smooth = engine.shade(points, None, scene, terminator=0.3, **options)
        t = np.clip(facing / 0.3, 0, 1)
        expected = sharp.specular * t * t * (3 - 2 * t)
        np.testing.assert_allclose(smooth.specular, expected, atol=20 * oracles.eps(dtype))
        np.testing.assert_array_equal(smooth.diffuse, sharp.diffuse)
        assert np.any(smooth.specular < 0.9 * sharp.specular)
    assert "terminator: highlights fade" in smooth.plan.explain()
    with pytest.raises(ValueError, match="terminator: expected 0 beside tangents"):
        plan(scene, k=1, terminator=0.1)
    with pytest.raises(ValueError, match="terminator: expected a number from 0 to 1"):
        plan(scene, normals=True, terminator=2)


def test_bad_input():
    with pytest.raises(ValueError, match="highlight_error: expected a finite number of at least 0"):
        plan(Scene(lights=SUN, view=FAR), k=1, highlight_error=-1)
    with pytest.raises(TypeError, match="highlight_error: expected a number"):
        plan(Scene(lights=SUN, view=FAR), k=1, highlight_error="2")
