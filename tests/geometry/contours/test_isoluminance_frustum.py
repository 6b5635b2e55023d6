"""Rulings of a truncus against 50 digits; a near light against the law and a closed form."""

import banded
import numpy as np
import pytest
from refusals import refusals

from vizlight.geometry.contours.isoluminance import truncus

SHAPES = {
    "cylinder": (2.0, (0.5, 0.5)),
    "cone up": (1.5, (0.0, 0.7)),
    "cone down": (1.5, (0.7, 0.0)),
    "frustum": (1.0, (0.3, 0.8)),
    "disc": (0.01, (1.0, 1.0)),
    "rod": (50.0, (0.1, 0.1)),
}
AXIS = np.array([0.3, -0.2, 0.9])
AXIS /= np.linalg.norm(AXIS)


def made(shape, **options):
    height, radii = SHAPES[shape]
    return truncus((0, 0, 0), AXIS, radii, height=height, ambient=0.1, diffuse=0.8, **options)


def normals(points, shape):
    height, radii = SHAPES[shape]
    along = points @ AXIS
    across = points - np.outer(along, AXIS)
    size = np.linalg.norm(across, axis=1, keepdims=True)
    across = across / np.where(size > 0, size, 1)
    normal = across * height + (radii[1] - radii[0]) * AXIS
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def onto(points, patch, shape):
    """Return places of polygons on the true surface, and the normals there."""
    height, radii = SHAPES[shape]
    along = points @ AXIS
    across = points - np.outer(along, AXIS)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
    radius = (radii[0] + radii[1]) / 2 + (radii[0] - radii[1]) / height * along
    side = np.outer(along, AXIS) + radius[:, None] * across
    on = np.where((patch == 0)[:, None], side, points)
    normal = normals(side, shape)
    normal[patch == 1], normal[patch == 2] = AXIS, -AXIS
    return on, normal


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    "direction", [(1, -2, 0.5), (0.3, -0.2, 0.9), (-0.3, 0.2, -0.9), (2, 3, 0)]
)
def test_bands_of_a_far_light(shape, direction, random):
    bands = made(shape, direction=direction, levels=9)
    assert banded.is_closed(bands)
    place, polygon = banded.places(bands, random, 8)
    on, normal = onto(place, bands.patch[polygon], shape)
    error = np.abs(banded.lambert(on, normal, direction=direction) - bands.values[polygon])
    assert error.max() <= bands.error + 1e-12
    ends = bands.patch[polygon] > 0
    assert error[ends].max() < 1e-14
    assert banded.volume(bands) > 0


@pytest.mark.sampled(4)
@pytest.mark.parametrize("shape", ["cylinder", "cone up", "cone down", "frustum", "disc"])
@pytest.mark.parametrize(
    "light",
    [
        {"position": (1.5, -1.0, 0.8)},
        {"position": (1.5, -1.0, 0.8), "attenuation": (0.2, 0.3, 0.4)},
        {"position": (0.2, -0.1, 3.0), "power": 8.0},
    ],
)
def test_curves_of_a_near_light(shape, light, random):
    bands = made(shape, levels=8, **light)
    assert banded.is_closed(bands)
    place, polygon = banded.places(bands, random)
    on, normal = onto(place, bands.patch[polygon], shape)
    error = np.abs(banded.lambert(on, normal, **light) - bands.values[polygon])
    # Chords between exact contour points add at most a tenth of half a step almost everywhere.
    assert np.quantile(error, 0.999) <= 1.15 * bands.steps.error
    assert error.max() <= 1.5 * bands.steps.error


def test_terminator_of_a_near_light_is_a_ruling():
    bands = truncus((0, 0, 0), (0, 0, 2), (0.5, 0.5), position=(3, 0, 0.2), levels=4)
    on = np.unique(bands.lines[bands.line_levels == 0])
    x = bands.points[on][np.abs(bands.points[on][:, 2]) < 0.99, 0]
    np.testing.assert_allclose(x, 0.25 / 3, atol=1e-12)


