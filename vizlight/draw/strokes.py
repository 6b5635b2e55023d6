"""Lines as bands that face the eye, of a width, with round ends and halos, made in VTK's shaders.

A halo has the colour of the ground and is the deeper the farther it is from the middle of its line,
like a tent: it hides lines that pass behind, and lines that run together keep no gap (Everts,
Bekker, Roerdink and Isenberg, Depth-Dependent Halos, 2009). The line itself is drawn nearer to the
eye by its own width, so that a surface on which it lies does not hide it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkRenderingCore import vtkActor, vtkMapper, vtkRenderer

from vizlight import _check
from vizlight._types import Array, Foreign, Indices, Keywords
from vizlight.draw import glsl
from vizlight.draw.dialects import VTK, Replacement, replace
from vizlight.draw.glsl import ALONG, END, HALO, Stroke, Uniform, suffixed
from vizlight.draw.symbols import number
from vizlight.model import formulas
from vizlight.vtk import polylines
from vizlight.vtk.polylines import has_lines_only

#: Width in pixels above 1, as VTK draws no quads for narrower lines; also the least width of lines
#: of a diameter, so that none breaks up.
LEAST = 1.01
#: Cosine of the angle between a segment and the tangent of the line up to which ends are mitred;
#: with halos, which are wider, sharper bends are round.
SHARPEST, SHARPEST_HALO = 0.5, 0.85
#: Length of a direction above which a point is an end of its line.
AT_END = 1.75
#: Width of a halo on each side in widths of the line, and its least width in pixels.
WIDTHS, PIXELS = 1.0, 2.0
#: The same of one in a colour, an outline.
OUTLINE_WIDTHS, OUTLINE_PIXELS = 0.35, 0.9
#: Depth of the border of a halo behind its line, in widths of the line: lines farther apart than
#: that have a gap of the whole width of the halo.
DEPTH = 4.0
#: Contrast with a light ground below which the rim of a line is darkened, by how much at most, and
#: the width of the rim in pixels: bright light on white would be seen neither before nor behind.
FAINT, DARKER, RIM = 0.4, 0.6, 2.5
#: Colour of halos, pixels that are drawn for each pixel of the picture, and by how much rims are
#: darkened, as uniforms.
GROUND, SAMPLES, DARKENED = "vizGround", "vizSamples", "vizDarkened"
#: Width of a line that supersampling draws one pixel wide, as measured from pictures of lines of 1
#: to 40 pixels: twice the size, and VTK's lines are a tenth narrower there.
SUPERSAMPLED = 2 / 0.9
#: Offset of surfaces behind the lines on them, in their slope and in least steps of depth.
BEHIND = 2.0


def stroke_of(mesh: pv.DataSet, drawing: Keywords) -> Stroke:
    """Take from keywords how lines are drawn.

    They are those of ``add_mesh``: line_diameter, halo, width and, for lines,
    render_lines_as_tubes. A mesh that is not of lines has no stroke.
    """
    diameter, halo = drawing.pop("line_diameter", None), drawing.pop("halo", False)
    share = drawing.pop("width", None)
    if not has_lines_only(mesh):
        return Stroke()
    # Across a line of one pixel there is no roundness to show.
    width = drawing.get("line_width") or pv.global_theme.line_width
    wide = diameter is not None or width > 1
    stroke = Stroke(diameter, bool(drawing.pop("render_lines_as_tubes", False)) and wide)
    if share is not None:
        check_widths(mesh, share)
        stroke = stroke._replace(width=share)
    if halo is None:
        # What is behind a translucent line is meant to be seen.
        opacity = drawing.get("opacity")
        halo = opacity is None or (isinstance(opacity, int | float) and opacity >= 1)
    if halo is False:
        return stroke
    return with_halo(stroke, width, None if halo is True else halo)


def check_widths(mesh: pv.DataSet, name: str) -> None:
    """Raise a ValueError unless an array holds one real number for each point."""
    array = mesh.point_data.get(name)
    if array is None or array.ndim > 1 or array.dtype.kind not in "biuf":
        got = repr(name) if array is None else f"{name!r} {_check.describe(array)}"
        raise _check.value_error("width", "the name of a point array of one number per point", got)


def check_halo(halo: bool | float | str) -> bool | float | str:
    """Return the option ``halo``, checked: whether lines have halos, or their width or colour."""
    if isinstance(halo, str):
        _check.color("halo", halo)
        return halo
    return halo if isinstance(halo, bool) else _check.number("halo", halo, low=0.0, high=100.0)


def with_halo(stroke: Stroke, line_width: float, halo: float | str | None) -> Stroke:
    """Return a stroke with a halo.

    ``line_width`` is in pixels, where lines have no diameter. ``halo`` is its width on each side,
    in widths of the line; None for one width, or 2 pixels where that is more; a colour for a
    narrower one in it.
    """
    if halo is None or isinstance(halo, str):
        stroke = stroke._replace(outline=halo)
        widths, pixels = (WIDTHS, PIXELS) if halo is None else (OUTLINE_WIDTHS, OUTLINE_PIXELS)
        halo = widths if stroke.diameter else max(widths, pixels / max(line_width, LEAST))
    return stroke._replace(halo=halo) if halo > 0 else stroke


def color_of_halo(stroke: Stroke, renderer: vtkRenderer) -> tuple[float, float, float]:
    """Return the colour of the halos of lines: that of the ground, if they have no other."""
    if stroke.outline is not None:
        return pv.Color(stroke.outline).float_rgb
    red, green, blue = renderer.GetBackground()
    return red, green, blue


def shares_of(mesh: pv.DataSet, width: str) -> Array:
    """Return the shares of the width of lines that a point array tells, from 0 to 1."""
    return np.asarray(np.clip(np.nan_to_num(mesh.point_data[width], nan=0.0), 0.0, 1.0))


def directions(mesh: pv.DataSet, width: str | None = None) -> Array:
    """Return the directions of lines at their points, with lengths that say how they are drawn.

    Vectors have the length 1, longer by 1 at the ends of lines, and by half of the width, of the
    point array ``width``.
    """
    lengths = 1 + polylines.of_points(mesh, _ends)
    if width is not None:
        lengths += 0.5 * shares_of(mesh, width)
    return polylines.line_tangents(mesh) * lengths[:, np.newaxis]


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

    The active normals of the drawn mesh are the :func:`directions` of its lines. ``last`` are
    further texts in place of VTK's.
    """
    actor.GetProperty().SetInterpolationToGouraud()
    ended = [END] if stroke.halo or stroke.width else []
    passed = VTK.passing([ALONG, *ended, *(HALO if stroke.halo else ())])
    unlit = [
        Replacement("Fragment", mark, "") for mark in ("//VTK::Normal::Dec", "//VTK::Normal::Impl")
    ]
    replace(actor, [*widened(actor, [*passed, *unlit], stroke), *last])


