"""The algebra of NumPy: a number is an array of a block of points, a vector has n of them."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import DTypeLike

from vizlight._types import Array, Bools, Raw, Slice, Value, Vector
from vizlight.model import frames, highlight_integral, kernels
from vizlight.shading.algebra import Algebra, Lamp
from vizlight.shading.inputs import ArraySource, ShadingInputs
from vizlight.shading.plan import Plan
from vizlight.shading.terms import light

#: Coordinates below this leave no room in float32 for the rest beyond its digits.
SMALLEST_HELD = 1e-30


@dataclass(frozen=True, kw_only=True)
class Shading:
    """The light of N points, as :func:`vizlight.shading.engine.shade` returns it.

    Attributes
    ----------
    luminance : ndarray, shape (N,)
        Luminance of the points.
    valid : ndarray of bool, shape (N,)
        False where tangents or a normal have no direction, or where a point is not finite and
        lights or view depend on its place; such a point has the ambient light.
    diffuse, specular : ndarray, shape (N,), or None
        Terms before the depth cue, kd and ks included; with ``components``.
    rgb : ndarray, shape (N, 3), or None
        Colour where the scene has one, or an exposure; without an exposure not clipped at 1.
    plan : Plan
        Plan that was run.
    seconds : float
        Wall time of the run.
    """

    luminance: Array
    valid: Bools
    diffuse: Array | None
    specular: Array | None
    rgb: Array | None
    plan: Plan
    seconds: float = 0.0

    @property
    def ambient(self) -> float:
        """Ambient term of points that nothing occludes, one number for all."""
        return self.plan.ambient

    @cached_property
    def invalid(self) -> int:
        """Number of points that could not be lit."""
        return self.valid.size - int(np.count_nonzero(self.valid))

    @classmethod
    def of(cls, plan: Plan, count: int) -> Shading:
        """Return arrays for a number of points, to be filled."""
        # Not cleared, since the blocks write every point.
        kind, parts = plan.dtype, plan.components
        return cls(
            luminance=np.empty(count, kind),
            valid=np.empty(count, np.bool_),
            diffuse=np.empty(count, kind) if parts else None,
            specular=np.empty(count, kind) if parts else None,
            rgb=np.empty((count, 3), kind) if plan.colored else None,
            plan=plan,
        )

    def arrays(self) -> dict[str, Raw]:
        """Return the arrays that are not None."""
        return {name: x for name, x in vars(self).items() if isinstance(x, np.ndarray)}

    def part(self, _: int, rows: Slice, /) -> Shading:
        """Return the light of some points, with a share of the time."""
        share = (rows.stop - rows.start) / max(self.luminance.size, 1)
        # One by one: of many small meshes each has a part of its own.
        parts = {name: array[rows] for name, array in self.arrays().items()}
        return dataclasses.replace(self, **parts, seconds=self.seconds * share)  # type: ignore[arg-type]


def shade_block(plan: Plan, rows: Slice, inputs: ShadingInputs, output: Shading) -> None:
    """Light the points of some rows of normals or tangents.

    Overflow and underflow are handled; the caller silences NumPy's warnings about them.
    """
    w, m = Arrays(plan, inputs, rows), inputs.repeat
    light(w, plan)
    # One truth that broadcasts where the whole block has light.
    valid = np.True_ if w.valid is None else w.valid
    at = slice(rows.start * m, rows.stop * m)
    for name, value in (*w.results.items(), ("valid", valid)):
        target = getattr(output, name)[at]
        # Points of one row stand one after the other.
        # Arrays of the algebra have the component first, those of a mesh the point: one transposed
        # write.
        view = target if m == 1 else target.reshape(-1, m, *target.shape[1:])
        view.T[...] = value


class Arrays(Algebra):
    """NumPy's algebra of the points of some rows, which evaluates at once.

    A number has the shape (rows,); where several points share a row it is (repeat, rows), or
    (1, rows) where it depends on the row alone.
    """

    def __init__(self, plan: Plan, inputs: ShadingInputs, rows: Slice) -> None:
        super().__init__(plan)
        self.inputs, self.rows, self.type = inputs, rows, plan.dtype.type
        self.valid: Bools | None = None
        self.results: dict[str, Value] = {}
        self._shares: dict[str, Array] = {}

    # Inputs and numbers.

    def _columns(self, name: str) -> Array:
        """Return an input component by component, in the wider precision of input and work."""
        source: ArraySource = getattr(self.inputs, name)
        rows, m = self.rows, self.inputs.repeat
        # One row for each point: the common case, without a second axis.
        if m == 1:
            return columns(source, rows, self.plan.dtype)
        # One row for all points of a fibre: it broadcasts along the axis of the points.
        if source.shape[0] != self.inputs.count:
            return columns(source, rows, self.plan.dtype)[:, np.newaxis]
        # Points of a fibre follow each other; the strided slice takes the j-th of every fibre.
        each = [
            columns(source, slice(rows.start * m + j, rows.stop * m, m), self.plan.dtype)
            for j in range(m)
        ]
        return np.stack(each, axis=1)

    @cached_property
    def _points(self) -> Array:
        return self._columns("points")

    def has(self, name: str) -> bool:
        """Return whether an input is given."""
        return getattr(self.inputs, name) is not None

    def read(self, name: str, lamp: Lamp | None = None) -> Value:
        """Return an input at the points."""
        # Normals are read once; shares hold all lamps in one array and are read lamp by lamp.
        if name == "normals":
            return self._columns(name)
        if name not in self._shares:
            self._shares[name] = self._columns(name)
        return self._shares[name][lamp.number if lamp else 0].astype(self.type, copy=False)

    def vectors(self, name: str, k: int) -> Sequence[Value]:
        """Return the k vectors of an input at the points."""
        # Tangents stand one after the other in a row: k times n components.
        array = self._columns(name)
        return list(array.reshape(k, self.n, *array.shape[1:]))

    def number(self, value: float) -> Value:
        """Return a number of the plan."""
        return self.type(value)

    def wide(self, value: float) -> Value:
        """Return a number of the plan in float64, which float32 does not take in."""
        # As an array, because beside float32 arrays NumPy rounds a Python number to float32.
        return np.array([value])

    def vector(self, values: Sequence[float], *, wide: bool = False) -> Value:
        """Return a vector of the plan, which broadcasts."""
        column = np.array(values, np.float64 if wide else self.type)
        # An axis of length 1 for the rows and, where points share a row, one for the points of
        # each.
        return column.reshape(-1, *(1,) * (1 + (self.inputs.repeat > 1)))

    def difference(self, position: Vector, *, wide: bool = False) -> Value:
        """Return a position less the points.

        float32 points in float32 work: the position is split into two float32 numbers, so that
        differences lose nothing to the distance from the origin.
        """
        points, at = self._points, self.vector(position, wide=True)
        # Dekker's split: high is what float32 holds of the position, low the rest.
        high = at.astype(np.float32)
        held = np.isfinite(high) & ((np.abs(high) > SMALLEST_HELD) | (at == 0))
        # A position out of float32's range has no such split.
        if wide or points.dtype == np.float64 or not held.all():
            return at - points
        difference, low = high - points, (at - high).astype(np.float32)
        return difference + low if low.any() else difference

    def work(self, x: Value) -> Value:
        """Return numbers in the precision of the work."""
        return x.astype(self.type, copy=False)

    # Vectors.

    def dot(self, a: Value, b: Value) -> Value:
        """Return dot products."""
        return kernels.dot(a, b)

    def unit(self, v: Value) -> tuple[Value, Value]:
        """Return unit vectors and finite lengths: 0 of a zero vector, NaN of one not finite."""
        unit, size = kernels.unit(v)
        # An infinite length is told from NaN, which marks the point: its direction is known.
        if not np.isfinite(size.max(initial=0)):
            size = np.minimum(size, np.finfo(size.dtype).max)
        return unit, size

    def apart(self, v: Value) -> Value:
        """Return the length of a residual up to which it is rounding."""
        return frames.default_rtol(self.n, v.dtype)

    def integral(self, z: Value, shininess: float) -> Value:
        """Return G(z) of a cylinder."""
        return highlight_integral.half_integral(shininess, z.dtype)(z)

    # Points without light.

    def need(self, test: Value) -> None:
        """Mark points that fail the test as unlit."""
        # Most blocks have no such point; none then carries a mask through the terms.
        if not test.all():
            self.valid = test if self.valid is None else self.valid & test

    def known(self, x: Value) -> None:
        """Mark points where a number is NaN as unlit."""
        self.need(~np.isnan(x))

    def present(self, x: Value, distance: Value | None) -> Value:
        """Return x, and 0 where the distance of its cause is 0."""
        return x if distance is None or distance.all() else x * (distance > 0)

    def sound(self, x: Value, other: float) -> Value:
        """Return x at points with light, else another number."""
        return x if self.valid is None else np.where(self.valid, x, self.type(other))

    # Results.

    def added(self, total: Value | None, value: Value) -> Value:
        """Return a sum, in place where it has the size."""
        if total is None:
            return value
        # In place only where nothing broadcasts: a lamp's constant term may meet one per point.
        return total + value if total.size < value.size else np.add(total, value, out=total)

    def largest(self, rgb: Value) -> Value:
        """Return the largest channel of colours."""
        return rgb.max(axis=0)

    def put(self, name: str, value: Value) -> None:
        """Store a value as a result."""
        self.results[name] = value


def columns(rows: ArraySource, block: Slice, work: DTypeLike = np.float32) -> Array:
    """Return a block of rows component by component, in the wider precision of rows and work.

    Float64 vectors are thus normalised before float32 work rounds them.
    """
    part = rows[block]
    narrow = work == np.float32 and part.dtype in (np.float16, np.float32)
    dtype = np.float32 if narrow else np.float64
    return np.ascontiguousarray(part.reshape(len(part), -1).T, dtype=dtype)
