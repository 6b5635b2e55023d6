"""Figures of pictures whose answer is known beforehand: chance, or no more than of another one."""

import io
import itertools
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image
from scipy.ndimage import gaussian_filter
from shapes import straws
from sheets import DIRECTION, FLAT, HOW, SHAPE, SIZE, counts, plotter_of, rings, sheet

import vizlight
from vizlight import presets
from vizlight.draw.cameras import camera_on
from vizlight.observers import measure, readers
from vizlight.observers.eye import Eye, linear
from vizlight.observers.figures import Speed
from vizlight.observers.lines import Segments, Strokes
from vizlight.observers.pixels import Pixels

pytestmark = pytest.mark.opengl


def shot(mesh, **how):
    """Return a picture, from 0 to 1, and its camera."""
    plotter, _ = plotter_of(mesh, show_scalar_bar=False, **how)
    picture, camera = plotter.screenshot(return_img=True) / 255, plotter.camera.copy()
    return picture, camera


VALUE = {"scene": FLAT, "scalars": "height", "cmap": "coolwarm"}
#: Question, or texture for direction by form, how a picture is drawn, and how it is read.
QUESTIONS = {
    "texture": (None, {"key": [], "tangents": "swirl"}),
    "direction": (DIRECTION, {"key": presets.direction(), "tangents": "swirl", "exponent": 2}),
    "shape": (SHAPE, {"key": presets.shape()}),
    "value": (VALUE, {"key": ("coolwarm", (-0.2, 0.2)), "scalars": "height"}),
}


def figure(question, mesh, picture, camera, **how):
    how = QUESTIONS[question][1] | {"camera": camera} | HOW | how
    name = "direction" if question == "texture" else question
    return getattr(vizlight.legibility(mesh, picture=picture, **how), name)


def falls_to_chance(bits, last=0.3, slack=0.1):
    """Return whether bits go down monotonically, but for the noise, to chance."""
    return all(b <= a + slack for a, b in itertools.pairwise(bits)) and bits[-1] < last


@pytest.fixture(
    scope="module",
    params=[
        "value",
        "texture",
        *(pytest.param(q, marks=pytest.mark.slow) for q in ("direction", "shape")),
    ],
)
def drawn(request):
    mesh = sheet()
    if request.param == "texture":
        return request.param, mesh, *rings(mesh)
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


@pytest.mark.slow
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
    # Form outlasts colour.
    lost = 0.98 if question == "texture" else 0.9
    assert falls_to_chance([whole, *bits], last=lost * whole)
    assert bits[0] > 0.9 * whole


