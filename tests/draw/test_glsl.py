"""The text of a fragment, run number by number in Python, gives the light of the points."""

import dataclasses
import math
import re

import numpy as np
import pytest
from lamps import NEAR, far
from vectors import unit

from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.draw import glsl
from vizlight.model import formulas
from vizlight.scene.light import WHITE
from vizlight.shading import display, engine
from vizlight.shading.engine import plan

EYE = View(position=(0.3, -0.2, 6.0), direction=(0.1, 0.2, 1.0))
FAR = Light(direction=(1, 0.9, 0.5), intensity=0.6)
CUE = DepthCue(front=3, back=9, back_scale=0.3, cue=0.1, color=(0.3, 0.4, 1.0))
SCENES = {
    "far": Scene(lights=FAR, material=Material(specular=0.4), view=EYE),
    "near": Scene(lights=NEAR, material=Material(specular=0.3, shininess=35.5), view=EYE),
    "cue": Scene(lights=[FAR, NEAR], depth_cue=CUE, ambient_color=(0.7, 0.8, 1), view=EYE),
    "smooth": Scene(
        lights=[FAR, NEAR],
        depth_cue=DepthCue(front=3, back=9, smooth=True, cue=0.4),
        material=Material(specular=0.5, shininess=2e4),
        view=View(direction=(0.2, 0.1, 1.0)),
    ),
    "exposed": Scene(lights=[FAR, NEAR], material=Material(specular=0.4), view=EYE, exposure=1.8),
    "bright": Scene(lights=[FAR] * 5, material=Material(diffuse=1, specular=1), view=EYE),
}
KINDS = {
    "surface": {"normals": True},
    "both sides": {"normals": True, "two_sided": True},
    "lines": {"k": 1},
    "flat law": {"k": 1, "exponent": 2},
    "conditioned": {"k": 1, "normals": True},
    "fur": {"k": 1, "normals": True, "fur": 0.7, "conditioned": False},
}


class Vec(np.ndarray):
    """A vector of GLSL: an array whose components have letters."""

    def __getattr__(self, axes):
        if not set(axes) <= set("xyzwrgb"):
            raise AttributeError(axes)
        found = [self[("rgb" if a in "rgb" else "xyzw").index(a)] for a in axes]
        return vec(*found) if len(axes) > 1 else found[0]


def vec(*numbers):
    return np.array(numbers, dtype=np.float64).view(Vec)


LANGUAGE = {
    "dot": np.dot, "length": np.linalg.norm, "max": np.maximum, "min": np.minimum, "abs": np.abs,
    "sqrt": math.sqrt, "inversesqrt": lambda x: x**-0.5, "pow": lambda x, e: x**e,
    "exp": math.exp, "atan": math.atan2, "vec3": vec, "vec4": vec,
    "viz_power": lambda x, d, e: math.exp(e * math.log1p(-d)) if x > 0 else float(e == 0),
}  # fmt: skip


def run(body, given):
    """Run the statements of a fragment and return the colour that they set."""
    scope = {**LANGUAGE, **given}
    for statement in body.replace("\n", " ").split(";"):
        text = statement.strip()
        if text.startswith("if "):
            test, name, value = re.fullmatch(r"if \((.*)\) (\w+) = (.*)", text).groups()
            text = f"{name} = {value} if {test} else {name}"
        elif text:
            _, name, value = re.fullmatch(r"(\w+) (\w+) = (.*)", text).groups()
            parts = re.fullmatch(r"(.*?) \? (.*) : (.*)", value)
            text = f"{name} = " + (
                "{1} if {0} else {2}".format(*parts.groups()) if parts else value
            )
        exec(text, scope)
    return np.array(scope["vizColor"])


def uniforms(scene, own, data):
    lights = [light.seen_from(scene.view) for light in scene.lights]
    found = glsl.numbers(scene, lights, fur=own.fur, tallest=1.0, data=data)
    values = {}
    for name, kind, value, space in found:
        numbers = np.asarray(value, dtype=np.float64)
        if space == "direction":
            numbers[:3] /= np.linalg.norm(numbers[:3])
        values[name] = float(numbers[0]) if kind == "float" else vec(*numbers)
    return values


