"""The ratio t on planes and domes, whose shadows are known; lengths have their truth elsewhere."""

import numpy as np
import pytest
from fields import sun
from vectors import unit

from vizlight.geometry import relief
from vizlight.geometry.relief import height_field

pytestmark = pytest.mark.usefixtures("each_code")


@pytest.mark.parametrize("depth", [1e-6, 0.1, 3.0])
def test_a_flat_field_has_the_cosine_exactly(depth):
    x, y = np.array([0, 1, 3, 3.5, 9]), np.arange(4.0) ** 2
    z = np.full((4, 5), 7.25)
    for way in (sun(90, 0), sun(50, 33), sun(3, 190), sun(0, 10), sun(-10, 0), (1e-9, 0, 1)):
        t = relief.shadow(x, y, z, depth=depth, direction=way)
        np.testing.assert_allclose(t, max(0, unit(way)[2]), atol=3e-9 if depth == 1e-6 else 1e-14)


@pytest.mark.parametrize("depth", [0.0, 1e-5, 0.2, 2.0])
def test_a_plane_has_the_cosine_for_every_depth(depth):
    """Where the ray leaves it before its border: toward the light it falls, or goes on."""
    x, y = np.linspace(0, 40, 81), np.linspace(0, 30, 101)
    z = 0.3 * x - 0.2 * y[:, None]
    n = unit([-0.3, 0.2, 1])
    inner = np.s_[35:65, 30:50]
    for way in (sun(50, 20), sun(35, 250), sun(25, 140), sun(80, 0)):
        t = relief.shadow(x, y, z, depth=depth, direction=way)
        np.testing.assert_allclose(t[inner], max(0, n @ way), atol=1e-9)


def test_two_parts_shade_by_the_sum_of_their_lengths():
    """A ray leaves one plateau through its top, and cuts the corner of a higher one (figure 2b)."""
    x, thin = np.array([0, 4, 4, 6, 6, 8, 8, 12.0]), 1e-9 * np.array([0, 0, 1, 0, 1, 0, 1, 0])
    z = np.repeat([[1, 1, 0, 0, 3, 3, 0, 0.0]], 2, axis=0)
    way, start = (2, 0, 1), [2.0, 0.5, 0.75]
    r = relief.inside_length(x + thin, [0.0, 1], z, start, direction=way)
    alone = relief.inside_length(x + thin, [0.0, 1], np.minimum(z, 1), start, direction=way)
    assert r == pytest.approx(2 * np.hypot(0.5, 0.25), abs=1e-7)
    assert alone == pytest.approx(np.hypot(0.5, 0.25), abs=1e-7)


def test_shallow_depth_goes_to_the_clamped_cosine():
    """A dome occludes nothing: t is the cosine or 0, for a small depth within depth / spacing."""
    for n in (101, 201):
        x = np.linspace(-2, 2, n)
        z = 1 - 0.2 * (x**2 + x[:, None] ** 2)
        slope = -0.4 * x
        normal = unit(
            np.stack(
                [
                    -np.broadcast_to(slope, (n, n)),
                    -np.broadcast_to(slope[:, None], (n, n)),
                    np.ones((n, n)),
                ],
                axis=-1,
            )
        )
        way = sun(30, 40)
        cosine = np.maximum(normal @ way, 0)
        inner = np.s_[5:-5, 5:-5]
        limit = relief.shadow(x, x, z, depth=0, direction=way, normals=normal)
        lit = cosine > 0.02
        np.testing.assert_allclose(limit[inner][lit[inner]], cosine[inner][lit[inner]], atol=1e-12)
        assert not limit[normal @ way <= 0].any()
        t = relief.shadow(x, x, z, depth=1e-6, direction=way, normals=normal)
        assert np.abs(t - cosine)[inner].max() < 1e-6 / (x[1] - x[0])
        np.testing.assert_allclose(t[inner][lit[inner]], cosine[inner][lit[inner]], atol=1e-9)


def test_where_nothing_is_in_the_way_t_is_the_cosine_of_the_normal(random):
    """Also on rough ground and on heights rounded to metres, whose cells have slopes of their own.

    A high sun passes over all that is behind the four cells.
    """
    x, y = np.cumsum(random.uniform(20, 40, 40)), np.cumsum(random.uniform(20, 40, 50))
    smooth = 150 * np.sin(x / 400) * np.cos(y[:, None] / 300)
    for z in (smooth, np.round(smooth), smooth + random.normal(0, 2, smooth.shape)):
        field = height_field.make(x, y, z, border="extend")
        normal = height_field.normals(field)
        for way in (sun(45, 315), sun(60, 100)):
            cosine = np.maximum(normal @ way, 0)
            for depth in (0.0, 1e-4, height_field.default_depth(field)):
                t = relief.shadow(x, y, z, depth=depth, direction=way)
                np.testing.assert_allclose(t, cosine, atol=1e-9)


@pytest.mark.parametrize("depth", [0.05, 0.2, 0.5])
def test_what_turns_away_is_dark_by_the_ratio_alone(depth):
    """A roof z = -2 |x| under a sun at 45 degrees: no rule of its own darkens its far side."""
    x = np.linspace(-3, 3, 601)
    z = np.tile(-2 * np.abs(x), (3, 1))
    way = np.array([1, 0, 1]) / np.sqrt(2)
    normal = np.array([-2, 0, 1]) / np.sqrt(5)
    t = relief.shadow(
        x, [-1, 0, 1], z, depth=depth, direction=way,
        normals=np.broadcast_to(normal, (3, 601, 3)),
    )[1]  # fmt: skip
    assert normal @ way < -0.3
    for i in (150, 250, 290):
        start = np.array([x[i], z[1, i]]) - depth * normal[[0, 2]]
        # The ray leaves through the near side of the roof, z = -2 x; behind a thin one it is out.
        inside = start[1] < -2 * abs(start[0])
        length = (-2 * start[0] - start[1]) / (3 * np.sqrt(0.5)) if inside else 0.0
        expected = 1.0 if length <= depth else depth / length
        assert t[i] == pytest.approx(expected, rel=1e-9)
    assert t[290] > t[150]
