"""Symbols stand for numbers and vectors where the terms leave a program in GLSL behind.

NumPy's functions and operators accept a symbol (NEP 13), so that the terms and the formulas need no
second notation: each operation is written down as a statement, and its result is a new symbol.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

import numpy as np

from vizlight._types import Value
from vizlight.shading.algebra import Algebra
from vizlight.shading.plan import Plan

_SIGNS = {
    "add": "+", "subtract": "-", "multiply": "*", "divide": "/", "true_divide": "/",
    "gt": ">", "ge": ">=", "lt": "<", "le": "<=",
}  # fmt: skip
_TESTS = (">", ">=", "<", "<=")
_CALLS = {"absolute": "abs", "maximum": "max", "minimum": "min", "arctan2": "atan"}
#: Numbers beyond this are infinite in float32.
_MOST = 3e38


def number(value: float) -> str:
    """Return a number as GLSL writes it, rounded to float32's digits."""
    # Nine digits tell all numbers of float32 apart; without a point or an exponent GLSL would read
    # an integer.
    text = f"{max(min(float(value), _MOST), -_MOST):.9g}"
    return text if "." in text or "e" in text else f"{text}.0"


class Symbol:
    """A name or an expression in a program, of the kind "float", "vec3" or "bool"."""

    def __init__(self, writer: Writer, text: str, kind: str) -> None:
        self.writer, self.text, self.kind = writer, text, kind

    def __array_ufunc__(self, ufunc: np.ufunc, _: str, /, *args: Value) -> Value:
        """Write an operation of NumPy down."""
        # Symbols have no arrays: NumPy hands the call over before it would convert them.
        name = ufunc.__name__
        if name in _SIGNS:
            return self.writer.operation(_SIGNS[name], *args)
        return self.writer.call(name, *args)

    def __neg__(self) -> Value:
        return self.writer.named(f"-{self.text}", self.kind)

    def select(self, yes: Value, no: Value) -> Value:
        """Return ``yes`` where this test holds, else ``no``."""
        return self.writer.select(self, yes, no)

    def power(self, deficit: Value, exponent: Value) -> Value:
        """Return this number x of [0, 1], with 1 - x as its deficit, to a power of 0 or more."""
        return self.writer.power(self, deficit, exponent)


def _operator(sign: str, *, turned: bool = False) -> Callable[[Symbol, Value], Value]:
    def apply(self: Symbol, other: Value) -> Value:
        return self.writer.operation(sign, *((other, self) if turned else (self, other)))

    return apply


for _name, _shorter in (("add", "add"), ("sub", "subtract"), ("mul", "multiply"),
                        ("truediv", "divide")):  # fmt: skip
    setattr(Symbol, f"__{_name}__", _operator(_SIGNS[_shorter]))
    setattr(Symbol, f"__r{_name}__", _operator(_SIGNS[_shorter], turned=True))
for _name in ("gt", "ge", "lt", "le"):
    setattr(Symbol, f"__{_name}__", _operator(_SIGNS[_name]))


class Writer(Algebra):
    """Writer of the statements of a program, each once."""

    def __init__(self, plan: Plan) -> None:
        super().__init__(plan)
        self.lines: list[str] = []
        self.names: dict[tuple[str, str], Symbol] = {}

    def present(self, x: Value, distance: Value | None) -> Value:
        """Return x: points at their lamp or eye are handled at the end."""
        del distance
        return x

    def sound(self, x: Value, other: float) -> Value:
        """Return x: points without light are handled at the end."""
        del other
        return x

    def named(self, text: str, kind: str) -> Value:
        """Return the symbol of an expression, which is written once."""
        # The text of an expression tells which it is: a common part of two terms is computed once.
        if (text, kind) not in self.names:
            name = f"viz{len(self.names) + 1}"
            self.names[text, kind] = Symbol(self, name, kind)
            self.lines.append(f"  {kind} {name} = {text};")
        return self.names[text, kind]

    def kind(self, *args: Value) -> str:
        """Return "vec3" if one of the values is a vector, else "float"."""
        return "vec3" if any(getattr(a, "kind", "") == "vec3" for a in args) else "float"

    def operation(self, sign: str, a: Value, b: Value) -> Value:
        """Write an operation of two values; factors of 1 and summands of 0 are left out."""
        if sign == "*":
            # A test times a value is the value where the test holds.
            for test, value in ((a, b), (b, a)):
                if getattr(test, "kind", "") == "bool":
                    return self.select(test, value, 0.0)
        if sign in "+*":
            for neutral, other in ((a, b), (b, a)):
                # The truth is the neutral number: 1 for products, 0 for sums.
                if isinstance(neutral, float) and neutral == (sign == "*"):
                    return other
        text = f"{self.text(a)} {sign} {self.text(b)}"
        return self.named(text, "bool" if sign in _TESTS else self.kind(a, b))

    def call(self, name: str, *args: Value) -> Value:
        """Return a function of numbers or vectors."""
        # GLSL's functions take vectors and numbers alike, as NumPy's do.
        texts = ", ".join(map(self.text, args))
        return self.named(f"{_CALLS.get(name, name)}({texts})", self.kind(*args))

    def select(self, test: Symbol, yes: Value, no: Value) -> Value:
        """Return one of two values."""
        # Both sides are evaluated; a branch would cost more on most cards.
        text = f"{test.text} ? {self.text(yes)} : {self.text(no)}"
        return self.named(text, self.kind(yes, no))

    def power(self, x: Value, deficit: Value, exponent: Value) -> Value:
        """Return a number of [0, 1] to a power."""
        raise NotImplementedError

    def text(self, value: Value) -> str:
        """Return a value as it stands in an expression."""
        return value.text if isinstance(value, Symbol) else number(value)


def needed(lines: Iterable[str], declared: str, roots: Iterable[str]) -> list[str]:
    """Return the lines that other lines need, of a program that defines each name once.

    Lines are statements in order, ``declared`` is the pattern of one that gives a name, with the
    name as its group, and ``roots`` are texts with the names that are needed.
    """
    words = {word for text in roots for word in re.findall(r"\w+", text)}
    kept = []
    # From the last line up, as a line that is needed makes the names in it needed.
    for line in reversed(list(lines)):
        declaration = re.match(declared, line)
        if declaration is None or declaration[1] in words:
            kept.append(line)
            words.update(re.findall(r"\w+", line))
    return kept[::-1]
