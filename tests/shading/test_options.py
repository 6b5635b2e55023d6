"""One list of options: keywords, fields, signatures and documentation agree."""

from __future__ import annotations

import dataclasses
import inspect
import re

import pytest

import vizlight
from vizlight.filters.fur import FurKeywords, FurOptions
from vizlight.filters.isoluminance import ContourKeywords, ContourOptions
from vizlight.filters.project import ProjectKeywords, ProjectOptions
from vizlight.filters.relief_shadow import ReliefKeywords, ReliefOptions
from vizlight.filters.streamlines import StreamlineKeywords, StreamlineOptions
from vizlight.shading.options import (
    LightKeywords,
    LightOptions,
    ShadingKeywords,
    ShadingOptions,
    accepts,
    documented,
)

PAIRS = [
    (ShadingOptions, ShadingKeywords),
    (LightOptions, LightKeywords),
    (StreamlineOptions, StreamlineKeywords),
    (ProjectOptions, ProjectKeywords),
    (ContourOptions, ContourKeywords),
    (FurOptions, FurKeywords),
    (ReliefOptions, ReliefKeywords),
]


@pytest.mark.parametrize(("fields", "keywords"), PAIRS)
def test_keywords_are_the_fields(fields, keywords):
    own = {field.name: field.type for field in dataclasses.fields(fields)}
    hints = {name: hint.__forward_arg__ for name, hint in keywords.__annotations__.items()}
    assert {name: re.sub(r"Required\[(.*)\]", r"\1", hint) for name, hint in hints.items()} == own


@pytest.mark.parametrize("fields", [pair[0] for pair in PAIRS])
def test_every_option_is_described_with_its_default(fields):
    texts = documented(fields)
    for field in dataclasses.fields(fields):
        assert field.name in texts, field.name
        stated = re.search(r"default: ([^\n]*)", texts[field.name].partition("\n")[0])
        if stated and field.default is not dataclasses.MISSING:
            assert eval(stated[1]) == field.default, field.name


@pytest.mark.parametrize(
    ("filter_name", "fields"),
    [
        ("illuminate", LightOptions),
        ("streamlines", StreamlineOptions),
        ("project", ProjectOptions),
        ("manifold", ProjectOptions),
        ("fur", FurOptions),
        ("isoluminance", ContourOptions),
        ("relief_shadow", ReliefOptions),
    ],
)
def test_signature_and_documentation_list_the_options(filter_name, fields):
    function = getattr(vizlight, filter_name)
    parameters = inspect.signature(function).parameters
    text = inspect.getdoc(function)
    assert "**options" not in text
    for field in dataclasses.fields(fields):
        assert parameters[field.name].kind is inspect.Parameter.KEYWORD_ONLY
        if field.default is dataclasses.MISSING:
            assert parameters[field.name].default is inspect.Parameter.empty
        else:
            assert parameters[field.name].default == field.default
        assert re.search(rf"^(\w+, )*{field.name}(, \w+)*( :|$)", text, re.MULTILINE), field.name


@accepts(ShadingOptions, without=("precision",))
def toy(mesh, /, *, size=1, **options):
    """Return what came.

    Parameters
    ----------
    mesh
        Anything.
    **options
        Fields of ShadingOptions.
    size : int
        Anything else.
    """
    return mesh, size, options


def test_keywords_are_checked_by_name():
    assert toy(1, size=2, model="blinn") == (1, 2, {"model": "blinn"})
    with pytest.raises(TypeError, match="modle: expected an option of toy.* mean model="):
        toy(1, modle="blinn")
    with pytest.raises(TypeError, match="precision: expected an option of toy"):
        toy(1, precision="float32")
    with pytest.raises(TypeError, match=r"zzz: .* it has size, exponent, model"):
        toy(1, zzz=0)
    assert "precision" not in inspect.signature(toy).parameters
    assert "Reflection model" in toy.__doc__
    assert "Anything else." in toy.__doc__


def test_a_missing_option_is_named():
    @dataclasses.dataclass(frozen=True)
    class Options:
        """Options.

        Parameters
        ----------
        size : float
            Size of it.
        """

        size: float

    @accepts(Options)
    def sized(mesh, /, **options):
        """Return what came.

        Parameters
        ----------
        **options
            Fields of Options.
        """
        return options

    assert sized(1, size=2) == {"size": 2}
    with pytest.raises(TypeError, match="size: expected a value for sized, got none"):
        sized(1)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"model": "lambert"}, ValueError, "model: expected 'phong', 'blinn' or 'cylinder'"),
        ({"precision": "half"}, ValueError, "precision: expected 'float32' or 'float64'"),
        ({"conditioned": 3}, TypeError, "conditioned: expected True, False or the name"),
        ({"components": "no"}, TypeError, "components: expected True or False, got 'no'"),
    ],
)
def test_bad_values(options, error, words):
    with pytest.raises(error, match=words):
        LightOptions(**options)


def test_satin_has_more_seeds():
    assert inspect.signature(vizlight.satin).parameters["seeds"].default == 300
    assert inspect.signature(vizlight.streamlines).parameters["seeds"].default == 200


def test_options_for_a_surface_beside_lines():
    assert ShadingOptions(model="cylinder").for_surface().model == "blinn"
    assert ShadingOptions(model="phong").for_surface().model == "phong"
