"""Files of Wavefront: colours, texture coordinates and normals of some points."""

import pytest
from refusals import saved

import vizlight
from vizlight.mesh import meaning

OBJ = b"# 12/31/2020\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n"


def test_colors_of_the_points_of_obj(tmp_path):
    """Also where points are repeated, as each corner has a normal of its own."""
    colored = OBJ.replace(b"v 0 0 0", b"v 0 0 0 1 0 0").replace(b"v 1 0 0", b"v 1 0 0 0 1 0.5")
    colored = colored.replace(b"v 0 1 0", b"v 0 1 0 0 0 1")
    more = b"vn 0 1 0\nf 2/1/2 1/1/2 3/1/2\n"
    for content, count in ((colored, 3), (colored + more, 6)):
        mesh = vizlight.read(saved(tmp_path / "a.obj", content))
        assert mesh.n_points == count
        expected = {(0, 0): [255, 0, 0], (1, 0): [0, 255, 128], (0, 1): [0, 0, 255]}
        for (x, y, _), color in zip(mesh.points.tolist(), mesh["color"].tolist(), strict=True):
            assert color == expected[x, y]


@pytest.mark.filterwarnings("default:.*left out")
def test_colors_of_some_points_of_obj(tmp_path):
    (tmp_path / "a.obj").write_bytes(OBJ.replace(b"v 0 0 0", b"v 0 0 0 1 0 0"))
    with pytest.warns(UserWarning, match="colours of some points alone, which are left out"):
        assert "color" not in vizlight.read(tmp_path / "a.obj").point_data


def test_weights_of_points_of_obj_are_no_colors(tmp_path):
    (tmp_path / "a.obj").write_bytes(OBJ.replace(b"v 0 0 0", b"v 0 0 0 1.0"))
    mesh = vizlight.read(tmp_path / "a.obj")
    assert "color" not in mesh.point_data
    assert mesh.points.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_materials_have_the_names_of_their_faces(tmp_path):
    faces = "f 1 2 3\nusemtl glass\nf 2 3 4\nusemtl a_leg\nf 1 3 4\nusemtl glass\nf 1 2 4\n"
    for head in ("", "mtllib a.mtl\nusemtl glass\n"):
        text = f"{head}v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n{faces}"
        (tmp_path / "a.obj").write_text(text)
        mesh = vizlight.read(tmp_path / "a.obj")
        names = meaning.flags(mesh, "material")
        first = "glass" if head else "NO MATERIAL"
        of_faces = [names[number] for number in mesh["material"].tolist()]
        assert of_faces == [first, "glass", "a leg", "glass"]


def test_texture_coordinates_that_are_missing(tmp_path):
    (tmp_path / "a.obj").write_bytes(OBJ.replace(b"3/1/1", b"3/9/1"))
    with pytest.warns(UserWarning, match="coordinates are left out: a face has number 9 of 1"):
        assert vizlight.read(tmp_path / "a.obj").n_cells == 1


@pytest.mark.filterwarnings("default:.*left out")
def test_normals_that_no_face_names(tmp_path):
    with pytest.warns(UserWarning, match=r"each point are left out: \['Normals'\]"):
        assert vizlight.read(saved(tmp_path / "a.obj", OBJ.replace(b"/1/1", b"//"))).n_cells == 1


def test_straight_curves_of_obj_are_lines_and_others_are_noted(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\ncstype bspline\ndeg 1\ncurv 0 1 1 2\nparm u 0 0 1 1\nend\n"
    assert vizlight.read(saved(tmp_path / "a.obj", text)).lines.tolist() == [2, 0, 1]
    with pytest.warns(UserWarning, match="free-form curves and surfaces .* are left out"):
        vizlight.read(saved(tmp_path / "a.obj", text.replace("deg 1", "deg 2")))
