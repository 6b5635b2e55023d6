"""What a look draws on and around maps: coasts and frames, where they are and where not."""

import contextlib
import re

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import cartography
from vizlight.draw.cameras import MARGIN
from vizlight.draw.margins import LETTERS
from vizlight.looks.recipes import reliefs
from vizlight.mesh import meaning

SIZE = (300, 200)
#: Ends of the paths of the layers of isolines and of their numbers.
ISOLINES = ["[]", "[]"]


def chart(width, height, west=-20.0, south=30.0, unit="degree", name="warmth"):
    """Return a map of 21 x 16 points with a smooth array."""
    grid = pv.ImageData(
        dimensions=(21, 16, 1), spacing=(width / 20, height / 15, 1), origin=(west, south, 0)
    )
    x, y, _ = np.asarray(grid.points, dtype=float).T
    grid[name] = np.sin(x / width * 4) + np.cos(y / height * 3)
    if unit:
        grid.field_data["unit"] = [unit]
    return grid


def paths(look):
    """Return the paths of the steps that make the layers of a look."""
    return [layer.mesh.path.rpartition(".")[2] for layer in look.drawing.layers]


@pytest.mark.parametrize(
    ("mesh", "options", "parts"),
    [
        (chart(60, 40), {}, ["graticule", "coasts", *ISOLINES, "frame"]),
        (chart(60, 40, south=-20), {}, ["coasts", *ISOLINES, "frame"]),
        (chart(14, 8), {}, ["graticule", *ISOLINES, "frame"]),
        (chart(60, 40, unit=""), {}, []),
        (chart(360, 180, -180, -90, unit=""), {}, ["graticule", "coasts", *ISOLINES, "frame"]),
        (chart(360, 180, 0, -90, unit=""), {}, ["graticule", "coasts", *ISOLINES, "frame"]),
        (chart(60, 40, west=-160, south=-40), {}, [*ISOLINES, "frame"]),
        (chart(60, 40, name="elevation"), {}, ["graticule", *ISOLINES, "frame"]),
        (chart(9000, 8000, unit="metre"), {}, [*ISOLINES, "frame"]),
        (chart(60, 40), {"view": "iso"}, ["coasts"]),
        (chart(60, 40), {"map_parts": ()}, []),
        (chart(60, 40), {"map_parts": "isolines"}, ISOLINES),
        (
            chart(14, 8, west=-5),
            {"map_parts": ["coasts", "frame"]},
            ["graticule", "coasts", "frame"],
        ),
        (chart(60, 40, name="elevation"), {"map_parts": "coasts"}, ["coasts"]),
    ],
)
def test_maps_have_what_suits_them(mesh, options, parts):
    assert paths(vizlight.look(mesh, size=SIZE, **options))[1:] == parts


def test_a_section_lies_as_it_is_and_has_isolines_and_numbers():
    mesh = chart(30, 900, unit="")
    scales = [meaning.AxisScale("distance", "km", 1e3), meaning.AxisScale("pressure", "hPa", -1.0)]
    mesh.origin = (0.0, -1000.0, 0.0)
    meaning.attach(mesh, meaning.Meaning(scales=scales))
    look = vizlight.look(mesh, size=SIZE)
    assert paths(look)[1:] == [*ISOLINES, "frame"]
    x, y, _ = look.mesh.bounds_size
    assert x / y == pytest.approx(1.6, rel=1e-3)
    np.testing.assert_allclose(look.view.up, (0, 1, 0), atol=1e-6)
    assert "with height up" in look.reason
    assert "the section fills the picture, its axes have different units" in look.notes
    mesh["u"] = mesh["v"] = mesh["warmth"]
    assert vizlight.look(mesh, size=SIZE).question == "none"


