"""Compiled light: a plan's terms in one pass over the points, where numba is installed and pays.

The text of a kernel is written by the terms (:mod:`vizlight.shading.loops`). Unusual points are lit
by NumPy's :func:`~vizlight.shading.arrays.shade_block`: vectors that are not finite or whose
squares are out of the range of their type, nearly dependent tangents, a light or an eye at the
point.
"""

from __future__ import annotations

import dataclasses
import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight import _compiled, _pool
from vizlight.model import highlight_integral
from vizlight.shading.arrays import SMALLEST_HELD, Shading, shade_block
from vizlight.shading.elementary import HELPERS
from vizlight.shading.inputs import PLACED, SHARES
from vizlight.shading.options import ShadingOptions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from vizlight._types import Array
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.loops import Program
    from vizlight.shading.plan import Plan

#: Number of points whose multiples fill all vectors of a processor, in unrolled loops too.
LANES = 64
#: Largest space and number of tangents for which code is written out.
MOST_COMPONENTS, MOST_TANGENTS = 6, 3
#: Largest coefficient of a distance whose products float32 holds.
MOST_FADING = 1e9
#: Seconds that compiled code saves per point: of the whole, and for each light.
SAVED, SAVED_PER_LIGHT = 10e-9, 15e-9

#: What a plan says of its code once compiled code has run, and before.
IN_WORDS = "compiled for these terms and types (numba), unusual points by NumPy"
WHERE_IT_PAYS = "where the number of points pays for its start-up (see vizlight doctor)"

#: Seconds that compiled code would have saved so far, by what most texts depend on.
_MISSED: dict[tuple[object, ...], float] = {}


def why_not(plan: Plan) -> str:
    """Return why a plan has no compiled form; an empty text where it has one."""
    if plan.n > MOST_COMPONENTS:
        return f"points have {plan.n} components, more than {MOST_COMPONENTS}"
    if not plan.surface and plan.k > MOST_TANGENTS:
        return f"{plan.k} tangents per point, more than {MOST_TANGENTS}"
    if not (plan.diffuse or plan.specular or plan.scene.depth_cue):
        return "the ambient term alone needs none"
    least = highlight_integral.TABLE_FROM
    if plan.model == "cylinder" and plan.specular and plan.scene.material.shininess < least:
        return f"a cylinder's highlight of a shininess below {least:g} is no table"
    return ""


