"""The text of a compiled kernel: a loop over points that holds the terms of one form and no others.

The optics come from :mod:`vizlight.shading.formulas`, written out statement by statement; vector
algebra is unrolled for n components and k tangents. Arrays are flat, constants have the type of the
work, sums keep their order.
"""

from __future__ import annotations

import ast
import inspect
from functools import cache, lru_cache
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from vizlight.shading import formulas

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

#: Up to this many lights are written out; more are grouped by kind, each kind in a loop.
UNROLLED = 4
#: Bits of the powers that are computed by multiplication.
BITS = 6


class LightForm(NamedTuple):
    """Kind of a light: near or at infinity, with attenuation or not, and its highlight.

    ``whole`` says that the highlight is an integer power below 2^BITS.
    """

    near: bool
    faded: bool
    highlight: str
    whole: bool


class Form(NamedTuple):
    """What the text of a kernel depends on; types are "f4", "f8", or empty for what is not read."""

    work: str
    n: int
    k: int
    base: int
    points: str
    tangents: str
    normals: str
    base_tangents: str
    surface: bool
    cylinder: bool
    two_sided: bool
    terminator: bool
    conditioned: bool
    shadowed: bool
    fur: bool
    diffuse: str
    based: str
    specular: bool
    eye: str
    splits_eye: bool
    cue: str
    axis: bool
    tinted: bool
    colored: bool
    components: bool
    lights: tuple[LightForm, ...]


class Text(NamedTuple):
    """Text of a kernel, and the names of its numbers: of the work's type, and of float64."""

    source: str
    numbers: tuple[str, ...]
    wide: tuple[str, ...]


#: Parameters of a kernel.
ARRAYS = (
    "points", "tangents", "normals", "base_tangents", "shadow", "height", "numbers", "wide",
    "table", "luminance", "diffuse", "specular", "rgb",
)  # fmt: skip

#: Elementary functions: exp of numbers of 0 or less, log of x where d = 1 - x is known, arctan2 of
#: y of 0 or more, and the table of the cylinder's integral. Polynomials are those of Cephes.
PRELUDE = """
def log_(x, d):
    bits = F(x).view(I)
    e = I((bits - ROOT) >> MANTISSA)
    m = I(bits - I(e << MANTISSA)).view(F)
    g = -d if e == I(0) else m - F(1)
    z = g * g
    ef = F(e)
{log}
    y = y + ef * LN2_LOW
    y = y - F(0.5) * z
    return (g + y) + ef * LN2_HIGH

def exp_(x):
    x = x if x > LOWEST else LOWEST
    t = x * LOG2_E + MAGIC
    e = I(F(t).view(I) - MAGIC_BITS)
    t = t - MAGIC
    r = x - t * LN2_HIGH
    r = r - t * LN2_LOW
    z = r * r
{exp}
    return I(F(y).view(I) + I(e << MANTISSA)).view(F)

def arctan2_(y, x):
    u = abs(x)
    big = u if u > y else y
    small = y if u > y else u
    t = small / (big if big > F(0) else F(1))
    far = t > F(0.4142135623730950)
    v = (t - F(1)) / (t + F(1)) if far else t
    z = v * v
{arctan}
    a = (F(0.7853981633974483) + p) if far else p
    a = F(1.5707963267948966) - a if y > u else a
    return F(3.141592653589793) - a if x < F(0) else a

def integral_(z, table, cells, scale):
    count = I(cells)
    place = abs(z) * scale
    place = place if place < cells else cells
    cell = I(place)
    cell = cell if cell < count else count - I(1)
    u = place - F(cell)
    v = table[I(5) * count + cell]
    v = v * u + table[I(4) * count + cell]
    v = v * u + table[I(3) * count + cell]
    v = v * u + table[I(2) * count + cell]
    v = v * u + table[count + cell]
    v = v * u + table[cell]
    return -v if z < F(0) else v
"""
HELPERS = ("log_", "exp_", "arctan2_", "integral_")


def _horner(name: str, coefficients: Iterable[float], variable: str, *, monic: bool = False) -> str:
    """Return the lines that evaluate a polynomial, highest power first."""
    first, *rest = coefficients
    lines = [f"    {name} = {variable} + F({first!r})" if monic else f"    {name} = F({first!r})"]
    lines += [f"    {name} = {name} * {variable} + F({c!r})" for c in rest]
    return "\n".join(lines)


