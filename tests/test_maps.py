"""The map of data: one lightness, one chroma, even steps for two kinds of readers."""

import matplotlib as mpl
import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight import maps
from vizlight.maps import even

COLORS = even(np.arange(256))[:, :3]
#: Viewing without green cones, on linear sRGB (Vienot, Brettel and Mollon 1999).
DEUTERANOPIA = np.array([[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]])


def linear(rgb):
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def cielab(light):
    """Return CIELAB, white D65, of linear sRGB."""
    m = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    x = light @ m.T / m.sum(axis=1)
    f = np.where(x > (6 / 29) ** 3, np.cbrt(x), x * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], 1)


def test_one_lightness_and_one_chroma():
    lightness, a, b = cielab(linear(COLORS)).T
    assert np.abs(lightness - 70).max() < 0.25
    assert np.abs(np.hypot(a, b) - 46).max() < 0.6
    hue = np.degrees(np.unwrap(np.arctan2(b, a))) % 360
    assert (hue[0], hue[-1]) == pytest.approx((275, 85), abs=1)


@pytest.mark.parametrize(
    ("cones", "p95", "most"), [("all", 0.005, 0.02), ("no green", 0.015, 0.04)]
)
def test_chromaticity_tells_the_value_in_any_light(cones, p95, most):
    error = misread(lambda rgb: shares(rgb if cones == "all" else without_green(rgb)))
    assert np.quantile(error, 0.95) < p95
    assert error.max() < most


def test_the_nearest_colour_of_the_bar_tells_the_value_in_any_light():
    error = misread(lambda rgb: cielab(linear(rgb)))
    assert np.quantile(error, 0.95) < 0.03
    assert error.max() < 0.06


def shares(rgb):
    return rgb / rgb.sum(axis=1, keepdims=True)


def without_green(rgb):
    seen = np.clip(linear(rgb) @ DEUTERANOPIA.T, 0, 1)
    return np.where(seen <= 0.0031308, 12.92 * seen, 1.055 * seen ** (1 / 2.4) - 0.055)


def misread(key):
    """Return errors, as shares of the range, of values in bytes of light from 0.3 to 1."""
    values = np.linspace(0, 255, 2000).round().astype(int)
    light = np.random.default_rng(3).uniform(0.3, 1, (2000, 1))
    seen = key(np.rint(255 * COLORS[values] * light) / 255)
    found = ((seen[:, None] - key(COLORS)) ** 2).sum(axis=-1).argmin(axis=1)
    return np.abs(found - values) / 255


def test_it_has_a_name_for_matplotlib_and_pyvista():
    np.testing.assert_array_equal(mpl.colormaps["vizlight.even"].colors, even.colors)
    table = pv.LookupTable("vizlight.even").values[:, :3]
    np.testing.assert_array_equal(table, np.rint(255 * COLORS).astype(np.uint8))


def test_heights_are_blue_below_0_and_lighter_toward_the_coast():
    table = maps.heights(-100.0, 300.0)
    colors = np.asarray(table.values, dtype=float)[:, :3]
    values = -100 + 400 * (np.arange(256) + 0.5) / 256
    sea, land = colors[values < 0], colors[values >= 0]
    assert (sea[:, 2] > sea[:, 0]).all()
    assert (land[:-8, 2] < land[:-8, 1]).all()
    assert (np.diff(sea @ (0.2, 0.7, 0.1)) > 0).all()
    # No dark colours, as a shadow dims them.
    assert (land @ (0.2126, 0.7152, 0.0722)).min() > 100
    only = np.asarray(maps.heights(10.0, 20.0).values)
    np.testing.assert_allclose(only[0, :3], land[0], atol=4)
    deep = np.asarray(maps.heights(-20.0, -10.0).values, dtype=float)
    assert (deep[:, 2] > deep[:, 0]).all()
    with pytest.raises(ValueError, match="high: expected a number above low=5, got 5"):
        maps.heights(5.0, 5.0)


