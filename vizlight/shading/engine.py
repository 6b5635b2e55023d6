"""The one seam for all shading: run a scene's plan over points, block by block.

Blocks fit the cache, run on a pool of threads and write into preallocated output, so that
memory beyond the output does not grow with the mesh.
"""

from __future__ import annotations

import contextlib
import contextvars
import dataclasses
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check, _compiled, _pool
from vizlight.model import kernels
from vizlight.scene import Scene
from vizlight.shading import compiled
from vizlight.shading.arrays import Output, columns, shade_block
from vizlight.shading.decide import decide, plan
from vizlight.shading.inputs import ArraySource, ShadingInputs, array_source
from vizlight.shading.options import Model, Precision, ShadingOptions, named
from vizlight.shading.plan import Plan

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import TypeAlias

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools
    from vizlight.scene import View
    from vizlight.shading.options import Exponent

    Observer: TypeAlias = Callable[[ShadingInputs, Scene, "Shading", ShadingOptions], None]
    Progress: TypeAlias = Callable[[int, int], None]

__all__ = [
    "ArraySource",
    "Model",
    "Plan",
    "Precision",
    "Shading",
    "ShadingInputs",
    "ShadingOptions",
    "depth_range",
    "observed",
    "plan",
    "run",
    "shade",
]


