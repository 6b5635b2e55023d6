"""The algebra of a graphics card: the terms of a plan as the GLSL of one fragment.

The numbers of a scene are uniforms by name (:mod:`vizlight.draw.program` gives their values),
so that a lamp or a camera can move and the text stays.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from vizlight.model import formulas
from vizlight.scene.light import NO_ATTENUATION
from vizlight.shading import display
from vizlight.shading.algebra import Lamp, Total
from vizlight.shading.symbols import Symbol, Writer, needed
from vizlight.shading.terms import light

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vizlight._types import Value
    from vizlight.shading.plan import Plan

_INPUTS = {
    "points": ("vizP", "vec3"),
    "normals": ("vizN", "vec3"),
    "tangents": ("vizT", "vec3"),
    "fur_height": ("vizHeight", "float"),
    "occlusion": ("vizShare", "float"),
    "dimensions": ("vizDimension", "float"),
}
_CALLS = {"absolute": "abs", "maximum": "max", "minimum": "min", "arctan2": "atan"}
#: Largest power for which the rounding of 1 - deficit to float32 does not show.
LARGEST_PLAIN = 1e4
#: Numbers beyond this are infinite in float32.
_MOST = 3e38
#: The power of a number in [0, 1] from its deficit; near 1 by a series, because GLSL has no log1p.
_POWER = """float viz_power(float x, float deficit, float exponent) {
  if (x <= 0.0) return exponent > 0.0 ? 0.0 : 1.0;
  float series = deficit * (1.0 + deficit * (0.5 + deficit * (1.0 / 3.0 + deficit * (0.25
    + deficit * (0.2 + deficit / 6.0)))));
  return exp(exponent * (deficit < 0.1 ? -series : log(x)));
}"""
#: The eye at a fragment: a point, or with w = 0 a direction.
_EYE = (
    "  vec3 vizToEye = vizEye.xyz - vizEye.w * vizP;\n"
    "  vec3 vizWo = vizToEye * inversesqrt(max(dot(vizToEye, vizToEye), 1e-30));\n"
)
_TURN = "  if (dot(vizN, vizWo) < -vizLean) vizN = -vizN;\n"


def number(value: float) -> str:
    """Return a number as GLSL writes it, rounded to float32's digits."""
    text = f"{max(min(float(value), _MOST), -_MOST):.9g}"
    return text if "." in text or "e" in text else f"{text}.0"


def vector(values: Sequence[float]) -> str:
    """Return a number or a vector as GLSL writes it."""
    texts = ", ".join(map(number, values))
    return f"vec{len(values)}({texts})" if len(values) > 1 else texts


def is_plain(shininess: float) -> bool:
    """Return whether the power of GLSL serves for a shininess."""
    return 0 < shininess <= LARGEST_PLAIN


def fragment(plan: Plan, *, turned: bool = False, data: bool = False) -> tuple[str, str]:
    """Return the functions and the body of a fragment shader for the light of a plan.

    Parameters
    ----------
    plan : Plan
        Plan of a surface or of one tangent per point in 3-space.
    turned : bool, default: False
        Whether the normal is turned to the eye, unless it leans away by ``vizLean`` at most.
    data : bool, default: False
        Whether the renderer's colours come from data.

    Returns
    -------
    declarations, body : str
        The body sets ``vizColor`` from ``vizT``, ``vizN``, ``vizP`` and ``vizHeight`` in view
        coordinates, ``vizShare``, the renderer's ``ambientColor`` and ``diffuseColor``, and
        uniforms.
    """
    # The terms write themselves: each operation on a symbol appends a line to the shader.
    w = Shader(plan, data=data)
    light(w, w.plan)
    body = _EYE + (_TURN if turned else "") + w.body()
    return (_POWER if "viz_power(" in body else ""), body


