"""Files of meshers and solvers that meshio or VTK's reader of AVS reads."""

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, refused, saved

import vizlight
from vizlight import files
from vizlight.mesh import meaning

VIEW = vizlight.View(direction=(0, 0, 1))
GMSH = """\
$MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
3 3 1 0
1 0 0 0 0
2 1 0 0 0
3 0 1 0 0
1 0 0 0 1 0 0 0 2 1 -2
2 0 0 0 1 1 0 0 2 2 -3
3 0 0 0 0 1 0 0 2 3 -1
1 0 0 0 1 1 0 0 3 1 2 3
$EndEntities
$Nodes
1 3 1 3
2 1 0 3
1
2
3
0 0 0
1 0 0
0 1 0
$EndNodes
$Elements
2 2 1 2
1 1 1 1
1 1 2
2 1 2 1
2 1 2 3
$EndElements
"""


@pytest.mark.filterwarnings("ignore:.*of the edges are sharper")
def test_a_tetrahedron_in_a_file_that_meshio_reads(tmp_path):
    pytest.importorskip("meshio")
    path = tmp_path / "a.off"
    path.write_text("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                    "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")  # fmt: skip
    mesh = vizlight.read(path)
    assert mesh.n_cells == 4
    lit = vizlight.illuminate(mesh, vizlight.Scene(lights=vizlight.Light(direction=(1, 1, 1)),
                                                   view=VIEW))  # fmt: skip
    # Lit from (1, 1, 1) the corner at the origin is the darkest.
    assert int(np.argmin(lit["luminance"])) == 0


def test_a_mesh_of_gmsh(tmp_path):
    pytest.importorskip("meshio")
    path = tmp_path / "part.msh"
    mesh = vizlight.read(saved(path, GMSH))
    # The edge of the shape, on which the triangle has a side, is none of the mesh.
    assert mesh.celltypes.tolist() == [pv.CellType.TRIANGLE]
    assert mesh.cell_data.keys() == ["gmsh:geometrical"]
    of_one = '$ElementData\n1\n"p"\n1\n0\n3\n0\n1\n1\n2 5\n$EndElementData\n'
    with pytest.warns(UserWarning, match="its values of some cells alone are left out"):
        assert vizlight.read(saved(path, GMSH + of_one)).n_cells == 1
    with pytest.warns(UserWarning, match="gives 2 of the 3 cells that it states"):
        vizlight.read(saved(path, GMSH.replace("2 2 1 2", "2 3 1 3")))


def test_an_edge_of_a_mesher_that_no_face_has_is_named(tmp_path):
    meshio = pytest.importorskip("meshio")
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 0, 0]], dtype=float)
    path = tmp_path / "part.mesh"
    meshio.Mesh(points, [("triangle", [[0, 1, 2]]), ("line", [[1, 3]])]).write(path)
    mesh = read_warned(path, "left out: cells of lower dimension")
    assert mesh.celltypes.tolist() == [pv.CellType.TRIANGLE]


def test_elements_of_nastran_may_have_long_fields(tmp_path):
    pytest.importorskip("meshio")
    rows = [
        f"GRID    {i + 1:8d}        {i % 2:8.1f}{i // 2 % 2:8.1f}{i // 4:8.1f}" for i in range(8)
    ]
    ids = [1, 1, 1, 2, 4, 3, 5, 6, 8, 7]
    short = (
        "CHEXA   " + "".join(f"{i:8d}" for i in ids[:8]) + "+       \n+       " + "       8       7"
    )
    fours = [ids[:4], ids[4:8], ids[8:]]
    heads = ["CHEXA*  ", "*       ", "*       "]
    long = "\n".join(
        head + "".join(f"{i:16d}" for i in four) for head, four in zip(heads, fours, strict=True)
    )
    cells = []
    for element in (short, long):
        text = "\n".join(["BEGIN BULK", *rows, element, "ENDDATA", ""])
        cells.append(vizlight.read(saved(tmp_path / "part.bdf", text)).cells_dict)
    np.testing.assert_array_equal(*(each[pv.CellType.HEXAHEDRON] for each in cells))


