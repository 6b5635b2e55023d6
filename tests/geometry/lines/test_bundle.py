"""Light inside a bundle: closed forms of a slab and a ball, real tubes, both paths of the grid."""

import numpy as np
import pytest
from straight_lines import pieces, some_lines, straight_halves
from vectors import unit

import vizlight
from vizlight.geometry.lines import bundle, cylinders


def depths(lines, places, toward):
    """Return the depths per diameter in the unit of the points."""
    *found, _ = lines.depths(lines.targets(places).places, toward)
    return [depth / lines.voxel for depth in found]


def filled(rng, side, low, high):
    """Return places that fill a box more evenly than at random: one in each cell."""
    cells = np.stack(np.meshgrid(*3 * [np.arange(side)], indexing="ij"), axis=-1).reshape(-1, 3)
    return low + (high - low) * (cells + rng.uniform(size=cells.shape)) / side


def ball_of_lines(rng, side, length, voxel, *, hole=(0, 0, 0), radius=0.0):
    """Return lines in all directions in the unit ball with a hole, their length per volume."""
    middles = filled(rng, side, -1.0, 1.0)
    middles = middles[np.linalg.norm(middles, axis=1) < 1]
    middles = middles[np.linalg.norm(middles - hole, axis=1) >= radius]
    tangents = unit(rng.normal(size=middles.shape))
    return pieces(middles, tangents, length, voxel), (side / 2) ** 3 * length


def test_a_slab_of_lines_across_the_light_has_the_depth_of_its_lines():
    """Lines along x between z = 0 and 1: the depth at z toward +z is (1 - z) length per volume."""
    rng = np.random.default_rng(1)
    middles, length = filled(rng, 60, 0.0, 1.0), 0.02
    count = len(middles)
    slab = pieces(middles, np.tile([1.0, 0, 0], (count, 1)), length, voxel=0.05)
    height = np.linspace(0.1, 0.9, 9)
    places = np.stack([np.full(9, 0.5), np.full(9, 0.5), height], axis=1)
    forth, back = depths(slab, places, (0, 0, 2))
    assert forth == pytest.approx(count * length * (1 - height), rel=0.02)
    assert back == pytest.approx(count * length * height, rel=0.02)
    along, _ = depths(slab, places, (1, 0, 0))
    assert along == pytest.approx(0, abs=1e-3 * count * length)
    slanted, _ = depths(slab, places, (0, 0.6, 0.8))
    middle = height > 0.4  # farther down the way leaves by the side of the slab
    expected = count * length * (1 - height) / 0.8
    assert slanted[middle] == pytest.approx(expected[middle], rel=0.03)


def test_a_ball_of_lines_in_all_directions():
    """The mean of |w x t| is pi / 4; from the place r the way out along w is in closed form."""
    rng = np.random.default_rng(2)
    ball, density = ball_of_lines(rng, 80, 0.01, 0.06)
    places = unit(rng.normal(size=(40, 3))) * rng.uniform(0, 0.8, (40, 1))
    for toward in np.eye(3):
        along = places @ toward
        way = np.sqrt(1 - (places * places).sum(axis=1) + along**2)
        for depth, sign in zip(depths(ball, places, toward), (-1, 1), strict=True):
            assert depth == pytest.approx(np.pi / 4 * density * (way + sign * along), rel=0.06)


@pytest.mark.parametrize("lamp", [(0.3, -0.2, 0.1), (2.0, 1.5, -3.0)])
def test_a_lamp_in_and_out_of_a_ball(lamp):
    """A hole around the lamp: without it the few pieces next to the lamp darken many points."""
    rng = np.random.default_rng(3)
    ball, density = ball_of_lines(rng, 80, 0.01, 0.06, hole=lamp, radius=0.15)
    places = unit(rng.normal(size=(3000, 3))) * rng.uniform(0, 0.7, (3000, 1))
    toward = np.asarray(lamp) - places
    distance = np.linalg.norm(toward, axis=1)
    along = (places * toward).sum(axis=1) / distance
    out = np.sqrt(1 - (places * places).sum(axis=1) + along**2) - along
    way = np.where(distance < out, distance - 0.15, out)
    keep = way > 0.2
    place = (np.array(lamp) - ball.origin) / ball.voxel
    depth, _ = bundle.depths(ball, ball.targets(places).places, place)
    depth = depth / ball.voxel
    ratio = depth[keep] / (np.pi / 4 * density * way[keep])
    assert ratio.mean() == pytest.approx(1, abs=0.01)
    assert ratio.std() < (0.1 if distance.min() > 1 else 0.25)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("gap", [0.55, 0.8, 1.5, 4.0])
