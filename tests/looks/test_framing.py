"""From where data are seen: maps from above, patches along their normal, solids from a side."""

import itertools

import numpy as np
import pytest
import pyvista as pv

from vizlight import look
from vizlight.looks import framing
from vizlight.looks.contents import Contents
from vizlight.looks.framing import eye_of
from vizlight.mesh import georeference, meaning


def eye(mesh):
    return eye_of(mesh, Contents(mesh))


@pytest.mark.parametrize(
    ("direction", "toward"),
    [((0, 0, 1), (0, 0, 1)), ((1, 0, 0), (1, 0, 0)), ((0, 1, 0), (0, -1, 0))],
)
def test_a_sheet_is_seen_along_its_axis(direction, toward):
    viewpoint = eye(pv.Plane(direction=direction, i_size=3, j_size=2))
    assert viewpoint.toward == toward
    assert viewpoint.parallel


def test_a_strip_lies_along_the_picture():
    strip = pv.Plane(i_size=1, j_size=9)
    viewpoint = eye(strip)
    right = np.cross(viewpoint.up, viewpoint.toward)
    assert abs(right[1]) == pytest.approx(1)


def test_a_map_is_turned_by_a_right_angle_if_at_all():
    """Meridians and parallels are beside it, whatever way its points lie."""
    for size, up in ((0.2, (0, 1, 0)), (0.01, (1, 0, 0))):
        track = np.linspace((1, 40, 0), (1 + size, 40.2, 0), 50)
        track[::2, 0] += size / 50
        points = georeference.in_metres(georeference.in_degrees(pv.PolyData(track)))
        assert tuple(eye(points).up) == up


def test_what_has_no_side_up_lies_across_with_its_thin_side_in_depth():
    ball = pv.Sphere().scale((2, 1, 9)).rotate_x(25).rotate_z(40)
    viewpoint = framing.eye_across(ball)
    right = np.cross(viewpoint.up, viewpoint.toward)
    sizes = [np.ptp(ball.points @ way) for way in (viewpoint.toward, viewpoint.up, right)]
    np.testing.assert_allclose(sizes, (1, 2, 9), rtol=0.02)


def test_an_open_patch_is_seen_along_its_mean_normal():
    patch = pv.Plane(direction=(1, 2, 3), i_resolution=20, j_resolution=20)
    patch.points += 0.02 * np.sin(9 * patch.points[:, [1, 2, 0]])
    np.testing.assert_allclose(eye(patch).toward, np.array((1, 2, 3)) / 14**0.5, atol=0.1)


def test_a_solid_shows_its_large_side():
    slab = pv.Cube(x_length=1, y_length=9, z_length=4).triangulate().subdivide(4)
    toward = np.array(eye(slab).toward)
    assert abs(toward[0]) > 0.5
    assert 0 < toward[2] < 0.7


def test_a_hollow_is_looked_into():
    """The open side of a half pipe faces the eye."""
    pipe = pv.Cylinder(direction=(0, 0, 1), height=4, resolution=60, capping=False).triangulate()
    half = pipe.subdivide(2).clip((0, 1, 0), invert=True)
    assert eye(half).toward[1] != 0


