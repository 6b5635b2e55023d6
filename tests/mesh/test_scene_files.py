"""Shapes of scenes stand where the transforms of their file put them."""

import numpy as np
import pytest

import vizlight
from vizlight.mesh import scene_files

TETRAHEDRON = """Shape { geometry IndexedFaceSet {
coord Coordinate { point [0 0 0, 1 0 0, 0 1 0, 0 0 1] }
coordIndex [0 2 1 -1, 0 1 3 -1, 1 2 3 -1, 0 3 2 -1] } }"""
EMPTY = (
    """Shape { geometry IndexedLineSet { coord Coordinate { point [] } coordIndex [0 1 -1] } }"""
)


def written(folder, *parts):
    path = folder / "a.wrl"
    path.write_text("\n".join(["#VRML V2.0 utf8", *parts]) + "\n")
    return path


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
    with pytest.warns(UserWarning, match="1 of 2 shapes are left out: no points"):
        assert vizlight.read(path).n_cells == 4


def test_a_scene_without_points_is_refused(tmp_path):
    with pytest.raises(vizlight.files.FileError, match="no points"):
        vizlight.read(written(tmp_path, EMPTY))


def test_colors_of_points(tmp_path):
    colors = "color Color { color [1 0 0, 0 1 0, 0 0 1, 1 1 1] } } }"
    (shape,) = scene_files.read(written(tmp_path, TETRAHEDRON.removesuffix("} }") + colors))
    expected = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]
    np.testing.assert_array_equal(shape["color"], expected)
