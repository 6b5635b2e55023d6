"""Segments and triangles split only where light bends, until interpolation is right enough."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Bools, Indices
from vizlight.mesh import normals, records, subdivision
from vizlight.mesh.subdivision import SplitCells
from vizlight.scene import Scene
from vizlight.shading import engine
from vizlight.shading.engine import Shading
from vizlight.shading.inputs import ArraySource
from vizlight.shading.options import LightOptions
from vizlight.verify.between import Between, Places, columns, error_between, random_places
from vizlight.vtk.cells import field_data, has_faces
from vizlight.vtk.parts import Part

#: Number of points that a refined mesh may have by default, if it has not half of them already.
MANY = 1_000_000
#: End of the name of the field array with the error that is left.
LEFT = "_error"
#: Share of the places with too large an error above which a warning is given.
WARNED = 5e-3

#: Shares of an edge, and weights of the corners of a triangle, at which the error is measured.
ALONG = (0.25, 0.5, 0.75)
WITHIN = np.array([[1 / 3, 1 / 3, 1 / 3], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]])
#: Number of random places at which the result is measured.
CHECKS = 4096
#: Largest number of rounds; each may halve every edge.
ROUNDS = 40
#: Share of the diagonal of the bounding box below which an edge is not split: the share of a pixel
#: in a large picture, to which a jump of the light is thus confined.
SHORTEST = 1 / 4096
#: Share of the allowed error that chosen places must keep: between them it may be larger.
KEPT = 0.9
#: Shares of an edge between which it is split.
NEAREST = 0.2


class Left(NamedTuple):
    """Errors that refinement leaves.

    ``error`` is the largest at 4,096 random places between the points, uniform in area or length,
    and ``share`` that of those places with more than the error allowed; ``enough`` is whether the
    point budget was sufficient.
    """

    error: float
    share: float
    enough: bool


class Refined(NamedTuple):
    """A refined mesh, the inputs of its light, and the error that is left."""

    mesh: pv.PolyData
    part: Part
    left: Left


def refined(
    mesh: pv.DataSet, path: str, part: Part, scene: Scene, error: float, most: int | None
) -> Refined:
    """Return a mesh with its segments or triangles split where light bends.

    The mesh, of faces or lines, is not changed; ``path`` is its own in a MultiBlock, for an error,
    a depth cue of the scene has both ends, and ``most`` is the largest number of points.
    """
    with _check.in_block(path):
        flat = subdivision.as_polydata(mesh)
    origin: Indices | None = None
    if has_faces(flat):
        parents, origin = subdivision.triangles(flat)
    else:
        parents = subdivision.simplices(flat)
    inputs, options, count = part.inputs, part.options, mesh.n_points
    shading = engine.run(inputs, scene, options)
    between = Between(inputs, scene, options)
    most = max(MANY, 2 * count) if most is None else most
    cells, left = refine(between, shading, parents, error, most)
    new_rows = _named(flat, between, options)
    positions = options.positions if isinstance(options.positions, str) else None
    split_mesh = subdivision.rebuilt(flat, cells, origin, new_rows, places=positions)
    records.carry(mesh, split_mesh)
    extended = _extended(part, between, cells.corners)
    # Taken from the refined line, tangents would be those of its straight segments.
    if origin is None and options.tangents is None and extended.inputs.tangents is not None:
        tangents = np.asarray(extended.inputs.tangents[:])
        records.keep(split_mesh, subdivision.TANGENTS, "refine", tangents)
    # So would normals be those of the flat triangles.
    if extended.sided is not None:
        normals.keep(split_mesh, extended.sided, fewest=1)
    return Refined(split_mesh, extended, left)


def _named(mesh: pv.PolyData, between: Between, options: LightOptions) -> dict[str, Array]:
    """Return the vectors of new points by the names of the point arrays that they belong to."""
    active = mesh.point_data.active_normals_name
    named = {
        "normals": active if options.normals is None else options.normals,
        "tangents": options.tangents,
        "base_tangents": options.conditioned,
    }
    new_rows = {}
    for name, key in named.items():
        if name in between.vectors and isinstance(key, str) and key in mesh.point_data:
            rows = between.rows(name).reshape(len(between.points), -1)
            rows = between.scales.get(name, 1.0) * rows
            old_rows = np.asarray(mesh.point_data[key], dtype=np.float64)
            with np.errstate(invalid="ignore", over="ignore"):
                along = rows[: len(old_rows)] * old_rows
            if name == "normals" and np.sum(along, where=np.isfinite(along)) < 0:
                # Outward normals of a mesh whose own point inward.
                rows = -rows
            new_rows[key] = rows[len(old_rows) :]
    return new_rows


def _extended(part: Part, between: Between, corners: Indices) -> Part:
    """Return the inputs of the light of a mesh, with the new points."""
    inputs, sided = part.inputs, part.sided
    count = inputs.count
    arrays: dict[str, ArraySource] = {"points": _joined(inputs.points, between.points[count:])}
    for name in between.vectors:
        rows = between.rows(name)
        added = rows[count:].reshape(len(rows) - count, rows[0].size if count else 0)
        if name == "normals":
            added = between.turned(added, between.facts[count:], between.points[count:])
        arrays[name] = _joined(getattr(inputs, name), between.scales.get(name, 1.0) * added)
    if inputs.dimensions is not None and inputs.tangents is not None:
        # New points are on faces; vectors that a point is not lit by have any direction.
        new = np.ones((len(between.points) - count, 3))
        arrays["tangents"] = _joined(inputs.tangents, new)
        arrays["dimensions"] = _joined(inputs.dimensions, 2 * new[:, :1]).ravel()
    sides = inputs.sides and inputs.sides()
    if sided is not None and sides is not None:
        facts = between.facts
        vectors = _joined(sided.vectors, between.rows("normals")[count:, 0])
        sides = sides._replace(normals=vectors, facts=facts)
        lean = None if sided.lean is None else facts[:, 0].astype(np.float32)
        sided = dataclasses.replace(
            sided, vectors=vectors, lean=lean, open=np.rint(facts[:, 1]).astype(np.intp), kept=False
        )
    extended = dataclasses.replace(
        inputs,
        **arrays,  # type: ignore[arg-type]
        cells=lambda: corners,
        sides=None if sides is None else lambda: sides,
    )
    return part._replace(inputs=extended, sided=sided)


def _joined(rows: ArraySource, added: Array) -> Array:
    """Return rows with further ones, in the type of the first."""
    first_rows = np.asarray(rows[:])
    first_rows = first_rows.reshape(len(first_rows), -1)
    kind = first_rows.dtype if first_rows.dtype.kind == "f" else np.dtype(np.float64)
    return np.concatenate([first_rows.astype(kind), added.astype(kind)])


def forget(mesh: pv.DataSet, name: str) -> None:
    """Remove the error of an earlier refinement, which new light does not have."""
    there = field_data(mesh).HasArray(name + LEFT)
    if there and records.read(mesh, name) is not None:
        del mesh.field_data[name + LEFT]


def warn_of_rest(results: Sequence[Refined], error: float) -> None:
    """Warn once if errors are left at more than 0.5 % of the places, or the budget is spent."""
    worst = max((result.left.error for result in results), default=0.0)
    share = max((result.left.share for result in results), default=0.0)
    what = (
        f"{100 * share:.2g} % of the places are off by more than {error:.3g}, by up to {worst:.3g}"
    )
    if not all(result.left.enough for result in results):
        used = max(result.mesh.n_points for result in results if not result.left.enough)
        remedy = "allow a larger error, or call vizlight.refine with a larger max_points"
        _check.warn(f"refined to {used} points, where the budget ends: {what}; {remedy}")
    elif share > WARNED:
        _check.warn(
            f"{what}: the light jumps there, and no edge shorter than 1/4096 of the mesh is split"
        )


def refine(
    between: Between, shading: Shading, parents: Indices, error: float, most: int
) -> tuple[SplitCells, Left]:
    """Split cells until interpolated light is within an error of the light between the points.

    ``parents`` (P, s) are segments, s = 2, or triangles, s = 3; ``most`` is the largest number of
    points.
    """
    work = _Refinement(between, shading, parents, error, most)
    fresh = np.arange(len(parents))
    with np.errstate(all="ignore"):
        for _ in range(ROUNDS):
            fresh = work.round(fresh)
            if not len(fresh):
                break
    return work.cells, work.left()


class _Refinement:
    """Cells with the light of their corners, and the errors that were measured on their parts."""

    def __init__(
        self, between: Between, shading: Shading, parents: Indices, error: float, most: int
    ) -> None:
        self.between, self.error, self.most = between, error, most
        self.cells, self.count = SplitCells(between.points, parents), len(between.points)
        self.light = columns(shading)
        # A point without light, as in a hole, has nothing to be compared with.
        good = shading.valid & np.isfinite(between.points).all(axis=1)
        #: Cells of the mesh between whose points there is light to compare.
        self.measured: Bools = np.asarray(good[parents].all(axis=1))
        extent = between.points[good]
        self.shortest = SHORTEST * math.hypot(*np.ptp(extent, axis=0)) if len(extent) else 0.0
        #: Whether the budget was sufficient.
        self.enough = True
        #: Errors at random places of the present parts.
        self.checked: Array | None = None
        self.random = np.random.default_rng(0)

    def round(self, fresh: Indices) -> Indices:
        """Measure parts, split those that are not right enough, and return the new parts."""
        codes, share, wrong = self._worst_edges(fresh)
        inside = self._worst_inside(fresh)
        bad = inside > KEPT * self.error
        # Only once all chosen places are right random ones are looked at: they find errors between.
        if not len(codes) and not bad.any():
            cell, miss = self._at_random()
            # The worst place of each part comes first.
            order = np.lexsort((-miss, cell))
            fresh, first = np.unique(cell[order], return_index=True)
            inside = miss[order][first]
            bad = inside > self.error
        codes, share, wrong = self._with_inside(codes, share, wrong, fresh[bad], inside[bad])
        room = max(self.most - len(self.between.points), 0)
        if len(codes) > room:
            self.enough = False
            # The largest errors have what is left of the budget; numbers of edges must stay sorted.
            worst = np.sort(np.argsort(-wrong, kind="stable")[:room])
            codes, share = codes[worst], share[worst]
        if not len(codes):
            return codes
        # Errors at random places were those of the parts before.
        self.checked = None
        new_parts = self.cells.split(codes, share)
        added = self.cells.steps[-1]
        self.light = np.concatenate([self.light, self.between.light(added)])
        self.between.extend(added)
        # With the budget spent no part is split again: there is nothing to measure them for.
        return new_parts if self.enough else new_parts[:0]

    def left(self) -> Left:
        """Return the errors that are left."""
        # Where the last round split nothing, its random places tell what is left.
        wrong = self._at_random()[1] if self.checked is None else self.checked
        share = float(np.mean(wrong > self.error)) if len(wrong) else 0.0
        return Left(float(wrong.max(initial=0)), share, self.enough)

    def _miss(self, cells: Indices, weights: Array) -> Array:
        """Return the error at one place of each part."""
        places = Places(self.cells.corners[cells], weights)
        return error_between(self.between, self.light, places)

    def _worst_edges(self, fresh: Indices) -> tuple[Indices, Array, Array]:
        """Return the edges of parts to be split, the place where each errs most, and its error."""
        size = self.cells.size
        fresh = fresh[self._seen(fresh)]
        codes, reverse = self.cells.edges(fresh)
        edges, first = np.unique(codes, return_index=True)
        cell, side = np.divmod(first, codes.shape[1])
        cell, back = fresh[cell], reverse.ravel()[first]
        rank, after = np.arange(len(edges)), (side + 1) % size
        # Weights of three corners for a place on an edge: the third corner has none.
        ends = np.zeros((len(edges), 2, size))
        ends[rank, 0, side] = 1
        ends[rank, 1, after] = 1
        tried = [np.full(len(edges), t) for t in ALONG]
        between = self.cells.corners[cell, side], self.cells.corners[cell, after]
        tried += [weights[:, 1] for weights in self.between.peaks(np.stack(between, axis=1))]
        best, worst = np.full(len(edges), 0.5), np.zeros(len(edges))
        for t in tried:
            weights = (1 - t)[:, np.newaxis] * ends[:, 0] + t[:, np.newaxis] * ends[:, 1]
            miss = self._miss(cell, weights)
            better = miss > worst
            best, worst = np.where(better, t, best), np.where(better, miss, worst)
        # Off the ends, or the parts would be slivers.
        best = np.clip(best, NEAREST, 1 - NEAREST)
        # Shares count from the end of the smaller number, whichever way this part has the edge.
        best = np.where(back, 1 - best, best)
        chosen = (worst > KEPT * self.error) & self._long(cell, side)
        return edges[chosen], best[chosen], worst[chosen]

    def _seen(self, cells: Indices) -> Bools:
        """Return whether parts have light to compare, and are not narrower than any edge split."""
        good = self.measured[self.cells.parent[cells]]
        if self.cells.size == 2:
            return good
        a, b, c = (self.between.points[self.cells.corners[cells, i]] for i in range(3))
        u, v, w = b - a, c - a, c - b
        uu, vv, ww, uv = (np.einsum("ij,ij->i", x, y) for x, y in ((u, u), (v, v), (w, w), (u, v)))
        # Square of the height over the longest side: Lagrange's identity gives that of twice the
        # area.
        height = (uu * vv - uv * uv) / np.maximum(np.maximum(uu, vv), ww)
        return np.asarray(good & (height > self.shortest * self.shortest))

    def _long(self, cell: Indices, side: Indices) -> Bools:
        """Return whether edges are long enough to be split."""
        after = (side + 1) % self.cells.size
        a, b = (self.between.points[self.cells.corners[cell, at]] for at in (side, after))
        return np.asarray(np.linalg.norm(a - b, axis=1) > self.shortest)

    def _worst_inside(self, fresh: Indices) -> Array:
        """Return the largest error within each part, 0 for segments."""
        worst = np.zeros(len(fresh))
        if self.cells.size == 2:
            return worst
        good = self._seen(fresh)
        cells = fresh[good]
        tried = [np.broadcast_to(w, (len(cells), 3)) for w in WITHIN]
        tried += self.between.peaks(self.cells.corners[cells])
        for weights in tried:
            worst[good] = np.maximum(worst[good], self._miss(cells, weights))
        return worst

    def _with_inside(
        self, codes: Indices, share: Array, wrong: Array, cells: Indices, inside: Array
    ) -> tuple[Indices, Array, Array]:
        """Add the edges of parts that are wrong inside but have no wrong edge."""
        edges, _ = self.cells.edges(cells)
        # Where one of its edges is split anyway, a part is not cut further before it is measured
        # anew.
        free = ~np.isin(edges, codes).any(axis=1)
        free &= self._seen(cells)
        cells, edges, inside = cells[free], edges[free], inside[free]
        if not len(cells):
            return codes, share, wrong
        sides = edges.shape[1]
        long = self._long(np.repeat(cells, sides), np.tile(np.arange(sides), len(cells)))
        added, place = np.unique(edges.ravel()[long], return_inverse=True)
        most = np.zeros(len(added))
        np.maximum.at(most, place.reshape(-1), np.repeat(inside, sides)[long])
        codes, share = (
            np.concatenate([codes, added]),
            np.concatenate([share, np.full(len(added), 0.5)]),
        )
        # Edges must be sorted by number for the split.
        order = np.argsort(codes)
        return codes[order], share[order], np.concatenate([wrong, most])[order]

    def _at_random(self) -> tuple[Indices, Array]:
        """Return the parts at random places, and the errors of the places."""
        cells = np.flatnonzero(self.measured[self.cells.parent])
        corners = self.cells.corners[cells]
        places, cell = random_places(self.between.points, corners, CHECKS, self.random)
        self.checked = self._miss(cells[cell], places.weights)
        return cells[cell], self.checked
