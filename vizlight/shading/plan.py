"""The plan of a scene: the terms that it needs and nothing else, also in words."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike

from vizlight import _check
from vizlight._types import FloatType, Model, Vector
from vizlight.model import brightness, kernels
from vizlight.model.manifolds import Highlight
from vizlight.scene import Light, Scene, View
from vizlight.scene.light import NO_ATTENUATION
from vizlight.shading.inputs import Layout
from vizlight.shading.options import ShadingOptions

#: Bytes of a block's tangents. About ten times as much memory is in use at once: little enough for
#: the last cache, enough that threads seldom wait for the interpreter.
BLOCK_BYTES = 3 << 19
#: Least power at which |h_N|^q may be computed from the tangential part alone: a lower one is too
#: steep at 0.
LEAST_POWER = 2.0
#: A line of words, and whether its term is computed or skipped.
Line = tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Terms that are computed for each point of a mesh; see :func:`vizlight.shading.engine.plan`.

    Attributes
    ----------
    n, k : int
        Dimension of the space and of the manifold that is lit.
    dtype : numpy.dtype
        Precision of the work and of the result.
    scene : Scene
        Scene with a view, lights that follow it fixed, and without lights that have no effect.
    options : ShadingOptions
        Options of the caller.
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
        Dimension of the manifold in which the tangents lie, with its brightness as a factor; 0 for
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
        Whether the scene has no view: it has no highlight, and other terms that depend on the eye
        are as in :meth:`vizlight.View.isometric`.
    """

    n: int
    k: int
    dtype: FloatType
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

    @property
    def components(self) -> bool:
        """Whether the terms are kept."""
        return self.options.components

    @property
    def colored(self) -> bool:
        """Whether the result has a colour."""
        return self.scene.colored

    @functools.cached_property
    def terms(self) -> tuple[str, ...]:
        """Names of the terms that are added up."""
        names = {"ambient": True, "diffuse": self.diffuse, "specular": self.specular}
        return tuple(name for name, there in names.items() if there)

    @property
    def ambient(self) -> float:
        """Ambient term, one number for all points."""
        return self.scene.material.ambient * self.scene.ambient_intensity

    @property
    def needs_eye(self) -> bool:
        """Whether anything depends on where the eye is."""
        # Single points of a mesh of several kinds of cells face the eye.
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
        """Return one line for each term that is computed or skipped, with the reason."""
        parts = (_manifold, _diffuse, _specular, _lights, _factors, _results)
        lines = [line for part in parts for line in part(self)]
        # "compute" comes before "skip"; lines of one kind keep their order.
        lines.sort(key=lambda line: line[0])
        return "\n".join(f"{verb:<9}{words}" for verb, words in lines)

    @property
    def cosine(self) -> str:
        """Cosine of the lit side or sides, in the notation of the sources."""
        return "|N.wi|" if self.two_sided else "max(0, N.wi)"


def _manifold(plan: Plan) -> Iterator[Line]:
    share = ", times the share of each point" if plan.occluded else ""
    yield "compute", f"ambient: the constant {plan.ambient:g}{share}"
    if not plan.surface:
        yield (
            "compute",
            f"frame: {plan.k} orthonormal tangent(s) per point in {plan.n}-space, "
            f"codimension {plan.n - plan.k}",
        )
        return
    sides = "both sides alike" if plan.two_sided else "the outer side only"
    yield "compute", f"surface: one unit normal per point, lit on {sides}"
    yield "skip", "frame: a surface is lit by its normals, no tangents are needed"
    if plan.line_exponent is not None:
        yield (
            "compute",
            "lines beside the faces: by their own tangents, diffuse |wi_N| to the power "
            f"{plan.line_exponent:.6g}; points of neither face the eye",
        )


def _why_not(plan: Plan, term: str) -> Line:
    """Return why the diffuse or the specular term is skipped."""
    why = "no light has an intensity above 0"
    if getattr(plan.scene.material, term) == 0:
        why = f"material.{term} is 0"
    elif plan.unseen and plan.scene.lights:
        why = "the scene has no view; pass view= to the Scene"
    return "skip", f"{term}: {why}"


def _diffuse(plan: Plan) -> Iterator[Line]:
    if not plan.diffuse:
        yield _why_not(plan, "diffuse")
    elif plan.shadowed and plan.surface:
        yield "compute", "diffuse: t = d/r of the cos-theta shadow in place of the cosine"
    elif plan.model == "cylinder":
        yield "compute", "diffuse: Lambert's law averaged over the visible half of a thin cylinder"
        yield "skip", "compensation: the mean over the cylinder includes it"
    else:
        base = plan.cosine if plan.surface else "|wi_N|"
        yield "compute", f"diffuse: {base} to the power {plan.exponent:.6g}"