class Shader(Writer):
    """Writes the light of a fragment; kinds are "float", "vec3" and "bool"."""

    prefix = "viz"

    def __init__(self, plan: Plan, *, data: bool = False) -> None:
        # A uniform, so that a slider can change it without a new program.
        shininess: Value = Symbol(self, "vizShininess", "float")
        self.plain = all(is_plain(h.shininess) for h in plan.highlights) and plan.exponent > 0
        # Half vectors are the same at all points only while the eye and the lamps stay.
        highlights = tuple(h._replace(shininess=shininess, half=None) for h in plan.highlights)
        # White light on colours of data would move them along the colour map.
        specular = plan.specular and not data
        super().__init__(dataclasses.replace(plan, highlights=highlights, specular=specular), None)
        self.data, self.colored = data, True
        self.made: dict[str, Value] = {}

    # Statements.

    def statement(self, name: str, text: str, kind: str) -> str:
        """Return the declaration of a name."""
        return f"  {kind} {name} = {text};"

    def kind(self, *args: Value) -> str:
        """Return "vec3" if one of the values is a vector, else "float"."""
        return "vec3" if any(getattr(a, "kind", "") == "vec3" for a in args) else "float"

    def literal(self, value: float, kind: str) -> str:
        """Return a number."""
        del kind
        return number(value)

    def call(self, name: str, *args: Value) -> Value:
        """Return a function of numbers or vectors."""
        # GLSL's functions take vectors and numbers alike, as NumPy's do.
        texts = ", ".join(self.text(a, "float") for a in args)
        return self.named(f"{_CALLS.get(name, name)}({texts})", self.kind(*args))

    def select(self, test: Symbol, yes: Value, no: Value) -> Value:
        """Return one of two values."""
        kind = self.kind(yes, no)
        pair = [self.text(x, kind) for x in (yes, no)]
        # Both sides are evaluated; a branch would cost more on most cards.
        return self.named(f"{test.text} ? {pair[0]} : {pair[1]}", kind)

    def power(self, x: Value, deficit: Value, exponent: Value) -> Value:
        """Return a power, by GLSL's own where no digits are lost by it."""
        raised = self.text(exponent, "float")
        if self.plain:
            return self.named(f"pow(max({x.text}, 0.0), {raised})", "float")
        rest = 1.0 - x if deficit is None else deficit
        return self.named(f"viz_power({x.text}, {self.text(rest, 'float')}, {raised})", "float")

    # Inputs and numbers.

    def has(self, name: str) -> bool:
        """Return whether the fragment has an input."""
        plan = self.plan
        # Shares inside bundles and cos-theta shadows are known at the points and never come here.
        return name == "normals" and (plan.surface or plan.conditioned or plan.fur > 0)

    def read(self, name: str, lamp: Lamp | None = None) -> Value:
        """Return an interpolated input; vectors have unit length."""
        del lamp
        # The body's first lines have normalised them: interpolated unit vectors are shorter than
        # 1.
        return Symbol(self, *_INPUTS[name])

    def direction(self, name: str) -> Value:
        """Return the unit vector of an input."""
        return self.read(name)

    def frame(self, name: str, k: int) -> list[Value]:
        """Return the one tangent."""
        del k
        # One tangent needs no Gram-Schmidt; two do not interpolate, and `unfit_layout` has refused
        # them.
        return [self.read(name)]

    def number(self, value: Value) -> Value:
        """Return a number of the plan."""
        return value

    def wide(self, value: Value) -> Value:
        """Return a number of the plan."""
        return value

    def vector(self, values: Value, *, wide: bool = False) -> Value:
        """Return a vector of the plan, which is a uniform, or a constant."""
        del wide
        if isinstance(values, Symbol):
            return values
        return Symbol(self, vector(values), f"vec{len(values)}")

    def way(self, direction: Value, *, wide: bool = False) -> Value:
        """Return a direction of the plan, which is a uniform of unit length."""
        del wide
        return direction

    def difference(self, position: Value, *, wide: bool = False) -> Value:
        """Return a position less the fragment's."""
        del wide
        return position - self.read("points")

    def lamps(self) -> Iterator[Lamp]:
        """Yield the lights; their places, colours and attenuations are uniforms."""
        for lamp in super().lamps():
            i = lamp.number
            place: Value = Symbol(self, f"vizLight{i}", "vec3")
            color: Value = Symbol(self, f"vizColor{i}", "vec3")
            # The intensity is in the colour, which is then one uniform for each lamp.
            lamp.intensity, lamp.color = 1.0, color
            if lamp.position is None:
                lamp.direction = place
            else:
                lamp.position = place
            if lamp.attenuation != NO_ATTENUATION:
                lamp.attenuation = self._parts(f"vizFade{i}", "xyz")
            yield lamp

    def eye(self) -> tuple[Value, Value | None]:
        """Return the direction to the eye, which the first lines give."""
        return Symbol(self, "vizWo", "vec3"), None

    def depth(self) -> tuple[Value, Sequence[Value]]:
        """Return the depth along the axis, or from the eye, and the cue's ends and scales."""
        away = self.named("vizFrom - vizP", "vec3")
        # w tells a parallel view, whose depth is along its axis, from an eye at a point.
        text = f"vizAxis.w == 0.0 ? dot(vizAxis.xyz, {away.text}) : length({away.text})"
        return self.named(text, "float"), self._parts("vizCueEnds", "xyzw")

    def cue_color(self) -> Value:
        """Return what the depth cue fades to."""
        return Symbol(self, "vizCue", "vec3")

    def fur_rate(self) -> Value:
        """Return the rate at which fur lets light through."""
        return Symbol(self, "vizFurRate", "float")

    def color(self, term: str, coefficient: float) -> Value:
        """Return a coefficient times the renderer's colour, which holds its own coefficient."""
        del coefficient
        kind = "float" if term == "diffuse" else "vec3"
        # VTK's ambientColor and diffuseColor hold its own coefficients; a gain turns them into
        # ours.
        gain: Value = Symbol(self, f"viz{term.capitalize()}Gain", kind)
        if term == "specular":
            return gain
        # On colours of data the ambient gain has a floor, so that no value turns black.
        if self.data:
            least = Symbol(self, "vizLeastGain", "vec3")
            return self.call("maximum", gain, least) if term == "ambient" else gain
        return gain * Symbol(self, f"{term}Color", "vec3")

    def _parts(self, name: str, axes: str) -> tuple[Value, ...]:
        return tuple(Symbol(self, f"{name}.{axis}", "float") for axis in axes)

    # Vectors.

    def dot(self, a: Value, b: Value) -> Value:
        """Return a dot product."""
        return self.named(f"dot({a.text}, {b.text})", "float")

    def unit(self, v: Value) -> tuple[Value, Value]:
        """Return a unit vector and the length."""
        # 1e-30 is within float32 and far below any length that is shown.
        size = self.named(f"length({v.text})", "float")
        return self.named(f"{v.text} / max({size.text}, 1e-30)", "vec3"), size

    # What a fragment does not ask: its points are there, and it shows what is not data at the end.

    def work(self, x: Value) -> Value:
        """Return x."""
        return x

    def need(self, test: Value) -> None:
        """Do nothing."""

    def known(self, x: Value) -> None:
        """Do nothing."""

    # Results.

    def total(self) -> Total:
        """Return an empty sum over the lamps."""
        return Total(self, tinted=True)

    def added(self, total: Value | None, value: Value) -> Value:
        """Return a sum."""
        return value if total is None else total + value

    def put(self, name: str, value: Value) -> None:
        """Take a value for a result."""
        self.made[name] = value

    def body(self) -> str:
        """Return the statements that set the colour as :mod:`vizlight.shading.display` shows it."""
        color = self.made["rgb"]
        shown: Value
        # Light is a factor on the data's colour, as in `display.py`: hue and order of values stay.
        if self.data:
            luma = self.named(f"dot({color.text}, {vector(formulas.LUMA)})", "float")
            own = self.named("vizColorGain * (ambientColor + diffuseColor)", "vec3")
            shown = own * formulas.color_factor(luma, display.LEAST)
        else:
            most = self.named(f"max(max({color.text}.r, {color.text}.g), {color.text}.b)", "float")
            shown = formulas.in_range(color, most)
        # Points that could not be lit have the colour of missing data. Lines that nothing needs
        # are left out, since a compiler on a browser's main thread takes its time.
        last = f"  vec3 vizColor = vizGood ? {shown.text} : {vector(display.NO_DATA)};"
        return "\n".join([*needed(self.lines, r"\s*\w+ (\w+) = ", [last]), last])
