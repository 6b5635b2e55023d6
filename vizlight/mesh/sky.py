"""The sky of meshes: height fields by horizons, all that has faces or lines by rays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check, _compiled
from vizlight._types import Array, Bools, Indices
from vizlight.geometry.lines import bundle as media
from vizlight.geometry.relief import sky as fields
from vizlight.mesh import blocks, bundles, normals, sky_rays
from vizlight.mesh.height_grids import Grid, Heights, elevation_name, heights_of
from vizlight.mesh.sky_rays import SkyPlaces
from vizlight.scene import View
from vizlight.shading.options import Bundle
from vizlight.shading.results import Record
from vizlight.verify import between
from vizlight.vtk import polylines
from vizlight.vtk.cells import GHOSTS, faces_only, has_faces, triangles

#: Error from which lines are taken for a medium of voxels, number of points at which rays measure
#: it, and number of pieces beyond which it is not measured, as rays need tubes around all lines.
VOXELS, SAMPLES, MANY = 0.1, 256, 500_000
#: Directions of light from all sides in a medium.
SIDES = 64
#: Bit of VTK's ghost array that marks a cell which is hidden, not one of another piece.
HIDDEN = 32
#: Up of a height field.
ABOVE = (0.0, 0.0, 1.0)
#: Least number of points for which a warning names the missing package.
SLOW = 5000


class Sky(NamedTuple):
    """The sky of a mesh.

    ``share`` is that of the sky that each point sees; one without a sky has the nearest point's.
    ``openness`` is in radians. ``record`` has method, error and effort, and ``dark`` is the number
    of points of a surface that see nothing. 95 of 100 places keep to ``between``, the error of
    values interpolated between the points of a surface.
    """

    share: Array
    valid: Bools
    openness: Array | None
    record: Record
    dark: int = 0
    between: float = 0.0
    requested: float = 0.0

    @property
    def error(self) -> float | None:
        """Error that 95 of 100 points keep to; None where it is not known."""
        value = self.record["error"]
        return value if isinstance(value, float) else None


class _Shape(NamedTuple):
    """Triangles of a mesh, and the points that look at the sky with their indices in the mesh."""

    points: Array
    triangles: Indices
    places: SkyPlaces
    ids: Indices


def skies(
    meshes: Sequence[pv.DataSet],
    *,
    error: float,
    up: tuple[float, ...] | None = None,
    diameter: float | None = None,
    openness: bool = False,
    report: Callable[[int], None] = lambda _: None,
    elevation: str | None = None,
    factor: float = 1.0,
) -> list[Sky]:
    """Return the sky of meshes: fields see themselves alone, all others hide one another's sky.

    95 of 100 points of each mesh shall keep to the error; ``up`` is the direction of the half space
    that is the sky of meshes that are no fields, and ``diameter`` that of lines. Only fields have
    an ``openness``, and ``elevation`` and ``factor`` as for :func:`vizlight.relief_shadow`.
    ``report`` takes the number of points, or of azimuths of a field, that are done.
    """
    skies_by_number: dict[int, Sky] = {}
    shapes: dict[int, pv.DataSet] = {}
    for number, mesh in enumerate(meshes):
        # Fields know their own horizon exactly; all other meshes hide one another's sky.
        field = _field(mesh, elevation, factor)
        if field is None:
            shapes[number] = mesh
            continue
        # The sky of a field is the half space above it: horizons know no other.
        if up is not None and not (up[2] > 0 and up[0] == up[1] == 0):
            remedy = "leave it out, or pass the surface of the grid"
            raise _check.value_error("up", "(0, 0, 1) for a height field", up, remedy)
        skies_by_number[number] = _of_field(field, error, openness=openness, report=report)
    if shapes and openness:
        remedy = "leave it out"
        raise _check.value_error("openness", "a height field", "another mesh", remedy)
    if shapes:
        by_rays = _by_rays([*shapes.values()], error, up, diameter, report)
        skies_by_number |= dict(zip(shapes, by_rays, strict=True))
    skies_in_order = [skies_by_number[number] for number in range(len(meshes))]
    return [
        sky._replace(record=sky.record | {"requested": error}, requested=error)
        for sky in skies_in_order
    ]


def is_grid(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is a grid of one layer, which is taken for ground below a sky."""
    return isinstance(mesh, Grid) and sum(size > 1 for size in mesh.dimensions) == 2


