"""Fur: fibres that stand on a surface, lit, shadowed and attenuated, and the skin below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import pyvista as pv

from vizlight import _check, _pool, engine
from vizlight.filters import _mesh, _progress, _provenance, _surface
from vizlight.filters._illuminate import attach, refuse_overwriting, warn_unlit
from vizlight.filters._mesh import unit_rows
from vizlight.filters._strands import Strands
from vizlight.geometry import fur as geometry
from vizlight.plan import surface_model
from vizlight.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.floating[Any]]

Inward = Literal["keep", "flip", "drop"]
#: Points that the engine lights at once: its buffers stay small beside the fibres.
LIT_AT_ONCE = 3 << 15


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
        A point array of 3 components along which fibres grow; default the normals, also where
        a vector is zero.
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
        ``fibres``: lines from root to tip, in float32. ``skin``: the surface, lit by its
        normals and attenuated by the fur that stands on it. Both with the point array
        ``luminance``, and ``rgb`` where the scene has a colour.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit: a negative length, a density outside [0, 1], no faces.

    Warns
    -----
    UserWarning
        Once, with the count, if vectors point into the surface, and if points could not be lit.

    Notes
    -----
    The height of fur above a point is how far, across the surface at the root, the fibre's
    highest point stands above it. Sources: Banks 4.2, 5, (7), (8).
    """
    density = _check.number("density", density, low=0.0, high=1.0)
    fibres = _check.integer("fibres", fibres, low=0)
    segments = _check.integer("segments", segments, low=1)
    if inward not in get_args(Inward):
        raise ValueError(_check.message("inward", "'keep', 'flip' or 'drop'", repr(inward)))
    for option, value in (("bend", bend), ("curl", curl), ("turns", turns)):
        _check.number(option, value)
    if bend and toward is None:
        raise ValueError(_check.message("toward", "what fibres bend to, with bend=", None))
    _check.instance("scene", scene, Scene)
    skin = _surface.with_normals(surface, scene.view)
    refuse_overwriting([(surface, "")], name, components=False, colored=scene.colored)
    coat = _Coat(skin, length, vectors, toward, inward)
    strands, inside = _grow(
        coat, fibres, segments, seed, threads, bend=bend, curl=curl, turns=turns
    )
    if inside:
        what = {"flip": "were turned over", "keep": "were kept", "drop": "were left out"}[inward]
        _check.warn(f"{inside} of {fibres} fibres point into the surface and {what}")

    through = {"fur": density} if attenuated and density else {}
    shared: dict[str, Any] = {"compensate": compensate, "model": model, **through}
    told = {
        "density": density, "fibres": fibres, "length": length, "segments": segments,
        "vectors": vectors, "inward": inward, "toward": toward, "bend": bend, "curl": curl,
        "turns": turns, "seed": seed, "conditioned": conditioned, "attenuated": attenuated,
        "compensate": compensate, "model": model, "name": name,
    }  # fmt: skip
    normals = strands.normals() if conditioned or through else None
    with _progress.progress("light fur", strands.n_points, show=progress_bar) as report:
        lit = engine.shade(
            strands.points.reshape(-1, 3),
            strands.tangents(),
            scene,
            normals=normals,
            depth=strands.depth() if through else None,
            conditioned=conditioned,
            threads=threads,
            block=LIT_AT_ONCE,
            progress=lambda done, _: report(done),
            **shared,
        )
    lines, unlit = strands.mesh(), lit.invalid
    attach(lines, lit, name, _provenance.record(lit, "fur", scene, told))
    shared["model"] = surface_model(model)
    below = coat.skin_depth(segments, bend=bend, curl=curl, turns=turns) if through else None
    lit = engine.shade(
        np.asarray(skin.points),
        None,
        scene,
        normals=np.asarray(skin.point_data["Normals"]),
        depth=below,
        threads=threads,
        **shared,
    )
    warn_unlit(unlit + lit.invalid, lines.n_points + skin.n_points, name)
    skin = surface.copy(deep=False)
    attach(skin, lit, name, _provenance.record(lit, "fur", scene, told))
    return pv.MultiBlock({"fibres": lines, "skin": skin})


