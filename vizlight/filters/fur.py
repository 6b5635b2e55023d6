"""Fur: fibres that stand on a surface, lit, shadowed and attenuated, and the skin below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters import lighting
from vizlight.filters.lighting import Job
from vizlight.geometry.lines import fur as geometry
from vizlight.mesh import point_arrays, surfaces
from vizlight.mesh.point_arrays import unit_rows
from vizlight.mesh.strands import Grown, Strands
from vizlight.model import kernels
from vizlight.scene import Scene
from vizlight.shading.options import surface_model

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.shading import engine

Inward = Literal["keep", "flip", "drop"]
#: Of a fibre: differences of longer ones leave the range of float32.
LONGEST = 1e30


def fur(
    surface: Any,
    /,
    scene: Scene,
    *,
    density: float,
    fibres: int = 50_000,
    length: Any = 0.1,
    segments: int = 3,
    vectors: str | None = None,
    inward: Inward = "flip",
    toward: Any = None,
    bend: float = 0.0,
    curl: float = 0.0,
    turns: float = 1.0,
    seed: int = 0,
    conditioned: bool = True,
    attenuated: bool = True,
    compensate: bool = True,
    model: engine.Model = "phong",
    threads: int | None = None,
    name: str = "luminance",
    progress_bar: bool = False,
) -> Any:
    """Cover a surface with fibres and light them and the skin below.

    Parameters
    ----------
    surface : pyvista.PolyData
        Not changed. Its active point normals, or those computed, say what is outside.
    scene : Scene
        With a view, if the light is attenuated.
    density : float
        rho in [0, 1], the share of light that fur absorbs over a unit of length.
    fibres : int, default: 50_000
        How many, uniform in area, jittered, the same for the same seed.
    length : float, str or array_like, default: 0.1
        Of a fibre, in the unit of the mesh, 0 or more: one for all, or a point array of one
        component, interpolated.
    segments : int, default: 3
        Of a fibre, all of one length.
    vectors : str, optional
        A point array of 3 components along which fibres grow, whatever their length; default the
        normals, also where a vector is zero.
    inward : {"flip", "keep", "drop"}
        What becomes of fibres whose vector points into the surface; a warning counts them.
    toward : str or vector of 3 components, optional
        What fibres bend to: a point array or one direction.
    bend : float, default: 0.0
        How much: the share of ``toward`` in the direction at the tip.
    curl, turns : float
        Sideways share of the direction, and its turns from root to tip.
    seed : int, default: 0
    conditioned : bool, default: True
        Inherit the surface's self-shadow (Banks 6).
    attenuated : bool, default: True
        Attenuate by the fur above a point on the light's way in and out (Banks 7, 8): most at
        the base, not at all at the tip.
    compensate, model, threads, name, progress_bar
        As for :func:`vizlight.illuminate`; with ``model="cylinder"`` the skin's law is Blinn's.

    Returns
    -------
    pyvista.MultiBlock
        ``fibres``: lines from root to tip, points in the surface's precision, in float64 where it
        is far from the origin. ``skin``: the surface, lit by its
        normals and attenuated by the fur that stands on it. Both with the point array
        ``luminance``, and ``rgb`` where the scene has a colour.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit: a negative length, a density outside [0, 1], no faces.

    Warns
    -----
    UserWarning
        Once each, with the count, if vectors point into the surface or are not finite, and if
        points could not be lit.

    Notes
    -----
    The height of fur above a point is how far, across the surface at the root, the fibre's
    highest point stands above it. Sources: Banks 4.2, 5, (7), (8).
    """
    density = _check.number("density", density, low=0.0, high=1.0)
    fibres = _check.integer("fibres", fibres, low=0)
    segments = _check.integer("segments", segments, low=1)
    seed = _check.integer("seed", seed, low=0)
    if inward not in get_args(Inward):
        raise ValueError(_check.message("inward", "'keep', 'flip' or 'drop'", repr(inward)))
    for option, value in (("bend", bend), ("curl", curl), ("turns", turns)):
        _check.number(option, value, low=-_check.LARGEST, high=_check.LARGEST)
    point_arrays.refuse_unnamed("vectors", vectors)
    if bend and toward is None:
        raise ValueError(_check.message("toward", "what fibres bend to, with bend=", None))
    _check.instance("scene", scene, Scene)
    if scene.n not in (None, 3):
        raise ValueError(_check.message("scene", "vectors of 3 components", scene.n))
    skin = surfaces.with_normals(surface, point_arrays.onlooker(scene))
    lighting.refuse_overwriting([(surface, "")], name, components=False, colored=scene.colored)
    told = {
        "density": density, "fibres": fibres, "length": length, "segments": segments,
        "vectors": vectors, "inward": inward, "toward": toward, "bend": bend, "curl": curl,
        "turns": turns, "seed": seed, "conditioned": conditioned, "attenuated": attenuated,
        "compensate": compensate, "model": model, "name": name,
    }  # fmt: skip
    coat = _Coat(surface, skin, length, vectors, toward, inward)
    if fibres and not (len(coat.total) and coat.total[-1] > 0):
        raise ValueError(_check.message("surface", "faces of some area", "none"))
    shape = {"segments": segments, "bend": bend, "curl": curl, "turns": turns}
    strands = Strands(
        lambda block: coat.grow(block, fibres, seed, **shape),
        fibres,
        segments + 1,
        np.float64 if any(coat.origin) else np.result_type(skin.points.dtype, np.float32),
        straight=not (bend or curl),
        threads=threads,
    )
    rows, through = strands.rows(), bool(attenuated and density)
    across = conditioned or through
    jobs = [
        Job(
            rows["points"],
            rows["tangents"],
            rows["normals"] if across else None,
            depth=rows["depth"] if through else None,
            repeat=strands.m,
            block=strands.block,
            origin=coat.origin,
            made_on_the_fly=True,
        ),
        Job(
            np.asarray(skin.points),
            None,
            np.asarray(skin.point_data[surfaces.NORMALS]),
            depth=coat.skin_depth(**shape) if through else None,
            own={"model": surface_model(model)},
        ),
    ]
    results, scene = lighting.light(
        jobs,
        scene,
        threads=threads,
        progress_bar=progress_bar,
        compensate=compensate,
        model=model,
        conditioned=conditioned,
        fur=density if through else 0.0,
    )
    if any(coat.origin):
        strands.points += np.array(coat.origin, strands.points.dtype)
    inside = int(np.count_nonzero(strands.inside))
    if inside:
        what = {"flip": "were turned over", "keep": "were kept", "drop": "were left out"}[inward]
        _check.warn(f"{inside} of {fibres} fibres point into the surface and {what}")
        if inward == "drop":
            results[0] = strands.drop(results[0])
    meshes = [strands.mesh(), surface.copy(deep=False)]
    lighting.finish(meshes, results, "fur", scene, told, name)
    return pv.MultiBlock(dict(zip(("fibres", "skin"), meshes, strict=True)))


class _Coat:
    """What fibres are made from: point arrays of a triangulated surface, in float32.

    Points are less ``origin``, which is not 0 where the surface is far from there.
    """

    def __init__(
        self,
        surface: pv.PolyData,
        skin: pv.PolyData,
        length: Any,
        vectors: str | None,
        toward: Any,
        inward: Inward,
    ) -> None:
        self.origin = point_arrays.near_origin(skin)
        size = float(skin.length)
        if not 1e-30 <= size <= 1e30 and skin.n_points:
            remedy = "scale the mesh"
            raise ValueError(_check.message("surface", "a size from 1e-30 to 1e30", size, remedy))
        self.faces: Indices = np.asarray(skin.regular_faces, dtype=np.intp)
        self.normals = np.asarray(skin.point_data[surfaces.NORMALS], dtype=np.float32)
        self.inward = inward
        self.vectors: Array | None = None
        if vectors is not None:
            given = point_arrays.vectors_of(surface, "vectors", vectors, 3)
            lost = len(given) - int(np.count_nonzero(np.all(np.isfinite(given), axis=1)))
            if lost:
                what = "the vectors are not finite: fibres there follow the normals"
                _check.warn(f"{lost} of {len(given)} of {what}")
            self.vectors = unit_rows(given).astype(np.float32)
        self.toward: Array | None = None
        if isinstance(toward, str):
            self.toward = unit_rows(point_arrays.vectors_of(surface, "toward", toward, 3)).astype(
                np.float32
            )
        elif toward is not None:
            direction = _check.vector("toward", toward, direction=True)
            if len(direction) != 3:
                raise ValueError(_check.message("toward", "3 components", len(direction)))
            self.toward = unit_rows(np.array([direction])).astype(np.float32)
        self.length: Array | float = _lengths(surface, length)
        self.total = geometry.areas(np.asarray(skin.points), self.faces)
        # All that is interpolated stands in one table, so that it is looked up once.
        with np.errstate(invalid="ignore"):
            local = np.asarray(skin.points) - np.array(self.origin)
        parts: list[Array] = [local.astype(np.float32), self.normals]
        if self.vectors is not None:
            parts.append(self.vectors)
        if self.toward is not None and len(self.toward) > 1:
            parts.append(self.toward)
        if isinstance(self.length, np.ndarray):
            parts.append(self.length[:, np.newaxis])
        self._table = np.concatenate(parts, axis=1)
        self._cuts = np.cumsum([part.shape[1] for part in parts])[:-1]

    def grow(self, block: slice, count: int, seed: int, **shape: Any) -> Grown:
        """Return some of the fibres."""
        start = block.start // geometry.SEED_BLOCK * geometry.SEED_BLOCK
        part = slice(block.start - start, block.stop - start)
        face, weights = geometry.seed_block(self.total, start, count, seed)
        face, weights = face[part], weights[part]
        corners = self.faces.take(face, axis=0)
        found: Array = self._table.take(corners[:, 0], axis=0)
        found *= weights[:, :1]
        for i in (1, 2):
            corner = self._table.take(corners[:, i], axis=0)
            corner *= weights[:, i : i + 1]
            found += corner
        columns = iter(np.split(np.ascontiguousarray(found.T), self._cuts))
        root, normal = next(columns), kernels.unit(next(columns))[0]
        way, inside = self._ways(normal, None if self.vectors is None else next(columns))
        toward = None if self.toward is None else self.toward.T
        if toward is not None and toward.shape[1] > 1:
            toward = kernels.unit(next(columns))[0]
        length = next(columns)[0] if isinstance(self.length, np.ndarray) else self.length
        phase = None
        if shape["curl"]:
            random = np.random.default_rng([seed, start, 1])
            phase = random.random(part.stop)[part] * 2 * np.pi
        offsets = geometry.strands(way, length, toward=toward, phase=phase, **shape)
        return Grown(root, offsets, way, normal, inside)

    def _ways(self, normal: Array, vector: Array | None) -> tuple[Array, Bools | None]:
        """Return unit directions at the root, and which of the vectors point into the surface."""
        if vector is None:
            return normal, None
        way, size = kernels.unit(vector)
        way = np.where(size > 0, way, normal)
        inside = kernels.dot(way, normal) < 0
        if self.inward == "flip":
            way[:, inside] *= -1
        return way, inside

    def skin_depth(self, **shape: Any) -> Array:
        """Return the height of a fibre that stood on each point of the skin."""
        normal = kernels.unit(np.ascontiguousarray(self.normals.T))[0]
        way, inside = self._ways(normal, None if self.vectors is None else self.vectors.T)
        toward = None if self.toward is None else self.toward.T
        offsets = geometry.strands(way, self.length, toward=toward, **shape)
        height: Array = np.einsum("jib,ib->jb", offsets, normal).max(axis=0)
        if self.inward == "drop" and inside is not None:
            height[inside] = 0
        return height


def _lengths(mesh: pv.PolyData, length: Any) -> Array | float:
    if isinstance(length, str):
        if length not in mesh.point_data or mesh.point_data[length].ndim != 1:
            there = [key for key in mesh.point_data if mesh.point_data[key].ndim == 1]
            raise ValueError(
                _check.message(
                    "length",
                    f"a point array of one component, {_check.one_of(there)}",
                    repr(length),
                )
            )
        length = mesh.point_data[length]
    if not isinstance(length, np.ndarray):
        length = _check.floats("length", length)
    if length.ndim == 0:
        return _check.number("length", length, low=0.0, high=LONGEST)
    array = _check.floats("length", length)
    if array.shape != (mesh.n_points,) or not np.all((array >= 0) & (array <= LONGEST)):
        raise ValueError(
            _check.message(
                "length", f"{mesh.n_points} lengths of 0 or more", _check.describe(array)
            )
        )
    return array.astype(np.float32, copy=False)
