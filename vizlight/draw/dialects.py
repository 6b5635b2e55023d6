"""How the shaders of a renderer name and declare what a program of light reads."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

from vizlight.draw import glsl
from vizlight.draw.program import Varying, suffixed

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vizlight.draw.program import Program, Uniform

#: Matrix from the coordinates of a buffer of VTK to world coordinates.
WORLD = "MCWCMatrix"


class Replacement(NamedTuple):
    """Text in place of a mark of a renderer's shader."""

    stage: Literal["Vertex", "Geometry", "Fragment"]
    mark: str
    text: str


@dataclass(frozen=True, kw_only=True)
class Dialect:
    """Words of a renderer whose shaders have the marks of VTK.

    Parameters
    ----------
    attribute, output, input : str
        Qualifiers of an attribute of a vertex, of a varying in the vertex shader, and of one in the
        fragment shader.
    normal, tangent : str
        Names of the attributes.
    clip : str
        Name of the matrix from model to clip coordinates.
    turned : str
        Matrix that turns tangents to view coordinates, as an expression.
    geometry : bool
        Whether there may be a geometry shader between the two others.
    declares : bool
        Whether the text declares its uniforms; otherwise the renderer does.
    constant : bool, default: False
        Whether the text holds the numbers, because the renderer takes none. Those that do not turn
        with the camera are turned in the vertex shader.
    """

    attribute: str
    output: str
    input: str
    normal: str
    tangent: str
    clip: str
    turned: str
    geometry: bool
    declares: bool
    constant: bool = False

    def declare(self, uniform: Uniform) -> str:
        """Return the declaration of a uniform in the fragment shader, a line or nothing."""
        return f"uniform {uniform.kind} {uniform.name};\n" if self.declares else ""

    def passing(self, varyings: Iterable[Varying]) -> list[Replacement]:
        """Return what passes values from the vertices to the fragments."""
        varyings = tuple(varyings)
        # VTK's own name for an output of the vertex shader ends so; a geometry shader renames it.
        names = [(v.kind, suffixed(v.name)) for v in varyings]
        values = {
            "position": "(MCVCMatrix * vertexMC).xyz",
            "normal": f"normalMatrix * {self.normal}",
            "tangent": f"{self.turned} * {self.tangent}",
            "length": f"length({self.normal})",
            "size": f"length({self.tangent})",
            "along": f"{self.clip} * vec4({self.normal}, 0.0)",
        }
        read = "".join(v.value for v in varyings)
        attributes = ""
        if any(word in read for word in ("{normal}", "{length}", "{along}")):
            attributes += f"{self.attribute} vec3 {self.normal};\n"
        if "{tangent}" in read or "{size}" in read:
            attributes += f"{self.attribute} vec3 {self.tangent};\n"
        out = "".join(f"{self.output} {kind} {name};\n" for kind, name in names)
        # VTK declares these only where its own light needs them; twice is allowed in GLSL.
        matrices = f"uniform mat4 {self.clip};\nuniform mat4 MCVCMatrix;\n"
        if WORLD in read:
            matrices += f"uniform mat4 {WORLD};\n"
        found = [
            Replacement("Vertex", "//VTK::Camera::Dec", matrices),
            Replacement(
                "Vertex",
                "//VTK::Normal::Dec",
                f"uniform mat3 normalMatrix;\n{attributes}{out}",
            ),
            Replacement(
                "Vertex",
                "//VTK::Normal::Impl",
                "".join(f"  {suffixed(v.name)} = {v.value.format(**values)};\n" for v in varyings),
            ),
        ]
        # Where lines are drawn as tubes VTK puts a geometry shader between: it must hand values
        # on.
        if self.geometry:
            passed = [(kind, name, name.replace("VSOutput", "GSOutput")) for kind, name in names]
            declared = "".join(f"in {k} {name}[];\nout {k} {own};\n" for k, name, own in passed)
            copied = "".join(f"  {own} = {name}[i];\n" for _, name, own in passed)
            found.append(Replacement("Geometry", "//VTK::Normal::Dec", declared))
            found.append(Replacement("Geometry", "//VTK::Normal::Impl", copied))
        return found

    def replacements(self, program: Program, numbers: Iterable[Uniform]) -> list[Replacement]:
        """Return what a renderer puts in place of its own light.

        Parameters
        ----------
        program : Program
        numbers : iterable of Uniform
            What the program is given.

        Returns
        -------
        list of Replacement
        """
        given, varyings = list(numbers), list(program.varyings)
        constants = ""
        # ParaView 5.11 has no uniforms of our own: numbers stand in the text, and what turns with
        # the camera is turned in the vertex shader by VTK's matrices.
        if self.constant:
            varyings += [_turned(uniform) for uniform in given if uniform.space]
            constants = "".join(map(_constant, given))
        into = "".join(f"{self.input} {v.kind} {suffixed(v.name)};\n" for v in varyings)
        uniforms = "".join(map(self.declare, given))
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


#: VTK 9.6 and later, on the desktop. It declares uniforms itself.
VTK = Dialect(
    attribute="in",
    output="out",
    input="in",
    normal="normalMC",
    tangent="tangentMC",
    clip="MCDCMatrix",
    # Tangents turn with the model, of whose matrix the normal matrix is the inverse transpose.
    turned="transpose(inverse(normalMatrix))",
    geometry=True,
    declares=False,
)

#: vtk.js. Tangents and normals are arrays of these names without "MC"; actors are not moved, so
#: both turn by the same matrix. (``mat3(MCVCMatrix)`` has the scale of vtk.js's buffers in it.)
VTK_JS = Dialect(
    attribute="attribute",
    output="varying",
    input="varying",
    normal="vizNormalMC",
    tangent="vizTangentMC",
    clip="MCPCMatrix",
    turned="normalMatrix",
    geometry=False,
    declares=True,
)

#: ParaView 5.11, which has VTK 9.1 and takes text alone. The eye is its camera's.
PARAVIEW = dataclasses.replace(VTK, constant=True)

#: The same with tangents. VTK 9.1 takes an array of any type as the normals, but as the tangents
#: only one of float32, as ParaView's filters make normals: so the two change places.
PARAVIEW_TANGENTS = dataclasses.replace(PARAVIEW, normal="tangentMC", tangent="normalMC")
