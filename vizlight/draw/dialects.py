"""Declarations, in the shaders of a renderer, of the inputs of a program of light."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

from vizlight.draw import glsl
from vizlight.draw.glsl import Program, Uniform, Varying, suffixed

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkActor

#: Matrix from the coordinates of a buffer of VTK to world coordinates.
WORLD = "MCWCMatrix"


class Replacement(NamedTuple):
    """Text in place of a mark of a renderer's shader."""

    stage: Literal["Vertex", "Geometry", "Fragment"]
    mark: str
    text: str


@dataclass(frozen=True, kw_only=True)
class Dialect:
    """Words of a renderer that has the marks of VTK in its shaders.

    ``normal`` and ``tangent`` are names of the attributes of a vertex. With ``web`` the renderer is
    vtk.js, with the GLSL of WebGL 1: the text declares its uniforms, which VTK does itself, and no
    geometry shader stands between the two others. Actors are not moved, so that tangents turn by
    the matrix of the normals. (``mat3(MCVCMatrix)`` has the scale of vtk.js's buffers in it.) With
    ``constant`` the text holds the numbers, because the renderer takes none; those that do not turn
    with the camera are turned in the vertex shader.
    """

    normal: str = "normalMC"
    tangent: str = "tangentMC"
    web: bool = False
    constant: bool = False

    def passing(self, varyings: Iterable[Varying]) -> list[Replacement]:
        """Return the replacements that pass values from the vertices to the fragments."""
        varyings = tuple(varyings)
        attribute, output = ("attribute", "varying") if self.web else ("in", "out")
        clip = "MCPCMatrix" if self.web else "MCDCMatrix"
        # Tangents turn with the model, of whose matrix the normal matrix is the inverse transpose.
        turned = "normalMatrix" if self.web else "transpose(inverse(normalMatrix))"
        # VTK's own name for an output of the vertex shader ends so; a geometry shader renames it.
        names = [(v.kind, suffixed(v.name)) for v in varyings]
        values = {
            "position": "(MCVCMatrix * vertexMC).xyz",
            "normal": f"normalMatrix * {self.normal}",
            "tangent": f"{turned} * {self.tangent}",
            "length": f"length({self.normal})",
            "size": f"length({self.tangent})",
            "along": f"{clip} * vec4({self.normal}, 0.0)",
            "course": f"{clip} * vec4({self.tangent}, 0.0)",
        }
        read = "".join(v.value for v in varyings)
        attributes = ""
        if any(word in read for word in ("{normal}", "{length}", "{along}")):
            attributes += f"{attribute} vec3 {self.normal};\n"
        if any(word in read for word in ("{tangent}", "{size}", "{course}")):
            attributes += f"{attribute} vec3 {self.tangent};\n"
        out = "".join(f"{output} {kind} {name};\n" for kind, name in names)
        # VTK declares these only where its own light needs them; twice is allowed in GLSL.
        matrices = f"uniform mat4 {clip};\nuniform mat4 MCVCMatrix;\n"
        if WORLD in read:
            matrices += f"uniform mat4 {WORLD};\n"
        parts = [
            Replacement("Vertex", "//VTK::Camera::Dec", matrices),
            Replacement(
                "Vertex", "//VTK::Normal::Dec", f"uniform mat3 normalMatrix;\n{attributes}{out}"
            ),
            Replacement(
                "Vertex",
                "//VTK::Normal::Impl",
                "".join(f"  {suffixed(v.name)} = {v.value.format(**values)};\n" for v in varyings),
            ),
        ]
        # Where lines are drawn as tubes VTK puts a geometry shader between: it must hand values
        # on.
        if not self.web:
            passed = [(kind, name, name.replace("VSOutput", "GSOutput")) for kind, name in names]
            declared = "".join(f"in {k} {name}[];\nout {k} {to};\n" for k, name, to in passed)
            copied = "".join(f"  {to} = {name}[i];\n" for _, name, to in passed)
            parts.append(Replacement("Geometry", "//VTK::Normal::Dec", declared))
            parts.append(Replacement("Geometry", "//VTK::Normal::Impl", copied))
        return parts

    def replacements(self, program: Program, numbers: Iterable[Uniform]) -> list[Replacement]:
        """Return the replacements that a renderer puts in place of its own light."""
        uniforms_in, varyings = list(numbers), list(program.varyings)
        constants = ""
        # ParaView 5.11 has no uniforms of our own: numbers stand in the text, and what turns with
        # the camera is turned in the vertex shader by VTK's matrices.
        if self.constant:
            varyings += [_turned(uniform) for uniform in uniforms_in if uniform.space]
            constants = "".join(map(_constant, uniforms_in))
        word = "varying" if self.web else "in"
        into = "".join(f"{word} {v.kind} {suffixed(v.name)};\n" for v in varyings)
        declared = uniforms_in if self.web else []
        uniforms = "".join(f"uniform {u.kind} {u.name};\n" for u in declared)
        if self.web and glsl.HEIGHTS in program.body:
            uniforms += f"uniform sampler2D {glsl.HEIGHTS};\n"
        written = f"{constants}{program.body}\n  gl_FragData[0] = vec4(vizColor, opacity);\n"
        return [
            *self.passing(varyings),
            Replacement("Fragment", "//VTK::Normal::Dec", into),
            Replacement("Fragment", "//VTK::Normal::Impl", ""),
            Replacement("Fragment", "//VTK::Light::Dec", f"{uniforms}{program.functions}\n"),
            # In place of VTK's light; what comes after, such as depth peeling, stays VTK's.
            Replacement("Fragment", "//VTK::Light::Impl", written),
        ]


