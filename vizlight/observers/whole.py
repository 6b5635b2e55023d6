"""The picture of a plotter for the meter: its pixels, its meshes, and actors that hide them."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersCore import vtkGlyph3D
from vtkmodules.vtkRenderingCore import vtkActor, vtkDataSetMapper, vtkGlyph3DMapper

from vizlight import _check
from vizlight.draw.glsl import Stroke
from vizlight.draw.live import Live, items, matrix_of
from vizlight.draw.strokes import SUPERSAMPLED, has_pass, shares_of
from vizlight.filters.tint import unlit_colors, values_of
from vizlight.mesh import records
from vizlight.mesh.polylines import direction_colors
from vizlight.model.kernels import unit_rows
from vizlight.observers.eye import MM_PER_INCH, NOISE
from vizlight.observers.figures import Legibility
from vizlight.observers.measure import measure, toward
from vizlight.observers.pixels import frame_of
from vizlight.observers.samples import GLYPH, part_on
from vizlight.scene import Light, Scene, View
from vizlight.shading.options import LightOptions
from vizlight.vtk.arrays import at_points, is_of_cells
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Callable

    from vtkmodules.vtkRenderingCore import vtkRenderer

    from vizlight._types import Array, Foreign, Keywords, Raw
    from vizlight.observers.samples import SeenMesh

#: Width in mm, pixels per inch and distance in mm of a picture in print.
PRINT = 85.0, 300.0, 400.0
#: Distance in mm of a screen.
SCREEN_DISTANCE = 600.0
#: VTK's number of the mode in which scalars are colours, in bytes or not.
DIRECT = 2
#: How far numbers of a picture may be beyond 0 and 1 by rounding, as after a blur in float32.
BEYOND = 1e-5
#: Opacity below which an actor does not hide what is behind it.
HIDES = 0.5


class Shown(NamedTuple):
    """Picture of a renderer.

    ``parts`` can be read, ``occluders`` hide them, and ``notes`` are on data that are not read.
    """

    parts: list[SeenMesh]
    occluders: list[vtkActor]
    notes: list[str]


def legibility_of(
    plotter: pv.BasePlotter,
    live_of: Callable[[vtkActor], Live | None],
    /,
    *,
    size_mm: float | None = None,
    distance_mm: float | None = None,
    screen: float | None = None,
    noise: float = NOISE,
    samples: int = 4096,
    seed: int = 0,
) -> Legibility:
    """Return how much a reader can read back from the whole picture of a plotter.

    The renderer that is active is read; ``live_of`` takes an actor to its light of vizlight, or
    None, and options are as for :func:`vizlight.legibility`.
    """
    if not plotter.camera_set:
        plotter.renderer.view_isometric(render=False)
    # PyVista's own picture may be older than the camera.
    assert plotter.render_window is not None
    whole = frame_of(plotter.render_window) / 255.0
    renderer = plotter.renderer
    (left, low), (wide, high) = renderer.GetOrigin(), renderer.GetSize()
    top = len(whole) - low - high
    picture = whole[top : top + high, left : left + wide]
    shown = shown_by(renderer, live_of)
    how = reading(wide, size_mm, distance_mm, screen, noise, samples, seed)
    camera = renderer.GetActiveCamera()
    if shown.parts:
        return measure(
            picture, shown.parts, camera, occluders=shown.occluders, notes=shown.notes, **how
        )
    if not shown.occluders:
        remedy = "add a mesh by plotter.vizlight.add_mesh, or with scalars"
        raise ValueError(_check.message("plotter", "a mesh that can be read", "none", remedy))
    del how["samples"]
    return Legibility(
        pixels=0, size=(wide, high), toward_eye=toward(camera), **how,
        notes=("nothing that is shown has a key by which it could be read",),
    )  # fmt: skip


def reading(
    pixels: int, size_mm: object, distance_mm: object, screen: object, noise: object,
    samples: object, seed: object,
) -> Keywords:  # fmt: skip
    """Return the checked options of a reading of a picture of some width in pixels."""
    far = PRINT[2]
    if screen is not None:
        if size_mm is not None:
            got = "both size_mm= and screen="
            raise ValueError(_check.message("screen", "a picture in print or on a screen", got))
        size_mm, far = MM_PER_INCH * pixels / _check.positive("screen", screen), SCREEN_DISTANCE
    size_mm = PRINT[0] if size_mm is None else _check.positive("size_mm", size_mm)
    far = far if distance_mm is None else _check.positive("distance_mm", distance_mm)
    return {
        "size_mm": size_mm,
        "distance_mm": far,
        "noise": _check.number("noise", noise, low=0.0, high=100.0),
        "samples": _check.integer("samples", samples, low=1, high=1 << 24),
        "seed": _check.integer("seed", seed, low=0),
    }


def shown_by(renderer: vtkRenderer, live_of: Callable[[vtkActor], Live | None]) -> Shown:
    """Return the readable meshes of a renderer, and the actors that hide them.

    An actor that cannot be picked is no data: it hides meshes behind it.
    """
    shown = Shown([], [], [])
    # Supersampling draws a picture that many times as wide and shrinks it.
    pixel = SUPERSAMPLED if has_pass(renderer.GetPass(), "vtkSSAAPass") else 1.0
    for actor in items(renderer.GetActors()):
        mapper = actor.GetMapper()
        if not actor.GetVisibility() or mapper is None or mapper.GetInput() is None:
            continue
        live, style = live_of(actor), actor.GetProperty()
        width = max(1.0, style.GetLineWidth() / pixel)
        if not actor.GetPickable():
            part = None  # what stands beside the data, such as coasts
        elif live is None:
            part = _colored(actor, renderer, width)
        else:
            # Strokes are as wide as their property says.
            stroke_width = width if live.stroke == Stroke() else max(1.0, style.GetLineWidth())
            part = _lit(live, renderer, actor, stroke_width)
        if part is not None:
            if part.kind == "point":
                # The square that a point fills, or one as large as its ball.
                share = math.sqrt(math.pi / 4) if style.GetRenderPointsAsSpheres() else 1.0
                width = max(1.0, share * style.GetPointSize() / pixel)
                part = dataclasses.replace(part, width=width)
            shown.parts.append(part)
        elif style.GetOpacity() >= HIDES:
            shown.occluders.append(_occluder(actor, pixel))
    return shown


def _lit(live: Live, renderer: vtkRenderer, actor: vtkActor, width: float) -> SeenMesh | None:
    """Return a mesh with light of vizlight as a part."""
    mesh, table = live.source.mesh, actor.GetMapper().GetLookupTable()
    if live.n != 3:
        # Light of n-space has no key in the picture; colours of values have.
        return _colored(actor, renderer, width, live)
    scene = live.scene_of(renderer, actor)
    options = live.source.named or LightOptions.of(vars(live.source.options))
    colors = _values(mesh, live.given, table, live.component, averaged=live.averaged)
    # Colours that were given mean nothing that a key tells; crossings of lines are still read, and
    # so are marks.
    lit = live.scalars is None or "values" in colors
    if not lit and not has_lines_only(mesh) and GLYPH not in mesh.point_data:
        return None
    # What is drawn has its sharp edges already.
    options = dataclasses.replace(options, feature_angle=None)
    return part_on(
        mesh, scene, options, matrix=matrix_of(actor.GetMatrix()), lit=lit, width=width,
        **_stroke_of(live), **colors,
    )  # fmt: skip


def _glyphs_of(mapper: Foreign) -> pv.PolyData | None:
    """Return the mesh of the glyphs that a mapper draws along vectors; None for others."""
    data = pv.PolyData(pv.wrap(mapper.GetInput()).points)
    data.point_data.update(pv.wrap(mapper.GetInput()).point_data)
    named = [mapper.GetInputArrayInformation(i).Get(vtkDataObject.FIELD_NAME()) for i in (0, 3)]
    size, vectors = (data.point_data.get(name) for name in named)
    along = mapper.GetOrient() and mapper.GetOrientationMode() == mapper.DIRECTION
    if vectors is None or not along or mapper.GetScaleMode() == mapper.SCALE_BY_COMPONENTS:
        return None
    data.point_data.active_vectors_name = named[1]
    maker = vtkGlyph3D()
    maker.SetInputData(data)
    maker.SetSourceData(mapper.GetSource())
    maker.SetScaleFactor(mapper.GetScaleFactor())
    maker.SetScaleModeToDataScalingOff()
    if size is not None and mapper.GetScaling() and mapper.GetScaleMode() != mapper.NO_DATA_SCALING:
        data.point_data["vizlight size"] = np.linalg.norm(size.reshape(len(size), -1), axis=1)
        data.point_data.active_scalars_name = "vizlight size"
        maker.SetScaleModeToScaleByScalar()
    maker.Update()
    return pv.PolyData(maker.GetOutput())


def _marks(actor: vtkActor, mesh: pv.DataSet) -> str | None:
    """Return the name of the vectors along which marks run: glyphs, VTK's LIC, other textures."""
    mapper = actor.GetMapper()
    if "LIC" in mapper.GetClassName():
        name = mapper.GetInputArrayInformation(0).Get(vtkDataObject.FIELD_NAME())
        return name or mesh.point_data.active_vectors_name
    if actor.GetTexture() is not None:
        return mesh.point_data.active_vectors_name
    return GLYPH if GLYPH in mesh.point_data else None


