"""Options of a filter on the command line, made of what the filter's source declares.

The source is read without an import: a filter loads PyVista, which takes longer than the help of a
command.
"""

from __future__ import annotations

import ast
import functools
import inspect
import re
from dataclasses import field, fields, make_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, Union, get_type_hints

from cyclopts import App, Group, Parameter

from vizlight import _words
from vizlight._version import __version__
from vizlight._words import message
from vizlight.cli.arguments import fraction, numbers, plane

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vizlight._types import Foreign, Keywords

    #: What a name of a module stands for: a function, a value, or a module and a name there.
    Meaning = ast.AST | tuple[str, str]

#: Words that ask for help.
HELP = frozenset({"--help", "-h"})
app = App(
    name="vizlight",
    help="Light that makes scientific data legible.",
    # Markdown takes longer to load than all of NumPy, and no text of the help has marks.
    help_format="plaintext",
    help_flags=sorted(HELP),
    version=__version__,
    result_action="return_value",
    suppress_keyboard_interrupt=False,
)
ROOT = Path(__file__).parents[1]
#: Types that text can be read as, by their names in annotations, beside those that are choices. A
#: filter's option that has none of them is left to scripts.
TYPES: Mapping[str, type] = {"bool": bool, "int": int, "float": float, "str": str}
#: Keywords of filters that are not options of what they make.
NOT_OPTIONS = ("scene", "inplace", "progress_bar")
#: Number of letters of a description that is shortened.
SHORTEST, LENGTH = 10, 64


def _levels(name: str, text: str) -> object:
    """Return a number of steps, an allowed error, or the luminance of each contour."""
    if text.isdecimal():
        return int(text)
    values = numbers(text, range(2, 10_000))
    return list(values) if values else fraction(name, text)


def _rotations(name: str, texts: list[str]) -> object:
    """Return turns PLANE:ANGLE as pairs."""
    found = []
    for text in texts:
        turned, colon, angle = text.partition(":")
        if not colon:
            expected = "PLANE:ANGLE with the angle in radians, such as xw:0.3"
            raise ValueError(message(f"--{name}", expected, repr(text)))
        found.append((turned, fraction(name, angle)))
    return found


def _name_or_vector(_: str, text: str) -> object:
    return numbers(text) or text


#: Options whose text is read in a way of its own: type, reader, and description.
READ: Mapping[str, tuple[object, Callable[[str, Foreign], object], str]] = {
    "levels": (
        str | None,
        _levels,
        "Number of steps (8), largest error (0.02) or values (0.2,0.4,0.6).",
    ),
    "feature_angle": (
        str | None,
        functools.partial(fraction, expected="an angle in degrees, or auto", word="auto"),
        "Angle in degrees above which edges are sharp, auto for creases.",
    ),
    "exponent": (
        str | None,
        functools.partial(fraction, expected="compensated, or a number", word="compensated"),
        "Exponent of the diffuse term: compensated, or a number: 1, 2.",
    ),
    "facing": (
        str,
        lambda _, text: text.replace("-", " "),
        "Side that is lit: auto, eye, outward or as-given.",
    ),
    "toward": (
        str | None,
        _name_or_vector,
        "Direction x,y,z to which fibres bend, or name of an array.",
    ),
    "up": (
        str | None,
        _name_or_vector,
        "Direction x,y,z of the sky's half space. Default: all round.",
    ),
    "hyperplane": (
        str | None,
        functools.partial(
            plane, counts=range(3, 100), expected="NORMAL:OFFSET, such as 0,0,0,1:0.2"
        ),
        "Hyperplane NORMAL:OFFSET that cuts the mesh: 0,0,0,1:0.2.",
    ),
    "rotation": (
        list[str] | None,
        _rotations,
        "Turn PLANE:ANGLE in radians, such as xw:0.5.",
    ),
}


def keywords(how: Foreign) -> Keywords:
    """Return the options of a filter that differ from their defaults, by the filter's names."""
    found: Keywords = {}
    for one in fields(how):
        value, name = getattr(how, one.name), one.metadata["name"]
        if value != one.default or type(value) is not type(one.default):
            _, read, _ = READ.get(name, (None, None, None))
            found[name] = read(one.name.replace("_", "-"), value) if read else value
    return found


def words(*parts: Foreign) -> list[str]:
    """Return the words of a command that give options of dataclasses the values that they have."""
    found = []
    for part in parts:
        for one in fields(part):
            value, flag = getattr(part, one.name), one.name.replace("_", "-")
            if value == one.default or value is None:
                continue
            if isinstance(value, bool):
                found.append(f"--{flag}" if value else f"--no-{flag}")
                continue
            # A value that begins with a minus is one word with its option.
            rows = value if isinstance(value, list | tuple) else [value]
            found += [f"--{flag}={row}" for row in rows]
    return found


