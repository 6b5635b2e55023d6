"""Evenly spaced curves: no gaps, no crowds, everywhere, closed where they are."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from scipy.spatial import cKDTree
from vectors import parts, waves

from vizlight import Light, Scene, View, streamlines

SCENE = Scene(lights=Light(direction=(1, -1, 0.8)), view=View(direction=(0.2, -1, 0.3)))


def ball(n=40, **options):
    mesh = pv.Sphere(radius=1.0, theta_resolution=n, phi_resolution=n, **options)
    mesh["orbits"] = np.cross([0.2, 0.3, 1.0], mesh.points)
    up = np.array([0, 0, 1.0])
    normals = np.asarray(mesh["Normals"], float)
    mesh["spiral"] = up - normals[:, 2:] * normals + np.cross(up, normals)
    return mesh


def evenness(lines, places):
    """Return the largest distance of places from a line, and the distances between lines.

    By brute force, from points of the lines that are close to each other.
    """
    pieces = parts(lines)
    step = max(np.linalg.norm(np.diff(piece, axis=0), axis=1).max() for piece in pieces)
    gap = cKDTree(np.concatenate(pieces)).query(places)[0].max()
    near = []
    for i, piece in enumerate(pieces):
        others = [other for j, other in enumerate(pieces) if j != i]
        if others:
            near.append(cKDTree(np.concatenate(others)).query(piece)[0])
    return gap, np.concatenate(near), step


@pytest.mark.parametrize("name", ["orbits", "spiral"])
def test_on_a_sphere(name):
    spacing = 0.15
    mesh = ball()
    lines = streamlines(mesh, SCENE, tangents=name, spacing=spacing)
    gap, near, step = evenness(lines, mesh.points)
    assert step <= spacing / 4 * 1.01
    assert gap <= 1.3 * spacing
    assert np.percentile(near, 5) >= 0.5 * spacing
    assert lines.field_data["largest_gap"][0] == pytest.approx(gap / spacing, abs=0.25)
    assert lines.field_data["nearest"][0] == pytest.approx(
        np.percentile(near, 5) / spacing, abs=0.1
    )
    lengths = [np.linalg.norm(np.diff(piece, axis=0), axis=1).sum() for piece in parts(lines)]
    assert min(lengths) > 0.5 * spacing


def test_orbits_are_closed():
    lines = streamlines(ball(), SCENE, tangents="orbits", spacing=0.15)
    pieces = parts(lines)
    closed = [np.array_equal(piece[0], piece[-1]) for piece in pieces]
    assert lines.field_data["closed"][0] == sum(closed)
    assert sum(closed) == len(pieces)
    axis = np.array([0.2, 0.3, 1.0]) / np.linalg.norm([0.2, 0.3, 1.0])
    for piece in pieces:
        # Once around, and not twice.
        height = piece @ axis
        assert np.ptp(height) < 0.02
        around = 2 * np.pi * np.linalg.norm(piece - height[:, np.newaxis] * axis, axis=1).mean()
        around *= np.sinc(1 / (len(piece) - 1))  # a polygon in the circle
        length = np.linalg.norm(np.diff(piece, axis=0), axis=1).sum()
        assert length == pytest.approx(around, rel=0.05)


def test_the_last_gaps_are_filled():
    """Where lines that others or the boundary cut short would leave gaps of 1.5 spacings."""
    grid, spacing = pv.ImageData(dimensions=(12, 12, 12), spacing=(0.1, 0.1, 0.1)), 0.15
    grid["V"] = waves(np.asarray(grid.points), 6, 0)
    lines = streamlines(grid, SCENE, tangents="V", spacing=spacing)
    gap, near, _ = evenness(lines, 1.1 * np.random.default_rng(2).random((60_000, 3)))
    assert gap <= 1.3 * spacing
    assert np.percentile(near, 5) >= 0.5 * spacing
    assert lines.field_data["largest_gap"][0] == pytest.approx(gap / spacing, abs=0.1)
    assert "Normals" not in lines.point_data


def test_a_spiral_is_not_closed():
    lines = streamlines(ball(), SCENE, tangents="spiral", spacing=0.15)
    assert not any(np.array_equal(piece[0], piece[-1]) for piece in parts(lines))


@pytest.mark.sampled(3)
@pytest.mark.parametrize("missing", [0, np.nan])
@pytest.mark.parametrize("line_field", [False, True])
@pytest.mark.filterwarnings("ignore:.*could not be lit:UserWarning")
def test_where_there_is_no_field_there_are_no_lines(missing, line_field):
    mesh = ball()
    mesh["orbits"][mesh.points[:, 0] > 0.3] = missing
    lines = streamlines(mesh, SCENE, tangents="orbits", spacing=0.2, line_field=line_field)
    assert lines.n_cells > 3
    assert lines.points[:, 0].max() < 0.45
    mesh["orbits"][:] = 0
    with pytest.raises(ValueError, match="where the vectors are not zero"):
        streamlines(mesh, SCENE, tangents="orbits", spacing=0.2, line_field=line_field)


def test_parts_of_a_surface_have_lines_of_their_own():
    small = ball(20).scale(0.03).translate((1.6, 0, 0))
    mesh = ball(30).append_polydata(small, ball(20).scale(0.5).translate((2.9, 0, 0)))
    lines = streamlines(mesh, SCENE, tangents="orbits", spacing=0.25)
    x = np.asarray(lines.points)[:, 0]
    assert np.any(np.abs(x - 1.6) < 0.05)
    assert np.any(np.abs(x - 2.9) < 0.5)


@pytest.mark.filterwarnings("ignore:.* of the edges are sharper")
def test_two_sides_of_a_sheet_are_apart():
    """Sides a third of a spacing from each other do not take the place of the other's lines."""
    sheet = pv.Box((0, 1, 0, 1, 0, 0.03), level=15).triangulate().clean()
    sheet["V"] = np.tile([1.0, 0.2, 0], (sheet.n_points, 1))
    lines = streamlines(sheet, SCENE, tangents="V", spacing=0.1)
    z = np.asarray(lines.points)[:, 2]
    top, bottom = np.sum(z > 0.029), np.sum(z < 0.001)
    assert 0.6 < top / bottom < 1.7
    places = np.random.default_rng(0).uniform((0.1, 0.1, 0.03), (0.9, 0.9, 0.03), (400, 3))
    gap = cKDTree(np.asarray(lines.points)[z > 0.029]).query(places)[0].max()
    assert gap < 0.13


