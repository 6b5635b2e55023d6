"""Strokes whose ends differ tell which way they run, others do not."""

from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv
from sheets import arrows, counts, drawn_plain, rings, seen_as, sheet

import vizlight
from vizlight.draw.cameras import camera_on
from vizlight.observers import lines as marks
from vizlight.observers.eye import Eye
from vizlight.observers.lines import (
    JUMP,
    Glyphs,
    Segments,
    above_ground,
    ahead_of,
    along_grain,
    grain_of,
    lengths_of,
    segments_of,
    strokes_of,
    two_sides,
)
from vizlight.observers.pixels import visible
from vizlight.observers.samples import part_on
from vizlight.scene import Light, Scene, View
from vizlight.shading.options import LightOptions

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


@pytest.mark.sampled(2)
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
    assert found.told == found.wrongly == 0.5
    assert counts(found)[0] < 0.2 * found.samples
    assert found.readable == 0
    assert "tapered" in found.reason


def test_tapers_of_which_half_run_against_the_data_tell_no_sense():
    mesh = strokes()
    picture = drawn(mesh, taper, black)
    mesh["IntegrationTime"][120:] *= -1
    found = sense(mesh, *picture)
    assert found.bits < 0.05
    assert counts(found)[0] == pytest.approx(found.samples / 2, abs=1)
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
    assert found.told > 0.9


@pytest.mark.parametrize("against", [0, 120, 240])
def test_widths_tell_the_sense_unless_half_of_them_run_against_it(against):
    """Black heads on waves of light: of 24 strokes some have their heads behind."""
    mesh = strokes(times=False)
    points = np.asarray(mesh.points).reshape(-1, 10, 3)
    mesh["V"] = np.repeat(points[:, -1] - points[:, 0], 10, axis=0)
    mesh["V"][:against] *= -1
    mesh["width"] = np.where(mesh["along"] > 0.6, 2.4 * (1.01 - mesh["along"]), 0.2)
    ground = pv.Plane(center=(*mesh.center[:2], -0.1), i_size=8, j_size=8, i_resolution=40)
    ground["light"] = 0.7 + 0.25 * np.sin(3 * ground.points[:, 0])
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.add_mesh(
        ground, scalars="light", cmap="gray", clim=(0, 1), lighting=False, show_scalar_bar=False
    )
    plotter.vizlight.add_mesh(
        mesh, tangents="V", color="black", width="width", line_width=12, halo=False
    )
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    found = plotter.vizlight.legibility(samples=64, size_mm=30).sense
    assert found.unreadable == (against == 120)
    assert found.unreadable or (found.told > 0.95 and found.wrongly == 0)


@pytest.mark.parametrize(
    ("told", "wrongly", "total", "bits"),
    [(1000, 0, 1000, 1), (500, 0, 1000, 0.5), (500, 500, 1000, 0), (100, 900, 1000, 0),
     (900, 100, 1000, 0.531), (1, 0, 1, 0.279), (0, 0, 10, 0)],
)  # fmt: skip
def test_the_bits_of_two_sides_are_those_of_the_channel(told, wrongly, total, bits):
    assert two_sides(told, wrongly, total) == pytest.approx(bits, abs=2e-3)


