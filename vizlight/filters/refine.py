"""Split the cells of a mesh where light bends, so that interpolation between points is right."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vizlight import _check
from vizlight.filters.illuminate import light_mesh
from vizlight.mesh import blocks, records
from vizlight.shading.options import FINEST, LightOptions, named
from vizlight.shading.results import plain

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight.mesh.blocks import MeshT
    from vizlight.scene import Scene
    from vizlight.shading.options import Bundle, Exponent, Facing, FeatureAngle, Model, Precision


@dataclass(frozen=True, kw_only=True)
class RefineOptions(LightOptions):
    """How far a mesh is refined, and how it is lit.

    The fields are keywords of :func:`vizlight.refine`.
    """

    error: float = 1 / 255
    max_points: int | None = None

    def __post_init__(self) -> None:
        error = _check.number("error", self.error, low=FINEST)
        _check.set_fields(self, error=error)
        super().__post_init__()
        if self.max_points is not None:
            most = _check.integer("max_points", self.max_points, low=1)
            _check.set_fields(self, max_points=most)


@named
def refine(
    mesh: MeshT,
    /,
    scene: Scene | None = None,
    *,
    error: float = 0.00392156862745098,
    max_points: int | None = None,
    tangents: str | ArrayLike | None = None,
    positions: str | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    feature_angle: FeatureAngle = None,
    conditioned: bool | str | None = False,
    bundle: bool | Bundle = False,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    threads: int | None = None,
    progress_bar: bool = False,
) -> MeshT:
    """Split triangles and polylines where light bends, and light the mesh.

    Between the points of a mesh a picture shows interpolated light, which misses highlights and
    blurs the terminator where cells are coarse. The light of the interpolated normals or tangents,
    as a fragment shader computes it, is the reference: edges are split where interpolated light
    differs from it by more than ``error``, and nowhere else.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh of faces or lines; not changed.
    scene : Scene, optional
        Lights, material and view for which the mesh is refined, by default ``Scene()``.
    error : float, default: 1/255
        Largest difference, in luminance and in each channel of a colour, of the light that is
        interpolated between the points from the light there; 1e-5 or more.
    max_points : int, optional
        Largest number of points of each mesh. Default: one million, or twice those that it has.
    tangents, positions, normals, facing, feature_angle, conditioned, bundle, name, exponent
        As for :func:`vizlight.illuminate`.
    model, components, precision
        As for :func:`vizlight.illuminate`.
    threads, progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.PolyData or pyvista.MultiBlock
        Triangles or polylines, lit as by :func:`vizlight.illuminate`, with the field array
        ``luminance_error``: the largest error at 4,096 random places between the points, and the
        share of those places that are off by more than ``error``. The points of the mesh come
        first and keep their index and their light. New points lie on its segments and triangles,
        without T-junctions. Point arrays are interpolated: unit vectors keep their length, tangents
        are interpolated as a line field, whose signs have no meaning, several tangents as the space
        that they span. Integers, which may be labels, are taken from the nearest corner. Cell
        arrays are carried.

    Raises
    ------
    TypeError, ValueError
        As :func:`vizlight.illuminate`; if the mesh has cells that fill space, or neither faces nor
        lines.

    Warns
    -----
    UserWarning
        With the error that is left, if ``max_points`` is not enough, or if the light jumps: where
        it does, edges are split down to 1/4096 of the diagonal of the mesh.

    Notes
    -----
    The error is measured at 3 places of each edge, 4 of each triangle, where each highlight would
    peak on an edge and in a triangle, which finds those that are smaller than a triangle, and at
    last at 4,096 random places. For several tangents per point no closed form gives the peaks. The
    error holds for the view and the lights of the scene alone. Cost:
    about 20 us for each triangle of the mesh and 30 us for each new point.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> ball = pv.Sphere()
    >>> fine = vizlight.refine(ball, scene)
    >>> bool(fine.n_points > ball.n_points), bool(fine["luminance_error"][0] <= 1 / 255)
    (True, True)
    """
    asked = RefineOptions.of(locals())
    light = dataclasses.replace(asked, refine=asked.error)
    lit = light_mesh(
        mesh,
        scene,
        light,
        threads=threads,
        progress_bar=progress_bar,
        max_points=asked.max_points,
    )
    recorded = {key: value for key, value in plain(asked).items() if key != "refine"}
    for block in blocks.all_blocks(lit):
        records.amend(block, asked.name, "refine", recorded)
    return lit
