"""The options that the source of a filter declares are those of the filter itself."""

import inspect
import subprocess
import sys
import typing
from dataclasses import fields

import pytest
from rich.console import Console

import vizlight
from vizlight import _words, cli
from vizlight.cli import options
from vizlight.geometry.relief.height_field import Border
from vizlight.shading.options import Model


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
assert cli.main(["--help"]) == cli.OK
names = [name for name in cli.app if name[0] != "-"]
for name in names:
    assert cli.main([name, "--help"]) == cli.OK
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


#: Filter of each command, and its options that no text can give, or that a file has none of.
COMMANDS = {
    "light": ("illuminate", {"positions", "occlusion"}),
    "streamlines": ("streamlines", {"surface"}),
    "relief": ("relief_shadow", {"occluders", "sun"}),
    "sky": ("sky", set()),
    "fur": ("fur", set()),
    "contours": ("isoluminance", {"tolerance"}),
    "project": ("project", set()),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_of_a_filter_is_one_of_its_command(name, monkeypatch, done):
    """Its default is the filter's, and the help, which fits a screen, has it."""
    filter_, in_scripts = COMMANDS[name]
    parameters = inspect.signature(getattr(vizlight, filter_)).parameters
    found = {one.name: one.default for one in fields(options.arguments_of(filter_))}
    assert found == {key: parameters[key].default for key in found}
    own = {key for key, one in parameters.items() if one.kind is one.KEYWORD_ONLY}
    assert own - {*options.NOT_OPTIONS} - found.keys() <= in_scripts
    # The command line keeps its console, whatever the terminal of the first test was.
    monkeypatch.setattr(cli.app, "console", Console(width=100))
    out = done(name, "--help")
    renamed = {"project": {"light": "when"}, "sky": {"up": "sky_up"}}.get(name, {})
    for option in found.keys() - in_scripts - {"exaggeration", "lit"}:
        assert f"--{renamed.get(option, option).replace('_', '-')} " in out
    groups = ["Arguments", "Light", "Material", "Camera", "Output"]
    places = [out.index(f"─ {group} ─") for group in groups]
    assert places == sorted(places)
    assert f"Example: vizlight {name} " in out
    assert len(out.splitlines()) <= 102


def test_the_first_clause_of_an_option():
    assert options.first_clause("Highlight, R . E or N . H. More.") == "Highlight, R . E or N . H."
    long = (
        "Whether it has the exponent p(k, n: the one), which gives lines the contrast of a surface."
    )
    assert options.first_clause(long) == "Whether it has the exponent p(k, n: the one)."


def test_completion_knows_commands_and_options():
    options.add_commands("--install-completion")
    script = cli.app.generate_completion(shell="bash")
    for word in ("streamlines", "--rotation", "--tangents", "--threshold", "cylinder"):
        assert word in script
    assert "--install-completion" in script


def test_one_command_adds_no_other_to_the_app():
    code = """
from vizlight import cli
cli.main(["light", "--help"])
print(*(name for name in cli.app if name[0] != "-"))
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "light" in run.stdout.splitlines()[-1].split()
    assert "relief" not in run.stdout.splitlines()[-1].split()
