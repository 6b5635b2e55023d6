"""Surfaces of brains, values over them, and tracts: kept, or told what is missing."""

import gzip
import struct
import zipfile

import numpy as np
import pytest
import pyvista as pv
import scipy
from refusals import read_warned, refused, saved

import vizlight
from vizlight import files
from vizlight.looks.recipes import drawing
from vizlight.mesh import meaning
from vizlight.reading.brains import mark_as_body

nibabel = pytest.importorskip("nibabel")

pytestmark = pytest.mark.usefixtures("without_trial")

BALL = pv.Sphere(theta_resolution=12, phi_resolution=10)
DEPTH = np.asarray(BALL.points[:, 2] ** 2, dtype=np.float32)


def gifti(path, *, surface):
    parts = [(DEPTH, "NIFTI_INTENT_SHAPE")]
    if surface:
        points, faces = (np.asarray(BALL.points, np.float32), BALL.regular_faces.astype(np.int32))
        parts = [(points, "NIFTI_INTENT_POINTSET"), (faces, "NIFTI_INTENT_TRIANGLE")]
    arrays = [nibabel.gifti.GiftiDataArray(rows, intent=code) for rows, code in parts]
    nibabel.save(nibabel.gifti.GiftiImage(darrays=arrays), path)


def freesurfer(path, *, surface):
    if surface:
        nibabel.freesurfer.write_geometry(path, BALL.points, BALL.regular_faces)
    else:
        nibabel.freesurfer.write_morph_data(path, DEPTH)


def mz3(path, *, surface):
    faces = np.asarray(BALL.regular_faces, "<i4")
    points = np.asarray(BALL.points, "<f4")
    kind, count = (3, len(faces)) if surface else (8, 0)
    head = b"MZ" + struct.pack("<HIII", kind, count, len(points), 4) + b"skip"
    body = faces.tobytes() + points.tobytes() if surface else DEPTH.tobytes()
    path.write_bytes(gzip.compress(head + body))


FORMATS = {
    "a.surf.gii": (gifti, "a.shape.gii"),
    "lh.pial": (freesurfer, "lh.curv"),
    "a.mz3": (mz3, "b.mz3"),
}


@pytest.mark.parametrize("name", FORMATS)
def test_a_surface_has_the_values_over_it(name, tmp_path):
    write, other = FORMATS[name]
    write(tmp_path / name, surface=True)
    write(tmp_path / other, surface=False)
    mesh = vizlight.read(tmp_path / name, overlay=tmp_path / other)
    np.testing.assert_allclose(mesh.points, BALL.points, atol=1e-6)
    np.testing.assert_array_equal(mesh.regular_faces, BALL.regular_faces)
    (key,) = mesh.point_data.keys()
    np.testing.assert_allclose(mesh[key], DEPTH)
    refused(tmp_path / other, "values over a surface, without one: read the surf")


@pytest.mark.parametrize("name", ["lh.sig.nii.gz", "lh.sig.mgz", "aparc.annot"])
def test_values_alone_say_how_they_are_given(name, tmp_path):
    path, values = tmp_path / name, np.arange(BALL.n_points, dtype=np.float32)
    if name.endswith(".annot"):
        colors = np.zeros((BALL.n_points, 5), np.int32)
        colors[:, 0] = colors[:, 4] = 1 + np.arange(BALL.n_points)  # 0 is no region
        names = [str(i) for i in range(BALL.n_points)]
        nibabel.freesurfer.write_annot(path, values.astype(np.int32), colors, names, False)
    else:
        kind = nibabel.Nifti1Image if ".nii" in name else nibabel.MGHImage
        # Their axis is the first of NIfTI, and may be any of MGH.
        shape = (-1, 1, 1) if name.endswith(".gz") else (1, 1, -1)
        nibabel.save(kind(values.reshape(shape), np.eye(4)), path)
    refused(path, "read the surface, and pass this file as overlay=")
    BALL.save(tmp_path / "lh.vtp")
    mesh = vizlight.read(tmp_path / "lh.vtp", overlay=path)
    (key,) = {*mesh.point_data} - {*BALL.point_data}
    np.testing.assert_array_equal(mesh[key], values)