def _colored(
    actor: vtkActor, renderer: vtkRenderer, width: float, live: Live | None = None
) -> SeenMesh | None:
    """Return a mesh with colours that mean values, or nothing on lines, as a part."""
    mapper = actor.GetMapper()
    glyphs = isinstance(mapper, vtkGlyph3DMapper)
    of_mapper = _glyphs_of(mapper) if glyphs else pv.wrap(mapper.GetInput())
    mesh = of_mapper if live is None else live.source.mesh
    name = mapper.GetArrayName() if live is None else live.given
    if not isinstance(mesh, pv.DataSet) or not mesh.n_points:
        return None
    # Colours that are drawn as they are have no table; those of n-space were made of values.
    direct = mapper.GetColorMode() == DIRECT and mapper.GetArrayName() == name
    table = None if direct else mapper.GetLookupTable()
    component, averaged = (None, False) if live is None else (live.component, live.averaged)
    name = name if mapper.GetScalarVisibility() else None
    colors = _values(mesh, name, table, component, averaged=averaged)
    marks = _marks(actor, mesh)
    # Crossings of lines are read whatever their colours mean, and so are marks.
    if not colors and marks is None and not has_lines_only(mesh):
        return None
    scene = Scene(lights=Light.headlight(), view=View.from_camera(renderer.GetActiveCamera()))
    return part_on(
        mesh, scene, LightOptions(tangents=marks), matrix=matrix_of(actor.GetMatrix()),
        width=width, lit=False, **({} if live is None else _stroke_of(live)), **colors,
    )  # fmt: skip


