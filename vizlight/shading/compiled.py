"""Compiled light: a plan's terms in one pass over the points, where numba is installed and pays.

The text of a kernel is made by :mod:`vizlight.shading.writer`. Unusual points are lit by NumPy's
:func:`~vizlight.shading.arrays.shade_block`: vectors that are not finite or whose squares are out
of the range of their type, nearly dependent tangents, a light or an eye at the point.
"""

from __future__ import annotations

import dataclasses
import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight import _compiled, _pool
from vizlight.model import cylinder_kernels, frames, kernels
from vizlight.scene.light import NO_ATTENUATION, WHITE
from vizlight.shading.arrays import SMALLEST_HELD, Output, shade_block
from vizlight.shading.elementary import HELPERS
from vizlight.shading.form import BITS, Form, LightForm

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from vizlight._types import Array, Vector
    from vizlight.scene import Light
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.plan import Highlight, Plan
    from vizlight.shading.writer import Text

#: Number of points whose multiples fill all vectors of a processor, in unrolled loops too.
LANES = 64
#: Largest space and number of tangents for which code is written out.
MOST_COMPONENTS, MOST_TANGENTS = 6, 3
#: Largest coefficient of a distance whose products float32 holds.
MOST_FADING = 1e9
#: Seconds that compiled code saves per point: of the whole, and for each light.
SAVED, SAVED_PER_LIGHT = 10e-9, 15e-9

#: Arrays that have a row for each point.
ROWS = ("points", "tangents", "normals", "base_tangents", "fur_height", "shadow", "occlusion")

#: What a plan says of its code once compiled code has run, and before.
IN_WORDS = "compiled for these terms and types (numba), unusual points by NumPy"
WHERE_IT_PAYS = "where the number of points pays for its start-up (see vizlight doctor)"

#: Seconds that compiled code would have saved so far, by form.
_MISSED: dict[Form, float] = {}


def why_not(plan: Plan) -> str:
    """Return why a plan has no compiled form; an empty text where it has one."""
    if plan.n > MOST_COMPONENTS:
        return f"points have {plan.n} components, more than {MOST_COMPONENTS}"
    if not plan.surface and plan.k > MOST_TANGENTS:
        return f"{plan.k} tangents per point, more than {MOST_TANGENTS}"
    if not (plan.diffuse or plan.specular or plan.scene.depth_cue):
        return "the ambient term alone needs none"
    if plan.dimmed:
        return "shares of lights, as inside a bundle, are multiplied in by NumPy"
    least = cylinder_kernels.TABLE_FROM
    if plan.model == "cylinder" and plan.specular and plan.scene.material.shininess < least:
        return f"a cylinder's highlight of a shininess below {least:g} is no table"
    return ""


