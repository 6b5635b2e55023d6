"""Legacy files of VTK whose numbers do not fit are refused before a reader opens them."""

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, refused, saved

import vizlight
from vizlight.files import FileError
from vizlight.reading import formats

FIELD = (
    b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 2 2 1\n"
    b"POINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\nPOINT_DATA 4\nFIELD F 1\na 1 4 float\n1 2 3 4\n"
)
CELLS = (
    b"# vtk DataFile Version 4.2\nt\n%s\nDATASET POLYDATA\nPOINTS 4 float\n%s\nPOLYGONS 2 %d\n%s\n"
)
PLACES = (0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0)


def cells(*numbers, text=True):
    """Return a legacy file of two faces, each with its number of corners before them."""
    if text:
        words = [" ".join(map(str, row)).encode() for row in (PLACES, numbers)]
        return CELLS % (b"ASCII", words[0], len(numbers), words[1])
    rows = np.array(PLACES, ">f4").tobytes(), np.array(numbers, ">i4").tobytes()
    return CELLS % (b"BINARY", rows[0], len(numbers), rows[1])


WHOLE = {
    "a.vtk": FIELD,
    "line.vtk": FIELD.replace(b"ASCII", b"\nASCII", 1),
    "name.vtk": FIELD.replace(b"F 1\n", b"F 2\n") + b"Info 1 4 float\n1 nan inf 4\n",
    "three.vtk": cells(3, 0, 1, 2, 3, 1, 2, 3),
    "mixed.vtk": cells(3, 0, 1, 2, 4, 0, 1, 3, 2),
    "binary.vtk": cells(3, 0, 1, 2, 4, 0, 1, 3, 2, text=False),
}
WRONG = {
    "short": (FIELD.replace(b"a 1 4", b"a 3 4"), "4 of 12 numbers"),
    "word": (FIELD.replace(b"1 2 3 4\n", b"1 \xb5 3 4\n"), "words stand among"),
    "no count": (FIELD.replace(b"F 1\n", b"F\xff\n"), "a field has no number of arrays"),
    "kind": (FIELD.replace(b"4 float\n1", b"4 5\n1"), "a field has the type '5'"),
    "huge cell": (cells(3, 0, 1, 2, 99999999, 1, 2, 3), "corners of 2 cells are not 8"),
    "binary cell": (cells(3, 0, 1, 2, -7, 1, 2, 3, text=False), "corners of 2 cells"),
    "version": (cells(3, 0, 1, 2).replace(b" 4.2", b""), "corners of 2 cells are not 4"),
    "no cells": (cells(3, 0, 1, 2).replace(b"2 4", b"2 400"), "4 of 400 numbers of cells"),
    "bracket": (FIELD.replace(b"1 2 3 4\n", b"1 ] 3 4\n"), "words stand among"),
    "no word": (
        cells(3, 0, 1, 2, 3, 0, 1, 2, text=False).replace(b"\nPOLYGONS", b"\n\0\0\0YGONS"),
        "no word stands after its points",
    ),
    "huge type": (
        cells(3, 0, 1, 2, 3, 0, 1, 2) + b"\nCELL_TYPES 2\n5 1099511627776\n",
        "no cells of type 1099511627776",
    ),
    "components": (
        cells(3, 0, 1, 2, 3, 0, 1, 2) + b"\nPOINT_DATA 4\nSCALARS a float 4294967295\n",
        "an array has 4294967295 components",
    ),
    "attribute": (
        cells(3, 0, 1, 2, 3, 0, 1, 2) + b"\nPOINT_DATA 4\nF\xffELD a 1\n",
        "stands where an array begins",
    ),
    "cell type": (
        cells(3, 0, 1, 2, 3, 0, 1, 2) + b"\nCELL_TYPES 2\n5 99\n",
        "no cells of type 99",
    ),
}


@pytest.mark.parametrize("name", WHOLE)
def test_whole_files_are_read(name, tmp_path):
    assert vizlight.read(saved(tmp_path / name, WHOLE[name])).n_points > 2


@pytest.mark.parametrize("kind", WRONG)
def test_numbers_that_contradict_each_other_are_refused(kind, tmp_path):
    content, words = WRONG[kind]
    refused(saved(tmp_path / "a.vtk", content), words)


@pytest.mark.filterwarnings("default:.*may be cut")
def test_a_file_that_ends_within_a_line(tmp_path):
    read_warned(saved(tmp_path / "a.vtk", FIELD[:-1]), "may be cut in its last line")


def test_a_legacy_file_that_ends_before_its_cells(tmp_path):
    path = tmp_path / "a.vtk"
    pv.ImageData(dimensions=(4, 3, 5)).cast_to_unstructured_grid().save(path, binary=False)
    with pytest.raises(FileError, match="its last block is not whole"):
        vizlight.read(saved(path, path.read_text().partition("CELLS")[0] + "METADATA\n"))


@pytest.mark.parametrize("word", [b"CELLS", b"CELL_TYPES"])
def test_cells_without_their_number_or_their_types(word, tmp_path):
    pv.ImageData(dimensions=(3, 3, 2)).to_tetrahedra().save(tmp_path / "a.vtk", binary=False)
    data = (tmp_path / "a.vtk").read_bytes()
    with pytest.raises(FileError, match="a list of cells has no number|its cells have no types"):
        vizlight.read(saved(tmp_path / "a.vtk", data.replace(b"\n" + word + b" ", b"\n")))


def test_arrays_that_vtk_skips(tmp_path):
    mesh = pv.ImageData(dimensions=(3, 2, 1))
    mesh["a"] = np.arange(6.0)
    mesh.save(tmp_path / "a.vtk")
    data = (tmp_path / "a.vtk").read_bytes()
    with pytest.raises(FileError, match="0 of 1 arrays are there"):
        vizlight.read(saved(tmp_path / "a.vtk", data.replace(b"LOOKUP_TABLE default\n", b"")))


@pytest.mark.parametrize("binary", [False, True])
def test_polyhedra_of_legacy_files_have_whole_faces(tmp_path, binary):
    path = tmp_path / "a.vtk"
    grid = pv.UnstructuredGrid(pv.examples.cells.Polyhedron())
    grid.save(path, binary=binary)
    assert formats.missing_part(path) == ""
    assert vizlight.read(path).n_cells == 1
    tetra = pv.UnstructuredGrid(pv.examples.cells.Tetrahedron())
    tetra.save(path, binary=binary)
    text = path.read_bytes()
    kind = (b"\n10\n", b"\n42\n") if not binary else (b"\0\0\0\n", b"\0\0\0*")
    path.write_bytes(kind[1].join(text.rsplit(kind[0], 1)))
    assert formats.missing_part(path) == "cell 0 is no polyhedron of whole faces"


@pytest.mark.parametrize(
    ("kind", "word", "is_held"),
    [("float", "1e60", False), ("float", "-inf", True), ("double", "1e60", True),
     ("double", "1e999", False), ("int", "99999999999", False), ("short", "-32768", True)],
)  # fmt: skip
def test_numbers_that_a_type_does_not_hold_are_refused(tmp_path, kind, word, is_held):
    """VTK ends the process at them."""
    path = tmp_path / "a.vtk"
    path.write_text(
        "# vtk DataFile Version 5.1\na\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
        "0 0 0 1 0 0 0 1 0\nPOINT_DATA 3\nFIELD FieldData 1\n"
        f"pair 2 3 {kind}\n1 2 3 {word} 5 6\n"
    )
    if is_held:
        assert vizlight.read(path)["pair"].shape == (3, 2)
    else:
        refused(path, f"{word} of a field is beyond the type")