def test_a_lamp_beside_a_line_sees_the_width_of_a_cylinder(gap):
    """A cylinder at a distance r of its axis hides 2 asin(d / 2 r) of the angle around the lamp."""
    thick, tries = 0.4, 20_000
    line = pieces(np.array([[gap * thick, 0, 0]]), np.eye(3)[2:], 600, 1.0)
    ways = unit(np.random.default_rng(4).normal(size=(tries, 3)))
    ways = ways[np.abs(ways[:, 2]) < 0.9]
    places = (10 * ways - line.origin).T.astype(np.float32)
    depth, _ = bundle.depths(line, places, -line.origin, thick)
    hidden = 1 - np.exp(-thick * depth).mean()
    assert hidden == pytest.approx(np.arcsin(0.5 / gap) / np.pi, abs=0.01)


def test_short_lines_at_random_leave_the_light_of_their_mean_depth():
    random, thick, length = np.random.default_rng(9), 0.5, 0.03
    middles = random.uniform(-1, 1, (round(400 / length), 3))
    angles = random.uniform(0, np.pi, len(middles))
    tangents = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    lines = pieces(middles, tangents, length, 0.04)
    targets = lines.targets(random.uniform(-0.9, 0.9, (4000, 3)) * [1, 1, 0])
    left = lines.dimmed(targets, thick * lines.voxel, [((0, 0, 1), False)])
    depth, _, _ = lines.depths(targets.places, (0, 0, 1))
    assert left.mean() == pytest.approx(np.exp(-thick * depth.mean()), abs=0.005)


def shares(middles, tangents, light, near, length, diameter, random, tries, ends=False):
    """Return the mean share of a light at points of lines by rays, and by the medium."""
    own = random.integers(len(middles), size=tries)
    at = random.choice([-0.5, 0.5], (tries, 1)) if ends else random.uniform(-0.5, 0.5, (tries, 1))
    places = middles[own] + at * length * tangents[own]
    lines = pieces(middles, tangents, length, 2 * diameter)
    targets = lines.targets(places, tangents[own], straight_halves(tangents[own], length, at))
    left = lines.dimmed(targets, diameter, [(light, near)])[:, 0]
    return cylinders.free_shares(lines, targets, diameter, light, near).mean(), left.mean()


def near_the_axis(degrees):
    return (np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0)


#: Lines, a light, and whether it has a place.
CASES = {
    "isotropic": ("isotropic", (0.3, -0.4, 0.866), False),
    "across parallel lines": ("aligned", (0.3, -0.4, 0.866), False),
    "layered": ("layered", (0.3, -0.4, 0.866), False),
    "2 degrees from parallel lines": ("parallel", near_the_axis(2), False),
    "5 degrees from parallel lines": ("parallel", near_the_axis(5), False),
    "10 degrees from parallel lines": ("parallel", near_the_axis(10), False),
    "along nearly parallel lines": ("aligned", near_the_axis(0), False),
    "6 degrees from half of crossing lines": ("crossing", near_the_axis(6), False),
    "a lamp among isotropic lines": ("isotropic", (0.1, 0.05, -0.08), True),
    "a lamp in a layer": ("layered", (0.1, 0.05, 0.125), True),
    "a lamp close outside": ("isotropic", (0, 0, 1.1), True),
    "a lamp outside, oblique to the axes": ("isotropic", (0.7, -0.45, 0.7), True),
    "a lamp at the end of parallel lines": ("parallel", (1.25, 0, 0), True),
    "a lamp at the end of crossing lines": ("crossing", (1.4, 0.15, 0.1), True),
}


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", CASES)
def test_the_mean_share_of_each_case_is_as_right_as_stated(name, seed, claim):
    """Over 8 bundles, beside the random error of their mean."""
    kind, light, near = CASES[name]
    random, diameter, length = np.random.default_rng(11 + seed), 0.02, 0.5
    found = [
        shares(*some_lines(kind, random), light, near, length, diameter, random, 1000)
        for _ in range(8)
    ]
    error = np.diff(found, axis=1)
    assert 0.1 < np.mean(found, axis=0)[0] < 0.97
    claim(abs(error.mean()), 0.01 + 2 * error.std() / np.sqrt(len(error)))
    assert error.std() / np.sqrt(len(error)) < 0.006
    claim(np.abs(error).max(), 0.04, "single")


