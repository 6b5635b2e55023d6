"""GLSL is written from the formulas, every one of them, and says what it cannot write."""

from __future__ import annotations

import inspect
import math
import re

import numpy as np
import pytest

from vizlight import Light, Material, Scene, View
from vizlight.model import formulas
from vizlight.plotting import glsl
from vizlight.shading.decide import plan

NAMES = [
    name
    for name, value in vars(formulas).items()
    if inspect.isfunction(value)
    and value.__module__ == formulas.__name__
    and name not in {"where", "only"}
]


def run(name, *arguments):
    """Evaluate a function of the GLSL text in Python, number by number."""
    text = glsl.functions([name])
    scope = {"sqrt": math.sqrt, "exp": math.exp, "log": math.log, "abs": abs, "max": max}
    scope |= {"min": min, "atan": math.atan2}
    for kind in re.findall(r"float (\w+)\(([^)]*)\) \{\n(.*?)\n\}", text, re.S):
        own, parameters, body = kind
        parameters = ", ".join(re.findall(r"float (\w+)", parameters))
        if own == "viz_power":
            scope[own] = lambda x, _, e: x**e if x > 0 else float(e == 0)
            continue
        lines = []
        for line in body.splitlines():
            line = re.sub(r"^\s*float ", "", line.strip()).rstrip(";")
            lines.append("    " + ternary(line))
        exec(f"def {own}({parameters}):\n" + "\n".join(lines), scope)
    return scope[f"viz_{name}"](*arguments)


def ternary(line):
    """Return a line of GLSL with each (a ? b : c) as Python writes it."""
    while "?" in line:
        line = re.sub(
            r"\(([^()?:]*(?:\([^()]*\)[^()?:]*)*) \? (.*) : ([^:]*)\)",
            r"((\2) if (\1) else (\3))",
            line,
            count=1,
        )
    return line


@pytest.mark.parametrize("name", NAMES)
def test_every_formula_is_written(name):
    text = glsl.functions([name])
    assert f"float viz_{name}(" in text
    assert text.count("{") == text.count("}")
    assert not re.search(r"\b\d+\b(?!\.)(?<!\.\d)", re.sub(r"[\w.]*\.[\w.]*|\w*_\w*", "", text))


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("phong", (0.1, 0.8, 0.6, 20.0)),
        ("blinn", (0.2, 1.7, 35.0)),
        ("diffuse", (0.8, 0.36, 4.8)),
        ("attenuation", (2.0, 0.5, 0.1, 0.01)),
        ("depth_scale", (4.0, 2.0, 7.0, 1.0, 0.2)),
        ("smooth_step", (0.3,)),
        ("in_range", (0.7, 1.3)),
        ("in_range", (0.7, 0.9)),
        ("color_factor", (0.1, 0.3)),
        ("color_factor", (0.7, 0.3)),
        ("color_factor", (1.7, 0.3)),
    ],
)
def test_written_functions_give_the_numbers_of_the_formulas(name, arguments):
    expected = float(getattr(formulas, name)(*map(np.float64, arguments)))
    assert run(name, *arguments) == pytest.approx(expected, rel=1e-7)


def test_what_is_no_arithmetic_is_named(monkeypatch):
    def wrong(x):
        for _ in range(3):
            x = x * 2
        return x

    source = inspect.getsource(wrong).replace("    def", "def").replace("\n    ", "\n")
    tree = glsl.ast.parse(source).body[0]
    monkeypatch.setattr(glsl, "_syntax", lambda: {"wrong_one": tree})
    with pytest.raises(SyntaxError, match=r"(?s)wrong_one, line 2: .* is not an assignment"):
        glsl.functions(["wrong_one"])


def test_only_what_the_plan_needs_is_written():
    scene = Scene(
        lights=Light(direction=(1, 0, 0)),
        material=Material(specular=0),
        view=View(direction=(0, 0, 1)),
    )
    made = plan(scene, normals=True)
    declarations, body = glsl.fragment(made)
    assert "attenuation" not in declarations
    assert "vizFade" not in body
    assert "vizSpecular +=" not in body
