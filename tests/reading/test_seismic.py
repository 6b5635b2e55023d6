"""Traces of SEG-Y files at the places of their headers."""

import struct

import numpy as np
import pytest
from refusals import read_warned, refused, saved

import vizlight


def written(folder, places):
    """Write traces of four samples with the places of their depth points."""
    head = bytearray(3600)
    struct.pack_into(">H", head, 3216, 4000)
    struct.pack_into(">HHH", head, 3220, 4, 4, 5)
    for number, (x, y) in enumerate(places):
        trace = bytearray(240)
        struct.pack_into(">h", trace, 70, 1)
        struct.pack_into(">HH", trace, 114, 4, 4000)
        struct.pack_into(">ii", trace, 180, x, y)
        head += trace + struct.pack(">4f", *np.arange(4.0) + number)
    return saved(folder / "survey.segy", head)


def test_lines_of_traces_are_a_volume_by_their_depth_points(tmp_path):
    places = [(25 * i, 100 * j) for j in range(3) for i in range(4)]
    mesh = vizlight.read(written(tmp_path, places))
    assert mesh.dimensions == (4, 3, 4)
    assert mesh.bounds_size[:2] == (75, 200)
    np.testing.assert_array_equal(mesh["trace"].reshape(4, 12)[0], mesh["trace"][:12])


def test_traces_without_places_stand_in_a_row(tmp_path):
    mesh = read_warned(written(tmp_path, [(0, 0)] * 6), "stand in a row by number")
    assert np.unique(mesh.points[:, 0]).tolist() == [*range(6)]


@pytest.mark.parametrize(("place", "number"), [(3224, 10), (3600 + 114, 5)])
def test_headers_by_which_vtk_ends_the_process(tmp_path, place, number):
    data = bytearray(written(tmp_path, [(25 * i, 0) for i in range(6)]).read_bytes())
    struct.pack_into(">H", data, place, number)
    reason = "samples of the format 10" if number == 10 else "4 samples by its header, 5 by that of"
    refused(saved(tmp_path / "other.segy", data), reason)
