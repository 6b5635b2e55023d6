"""Files of glTF whose parts do not fit are refused before a reader opens them."""

import base64
import json
import struct

import numpy as np
import pytest
from refusals import refused, saved

import vizlight

GLTF = {
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
         "max": [1, 1, 0]}
    ],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,"
                 + base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()}],
}  # fmt: skip


def gltf(key="asset", **changes):
    """Return glTF whose first part of a list has some other values."""
    part = GLTF[key]
    part = [part[0] | changes] if isinstance(part, list) else part
    return json.dumps(GLTF | {key: part}).encode()


WRONG = {
    "infinity": (gltf("accessors").replace(b"[0, 0, 0]", b"[0, 0, 1e999]"), "1e999"),
    "fraction": (gltf("buffers", byteLength=0.5), "its byteLength is 0.5"),
    "bytes": (gltf("buffers", byteLength=100), "of 100 bytes of a buffer"),
    "file": (gltf("buffers", uri="b.bin"), "'b.bin', which is missing"),
    "view": (gltf("bufferViews", byteLength=37), "ends at 37 of 36 bytes of its buffer"),
    "target": (gltf("bufferViews", target=34961), "a view has the target 34961"),
    "array": (gltf("accessors", count=4), "ends at 48 of 36 bytes of its view"),
    "reference": (gltf("accessors", bufferView=10**9), "number 1000000000 of 1 buffer"),
    "cycle": (gltf("nodes", children=[0]), "nodes are in a cycle"),
    "a list": (b"[1, 2]", "its header cannot be read"),
}


def test_a_whole_file_is_read(tmp_path):
    assert vizlight.read(saved(tmp_path / "a.gltf", gltf())).n_points == 3


def test_shapes_of_an_animation_are_no_vectors(tmp_path):
    shape = {"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}]}
    (tmp_path / "a.gltf").write_bytes(gltf("meshes", primitives=[shape], weights=[0.0]))
    with pytest.warns(UserWarning, match="its animation are left out: target0_position"):
        assert not vizlight.read(tmp_path / "a.gltf").point_data


@pytest.mark.parametrize("kind", WRONG)
def test_parts_that_do_not_fit_are_refused(kind, tmp_path):
    content, words = WRONG[kind]
    refused(saved(tmp_path / "a.gltf", content), words)


def test_colours_of_gltf_are_bytes(tmp_path):
    from vizlight.reading.gltf import _as_bytes

    linear = np.array([[0.0, 0.2159, 1.0, 0.5], [0.0031, 2.0, -1.0, 1.0]], np.float32)
    assert _as_bytes(linear).tolist() == [[0, 128, 255, 128], [10, 255, 0, 255]]
