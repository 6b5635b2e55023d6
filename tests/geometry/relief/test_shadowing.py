"""Length inside a height field against closed forms and quadrature; laws of t = d/r."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, marching, sweeping

METHODS = ("fast", "exact")


def unit(v):
    v = np.asarray(v, dtype=float)
    return v / np.linalg.norm(v)


def sun(elevation, azimuth):
    """Return a direction from angles in degrees, azimuth from x toward y."""
    e, a = np.radians([elevation, azimuth])
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def hills(n=60, ny=None, seed=3, size=10.0):
    """Return a smooth random field on uneven nodes."""
    random = np.random.default_rng(seed)
    x = np.sort(np.append(random.uniform(0, size, n - 2), [0, size]))
    y = np.sort(np.append(random.uniform(0, size, (ny or n) - 2), [0, size]))
    z = np.zeros((len(y), len(x)))
    for _ in range(12):
        a, b = random.uniform(0, size, 2)
        z += random.uniform(0.2, 1) * np.exp(-((x - a) ** 2 + (y[:, None] - b) ** 2))
    return x, y, z


def quadrature(x, y, z, start, way, reach, steps=100_000, base=-np.inf, wall=False):
    """Return the length inside by sampling one ray: no cells, no roots."""
    if way[2] > 0:
        # Above the highest point there is nothing to be in.
        reach = min(reach, max((z.max() - start[2]) / way[2], 1e-9))
    surface = RegularGridInterpolator((y, x), z)
    s = (np.arange(steps) + 0.5) * reach / steps
    p = start + s[:, None] * way
    beside = np.stack([np.clip(p[:, 1], y[0], y[-1]), np.clip(p[:, 0], x[0], x[-1])], axis=1)
    inside = (p[:, 2] < surface(beside)) & (p[:, 2] > base)
    if wall:
        inside &= (p[:, 0] > x[0]) & (p[:, 0] < x[-1]) & (p[:, 1] > y[0]) & (p[:, 1] < y[-1])
    return np.count_nonzero(inside) * reach / steps


def places(x, y, z, count, random, below=0.4):
    i, j = random.integers(0, len(x), count), random.integers(0, len(y), count)
    jitter = random.uniform(-0.3, 0.3, (count, 2))
    return np.column_stack([x[i], y[j], z[j, i] - random.uniform(0, below, count)]) + np.pad(
        jitter, [(0, 0), (0, 1)]
    )


@pytest.mark.parametrize("border", ["extend", "wall"])
@pytest.mark.parametrize("base", [None, -0.25])
def test_exact_length_is_that_of_ray_marching(border, base, random):
    """Uneven nodes, places beside and below the field, light high, low, along an axis, below."""
    x, y, z = hills(25, 31)
    points = places(x, y, z, 12, random)
    low = -np.inf if base is None else base
    for way in (sun(40, 30), sun(8, 200), sun(25, 90), sun(0, 77), sun(90, 0), sun(-20, 140)):
        if way[2] <= 0 and base is None and border == "extend":
            continue
        found = relief.inside_length(
            x, y, z, points, direction=3 * way, base=base, border=border, method="exact"
        )
        for point, length in zip(points, found, strict=True):
            reach = 40.0
            expected = quadrature(x, y, z, point, way, reach, base=low, wall=border == "wall")
            if np.isinf(length):
                assert expected > 20
            else:
                assert length == pytest.approx(expected, abs=2.5e-3)


@pytest.mark.parametrize("method", METHODS)
def test_length_to_a_near_light_is_that_of_ray_marching(method, random):
    x, y, z = hills(25, 31)
    light = np.array([7.0, 3.0, 2.5])
    points = places(x, y, z, 30, random)
    found = relief.inside_length(x, y, z, points, position=light, method=method)
    for point, length in zip(points, found, strict=True):
        reach = np.linalg.norm(light - point)
        expected = quadrature(x, y, z, point, unit(light - point), reach)
        assert length == pytest.approx(expected, abs=2e-4)


def test_large_squares_change_nothing(random):
    """Every cell one by one, and 2^l x 2^l at once, to rounding."""
    x, y, z = hills(70, 41)
    field = height_field.make(x, y, z, base=None, border="extend")
    start = (places(x, y, z, 2000, random) - field.origin).T
    way = np.repeat(sun(12, 215)[:, None], 2000, axis=1)
    reach = np.full(2000, marching.FAR)
    one, many = (marching.march(field, start, way, reach, coarse=c) for c in (False, True))
    np.testing.assert_allclose(one, many, atol=64 * 2.2e-16 * 10)
    assert one.max() > 3


@pytest.mark.parametrize("border", ["extend", "wall"])
def test_fast_rays_may_start_anywhere(border, random):
    """Far beside and below the field, above it, light at any height."""
    x, y, z = hills(40, 30)
    points = random.uniform([-6, -6, -6], [16, 16, 3], (500, 3))
    for way in (sun(12, 20), sun(70, 110), sun(30, 200), sun(45, 305), sun(5, 0), sun(60, 90)):
        fast, exact = (
            relief.inside_length(x, y, z, points, direction=way, border=border, method=method)
            for method in METHODS
        )
        assert np.all(np.isfinite(fast))
        assert np.median(np.abs(fast - exact)) < 2e-3
        assert np.mean(np.abs(fast - exact)) < 0.1


@pytest.mark.parametrize("border", ["extend", "wall"])
def test_bands_of_profiles_change_nothing(border, monkeypatch):
    """One band for all rays, or many narrow ones; holes and uneven nodes."""
    x, y, z = hills(32, 26)
    z[10:14, 20:26] = np.nan
    for way in (sun(12, 20), sun(9, 110), sun(15, 200), sun(14, 305), sun(8, 0), sun(10, 90)):
        field = height_field.make(x, y, z, base=None, border=border)
        profiles = sweeping.profiles(field, way, 0.2)
        assert profiles.count > 10 * sweeping.NARROW
        one = relief.shadow(x, y, z, depth=0.2, direction=way, border=border)
        with monkeypatch.context() as patch:
            patch.setattr(sweeping, "BAND", 1)
            assert profiles.width(z.size) == sweeping.NARROW
            many = relief.shadow(x, y, z, depth=0.2, direction=way, border=border)
        np.testing.assert_allclose(many, one, atol=1e-13)


def test_levels_are_followed_as_by_single_columns(random):
    """Rays through random profiles, in uneven columns, against a loop over segments."""
    x = np.sort(random.uniform(0, 30, 70))
    z = np.repeat(random.uniform(0, 3, (1, 70)), 5, axis=0)
    way = sun(6, 0)
    start = np.column_stack(
        [random.uniform(x[0], x[-1], 300), np.full(300, 2.0), random.uniform(-2, 3, 300)]
    )
    field = height_field.make(x, np.arange(5.0), z, base=None, border="extend")
    assert sweeping.profiles(field, way, 2.0) is not None
    found = relief.inside_length(x, np.arange(5.0), z, start, direction=way)
    edge = np.append(x, x[-1] + 100)
    for (a, _, c), length in zip(start, found, strict=True):
        s = np.sort(np.append(edge[edge > a], a))
        f = np.interp(s, x, z[0]) - (c + (s - a) * way[2] / way[0])
        high, low = np.maximum(f[:-1], f[1:]), np.minimum(f[:-1], f[1:])
        share = np.clip(high / np.where(high > low, high - low, 1), 0, 1)
        expected = np.where(low >= 0, 1, share) @ np.diff(s) / way[0]
        assert length == pytest.approx(expected, abs=1e-9)


def test_a_batch_is_a_loop_and_shapes_are_kept(random):
    x, y, z = hills(20)
    points = places(x, y, z, 24, random).reshape(2, 3, 4, 3)
    for light in ({"direction": sun(30, 10)}, {"position": (3, 3, 4)}):
        found = relief.inside_length(x, y, z, points, method="exact", **light)
        assert found.shape == (2, 3, 4)
        one = [
            relief.inside_length(x, y, z, p, method="exact", **light) for p in points.reshape(-1, 3)
        ]
        np.testing.assert_allclose(found.ravel(), one, atol=1e-13)
    assert relief.inside_length(x, y, z, np.empty((0, 3)), direction=(0, 0, 1)).shape == (0,)
    odd = relief.inside_length(x, y, z, [[1, 1, np.nan], [1, 1, -1]], direction=(0, 0, 1))
    assert np.isnan(odd[0])
    slanted = relief.inside_length(x, y, z, [[np.nan, 1, 1], [1, 1, -np.inf]], direction=(9, 1, 1))
    assert np.all(np.isnan(slanted))
    assert odd[1] > 1


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("depth", [1e-6, 0.1, 3.0])
def test_a_flat_field_has_the_cosine_exactly(method, depth):
    x, y = np.array([0, 1, 3, 3.5, 9]), np.arange(4.0) ** 2
    z = np.full((4, 5), 7.25)
    for way in (sun(90, 0), sun(50, 33), sun(3, 190), sun(0, 10), sun(-10, 0), (1e-9, 0, 1)):
        t = relief.shadow(x, y, z, depth=depth, direction=way, method=method)
        np.testing.assert_allclose(t, max(0, unit(way)[2]), atol=3e-9 if depth == 1e-6 else 1e-14)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("depth", [0.0, 1e-5, 0.2, 2.0])
def test_a_plane_has_the_cosine_for_every_depth(method, depth):
    """Where the ray leaves it before its border: toward the light it falls, or goes on."""
    x, y = np.linspace(0, 40, 81), np.linspace(0, 30, 101)
    z = 0.3 * x - 0.2 * y[:, None]
    n = unit([-0.3, 0.2, 1])
    inner = np.s_[35:65, 30:50]
    for way in (sun(50, 20), sun(35, 250), sun(25, 140), sun(80, 0)):
        t = relief.shadow(x, y, z, depth=depth, direction=way, method=method)
        np.testing.assert_allclose(t[inner], max(0, n @ way), atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_a_plane_under_a_near_light_has_the_cosine_seen_from_below_the_surface(method):
    x = np.linspace(-5, 5, 41)
    light, depth = np.array([1.0, -0.5, 2.0]), 0.3
    t = relief.shadow(x, x, np.zeros((41, 41)), depth=depth, position=light, method=method)
    gap = light - np.stack([*np.meshgrid(x, x), np.full((41, 41), -depth)], axis=-1)
    np.testing.assert_allclose(t, gap[..., 2] / np.linalg.norm(gap, axis=-1), atol=1e-14)


def test_a_light_very_far_is_one_at_infinity():
    x, y, z = hills(30)
    way = sun(20, 130)
    near = relief.shadow(x, y, z, depth=0.2, position=1e9 * way, method="exact")
    far = relief.shadow(x, y, z, depth=0.2, direction=way, method="exact")
    np.testing.assert_allclose(near, far, atol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_shallow_depth_goes_to_the_clamped_cosine(method):
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
        limit = relief.shadow(x, x, z, depth=0, direction=way, normals=normal, method=method)
        lit = cosine > 0.02
        np.testing.assert_allclose(limit[inner][lit[inner]], cosine[inner][lit[inner]], atol=1e-12)
        assert not limit[normal @ way <= 0].any()
        t = relief.shadow(x, x, z, depth=1e-6, direction=way, normals=normal, method=method)
        errors.append(np.abs(t - cosine)[inner].max())
    assert errors[1] < 0.01
    assert np.log2(errors[0] / errors[1]) > 0.8


@pytest.mark.parametrize("method", METHODS)
def test_more_occluder_is_less_light(method):
    x = np.linspace(0, 10, 101)
    tower = (np.abs(x - 6) < 0.5) & (np.abs(x[:, None] - 5) < 1.5)
    before = None
    for height in (0, 0.2, 0.5, 1, 2, 4):
        z = np.where(tower, height, 0.0)
        t = relief.shadow(x, x, z, depth=0.3, direction=sun(25, 15), method=method)
        t = t[:, x < 5]
        if before is not None:
            assert np.all(t <= before + 1e-12)
        before = t if before is None else np.minimum(before, t)
    assert before.min() < 0.2 < 0.4 < np.median(before)
    assert before.max() <= np.sin(np.radians(25)) + 1e-12


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


@pytest.mark.parametrize(
    ("method", "azimuth", "mean", "largest"),
    [
        ("exact", 20, 1e-12, 1e-12),
        ("exact", 75, 1e-12, 1e-12),
        ("fast", 20, 1e-12, 1e-12),
        ("fast", 75, 1e-4, 0.03),
    ],
)
def test_ridge_has_its_closed_form(method, azimuth, mean, largest):
    """To rounding; in profiles that run along a sharp ridge, between its nodes, in the mean."""
    x, y = np.linspace(-6, 3, 361), np.linspace(-3, 3, 121)
    z = np.broadcast_to(ridge(x), (121, 361))
    depth, way = 0.15, sun(22, azimuth)
    flat = np.abs(x) > 0.5 + 0.03
    start = np.stack([*np.meshgrid(x[flat], y), np.full((121, flat.sum()), -depth)], axis=-1)
    expected = np.minimum(depth / ridge_length(start, way), 1)
    t = relief.shadow(x, y, z, depth=depth, direction=way, method=method)[:, flat]
    assert expected.min() < 0.2
    assert np.abs(t - expected).mean() < mean
    assert np.abs(t - expected).max() < largest


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
def test_hemisphere_on_a_plane_below_1e_6_by_the_exact_method(b):
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
        length = relief.inside_length(x, y, z, p, direction=way, method="exact")
        t, expected = np.minimum(depth / np.array([length, ball_length(p, way)]), 1)
        errors.append(np.abs(t - expected).max())
    assert errors[-1] < 1e-6
    order = -np.polyfit(np.log([1, 2, 4, 8]), np.log(errors), 1)[0]
    assert order == pytest.approx(2, abs=0.2)


def test_hemisphere_on_a_plane_below_1e_3_by_default():
    """In the mean; at the rim and the shadow's edge the chord goes as the root of the height."""
    errors = []
    for n in (151, 301, 601):
        x = np.linspace(-3, 3, n)
        z = hemisphere(x, x[:, None])
        p = np.stack([*np.meshgrid(x, x), z], axis=-1)
        normal = np.where(z[..., None] > 0, p, [0, 0, 1.0])
        depth, way = 0.1, sun(35, 20)
        start = p - depth * normal
        expected = np.minimum(depth / np.maximum(ball_length(start, way), 1e-9), 1)
        t = relief.shadow(x, x, z, depth=depth, direction=way, normals=normal)
        errors.append(np.abs(t - expected).mean())
    assert errors[-1] < 1e-3
    assert np.log2(errors[0] / errors[-1]) / 2 > 1


