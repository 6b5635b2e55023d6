"""Light in each fragment in ParaView, which needs no plugin: shader text and properties to set."""

from __future__ import annotations

import dataclasses
import json
import string
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check, files, writing
from vizlight._types import Exponent, Facing, Given, Model
from vizlight.draw import dialects, glsl
from vizlight.draw.glsl import Program
from vizlight.draw.live import NORMALS, TANGENTS, Fragments, unfit, unfit_layout
from vizlight.draw.sources import sources_in_scene
from vizlight.filters.tint import color_table
from vizlight.scene import Scene, View
from vizlight.scene.keywords import named
from vizlight.scene.light import WHITE
from vizlight.shading.display import NO_DATA, NO_DATA_NAME
from vizlight.shading.inputs import Layout
from vizlight.shading.options import LightOptions, ShadingOptions
from vizlight.shading.plan import Plan, decide

__all__ = ["Shader", "save", "shader"]

#: The camera in its own coordinates, as ParaView has it.
EYE = View(direction=(0, 0, 1))
#: Options of light that a program of fragments has no use for.
WITHOUT = (
    "positions", "feature_angle", "line_field", "bundle", "occlusion",
    "name", "components", "precision",
)  # fmt: skip
#: How normals are turned, by ``facing``; otherwise they stay as they are.
TOWARD: dict[str, Literal["eye", "face"]] = {"auto": "face", "eye": "eye"}
SUFFIX = ".py"
#: Number of colours of a map that is passed to ParaView.
COLORS = 33
_COLORED = string.Template("""\
ColorBy(display, ("POINTS", $name))
table = GetColorTransferFunction($name)
table.ColorSpace, table.RGBPoints, table.NanColor = "RGB", $points, $nan
display.RescaleTransferFunctionToDataRange(False, True)
display.SetScalarBarVisibility(view, True)
bar = GetScalarBar(table, view)
bar.DrawNanAnnotation, bar.NanAnnotation = 1, $no_data""")
_SCRIPT = string.Template("""\
# Shows a mesh in ParaView with light in each fragment: paraview --script=THIS.py, or Run Script in
# the Python shell; pvpython for a picture.
import inspect

if not hasattr(inspect, "getargspec"):
    # Debian's ParaView 5.11 calls what its Python has no more.
    inspect.getargspec = inspect.getfullargspec

from paraview.simple import *

source = $source
view = GetActiveViewOrCreate("RenderView")
display = Show(source, view)
$colors
properties = $properties
names = properties["SelectNormalArray"], properties["SelectTangentArray"]
for name in names:
    if name != "None" and source.PointData.GetArray(name) is None:
        raise RuntimeError(f"the source has no point array {name!r}")
if names[1] != "None" and source.PointData.GetArray(names[1]).GetDataType() != 10:
    raise RuntimeError(f"{names[1]}: ParaView passes an array of float32 alone; convert it")
for name, value in properties.items():
    setattr(display, name, value)
${end}Render(view)
""")


@dataclass(frozen=True)
class Shader:
    """Text and properties of a representation in ParaView.

    Parameters
    ----------
    shader_replacements : str
        Text, in JSON, of the property ``ShaderReplacements``.
    properties : dict of str to object
        Values of the other properties, by the names that ``pvpython`` has for them.
    scalars : str or None
        Name of the point array that gives the colours.
    """

    shader_replacements: str
    properties: Mapping[str, object]
    scalars: str | None = None

    def script(self, source: str | Path | None = None) -> str:
        """Return a script for ``pvpython``, ``paraview --script`` and ParaView's Python shell.

        Parameters
        ----------
        source : path, optional
            Path of a file that is opened. Default: the source that is selected.

        Returns
        -------
        str

        Examples
        --------
        >>> import vizlight
        >>> scene = vizlight.Scene(lights=vizlight.Light(direction=(1, 1, 1)))
        >>> made = vizlight.paraview.shader(scene, tangents="V", conditioned=True)
        >>> "GetActiveSource()" in made.script()
        True
        """
        values = {**self.properties, "ShaderReplacements": self.shader_replacements}
        lines = "".join(f"    {name!r}: {value!r},\n" for name, value in values.items())
        return _SCRIPT.substitute(
            source="GetActiveSource()" if source is None else f"OpenDataFile({str(source)!r})",
            colors="ColorBy(display, None)" if self.scalars is None else _colored(self.scalars),
            properties=f"{{\n{lines}}}",
            end="" if source is None else "ResetCamera(view)\n",
        )


