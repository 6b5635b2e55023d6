"""glTF files with the light that does not depend on the eye as colours of the points."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from vizlight import _check, writing
from vizlight._types import Array, Given, Indices, Keywords, Raw
from vizlight._version import __version__
from vizlight.draw.keywords import LIGHT
from vizlight.draw.live import lifted
from vizlight.draw.sources import LEFT_OUT, fixed_colors, lit_apart, sources_in_scene, tinted
from vizlight.filters.relight import Source
from vizlight.filters.tint import ColorMap, color_table, map_colors, values_of, values_of_blocks
from vizlight.mesh import blocks
from vizlight.mesh.normals import split_values
from vizlight.scene import View
from vizlight.scene.presets import AnyScene
from vizlight.vtk.arrays import is_of_cells
from vizlight.vtk.cells import has_faces

__all__ = ["save_gltf"]

#: Component types of glTF by NumPy's, and targets of buffers.
_KINDS = {"<f4": 5126, "<u2": 5123, "<u4": 5125}
_VERTICES, _INDICES = 34962, 34963
#: Quaternion that turns z, which is up in PyVista, to y, which is up in glTF.
_UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]


def save_gltf(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    path: str | Path,
    *,
    scene: AnyScene | None = None,
    scalars: str | None = None,
    cmap: ColorMap = None,
    clim: Sequence[float] | float | None = None,
    **options: Given,
) -> Path:
    """Write a glTF file (.glb) with the colours of a lit mesh, as any viewer shows them.

    The colours of the points hold ambient and diffuse light. The highlight and the depth cue depend
    on the eye, which the file does not know, and are left out; ``asset.extras`` of the file says
    so. :func:`vizlight.live_html` writes light that follows the eye.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh, which is not changed; of a volume its surface is written. Each block is a node.
    path : path
        Path of the file, which ends in .glb. An existing file is replaced.
    scene : Scene or str, optional
        Lights and material. Default: the record of a lit mesh. The view counts only for parts that
        need one, such as a headlight, which is then fixed, with a warning.
    scalars : str, optional
        Name of the array that gives the colours; each cell has one colour where the values are
        the cells'. Default: the material's, or the array of :func:`vizlight.tint` for a mesh that
        it returned.
    cmap, clim
        Colour map and its ends, as for :func:`vizlight.tint`.
    **options
        Options of :func:`vizlight.illuminate`, except ``name`` and ``components``.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, as for :func:`vizlight.illuminate`.
    FileError
        If the file cannot be written.

    Warns
    -----
    UserWarning
        If a part of the light is fixed as the view of the scene sees it.

    Notes
    -----
    ``COLOR_0`` with ``KHR_materials_unlit``: colours are linear by the standard, so that the
    colours of a picture of PyVista are decoded from sRGB, to 16 bits. Positions are float32 from
    the centre of the mesh, which is the translation of the node.
    """
    path = writing.check_output(path, (".glb",))
    for name in options.keys() - LIGHT:
        raise TypeError(_check.message("options", "an option of vizlight.illuminate", repr(name)))
    if scalars is not None:
        _check.text("scalars", scalars, expected="the name of an array")
    parts = [sources_in_scene(part, scene, options) for part in lit_apart(mesh, scene, options)]
    sources = [source for of_part, _ in parts for source in of_part]
    scenes = [used for of_part, used in parts for _ in of_part]
    names = [path.lstrip("/") for _, path in blocks.named_blocks(mesh)]
    file, fixed = _File(), set()
    drawn = [_drawn(source.mesh, scalars) for source in sources]
    colors = _colors(sources, drawn, scalars, cmap, clim)
    for source, used, name, (surface, ids), color in zip(
        sources, scenes, names, drawn, colors, strict=True
    ):
        if not source.mesh.n_points:
            continue
        n = int(source.inputs.points.shape[1])
        here = lifted(used, n)
        if here.view is None:
            here = here.replace(view=View.isometric(n))
        lit, seen = fixed_colors(source, here, color, ids)
        file.add(name or "mesh", surface, lit)
        fixed |= {seen} - {""}
    if not file.nodes:
        raise _check.value_error("mesh", "a mesh with points", "none")
    said = f"; {' and '.join(sorted(fixed))} as from the scene's view" if fixed else ""
    data = file.content(f"vizlight {__version__}", LEFT_OUT + said)
    written = writing.replace_file(path, lambda draft: Path(draft).write_bytes(data))
    if fixed:
        _check.warn(f"{path.name}: {LEFT_OUT}{said}")
    return written


def _drawn(mesh: pv.DataSet, scalars: str | None) -> tuple[pv.PolyData, Indices]:
    """Return the drawn surface of a mesh, and the point of the mesh of each of its points.

    Points are split where cells of different values meet.
    """
    surface, ids = blocks.outer_surface(mesh)
    if scalars is None or not is_of_cells(surface, scalars) or not has_faces(surface):
        return surface, ids
    split, origin = split_values(surface, scalars)
    return split, ids[origin]


def _colors(
    sources: Sequence[Source],
    drawn: Sequence[tuple[pv.PolyData, Indices]],
    scalars: str | None,
    cmap: ColorMap,
    clim: Sequence[float] | float | None,
) -> list[NDArray[np.uint8] | None]:
    """Return for each source the colours of data, None for the colour of the material."""
    named: list[tuple[str | None, Keywords]] = [(scalars, {})] * len(sources)
    values: list[Raw | None] = []
    if scalars is not None:
        values += values_of_blocks([surface for surface, _ in drawn], scalars)
    else:
        named = [tinted(source.mesh) for source in sources]
        values += [
            None if name is None else values_of(surface, name, options.get("component"))
            for (name, options), (surface, _) in zip(named, drawn, strict=True)
        ]
    rows = [value for value in values if value is not None]
    table = color_table(rows, cmap=cmap, clim=clim)
    return [
        None if value is None else map_colors(options.get("cmap", table), value)
        for (_, options), value in zip(named, values, strict=True)
    ]


class _File:
    """Nodes of a binary glTF 2.0 file, and its buffer."""

    def __init__(self) -> None:
        self.nodes: list[dict[str, object]] = []
        self.meshes: list[dict[str, object]] = []
        self.accessors: list[dict[str, object]] = []
        self.views: list[dict[str, object]] = []
        self.buffer = bytearray()
        self.clear = False

    def add(self, name: str, surface: pv.PolyData, shown: NDArray[np.uint8]) -> None:
        """Add a mesh with the colours of its points."""
        # glTF has no polygons of more than three corners.
        flat = surface.triangulate(pass_verts=True, pass_lines=True)
        points = np.asarray(surface.points, dtype=np.float64)
        good = np.all(np.abs(points) < 1e38, axis=1)
        drawn = points[good] if np.any(good) else np.zeros((1, 3))
        centre = (drawn.min(axis=0) + drawn.max(axis=0)) / 2
        # Viewers sort what is blended, so blending is asked for only where something is
        # transparent.
        self.clear |= bool(np.any(shown[:, 3] < 255))
        # glTF knows no number that is not finite in float32; no cell with one is drawn.
        rows = np.where(good[:, np.newaxis], points - centre, 0.0).astype("<f4")
        # The standard asks for the bounds of positions.
        ends = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        attributes = {
            "POSITION": self.put(rows, "<f4", "VEC3", _VERTICES, **ends),
            "COLOR_0": self.put(_linear(shown), "<u2", "VEC4", _VERTICES, normalized=True),
        }
        primitives: list[dict[str, object]] = []
        # Modes of glTF for points, lines and triangles: after the filter all cells of a kind are of
        # one size.
        for mode, cells, size in ((0, flat.verts, 1), (1, flat.lines, 2), (4, flat.faces, 3)):
            corners = np.asarray(cells).reshape(-1, size + 1)[:, 1:]
            corners = corners[np.all(good[corners], axis=1)]
            if len(corners):
                index = self.put(corners.reshape(-1, 1), "<u4", "SCALAR", _INDICES)
                primitives.append(
                    {"attributes": attributes, "indices": index, "material": 0, "mode": mode}
                )
        if not primitives:
            return
        self.nodes.append({"name": name, "mesh": len(self.meshes), "translation": centre.tolist()})
        self.meshes.append({"name": name, "primitives": primitives})

    def put(self, rows: Raw, kind: str, shape: str, target: int, **extra: object) -> int:
        """Append an array to the buffer and return the index of its accessor."""
        # Rows are multiples of 4 bytes, so that each array begins where the standard wants it to.
        data = np.ascontiguousarray(rows, kind)
        self.views.append(
            {
                "buffer": 0, "byteOffset": len(self.buffer), "byteLength": data.nbytes,
                "target": target,
            }
        )  # fmt: skip
        self.buffer += data.tobytes()
        accessor: dict[str, object] = {
            "bufferView": len(self.views) - 1, "componentType": _KINDS[kind], "count": len(data),
            "type": shape,
        }  # fmt: skip
        self.accessors.append(accessor | extra)
        return len(self.accessors) - 1

    def content(self, generator: str, said: str) -> bytes:
        """Return the file."""
        root = {
            "name": "z up", "rotation": _UPRIGHT, "children": list(range(1, len(self.nodes) + 1))
        }  # fmt: skip
        # Viewers leave out the back of what is not double-sided; one that does not know the
        # extension shows a dull material in its place, which comes nearest.
        material: dict[str, object] = {
            "doubleSided": True,
            "extensions": {"KHR_materials_unlit": {}},
            "pbrMetallicRoughness": {"roughnessFactor": 1.0, "metallicFactor": 0.0},
        }
        if self.clear:
            material["alphaMode"] = "BLEND"
        text = json.dumps(
            {
                "asset": {"version": "2.0", "generator": generator, "extras": {"light": said}},
                "extensionsUsed": ["KHR_materials_unlit"],
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [root, *self.nodes],
                "meshes": self.meshes,
                "materials": [material],
                "accessors": self.accessors,
                "bufferViews": self.views,
                "buffers": [{"byteLength": len(self.buffer)}],
            },
            allow_nan=False,
        ).encode()
        # Chunks of a binary glTF file are multiples of 4 bytes: text is filled up with spaces, data
        # with zeros.
        text += b" " * (-len(text) % 4)
        data = bytes(self.buffer) + b"\0" * (-len(self.buffer) % 4)
        # The header of the file, and the header and the content of each of two chunks.
        size = 12 + 8 + len(text) + 8 + len(data)
        return b"".join(
            [
                struct.pack("<4sII", b"glTF", 2, size),
                struct.pack("<I4s", len(text), b"JSON"), text,
                struct.pack("<I4s", len(data), b"BIN\0"), data,
            ]
        )  # fmt: skip


def _linear(colors: NDArray[np.uint8]) -> Array:
    """Return colours as glTF has them: linear, opacity as it is, in 16 bits."""
    shown = colors / 255.0
    rgb = shown[:, :3]
    # The curve of sRGB (IEC 61966-2-1), back to linear light.
    decoded = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    linear: Array = np.rint(65535 * np.column_stack([decoded, shown[:, 3]]))
    return linear
