"""Strokes whose ends differ tell which way they run, others do not."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.draw.cameras import camera_on
from vizlight.observers.lines import two_sides

pytestmark = pytest.mark.opengl

SIZE = (300, 200)


def strokes(count=24, times=True):
    """Return short strokes of ten points in all directions of a plane, with the time along them."""
    random = np.random.default_rng(0)
    middle = np.stack(np.meshgrid(np.arange(6), np.arange(4)), axis=-1).reshape(-1, 2)[:count]
    turn = random.uniform(0, 2 * np.pi, count)
    way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    share = np.linspace(-0.3, 0.3, 10)
    flat = middle[:, np.newaxis] + share[:, np.newaxis] * way[:, np.newaxis]
    points = np.insert(flat.reshape(-1, 2), 2, 0.0, axis=1)
    cells = np.insert(np.arange(10 * count).reshape(-1, 10), 0, 10, axis=1)
    mesh = pv.PolyData(points, lines=cells.ravel())
    mesh["along"] = np.tile(np.linspace(0, 1, 10), count)
    if times:
        mesh["IntegrationTime"] = mesh["along"]
    return mesh


def drawn(mesh, radius, color):
    """Return a picture of strokes as tubes of a radius and a gray along them, and its camera."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "white"
    shown = mesh.copy()
    shown["r"], shown["c"] = radius(mesh["along"]), color(mesh["along"])
    tubes = shown.tube(scalars="r", absolute=True)
    plotter.add_mesh(
        tubes, scalars="c", cmap="gray", clim=(0, 1), lighting=False, show_scalar_bar=False
    )
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5, parallel=True)
    picture, camera = plotter.screenshot(return_img=True), plotter.camera.copy()
    plotter.close()
    return picture, camera


def sense(mesh, picture, camera):
    how = {"key": [], "line_width": 3, "samples": 64, "size_mm": 30}
    return vizlight.legibility(mesh, picture=picture, camera=camera, **how).sense


def black(along):
    return 0 * along


def even(along):
    return 0.03 + 0 * along


def taper(along):
    return 0.005 + 0.06 * along


def heads(along):
    return np.where(along > 0.7, 0.2 * (1.05 - along), 0.01)


@pytest.mark.parametrize(
    ("radius", "color"),
    [(taper, black), (lambda t: taper(1 - t), black), (heads, black), (even, lambda t: 0.9 * t)],
    ids=["taper", "thin end ahead", "heads", "lightness"],
)
def test_strokes_whose_ends_differ_tell_their_sense(radius, color):
    found = sense(strokes(), *drawn(strokes(), radius, color))
    assert found.told > 0.9
    assert found.wrongly == 0
    assert found.bits > 0.8
    assert found.samples == 24


def test_plain_strokes_tell_no_sense():
    found = sense(strokes(), *drawn(strokes(), even, black))
    assert found.unreadable
    assert found.told < 0.2
    assert found.readable == 0
    assert "tapered" in found.reason


def test_tapers_of_which_half_run_against_the_data_tell_no_sense():
    mesh = strokes()
    picture = drawn(mesh, taper, black)
    mesh["IntegrationTime"][120:] *= -1
    found = sense(mesh, *picture)
    assert found.bits < 0.05
    assert found.told == pytest.approx(0.5, abs=0.05)
    assert "wrongly" in found.reason


def test_lines_without_a_sense_and_few_strokes_are_not_asked():
    mesh = strokes(times=False)
    picture = drawn(mesh, taper, black)
    assert sense(mesh, *picture) is None
    few = strokes(7)
    assert sense(few, *drawn(few, taper, black)) is None


def test_vectors_of_lines_tell_the_sense():
    mesh = strokes(times=False)
    points = np.asarray(mesh.points).reshape(-1, 10, 3)
    mesh["V"] = -np.repeat(points[:, -1] - points[:, 0], 10, axis=0)
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "white"
    plotter.vizlight.add_mesh(
        mesh, tangents="V", scalars="along", cmap="gray", clim=(0, 1.1), line_width=6, halo=False
    )
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    found = plotter.vizlight.legibility(samples=64).sense
    plotter.close()
    assert found.told > 0.9


@pytest.mark.parametrize(
    ("told", "wrongly", "total", "bits"),
    [(1000, 0, 1000, 1), (500, 0, 1000, 0.5), (500, 500, 1000, 0), (100, 900, 1000, 0),
     (900, 100, 1000, 0.531), (1, 0, 1, 0.279), (0, 0, 10, 0)],
)  # fmt: skip
def test_the_bits_of_two_sides_are_those_of_the_channel(told, wrongly, total, bits):
    assert two_sides(told, wrongly, total) == pytest.approx(bits, abs=2e-3)