class _Coat:
    """What fibres are made from: point arrays of a triangulated surface, in float32."""

    def __init__(
        self, skin: pv.PolyData, length: Any, vectors: str | None, toward: Any, inward: Inward
    ) -> None:
        self.points = np.asarray(skin.points, dtype=np.float32)
        self.faces: NDArray[np.intp] = np.asarray(skin.regular_faces, dtype=np.intp)
        self.normals = np.asarray(skin.point_data["Normals"], dtype=np.float32)
        self.inward = inward
        self.vectors: Array | None = None
        if vectors is not None:
            self.vectors = _mesh.vectors_of(skin, "vectors", vectors, 3).astype(
                np.float32, copy=False
            )
        self.toward: Array | None = None
        if isinstance(toward, str):
            self.toward = unit_rows(
                _mesh.vectors_of(skin, "toward", toward, 3).astype(np.float32, copy=False)
            )
        elif toward is not None:
            direction = _check.vector("toward", toward, direction=True)
            if len(direction) != 3:
                raise ValueError(_check.message("toward", "3 components", len(direction)))
            self.toward = unit_rows(np.array([direction], dtype=np.float32))
        self.length: Array | float = _lengths(skin, length)
        self.total = geometry.areas(np.asarray(skin.points), self.faces)
        # All that is interpolated stands in one table, so that it is looked up once.
        parts = [self.points, self.normals]
        if self.vectors is not None:
            parts.append(self.vectors)
        if self.toward is not None and len(self.toward) > 1:
            parts.append(self.toward)
        if isinstance(self.length, np.ndarray):
            parts.append(self.length[:, np.newaxis])
        self._table = np.concatenate(parts, axis=1)
        self._cuts = np.cumsum([part.shape[1] for part in parts])[:-1]

    def roots(self, block: slice, count: int, seed: int) -> tuple[Any, ...]:
        """Return roots, unit normals, directions, lengths and bends of some fibres, and ``inside``.

        ``inside`` marks fibres whose vector points into the surface.
        """
        face, weights = geometry.seed_block(self.total, block, count, seed)
        corners = self.faces.take(face, axis=0)
        found: Array = self._table.take(corners[:, 0], axis=0)
        found *= weights[:, :1]
        for i in (1, 2):
            part = self._table.take(corners[:, i], axis=0)
            part *= weights[:, i : i + 1]
            found += part
        columns = iter(np.split(found, self._cuts, axis=1))
        root, normal = next(columns), unit_rows(next(columns))
        vector = None if self.vectors is None else next(columns)
        toward, length = self.toward, self.length
        if toward is not None:
            toward = unit_rows(next(columns)) if len(toward) > 1 else toward
        if isinstance(length, np.ndarray):
            length = next(columns)[:, 0]
        return root, normal, *self._directions(normal, vector), length, toward

    def _directions(self, normal: Array, vector: Array | None) -> tuple[Array, Any]:
        if vector is None:
            return normal, None
        direction = unit_rows(vector)
        lost = ~np.any(direction, axis=1)
        direction[lost] = normal[lost]
        inside = np.einsum("ij,ij->i", direction, normal) < 0
        if self.inward == "flip":
            direction[inside] *= -1
        return direction, inside

    def skin_depth(self, segments: int, **shape: Any) -> Array:
        """Return the height of a fibre that stood on each point of the skin."""
        direction, inside = self._directions(self.normals, self.vectors)
        toward = self.toward
        strand = geometry.grow(
            np.zeros_like(self.points), direction, self.length, segments=segments, toward=toward,
            **shape,
        )  # fmt: skip
        height = np.einsum("ijk,ik->ij", strand, self.normals).max(axis=1)
        if self.inward == "drop" and inside is not None:
            height[inside] = 0
        depth: Array = np.maximum(height, 0)
        return depth


def _grow(
    coat: _Coat, count: int, segments: int, seed: int, threads: int | None, **shape: Any
) -> tuple[Strands, int]:
    """Return the fibres, and how many point into the surface."""
    if count and not (len(coat.total) and coat.total[-1] > 0):
        raise ValueError(_check.message("surface", "faces of some area", "none"))
    points = np.empty((count, segments + 1, 3), np.float32)
    normals = np.empty((count, 3), np.float32)
    inside = np.zeros(count, np.bool_)

    def work(block: slice) -> int:
        root, normal, direction, into, length, toward = coat.roots(block, count, seed)
        phase = None
        if shape["curl"]:
            phase = np.random.default_rng([seed, block.start, 1]).random(len(root)) * 2 * np.pi
        geometry.grow(
            root, direction, length, segments=segments, toward=toward, phase=phase,
            out=points[block], **shape,
        )  # fmt: skip
        normals[block] = normal
        if into is not None:
            inside[block] = into
        return int(block.stop)

    for _ in _pool.run(work, _pool.blocks(count, geometry.SEED_BLOCK), threads):
        pass
    found = int(np.count_nonzero(inside))
    if coat.inward == "drop" and found:
        points, normals = points[~inside], normals[~inside]
    straight = not (shape["bend"] or shape["curl"])
    return Strands(points, normals, straight=straight), found


def _lengths(mesh: pv.PolyData, length: Any) -> Array | float:
    if isinstance(length, str):
        if length not in mesh.point_data or mesh.point_data[length].ndim != 1:
            there = [key for key in mesh.point_data if mesh.point_data[key].ndim == 1]
            raise ValueError(
                _check.message(
                    "length", f"a point array of one component, one of {there}", repr(length)
                )
            )
        length = mesh.point_data[length]
    if np.ndim(length) == 0:
        return _check.number("length", length, low=0.0)
    array = _check.floats("length", length)
    if array.shape != (mesh.n_points,) or not np.all((array >= 0) & np.isfinite(array)):
        raise ValueError(
            _check.message(
                "length", f"{mesh.n_points} lengths of 0 or more", _check.describe(array)
            )
        )
    return array.astype(np.float32, copy=False)
