"""Validators: their messages have the name, the expectation, the actual value and a remedy.

They raise TypeError for a value of the wrong type, ValueError for a wrong shape or value.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import math
import numbers
import os
import re
import sys
import threading
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import UnionType

import numpy as np

from vizlight import _words
from vizlight._types import Array, Color, Foreign, Function, Indices, Raw, Vector

# pytest leaves the frames of this module out of tracebacks.
__tracebackhide__ = True

describe, message, one_of = _words.describe, _words.message, _words.one_of
value_error, type_error = _words.value_error, _words.type_error

#: Largest intensity, coefficient or power: the product of three of them fits float32.
LARGEST = 1e9
#: Largest coordinate: the product of three of them fits float64.
FARTHEST = 1e100
#: Largest number of elements of an array, 2 TiB in float64; and largest integer, from which float64
#: skips some.
MOST, LARGEST_INTEGER = 2**38, 2**53


#: Names that VTK's table lacks or spells otherwise.
_OTHERS = {
    "gray": "808080", "rebeccapurple": "663399",
    "paraviewbackground": "54596d", "paraviewbackgroundwarm": "625d5a",
    "deepcadmiumred": "e3170d", "deepcobaltviolet": "91219e", "deepnaplesyellow": "ffa812",
    "lightcadmiumred": "ff030d", "lightcadmiumyellow": "ffb00f", "lightslateblue": "8470ff",
    "lightviridian": "6eff70",
    "tab:blue": "1f77b4", "tab:orange": "ff7f0e", "tab:green": "2ca02c", "tab:red": "d62728",
    "tab:purple": "9467bd", "tab:brown": "8c564b", "tab:pink": "e377c2", "tab:gray": "7f7f7f",
    "tab:olive": "bcbd22", "tab:cyan": "17becf",
    "b": "0000ff", "g": "008000", "r": "ff0000", "c": "00ffff", "m": "ff00ff", "y": "ffff00",
    "k": "000000", "w": "ffffff",
    "pv": "54596d", "paraview": "54596d", "paraviewwarm": "625d5a", "lightgoldenrod": "fafad2",
}  # fmt: skip


@contextlib.contextmanager
def in_block(path: str) -> Iterator[None]:
    """Name the block of a mesh in an error, of the same kind, unless the path is empty."""
    try:
        yield
    except (TypeError, ValueError) as error:
        if not path:
            raise
        raise type(error)(f"block {path}: {error}") from error


class held:  # noqa: N801 - used as a function
    """Hold the warnings of a thread until a block ends well; an error comes without them.

    A name in them, such as that of a temporary file, is replaced by another.
    """

    _texts = threading.local()

    def __init__(self, name: str = "", shown: str = "") -> None:
        self._names = name, shown

    def __enter__(self) -> None:
        """Begin to hold; an outer block keeps its warnings."""
        self._outer: list[str] | None = getattr(self._texts, "held", None)
        self._texts.held = []

    def __exit__(self, kind: object, *_: object) -> None:
        """Issue the held warnings, if no error came."""
        texts, self._texts.held = self._texts.held, self._outer
        for text in texts if kind is None else ():
            warn(text.replace(*self._names))


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Issue a warning that points at the caller's line outside this package."""
    texts: list[str] | None = getattr(held._texts, "held", None)
    if texts is not None and category is UserWarning:
        texts.append(text)
        return
    level, frame = 2, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == "vizlight":
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)


def choice(name: str, value: object, allowed: Sequence[str], *, optional: bool = False) -> None:
    """Check that a value is one of the allowed strings, or with ``optional=True`` None."""
    # An array would be compared element by element, so that anything but a text is ruled out first.
    if not (isinstance(value, str) and value in allowed) and not (optional and value is None):
        *others, last = (repr(text) for text in (*allowed, *([None] if optional else [])))
        raise value_error(name, f"{', '.join(others)} or {last}", describe(value))


def boolean(name: str, value: object, *, expected: str = "True or False") -> bool:
    """Return a truth value; 0 and 1 count as such, words do not."""
    if isinstance(value, bool | np.bool_) or (isinstance(value, int) and value in (0, 1)):
        return bool(value)
    raise type_error(name, expected, value)


def flags(frozen: Foreign) -> None:
    """Check the fields of a frozen dataclass that are annotated ``bool``; see :func:`boolean`."""
    # Annotations are texts in modules that postpone them.
    fields(frozen, boolean, *[f.name for f in dataclasses.fields(frozen) if f.type == "bool"])


