"""Files in and out: clear errors, whole files or none."""

import gzip
import os
import signal
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, saved
from scipy.spatial import cKDTree
from vtkmodules.vtkCommonCore import vtkOutputWindow

import vizlight
from vizlight import _supervise, _trials, files
from vizlight.mesh import meaning
from vizlight.reading import formats, reader

PLY = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\n%s\nend_header\n"


def volume():
    grid = pv.ImageData(dimensions=(8, 8, 8))
    grid["r"] = np.linalg.norm(grid.points - 3.5, axis=1)
    grid["V"] = np.ones((grid.n_points, 3))
    return grid


def test_names_of_arrays_are_one_line(tmp_path):
    # VTK takes a whole line of a cube, with its end.
    head = "Made up\n Density of helium \n1 0 0 0\n2 1 0 0\n2 0 1 0\n2 0 0 1\n2 2 0 0 0\n"
    path = saved(tmp_path / "a.cube", head + "1 2\n3 4\n5 6\n7 8\n")
    mesh = files.read(path)
    assert list(mesh.point_data) == [mesh.active_scalars_name] == ["Density of helium"]
    assert sorted(mesh["Density of helium"]) == [1, 2, 3, 4, 5, 6, 7, 8]


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.vtp", b"garbage", "no points: Error parsing XML"),
        ("b.vtk", b"garbage", ""),
        ("c.stl", b"solid x", ""),
        ("d.nothing", b"q", ""),
        ("e.ply", b"ply\nfoo", ""),
        ("f.vtu", b'<?xml version="1.0"?><VTKFile type="UnstructuredGrid"><UnstructuredGrid>', ""),
        ("g.ex2", b"x", ""),
        ("h.vtp", b"", ""),
        ("i.dwg", b"x", "no reader takes '.dwg' files; convert it to"),
        ("i.molden", b"x", "obabel 'i.molden' -O 'i.pdb'"),
        ("i.txt", b"x,y,z", r"mesh = pyvista.PolyData\(rows of x, y, z\)"),
        ("j.stp", b"x", "gmsh -2 -bin -clcurv 48 'j.stp' -o 'j.stl'"),
        ("j.fbx", b"x", "assimp export 'j.fbx' 'j.glb'"),
        ("k.gz", b"x", "no reader takes '.gz' files; unpack it first"),
        # Headers that break off within a line.
        ("l.ply", PLY % b"property" + bytes(100), "its header has the line"),
        ("m.ply", PLY % b"property list uchar" + bytes(100), "its header has the line"),
    ],
)
def test_damaged_files_give_one_clear_error(name, content, words, tmp_path, capfd):
    path = saved(tmp_path / name, content)
    expected = rf"file: expected a (mesh that|file that) .*, got .*{name}. \(.*{words}"
    with pytest.raises(files.FileError, match=expected):
        files.read(path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.skipif(not _trials._FORKS, reason="a helper does not share what is replaced")
def test_a_file_that_ends_the_process_is_refused(tmp_path, monkeypatch, calls_of):
    """Also one that is packed, of which another one is read; formats of own checks are not."""
    monkeypatch.setattr(_trials.threading, "active_count", lambda: 1)
    tried = calls_of(_trials, "_forked")
    found = reader._found

    def ends(path, *rest):
        if _trials._is_trial:
            os.kill(os.getpid(), signal.SIGKILL)
        return found(path, *rest)

    monkeypatch.setattr(reader, "_found", ends)
    pv.Sphere().save(tmp_path / "a.vtk")
    packed = gzip.compress((tmp_path / "a.vtk").read_bytes())
    (tmp_path / "b.vtk.gz").write_bytes(packed)
    for name in ("a.vtk", "b.vtk.gz"):
        with pytest.raises(files.FileError, match=rf"{name}' \(its reader was ended by SIGKILL"):
            files.read(tmp_path / name)
    assert len(tried) == 2
    pv.Sphere().save(tmp_path / "a.vtp")
    files.read(tmp_path / "a.vtp")
    with monkeypatch.context() as child:
        child.setattr(_supervise, "has_parent", lambda: True)
        files.read(tmp_path / "a.vtk")
    assert len(tried) == 2


def test_bytes_that_are_read_with_a_file(tmp_path):
    for name in ("case/0/p", "case/a.foam", "b.vtu", "c.vtk"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(bytes(1000))
    (tmp_path / "d.pvtu").write_text('<Piece Source="b.vtu"/>'.ljust(100))
    (tmp_path / "e.pvd").write_text('<A file="d.pvtu"/> <A file="none.vtu"/>'.ljust(100))
    assert reader._size(tmp_path / "c.vtk") == 1000
    assert reader._size(tmp_path / "case" / "a.foam") == 2000
    assert reader._size(tmp_path / "e.pvd") == 1200
    (tmp_path / "f.pvd").write_text(f'<A file="{"A" * 5000}"/>')
    with pytest.raises(files.FileError, match=r"f\.pvd"):
        files.read(tmp_path / "f.pvd")


def test_missing_file(tmp_path):
    with pytest.raises(files.FileError, match=r"file: expected a file, got .*\(no such file\)"):
        files.read(tmp_path / "no.vtp")
    with pytest.raises(files.FileError, match=r"file: expected a file, got .*\(a folder\)"):
        files.read(tmp_path)


def test_blocks_become_one_grid_of_their_highest_cells(tmp_path):
    grid = volume().cast_to_unstructured_grid()
    blocks = pv.MultiBlock({"solid": grid, "side": grid.extract_surface(algorithm="geometry")})
    blocks.save(tmp_path / "b.vtm")
    read = files.read(tmp_path / "b.vtm")
    assert isinstance(read, pv.UnstructuredGrid)
    assert read.n_cells == grid.n_cells
    assert "V" in read.point_data
    assert not [name for name in read.array_names if name.startswith("vtk")]


def test_blocks_that_are_left_out_are_named(tmp_path):
    ball = pv.Sphere(center=(20, 0, 0))
    line = pv.Line((20, 0, 0), (30, 0, 0))
    blocks = pv.MultiBlock({"grid": volume(), "more": pv.MultiBlock({"ball": ball}), "line": line})
    blocks.save(tmp_path / "b.vtm")
    with pytest.warns(UserWarning, match=r"which are left out: more/ball, line; light pyvista"):
        read = files.read(tmp_path / "b.vtm")
    assert read.n_cells == volume().n_cells


def cut(path, share):
    os.truncate(path, int(path.stat().st_size * share))
    return path


@pytest.mark.parametrize("kind", ["unstructured", "structured", "rectilinear", "poly"])
def test_whole_legacy_files_of_all_kinds_are_read(kind, tmp_path):
    mesh = volume()
    mesh.cell_data["C"] = np.ones((mesh.n_cells, 3))
    # VTK before 9.7 writes "nan" as text that it does not read.
    bad = np.nan if pv.vtk_version_info >= (9, 7) else 0.0
    mesh.point_data["bad"] = np.full(mesh.n_points, bad)
    mesh.add_field_data(["some words"], "note")
    mesh = pv.Sphere() if kind == "poly" else getattr(mesh, f"cast_to_{kind}_grid")()
    mesh.save(tmp_path / "a.vtk", binary=False)
    assert files.read(tmp_path / "a.vtk").n_points == mesh.n_points


def netcdf(path):
    """Write a grid with an axis without end, as models write it."""
    from scipy.io import netcdf_file

    with netcdf_file(path, "w") as file:
        for name, size in (("time", None), ("lat", 12), ("lon", 9)):
            file.createDimension(name, size)
        for name in ("lat", "lon"):
            size = file.dimensions[name]
            file.createVariable(name, "f8", (name,))[:] = np.arange(size)
        wind = file.createVariable("wind", "f4", ("time", "lat", "lon"))
        for step in range(3):
            wind[step] = np.random.default_rng(step).random((12, 9))


def tiff(path):
    from PIL import Image

    heights = np.random.default_rng(1).random((40, 50), dtype=np.float32)
    Image.fromarray(heights).save(path)


def appended(path):
    """Write a grid whose arrays stand as raw bytes at the end of the file."""
    from vtkmodules.vtkIOXML import vtkXMLRectilinearGridWriter

    writer = vtkXMLRectilinearGridWriter()
    writer.SetInputData(volume().cast_to_rectilinear_grid())
    writer.SetFileName(str(path))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.Write()


def legacy(path, version=42):
    """Write a legacy file of text."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

    writer = vtkPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetFileVersion(version)
    writer.SetFileTypeToASCII()
    writer.SetInputData(pv.Sphere(theta_resolution=12, phi_resolution=12))
    writer.Write()


def quads(path):
    """Write a file of PLY whose faces have four corners, and three."""
    plane = pv.Plane(i_resolution=8, j_resolution=8)
    mesh = plane.append_polydata(plane.translate((3, 0, 0)).triangulate())
    mesh.clear_data()
    mesh.save(path)


#: How a file is written, and the number of bytes at its end that may be missing without a trace:
#: filling, the end of a line, or a part of the last number.
SIZED = {
    "a.nc": (netcdf, 3),
    "a.tif": (tiff, 3),
    "a.vtr": (appended, 1),
    "a.vtp": (lambda path: pv.Sphere().save(path), 1),
    "a.stl": (lambda path: pv.Sphere().save(path), 3),
    "a.ply": (lambda path: pv.Sphere().save(path), 3),
    "text.ply": (lambda path: pv.Sphere().save(path, binary=False), 24),
    "quads.ply": (quads, 3),
    "a.vtk": (lambda path: volume().save(path), 60),
    "text.vtk": (lambda path: volume().save(path, binary=False), 60),
    "4.vtk": (legacy, 60),
    "5.vtk": (lambda path: legacy(path, 51), 60),
    "a.vti": (lambda path: volume().save(path), 1),
}


@pytest.mark.parametrize("name", SIZED)
def test_no_cut_of_a_file_that_states_its_size_is_read(name, tmp_path):
    pytest.importorskip({"a.nc": "xarray", "a.tif": "rasterio"}.get(name, "vtk"))
    path = tmp_path / name
    write, filling = SIZED[name]
    write(path)
    whole = path.read_bytes()
    assert files.read(path).n_points > 100
    last = len(whole.rstrip() if filling != 3 else whole) - filling
    for end in [*np.random.default_rng(7).integers(1, last, 20), last]:
        path.write_bytes(whole[:end])
        with pytest.raises(files.FileError, match="file: expected a "):
            files.read(path)


def test_threads_that_read_leave_the_streams_as_they_were(tmp_path):
    paths = [files.write_mesh(pv.Sphere(), tmp_path / f"a{i}.vtp") for i in range(4)]
    bad = tmp_path / "bad.vtk"
    volume().save(bad)
    cut(bad, 0.9)
    out, err, place = sys.stdout, sys.stderr, os.fstat(2)
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(files.read, paths * 10))
        with pytest.raises(files.FileError, match="damaged"):
            list(pool.map(files.read, [*paths, bad]))
    assert {mesh.n_points for mesh in found} == {842}
    assert sys.stdout is out
    assert sys.stderr is err
    assert os.fstat(2) == place


@pytest.mark.parametrize(("suffix", "cells"), [("f3grid", "* ZONES"), ("mdpa", "Begin Elements")])
def test_a_text_that_ends_before_its_cells_is_refused(suffix, cells, tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / f"a.{suffix}"
    meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])]).write(path)
    assert files.read(path).n_cells == 1
    path.write_text(path.read_text().partition(cells)[0])
    with pytest.raises(files.FileError, match="it has no cells"):
        files.read(path)


def test_what_meshio_says_is_a_warning_or_left_to_the_error(tmp_path, capfd):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "a.mesh"
    meshio.Mesh(np.eye(4, 3), [("tetra", [[0, 1, 2, 3]])]).write(path)
    unknown = "RequiredVertices\n1\n1\n"
    path.write_text(path.read_text().replace("End", 2 * unknown + "End"))
    with pytest.warns(UserWarning, match=r"a\.mesh': Meshio doesn't know .*first of 2 warnings"):
        assert files.read(path).n_cells == 1
    path = saved(tmp_path / "a.msh", "$MeshFormat\n4.1 0 8\nno end\n")
    with pytest.raises(files.FileError, match="section not found"):
        files.read(path)
    assert capfd.readouterr() == ("", "")


def test_files_whose_standard_has_y_up_stand_upright(tmp_path):
    tall = pv.Cylinder(direction=(0, 1, 0), height=5, radius=0.5)
    plotter = pv.Plotter(off_screen=True)
    plotter.add_mesh(tall)
    plotter.export_vrml(tmp_path / "a.wrl")
    plotter.export_gltf(tmp_path / "a.glb", rotate_scene=False)
    assert np.argmax(files.read(tmp_path / "a.glb").bounds_size) == 2
    tall.save(tmp_path / "a.ply")
    assert np.argmax(files.read(tmp_path / "a.ply").bounds_size) == 1
    assert np.argmax(files.read(tmp_path / "a.wrl").bounds_size) == 2


def test_files_of_scenes_are_read_without_a_screen(tmp_path, monkeypatch):
    """VTK warns of the screen that its importers ask for, and reads all the same."""
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW", raising=False)
    monkeypatch.delenv("DISPLAY", raising=False)
    path = tmp_path / "a.wrl"
    corners = "0 0 0, 1 0 0, 0 1 0, 0 0 1"
    path.write_text(
        "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point "
        f"[{corners}] }}"
        " coordIndex [0, 2, 1, -1, 0, 1, 3, -1, 1, 2, 3, -1, 0, 3, 2, -1] } }\n"
    )
    assert files.read(path).n_points == 4


def test_groups_of_faces_beside_lines_are_left_out(tmp_path):
    path = saved(tmp_path / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nusemtl a\nf 1 2 3\np 1\n")
    words = r"arrays without a row for each cell are left out: \['GroupIds'"
    with warnings.catch_warnings():
        # PyVista warns of them too, by its own class.
        warnings.filterwarnings("ignore", message="PolyData mesh is not valid")
        with pytest.warns(UserWarning, match=words):
            found = files.read(path)
    assert (found.n_cells, len(found.cell_data)) == (3, 0)
    # Without faces nothing is lost.
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ng a\nusemtl a\n")
    with warnings.catch_warnings(record=True) as notes:
        files.read(path)
    assert not [note for note in notes if "left out" in str(note.message)]
    bad = found.copy()
    pv.PolyData.GetCellData(bad).AddArray(pv.convert_array(np.zeros(1), "odd"))
    with pytest.raises(ValueError, match="expected cell arrays of 3 rows, one per cell, got 'odd'"):
        vizlight.illuminate(bad, feature_angle=30)


@pytest.mark.parametrize(
    "said",
    [
        "Could not locate key vtkExodusIIReader::GLOBAL_TEMPORAL_VARIABLE.",
        "Skipping BC_t node: BC_t type 'BCFarfield' not supported yet.",
        "No data file (.dat.h5) found. Only the case file will be opened.",
    ],
)
def test_warnings_of_what_is_no_part_of_a_mesh_refuse_no_file(said, tmp_path, monkeypatch):
    def found(path, time, **options):
        vtkOutputWindow.GetInstance().DisplayWarningText(f"{said}\n")
        return pv.Sphere()

    # Another process would not have this reader.
    monkeypatch.setattr(reader._trials, "are_needed", lambda: False)
    monkeypatch.setattr(formats, "read", found)
    (tmp_path / "a.cgns").touch()
    assert vizlight.read(tmp_path / "a.cgns").n_points == pv.Sphere().n_points
    said = "`FlowSolutionPointers` in the CGNS file 'a.cgns' refer to invalid solution nodes."
    with pytest.warns(UserWarning, match="name no solutions: those of one step are read"):
        vizlight.read(tmp_path / "a.cgns")


def test_arrays_with_keys_of_another_program_are_read(tmp_path):
    path = tmp_path / "a.vtu"
    mesh = volume().cast_to_unstructured_grid()
    mesh.field_data["KE"] = [1.0]
    mesh.save(path, binary=False)
    key = '<InformationKey name="UNITS" location="vtkNowhere">1</InformationKey>'
    head, tail = path.read_text().split("</FieldData>")
    end = head.rindex("</DataArray>")
    path.write_text(f"{head[:end]}{key}{head[end:]}</FieldData>{tail}")
    assert vizlight.read(path).n_points == 512


def test_the_parts_of_a_partitioned_dataset_become_one_grid(tmp_path, monkeypatch):
    parts = pv.PartitionedDataSet([volume().threshold([0, 3]), volume().threshold([3, 9])])
    parts.field_data["TimeValue"] = [7.0]
    # Another process would not have this reader.
    monkeypatch.setattr(reader._trials, "are_needed", lambda: False)
    monkeypatch.setattr(formats, "read", lambda path, time, **options: parts)
    (tmp_path / "a.vtpd").touch()
    mesh = vizlight.read(tmp_path / "a.vtpd")
    assert mesh.n_cells == sum(part.n_cells for part in parts)
    assert list(mesh.field_data["TimeValue"]) == [7]


@pytest.mark.filterwarnings("ignore:.*edges are sharper:UserWarning")
@pytest.mark.parametrize("ghosts", [False, True])
@pytest.mark.parametrize("suffix", [".vtp", ".vtu"])
def test_pieces_of_one_mesh_share_the_points_of_their_seams(suffix, ghosts, tmp_path):
    """So that light has no seam, and a volume has no walls inside; cells of neighbours go."""
    whole = pv.Sphere() if suffix == ".vtp" else volume().cast_to_unstructured_grid()
    whole.point_data.clear()
    whole["even"] = np.arange(whole.n_points) % 2 == 0
    (corners,) = whole.cast_to_unstructured_grid().cells_dict.values()
    side = whole.cell_centers().points[:, 0] > whole.center[0] + 0.01
    kind, lines = type(whole).__name__, []
    for i, own in enumerate((side, ~side)):
        kept = np.isin(corners, corners[own]).any(axis=1) if ghosts else own
        piece = whole.remove_cells(~kept)
        piece.clear_cell_data()
        piece.cell_data["vtkGhostType"] = (~own[kept]).astype(np.uint8)
        del piece.point_data["vtkOriginalPointIds"]
        piece.save(tmp_path / f"{i}{suffix}")
        lines.append(f'<Piece Source="{i}{suffix}"/>')
    arrays = '<P{}><PDataArray type="UInt8" Name="{}"/></P{}>'
    (tmp_path / f"x.p{suffix[1:]}").write_text(
        f'<VTKFile type="P{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
        f'<P{kind} GhostLevel="{int(ghosts)}">'
        + arrays.format("PointData", "even", "PointData")
        + arrays.format("CellData", "vtkGhostType", "CellData")
        + '<PPoints><PDataArray type="Float32" NumberOfComponents="3"/></PPoints>'
        + "".join(lines)
        + f"</P{kind}></VTKFile>"
    )
    mesh = vizlight.read(tmp_path / f"x.p{suffix[1:]}")
    assert (mesh.n_points, mesh.n_cells) == (whole.n_points, whole.n_cells)
    assert files.surface_of(mesh).n_cells == files.surface_of(whole).n_cells
    _, at = cKDTree(whole.points).query(mesh.points)
    np.testing.assert_array_equal(mesh["even"], whole["even"][at])
    lit = [vizlight.illuminate(each, feature_angle=None)["luminance"] for each in (mesh, whole)]
    np.testing.assert_allclose(lit[0], lit[1][at], atol=1e-6)


def test_xdmf_without_times_is_read(tmp_path):
    path = tmp_path / "mesh.xdmf"
    path.write_text(
        """<Xdmf Version="3.0"><Domain><Grid Name="Grid">
        <Geometry GeometryType="XYZ"><DataItem DataType="Float" Dimensions="4 3" Format="XML">
        0 0 0 1 0 0 0 1 0 0 0 1</DataItem></Geometry>
        <Topology TopologyType="Tetrahedron" NumberOfElements="1">
        <DataItem DataType="Int" Dimensions="1 4" Format="XML">0 1 2 3</DataItem></Topology>
        </Grid></Domain></Xdmf>"""
    )
    assert vizlight.read(path).volume == pytest.approx(1 / 6)


def test_sets_of_exodus_are_no_blocks_which_are_kinds(tmp_path, monkeypatch):
    plane = pv.Plane(i_resolution=2, j_resolution=2)
    plane.clear_data()
    shell, rest = plane.copy(), plane.translate((1, 0, 0))
    shell.cell_data["ObjectId"], rest.cell_data["ObjectId"] = np.full((2, 4), [[10], [4]], np.int32)
    found = pv.MultiBlock(
        {
            "Element Blocks": pv.MultiBlock({"inner shell": shell, "Unnamed block ID: 4": rest}),
            "Side Sets": pv.MultiBlock({"top": plane.copy(), "edge": pv.Line()}),
        }
    )
    # Another process would not have this reader.
    monkeypatch.setattr(reader._trials, "are_needed", lambda: False)
    monkeypatch.setattr(formats, "read", lambda path, time, **options: found)
    # What the reader gives counts, not the name.
    path = tmp_path / "a.vtpd"
    path.touch()
    (part,) = files.read_parts(path)
    assert part.n_cells == 8
    assert meaning.flags(part, "block") == {10: "inner shell", 4: "4"}
    assert vizlight.look(part).array == "block"
    del found["Element Blocks"][1]
    (part,) = files.read_parts(path)
    assert "block" not in part.cell_data


def test_points_that_float32_does_not_resolve_are_noted(tmp_path):
    plane = pv.Plane(center=(5e5, 5e6, 0), i_size=10, j_size=10, i_resolution=20, j_resolution=20)
    plane.clear_data()
    plane.points = np.asarray(plane.points, np.float32)
    plane.save(tmp_path / "a.vtp")
    read_warned(tmp_path / "a.vtp", "float32, which are .* apart .*: points may fall together")


def test_points_of_no_cell_that_are_far_from_all_cells_are_left_out(tmp_path):
    grid = pv.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid()
    grid["T"] = np.arange(27.0)
    more = pv.UnstructuredGrid(grid.cells, grid.celltypes, np.append(grid.points, [[9, 0, 0]], 0))
    more["T"] = np.arange(28.0)
    more.save(tmp_path / "a.vtu")
    mesh = read_warned(tmp_path / "a.vtu", "1 of its 28 points are in no cell and left out")
    assert mesh.bounds == grid.bounds
    np.testing.assert_array_equal(mesh["T"], grid["T"])
    # One among the cells stays.
    more.points[-1] = 1
    more.save(tmp_path / "b.vtu")
    assert vizlight.read(tmp_path / "b.vtu").n_points == 28


def test_cells_of_grdecl_share_their_points(tmp_path):
    pillars = "\n".join(f"{x} {y} 0 {x} {y} 9" for y in (0, 1) for x in (0, 1, 2))
    depths = "8*1\n8*3"
    text = f"SPECGRID\n2 1 1 1 F /\nCOORD\n{pillars} /\nZCORN\n{depths} /\nPERMX\n5 700 /\n"
    mesh = vizlight.read(saved(tmp_path / "a.grdecl", text))
    assert (mesh.n_cells, mesh.n_points) == (2, 12)
    # The face between the two cells is not one of the outer surface.
    assert mesh.extract_surface(algorithm="dataset_surface").n_cells == 10
    assert mesh.cell_data["PERMX"].tolist() == [5, 700]
