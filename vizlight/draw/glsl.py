"""The light of a plan as a program of a graphics card, and the numbers that it is given.

The terms of a plan write the GLSL of one fragment. The numbers of a scene are uniforms by name,
so that a lamp or a camera can move and the text stays. One text serves all renderers; the
differences between them are a dialect (:mod:`vizlight.draw.dialects`).
"""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Iterator, Sequence
from importlib import resources
from typing import Literal, NamedTuple

import numpy as np

from vizlight import _check
from vizlight._types import Color, Value
from vizlight.draw.symbols import Symbol, Writer, needed, number
from vizlight.model import formulas
from vizlight.scene import DepthCue, Light, Scene, View
from vizlight.scene.light import NO_ATTENUATION, WHITE
from vizlight.shading import display
from vizlight.shading.algebra import Lamp, Total
from vizlight.shading.plan import Plan
from vizlight.shading.terms import light

_INPUTS = {
    "points": ("vizP", "vec3"),
    "normals": ("vizN", "vec3"),
    "tangents": ("vizT", "vec3"),
    "fur_height": ("vizHeight", "float"),
    "occlusion": ("vizShare", "float"),
    "dimensions": ("vizDimension", "float"),
}
#: Largest power for which the rounding of 1 - deficit to float32 does not show.
LARGEST_PLAIN = 1e4
#: Texture of the heights of a field.
HEIGHTS = "vizField"
#: The eye at a fragment: a point, or with w = 0 a direction.
_EYE = (
    "  vec3 vizToEye = vizEye.xyz - vizEye.w * vizP;\n"
    "  vec3 vizWo = vizToEye * inversesqrt(max(dot(vizToEye, vizToEye), 1e-30));\n"
)
_TURN = "  if (dot(vizN, vizWo) < -vizLean) vizN = -vizN;\n"


def vector(values: Sequence[float]) -> str:
    """Return a number or a vector as GLSL writes it."""
    texts = ", ".join(map(number, values))
    return f"vec{len(values)}({texts})" if len(values) > 1 else texts


def is_plain(shininess: float) -> bool:
    """Return whether the power of GLSL serves for a shininess."""
    return 0 < shininess <= LARGEST_PLAIN


def fragment(plan: Plan, *, turned: bool = False, data: bool = False) -> tuple[str, str]:
    """Return the functions and the body of a fragment shader for the light of a plan.

    With ``turned`` the normal is turned to the eye, unless it leans away by ``vizLean`` at most;
    ``data`` are colours of the renderer. The body sets ``vizColor`` from ``vizT``, ``vizN``,
    ``vizP`` and ``vizHeight`` in view coordinates, ``vizShare``, the renderer's ``ambientColor``
    and ``diffuseColor``, and uniforms.
    """
    # The terms write themselves: each operation on a symbol appends a line to the shader.
    w = FragmentShader(plan, data=data)
    light(w, w.plan)
    body = _EYE + (_TURN if turned else "") + w.body()
    functions = {"power": "viz_power(" in body, "shadow": plan.shadowed}
    return "\n".join(_functions(name) for name, used in functions.items() if used), body


@functools.cache
def _functions(name: str) -> str:
    """Return the functions of a file of GLSL, without the comment at its begin."""
    text = resources.files("vizlight.draw").joinpath(f"{name}.glsl").read_text("utf-8")
    return re.sub(r"\A(//.*\n)+", "", text).rstrip()