def _colored(name: str) -> str:
    """Return statements that colour by an array, by the map of data where none is named."""
    colors = np.asarray(color_table([], clim=(0, 1), n_colors=COLORS).values)[:, :3] / 255
    points = np.column_stack([np.linspace(0, 1, COLORS), colors]).round(4)
    return _COLORED.substitute(
        name=repr(name),
        points=points.ravel().tolist(),
        nan=[round(channel, 4) for channel in NO_DATA],
        no_data=repr(NO_DATA_NAME),
    )


@named
def shader(
    scene: Scene,
    /,
    *,
    scalars: str | None = None,
    tangents: str | ArrayLike | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    conditioned: bool | str | None = False,
    exponent: Exponent = "compensated",
    model: Model = "phong",
) -> Shader:
    """Return the properties that show the light of a scene in fragments of an unchanged ParaView.

    The light follows ParaView's camera, which takes the place of the view of the scene; ParaView's
    own lights have no effect. The properties Ambient and Diffuse scale it, but not on colours of
    data, which stay readable as in :func:`vizlight.tint`.

    Parameters
    ----------
    scene : Scene
        Lights, material and depth cue in 3-space, in the coordinates of the data. Lights
        that follow the view turn with the camera.
    scalars : str, optional
        Name of the point array that gives the colours, by ``vizlight.maps.even`` unless PyVista's
        theme was changed. Default: the colour of the material.
    tangents, normals, facing, conditioned, exponent, model
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    Shader

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit; if the light of a fragment needs more than one tangent and a
        normal (``model="cylinder"``, ``conditioned=`` by an array, *n*-space); or if the depth cue
        has no ends, which without the mesh are not known.

    See Also
    --------
    save : A mesh with the arrays that its light needs, and the script that shows it.
    vizlight.vtk : The plugin that lights points in ParaView.

    Notes
    -----
    Written for ParaView 5.11, where representations have the property ``ShaderReplacements``: 99 %
    of the pixels are within 2 of 255 of the light of a plotter. A position of a light is rounded to
    float32, which is 0.25 at 5e6 from the origin. Light turns with a representation that is moved
    by its own ``Position`` or ``Orientation``; move the data in place of that. The text does not
    reach drawings by other shaders of ParaView: tubes, spheres, ray tracing and volumes.
    """
    options = LightOptions.of(locals())
    tangents, normals = (_named(name, getattr(options, name)) for name in ("tangents", "normals"))
    if isinstance(options.conditioned, str):
        expected, remedy = "True or False in ParaView", "vizlight.illuminate lights the points"
        raise _check.value_error("conditioned", expected, repr(options.conditioned), remedy)
    if normals is None and (tangents is None or options.conditioned):
        # The name that ParaView's own filters give to normals.
        normals = "Normals"
    layout = Layout(k=None if tangents is None else 1, normals=normals is not None)
    scalars = _named("scalars", scalars)
    plan = _plan(scene, layout, options)
    written = glsl.write(
        plan, turned=False, toward=TOWARD.get(options.facing, ""), data=scalars is not None
    )
    return _made(scene, plan, written, tangents, normals, scalars)


