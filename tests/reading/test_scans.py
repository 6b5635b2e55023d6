"""Scans of NRRD and MetaImage: places, axes of a body, segments."""

import gzip

import numpy as np
import pytest
import pyvista as pv
from refusals import saved

import vizlight
from vizlight.mesh import meaning

#: Values of which no two are alike, with more points along the first axis than components have.
VALUES = np.arange(12 * 5 * 4, dtype=np.int16).reshape(12, 5, 4)
#: Directions of storage in the space of a file, oblique ones too, and its origin.
WAYS = {
    "straight": np.diag([0.5, 2, 3]), "turned over": np.diag([0.5, -2, 3]),
    "in another order": np.array([[0, -2, 0], [0, 0, 3], [-0.5, 0, 0]]),
    "oblique": np.array([[0.4, -1.2, 0], [0.3, 1.6, 0], [0, 0, -3]]),
}  # fmt: skip
ENCODINGS = {"turned over": "gzip", "oblique": "ascii"}
ORIGIN = np.array([-90.0, 126, -72])


def nrrd(path, columns, space="left-posterior-superior", *, encoding="raw"):
    values = VALUES.tobytes(order="F")
    if encoding == "gzip":
        values = gzip.compress(values)
    elif encoding == "ascii":
        values = " ".join(map(str, VALUES.ravel(order="F"))).encode()
    ways = " ".join("({},{},{})".format(*column) for column in columns.T)
    fields = [
        "NRRD0004", "type: short", "dimension: 3", *([f"space: {space}"] if space else []),
        "sizes: 12 5 4", f"space directions: {ways}", "kinds: domain domain domain",
        "endian: little", f"encoding: {encoding}",
        "space origin: ({},{},{})".format(*ORIGIN),
    ]  # fmt: skip
    return vizlight.read(saved(path, "\n".join([*fields, "\n"]).encode() + values))


def meta(path, columns, *, orientation="RAI"):
    spacing = np.linalg.norm(columns, axis=0)
    fields = {
        "ObjectType": "Image", "NDims": 3, "BinaryData": True, "BinaryDataByteOrderMSB": False,
        "TransformMatrix": (columns / spacing).T.ravel(), "Offset": ORIGIN,
        "AnatomicalOrientation": orientation, "ElementSpacing": spacing, "DimSize": (12, 5, 4),
        "ElementType": "MET_SHORT", "ElementDataFile": "LOCAL",
    }  # fmt: skip
    lines = [f"{key} = {' '.join(map(str, np.atleast_1d(it)))}\n" for key, it in fields.items()]
    return vizlight.read(saved(path, "".join(lines).encode() + VALUES.tobytes(order="F")))


def assert_placed(mesh, affine):
    """Assert that each value is where the affine puts it, by the points of the mesh."""
    (name,) = mesh.point_data.keys()
    order = np.argsort(mesh[name])
    ijk = np.array([*np.ndindex(VALUES.shape)]).T
    places = (affine[:3, :3] @ ijk).T + affine[:3, 3]
    np.testing.assert_allclose(np.asarray(mesh.points)[order], places, atol=1e-4)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    ("space", "signs"),
    [
        ("left-posterior-superior", (-1, -1, 1)), ("right-anterior-superior", (1, 1, 1)),
        ("LAS", (-1, 1, 1)), ("3D-right-handed", None), ("", None),
    ],
)  # fmt: skip
def test_an_image_of_nrrd_is_where_its_header_says(way, space, signs, tmp_path):
    mesh = nrrd(tmp_path / "a.nrrd", WAYS[way], space, encoding=ENCODINGS.get(way, "raw"))
    affine = np.eye(4)
    affine[:3] = np.diag(signs or (1, 1, 1)) @ np.column_stack([WAYS[way], ORIGIN])
    assert_placed(mesh, affine)
    has_body = meaning.ways(mesh) == ("left, right", "back, front", "down, up")
    assert has_body == (signs is not None)
    if signs is not None:
        # A file of NIfTI with this affine is the same grid, with the same words.
        nibabel = pytest.importorskip("nibabel")
        nibabel.save(nibabel.Nifti1Image(VALUES, affine), tmp_path / "a.nii")
        other = vizlight.read(tmp_path / "a.nii")
        np.testing.assert_allclose(mesh.points, other.points, atol=1e-4)
        np.testing.assert_array_equal(mesh.point_data.values()[0], other["NIFTI"])
        words = [meaning.line(it).replace("directions", "affine") for it in (mesh, other)]
        assert words[0] == words[1]


@pytest.mark.parametrize("way", WAYS)
def test_an_image_of_meta_is_where_itk_puts_it(way, tmp_path):
    affine = np.eye(4)
    affine[:3] = np.column_stack([WAYS[way], ORIGIN])
    mesh = meta(tmp_path / "plain.mha", WAYS[way], orientation="???")
    assert_placed(mesh, affine)
    assert meaning.ways(mesh) == ("x", "y", "z")
    affine[:2] *= -1
    mesh = meta(tmp_path / "body.mha", WAYS[way])
    assert_placed(mesh, affine)
    assert meaning.ways(mesh) == ("left, right", "back, front", "down, up")


def test_a_header_without_places_leaves_what_the_reader_takes(tmp_path):
    path = tmp_path / "a.nrrd"
    for old, new in (
        (b"(0.5,0.0,0.0)", b"(0.5,nan,0.0)"), (b"(0.5,0.0,0.0)", b"(0.0,2.0,0.0)"),
    ):  # fmt: skip
        nrrd(path, WAYS["straight"])
        mesh = vizlight.read(saved(path, path.read_bytes().replace(old, new)))
        assert isinstance(mesh, pv.ImageData)
        assert meaning.ways(mesh) == ("x", "y", "z")


def test_segments_of_a_file_of_labels_have_their_names_and_colours(tmp_path):
    labels = np.zeros((4, 5, 12), np.uint8)
    labels[1:3, 1:4, 1:3], labels[1:3, 1:4, 3:5] = 2, 7
    fields = [
        "NRRD0004", "type: unsigned char", "dimension: 3", "sizes: 12 5 4", "encoding: raw",
        "Segment0_Name:=left lung", "Segment0_LabelValue:=2", "Segment0_Color:=1 0.5 0",
        "Segment1_Color:=0 0 1", "Segment1_LabelValue:=7", "Segment1_Name:=heart",
    ]  # fmt: skip
    path = tmp_path / "a.seg.nrrd"
    mesh = vizlight.read(saved(path, "\n".join([*fields, "\n"]).encode() + labels.tobytes()))
    assert meaning.flags(mesh, "segment") == {2: "left lung", 7: "heart"}
    assert meaning.flags(mesh, "segment", "colors") == {2: "#ff8000", 7: "#0000ff"}
    look = vizlight.look(path)
    assert look.drawing.keys[0]["cmap"].arguments[0] == {2: "left lung", 7: "heart"}
