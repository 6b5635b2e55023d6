"""Places of a picture with their data, and the light of the data that they might have."""

from __future__ import annotations

import dataclasses
import warnings
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.draw.cameras import VIEW_ANGLE, camera_on
from vizlight.filters.lighting import part_of
from vizlight.filters.streamlines import TANGENTS, speed_of
from vizlight.geometry.lines.simplices import Columns
from vizlight.mesh import strokes, subdivision
from vizlight.model.frames import orthonormalize
from vizlight.model.kernels import length_rows, unit_rows
from vizlight.observers.near import around_points, near, near_points, stars, tangents_at
from vizlight.observers.pixels import Cells, rows_of, toward_eye
from vizlight.scene import Scene, View
from vizlight.scene.view import as_view, is_camera
from vizlight.shading import engine
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import LightOptions, ShadingOptions
from vizlight.verify.between import Places, interpolated, mean_spaces
from vizlight.vtk import hull
from vizlight.vtk.arrays import (
    MadePoints,
    at_points,
    is_of_cells,
    points_of,
    tangents_of,
    without_sign,
)
from vizlight.vtk.drawn import TRIANGLE, DrawnCells, DrawnPoints, DrawnSegments, DrawnTriangles
from vizlight.vtk.hull import SOLID
from vizlight.vtk.normals import is_scan

if TYPE_CHECKING:
    from typing import TypeAlias

    from vizlight._types import Array, Bools, Given, Indices, Keywords, Raw
    from vizlight.observers.pixels import Pixels
    from vizlight.scene.conversion import AnyView
    from vizlight.shading.inputs import ArraySource

    Kind: TypeAlias = Literal["surface", "line", "point"]

#: Arrays of VTK: of streamlines, what grows in the sense of the flow; of glyphs, their vectors.
TIME, GLYPH = "IntegrationTime", "GlyphVector"
#: Number of cells of a surface up to which it is looked at as a whole.
WHOLE = 1 << 17