def takes(
    filter_: str, group: str, *, example: str, without: tuple[str, ...] = (), **renamed: str
) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Let a command take the options of a filter as ``how``, and groups of others by their class.

    Parameters
    ----------
    filter_ : str
        Name of a public filter, whose signature and documentation list its options.
    group : str
        Heading of the filter's options in the help.
    example : str
        Words of a call that the help ends with.
    without : tuple of str
        Options that are left to scripts.
    **renamed : str
        Other names of options on the command line.
    """

    def decorate(command: Callable[..., int]) -> Callable[..., int]:
        own = arguments_of(filter_, without=without, renamed=renamed)
        Parameter(name="*", group=Group(group, sort_key=1))(own)
        command.__annotations__["how"] = own
        types, signature = get_type_hints(command), inspect.signature(command)
        command.__kwdefaults__ = {
            name: types[name]() if one.default is one.empty else one.default
            for name, one in signature.parameters.items()
            if one.kind is one.KEYWORD_ONLY
        }
        name = command.__name__
        return app.command(
            command,
            usage=f"Usage: vizlight {name} FILES [OPTIONS]",
            help_epilogue=f"Example: vizlight {name} {example}",
        )

    return decorate


def arguments_of(
    filter_: str, *, without: tuple[str, ...] = (), renamed: Mapping[str, str] | None = None
) -> type:
    """Return a class of the options of a filter, each with the first clause on it; see takes."""
    module = f"vizlight.filters.{filter_}"
    node, texts = _function(module, filter_)
    made: list[tuple[str, object, object]] = []
    for argument, value in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True):
        name = argument.arg
        text_type = _type(name, argument.annotation, module)
        if text_type is None or value is None or name in (*NOT_OPTIONS, *without):
            continue
        constant: Foreign = _find(module, value.id) if isinstance(value, ast.Name) else value
        default = ast.literal_eval(constant)
        shown = Parameter(
            help=first_clause(_text(name, texts)),
            negative=() if default is False or name == "rotation" else None,
            show_default=bool(default) and not isinstance(default, bool),
            allow_leading_hyphen=name in READ,
        )
        own = field(default=default, metadata={"name": name})
        made.append(((renamed or {}).get(name, name), Annotated[text_type, shown], own))
    kind = make_dataclass("Arguments", made, frozen=True, kw_only=True)
    # Cyclopts looks for descriptions in the source of the module of a class; this one has none.
    kind.__module__ = __package__ or __name__
    return kind


@functools.cache
def _names(module: str) -> dict[str, Meaning]:
    """Return what the names of a module stand for, none for a module of another package."""
    path = ROOT.joinpath(*module.split(".")[1:])
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    found: dict[str, Meaning] = {}
    if not (module.startswith("vizlight.") and path.is_file()):
        return found
    body = ast.parse(path.read_text(encoding="utf-8")).body
    # What stands below ``if`` is for types alone.
    for node in (
        *body,
        *(one for outer in body if isinstance(outer, ast.If) for one in outer.body),
    ):
        if isinstance(node, ast.FunctionDef):
            found.setdefault(node.name, node)
        elif isinstance(node, ast.Assign):
            found.setdefault(ast.unparse(node.targets[0]), node.value)
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                found.setdefault(alias.asname or alias.name, (str(node.module), alias.name))
    return found


def _find(module: str, name: str) -> ast.AST | None:
    """Return what a name of a module, which may import it from another, stands for."""
    found = _names(module).get(name)
    return _find(*found) if isinstance(found, tuple) else found


def _function(module: str, name: str) -> tuple[ast.FunctionDef, dict[str, str]]:
    """Return a function, and the description of its parameters."""
    node = _find(module, name)
    assert isinstance(node, ast.FunctionDef)
    return node, _words.parameters(ast.get_docstring(node))


def _type(name: str, annotation: ast.expr | None, module: str) -> object | None:
    """Return the type of an option on the command line, None where text cannot give it."""
    if name in READ:
        return READ[name][0]
    names = ast.unparse(annotation).split(" | ") if annotation else []
    parts = [TYPES.get(one) or _choices(one, module) for one in names]
    parts = [part for part in parts if part is not None]
    if bool in parts:
        # A flag; the name of an array in its place is left to scripts.
        parts = [bool]
    return Union[(*parts, *([None] * ("None" in names)))] if parts else None


def _choices(name: str, module: str) -> object | None:
    """Return the type ``Literal`` that a name in an annotation stands for, or None."""
    found = _find(module, name)
    if isinstance(found, ast.Subscript) and ast.unparse(found.value) == "Literal":
        return Literal[ast.literal_eval(found.slice)]
    return None


def _text(name: str, texts: Mapping[str, str]) -> str:
    """Return the description of an option; one that refers to another function is taken there."""
    if name in READ:
        return READ[name][2]
    names = [*texts]
    at = names.index(name) if name in texts else 0
    # An entry of several options stands at the first of them.
    entry = next((texts[each] for each in reversed(names[: at + 1]) if texts[each]), "")
    elsewhere = re.search(r"[Aa]s for\s:\w+:`~?vizlight\.([\w.]+)`", entry)
    if elsewhere:
        module, _, function = elsewhere[1].rpartition(".")
        _, there = _function(f"vizlight.{module or f'filters.{function}'}", function)
        entry = there.get(name, "") or entry
    text = " ".join(entry.partition("\n")[2].split()).replace("``", "")
    return re.sub(r":\w+:`~?(?:[\w.]+\.)?(\w+)`", r"\1", text)


def first_clause(text: str) -> str:
    """Return the first sentence, or as much of it as fits a line and ends where a clause does."""
    sentence = re.split(r"(?<=\S[.;])\s(?=[A-Z0-9\"])", text)[0].rstrip(".")
    ends = []
    for found in re.finditer(
        r"[:;] |, (?=which|such|see|or its|before|in )| \((?=[A-Z])", sentence
    ):
        before = sentence[: found.start()]
        if all(before.count(a) == before.count(b) for a, b in ("()", "{}", "[]")):
            ends.append(found.start())
    ends = [end for end in ends if end >= SHORTEST]
    short = [end for end in ends if end <= LENGTH]
    if len(sentence) > LENGTH and ends:
        sentence = sentence[: max(short, default=min(ends))]
    return f"{sentence}."
