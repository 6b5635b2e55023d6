"""The visible cells of a picture against rays through its pixels."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.draw.cameras import camera_on
from vizlight.observers import pixels
from vizlight.observers.pixels import Cells
from vizlight.observers.samples import rays, weights
from vizlight.vtk.arrays import GridPoints

pytestmark = pytest.mark.opengl


def seen(meshes, camera, size=(300, 200)):
    parts = [Cells(mesh.points, mesh.regular_faces, 1.0) for mesh in meshes]
    return pixels.visible(parts, camera, size)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("offset", [0.0, 5e6])
def test_a_pixel_shows_the_cell_that_its_ray_meets_first(parallel, offset):
    ball = pv.Icosphere(nsub=3, center=(offset, 0, 0))
    ball.points = ball.points.astype(np.float64)
    small = pv.Icosphere(nsub=1, radius=0.4, center=(offset + 1, 1, 1))
    small.points = small.points.astype(np.float64)
    meshes = [ball, small]
    camera = camera_on(pv.MultiBlock(meshes), (1, 0.8, 1), parallel=parallel)
    camera.SetWindowCenter(0.1, -0.2)  # as for a picture with a title
    found = seen(meshes, camera)
    pick = np.random.default_rng(0).permutation(len(found.part))[:200]
    sight = rays(camera, found.at[pick])
    right = 0
    for i, origin, way in zip(pick, *sight, strict=True):
        hits = []
        for number, mesh in enumerate(meshes):
            places, cells = mesh.ray_trace(origin, origin + 20 * way)
            hits += [
                (float((place - origin) @ way), number, cell)
                for place, cell in zip(places, cells, strict=True)
            ]
        right += bool(hits) and min(hits)[1:] == (found.part[i], found.cell[i])
    # Rounding to pixels may give a neighbour at an edge.
    assert right > 190


def test_places_lie_on_the_lines_of_sight():
    random = np.random.default_rng(1)
    camera = camera_on((-1, 1, -1, 1, -1, 1), (1, 2, 3))
    at = random.uniform(-0.3, 0.3, (500, 2))
    origin, way = rays(camera, at)
    share = random.dirichlet(np.ones(3), 500)
    middle = origin + random.uniform(2, 6, (500, 1)) * way
    corners = random.normal(size=(500, 3, 3))
    corners += (middle - np.einsum("ms,msn->mn", share, corners))[:, np.newaxis]
    np.testing.assert_allclose(weights(corners, origin, way), share, atol=1e-8)
    ends = corners[:, :2]
    found = weights(ends, origin, way)
    assert np.all(found >= 0)
    place = np.einsum("ms,msn->mn", found, ends) - origin
    off = np.linalg.norm(np.cross(place, way), axis=1)
    for share in (0.2, 0.5, 0.9):  # no other place on the segment is nearer
        other = share * ends[:, 0] + (1 - share) * ends[:, 1] - origin
        assert np.all(off <= np.linalg.norm(np.cross(other, way), axis=1) + 1e-12)


def test_each_byte_of_the_number_of_a_cell_is_drawn():
    plane = pv.Plane(i_size=2, j_size=2, i_resolution=300, j_resolution=300).triangulate()
    assert plane.n_cells > 2 << 16
    found = seen([plane], above(parallel=True), (100, 100))
    middles = np.asarray(plane.cell_centers().points)[found.cell, :2]
    np.testing.assert_allclose(middles, found.at, atol=0.01)


def above(height=2.0, parallel=False):
    """Return a camera on the z axis that sees a square of a side of 2 at z = 0."""
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, height), (0, 0, 0), (0, 1, 0)
    camera.parallel_projection, camera.parallel_scale = parallel, 1.0
    camera.view_angle = 2 * np.degrees(np.arctan(1 / height))
    return camera


@pytest.mark.parametrize("parallel", [False, True])
def test_a_pixel_is_a_share_of_what_the_camera_sees(parallel):
    camera = above(parallel=parallel)
    points = np.array([[0, 0, 0], [0.5, 0.2, 1.0], [0, 0, -2.0]])
    expected = np.array([1, 1, 1]) if parallel else np.array([1, 0.5, 2])
    np.testing.assert_allclose(pixels.footprint(camera, points, 100), 0.02 * expected)
    toward = pixels.toward_eye(camera, points)
    np.testing.assert_allclose(toward[0], [0, 0, 1], atol=1e-12)
    way = [0, 0, 1] if parallel else np.array([-0.5, -0.2, 1]) / np.sqrt(1.29)
    np.testing.assert_allclose(toward[1], way, atol=1e-12)


def test_lines_of_a_diameter_are_bands_of_its_width_and_no_narrower_than_asked():
    points = np.array([[-0.5, 0, 0], [0.5, 0, 0], [0.5, 0, 1]], float)
    lines = Cells(points, np.array([[0, 1], [2, 1]]), 3.0, 0.2)
    camera = above(parallel=True)
    both = np.array([0, 1])
    np.testing.assert_allclose(lines.widths(both, camera, 100), [10, 10])
    np.testing.assert_allclose(lines.widths(both, above(), 100), [10, 20])
    np.testing.assert_allclose(lines.widths(both[1:], above(), 100), [20])
    np.testing.assert_allclose(lines.widths(both, camera, 20), [3, 3])
    np.testing.assert_allclose(lines._replace(diameter=None).widths(both, camera, 100), [3, 3])
    bands = pv.PolyData(lines.data(slice(0, 2), camera, 100))
    where = bands.points.reshape(-1, 4, 3)[0]
    np.testing.assert_allclose(np.abs(where[:, :2]), np.tile([0.5, 0.1], (4, 1)), atol=1e-6)
    np.testing.assert_allclose(where[:, 2], 0.1, atol=1e-6)
    assert bands.regular_faces.shape == (4, 3)
    found = pixels.visible([lines], camera, (100, 100))
    assert np.count_nonzero(found.cell == 0) == pytest.approx(50 * 10, rel=0.1)
    np.testing.assert_allclose(np.abs(found.at[:, 1]).max(), 0.09, atol=0.011)


def test_cells_drawn_in_blocks_are_those_of_one_drawing(monkeypatch):
    ball, line = pv.Sphere(), pv.Line((-1, 0, 0.2), (1, 0, 0.2), resolution=9)
    meshes = [
        Cells(ball.points, ball.regular_faces, 1.0),
        Cells(line.points, np.stack([np.arange(9), np.arange(1, 10)], axis=1), 3.0, 0.1),
    ]
    plane = pv.Actor(mapper=pv.DataSetMapper(pv.Plane(center=(0.5, 0.2, 0.6), i_size=0.5)))
    whole = pixels.visible(meshes, above(), (100, 100), [plane])
    monkeypatch.setattr(pixels, "BLOCK", 300)
    blocks = pixels.visible(meshes, above(), (100, 100), [plane])
    assert {0, 1} == {*whole.part}
    for this, other in zip(whole[:4], blocks[:4], strict=True):
        np.testing.assert_array_equal(this, other)


@pytest.mark.parametrize(
    "corners", [[[3, 5], [5, 4]], [[90, 7], [7, 40], [3, 7]], [[0, 8], [1, 8]], [[0, 7], [1, 7]]]
)
def test_cells_take_the_points_between_their_corners_unless_these_are_far_apart(corners):
    grid, corners = pv.ImageData(dimensions=(10, 10, 1)), np.array(corners)
    for source in (np.asarray(grid.points), GridPoints(grid)):
        points, own = pixels.with_own_points(source, corners)
        np.testing.assert_array_equal(points[own], grid.points[corners])
        # Twice as many points in a row as corners at most.
        spread = np.ptp(corners) + 1
        assert len(points) == (spread if spread <= 2 * corners.size else len(np.unique(corners)))


def test_a_drawing_has_blocks_in_their_order_and_no_more_than_two_full_ones(monkeypatch):
    monkeypatch.setattr(pixels, "BLOCK", 10)
    sizes = [10, 10, 4, 10, 3, 3, 3, 3, 9]
    blocks = [pixels._Block(i, None, slice(5, 5 + size)) for i, size in enumerate(sizes)]
    drawings = pixels._drawings(blocks)
    assert [[block.size for block in drawing] for drawing in drawings] == [
        [10], [10], [4, 10], [3, 3, 3, 3], [9]
    ]  # fmt: skip
    assert [block for drawing in drawings for block in drawing] == blocks


def test_occluders_hide_cells_and_take_no_pixels():
    plane, front = pv.Plane(i_size=1, j_size=1), pv.Plane(center=(0.25, 0, 0.5), i_size=0.5)
    camera = above(parallel=True)
    part = Cells(plane.triangulate().points, plane.triangulate().regular_faces, 1.0)
    actor = pv.Actor(mapper=pv.DataSetMapper(front))
    actor.prop.color, actor.prop.lighting = "black", False
    whole, half = (pixels.visible([part], camera, (100, 100), o) for o in ((), (actor,)))
    assert len(whole.row) == 2500
    assert len(half.row) == 1250
    assert half.column.max() == 49


def test_a_line_on_a_surface_is_seen_whole():
    plane = pv.Plane(i_size=1, j_size=1).triangulate()
    line = Cells(np.array([[-0.5, 0.1, 0], [0.5, 0.1, 0]]), np.array([[0, 1]]), 2.0)
    camera = above()
    camera.elevation = 20
    parts = [Cells(plane.points, plane.regular_faces, 1.0), line]
    found = pixels.visible(parts, camera, (100, 100))
    assert np.count_nonzero(found.part == 1) >= 2 * 48


def test_points_behind_the_eye_have_no_place_in_the_picture():
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, 3), (0, 0, 0), (0, 1, 0)
    found = pixels.in_pixels(camera, (60, 40), np.array([[0, 0, 0], [0, 0, 4.0]]))
    np.testing.assert_allclose(found, [[30, 20], [np.nan, np.nan]])
