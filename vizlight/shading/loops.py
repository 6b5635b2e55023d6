"""Compiled light: the terms of a plan as straight-line code of one point, where numba is installed.

The algebra :class:`Loop` writes the text, which depends on the structure of a plan alone; its
numbers are two lists, ``g`` in the type of the work and ``h`` in float64. Arrays are flat,
constants have the type of the work, sums keep their order. Points out of the common range are
marked, and lit by NumPy's :func:`~vizlight.shading.arrays.shade_block`: a vector that is not finite
or with a square that has no digits, nearly dependent tangents, a lamp or the eye at the point.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vizlight import _compiled, _pool
from vizlight._types import Array, Keywords, Raw, Slice, Value, Vector
from vizlight.model import frames, highlight_integral
from vizlight.scene.light import NO_ATTENUATION
from vizlight.shading.algebra import Lamp
from vizlight.shading.arrays import SMALLEST_HELD, Shading, shade_block
from vizlight.shading.elementary import HELPERS, prelude
from vizlight.shading.inputs import PLACED, SHARES, ArraySource, ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.shading.plan import Plan
from vizlight.shading.symbols import Components, Symbol, Writer
from vizlight.shading.terms import light

#: Number of points whose multiples fill all vectors of a processor, in unrolled loops too.
LANES = 64
#: Largest space and number of tangents for which code is written out.
MOST_COMPONENTS, MOST_TANGENTS = 6, 3
#: Largest coefficient of a distance whose products float32 holds.
MOST_FADING = 1e9
#: Seconds that compiled code saves per point: of the whole, and for each light.
SAVED, SAVED_PER_LIGHT = 10e-9, 15e-9

#: Words of a plan about its code once compiled code has run, and before.
IN_WORDS = "compiled for these terms and types (numba), unusual points by NumPy"
WHERE_IT_PAYS = "where the number of points pays for its start-up (see vizlight doctor)"

#: Seconds that compiled code would have saved so far, by the key of most texts.
_MISSED: dict[tuple[object, ...], float] = {}
#: Up to this many lamps of a kind are written out; more are a loop.
UNROLLED = 4
#: Whole powers below 2^BITS are products, by the same text for all of them.
BITS = 6
RESULTS = ("luminance", "diffuse", "specular", "rgb")
#: Parameters of a kernel.
PARAMETERS = (*PLACED, *SHARES, "g", "h", "columns", "table", *RESULTS)
_CALLS = {
    "maximum": "{0} if {0} > {1} else {1}", "minimum": "{0} if {0} < {1} else {1}",
    "absolute": "abs({0})", "sqrt": "sqrt({0})", "exp": "exp_({0})",
    "arctan2": "arctan2_({0}, {1})",
}  # fmt: skip


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


class LoopProgram(NamedTuple):
    """The text of a loop, and the tables of its numbers.

    Attributes
    ----------
    source : str
        Text of a function ``light`` of the arrays in ``PARAMETERS``; it needs the name ``sqrt``.
        The luminance of points that NumPy must light is NaN: a count would halve the number of
        points in a vector.
    kinds : dict
        Types in which the loop reads its inputs, by name.
    tables : tuple of ndarray
        Numbers, wide numbers, columns of lamps, table of a cylinder's integral.
    """

    source: str
    kinds: dict[str, str]
    tables: tuple[Array, Array, NDArray[np.int64], Array]

    @property
    def kernel(self) -> _compiled.Kernel[..., None]:
        """The compiled function, which is not compiled before its first call."""
        return _kernel(self.source)

    def shade_block(self, plan: Plan, rows: Slice, inputs: ShadingInputs, output: Shading) -> None:
        """Light the points of some rows; as :func:`vizlight.shading.arrays.shade_block`."""
        for at, part in _parts(rows, inputs):
            self._shade_points(plan, at, part, output)

    def _shade_points(self, plan: Plan, at: Slice, part: ShadingInputs, output: Shading) -> None:
        # A stride takes one point of each fibre: such results are made in a row and then spread.
        kind, count, whole = plan.dtype, part.count, at.step is None
        light: Array = output.luminance[at] if whole else np.empty(count, kind)
        terms = np.empty((2, count if plan.components else 0), kind)
        color = np.empty(3 * count if plan.colored else 0, kind)
        kinds = self.kinds
        read = [_flat(getattr(part, name), kinds.get(name, "")) for name in (*PLACED, *SHARES)]
        try:
            self._run(read, [light, terms[0], terms[1], color], count)
        except _compiled.FailedError:
            # All points are marked, so that NumPy lights the block.
            light[...] = np.nan
        if not whole:
            output.luminance[at] = light
        # Points that are marked get theirs from NumPy below.
        output.valid[at] = True
        if output.diffuse is not None and output.specular is not None:
            output.diffuse[at], output.specular[at] = terms
        if output.rgb is not None:
            output.rgb[at] = color.reshape(-1, 3)
        # The sum finds a mark in one pass, without a mask.
        if np.isnan(light.sum()):
            _light_again(plan, at, np.flatnonzero(np.isnan(light)), part, output)

    def _run(self, read: list[Array], outputs: list[Array], count: int) -> None:
        """Run the kernel on rows in multiples of LANES, so that all go through the same code.

        The compiler's code for the rest of a vector rounds otherwise, and the light of a point
        would depend on how points are cut into blocks.
        """
        numbers, whole = self.tables, count - count % LANES
        if whole:
            self.kernel(
                *(a[: a.size // count * whole] for a in read),
                *numbers,
                *(a[: a.size // count * whole] for a in outputs),
            )
        if whole == count:
            return
        # The rest is filled up with points of ones to one full multiple, and their light is
        # dropped.
        widths = [a.size // count for a in (*read, *outputs)]
        rest = [np.ones(w * LANES, a.dtype) for w, a in zip(widths, (*read, *outputs), strict=True)]
        for buffer, a, w in zip(rest, read, widths, strict=False):
            buffer[: a.size - w * whole] = a[w * whole :]
        self.kernel(*rest[: len(read)], *numbers, *rest[len(read) :])
        for buffer, a, w in zip(rest[len(read) :], outputs, widths[len(read) :], strict=True):
            a[w * whole :] = buffer[: a.size - w * whole]


@lru_cache(maxsize=64)
def program(plan: Plan, kinds: tuple[tuple[str, str], ...]) -> LoopProgram:
    """Return the program of a plan.

    Parameters
    ----------
    plan : Plan
    kinds : tuple of (str, str)
        Inputs by name, and the types in which they are read: "f4" or "f8".

    Returns
    -------
    LoopProgram
    """
    w = Loop(plan, dict(kinds))
    light(w, plan)
    return w.program()


def prepare(plan: Plan, inputs: ShadingInputs) -> tuple[LoopProgram | None, str]:
    """Return the compiled form of a plan for some inputs, and the reason if none is used.

    Parameters
    ----------
    plan : Plan
    inputs : ShadingInputs

    Returns
    -------
    program : LoopProgram or None
        None where NumPy lights the points.
    reason : str
        Reason in words; empty with a compiled form.
    """
    reason = _compiled.why_not() or why_not(plan) or _beyond(plan)
    if reason:
        return None, reason
    saved = inputs.count * (SAVED + SAVED_PER_LIGHT * len(plan.scene.lights))
    # The seconds are of float32 on one thread: float64 counts twice, and threads share what is
    # saved.
    saved *= plan.dtype.itemsize / 4 / _pool.workers()
    # The text itself takes a millisecond: it is not written while nothing could pay for it.
    sort = _sort(plan)
    missed = _MISSED.get(sort, 0.0)
    # Many small runs may pay together for a start-up that no single one pays for.
    _MISSED[sort] = missed + saved
    if _compiled.could_pay(saved, missed):
        # Equal plans have equal texts, so that one compilation serves all meshes of a kind.
        candidate = program_of(plan, inputs)
        if candidate.kernel.pays(missed + saved - candidate.kernel.missed, counted=True):
            return candidate, ""
    return None, _compiled.why_not() or f"{inputs.count} points do not pay for its start-up"


def _beyond(plan: Plan) -> str:
    """Return a reason if a light or the eye stands where the type of the work has no numbers."""
    most = float(np.finfo(plan.dtype).max)
    ends = (*plan.scene.lights, plan.scene.view)
    places = [end.position for end in ends if end is not None]
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
    # A square root that keeps the type.
    scope = _compiled.generated(source, {"sqrt": math.sqrt}, "light")
    for name in HELPERS:
        scope[name] = _compiled.Kernel(
            scope[name],  # type: ignore[arg-type]
            inline=True,
            rounding=_compiled.ROUNDING,
        )
    light: Callable[..., None] = scope["light"]  # type: ignore[assignment]
    # The text calls the compiled helpers, not the plain ones.
    light.__globals__.update(scope)
    return _compiled.Kernel(light, rounding=_compiled.ROUNDING, apart=True)


def _sort(plan: Plan) -> tuple[object, ...]:
    """Return a key that tells most texts apart, to account for the time each would have saved."""
    models = frozenset(h.model for h in plan.highlights)
    near = sum(light.position is not None for light in plan.scene.lights)
    sizes = (plan.n, plan.k, plan.dtype, len(plan.scene.lights), near)
    colors = plan.colored, plan.scene.exposure is None
    return (*sizes, models, plan.surface, plan.conditioned, plan.terms, *colors)


def program_of(plan: Plan, inputs: ShadingInputs) -> LoopProgram:
    """Return the program that lights some inputs by a plan."""
    work = "f4" if plan.dtype == np.float32 else "f8"
    kinds = []
    for name, source in inputs.arrays().items():
        if name != "points" or plan.needs_points:
            # In float32 where no digit is lost by it.
            narrow = source.dtype == np.float32 or (source.dtype == np.float16 and work == "f4")
            kinds.append((name, work if name in SHARES else "f4" if narrow else "f8"))
    # The options may hold arrays; the terms read of them only whether they are kept.
    # Plans that differ in nothing else are then equal, and share a text.
    options = ShadingOptions(components=plan.components)
    bare = dataclasses.replace(plan, options=options, compiled=False, code="")
    return program(bare, tuple(kinds))


def _flat(source: ArraySource | Raw | None, kind: str) -> Array:
    """Return all rows of an array one after the other, in the type that a kernel reads."""
    if source is None or not kind:
        return np.empty(0, np.float32)
    flat: Array = np.ascontiguousarray(source[:], dtype=kind).reshape(-1)
    return flat


def _parts(rows: Slice, inputs: ShadingInputs) -> Iterator[tuple[Slice, ShadingInputs]]:
    """Yield the places of one point of each row, and their inputs as arrays."""
    repeat, count, sources = inputs.repeat, inputs.count, inputs.arrays()
    # Inputs that all points of a fibre share are read once for all of them.
    shared: Keywords = {name: x[rows] for name, x in sources.items() if x.shape[0] != count}
    for j in range(repeat):
        at = rows if repeat == 1 else slice(rows.start * repeat + j, rows.stop * repeat, repeat)
        separate: Keywords = {name: x[at] for name, x in sources.items() if name not in shared}
        yield at, dataclasses.replace(inputs, repeat=1, **shared, **separate)


def _light_again(
    plan: Plan, at: Slice, odd: NDArray[np.intp], part: ShadingInputs, output: Shading
) -> None:
    """Light some points of a block by NumPy."""
    rows: Keywords = {name: source[:][odd] for name, source in part.arrays().items()}
    few = dataclasses.replace(part, **rows)
    relit = Shading.of(plan, len(odd))
    shade_block(plan, slice(0, len(odd)), few, relit)
    for name, values in relit.arrays().items():
        getattr(output, name)[at][odd] = values


class _Length(Symbol):
    """The length of a vector, which is above 0 where the point is not marked."""

    def __gt__(self, other: Value) -> Value:
        return True if isinstance(other, float) else self.writer.operation(">", self, other)


class Loop(Writer):
    """Writes the light of one point; kinds are "f4", "f8" and "bool"."""

    def __init__(self, plan: Plan, kinds: dict[str, str]) -> None:
        super().__init__(plan)
        self.type, self.kinds = "f4" if plan.dtype == np.float32 else "f8", kinds
        self.constants: dict[tuple[float, str], str] = {}
        self.numbers: dict[str, list[float]] = {"g": [], "h": []}
        #: Numbers of the lamp that is being written.
        self.lamp: dict[str, list[float]] | None = None
        #: Squared lengths by their type, since they were last checked.
        self.squares: dict[str, list[str]] = {}
        self.sums: list[str] = []
        self.puts: list[str] = []
        self.columns: list[int] = []
        self.table: Array = np.zeros(1, plan.dtype)

    # Statements.

    def statement(self, name: str, text: str, kind: str) -> str:
        """Return an assignment."""
        del kind
        return f"{name} = {text}"

    def kind(self, *args: Value) -> str:
        """Return the wider type of some numbers."""
        return "f8" if any(getattr(a, "kind", "") == "f8" for a in args) else self.type

    def literal(self, value: float, kind: str) -> str:
        """Return the name of a typed constant."""
        return self.constants.setdefault((value, kind), f"C{len(self.constants)}")

    def call(self, name: str, *args: Value) -> Value:
        """Return a function of numbers."""
        kind = self.kind(*args)
        return self.named(_CALLS[name].format(*(self.text(a, kind) for a in args)), kind)

    def select(self, test: Symbol, yes: Value, no: Value) -> Value:
        """Return one of two numbers."""
        kind = self.kind(yes, no)
        pair = [self.text(x, kind) for x in (yes, no)]
        return self.named(f"{pair[0]} if {test.text} else {pair[1]}", kind)

    def power(self, x: Value, deficit: Value, exponent: float) -> Value:
        """Return a power; a whole one takes a factor in, or 1, for each of its bits."""
        # The bits are numbers of the program, not text, so that another whole shininess needs no
        # new compilation.
        if exponent == int(exponent) and exponent < 2**BITS:
            value: Value = None
            for bit in range(BITS):
                x = x * x if bit else x
                taken = int(exponent) >> bit & 1
                factor = self.number(taken) * x + self.number(1 - taken)
                value = value * factor if bit else factor
            return value
        # log has no value at 0, where the power is 0, or 1 for an exponent of 0.
        zero, e = self.literal(0.0, self.type), self.number(exponent)
        rest = 1.0 - x if deficit is None else deficit
        least = self.named(f"{zero} if {e.text} > {zero} else {self.literal(1.0, x.kind)}", x.kind)
        raised = self.named(f"exp_({e.text} * log_({x.text}, {rest.text}))", x.kind)
        return self.select(x > 0.0, raised, least)

    # Inputs and numbers.

    def has(self, name: str) -> bool:
        """Return whether an input is given."""
        return name in self.kinds

    def _row(self, name: str, start: int, count: int, width: int) -> Components:
        kind = self.kinds[name]
        texts = [f"{name}[{width} * i + {start + c}]" for c in range(count)]
        # F is float64 here: inputs of float32 are widened as they are read.
        texts = [f"F({text})" for text in texts] if self.type == "f8" else texts
        return Components(self.named(text, max(kind, self.type)) for text in texts)

    def read(self, name: str, lamp: Lamp | None = None) -> Value:
        """Return an input at the point."""
        if name in PLACED:
            return self._row(name, 0, self.n, self.n)
        text = f"{name}[i]"
        if lamp is not None:
            text = f"{name}[{len(self.plan.scene.lights)} * i + LAMP]"
        return self.named(text, self.type)

    def vectors(self, name: str, k: int) -> Sequence[Value]:
        """Return the k vectors of an input at the point."""
        return [self._row(name, j * self.n, self.n, k * self.n) for j in range(k)]

    def number(self, value: Value, array: str = "g") -> Value:
        """Return a number of the plan; a lamp's numbers count from its own first one."""
        if isinstance(value, Symbol):
            return value
        numbers = self.numbers if self.lamp is None else self.lamp
        numbers[array].append(float(value))
        text = f"{array}{'' if self.lamp is None else '_'}{len(numbers[array]) - 1}"
        return Symbol(self, text, "f8" if array == "h" else self.type)

    def wide(self, value: Value) -> Value:
        """Return a number of the plan in float64."""
        return self.number(value, "h")

    def vector(self, values: Sequence[float], *, wide: bool = False) -> Value:
        """Return a vector of the plan."""
        return Components(self.number(x, "h" if wide else "g") for x in values)

    def difference(self, position: Vector, *, wide: bool = False) -> Value:
        """Return a position less the point; as two float32 numbers where both are float32."""
        points = self.read("points")
        if wide or points[0].kind == "f8":
            return self.vector(position, wide=True) - points
        # Dekker's split, as in NumPy's algebra: what float32 holds of the position, and the rest.
        low = np.subtract(position, np.asarray(position, np.float32), dtype=np.float64)
        return (self.vector(position) - points) + self.vector(low.tolist())

    def toward(
        self, position: Vector | None, direction: Vector | None, *, far: bool
    ) -> tuple[Value, Value | None]:
        """Return a unit direction and the distance, in the type of the work."""
        way, distance = super().toward(position, direction, far=far)
        return way, None if distance is None else self.work(distance)

    def work(self, x: Value) -> Value:
        """Return numbers in the type of the work."""
        if isinstance(x, Components):
            return Components(map(self.work, x))
        return x if x.kind == self.type else self.named(f"F({x.text})", self.type)

    # Vectors.

    def dot(self, a: Value, b: Value) -> Value:
        """Return a dot product."""
        text = " + ".join(f"{x.text} * {y.text}" for x, y in zip(a, b, strict=True))
        return self.named(text, self.kind(*a, *b))

    def unit(self, v: Value) -> tuple[Value, Value]:
        """Return a unit vector and its length, and note the square."""
        square = self.dot(v, v)
        self.squares.setdefault(square.kind, []).append(square.text)
        # One division, then products: a processor divides several times more slowly.
        unity = self.literal(1.0, square.kind)
        inverse = self.named(f"{unity} / sqrt({square.text})", square.kind)
        return v * inverse, _Length(self, (square * inverse).text, square.kind)

    def apart(self, v: Value) -> Value:
        """Return four times NumPy's limit of dependent vectors, for NumPy to decide near cases."""
        del v
        return self.number(4 * frames.default_rtol(self.n, self.plan.dtype))

    def integral(self, z: Value, shininess: float) -> Value:
        """Return G(z) of a cylinder by its table."""
        inverse, cells = highlight_integral.table(shininess)
        self.table = cells.astype(self.plan.dtype).ravel()
        arguments = f"{self.number(cells.shape[1]).text}, {self.number(inverse).text}"
        return self.named(f"integral_({z.text}, table, {arguments})", self.type)

    # Points that NumPy lights.

    def need(self, test: Value) -> None:
        """Mark the point where a test does not hold."""
        if test is not True:
            self.lines.append(f"odd = odd | (not {test.text})")

    def known(self, x: Value) -> None:
        """Mark the point where a number is not finite; lengths are checked by their squares."""
        if not isinstance(x, _Length):
            self.lines.append(f"odd = odd | (not abs({x.text}) < MOST_{x.kind})")

    def check(self) -> None:
        """Mark the point if a square is out of range: the least too small or the sum too large."""
        for kind, squares in self.squares.items():
            # One minimum and one sum test all squares: a NaN that the minimum loses makes the sum
            # NaN, which fails the comparison.
            least = squares[0]
            for square in squares[1:]:
                least = self.named(f"{least} if {least} < {square} else {square}", kind).text
            # Squares in float64 of what becomes float32 must have roots that float32 holds.
            limit = kind if kind == self.type else f"{kind}_of_{self.type}"
            good = f"({least} > LEAST_{limit}) & ({' + '.join(squares)} < MOST_{limit})"
            self.lines.append(f"odd = odd | (not ({good}))")
        self.squares = {}

    # Lamps and results.

    def lamps(self) -> Iterator[Lamp]:
        """Yield the lamps; lamps of a kind leave the same text, and many of them become a loop."""
        self.check()
        # Each lamp is written from the same names and the same count, as lamps of a kind would not
        # leave the same text otherwise.
        lines, names, count, most = self.lines, self.names, self.count, self.count
        kinds: dict[tuple[str, ...], list[tuple[int, dict[str, list[float]]]]] = {}
        for lamp in super().lamps():
            # Names of before the lamps may be used by all, but none of one lamp by another.
            self.lines, self.names, self.count = [], dict(names), count
            self.lamp = {"g": [], "h": []}
            if lamp.attenuation != NO_ATTENUATION:
                lamp.attenuation = tuple(map(self.number, lamp.attenuation))
            yield lamp
            self.check()
            kinds.setdefault(tuple(self.lines), []).append((lamp.number, self.lamp))
            most = max(most, self.count)
        self.lines, self.names, self.count, self.lamp = lines, names, most, None
        for text, members in kinds.items():
            self._place("\n".join(text), members)

    def _place(self, text: str, lamps: list[tuple[int, dict[str, list[float]]]]) -> None:
        """Write the lamps of a kind, with the places of their numbers."""
        start = {array: len(entry) for array, entry in self.numbers.items()}
        width = {array: len(entry) for array, entry in lamps[0][1].items()}
        for _, entry in lamps:
            for array, values in entry.items():
                self.numbers[array] += values
        # g_3 is number 3 of a lamp's own: a loop finds it by the lamp's turn m, text that is
        # written out by a place of its own.
        if len(lamps) > UNROLLED:
            column = f"columns[{len(self.columns)} + m]"
            self.columns += [number for number, _ in lamps]
            text = re.sub(
                r"\b([gh])_(\d+)\b",
                lambda m: f"{m[1]}[{start[m[1]] + int(m[2])} + {width[m[1]]} * m]",
                text.replace("LAMP", column),
            )
            self.lines.append(f"for m in range({len(lamps)}):")
            self.lines += [f"    {line}" for line in text.split("\n")]
            return
        for j, (number, _) in enumerate(lamps):
            own_text = re.sub(
                r"\b([gh])_(\d+)\b",
                lambda m, j=j: f"{m[1]}{start[m[1]] + j * width[m[1]] + int(m[2])}",  # type: ignore[misc]
                text.replace("LAMP", str(number)),
            )
            self.lines += own_text.split("\n")

    def added(self, total: Value | None, value: Value) -> Value:
        """Add to a sum, which is 0 before the lamps."""
        if isinstance(value, Components):
            totals = total or [None] * len(value)
            return Components(self.added(a, b) for a, b in zip(totals, value, strict=True))
        if total is None:
            total = Symbol(self, f"sum{len(self.sums)}", self.type)
            self.sums.append(f"{total.text} = {self.literal(0.0, self.type)}")
        self.lines.append(f"{total.text} = {total.text} + {value.text}")
        return total

    def largest(self, rgb: Value) -> Value:
        """Return the largest channel of a colour."""
        red, green, blue = rgb
        return np.maximum(np.maximum(red, green), blue)

    def put(self, name: str, value: Value) -> None:
        """Write a result."""
        values = value if isinstance(value, Components) else [value]
        for c, x in enumerate(values):
            place = f"{name}[{len(values)} * i + {c}]" if len(values) > 1 else f"{name}[i]"
            text = self.text(x, self.type)
            # The luminance alone carries the mark: NaN, which sends the point to NumPy.
            self.puts.append(f"{place} = LOST if odd else {text}" if name == "luminance" else
                             f"{place} = {text}")  # fmt: skip

    def program(self) -> LoopProgram:
        """Return the program that was written."""
        self.check()
        body = [*self.sums, *self.lines, *self.puts]
        # Numbers are read from their arrays once, before the loop over the points.
        used = sorted(set(re.findall(r"\b[gh]\d+\b", "\n".join(body))))
        # A plain number of Python would widen work in float32 to float64.
        types = {"f4": "np.float32", "f8": "np.float64"}
        text = [
            *(f"{name} = {types[k]}({x!r})" for (x, k), name in self.constants.items()),
            "",
            f"def light({', '.join(PARAMETERS)}):",
            *(f"    {name} = {name[0]}[{name[1:]}]" for name in used),
            "    for i in range(luminance.shape[0]):",
            "        odd = False",
            *(f"        {line}" for line in body),
            "",
        ]
        kind = self.plan.dtype
        # One number at least, so that the arrays have a type.
        tables = (
            np.array(self.numbers["g"] or [0], kind),
            np.array(self.numbers["h"] or [0], np.float64),
            np.array(self.columns or [0], np.int64),
            self.table,
        )
        return LoopProgram(prelude(self.type) + "\n".join(text), self.kinds, tables)