class FragmentShader(Writer):
    """Writes the light of a fragment; kinds are "float", "vec3" and "bool"."""

    def __init__(self, plan: Plan, *, data: bool = False) -> None:
        # A uniform, so that a slider can change it without a new program.
        shininess: Value = Symbol(self, "vizShininess", "float")
        self.plain = all(is_plain(h.shininess) for h in plan.highlights) and plan.exponent > 0
        # Half vectors are the same at all points only while the eye and the lamps stay.
        highlights = tuple(h._replace(shininess=shininess, half=None) for h in plan.highlights)
        # White light on colours of data would move them along the colour map.
        specular = plan.specular and not data
        super().__init__(dataclasses.replace(plan, highlights=highlights, specular=specular))
        self.data, self.colored = data, True
        self.made: dict[str, Value] = {}

    def power(self, x: Value, deficit: Value, exponent: Value) -> Value:
        """Return a power, by GLSL's own where no digits are lost by it."""
        raised = self.text(exponent)
        # GLSL leaves pow of a number below 0 undefined, which rounding may give.
        if self.plain:
            return self.named(f"pow(max({x.text}, 0.0), {raised})", "float")
        rest = 1.0 - x if deficit is None else deficit
        return self.named(f"viz_power({x.text}, {self.text(rest)}, {raised})", "float")

    # Inputs and numbers.

    def has(self, name: str) -> bool:
        """Return whether the fragment has an input."""
        plan = self.plan
        # Shares inside bundles are known at the points and never come here.
        return name == "normals" and (plan.surface or plan.conditioned or plan.fur > 0)

    def read(self, name: str, lamp: Lamp | None = None) -> Value:
        """Return an interpolated input, or the shadow of a lamp; vectors have unit length."""
        if name == "shadow" and lamp is not None:
            i, near = lamp.number, number(float(lamp.position is not None))
            return self.named(f"viz_shadow({HEIGHTS}, vizP, vizN, vizLight{i}, {near})", "float")
        # The body's first lines have normalised them: interpolated unit vectors are shorter than
        # 1.
        return Symbol(self, *_INPUTS[name])

    direction = read

    def frame(self, name: str, k: int) -> list[Value]:
        """Return the one tangent."""
        del k
        # One tangent needs no Gram-Schmidt; two do not interpolate, and `unfit_layout` has refused
        # them.
        return [self.read(name)]

    def number(self, value: Value) -> Value:
        """Return a number of the plan."""
        return value

    wide = number

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
        """Return the colour to which the depth cue fades."""
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
        # The white sum is written as well, and left out at the end where nothing needs it.
        return Total(self, tinted=True)

    def added(self, total: Value | None, value: Value) -> Value:
        """Return a sum."""
        return value if total is None else total + value

    def largest(self, rgb: Value) -> Value:
        """Return the largest channel of a colour."""
        return self.named(f"max(max({rgb.text}.r, {rgb.text}.g), {rgb.text}.b)", "float")

    def exposed(self, rgb: Value) -> Value:
        """Return an exposed colour; of colours of data the factor is exposed at the end."""
        return rgb if self.data else super().exposed(rgb)

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
            base = self.named("vizColorGain * (ambientColor + diffuseColor)", "vec3")
            if self.plan.scene.exposure is not None:
                luma = luma * formulas.exposed(luma, self.number(self.plan.scene.exposure))
            shown = base * formulas.color_factor(luma, display.LEAST)
        else:
            shown = formulas.in_range(color, self.largest(color))
        # Points that could not be lit have the colour of missing data. Lines that nothing needs
        # are left out, since a compiler on a browser's main thread takes its time.
        last = f"  vec3 vizColor = vizGood ? {shown.text} : {vector(display.NO_DATA)};"
        return "\n".join([*needed(self.lines, r"\s*\w+ (\w+) = ", [last]), last])


#: Number of lights for which a program is written.
MOST_LIGHTS = 16


class Uniform(NamedTuple):
    """Number or vector that a program is given, in world coordinates.

    ``kind`` is the type of GLSL, "float", "vec3" or "vec4", and ``space``, "direction", "position"
    or empty, is that of the first three numbers: the program takes directions (of unit length) and
    positions in view coordinates.
    """

    name: str
    kind: Literal["float", "vec3", "vec4"]
    value: tuple[float, ...]
    space: Literal["", "direction", "position"] = ""


