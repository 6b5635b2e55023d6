"""The arrays of one mesh that the engine lights, checked against each other."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import AnyArray, Array, Indices, RawType, Rows, Vector

#: Names of the arrays: vectors of the space, and numbers.
PLACED = ("points", "tangents", "normals", "base_tangents")
SHARES = ("fur_height", "shadow", "transmittance", "occlusion", "dimensions")


class ArraySource(Protocol):
    """Anything that gives rows by slice: an array, or points that are made on demand."""

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape; the first axis counts the points."""

    @property
    def dtype(self) -> RawType:
        """The type of the numbers."""

    def __getitem__(self, rows: Rows, /) -> AnyArray:
        """Return some rows."""


class Layout(NamedTuple):
    """Facts about the inputs that a plan needs.

    ``n`` is the dimension of the space, ``k`` the number of tangents per point, None for a surface
    that has normals alone; ``base`` is the number of base tangents per point, and ``fur`` the
    density of the fur that light passes. ``shadowed``: t of a cos-theta shadow is known; ``dimmed``
    and ``occluded``: the shares of the lights and of the ambient light are; ``two_sided``: normals
    have no side; ``mixed``: some of the points are lit as lines or alone, see
    ``ShadingInputs.dimensions``.
    """

    n: int = 3
    k: int | None = None
    normals: bool = False
    base: int = 0
    shadowed: bool = False
    fur: float = 0.0
    dimmed: bool = False
    occluded: bool = False
    two_sided: bool = False
    mixed: bool = False


class Sides(NamedTuple):
    """Normals before they are turned to the side of the surface that is seen.

    Normals (M, n) agree with each other on a side; ``facts`` (M, j) are numbers of each point on
    which the side depends, and ``turned`` takes normals, facts and points at the same places to the
    normals turned.
    """

    normals: Array
    facts: Array
    turned: Callable[[Array, Array, Array], Array]