def _specular(plan: Plan) -> Iterator[Line]:
    view = plan.scene.view
    if not plan.specular or view is None:
        if plan.unseen and plan.needs_eye:
            yield "compute", "eye: the scene has no view, so it is toward (1, ..., 1), at infinity"
        yield _why_not(plan, "specular")
        if not plan.needs_eye:
            yield "skip", "eye: no term of the light depends on the view"
        return
    shininess = plan.scene.material.shininess
    yield "compute", f"specular: {plan.model}, shininess {shininess:g}"
    # A half vector that all points share depends on both being at infinity, the lamp and the eye.
    fixed = sum(h.half is not None for h in plan.highlights)
    if fixed:
        yield "compute", f"half vector: one for all points for {fixed} light(s)"
    if not plan.splits_eye:
        yield "skip", "eye: no split per point, all half vectors are fixed"
    if view.parallel:
        yield "skip", "eye: the parallel view has one direction for all points"
    else:
        yield "compute", "eye: its direction and split once per point, shared by all lights"


def _lights(plan: Plan) -> Iterator[Line]:
    for i, light in enumerate(plan.scene.lights):
        near = light.position is not None
        kind = "one direction per point" if near else "one direction for all points"
        yield "compute", f"light {i}: {kind}, intensity {light.intensity:g}"
        if light.attenuation != NO_ATTENUATION:
            yield "compute", f"light {i}: attenuation {light.attenuation} of the distance"
        elif near:
            yield "skip", f"light {i}: attenuation, its coefficients are {NO_ATTENUATION}"


def _factors(plan: Plan) -> Iterator[Line]:
    """Yield descriptions of the factors of each light."""
    if plan.conditioned:
        side = "t = d/r in place" if plan.shadowed else plan.cosine
        yield "compute", f"self-shadow: {side} of the surface's normals, a factor for each light"
    elif plan.base:
        yield (
            "compute",
            f"base tangents: brightness |wi_N| to the power {plan.base_exponent:.6g} of the "
            f"{plan.base}-manifold in which the tangents lie, a factor for each light",
        )
    elif not plan.surface:
        yield "skip", "self-shadow: no surface conditions the tangents"
    if plan.dimmed:
        yield "compute", "transmittance: a share of each light for each point, as inside a bundle"
    if plan.fur:
        yield "compute", f"fur: density {plan.fur:g}, on the way in for each light and out once"


def _results(plan: Plan) -> Iterator[Line]:
    cue = plan.scene.depth_cue
    if cue is None:
        yield "skip", "depth cue: the scene has none"
    else:
        yield "compute", f"depth cue: {'smooth' if cue.smooth else 'linear'}"
    if plan.colored:
        shown = plan.scene.exposure
        kept = "" if shown is None else f", exposed by {shown:g} with a soft knee below white"
        yield "compute", f"rgb: three channels{kept}"
    else:
        yield "skip", "rgb: nothing in the scene has a colour"


def decide(
    scene: Scene, layout: Layout, options: ShadingOptions, dtype: DTypeLike | None = None
) -> Plan:
    """Return the plan for inputs of a layout; see :func:`vizlight.shading.engine.plan`."""
    _check.instance("scene", scene, Scene)
    kind = _precision((options.precision or np.float64) if dtype is None else dtype)
    _check_layout(layout, options)
    _check_scene(scene, layout.n)
    n, surface = layout.n, layout.k is None
    k = n - 1 if layout.k is None else layout.k
    unseen = scene.view is None
    scene, diffuse, specular = _needed(scene, n)
    return Plan(
        n=n,
        k=k,
        dtype=kind,
        scene=scene,
        options=options,
        # The mean over a cylinder includes what the exponent compensates.
        exponent=1.0 if options.model == "cylinder" else _exponent(options, k, n),
        model=options.model,
        highlights=_highlights(scene, options.model),
        surface=surface,
        two_sided=layout.two_sided,
        # A surface is lit by its normals themselves, which would then count twice.
        conditioned=bool(options.conditioned and layout.normals and not surface),
        base=layout.base,
        base_exponent=(
            brightness.exponent(layout.base, n)
            if layout.base and options.exponent == "compensated"
            else 1.0
        ),
        line_exponent=_exponent(options, 1, n) if layout.mixed else None,
        shadowed=layout.shadowed,
        # A share of the lights has nothing to multiply where no term of them is computed.
        dimmed=layout.dimmed and (diffuse or specular),
        occluded=layout.occluded,
        fur=layout.fur if diffuse or specular else 0.0,
        diffuse=diffuse,
        specular=specular,
        unseen=unseen,
    )