@pytest.mark.parametrize("name", ["lh.parts.annot", "parts.label.gii"])
def test_regions_have_the_names_and_colours_of_their_file(name, tmp_path):
    path, kinds = tmp_path / name, np.arange(BALL.n_points) % 2
    colors = np.array([[25, 5, 25, 0, 1], [220, 20, 100, 0, 2]], np.int32)
    if name.endswith(".annot"):
        nibabel.freesurfer.write_annot(path, kinds, colors, ["none", "insula lobe"], fill_ctab=True)
    else:
        table = nibabel.gifti.GiftiLabelTable()
        for key, text in enumerate(("none", "insula lobe")):
            label = nibabel.gifti.GiftiLabel(key, *colors[key, :3] / 255, 1.0)
            label.label = text
            table.labels.append(label)
        values = nibabel.gifti.GiftiDataArray(kinds.astype(np.int32), "NIFTI_INTENT_LABEL")
        nibabel.save(nibabel.GiftiImage(labeltable=table, darrays=[values]), path)
    BALL.save(tmp_path / "lh.vtp")
    mesh = vizlight.read(tmp_path / "lh.vtp", overlay=path)
    key = name.removesuffix(".gii")
    assert meaning.flags(mesh, key) == {0: "none", 1: "insula lobe"}
    assert meaning.flags(mesh, key, "colors") == {0: "#190519", 1: "#dc1464"}
    look = vizlight.look(mesh, array=key, size=(90, 60))
    assert "colors={0: '#190519', 1: '#dc1464'}" in look.script().replace("0.0:", "0:").replace(
        "1.0:", "1:"
    )


def test_frames_other_than_that_of_the_points_are_noted(tmp_path):
    header = {"head": [2, 0, 20], "valid": "1", "filename": "a.mgz", "volume": [9, 9, 9]}
    header |= {"voxelsize": [1.0] * 3, "xras": [-1.0, 0, 0], "yras": [0, 0, -1.0]}
    header |= {"zras": [0, 1.0, 0], "cras": [5.0, -18, 12]}
    faces, path = BALL.regular_faces, tmp_path / "lh.white"
    nibabel.freesurfer.write_geometry(path, BALL.points, faces, volume_info=header)
    mesh = vizlight.read(path)
    assert "c_ras (5, -18, 12)" in meaning.line(mesh)
    np.testing.assert_allclose(mesh.points, BALL.points, atol=1e-6)
    gifti(tmp_path / "a.surf.gii", surface=True)
    image = nibabel.load(tmp_path / "a.surf.gii")
    assert meaning.line(vizlight.read(tmp_path / "a.surf.gii")) == ""
    image.darrays[0].coordsys = nibabel.gifti.GiftiCoordSystem(1, 3, 2 * np.eye(4))
    # Some write the rows of a transform one after the other.
    for turn in (2 * np.eye(4), 2 * np.eye(4).ravel()):
        image.darrays[0].coordsys.xform = turn
        nibabel.save(image, tmp_path / "b.surf.gii")
        assert "to Talairach, not applied" in meaning.line(vizlight.read(tmp_path / "b.surf.gii"))


def test_values_for_another_surface_are_an_error(tmp_path):
    mz3(tmp_path / "a.mz3", surface=False)
    pv.Cube().save(tmp_path / "b.ply")
    with pytest.raises(
        files.FileError,
        match=rf"overlay '.*a.mz3' has {len(DEPTH)} values for a surface of \d+ points",
    ):
        vizlight.read(tmp_path / "b.ply", overlay=[tmp_path / "a.mz3"])


def test_a_cut_file_is_refused(tmp_path):
    mz3(tmp_path / "a.mz3", surface=True)
    data = gzip.decompress((tmp_path / "a.mz3").read_bytes())
    for cut in (data[:-4], data[:40], data[:10], b"q" * 50):
        refused(saved(tmp_path / "a.mz3", cut), "file: expected a mesh")


