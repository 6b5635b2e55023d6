"""Options of the command line: their groups, the readers of their text, and those of a filter.

Those of a filter follow the signature in its source. The source is read without an import: a
filter loads PyVista, which takes longer than the help of a command.
"""

from __future__ import annotations

import ast
import functools
import inspect
import re
from dataclasses import dataclass, field, fields, make_dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, Union, get_type_hints

from cyclopts import App, Group, Parameter

from vizlight import _words
from vizlight._questions import QUESTIONS
from vizlight._version import __version__
from vizlight._words import AXES, numbers, value_error

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vizlight._types import Foreign, Keywords

    #: What a name of a module stands for: a function, a value, or a module and a name there.
    Meaning = ast.AST | tuple[str, str]


Backend = Literal["egl", "osmesa"]
if TYPE_CHECKING:
    Question = str
else:
    Question = Literal[(*QUESTIONS, "relief")]
Flag = Annotated[bool, Parameter(negative=(), show_default=False)]
Text = Annotated[str, Parameter(allow_leading_hyphen=True)]
Texts = Annotated[list[str], Parameter(allow_leading_hyphen=True, negative=())]
Overlays = Annotated[list[Path], Parameter(negative=())]
Outputs = Annotated[list[Path], Parameter(name=["--output", "-o"], negative=())]

#: Headings of the help in their order; second stand the options of a filter.
GROUPS = {
    name: Group(name, sort_key=place)
    for place, name in enumerate(
        ("What is lit", "", "Light", "Material", "Camera", "Output", "Pieces")
    )
}


@Parameter(name="*", group=GROUPS["What is lit"])
@dataclass(frozen=True, kw_only=True)
class FilePart:
    """Part of a file.

    Parameters
    ----------
    time
        Time of the step, or its index; first, or last, the default.
    times
        Steps one by one, or of a movie: all, or indices FIRST:END or FIRST:END:STEP.
    overlay
        File with values for the points of a surface of a brain.
    at
        Place NAME=VALUE along another axis of a grid: number=3.
    nodata
        Value of a grid that stands for none; nan for no such value.
    clip
        Plane NORMAL:OFFSET beyond which is cut away: 0,0,1:5 or z:5.
    threshold
        Range NAME:LOW:HIGH of an array that is kept; an end may be empty.
    contour
        Point array of the isosurface that is taken.
    level
        Value of the isosurface. Default: where the values are steepest.
    """

    time: Text | None = None
    times: Text | None = None
    overlay: Overlays | None = None
    at: Texts | None = None
    nodata: float | None = None
    clip: Texts | None = None
    threshold: Texts | None = None
    contour: str | None = None
    level: float | None = None


@dataclass(frozen=True, kw_only=True)
class SurfacePart(FilePart):
    """Surface of a file.

    Parameters
    ----------
    slice
        Plane NORMAL:OFFSET of the section that is taken.
    warp
        Point array by which points are moved: heights, or vectors.
    exaggeration
        Factor of heights. Default: one that shows them, which is printed.
    globe
        Show a map of the whole earth on a ball.
    """

    slice: Text | None = None
    warp: str | None = None
    exaggeration: float | None = None
    globe: Flag = False


@dataclass(frozen=True, kw_only=True)
class Target(SurfacePart):
    """Lit part of a file.

    Parameters
    ----------
    surface
        Take the outer surface; otherwise light all points.
    """

    surface: bool = True


@Parameter(name="*", group=GROUPS["Light"])
@dataclass(frozen=True, kw_only=True)
class Lights:
    """Lights.

    Parameters
    ----------
    question
        Question that the light answers, with its key.
    key
        Draw the key of the colours and of the light beside the picture.
    light
        Direction x,y,z to a far light, or azimuth,altitude in degrees.
    light_position
        Position x,y,z of a light.
    headlight
        Add a light that follows the view.
    depth_cue
        Fade to half with depth.
    scene
        JSON file of Scene.to_dict(); other options replace its values.
    """

    question: Annotated[Question | None, Parameter(name="--for")] = None
    key: bool = True
    light: Texts | None = None
    light_position: Texts | None = None
    headlight: Flag = False
    depth_cue: Flag = False
    scene: Path | None = None


@Parameter(name="*", group=GROUPS["Material"])
@dataclass(frozen=True, kw_only=True)
class Finish:
    """Material.

    Parameters
    ----------
    ambient
        Coefficient of the ambient term. Default: 0.3; of fur 0.4.
    diffuse
        Coefficient of the diffuse term. Default: 0.7; of fur 2.
    specular
        Coefficient of the specular term. Default: 0; of fur 0.3.
    shininess
        Power of the specular term. Default: 20.
    color
        Name of a colour, or #rrggbb, in plain light.
    """

    ambient: float | None = None
    diffuse: float | None = None
    specular: float | None = None
    shininess: float | None = None
    color: str | None = None


