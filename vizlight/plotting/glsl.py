"""The light of a plan as GLSL, written from the formulas of the compiled light."""

from __future__ import annotations

import ast
import functools
import inspect
from typing import TYPE_CHECKING

from vizlight.model import formulas
from vizlight.scene.light import NO_ATTENUATION
from vizlight.shading import display

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vizlight.shading.plan import Plan

#: Prefix of all names, so that none is one of VTK's or of the language.
PREFIX = "viz_"
_OPERATORS: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Lt: "<", ast.LtE: "<=",
    ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
}  # fmt: skip
_CALLS = {
    "absolute": "abs", "arctan2": "atan", "exp": "exp", "maximum": "max", "minimum": "min",
}  # fmt: skip
#: Largest power for which the rounding of 1 - deficit to float32 does not show.
LARGEST_PLAIN = 1e4
_PLAIN_POWER = f"""float {PREFIX}power(float x, float deficit, float exponent) {{
  return pow(max(x, 0.0), exponent);
}}"""
#: The power of a number in [0, 1] from its deficit; near 1 by a series, because GLSL has no log1p.
_POWER = f"""float {PREFIX}power(float x, float deficit, float exponent) {{
  if (x <= 0.0) return exponent > 0.0 ? 0.0 : 1.0;
  float series = deficit * (1.0 + deficit * (0.5 + deficit * (1.0 / 3.0 + deficit * (0.25
    + deficit * (0.2 + deficit / 6.0)))));
  return exp(exponent * (deficit < 0.1 ? -series : log(x)));
}}"""


def functions(names: Iterable[str], *, plain: bool = False) -> str:
    """Return formulas as GLSL, with those that they call before them.

    Parameters
    ----------
    names : iterable of str
        Names of functions of :mod:`vizlight.model.formulas`.
    plain : bool, default: False
        Whether all powers are above 0 and not large, so that the power of GLSL serves.

    Returns
    -------
    str

    Raises
    ------
    SyntaxError
        If a formula is not a straight line of arithmetic.
    """
    made: dict[str, str] = {}

    def add(name: str) -> None:
        if name in made:
            return
        if name == "power":
            made[name] = _PLAIN_POWER if plain else _POWER
            return
        text, called = _function(name)
        for other in called:
            add(other)
        made[name] = text

    for name in names:
        add(name)
    return "\n".join(made.values())


@functools.cache
def _syntax() -> dict[str, ast.FunctionDef]:
    tree = ast.parse(inspect.getsource(formulas))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


@functools.cache
def _function(name: str) -> tuple[str, tuple[str, ...]]:
    """Return a formula as GLSL, and the names of the formulas that it calls."""
    node, called = _syntax()[name], []

    def expression(e: ast.expr) -> str:
        if isinstance(e, ast.BinOp) and type(e.op) in _OPERATORS:
            return f"({expression(e.left)} {_OPERATORS[type(e.op)]} {expression(e.right)})"
        if isinstance(e, ast.UnaryOp) and isinstance(e.op, ast.USub):
            return f"(-{expression(e.operand)})"
        if isinstance(e, ast.Constant) and isinstance(e.value, int | float):
            return number(e.value)
        if isinstance(e, ast.Name):
            return e.id
        if isinstance(e, ast.Compare) and len(e.ops) == 1 and type(e.ops[0]) in _OPERATORS:
            sign = _OPERATORS[type(e.ops[0])]
            return f"{expression(e.left)} {sign} {expression(e.comparators[0])}"
        if isinstance(e, ast.Call) and isinstance(e.func, ast.Name) and not e.keywords:
            arguments = [expression(argument) for argument in e.args]
            if e.func.id == "where":
                return "({} ? {} : {})".format(*arguments)
            if e.func.id == "only":
                return "({} ? {} : 0.0)".format(*arguments)
            if e.func.id not in _CALLS:
                called.append(e.func.id)
            own = _CALLS.get(e.func.id, PREFIX + e.func.id)
            return f"{own}({', '.join(arguments)})"
        raise SyntaxError(f"{name}, line {e.lineno}: {ast.unparse(e)} is not straight arithmetic")

    lines = []
    for statement in node.body:
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
            continue
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            lines.append(f"  float {statement.targets[0].id} = {expression(statement.value)};")
        elif isinstance(statement, ast.Return) and statement.value is not None:
            lines.append(f"  return {expression(statement.value)};")
        else:
            text = ast.unparse(statement)
            raise SyntaxError(f"{name}, line {statement.lineno}: {text} is not an assignment")
    parameters = ", ".join(f"float {argument.arg}" for argument in node.args.args)
    body = "\n".join(lines)
    return f"float {PREFIX}{name}({parameters}) {{\n{body}\n}}", tuple(called)