def test_parts_of_a_map_by_name():
    rough = chart(60, 40)
    rough["warmth"] = np.random.default_rng(3).uniform(size=rough.n_points)
    assert paths(vizlight.look(rough, size=SIZE, map_parts="none"))[1:] == []
    assert "[]" in paths(vizlight.look(rough, size=SIZE, map_parts="isolines"))
    globe = vizlight.look(chart(360, 180, -180, -90), size=SIZE, globe=True, map_parts=())
    assert [layer.mesh.name for layer in globe.drawing.layers] == ["ball", "ball"]
    notes = vizlight.look(pv.Sphere(), size=SIZE, map_parts="coasts,frame").drawing.notes
    assert notes[-1] == "not drawn on these data: coasts, frame"
    with pytest.raises(ValueError, match="map_parts: expected names of coasts, frame, isolines"):
        vizlight.look(rough, map_parts="coast")


def test_a_globe_of_a_smooth_field_has_isolines_on_the_ball():
    earth = chart(360, 180, -180, -90)
    earth["warmth"] = np.cos(np.radians(np.asarray(earth.points)[:, 1]))
    look = vizlight.look(earth, globe=True, size=SIZE)
    meshes = [layer.mesh for layer in look.drawing.layers]
    curves = next(mesh.run() for mesh in meshes if mesh.name == "isolines")
    points = np.asarray(curves.points, dtype=float)
    latitudes = np.degrees(np.arcsin(points[:, 2] / np.linalg.norm(points, axis=1)))
    np.testing.assert_allclose(np.cos(np.radians(latitudes)), curves["warmth"], atol=0.01)
    assert "lines every" in look.drawing.keys[0]["title"]


def test_two_maps_in_one_picture_have_no_frame_of_one():
    assert (
        paths(vizlight.look([chart(60, 40), chart(60, 40, south=70.0)], size=SIZE))
        == ["surface_of"] * 2
    )


@pytest.mark.parametrize("sides", [(60, 40), (360, 180), (15, 60), (90, 10)])
def test_all_of_the_frame_is_in_the_picture_and_the_map_fills_the_rest(sides):
    look = vizlight.look(chart(*sides, west=-20, south=-30), size=SIZE)
    camera, frame = look.view, look.drawing.layers[-1].mesh.run()
    room = look.wishes.room
    high = camera.parallel_scale
    wide = high * room[0] / room[1]
    x, y, _ = np.asarray(frame.points, dtype=float).T - np.reshape(camera.focal_point, (3, 1))
    up = np.array(camera.up)[:2]
    right = np.array([up[1], -up[0]])
    filled = [
        np.abs(x * right[0] + y * right[1]).max() / wide,
        np.abs(x * up[0] + y * up[1]).max() / high,
    ]
    assert max(filled) == pytest.approx(1 / MARGIN, abs=0.03)
    # Letters are as high as those of keys.
    pixels = look.drawing.layers[-1].mesh.keywords["letters"] / (2 * high) * room[1]
    assert pixels == pytest.approx(LETTERS * min(SIZE), rel=0.06)


def test_a_smooth_map_has_bands_between_its_isolines_and_says_their_step():
    look = vizlight.look(chart(60, 40), size=SIZE)
    (key,) = look.drawing.keys
    table = look.drawing.layers[0].keywords["cmap"].run()
    lines = look.drawing.layers[3].mesh.run()
    assert set(np.unique(lines["level"])) <= set(key["levels"])
    # Of few lines, classes end halfway between them too.
    step = 2 * (key["levels"][1] - key["levels"][0])
    assert key["title"] == f"warmth; lines every {step:g}"
    low, high = table.scalar_range
    assert (low, high) == (key["levels"][0], key["levels"][-1]) == key["clim"]
    colors = np.asarray(table.values).astype(int)
    jumps = np.abs(np.diff(colors, axis=0)).sum(axis=1)
    at = low + (np.argsort(jumps)[-4:] + 1) / len(colors) * (high - low)
    nearest = np.abs(at[:, np.newaxis] - key["levels"]).min(axis=1)
    assert nearest.max() < 2 * (high - low) / len(colors)


def test_bands_do_not_take_back_a_range_that_leaves_values_out():
    mesh = chart(60, 40)
    mesh["warmth"] += 280
    mesh["warmth"][:42] = 0
    look = vizlight.look(mesh, size=SIZE)
    (key,) = look.drawing.keys
    assert key["clim"][0] > 270
    assert key["clim"] == look.drawing.layers[0].keywords["clim"]
    assert "lines every" not in key["title"]


