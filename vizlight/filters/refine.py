"""Split the cells of a mesh where light bends, so that interpolation between points is right."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Exponent, Facing, FeatureAngle, Model, Precision
from vizlight.filters import lighting
from vizlight.filters.illuminate import light_parts, parts_of
from vizlight.filters.sky import with_sky
from vizlight.mesh import blocks, records, refining
from vizlight.mesh.blocks import MeshT
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene
from vizlight.shading.options import Bundle, LightOptions
from vizlight.shading.results import plain
from vizlight.vtk.parts import share_of

#: Least error between points that light is refined to: rounding in float32 is about 1e-6.
FINEST = 1e-5


@dataclass(frozen=True, kw_only=True)
class RefineOptions(LightOptions):
    """Options of refinement and light.

    The fields are keywords of :func:`vizlight.refine`.
    """

    error: float = 1 / 255
    max_points: int | None = None

    def __post_init__(self) -> None:
        _check.fields(self, _check.number, "error", low=FINEST)
        super().__post_init__()
        _check.fields(self, _check.integer, "max_points", optional=True, low=1)


@named
def refine(
    mesh: MeshT,
    /,
    scene: AnyScene | None = None,
    *,
    error: float = 0.00392156862745098,
    max_points: int | None = None,
    tangents: str | ArrayLike | None = None,
    positions: str | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    feature_angle: FeatureAngle = None,
    conditioned: bool | str | None = False,
    line_field: bool = False,
    bundle: bool | Bundle = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    progress_bar: bool = False,
) -> MeshT:
    """Split triangles and polylines where light bends, and light the mesh.

    Between the points of a mesh a picture shows interpolated light, which misses highlights and
    blurs the terminator where cells are coarse. The light of the interpolated normals or tangents,
    as a fragment shader computes it, is the reference: edges are split where interpolated light
    differs from it by more than ``error``, and nowhere else. The error is not a bound for each
    place: see the notes.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh of faces or lines; not changed.
    scene : Scene or str, optional
        Lights, material and view for which the mesh is refined, by default ``Scene()``.
    error : float, default: 1/255
        Largest difference, in luminance and in each channel of a colour, between the interpolated
        and the exact light of a place, for all but a small share of the places; 1e-5 or more.
    max_points : int, optional
        Largest number of points of each mesh. Default: one million, or twice those that it has.
    tangents, positions, normals, facing, feature_angle, conditioned, line_field, bundle, occlusion
        As for :func:`vizlight.illuminate`.
    name, exponent, model, components, precision
        As for :func:`vizlight.illuminate`.
    progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.PolyData or pyvista.MultiBlock
        Triangles or polylines, lit as by :func:`vizlight.illuminate`, with the field array
        ``luminance_error``: the largest error at 4,096 random places between the points, and the
        share of those places that are off by more than ``error``. The points of the mesh come
        first and keep their index and their light. New points lie on its segments and triangles,
        without T-junctions. Point arrays are interpolated: unit vectors keep their length, tangents
        of a ``line_field`` are turned alike before, several tangents are interpolated as the space
        that they span. Integers, which may be labels, are taken from the nearest corner. Cell
        arrays are carried.

    Raises
    ------
    TypeError, ValueError
        As :func:`vizlight.illuminate`; if the mesh has neither faces nor lines. Of cells that fill
        space the outer surface is refined.

    Warns
    -----
    UserWarning
        With the error that is left, if ``max_points`` is not enough, or if the light jumps: where
        it does, edges are split down to 1/4096 of the diagonal of the mesh.

    Notes
    -----
    The error is measured at 3 places of each edge, 4 of each triangle, where each highlight would
    peak on an edge and in a triangle, which finds those that are smaller than a triangle, and at
    last at 4,096 random places, uniform in area or length. For several tangents per point no
    closed form gives the peaks.

    Where the share in ``luminance_error`` is 0, none of these random places is off by more than
    ``error``. Were a share p of all places, it would be missed with probability ``(1 - p)^4096``:
    with 95 % confidence fewer than 0.08 % are. On a sphere, a cylinder with creases, a terrain, a
    torus with tangents, the flow on an isosurface and a blob the largest error at 100,000 places is
    less than 5 times that allowed. It is more at these places: where light jumps, as where a
    surface with a rim turns to the eye, up to 0.4 at 0.2 % of an isosurface; where tangents vanish
    between opposite ones, up to 0.7 at 0.5 % of a triangle; in slivers narrower than 1/4096 of the
    diagonal, which are not split, 10 times that allowed. No warning is given where 0.5 % of the
    places or fewer are off.

    The error holds for the view and the lights of the scene alone.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> ball = pv.Sphere()
    >>> fine = vizlight.refine(ball, scene)
    >>> bool(fine.n_points > ball.n_points), bool(fine["luminance_error"][0] <= 1 / 255)
    (True, True)
    """
    options = RefineOptions.of(locals())
    scene = as_scene(scene)
    # Of cells that fill space the outer surface is lit.
    faces = [
        blocks.surface(block, "mesh") if block.GetMaxSpatialDimension() == 3 else block
        for block, _ in blocks.check(mesh)
    ]
    whole = blocks.like(mesh, iter(faces))
    # New points see the sky of the refined mesh.
    early = dataclasses.replace(options, occlusion=None)
    taken, parts = parts_of(whole, scene, early)
    # The cue spans the present points: new ones lie between them.
    fitted = lighting.fit_depth_cue(scene, [part.inputs.points for part in parts])
    # Each mesh is refined alone.
    results = [
        refining.refined(surface, path, part, fitted, options.error, options.max_points)
        for surface, part, (_, path) in zip(taken, parts, blocks.named_blocks(whole), strict=True)
    ]
    refining.warn_of_rest(results, options.error)
    fine = with_sky([result.mesh for result in results], options.occlusion)
    parts = [
        result.part._replace(
            inputs=dataclasses.replace(
                result.part.inputs, occlusion=share_of(surface, options.occlusion)
            )
        )
        for surface, result in zip(fine, results, strict=True)
    ]
    lit = light_parts(whole, fine, parts, scene, options, progress_bar=progress_bar)
    for block, result in zip(blocks.all_blocks(lit), results, strict=True):
        left = [result.left.error, result.left.share]
        block.field_data[f"{options.name}{refining.LEFT}"] = left
        records.amend(block, options.name, "refine", plain(options))
    return lit