def _highlights(scene: Scene, model: Model) -> tuple[Highlight, ...]:
    """Return the highlight of each light.

    Where light and eye are at infinity all points share the half vector. Blinn's model then needs
    no split of the eye.
    """
    shininess = scene.material.shininess
    fixed = model == "blinn" and shininess >= LEAST_POWER
    return tuple(
        Highlight(model, shininess, _half(light, scene.view) if fixed else None)
        for light in scene.lights
    )


def _half(light: Light, view: View | None) -> Vector | None:
    """Return the half vector that all points share, or None."""
    if view is None or not view.parallel or light.direction is None or view.direction is None:
        return None
    # As two columns: kernels have the components first.
    unit, _ = kernels.unit(np.array([light.direction, view.direction], dtype=np.float64).T)
    both = unit[:, 0] + unit[:, 1]
    size = float(np.linalg.norm(both))
    # Of nearly opposite directions the half vector is mere rounding.
    return None if size < 1e-6 else tuple((both / size).tolist())


# A thousand blocks of one scene ask a thousand times.
@functools.lru_cache(maxsize=16)
def _needed(scene: Scene, n: int) -> tuple[Scene, bool, bool]:
    """Return the scene with a view and the lights that have an effect, and the terms they need."""
    lights = tuple(light for light in scene.lights if light.intensity > 0)
    specular = bool(scene.material.specular > 0 and lights and scene.view is not None)
    diffuse = bool(scene.material.diffuse > 0 and lights)
    # Without a view, what needs an eye all the same, as fur and single points, has it there.
    view = View.isometric(n) if scene.view is None else scene.view
    # Lights that follow the view get the place or direction that they have under it.
    fixed = tuple(light.seen_from(view) for light in lights) if diffuse or specular else ()
    return scene.replace(lights=fixed, view=view), diffuse, specular


def _exponent(options: ShadingOptions, k: int, n: int) -> float:
    """Return the exponent of the diffuse term of a k-manifold in n-space."""
    if isinstance(options.exponent, str):
        return brightness.exponent(k, n)
    return options.exponent


def _precision(dtype: DTypeLike) -> FloatType:
    for kind in (np.dtype(np.float32), np.dtype(np.float64)):
        # Comparison refuses anything but a type.
        if isinstance(dtype, str | type | np.dtype) and kind == dtype:
            return kind
    raise _check.value_error("dtype", "float32 or float64", _check.describe(dtype))


def _check_layout(layout: Layout, options: ShadingOptions) -> None:
    """Check that tangents, normals and options go together."""
    n, k, normals, base, _, fur, *_ = layout
    if k is None and not normals:
        raise _check.value_error("tangents", "tangents (k=) or normals (normals=True)", "neither")
    if k is not None and not 0 < _check.integer("k", k, low=1) < n:
        raise _check.value_error("k", f"fewer than n = {n} tangents per point", k)
    if options.model == "cylinder" and (k, n) != (1, 3):
        got = f"a surface of {n}-space" if k is None else f"{k} tangent(s) per point in {n}-space"
        raise ValueError(not_a_line(got))
    if base and (k is None or normals):
        expected = "tangents (k=) and no normals beside it"
        got = "normals" if normals else "neither"
        raise _check.value_error("base_tangents", expected, got)
    if base and not (n - 1 if k is None else k) <= base < n:
        expected = f"from k = {k} to less than n = {n} tangents per point"
        raise _check.value_error("base_tangents", expected, base)
    if fur and not normals:
        raise _check.value_error("normals", "normals, across which fur stands", None)


def not_a_line(got: str) -> str:
    """Return the message for a cylinder's light on anything but lines in 3-space."""
    remedy = "use model='blinn' for other manifolds"
    return _check.message("model", "lines in 3-space for 'cylinder'", got, remedy)


def _check_scene(scene: Scene, n: int) -> None:
    """Check that the scene fits points of n components."""
    if scene.n not in (None, n):
        raise _check.value_error(
            "scene",
            f"vectors of {n} components, as the points have",
            f"{scene.n} components",
            f"for light in {scene.n}-space name the arrays by positions= and tangents=",
        )
    cue = scene.depth_cue
    if scene.view is None and cue is not None:
        expected, remedy = "a View, which the depth cue needs", "pass view= to the Scene"
        raise _check.value_error("view", expected, None, remedy)
    if cue is not None and (cue.front is None or cue.back is None):
        raise _check.value_error("depth_cue", "front= and back=", cue)
