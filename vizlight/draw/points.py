"""Light at the points, computed again before a frame in which it would be another one."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.draw import strokes
from vizlight.draw.live import COLORS, LUMINANCE, NORMALS
from vizlight.draw.program import Stroke
from vizlight.filters import lighting
from vizlight.filters.tint import light_on_colors, map_colors
from vizlight.mesh import records
from vizlight.reading import polylines
from vizlight.shading.decide import decide
from vizlight.shading.display import NO_DATA, displayable, on_colors

if TYPE_CHECKING:
    import pyvista as pv
    from numpy.typing import NDArray
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Keywords
    from vizlight.draw.live import Live
    from vizlight.scene import Scene

#: Fragment shader that draws the colours of the points.
AS_IT_IS = "  gl_FragData[0] = vec4(vertexColorVSOutput.rgb, opacity);\n"


class Points:
    """Light as a point array of the drawn mesh, the same numbers as a filter attaches.

    Parameters
    ----------
    reason : str
        Why the light is not computed in each fragment.
    diameter : float, optional
        Diameter of lines in the unit of the mesh.
    """

    light = "points"

    def __init__(self, reason: str, diameter: float | None = None) -> None:
        self.reason, self._diameter = reason, diameter

    def attach(self, live: Live) -> None:
        """Give the drawn mesh an array; the first frame fills it."""
        count = live.drawn.n_points
        records.attach_rows(live.drawn, LUMINANCE, np.zeros(count))
        channels = 3 if live.scalars is None else 4
        kind = np.float64 if live.scalars is None else np.uint8
        records.attach_rows(live.drawn, COLORS, np.zeros((count, channels), kind))
        if self._diameter is not None:
            live.attach(NORMALS, polylines.line_tangents(live.source.mesh).astype(np.float32))
            live.drawn.GetPointData().SetActiveNormals(NORMALS)

    def drawing(self, live: Live, drawing: Keywords) -> Keywords:
        """Return the keywords of ``plotter.add_mesh``."""
        if live.scalars is not None:
            return drawing | {"lighting": False}
        color = drawing.pop("color", None)
        if color is not None and live.scene is not None:
            channels = _check.color("color", color)
            material = dataclasses.replace(live.scene.material, color=channels)
            live.scene = live.scene.replace(material=material)
        plain = {"lighting": False, "show_scalar_bar": False}
        if live.scene is not None and not live.scene.colored:
            gray = {"scalars": LUMINANCE, "cmap": "gray", "clim": (0.0, 1.0)}
            return drawing | plain | gray
        own = True if color is None else color
        return drawing | plain | {"scalars": COLORS, "rgb": True, "color": own}

    def start(self, live: Live, actor: vtkActor) -> None:
        """Let an actor draw lit colours as they are, in place of the data's."""
        prop = actor.GetProperty()
        if self._diameter is not None:
            strokes.widen(actor, Stroke(self._diameter))
        if live.scene is None:
            # Without lights VTK multiplies by the sum of both coefficients, which are the material.
            actor.GetShaderProperty().AddFragmentShaderReplacement(
                "//VTK::Light::Impl", True, AS_IT_IS, False
            )
        else:
            prop.SetAmbient(1.0)
            prop.SetDiffuse(0.0)
        if live.scalars is None:
            return
        mapper = actor.GetMapper()
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(COLORS)
        mapper.SetColorModeToDirectScalars()
        mapper.SetInterpolateScalarsBeforeMapping(False)

    def paint(self, live: Live, scene: Scene, renderer: vtkRenderer, actor: vtkActor) -> None:  # noqa: ARG002
        """Light the points and draw them with the result."""
        inputs = live.source.seen_from(scene.view, live.placed(actor))
        source = live.source._replace(inputs=inputs, sided=None)
        if live.scalars is not None:
            (light,) = light_on_colors([source], scene)
            _write(live.drawn, COLORS, on_colors(_colors(live, actor), *light))
            return
        parts = [(source.inputs, source.options)]
        (shading,), _ = lighting.light(parts, scene, progress_bar=False)
        if live.scene is None or live.scene.colored:
            rgb = shading.rgb
            if rgb is None:
                rgb = np.repeat(shading.luminance[:, np.newaxis], 3, axis=1)
            # VTK wraps around above 1, so a bright highlight would turn black.
            shown = displayable(rgb)
            shown[~shading.valid] = NO_DATA
            _write(live.drawn, COLORS, shown)
        else:
            _write(live.drawn, LUMINANCE, np.where(shading.valid, shading.luminance, NO_DATA[0]))

    def explain(self, live: Live, scene: Scene) -> str:
        """Return why the light is computed at the points, and what of it."""
        fitted = lighting.fit_depth_cue(scene, [live.source.inputs])
        plan = decide(fitted, live.source.inputs.layout, live.source.options)
        return f"light at the points: {self.reason}\n{plan.explain()}"


def _colors(live: Live, actor: vtkActor) -> NDArray[np.uint8]:
    """Return the colours of the data, as the mapper has them."""
    values = np.asarray(live.drawn.point_data[live.scalars or ""])
    if values.ndim == 2:
        # Colours as they were given, or PyVista's own for an opacity of each point.
        colors = values.astype(np.uint8)
        return colors if colors.shape[1] == 4 else np.insert(colors, 3, 255, axis=1)
    table: pv.LookupTable = actor.GetMapper().GetLookupTable()
    return map_colors(table, values)


def _write(mesh: pv.DataSet, name: str, values: NDArray[np.generic]) -> None:
    """Write values to an array of a mesh, in place where they fit."""
    if name in mesh.point_data:
        array = mesh.point_data[name]
        if array.shape == values.shape and array.dtype == values.dtype:
            np.copyto(array, values)
            mesh.GetPointData().GetAbstractArray(name).Modified()
            mesh.Modified()
            return
    records.attach_rows(mesh, name, values)