def fields(
    frozen: object, check: Function, *names: str, optional: bool = False, **limits: float
) -> None:
    """Set fields of a frozen dataclass to their values from a validator.

    With ``optional=True`` None stays. ``limits`` are keywords of the validator.
    """
    for name in names:
        value = getattr(frozen, name)
        if not (optional and value is None):
            set_fields(frozen, **{name: check(name, value, **limits)})


def array_name(name: str, value: object) -> str:
    """Return the name of an array that is made: text that is not empty."""
    expected = "a name for the point array"
    if not text(name, value, expected=expected):
        raise value_error(name, expected, "an empty text")
    return str(value)


def reals(name: str, value: object) -> Raw:
    """Return ``value`` as an array of real numbers of any type; masked elements become NaN."""
    try:
        array = np.asarray(unmasked(value))
    except ValueError as error:
        raise type_error(name, "numbers in rows of equal length", value) from error
    if array.dtype.kind not in "iubf":
        raise type_error(name, "real numbers", value)
    holds(name, array.shape)
    return array


def floats(name: str, value: object) -> Array:
    """Return ``value`` as a floating-point array.

    Integers, booleans and longer floats become float64 and float16 becomes float32; float32 and
    float64 stay. Masked elements become NaN.
    """
    array = reals(name, value)
    # The square of 256 is beyond the range of float16.
    if array.dtype == np.float16:
        return array.astype(np.float32)
    if array.dtype.kind != "f" or array.dtype.itemsize > 8:
        with np.errstate(over="ignore"):
            return array.astype(np.float64)
    # Compiled code and VTK take the byte order of the machine, which files may not have.
    return array.astype(array.dtype.newbyteorder("="), copy=False)


def floats_in(name: str, value: object, low: float, high: float, what: str = "numbers") -> Array:
    """Return ``value`` as a floating-point array of finite numbers in the range [low, high].

    An end that is rounded up to a narrower type passes. ``what`` names the numbers.
    """
    array = floats(name, value)
    slack = 8 * float(np.finfo(array.dtype).eps)
    # Of float64, since the array's own type may not hold them.
    low, high = np.float64(low - slack * abs(low)), np.float64(high + slack * abs(high))
    if not np.all((array >= low) & (array <= high) & np.isfinite(array)):
        bounds = f"of at least {low:g}" if high == math.inf else f"from {low:g} to {high:g}"
        raise value_error(name, f"{what} {bounds}", describe(value))
    return array


def coordinates(name: str, value: object) -> Array:
    """Return ``value`` as float64 coordinates with products that float64 holds."""
    return floats_in(name, value, -FARTHEST, FARTHEST, "finite values").astype(np.float64)


def together(**arrays: Array) -> list[Array]:
    """Return arrays, each by its name, broadcast to one shape."""
    broadcast_shape(**{name: array.shape for name, array in arrays.items()})
    return list(np.broadcast_arrays(*arrays.values()))


