"""Bands and contours of equal luminance on a mesh, or on a solid made of primitives."""

from __future__ import annotations

import dataclasses
import functools
import json
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters import lighting
from vizlight.geometry.contours import banding, facets, refinement, spacing
from vizlight.geometry.contours import isoluminance as closed
from vizlight.geometry.solids import tessellation
from vizlight.geometry.solids.primitives import Solid, Sphere, Truncus
from vizlight.mesh import hull, normals, point_arrays, records
from vizlight.mesh.inputs import inputs_of
from vizlight.mesh.point_arrays import unit_rows
from vizlight.scene import Scene
from vizlight.shading import engine
from vizlight.shading.options import LightOptions
from vizlight.verify import report

if TYPE_CHECKING:
    from vizlight._types import Array, Indices
    from vizlight.geometry.contours.banding import Bands
    from vizlight.geometry.contours.spacing import Levels
    from vizlight.model.reflection import SpecularModel


def isoluminance(
    mesh: Any,
    /,
    scene: Scene,
    *,
    levels: Levels = 16,
    tolerance: float = 3e-3,
    model: SpecularModel = "phong",
    two_sided: bool = False,
    flip_normals: bool = False,
    normals: Any = None,
    tangents: Any = None,
    conditioned: bool = False,
    compensate: bool = True,
    threads: int | None = None,
    name: str = "luminance",
) -> Any:
    """Draw the contours of equal luminance, and the bands between them with one value each.

    Parameters
    ----------
    mesh : pyvista.DataSet, pyvista.MultiBlock or a solid
        A lit surface (of another mesh its outer surface; blocks are joined), not changed. Or a
        :class:`vizlight.Sphere`, :class:`~vizlight.Truncus`, :class:`~vizlight.Block`, or what
        ``|``, ``&`` and ``-`` made of them.
    scene : Scene
        One light or several; a highlight needs a view.
    levels : int, float or sequence of float, default: 16
        A count of equal steps, an allowed luminance error, or the luminance of the contours.
    tolerance : float, default: 3e-3
        Of a combined solid: how far triangles may be from its curves and surfaces, as a share of
        its size.
    model : {"phong", "blinn"}
        The law of the highlight: ``R . E`` or ``N . H``. Both are drawn exactly.
    two_sided, flip_normals : bool, default: False
        As for :func:`vizlight.illuminate`.
    normals, tangents, conditioned, compensate
        As for :func:`vizlight.illuminate`; of a mesh only.
    threads : int, optional
    name : str, default: "luminance"
        Of the resulting cell arrays.

    Returns
    -------
    pyvista.MultiBlock
        ``bands``: polygons with the cell arrays ``luminance`` and ``band``, closed if the
        surface is, and for a solid ``patch``. ``contours``: lines with the cell array
        ``luminance``. ``rgb`` on the bands where the scene has a colour: that of each polygon's
        middle, as bright as its band; with tangents interpolated as the luminance is. Field data
        of the bands: ``luminance_error``, the bound of a closed form, else what was measured at
        the middle and along the edges of each polygon; ``luminance_provenance``.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or as :func:`vizlight.illuminate`.

    Warns
    -----
    UserWarning
        If points of faces could not be lit; triangles at such points have the band of the ambient
        light.
        If an allowed error is not kept, as where a highlight ends at the terminator.

    Notes
    -----
    A solid is lit at its exact points and normals. A mesh is lit with its normals, interpolated
    over each triangle and made unit: contour points are found by halving edges, so the
    terminator does not jump from corner to corner, and triangles over which the luminance bends
    are split. An empty mesh has no bands. With tangents the luminance itself is
    interpolated. A sphere, or a truncus, under one light without a highlight has closed forms.
    Source: Isoluminance.
    """
    options = {
        key: value for key, value in locals().items() if key not in ("mesh", "scene", "threads")
    }
    start = time.perf_counter()
    with report.paused():
        made, bands, light = _make(mesh, scene, options, threads)
    seconds = time.perf_counter() - start
    _note(bands, light, seconds, 1024 * made.actual_memory_size, sampled=tangents is None)
    return made


def _make(
    mesh: Any, scene: Scene, options: dict[str, Any], threads: int | None
) -> tuple[pv.MultiBlock, Bands, _Light]:
    """Return bands and contours as meshes, the bands as arrays, and what lit them."""
    levels, tolerance, name = options["levels"], options["tolerance"], options["name"]
    model = options["model"]
    two_sided, flip_normals = options["two_sided"], options["flip_normals"]
    _check.instance("scene", scene, Scene)
    spacing.check(levels)
    _check.number("tolerance", tolerance, low=1e-6, high=0.1)
    if not isinstance(name, str) or not name:
        raise ValueError(_check.message("name", "a name for the cell array", repr(name)))
    if isinstance(mesh, Solid):
        for option in ("normals", "tangents"):
            if options[option] is not None:
                raise ValueError(
                    _check.message(option, "None for a solid, which has its own", "an array")
                )
        light = _Light(scene, model, two_sided, flip_normals, threads)
        found = _of_solid(mesh, light, levels, tolerance)
        told = light.record(options)
        rgb = _rgb(found, light) if scene.colored else None
        return _blocks(found, name, told, rgb, patches=True), found, light
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        remedy = "make solids of vizlight.Sphere, Truncus and Block"
        raise TypeError(
            _check.message("mesh", "a PyVista mesh or a solid", type(mesh).__name__, remedy)
        )
    joined = mesh.combine() if isinstance(mesh, pv.MultiBlock) else mesh
    if not joined.n_points:
        joined = pv.PolyData()
    return _of_mesh(joined, scene, levels, threads, options)


