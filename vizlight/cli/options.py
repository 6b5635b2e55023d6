"""Options of a filter on the command line, derived from the filter's own signature."""

from __future__ import annotations

import inspect
import re
from dataclasses import field, fields, make_dataclass
from typing import TYPE_CHECKING, Annotated, Union

from cyclopts import Group, Parameter

from vizlight._words import message
from vizlight.cli import declared
from vizlight.cli.arguments import fraction, numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import ParamSpec

    from vizlight._types import Foreign, Keywords

    P = ParamSpec("P")

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
    values = numbers(text, tuple(range(2, 10_000)))
    return list(values) if values else fraction(name, text)


def _name_or_vector(_: str, text: str) -> object:
    return numbers(text) or text


def _facing(_: str, text: str) -> object:
    return text.replace("-", " ")


def _angle(name: str, text: str) -> object:
    return text if text == "auto" else fraction(name, text, "an angle in degrees, or auto")


def _rotations(name: str, texts: list[str]) -> object:
    """Return turns PLANE:ANGLE as pairs."""
    found = []
    for text in texts:
        plane, colon, angle = text.partition(":")
        if not colon:
            expected = "PLANE:ANGLE with the angle in radians, such as xw:0.3"
            raise ValueError(message(f"--{name}", expected, repr(text)))
        found.append((plane, fraction(name, angle)))
    return found


def _hyperplane(name: str, text: str) -> object:
    """Return a normal of any number of components and an offset."""
    normal, _, offset = text.rpartition(":")
    values, distance = numbers(normal, tuple(range(3, 100))), numbers(offset, (1,))
    if not (any(values) and distance):
        expected = "NORMAL:OFFSET, such as 0,0,0,1:0.2"
        raise ValueError(message(f"--{name}", expected, repr(text)))
    return values, distance[0]


def _exponent(name: str, text: str) -> object:
    return text if text == "compensated" else fraction(name, text, "compensated, or a number")


#: Options whose text is read in a way of its own, and its description.
READ: Mapping[str, tuple[Callable[[str, str], object], str]] = {
    "levels": (_levels, "Number of steps (8), largest error (0.02) or values (0.2,0.4,0.6)."),
    "feature_angle": (
        _angle,
        "Angle in degrees above which edges are sharp, auto for creases.",
    ),
    "exponent": (_exponent, "Exponent of the diffuse term: compensated, or a number: 1, 2."),
    "facing": (_facing, "Side that is lit: auto, eye, outward or as-given."),
    "toward": (_name_or_vector, "Direction x,y,z to which fibres bend, or name of an array."),
    "up": (
        _name_or_vector,
        "Direction x,y,z of the sky's half space. Default: all round.",
    ),
    "hyperplane": (_hyperplane, "Hyperplane NORMAL:OFFSET that cuts the mesh: 0,0,0,1:0.2."),
}
READ_LISTS: Mapping[str, tuple[Callable[[str, list[str]], object], str]] = {
    "rotation": (_rotations, "Turn PLANE:ANGLE in radians, such as xw:0.5."),
}


def words(*parts: Foreign) -> list[str]:
    """Return the words of a command that give options of dataclasses the values that they have."""
    found = []
    for part in parts:
        for one in fields(part) if part is not None else ():
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


def arguments_of(
    filter_: str,
    *,
    without: tuple[str, ...] = (),
    renamed: Mapping[str, str] | None = None,
) -> type:
    """Return a class of the options of a filter, each with the first clause on it.

    Parameters
    ----------
    filter_ : str
        Name of a public filter, whose signature and documentation list its options.
    without : tuple of str
        Options that are left to scripts.
    renamed : dict of str to str, optional
        Other names of options on the command line.
    """
    found = declared.filter_(filter_)
    made: list[tuple[str, object, object]] = []
    for name, option in found.options.items():
        text_type = _type(name, option)
        if text_type is None or name in (*NOT_OPTIONS, *without):
            continue
        default = option.default
        shown = Parameter(
            help=first_clause(_text(name, found.texts)),
            negative=() if default is False or name in READ_LISTS else None,
            show_default=bool(default) and not isinstance(default, bool),
            allow_leading_hyphen=name in READ,
        )
        made.append(
            (
                (renamed or {}).get(name, name),
                Annotated[text_type, shown],
                field() if option.required else field(default=default),
            )
        )
    kind = make_dataclass("Arguments", made, frozen=True, kw_only=True)
    # Cyclopts looks for descriptions in the source of the module of a class; this one has none.
    kind.__module__ = __package__ or __name__
    return kind


def keywords(arguments: object, renamed: Mapping[str, str] | None = None) -> Keywords:
    """Return the options that differ from their defaults, by the filter's names."""
    if arguments is None:
        return {}
    names = {new: old for old, new in (renamed or {}).items()}
    found: Keywords = {}
    for shown, parameter in inspect.signature(type(arguments)).parameters.items():
        name, value = names.get(shown, shown), getattr(arguments, shown)
        if value != parameter.default or type(value) is not type(parameter.default):
            option = shown.replace("_", "-")
            if name in READ:
                value = READ[name][0](option, value)
            elif name in READ_LISTS:
                value = READ_LISTS[name][0](option, value)
            found[name] = value
    return found


def _type(name: str, option: declared.Option) -> object | None:
    """Return the type of an option on the command line, None where text cannot give it."""
    if name in READ_LISTS:
        return list[str] | None
    if name in READ:
        return str if option.annotation == "Facing" else str | None
    words = option.annotation.split(" | ")
    parts = [TYPES.get(word) or declared.choices(option, word) for word in words]
    parts = [part for part in parts if part is not None]
    if bool in parts:
        # A flag; the name of an array in its place is left to scripts.
        parts = [bool]
    optional = [None] if "None" in words else []
    return Union[(*parts, *optional)] if parts else None


def _text(name: str, texts: Mapping[str, str]) -> str:
    """Return the description of an option; one that refers to another function is taken there."""
    if name in READ:
        return READ[name][1]
    if name in READ_LISTS:
        return READ_LISTS[name][1]
    names = [*texts]
    at = names.index(name) if name in texts else 0
    # An entry of several options stands at the first of them.
    entry = next((texts[each] for each in reversed(names[: at + 1]) if texts[each]), "")
    text, elsewhere = _flat(entry), re.search(r"[Aa]s for\s:\w+:`~?vizlight\.([\w.]+)`", entry)
    if not elsewhere:
        return text
    module, _, function = elsewhere[1].rpartition(".")
    there = (
        declared.function(f"vizlight.{module}", function) if module else declared.filter_(function)
    )
    return _flat(there.texts.get(name, "")) or text


def _flat(entry: str) -> str:
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


def takes(
    filter_: str,
    group: str,
    *,
    without: tuple[str, ...] = (),
    renamed: Mapping[str, str] | None = None,
) -> Callable[[Callable[P, int]], Callable[P, int]]:
    """Let a command take the options of a filter as its argument ``how``; see arguments_of."""

    def decorate(command: Callable[P, int]) -> Callable[P, int]:
        kind = arguments_of(filter_, without=without, renamed=renamed)
        place = Group(group, sort_key=1)
        command.__annotations__["how"] = Annotated[kind, Parameter(name="*", group=place)]
        return command

    return decorate