def test_the_sources_approximation_falls_with_distance():
    """Rulings seen from the centre against the near light: first order in size / distance."""
    worst = []
    for distance in (8.0, 16.0, 32.0, 64.0):
        position = distance * np.array([1.0, -0.6, 0.7]) / np.linalg.norm([1.0, -0.6, 0.7])
        bands = made("frustum", position=position, method="rulings", levels=400)
        place, polygon = banded.places(bands, np.random.default_rng(3), 20)
        on, normal = onto(place, bands.patch[polygon], "frustum")
        error = np.abs(banded.lambert(on, normal, position=position) - bands.values[polygon])
        worst.append(error.max() - bands.steps.error)
    order = np.log2(np.array(worst[:-1]) / worst[1:])
    np.testing.assert_allclose(order, 1, atol=0.2)


@pytest.mark.parametrize(
    ("radii", "height", "cells", "area"),
    [
        ((0.0, 0.0), 1.0, False, 0.0),
        ((0.0, 0.0), 0.0, False, 0.0),
        ((1.0, 1.0), 0.0, True, 2 * np.pi),
        ((1.0, 0.0), 0.0, True, 2 * np.pi),
        ((0.5, 1.0), 0.0, True, 2 * np.pi),
    ],
)
@pytest.mark.parametrize("light", [{"direction": (1, 0, 1)}, {"direction": (0, 0, 1)},
                                   {"position": (1, 0, 1)}])  # fmt: skip
def test_degenerate_shapes(radii, height, cells, area, light):
    bands = truncus((0, 0, 0), (0, 0, 1), radii, height=height, segments=200, levels=5, **light)
    assert (len(bands.values) > 0) == cells
    assert np.isfinite(bands.points).all()
    assert np.isfinite(bands.values).all()
    if cells:
        assert banded.area(bands) == pytest.approx(area, rel=2e-3)
        assert banded.is_closed(bands)


@pytest.mark.parametrize("size", [1e-150, 1e150])
@pytest.mark.parametrize("method", ["rulings", "curves"])
def test_any_scale(size, method):
    options = {"levels": 4, "method": method}
    bands = truncus(
        (0, 0, 0), (0, 0, size), (0.2 * size, 0.5 * size), position=(3 * size, 0, size), **options
    )
    unit = truncus((0, 0, 0), (0, 0, 1), (0.2, 0.5), position=(3, 0, 1), **options)
    np.testing.assert_allclose(bands.points / size, unit.points, atol=1e-9)
    np.testing.assert_allclose(bands.values, unit.values, atol=1e-9)


def test_an_allowed_error():
    """Contours of a far light are exact: the smallest count, without a share for chords."""
    bands = truncus((0, 0, 0), (0, 0, 1), (0.5, 0.5), direction=(1, 0, 0), levels=0.05)
    assert len(bands.steps.edges) == 11
    assert bands.error == pytest.approx(0.05)
    near = truncus((0, 0, 0), (0, 0, 1), (0.5, 0.5), position=(2, 0, 0), levels=0.02)
    assert near.error <= 0.02


test_bad_input = refusals(
    lambda arguments, options: truncus(*arguments, direction=(0, 0, 1), **options),
    (((0, 0, 0), (0, 0, 0), (1, 1)), {}, "axis: expected a vector of non-zero length"),
    (((0, 0, 0), (0, 0, 1), (1, -1)), {}, "radii: expected"),
    (((0, 0, 0), (0, 0, 1), (1, 1, 1)), {}, "radii: expected two radii"),
    (((0, 0, 0), (0, 0, 1), (1, 1)), {"height": -1}, "height: expected"),
    (((0, 0, 0), (0, 0, 1), (1, 1)), {"method": "lines"}, "method: expected 'rulings'"),
)


@pytest.mark.parametrize("far", [1e20, 1e200, 1e308])
def test_a_light_far_away_is_a_direction(far):
    """The first end is the brightest: its value is a plain dot product."""
    solid = (0, 0, 0), (0, 0, 1), (1, 0.5)
    way = np.array([0, 0.3, 1])
    near, sunny = (
        truncus(*solid, levels=0.05, **light)
        for light in ({"position": far * way}, {"direction": way})
    )
    assert near.values.max() == pytest.approx(sunny.values.max(), abs=0.05)
    assert near.steps.edges[-1] == pytest.approx(way[2] / np.hypot(0.3, 1), abs=1e-9)
