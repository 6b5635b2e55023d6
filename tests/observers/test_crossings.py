"""Crossings of lines are found, and the nearer line is told where the picture shows it."""

import io

import numpy as np
import pytest
import pyvista as pv
from PIL import Image, ImageDraw
from scipy.ndimage import gaussian_filter
from sheets import counts, seen_as

import vizlight
from vizlight import presets
from vizlight.draw.cameras import camera_on
from vizlight.draw.live import matrix_of
from vizlight.observers import crossings
from vizlight.observers.lines import JUMP, Segments

pytestmark = pytest.mark.opengl

#: A small picture; an eye at 400 mm sees as many of its pixels in a degree as in print.
SIZE, SIZE_MM = (300, 200), 25


def lines(*pieces):
    """Return a mesh of lines through points."""
    starts = np.cumsum([0, *map(len, pieces)])
    cells = [[len(p), *range(a, a + len(p))] for a, p in zip(starts, pieces, strict=False)]
    return pv.PolyData(np.concatenate(pieces).astype(float), lines=np.concatenate(cells))


def straight(start, end, count=30):
    return np.linspace(start, end, count)


def lattice(across=5, along=4, depth=0.3):
    """Return lines that cross at right angles, of which every other one passes in front."""
    rows = [straight((0, y, 0), (7, y, 0)) for y in np.arange(along) + 0.5]
    columns = [
        straight((x + 1, -0.2, s * depth), (x + 1, along + 0.2, s * depth))
        for x, s in zip(range(across), np.tile([1, -1], across), strict=False)
    ]
    mesh = lines(*rows, *columns)
    mesh["kind"] = np.repeat([0.0, 1.0], [30 * along, 30 * across])
    return mesh