class Compiled(NamedTuple):
    """The kernel of a plan and the numbers that it is given.

    Attributes
    ----------
    kernel : callable
        Function of the arrays in :data:`vizlight.shading.writer.ARRAYS`.
    form : Form
        What its text depends on.
    numbers, wide, table : ndarray
        Numbers in the type of the work, numbers in float64, table of a cylinder's integral.
    order : list of int
        Lights in the order in which the kernel takes them.
    """

    kernel: Callable[..., None]
    form: Form
    numbers: Array
    wide: Array
    table: Array
    order: list[int]

    def shade_block(self, plan: Plan, rows: slice, inputs: ShadingInputs, output: Output) -> None:
        """Light the points of some rows; as :func:`vizlight.shading.arrays.shade_block`."""
        for at, part in _parts(rows, inputs):
            self._shade_points(plan, at, part, output)

    def _shade_points(self, plan: Plan, at: slice, part: ShadingInputs, output: Output) -> None:
        form, kind, count = self.form, plan.dtype, part.count
        shadow = None if part.shadow is None else np.asarray(part.shadow[:])[:, self.order]
        whole = at.step is None
        light: Array = output.luminance[at] if whole else np.empty(count, kind)
        terms = np.empty((2, count if form.components else 0), kind)
        color = np.empty(3 * count if form.colored else 0, kind)
        given = [
            _flat(part.points if form.points else None, form.points),
            _flat(part.tangents, form.tangents),
            _flat(part.normals, form.normals),
            _flat(part.base_tangents, form.base_tangents),
            _flat(shadow, form.work),
            _flat(part.fur_height if form.fur else None, form.work),
            _flat(part.occlusion if form.occluded else None, form.work),
        ]
        try:
            self._run(given, [light, terms[0], terms[1], color], count)
        except _compiled.FailedError:
            light[...] = np.nan
        if not whole:
            output.luminance[at] = light
        output.valid[at] = True
        if output.diffuse is not None and output.specular is not None:
            output.diffuse[at], output.specular[at] = terms
        if output.rgb is not None:
            output.rgb[at] = color.reshape(-1, 3)
        if np.isnan(light.sum()):
            _light_again(plan, at, np.flatnonzero(np.isnan(light)), part, output)

    def _run(self, given: list[Array], made: list[Array], count: int) -> None:
        """Run the kernel on rows in multiples of LANES, so that all go through the same code.

        The compiler's code for the rest of a vector rounds otherwise, and the light of a point
        would depend on how points are cut into blocks.
        """
        numbers = (self.numbers, self.wide, self.table)
        whole = count - count % LANES
        if whole:
            self.kernel(
                *(a[: a.size // count * whole] for a in given),
                *numbers,
                *(a[: a.size // count * whole] for a in made),
            )
        if whole == count:
            return
        widths = [a.size // count for a in (*given, *made)]
        rest = [np.ones(w * LANES, a.dtype) for w, a in zip(widths, (*given, *made), strict=True)]
        for own, a, w in zip(rest, given, widths, strict=False):
            own[: a.size - w * whole] = a[w * whole :]
        self.kernel(*rest[: len(given)], *numbers, *rest[len(given) :])
        for own, a, w in zip(rest[len(given) :], made, widths[len(given) :], strict=True):
            a[w * whole :] = own[: a.size - w * whole]


def prepare(plan: Plan, inputs: ShadingInputs, threads: int | None) -> tuple[Compiled | None, str]:
    """Return the compiled form of a plan for some inputs, and why there is none.

    Parameters
    ----------
    plan : Plan
    inputs : ShadingInputs
    threads : int or None
        Number of threads that would share the work.

    Returns
    -------
    compiled : Compiled or None
        None where NumPy lights the points.
    reason : str
        Why, in words; empty where there is a compiled form.
    """
    reason = _compiled.why_not() or why_not(plan) or _beyond(plan)
    if reason:
        return None, reason
    form, order = _form(plan, inputs)
    saved = inputs.count * (SAVED + SAVED_PER_LIGHT * len(form.lights))
    saved *= plan.dtype.itemsize / 4 / _pool.workers(threads)
    # The text itself takes milliseconds: it is not written while nothing could pay for it.
    missed = _MISSED.get(form, 0.0)
    _MISSED[form] = missed + saved
    if _compiled.could_pay(saved, missed):
        kernel = _kernel(form)
        if kernel.pays(missed + saved - kernel.missed, counted=True):
            return _given(plan, form, order, kernel), ""
    return None, _compiled.why_not() or f"{inputs.count} points do not pay for its start-up"


def given(plan: Plan, inputs: ShadingInputs, *, interpreted: bool = False) -> Compiled:
    """Return the compiled form of a plan that has one, without asking whether it pays.

    With ``interpreted`` the kernel's text runs as Python, point by point: a check of the text.
    """
    form, order = _form(plan, inputs)
    if not interpreted:
        return _given(plan, form, order, _kernel(form))
    function: Callable[..., None] = _functions(form, np.sqrt)["light"]  # type: ignore[assignment]
    return _given(plan, form, order, function)


def _beyond(plan: Plan) -> str:
    """Return a reason if a light or the eye stands where the type of the work has no numbers."""
    most = float(np.finfo(plan.dtype).max)
    view = plan.scene.view
    places = [light.position for light in plan.scene.lights]
    if view is not None:
        places.append(view.position)
    if any(abs(x) > most for place in places for x in place or ()):
        return f"a light or the eye is out of the range of {plan.dtype.name}"
    if plan.dtype == np.float32:
        if any(0 < abs(x) < SMALLEST_HELD for place in places for x in place or ()):
            return "a light or the eye is nearer to 0 than float32 resolves"
        factors = (c for light in plan.scene.lights for c in light.attenuation)
        if any(c > MOST_FADING for c in factors):
            return "a light fades faster than float32 resolves"
    return ""


@lru_cache(maxsize=256)
def _kernel(form: Form) -> _compiled.Kernel[..., None]:
    """Return the kernel of a form, which is not compiled before its first call."""
    scope = _functions(form, math.sqrt)
    for name in HELPERS:
        scope[name] = _compiled.Kernel(
            scope[name],  # type: ignore[arg-type]
            inline=True,
            rounding=_compiled.ROUNDING,
        )
    light: Callable[..., None] = scope["light"]  # type: ignore[assignment]
    light.__globals__.update(scope)
    return _compiled.Kernel(light, rounding=_compiled.ROUNDING, apart=True)


def _functions(form: Form, sqrt: Callable[[float], float]) -> dict[str, object]:
    """Return the functions of a kernel's text, with a square root that keeps the type."""
    return _compiled.generated(_written(form).source, {"sqrt": sqrt}, "light")


def _written(form: Form) -> Text:
    """Return the text of a kernel; what writes it is imported where compiled code pays."""
    from vizlight.shading.writer import write

    return write(form)


def _type(source: ArraySource | None, plan: Plan) -> str:
    """Return the type in which a kernel reads an array: "f4" where nothing is lost by it."""
    if source is None:
        return ""
    narrow = plan.dtype == np.float32 and source.dtype in (np.float16, np.float32)
    return "f4" if narrow or source.dtype == np.float32 else "f8"


def _form(plan: Plan, inputs: ShadingInputs) -> tuple[Form, list[int]]:
    """Return the form of a plan and the order of its lights."""
    scene, view, cue = plan.scene, plan.scene.view, plan.scene.depth_cue
    lights = [_kind(*pair) for pair in zip(scene.lights, plan.highlights, strict=True)]
    order = sorted(range(len(lights)), key=lambda i: lights[i])
    seen = "" if view is None or not plan.needs_eye else "far" if view.parallel else "near"
    form = Form(
        work="f4" if plan.dtype == np.float32 else "f8",
        n=plan.n,
        k=0 if plan.surface else plan.k,
        base=plan.base,
        points=_type(inputs.points, plan) if plan.needs_points else "",
        tangents=_type(inputs.tangents, plan),
        normals=_type(inputs.normals, plan),
        base_tangents=_type(inputs.base_tangents, plan),
        surface=plan.surface,
        cylinder=plan.model == "cylinder",
        two_sided=plan.two_sided,
        conditioned=plan.conditioned,
        shadowed=plan.shadowed,
        fur=plan.fur > 0 and seen != "",
        occluded=plan.occluded,
        diffuse=("plain" if plan.exponent == 1 else "power") if plan.diffuse else "",
        based=("plain" if plan.base_exponent == 1 else "power") if plan.base else "",
        specular=plan.specular,
        eye=seen,
        splits_eye=plan.splits_eye,
        cue="" if cue is None else "smooth" if cue.smooth else "linear",
        axis=cue is not None and view is not None and view.direction is not None,
        tinted=plan.colored and any(light.color is not None for light in scene.lights),
        colored=plan.colored,
        components=plan.components,
        lights=tuple(lights[i] for i in order),
    )
    return form, order


def _kind(light: Light, highlight: Highlight) -> LightForm:
    """Return the kind of a light."""
    near = light.position is not None
    power = _power(highlight)
    return LightForm(
        near=near,
        faded=near and light.attenuation != NO_ATTENUATION,
        highlight=highlight.model if highlight.half is None else "half",
        whole=highlight.model != "cylinder" and power == int(power) and power < 2**BITS,
    )


def _power(highlight: Highlight) -> float:
    """Return the power that is computed: Blinn's is one of squares."""
    return highlight.shininess / (1 if highlight.model == "phong" else 2)


def _given(
    plan: Plan, form: Form, order: list[int], kernel: Callable[..., None]
) -> Compiled:  # fmt: skip
    """Return a kernel with the numbers of a plan."""
    values = _scene_numbers(plan)
    table = np.zeros(1, plan.dtype)
    for number, i in enumerate(order):
        own = _light_numbers(plan.scene.lights[i], plan.highlights[i])
        values.update({f"light{number}.{name}": value for name, value in own.items()})
    if form.cylinder and plan.specular:
        inverse, cells = cylinder_kernels.table(plan.highlights[0].shininess)
        table = cells.astype(plan.dtype).ravel()
        values["cells"], values["per_cell"] = cells.shape[1], inverse
        values["end_on"] = cylinder_kernels.round_mean(plan.highlights[0].shininess)
    text = _written(form)
    # One number at least, so that the arrays have a type.
    numbers = np.array([values[name] for name in text.numbers] or [0], plan.dtype)
    wide = np.array([values[name] for name in text.wide] or [0], np.float64)
    return Compiled(kernel, form, numbers, wide, table, order)


def _scene_numbers(plan: Plan) -> dict[str, float]:
    """Return the numbers of a kernel that all lights share."""
    scene, material, view, cue = (
        plan.scene, plan.scene.material, plan.scene.view, plan.scene.depth_cue,
    )  # fmt: skip
    eps, tiny, most = (float(getattr(np.finfo(plan.dtype), x)) for x in ("eps", "tiny", "max"))
    kd, ks = material.diffuse, material.specular
    values = {
        "ambient": plan.ambient,
        "kd": kd,
        "ks": ks,
        "exponent": plan.exponent,
        "base_exponent": plan.base_exponent,
        # Not 0, which times an infinite path is no number.
        "rate": min(float(np.log1p(-plan.fur)), -tiny) if plan.fur < 1 else -most,
        "least": cylinder_kernels.ALONG * eps,
        # Four times what NumPy takes for dependent, so that NumPy decides what is near.
        "rank": 4 * frames.default_rtol(plan.n, plan.dtype),
    }
    ambient = np.multiply(material.color or WHITE, scene.ambient_color or WHITE)
    for c in range(3):
        values[f"ambient{c}"] = plan.ambient * float(ambient[c])
        values[f"kd{c}"] = kd * (material.color or WHITE)[c]
        values[f"ks{c}"] = ks * (material.specular_color or WHITE)[c]
    if view is not None:
        values |= _toward("eye", view.position, view.direction, near=not view.parallel)
        values |= _vector("origin", view.position or (0.0,) * plan.n)
        if view.direction is not None:
            values |= _vector("axis", _unit(view.direction))
    if cue is not None and cue.front is not None and cue.back is not None:
        values |= {
            "front": cue.front,
            "back": cue.back,
            "front_scale": cue.front_scale,
            "back_scale": cue.back_scale,
            "cue": cue.cue,
        }
        values |= _vector("cue", [cue.cue * x for x in cue.color or WHITE])
    return values


def _light_numbers(light: Light, highlight: Highlight) -> dict[str, float]:
    """Return the numbers of a kernel that belong to one light."""
    values = {"intensity": light.intensity, "shininess": highlight.shininess}
    values |= _vector("c", light.attenuation)
    power = _power(highlight)
    for bit in range(BITS):
        taken = int(power) >> bit & 1
        values |= {f"bit{bit}": taken, f"bit{bit}not": 1 - taken}
    values |= _vector("color", light.color or WHITE)
    values |= _toward("", light.position, light.direction, near=light.position is not None)
    if highlight.half is not None:
        values |= _vector("half", highlight.half)
    return values


def _toward(
    name: str, position: Vector | None, direction: Vector | None, *, near: bool
) -> dict[str, float]:
    """Return a place, with the rest that float32 leaves, or a unit direction."""
    if not near or position is None:
        assert direction is not None
        return _vector(name, _unit(direction))
    high = np.array(position, np.float64)
    with np.errstate(over="ignore"):
        low = high - high.astype(np.float32)
    return _vector(name, position) | _vector(f"{name}low", low.tolist())


def _unit(direction: Vector) -> Sequence[float]:
    column, _ = kernels.unit(np.array(direction, np.float64)[:, np.newaxis])
    return [float(x) for x in column[:, 0]]


def _vector(name: str, values: Sequence[float]) -> dict[str, float]:
    return {f"{name}{c}": float(value) for c, value in enumerate(values)}


def _flat(source: ArraySource | NDArray[np.generic] | None, kind: str) -> Array:
    """Return all rows of an array one after the other, in the type that a kernel reads."""
    if source is None or not kind:
        return np.empty(0, np.float32)
    flat: Array = np.ascontiguousarray(source[:], dtype=kind).reshape(-1)
    return flat


def _parts(rows: slice, inputs: ShadingInputs) -> Iterator[tuple[slice, ShadingInputs]]:
    """Yield the places of one point of each row, and their inputs as arrays."""
    repeat, tangents = inputs.repeat, inputs.tangents
    each = tangents is not None and tangents.shape[0] == inputs.points.shape[0]
    normals = None if inputs.normals is None else inputs.normals[rows]
    base = None if inputs.base_tangents is None else inputs.base_tangents[rows]
    own = None if tangents is None or each else tangents[rows]
    for j in range(repeat):
        at = rows if repeat == 1 else slice(rows.start * repeat + j, rows.stop * repeat, repeat)
        yield (
            at,
            dataclasses.replace(
                inputs,
                points=inputs.points[at],
                tangents=tangents[at] if each and tangents is not None else own,
                normals=normals,
                base_tangents=base,
                fur_height=None if inputs.fur_height is None else inputs.fur_height[at],
                shadow=None if inputs.shadow is None else inputs.shadow[at],
                occlusion=None if inputs.occlusion is None else inputs.occlusion[at],
                repeat=1,
            ),
        )


def _light_again(
    plan: Plan, at: slice, odd: NDArray[np.intp], part: ShadingInputs, output: Output
) -> None:
    """Light some points of a block by NumPy."""
    few = dataclasses.replace(
        part,
        **{name: source[:][odd] for name in ROWS if (source := getattr(part, name)) is not None},
    )
    own = Output(plan, len(odd))
    shade_block(plan, slice(0, len(odd)), few, own)
    for name in ("luminance", "valid", "diffuse", "specular", "rgb"):
        if (values := getattr(own, name)) is not None:
            getattr(output, name)[at][odd] = values
