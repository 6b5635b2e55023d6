"""Points of PCD files: their places, colours, normals and values."""

import numpy as np
import pytest
from refusals import refused, saved

import vizlight
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
    refused(written(tmp_path, "x y z intensity", body[:-9]), "2 of 3 points are there")
    refused(written(tmp_path, "x y w intensity", body), "expected x, y and z among them")
    refused(saved(tmp_path / "scan.pcd", "1 2 3\n"), "no line DATA")


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


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("hello\n", "a word stands where a number should be"),
        ("hello world\n", "could not convert string"),
        ("\0\1\2", "a word stands where a number should be"),
        ("1 2\n3 4\n", "2 columns are no places"),
        ("", "1 columns are no places"),
        ("3\n1 2 3\n4 5 6\n", "2 of 3 points are there"),
    ],
)
def test_scans_that_are_no_points(tmp_path, text, reason):
    refused(saved(tmp_path / "a.pts", text), reason)


@pytest.mark.parametrize("count", ["2\n", ""])
def test_points_of_a_scan(tmp_path, count):
    scan = vizlight.read(saved(tmp_path / "a.pts", f"{count}0 0 0 5 255 0 0\n1 2 3 6 0 255 7\n"))
    np.testing.assert_array_equal(scan.points, [[0, 0, 0], [1, 2, 3]])
    np.testing.assert_array_equal(scan["intensity"], [5, 6])
    np.testing.assert_array_equal(scan["color"], [[255, 0, 0], [0, 255, 7]])
    (tmp_path / "a.pts").write_text(f"{count}0 0 0 5 255 0 255\n1 2 3 6 0 255 255\n")
    scan = vizlight.read(tmp_path / "a.pts")
    assert scan.point_data.keys() == ["color"]
    np.testing.assert_array_equal(scan["color"], [[5, 255, 0], [6, 0, 255]])


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
def test_points_of_a_lidar(tmp_path, name):
    laspy = pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    cloud = laspy.create(point_format=3, file_version="1.2")
    cloud.header.scales, cloud.header.offsets = [0.01] * 3, [600_000.0, 5_000_000.0, 0.0]
    places = np.array([[600_001.25, 5_000_002.5, 7.0], [600_003.0, 5_000_004.0, 8.0]])
    cloud.x, cloud.y, cloud.z = places.T
    cloud.intensity, cloud.classification = [3, 9], [2, 5]
    cloud.red, cloud.green, cloud.blue = [65280, 0], [256, 512], [0, 65280]
    cloud.write(tmp_path / name)
    mesh = vizlight.read(tmp_path / name)
    np.testing.assert_allclose(mesh.points, places, atol=0.005)
    assert mesh["intensity"].tolist() == [3, 9]
    assert mesh["color"].tolist() == [[255, 1, 0], [0, 2, 255]]
    assert vizlight.look(mesh, size=(90, 60)).array == "color"
    cloud.red, cloud.green, cloud.blue = np.zeros((3, 2), np.uint16)
    cloud.write(tmp_path / name)
    assert vizlight.look(tmp_path / name, size=(90, 60)).array == "intensity"


def test_points_in_lines_of_text(tmp_path):
    mesh = vizlight.read(saved(tmp_path / "a.xyz", "0 0 0 10 20 30\n1 2 3 40 50 60\n"))
    assert mesh["color"].tolist() == [[10, 20, 30], [40, 50, 60]]


@pytest.mark.filterwarnings("default:.*the last three columns")
def test_normals_and_colors_of_points_in_lines_of_text(tmp_path):
    path = tmp_path / "a.xyz"
    mesh = vizlight.read(saved(path, "0 0 0 0 0.6 -0.8\n1 2 3 1 0 0\n"))
    np.testing.assert_allclose(mesh.active_normals, [[0, 0.6, -0.8], [1, 0, 0]], atol=1e-6)
    path.write_text("0 0 0 0 0.5 1\n1 2 3 1 1 1\n")
    assert vizlight.read(path)["color"].tolist() == [[0, 128, 255], [255, 255, 255]]
    with pytest.warns(UserWarning, match="neither colours .* nor normals of length 1"):
        assert not vizlight.read(saved(path, "0 0 0 0 0.5 -9\n1 2 3 1 1 1\n")).array_names
