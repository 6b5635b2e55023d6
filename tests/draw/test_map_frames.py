"""Frames of maps: round degrees in words, bars of round lengths, arrows, and nothing on data."""

import dataclasses
import math

import numpy as np
import pytest
import pyvista as pv

from vizlight.draw import map_frames
from vizlight.draw.map_frames import frame, graticule, ticks
from vizlight.mesh import charts, meaning
from vizlight.mesh.charts import chart
from vizlight.mesh.georeference import in_degrees
from vizlight.vtk import letters


def sheet(width, height, *, unit="degree", origin=(0, 0, 0)):
    grid = pv.ImageData(dimensions=(2, 2, 1), spacing=(width, height, 1), origin=origin)
    if unit:
        grid.field_data["unit"] = [unit]
    return grid


@pytest.mark.parametrize(
    ("low", "high", "size", "signs", "words"),
    [
        (-180, 180, 5, "EW", ["180°", "120°W", "60°W", "0°", "60°E", "120°E", "180°"]),
        (120, 300, 5, "EW", ["120°E", "150°E", "180°", "150°W", "120°W", "90°W", "60°W"]),
        (-90, 90, 5, "NS", ["90°S", "60°S", "30°S", "0°", "30°N", "60°N", "90°N"]),
        (52.37, 52.461, 0.003, "NS", ["52.38°N", "52.40°N", "52.42°N", "52.44°N", "52.46°N"]),
        (-0.01, 0.01, 0.001, "EW", ["0.01°W", "0.00°", "0.01°E"]),
    ],
)
def test_ticks_are_round_and_named(low, high, size, signs, words):
    assert [word for _, word in ticks(low, high, size, signs)] == words


def test_words_never_touch():
    random = np.random.default_rng(3)
    for _ in range(60):
        low = random.uniform(-180, 170)
        high = low + random.uniform(0.01, 360)
        size = (high - low) * random.uniform(0.01, 0.1)
        found = ticks(low, high, size, "EW")
        halves = [size * letters.width(word) / 2 for _, word in found]
        for (a, _), (b, _), one, other in zip(found, found[1:], halves, halves[1:], strict=False):
            assert b - a > one + other + 0.2 * size


def test_a_frame_of_degrees_is_around_the_data():
    made = frame(sheet(60, 40, origin=(-20, 30, 3)), 2.0)
    points = np.asarray(made.points, dtype=float)
    inside = (points[:, 0] > -20) & (points[:, 0] < 40) & (points[:, 1] > 30) & (points[:, 1] < 70)
    # Corners of the lines along the sides lie on them.
    assert not inside.any()
    assert set(points[:, 2]) == {3.0}
    west, east, south, north = made.bounds[:4]
    assert west < -20 - 2 * 2.0
    assert south < 30 - 2.0
    assert north == pytest.approx(70, abs=1.1)
    assert east < 40 + 2 * 2.0


def test_a_bar_has_a_round_length_of_at_most_a_quarter():
    made = frame(sheet(37_000, 20_000, unit="metre"), 900.0)
    bar = np.asarray(made.points, dtype=float)[:4]
    assert np.ptp(bar[:, 0]) == 5000
    assert bar[:, 1].max() < 0
    feet = frame(sheet(37_000, 20_000, unit="foot"), 900.0)
    assert np.ptp(np.asarray(feet.points, dtype=float)[:4, 0]) == pytest.approx(2000 / 0.3048)


def test_an_arrow_points_north_where_up_is_not():
    """The tip of the arrow is its farthest corner along y, whatever is up in the picture."""
    for up in [(1, 0), (-1, 0), (0.6, 0.8), (0, -1)]:
        made = frame(sheet(100, 20, unit=""), 2.0, up=up)
        head = np.asarray(made.points, dtype=float)[:4]
        tip = head[0] - head[1:].mean(axis=0)
        assert tip[1] > 0
        assert tip[0] == pytest.approx(0, abs=1e-6)
    assert frame(sheet(100, 20, unit=""), 2.0).n_points == 0


def test_degrees_that_no_unit_names():
    assert frame(sheet(20, 10, unit=""), 1.0).n_points == 0
    assert frame(in_degrees(sheet(20, 10, unit="")), 1.0).n_points > 100


def test_a_turned_frame_names_the_sides_as_they_run():
    """North to the right: the lower side has latitudes from the left, the left one longitudes."""
    upright = frame(sheet(20, 60, origin=(-70, -50, 0)), 2.0)
    turned = frame(sheet(20, 60, origin=(-70, -50, 0)), 2.0, up=(-1, 0))
    assert (turned.bounds[0], turned.bounds[1]) != (upright.bounds[0], upright.bounds[1])
    # Below in the picture is east of the map.
    assert turned.bounds[1] > -50 + 2.0
    assert turned.bounds[2] < -50 - 2 * 2.0
    assert turned.n_points > 100


