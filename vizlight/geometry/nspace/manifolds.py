"""A k-manifold in n-space, sampled from a function of k parameters, with its tangents; tori."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import AnyArray, Array, Indices, Numbers
from vizlight.geometry.nspace import lattice
from vizlight.model.frames import orthonormalize

Function = Callable[..., Iterable[ArrayLike]]
TangentFunction = Callable[..., Iterable[Iterable[ArrayLike]]]
Samples = Callable[..., tuple[Array, Array]]

__all__ = ["Manifold", "parametric", "torus"]

Tangents = Literal["complex", "central"]

#: Complex step, as a share of the domain: its square vanishes next to 1.
COMPLEX_STEP = 1e-30
EPS = float(np.finfo(np.float64).eps)


def central_step(eps: float) -> float:
    """Return the step of central differences, as a share of the domain, for numbers of a given eps.

    The cube root of eps balances the truncation and the rounding error.
    """
    return float(eps ** (1 / 3)) / 8


#: Largest distance, as a share of the extent, between the two ends of a closed direction.
CLOSED = 1e-9
#: Largest difference of the tangent spaces at both ends of a closed direction.
SAME_SPACE = 1e-5
#: Largest relative difference between the complex step and central differences.
NOT_ANALYTIC = 1e-5
#: Rounding error of a function, in eps of its value and of the effect of rounded parameters.
ROUNDING = 64
#: Largest radius of a torus.
LARGEST_RADIUS = 1e150


@dataclass(frozen=True)
class Manifold:
    """A sampled k-manifold in n-space.

    Attributes
    ----------
    points : ndarray, shape (N, n)
        Positions.
    frame : ndarray, shape (N, k, n)
        Orthonormal tangents; rows past the rank are zero.
    cells : ndarray of int, shape (M, 2^k)
        Segments, quadrilaterals or hexahedra between the points, with corners in VTK's order. A
        closed direction shares its points across the seam.

    Numbers that are not finite are kept; results from them are marked as invalid.

    Raises
    ------
    TypeError, ValueError
        If an array does not hold real numbers, or the shapes do not fit.
    """

    points: Array
    frame: Array
    cells: Indices

    def __post_init__(self) -> None:
        points, frame = (_check.floats(name, getattr(self, name)) for name in ("points", "frame"))
        if points.ndim != 2 or points.shape[1] < 2:
            raise _check.value_error("points", "shape (N, n), n of 2 or more", points)
        count, n = points.shape
        if frame.ndim != 3 or frame.shape[::2] != (count, n) or not 0 < frame.shape[1] < n:
            expected = f"shape ({count}, k, {n}) with k < {n}, for points of shape ({count}, {n})"
            raise _check.value_error("frame", expected, frame)
        cells = _check.cells("cells", self.cells, count, (2 ** frame.shape[1],))
        _check.set_fields(self, points=points, frame=frame, cells=cells)

    @property
    def k(self) -> int:
        """Dimension of the manifold."""
        return int(self.frame.shape[1])

    @property
    def n(self) -> int:
        """Dimension of the space."""
        return int(self.points.shape[1])


def manifold(points: Array, tangents: Array, cells: Indices) -> Manifold:
    """Return a :class:`Manifold` of tangents (N, k, n), which are orthonormalised first."""
    return Manifold(points, orthonormalize(tangents)[0], cells)


def parametric(
    function: Function,
    domain: Sequence[Sequence[float]],
    n: int,
    /,
    *,
    resolution: int | Sequence[int] = 64,
    tangents: Tangents | TangentFunction = "central",
    closed: Sequence[bool] | bool | None = None,
    step: float | None = None,
) -> Manifold:
    """Sample a k-manifold in n-space, k = 1, 2 or 3.

    Parameters
    ----------
    function : callable
        Function of the k parameters, which are arrays of one shape inside the domain. It returns n
        coordinates of that shape (or a number for a constant coordinate).
    domain : sequence of (low, high), one for each parameter
        Range of each parameter.
    n : int
        Dimension of the space, more than k.
    resolution : int or k of them, default: 64
        Number of samples in each direction.
    tangents : {"central", "complex"} or callable, default: "central"
        Source of the tangents: central differences; the complex step, for a function that is
        analytic and accepts complex parameters (no ``abs``, ``arctan2`` or comparison); or a
        function of the same parameters that returns the exact tangents, k rows of n components.
    closed : bool or k of them, optional
        Whether a direction returns to its start, so that its last sample is followed by its first.
        Default: determined from the points and tangent spaces at both ends.
    step : float, optional
        Step of the differences, as a share of each direction's range. Default: eps^(1/3)/8 for
        central differences, which is 7.6e-7, or 6.2e-4 where the function returns float32; 1e-30
        for the complex step.

    Returns
    -------
    Manifold

    Raises
    ------
    TypeError
        If the function does not take or return such arrays.
    ValueError
        If an argument is invalid, the function is not finite on its domain, a direction that should
        be closed is not, the step is lost in the rounding of the parameters, or the function is not
        analytic although the complex step requires it: its derivative differs from central
        differences by more than 1e-5 of itself plus their own error.

    Notes
    -----
    For a step h in the parameter's own unit, the error of each component of a tangent by central
    differences is ``(h^2/6) |f'''| + eps (|f| + |u f'|) / h``, with eps of the type that the
    function returns. For a function that varies over a domain from 0 on like one period of a sine
    this is about 1e-10 of the extent in float64 and 3e-4 in float32. The complex step
    ``Im f(u + i h) / h`` subtracts nothing, so h may be tiny, and its error is only the rounding of
    the function itself, a few eps. Differences stay inside the domain: at its
    ends they are the slope of the parabola through the end and the points h and 2 h from it, with
    an error of ``(h^2/3) |f'''|`` and four times the rounding. Where tangents are dependent, for
    example at the poles of spherical coordinates, the frame has rows of zero and only ambient light
    remains. A twisted direction (a Moebius band) keeps two points at each place of its seam.

    Examples
    --------
    >>> import numpy as np
    >>> from vizlight.geometry import manifolds
    >>> circle = manifolds.parametric(lambda t: (np.cos(t), np.sin(t), 0), [(0, 2 * np.pi)], 3)
    >>> circle.points.shape, circle.frame.shape, circle.cells.shape
    ((64, 3), (64, 1, 3), (64, 2))
    """
    _check.function("function", function)
    ends, wraps = _domain(domain, closed)
    k = len(ends)
    n = _check.integer("n", n, low=k + 1)
    # The precision of the coarsest type that the function returns at the start of its domain.
    first = _rows(function, list(ends[:, :1]), n)
    eps = max([EPS, *(float(np.finfo(row.dtype).eps) for row in first if row.dtype.kind == "f")])
    slopes = _slopes(function, ends, n, tangents, step, eps)
    # Differences at both ends are one-sided, so their second-order errors need not agree.
    coarse = step if step is not None and tangents == "central" else 0.0
    same = max(SAME_SPACE, ROUNDING * eps ** (2 / 3), (8 * coarse) ** 2)

    def sample(*u: Array) -> tuple[Array, Array]:
        points = _values(function, u, n)
        return points, slopes(u, points)

    if wraps is None:
        wraps = tuple(_is_closed(sample, ends, axis, eps, same) for axis in range(k))
    shape = lattice.resolution(resolution, k, wraps)
    axes = [
        # The end of a closed direction is its start, which is sampled already.
        np.linspace(low, high, count, endpoint=not wrap)
        for (low, high), count, wrap in zip(ends, shape, wraps, strict=True)
    ]
    u: list[Array] = [axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")]
    points, rows = sample(*u)
    for axis in range(k):
        if closed is not None and wraps[axis] and not _is_closed(sample, ends, axis, eps):
            expected = f"a function that returns to its start in direction {axis}"
            remedy = "pass closed=False for an open direction"
            raise _check.value_error("closed", expected, "one that does not", remedy)
    return manifold(points, rows, lattice.cells(shape, wraps))


def _domain(domain: object, closed: object) -> tuple[Array, tuple[bool, ...] | None]:
    ends = _check.floats("domain", domain).astype(np.float64)
    if ends.ndim != 2 or ends.shape[1] != 2 or not 1 <= len(ends) <= 3:
        raise _check.value_error("domain", "1 to 3 pairs (low, high)", ends)
    sizes = ends[:, 1] - ends[:, 0]
    if not np.all(np.isfinite(ends) & (sizes[:, np.newaxis] > 0)):
        raise _check.value_error("domain", "finite pairs with low < high", ends.tolist())
    if closed is None:
        return ends, None
    expected = f"a bool or {len(ends)} of them"
    try:
        wraps = np.asarray(closed)
    except ValueError as error:
        raise _check.type_error("closed", expected, closed) from error
    if wraps.dtype.kind not in "biu" or not np.isin(wraps, (0, 1)).all():
        raise _check.type_error("closed", expected, closed)
    if wraps.shape not in ((), (len(ends),)):
        raise _check.value_error("closed", expected, _check.describe(closed))
    return ends, tuple(bool(wrap) for wrap in np.broadcast_to(wraps, len(ends)))


def _slopes(
    function: Function,
    ends: Array,
    n: int,
    tangents: Tangents | TangentFunction,
    step: float | None,
    eps: float,
) -> Callable[[Sequence[Array], Array], Array]:
    """Return a function of parameters and points that returns tangents (N, k, n)."""
    if step is not None:
        step = _check.number("step", step, low=1e-290, high=0.5)
    if callable(tangents):
        return lambda u, _: _exact(tangents, u, n)
    if not isinstance(tangents, str) or tangents not in get_args(Tangents):
        got = _check.describe(tangents)
        raise _check.value_error("tangents", "'central', 'complex' or a function", got)
    if tangents == "central":
        steps = _central_steps(step, ends, eps)
        return lambda u, _: _central(function, u, n, steps, ends)
    coarse = _central_steps(None, ends, eps)
    fine = (step or COMPLEX_STEP) * (ends[:, 1] - ends[:, 0])
    # The complex step subtracts nothing, and only has to be a normal number.
    if not np.all(fine >= np.finfo(np.float64).tiny):
        raise ValueError(_lost_step(step, fine, ends))

    def checked(u: Sequence[Array], points: Array) -> Array:
        """Return ``Im f(u + i h) / h`` after a comparison with central differences."""
        slopes = _complex_step(function, u, n, fine)
        # The difference of the two estimates the error of central differences themselves.
        near, far = (_central(function, u, n, s * coarse, ends) for s in (1, 2))
        place = np.abs(np.stack(u, axis=1))[..., np.newaxis]
        # The function rounds its values, and the parameters' rounding moves them by the slope.
        rounding = np.abs(points)[:, np.newaxis] + place * np.abs(near)
        allowed = NOT_ANALYTIC * np.abs(near) + np.abs(far - near)
        allowed += ROUNDING * eps * rounding / coarse[:, np.newaxis]
        if not np.all(np.abs(slopes - near) <= allowed):
            expected = "one that is analytic, as the complex step requires"
            got = "one for which the complex step and central differences disagree"
            raise _check.value_error("function", expected, got, "pass tangents='central'")
        return slopes

    return checked


def _central_steps(step: float | None, ends: Array, eps: float) -> Array:
    """Return the step in each direction, if it is large compared to the parameters' rounding."""
    steps: Array = (central_step(eps) if step is None else step) * (ends[:, 1] - ends[:, 0])
    # A step of few units in the last place of a parameter would be rounding for the most part.
    if not np.all(steps >= 8 * np.spacing(np.abs(ends).max(axis=1))):
        raise ValueError(_lost_step(step, steps, ends))
    return steps


