"""The plan holds what a scene needs and nothing else, and says so."""

import numpy as np
import pytest
from lamps import HEADLIT, SHINY, shiny
from refusals import refusals

from vizlight import DepthCue, Light, Scene, View
from vizlight.shading.engine import plan

SUN = Light(direction=(1, 1, 1))
FAR = View(direction=(0, 0, 1))


def words(made, part):
    return [line[9:] for line in made.explain().splitlines() if line.startswith(part)]


def test_all_terms():
    made = plan(Scene(lights=SUN, view=FAR, material=SHINY), k=1)
    assert made.terms == ("ambient", "diffuse", "specular")
    assert (made.n, made.k, made.dtype) == (3, 1, np.float64)
    assert made.exponent == pytest.approx(4.7635, abs=1e-4)


def test_no_specular_means_no_eye():
    made = plan(Scene(lights=SUN, material=shiny(specular=0)), k=1)
    assert made.terms == ("ambient", "diffuse")
    assert "specular: material.specular is 0" in words(made, "skip")
    assert "eye: no term of the light depends on the view" in words(made, "skip")


def test_no_diffuse():
    made = plan(Scene(lights=SUN, material=shiny(diffuse=0), view=FAR), k=1)
    assert made.terms == ("ambient", "specular")


def test_no_light_is_ambient_alone():
    for lights in ([], [Light(direction=(1, 0, 0), intensity=0)]):
        made = plan(Scene(lights=lights, material=SHINY), k=1)
        assert made.terms == ("ambient",)
        assert made.scene.lights == ()
        assert any("no light has an intensity" in line for line in words(made, "skip"))


def test_compensation_leaves_surfaces_as_they_are():
    scene = Scene(lights=SUN, view=FAR, material=SHINY)
    assert plan(scene, normals=True).exponent == 1.0
    assert plan(scene, k=2).exponent == 1.0
    assert plan(scene, k=1, exponent=1).exponent == 1.0


def test_words_for_lights_and_views():
    near = Light(position=(0, 0, 5), attenuation=(1, 0, 1))
    made = plan(Scene(lights=[SUN, near], view=View(position=(0, 0, 9)), material=SHINY), k=1)
    said = words(made, "compute")
    assert any(line.startswith("light 0: one direction for all points") for line in said)
    assert any(line.startswith("light 1: one direction per point") for line in said)
    assert any("attenuation (1.0, 0.0, 1.0)" in line for line in said)
    assert any("once per point, shared by all lights" in line for line in said)


def test_words_for_the_rest():
    scene = Scene(
        lights=SUN, view=FAR, material=shiny(color="red"), depth_cue=DepthCue(front=0, back=1)
    )
    said = "\n".join(words(plan(scene, k=1, normals=True, model="blinn"), "compute"))
    for part in (
        "self-shadow: max(0, N.wi)",
        "rgb: three",
        "depth cue: linear",
        "half vector: one for all",
    ):
        assert part in said
    assert "|N.wi|" in plan(scene, normals=True, two_sided=True).explain()


def test_fur_needs_normals_an_eye_and_a_density():
    scene = Scene(lights=SUN, view=FAR, material=SHINY)
    made = plan(scene, k=1, normals=True, fur=0.3)
    assert "fur: density 0.3, on the way in for each light and out once" in words(made, "compute")
    assert made.conditioned
    assert not plan(scene, k=1, normals=True, fur=0.3, conditioned=False).conditioned
    with pytest.raises(ValueError, match="normals: expected normals, across which fur stands"):
        plan(scene, k=1, fur=0.3)
    with pytest.raises(ValueError, match="fur: expected a number from 0 to 1"):
        plan(scene, normals=True, fur=2)


def test_a_scene_without_a_view_has_no_highlight_and_an_eye_at_infinity():
    made = plan(Scene(**HEADLIT), normals=True)
    assert made.unseen
    assert not made.specular
    assert made.scene.lights == (Light(direction=(1, 1, 1)),)
    skipped = words(made, "skip")
    assert "specular: the scene has no view; pass view= to the Scene" in skipped
    assert "eye: no term of the light depends on the view" in skipped
    isometric = "eye: the scene has no view, so it is toward (1, ..., 1), at infinity"
    assert isometric in words(
        plan(Scene(lights=SUN, material=SHINY), normals=True, fur=0.3), "compute"
    )
    assert plan(Scene(**HEADLIT), k=2, n=5).scene.lights == (Light(direction=(1,) * 5),)
    assert not plan(Scene(**HEADLIT, view=FAR), normals=True).unseen


def test_block_shrinks_with_the_space():
    scene = Scene(lights=[], material=SHINY)
    small, large = plan(scene, k=1, n=3), plan(scene, k=5, n=100)
    assert small.block * 3 == pytest.approx(large.block * 500, rel=1e-2)
    assert plan(scene, k=1, dtype=np.float32).block == 2 * small.block
    assert plan(scene, k=1, n=10**6).block == 1


test_bad_input = refusals(
    lambda call: call(),
    (lambda: plan("scene", k=1), "scene: expected a vizlight.Scene", TypeError),
    (
        lambda: plan(Scene(lights=[], depth_cue=DepthCue(front=0, back=1), material=SHINY), k=1),
        "view: expected a View, which the depth cue needs",
    ),
    (
        lambda: plan(Scene(lights=[], view=FAR, depth_cue=DepthCue(), material=SHINY), k=1),
        "depth_cue: expected front= and back=",
    ),
    (
        lambda: plan(Scene(lights=[], material=SHINY)),
        r"tangents: expected tangents \(k=\) or normals",
    ),
    (lambda: plan(Scene(lights=[], material=SHINY), k=3), "k: expected fewer than n = 3"),
    (lambda: plan(Scene(lights=[], material=SHINY), k=1, model="x"), "model: expected 'phong'"),
    (lambda: plan(Scene(lights=[], material=SHINY), k=1, dtype="int32"), "dtype: expected float32"),
    (
        lambda: plan(Scene(lights=SUN, view=FAR, material=SHINY), k=1, n=4),
        "scene: expected vectors of 4 components, as the points have, got 3",
    ),
)
