"""Arguments of the command line: groups of options, and how their text is read."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Group, Parameter

from vizlight._words import message

if TYPE_CHECKING:
    from collections.abc import Container

Backend = Literal["egl", "osmesa"]
Question = Literal["direction", "slope", "heading", "shape", "value"]
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
class Part:
    """Part of a file.

    Parameters
    ----------
    time
        Time of the step that is taken, or its index; first or last, the default.
    times
        Steps that are lit one by one: all, or indices FIRST:END or FIRST:END:STEP.
    overlay
        File with values for the points of a surface of a brain.
    clip
        Plane NORMAL:OFFSET beyond which is cut away: 0,0,1:5 or z:5.
    threshold
        Range NAME:LOW:HIGH of an array that is kept; an end may be empty.
    contour
        Point array whose isosurface is taken.
    level
        Value of the isosurface. Default: the middle of the range.
    """

    time: Text | None = None
    times: str | None = None
    overlay: Overlays | None = None
    clip: Texts | None = None
    threshold: Texts | None = None
    contour: str | None = None
    level: float | None = None


@dataclass(frozen=True, kw_only=True)
class Shape(Part):
    """Surface of a file.

    Parameters
    ----------
    slice
        Plane NORMAL:OFFSET whose section is taken.
    warp
        Point array by which points are moved: heights, or vectors.
    exaggeration
        Factor of heights. Default: one that shows them, which is printed.
    """

    slice: Text | None = None
    warp: str | None = None
    exaggeration: float | None = None


@dataclass(frozen=True, kw_only=True)
class Target(Shape):
    """What of a file is lit.

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
        Light for one question, with its key: direction, slope, heading, shape or value.
    key
        Draw the key of --for into the picture.
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
        Name of a colour, or #rrggbb, for a picture in colour.
    """

    ambient: float | None = None
    diffuse: float | None = None
    specular: float | None = None
    shininess: float | None = None
    color: str | None = None


@Parameter(name="*", group=GROUPS["Camera"])
@dataclass(frozen=True, kw_only=True)
class Eye:
    """Camera.

    Parameters
    ----------
    view
        Direction x,y,z to the eye, or a JSON file of a camera position. Default: 1,1,1.
    up
        Direction x,y,z that is up in the picture, or x, y or z. Default: z, or y seen along z.
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
    """Files and what is printed.

    Parameters
    ----------
    output
        File .png .html .glb .vtp .vtu .vtk .vts .vti .vtr .vtm, or a folder.
    paraview
        Script .py that shows it in ParaView, lit in each fragment, and a .vtp beside it.
    size
        Width and height of the picture in pixels.
    background
        Colour behind the mesh. Default: white, or black behind lines and points.
    line_width
        Width of lines in pixels.
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
    background: str | None = None
    line_width: float = 1.0
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
    scalars
        Array that colours the picture, times the light; or direction, for lines.
    cmap
        Name of the colour map of --scalars.
    """

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
        Address of a scheduler of Dask, whose workers light the pieces.
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
    eye: Eye = Eye()
    out: Output = Output()


def numbers(text: str, counts: Container[int] = (3,)) -> tuple[float, ...]:
    """Return numbers separated by commas, none where the text is not that."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        return ()
    return values if len(values) in counts and all(map(math.isfinite, values)) else ()


#: Directions by the names of axes.
_AXES = {
    f"{sign}{axis}": ",".join(f"{sign}1" if axis == own else "0" for own in "xyz")
    for sign in ("", "-")
    for axis in "xyz"
}


def vector(name: str, text: str, *, n: int = 3, direction: bool = True) -> tuple[float, ...]:
    """Return a vector x,y,z, with zeros for what it lacks of n components.

    A direction is not zero, and may be the name of an axis; one toward a light may be
    azimuth,altitude in degrees.
    """
    text = _AXES.get(text, text) if direction else text
    by_angles = name == "light"
    values = numbers(text, (3, n, 2) if by_angles else (3, n))
    if not values:
        expected = "three numbers x,y,z" + f" or {n} numbers" * (n != 3)
        expected += ", or azimuth,altitude in degrees" * by_angles
        raise ValueError(message(f"--{name}", expected, repr(text)))
    if len(values) == 2:
        from vizlight.geometry.relief import sun

        values = tuple(sun.toward(*values).round(15).tolist())
    if direction and not any(values):
        raise ValueError(message(f"--{name}", "a direction x,y,z, not all zero", repr(text)))
    return values + (0.0,) * (n - len(values))


def plane(
    name: str,
    text: str,
    *,
    counts: Container[int] = (3,),
    expected: str = "NORMAL:OFFSET, 3 numbers and one, such as 0,0,1:2.5 or z:2.5",
) -> tuple[tuple[float, ...], float]:
    """Return a normal and the distance of the plane from the origin along it."""
    normal, _, offset = text.rpartition(":")
    values = numbers(_AXES.get(normal.lower(), normal), counts)
    distance = numbers(offset, (1,))
    if not (any(values) and distance):
        raise ValueError(message(f"--{name}", expected, repr(text)))
    return values, distance[0]


def interval(name: str, text: str) -> tuple[str, float, float]:
    """Return the name of an array and the ends of a range, infinite where one is empty."""
    array, *ends = text.rsplit(":", 2)
    found = [
        numbers(end, (1,)) if end else (empty,)
        for end, empty in zip(ends, (-math.inf, math.inf), strict=False)
    ]
    if len(found) == 2 and all(found):
        low, high = found[0][0], found[1][0]
        if low <= high and any(ends):
            return array, low, high
    expected = "NAME:LOW:HIGH, such as Temp:300:600 or Temp:300:"
    raise ValueError(message(f"--{name}", expected, repr(text)))


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
        raise ValueError(message(f"--{name}", expected, repr(text))) from error


def pixels(text: str) -> tuple[int, int]:
    """Return the width and the height of a picture."""
    from vizlight.draw import render

    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise ValueError(message("--size", "WIDTHxHEIGHT in pixels", repr(text)))
    columns, rows = render.pixels_of((int(width), int(height)))
    return columns, rows
