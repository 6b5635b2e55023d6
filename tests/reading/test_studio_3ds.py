"""Objects of 3D Studio, and files of them that are not whole."""

import struct

import numpy as np
import pytest
from refusals import read_warned, refused, saved


def chunk(kind, data):
    return struct.pack("<HI", kind, 6 + len(data)) + data


def rows(kind, numbers, count, width, more=b""):
    """Return a chunk of rows of numbers, which states a count of them."""
    return chunk(kind, struct.pack(f"<H{len(numbers)}{width}", count, *numbers) + more)


def studio(*corners, count=1, more=b""):
    """Return a file of three points and a triangle, and of an object without triangles."""
    points = rows(0x4110, (0, 0, 0, 1, 0, 0, 0, 1, 0), 3, "f")
    faces = rows(0x4120, (*corners, 7), count, "H", more)
    material = chunk(0xAFFF, chunk(0xA000, b"m\0"))
    objects = [chunk(0x4000, b"s\0" + chunk(0x4100, part)) for part in (points + faces, points)]
    return chunk(0x4D4D, chunk(0x3D3D, material + b"".join(objects)))


@pytest.mark.filterwarnings("default:.*left out")
def test_objects_with_triangles(tmp_path):
    """Also where a list of the triangles of a material names one that is not there."""
    (tmp_path / "a.3ds").write_bytes(
        studio(2, 0, 1, more=chunk(0x4130, b"m\0" + struct.pack("<HH", 1, 65535)))
    )
    mesh = read_warned(tmp_path / "a.3ds", "1 of 2 objects are left out: no triangles")
    np.testing.assert_array_equal(mesh.points, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    assert mesh.get_cell(0).point_ids == [2, 0, 1]
    assert mesh.n_cells == 1


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (studio(0, 1, 9), "a triangle has the point 9 of 3"),
        (studio(0, 1, 2, count=99), "99 rows are not within 8 bytes"),
        (studio(0, 1, 2)[:-1], "a part of .* bytes is not within"),
        (b"", "no points"),
    ],
)
def test_files_that_are_not_whole(tmp_path, content, words):
    refused(saved(tmp_path / "a.3ds", content), words)