class _Light:
    """The luminance of points with normals, and what is told of it."""

    def __init__(
        self, scene: Scene, model: SpecularModel, two_sided: bool, flip: bool, threads: int | None
    ) -> None:
        self.scene, self.flip, self.two_sided, self.model = scene, flip, two_sided, model
        self.shade = functools.partial(
            engine.shade, precision="float64", threads=threads, model=model, two_sided=two_sided
        )
        self.last: Any = None
        #: Triangles on the exact surfaces of a solid that is lit.
        self.shape: Any = None

    def __call__(self, points: Array, normals: Array) -> Array:
        self.last = self.shade(points, None, self.scene, normals=-normals if self.flip else normals)
        return np.asarray(self.last.luminance)

    def record(self, options: dict[str, Any]) -> dict[str, Any]:
        """Return what made the bands."""
        if self.last is None:
            self(np.zeros((1, 3)), np.array([[0.0, 0, 1]]))
        return records.of_light(self.last, "isoluminance", self.scene, options)


def _of_solid(solid: Solid, light: _Light, levels: Levels, tolerance: float) -> Bands:
    """Return the bands of a solid, in closed form where there is one."""
    scene = light.scene
    low = scene.material.ambient * scene.ambient_intensity
    dull = scene.material.specular == 0 and scene.depth_cue is None
    found: Bands | None = None
    plain = dull and len(scene.lights) == 1 and not (light.two_sided or light.flip)
    if plain and isinstance(solid, Sphere | Truncus):
        (lamp,) = scene.lights
        source: dict[str, Any] = {
            "direction": lamp.direction, "position": lamp.position, "ambient": low,
            "diffuse": scene.material.diffuse * lamp.intensity,
            "attenuation": lamp.attenuation, "levels": levels,
        }  # fmt: skip
        if isinstance(solid, Sphere) and not lamp.follows_view:
            found = closed.sphere(solid.center, solid.radius, **source)
        if isinstance(solid, Truncus) and lamp.direction is not None:
            found = closed.truncus(
                solid.center, solid.axis, solid.radii, height=solid.height, **source
            )
    if found is not None:
        return found
    light.shape = tessellation.tessellate(solid, tolerance=tolerance)
    return refinement.draw(light.shape, light, levels, low=low if dull else None)


def _of_mesh(
    mesh: pv.DataSet, scene: Scene, levels: Levels, threads: int | None, options: dict[str, Any]
) -> tuple[pv.MultiBlock, Bands, _Light]:
    """Return bands and contours of a mesh."""
    surface, triangles, used, ids = _surface(mesh)
    given = dict(options)
    if ids is not None:
        for key in ("normals", "tangents"):
            if given[key] is not None and not isinstance(given[key], str):
                rows = point_arrays.array_of(mesh, key, given[key], average_cells=False)
                given[key] = np.where(ids[:, np.newaxis] < 0, 0, rows[ids])
    names = {field.name for field in dataclasses.fields(LightOptions)} - {"tolerance"}
    asked = LightOptions(
        precision="float64", **{key: value for key, value in given.items() if key in names}
    )
    (lit,), fitted = lighting.light(
        [(inputs_of(surface, "", scene, asked), asked)], scene, threads=threads, progress_bar=False
    )
    unlit = int(np.count_nonzero(~lit.valid[used]))
    if unlit:
        _check.warn(lighting.unlit(unlit, len(used)))
    points = np.array(surface.points, dtype=np.float64)
    light = _Light(scene, options["model"], options["two_sided"], options["flip_normals"], threads)
    rgb: Array | None = None
    if not len(triangles):
        steps = spacing.steps(levels, 0.0, 0.0)
        bands, _ = banding.cut(np.empty((0, 3)), triangles, np.empty((0, 3)), steps)
        bands = dataclasses.replace(bands, error=0.0)
    elif options["tangents"] is None:
        found = normals.normals_of(surface, given["normals"], 3, normals.onlooker(scene))
        unit = unit_rows(np.asarray(found, dtype=np.float64))
        rows = np.concatenate([points, unit], axis=1)

        def luminance(places: Array, directions: Array) -> Array:
            return light(places, unit_rows(directions))

        bands = refinement.refine(facets.Facets(rows, triangles, luminance, lit.valid), levels)
    else:
        values = np.asarray(lit.luminance[triangles], dtype=np.float64)
        steps = spacing.steps(levels, float(values.min()), float(values.max()), exact=True)
        # What comes with the luminance is interpolated as it is.
        columns = [points, lit.luminance[:, np.newaxis], *([] if lit.rgb is None else [lit.rgb])]
        cut, _ = banding.cut(np.concatenate(columns, axis=1), triangles, values, steps)
        bands = dataclasses.replace(cut, points=cut.points[:, :3], error=steps.error)
        if lit.rgb is not None:
            middles = cut.middles()
            rgb = _as_bright(middles[:, 4:], middles[:, 3], bands)
    told = records.of_light(lit, "isoluminance", fitted, options)
    if scene.colored and options["tangents"] is None:
        rgb = _rgb(bands, light)
    return _blocks(bands, options["name"], told, rgb, patches=False), bands, light


