"""The error meter measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np
import pytest

from studies import lines, words
from vizlight.model import cylinder


@pytest.fixture(scope="module")
def rows():
    found = lines.measure(2000, repeats=1)
    return {(row.setting, row.term, row.model): row for row in found}


def test_what_is_exact_up_to_a_factor_and_what_is_not(rows):
    for term, model in (("diffuse", "Banks, p = 1"), ("specular", "Blinn")):
        assert rows["headlight", term, model].scaled_worst < 1e-13
        assert rows["random", term, model].scaled_worst > 0.1
    assert rows["headlight", "diffuse", "Banks, p(1, 3)"].scaled_rms > 0.1
    assert rows["random", "diffuse", "exact"].worst == 0


def test_tubes_near_the_cylinder_at_second_order(rows):
    for term in ("diffuse", "specular"):
        rough, fine = (rows["random", term, f"tube of {n} sides"].rms for n in (8, 40))
        assert np.log(rough / fine) / np.log(5) == pytest.approx(2, abs=0.2)
    sizes = [rows["random", "diffuse", f"tube of {n} sides"].bytes for n in lines.SIDES]
    assert sizes == sorted(sizes)
    assert sizes[0] > 3 * rows["random", "diffuse", "exact"].bytes
    assert all(row.nanoseconds > 0 for row in rows.values())


def test_a_tube_of_many_sides_is_the_cylinder():
    wi, wo, t = lines.directions(50, headlight=False)
    diffuse, specular = lines.tube(wi, wo, t, 300, shininess=10.0)
    np.testing.assert_allclose(diffuse, cylinder.diffuse(wi, wo, t), atol=2e-4)
    exact = cylinder.specular(wi, wo, t, shininess=10.0)
    np.testing.assert_allclose(specular, exact, atol=2e-4)


def test_rows_of_the_study(monkeypatch):
    monkeypatch.setattr(lines, "SIDES", (3, 40))
    rows = lines.rows(500, repeats=1)
    assert {row.parameter for row in rows} == {0, 3, 40}
    said = lines.verdict(rows)
    assert said.startswith(
        "models to use for an RMS error of 1/255, each with its best factor: diffuse: "
    )
    assert "diffuse with a headlight: 'Banks, p = 1'" in said
    # The errors are those by the best factor, as in the table.
    blinn = next(row for row in rows if row.way == "Blinn, specular, random")
    assert f"('Blinn' at {words(blinn.cost)} ns has an error of {blinn.error:.2g})" in said
    assert blinn.error < 0.04 < 0.2 < blinn.more["RMS error without factor"]
    far = [row._replace(error=0.5) for row in rows]
    assert "diffuse: none, 'Banks, p = 1' has an error of 0.5" in lines.verdict(far)
    shown = {lines.STUDY.curve(row) for row in rows} - {None}
    assert {name for name, _ in shown} == {"Banks, p = 1", "Banks, p(1, 3)", "tube", "exact"}
