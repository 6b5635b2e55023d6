"""Points of PCD files: their places, colours, normals and values."""

import numpy as np
import pytest

import vizlight
from vizlight.files import FileError
from vizlight.mesh import meaning

HEAD = "VERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nWIDTH {}\nHEIGHT {}\nPOINTS 3\nDATA {}\n"


def written(folder, fields, body, *, sizes="4 4 4 4", types="F F F F", rows=1, form="ascii"):
    path = folder / "scan.pcd"
    path.write_bytes(HEAD.format(fields, sizes, types, 3 // rows, rows, form).encode() + body)
    return path


def test_points_in_text_have_values_and_those_without_a_place_are_left_out(tmp_path):
    body = b"1 2 3 10\nnan nan nan 20\n4 5 6 30\n"
    mesh = vizlight.read(written(tmp_path, "x y z intensity", body))
    assert mesh.points.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert mesh["intensity"].tolist() == [10, 30]
    with pytest.raises(FileError, match="2 of 3 points are there"):
        vizlight.read(written(tmp_path, "x y z intensity", body[:-9]))
    with pytest.raises(FileError, match="expected x, y and z among them"):
        vizlight.read(written(tmp_path, "x y w intensity", body))
    (tmp_path / "scan.pcd").write_text("1 2 3\n")
    with pytest.raises(FileError, match="no line DATA"):
        vizlight.read(tmp_path / "scan.pcd")


def test_points_of_a_camera_are_upright_and_colours_are_in_four_bytes(tmp_path):
    rows = np.zeros(3, [("place", "<f4", 3), ("rgb", "<u4")])
    rows["place"] = [[0, -1, 2], [0, 0, 2], [0, 1, 3]]
    rows["rgb"] = 0x0A141E
    options = {"types": "F F F U", "rows": 3, "form": "binary"}
    mesh = vizlight.read(written(tmp_path, "x y z rgb", rows.tobytes(), **options))
    assert mesh.points.tolist() == [[0, 2, 1], [0, 2, 0], [0, 3, -1]]
    assert mesh["color"].tolist() == [[10, 20, 30]] * 3
    assert "z up" in meaning.line(mesh)


def test_normals_turn_with_the_points(tmp_path):
    fields = "x y z normal_x normal_y normal_z"
    options = {"sizes": "4 4 4 4 4 4", "types": "F F F F F F", "rows": 3}
    body = b"0 -1 2 0 -1 0\n0 0 2 0 0 -1\n0 1 3 1 0 0\n"
    mesh = vizlight.read(written(tmp_path, fields, body, **options))
    assert mesh.point_data.active_normals.tolist() == [[0, 0, 1], [0, -1, 0], [1, 0, 0]]


def test_packed_fields_follow_one_another(tmp_path):
    # Two literals of four bytes, one of them and six more that repeat what came before.
    ones = np.float32(1).tobytes()
    packed = b"\x03" + ones + b"\x03" + ones + b"\xe0\x13\x03"
    sizes = np.array([len(packed), 36], "<u4").tobytes()
    options = {"sizes": "4 4 4", "types": "F F F", "form": "binary_compressed"}
    mesh = vizlight.read(written(tmp_path, "x y z", sizes + packed, **options))
    assert mesh.points.tolist() == [[1, 1, 1]] * 3