@pytest.mark.parametrize("method", METHODS)
def test_both_methods_are_of_second_order_on_a_smooth_field(method, random):
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
        found = relief.inside_length(
            x, x, height(x, x[:, None]), start, direction=way, method=method
        )
        errors.append(np.median(np.abs(found - expected)))
    order = -np.polyfit(np.log([1, 2, 4, 8]), np.log(errors), 1)[0]
    assert order == pytest.approx(2, abs=0.2)


def test_the_hard_boundary_is_that_of_the_horizon_angle():
    """A point is lit where it faces a light above its horizon, found by sampling the field."""
    x, y, z = hills(80)
    surface = RegularGridInterpolator((y, x), z)
    s = np.arange(1, 750) * 0.02
    for azimuth in (20, 130, 265):
        elevation = 14.0
        way = sun(0, azimuth)
        gx, gy = np.meshgrid(x, y)
        horizon = np.full(z.shape, -np.inf)
        for k in s:
            beside = np.stack(
                [np.clip(gy + k * way[1], 0, 10), np.clip(gx + k * way[0], 0, 10)], -1
            )
            horizon = np.maximum(horizon, (surface(beside) - z) / k)
        margin = np.degrees(np.arctan(horizon)) - elevation
        lit = relief.shadow(x, y, z, depth=0, direction=sun(elevation, azimuth), method="exact") > 0
        # At the border a normal knows one side alone.
        margin, lit = margin[1:-1, 1:-1], lit[1:-1, 1:-1]
        down, right = (slope[1:-1, 1:-1] for slope in np.gradient(z, y, x))
        facing = np.tan(np.radians(elevation)) > right * way[0] + down * way[1]
        differs = lit != ((margin < 0) & facing)
        assert 0.05 < lit.mean() < 0.95
        assert differs.mean() < 0.01
        assert np.abs(margin[differs]).max(initial=0) < 2
        soft = relief.shadow(x, y, z, depth=0.03, direction=sun(elevation, azimuth))
        assert soft[1:-1, 1:-1][margin > 5].max() < 0.4