@pytest.mark.parametrize(
    ("mesh", "options", "lies"),
    [
        (chart(90, 40), {}, True),
        (chart(40, 40), {}, False),
        (chart(90, 40), {"key": False}, False),
        (chart(90, 40), {"view": "above"}, False),
        (chart(90, 40, south=-20, name="elevation"), {}, True),
    ],
)
def test_the_bar_of_a_wide_map_lies_below_it(mesh, options, lies):
    look = vizlight.look(mesh, size=SIZE, **options)
    _, steps = look._picture()
    assert any(step.keywords.get("lying") for step in steps) == lies
    assert (look.wishes.room[0] == SIZE[0]) == (lies or "key" in options)


@pytest.mark.slow
def test_the_disc_of_a_wide_map_stands_beside_it():
    mesh = chart(90, 40)
    mesh["wind"] = np.full((mesh.n_points, 3), (1.0, 2.0, 0.0))
    look = vizlight.look(mesh, "direction", size=SIZE)
    assert look.wishes.room[0] < SIZE[0]


def test_contours_of_a_relief_are_thin_and_its_colours_have_no_classes():
    look = vizlight.look(chart(60, 40, name="elevation"), size=SIZE)
    lines, (key,) = look.drawing.layers[1], look.drawing.keys
    assert lines.keywords["line_width"] < 1.5
    assert "levels" not in key
    assert re.search(r"; lines every [\d.]+$", key["title"])


def test_pressure_of_air_is_read_in_hectopascals():
    mesh = chart(60, 40, name="air_pressure")
    mesh["air_pressure"] = 1e5 + 1e3 * mesh["air_pressure"]
    said = meaning.Meaning()
    said.add_array("air_pressure", {"standard_name": "air_pressure", "units": "Pa"})
    meaning.attach(mesh, said)
    look = vizlight.look(mesh, size=SIZE)
    (key,) = look.drawing.keys
    low, high = np.divide(mesh.get_data_range("air_pressure"), 100)
    step = np.diff(key["levels"]).min()
    assert key["clim"][0] <= low < key["clim"][0] + step
    assert key["clim"][1] - step < high <= key["clim"][1]
    assert re.fullmatch(r"air_pressure \(hPa\); lines every \d hPa", key["title"])
    levels = look.drawing.layers[3].mesh.arguments[0].arguments[2]
    assert set(np.divide(levels, 100)) <= set(key["levels"])


@pytest.mark.parametrize("standard", ["air_pressure_at_sea_level", "air_temperature"])
def test_highs_and_lows_are_marked_on_maps_of_pressure_alone(standard):
    mesh = chart(60, 40, name="p")
    x, y, _ = np.asarray(mesh.points, dtype=float).T
    mesh["p"] = 1e5 - 2e3 * np.exp(-(np.hypot(x - 10, y - 50) ** 2) / 60)
    said = meaning.Meaning()
    said.add_array("p", {"standard_name": standard, "units": "Pa"})
    meaning.attach(mesh, said)
    assert paths(vizlight.look(mesh, size=SIZE)).count("[]") == 2 + (standard != "air_temperature")


def test_lines_that_are_held_are_those_that_a_script_makes():
    step = vizlight.look(chart(60, 40), size=SIZE).drawing.layers[3].mesh.arguments[0]
    again = type(step)("", step.path, *step.arguments, **step.keywords).run()
    for name in ("lines", "numbers"):
        np.testing.assert_array_equal(step.run()[name].points, again[name].points)


def test_a_map_in_degrees_stays_so_where_planes_or_an_eye_are_in_degrees():
    for options in ({"view": "above"}, {"clip": [((1, 0, 0), (10, 50, 0))]}):
        mesh = vizlight.look(chart(60, 40), size=SIZE, **options).mesh
        assert mesh.field_data["unit"][0] == "degree"
    assert vizlight.look(chart(60, 40), size=SIZE).mesh.field_data["unit"][0] == "metre"


