"""Two ways to show light: in each fragment, by GLSL on an actor, or as colours of the points."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.draw import dialects, glsl, program
from vizlight.draw.live import COLORS, LUMINANCE, NORMALS, TANGENTS, matrix_of
from vizlight.draw.program import Stroke
from vizlight.filters import lighting
from vizlight.filters.tint import light_on_colors, map_colors
from vizlight.mesh import blocks, records
from vizlight.model import kernels
from vizlight.scene.conversion import LARGEST_POWER
from vizlight.scene.light import NO_ATTENUATION, WHITE
from vizlight.shading.display import NO_DATA, displayable, on_colors
from vizlight.shading.inputs import Layout
from vizlight.shading.plan import decide
from vizlight.vtk import polylines

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Bools, Indices, Keywords
    from vizlight.draw.live import Live
    from vizlight.draw.program import Uniform
    from vizlight.filters.relight import Source
    from vizlight.scene import Light, Scene, View
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.options import ShadingOptions
    from vizlight.shading.plan import Plan

#: Share of the edges along which the tangent may reverse before its sign counts as arbitrary.
REVERSED = 0.02
#: Fragment shader that draws the colours of the points.
AS_IT_IS = "  gl_FragData[0] = vec4(vertexColorVSOutput.rgb, opacity);\n"


def unfit(
    inputs: ShadingInputs,
    options: ShadingOptions,
    mesh: pv.DataSet,
    stroke: Stroke = Stroke(),  # noqa: B008 (a tuple is not changed)
) -> str:
    """Return why a source cannot be lit in each fragment, or an empty string.

    Parameters
    ----------
    inputs : ShadingInputs
    options : ShadingOptions
    mesh : pyvista.DataSet
        Mesh that is drawn.
    stroke : Stroke
        How its lines are drawn.

    Returns
    -------
    str
    """
    layout = inputs.layout
    alone = layout._replace(normals=False, dimmed=False, occluded=False) == Layout(k=1)
    # A round line has the normals of a cylinder, made in the shader: there is no room for others.
    if stroke.round and (options.conditioned or not alone):
        return "only lines that are lit by their tangents alone can be round"
    reason = unfit_layout(layout, options, stroke)
    lines = inputs.tangents is not None and inputs.dimensions is None
    # Between opposite tangents the interpolated one passes through 0 and tells no direction.
    if not reason and lines and _reverses(inputs, mesh):
        return "the tangents reverse from point to point, so their sign is arbitrary"
    return reason


def unfit_layout(
    layout: Layout,
    options: ShadingOptions,
    stroke: Stroke = Stroke(),  # noqa: B008
) -> str:
    """Return why inputs of a layout cannot be lit in each fragment, or an empty string."""
    if layout.n != 3:
        return f"light in {layout.n}-space has no direction in the picture"
    if layout.k not in (None, 1):
        return f"{layout.k} tangents per point span a plane, which is not interpolated"
    if options.model == "cylinder" and not stroke.round:
        return "the highlight of a cylinder is an integral that GLSL has no function for"
    if layout.shadowed:
        return "t of the cos-theta shadow is known at the points"
    if layout.dimmed:
        return "the shares of light inside a bundle are known at the points"
    if layout.base:
        return "base tangents span a plane, which is not interpolated"
    return ""


def _reverses(inputs: ShadingInputs, mesh: pv.DataSet) -> bool:
    """Return whether tangents at neighbouring points often point against each other."""
    tangents = _rows(inputs, inputs.tangents)
    starts, ends = _edges(mesh)
    if tangents is None or not len(starts):
        return False
    cosine = np.einsum("ij,ij->i", tangents[starts], tangents[ends])
    return bool(np.count_nonzero(cosine < -0.5) > REVERSED * len(starts))


def _edges(mesh: pv.DataSet) -> tuple[Indices, Indices]:
    """Return the points at both ends of consecutive corners of the cells that are drawn."""
    surface = mesh if isinstance(mesh, pv.PolyData) else None
    if surface is None:
        shell, ids = blocks.outer_surface(mesh)
        starts, ends = (ids[corners] for corners in _edges(shell))
        inside = (starts >= 0) & (ends >= 0)
        return starts[inside], ends[inside]
    pairs = []
    for cells in (surface.GetLines(), surface.GetPolys(), surface.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray())
        # The last corner of a cell has no next one: cells follow each other in one list of
        # corners.
        inside = np.ones(len(ids), dtype=np.bool_)
        inside[pv.convert_array(cells.GetOffsetsArray())[1:] - 1] = False
        first = np.flatnonzero(inside)
        pairs.append((ids[first], ids[first + 1]))
    starts, ends = (np.concatenate(side) for side in zip(*pairs, strict=True))
    return starts, ends


class Fragments:
    """Light computed in each fragment, from tangents and normals that VTK interpolates.

    They are the active tangents and normals of the drawn mesh, so that PyVista's own mapper is
    kept, with its colours and its scalar bar.
    """

    light = "fragments"

    def __init__(self, stroke: Stroke = Stroke()) -> None:  # noqa: B008 (a tuple is not changed)
        self._stroke = stroke
        self._key: object = None
        self._plan: Plan | None = None
        #: Whether the colour is the material's.
        self._colored = False
        #: Height of the fur whose normal has the length 2.
        self.tallest = 0.0
        #: Height fields that the eye sees from behind.
        self._averted: Bools = np.zeros(0, dtype=np.bool_)

    def attach(self, live: Live) -> None:
        """Give the drawn mesh its tangents and normals, of unit length in float32."""
        inputs, data = live.source.inputs, live.drawn.GetPointData()
        tangents, normals = (
            _rows(inputs, rows, live) for rows in (inputs.tangents, inputs.normals)
        )
        carried = tangents
        if inputs.occlusion is not None:
            # The length of a tangent, which a surface does not have, carries the ambient share.
            share = live.picked(np.asarray(inputs.occlusion[:], dtype=np.float64))
            # From 1 to 2, never 0: a vector of length 0 would lose its direction between points.
            share = 1 + np.where(share >= 0, share, 1.0)
            along = np.array([[1.0, 0.0, 0.0]]) if tangents is None else tangents
            carried = share[:, np.newaxis] * along
        if inputs.dimensions is not None and carried is not None:
            # Two numbers in one length: the share in 0 to 1 above a step of LENGTHS for the
            # dimension.
            less = 2 - live.picked(np.asarray(inputs.dimensions[:]))
            carried = carried + program.LENGTHS * less[:, np.newaxis] * kernels.unit_rows(carried)
        if carried is not None:
            records.attach_rows(live.drawn, TANGENTS, carried.astype(np.float32))
            data.SetActiveTangents(TANGENTS)
        if normals is None:
            # VTK lights lines, and so draws with a shader for them, only if they have normals.
            normals = tangents
            # A stroke is widened across the line's own direction, whatever the light takes for its
            # tangent.
            if self._stroke != Stroke():
                normals = live.picked(polylines.line_tangents(live.source.mesh))
        elif inputs.fur_height is not None:
            # The length of a normal, which light does not need, carries the height of the fur.
            height = live.picked(np.asarray(inputs.fur_height[:], dtype=np.float64))
            self.tallest = float(np.max(height, initial=0.0)) or 1.0
            normals = normals * (1 + height[:, np.newaxis] / self.tallest)
        elif (sided := live.source.sided) is not None:
            # Before the first frame there is no eye: height fields are then taken as seen from
            # above.
            if len(self._averted) <= np.max(sided.open, initial=1):
                self._averted = sided.averted_fields(inputs.points, None)
            lean = live.picked(_lean_lengths(live.source, self._averted))
            normals = normals * lean[:, np.newaxis]
        if normals is not None:
            records.attach_rows(live.drawn, NORMALS, normals.astype(np.float32))
            data.SetActiveNormals(NORMALS)

    def drawing(self, live: Live, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""
        drawing = drawing | {"lighting": True}
        if live.scalars is None:
            own = None if live.scene is None else (live.scene.material.color or WHITE)
            given = drawing.get("color")
            self._colored = given is None
            # A texture multiplies the actor's colour: white leaves it as it is.
            usual = WHITE if drawing.get("texture") is not None else True
            drawing["color"] = (usual if own is None else own) if given is None else given
        return drawing

    def start(self, live: Live, actor: vtkActor) -> None:
        """Give an actor the material of the scene, as far as VTK can have it."""
        prop = actor.GetProperty()
        prop.SetInterpolationToPhong()
        if live.scene is None:
            return
        material = live.scene.material
        if self._colored:
            prop.SetColor(*(material.color or WHITE))
        # VTK clamps coefficients to 1 and shininess to its own largest; the rest is a uniform, a
        # gain.
        prop.SetAmbient(min(material.ambient, 1.0))
        prop.SetDiffuse(min(material.diffuse, 1.0))
        prop.SetSpecular(min(material.specular, 1.0))
        prop.SetSpecularPower(min(material.shininess, LARGEST_POWER))
        prop.SetSpecularColor(*(material.specular_color or WHITE))

    def paint(self, live: Live, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Write the shader of a scene if it is another one, and set its uniforms."""
        # The camera may have crossed to the other side of a height field.
        self.see(live, live.placed(actor), scene.view)
        scene = lighting.fit_depth_cue(scene, [live.placed(actor)])
        # Colours of data have no highlight.
        data = live.scalars is not None
        if data:
            scene = without_highlight(scene)
        lights = [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]
        # A new text costs a compilation, some 0.1 s; moved lamps and cameras only set uniforms.
        key, prop = _structure(scene, lights, live.source), actor.GetProperty()
        stroke, renew = self._stroke, key != self._key or self._plan is None
        plan = self._plan
        if renew or plan is None:
            plan = exact_plan(scene, live.source, stroke)
        # VTK has a specular colour only where it has lights of its own.
        shown = program.Shown(prop.GetAmbient(), prop.GetDiffuse(), prop.GetSpecularColor())
        given = program.numbers(
            scene, lights, shown=shown, fur=plan.fur, tallest=self.tallest, data=data
        )
        if renew:
            turned = live.source.sided is not None
            written = program.write(plan, turned=turned, stroke=stroke, data=data)
            texts = dialects.VTK.replacements(written, given)
            if stroke != Stroke():
                texts = dialects.widened(actor, texts, stroke)
            dialects.replace(actor, texts)
            self._key, self._plan = key, plan
        _set_uniforms(given, renderer, actor)

    def see(self, live: Live, placed: ShadingInputs, view: View | None) -> None:
        """Attach normals that tell which side of height fields an eye sees, if it is another."""
        sided = live.source.sided
        if sided is None or placed.normals is None:
            return
        vectors = np.asarray(placed.normals[:])
        averted = dataclasses.replace(sided, vectors=vectors).averted_fields(placed.points, view)
        if not np.array_equal(averted, self._averted):
            self._averted = averted
            self.attach(live)

    def explain(self, live: Live, scene: Scene) -> str:
        """Return what is computed in each fragment."""
        fitted = lighting.fit_depth_cue(scene, [live.source.inputs])
        if live.scalars is not None:
            fitted = without_highlight(fitted)
        plan = decide(fitted, *_drawn_as(live.source, self._stroke))
        return f"light in each fragment\n{plan.explain()}"