def number(value: float) -> str:
    """Return a number as GLSL writes it, rounded to float32's digits."""
    text = f"{float(value):.9g}"
    return text if any(c in text for c in ".einf") else f"{text}.0"


def vector(values: Sequence[float]) -> str:
    """Return a number or a vector as GLSL writes it."""
    texts = ", ".join(map(number, values))
    return f"vec{len(values)}({texts})" if len(values) > 1 else texts


def is_plain(shininess: float) -> bool:
    """Return whether the power of GLSL serves for a shininess."""
    return 0 < shininess <= LARGEST_PLAIN


class _Writer:
    """Lines of a fragment shader and the formulas that they call."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.used: dict[str, None] = {}

    def add(self, line: str) -> None:
        self.lines.append(f"  {line}")

    def call(self, name: str, *arguments: str) -> str:
        """Return the call of a formula."""
        self.used[name] = None
        return f"{PREFIX}{name}({', '.join(arguments)})"


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
    w = _Writer()
    w.add("vec3 vizToEye = vizEye.xyz - vizEye.w * vizP;")
    w.add("vec3 vizWo = vizToEye * inversesqrt(max(dot(vizToEye, vizToEye), 1e-30));")
    if turned:
        w.add("if (dot(vizN, vizWo) < -vizLean) vizN = -vizN;")
    w.add("vec3 vizDiffuse = vec3(0.0); vec3 vizSpecular = vec3(0.0);")
    if plan.surface or plan.conditioned or plan.fur:
        w.add("float vizNo = dot(vizN, vizWo);")
    if not plan.surface:
        w.add("float vizOt = dot(vizWo, vizT);")
        w.add("float vizOn = length(vizWo - vizOt * vizT);")
    for i in range(len(plan.scene.lights)):
        w.add("{")
        _light(w, plan, i)
        w.add("}")
    share = "vizShare * " if plan.occluded else ""
    if data:
        w.add(f"vec3 vizColor = {share}max(vizAmbientGain, vizLeastGain);")
        w.add("vizColor += vizDiffuseGain * vizDiffuse;")
    else:
        w.add(f"vec3 vizColor = {share}vizAmbientGain * ambientColor;")
        w.add("vizColor += vizSpecularGain * vizSpecular;")
        w.add("vizColor += vizDiffuseGain * diffuseColor * vizDiffuse;")
    _cue(w, plan)
    _shown(w, data=data)
    plain = all(is_plain(highlight.shininess) for highlight in plan.highlights)
    return functions(w.used, plain=plain and plan.exponent > 0), "\n".join(w.lines)


def _light(w: _Writer, plan: Plan, i: int) -> None:
    """Add the diffuse and the specular light of one light."""
    light, highlight = plan.scene.lights[i], plan.highlights[i]
    if light.position is None:
        w.add(f"vec3 wi = vizLight{i};")
    else:
        w.add(f"vec3 ray = vizLight{i} - vizP;")
        w.add("float distance = length(ray); vec3 wi = ray / max(distance, 1e-30);")
    w.add("float scale = 1.0;")
    if light.attenuation != NO_ATTENUATION:
        fade = [f"vizFade{i}.{axis}" for axis in "xyz"]
        w.add(f"scale = {w.call('attenuation', 'distance', *fade)};")
    side = "both_sides" if plan.two_sided else "one_side"
    if plan.surface or plan.conditioned or plan.fur:
        w.add("float cosine = dot(vizN, wi);")
    if plan.conditioned:
        w.add(f"scale *= {w.call(side, 'cosine')};")
    if plan.fur:
        ways = [w.call("fur_path", "vizHeight", f"abs({name})") for name in ("cosine", "vizNo")]
        w.add(f"scale *= {w.call('fur_passes', ' + '.join(ways), 'vizFurRate')};")
    shininess, exponent = "vizShininess", number(plan.exponent)
    if plan.surface:
        lit = w.call(side, "cosine")
        kept = lit if plan.exponent == 1 else w.call("surface_diffuse", lit, exponent)
        w.add(f"float kept = {kept};")
        w.add("vec3 h = wi + vizWo; float up = dot(h, vizN); h -= up * vizN;")
        w.add(f"float shine = {_surface_highlight(w, plan, highlight.model, side, shininess)};")
    else:
        w.add("float along = dot(wi, vizT); float across = length(wi - along * vizT);")
        sine = ("across", "along * along", exponent)
        w.add(f"float kept = {'across' if plan.exponent == 1 else w.call('diffuse', *sine)};")
        if highlight.model == "phong":
            w.add("float both = along + vizOt;")
            value = w.call("phong", "both * both", "across", "vizOn", shininess)
        else:
            w.add("vec3 h = wi + vizWo; float up = dot(h, vizT); h -= up * vizT;")
            value = w.call("blinn", "up * up", "dot(h, h)", shininess)
        w.add(f"float shine = {value};")
    if plan.diffuse:
        w.add(f"vizDiffuse += scale * kept * vizColor{i};")
    if plan.specular:
        w.add(f"vizSpecular += scale * shine * vizColor{i};")


def _surface_highlight(w: _Writer, plan: Plan, model: str, side: str, shininess: str) -> str:
    """Return the highlight of a surface, cut where the light does not reach its side."""
    if model == "phong":
        cosines = ("cosine", "vizNo")
        if plan.two_sided:
            cosines = ("abs(cosine)", "abs(vizNo)")
        value = w.call("phong", "dot(h, h)", *cosines, shininess)
    else:
        facing = w.call(side, "up")
        value = w.call("blinn", "dot(h, h)", f"{facing} * {facing}", shininess)
    return value if plan.two_sided else w.call("lit_highlight", value, "cosine")


def _cue(w: _Writer, plan: Plan) -> None:
    """Add the depth cue."""
    cue = plan.scene.depth_cue
    if cue is None:
        return
    name = "smooth_depth_scale" if cue.smooth else "depth_scale"
    ends = [f"vizCueEnds.{axis}" for axis in "xyzw"]
    w.add("float vizDepth = vizAxis.w == 0.0 ? dot(vizAxis.xyz, vizFrom - vizP)")
    w.add("  : length(vizFrom - vizP);")
    w.add(f"float vizKept = {w.call(name, 'vizDepth', *ends)};")
    channels = [w.call("depth_cue", f"vizColor.{c}", "vizKept", f"vizCue.{c}") for c in "rgb"]
    w.add(f"vizColor = vec3({', '.join(channels)});")


def _shown(w: _Writer, *, data: bool) -> None:
    """Turn light into a colour that a screen shows, as :mod:`vizlight.shading.display` does."""
    if data:
        light = f"dot(vizColor, {vector(formulas.LUMA)})"
        factor = w.call("color_factor", light, number(display.LEAST))
        w.add(f"vizColor = vizColorGain * (ambientColor + diffuseColor) * {factor};")
    else:
        w.add("float vizMost = max(max(vizColor.r, vizColor.g), vizColor.b);")
        channels = [w.call("in_range", f"vizColor.{c}", "vizMost") for c in "rgb"]
        w.add(f"vizColor = vec3({', '.join(channels)});")
    w.add(f"if (!vizGood) vizColor = {vector(display.NO_DATA)};")