def _field(mesh: pv.DataSet, elevation: str | None, factor: float) -> Heights | None:
    """Return the height field of a grid of one layer; None where it is none."""
    if not (is_grid(mesh) and isinstance(mesh, Grid) and mesh.dimensions[2] == 1):
        return None
    if not isinstance(mesh, pv.StructuredGrid):
        # Without heights such a grid is flat.
        has_heights = elevation is not None or elevation_name(mesh) is not None
        return heights_of(mesh, elevation, factor) if has_heights else None
    try:
        return heights_of(mesh, elevation, factor)
    except ValueError:
        # Its rows and columns bend: a surface like any other, below the sky of a field.
        return None


def _of_field(
    field: Heights, error: float, *, openness: bool, report: Callable[[int], None]
) -> Sky:
    """Return the sky of a height field."""
    nodes = field.x, field.y, field.z
    ground = fields.sky(*nodes, error=error, stretch=field.stretch, progress=report)
    opened = None
    if openness:
        other = fields.sky(
            *nodes, error=error, openness=True, stretch=field.stretch, progress=report
        )
        # A hole has no horizon: its openness is 0.
        opened = np.nan_to_num(field.to_points(other.share))
    share = field.to_points(ground.share)
    valid: Bools = np.isfinite(share)
    record: Record = {
        "method": ground.method,
        "error": ground.error, "directions": ground.azimuths, "rays": ground.azimuths * share.size,
    }  # fmt: skip
    # A warning only where it takes long enough to be noticed.
    if (reason := _compiled.why_not()) and share.size > fields.SMALL:
        _check.warn(f"the sky takes ten times as long by NumPy: {reason}")
    points = field.points()
    return Sky(_filled(share, valid, points), valid, opened, record)


def _filled(share: Array, valid: Bools, points: Array) -> Array:
    """Return shares where points without a sky have the nearest point's."""
    if valid.all():
        return share
    share = np.where(valid, share, 1.0).astype(np.float32)
    # Points too far out would break the search and keep an open sky.
    lost = ~valid & (np.abs(points) <= _check.FARTHEST).all(axis=1)
    if valid.any() and lost.any():
        _, nearest = scipy.spatial.cKDTree(points[valid]).query(points[lost])
        share[lost] = share[valid][nearest]
    return share


