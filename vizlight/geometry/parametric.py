"""A k-manifold in n-space from a function of k parameters, with the tangents it needs for light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vizlight import _check
from vizlight.geometry import lattice
from vizlight.model.frames import orthonormalize

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.floating[Any]]
    Function = Callable[..., Any]

Tangents = Literal["complex", "central"]

#: The complex step: so small that its square is nothing beside 1.
COMPLEX_STEP = 1e-30
#: The central step, as a part of the domain: the cube root of eps balances both errors.
CENTRAL_STEP = float(np.finfo(np.float64).eps ** (1 / 3)) / 8
#: How far apart, as a part of the extent, two ends of a closed direction may be.
CLOSED = 1e-9
#: How far the tangent spaces there may differ, and complex step from central differences.
SAME_SPACE = 1e-5
NOT_ANALYTIC = 1e-5


@dataclass(frozen=True)
class Manifold:
    """A sampled k-manifold in n-space.

    Attributes
    ----------
    points : ndarray, shape (N, n)
    frame : ndarray, shape (N, k, n)
        Orthonormal tangents; rows past the rank are zero.
    cells : ndarray of int, shape (M, 2^k)
        Segments, quadrilaterals or hexahedra between the points, corners in VTK's order. A
        closed direction shares its points across the seam.
    """

    points: Array
    frame: Array
    cells: NDArray[np.intp]

    @property
    def k(self) -> int:
        """The dimension of the manifold."""
        return int(self.frame.shape[1])

    @property
    def n(self) -> int:
        """The dimension of the space."""
        return int(self.points.shape[1])


def manifold(points: Array, tangents: Array, cells: NDArray[np.intp]) -> Manifold:
    """Return a :class:`Manifold`; its tangents (N, k, n) of any length are orthonormalised."""
    return Manifold(points, orthonormalize(tangents)[0], cells)


def parametric(
    function: Function,
    domain: Sequence[Sequence[float]],
    n: int,
    /,
    *,
    resolution: Any = 64,
    tangents: Tangents | Function = "central",
    closed: Sequence[bool] | bool | None = None,
    step: float | None = None,
) -> Manifold:
    """Sample a k-manifold in n-space, k = 1, 2 or 3.

    Parameters
    ----------
    function : callable
        Called with k arrays of one shape, the parameters; returns n coordinates of that shape
        (or numbers, where one is constant).
    domain : sequence of (low, high), one for each parameter
    n : int
        Dimension of the space, more than k.
    resolution : int or k of them, default: 64
        Samples in each direction.
    tangents : {"central", "complex"} or callable, default: "central"
        Where tangents come from: central differences; the complex step, for a function that is
        analytic and takes complex parameters (no ``abs``, ``arctan2`` or comparison); or a
        function like the first that returns k rows of n components, exact tangents.
    closed : bool or k of them, optional
        Whether a direction comes back to where it began: its last sample is then its first.
        Default: found out, by points and tangent spaces at both ends.
    step : float, optional
        Of the differences, as a part of each direction's range. Default: eps^(1/3)/8 = 7.6e-7
        for central differences, 1e-30 for the complex step.

    Returns
    -------
    Manifold

    Raises
    ------
    TypeError
        If the function does not take or return what is asked for.
    ValueError
        If an argument does not fit, the function is not finite on its domain, a direction that
        should be closed is not, or the function is not analytic where the complex step needs it.

    Notes
    -----
    Error of a tangent, in each component, for a step h in the parameter's own unit: central
    differences ``(h^2/6) |f'''| + eps |f| / h``, about 1e-10 of the extent for a function that
    varies over its domain as a sine does over a period; the complex step
    ``Im f(u + i h) / h`` (nothing is subtracted, so h may be tiny) only the rounding of the
    function itself, a few eps. ``vizlight.studies.frames`` measures both. Differences reach
    past the ends of the domain by h.
    Where tangents are dependent, at the pole of a sphere's angles for one, the frame has rows
    of zero, and light there is the ambient one.
    A twisted direction (a Moebius band) keeps two points at each place of its seam;
    :func:`vizlight.geometry.manifolds.klein_bottle` has none.

    Examples
    --------
    >>> import numpy as np
    >>> from vizlight.geometry import manifolds
    >>> circle = manifolds.parametric(lambda t: (np.cos(t), np.sin(t), 0), [(0, 2 * np.pi)], 3)
    >>> circle.points.shape, circle.frame.shape, circle.cells.shape
    ((64, 3), (64, 1, 3), (64, 2))
    """
    check_callable("function", function)
    ends, sizes, wraps = _domain(domain, closed)
    k = len(ends)
    n = _check.integer("n", n, low=k + 1)
    step = _step(step, tangents)

    def sample(*u: Array) -> tuple[Array, Array]:
        points = _values(function, u, n)
        return points, _tangents(function, u, n, tangents, step, sizes)

    if wraps is None:
        wraps = tuple(_comes_back(sample, ends, axis) for axis in range(k))
    shape = lattice.resolution(resolution, k, wraps)
    axes = [
        np.linspace(low, high, count, endpoint=not wrap)
        for (low, high), count, wrap in zip(ends, shape, wraps, strict=True)
    ]
    u: list[Array] = [axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")]
    points, rows = sample(*u)
    for axis in range(k):
        if closed is not None and wraps[axis] and not _comes_back(sample, ends, axis, spaces=False):
            expected = f"a function that comes back in direction {axis}"
            raise ValueError(_check.message("closed", expected, "one that does not"))
    return manifold(points, rows, lattice.cells(shape, wraps))


def check_callable(name: str, value: Any) -> None:
    """Check that a value can be called."""
    if not callable(value):
        raise TypeError(_check.message(name, "a function", _check.describe(value)))


def _domain(domain: Any, closed: Any) -> tuple[Array, Array, tuple[bool, ...] | None]:
    ends = _check.floats("domain", domain).astype(np.float64)
    if ends.ndim != 2 or ends.shape[1] != 2 or not 1 <= len(ends) <= 3:
        raise ValueError(
            _check.message("domain", "1 to 3 pairs (low, high)", f"shape {ends.shape}")
        )
    sizes = ends[:, 1] - ends[:, 0]
    if not np.all(np.isfinite(ends) & (sizes[:, np.newaxis] > 0)):
        raise ValueError(_check.message("domain", "finite pairs with low < high", ends.tolist()))
    if closed is None:
        return ends, sizes, None
    wraps = (closed,) * len(ends) if isinstance(closed, bool) else tuple(closed)
    if len(wraps) != len(ends):
        raise ValueError(_check.message("closed", f"1 or {len(ends)} of True or False", closed))
    return ends, sizes, tuple(bool(wrap) for wrap in wraps)


def _step(step: float | None, tangents: Any) -> float:
    if not callable(tangents) and tangents not in ("complex", "central"):
        raise ValueError(
            _check.message("tangents", "'central', 'complex' or a function", repr(tangents))
        )
    if step is None:
        return COMPLEX_STEP if tangents == "complex" else CENTRAL_STEP
    return _check.number("step", step, low=1e-290, high=0.5)


def _values(
    function: Function, u: Sequence[Any], n: int, name: str = "function", kind: Any = np.float64
) -> Any:
    """Return n coordinates a point, (N, n), at some parameters."""
    with np.errstate(all="ignore"):
        given = function(*u)
    expected = f"one that returns {n} coordinates of the parameters' shape, or numbers"
    try:
        rows = [np.broadcast_to(np.asarray(row), u[0].shape) for row in given]
    except (TypeError, ValueError) as error:
        raise TypeError(_check.message(name, expected, _check.describe(given))) from error
    if len(rows) != n:
        raise ValueError(_check.message(name, expected, len(rows)))
    allowed = "iubf" if kind is np.float64 else "iubfc"
    if any(row.dtype.kind not in allowed for row in rows):
        kinds = ", ".join(sorted({str(row.dtype) for row in rows}))
        raise TypeError(_check.message(name, "one that returns real numbers", kinds))
    points = np.stack(rows, axis=1).astype(kind)
    lost = int(np.count_nonzero(~np.all(np.isfinite(points), axis=1)))
    if lost:
        expected = "finite coordinates on its domain"
        remedy = "choose a domain without them"
        got = f"{lost} of {len(points)} points without"
        raise ValueError(_check.message(name, expected, got, remedy))
    return points


def _tangents(
    function: Function, u: Sequence[Array], n: int, tangents: Any, step: float, sizes: Array
) -> Array:
    """Return tangents (N, k, n) at some parameters."""
    if tangents == "central":
        return _central(function, u, n, step * sizes)
    if tangents == "complex":
        central = _central(function, u, n, CENTRAL_STEP * sizes)
        return _complex_step(function, u, n, step * sizes, central)
    with np.errstate(all="ignore"):
        rows = list(tangents(*u))
    if len(rows) != len(u):
        raise ValueError(_check.message("tangents", f"{len(u)} rows of {n}", len(rows)))
    return np.stack([_values(lambda *_, row=row: row, u, n, "tangents") for row in rows], axis=1)


def _central(function: Function, u: Sequence[Array], n: int, steps: Array) -> Array:
    rows = []
    for axis, h in enumerate(steps):
        ahead, behind = list(u), list(u)
        # The distance between both is what the floats have, not what was asked for.
        ahead[axis], behind[axis] = u[axis] + h, u[axis] - h
        width = (ahead[axis] - behind[axis])[:, np.newaxis]
        rows.append((_values(function, ahead, n) - _values(function, behind, n)) / width)
    return np.stack(rows, axis=1)


def _complex_step(
    function: Function, u: Sequence[Array], n: int, steps: Array, central: Array
) -> Array:
    """Return ``Im f(u + i h) / h``, if it agrees with central differences."""
    remedy = "pass tangents='central'"
    rows = []
    for axis, h in enumerate(steps):
        moved: list[Any] = list(u)
        moved[axis] = u[axis] + 1j * h
        try:
            rows.append(_values(function, moved, n, kind=np.complex128).imag / h)
        except TypeError as error:
            expected = "one that takes complex parameters"
            raise TypeError(_check.message("function", expected, str(error), remedy)) from error
    found = np.stack(rows, axis=1)
    scale = np.abs(central).max(initial=0.0)
    if not np.all(np.abs(found - central) <= NOT_ANALYTIC * scale):
        expected = "one that is analytic, as the complex step needs"
        got = "one whose complex step and central differences disagree"
        raise ValueError(_check.message("function", expected, got, remedy))
    return found


def _comes_back(sample: Any, ends: Array, axis: int, *, spaces: bool = True) -> bool:
    """Tell whether both ends of a direction are one, with one tangent space."""
    across = [np.linspace(low, high, 9) for low, high in ends]

    def on(axes: Sequence[Any]) -> tuple[Array, Array]:
        found: tuple[Array, Array] = sample(*(u.ravel() for u in np.meshgrid(*axes)))
        return found

    (p, rows_p), (q, rows_q) = (
        on([*across[:axis], [end], *across[axis + 1 :]]) for end in ends[axis]
    )
    extent = np.ptp(on(across)[0], axis=0).max()
    if not extent or np.abs(p - q).max() > CLOSED * extent:
        return False
    if not spaces:
        return True
    # A tangent space is compared by its projector, which no choice of rows changes.
    one, other = (np.einsum("bki,bkj->bij", f, f) for f in map(_frame, (rows_p, rows_q)))
    return bool(np.abs(one - other).max() < SAME_SPACE)


def _frame(rows: Array) -> Array:
    frame: Array = orthonormalize(rows)[0]
    return frame
