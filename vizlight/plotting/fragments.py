"""Light in each fragment: the plan as GLSL by shader replacement on an actor."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters import lighting
from vizlight.mesh import hull, polylines
from vizlight.mesh.point_arrays import unit_rows
from vizlight.plotting import glsl, strokes
from vizlight.plotting.live import NORMALS, TANGENTS
from vizlight.plotting.strokes import Stroke
from vizlight.scene.light import NO_ATTENUATION, WHITE
from vizlight.scene.vtk import LARGEST_POWER
from vizlight.shading.decide import decide
from vizlight.shading.inputs import Layout

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Indices, Vector
    from vizlight.filters.relight import Source
    from vizlight.plotting.live import Live
    from vizlight.scene import Light, Scene
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.options import ShadingOptions
    from vizlight.shading.plan import Plan

#: Share of the edges along which the tangent may reverse before its sign counts as arbitrary.
REVERSED = 0.02
#: Number of lights for which a shader is written.
MOST_LIGHTS = 16


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
    if stroke.round and (options.conditioned or not alone):
        return "only lines that are lit by their tangents alone can be round"
    if layout.n != 3:
        return f"light in {layout.n}-space has no direction in the picture"
    if layout.k not in (None, 1):
        return f"{layout.k} tangents per point span a plane, which is not interpolated"
    if options.model == "cylinder" and not stroke.round:
        return "the highlight of a cylinder is an integral that GLSL has no function for"
    if layout.shadowed:
        return "t of the cos-theta shadow is known at the points"
    if layout.dimmed or layout.occluded:
        return "the shares of light inside a bundle are known at the points"
    if layout.base:
        return "base tangents span a plane, which is not interpolated"
    if inputs.tangents is not None and _reverses(inputs, mesh):
        return "the tangents reverse from point to point, so their sign is arbitrary"
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
        shell, ids = hull.outer_surface(mesh)
        starts, ends = (ids[corners] for corners in _edges(shell))
        inside = (starts >= 0) & (ends >= 0)
        return starts[inside], ends[inside]
    pairs = []
    for cells in (surface.GetLines(), surface.GetPolys(), surface.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray())
        inside = np.ones(len(ids), dtype=np.bool_)
        inside[pv.convert_array(cells.GetOffsetsArray())[1:] - 1] = False
        first = np.flatnonzero(inside)
        pairs.append((ids[first], ids[first + 1]))
    starts, ends = (np.concatenate(side) for side in zip(*pairs, strict=True))
    return starts, ends


class _ViewSpace:
    """Vectors of the scene in the coordinates of a camera."""

    def __init__(self, renderer: vtkRenderer) -> None:
        matrix = renderer.GetActiveCamera().GetViewTransformMatrix()
        self._matrix = pv.array_from_vtkmatrix(matrix)

    def direction(self, vector: Vector) -> list[float]:
        """Return a unit direction."""
        turned = self._matrix[:3, :3] @ np.asarray(vector, dtype=np.float64)
        return [float(x) for x in turned / np.linalg.norm(turned)]

    def position(self, vector: Vector) -> list[float]:
        """Return a position."""
        moved = self._matrix[:3, :3] @ np.asarray(vector, dtype=np.float64) + self._matrix[:3, 3]
        return [float(x) for x in moved]


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
        self._tallest = 0.0

    def attach(self, live: Live) -> None:
        """Give the drawn mesh its tangents and normals, of unit length in float32."""
        inputs, data = live.source.inputs, live.drawn.GetPointData()
        tangents, normals = (_rows(inputs, rows) for rows in (inputs.tangents, inputs.normals))
        if tangents is not None:
            live.attach(TANGENTS, tangents.astype(np.float32))
            data.SetActiveTangents(TANGENTS)
        if normals is None:
            # VTK lights lines, and so draws with a shader for them, only if they have normals.
            normals = tangents
            if self._stroke != Stroke():
                normals = polylines.line_tangents(live.source.mesh)
        elif inputs.fur_height is not None:
            # The length of a normal, which light does not need, carries the height of the fur.
            height = np.asarray(inputs.fur_height[:], dtype=np.float64)
            self._tallest = float(np.max(height, initial=0.0)) or 1.0
            normals = normals * (1 + height[:, np.newaxis] / self._tallest)
        elif live.source.sided is not None:
            normals = normals * _lean_lengths(live.source, len(normals))[:, np.newaxis]
        if normals is not None:
            live.attach(NORMALS, normals.astype(np.float32))
            data.SetActiveNormals(NORMALS)

    def drawing(self, live: Live, drawing: dict[str, Any]) -> dict[str, Any]:
        """Return the keywords of ``plotter.add_mesh``."""
        drawing = drawing | {"lighting": True}
        if live.scalars is None:
            own = None if live.scene is None else (live.scene.material.color or WHITE)
            given = drawing.get("color")
            drawing["color"] = (True if own is None else own) if given is None else given
        return drawing

    def start(self, live: Live, actor: vtkActor) -> None:
        """Give an actor the material of the scene, as far as VTK can have it."""
        prop = actor.GetProperty()
        prop.SetInterpolationToPhong()
        if live.scene is None:
            if live.scalars is not None:
                prop.SetSpecularColor(1.0, 1.0, 1.0)
            return
        material = live.scene.material
        prop.SetAmbient(min(material.ambient, 1.0))
        prop.SetDiffuse(min(material.diffuse, 1.0))
        prop.SetSpecular(min(material.specular, 1.0))
        prop.SetSpecularPower(min(material.shininess, LARGEST_POWER))
        prop.SetSpecularColor(*(material.specular_color or WHITE))

    def paint(self, live: Live, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Write the shader of a scene if it is another one, and set its uniforms."""
        scene = lighting.fit_depth_cue(scene, [live.placed(actor)])
        lights = [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]
        if len(lights) > MOST_LIGHTS:
            got = str(len(lights))
            raise ValueError(_check.message("lights", f"at most {MOST_LIGHTS} lights", got))
        key = _structure(scene, lights, live.source)
        if key != self._key or self._plan is None:
            self._plan = _plan(scene, live.source, self._stroke)
            turned = live.source.sided is not None
            code = glsl.fragment(self._plan, turned=turned)
            _replace(actor, *code, self._plan, self._stroke, turned=turned)
            self._key = key
        self._set_uniforms(self._plan, scene.replace(lights=lights), renderer, actor)

    def explain(self, live: Live, scene: Scene) -> str:
        """Return what is computed in each fragment."""
        fitted = lighting.fit_depth_cue(scene, [live.source.inputs])
        plan = decide(fitted, *_drawn_as(live.source, self._stroke))
        return f"light in each fragment\n{plan.explain()}"

    def _set_uniforms(
        self, plan: Plan, scene: Scene, renderer: vtkRenderer, actor: vtkActor
    ) -> None:
        """Set what the shader does not hold as a constant."""
        prop, space = actor.GetProperty(), _ViewSpace(renderer)
        uniforms = actor.GetShaderProperty().GetFragmentCustomUniforms()
        for i, light in enumerate(scene.lights):
            if light.position is not None:
                uniforms.SetUniform3f(f"vizLight{i}", space.position(light.position))
                uniforms.SetUniform3f(f"vizFade{i}", list(light.attenuation))
            elif light.direction is not None:
                uniforms.SetUniform3f(f"vizLight{i}", space.direction(light.direction))
            color = [light.intensity * c for c in light.color or WHITE]
            uniforms.SetUniform3f(f"vizColor{i}", color)
        view = scene.view
        eye = [0.0, 0.0, 1.0, 0.0]
        if view is not None and view.parallel and view.direction is not None:
            eye = [*space.direction(view.direction), 0.0]
        elif view is not None and view.position is not None:
            eye = [*space.position(view.position), 1.0]
        uniforms.SetUniform4f("vizEye", eye)
        material = scene.material
        ambient = scene.ambient_intensity * _ratio(material.ambient, prop.GetAmbient())
        color = [ambient * c for c in scene.ambient_color or WHITE]
        uniforms.SetUniform3f("vizAmbientGain", color)
        diffuse = _ratio(material.diffuse, prop.GetDiffuse())
        uniforms.SetUniformf("vizDiffuseGain", diffuse)
        # VTK has a specular colour only where it has lights of its own.
        shine = [material.specular * c for c in prop.GetSpecularColor()]
        uniforms.SetUniform3f("vizSpecularGain", shine)
        if plan.fur:
            # Fur of density 1 lets through what is less than any float.
            uniforms.SetUniformf("vizFurRate", float(np.log1p(-min(plan.fur, 1 - 1e-12))))
            uniforms.SetUniformf("vizTallest", self._tallest)
        cue = scene.depth_cue
        if cue is None or view is None or cue.front is None or cue.back is None:
            return
        axis = [0.0, 0.0, 0.0, 1.0]
        if view.direction is not None:
            axis = [*space.direction(view.direction), 0.0]
        uniforms.SetUniform4f("vizAxis", axis)
        uniforms.SetUniform3f("vizFrom", space.position(view.position or (0.0, 0.0, 0.0)))
        ends = [cue.front, cue.back, cue.front_scale, cue.back_scale]
        uniforms.SetUniform4f("vizCueEnds", ends)
        uniforms.SetUniform3f("vizCue", [cue.cue * c for c in cue.color or WHITE])