def test_letters_without_height():
    with pytest.raises(ValueError, match="letters: expected"):
        frame(sheet(20, 10), 0.0)


def test_lines_are_thin_and_words_as_high_as_asked():
    assert map_frames.LINE < map_frames.GAP
    made = frame(sheet(1000, 500, unit="metre"), 30.0)
    word = np.asarray(made.points, dtype=float)[8 : -count("N") - 4]
    assert np.ptp(word[:, 1]) == pytest.approx(0.73 * 30, rel=0.1)


def count(word):
    return len(letters.triangles(word)[0])


def test_an_arrow_points_north_beside_a_bar():
    mesh = sheet(37_000, 20_000, unit="metre")
    head = np.asarray(frame(mesh, 900.0).points, dtype=float)[-count("N") - 4 : -count("N")]
    tip = head[0] - head[1:].mean(axis=0)
    assert tip[:2] == pytest.approx([0, 930], abs=1)
    assert head[:, 1].max() < mesh.bounds[2]
    assert head[:, 0].min() > mesh.bounds[1] - 3 * 900


def charted(west, east, south, north, step=1.0):
    """Return a map in the plane of the projection that suits it."""
    size = (round((east - west) / step) + 1, round((north - south) / step) + 1, 1)
    grid = pv.ImageData(dimensions=size, spacing=(step, step, 1), origin=(west, south, 3))
    return chart(in_degrees(grid))


def test_the_frame_of_a_cone_is_outside_of_it_and_has_words_along_two_sides():
    mesh = charted(-135, -45, 15, 60)
    size = 2e5
    made = frame(mesh, size)
    sheet = charts.sheet(mesh)
    points = np.asarray(made.points, dtype=float)
    assert set(points[:, 2]) == {3.0}
    # All but the inner corners of the border.
    earth = sheet.plane.inverse(points[:, :2])
    inside = (np.abs(earth[:, 0] + 90) < 44.9) & (earth[:, 1] > 15.1) & (earth[:, 1] < 59.9)
    assert not inside.any()
    west, east, south, north = np.array(made.bounds[:4]) - mesh.bounds[:4]
    assert west < -size
    assert south < -size
    assert 0 < north < 2 * size
    assert 0 < east < 3 * size


def test_meridians_and_parallels_are_where_they_are_named():
    mesh = charted(-135, -45, 15, 60)
    plane = charts.sheet(mesh).plane
    lines = graticule(mesh, 2e5)
    round_ones = set()
    for cell in lines.cell:
        earth = plane.inverse(np.asarray(cell.points, dtype=float)[:, :2])
        column = int(np.ptp(earth[:, 1]) < np.ptp(earth[:, 0]))
        # Points are of four bytes.
        assert np.ptp(earth[:, column]) < 1e-4
        round_ones.add((column, round(float(earth[:, column].mean()), 3)))
    assert round_ones >= {(0, -90.0), (0, -105.0), (1, 20.0), (1, 50.0)}
    assert graticule(sheet(60, 40), 2.0).n_lines == 0


def test_a_small_map_has_as_many_meridians_as_parallels():
    grid = pv.ImageData(dimensions=(4, 4, 1), spacing=(0.1, 0.1, 1), origin=(-79.1, -3.8, 0))
    projection = "+proj=lcc +lat_0=-3.6 +lat_1=-3.5 +lat_2=-3.7 +lon_0=-79"
    lines = graticule(chart(in_degrees(grid), projection=projection), 1e3)
    spans = [np.ptp(np.asarray(cell.points), axis=0) for cell in lines.cell]
    meridians = sum(bool(across < up) for across, up, _ in spans)
    assert meridians == 4


def test_a_map_around_a_pole_has_words_on_all_sides():
    mesh = charted(-180, 180, 60, 90)
    made = np.asarray(frame(mesh, 1.5e5).points, dtype=float)[:, :2]
    beyond = made[np.linalg.norm(made, axis=1) > 1.02 * mesh.bounds[1]]
    turns = np.unique(np.round(np.degrees(np.arctan2(*beyond.T)) / 30) % 12)
    assert len(turns) == 12