def adapt(actor: vtkActor, renderer: vtkRenderer, stroke: Stroke, *, of_data: bool) -> None:
    """Give the lines of an actor the colour of their halos and the pixels of a renderer.

    Colours ``of_data`` have no darker rim: it would be read as another value.
    """
    shader = actor.GetShaderProperty()
    fragment = shader.GetFragmentCustomUniforms()
    fragment.SetUniform3f(GROUND, list(color_of_halo(stroke, renderer)))
    samples = line_samples(renderer)
    fragment.SetUniformf(DARKENED, 0.0 if of_data else DARKER)
    for uniforms in (fragment, shader.GetGeometryCustomUniforms()):
        uniforms.SetUniformf(SAMPLES, samples)


def enlarge(actor: vtkActor, renderer: vtkRenderer) -> None:
    """Give VTK's own lines and points the size that they have once a larger picture is shrunk."""
    prop, samples = actor.GetProperty(), line_samples(renderer)
    prop.SetLineWidth(prop.GetLineWidth() * samples)
    prop.SetPointSize(prop.GetPointSize() * (2.0 if samples > 1 else 1.0))


def lay_on_surfaces(renderer: Foreign) -> None:
    """Draw VTK's own lines whole on surfaces, which eat those that lie on them otherwise.

    VTK has one switch for all renderers of a process: after each frame it is as it was before.
    """
    mappers: Foreign = vtkMapper
    usual: tuple[Foreign, Foreign] = reference(0.0), reference(0.0)
    mappers.GetResolveCoincidentTopologyPolygonOffsetParameters(*usual)
    before: list[int] = []

    def start(*_: object) -> None:
        before.append(mappers.GetResolveCoincidentTopology())
        mappers.SetResolveCoincidentTopologyToPolygonOffset()
        mappers.SetResolveCoincidentTopologyPolygonOffsetParameters(BEHIND, BEHIND)

    def end(*_: object) -> None:
        mappers.SetResolveCoincidentTopology(before.pop())
        mappers.SetResolveCoincidentTopologyPolygonOffsetParameters(*map(float, usual))

    renderer.AddObserver("StartEvent", start)
    renderer.AddObserver("EndEvent", end)


