import numpy as np
import pytest
import pyvista as pv
from refusals import saved

from vizlight import files
from vizlight.reading import kratos

NODES = "Begin Nodes // of the mesh\n 7 0 0 0\n 3 1 0 0\n 9 1 1 0\n 4 0 1 0\n 5 0 0 1\nEnd Nodes\n"


def block(kind, name, *rows):
    lines = (f" {i} {' '.join(map(str, row))}" for i, row in enumerate(rows, 1))
    return "\n".join([f"Begin {kind} {name} // GUI", *lines, f"End {kind}", ""])


@pytest.mark.parametrize(
    ("name", "corners", "kind"),
    [
        ("Element2D3N", (7, 3, 9), pv.CellType.TRIANGLE),
        ("TotalLagrangianElement2D4N", (7, 3, 9, 4), pv.CellType.QUAD),
        ("VMS3D", (7, 3, 9, 5), pv.CellType.TETRA),
        ("MembraneElement3D4N", (7, 3, 9, 4), pv.CellType.QUAD),
        ("TrussElement3D2N", (7, 5), pv.CellType.LINE),
    ],
)
def test_elements_are_cells_of_their_dimension_at_nodes_by_their_numbers(
    name, corners, kind, tmp_path
):
    path = tmp_path / "a.mdpa"
    path.write_text(
        NODES
        + block("Elements", name, (1, *corners), (2, *corners[::-1]))
        + block("Conditions", "LineCondition2D2N", (0, 7, 3))
    )
    mesh = kratos.read(path)
    assert mesh.celltypes.tolist() == [kind, kind]
    assert mesh["property"].tolist() == [1, 2]
    places = {7: (0, 0, 0), 3: (1, 0, 0), 9: (1, 1, 0), 4: (0, 1, 0), 5: (0, 0, 1)}
    assert mesh.get_cell(0).points.tolist() == [list(map(float, places[i])) for i in corners]


def test_conditions_are_read_where_there_are_no_elements(tmp_path):
    path = tmp_path / "a.mdpa"
    path.write_text(NODES + block("Conditions", "SurfaceCondition3D3N", (0, 7, 3, 9)))
    assert kratos.read(path).celltypes.tolist() == [pv.CellType.TRIANGLE]


def test_corners_of_20_are_in_the_order_of_vtk(tmp_path):
    cube = pv.CellType.QUADRATIC_HEXAHEDRON
    corners = np.array(
        [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    )
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    # Kratos has the middles of upright edges before those of the upper ones.
    edges = [*ring, *((i, i + 4) for i in range(4)), *((i + 4, j + 4) for i, j in ring)]
    points = [*corners, *(corners[[i, j]].mean(axis=0) for i, j in edges)]
    rows = "\n".join(f" {i} {x:g} {y:g} {z:g}" for i, (x, y, z) in enumerate(points, 1))
    path = tmp_path / "a.mdpa"
    path.write_text(
        f"Begin Nodes\n{rows}\nEnd Nodes\n"
        + block("Elements", "SmallDisplacementElement3D20N", (0, *range(1, 21)))
    )
    mesh = kratos.read(path)
    assert mesh.celltypes.tolist() == [cube]
    assert mesh.compute_cell_sizes()["Volume"] == pytest.approx([8])


@pytest.mark.parametrize(
    ("rows", "words"), [((0, 7, 3, 8), "no node"), ((0, 7, 3, 9, 4, 5), "5 corners are unknown")]
)
def test_cells_that_cannot_be_are_refused(rows, words, tmp_path):
    path = saved(tmp_path / "a.mdpa", NODES + block("Elements", "Element2D3N", rows))
    with pytest.raises(files.FileError, match=words):
        files.read(path)