class Varying(NamedTuple):
    """Vector that is interpolated between vertices, and its value at a vertex.

    ``value`` holds ``{position}``, ``{normal}`` or ``{tangent}``, in view coordinates,
    ``{length}`` or ``{size}``, the length of the normal or of the tangent as it was given, or
    ``{along}`` or ``{course}``, the normal or the tangent as a direction in clip coordinates.
    """

    name: str
    kind: Literal["float", "vec2", "vec3", "vec4"]
    value: str


#: What a tangent of a mesh of several kinds of cells is longer by for each dimension that a point
#: has less than a face, and that dimension.
LENGTHS = 2.0
DIMENSION = "(2.0 - step(2.5, {size}) - step(4.5, {size}))"


class Stroke(NamedTuple):
    """How wide lines are drawn, and whether they are lit as a cylinder across their width.

    The ``diameter`` is in the unit of the mesh; None for a width in pixels. A ``round`` line has
    the normal of the cylinder that it stands for in each fragment. ``halo`` is the width of the
    band on each side, in widths of the line, and ``outline`` its colour, None for that of the
    ground; ``width`` names the point array of widths, as shares from 0 to 1 of that of the line,
    None for one width.
    """

    diameter: float | None = None
    round: bool = False
    halo: float = 0.0
    width: str | None = None
    outline: str | None = None


#: Direction of the line at a vertex; its array takes the place of normals.
ALONG = Varying("vizD", "vec4", "{along}")
#: The same where normals are those of a surface: the line is lit by its tangents.
COURSE = Varying("vizD", "vec4", "{course}")
#: What lines with halos have: the place across a line and past either end, in half widths, the
#: changes of depth of the line and of the border of its halo, and the widths at both ends.
HALO = (Varying("vizLine", "vec3", "vec3(0.0)"), Varying("vizDeep", "vec4", "vec4(0.0)"))
#: Length of the direction of a line, which is longer by 1 at an end, and by half of a width.
END = Varying("vizEnd", "float", "{length}")
#: Normal of the cylinder at a fragment, from the tangent and the place across the line.
CYLINDER_NORMAL = """  vec3 vizLast = vec3(MCDCMatrix[0][3], MCDCMatrix[1][3], MCDCMatrix[2][3]);
  vec3 vizFront = vizLast == vec3(0.0) ? vec3(0.0, 0.0, 1.0) : -vizP;
  vizFront -= dot(vizFront, vizT) * vizT;
  vizFront *= inversesqrt(max(dot(vizFront, vizFront), 1e-30));
  float vizX = clamp(vizXVSOutput, -1.0, 1.0);
  vec3 vizN = sqrt(1.0 - vizX * vizX) * vizFront + vizX * cross(vizFront, vizT);
"""


class Program(NamedTuple):
    """Text of a fragment shader, and its inputs.

    The body sets ``vizColor`` from varyings, uniforms, ``ambientColor`` and ``diffuseColor``.
    """

    functions: str
    body: str
    varyings: tuple[Varying, ...]


#: Statements that turn the normal where its length does not say how.
_TOWARD = {
    "": "",
    "eye": "  if (dot(vizN, vizEye.xyz - vizEye.w * vizP) < 0.0) vizN = -vizN;\n",
    "face": (
        "  vec3 vizFace = cross(dFdx(vizP), dFdy(vizP));\n"
        "  if (dot(vizFace, vizEye.xyz - vizEye.w * vizP) * dot(vizFace, vizN) < 0.0)\n"
        "    vizN = -vizN;\n"
    ),
}


def suffixed(name: str) -> str:
    """Return the name of a varying as a fragment shader reads it."""
    return f"{name}VSOutput"


