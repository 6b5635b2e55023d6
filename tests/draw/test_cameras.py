"""Cameras that see all of a mesh: where they stand, what is up, what is clipped."""

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

from studies import peak_memory
from vizlight import render


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("direction", [(1, 1, 1), (0, 0, 1), (0, 0, -2), (-1, 0.2, 0)])
def test_camera_frames_as_vtk_would(direction, parallel):
    bounds = (-3.0, 5, 2, 4, 1e3, 1e3 + 7)
    camera = render.camera_on(bounds, direction, parallel=parallel)
    renderer = pv.Plotter(off_screen=True).renderer
    renderer.camera = camera.copy()
    renderer.ResetCamera(*bounds)
    np.testing.assert_allclose(camera.position, renderer.camera.position, rtol=1e-6)
    np.testing.assert_allclose(camera.focal_point, renderer.camera.focal_point, rtol=1e-9)
    assert camera.parallel_scale == pytest.approx(renderer.camera.parallel_scale)
    assert camera.parallel_projection == parallel


@pytest.mark.parametrize("direction", [(0.3, -1, 0.4), (0, 0, 1), (1, 0.2, -0.5)])
def test_a_mesh_is_centred_as_it_is_seen(direction):
    """The camera's focal point lies in the middle of what is seen, which is not the box's."""
    points = np.array([[0, 0, 0], [4, 0, 0], [4, 3, 1], [0.5, 0.2, 5e-1]])
    mesh = pv.MultiBlock([pv.PolyData(points[:2]), None, pv.PolyData(points[2:]), pv.PolyData()])
    camera = render.camera_on(mesh, direction, parallel=True)
    back = unit(direction)
    right = np.cross(camera.up, back)
    for axis in (right, np.cross(back, right)):
        seen = points @ axis
        assert camera.focal_point @ axis == pytest.approx((seen.min() + seen.max()) / 2)
    box = render.camera_on(mesh.bounds, direction, parallel=True)
    if np.count_nonzero(direction) == 3:
        assert np.linalg.norm(np.subtract(camera.focal_point, box.focal_point)) > 0.1
    assert camera.parallel_scale < box.parallel_scale
    with pytest.raises(ValueError, match="bounds: expected a mesh with points"):
        render.camera_on(pv.PolyData())


def test_light_over_the_shoulder_is_above_left_of_the_eye():
    camera = render.camera_on((0, 1, 0, 1, 0, 1), (0, -1, 0))
    assert np.sign(render.over_shoulder(camera)).tolist() == [-1, -1, 1]


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e6])
def test_what_is_up_is_up_in_the_picture(size):
    """A plate 4 wide and 1 high, seen from above: what is up decides its height."""
    plate = pv.Plane(i_size=4 * size, j_size=size)
    for up, height in ((None, 1), ((0, -1, 0), 1), ((1, 0, 0), 4)):
        camera = render.camera_on(plate, (0, 0, 1), up=up, parallel=True, aspect=4.0)
        assert camera.up == (up or (0, 1, 0))
        assert camera.parallel_scale == pytest.approx(1.05 * size * height / 2)
        camera = render.camera_on(plate, (0, 0, 1), up=up, aspect=4.0)
        seen = camera.distance * np.tan(np.radians(15))
        assert seen == pytest.approx(1.05 * size * height / 2)
    assert render.camera_on(plate.bounds, (1, 0, 0)).up == (0, 0, 1)


@pytest.mark.parametrize("zoom", [0.5, 1.0, 3.0, 50.0])
@pytest.mark.parametrize("direction", [(1, 1, 1), (0, 0, -1), (0.3, -1, 0.2)])
def test_nothing_before_the_eye_is_clipped(direction, zoom):
    """The near plane stands before the box or close to the eye, the far one behind it."""
    bounds = (-3, 5, 1, 2, 1e3, 1004)
    camera = render.camera_on(bounds, direction, zoom=zoom)
    corners = np.stack(np.meshgrid(*np.reshape(bounds, (3, 2))), axis=-1).reshape(-1, 3)
    way = np.subtract(camera.focal_point, camera.position)
    depth = (corners - camera.position) @ way / camera.distance
    near, far = camera.clipping_range
    assert 0 < near <= max(depth.min(), camera.distance * 1.001e-3)
    assert depth.max() <= far
    # Depth is kept in few digits: no more than the box twice over.
    assert far - near < 2.01 * np.linalg.norm(corners[0] - corners[-1])


