"""What keeps a drawn mesh lit: its source, its scene at a moment, and what has changed since."""

from __future__ import annotations

import dataclasses
import warnings
from typing import TYPE_CHECKING, Literal, Protocol, TypeVar

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters import relight
from vizlight.filters.tint import are_colors, values_of
from vizlight.mesh import blocks, records
from vizlight.scene import Material, Scene, View
from vizlight.scene.conversion import is_light_kit, lights_of
from vizlight.scene.light import default_lights

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray
    from vtkmodules.vtkCommonCore import vtkCollection
    from vtkmodules.vtkCommonMath import vtkMatrix4x4
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Bools, Foreign, Indices, Keywords, Vector
    from vizlight.shading.inputs import ShadingInputs

Number = TypeVar("Number", bound=np.generic)
#: Place where the light is computed.
LightAt = Literal["auto", "points", "fragments"]
#: Names of the arrays that the drawn copy of a mesh has beside the mesh's own.
LUMINANCE, COLORS, VALUES = "vizlight luminance", "vizlight colors", "vizlight values"
TANGENTS, NORMALS = "vizlight tangents", "vizlight normals"


class Painter(Protocol):
    """The way in which a drawn mesh shows its light."""

    #: Name of the way: "points" or "fragments".
    light: str

    def attach(self, live: Live) -> None:
        """Give the drawn mesh the arrays that a new source needs."""

    def drawing(self, live: Live, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""

    def start(self, live: Live, actor: vtkActor) -> None:
        """Prepare an actor that was just made."""

    def paint(self, live: Live, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Show the light of a scene."""

    def explain(self, live: Live, scene: Scene) -> str:
        """Return what is computed, and what is skipped and why."""


class Live:
    """A drawn mesh whose light follows the camera, the lights and the mesh.

    An observer of the actor keeps it alive, so that nothing is left once the actor is gone.

    Parameters
    ----------
    source : Source
        What is lit. Its mesh is the caller's.
    scene : Scene or None
        Scene; None for the lights and the material of the plotter.
    painter : Painter
        How its light is shown.
    follow : bool, default: True
        Whether the camera takes the place of the view of the scene.
    """

    def __init__(
        self, source: relight.Source, scene: Scene | None, painter: Painter, *, follow: bool = True
    ) -> None:
        self.source, self.scene, self.painter, self.follow = source, scene, painter, follow
        # VTK takes normals from the mesh of cells where it extracts the outer surface itself.
        of_cells = not isinstance(source.mesh, pv.PolyData)
        self._by_surface = painter.light == "fragments" and of_cells
        self._shown: Indices | None = None
        #: Shallow copy of the mesh, or of its outer surface, that is drawn.
        self.drawn: pv.DataSet = pv.PolyData() if self._by_surface else source.mesh.copy(deep=False)
        self._redraw()
        #: Name of the mesh, for a page.
        self.name = ""
        #: Name of the drawn array that gives the colours, and of the one it is made of, or None.
        self.scalars: str | None = None
        self.given: str | None = None
        self._component: int | None = None
        self._of_cells = self._averaged = False
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

    def picked(self, rows: NDArray[Number]) -> NDArray[Number]:
        """Return the rows of the points that are drawn, from one for each point of the mesh."""
        if self._shown is None:
            return rows
        # A control point of a curved cell, which has no index, is not lit.
        missing, rows = self._shown < 0, rows[self._shown]
        rows[missing] = 0
        return rows

    def attach(self, name: str, rows: NDArray[np.generic]) -> None:
        """Attach one row for each point of the mesh to what is drawn."""
        records.attach_rows(self.drawn, name, self.picked(rows))

    def color_by(self, scalars: str, component: int | None, *, at_points: bool) -> None:
        """Take the colours from an array of the mesh.

        Colours of cells are averaged where the light is at the points, with a warning.

        Raises
        ------
        TypeError, ValueError
            If there is no such array.
        """
        self.given, self._component = scalars, component
        self.scalars = scalars
        mesh = self.source.mesh
        self._of_cells = scalars in mesh.cell_data and scalars not in mesh.point_data
        self._averaged = self._of_cells and at_points
        if self._averaged:
            _check.warn(f"the colours of {scalars!r} are averaged from cells to points")
        self._color(self._values())

    def _values(self) -> NDArray[np.generic] | None:
        """Return the values that are coloured; None for an array of the mesh as it is."""
        if self.given is None or (self._of_cells and not self._averaged):
            return None
        mesh = self.source.mesh
        if self._averaged:
            mesh = _at_points(mesh, self.given)
        values = values_of(mesh, self.given, self._component)
        return values if self._averaged or mesh.point_data[self.given].ndim > 1 else None

    def _color(self, values: NDArray[np.generic] | None) -> None:
        """Attach the values that are coloured, unless they are an array of the mesh."""
        if values is not None:
            self.scalars = VALUES
            self.attach(VALUES, values)

    def has_colors(self) -> bool:
        """Return whether the array that is drawn holds colours, not values."""
        name, points = self.scalars or "", self.drawn.point_data
        values = points[name] if name in points else self.drawn.cell_data[name]
        return self._component is None and are_colors(np.asarray(values))

    def set_scene(self, scene: Scene, actor: vtkActor) -> None:
        """Take another scene, by which the next frame is lit."""
        self.scene, self._state = scene, ()
        self.painter.start(self, actor)

    def invalid(self) -> int:
        """Return the number of points whose vectors have no direction."""
        # Points inside a volume, which are not drawn, have no normal.
        seen = None if self._shown is None else self._shown[self._shown >= 0]
        good: Bools = np.ones(1, dtype=np.bool_)
        for rows in (self.source.inputs.tangents, self.source.inputs.normals):
            if rows is not None and rows.shape[0] == self.source.inputs.rows:
                vectors = np.asarray(rows[:] if seen is None else rows[:][seen])
                vectors = vectors.reshape(len(vectors), -1)
                good = good & np.any(vectors, axis=1) & np.all(np.isfinite(vectors), axis=1)
        unlit = int(np.count_nonzero(~good)) - (self.source.inside if seen is None else 0)
        return max(unlit, 0) * self.source.inputs.repeat

    def lacks_values(self) -> bool:
        """Return whether any of the values that are coloured is NaN."""
        at_cells = self._of_cells and not self._averaged
        data = self.source.mesh.cell_data if at_cells else self.drawn.point_data
        values = np.asarray(data[self.scalars or ""])
        return bool(values.dtype.kind == "f" and np.isnan(values).any())

    def update(self, renderer: vtkRenderer, actor: vtkActor) -> None:
        """Light the mesh anew if anything has changed since; called before a frame is drawn.

        What cannot be lit keeps the light it has, with one warning.
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
        """Show the light of the scene of a frame, dimmed where its lights are now.

        Raises
        ------
        TypeError, ValueError
            If the scene does not fit.
        """
        scene = self.scene_of(renderer, actor)
        source = self.source.dimmed_by(scene)
        if source is not self.source:
            self.source, self._placed = source, None
        self.painter.paint(self, scene, renderer, actor)

    def _state_of(self, renderer: vtkRenderer, actor: vtkActor) -> tuple[object, ...]:
        """Return what the light depends on, in a form that can be compared."""
        camera, mapper = renderer.GetActiveCamera(), actor.GetMapper()
        state: list[object] = [
            camera.GetAddressAsString(""), camera.GetMTime(), self.source.mesh.GetMTime(),
            _elements(actor),
        ]  # fmt: skip
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
        self.source, self._placed = source, None
        self._redraw()
        self._color(values)
        self.painter.attach(self)

    def scene_of(self, renderer: vtkRenderer, actor: vtkActor) -> Scene:
        """Return the scene of a frame, in the space of the light."""
        camera = renderer.GetActiveCamera()
        if self.scene is not None and not self.follow:
            return self.scene
        view = View.from_camera(camera)
        if self.scene is None:
            with warnings.catch_warnings():
                # They were given when the mesh was added.
                warnings.simplefilter("ignore", UserWarning)
                return lifted(scene_of(renderer, actor, self.source.options.model), self.n)
        if self.own_eye:
            return self.scene
        if self.scene.n in (None, 3):
            return lifted(self.scene.replace(view=view), self.n)
        if self.scene.n != self.n:
            # The plan names what does not fit.
            return self.scene
        return self.scene.replace(view=_lifted_view(view, self.n))

    def placed(self, actor: vtkActor) -> ShadingInputs:
        """Return the inputs of the light where the actor stands."""
        elements = _elements(actor)
        inputs = self.source.inputs
        if self.n != 3 or np.array_equal(np.reshape(elements, (4, 4)), np.eye(4)):
            return inputs
        if self._placed is None or self._placed[0] != elements:
            self._placed = elements, _transformed(inputs, np.reshape(elements, (4, 4)))
        return self._placed[1]


def scene_of(renderer: vtkRenderer, actor: vtkActor, model: str) -> Scene:
    """Return the scene of a renderer: its lights, its camera and the material of an actor.

    Lights that are as PyVista sets them stand for the lights of ``Scene()``.
    """
    camera = renderer.GetActiveCamera()
    view = View.from_camera(camera)
    # PyVista's default lights are a kit for plain shading; ours stand in for it.
    given = list(items(renderer.GetLights()))
    lights = default_lights(view) if is_light_kit(given) else tuple(lights_of(given, camera))
    kind = "phong" if model == "phong" else "blinn"
    prop = actor.GetProperty()
    material = Material.from_property(prop, lights=lights, view=view, model=kind)
    return Scene(lights=lights, material=material, view=view)


def _at_points(mesh: pv.DataSet, name: str) -> pv.DataSet:
    """Return points with the means of a cell array over the cells that meet there."""
    # Without its other arrays, which VTK would average too.
    bare = mesh.copy(deep=False)
    bare.clear_data()
    values = np.asarray(mesh.cell_data[name])
    bare.cell_data[name] = values.astype(np.float64)
    points: pv.DataSet = bare.cell_data_to_point_data()
    if values.dtype == np.uint8:
        # Means of colours are rounded, not cut.
        points.point_data[name] = np.rint(points.point_data[name]).astype(np.uint8)
    return points


def items(collection: vtkCollection) -> Iterator[Foreign]:
    """Yield what a collection of VTK holds."""
    for i in range(collection.GetNumberOfItems()):
        yield collection.GetItemAsObject(i)


def matrix_of(matrix: vtkMatrix4x4) -> Array:
    """Return a matrix of VTK in float64."""
    return np.asarray(pv.array_from_vtkmatrix(matrix), np.float64)


def is_copy(actor: vtkActor) -> bool:
    """Return whether an actor draws what was made for a live light."""
    mapper: Foreign = actor.GetMapper()
    data: Foreign = None if mapper is None else mapper.GetInputDataObject(0, 0)
    own = (NORMALS, TANGENTS, COLORS)
    if not hasattr(data, "GetPointData"):
        return False
    return any(data.GetPointData().HasArray(name) for name in own)


def has_pass(renderer: vtkRenderer, kind: str) -> bool:
    """Return whether a renderer draws by a pass of a class of VTK, at any depth."""
    # Passes nest: SSAO, for instance, holds the pass that draws.
    waiting: list[Foreign] = [renderer.GetPass()]
    while waiting:
        step = waiting.pop()
        if step is None:
            continue
        if step.IsA(kind):
            return True
        if step.IsA("vtkSequencePass"):
            waiting += items(step.GetPasses())
        for name in ("GetDelegatePass", "GetSequence"):
            if hasattr(step, name):
                waiting.append(getattr(step, name)())
    return False


def lifted(scene: Scene, n: int) -> Scene:
    """Return a scene of 3-space in the hyperplane of the first three axes of n-space."""
    # Without a rotation the picture shows the first three axes, so lamps and eye stand there too.
    if n <= 3 or scene.n != 3:
        return scene
    fixed = (light if light.is_headlight else light.seen_from(scene.view) for light in scene.lights)
    lights = tuple(
        dataclasses.replace(
            light, direction=_lifted(light.direction, n), position=_lifted(light.position, n)
        )
        for light in fixed
    )
    view = None if scene.view is None else _lifted_view(scene.view, n)
    return scene.replace(lights=lights, view=view)


def _lifted(vector: Vector | None, n: int) -> Vector | None:
    return None if vector is None else (*vector, *([0.0] * (n - len(vector))))


def _lifted_view(view: View, n: int) -> View:
    return View(
        position=_lifted(view.position, n),
        direction=_lifted(view.direction, n),
        parallel=view.parallel,
        up=_lifted(view.up, n),
    )


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


def colorless(scene: Scene) -> Scene:
    """Return a scene without colours, whose light is luminance alone."""
    cue, material = scene.depth_cue, scene.material
    return scene.replace(
        lights=tuple(dataclasses.replace(light, color=None) for light in scene.lights),
        material=dataclasses.replace(material, color=None, specular_color=None),
        ambient_color=None,
        depth_cue=None if cue is None else dataclasses.replace(cue, color=None),
    )