def _stroke_of(live: Live) -> Keywords:
    """Return how wide the lines of a mesh with light are drawn."""
    stroke = live.stroke
    shares = None if stroke.width is None else shares_of(live.source.mesh, stroke.width)
    return {"diameter": stroke.diameter, "shares": shares}


def _values(
    mesh: pv.DataSet, name: str | None, table: Foreign, component: int | None, *, averaged: bool
) -> Keywords:
    """Return the meaning of the colours of an array: values and their table, axes, or nothing.

    Values of cells are those of their colours, unless they are averaged to points.
    """
    if name is None or name not in (*mesh.point_data, *mesh.cell_data):
        return {}
    of_cells = is_of_cells(mesh, name)
    flat = of_cells and not averaged
    if table is None:
        values: Raw = np.asarray((mesh.cell_data if of_cells else mesh.point_data)[name])
    else:
        values = values_of(mesh, name, component, flat=flat)
    if values.ndim == 1:
        has_table = isinstance(table, pv.LookupTable)
        return {"values": values, "table": table, "flat": flat} if has_table else {}
    if name in records.all_made(mesh) and records.provenance(mesh, name)["filter"] == "tint":
        of_tint = records.provenance(mesh, name)["options"]
        colors, component = unlit_colors(mesh, name), of_tint["component"]
        return _values(mesh, of_tint["scalars"], colors, component, averaged=True)
    return {"by_axes": True} if has_lines_only(mesh) and _by_axes(mesh, name) else {}