def _prelude(work: str) -> str:
    """Return the head of a kernel's text: types, constants and elementary functions."""
    if work == "f4":
        log = _horner("y", (
            7.0376836292e-2, -1.1514610310e-1, 1.1676998740e-1, -1.2420140846e-1, 1.4249322787e-1,
            -1.6668057665e-1, 2.0000714765e-1, -2.4999993993e-1, 3.3333331174e-1,
        ), "g")  # fmt: skip
        log += "\n    y = y * g * z"
        exp = _horner("y", (
            1.9875691500e-4, 1.3981999507e-3, 8.3334519073e-3, 4.1665795894e-2, 1.6666665459e-1,
            5.0000001201e-1,
        ), "r")  # fmt: skip
        exp += "\n    y = y * z + r + F(1)"
        arctan = _horner("p", (
            8.05374449538e-2, -1.38776856032e-1, 1.99777106478e-1, -3.33329491539e-1,
        ), "z")  # fmt: skip
        arctan += "\n    p = p * z * v + v"
        kinds = "F, I, MANTISSA = np.float32, np.int32, np.int32(23)"
        low, magic = -87.0, 12582912.0
        second = -2.12194440e-4
    else:
        log = _horner("p", (
            1.01875663804580931796e-4, 4.97494994976747001425e-1, 4.70579119878881725854,
            1.44989225341610930846e1, 1.79368678507819816313e1, 7.70838733755885391666,
        ), "g")  # fmt: skip
        log += "\n" + _horner("q", (
            1.12873587189167450590e1, 4.52279145837532221105e1, 8.29875266912776603211e1,
            7.11544750618563894466e1, 2.31251620126765340583e1,
        ), "g", monic=True)  # fmt: skip
        log += "\n    y = g * (z * p / q)"
        exp = _horner("p", (
            1.26177193074810590878e-4, 3.02994407707441961300e-2, 9.99999999999999999910e-1,
        ), "z")  # fmt: skip
        exp += "\n    p = p * r\n" + _horner("q", (
            3.00198505138664455042e-6, 2.52448340349684104192e-3, 2.27265548208155028766e-1,
            2.00000000000000000009,
        ), "z")  # fmt: skip
        exp += "\n    y = F(1) + F(2) * (p / (q - p))"
        arctan = _horner("p", (
            -8.750608600031904122785e-1, -1.615753718733365076637e1, -7.500855792314704667340e1,
            -1.228866684490136173410e2, -6.485021904942025371773e1,
        ), "z")  # fmt: skip
        arctan += "\n" + _horner("q", (
            2.485846490142306297962e1, 1.650270098316988542046e2, 4.328810604912902668951e2,
            4.853903996359136964868e2, 1.945506571482613964425e2,
        ), "z", monic=True)  # fmt: skip
        arctan += "\n    p = v * (z * p / q) + v"
        kinds = "F, I, MANTISSA = np.float64, np.int64, np.int64(52)"
        low, magic = -708.0, 6755399441055744.0
        second = -2.121944400546905827679e-4
    constants = f"""
import numpy as np
{kinds}
ROOT, MAGIC = F(0.7071067811865476).view(I), F({magic!r})
MAGIC_BITS, LOWEST, LOG2_E = MAGIC.view(I), F({low!r}), F(1.4426950408889634)
LN2_HIGH, LN2_LOW = F(0.693359375), F({second!r})
LEAST_f4 = np.finfo(np.float32).tiny / np.finfo(np.float32).eps
LEAST_f8 = np.finfo(np.float64).tiny / np.finfo(np.float64).eps
MOST_f4, MOST_f8 = np.finfo(np.float32).max, np.finfo(np.float64).max
LOST = F(np.nan)
"""
    return constants + PRELUDE.format(log=log, exp=exp, arctan=arctan)


@cache
def _functions() -> dict[str, ast.FunctionDef]:
    """Return the syntax trees of the formulas by name."""
    tree = ast.parse(inspect.getsource(formulas))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


_OPERATORS: dict[type[ast.operator], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
}  # fmt: skip


class _Writer:
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
        node = _functions()[function]
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
            good = f"({least} > LEAST_{kind}) & ({' + '.join(squares)} < MOST_{kind})"
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


class _Sight(NamedTuple):
    """The eye at a point: its direction and how the manifold splits it."""

    vector: list[str]
    along: list[str]
    rest: list[str]
    size: str
    path: str