def test_a_lamp_far_away_in_any_direction_is_a_light_at_infinity():
    random, diameter, length = np.random.default_rng(8), 0.02, 0.5
    for toward in unit(random.normal(size=(3, 3))):
        middles, tangents = some_lines("isotropic", random)
        lines = pieces(middles, tangents, length, 2 * diameter)
        targets = lines.targets(middles, tangents, straight_halves(tangents, length, 0.0))
        left = lines.dimmed(targets, diameter, [(toward, False), (1e4 * toward, True)])
        assert abs(np.diff(left.mean(axis=0))) < 0.01


def test_a_straight_line_does_not_dim_itself():
    """Wherever it lies in the voxels: alone it is the whole medium."""
    random, at, least = np.random.default_rng(6), np.linspace(-0.5, 0.5, 41)[:, np.newaxis], []
    for _ in range(40):
        tangent, light = unit(random.normal(size=(2, 3)))
        light = unit(light - 0.9 * (light @ tangent) * tangent)
        middle, along = random.normal(size=(1, 3)), np.tile(tangent, (41, 1))
        line = pieces(middle, tangent[np.newaxis], 1.0, 0.04)
        targets = line.targets(middle + at * tangent, along, straight_halves(along, 1.0, at))
        beside, ahead = middle[0] + 1.5 * light, middle[0] + 1.5 * tangent + 0.05 * light
        lights = [(light, False), (beside, True), (ahead, True)]
        least.append(line.dimmed(targets, 0.02, lights).min(axis=0))
    assert (np.min(least, axis=0) > (0.94, 0.93, 0.96)).all()
    assert (np.mean(least, axis=0) > 0.97).all()


@pytest.mark.slow
@pytest.mark.parametrize("length", [0.5, 0.03])
@pytest.mark.parametrize("kind", ["isotropic", "layered"])
def test_ends_of_lines_are_as_right_as_their_inner_points(kind, length):
    """Also of lines that are shorter than a voxel."""
    random, diameter = np.random.default_rng(12), 0.02
    light, count = (0.3, -0.4, 0.866), round(600 / length)
    found = [
        shares(*some_lines(kind, random, count), light, False, length, diameter, random, 150, True)
        for _ in range(6)
    ]
    error = np.diff(found, axis=1)
    # Lines of a length of 1.5 diameters are hardly cylinders.
    most = 0.01 if length > 10 * diameter else 0.02
    assert abs(error.mean()) < most + 2 * error.std() / np.sqrt(len(error))


def test_halves_of_lines():
    """Of the longest line of a point, along the segments beside it; none at a line's end.

    Ends are free where no other line goes on, and count where the half is straight.
    """
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [1, 5, 0], [np.nan, 0, 0], [7.0, 7, 7]])
    ids, offsets = np.array([0, 1, 2, 1, 3, 4, 3]), np.array([0, 3, 3, 5, 7])
    halves = bundle.line_halves(points, ids, offsets)
    wanted = np.zeros((6, 2, 4))
    wanted[0] = [3, 0, 0, 0], [0, 0, 0, 1]
    wanted[1, 0] = 0, 5, 0, 0
    wanted[2] = [0, 0, 0, 1], [0, -3, 0, 0]
    wanted[3, 1] = 0, -5, 0, 0
    assert np.array_equal(halves, wanted)
    straight = bundle.line_halves(points[[0, 1]], np.array([0, 1]), np.array([0, 2]))
    assert np.array_equal(straight[:, :, 3], np.ones((2, 2)))
    ring = np.array([0, 1, 2, 0]), np.array([0, 4])
    assert not bundle.line_halves(points, *ring)[:, :, 3].any()
    assert not bundle.medium(points, *ring, voxel=1.0).free.any()


