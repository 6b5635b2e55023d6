"""Lines as bands that face the eye, of a width, with round ends and halos, made in VTK's shaders.

A halo has the colour of the ground and is the deeper the farther it is from the middle of its line,
like a tent: it hides what passes behind, and lines that run together keep no gap (Everts, Bekker,
Roerdink and Isenberg, Depth-Dependent Halos, 2009). The line itself is drawn nearer to the eye by
its own width, so that a surface on which it lies does not hide it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.draw import glsl
from vizlight.draw.dialects import VTK, Replacement, replace
from vizlight.draw.glsl import ALONG, END, HALO, Stroke, suffixed
from vizlight.vtk import polylines

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Indices

#: Width in pixels above 1, as VTK draws no quads for narrower lines; also the least width of lines
#: of a diameter, so that none breaks up.
LEAST = 1.01
#: Cosine of the angle between a segment and the tangent of the line up to which ends are mitred;
#: with halos, which are wider, sharper bends are round.
SHARPEST, SHARPEST_HALO = 0.5, 0.85
#: Width of a halo on each side in widths of the line, and its least width in pixels.
WIDTHS, PIXELS = 1.0, 2.0
#: Depth of the border of a halo behind its line, as a share of the size of the lines.
DEPTH = 0.05
#: Colour of halos, a uniform.
GROUND = "vizGround"


def with_halo(stroke: Stroke, mesh: pv.DataSet, line_width: float, halo: float | None) -> Stroke:
    """Return a stroke with a halo.

    Parameters
    ----------
    stroke : Stroke
    mesh : pyvista.DataSet
        Lines.
    line_width : float
        Width of the lines in pixels, where they have no diameter.
    halo : float or None
        Width of the halo on each side, in widths of the line. None for one width, or 2 pixels where
        that is more.

    Returns
    -------
    Stroke
    """
    if halo is None:
        halo = WIDTHS if stroke.diameter else max(WIDTHS, PIXELS / max(line_width, LEAST))
    return stroke._replace(halo=halo, depth=DEPTH * mesh.length) if halo > 0 else stroke


def directions(mesh: pv.DataSet) -> Array:
    """Return the directions of lines at their points, of the length 2 at the ends of lines."""
    return polylines.line_tangents(mesh) * (1 + polylines.of_points(mesh, _ends))[:, np.newaxis]


def _ends(points: Array, ids: Indices, offsets: Indices) -> Array:
    """Return 1 for the points at the ends of open lines, 0 for others."""
    ends = np.zeros(len(points))
    full = np.diff(offsets) > 0
    first, last = ids[offsets[:-1][full]], ids[offsets[1:][full] - 1]
    is_open = np.any(points[first] != points[last], axis=1)
    ends[first[is_open]] = ends[last[is_open]] = 1.0
    return ends


def widen(actor: vtkActor, stroke: Stroke, last: Iterable[Replacement] = ()) -> None:
    """Draw the lines of an actor as a stroke says, in the colours that they have.

    The active normals of what is drawn are the :func:`directions` of its lines.

    Parameters
    ----------
    actor : vtkActor
    stroke : Stroke
    last : iterable of Replacement
        Further texts in place of VTK's.
    """
    actor.GetProperty().SetInterpolationToGouraud()
    passed = VTK.passing([ALONG, END, *HALO] if stroke.halo else [ALONG])
    unlit = [
        Replacement("Fragment", mark, "") for mark in ("//VTK::Normal::Dec", "//VTK::Normal::Impl")
    ]
    replace(actor, [*widened(actor, [*passed, *unlit], stroke), *last])


def put_ground(actor: vtkActor, renderer: vtkRenderer) -> None:
    """Give the halos of an actor the colour of the background of a renderer."""
    uniforms = actor.GetShaderProperty().GetFragmentCustomUniforms()
    uniforms.SetUniform3f(GROUND, list(renderer.GetBackground()))


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
        Width of the lines, and of their halos.
    """
    # Lines as tubes are quads that VTK makes in a shader, whatever width a driver can draw.
    prop = actor.GetProperty()
    prop.SetRenderLinesAsTubes(True)
    prop.SetLineWidth(LEAST if stroke.diameter else max(prop.GetLineWidth(), LEAST))
    matrices = "uniform mat4 MCDCMatrix;\nuniform mat4 MCVCMatrix;\n"
    texts = []
    into = "".join(f"in {v.kind} {suffixed(v.name)};\n" for v in HALO)
    for stage, mark, text in replacements:
        if mark == "//VTK::Normal::Dec" and stage == "Geometry":
            text = matrices + text
        if mark == "//VTK::Normal::Dec" and stage == "Fragment":
            if stroke.round:
                text += "uniform mat4 MCDCMatrix;\n"
            if stroke.halo and suffixed(HALO[0].name) not in text:
                text += into
        texts.append(Replacement(stage, mark, text))
    words = "".join(text for _, _, text in texts)
    joined, ended = (suffixed(v.name) in words for v in (ALONG, END))
    quad = _quad(stroke, joined=joined, ended=ended)
    return [
        *texts,
        # Normals of VTK's own tubes, and their depth.
        Replacement("Geometry", "//VTK::Normal::Start", ""),
        Replacement("Fragment", "//VTK::Depth::Impl", _border(stroke) if stroke.halo else ""),
        Replacement("Geometry", "//VTK::PositionVC::Impl", quad),
        *([Replacement("Fragment", "//VTK::TCoord::Impl", _GROUNDED)] if stroke.halo else []),
    ]


