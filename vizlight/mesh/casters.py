"""Shadow casters: a height field, or a closed surface with further closed surfaces."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Bools, FeatureAngle, VectorLike
from vizlight.geometry.relief import height_field, shadowing
from vizlight.geometry.relief.height_field import Border
from vizlight.mesh import closed_meshes, georeference, normals
from vizlight.mesh.height_grids import Grid, Raster, heights_of
from vizlight.model import kernels
from vizlight.scene import Light, Scene
from vizlight.shading.options import Options, check_sides
from vizlight.verify import rays

#: Default depth of a closed surface, as a share of the diagonal of the mesh.
DEPTH = 0.01
#: Largest distance of a light in sizes of the surface: a light farther away is moved there, so that
#: squares do not overflow.
FAR = 1e100
#: Range of heights, as a share of the side of a map, below which its slopes are not seen.
UNSEEN = 1e-4
#: Largest difference of steps that are even, as a share of their mean.
EVEN = 1e-4
#: Options that only height fields have.
FIELD_ALONE = ("elevation", "exaggeration", "border", "raster")


@dataclass(frozen=True, kw_only=True)
class CasterOptions(Options):
    """Options of casting shadows.

    The fields are keywords of :func:`vizlight.relief_shadow`.
    """

    depth: float | None = None
    elevation: str | None = None
    exaggeration: float = 1.0
    border: Border = "extend"
    raster: float | None = None
    thickness: float | None = None
    feature_angle: FeatureAngle = None
    occluders: pv.PolyData | Sequence[pv.PolyData] = ()

    def __post_init__(self) -> None:
        occluders: object = self.occluders
        if isinstance(occluders, pv.DataObject):
            occluders = [occluders]
        # Text and arrays can be iterated, too, but are no meshes.
        if isinstance(occluders, str | np.ndarray) or not isinstance(occluders, Iterable):
            raise _check.type_error("occluders", "a closed surface or several", occluders)
        _check.set_fields(self, occluders=list(occluders))
        if self.thickness is not None:
            _check.positive("thickness", self.thickness)
        if self.elevation is not None:
            _check.text("elevation", self.elevation, expected="the name of a point array")
        check_sides("auto", self.feature_angle)


def caster(mesh: pv.DataSet, scene: Scene, options: CasterOptions) -> FieldCaster | SolidCaster:
    """Return a mesh that casts shadows on itself.

    ``ratios`` gives t at all its points and reports the number of rays followed, ``reference``
    gives t at one point by an independent method, NaN where that does not apply. ``valid`` is the
    mask of the points that have a t, ``depth`` the depth d, and ``effort`` the number of planes of
    nodes or triangles that ``reference`` visits for one t, 0 if it finds none.
    """
    sampled = options.raster is not None
    if isinstance(mesh, Grid) or (sampled and isinstance(mesh, pv.PolyData)):
        for option in ("thickness", "feature_angle", "occluders"):
            value = getattr(options, option)
            if value:
                got = len(value) if option == "occluders" else repr(value)
                remedy = "leave it out, or pass the surface of the grid as a closed mesh"
                raise _check.value_error(option, "none on a height field", got, remedy)
        return FieldCaster(mesh, options)
    if isinstance(mesh, pv.PolyData):
        defaults = {field.name: field.default for field in dataclasses.fields(options)}
        for option in FIELD_ALONE:
            setting, default = getattr(options, option), defaults[option]
            if setting is not default and (default is None or np.any(setting != default)):
                remedy = "leave it out, or pass a grid"
                raise _check.value_error(option, "none on a surface", repr(setting), remedy)
        return SolidCaster(mesh, scene, options)
    expected = "a height field (ImageData, RectilinearGrid, StructuredGrid) or a closed PolyData"
    remedy = "take the mesh's extract_surface()"
    raise TypeError(_check.message("mesh", expected, type(mesh).__name__, remedy))


class EvenField(NamedTuple):
    """Height field of even rows and columns, by which a shader casts shadows.

    ``heights`` (ny, nx) are above the ``origin``, the place of the first node at the height 0; the
    rows of ``axes`` take a vector of the mesh to cells along x and y, and a height. ``depth`` is
    the depth d at which light is gathered.
    """

    heights: Array
    origin: Array
    axes: Array
    depth: float


class FieldCaster:
    """Shadows of a height field."""

    def __init__(self, grid: Grid | pv.PolyData, options: CasterOptions) -> None:
        heights = heights_of(grid, options.elevation, options.exaggeration, options.raster)
        # Where the ground goes on beyond the border and in holes its slope does, for one cell.
        self._rim = int(str(options.border) == "extend")
        nodes = height_field.continued(heights.x, heights.y, heights.z) if self._rim else (
            heights.x, heights.y, heights.z
        )  # fmt: skip
        stretch = heights.stretch
        if stretch is not None:
            stretch = np.pad(stretch, self._rim, mode="edge")
        field = height_field.make(*nodes, border=options.border, stretch=stretch)
        self._field = field
        self._normal, self._heights = height_field.normals(field), heights
        # From the axes of the mesh to those of the grid's rows and columns.
        self._turn = np.eye(3) if heights.turn is None else heights.turn
        # The nodes are then others than the points of the mesh.
        sampled = isinstance(heights, Raster)
        # By the nodes of the grid, without the ring.
        inner = dataclasses.replace(
            field,
            x=field.x[self._rim :][: len(heights.x)] - field.x[self._rim],
            y=field.y[self._rim :][: len(heights.y)] - field.y[self._rim],
            heights=self._inner(field.heights),
            stretch=field.stretch[self._rim :][: len(heights.y)],
            top=float(np.nanmax(heights.z) - np.nanmin(heights.z)),
        )
        self.depth = _depth(options.depth, height_field.default_depth(inner))
        self.points = heights.points()
        covered = np.isfinite(heights.z)
        upright = self._inner(self._normal)
        if heights.turn is not None:
            # Rows times a rotation are turned by its transpose, here back to the axes of the mesh.
            upright = upright @ self._turn
        upright = heights.to_points(np.where(covered[..., np.newaxis], upright, 0))
        # Interpolated from the nodes around, normals are shorter than 1.
        self.normals = kernels.unit_rows(upright) if sampled else upright
        self.valid: Bools = heights.covered() & (heights.to_points(covered * 1.0) > 0)
        if georeference.UNIT in grid.field_data and 0 < inner.top < UNSEEN * inner.size:
            wanted = georeference.ENOUGH[0] * inner.size / inner.top * options.exaggeration
            _check.warn(
                f"the heights of the map range over {inner.top / inner.size:.1g} of its side, a "
                f"relief that nobody sees; pass exaggeration={10 ** round(np.log10(wanted)):g}"
            )
        # The oracle follows single rays; it knows fields as they are, not resampled ones.
        exact = not sampled and self.depth > shadowing.LEAST_DEPTH * field.size
        self.effort = sum(field.heights.shape) if exact else 0

    def ratios(self, light: Light, report: Callable[[int], None]) -> Array:
        """Return t at all points; ``report`` takes the number of rays followed so far."""
        rays, nodes = self._field.heights.size, self._heights.z.size
        t = shadowing.ratio(
            self._field, self._normal, self.depth, direction=self._turned(light.direction),
            position=self._turned(light.position),
            report=lambda done: report(done * nodes // rays),
        )  # fmt: skip
        t = self._inner(t).copy()
        t[np.isnan(self._heights.z)] = 0
        t = self._heights.to_points(t)
        t[~self.valid] = 0
        return t

    def even(self, mesh: pv.DataSet) -> tuple[EvenField | None, str]:
        """Return the field for a shader that draws its mesh, or None and why it has none."""
        field = self._field
        if isinstance(self._heights, Raster):
            return None, "the height field is sampled from a surface"
        if field.border != "extend":
            return None, "a border of walls is known at the points"
        if self.depth <= shadowing.LEAST_DEPTH * field.size:
            return None, "the limit for depth 0 is known at the points"
        steps = [np.diff(axis) for axis in (field.x, field.y)]
        if any(np.ptp(step) > EVEN * step.mean() for step in steps):
            return None, "rows or columns of the height field are uneven"
        of_mesh = np.asarray(mesh.points)[:, :2]
        if np.ptp(field.stretch) or not np.allclose(self.points[:, :2], of_mesh, rtol=1e-6):
            return None, "the field is a map in degrees"
        step_x, step_y = (float(step.mean()) for step in steps)
        axes = self._turn / np.array([[step_x], [step_y], [1.0]])
        # Rows times a rotation are turned by its transpose, here back to the axes of the mesh.
        return EvenField(field.heights, field.origin @ self._turn, axes, self.depth), ""

    def _inner(self, rows: Array) -> Array:
        """Return the rows at the nodes of the grid itself."""
        end = -self._rim or None
        return rows[self._rim : end, self._rim : end]

    def reference(self, point: int, light: Light) -> float:
        """Return t at one point by an independent method; NaN where that does not apply."""
        field, way, end = self._field, self._turned(light.direction), self._turned(light.position)
        # Below the horizon every ray is inside for ever; the oracle does not integrate that.
        if not self.effort or (way is not None and way[2] <= 0):
            return math.nan
        place = self._turn @ self.points[point] - field.origin
        # In the frame of the point, where the field has been stretched along x.
        scale = np.array([field.stretch[np.argmin(np.abs(field.y - place[1]))], 1.0, 1.0])
        return rays.relief_ratio(
            scale[0] * field.x, field.y, field.heights, scale * place,
            self._turn @ self.normals[point], self.depth, way=way,
            end=None if end is None else scale * (end - field.origin),
            wall=field.border != "extend",
        )  # fmt: skip

    def _turned(self, vector: VectorLike | None) -> Array | None:
        return None if vector is None else self._turn @ np.array(vector)


class SolidCaster:
    """Shadows of a closed surface and of the occluders."""

    def __init__(self, mesh: pv.PolyData, scene: Scene, options: CasterOptions) -> None:
        thickness = options.thickness
        # An open surface raises its error before normals are computed; a shell is made of these.
        if thickness is None:
            body = closed_meshes.closed(mesh)
        vectors = normals.normals_of(
            mesh, None, 3, normals.onlooker(scene), warn=options.feature_angle is None
        )
        self.normals = kernels.unit_rows(vectors)
        if thickness is not None:
            body = closed_meshes.shell(mesh, thickness, self.normals)
        # All bodies at once: lengths inside overlapping ones count once.
        bodies = [body]
        for i, other in enumerate(options.occluders):
            bodies.append(closed_meshes.closed(other, f"occluders[{i}]"))
        # Lengths are in units of the size of the surface, so that products neither overflow nor
        # underflow.
        self._origin = body[0].mean(axis=0)
        self._unit = float(np.linalg.norm(np.ptp(body[0], axis=0))) or 1.0
        self._solids = [
            closed_meshes.Body(*triangles, self._origin, self._unit) for triangles in bodies
        ]
        self.depth = _depth(options.depth, DEPTH * self._unit)
        self._share = self.depth / self._unit
        self.points: Array = np.asarray(mesh.points, dtype=np.float64)
        self._places = (self.points - self._origin) / self._unit
        self.valid = np.any(self.normals, axis=1) & np.all(np.isfinite(self.points), axis=1)
        faces = sum(len(body.triangles) for body in self._solids)
        self.effort = faces if self._share > shadowing.LEAST_DEPTH else 0

    def ratios(self, light: Light, report: Callable[[int], None]) -> Array:
        """Return t at all points; ``report`` takes the number of rays followed so far."""
        good, depth = self.valid, self._share
        # At depth 0 the limit of t is the cosine where the way is free, else 0: rays start just
        # outside the surface, so that they miss their own facet.
        limit = depth <= shadowing.LEAST_DEPTH
        normal = self.normals[good]
        start = self._places[good] - (-1e-7 if limit else depth) * normal
        # A lamp at a place ends its rays; what stands behind it casts no shadow here.
        way, reach = self._toward(light, start)
        length = closed_meshes.inside_length(self._solids, start, way, reach, report)
        t = np.zeros(len(good))
        if limit:
            cosine = np.clip(np.einsum("ij,ij->i", normal, way), 0, 1)
            t[good] = np.where(length > 0, 0.0, cosine)
        else:
            # t = d / r (cos-theta, section 2), which is the cosine on a plane; a ray shorter than d
            # is free.
            t[good] = depth / np.maximum(length, depth)
        return t

    def reference(self, point: int, light: Light) -> float:
        """Return t at one point by an independent method; NaN where that does not apply."""
        corners = [body.corners for body in self._solids]
        place, normal = self._places[point], self.normals[point]
        way, reach = self._toward(light, (place - self._share * normal)[np.newaxis])
        far = min(float(reach[0]), 10.0 * max(float(np.abs(c).max()) for c in corners))
        return rays.solid_ratio(corners, place, normal, self._share, way[0], far)

    def _toward(self, light: Light, start: Array) -> tuple[Array, Array]:
        if light.direction is not None:
            way = kernels.unit_rows([light.direction])
            return np.repeat(way, len(start), axis=0), np.full(len(start), np.inf)
        # Lights are in the unit of the mesh, rays in sizes of the solid.
        place = np.array(light.position) - self._origin
        place /= max(self._unit, np.abs(place).max() / FAR)
        if any(closed_meshes.is_inside(body, place) for body in self._solids):
            expected, got = "a light outside the solid", light.position
            raise _check.value_error("position", expected, got, "move the light")
        reach = np.linalg.norm(place - start, axis=1)
        return (place - start) / np.where(reach > 0, reach, 1)[:, np.newaxis], reach


def _depth(depth: float | None, default: float) -> float:
    return default if depth is None else _check.number("depth", depth, low=0.0)
