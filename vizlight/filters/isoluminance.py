"""Bands and contours of equal luminance on a mesh or a solid."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check, _progress
from vizlight._types import Array, Bools, Exponent, FeatureAngle, Indices, Keywords
from vizlight.filters import lighting
from vizlight.geometry.contours import banding, refinement, spacing
from vizlight.geometry.contours import isoluminance as closed
from vizlight.geometry.contours.banding import Bands
from vizlight.geometry.contours.spacing import Levels
from vizlight.geometry.solids import exact_surfaces, tessellation, triangle_mesh
from vizlight.geometry.solids.primitives import Frustum, Solid, Sphere
from vizlight.geometry.solids.triangle_mesh import Mesh
from vizlight.mesh import blocks, georeference, normals, records, subdivision
from vizlight.model import kernels
from vizlight.model.reflection import SpecularModel
from vizlight.scene import Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene
from vizlight.shading import engine
from vizlight.shading.display import exposed
from vizlight.shading.engine import Shading
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import LightOptions, Options, check_sides
from vizlight.shading.results import Record, of_light, part_name, unlit
from vizlight.vtk.arrays import array_of


@dataclass(frozen=True, kw_only=True)
class ContourOptions(Options):
    """Options of contours and of the light of the surface.

    The fields are keywords of :func:`vizlight.isoluminance`.
    """

    levels: Levels = 16
    tolerance: float = 3e-3
    model: SpecularModel = "phong"
    feature_angle: FeatureAngle = None
    normals: str | ArrayLike | None = None
    tangents: str | ArrayLike | None = None
    conditioned: bool = False
    exponent: Exponent = "compensated"
    name: str = "luminance"

    def __post_init__(self) -> None:
        spacing.check(self.levels)
        check_sides("auto", self.feature_angle)
        _check.number("tolerance", self.tolerance, low=1e-6, high=0.1)
        _check.array_name("name", self.name)
        _check.flags(self)

    @property
    def light(self) -> LightOptions:
        """The options of the light."""
        # Contour points are found by bracketing, for which float32 has too few digits.
        return LightOptions.of(vars(self) | {"precision": "float64"})


@named
def isoluminance(
    mesh: pv.DataSet | pv.MultiBlock | Solid,
    /,
    scene: AnyScene | None = None,
    *,
    levels: Levels = 16,
    tolerance: float = 0.003,
    model: SpecularModel = "phong",
    feature_angle: FeatureAngle = None,
    normals: str | ArrayLike | None = None,
    tangents: str | ArrayLike | None = None,
    conditioned: bool = False,
    exponent: Exponent = "compensated",
    name: str = "luminance",
    progress_bar: bool = False,
) -> pv.MultiBlock:
    """Return contours of equal luminance, and the bands between them with one value per band.

    Parameters
    ----------
    mesh : pyvista.DataSet, pyvista.MultiBlock or a solid
        Surface to light, which is not modified. Of a mesh that is not a surface the outer surface
        is lit; blocks are joined. A solid is a :class:`vizlight.Sphere`,
        :class:`~vizlight.Frustum` or :class:`~vizlight.Block`, or a combination of them by ``|``,
        ``&`` and ``-``.
    scene : Scene or str, optional
        Scene with one light or several, by default ``Scene()``. A highlight needs a view.
    levels : int, float or sequence of float, default: 16
        Number of equal steps (int), allowed luminance error (float), or luminance of the contours
        (sequence).
    tolerance : float, default: 3e-3
        Largest distance of triangles from the curves and surfaces of a combined solid, as a share
        of its size.
    model : {"phong", "blinn"}
        Reflection model of the highlight: ``R . E`` or ``N . H``. Both are drawn exactly.
    feature_angle : float or "auto", optional
        Angle in degrees above which edges are sharp, as for :func:`vizlight.illuminate`; for a
        mesh only. Default: none is.
    normals, tangents, conditioned, exponent
        Arrays and options as for :func:`vizlight.illuminate`, for a mesh only.
    name : str, default: "luminance"
        Name of the resulting cell arrays.
    progress_bar : bool, default: False
        Whether the share of triangles that keep the allowed error is shown on standard error.

    Returns
    -------
    pyvista.MultiBlock
        Block ``bands`` holds polygons with the cell arrays ``luminance`` and ``band``, for a solid
        also ``patch``; it is closed if the surface is. Floating-point point data of a mesh are
        interpolated over its triangles and kept. Block ``contours`` holds lines with the
        cell array ``luminance``. If the scene has a colour, the bands have ``rgb``: the colour at
        the centre of each polygon with the brightness of its band; with tangents the colour is
        interpolated like the luminance. Field data of the bands are ``luminance_error``, which is
        the bound of a closed form or else the error measured at the centre and along the edges of
        each polygon, and ``luminance_provenance``.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, or as for :func:`vizlight.illuminate`.

    Warns
    -----
    UserWarning
        If points of faces could not be lit; triangles at such points get the band of the ambient
        light.
        If an allowed error is not kept, for instance where a highlight ends at the terminator.

    Notes
    -----
    A solid is lit at its exact points and normals. A mesh is lit with its normals, interpolated
    over each triangle and normalised. Contour points are found by bracketing, so that the
    terminator is not restricted to corners, and triangles are split where the luminance is not
    linear. With tangents the luminance itself is interpolated. An empty mesh has no bands. A
    sphere or a frustum under one light without a highlight has closed forms. The memory that is
    taken, with the result, is at most three times that of mesh and result, and some 20 MB.
    Source: Isoluminance.
    """
    options = ContourOptions.of(locals())
    with _progress.progress("contours", 100, show=progress_bar) as show:
        result = _make(mesh, scene, options, lambda share: show(int(100 * share)))
        show(100)
    return result


def _make(
    mesh: pv.DataSet | pv.MultiBlock | Solid,
    scene: AnyScene | None,
    options: ContourOptions,
    progress: Callable[[float], None],
) -> pv.MultiBlock:
    """Return bands and contours."""
    scene = as_scene(scene)
    light = _Light(scene, options, progress)
    if isinstance(mesh, Solid):
        for option in ("normals", "tangents"):
            if getattr(options, option) is not None:
                raise _check.value_error(
                    option, "None for a solid, which has its own", "an array", "leave it out"
                )
        bands = _of_solid(mesh, light)
        rgb = _rgb(bands, light) if scene.colored else None
        return _blocks(bands, options.name, light.record(), rgb, patches=True)
    data: object = mesh
    if not isinstance(data, pv.DataSet | pv.MultiBlock):
        remedy = "combine solids from vizlight.Sphere, Frustum and Block"
        raise TypeError(
            _check.message("mesh", "a PyVista mesh or a solid", type(mesh).__name__, remedy)
        )
    blocks.check(data)
    if not any(block.n_points for block in blocks.all_blocks(mesh)):
        return _of_mesh(pv.PolyData(), light)
    # Blocks are joined, so that all have the same contours.
    whole = blocks.joined(mesh) if isinstance(mesh, pv.MultiBlock) else mesh
    result = _of_mesh(whole, light)
    for block in blocks.all_blocks(result):
        georeference.place_alike(block, whole)
    return result


class _Light:
    """The luminance of points with normals, and its record."""

    def __init__(
        self, scene: Scene, options: ContourOptions, progress: Callable[[float], None]
    ) -> None:
        self.scene, self.options = scene, options
        #: Function that is called with the share of the refinement that is done.
        self.progress = progress
        self.last: Shading | None = None
        #: Mesh on the exact surfaces of a solid.
        self.shape: Mesh | None = None

    def __call__(self, points: Array, normals: Array) -> Array:
        return np.asarray(self.lit(points, normals).luminance)

    def lit(self, points: Array, normals: Array) -> Shading:
        """Return the light of points with normals."""
        options = self.options
        self.last = engine.shade(
            points, None, self.scene, normals=normals, model=options.model, precision="float64"
        )
        return self.last

    def record(self) -> Record:
        """Return the provenance of the bands."""
        # Where nothing was lit, one place makes the plan that the record names.
        last = self.last or self.lit(np.zeros((1, 3)), np.array([[0.0, 0, 1]]))
        return of_light(last, "isoluminance", self.scene, self.options)


def _of_solid(solid: Solid, light: _Light) -> Bands:
    """Return the bands of a solid, in closed form if possible."""
    scene, options = light.scene, light.options
    low = scene.material.ambient * scene.ambient_intensity
    # With ambient and diffuse light alone there are closed forms, and the ambient term is the
    # least.
    dull = (scene.material.specular == 0 or scene.view is None) and scene.depth_cue is None
    plain = dull and len(scene.lights) == 1
    if plain and isinstance(solid, Sphere | Frustum):
        # A light that follows the view has a fixed direction or position only in that view.
        (lamp,) = (light.seen_from(scene.view) for light in scene.lights)
        source: Keywords = {
            "direction": lamp.direction, "position": lamp.position, "ambient": low,
            "diffuse": scene.material.diffuse * lamp.intensity,
            "attenuation": lamp.attenuation, "levels": options.levels,
        }  # fmt: skip
        if isinstance(solid, Sphere):
            return closed.sphere(solid.center, solid.radius, **source)
        # A frustum has a closed form for parallel light alone.
        if lamp.direction is not None:
            return closed.truncus(
                solid.center, solid.axis, solid.radii, height=solid.height, **source
            )
    # Without a closed form the bands are refined on triangles of the exact surfaces.
    light.shape = tessellation.tessellate(solid, tolerance=options.tolerance)
    return refinement.draw(
        light.shape, light, options.levels, low=low if dull else None, progress=light.progress
    )


def _of_mesh(mesh: pv.DataSet, light: _Light) -> pv.MultiBlock:
    """Return bands and contours of a mesh."""
    scene, options, levels = light.scene, light.options, light.options.levels
    light_options = options.light
    angle = options.feature_angle
    if angle is not None and normals.are_computed(mesh, light_options) and mesh.n_points:
        # Points are split below, and only arrays that the mesh carries go with them.
        expected, remedy = "a name beside feature_angle=", "attach the array"
        _check.instance("tangents", options.tangents, str | None, expected, remedy=remedy)
        whole = mesh if isinstance(mesh, pv.PolyData) else blocks.outer_surface(mesh)[0]
        mesh = normals.split_edges(whole, angle)
    surface, triangles, used, ids = _surface(mesh)
    # The surface of another mesh numbers its points anew: arrays without a name are taken there
    # too.
    if ids is not None:
        light_options = dataclasses.replace(
            light_options,
            normals=_on_surface(mesh, "normals", light_options.normals, ids),
            tangents=_on_surface(mesh, "tangents", light_options.tangents, ids),
        )
    inputs = lighting.part_of(surface, "", scene, light_options).inputs
    # This light says which points can be lit; with tangents it is itself cut into bands.
    (lit,), fitted = lighting.light([(inputs, light_options)], scene, progress_bar=False)
    invalid = int(np.count_nonzero(~lit.valid[used]))
    if invalid:
        _check.warn(unlit(invalid, len(used)))
    # Where triangles are cut, values are interpolated: labels, which are integers, cannot be.
    carried = {
        str(name): value.reshape(len(value), -1)
        for name, value in surface.point_data.items()
        if np.issubdtype(value.dtype, np.floating) and len(value)
    }
    rgb: Array | None = None
    if not len(triangles):
        carried = {}
        bands = banding.none(spacing.steps(levels, 0.0, 0.0))
    elif options.tangents is None:
        unit, shown = _normals(surface, light_options, inputs, scene, warn=angle is None)
        del inputs
        valid = lit.valid
        # Points whose normal was turned to the eye.
        averted: Bools = np.einsum("ij,ij->i", unit, shown) < 0
        # Columns 3 to 5 are the normals, by which new points are lit; all columns are interpolated
        # along edges.
        columns = [surface.points, unit, *carried.values()]
        if averted.any():
            # Of an open piece each triangle shows one side, also where the normals between its
            # corners would turn over.
            other = np.count_nonzero(averted[triangles], axis=1) > 1
            # Each point is there twice, with both normals, and a triangle takes all its corners
            # from one half.
            columns = [np.concatenate([column, column]) for column in columns]
            columns[1][len(unit) :] *= -1
            valid = np.tile(valid, 2)
            triangles = triangles + len(unit) * other[:, np.newaxis]
        rows = np.concatenate(columns, axis=1, dtype=np.float64)
        # The contents of ``rows`` are not kept twice, since the notes bound the memory.
        del unit, shown, averted, columns
        lit_facets = refinement.LitTriangles(rows, triangles, light, valid)
        del rows, triangles
        bands = refinement.refine(lit_facets, levels, progress=light.progress)
    else:
        # With tangents the luminance itself is linear in a triangle, and no new points are lit.
        values = np.asarray(lit.luminance, dtype=np.float64)
        low, high = values[triangles].min(), values[triangles].max()
        # Contours of a linear luminance are straight: no part of the error is reserved for chords.
        steps = spacing.steps(levels, float(low), float(high), exact=True)
        # Colours are interpolated like the luminance.
        light_columns = [lit.luminance[:, np.newaxis], *([] if lit.rgb is None else [lit.rgb])]
        columns = [surface.points, *light_columns, *carried.values()]
        rows = np.concatenate(columns, axis=1, dtype=np.float64)
        cut, _ = banding.cut(rows, triangles, values, steps)
        bands = dataclasses.replace(cut, error=steps.error)
        if lit.rgb is not None:
            # Column 3 is the luminance and 4 to 6 are the colour, behind the place.
            middles = cut.middles()
            rgb = _as_bright(middles[:, 4:7], middles[:, 3], bands, scene.exposure)
    record = of_light(lit, "isoluminance", fitted, options)
    if scene.colored and options.tangents is None:
        rgb = _rgb(bands, light)
    out = _blocks(bands, options.name, record, rgb, patches=False)
    bands_block = out["bands"]
    assert isinstance(bands_block, pv.PolyData)
    # The carried values are the last columns of the points.
    last = bands.points.shape[1]
    for name, column in reversed(carried.items()):
        last -= column.shape[1]
        interpolated = bands.points[:, last : last + column.shape[1]]
        kind = surface.point_data[name].dtype
        shape = (len(interpolated), *surface.point_data[name].shape[1:])
        bands_block.point_data[name] = np.ascontiguousarray(interpolated.reshape(shape), dtype=kind)
    # PyVista would draw an active array of the points in place of the bands.
    bands_block.point_data.active_scalars_name = None
    return out


def _normals(
    surface: pv.PolyData, options: LightOptions, inputs: ShadingInputs, scene: Scene, *, warn: bool
) -> tuple[Array, Array]:
    """Return unit normals of a surface, and normals on the sides that are lit."""
    vectors = normals.normals_of(surface, options.normals, 3, normals.onlooker(scene), warn=warn)
    assert inputs.normals is not None
    # The inputs have the normals on the side that the eye sees.
    shown = np.asarray(inputs.normals[0 : len(vectors)], dtype=np.float64)
    return kernels.unit_rows(np.asarray(vectors, dtype=np.float64)), shown


def _on_surface(
    mesh: pv.DataSet, name: str, value: str | ArrayLike | None, ids: Indices
) -> str | ArrayLike | None:
    """Return values of a mesh on its outer surface; the name of an array stays."""
    if value is None or isinstance(value, str):
        return value
    rows = array_of(mesh, name, value)
    return rows[ids]


def _surface(mesh: pv.DataSet) -> tuple[pv.PolyData, Indices, Indices, Indices | None]:
    """Return the surface of a mesh, its triangles with finite corners, and its points.

    The points are given by the indices of those that faces use, and by the index in the mesh of
    each point of the surface.
    """
    surface, ids = (mesh, None) if isinstance(mesh, pv.PolyData) else blocks.outer_surface(mesh)
    if surface.n_points and not (surface.GetNumberOfPolys() or surface.GetNumberOfStrips()):
        remedy = "pass a contour or the mesh's extract_surface()"
        raise _check.value_error(
            "mesh", "a surface with faces", f"a {type(mesh).__name__} without", remedy
        )
    triangles, _ = subdivision.triangles(surface)
    used = np.zeros(surface.n_points, np.bool_)
    used[triangles] = True
    # A triangle with a corner that is nowhere has neither place nor contours.
    finite: Bools = np.isfinite(np.asarray(surface.points)).all(axis=1)
    if not finite.all():
        triangles = triangles[finite[triangles].all(axis=1)]
    return surface, triangles, np.flatnonzero(used), ids


def _middles(bands: Bands, light: _Light) -> tuple[Array, Array]:
    """Return the centres of polygons, on the exact surface if known, and their unit normals."""
    middle, shape = bands.middles(), light.shape
    # The middle of a flat polygon is not on a curved surface: place and normal are taken from that.
    if shape is not None:
        patches = np.stack([bands.patch, bands.patch], axis=1)
        places = exact_surfaces.onto(shape.surfaces, (middle - shape.shift) / shape.scale, patches)
        return shape.world(places), triangle_mesh.normals_of(shape, places, bands.patch)
    # Bands of a mesh carry its interpolated normals; others have the normals of their polygons.
    normals = kernels.unit_rows(middle[:, 3:6]) if middle.shape[1] >= 6 else bands.normals()
    return middle[:, :3], normals


def _rgb(bands: Bands, light: _Light) -> Array | None:
    """Return the colour at the centre of each polygon, with the brightness of its band."""
    if not len(bands.values):
        return None
    lit = light.lit(*_middles(bands, light))
    if lit.rgb is None:
        return None
    return _as_bright(lit.rgb, np.asarray(lit.luminance), bands, light.scene.exposure)


def _as_bright(rgb: Array, value: Array, bands: Bands, exposure: float | None) -> Array:
    """Return colours scaled from their luminance to the luminance of each polygon's band."""
    # Hue and saturation of the light stay, and it becomes as bright as the band.
    value, shown = exposed(value, exposure), exposed(bands.values, exposure)
    share = np.divide(shown, value, out=np.ones_like(value), where=value > 0)
    return np.asarray(rgb * share[:, np.newaxis])


