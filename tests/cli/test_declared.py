"""The options that the source of a filter declares are those of the filter itself."""

from __future__ import annotations

import inspect
import subprocess
import sys
import typing

import pytest

import vizlight
from vizlight import _words
from vizlight.cli import declared, options
from vizlight.geometry.relief.height_field import Border
from vizlight.shading.options import Model

FILTERS = (
    "fur", "illuminate", "isoluminance", "pathlines", "project", "refine", "relief_day",
    "relief_shadow", "satin", "streamlines",
)  # fmt: skip


@pytest.mark.parametrize("name", FILTERS)
def test_options_are_those_of_the_signature(name):
    function = getattr(vizlight, name)
    found = declared.filter_(name)
    expected = {
        key: (str(p.annotation), p.default is p.empty, None if p.default is p.empty else p.default)
        for key, p in inspect.signature(function).parameters.items()
        if p.kind is p.KEYWORD_ONLY
    }
    assert {key: option[:3] for key, option in found.options.items()} == expected
    texts = _words.parameters(function.__doc__)
    assert {key: found.texts[key] for key in expected} == {key: texts[key] for key in expected}


def test_choices_are_those_of_the_type():
    model = declared.filter_("illuminate").options["model"]
    border = declared.filter_("relief_shadow").options["border"]
    for option, kind in ((model, Model), (border, Border)):
        made = declared.choices(option, option.annotation)
        assert typing.get_args(made) == typing.get_args(kind)
    assert declared.choices(model, "ArrayLike") is None
    assert declared.choices(model, "int") is None


def test_what_is_not_there_is_named():
    with pytest.raises(LookupError, match=r"no file of vizlight\.filters\.nothing"):
        declared.filter_("nothing")
    with pytest.raises(LookupError, match="defines no nothing"):
        declared.function("vizlight.filters.fur", "nothing")
    with pytest.raises(LookupError, match="FurOptions is no function"):
        declared.function("vizlight.filters.fur", "FurOptions")


def test_help_loads_nothing_that_computes_or_draws():
    """It is printed in less time than these packages take to load."""
    code = """
import sys
from vizlight import cli
names = [name for name in cli.app if name[0] != "-"]
for words in ([], *([name] for name in names)):
    assert cli.main([*words, "--help"]) == cli.OK
print(*names)
print(*{name.partition(".")[0] for name in sys.modules}, "rich.markdown" in sys.modules)
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    *_, names, loaded = run.stdout.splitlines()
    assert {"light", "relief", "view", "demo"} <= set(names.split())
    assert not {"numpy", "scipy", "pyvista", "vtkmodules", "matplotlib", "True"} & {*loaded.split()}


def test_the_help_of_an_option_is_its_own_description():
    texts = declared.filter_("illuminate").texts
    own = {name: text for name, text in texts.items() if text and "s for :" not in text}
    assert len(own) > 8
    for name, text in own.items():
        found = options._text(name, texts)
        assert found == options._flat(text) or name in {*options.READ, *options.READ_LISTS}
