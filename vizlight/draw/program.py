"""The light of a plan as a program of a graphics card, and the numbers that it is given.

One text serves all renderers; what differs between them is a dialect
(:mod:`vizlight.draw.dialects`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from vizlight import _check
from vizlight.draw import glsl
from vizlight.scene.light import WHITE
from vizlight.shading.display import LEAST

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Color
    from vizlight.scene import DepthCue, Light, Scene, View
    from vizlight.shading.plan import Plan

#: Number of lights for which a program is written.
MOST_LIGHTS = 16


class Uniform(NamedTuple):
    """Number or vector that a program is given, in world coordinates.

    Attributes
    ----------
    name : str
    kind : {"float", "vec3", "vec4"}
        Type of GLSL.
    value : tuple of float
    space : {"", "direction", "position"}
        What the first three numbers are. The program takes directions (of unit length) and
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
    ``{along}``, the normal as a direction in clip coordinates.
    """

    name: str
    kind: Literal["float", "vec3", "vec4"]
    value: str


#: What a tangent of a mesh of several kinds of cells is longer by for each dimension that a point
#: has less than a face, and that dimension.
LENGTHS = 2.0
DIMENSION = "(2.0 - step(2.5, {size}) - step(4.5, {size}))"


class Stroke(NamedTuple):
    """How wide lines are drawn, and whether they are lit as a cylinder across their width.

    Attributes
    ----------
    diameter : float or None
        Diameter in the unit of the mesh; None for a width in pixels.
    round : bool
        Whether each fragment has the normal of the cylinder that the line stands for.
    """

    diameter: float | None = None
    round: bool = False


#: Direction of the line at a vertex; its array takes the place of normals.
ALONG = Varying("vizD", "vec4", "{along}")
#: Normal of the cylinder at a fragment, from the tangent and the place across the line.
CYLINDER_NORMAL = """  vec3 vizLast = vec3(MCDCMatrix[0][3], MCDCMatrix[1][3], MCDCMatrix[2][3]);
  vec3 vizFront = vizLast == vec3(0.0) ? vec3(0.0, 0.0, 1.0) : -vizP;
  vizFront -= dot(vizFront, vizT) * vizT;
  vizFront *= inversesqrt(max(dot(vizFront, vizFront), 1e-30));
  float vizX = clamp(vizXVSOutput, -1.0, 1.0);
  vec3 vizN = sqrt(1.0 - vizX * vizX) * vizFront + vizX * cross(vizFront, vizT);
"""


class Program(NamedTuple):
    """Text of a fragment shader, and what it reads.

    Attributes
    ----------
    functions : str
        Functions that the body calls.
    body : str
        Statements that set ``vizColor`` from varyings, uniforms, ``ambientColor`` and
        ``diffuseColor``.
    varyings : tuple of Varying
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

    Parameters
    ----------
    plan : Plan
        Plan of a surface or of one tangent per point in 3-space, in its exact form.
    turned : bool
        Whether the normal is turned to the eye, unless it leans away by what its length says: from
        1 for a lean of -1 to 2 for one of 1.
    toward : {"", "eye", "face"}
        Where normals have no such length: whether they are turned to the eye, or to the side of
        the face that is seen, which may lean away between the corners. A line has no face.
    stroke : Stroke
        Width of lines; round ones have the plan of the surface of their cylinders.
    data : bool, default: False
        Whether the renderer's colours come from data, which light keeps readable.
    sky : bool, default: False
        Whether the number ``vizSky`` says how much the share of the ambient light counts.

    Returns
    -------
    Program
    """
    # Varyings are declared only where the body reads them: the least that WebGL has are eight.
    functions, body = glsl.fragment(plan, turned=turned, data=data)
    mixed = plan.line_exponent is not None
    names = [Varying("vizP", "vec3", "{position}")]
    # vizGood turns false where a vector has no length; such fragments show no data.
    read = f"  vec3 vizP = {suffixed('vizP')};\n  bool vizGood = true;\n"
    if (plan.surface and not stroke.round) or plan.conditioned or plan.fur:
        names.append(Varying("vizN", "vec3", "{normal}"))
        read += _unit("vizN") + _TOWARD[toward]
    elif stroke != Stroke():
        # A stroke without normals needs the direction of the line, by which VTK's geometry is
        # widened.
        names.append(ALONG)
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
    """Return what the program of a scene is given.

    Parameters
    ----------
    scene : Scene
        Scene with the ends of its depth cue.
    lights : sequence of Light
        Lights of the plan, with headlights fixed.
    ambient, diffuse : float, default: 1.0
        Coefficients that a renderer has multiplied its colours by.
    specular_color : (r, g, b)
        Specular colour of the renderer.
    fur : float
        Density of the fur, 0 for none.
    tallest : float
        Height of the fur whose normal has the length 2.
    data : bool, default: False
        Whether the renderer's colours come from data.

    Returns
    -------
    list of Uniform

    Raises
    ------
    ValueError
        If there are more than 16 lights.
    """
    if len(lights) > MOST_LIGHTS:
        got = str(len(lights))
        raise ValueError(_check.message("lights", f"at most {MOST_LIGHTS} lights", got))
    # Light on colours of data is a factor, which the colours of a renderer must not hold already.
    held = (1.0, 1.0, WHITE) if data else (ambient, diffuse, specular_color)
    found = [
        *_of_lights(lights),
        *_of_material(scene, *held),
        *_of_view(scene.depth_cue, scene.view),
    ]
    if data:
        least = scene.ambient_intensity * LEAST
        around = tuple(least * c for c in scene.ambient_color or WHITE)
        found.append(Uniform("vizLeastGain", "vec3", around))
        # VTK multiplies a scalar colour by ambient and diffuse before the light sees it.
        gain = _ratio(1.0, ambient + diffuse)
        found.append(Uniform("vizColorGain", "float", (gain,)))
    if fur:
        # Fur of density 1 lets through what is less than any float.
        # log(1 - density): density 1 would be -inf, which GLSL has not.
        rate = float(np.log1p(-min(fur, 1 - 1e-12)))
        found.append(Uniform("vizFurRate", "float", (rate,)))
        found.append(Uniform("vizTallest", "float", (tallest,)))
    return found


def _unit(name: str) -> str:
    """Return statements that read a varying as a unit vector."""
    given = suffixed(name)
    return (
        f"  float {name}Size = length({given});\n"
        f"  vizGood = vizGood && {name}Size > 1e-6;\n"
        f"  vec3 {name} = {given} / max({name}Size, 1e-6);\n"
    )


def _of_lights(lights: Sequence[Light]) -> list[Uniform]:
    found = []
    for i, light in enumerate(lights):
        if light.position is not None:
            found.append(Uniform(f"vizLight{i}", "vec3", light.position, "position"))
            # Only a lamp at a place fades with distance.
            found.append(Uniform(f"vizFade{i}", "vec3", light.attenuation))
        elif light.direction is not None:
            found.append(Uniform(f"vizLight{i}", "vec3", light.direction, "direction"))
        # Intensity and colour are one vector; a lamp without a colour is white.
        color = tuple(light.intensity * c for c in light.color or WHITE)
        found.append(Uniform(f"vizColor{i}", "vec3", color))
    return found


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
    """Return what a coefficient of a renderer must be multiplied by."""
    return wanted / shown if shown > 0 else 0.0


def _of_view(cue: DepthCue | None, view: View | None) -> list[Uniform]:
    """Return the eye, as a point or as a direction with 0 after it, and the depth cue."""
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