def _blocks(
    bands: Bands, name: str, record: Record, rgb: Array | None, *, patches: bool
) -> pv.MultiBlock:
    """Return bands and contours as meshes."""
    points = np.ascontiguousarray(bands.points[:, :3])
    surface = pv.PolyData()
    if len(bands.values):
        surface.points = points
        surface.SetPolys(blocks.cell_array(bands.corners, bands.offsets))
    surface.cell_data[part_name(name, "band")] = bands.band
    if patches:
        surface.cell_data[part_name(name, "patch")] = bands.patch
    if rgb is not None and len(rgb):
        surface.cell_data[part_name(name, "rgb")] = rgb
    surface.cell_data[name] = bands.values
    surface.cell_data.active_scalars_name = name
    surface.field_data[f"{name}_error"] = [bands.error]
    records.write(surface, name, record)
    lines = pv.PolyData()
    if len(bands.lines):
        # The lines have only the points of the bands that a contour runs through.
        used, ends = np.unique(bands.lines, return_inverse=True)
        ends = ends.reshape(-1, 2)
        lines = pv.PolyData(
            points[used], lines=np.column_stack([np.full(len(ends), 2), ends]).ravel()
        )
    lines.cell_data[name] = bands.line_levels
    return pv.MultiBlock({"bands": surface, "contours": lines})
