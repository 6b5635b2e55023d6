"""Rays through the cylinders of a bundle: each ray against all, a ring, errors at other points."""

import numpy as np
import pytest
from straight_lines import pieces, shaded, some_lines, straight_halves
from vectors import unit

from vizlight.geometry.lines import bundle, cylinders

LENGTH, DIAMETER = 0.5, 0.02
FAR, ALONG = ((0.3, -0.4, 0.866), False), ((1.0, 0.1, 0.02), False)
INSIDE, OUTSIDE = ((0.1, 0.05, -0.08), True), ((0.3, 0.2, 1.6), True)


def points_of(middles, tangents, random, count):
    """Return the medium of straight lines, points of them, and the numbers of their lines."""
    own, at = random.integers(len(middles), size=count), random.uniform(-0.5, 0.5, (count, 1))
    places = middles[own] + at * LENGTH * tangents[own]
    lines = pieces(middles, tangents, LENGTH, 2 * DIAMETER)
    halves = straight_halves(tangents[own], LENGTH, at)
    return lines, lines.targets(places, tangents[own], halves), places, own


@pytest.mark.parametrize(
    ("kind", "lamp"),
    [("isotropic", FAR), ("parallel", ALONG), ("layered", INSIDE), ("parallel", OUTSIDE)],
)
def test_rays_meet_the_cylinders_that_each_of_them_meets(kind, lamp):
    """Against rays that are tested with every line, without cells or pieces."""
    (light, near), random = lamp, np.random.default_rng(5)
    middles, tangents = some_lines(kind, random)
    lines, targets, places, line_of_place = points_of(middles, tangents, random, 60)
    way = np.asarray(light) - places if near else np.tile(light, (len(places), 1))
    reach = np.linalg.norm(way, axis=1) if near else np.full(len(places), np.inf)
    way = unit(way)
    side = unit(np.cross(way, tangents[line_of_place])) * DIAMETER
    free = [
        ~shaded(places + x * side, way, line_of_place, middles, tangents, LENGTH, DIAMETER, reach)
        for x in cylinders.STARTS
    ]
    shares = cylinders.free_shares(lines, targets, DIAMETER, light, near)
    assert 0.1 < np.mean(free) < 0.9
    np.testing.assert_allclose(shares, np.mean(free, axis=0), atol=1e-9)


def test_a_ring_hides_its_far_side_and_not_the_point_itself():
    """Cylinders around a circle of 60 corners in the plane of the light, and a disc of faces."""
    angles = np.linspace(0, 2 * np.pi, 61)
    points = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)[:-1]
    ids, offsets = np.arange(61) % 60, np.array([0, 61])
    lines = bundle.medium(points, ids, offsets, voxel=0.1)
    tangents = np.stack([-points[:, 1], points[:, 0], points[:, 2]], axis=1)
    ring = lines.targets(points, tangents, bundle.line_halves(points, ids, offsets))
    for light, near in (((1, 0, 0), False), ((40.0, 0, 0), True), ((1.25, 0, 0), True)):
        # Where tangents from the lamp touch the ring: close to them a cylinder is seen in part.
        edge = 1 / light[0] if near else 0.0
        clear = np.abs(points[:, 0] - edge) > 0.15
        free = cylinders.free_shares(lines, ring, 0.02, light, near)
        assert np.array_equal(free[clear], points[clear, 0] > edge)
    place = np.array([[0.0, 0, 0], [0, 0, 0.5]])
    plate = lines.targets(place, np.array([[1.0, 0, 0], [1, 0, 0]]))
    assert cylinders.free_shares(lines, plate, 0.02, (1, 0, 0), False).tolist() == [0, 1]
    behind = lines.targets(place, -np.array([[1.0, 0, 0], [1, 0, 0]]))
    assert cylinders.missed(lines, behind, 0.02, (1, 0, 0), False, np.ones(2)) == (0, 0)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("kind", "lamp"),
    [("isotropic", OUTSIDE), ("parallel", ALONG), ("layered", FAR), ("isotropic", INSIDE)],
)
def test_errors_hold_at_other_points(kind, lamp, seed, claim):
    """At 95 of 100 points, and of their mean beside its random error."""
    (light, near), random = lamp, np.random.default_rng(6 + seed)
    lines, targets, _, _ = points_of(*some_lines(kind, random), random, 1500)
    left = lines.dimmed(targets, DIAMETER, [lamp])[:, 0]
    error, mean = cylinders.missed(lines, targets, DIAMETER, light, near, left)
    off = left - cylinders.free_shares(lines, targets, DIAMETER, light, near)
    claim(np.mean(abs(off) > error), 0.05)
    assert error < 0.8
    # Two standard errors of the sample leave one mean in twenty out.
    assert abs(off.mean()) < mean + 0.02
    assert mean < 0.07