@pytest.mark.parametrize("method", METHODS)
def test_mirrors_turns_and_scale(method):
    x, y, z = hills(40, 55)
    way = sun(20, 35)
    shade = {"depth": 0.2, "method": method}
    t = relief.shadow(x, y, z, direction=way, **shade)
    mirrored = relief.shadow(-x[::-1], y, z[:, ::-1], direction=way * [-1, 1, 1], **shade)
    np.testing.assert_allclose(mirrored[:, ::-1], t, atol=1e-10)
    turned = relief.shadow(y, x, z.T, direction=way[[1, 0, 2]], **shade)
    np.testing.assert_allclose(turned.T, t, atol=1e-10)
    for scale in (1e-60, 1e60):
        big = relief.shadow(
            scale * x, scale * y, scale * z, direction=way, depth=0.2 * scale, method=method
        )
        np.testing.assert_allclose(big, t, atol=1e-10)


@pytest.mark.parametrize("method", METHODS)
def test_far_from_the_origin_in_float32(method):
    """What float32 was given is kept: the same field near the origin has the same t."""
    x = (5e6 + 30 * np.arange(60)).astype(np.float32)
    y = (5.1e6 + 30 * np.arange(50)).astype(np.float32)
    z = (2000 + 300 * hills(60, 50)[2]).astype(np.float32)
    light = np.array([5e6 + 900.0, 5.1e6 + 400.0, 4000.0])
    for ray, moved in (
        ({"direction": sun(20, 60)}, {"direction": sun(20, 60)}),
        ({"position": light}, {"position": light - [5e6, 5.1e6, 0]}),
    ):
        t = relief.shadow(x, y, z, depth=40, method=method, **ray)
        near = relief.shadow(
            x.astype(float) - 5e6, y.astype(float) - 5.1e6, z, depth=40, method=method, **moved
        )
        np.testing.assert_allclose(t, near, atol=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_holes(method):
    """A flat field stays flat under holes; with walls, light comes in through them."""
    x = np.arange(21.0)
    z = np.zeros((21, 21))
    z[8:12, 9:13] = np.nan
    way = sun(30, 0)
    t = relief.shadow(x, x, z, depth=0.5, direction=way, method=method)
    hole = np.isnan(z)
    assert not t[hole].any()
    np.testing.assert_allclose(t[~hole], 0.5, atol=1e-12)
    wall = relief.shadow(x, x, z, depth=1.0, direction=way, border="wall", method=method)
    row = 10
    # The wall stands at x = 8: the ray from depth 1 reaches it before the surface.
    expected = np.where((x <= 8) & (8 - x < 3**0.5), 1 / np.maximum((8 - x) * 2 / 3**0.5, 1), 0.5)
    expected[20 - x < 3**0.5] = 1 / np.maximum((20 - x) * 2 / 3**0.5, 1)[20 - x < 3**0.5]
    np.testing.assert_allclose(wall[row][~hole[row]], expected[~hole[row]], atol=1e-12)


@pytest.mark.parametrize("normal", [np.zeros(3), [0, 0, np.nan], [np.inf, 0, 0]])
@pytest.mark.parametrize("depth", [0, 0.1])
def test_no_normal_no_light(normal, depth):
    x, y, z = hills(12, 9)
    normals = height_field.normals(height_field.make(x, y, z, base=None, border="extend"))
    options = {"depth": depth, "direction": sun(50, 30), "method": "exact"}
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
            relief.shadow(x, y, z, depth=depth, method="exact", **light)
            for light in ({"position": position}, {"direction": way})
        )
        np.testing.assert_allclose(near, sunny, atol=1e-9)
    length = relief.inside_length(
        [0, 1], [0, 1], np.zeros((2, 2)), (0.5, 0.5, -1), position=(0.5, 0.5, far)
    )
    assert length == pytest.approx(1, abs=1e-12)


