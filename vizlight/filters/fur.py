"""Fur: fibres that stand on a surface, lit, shadowed and attenuated, and the skin below."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check, _pool
from vizlight._types import Array, Exponent, FeatureAngle, Indices, Model, Slice, Vector, VectorLike
from vizlight.filters import lighting
from vizlight.geometry.lines import fur as geometry
from vizlight.mesh import blocks, bundles, georeference, records
from vizlight.mesh.normals import NORMALS, onlooker, split_where_computed, with_normals
from vizlight.mesh.sky import in_medium
from vizlight.model import kernels
from vizlight.scene import Material, Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import Bundle, Options, ShadingOptions, check_sides, checked_bundle
from vizlight.vtk.arrays import vectors_of

#: Default absorption, and length of fibres as a share of the diagonal of the mesh.
ABSORPTION, LENGTH = 0.5, 0.03
#: Material of fur, which is lit through fur and seen through fur.
MATERIAL = Material(ambient=0.4, diffuse=2.0, specular=0.3)
#: Number of fibres that a thread grows at once.
AT_ONCE = 1 << 13
#: Largest length of a fibre: differences of longer ones leave the range of float32.
LONGEST = 1e30


@dataclass(frozen=True, kw_only=True)
class FurOptions(Options):
    """Options of fur and its light.

    The fields are keywords of :func:`vizlight.fur`.
    """

    absorption: float | None = None
    density: float | None = None
    fibres: int = 50_000
    length: float | str | Sequence[float] | Array | None = None
    segments: int = 3
    tangents: str | None = None
    toward: str | VectorLike | None = None
    bend: float = 0.0
    curl: float = 0.0
    turns: float = 1.0
    seed: int = 0
    feature_angle: FeatureAngle = None
    conditioned: bool = True
    bundle: bool | Bundle = False
    exponent: Exponent = "compensated"
    model: Model = "phong"
    name: str = "luminance"

    def __post_init__(self) -> None:
        _check.flags(self)
        _check.set_fields(self, bundle=checked_bundle(self.bundle))
        if isinstance(self.bundle, Bundle):
            # A bundle dims by the fibres that lie in the way: a share of absorption beside it would
            # count them twice.
            if self.absorption is not None or self.density is not None:
                expected = "no absorption or density"
                remedy = "set the diameter of a vizlight.Bundle"
                raise _check.value_error("bundle", expected, "both", remedy)
            if self.bundle.lines is not None:
                expected, remedy = "the fibres", "leave it out"
                raise _check.value_error("Bundle(lines=)", expected, "other lines", remedy)
        check_sides("auto", self.feature_angle)
        for option in ("bend", "curl", "turns"):
            value = getattr(self, option)
            _check.number(option, value, low=-_check.LARGEST, high=_check.LARGEST)
        records.refuse_unnamed("tangents", self.tangents)
        if isinstance(self.toward, str):
            records.refuse_unnamed("toward", self.toward)
        if self.bend and self.toward is None:
            expected = "the direction of the bend, with bend="
            raise _check.value_error("toward", expected, None)
        shares = ("absorption", "density")
        _check.fields(self, _check.number, *shares, optional=True, low=0.0, high=1.0)
        if self.absorption is not None and self.density is not None:
            expected = "one of them: a share over the fur's length, or over a unit of length"
            raise _check.value_error("absorption, density", expected, "both")
        _check.fields(self, _check.integer, "fibres", "seed", low=0)
        _check.fields(self, _check.integer, "segments", low=1)

    @property
    def straight(self) -> bool:
        """Whether fibres neither bend nor curl."""
        return not (self.bend or self.curl)

    @property
    def lost(self) -> float:
        """Share of light that is lost over a unit of height, or over the fur's own length."""
        # In a bundle each light has a transmittance of its own, and Banks (7) and (8) are left out.
        if self.bundle:
            return 0.0
        if self.density is not None:
            return self.density
        return ABSORPTION if self.absorption is None else self.absorption


