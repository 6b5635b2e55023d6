"""Circles on a sphere: contours against 50 digits, bands against the law itself."""

import math

import banded
import numpy as np
import pytest
from refusals import refusals

from vizlight import Light, View
from vizlight.geometry.contours.isoluminance import sphere, virtual_light

LIGHTS = {
    "far": {"direction": (1, -2, 0.5)},
    "near": {"position": (0.3, 1.2, -0.4)},
    "close": {"position": (0.0, 0.0, 1.0 + 1e-6)},
    "fading": {"position": (0.3, 1.2, -2), "attenuation": (0.5, 0.3, 0.2)},
    "highlight": {"direction": (1, 1, 1), "power": 40.0},
    "sharp": {"direction": (1, 1, 1), "power": 1e5},
}


def many(points, **light):
    """The law at many points of the unit sphere."""
    normal = points / np.linalg.norm(points, axis=1, keepdims=True)
    return banded.lambert(normal, normal, **light)


def made(light, **options):
    return sphere((0, 0, 0), 1.0, ambient=0.1, diffuse=0.8, **LIGHTS[light], **options)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("count", [1, 5, 40])
def test_bands_are_closed_and_right_everywhere(light, count, random):
    bands = made(light, levels=count)
    assert banded.is_closed(bands)
    place, polygon = banded.places(bands, random)
    error = np.abs(many(place, **LIGHTS[light]) - bands.values[polygon])
    assert error.max() <= bands.error * (1 + 1e-9)
    assert bands.error <= bands.steps.error * 1.06
    assert error.max() > 0.8 * bands.steps.error
    dark = bands.band[polygon] == 0
    assert np.all(bands.values[polygon[dark]] == 0.1)
    assert np.all(np.unique(bands.band) == np.arange(count + 1))


def test_volume_and_area_converge(random):
    missing = []
    for segments in (24, 48, 96):
        bands = made("near", levels=6, segments=segments)
        missing.append(4 / 3 * np.pi - banded.volume(bands))
        assert 0 < 4 * np.pi - banded.area(bands) < 30 * np.pi / segments**2 * 4
    order = np.log2(np.array(missing[:-1]) / missing[1:])
    np.testing.assert_allclose(order, 2, atol=0.2)


@pytest.mark.parametrize("distance", [1.0 + 1e-9, 1.5, 10.0, 1e8])
def test_terminator_of_a_near_light(distance):
    bands = sphere((0, 0, 0), 1.0, position=(0, 0, distance), levels=4)
    terminator = bands.points[np.unique(bands.lines[bands.line_levels == 0])]
    np.testing.assert_allclose(terminator[:, 2], 1 / distance, atol=1e-15)


@pytest.mark.parametrize("error", [0.2, 0.05, 0.01, 0.003])
@pytest.mark.parametrize("light", ["far", "near", "highlight"])
def test_an_allowed_error_is_kept_by_few_steps(light, error, random):
    bands = made(light, levels=error)
    place, polygon = banded.places(bands, random)
    assert np.abs(many(place, **LIGHTS[light]) - bands.values[polygon]).max() <= error
    assert bands.error <= error
    n = len(bands.steps.edges) - 1
    span = bands.steps.edges[-1] - 0.1
    # With one step less the error exceeds 95 % of it; the rest is reserved for chords.
    assert n == 1 or span / (n - 1) / 2 > 0.95 * error


@pytest.mark.parametrize("position", [(0.5, 0, 0), (0, 0, 0), (1.0, 0, 0)])
def test_no_light_from_within(position):
    bands = sphere((0, 0, 0), 1.0, position=position, ambient=0.2)
    assert np.all(bands.values == 0.2)
    assert np.all(bands.band == 0)
    assert banded.is_closed(bands)
    assert len(bands.lines) == 0


