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
    lost = pv.PolyData(np.array([[0.0, 0, 0], [np.inf, 1, 1]]))
    with pytest.raises(ValueError, match="mesh"):
        box_axes(lost, camera, HEIGHT, size=SIZE)
