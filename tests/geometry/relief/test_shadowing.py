"""The ratio t of cos-theta shadows: laws that hold on any height field."""

import numpy as np
import pytest
from fields import hills, places, sun

from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, shadowing

pytestmark = pytest.mark.usefixtures("each_code")


def test_a_batch_is_a_loop_and_shapes_are_kept(random):
    x, y, z = hills(20)
    points = places(x, y, z, 24, random).reshape(2, 3, 4, 3)
    for light in ({"direction": sun(30, 10)}, {"position": (3, 3, 4)}):
        found = relief.inside_length(x, y, z, points, **light)
        assert found.shape == (2, 3, 4)
        one = [relief.inside_length(x, y, z, p, **light) for p in points.reshape(-1, 3)]
        np.testing.assert_allclose(found.ravel(), one, atol=1e-13)
    assert relief.inside_length(x, y, z, np.empty((0, 3)), direction=(0, 0, 1)).shape == (0,)
    odd = relief.inside_length(x, y, z, [[1, 1, np.nan], [1, 1, -1]], direction=(0, 0, 1))
    assert np.isnan(odd[0])
    slanted = relief.inside_length(x, y, z, [[np.nan, 1, 1], [1, 1, -np.inf]], direction=(9, 1, 1))
    assert np.all(np.isnan(slanted))
    assert odd[1] > 1


def test_mirrors_turns_and_scale():
    x, y, z = hills(40, 55)
    way = sun(20, 35)
    shade = {"depth": 0.2}
    t = relief.shadow(x, y, z, direction=way, **shade)
    mirrored = relief.shadow(-x[::-1], y, z[:, ::-1], direction=way * [-1, 1, 1], **shade)
    np.testing.assert_allclose(mirrored[:, ::-1], t, atol=1e-10)
    turned = relief.shadow(y, x, z.T, direction=way[[1, 0, 2]], **shade)
    np.testing.assert_allclose(turned.T, t, atol=1e-10)
    for scale in (1e-60, 1e60):
        big = relief.shadow(scale * x, scale * y, scale * z, direction=way, depth=0.2 * scale)
        np.testing.assert_allclose(big, t, atol=1e-10)


def test_far_from_the_origin_in_float32():
    """What float32 was given is kept: the same field near the origin has the same t."""
    x = (5e6 + 30 * np.arange(60)).astype(np.float32)
    y = (5.1e6 + 30 * np.arange(50)).astype(np.float32)
    z = (2000 + 300 * hills(60, 50)[2]).astype(np.float32)
    light = np.array([5e6 + 900.0, 5.1e6 + 400.0, 4000.0])
    for ray, moved in (
        ({"direction": sun(20, 60)}, {"direction": sun(20, 60)}),
        ({"position": light}, {"position": light - [5e6, 5.1e6, 0]}),
    ):
        t = relief.shadow(x, y, z, depth=40, **ray)
        near = relief.shadow(x.astype(float) - 5e6, y.astype(float) - 5.1e6, z, depth=40, **moved)
        np.testing.assert_allclose(t, near, atol=1e-9)


@pytest.mark.parametrize("normal", [np.zeros(3), [0, 0, np.nan], [np.inf, 0, 0]])
@pytest.mark.parametrize("depth", [0, 0.1])
def test_no_normal_no_light(normal, depth):
    x, y, z = hills(12, 9)
    normals = height_field.normals(height_field.make(x, y, z, border="extend"))
    options = {"depth": depth, "direction": sun(50, 30)}
    expected = relief.shadow(x, y, z, normals=normals, **options)
    expected[2, 3] = 0
    normals[2, 3] = normal
    given = normals.copy()
    np.testing.assert_array_equal(relief.shadow(x, y, z, normals=normals, **options), expected)
    np.testing.assert_array_equal(normals, given)


@pytest.mark.parametrize("far", [1e20, 1e200, 1e308])
@pytest.mark.parametrize("way", [(0, 0, 1), (-0.6, 0.5, 0.8)])
def test_a_light_far_away_is_a_direction(way, far):
    x, y, z = hills(12, 9)
    position = far * np.array(way)
    for depth in (0, 0.1):
        near, sunny = (
            relief.shadow(x, y, z, depth=depth, **light)
            for light in ({"position": position}, {"direction": way})
        )
        np.testing.assert_allclose(near, sunny, atol=1e-9)
    length = relief.inside_length(
        [0, 1], [0, 1], np.zeros((2, 2)), (0.5, 0.5, -1), position=(0.5, 0.5, far)
    )
    assert length == pytest.approx(1, abs=1e-12)


def test_a_light_on_the_surface():
    x, y, z = hills(20)
    light = (x[7], y[9], z[9, 7])
    t = relief.shadow(x, y, z, depth=0.1, position=light)
    assert t[9, 7] == pytest.approx(1, abs=1e-9)
    assert np.all((t >= 0) & (t <= 1))


@pytest.mark.sampled(3)
@pytest.mark.parametrize("depth", [0.0, 0.2])
@pytest.mark.parametrize("light", [{"direction": sun(25, 70)}, {"position": (4.0, 3.0, 9.0)}])
def test_rows_of_other_lengths_are_lit_like_a_field_of_their_own(light, depth):
    """Each row as if all had its length of a unit of x, as degrees of longitude have."""
    x, y, z = hills(30, 26)
    stretch = np.linspace(1.2, 0.3, len(y))
    field = height_field.make(x, y, z, border="extend", stretch=stretch)
    t = shadowing.ratio(field, height_field.normals(field), depth, **light)
    key, (along, *others) = next((key, way) for key, way in light.items())
    for row, length in enumerate(stretch):
        way = (along * length if key == "position" else along, *others)
        expected = relief.shadow(length * x, y, z, depth=depth, **{key: way})[row]
        np.testing.assert_allclose(t[row], expected, atol=1e-10)
