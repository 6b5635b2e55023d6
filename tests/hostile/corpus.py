"""Hostile files, each with the exit code of ``vizlight light`` and a part of its line."""

from __future__ import annotations

import json
import struct
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv
from hostile import runner


class Case(NamedTuple):
    """A file: its content, the exit code, and words on standard error (0 may have none)."""

    content: bytes
    code: int
    words: str


def text(*lines):
    """Return lines of text as bytes."""
    return "\n".join(lines).encode() + b"\n"


def legacy(points, *cells, kind="POLYDATA"):
    """Return a legacy VTK file of text with some points and cells."""
    rows = [" ".join(str(x) for x in point) for point in points]
    head = ("# vtk DataFile Version 3.0", "hostile", "ASCII", f"DATASET {kind}")
    return text(*head, f"POINTS {len(points)} double", *rows, *cells)


#: What rasterio says of elevation models without a place, where it is there.
NO_DEM = "not recognized as being in a supported file format" * bool(find_spec("rasterio"))


def dem(columns, there):
    """Return an elevation model with a part of the columns of its header."""
    head = f"{'':852}{1:6d}{columns:6d}".ljust(1024)
    return (head + f"{1:6d}{1:6d}{3:6d}{1:6d}".ljust(1024) * there).encode()


def image(*, extent="0 2 0 2 0 2", spacing="1 1 1", data=""):
    """Return an XML image."""
    return text(
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian">',
        f'<ImageData WholeExtent="{extent}" Origin="0 0 0" Spacing="{spacing}">',
        f'<Piece Extent="{extent}"><PointData>{data}</PointData></Piece></ImageData></VTKFile>',
    )


def structured(extent):
    """Return an XML grid of eight points, of the given extent as a whole."""
    points = " ".join(f"{x} {y} {z}" for z in (0, 1) for y in (0, 1) for x in (0, 1))
    return text(
        '<VTKFile type="StructuredGrid" version="1.0" byte_order="LittleEndian">',
        f'<StructuredGrid WholeExtent="{extent}"><Piece Extent="0 1 0 1 0 1"><Points>',
        f'<DataArray type="Float32" NumberOfComponents="3" format="ascii">{points}</DataArray>',
        "</Points></Piece></StructuredGrid></VTKFile>",
    )


def ply(*, points=3, faces=1, rows=("0 0 0", "1 0 0", "0 1 0", "3 0 1 2")):
    """Return a PLY file of text that announces some points and faces."""
    return text(
        "ply", "format ascii 1.0", f"element vertex {points}",
        *(f"property float {axis}" for axis in "xyz"), f"element face {faces}",
        "property list uchar int vertex_indices", "end_header", *rows,
    )  # fmt: skip


def stl(count, triangles):
    """Return a binary STL file that announces a number of triangles and holds another."""
    one = np.array([0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0], "<f4").tobytes() + b"\0\0"
    return b"\0" * 80 + struct.pack("<I", count) + one * triangles


def gltf(**changes):
    """Return a glTF file whose parts contradict each other."""
    whole = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAA"}],
    }
    return json.dumps(whole | changes).encode()


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACE = ("POLYGONS 1 5", "4 0 1 2 3")
NOT_A_MESH = "file: expected a mesh that PyVista reads, got"
DAMAGED = "file: expected a file that is not damaged, got"
PAST = "expected cells of the points 0 to 3, got"
#: VTK before 9.7 does not read "nan" in text.
NAN_IN_TEXT = "bounds: expected finite" if pv.vtk_version_info >= (9, 7) else DAMAGED

