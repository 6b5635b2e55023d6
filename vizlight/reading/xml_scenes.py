"""Files of scenes of XML: COLLADA (.dae) and 3MF, each object placed by its transforms."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeVar
from xml.etree import ElementTree as ET

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.mesh import meaning

Key = TypeVar("Key")

#: Axes to the right, away from the eye and up, by the axis of COLLADA that is up.
_UP = {
    "X_UP": [[0, -1, 0], [0, 0, -1], [1, 0, 0]],
    "Y_UP": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    "Z_UP": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
}
#: Elements of COLLADA with faces.
_FACES = ("triangles", "polylist", "polygons", "tristrips", "trifans")
#: End of the type of the relation of a 3MF file to its model, and the transform that moves nothing.
_MODEL, _UNMOVED = "/3dmodel", "1 0 0 0 1 0 0 0 1 0 0 0"


def read_collada(path: Path) -> pv.MultiBlock:
    """Return the faces of the geometries of a COLLADA file, placed by its scene, with z up."""
    root = _root(path.read_bytes())
    named = {f"#{node.get('id')}": node for node in root.iter() if node.get("id")}
    scene = next(root.iter("instance_visual_scene"), None)
    tops = root.iter("visual_scene") if scene is None else [_named(named, scene.get("url"))]
    up: Array = np.array(_UP[root.findtext("asset/up_axis", "Y_UP").strip()], dtype=np.float64)
    shapes = [
        _moved(shape, up @ matrix[:3])
        for top in tops
        for geometry, matrix in _instances(top, named, np.eye(4))
        for shape in _geometry(geometry, named)
    ]
    if count := sum(node.tag in ("lines", "linestrips") for node in root.iter()):
        _check.warn(f"file: '{path}': {count} parts of lines are left out")
    unit = root.find("asset/unit")
    of_unit = {"name": "meter"} if unit is None else unit.attrib
    return _scene(shapes, of_unit.get("name") or f"units of {of_unit.get('meter', 1)} m")


def _instances(
    node: ET.Element, named: Mapping[str, ET.Element], matrix: Array
) -> Iterator[tuple[ET.Element, Array]]:
    """Yield the geometries below a node of COLLADA, each with its matrix."""
    for child in node:
        if child.tag in ("matrix", "translate", "rotate", "scale"):
            matrix = matrix @ _transform(child)
        elif child.tag == "node":
            yield from _instances(child, named, matrix)
        elif child.tag == "instance_node":
            yield from _instances(_named(named, child.get("url")), named, matrix)
        elif child.tag == "instance_geometry":
            yield _named(named, child.get("url")), matrix
        elif child.tag == "instance_controller":
            # A skin has the shape in which it was bound to its skeleton.
            for skin in _named(named, child.get("url")).iter("skin"):
                bound = skin.find("bind_shape_matrix")
                own = np.eye(4) if bound is None else _numbers(bound).reshape(4, 4)
                yield _named(named, skin.get("source")), matrix @ own


def _transform(node: ET.Element) -> Array:
    """Return the matrix of a transform of COLLADA."""
    numbers, matrix = _numbers(node), np.eye(4)
    if node.tag == "matrix":
        return numbers.reshape(4, 4)
    if node.tag == "translate":
        matrix[:3, 3] = numbers
    elif node.tag == "scale":
        matrix[:3, :3] = np.diag(numbers)
    else:
        *axis, angle = numbers.tolist()
        matrix = np.asarray(pv.Transform().rotate_vector(axis, angle).matrix)
    return matrix


def _geometry(geometry: ET.Element, named: Mapping[str, ET.Element]) -> Iterator[pv.PolyData]:
    """Yield the faces of the parts of a geometry of COLLADA."""
    for part in geometry.iterfind("mesh/*"):
        inputs = part.findall("input")
        of_points = [one for one in inputs if one.get("semantic") == "VERTEX"]
        runs = [_numbers(p).astype(np.intp) for p in part.iter("p")]
        if part.tag not in _FACES or not of_points or not runs:
            continue
        width = 1 + max(int(one.get("offset", 0)) for one in inputs)
        at = int(of_points[0].get("offset", 0))
        counts, corners = _corners(part, [run.reshape(-1, width)[:, at] for run in runs])
        vertices = _named(named, of_points[0].get("source"))
        sources = [one.get("source") for one in vertices if one.get("semantic") == "POSITION"]
        yield _surface(_points(_named(named, sources[0])), counts, corners)


def _corners(part: ET.Element, runs: Sequence[Indices]) -> tuple[Indices, Indices]:
    """Return the number of corners of each face of a part of COLLADA, and all corners."""
    corners = np.concatenate(runs)
    if part.tag == "polygons":
        return np.array([len(run) for run in runs]), corners
    if part.tag == "polylist":
        counts = part.find("vcount")
        return np.empty(0, np.intp) if counts is None else _numbers(counts).astype(np.intp), corners
    if part.tag == "tristrips":
        strips = [np.column_stack([run[:-2], run[1:-1], run[2:]]) for run in runs]
        for strip in strips:
            # Every second triangle is turned.
            strip[1::2] = strip[1::2, [1, 0, 2]]
        corners = np.concatenate(strips).ravel()
    elif part.tag == "trifans":
        fans = [np.column_stack([0 * run[2:] + run[0], run[1:-1], run[2:]]) for run in runs]
        corners = np.concatenate(fans).ravel()
    return np.full(len(corners) // 3, 3), corners


def _points(source: ET.Element) -> Array:
    """Return the points of a source of COLLADA."""
    array, access = source.find("float_array"), source.find("technique_common/accessor")
    if array is None or access is None:
        raise ValueError(f"no numbers in the source {source.get('id')!r}")
    count, stride = int(access.get("count", 0)), int(access.get("stride", 1))
    rows = _numbers(array)[int(access.get("offset", 0)) :][: count * stride]
    if len(rows) < count * stride or stride < 3:
        raise ValueError(f"{len(rows)} numbers for {count} points in {source.get('id')!r}")
    return rows.reshape(count, stride)[:, :3]


def read_3mf(path: Path) -> pv.MultiBlock:
    """Return the objects that a 3MF file builds, each at its place."""
    with zipfile.ZipFile(path) as archive:
        relations = _root(archive.read("_rels/.rels"))
        targets = [one.get("Target") for one in relations if one.get("Type", "").endswith(_MODEL)]
        models = {
            f"/{name}": _root(archive.read(name))
            for name in archive.namelist()
            if name.endswith(".model")
        }
    if beams := sum(len(model.findall(".//beam")) for model in models.values()):
        _check.warn(f"file: '{path}': the {beams} beams of its lattices are left out")
    main = _named(models, next(iter(targets), None))
    objects = {
        (name, one.get("id")): one for name, model in models.items() for one in model.iter("object")
    }
    shapes = [
        shape
        for item in main.iterfind("build/item")
        for shape in _built(item, f"{targets[0]}", objects, np.eye(4))
    ]
    return _scene(shapes, main.get("unit", "millimeter"))


def _built(
    item: ET.Element,
    name: str,
    objects: Mapping[tuple[str, str | None], ET.Element],
    matrix: Array,
) -> Iterator[pv.PolyData]:
    """Yield the meshes of an item or a component of 3MF in the model of a name."""
    own: Array = np.array(item.get("transform", _UNMOVED).split(), dtype=np.float64)
    # Points are rows, which it multiplies from the right.
    matrix = matrix @ np.vstack([own.reshape(4, 3).T, [0, 0, 0, 1]])
    # Parts of a production have files of their own.
    name = item.get("path", name)
    found = _named(objects, (name, item.get("objectid")))
    for component in found.iterfind("components/component"):
        yield from _built(component, name, objects, matrix)
    triangles = found.findall("mesh/triangles/triangle")
    if triangles:
        vertices = found.iterfind("mesh/vertices/vertex")
        points = np.array([[one.get(axis) for axis in "xyz"] for one in vertices], np.float64)
        rows = [[one.get(corner) for corner in ("v1", "v2", "v3")] for one in triangles]
        shape = _surface(points, np.full(len(rows), 3), np.array(rows, np.intp).ravel())
        yield _moved(shape, matrix[:3])


def _root(text: bytes) -> ET.Element:
    """Return the root of a text of XML, its names without those of their spaces."""
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise ValueError(f"no whole XML: {error}") from None
    for node in root.iter():
        node.tag = node.tag.rpartition("}")[2]
        for key in [key for key in node.attrib if key.startswith("{")]:
            node.attrib[key.rpartition("}")[2]] = node.attrib.pop(key)
    return root


def _named(table: Mapping[Key, ET.Element], key: Key | None) -> ET.Element:
    """Return the element that a file names, if it has it."""
    if key is None or key not in table:
        raise ValueError(f"it names {key!r}, which it has not")
    return table[key]


def _numbers(node: ET.Element) -> Array:
    """Return the numbers in the text of an element."""
    return np.array((node.text or "").split(), dtype=np.float64)


def _surface(points: Array, counts: Indices, corners: Indices) -> pv.PolyData:
    """Return faces by the numbers of their corners, with the points that they have."""
    if counts.sum() != len(corners):
        raise ValueError(f"{len(corners)} corners of faces that have {counts.sum()}")
    used, ids = np.unique(corners, return_inverse=True)
    if len(used) and not 0 <= used[0] <= used[-1] < len(points):
        raise ValueError(f"a face has the point {used[-1]} of {len(points)}")
    return pv.PolyData(points[used], faces=np.insert(ids, np.cumsum(counts) - counts, counts))


def _moved(shape: pv.PolyData, matrix: Array) -> pv.PolyData:
    """Return a shape at the place that a matrix of three rows gives it."""
    shape.points = np.asarray(shape.points, np.float64) @ matrix[:, :3].T + matrix[:, 3]
    return shape


def _scene(shapes: Sequence[pv.PolyData], unit: str) -> pv.MultiBlock:
    """Return the shapes of a scene, with the unit of their lengths."""
    if not shapes:
        raise ValueError("its scene places no faces")
    scene = pv.MultiBlock(list(shapes))
    return meaning.attach(scene, meaning.Meaning(axes=[f"x in {unit}", "y", "z"]))