@pytest.mark.parametrize("low", [-100.0, 0.0])
def test_a_level_sea_is_blue(low):
    table, usual = maps.heights(low, 300.0, level_sea=True), maps.heights(low, 300.0)
    blue, green = np.asarray(table.map_value(0.0))[[2, 1]]
    assert blue > green
    assert usual.map_value(0.0)[1] > usual.map_value(0.0)[2]
    # That step alone differs.
    differ = np.any(np.asarray(table.values) != np.asarray(usual.values), axis=1)
    assert np.flatnonzero(differ).tolist() == [int(-low / (300 - low) * 256)]


def test_bands_have_a_step_at_each_level_and_black_lines_are_seen_on_them():
    table = maps.bands([1.0, 2.0], (0.0, 3.0))
    colors = np.asarray(table.values)[:, :3] / 255
    light = cielab(linear(colors))
    assert light[:, 0].min() > 40
    jumps = np.linalg.norm(np.diff(light, axis=0), axis=1)
    at = (np.sort(np.argsort(jumps)[-2:]) + 1) / len(colors) * 3
    np.testing.assert_allclose(at, [1, 2], atol=3 / len(colors))
    assert len(np.unique(colors, axis=0)) == 3
    assert (table.scalar_range, table.nan_color.hex_rgb) == ((0.0, 3.0), maps.MISSING)


@pytest.mark.parametrize(
    ("limits", "middle"), [((-2.0, 2.2), 0.0), ((-1.4, 3.0), 0.0), ((-1.0, 3.0), 1.0)]
)
def test_bands_of_two_sides_have_their_middle_at_zero(limits, middle):
    table = maps.bands(np.linspace(*limits, 40), limits, "RdBu_r")
    values = limits[0] + np.ptp(limits) * (np.arange(table.n_values) + 0.5) / table.n_values
    lightest = values[np.argmax(cielab(linear(np.asarray(table.values)[:, :3] / 255))[:, 0])]
    assert lightest == pytest.approx(middle, abs=0.2)


test_bands_that_do_not_fit = refusals(
    maps.bands,
    ([1.0], (2.0, 2.0), "limits: expected a number above 2"),
    ([np.nan], (0.0, 1.0), "levels"),
)


@pytest.mark.parametrize(
    ("count", "cones", "least"),
    [(8, "all", 30), (8, "no green", 16), (16, "all", 19), (16, "no green", 10)],
)
def test_colours_of_kinds_are_muted_and_far_from_each_other(count, cones, least):
    rgb = maps.kinds(range(count)).values[:, :3] / 255
    light = cielab(linear(rgb))
    assert np.hypot(*light.T[1:]).max() < 36
    assert np.ptp(light[:8, 0]) < 32
    # From what is missing too.
    rgb = np.append(rgb, [mpl.colors.to_rgb(maps.MISSING)], axis=0)
    lab = cielab(linear(rgb if cones == "all" else without_green(rgb)))
    distances = np.linalg.norm(lab[:, np.newaxis] - lab, axis=2)
    assert distances[np.triu_indices(count + 1, 1)].min() > least


def test_kinds_have_the_colours_that_are_named():
    table = maps.kinds({1: "sea", 2: "land"}, colors={2: "#00ff00"})
    assert table.values[1].tolist() == [0, 255, 0, 255]
    assert table.values[0].tolist() == maps.kinds([1, 2]).values[0].tolist()
    with pytest.raises(ValueError, match="colors: expected a mapping of kinds to colours"):
        maps.kinds([1], colors={1: "no colour"})


def test_logarithmic_bands_have_classes_of_equal_ratios():
    table = maps.bands([10, 100], (1, 1000), logarithmic=True, below="#ffffff")
    colors = np.asarray(table.values)[:, :3]
    sizes = np.diff([0, *(1 + np.flatnonzero(np.diff(colors, axis=0).any(axis=1))), len(colors)])
    np.testing.assert_allclose(sizes, len(colors) / 3, atol=1)
    assert table.log_scale
    assert table.scalar_range == (1, 1000)
    assert table.below_range_color.hex_rgb == "#ffffff"
    with pytest.raises(ValueError, match="limits: expected positive numbers"):
        maps.bands([1], (0, 2), logarithmic=True)
    with pytest.raises(ValueError, match="below: expected a colour"):
        maps.bands([1], (0, 2), below="no colour")
