"""Decide what a scene needs: the terms that are computed and nothing else."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, get_args

import numpy as np

from vizlight import _check
from vizlight.model import brightness
from vizlight.scene import Scene
from vizlight.shading import bounds, highlight
from vizlight.shading.options import Model
from vizlight.shading.plan import Plan
from vizlight.shading.tolerance import relax

if TYPE_CHECKING:
    from numpy.typing import DTypeLike


def plan(
    scene: Scene,
    /,
    *,
    n: int = 3,
    k: int | None = None,
    normals: bool = False,
    dtype: DTypeLike | None = None,
    model: Model = "phong",
    highlight_error: float = 0.0,
    tolerance: float = 0.0,
    compensate: bool = True,
    conditioned: bool = True,
    two_sided: bool = False,
    carrier: int | None = None,
    terminator: float = 0.0,
    shadowed: bool = False,
    fur: float = 0.0,
    components: bool = False,
) -> Plan:
    """Return the terms that a scene needs.

    Parameters
    ----------
    scene : Scene
    n : int, default: 3
        Dimension of the space.
    k : int, optional
        Number of tangents a point. None: the manifold is the surface that has the normals.
    normals : bool, default: False
        Whether normals are given. With k they may condition and attenuate the light.
    dtype : dtype, optional
        float32 or float64. Default: float64, or what ``tolerance`` allows.
    model : {"phong", "blinn", "cylinder"}
        The last for lines in 3-space alone: the exact line light.
    highlight_error : float, default: 0.0
        How far, in pixel values of 255, Phong's specular term may differ from what it is: where
        the half vector is the same at all points, Blinn's law with the best power then takes its
        place, light by light, while the errors' bounds, rounding included, add up to no more.
    tolerance : float, default: 0.0
        How far the luminance may be from that of the exact forms. The cheapest evaluation whose
        stated bound is within it is taken: float32, Blinn's law for Phong's, whole powers, the
        laws that a cylinder's light is a multiple of under headlights. Float64 is taken where
        rounding in float32 has no bound that holds for all data. 0: the exact forms.
    compensate : bool, default: True
        Diffuse with the exponent p(k, n) (Banks 5), else 1; nothing to a cylinder.
    conditioned : bool, default: True
        Tangents inherit the self-shadow of normals that are given (Banks 6).
    two_sided : bool, default: False
        Light the far side of normals as the near one.
    carrier : int, optional
        Tangents of the manifold that carries the field, how many a point: k or more, less than n.
    terminator : float, default: 0.0
        N.wi, up to 1, below which a one-sided surface's highlight fades smoothly to the
        terminator, where it otherwise ends sharply.
    shadowed : bool, default: False
        t of a cos-theta shadow is given for each light.
    fur : float, default: 0.0
        Density in [0, 1] of fur that attenuates the light (Banks 7, 8); needs normals.
    components : bool, default: False
        Keep the diffuse and the specular term.

    Raises
    ------
    TypeError
        If the scene is not a :class:`vizlight.Scene`.
    ValueError
        If the scene's vectors are not of n components, a view is needed and missing, an option
        is unknown, or the tolerance is less than the rounding of float32 that is asked for.
    """
    _check.instance("scene", scene, Scene)
    if model not in get_args(Model):
        raise ValueError(_check.message("model", "'phong', 'blinn' or 'cylinder'", repr(model)))
    highlight_error = _check.number("highlight_error", highlight_error, low=0.0)
    tolerance = _check.number("tolerance", tolerance, low=0.0)
    if tolerance and highlight_error:
        remedy = "it has the highlights' share in it"
        raise ValueError(
            _check.message("tolerance", "no highlight_error beside it", "both", remedy)
        )
    terminator = _check.number("terminator", terminator, low=0.0, high=1.0)
    kind = np.dtype(np.float64 if dtype is None else dtype)
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(_check.message("dtype", "float32 or float64", kind))
    n = _check.integer("n", n, low=2)
    if k is None and not normals:
        raise ValueError(
            _check.message("tangents", "tangents (k=) or normals (normals=True)", "neither")
        )
    if k is not None and not 0 < _check.integer("k", k, low=1) < n:
        raise ValueError(_check.message("k", f"fewer than n = {n} tangents a point", k))
    if model == "cylinder" and (k, n) != (1, 3):
        got = f"a surface of {n}-space" if k is None else f"{k} tangent(s) a point in {n}-space"
        remedy = "model='blinn' is its like for other manifolds"
        raise ValueError(_check.message("model", "lines in 3-space for 'cylinder'", got, remedy))
    if terminator and k is not None:
        remedy = "conditioned= shadows tangents smoothly"
        raise ValueError(_check.message("terminator", "0 beside tangents", terminator, remedy))
    if scene.n not in (None, n):
        raise ValueError(
            _check.message(
                "scene",
                f"vectors of {n} components, as the points have",
                f"{scene.n} components",
                f"for light in {scene.n}-space name the arrays by positions= and tangents=",
            )
        )
    material, cue = scene.material, scene.depth_cue
    if cue is not None and (cue.front is None or cue.back is None):
        raise ValueError(_check.message("depth_cue", "front= and back=", cue))

    surface = k is None
    size = n - 1 if k is None else k
    conditioned = bool(conditioned and normals and not surface)
    if carrier is not None and (k is None or normals):
        expected = "tangents (k=) and no normals beside it"
        raise ValueError(_check.message("carrier", expected, "normals" if normals else "neither"))
    if carrier is not None and not size <= _check.integer("carrier", carrier, low=1) < n:
        expected = f"from k = {size} to less than n = {n} tangents a point"
        raise ValueError(_check.message("carrier", expected, carrier))
    fur = _check.number("fur", fur, low=0.0, high=1.0)
    if fur and not normals:
        raise ValueError(_check.message("normals", "normals, across which fur stands", None))
    exponent = brightness.exponent(size, n) if compensate and model != "cylinder" else 1.0
    lights = tuple(light for light in scene.lights if light.intensity > 0)
    specular = bool(material.specular > 0 and lights)
    diffuse = bool(material.diffuse > 0 and lights)
    through_fur = bool(fur and diffuse)
    round_line = bool(model == "cylinder" and diffuse)
    if scene.view is None and (specular or through_fur or round_line or cue is not None):
        what = (
            "specular term" if specular
            else "fur" if through_fur
            else "cylinder's visible half" if round_line
            else "depth cue"
        )  # fmt: skip
        remedy = "pass view=, or Material(specular=0)" if specular else "pass view="
        raise ValueError(_check.message("view", f"a View, which the {what} needs", None, remedy))
    lights = tuple(light.seen_from(scene.view) for light in lights) if diffuse or specular else ()
    scene = scene.replace(lights=lights)
    exact = Plan(
        n=n,
        k=size,
        dtype=kind,
        scene=scene,
        exponent=exponent,
        model=model,
        highlights=highlight.choose(
            scene,
            model,
            highlight_error if specular else 0.0,
            partial(bounds.specular_bound, eps=float(np.finfo(kind).eps)),
        ),
        surface=surface,
        conditioned=conditioned,
        two_sided=bool(two_sided),
        carrier=carrier or 0,
        carrier_exponent=brightness.exponent(carrier, n) if carrier and compensate else 1.0,
        terminator=terminator,
        shadowed=bool(shadowed),
        fur=fur if diffuse or specular else 0.0,
        diffuse=diffuse,
        specular=specular,
        colored=scene.colored,
        components=bool(components),
    )
    return relax(exact, tolerance, any_precision=dtype is None) if tolerance else exact