def _lost_step(step: float | None, steps: Array, ends: Array) -> str:
    """Return an error message for a step that the rounding of the parameters hides."""
    got = f"{steps.min():.2g} on {ends.tolist()}"
    if step is not None:
        expected = "one that rounding of the parameters does not hide"
        return _check.message("step", expected, got, "pass a larger step")
    remedy = "measure parameters from its middle, in a unit of its size, or pass exact tangents"
    expected = "one in which rounding does not hide the step of differences"
    return _check.message("domain", expected, got, remedy)


def _exact(tangents: TangentFunction, u: Sequence[Array], n: int) -> Array:
    """Return the tangents that a user's function returns, validated."""
    with np.errstate(all="ignore"):
        returned = tangents(*u)
    expected = f"{len(u)} rows of {n}"
    try:
        rows = list(returned)
    except TypeError as error:
        raise _check.type_error("tangents", expected, returned) from error
    if len(rows) != len(u):
        raise _check.value_error("tangents", expected, len(rows))
    return np.stack([_values(lambda *_, row=row: row, u, n, "tangents") for row in rows], axis=1)


def _rows(
    function: Function, u: Sequence[Numbers], n: int, name: str = "function"
) -> list[AnyArray]:
    """Return n coordinates in the parameters' shape, each of its own type.

    They may be complex only where a parameter is.
    """
    with np.errstate(all="ignore"):
        returned = function(*u)
    expected = f"one that returns {n} coordinates of the parameters' shape, or numbers"
    try:
        # Constant coordinates may be given as numbers.
        rows = [np.broadcast_to(np.asarray(row), u[0].shape) for row in returned]
    except (TypeError, ValueError) as error:
        raise _check.type_error(name, expected, returned) from error
    if len(rows) != n:
        raise _check.value_error(name, expected, len(rows))
    # A complex result is right only where a parameter is complex: its kind then joins the others.
    if any(row.dtype.kind not in "iubf" + np.result_type(*u).kind for row in rows):
        kinds = ", ".join(sorted({str(row.dtype) for row in rows}))
        raise TypeError(_check.message(name, "one that returns real numbers", kinds))
    return rows