@named
def fur(
    surface: pv.PolyData,
    /,
    scene: AnyScene | None = None,
    *,
    absorption: float | None = None,
    density: float | None = None,
    fibres: int = 50000,
    length: float | str | Sequence[float] | Array | None = None,
    segments: int = 3,
    tangents: str | None = None,
    toward: str | VectorLike | None = None,
    bend: float = 0.0,
    curl: float = 0.0,
    turns: float = 1.0,
    seed: int = 0,
    feature_angle: FeatureAngle = None,
    conditioned: bool = True,
    bundle: bool | Bundle = False,
    exponent: Exponent = "compensated",
    model: Model = "phong",
    name: str = "luminance",
    progress_bar: bool = False,
) -> pv.MultiBlock:
    """Cover a surface with fibres and light them and the skin below.

    Parameters
    ----------
    surface : pyvista.PolyData
        Surface that is covered; not changed. Its active point normals, or those computed, point
        outward.
    scene : Scene or str, optional
        Scene, by default ``Scene()`` with the material ``filters.fur.MATERIAL``, as bright as fur
        that dims itself needs.
    absorption : float, optional
        Share of light from 0 to 1 that is lost on the way through the fur's own length, its mean
        over the points, along the normal, on its way in and out (Banks 7, 8): most at the root,
        not at all at the tip. 0: light is not attenuated. Default: 0.5, without ``density``.
    density : float, optional
        Share rho of light from 0 to 1 that fur absorbs over a unit of length, in place of
        ``absorption``, which is ``1 - (1 - rho)^L`` for fur of length L.
    fibres : int, default: 50_000
        Number of fibres, uniform in area, jittered, the same for the same seed.
    length : float, str or array_like, optional
        Length of a fibre, in the unit of the mesh, 0 or more: one for all, or a point array of
        one component, interpolated. Default: 0.03 of the diagonal of the mesh.
    segments : int, default: 3
        Number of segments of a fibre, of equal lengths.
    tangents : str, optional
        Name of a point array of 3 components along which fibres grow, whatever their length.
        Default: the normals, also where a vector is zero. A vector that points into the surface is
        reversed, and a warning counts them.
    toward : str or vector of 3 components, optional
        Direction to which fibres bend: one for all, or the name of a point array. It is one of
        space, in the frame of the mesh, not of the surface: where it leans out of the surface or
        into it, fibres that bend to it do too. Fur that lies along a surface takes an array of
        vectors that are tangent to it.
    bend : float, default: 0.0
        Share of ``toward`` in the direction at the tip.
    curl, turns : float
        Sideways share of the direction, 0.3 for soft fur, and number of its turns from root to
        tip.
    seed : int, default: 0
        Seed of the random numbers.
    feature_angle : float or "auto", optional
        Angle in degrees above which edges are sharp, as for :func:`vizlight.illuminate`. Default:
        none is.
    conditioned : bool, default: True
        Whether fibres inherit the self-shadow of the surface (Banks 6).
    bundle : bool or Bundle, default: False
        Whether the fibres dim one another and the skin as a bundle of thin cylinders, as for
        :func:`vizlight.illuminate`, in place of the attenuation by Banks (7, 8), which does not
        know of neighbours.
    exponent, model, name
        As for :func:`vizlight.illuminate`; with ``model="cylinder"`` the highlight of the skin is
        Blinn's.
    progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.MultiBlock
        ``fibres``: lines from root to tip, points in the precision of the surface, in float64
        where it is far from the origin. ``skin``: the surface, lit by its normals and attenuated
        by the fur that stands on it. Both with the point array ``luminance``, and ``rgb`` where
        the scene has a colour.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit: a negative length, a share outside [0, 1], no faces.

    Warns
    -----
    UserWarning
        Once each, with the count, if vectors point into the surface or are not finite, and if
        points could not be lit.

    Notes
    -----
    Fibres stand evenly on any triangulation. The height of fur above a point is the distance,
    across the surface at the root, from the point to the highest point of its fibre. Sources: Banks
    4.2, 5, (7), (8).
    """
    options = FurOptions.of(locals())
    scene = as_scene(Scene(material=MATERIAL) if scene is None else scene)
    grown = grow(surface, scene, options, progress_bar=progress_bar)
    parts, origin, inside = grown.parts, grown.origin, grown.inside
    # A depth cue spans the skin.
    scene = lighting.fit_depth_cue(scene, [parts[1][0].points])
    points = np.asarray(parts[0][0].points)
    results, scene = lighting.light(parts, scene, progress_bar=progress_bar)
    # The inputs of the light are freed before the cells of the lines are made.
    parts.clear()
    if any(origin):
        # The engine lit points less the origin; the mesh has them where its surface is.
        points += np.array(origin)
    if inside:
        _check.warn(f"{inside} of {options.fibres} fibres point into the surface and were reversed")
    meshes = [_mesh(points, options.segments + 1), grown.surface.copy(deep=True)]
    georeference.place_alike(meshes[0], grown.surface)
    lighting.finish(meshes, results, "fur", scene, options, name, dimmings=grown.dimmings)
    return pv.MultiBlock(dict(zip(("fibres", "skin"), meshes, strict=True)))