def write(
    plan: Plan,
    *,
    turned: bool,
    toward: Literal["", "eye", "face"] = "",
    stroke: Stroke = Stroke(),  # noqa: B008
    data: bool = False,
    sky: bool = False,
) -> Program:
    """Return the program of a plan.

    The plan is that of a surface or of one tangent per point in 3-space, in its exact form; round
    strokes have the plan of the surface of their cylinders. With ``turned`` the normal is turned to
    the eye, unless it leans away by the sine in its length, 1 at -1 and 2 at 1. Where normals have
    no such length, ``toward`` turns them to the "eye", or to the side of the "face" that is seen,
    which may lean away between the corners; a line has no face. ``data`` are colours of the
    renderer that light keeps readable, and with ``sky`` the number ``vizSky`` says how much the
    share of the ambient light counts.
    """
    # Varyings are declared only where the body reads them: the least that WebGL has are eight.
    functions, body = fragment(plan, turned=turned, data=data)
    mixed = plan.line_exponent is not None
    names = [Varying("vizP", "vec3", "{position}")]
    # vizGood turns false where a vector has no length; such fragments show no data.
    read = f"  vec3 vizP = {suffixed('vizP')};\n  bool vizGood = true;\n"
    if (plan.surface and not stroke.round) or plan.conditioned or plan.fur:
        names.append(Varying("vizN", "vec3", "{normal}"))
        read += _unit("vizN") + _TOWARD[toward]
        if stroke.halo and (plan.conditioned or plan.fur):
            names.append(COURSE)
    elif stroke != Stroke():
        # A stroke without normals needs the direction of the line, by which VTK's geometry is
        # widened.
        names += [ALONG, END] if stroke.halo or stroke.width else [ALONG]
    if stroke.halo:
        names += HALO
    if plan.fur or turned:
        names.append(Varying("vizH", "float", "{length} - 1.0"))
    if plan.occluded:
        # The dimension of the point is in the same length, in steps of LENGTHS: they are taken
        # off.
        past = f" - {2 * LENGTHS:.1f} + {LENGTHS:.1f} * {DIMENSION}" if mixed else ""
        names.append(Varying("vizS", "float", "{size} - 1.0" + past))
        share = suffixed("vizS")
        read += f"  float vizShare = {f'mix(1.0, {share}, vizSky)' if sky else share};\n"
    if mixed:
        names.append(Varying("vizK", "float", DIMENSION))
        read += f"  float vizDimension = {suffixed('vizK')};\n"
    if stroke.round or not plan.surface or mixed:
        names.append(Varying("vizT", "vec3", "{tangent}"))
        read += _unit("vizT")
    if stroke.round:
        names.append(Varying("vizX", "float", "0.0"))
        # The eye sees half of a cylinder: the place across it in -1 to 1 is the sine of the
        # normal's angle.
        read += CYLINDER_NORMAL
    if turned:
        # The length came as 1 to 2: back to a lean of -1 to 1.
        read += f"  float vizLean = 2.0 * {suffixed('vizH')} - 1.0;\n"
    if plan.fur:
        read += f"  float vizHeight = vizTallest * max({suffixed('vizH')}, 0.0);\n"
    return Program(functions, read + body, tuple(names))


def numbers(
    scene: Scene,
    lights: Sequence[Light],
    ambient: float = 1.0,
    diffuse: float = 1.0,
    specular_color: Color = WHITE,
    *,
    fur: float,
    tallest: float,
    data: bool = False,
) -> list[Uniform]:
    """Return the numbers of the program of a scene.

    The scene has the ends of its depth cue, and headlights are fixed.
    A renderer has multiplied its colours by ``ambient`` and ``diffuse``. ``fur`` is the density of
    the fur, 0 for none, and ``tallest`` the height of fur with a normal of length 2.
    """
    if len(lights) > MOST_LIGHTS:
        raise _check.value_error("lights", f"at most {MOST_LIGHTS} lights", str(len(lights)))
    # Light on colours of data is a factor, which the colours of a renderer must not hold already.
    held = (1.0, 1.0, WHITE) if data else (ambient, diffuse, specular_color)
    uniforms = [
        *_of_lights(lights),
        *_of_material(scene, *held),
        *_of_view(scene.depth_cue, scene.view),
    ]
    if data:
        least = scene.ambient_intensity * display.LEAST
        around = tuple(least * c for c in scene.ambient_color or WHITE)
        uniforms.append(Uniform("vizLeastGain", "vec3", around))
        # VTK multiplies a scalar colour by ambient and diffuse before the light sees it.
        gain = _ratio(1.0, ambient + diffuse)
        uniforms.append(Uniform("vizColorGain", "float", (gain,)))
    if fur:
        # Fur of density 1 lets through what is less than any float.
        # log(1 - density): density 1 would be -inf, which GLSL has not.
        rate = float(np.log1p(-min(fur, 1 - 1e-12)))
        uniforms.append(Uniform("vizFurRate", "float", (rate,)))
        uniforms.append(Uniform("vizTallest", "float", (tallest,)))
    return uniforms