def without_highlight(scene: Scene) -> Scene:
    """Return a scene for colours of data, which no highlight hides."""
    return scene.replace(material=dataclasses.replace(scene.material, specular=0.0))


def _drawn_as(source: Source, stroke: Stroke) -> tuple[Layout, ShadingOptions]:
    """Return the layout and the options of a source, or of the cylinders of its lines."""
    if stroke.round:
        occluded = source.inputs.occlusion is not None
        return Layout(normals=True, occluded=occluded), source.options.for_surface()
    return source.inputs.layout, source.options


def exact_plan(scene: Scene, source: Source, stroke: Stroke = Stroke()) -> Plan:  # noqa: B008
    """Return the plan of a source."""
    layout, options = _drawn_as(source, stroke)
    return decide(scene, layout, dataclasses.replace(options, components=False))


def _structure(scene: Scene, lights: Sequence[Light], source: Source) -> tuple[object, ...]:
    """Return what a shader holds as constants, in a form that can be compared."""
    material, cue = scene.material, scene.depth_cue
    return (
        [(light.position is None, light.attenuation == NO_ATTENUATION) for light in lights],
        material.diffuse > 0, material.specular > 0, glsl.is_plain(material.shininess),
        None if cue is None else cue.smooth,
        source.inputs.layout, source.options, source.sided is None,
    )  # fmt: skip


