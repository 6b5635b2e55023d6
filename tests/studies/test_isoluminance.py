"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from studies import Row
from studies import isoluminance as study
from vizlight import render


@pytest.mark.opengl
@pytest.mark.parametrize("shape", study.SHAPES)
def test_rows(shape):
    rows = study.measure(shape, 900, levels=30, repeats=1)
    contours, coarse, fine, cast = rows
    assert contours.largest < coarse.largest
    assert fine.largest <= contours.largest
    assert fine.vertices > coarse.vertices
    # Half a step, a pixel's step, and the slope over half a pixel.
    assert contours.mean < 0.9 / 60
    assert min(row.model for row in rows) > 0
    assert cast.vertices == 0


def test_the_cast_is_the_exact_picture():
    camera = render.camera_on(
        (-1, 1, -1, 1, -1, 1), study.EYE, parallel=True, zoom=math.sqrt(3) / 1.02
    )
    ball, cone = (study.cast(shape, camera, 200) for shape in ("sphere", "cone"))
    scale = (2 * camera.parallel_scale / 200) ** 2
    assert np.isfinite(ball).sum() * scale == pytest.approx(math.pi, rel=5e-3)
    assert np.nanmax(ball) == pytest.approx(1, abs=1e-3)
    assert np.nanmin(ball) == study.LOW
    cosine = (study.TOWARD[2] * 0.5 + math.hypot(*study.TOWARD[:2])) / math.hypot(1, 0.5)
    assert np.nanmax(cone) == pytest.approx(study.LOW + study.SCALE * cosine, abs=1e-3)


def test_highlights():
    """Exact for light and eye far away; first order in 1 / distance, peak nearer to the light."""
    far = study.highlight(math.inf, 60)
    assert far.half < 1e-12
    assert abs(far.shift) < 1e-9
    near = [study.highlight(d, 60) for d in (16.0, 32.0, 64.0)]
    order = np.log2([a.half / b.half for a, b in itertools.pairwise(near)])
    np.testing.assert_allclose(order, 1, atol=0.2)
    assert all(row.shift > 0 for row in near)
    # Fisher and Woo: (N . H)^(4 s) against (R . E)^s, the same at the peak.
    assert 0.05 < far.mirror < 0.2


@pytest.mark.parametrize("shape", study.SHAPES)
def test_facets_need_more_vertices_for_the_same_worst_error(shape):
    """Facets lie across the terminator: their worst error falls with their size, not its square."""
    row = study.count(shape, 0.02)
    assert row.facets > row.contours


@pytest.mark.opengl
def test_rows_and_verdict():
    rows = [row for shape in study.SHAPES for row in study.vertices(shape, 0.05)]
    rows += study.pictures("sphere", 300, 12, 1) + study.virtual(30.0)
    assert {row.way for row in rows} >= {"sphere, contours", "virtual light, 30 degrees"}
    said = study.verdict(rows)
    assert "either method for a sphere at an error of 0.05 (contours 758, facets 762)" in said
    assert "contours for a cone at an error of 0.05 (contours 43, facets 150)" in said
    assert "for the fastest picture of that quality use" in said
    panels = (study.STUDY, *study.STUDY.beside)
    assert all(sum(panel.curve(row) is not None for panel in panels) == 1 for row in rows)


def test_the_verdict_follows_vertices_and_times():
    """What needs ten times the vertices, or is too far off, is not chosen."""
    rows = [
        Row(f"{s}, {way}", 0.01, 0.01, cost)
        for s in study.SHAPES
        for way, cost in (("contours", 1000), ("facets", 100))
    ]
    ways = (
        ("50 levels", 0.01, 9.0),
        ("70 facets", 0.3, 1.0),
        ("900 facets, equal", 0.01, 5.0),
        ("ray cast", 0.0, 20.0),
    )
    rows += [
        Row(
            f"picture of a cone, {way}",
            550,
            error,
            10,
            {"ms to model": ms - 1, "ms per frame": 1.0},
        )
        for way, error, ms in ways
    ]
    said = study.verdict(rows)
    assert "use facets for a sphere at an error of 0.01 (contours 1000, facets 100)" in said
    assert "use 900 facets of equal error for a cone of 550 pixels (5 ms, 50 levels 9" in said
