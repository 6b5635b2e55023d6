"""Tables of text: places, values, missing numbers, and what is refused."""

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, refused, refused_files

import vizlight
from vizlight.files import FileError
from vizlight.mesh import meaning

pytestmark = pytest.mark.usefixtures("without_trial")


def written(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def test_columns_of_places_are_points_with_the_others_as_values(tmp_path):
    path = written(tmp_path / "a.csv", "#X,y [m],z,p\n0,1,2,7\n3,4,5,NA\n\n6,,8,9\n")
    mesh = read_warned(path, "left out are 1 rows without a place")
    np.testing.assert_array_equal(mesh.points, [(0, 1, 2), (3, 4, 5)])
    np.testing.assert_array_equal(mesh["p"], [7, np.nan])
    # Rows may end by a separator though the first line does not.
    mesh = vizlight.read(written(tmp_path / "b.csv", "x,y,z\n0,1,2,\n3,4,5,\n"))
    np.testing.assert_array_equal(mesh.points, [(0, 1, 2), (3, 4, 5)])


def test_the_data_of_an_export_of_cfx_are_a_table(tmp_path):
    head = "[Name]\nwing\n\n[Parameters]\nAxis = 0 [m], 0 [m], 1 [m]\n\n[Data]\n"
    text = (
        f"{head}X [ m ], Y [ m ], Z [ m ], p [ Pa ]\n0, 1, 2, 7\n3, 4, 5, 8\n\n[Faces]\n0, 1, 2\n"
    )
    mesh = vizlight.read(written(tmp_path / "a.csv", text))
    np.testing.assert_array_equal(mesh.points, [(0, 1, 2), (3, 4, 5)])
    assert mesh["p [ Pa ]"].tolist() == [7, 8]


def test_longitudes_are_a_map_with_decimal_commas(tmp_path):
    text = "station;lon;lat;t (K)\n'A';10,5;50;280\n'B';11;51,25;281,5\n"
    mesh = read_warned(written(tmp_path / "a.csv", text), "left out are columns of text: station")
    np.testing.assert_array_equal(mesh.points, [(10.5, 50, 0), (11, 51.25, 0)])
    assert mesh.field_data["unit"][0] == "degree"
    assert mesh["t (K)"].tolist() == [280, 281.5]


@pytest.mark.parametrize(
    ("lon", "lat"), [("decimalLongitude", "decimalLatitude"), ("GTD_LON", "GTD_LAT")]
)
def test_longitudes_may_have_words_before_them(lon, lat, tmp_path):
    mesh = vizlight.read(written(tmp_path / "a.csv", f"count,{lat},{lon}\n3,50,10.5\n4,51,11\n"))
    np.testing.assert_array_equal(mesh.points, [(10.5, 50, 0), (11, 51, 0)])
    assert mesh.field_data["unit"][0] == "degree"
    refused(written(tmp_path / "b.csv", "balloon,flat\n1,2\n"), "no names of places")


@pytest.mark.parametrize("name", ["", "Unnamed: 0"])
def test_the_numbers_of_the_rows_of_a_data_frame_are_no_values(name, tmp_path):
    rows = "".join(f"{7 * i},{i},{i * i},0,{3 + i % 2}.5\n" for i in range(20))
    mesh = vizlight.read(written(tmp_path / "a.csv", f"{name},x,y,z,grade\n{rows}"))
    assert mesh.point_data.keys() == ["index", "grade"]
    assert vizlight.look(mesh).array == "grade"


def test_words_of_few_kinds_are_kinds(tmp_path):
    rows = "".join(f"{i},{i * i},{'granite' if i % 3 else 'salt'},name {i}\n" for i in range(20))
    path = written(tmp_path / "a.csv", f"x,y,rock,label\n{rows}5,7,,last\n")
    mesh = read_warned(path, "left out are columns of text: label$")
    assert meaning.flags(mesh, "rock") == {0: "granite", 1: "salt"}
    assert mesh["rock"][:4].tolist() == [1, 0, 0, 1]
    assert np.isnan(mesh["rock"][-1])
    assert vizlight.look(mesh).array == "rock"


def test_lines_of_text_at_the_end_are_left_out_with_a_note(tmp_path):
    text = '"ID", "x", "y", "p q"\n0, 1, 2, 3\n1, 4, 5, 6\n\nEXT_ITER= 600\nDRAG=, 0.5\n'
    words = "left out are 2 lines of text at its end, such as 'EXT_ITER= 600'"
    mesh = read_warned(written(tmp_path / "a.csv", text), words)
    np.testing.assert_array_equal(mesh.points[:, :2], [(1, 2), (4, 5)])
    assert mesh["p q"].tolist() == [3, 6]
    # A row that was cut off, or a line between rows, is a damage.
    for damaged in ("x,y,z\n1,2,3\n4,5\n", "x,y,z\n1,2,3\nEXT= 6\n4,5,6\n"):
        refused(written(tmp_path / "b.csv", damaged), "a row has")


test_other_tables_are_refused_with_a_remedy = refused_files(
    lambda folder, text: vizlight.read(written(folder / "a.csv", text)),
    ("a,b\n1,2\n", r"no names of places \(x, y, z or lon, lat\) but 'a', 'b'; name them so"),
    ("x,y\n", "no rows below its first line"),
    ("x,y\n1,2,3\n", r"a row has 3 columns for 2 names: \['1', '2', '3'\]"),
    ("x,y\nnan,1\n", "no rows with places"),
    ("", "no rows below its first line"),
)  # fmt: skip


def test_a_table_over_a_mesh_has_a_row_for_each_point(tmp_path):
    mesh = pv.Plane(i_resolution=1, j_resolution=1).triangulate()
    mesh.save(tmp_path / "a.vtp")
    table = written(tmp_path / "b.tsv", "p\tq\n1\t5\n2\t6\n3\t7\n4\t8\n")
    assert vizlight.read(tmp_path / "a.vtp", overlay=table)["q"].tolist() == [5, 6, 7, 8]
    short = written(tmp_path / "c.csv", "p\n1\n")
    words = (
        "overlay: expected values for the points of .*'.*c.csv' has 1 rows for a mesh of 4 points"
    )
    with pytest.raises(FileError, match=words):
        vizlight.read(tmp_path / "a.vtp", overlay=short)
    uneven = written(tmp_path / "d.csv", "p\n1,2\n")
    with pytest.raises(FileError, match=r"overlay: .*'.*d.csv' is no table: a row has 2 columns"):
        vizlight.read(tmp_path / "a.vtp", overlay=uneven)


def test_a_table_over_a_mesh_needs_no_names(tmp_path):
    pv.Plane(i_resolution=1, j_resolution=1).triangulate().save(tmp_path / "a.vtp")
    for text, columns in (
        ("1\n2\n3\n4\n", {"p": [1, 2, 3, 4]}),
        ("1,-5\n2,nan\n3,7\n4,8\n", {"p 1": [1, 2, 3, 4], "p 2": [-5, np.nan, 7, 8]}),
        # Numbers above a row for each point are names, as pandas writes them.
        ("0\n1\n2\n3\n4\n", {"0": [1, 2, 3, 4]}),
    ):
        mesh = vizlight.read(tmp_path / "a.vtp", overlay=written(tmp_path / "p.csv", text))
        for name, rows in columns.items():
            np.testing.assert_array_equal(mesh[name], rows)
    with pytest.raises(FileError, match="has 3 rows for a mesh of 4 points"):
        vizlight.read(tmp_path / "a.vtp", overlay=written(tmp_path / "p.csv", "1\n2\n3\n"))