@pytest.mark.parametrize("block", [1, 2, 1 << 16])
def test_segments_are_in_pixels_and_each_line_is_far_from_the_others(block, monkeypatch):
    monkeypatch.setattr(marks, "BLOCK", block)
    points = [[-0.5, 0, 0], [0, 0, 0], [0.5, 0, 0], [0, -0.5, 1], [0, 0.5, 1]]
    mesh = pv.PolyData(np.array(points, float), lines=[3, 0, 1, 2, 2, 3, 4])
    mesh["IntegrationTime"] = np.array([0, 1, 2, 5, 4.0])
    scene = Scene(lights=Light.headlight(), view=View(direction=(0, 0, 1)))
    ground = part_on(pv.Plane(center=(0.8, 0.8, 0), i_size=0.1), scene, LightOptions())
    part = part_on(mesh, scene, LightOptions(), width=4.0)
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, 5), (0, 0, 0), (0, 1, 0)
    camera.parallel_projection, camera.parallel_scale = True, 1.0
    pixels = visible([ground.drawn, part.drawn], camera, (120, 80))
    found = segments_of([ground, part], pixels, camera)
    np.testing.assert_allclose(found.start, [[40, 40], [60, 40], [60, 60]], atol=1e-4)
    np.testing.assert_allclose(found.way, [[20, 0], [20, 0], [0, -40]], atol=1e-4)
    np.testing.assert_allclose(found.along, [0, 20, 40 + JUMP], atol=1e-3)
    np.testing.assert_array_equal(found.line, [0, 0, 1])
    np.testing.assert_array_equal(found.width, 4)
    np.testing.assert_array_equal(found.ahead, [1, 1, -1])
    assert (found.number[40, 45], found.number[40, 75], found.number[30, 60]) == (0, 1, 2)
    assert found.number[5, 5] == -1
    assert segments_of([ground], pixels, camera) is None
    # Two meshes of lines, of which one segment is seen: the others are still known along the lines.
    some = pixels[pixels.cell == 1]
    few = segments_of([ground, part, part], replace(some, part=some.part + 1), camera)
    np.testing.assert_allclose(few.start, [[60, 40]], atol=1e-4)
    np.testing.assert_allclose(few.along, [100 + 2 * JUMP], atol=1e-3)
    assert (few.line, few.number.max(), few.number[40, 75]) == ([2], 0, 0)
    second = (pixels.part == 1) & (pixels.cell == 1)
    both = replace(pixels, part=np.where(second, 2, pixels.part))
    numbers = segments_of([ground, part, part], both, camera).number
    assert (numbers[40, 45], numbers[40, 75], numbers[30, 60]) == (0, 2, 1)
    ways = few.ways_at(np.array([-5, 19, 21, 50 + JUMP, 90 + 2 * JUMP, np.inf, np.nan]))
    right, up = [20, 0], [0, -40]
    np.testing.assert_allclose(ways, [right, right, right, up, right, up, up], atol=1e-4)


@pytest.mark.parametrize("ahead", [1, -1])
def test_the_end_ahead_of_a_stroke_is_lighter_by_its_last_third(ahead):
    """A stroke of 90 pixels, 3 wide: lightness rises by 30 along it, on ground of 80."""
    number = np.full((40, 120), -1)
    number[19:22, 15:105] = 0
    colors = np.zeros((40, 120, 3))
    colors[..., 0] = 80.0
    colors[..., 1:] = 3.0
    share = (np.arange(90) + 0.5) / 90
    colors[19:22, 15:105, 0] = 20 + 30 * share
    lines = Segments(
        number, np.array([[15.0, 20.5]]), np.array([[90.0, 0]]), np.zeros(1),
        np.zeros(1, dtype=int), np.full(1, 3.0), np.array([float(ahead)]),
    )  # fmt: skip
    seen = seen_as(colors)
    # A window of a pixel: 8 arc minutes.
    found = strokes_of(lines, lines.shown, seen, Eye(7.5))
    assert (found.form, found.pixels) == ([0], [270])
    # Middles of the two outer thirds are two thirds of the stroke apart.
    np.testing.assert_allclose(found.light, [20 * ahead], atol=0.01)
    short = lines._replace(number=np.full_like(number, -1))
    short.number[20, 15:17] = 0
    assert len(strokes_of(short, short.shown, seen, Eye(7.5)).light) == 0
    none = lines._replace(ahead=np.zeros(1))
    assert len(strokes_of(none, none.shown, seen, Eye(7.5)).light) == 0


def test_the_round_end_of_a_stroke_belongs_to_its_end():
    """A segment of 60 pixels that is drawn with 30 more: thirds are those of the segment."""
    number = np.full((40, 120), -1)
    number[20, 15:105] = 0
    colors = np.full((40, 120, 3), 50.0)
    colors[..., 0] = np.where(np.arange(120) < 15 + 20, 40.0, 70.0)
    lines = Segments(
        number, np.array([[15.0, 20.5]]), np.array([[60.0, 0]]), np.zeros(1),
        np.zeros(1, dtype=int), np.ones(1), np.ones(1),
    )  # fmt: skip
    # The ground is as the stroke: only the step within the first third of 20 pixels is seen.
    colors[number < 0] = (0, 0, 0)
    found = strokes_of(lines, lines.shown, seen_as(colors), Eye(7.5))
    np.testing.assert_allclose(found.light, [30], atol=1e-9)


def read(mesh, picture, camera, **how):
    return vizlight.legibility(
        mesh, picture=picture, camera=camera, **{"key": [], "size_mm": 30, "samples": 400} | how
    )