def _drawn_as(source: Source, stroke: Stroke) -> tuple[Layout, ShadingOptions]:
    """Return the layout and the options of a source, or of the cylinders of its lines."""
    if stroke.round:
        return Layout(normals=True), source.options.for_surface()
    return source.inputs.layout, source.options


def _plan(scene: Scene, source: Source, stroke: Stroke) -> Plan:
    """Return the plan of a source in its exact form."""
    layout, options = _drawn_as(source, stroke)
    options = dataclasses.replace(options, tolerance=0.0, highlight_error=0.0, components=False)
    return decide(scene, layout, options)


def _structure(scene: Scene, lights: Sequence[Light], source: Source) -> tuple[object, ...]:
    """Return what a shader holds as constants, in a form that can be compared."""
    material, cue = scene.material, scene.depth_cue
    return (
        [(light.position is None, light.attenuation == NO_ATTENUATION) for light in lights],
        material.diffuse > 0, material.specular > 0, material.shininess,
        None if cue is None else cue.smooth,
        source.inputs.layout, source.options, source.sided is None,
    )  # fmt: skip


def _ratio(wanted: float, shown: float) -> float:
    """Return what a coefficient of VTK, which is 1 at most, must be multiplied by."""
    return wanted / shown if shown > 0 else 0.0


