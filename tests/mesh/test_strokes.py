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


@pytest.mark.parametrize(("radius", "pieces"), [(0.4, 1), (0.2, 2)])
@pytest.mark.parametrize("count", [9, 200])
def test_lines_are_cut_where_they_turn_by_a_right_angle_within_a_seventh(radius, pieces, count):
    """Two straight lines with an arc between them, which turns by a right angle in 1.57 radii."""
    angles = np.linspace(0, 0.9 * np.pi, count)
    arc = radius * np.column_stack([np.sin(angles), 1 - np.cos(angles), 0 * angles])
    way = np.array([np.cos(angles[-1]), np.sin(angles[-1]), 0])
    ends = [-np.linspace(4, 0, 40, endpoint=False)[:, np.newaxis] * (1.0, 0, 0)]
    ends += [arc[-1] + np.linspace(0, 4, 41)[1:, np.newaxis] * way]
    mesh = pv.MultipleLines(np.concatenate([ends[0], arc, ends[1]]))
    mesh = mesh.append_polydata(pv.Line((0, 0, 5), (3.4, 0, 5)))
    kept = strokes.without_short(mesh, 3.5)
    assert (kept.n_lines, kept.field_data["left_out"][0]) == (pieces, 1)
    # No more is lost than the arc and half of the way on either side.
    lost = strokes.segments_of(mesh).lengths.sum() - 3.4 - strokes.segments_of(kept).lengths.sum()
    assert lost == pytest.approx(0 if pieces == 1 else 0.9 * np.pi * radius, abs=0.2)


def test_turned_lines_have_the_values_of_their_other_end():
    mesh = lines()
    values = mesh.points[:, 0] ** 2
    sizes = np.array(LENGTHS)[mesh.points[:, 1].astype(int)]
    turned = strokes.turned(mesh, values)
    np.testing.assert_allclose(turned, (sizes - mesh.points[:, 0]) ** 2, atol=1e-4)
    np.testing.assert_allclose(strokes.turned(mesh, turned), values, atol=1e-4)
    np.testing.assert_array_equal(strokes.leaning(mesh, values), 1)
    np.testing.assert_array_equal(strokes.leaning(mesh, turned), -1)


def test_lines_along_a_border_are_left_out_unless_all_run_along_it():
    border = np.array([[(0, 0.1, 0), (2, 0.1, 0)], [(2, 0.1, 0), (9, 0.1, 0)]])
    kept = strokes.inside(lines(), border, 1.0)
    assert kept.n_lines == len(LENGTHS) - 1
    assert 0.0 not in kept.points[:, 1]
    half = strokes.inside(lines(), border[:1], 1.0)
    assert half.n_lines == len(LENGTHS)
    assert half.points[half.points[:, 1] == 0, 0].min() == pytest.approx(2, abs=0.3)
    assert strokes.inside(lines(), border, 0.2).n_lines == len(LENGTHS)
    assert strokes.inside(lines(), border, 30.0).n_lines == len(LENGTHS)
    assert strokes.inside(lines(), border[:0], 9.0).n_lines == len(LENGTHS)


@pytest.mark.parametrize("arrow", [strokes.FLAT, strokes.TUBE, None])
def test_strokes_are_equally_long_and_thin_where_they_come_from(arrow):
    cut = strokes.cut(lines(), 1.0, "t", arrow)
    # 4, 1 and 2 pieces: 2.5 is rounded to an even number.
    assert cut.n_lines == 7
    assert cut.compute_cell_sizes()["Length"] == pytest.approx([1] * 5 + [1.25] * 2, abs=0.1)
    for line in (cut.get_cell(i) for i in range(7)):
        widths = cut["width"][line.point_ids]
        run = np.abs(line.points[:, 0] - line.points[0, 0])
        if line.points[0, 1] == 1:
            widths, run = widths[::-1], run[-1] - run[::-1]
        if arrow is None:
            assert widths[[0, -1]] == pytest.approx([0.3, 0.3], abs=1e-6)
            assert widths.max() == pytest.approx(1.0, abs=0.05)
            continue
        # A shaft that grows, and a head of one length, which ends as wide as its tip.
        head = run >= run[-1] - arrow.head - 1e-6
        np.testing.assert_allclose(
            widths[head], np.maximum((run[-1] - run[head]) / arrow.head, arrow.tip), atol=2e-5
        )
        assert np.all(np.diff(widths[~head]) > 0)
        shaft = run <= run[-1] - (1 + strokes.BASE) * arrow.head + 1e-6
        assert widths[shaft][[0, -1]] == pytest.approx(arrow[:2], abs=0.01)