def test_base():
    """Light from below comes through a slab of finite height, and not through one without end."""
    x = np.arange(5.0)
    z = np.zeros((5, 5))
    slab = relief.shadow(x, x, z, depth=0.25, direction=(0, 0, -1), base=-1)
    np.testing.assert_allclose(slab, 1 / 3)
    assert not relief.shadow(x, x, z, depth=0.25, direction=(0, 0, -1)).any()
    assert not relief.shadow(x, x, z, depth=0.25, direction=(1, 0, -1e-12)).any()


def test_a_light_on_the_surface():
    x, y, z = hills(20)
    light = (x[7], y[9], z[9, 7])
    t = relief.shadow(x, y, z, depth=0.1, position=light)
    assert t[9, 7] == pytest.approx(1, abs=1e-9)
    assert np.all((t >= 0) & (t <= 1))


@pytest.mark.parametrize("shape", [(2, 2), (2, 7), (9, 2), (3, 3)])
@pytest.mark.parametrize("method", METHODS)
def test_small_fields(shape, method, random):
    y, x = (np.arange(float(n)) for n in shape)
    z = random.uniform(0, 0.1, shape)
    for way in (sun(45, 10), sun(5, 200), sun(90, 0)):
        t = relief.shadow(x, y, z, depth=0.1, direction=way, method=method)
        assert np.all((t > 0) & (t <= 1))


