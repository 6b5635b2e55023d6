"""Sources of light, by a record or by options, and their colours without an eye."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._questions import QUESTIONS
from vizlight._types import FeatureAngle, Indices, Keywords
from vizlight.draw.live import lifted, on_screen
from vizlight.filters import lighting, relight
from vizlight.filters.key import question_of
from vizlight.filters.relight import Source
from vizlight.filters.sky import SKY, with_sky
from vizlight.filters.tint import RGB, light_on_colors, unlit_colors
from vizlight.mesh import blocks, normals, records
from vizlight.mesh.blocks import cell_array
from vizlight.mesh.normals import split_where_computed
from vizlight.model import kernels
from vizlight.scene import Light, Scene, View
from vizlight.scene.presets import AnyScene, optional_scene
from vizlight.shading.display import Bytes, on_colors
from vizlight.shading.options import LightOptions
from vizlight.vtk.arrays import GridPoints
from vizlight.vtk.cells import has_marks
from vizlight.vtk.corners import MANY_SHARP, SHARP
from vizlight.vtk.normals import Sided, are_of_faces, computed_normals, creases, piece_numbers
from vizlight.vtk.parts import uses_normals

#: What is left out, for a page, a file and its reader.
LEFT_OUT = "ambient and diffuse light only: the highlight and the depth cue depend on the eye"


def sources_of(
    mesh: pv.DataSet | pv.MultiBlock,
    scene: Scene | None,
    options: Keywords,
    angle: FeatureAngle = "auto",
) -> tuple[list[Source], Scene | None]:
    """Return the sources of light of a mesh: by its record, or by options.

    Without a record surfaces are split at edges of an angle, unless ``feature_angle`` is given.
    """
    if not options and relight.is_lit(mesh):
        return relight.from_record(mesh, scene)
    keywords: Keywords = {"feature_angle": angle}
    light = LightOptions(**(keywords | options))
    _refuse_without_tangents(mesh, scene, light)
    normals.compute_ahead(blocks.all_blocks(mesh))
    mesh = blocks.like(mesh, (with_sharp_edges(block, light) for block in blocks.all_blocks(mesh)))
    if light.feature_angle is not None and light.occlusion == SKY:
        mesh = blocks.like(mesh, iter(with_sky([*blocks.all_blocks(mesh)], SKY, finer=True)))
    # The points are split by now, and must not be once more.
    light = dataclasses.replace(light, feature_angle=None)
    spaces = {
        np.shape(block.point_data[light.positions])[-1]
        for block in blocks.all_blocks(mesh)
        if light.positions is not None and light.positions in block.point_data
    }
    n = max(spaces, default=3)
    # Sources are checked before there is a frame.
    ahead = (0.0, 0.0, 1.0)
    seen = lifted(Scene(lights=Light(direction=ahead), view=View(direction=ahead)), n)
    provisional = seen if scene is None else lifted(scene, n)
    if provisional.view is None and provisional.n in (None, n):
        # Which side of an open surface is lit is then the camera's to say.
        provisional = provisional.replace(view=seen.view)
    return relight.from_options(mesh, provisional, light), scene


def _has_sides(block: pv.DataSet) -> bool:
    return bool(block.n_cells) and block.max_cell_dimensionality > 1


def _refuse_without_tangents(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene | None, light: LightOptions
) -> None:
    """Raise ValueError if a surface has no tangents, and its light tells their direction."""
    if scene is None or light.tangents is not None or light.positions is not None:
        return
    question = question_of(scene)
    if QUESTIONS[question].of_tangents and any(map(_has_sides, blocks.all_blocks(mesh))):
        expected = f"vectors, whose {question} this scene shows"
        remedy = "pass tangents=NAME, or scene='shape' for the shape of the surface"
        raise _check.value_error("tangents", expected, None, remedy)


def sources_in_scene(
    mesh: pv.DataSet | pv.MultiBlock, scene: AnyScene | None, options: Keywords
) -> tuple[list[Source], Scene]:
    """Return the sources of light and their scene for a file, which has no lights of a plotter."""
    blocks.check(mesh)
    sources, used = sources_of(mesh, optional_scene(scene), options)
    if used is None:
        remedy = "pass a Scene, or a mesh that a filter has lit"
        raise _check.value_error("scene", "a scene or the record of one", None, remedy)
    return sources, used


def lit_apart(
    mesh: pv.DataSet | pv.MultiBlock, scene: object, options: Keywords
) -> list[pv.DataSet | pv.MultiBlock]:
    """Return the blocks of a mesh that were lit in scenes of their own, else the mesh alone."""
    if scene is None and not options and isinstance(mesh, pv.MultiBlock) and relight.is_lit(mesh):
        lit = [block for block in mesh if block is not None]
        first, *others = (records.provenance(block)["scene"] for block in lit)
        if any(other != first for other in others):
            return lit
    return [mesh]


def with_sharp_edges(mesh: pv.DataSet, light: LightOptions) -> pv.DataSet:
    """Return a surface with points split at sharp edges, the mesh itself if it has none.

    The light has ``feature_angle``, the least angle of an edge that is sharp.
    """
    # An array of tangents has the rows of the mesh as it is, which split points would not fit.
    if not (mesh.n_points and mesh.n_cells and isinstance(light.tangents, str | None)):
        return mesh
    if light.positions is not None or light.normals is not None or not uses_normals(mesh, light):
        return mesh
    bare, carried = mesh, mesh.point_data.active_normals_name
    if carried is not None:
        bare = mesh.copy(deep=False)
        bare.point_data.active_normals_name = None
    if carried is None and light.feature_angle == "auto" and (sides := box(mesh)) is not None:
        return sides
    surface = bare
    if isinstance(bare, pv.UnstructuredGrid) or bare.GetMaxSpatialDimension() == 3:
        surface = blocks.outer_surface(bare)[0]
    if not isinstance(surface, pv.PolyData):
        return mesh
    is_auto = light.feature_angle == "auto"
    if carried and is_auto:
        vectors = np.asarray(surface.point_data[carried])
        # Those of another number of components are refused where the mesh is lit.
        if vectors.shape[1:] != (3,) or are_of_faces(surface, vectors):
            return mesh
        if not creases(surface, has_normals=True):
            return mesh
    split = split_where_computed(surface, light.feature_angle)
    if split is surface:
        return mesh
    # Known as long as the mesh is there, though the split points are made for each picture.
    computed_normals(split, owner=surface)
    averaged = carried is None or not is_auto or _fit_no_face(split, carried)
    return split if averaged else mesh


def _fit_no_face(split: pv.PolyData, name: str) -> bool:
    """Return whether normals from before a split fit neither side of many edges."""
    # Of either sign below, as a normal may be of the other side of the same face.
    old, new = kernels.unit_rows(split.point_data[name]), computed_normals(split).vectors
    cosine, has_face = np.abs(np.einsum("ij,ij->i", old, new)), np.any(new, axis=1)
    apart = has_face & (cosine < np.cos(np.radians(SHARP / 2)))
    # Faces without area come from points that were rounded; their edges are no creases.
    return bool(np.mean(apart) > MANY_SHARP >= np.mean(~has_face))


def tinted(mesh: pv.DataSet, *, warn: bool = True) -> tuple[str | None, Keywords]:
    """Return the array and the colours of a mesh that tint returned.

    With ``warn`` a warning is given where the mesh has no such array.
    """
    record = records.read(mesh, RGB) or {}
    if record.get("filter") != "tint":
        return None, {}
    options = record["options"]
    name = options["scalars"]
    if name not in (*mesh.point_data, *mesh.cell_data):
        if warn:
            _check.warn(
                f"the light is shown without colours: they are those of {name}, which the mesh has "
                "no array of; attach it, and pass its name to vizlight.tint"
            )
        return None, {}
    return name, {"cmap": unlit_colors(mesh), "component": options["component"]}


def box(mesh: pv.DataSet) -> pv.PolyData | None:
    """Return the six sides of a grid as a surface with its normals and arrays, None for others.

    Points on the edges of the box are stored once for each side. An image or a rectilinear grid of
    two or more points along each axis has sides.
    """
    if not isinstance(mesh, pv.ImageData | pv.RectilinearGrid) or min(mesh.dimensions) < 2:
        return None
    # What is hidden may leave a grid other sides than its box has.
    if has_marks(mesh):
        return None
    size = np.array(mesh.dimensions)
    source, middle = GridPoints(mesh), np.asarray(mesh.center)
    origin, cells, quads, vectors, count = [], [], [], [], 0
    for axis, end in itertools.product(range(3), (0, -1)):
        ids_of_side, of_cells = _side(size, axis, end), _side(size - 1, axis, end)
        a, b, c = source.at(ids_of_side[:2, :2].ravel()[:3])
        normal = np.cross(c - a, b - a)
        # Outward on either end of an axis: corners are turned round together with their normal.
        if normal @ (a - middle) < 0:
            ids_of_side, of_cells, normal = ids_of_side[::-1], of_cells[::-1], -normal
        at = count + np.arange(ids_of_side.size).reshape(ids_of_side.shape)
        corners = [at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]]
        quads.append(np.stack(corners, axis=-1).reshape(-1, 4))
        cells.append(of_cells.ravel())
        origin.append(ids_of_side.ravel())
        vectors.append(np.tile(np.float32(normal / np.linalg.norm(normal)), (ids_of_side.size, 1)))
        count += ids_of_side.size
    ids = np.concatenate(origin)
    surface = pv.PolyData()
    surface.SetPoints(pv.vtk_points(np.asarray(source.at(ids), dtype=float)))
    corners_of = np.concatenate(quads)
    surface.SetPolys(cell_array(corners_of.ravel(), np.arange(0, corners_of.size + 1, 4)))
    for key, array in mesh.point_data.items():
        records.attach_rows(surface, key, np.asarray(array)[ids])
    for key, array in mesh.cell_data.items():
        surface.cell_data[key] = np.asarray(array)[np.concatenate(cells)]
    records.carry_active(mesh, surface)
    lean = np.zeros(count, dtype=np.float32)
    normals.keep(surface, Sided(np.concatenate(vectors), lean, computed=True))
    return surface


def _side(size: Indices, axis: int, end: int) -> Indices:
    """Return numbers of the places on a side of a grid, along its two other axes."""
    # VTK's first index varies fastest: these are the steps from a point to the next along each
    # axis.
    along = [np.arange(n) * step for n, step in zip(size, np.cumprod([1, *size[:2]]), strict=True)]
    numbers: Indices = along[axis][end] + np.add.outer(along[axis - 2], along[axis - 1])
    return numbers


def fixed_colors(
    source: Source, scene: Scene, colors: Bytes | None, ids: Indices
) -> tuple[Bytes, str]:
    """Return colours in light that stays as it is when the eye moves.

    The view of the scene is used only where ambient and diffuse light cannot do without one; terms
    that were computed for it are returned in words. ``colors`` of data, None for the material's,
    are of the points ``ids`` of the source, -1 for none.
    """
    seen = []
    following = [light for light in scene.lights if light.follows_view and light.intensity > 0]
    if any(light.is_headlight for light in following):
        seen.append("the headlight")
    if not all(light.is_headlight for light in following):
        seen.append("the light that follows the view")
    if source.options.model == "cylinder":
        seen.append("the diffuse light of cylinders")
    if source.inputs.fur_height is not None:
        seen.append("the way of light out of the fur")
    if source.sided is not None:
        seen.append("the lit side of open surfaces")
    bare = scene.replace(
        material=dataclasses.replace(scene.material, specular=0.0),
        depth_cue=None,
        view=scene.view if seen else None,
    )
    return lit_colors(_on_one_side(source, bare.view), bare, colors, ids), " and ".join(seen)


def lit_colors(source: Source, scene: Scene, colors: Bytes | None, ids: Indices) -> Bytes:
    """Return colours of data, or of the material, in light, as bytes of shape (M, 4)."""
    if colors is not None:
        light, valid = light_on_colors([source], scene)[0]
        lit = on_colors(colors, light[ids], valid[ids])
    else:
        parts = [(source.seen_from(scene.view, source.inputs), source.options)]
        (shading,), _ = lighting.light(parts, scene, progress_bar=False)
        # One half makes the cast to bytes round; the fourth channel is full opacity.
        lit = np.insert(255.0 * on_screen(shading) + 0.5, 3, 255.0, axis=1).astype(np.uint8)[ids]
    return lit


def _on_one_side(source: Source, view: View | None) -> Source:
    """Return a source with its open pieces lit on the side that most of their points show.

    Turned point by point they would be dark where the eye of the file's reader is not expected.
    """
    vectors_in = source.inputs.normals
    turned = source.seen_from(view, source.inputs).normals
    if source.sided is None or vectors_in is None or turned is None:
        return source
    vectors = np.asarray(vectors_in[:])
    piece = piece_numbers(source.mesh)
    # Each point has a vote: 1 where the eye is on the side of its normal, -1 on the other.
    same = np.sign(np.einsum("ij,ij->i", vectors, np.asarray(turned[:])))
    averted = np.bincount(piece, same)[piece] < 0
    sides = np.where(averted[:, np.newaxis], -vectors, vectors)
    return source._replace(inputs=dataclasses.replace(source.inputs, normals=sides), sided=None)
