"""Strokes that a changing field carries."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from vizlight.mesh import particles as drift_module
from vizlight.mesh.particles import Drift
from vizlight.vtk import polylines

SPACING, LENGTH = 0.5, 1.5


def _grid(layers: int) -> pv.ImageData:
    return pv.ImageData(dimensions=(21, 21, layers), spacing=(0.5, 0.5, 0.5))


def _uniform(grid: pv.ImageData, velocity: tuple[float, float, float]) -> np.ndarray:
    return np.tile(np.array(velocity), (grid.n_points, 1))


def _ways(lines: pv.PolyData) -> np.ndarray:
    """Return the way from the first point of each line to its last."""
    _, ids, offsets = polylines.cells_of(lines)
    points = np.asarray(lines.points, dtype=np.float64)[ids]
    return points[offsets[1:] - 1] - points[offsets[:-1]]


@pytest.mark.parametrize("layers", [1, 8])
def test_strokes_are_as_long_as_asked_for_and_spread_over_the_mesh(layers: int) -> None:
    grid = _grid(layers)
    drift = Drift(grid, _uniform(grid, (2.0, 0.0, 0.0)), SPACING, LENGTH)
    assert drift.duration == pytest.approx(LENGTH / 2.0)
    lines = drift.strokes("V")
    ways = _ways(lines)
    np.testing.assert_allclose(ways[:, 1:], 0, atol=1e-6)
    assert np.all((ways[:, 0] > 0) & (ways[:, 0] < LENGTH * (1 + 1e-6)))
    widths = lines.point_data["width"]
    # Young ones are thin as a whole.
    assert widths.min() < 0.1
    assert 0.9 < widths.max() <= 1
    # Every square of 2.5 by 2.5 has strokes.
    counts, _, _ = np.histogram2d(*lines.points[:, :2].T, bins=4, range=[[0, 10], [0, 10]])
    assert counts.min() > 0


def test_ways_are_those_of_particles_in_a_field_that_turns() -> None:
    grid = _grid(1)
    drift = Drift(grid, _uniform(grid, (1.0, 0.0, 0.0)), SPACING, LENGTH)
    steps, end = 40, 3.0
    times = np.linspace(0.0, end, steps + 1)
    fields = [_uniform(grid, (np.cos(t), np.sin(t), 0.0)) for t in times]
    for i in range(steps):
        drift.between(fields[i], fields[i + 1])
        drift.advance(0.0, 1.0, end / steps)
    ways = _ways(drift.strokes("V"))
    # The integral of the velocity over the time that a grown stroke shows, less a row at most.
    start = end - drift.duration
    exact = np.array([np.sin(end) - np.sin(start), np.cos(start) - np.cos(end)])
    same = np.linalg.norm(ways[:, :2] - exact, axis=1) < 0.08 * LENGTH
    # The others are younger, or shrink.
    assert np.mean(same) > 0.3
    assert np.all(np.linalg.norm(ways, axis=1) < 1.01 * drift.duration)


def test_a_stroke_lives_on_from_picture_to_picture() -> None:
    grid = _grid(1)
    velocity = (1.0, 0.5, 0.0)
    drift = Drift(grid, _uniform(grid, velocity), SPACING, LENGTH)
    before = drift.strokes("V")
    move = drift.duration / 16
    drift.advance(0.0, 0.0, move)
    after = drift.strokes("V")
    heads = [
        np.asarray(lines.points)[polylines.cells_of(lines)[2][1:] - 1] for lines in (before, after)
    ]
    expected = heads[0] + move * np.array(velocity)
    moved, stopped = (
        np.linalg.norm(heads[1][:, np.newaxis] - places, axis=2).min(axis=0) < 1e-5
        for places in (expected, heads[0])
    )
    assert np.mean(moved) > 0.5
    # The others shrink at the end of their lives, where they are; few are gone.
    assert np.mean(moved | stopped) > 0.9


def test_strokes_end_where_vectors_are_missing() -> None:
    grid = _grid(1)
    vectors = _uniform(grid, (1.0, 0.0, 0.0))
    vectors[grid.points[:, 0] > 5] = np.nan
    drift = Drift(grid, vectors, SPACING, LENGTH)
    drift.advance(0.0, 0.0, drift.duration)
    lines = drift.strokes("V")
    assert lines.n_points
    assert lines.points[:, 0].max() <= 5 + 1e-6
    assert np.all(np.isfinite(lines.point_data["width"]))


def test_a_field_at_rest_has_no_stroke() -> None:
    grid = _grid(1)
    drift = Drift(grid, np.zeros((grid.n_points, 3)), SPACING, LENGTH)
    drift.advance(0.0, 0.0, 1.0)
    assert drift.strokes("V").n_points == 0


def test_the_number_of_strokes_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drift_module, "MOST", 40)
    grid = _grid(1)
    drift = Drift(grid, _uniform(grid, (1.0, 0.0, 0.0)), 0.01, 0.01)
    assert 0 < drift.strokes("V").n_lines <= 40
    assert drift.fits(grid)
    assert not drift.fits(_grid(2))
