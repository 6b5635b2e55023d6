"""Words of scalar bars in the picture; a key in the corner: its colours and its place."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import View, presets
from vizlight.draw import render

pytestmark = pytest.mark.opengl
SIZE = (400, 300)
NAME = "a rather long name of a field [kg m-2 s-1]"


def inked(size, values, name=NAME, columns=1, **asked):
    """Return which pixels of a picture a scalar bar covers, and the bar."""
    ball = pv.Sphere()
    ball[name] = values(ball.points[:, 2])
    plotter = pv.Plotter(off_screen=True, window_size=size, shape=(1, columns), border=False)
    actor = plotter.vizlight.add_mesh(ball, scalars=name, scalar_bar_args=asked or None)
    plotter.render()
    actor.SetVisibility(False)
    picture = plotter.screenshot(return_img=True)
    bar = plotter.scalar_bars[name]
    return np.any(picture < 200, axis=2), bar


def groups(rows):
    """Return the number of runs of rows with ink."""
    return int(np.count_nonzero(np.diff(np.concatenate([[0], rows])) == 1))


def holed(heights):
    return np.where(heights > 0.3, np.nan, heights)


def far(heights):
    return 8e5 + 1000 * heights


@pytest.mark.parametrize("values", [holed, far, lambda heights: -1e-7 * (heights + 1)])
@pytest.mark.parametrize("size", [(900, 600), (400, 300)])
@pytest.mark.parametrize("vertical", [False, True])
def test_no_word_of_a_bar_leaves_the_picture(values, size, vertical):
    ink, _ = inked(size, values, vertical=vertical)
    assert ink.any()
    assert not np.any(ink[:, [0, -1]])
    assert not np.any(ink[[0, -1]])


@pytest.mark.parametrize("size", [(900, 600), (400, 300), (1024, 768)])
def test_title_numbers_and_bar_stand_apart(size):
    ink, _ = inked(size, far)
    assert groups(ink.any(axis=1)) == 3
    numbers = ink.any(axis=1).nonzero()[0]
    first = numbers[np.flatnonzero(np.diff(numbers) > 1)[0] + 1]
    assert groups(ink[first : first + 6].any(axis=0)) >= 3


def test_bars_stand_above_one_another():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    for name in (NAME, f"another {NAME}"):
        ball = pv.Sphere()
        ball[name] = ball.points[:, 2]
        plotter.vizlight.add_mesh(ball, scalars=name)
    low, high = (bar.GetPosition()[1] for bar in plotter.scalar_bars.values())
    assert high >= low + plotter.scalar_bars[NAME].GetHeight()


def test_a_bar_fits_its_subplot():
    ink, _ = inked((800, 300), holed, columns=2)
    assert not ink[:, 399:].any()


def test_numbers_of_a_narrow_range_differ():
    _, bar = inked((900, 600), far, "t")
    assert bar.GetLabelFormat() == "%-#6.4g"


def test_what_is_asked_for_stays():
    asked = {"position_x": 0.1, "width": 0.3, "n_labels": 2, "fmt": "%.1f"}
    _, bar = inked((400, 300), far, **asked)
    assert (bar.GetPosition()[0], bar.GetWidth(), bar.GetNumberOfLabels()) == (0.1, 0.3, 2)
    assert (bar.GetLabelFormat(), bar.GetTitle()) == ("%.1f", NAME)


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
