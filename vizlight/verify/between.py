"""Light between the points of a mesh, and the error of interpolating the light at the points.

The reference is the light of interpolated vectors, as a fragment shader computes it: normals and
tangents are interpolated linearly over a segment or a triangle, as VTK interpolates any array,
normalised and lit. Only tangents that stand for lines without sign are turned alike before.
"""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from vizlight import _pool
from vizlight._types import Array, Indices, Rows
from vizlight.model import kernels
from vizlight.model.frames import orthonormalize
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.shading.engine import Shading
from vizlight.shading.inputs import ArraySource, ShadingInputs
from vizlight.shading.options import ShadingOptions

#: Number of places that are lit at once.
BLOCK = 1 << 17
#: Largest deviation of the length of unit vectors from 1.
UNIT = 1e-3


class Places(NamedTuple):
    """Places on segments or triangles.

    Corners (M, s) are the ends of a segment, s = 2, or those of a triangle, s = 3; weights are 0 or
    more with sum 1.
    """

    corners: Indices
    weights: Array


def measurable(inputs: ShadingInputs) -> bool:
    """Return whether light between the points follows from the inputs at the points."""
    # Inputs of the points alone, such as their share of a shadow, are not known between them.
    plain = inputs.shadow is None and inputs.fur_height is None
    plain = plain and inputs.transmittance is None and inputs.occlusion is None
    return plain and inputs.repeat == 1