def _by_rays(
    meshes: Sequence[pv.DataSet],
    error: float,
    up: tuple[float, ...] | None,
    diameter: float | None,
    report: Callable[[int], None],
) -> list[Sky]:
    """Return the skies of meshes that hide one another's sky."""
    # Only meshes of lines alone become tubes: lines beside faces hide nothing.
    lines = [mesh for mesh in meshes if polylines.has_lines_only(mesh)]
    if diameter is not None and not lines:
        got = "a mesh without lines"
        raise _check.value_error("diameter", "a mesh of lines", got, "leave it out")
    medium: media.Medium | None = None
    thick = 0.0
    # A medium also gives the default diameter, which rays need for their tubes.
    if lines and (diameter is None or error >= VOXELS):
        medium, thick = bundles.medium_of(bundles.joined(lines), Bundle(diameter=diameter))
    thick = thick if diameter is None else diameter
    # A bundle seen from inside is a medium: voxels are faster than rays where the error allows
    # them.
    among = medium is not None and error >= VOXELS and len(lines) == len(meshes) and up is None
    if among and medium is not None and medium.middles.shape[1] > MANY:
        return [_in_medium(mesh, medium, thick) for mesh in meshes]
    # Ground has a sky above it alone, also where it is a bent grid and no field.
    above = [ABOVE if up is None and is_grid(mesh) else up for mesh in meshes]
    shapes = [_shape(mesh, thick, axis) for mesh, axis in zip(meshes, above, strict=True)]
    hidden = _occluders(shapes)
    if among and medium is not None:
        by_voxels = [_in_medium(mesh, medium, thick) for mesh in meshes]
        # The medium's error is not known beforehand: rays from some points measure it.
        worst = [_missed(sky, shape, hidden) for sky, shape in zip(by_voxels, shapes, strict=True)]
        if max(worst) <= error:
            return [
                sky._replace(record=sky.record | {"error": measured})
                for sky, measured in zip(by_voxels, worst, strict=True)
            ]
    total = sum(len(shape.ids) for shape in shapes)
    if hidden.tracer.name != "rays by Embree" and total > SLOW:
        remedy = "pip install 'vizlight[rays]'"
        _check.warn(f"the sky takes 20 times as long without embreex (try: {remedy})")
    results, done = [], 0
    for mesh, shape, axis in zip(meshes, shapes, above, strict=True):
        seen = hidden.seen(
            shape.places, error=error, up=None if axis is None else np.array(axis, np.float64),
            report=lambda now, done=done: report(done + now),  # type: ignore[misc]
        )  # fmt: skip
        done += len(shape.ids)
        share = np.zeros(mesh.n_points, np.float32)
        valid = np.zeros(mesh.n_points, np.bool_)
        share[shape.ids], valid[shape.ids] = seen.share, seen.valid
        record: Record = {
            "method": hidden.tracer.name, "error": seen.error, "rays": seen.rays,
            "directions": round(seen.rays / max(len(shape.ids), 1)),
        }  # fmt: skip
        dark, off = 0, 0.0
        if polylines.has_lines_only(mesh):
            record["diameter"] = thick
        else:
            dark = int(np.count_nonzero(valid & (share == 0)))
            off = _between(seen, shape, hidden, axis)
            record |= {"dark": dark, "between": off}
        places = np.asarray(mesh.points, np.float64)
        results.append(Sky(_filled(share, valid, places), valid, None, record, dark, off))
    return results


def _occluders(shapes: Sequence[_Shape]) -> sky_rays.Occluders:
    """Return the triangles of all shapes."""
    counts = np.cumsum([0, *(len(shape.points) for shape in shapes)])
    # Points of all shapes are numbered one after the other.
    faces = [shape.triangles + at for shape, at in zip(shapes, counts[:-1], strict=True)]
    points = np.concatenate([shape.points for shape in shapes])
    return sky_rays.Occluders(points, np.concatenate(faces))


def _between(
    seen: sky_rays.Seen, shape: _Shape, hidden: sky_rays.Occluders, up: tuple[float, ...] | None
) -> float:
    """Return the error of interpolated shares at 95 of 100 places on the faces."""
    places, _ = between.random_places(
        shape.points, shape.triangles, SAMPLES, np.random.default_rng(0)
    )
    # Where a corner has no sky, nothing is interpolated.
    good = seen.valid[places.corners].all(axis=1)
    places = between.Places(places.corners[good], places.weights[good])
    at = between.interpolated(shape.points, places)
    ways = sky_rays.across(shape.points, places.corners)
    axis = None if up is None else np.array(up, np.float64)
    # The light between the points is interpolated; rays from there tell what that misses.
    true = hidden.seen(sky_rays.SkyPlaces(at, ways), error=VOXELS / 4, up=axis)
    off = np.abs(true.share - between.interpolated(seen.share, places))[true.valid]
    return float(np.quantile(off, 0.95)) if len(off) else 0.0


def _missed(sky: Sky, shape: _Shape, hidden: sky_rays.Occluders) -> float:
    """Return the error that 95 of 100 points keep to, as rays from some of them find it."""
    some = np.random.default_rng(0).permutation(np.flatnonzero(sky.valid))[:SAMPLES]
    if not len(some):
        return 0.0
    points, ways, radius, _ = shape.places
    seen = hidden.seen(sky_rays.SkyPlaces(points[some], ways[some], radius), error=VOXELS / 4)
    return float(np.quantile(np.abs(sky.share[some] - seen.share), 0.95))