def _values(function: Function, u: Sequence[Numbers], n: int, name: str = "function") -> AnyArray:
    """Return n finite coordinates per point, (N, n), complex where a parameter is."""
    points = np.stack(_rows(function, u, n, name), axis=1).astype(np.result_type(np.float64, *u))
    finite = np.all(np.isfinite(points), axis=1)
    lost = int(np.count_nonzero(~finite))
    if lost:
        expected = "finite coordinates on its domain"
        where = ", ".join(f"{x[np.argmin(finite)]:g}" for x in u)
        got = f"{lost} of {len(points)} points with NaN or infinity, the first at ({where})"
        raise _check.value_error(name, expected, got, "choose a domain without them")
    return points


def _central(function: Function, u: Sequence[Array], n: int, steps: Array, ends: Array) -> Array:
    """Return the slopes of parabolas through three points, all within the domain."""
    rows = []
    for axis, h in enumerate(steps):
        low, high = ends[axis]
        # At the ends of the domain all three points move inside it.
        middle = np.clip(u[axis], low + h, high - h)
        ahead, behind = list(u), list(u)
        ahead[axis], behind[axis] = np.minimum(middle + h, high), np.maximum(middle - h, low)
        # Rounding makes the actual distance differ from the requested one.
        width = (ahead[axis] - behind[axis])[:, np.newaxis]
        right, left = _values(function, ahead, n), _values(function, behind, n)
        slope = (right - left) / width
        at_ends = np.flatnonzero(middle != u[axis])
        if len(at_ends):
            at = [x[at_ends] for x in u]
            at[axis] = middle[at_ends]
            half = width[at_ends] / 2
            bend = (right[at_ends] - 2 * _values(function, at, n) + left[at_ends]) / half
            # The parabola's second derivative, times the way from its middle to the point.
            slope[at_ends] += bend * (u[axis] - middle)[at_ends, np.newaxis] / half
        rows.append(slope)
    return np.stack(rows, axis=1)


