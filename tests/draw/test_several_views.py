"""A mesh from several sides, beside each other."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight.draw.cameras import axes_of, camera_on
from vizlight.draw.several_views import beside, inset, several_views

BOTH, NAMES = [(0, -1, 0), (0, 1, 0)], ("front", "back")


def ellipsoid(*sizes):
    mesh = pv.Sphere().scale(sizes)
    mesh["x"] = np.asarray(mesh.points)[:, 0].copy()
    mesh["way"] = np.tile([1.0, 2.0, 3.0], (mesh.n_points, 1))
    return mesh


@pytest.mark.parametrize(("sizes", "away"), [((4, 1, 3), (1.08, 0, 0)), ((9, 1, 3), (0, 0, -1.25))])
def test_the_second_view_is_turned_and_stands_beside_the_first(sizes, away):
    mesh = ellipsoid(*sizes)
    blocks = several_views(mesh, BOTH, names=NAMES)
    assert blocks.keys() == ["front", "back"]
    np.testing.assert_array_equal(blocks[0].points, mesh.points)
    expected = mesh.bounds_size * np.array(away)
    np.testing.assert_allclose(np.subtract(blocks[1].center, blocks[0].center), expected, atol=1e-5)
    turned = np.asarray(blocks[1].points) - blocks[1].center
    expected = (np.asarray(mesh.points) - mesh.center) * (-1, -1, 1)
    np.testing.assert_allclose(turned, expected, atol=1e-5)
    np.testing.assert_array_equal(blocks[1]["x"], mesh["x"])
    np.testing.assert_allclose(blocks[1]["way"][0], (-1, -2, 3), atol=1e-6)
    np.testing.assert_array_equal(mesh["way"][0], (1, 2, 3))


def test_the_eye_of_the_first_sees_each_from_its_side_and_in_one_scale():
    # Width, depth and height of a part, which the front, its right side and the top show in pairs.
    part = pv.Box((0, 4, 0, 2, 0, 3))
    blocks = several_views(
        part, [(0, -1, 0), (1, 0, 0), (0, 0, 1)], names=("front", "side", "top"), aspect=3.0
    )
    flat = [np.delete(block.bounds_size, 1) for block in blocks]
    np.testing.assert_allclose(flat, [(4, 3), (2, 3), (4, 2)], atol=1e-6)
    # The right side shows the front at its left, and the top shows it below.
    corner = int(np.argmin(np.asarray(part.points) @ (0, 1, 0)))
    assert blocks["side"].points[corner, 0] < blocks["side"].center[0]
    assert blocks["top"].points[corner, 2] < blocks["top"].center[2]
    for one, other in ((0, 1), (1, 2), (0, 2)):
        left, right = blocks[one].bounds[1], blocks[other].bounds[0]
        assert left < right


def test_parts_of_a_mesh_stay_together():
    part = pv.Box((0, 4, 0, 2, 0, 3))
    corner = pv.PolyData(np.asarray(part.points)[:1])
    whole = several_views(part, BOTH, names=NAMES)
    alone = several_views(corner, BOTH, names=NAMES, around=part)
    both = several_views(pv.MultiBlock([part, corner]), BOTH, names=NAMES)
    for name in NAMES:
        np.testing.assert_allclose(alone[name].points[0], whole[name].points[0], atol=1e-6)
        np.testing.assert_allclose(both[name][1].points[0], whole[name].points[0], atol=1e-6)


def test_colors_of_bytes_are_no_vectors():
    mesh = pv.Sphere(theta_resolution=6, phi_resolution=6)
    mesh["rgb"] = np.full((mesh.n_points, 3), (250, 10, 20), np.uint8)
    mesh.cell_data["rgb"] = np.full((mesh.n_cells, 3), (1, 2, 3), np.uint8)
    turned = several_views(mesh, BOTH, names=NAMES)["back"]
    for rows, expected in (
        (turned.point_data["rgb"], (250, 10, 20)), (turned.cell_data["rgb"], (1, 2, 3))
    ):  # fmt: skip
        assert rows.dtype == np.uint8
        np.testing.assert_array_equal(rows[0], expected)


def seen(camera, points):
    """Return places in the picture of a parallel camera, in halves of its height."""
    axes = axes_of(np.negative(camera.direction).tolist(), camera.up)
    return (np.asarray(points) - camera.focal_point) @ axes[:2].T / camera.parallel_scale


@pytest.mark.parametrize(("place", "scale"), [((1.6, 0.3, 0.5, 0.4), None), ((0, -3, 9, 9), 1.0)])
def test_an_inset_is_seen_from_its_side_in_its_place_and_no_larger(place, scale):
    mesh = ellipsoid(4, 1, 3)
    mesh["V"] = np.arange(3.0 * mesh.n_points).reshape(-1, 3)
    camera = camera_on(mesh, (0.6, -1, 0.4), parallel=True)
    turned = inset(mesh, camera, (0, 0, 1), place, up=(0, 1, 0))
    lengths = np.linalg.norm(mesh["V"], axis=1)
    np.testing.assert_allclose(np.linalg.norm(turned["V"], axis=1), lengths, rtol=1e-5)
    flat = seen(camera, turned.points)
    middle, sizes = (flat.max(axis=0) + flat.min(axis=0)) / 2, np.ptp(flat, axis=0)
    np.testing.assert_allclose(middle, place[:2], atol=1e-5)
    if scale is None:
        assert np.isclose(np.max(sizes / place[2:]), 1, atol=1e-5)
        scale = float(sizes[0] * camera.parallel_scale / mesh.bounds_size[0])
    # Seen from above: x to the right and y up.
    expected = scale * np.asarray(mesh.points)[:, :2] / camera.parallel_scale
    np.testing.assert_allclose(flat - middle, expected, atol=1e-5)
    depth = (np.asarray(turned.center) - camera.focal_point) @ camera.direction
    assert abs(depth) < 1e-4
    part = inset(pv.PolyData(mesh.points[:1]), camera, (0, 0, 1), place, up=(0, 1, 0), around=mesh)
    np.testing.assert_allclose(part.points[0], turned.points[0], atol=1e-5)


@pytest.mark.parametrize(("right", "below"), [(0.8, 0.0), (0.0, 0.6)])
def test_a_picture_with_room_beside_has_that_of_its_camera_at_its_upper_left(right, below):
    camera = camera_on(ellipsoid(4, 1, 3), (0.6, -1, 0.4), parallel=True, aspect=1.5)
    wide = beside(camera, right=right, below=below)
    axes = axes_of(np.negative(camera.direction).tolist(), camera.up)
    half = camera.parallel_scale
    corner = np.asarray(camera.focal_point) + half * (-1.5 * axes[0] + axes[1])
    height = 1 + below / 2
    expected = np.array([-(1.5 + right / 2), height]) / height
    np.testing.assert_allclose(seen(wide, [corner])[0], expected, atol=1e-9)
    assert np.isclose(wide.parallel_scale, height * half)


test_places_that_are_none_are_refused = refusals(
    lambda place: inset(pv.Sphere(), camera_on(pv.Sphere(), parallel=True), (0, 0, 1), place),
    ((1, 2, 3), "place: expected a middle, a width and a height above 0"),
    ((0, 0, 1, 0), "place: expected a middle, a width and a height above 0"),
)
test_views_that_are_none_are_refused = refusals(
    lambda mesh, views, options: several_views(mesh, views, **options),
    (pv.Sphere(), [], {"names": ()}, "views: expected directions toward the eye"),
    (pv.Sphere(), BOTH, {"names": ("a",)}, "names: expected 2 texts"),
    (pv.Sphere(), BOTH, {"names": ("a", "a")}, "names: expected names that differ"),
    (pv.Sphere(), BOTH, {"names": NAMES, "up": [(0, 0, 1)]}, "up: expected 2 directions"),
    (pv.Sphere(), BOTH, {"names": NAMES, "aspect": 0.0}, "aspect"),
    (np.zeros(3), BOTH, {"names": NAMES}, "mesh: expected a PyVista mesh", TypeError),
)
