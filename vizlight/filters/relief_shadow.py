"""Cos-theta shadows as point scalars, on height fields and on closed surfaces."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check, _progress
from vizlight._types import Array, FeatureAngle, Keywords, Raw
from vizlight.filters import lighting
from vizlight.filters.sky import with_sky
from vizlight.geometry.relief import sun as sky
from vizlight.geometry.relief.height_field import Border
from vizlight.mesh import blocks, records
from vizlight.mesh.blocks import MeshT
from vizlight.mesh.casters import CasterOptions, FieldCaster, SolidCaster, caster
from vizlight.mesh.height_grids import Grid, elevation_name
from vizlight.mesh.normals import split_where_computed
from vizlight.mesh.sky import ABOVE
from vizlight.scene import Light, Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.shading.results import (
    DEFAULT_NAME,
    PARTS,
    VALID,
    arrays_of,
    digest,
    of_filter,
    of_light,
)
from vizlight.vtk.cells import check_whole, triangles
from vizlight.vtk.parts import share_of

#: Share of a surface in which shadows end from which a warning is given, and sides of triangles
#: that are long: as a share of the mesh's longest side, or in cells of the raster.
SMEARED, LONG, WIDE = 0.3, 0.2, 4.0


@dataclass(frozen=True, kw_only=True)
class ReliefOptions(CasterOptions):
    """Options of cos-theta shadows.

    The fields are keywords of :func:`vizlight.relief_shadow`.
    """

    angular_diameter: float = 0.0
    samples: int = 16
    lit: bool = False
    components: bool = False
    occlusion: str | None = None
    name: str = "t"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check.flags(self)
        _check.array_name("name", self.name)
        if self.occlusion is not None:
            _check.text("occlusion", self.occlusion, expected="the name of a point array")
            if not self.lit:
                raise _check.value_error("occlusion", "lit=True beside it", repr(self.occlusion))
        _check.fields(self, _check.number, "angular_diameter", low=0.0, high=1.0)
        _check.fields(self, _check.integer, "samples", low=1)


class Shadows(NamedTuple):
    """The shadows on a surface, before they are cast.

    The surface has its points split at sharp edges; rays of the lights pass the ``caster``. The
    lights have an intensity above 0, where the view has them, and ``share`` is that of the ambient
    light that reaches the points.
    """

    surface: Grid | pv.PolyData
    caster: FieldCaster | SolidCaster
    lights: list[Light]
    share: Array | None

    @classmethod
    def of(cls, mesh: Grid | pv.PolyData, scene: Scene, options: ReliefOptions) -> Shadows:
        """Return the shadows that the lights of a scene cast."""
        check_whole(mesh, "mesh")
        # A light that is off casts no shadow and has no weight in the mean.
        lights = [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]
        if not lights:
            raise _check.value_error("scene", "a light of intensity above 0", "none")
        if scene.n not in (None, 3):
            raise _check.value_error("scene", "vectors of 3 components", f"{scene.n}")
        # A raster is sampled from above, and does not need the points of edges apart.
        is_raster = options.raster is not None
        surface = mesh if is_raster else split_where_computed(mesh, options.feature_angle)
        ground = surface.copy(deep=False) if is_raster else surface
        if is_raster:
            # Sampled from above, it has its sky above alone, whatever side its normals are on.
            ground.point_data.active_normals_name = None
        (sunlit,) = with_sky(
            [ground], options.occlusion, elevation=options.elevation, factor=options.exaggeration,
            up=ABOVE if is_raster else None,
        )  # fmt: skip
        share = share_of(sunlit, options.occlusion)
        if sunlit is not ground:
            # The sky stays with the result, which may be lit again.
            assert isinstance(sunlit, Grid | pv.PolyData)
            sunlit.point_data.active_normals_name = surface.point_data.active_normals_name
            surface = sunlit
        return cls(surface, caster(surface, scene, options), lights, share)

    def ratios(self, options: ReliefOptions, *, progress_bar: bool) -> Array:
        """Return t of each point (rows) and light."""
        shadow, lights = self.caster, self.lights
        t = np.empty((len(shadow.points), len(lights)))
        discs = [_disc(light, options) for light in lights]
        count, done = len(t), 0
        total = count * sum(map(len, discs))
        with _progress.progress("shadow", total, show=progress_bar) as report:
            for i, disc in enumerate(discs):
                column = np.zeros(count)
                for lamp in disc:
                    column += shadow.ratios(lamp, lambda now, done=done: report(done + now))  # type: ignore[misc]
                    done += count
                    report(done)
                t[:, i] = column / len(disc)
        return t

    def reference(self, point: int, light: int, options: ReliefOptions) -> float:
        """Return t of a point and a light by a second implementation."""
        disc = _disc(self.lights[light], options)
        return float(np.mean([self.caster.reference(point, lamp) for lamp in disc]))

    def effort(self, options: ReliefOptions) -> int:
        """Return the number of planes of nodes or triangles that one reference tests; 0 if none."""
        return self.caster.effort * max(len(_disc(light, options)) for light in self.lights)

    @property
    def ground(self) -> str:
        """Digest of the ground: of its points, and of a surface of its normals and cells too."""
        if isinstance(self.surface, Grid):
            return digest(self.caster.points)
        cells = records.fingerprint(self.surface)
        return f"{records.source(self.caster.points, self.caster.normals)} {cells}"

    def recorded(self, options: ReliefOptions, scene: Scene) -> Array | None:
        """Return t of each point from its arrays, None where they are of other ground or light.

        With several lights a mesh holds their mean, and each of them if lit with ``components``.
        """
        name, count = options.name, len(self.lights)
        record, ours = records.read(self.surface, name) or {}, records.made(self.surface, name)
        columns = [name] if count == 1 else [f"{name}_{i}" for i in range(count)]
        if record.get("ground") != self.ground or not ours.issuperset(columns):
            return None
        cast_by = ReliefOptions.of(record["options"] | {"lit": True, "components": False})
        if cast_by != options or Scene.from_dict(record["scene"]) != scene:
            return None
        return np.column_stack([np.asarray(self.surface.point_data[key]) for key in columns])

    def inputs(self, t: Array) -> ShadingInputs:
        """Return what the engine lights: it multiplies each light by its own column of t."""
        return ShadingInputs(
            points=self.caster.points, normals=self.caster.normals, shadow=t, occlusion=self.share
        )


@named
def relief_shadow(
    mesh: MeshT,
    /,
    scene: AnyScene | None = None,
    *,
    sun: Sequence[float] | None = None,
    angular_diameter: float = 0.0,
    samples: int = 16,
    lit: bool = False,
    components: bool = False,
    occlusion: str | None = None,
    name: str = "t",
    depth: float | None = None,
    elevation: str | None = None,
    exaggeration: float = 1.0,
    border: Border = "extend",
    raster: float | None = None,
    thickness: float | None = None,
    feature_angle: FeatureAngle = None,
    occluders: pv.PolyData | Sequence[pv.PolyData] = (),
    inplace: bool = False,
    progress_bar: bool = False,
) -> MeshT:
    """Return a mesh with its cos-theta shadow: cosine, shadow and scattering in one number.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        A height field of one layer, its rows and columns straight and square to each other, or
        any surface with ``raster``; or a closed surface, such as the outer one of a volume, which
        is taken. Of a MultiBlock each block by itself. Not changed, unless ``inplace``. Lengths of
        a map in degrees are in metres from its centre.
    scene : Scene or str, optional
        Scene with the lights that cast the shadows, at infinity or near, in the unit of the mesh,
        by default ``Scene()``.
    sun : (azimuth, altitude), optional
        Angles toward the sun in degrees, in place of the lights of the scene: azimuth clockwise
        from north, the y axis, and altitude above the horizon.
    angular_diameter : float, default: 0.0
        Angular diameter of the lights at infinity, in radians: the sun's 0.53 degrees are 0.00925.
    samples : int, default: 16
        Number of directions, equal in area, that stand for a light with an angular diameter.
    lit : bool, default: False
        Whether ``luminance`` is added, and ``rgb`` where the scene has a colour: the engine's
        light with t in place of the cosine; a highlight keeps ``min(1, t / cos)``.
    components : bool, default: False
        Whether ``t_0``, ``t_1``, ..., one for each light, are added, and with ``lit`` the terms of
        the engine.
    occlusion : str, optional
        Name of a point array that multiplies the ambient term of the light, as for
        :func:`vizlight.illuminate`: ``lit=True, occlusion="sky"`` is the light of sun and sky.
        A sky that is computed stays with the result.
    name : str, default: "t"
        Name of the result.
    depth : float, optional
        Depth d below the surface at which light is gathered, 0 or more, in the unit of the mesh:
        a larger depth gives softer shadows, and fewer where it exceeds the relief. Default: for a
        height field an eighth of a cell's width, but at most half the mean difference of heights
        from node to node; for a closed surface 0.01 of the diagonal of its faces.
    elevation : str, optional
        Name of a point array of heights. Default: z of a StructuredGrid or of a surface that is
        sampled, else the active scalars. NaN is a hole.
    exaggeration : float, default: 1.0
        Factor of the heights; only for height fields.
    border
        As for :func:`vizlight.geometry.relief.inside_length`; only for height fields. With
        "extend" the slope of the last cells goes on for one cell first. Walls reach down without
        end.
    raster : float, optional
        Spacing of an even grid on which curvilinear grids and open surfaces are sampled from
        above, such as a TIN; 0 for the root of the mean area per point. Shadows then end within a
        cell of it; nodes that it does not cover have the height of the nearest covered one.
    thickness : float, optional
        Thickness of the shell, measured against the normals, that stands for an open surface.
    feature_angle : float or "auto", optional
        Angle in degrees above which edges of a closed surface are sharp, as for
        :func:`vizlight.illuminate`. Default: none is.
    occluders : pyvista.PolyData or sequence of pyvista.PolyData
        Further closed surfaces between the surface and the light.
    inplace, progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.DataSet
        With the point array ``t`` in [0, 1], the mean of all lights weighed by their intensity,
        and ``t_provenance``. ``t_valid`` marks points without height or normal, where t is 0.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit; if the mesh is open, a grid has several layers or one row,
        or a light is inside the solid.

    Warns
    -----
    UserWarning
        Once, with the count, if points have no height or no normal. Once, if shadows end within
        long triangles that are more than 0.3 of a surface.

    Notes
    -----
    ``t = d / r``, r the length inside the solid of the segment from ``p' = p - d n`` to the
    light; 1 where r is less than d. A field of cells of size h errs by h^2 / d, in the mean
    where shadows begin. Rays through a closed surface are followed in float64. On a map in degrees
    each point is lit in the frame of its own row, as if the parallels were straight and the earth
    flat: with heights so large that a third of the map is in shadow, t is off by 0.004 in the mean
    on a map of 1 degree, 0.008 on one of 10, and 0.03 on one of 60 or 150, beside straight rays
    through the ground of a sphere. The highlight and the attenuation of a lamp near the map, with
    ``lit``, take metres along x of the middle row.
    Source: cos-theta, section 3, which prints ``t = r/d`` once; it is d/r.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> flat = pv.ImageData(dimensions=(5, 5, 1))
    >>> flat["height"] = [0.0] * 25
    >>> round(float(vizlight.relief_shadow(flat, sun=(315, 30))["t"][7]), 9)
    0.5
    """
    options = ReliefOptions.of(locals())
    inplace = _check.boolean("inplace", inplace)
    if isinstance(mesh, pv.MultiBlock):
        keywords: Keywords = options.changed()
        keywords |= {"sun": sun, "progress_bar": progress_bar}
        shadowed = blocks.each(
            mesh, lambda block: relief_shadow(block, scene, inplace=inplace, **keywords)
        )
        return mesh if inplace else shadowed
    scene = as_scene(scene)
    if sun is not None:
        scene = scene.replace(lights=[Light(direction=sun_direction(sun))])
    if isinstance(mesh, pv.DataSet) and not isinstance(mesh, pv.PolyData | Grid):
        mesh = blocks.surface(mesh, "mesh")
    cast = Shadows.of(mesh, scene, options)
    surface, shadow, lights = cast.surface, cast.caster, cast.lights
    if options.elevation is None and (isinstance(surface, Grid) or options.raster is not None):
        # For the record: in the result the light is the active array.
        options = dataclasses.replace(options, elevation=elevation_name(surface))
    name = options.name
    each = [f"{name}_{i}" for i in range(len(lights) if options.components else 0)]
    names = [name, name + VALID, *each]
    records.refuse_overwriting([(mesh, "")], name, names)
    if options.lit:
        taken = sorted({DEFAULT_NAME, DEFAULT_NAME + VALID, *PARTS}.intersection(names))
        if taken:
            expected = "a name that the light does not use, with lit=True"
            raise _check.value_error("name", expected, repr(taken[0]))
        lighting.refuse_overwriting(
            [(mesh, "")], DEFAULT_NAME, scene, components=options.components
        )
    t = cast.ratios(options, progress_bar=progress_bar)
    weight = np.array([light.intensity for light in lights])
    missing = int(np.count_nonzero(~shadow.valid))
    record = of_filter(
        "relief_shadow", scene, options, precision="float64", points=len(t), invalid=missing,
        depth=shadow.depth, ground=cast.ground,
    )  # fmt: skip
    shading = None
    if options.lit:
        part = cast.inputs(t), ShadingOptions(components=options.components)
        (shading,), _ = lighting.light([part], scene.replace(lights=lights), progress_bar=False)
    # Nothing is attached before all is computed: a failure leaves the mesh as it was.
    out, _ = blocks.placed(mesh, [surface], inplace=inplace)
    if shading is not None:
        light = of_light(shading, "relief_shadow", scene, options)
        lit_arrays = arrays_of(shading, DEFAULT_NAME, occlusion=cast.share)
        records.attach(out, DEFAULT_NAME, lit_arrays, light)
    arrays: dict[str, Raw] = {key: t[:, i].copy() for i, key in enumerate(each)}
    arrays[name] = t @ (weight / weight.sum())
    if missing:
        arrays[name + VALID] = shadow.valid
        lacking = "height" if isinstance(shadow, FieldCaster) else "normal"
        _check.warn(
            f"{missing} of {len(t)} points have no {lacking} and t = 0; "
            f"the point array {name + VALID!r} marks them"
        )
    _warn_of_wide(surface, t, options.raster)
    records.attach(out, name, arrays, record)
    if options.lit:
        records.activate(out, DEFAULT_NAME)
    return out


def _warn_of_wide(mesh: pv.DataSet, t: Array, raster: float | None) -> None:
    """Warn if shadows end within large triangles of a surface, over which they are interpolated."""
    if not isinstance(mesh, pv.PolyData):
        return
    corners, unit = triangles(mesh), blocks.box(mesh)[1]
    with np.errstate(all="ignore"):
        # In units of the box products of lengths neither overflow nor vanish.
        points = np.asarray(mesh.points, np.float64)[corners] / unit
        sides = points - np.roll(points, 1, axis=1)
        area = np.nan_to_num(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)) / 2
        # A shadow's edge lies between a corner in light and one in shadow.
        across = (np.ptp(t[corners], axis=1) > 1 / 2).any(axis=1)
        long = LONG
        if raster is not None:
            # A raster of 0 stands for the root of the mean area per point.
            long = WIDE * (raster / unit or (area.sum() / mesh.n_points) ** 0.5)
        across &= np.linalg.norm(sides, axis=2).max(axis=1) > long
        share = float(area[across].sum() / area.sum()) if area.any() else 0.0
    if share > SMEARED:
        _check.warn(
            f"shadows end within triangles that are {share:.0%} of the surface, and are "
            "interpolated over them; smaller ones show their edges: "
            "mesh.triangulate().subdivide(3, 'linear')"
        )


def sun_direction(sun: object) -> Array:
    """Return the direction toward the sun from its azimuth and altitude in degrees."""
    angles = _check.floats("sun", sun)
    if angles.shape != (2,):
        expected = "two angles in degrees, (azimuth, altitude)"
        raise _check.value_error("sun", expected, _check.describe(sun))
    if not (np.isfinite(angles).all() and abs(angles[1]) <= 90):
        expected = "an azimuth and an altitude from -90 to 90 degrees"
        raise _check.value_error("sun", expected, _check.describe(tuple(angles.tolist())))
    return sky.toward(angles[0], angles[1])


def _disc(light: Light, options: ReliefOptions) -> list[Light]:
    """Return lights of equal area each that stand for the disc of a light."""
    diameter, samples = options.angular_diameter, options.samples
    if light.direction is None or diameter == 0 or samples == 1:
        return [light]
    return [
        Light(direction=way, intensity=light.intensity)
        for way in sky.disc(light.direction, diameter, samples)
    ]