def _quad(stroke: Stroke, *, joined: bool, ended: bool) -> str:
    """Return what moves a corner of the quad of a segment, in pixels that are square.

    VTK's own quads are not perpendicular to their lines unless the picture is a square.
    """
    lines = [
        "//VTK::PositionVC::Impl",
        "vec4 vizHere = gl_in[i].gl_Position;",
        "vec2 vizSpan = (gl_in[1].gl_Position.xy / gl_in[1].gl_Position.w",
        "  - gl_in[0].gl_Position.xy / gl_in[0].gl_Position.w) / lineWidthNVC;",
        "vec2 vizWay = normalize(vizSpan);",
        "float vizWide = 1.0;",
    ]
    if stroke.diameter is not None or stroke.halo:
        # Row 1 of the projection, free of the model and of how VTK shifts and scales points.
        lines.append(f"float vizSpread = {_ratio(1)};")
    if stroke.diameter is not None:
        lines += [
            f"vizWide = max(1.0, {glsl.number(stroke.diameter)} * vizSpread",
            "  / (vizHere.w * lineWidthNVC.y));",
        ]
    if stroke.halo:
        lines += ["vec2 vizStraight = vizWay;", "float vizThick = vizWide, vizCap = 0.0;"]
    # At a joint both quads take the direction of the line there, so that their corners meet; such a
    # mitre is wider by 1 over the cosine, and sharp bends have none.
    if joined:
        lines += [
            "vec4 vizD = vizDVSOutput[i];",
            "vec2 vizBend = (vizD.xy * vizHere.w - vizHere.xy * vizD.w) / lineWidthNVC;",
            "float vizTurn = dot(vizBend, vizWay) / max(length(vizBend), 1e-30);",
            f"if (abs(vizTurn) > {SHARPEST_HALO if stroke.halo else SHARPEST}) {{",
            "  vizWay = normalize(vizBend) * sign(vizTurn);",
            "  vizWide /= abs(vizTurn);",
            "}",
        ]
    if stroke.halo:
        lines += _capped(stroke, joined=joined, ended=ended)
    lines.append("vec2 vizAcross = vizWide * vec2(-vizWay.y, vizWay.x) * lineWidthNVC;")
    # The place across the line, from -1 to 1, has the side of the tangent, which may run against
    # the segment.
    if stroke.round:
        whole = glsl.number(2 * _reach(stroke))
        lines += [
            "float vizSide = dot(vizPVSOutput[1] - vizPVSOutput[0], vizTVSOutput[i]);",
            f"vizXGSOutput = (vizSide < 0.0 ? -{whole} : {whole}) * ((j + 1) % 2 - 0.5);",
        ]
    # What VTK writes after this place.
    lines += ["#define lineWidthNVC vizAcross", "#define normal 1.0", ""]
    return "\n".join(lines)


