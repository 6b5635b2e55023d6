"""Plugin for ParaView: the filter "Vizlight Illuminate" lights the points of a dataset."""

import re

from paraview.util.vtkAlgorithm import smproperty, smproxy

try:
    from vizlight import scene
    from vizlight.vtk import Illuminate
except ImportError as error:
    # Of an ImportError ParaView shows another one in place.
    raise RuntimeError(
        f"{error}. Start ParaView with the folder of this file on PYTHONPATH, and give its Python "
        "NumPy 1.24 and SciPy 1.10 or newer (on Debian: apt-get install python3-scipy)"
    ) from error

FACINGS = ("eye", "auto", "outward", "as given")
MODELS = ("phong", "blinn", "cylinder")
LIGHTS = ("direction", "position", "headlight", "beside the eye")
#: Visibility of what few set.
RARE = "advanced"
BOOLEAN = '<BooleanDomain name="bool"/>'


def entries(*texts):
    """Return the domain of a property with numbers as values, each with a text."""
    text_of_all = "".join(f'<Entry value="{i}" text="{text}"/>' for i, text in enumerate(texts))
    return f'<EnumerationDomain name="enum">{text_of_all}</EnumerationDomain>'


def prop(kind, name, values, words, domain="", *, shown="default"):
    """Return the description of a property with the method Put and its name."""
    values = [*values] if isinstance(values, tuple) else [values]
    return (
        f'<{kind}VectorProperty name="{name}" command="Put{name}" panel_visibility="{shown}" '
        f'number_of_elements="{len(values)}" default_values="{" ".join(map(str, values))}">'
        f"{domain}<Documentation>{words}</Documentation></{kind}VectorProperty>"
    )


def at_least(low):
    """Return the domain of a number that is not below another."""
    return f'<DoubleRangeDomain name="range" min="{low}"/>'


UNIT = '<DoubleRangeDomain name="range" min="0" max="1"/>'
TANGENTS = """
<StringVectorProperty name="Tangents" command="PutTangents" number_of_elements="5"
    element_types="0 0 0 0 2" default_values_delimiter=";" default_values="0;0;0;0;None">
  <ArrayListDomain name="array_list" attribute_type="Vectors" input_domain_name="vectors"
      none_string="None">
    <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
  </ArrayListDomain>
  <Documentation>Point array of 3 components whose direction is lit. None: the normals of the
    surface, or the tangents of lines.</Documentation>
</StringVectorProperty>"""
INPUT = """
<InputProperty name="Input" command="SetInputConnection">
  <ProxyGroupDomain name="groups"><Group name="sources"/><Group name="filters"/></ProxyGroupDomain>
  <DataTypeDomain name="input_type" composite_data_supported="1">
    <DataType value="vtkDataSet"/>
  </DataTypeDomain>
  <InputArrayDomain name="vectors" attribute_type="point" number_of_components="3" optional="1"/>
</InputProperty>"""
PROPERTIES = [
    INPUT,
    TANGENTS,
    prop("Int", "Conditioned", 0, "Tangents have the self-shadow of their surface.", BOOLEAN),
    prop("Int", "Facing", 0, "Side of the surface that is lit.", entries(*FACINGS)),
    prop("Int", "Model", 0, "Reflection model of the highlight.", entries(*MODELS)),
    prop("Int", "LightType", 0, "What Light is; beside the eye: x right, y up.", entries(*LIGHTS)),
    prop("Double", "Light", (1, 1, 1), "Direction toward the light, or its position."),
    prop("Double", "Intensity", 1, "Intensity of the light.", at_least(0)),
    prop("Double", "Eye", (0, 0, 1), "Position of the eye, or the direction toward it."),
    prop("Int", "ParallelProjection", 1, "Whether Eye is a direction.", BOOLEAN),
    prop("Double", "Ambient", 0.1, "Ambient coefficient.", at_least(0)),
    prop("Double", "Diffuse", 0.5, "Diffuse coefficient.", at_least(0)),
    prop("Double", "Specular", 0.4, "Specular coefficient.", at_least(0)),
    prop("Double", "Shininess", 20, "Exponent of the highlight.", at_least(0)),
    prop("Double", "Color", (1, 1, 1), "Colour; unless white it gives an array rgb.", UNIT),
    prop("Double", "Exponent", 0, "Diffuse exponent, 0: automatic.", at_least(0), shown=RARE),
    prop("Int", "Terms", 0, "The three terms are arrays of their own.", BOOLEAN, shown=RARE),
]  # fmt: skip
NAMES = re.findall(r'command="Put(\w+)"', "".join(PROPERTIES))


def made(part, kind, **values):
    """Return a part of the scene; an error names the part."""
    try:
        return kind(**values)
    except (TypeError, ValueError) as error:
        raise type(error)(f"{part}, {error}") from error


def setter(name):
    """Return the method by which ParaView sets a property."""

    def put(self, *values):
        self.put(name, values[0] if len(values) == 1 else values)

    return put


@smproxy.filter(label="Vizlight Illuminate", support_reload=False)
@smproperty.xml("".join(PROPERTIES))
class VizlightIlluminate(Illuminate):
    """Light as a point array; its properties are numbers and texts that ParaView can set."""

    def __init__(self):
        super().__init__()
        self.values = {}

    def put(self, name, value):
        """Set a property; the filter runs again if its value has changed."""
        if self.values.get(name) != value:
            self.values[name] = value
            self.Modified()

    # ParaView sets a property by a method of its own; locals() in the body of a class is the class.
    for _name in NAMES:
        locals()[f"Put{_name}"] = setter(_name)

    def prepare(self):
        """Set scene and options by the properties, when the input is lit."""
        self.apply(**self.values)

    def apply(
        self, *, Tangents, Conditioned, Facing, Model, LightType, Light, Intensity, Eye,
        ParallelProjection, Ambient, Diffuse, Specular, Shininess, Color, Exponent, Terms,
    ):  # fmt: skip
        """Set scene and options."""
        eye = {"direction" if ParallelProjection else "position": Eye}
        kind = LIGHTS[LightType]
        at = {
            "headlight": {"follows_view": True},
            "beside the eye": {"direction": Light, "follows_view": True},
        }.get(kind, {kind: Light})
        light = made("Light", scene.Light, intensity=Intensity, **at)
        material = made(
            "Material", scene.Material, ambient=Ambient, diffuse=Diffuse, specular=Specular,
            shininess=Shininess, color=None if Color == (1, 1, 1) else Color,
        )  # fmt: skip
        view = made("Eye", scene.View, **eye)
        self.scene = scene.Scene(lights=light, view=view, material=material)
        # ParaView gives the index, port, connection, association and name of an array.
        tangents = Tangents[-1]
        self.tangents = None if tangents in ("", "None") else tangents
        self.conditioned, self.facing = bool(Conditioned), FACINGS[Facing]
        self.model, self.exponent = MODELS[Model], Exponent or "compensated"
        self.components = bool(Terms)