@pytest.mark.parametrize("sign", [-1, 1])
def test_the_side_that_shows_most_kinds_is_seen(sign):
    # Small parts on one side of a block.
    parts = [pv.Box((0, 8, 0, 6, 0, 5), level=8)]
    parts += [pv.Sphere(radius=0.6, center=(x, 3 + 3.2 * sign, 2.5)) for x in (1.5, 4, 6.5)]
    for kind, part in enumerate(parts):
        part.clear_data()
        part.cell_data["part"] = np.full(part.n_cells, kind)
    whole = pv.merge(parts, merge_points=False).extract_surface(algorithm="dataset_surface")
    assert eye_of(whole, Contents(whole), "part").toward[1] * sign > 0.3


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_case_of_thin_walls_is_seen_from_its_open_side(axis, sign):
    # Thin walls are seen from behind too; two balls are inside.
    walls = []
    for i, end in itertools.product(range(3), (-1, 1)):
        sizes, middle = np.full(3, 6.0), np.zeros(3)
        sizes[i], middle[i] = 0.1, 3.0 * end
        if (i, end) != (axis, sign):
            bounds = np.column_stack([middle - sizes / 2, middle + sizes / 2]).ravel()
            walls.append(pv.Box(bounds))
    case = pv.merge(walls, merge_points=False)
    parts = [case, *(pv.Sphere(radius=1.0, center=(0, 0, z)) for z in (-1.5, 1.5))]
    for kind, part in enumerate(parts):
        part.clear_data()
        part.cell_data["solid"] = np.full(part.n_cells, kind)
    whole = pv.merge(parts, merge_points=False).extract_surface(algorithm="dataset_surface")
    assert eye_of(whole, Contents(whole), "solid").toward[axis] * sign > 0.5


def test_the_side_that_shows_most_of_the_values_is_seen():
    box = pv.Box(bounds=(0, 1, 0, 1, 0, 1), level=8).triangulate()
    box.clear_data()
    points = np.asarray(box.points)
    for axis, sign in ((0, 1), (0, -1), (1, 1), (1, -1)):
        # Values on one side alone, which alternate along it.
        on = points[:, axis] == (sign > 0)
        box["v"] = np.where(on, np.sin(9 * points[:, 1 - axis]), 0.0)
        toward = eye_of(box, Contents(box), "v").toward
        assert toward[axis] * sign > 0.3
    # A few large faces hide what is behind them too.
    coarse = pv.Cube().triangulate()
    _, corners, _ = framing._triangles(coarse)
    way, places = np.array([0.8, 0.5, 0.33]), framing._places(corners)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.array_equal(
        framing._in_front(places, len(corners), way / np.linalg.norm(way)), normals @ way > 0
    )


@pytest.mark.parametrize(("axis", "toward"), [(0, (1, 0, 0)), (1, (0, -1, 0)), (2, (0, 0, 1))])
def test_a_slab_is_seen_across(axis, toward):
    spacing = np.full(3, 0.1)
    spacing[axis] = 0.01
    slab = pv.ImageData(dimensions=(8, 9, 8), spacing=spacing).cast_to_structured_grid()
    assert eye_of(slab, Contents(slab)).toward == toward
    thick = pv.ImageData(dimensions=(8, 9, 8)).cast_to_structured_grid()
    assert np.abs(eye_of(thick, Contents(thick)).toward).max() < 0.99


def test_a_long_thing_lies_across_the_picture():
    # A thick end that an eye in front of it would see most of.
    bar = pv.Cylinder(direction=(1, 0, 0), radius=0.4, height=5).triangulate()
    head = pv.Cube(center=(2.5, 0, 0), x_length=0.3, y_length=2, z_length=2).triangulate()
    assert abs(eye(pv.merge([bar, head]).extract_surface(algorithm=None)).toward[0]) < 0.5


def test_a_surface_that_its_box_cuts_is_seen_near_a_diagonal():
    grid = pv.ImageData(dimensions=(30,) * 3, spacing=(0.25,) * 3)
    x, y, z = np.asarray(grid.points).T
    grid["f"] = np.cos(x) + np.cos(y) + np.cos(z)
    toward = framing.eye_around(grid.contour([0.0], scalars="f"), cut=True).toward
    assert toward[2] == pytest.approx(0.5)
    assert min(abs(toward[0]), abs(toward[1])) > 0.5


@pytest.mark.parametrize(("turn", "slope"), [(0, 0.0), (90, 0.0), (0, 0.03)])
def test_a_thing_that_stands_along_y_has_y_up(turn, slope):
    foot = pv.Cone(direction=(0, 1, 0), radius=0.6, resolution=24).triangulate().subdivide(3)
    # The foot of a bust is uneven.
    foot.points[:, 1] += slope * foot.points[:, 0]
    thing = foot.rotate_x(turn)
    viewpoint = eye(thing)
    assert viewpoint.up == ((0, 1, 0) if turn == 0 else (0, 0, 1))
    # It is seen from above its foot.
    assert np.dot(viewpoint.toward, viewpoint.up) > 0.3