def _constant(uniform: Uniform) -> str:
    """Return the statement that gives a number its value in the fragment shader."""
    name, kind, value, space = uniform
    text = glsl.vector(value)
    # Perspective: the eye is the origin of view coordinates.
    if name == "vizEye":
        text = f"cameraParallel == 1 ? {text} : vec4(0.0, 0.0, 0.0, 1.0)"
    elif space:
        text = suffixed(name) if space == "position" else f"normalize({suffixed(name)})"
    return f"  {kind} {name} = {text};\n"


def _turned(uniform: Uniform) -> Varying:
    """Return a vector as the vertex shader turns it to view coordinates.

    The matrices are those from the coordinates of the buffer, which VTK may have moved and scaled;
    the origin of the buffer has the one position that is known in both.
    """
    text = glsl.vector(uniform.value)
    if uniform.space == "position":
        text = f"({text} - {WORLD}[3].xyz)"
        return Varying(uniform.name, "vec3", f"MCVCMatrix[3].xyz + normalMatrix * {text}")
    return Varying(uniform.name, "vec3", f"normalMatrix * {text}")


#: VTK 9.6 and later, on the desktop.
VTK = Dialect()

#: vtk.js, whose arrays have these names without "MC".
VTK_JS = Dialect(normal="vizNormalMC", tangent="vizTangentMC", web=True)

#: ParaView 5.11, which has VTK 9.1 and takes text alone. The eye is its camera's.
PARAVIEW = Dialect(constant=True)

#: The same with tangents. VTK 9.1 takes an array of any type as the normals, but as the tangents
#: only one of float32, as ParaView's filters make normals: so the two change places.
PARAVIEW_TANGENTS = Dialect(normal="tangentMC", tangent="normalMC", constant=True)


def replace(actor: vtkActor, replacements: Iterable[Replacement]) -> None:
    """Put texts in place of VTK's, in every shader of the pipeline."""
    shader = actor.GetShaderProperty()
    shader.ClearAllShaderReplacements()
    for stage, mark, text in replacements:
        getattr(shader, f"Add{stage}ShaderReplacement")(mark, True, text, False)