class Between:
    """Points and vectors of a mesh, to be interpolated and lit.

    The inputs are such that :func:`measurable` holds, a depth cue of the scene has both ends, and
    places are lit in float64. ``vectors`` are unit ``normals``, ``tangents`` and ``base_tangents``
    (N, k, n), if the inputs have them; at points that were added they are as interpolation leaves
    them, shorter than the others, so that parts of a cell interpolate to the same directions as the
    cell; see :meth:`rows`. ``scales`` are factors by which tangents have been divided.
    """

    def __init__(self, inputs: ShadingInputs, scene: Scene, options: ShadingOptions) -> None:
        inputs = inputs.of_faces()
        self.inputs, self.scene = inputs, scene
        self.options = dataclasses.replace(options, precision="float64", components=False)
        n = int(inputs.points.shape[1])
        self.points = _rows(inputs.points)
        self.vectors: dict[str, Array] = {}
        self._sides = None if inputs.sides is None else inputs.sides()
        self.facts: Array = np.empty((len(self.points), 0))
        if inputs.normals is not None:
            normals: ArraySource = inputs.normals
            # Normals are interpolated before they are turned, as the side that is seen may change
            # within a cell.
            if self._sides is not None:
                normals, self.facts = self._sides.normals, self._sides.facts
            self.vectors["normals"] = kernels.unit_rows(_rows(normals))[:, np.newaxis]
        self._unit = set(self.vectors)
        self.scales: dict[str, float] = {}
        for name in ("tangents", "base_tangents"):
            rows: ArraySource | None = getattr(inputs, name)
            if rows is not None:
                frames, self.scales[name] = _frames(rows, n)
                self.vectors[name] = frames
                if frames.shape[1] == 1 and are_unit(frames[:, 0]):
                    self._unit.add(name)

    def interpolated_at(self, places: Places) -> tuple[Array, dict[str, Array], Array]:
        """Return the points, the vectors and the facts on which sides depend, at places."""
        points, vectors, facts = self._interpolated(places)
        for name in self._unit & vectors.keys():
            vectors[name] = kernels.unit_rows(vectors[name][:, 0])[:, np.newaxis]
        return points, vectors, facts

    def _interpolated(self, places: Places) -> tuple[Array, dict[str, Array], Array]:
        vectors: dict[str, Array] = {}
        for name, rows in self.vectors.items():
            mean = mean_spaces if self._unsigned(name) else interpolated
            vectors[name] = mean(rows, places)
        return interpolated(self.points, places), vectors, interpolated(self.facts, places)

    def _unsigned(self, name: str) -> bool:
        """Return whether vectors stand for lines or spaces, on which no sign depends."""
        if name == "tangents":
            return self.inputs.line_field or self.vectors[name].shape[1] > 1
        return name == "base_tangents"

    def rows(self, name: str) -> Array:
        """Return vectors of all points, of length 1 where the mesh's are."""
        rows = self.vectors[name]
        return kernels.unit_rows(rows[:, 0])[:, np.newaxis] if name in self._unit else rows

    def turned(self, normals: Array, facts: Array, points: Array) -> Array:
        """Return normals, shape (M, n), turned to the side of the surface that is seen."""
        return normals if self._sides is None else self._sides.turned(normals, facts, points)

    def extend(self, places: Places) -> None:
        """Add points at places, after the present ones."""
        points, vectors, facts = self._interpolated(places)
        self.points = np.concatenate([self.points, points])
        self.facts = np.concatenate([self.facts, facts])
        for name, rows in vectors.items():
            self.vectors[name] = np.concatenate([self.vectors[name], rows])

    def light(self, places: Places) -> Array:
        """Return luminance and colour at places, shape (M, 1) or (M, 4)."""
        count = len(places.weights)
        values = np.empty((count, 4 if self.scene.colored else 1))
        for block in _pool.blocks(count, BLOCK):
            part = Places(places.corners[block], places.weights[block])
            points, vectors, facts = self.interpolated_at(part)
            arrays: dict[str, ArraySource] = {
                name: rows.reshape(len(rows), -1) for name, rows in vectors.items()
            }
            if "normals" in vectors:
                arrays["normals"] = self.turned(vectors["normals"][:, 0], facts, points)
            arrays["points"] = points
            inputs = dataclasses.replace(self.inputs, **arrays)  # type: ignore[arg-type]
            values[block] = columns(engine.run(inputs, self.scene, self.options))
        return values

    def peaks(self, cells: Indices) -> list[Array]:
        """Return the places in cells where each light's highlight may peak, as weights of corners.

        One place (M, s) per cell is returned for each light, none where no closed form gives them.
        """
        material, view = self.scene.material, self.scene.view
        lines = "tangents" in self.vectors and self.vectors["tangents"].shape[1] == 1
        surface = "tangents" not in self.vectors and self.points.shape[1] == 3
        if not material.specular or view is None or not (lines or surface):
            return []
        # The points are less an origin, and lights and eye are moved likewise.
        moved = self.inputs.origin
        scene = self.scene if moved is None else self.scene.moved([-x for x in moved])
        rows = self.points[cells]
        if lines:
            vectors = self.vectors["tangents"][cells, 0]
        else:
            at = cells.ravel()
            normals = self.vectors["normals"][at, 0]
            turned = self.turned(kernels.unit_rows(normals), self.facts[at], self.points[at])
            # The lengths stay: normals of added points are shorter, and the weights depend on that.
            length = np.linalg.norm(normals, axis=1, keepdims=True)
            vectors = (length * turned).reshape(rows.shape)
        if lines and self.inputs.line_field:
            # Signs mean nothing: all are turned as the first.
            with_first = np.einsum("msn,mn->ms", vectors, vectors[:, 0])
            vectors = np.where(with_first < 0, -1.0, 1.0)[..., np.newaxis] * vectors
        solve = _across if lines else _toward_half
        peak_weights = []
        for light in scene.lights:
            if light.intensity > 0:
                weights = np.full(cells.shape, 1 / cells.shape[1])
                # From near lights and eyes the half vector depends on the place: first it is that
                # of the centre, then of the place found there.
                for _ in range(2):
                    middle = np.einsum("ms,msn->mn", weights, rows)
                    # The sum of both unit directions; its length is of no account.
                    half = _toward(light.seen_from(view), middle) + _toward(view, middle)
                    weights = solve(vectors, half)
                peak_weights.append(weights)
        return peak_weights


def interpolated(rows: Array, places: Places) -> Array:
    """Return weighted means of rows at places."""
    weights = places.weights.reshape(*places.weights.shape, *[1] * (rows.ndim - 1))
    total = weights[:, 0] * rows[places.corners[:, 0]]
    for i in range(1, places.weights.shape[1]):
        total += weights[:, i] * rows[places.corners[:, i]]
    return np.asarray(total)


