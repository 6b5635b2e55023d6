"""Formats that no reader takes are known before any reader is loaded."""

import subprocess
import sys
from pathlib import Path

import pytest
from pyvista.core.utilities import reader
from refusals import refused, saved

from vizlight.reading import formats, other_formats


def test_no_reader_takes_them():
    ends = {end for group in other_formats.WAYS for end in group}
    assert ends.isdisjoint(reader.CLASS_READERS)
    for end in ends:
        row = formats.of(Path(f"a{end}"))
        assert not row.read
        assert not row.package


def test_they_are_refused_before_a_reader_is_loaded(tmp_path):
    path = saved(tmp_path / "walk.xtc", b"something")
    with pytest.raises(ValueError, match=r"no reader takes '.xtc' files; write a state of the mol"):
        other_formats.check(path)
    code = (
        "import sys; from vizlight import cli; code = cli.main([sys.argv[1]]); "
        "sys.exit(code if 'pyvista' not in sys.modules else 1)"
    )
    command = [sys.executable, "-c", code, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert "as .pdb, .cif or .xyz" in done.stderr


def test_grib_of_any_name_and_other_files_are_left_to_readers(tmp_path):
    for name, data in (("a.txt", b"GRIB 1"), ("b.stl", b"solid"), ("c.gz", b"x")):
        (tmp_path / name).write_bytes(data)
        other_formats.check(tmp_path / name)
    other_formats.check(tmp_path / "absent.xtc")


@pytest.mark.parametrize(
    ("name", "content", "format_"),
    [
        ("a.mesh", b"MFEM NC mesh v1.0\n\ndimension\n2\n", "a mesh of MFEM"),
        ("a.asc", b';by a program\n("CellBody"\n  (Color Red)\n', "a neuron of Neurolucida"),
        ("a.dat", b" BINARY 2.B\n!File started at: 2007\n", "a result of Elmer"),
        ("a.dat", bytes.fromhex("ec2b0800") + bytes(16), "a restart of SU2"),
        ("a.hdf", bytes.fromhex("0e031301") + bytes(16), "HDF4, as of MODIS"),
        ("a.xml", b"<q:quakeml xmlns:q='a'></q:quakeml>", "no mesh of DOLFIN"),
        ("a.cdf", bytes.fromhex("cdf30001") + bytes(16), "CDF of NASA"),
        ("a.msh", b"# of a run\nMESH dimension 2 ElemType Triangle Nnode 3\n", "a mesh of GiD"),
        ("a.cdb", b"/PREP7\n", "ansys-mapdl-reader makes a .vtu of it"),
        ("a.he5", b"", "look at an array of it by xarray"),
    ],
)
def test_formats_with_the_name_of_another_are_named_by_their_content(
    name, content, format_, tmp_path
):
    path = tmp_path / name
    refused(saved(path, content), f"a mesh that PyVista reads, got .*{format_}")
    path.write_bytes(b"ncols 3 <dolfin>\n")
    assert not other_formats.of_content(path)


def test_a_file_that_is_none_of_tecplot_is_not_damaged(tmp_path):
    path = tmp_path / "a.dat"
    refused(saved(path, b"1 2 3\n"), "expected a file of Tecplot, got .*no VARIABLES and ZONE")


def test_hdf5_of_another_program_is_not_damaged(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.hdf", "w") as file:
        file["where"] = [1.0]
    refused(tmp_path / "a.hdf", "expected a mesh of VTK in HDF5, got .*by xarray")


def test_features_of_maps_have_a_way_to_a_raster():
    assert "gdal_rasterize" in other_formats.reason(Path("a.geojson"))
