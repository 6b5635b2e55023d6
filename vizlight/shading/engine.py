"""The one seam for all shading: run a scene's plan over points, block by block.

Blocks fit the cache, run on a pool of threads and write into preallocated output, so that
memory beyond the output does not grow with the mesh.
"""

from __future__ import annotations

import contextlib
import contextvars
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from vizlight import _check, _pool
from vizlight.shading.block import Given, Output, Rows, columns, shade_block, view_depth
from vizlight.shading.decide import plan
from vizlight.shading.options import Model, Precision
from vizlight.shading.plan import Plan

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vizlight._types import Array, Bools
    from vizlight.scene import Scene

    Observer = Callable[[Given, Scene, "Shading", dict[str, Any]], None]

__all__ = [
    "Model",
    "Plan",
    "Precision",
    "Rows",
    "Shading",
    "depth_range",
    "observed",
    "plan",
    "shade",
]


@dataclass(frozen=True, kw_only=True)
class Shading:
    """The light of N points, as :func:`shade` returns it.

    Attributes
    ----------
    luminance : ndarray, shape (N,)
    valid : ndarray of bool, shape (N,)
        False where tangents or a normal have no direction, or a point that lights or view ask
        for is not finite; such a point has the ambient light.
    diffuse, specular : ndarray, shape (N,), or None
        With ``components``; before the depth cue, kd and ks included.
    rgb : ndarray, shape (N, 3), or None
        Where the scene has a colour; linear, not clipped at 1.
    plan : Plan
    seconds : float
        Wall time of the run.
    """

    luminance: Array
    valid: Bools
    diffuse: Array | None
    specular: Array | None
    rgb: Array | None
    plan: Plan
    seconds: float

    @property
    def ambient(self) -> float:
        """The ambient term, one number for all points."""
        return self.plan.ambient

    @property
    def invalid(self) -> int:
        """How many points could not be lit."""
        return self.valid.size - int(np.count_nonzero(self.valid))


_OBSERVER: contextvars.ContextVar[Observer | None] = contextvars.ContextVar(
    "observer", default=None
)


@contextlib.contextmanager
def observed(observer: Observer | None, /) -> Iterator[None]:
    """Call a function after each run of the engine while this context is entered.

    Parameters
    ----------
    observer : callable or None
        Called with the inputs, the scene, the :class:`Shading` and the options of a run; None
        to call nothing for a while.
    """
    token = _OBSERVER.set(observer)
    try:
        yield
    finally:
        _OBSERVER.reset(token)


