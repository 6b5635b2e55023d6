"""Tractograms and grids that other packages read."""

import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import cli, files
from vizlight.mesh import meaning, polylines

VIEW = vizlight.View(direction=(0, 0, 1))


def tract(name):
    """Return the path of a file that nibabel carries for its own tests."""
    nibabel = pytest.importorskip("nibabel")
    path = Path(nibabel.__file__).parent / "tests" / "data" / name
    if not path.is_file():
        pytest.skip("nibabel is installed without its tests")
    return path


def lines_of(mesh):
    return [np.asarray(mesh.get_cell(i).points) for i in range(mesh.n_cells)]


@pytest.mark.parametrize("name", ["complex.trk", "complex_big_endian.trk"])
def test_a_tractogram_has_its_data_per_point_and_per_line(name):
    """The numbers are those of nibabel's own description of its test data."""
    mesh = vizlight.read(tract(name))
    assert [len(line) for line in lines_of(mesh)] == [1, 2, 5]
    np.testing.assert_allclose(mesh.points, np.concatenate(
        [np.arange(3.0 * n).reshape(n, 3) for n in (1, 2, 5)]
    ))  # fmt: skip
    np.testing.assert_allclose(
        mesh.point_data["fa"], [0.2, 0.3, 0.4, 0.5, 0.6, 0.6, 0.7, 0.8], rtol=1e-6
    )
    np.testing.assert_array_equal(
        mesh.point_data["colors"], np.repeat([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [1, 2, 5], axis=0)
    )
    np.testing.assert_allclose(mesh.cell_data["mean_curvature"], [1.11, 2.11, 3.11])
    assert mesh.cell_data["mean_colors"].shape == (3, 3)
    assert all(array.dtype.isnative for array in mesh.point_data.values())


def test_the_formats_agree_about_the_space():
    """The same lines in TrackVis's two orders of axes and in MRtrix's file."""
    expected = vizlight.read(tract("standard.trk"))
    assert expected.n_cells == 120
    for name in ("standard.LPS.trk", "standard.tck"):
        np.testing.assert_allclose(vizlight.read(tract(name)).points, expected.points, atol=1e-5)


def test_trx_has_the_lines_the_data_and_the_groups(tmp_path):
    trx = pytest.importorskip("trx.trx_file_memmap")
    import nibabel

    source = nibabel.streamlines.load(tract("complex.trk")).tractogram
    with warnings.catch_warnings():
        # Its writer leaves a folder to the garbage collector.
        warnings.simplefilter("ignore", ResourceWarning)
        made = trx.TrxFile.from_tractogram(
            source, reference=nibabel.Nifti1Image(np.zeros((20, 20, 20), np.uint8), np.eye(4))
        )
        made.groups["left"] = np.array([0, 2], np.uint32)
        trx.save(made, str(tmp_path / "a.trx"))
        made.close()
    mesh = vizlight.read(tmp_path / "a.trx")
    expected = vizlight.read(tract("complex.trk"))
    assert [len(line) for line in lines_of(mesh)] == [1, 2, 5]
    np.testing.assert_allclose(mesh.points, expected.points, atol=1e-2)  # half precision
    np.testing.assert_allclose(mesh.point_data["fa"], expected.point_data["fa"], rtol=1e-3)
    np.testing.assert_allclose(
        mesh.cell_data["mean_curvature"], expected.cell_data["mean_curvature"], rtol=1e-3
    )
    assert mesh.cell_data["left"].tolist() == [1, 0, 1]


def test_a_tractogram_is_lit_and_kept(tmp_path):
    mesh = vizlight.read(tract("standard.trk"))
    lit = vizlight.illuminate(mesh, vizlight.Scene(view=VIEW))
    assert lit["luminance"].min() > 0.2  # 0.1 of it is ambient
    files.write_mesh(lit, tmp_path / "lit.vtp")
    np.testing.assert_array_equal(
        vizlight.read(tmp_path / "lit.vtp")["luminance"], lit["luminance"]
    )


@pytest.mark.parametrize("name", ["empty.trk", "empty.tck", "no_header_end.tck"])
def test_a_tractogram_without_lines_or_header(name):
    with pytest.raises(files.FileError, match=rf"got '.*{name}' \((no points|Miss)"):
        vizlight.read(tract(name))


@pytest.mark.parametrize(("name", "cut"), [("standard.trk", 5), ("standard.tck", 19)])
def test_a_cut_tractogram_is_refused(name, cut, tmp_path):
    path = tmp_path / name
    path.write_bytes(tract(name).read_bytes()[:-cut])
    with pytest.raises(files.FileError, match="file: expected a mesh"):
        vizlight.read(path)


def test_a_file_of_abaqus_is_not_one_of_avs(tmp_path):
    pytest.importorskip("meshio")
    lines = "*NODE", "1, 0, 0, 0", "2, 1, 0, 0", "3, 0, 1, 0", "*ELEMENT, TYPE=S3", "1, 1, 2, 3"
    (tmp_path / "a.inp").write_text("\n".join(lines))
    mesh = vizlight.read(tmp_path / "a.inp")
    assert mesh.n_cells == 1
    np.testing.assert_array_equal(mesh.points, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])


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


