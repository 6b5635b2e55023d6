"""Decide what a scene needs: the terms that are computed and nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from vizlight import _check
from vizlight.light import NO_ATTENUATION
from vizlight.model import brightness
from vizlight.model._kernels import DEFICIT_FROM
from vizlight.model.reflection import SpecularModel
from vizlight.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import DTypeLike

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
    model : str
        Of the specular term.
    surface : bool
        Whether the manifold is given by its normals (k = n - 1), not by tangents.
    conditioned : bool
        Whether tangents inherit the self-shadow of the surface that the normals belong to.
    two_sided : bool
        Whether the far side of normals is lit as the near one.
    shadowed : bool
        Whether t of the cos-theta shadow takes the place of the cosine of normals.
    fur : float
        Density of the fur that light passes on its way in and out, 0 for none.
    diffuse, specular : bool
        Whether the term is computed.
    colored, components : bool
        Which results are kept.
    """

    n: int
    k: int
    dtype: np.dtype[Any]
    scene: Scene
    exponent: float
    model: SpecularModel
    surface: bool
    conditioned: bool
    two_sided: bool
    shadowed: bool
    fur: float
    diffuse: bool
    specular: bool
    colored: bool
    components: bool

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
        return self.specular or (self.fur > 0 and self.diffuse)

    @property
    def block(self) -> int:
        """Points in a block, unless the caller says."""
        return max(BLOCK_BYTES // (self.n * self.k * self.dtype.itemsize), 1)

    @property
    def multiplies(self) -> bool:
        """Whether the specular power is taken by multiplication."""
        shininess = self.scene.material.shininess
        power = shininess / 2 if self.model == "blinn" else shininess
        return power == int(power) and power <= DEFICIT_FROM

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
    dtype: DTypeLike = np.float64,
    model: SpecularModel = "phong",
    compensate: bool = True,
    conditioned: bool = True,
    two_sided: bool = False,
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
    dtype : dtype, default: float64
        float32 or float64.
    model : {"phong", "blinn"}
    compensate : bool, default: True
        Diffuse with the exponent p(k, n) (Banks 5), else 1.
    conditioned : bool, default: True
        Tangents inherit the self-shadow of normals that are given (Banks 6).
    two_sided : bool, default: False
        Light the far side of normals as the near one.
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
        If the scene's vectors are not of n components, a view is needed and missing, or an
        option is unknown.
    """
    _check.instance("scene", scene, Scene)
    if model not in get_args(SpecularModel):
        raise ValueError(_check.message("model", "'phong' or 'blinn'", repr(model)))
    kind = np.dtype(dtype)
    if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(_check.message("dtype", "float32 or float64", kind))
    n = _check.integer("n", n, low=2)
    if k is None and not normals:
        raise ValueError(
            _check.message("tangents", "tangents (k=) or normals (normals=True)", "neither")
        )
    if k is not None and not 0 < _check.integer("k", k, low=1) < n:
        raise ValueError(_check.message("k", f"fewer than n = {n} tangents a point", k))
    if scene.n not in (None, n):
        raise ValueError(
            _check.message(
                "scene", f"vectors of {n} components, as the points have", f"{scene.n} components"
            )
        )
    material, cue = scene.material, scene.depth_cue
    if cue is not None and (cue.front is None or cue.back is None):
        raise ValueError(_check.message("depth_cue", "front= and back=", cue))

    surface = k is None
    size = n - 1 if k is None else k
    conditioned = bool(conditioned and normals and not surface)
    fur = _check.number("fur", fur, low=0.0, high=1.0)
    if fur and not normals:
        raise ValueError(_check.message("normals", "normals, across which fur stands", None))
    exponent = brightness.exponent(size, n) if compensate else 1.0
    lights = tuple(light for light in scene.lights if light.intensity > 0)
    specular = bool(material.specular > 0 and lights)
    diffuse = bool(material.diffuse > 0 and lights)
    through_fur = bool(fur and diffuse)
    if scene.view is None and (specular or through_fur or cue is not None):
        what = "specular term" if specular else "fur" if through_fur else "depth cue"
        remedy = "pass view=, or Material(specular=0)" if specular else "pass view="
        raise ValueError(_check.message("view", f"a View, which the {what} needs", None, remedy))
    lights = tuple(light.seen_from(scene.view) for light in lights) if diffuse or specular else ()
    return Plan(
        n=n,
        k=size,
        dtype=kind,
        scene=scene.replace(lights=lights),
        exponent=exponent,
        model=model,
        surface=surface,
        conditioned=conditioned,
        two_sided=bool(two_sided),
        shadowed=bool(shadowed),
        fur=fur if diffuse or specular else 0.0,
        diffuse=diffuse,
        specular=specular,
        colored=scene.colored,
        components=bool(components),
    )


def _words(plan: Plan) -> tuple[list[str], list[str]]:
    """Return what is computed and what is skipped, in words."""
    scene = plan.scene
    material, view, lights = scene.material, scene.view, scene.lights
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
    elif plan.diffuse:
        yes.append(f"diffuse: {law} to the power {plan.exponent:.6g}")
    else:
        no.append(f"diffuse: {plan.why_not('diffuse')}")
    if plan.specular and view is not None:
        yes.append(
            f"specular: {plan.model}, shininess {material.shininess:g} by "
            + ("multiplication" if plan.multiplies else "a power")
        )
        distant = sum(light.position is None for light in lights)
        if view.parallel:
            no.append("eye: no direction a point, the parallel view has one for all")
            if plan.model == "blinn" and distant:
                yes.append(f"half vector: one for all points for {distant} light(s)")
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
    elif not plan.surface:
        no.append("self-shadow: no surface conditions the tangents")
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
    return yes, no