def shade(
    points: Rows,
    tangents: Rows | None,
    scene: Scene,
    /,
    *,
    normals: Rows | None = None,
    carrier: Rows | None = None,
    depth: Rows | None = None,
    shadow: Rows | None = None,
    repeat: int = 1,
    precision: Precision | None = None,
    threads: int | None = None,
    block: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> Shading:
    """Light points by a scene.

    Parameters
    ----------
    points : array_like, shape (N, n)
        Positions, in any unit and of any real type, or an object with ``shape`` and ``dtype``
        that gives rows by slice. Differences to lights and eye are exact to rounding of the
        result, also far from the origin.
    tangents : array_like, shape (N, k, n) or (N, k n) or (N, n), or None
        Vectors that span the tangent space, of any length; orthonormalised here block by block.
        None: the manifold is the surface that has the normals.
    scene : Scene
    normals : array_like, shape (M, n), optional
        Outward normals, of any length. With tangents they condition the light (Banks 6).
    carrier : array_like, shape (M, j, n) or (M, j n), optional
        Instead of normals, where codimension 2 or more has none: what spans the manifold that
        the tangents lie in. Diffuse and specular of each light are multiplied by its own
        brightness ``sin(a)^p(j, n)``.
    depth : array_like, shape (N,), optional
        With ``fur=``: the height of fur above each point, across the surface.
    shadow : array_like, shape (N, L), optional
        t of the cos-theta shadow for each of the L lights of intensity above 0. It takes the
        place of the cosine of normals in the diffuse term and where they condition; a surface's
        highlight keeps ``min(1, t / cos)``.
    repeat : int, default: 1
        How many points, one after the other, share a normal, such as those of a fibre:
        N = M repeat. Tangents have N rows or M. What depends on the row alone is computed once.
    precision : {"float32", "float64"}, optional
        Of the work and the result. Default: float32 if the vectors are float32 or less, else
        float64; float64 points keep their differences in float64 either way. With
        ``tolerance=`` what that allows.
    threads : int, optional
        Default: the processors that this process may use.
    block : int, optional
        Rows in a block. Default: what suits the caches, see :attr:`Plan.block`.
    progress : callable, optional
        Called from the caller's thread as ``progress(points done, N)`` after each block.
    **options
        Of :func:`plan`: model, highlight_error, tolerance, compensate, conditioned, two_sided,
        terminator, fur, components.

    Returns
    -------
    Shading

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, or as :func:`plan`.

    Notes
    -----
    The absolute error of the diffuse and the specular term, for one light of intensity 1 and
    coefficients of 1, is within the bounds of :func:`vizlight.model.reflection.diffuse` and
    :func:`~vizlight.model.reflection.specular`; where points are and how long vectors are adds
    nothing, but k tangents multiply it by 1 over the sine of the angle between them. For
    ``model="cylinder"`` see :mod:`vizlight.model.cylinder`.
    Memory beyond the output: about 15 MB for each thread, whatever N.
    """
    points = _rows("points", points)
    if len(points.shape) != 2 or points.shape[1] < 2:
        raise ValueError(
            _check.message("points", "shape (N, n), n of 2 or more", f"shape {points.shape}")
        )
    count, n = points.shape
    rows, rest = divmod(count, _check.integer("repeat", repeat, low=1))
    if rest:
        raise ValueError(_check.message("repeat", f"a divisor of {count} points", repeat))
    k = None
    if tangents is not None:
        tangents = _rows("tangents", tangents)
        k = _tangent_count(tangents.shape, {count, rows}, n)
    if normals is not None:
        normals = _rows("normals", normals)
        if tuple(normals.shape) != (rows, n):
            raise ValueError(
                _check.message("normals", f"shape ({rows}, {n})", f"shape {normals.shape}")
            )
    spans = None
    if carrier is not None:
        carrier = _rows("carrier", carrier)
        spans = _tangent_count(carrier.shape, {rows}, n, "carrier")
    if (depth is None) == bool(options.get("fur")):
        raise ValueError(_check.message("depth", "depth and fur= together", "one of them"))
    if depth is not None:
        depth = _rows("depth", depth)
        if tuple(depth.shape) != (count,):
            raise ValueError(_check.message("depth", f"shape ({count},)", f"shape {depth.shape}"))
    if shadow is not None:
        shadow = _rows("shadow", shadow)
        bright = sum(light.intensity > 0 for light in scene.lights)
        if tuple(shadow.shape) != (count, bright) or normals is None:
            got = f"shape {tuple(shadow.shape)}" if normals is not None else "no normals"
            raise ValueError(_check.message("shadow", f"shape ({count}, {bright}), normals", got))
    if precision is None and not options.get("tolerance"):
        given = [rows.dtype for rows in (tangents, normals) if rows is not None]
        small = given and all(kind in (np.float16, np.float32) for kind in given)
        precision = "float32" if small else "float64"
    if precision not in (None, *get_args(Precision)):
        raise ValueError(_check.message("precision", "'float32' or 'float64'", repr(precision)))
    made = plan(
        scene,
        n=n,
        k=k,
        normals=normals is not None,
        carrier=spans,
        dtype=precision,
        shadowed=shadow is not None,
        **options,
    )

    start = time.perf_counter()
    output = Output(made, count)
    lit = Given(points, tangents, normals, carrier, depth, shadow, repeat)
    step = made.block if block is None else _check.integer("block", block, low=1)

    def work(block: slice) -> int:
        with np.errstate(all="ignore"):
            shade_block(made, block, lit, output)
        return int(block.stop) * repeat

    for done in _pool.run(work, _pool.blocks(rows, step), threads):
        if progress is not None:
            progress(done, count)
    shading = Shading(
        luminance=output.luminance,
        valid=output.valid,
        diffuse=output.diffuse,
        specular=output.specular,
        rgb=output.rgb,
        plan=made,
        seconds=time.perf_counter() - start,
    )
    if (observer := _OBSERVER.get()) is not None:
        observer(lit, scene, shading, options)
    return shading


def _rows(name: str, rows: Any) -> Any:
    """Return rows to slice: arrays validated, anything else that slices as it is."""
    if isinstance(rows, np.ndarray) or not hasattr(rows, "dtype"):
        array = np.asarray(rows)
        if array.dtype.kind not in "iubf":
            raise TypeError(_check.message(name, "real numbers", _check.describe(array)))
        return array
    return rows


def _tangent_count(shape: tuple[int, ...], counts: set[int], n: int, name: str = "tangents") -> int:
    if len(shape) == 3 and shape[0] in counts and shape[2] == n:
        k = shape[1]
    elif len(shape) == 2 and shape[0] in counts and shape[1] % n == 0:
        k = shape[1] // n
    else:
        k = 0
    if not 0 < k < n:
        count = " or ".join(str(number) for number in sorted(counts))
        raise ValueError(
            _check.message(
                name,
                f"shape ({count}, k, {n}) or ({count}, {n} k) with k < {n}",
                f"shape {tuple(shape)}",
            )
        )
    return k


def depth_range(points: Rows, scene: Scene, /, *, block: int = 1 << 17) -> tuple[float, float]:
    """Return the nearest and the farthest depth of finite points as the scene's view has it.

    Parameters
    ----------
    points : array_like, shape (N, n)
    scene : Scene
        With a view.
    block : int
        Points taken at once.

    Returns
    -------
    near, far : float
        In the unit of the points; (inf, -inf) if there is no point.
    """
    near, far = np.inf, -np.inf
    for start in range(0, points.shape[0], block):
        depth = view_depth(scene.view, columns(points, slice(start, start + block)))
        depth = depth[np.isfinite(depth)]
        if depth.size:
            near, far = min(near, float(depth.min())), max(far, float(depth.max()))
    return near, far
