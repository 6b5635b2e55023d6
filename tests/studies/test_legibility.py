"""The study of legibility: its rows."""

from __future__ import annotations

import numpy as np
import pytest

from studies import _readable, legibility

pytestmark = pytest.mark.opengl


@pytest.fixture(scope="module")
def places():
    return [legibility._place(name, 0, 64) for name in ("nut", "childress")]


def test_each_data_set_has_what_is_asked_for():
    for name, make in _readable.known().items():
        if name == "helens":
            continue
        data = make()
        assert np.isfinite(data.mesh.points).all()
        assert (data.tangents is None) == (name in _readable.LINES)
        if data.tangents is not None:
            length = np.linalg.norm(data.mesh[data.tangents], axis=1)
            assert np.mean(length > 0.99) > 0.9, name
            assert np.ptp(data.mesh[data.scalars]) > 0


def test_presets_are_better_than_the_default_where_they_are_asked(places):
    rows = {(row.way, row.parameter): row for row in legibility.lights(places)}
    for question in ("direction", "key", "heading", "shape"):
        row = rows[f"presets.{legibility.BEST[question]}", question]
        assert row.error < 0.5 * row.cost, question
        assert row.more["gains on"] == "1 of 1"
    same = rows[legibility.DEFAULT, "slope"]
    assert same.error == same.cost
    assert same.more["best gain"] == 0


def test_an_option_is_compared_with_the_light_that_it_changes(places):
    rows = legibility.option("specular=0", places, 64)
    for row in rows:
        # Neither the presets nor the default have a highlight.
        assert row.error == row.cost
    assert {row.parameter for row in rows} == set(legibility.ERRORS)
    shadowed = legibility.option("conditioned=True", places, 64)
    assert {row.parameter for row in shadowed} == {"direction", "key"}
    lines = legibility.option("bundle=True", places, 64)
    assert {row.parameter for row in lines} == {"slope", "heading"}
