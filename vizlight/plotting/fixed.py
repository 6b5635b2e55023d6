"""The part of the light that does not depend on the eye, as colours that any viewer can show."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from vizlight.filters.tint import displayable, light_factors
from vizlight.reading.normals import piece_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight._types import Array
    from vizlight.filters.relight import Source
    from vizlight.scene import Scene, View

#: What is left out, for a page, a file and its reader.
LEFT_OUT = "ambient and diffuse light only: the highlight and the depth cue depend on the eye"


def fixed_light(source: Source, scene: Scene) -> tuple[Array, str]:
    """Return what colours are multiplied by in light that stays as it is when the eye moves.

    Parameters
    ----------
    source : Source
    scene : Scene
        Scene; its view is used only where ambient and diffuse light cannot do without one.

    Returns
    -------
    factors : ndarray, shape (N, 1) or (N, 3)
        Ambient and diffuse light.
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
    ((factors, _),) = light_factors([_on_one_side(source, bare.view)], bare)
    return factors, " and ".join(seen)


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


def lit_colors(colors: Array, factors: Array, rest: Array | float = 0.0) -> NDArray[np.uint8]:
    """Return colours from 0 to 1 times light, in bytes of shape (N, 4), opaque if they have none.

    Parameters
    ----------
    colors : array_like, shape (3,), (N, 3) or (N, 4)
    factors : array_like, shape (N, 1) or (N, 3)
    rest : array_like, shape (N, 1) or (N, 3), or float, default: 0
        Light that does not take the colour.
    """
    rows = np.broadcast_to(colors, (len(factors), np.shape(colors)[-1]))
    found = np.full((len(factors), 4), 255, np.uint8)
    found[:, :3] = displayable(255.0 * (rows[:, :3] * factors + rest), white=255.0) + 0.5
    if rows.shape[1] == 4:
        found[:, 3] = np.clip(255.0 * rows[:, 3] + 0.5, 0, 255)
    return found
