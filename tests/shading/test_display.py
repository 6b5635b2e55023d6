"""Colours of data keep their chromaticity in any light; other colours fit a screen."""

import dataclasses

import numpy as np
import pytest

from vizlight import DepthCue, Light, Material, Scene
from vizlight.model import formulas
from vizlight.shading.display import (
    NO_DATA,
    displayable,
    exposed,
    exposure_of,
    for_colors,
    numerals,
    on_colors,
)


def test_light_on_colours_is_a_factor_from_three_tenths_to_one(random):
    colors = random.integers(0, 256, (40000, 3), dtype=np.uint8)
    light = random.uniform(0, 2, 40000)
    got = on_colors(colors, light)
    assert got.dtype == np.uint8
    expected = colors * np.minimum(np.maximum(light, 0.3), 1)[:, None]
    assert np.abs(got - expected).max() <= 0.5 + 1e-4
    np.testing.assert_array_equal(got[light >= 1], colors[light >= 1])


def test_chromaticity_of_bright_enough_colours_is_that_of_the_data(random):
    colors = random.integers(120, 256, (5000, 3), dtype=np.uint8)
    got = on_colors(colors, random.uniform(0, 3, 5000)).astype(float)
    apart = got / got.sum(1, keepdims=True) - colors / colors.sum(1, keepdims=True, dtype=float)
    assert np.abs(apart).max() < 0.01


def test_opacity_is_kept_and_points_without_light_are_grey():
    colors = np.array([[10, 20, 30, 40], [50, 60, 70, 80]], np.uint8)
    got = on_colors(colors, np.array([0.5, 2.0]), np.array([True, False]))
    np.testing.assert_array_equal(got, [[5, 10, 15, 40], [128, 128, 128, 80]])
    assert pytest.approx(NO_DATA) == (128 / 255,) * 3


def test_scene_for_colours_has_luma_and_no_highlight():
    scene = Scene(
        lights=[
            Light(direction=(1, 0, 0), color=(1, 0, 0), intensity=2),
            Light(position=(1, 0, 0), color="black"),
            Light.headlight(intensity=0.5),
        ],
        material=Material(ambient=0.1, color="tan", specular_color="red"),
        ambient_color=(0, 0, 1),
        depth_cue=DepthCue(cue=0.5, color=(0, 1, 0)),
    )
    plain = for_colors(scene)
    assert not plain.colored
    assert [light.intensity for light in plain.lights] == pytest.approx([0.4252, 0, 0.5], abs=1e-9)
    # Shadows are given for each light of an intensity.
    assert all(light.intensity > 0 for light in plain.lights)
    assert (plain.material.ambient, plain.material.specular) == (0.3, 0)
    assert plain.material.diffuse == scene.material.diffuse
    assert plain.ambient_intensity == pytest.approx(0.0722)
    assert plain.depth_cue.cue == pytest.approx(0.5 * 0.7152)
    bright = scene.replace(material=dataclasses.replace(scene.material, ambient=0.7))
    assert for_colors(bright).material.ambient == 0.7


def test_colours_above_white_keep_chromaticity(random):
    rgb = random.uniform(0, 1.8, (4000, 3))
    got = displayable(rgb)
    inside = rgb.max(axis=1) <= 1
    np.testing.assert_array_equal(got[inside], rgb[inside])
    np.testing.assert_allclose(got[~inside].max(axis=1), 1, rtol=1e-15)
    np.testing.assert_allclose(np.cross(got, rgb), 0, atol=1e-15)


def test_colours_are_brought_into_range_in_any_layout_and_however_bright():
    rgb = np.random.default_rng(0).random((4, 5, 3)) * 3
    expected = displayable(rgb)
    assert expected.max() == 1
    np.testing.assert_array_equal(displayable(np.asfortranarray(rgb)), expected)
    turned = displayable(rgb.transpose(1, 0, 2))
    np.testing.assert_array_equal(turned, expected.transpose(1, 0, 2))
    np.testing.assert_array_equal(displayable([np.inf, np.inf, -1]), [1, 1, 0])
    assert np.isnan(displayable([np.nan, 2, 0])).all()


def test_colours_to_bring_into_range_are_of_three_components():
    with pytest.raises(ValueError, match=r"rgb: expected an array of shape"):
        displayable([1.0, 2.0])
    with pytest.raises(TypeError, match="rgb"):
        displayable("red")


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ((682.1, 2543.0), ["682", "2540"]),
        ((287.2, 287.4), ["287.2", "287.4"]),
        ((799_500.0, 800_500.0), ["799500", "800500"]),
        ((-9.87e-7, 0.0, 1.35e7), ["-9.87e-07", "0", "1.35e+07"]),
        ((3.0, 3.0), ["3", "3"]),
    ],
)
def test_numbers_are_told_apart(numbers, words):
    assert numerals(numbers) == words


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_exposed_light_rises_smoothly_toward_white(dtype):
    light = np.linspace(0, 2, 4001).astype(dtype)
    shown = exposed(light, 1.25)
    assert shown.dtype == dtype
    below = 1.25 * light <= formulas.KNEE
    np.testing.assert_array_equal(shown[below], light[below] * dtype(1.25))
    assert np.all(np.diff(shown) >= -np.finfo(dtype).eps)
    assert 0.999 < shown.max() < 1
    # No kink: slopes of neighbours differ by little, and none exceeds the exposure.
    slopes = np.diff(exposed(np.linspace(0, 2, 4001), 1.25)) / (2 / 4000)
    assert np.abs(np.diff(slopes)).max() < 0.005
    assert slopes.max() < 1.25 + 1e-9
    # The bound that the formula states.
    gap = np.linspace(0, 1, 1001) - exposed(np.linspace(0, 1, 1001), 1.0)
    assert gap.min() == 0
    assert gap.max() == pytest.approx(0.0736, abs=1e-4)


def test_light_without_exposure_stays():
    light = np.array([0.2, 3.0])
    assert exposed(light, None) is light


def test_the_exposure_of_light_brings_its_seventieth_percentile_to_1(random):
    light = random.uniform(0.1, 0.9, 1001)
    exposure = exposure_of(np.append(light, [np.nan, np.inf]))
    assert np.percentile(exposure * light, 70) == pytest.approx(1)
    grey = np.repeat(light[:, np.newaxis], 3, axis=1)
    assert exposure_of(grey) == pytest.approx(exposure)
    assert exposure_of([0.0, 0.0]) == exposure_of([]) == 1.0
    with pytest.raises(ValueError, match=r"light: expected an array of shape \(N,\) or"):
        exposure_of([[1.0, 2.0]])