@Parameter(name="*", group=GROUPS["Camera"])
@dataclass(frozen=True, kw_only=True)
class CameraOptions:
    """Camera.

    Parameters
    ----------
    view
        Eye: front, back, left, right, top, bottom, iso, or several; x,y,z; a JSON file.
    up
        Direction x,y,z that is up, or x, y or z. Default: z, or y seen along z.
    parallel
        Parallel projection.
    zoom
        Magnification; 2 shows half the width.
    """

    view: Text | None = None
    up: Text | None = None
    parallel: Flag = False
    zoom: float = 1.0


@Parameter(name="*", group=GROUPS["Output"])
@dataclass(frozen=True, kw_only=True)
class Output:
    """Files and printed text.

    Parameters
    ----------
    output
        File .png .svg .pdf .html .mp4 .glb .vtp .vtu .vtk .vts .vti .vtr .vtm, or a folder.
    paraview
        Script .py that shows it in ParaView, lit in each fragment, and a .vtp beside it.
    size
        Width and height of the picture in pixels.
    style
        House style: paper, on white, or dark.
    background
        Colour behind the mesh. Default: that of the style.
    line_width
        Width of lines in pixels.
    title
        Words above the picture, in place of those of the data.
    frames
        Frames of a movie that turns. Default: 120.
    fps
        Frames, or steps of a series, per second of a movie.
    map_parts
        Parts of a map: coasts,frame,isolines or none. Default: by the data.
    backend
        Library that draws. Default: egl.
    report
        Print the cost, and the error of a sample lit again in float64.
    progress
        Show a progress bar.
    script
        Print the Python script that does the same, and do nothing else.
    """

    output: Outputs | None = None
    paraview: Path | None = None
    size: str = "1200x800"
    style: Literal["paper", "dark"] = "paper"
    background: str | None = None
    line_width: float = 1.0
    title: Text | None = None
    frames: int | None = None
    fps: float | None = None
    map_parts: str | None = None
    backend: Backend | None = None
    report: Flag = False
    progress: Flag = False
    script: Flag = False


@Parameter(name="*", group=GROUPS["Output"])
@dataclass(frozen=True, kw_only=True)
class Color:
    """Colour of a picture by data.

    Parameters
    ----------
    array
        Array that the picture is about; it chooses the drawing. U,V joins components.
    scalars
        Array that only colours the drawing; or direction, for lines.
    cmap
        Name of the colour map.
    """

    array: str | None = None
    scalars: str | None = None
    cmap: str | None = None


@Parameter(name="*", group=GROUPS["Pieces"])
@dataclass(frozen=True, kw_only=True)
class Pieces:
    """Data in pieces, for an output .pvtp, .pvtu, .pvti, .pvtr or .pvts.

    Parameters
    ----------
    workers
        Number of processes. Default: 1, this one.
    scheduler
        Address of a scheduler of Dask with the workers that light the pieces.
    slab
        Largest size in MB of a slab of a structured grid. Default: 64.
    """

    workers: int | None = None
    scheduler: str | None = None
    slab: float | None = None


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class Common:
    """Options of every command that lights files."""

    lights: Lights = Lights()
    finish: Finish = Finish()
    eye: CameraOptions = CameraOptions()
    out: Output = Output()


def vector(name: str, text: str, *, n: int = 3, direction: bool = True) -> tuple[float, ...]:
    """Return a vector x,y,z, with zeros for missing components up to n.

    A direction is not zero, and may be the name of an axis; one toward a light may be
    azimuth,altitude in degrees.
    """
    by_angles = name == "light"
    axis = AXES.get(text, ()) if direction else ()
    values = axis or numbers(text, (3, n, 2) if by_angles else (3, n))
    if not values:
        expected = "three numbers x,y,z" + f" or {n} numbers" * (n != 3)
        expected += ", or azimuth,altitude in degrees" * by_angles
        raise value_error(f"--{name}", expected, repr(text))
    if len(values) == 2:
        from vizlight.geometry.relief import sun

        values = tuple(sun.toward(*values).round(15).tolist())
    if direction and not any(values):
        raise value_error(f"--{name}", "a direction x,y,z, not all zero", repr(text))
    return values + (0.0,) * (n - len(values))