def test_finer_rings_are_read_worse_until_chance():
    mesh = sheet(20)
    found = [
        read(mesh, *rings(mesh, wide), tangents="swirl").direction for wide in (8, 4, 3.4, 2.1)
    ]
    medians, bits = [one.median for one in found], [one.bits for one in found]
    assert medians == sorted(medians)
    assert bits == sorted(bits, reverse=True)
    assert medians[0] < 2
    assert found[-1].unreadable
    assert medians[-1] == 45
    assert "too fine" in found[-1].reason


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("geom", "told"),
    [(None, 1), (pv.Cone(), 1), (pv.Cylinder(radius=0.1), 0), (pv.Line((-0.5, 0, 0)), 0)],
    ids=["arrow", "cone", "cylinder", "line"],
)
def test_glyphs_tell_course_and_speed_and_sense_by_their_heads(geom, told):
    glyphs = arrows(sheet(9), geom, scale="speed", factor=0.2)
    found = read(glyphs, *drawn_plain(glyphs, line_width=2), line_width=2)
    assert found.direction.median < 5
    assert found.speed.spearman > 0.9
    right, wrong = counts(found.sense)
    assert (right > 0.3 * found.sense.samples) == bool(told)
    assert wrong == 0


def test_a_wide_glyph_is_read_as_a_whole():
    bars = arrows(sheet(3), pv.Cylinder(radius=0.3), factor=0.8)
    found = read(bars, *drawn_plain(bars, lighting=False)).direction
    assert found.readable > 0.95


def test_glyphs_that_point_the_other_way_are_told_wrongly():
    mesh, back = sheet(9), sheet(9)
    back["swirl"] *= -1
    glyphs = arrows(mesh)
    ahead, found = (read(glyphs, *drawn_plain(arrows(one))) for one in (mesh, back))
    (right, few), (others, wrong) = counts(ahead.sense), counts(found.sense)
    assert right == pytest.approx(wrong, abs=0.05 * found.sense.samples)
    assert right > 0.8 * ahead.sense.samples
    assert max(few, others) < 0.05 * found.sense.samples
    assert found.sense.unreadable
    assert found.direction.median < 3
    # Glyphs of one length tell no speed, but by their colour.
    assert abs(found.speed.spearman) < 0.2
    colored = drawn_plain(glyphs, scalars="speed", cmap="gray", clim=(-0.1, 1.5), lighting=False)
    assert read(glyphs, *colored).speed.spearman > 0.8


def test_glyphs_of_another_field_are_chance():
    mesh, other = sheet(9), sheet(9)
    x, y, z = np.asarray(other.points).T
    other["swirl"] = np.stack([np.cos(4 * y), np.sin(3 * x + 1), 0 * z], axis=1)
    found = read(arrows(mesh), *drawn_plain(arrows(other)))
    assert found.direction.unreadable
    assert found.sense.unreadable


@pytest.mark.parametrize("turn", [0, 30, 75, 110, 170])
def test_stripes_have_their_course_and_shading_has_none(turn):
    right, down = np.meshgrid(np.arange(64.0), np.arange(48.0))
    across = right * np.sin(np.radians(turn)) + down * np.cos(np.radians(turn))
    for colors, noise in ((50 + 20 * np.cos(across), 0.0), (140 + 2 * across, 2.3)):
        picture = np.repeat(colors[..., np.newaxis], 3, axis=2)
        seen = seen_as(picture)
        tensor = grain_of(seen, Eye(60.0, noise), 0)
        grain = along_grain(tensor)[24, 32]
        # Light that changes by 2 from pixel to pixel is as nothing beside the noise.
        assert (abs(grain) > 0.98 if noise == 0 else abs(grain) < 0.5).all()
        if noise == 0:
            assert np.degrees(np.angle(grain)) / 2 % 180 == pytest.approx(turn, abs=0.1)


def test_faint_wide_stripes_are_seen_by_the_channel_of_coarse_marks():
    right, _ = np.meshgrid(np.arange(64.0), np.arange(48.0))
    picture = np.repeat((50 + 3 * np.cos(right / 2))[..., np.newaxis], 3, axis=2)
    grain = along_grain(grain_of(seen_as(picture), Eye(83.0, 2.3), 0))
    fine, coarse = (grain.imag**2 + (grain.real + 1) ** 2).mean(axis=(0, 1))
    assert coarse < 0.3 * fine


