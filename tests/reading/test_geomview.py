"""OFF and MESH files as Geomview writes them."""

import gzip

import numpy as np
import pytest
import pyvista as pv
from refusals import refused, refused_files, saved

import vizlight

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def read(folder, text, name="a.off"):
    path = folder / name
    return vizlight.read(saved(path, text))


@pytest.mark.parametrize(
    "head", ["OFF\n4 2 0\n", "OFF 4 2 0\n", "# square\n\nOFF # so\n\n4 2 5\n# places\n", "4 2 0\n"]
)
def test_counts_comments_and_polygons(head, tmp_path):
    mesh = read(tmp_path, f"{head}{SQUARE}4 0 1 2 3\n3 0 1 2 # half\n")
    np.testing.assert_array_equal(mesh.faces, [4, 0, 1, 2, 3, 3, 0, 1, 2])
    np.testing.assert_allclose(mesh.points[2], [1, 1, 0])


def test_colours_of_vertices_and_of_faces(tmp_path):
    text = "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 0 1 0 1\n0 1 0 0 0 .5 1\n3 0 1 2 0 0.2 1\n"
    mesh = read(tmp_path, text)
    np.testing.assert_array_equal(
        mesh.point_data["color"][:, :3], [[255, 0, 0], [0, 255, 0], [0, 0, 128]]
    )
    np.testing.assert_array_equal(mesh.cell_data["color"], [[0, 51, 255]])
    whole = read(tmp_path, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 128 0\n")
    np.testing.assert_array_equal(whole.cell_data["color"], [[255, 128, 0]])


def test_normals_and_colours(tmp_path):
    rows = "0 0 0 0 0 1 1 0 0", "1 0 0 0 0 1 0 2 0", "0 1 0 0 0 1 0 0 2"
    mesh = read(tmp_path, "CNOFF\n3 1 0\n" + "\n".join(rows) + "\n3 0 1 2\n")
    np.testing.assert_array_equal(mesh.point_data.active_normals, [[0, 0, 1]] * 3)
    np.testing.assert_array_equal(mesh["color"], np.diag([1, 2, 2]))


@pytest.mark.parametrize("head", ["4OFF\n3 1 0\n", "nOFF 4\n3 1 0\n", "nOFF\n4\n3 1 0\n"])
def test_places_in_4_space(head, tmp_path):
    mesh = read(tmp_path, f"{head}0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n")
    np.testing.assert_array_equal(mesh["position"][:, 3], [1, 2, 3])
    np.testing.assert_array_equal(mesh["position"][:, :3], mesh.points)


def test_a_mesh_of_4_space_is_closed_where_it_says_so(tmp_path):
    angles = np.arange(4) * np.pi / 2
    rows = [f"{np.cos(a)} {np.sin(a)} {np.cos(b)} {np.sin(b)}" for b in angles[:3] for a in angles]
    mesh = read(tmp_path, "4uMESH\n4 3\n" + "\n".join(rows), "torus.mesh")
    assert mesh.n_cells == 8
    assert mesh["position"].shape == (12, 4)
    heights = read(tmp_path, "ZMESH 3 2\n0 1 2\n3 4 5\n", "heights.mesh")
    np.testing.assert_array_equal(heights.points[4], [1, 1, 4])
    np.testing.assert_array_equal(heights.cells, [4, 0, 1, 4, 3, 4, 1, 2, 5, 4])


test_what_is_not_whole_is_refused = refused_files(
    read,
    ("OFF BINARY\n", "binary file of Geomview"),
    ("OFF\n4 1 0\n0 0 0\n", "1 of 5 vertices and faces"),
    ("OFF\n999999999999 1 0\n0 0 0\n", "vertices and faces are there"),
    ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "2 of 3 corners"),
    ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n", "cells of the points 0 to 2"),
    ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "different numbers of components"),
    ("hello\n", "no numbers of vertices"),
    ("", "no numbers of vertices"),
)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.off", f"OFF\n4 0 0\n{SQUARE}1 1\n# end\n", "1 lines"),
        ("a.mesh", f"MESH 2 2 {SQUARE} 7 7", "2 numbers"),
    ],
)
@pytest.mark.filterwarnings("default:.*left out")
def test_more_than_is_stated(name, text, words, tmp_path):
    with pytest.warns(UserWarning, match=f"has {words} more than it states, which are left out"):
        assert read(tmp_path, text, name).n_points == 4


@pytest.mark.parametrize("order", ["ascii", "<", ">"])
def test_places_of_ply_keep_their_digits(order, tmp_path):
    points = np.array([[5e6, 4e5, 0], [5e6 + 0.25, 4e5, 0], [5e6, 4e5 + 0.25, 0]])
    form = {"ascii": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    axes = "".join(f"property double {axis}\n" for axis in "xyz")
    head = f"ply\nformat {form} 1.0\nelement vertex 3\n{axes}property uchar q\n"
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    if order == "ascii":
        rows = "".join(f"{x!r} {y!r} {z!r} 7\n" for x, y, z in points.tolist())
        body = f"{rows}3 0 1 2\n".encode()
    else:
        kind = np.dtype([("p", f"{order}f8", 3), ("q", "u1")])
        body = np.array([(row, 7) for row in points], kind).tobytes()
        body += b"\x03" + np.arange(3).astype(f"{order}i4").tobytes()
    found = vizlight.read(saved(tmp_path / "a.ply", head.encode() + body)).points
    assert found.dtype == np.float64
    np.testing.assert_array_equal(np.unique(found, axis=0), np.unique(points, axis=0))


def test_packed_files(tmp_path):
    ball = pv.Sphere(theta_resolution=8, phi_resolution=8)
    ball.save(tmp_path / "a.stl")
    data = (tmp_path / "a.stl").read_bytes()
    assert vizlight.read(saved(tmp_path / "b.stl.gz", gzip.compress(data))).n_cells == ball.n_cells
    refused(saved(tmp_path / "c.stl.gz", gzip.compress(data)[:-20]), "not damaged.*c.stl.gz")
    refused(saved(tmp_path / "d.stl.gz", gzip.compress(data[:200])), "d.stl.gz")


def test_lines_may_break_anywhere(tmp_path):
    mesh = read(tmp_path, "OFF 5 2 0 0 0 0 1\n0 0 1 1 0 0 1\n0 0 0 1\n4 0 1 2 3 3 0 1 4\n")
    assert (mesh.n_points, mesh.n_cells) == (5, 2)


def test_edges_and_points(tmp_path):
    edges = read(tmp_path, "OFF\n3 2 0\n0 0 0\n1 0 0\n1 1 0\n2 0 1\n2 1 2\n")
    assert (edges.n_lines, edges.n_points) == (2, 3)
    assert read(tmp_path, "OFF\n2 0 0\n0 0 0\n1 0 0\n").n_verts == 2
    mixed = read(tmp_path, "OFF\n3 2 0\n0 0 0\n1 0 0\n1 1 0\n1 1\n3 0 1 2\n")
    assert (mixed.n_verts, mixed.n_cells) == (1, 2)
    with pytest.warns(UserWarning, match="gives 1 of the 2 faces that it states"):
        read(tmp_path, "OFF\n3 2 0\n0 0 0\n1 0 0\n1 1 0\n0\n3 0 1 2\n")