def shot(mesh, *, ours=True, light=None, view=(0, 0, 1), parallel=True, **how):
    """Return a picture of lines on black, and its camera."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "black"
    plotter.enable_anti_aliasing("msaa", multi_samples=8)
    if ours:
        plotter.vizlight.add_mesh(mesh, scene=light or vizlight.Scene(), **how)
    else:
        plotter.add_mesh(mesh, show_scalar_bar=False, **({"color": "tan", "lighting": False} | how))
    plotter.camera = camera_on(mesh, view, aspect=1.5, parallel=parallel)
    picture, camera = plotter.screenshot(return_img=True), plotter.camera.copy()
    return picture, camera


def order(mesh, picture, camera, **how):
    how = {"key": [], "line_width": 3, "size_mm": SIZE_MM, "samples": 256} | how
    return vizlight.legibility(mesh, picture=picture, camera=camera, **how).order


@pytest.fixture(scope="module")
def haloed():
    """Return a lattice of lines with halos, its picture, and the camera."""
    mesh = lattice()
    return mesh, *shot(mesh, line_width=3)


def test_lines_of_one_color_tell_no_order():
    mesh = lattice()
    found = order(mesh, *shot(mesh, ours=False, line_width=3))
    assert found.samples == 20
    assert (found.told, found.wrongly, found.bits) == (0.5, 0.5, 0)
    assert counts(found) == (0, 0)
    assert found.unreadable
    assert "halos" in found.reason


@pytest.mark.parametrize(("depth", "answer"), [(0.3, 0), (-0.3, 1)])
def test_darker_borders_inside_of_lines_of_one_color_tell_the_order(depth, answer):
    """Outlined lines, drawn from back to front, and the same picture of the mirrored lines."""
    mesh = lattice()
    drawn = np.asarray(mesh.points).reshape(9, 30, 3)
    _, camera = shot(mesh)
    to_pixels = matrix_of(camera.GetCompositeProjectionTransformMatrix(SIZE[0] / SIZE[1], -1, 1))
    picture = Image.new("RGB", SIZE)
    pen = ImageDraw.Draw(picture)
    for line in sorted(drawn, key=lambda line: line[0, 2]):
        x, y, *_ = to_pixels @ np.insert(line[[0, -1]], 3, 1, axis=1).T
        ends = [tuple(p) for p in np.column_stack([(1 + x) / 2 * SIZE[0], (1 - y) / 2 * SIZE[1]])]
        pen.line(ends, fill=(90, 70, 50), width=11)
        pen.line(ends, fill="tan", width=5)
    found = order(lattice(depth=depth), np.asarray(picture), camera, line_width=11)
    assert found.samples == 20
    assert counts(found)[answer] > 18
    assert counts(found)[1 - answer] == 0


@pytest.mark.parametrize("width", [3, 8])
def test_halos_tell_the_order(width):
    mesh = lattice()
    found = order(mesh, *shot(mesh, line_width=width), line_width=width)
    assert found.samples == 20
    assert found.told > 0.9
    assert found.wrongly == 0
    assert found.readable == found.told


@pytest.mark.parametrize("background", [0, 255])
def test_two_colors_tell_the_order_without_a_gap(background):
    mesh = lattice()
    picture, camera = shot(mesh, ours=False, scalars="kind", cmap=["orange", "blue"], line_width=7,
                           color=None)  # fmt: skip
    picture = np.where((picture == 0).all(axis=2, keepdims=True), np.uint8(background), picture)
    found = order(mesh, picture, camera, line_width=7)
    assert found.told > 0.9
    assert found.wrongly == 0


def test_a_picture_of_the_mirrored_lines_tells_the_order_wrongly(haloed):
    found = order(lattice(depth=-0.3), *haloed[1:])
    assert counts(found)[1] > 18
    assert counts(found)[0] == 0
    assert found.bits == 0
    assert "wrongly" in found.reason


def test_half_of_the_lines_mirrored_are_chance():
    columns = lattice(across=6)
    picture = shot(columns, line_width=3)
    points = np.asarray(columns.points).copy()
    points[(np.isin(np.arange(len(points)) // 30 - 4, [2, 3, 4])), 2] *= -1
    columns.points = points
    found = order(columns, *picture)
    assert abs(np.subtract(*counts(found))) < 0.1 * found.samples
    assert found.bits < 0.05


def told_of(pictures, camera, mesh):
    return [counts(order(mesh, picture, camera))[0] for picture in pictures]


def test_more_blur_tells_less(haloed):
    mesh, picture, camera = haloed
    blurred = [gaussian_filter(picture.astype(float), (s, s, 0)) / 255 for s in (0, 1, 2, 5)]
    told = told_of(blurred, camera, mesh)
    assert told == sorted(told, reverse=True)
    assert told[0] > 18
    assert told[-1] < 2


def test_less_contrast_tells_less(haloed):
    mesh, picture, camera = haloed
    told = told_of([picture / 255 * c for c in (1, 0.3, 0.1, 0.03, 0)], camera, mesh)
    assert told == sorted(told, reverse=True)
    assert told[0] > 18
    assert told[-1] == 0


@pytest.mark.slow
def test_narrower_lines_tell_less():
    mesh = lattice()
    picture, camera = shot(mesh, line_width=4)
    told = []
    for width in (4, 2, 1, 0.5, 0.25):
        # A picture of a quarter of the size has lines of a quarter of the width.
        how = {"line_width": 4, "size_mm": SIZE_MM * width / 4}
        told.append(counts(order(mesh, picture, camera, **how))[0])
    assert told == sorted(told, reverse=True)
    assert told[0] > 18
    assert told[-1] == 0


def test_a_jpeg_of_usual_quality_tells_the_order_as_well(haloed):
    mesh, picture, camera = haloed
    file = io.BytesIO()
    Image.fromarray(picture).save(file, "JPEG", quality=75)
    assert order(mesh, np.asarray(Image.open(file)), camera).told > 0.9


def test_crossings_beside_a_third_line_and_flat_ones_are_left_out():
    first, second = straight((0, 0, 0), (3, 0, 0)), straight((1, -1, 1), (1, 1, 1))
    third = straight((0.98, -1, 2), (0.98, 1, 2))
    alone, disturbed = lines(first, second), lines(first, second, third)
    assert order(alone, *shot(alone, line_width=3)).samples == 1
    assert order(disturbed, *shot(disturbed, line_width=3)) is None
    flat = lines(first, straight((0, -0.5, 1), (3, 0.5, 1)))
    assert order(flat, *shot(flat, line_width=3)) is None
    end = lines(first, straight((1, -1, 1), (1, 0, 1)))
    assert order(end, *shot(end, line_width=3)) is None


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ([(0.98, -1, 2)], "no crossing without a third line was found; 1 crossing is beside one"),
        (None, "no two lines are seen to cross at 30 degrees or more"),
    ],
)
def test_a_picture_says_why_no_crossing_is_asked(more, words):
    """The course of the lines and their values are read all the same."""
    starts = [(1, -1, 1), *more] if more else []
    across = [straight(start, np.multiply(start, (1, -1, 1))) for start in starts]
    mesh = lines(straight((0, 0, 0), (3, 0, 0)), *across)
    mesh["height"] = mesh.points[:, :2].sum(axis=1)
    picture, camera = shot(mesh, scalars="height", ours=False, color=None, line_width=3)
    key = {"scalars": "height", "key": ("viridis", mesh.get_data_range("height"))}
    found = vizlight.legibility(
        mesh, picture=picture, camera=camera, line_width=3, size_mm=SIZE_MM, samples=256, **key
    )
    assert found.order is None
    assert f"note: order: not measured, since {words}" in str(found)
    assert words in found.to_dict()["notes"][0]
    assert found.value.median < 0.05
    # All places of one line have one direction, of which nothing is read.
    assert found.direction.median < 5 if more else "values" not in found.direction.reason


def test_lines_that_bend_at_their_crossing_are_left_out():
    """Beside a bend a line is not where its direction at the crossing points."""
    bent = np.array([(0, -1, 0), (1, 0, 0), (0, 1, 0)])
    for x, count in ((0.97, 0), (0.5, 2)):
        mesh = lines(straight((x, -1, 1), (x, 1, 1)), bent.repeat(2, axis=0)[[0, 2, 4]])
        found = order(mesh, *shot(mesh, line_width=3))
        assert (0 if found is None else found.samples) == count


@pytest.mark.parametrize(
    ("bend", "far", "straight"),
    [(-35, 3, False), (-25, 3, True), (25, 3, True), (35, 3, False), (35, 6, False), (35, 7, True)],
)
def test_lines_turn_by_thirty_degrees_at_most_beside_a_crossing(bend, far, straight):
    """A line bends some pixels beyond the other one; 6.5 are looked at."""
    after = 60 * np.array([np.cos(np.radians(bend)), np.sin(np.radians(bend))])
    starts, ways = (
        np.array([[0.0, 40], [60, 40], [60 - far, 0]]),
        np.array([[60.0, 0], after, [0, 80]]),
    )
    along, line = np.array([0, 60, JUMP]), np.array([0, 0, 1])
    shown = np.full((80, 120), -1)
    lines = Segments(shown, starts, ways, along, line, np.full(3, 3.0), np.zeros(3))
    pair = np.array([0]), np.array([2])
    assert crossings._straight(lines, np.array([[60.0 - far, 40]]), *pair).tolist() == [straight]


def test_a_line_that_crosses_itself_is_asked():
    turn = np.linspace(0, 2 * np.pi, 400)[:-2]
    knot = np.stack(
        [np.sin(turn) + 2 * np.sin(2 * turn), np.cos(turn) - 2 * np.cos(2 * turn),
         -np.sin(3 * turn)], axis=1,
    )  # fmt: skip
    mesh = lines(knot)
    found = order(mesh, *shot(mesh, line_width=3))
    assert found.samples == 3
    assert found.told == 1


def test_lines_behind_a_surface_have_no_crossings():
    mesh = lattice()
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.vizlight.add_mesh(mesh, scene=presets.heading(), line_width=3)
    plotter.add_mesh(pv.Plane(center=(1, 2, 1), i_size=3, j_size=6), color="red")
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    found = plotter.vizlight.legibility(samples=256, size_mm=SIZE_MM).order
    assert found.samples == 12


@pytest.mark.parametrize("parallel", [True, False])
def test_lines_of_a_diameter_are_as_wide_as_they_are_drawn(parallel):
    mesh = lattice(depth=1.5)
    plotter = pv.Plotter(off_screen=True, window_size=[2 * side for side in SIZE])
    plotter.background_color = "white"
    plotter.vizlight.add_mesh(mesh, scene=presets.heading(), line_diameter=0.2, halo=False)
    plotter.camera = camera_on(mesh, (0.1, 0.1, 1), aspect=1.5, parallel=parallel)
    found = plotter.vizlight.legibility(samples=256, size_mm=2 * SIZE_MM)
    drawn = np.asarray(plotter.screenshot(return_img=True))
    assert found.pixels == pytest.approx(np.count_nonzero((drawn < 250).any(axis=2)), rel=0.08)
    assert found.order.samples == 20
    assert found.order.told > 0.9


def test_plain_lines_of_a_plotter_are_asked():
    mesh = lattice()
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.add_mesh(mesh, color="tan", line_width=3)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    found = plotter.vizlight.legibility(samples=256)
    assert found.order.unreadable
    assert found.heading is None


def crossed(angle=90.0, width=3, third=None, size=(80, 120)):
    """Return the segments of a horizontal line that another one crosses in front, as drawn."""
    row, column = np.mgrid[: size[0], : size[1]] + 0.5
    number = np.full(size, -1)
    number[np.abs(row - 40) <= width / 2] = 0
    way = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    for middle, name in ((60.0, 1), (third, 2)):
        if middle is not None:
            off = (column - middle) * way[1] - (row - 40) * way[0]
            number[np.abs(off) <= width / 2] = name
    start = np.array([[0, 40], *(np.array([x, 40]) - 50 * way for x in (60, third or 0))])
    ways = np.array([[120, 0], 100 * way, 100 * way])
    line = np.arange(3)
    return Segments(number, start, ways, JUMP * line, line, np.full(3, float(width)), np.zeros(3))


def found_in(lines):
    return crossings.crossings_of(lines, 16, np.random.default_rng(0))


def test_the_place_of_a_crossing_and_its_nearer_line_are_found():
    for angle in (90, 60, -40):
        found = found_in(crossed(angle))
        np.testing.assert_allclose(found.at, [[60, 40]], atol=1e-9)
        assert (found.front.tolist(), found.back.tolist()) == ([1], [0])


@pytest.mark.parametrize(("angle", "count"), [(25, 0), (35, 1), (145, 1), (155, 0)])
def test_lines_cross_at_thirty_degrees_or_more(angle, count):
    assert len(found_in(crossed(angle)).at) == count


@pytest.mark.parametrize(("third", "count"), [(66, 0), (70, 2), (54, 0), (50, 2)])
def test_no_third_line_is_within_some_pixels(third, count):
    """Lines of 3 pixels: their borders are 3 less apart than their middles."""
    assert len(found_in(crossed(third=third)).at) == count


def test_crossings_at_the_border_and_close_to_each_other():
    at = np.array([[10.0, 10], [12, 10], [14, 10], [30, 10]])
    np.testing.assert_array_equal(np.sort(crossings._first_of_each(at)), [0, 3])
    lines = crossed()
    places = np.array([[60.5, 0], [-0.5, 40], [119.5, 40], [120.5, 40], [5, -1], [5, 80.5],
                       [np.nan, 40], [5.5, 40.2]])  # fmt: skip
    shown = crossings._number(lines, places)
    np.testing.assert_array_equal(shown, [1, -1, 0, -1, -1, -1, -1, 0])


@pytest.mark.parametrize(("gap", "told"), [(0, 0), (6, 0), (8, 1), (-6, 0), (-8, -1), (40, 1)])
def test_borders_that_differ_by_three_deviations_tell_the_nearer_line(gap, told):
    """Beside one line the other is darker; 3 deviations of the noise are 6.96."""
    lines = crossed()
    colors = np.zeros((80, 120, 3))
    colors[..., 0] = 50.0
    across, along = (slice(38, 42), slice(56, 65)) if gap > 0 else (slice(35, 46), slice(58, 62))
    colors[across, along, 0] -= abs(gap)
    colors[38:42, 58:62, 0] = 50.0
    seen = seen_as(colors)
    assert crossings.answers(found_in(lines), lines, seen, 2.3).tolist() == [told]
    # A border on one side is none.
    colors[40:, :60, 0] = colors[:40, :60, 0] = colors[:40, :, 0] = 50.0
    assert crossings.answers(found_in(lines), lines, seen_as(colors), 2.3).tolist() == [0]