def test_integers_and_lists_are_numbers():
    t = relief.shadow([0, 1, 2], [0, 1], [[0, 1, 0], [0, 1, 0]], depth=1, direction=[0, 0, 1])
    assert t.shape == (2, 3)


FLAT = ([0, 1, 2], [0, 1], np.zeros((2, 3)))
UP = {"direction": (0, 0, 1)}


@pytest.mark.parametrize(
    ("field", "options", "error", "words"),
    [
        (FLAT, {**UP, "depth": -1}, ValueError, "depth: expected a finite number of at least 0"),
        (FLAT, {**UP, "depth": 1e300}, ValueError, "depth: expected at most 2e.09, 1e9 times"),
        (FLAT, {**UP, "depth": "1"}, TypeError, "depth: expected a number"),
        (FLAT, {"depth": 1}, ValueError, "direction, position: expected one of them, got neither"),
        (FLAT, {"depth": 1, **UP, "position": (0, 0, 9)}, ValueError, "got both"),
        (FLAT, {"depth": 1, "direction": (0, 0, 0)}, ValueError, "direction of non-zero length"),
        (FLAT, {"depth": 1, "direction": (0, 1)}, ValueError, "direction: expected 3 components"),
        (
            FLAT,
            {"depth": 1, "position": (1, 0.5, -0.1)},
            ValueError,
            "position: expected a light outside the solid, above 0 there",
        ),
        (FLAT, {"depth": 1, **UP, "method": "slow"}, ValueError, "method: expected 'fast' or"),
        (FLAT, {"depth": 1, **UP, "border": "none"}, ValueError, "border: expected 'extend' or"),
        (FLAT, {"depth": 1, **UP, "base": 0.5}, ValueError, "base: expected a height not above"),
        (FLAT, {"depth": 1, **UP, "normals": np.zeros((3, 3))}, ValueError, r"normals: .*\(2, 3"),
        (([0, 1], [0, 1], np.full((2, 2), np.nan)), {"depth": 1, **UP}, ValueError, "NaN every"),
        (([0, 1], [0, 1], [[0, np.inf]] * 2), {"depth": 1, **UP}, ValueError, "z: expected finite"),
        (([0, 1], [0], np.zeros((1, 2))), {"depth": 1, **UP}, ValueError, "y: .*repeat the row"),
        (([], [0, 1], np.zeros((2, 0))), {"depth": 1, **UP}, ValueError, "x: expected two nodes"),
        (([1, 0], [0, 1], np.zeros((2, 2))), {"depth": 1, **UP}, ValueError, "x: .*rising"),
        (([0, np.nan], [0, 1], np.zeros((2, 2))), {"depth": 1, **UP}, ValueError, "x: .*finite"),
        (([0, 1], [0, 1, 2], np.zeros((2, 3))), {"depth": 1, **UP}, ValueError, r"z: .*\(3, 2\)"),
        (([0, 1], [0, 1], [["a"] * 2] * 2), {"depth": 1, **UP}, TypeError, "z: expected real"),
        (([0, 1e-80], [0, 1], np.zeros((2, 2))), {"depth": 1, **UP}, ValueError, "1e-70 and 1e70"),
    ],
)
def test_bad_input(field, options, error, words):
    with pytest.raises(error, match=words):
        relief.shadow(*field, **options)


