"""Statements of a compiled kernel: formulas written out, and vector algebra unrolled."""

from __future__ import annotations

import ast
import inspect
from functools import cache
from typing import TYPE_CHECKING

from vizlight.model import formulas
from vizlight.shading.form import BITS

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vizlight.shading.form import Form


@cache
def functions() -> dict[str, ast.FunctionDef]:
    """Return the syntax trees of the formulas by name."""
    tree = ast.parse(inspect.getsource(formulas))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


_OPERATORS: dict[type[ast.operator], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
}  # fmt: skip


class Statements:
    """Lines of a loop's body, with names that are given once."""

    def __init__(self, form: Form) -> None:
        self.form = form
        self.lines: list[str] = []
        self.indent = "        "
        self.numbers: list[str] = []
        self.wide: list[str] = []
        self.hoisted: dict[str, str] = {}
        #: Squared lengths by their type, since they were last checked.
        self.squares: dict[str, list[str]] = {}
        #: First part of the names of a power's bits, where it is an integer.
        self.whole = ""
        #: Numbers of the lights of the loop that is being written.
        self.looped: range | None = None
        self.constants: dict[float, str] = {}
        self.count = 0

    def name(self, value: str) -> str:
        """Assign an expression to a new name."""
        if value.isidentifier():
            return value
        self.count += 1
        self.lines.append(f"{self.indent}v{self.count} = {value}")
        return f"v{self.count}"

    def constant(self, value: float) -> str:
        """Return the name of a typed constant."""
        return self.constants.setdefault(value, f"C{len(self.constants)}")

    def number(self, name: str) -> str:
        """Return the name of a number that the kernel is given, in the type of the work."""
        return self._given(name, self.numbers, "numbers")

    def wide_number(self, name: str) -> str:
        """Return the name of a number that the kernel is given in float64."""
        return self._given(name, self.wide, "wide")

    def _given(self, name: str, listed: list[str], array: str) -> str:
        inner = name.startswith("light.") and self.looped
        names = [name.replace("light.", f"light{i}.") for i in inner] if inner else [name]
        if names[0] not in listed:
            listed += names
        place = listed.index(names[0])
        if inner:
            return self.name(f"{array}[{place} + m]")
        self.hoisted[f"{array}[{place}]"] = f"{array[0]}{place}"
        return f"{array[0]}{place}"

    def call(self, function: str, *arguments: str) -> str:
        """Write a formula out and return the name of its value."""
        node = functions()[function]
        names = dict(zip((a.arg for a in node.args.args), arguments, strict=True))
        for statement in node.body:
            if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
                names[statement.targets[0].id] = self.name(self.expression(statement.value, names))
            elif isinstance(statement, ast.Return) and statement.value is not None:
                return self.name(self.expression(statement.value, names))
        raise AssertionError(function)

    def expression(self, node: ast.expr, names: dict[str, str]) -> str:
        """Return an expression of a formula, with names and constants replaced."""
        match node:
            case ast.BinOp(left=left, op=op, right=right):
                a, b = self.expression(left, names), self.expression(right, names)
                return f"({a} {_OPERATORS[type(op)]} {b})"
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=float(value))):
                return self.constant(-value)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return f"(-{self.expression(operand, names)})"
            case ast.Constant(value=float(value)):
                return self.constant(value)
            case ast.Name(id=name):
                return names[name]
            case ast.Call(func=ast.Name(id="where"), args=[ast.Compare() as test, yes, no]):
                sign = ">" if isinstance(test.ops[0], ast.Gt) else "<"
                a, b = (
                    self.expression(test.left, names),
                    self.expression(test.comparators[0], names),
                )
                chosen = [self.name(self.expression(x, names)) for x in (yes, no)]
                return self.name(f"{chosen[0]} if {a} {sign} {b} else {chosen[1]}")
            case ast.Call(func=ast.Name(id="only"), args=[test, value]):
                kept = ast.Call(ast.Name("where"), [test, value, ast.Constant(0.0)], [])
                return self.expression(kept, names)
            case ast.Call(func=ast.Name(id=name), args=args):
                return self.primitive(name, [self.name(self.expression(a, names)) for a in args])
        raise AssertionError(ast.dump(node))

    def primitive(self, name: str, args: Sequence[str]) -> str:
        """Return a call of what the language gives, or a formula written out."""
        if name == "power" and self.whole:
            # Each bit of the power takes a factor in, or 1: one code for all integers.
            x, value = args[0], ""
            for bit in range(BITS):
                x = self.name(f"{x} * {x}") if bit else x
                given = f"{self.whole}{bit}"
                factor = self.name(f"{self.number(given)} * {x} + {self.number(f'{given}not')}")
                value = self.name(f"{value} * {factor}") if bit else factor
            return value
        if name == "power":
            x, deficit, exponent = args
            zero, one = self.constant(0.0), self.constant(1.0)
            least = self.name(f"{zero} if {exponent} > {zero} else {one}")
            raised = self.name(f"exp_({exponent} * log_({x}, {deficit}))")
            return self.name(f"{raised} if {x} > {zero} else {least}")
        if name in ("maximum", "minimum"):
            a, b = args
            return self.name(f"{a} if {a} {'>' if name == 'maximum' else '<'} {b} else {b}")
        if name in ("absolute", "exp", "arctan2"):
            function = {"absolute": "abs", "exp": "exp_", "arctan2": "arctan2_"}[name]
            return f"{function}({', '.join(args)})"
        return self.call(name, *args)

    def load(self, array: str, count: int, offset: int = 0, stride: int = 0) -> list[str]:
        """Return the names of the components of row i of a flat array."""
        names = [f"{array}[{stride or count} * i + {offset + c}]" for c in range(count)]
        return [self.name(f"F({name})" if self.form.work == "f8" else name) for name in names]

    def dot(self, a: Sequence[str], b: Sequence[str]) -> str:
        """Return the dot product of two vectors."""
        return self.name(" + ".join(f"{x} * {y}" for x, y in zip(a, b, strict=True)))

    def unit(self, v: Sequence[str], kind: str) -> tuple[list[str], str]:
        """Return a unit vector in the type of its array and its length, and note its square."""
        kind = max(kind, self.form.work)
        square = self.dot(v, v)
        self.squares.setdefault(kind, []).append(square)
        inverse = self.name(f"{self.constant(1.0)} / sqrt({square})")
        return [self.name(f"{x} * {inverse}") for x in v], self.name(f"{square} * {inverse}")

    def check(self) -> None:
        """Mark the point if a square is out of range: least too small or sum too large."""
        for kind, squares in self.squares.items():
            least = squares[0]
            for square in squares[1:]:
                least = self.name(f"{least} if {least} < {square} else {square}")
            limit = kind if kind == self.form.work else f"{kind}_of_{self.form.work}"
            good = f"({least} > LEAST_{limit}) & ({' + '.join(squares)} < MOST_{limit})"
            self.lines.append(f"{self.indent}odd = odd | (not ({good}))")
        self.squares = {}

    def cast(self, v: Iterable[str]) -> list[str]:
        """Return numbers in the type of the work."""
        return [self.name(f"F({x})") for x in v]

    def reject(self, x: list[str], rows: Sequence[Sequence[str]]) -> list[str]:
        """Return the part of a vector across some rows."""
        for row in rows:
            along = self.dot(row, x)
            x = [self.name(f"{a} - {along} * {b}") for a, b in zip(x, row, strict=True)]
        return x

    def frame(self, array: str, k: int, kind: str) -> list[list[str]]:
        """Return orthonormal rows that span the tangents of row i."""
        n, rows = self.form.n, list[list[str]]()
        for a in range(k):
            row, _ = self.unit(self.load(array, n, a * n, k * n), kind)
            if a:
                row = self.reject(row, rows)
                row, size = self.unit(row, kind)
                # Near the limit of a dependent vector NumPy decides.
                self.lines.append(f"{self.indent}odd = odd | (not {size} > {self.number('rank')})")
                row, _ = self.unit(self.reject(row, rows), kind)
            rows.append(row)
        return [self.cast(row) for row in rows]

    def split(self, x: list[str], rows: list[list[str]]) -> tuple[list[str], list[str], str]:
        """Return tangential coefficients, normal part and its length."""
        along = [self.dot(row, x) for row in rows]
        for a, row in zip(along, rows, strict=True):
            x = [self.name(f"{p} - {a} * {q}") for p, q in zip(x, row, strict=True)]
        return along, x, self.name(f"sqrt({self.dot(x, x)})")

    def toward(self, place: list[str], near: bool, given: str) -> tuple[list[str], str]:
        """Return the unit direction from a point toward what is given, and the distance."""
        if not near:
            return [self.number(f"{given}{c}") for c in range(self.form.n)], ""
        form = self.form
        if form.points == form.work == "f4":
            v = [
                self.name(f"({self.number(f'{given}{c}')} - {p}) + {self.number(f'{given}low{c}')}")
                for c, p in enumerate(place)
            ]
            kind = "f4"
        else:
            v = [self.name(f"{self.wide_number(f'{given}{c}')} - {p}") for c, p in enumerate(place)]
            kind = "f8"
        direction, distance = self.unit(v, kind)
        return self.cast(direction), self.name(f"F({distance})")
