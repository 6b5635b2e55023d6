"""Tests of scans that are cut open."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import files


def head(size=40, air=0.0):
    """Scan of a ball with a dark shell under its skin, a cavity, and a neck that the scan cuts."""
    scan = pv.ImageData(dimensions=(size, size, size), origin=(-(size - 1) / 2,) * 3)
    radius = np.linalg.norm(scan.points, axis=1)
    values = np.select([radius < 3, radius < 12, radius < 13, radius < 15], [0, 100, 0, 90], 0)
    neck = (np.linalg.norm(np.asarray(scan.points)[:, :2], axis=1) < 8) & (scan.points[:, 2] < -8)
    values[neck & (radius > 12)] = 80
    scan["T1"] = values + air + np.arange(scan.n_points) % 5
    return scan


@pytest.mark.parametrize("air", [0.0, -1000.0])
@pytest.mark.parametrize("toward", [(1, 1, 1), (-1, 2, -0.5)])
def test_the_corner_toward_the_eye_is_taken_out_of_a_body(air, toward):
    scan = head(air=air)
    before = np.array(scan["T1"])
    parts = files.cut_open(scan, "T1", toward=toward)
    np.testing.assert_array_equal(scan["T1"], before)
    skin, cut, signs = parts["skin"], parts["cut"], np.sign(toward)
    places = np.asarray(skin.points)
    round_part = places[places[:, 2] > -5]
    np.testing.assert_allclose(np.linalg.norm(round_part, axis=1), 15, atol=1)
    # The middle of the body is below that of the ball.
    middle = np.array([0.5, 0.5, -1.5])
    assert ((places - middle) * signs).min(axis=1).max() == pytest.approx(0, abs=1.01)
    np.testing.assert_allclose(cut["T1"], cut.sample(scan)["T1"], atol=1e-3)
    # The cavity and the dark shell are seen in the cut, and the neck where the scan ends.
    radius = np.linalg.norm(cut.points, axis=1)
    assert cut["T1"][radius < 2].max() < air + 6
    assert cut["T1"][radius < 10].max() > air + 99
    assert (cut["T1"][(radius > 12.1) & (radius < 12.9)] < air + 60).any()
    assert (cut.points[:, 2] == scan.bounds[4]).any()


def test_axes_that_are_turned_are_those_of_the_scan():
    scan = head()
    turned = scan.copy()
    turned.direction_matrix = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    plain, other = (
        files.cut_open(each, "T1", toward=toward)["skin"].points @ matrix
        for each, toward, matrix in (
            (scan, (1, 1, 1), np.eye(3)),
            (turned, (1, -1, 1), np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])),
        )
    )
    assert plain.shape == other.shape


def test_what_stands_in_no_air_is_a_box_without_skin():
    scan = head()
    scan["T1"] = np.arange(scan.n_points) % 97.0
    parts = files.cut_open(scan, "T1")
    assert not parts["skin"].n_points
    assert parts["cut"].bounds == scan.bounds
    assert vizlight.look(scan).summary.startswith("slices of T1")


def test_only_scans_are_cut_open():
    with pytest.raises(TypeError, match=r"volume: expected a pyvista\.ImageData, got"):
        files.cut_open(pv.Sphere(), "T1")
    with pytest.raises(ValueError, match="name: expected a point array"):
        files.cut_open(head(), "T2")
    sheet = pv.ImageData(dimensions=(4, 4, 1))
    sheet["T1"] = np.arange(16.0)
    with pytest.raises(ValueError, match="volume: expected an image of two points at least along"):
        files.cut_open(sheet, "T1")