def test_maps_on_which_lengths_are_alike_have_a_bar():
    bars = {
        (6, 9, 45, 47): True, (-135, -45, 15, 60): False,
    }  # fmt: skip
    for bounds, has in bars.items():
        assert map_frames.has_bar(charted(*bounds)) == has
    assert map_frames.has_bar(sheet(10, 8))
    assert not map_frames.has_bar(sheet(60, 40))
    # 2 degrees of latitude are 222 km: the bar of 50 km is a quarter of 3 degrees at 46 north.
    corners = np.asarray(frame(charted(6, 9, 45, 47), 5e3).points, dtype=float)
    after = count("50 km") + 4 + count("N")
    assert np.ptp(corners[-after - 4 : -after, 0]) == pytest.approx(50e3)


@pytest.mark.parametrize("latitude", [0, 40, -60])
def test_the_bar_of_a_map_of_mercator_has_the_length_on_the_earth(latitude):
    """Mercator's lengths are those on the earth times the secant of the latitude."""
    north = 6371000 * math.asinh(math.tan(math.radians(latitude)))
    mesh = pv.ImageData(dimensions=(11, 9, 1), spacing=(1e3, 1e3, 1), origin=(5e4, north - 4e3, 0))
    mesh.field_data["unit"] = ["metre"]
    mesh.field_data["projection"] = ["+proj=merc +lon_0=0 +R=6371000"]
    corners = np.asarray(frame(mesh, 100.0).points, dtype=float)
    # A quarter of the width at the most, which is 10 km, 7.7 km and 5 km on the earth.
    length = 1e3 if latitude else 2e3
    after = count(f"{length / 1e3:g} km") + 4 + count("N")
    drawn = np.ptp(corners[-after - 4 : -after, 0])
    assert drawn * math.cos(math.radians(latitude)) == pytest.approx(length, rel=2e-3)


def test_a_map_with_corners_that_have_no_place_has_a_graticule(monkeypatch):
    """As the earth from a satellite, whose extent has corners that PROJ puts at infinity."""
    pytest.importorskip("rasterio")
    mesh = sheet(1.08e7, 1.08e7, unit="metre", origin=(-5.4e6, -5.4e6, 0))
    mesh.field_data["projection"] = ["+proj=geos +h=35785831 +lon_0=-75 +sweep=x +ellps=GRS80"]
    seen = charts.sheet(mesh)

    def forward(places):
        rows = seen.plane.forward(places)
        return np.where(np.isfinite(rows), rows, np.inf)

    plane = dataclasses.replace(seen.plane, forward=forward)
    monkeypatch.setattr(charts, "sheet", lambda _: dataclasses.replace(seen, plane=plane))
    assert graticule(mesh, 2e5).n_cells > 0


def test_a_chart_on_its_side_has_its_parallels_below():
    """North to the left: the words of parallels are east of the map, those of meridians north."""
    mesh = charted(-76, -68, -55, -18, 0.5)
    size = 5e4
    made = np.asarray(frame(mesh, size, up=(1, 0)).points, dtype=float)
    west, east, south, north = mesh.bounds[:4]
    assert made[:, 0].min() < west - size
    assert made[:, 0].max() < east + size
    beside = made[made[:, 0] < west - size]
    assert np.ptp(beside[:, 1]) > 0.5 * (north - south)


def framed(section, bounds, size, monkeypatch):
    """Return the words of the frame of a section, and the frame."""
    mesh, words = sheet(bounds[1] - bounds[0], bounds[3] - bounds[2], unit=""), []
    mesh.origin = (bounds[0], bounds[2], 0.0)
    meaning.attach(mesh, meaning.Meaning(scales=section))
    triangles = letters.triangles
    monkeypatch.setattr(letters, "width", lambda word: np.ptp(triangles(word)[0][:, 0]))
    monkeypatch.setattr(letters, "triangles", lambda word: words.append(word) or triangles(word))
    return words, frame(mesh, size)


def test_a_section_has_numbers_on_two_sides_and_what_they_are(monkeypatch):
    scales = [meaning.AxisScale("latitude"), meaning.AxisScale("depth", "m", -0.02)]
    words, made = framed(scales, (-60, 60, -100, 0), 6.0, monkeypatch)
    below, beside = words[:5], words[5:]
    assert below == ["60°S", "30°S", "0°", "30°N", "60°N"]
    assert beside == ["0", "1000", "2000", "3000", "4000", "5000", "depth (m)"]
    west, east, south, north = made.bounds[:4]
    # The title is beside the numbers.
    assert west < -60 - 6 * (letters.width("5000") + 0.73)
    assert south < -100 - 6
    assert (east, north) == pytest.approx((60, 0), abs=12)