def line_samples(renderer: vtkRenderer) -> float:
    """Return the width of a line that a renderer draws one pixel wide."""
    return SUPERSAMPLED if has_pass(renderer.GetPass(), "vtkSSAAPass") else 1.0


def has_pass(step: Foreign, kind: str) -> bool:
    """Return whether a pass of VTK is of a class, or holds one that is: passes nest."""
    if step is None or step.IsA(kind):
        return step is not None
    passes = step.GetPasses() if step.IsA("vtkSequencePass") else None
    held = [] if passes is None else [passes.GetItemAsObject(i) for i in range(len(passes))]
    held += [
        getattr(step, name)() for name in ("GetDelegatePass", "GetSequence") if hasattr(step, name)
    ]
    return any(has_pass(inner, kind) for inner in held)


def widened(
    actor: vtkActor,
    replacements: Iterable[Replacement],
    stroke: Stroke,
    numbers: Sequence[Uniform] = (),
) -> list[Replacement]:
    """Return replacements that draw lines as quads of a width, which the actor is set to.

    Replacements pass values to the fragments, and their light; with ``ALONG`` the quads of a line
    join. ``numbers`` are those of a light that is smooth within segments: it is computed at three
    places of each in place of in each fragment, of which a halo has more than its line.
    """
    # Lines as tubes are quads that VTK makes in a shader, whatever width a driver can draw.
    prop = actor.GetProperty()
    prop.SetRenderLinesAsTubes(True)
    prop.SetLineWidth(LEAST if stroke.diameter else max(prop.GetLineWidth(), LEAST))
    # VTK declares no uniforms of others in this shader.
    uniforms = f"uniform mat4 MCDCMatrix;\nuniform mat4 MCVCMatrix;\nuniform float {SAMPLES};\n"
    texts = []
    into = "".join(f"in {v.kind} {suffixed(v.name)};\n" for v in HALO)
    for stage, mark, text in replacements:
        if mark == "//VTK::Normal::Dec" and stage == "Geometry":
            text = uniforms + text
        if mark == "//VTK::Normal::Dec" and stage == "Fragment":
            if stroke.round:
                text += "uniform mat4 MCDCMatrix;\n"
            if stroke.halo and suffixed(HALO[0].name) not in text:
                text += into
        texts.append(Replacement(stage, mark, text))
    if numbers:
        texts = _lit_by_segments(texts, numbers)
    words = "".join(text for _, _, text in texts)
    joined, ended = (suffixed(v.name) in words for v in (ALONG, END))
    quad = _quad(stroke, joined=joined, ended=ended)
    return [
        # Normals of VTK's own tubes, and their depth.
        Replacement("Geometry", "//VTK::Normal::Start", ""),
        *texts,
        Replacement("Fragment", "//VTK::Depth::Impl", _border(stroke) if stroke.halo else ""),
        Replacement("Geometry", "//VTK::PositionVC::Impl", quad),
        *([Replacement("Fragment", "//VTK::TCoord::Impl", _GROUNDED)] if stroke.halo else []),
    ]


