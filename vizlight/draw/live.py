"""A drawn mesh with light that follows the camera: at its points, or in each fragment.

In fragments it is GLSL on an actor, from tangents and normals that VTK interpolates.
"""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Literal

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkCollection
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor, vtkCamera, vtkRenderer

from vizlight import _check
from vizlight._types import AnyArray, Array, Bools, Foreign, Indices, Keywords, Raw
from vizlight.draw import dialects, glsl, ground, strokes
from vizlight.draw.glsl import Stroke, Uniform
from vizlight.filters import lighting, relight
from vizlight.filters.relight import Source
from vizlight.filters.tint import light_on_colors, map_colors, values_of
from vizlight.mesh import blocks, records
from vizlight.model import kernels
from vizlight.scene import Light, Material, Scene, View
from vizlight.scene.conversion import LARGEST_POWER, is_light_kit, lights_of
from vizlight.scene.light import NO_ATTENUATION, WHITE, default_lights
from vizlight.shading.display import NO_DATA, Bytes, displayable, for_colors, on_colors
from vizlight.shading.engine import Shading
from vizlight.shading.inputs import ArraySource, Layout, ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.shading.plan import Plan, decide
from vizlight.vtk.arrays import are_colors, is_of_cells

#: Place where the light is computed.
LightAt = Literal["auto", "points", "fragments"]
#: Names of the arrays that the drawn copy of a mesh has beside the mesh's own.
LUMINANCE, COLORS, VALUES = "vizlight luminance", "vizlight colors", "vizlight values"
TANGENTS, NORMALS = "vizlight tangents", "vizlight normals"
#: Fragment shader that draws the colours of the points.
AS_IT_IS = dialects.Replacement(
    "Fragment", "//VTK::Light::Impl", "  gl_FragData[0] = vec4(vertexColorVSOutput.rgb, opacity);\n"
)


