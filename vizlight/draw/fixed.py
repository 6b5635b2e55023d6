"""The part of the light that does not depend on the eye, as colours that any viewer can show."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from vizlight.filters import lighting
from vizlight.filters.tint import light_on_colors
from vizlight.reading.normals import piece_numbers
from vizlight.shading.display import NO_DATA, displayable, on_colors

if TYPE_CHECKING:
    from vizlight._types import Indices
    from vizlight.filters.relight import Source
    from vizlight.scene import Scene, View
    from vizlight.shading.display import Bytes

#: Rows of all points.
EVERY = slice(None)
#: What is left out, for a page, a file and its reader.
LEFT_OUT = "ambient and diffuse light only: the highlight and the depth cue depend on the eye"


def fixed_colors(
    source: Source, scene: Scene, colors: Bytes | None, ids: Indices | slice = EVERY
) -> tuple[Bytes, str]:
    """Return colours in light that stays as it is when the eye moves.

    Parameters
    ----------
    source : Source
    scene : Scene
        Scene; its view is used only where ambient and diffuse light cannot do without one.
    colors : ndarray of uint8, shape (M, 4), or None
        Colours of data; None for the material's.
    ids : ndarray of int, shape (M,), optional
        Point of the source that each colour belongs to. Default: all points, one after the other.

    Returns
    -------
    colors : ndarray of uint8, shape (M, 4)
        Colours in ambient and diffuse light.
    from_view : str
        What was computed as the view of the scene sees it, in words; empty if nothing was.
    """
    seen = []
    following = [light for light in scene.lights if light.follows_view and light.intensity > 0]
    if any(light.is_headlight for light in following):
        seen.append("the headlight")
    if not all(light.is_headlight for light in following):
        seen.append("the light that follows the view")
    if source.options.model == "cylinder":
        seen.append("the diffuse light of cylinders")
    if source.inputs.fur_height is not None:
        seen.append("the way of light out of the fur")
    if source.sided is not None:
        seen.append("the lit side of open surfaces")
    bare = scene.replace(
        material=dataclasses.replace(scene.material, specular=0.0),
        depth_cue=None,
        view=scene.view if seen else None,
    )
    return lit_colors(_on_one_side(source, bare.view), bare, colors, ids), " and ".join(seen)


def lit_colors(
    source: Source, scene: Scene, colors: Bytes | None, ids: Indices | slice = EVERY
) -> Bytes:
    """Return colours of data, or of the material, in light, as bytes of shape (M, 4)."""
    if colors is not None:
        light, valid = light_on_colors([source], scene)[0]
        return on_colors(colors, light[ids], valid[ids])
    inputs = source.seen_from(scene.view, source.inputs)
    parts = [(inputs, source.options)]
    (shading,), _ = lighting.light(parts, scene, progress_bar=False)
    rgb = shading.luminance[:, np.newaxis] if shading.rgb is None else shading.rgb
    shown = displayable(np.broadcast_to(rgb, (len(rgb), 3)))
    shown[~shading.valid] = NO_DATA
    return np.insert(255.0 * shown + 0.5, 3, 255.0, axis=1).astype(np.uint8)[ids]


def _on_one_side(source: Source, view: View | None) -> Source:
    """Return a source whose open pieces are lit on the side that most of their points show.

    Turned point by point they would be dark where the eye of the file's reader is not expected.
    """
    own = source.inputs.normals
    turned = source.seen_from(view, source.inputs).normals
    if source.sided is None or own is None or turned is None:
        return source
    vectors = np.asarray(own[:])
    piece = piece_numbers(source.mesh)
    same = np.sign(np.einsum("ij,ij->i", vectors, np.asarray(turned[:])))
    averted = np.bincount(piece, same)[piece] < 0
    sides = np.where(averted[:, np.newaxis], -vectors, vectors)
    return source._replace(inputs=dataclasses.replace(source.inputs, normals=sides), sided=None)