def test_tracts_of_dsi_studio(tmp_path):
    lines = [np.cumsum(np.full((n, 3), (3, -2, 1)), axis=0) + 64 * n for n in (2, 5)]
    blob = b""
    for line in lines:
        steps = np.diff(line, axis=0).astype("i1")
        blob += struct.pack("<I3i", line.size, *line[0]) + steps.tobytes()
    parts = {"track": np.frombuffer(blob, np.uint8), "trans_to_mni": np.diag([-2.0, 2, 2, 1])}
    scipy.io.savemat(tmp_path / "a.mat", parts, format="4", oned_as="row")
    (tmp_path / "a.mat").rename(tmp_path / "a.tt")
    (tmp_path / "a.tt.gz").write_bytes(gzip.compress((tmp_path / "a.tt").read_bytes()))
    mesh = vizlight.read(tmp_path / "a.tt.gz")
    np.testing.assert_array_equal(vizlight.read(tmp_path / "a.tt").points, mesh.points)
    assert [mesh.get_cell(i).n_points for i in range(mesh.n_cells)] == [2, 5]
    np.testing.assert_allclose(mesh.points, np.concatenate(lines) / 32 * (-2, 2, 2))


@pytest.mark.filterwarnings("ignore:.*unclosed|Implicitly cleaning up:ResourceWarning")
def test_odd_data_beside_the_lines_are_named_and_the_rest_is_kept(tmp_path):
    trx = pytest.importorskip("trx.trx_file_memmap")
    made = trx.TrxFile.from_tractogram(
        nibabel.streamlines.Tractogram(
            [np.zeros((2, 3), np.float32), np.ones((3, 3), np.float32)], affine_to_rasmm=np.eye(4)
        ),
        reference=nibabel.Nifti1Image(np.zeros((20, 20, 20), np.uint8), np.eye(4)),
    )
    trx.save(made, str(tmp_path / "a.trx"))
    made.close()
    with zipfile.ZipFile(tmp_path / "a.trx", "a") as file:
        file.writestr("dpv/odd.float32", np.zeros(3, np.float32).tobytes())
    mesh = read_warned(tmp_path / "a.trx", "left out: .*odd")
    assert mesh.n_lines == 2


def nifti(path, values, affine):
    nibabel.save(nibabel.Nifti1Image(values, affine), path)
    return vizlight.read(path)


@pytest.mark.parametrize("signs", [(1, 1, 1), (-1, 1, 1), (-1, -1, 1), (1, -1, -1)])
@pytest.mark.parametrize("axes", [(0, 1, 2), (2, 0, 1)])
def test_a_volume_is_where_its_affine_says(signs, axes, tmp_path):
    values = np.random.default_rng(0).random((3, 4, 5)).astype(np.float32)
    affine = np.eye(4)
    affine[:3, :3] = (np.diag(signs) * [2.0, 3, 4])[list(axes)]
    affine[:3, 3] = [-90, -126, -72]
    mesh = nifti(tmp_path / "v.nii", values, affine)
    assert isinstance(mesh, pv.ImageData)
    assert min(mesh.spacing) > 0
    for ijk in np.ndindex(values.shape):
        place = (affine @ [*ijk, 1])[:3]
        assert mesh["NIFTI"][mesh.find_closest_point(place)] == values[ijk]
        # Pictures have the name of the file.
        assert meaning.of(mesh).arrays == {"NIFTI": {"long_name": "v"}}
        np.testing.assert_allclose(mesh.points[mesh.find_closest_point(place)], place, atol=1e-4)


def test_a_pair_of_a_header_and_an_image(tmp_path):
    nibabel.save(nibabel.Nifti1Pair(np.ones((4, 5, 6), np.float32), np.eye(4)), tmp_path / "a.img")
    for name in ("a.img", "a.hdr"):
        assert vizlight.read(tmp_path / name).dimensions == (4, 5, 6)