@pytest.mark.parametrize(
    "nodes",
    [
        np.linspace(0.0, 1.0, 1000),
        np.cumsum(np.geomspace(1e-9, 1.0, 50)),
        np.array([0.0, 1e-300, 1e70]),
        np.array([-3.0, -1.0]),
    ],
    ids=["even", "ever wider", "smallest and largest", "one cell"],
)
def test_intervals_are_those_of_a_binary_search(nodes, random):
    near = [np.nextafter(nodes, end) for end in (-np.inf, np.inf)]
    between = random.uniform(nodes[0], nodes[-1], 1000)
    place = np.concatenate([nodes, *near, between, [-1e70, 1e70]])
    found = height_field.locate(nodes, place)
    assert np.array_equal(found, np.searchsorted(nodes, place, side="right"))


@pytest.mark.parametrize("least", [5e-324, 1e-310, 1e-300])
def test_a_light_hardly_off_the_zenith(least):
    """Dividing by what is nearly nothing overflows: it must not be told."""
    points = [(1.5, 1.5, -0.5), (0.25, 2.0, -0.25)]
    length = relief.inside_length(
        range(4), range(4), np.zeros((4, 4)), points, direction=(least, -least, 1), method="exact"
    )
    assert length.tolist() == [0.5, 0.25]
