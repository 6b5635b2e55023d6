"""Numbers along the edges of a box."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.draw import box_axes as module
from vizlight.draw.box_axes import box_axes
from vizlight.draw.render import camera_on

BOX = (0, 4, -2, 2, 10, 13)
HEIGHT, SIZE = 500.0, 20.0


def made(direction=(1, 2, 1), parallel=False, bounds=BOX):
    """Return the axes of a box, and the words that were written at their places."""
    words = []

    def word(place, out, away, text, eye, size):
        words.append((text, place.copy(), out))
        return original(place, out, away, text, eye, size)

    original = module._word
    camera = camera_on(bounds, direction, parallel=parallel)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_word", word)
        mesh = box_axes(pv.Box(bounds), camera, HEIGHT, size=SIZE)
    return mesh, words, camera


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("direction", [(1, 2, 1), (-1, -3, 0.4), (2, -1, -0.7)])
def test_numbers_stand_at_their_places_outside_of_the_box(direction, parallel):
    mesh, words, camera = made(direction, parallel)
    eye = module._Eye(camera, HEIGHT)
    names = [text for text, *_ in words if text in "xyz"]
    assert sorted(names) == ["x", "y", "z"]
    numbers = [(float(text), place) for text, place, _ in words if text not in "xyz"]
    corners = np.reshape(np.meshgrid(BOX[:2], BOX[2:4], BOX[4:]), (3, -1)).T
    flat = eye.seen(corners)
    for value, place in numbers:
        ends = np.reshape(BOX, (3, 2))
        inside = [axis for axis in range(3) if place[axis] not in ends[axis]]
        # All but the axis of a number are those of an edge.
        assert len(inside) <= 1
        assert value in place
    # No letter covers what the box encloses: all are beyond a straight side of its outline.
    # Ticks begin on it.
    flat = flat.mean(axis=0) + 0.99 * (flat - flat.mean(axis=0))
    hull = pv.PolyData(np.column_stack([flat, np.zeros(8)])).delaunay_2d()
    points = eye.seen(np.asarray(mesh.points, dtype=float))
    within = hull.find_containing_cell(np.column_stack([points, np.zeros(len(points))]))
    assert (within < 0).all()


def test_letters_face_the_eye_and_have_their_size():
    mesh, words, camera = made()
    eye = module._Eye(camera, HEIGHT)
    corners = mesh.points[mesh.regular_faces].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    cosines = np.abs(normals @ eye.away) / lengths
    assert cosines[lengths > 1e-9].min() > 0.999
    alone = box_axes(pv.Box((0, 1, 0, 1, 0, 0)), camera_on(BOX, (0, 0, 1)), HEIGHT, size=SIZE)
    assert alone.n_points == 0 or np.isfinite(alone.points).all()
    _, place, out = words[0]
    points, _ = module._word(place, out, 0.0, "8", eye, SIZE)
    assert np.ptp(eye.seen(points)[:, 1]) == pytest.approx(module.DIGIT * SIZE, rel=0.05)


def test_a_box_that_is_a_point_has_no_axes():
    assert not made(bounds=(1, 1, 2, 2, 3, 3))[0].n_points


def test_what_is_no_box_is_refused():
    camera = camera_on(BOX)
    with pytest.raises(TypeError, match="mesh: expected a mesh"):
        box_axes(3, camera, HEIGHT, size=SIZE)
    with pytest.raises(ValueError, match="height"):
        box_axes(pv.Box(), camera, 0, size=SIZE)
    with pytest.raises(ValueError, match="names: expected 3 texts"):
        box_axes(pv.Box(), camera, HEIGHT, size=SIZE, names=["x", "y"])
    lost = pv.PolyData(np.array([[0.0, 0, 0], [np.inf, 1, 1]]))
    with pytest.raises(ValueError, match="mesh"):
        box_axes(lost, camera, HEIGHT, size=SIZE)


def test_captions_stand_around_blocks_and_the_bar_is_as_long_as_it_says():
    pair = pv.MultiBlock({"front": pv.Box((0, 170, 0, 60, 0, 110))})
    pair["back"] = pv.Box((200, 370, 0, 60, 0, 110))
    camera = camera_on(pair, (0, -1, 0), parallel=True)
    eye = module._Eye(camera, HEIGHT)
    written = []

    def word(text, place, middle, eye, size):
        written.append((text, eye.seen(place) + size * middle))
        return original(text, place, middle, eye, size)

    original = module._written
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_written", word)
        ends = [("a", "p"), ("p", "a")]
        mesh = module.captions(pair, camera, HEIGHT, size=SIZE, ends=ends, unit="mm")
    assert [text for text, _ in written] == ["front", "a", "p", "back", "p", "a", "50 mm"]
    corners = eye.seen(np.asarray(pair["front"].points, dtype=float))
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    (x, y), first, second = (spot for _, spot in written[:3])
    assert y > high
    assert x == pytest.approx((left + right) / 2, abs=1)
    assert left < first[0] < second[0] < right
    assert first[1] == second[1] < low
    bar = np.asarray(mesh.points, dtype=float)
    # The longest triangles are those of the bar.
    faces = bar[mesh.regular_faces]
    assert np.ptp(faces[:, :, 0], axis=1).max() == pytest.approx(50, rel=1e-5)


def test_captions_need_blocks_and_two_ends_for_each():
    pair, camera = pv.MultiBlock([pv.Box(), pv.Box()]), camera_on(BOX)
    with pytest.raises(TypeError, match="meshes: expected a PyVista mesh"):
        module.captions(np.zeros(3), camera, HEIGHT, size=SIZE)
    with pytest.raises(ValueError, match="ends: expected two words for each of the 2 blocks"):
        module.captions(pair, camera, HEIGHT, size=SIZE, ends=[("a", "p")])


def test_numbers_along_z_are_not_beside_those_of_another_axis():
    # From the left and above: the edge of y goes on in that of z at the left.
    bounds = (-1.3, 1.3, -1.3, 1.3, 0, 0.9)
    _, words, camera = made((-0.35, -1, 0.75), bounds=bounds)
    eye = module._Eye(camera, HEIGHT)
    names = {text: eye.seen(place) for text, place, _ in words if text in "xyz"}
    assert names["z"][0] > names["x"][0] > names["y"][0]


def test_axes_have_the_names_that_are_given():
    camera = camera_on(BOX, (1, 1, 1))
    usual = box_axes(pv.Box(), camera, HEIGHT, size=SIZE)
    named = box_axes(pv.Box(), camera, HEIGHT, size=SIZE, names=["x (mm)", "y", "z"])
    # A parenthesis has no place in the usual names.
    assert named.n_cells > usual.n_cells


def test_names_take_the_place_of_those_of_blocks():
    blocks = pv.MultiBlock({"a": pv.Box()})
    camera = camera_on(blocks, (0, -1, 0), parallel=True)
    own, given, none = (
        module.captions(blocks, camera, HEIGHT, size=SIZE, names=names)
        for names in (None, ["aa"], ())
    )
    assert given.n_cells == 2 * own.n_cells
    assert not none.n_cells
    with pytest.raises(ValueError, match="names: expected 1 text, got"):
        module.captions(blocks, camera, HEIGHT, size=SIZE, names=["a", "b"])


def test_a_bar_alone_stands_below_a_mesh_and_below_words_that_leave_it_no_room():
    box = pv.Box((0, 170, 0, 60, 0, 110))
    camera = camera_on(box, (0, -1, 0), parallel=True)
    bar = module.captions(pv.MultiBlock([box]), camera, HEIGHT, size=SIZE, unit="mm", names=())
    assert np.array_equal(
        bar.points, module.captions(box, camera, HEIGHT, size=SIZE, unit="mm").points
    )
    assert bar.bounds[5] < 0
    low = []
    for words in ("a", "a long word"):
        around = module.captions(box, camera, HEIGHT, size=SIZE, unit="mm", ends=[(words, words)])
        low.append(around.bounds[4])
    assert low[1] < low[0] - 0.5 * (bar.bounds[5] - bar.bounds[4])
