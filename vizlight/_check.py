"""Validators: every message says name, expected, got and, where there is one, the remedy."""

from __future__ import annotations

import math
import numbers
import sys
import warnings
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Color, Vector

#: The largest intensity, coefficient or power: products of three fit float32.
LARGEST = 1e9


def warn(text: str) -> None:
    """Warn at the line outside this package that called it."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == "vizlight":
        level, frame = level + 1, frame.f_back
    warnings.warn(text, stacklevel=level)


def message(name: str, expected: str, got: object, remedy: str = "") -> str:
    """Return ``name: expected ..., got ...; remedy`` on one line."""
    text = f"{name}: expected {expected}, got {got}"
    return f"{text}; {remedy}" if remedy else text


def one_of(names: Sequence[str]) -> str:
    """Return ``one of`` some names, for an error message, or that there is none."""
    return f"one of {list(names)}" if names else "of which there is none"


def describe(value: object) -> str:
    """Return a short description of a value for an error message."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # Python writes no integer of more than 4300 digits
        kind = "an integer" if isinstance(value, int) else "a number"
        text = f"{kind} of more digits than can be written"
    return text if len(text) <= 60 else f"{text[:57]}..."


def floats(name: str, value: object) -> Array:
    """Return ``value`` as a floating array; integers become float64, half becomes float32.

    Raises
    ------
    TypeError
        If the value does not hold real numbers.
    """
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise TypeError(message(name, "numbers of one shape", describe(value))) from error
    if array.dtype.kind in "iub":
        return array.astype(np.float64)
    if array.dtype.kind != "f":
        raise TypeError(message(name, "real numbers", describe(value)))
    if array.dtype == np.float16:
        return array.astype(np.float32)
    return array


def vectors(name: str, value: object, *, n: int | None = None) -> Array:
    """Return ``value`` as floats of shape (..., n) with n of at least 2.

    Raises
    ------
    TypeError
        If the value does not hold real numbers.
    ValueError
        If the last axis has another length.
    """
    array = floats(name, value)
    if n is not None and (array.ndim == 0 or array.shape[-1] != n):
        raise ValueError(message(name, f"vectors of shape (..., {n})", describe(array)))
    if array.ndim == 0 or array.shape[-1] < 2:
        raise ValueError(
            message(name, "vectors of shape (..., n), n of 2 or more", describe(array))
        )
    return array


def number(
    name: str,
    value: object,
    *,
    low: float = -math.inf,
    high: float = math.inf,
) -> float:
    """Return ``value`` as a finite float in the closed range [low, high].

    Raises
    ------
    TypeError
        If the value is not one real number.
    ValueError
        If it is outside the range, infinite or NaN.
    """
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(message(name, "a number", describe(value)))
    try:
        result = float(value)
    except OverflowError:  # an integer or a fraction beyond the largest double
        result = math.inf
    if not (math.isfinite(result) and low <= result <= high):
        raise ValueError(message(name, _range(low, high), describe(value)))
    return result


def integer(name: str, value: object, *, low: int) -> int:
    """Return ``value`` as an int of at least ``low``.

    Raises
    ------
    TypeError
        If the value is not an integer.
    ValueError
        If it is less than ``low``.
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(message(name, "an integer", describe(value)))
    if value < low:
        raise ValueError(message(name, f"an integer of at least {low}", describe(value)))
    return int(value)


def vector(name: str, value: object, *, direction: bool = False) -> Vector:
    """Return one finite vector as a tuple of floats.

    With ``direction=True`` its length must not be zero; it is returned as it came.

    Raises
    ------
    TypeError
        If the value does not hold real numbers.
    ValueError
        If it is not one vector of at least 2 components, is not finite, or is a zero direction.
    """
    array = vectors(name, value)
    if array.ndim != 1:
        raise ValueError(message(name, "one vector of n components", describe(array)))
    result = tuple(float(x) for x in array)
    if not all(math.isfinite(x) for x in result):
        remedy = "a light or eye at infinity is given by direction=" if "position" in name else ""
        raise ValueError(message(name, "finite components", result, remedy))
    if direction and not any(result):
        raise ValueError(message(name, "a direction of non-zero length", result))
    return result


def optional_vector(name: str, value: object, *, direction: bool = False) -> Vector | None:
    """Return :func:`vector` of a value, or None."""
    return None if value is None else vector(name, value, direction=direction)


def color(name: str, value: object) -> Color | None:
    """Return three channels from numbers, a colour's name or hex, a ``pyvista.Color``, or None.

    Raises
    ------
    TypeError
        If the value does not hold real numbers.
    ValueError
        If it is no colour.
    """
    if value is None:
        return None
    if isinstance(value, str):
        import pyvista as pv

        try:
            value = pv.Color(value).float_rgb
        except ValueError as error:
            raise ValueError(
                message(name, "a colour's name, '#rrggbb' or (r, g, b)", repr(value))
            ) from error
    return rgb(name, getattr(value, "float_rgb", value))


def instance(
    name: str,
    value: object,
    kind: type,
    *,
    optional: bool = False,
    home: str = "",
    remedy: str = "",
) -> None:
    """Check that a value is of one of this package's classes, or None where that may be.

    ``home`` is the public module of a class that is not at the package's top.

    Raises
    ------
    TypeError
        If it is not.
    """
    if not (isinstance(value, kind) or (optional and value is None)):
        where = f"vizlight.{home}." if home else "vizlight."
        expected = f"a {where}{kind.__name__}" + (" or None" if optional else "")
        raise TypeError(message(name, expected, describe(value), remedy))


def set_fields(frozen: object, **values: object) -> None:
    """Set the validated fields of a frozen dataclass that is being made."""
    for name, value in values.items():
        object.__setattr__(frozen, name, value)


def rgb(name: str, value: object) -> Color:
    """Return a colour as three linear channels from 0 to 1.

    Raises
    ------
    TypeError
        If the value does not hold real numbers.
    ValueError
        If there are not three, or one is not from 0 to 1.
    """
    array = floats(name, value)
    if array.shape != (3,) or not np.all((array >= 0) & (array <= 1)):
        raise ValueError(
            message(
                name,
                "three channels (r, g, b) from 0 to 1",
                describe(value),
                "divide bytes by 255; intensity= makes light brighter",
            )
        )
    r, g, b = (float(x) for x in array)
    return r, g, b


def _range(low: float, high: float) -> str:
    if low == -math.inf and high == math.inf:
        return "a finite number"
    if high == math.inf:
        return f"a finite number of at least {low:g}"
    return f"a number from {low:g} to {high:g}"