def mean_spaces(frames: Array, places: Places) -> Array:
    """Return the spaces that frames span, interpolated at places, as frames.

    For one vector, signs are chosen so that the mean is as long as possible; given signs do not
    matter. Where they agree this is the plain mean. For several vectors, the projections on the
    spaces are averaged, and the result is the space of the k largest eigenvalues of that average,
    which depends on no basis. Frames (N, k, n) have one vector of any length, or several
    orthonormal ones.
    """
    _, k, n = frames.shape
    m, s = places.weights.shape
    if k > 1:
        spaces = np.empty((m, k, n))
        for block in _pool.blocks(m, BLOCK >> 2):
            rows = frames[places.corners[block]]
            square = np.einsum("ms,mskn,mskl->mnl", places.weights[block], rows, rows)
            # The eigenvectors of the k largest eigenvalues, which stand last.
            spaces[block] = np.linalg.eigh(square)[1][:, :, n - k :].swapaxes(1, 2)
        return spaces
    parts = [places.weights[:, i : i + 1] * frames[places.corners[:, i], 0] for i in range(s)]
    if s == 2:
        # Of two vectors the second is turned over where they point apart.
        turned = [np.ones(m), np.where(_dots(*parts) < 0, -1.0, 1.0)]
    else:
        a, b, c = parts
        ab, ac, bc = _dots(a, b), _dots(a, c), _dots(b, c)
        # Up to a common sign there are four choices, and the longest sum has the largest sum of
        # products.
        scores = np.stack([ab + ac + bc, ab - ac - bc, ac - ab - bc, bc - ab - ac])
        best = np.argmax(scores, axis=0)
        signs = np.array([[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]], dtype=np.float64)
        turned = list(signs[best].T)
    total = sum(part * sign[:, np.newaxis] for part, sign in zip(parts, turned, strict=True))
    return np.asarray(total)[:, np.newaxis]


def columns(shading: Shading, rows: Rows = slice(None)) -> Array:
    """Return luminance and colour of points, shape (N, 1) or (N, 4)."""
    light = shading.luminance[rows, np.newaxis]
    values = light if shading.rgb is None else np.hstack([light, shading.rgb[rows]])
    return np.asarray(values, dtype=np.float64)


def random_places(
    points: Array, cells: Indices, count: int, random: np.random.Generator
) -> tuple[Places, Indices]:
    """Return places in cells, uniform in area or length, and the cell of each.

    Cells (M, s) are segments or triangles; without an area they have no places.
    """
    s = cells.shape[1]
    # In units of the extent squares of lengths neither overflow nor vanish.
    unit = float(np.ptp(points, axis=0).max(initial=0)) or 1.0
    with np.errstate(invalid="ignore"):  # at points that are infinite
        sides = [(points[cells[:, i]] - points[cells[:, 0]]) / unit for i in range(1, s)]
    square = _dots(sides[0], sides[0])
    if s == 3:
        # |a|^2 |b|^2 - (a . b)^2 is the squared area of the parallelogram, in a space of any
        # dimension.
        square = square * _dots(sides[1], sides[1]) - _dots(*sides) ** 2
    total = np.cumsum(np.sqrt(np.maximum(np.nan_to_num(square), 0)))
    # Cells of no area, or of one that is not finite, have no places.
    if not (len(total) and 0 < total[-1] < np.inf):
        return Places(cells[:0], np.empty((0, s))), np.empty(0, np.intp)
    # One place in each of as many equal parts of the area.
    at = (np.arange(count) + random.random(count)) / count * total[-1]
    cell = np.minimum(np.searchsorted(total, at, side="right"), len(cells) - 1)
    # With ones for all corners Dirichlet's distribution is uniform over the cell.
    weights = random.dirichlet(np.ones(s), count)
    return Places(cells[cell], weights), cell


def measure(
    inputs: ShadingInputs,
    scene: Scene,
    options: ShadingOptions,
    shading: Shading,
    cells: Indices,
    *,
    count: int,
    seed: int,
) -> Array:
    """Return the error of interpolated light at random places between the points.

    Cells with a point that could not be lit are left out; the result is empty if they have no area.
    """
    points = np.asarray(inputs.points[:])
    good = shading.valid & np.isfinite(points).all(axis=1)
    if not good.all():
        cells = cells[good[cells].all(axis=1)]
    places, _ = random_places(points, cells, count, np.random.default_rng(seed))
    if not len(places.weights):
        return np.empty(0)
    # Only the corners of the cells that were drawn are looked at.
    used, corner = np.unique(places.corners, return_inverse=True)
    # From here on corners count among the points that are taken.
    places = Places(corner.reshape(places.corners.shape), places.weights)
    return error_between(
        Between(_taken(inputs, used), scene, options), columns(shading, used), places
    )