def _complex_step(function: Function, u: Sequence[Array], n: int, steps: Array) -> Array:
    """Return ``Im f(u + i h) / h``."""
    rows = []
    for axis, h in enumerate(steps):
        moved: list[Numbers] = list(u)
        moved[axis] = u[axis] + 1j * h
        try:
            rows.append(_values(function, moved, n).imag / h)
        except TypeError as error:
            expected, remedy = "one that takes complex parameters", "pass tangents='central'"
            raise TypeError(_check.message("function", expected, str(error), remedy)) from error
    return np.stack(rows, axis=1)


def _is_closed(
    sample: Samples, ends: Array, axis: int, eps: float, same: float | None = None
) -> bool:
    """Return whether the points, and to ``same`` the tangent spaces, at both ends coincide."""
    # Nine places across the seam tell whether all of it closes, and not one point by chance.
    across = [np.linspace(low, high, 9) for low, high in ends]

    def on(axes: Sequence[ArrayLike]) -> tuple[Array, Array]:
        return sample(*(u.ravel() for u in np.meshgrid(*axes)))

    (p, rows_p), (q, rows_q) = (
        on([*across[:axis], [end], *across[axis + 1 :]]) for end in ends[axis]
    )
    # The extent of the whole shape: at its seam alone it may have none.
    extent = np.ptp(on(across)[0], axis=0).max()
    if not extent or np.abs(p - q).max() > max(CLOSED, 16 * eps) * extent:
        return False
    if same is None:
        return True
    # Tangent spaces are compared by their projectors, which do not depend on the basis.
    frames = [orthonormalize(rows)[0] for rows in (rows_p, rows_q)]
    first, second = (np.einsum("bki,bkj->bij", frame, frame) for frame in frames)
    return bool(np.abs(first - second).max() < same)


