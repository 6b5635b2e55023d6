"""PLY files of all types of numbers, and what other programs write beside the mesh."""

import struct

import numpy as np
import pytest
import pyvista as pv
from refusals import refused_files, saved

import vizlight
from vizlight.files import FileError
from vizlight.reading import ply

POINTS = "0 0 0", "1 0 0", "1 1 0", "0 1 0"
AXES = [f"property float {axis}" for axis in "xyz"]
LIST = "property list uchar int vertex_indices"


def text(*rows, head=(), form="ascii"):
    """Return a file of four points, what else stands in its header, and its rows."""
    lines = ["ply", f"format {form} 1.0", "element vertex 4", *AXES, *head, "end_header", *rows]
    return "\n".join(lines).encode() + b"\n"


def read(folder, data):
    path = folder / "a.ply"
    return vizlight.read(saved(path, data))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("length", ["uchar", "char", "ushort", "int", "uint"])
@pytest.mark.parametrize("number", ["uchar", "short", "uint", "int", "float", "double"])
def test_lists_of_all_types(order, length, number, tmp_path):
    """A triangle and a quadrilateral, with a number before the list and one after it."""
    kinds = "u1", ply._TYPES[length], ply._TYPES[number], "f4"
    rows = b""
    for tag, face, size in (7, [0, 1, 2], 0.5), (9, [0, 1, 2, 3], 2.5):
        values = zip(kinds, (tag, len(face), face, size), strict=True)
        rows += b"".join(np.array(value, order + kind).tobytes() for kind, value in values)
    form = "binary_little_endian" if order == "<" else "binary_big_endian"
    head = (
        "element face 2", "property uchar tag", f"property list {length} {number} vertex_index",
        "property float size",
    )  # fmt: skip
    data = text(head=head, form=form)[:-1] + b"\n"
    points = np.array([row.split() for row in POINTS], float).astype(f"{order}f4").tobytes()
    mesh = read(tmp_path, data + points + rows)
    np.testing.assert_array_equal(mesh.faces, [3, 0, 1, 2, 4, 0, 1, 2, 3])
    assert mesh.cell_data["tag"].tolist() == [7, 9]
    assert mesh.cell_data["size"].tolist() == [0.5, 2.5]
    for cut in (1, 5, 12, len(rows)):
        with pytest.raises(FileError, match="rows of '(face|vertex)' are there"):
            read(tmp_path, (data + points + rows)[:-cut])


def test_a_camera_before_the_vertices_and_numbers_of_vertices(tmp_path):
    lines = ["ply", "format ascii 1.0", "comment by a program", "element camera 1",
             "property float view", "element vertex 3", *AXES, "property double quality",
             *(f"property uchar {c}" for c in ("red", "green", "blue")), "element face 1", LIST,
             "property uchar red", "property uchar green", "property uchar blue", "end_header",
             "1", *(f"{row} 0.{i} {i} 0 255" for i, row in enumerate(POINTS[:3])),
             "3 0 1 2 9 8 7"]  # fmt: skip
    # Some programs write the first word in capitals.
    mesh = read(tmp_path, "\r\n".join(lines).encode().replace(b"ply", b"PLY", 1) + b"\r\n")
    assert mesh.n_points == 3
    assert mesh.point_data["quality"].tolist() == [0, 0.1, 0.2]
    assert mesh.point_data["RGB"].tolist() == [[0, 0, 255], [1, 0, 255], [2, 0, 255]]
    assert mesh.cell_data["RGB"].tolist() == [[9, 8, 7]]


def test_edges_strips_and_points(tmp_path):
    head = "element edge 1", "property int vertex1", "property int vertex2"
    assert read(tmp_path, text(*POINTS, "1 3", head=head)).lines.tolist() == [2, 1, 3]
    head = "element tristrips 1", "property list int int vertex_indices"
    mesh = read(tmp_path, text(*POINTS, "8 0 1 2 3 -1 1 2 3", head=head))
    assert mesh.strips.tolist() == [4, 0, 1, 2, 3, 3, 1, 2, 3]
    assert read(tmp_path, text(*POINTS)).n_verts == 4


def test_texture_of_the_corners_of_faces_parts_points(tmp_path):
    head = "element face 2", LIST, "property list uchar float texcoord"
    rows = "3 0 1 2 6 0 0 1 0 1 1", "3 0 2 3 6 .5 0 1 1 0 1"
    mesh = read(tmp_path, text(*POINTS, *rows, head=head))
    assert mesh.n_points == 5
    np.testing.assert_allclose(
        mesh.points[mesh.regular_faces[1]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]
    )
    np.testing.assert_allclose(mesh["TCoords"][mesh.regular_faces[1]], [[0.5, 0], [1, 1], [0, 1]])


