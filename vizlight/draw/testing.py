"""Snapshot tests of lit scenes: compare a picture with an inspected, stored one.

Graphics drivers draw the edges of lines and surfaces differently, so pixels cannot be compared one
by one. The mean brightness of a picture does not reveal a displaced highlight, and the mean of all
errors does not reveal thin lines that are 5 % too bright. The comparison therefore uses three
errors, each insensitive to edges; together they reveal wrong light.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from PIL import Image

from vizlight import _check
from vizlight._types import ColorLike, Foreign
from vizlight.writing import check_output, replace_file

Pixels: TypeAlias = NDArray[np.uint8]
Picture: TypeAlias = pv.BasePlotter | str | Path | Pixels

__all__ = ["Difference", "assert_same_picture", "difference"]

# pytest leaves the frames of this module out of tracebacks.
__tracebackhide__ = True

#: Side in pixels of the blocks whose means are compared; edges are displaced by at most one pixel.
BLOCK = 12


@dataclass(frozen=True)
class Difference:
    """Difference between two pictures.

    Attributes
    ----------
    brightness : float
        Relative error of the summed distance from the background, or of the summed light within
        the outlines of surfaces, whichever is larger, in the worst channel. It is 0.05 for light
        that is 5 % too bright on a dark background, and on any background if surfaces are drawn.
    block : float
        Largest mean, over a block of 12 x 12 pixels, of the distance from the range of colours that
        an edge may have: that of the expected 3 x 3 neighbourhood and a quarter more. In pixel
        values from 0 to 255.
    pixels : float
        Fraction of the pixels within the outlines of surfaces that lie outside that range by more
        than 7 of 255. It reveals a highlight of another strength, which may be two pixels wide.
    """

    brightness: float
    block: float
    pixels: float


def difference(
    got: Picture, expected: Picture, /, *, background: ColorLike | None = None
) -> Difference:
    """Measure the difference between two pictures of a lit scene.

    Parameters
    ----------
    got, expected : pyvista.Plotter, path of a picture, or ndarray of uint8, shape (h, w, 3)
        Pictures to compare. A plotter must not be closed.
    background : colour, optional
        Background colour. Default: the most frequent colour of ``expected``.

    Returns
    -------
    Difference

    Raises
    ------
    TypeError, ValueError
        If an argument is not a picture, or the sizes differ.
    """
    return _measure(_pixels("got", got), _pixels("expected", expected), background)


def assert_same_picture(
    got: Picture,
    expected: Picture,
    /,
    *,
    brightness: float = 0.02,
    block: float = 4.5,
    pixels: float = 0.006,
    background: ColorLike | None = None,
    failed: str | Path | None = None,
    add_missing: bool = False,
) -> Difference:
    """Assert that a picture of a lit scene equals the expected one, except in how edges are drawn.

    Parameters
    ----------
    got, expected : pyvista.Plotter, path of a picture, or ndarray of uint8, shape (h, w, 3)
        Picture just drawn, and the inspected, stored one. A plotter must not be closed: compare
        before ``show()``, or after ``show(auto_close=False)``.
    brightness, block, pixels : float, default: 0.02, 4.5, 0.006
        Largest errors that pass, as in :class:`Difference`. With the defaults a different
        anti-aliasing of solids and lines passes; light that is 5 % too bright fails, a lamp that
        is 5 degrees elsewhere on a surface, and a specular coefficient of 0.35 in place of 0.2.
    background : colour, optional
        Background colour. Default: the most frequent colour of ``expected``.
    failed : path, optional
        Folder for the pictures of a failure: got, expected and their difference, amplified so that
        the largest is white. It is created if necessary.
    add_missing : bool, default: False
        Whether to store ``got`` as ``expected`` if that file does not exist yet. Inspect it then.

    Returns
    -------
    Difference

    Raises
    ------
    AssertionError
        If an error exceeds its limit, the sizes differ, or the expected picture does not exist.
    TypeError, ValueError
        If an argument is not a picture.

    Examples
    --------
    >>> import vizlight
    >>> from vizlight import render, testing
    >>> def test_my_flow():  # doctest: +SKIP
    ...     plotter = render.make_plotter(lit, camera=camera)
    ...     testing.assert_same_picture(plotter, "pictures/my_flow.png", failed="failed")
    """
    limits = Difference(
        brightness=_check.number("brightness", brightness, low=0.0),
        block=_check.number("block", block, low=0.0),
        pixels=_check.number("pixels", pixels, low=0.0),
    )
    seen = _pixels("got", got)
    name = "picture"
    if isinstance(expected, str | Path):
        path = _check.path("expected", expected)
        path = check_output(path, (".png",)) if add_missing else path
        name = path.stem
        if add_missing and not path.exists():
            replace_file(path, Image.fromarray(seen).save)
        if not os.path.exists(path):  # noqa: PTH110 - False for a name that is too long
            places = _keep(failed, name, {"got": seen})
            raise AssertionError(
                f"{name}: the expected picture {str(path)!r} does not exist; store it with "
                f"add_missing=True or pytest --add-missing, and inspect it{places}"
            )
    wanted = _pixels("expected", expected)
    if seen.shape != wanted.shape:
        places = _keep(failed, name, {"got": seen, "expected": wanted})
        raise AssertionError(f"{name}: {_size(seen)} pixels, expected {_size(wanted)}{places}")
    measured = _measure(seen, wanted, background)
    wrong = [
        f"{error} {getattr(measured, error):.3g}, at most {getattr(limits, error):.3g}"
        for error in ("brightness", "block", "pixels")
        if not getattr(measured, error) <= getattr(limits, error)
    ]
    if wrong:
        errors = np.abs(seen.astype(np.int16) - wanted)
        factor = 255 // max(1, errors.max())
        amplified = (factor * errors).astype(np.uint8)
        pictures = {"got": seen, "expected": wanted, "difference": amplified}
        places = _keep(failed, name, pictures)
        times = f" times {factor}" if places else ""
        raise AssertionError(f"{name}: {'; '.join(wrong)}{places}{times}")
    return measured


def _measure(got: Pixels, expected: Pixels, background: ColorLike | None) -> Difference:
    from scipy.ndimage import binary_erosion, maximum_filter, minimum_filter, uniform_filter

    if got.shape != expected.shape:
        raise _check.value_error("got", f"{_size(expected)} pixels", _size(got))
    if (channels := _check.color("background", background)) is not None:
        back = 255.0 * np.array(pv.Color(channels).float_rgb)
    else:
        colours = expected.reshape(-1, 3)
        # Numbers are sorted ten times as fast as rows.
        numbers = colours @ np.array([65536, 256, 1])
        _, places, counts = np.unique(numbers, return_index=True, return_counts=True)
        back = colours[places[np.argmax(counts)]].astype(np.float64)
    # Differences of unsigned bytes would wrap around below 0.
    a, b = got.astype(np.float64), expected.astype(np.float64)
    drawn, wanted = (np.abs(x - back).sum(axis=(0, 1)) for x in (a, b))
    # One grey level in a thousandth of the picture counts as nothing drawn.
    least = max(1e-3 * a.shape[0] * a.shape[1], 0.02 * float(wanted.max()))
    brightness = float(np.max(np.abs(drawn - wanted) / np.maximum(wanted, least)))
    high, low = (f(b, size=(3, 3, 1)) for f in (maximum_filter, minimum_filter))
    # An edge or a line that is displaced by part of a pixel changes colours by part of their range.
    outside = np.maximum(np.maximum(a - high, low - a) - 0.25 * (high - low), 0.0)
    # The pixels next to the background are left out, because drivers draw edges differently.
    apart = [np.any(np.abs(x - back) > 8, axis=-1) for x in (a, b)]
    pixels, inside = 0.0, binary_erosion(apart[0] & apart[1], np.ones((3, 3), np.bool_))
    # Lines have hardly an inside, of whose few pixels a share would tell nothing.
    if np.mean(inside) >= 1e-2:
        light, wanted = a[inside].sum(axis=0), b[inside].sum(axis=0)
        # In a channel that is almost dark the least rounding is a large share.
        least = 0.02 * wanted.max() + 1
        brightness = max(brightness, np.max(np.abs(light - wanted) / np.maximum(wanted, least)))
        pixels = float(np.mean(outside[inside].max(axis=-1) > 7))
    # Beside the picture there is no error: a block that reaches beyond it has no larger mean.
    sides = [min(BLOCK, side) for side in a.shape[:2]]
    block = uniform_filter(outside, (*sides, 1), mode="constant").max()
    return Difference(float(brightness), float(block), pixels)


def _pixels(name: str, picture: Picture) -> Pixels:
    if isinstance(picture, pv.BasePlotter):
        if getattr(picture, "render_window", None) is None:
            raise _check.value_error(name, "an open plotter", "a closed one")
        shot = picture.screenshot(return_img=True)
        return np.array(shot, dtype=np.uint8)[..., :3]
    if isinstance(picture, str | Path):
        picture = _check.path(name, picture)
        try:
            with Image.open(picture) as image:
                return np.array(image.convert("RGB"))
        except OSError as error:
            raise _check.value_error(name, "a picture", f"{str(picture)!r}") from error
    array: Foreign = picture
    try:
        array = np.asarray(array)
    except ValueError:  # rows of unequal length
        array = np.zeros(0)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] not in (3, 4) or not array.size:
        raise _check.type_error(name, "a plotter, a path or bytes of shape (h, w, 3)", picture)
    pixels: Pixels = array[..., :3]
    return pixels


def _size(picture: Pixels) -> str:
    return f"{picture.shape[1]} x {picture.shape[0]}"


def _keep(folder: str | Path | None, name: str, pictures: dict[str, Pixels]) -> str:
    """Write the pictures of a failure and return the part of the message that names the folder."""
    if folder is None:
        return ""
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    for kind, picture in pictures.items():
        replace_file(place / f"{name}-{kind}.png", Image.fromarray(picture).save)
    return f"; see {place}/{name}-*.png: {', '.join(pictures)}"
