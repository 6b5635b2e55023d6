"""Globes: places, winds, seams, poles, lines, and maps that are none."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight.mesh.coasts import coasts
from vizlight.mesh.georeference import in_degrees
from vizlight.mesh.globes import centred, globe, is_globe, middle_of


def earth(west=-180.0, columns=73, south=-90.0, rows=37, kind="image"):
    """Return a map every 5 degrees with a smooth array and a wind that turns with the earth."""
    grid = pv.ImageData(dimensions=(columns, rows, 1), spacing=(5, 5, 1), origin=(west, south, 0))
    x, y, _ = np.radians(np.asarray(grid.points, dtype=float)).T
    grid["warmth"] = np.sin(y) + 0.3 * np.cos(x) * np.cos(y)
    grid["u"], grid["v"] = 7 * np.cos(y), 0 * y
    if kind == "rectilinear":
        grid = grid.cast_to_rectilinear_grid()
    return in_degrees(grid)


def places(ball):
    points = np.asarray(ball.points, dtype=float)
    return points, np.arctan2(points[:, 1], points[:, 0]), np.arcsin(np.clip(points[:, 2], -1, 1))


@pytest.mark.parametrize(
    "grid",
    [
        earth(),
        earth(west=0.0),
        earth(kind="rectilinear"),
        earth(columns=72),
        earth(south=-87.5, rows=36),
        earth(west=2.5, columns=72, south=-87.5, rows=36),
    ],
    ids=["closed", "from 0", "rectilinear", "seam", "poles", "both"],
)
def test_a_ball_is_closed_and_has_the_values_of_its_map(grid):
    ball = globe(grid)
    points, east, north = places(ball)
    assert np.linalg.norm(points, axis=1) == pytest.approx(1, abs=1e-6)
    assert ball.n_open_edges == 0
    assert len(np.unique(points.round(5), axis=0)) == ball.n_points
    # Genus 0: a sphere and nothing else.
    edges = ball.extract_all_edges().n_cells
    assert ball.n_points - edges + ball.n_cells == 2
    expected = np.sin(north) + 0.3 * np.cos(east) * np.cos(north)
    assert np.asarray(ball["warmth"]) == pytest.approx(expected, abs=0.01)
    assert is_globe(ball)
    assert not is_globe(grid)


@pytest.mark.parametrize(
    ("grid", "middle"),
    [
        (earth(), 0.0),
        (earth(west=0.0, columns=72), 0.0),
        (earth(west=2.5, columns=72, south=-87.5, rows=36), 2.5),
        (earth(columns=60), None),
        (earth(south=-50.0, rows=20), None),
    ],
    ids=["closed", "from 0", "between", "no turn", "no pole"],
)
def test_the_middle_of_a_map_around_the_earth(grid, middle):
    assert middle_of(grid) == middle
    turned = centred(grid, 90.0)
    if middle is None:
        assert turned.n_points == grid.n_points
        return
    lon = np.asarray(turned.points, dtype=float)[: turned.dimensions[0], 0]
    assert lon[-1] - lon[0] == pytest.approx(360)
    assert np.all(np.diff(lon) > 0)
    assert abs(lon.mean() - 90) <= 2.5


def test_winds_are_tangent_and_turn_about_the_axis():
    ball = globe(earth())
    wind, points = np.asarray(ball["u,v"], dtype=float), np.asarray(ball.points, dtype=float)
    assert np.abs(np.sum(wind * points, axis=1)).max() < 1e-5
    assert wind == pytest.approx(7 * np.cross((0, 0, 1), points), abs=1e-4)


def test_heights_raise_the_ball():
    flat = earth()
    flat["ground"] = 1e4 * np.sin(np.radians(np.asarray(flat.points)[:, 1]))
    ball = globe(flat, heights="ground", exaggeration=20)
    size = np.linalg.norm(np.asarray(ball.points, dtype=float), axis=1)
    assert size == pytest.approx(1 + 20 * np.asarray(ball["ground"]) / 6_371_008.8, abs=1e-6)
    with pytest.raises(ValueError, match=r"heights: expected a point array .*, got 'u,v'"):
        globe(flat, heights="u,v")


def test_lines_follow_the_ball():
    shore = globe(coasts((-180.0, 180.0, -90.0, 90.0)))
    points = np.asarray(shore.points, dtype=float)
    assert np.linalg.norm(points, axis=1) == pytest.approx(1, abs=1e-6)
    longest = max(
        np.linalg.norm(np.diff(np.asarray(cell.points), axis=0), axis=1).max()
        for cell in shore.cell
    )
    assert longest < np.radians(1.5)
    horn = np.radians((-67.3, -55.5))
    cape = (np.cos(horn[1]) * np.cos(horn[0]), np.cos(horn[1]) * np.sin(horn[0]), np.sin(horn[1]))
    assert np.linalg.norm(points - cape, axis=1).min() < np.radians(0.7)


test_what_is_no_map = refusals(
    globe,
    (3, "mesh: expected a mesh", TypeError),
    (pv.Plane(), "mesh: expected a map in degrees"),
    (in_degrees(pv.ImageData(dimensions=(5, 5, 3))), "a flat map"),
)


def test_balls_of_geovista_are_globes_and_others_are_not():
    ball = pv.Sphere(radius=1.0)
    assert not is_globe(ball)
    ball.field_data["gvCRS"] = ["EPSG:4326"]
    assert is_globe(ball)
    assert not is_globe(ball.scale(2.0))
