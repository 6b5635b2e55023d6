"""What is computed for a scene: the terms that it needs and nothing else, also in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from vizlight.model.kernels import DEFICIT_FROM
from vizlight.scene.light import NO_ATTENUATION

if TYPE_CHECKING:
    import numpy as np

    from vizlight._types import Vector
    from vizlight.scene import Scene
    from vizlight.shading.options import Model, ShadingOptions

#: Bytes of a block's tangents. About ten times as much memory is in use at once: little enough for
#: the last cache, enough that threads seldom wait for the interpreter.
BLOCK_BYTES = 3 << 19


class Highlight(NamedTuple):
    """The highlight of one light.

    Attributes
    ----------
    model : {"phong", "blinn", "cylinder"}
        Reflection model that is computed.
    shininess : float
        Power of the model.
    half : vector or None
        Unit half vector, where it is the same at all points and used as such.
    """

    model: Model
    shininess: float
    half: Vector | None = None


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is computed for each point of a mesh; made by :func:`vizlight.shading.engine.plan`.

    Attributes
    ----------
    n, k : int
        Dimension of the space and of the manifold that is lit.
    dtype : numpy.dtype
        Precision of the work and of the result.
    scene : Scene
        Scene with a view, lights that follow it fixed, and without lights that have no effect.
    options : ShadingOptions
        Options that were asked for.
    exponent : float
        Exponent of the diffuse term.
    model : {"phong", "blinn", "cylinder"}
        Reflection model of the specular term, for a cylinder also of the diffuse one.
    highlights : tuple of Highlight
        Way in which the specular term of each light is computed.
    surface : bool
        Whether the manifold is given by its normals (k = n - 1), not by tangents.
    two_sided : bool
        Whether the normals have no side, so that both are lit alike.
    conditioned : bool
        Whether tangents inherit the self-shadow of the surface that the normals belong to.
    base : int
        Dimension of the manifold in which the tangents lie and whose brightness is a factor, 0 for
        none.
    base_exponent : float
        Exponent of that factor.
    line_exponent : float or None
        Exponent of the diffuse term of lines beside the faces; None where all points are lit as
        one kind.
    shadowed : bool
        Whether t of the cos-theta shadow takes the place of the cosine of normals.
    dimmed, occluded : bool
        Whether a share of each light, and of the ambient light, reaches each point.
    fur : float
        Density of the fur that light passes on its way in and out, 0 for none.
    diffuse, specular : bool
        Whether the term is computed.
    unseen : bool
        Whether the scene has no view: there is no highlight, and what else depends on the eye is
        as in :meth:`vizlight.View.isometric`.
    compiled : bool
        Whether compiled code has lit the points (extra ``fast``).
    code : str
        What runs the plan, or why it is not compiled code, in words.
    """

    n: int
    k: int
    dtype: np.dtype[np.floating]
    scene: Scene
    options: ShadingOptions
    exponent: float
    model: Model
    highlights: tuple[Highlight, ...]
    surface: bool
    two_sided: bool
    conditioned: bool
    base: int
    base_exponent: float
    shadowed: bool
    dimmed: bool
    occluded: bool
    fur: float
    diffuse: bool
    specular: bool
    line_exponent: float | None = None
    unseen: bool = False
    compiled: bool = False
    code: str = ""

    @property
    def components(self) -> bool:
        """Whether the terms are kept."""
        return self.options.components

    @property
    def colored(self) -> bool:
        """Whether the result has a colour."""
        return self.scene.colored

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of the terms that are added up."""
        names = {"ambient": True, "diffuse": self.diffuse, "specular": self.specular}
        return tuple(name for name, there in names.items() if there)

    @property
    def ambient(self) -> float:
        """Ambient term, one number for all points."""
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
        turned = self.line_exponent is not None and (self.diffuse or self.specular)
        return turned or self.splits_eye or (self.fur > 0 and self.diffuse)

    @property
    def splits_eye(self) -> bool:
        """Whether a term depends on how the eye stands to the manifold at each point."""
        if self.model == "cylinder":
            return self.specular or self.diffuse
        return self.specular and any(h.half is None for h in self.highlights)

    @property
    def block(self) -> int:
        """Number of points in a block, unless the caller gives one."""
        return max(BLOCK_BYTES // (self.n * self.k * self.dtype.itemsize), 1)

    def explain(self) -> str:
        """Return what is computed, what is skipped and why, one line each."""
        words = _Words()
        parts = (_manifold, _diffuse, _specular, _lights, _factors, _results, _code)
        for part in parts:
            part(self, words)
        return "\n".join(
            [f"compute  {line}" for line in words.computed]
            + [f"skip     {line}" for line in words.skipped]
        )


_ISOMETRIC = "eye: the scene has no view, so it is toward (1, ..., 1), at infinity"


class _Words:
    """Lines about what is computed and what is skipped."""

    def __init__(self) -> None:
        self.computed: list[str] = []
        self.skipped: list[str] = []

    def add(self, computed: str | None, skipped: str | None = None) -> None:
        if computed is not None:
            self.computed.append(computed)
        if skipped is not None:
            self.skipped.append(skipped)


def _why_not(plan: Plan, term: str) -> str:
    """Return why the diffuse or the specular term is skipped."""
    if getattr(plan.scene.material, term) == 0:
        return f"material.{term} is 0"
    if plan.unseen and plan.scene.lights:
        return "the scene has no view; pass view= to the Scene"
    return "no light has an intensity above 0"


def _manifold(plan: Plan, words: _Words) -> None:
    share = ", times the share of each point" if plan.occluded else ""
    words.add(f"ambient: the constant {plan.ambient:g}{share}")
    if plan.surface:
        sides = "both sides alike" if plan.two_sided else "the outer side only"
        words.add(
            f"surface: one unit normal per point, lit on {sides}",
            "frame: a surface is lit by its normals, no tangents are needed",
        )
        if plan.line_exponent is not None:
            words.add(
                "lines beside the faces: by their own tangents, diffuse |wi_N| to the power "
                f"{plan.line_exponent:.6g}; points of neither face the eye"
            )
    else:
        words.add(
            f"frame: {plan.k} orthonormal tangent(s) per point in {plan.n}-space, "
            f"codimension {plan.n - plan.k}"
        )


def _cosine(plan: Plan) -> str:
    return "|N.wi|" if plan.two_sided else "max(0, N.wi)"


def _diffuse(plan: Plan, words: _Words) -> None:
    if not plan.diffuse:
        words.add(None, f"diffuse: {_why_not(plan, 'diffuse')}")
    elif plan.shadowed and plan.surface:
        words.add("diffuse: t = d/r of the cos-theta shadow in place of the cosine")
    elif plan.model == "cylinder":
        words.add(
            "diffuse: Lambert's law averaged over the visible half of a thin cylinder",
            "compensation: the mean over the cylinder includes it",
        )
    else:
        base = _cosine(plan) if plan.surface else "|wi_N|"
        words.add(f"diffuse: {base} to the power {plan.exponent:.6g}")


def _specular(plan: Plan, words: _Words) -> None:
    view = plan.scene.view
    if not plan.specular or view is None:
        unneeded = None if plan.needs_eye else "eye: no term of the light depends on the view"
        words.add(_ISOMETRIC if plan.unseen and plan.needs_eye else None)
        words.add(None, f"specular: {_why_not(plan, 'specular')}")
        words.add(None, unneeded)
        return
    _highlights(plan, words)
    if view.parallel:
        words.add(None, "eye: the parallel view has one direction for all points")
    else:
        words.add("eye: its direction and split once per point, shared by all lights")


def _highlights(plan: Plan, words: _Words) -> None:
    """Add how highlights are computed."""
    shininess = plan.scene.material.shininess
    if plan.model == "cylinder":
        how = "averaged over the visible half of a thin cylinder"
    else:
        power = shininess / 2 if plan.model == "blinn" else shininess
        multiplies = power == int(power) and power <= DEFICIT_FROM
        how = "by multiplication" if multiplies else "by a power"
    words.add(f"specular: {plan.model}, shininess {shininess:g} {how}")
    fixed = sum(h.half is not None for h in plan.highlights)
    if fixed:
        words.add(f"half vector: one for all points for {fixed} light(s)")
    if not plan.splits_eye:
        words.add(None, "eye: no split per point, all half vectors are fixed")


def _lights(plan: Plan, words: _Words) -> None:
    for i, light in enumerate(plan.scene.lights):
        near = light.position is not None
        kind = "one direction per point" if near else "one direction for all points"
        words.add(f"light {i}: {kind}, intensity {light.intensity:g}")
        if light.attenuation != NO_ATTENUATION:
            words.add(f"light {i}: attenuation {light.attenuation} of the distance")
        elif near:
            words.add(None, f"light {i}: attenuation, its coefficients are {NO_ATTENUATION}")


def _factors(plan: Plan, words: _Words) -> None:
    """Add what multiplies the light of each light."""
    if plan.conditioned:
        side = "t = d/r in place" if plan.shadowed else _cosine(plan)
        words.add(f"self-shadow: {side} of the surface's normals, a factor for each light")
    elif plan.base:
        words.add(
            f"base tangents: brightness |wi_N| to the power {plan.base_exponent:.6g} of the "
            f"{plan.base}-manifold in which the tangents lie, a factor for each light"
        )
    elif not plan.surface:
        words.add(None, "self-shadow: no surface conditions the tangents")
    if plan.dimmed:
        words.add("transmittance: a share of each light for each point, as inside a bundle")
    if plan.fur:
        words.add(f"fur: density {plan.fur:g}, on the way in for each light and out once")


def _results(plan: Plan, words: _Words) -> None:
    cue = plan.scene.depth_cue
    if cue is not None:
        words.add(f"depth cue: {'smooth' if cue.smooth else 'linear'}")
    else:
        words.add(None, "depth cue: the scene has none")
    if plan.colored:
        words.add("rgb: three channels")
    else:
        words.add(None, "rgb: nothing in the scene has a colour")


def _code(plan: Plan, words: _Words) -> None:
    if plan.compiled:
        words.add(f"code: {plan.code}")
    elif plan.code:
        words.add(None, f"compiled code: {plan.code}")