@dataclass(frozen=True, kw_only=True)
class Shading:
    """The light of N points, as :func:`shade` returns it.

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
        Colour where the scene has one; linear, not clipped at 1.
    plan : Plan
        What was computed.
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
        """Ambient term of points that nothing occludes, one number for all."""
        return self.plan.ambient

    @property
    def invalid(self) -> int:
        """Number of points that could not be lit."""
        return self.valid.size - int(np.count_nonzero(self.valid))

    def part(self, _: int, rows: slice, /) -> Shading:
        """Return the light of some points, with a share of the time."""
        return Shading(
            luminance=self.luminance[rows],
            valid=self.valid[rows],
            diffuse=None if self.diffuse is None else self.diffuse[rows],
            specular=None if self.specular is None else self.specular[rows],
            rgb=None if self.rgb is None else self.rgb[rows],
            plan=self.plan,
            seconds=self.seconds * (rows.stop - rows.start) / max(self.luminance.size, 1),
        )


_OBSERVER: contextvars.ContextVar[Observer | None] = contextvars.ContextVar(
    "observer", default=None
)


@contextlib.contextmanager
def observed(observer: Observer | None, /) -> Iterator[None]:
    """Call a function after each run of the engine while this context is entered.

    Parameters
    ----------
    observer : callable or None
        Function of the inputs, the scene, the :class:`Shading` and the options of a run; None
        for none.
    """
    _check.function("observer", observer, optional=True)
    token = _OBSERVER.set(observer)
    try:
        yield
    finally:
        _OBSERVER.reset(token)


@named
def shade(
    points: ArrayLike | ArraySource,
    tangents: ArrayLike | ArraySource | None,
    scene: Scene,
    /,
    *,
    normals: ArrayLike | ArraySource | None = None,
    base_tangents: ArrayLike | ArraySource | None = None,
    fur_height: ArrayLike | ArraySource | None = None,
    fur: float = 0.0,
    shadow: ArrayLike | ArraySource | None = None,
    transmittance: ArrayLike | ArraySource | None = None,
    occlusion: ArrayLike | ArraySource | None = None,
    two_sided: bool = False,
    repeat: int = 1,
    block: int | None = None,
    progress: Progress | None = None,
    exponent: Exponent = "compensated",
    model: Model = "phong",
    conditioned: bool | str | None = True,
    components: bool = False,
    precision: Precision | None = None,
) -> Shading:
    """Light points by a scene.

    Parameters
    ----------
    points : array_like, shape (N, n)
        Positions, in any unit and of any real type, or an object with ``shape`` and ``dtype``
        that gives rows by slice. Differences to lights and eye are exact to rounding of the
        result, also far from the origin.
    tangents : array_like, shape (N, k, n) or (N, k n) or (N, n), or None
        Vectors that span the tangent space, of any length; they are orthonormalised block by
        block. None: the manifold is the surface that has the normals.
    scene : Scene
    normals : array_like, shape (M, n), optional
        Outward normals, of any length. With tangents they condition the light (Banks 6).
    base_tangents : array_like, shape (M, j, n) or (M, j n), optional
        In place of normals, where codimension 2 or more has none: vectors that span the manifold
        in which the tangents lie. Diffuse and specular term of each light are multiplied by its
        own brightness ``sin(a)^p(j, n)``.
    fur_height : array_like, shape (N,), optional
        Height of the fur above each point, across the surface; with ``fur=``.
    fur : float, default: 0.0
        Density in [0, 1] of the fur that attenuates the light (Banks 7, 8); needs normals.
    shadow : array_like, shape (N, L), optional
        t of the cos-theta shadow for each of the L lights of intensity above 0. It takes the
        place of the cosine of normals in the diffuse term and where they condition; the highlight
        of a surface keeps ``min(1, t / cos)``.
    transmittance : array_like, shape (N, L), optional
        Share of each of the L lights of intensity above 0 that reaches a point, a factor of its
        diffuse and its specular term.
    occlusion : array_like, shape (N,), optional
        Share of the ambient light that reaches a point: 1 for a point that is open to all sides.
    two_sided : bool, default: False
        Whether the normals have no side: the surface is lit by ``|N . wi|``.
    repeat : int, default: 1
        Number of points, one after the other, that share a normal, such as the points of a fibre:
        N = M repeat. Tangents have N rows or M. What depends on the row alone is computed once.
    block : int, optional
        Number of rows in a block. Default: what suits the caches, see :attr:`Plan.block`.
    progress : callable, optional
        Function that is called from the caller's thread as ``progress(points done, N)`` after
        each block.
    exponent : float or "compensated"
        Exponent of the diffuse term, above 0 and up to 1e6. ``"compensated"`` is p(k, n), which
        gives lines the contrast of a surface (Banks 5); 1 is the plain law; under lamps of several
        colours in the picture plane 2 makes hue a code of direction. It has no effect on a
        cylinder.
    model : {"phong", "blinn", "cylinder"}
        Reflection model of the highlight. ``"cylinder"``, for lines in 3-space, is the exact light
        of a thin cylinder, diffuse and specular (Blinn's), by which the others are measured. As a
        mean over the width it is dimmer than the brightest normal of a line: raise the
        coefficients.
    conditioned : bool or str
        Whether tangents inherit the self-shadow of the surface that the normals belong to
        (Banks 6).
    components : bool, default: False
        Whether the terms ``ambient``, ``diffuse`` and ``specular`` are kept, before any depth cue.
    precision : {"float32", "float64"}, optional
        Precision of the work and the result. Default: the precision of the tangents or normals.

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
    :func:`~vizlight.model.reflection.specular`. Places of points and lengths of vectors add
    nothing to it, but k tangents multiply it by 1 over the sine of the angle between them. For
    ``model="cylinder"`` see :mod:`vizlight.model.cylinder`.
    With numba installed (extra ``fast``) compiled code lights the points where it pays for its
    start-up, within the same bounds; it rounds otherwise than NumPy.
    Memory beyond the output: about 15 MB for each thread, whatever N; 1 MB by compiled code.
    """
    inputs = ShadingInputs(
        points=array_source("points", points),
        tangents=None if tangents is None else array_source("tangents", tangents),
        normals=None if normals is None else array_source("normals", normals),
        base_tangents=(
            None if base_tangents is None else array_source("base_tangents", base_tangents)
        ),
        fur_height=None if fur_height is None else array_source("fur_height", fur_height),
        fur=fur,
        shadow=None if shadow is None else array_source("shadow", shadow),
        transmittance=(
            None if transmittance is None else array_source("transmittance", transmittance)
        ),
        occlusion=None if occlusion is None else array_source("occlusion", occlusion),
        two_sided=two_sided,
        repeat=repeat,
    )
    chosen = ShadingOptions.of(locals())
    return run(inputs, scene, chosen, block=block, progress=progress)


def run(
    inputs: ShadingInputs,
    scene: Scene,
    options: ShadingOptions,
    /,
    *,
    block: int | None = None,
    progress: Progress | None = None,
) -> Shading:
    """Light the points of some inputs; see :func:`shade`.

    Parameters
    ----------
    inputs : ShadingInputs
        Arrays of one mesh.
    scene : Scene
        Scene in the space of the points, before ``inputs.origin`` was subtracted.
    options : ShadingOptions
        How light is computed.
    block, progress
        As for :func:`shade`.

    Returns
    -------
    Shading

    Raises
    ------
    TypeError, ValueError
        As :func:`shade`.
    """
    _check.instance("scene", scene, Scene)
    _check.instance("inputs", inputs, ShadingInputs, home="engine")
    _check.instance("options", options, ShadingOptions, home="engine")
    _check.function("progress", progress, optional=True)
    inputs.check(sum(light.intensity > 0 for light in scene.lights))
    # Points far from the origin are stored less a near one; lights and eye move with them, so that
    # differences keep their digits.
    if inputs.origin is not None:
        scene = scene.moved([-x for x in inputs.origin])
    if options.precision is None:
        precision: Precision = "float32" if inputs.narrow else "float64"
        options = dataclasses.replace(options, precision=precision)
    made = decide(scene, inputs.layout, options, narrow=inputs.narrow)
    start = time.perf_counter()
    count, repeat = inputs.count, inputs.repeat
    output = Output(made, count)
    # Compiled code where numba is there and the points are many enough to pay for its start-up.
    code, reason = compiled.prepare(made, inputs)
    made = dataclasses.replace(made, compiled=code is not None, code=reason or compiled.IN_WORDS)
    light = shade_block if code is None else code.shade_block
    step = _step(made, inputs) if block is None else _check.integer("block", block, low=1)

    def work(rows: slice) -> int:
        # Overflow and NaN of single points are wanted: the terms mark them instead of warning.
        with np.errstate(all="ignore"):
            light(made, rows, inputs, output)
        return int(rows.stop) * repeat

    for done in _pool.run(work, _pool.blocks(inputs.rows, step)):
        if progress is not None:
            progress(done, count)
    # The compiler may have failed at the first block, which NumPy then has lit.
    if code is not None and (reason := _compiled.why_not()):
        made = dataclasses.replace(made, compiled=False, code=reason)
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
        # An open report looks at each run, whichever filter began it.
        observer(inputs, scene, shading, options)
    return shading


def _step(plan: Plan, inputs: ShadingInputs) -> int:
    """Return the rows of a block: all blocks have about one size, as a small one costs as much."""
    # Ceiling of the number of blocks first, then rows shared out evenly among them.
    count = -(-inputs.rows // max(plan.block // inputs.repeat, 1))
    return max(-(-inputs.rows // max(count, 1)), 1)


def depth_range(
    points: ArraySource, scene: Scene, /, *, block: int = 1 << 17
) -> tuple[float, float]:
    """Return the nearest and the farthest depth of finite points, along the view of a scene.

    Parameters
    ----------
    points : array_like, shape (N, n)
    scene : Scene
        Scene with a view.
    block : int
        Number of points that are taken at once.

    Returns
    -------
    near, far : float
        Depths in the unit of the points; (inf, -inf) if there is no point.

    Raises
    ------
    TypeError, ValueError
        If the points are not real numbers of shape (N, n), or the scene has no view in n-space.
    """
    _check.instance("scene", scene, Scene)
    if scene.view is None:
        raise ValueError(_check.message("scene", "a view, from which depth is measured", None))
    points = array_source("points", points)
    n = len(scene.view.position or scene.view.direction or ())
    if len(points.shape) != 2 or points.shape[1] != n:
        raise ValueError(_check.message("points", f"shape (N, {n})", f"shape {points.shape}"))
    # In blocks: points may be made on demand, and a copy in float64 would take twice their memory.
    block = _check.integer("block", block, low=1)
    near, far = np.inf, -np.inf
    for start in range(0, points.shape[0], block):
        depth = _depth(scene.view, columns(points, slice(start, start + block)))
        depth = depth[np.isfinite(depth)]
        if depth.size:
            near, far = min(near, float(depth.min())), max(far, float(depth.max()))
    return near, far


def _depth(view: View, points: Array) -> Array:
    """Return the depth of points: along the axis of the view, or from the eye without an axis."""
    origin = np.array(view.position or np.zeros(len(points)), dtype=np.float64)[:, np.newaxis]
    if view.direction is None:
        # A view by its position alone has no axis.
        return kernels.length(points - origin)
    axis, _ = kernels.unit(np.array(view.direction, dtype=np.float64)[:, np.newaxis])
    return kernels.dot(axis, origin - points)