test_damage_is_refused = refused_files(
    lambda folder, head, rows: read(folder, text(*POINTS, *rows, head=head)),
    (("element face 1", LIST), ("3 0 1 9",), "cells of the points 0 to 3, got 0 to 9"),
    (("element face 1", LIST), ("3 0 1 -9",), "cells of the points 0 to 3, got -9 to 1"),
    (("element face 1", LIST), ("-3 0 1 2",), "a list of 'face' has -3 numbers"),
    (("element face 1", LIST), ("4 0 1 2",), "4 of 5 numbers of a line are there"),
    (("element face 2", LIST), ("3 0 1 2",), "1 of 2 rows of 'face' are there"),
    (("element face 1", LIST), ("3 0 1 1e300",), "numbers from 0 to 1e.300 as int32"),
    (("element face 1", LIST.replace(" int", " float")), ("3 0 1 .5",), "not whole"),
    (("element face -1", LIST), (), "a count below 0"),
    (("element face x", LIST), (), "its header has the line 'element face x'"),
    (("property list quark int a",), (), "its header has the line"),
    (("property float",), (), "its header has the line 'property float'"),
    (("-inf int a",), (), "its header has the line '-inf int a'"),
)  # fmt: skip


test_what_is_no_whole_file = refused_files(
    read,
    (b"ply\nformat ascii 1.0\n", "its header is not whole"),
    (b"no", "no PLY file"),
    (b"ply\nformat ternary 1.0\nend_header\n", "its header has the format 'ternary'"),
    (b"ply\nformat ascii 1.0\nend_header\n", "no vertices with x, y and z"),
    (text("0 0", *POINTS), "2 of 3 numbers of a line"),
    (
        text(head=("element face 1", LIST.replace("uchar", "char")), form="binary_big_endian")
        + bytes(48) + struct.pack(">b3i", -3, 0, 1, 2),
        "a list of 'face' has -3 numbers",
    ),
    (
        text(head=("element face 1", LIST.replace("uchar", "float")), form="binary_big_endian")
        + bytes(99),
        "the lengths of the list 'vertex_indices' are no whole numbers",
    ),
)  # fmt: skip


def test_the_last_line_of_a_text(tmp_path):
    whole = text(*POINTS, "4 0 1 2 3", head=("element face 1", LIST))
    expected = read(tmp_path, whole)
    with pytest.warns(UserWarning, match="may be cut in its last line, which has no line break"):
        assert read(tmp_path, whole[:-1]) == expected
    assert read(tmp_path, whole + b"\nmore\n") == expected
    with pytest.warns(UserWarning, match="elements and lists that are left out: grid"):
        read(tmp_path, text(*POINTS, "1", head=("element grid 1", "property int a")))


def test_places_and_faces_of_pyvista(tmp_path):
    ball = pv.Sphere(theta_resolution=9, phi_resolution=8)
    for binary in True, False:
        ball.save(tmp_path / "b.ply", binary=binary)
        mesh = ply.read(tmp_path / "b.ply")
        np.testing.assert_allclose(mesh.points, ball.points, atol=1e-6)
        np.testing.assert_array_equal(mesh.faces, ball.faces)
        np.testing.assert_allclose(
            mesh.point_data.active_normals, ball.point_data["Normals"], atol=1e-6
        )


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
@pytest.mark.filterwarnings("default:.*left out")
def test_lists_of_vertices_are_left_out(form, tmp_path):
    head = ["property list uchar uchar marks", "element face 1", LIST]
    data = text(*(f"{row} 2 7 9" for row in POINTS), "4 0 1 2 3", head=head)
    if form != "ascii":
        rows = [struct.pack("<3f3B", *map(int, row.split()), 2, 7, 9) for row in POINTS]
        data = text(head=head, form=form) + b"".join(rows) + struct.pack("<B4i", 4, 0, 1, 2, 3)
    with pytest.warns(UserWarning, match="lists that are left out: marks"):
        mesh = read(tmp_path, data)
    assert (mesh.n_points, mesh.n_cells, mesh.array_names) == (4, 1, [])


@pytest.mark.filterwarnings("default:.*left out")
def test_more_rows_than_stated(tmp_path):
    with pytest.warns(UserWarning, match="has 1 lines more than it states, which are left out"):
        assert read(tmp_path, text(*POINTS, "5 5 5", "a comment")).n_points == 4
    data = text(form="binary_little_endian") + np.zeros((4, 3), "<f4").tobytes()
    with pytest.warns(UserWarning, match="has 3 bytes more than it states"):
        assert read(tmp_path, data + b"abc\n").n_points == 4
    faces = text(*POINTS, "4 0 1 2 3 7 7", "3 0 1 2 7", head=("element face 2", LIST))
    with pytest.warns(UserWarning, match="has 3 numbers more than it states"):
        assert read(tmp_path, faces).n_cells == 2


def test_points_in_no_face(tmp_path):
    with pytest.warns(UserWarning, match="1 of its 4 points are in no face and left out"):
        mesh = read(tmp_path, text(*POINTS, "3 0 1 2", head=("element face 1", LIST)))
    assert mesh.n_points == 3


def test_counts_in_the_billions(tmp_path):
    """Also of an element without properties."""
    form = "binary_little_endian"
    head = ["element face 1000000000000", LIST, "element nothing 1000000000000"]
    points = np.array([row.split() for row in POINTS], "<f4").tobytes()
    with pytest.raises(FileError, match="2 of 1000000000000 rows of 'face' are there"):
        read(
            tmp_path, text(head=head, form=form) + points + struct.pack("<B3i", 3, 0, 1, 2) + b"\0"
        )
    data = text(head=["element nothing 1000000000000"], form=form) + points
    with pytest.warns(UserWarning, match="left out: nothing"):
        assert read(tmp_path, data).n_points == 4