#: As gmsh writes it: with the entities of which the mesh is made, and what bounds them.
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


def test_a_mesh_of_gmsh(tmp_path):
    pytest.importorskip("meshio")
    path = tmp_path / "part.msh"
    path.write_text(GMSH)
    mesh = vizlight.read(path)
    # The edge of the shape, on which the triangle has a side, is none of the mesh.
    assert mesh.celltypes.tolist() == [pv.CellType.TRIANGLE]
    assert mesh.cell_data.keys() == ["gmsh:geometrical"]
    of_one = '$ElementData\n1\n"p"\n1\n0\n3\n0\n1\n1\n2 5\n$EndElementData\n'
    path.write_text(GMSH + of_one)
    with pytest.warns(UserWarning, match="its values of some cells alone are left out"):
        assert vizlight.read(path).n_cells == 1
    path.write_text(GMSH.replace("2 2 1 2", "2 3 1 3"))
    with pytest.warns(UserWarning, match="gives 2 of the 3 cells that it states"):
        vizlight.read(path)


def test_an_edge_of_a_mesher_that_no_face_has_is_named(tmp_path):
    meshio = pytest.importorskip("meshio")
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 0, 0]], dtype=float)
    path = tmp_path / "part.mesh"
    meshio.Mesh(points, [("triangle", [[0, 1, 2]]), ("line", [[1, 3]])]).write(path)
    with pytest.warns(UserWarning, match="left out: cells of lower dimension"):
        mesh = vizlight.read(path)
    assert mesh.celltypes.tolist() == [pv.CellType.TRIANGLE]


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
    (tmp_path / "a.mesh").write_text(f"{head}0.0 0\n1.5 1\nEdges\n1\n1 2 0\nEnd\n")
    mesh = vizlight.read(tmp_path / "a.mesh")
    np.testing.assert_array_equal(mesh.points, [[0, 0, 0], [1.5, 0, 0]])
    assert mesh.n_cells == 1


def test_an_array_of_meshio_without_rows_for_some_cells_is_left_out(tmp_path):
    pytest.importorskip("meshio")
    path = tmp_path / "a.fem"
    grids = [(1, 0, 0), (2, 1, 0), (3, 0, 1), (4, 1, 1)]
    lines = [f"GRID,{i},,{x}.0,{y}.0,0.0" for i, x, y in grids]
    lines += ["CBAR,1,,1,2", "CTRIA3,2,7,1,2,3", "CTRIA3,3,8,2,4,3"]
    path.write_text("\n".join(["BEGIN BULK", *lines, "ENDDATA", ""]))
    with pytest.warns(UserWarning, match=r"'nastran:ref' has 2 rows for 3 cells, and is left out"):
        mesh = vizlight.read(path)
    assert (mesh.n_points, mesh.array_names) == (4, [])


def test_a_file_that_a_reader_of_meshio_refuses(tmp_path, capsys):
    pytest.importorskip("meshio")
    path = tmp_path / "a.wkt"
    path.write_text("POINT (1 2)")
    with pytest.raises(files.FileError, match=r"a\.wkt' \(Invalid WKT"):
        vizlight.read(path)
    assert capsys.readouterr().out == ""


def test_a_warning_of_a_reader_is_no_second_line(tmp_path):
    """NumPy warns of lines without numbers among those that are counted."""
    pytest.importorskip("meshio")
    path = tmp_path / "a.vol"
    rows = "1 0 0 0 0 1 2 3\n# none\n1 0 0 0 0 1 2 3\n"
    path.write_text(f"mesh3d\ndimension\n3\ngeomtype\n0\nsurfaceelements\n2\n{rows}")
    with pytest.raises(files.FileError, match=r"a\.vol"):
        vizlight.read(path)


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
    path.write_bytes(b"x")
    with pytest.raises(files.FileError, match=words):
        vizlight.read(path)