def _rows(
    inputs: ShadingInputs, rows: ArraySource | None, live: Live | None = None
) -> Array | None:
    """Return unit vectors, one per point, or with ``live`` per point that is drawn."""
    if rows is None:
        return None
    vectors = np.asarray(rows[0 : rows.shape[0]]).reshape(-1, 3)
    if len(vectors) != inputs.count:
        vectors = np.repeat(vectors, inputs.repeat, axis=0)
    unit = kernels.unit_rows(vectors if live is None else live.picked(vectors))
    unit[~np.all(np.isfinite(unit), axis=1)] = 0
    return unit


def _lean_lengths(source: Source, averted: Bools) -> Array:
    """Return lengths of normals, which carry from 1 to 2 the lean from -1 to 1.

    A lean of 1 stands for points that no eye turns.
    """
    sided = source.sided
    assert sided is not None
    lean = sided.leaning(source.facing, averted)
    turned = (sided.facts()[:, 1] > 0) | (source.facing == "eye")
    return np.where(turned, 1.5 + 0.5 * np.clip(0.0 if lean is None else lean, -1.0, 0.98), 2.0)


def _set_uniforms(given: Iterable[Uniform], renderer: vtkRenderer, actor: vtkActor) -> None:
    """Set what a program is given, in the coordinates of the camera."""
    # VTK lights in view coordinates, where the eye is at the origin: float32 holds these well even
    # if the mesh is far from the origin of the world.
    view = matrix_of(renderer.GetActiveCamera().GetViewTransformMatrix())
    uniforms = actor.GetShaderProperty().GetFragmentCustomUniforms()
    for name, kind, value, space in given:
        numbers = list(value)
        if space:
            moved = view[:3, :3] @ np.asarray(value[:3], dtype=np.float64)
            # A camera's matrix may scale; directions stay unit vectors.
            moved = moved / np.linalg.norm(moved) if space == "direction" else moved + view[:3, 3]
            numbers[:3] = moved.tolist()
        if kind == "float":
            uniforms.SetUniformf(name, numbers[0])
        else:
            getattr(uniforms, f"SetUniform{len(numbers)}f")(name, numbers)


