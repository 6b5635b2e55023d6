"""Snapshot tests of lit scenes: compare a picture with one that was looked at and kept.

Drivers draw the edge of a line or a surface differently, so pixels cannot be compared one by one;
a mean over the picture lets a moved highlight pass, and one over all errors lets thin lines pass
that are 5 % too bright. So three errors are looked at, each of which is blind to edges or small for
them, and together they see what a wrong law of light does.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from PIL import Image

from vizlight import _check
from vizlight.files import check_output, replace_file

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight._types import Array

__all__ = ["Difference", "assert_same_picture", "difference"]

#: Pixels on a side of the blocks whose means are compared: edges are off by one pixel or less.
BLOCK = 12


@dataclass(frozen=True)
class Difference:
    """How much two pictures differ.

    Attributes
    ----------
    brightness : float
        Of what is drawn: the summed distance from the background, or within outlines the summed
        light itself, is so many times too large or too small, in the worst channel; 0.05 for
        light 5 % too bright on a dark background, and on any background where surfaces are drawn.
    block : float
        The largest difference of the means of blocks of 12 x 12 pixels, of 255.
    pixels : float
        The share of pixels that differ by more than 32 of 255 from all expected pixels beside them.
    """

    brightness: float
    block: float
    pixels: float


def difference(got: Any, expected: Any, /, *, background: Any = None) -> Difference:
    """Measure how much a picture of a lit scene differs from another.

    Parameters
    ----------
    got, expected : pyvista.Plotter, path of a picture, or ndarray of uint8, shape (h, w, 3)
        A plotter must not be closed.
    background : colour, optional
        Default: the colour that is seen most often in ``expected``.

    Returns
    -------
    Difference

    Raises
    ------
    TypeError, ValueError
        If something is not a picture, or their sizes differ.
    """
    return _measure(_pixels("got", got), _pixels("expected", expected), background)


def assert_same_picture(
    got: Any,
    expected: Any,
    /,
    *,
    brightness: float = 0.02,
    block: float = 12.0,
    pixels: float = 0.01,
    background: Any = None,
    failed: str | Path | None = None,
    add_missing: bool = False,
) -> Difference:
    """Fail unless a picture of a lit scene is the expected one but for how edges are drawn.

    Parameters
    ----------
    got, expected : pyvista.Plotter, path of a picture, or ndarray of uint8, shape (h, w, 3)
        What was drawn, and what was looked at and kept. A plotter must not be closed: compare
        before ``show()``, or after ``show(auto_close=False)``.
    brightness, block, pixels : float
        The largest errors that pass, as :class:`Difference` has them. The defaults let other
        anti-aliasing of solids and lines pass, but not light 5 % too bright.
    background : colour, optional
        Default: the colour that is seen most often in ``expected``.
    failed : path, optional
        A folder, made if need be, for got, expected and difference of a picture that fails.
    add_missing : bool, default: False
        Keep ``got`` as ``expected`` where that file is not there yet; look at it.

    Returns
    -------
    Difference

    Raises
    ------
    AssertionError
        If an error is beyond its limit, the sizes differ, or the expected picture is not there.
    TypeError, ValueError
        If something is not a picture.

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
        path = check_output(expected, (".png",)) if add_missing else Path(expected)
        name = path.stem
        if not path.exists() and add_missing:
            replace_file(path, Image.fromarray(seen).save)
        if not path.exists():
            places = _keep(failed, name, {"got": seen})
            raise AssertionError(
                f"{name}: no expected picture {str(path)!r}; make it with add_missing=True and "
                f"look at it{places}"
            )
    wanted = _pixels("expected", expected)
    if seen.shape != wanted.shape:
        places = _keep(failed, name, {"got": seen, "expected": wanted})
        raise AssertionError(f"{name}: {_size(seen)} pixels, expected {_size(wanted)}{places}")
    found = _measure(seen, wanted, background)
    wrong = [
        f"{error} {getattr(found, error):.3g}, at most {getattr(limits, error):.3g}"
        for error in ("brightness", "block", "pixels")
        if not getattr(found, error) <= getattr(limits, error)
    ]
    if wrong:
        apart = np.abs(seen.astype(np.int16) - wanted).astype(np.uint8)
        pictures = {"got": seen, "expected": wanted, "difference": apart}
        raise AssertionError(f"{name}: {'; '.join(wrong)}{_keep(failed, name, pictures)}")
    return found


