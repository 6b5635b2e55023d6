"""Decide what a scene needs: the terms that are computed and nothing else."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from vizlight import _check, _highlight, _tolerance
from vizlight.light import NO_ATTENUATION
from vizlight.model import brightness
from vizlight.model._kernels import DEFICIT_FROM
from vizlight.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import DTypeLike

Model = Literal["phong", "blinn", "cylinder"]
#: Bytes of a block's tangents. Some ten times as much is alive at once: small enough for the last
#: cache, large enough that threads seldom wait for the interpreter.
BLOCK_BYTES = 3 << 19


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is computed for each point of a mesh; made by :func:`plan`.

    Attributes
    ----------
    n, k : int
        Dimension of the space and of the manifold that is lit.
    dtype : numpy.dtype
        Precision of the work and of the result.
    scene : Scene
        With headlights fixed and lights that give nothing left out.
    exponent : float
        Of the diffuse term.
    model : {"phong", "blinn", "cylinder"}
        That was asked for: of the specular term, for a cylinder also of the diffuse one.
    highlights : tuple of Highlight
        How each light's specular term is computed, and what that costs in error.
    surface : bool
        Whether the manifold is given by its normals (k = n - 1), not by tangents.
    conditioned : bool
        Whether tangents inherit the self-shadow of the surface that the normals belong to.
    two_sided : bool
        Whether the far side of normals is lit as the near one.
    carrier : int
        Dimension of the manifold that the tangents lie in and whose own brightness is a factor,
        0 for none.
    carrier_exponent : float
        Of that factor.
    terminator : float
        N.wi below which a surface's highlight fades, 0 for a sharp end.
    shadowed : bool
        Whether t of the cos-theta shadow takes the place of the cosine of normals.
    fur : float
        Density of the fur that light passes on its way in and out, 0 for none.
    diffuse, specular : bool
        Whether the term is computed.
    colored, components : bool
        Which results are kept.
    factors : tuple of float
        Of the diffuse and the specular coefficient; not 1 where a law stands for its multiple.
    choice : Choice
        What was chosen within ``tolerance=``, and its bound.
    """

    n: int
    k: int
    dtype: np.dtype[Any]
    scene: Scene
    exponent: float
    model: Model
    highlights: tuple[_highlight.Highlight, ...]
    surface: bool
    conditioned: bool
    two_sided: bool
    carrier: int
    carrier_exponent: float
    terminator: float
    shadowed: bool
    fur: float
    diffuse: bool
    specular: bool
    colored: bool
    components: bool
    factors: tuple[float, float] = (1.0, 1.0)
    choice: _tolerance.Choice = _tolerance.EXACT

    @property
    def terms(self) -> tuple[str, ...]:
        """The names of the terms that are added up."""
        names = {"ambient": True, "diffuse": self.diffuse, "specular": self.specular}
        return tuple(name for name, there in names.items() if there)

    @property
    def ambient(self) -> float:
        """The ambient term, one number for all points."""
        return self.scene.material.ambient * self.scene.ambient_intensity

    @property
    def needs_points(self) -> bool:
        """Whether anything depends on where a point is."""
        view = self.scene.view
        return (
            any(light.position is not None for light in self.scene.lights)
            or (self.needs_eye and view is not None and not view.parallel)
            or self.scene.depth_cue is not None
        )

    @property
    def needs_eye(self) -> bool:
        """Whether anything depends on where the eye is."""
        return self.splits_eye or (self.fur > 0 and self.diffuse)

    @property
    def splits_eye(self) -> bool:
        """Whether a term depends on how the eye stands to the manifold, at each point."""
        if self.model == "cylinder":
            return self.specular or self.diffuse
        return self.specular and any(h.half is None for h in self.highlights)

    @property
    def highlight_error(self) -> float:
        """The most that the specular term differs from the model asked for, of 255, rounded."""
        return sum(h.error for h in self.highlights)

    @property
    def block(self) -> int:
        """Points in a block, unless the caller says."""
        return max(BLOCK_BYTES // (self.n * self.k * self.dtype.itemsize), 1)

    def why_not(self, term: str) -> str:
        """Say why the diffuse or the specular term is left out."""
        if getattr(self.scene.material, term) == 0:
            return f"material.{term} is 0"
        return "no light has an intensity above 0"

    def explain(self) -> str:
        """Say what is computed, what is skipped and why, a line each."""
        computed, skipped = _words(self)
        return "\n".join(
            [f"compute  {line}" for line in computed] + [f"skip     {line}" for line in skipped]
        )


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
        highlights=_highlight.choose(
            scene,
            model,
            highlight_error if specular else 0.0,
            partial(_tolerance.specular_bound, eps=float(np.finfo(kind).eps)),
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
    return _tolerance.relax(exact, tolerance, any_precision=dtype is None) if tolerance else exact


def surface_model(model: Model) -> Model:
    """Return the law of a surface's highlight beside lines of a model: a cylinder's is Blinn's."""
    return "blinn" if model == "cylinder" else model


def _words(plan: Plan) -> tuple[list[str], list[str]]:
    """Return what is computed and what is skipped, in words."""
    scene = plan.scene
    view, lights = scene.view, scene.lights
    yes, no = [f"ambient: the constant {plan.ambient:g}"], []
    if plan.surface:
        sides = "both sides alike" if plan.two_sided else "the outer side only"
        yes.append(f"surface: one unit normal a point, lit on {sides}")
        no.append("frame: a surface is lit by its normals, no tangents are needed")
        law = "|N.wi|" if plan.two_sided else "max(0, N.wi)"
    else:
        yes.append(
            f"frame: {plan.k} orthonormal tangent(s) a point in {plan.n}-space, "
            f"codimension {plan.n - plan.k}"
        )
        law = "|wi_N|"
    if plan.diffuse and plan.shadowed and plan.surface:
        yes.append("diffuse: t = d/r of the cos-theta shadow in place of the cosine")
    elif plan.diffuse and plan.model == "cylinder":
        yes.append("diffuse: Lambert's law averaged over the visible half of a thin cylinder")
        no.append("compensation: the round of a cylinder has it in the mean")
    elif plan.diffuse:
        yes.append(f"diffuse: {law} to the power {plan.exponent:.6g}")
    else:
        no.append(f"diffuse: {plan.why_not('diffuse')}")
    if plan.specular and view is not None:
        said, unsaid = _highlight_words(plan)
        yes += said
        no += unsaid
        if view.parallel:
            no.append("eye: no direction a point, the parallel view has one for all")
        else:
            yes.append("eye: its direction and split once a point, shared by all lights")
    else:
        no.append(f"specular: {plan.why_not('specular')}")
        if not plan.needs_eye:
            no.append("eye: no term of the light depends on the view")
    for i, light in enumerate(lights):
        near = light.position is not None
        kind = "a direction a point" if near else "one direction for all points"
        yes.append(f"light {i}: {kind}, intensity {light.intensity:g}")
        if light.attenuation != NO_ATTENUATION:
            yes.append(f"light {i}: attenuation {light.attenuation} of the distance")
        elif near:
            no.append(f"light {i}: attenuation, its coefficients are {NO_ATTENUATION}")
    if plan.conditioned:
        side = "|N.wi|" if plan.two_sided else "max(0, N.wi)"
        side = "t = d/r in place" if plan.shadowed else side
        yes.append(f"self-shadow: {side} of the surface's normals, a factor for each light")
    elif plan.carrier:
        yes.append(
            f"carrier: brightness |wi_N| to the power {plan.carrier_exponent:.6g} of the "
            f"{plan.carrier}-manifold that the tangents lie in, a factor for each light"
        )
    elif not plan.surface:
        no.append("self-shadow: no surface conditions the tangents")
    if plan.terminator:
        yes.append(f"terminator: highlights fade smoothly below N.wi = {plan.terminator:g}")
    if plan.fur:
        yes.append(f"fur: density {plan.fur:g}, on the way in for each light and out once")
    if scene.depth_cue is not None:
        yes.append(f"depth cue: {'smooth' if scene.depth_cue.smooth else 'linear'}")
    else:
        no.append("depth cue: none asked for")
    if plan.colored:
        yes.append("rgb: three channels")
    else:
        no.append("rgb: nothing in the scene has a colour")
    if plan.choice.tolerance:
        yes += plan.choice.said
        no += plan.choice.unsaid
        asked = f"tolerance: {plan.choice.tolerance:.3g} of luminance"
        met = math.isfinite(plan.choice.bound)
        none = "rounding has no bound within it here"
        yes.append(
            f"{asked}, the bound of all is {plan.choice.bound:.3g}" if met else f"{asked}: {none}"
        )
    return yes, no


def _highlight_words(plan: Plan) -> tuple[list[str], list[str]]:
    """Return in words how highlights are computed, and what was not taken for them."""
    yes, no = [], []
    shininess = plan.scene.material.shininess
    own = [h for h in plan.highlights if h.model == plan.model]
    if own:
        shininess = own[0].shininess
        if plan.model == "cylinder":
            how = "averaged over the visible half of a thin cylinder"
        else:
            power = shininess / 2 if plan.model == "blinn" else shininess
            multiplies = power == int(power) and power <= DEFICIT_FROM
            how = "by multiplication" if multiplies else "by a power"
        yes.append(f"specular: {plan.model}, shininess {shininess:g} {how}")
    fixed = sum(h.half is not None for h in own)
    if fixed:
        yes.append(f"half vector: one for all points for {fixed} light(s)")
    for i, h in enumerate(plan.highlights):
        if h.model != plan.model:
            yes.append(
                f"light {i}: Blinn's law of power {h.shininess:.6g} for {plan.model}'s of "
                f"{shininess:g}, one half vector for all points, "
                f"within {h.error:.3g} of 255"
            )
        elif h.refused:
            no.append(
                f"light {i}: Blinn's law in place of {plan.model}'s, "
                f"it would differ by up to {h.refused:.3g} of 255"
            )
    if plan.highlight_error:
        yes.append(f"specular: in all within {plan.highlight_error:.3g} of 255 of {plan.model}'s")
        if not plan.splits_eye:
            no.append("eye: no split a point, all half vectors are fixed")
    return yes, no
