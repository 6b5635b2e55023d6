"""A k-manifold in n-space from a function of k parameters, with the tangents it needs for light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vizlight import _check
from vizlight.geometry.nspace import lattice
from vizlight.model.frames import orthonormalize

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array, Indices

    Function = Callable[..., Any]

Tangents = Literal["complex", "central"]

#: The complex step: so small that its square is nothing beside 1.
COMPLEX_STEP = 1e-30
EPS = float(np.finfo(np.float64).eps)


def central_step(eps: float) -> float:
    """Return the central step, as a part of the domain, for numbers of a precision.

    The cube root of eps balances both errors.
    """
    return float(eps ** (1 / 3)) / 8


CENTRAL_STEP = central_step(EPS)
#: How far apart, as a part of the extent, two ends of a closed direction may be.
CLOSED = 1e-9
#: How far the tangent spaces there may differ, and complex step from central differences.
SAME_SPACE = 1e-5
NOT_ANALYTIC = 1e-5
#: Rounding of a function, in eps of its value and of what rounding its parameters does to it.
ROUNDING = 64


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
    cells: Indices

    @property
    def k(self) -> int:
        """The dimension of the manifold."""
        return int(self.frame.shape[1])

    @property
    def n(self) -> int:
        """The dimension of the space."""
        return int(self.points.shape[1])


def manifold(points: Array, tangents: Array, cells: Indices) -> Manifold:
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
        Called with k arrays of one shape, the parameters, all within the domain; returns n
        coordinates of that shape (or numbers, where one is constant).
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
        Of the differences, as a part of each direction's range. Default: eps^(1/3)/8 for central
        differences, 7.6e-7, or 6.2e-4 where the function returns float32; 1e-30 for the complex
        step.

    Returns
    -------
    Manifold

    Raises
    ------
    TypeError
        If the function does not take or return what is asked for.
    ValueError
        If an argument does not fit, the function is not finite on its domain, a direction that
        should be closed is not, the step is lost in the rounding of the parameters, or the
        function is not analytic where the complex step needs it: a derivative by central
        differences is off by more than 1e-5 of itself and their own error.

    Notes
    -----
    Error of a tangent, in each component, for a step h in the parameter's own unit: central
    differences ``(h^2/6) |f'''| + eps (|f| + |u f'|) / h`` with eps that of the numbers that
    the function returns, about 1e-10 of the extent in float64 and 3e-4 in float32 for a function
    that varies over its domain as a sine does over a period; the complex step
    ``Im f(u + i h) / h`` (nothing is subtracted, so h may be tiny) only the rounding of the
    function itself, a few eps. ``vizlight.studies.frames`` measures both. Differences stay
    within the domain: at its ends they are those of the parabola through the end and two points
    h and 2 h from it, with ``(h^2/3) |f'''|`` and four times the rounding.
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
    ends, wraps = _domain(domain, closed)
    k = len(ends)
    n = _check.integer("n", n, low=k + 1)
    eps = _precision(function, ends, n)
    ways = _ways(function, ends, n, tangents, step, eps)
    # Differences at both ends look inward, so that their errors, of order 2, need not agree.
    coarse = step if step is not None and tangents == "central" else 0.0
    same = max(SAME_SPACE, ROUNDING * eps ** (2 / 3), (8 * coarse) ** 2)

    def sample(*u: Array) -> tuple[Array, Array]:
        points = _values(function, u, n)
        return points, ways(u, points)

    if wraps is None:
        wraps = tuple(_comes_back(sample, ends, axis, eps, same) for axis in range(k))
    shape = lattice.resolution(resolution, k, wraps)
    axes = [
        np.linspace(low, high, count, endpoint=not wrap)
        for (low, high), count, wrap in zip(ends, shape, wraps, strict=True)
    ]
    u: list[Array] = [axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")]
    points, rows = sample(*u)
    for axis in range(k):
        if closed is None or not wraps[axis]:
            continue
        if not _comes_back(sample, ends, axis, eps):
            expected = f"a function that comes back in direction {axis}"
            raise ValueError(_check.message("closed", expected, "one that does not"))
    return manifold(points, rows, lattice.cells(shape, wraps))


def check_callable(name: str, value: Any) -> None:
    """Check that a value can be called."""
    if not callable(value):
        raise TypeError(_check.message(name, "a function", _check.describe(value)))


def _domain(domain: Any, closed: Any) -> tuple[Array, tuple[bool, ...] | None]:
    ends = _check.floats("domain", domain).astype(np.float64)
    if ends.ndim != 2 or ends.shape[1] != 2 or not 1 <= len(ends) <= 3:
        raise ValueError(
            _check.message("domain", "1 to 3 pairs (low, high)", f"shape {ends.shape}")
        )
    sizes = ends[:, 1] - ends[:, 0]
    if not np.all(np.isfinite(ends) & (sizes[:, np.newaxis] > 0)):
        raise ValueError(_check.message("domain", "finite pairs with low < high", ends.tolist()))
    if closed is None:
        return ends, None
    wraps = np.asarray(closed)
    expected = f"1 or {len(ends)} of True or False"
    if wraps.dtype.kind not in "biu" or not np.isin(wraps, (0, 1)).all():
        raise TypeError(_check.message("closed", expected, _check.describe(closed)))
    if wraps.shape not in ((), (len(ends),)):
        raise ValueError(_check.message("closed", expected, _check.describe(closed)))
    return ends, tuple(bool(wrap) for wrap in np.broadcast_to(wraps, len(ends)))


def _precision(function: Function, ends: Array, n: int) -> float:
    """Return eps of the coarsest numbers that a function returns, seen where its domain begins."""
    rows = _rows(function, list(ends[:, :1]), n)
    return max([EPS, *(float(np.finfo(row.dtype).eps) for row in rows if row.dtype.kind == "f")])


def _ways(
    function: Function, ends: Array, n: int, tangents: Any, step: float | None, eps: float
) -> Callable[[Sequence[Array], Array], Array]:
    """Return what gives tangents (N, k, n) at some parameters and points."""
    if step is not None:
        step = _check.number("step", step, low=1e-290, high=0.5)
    if callable(tangents):
        return lambda u, _: _given(tangents, u, n)
    if not isinstance(tangents, str) or tangents not in ("complex", "central"):
        got = _check.describe(tangents)
        raise ValueError(_check.message("tangents", "'central', 'complex' or a function", got))
    if tangents == "central":
        steps = _central_steps(step, ends, eps)
        return lambda u, _: _central(function, u, n, steps, ends)
    coarse = _central_steps(None, ends, eps)
    fine = (step or COMPLEX_STEP) * (ends[:, 1] - ends[:, 0])
    if not np.all(fine >= np.finfo(np.float64).tiny):
        raise ValueError(_lost_step(step, fine, ends))

    def checked(u: Sequence[Array], points: Array) -> Array:
        """Return ``Im f(u + i h) / h``, if it agrees with central differences."""
        found = _complex_step(function, u, n, fine)
        near, far = (_central(function, u, n, s * coarse, ends) for s in (1, 2))
        place = np.abs(np.stack(u, axis=1))[..., np.newaxis]
        rounding = np.abs(points)[:, np.newaxis] + place * np.abs(near)
        allowed = NOT_ANALYTIC * np.abs(near) + np.abs(far - near)
        allowed += ROUNDING * eps * rounding / coarse[:, np.newaxis]
        if not np.all(np.abs(found - near) <= allowed):
            expected = "one that is analytic, as the complex step needs"
            got = "one whose complex step and central differences disagree"
            remedy = "pass tangents='central'"
            raise ValueError(_check.message("function", expected, got, remedy))
        return found

    return checked


def _central_steps(step: float | None, ends: Array, eps: float) -> Array:
    """Return the step in each direction, if there are numbers between a parameter and the next."""
    steps: Array = (central_step(eps) if step is None else step) * (ends[:, 1] - ends[:, 0])
    if not np.all(steps >= 8 * np.spacing(np.abs(ends).max(axis=1))):
        raise ValueError(_lost_step(step, steps, ends))
    return steps


def _lost_step(step: float | None, steps: Array, ends: Array) -> str:
    """Return what is wrong where parameters are so large, or steps so small, that none is seen."""
    got = f"{steps.min():.2g} on {ends.tolist()}"
    if step is not None:
        return _check.message("step", "one that rounding of the parameters does not hide", got)
    remedy = "count parameters from its middle and in a unit of its size, or pass exact tangents"
    expected = "one in which rounding does not hide the step of differences"
    return _check.message("domain", expected, got, remedy)


def _given(tangents: Function, u: Sequence[Array], n: int) -> Array:
    """Return tangents by a function of the user's."""
    with np.errstate(all="ignore"):
        given = tangents(*u)
    expected = f"{len(u)} rows of {n}"
    try:
        rows = list(given)
    except TypeError as error:
        raise TypeError(_check.message("tangents", expected, _check.describe(given))) from error
    if len(rows) != len(u):
        raise ValueError(_check.message("tangents", expected, len(rows)))
    return np.stack([_values(lambda *_, row=row: row, u, n, "tangents") for row in rows], axis=1)


