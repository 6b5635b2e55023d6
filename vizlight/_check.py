"""Validators, whose messages have the name, the expectation, the actual value and a remedy.

They raise TypeError for a value of the wrong type, ValueError for a wrong shape or value.
"""

from __future__ import annotations

import functools
import math
import numbers
import sys
import warnings
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import ParamSpec, TypeVar

    from vizlight._types import Array, Color, Indices, Vector

    P = ParamSpec("P")
    R = TypeVar("R")

#: Largest intensity, coefficient or power: the product of three of them fits float32.
LARGEST = 1e9


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Issue a warning that points at the caller's line outside this package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == "vizlight":
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)


def renamed(function: Callable[P, R], old: str) -> Callable[P, R]:
    """Return a function under its old name, which warns that it has a new one."""

    @functools.wraps(function)
    def method(*args: P.args, **kwargs: P.kwargs) -> R:
        warn(f"{old} is now called {function.__name__}", DeprecationWarning)
        return function(*args, **kwargs)

    return method


def message(name: str, expected: str, got: object, remedy: str = "") -> str:
    """Return ``name: expected ..., got ...; remedy`` on one line, with arrays described."""
    got = describe(got) if isinstance(got, np.ndarray) else got
    text = f"{name}: expected {expected}, got {got}"
    return f"{text}; {remedy}" if remedy else text


def one_of(names: Sequence[str]) -> str:
    """Return the names that the user may choose from, as part of an error message."""
    return f"one of {list(names)}" if names else "but the mesh has none"


def choice(name: str, value: object, allowed: Sequence[str]) -> None:
    """Check that a value is one of the allowed strings."""
    if value not in allowed:
        *others, last = (repr(text) for text in allowed)
        raise ValueError(message(name, f"{', '.join(others)} or {last}", describe(value)))


def boolean(name: str, value: object, *, expected: str = "True or False") -> bool:
    """Return a truth value; 0 and 1 count as such, words do not.

    Raises
    ------
    TypeError
        If the value is neither.
    """
    if isinstance(value, bool | np.bool_) or (isinstance(value, int) and value in (0, 1)):
        return bool(value)
    raise TypeError(message(name, expected, describe(value)))


def describe(value: object) -> str:
    """Return a short description of a value for an error message."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # Python does not print integers of more than 4300 digits
        kind = "an integer" if isinstance(value, int) else "a number"
        text = f"{kind} of more digits than Python prints"
    return text if len(text) <= 60 else f"{text[:57]}..."


def floats(name: str, value: object) -> Array:
    """Return ``value`` as a floating-point array.

    Integers and booleans become float64 and float16 becomes float32; float32 and float64 stay.
    Masked elements become NaN.
    """
    try:
        array = np.asarray(unmasked(value))
    except ValueError as error:
        expected = "numbers in rows of equal length"
        raise TypeError(message(name, expected, describe(value))) from error
    if array.dtype.kind in "iub":
        return array.astype(np.float64)
    if array.dtype.kind != "f":
        raise TypeError(message(name, "real numbers", describe(value)))
    if array.dtype == np.float16:
        return array.astype(np.float32)
    return array


def unmasked(value: object) -> object:
    """Return a masked array as a plain one with NaN in masked places, anything else as it is.

    Integers and booleans with masked elements become float64.
    """
    if not isinstance(value, np.ma.MaskedArray):
        return value
    if not np.ma.is_masked(value):
        return value.data
    kind = value.dtype if value.dtype.kind == "f" else np.float64
    return np.ma.filled(value.astype(kind), np.nan)


def vectors(name: str, value: object, *, n: int | None = None) -> Array:
    """Return ``value`` as a floating-point array of shape (..., n), where n is at least 2."""
    array = floats(name, value)
    if n is not None and (array.ndim == 0 or array.shape[-1] != n):
        raise ValueError(message(name, f"vectors of shape (..., {n})", array))
    if array.ndim == 0 or array.shape[-1] < 2:
        raise ValueError(message(name, "vectors of shape (..., n) with n of 2 or more", array))
    return array


def cells(name: str, value: object, count: int, sizes: Sequence[int]) -> Indices:
    """Return ``value`` as cells: rows of indices of ``count`` points, of one of some sizes."""
    array = np.asarray(value)
    if array.ndim != 2 or array.shape[1] not in sizes or array.dtype.kind not in "iu":
        shapes = " or ".join(f"(M, {size})" for size in sizes)
        raise ValueError(message(name, f"integers of shape {shapes}", array))
    if array.size and not 0 <= array.min() <= array.max() < count:
        got = f"{array.min()} to {array.max()}"
        raise ValueError(message(name, f"indices of points from 0 to {count - 1}", got))
    return array


def number(name: str, value: object, *, low: float = -math.inf, high: float = math.inf) -> float:
    """Return ``value`` as a finite float in the closed range [low, high]."""
    if isinstance(value, np.ndarray) and value.ndim == 0 and value is not np.ma.masked:
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


def positive(name: str, value: object, *, high: float = math.inf) -> float:
    """Return ``value`` as a finite float above 0 and not above ``high``."""
    result = number(name, value, low=0.0, high=high)
    if result == 0:
        raise ValueError(message(name, "a number above 0", describe(value)))
    return result


def integer(name: str, value: object, *, low: int) -> int:
    """Return ``value`` as an int of at least ``low``."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(message(name, "an integer", describe(value)))
    if value < low:
        raise ValueError(message(name, f"an integer of at least {low}", describe(value)))
    return int(value)


