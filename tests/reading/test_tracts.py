"""Tractograms, and the colours of directions."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, refused, saved

import vizlight
from vizlight import files
from vizlight.mesh import georeference, meaning, polylines

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
        made.groups["right"] = np.array([1], np.uint32)
        trx.save(made, str(tmp_path / "b.trx"))
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
    # Groups that share no line are kinds.
    mesh = vizlight.read(tmp_path / "b.trx")
    assert mesh.cell_data["group"].tolist() == [1, 2, 1]
    assert meaning.flags(mesh, "group") == {0: "none", 1: "left", 2: "right"}


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
    refused(tract(name), rf"got '.*{name}' \((no points|Miss)")


@pytest.mark.parametrize(("name", "cut"), [("standard.trk", 5), ("standard.tck", 19)])
def test_a_cut_tractogram_is_refused(name, cut, tmp_path):
    path = tmp_path / name
    refused(saved(path, tract(name).read_bytes()[:-cut]), "file: expected a mesh")


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
    read_warned(saved(tmp_path / "a.trk", data + bytes(12)), "has 12 bytes more than it states")
    data[12:24] = bytes(12)
    refused(saved(tmp_path / "a.trk", data), "no point is finite, by the affine of its header")


def test_tracts_that_are_fewer_than_their_header_states(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    lines = nibabel.streamlines.Tractogram([np.eye(3, dtype="f4")], affine_to_rasmm=np.eye(4))
    nibabel.streamlines.save(lines, str(tmp_path / "a.tck"))
    data = (tmp_path / "a.tck").read_bytes()
    (tmp_path / "a.tck").write_bytes(data.replace(b"count: 0000000001", b"count: 0000000002"))
    with pytest.warns(UserWarning, match="gives 1 of the 2 streamlines that it states"):
        assert vizlight.read(tmp_path / "a.tck").n_lines == 1


def test_tracts_say_in_which_frame_they_are():
    pytest.importorskip("nibabel")
    mesh = vizlight.read(tract("standard.trk"))
    assert meaning.ways(mesh) == ("left, right", "back, front", "down, up")
    assert georeference.unit_of(mesh) == "millimetre"
    mesh.point_data.clear()
    mesh.cell_data.clear()
    bar = vizlight.look(mesh).drawing.keys[0]["cmap"].run()
    assert bar.annotations == {0.0: "left, right", 1.0: "back, front", 2.0: "down, up"}
    assert meaning.ways(pv.Line()) == ("x", "y", "z")
