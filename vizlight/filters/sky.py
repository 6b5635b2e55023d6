"""The share of a uniform sky that each point sees, as a point array."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPointSet, vtkPolyData

from vizlight import _check, _progress
from vizlight._types import FeatureAngle, Given, Raw
from vizlight._version import __version__
from vizlight.geometry.relief.sky import LARGEST, LEAST
from vizlight.mesh import blocks, normals, records, subdivision
from vizlight.mesh.blocks import MeshT
from vizlight.mesh.sky import MANY, VOXELS, Sky, skies
from vizlight.model import kernels
from vizlight.scene.keywords import named
from vizlight.shading.options import Options, check_sides
from vizlight.shading.results import VALID, Record, digest, plain
from vizlight.vtk.cells import places, point_data
from vizlight.vtk.corners import SHARP
from vizlight.vtk.normals import computed_normals
from vizlight.vtk.polylines import has_lines_only

#: Name of the array, which stands for a sky that is computed where a mesh has none.
SKY = "sky"
OPENNESS = "_openness"
#: Errors of a sky that is computed for light alone: of lines twice the least of voxels.
FOR_LIGHT = (0.02, 2 * VOXELS)
#: The same where none is asked for.
FOR_POINTS = (0.01, VOXELS)
#: Error between the points from which a picture shows the triangles.
BENT = 0.1
#: Number of sides of triangles across a surface that is made finer, and of points it may have.
ACROSS, MOST = 32, 1 << 17


@dataclass(frozen=True, kw_only=True)
class SkyOptions(Options):
    """Options of a sky; the fields are keywords of :func:`vizlight.sky`."""

    error: float | None = None
    up: Sequence[float] | None = None
    diameter: float | None = None
    openness: bool = False
    feature_angle: FeatureAngle = "auto"
    name: str = SKY

    def __post_init__(self) -> None:
        _check.flags(self)
        _check.fields(self, _check.number, "error", optional=True, low=LEAST, high=LARGEST)
        _check.fields(self, _check.vector, "up", optional=True, direction=True, n=3)
        _check.fields(self, _check.positive, "diameter", optional=True)
        _check.fields(self, _check.array_name, "name")
        check_sides("auto", self.feature_angle)


@named
def sky(
    mesh: MeshT,
    /,
    *,
    error: float | None = None,
    up: Sequence[float] | None = None,
    diameter: float | None = None,
    openness: bool = False,
    feature_angle: FeatureAngle = "auto",
    name: str = SKY,
    inplace: bool = False,
    progress_bar: bool = False,
) -> MeshT:
    """Return a mesh with the share of a uniform sky that each point sees.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Height field, surface, mesh of cells, of which the surface counts, or mesh of lines. Blocks
        hide one another's sky; a height field sees itself alone. Not changed, unless ``inplace``.
    error : float, optional
        Error that 95 of 100 points shall keep to, from 0.0001 to 0.5. Default: 0.01, of lines 0.1.
        From 0.1 on a mesh of lines is taken for a medium of voxels, which is faster for many lines,
        where rays from some points confirm it; for more than 500 thousand voxels of lines no rays
        are taken, and the error is None.
    up : sequence of 3 float, optional
        Direction of the half space that is the sky. Default: the z axis for a grid of one layer,
        else the sky is all round.
    diameter : float, optional
        Diameter of lines, in the unit of the mesh. Default: as in a bundle, see
        :class:`vizlight.Bundle`.
    openness : bool, default: False
        Whether the array ``<name>_openness`` is added: the mean angle between the zenith and the
        horizon of a height field, in radians.
    feature_angle : float, "auto" or None, default: "auto"
        Angle in degrees between two faces of a PolyData surface above which points on their common
        edge are split, as by :func:`vizlight.illuminate`: each of them sees the sky of its own
        side. Large triangles inside of which the sky changes are split too. The result then has
        more points than the mesh. None: the points stay, and one of an edge has one sky, that of
        its mean normal.
    name : str, default: "sky"
        Name of the result.
    inplace, progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        With the point array ``sky`` in [0, 1] and ``sky_provenance``, which holds the ``error``
        that was found beside the one ``requested``, the numbers of ``directions`` per point and of
        ``rays``, and the ``method``; of surfaces also ``between``, the error of values interpolated
        at 95 of 100 places on the faces, and ``dark``, the number of points that see nothing.
        ``sky_valid`` marks points that have no sky: in a hole, without a normal, or buried inside a
        surface. They have the share of the nearest point that has one.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit; if a mesh has neither faces nor lines.

    Warns
    -----
    UserWarning
        Once, with both figures, if the error found is larger than the one requested. Once, with
        the count, if points have no sky, and if points of a surface see nothing; once, if the sky
        changes inside of triangles, if a volume has many sharp edges, which cannot be split, and if
        a package that is missing makes many points slow.

    Notes
    -----
    ``V = 1/pi * integral of max(n . w, 0) dw`` over the directions w in which nothing stands; n is
    the normal on the side that the mesh's own normals have, else of an open piece toward ``up`` or
    away from its centre. A point of a line has the mean over the circumference of its tube. An
    endless slope of angle b sees (1 + cos b) / 2; light from other points is not part of V.

    Fields: horizons through every cell, of large ones by scan lines, exact for near cells; holes
    hide nothing, though the side of a cell between two heights does, and heights beyond the border
    are those of the border. The error is measured by half of the azimuths, and at random nodes
    against every cell in the way. Which way is taken depends on the field and the error alone.
    Surfaces and lines: rays in float32; the error is that of two halves of the rays, pooled over
    points like each other, which is no bound for a single point. A point that sees nothing has the
    sky of a place beside it on its largest triangle: where faces meet inward, rounding puts the
    point itself on the wrong side of one.

    The mean of :func:`vizlight.relief_shadow` over the sky is V only at depth 0.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> round(float(vizlight.sky(pv.Sphere())["sky"].min()), 2)
    1.0
    """
    options = SkyOptions.of(locals())
    chosen = blocks.check(mesh)
    inplace = _check.boolean("inplace", inplace)
    more = [options.name + OPENNESS] if options.openness else []
    records.refuse_overwriting(chosen, options.name, [options.name, options.name + VALID, *more])
    taken = [_split(block, options) for block, _ in chosen]
    finer = options.feature_angle is not None
    taken, results = _found_finer(taken, options, finer=finer, show=progress_bar)
    # Nothing is attached before all is computed: a failure leaves the mesh as it was.
    out, lit = blocks.placed(mesh, taken, inplace=inplace)
    _attach(lit, results, options, finer=finer)
    _warn_of_lost(results, options)
    return out


def with_sky(
    meshes: Sequence[pv.DataSet],
    occlusion: str | None,
    *,
    elevation: str | None = None,
    factor: float = 1.0,
    up: Sequence[float] | None = None,
    finer: bool = False,
) -> list[pv.DataSet]:
    """Return meshes with the array of their share of the ambient light.

    Where its name is "sky" and some mesh has none, it is computed for all, as :func:`sky` does with
    an error of 0.02, lines as voxels; those meshes are shallow copies, or with ``finer`` meshes of
    smaller triangles where the sky changes inside of triangles. ``elevation`` and ``factor`` are
    the same as in :func:`vizlight.relief_shadow`.
    """
    if occlusion is not None:
        _warn_if_stale(meshes, occlusion)
    if occlusion != SKY or all(SKY in mesh.point_data for mesh in meshes):
        return list(meshes)
    # Edges are not split here: the caller has done so where it wants that.
    options = SkyOptions(error=_error(meshes, FOR_LIGHT), up=up, feature_angle=None)
    taken, results = _found_finer(
        meshes, options, finer=finer, show=False, elevation=elevation, factor=factor
    )
    lit = [mesh.copy(deep=False) for mesh in taken]
    _attach(lit, results, options, finer=finer)
    if elevation is None:
        # Of heights the caller says which are missing.
        _warn_of_lost(results, options)
    return lit


def _split(mesh: pv.DataSet, options: SkyOptions) -> pv.DataSet:
    """Return a mesh with points split at its sharp edges; of a volume warn of the edges."""
    if options.feature_angle is not None and mesh.GetMaxSpatialDimension() == 3:
        # This is called for its warning: points of a volume cannot be split.
        normals.normals_of(mesh, None, 3, None, warn=True)
    return normals.split_where_computed(mesh, options.feature_angle)


def _error(meshes: Sequence[pv.DataSet], errors: tuple[float, float]) -> float:
    """Return the error for meshes, the second one if they are lines."""
    # True counts as 1: meshes of lines alone have the second error.
    return errors[all(has_lines_only(mesh) for mesh in meshes)]


def _source(mesh: object) -> str | None:
    """Return a digest of the points and the number of triangles, on which a sky depends.

    None for a grid that stores no points.
    """
    if not isinstance(mesh, vtkPointSet):
        return None
    count = mesh.GetNumberOfCells()
    if isinstance(mesh, vtkPolyData):
        # A polygon or a strip of n points is n - 2 triangles.
        cells = (mesh.GetPolys(), mesh.GetStrips())
        count = sum(c.GetNumberOfConnectivityIds() - 2 * c.GetNumberOfCells() for c in cells)
    return f"{digest(places(mesh))} {count}"


def _warn_if_stale(meshes: Sequence[pv.DataSet], name: str) -> None:
    """Warn if points or faces have changed since their sky was found.

    A mesh of other points that was made from one with a sky, such as a part of it, has other rows.
    """
    for mesh in meshes:
        record = records.read(mesh, name) or {}
        source = record.get("source")
        # Without a source there is nothing to compare, and an array that was changed is the user's
        # own.
        if source in (None, _source(mesh)) or name not in records.made(mesh, name):
            continue
        remedy = f"vizlight.sky(mesh, name={name!r})" if name != SKY else "vizlight.sky(mesh)"
        _check.warn(
            f"the points or the faces have changed since their sky {name!r} was found; "
            f"{remedy} finds it anew"
        )
        # One warning stands for all blocks.
        return


def _found_finer(
    meshes: Sequence[pv.DataSet], options: SkyOptions, *, finer: bool, **how: Given
) -> tuple[list[pv.DataSet], list[Sky]]:
    """Return meshes and their skies, with ``finer`` by smaller triangles where these are needed."""
    results = _found(meshes, options, **how)
    if not finer:
        return list(meshes), results
    fine = [
        _finer(mesh) if result.between > BENT else mesh
        for mesh, result in zip(meshes, results, strict=True)
    ]
    # Where no mesh became finer the first skies stand.
    if all(fine_mesh is other for fine_mesh, other in zip(fine, meshes, strict=True)):
        return fine, results
    return fine, _found(fine, options, **how)


def _finer(mesh: pv.DataSet) -> pv.DataSet:
    """Return a surface of faces with sides of a part of its size, anything else as it is.

    It looks as smooth as it was: its normals are those of the surface, interpolated.
    """
    if not isinstance(mesh, pv.PolyData):
        return mesh
    # The second bound keeps the number of points to about MOST.
    side = max(mesh.length / ACROSS, 2 * (mesh.area / MOST) ** 0.5)
    sided = normals.kept(mesh) or computed_normals(mesh)
    bare = mesh.copy(deep=False)
    # As a point array the normals are interpolated with the points; computed anew they would be
    # those of flat triangles.
    bare.point_data[normals.KEPT] = np.concatenate([sided.vectors, sided.facts()], axis=1)
    fine = subdivision.with_sides(bare, side)
    if fine.n_points == mesh.n_points:
        return mesh
    rows = np.asarray(fine.point_data.pop(normals.KEPT), dtype=np.float64)
    vectors, lean = kernels.unit_rows(rows[:, :3]).astype(np.float32), rows[:, 3]
    # Numbers of pieces are interpolated too, and rounded back to integers.
    number = np.rint(rows[:, 4]).astype(np.intp)
    # Normals that count as kept would not be attached to a mesh.
    finer_normals = dataclasses.replace(sided, vectors=vectors, lean=lean, open=number, kept=False)
    normals.keep(fine, finer_normals)
    return fine


def _found(
    meshes: Sequence[pv.DataSet],
    options: SkyOptions,
    *,
    show: bool,
    elevation: str | None = None,
    factor: float = 1.0,
) -> list[Sky]:
    total = sum(mesh.n_points for mesh in meshes)
    error = options.error or _error(meshes, FOR_POINTS)
    with _progress.progress("sky", total, show=show) as report:
        return skies(
            meshes, error=error, up=None if options.up is None else tuple(options.up),
            diameter=options.diameter, openness=options.openness,
            report=lambda now: report(min(now, total)), elevation=elevation, factor=factor,
        )  # fmt: skip


def _warn_of_lost(results: Sequence[Sky], options: SkyOptions) -> None:
    """Warn if points have no sky."""
    lost = sum(int(np.count_nonzero(~result.valid)) for result in results)
    if lost:
        total = sum(len(result.valid) for result in results)
        _check.warn(
            f"{lost} of {total} points have no sky (in a hole, without a normal, or buried inside "
            f"a surface) and that of the nearest point; the point array {options.name + VALID!r} "
            "marks them"
        )


def _attach(
    meshes: Sequence[pv.DataSet], results: Sequence[Sky], options: SkyOptions, *, finer: bool
) -> None:
    """Attach skies to meshes, with their records."""
    dark = 0
    bent, length = 0.0, 0.0
    errors = [result.error for result in results if result.error is not None]
    requested = max((result.requested for result in results), default=0.0)
    if (largest := max(errors, default=0.0)) > requested:
        _check.warn(
            f"the error of the sky is {largest:.2g} at 95 of 100 points, and error={requested:g} "
            "was requested, which needs more directions than are tried"
        )
    if len(errors) < len(results):
        _check.warn(
            f"the error of the sky is not known, and error={requested:g} was requested: lines of "
            f"more than {MANY} voxels are not compared with rays; error={VOXELS / 2:g} takes rays"
        )
    for mesh, result in zip(meshes, results, strict=True):
        arrays: dict[str, Raw] = {options.name: result.share}
        dark += result.dark
        # The warning is about the mesh in which the sky changes most.
        if result.between > bent:
            bent, length = result.between, mesh.length
        missing = int(np.count_nonzero(~result.valid))
        if missing:
            arrays[options.name + VALID] = result.valid
        if result.openness is not None:
            arrays[options.name + OPENNESS] = result.openness
        record: Record = {
            "vizlight": __version__, "filter": "sky", "precision": "float32", **result.record,
            "points": len(result.valid), "invalid": missing, "options": plain(options),
            "source": _source(mesh),
        }  # fmt: skip
        active = point_data(mesh).GetScalars()
        records.attach(mesh, options.name, arrays, record)
        if active is not None:
            # Such as the heights of a flat grid.
            records.activate(mesh, active.GetName())
    if dark:
        total = sum(len(result.valid) for result in results)
        _check.warn(
            f"{dark} of {total} points see nothing of the sky: they lie in cavities or folds, or "
            "other faces touch them"
        )
    if bent > BENT:
        remedy = f"feature_angle={SHARP:g} splits them"
        if finer:
            side = float(f"{length / (2 * ACROSS):.1g}")
            remedy = f"mesh.triangulate().subdivide_adaptive(max_edge_len={side:g}) splits them"
        _check.warn(
            f"the sky changes inside of triangles: 1 of 20 places between the points is off by "
            f"{bent:.2f} or more; {remedy}"
        )
