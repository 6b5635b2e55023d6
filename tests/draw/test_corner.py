"""A key in the corner: its colours in the picture, and where it stands."""

import numpy as np
import pytest
import pyvista as pv
from lamps import HEADLIT

import vizlight
from vizlight import Scene, View, presets
from vizlight.draw import render

SIZE = (400, 300)
pytestmark = pytest.mark.opengl


def picture(**options):
    """Return a picture with a plane that covers the left side, and the key's colours."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "black"
    plotter.enable_parallel_projection()
    field = pv.Plane(i_size=2, j_size=2)
    scene = presets.shape()
    plotter.vizlight.add_mesh(field, scene=scene)
    plotter.view_xy()
    plotter.camera.parallel_scale = 1.6
    plotter.camera.position, plotter.camera.focal_point = (0.8, 0.9, 5), (0.8, 0.9, 0)
    made = plotter.vizlight.add_key(size=0.3, **options)
    seen = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    return seen, made


def corner_of(seen, right, upper):
    half = seen[: SIZE[1] // 2] if upper else seen[SIZE[1] // 2 :]
    return half[:, SIZE[0] // 2 :] if right else half[:, : SIZE[0] // 2]


def test_the_key_is_in_the_freest_corner_in_the_colours_of_its_mesh():
    seen, made = picture()
    there = corner_of(seen, right=True, upper=False)
    # The middle of the ball, which has one colour, the lightest.
    whole = there.reshape(-1, 3).astype(int)
    lightest = made["rgb"][np.argmin(np.hypot(*made.points[:, :2].T))].astype(int)
    assert (np.abs(whole - lightest).max(axis=1) <= 3).any()
    # Words and a ball of 45 pixels in radius.
    assert 0.9 * np.pi * 45**2 < (whole.max(axis=1) > 10).sum() < 1.6 * np.pi * 45**2


def test_a_corner_that_is_named():
    seen, _ = picture(corner="upper left")
    assert corner_of(seen, right=False, upper=True).max() > 100
    with pytest.raises(ValueError, match="corner: expected 'auto'"):
        picture(corner="middle")


def test_the_key_of_the_live_light_has_its_exponent():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    line = pv.Line(resolution=4)
    with pytest.raises(ValueError, match="scene: expected a scene, or a mesh with live light"):
        plotter.vizlight.add_key()
    plotter.vizlight.add_mesh(line, scene=presets.direction(), exponent=2)
    made = plotter.vizlight.add_key()
    plotter.close()
    expected = presets.key(presets.direction(View(direction=(1, 1, 1))), exponent=2)
    np.testing.assert_array_equal(made["rgb"], expected["rgb"])
    assert (made["rgb"] != presets.key(presets.direction())["rgb"]).any()


@pytest.mark.parametrize("valued", [True, False])
def test_the_default_light_has_the_key_of_what_it_shows(valued):
    ball = pv.Sphere()
    ball["speed"] = np.linspace(2, 5, ball.n_points)
    ball["speed"][7] = np.nan
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    given = {"scalars": "speed", "cmap": "viridis"} if valued else {"color": "white"}
    plotter.vizlight.add_mesh(ball, show_scalar_bar=False, **given)
    made = plotter.vizlight.add_key()
    plotter.close()
    words = ["2", "speed (grey: no data)", "5"] if valued else ["a ball in this light"]
    assert list(made.field_data["words"]) == words
    if valued:
        expected = presets.key(vizlight.Scene(), cmap="viridis", clim=(2, 5))
        np.testing.assert_array_equal(made["rgb"], expected["rgb"])


def test_pictures_have_keys():
    ball = vizlight.illuminate(pv.Sphere(), presets.shape())
    key = presets.key(presets.shape())
    options = {"size": SIZE, "scalars": "rgb", "background": "black"}
    plain, keyed = (next(iter(render.pictures([ball], key=one, **options))) for one in (None, key))
    changed = np.abs(plain.astype(int) - keyed).max(axis=2) > 10
    rows, columns = np.nonzero(changed)
    assert changed.sum() > 0.9 * np.pi * 30**2
    # All of it in one corner.
    assert np.ptp(rows) < 100
    assert np.ptp(columns) < 140


def test_a_bar_has_a_word_at_each_end():
    bar = presets.key(presets.value(), clim=(2, 70))
    assert list(bar.field_data["words"]) == ["2", "70"]
    assert list(presets.key(Scene(**HEADLIT)).field_data["words"]) == ["a ball in this light"]
