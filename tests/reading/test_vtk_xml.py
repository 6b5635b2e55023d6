"""Files of VTK's XML that are cut, or hold other numbers than they state, are refused."""

import base64
import re
import struct

import numpy as np
import pytest
import pyvista as pv
from refusals import refused, saved
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import vizlight
from vizlight.files import FileError
from vizlight.reading import formats

VTM = (
    b'<?xml version="1.0"?><VTKFile type="vtkMultiBlockDataSet" version="1.0">'
    b'<vtkMultiBlockDataSet><DataSet index="%d" file="%s"/><Block index="1"/>'
    b'<Block index="2"><DataSet index="%d" file="c.vtp"/><DataSet index="0" file="d.vtp"/></Block>'
    b"</vtkMultiBlockDataSet></VTKFile>"
)


def xml(count, folder):
    """Return a surface of VTK's XML with another number of points."""
    pv.Triangle().save(folder / "whole.vtp", binary=False)
    return (folder / "whole.vtp").read_bytes().replace(b'Points="3"', b'Points="%d"' % count)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (VTM % (0, b"a" * 300, 1), "File name too long"),
        (VTM % (0, b"b.vtp", 0), "two blocks have the index 0"),
    ],
)
def test_indices_of_blocks(content, words, tmp_path):
    refused(saved(tmp_path / "a.vtm", content), words)


@pytest.mark.parametrize("count", [-1, 10**12])
def test_counts_beyond_the_size_of_a_file_are_refused_also_in_pieces(count, tmp_path):
    refused(saved(tmp_path / "a.vtp", xml(count, tmp_path)), f"NumberOfPoints is {count}")
    pv.MultiBlock([pv.Triangle()]).save(tmp_path / "b.vtm", binary=False)
    index = (tmp_path / "b.vtm").read_text()
    with pytest.raises(FileError, match=f"'a.vtp': NumberOfPoints is {count}"):
        vizlight.read(saved(tmp_path / "b.vtm", index.replace("b/b_0.vtp", "a.vtp")))


BOX = pv.ImageData(dimensions=(4, 3, 5))
GRIDS = {"vti": BOX, "vts": BOX.cast_to_structured_grid(), "vtr": BOX.cast_to_rectilinear_grid()}


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("suffix", GRIDS)
def test_pieces_cover_the_whole(tmp_path, suffix, binary):
    path = tmp_path / f"a.{suffix}"
    GRIDS[suffix].save(path, binary=binary)
    assert vizlight.read(path).n_points == 60
    whole = path.read_bytes()
    for number, reason in (
        (b"-1", "its pieces cover \\[0, 3"),
        (b"2147483647", "its pieces cover \\[0, 3"),
        (b"x", "invalid literal"),
        (b"", "its extents are no six numbers"),
    ):
        path.write_bytes(re.sub(rb'WholeExtent="0', b'WholeExtent="' + number, whole, count=1))
        refused(path, reason)


def test_arrays_of_grids_with_other_numbers(tmp_path):
    path, grid = tmp_path / "a.vtr", GRIDS["vtr"].copy()
    grid["pair"] = np.zeros((60, 2))
    grid.save(path, binary=False)
    whole = path.read_text()
    for pattern, damaged, reason in (
        (' NumberOfComponents="2"', "", "'pair' has 120 numbers for 60"),
        (r">\s+0 1 2 3 4", ' NumberOfComponents="2"> 0 1 2 3 4 0 1 2 3 4', "an axis has 2 numbers"),
    ):
        refused(saved(path, re.sub(pattern, damaged, whole)), reason)


def test_damaged_pieces_of_grids(tmp_path):
    GRIDS["vtr"].save(tmp_path / "a.vtr")
    head = '<VTKFile type="PRectilinearGrid"><PRectilinearGrid WholeExtent="0 3 0 2 0 4">'
    pieces = '<PCoordinates>{0}{0}{0}</PCoordinates><Piece Extent="0 3 0 2 0 4" Source="a.vtr"/>'
    pieces = pieces.format('<PDataArray type="Float64"/>')
    (tmp_path / "a.pvtr").write_text(f"{head}{pieces}</PRectilinearGrid></VTKFile>")
    assert vizlight.read(tmp_path / "a.pvtr").n_points == 60
    whole = (tmp_path / "a.vtr").read_bytes()
    (tmp_path / "a.vtr").write_bytes(whole.replace(b"LittleEndian", b"BigEndian"))
    refused(tmp_path / "a.pvtr", r"a\.vtr': .* an array of 16777216 blocks")


def write(path, grid, form, *, wide, packed):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.SetDataMode({"ascii": 0, "binary": 1}.get(form, 2))
    writer.SetEncodeAppendedData(form == "base64")
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
    writer.Write()


@pytest.mark.parametrize("form", ["ascii", "binary", "base64", "raw"])
def test_arrays_with_more_numbers_than_cells(form, tmp_path):
    grid = pv.ImageData(dimensions=(4, 3, 2)).cast_to_unstructured_grid()
    grid.cell_data["v"] = grid.cell_centers().points
    path = tmp_path / "a.vtu"
    for packed in (True, False):
        for wide in (True, False):
            write(path, grid, form, wide=wide, packed=packed)
            assert formats.missing_part(path) == ""
            path.write_bytes(path.read_bytes().replace(b'Cells="6"', b'Cells="4"'))
            reason = "the array 'v' has 18 numbers for 12"
            assert formats.missing_part(path) == reason


@pytest.mark.parametrize("form", ["ascii", "binary", "base64", "raw"])
@pytest.mark.parametrize("wide", [True, False])
def test_cells_that_end_beyond_their_corners(form, wide, tmp_path):
    """VTK makes room for that many, and ends the process where there is none."""
    path = tmp_path / "a.vtu"
    grid = pv.ImageData(dimensions=(4, 3, 2)).cast_to_unstructured_grid()
    write(path, grid, form, wide=wide, packed=False)
    assert formats.missing_part(path) == ""
    rows = [[8, 16, 24, 32, 40, last] for last in (48, 1 << 40)]
    parts = [struct.pack("<6q", *row) for row in rows]
    if form == "ascii":
        parts = [" ".join(map(str, row)).encode() for row in rows]
    elif form != "raw":
        head = (48).to_bytes(8 if wide else 4, "little")
        parts = [base64.b64encode(head + part) for part in parts]
    content = path.read_bytes()
    assert content.count(parts[0]) == 1
    path.write_bytes(content.replace(*parts))
    reason = f"the cells have 48 corners, and end at {1 << 40}"
    assert formats.missing_part(path) == reason
