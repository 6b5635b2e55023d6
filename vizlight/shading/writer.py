"""The text of a compiled kernel: a loop over points that holds the terms of one form and no others.

The optics come from :mod:`vizlight.model.formulas`, written out statement by statement; vector
algebra is unrolled for n components and k tangents. Arrays are flat, constants have the type of the
work, sums keep their order.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import groupby
from typing import NamedTuple

from vizlight.shading.elementary import prelude
from vizlight.shading.form import UNROLLED, Form, LightForm
from vizlight.shading.statements import Statements


class Text(NamedTuple):
    """Text of a kernel, and the names of its numbers: of the work's type, and of float64."""

    source: str
    numbers: tuple[str, ...]
    wide: tuple[str, ...]


#: Parameters of a kernel.
ARRAYS = (
    "points", "tangents", "normals", "base_tangents", "shadow", "height", "occlusion", "numbers",
    "wide", "table", "luminance", "diffuse", "specular", "rgb",
)  # fmt: skip


class _Sight(NamedTuple):
    """The eye at a point: its direction and how the manifold splits it."""

    vector: list[str]
    along: list[str]
    rest: list[str]
    size: str
    path: str


class _Body:
    """The terms of a point, in the order in which the engine's NumPy code has them."""

    def __init__(self, form: Form) -> None:
        self.form, self.w = form, Statements(form)
        self.normal: list[str] = []
        self.rows: list[list[str]] = []
        self.sheet: list[list[str]] = []
        self.place: list[str] = []
        self.height = ""

    def write(self) -> None:
        form, w = self.form, self.w
        if form.normals:
            self.normal = w.cast(w.unit(w.load("normals", form.n), form.normals)[0])
        if form.base_tangents:
            self.sheet = w.frame("base_tangents", form.base, form.base_tangents)
        if form.tangents:
            self.rows = w.frame("tangents", form.k, form.tangents)
        if form.points:
            self.place = w.load("points", form.n)
        sight = self.look()
        zero = w.constant(0.0)
        for name in self.sums():
            w.lines.append(f"{w.indent}{name} = {zero}")
        if len(form.lights) <= UNROLLED:
            for number, light in enumerate(form.lights):
                self.light(light, f"light{number}.", sight, str(number))
        else:
            self.loops(sight)
        self.store()

    def sums(self) -> list[str]:
        """Return the names of the sums over lights."""
        form = self.form
        terms = [t for t, there in (("d", form.diffuse), ("s", form.specular)) if there]
        return [t + c for t in terms for c in (("", "0", "1", "2") if form.tinted else ("",))]

    def loops(self, sight: _Sight) -> None:
        """Write one loop for each kind of light; the lights come sorted by kind."""
        w, start = self.w, 0
        for kind, group in groupby(self.form.lights):
            w.looped = range(start, start + len(list(group)))
            w.check()
            w.lines.append(f"{w.indent}for m in range({len(w.looped)}):")
            w.indent += "    "
            self.light(kind, "light.", sight, f"({start} + m)")
            w.check()
            w.indent = w.indent[:-4]
            start = w.looped.stop
        w.looped = None

    def look(self) -> _Sight:
        form, w = self.form, self.w
        if not form.eye:
            return _Sight([], [], [], "", "")
        vector, _ = w.toward(self.place, form.eye == "near", "eye")
        along, rest, size, path = list[str](), list[str](), "", ""
        if form.splits_eye and self.rows:
            along, rest, size = w.split(vector, self.rows)
        elif form.splits_eye:
            size = w.dot(self.normal, vector)
        if form.fur:
            self.height = w.name("height[i]")
            w.lines.append(f"{w.indent}odd = odd | (not {self.height} >= {w.constant(0.0)})")
            sine = w.name(f"abs({w.dot(self.normal, vector)})")
            path = w.call("fur_path", self.height, sine)
        return _Sight(vector, along, rest, size, path)

    def side(self, cosine: str) -> str:
        return self.w.call("both_sides" if self.form.two_sided else "one_side", cosine)

    def light(self, kind: LightForm, given: str, sight: _Sight, column: str) -> None:
        """Add the light of one light to the sums."""
        form, w = self.form, self.w
        vector, distance = w.toward(self.place, kind.near, given)
        scale = w.number(f"{given}intensity")
        if kind.faded:
            c = [w.number(f"{given}c{i}") for i in range(3)]
            scale = w.name(f"{scale} * {w.call('attenuation', distance, *c)}")
        along, rest, size = list[str](), list[str](), ""
        if self.rows:
            along, rest, size = w.split(vector, self.rows)
        cosine = w.dot(self.normal, vector) if self.normal else ""
        passed = ""
        if form.shadowed:
            passed = w.name(f"shadow[{len(form.lights)} * i + {column}]")
            w.lines.append(f"{w.indent}odd = odd | (not {passed} >= {w.constant(0.0)})")
        if form.conditioned:
            scale = w.name(f"{scale} * {passed or self.side(cosine)}")
        if form.fur:
            path = w.call("fur_path", self.height, w.name(f"abs({cosine})"))
            both = w.name(f"{path} + {sight.path}")
            scale = w.name(f"{scale} * {w.call('fur_passes', both, w.number('rate'))}")
        if self.sheet:
            coefficients, _, across = w.split(vector, self.sheet)
            based = self.power(form.based, across, coefficients, "base_exponent")
            scale = w.name(f"{scale} * {based}")
        split = _Sight(vector, along, rest, size or cosine, "")
        met = self.meet(split, sight) if form.cylinder else []
        if form.diffuse:
            self.add("d", w.name(f"{self.diffuse(split, met, passed)} * {scale}"), given)
        if form.specular:
            w.whole = f"{given}bit" if kind.whole else ""
            value = self.specular(kind, split, sight, met, given)
            w.whole = ""
            if form.surface:
                value = self.cut(value, cosine, passed)
            self.add("s", w.name(f"{value} * {scale}"), given)

    def add(self, term: str, value: str, given: str) -> None:
        w = self.w
        w.lines.append(f"{w.indent}{term} = {term} + {value}")
        if self.form.tinted:
            for c in range(3):
                tint = w.number(f"{given}color{c}")
                w.lines.append(f"{w.indent}{term}{c} = {term}{c} + {tint} * {value}")

    def power(self, how: str, size: str, along: list[str], exponent: str) -> str:
        """Return |wi_N| to a power."""
        if how == "plain":
            return size
        w = self.w
        return w.call("diffuse", size, w.dot(along, along), w.number(exponent))

    def diffuse(self, split: _Sight, met: list[str], passed: str) -> str:
        form, w = self.form, self.w
        if form.cylinder:
            return w.call("cylinder_diffuse", *met, w.number("least"))
        if not form.surface:
            return self.power(form.diffuse, split.size, split.along, "exponent")
        if passed:
            return passed
        side = self.side(split.size)
        if form.diffuse == "plain":
            return side
        return w.call("surface_diffuse", side, w.number("exponent"))

    def meet(self, lit: _Sight, eye: _Sight) -> list[str]:
        """Return |wi_N|, |wo_N|, wi_N . wo_N and |wi_N x wo_N| of a line."""
        w, t = self.w, self.rows[0]
        a, b = lit.rest, eye.rest
        terms = [
            f"({a[i]} * {b[j]} - {a[j]} * {b[i]}) * {t[c]}"
            for c, (i, j) in enumerate(((1, 2), (2, 0), (0, 1)))
        ]
        return [lit.size, eye.size, w.dot(a, b), w.name(f"abs({' + '.join(terms)})")]

    def specular(
        self, kind: LightForm, lit: _Sight, eye: _Sight, met: list[str], given: str
    ) -> str:
        form, w = self.form, self.w
        shininess = w.number(f"{given}shininess")
        if kind.highlight == "half":
            half = [w.number(f"{given}half{c}") for c in range(form.n)]
            if not form.surface:
                along = [w.dot(row, half) for row in self.rows]
                return w.call("blinn_of_unit", w.dot(along, along), shininess)
            cosine = w.dot(self.normal, half)
            rest = w.reject(half, [self.normal])
            value = w.call("blinn_of_unit", w.dot(rest, rest), shininess)
            return value if form.two_sided else w.call("lit_highlight", value, cosine)
        if form.surface or kind.highlight == "blinn":
            half = [w.name(f"{a} + {b}") for a, b in zip(lit.vector, eye.vector, strict=True)]
            if form.surface:
                up = w.dot(self.normal, half)
                rest = [w.name(f"{h} - {up} * {m}") for h, m in zip(half, self.normal, strict=True)]
                tangential = w.dot(rest, rest)
                if kind.highlight == "phong":
                    sides = [lit.size, eye.size]
                    if form.two_sided:
                        sides = [self.side(x) for x in sides]
                    return w.call("phong", tangential, *sides, shininess)
                up = self.side(up)
                return w.call("blinn", tangential, w.name(f"{up} * {up}"), shininess)
            along, rest, _ = w.split(half, self.rows)
            return w.call("blinn", w.dot(along, along), w.dot(rest, rest), shininess)
        sums = [w.name(f"{a} + {b}") for a, b in zip(lit.along, eye.along, strict=True)]
        tangential = w.dot(sums, sums)
        if kind.highlight == "phong":
            return w.call("phong", tangential, lit.size, eye.size, shininess)
        return self.cylinder(lit, eye, met, tangential, shininess)

    def cylinder(
        self, lit: _Sight, eye: _Sight, met: list[str], tangential: str, shininess: str
    ) -> str:
        """Return Blinn's highlight averaged over the visible half of a thin cylinder."""
        w = self.w
        a, b, _, cross = met
        whole = [w.name(f"{p} + {q}") for p, q in zip(lit.rest, eye.rest, strict=True)]
        square = w.dot(whole, whole)
        normal = w.name(f"sqrt({square})")
        value = w.call("blinn", tangential, square, shininess)
        to_eye, to_light = w.name(f"{b} * {normal}"), w.name(f"{a} * {normal}")
        cos_b = w.call("cylinder_cosine", w.dot(eye.rest, whole), to_eye)
        cos_c = w.call("cylinder_cosine", w.dot(lit.rest, whole), to_light)
        sin_b = w.call("cylinder_sine", cross, to_eye)
        sin_c = w.call("cylinder_sine", cross, to_light)
        table = f"table, {w.number('cells')}, {w.number('per_cell')}"
        both = w.name(f"integral_({cos_b}, {table}) + integral_({cos_c}, {table})")
        ends = w.call("cylinder_ends", sin_b, sin_c, shininess)
        ends = w.name(f"{ends} / ({shininess} + {w.constant(1.0)})")
        return w.call(
            "cylinder_specular", value, cos_b, both, ends, a, b, normal, w.number("least"),
            w.number("end_on"),
        )  # fmt: skip

    def cut(self, value: str, cosine: str, passed: str) -> str:
        """Remove the highlight of a surface where the light does not reach it."""
        form, w = self.form, self.w
        if not form.two_sided:
            value = w.call("lit_highlight", value, cosine)
        return w.call("shadowed_highlight", value, passed, self.side(cosine)) if passed else value

    def store(self) -> None:
        """Multiply the sums by the material, fade them with depth, write them to the output."""
        form, w = self.form, self.w
        zero = w.constant(0.0)
        fade = self.fade() if form.cue else ""
        share = ""
        if form.occluded:
            share = w.name("occlusion[i]")
            w.lines.append(f"{w.indent}odd = odd | (not {share} >= {zero})")
        w.check()
        d, s = "d" if form.diffuse else zero, "s" if form.specular else zero
        kd, ks = w.number("kd"), w.number("ks")
        light = w.call("luminance", self.ambient("ambient", share), kd, d, ks, s)
        if fade:
            light = w.call("depth_cue", light, fade, w.number("cue"))
        put = [f"luminance[i] = LOST if odd else {light}"]
        if form.components:
            put += [f"diffuse[i] = {kd} * {d}", f"specular[i] = {ks} * {s}"]
        if form.colored:
            for c in range(3):
                tint = str(c) if form.tinted else ""
                color = w.call(
                    "luminance",
                    self.ambient(f"ambient{c}", share),
                    w.number(f"kd{c}"),
                    f"d{tint}" if form.diffuse else zero,
                    w.number(f"ks{c}"),
                    f"s{tint}" if form.specular else zero,
                )
                if fade:
                    color = w.call("depth_cue", color, fade, w.number(f"cue{c}"))
                put.append(f"rgb[3 * i + {c}] = {color}")
        w.lines += [f"{w.indent}{line}" for line in put]

    def ambient(self, name: str, share: str) -> str:
        """Return an ambient term times the share of it that reaches a point."""
        ambient = self.w.number(name)
        return self.w.name(f"{ambient} * {share}") if share else ambient

    def fade(self) -> str:
        """Return the scale of the depth cue, in float64 until it is known."""
        form, w = self.form, self.w
        v = [w.name(f"{w.wide_number(f'origin{c}')} - {p}") for c, p in enumerate(self.place)]
        if form.axis:
            depth = w.dot([w.wide_number(f"axis{c}") for c in range(form.n)], v)
        else:
            depth = w.name(f"sqrt({w.dot(v, v)})")
        w.lines.append(f"{w.indent}odd = odd | (not abs({depth}) < MOST_f8)")
        ends = [w.wide_number(x) for x in ("front", "back", "front_scale", "back_scale")]
        scale = w.call(
            "smooth_depth_scale" if form.cue == "smooth" else "depth_scale", depth, *ends
        )
        return w.name(f"F({scale})")


@lru_cache(maxsize=256)
def write(form: Form) -> Text:
    """Return the text of the kernel of a form.

    Parameters
    ----------
    form : Form

    Returns
    -------
    Text
        Source of a function ``light`` of the arrays in ``ARRAYS``; it needs the name ``sqrt``. The
        luminance of points that NumPy must light is NaN: a count would halve the number of points
        in a vector.
    """
    body = _Body(form)
    body.write()
    w = body.w
    lines = [f"{name} = F({value!r})" for value, name in w.constants.items()]
    lines += ["", f"def light({', '.join(ARRAYS)}):"]
    lines += [f"    {name} = {place}" for place, name in w.hoisted.items()]
    lines += [
        "    for i in range(luminance.shape[0]):",
        "        odd = False",
        "        void = False",
    ]
    source = prelude(form.work) + "\n".join([*lines, *w.lines, ""])
    return Text(source, tuple(w.numbers), tuple(w.wide))