@pytest.mark.parametrize(
    ("unit", "long", "expected"),
    [
        ("days since 2001-01-01", 1000, ["2001", "2002", "2003"]),
        ("hours since 2001-01-01 05:00", 12, ["06:00", "09:00", "12:00", "15:00", "2001-01-01"]),
        ("hours", 10, ["0", "2", "4", "6", "8", "10", "time (hours)"]),
    ],
)
def test_times_of_a_section_are_dates(unit, long, expected, monkeypatch):
    """Those of a day have this as their title; latitudes are where the section is stretched to."""
    scales = [meaning.AxisScale("time", unit), meaning.AxisScale("latitude", "degrees", long / 60)]
    words, _ = framed(scales, (0, long, -long / 2, long / 2), long / 25, monkeypatch)
    assert [word for word in words if "°" not in word] == expected
    assert [word for word in words if "°" in word] == [
        "30°S",
        "20°S",
        "10°S",
        "0°",
        "10°N",
        "20°N",
        "30°N",
    ]


def test_long_lengths_are_in_kilometres(monkeypatch):
    scales = [meaning.AxisScale("distance", "m", 1.0), meaning.AxisScale("height", "m", 0.1)]
    words, _ = framed(scales, (0, 6000, 0, 3000), 200.0, monkeypatch)
    assert words[:4] == ["0", "1000", "2000", "3000"]
    assert words[-3:] == ["30", "distance (m)", "height (km)"]


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (3.0, ["1", "2", "5", "10", "20", "50", "100", "200", "500", "1000"]),
        (5.0, ["1", "3", "10", "30", "100", "300", "1000"]),
        (8.0, ["1", "10", "100", "1000"]),
        (16.0, ["1", "100"]),
    ],
)
def test_pressures_by_their_logarithm_have_round_numbers(size, words, monkeypatch):
    scales = [
        meaning.AxisScale("longitude"),
        meaning.AxisScale("pressure", "hPa", -25.0, is_log=True),
    ]
    found, _ = framed(scales, (0.0, 100.0, -75.0, 0.0), size, monkeypatch)
    assert [word for word in found if "°" not in word] == [*words, "pressure (hPa)"]


@pytest.mark.parametrize("projected", [False, True])
def test_discs_of_points_are_within_the_frame(projected):
    points = in_degrees(pv.PolyData([(10.0, 50.0, 0.0), (13.0, 52.0, 0.0)]))
    points = chart(points) if projected else points
    x, y, _ = (frame(points, letters=points.length / 40).points - points.center).T
    half, high, _ = np.array(points.bounds_size) / 2
    # No corner of a part of the frame is in the box, nor beside it where discs reach.
    wide = 0.015 * 2 * max(half, high)
    assert not np.any((np.abs(x) < half + wide) & (np.abs(y) < high + wide))
    np.testing.assert_allclose(charts.box_of(pv.Plane()), pv.Plane().bounds[:4])


@pytest.mark.parametrize(
    ("places", "has_arrow"), [((-2, 2, 50, 52), True), ((20, 50, 68, 80), False)]
)
def test_an_arrow_is_drawn_where_all_meridians_run_along_it(places, has_arrow):
    west, east, south, north = places
    grid = pv.ImageData(
        dimensions=(31, 21, 1), spacing=((east - west) / 30, (north - south) / 20, 1),
        origin=(west, south, 0),
    )  # fmt: skip
    mesh = chart(in_degrees(grid), "+proj=stere +lat_0=90 +lon_0=0 +R=6371000")
    size = 0.02 * max(mesh.bounds_size)
    corners = np.asarray(frame(mesh, size).points, dtype=float)
    # Those of the arrow come before those of its word.
    head = corners[-count("N") - 4 : -count("N")]
    is_arrow = np.ptp(head[:, 1]) == pytest.approx(1.1 * size, rel=0.01)
    assert is_arrow == has_arrow


def test_lines_that_meet_no_side_of_their_own_have_words_at_another(monkeypatch):
    """On a grid turned by some 45 degrees parallels end below, where meridians do."""
    written = []
    word = map_frames._word
    monkeypatch.setattr(map_frames, "_word", lambda text, *rest, **of: (
        written.append(text), word(text, *rest, **of)
    )[1])  # fmt: skip
    plane = "+proj=stere +lat_0=90 +lon_0=0 +R=6371000"
    grid = pv.ImageData(dimensions=(41, 6, 1), spacing=(5e4, 5e4, 1), origin=(1e6, -2.0e6, 0))
    grid.field_data["unit"], grid.field_data["projection"] = ["metre"], [plane]
    frame(grid, 4e4)
    assert sum(text.endswith("°N") for text in written) > 1
    assert any(text.endswith("°E") for text in written)