class Compiled(NamedTuple):
    """The kernel of a plan, and the program with the numbers that it is given."""

    kernel: Callable[..., None]
    program: Program

    def shade_block(self, plan: Plan, rows: slice, inputs: ShadingInputs, output: Shading) -> None:
        """Light the points of some rows; as :func:`vizlight.shading.arrays.shade_block`."""
        for at, part in _parts(rows, inputs):
            self._shade_points(plan, at, part, output)

    def _shade_points(self, plan: Plan, at: slice, part: ShadingInputs, output: Shading) -> None:
        kind, count, whole = plan.dtype, part.count, at.step is None
        light: Array = output.luminance[at] if whole else np.empty(count, kind)
        terms = np.empty((2, count if plan.components else 0), kind)
        color = np.empty(3 * count if plan.colored else 0, kind)
        kinds = self.program.kinds
        read = [_flat(getattr(part, name), kinds.get(name, "")) for name in (*PLACED, *SHARES)]
        try:
            self._run(read, [light, terms[0], terms[1], color], count)
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

    def _run(self, read: list[Array], made: list[Array], count: int) -> None:
        """Run the kernel on rows in multiples of LANES, so that all go through the same code.

        The compiler's code for the rest of a vector rounds otherwise, and the light of a point
        would depend on how points are cut into blocks.
        """
        numbers, whole = self.program.given, count - count % LANES
        if whole:
            self.kernel(
                *(a[: a.size // count * whole] for a in read),
                *numbers,
                *(a[: a.size // count * whole] for a in made),
            )
        if whole == count:
            return
        widths = [a.size // count for a in (*read, *made)]
        rest = [np.ones(w * LANES, a.dtype) for w, a in zip(widths, (*read, *made), strict=True)]
        for own, a, w in zip(rest, read, widths, strict=False):
            own[: a.size - w * whole] = a[w * whole :]
        self.kernel(*rest[: len(read)], *numbers, *rest[len(read) :])
        for own, a, w in zip(rest[len(read) :], made, widths[len(read) :], strict=True):
            a[w * whole :] = own[: a.size - w * whole]


def prepare(plan: Plan, inputs: ShadingInputs) -> tuple[Compiled | None, str]:
    """Return the compiled form of a plan for some inputs, and why there is none.

    Parameters
    ----------
    plan : Plan
    inputs : ShadingInputs

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
    saved = inputs.count * (SAVED + SAVED_PER_LIGHT * len(plan.scene.lights))
    saved *= plan.dtype.itemsize / 4 / _pool.workers()
    # The text itself takes a millisecond: it is not written while nothing could pay for it.
    sort = _sort(plan)
    missed = _MISSED.get(sort, 0.0)
    _MISSED[sort] = missed + saved
    if _compiled.could_pay(saved, missed):
        made = _program(plan, inputs)
        kernel = _kernel(made.source)
        if kernel.pays(missed + saved - kernel.missed, counted=True):
            return Compiled(kernel, made), ""
    return None, _compiled.why_not() or f"{inputs.count} points do not pay for its start-up"


def given(plan: Plan, inputs: ShadingInputs, *, interpreted: bool = False) -> Compiled:
    """Return the compiled form of a plan that has one, without asking whether it pays.

    With ``interpreted`` the kernel's text runs as Python, point by point: a check of the text.
    """
    made = _program(plan, inputs)
    if not interpreted:
        return Compiled(_kernel(made.source), made)
    function: Callable[..., None] = _functions(made.source, np.sqrt)["light"]  # type: ignore[assignment]
    return Compiled(function, made)


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
def _kernel(source: str) -> _compiled.Kernel[..., None]:
    """Return the kernel of a text, which is not compiled before its first call."""
    scope = _functions(source, math.sqrt)
    for name in HELPERS:
        scope[name] = _compiled.Kernel(
            scope[name],  # type: ignore[arg-type]
            inline=True,
            rounding=_compiled.ROUNDING,
        )
    light: Callable[..., None] = scope["light"]  # type: ignore[assignment]
    light.__globals__.update(scope)
    return _compiled.Kernel(light, rounding=_compiled.ROUNDING, apart=True)


def _functions(source: str, sqrt: Callable[[float], float]) -> dict[str, object]:
    """Return the functions of a kernel's text, with a square root that keeps the type."""
    return _compiled.generated(source, {"sqrt": sqrt}, "light")


def _sort(plan: Plan) -> tuple[object, ...]:
    """Return what tells most texts apart, for the account of what each would have saved."""
    models = frozenset(h.model for h in plan.highlights)
    near = sum(light.position is not None for light in plan.scene.lights)
    sizes = (plan.n, plan.k, plan.dtype, len(plan.scene.lights), near)
    return (*sizes, models, plan.surface, plan.conditioned, plan.terms, plan.colored)


def _program(plan: Plan, inputs: ShadingInputs) -> Program:
    """Return the program of a plan; what writes it is imported where compiled code pays."""
    from vizlight.shading.loops import program

    work = "f4" if plan.dtype == np.float32 else "f8"
    kinds = []
    for name in (*PLACED, *SHARES):
        source: ArraySource | None = getattr(inputs, name)
        needed = name != "points" or plan.needs_points
        if source is not None and needed:
            # In float32 where nothing is lost by it.
            narrow = source.dtype == np.float32 or (source.dtype == np.float16 and work == "f4")
            kinds.append((name, work if name in SHARES else "f4" if narrow else "f8"))
    # What was asked for may hold arrays; of it the terms read whether they are kept.
    asked = ShadingOptions(components=plan.components)
    bare = dataclasses.replace(plan, options=asked, compiled=False, code="")
    return program(bare, tuple(kinds))


def _flat(source: ArraySource | NDArray[np.generic] | None, kind: str) -> Array:
    """Return all rows of an array one after the other, in the type that a kernel reads."""
    if source is None or not kind:
        return np.empty(0, np.float32)
    flat: Array = np.ascontiguousarray(source[:], dtype=kind).reshape(-1)
    return flat


def _parts(rows: slice, inputs: ShadingInputs) -> Iterator[tuple[slice, ShadingInputs]]:
    """Yield the places of one point of each row, and their inputs as arrays."""
    repeat, count = inputs.repeat, inputs.count
    sources = {name: x for name in (*PLACED, *SHARES) if (x := getattr(inputs, name)) is not None}
    shared = {name: x[rows] for name, x in sources.items() if x.shape[0] != count}
    for j in range(repeat):
        at = rows if repeat == 1 else slice(rows.start * repeat + j, rows.stop * repeat, repeat)
        own = {name: x[at] for name, x in sources.items() if name not in shared}
        yield at, dataclasses.replace(inputs, repeat=1, **shared, **own)


def _light_again(
    plan: Plan, at: slice, odd: NDArray[np.intp], part: ShadingInputs, output: Shading
) -> None:
    """Light some points of a block by NumPy."""
    few = dataclasses.replace(
        part,
        **{
            name: source[:][odd]
            for name in (*PLACED, *SHARES)
            if (source := getattr(part, name)) is not None
        },
    )
    own = Shading.of(plan, len(odd))
    shade_block(plan, slice(0, len(odd)), few, own)
    for name, values in own.arrays().items():
        getattr(output, name)[at][odd] = values