class Grown(NamedTuple):
    """Fur that has grown and is not lit.

    ``parts`` are inputs and options of the light of the fibres and of the skin. ``origin`` was
    subtracted from the points, ``inside`` is the number of fibres with vectors that point into the
    surface, and ``dimmings`` are shares of light inside a bundle.
    """

    surface: pv.PolyData
    parts: list[tuple[ShadingInputs, ShadingOptions]]
    origin: Vector
    inside: int
    dimmings: list[bundles.Dimming]


def grow(
    surface: pv.DataSet | pv.MultiBlock, scene: Scene, options: FurOptions, *, progress_bar: bool
) -> Grown:
    """Return the fur of a surface; see :func:`fur`."""
    if scene.n not in (None, 3):
        raise _check.value_error("scene", "vectors of 3 components", scene.n)
    # Splitting at sharp edges makes more points, and only arrays that the mesh carries go with
    # them.
    if options.feature_angle is not None and np.asarray(options.length, dtype=object).ndim:
        expected, remedy = "the name of a point array beside feature_angle=", "attach the array"
        raise _check.type_error("length", expected, options.length, remedy)
    surface = records.averaged(blocks.surface(surface, "surface"), options.length, options.toward)
    surface = split_where_computed(surface, options.feature_angle)
    skin = with_normals(surface, onlooker(scene), options.feature_angle)
    lighting.refuse_overwriting([(surface, "")], options.name, scene, bundle=bool(options.bundle))
    _check.holds("fibres, segments", (options.fibres, options.segments + 1, 3))
    coat = _Coat(surface, skin, options)
    if options.fibres and not (len(coat.total) and coat.total[-1] > 0):
        raise _check.value_error("surface", "faces of some area", "none")
    hairs, inside = coat.fibres()
    # The skin is a surface of its own, which light reaches through the fur above it.
    below = ShadingInputs(
        points=np.asarray(skin.points),
        normals=np.asarray(skin.point_data[NORMALS]),
        fur_height=coat.skin_heights() if options.lost else None,
        fur=options.lost,
    )
    dimmings: list[bundles.Dimming] = []
    if isinstance(options.bundle, Bundle):
        # The lines of the bundle are in the space of the surface, and the fibres are less the
        # origin.
        points = np.asarray(hairs.points)
        lines = _mesh(points + np.array(coat.origin) if any(coat.origin) else points, hairs.repeat)
        (hairs, below), dimmings = lighting.dimmed(
            [lines, surface], [hairs, below], scene, options.bundle, options.name, show=progress_bar
        )
        # Ambient light comes from all sides: its share in the fur is found in the medium of the
        # fibres.
        medium = bundles.medium_of(bundles.joined([lines]), options.bundle)
        sides = np.asarray(skin.point_data[NORMALS])
        shares = in_medium(lines, medium, None), in_medium(skin, medium, sides)
        hairs, below = (
            dataclasses.replace(inputs, occlusion=share)
            for inputs, share in zip((hairs, below), shares, strict=True)
        )
    light = ShadingOptions.of(vars(options))
    parts = [(hairs, light), (below, light.for_surface())]
    return Grown(surface, parts, coat.origin, inside, dimmings)