def _ratio(row: int) -> str:
    """Return the length of a row of the projection, which no model and no shift changes."""
    rows = [
        f"vec3({m}[0][{row}], {m}[1][{row}], {m}[2][{row}])" for m in ("MCDCMatrix", "MCVCMatrix")
    ]
    return f"length({rows[0]}) / length({rows[1]})"


def _reach(stroke: Stroke) -> float:
    """Return the distance from the middle of a line to the border of its halo, in half widths."""
    return 1 + 2 * stroke.halo


def _capped(stroke: Stroke, *, joined: bool, ended: bool) -> list[str]:
    """Return what lengthens a quad by a round end, and the places and depths of its corners."""
    reach = glsl.number(_reach(stroke))
    # Ends are round, and so is a bend that is not mitred: both of its quads end there in a disc.
    if joined:
        is_end = f"abs(vizTurn) <= {SHARPEST_HALO}" + (" || vizEndVSOutput[i] > 1.5" * ended)
    else:
        is_end = "true"
    return [
        f"if ({is_end}) {{",
        "  vizWay = vizStraight; vizWide = vizThick;",
        f"  vizCap = {reach};",
        "}",
        # Places in half widths: across, past the start and past the end.
        "float vizLong = 2.0 * length(vizSpan) / vizThick + vizCap;",
        f"float vizFar = {reach} * 2.0 * ((j + 1) % 2 - 0.5);",
        "vizLineGSOutput = vizHere.w * (i == 0 ? vec3(vizFar, -vizCap, vizLong)",
        "  : vec3(vizFar, vizLong, -vizCap));",
        "_lineVertices[i] = vizHere.xy + (i == 0 ? -0.5 : 0.5) * vizCap * vizThick * vizHere.w",
        "  * vizStraight * lineWidthNVC;",
        f"vizWide *= {reach};",
        # Depths of what is nearer to the eye by the width of the line, and of what is behind it.
        f"float vizSlope = -{_ratio(2)};",
        "float vizFocus = vec3(MCDCMatrix[0][3], MCDCMatrix[1][3], MCDCMatrix[2][3]) == vec3(0.0)",
        "  ? 0.0 : 1.0;",
        "float vizNearer = vizThick * lineWidthNVC.y * vizHere.w / vizSpread;",
        "if (vizFocus > 0.0) vizNearer = min(vizNearer, 0.5 * vizHere.w);",
        f"vec2 vizMoved = vec2(vizNearer, -{glsl.number(stroke.depth)});",
        "vizDeepGSOutput = 0.5 * vizHere.w * ((vizHere.z + vizSlope * vizMoved)",
        "  / (vizHere.w - vizFocus * vizMoved) - vizHere.z / vizHere.w);",
    ]


def _border(stroke: Stroke) -> str:
    """Return what a fragment is: its distance from the line, its depth, and whether it is drawn."""
    reach = glsl.number(_reach(stroke))
    # Corners were multiplied by their w, so that what is interpolated is linear on the screen.
    return (
        "  vec3 vizAt = vizLineVSOutput * gl_FragCoord.w;\n"
        "  vec2 vizDepths = vizDeepVSOutput * gl_FragCoord.w;\n"
        "  float vizAway = length(vec2(vizAt.x, max(0.0, -min(vizAt.y, vizAt.z))));\n"
        "  float vizBlur = 0.5 * fwidth(vizAway);\n"
        "  float vizGap = smoothstep(1.0 - vizBlur, 1.0 + vizBlur, vizAway);\n"
        f"  if (vizAway > {reach}) discard;\n"
        # The blurred border is already deeper, so that it hides nothing of a quad that joins.
        f"  float vizTent = clamp((vizAway - 1.0 + vizBlur) / ({reach} - 1.0), 0.0, 1.0);\n"
        # Before the nearest depth, to which all that is nearer would be clamped alike.
        "  gl_FragDepth = max(gl_FragCoord.z + vizDepths.x, 1e-3)\n"
        "    + vizTent * (vizDepths.y - vizDepths.x);\n"
    )


#: The colour of the ground beside a line.
_GROUNDED = (
    f"//VTK::TCoord::Impl\n  gl_FragData[0].rgb = mix(gl_FragData[0].rgb, {GROUND}, vizGap);\n"
)