def broadcast_shape(**shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape that shapes, each by the name of its array, broadcast to."""
    names = ", ".join(shapes)
    try:
        shape = np.broadcast_shapes(*shapes.values())
    except ValueError as error:
        got = ", ".join(str(shape) for shape in shapes.values())
        raise value_error(names, "shapes that broadcast", got) from error
    holds(names, shape)
    return shape


def holds(name: str, shape: Sequence[int]) -> None:
    """Check that memory can hold an array of some shape."""
    if math.prod(shape) > MOST:
        got = describe(tuple(shape))
        raise value_error(name, f"at most {MOST:.2g} numbers in all", got, "pass fewer")


def unmasked(value: object) -> object:
    """Return a masked array as a plain one with NaN in masked places, anything else as it is.

    Integers and booleans with masked elements become float64.
    """
    if not isinstance(value, np.ma.MaskedArray):
        return value
    if not np.ma.is_masked(value):
        return value.data
    # Integers and booleans have no NaN.
    kind = value.dtype if value.dtype.kind == "f" else np.float64
    return np.ma.filled(value.astype(kind), np.nan)


def vectors(name: str, value: object, *, n: int | None = None) -> Array:
    """Return ``value`` as a floating-point array of shape (..., n), where n is at least 2."""
    array = floats(name, value)
    if n is not None and (array.ndim == 0 or array.shape[-1] != n):
        raise value_error(name, f"vectors of shape (..., {n})", array)
    if array.ndim == 0 or array.shape[-1] < 2:
        raise value_error(name, "vectors of shape (..., n) with n of 2 or more", array)
    return array


def cells(
    name: str, value: object, count: int, sizes: Sequence[int], *, of: str = "points"
) -> Indices:
    """Return ``value`` as cells: rows of indices of ``count`` points, of one of some sizes."""
    array = reals(name, value)
    if array.ndim != 2 or array.shape[1] not in sizes or array.dtype.kind not in "iu":
        shapes = " or ".join(f"(M, {size})" for size in sizes)
        raise value_error(name, f"integers of shape {shapes}", array)
    if array.size and not 0 <= array.min() <= array.max() < count:
        got = f"{array.min()} to {array.max()}"
        raise value_error(name, f"indices of {of} from 0 to {count - 1}", got)
    return array.astype(np.intp, copy=False)


def indices(name: str, value: object, limit: int) -> Indices:
    """Return ``value`` as a row of indices from 0 to ``limit - 1``."""
    array = reals(name, value)
    # NumPy makes an empty list one of floats.
    if array.size == 0:
        array = array.astype(np.intp)
    if array.dtype.kind not in "iu":
        raise TypeError(message(name, "integers", array))
    if array.ndim != 1 or (array.size and not 0 <= array.min() <= array.max() < limit):
        raise value_error(name, f"a 1-D array of indices from 0 to {limit - 1}", array)
    return array.astype(np.intp, copy=False)


def number(name: str, value: object, *, low: float = -math.inf, high: float = math.inf) -> float:
    """Return ``value`` as a finite float in the closed range [low, high]."""
    value = _scalar(value)
    # To Python True is the number 1; as an option it is a mistake.
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise type_error(name, "a number", value)
    try:
        result = float(value)
    except OverflowError:  # an integer or a fraction beyond the largest double
        result = math.inf
    if not (math.isfinite(result) and low <= result <= high):
        raise value_error(name, _range(low, high), describe(value))
    return result


def positive(name: str, value: object, *, high: float = math.inf) -> float:
    """Return ``value`` as a finite float above 0 and not above ``high``."""
    result = number(name, value, low=0.0, high=high)
    if result == 0:
        raise value_error(name, "a number above 0", describe(value))
    return result


def integer(name: str, value: object, *, low: int, high: int = LARGEST_INTEGER) -> int:
    """Return ``value`` as an int in the closed range [low, high]."""
    value = _scalar(value)
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise type_error(name, "an integer", value)
    result = int(value)
    if not low <= result <= high:
        expected = f"of at least {low}" if result < low else f"of at most {high}"
        raise value_error(name, f"an integer {expected}", describe(value))
    return result


def _scalar(value: object) -> object:
    """Return the element of an array without axes, and anything else as it is."""
    if isinstance(value, np.ndarray) and value.ndim == 0 and value is not np.ma.masked:
        return value.item()
    return value


def text(name: str, value: object, *, expected: str = "text") -> str:
    """Return a string without a null character, at which VTK and files end names."""
    if not isinstance(value, str):
        raise type_error(name, expected, value)
    # Half of a surrogate pair has no bytes in UTF-8, in which VTK takes names.
    if "\0" in value or value != value.encode("utf-8", "ignore").decode():
        raise value_error(name, f"{expected} of valid characters", describe(value))
    return str(value)


def texts(name: str, value: object, count: int) -> list[str]:
    """Return a number of texts."""
    if not isinstance(value, list | tuple) or len(value) != count:
        raise value_error(name, f"{count} text{'s' * (count != 1)}", describe(value))
    return [text(name, each) for each in value]


def path(name: str, value: object) -> Path:
    """Return a path of valid characters that is not empty."""
    expected = "the path of a file"
    file = os.fspath(value) if isinstance(value, str | os.PathLike) else value
    if not isinstance(file, str):
        raise type_error(name, expected, value)
    try:
        # Bytes that are no characters of the locale name files all the same.
        valid = "\0" not in os.fsencode(file).decode("latin-1")
    except UnicodeEncodeError:
        valid = False
    if not valid:
        raise value_error(name, f"{expected} of valid characters", describe(value))
    if not file:
        raise value_error(name, expected, "an empty text")
    return Path(file)


def iterable(name: str, value: object, expected: str) -> None:
    """Check that a value holds others, as a text and a dict do not; ``expected`` says which."""
    # An array without axes has the method ``__iter__``, but nothing to iterate over.
    flat = getattr(value, "ndim", 1) != 0
    if isinstance(value, str | bytes | dict) or not (flat and hasattr(value, "__iter__")):
        raise type_error(name, expected, value, "put a single one in a list")


def function(name: str, value: object, *, optional: bool = False) -> None:
    """Check that a value can be called; with ``optional=True`` None is allowed too."""
    if not (callable(value) or (optional and value is None)):
        raise type_error(name, "a function" + (" or None" if optional else ""), value)


def vector(name: str, value: object, *, direction: bool = False, n: int | None = None) -> Vector:
    """Return one finite vector, of n components if that is given, as a tuple of floats.

    With ``direction=True`` the vector must not be zero; it is not normalised.
    """
    array = vectors(name, value)
    if array.ndim != 1 or array.size > LARGEST:
        raise value_error(name, "one vector of n components", array)
    result = tuple(float(x) for x in array)
    if not all(math.isfinite(x) for x in result):
        remedy = "for a light or an eye at infinity pass direction=" if "position" in name else ""
        raise value_error(name, "finite components", result, remedy)
    if direction and not any(result):
        raise value_error(name, "a direction of non-zero length", result)
    if n is not None and len(result) != n:
        raise value_error(name, f"{n} components", len(result))
    return result


def limits(name: str, value: object) -> tuple[float, float]:
    """Return the ends of a range of colours: two numbers, or one for the range about zero."""
    if isinstance(value, int | float | np.number):
        half = abs(number(name, value))
        return -half, half
    ends = vector(name, value)
    if len(ends) != 2 or ends[0] > ends[1]:
        raise value_error(name, "a lower and a higher number", value)
    return ends[0], ends[1]


def unit(name: str, value: object) -> Array:
    """Return a direction of 3 components, of any length but 0, with length 1."""
    direction = np.array(vector(name, value, direction=True, n=3))
    # By a power of 2, which rounds nothing: squares of the components might overflow.
    direction = np.ldexp(direction, -np.frexp(np.abs(direction).max())[1])
    return np.asarray(direction / np.linalg.norm(direction))


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
        try:
            value = _named(value)
        except ValueError as error:
            expected = "a colour's name, '#rrggbb' or (r, g, b)"
            raise value_error(name, expected, describe(value)) from error
    channels = getattr(value, "float_rgb", value)
    array = floats(name, channels)
    if array.shape != (3,) or not np.all((array >= 0) & (array <= 1)):
        remedy = "divide bytes by 255; brighten a light with intensity="
        expected = "three channels (r, g, b) from 0 to 1"
        raise value_error(name, expected, describe(channels), remedy)
    r, g, b = (float(x) for x in array)
    return r, g, b


def instance(
    name: str,
    value: object,
    kind: type | UnionType,
    expected: str = "",
    *,
    optional: bool = False,
    home: str = "",
    remedy: str = "",
) -> None:
    """Check that a value is an instance of a class.

    With ``optional=True`` None is allowed too. Without ``expected``, the words for the class, it is
    one of this package; ``home`` is the public module that holds it, if the package itself does not
    export it.
    """
    if isinstance(value, kind) or (optional and value is None):
        return
    if not expected and isinstance(kind, type):
        where = f"vizlight.{home}." if home else "vizlight."
        expected = f"a {where}{kind.__name__}" + (" or None" if optional else "")
        if not remedy and callable(value) and hasattr(value, "__name__"):
            remedy = f"call it: {value.__name__}()"
    raise type_error(name, expected, value, remedy)


def set_fields(frozen: object, **values: object) -> None:
    """Set validated fields of a frozen dataclass while it is being constructed."""
    for name, value in values.items():
        object.__setattr__(frozen, name, value)


def _range(low: float, high: float) -> str:
    if low == -math.inf and high == math.inf:
        return "a finite number"
    if high == math.inf:
        return f"a finite number of at least {low:g}"
    return f"a number from {low:g} to {high:g}"


def _named(text: str) -> Color:
    """Return the channels of a colour, from 0 to 1, by PyVista's name or by hexadecimal digits.

    Case, underscores, hyphens and spaces of a name are ignored. Digits are ``#rrggbb``, without
    the ``#``, with ``0x`` in its place, or followed by two of an opacity, which is ignored.
    """
    name = _plain(text)
    digits = _OTHERS.get(name, name.lstrip("#").removeprefix("0x"))
    if name not in _OTHERS and (spelled := _names().get(name)) is not None:
        from vtkmodules.vtkCommonColor import vtkNamedColors

        red, green, blue = vtkNamedColors().GetColor3d(spelled)
        return float(red), float(green), float(blue)
    if not re.fullmatch(r"[0-9a-f]{6}([0-9a-f]{2})?", digits):
        raise ValueError(f"no colour {text!r}")
    red, green, blue = (int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4))
    return red, green, blue


def _plain(name: str) -> str:
    return re.sub("[-_ ]", "", name.lower()).replace("grey", "gray")


@functools.cache
def _names() -> dict[str, str]:
    """Return VTK's spelling of each of its names."""
    from vtkmodules.vtkCommonColor import vtkNamedColors

    return {_plain(name): name for name in vtkNamedColors().GetColorNames().split("\n")}