def _lit_by_segments(texts: list[Replacement], numbers: Sequence[Uniform]) -> list[Replacement]:
    """Return texts that compute the light of fragments at both ends and the middle of segments.

    In between it is the parabola through all three.
    """
    by_mark = {(stage, mark): text for stage, mark, text in texts}
    light = by_mark["Fragment", "//VTK::Light::Impl"].partition("  gl_FragData[0] = ")[0]
    outputs = by_mark["Geometry", "//VTK::Normal::Dec"]
    inputs = [(k, n) for k, n in re.findall(r"in (\w+) (\w+)\[\];", outputs) if n in light]
    uniforms = "".join(f"uniform {u.kind} {u.name};\n" for u in numbers)
    parameters = ", ".join(f"{kind} {name}" for kind, name in inputs)
    places = ("{0}[0]", "{0}[1]", "0.5 * ({0}[0] + {0}[1])")
    first, last, middle = (
        f"vizLit({', '.join(place.format(name) for _, name in inputs)})" for place in places
    )
    # Colours of data are those of fragments, and light is a factor on them.
    is_factor = "vizColorGain" in light
    colors = _WHITE if is_factor else _COLORS
    by_mark["Geometry", "//VTK::Normal::Dec"] = (
        f"{outputs}out vec4 vizLitGSOutput;\nflat out vec3 vizBulgeGSOutput;\n{uniforms}"
        f"{by_mark['Fragment', '//VTK::Light::Dec']}{colors}"
        f"vec3 vizLit({parameters}) {{\n{light}  return vizColor;\n}}\n"
    )
    by_mark["Geometry", "//VTK::Normal::Start"] = (
        f"  vec3 vizLits[2] = vec3[2]({first}, {last});\n"
        f"  vec3 vizBulge = 4.0 * {middle} - 2.0 * (vizLits[0] + vizLits[1]);\n"
    )
    by_mark["Geometry", "//VTK::Normal::Impl"] += (
        "  vizLitGSOutput = vec4(vizLits[i], i);\n  vizBulgeGSOutput = vizBulge;\n"
    )
    by_mark["Fragment", "//VTK::Normal::Dec"] += (
        "in vec4 vizLitVSOutput;\nflat in vec3 vizBulgeVSOutput;\n"
    )
    by_mark["Fragment", "//VTK::Light::Dec"] = ""
    by_mark["Fragment", "//VTK::Light::Impl"] = (
        "  vec3 vizColor = vizLitVSOutput.rgb\n"
        "    + vizLitVSOutput.w * (1.0 - vizLitVSOutput.w) * vizBulgeVSOutput;\n"
        + "  vizColor *= vizColorGain * (ambientColor + diffuseColor);\n" * is_factor
        + "  gl_FragData[0] = vec4(vizColor, opacity);\n"
    )
    return [Replacement(stage, mark, text) for (stage, mark), text in by_mark.items()]


#: The colours of the material as VTK's fragments have them, and none.
_COLORS = (
    "uniform float ambientIntensity, diffuseIntensity;\n"
    "uniform vec3 ambientColorUniform, diffuseColorUniform;\n"
    "#define ambientColor (ambientIntensity * ambientColorUniform)\n"
    "#define diffuseColor (diffuseIntensity * diffuseColorUniform)\n"
)
_WHITE = (
    "#define vizColorGain 1.0\n#define ambientColor vec3(1.0)\n#define diffuseColor vec3(0.0)\n"
)


