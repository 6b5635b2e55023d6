"""The one seam for all shading: run a scene's plan over points, block by block.

Blocks fit the cache, run on a pool of threads and write into preallocated output, so that
memory beyond the output does not grow with the mesh.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from vizlight import _check, _pool
from vizlight._types import Array, Exponent, Keywords, Model, Precision, Slice
from vizlight.model import kernels
from vizlight.scene import Scene, View
from vizlight.scene.keywords import named
from vizlight.shading.arrays import Shading, columns, shade_block
from vizlight.shading.inputs import ArraySource, Layout, ShadingInputs, array_source
from vizlight.shading.options import ShadingOptions
from vizlight.shading.plan import Plan, decide

Progress: TypeAlias = Callable[[int, int], None]

__all__ = [
    "ArraySource", "Model", "Plan", "Precision", "Shading", "ShadingInputs", "ShadingOptions",
    "depth_range", "plan", "run", "shade",
]  # fmt: skip


@named
def plan(
    scene: Scene,
    /,
    *,
    n: int = 3,
    k: int | None = None,
    normals: bool = False,
    two_sided: bool = False,
    dtype: DTypeLike | None = None,
    base_tangents: int | None = None,
    shadowed: bool = False,
    fur: float = 0.0,
    exponent: Exponent = "compensated",
    model: Model = "phong",
    conditioned: bool | str | None = True,
    components: bool = False,
    precision: Precision | None = None,
) -> Plan:
    """Return the plan of the light of a scene.

    Parameters
    ----------
    scene : Scene
    n : int, default: 3
        Dimension of the space.
    k : int, optional
        Number of tangents per point. None: the manifold is the surface that has the normals.
    normals : bool, default: False
        Whether normals are given. With k they may condition and attenuate the light.
    two_sided : bool, default: False
        Whether the normals have no side: the surface is lit by ``|N . wi|``.
    dtype : dtype, optional
        float32 or float64. Default: ``precision``, else float64.
    base_tangents : int, optional
        Number of base tangents per point, k or more and less than n: the frame of the manifold in
        which the tangents lie.
    shadowed : bool, default: False
        Whether t of a cos-theta shadow is given for each light.
    fur : float, default: 0.0
        Density in [0, 1] of fur that attenuates the light (Banks 7, 8); needs normals.
    exponent, model, conditioned, components, precision
        As for :func:`vizlight.shading.engine.shade`.

    Returns
    -------
    Plan

    Raises
    ------
    TypeError
        If the scene is not a :class:`vizlight.Scene`, or a keyword is unknown.
    ValueError
        If the vectors of the scene do not have n components, a depth cue has no view, or an
        option does not fit.
    """
    n = _check.integer("n", n, low=2, high=int(_check.LARGEST))
    normals = _check.boolean("normals", normals)
    shadowed = _check.boolean("shadowed", shadowed)
    fur = _check.number("fur", fur, low=0.0, high=1.0)
    if base_tangents is not None:
        base_tangents = _check.integer("base_tangents", base_tangents, low=1)
    layout = Layout(
        n, k, normals, base_tangents or 0, shadowed, fur,
        two_sided=_check.boolean("two_sided", two_sided),
    )  # fmt: skip
    return decide(scene, layout, ShadingOptions.of(locals()), dtype)


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
        N = M repeat. Tangents have N rows or M. Work on a row alone is done once.
    block : int, optional
        Number of rows in a block. Default: a number that suits the caches, see :attr:`Plan.block`.
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
    Memory beyond the output: about 15 MB for each thread, whatever N.
    """
    chosen = ShadingOptions.of(locals())
    optional = {
        "tangents": tangents, "normals": normals, "base_tangents": base_tangents,
        "fur_height": fur_height, "shadow": shadow, "transmittance": transmittance,
        "occlusion": occlusion,
    }  # fmt: skip
    there: Keywords = {name: array_source(name, x) for name, x in optional.items() if x is not None}
    at = array_source("points", points)
    repeat = _check.integer("repeat", repeat, low=1)
    inputs = ShadingInputs(points=at, fur=fur, two_sided=two_sided, repeat=repeat, **there)
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
        Options of the light.
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
    # Vectors of float32 have no digits that light in float32 would lose.
    if options.precision is None:
        precision: Precision = "float32" if inputs.narrow else "float64"
        options = dataclasses.replace(options, precision=precision)
    # Only the structure of the inputs decides, not their values, so that all blocks share one plan.
    decided = decide(scene, inputs.layout, options)
    start = time.perf_counter()
    count, repeat = inputs.count, inputs.repeat
    shading = Shading.of(decided, count)
    step = _step(decided, inputs) if block is None else _check.integer("block", block, low=1)

    def work(rows: Slice) -> int:
        # Overflow and NaN of single points are wanted: the terms mark them instead of warning.
        with np.errstate(all="ignore"):
            shade_block(decided, rows, inputs, shading)
        return int(rows.stop) * repeat

    for done in _pool.run(work, _pool.blocks(inputs.rows, step)):
        if progress is not None:
            progress(done, count)
    return dataclasses.replace(shading, seconds=time.perf_counter() - start)


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
        Depths in the unit of the points; (inf, -inf) without points.

    Raises
    ------
    TypeError, ValueError
        If the points are not real numbers of shape (N, n), or the scene has no view in n-space.
    """
    _check.instance("scene", scene, Scene)
    if scene.view is None:
        raise _check.value_error("scene", "a view, from which depth is measured", None)
    points = array_source("points", points)
    n = len(scene.view.position or scene.view.direction or ())
    if len(points.shape) != 2 or points.shape[1] != n:
        raise _check.value_error("points", f"shape (N, {n})", f"shape {points.shape}")
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
    # In float64, since differences of points far from the origin would lose digits.
    origin = np.array(view.position or np.zeros(len(points)), dtype=np.float64)[:, np.newaxis]
    if view.direction is None:
        # A view by its position alone has no axis.
        return kernels.length(points - origin)
    axis, _ = kernels.unit(np.array(view.direction, dtype=np.float64)[:, np.newaxis])
    # The direction of a view is toward the eye, so that depth grows away from it.
    return kernels.dot(axis, origin - points)
