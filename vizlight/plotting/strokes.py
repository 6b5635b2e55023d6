"""Lines as wide as cylinders of a diameter, by shader replacement on an actor."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from vizlight.plotting import glsl

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vtkmodules.vtkRenderingCore import vtkActor

#: Width in pixels above 1, as VTK draws no quads for narrower lines; also the least width of lines
#: of a diameter, so that none breaks up.
LEAST = 1.01
#: Cosine of the angle between a segment and the tangent of the line up to which ends are mitred.
SHARPEST = 0.5
#: Direction of the line at a vertex in clip coordinates; its array takes the place of normals.
ALONG = ("vizD", "vec4", "MCDCMatrix * vec4(normalMC, 0.0)")


class Stroke(NamedTuple):
    """How wide lines are drawn, and whether light is that of a cylinder across them.

    Attributes
    ----------
    diameter : float or None
        Diameter in the unit of the mesh; None for a width in pixels.
    round : bool
        Whether each fragment has the normal of the cylinder that the line stands for.
    """

    diameter: float | None = None
    round: bool = False


def widen(actor: vtkActor, stroke: Stroke) -> None:
    """Draw the lines of an actor with the diameter of a stroke, in the colours that they have.

    The active normals of what is drawn are the tangents of its lines.
    """
    actor.GetProperty().SetInterpolationToGouraud()
    pass_on(actor, [ALONG], "in vec3 normalMC;\n", stroke)
    for mark in ("//VTK::Normal::Dec", "//VTK::Normal::Impl", "//VTK::Depth::Impl"):
        actor.GetShaderProperty().AddFragmentShaderReplacement(mark, True, "", False)


def pass_on(
    actor: vtkActor, names: Iterable[tuple[str, str, str]], attributes: str, stroke: Stroke
) -> None:
    """Pass values from the vertices of an actor to its fragments, through quads of lines.

    Parameters
    ----------
    actor : vtkActor
        Actor whose shaders are changed.
    names : iterable of (str, str, str)
        Name, type and value of what is passed on; with ``ALONG`` the quads of a line join.
    attributes : str
        Declarations of the vertex attributes that the values need.
    stroke : Stroke
        Width of the lines.
    """
    names, shader = list(names), actor.GetShaderProperty()
    if stroke != Stroke():
        # Lines as tubes are quads that VTK makes in a shader, whatever width a driver can draw.
        prop = actor.GetProperty()
        prop.SetRenderLinesAsTubes(True)
        prop.SetLineWidth(LEAST if stroke.diameter else max(prop.GetLineWidth(), LEAST))
    out = "".join(f"out {kind} {name}VSOutput;\n" for name, kind, _ in names)
    vertex = {
        "//VTK::Camera::Dec": "uniform mat4 MCDCMatrix;\nuniform mat4 MCVCMatrix;\n",
        "//VTK::Normal::Dec": f"uniform mat3 normalMatrix;\n{attributes}{out}",
        "//VTK::Normal::Impl": "".join(
            f"  {name}VSOutput = {value};\n" for name, _, value in names
        ),
    }
    geometry = {
        "//VTK::Normal::Dec": "uniform mat4 MCDCMatrix;\nuniform mat4 MCVCMatrix;\n"
        + "".join(
            f"in {kind} {name}VSOutput[];\nout {kind} {name}GSOutput;\n" for name, kind, _ in names
        ),
        "//VTK::Normal::Impl": "".join(
            f"  {name}GSOutput = {name}VSOutput[i];\n" for name, _, _ in names
        ),
    }
    if stroke != Stroke():
        # Normals of VTK's own tubes.
        geometry["//VTK::Normal::Start"] = ""
        geometry["//VTK::PositionVC::Impl"] = _quad(stroke, joined=ALONG in names)
    for mark, text in vertex.items():
        shader.AddVertexShaderReplacement(mark, True, text, False)
    for mark, text in geometry.items():
        shader.AddGeometryShaderReplacement(mark, True, text, False)


def _quad(stroke: Stroke, *, joined: bool) -> str:
    """Return what moves a corner of the quad of a segment, in pixels that are square.

    VTK's own quads are not perpendicular to their lines unless the picture is a square.
    """
    lines = [
        "//VTK::PositionVC::Impl",
        "vec4 vizHere = gl_in[i].gl_Position;",
        "vec2 vizWay = normalize((gl_in[1].gl_Position.xy / gl_in[1].gl_Position.w",
        "  - gl_in[0].gl_Position.xy / gl_in[0].gl_Position.w) / lineWidthNVC);",
        "float vizWide = 1.0;",
    ]
    if stroke.diameter is not None:
        # Row 1 of the projection, free of the model and of how VTK shifts and scales points.
        rows = [f"vec3({m}[0][1], {m}[1][1], {m}[2][1])" for m in ("MCDCMatrix", "MCVCMatrix")]
        lines += [
            f"float vizSpread = length({rows[0]}) / length({rows[1]});",
            f"vizWide = max(1.0, {glsl.number(stroke.diameter)} * vizSpread",
            "  / (vizHere.w * lineWidthNVC.y));",
        ]
    if joined:
        lines += [
            "vec4 vizD = vizDVSOutput[i];",
            "vec2 vizBend = (vizD.xy * vizHere.w - vizHere.xy * vizD.w) / lineWidthNVC;",
            "float vizTurn = dot(vizBend, vizWay) / max(length(vizBend), 1e-30);",
            f"if (abs(vizTurn) > {SHARPEST}) {{",
            "  vizWay = normalize(vizBend) * sign(vizTurn);",
            "  vizWide /= abs(vizTurn);",
            "}",
        ]
    lines.append("vec2 vizAcross = vizWide * vec2(-vizWay.y, vizWay.x) * lineWidthNVC;")
    if stroke.round:
        lines += [
            "float vizSide = dot(vizPVSOutput[1] - vizPVSOutput[0], vizTVSOutput[i]);",
            "vizXGSOutput = (vizSide < 0.0 ? -2.0 : 2.0) * ((j + 1) % 2 - 0.5);",
        ]
    # What VTK writes after this place.
    lines += ["#define lineWidthNVC vizAcross", "#define normal 1.0", ""]
    return "\n".join(lines)


#: Normal of the cylinder at a fragment, from the tangent and the place across the line.
CYLINDER_NORMAL = """  vec3 vizLast = vec3(MCDCMatrix[0][3], MCDCMatrix[1][3], MCDCMatrix[2][3]);
  vec3 vizFront = vizLast == vec3(0.0) ? vec3(0.0, 0.0, 1.0) : -vizP;
  vizFront -= dot(vizFront, vizT) * vizT;
  vizFront *= inversesqrt(max(dot(vizFront, vizFront), 1e-30));
  float vizX = clamp(vizXVSOutput, -1.0, 1.0);
  vec3 vizN = sqrt(1.0 - vizX * vizX) * vizFront + vizX * cross(vizFront, vizT);
"""
