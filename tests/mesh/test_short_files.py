"""Files that say themselves that a part of them is missing, refused before a reader opens them."""

import re

import pytest
import pyvista as pv

import vizlight
from vizlight import files

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
        with pytest.raises(files.FileError, match=reason):
            vizlight.read(path)


def test_places_beyond_the_largest(tmp_path):
    pv.RectilinearGrid([0.0, 1e200], [0.0, 1], [0.0, 1]).save(tmp_path / "a.vtr")
    with pytest.raises(files.FileError, match=r"points beyond 1e\+100, the largest coordinate"):
        vizlight.read(tmp_path / "a.vtr")


def test_a_legacy_file_that_ends_before_its_cells(tmp_path):
    path = tmp_path / "a.vtk"
    BOX.cast_to_unstructured_grid().save(path, binary=False)
    path.write_text(path.read_text().partition("CELLS")[0] + "METADATA\n")
    with pytest.raises(files.FileError, match="its last block is not whole"):
        vizlight.read(path)
