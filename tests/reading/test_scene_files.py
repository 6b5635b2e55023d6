"""Shapes of scenes stand where the transforms of their file put them."""

import itertools

import numpy as np
import pytest
from refusals import read_warned, refused, saved

import vizlight
from vizlight.reading import scene_files

pytestmark = pytest.mark.usefixtures("without_trial")

TETRAHEDRON = """Shape { geometry IndexedFaceSet {
coord Coordinate { point [0 0 0, 1 0 0, 0 1 0, 0 0 1] }
coordIndex [0 2 1 -1, 0 1 3 -1, 1 2 3 -1, 0 3 2 -1] } }"""
NORMALS, COLORS = "normal Normal { vector [0 0 1, 0 1 0] }", "color Color { color [1 0 0, 0 1 0] }"


def with_rows(text):
    """Return the tetrahedron with more fields."""
    return TETRAHEDRON.replace("coordIndex", f"{text} coordIndex")


EMPTY = (
    """Shape { geometry IndexedLineSet { coord Coordinate { point [] } coordIndex [0 1 -1] } }"""
)


def written(folder, *parts):
    return saved(folder / "a.wrl", "\n".join(["#VRML V2.0 utf8", *parts]) + "\n")


def test_transforms_inside_of_transforms(tmp_path):
    inner = f"Transform {{ translation 1 0 0 children [ {TETRAHEDRON} ] }}"
    outer = "translation 10 0 0 scale 2 3 4 rotation 0 0 1 1.5707963"
    path = written(tmp_path, f"Transform {{ {outer} children [ {inner} ] }}", TETRAHEDRON)
    moved, still = scene_files.read(path)
    # x becomes 2 (x + 1), y 3 y and z 4 z; then x turns to y and y to -x.
    np.testing.assert_allclose(moved.bounds, (7, 10, 2, 4, 0, 4), atol=1e-6)
    np.testing.assert_allclose(still.bounds, (0, 1, 0, 1, 0, 1))
    # y is up in the file, z in what is read.
    np.testing.assert_allclose(vizlight.read(path).bounds, (0, 10, -4, 0, 0, 4), atol=1e-6)


@pytest.mark.filterwarnings("default:.*left out")
def test_a_shape_without_points_does_not_refuse_the_others(tmp_path):
    path = written(tmp_path, TETRAHEDRON, EMPTY)
    assert read_warned(path, "1 of 2 shapes are left out: no points").n_cells == 4


def test_a_scene_without_points_is_refused(tmp_path):
    refused(written(tmp_path, EMPTY), "no points")


def test_colors_of_points(tmp_path):
    colors = "color Color { color [1 0 0, 0 1 0, 0 0 1, 1 1 1] } } }"
    (shape,) = scene_files.read(written(tmp_path, TETRAHEDRON.removesuffix("} }") + colors))
    expected = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]
    np.testing.assert_array_equal(shape["color"], expected)


def turn(axis, angle):
    """Return the matrix of a turn, by Rodrigues."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_center_and_orientation_of_the_scale(tmp_path):
    fields = "center 1 2 3 rotation 1 1 0 0.7 scale -2 3 4 scaleOrientation 0 1 1 0.4"
    (shape,) = scene_files.read(
        written(tmp_path, f"Transform {{ {fields} translation 5 6 7 children [ {TETRAHEDRON} ] }}")
    )
    lean = turn(np.array([0, 1, 1]), 0.4)
    matrix = turn(np.array([1, 1, 0]), 0.7) @ lean @ np.diag([-2, 3, 4]) @ lean.T
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    center = np.array([1, 2, 3])
    expected = (corners - center) @ matrix.T + center + (5, 6, 7)
    np.testing.assert_allclose(shape.points, expected, atol=1e-3)


#: Scenes, each with the ends of its shapes along x.
OTHERS = {
    "used again": (
        f"""DEF A Transform {{ translation 1 0 0 children {TETRAHEDRON} }}