def _rows(inputs: ShadingInputs, rows: ArraySource | None) -> Array | None:
    """Return unit vectors, one per point, also where several points share one."""
    if rows is None:
        return None
    unit = unit_rows(np.asarray(rows[0 : rows.shape[0]]).reshape(-1, 3))
    unit[~np.all(np.isfinite(unit), axis=1)] = 0
    return unit if len(unit) == inputs.count else np.repeat(unit, inputs.repeat, axis=0)


def _lean_lengths(source: Source, count: int) -> Array:
    """Return lengths of normals, which carry from 1 to 2 the lean from -1 to 1.

    A lean of 1 stands for points that no eye turns.
    """
    sided = source.sided
    assert sided is not None
    lean = np.zeros(count) if sided.lean is None else np.asarray(sided.lean, dtype=np.float64)
    turned = np.ones(count, dtype=np.bool_) & (True if source.facing == "eye" else sided.open)
    return np.where(turned, 1.5 + 0.5 * np.clip(lean, -1.0, 0.98), 2.0)


def _replace(
    actor: vtkActor, functions: str, body: str, plan: Plan, stroke: Stroke, *, turned: bool = False
) -> None:
    """Put the light of a plan in place of VTK's, in every shader of the pipeline."""
    names = [("vizP", "vec3", "(MCVCMatrix * vertexMC).xyz")]
    of_cylinder = stroke.round
    normal = (plan.surface and not of_cylinder) or plan.conditioned or bool(plan.fur)
    attributes = ""
    if normal:
        attributes += "in vec3 normalMC;\n"
        names.append(("vizN", "vec3", "normalMatrix * normalMC"))
    elif stroke != Stroke():
        attributes += "in vec3 normalMC;\n"
        names.append(strokes.ALONG)
    if plan.fur or turned:
        names.append(("vizH", "float", "length(normalMC) - 1.0"))
    if of_cylinder or not plan.surface:
        attributes += "in vec3 tangentMC;\n"
        # Tangents turn with the model, of whose matrix the normal matrix is the inverse transpose.
        names.append(("vizT", "vec3", "transpose(inverse(normalMatrix)) * tangentMC"))
    if of_cylinder:
        names.append(("vizX", "float", "0.0"))
    shader = actor.GetShaderProperty()
    shader.ClearAllShaderReplacements()
    strokes.pass_on(actor, names, attributes, stroke)
    given = "".join(f"in {kind} {name}VSOutput;\n" for name, kind, _ in names)
    if of_cylinder:
        given += "uniform mat4 MCDCMatrix;\n"
    read = "  vec3 vizP = vizPVSOutput;\n  bool vizGood = true;\n"
    for name in ("vizN", "vizT"):
        if f"{name}VSOutput" in given:
            read += (
                f"  float {name}Size = length({name}VSOutput);\n"
                f"  vizGood = vizGood && {name}Size > 1e-6;\n"
                f"  vec3 {name} = {name}VSOutput / max({name}Size, 1e-6);\n"
            )
    if of_cylinder:
        read += strokes.CYLINDER_NORMAL
    if turned:
        read += "  float vizLean = 2.0 * vizHVSOutput - 1.0;\n"
    if plan.fur:
        read += "  float vizHeight = vizTallest * max(vizHVSOutput, 0.0);\n"
    pixel = {
        "//VTK::Normal::Dec": given,
        "//VTK::Normal::Impl": "",
        "//VTK::Light::Dec": functions + "\n",
        "//VTK::Light::Impl": f"{read}{body}\n  gl_FragData[0] = vec4(vizColor, opacity);\n",
    }
    if stroke != Stroke():
        # The depth of VTK's own tubes.
        pixel["//VTK::Depth::Impl"] = ""
    for mark, text in pixel.items():
        shader.AddFragmentShaderReplacement(mark, True, text, False)