def grid_file(path, lon, time=None, **variables):
    xarray = pytest.importorskip("xarray")
    lat = np.array([40.0, 30.0, 10.0]) if len(variables) > 1 else np.array([30.0, 20.0, 10.0])
    axes = {"lat": lat, "lon": np.asarray(lon, dtype=float), "time": [5.0, 6.0]}
    xarray.Dataset(
        {key: (("time", "lat", "lon")[3 - np.ndim(v) :], v) for key, v in variables.items()},
        coords=axes,
    ).to_netcdf(path, engine="scipy")
    return vizlight.read(path, time=time)


def test_a_grid_of_degrees(tmp_path):
    heights = np.arange(12.0).reshape(3, 4)
    grid = grid_file(tmp_path / "a.nc", [1, 2, 3, 4], height=heights)
    assert isinstance(grid, pv.ImageData)
    assert grid.dimensions == (4, 3, 1)
    for value, (x, y, _) in zip(grid["height"], grid.points, strict=True):
        assert value == heights[[30.0, 20.0, 10.0].index(y), int(x) - 1]


def test_unequal_axes_missing_values_and_the_first_time(tmp_path):
    winds = np.arange(24.0).reshape(2, 3, 4)
    winds[0, 1, 2] = np.nan
    grid = grid_file(tmp_path / "a.nc", [1, 2, 4, 8], "first", wind=winds, other=np.ones((3, 4)))
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
    with pytest.raises(files.FileError, match="no variable on a grid of two or three axes"):
        vizlight.read(path)


def test_depths_are_below_the_surface(tmp_path):
    xarray = pytest.importorskip("xarray")
    warmth = np.arange(24.0).reshape(4, 3, 2)
    axis = ("depth", np.array([5.0, 10.0, 30.0, 90.0]), {"positive": "down"})
    sea = xarray.Dataset({"warmth": (("depth", "y", "x"), warmth)}, coords={"depth": axis})
    sea.to_netcdf(tmp_path / "sea.nc", engine="scipy")
    grid = vizlight.read(tmp_path / "sea.nc")
    assert (grid.bounds.z_min, grid.bounds.z_max) == (-90, -5)
    assert grid["warmth"][np.argmax(grid.points[:, 2])] == 0


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


def test_a_file_of_no_grid(tmp_path):
    with pytest.raises(files.FileError, match="no variable on a grid of two or three axes"):
        grid_file(tmp_path / "a.nc", [1, 2, 3], series=np.ones(3))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_colours_of_directions(dtype):
    points = np.array([[0, 0, 0], [3, 0, 0], [3, -4, 0], [3, -4, 5], [9, 9, 9]], dtype)
    mesh = pv.PolyData()
    mesh.points = points
    mesh.SetLines(pv.CellArray.from_arrays([0, 2, 4], [1, 0, 2, 3]))
    colors = vizlight.direction_colors(mesh)
    assert colors.dtype == dtype
    np.testing.assert_allclose(
        colors, [[1, 0, 0], [1, 0, 0], [0, 0, 1], [0, 0, 1], [0, 0, 0]], atol=1e-7
    )


def test_colours_of_directions_are_of_lines():
    with pytest.raises(ValueError, match="mesh: expected a mesh of lines, got PolyData; take"):
        polylines.direction_colors(pv.Sphere())
    with pytest.raises(TypeError, match="mesh: expected a PyVista mesh of lines, got list"):
        polylines.direction_colors([])


def test_tracts_whose_header_has_no_size(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    lines = nibabel.streamlines.Tractogram([np.eye(3, dtype="f4")], affine_to_rasmm=np.eye(4))
    nibabel.streamlines.save(lines, str(tmp_path / "a.trk"))
    data = bytearray((tmp_path / "a.trk").read_bytes())
    (tmp_path / "a.trk").write_bytes(data + bytes(12))
    with pytest.warns(UserWarning, match="has 12 bytes more than it states"):
        vizlight.read(tmp_path / "a.trk")
    data[12:24] = bytes(12)
    (tmp_path / "a.trk").write_bytes(data)
    with pytest.raises(files.FileError, match="no point is finite, by the affine of its header"):
        vizlight.read(tmp_path / "a.trk")


def test_tracts_that_are_fewer_than_their_header_states(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    lines = nibabel.streamlines.Tractogram([np.eye(3, dtype="f4")], affine_to_rasmm=np.eye(4))
    nibabel.streamlines.save(lines, str(tmp_path / "a.tck"))
    data = (tmp_path / "a.tck").read_bytes()
    (tmp_path / "a.tck").write_bytes(data.replace(b"count: 0000000001", b"count: 0000000002"))
    with pytest.warns(UserWarning, match="gives 1 of the 2 streamlines that it states"):
        assert vizlight.read(tmp_path / "a.tck").n_lines == 1


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("hello\n", "a word stands where a number should be"),
        ("hello world\n", "could not convert string"),
        ("\0\1\2", "a word stands where a number should be"),
        ("1 2\n3 4\n", "2 columns are no places"),
        ("", "1 columns are no places"),
        ("3\n1 2 3\n4 5 6\n", "2 of 3 points are there"),
    ],
)
def test_scans_that_are_no_points(tmp_path, text, reason):
    (tmp_path / "a.pts").write_text(text)
    with pytest.raises(files.FileError, match=reason):
        vizlight.read(tmp_path / "a.pts")


