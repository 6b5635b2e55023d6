"""Pictures of a plotter at several samples per pixel, with more than 8 bits per channel.

Colours are read back in three bytes for each channel: a line at the end of the fragment shaders
writes one channel in the place of the colour. Surfaces that are drawn otherwise, such as
translucent ones, keep their 8 bits.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkActor, vtkProp, vtkRenderer

from vizlight._types import Array
from vizlight.draw.live import items
from vizlight.draw.strokes import has_pass
from vizlight.vtk.cells import as_numpy

#: Mark of VTK's fragment shaders after which the colour is final, and the uniform with the channel.
LAST, CHANNEL = "//VTK::Picking::Impl", "vizChannel"
#: Statement that writes a channel from 0 to 1 as 24 bits; below 0 there is none to write.
PACKED = f"""//VTK::Picking::Impl
  if ({CHANNEL} > -0.5) {{
    int vizPick = int({CHANNEL} + 0.5);
    float vizValue = vizPick == 0 ? gl_FragData[0].r : (vizPick == 1 ? gl_FragData[0].g
      : gl_FragData[0].b);
    float vizWhole = floor(clamp(vizValue, 0.0, 1.0) * 16777215.0 + 0.5);
    float vizHigh = floor(vizWhole / 65536.0);
    float vizMiddle = floor((vizWhole - 65536.0 * vizHigh) / 256.0);
    gl_FragData[0] = vec4(vizHigh, vizMiddle, vizWhole - 65536.0 * vizHigh - 256.0 * vizMiddle,
      255.0) / 255.0;
  }}
"""
#: Largest difference of a channel in 24 bits from the one in 8, in 1/255, that is its rounding.
ROUNDING = 0.51


class Samples(NamedTuple):
    """Colours and depths of the picture of a plotter.

    Channels are from 0 to 255, from the upper left; one where all three are equal everywhere. Depth
    is from 0, near, to 1, behind all.
    """

    colors: Array
    depth: Array


def actors_of(renderer: vtkRenderer) -> list[vtkActor]:
    """Return the visible actors in space of a renderer."""
    actors = items(renderer.GetActors())
    return [actor for actor in actors if isinstance(actor, vtkActor) and actor.GetVisibility()]


@contextlib.contextmanager
def without(props: Iterable[vtkProp]) -> Iterator[None]:
    """Hide props while a plotter draws."""
    visible = [prop for prop in props if prop.GetVisibility()]
    for prop in visible:
        prop.SetVisibility(False)
    try:
        yield
    finally:
        for prop in visible:
            prop.SetVisibility(True)


@contextlib.contextmanager
def enlarged(plotter: pv.BasePlotter, scale: int, hidden: Sequence[vtkProp]) -> Iterator[None]:
    """Let a plotter draw several samples per pixel, each of one colour, and without some props.

    ``scale`` is the number of samples for each pixel along a side.
    """
    window = plotter.render_window
    assert window is not None
    size, multisamples = window.GetSize(), window.GetMultiSamples()
    actors = [actor for renderer in plotter.renderers for actor in actors_of(renderer)]
    properties = [(actor.GetProperty(), actor.GetProperty().GetLineWidth(),
                   actor.GetProperty().GetPointSize()) for actor in actors]  # fmt: skip
    smoothed = [(renderer, renderer.GetPass(), renderer.GetUseFXAA())
                for renderer in plotter.renderers]  # fmt: skip
    try:
        window.SetMultiSamples(0)
        for renderer, drawn_by, _ in smoothed:
            renderer.SetUseFXAA(False)
            if has_pass(drawn_by, "vtkSSAAPass"):
                renderer.SetPass(None)
        for style, width, point in properties:
            style.SetLineWidth(scale * width)
            style.SetPointSize(scale * point)
        window.SetSize(scale * size[0], scale * size[1])
        with without(hidden):
            yield
    finally:
        window.SetSize(*size)
        window.SetMultiSamples(multisamples)
        for style, width, point in properties:
            style.SetLineWidth(width)
            style.SetPointSize(point)
        for renderer, drawn_by, fxaa in smoothed:
            renderer.SetPass(drawn_by)
            renderer.SetUseFXAA(fxaa)
        # What is read back next is a picture of the old size again.
        window.Render()


def samples_of(plotter: pv.BasePlotter, *, fine: bool = True) -> Samples:
    """Return the present picture of a plotter, sample by sample.

    With ``fine`` channels have 24 bits, for each of which the picture is drawn once more.
    """
    window = plotter.render_window
    assert window is not None
    window.Render()
    coarse = _bytes(plotter)
    depths = vtkFloatArray()
    width, height = window.GetSize()
    window.GetZbufferData(0, 0, width - 1, height - 1, depths)
    depth = as_numpy(depths).reshape(height, width)[::-1]
    gray = bool(np.all(coarse[..., :1] == coarse[..., 1:]))
    colors = coarse[..., : 1 if gray else 3].astype(np.float32)
    every = [prop for renderer in plotter.renderers for prop in _props(renderer)]
    # Bytes of a value do not blend.
    if fine and not any(prop.HasTranslucentPolygonalGeometry() for prop in every):
        actors = [actor for renderer in plotter.renderers for actor in actors_of(renderer)]
        for channel, exact in enumerate(_packed(plotter, actors, colors.shape[2])):
            near = np.abs(exact - colors[..., channel]) <= ROUNDING
            colors[..., channel][near] = exact[near]
    return Samples(colors, depth)


def _props(renderer: vtkRenderer) -> list[vtkProp]:
    return [prop for prop in items(renderer.GetViewProps()) if prop.GetVisibility()]


def _packed(plotter: pv.BasePlotter, actors: Iterable[vtkActor], count: int) -> Iterator[Array]:
    """Yield each channel as it is before it is rounded to 8 bits."""
    shaders = [actor.GetShaderProperty() for actor in actors]
    for shader in shaders:
        shader.AddFragmentShaderReplacement(LAST, True, PACKED, False)
    try:
        for channel in range(count):
            for shader in shaders:
                shader.GetFragmentCustomUniforms().SetUniformf(CHANNEL, float(channel))
            plotter.render_window.Render()  # type: ignore[union-attr]
            byte = _bytes(plotter)
            whole = byte[..., 0].astype(np.float32)
            whole += byte[..., 1] * np.float32(2**-8)
            whole += byte[..., 2] * np.float32(2**-16)
            # 255 parts of 2^24 - 1, of which the first byte counts 2^16.
            whole *= np.float32(255 * 65536 / 16777215)
            yield whole
    finally:
        for shader in shaders:
            shader.ClearFragmentShaderReplacement(LAST, True)
            shader.GetFragmentCustomUniforms().RemoveUniform(CHANNEL)


def _bytes(plotter: pv.BasePlotter) -> Array:
    """Return the picture that was drawn last, in 8 bits per channel."""
    window = plotter.render_window
    assert window is not None
    width, height = window.GetSize()
    pixels = vtkUnsignedCharArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0)
    return as_numpy(pixels).reshape(height, width, 3)[::-1]
