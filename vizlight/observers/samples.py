"""Places of a picture with the data there, and the light of what they might be.

The visible cells are those of one offscreen drawing in which each cell has its own colour.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import pyvista as pv
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - what draws registers itself
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

from vizlight import _check
from vizlight.draw.backends import BackendError, choose_backend, window_class
from vizlight.draw.cameras import VIEW_ANGLE, camera_on
from vizlight.filters.lighting import part_of
from vizlight.filters.tint import values_of_blocks
from vizlight.mesh import blocks, records, subdivision
from vizlight.model.frames import orthonormalize
from vizlight.model.kernels import unit_rows
from vizlight.scene import Scene, View
from vizlight.scene.view import as_view, is_camera
from vizlight.shading import engine
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.shading.results import DEFAULT_NAME
from vizlight.verify.between import Places, interpolated, mean_spaces
from vizlight.vtk.cells import as_numpy, as_vtk

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TypeAlias

    from numpy.typing import ArrayLike
    from vtkmodules.vtkCommonCore import vtkPoints

    from vizlight._types import Array, Bools, Indices, Keywords, Raw, Rows
    from vizlight.draw.backends import Backend
    from vizlight.scene.conversion import AnyView
    from vizlight.shading.inputs import ArraySource
    from vizlight.shading.options import LightOptions

    Kind: TypeAlias = Literal["surface", "line", "point"]


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Some places of a picture on one mesh: where they are, and what is there.

    Attributes
    ----------
    kind : {"surface", "line", "point"}
        What is seen.
    points : ndarray, shape (M, 3)
        Places.
    eye, right, up : ndarray, shape (M, 3)
        Unit directions toward the eye, to the right and up in the picture.
    tangents : ndarray, shape (M, k, 3), or None
        Orthonormal tangents.
    normals : ndarray, shape (M, 3), or None
        Unit normals as they are lit.
    values : ndarray, shape (M,), or None
        Values that colours show.
    valid : ndarray of bool, shape (M,)
        Whether tangents and normals have a direction.
    scene : Scene
        Scene with a view, and with both ends of its depth cue.
    options : ShadingOptions
        How light is computed.
    shares : dict of ndarray
        Shares of the light that reach the places, by the names of :class:`ShadingInputs`.
    """

    kind: Kind
    points: Array
    eye: Array
    right: Array
    up: Array
    tangents: Array | None
    normals: Array | None
    values: Array | None
    valid: Bools
    scene: Scene
    options: ShadingOptions
    shares: dict[str, Array]

    def __len__(self) -> int:
        return len(self.points)

    def take(self, rows: Rows) -> Sample:
        """Return some of the places."""
        own: Keywords = {
            n: array[rows] for n, array in vars(self).items() if isinstance(array, np.ndarray)
        }
        shares = {name: share[rows] for name, share in self.shares.items()}
        return dataclasses.replace(self, **own, shares=shares)

    @property
    def local(self) -> bool:
        """Whether light depends on the place, beside tangents and normals."""
        scene = self.scene
        assert scene.view is not None
        near = not scene.view.parallel or any(x.position is not None for x in scene.lights)
        return near or scene.depth_cue is not None or bool(self.shares)

    @property
    def has_one_tangent(self) -> bool:
        """Whether there is a single tangent at each place."""
        return self.tangents is not None and self.tangents.shape[1] == 1

    def given(
        self, tangents: Array | None, normals: Array | None, repeat: int = 1
    ) -> ShadingInputs:
        """Return inputs of the engine of other tangents and normals, ``repeat`` at each place."""
        # Normals beside tangents are what a reader sees as the shape; light has them where it is
        # conditioned.
        lit = self.options.conditioned is True or tangents is None
        known = {"points": self.points} | self.shares
        several: Keywords = {name: np.repeat(rows, repeat, axis=0) for name, rows in known.items()}
        return ShadingInputs(tangents=tangents, normals=normals if lit else None, **several)

    def light(self, tangents: Array | None, normals: Array | None, repeat: int = 1) -> Array:
        """Return the light of other tangents and normals at the places, shape (M repeat, 3)."""
        # These runs are the observer's, and none of those that a report of the user counts.
        with engine.observed(None):
            found = engine.run(self.given(tangents, normals, repeat), self.scene, self.options)
        if found.rgb is not None:
            return np.asarray(found.rgb, np.float64)
        return np.repeat(found.luminance[:, np.newaxis].astype(np.float64), 3, axis=1)

    def own_light(self) -> Array:
        """Return the light of the places themselves, shape (M, 3)."""
        return self.light(self.tangents, self.normals)


