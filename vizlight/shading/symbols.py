"""Symbols stand for numbers and vectors where the terms leave a program behind.

NumPy's functions and operators accept a symbol (NEP 13), so that the terms and the formulas need no
second notation: each operation is written down as a statement, and its result is a new symbol.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Protocol

from vizlight._types import Value
from vizlight.shading.algebra import Algebra
from vizlight.shading.plan import Plan

if TYPE_CHECKING:
    import numpy as np

_SIGNS = {
    "add": "+", "subtract": "-", "multiply": "*", "divide": "/", "true_divide": "/",
    "gt": ">", "ge": ">=", "lt": "<", "le": "<=",
}  # fmt: skip
_TESTS = (">", ">=", "<", "<=")


class Symbol:
    """A name or an expression in a program, of a kind such as "float" or "bool"."""

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


class Components(tuple[Symbol, ...]):
    """A vector as the symbols of its components."""

    __slots__ = ()

    def each(self, sign: str, other: Value, *, turned: bool) -> Components:
        """Return an operation component by component, with a number or another vector."""
        others = other if isinstance(other, Components) else [other] * len(self)
        pairs = zip(self, others, strict=True)
        return Components(
            a.writer.operation(sign, *((b, a) if turned else (a, b))) for a, b in pairs
        )


def _operator(sign: str, *, turned: bool = False) -> Callable[[Symbol | Components, Value], Value]:
    def apply(self: Symbol | Components, other: Value) -> Value:
        if isinstance(self, Components):
            return self.each(sign, other, turned=turned)
        if isinstance(other, Components):
            # Python then asks the vector, which goes component by component.
            return NotImplemented
        pair = (other, self) if turned else (self, other)
        return self.writer.operation(sign, *pair)

    return apply


for _name, _shorter in (("add", "add"), ("sub", "subtract"), ("mul", "multiply"),
                        ("truediv", "divide")):  # fmt: skip
    for _kind in (Symbol, Components):
        setattr(_kind, f"__{_name}__", _operator(_SIGNS[_shorter]))
        setattr(_kind, f"__r{_name}__", _operator(_SIGNS[_shorter], turned=True))
for _name in ("gt", "ge", "lt", "le"):
    setattr(Symbol, f"__{_name}__", _operator(_SIGNS[_name]))


class Language(Protocol):
    """The language of a program."""

    def statement(self, name: str, text: str, kind: str) -> str:
        """Return the statement that gives a name to an expression."""

    def kind(self, *args: Value) -> str:
        """Return the kind of a result of some values."""

    def literal(self, value: float, kind: str) -> str:
        """Return a number as the language writes it where another kind is met."""

    def call(self, name: str, *args: Value) -> Value:
        """Return a function of NumPy of some values."""

    def select(self, test: Symbol, yes: Value, no: Value) -> Value:
        """Return ``yes`` where a test holds, else ``no``."""

    def power(self, x: Value, deficit: Value, exponent: Value) -> Value:
        """Return a number of [0, 1] to a power."""


class Writer(Algebra, Language):
    """Writer of the statements of a program, each once."""

    #: First letters of the names of a program.
    prefix = "v"

    def __init__(self, plan: Plan) -> None:
        super().__init__(plan)
        self.lines: list[str] = []
        self.names: dict[tuple[str, str], Symbol] = {}
        self.count = 0

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
            self.count += 1
            name = f"{self.prefix}{self.count}"
            self.names[text, kind] = Symbol(self, name, kind)
            self.lines.append(self.statement(name, text, kind))
        return self.names[text, kind]

    def operation(self, sign: str, a: Value, b: Value) -> Value:
        """Write an operation of two values; factors of 1 and summands of 0 are left out."""
        if sign == "*":
            # A test times a value is the value where the test holds.
            for test, value in ((a, b), (b, a)):
                if getattr(test, "kind", "") == "bool":
                    return self.select(test, value, 0.0)
        if sign in "+*":
            for number, other in ((a, b), (b, a)):
                # The truth is the neutral number: 1 for products, 0 for sums.
                if isinstance(number, float) and number == (sign == "*"):
                    return other
        kind = self.kind(a, b)
        text = f"{self.text(a, kind)} {sign} {self.text(b, kind)}"
        return self.named(text, "bool" if sign in _TESTS else kind)

    def text(self, value: Value, kind: str) -> str:
        """Return a value as it stands in an expression of a kind."""
        return value.text if isinstance(value, Symbol) else self.literal(float(value), kind)


def needed(lines: Iterable[str], declared: str, roots: Iterable[str]) -> list[str]:
    """Return the lines that other lines need, of a program that defines each name once.

    Parameters
    ----------
    lines : iterable of str
        Statements in order.
    declared : str
        Pattern of a statement that gives a name, with the name as its group.
    roots : iterable of str
        Texts with the names that are needed.

    Returns
    -------
    list of str
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