def test_lines_along_the_light_hide_what_their_ends_do():
    """A disc of the diameter for each line that begins and ends before the light."""
    rng = np.random.default_rng(5)
    middles, thick = filled(rng, 30, 0.0, 1.0), 0.02
    lines = pieces(middles, np.tile([0, 0, 1.0], (len(middles), 1)), 0.05, voxel=0.04)
    places = rng.uniform(0.1, 0.9, (200, 3))
    forth, back, _ = lines.depths(lines.targets(places).places, (0, 0, 1), thick / lines.voxel)
    share = np.stack([1 - places[:, 2], places[:, 2]]).mean(axis=1)
    wanted = len(middles) * np.pi / 4 * thick**2 * share
    found = np.mean([forth, back], axis=1) / lines.voxel * thick
    assert found == pytest.approx(wanted, rel=0.03)


@pytest.mark.parametrize(
    ("degrees", "around", "rays", "medium"),
    [(4, 15, 1.0, 0.85), (4, 0, 0.41, 0.77), (90, 0, 0.08, 0.23)],
)
def test_the_medium_does_not_know_of_a_lattice(degrees, around, rays, medium):
    """A hexagonal lattice of parallel lines, 5 diameters apart, is open or shut by the angle."""
    i, j = (x.ravel() for x in np.meshgrid(*2 * [np.arange(-21, 22)]))
    y, z = 0.05 * (i + 0.5 * j), 0.05 * np.sqrt(0.75) * j
    inside = y * y + z * z < 0.25
    middles = np.stack([0 * y, y, z], axis=1)[inside]
    tangents = np.tile([1.0, 0, 0], (len(middles), 1))
    a, b = np.radians([degrees, around])
    light = (np.cos(a), np.sin(a) * np.cos(b), np.sin(a) * np.sin(b))
    random = np.random.default_rng(0)
    found = shares(middles, tangents, light, False, 2.0, 0.01, random, 500)
    assert found == pytest.approx((rays, medium), abs=0.04)
    assert f"{rays:.2f}" in vizlight.Bundle.__doc__
    assert f"{medium:.2f}" in vizlight.Bundle.__doc__


def test_a_grid_holds_what_is_spread_over_it():
    rng = np.random.default_rng(7)
    shape = (9, 11, 13)
    cells = (rng.uniform(size=(3, 5000)) * (np.array(shape)[:, None] - 2)).astype(np.float32)
    values = rng.uniform(size=5000).astype(np.float32)
    grid = bundle.spread(cells, values, shape)
    assert grid.sum() == pytest.approx(values.sum(), rel=1e-5)
    corner = np.array([[2.0], [3.0], [4.0]], np.float32)
    assert bundle.read(grid, corner)[0] == grid[2, 3, 4]


def test_lines_that_are_odd():
    """One point, no line, points that are not finite, repeated points: finite pieces or none."""
    points = np.array([[0, 0, 0], [1, 0, 0], [np.nan, 0, 0], [1, 0, 0], [1, 0, 0]], np.float32)
    found = bundle.medium(
        points, np.array([0, 1, 2, 3, 4, 4]), np.array([0, 3, 4, 4, 6]), voxel=0.25
    )
    assert found.middles.shape == (3, 5)
    assert np.isfinite(found.middles).all()
    targets = found.targets(points)
    left = found.dimmed(targets, 0.1, [((0, 0, 1), False), ((0, 0, 1), True)])
    sides = found.sky(targets, 0.1, 4)
    assert left[2].tolist() == [1, 1]
    assert sides[2] == 1
    assert ((left > 0) & (left <= 1)).all()
    empty = bundle.medium(points[:0], np.zeros(0, int), np.zeros(1, int), voxel=0.25)
    assert empty.middles.shape == (3, 0)
    left = empty.dimmed(targets, 0.1, [((0, 0, 1), False), ((0, 0, 1), True)])
    sides = empty.sky(targets, 0.1, 4)
    assert (left == 1).all()
    assert (sides == 1).all()