def test_an_oblique_and_a_sheared_volume(tmp_path):
    turn = scipy.spatial.transform.Rotation.from_euler("xyz", [5, -8, 12], degrees=True).as_matrix()
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = turn @ np.diag([1.0, 2, 3]), [5, 6, 7]
    values = np.arange(60, dtype=np.float32).reshape(3, 4, 5)
    for kind in (pv.ImageData, pv.StructuredGrid):
        mesh = nifti(tmp_path / "v.nii", values, affine)
        assert isinstance(mesh, kind)
        place = (affine @ [2, 1, 3, 1])[:3]
        np.testing.assert_allclose(mesh.points[np.argmax(mesh["NIFTI"] == values[2, 1, 3])], place,
                                   atol=1e-4)  # fmt: skip
        affine[:3, 0] += 0.3 * affine[:3, 1]


def test_steps_of_a_functional_image(tmp_path):
    values = np.zeros((3, 4, 5, 4), np.int16) + np.arange(4, dtype=np.int16)
    image = nibabel.Nifti1Image(values, np.eye(4))
    image.header.set_zooms((1, 1, 1, 2.5))
    image.header.set_xyzt_units("mm", "sec")
    nibabel.save(image, tmp_path / "f.nii.gz")
    mesh = vizlight.read(tmp_path / "f.nii.gz", time=5.0)
    assert mesh["NIFTI"].tolist() == [2] * 60
    assert mesh.field_data["TimeSteps"].tolist() == [0, 2.5, 5, 7.5]
    assert drawing.titled(mesh, "NIFTI").endswith("t = 5 s")


def test_three_volumes_of_directions_are_vectors_and_others_are_steps(tmp_path):
    ways = np.random.default_rng(0).normal(size=(3, 4, 5, 3)).astype(np.float32)
    ways /= np.linalg.norm(ways, axis=3, keepdims=True)
    ways[0] = 0
    nifti(tmp_path / "v1.nii", ways, np.diag([-2.0, 2, 2, 1]))
    read = vizlight.read(tmp_path / "v1.nii")["NIFTI"]
    np.testing.assert_array_equal(read.reshape(5, 4, 3, 3)[:, :, ::-1], ways.transpose(2, 1, 0, 3))
    nifti(tmp_path / "steps.nii", 3 * ways, np.eye(4))
    assert vizlight.read(tmp_path / "steps.nii")["NIFTI"].ndim == 1


def test_a_volume_of_freesurfer_and_colours(tmp_path):
    image = nibabel.MGHImage(
        np.arange(60, dtype=np.float32).reshape(3, 4, 5), np.diag([-1, 1, 1, 1])
    )
    nibabel.save(image, tmp_path / "a.mgz")
    mesh = vizlight.read(tmp_path / "a.mgz")
    assert mesh.bounds == (-2, 0, 0, 3, 0, 4)
    assert mesh.point_data.keys() == ["MGH"]
    kind = np.dtype([("R", "u1"), ("G", "u1"), ("B", "u1")])
    colors = np.array([(1, 2, 3)] * 8, kind).reshape(2, 2, 2)
    mesh = nifti(tmp_path / "c.nii", colors, np.eye(4))
    assert mesh["NIFTI"].tolist() == [[1, 2, 3]] * 8


@pytest.fixture
def of_models(tmp_path):
    """Return a function that writes values of both hemispheres, over all points but the first."""
    axes, count = nibabel.cifti2, BALL.n_points
    sides = (
        axes.BrainModelAxis.from_surface(range(1, count), count, f"CIFTI_STRUCTURE_CORTEX_{side}")
        for side in ("LEFT", "RIGHT")
    )
    models = sum(sides, next(sides))

    def write(name, first, rows):
        path = tmp_path / name
        rows = np.hstack([np.asarray(rows)[:, 1:], 7 - np.asarray(rows)[:, 1:]])
        nibabel.cifti2.Cifti2Image(rows, (first, models)).to_filename(path)
        return path

    return write