def test_references_of_points_leave_their_name_to_those_of_cells(tmp_path):
    meshio = pytest.importorskip("meshio")
    points, corners = np.eye(4)[:, :3], [("tetra", [[0, 1, 2, 3]])]
    rows = {"medit:ref": np.arange(4)}, {"medit:ref": [np.array([7])]}
    meshio.Mesh(points, corners, *rows).write(tmp_path / "a.mesh")
    mesh = vizlight.read(tmp_path / "a.mesh")
    assert (mesh.cell_data["medit:ref"] == 7).all()
    assert list(mesh.point_data) == ["medit:ref of points"]


def test_a_mesh_of_one_dimension(tmp_path):
    pytest.importorskip("meshio")
    head = "MeshVersionFormatted 2\nDimension 1\nVertices\n2\n"
    mesh = vizlight.read(saved(tmp_path / "a.mesh", f"{head}0.0 0\n1.5 1\nEdges\n1\n1 2 0\nEnd\n"))
    np.testing.assert_array_equal(mesh.points, [[0, 0, 0], [1.5, 0, 0]])
    assert mesh.n_cells == 1


def test_an_array_of_meshio_without_rows_for_some_cells_is_left_out(tmp_path):
    pytest.importorskip("meshio")
    path = tmp_path / "a.fem"
    grids = [(1, 0, 0), (2, 1, 0), (3, 0, 1), (4, 1, 1)]
    lines = [f"GRID,{i},,{x}.0,{y}.0,0.0" for i, x, y in grids]
    lines += ["CBAR,1,,1,2", "CTRIA3,2,7,1,2,3", "CTRIA3,3,8,2,4,3"]
    with pytest.warns(UserWarning, match=r"'nastran:ref' has 2 rows for 3 cells, and is left out"):
        mesh = vizlight.read(saved(path, "\n".join(["BEGIN BULK", *lines, "ENDDATA", ""])))
    assert (mesh.n_points, mesh.array_names) == (4, [])


def test_a_file_that_a_reader_of_meshio_refuses(tmp_path, capsys):
    pytest.importorskip("meshio")
    path = tmp_path / "a.wkt"
    refused(saved(path, "POINT (1 2)"), r"a\.wkt' \(Invalid WKT")
    assert capsys.readouterr().out == ""


def test_a_warning_of_a_reader_is_no_second_line(tmp_path):
    """NumPy warns of lines without numbers among those that are counted."""
    pytest.importorskip("meshio")
    path = tmp_path / "a.vol"
    rows = "1 0 0 0 0 1 2 3\n# none\n1 0 0 0 0 1 2 3\n"
    with pytest.raises(files.FileError, match=r"a\.vol"):
        vizlight.read(saved(path, f"mesh3d\ndimension\n3\ngeomtype\n0\nsurfaceelements\n2\n{rows}"))


def test_a_file_of_avs_ucd_may_begin_with_comments(tmp_path):
    path = tmp_path / "a.ucd"
    path.write_text("# AVS UCD\n3 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 7 tri 1 2 3\n")
    mesh = vizlight.read(path)
    assert (mesh.n_points, mesh.n_cells) == (3, 1)
    refused(saved(path, "# AVS UCD\n3 1 0 0 0\n1 0 0 0\n"), "2 of 5 lines of points and cells")


def test_groups_of_gmsh_have_words_for_titles(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(
        np.eye(3), [("triangle", [[0, 1, 2]])],
        cell_data={"gmsh:physical": [np.array([5])], "gmsh:geometrical": [np.array([1])]},
    )  # fmt: skip
    meshio.gmsh.write(tmp_path / "a.msh", mesh, fmt_version="2.2")
    said = meaning.of(vizlight.read(tmp_path / "a.msh"))
    assert said.arrays["gmsh:physical"]["long_name"] == "Physical group"