def hyperplane(name: str, text: str) -> tuple[tuple[float, ...], float]:
    """Return a normal of n-space and the distance of the hyperplane from the origin along it."""
    normal, _, offset = text.rpartition(":")
    values, distance = numbers(normal, range(3, 100)), numbers(offset, (1,))
    if not (any(values) and distance):
        raise value_error(f"--{name}", "NORMAL:OFFSET, such as 0,0,0,1:0.2", repr(text))
    return values, distance[0]


def place(name: str, text: str) -> tuple[str, float | str]:
    """Return the name of an axis and a value along it."""
    axis, _, value = text.partition("=")
    if not (axis and value):
        raise value_error(f"--{name}", "the name of an axis, = and a value", repr(text))
    number = numbers(value, (1,))
    # A whole number can be an index.
    return axis, (int(number[0]) if number[0].is_integer() else number[0]) if number else value


def fraction(
    name: str,
    text: str,
    expected: str = "a number or a fraction such as 1/255",
    word: str | None = None,
) -> float | str:
    """Return a number that may be written as a fraction, or the one word that may stand for it."""
    if text == word:
        return text
    try:
        return float(Fraction(text))
    except (ValueError, ZeroDivisionError) as error:
        raise value_error(f"--{name}", expected, repr(text)) from error


def pixels(text: str) -> tuple[int, int]:
    """Return the width and the height of a picture."""
    from vizlight.draw import render

    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise value_error("--size", "WIDTHxHEIGHT in pixels", repr(text))
    columns, rows = render.pixels_of((int(width), int(height)))
    return columns, rows