@pytest.mark.parametrize("name", ["a.gif", "a.mp4"])
def test_a_map_on_which_nothing_moves_has_no_movie(name):
    with pytest.raises(ValueError, match="path: expected a picture or a page of a map"):
        vizlight.look(chart(60, 40), size=SIZE).steps(name)


def test_heights_that_are_0_at_sea_have_coasts_and_a_blue_sea():
    land = chart(60, 40, name="elevation")
    land["elevation"] = np.maximum(1000 * land["elevation"], 0)
    assert np.mean(land["elevation"] == 0) > 0.1
    shown = vizlight.look(land, size=SIZE)
    assert "coasts" in paths(shown)
    assert "level_sea=True" in shown.script()
    bed = chart(60, 40, name="elevation")
    assert "coasts" not in paths(vizlight.look(bed, size=SIZE))


@pytest.mark.slow
@pytest.mark.opengl
def test_a_page_has_the_coasts_and_the_frame(tmp_path):
    look = vizlight.look(chart(60, 40), size=SIZE)
    with_them = look.save(tmp_path / "a.html").stat().st_size
    bare = vizlight.look(chart(60, 40, unit=""), size=SIZE).save(tmp_path / "b.html").stat().st_size
    assert with_them > bare + 3000


@pytest.mark.slow
@pytest.mark.opengl
def test_coasts_are_seen_on_dark_colours_and_on_light_ones():
    """Where a coast runs the picture differs by more than a step of grey from a bare one."""
    for cmap in ("Greys", "Greys_r", "viridis"):
        pictures = []
        for unit in ("degree", ""):
            plotter = vizlight.look(
                chart(60, 40, unit=unit), size=SIZE, cmap=cmap, key=False
            ).plotter()
            if unit:
                camera = plotter.camera.copy()
            plotter.camera = camera
            pictures.append(plotter.screenshot(return_img=True).astype(int))
            plotter.close()
        change = np.abs(pictures[0] - pictures[1]).sum(axis=2)
        # Over the data: coasts alone.
        inner = change[40:120, 60:260]
        assert np.mean(inner > 150) > 0.03


@pytest.mark.parametrize(
    ("methods", "span", "words"),
    [
        ("time: mean (interval: 6 hour)", [], "warmth, mean at 1900-01-03 (K)"),
        ("time: mean", [24.0, 60.0], "warmth, mean of 1900-01-02 to 1900-01-03 12:00 (K)"),
        ("area: mean time: maximum", [], "warmth, maximum at 1900-01-03 (K)"),
        ("time: point", [24.0, 72.0], "warmth, 1900-01-03 (K)"),
        ("", [], "warmth, 1900-01-03 (K)"),
    ],
)
def test_the_title_says_what_a_value_sums_up_in_time(methods, span, words):
    mesh = chart(60, 40)
    said = meaning.Meaning(time="hours since 1900-01-01", span=span)
    said.add_array("warmth", {"units": "K", "cell_methods": methods})
    meaning.attach(mesh, said)
    mesh.field_data["TimeValue"] = [48.0]
    assert vizlight.look(mesh).drawing.keys[0]["title"].startswith(words)


def test_a_relief_of_the_whole_earth_has_a_sky_where_it_has_few_points(monkeypatch):
    world = chart(360, 170, -180, -85, name="elevation")
    assert vizlight.look(world, size=SIZE).drawing.lit.keywords["occlusion"] == "sky"
    monkeypatch.setattr(reliefs, "MOST_WIDE", 300)
    assert "occlusion" not in vizlight.look(world, size=SIZE).drawing.lit.keywords


@pytest.mark.usefixtures("few_strokes")
def test_strokes_of_a_map_have_their_course():
    grid = chart(20, 10, 0, 55, name="warmth")
    grid["wind"] = np.tile([10.0, 10.0, 0.0], (grid.n_points, 1))
    layers = vizlight.look(grid, "direction", size=SIZE).drawing.layers
    strokes = next(
        mesh for mesh in (layer.mesh.run() for layer in layers) if "age" in mesh.array_names
    )
    start, end = strokes.get_cell(0).points[[0, -1]]
    assert np.degrees(np.arctan2(*(end - start)[1::-1])) == pytest.approx(45, abs=0.1)


