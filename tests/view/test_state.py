from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import pyvista as pv

from vizlight.view.state import History, State, facts_of, first, fitted


def volume():
    grid = pv.ImageData(dimensions=(5, 6, 7))
    grid["T"] = np.linspace(300.0, 900.0, grid.n_points)
    grid["p"] = np.linspace(0.0, 1.0, grid.n_points)
    grid["V"] = np.ones((grid.n_points, 3), np.float32)
    return grid


def field(height):
    grid = pv.ImageData(dimensions=(5, 6, 1))
    grid["h"] = np.linspace(0.0, height, grid.n_points)
    return grid


@pytest.mark.parametrize(
    ("mesh", "shows", "expected"),
    [
        (volume(), ("surface", "isosurface", "streamlines"), {"show": "isosurface", "level": 600}),
        (pv.Sphere(), ("surface",), {"show": "surface", "heights": ""}),
        (field(1.0), ("surface",), {"heights": "h", "factor": 1.0}),
        (field(1e6), ("surface",), {"heights": "h", "factor": 3.2e-7}),
        (pv.Line(), ("surface",), {"show": "surface"}),
        (pv.PolyData([[0.0, 0, 0]]), ("surface",), {"show": "surface"}),
    ],
)
def test_first_state_shows_what_a_file_has(mesh, shows, expected):
    facts = facts_of(mesh)
    assert facts.shows == shows
    state = first(facts)
    assert {name: getattr(state, name) for name in expected} == expected
    assert fitted(state, state, facts) == state


def test_volume_without_scalars_shows_streamlines():
    grid = volume()
    for name in ("T", "p"):
        del grid.point_data[name]
    assert first(facts_of(grid)).show == "streamlines"


def test_arrays_of_cells_stand_for_those_of_points_where_there_are_none():
    grid = pv.ImageData(dimensions=(5, 6, 7))
    grid.cell_data["T"] = np.linspace(300.0, 900.0, grid.n_cells)
    facts = facts_of(grid)
    assert facts.averaged
    assert set(facts.scalars) == {"T"}
    assert not facts_of(volume()).averaged


def test_what_depends_on_other_values_is_put_right():
    facts = facts_of(volume())
    start = first(facts)
    assert fitted(start.changed(array="p"), start, facts).level == 0.5
    # An isosurface is not coloured by its own constant.
    colored = fitted(start.changed(color="p"), start, facts)
    assert colored.color == "p"
    assert fitted(colored.changed(array="p"), colored, facts).color == ""
    assert fitted(start.changed(color="T"), start, facts).color == ""
    # Lines have a reflection model of their own.
    lines = fitted(start.changed(show="streamlines", model="cylinder"), start, facts)
    assert lines.model == "cylinder"
    assert fitted(lines.changed(show="isosurface"), lines, facts).model == "phong"


def test_light_that_is_moved_no_longer_follows_the_eye():
    assert State().shoulder
    assert not State().changed(azimuth=10).shoulder
    assert State(shoulder=False).changed(shoulder=True).shoulder


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"show": "volume"}, "show: expected"),
        ({"array": "W"}, "array: expected an array, one of"),
        ({"tangents": "T"}, "tangents: expected an array"),
        ({"level": 2000.0}, "level: expected a value between 300 and 900, got 2000"),
        ({"level": float("nan")}, "level: expected"),
        ({"ambient": 2.0}, "ambient: expected"),
        ({"azimuth": "west"}, "azimuth: expected a number"),
        ({"lines": 0}, "lines: expected"),
        ({"cmap": "../viridis"}, "cmap: expected"),
        ({"color": ["T"]}, "color: expected the name of an array"),
        ({"conditioned": "yes"}, "conditioned: expected"),
    ],
)
def test_values_that_do_not_fit_are_refused(values, message):
    facts = facts_of(volume())
    start = first(facts)
    with pytest.raises((TypeError, ValueError), match=message):
        fitted(start.changed(**values), start, facts)


def test_history_undoes_and_redoes():
    a = State()
    b, c = a.changed(ambient=0.2), a.changed(ambient=0.3)
    history = History(a).with_state(b).with_state(c)
    assert history.undone().present == b
    assert history.undone().undone().present == a
    assert history.undone().undone().undone() == history.undone().undone()
    assert history.undone().redone() == history
    assert history.redone() == history
    # A drag is one step; a change after undo forgets what was undone.
    assert History(a).with_state(b).with_state(c, merged=True).undone().present == a
    assert history.undone().with_state(a).future == ()
    assert history.with_state(c) is history


def test_light_alone_needs_no_other_mesh():
    state = State(show="isosurface", array="T")
    for name in ("azimuth", "fill", "ambient", "shininess", "cue", "color", "vectors", "lines"):
        value = getattr(state, name)
        other = "x" if isinstance(value, str) else value / 2 + 0.5
        assert dataclasses.replace(state, **{name: other}).built == state.built
    for name in ("level", "tangents", "model"):
        other = {"level": 5.0, "tangents": "V", "model": "blinn"}[name]
        assert dataclasses.replace(state, **{name: other}).built != state.built
