"""Light in each fragment: GLSL on an actor, from tangents and normals that VTK interpolates."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.draw import dialects, glsl, program
from vizlight.draw.live import NORMALS, TANGENTS, Live, matrix_of
from vizlight.draw.program import Stroke
from vizlight.filters import lighting
from vizlight.mesh import blocks, records
from vizlight.model import kernels
from vizlight.scene.conversion import LARGEST_POWER
from vizlight.scene.light import NO_ATTENUATION, WHITE
from vizlight.shading.decide import decide
from vizlight.shading.inputs import Layout
from vizlight.vtk import polylines

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Bools, Indices, Keywords
    from vizlight.draw.program import Uniform
    from vizlight.filters.relight import Source
    from vizlight.scene import Light, Scene, View
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.options import ShadingOptions
    from vizlight.shading.plan import Plan

#: Share of the edges along which the tangent may reverse before its sign counts as arbitrary.
REVERSED = 0.02


def unfit(source: Source, stroke: Stroke = Stroke()) -> str:  # noqa: B008 (a tuple is not changed)
    """Return why a source cannot be lit in each fragment, or an empty string.

    Parameters
    ----------
    source : Source
    stroke : Stroke
        How its lines are drawn.

    Returns
    -------
    str
    """
    inputs, options = source.inputs, source.options
    layout = inputs.layout
    alone = layout._replace(normals=False, dimmed=False, occluded=False) == Layout(k=1)
    # A round line has the normals of a cylinder, made in the shader: there is no room for others.
    if stroke.round and (options.conditioned or not alone):
        return "only lines that are lit by their tangents alone can be round"
    reason = unfit_layout(layout, options, stroke)
    lines = inputs.tangents is not None and inputs.dimensions is None
    # Between opposite tangents the interpolated one passes through 0 and tells no direction.
    if not reason and lines and _reverses(inputs, source.mesh):
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
    tangents = _unit(inputs, inputs.tangents)
    starts, ends = _edges(mesh)
    if tangents is None or not len(starts):
        return False
    cosine = np.einsum("ij,ij->i", tangents[starts], tangents[ends])
    return bool(np.count_nonzero(cosine < -0.5) > REVERSED * len(starts))


def _edges(mesh: pv.DataSet) -> tuple[Indices, Indices]:
    """Return the points at both ends of consecutive corners of the cells that are drawn."""
    if not isinstance(mesh, pv.PolyData):
        shell, ids = blocks.outer_surface(mesh)
        starts, ends = (ids[corners] for corners in _edges(shell))
        inside = (starts >= 0) & (ends >= 0)
        return starts[inside], ends[inside]
    pairs = []
    for cells in (mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray())
        # The last corner of a cell has no next one: cells follow each other in one list of
        # corners.
        inside = np.ones(len(ids), dtype=np.bool_)
        inside[pv.convert_array(cells.GetOffsetsArray())[1:] - 1] = False
        first = np.flatnonzero(inside)
        pairs.append((ids[first], ids[first + 1]))
    starts, ends = (np.concatenate(side) for side in zip(*pairs, strict=True))
    return starts, ends


class Fragments(Live):
    """A drawn mesh whose light is computed in each fragment, from interpolated vectors.

    They are the active tangents and normals of the drawn mesh, so that PyVista's own mapper is
    kept, with its colours and its scalar bar.
    """

    _key: object = None
    _plan: Plan | None = None
    #: Whether the colour is the material's.
    _colored = False
    #: Height of the fur whose normal has the length 2.
    tallest = 0.0
    #: Height fields that the eye sees from behind.
    _averted: Bools = np.zeros(0, dtype=np.bool_)

    def attach(self) -> None:
        """Give the drawn mesh its tangents and normals, of unit length in float32."""
        inputs = self.source.inputs
        tangents, normals = self._picked(inputs.tangents), self._picked(inputs.normals)
        carried = tangents
        if inputs.occlusion is not None:
            # The length of a tangent, which a surface does not have, carries the ambient share.
            share = self.picked(np.asarray(inputs.occlusion[:], dtype=np.float64))
            # From 1 to 2, never 0: a vector of length 0 would lose its direction between points.
            share = 1 + np.where(share >= 0, share, 1.0)
            along = np.array([[1.0, 0.0, 0.0]]) if tangents is None else tangents
            carried = share[:, np.newaxis] * along
        if inputs.dimensions is not None and carried is not None:
            # Two numbers in one length: the share in 0 to 1 above a step of LENGTHS for the
            # dimension.
            less = 2 - self.picked(np.asarray(inputs.dimensions[:]))
            carried = carried + program.LENGTHS * less[:, np.newaxis] * kernels.unit_rows(carried)
        if carried is not None:
            records.attach_rows(self.drawn, TANGENTS, carried.astype(np.float32))
            self.drawn.GetPointData().SetActiveTangents(TANGENTS)
        if normals is None:
            # VTK lights lines, and so draws with a shader for them, only if they have normals.
            normals = tangents
            # A stroke is widened across the line's own direction, whatever the light takes for its
            # tangent.
            if self._stroke != Stroke():
                normals = self.picked(polylines.line_tangents(self.source.mesh))
        else:
            normals = normals * self._lengths()
        if normals is not None:
            records.attach_rows(self.drawn, NORMALS, normals.astype(np.float32))
            self.drawn.GetPointData().SetActiveNormals(NORMALS)

    def _picked(self, rows: ArraySource | None) -> Array | None:
        return _unit(self.source.inputs, rows, self.picked)

    def _lengths(self) -> Array:
        """Return what lengths of normals, which light does not need, carry: fur, or a lean.

        A lean from -1 to 1, by which a normal may point away from the eye that sees its side, is
        carried as 1 to 2; 2 stands for points that no eye turns.
        """
        source = self.source
        if source.inputs.fur_height is not None:
            height = self.picked(np.asarray(source.inputs.fur_height[:], dtype=np.float64))
            self.tallest = float(np.max(height, initial=0.0)) or 1.0
            return 1 + height[:, np.newaxis] / self.tallest
        sided = source.sided
        if sided is None:
            return np.ones((1, 1))
        # Before the first frame there is no eye: height fields are then taken as seen from above.
        if len(self._averted) <= np.max(sided.open, initial=1):
            self._averted = sided.averted_fields(source.inputs.points, None)
        lean = sided.leaning(source.facing, self._averted)
        turned = (sided.facts()[:, 1] > 0) | (source.facing == "eye")
        length = 1.5 + 0.5 * np.clip(0.0 if lean is None else lean, -1.0, 0.98)
        return self.picked(np.where(turned, length, 2.0))[:, np.newaxis]

    def drawing(self, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""
        drawing = drawing | {"lighting": True}
        if self.scalars is None:
            own = None if self.scene is None else (self.scene.material.color or WHITE)
            given = drawing.get("color")
            self._colored = given is None
            # A texture multiplies the actor's colour: white leaves it as it is.
            usual = WHITE if drawing.get("texture") is not None else True
            drawing["color"] = (usual if own is None else own) if given is None else given
        return drawing

    def start(self, actor: vtkActor) -> None:
        """Give an actor the material of the scene, as far as VTK can have it."""
        prop = actor.GetProperty()
        prop.SetInterpolationToPhong()
        if self.scene is None:
            return
        material = self.scene.material
        if self._colored:
            prop.SetColor(*(material.color or WHITE))
        # VTK clamps coefficients to 1 and shininess to its own largest; the rest is a uniform, a
        # gain.
        prop.SetAmbient(min(material.ambient, 1.0))
        prop.SetDiffuse(min(material.diffuse, 1.0))
        prop.SetSpecular(min(material.specular, 1.0))
        prop.SetSpecularPower(min(material.shininess, LARGEST_POWER))
        prop.SetSpecularColor(*(material.specular_color or WHITE))

    def show(self, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Write the shader of a scene if it is another one, and set its uniforms."""
        placed = self.placed(actor)
        # The camera may have crossed to the other side of a height field.
        self.see(placed, scene.view)
        scene = lighting.fit_depth_cue(scene, [placed])
        data = self.scalars is not None
        lights = [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]
        # A new text costs a compilation, some 0.1 s; moved lamps and cameras only set uniforms.
        key, prop = _structure(scene, lights, self.source), actor.GetProperty()
        plan = self._plan
        renew = key != self._key or plan is None
        if plan is None or renew:
            plan = decide(scene, *self.lit_as())
        # VTK has a specular colour only where it has lights of its own.
        shown = prop.GetAmbient(), prop.GetDiffuse(), prop.GetSpecularColor()
        given = program.numbers(
            scene, lights, *shown, fur=plan.fur, tallest=self.tallest, data=data
        )
        if renew:
            turned = self.source.sided is not None
            written = program.write(plan, turned=turned, stroke=self._stroke, data=data)
            texts = dialects.VTK.replacements(written, given)
            if self._stroke != Stroke():
                texts = dialects.widened(actor, texts, self._stroke)
            dialects.replace(actor, texts)
            self._key, self._plan = key, plan
        _set_uniforms(given, renderer, actor)

    def see(self, placed: ShadingInputs, view: View | None) -> None:
        """Attach normals that tell which side of height fields an eye sees, if it is another."""
        sided = self.source.sided
        if sided is None or placed.normals is None:
            return
        vectors = np.asarray(placed.normals[:])
        averted = dataclasses.replace(sided, vectors=vectors).averted_fields(placed.points, view)
        if not np.array_equal(averted, self._averted):
            self._averted = averted
            self.attach()

    def lit_as(self) -> tuple[Layout, ShadingOptions]:
        """Return the layout and the options of a source, or of the cylinders of its lines."""
        source, layout = self.source, self.source.inputs.layout
        options = dataclasses.replace(source.options, components=False)
        if self._stroke.round:
            layout, options = Layout(normals=True, occluded=layout.occluded), options.for_surface()
        return layout, options


def _structure(scene: Scene, lights: Sequence[Light], source: Source) -> tuple[object, ...]:
    """Return what a shader holds as constants, in a form that can be compared."""
    material, cue = scene.material, scene.depth_cue
    return (
        [(light.position is None, light.attenuation == NO_ATTENUATION) for light in lights],
        material.diffuse > 0, material.specular > 0, glsl.is_plain(material.shininess),
        None if cue is None else cue.smooth,
        source.inputs.layout, source.options, source.sided is None,
    )  # fmt: skip


def _unit(
    inputs: ShadingInputs, rows: ArraySource | None, picked: Callable[[Array], Array] | None = None
) -> Array | None:
    """Return unit vectors, one per point or per point that is picked; of length 0 for none."""
    if rows is None:
        return None
    vectors = np.asarray(rows[0 : rows.shape[0]]).reshape(-1, 3)
    if len(vectors) != inputs.count:
        vectors = np.repeat(vectors, inputs.repeat, axis=0)
    unit = kernels.unit_rows(vectors if picked is None else picked(vectors))
    unit[~np.all(np.isfinite(unit), axis=1)] = 0
    return unit


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