def save(
    mesh: pv.DataSet,
    /,
    scene: Scene | None,
    path: str | Path,
    *,
    scalars: str | None = None,
    **options: Given,
) -> Path:
    """Write a script that shows a mesh in ParaView with light in each fragment, and the mesh.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed; of a volume its surface is written.
    scene : Scene or None
        As for :func:`shader`. None for the record of a lit mesh.
    path : path
        Path of the script, which ends in .py. The mesh, with the tangents and normals of its
        light, is beside it: ``NAME-paraview.vtp`` for ``NAME.py``. Existing files are replaced.
    scalars : str, optional
        Name of the point array that gives the colours, as for :func:`shader`.
    **options
        Options of :func:`vizlight.illuminate`, except ``name`` and ``components``.

    Returns
    -------
    pathlib.Path
        Path of the script, which ``paraview --script=`` runs.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, the light cannot be computed in each fragment, with the
        reason, or the mesh has several blocks.
    FileError
        If a file cannot be written.
    """
    path = writing.check_output(path, (SUFFIX,))
    sources, used = sources_in_scene(mesh, scene, options)
    if len(sources) != 1:
        expected, remedy = "one block", "write a script for each"
        raise _check.value_error("mesh", expected, f"{len(sources)} blocks", remedy)
    (source,) = sources
    if scalars is not None:
        _check.text("scalars", scalars, expected="the name of a point array")
    if scalars is not None and scalars not in source.mesh.point_data:
        raise _check.value_error("scalars", "the name of a point array", repr(scalars))
    if reason := unfit(source):
        raise ValueError(_unfit(reason))
    plan = _plan(used, source.inputs.layout, source.options)
    live = Fragments(source, used)
    live.attach()
    # The eye is not known as the file is written: height fields have the side that the scene's view
    # sees.
    live.see(source.inputs, used.view)
    written = glsl.write(plan, turned=source.sided is not None, data=scalars is not None)
    result = _made(used, plan, written, TANGENTS, NORMALS, scalars, tallest=live.tallest)
    data = files.write_mesh(live.drawn, beside(path))
    text = result.script(data.resolve())
    return writing.replace_file(path, lambda draft: Path(draft).write_text(text, "utf-8"))


def beside(path: Path) -> Path:
    """Return the path of the mesh that a script shows."""
    return path.with_name(f"{path.stem}-paraview.vtp")


def _named(name: str, value: str | None) -> str | None:
    expected = "the name of a point array that the data have in ParaView"
    _check.instance(name, value, str | None, expected)
    return value


def _unfit(reason: str) -> str:
    remedy = "vizlight.illuminate lights the points, which ParaView shows as they are"
    return _check.message("light", "what a fragment can compute in ParaView", reason, remedy)


def _plan(scene: Scene, layout: Layout, options: ShadingOptions) -> Plan:
    """Return the plan of a scene as ParaView's camera sees it."""
    _check.instance("scene", scene, Scene)
    if scene.n not in (None, 3):
        raise _check.value_error("scene", "vectors of 3 components", scene.n)
    if reason := unfit_layout(layout, options):
        raise ValueError(_unfit(reason))
    cue = scene.depth_cue
    if cue is not None and (cue.front is None or cue.back is None):
        expected, remedy = "both ends for ParaView", "pass DepthCue(front=, back=), distances"
        raise _check.value_error("depth_cue", expected, "none or one", remedy)
    bare = dataclasses.replace(options, components=False)
    return decide(scene.replace(view=EYE), layout, bare)


def _made(
    scene: Scene,
    plan: Plan,
    written: Program,
    tangents: str | None,
    normals: str | None,
    scalars: str | None,
    *,
    tallest: float = 0.0,
) -> Shader:
    """Return the text of a program and the properties that it needs."""
    material = scene.material
    ambient, diffuse = min(material.ambient, 1.0), min(material.diffuse, 1.0)
    shown = ambient, diffuse, material.specular_color or WHITE
    lights = [light for light in scene.lights if light.intensity > 0]
    seen, fixed = scene.replace(view=EYE), [light.seen_from(EYE) for light in lights]
    uniforms = glsl.numbers(
        seen, fixed, *shown, fur=plan.fur, tallest=tallest, data=scalars is not None
    )
    # What stands with the camera has its numbers in view coordinates already.
    names = {"vizEye", "vizAxis", "vizFrom"}
    names |= {f"vizLight{i}" for i, light in enumerate(lights) if light.follows_view}
    uniforms = [each._replace(space="") if each.name in names else each for each in uniforms]
    normal_array, tangent_array, dialect = normals, None, dialects.PARAVIEW
    if not plan.surface:
        # VTK 9.1 takes an array of any type as normals, but as tangents one of float32 alone.
        normal_array, tangent_array, dialect = tangents, normals, dialects.PARAVIEW_TANGENTS
    replacements = [
        {"type": stage.lower(), "original": mark, "replacement": text}
        for stage, mark, text in dialect.replacements(written, uniforms)
    ]
    color = list(material.color or WHITE)
    properties: dict[str, object] = {
        "AmbientColor": color,
        "DiffuseColor": color,
        "Ambient": ambient,
        "Diffuse": diffuse,
        "Interpolation": "Gouraud",
        "SelectNormalArray": normal_array,
        "SelectTangentArray": tangent_array or "None",
        "UseShaderReplacements": 1,
    }
    return Shader(json.dumps(replacements, indent=1), properties, scalars)
