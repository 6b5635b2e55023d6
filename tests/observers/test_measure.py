"""Figures of pictures whose answer is known beforehand: chance, or no more than of another one."""

import io
import itertools

import numpy as np
import pytest
import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image
from scipy.ndimage import gaussian_filter
from shapes import straws
from sheets import DIRECTION, FLAT, HOW, SHAPE, SIZE, plotter_of, sheet

import vizlight
from vizlight import presets
from vizlight.draw.cameras import camera_on
from vizlight.observers.eye import linear

pytestmark = pytest.mark.opengl


def shot(mesh, **how):
    """Return a picture, from 0 to 1, and its camera."""
    plotter, _ = plotter_of(mesh, show_scalar_bar=False, **how)
    picture, camera = plotter.screenshot(return_img=True) / 255, plotter.camera.copy()
    plotter.close()
    return picture, camera


VALUE = {"scene": FLAT, "scalars": "height", "cmap": "coolwarm"}
#: Question, how a picture is drawn, and how it is read.
QUESTIONS = {
    "direction": (DIRECTION, {"key": presets.direction(), "tangents": "swirl", "exponent": 2}),
    "shape": (SHAPE, {"key": presets.shape()}),
    "value": (VALUE, {"key": ("coolwarm", (-0.2, 0.2)), "scalars": "height"}),
}


def figure(question, mesh, picture, camera, **how):
    how = QUESTIONS[question][1] | {"camera": camera} | HOW | how
    return getattr(vizlight.legibility(mesh, picture=picture, **how), question)


def falls_to_chance(bits, last=0.3, slack=0.1):
    """Return whether bits go down monotonically, but for the noise, to chance."""
    return all(b <= a + slack for a, b in itertools.pairwise(bits)) and bits[-1] < last


@pytest.fixture(
    scope="module",
    params=["value", *(pytest.param(q, marks=pytest.mark.slow) for q in ("direction", "shape"))],
)
def drawn(request):
    mesh = sheet()
    if request.param == "value":
        # The bar of the key is that of the picture.
        return request.param, mesh, *shot(mesh, clim=(-0.2, 0.2), **VALUE)
    return request.param, mesh, *shot(mesh, **QUESTIONS[request.param][0])


def test_less_contrast_is_read_worse_until_chance(drawn):
    question, mesh, picture, camera = drawn
    gray = 0.6
    bits = [
        figure(question, mesh, gray + c * (picture - gray), camera).bits for c in (1, 0.3, 0.1, 0)
    ]
    assert bits[0] > 1
    assert falls_to_chance(bits)


def test_more_blur_is_read_worse_until_chance(drawn):
    question, mesh, picture, camera = drawn
    blurred = [gaussian_filter(picture, (s, s, 0)) if s else picture for s in (0, 12, 48, 400)]
    bits = [figure(question, mesh, np.clip(p, 0, 1), camera).bits for p in blurred]
    assert falls_to_chance(bits)


def test_a_jpeg_is_read_worse_the_more_it_loses(drawn):
    question, mesh, picture, camera = drawn
    bits = []
    for quality in (95, 20, 1):
        file = io.BytesIO()
        Image.fromarray((picture * 255).round().astype(np.uint8)).save(
            file, "JPEG", quality=quality
        )
        bits.append(figure(question, mesh, np.asarray(Image.open(file)), camera).bits)
    whole = figure(question, mesh, picture, camera).bits
    assert falls_to_chance([whole, *bits], last=0.9 * whole)
    assert bits[0] > 0.9 * whole