#: Words that ask for help.
HELP = frozenset({"--help", "-h"})
app = App(
    name="vizlight",
    help="Light that makes scientific data legible. vizlight FILE shows what is in a file.",
    usage="Usage: vizlight FILE [OPTIONS]\n       vizlight COMMAND FILE [OPTIONS]",
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
#: Keywords of filters that are not options of their results.
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
    turns = []
    for text in texts:
        turned, colon, angle = text.partition(":")
        if not colon:
            expected = "PLANE:ANGLE with the angle in radians, such as xw:0.3"
            raise value_error(f"--{name}", expected, repr(text))
        turns.append((turned, fraction(name, angle)))
    return turns


def _name_or_vector(_: str, text: str) -> object:
    return numbers(text) or text


#: Options whose text is read in a way of its own: type, reader, and description.
READ: Mapping[str, tuple[object, Callable[[str, Foreign], object], str]] = {
    "tangents": (str | None, lambda _, text: text, "Name of the vectors, or U,V for components."),
    "levels": (str | None, _levels,
        "Number of steps (8), largest error (0.02) or values (0.2,0.4,0.6)."),
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
    "facing": (str, lambda _, text: text.replace("-", " "),
        "Side that is lit: auto, eye, outward or as-given."),
    "toward": (str | None, _name_or_vector,
        "Direction x,y,z to which fibres bend, or name of an array."),
    "up": (str | None, _name_or_vector,
        "Direction x,y,z of the sky's half space. Default: all round."),
    "hyperplane": (str | None, hyperplane,
        "Hyperplane NORMAL:OFFSET that cuts the mesh: 0,0,0,1:0.2."),
    "rotation": (list[str] | None, _rotations, "Turn PLANE:ANGLE in radians, such as xw:0.5."),
}  # fmt: skip


def keywords(how: Foreign) -> Keywords:
    """Return the options of a filter that differ from their defaults, by the filter's names."""
    values: Keywords = {}
    for option in fields(how):
        value, name = getattr(how, option.name), option.metadata["name"]
        # In Python 1, 1.0 and True are equal, but not the same option.
        if value != option.default or type(value) is not type(option.default):
            _, read, _ = READ.get(name, (None, None, None))
            values[name] = read(option.name.replace("_", "-"), value) if read else value
    return values


def words(*parts: Foreign) -> list[str]:
    """Return the words of a command that give options of dataclasses the values that they have."""
    texts = []
    for part in parts:
        for option in fields(part):
            value, flag = getattr(part, option.name), option.name.replace("_", "-")
            if value == option.default or value is None:
                continue
            if isinstance(value, bool):
                texts.append(f"--{flag}" if value else f"--no-{flag}")
                continue
            # A value that begins with a minus is one word with its option.
            rows = value if isinstance(value, list | tuple) else [value]
            texts += [f"--{flag}={row}" for row in rows]
    return texts


def takes(
    filter_: str, group: str, *, example: str, without: tuple[str, ...] = (), **renamed: str
) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Let a command take the options of a filter as ``how``, and groups of others by their class.

    ``group`` is the heading of the filter's options in the help, which ends with the ``example`` of
    a call; options of ``without`` are left to scripts, and ``renamed`` has other names of options.
    """

    def decorate(command: Callable[..., int]) -> Callable[..., int]:
        _LATER[command.__name__] = functools.partial(add, command)
        return command

    def add(command: Callable[..., int]) -> None:
        arguments = arguments_of(filter_, without=without, renamed=renamed)
        Parameter(name="*", group=Group(group, sort_key=1))(arguments)
        # Cyclopts reads the annotations, and this class was made just now.
        command.__annotations__["how"] = arguments
        types, signature = get_type_hints(command), inspect.signature(command)
        # A group without a given option has its defaults.
        command.__kwdefaults__ = {
            name: types[name]() if parameter.default is parameter.empty else parameter.default
            for name, parameter in signature.parameters.items()
            if parameter.kind is parameter.KEYWORD_ONLY
        }
        name = command.__name__
        app.command(
            command,
            usage=f"Usage: vizlight {name} FILES [OPTIONS]",
            help_epilogue=f"Example: vizlight {name} {example}",
        )

    return decorate


#: Functions that add the commands that are not in the app yet: options take time to find.
_LATER: dict[str, Callable[[], None]] = {}


def is_command(word: str) -> bool:
    """Return whether a word is the name of a command."""
    return word in _LATER or word in app


def add_commands(word: str) -> None:
    """Add to the app the command that a word names; all commands if it names none."""
    is_there = word in app and not word.startswith("-")
    for name in [word] if word in _LATER else [] if is_there else [*_LATER]:
        _LATER.pop(name)()


def arguments_of(
    filter_: str, *, without: tuple[str, ...] = (), renamed: Mapping[str, str] | None = None
) -> type:
    """Return a class of the options of a filter, each with the first clause on it; see takes."""
    module = f"vizlight.filters.{filter_}"
    node, texts = _function(module, filter_)
    options: list[tuple[str, object, object]] = []
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
        entry = field(default=default, metadata={"name": name})
        options.append(((renamed or {}).get(name, name), Annotated[text_type, shown], entry))
    kind = make_dataclass("Arguments", options, frozen=True, kw_only=True)
    # Cyclopts looks for descriptions in the source of the module of a class; this one has none.
    kind.__module__ = __package__ or __name__
    return kind


@functools.cache
def _names(module: str) -> dict[str, Meaning]:
    """Return the meanings of the names of a module, none for a module of another package."""
    path = ROOT.joinpath(*module.split(".")[1:])
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    meanings: dict[str, Meaning] = {}
    if not (module.startswith("vizlight.") and path.is_file()):
        return meanings
    body = ast.parse(path.read_text(encoding="utf-8")).body
    # Names below ``if`` are for types alone.
    for node in (
        *body,
        *(inner for outer in body if isinstance(outer, ast.If) for inner in outer.body),
    ):
        if isinstance(node, ast.FunctionDef):
            meanings.setdefault(node.name, node)
        elif isinstance(node, ast.Assign):
            meanings.setdefault(ast.unparse(node.targets[0]), node.value)
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                meanings.setdefault(alias.asname or alias.name, (str(node.module), alias.name))
    return meanings


def _find(module: str, name: str) -> ast.AST | None:
    """Return the meaning of a name of a module, which may import it from another."""
    meaning = _names(module).get(name)
    return _find(*meaning) if isinstance(meaning, tuple) else meaning


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
    parts = [TYPES.get(word) or _choices(word, module) for word in names]
    parts = [part for part in parts if part is not None]
    if bool in parts:
        # A flag; the name of an array in its place is left to scripts.
        parts = [bool]
    return Union[(*parts, *([None] * ("None" in names)))] if parts else None


def _choices(name: str, module: str) -> object | None:
    """Return the type ``Literal`` that a name in an annotation stands for, or None."""
    meaning = _find(module, name)
    if isinstance(meaning, ast.Subscript) and ast.unparse(meaning.value) == "Literal":
        return Literal[ast.literal_eval(meaning.slice)]
    return None


def _text(name: str, texts: Mapping[str, str]) -> str:
    """Return the description of an option; one that refers to another function is taken from it."""
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
    for match in re.finditer(
        r"[:;] |, (?=which|such|see|or its|before|in )| \((?=[A-Z])", sentence
    ):
        before = sentence[: match.start()]
        # No clause ends within brackets.
        if all(before.count(a) == before.count(b) for a, b in ("()", "{}", "[]")):
            ends.append(match.start())
    ends = [end for end in ends if end >= SHORTEST]
    short = [end for end in ends if end <= LENGTH]
    if len(sentence) > LENGTH and ends:
        sentence = sentence[: max(short, default=min(ends))]
    return f"{sentence}."