@pytest.mark.parametrize("size", [1e-150, 1e-8, 1.0, 1e150])
def test_any_scale(size):
    bands = sphere((0, 0, 0), size, position=(0, 3 * size, 0), levels=5)
    unit = sphere((0, 0, 0), 1.0, position=(0, 3, 0), levels=5)
    np.testing.assert_allclose(bands.points / size, unit.points, atol=1e-14)
    np.testing.assert_array_equal(bands.band, unit.band)


def test_far_from_the_origin_and_of_any_type(dtype):
    center = np.array([5e6, -5e6, 0], dtype)
    bands = sphere(center, dtype(2), position=center + np.array([0, 4, 0], dtype), levels=4)
    unit = sphere((0, 0, 0), 1.0, position=(0, 2, 0), levels=4)
    np.testing.assert_allclose((bands.points - center) / 2, unit.points, atol=2e-9)
    assert bands.points.dtype == np.float64


def test_a_sphere_of_radius_0_has_no_cells():
    bands = sphere((1, 2, 3), 0, direction=(0, 0, 1))
    assert len(bands.points) == len(bands.values) == len(bands.lines) == 0


def test_virtual_light_is_exact_for_the_half_vector(random):
    light, eye = np.array([1.0, 0.2, 0.4]), np.array([-0.3, 0.9, 0.5])
    toward = virtual_light((0, 0, 0), light=light, eye=eye)
    bands = sphere((0, 0, 0), 1.0, direction=toward, power=30.0, levels=12)
    point = bands.points[bands.lines[:, 0]]
    unit = [v / np.linalg.norm(v) for v in (light, eye)]
    half = (unit[0] + unit[1]) / np.linalg.norm(unit[0] + unit[1])
    lit = bands.line_levels > 0
    np.testing.assert_allclose((point[lit] @ half) ** 30, bands.line_levels[lit], rtol=1e-12)


def test_virtual_light_of_lights_and_views():
    direct = virtual_light((1, 0, 0), light=(0, 1, 0), eye=(0, 0, 1))
    np.testing.assert_allclose(direct, np.array([0, 1, 1]) / math.sqrt(2))
    placed = virtual_light((1, 0, 0), light=Light(position=(1, 5, 0)), eye=View(position=(1, 0, 9)))
    np.testing.assert_allclose(placed, direct)
    parallel = View(position=(5, 5, 5), direction=(0, 0, 2), parallel=True)
    np.testing.assert_allclose(
        virtual_light((1, 0, 0), light=Light(direction=(0, 3, 0)), eye=parallel), direct
    )
    eye = View(position=(1, 0, 9))
    headlight = virtual_light((1, 0, 0), light=Light.headlight(), eye=eye)
    np.testing.assert_allclose(headlight, (0, 0, 1))
    with pytest.raises(ValueError, match="eye: expected an eye that is not opposite"):
        virtual_light((0, 0, 0), light=(0, 0, 1), eye=(0, 0, -1))


test_bad_input = refusals(
    lambda options: sphere((0, 0, 0), 1.0, **options),
    ({}, "direction: expected either direction="),
    ({"direction": (0, 0, 1), "position": (0, 0, 2)}, "got both"),
    ({"direction": (0, 0, 0)}, "direction"),
    ({"direction": (0, 1)}, "direction: expected 3 components"),
    ({"direction": (0, 0, np.nan)}, "direction: expected finite"),
    ({"direction": "up"}, "direction: expected", TypeError),
    ({"direction": (0, 0, 1), "attenuation": (1, 1, 0)}, "attenuation: expected a"),
    ({"direction": (0, 0, 1), "power": -1}, "power: expected"),
    ({"direction": (0, 0, 1), "segments": 2}, "segments: expected an integer"),
    ({"direction": (0, 0, 1), "levels": 0}, "levels: expected"),
)


def test_bad_shapes():
    with pytest.raises(ValueError, match="radius: expected"):
        sphere((0, 0, 0), -1.0, direction=(0, 0, 1))
    with pytest.raises(ValueError, match="center: expected 3 components"):
        sphere((0, 0), 1.0, direction=(0, 0, 1))