def sample(part: Part, cells: Indices, at: Array, camera: pv.Camera, scene: Scene) -> Sample:
    """Return places of a picture with the data that are interpolated there.

    Parameters
    ----------
    part : Part
        Mesh.
    cells : ndarray of int, shape (M, s)
        Corners of the cells that are seen.
    at : ndarray, shape (M, 2)
        Places in the picture, see :class:`Pixels`; for single points
        as cells they have no effect.
    camera : pyvista.Camera
        Camera of the picture.
    scene : Scene
        Scene with a view.
    """
    m, s = cells.shape
    ids = cells.ravel()
    corners = rows_of(part.inputs.points, ids).astype(np.float64).reshape(m, s, 3)
    share = weights(corners, *rays(camera, at))
    places = Places(np.arange(m * s).reshape(m, s), share)
    points = interpolated(corners.reshape(-1, 3), places)
    toward = _toward_eye(camera, points)
    right = unit_rows(np.cross(np.asarray(camera.GetViewUp()), toward))
    tangents = _tangents(part, ids, places)
    normals = _normals(part, ids, places, points)
    valid = np.ones(m, dtype=np.bool_)
    for vectors in (normals, *(() if tangents is None else np.moveaxis(tangents, 1, 0))):
        if vectors is not None:
            # Vectors are of length 1, or 0 where there is no direction.
            valid &= np.einsum("ij,ij->i", vectors, vectors) > 0.5
    shares = {
        name: np.clip(interpolated(rows[ids].astype(np.float64), places), 0.0, 1.0)
        for name, rows in part.shares.items()
    }
    values = None
    if part.values is not None:
        values = interpolated(part.values[ids].astype(np.float64), places)
    # In float64, so that no error of the engine is taken for one of the reader.
    options = ShadingOptions.of(vars(part.options) | {"precision": "float64", "components": False})
    return Sample(
        kind=part.kind, points=points, eye=toward, right=right, up=np.cross(toward, right),
        tangents=tangents, normals=normals, values=values, valid=valid, scene=scene,
        options=options, shares=shares,
    )  # fmt: skip


def _toward_eye(camera: pv.Camera, points: Array) -> Array:
    """Return the unit directions from points toward the eye of a camera."""
    if camera.GetParallelProjection():
        away = np.array(camera.GetDirectionOfProjection())
        return np.broadcast_to(-away, points.shape).copy()
    return unit_rows(np.array(camera.GetPosition()) - points)


def _tangents(part: Part, ids: Indices, places: Places) -> Array | None:
    """Return tangents interpolated as a picture has them, zero where one has no direction.

    Vectors are interpolated linearly; lines without sign, and planes, are turned alike before.
    """
    if part.inputs.tangents is None:
        return None
    rows = rows_of(part.inputs.tangents, ids).astype(np.float64)
    frames: Array = rows.reshape(len(ids), -1, 3)
    one = frames.shape[1] == 1
    frames = unit_rows(frames[:, 0])[:, np.newaxis] if one else orthonormalize(frames)[0]
    if places.weights.shape[1] > 1:
        unsigned = part.inputs.line_field or not one
        frames = (mean_spaces if unsigned else interpolated)(frames, places)
    return unit_rows(frames[:, 0])[:, np.newaxis] if one else frames


def _normals(part: Part, ids: Indices, places: Places, points: Array) -> Array | None:
    """Return interpolated normals, turned to the side that is lit; zero without a direction."""
    sides = part.inputs.sides
    if sides is None or part.inputs.normals is None:
        return None
    own = sides()
    normals = interpolated(unit_rows(own.normals[ids]), places)
    facts = interpolated(own.facts[ids], places)
    return own.turned(unit_rows(normals), facts, points)


@dataclass(frozen=True)
class Part:
    """One mesh of the picture.

    Attributes
    ----------
    kind : {"surface", "line", "point"}
        What its cells are.
    cells : ndarray of int, shape (C, s)
        Triangles, segments or points.
    inputs : ShadingInputs
        Points, tangents and normals. A surface has normals also where its light does not depend
        on them: they are what a reader sees as its shape.
    options : LightOptions
        How the mesh is lit.
    shares : dict of ndarray
        Shares of the light that reach the points, by the names of :class:`ShadingInputs`.
    values : ndarray, shape (N,), or None
        Values of the points that colours show.
    """

    kind: Kind
    mesh: pv.DataSet
    cells: Indices
    inputs: ShadingInputs
    options: LightOptions
    shares: dict[str, Array]
    values: Raw | None

    @property
    def drawn(self) -> tuple[vtkPoints, Indices]:
        """Points and cells to draw."""
        if isinstance(self.mesh, pv.PolyData | pv.PointSet | pv.UnstructuredGrid):
            return self.mesh.GetPoints(), self.cells
        return pv.vtk_points(np.asarray(self.inputs.points[:])), self.cells


