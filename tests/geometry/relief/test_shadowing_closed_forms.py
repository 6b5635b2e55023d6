"""The ratio t on planes, ridges and domes, whose shadows are known."""

import numpy as np
import pytest
from fields import sun, unit

from vizlight.geometry import relief

pytestmark = pytest.mark.usefixtures("each_code")


def between(lows, highs):
    """Return the length of a union of two intervals, empty where low > high."""
    (a, c), (b, d) = lows, highs
    one, two = np.maximum(b - a, 0), np.maximum(d - c, 0)
    both = np.maximum(np.minimum(b, d) - np.maximum(a, c), 0)
    return one + two - np.where((one > 0) & (two > 0), both, 0)


def ridge(x, height=1.0, slope=2.0):
    return np.maximum(height - slope * np.abs(x), 0)


def ridge_length(start, way, height=1.0, slope=2.0):
    """Return the length in the ground and in the wedge z < height - slope |x| above it."""
    x, z = start[..., 0], start[..., 2]
    ground = -z / way[2]
    low, high = np.full(x.shape, 0.0), np.full(x.shape, np.inf)
    for side in (1, -1):
        # z + s wz < height - side slope (x + s wx)
        rate, room = way[2] + side * slope * way[0], height - side * slope * x - z
        bound = room / rate
        if rate > 0:
            high = np.minimum(high, bound)
        else:
            low = np.maximum(low, bound)
    low = np.maximum(low, ground)
    return between((np.zeros_like(low), low), (ground, high))


@pytest.mark.parametrize("azimuth", [20, 75])
def test_ridge_has_its_closed_form(azimuth):
    x, y = np.linspace(-6, 3, 361), np.linspace(-3, 3, 121)
    z = np.broadcast_to(ridge(x), (121, 361))
    depth, way = 0.15, sun(22, azimuth)
    flat = np.abs(x) > 0.5 + 0.03
    start = np.stack([*np.meshgrid(x[flat], y), np.full((121, flat.sum()), -depth)], axis=-1)
    expected = np.minimum(depth / ridge_length(start, way), 1)
    t = relief.shadow(x, y, z, depth=depth, direction=way)[:, flat]
    assert expected.min() < 0.2
    assert np.abs(t - expected).max() < 1e-12


def ball_length(start, way, radius=1.0):
    """Return the length in the half-space z < 0 and in the ball about the origin."""
    ground = -start[..., 2] / way[2]
    middle = -(start @ way)
    inside = radius**2 - np.einsum("...i,...i", start, start) + middle**2
    half = np.sqrt(np.maximum(inside, 0))
    low, high = np.maximum(middle - half, 0), np.where(inside > 0, middle + half, -1)
    return between((np.zeros_like(low), low), (np.maximum(ground, 0), high))


def hemisphere(x, y):
    return np.sqrt(np.maximum(1 - x**2 - y**2, 0))


@pytest.mark.parametrize("b", [0.0, 0.6])
def test_hemisphere_on_a_plane_below_1e_6(b):
    """Nodes close up at the rim, where the slope has no bound; the order is 2."""
    rim, way, depth = np.sqrt(1 - b * b), sun(30, 0), 0.1
    errors = []
    for n in (1000, 2000, 4000, 8000):
        x = np.concatenate([[-9.0], -rim * np.cos(np.linspace(0, np.pi, n)), [9.0]])
        y = b + np.array([-1e-3, 0, 1e-3])
        z = hemisphere(x, y[:, None])
        ground = np.linspace(-3.5, -rim - 1e-2, 60)
        top = -rim * np.cos(np.linspace(0.05, np.pi - 0.05, 61))
        p = np.concatenate(
            [
                np.stack([ground, np.full(60, b), np.full(60, -depth)], axis=1),
                np.stack([top, np.full(61, b), hemisphere(top, b)], axis=1) * (1 - depth),
            ]
        )
        p[60:, 1] = b
        length = relief.inside_length(x, y, z, p, direction=way)
        t, expected = np.minimum(depth / np.array([length, ball_length(p, way)]), 1)
        errors.append(np.abs(t - expected).max())
    assert errors[-1] < 1e-6
    order = -np.polyfit(np.log([1, 2, 4, 8]), np.log(errors), 1)[0]
    assert order == pytest.approx(2, abs=0.2)


def test_second_order_on_a_smooth_field(random):
    """Against roots of the field itself along the ray, not of its cells."""

    def height(x, y):
        return 0.4 * np.sin(1.3 * x) * np.cos(1.1 * y) + 0.2 * np.sin(0.7 * x + y)

    way = sun(18, 35)
    start = random.uniform(3, 7, (120, 2))
    start = np.column_stack([start, height(*start.T) - 0.1])
    s = np.linspace(0, 4, 20_001)
    p = start[:, None] + s[:, None] * way
    f = height(p[..., 0], p[..., 1]) - p[..., 2]
    share = np.clip(np.maximum(f[:, :-1], f[:, 1:]) / np.abs(np.diff(f, axis=1)), 0, 1)
    expected = np.where((f[:, :-1] > 0) & (f[:, 1:] > 0), 1, share).sum(axis=1) * s[1]
    errors = []
    for n in (81, 161, 321, 641):
        x = np.linspace(0, 12, n)
        found = relief.inside_length(x, x, height(x, x[:, None]), start, direction=way)
        errors.append(np.median(np.abs(found - expected)))
    order = -np.polyfit(np.log([1, 2, 4, 8]), np.log(errors), 1)[0]
    assert order == pytest.approx(2, abs=0.2)


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


def test_shallow_depth_goes_to_the_clamped_cosine():
    """A dome occludes nothing: t is the cosine or 0; small depths come as near as cells allow."""
    errors = []
    for n in (101, 201):
        x = np.linspace(-2, 2, n)
        z = 1 - 0.2 * (x**2 + x[:, None] ** 2)
        slope = -0.4 * x
        normal = np.stack(
            [
                -np.broadcast_to(slope, (n, n)),
                -np.broadcast_to(slope[:, None], (n, n)),
                np.ones((n, n)),
            ],
            axis=-1,
        )
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        way = sun(30, 40)
        cosine = np.maximum(normal @ way, 0)
        inner = np.s_[5:-5, 5:-5]
        limit = relief.shadow(x, x, z, depth=0, direction=way, normals=normal)
        lit = cosine > 0.02
        np.testing.assert_allclose(limit[inner][lit[inner]], cosine[inner][lit[inner]], atol=1e-12)
        assert not limit[normal @ way <= 0].any()
        t = relief.shadow(x, x, z, depth=1e-6, direction=way, normals=normal)
        errors.append(np.abs(t - cosine)[inner].max())
    assert errors[1] < 0.01
    assert np.log2(errors[0] / errors[1]) > 0.8


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