def _measure(got: NDArray[np.uint8], expected: NDArray[np.uint8], background: Any) -> Difference:
    if got.shape != expected.shape:
        raise ValueError(_check.message("got", f"{_size(expected)} pixels", _size(got)))
    if background is None:
        colours, counts = np.unique(expected.reshape(-1, 3), axis=0, return_counts=True)
        back = colours[np.argmax(counts)].astype(np.float64)
    else:
        _check.color("background", background)
        back = 255.0 * np.array(pv.Color(background).float_rgb)
    # In floats: unsigned bytes wrap around below 0.
    a, b = got.astype(np.float64), expected.astype(np.float64)
    drawn, ought = (np.abs(x - back).sum(axis=(0, 1)) for x in (a, b))
    # One grey level over a thousandth of the picture is as good as nothing drawn.
    least = max(1e-3 * a.shape[0] * a.shape[1], 0.02 * float(ought.max()))
    brightness = float(np.max(np.abs(drawn - ought) / np.maximum(ought, least)))
    brightness = max(brightness, _within_outlines(a, b, back))
    return Difference(brightness, _block_error(a - b), _far_off(a, b))


def _within_outlines(got: Array, expected: Array, back: Array) -> float:
    """Return the relative error of light where both pictures and all pixels beside are drawn on."""
    from scipy.ndimage import binary_erosion

    drawn = [np.any(np.abs(x - back) > 8, axis=-1) for x in (got, expected)]
    inside = binary_erosion(drawn[0] & drawn[1], np.ones((3, 3), np.bool_))
    if np.mean(inside) < 1e-2:
        return 0.0
    light, ought = got[inside].sum(axis=0), expected[inside].sum(axis=0)
    return float(np.max(np.abs(light - ought) / np.maximum(ought, 0.02 * ought.max() + 1)))


def _block_error(apart: Array) -> float:
    """Return the largest mean over a block, wherever it begins: no border hides an error."""
    rows, columns = (min(BLOCK, n) for n in apart.shape[:2])
    total = np.zeros((apart.shape[0] + 1, apart.shape[1] + 1, 3))
    total[1:, 1:] = apart.cumsum(axis=0).cumsum(axis=1)
    sums = total[rows:, columns:] - total[:-rows, columns:]
    sums = sums - (total[rows:, :-columns] - total[:-rows, :-columns])
    return float(np.abs(sums).max() / (rows * columns))


def _far_off(got: Array, expected: Array) -> float:
    """Return the share of pixels outside the range of the 3 x 3 expected pixels, by over 32."""
    from scipy.ndimage import maximum_filter, minimum_filter

    high, low = (f(expected, size=(3, 3, 1)) for f in (maximum_filter, minimum_filter))
    far = np.any((got > high + 32) | (got < low - 32), axis=-1)
    return float(np.mean(far))


def _pixels(name: str, picture: Any) -> NDArray[np.uint8]:
    if isinstance(picture, pv.BasePlotter):
        if getattr(picture, "render_window", None) is None:
            raise ValueError(_check.message(name, "an open plotter", "one that was closed"))
        shot = picture.screenshot(return_img=True)
        return np.array(shot, dtype=np.uint8)[..., :3]
    if isinstance(picture, str | Path):
        try:
            with Image.open(picture) as image:
                return np.array(image.convert("RGB"))
        except OSError as error:
            raise ValueError(_check.message(name, "a picture", f"{str(picture)!r}")) from error
    array = np.asarray(picture)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] not in (3, 4) or not array.size:
        shape = "a plotter, a path or bytes of shape (h, w, 3)"
        raise TypeError(_check.message(name, shape, _check.describe(picture)))
    return array[..., :3]


def _size(picture: NDArray[np.uint8]) -> str:
    return f"{picture.shape[1]} x {picture.shape[0]}"


def _keep(folder: str | Path | None, name: str, pictures: dict[str, NDArray[np.uint8]]) -> str:
    """Write the pictures of a failure and say where."""
    if folder is None:
        return ""
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    for kind, picture in pictures.items():
        replace_file(place / f"{name}-{kind}.png", Image.fromarray(picture).save)
    return f"; see {place}/{name}-*.png ({', '.join(pictures)})"