class _Coat:
    """Point arrays of a triangulated surface, in float32, from which fibres are made.

    Points are less ``origin``, which is not 0 for a surface far from the origin of space.
    """

    def __init__(self, surface: pv.PolyData, skin: pv.PolyData, options: FurOptions) -> None:
        self.options = options
        shape = {name: getattr(options, name) for name in ("segments", "bend", "curl", "turns")}
        #: Function of the points of fibres less their roots.
        self._strands = functools.partial(geometry.strands, **shape)
        self.origin = blocks.near_origin(skin)
        #: Type of the points.
        self.kind = np.dtype(np.float64)
        # Near the origin float32 is enough, unless the surface itself has more digits.
        if not any(self.origin):
            self.kind = np.result_type(skin.points.dtype, np.float32)
        size = float(skin.length)
        if not 1e-30 <= size <= 1e30 and skin.n_points:
            raise _check.value_error("surface", "a size from 1e-30 to 1e30", size, "scale the mesh")
        faces: Indices = np.asarray(skin.regular_faces, dtype=np.intp)
        # Along a Hilbert curve neighbouring seeds are neighbouring places, so that fibres stand
        # evenly whatever the order of the faces.
        order, self.total = geometry.laid(np.asarray(skin.points), faces)
        self.faces = faces.take(order, axis=0)
        self.normals = np.asarray(skin.point_data[NORMALS], dtype=np.float32)
        self.vectors: Array | None = None
        if options.tangents is not None:
            vectors = vectors_of(surface, "tangents", options.tangents, 3)
            lost = len(vectors) - int(np.count_nonzero(np.all(np.isfinite(vectors), axis=1)))
            if lost:
                what = "the vectors are not finite: fibres there follow the normals"
                _check.warn(f"{lost} of {len(vectors)} of {what}")
            # Of length 1, so that long vectors do not prevail where they are interpolated.
            self.vectors = kernels.unit_rows(vectors).astype(np.float32)
        self.toward = _toward(surface, options.toward)
        self.length: Array | float = (
            LENGTH * size if options.length is None else _lengths(surface, options.length)
        )
        # The unit of the heights of fur, in which light is lost.
        mean = float(np.mean(self.length)) if np.size(self.length) else 0.0
        self.unit = mean if options.density is None and mean > 0 else 1.0
        # All interpolated values stand in one table, so that they are looked up once.
        with np.errstate(invalid="ignore"):
            # The origin goes before the numbers are rounded to float32, which far away has few
            # digits.
            local = np.asarray(skin.points) - np.array(self.origin)
        parts: list[Array] = [local.astype(np.float32), self.normals]
        if self.vectors is not None:
            parts.append(self.vectors)
        # One direction for all is the same at every place, and is not interpolated.
        if self.toward is not None and len(self.toward) > 1:
            parts.append(self.toward)
        if isinstance(self.length, np.ndarray):
            parts.append(self.length[:, np.newaxis])
        self._table = np.concatenate(parts, axis=1)
        self._cuts = np.cumsum([part.shape[1] for part in parts])[:-1]

    def fibres(self) -> tuple[ShadingInputs, int]:
        """Grow all fibres; return the inputs of their light, and the number of those reversed."""
        options = self.options
        count, m = options.fibres, options.segments + 1
        # Straight fibres have one tangent each.
        each = (count,) if options.straight else (count, m)
        points, single = np.empty((count, m, 3), self.kind), np.float32
        tangents: Array = np.empty((*each, 3), single)
        normals: Array | None = None
        if options.conditioned or options.lost:
            # Straight fibres without vectors stand along the normals.
            upright = options.straight and self.vectors is None
            normals = tangents if upright else np.empty((count, 3), single)
        heights: Array | None = np.empty((count, m), single) if options.lost else None

        def work(block: Slice) -> int:
            face, weights = geometry.seed_block(self.total, block.start, count, options.seed)
            # Drawn by the block of seeds, so that the curls do not depend on the number of threads.
            phases: Array | None = None
            if options.curl:
                random = np.random.default_rng([options.seed, block.start, 1])
                phases = random.random(len(face)) * 2 * np.pi
            reversed_ = 0
            # In parts that fit the caches.
            for part in _pool.blocks(len(face), AT_ONCE):
                at = slice(block.start + part.start, block.start + part.stop)
                phase = None if phases is None else phases[part]
                root, normal, way, offsets, inside = self._grown(face[part], weights[part], phase)
                # The points are stored fibre by fibre; offsets have the points first and the fibres
                # last.
                np.add(root, offsets, out=points[at].transpose(1, 2, 0))
                along = way if options.straight else geometry.tangents(offsets, way)
                np.moveaxis(tangents[at], 0, -1)[...] = along
                if normals is not None:
                    normals[at] = normal.T
                if heights is not None:
                    height = self._heights(offsets, normal)
                    # Fur above a point reaches to the highest point of its fibre.
                    np.subtract(height.max(axis=0), height, out=heights[at].T)
                reversed_ += inside
            return reversed_

        # Threads share blocks of seeds, each with a generator of its own: the fur does not depend
        # on their number.
        inside = sum(_pool.run(work, _pool.blocks(count, geometry.SEED_BLOCK)))
        inputs = ShadingInputs(
            points=points.reshape(-1, 3),
            tangents=tangents.reshape(-1, 3),
            normals=normals,
            fur_height=None if heights is None else heights.reshape(-1),
            fur=options.lost,
            # One row of normals, and of tangents of straight fibres, serves all m points of a
            # fibre.
            repeat=m,
            origin=self.origin,
        )
        return inputs, inside

    def _grown(
        self, face: Indices, weights: Array, phase: Array | None
    ) -> tuple[Array, Array, Array, Array, int]:
        """Return roots, normals, directions, points less roots, and the number reversed."""
        corners = self.faces.take(face, axis=0)
        rows: Array = self._table.take(corners[:, 0], axis=0)
        # Barycentric weights of the roots, corner after corner of their triangles.
        rows *= weights[:, :1]
        for i in (1, 2):
            corner = self._table.take(corners[:, i], axis=0)
            corner *= weights[:, i : i + 1]
            rows += corner
        columns = iter(np.split(np.ascontiguousarray(rows.T), self._cuts))
        # Between corners the mean of unit normals is shorter than 1.
        root, normal = next(columns), kernels.unit(next(columns))[0]
        way, inside = self._ways(normal, None if self.vectors is None else next(columns))
        toward = None if self.toward is None else self.toward.T
        if toward is not None and toward.shape[1] > 1:
            toward = kernels.unit(next(columns))[0]
        length = next(columns)[0] if isinstance(self.length, np.ndarray) else self.length
        return root, normal, way, self._strands(way, length, toward=toward, phase=phase), inside

    def _ways(self, normal: Array, vector: Array | None) -> tuple[Array, int]:
        """Return unit directions at the root, and how many of the vectors point inward."""
        if vector is None:
            return normal, 0
        way, size = kernels.unit(vector)
        # A fibre without a direction of its own, as at a vector of 0, stands along the normal.
        way = np.where(size > 0, way, normal)
        # Fibres that would grow into the surface are reversed, and counted for the warning.
        inside = kernels.dot(way, normal) < 0
        way[:, inside] *= -1
        return way, int(np.count_nonzero(inside))

    def skin_heights(self) -> Array:
        """Return the height of a fibre that stood on each point of the skin."""
        # A fibre is grown on each point of the skin, to know how much fur covers it.
        normal = kernels.unit(np.ascontiguousarray(self.normals.T))[0]
        way, _ = self._ways(normal, None if self.vectors is None else self.vectors.T)
        toward = None if self.toward is None else self.toward.T
        offsets = self._strands(way, self.length, toward=toward)
        return np.asarray(self._heights(offsets, normal).max(axis=0))

    def _heights(self, offsets: Array, normal: Array) -> Array:
        """Return heights of points over the surface at the root, in units."""
        # Heights are along the normal; the engine divides them by the sine of the way of the light
        # (Banks 7, 8).
        height: Array = np.einsum("jib,ib->jb", offsets, normal)
        height /= np.float32(self.unit)
        return height