def test_a_picture_of_another_mesh_is_chance(drawn):
    question, mesh, picture, camera = drawn
    mixed = picture.reshape(-1, 3).copy()
    shown = (mixed < 0.99).any(axis=1)
    # The same colours at other places.
    blocks = np.flatnonzero(shown)
    mixed[blocks] = mixed[np.roll(blocks[::-1], len(blocks) // 3)]
    found = figure(question, mesh, mixed.reshape(picture.shape), camera)
    assert found.bits < 0.3
    assert found.unreadable
    assert found.readable == 0


def test_a_picture_without_hue_tells_no_direction(drawn):
    question, mesh, picture, camera = drawn
    gray = np.repeat(picture.mean(axis=2, keepdims=True), 3, axis=2)
    whole, found = (figure(question, mesh, p, camera) for p in (picture, gray))
    assert found.bits < 0.6 * whole.bits
    if question == "direction":
        assert found.unreadable
        assert found.median == 45


@pytest.mark.parametrize("name", ["hue", "lightness"])
def test_maps_of_equal_lightness_are_read_in_colors_only(name):
    """Of two maps one has hue and the other lightness alone; without hue one is chance."""
    mesh = sheet()
    ends = {"hue": [(0.75, 0.42, 0.42), (0.25, 0.58, 0.55)], "lightness": ["black", "lightgray"]}
    cmap = LinearSegmentedColormap.from_list(name, ends[name])
    how = {"cmap": cmap, "clim": (-0.2, 0.2), "scalars": "height"}
    picture, camera = shot(mesh, scene=FLAT, **how)
    light = np.array([0.2126, 0.7152, 0.0722])
    gray = np.repeat(((picture**2.2) @ light)[..., np.newaxis] ** (1 / 2.2), 3, axis=2)
    key = {"key": (cmap, (-0.2, 0.2))}
    whole, bare = (figure("value", mesh, p, camera, **key) for p in (picture, gray))
    assert whole.bits > 1
    assert bare.unreadable == (name == "hue")
    assert bare.readable < 0.05 or name == "lightness"


def test_a_map_read_by_the_key_of_another_is_chance():
    mesh = sheet()
    picture, camera = shot(mesh, scene=FLAT, scalars="height", cmap="gray", clim=(-0.2, 0.2))
    backward = {"key": ("gray_r", (-0.2, 0.2))}
    found = figure("value", mesh, picture, camera, **backward)
    assert found.unreadable
    assert (found.median, found.largest) == (0.25, 0.5)


def test_narrower_lines_are_read_worse_until_chance():
    mesh = straws(40, 8)
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "black"
    plotter.vizlight.add_mesh(mesh, scene=presets.heading(), line_width=4, halo=False)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    bits = []
    for width in (4, 2, 1, 0.5, 0.25):
        # A picture of a quarter of the size has lines of a quarter of the width.
        bits.append(plotter.vizlight.legibility(samples=768, size_mm=30 * width / 4).heading.bits)
    picture = linear(plotter.screenshot(return_img=True) / 255)
    how = {"camera": plotter.camera.copy(), "line_width": 4, "key": presets.heading()} | HOW
    plotter.close()
    assert bits[0] > 1
    assert falls_to_chance(bits)
    # Lines that are all darker than the key by one factor are read like the others.
    dark = (0.5 * picture) ** (1 / 2.2)
    assert vizlight.legibility(mesh, picture=dark, **how).heading.bits > 0.8 * bits[0]


@pytest.mark.parametrize("question", [pytest.param("shape", marks=pytest.mark.slow), "speed"])
def test_thin_lines_on_a_surface_leave_it_readable(question):
    mesh = sheet()
    how = SHAPE
    if question == "speed":
        how = {"scene": FLAT, "tangents": "swirl", "scalars": "speed", "cmap": "viridis"}
    plotter, _ = plotter_of(mesh, show_scalar_bar=False, **how)
    bare = getattr(plotter.vizlight.legibility(**HOW), question)
    lines = vizlight.streamlines(mesh, tangents="swirl", spacing=0.12)
    lines.points[:, 2] += 0.02
    plotter.vizlight.add_mesh(lines, color="black", line_width=1, halo=False)
    found = getattr(plotter.vizlight.legibility(**HOW), question)
    plotter.close()
    assert found.bits > 0.85 * bare.bits
    assert found.readable > 0.85 * bare.readable
