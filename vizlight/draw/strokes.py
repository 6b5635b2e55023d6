"""Lines as wide as cylinders of a diameter, by shader replacement on an actor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vizlight.draw import dialects, glsl
from vizlight.draw.dialects import Replacement
from vizlight.draw.program import ALONG, suffixed

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vtkmodules.vtkRenderingCore import vtkActor

    from vizlight.draw.program import Stroke

#: Width in pixels above 1, as VTK draws no quads for narrower lines; also the least width of lines
#: of a diameter, so that none breaks up.
LEAST = 1.01
#: Cosine of the angle between a segment and the tangent of the line up to which ends are mitred.
SHARPEST = 0.5


def widen(actor: vtkActor, stroke: Stroke) -> None:
    """Draw the lines of an actor with the diameter of a stroke, in the colours that they have.

    The active normals of what is drawn are the tangents of its lines.
    """
    actor.GetProperty().SetInterpolationToGouraud()
    passed = widened(actor, dialects.VTK.passing([ALONG]), stroke)
    unlit = [
        Replacement("Fragment", mark, "") for mark in ("//VTK::Normal::Dec", "//VTK::Normal::Impl")
    ]
    replace(actor, [*passed, *unlit])


def replace(actor: vtkActor, replacements: Iterable[Replacement]) -> None:
    """Put texts in place of VTK's, in every shader of the pipeline."""
    shader = actor.GetShaderProperty()
    shader.ClearAllShaderReplacements()
    for stage, mark, text in replacements:
        getattr(shader, f"Add{stage}ShaderReplacement")(mark, True, text, False)


def widened(
    actor: vtkActor, replacements: Iterable[Replacement], stroke: Stroke
) -> list[Replacement]:
    """Return replacements that draw lines as quads of a width, which the actor is set to.

    Parameters
    ----------
    actor : vtkActor
        Actor of lines.
    replacements : iterable of Replacement
        What passes values to the fragments, and their light; with ``ALONG`` the quads of a line
        join.
    stroke : Stroke
        Width of the lines.
    """
    # Lines as tubes are quads that VTK makes in a shader, whatever width a driver can draw.
    prop = actor.GetProperty()
    prop.SetRenderLinesAsTubes(True)
    prop.SetLineWidth(LEAST if stroke.diameter else max(prop.GetLineWidth(), LEAST))
    matrices = "uniform mat4 MCDCMatrix;\nuniform mat4 MCVCMatrix;\n"
    found = []
    for stage, mark, text in replacements:
        if mark == "//VTK::Normal::Dec" and stage == "Geometry":
            text = matrices + text
        if mark == "//VTK::Normal::Dec" and stage == "Fragment" and stroke.round:
            text += "uniform mat4 MCDCMatrix;\n"
        found.append(Replacement(stage, mark, text))
    joined = any(suffixed(ALONG.name) in text for _, _, text in found)
    return [
        *found,
        # Normals of VTK's own tubes, and their depth.
        Replacement("Geometry", "//VTK::Normal::Start", ""),
        Replacement("Fragment", "//VTK::Depth::Impl", ""),
        Replacement("Geometry", "//VTK::PositionVC::Impl", _quad(stroke, joined=joined)),
    ]


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