class Points:
    """Light as a point array of the drawn mesh, the same numbers as a filter attaches.

    Parameters
    ----------
    reason : str
        Why the light is not computed in each fragment.
    diameter : float, optional
        Diameter of lines in the unit of the mesh.
    """

    light = "points"

    def __init__(self, reason: str, diameter: float | None = None) -> None:
        self.reason, self._diameter = reason, diameter

    def attach(self, live: Live) -> None:
        """Give the drawn mesh an array; the first frame fills it."""
        count = live.drawn.n_points
        records.attach_rows(live.drawn, LUMINANCE, np.zeros(count))
        channels = 3 if live.scalars is None else 4
        kind = np.float64 if live.scalars is None else np.uint8
        records.attach_rows(live.drawn, COLORS, np.zeros((count, channels), kind))
        if self._diameter is not None:
            live.attach(NORMALS, polylines.line_tangents(live.source.mesh).astype(np.float32))
            live.drawn.GetPointData().SetActiveNormals(NORMALS)

    def drawing(self, live: Live, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""
        if live.scalars is not None:
            return drawing | {"lighting": False}
        color = drawing.pop("color", None)
        if color is not None and live.scene is not None:
            channels = _check.color("color", color)
            material = dataclasses.replace(live.scene.material, color=channels)
            live.scene = live.scene.replace(material=material)
        plain = {"lighting": False, "show_scalar_bar": False}
        if live.scene is not None and not live.scene.colored:
            gray = {"scalars": LUMINANCE, "cmap": "gray", "clim": (0.0, 1.0)}
            return drawing | plain | gray
        own = True if color is None else color
        return drawing | plain | {"scalars": COLORS, "rgb": True, "color": own}

    def start(self, live: Live, actor: vtkActor) -> None:
        """Let an actor draw lit colours as they are, in place of the data's."""
        prop = actor.GetProperty()
        if self._diameter is not None:
            dialects.widen(actor, Stroke(self._diameter))
        if live.scene is None:
            # Without lights VTK multiplies by the sum of both coefficients, which are the material.
            actor.GetShaderProperty().AddFragmentShaderReplacement(
                "//VTK::Light::Impl", True, AS_IT_IS, False
            )
        else:
            prop.SetAmbient(1.0)
            prop.SetDiffuse(0.0)
        if live.scalars is None:
            return
        mapper = actor.GetMapper()
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(COLORS)
        mapper.SetColorModeToDirectScalars()
        mapper.SetInterpolateScalarsBeforeMapping(False)

    def paint(self, live: Live, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:  # noqa: ARG002
        """Light the points and draw them with the result."""
        inputs = live.source.seen_from(scene.view, live.placed(actor))
        source = live.source._replace(inputs=inputs, sided=None)
        if live.scalars is not None:
            (light,) = light_on_colors([source], scene)
            colors = mapped(live.drawn.point_data[live.scalars], actor)
            if colors.shape[1] == 3:
                colors = np.insert(colors, 3, 255, axis=1)
            _write(live.drawn, COLORS, on_colors(colors, *light))
            return
        parts = [(source.inputs, source.options)]
        (shading,), _ = lighting.light(parts, scene, progress_bar=False)
        if live.scene is None or live.scene.colored:
            rgb = shading.rgb
            if rgb is None:
                rgb = np.repeat(shading.luminance[:, np.newaxis], 3, axis=1)
            # VTK wraps around above 1, so a bright highlight would turn black.
            shown = displayable(rgb)
            shown[~shading.valid] = NO_DATA
            _write(live.drawn, COLORS, shown)
        else:
            _write(live.drawn, LUMINANCE, np.where(shading.valid, shading.luminance, NO_DATA[0]))

    def explain(self, live: Live, scene: Scene) -> str:
        """Return why the light is computed at the points, and what of it."""
        fitted = lighting.fit_depth_cue(scene, [live.source.inputs])
        plan = decide(fitted, live.source.inputs.layout, live.source.options)
        return f"light at the points: {self.reason}\n{plan.explain()}"


def mapped(values: NDArray[np.generic], actor: vtkActor) -> NDArray[np.uint8]:
    """Return the colours of values as the mapper of an actor has them, or colours as they are."""
    if np.ndim(values) == 2:
        # Colours as they were given, or PyVista's own for an opacity of each point.
        return np.asarray(values).astype(np.uint8)
    return map_colors(actor.GetMapper().GetLookupTable(), values)


def _write(mesh: pv.DataSet, name: str, values: NDArray[np.generic]) -> None:
    """Write values to an array of a mesh, in place where they fit."""
    if name in mesh.point_data:
        array = mesh.point_data[name]
        if array.shape == values.shape and array.dtype == values.dtype:
            np.copyto(array, values)
            mesh.GetPointData().GetAbstractArray(name).Modified()
            mesh.Modified()
            return
    records.attach_rows(mesh, name, values)