def _by_axes(mesh: pv.DataSet, name: str) -> bool:
    """Return whether lines have the colours of the axes along which they run, in any light.

    Colours that are seen are compared with :func:`vizlight.direction_colors`: the median of their
    angle is less than that of a change of a channel by 1 in 30.
    """
    given = mesh.point_data.get(name)
    colors = at_points(mesh, np.asarray(mesh.cell_data[name])) if given is None else given
    if colors is None or colors.shape[1] < 3:
        return False
    shown, of_axes = (
        unit_rows(a[:, :3].astype(np.float64)) for a in (colors, direction_colors(mesh))
    )
    seen = (shown.any(axis=1)) & (of_axes.any(axis=1))
    cosine = np.einsum("ij,ij->i", shown[seen], of_axes[seen])
    return len(cosine) > 0 and float(np.median(cosine)) > np.cos(1 / 30)


def _occluder(actor: vtkActor, pixel: float) -> vtkActor:
    """Return a black copy of an actor, which hides meshes behind it and has no cells."""
    mapper = vtkDataSetMapper()
    mapper.SetInputData(actor.GetMapper().GetInput())
    mapper.ScalarVisibilityOff()
    copy = vtkActor()
    copy.SetMapper(mapper)
    copy.SetUserMatrix(actor.GetMatrix())
    style = copy.GetProperty()
    style.LightingOff()
    style.SetColor(0.0, 0.0, 0.0)
    style.SetLineWidth(max(1.0, actor.GetProperty().GetLineWidth() / pixel))
    style.SetPointSize(max(1.0, actor.GetProperty().GetPointSize() / pixel))
    style.SetRepresentation(actor.GetProperty().GetRepresentation())
    # Walls whose near sides are left out let through what they enclose.
    style.SetFrontfaceCulling(actor.GetProperty().GetFrontfaceCulling())
    style.SetBackfaceCulling(actor.GetProperty().GetBackfaceCulling())
    return copy


def read_picture(picture: object) -> Array:
    """Return a picture from an array or a file as sRGB values, shape (H, W, 3) from 0 to 1.

    Values beyond that by ``BEYOND`` at most, such as by rounding, are taken for 0 and 1.
    """
    if isinstance(picture, np.ndarray):
        array: Foreign = picture
    else:
        path = _check.path("picture", picture)
        if not path.exists():
            raise ValueError(_check.message("picture", "an array or an existing file", str(path)))
        image = pv.read(path)
        if not isinstance(image, pv.ImageData) or image.active_scalars is None:
            raise ValueError(_check.message("picture", "a picture such as a PNG file", str(path)))
        width, height, _ = image.dimensions
        # VTK's rows begin at the bottom.
        array = np.asarray(image.active_scalars).reshape(height, width, -1)[::-1]
    if array.ndim != 3 or array.shape[2] not in (3, 4) or min(array.shape[:2]) < 8:
        expected = "an array of shape (height, width, 3), of 8 pixels or more along each side"
        raise ValueError(_check.message("picture", expected, f"shape {array.shape}"))
    scale = 255.0 if array.dtype == np.uint8 else 1.0
    rgb = np.asarray(array[..., :3], dtype=np.float64) / scale
    low, high = float(rgb.min()), float(rgb.max())
    if not (low >= -BEYOND and high <= 1 + BEYOND):
        finite = math.isfinite(low) and math.isfinite(high)
        got = f"numbers from {low:.6g} to {high:.6g}" if finite else "numbers that are not finite"
        remedy = "clip them, or divide them by the number of white"
        raise ValueError(_check.message("picture", "bytes, or numbers from 0 to 1", got, remedy))
    return np.clip(rgb, 0.0, 1.0)