def _quad(stroke: Stroke, *, joined: bool, ended: bool) -> str:
    """Return the text that moves a corner of the quad of a segment, in pixels that are square.

    VTK's own quads are not perpendicular to their lines unless the picture is a square.
    """
    lines = [
        "//VTK::PositionVC::Impl",
        # What is nearer than the near plane is cut: it would have a place on the wrong side.
        "vec4 vizEnds[2] = vec4[2](gl_in[0].gl_Position, gl_in[1].gl_Position);",
        "vec2 vizBefore = vec2(vizEnds[0].z + vizEnds[0].w, vizEnds[1].z + vizEnds[1].w);",
        "if (max(vizBefore.x, vizBefore.y) <= 0.0) return;",
        "float vizCut = vizBefore.x / (vizBefore.x - vizBefore.y);",
        "if (vizBefore.x < 0.0) vizEnds[0] = mix(vizEnds[0], vizEnds[1], vizCut);",
        "if (vizBefore.y < 0.0) vizEnds[1] = mix(vizEnds[0], vizEnds[1], vizCut);",
        "vec4 vizHere = vizEnds[i];",
        f"vec2 vizPen = {SAMPLES} * lineWidthNVC;",
        "vec2 vizSpan = (vizEnds[1].xy / vizEnds[1].w - vizEnds[0].xy / vizEnds[0].w) / vizPen;",
        "vec2 vizWay = normalize(vizSpan);",
        "vec2 vizThick = vec2(1.0), vizShare = vec2(1.0);",
        "vec2 vizPlace = vizHere.xy;",
    ]
    # Row 1 of the projection, free of the model and of how VTK shifts and scales points.
    lines.append(f"float vizSpread = {_ratio(1)};")
    if stroke.diameter is not None:
        lines += [
            f"vizThick = max(vec2(1.0), {number(stroke.diameter)} * vizSpread",
            "  / (vec2(vizEnds[0].w, vizEnds[1].w) * vizPen.y));",
        ]
    if stroke.width is not None:
        lines += [
            "vizShare = vec2(vizEndVSOutput[0], vizEndVSOutput[1]) - 1.0;",
            f"vizShare = 2.0 * (vizShare - step({AT_END} - 1.0, vizShare));",
        ]
    lines.append(f"float vizWide = {'1.0' if stroke.halo else 'vizShare[i]'} * vizThick[i];")
    if stroke.halo:
        lines += ["vec2 vizStraight = vizWay;", "float vizWhole = vizThick[i], vizCap = 0.0;"]
    # At a joint both quads take the direction of the line there, so that their corners meet; such a
    # mitre is wider by 1 over the cosine, and sharp bends have none.
    if joined:
        lines += [
            "vec4 vizD = vizDVSOutput[i];",
            "vec2 vizBend = (vizD.xy * vizHere.w - vizHere.xy * vizD.w) / vizPen;",
            "float vizTurn = dot(vizBend, vizWay) / max(length(vizBend), 1e-30);",
            f"if (abs(vizTurn) > {SHARPEST_HALO if stroke.halo else SHARPEST}) {{",
            "  vizWay = normalize(vizBend) * sign(vizTurn);",
            "  vizWide /= abs(vizTurn);",
            "}",
        ]
    # Depths of what is nearer to the eye by the width of the line, so that a surface on which it
    # lies does not hide it.
    lines += [
        f"float vizSlope = -{_ratio(2)};",
        "float vizFocus = vec3(MCDCMatrix[0][3], MCDCMatrix[1][3], MCDCMatrix[2][3]) == vec3(0.0)",
        "  ? 0.0 : 1.0;",
        "float vizWidth = vizThick[i] * vizPen.y * vizHere.w / vizSpread;",
        "float vizNearer = vizFocus > 0.0 ? min(vizWidth, 0.5 * vizHere.w) : vizWidth;",
    ]
    if stroke.halo:
        lines += _capped(stroke, joined=joined, ended=ended)
    lines += [
        "vec2 vizAcross = ((j + 1) % 2 - 0.5) * vizWide * vec2(-vizWay.y, vizWay.x);",
        "vizPlace += vizAcross * vizPen * vizHere.w;",
        "vec4 vizCorner = vec4(vizPlace, vizHere.zw);",
    ]
    if not stroke.halo:
        # Never before the near plane, which would cut it.
        lines += [
            "vizCorner.z = vizHere.w * max(-0.999, (vizHere.z + vizSlope * vizNearer)",
            "  / (vizHere.w - vizFocus * vizNearer));",
        ]
    # The place across the line, from -1 to 1, has the side of the tangent, which may run against
    # the segment.
    if stroke.round:
        whole = number(4 * stroke.halo)
        lines += [
            "float vizSide = dot(vizPVSOutput[1] - vizPVSOutput[0], vizTVSOutput[i]);",
            f"float vizEdge = 2.0 + {whole} / max(vizShare[i], 0.05);",
            "vizXGSOutput = (vizSide < 0.0 ? -vizEdge : vizEdge) * ((j + 1) % 2 - 0.5);",
        ]
    # In place of the corner that VTK makes.
    lines += ["#define EmitVertex() gl_Position = vizCorner; EmitVertex()", ""]
    return "\n".join(lines)


def _ratio(row: int) -> str:
    """Return the length of a row of the projection, which no model and no shift changes."""
    rows = [
        f"vec3({m}[0][{row}], {m}[1][{row}], {m}[2][{row}])" for m in ("MCDCMatrix", "MCVCMatrix")
    ]
    return f"length({rows[0]}) / length({rows[1]})"


def _capped(stroke: Stroke, *, joined: bool, ended: bool) -> list[str]:
    """Return the text that lengthens a quad by a round end, and the places of its corners."""
    band = number(2 * stroke.halo)
    # Ends are round, and so is a bend that is not mitred: both of its quads end there in a disc.
    if joined:
        is_end = f"abs(vizTurn) <= {SHARPEST_HALO}" + f" || vizEndVSOutput[i] > {AT_END}" * ended
    else:
        is_end = "true"
    return [
        f"float vizReach = vizShare[i] + {band};",
        f"if ({is_end}) {{",
        "  vizWay = vizStraight; vizWide = vizWhole;",
        "  vizCap = vizReach;",
        "}",
        # Places in half widths: across, past the start and past the end.
        "float vizLong = (2.0 * length(vizSpan) + vizCap * vizWhole) / vizThick[1 - i];",
        "float vizFar = vizReach * 2.0 * ((j + 1) % 2 - 0.5);",
        "vizLineGSOutput = vizHere.w * (i == 0 ? vec3(vizFar, -vizCap, vizLong)",
        "  : vec3(vizFar, vizLong, -vizCap));",
        "vizPlace += (i == 0 ? -0.5 : 0.5) * vizCap * vizWhole * vizHere.w * vizStraight * vizPen;",
        "vizWide *= vizReach;",
        # Depths of what is nearer to the eye, and of what is behind it.
        f"vec2 vizMoved = vec2(vizNearer, -{number(DEPTH)} * vizWidth);",
        "vizDeepGSOutput.xy = 0.5 * vizHere.w * ((vizHere.z + vizSlope * vizMoved)",
        "  / (vizHere.w - vizFocus * vizMoved) - vizHere.z / vizHere.w);",
        "vizDeepGSOutput.zw = vizHere.w * vizShare;",
    ]


