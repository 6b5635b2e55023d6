"""One list of options: keywords, fields, signatures and documentation agree."""

import dataclasses
import inspect
import re

import pytest
from refusals import refusals

import vizlight
from vizlight import _words
from vizlight.draw import paraview
from vizlight.filters.fur import FurOptions
from vizlight.filters.isoluminance import ContourOptions
from vizlight.filters.pathlines import PathlineOptions
from vizlight.filters.project import ProjectOptions
from vizlight.filters.refine import RefineOptions
from vizlight.filters.relief_shadow import ReliefOptions
from vizlight.filters.satin import SatinOptions
from vizlight.filters.sky import SkyOptions
from vizlight.filters.streamlines import StreamlineOptions
from vizlight.scene.keywords import named
from vizlight.shading import engine
from vizlight.shading.options import LightOptions, ShadingOptions

#: Functions, the options that they take, and those that they leave out.
FUNCTIONS = [
    (engine.shade, ShadingOptions, set()),
    (engine.plan, ShadingOptions, set()),
    (vizlight.illuminate, LightOptions, set()),
    (vizlight.streamlines, StreamlineOptions, set()),
    (vizlight.pathlines, PathlineOptions, set()),
    (vizlight.satin, SatinOptions, set()),
    (vizlight.project, ProjectOptions, set()),
    (vizlight.manifold, ProjectOptions, set()),
    (vizlight.fur, FurOptions, set()),
    (vizlight.isoluminance, ContourOptions, set()),
    (vizlight.relief_shadow, ReliefOptions, set()),
    (vizlight.relief_day, ReliefOptions, {"lit", "components", "occlusion"}),
    (vizlight.refine, RefineOptions, set()),
    (paraview.shader, LightOptions, set(paraview.WITHOUT)),
    (vizlight.vtk.Illuminate, LightOptions, {"feature_angle", "line_field", "bundle"}),
    (vizlight.sky, SkyOptions, set()),
]
IDS = [function.__qualname__ for function, _, _ in FUNCTIONS]


@pytest.mark.parametrize(("function", "kind", "without"), FUNCTIONS, ids=IDS)
def test_the_signature_lists_the_options(function, kind, without):
    """Names, types and defaults are those of the fields, for an editor and for help() alike."""
    parameters = inspect.signature(function).parameters
    kinds = {p.kind for p in parameters.values()}
    assert inspect.Parameter.VAR_KEYWORD not in kinds
    without = without | kind.DECIDED
    fields = {f.name: f for f in dataclasses.fields(kind)}
    assert without <= fields.keys()
    positional = {p.name for p in parameters.values() if p.kind is not p.KEYWORD_ONLY}
    assert fields.keys() - without - positional == fields.keys() & parameters.keys() - positional
    for name in fields.keys() - without - positional:
        parameter, field = parameters[name], fields[name]
        required = field.default is dataclasses.MISSING
        assert parameter.kind is parameter.KEYWORD_ONLY
        assert parameter.annotation == field.type, name
        assert parameter.default == (parameter.empty if required else field.default), name


@pytest.mark.parametrize(("function", "kind", "without"), FUNCTIONS, ids=IDS)
def test_every_option_is_described_with_its_default(function, kind, without):
    if function is vizlight.vtk.Illuminate:
        pytest.skip("its options are properties, described there")
    parameters, texts = inspect.signature(function).parameters, _words.parameters(function.__doc__)
    for name in {f.name for f in dataclasses.fields(kind)} & parameters.keys():
        assert name in texts, name
        stated = re.search(r"default: ([^\n]*)", texts[name].partition("\n")[0])
        if stated:
            assert eval(stated[1]) == parameters[name].default, name


@named
def toy(mesh, /, *, size=1, model="phong"):
    return mesh, size, model


def test_keywords_are_checked_by_name():
    assert toy(1, size=2, model="blinn") == (1, 2, "blinn")
    with pytest.raises(TypeError, match="modle: expected an option of toy.* mean model="):
        toy(1, modle="blinn")
    with pytest.raises(TypeError, match=r"zzz: .* it has size, model"):
        toy(1, zzz=0)


def test_options_of_a_function_and_those_that_differ():
    made = LightOptions.of({"mesh": 1, "model": "blinn", "refine": 0.0, "tangents": [1.0]})
    assert made.changed() == {"model": "blinn", "tangents": [1.0]}
    assert ReliefOptions.of({"depth": 0.0}).changed()["depth"] == 0.0


test_bad_values = refusals(
    lambda options: LightOptions(**options),
    ({"model": "lambert"}, "model: expected 'phong', 'blinn' or 'cylinder'"),
    ({"precision": "half"}, "precision: expected 'float32' or 'float64'"),
    ({"conditioned": 3}, "conditioned: expected True, False or the name", TypeError),
    ({"components": "no"}, "components: expected True or False, got 'no'", TypeError),
)


def test_satin_has_more_seeds():
    assert inspect.signature(vizlight.satin).parameters["seeds"].default == 300
    assert inspect.signature(vizlight.streamlines).parameters["seeds"].default == 200


def test_options_for_a_surface_beside_lines():
    assert ShadingOptions(model="cylinder").for_surface().model == "blinn"
    assert ShadingOptions(model="phong").for_surface().model == "phong"