def projected(mesh, camera):
    """Return the places of the finite points in the picture, -1 to 1 from side to side."""
    points = mesh.points[np.isfinite(mesh.points).all(axis=1)].astype(np.float64)
    back = unit(np.subtract(camera.position, camera.focal_point))
    right = unit(np.cross(camera.up, back))
    way = points - camera.position
    half = -(way @ back) * np.tan(np.radians(camera.view_angle / 2))
    return np.stack([way @ right / half, way @ np.cross(back, right) / half])


@pytest.mark.parametrize("direction", [(1, 1, 1), (0, 0, 1), (0.3, -1, 0.2)])
def test_the_outermost_of_many_points_touch_the_margins(direction, random):
    """Also where some are not finite, of a grid, and in whatever order they are."""
    cloud = pv.PolyData(random.normal(size=(150_000, 3)).astype(np.float32) + 7)
    cloud.points[::7] = np.nan
    turned = cloud.copy()
    turned.points = turned.points[::-1]
    edges = [np.cumsum(random.random(n)) for n in (9, 7, 5)]
    for mesh in (
        cloud,
        pv.ImageData(dimensions=(3, 4, 5), origin=(5, 6, 7)),
        pv.RectilinearGrid(*edges),
    ):
        camera = render.camera_on(mesh, direction)
        # Both ends along one axis, so that no nearer eye sees all.
        seen = projected(mesh, camera)
        ends = np.stack([-np.nanmin(seen, axis=1), np.nanmax(seen, axis=1)])
        assert ends.max() == pytest.approx(1 / 1.05, rel=1e-6)
        assert np.any(np.isclose(ends, 1 / 1.05, rtol=1e-6).all(axis=0))
    np.testing.assert_allclose(
        render.camera_on(turned, direction).position,
        render.camera_on(cloud, direction).position,
        rtol=1e-14,
    )


def test_a_camera_copies_no_mesh():
    cloud = pv.PolyData(np.tile(np.float32([1, 2, 3]), (400_000, 1)))
    cloud.points[0] = 0
    for mesh in (cloud, pv.ImageData(dimensions=(160, 160, 160))):
        mesh.bounds  # noqa: B018 - which VTK keeps
        assert peak_memory(lambda mesh=mesh: render.camera_on(mesh)) < 2.5 * 65_536 * 10 * 8


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize(
    ("direction", "up"), [((1, 1, 1), None), ((0.2, -1, -0.4), None), ((1, 0.3, 0.5), (0, 1, 0))]
)
def test_a_mesh_stays_in_the_picture_all_around(direction, up, parallel):
    """Points are projected by hand from all azimuths: none is outside, and one is at the margin."""
    points = np.random.default_rng(5).normal(size=(200, 3)) * (3, 1, 0.5) + (10, 20, 30)
    aspect, shares = 1.5, []
    camera = render.camera_on(
        pv.PolyData(points), direction, up=up, parallel=parallel, aspect=aspect, turning=True
    )
    for _ in range(90):
        way = unit(np.subtract(camera.focal_point, camera.position))
        right = unit(np.cross(way, camera.up))
        away = points - camera.position
        half = camera.parallel_scale if parallel else np.tan(np.radians(15)) * (away @ way)
        shares += [abs(away @ right) / (half * aspect), abs(away @ np.cross(right, way)) / half]
        camera.Azimuth(4)
    assert 0.93 < np.max(shares) < 0.96
    middle = np.reshape(pv.PolyData(points).bounds, (3, 2)).mean(axis=1)
    assert np.linalg.norm(np.cross(middle - camera.focal_point, camera.up)) < 1e-9