def _rows(
    function: Function, u: Sequence[Any], n: int, name: str = "function", allowed: str = "iubf"
) -> list[Any]:
    """Return n coordinates, each an array of the parameters' shape and of its own type."""
    with np.errstate(all="ignore"):
        given = function(*u)
    expected = f"one that returns {n} coordinates of the parameters' shape, or numbers"
    try:
        rows = [np.broadcast_to(np.asarray(row), u[0].shape) for row in given]
    except (TypeError, ValueError) as error:
        raise TypeError(_check.message(name, expected, _check.describe(given))) from error
    if len(rows) != n:
        raise ValueError(_check.message(name, expected, len(rows)))
    if any(row.dtype.kind not in allowed for row in rows):
        kinds = ", ".join(sorted({str(row.dtype) for row in rows}))
        raise TypeError(_check.message(name, "one that returns real numbers", kinds))
    return rows


def _values(
    function: Function, u: Sequence[Any], n: int, name: str = "function", kind: Any = np.float64
) -> Any:
    """Return n coordinates a point, (N, n), at some parameters."""
    rows = _rows(function, u, n, name, "iubf" if kind is np.float64 else "iubfc")
    points = np.stack(rows, axis=1).astype(kind)
    lost = int(np.count_nonzero(~np.all(np.isfinite(points), axis=1)))
    if lost:
        expected = "finite coordinates on its domain"
        remedy = "choose a domain without them"
        first = np.argmin(np.all(np.isfinite(points), axis=1))
        where = ", ".join(f"{x[first]:g}" for x in u)
        got = f"{lost} of {len(points)} points without, the first at ({where})"
        raise ValueError(_check.message(name, expected, got, remedy))
    return points