def _unit(name: str) -> str:
    """Return statements that read a varying as a unit vector."""
    varying = suffixed(name)
    return (
        f"  float {name}Size = length({varying});\n"
        f"  vizGood = vizGood && {name}Size > 1e-6;\n"
        f"  vec3 {name} = {varying} / max({name}Size, 1e-6);\n"
    )


def _of_lights(lights: Sequence[Light]) -> list[Uniform]:
    uniforms = []
    for i, lamp in enumerate(lights):
        if lamp.position is not None:
            uniforms.append(Uniform(f"vizLight{i}", "vec3", lamp.position, "position"))
            # Only a lamp at a place fades with distance.
            uniforms.append(Uniform(f"vizFade{i}", "vec3", lamp.attenuation))
        elif lamp.direction is not None:
            uniforms.append(Uniform(f"vizLight{i}", "vec3", lamp.direction, "direction"))
        # Intensity and colour are one vector; a lamp without a colour is white.
        color = tuple(lamp.intensity * c for c in lamp.color or WHITE)
        uniforms.append(Uniform(f"vizColor{i}", "vec3", color))
    return uniforms


def _of_material(
    scene: Scene, ambient: float, diffuse: float, specular_color: Color
) -> list[Uniform]:
    material = scene.material
    gain = scene.ambient_intensity * _ratio(material.ambient, ambient)
    around = scene.ambient_color or WHITE
    shine = tuple(material.specular * c for c in specular_color)
    return [
        Uniform("vizAmbientGain", "vec3", tuple(gain * c for c in around)),
        Uniform("vizDiffuseGain", "float", (_ratio(material.diffuse, diffuse),)),
        Uniform("vizSpecularGain", "vec3", shine),
        Uniform("vizShininess", "float", (material.shininess,)),
    ]


def _ratio(wanted: float, shown: float) -> float:
    """Return the factor by which a coefficient of a renderer must be multiplied."""
    return wanted / shown if shown > 0 else 0.0


def _of_view(cue: DepthCue | None, view: View | None) -> list[Uniform]:
    """Return the eye, as a point or as a direction with 0 after it, and the depth cue."""
    # Without a view the eye is at infinity along z of view coordinates.
    eye = Uniform("vizEye", "vec4", (0.0, 0.0, 1.0, 0.0))
    # w = 0 is a direction, w = 1 a point: one text serves both projections.
    if view is not None and view.parallel and view.direction is not None:
        eye = Uniform("vizEye", "vec4", (*view.direction, 0.0), "direction")
    elif view is not None and view.position is not None:
        eye = Uniform("vizEye", "vec4", (*view.position, 1.0), "position")
    if cue is None or view is None or cue.front is None or cue.back is None:
        return [eye]
    axis = Uniform("vizAxis", "vec4", (0.0, 0.0, 0.0, 1.0))
    if view.direction is not None:
        axis = Uniform("vizAxis", "vec4", (*view.direction, 0.0), "direction")
    ends = (cue.front, cue.back, cue.front_scale, cue.back_scale)
    return [
        eye,
        axis,
        Uniform("vizFrom", "vec3", view.position or (0.0, 0.0, 0.0), "position"),
        Uniform("vizCueEnds", "vec4", ends),
        Uniform("vizCue", "vec3", tuple(cue.cue * c for c in cue.color or WHITE)),
    ]
