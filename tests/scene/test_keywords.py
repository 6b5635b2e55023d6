"""Records that take keywords alone say which, and which of them was meant."""

import inspect

import pytest
import pyvista as pv

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View

RECORDS = {
    Material: ("spec", "specular"),
    Light: ("dir", "direction"),
    Scene: ("light", "lights"),
    View: ("pos", "position"),
    DepthCue: ("colour", "color"),
}


@pytest.mark.parametrize("record", RECORDS)
def test_an_unknown_keyword_is_answered_by_the_known_ones(record):
    wrong, right = RECORDS[record]
    with pytest.raises(TypeError, match=f"{wrong}: .* of {record.__name__}.*mean {right}="):
        record(**{wrong: 1})
    with pytest.raises(TypeError, match="zzz: expected an option of") as error:
        record(zzz=1)
    assert all(name in str(error.value) for name in inspect.signature(record).parameters)


def test_values_without_a_name_are_refused():
    with pytest.raises(TypeError, match=r"Scene: .* got Light\(.*; name it, as in Scene\(lights="):
        Scene(Light(direction=(1, 1, 1)))


def test_filters_say_how_a_value_without_a_name_is_named():
    scene = Scene()
    with pytest.raises(TypeError, match=r"project: .* got Scene\(.*; name it, as in project\(sce"):
        vizlight.project(pv.Sphere(), scene)
    with pytest.raises(TypeError, match=r"got 'V'; name it, as in illuminate\(tangents="):
        vizlight.illuminate(pv.Sphere(), scene, "V")
    with pytest.raises(TypeError, match=r"add_mesh: .* got Scene\(.*; name it, as in add_mesh\(s"):
        pv.Plotter().vizlight.add_mesh(pv.Sphere(), scene)
    with pytest.raises(TypeError, match=r"plot: .* got Scene\(.*; name it, as in plot\(scene="):
        pv.Sphere().vizlight.plot(scene)