def test_short_strokes_have_short_heads_and_new_points_have_the_values_of_their_places():
    mesh = lines()
    mesh["x"], mesh["number"] = mesh.points[:, 0].astype(np.float64), np.arange(mesh.n_points)
    cut = strokes.cut(mesh, 10.0, "t", strokes.FLAT)
    # Two more on each line, unless they are there already.
    assert mesh.n_points + 4 <= cut.n_points <= mesh.n_points + 6
    np.testing.assert_allclose(cut["x"], cut.points[:, 0], atol=1e-6)
    assert cut["number"].dtype == mesh["number"].dtype
    # 0.4 of a line of 1, run through from its other end; 2 of a line of 10 would be more.
    base = cut.points[(cut["width"] == cut["width"].max()) & (cut.points[:, 1] == 1), 0]
    assert base == pytest.approx(0.4, abs=0.03)


def test_points_of_moving_heads_are_near_and_lines_keep_theirs():
    mesh = lines()
    fine = strokes.fine(mesh, 0.1)
    parts = strokes.segments_of(fine)
    assert parts.lengths.max() <= 0.1 * strokes.FLAT.head / strokes.STEPS + 1e-6
    np.testing.assert_allclose(parts.totals(), LENGTHS, rtol=1e-6)
    np.testing.assert_array_equal(strokes.fine(mesh, 10.0).points, mesh.points)


def heads(width):
    """Return the points at which strokes are widest: the bases of their heads."""
    top = (width[1:-1] > width[:-2]) & (width[1:-1] >= width[2:]) & (width[1:-1] > 0.6)
    return 1 + np.flatnonzero(top)


@pytest.mark.parametrize("frame", range(12))
def test_strokes_of_a_uniform_flow_are_found_where_it_carries_them(frame):
    """Each stroke of a frame is in the next, farther by speed times time, to a step of its line."""
    mesh = pv.Line((0, 0, 0), (6, 0, 0), resolution=1200)
    mesh.clear_data()
    strokes.set_moving(mesh, 1.0, np.tile([2.0, 0, 0], (1201, 1)), 3.0)
    assert mesh.field_data["period"][0] == pytest.approx(3 * 1.0 / 2.0)
    moved = 2.0 * mesh.field_data["period"][0] / 12
    here, there = (
        mesh.points[heads(strokes.moved_widths(mesh, step / 12)), 0] for step in (frame, frame + 1)
    )
    inner = here[(here > 1) & (here < 5 - moved)]
    assert len(inner) >= 3
    for place in inner:
        assert np.abs(there - place - moved).min() <= 0.006
    np.testing.assert_allclose(
        strokes.moved_widths(mesh, 1.0), strokes.moved_widths(mesh, 0.0), atol=1e-4
    )


def test_strokes_of_a_solid_rotation_turn_by_its_angle():
    """At any radius: lines that are slower have fewer strokes, and none is slower than its flow."""
    turn = np.linspace(0, 1.9 * np.pi, 4000)
    rings = [pv.MultipleLines(r * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1))
             for r in (0.4, 1.0)]  # fmt: skip
    mesh = rings[0].append_polydata(rings[1])
    strokes.set_moving(mesh, 0.4, np.cross([0, 0, 2.0], mesh.points), 3.0)
    angle = np.tile(turn, 2)
    step = 2.0 * mesh.field_data["period"][0] / 10
    for ring in (slice(0, 4000), slice(4000, 8000)):
        places = []
        for share in (0.3, 0.4):
            width = strokes.moved_widths(mesh, share)[ring]
            places.append(angle[ring][heads(width)])
        inner = places[0][(places[0] > 1) & (places[0] < 1.9 * np.pi - 1.2)]
        assert len(inner)
        for place in inner:
            assert np.abs(places[1] - place - step).min() < 0.004
    # Slow lines have few strokes, in whole numbers.
    assert set(mesh["passing"]) == {1.0, 3.0}


def test_strokes_grow_at_the_start_of_a_line_and_shrink_at_its_end():
    mesh = lines()
    strokes.set_moving(mesh, 0.5, mesh["t"], 2.0)
    widths = np.array([strokes.moved_widths(mesh, share) for share in np.linspace(0, 1, 24)])
    ends = np.isin(np.arange(mesh.n_points) % 41, [0, 40])
    assert widths[:, ends].max() == 0
    assert widths.min() == 0
    assert widths.max() > 0.9
    near = np.minimum(mesh.points[:, 0], 4 - mesh.points[:, 0])[mesh.points[:, 1] == 0]
    # A stroke has grown when half of the distance to the next has passed.
    assert np.all(widths[:, mesh.points[:, 1] == 0] <= np.minimum(near / 0.25, 1) + 1e-5)


def test_where_vectors_are_zero_strokes_stand_still():
    mesh = lines()
    strokes.set_moving(mesh, 0.5, np.zeros((mesh.n_points, 3)), 2.0)
    assert np.all(np.isfinite(mesh["phase"]))