@dataclass(frozen=True, kw_only=True)
class ShadingInputs:
    """The rows that are lit; normals, base tangents and perhaps tangents serve ``repeat`` points.

    Parameters
    ----------
    points : ArraySource, shape (N, n)
        Positions, less ``origin`` where one is given.
    tangents : ArraySource, shape (N or M, k n), optional
        Tangents, row after row; N = M repeat.
    normals : ArraySource, shape (M, n), optional
        Outward normals.
    base_tangents : ArraySource, shape (M, j n), optional
        Tangents of the manifold in which ``tangents`` lie.
    fur_height : ArraySource, shape (N,), optional
        Height of the fur above each point.
    fur : float, default: 0.0
        Density of that fur.
    shadow : ArraySource, shape (N, L), optional
        t of the cos-theta shadow of each light.
    transmittance : ArraySource, shape (N, L), optional
        Share of each light that reaches the points.
    occlusion : ArraySource, shape (N,), optional
        Share of the ambient light that reaches the points.
    dimensions : ArraySource, shape (N,), optional
        Dimension as which each point is lit, where a mesh in 3-space has cells of several kinds: 2
        by its normal, 1 as a line by its tangent, 0 as a point that faces the eye. The vector that
        is not used has any length but 0.
    two_sided : bool, default: False
        Whether the normals have no side: the surface is lit by ``|N . wi|``.
    line_field : bool, default: False
        Whether a single tangent per point is a line without sign, which matters between the points.
    repeat : int, default: 1
        Number of points, one after the other, that share a normal.
    origin : vector of n components, optional
        Vector that was subtracted from the points, where differences would lose digits.
    cells : callable, optional
        Function that returns the segments or triangles over which the light is interpolated, shape
        (C, 2) or (C, 3).
    sides : callable, optional
        Function that returns the normals as they are interpolated between the points.
    """

    points: ArraySource
    tangents: ArraySource | None = None
    normals: ArraySource | None = None
    base_tangents: ArraySource | None = None
    fur_height: ArraySource | None = None
    fur: float = 0.0
    shadow: ArraySource | None = None
    transmittance: ArraySource | None = None
    occlusion: ArraySource | None = None
    dimensions: ArraySource | None = None
    two_sided: bool = False
    line_field: bool = False
    repeat: int = 1
    origin: Vector | None = None
    cells: Callable[[], Indices] | None = None
    sides: Callable[[], Sides] | None = None

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.points.shape[0])

    @property
    def rows(self) -> int:
        """Number of rows of normals."""
        return self.count // self.repeat

    @property
    def layout(self) -> Layout:
        """Layout of the inputs, which a plan needs."""
        n, mixed = int(self.points.shape[1]), self.dimensions is not None
        # A mesh of several kinds of cells has the plan of a surface; the tangent of its lines comes
        # beside it.
        flat = self.tangents is None or mixed
        k = None if flat else int(np.prod(self.tangents.shape[1:])) // n  # type: ignore[union-attr]
        base = 0 if self.base_tangents is None else int(np.prod(self.base_tangents.shape[1:])) // n
        return Layout(
            n, k, self.normals is not None, base, self.shadow is not None, self.fur,
            self.transmittance is not None, self.occlusion is not None, self.two_sided, mixed,
        )  # fmt: skip

    def arrays(self) -> dict[str, ArraySource]:
        """Return the arrays that are given, by their names."""
        names = (*PLACED, *SHARES)
        return {name: x for name in names if (x := getattr(self, name)) is not None}

    @property
    def narrow(self) -> bool:
        """Whether the vectors have no more digits than float32."""
        # Points do not count: their differences to lights and eye lose no digits in either type.
        dtypes = [rows.dtype for rows in (self.tangents, self.normals) if rows is not None]
        return bool(dtypes) and all(kind in (np.float16, np.float32) for kind in dtypes)

    def of_faces(self) -> ShadingInputs:
        """Return inputs that light all points by their normals, where some are not on faces."""
        if self.dimensions is None:
            return self
        return dataclasses.replace(self, tangents=None, dimensions=None)

    def check(self, lights: int) -> None:
        """Check all shapes against each other, for a number of lights.

        Raises
        ------
        TypeError, ValueError
            If shapes or types do not fit.
        """
        shape = tuple(self.points.shape)
        if len(shape) != 2 or shape[1] < 2:
            got = f"shape {shape}"
            raise _check.value_error("points", "shape (N, n), n of 2 or more", got)
        count, n = shape
        rows, rest = divmod(count, _check.integer("repeat", self.repeat, low=1))
        if rest:
            raise _check.value_error("repeat", f"a divisor of {count} points", self.repeat)
        # Tangents may be shared by the points of a row, or each point has its own.
        for name, array, counts in (
            ("tangents", self.tangents, {count, rows}),
            ("base_tangents", self.base_tangents, {rows}),
        ):
            if array is not None:
                _check_tangents(name, tuple(array.shape), counts, n)
        _check.boolean("two_sided", self.two_sided)
        _check.number("fur", self.fur, low=0.0, high=1.0)
        if (self.fur_height is None) == bool(self.fur):
            raise _check.value_error("fur_height", "fur_height and fur= together", "one of them")
        for name, array, expected in (
            ("normals", self.normals, (rows, n)),
            ("fur_height", self.fur_height, (count,)),
            ("transmittance", self.transmittance, (count, lights)),
            ("occlusion", self.occlusion, (count,)),
            ("dimensions", self.dimensions, (count,)),
        ):
            if array is not None and tuple(array.shape) != expected:
                got = f"shape {tuple(array.shape)}"
                raise _check.value_error(name, f"shape {expected}", got)
        if self.shadow is not None:
            got = f"shape {tuple(self.shadow.shape)}" if self.normals is not None else "no normals"
            if got != f"shape {(count, lights)}":
                raise _check.value_error("shadow", f"shape ({count}, {lights}), normals", got)


def array_source(name: str, value: ArrayLike | ArraySource) -> ArraySource:
    """Return rows to slice: an array is validated, anything else that slices stays as it is.

    Masked elements become NaN, which is not lit.
    """
    if hasattr(value, "dtype") and not isinstance(value, np.ndarray):
        source: ArraySource = value  # type: ignore[assignment]
        # To check the values of an array that is made on demand would make all of it at once.
        return source
    return _check.reals(name, value)


def _check_tangents(name: str, shape: tuple[int, ...], counts: set[int], n: int) -> None:
    k = 0
    if len(shape) == 3 and shape[0] in counts and shape[2] == n:
        k = shape[1]
    elif len(shape) == 2 and shape[0] in counts and shape[1] % n == 0:
        # The tangents of a point stand one after the other in its row.
        k = shape[1] // n
    if not 0 < k < n:
        count = " or ".join(str(number) for number in sorted(counts))
        expected = f"shape ({count}, k, {n}) or ({count}, {n} k) with k < {n}, as points has {n}"
        raise _check.value_error(name, expected, f"shape {shape}")
