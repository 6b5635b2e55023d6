"""Slices of a stack on one sheet, as they lie in space."""

import numpy as np
import pyvista as pv
from refusals import refusals

import vizlight
from vizlight import files
from vizlight.mesh import montages


def stack(count=3, wide=20, high=16, apart=5.0):
    volume = pv.ImageData(dimensions=(wide, high, count), spacing=(1.0, 1.0, apart))
    x, y, z = np.asarray(volume.points, np.float64).T
    volume["scan"] = x + 100 * y + 10_000 * z / apart
    return volume


def test_slices_lie_in_rows_from_the_upper_left():
    """Two are beside each other in a sheet of one and a half times its height."""
    sheet = files.side_by_side(stack(), "scan")
    assert sheet.dimensions == (41, 33, 1)
    rows = sheet["scan"].reshape(33, 41)
    np.testing.assert_array_equal(
        rows[17:, :20], np.add.outer(100.0 * np.arange(16), np.arange(20))
    )
    np.testing.assert_array_equal(rows[17:, 21:] - rows[17:, :20], 10_000)
    np.testing.assert_array_equal(rows[:16, :20] - rows[17:, :20], 20_000)
    assert np.isnan(rows[16]).all()
    assert np.isnan(rows[:, 20]).all()
    assert np.isnan(rows[:16, 21:]).all()


def test_slices_are_seen_as_they_lie_in_space():
    """A stack that is turned about the vertical shows what is up, and to the right, as it is."""
    turned = stack().cast_to_structured_grid().rotate_x(90).rotate_z(180)
    rows = files.side_by_side(turned, "scan")["scan"].reshape(33, 41)
    # Its y rises; its x leads to the left, and its slices follow each other along y.
    first = rows[17:, :20]
    assert first[0, 0] == 19
    assert first[-1, 0] - first[0, 0] == 1500


def test_few_slices_far_apart_are_drawn_as_a_sheet():
    volume = stack(4, 24, 24)
    assert montages.is_stack(volume)
    look = vizlight.look(volume, size=(240, 160))
    assert look.shown == "slices"
    assert "side by side" in look.summary
    np.testing.assert_allclose(np.abs(look.view.direction), (0, 0, 1), atol=1e-6)
    assert montages.is_stack(stack(30, 120, 120))
    # Beside other meshes it is a body in space.
    both = vizlight.look([volume, pv.Sphere(center=volume.center)], size=(240, 160))
    assert "side by side" not in both.summary
    assert not montages.is_stack(stack(4, 24, 24, apart=1.0))
    assert not montages.is_stack(stack(12, 24, 24))
    assert not montages.is_stack(pv.Sphere())


test_a_sheet_needs_a_stack_and_its_array = refusals(
    files.side_by_side,
    (pv.Sphere(), "scan", "volume: expected an image or a grid"),
    (stack(), "other", "name: expected a point array of one component, one of"),
    (stack(), 3, "name: expected the name of a point array"),
    kind=(TypeError, ValueError),
)