def parts_of(
    mesh: pv.DataSet | pv.MultiBlock,
    scene: Scene,
    options: LightOptions,
    scalars: str | ArrayLike | None,
) -> list[Part]:
    """Return the meshes of a picture that have points; an error names the block.

    Raises
    ------
    TypeError, ValueError
        If an array is missing or does not fit, as :func:`vizlight.illuminate`.
    """
    parts = [(block, path) for block, path in blocks.check(mesh) if block.n_points]
    values: Sequence[Raw | None] = [None] * len(parts)
    if scalars is not None:
        values = values_of_blocks([block for block, _ in parts], scalars)
    return [
        _part(block, path, scene, options, own)
        for (block, path), own in zip(parts, values, strict=True)
    ]


def _part(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    values: Raw | None,
) -> Part:
    cells = subdivision.simplices(mesh)
    kind: Kind = "surface" if cells.shape[1] == 3 else "line"
    if not len(cells):
        kind, cells = "point", np.arange(mesh.n_points)[:, np.newaxis]
    known = options
    if kind == "surface" and options.tangents is not None:
        # Normals are then read beside the tangents: they are the shape that a reader sees.
        known = dataclasses.replace(options, conditioned=True)
    inputs = part_of(mesh, path, scene, known).inputs.of_faces()
    shares = _shares(mesh, sum(light.intensity > 0 for light in scene.lights))
    return Part(kind, mesh, cells, inputs, options, shares, values)


def _shares(mesh: pv.DataSet, lights: int) -> dict[str, Array]:
    """Return the shares of light that a filter found to reach the points of a mesh."""
    made = records.made(mesh, DEFAULT_NAME)
    names = {"transmittance", "occlusion"} & made
    found: dict[str, Array] = {name: np.asarray(mesh.point_data[name]) for name in names}
    name = (records.read(mesh, DEFAULT_NAME) or {}).get("options", {}).get("occlusion")
    if isinstance(name, str) and name in mesh.point_data:
        found["occlusion"] = np.asarray(mesh.point_data[name])
    if "transmittance" in found:
        columns = found["transmittance"].reshape(mesh.n_points, -1)
        if columns.shape[1] != lights:
            expected = f"one column for each of the {lights} lights of the scene"
            remedy = "light the mesh by this scene first, or delete the array"
            got = f"{columns.shape[1]} in 'transmittance'"
            raise ValueError(_check.message("mesh", expected, got, remedy))
        found["transmittance"] = columns
    return found


def rows_of(source: ArraySource, ids: Indices) -> Raw:
    """Return rows of points or of an array by their numbers."""
    return np.asarray(source[:])[ids]


def seen_from(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene, view: AnyView
) -> tuple[pv.Camera, Scene]:
    """Return the camera of the picture, and the scene with its view."""
    own = as_view(view) or scene.view
    for name, n in (("scene", scene.n), ("view", None if own is None else Scene(view=own).n)):
        if n not in (None, 3):
            remedy = "project the mesh first, vizlight.project, and measure it in 3-space"
            raise ValueError(_check.message(name, "vectors of 3 components", n, remedy))
    if is_camera(view):
        camera = camera_on((-1, 1, -1, 1, -1, 1))
        # A copy, since drawing moves the clipping planes.
        camera.DeepCopy(view)
    elif own is None:
        camera = camera_on(mesh)
    else:
        camera = _camera_of(own, mesh)
    return camera, scene.replace(view=View.from_camera(camera) if own is None else own)


def _camera_of(view: View, mesh: pv.DataSet | pv.MultiBlock) -> pv.Camera:
    """Return a camera at the eye of a view."""
    if view.position is None or view.parallel:
        assert view.direction is not None
        return camera_on(mesh, view.direction, up=view.axes()[1].tolist(), parallel=view.parallel)
    position, toward = np.array(view.position), np.array(view.direction)
    if view.direction is None:
        toward = position - np.array(camera_on(mesh).focal_point)
    eye = View(direction=toward, up=view.up)
    camera = camera_on((-1, 1, -1, 1, -1, 1), toward.tolist(), up=eye.axes()[1].tolist())
    camera.position = tuple(position)
    camera.focal_point = tuple(position - toward)
    camera.view_angle = VIEW_ANGLE
    return camera


