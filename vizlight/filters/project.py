"""Turn, cut and project the n-space arrays of a mesh, and light it before or after."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, get_args

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check, _progress
from vizlight._types import Exponent, Facing, Given, Model, Precision, VectorLike
from vizlight.filters.illuminate import light_mesh
from vizlight.geometry.nspace import projection
from vizlight.mesh import blocks, records
from vizlight.mesh.nspace import FRAME, POSITION, PROJECTED, Counter, Turning, continued
from vizlight.scene import Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, optional_scene
from vizlight.shading.options import LightOptions
from vizlight.shading.results import Record

LightWhen = Literal["before", "after"]
#: Options of the projection alone.
PROJECTION = ("rotation", "hyperplane", "distance", "frame", "turned", "cut", "light")
#: Options of the light alone, which need a scene.
LIGHT_ALONE = {field.name for field in dataclasses.fields(LightOptions)} - {"positions"}


@dataclass(frozen=True, kw_only=True)
class ProjectOptions(LightOptions):
    """Options of turning, cutting, projecting and lighting a mesh.

    The fields are keywords of :func:`vizlight.project`.
    """

    DECIDED: ClassVar = frozenset({"feature_angle", "bundle"})
    rotation: object = None
    hyperplane: tuple[VectorLike, float] | None = None
    distance: float | None = None
    positions: str | None = POSITION
    frame: str | None = FRAME
    turned: str | Sequence[str] | None = None
    cut: bool = False
    light: LightWhen = "before"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.choice("light", self.light, get_args(LightWhen))
        positions: object = self.positions
        if not isinstance(positions, str) or not positions:
            got, remedy = _check.describe(positions), "attach it to the mesh and name it"
            raise TypeError(_check.message("positions", "the name of a point array", got, remedy))
        turned: Given = () if self.turned is None else self.turned
        turned = (turned,) if isinstance(turned, str) else turned
        expected = "the name of a point array, or a list of names"
        _check.instance("turned", turned, list | tuple, expected)
        distance = self.distance
        _check.set_fields(
            self,
            turned=tuple(turned),
            distance=None if distance is None else projection.check_distance(distance),
        )

    def by(self, tangents: str | None, positions: str | None) -> LightOptions:
        """Return the options of the light by some tangents, unless others are named."""
        named = self.tangents if self.tangents is not None else tangents
        return LightOptions.of(vars(self) | {"tangents": named, "positions": positions})


@named
def project(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    *,
    scene: AnyScene | None = None,
    rotation: object = None,
    hyperplane: tuple[VectorLike, float] | None = None,
    distance: float | None = None,
    positions: str | None = "position",
    frame: str | None = "frame",
    turned: str | Sequence[str] | None = None,
    cut: bool = False,
    light: LightWhen = "before",
    tangents: str | ArrayLike | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    conditioned: bool | str | None = False,
    line_field: bool = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    progress_bar: bool = False,
) -> pv.DataSet | pv.MultiBlock:
    """Turn a mesh in n-space, cut it by a hyperplane, project it to 3-space; light it on the way.

    VTK's own transforms leave arrays of positions and frames alone; here they turn together.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that is turned; not changed. An image or a rectilinear grid becomes a structured grid.
    scene : Scene or str, optional
        Scene by which the mesh is lit.
    rotation : optional
        A matrix of SO(n), ``("xw", angle)`` with the angle in radians, or a list of these, the
        first done first; see :func:`vizlight.geometry.nspace.projection.rotation`.
    hyperplane : (normal, offset), optional
        Hyperplane ``{x : x . normal / |normal| = offset}`` that cuts the turned mesh to a (k -
        1)-manifold. Point arrays of numbers are interpolated, the frame as the space that it spans,
        whatever its basis at each point, and cut down to the directions within.
    distance : float, optional
        Distance of the eye on the last axis from the origin, in the unit of the mesh: a
        perspective projection on the hyperplane across it. Default: orthographic, the first three
        coordinates.
    positions : str, default: "position"
        Name of the point array of n components with the places of the points in n-space.
    frame : str or None, default: "frame"
        Name of the point array of k n components, the tangents, row after row. Without the
        array ``frame`` it is that of the space which the cells around a point span. None: no
        frame.
    turned : str or sequence of str, optional
        Names of further point arrays of m n components, vectors in n-space that turn with the
        mesh.
    cut : bool, default: False
        Whether points that cannot be cut or projected, those on or behind the eye's hyperplane
        or not finite, are dropped with the cells that have one, and a warning gives the count;
        else they are an error.
    light : {"before", "after"}
        Light in n-space, with lights and eye of n components, before the projection; or in
        3-space, by the projected points and frame, after it.
    tangents, normals, facing, conditioned, line_field, occlusion, name, exponent, model, components
        As for :func:`vizlight.illuminate`.
    precision
        As for :func:`vizlight.illuminate`.
    progress_bar : bool, default: False
        Whether progress is shown on standard error.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        A mesh with points in 3-space, ``position`` and ``frame`` turned, and for k < 3 the point
        array ``projected_frame``: the derivative of the projection applied to the frame,
        orthonormalised; for each array V of ``turned`` its image ``projected_V``, with the length
        of the image. The steps are kept as field data, ``provenance(mesh, "projection")``; from
        ``luminance_provenance`` the light can be made again from the original mesh. The result
        shares no memory with ``mesh``: unchanged arrays are copies.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an array is missing or has the wrong number of components, the rotation is invalid,
        points cannot be projected, or the result cannot be lit: points without tangents, or a
        3-manifold that fills 3-space.

    Warns
    -----
    UserWarning
        Once, with the count, if points are dropped.

    Notes
    -----
    Where the projection flattens the tangent space (at a silhouette) ``projected_frame`` has rows
    of zero past its rank, the number of unit tangents that survive beyond rounding (see
    :func:`vizlight.geometry.nspace.projection.push_frame`). At such points, light after the
    projection is computed for the limit of the tangent spaces along the surface, from points
    around, with an error of second order in their distance. Points without a limit (a pinch point,
    or one among points that have lost their rank too) have ambient light alone, and
    ``luminance_valid`` marks the points; light before the projection knows of no silhouette. A
    frame on a cut is a mean of those at the points around, of second order in their distance, and
    zero where one of them lacks tangents. Error bounds:
    :func:`vizlight.geometry.nspace.projection.turn` and ``perspective``. Work is done in float64,
    block by block; arrays keep their type. Source: Banks, section 3.
    """
    options = ProjectOptions.of(locals())
    blocks.check(mesh)
    scene = optional_scene(scene)
    if scene is None:
        # Without a scene nothing is lit, and an option of the light would be ignored in silence.
        for option in options.changed():
            if option in LIGHT_ALONE:
                expected = "an option of project, or scene= beside an option of illuminate"
                raise TypeError(_check.message(option, expected, "neither"))
    names = [field.name for field in dataclasses.fields(Turning)]
    job = Turning(**{name: getattr(options, name) for name in names})

    def lit(shown: pv.DataSet | pv.MultiBlock, when: LightWhen) -> pv.DataSet | pv.MultiBlock:
        if scene is None or options.light != when:
            return shown
        prefix, positions = ("", job.positions) if when == "before" else (PROJECTED, None)
        _check_tangents(shown, job, options, prefix)
        _check_space(shown, scene, when, job.positions)
        frame = None if options.frame is None else f"{prefix}{options.frame}"
        if when == "before" or frame is None or options.tangents is not None:
            return light_mesh(shown, scene, options.by(frame, positions))
        # Folds are lit by the limit of the tangents, which the result does not keep.
        named = list(blocks.all_blocks(shown))
        projected_frames = [np.asarray(block.point_data[frame]) for block in named]
        for block in named:
            limit = continued(block, frame)
            if limit is not None:
                records.attach_rows(block, frame, limit)
        lit_mesh = light_mesh(shown, scene, options.by(frame, positions))
        # The frame of the result is the projected one, which loses rank at the folds.
        for block, rows in zip(blocks.all_blocks(lit_mesh), projected_frames, strict=True):
            records.attach_rows(block, frame, rows)
        return lit_mesh

    # Each point counts twice: when it is turned and when it is projected.
    total = 2 * sum(block.n_points for block in blocks.all_blocks(mesh))
    with _progress.progress("project", total, show=progress_bar) as report:
        done = Counter(report)
        lost = Counter(lambda _: None)
        # Between these two steps the mesh has its turned positions of n components.
        out = lit(_each(mesh, lambda block: job.rotated(block, done, lost)), "before")
        out = lit(_each(out, lambda block: job.projected(block, done, lost)), "after")
        if scene is not None:
            for block in blocks.all_blocks(out):
                recorded = records.provenance(block, options.name)["options"].items()
                kept = {key: value for key, value in recorded if key not in options.DECIDED}
                records.amend(block, options.name, "project", kept, _own(options))
    if lost.count:
        _check.warn(
            f"{lost.count} points cannot be projected (on or behind the eye's hyperplane, or not "
            "finite) and are dropped, with the cells that have one"
        )
    return out


def _own(options: ProjectOptions) -> Record:
    """Return the options of the projection alone."""
    return {name: getattr(options, name) for name in (*PROJECTION, "positions")}


def _each(
    mesh: pv.DataSet | pv.MultiBlock, work: Callable[[pv.DataSet], pv.DataSet]
) -> pv.DataSet | pv.MultiBlock:
    """Apply a function to a mesh, or to each block; an error names the block."""

    def of_block(block: pv.DataSet, path: str) -> pv.DataSet:
        with _check.in_block(path):
            return work(block)

    return blocks.like(mesh, itertools.starmap(of_block, blocks.named_blocks(mesh)))


def _check_space(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene, light: LightWhen, positions: str
) -> None:
    """Check that lights and eye live in the lit space, the space of positions or 3-space."""
    for block in blocks.all_blocks(mesh):
        n = block.point_data[positions].shape[1]
        lit, other, when = (n, 3, "after") if light == "before" else (3, n, "before")
        if scene.n not in (None, lit):
            remedy = f"pass light={when!r} to light in {other}-space" if scene.n == other else ""
            expected = f"vectors of {lit} components for light={light!r}"
            raise _check.value_error("scene", expected, scene.n, remedy)


def _check_tangents(
    mesh: pv.DataSet | pv.MultiBlock, job: Turning, options: ProjectOptions, prefix: str
) -> None:
    """Check that the mesh has tangents to light by; the error says why it has none."""
    if options.tangents is not None:
        return
    if job.frame is None:
        raise _check.value_error("frame", "tangents to light by", None, "or pass tangents=")
    for block in blocks.all_blocks(mesh):
        if job.frame not in block.point_data:
            got = "the points of a cut curve, which have no tangents"
            raise _check.value_error("scene", "a mesh that can be lit", got)
        if prefix + job.frame not in block.point_data:
            k = block.point_data[job.frame].shape[1] // block.point_data[job.positions].shape[1]
            got = f"a {k}-manifold, which fills 3-space and has no normals there"
            remedy = "pass light='before', or cut it by hyperplane="
            raise _check.value_error("light", "a curve or a surface", got, remedy)