class Live:
    """A drawn mesh with light that follows the camera, the lights and the mesh.

    The light is an array of the points, the same numbers as a filter attaches; :class:`Fragments`
    computes it in each fragment. An observer of the actor keeps it alive, so that nothing is left
    once the actor is gone. The mesh of the source is the caller's. Without a scene the lights and
    the material of the plotter count, and with ``follow`` the camera takes the place of the view of
    the scene; ``reason`` says why the light is not computed in each fragment, empty where it is.
    """

    def __init__(
        self,
        source: relight.Source,
        scene: Scene | None,
        stroke: Stroke = Stroke(),  # noqa: B008 (a tuple is not changed)
        *,
        reason: str = "",
        follow: bool = True,
    ) -> None:
        self.source, self.scene, self.reason, self.follow = source, scene, reason, follow
        self.stroke = stroke
        # VTK takes normals from the mesh of cells where it extracts the outer surface itself.
        self._by_surface = not reason and not isinstance(source.mesh, pv.PolyData)
        self._shown: Indices | None = None
        #: Shallow copy of the mesh, or of its outer surface, that is drawn.
        self.drawn: pv.DataSet = pv.PolyData() if self._by_surface else source.mesh.copy(deep=False)
        self._redraw()
        #: Name of the mesh, for a page.
        self.name = ""
        #: Name of the drawn array that gives the colours, and of the one it is made of, or None.
        self.scalars: str | None = None
        self.given: str | None = None
        #: Component of that array that is coloured, None for one number or for lengths.
        self.component: int | None = None
        #: Whether its values are of cells and were averaged to the points.
        self.averaged = False
        self._changed = source.mesh.GetMTime()
        self._state: tuple[object, ...] = ()
        self._placed: tuple[tuple[float, ...], ShadingInputs] | None = None
        self._warned = False

    @property
    def n(self) -> int:
        """Dimension of the space of the light."""
        return int(self.source.inputs.points.shape[1])

    @property
    def own_eye(self) -> bool:
        """Whether the scene has an eye in n-space, which is not the camera's."""
        scene = self.scene
        return scene is not None and scene.view is not None and scene.n == self.n > 3

    def _redraw(self) -> None:
        """Draw the mesh as it is now."""
        mesh = self.source.mesh
        if self._by_surface:
            mesh, self._shown = blocks.outer_surface(mesh)
        self.drawn.shallow_copy(mesh)

    def picked(self, rows: AnyArray) -> AnyArray:
        """Return the rows of the points that are drawn, from one for each point of the mesh."""
        if self._shown is None:
            return rows
        return rows[self._shown]

    # Colours of data.

    def color_by(self, scalars: str, component: int | None) -> None:
        """Take the colours from an array of the mesh.

        Colours of cells are averaged where the light is at the points, with a warning.
        """
        self.given, self.component = scalars, component
        self.scalars = scalars
        self.averaged = bool(self.reason) and is_of_cells(self.source.mesh, scalars)
        if self.averaged:
            _check.warn(f"the colours of {scalars!r} are averaged from cells to points")
        self._color(self._values())

    def _values(self) -> Raw | None:
        """Return the values that are coloured; None for an array of the mesh as it is."""
        mesh, name = self.source.mesh, self.given
        if name is None or (is_of_cells(mesh, name) and not self.averaged):
            return None
        values = values_of(mesh, name, self.component)
        return values if self.averaged or mesh.point_data[name].ndim > 1 else None

    def _color(self, values: Raw | None) -> None:
        """Attach the values that are coloured, unless they are an array of the mesh."""
        if values is not None:
            self.scalars = VALUES
            records.attach_rows(self.drawn, VALUES, self.picked(values))

    def shown_values(self) -> Raw:
        """Return the values or colours that are drawn, one row per point or per cell."""
        name, points = self.scalars or "", self.drawn.point_data
        return np.asarray(points[name] if name in points else self.drawn.cell_data[name])

    def has_colors(self) -> bool:
        """Return whether the array that is drawn holds colours, not values."""
        return self.component is None and are_colors(self.shown_values())

    def lacks_values(self) -> bool:
        """Return whether any of the values that are coloured is NaN."""
        values = self.shown_values()
        return bool(values.dtype.kind == "f" and np.isnan(values).any())

    def mapped(self, actor: vtkActor) -> Bytes:
        """Return the colours of data as the mapper of an actor has them, or as they were given."""
        return map_colors(actor.GetMapper().GetLookupTable(), self.shown_values())

    # The actor.

    def attach(self) -> None:
        """Give the drawn mesh the arrays that the light of a new source needs."""
        count = self.drawn.n_points
        records.attach_rows(self.drawn, LUMINANCE, np.zeros(count))
        channels = 3 if self.scalars is None else 4
        kind = np.float64 if self.scalars is None else np.uint8
        records.attach_rows(self.drawn, COLORS, np.zeros((count, channels), kind))
        if self.stroke != Stroke():
            # VTK hands a shader no other vector of lines than their normals.
            along = strokes.directions(self.source.mesh, self.stroke.width)
            along = self.picked(along).astype(np.float32)
            records.attach_rows(self.drawn, NORMALS, along)
            self.drawn.GetPointData().SetActiveNormals(NORMALS)

    def drawing(self, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""
        if self.scalars is not None:
            return drawing | {"lighting": False}
        color = drawing.pop("color", None)
        if color is not None and self.scene is not None:
            channels = _check.color("color", color)
            material = dataclasses.replace(self.scene.material, color=channels)
            self.scene = self.scene.replace(material=material)
        plain = {"lighting": False, "show_scalar_bar": False}
        if self.scene is not None and not self.scene.colored:
            gray = {"scalars": LUMINANCE, "cmap": "gray", "clim": (0.0, 1.0)}
            return drawing | plain | gray
        base = True if color is None else color
        return drawing | plain | {"scalars": COLORS, "rgb": True, "color": base}

    def start(self, actor: vtkActor) -> None:
        """Let an actor draw lit colours as they are, in place of the data's."""
        prop = actor.GetProperty()
        # Without lights VTK multiplies by the sum of both coefficients, which are the material.
        as_it_is = [] if self.scene is not None else [AS_IT_IS]
        if self.stroke != Stroke():
            strokes.widen(actor, self.stroke, as_it_is)
        elif as_it_is:
            dialects.replace(actor, as_it_is)
        if self.scene is not None:
            # The colours are lit already: these coefficients show them as they are.
            prop.SetAmbient(1.0)
            prop.SetDiffuse(0.0)
        if self.scalars is None:
            return
        mapper = actor.GetMapper()
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(COLORS)
        mapper.SetColorModeToDirectScalars()
        mapper.SetInterpolateScalarsBeforeMapping(False)

    def show(self, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:  # noqa: ARG002
        """Show the light of a scene."""
        inputs = self.source.seen_from(scene.view, self.placed(actor))
        if self.scalars is not None:
            (light,) = light_on_colors([self.source._replace(inputs=inputs, sided=None)], scene)
            _write(self.drawn, COLORS, on_colors(self.mapped(actor), *light))
            return
        (shading,), _ = lighting.light([(inputs, self.source.options)], scene, progress_bar=False)
        if self.scene is None or self.scene.colored:
            _write(self.drawn, COLORS, on_screen(shading))
        else:
            _write(self.drawn, LUMINANCE, np.where(shading.valid, shading.luminance, NO_DATA[0]))

    def lit_as(self) -> tuple[Layout, ShadingOptions]:
        """Return the layout and the options of the light that is drawn."""
        return self.source.inputs.layout, self.source.options

    def explain(self, scene: Scene) -> str:
        """Return where the light is computed, and which terms are computed or skipped and why."""
        seen = scene if self.scalars is None else for_colors(scene)
        plan = decide(lighting.fit_depth_cue(seen, [self.source.inputs.points]), *self.lit_as())
        place = "at three places of each segment" if self._is_even(plan) else "in each fragment"
        where = f"light at the points: {self.reason}" if self.reason else f"light {place}"
        return f"{where}\n{plan.explain()}"

    def _is_even(self, plan: Plan) -> bool:
        """Return whether lines with halos have light that is smooth within each segment."""
        # Colours of data have no highlight.
        shines = plan.specular and self.scalars is None
        is_near = any(lamp.position is not None for lamp in plan.scene.lights)
        return (
            # Round lines have another light at each place across them.
            (self.stroke.halo > 0 and not self.stroke.round)
            # Highlights and the light of near lamps rise and fall within a segment.
            and not (shines or is_near)
            # Grey of points that cannot be lit reaches no farther than these.
            and not self.invalid()
        )

    def set_scene(self, scene: Scene, actor: vtkActor) -> None:
        """Take another scene, by which the next frame is lit."""
        if self.reason and self.source.inputs.shadow is not None:
            (self.source,), _ = relight.from_record(self.source.mesh, scene)
            self._placed = None
        self.scene, self._state = scene, ()
        self.start(actor)

    def invalid(self) -> int:
        """Return the number of points with vectors that have no direction."""
        # Points inside a volume, which are not drawn, have no normal.
        seen = self._shown
        good: Bools = np.ones(1, dtype=np.bool_)
        for rows in (self.source.inputs.tangents, self.source.inputs.normals):
            if rows is not None and rows.shape[0] == self.source.inputs.rows:
                vectors = np.asarray(rows[:] if seen is None else rows[:][seen])
                vectors = vectors.reshape(len(vectors), -1)
                good = good & np.any(vectors, axis=1) & np.all(np.isfinite(vectors), axis=1)
        unlit = int(np.count_nonzero(~good)) - (self.source.inside if seen is None else 0)
        return max(unlit, 0) * self.source.inputs.repeat

    # What changes from frame to frame.

    def update(self, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Light the mesh anew if anything has changed since; called before a frame is drawn.

        Data that cannot be lit keep the light they have, with one warning.
        """
        state = self._state_of(renderer, actor)
        if state == self._state:
            return
        try:
            self._read(renderer, actor)
            self.paint(renderer, actor)
            self._warned = False
        except (KeyError, TypeError, ValueError) as error:
            if not self._warned:
                self._warned = True
                _check.warn(f"the mesh keeps the light that it has: {error}")
        # Painting itself changes the actor.
        self._state = self._state_of(renderer, actor)

    def paint(self, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Show the light of the scene of a frame, dimmed where its lights are now."""
        scene = self.scene_of(renderer, actor)
        source = self.source.dimmed_by(scene)
        if source is not self.source:
            self.source, self._placed = source, None
        self.show(scene, renderer, actor)
        if self.stroke != Stroke():
            strokes.adapt(actor, renderer, self.stroke, of_data=self.scalars is not None)

    def _state_of(self, renderer: vtkRenderer, actor: vtkActor) -> tuple[object, ...]:
        """Return the state on which the light depends, in a form that can be compared."""
        camera, mapper = renderer.GetActiveCamera(), actor.GetMapper()
        # The address is there because another camera may have the same time of change.
        state: list[object] = [camera.GetAddressAsString(""), camera.GetMTime()]
        state += [self.source.mesh.GetMTime(), _elements(actor)]
        if self.stroke != Stroke():
            state += [renderer.GetBackground(), strokes.has_pass(renderer.GetPass(), "vtkSSAAPass")]
        if self.scene is None:
            lights = renderer.GetLights()
            state += [lights.GetMTime(), *(light.GetMTime() for light in items(lights))]
            state.append(actor.GetProperty().GetMTime())
        if self.scalars is not None:
            table = mapper.GetLookupTable()
            state += [table.GetMTime(), *mapper.GetScalarRange()]
        return tuple(state)

    def _read(self, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Read the mesh again after it has changed."""
        mesh, named = self.source.mesh, self.source.named
        if mesh.GetMTime() == self._changed:
            return
        # Taken before the work, so that a mesh that cannot be lit is not read again in each frame.
        self._changed = mesh.GetMTime()
        # What cannot be lit or coloured any more stays as it is drawn.
        source, values = self.source, self._values()
        if named is not None:
            scene = self.scene_of(renderer, actor)
            if self.scene is None:
                # Shares of light inside a bundle belong to the lights of each frame.
                fixed = [light.seen_from(scene.view) for light in scene.lights]
                scene = scene.replace(lights=fixed)
            source = relight.read(mesh, "", scene, named)
            relight.refuse_following([source], scene)
        self.source, self._placed = source, None
        self._redraw()
        self._color(values)
        self.attach()

    def scene_of(self, renderer: vtkRenderer, actor: vtkActor) -> Scene:
        """Return the scene of a frame, in the space of the light."""
        if self.scene is None:
            with warnings.catch_warnings():
                # They were given when the mesh was added.
                warnings.simplefilter("ignore", UserWarning)
                return lifted(scene_of(renderer, actor, self.source.options.model), self.n)
        if self.own_eye or not self.follow:
            return self.scene
        view = View.from_camera(renderer.GetActiveCamera())
        if self.scene.n in (None, 3):
            return lifted(self.scene.replace(view=view), self.n)
        if self.scene.n != self.n:
            # The plan names what does not fit.
            return self.scene
        return self.scene.replace(view=_lifted_view(view, self.n))

    def placed(self, actor: vtkActor) -> ShadingInputs:
        """Return the inputs of the light where the actor stands."""
        elements = _elements(actor)
        matrix = np.reshape(elements, (4, 4))
        if self.n != 3 or np.array_equal(matrix, np.eye(4)):
            return self.source.inputs
        if self._placed is None or self._placed[0] != elements:
            self._placed = elements, _transformed(self.source.inputs, matrix)
        return self._placed[1]


def scene_of(renderer: vtkRenderer, actor: vtkActor, model: str) -> Scene:
    """Return the scene of a renderer: its lights, its camera and the material of an actor.

    Lights that are as PyVista sets them stand for the lights of ``Scene()``.
    """
    camera = renderer.GetActiveCamera()
    view = View.from_camera(camera)
    # PyVista's default lights are a kit for plain shading; ours stand in for it.
    lamps = list(items(renderer.GetLights()))
    lights = default_lights(view) if is_light_kit(lamps) else tuple(lights_of(lamps, camera))
    kind = "phong" if model == "phong" else "blinn"
    prop = actor.GetProperty()
    material = Material.from_property(prop, lights=lights, view=view, model=kind)
    return Scene(lights=lights, material=material, view=view)


def on_screen(shading: Shading) -> Array:
    """Return light as colours of a screen, and the colour of missing values where it has none."""
    rgb = shading.luminance[:, np.newaxis] if shading.rgb is None else shading.rgb
    # VTK wraps around above 1, so a bright highlight would turn black.
    shown = displayable(np.broadcast_to(rgb, (len(rgb), 3)))
    shown[~shading.valid] = NO_DATA
    return shown


def _write(mesh: pv.DataSet, name: str, values: Raw) -> None:
    """Write values to an array of a mesh, in place where they fit."""
    array = mesh.point_data[name]
    if array.shape != values.shape or array.dtype != values.dtype:
        records.attach_rows(mesh, name, values)
        return
    np.copyto(array, values)
    mesh.GetPointData().GetAbstractArray(name).Modified()
    mesh.Modified()


def items(collection: vtkCollection) -> Iterator[Foreign]:
    """Yield the items of a collection of VTK."""
    for i in range(collection.GetNumberOfItems()):
        yield collection.GetItemAsObject(i)


def draws_light(actor: vtkActor) -> bool:
    """Return whether an actor draws the mesh that was made for a live light."""
    mapper: Foreign = actor.GetMapper()
    data: Foreign = None if mapper is None else mapper.GetInputDataObject(0, 0)
    arrays = data.GetPointData() if hasattr(data, "GetPointData") else None
    return arrays is not None and any(map(arrays.HasArray, (NORMALS, TANGENTS, COLORS)))


def matrix_of(matrix: vtkMatrix4x4) -> Array:
    """Return a matrix of VTK in float64."""
    return np.asarray(pv.array_from_vtkmatrix(matrix), np.float64)


def in_view(camera: vtkCamera, aspect: float, points: Array) -> tuple[Array, Bools]:
    """Return where points are in the view of a camera, and which of them are in front of the eye.

    ``aspect`` is the width of the picture by its height. Places (N, 3) are from -1 to 1 to the
    right, up, and from the near plane to the far one; of no meaning behind the eye.
    """
    matrix = matrix_of(camera.GetCompositeProjectionTransformMatrix(aspect, -1, 1))
    whole = points @ matrix[:, :3].T + matrix[:, 3]
    front = whole[:, 3] > 0
    return whole[:, :3] / np.where(front, whole[:, 3], 1)[:, np.newaxis], front


def lifted(scene: Scene, n: int) -> Scene:
    """Return a scene of 3-space in the hyperplane of the first three axes of n-space."""
    # Without a rotation the picture shows the first three axes, so lamps and eye stand there too.
    if n <= 3 or scene.n != 3:
        return scene
    # A lamp beside the eye has its direction in the eye's frame of three axes, so it is fixed
    # before zeros are put behind.
    fixed = (light if light.is_headlight else light.seen_from(scene.view) for light in scene.lights)
    lights = tuple(
        dataclasses.replace(light, **_padded(light, ("direction", "position"), n))
        for light in fixed
    )
    view = None if scene.view is None else _lifted_view(scene.view, n)
    return scene.replace(lights=lights, view=view)


def _lifted_view(view: View, n: int) -> View:
    return View(parallel=view.parallel, **_padded(view, ("position", "direction", "up"), n))


def _padded(thing: object, names: tuple[str, ...], n: int) -> Keywords:
    """Return vectors of a light or a view by name, with zeros along the further axes."""
    padded: Keywords = {}
    for name in names:
        vector = getattr(thing, name)
        padded[name] = None if vector is None else (*vector, *([0.0] * (n - len(vector))))
    return padded


def _elements(actor: vtkActor) -> tuple[float, ...]:
    """Return the matrix by which an actor is placed, row after row."""
    return tuple(matrix_of(actor.GetMatrix()).ravel().tolist())


def _transformed(inputs: ShadingInputs, matrix: Array) -> ShadingInputs:
    """Return inputs in 3-space moved by a matrix; normals stay across the surface."""
    # Points move by the matrix, tangents by its linear part, normals by the inverse transpose
    # (here on the right, as rows), so that they stay across a surface that is scaled unevenly.
    linear, offset = matrix[:3, :3], matrix[:3, 3]
    points = np.asarray(inputs.points[:], dtype=np.float64) @ linear.T + offset
    tangents = normals = None
    if inputs.tangents is not None:
        rows = np.asarray(inputs.tangents[:])
        tangents = (rows.reshape(-1, 3) @ linear.T).astype(rows.dtype).reshape(rows.shape)
    if inputs.normals is not None:
        rows = np.asarray(inputs.normals[:])
        normals = (rows @ np.linalg.inv(linear)).astype(rows.dtype)
    return dataclasses.replace(inputs, points=points, tangents=tangents, normals=normals)


#: Share of the edges along which the tangent may reverse before its sign counts as arbitrary.
REVERSED = 0.02


def unfit(
    source: Source,
    stroke: Stroke = Stroke(),  # noqa: B008 (a tuple is not changed)
    *,
    cast: bool = False,
) -> str:
    """Return why a source cannot be lit in each fragment, or an empty string.

    With ``cast`` a height field casts its shadow in each fragment, which takes longer than the rest
    of the light.
    """
    inputs, options = source.inputs, source.options
    layout = inputs.layout
    if layout.shadowed and cast:
        if source.field is None:
            return f"t of the cos-theta shadow is known at the points: {source.uncast}"
        layout = layout._replace(shadowed=False)
    alone = layout._replace(normals=False, dimmed=False, occluded=False) == Layout(k=1)
    # A round line has the normals of a cylinder, made in the shader: there is no room for others.
    if stroke.round and (options.conditioned or not alone):
        return "only lines that are lit by their tangents alone can be round"
    if stroke.width is not None and layout.normals:
        return "the widths of lines at their points take the place of normals"
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
    # More than 120 degrees from one point to the next is a change of sign, not a bend.
    return bool(np.count_nonzero(cosine < -0.5) > REVERSED * len(starts))


def _edges(mesh: pv.DataSet) -> tuple[Indices, Indices]:
    """Return the points at both ends of consecutive corners of the cells that are drawn."""
    if not isinstance(mesh, pv.PolyData):
        shell, ids = blocks.outer_surface(mesh)
        starts, ends = (ids[corners] for corners in _edges(shell))
        return starts, ends
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
    """A drawn mesh with light computed in each fragment, from interpolated vectors.

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
            carried = carried + glsl.LENGTHS * less[:, np.newaxis] * kernels.unit_rows(carried)
        if carried is not None:
            records.attach_rows(self.drawn, TANGENTS, carried.astype(np.float32))
            self.drawn.GetPointData().SetActiveTangents(TANGENTS)
        if normals is None:
            # VTK lights lines, and so draws with a shader for them, only if they have normals.
            normals = tangents
            # A stroke is widened across the line's own direction, whatever the light takes for its
            # tangent.
            if self.stroke != Stroke():
                along = strokes.directions(self.source.mesh, self.stroke.width)
                normals = self.picked(along)
        else:
            normals = normals * self._lengths()
        if normals is not None:
            records.attach_rows(self.drawn, NORMALS, normals.astype(np.float32))
            self.drawn.GetPointData().SetActiveNormals(NORMALS)

    def _picked(self, rows: ArraySource | None) -> Array | None:
        return _unit(self.source.inputs, rows, self.picked)

    def _lengths(self) -> Array:
        """Return the values in the lengths of normals, which light does not need: fur, or a lean.

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
        # The lengths of leans end just below 2, which stands for points that no eye turns.
        length = 1.5 + 0.5 * np.clip(0.0 if lean is None else lean, -1.0, 0.98)
        return self.picked(np.where(turned, length, 2.0))[:, np.newaxis]

    def drawing(self, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""
        drawing = drawing | {"lighting": True}
        if self.scalars is None:
            of_scene = None if self.scene is None else (self.scene.material.color or WHITE)
            color = drawing.get("color")
            self._colored = color is None
            # A texture multiplies the actor's colour: white leaves it as it is.
            usual = WHITE if drawing.get("texture") is not None else True
            drawing["color"] = (usual if of_scene is None else of_scene) if color is None else color
        return drawing

    def start(self, actor: vtkActor) -> None:
        """Give an actor the material of the scene, as far as VTK can have it."""
        prop = actor.GetProperty()
        prop.SetInterpolationToPhong()
        if self.source.field is not None and prop.GetTexture(glsl.HEIGHTS) is None:
            ground.attach(actor, self.source.field)
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
        scene = lighting.fit_depth_cue(scene, [placed.points])
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
        numbers = glsl.numbers(scene, lights, *shown, fur=plan.fur, tallest=self.tallest, data=data)
        if self.source.field is not None:
            numbers += ground.numbers(self.source.field, np.reshape(_elements(actor), (4, 4)))
        if renew:
            turned = self.source.sided is not None
            written = glsl.write(plan, turned=turned, stroke=self.stroke, data=data)
            texts = dialects.VTK.replacements(written, numbers)
            if self.stroke != Stroke():
                even = numbers if self._is_even(plan) else ()
                texts = strokes.widened(actor, texts, self.stroke, even)
            dialects.replace(actor, texts)
            self._key, self._plan = key, plan
        _set_uniforms(numbers, renderer, actor)

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
        if self.stroke.round:
            layout, options = Layout(normals=True, occluded=layout.occluded), options.for_surface()
        return layout, options


def _structure(scene: Scene, lights: Sequence[Light], source: Source) -> tuple[object, ...]:
    """Return the constants of a shader, in a form that can be compared."""
    material, cue = scene.material, scene.depth_cue
    return (
        [(light.position is None, light.attenuation == NO_ATTENUATION) for light in lights],
        material.diffuse > 0, material.specular > 0, glsl.is_plain(material.shininess),
        None if cue is None else cue.smooth, scene.exposure,
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


def _set_uniforms(inputs: Iterable[Uniform], renderer: vtkRenderer, actor: vtkActor) -> None:
    """Set the numbers of a program, in the coordinates of the camera."""
    # VTK lights in view coordinates, where the eye is at the origin: float32 holds these well even
    # if the mesh is far from the origin of the world.
    view = matrix_of(renderer.GetActiveCamera().GetViewTransformMatrix())
    uniforms = actor.GetShaderProperty().GetFragmentCustomUniforms()
    for name, kind, value, space in inputs:
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