@pytest.mark.parametrize(("turn", "up"), [(0, (0, 1, 0)), (90, (0, 0, 1))])
def test_a_model_that_stands_on_nothing_has_y_up_unless_it_is_mirrored_in_y(turn, up):
    # A head without a foot, the same on its left and its right, which are along z.
    head = pv.Sphere(theta_resolution=40, phi_resolution=40)
    nose = pv.Cone(center=(0.6, 0.1, 0), direction=(1, 0, 0), height=0.5, radius=0.15)
    chin = pv.Sphere(radius=0.2, center=(0.3, -0.45, 0))
    thing = pv.merge([head, nose, chin]).extract_surface(algorithm=None).triangulate()
    thing = thing.rotate_x(turn)
    assert eye_of(thing, Contents(thing), is_model=True).up == up
    assert eye(thing).up == (0, 0, 1)


def test_a_model_that_stands_along_z_has_z_up():
    foot = pv.Cone(direction=(0, 0, 1), radius=0.6, resolution=24).triangulate().subdivide(3)
    assert eye_of(foot, Contents(foot), is_model=True).up == (0, 0, 1)
    thing = foot.rotate_x(-90)
    assert eye_of(thing, Contents(thing), is_model=True).up == (0, 1, 0)


def test_an_image_of_depths_is_seen_from_the_side_of_its_camera():
    x, z = (part.ravel() for part in np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)))
    cloud = pv.PolyData(np.stack([x, 2 + x**2 + z, z], axis=1))
    meaning.attach(cloud, meaning.Meaning(axes=[*meaning.CAMERA]))
    toward = eye_of(cloud, Contents(cloud)).toward
    assert toward[1] < -0.9 * np.linalg.norm(toward)


@pytest.mark.parametrize("name", ["head.obj", "head.OFF", "head.stl"])
def test_a_file_of_a_model_has_y_up(tmp_path, name):
    head = pv.ParametricEllipsoid(1.0, 1.4, 0.8).triangulate()
    head.points[:, 0] += 0.3 * head.points[:, 1] * np.abs(head.points[:, 1])
    path = tmp_path / name
    faces = head.regular_faces
    if path.suffix == ".OFF":
        rows = [f"OFF\n{len(head.points)} {len(faces)} 0"]
        rows += [" ".join(map(str, point)) for point in head.points]
        rows += [f"3 {a} {b} {c}" for a, b, c in faces]
        path.write_text("\n".join(rows) + "\n")
    else:
        head.clear_data()
        head.save(path)
    up = look(path).view.up
    assert tuple(np.round(up)) == ((0, 0, 1) if name == "head.stl" else (0, 1, 0))


@pytest.mark.parametrize("thing", [pv.Sphere(), pv.Cube(), pv.Cylinder(direction=(0, 1, 0))])
def test_what_stands_along_several_axes_has_z_up(thing):
    assert eye(thing.triangulate()).up == (0, 0, 1)


@pytest.mark.parametrize(
    ("sizes", "middle", "toward"),
    [
        ((130, 170, 120), 0, (1, 0, 0)),
        ((50, 120, 90), -30, (-1, 0, 0)),
        ((120, 20, 90), 0, (0, 1, 0)),
        ((120, 90, 20), 0, (0, 0, 1)),
    ],
)
def test_a_body_is_seen_from_its_side_if_that_is_nearly_as_large(sizes, middle, toward):
    places = np.random.default_rng(1).uniform(-0.5, 0.5, (500, 3)) * sizes + (middle, 0, 0)
    assert framing.eye_on_body(pv.PolyData(places)).toward == toward