def test_a_picture_of_another_mesh_is_chance(drawn):
    question, mesh, picture, camera = drawn
    mixed = picture.reshape(-1, 3).copy()
    shown = (mixed < 0.99).any(axis=1)
    # The same colours at other places, half of the picture away, upside down.
    blocks = np.flatnonzero(shown)
    mixed[blocks] = mixed[np.roll(blocks[::-1], len(blocks) // 2)]
    found = figure(question, mesh, mixed.reshape(picture.shape), camera)
    assert found.bits < 0.3
    assert found.unreadable
    assert found.readable == 0


def test_a_picture_without_hue_tells_no_direction(drawn):
    question, mesh, picture, camera = drawn
    gray = np.repeat(picture.mean(axis=2, keepdims=True), 3, axis=2)
    whole, found = (figure(question, mesh, p, camera) for p in (picture, gray))
    assert (found.bits < 0.6 * whole.bits) == (question != "texture")
    if question == "direction":
        assert found.unreadable
        assert found.median == 45


def without_hue(picture):
    """Return a picture in grays of the same luminance."""
    light = picture**2.2 @ np.array([0.2126, 0.7152, 0.0722])
    return np.repeat(light[..., np.newaxis] ** (1 / 2.2), 3, axis=2)


@pytest.mark.parametrize("name", ["hue", "lightness"])
def test_maps_of_equal_lightness_are_read_in_colors_only(name):
    """Of two maps one has hue and the other lightness alone; without hue one is chance."""
    mesh = sheet()
    ends = {"hue": [(0.75, 0.42, 0.42), (0.25, 0.58, 0.55)], "lightness": ["black", "lightgray"]}
    cmap = LinearSegmentedColormap.from_list(name, ends[name])
    how = {"cmap": cmap, "clim": (-0.2, 0.2), "scalars": "height"}
    picture, camera = shot(mesh, scene=FLAT, **how)
    gray = without_hue(picture)
    key = {"key": (cmap, (-0.2, 0.2))}
    whole, bare = (figure("value", mesh, p, camera, **key) for p in (picture, gray))
    assert whole.bits > 1
    assert bare.unreadable == (name == "hue")
    assert bare.readable < 0.05 or name == "lightness"


@pytest.mark.parametrize(("cmap", "read"), [("viridis", True), ("twilight", False)])
def test_a_map_that_rises_in_lightness_is_read_in_gray(cmap, read):
    mesh = sheet()
    picture, camera = shot(mesh, scene=FLAT, scalars="height", cmap=cmap, clim=(-0.2, 0.2))
    how = {"key": (cmap, (-0.2, 0.2))}
    found = figure("value", mesh, without_hue(picture), camera, **how)
    assert (found.median < 0.03) == read
    assert (found.readable > 0.9) == read


def test_a_map_read_by_the_key_of_another_is_chance():
    mesh = sheet()
    picture, camera = shot(mesh, scene=FLAT, scalars="height", cmap="gray", clim=(-0.2, 0.2))
    backward = {"key": ("gray_r", (-0.2, 0.2))}
    found = figure("value", mesh, picture, camera, **backward)
    assert found.unreadable
    assert (found.median, found.largest) == (0.25, 0.5)


@pytest.mark.slow
def test_narrower_lines_are_read_worse_until_chance():
    mesh = straws(40, 8)
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "black"
    plotter.vizlight.add_mesh(mesh, scene=presets.heading(), line_width=4, halo=False)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    bits = []
    for width in (4, 2, 1, 0.5, 0.25):
        # A picture of a quarter of the size has lines of a quarter of the width.
        found = plotter.vizlight.legibility(samples=768, size_mm=30 * width / 4).heading
        bits.append(found.bits)
        # No line is read to a fraction of a degree: the noise of the eye alone is more.
        assert found.median > 2
    assert "finer than an eye" in found.reason
    picture = linear(plotter.screenshot(return_img=True) / 255)
    how = {"camera": plotter.camera.copy(), "line_width": 4, "key": presets.heading()} | HOW
    assert bits[0] > 1
    assert falls_to_chance(bits)
    # Lines that are all darker than the key by one factor are read like the others.
    dark = (0.5 * picture) ** (1 / 2.2)
    assert vizlight.legibility(mesh, picture=dark, **how).heading.bits > 0.8 * bits[0]


@pytest.mark.slow
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
    assert found.bits > 0.85 * bare.bits
    assert found.readable > 0.85 * bare.readable


def places(turns_right, turns_up, apart):
    """Return places whose data turn by some degrees to the next pixels to the right and up."""
    angles = [np.zeros(len(apart)), np.radians(turns_right), np.radians(turns_up)]
    here, right, up = (
        np.stack([np.cos(a), np.sin(a)], axis=1) * np.array([1, sign])
        for a, sign in zip(angles, (1, 1, -1), strict=True)
    )
    beside = dict.fromkeys(("part", "colors", "unit", "grain", "course", "thing", "length"))
    return measure.SeenPlaces(here=here, right=right, up=up, apart=np.array(apart), **beside)


def test_structure_is_the_length_of_a_quarter_turn():
    found = places([3, 0, 3], [4, 9, 4], [True, True, False]).structure(lambda sample: sample)
    np.testing.assert_allclose(found, [18, 10, np.nan], rtol=1e-6)
    double = places([3], [4], [True]).structure(lambda sample: sample, 2)
    np.testing.assert_allclose(double, [36], rtol=1e-6)


def test_the_finest_structure_is_the_least_octave_of_which_half_is_read():
    lengths = np.repeat([4.0, 8.5, 20.0, 40.0, np.nan], 40)
    unit = np.full(200, 0.5)
    found = measure._scale("direction", lengths, unit, lengths > 8, 1 / 6)
    assert (found.pixels, found.length, found.median) == (8.5, 4.25, 14.25)
    # Octaves of fewer than 32 places are not judged, and what is guessed is not read.
    few = measure._scale("direction", lengths[9:], unit[9:], lengths[9:] < 50, 1 / 6)
    assert few.pixels == 8.5
    half = measure._scale("direction", lengths, unit, np.arange(200) % 5 > 1, 0.5)
    assert half.pixels is None
    assert measure._beyond_chance(np.arange(10) < 6, 0.5) == pytest.approx(0.2)
    assert measure._beyond_chance(np.arange(10) < 4, 0.5) == 0


def test_a_figure_of_two_sides_counts_right_and_wrong_answers():
    found = measure._order(np.repeat([1, -1, 0], [8, 1, 1]))
    assert (found.told, found.wrongly, found.samples) == (0.8, 0.1, 10)
    assert found.bits == pytest.approx(0.9 * (1 - 0.50326) - 0.07213, abs=1e-4)
    assert found.readable == pytest.approx(0.7)
    assert not found.unreadable
    assert "alike" in measure._order(np.repeat([1, 0], [3, 7])).reason
    chance = measure._order(np.repeat([1, -1, 0], [3, 2, 5]))
    assert "wrongly, 3 right and 2 wrong of 10;" in chance.reason
    assert (chance.told, chance.wrongly, chance.readable) == (0.5, 0.5, 0)
    assert measure._order(np.zeros(0)) is None


def test_no_answer_that_is_not_better_than_chance_is_printed():
    random = np.random.default_rng(4)
    for _ in range(200):
        shares = random.dirichlet([1, 1, 1])
        found = measure._order(random.choice([-1, 0, 1], size=40, p=shares))
        assert found.unreadable or found.told > found.wrongly
        assert found.readable >= 0
        answers = [figure for _, figure, _ in found.rows()[:2]]
        assert (answers == ["chance"] * 2) == found.unreadable


def test_ends_of_strokes_differ_by_three_deviations_of_the_noise():
    ink = np.array([7.0] * 7 + [6.8, -7.0, 0.0])
    none, pixels = 0 * ink, np.full(10, 5)
    answers = measure._of_strokes(Strokes(ink, none, pixels), 2.3)
    found = measure._sense(answers, pixels)
    assert counts(found) == (7, 1)
    for ends in ((-ink, none), (none, answers), (none, -answers)):
        same = measure._of_strokes(Strokes(*ends, pixels), 2.3)
        np.testing.assert_array_equal(same, answers)
    assert measure._sense(answers[:7], pixels[:7]) is None
    assert measure._sense(answers[:8], pixels[:8]) is not None


def test_a_place_on_a_long_stroke_counts_as_one_on_a_short_one():
    answers, pixels = np.repeat([1.0, 0.0, -1.0], 10), np.repeat([90, 9, 1], 10)
    found = measure._sense(answers, pixels)
    assert (found.told, found.wrongly, found.samples) == pytest.approx((0.9, 0.01, 30))
    each = measure._sense(np.repeat(answers, pixels), np.ones(1000))
    assert (each.told, each.wrongly) == pytest.approx((found.told, found.wrongly))


def pixels_of(part):
    """Return the pixels of a picture of numbers of meshes, none where -1, and their numbers."""
    row, column = np.nonzero(part >= 0)
    number = np.full(part.shape, -1)
    number[row, column] = np.arange(len(row))
    size = part.shape[1], part.shape[0]
    return Pixels(row, column, part[row, column], np.zeros(len(row), dtype=int), size), number


def test_a_reader_of_a_surface_looks_between_the_lines_on_it():
    part = np.zeros((40, 60), dtype=int)
    part[:, 30] = 1
    pixels, number = pixels_of(part)
    ids = number[20, [31, 29, 33, 50, 10]]
    # A pixel is an arc minute.
    row, column = measure._between(pixels, number, 0, ids, Eye(60.0))
    np.testing.assert_array_equal(row, 20)
    np.testing.assert_array_equal(column, [33, 27, 33, 50, 10])
    # All is closer to the line than an eye sees it alone, or what is free is too far away.
    for narrow, pixel in ((slice(28, 33), 31), (slice(14, 33), 32)):
        part = np.full((40, 60), -1)
        part[:, narrow] = 0
        part[:, 30 if narrow.start > 20 else slice(17, 33)] = 1
        part[20, pixel] = 0
        pixels, number = pixels_of(part)
        found = measure._between(pixels, number, 0, number[[20], [pixel]], Eye(60.0))
        assert [int(each[0]) for each in found] == [20, pixel]
    alone, number = pixels_of(np.zeros((4, 4), dtype=int))
    found = measure._between(alone, number, 0, number[1], Eye(60.0))
    np.testing.assert_array_equal(found, [[1] * 4, range(4)])


def test_a_line_is_seen_in_pieces_of_eight_arc_minutes():
    pixels, number = pixels_of(np.array([[0] * 60 + [1] * 4]))
    shown = np.where(number < 60, 0, -1)
    line = Segments(
        shown, np.array([[0.0, 0.5]]), np.array([[60.0, 0]]), *np.zeros((1, 1)),
        np.zeros(1, dtype=int), np.ones(1), np.zeros(1),
    )  # fmt: skip
    parts = [SimpleNamespace(kind=kind) for kind in ("line", "surface")]
    # A pixel is an arc minute.
    thing = measure._things(pixels, parts, line, None, Eye(60.0))
    assert np.unique(thing[:60], return_counts=True)[1].tolist() == [4, *[8] * 7]
    np.testing.assert_array_equal(thing[60:], measure.NO_THING)


def test_the_pixel_beside_is_of_the_same_mesh():
    part = np.array([[0, 0, 1, -1], [0, 1, 1, 1]])
    pixels, number = pixels_of(part)
    for step, expected in (
        ((0, 1), [1, 0, 2, 3, 5, 6, 5]), ((1, 0), [3, 1, 5, 0, 4, 2, 6]),
    ):  # fmt: skip
        found = measure._beside(pixels, number, np.arange(7), step)
        np.testing.assert_array_equal(found, expected)


def test_values_have_their_places_on_a_bar():
    table = pv.LookupTable("viridis", scalar_range=(0.1, 1000))
    values = np.array([-1, 0.1, 1, 100, 1e5])
    even = measure._shares(table, values)
    np.testing.assert_allclose(even, [0, 0, 0.9 / 999.9, 99.9 / 999.9, 1], atol=1e-12)
    table.log_scale = True
    np.testing.assert_allclose(measure._shares(table, values), [0, 0, 0.25, 0.75, 1], atol=1e-12)


def test_angles_are_a_share_and_a_median_unless_they_are_chance():
    error = np.array([2.0, 10.0, 11.0, 40.0])
    found = [readers.Reading(part, None, 8, part, None) for part in (error[:1], error[1:])]
    assert measure._angles(found, {"reason": ""}) == {"within_10": 0.5, "median": 10.5}
    chance = measure._angles(found, {"reason": "too fine"})
    assert chance == {"within_10": 1 / 9, "median": 45.0}


def test_what_is_guessed_is_the_share_of_the_tolerance():
    tolerance = measure.TOLERANCE
    guessed = {question: kind.guessed for question, kind in measure.MATCHED.items()}
    guessed["rank"] = Speed.guessed
    assert tolerance == {
        "direction": 15, "heading": 15, "shape": 20, "value": 0.1, "rank": 0.15,
    }  # fmt: skip
    for question in ("direction", "heading"):
        assert guessed[question] == pytest.approx(2 * tolerance[question] / 180)
    assert guessed["shape"] == pytest.approx(np.sin(np.radians(20)) ** 2, abs=1e-3)
    for question in ("value", "rank"):
        assert guessed[question] == pytest.approx(2 * tolerance[question])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lengths": [7, 7, np.nan]}, "within 7 pixels"),
        ({"lengths": [7, 7], "pixels": 30}, "do not follow"),
        ({"values": 1}, "show values"),
        ({"deviation": 7.0}, "finer than an eye"),
        ({"deviation": 6.8, "wide": 50}, "do not follow"),
        ({"wide": 10}, "less than an eye"),
        ({"wide": 10, "by_form": True}, "marks are too fine"),
        ({"wide": 11}, "do not follow"),
    ],
)
def test_the_reason_is_what_keeps_a_picture_from_being_read(change, words):
    """Structure below 6 arc minutes; noise of 3 times the eye's; colours that hardly differ."""
    how = {"lengths": [], "pixels": 100, "values": None, "deviation": 2.3, "wide": 90}
    how |= {"by_form": False} | change
    colors = np.zeros((101, 3))
    colors[:, 1] = np.linspace(0, how["wide"], 101)
    place = SimpleNamespace(
        here=SimpleNamespace(points=np.zeros((1, 3))),
        part=SimpleNamespace(values=how["values"], by_form=how["by_form"]),
        colors=readers.Colors(colors, np.full((101, 3), how["deviation"])),
    )  # fmt: skip
    reader = measure._PictureReader([place], 0, Eye(how["pixels"]), [])
    assert words in reader._reason("direction", [place], np.array(how["lengths"], float))


