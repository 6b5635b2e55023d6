"""The error meter measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np
import pytest

from studies import lines
from vizlight.model import cylinder


@pytest.fixture(scope="module")
def rows():
    return {(row.way, row.parameter): row for row in lines.measure(2000, repeats=1)}


def test_what_is_exact_up_to_a_factor_and_what_is_not(rows):
    worst = "largest error with the best factor"
    for way in ("Banks, p = 1, diffuse", "Blinn, specular"):
        assert rows[f"{way}, headlight", 0].more[worst] < 1e-13
        assert rows[f"{way}, random", 0].more[worst] > 0.1
    assert rows["Banks, p(1, 3), diffuse, headlight", 0].error > 0.1
    assert rows["exact, diffuse, random", 0].error == 0


def test_tubes_near_the_cylinder_at_second_order(rows):
    for term in ("diffuse", "specular"):
        rough, fine = (
            rows[f"tube, {term}, random", n].more["RMS error without factor"] for n in (8, 40)
        )
        assert np.log(rough / fine) / np.log(5) == pytest.approx(2, abs=0.2)
    sizes = [rows["tube, diffuse, random", n].more["bytes per point"] for n in lines.SIDES]
    assert sizes == sorted(sizes)
    assert sizes[0] > 3 * rows["exact, diffuse, random", 0].more["bytes per point"]
    assert all(row.cost > 0 for row in rows.values())
    shown = {lines.STUDY.curve(row) for row in rows.values()} - {None}
    assert ("Banks, p = 1", "diffuse") in shown
    assert len(shown) == 8


def test_a_tube_of_many_sides_is_the_cylinder():
    wi, wo, t = lines.directions(50, headlight=False)
    diffuse, specular = lines.tube(wi, wo, t, 300, shininess=10.0)
    np.testing.assert_allclose(diffuse, cylinder.diffuse(wi, wo, t), atol=2e-4)
    exact = cylinder.specular(wi, wo, t, shininess=10.0)
    np.testing.assert_allclose(specular, exact, atol=2e-4)