Transform {{ translation 5 0 0 children [ USE A ] }} ROUTE A.b TO A.c""",
        (1, 7),
    ),
    "group": (
        f"""Group {{ children [ {TETRAHEDRON} Anchor {{ url "a" children Transform {{
translation 6 0 0 children [ {TETRAHEDRON} ] }} description "# {{" }} ] bboxSize 1 1 1 }}""",
        (0, 7),
    ),
    "levels": (
        f"LOD {{ range [ 1 ] level [ {TETRAHEDRON} Shape {{ geometry Box {{ }} }} ] }}",
        (0, 1),
    ),
    "choice": (
        f"Switch {{ whichChoice 1 choice [ Shape {{ geometry Box {{ }} }} {TETRAHEDRON} ] }}",
        (0, 1),
    ),
    "size": ("Shape { geometry Box { } }", (-1, 1)),
    "commas": (TETRAHEDRON.replace("1 0 0", "1,# {\n0 ,0"), (0, 1)),
    "base 16": (
        TETRAHEDRON.replace(
            "{", "{ appearance Appearance { texture PixelTexture { image 1 2 3 0xFF 0x00ff00 } }", 1
        ),
        (0, 1),
    ),
    "prototypes": (
        f"""PROTO A [ field SFVec3f at 5 0 0 eventIn SFBool b ] {{ Transform {{
translation IS at set_b IS b children [ {TETRAHEDRON} ] }} Script {{ }} }}
PROTO B [ field MFNode kids [ ] ] {{ Group {{ children IS kids }} }}
A {{ at 1 0 0 }} B {{ kids [ A {{ }} A {{ at 2 0 0 }} ] }}""",
        (1, 6),
    ),
}


@pytest.mark.parametrize(("text", "ends"), OTHERS.values(), ids=OTHERS)
def test_nodes_that_vtk_reads_wrong(text, ends, tmp_path):
    # VTK leaves memory as it was, which is right now and then.
    for _ in range(3):
        shapes = scene_files.read(written(tmp_path, text))
        assert shapes.bounds[:2] == pytest.approx(ends, abs=1e-6)


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("text", "words"),
    {
        "PROTO A [ ] { Group { children [ A { } ] } } A { }": "Unknown node type A",
        "PROTO A [ ] { Shape {": "its brackets do not close",
        "PROTO A [ ] { Group { } } "
        + "".join(
            f"PROTO {b} [ ] {{ Group {{ children [ {f'{a} {{ }} ' * 400} ] }} }} "
            for a, b in itertools.pairwise("ABCD")
        )
        + "D { }": "its nodes are used too often",
        TETRAHEDRON.replace("point [", "point "): "its brackets do not close",
        TETRAHEDRON.replace("coordIndex [", "coordIndex {"): "its brackets do not close",
        TETRAHEDRON[:-1]: "its brackets do not close",
        TETRAHEDRON.replace("point", "DEF point"): "Coordinate has no point",
        TETRAHEDRON.replace("1 0 0", "1 0"): "Coordinate has no point of three numbers a row",
        TETRAHEDRON.replace("1 2 3", "1 x 3"): "'x' stands after '0 2 1 -1",
        TETRAHEDRON.replace("coordI", "normalI"): "a normalIndex and no coordIndex",
        TETRAHEDRON.replace("0 2 1", "0 2 4"): "the number 4 of 4 rows of Coordinate",
        TETRAHEDRON.replace("0 2 1", "0 2 -2"): "the number -2 of 4 rows of Coordinate",
        with_rows(f"{NORMALS} normalIndex [0 1 2 -1]"): "the number 2 of 2 rows of Normal",
        with_rows(NORMALS): "the number 3 of 2 rows of Normal",
        with_rows(f"{NORMALS} normalPerVertex FALSE"): "the number 3 of 2 rows of Normal",
        with_rows(f"{COLORS} colorPerVertex FALSE colorIndex [0 7]"): "the number 7 of 2 rows of C",
        with_rows("texCoord TextureCoordinate { point [0 0] }"): "3 of 1 rows of TextureC",
        f"Transform {{ scale 1 2 children [ {TETRAHEDRON} ] }}": "scale has 2 numbers",
    }.items(),
)
def test_scenes_that_end_the_process_in_vtk_are_refused(text, words, tmp_path):
    refused(written(tmp_path, text), words)


def test_nodes_of_other_files_are_left_out_with_a_word(tmp_path):
    path = written(tmp_path, f'Inline {{ url "b.wrl" }} {TETRAHEDRON}')
    assert read_warned(path, "nodes of other files are left out: Inline").n_cells == 4


def test_external_prototypes_are_left_out_with_a_word(tmp_path):
    declared = 'EXTERNPROTO Hill [ exposedField MFVec2f scale field SFNode a ] [ "urn:a" "b.wrl" ]'
    used = "Transform { children [ Hill { scale [1 1] } Shape { geometry Hill { } } ] }"
    path = written(tmp_path, declared, used, TETRAHEDRON)
    with pytest.warns(UserWarning, match="left out") as said:
        assert vizlight.read(path).n_cells == 4
    words = " ".join(str(warning.message) for warning in said)
    assert "nodes of other files are left out: EXTERNPROTO" in words
    assert "1 of 2 shapes are left out: no points" in words


def test_texts_with_quotation_marks_and_scales_of_textures(tmp_path):
    info = r'WorldInfo { info [ "by \"a\" # { " ] }'
    texture = "appearance Appearance { textureTransform TextureTransform { scale 2 2 } } geometry"
    path = written(tmp_path, info, TETRAHEDRON.replace("geometry", texture))
    assert vizlight.read(path).n_cells == 4


def test_what_vtk_stops_at_is_refused(tmp_path):
    path = written(tmp_path, TETRAHEDRON, "Viewpoint { position 1 }", TETRAHEDRON)
    refused(path, "VTK reads 1 of its 2 shapes")


def test_the_first_version_is_refused(tmp_path):
    path = tmp_path / "a.wrl"
    with pytest.raises(vizlight.files.FileError, match="VRML 1, which VTK does not read: save it"):
        vizlight.read(saved(path, "#VRML V1.0 ascii\nSeparator { }\n"))