def test_seeds_come_first_and_lines_keep_their_distance():
    mesh = ball(30)
    seeds = np.array([[0, 1.0, 0], [1.0, 0, 0]])
    lines = streamlines(mesh, SCENE, tangents="spiral", spacing=0.2, seeds=seeds)
    _, near, _ = evenness(lines, seeds)
    assert np.percentile(near, 5) > 0.45 * 0.2
    assert cKDTree(lines.points).query(seeds)[0].max() < 0.03
    again = streamlines(mesh, SCENE, tangents="spiral", spacing=0.2, seeds=seeds)
    np.testing.assert_array_equal(lines.points, again.points)


def test_far_from_the_origin_and_of_any_size():
    expected = streamlines(ball(20), SCENE, tangents="spiral", spacing=0.3)
    mesh = ball(20)
    mesh.points = 1e6 * (np.asarray(mesh.points, float) + np.array([40.0, 500.0, 1.0]))
    found = streamlines(mesh, SCENE, tangents="spiral", spacing=0.3e6)
    assert abs(found.n_lines - expected.n_lines) <= 3
    assert found.field_data["largest_gap"][0] < 1.3
    assert found.points.dtype == np.float64


test_bad_input = refusals(
    lambda options: streamlines(ball(12), SCENE, tangents="spiral", **options),
    ({"spacing": 0}, "spacing: expected a number above 0"),
    ({"spacing": "wide"}, "spacing: expected a number", TypeError),
    ({"spacing": 1e-5}, "spacing: expected a number from 0.00.* for a mesh of this"),
    ({"line_field": "yes"}, "line_field: expected True or False", TypeError),
)
