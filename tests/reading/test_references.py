"""Files that a file takes from elsewhere than its own folder."""

import numpy as np
import pytest
import pyvista as pv
from refusals import saved

import vizlight
from vizlight.reading import references

VTM = (
    '<?xml version="1.0"?><VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>'
    '<DataSet index="0" name="a" file="{}"/></vtkMultiBlockDataSet></VTKFile>'
)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.vtm", VTM),
        ("a.pvd", "<Collection><DataSet timestep=\"0\" file='{}'/></Collection>"),
        ("a.pvtu", '<Piece Source="{}"/>'),
        ("a.gltf", '{{"buffers": [{{"uri": "{}"}}, {{"uri": "data:x;base64,../AAAA"}}]}}'),
        ("a.xmf", "<DataItem>{}:/data0</DataItem>"),
        ("a.inp", "*NODE\n1, 0, 0, 0\n*Include, Input={}\n"),
        ("a.case", "GEOMETRY\nmodel: 1 {}\n"),
        ("a.vtp.series", '{{"files": [{{"name": "{}"}}]}}'),
        ("a.mhd", "DimSize = 1 1\nElementDataFile = {}\n"),
        ("a.nhdr", "NRRD0004\ndata file: {}\n"),
    ],
)
def test_names_that_leave_the_folder(name, text, tmp_path):
    path = tmp_path / name
    for own in ("b.vtu", "sub/b.vtu", "sub/../b.vtu", str(tmp_path / "b.vtu")):
        path.write_text(text.format(own))
        assert references.outside(path) == []
    for other in ("../b.vtu", "sub/../../b.vtu", "/none/b.vtu"):
        path.write_text(text.format(other))
        assert references.outside(path) == [other]


def test_reading_says_so(tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    pv.PolyData(np.eye(3), [3, 0, 1, 2]).save(tmp_path / "b.vtp")
    with pytest.warns(UserWarning, match=r"from outside of its folder: \.\./b\.vtp"):
        assert vizlight.read(saved(folder / "a.vtm", VTM.format("../b.vtp"))).n_points == 3