@pytest.fixture
def left(tmp_path):
    """Return the path of a surface that says that it is the left cortex."""
    gifti(tmp_path / "left.surf.gii", surface=True)
    image = nibabel.load(tmp_path / "left.surf.gii")
    image.darrays[0].meta["AnatomicalStructurePrimary"] = "CortexLeft"
    nibabel.save(image, tmp_path / "left.surf.gii")
    return tmp_path / "left.surf.gii"


def test_maps_of_brain_models_lie_over_their_surface(of_models, left, tmp_path):
    axes = nibabel.cifti2
    path = of_models("a.dscalar.nii", axes.ScalarAxis(["sulc", "curv"]), [DEPTH, 2 * DEPTH])
    mesh = vizlight.read(left, overlay=path)
    np.testing.assert_allclose(mesh["curv"][1:], 2 * DEPTH[1:], rtol=1e-6)
    assert np.isnan(mesh["sulc"][0])
    steps = of_models("a.dtseries.nii", axes.SeriesAxis(0, 1, 2), [DEPTH, 3 * DEPTH])
    with pytest.warns(UserWarning, match="the last of its 2 steps is taken"):
        mesh = vizlight.read(left, overlay=steps)
    np.testing.assert_allclose(mesh["a.dtseries.nii"][1:], 3 * DEPTH[1:], rtol=1e-6)
    regions = {0: ("???", (0, 0, 0, 0)), 3: ("V1", (1, 0, 0, 1))}
    labels = of_models("a.dlabel.nii", axes.LabelAxis(["areas"], regions), [np.full(len(DEPTH), 3)])
    mesh = vizlight.read(left, overlay=labels)
    assert mesh["areas"].tolist() == [0] + [3] * (len(DEPTH) - 1)
    assert meaning.of(mesh).arrays["areas"]
    # A surface that is neither hemisphere is not guessed at.
    gifti(tmp_path / "b.surf.gii", surface=True)
    with pytest.raises(files.FileError, match=r"CORTEX_LEFT of \d+.*surface of \d+ points, cortex"):
        vizlight.read(tmp_path / "b.surf.gii", overlay=path)


def test_values_of_brain_models_without_places_say_what_to_become(of_models):
    path = of_models("a.dscalar.nii", nibabel.cifti2.ScalarAxis(["sulc"]), [DEPTH])
    refused(path, "CIFTI.*read the surface of one.*overlay=")


def test_a_slab_of_a_scan_is_a_sheet_of_slices_unless_its_shape_is_asked_for():
    slab = pv.ImageData(dimensions=(40, 40, 12))
    slab["T"] = np.exp(-((slab.points - (20, 20, 6)) ** 2).sum(axis=1) / 40)
    mark_as_body(slab, "affine", np.eye(4))
    assert vizlight.look(slab).summary.startswith("slices of T")
    assert vizlight.look(slab, "shape").summary.startswith("isosurface T")


def test_a_slice_of_a_scan_is_gray_and_no_map(tmp_path):
    rows = np.add.outer(np.arange(30.0), np.arange(20.0))[..., np.newaxis]
    nibabel.save(nibabel.Nifti1Image(rows.astype(np.float32), np.eye(4)), tmp_path / "a.nii")
    look = vizlight.look(tmp_path / "a.nii", size=(90, 60))
    assert look.shown == "sheet"
    # Its brightest hundredth is white.
    assert "gray" in look.drawing.keys[0]["cmap"].arguments
    assert "frame" not in look.script()
    assert "isolines" not in look.script()


def test_triangles_in_text_of_a_brain(tmp_path):
    path = tmp_path / "cortex.tri"
    path.write_text("- 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 2 0 0 0 1\n- 1 1 1\n0 1 2\n")
    mesh = vizlight.read(path)
    assert (mesh.area, mesh.n_points) == (1, 3)
    refused(saved(path, path.read_text()[:-3]), "cannot reshape")
