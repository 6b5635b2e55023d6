"""The study's numbers are those of a short run: errors, not times."""

from __future__ import annotations

import numpy as np
import pytest

from studies import sky


@pytest.mark.filterwarnings("ignore:the sky changes inside of triangles")
def test_rows_of_a_field_and_of_a_surface():
    (field,) = sky.of_field(48, 0.3, 0.02)
    assert 0 < field.error <= 0.02
    assert field.more["stated"] <= 0.02
    pytest.importorskip("embreex")
    (ball,) = sky.of_surface(400, 0.04)
    assert 0 < ball.error <= 0.04
    assert ball.cost > 0


def test_the_truth_of_a_slope():
    at, slopes, t, turn = sky.horizons(48, 0.3)
    assert at.shape == (sky.PLACES, 2)
    assert t.shape == (sky.PLACES, len(turn))
    assert np.isfinite(slopes).all()
    _, share = sky.field_truth(48, 0.3)
    assert ((share > 0.3) & (share <= 1)).all()