def _mesh(points: Array, m: int) -> pv.PolyData:
    """Return fibres of m points each as lines; the points are not copied."""
    count = int(points.shape[0])
    # Indices of 32 bits take half the memory.
    number = np.int32 if count < 2**31 else np.int64
    out = pv.PolyData()
    out.points = points
    offsets = np.arange(0, count + 1, m, dtype=number)
    ids = np.arange(count, dtype=number)
    out.SetLines(pv.CellArray.from_arrays(offsets, ids))  # type: ignore[arg-type]
    return out


def _toward(surface: pv.PolyData, toward: str | VectorLike | None) -> Array | None:
    """Return the unit direction to which fibres bend, one or one per point."""
    if toward is None:
        return None
    if isinstance(toward, str):
        rows = vectors_of(surface, "toward", toward, 3)
    else:
        rows = np.array([_check.vector("toward", toward, direction=True, n=3)])
    return kernels.unit_rows(rows).astype(np.float32)


def _lengths(mesh: pv.PolyData, length: object) -> Array | float:
    if isinstance(length, str):
        _check.text("length", length, expected="a length or the name of a point array")
        length = records.scalars_of(mesh, "length", length)
    array = _check.floats("length", length)
    if array.ndim == 0:
        return _check.number("length", array, low=0.0, high=LONGEST)
    if array.shape != (mesh.n_points,) or not np.all((array >= 0) & (array <= LONGEST)):
        raise _check.value_error("length", f"{mesh.n_points} lengths of 0 or more", array)
    return array.astype(np.float32, copy=False)
