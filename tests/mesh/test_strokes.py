"""Strokes: lengths along lines, and pieces with widths."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.mesh import strokes

LENGTHS = (4.0, 1.0, 2.5)


def lines():
    """Straight lines of three lengths along x, the second against its tangents."""
    parts = [pv.Line((0, y, 0), (size, y, 0), resolution=40) for y, size in enumerate(LENGTHS)]
    mesh = parts[0].append_polydata(*parts[1:])
    mesh.clear_data()
    signs = np.where(mesh.points[:, 1] == 1, -1.0, 1.0)
    mesh["t"] = np.outer(signs, [1.0, 0, 0])
    return mesh


def test_ages_run_along_the_tangents():
    mesh = lines()
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    expected = np.where(y == 1, LENGTHS[1] - x, x)
    np.testing.assert_allclose(strokes.ages(mesh, mesh["t"]), expected, atol=1e-6)


def test_short_lines_are_left_out():
    kept = strokes.without_short(lines(), 2.0)
    assert kept.n_lines == 2
    assert set(kept.points[:, 1]) == {0.0, 2.0}
    np.testing.assert_array_equal(kept["t"], np.tile([1.0, 0, 0], (82, 1)))
    assert strokes.without_short(lines(), 9.0).n_lines == 0


@pytest.mark.parametrize("signed", [True, False])
def test_strokes_are_equally_long_and_thin_where_they_come_from(signed):
    cut = strokes.cut(lines(), 1.0, "t", signed=signed)
    # 4, 1 and 2 pieces: 2.5 is rounded to an even number.
    assert cut.n_lines == 7
    assert cut.compute_cell_sizes()["Length"] == pytest.approx([1] * 5 + [1.25] * 2, abs=0.1)
    for line in (cut.get_cell(i) for i in range(7)):
        widths = cut["width"][line.point_ids]
        ends = widths[[0, -1]] if line.points[0, 1] != 1 else widths[[-1, 0]]
        assert ends == pytest.approx([0.3, 1.0 if signed else 0.3], abs=1e-6)
        assert widths.max() == pytest.approx(1.0, abs=0.05)
