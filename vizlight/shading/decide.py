"""Decide what a scene needs: the terms that are computed and nothing else."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.model import brightness, kernels
from vizlight.scene import Scene, View
from vizlight.shading import compiled
from vizlight.shading.inputs import Layout
from vizlight.shading.options import ShadingOptions, named
from vizlight.shading.plan import Highlight, Plan

if TYPE_CHECKING:
    from numpy.typing import DTypeLike

    from vizlight._types import Vector
    from vizlight.shading.options import Exponent, Model, Precision


#: Least power at which |h_N|^q may be computed from the tangential part alone: a lower one is too
#: steep at 0.
LEAST_POWER = 2.0


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
    """Return what the light of a scene needs.

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
    made = decide(scene, layout, ShadingOptions.of(locals()), dtype)
    return dataclasses.replace(made, code=compiled.why_not(made) or compiled.WHERE_IT_PAYS)


def decide(
    scene: Scene,
    layout: Layout,
    options: ShadingOptions,
    dtype: DTypeLike | None = None,
    *,
    narrow: bool = False,
) -> Plan:
    """Return the plan for inputs of a layout; see :func:`plan`.

    Inputs that are ``narrow`` have no more digits than float32.
    """
    _check.instance("scene", scene, Scene)
    dtype = options.precision if dtype is None else dtype
    kind = _precision((np.float32 if narrow else np.float64) if dtype is None else dtype)
    _check_layout(layout, options)
    _check_scene(scene, layout.n)
    n, surface = layout.n, layout.k is None
    k = n - 1 if layout.k is None else layout.k
    unseen = scene.view is None
    scene, diffuse, specular = _needed(scene, layout)
    return Plan(
        n=n,
        k=k,
        dtype=kind,
        scene=scene,
        options=options,
        exponent=1.0 if options.model == "cylinder" else _exponent(options, k, n),
        model=options.model,
        highlights=_highlights(scene, options.model),
        surface=surface,
        two_sided=layout.two_sided,
        conditioned=bool(options.conditioned and layout.normals and not surface),
        base=layout.base,
        base_exponent=(
            brightness.exponent(layout.base, n)
            if layout.base and options.exponent == "compensated"
            else 1.0
        ),
        line_exponent=_exponent(options, 1, n) if layout.mixed else None,
        shadowed=layout.shadowed,
        dimmed=layout.dimmed and (diffuse or specular),
        occluded=layout.occluded,
        fur=layout.fur if diffuse or specular else 0.0,
        diffuse=diffuse,
        specular=specular,
        unseen=unseen,
    )


def _highlights(scene: Scene, model: Model) -> tuple[Highlight, ...]:
    """Return how the highlight of each light is computed.

    Where light and eye are at infinity all points share the half vector. Blinn's model then needs
    no split of the eye.
    """
    shininess = scene.material.shininess
    fixed = model == "blinn" and shininess >= LEAST_POWER
    return tuple(
        Highlight(model, shininess, _half(scene, i) if fixed else None)
        for i in range(len(scene.lights))
    )


def _half(scene: Scene, index: int) -> Vector | None:
    """Return the half vector that all points share, or None."""
    light, view = scene.lights[index], scene.view
    if view is None or not view.parallel or light.direction is None or view.direction is None:
        return None
    unit, _ = kernels.unit(np.array([light.direction, view.direction], dtype=np.float64).T)
    both = unit[:, 0] + unit[:, 1]
    size = float(np.linalg.norm(both))
    # Of nearly opposite directions the half vector is mere rounding.
    return None if size < 1e-6 else tuple((both / size).tolist())


def _needed(scene: Scene, layout: Layout) -> tuple[Scene, bool, bool]:
    """Return the scene with a view and the lights that have an effect, and the terms they need."""
    lights = tuple(light for light in scene.lights if light.intensity > 0)
    specular = bool(scene.material.specular > 0 and lights and scene.view is not None)
    diffuse = bool(scene.material.diffuse > 0 and lights)
    view = View.isometric(layout.n) if scene.view is None else scene.view
    fixed = tuple(light.seen_from(view) for light in lights) if diffuse or specular else ()
    return scene.replace(lights=fixed, view=view), diffuse, specular


def _exponent(options: ShadingOptions, k: int, n: int) -> float:
    """Return the exponent of the diffuse term of a k-manifold in n-space."""
    if isinstance(options.exponent, str):
        return brightness.exponent(k, n)
    return options.exponent


def _precision(dtype: DTypeLike) -> np.dtype[np.floating]:
    for kind in (np.dtype(np.float32), np.dtype(np.float64)):
        # Comparison refuses what is no type.
        if isinstance(dtype, str | type | np.dtype) and kind == dtype:
            return kind
    raise ValueError(_check.message("dtype", "float32 or float64", _check.describe(dtype)))


def _check_layout(layout: Layout, options: ShadingOptions) -> None:
    """Check that tangents, normals and options go together."""
    n, k, normals, base, _, fur, *_ = layout
    if k is None and not normals:
        raise ValueError(
            _check.message("tangents", "tangents (k=) or normals (normals=True)", "neither")
        )
    if k is not None and not 0 < _check.integer("k", k, low=1) < n:
        raise ValueError(_check.message("k", f"fewer than n = {n} tangents per point", k))
    if options.model == "cylinder" and (k, n) != (1, 3):
        got = f"a surface of {n}-space" if k is None else f"{k} tangent(s) per point in {n}-space"
        raise ValueError(not_a_line(got))
    if base and (k is None or normals):
        expected = "tangents (k=) and no normals beside it"
        got = "normals" if normals else "neither"
        raise ValueError(_check.message("base_tangents", expected, got))
    if base and not (n - 1 if k is None else k) <= base < n:
        expected = f"from k = {k} to less than n = {n} tangents per point"
        raise ValueError(_check.message("base_tangents", expected, base))
    if _check.number("fur", fur, low=0.0, high=1.0) and not normals:
        raise ValueError(_check.message("normals", "normals, across which fur stands", None))


def not_a_line(got: str) -> str:
    """Return the message for a cylinder's light on what is not a line in 3-space."""
    remedy = "use model='blinn' for other manifolds"
    return _check.message("model", "lines in 3-space for 'cylinder'", got, remedy)


def _check_scene(scene: Scene, n: int) -> None:
    """Check that the scene fits points of n components."""
    if scene.n not in (None, n):
        raise ValueError(
            _check.message(
                "scene",
                f"vectors of {n} components, as the points have",
                f"{scene.n} components",
                f"for light in {scene.n}-space name the arrays by positions= and tangents=",
            )
        )
    if scene.view is None and scene.depth_cue is not None:
        expected, remedy = "a View, which the depth cue needs", "pass view= to the Scene"
        raise ValueError(_check.message("view", expected, None, remedy))
    cue = scene.depth_cue
    if cue is not None and (cue.front is None or cue.back is None):
        raise ValueError(_check.message("depth_cue", "front= and back=", cue))