def places_of(
    parts: list[Part],
    camera: pv.Camera,
    scene: Scene,
    most: int,
    random: np.random.Generator,
) -> tuple[list[tuple[Sample, Part]], int, bool]:
    """Return places of the picture with what is there, the number of pixels, and whether drawn."""
    try:
        backend = choose_backend()
    except BackendError:
        found = _facing(parts, camera, scene, most, random)
        total = sum(len(one) for one, _ in found)
        drawn = False
    else:
        pixels = visible([part.drawn for part in parts], camera, backend)
        total, drawn = len(pixels.part), True
        chosen = np.sort(random.permutation(total)[:most])
        found = []
        for number, part in enumerate(parts):
            own = chosen[pixels.part[chosen] == number]
            if len(own):
                corners = part.cells[pixels.cell[own]]
                found.append((sample(part, corners, pixels.at[own], camera, scene), part))
    if not total:
        remedy = "pass view= with a direction, or a camera that looks at the mesh"
        raise ValueError(_check.message("mesh", "a point that the eye sees", "none", remedy))
    return found, total, drawn


def _facing(
    parts: list[Part], camera: pv.Camera, scene: Scene, most: int, random: np.random.Generator
) -> list[tuple[Sample, Part]]:
    """Return random points that face the eye, each as likely as its surface is large in a picture.

    Points that are even on a surface are then as in a picture without what hides them.
    """
    total = sum(part.inputs.count for part in parts)
    found = []
    for part in parts:
        count = part.inputs.count
        # On a ball half of the points face the eye, and are half as large in the picture.
        chosen = random.permutation(count)[: max(1, round(4 * most * count / total))]
        ids: Indices = np.sort(chosen)
        ids = ids[np.isfinite(rows_of(part.inputs.points, ids)).all(axis=1)]
        own = sample(part, ids[:, np.newaxis], np.zeros((len(ids), 2)), camera, scene)
        if own.normals is not None:
            toward = np.einsum("ij,ij->i", own.normals, own.eye)
            # The chance of a point is its cosine to the eye, by which its surface is foreshortened.
            own = own.take(toward > random.uniform(0.0, 1.0, len(own)))
        if len(own):
            found.append((own, part))
    keep = min(1.0, most / max(1, sum(len(one) for one, _ in found)))
    few = [random.permutation(len(one))[: max(1, round(keep * len(one)))] for one, _ in found]
    return [(one.take(np.sort(ids)), part) for ids, (one, part) in zip(few, found, strict=True)]


#: Width and height of the picture.
SIZE = 512, 512
#: Width of lines and of points, in pixels.
LINE, POINT = 2.0, 4.0
#: Bits of the three channels.
BITS = 24


class Pixels(NamedTuple):
    """Visible pixels.

    Attributes
    ----------
    part : ndarray of int, shape (M,)
        Number of the mesh that each pixel shows.
    cell : ndarray of int, shape (M,)
        Number of the cell of that mesh.
    at : ndarray, shape (M, 2)
        Place of the pixel's middle in the picture, from -1 at the left and at the bottom to 1.
    """

    part: Indices
    cell: Indices
    at: Array


def visible(
    parts: Sequence[tuple[vtkPoints, Indices]], camera: pv.Camera, backend: Backend | None
) -> Pixels:
    """Return the pixels of a picture that show a cell, and which.

    Parameters
    ----------
    parts : sequence of (vtkPoints, ndarray of int, shape (C, s))
        Points of each mesh, and cells of 1, 2 or 3 of them.
    camera : pyvista.Camera
        Camera of the picture; its clipping range is set to show all.
    backend : {"egl", "osmesa"} or None
        OpenGL library that draws, see :func:`vizlight.draw.backends.choose_backend`.

    Returns
    -------
    Pixels
    """
    starts = np.cumsum([0, *(len(cells) for _, cells in parts)])
    with window_class(backend):
        window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    # A pixel that is mixed of two colours would name a third cell.
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    renderer = vtkRenderer()
    renderer.SetActiveCamera(camera)
    window.AddRenderer(renderer)
    number = np.zeros(SIZE[0] * SIZE[1], dtype=np.int64)
    # A picture has 24 bits of a cell's number; more cells take more pictures.
    for shift in range(0, max(int(starts[-1]).bit_length(), 1), BITS):
        renderer.RemoveAllViewProps()
        for (points, cells), start in zip(parts, starts.tolist(), strict=False):
            renderer.AddActor(_actor(points, cells, start, shift))
        renderer.ResetCameraClippingRange()
        window.Render()
        pixels = vtkUnsignedCharArray()
        window.GetPixelData(0, 0, SIZE[0] - 1, SIZE[1] - 1, 1, pixels, 0)
        rgb = as_numpy(pixels).reshape(-1, 3).astype(np.int64)
        number |= (rgb[:, 0] << 16 | rgb[:, 1] << 8 | rgb[:, 2]) << shift
    window.Finalize()
    shown = np.flatnonzero((number > 0) & (number <= starts[-1]))
    cell = number[shown] - 1
    which = np.searchsorted(starts, cell, side="right") - 1
    # VTK's rows begin at the bottom, and a pixel is seen through its middle.
    row, column = np.divmod(shown, SIZE[0])
    at = np.stack([(column + 0.5) / SIZE[0], (row + 0.5) / SIZE[1]], axis=1) * 2 - 1
    return Pixels(which, cell - starts[which], at)


