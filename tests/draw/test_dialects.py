"""One program serves all renderers: only names and qualifiers differ."""

import re

import pytest

from vizlight import DepthCue, Light, Scene, View
from vizlight.draw import dialects, glsl
from vizlight.shading.engine import plan

NEAR = Light(position=(1, 2, 3), attenuation=(0.5, 0.1, 0))
CUE = DepthCue(front=1, back=2)
SCENE = Scene(
    lights=[Light(direction=(1, 0, 0)), NEAR], view=View(position=(0, 0, 5)), depth_cue=CUE
)
SHAPES = {
    "surface": {"normals": True},
    "lines": {"k": 1},
    "conditioned": {"k": 1, "normals": True, "conditioned": True},
}


def made(shape, dialect, *, turned=False):
    """Return the replacements of a dialect by stage, and what the program is given."""
    own = plan(SCENE, **SHAPES[shape])
    written = glsl.write(own, turned=turned)
    given = glsl.numbers(SCENE, SCENE.lights, fur=own.fur, tallest=0.0)
    texts = {}
    for stage, mark, text in dialect.replacements(written, given):
        texts.setdefault(stage, {})[mark] = text
    return texts, given


@pytest.mark.parametrize("shape", SHAPES)
def test_the_light_is_the_same_text_for_all(shape):
    ours, _ = made(shape, dialects.VTK)
    others, _ = made(shape, dialects.VTK_JS)
    assert ours["Fragment"]["//VTK::Light::Impl"] == others["Fragment"]["//VTK::Light::Impl"]
    assert "Geometry" in ours
    assert "Geometry" not in others


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("shape", SHAPES)
def test_what_is_read_is_declared(shape, turned):
    """In WebGL nothing else declares uniforms, attributes and varyings."""
    texts, given = made(shape, dialects.VTK_JS, turned=turned)
    vertex, fragment = ("".join(texts[stage].values()) for stage in ("Vertex", "Fragment"))
    uniforms = dict(re.findall(r"uniform \w+ (\w+);()", fragment))
    assert set(uniforms) == {number.name for number in given}
    body = texts["Fragment"]["//VTK::Light::Impl"]
    for name in re.findall(r"\bviz\w+VSOutput\b", body):
        assert re.search(rf"varying \w+ {name};", fragment)
        assert re.search(rf"varying \w+ {name};", vertex)
        assert f"{name} = " in vertex
    for name in re.findall(r"\bviz(?:Normal|Tangent)MC\b", vertex):
        assert f"attribute vec3 {name};" in vertex
    assert not re.search(r"^(in|out) ", vertex + fragment, re.M)


def test_numbers_are_those_of_the_scene():
    found = {number.name: number for number in made("surface", dialects.VTK)[1]}
    assert found["vizLight0"][2:] == ((1, 0, 0), "direction")
    assert found["vizLight1"][2:] == ((1, 2, 3), "position")
    assert found["vizFade1"].value == (0.5, 0.1, 0)
    assert found["vizEye"][2:] == ((0, 0, 5, 1), "position")
    assert found["vizCueEnds"].value == (1, 2, 1, 0)
