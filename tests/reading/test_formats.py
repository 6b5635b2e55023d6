"""Files of many formats: whole ones, those that lack a part, and packages that are missing."""

import gzip
import io
import struct
import sys
import zipfile
import zlib

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, refused, saved

import vizlight
from vizlight import cli, files
from vizlight.reading import formats

VIEW = vizlight.View(direction=(0, 0, 1))


#: As gmsh writes it: with the entities of which the mesh is made, and what bounds them.


@pytest.mark.parametrize(
    ("name", "module", "words"),
    [
        ("a.trk", "nibabel", r".trk files are read by nibabel: .*'vizlight\[tracts\]'"),
        ("a.trx", "trx", r".trx files are read by trx-python: .*'vizlight\[tracts\]'"),
        ("a.mesh", "meshio", r".mesh files are read by meshio: .*'vizlight\[formats\]'"),
        ("a.tif", "rasterio", r".tif files are read by rasterio: .*'vizlight\[maps\]'"),
        ("a.NC", "xarray", r".nc files are read by xarray: .*'vizlight\[formats\]'"),
    ],
)
@pytest.mark.usefixtures("without_trial")
def test_a_package_that_is_missing_is_named(name, module, words, tmp_path, monkeypatch):
    """Another process would have the package."""
    for loaded in [key for key in sys.modules if key.partition(".")[0] == module]:
        monkeypatch.delitem(sys.modules, loaded)
    monkeypatch.setitem(sys.modules, module, None)
    path = tmp_path / name
    refused(saved(path, b"x"), words)


def test_unequal_axes_missing_values_and_the_first_time(tmp_path):
    xarray = pytest.importorskip("xarray")
    winds = np.arange(24.0).reshape(2, 3, 4)
    winds[0, 1, 2] = np.nan
    xarray.Dataset(
        {"wind": (("time", "lat", "lon"), winds), "other": (("lat", "lon"), np.ones((3, 4)))},
        {"lat": [40.0, 30.0, 10.0], "lon": [1.0, 2.0, 4.0, 8.0], "time": [5.0, 6.0]},
    ).to_netcdf(tmp_path / "a.nc", engine="scipy")
    grid = vizlight.read(tmp_path / "a.nc", time="first")
    assert isinstance(grid, pv.RectilinearGrid)
    assert grid.dimensions == (4, 3, 1)
    assert np.isnan(grid["wind"]).sum() == 1
    x, y, z = grid.points[np.argmax(np.isnan(grid["wind"]))]
    assert (x, y, z) == (4.0, 30.0, 0.0)