@dataclass(frozen=True, kw_only=True)
class Sample(Columns):
    """Some places of a picture on one mesh: where they are, and their data.

    ``kind`` is "surface", "line" or "point"; ``eye``, ``right`` and ``up`` are unit directions
    toward the eye, to the right and up in the picture. Tangents (M, k, 3) are orthonormal, normals
    unit vectors as they are lit, ``valid`` where these have a direction; ``values`` are those that
    colours show, and ``magnitude`` is the length of a single tangent before it became a unit
    vector. The scene has a view, and both ends of its depth cue.
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
    magnitude: Array | None = None

    def __len__(self) -> int:
        return len(self.points)

    @property
    def has_one_tangent(self) -> bool:
        """Whether each place has a single tangent."""
        return self.tangents is not None and self.tangents.shape[1] == 1

    def inputs(
        self, tangents: Array | None, normals: Array | None, repeat: int = 1
    ) -> ShadingInputs:
        """Return inputs of the engine for other tangents and normals, ``repeat`` at each place."""
        # Normals beside tangents are what a reader sees as the shape; light has them where it is
        # conditioned.
        lit = self.options.conditioned is True or tangents is None
        points = np.repeat(self.points, repeat, axis=0)
        return ShadingInputs(points=points, tangents=tangents, normals=normals if lit else None)

    def light(self, tangents: Array | None, normals: Array | None, repeat: int = 1) -> Array:
        """Return the light of other tangents and normals at the places, shape (M repeat, 3)."""
        result = engine.run(self.inputs(tangents, normals, repeat), self.scene, self.options)
        if result.rgb is not None:
            return np.asarray(result.rgb, np.float64)
        return np.repeat(result.luminance[:, np.newaxis].astype(np.float64), 3, axis=1)


def sample(part: SeenMesh, pixels: Pixels, camera: pv.Camera) -> Sample:
    """Return places of a picture with the data that are interpolated at them."""
    names, cell = np.unique(pixels.cell, return_inverse=True)
    whole, part = part, part.near(names)
    cells = part.cells[cell]
    m, s = cells.shape
    ids = cells.ravel()
    corners = rows_of(part.inputs.points, ids).astype(np.float64).reshape(m, s, 3)
    share = weights(corners, *rays(camera, pixels.at))
    places = Places(np.arange(m * s).reshape(m, s), share)
    points = interpolated(corners.reshape(-1, 3), places)
    toward = toward_eye(camera, points)
    # To the right is one direction for all of a picture, also where up is nearly toward the eye.
    side = np.cross(camera.GetDirectionOfProjection(), camera.GetViewUp())
    right = unit_rows(side - (toward @ side)[:, np.newaxis] * toward)
    tangents = _tangents(part, ids, places)
    normals = _normals(part, ids, places, points)
    valid = np.ones(m, dtype=np.bool_)
    for vectors in (normals, *(() if tangents is None else np.moveaxis(tangents, 1, 0))):
        if vectors is not None:
            # Vectors are of length 1, or 0 where there is no direction.
            valid &= np.einsum("ij,ij->i", vectors, vectors) > 0.5
    values = magnitude = None
    if part.values is not None:
        rows = part.values[cell if part.flat else ids].astype(np.float64)
        values = rows if part.flat else np.asarray(interpolated(rows, places))
    traced = whole.kind == "line" and whole.light.tangents == TANGENTS
    if traced and (name := speed_of(whole.mesh)) is not None:
        # The tangents of streamlines have the length 1.
        speeds = np.asarray(whole.mesh.point_data[name], dtype=np.float64)
        magnitude = interpolated(speeds[whole.cells[names][cell].ravel()], places)
    elif part.inputs.tangents is not None and part.inputs.tangents.shape[1] == 3:
        magnitude = interpolated(length_rows(rows_of(part.inputs.tangents, ids)), places)
    return Sample(
        kind=part.kind, points=points, eye=toward, right=right, up=np.cross(toward, right),
        tangents=tangents, normals=normals, values=values, valid=valid, scene=part.scene,
        options=part.options, magnitude=magnitude,
    )  # fmt: skip


def _tangents(part: SeenMesh, ids: Indices, places: Places) -> Array | None:
    """Return tangents interpolated as a picture has them, zero where one has no direction.

    Vectors are interpolated linearly; lines without sign, and planes, are turned alike before.
    """
    if part.inputs.tangents is None:
        return None
    rows = rows_of(part.inputs.tangents, ids).astype(np.float64)
    frames: Array = rows.reshape(len(ids), -1, 3)
    is_single = frames.shape[1] == 1
    frames = unit_rows(frames[:, 0])[:, np.newaxis] if is_single else orthonormalize(frames)[0]
    if places.weights.shape[1] > 1:
        unsigned = part.inputs.line_field or not is_single
        frames = (mean_spaces if unsigned else interpolated)(frames, places)
    return unit_rows(frames[:, 0])[:, np.newaxis] if is_single else frames


def _normals(part: SeenMesh, ids: Indices, places: Places, points: Array) -> Array | None:
    """Return interpolated normals, turned to the side that is lit; zero without a direction."""
    sides = part.inputs.sides
    if sides is None or part.inputs.normals is None:
        return None
    sided = sides()
    normals = interpolated(unit_rows(sided.normals[ids]), places)
    facts = interpolated(sided.facts[ids], places)
    return sided.turned(unit_rows(normals), facts, points)


@dataclass(frozen=True, kw_only=True)
class SeenMesh:
    """One mesh of the picture.

    ``kind`` is "surface", "line" or "point", and ``cells`` (C, s) are triangles, segments or
    points. A lit surface has normals also where its light does not depend on them: a reader sees
    them as its shape; of a large surface and of many lines ``inputs`` are the points alone, as
    tangents and normals are made near the places that are read. ``lit`` says that the colours of
    the picture mean light, that of the ``scene``, which has a view. ``values`` that colours of the
    ``table`` show are of the points, or of the cells if ``flat``: each cell has one colour.
    ``width`` is in pixels, the least one of lines that have a ``diameter`` in the unit of the mesh,
    and ``shares`` of it are those that lines have at their points, None for one width. ``glyph`` is
    the number of the glyph that a cell belongs to; with ``by_axes`` hues of lines are those of the
    axes along which they run. ``matrix`` is the place of a mesh that is not moved as a whole, and
    ``path`` its name for errors.
    """

    kind: Kind
    mesh: pv.DataSet
    cells: Indices | DrawnCells | DrawnPoints
    inputs: ShadingInputs
    options: ShadingOptions
    scene: Scene
    light: LightOptions = dataclasses.field(default_factory=LightOptions)
    path: str = ""
    lit: bool = True
    values: Raw | None = None
    flat: bool = False
    table: pv.LookupTable | None = None
    width: float = 1.0
    diameter: float | None = None
    shares: Array | None = None
    glyph: Indices | None = None
    by_axes: bool = False
    large: bool = False
    matrix: Array | None = None

    @property
    def by_form(self) -> bool:
        """Whether marks tell directions by their form, since colours do not by their hue."""
        return self.kind == "line" or not self.lit

    @property
    def has_tangents(self) -> bool:
        """Whether the mesh has tangents."""
        named = self.light.tangents is not None
        return named or self.inputs.tangents is not None or (self.kind == "line" and self.large)

    @property
    def drawn(self) -> Cells:
        """Points and cells to draw."""
        points = _moved_points(points_of(self.mesh, None), self.matrix)
        return Cells(points, self.cells, self.width, self.diameter, self.shares)

    @property
    def turned(self) -> Cells:
        """Points and cells to draw, with the widths of lines from their ends to their starts."""
        if self.shares is None or not isinstance(self.mesh, pv.PolyData):
            return self.drawn
        return self.drawn._replace(shares=strokes.turned(self.mesh, self.shares))

    def lean(self, cells: Indices) -> Array:
        """Return 1 for segments of lines that are wider ahead of their middle, -1 behind it."""
        if self.shares is None or not isinstance(self.mesh, pv.PolyData):
            return np.zeros(len(cells))
        return strokes.leaning(self.mesh, self.shares)[self.cells[cells][:, 0]]

    def ahead(self, cells: Indices) -> Array:
        """Return whether segments run with the data, by their vectors or by the time along them.

        1 if they run in the sense of the data, -1 against it, 0 without a sense.
        """
        if self.glyph is None and TIME in self.mesh.point_data:
            time = np.asarray(self.mesh.point_data[TIME])[self.cells[cells]].astype(np.float64)
            return np.sign(np.diff(time)[:, 0])
        given = self.light.tangents
        if given is None or self.light.line_field or without_sign(self.mesh, given):
            return np.zeros(len(cells))
        part = self.near(cells)
        tangents = part.inputs.tangents
        if tangents is None or tangents.shape[1] != 3 or self.glyph is not None:
            return np.zeros(len(cells))
        start, end = part.cells[:].T
        vectors, points = (
            [rows_of(rows, each).astype(np.float64) for each in (start, end)]
            for rows in (tangents, part.inputs.points)
        )
        return np.asarray(np.sign(dots(vectors[0] + vectors[1], points[1] - points[0])))

    def near(self, cells: Indices) -> SeenMesh:
        """Return the mesh with some of the cells alone, and with all inputs at their points."""
        values = self.values
        if values is not None and self.flat:
            assert isinstance(self.cells, DrawnCells)
            values = values[self.cells.cells(cells)]
        corners = self.cells[cells]
        if not self.large:
            return dataclasses.replace(self, cells=corners, values=values)
        if isinstance(self.cells, DrawnTriangles):
            around = near(self.mesh, self.cells, cells, self.light)
            light = around.light
            others = self.cells.beside or self.cells.grid is not None
            if others and are_of_cells(self.mesh, self.light):
                light = _with_means(light, self.mesh, around.origin, self.path, self.scene)
            mesh, light = moved(around.mesh, light, self.matrix)
        elif are_of_cells(self.mesh, self.light):
            around = around_points(self.mesh, corners, self.light)
            mesh, light = moved(around.mesh, around.light, self.matrix)
        elif isinstance(self.cells, DrawnSegments):
            return self._near_lines(self.cells, cells, values)
        else:
            around = near_points(self.inputs.points, corners, self.light)
            mesh, light = around.mesh, around.light
        inputs = _inputs(mesh, self.path, self.scene, light, self.kind, lit=self.lit)
        if values is not None and not self.flat:
            values = values[around.origin]
        return dataclasses.replace(
            self, mesh=mesh, cells=around.corners, inputs=inputs, values=values, matrix=None
        )

    def _near_lines(self, lines: DrawnSegments, cells: Indices, values: Raw | None) -> SeenMesh:
        """Return some segments with their points alone, and the tangents at these."""

        def tangents_of(mesh: pv.PolyData) -> Array:
            placed, light = moved(mesh, self.light, self.matrix)
            tangents = part_of(placed, self.path, self.scene, light).inputs.tangents
            assert tangents is not None
            return tangents[:]

        points, corners = np.unique(lines[cells], return_inverse=True)
        inputs = ShadingInputs(
            points=rows_of(self.inputs.points, points),
            tangents=tangents_at(self.mesh, lines, points, tangents_of),
            line_field=self.light.line_field,
        )
        values = values if values is None or self.flat else values[points]
        corners = corners.reshape(-1, lines.shape[1])
        return dataclasses.replace(self, cells=corners, inputs=inputs, values=values)


def is_large(mesh: pv.DataSet) -> bool:
    """Return whether a surface is looked at near the places that are read, and not as a whole."""
    large = mesh.n_cells > WHOLE and GLYPH not in mesh.point_data
    return large and DrawnTriangles.of(mesh) is not None


def is_solid(mesh: pv.DataSet) -> bool:
    """Return whether the outer surface of cells that fill space has all that a picture shows."""
    if isinstance(mesh, pv.PolyData) or hull.dimension(mesh) != SOLID:
        return False
    return not hull.is_curved(mesh) and GLYPH not in mesh.point_data


def are_of_cells(mesh: pv.DataSet, light: LightOptions) -> bool:
    """Return whether tangents are means of those of the cells around a point."""
    names = light.tangents.split(",") if isinstance(light.tangents, str) else ()
    return any(map(partial(is_of_cells, mesh), names))


def _made_near(
    mesh: pv.DataSet, cells: Indices | DrawnCells | DrawnPoints, light: LightOptions, *, lit: bool
) -> bool:
    """Return whether tangents and normals of a mesh are made near the places that are read."""
    if isinstance(cells, DrawnTriangles):
        return is_large(mesh)
    if mesh.n_points <= WHOLE or light.positions is not None:
        return False
    given = light.normals is not None or mesh.point_data.active_normals_name is not None
    if light.tangents is not None:
        # Normals of faces, such as of curved cells, are not those of points alone.
        needs_faces = lit if cells.shape[1] == TRIANGLE else light.conditioned is True and not given
        return are_of_cells(mesh, light) and not needs_faces
    if isinstance(cells, DrawnSegments):
        # Which of several lines a segment is a part of is known of segments alone.
        apart = cells.are_single or not cells.may_join
        return apart and not light.conditioned and subdivision.kept_tangents(mesh) is None
    return lit and not given and is_scan(mesh)


def _inputs(
    mesh: pv.DataSet, path: str, scene: Scene, light: LightOptions, kind: Kind, *, lit: bool
) -> ShadingInputs:
    """Return the points, the tangents and, where colours mean light, the normals of a mesh."""
    if light.tangents is None and not lit and kind != "line":
        return ShadingInputs(points=points_of(mesh, light.positions))
    conditioned = light.conditioned
    if kind == "surface":
        # Normals are read beside the tangents: they are the shape that a reader sees. Surfaces
        # without tangents have their attached shadow in any case.
        conditioned = lit and light.tangents is not None
    return part_of(mesh, path, scene, dataclasses.replace(light, conditioned=conditioned)).inputs


def part_on(
    mesh: pv.DataSet,
    scene: Scene,
    options: LightOptions,
    path: str = "",
    *,
    values: Raw | None = None,
    flat: bool = False,
    matrix: Array | None = None,
    **more: Given,
) -> SeenMesh:
    """Return the part that the meter needs of a mesh in the light of a scene.

    ``path`` is its name among others, for errors, ``values`` are of each point, or of each cell if
    they are ``flat``, ``matrix`` is the place of the mesh, and ``more`` are further attributes.
    """
    options, is_glyphs = of_glyphs(mesh, options), GLYPH in mesh.point_data
    if is_glyphs:
        more["lit"] = False
    elif is_solid(mesh):
        mesh, options, values = _on_surface(mesh, path, scene, options, values, flat=flat)
    if matrix is not None and np.array_equal(matrix, np.eye(4)):
        matrix = None
    # A key has no depth by which a cue could fade it.
    scene = scene.replace(depth_cue=None)
    drawn = DrawnTriangles.of(mesh) or DrawnSegments.of(mesh)
    if flat and drawn is None and values is not None:
        # Cells that are curved, hidden, or points.
        values, flat = at_points(mesh, values), False
    cells: Indices | DrawnCells | DrawnPoints
    cells = subdivision.simplices(mesh) if drawn is None else drawn
    kind: Kind = "surface" if cells.shape[1] == 3 else "line"
    if not len(cells):
        kind, cells = "point", DrawnPoints(mesh.n_points)
    # Shares of light that reach a place are the picture's to show, and not of the key.
    light = dataclasses.replace(options, occlusion=None, bundle=False)
    lit = more.get("lit", True)
    placed = False
    if large := _made_near(mesh, cells, light, lit=lit):
        points = points_of(mesh, options.positions)
        points = points if options.positions else _moved_points(points, matrix)
        inputs = ShadingInputs(points=points)
    elif placed := _moves_by_rows(mesh, light, kind, matrix, lit=lit):
        inputs = _inputs(mesh, path, scene, light, kind, lit=lit)
        points, tangents = _moved_points(inputs.points, matrix), inputs.tangents
        if tangents is not None:
            tangents = _moved_points(tangents, matrix, shift=0.0)
        inputs = dataclasses.replace(inputs, points=points, tangents=tangents)
    else:
        mesh, light = moved(mesh, light, matrix)
        inputs = _inputs(mesh, path, scene, light, kind, lit=lit)
    inputs = dataclasses.replace(inputs.of_faces(), occlusion=None, transmittance=None, shadow=None)
    # In float64, so that no error of the engine is taken for one of the reader.
    exact = ShadingOptions.of(vars(options) | {"precision": "float64", "components": False})
    return SeenMesh(
        kind=kind, mesh=mesh, cells=cells, inputs=inputs, options=exact, scene=scene, light=light,
        path=path, glyph=_glyphs(mesh, cells) if is_glyphs else None, large=large,
        matrix=matrix if large or placed else None, values=values, flat=flat, **more,
    )  # fmt: skip


def _on_surface(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    values: Raw | None,
    *,
    flat: bool,
) -> tuple[pv.DataSet, LightOptions, Raw | None]:
    """Return the outer surface of a mesh with its rows of arrays, options and values."""
    surface, origin, cells = hull.outer_faces(mesh)
    given: Keywords = {
        name: np.asarray(rows)[origin]
        for name in ("tangents", "normals")
        if not isinstance(rows := getattr(options, name), str | None)
    }
    if are_of_cells(mesh, options):
        options = _with_means(options, mesh, origin, path, scene)
    values = values if values is None else values[cells if flat else origin]
    return pv.wrap(surface), dataclasses.replace(options, **given), values


def _with_means(
    options: LightOptions, mesh: pv.DataSet, origin: Indices, path: str, scene: Scene
) -> LightOptions:
    """Return options with tangents that are means of all cells around, inside and hidden too."""
    light = LightOptions(tangents=options.tangents, line_field=options.line_field)
    points, place = np.unique(origin, return_inverse=True)
    rows: list[Array] = []
    for part, own in stars(mesh, points, light):
        inputs = part_of(part, path, scene, own).inputs
        assert inputs.tangents is not None
        rows.append(inputs.tangents[:])
    tangents = np.concatenate(rows)[place]
    return dataclasses.replace(options, tangents=tangents, line_field=inputs.line_field)


def moved(
    mesh: pv.DataSet, options: LightOptions, matrix: Array | None
) -> tuple[pv.DataSet, LightOptions]:
    """Return a mesh, and the options of its light, where an actor has placed it.

    Tangents move with it, and normals stay across its surface.
    """
    options = of_glyphs(mesh, options)
    if matrix is None:
        return mesh, options
    linear = matrix[:3, :3]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Integer points, vector")
        # Of a copy: PyVista makes active vectors of whole numbers in the mesh itself float32.
        placed = mesh.copy(deep=False).transform(
            matrix, transform_all_input_vectors=False, inplace=False
        )
    turned: Keywords = {}
    if (name := options.tangents) is not None:
        rows = tangents_of(mesh, name, 3)
        turned["tangents"] = (rows.reshape(-1, 3) @ linear.T).reshape(rows.shape)
        turned["line_field"] = options.line_field or without_sign(mesh, name)
    if (name := options.normals) is not None:
        rows = np.asarray(mesh.point_data[name] if isinstance(name, str) else name)
        turned["normals"] = rows @ np.linalg.inv(linear)
    return placed, dataclasses.replace(options, **turned)


def _moves_by_rows(
    mesh: pv.DataSet, light: LightOptions, kind: Kind, matrix: Array | None, *, lit: bool
) -> bool:
    """Return whether a matrix moves the points of many lines or points, and vectors that it has."""
    if matrix is None or mesh.n_points <= WHOLE or light.positions is not None or light.conditioned:
        return False
    if light.tangents is None:
        return kind == "point" and not lit
    rows = mesh.point_data.get(light.tangents) if isinstance(light.tangents, str) else None
    return kind == "line" and rows is not None and rows.shape[1:] == (3,)


def _moved_points(
    points: ArraySource, matrix: Array | None, *, shift: float = 1.0
) -> ArraySource:  # fmt: skip
    """Return points where a matrix places them, with a share of its shift, which are not stored."""
    if matrix is None:
        return points

    def at(ids: Indices) -> Array:
        moved_rows: Array = rows_of(points, ids) @ matrix[:3, :3].T + shift * matrix[:3, 3]
        return moved_rows

    return MadePoints(points.shape[0], at)


def of_glyphs(mesh: pv.DataSet, options: LightOptions) -> LightOptions:
    """Return options that name the vectors of glyphs, of which these are marks."""
    if options.tangents is None and GLYPH in mesh.point_data:
        return dataclasses.replace(options, tangents=GLYPH)
    return options


def _glyphs(mesh: pv.DataSet, cells: Indices | DrawnCells | DrawnPoints) -> Indices:
    """Return the numbers of the glyphs that cells belong to.

    VTK writes the points of one glyph after those of another, as many of each. In another mesh,
    such as one with split sharp edges, glyphs of equal vectors count as one.
    """
    vectors, cells = np.asarray(mesh.point_data[GLYPH]), cells[:]
    starts = np.flatnonzero((vectors[1:] != vectors[:-1]).any(axis=1)) + 1
    # Neighbours may have equal vectors.
    number = np.arange(len(vectors)) // np.diff([0, *starts, len(vectors)]).min()
    if (number[cells] != number[cells[:, :1]]).any():
        number = np.unique(vectors, axis=0, return_inverse=True)[1].ravel()
    return np.asarray(np.unique(number[cells[:, 0]], return_inverse=True)[1])


def camera_of(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene | None, view: AnyView, aspect: float
) -> pv.Camera:
    """Return the camera of a picture of some width over height."""
    eye = as_view(view) or (None if scene is None else scene.view)
    spaces = ("scene", scene), ("view", None if eye is None else Scene(view=eye))
    for name, space in spaces:
        if space is not None and space.n not in (None, 3):
            remedy = "project the mesh first, vizlight.project, and measure it in 3-space"
            raise ValueError(_check.message(name, "vectors of 3 components", space.n, remedy))
    if is_camera(view):
        camera = camera_on((-1, 1, -1, 1, -1, 1))
        # A copy, since drawing moves the clipping planes.
        camera.DeepCopy(view)
        return camera
    if eye is None:
        return camera_on(mesh, aspect=aspect)
    if eye.position is None or eye.parallel:
        assert eye.direction is not None
        up = eye.axes()[1].tolist()
        return camera_on(mesh, eye.direction, up=up, parallel=eye.parallel, aspect=aspect)
    position, toward = np.array(eye.position), np.array(eye.direction)
    if eye.direction is None:
        toward = position - np.reshape(mesh.bounds, (3, 2)).mean(axis=1)
    eye = View(direction=toward, up=eye.up)
    camera = camera_on((-1, 1, -1, 1, -1, 1), toward.tolist(), up=eye.axes()[1].tolist())
    camera.position = tuple(position)
    camera.focal_point = tuple(position - toward)
    camera.view_angle = VIEW_ANGLE
    return camera


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

    Lines of sight are those of :func:`rays`, ``corners`` (M, s, 3) are of a triangle, a segment or
    a point for each. Shares (M, s) are 0 or more with sum 1; for a segment, of its point nearest to
    the line.
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
    shares = np.maximum(np.stack([1 - second - third, second, third], axis=1), 0.0)
    return np.asarray(shares / shares.sum(axis=1, keepdims=True))


def flattened(vectors: Array, way: Array) -> Array:
    """Return the part of vectors that stands across unit directions."""
    return np.asarray(vectors - dots(vectors, way)[:, np.newaxis] * way)


def dots(a: Array, b: Array) -> Array:
    """Return the dot products of rows."""
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _ratio(a: Array, b: Array) -> Array:
    """Return a / b, and 0 for a cell that is seen edge on."""
    return np.divide(a, b, out=np.zeros_like(a), where=b > 0)