CASES = {
    # nothing in it
    "empty.vtp": Case(b"", 2, NOT_A_MESH),
    "empty.vtk": Case(b"", 2, NOT_A_MESH),
    "empty.ply": Case(b"", 2, NOT_A_MESH),
    "empty.stl": Case(b"", 2, NOT_A_MESH),
    "empty.obj": Case(b"", 2, NOT_A_MESH),
    "zeros.vtu": Case(b"\0" * 512, 2, NOT_A_MESH),
    "zeros.glb": Case(b"\0" * 512, 2, "its header cannot be read"),
    "zeros.vtkhdf": Case(b"\0" * 512, 2, "neither netCDF nor HDF5"),
    "zeros.trk": Case(b"\0" * 1000, 2, NOT_A_MESH),
    "words.nothing": Case(b"what is this", 2, NOT_A_MESH),
    "other.stl": Case(b"\x89PNG\r\n\x1a\n" + bytes(range(256)), 2, "file: expected"),
    "no-points.vtk": Case(legacy([]), 2, "(no points"),
    # counts that do not hold
    "cut.vtk": Case(legacy(SQUARE, *FACE)[:-6], 2, "file: expected"),
    "past.vtk": Case(legacy(SQUARE, "POLYGONS 1 5", "4 0 1 2 900"), 2, PAST),
    "negative.vtk": Case(legacy(SQUARE, "POLYGONS 1 5", "4 0 1 2 -7"), 2, PAST),
    "past-lines.vtk": Case(legacy(SQUARE, "LINES 1 4", "3 0 1 99999999"), 2, PAST),
    "past-cells.vtk": Case(
        legacy(SQUARE, "CELLS 1 5", "4 0 1 2 77", "CELL_TYPES 1", "9", kind="UNSTRUCTURED_GRID"),
        2,
        PAST,
    ),
    "points.ply": Case(ply(points=900), 2, "4 of 900 rows of 'vertex' are there"),
    "points-most.ply": Case(ply(points=2**63), 2, "file: expected"),
    "faces.ply": Case(ply(faces=2**31), 2, "1 of 2147483648 rows of 'face'"),
    "past.ply": Case(ply(rows=("0 0 0", "1 0 0", "0 1 0", "3 0 1 9999")), 2, "file: expected"),
    "count.stl": Case(stl(2**32 - 1, 1), 2, DAMAGED),
    "narrow.dem": Case(
        dem(5, 5), 2, NO_DEM or "5' columns in the header, VTK reads 100 or more"
    ),
    "no-axis.vtk": Case(
        text("# vtk DataFile Version 3.0", "cut", "ASCII", "DATASET RECTILINEAR_GRID",
             "DIMENSIONS 2 2 2", "X_COORDINATES 2 double", "0 1"),
        2, "No y coordinates",
    ),
    "layers.vtk": Case(
        text("# vtk DataFile Version 3.0", "few", "ASCII", "DATASET STRUCTURED_GRID",
             "DIMENSIONS 2 300 1", "POINTS 4 double", *(" ".join(map(str, p)) for p in SQUARE)),
        2, "expected 600 points by the extent",
    ),
    "order.vtk": Case(
        text("# vtk DataFile Version 5.1", "order", "ASCII", "DATASET POLYDATA", "POINTS 4 double",
             *(" ".join(map(str, p)) for p in SQUARE), "POLYGONS 3 6", "OFFSETS vtktypeint64",
             "0 9 6", "CONNECTIVITY vtktypeint64", "0 1 2 0 2 3"),
        2, "cells that do not follow one another among 6 corners",
    ),
    "field.vtk": Case(
        text("# vtk DataFile Version 3.0", "cut", "ASCII", "DATASET POLYDATA", "FIELD F")[:-1],
        2, "a field has no number of arrays",
    ),
    "version.vtk": Case(
        text("# vtk DataFile Version g.1", "words", "ASCII", "DATASET NONE"),
        2, "Cannot read file version",
    ),
    "colours.vtk": Case(
        legacy(SQUARE, *FACE, "POINT_DATA 4", "COLOR_SCALARS c 3", "0 0 0 1 1 1"),
        2, "Error reading ascii data",
    ),
    "texture.vtk": Case(
        legacy(SQUARE, *FACE, "point_data 4", "texture_coordinates t 2 float", "0 0 1 1"),
        2, "Error reading ascii data",
    ),
    "nan-cut.vtk": Case(
        legacy(SQUARE, *FACE, "POINT_DATA 4", "SCALARS f float", "LOOKUP_TABLE a", "1 2", "nan"),
        2, "Error reading ascii data",
    ),
    "title.vtk": Case(
        text("# vtk DataFile Version 3.0", "from an ASCII file", "BINARY", "DATASET POLYDATA",
             "POINTS 4 double")
        + np.array(SQUARE, ">f8").tobytes()
        + b"\nPOLYGONS 1 5\n" + np.array([4, 0, 1, 2, 3], ">i4").tobytes() + b"\n",
        0, "",
    ),
    "whole.vts": Case(structured("0 1 0 1 0 1"), 0, ""),
    "extent.vts": Case(structured("0 1 2147483647 1 0 1"), 2, "its pieces cover [0, 1,"),
    "cut.dem": Case(dem(100, 60), 2, NO_DEM or "its reader was ended by SIGSEGV"),
    "cut.stl": Case(stl(2, 1), 2, DAMAGED),
    "no-end.stl": Case(
        text("solid a" + " " * 80, "facet normal 0 0 1", "outer loop", "vertex 0 0 0",
             "vertex 1 0 0", "vertex 0 1 0", "endloop", "endfacet"),
        2, "its end is missing",
    ),
    "past.obj": Case(text("v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 99"), 2, "file: expected"),
    "extent.vti": Case(image(extent="0 99999 0 99999 0 99999"), 2, ""),
    "backward.vti": Case(image(extent="5 0 5 0 5 0"), 2, "file: expected"),
    "data.vti": Case(
        image(data='<DataArray type="Float32" Name="a" format="ascii">1 2</DataArray>'),
        2, "file: expected",
    ),
    "short.gltf": Case(gltf(), 2, "bytes of a buffer"),
    "past.gltf": Case(gltf(bufferViews=[{"buffer": 7, "byteLength": 36}]), 2, "of a buffer"),
    "cut.su2": Case(
        text("NDIME= 2", "NPOIN= 4", "0 0 0", "1 0 1", "1 1 2"), 2, NOT_A_MESH
    ),
    "cut.off": Case(text("OFF", "900 1 0", "0 0 0"), 2, NOT_A_MESH),
    # values that no surface has
    "nan.vtk": Case(legacy([("nan", "nan", "nan")] * 4, *FACE), 2, NAN_IN_TEXT),
    "größe.vtk": Case(legacy(SQUARE, *FACE), 0, ""),
    "one-place.vtk": Case(legacy([(1, 1, 1)] * 4, *FACE), 0, "could not be lit"),
    "tiny.vtk": Case(legacy([[x * 1e-300 for x in p] for p in SQUARE], *FACE), 2, "a size from"),
    "huge.vtk": Case(legacy([[x * 1e300 for x in p] for p in SQUARE], *FACE), 2, "points beyond"),
    "points.vtk": Case(legacy(SQUARE), 2, "without faces"),
    "two-corners.vtk": Case(legacy(SQUARE, "POLYGONS 1 3", "2 0 1"), 0, "could not be lit"),
    "same-corner.vtk": Case(legacy(SQUARE, "POLYGONS 1 4", "3 0 0 0"), 0, "could not be lit"),
    # XML that is none
    "not-closed.vtu": Case(b'<VTKFile type="UnstructuredGrid"><UnstructuredGrid>', 2, DAMAGED),
    "entities.vtp": Case(
        b'<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><VTKFile>&b;</VTKFile>',
        2, NOT_A_MESH,
    ),
    "latin.vtp": Case(b'<VTKFile type="PolyData">\xff\xfe\xe9</VTKFile>', 2, NOT_A_MESH),
}  # fmt: skip


def faults(folder, **how):
    """Light all files, in a way that ``runner.run`` takes, and return what is wrong, line by line.

    In the C locale VTK has no words for a name with other letters, which one line says.
    """
    plain = how.get("environment", {}).get("LC_ALL") == "C"
    commands = []
    for name, case in CASES.items():
        (folder / name).write_bytes(case.content)
        out = folder / "made" / name / "lit.vtk"
        out.parent.mkdir(parents=True)
        commands.append(["light", str(folder / name), "-o", str(out)])
    wrong = []
    for (name, case), words, run in zip(
        CASES.items(), commands, runner.run(commands, **how), strict=True
    ):
        if plain and not name.isascii():
            case = case._replace(code=2, words="PYTHONUTF8=1")
        found = runner.fault(run, folder / name, case.content, Path(words[-1]))
        if found or run.code != case.code or case.words not in run.err:
            wrong.append(f"{name}: {run.code} {run.err} {found}")
    return wrong