def test_corners_of_cells_are_no_variable(tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "a.nc"
    axis = ("cell", np.arange(5.0), {"bounds": "lat_bounds"})
    corners = ("cell", "corner"), np.ones((5, 6))
    xarray.Dataset(
        {"heat": ("cell", np.arange(5.0)), "lat": axis, "lat_bounds": corners}
    ).to_netcdf(path, engine="scipy")
    refused(path, "no variable on a grid of two or three axes")


@pytest.mark.parametrize(
    ("cut", "rise"),
    [(("--for", "shape"), 600), (("--clip", "z:3"), 1000), (("--slice", "x:1.15"), 1500)],
)
def test_a_volume_in_degrees_is_no_needle_in_pictures(cut, rise, tmp_path, capsys):
    """Planes that cut it are in the coordinates of the file."""
    xarray = pytest.importorskip("xarray")
    axes = {"level": [1.0, 2, 3, 4], "grid_latitude": [0.1, 0.2, 0.3], "grid_longitude": [1.1, 1.2]}
    air = xarray.Dataset({"warmth": ([*axes], np.zeros((4, 3, 2)))}, coords=axes)
    air.to_netcdf(tmp_path / "air.nc", engine="scipy")
    out = str(tmp_path / "lit.vtp")
    assert cli.main(["light", str(tmp_path / "air.nc"), *cut, "-o", out]) == 0
    assert "its z taken" in capsys.readouterr().out
    assert pv.read(out).bounds_size[2] == pytest.approx(rise)


@pytest.mark.parametrize(
    ("attribute", "words"),
    [
        ("", "HDF5 of an unknown program; look at a mesh of"),
        ("elangle", r"radar's volume of ODIM; xradar makes .*open_odim_datatree\('a.h5'\), 'a.nc'"),
        ("mdtraj", r"MDTraj; it writes a state as .pdb: mdtraj.load\('a.h5'\)"),
    ],
)
def test_other_files_of_hdf5_are_refused_with_a_way_out(attribute, words, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["field"] = np.zeros((2, 3))
        file["field"].attrs[attribute or "unit"] = 1.0
    refused(tmp_path / "a.h5", words)


def test_a_recipe_of_gmsh_is_no_mesh(tmp_path):
    with pytest.raises(files.FileError, match="gmsh makes a mesh of it: gmsh -3 -format msh2"):
        vizlight.read(saved(tmp_path / "t1.geo", "Point(1) = {0, 0, 0, 1};\n"))


def test_a_step_of_a_file_that_has_none(tmp_path):
    assert vizlight.read(saved(tmp_path / "a.xyz", "0 0 0\n1 2 3\n"), time="first").n_points == 2
    with pytest.raises(ValueError, match=r"time: expected a file of several steps, got 'a\.xyz'"):
        vizlight.read(tmp_path / "a.xyz", time=3)


#: Two triangles in a plane, their four sides and the edge between them.
FLUENT = """(0 "by hand")
(2 2)
(10 (0 1 4 1 2))
(12 (0 1 2 0))
(13 (0 1 5 0))
(10 (1 1 4 1 2)
(
0 0
1 0
1 1
0 1
))
(13 (2 1 4 3 2)
(
1 2 1 0
2 3 1 0
3 4 2 0
4 1 2 0
))
(13 (3 5 5 2 2)
(
1 3 2 1
))
(12 (1 1 2 1 1))
(45 (1 fluid a)())
(45 (2 wall b)())
(45 (3 interior c)())
"""


def test_cells_of_fluent_are_read_once(tmp_path):
    for name in ("a.cas", "a.msh"):
        mesh = vizlight.read(saved(tmp_path / name, FLUENT))
        assert (mesh.n_points, mesh.n_cells) == (4, 2)
        assert mesh.max_cell_dimensionality == 2


NRRD = b"NRRD0004\ntype: short\ndimension: 3\nsizes: 10 3 2\nencoding: raw\n\n" + bytes(120)
META = (
    b"ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 5 4 3\nElementSpacing = 1 1 1\n"
    b"ElementType = MET_SHORT\nElementDataFile = LOCAL\n" + bytes(120)
)
GRIB1 = b"GRIB\0\0\x28\1" + bytes(28) + b"7777"
GRIB2 = b"GRIB\0\0\0\2" + (40).to_bytes(8, "big") + bytes(20) + b"7777"
ATOM = b"ATOM      1  CA  ALA A   1       0.000   0.000   0.500  1.00  0.00           C\n"
TECPLOT = (
    b'VARIABLES = "X" "Y" "Z"\nZONE N=3, E=1, F=FEPOINT, ET=TRIANGLE\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n'
)
OBJ = b"# 12/31/2020\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n"
PACKED = gzip.compress(bytes(range(200)))
HDF = b"\x89HDF\r\n\x1a\n" + struct.pack("<5x2B25xQ52x", 8, 8, 100)
#: A text of five bytes in a heap of HDF5, filled up to eight.
HEAP = struct.pack("<HHIQ8s", 1, 1, 0, 5, b"words")


def archive(*, method=0):
    """Return an archive of one part, which states how that is packed."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as parts:
        parts.writestr("header.json", "{}")
    data = bytearray(file.getvalue())
    data[8] = data[data.find(b"PK\1\2") + 10] = method
    return bytes(data)


def scan(*, minor=2, records=0, kind=3, count=2, extended=0):
    """Return points of LAS, or the begin of such a file."""
    head = bytearray(375 if minor == 4 else 227)
    head[:4], head[24:26] = b"LASF", bytes((1, minor))
    struct.pack_into("<HIIBHI", head, 94, len(head), len(head), records, kind, 34, count)
    if minor == 4:
        struct.pack_into("<QIQ", head, 235, len(head) + 68, extended, count)
    return bytes(head) + bytes(68)


AVS = b"3 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 0 tri 1 2 3\n"


def png(kind=b"IDAT"):
    """Return a grey picture of four pixels."""
    parts = (
        (b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 0, 0, 0, 0)),
        (kind, zlib.compress(b"\0\1\2\0\3\4")),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in parts
    )


BMP = struct.pack("<2sI4xIIiiHHI20x", b"BM", 70, 54, 40, 2, 2, 1, 24, 0) + bytes(range(16))
WHOLE = {
    "a.bmp": BMP,
    "a.nrrd": NRRD,
    "a.mha": META,
    "a.png": png(),
    "a.pnm": b"P5\n# a comment\n2 2\n255\nabcd",
    "a.dat": TECPLOT,
    "a.avs": AVS,
    "a.obj": OBJ,
    "untextured.obj": OBJ.replace(b"vt 0 0\n", b""),
    "slashes.obj": OBJ.replace(b"/1/1", b"/1/").replace(b"vn 0 0 1\n", b""),
}
WRONG = {
    "no end": ("a.nrrd", NRRD[:40], "header"),
    "dimension": ("a.nrrd", NRRD.replace(b"dimension: 3", b"dimension: 100000"), "3 sizes for"),
    "sizes": ("a.nrrd", NRRD.replace(b"sizes: 10", b"sizes: 1000"), "of 12065 bytes"),
    "late": (
        "a.nrrd",
        NRRD.replace(b"dimension: 3\n", b"").replace(b"\n\n", b"\ndimension: 3\n\n"),
        "its sizes stand before their number",
    ),
    "twice": ("a.nrrd", NRRD.replace(b"\n\n", b"\ntype: int\n\n"), "a key stands twice"),
    "no data": ("a.nhdr", NRRD[:-121] + b"data file: b.raw\n", "'b.raw' are missing"),
    "no break": ("a.nhdr", NRRD[:-121] + b"data file: b.raw", "last line has no line break"),
    "huge": ("a.mha", META.replace(b"DimSize = 5", b"DimSize = 1000000000"), "bytes are there"),
    "no place": ("a.mha", META[:60], "its header has no end"),
    "sum": ("a.png", png().replace(b"IHDR\0\0\0\2", b"IHDRdddd"), "check sum"),
    "cut": ("a.png", png()[:-9], "check sum|requires a buffer"),
    "no size": ("a.pnm", b"P5\n# a comment", "width and height"),
    "wide": ("a.bmp", BMP.replace(b"\2\0\0\0\2", b"\2\0\0\7\2"), r"70 of \d{9} bytes"),
    "no width": ("a.bmp", BMP.replace(b"\2\0\0\0\2", b"\0\0\0\0\2"), "0 pixels wide"),
    "column": ("a.pdb", ATOM.replace(b"   0.000   0.500", b"   0.0 0   0.500"), "no numbers in"),
    "short atom": ("a.pdb", ATOM[:53], "no numbers in the columns"),
    "nodes": ("a.dat", TECPLOT.replace(b"N=3", b"N=300"), "of 903 numbers"),
    "negative": ("a.tec", TECPLOT.replace(b"E=1", b"E=-5"), "negative"),
    "quotation": ("a.dat", TECPLOT.replace(b'"Z"', b'"Z'), "a name in it has no end"),
    "no zone": ("a.dat", TECPLOT[:9], "no VARIABLES and ZONE"),
    "order": (
        "a.mdpa",
        b"End Nodes\nBegin Elements T\nEnd Elements\nBegin Nodes\n",
        "do not end as they begin",
    ),
    "block": ("a.mdpa", b"Begin Nodes\n 1 0.0 0.0 0.", "do not end as they begin"),
    "text": ("a.obj", OBJ.replace(b"1 0 0", b"1 0 \0"), "bytes of 0"),
    "point": ("a.obj", OBJ.replace(b"3/1/1", b"8/1/1"), "the point 8 of 3"),
    "normal": ("a.obj", OBJ.replace(b"3/1/1", b"3//7"), "the normal 7 of 1"),
    "corner": ("a.obj", OBJ.replace(b"3/1/1", b"3/1/0x7fffffff"), "corner '3/1/0x7fffffff'"),
    "axes": ("a.gii", b'<DataArray Dimensionality="10000000" />', "an array of 10000000 axes"),
    "arrays": (
        "a.gii",
        b'<GIFTI NumberOfDataArrays="2"><DataArray Dimensionality="1"/></GIFTI>',
        "1 of 2 arrays are there",
    ),
    "records": ("a.las", scan(records=1 << 30), "records end after byte 227, where its points"),
    "points of a scan": ("a.las", scan(count=3), "295 of 329 bytes are there"),
    "later records": ("a.laz", scan(minor=4, kind=131, extended=2), "443 of 563 bytes are there"),
    "counts": ("a.avs", AVS[10:], "its first line is no five counts"),
    "no line": ("a.avs", AVS[:30], "4 of 5 lines of points and cells"),
    "no corner": ("a.avs", AVS[:-10], "a cell is not whole"),
    "message": ("a.grib", GRIB1 + GRIB2[:-9], "message 2 does not end where its length of 40"),
    "begin": ("a.grb", GRIB1 + GRIB2[9:], "the begin of message 2 is missing"),
    "edition": ("a.grb2", GRIB1 + GRIB2.replace(b"\2", b"\5"), "the begin of message 2"),
    "line": (
        "a.nrrd",
        NRRD.replace(b"encoding", b"s\0\nencoding"),
        "a line of its header is no field",
    ),
    "columns": ("a.pdb", ATOM.replace(b"   1  ", b"1" + b"0" * 30), "no numbers in the columns"),
    "sum of all": ("a.mgz", PACKED[:-8] + bytes(4) + PACKED[-4:], "CRC check failed"),
    "cut sum": ("a.nii.gz", PACKED[:-8], "ended before the end-of-stream marker"),
    "sum of a part": ("a.trx", archive().replace(b"{}", b"{ "), "the check sum of 'header.json'"),
    "packed otherwise": ("a.trx", archive(method=99), "compression method"),
    "no archive": ("a.trx", archive()[:-9], "File is not a zip file"),
    "heap": (
        "a.nc",
        HDF + b"GCOL\1" + bytes(3) + struct.pack("<Q", 56) + HEAP + bytes(16),
        "free space of 0",
    ),
}


@pytest.mark.parametrize("name", WHOLE)
def test_whole_files_are_read(name, tmp_path):
    if name.endswith(".avs"):
        pytest.importorskip("meshio")
    assert vizlight.read(saved(tmp_path / name, WHOLE[name])).n_points > 2


def test_messages_of_both_editions_are_followed(tmp_path):
    """Also with other bytes between them, and of a length that counts in steps of 120 bytes."""
    large = b"GRIB\x80\0\2\1" + bytes(200) + b"7777"
    (tmp_path / "a.grib").write_bytes(b"a head\r\n" + GRIB1 + bytes(99) + large + GRIB2 + bytes(7))
    assert not formats.missing_part(tmp_path / "a.grib")


@pytest.mark.parametrize("kind", WRONG)
def test_headers_that_contradict_the_data_are_refused(kind, tmp_path):
    name, content, words = WRONG[kind]
    refused(saved(tmp_path / name, content), words)


@pytest.mark.filterwarnings("default:.*may be cut")
def test_a_file_that_ends_within_a_line(tmp_path):
    with pytest.warns(UserWarning, match="may be cut in its last line"):
        vizlight.read(saved(tmp_path / "a.pdb", ATOM + ATOM.replace(b"0.500", b"0.900")[:62]))


@pytest.mark.filterwarnings("default:.*first axis")
@pytest.mark.parametrize(
    ("name", "content", "count"),
    [
        ("a.mha", META.replace(b"5 4 3", b"5 4 2"), 40),
        ("a.nrrd", NRRD.replace(b"10 3 2", b"10 2 2"), 40),
        ("a.pnm", b"P5\n# a comment\n2 2\n255\nabcdef", 2),
    ],
)
def test_bytes_of_images_beyond_their_sizes(name, content, count, tmp_path):
    read_warned(saved(tmp_path / name, content), f"has {count} bytes more than it states")


@pytest.mark.parametrize("binary", [False, True])
def test_triangles_of_stl_without_area(binary, tmp_path):
    mesh = pv.Sphere(theta_resolution=6, phi_resolution=6)
    mesh.points[-1] = mesh.points[-2]
    mesh.save(tmp_path / "a.stl", binary=binary)
    with pytest.warns(UserWarning, match="gives 46 of the 48 triangles that it states"):
        assert vizlight.read(tmp_path / "a.stl").n_cells == 46


@pytest.mark.filterwarnings("default:.*first axis")
def test_an_axis_that_vtk_takes_for_components(tmp_path):
    """The number of rows is 9 at most, whatever the header says of its kind."""
    for sizes, dimensions in ((b"10 3 2", (10, 3, 2)), (b"6 5 2", (5, 2, 1))):
        (tmp_path / "a.nrrd").write_bytes(NRRD.replace(b"10 3 2", sizes))
        if sizes[:2] == b"10":
            assert vizlight.read(tmp_path / "a.nrrd").dimensions == dimensions
            continue
        with pytest.warns(UserWarning, match="its first axis of 6 numbers as components"):
            assert vizlight.read(tmp_path / "a.nrrd").dimensions == dimensions


def test_a_key_of_a_program_is_no_field_of_an_image(tmp_path):
    key = b"\nSegmentation_ConversionParameters:=Smoothing: 0.5|&\n\n"
    (tmp_path / "a.nrrd").write_bytes(NRRD.replace(b"\n\n", key))
    assert vizlight.read(tmp_path / "a.nrrd").dimensions == (10, 3, 2)


def test_places_beyond_the_largest(tmp_path):
    pv.RectilinearGrid([0.0, 1e200], [0.0, 1], [0.0, 1]).save(tmp_path / "a.vtr")
    refused(tmp_path / "a.vtr", r"points beyond 1e\+100, the largest coordinate")


def test_places_in_hdf5_have_any_number_of_bytes(tmp_path):
    """Of a file that HDF5 writes with short places, the end is where the library says."""
    h5py = pytest.importorskip("h5py")
    for size in (4, 8):
        layout = h5py.h5p.create(h5py.h5p.FILE_CREATE)
        layout.set_sizes(size, size)
        path = tmp_path / f"{size}.h5"
        with h5py.File(h5py.h5f.create(str(path).encode(), fcpl=layout)) as file:
            file["values"] = [*range(100)]
        whole = path.read_bytes()
        assert whole[9 if whole[8] > 1 else 13] == size
        assert not formats.missing_part(path)
        path.with_suffix(".nc").write_bytes(whole[:-9])
        assert "bytes are there" in formats.missing_part(path.with_suffix(".nc"))
        path.with_suffix(".nc").write_bytes(whole)
        assert not formats.missing_part(path.with_suffix(".nc"))