def wedge(shift=0):
    """Return a triangle of 12 by 9 pixels whose tip is to the right, as one glyph."""
    number = np.full((31, 32 + 2 * shift), -1)
    for step in range(12):
        half = 4 - step // 3
        number[15 - half : 16 + half, 10 + shift + step] = 0
    middle = np.array([[16.0 + shift, 15.5]])
    return Glyphs(number, number[::-1, ::-1], middle, np.array([[1.0, 0.0]]), np.array([6.0]))


def test_a_wedge_is_told_from_one_that_is_turned():
    glyphs, eye = wedge(), Eye(60.0)
    bare = glyphs.number < 0
    ink = np.where(bare, 10.0, 60.0)
    sides = glyphs.number, glyphs.turned
    for shown, answer in ((ink, 1), (ink[::-1, ::-1], -1), (0 * ink, 0)):
        assert ahead_of(*sides, shown, bare, eye) == answer
    # Of 72 pixels 24 are not those of both: 3 deviations of the mean of 18 would be the noise.
    assert np.count_nonzero(~bare & (glyphs.turned < 0)) == 24
    for more, answer in ((2.31, 1), (2.29, 0)):
        assert ahead_of(*sides, np.where(bare, 0, more), bare, eye) == answer
    # At twice as many pixels in a degree there are 6 square arc minutes.
    for more, answer in ((3.99, 1), (3.97, 0)):
        assert ahead_of(*sides, np.where(bare, 0, more), bare, Eye(120.0)) == answer
    # Without bare pixels around it a glyph has no sense; one that is not seen has no answer.
    assert ahead_of(*sides, ink, np.zeros_like(bare), eye) == 0
    hidden = np.full_like(glyphs.number, -1)
    assert np.isnan(ahead_of(hidden, glyphs.turned, ink, bare, eye)).all()


def test_the_side_of_a_wedge_that_is_seen_tells_it_where_a_surface_hides_the_other():
    glyphs, eye = wedge(), Eye(60.0)
    left = np.arange(32) < 16
    for hides, answers in ((left, (0, -1)), (~left, (1, 0))):
        # The wide end is to the left: as it is, or to the right if it is turned.
        number, turned = (np.where(hides, -1, each) for each in (glyphs.number, glyphs.turned))
        for shown, answer in zip((glyphs.number, glyphs.turned), answers, strict=True):
            ink = np.where(hides | (shown < 0), 0.0, 60.0)
            assert ahead_of(number, turned, ink, number < 0, eye) == answer


def test_the_contrast_of_marks_is_that_with_the_ground_beside_them_which_may_change():
    """Marks of 20 less than a ground that rises by 1 in 2 pixels, and has a step of 40."""
    height, width = np.indices((60, 120))
    ground = 30 + 0.5 * width + 40 * (width >= 60)
    line, disc = np.abs(height - 30) <= 1, np.hypot(height - 12, width - 90) < 9
    seen = seen_as((ground - 20 * (line | disc))[..., np.newaxis] * (1.0, 0, 0))
    above = above_ground(seen, line | disc, Eye(60.0))[..., 0]
    far = (np.abs(width - 60) > 12) & (width > 12) & (width < 108)
    np.testing.assert_allclose(above[~line & ~disc & far], 0, atol=2)
    np.testing.assert_allclose(above[line & far], -20, atol=0.5)
    # No place of the disc is further than its radius from the ground.
    np.testing.assert_allclose(above[disc], -20, atol=0.5 * 9 + 2)
    assert above[disc].mean() == pytest.approx(-20, abs=0.5)


def test_the_length_of_a_glyph_is_that_of_what_is_seen():
    glyphs = wedge()
    ink = np.where(glyphs.number >= 0, 60.0, 0.0)
    assert lengths_of(glyphs, ink, 6.9) == 12
    # It ends at half of the contrast of its middle, and goes on beyond what the mesh has of it.
    ink[15, 20:24] = (31, 31, 31, 29)
    assert lengths_of(glyphs, ink, 6.9) == 13
    assert lengths_of(glyphs, ink, 32.0) == 10
    assert lengths_of(glyphs, 0 * ink, 6.9) == 0
    # No further than 3/4 of its length to either side, and as far as the picture goes.
    assert lengths_of(glyphs, np.full_like(ink, 9.0), 6.9) == 19
    assert lengths_of(wedge(-9), np.full((31, 14), 9.0), 6.9) == 14