@pytest.mark.parametrize("count", ["2\n", ""])
def test_points_of_a_scan(tmp_path, count):
    (tmp_path / "a.pts").write_text(f"{count}0 0 0 5 255 0 0\n1 2 3 6 0 255 7\n")
    scan = vizlight.read(tmp_path / "a.pts")
    np.testing.assert_array_equal(scan.points, [[0, 0, 0], [1, 2, 3]])
    np.testing.assert_array_equal(scan["intensity"], [5, 6])
    np.testing.assert_array_equal(scan["color"], [[255, 0, 0], [0, 255, 7]])
    (tmp_path / "a.pts").write_text(f"{count}0 0 0 5 255 0 255\n1 2 3 6 0 255 255\n")
    scan = vizlight.read(tmp_path / "a.pts")
    assert scan.point_data.keys() == ["color"]
    np.testing.assert_array_equal(scan["color"], [[5, 255, 0], [6, 0, 255]])


def test_other_files_of_hdf5_are_refused_with_a_way_out(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["field"] = np.zeros((2, 3))
    with pytest.raises(files.FileError, match="HDF5 of an unknown program; look at a mesh of"):
        vizlight.read(tmp_path / "a.h5")


def test_triangles_in_text_of_a_brain(tmp_path):
    path = tmp_path / "cortex.tri"
    path.write_text("- 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 2 0 0 0 1\n- 1 1 1\n0 1 2\n")
    mesh = vizlight.read(path)
    assert (mesh.area, mesh.n_points) == (1, 3)
    path.write_text(path.read_text()[:-3])
    with pytest.raises(files.FileError, match="cannot reshape"):
        vizlight.read(path)


def test_a_recipe_of_gmsh_is_no_mesh(tmp_path):
    (tmp_path / "t1.geo").write_text("Point(1) = {0, 0, 0, 1};\n")
    with pytest.raises(files.FileError, match="gmsh makes a mesh of it: gmsh -3 -format msh2"):
        vizlight.read(tmp_path / "t1.geo")


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
def test_points_of_a_lidar(tmp_path, name):
    laspy = pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    cloud = laspy.create(point_format=3, file_version="1.2")
    cloud.header.scales, cloud.header.offsets = [0.01] * 3, [600_000.0, 5_000_000.0, 0.0]
    places = np.array([[600_001.25, 5_000_002.5, 7.0], [600_003.0, 5_000_004.0, 8.0]])
    cloud.x, cloud.y, cloud.z = places.T
    cloud.intensity, cloud.classification = [3, 9], [2, 5]
    cloud.red, cloud.green, cloud.blue = [65280, 0], [256, 512], [0, 65280]
    cloud.write(tmp_path / name)
    mesh = vizlight.read(tmp_path / name)
    np.testing.assert_allclose(mesh.points, places, atol=0.005)
    assert mesh["intensity"].tolist() == [3, 9]
    assert mesh["color"].tolist() == [[255, 1, 0], [0, 2, 255]]
    assert vizlight.look(mesh, size=(90, 60)).array == "color"
    cloud.red, cloud.green, cloud.blue = np.zeros((3, 2), np.uint16)
    cloud.write(tmp_path / name)
    assert vizlight.look(tmp_path / name, size=(90, 60)).array == "intensity"


def test_a_step_of_a_file_that_has_none(tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0\n1 2 3\n")
    assert vizlight.read(tmp_path / "a.xyz", time="first").n_points == 2
    with pytest.raises(ValueError, match=r"time: expected a file of several steps, got 'a\.xyz'"):
        vizlight.read(tmp_path / "a.xyz", time=3)


def test_points_in_lines_of_text(tmp_path):
    (tmp_path / "a.xyz").write_text("0 0 0 10 20 30\n1 2 3 40 50 60\n")
    mesh = vizlight.read(tmp_path / "a.xyz")
    assert mesh["color"].tolist() == [[10, 20, 30], [40, 50, 60]]


@pytest.mark.filterwarnings("default:.*the last three columns")
def test_normals_and_colors_of_points_in_lines_of_text(tmp_path):
    path = tmp_path / "a.xyz"
    path.write_text("0 0 0 0 0.6 -0.8\n1 2 3 1 0 0\n")
    mesh = vizlight.read(path)
    np.testing.assert_allclose(mesh.active_normals, [[0, 0.6, -0.8], [1, 0, 0]], atol=1e-6)
    path.write_text("0 0 0 0 0.5 1\n1 2 3 1 1 1\n")
    assert vizlight.read(path)["color"].tolist() == [[0, 128, 255], [255, 255, 255]]
    path.write_text("0 0 0 0 0.5 -9\n1 2 3 1 1 1\n")
    with pytest.warns(UserWarning, match="neither colours .* nor normals of length 1"):
        assert not vizlight.read(path).array_names


def test_tracts_say_in_which_frame_they_are():
    pytest.importorskip("nibabel")
    mesh = vizlight.read(tract("standard.trk"))
    assert meaning.ways(mesh) == ("left, right", "back, front", "down, up")
    mesh.point_data.clear()
    mesh.cell_data.clear()
    bar = vizlight.look(mesh).drawing.keys[0]["cmap"].run()
    assert bar.annotations == {0.0: "left, right", 1.0: "back, front", 2.0: "down, up"}
    assert meaning.ways(pv.Line()) == ("x", "y", "z")


def test_what_an_elevation_model_misses_is_nan(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    from rasterio import shutil

    rows = np.arange(600, dtype=np.int16).reshape(20, 30) + 100
    rows[0, :4] = -32767
    place = rasterio.Affine(30, 0, 500_000, 0, -30, 5_100_000)
    kind = {"width": 30, "height": 20, "count": 1, "dtype": "int16", "nodata": -32767}
    with rasterio.open(
        tmp_path / "a.tif", "w", driver="GTiff", crs="EPSG:26710", transform=place, **kind
    ) as file:
        file.write(rows, 1)
    shutil.copy(tmp_path / "a.tif", tmp_path / "a.dem", driver="USGSDEM")
    mesh = vizlight.read(tmp_path / "a.dem")
    heights = np.asarray(mesh["elevation"]).reshape(mesh.dimensions[1::-1])[-20:]
    # Rows of the mesh run north; the format begins a profile one row lower.
    assert np.isnan(heights[-1, :4]).all()
    np.testing.assert_array_equal(heights[-1, 4:], rows[0, 4:])
    assert str(mesh.field_data["unit"][0]) == "metre"


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
    (tmp_path / "a.cas").write_text(FLUENT)
    mesh = vizlight.read(tmp_path / "a.cas")
    assert (mesh.n_points, mesh.n_cells) == (4, 2)


def test_a_file_of_abaqus_may_have_the_name_of_one_of_gmsh(tmp_path):
    path = tmp_path / "a.msh"
    path.write_text(
        "*node, nset=Nall\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
        "*element, type=C3D4, elset=Eall\n1, 1, 2, 3, 4\n"
    )
    assert vizlight.read(path).n_cells == 1


def test_a_file_of_avs_ucd_may_begin_with_comments(tmp_path):
    path = tmp_path / "a.ucd"
    path.write_text("# AVS UCD\n3 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 7 tri 1 2 3\n")
    mesh = vizlight.read(path)
    assert (mesh.n_points, mesh.n_cells) == (3, 1)
    path.write_text("# AVS UCD\n3 1 0 0 0\n1 0 0 0\n")
    with pytest.raises(files.FileError, match="2 of 5 lines of points and cells"):
        vizlight.read(path)


def test_groups_of_gmsh_have_words_for_titles(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(
        np.eye(3), [("triangle", [[0, 1, 2]])],
        cell_data={"gmsh:physical": [np.array([5])], "gmsh:geometrical": [np.array([1])]},
    )  # fmt: skip
    meshio.gmsh.write(tmp_path / "a.msh", mesh, fmt_version="2.2")
    said = meaning.of(vizlight.read(tmp_path / "a.msh"))
    assert said.arrays["gmsh:physical"]["long_name"] == "Physical group"