class _Body:
    """The terms of a point, in the order in which the engine's NumPy code has them."""

    def __init__(self, form: Form) -> None:
        self.form, self.w = form, _Writer(form)
        self.normal: list[str] = []
        self.rows: list[list[str]] = []
        self.sheet: list[list[str]] = []
        self.place: list[str] = []
        self.height = ""

    def write(self) -> None:
        form, w = self.form, self.w
        if form.normals:
            self.normal = w.cast(w.unit(w.load("normals", form.n), form.normals)[0])
        if form.base_tangents:
            self.sheet = w.frame("base_tangents", form.base, form.base_tangents)
        if form.tangents:
            self.rows = w.frame("tangents", form.k, form.tangents)
        if form.points:
            self.place = w.load("points", form.n)
        sight = self.look()
        zero = w.constant(0.0)
        for name in self.sums():
            w.lines.append(f"{w.indent}{name} = {zero}")
        if len(form.lights) <= UNROLLED:
            for number, light in enumerate(form.lights):
                self.light(light, f"light{number}.", sight, str(number))
        else:
            self.loops(sight)
        self.store()

    def sums(self) -> list[str]:
        """Return the names of the sums over lights."""
        form = self.form
        terms = [t for t, there in (("d", form.diffuse), ("s", form.specular)) if there]
        return [t + c for t in terms for c in (("", "0", "1", "2") if form.tinted else ("",))]

    def loops(self, sight: _Sight) -> None:
        """Write one loop for each kind of light; the lights come sorted by kind."""
        w, start = self.w, 0
        for kind, group in groupby(self.form.lights):
            w.looped = range(start, start + len(list(group)))
            w.check()
            w.lines.append(f"{w.indent}for m in range({len(w.looped)}):")
            w.indent += "    "
            self.light(kind, "light.", sight, f"({start} + m)")
            w.check()
            w.indent = w.indent[:-4]
            start = w.looped.stop
        w.looped = None

    def look(self) -> _Sight:
        form, w = self.form, self.w
        if not form.eye:
            return _Sight([], [], [], "", "")
        vector, _ = w.toward(self.place, form.eye == "near", "eye")
        along, rest, size, path = list[str](), list[str](), "", ""
        if form.splits_eye and self.rows:
            along, rest, size = w.split(vector, self.rows)
        elif form.splits_eye:
            size = w.dot(self.normal, vector)
        if form.fur:
            self.height = w.name("height[i]")
            w.lines.append(f"{w.indent}odd = odd | (not {self.height} >= {w.constant(0.0)})")
            sine = w.name(f"abs({w.dot(self.normal, vector)})")
            path = w.call("fur_path", self.height, sine)
        return _Sight(vector, along, rest, size, path)

    def side(self, cosine: str) -> str:
        return self.w.call("both_sides" if self.form.two_sided else "one_side", cosine)

    def light(self, kind: LightForm, given: str, sight: _Sight, column: str) -> None:
        """Add the light of one light to the sums."""
        form, w = self.form, self.w
        vector, distance = w.toward(self.place, kind.near, given)
        scale = w.number(f"{given}intensity")
        if kind.faded:
            c = [w.number(f"{given}c{i}") for i in range(3)]
            scale = w.name(f"{scale} * {w.call('attenuation', distance, *c)}")
        along, rest, size = list[str](), list[str](), ""
        if self.rows:
            along, rest, size = w.split(vector, self.rows)
        cosine = w.dot(self.normal, vector) if self.normal else ""
        passed = ""
        if form.shadowed:
            passed = w.name(f"shadow[{len(form.lights)} * i + {column}]")
            w.lines.append(f"{w.indent}odd = odd | (not {passed} >= {w.constant(0.0)})")
        if form.conditioned:
            scale = w.name(f"{scale} * {passed or self.side(cosine)}")
        if form.fur:
            path = w.call("fur_path", self.height, w.name(f"abs({cosine})"))
            both = w.name(f"{path} + {sight.path}")
            scale = w.name(f"{scale} * {w.call('fur_passes', both, w.number('rate'))}")
        if self.sheet:
            coefficients, _, across = w.split(vector, self.sheet)
            based = self.power(form.based, across, coefficients, "base_exponent")
            scale = w.name(f"{scale} * {based}")
        split = _Sight(vector, along, rest, size or cosine, "")
        met = self.meet(split, sight) if form.cylinder else []
        if form.diffuse:
            self.add("d", w.name(f"{self.diffuse(split, met, passed)} * {scale}"), given)
        if form.specular:
            w.whole = f"{given}bit" if kind.whole else ""
            value = self.specular(kind, split, sight, met, given)
            w.whole = ""
            if form.surface:
                value = self.cut(value, cosine, passed)
            self.add("s", w.name(f"{value} * {scale}"), given)

    def add(self, term: str, value: str, given: str) -> None:
        w = self.w
        w.lines.append(f"{w.indent}{term} = {term} + {value}")
        if self.form.tinted:
            for c in range(3):
                tint = w.number(f"{given}color{c}")
                w.lines.append(f"{w.indent}{term}{c} = {term}{c} + {tint} * {value}")

    def power(self, how: str, size: str, along: list[str], exponent: str) -> str:
        """Return |wi_N| to a power."""
        if how == "plain":
            return size
        w = self.w
        return w.call("diffuse", size, w.dot(along, along), w.number(exponent))

    def diffuse(self, split: _Sight, met: list[str], passed: str) -> str:
        form, w = self.form, self.w
        if form.cylinder:
            return w.call("cylinder_diffuse", *met, w.number("least"))
        if not form.surface:
            return self.power(form.diffuse, split.size, split.along, "exponent")
        if passed:
            return passed
        side = self.side(split.size)
        if form.diffuse == "plain":
            return side
        return w.call("surface_diffuse", side, w.number("exponent"))

    def meet(self, lit: _Sight, eye: _Sight) -> list[str]:
        """Return |wi_N|, |wo_N|, wi_N . wo_N and |wi_N x wo_N| of a line."""
        w, t = self.w, self.rows[0]
        a, b = lit.rest, eye.rest
        terms = [
            f"({a[i]} * {b[j]} - {a[j]} * {b[i]}) * {t[c]}"
            for c, (i, j) in enumerate(((1, 2), (2, 0), (0, 1)))
        ]
        return [lit.size, eye.size, w.dot(a, b), w.name(f"abs({' + '.join(terms)})")]

    def specular(
        self, kind: LightForm, lit: _Sight, eye: _Sight, met: list[str], given: str
    ) -> str:
        form, w = self.form, self.w
        shininess = w.number(f"{given}shininess")
        if kind.highlight == "half":
            half = [w.number(f"{given}half{c}") for c in range(form.n)]
            if not form.surface:
                along = [w.dot(row, half) for row in self.rows]
                return w.call("blinn_of_unit", w.dot(along, along), shininess)
            cosine = w.dot(self.normal, half)
            rest = w.reject(half, [self.normal])
            value = w.call("blinn_of_unit", w.dot(rest, rest), shininess)
            return value if form.two_sided else w.call("lit_highlight", value, cosine)
        if form.surface or kind.highlight == "blinn":
            half = [w.name(f"{a} + {b}") for a, b in zip(lit.vector, eye.vector, strict=True)]
            if form.surface:
                up = w.dot(self.normal, half)
                rest = [w.name(f"{h} - {up} * {m}") for h, m in zip(half, self.normal, strict=True)]
                tangential = w.dot(rest, rest)
                if kind.highlight == "phong":
                    sides = [lit.size, eye.size]
                    if form.two_sided:
                        sides = [self.side(x) for x in sides]
                    return w.call("phong", tangential, *sides, shininess)
                up = self.side(up)
                return w.call("blinn", tangential, w.name(f"{up} * {up}"), shininess)
            along, rest, _ = w.split(half, self.rows)
            return w.call("blinn", w.dot(along, along), w.dot(rest, rest), shininess)
        sums = [w.name(f"{a} + {b}") for a, b in zip(lit.along, eye.along, strict=True)]
        tangential = w.dot(sums, sums)
        if kind.highlight == "phong":
            return w.call("phong", tangential, lit.size, eye.size, shininess)
        return self.cylinder(lit, eye, met, tangential, shininess)

    def cylinder(
        self, lit: _Sight, eye: _Sight, met: list[str], tangential: str, shininess: str
    ) -> str:
        """Return Blinn's highlight averaged over the visible half of a thin cylinder."""
        w = self.w
        a, b, _, cross = met
        whole = [w.name(f"{p} + {q}") for p, q in zip(lit.rest, eye.rest, strict=True)]
        square = w.dot(whole, whole)
        normal = w.name(f"sqrt({square})")
        value = w.call("blinn", tangential, square, shininess)
        to_eye, to_light = w.name(f"{b} * {normal}"), w.name(f"{a} * {normal}")
        cos_b = w.call("cylinder_cosine", w.dot(eye.rest, whole), to_eye)
        cos_c = w.call("cylinder_cosine", w.dot(lit.rest, whole), to_light)
        sin_b = w.call("cylinder_sine", cross, to_eye)
        sin_c = w.call("cylinder_sine", cross, to_light)
        table = f"table, {w.number('cells')}, {w.number('per_cell')}"
        both = w.name(f"integral_({cos_b}, {table}) + integral_({cos_c}, {table})")
        ends = w.call("cylinder_ends", sin_b, sin_c, shininess)
        return w.call(
            "cylinder_specular", value, cos_b, both, ends, a, b, normal, w.number("least"),
            w.number("end_on"),
        )  # fmt: skip

    def cut(self, value: str, cosine: str, passed: str) -> str:
        """Remove the highlight of a surface where the light does not reach it."""
        form, w = self.form, self.w
        if form.terminator and not form.two_sided:
            value = w.call("faded_highlight", value, cosine, w.number("terminator"))
        elif not form.two_sided:
            value = w.call("lit_highlight", value, cosine)
        return w.call("shadowed_highlight", value, passed, self.side(cosine)) if passed else value

    def store(self) -> None:
        """Multiply the sums by the material, fade them with depth, write them to the output."""
        form, w = self.form, self.w
        zero = w.constant(0.0)
        fade = self.fade() if form.cue else ""
        w.check()
        d, s = "d" if form.diffuse else zero, "s" if form.specular else zero
        kd, ks = w.number("kd"), w.number("ks")
        light = w.call("luminance", w.number("ambient"), kd, d, ks, s)
        if fade:
            light = w.call("depth_cue", light, fade, w.number("cue"))
        put = [f"luminance[i] = LOST if odd else {light}"]
        if form.components:
            put += [f"diffuse[i] = {kd} * {d}", f"specular[i] = {ks} * {s}"]
        if form.colored:
            for c in range(3):
                tint = str(c) if form.tinted else ""
                color = w.call(
                    "luminance",
                    w.number(f"ambient{c}"),
                    w.number(f"kd{c}"),
                    f"d{tint}" if form.diffuse else zero,
                    w.number(f"ks{c}"),
                    f"s{tint}" if form.specular else zero,
                )
                if fade:
                    color = w.call("depth_cue", color, fade, w.number(f"cue{c}"))
                put.append(f"rgb[3 * i + {c}] = {color}")
        w.lines += [f"{w.indent}{line}" for line in put]

    def fade(self) -> str:
        """Return the scale of the depth cue, in float64 until it is known."""
        form, w = self.form, self.w
        v = [w.name(f"{w.wide_number(f'origin{c}')} - {p}") for c, p in enumerate(self.place)]
        if form.axis:
            depth = w.dot([w.wide_number(f"axis{c}") for c in range(form.n)], v)
        else:
            depth = w.name(f"sqrt({w.dot(v, v)})")
        w.lines.append(f"{w.indent}odd = odd | (not abs({depth}) < MOST_f8)")
        ends = [w.wide_number(x) for x in ("front", "back", "front_scale", "back_scale")]
        scale = w.call(
            "smooth_depth_scale" if form.cue == "smooth" else "depth_scale", depth, *ends
        )
        return w.name(f"F({scale})")


@lru_cache(maxsize=256)
def write(form: Form) -> Text:
    """Return the text of the kernel of a form.

    Parameters
    ----------
    form : Form

    Returns
    -------
    Text
        Source of a function ``light`` of the arrays in ``ARRAYS``; it needs the name ``sqrt``. The
        luminance of points that NumPy must light is NaN: a count would halve the number of points
        in a vector.
    """
    body = _Body(form)
    body.write()
    w = body.w
    lines = [f"{name} = F({value!r})" for value, name in w.constants.items()]
    lines += ["", f"def light({', '.join(ARRAYS)}):"]
    lines += [f"    {name} = {place}" for place, name in w.hoisted.items()]
    lines += [
        "    for i in range(luminance.shape[0]):",
        "        odd = False",
        "        void = False",
    ]
    source = _prelude(form.work) + "\n".join([*lines, *w.lines, ""])
    return Text(source, tuple(w.numbers), tuple(w.wide))