def in_medium(
    mesh: pv.DataSet, lines: tuple[media.Medium, float], normals: Array | None = None
) -> Array:
    """Return the share of light from all sides at points of a surface, or of lines, among lines.

    ``lines`` are given with their diameter; a surface has ``normals``.
    """
    medium, thick = lines
    points = np.asarray(mesh.points)
    if normals is not None:
        targets = medium.targets(points, normals)
    else:
        halves = polylines.of_points(mesh, media.line_halves)
        targets = medium.targets(points, polylines.line_tangents(mesh), halves)
    return medium.sky(targets, thick, SIDES)


def _in_medium(mesh: pv.DataSet, medium: media.Medium, thick: float) -> Sky:
    """Return the sky of lines inside a medium of lines, by voxels."""
    points, tangents = np.asarray(mesh.points), polylines.line_tangents(mesh)
    share = in_medium(mesh, (medium, thick))
    valid: Bools = np.any(tangents, axis=1) & np.isfinite(points).all(axis=1)
    record: Record = {
        "method": "voxels", "error": None, "directions": SIDES, "rays": 0, "diameter": thick,
        "voxel": medium.voxel,
    }  # fmt: skip
    return Sky(_filled(share, valid, points.astype(np.float64)), valid, None, record)


def _shape(mesh: pv.DataSet, thick: float, up: tuple[float, ...] | None) -> _Shape:
    """Return the triangles by which a mesh hides the sky, and its points that look at it.

    Open pieces without normals of their own face a sky that is above.
    """
    if polylines.has_lines_only(mesh):
        points, ids, offsets = polylines.cells_of(mesh)
        # A line has no area that could hide anything: tubes of its diameter stand for it.
        vertices, faces = sky_rays.tubes(points, ids, offsets, thick / 2)
        ways = polylines.line_tangents(mesh)
        places = sky_rays.SkyPlaces(np.asarray(mesh.points), ways, thick / 2)
        return _Shape(vertices, faces, places, np.arange(mesh.n_points))
    surface, ids = _surface(mesh)
    if not has_faces(surface):
        remedy = "take its surface, lines or glyphs, which have directions"
        got = f"{type(mesh).__name__} without either"
        raise _check.value_error("mesh", "a mesh with faces or lines", got, remedy)
    points = np.asarray(pv.wrap(surface).points, np.float64)
    faces = np.asarray(triangles(faces_only(surface)), np.intp)
    view = None if up is None else View(direction=up)
    ways = np.asarray(normals.normals_of(mesh, None, 3, view), np.float64)
    outward = ways[ids]
    faces = sky_rays.turned(points, faces, outward)
    # A ray must not meet the faces around its own start.
    beside = sky_rays.beside(points, faces)
    return _Shape(points, faces, sky_rays.SkyPlaces(points, outward, beside=beside), ids)


def _surface(mesh: pv.DataSet) -> tuple[pv.PolyData, Indices]:
    """Return the surface of a mesh without hidden cells, and its points' indices in the mesh.

    Cells of other pieces stay: they hide the sky.
    """
    marks, numbers = mesh.cell_data.get(GHOSTS), None
    if marks is not None:
        hidden = (np.asarray(marks) & HIDDEN) > 0
        # VTK's filter leaves out faces of cells that another piece has, which hide the sky all the
        # same.
        mesh = mesh.copy(deep=False)
        del mesh.cell_data[GHOSTS]
        if hidden.any():
            mesh = mesh.extract_cells(np.asarray(~hidden, dtype=bool))
            # Extraction has numbered the points anew.
            numbers = np.asarray(mesh.point_data["vtkOriginalPointIds"], np.intp)
    if isinstance(mesh, pv.PolyData):
        return mesh, np.arange(mesh.n_points)
    surface, ids = blocks.outer_surface(mesh)
    return surface, ids if numbers is None else numbers[ids]