def _central(function: Function, u: Sequence[Array], n: int, steps: Array, ends: Array) -> Array:
    """Return slopes of the parabola through a point and two beside it, all within the domain."""
    rows = []
    for axis, h in enumerate(steps):
        low, high = ends[axis]
        middle = np.clip(u[axis], low + h, high - h)
        ahead, behind = list(u), list(u)
        ahead[axis], behind[axis] = np.minimum(middle + h, high), np.maximum(middle - h, low)
        # The distance between both is what the floats have, not what was asked for.
        width = (ahead[axis] - behind[axis])[:, np.newaxis]
        right, left = _values(function, ahead, n), _values(function, behind, n)
        slope = (right - left) / width
        aside = np.flatnonzero(middle != u[axis])
        if len(aside):
            at = [x[aside] for x in u]
            at[axis] = middle[aside]
            bend = (right[aside] - 2 * _values(function, at, n) + left[aside]) / (width[aside] / 2)
            slope[aside] += bend * (u[axis] - middle)[aside, np.newaxis] / (width[aside] / 2)
        rows.append(slope)
    return np.stack(rows, axis=1)


def _complex_step(function: Function, u: Sequence[Array], n: int, steps: Array) -> Array:
    """Return ``Im f(u + i h) / h``."""
    rows = []
    for axis, h in enumerate(steps):
        moved: list[Any] = list(u)
        moved[axis] = u[axis] + 1j * h
        try:
            rows.append(_values(function, moved, n, kind=np.complex128).imag / h)
        except TypeError as error:
            expected, remedy = "one that takes complex parameters", "pass tangents='central'"
            raise TypeError(_check.message("function", expected, str(error), remedy)) from error
    return np.stack(rows, axis=1)


def _comes_back(sample: Any, ends: Array, axis: int, eps: float, same: float | None = None) -> bool:
    """Tell whether both ends of a direction are one, with tangent spaces that differ by less."""
    across = [np.linspace(low, high, 9) for low, high in ends]

    def on(axes: Sequence[Any]) -> tuple[Array, Array]:
        found: tuple[Array, Array] = sample(*(u.ravel() for u in np.meshgrid(*axes)))
        return found

    (p, rows_p), (q, rows_q) = (
        on([*across[:axis], [end], *across[axis + 1 :]]) for end in ends[axis]
    )
    extent = np.ptp(on(across)[0], axis=0).max()
    if not extent or np.abs(p - q).max() > max(CLOSED, 16 * eps) * extent:
        return False
    if same is None:
        return True
    # A tangent space is compared by its projector, which no choice of rows changes.
    one, other = (np.einsum("bki,bkj->bij", f, f) for f in map(_frame, (rows_p, rows_q)))
    return bool(np.abs(one - other).max() < same)


def _frame(rows: Array) -> Array:
    frame: Array = orthonormalize(rows)[0]
    return frame