@pytest.mark.parametrize("name", ["elevation", "posts"])
def test_posts_are_heights_to_the_sky_though_they_have_two_values(name):
    grid = pv.ImageData(dimensions=(20, 20, 1))
    grid[name] = np.where(np.arange(400) % 37, 0.0, 3.0)
    look = vizlight.look(grid, "sky", size=SIZE)
    assert look.mesh["sky"].min() < 0.9
    assert not look.others


@pytest.mark.slow
def test_a_relief_of_the_whole_earth_is_bent_once_it_is_lit(tmp_path):
    earth = chart(348, 168, west=-174.0, south=-84.0, name="elevation")
    earth = earth.cast_to_rectilinear_grid()
    earth.x = np.arange(21) * 360 / 21 - 170
    look = vizlight.look(earth, "relief", size=SIZE)
    shown = look.drawing.layers[0].mesh
    assert shown.path == "vizlight.cartography.chart"
    assert shown.arguments[0].path == "vizlight.tint"
    assert "eqearth" in str(shown.run().field_data["projection"][0])
    assert look.others[0].python == "globe=True"
    # A page has the data, not only the frame.
    steps = look.steps(tmp_path / "a.html")[-1]
    assert any(shown is argument for step in steps for argument in step.arguments)


@pytest.mark.parametrize(
    ("west", "south", "side", "keywords", "said"),
    [
        (-10.0, 49.0, 10.0, {}, True),
        (-10.0, 49.0, 10.0, {"map_parts": ("coasts",)}, False),
        (-10.0, 49.0, 10.0, {"map_parts": ()}, False),
        (-10.0, 40.0, 30.0, {}, False),
        (-150.0, 10.0, 5.0, {}, False),
    ],
)
def test_coasts_that_are_too_coarse_are_said_to_be_so(west, south, side, keywords, said):
    grid = pv.ImageData(
        dimensions=(11, 11, 1), spacing=(side / 10, side / 10, 1), origin=(west, south, 0)
    )
    grid["t"] = grid.points[:, 0] * 2 + grid.points[:, 1] ** 2
    grid = cartography.in_degrees(grid)
    notes = vizlight.look(grid, size=SIZE, **keywords).notes
    assert any("too coarse for maps under 2220 km" in note for note in notes) == said


@pytest.mark.opengl
def test_values_of_single_points_of_a_map_are_seen():
    """Each has the share of the map that is nearest to its point."""
    mesh = chart(60, 40, unit="")
    known = np.zeros((16, 21), dtype=bool)
    known[2:-2:3, 2:-2:3] = True
    mesh["warmth"][~known.ravel()] = np.nan
    with contextlib.closing(vizlight.look(mesh, size=SIZE, cmap="autumn").plotter()) as plotter:
        picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :200]
    drawn = (picture[..., 0] > 200) & (picture[..., 2] < 60)
    grey = np.ptp(picture, axis=2) < 5
    share = drawn.sum() / (drawn.sum() + (grey & (picture[..., 0] < 240)).sum())
    assert share == pytest.approx(known.sum() / (15 * 20), rel=0.2)


def test_heights_of_stations_are_on_a_map_with_coasts():
    grid = chart(60, 40, name="elevation")
    stations = pv.PolyData(grid.points[::7])
    stations["elevation"] = grid["elevation"][::7]
    look = vizlight.look(cartography.in_degrees(stations), size=SIZE)
    assert look.array == "elevation"
    assert "coasts" in paths(look)


@pytest.mark.parametrize(("name", "is_warm"), [("sst", True), ("sst anomaly", False)])
def test_bands_of_a_warm_sea_are_unlike_the_grey_of_land(name, is_warm):
    sea = chart(60, 40, name=name)
    sea[name] += 285.0
    sea[name][:60] = np.nan
    look = vizlight.look(sea, size=SIZE)
    table = look.drawing.layers[0].keywords["cmap"]
    assert ("vizlight.heat" in table.arguments) == is_warm
    # The sea ends halfway between points with and without a value.
    assert np.isnan(look.drawing.layers[0].mesh.run()[name]).any()