@pytest.mark.sampled(5)
@pytest.mark.parametrize("data", [False, True])
@pytest.mark.parametrize("model", ["phong", "blinn"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("scene", SCENES)
def test_the_text_gives_the_light_of_the_engine(scene, kind, model, data):
    asked, scene = {**KINDS[kind], "model": model}, SCENES[scene]
    if data:
        scene = scene.replace(material=Material(specular=0))
    own = plan(scene, **asked)
    _, body = glsl.fragment(own, data=data)
    rng, count = np.random.default_rng(5), 12
    points, normals, tangents = (rng.normal(size=(count, 3)) for _ in range(3))
    heights = rng.uniform(0.1, 1, count)
    asked.pop("normals", None)
    color = None if data else (0.9, 0.8, 0.7)
    lit = engine.shade(
        points,
        tangents if asked.pop("k", None) else None,
        scene.replace(
            material=dataclasses.replace(scene.material, color=color),
            # Of colours of data the whole factor is exposed.
            exposure=None if data else scene.exposure,
        ),
        normals=normals if own.surface or own.conditioned or own.fur else None,
        fur_height=heights if own.fur else None,
        **asked,
    )
    given = uniforms(scene, own, data)
    given |= {"ambientColor": vec(0.9, 0.8, 0.7), "diffuseColor": vec(0.9, 0.8, 0.7)}
    if data:
        # A factor on the colour of the data, which stands twice in what the renderer holds.
        luma = lit.luminance if lit.rgb is None else lit.rgb @ formulas.LUMA
        luma = display.exposed(luma, scene.exposure)
        expected = np.clip(luma, display.LEAST, 1)[:, np.newaxis] * [0.9, 0.8, 0.7]
    else:
        expected = lit.rgb / np.maximum(lit.rgb.max(axis=1, keepdims=True), 1)
    given["vizGood"], got = True, []
    for p, n, t, h in zip(points, unit(normals), unit(tangents), heights, strict=True):
        own = {"vizP": vec(*p), "vizN": vec(*n), "vizT": vec(*t), "vizHeight": h}
        got.append(run(body, given | own))
    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-6)


def white_surface(**options):
    """Return the text for a white surface in far light, and what it is given at the origin."""
    own = plan(SCENES["far"], normals=True)
    given = uniforms(SCENES["far"], own, data=False)
    given |= {"ambientColor": vec(*WHITE), "diffuseColor": vec(*WHITE), "vizGood": True}
    return glsl.fragment(own, **options)[1], given | {"vizP": vec(0.0, 0.0, 0.0)}


def test_a_fragment_without_data_is_grey():
    body, given = white_surface()
    found = run(body, given | {"vizN": vec(0.0, 0.0, 1.0), "vizGood": False})
    np.testing.assert_allclose(found, display.NO_DATA)


@pytest.mark.parametrize("lean", [-1.0, 1.0])
def test_normals_turn_to_the_eye_unless_they_lean_away_by_little(lean):
    body, given = white_surface(turned=True)
    away = vec(0.0, 0.0, -1.0)
    turned = run(body, given | {"vizN": away, "vizLean": lean})
    expected = run(body, given | {"vizN": -away if lean < 0 else away, "vizLean": 1.0})
    np.testing.assert_array_equal(turned, expected)


def test_only_what_the_plan_needs_is_written():
    scene = far((1, 0, 0), (0, 0, 1), Material(specular=0))
    functions, body = glsl.fragment(plan(scene, normals=True))
    assert not functions
    assert not any(word in body for word in ("vizFade", "vizSpecularGain", "pow(", "* 1.0"))


def test_large_powers_keep_the_digits_of_the_deficit():
    functions, body = glsl.fragment(plan(SCENES["smooth"], normals=True))
    assert "float viz_power(" in functions
    assert "viz_power(" in body


@pytest.mark.parametrize(
    ("value", "text"),
    [(1, "1.0"), (0.25, "0.25"), (1e-8, "1e-08"), (np.inf, "3e+38"), (-1e300, "-3e+38")],
)
def test_numbers_are_float32(value, text):
    assert glsl.number(value) == text


def test_a_term_may_name_a_vector_of_its_own():
    w = glsl.FragmentShader(plan(Scene(), n=3, normals=True))
    own = w.vector((0.5, 1.0, 2.0))
    assert (own.text, own.kind) == ("vec3(0.5, 1.0, 2.0)", "vec3")
    assert (own * w.number(0.5)).kind == "vec3"


def test_a_vector_of_one_number_is_a_number():
    assert glsl.vector([0.5]) == "0.5"
    assert glsl.vector([1, 2, 3]) == "vec3(1.0, 2.0, 3.0)"