def vector(name: str, value: object, *, direction: bool = False) -> Vector:
    """Return one finite vector as a tuple of floats.

    With ``direction=True`` the vector must not be zero; it is not normalised.
    """
    array = vectors(name, value)
    if array.ndim != 1:
        raise ValueError(message(name, "one vector of n components", array))
    result = tuple(float(x) for x in array)
    if not all(math.isfinite(x) for x in result):
        remedy = "for a light or an eye at infinity pass direction=" if "position" in name else ""
        raise ValueError(message(name, "finite components", result, remedy))
    if direction and not any(result):
        raise ValueError(message(name, "a direction of non-zero length", result))
    return result


def optional_vector(name: str, value: object, *, direction: bool = False) -> Vector | None:
    """Return None for None, and otherwise the value as a :func:`vector`."""
    return None if value is None else vector(name, value, direction=direction)


def color(name: str, value: object) -> Color | None:
    """Return the three channels of a colour, or None for None.

    A colour is three numbers, a name, a hexadecimal string or a ``pyvista.Color``.
    """
    if value is None:
        return None
    if isinstance(value, str):
        import pyvista as pv

        try:
            value = pv.Color(value).float_rgb
        except ValueError as error:
            expected = "a colour's name, '#rrggbb' or (r, g, b)"
            raise ValueError(message(name, expected, describe(value))) from error
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
    """Check that a value is an instance of a class of this package.

    With ``optional=True`` None is allowed too. ``home`` is the public module that holds the
    class, if the package itself does not export it.
    """
    if not (isinstance(value, kind) or (optional and value is None)):
        where = f"vizlight.{home}." if home else "vizlight."
        expected = f"a {where}{kind.__name__}" + (" or None" if optional else "")
        raise TypeError(message(name, expected, describe(value), remedy))


def set_fields(frozen: object, **values: object) -> None:
    """Set validated fields of a frozen dataclass while it is being constructed."""
    for name, value in values.items():
        object.__setattr__(frozen, name, value)


def rgb(name: str, value: object) -> Color:
    """Return a colour as three linear channels from 0 to 1."""
    array = floats(name, value)
    if array.shape != (3,) or not np.all((array >= 0) & (array <= 1)):
        remedy = "divide bytes by 255; brighten a light with intensity="
        expected = "three channels (r, g, b) from 0 to 1"
        raise ValueError(message(name, expected, describe(value), remedy))
    r, g, b = (float(x) for x in array)
    return r, g, b


def _range(low: float, high: float) -> str:
    if low == -math.inf and high == math.inf:
        return "a finite number"
    if high == math.inf:
        return f"a finite number of at least {low:g}"
    return f"a number from {low:g} to {high:g}"