def _surface(mesh: Any) -> tuple[pv.PolyData, Indices, Indices, Any]:
    """Return the surface of a mesh, its triangles with finite corners, and points.

    Points are those that faces use, and which of the mesh each one is.
    """
    surface, ids = mesh, None
    if not isinstance(mesh, pv.PolyData):
        surface, ids = hull.outer_surface(mesh)
    if surface.n_points and not (surface.GetNumberOfPolys() or surface.GetNumberOfStrips()):
        remedy = "take a contour or the mesh's extract_surface()"
        raise ValueError(
            _check.message(
                "mesh", "a surface with faces", f"a {type(mesh).__name__} without", remedy
            )
        )
    bare = pv.PolyData()
    bare.SetPoints(surface.GetPoints())
    bare.SetPolys(surface.GetPolys())
    bare.SetStrips(surface.GetStrips())
    bare = bare if bare.is_all_triangles else bare.triangulate()
    triangles = np.asarray(bare.regular_faces, dtype=np.intp).reshape(-1, 3)
    finite: Any = np.isfinite(np.asarray(surface.points)).all(axis=1)
    return surface, triangles[finite[triangles].all(axis=1)], np.unique(triangles), ids


def _note(bands: Bands, light: _Light, seconds: float, size: int, *, sampled: bool) -> None:
    """Tell the report, if one is asked for, how far bands are from the light at their middles."""
    none: Array = np.empty((0, 3))
    places, normals = _middles(bands, light) if sampled and len(bands.values) else (none, none)
    terms = engine.plan(light.scene, normals=True, model=light.model).terms
    report.note_bands(
        bands.values, len(bands.points), places, -normals if light.flip else normals, light.scene,
        terms, seconds, size, bands.error, model=light.model, two_sided=light.two_sided,
    )  # fmt: skip


def _middles(bands: Bands, light: _Light) -> tuple[Array, Array]:
    """Return the middles of polygons, on the surface where it is known, and unit normals there."""
    middle, shape = bands.middles(), light.shape
    if shape is not None:
        patches = np.stack([bands.patch, bands.patch], axis=1)
        places = refinement.onto(shape.surfaces, (middle - shape.shift) / shape.scale, patches)
        return shape.world(places), refinement.normals_of(shape, places, bands.patch)
    normals = unit_rows(middle[:, 3:]) if middle.shape[1] == 6 else bands.normals()
    return middle[:, :3], normals


def _rgb(bands: Bands, light: _Light) -> Array:
    """Return the colour of each polygon: that of the light at its middle, as bright as its band."""
    value = light(*_middles(bands, light))
    return _as_bright(light.last.rgb, value, bands)


def _as_bright(rgb: Array, value: Array, bands: Bands) -> Array:
    """Return colours of some luminance made as bright as the band of each polygon."""
    share = np.divide(bands.values, value, out=np.ones_like(value), where=value > 0)
    return np.asarray(rgb * share[:, np.newaxis])


def _blocks(
    bands: Bands, name: str, told: dict[str, Any], rgb: Array | None, *, patches: bool
) -> pv.MultiBlock:
    """Return bands and contours as meshes."""
    points = bands.points[:, :3]
    size = np.diff(bands.offsets)
    cells = np.insert(bands.corners, bands.offsets[:-1], size)
    surface = pv.PolyData(points, faces=cells) if len(size) else pv.PolyData()
    surface.cell_data[lighting.part_name(name, "band")] = bands.band
    if patches:
        surface.cell_data[lighting.part_name(name, "patch")] = bands.patch
    if rgb is not None and len(rgb):
        surface.cell_data[lighting.part_name(name, "rgb")] = rgb
    surface.cell_data[name] = bands.values
    surface.cell_data.active_scalars_name = name
    surface.field_data[f"{name}_error"] = [bands.error]
    surface.field_data[records.key(name)] = [json.dumps(told)]
    lines = pv.PolyData()
    if len(bands.lines):
        used, ends = np.unique(bands.lines, return_inverse=True)
        ends = ends.reshape(-1, 2)
        lines = pv.PolyData(
            points[used], lines=np.column_stack([np.full(len(ends), 2), ends]).ravel()
        )
    lines.cell_data[name] = bands.line_levels
    return pv.MultiBlock({"bands": surface, "contours": lines})
