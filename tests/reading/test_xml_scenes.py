"""Scenes of XML: faces at their places, with z up, in the unit of the file."""

import zipfile

import numpy as np
import pytest
from refusals import read_warned, refused, saved

import vizlight
from vizlight.mesh import meaning

COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array count="12">0 0 0  2 0 0  2 1 0  0 1 0</float_array>
<technique_common><accessor count="4" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
{faces}
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node>
<translate>10 0 0</translate><rotate>0 0 1 90</rotate>
<node><scale>1 3 1</scale><instance_geometry url="#g"/></node>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
INPUTS = """<input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#n" offset="1"/>"""
QUAD = f"<polylist>{INPUTS}<vcount>4</vcount><p>0 9 1 9 2 9 3 9</p></polylist>"
STRIP = "<tristrips><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 3 2</p></tristrips>"


@pytest.mark.parametrize(
    ("up", "corner"), [("Z_UP", (7, 2, 0)), ("Y_UP", (7, 0, 2)), ("X_UP", (-2, 0, 7))]
)
def test_faces_of_collada_are_where_their_nodes_put_them(up, corner, tmp_path):
    """The far corner (2, 1, 0) is scaled to (2, 3, 0), turned to (-3, 2, 0), and moved by 10."""
    path = tmp_path / "plate.dae"
    mesh = vizlight.read(saved(path, COLLADA.format(up=up, faces=QUAD)))
    assert (mesh.n_points, mesh.n_cells) == (4, 1)
    np.testing.assert_allclose(mesh.points[mesh.get_cell(0).point_ids[2]], corner, atol=1e-6)
    assert meaning.line(mesh) == "x, y, z in inch"


def test_the_triangles_of_a_strip_face_one_way(tmp_path):
    path = saved(tmp_path / "strip.dae", COLLADA.format(up="Z_UP", faces=STRIP))
    surface = vizlight.read(path).extract_surface(algorithm="dataset_surface")
    normals = surface.compute_normals(
        consistent_normals=False, point_normals=False, auto_orient_normals=False
    )
    np.testing.assert_allclose(normals["Normals"], [[0, 0, 1], [0, 0, 1]], atol=1e-6)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("9 3 9</p>", "9 7 9</p>", "a face has the point 7 of 4"),
        ("<vcount>4", "<vcount>5", "4 corners of faces that have 5"),
        ("#p", "#q", "it names '#q', which it has not"),
        ('count="4" stride', 'count="5" stride', "12 numbers for 5 points in 'p'"),
        ("<instance_geometry url='#g'/>".replace("'", '"'), "", "its scene places no faces"),
        ("</COLLADA>", "", "no whole XML"),
    ],
)
def test_a_scene_that_is_not_whole_is_refused(old, new, said, tmp_path):
    text = COLLADA.format(up="Z_UP", faces=QUAD)
    assert old in text
    refused(saved(tmp_path / "a.dae", text.replace(old, new)), said)


MODEL = """<model unit="{unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh>
<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>
</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
<object id="2" type="model"><components>
<component objectid="1" transform="0 2 0 -2 0 0 0 0 2 5 0 0"/></components></object></resources>
<build><item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 7"/>
<item objectid="{second}"/></build></model>"""
RELATIONS = """<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/a.model" Id="r"
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"""


def written(path, unit="millimeter", second="1"):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("_rels/.rels", RELATIONS)
        archive.writestr("3D/a.model", MODEL.format(unit=unit, second=second))
    return path


def test_objects_of_3mf_are_where_their_transforms_put_them(tmp_path):
    """Rows are multiplied from the left: (1, 0, 0) becomes (0, 2, 0), then (5, 2, 7)."""
    mesh = vizlight.read(written(tmp_path / "plate.3mf", "inch"))
    places = sorted(map(tuple, np.round(mesh.points, 6).tolist()))
    assert places == [(0, 0, 0), (0, 1, 0), (1, 0, 0), (3, 0, 7), (5, 0, 7), (5, 2, 7)]
    assert mesh.n_cells == 2
    assert meaning.line(mesh) == "x, y, z in inch"
    refused(written(tmp_path / "a.3mf", second="9"), r"it names .*'9'.*, which it has not")


def test_beams_of_3mf_that_are_left_out_are_counted(tmp_path, monkeypatch):
    beams = "<beamlattice><beams><beam v1='0' v2='1'/><beam v1='1' v2='2'/></beams></beamlattice>"
    monkeypatch.setitem(globals(), "MODEL", MODEL.replace("</mesh>", f"{beams}</mesh>"))
    read_warned(written(tmp_path / "a.3mf"), "the 2 beams of its lattices are left out")