def _actor(points: vtkPoints, corners: Indices, start: int, shift: int) -> vtkActor:
    """Return a mesh whose cells have their numbers, from 1, as flat colours; 0 is background."""
    count, size = corners.shape
    number = np.arange(start + 1, start + 1 + count) >> shift
    colors = np.stack([number >> place & 255 for place in (16, 8, 0)], axis=1).astype(np.uint8)
    cells = vtkCellArray()
    cells.SetData(size, as_vtk(corners.ravel()))
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    (mesh.SetVerts, mesh.SetLines, mesh.SetPolys)[size - 1](cells)
    mesh.GetCellData().SetScalars(as_vtk(colors, "number"))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToDirectScalars()
    actor = vtkActor()
    actor.SetMapper(mapper)
    own = actor.GetProperty()
    # The colours are numbers, which light must not change.
    own.LightingOff()
    own.SetLineWidth(LINE)
    own.SetPointSize(POINT)
    return actor


def rays(camera: pv.Camera, at: Array) -> tuple[Array, Array]:
    """Return a point on each line of sight through places of a picture, ``Pixels.at``, and its way.

    The way is the unit direction away from the eye.
    """
    away = np.array(camera.GetDirectionOfProjection())
    right = np.cross(away, camera.GetViewUp())
    right /= np.linalg.norm(right)
    across = at[:, :1] * right + at[:, 1:] * np.cross(right, away)
    eye = np.array(camera.GetPosition())
    if camera.GetParallelProjection():
        scale = camera.GetParallelScale()
        return eye + scale * across, np.broadcast_to(away, across.shape)
    # The angle of view is VTK's, from bottom to top.
    way = away + np.tan(np.radians(camera.GetViewAngle() / 2)) * across
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    return np.broadcast_to(eye, way.shape), way


def weights(corners: Array, origin: Array, way: Array) -> Array:
    """Return where lines of sight meet cells, as the share of each corner.

    Parameters
    ----------
    corners : ndarray, shape (M, s, 3)
        Corners of a triangle, a segment or a point for each line of sight.
    origin, way : ndarray, shape (M, 3)
        Lines of sight, as :func:`rays` returns them.

    Returns
    -------
    ndarray, shape (M, s)
        Shares, 0 or more and with sum 1; for a segment, of its point nearest to the line.
    """
    m, s, _ = corners.shape
    if s == 1:
        return np.ones((m, 1))
    start = origin - corners[:, 0]
    # What lies along the line of sight has no part in where it meets a cell.
    flat = [
        flattened(x, way) for x in (start, *(corners[:, i] - corners[:, 0] for i in range(1, s)))
    ]
    if s == 2:
        p, u = flat
        second = np.clip(_ratio(dots(p, u), dots(u, u)), 0.0, 1.0)
        return np.stack([1 - second, second], axis=1)
    p, u, v = flat
    uu, uv, vv, pu, pv_ = dots(u, u), dots(u, v), dots(v, v), dots(p, u), dots(p, v)
    # Gram's determinant of two sides across the line of sight; barycentric coordinates follow by
    # Cramer's rule.
    area = uu * vv - uv**2
    second, third = _ratio(vv * pu - uv * pv_, area), _ratio(uu * pv_ - uv * pu, area)
    # At an edge a line of sight may pass the cell by a little.
    found = np.maximum(np.stack([1 - second - third, second, third], axis=1), 0.0)
    return np.asarray(found / found.sum(axis=1, keepdims=True))


def flattened(vectors: Array, way: Array) -> Array:
    """Return what of vectors stands across unit directions."""
    return np.asarray(vectors - dots(vectors, way)[:, np.newaxis] * way)


def dots(a: Array, b: Array) -> Array:
    """Return the dot products of rows."""
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _ratio(a: Array, b: Array) -> Array:
    """Return a / b, and 0 for a cell that is seen edge on."""
    return np.divide(a, b, out=np.zeros_like(a), where=b > 0)
