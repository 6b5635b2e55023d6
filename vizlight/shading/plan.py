"""What is computed for a scene: the terms that it needs and nothing else, also in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from vizlight.model.kernels import DEFICIT_FROM
from vizlight.scene.light import NO_ATTENUATION

if TYPE_CHECKING:
    import numpy as np

    from vizlight._types import Vector
    from vizlight.scene import Scene
    from vizlight.shading.options import Model

#: Bytes of a block's tangents. Some ten times as much is alive at once: small enough for the last
#: cache, large enough that threads seldom wait for the interpreter.
BLOCK_BYTES = 3 << 19


class Highlight(NamedTuple):
    """The highlight of one light.

    Attributes
    ----------
    model : {"phong", "blinn", "cylinder"}
        The law that is computed.
    shininess : float
        Its power.
    half : vector or None
        The unit half vector, where it is the same at all points and used as such.
    error : float
        The most that this law differs from the one asked for, in pixel values of 255 and with
        coefficient and intensity, the rounding of both included; 0 where it is the one asked for.
    refused : float
        The error of Blinn's law, where it was not used because that is too much.
    """

    model: Model
    shininess: float
    half: Vector | None = None
    error: float = 0.0
    refused: float = 0.0


@dataclass(frozen=True)
class Choice:
    """What was chosen within a tolerance, in words, and the bound of all of it together.

    Attributes
    ----------
    tolerance : float
        That was asked for, 0 for the exact forms.
    bound : float
        The most that the luminance of a valid point differs from the exact forms; infinity where
        rounding has no bound within the tolerance that holds for all data.
    said, unsaid : tuple of str
        What was taken and what was not.
    """

    tolerance: float = 0.0
    bound: float = math.inf
    said: tuple[str, ...] = ()
    unsaid: tuple[str, ...] = ()


EXACT = Choice()


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is computed for each point of a mesh; made by :func:`vizlight.engine.plan`.

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
    highlights: tuple[Highlight, ...]
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
    choice: Choice = EXACT

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