def _taken(inputs: ShadingInputs, rows: Indices) -> ShadingInputs:
    """Return the inputs of some points."""
    arrays: dict[str, ArraySource] = {}
    for name in ("points", "normals", "tangents", "base_tangents"):
        source: ArraySource | None = getattr(inputs, name)
        if source is not None:
            arrays[name] = np.asarray(source[:])[rows]
    sides = inputs.sides and inputs.sides()
    if sides is not None:
        sides = sides._replace(normals=sides.normals[rows], facts=sides.facts[rows])
    return dataclasses.replace(
        inputs,
        **arrays,  # type: ignore[arg-type]
        sides=None if sides is None else lambda: sides,
    )


def error_between(between: Between, light: Array, places: Places) -> Array:
    """Return the error at places, shape (M,), of interpolated ``light``, shape (N, c)."""
    missed = np.abs(between.light(places) - interpolated(light, places))
    return np.asarray(missed.max(axis=1, initial=0))


def are_unit(rows: Array) -> bool:
    """Return whether rows are unit vectors, but for some of length 0."""
    if rows.ndim != 2 or rows.shape[1] < 2:
        return False
    length = kernels.length(np.ascontiguousarray(rows.T))
    length = length[length > 0]
    return bool(len(length)) and bool(np.all(np.abs(length - 1) < UNIT))


def _rows(rows: ArraySource) -> Array:
    return np.asarray(rows[:], dtype=np.float64)


def _frames(rows: ArraySource, n: int) -> tuple[Array, float]:
    """Return frames: of one vector divided by a scale, orthonormal ones of several."""
    vectors = _rows(rows)
    vectors = vectors.reshape(len(vectors), -1, n)
    if vectors.shape[1] > 1:
        return orthonormalize(vectors)[0], 1.0
    largest = float(np.abs(vectors).max(initial=0, where=np.isfinite(vectors))) or 1.0
    # The lengths of unit vectors are kept to rounding.
    scale = 1.0 if 0.5 < largest < 2 else largest
    return np.asarray(np.nan_to_num(vectors / scale, posinf=0.0, neginf=0.0)), scale


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def _toward(end: Light | View, points: Array) -> Array:
    """Return unit directions from points to a light or an eye."""
    # A parallel view with a position sees along its direction all the same.
    if end.direction is not None and (end.position is None or getattr(end, "parallel", False)):
        return kernels.unit_rows(np.array([end.direction], dtype=np.float64))
    return kernels.unit_rows(np.asarray(end.position, dtype=np.float64) - points)


def _across(lines: Array, half: Array) -> Array:
    """Return weights where interpolated lines are normal to a half vector, or most nearly so."""
    m, s, _ = lines.shape
    # A highlight on a line is brightest where the tangent is normal to the half vector: t . h = 0,
    # linear in the weights.
    along = np.einsum("msn,mn->ms", lines, np.broadcast_to(half, (m, lines.shape[2])))
    low, high = along.argmin(axis=1), along.argmax(axis=1)
    rows = np.arange(m)
    gap = along[rows, high] - along[rows, low]
    share = np.divide(-along[rows, low], gap, out=np.full(m, 0.5), where=gap > 0)
    # Where the tangents of all corners lie on one side of that, the place is the nearest corner.
    share = np.clip(share, 0, 1)
    weights = np.zeros((m, s))
    weights[rows, high] = share
    weights[rows, low] += 1 - share
    return weights


def _toward_half(normals: Array, half: Array) -> Array:
    """Return weights where interpolated normals point to a half vector, or most nearly so."""
    m, s, n = normals.shape
    half = np.broadcast_to(half, (m, n))
    if s == 2:
        a, b = normals[:, 0], normals[:, 1]
        aa, ab, bb, ah, bh = _dots(a, a), _dots(a, b), _dots(b, b), _dots(a, half), _dots(b, half)
        # The least squares solution of x a + y b = h by its normal equations, but for a common
        # factor.
        shares = np.stack([bb * ah - ab * bh, aa * bh - ab * ah], axis=1)
    else:
        a, b, c = (normals[:, i] for i in range(3))
        # The solution of x a + y b + z c = h by Cramer's rule; of the determinant only the sign is
        # needed.
        sides = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
        shares = np.einsum("msn,mn->ms", sides, half)
        shares *= np.where(_dots(a, sides[:, 0]) < 0, -1.0, 1.0)[:, np.newaxis]
    # A peak outside of the cell is moved to its border.
    shares = np.maximum(shares, 0)
    total = shares.sum(axis=1, keepdims=True)
    return np.asarray(np.divide(shares, total, out=np.full_like(shares, 1 / s), where=total > 0))