def _border(stroke: Stroke) -> str:
    """Return the text of a fragment: its distance from the line, and its depth.

    Nothing is discarded, which costs software renderers a fifth of a frame: corners beyond the
    halo lie at the far plane, where they are the ground on the ground. Outlines are another colour.
    """
    band = number(2 * stroke.halo)
    half = "1.0" if stroke.width is None else _HALF
    # Corners were multiplied by their w, so that what is interpolated is linear on the screen.
    return (
        "  vec3 vizAt = vizLineVSOutput * gl_FragCoord.w;\n"
        "  vec4 vizDepths = vizDeepVSOutput * gl_FragCoord.w;\n"
        "  float vizAway = length(vec2(vizAt.x, max(0.0, -min(vizAt.y, vizAt.z))))\n"
        f"    - {half};\n"
        # In halves of a pixel: the border is blurred from -1 to 1.
        "  float vizBlur = max(0.5 * fwidth(vizAway), 1e-6);\n"
        "  float vizPixels = vizAway / vizBlur;\n"
        "  float vizOut = clamp(0.5 + 0.5 * vizPixels, 0.0, 1.0);\n"
        # The blurred border is already behind, so that it hides nothing of a quad that joins, and
        # yet before a surface on which the line lies.
        "  float vizNear = vizDepths.x * (1.0 - 0.75 * vizOut);\n"
        f"  float vizTent = clamp((vizAway - vizBlur) * {number(0.5 / stroke.halo)}, 0.0, 1.0);\n"
        # Before the nearest depth, to which all that is nearer would be clamped alike.
        "  float vizDepth = max(gl_FragCoord.z + vizNear, 1e-3)\n"
        "    + vizTent * (vizDepths.y - vizNear);\n"
        + (
            f"  gl_FragDepth = vizAway > {band} ? 1.0 : vizDepth;\n"
            if stroke.outline is None
            else f"  if (vizAway > {band}) discard;\n  gl_FragDepth = vizDepth;\n"
        )
    )


#: Half width of a line between its ends, where both have widths of their own.
_HALF = (
    "mix(vizDepths.z, vizDepths.w,\n    clamp(vizAt.y / max(vizAt.y + vizAt.z, 1e-6), 0.0, 1.0))"
)
#: The rim of a line that is nearly as light as its ground, and the colour of the ground beside it.
#: VTK discards what is not opaque at all; where a compiler sees that nothing is, frames are faster.
_GROUNDED = (
    "//VTK::TCoord::Impl\n"
    f"  vec3 vizLuma = {glsl.vector(formulas.LUMA)};\n"
    f"  float vizPale = dot({GROUND}, vizLuma);\n"
    "  vizPale = vizPale < 0.5 ? 0.0\n"
    f"    : clamp(1.0 - {number(1 / FAINT)} * (vizPale - dot(gl_FragData[0].rgb, vizLuma)),\n"
    "      0.0, 1.0);\n"
    f"  float vizRim = clamp(vizPixels * {number(0.5 / (RIM - 0.5))} / {SAMPLES}\n"
    f"    + {number(RIM / (RIM - 0.5))}, 0.0, 1.0);\n"
    "  vizRim *= vizRim * (3.0 - 2.0 * vizRim);\n"
    f"  gl_FragData[0].rgb *= 1.0 - {DARKENED} * vizPale * vizRim;\n"
    "  float vizGap = vizOut * vizOut * (3.0 - 2.0 * vizOut);\n"
    f"  gl_FragData[0].rgb = mix(gl_FragData[0].rgb, {GROUND}, vizGap);\n"
    "  gl_FragData[0].a = max(gl_FragData[0].a, 1e-30);\n"
)
