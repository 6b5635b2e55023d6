"""The options that the source of a filter declares are those of the filter itself."""

from __future__ import annotations

import inspect
import subprocess
import sys
import typing
from dataclasses import fields

import pytest

import vizlight
from vizlight import _words
from vizlight.cli import options
from vizlight.geometry.relief.height_field import Border
from vizlight.shading.options import Model

FILTERS = (
    "fur", "illuminate", "isoluminance", "pathlines", "project", "refine", "relief_day",
    "relief_shadow", "satin", "streamlines",
)  # fmt: skip


@pytest.mark.parametrize("name", FILTERS)
def test_options_are_those_of_the_signature(name):
    parameters = inspect.signature(getattr(vizlight, name)).parameters
    found = {one.name: one.default for one in fields(options.arguments_of(name))}
    assert found == {key: parameters[key].default for key in found}
    plain = {
        key
        for key, one in parameters.items()
        if one.kind is one.KEYWORD_ONLY and one.annotation.partition(" | ")[0] in options.TYPES
    }
    assert plain - {*options.NOT_OPTIONS} <= found.keys()


def test_choices_are_those_of_the_type():
    for name, option, kind in (
        ("illuminate", "model", Model), ("relief_shadow", "border", Border)
    ):  # fmt: skip
        made = typing.get_type_hints(options.arguments_of(name))[option]
        assert typing.get_args(made) == typing.get_args(kind)
    # An array, and a type of another module, are left to scripts.
    assert "sun" not in typing.get_type_hints(options.arguments_of("relief_shadow"))
    tangents = typing.get_type_hints(options.arguments_of("illuminate"))["tangents"]
    assert tangents == str | None


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
    texts = _words.parameters(vizlight.illuminate.__doc__)
    own = {name: text for name, text in texts.items() if text and "s for :" not in text}
    assert len(own) > 8
    for name, text in own.items():
        words = " ".join(text.partition("\n")[2].split()).replace("``", "")
        if name not in options.READ and ":" not in words:
            assert options._text(name, texts) == words
