"""Light as a screen shows it: on colours of data, and on anything else.

Colours of data keep their chromaticity, so that they can be read by their bar: light multiplies
them by one number from 0.3 to 1, without a highlight. Every way to show data colours derives from
:func:`for_colors` and :func:`on_colors`, or is the same formula as GLSL.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vizlight import _check
from vizlight._types import Array, Bools, Color
from vizlight.model import formulas
from vizlight.scene import Scene

Bytes: TypeAlias = NDArray[np.uint8]

#: Least ambient coefficient, and least light, of colours of data.
LEAST = 0.3
#: Colour of missing data, in bytes, and as channels from 0 to 1.
NO_DATA_BYTE = 128
NO_DATA = (NO_DATA_BYTE / 255,) * 3
#: Name of that colour beside a scalar bar.
NO_DATA_NAME = "no data"
#: Light that makes any colour as bright as a screen can.
_LARGEST = 1e30
#: Percentile of the light that an exposure brings to 1.
EXPOSED_SHARE = 70
#: Number of colours that are multiplied at once.
_BLOCK = 1 << 14


def titled(name: str, *, lacking: bool) -> str:
    """Return the title of a key of values, with the colour of those that are lacking."""
    return f"{name} (grey: {NO_DATA_NAME})" if lacking else name


def numerals(numbers: Sequence[float]) -> list[str]:
    """Return numbers in the fewest digits that tell them apart, at least three."""
    words = [""]
    for digits in range(3, 16):
        words = [f"{float(f'{number:.{digits}g}'):.{max(digits, 6)}g}" for number in numbers]
        if len(set(words)) == len(set(numbers)):
            break
    return words


def for_colors(scene: Scene) -> Scene:
    """Return the scene with the light on colours of data as its luminance.

    Lights, ambient light and depth cue of a colour count by their luma; the material has no
    highlight, and its ambient coefficient is 0.3 at least. The scene has no exposure, which
    :func:`exposed` applies to the luminance.
    """
    material, cue = scene.material, scene.depth_cue
    if cue is not None:
        cue = dataclasses.replace(cue, cue=cue.cue * _luma(cue.color), color=None)
    return scene.replace(
        lights=tuple(
            # A black lamp stays one of the lights, to which shadows belong.
            dataclasses.replace(
                light, intensity=light.intensity * max(_luma(light.color), 1e-12), color=None
            )
            for light in scene.lights
        ),
        material=dataclasses.replace(
            material, ambient=max(material.ambient, LEAST), specular=0.0, color=None,
            specular_color=None,
        ),
        ambient_intensity=scene.ambient_intensity * _luma(scene.ambient_color),
        ambient_color=None,
        depth_cue=cue,
        # The caller exposes the light, see `exposed`.
        exposure=None,
    )  # fmt: skip


def exposed(light: Array, exposure: float | None) -> Array:
    """Return luminance as an exposure shows it; as it is without one.

    It is then from 0 to 1: see :func:`vizlight.model.formulas.exposed`.
    """
    if exposure is None:
        return light
    return np.asarray(light * formulas.exposed(light, exposure), light.dtype)


def exposure_of(light: ArrayLike, /) -> float:
    """Return the exposure at which the 70th percentile of some light becomes 1.

    Parameters
    ----------
    light : array_like, shape (N,) or (N, 3)
        Luminance, or colours, which count by their luma. Values that are not finite are left out.

    Returns
    -------
    float
        Factor for ``Scene(exposure=)``, from 1e-9 to 1e9; 1 where no light is above 0.

    Raises
    ------
    TypeError, ValueError
        If ``light`` is no such array.

    Examples
    --------
    >>> from vizlight.shading.display import exposure_of
    >>> exposure_of([0.1, 0.5, 0.5, 0.9])
    2.0
    """
    values: Array = np.asarray(_check.reals("light", light), np.float64)
    if values.ndim == 2 and values.shape[1] == 3:
        values = values @ np.array(formulas.LUMA)
    if values.ndim != 1:
        raise _check.value_error("light", "an array of shape (N,) or (N, 3)", values)
    values = values[np.isfinite(values)]
    high = float(np.percentile(values, EXPOSED_SHARE, method="lower")) if len(values) else 0.0
    return float(np.clip(1 / high, 1e-9, _check.LARGEST)) if high > 0 else 1.0


def _luma(color: Color | None) -> float:
    return 1.0 if color is None else float(np.dot(color, formulas.LUMA))


def on_colors(colors: Bytes, light: Array, valid: Bools | None = None) -> Bytes:
    """Return colours of data in light: ``colour * min(1, max(0.3, light))``.

    Light (N,) is that of the scene of :func:`for_colors`; points that are not ``valid`` have the
    colour of missing data. A fourth component of colours is kept, others are rounded to the nearest
    byte.
    """
    out = colors.copy()
    for start in range(0, len(colors), _BLOCK):
        rows = slice(start, start + _BLOCK)
        factor = formulas.color_factor(light[rows].astype(np.float32), LEAST)
        product = colors[rows, :3] * np.asarray(factor)[:, np.newaxis]
        # The cast to bytes cuts off, so 1/2 makes it round; the factor is 1 at most, and 255.5
        # still becomes 255.
        product += np.float32(0.5)
        out[rows, :3] = product
    if valid is not None:
        out[~valid, :3] = NO_DATA_BYTE
    return out


def displayable(rgb: ArrayLike, /) -> Array:
    """Return colours brighter than white in a screen's range, with the same chromaticity.

    Parameters
    ----------
    rgb : array_like, shape (..., 3)
        Red, green and blue, 0 or more, such as the array ``rgb`` of a lit mesh.

    Returns
    -------
    ndarray, shape (..., 3)
        Colours with channels up to 1: those with a larger one are divided by their largest, the
        others are equal to the bit. All channels are NaN where one is.

    Raises
    ------
    TypeError, ValueError
        If ``rgb`` is not an array of three real components.

    Notes
    -----
    Live light, pages, glTF files and pictures show meshes without colours of data by this rule;
    colours of data are never brighter than themselves, see :func:`vizlight.tint`.

    Examples
    --------
    >>> from vizlight.shading.display import displayable
    >>> displayable([[0.2, 0.5, 0.9], [1.6, 0.8, 0.4]])
    array([[0.2 , 0.5 , 0.9 ],
           [1.  , 0.5 , 0.25]])
    """
    colors: Array = np.asarray(_check.reals("rgb", rgb), np.float64)
    if colors.ndim < 1 or colors.shape[-1] != 3:
        raise _check.value_error("rgb", "an array of shape (..., 3)", colors)
    # An infinite channel over an infinite largest one would be NaN.
    bright = np.clip(colors, 0.0, _LARGEST)
    return np.asarray(formulas.in_range(bright, bright.max(axis=-1, keepdims=True)))
