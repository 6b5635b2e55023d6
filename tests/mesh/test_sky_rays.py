"""The sky by rays: closed forms, what is buried, the error, and both tracers."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.mesh import closed_meshes, sky_rays
from vizlight.mesh.sky_rays import Occluders, SkyPlaces

pytest.importorskip("embreex")


def disc(radius, z, count=128):
    """Return a fan of triangles."""
    turn = np.linspace(0, 2 * np.pi, count + 1)[:-1]
    rim = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(count, z)], axis=1)
    a = np.arange(count)
    faces = np.stack([np.zeros_like(a), a + 1, (a + 1) % count + 1], axis=1)
    return np.vstack([[[0, 0, z]], rim]), faces


@pytest.fixture(params=["embree", "vtk"])
def tracer(request, monkeypatch):
    """Follow rays by each of the two."""
    if request.param == "vtk":
        monkeypatch.setattr(closed_meshes, "embree_tree", lambda _: None)
    return request.param


@pytest.mark.parametrize("distance", [0.2, 1.0, 3.0])
def test_parallel_discs(distance, tracer):
    """A disc of radius r, h above a point, hides r^2 / (r^2 + h^2) of its sky."""
    points, faces = disc(1.0, distance)
    made = Occluders(points, faces)
    assert tracer in made.tracer.name.lower()
    seen = made.seen(SkyPlaces(np.zeros((1, 3)), np.array([[0, 0, 1.0]])), error=0.02)
    assert seen.share[0] == pytest.approx(1 - 1 / (1 + distance**2), abs=0.03)
    assert made.seen(
        SkyPlaces(np.zeros((1, 3)), np.array([[0, 0, -1.0]])), error=0.02
    ).share == pytest.approx([1.0])


def test_the_half_space_above():
    points, faces = disc(1e-3, -50.0)
    made = Occluders(points, faces)
    ways = np.array([[0, 0, 1.0], [1, 0, 0], [0, 0, -1], [1, 0, 1]])
    seen = made.seen(SkyPlaces(np.zeros((4, 3)), ways), error=0.005, up=np.array([0, 0, 2.0]))
    wanted = [1, 0.5, 0, (1 + np.sqrt(0.5)) / 2]
    np.testing.assert_allclose(seen.share, wanted, atol=0.012)


def test_parallel_tubes():
    """Two long tubes hide from each other, in the mean, 1/2 - acos and root of crossed strings."""
    radius, apart = 0.1, 0.3
    ends = np.array([[0, 0, -200.0], [0, 0, 200], [apart, 0, -200], [apart, 0, 200]])
    vertices, faces = sky_rays.tubes(ends, np.arange(4), np.array([0, 2, 4]), radius)
    made = Occluders(vertices, faces)
    points = np.column_stack([np.zeros((400, 2)), np.linspace(-1, 1, 400)])
    ways = np.tile([0, 0, 1.0], (400, 1))
    seen = made.seen(SkyPlaces(points, ways, radius), error=0.02)
    x = apart / (2 * radius)
    hidden = (np.sqrt(x * x - 1) + np.arcsin(1 / x) - x) / np.pi
    assert seen.share.mean() == pytest.approx(1 - hidden, abs=0.006)


def test_a_tube_alone_sees_all():
    turn = np.linspace(0, 6, 300)
    line = np.stack([np.cos(turn), np.sin(turn), 2 * turn], axis=1)
    vertices, faces = sky_rays.tubes(line, np.arange(300), np.array([0, 300]), 0.001)
    assert len(vertices) == 1800
    made = Occluders(vertices, faces)
    step = np.gradient(line, axis=0)
    seen = made.seen(SkyPlaces(line[5:-5], step[5:-5], 0.001), error=0.05)
    assert seen.share.min() > 0.97


@pytest.mark.slow
def test_the_error_holds_and_flat_parts_cost_little():
    ball = pv.ParametricRandomHills(random_seed=3).triangulate()
    points, faces = np.asarray(ball.points, float), ball.regular_faces
    ways = np.asarray(ball.compute_normals(auto_orient_normals=False)["Normals"], float)
    made = Occluders(points, faces)
    some = np.random.default_rng(0).permutation(len(points))[:800]
    places = SkyPlaces(points[some], ways[some])
    true = made.seen(places, error=0.0015).share
    for error in (0.04, 0.015):
        seen = made.seen(places, error=error)
        assert seen.error <= error
        assert np.quantile(np.abs(seen.share - true), 0.95) <= error
    convex = pv.Icosphere(nsub=4)
    flat = Occluders(np.asarray(convex.points, float), convex.regular_faces)
    open_ = flat.seen(SkyPlaces(convex.points, np.asarray(convex.points)), error=0.001)
    assert open_.rays == sky_rays.FEWEST * convex.n_points
    assert (open_.share == 1).all()


@pytest.mark.parametrize("scale", [1e-12, 1e9])
def test_neither_unit_nor_place_matters(scale):
    points, faces = disc(1.0, 0.5)
    far = scale * (points + 5.0)
    ways = np.array([[0, 0, 1e-200]])
    seen = Occluders(far, faces).seen(SkyPlaces(scale * np.full((1, 3), 5.0), ways), error=0.02)
    assert seen.share[0] == pytest.approx(0.2, abs=0.03)


def test_points_without_a_sky(tracer):
    """No normal, not finite, or inside of a closed surface; a deep pit is dark but has a sky."""
    box = pv.Box().triangulate()
    made = Occluders(np.asarray(box.points, float), box.regular_faces)
    points = np.array([[2.0, 0, 0], [2, 0, 0], [np.nan, 0, 0], [0.2, 0.1, 0]])
    ways = np.array([[1.0, 0, 0], [0, 0, 0], [1, 0, 0], [1, 0, 0]])
    seen = made.seen(SkyPlaces(points, ways), error=0.1)
    assert seen.valid.tolist() == [True, False, False, False]
    assert seen.share[0] == 1
    inward = Occluders(np.asarray(box.points, float), box.regular_faces[:, ::-1])
    pit = inward.seen(SkyPlaces(points[3:], ways[3:]), error=0.1)
    assert pit.valid.tolist() == [True]
    assert pit.share[0] == 0


def test_nothing_to_see():
    none = Occluders(np.zeros((0, 3)), np.zeros((0, 3), int))
    seen = none.seen(SkyPlaces(np.zeros((2, 3)), np.array([[0, 0, 1.0], [0, 0, 0]])), error=0.1)
    assert seen.share[0] == 1
    assert seen.valid.tolist() == [True, False]
    degenerate = Occluders(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    seen = degenerate.seen(SkyPlaces(np.ones((1, 3)), np.array([[0, 0, 1.0]])), error=0.1)
    assert seen.share[0] == 1
