"""Every public callable refuses adversarial values by name, or returns finite numbers."""

import re
import warnings

import adversary
import adversary_calls as table
import numpy as np
import pytest
import pyvista as pv

from vizlight import _check

#: Calls of each callable in the suite; `python tests/adversary.py` makes all of them.
EACH = 2
#: Beginnings of the names of callables that draw or start a process.
DRAWING = ("draw.", "accessor.Accessor.plot")


def test_no_line_is_left_of_a_callable_that_is_gone():
    names = [f".{name}" for name in table.PUBLIC]
    for line in (*table.OWN, *table.SELF, *table.MARKED):
        assert any(name.endswith(f".{line}") for name in names), line
    arguments = {key for f in table.PUBLIC.values() for key in adversary.parameters(f)}
    known = {*table.VALUES, *table.OFTEN, *table.KINDS, *table.ALIASES}
    assert not known - arguments


@pytest.mark.sampled(3)
@pytest.mark.parametrize("name", [name for name in table.PUBLIC if not name.startswith(DRAWING)])
def test_adversarial_values(name):
    for call in [adversary.calls(name)[0], *adversary.sample(name, EACH, 0)]:
        assert not adversary.judge(call), f"{call.argument}={call.label}"


@pytest.mark.sampled(3)
@pytest.mark.opengl
@pytest.mark.parametrize("name", [name for name in table.PUBLIC if name.startswith(DRAWING)])
def test_adversarial_values_of_pictures(name):
    for call in [adversary.calls(name)[0], *adversary.sample(name, 1, 0)]:
        assert not adversary.judge(call), f"{call.argument}={call.label}"


@pytest.mark.parametrize("name", table.MARKED)
def test_marks_are_documented(name):
    _, words = table.MARKED[name]
    assert words in " ".join((table.PUBLIC[name].__doc__ or "").split())


def raw(value):
    return np.zeros(3)[value]


def silent(value):
    warnings.warn("of NumPy", RuntimeWarning, stacklevel=1)


def changing(value):
    value[0] = 1.0


def nameless(value):
    _check.number("other", value)


def infinite(value):
    return {"a": [pv.PolyData(np.full((1, 3), np.inf))]}


def slow(value):
    while True:
        pass


def leaving(value):
    with open("file", "w") as file:  # noqa: PTH123
        file.write("half")
    _check.number("value", value)


@pytest.mark.parametrize(
    ("function", "value", "words"),
    [
        (raw, 7, "raw IndexError"),
        (silent, 7, "leaks RuntimeWarning"),
        (changing, np.zeros(3), "changes its inputs"),
        (nameless, "x", "does not name the argument"),
        (infinite, 7, r"not finite at \[a\]\[0\]points"),
        (slow, 7, "takes more than"),
        (leaving, "x", "leaves"),
    ],
)
def test_the_judge_can_fail(function, value, words, monkeypatch):
    monkeypatch.setitem(table.PUBLIC, "wrong", function)
    monkeypatch.setitem(table.VALUES, "value", 1.0)
    monkeypatch.setattr(adversary, "LIMIT", 0.2)
    found = adversary.judge(adversary.Call("wrong", "value", "number:x", value))
    assert found
    assert re.search(words, found)


@pytest.mark.opengl
@pytest.mark.parametrize(
    ("name", "argument", "label"),
    [
        ("accessor.Accessor.sky", "mesh", "mesh:inf points"),
        ("accessor.Accessor.streamlines", "mesh", "mesh:huge points"),
        ("draw.component.Component.export_html", "source", "array:inf"),
        ("draw.component.Component.show_key", "mesh", "mesh:line"),
        ("draw.component.Component.show_key", "mesh", "mesh:rgb bool"),
        ("draw.gltf.save_gltf", "mesh", "mesh:Normals of 2"),
        ("draw.gltf.save_gltf", "scalars", "text:[]"),
        ("draw.isolines.isolines", "letters", "number:5e-324"),
        ("draw.isolines.isolines", "mesh", "mesh:NaN points"),
        ("draw.isolines.isolines", "words", "array:short last axis"),
        ("draw.render.pictures", "clim", "number:4611686018427387904"),
        ("draw.isolines.isolines", "mesh", "mesh:h of 7"),
        ("draw.movie.orbit", "plotter", "other:{}"),
        ("draw.render.save", "plotter", "other:None"),
        ("reading.reader.read", "time", "text:array(['x', 'y'], dt"),
        ("maps.bands", "cmap", "text:''"),
        ("maps.bands", "levels", "array:0-d"),
        ("maps.bands", "logarithmic", "flag:nan"),
        ("draw.several_views.several_views", "mesh", "mesh:Normals of 7"),
        ("draw.several_views.several_views", "mesh", "mesh:V uint8"),
        ("mesh.charts.chart", "mesh", "mesh:inf points"),
        ("mesh.derived.stretched", "factor", "number:-1"),
        ("mesh.derived.with_vectors", "mesh", "mesh:h string"),
        ("mesh.globes.globe", "mesh", "mesh:NaN points"),
        ("mesh.smooth_maps.smoothed", "name", "text:Ellipsis"),
        ("observers.legibility.legibility", "cmap", "text:{'x'}"),
        ("observers.legibility.legibility", "size_mm", "number:1e+300"),
        ("shading.engine.shade", "repeat", "number:np.int8(1)"),
    ],
)
def test_values_that_were_not_refused_in_words(name, argument, label):
    found = [c for c in adversary.calls(name) if (c.argument, c.label) == (argument, label)]
    assert [adversary.judge(call) for call in found[:1]] == [""]


def test_warnings_of_the_package_pass(monkeypatch):
    def warning(value):
        _check.warn("of vizlight")

    monkeypatch.setitem(table.PUBLIC, "right", warning)
    monkeypatch.setitem(table.VALUES, "value", 1.0)
    assert not adversary.judge(adversary.Call("right", "value", "number:x", 2.0))