def test_a_figure_is_unread_below_its_floor_or_near_the_error_of_chance():
    random = np.random.default_rng(0)
    place = SimpleNamespace(
        here=SimpleNamespace(points=np.zeros((1, 3))),
        part=SimpleNamespace(values=None, by_form=False),
        colors=readers.Colors(random.normal(0, 20, (64, 3)), np.full((64, 3), 2.3)),
        unit=np.full(64, 0.5),
    )  # fmt: skip
    for bits, error, unread in ((0.5, 5, 0), (0.2, 5, 1), (0.5, 42, 1), (0.5, 40, 0)):
        truth = np.full((4, 64), 2.0**bits / 4)
        reading = readers.Reading(
            np.full(64, float(error)), truth, 4, np.full(64, 90.0), np.full((4, 64), 0.25)
        )
        reader = measure._PictureReader([place], 0, Eye(100.0), [])
        found = reader._common("direction", [place], [reading], np.full(64, 50.0))
        assert found["bits"] == pytest.approx(np.log2(0.98 * 2**bits + 0.02), abs=1e-9)
        assert bool(found["reason"]) == bool(unread)
        assert found["readable"] == (1 if error == 5 and not unread else 0)
        read = error == 5 and not unread
        assert (reader.scale.pixels, found["samples"]) == (50 if read else None, 64)