def torus(*radii: float, resolution: int | Sequence[int] = 64) -> Manifold:
    """Return the product of 1 to 3 circles, a k-torus in 2k-space.

    ``torus(r1, r2)`` is the torus of Banks, section 3, a surface in 4-space:
    ``(r1 cos t, r1 sin t, r2 cos f, r2 sin f)``; ``torus(r1, r2, r3)`` is the 3-torus in 6-space.

    Parameters
    ----------
    *radii : float
        Radii of the circles, above 0, in any unit.
    resolution : int or one for each circle, default: 64
        Number of samples on a circle, 3 or more.

    Returns
    -------
    Manifold
        Segments, quadrilaterals or hexahedra without a boundary.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The tangents are orthonormal by construction. The error of points, relative to the largest
    radius, and of tangents is 8 eps per component, including the error of the angle. Source: Banks,
    section 3.
    """
    if not 1 <= len(radii) <= 3:
        raise _check.value_error("radii", "1 to 3 radii", len(radii))
    # The square of a radius must be well within the range of float64.
    sizes = [_check.positive(f"radii[{i}]", r, high=LARGEST_RADIUS) for i, r in enumerate(radii)]
    k = len(sizes)
    shape = lattice.resolution(resolution, k, [True] * k)
    angles = np.meshgrid(*(2 * np.pi * np.arange(count) / count for count in shape), indexing="ij")
    points = np.empty((angles[0].size, 2 * k))
    tangents = np.zeros((len(points), k, 2 * k))
    for i, (radius, angle) in enumerate(zip(sizes, angles, strict=True)):
        cosine, sine = np.cos(angle.ravel()), np.sin(angle.ravel())
        points[:, 2 * i], points[:, 2 * i + 1] = radius * cosine, radius * sine
        tangents[:, i, 2 * i], tangents[:, i, 2 * i + 1] = -sine, cosine
    return Manifold(points, tangents, lattice.cells(shape, [True] * k))
