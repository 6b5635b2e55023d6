"""Arguments of the command line: groups of options, and how their text is read."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, fields, make_dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from vizlight import _check
from vizlight.shading.options import LightOptions, Model, Precision, documented

if TYPE_CHECKING:
    from collections.abc import Mapping

Backend = Literal["egl", "osmesa"]
Vector = Annotated[str, Parameter(allow_leading_hyphen=True)]
Vectors = Annotated[list[str], Parameter(allow_leading_hyphen=True, negative=())]
Positions = Annotated[
    list[str],
    Parameter(name=["--light-position", "--lamp"], allow_leading_hyphen=True, negative=()),
]
Outputs = Annotated[list[Path], Parameter(name=["--output", "-o"], negative=())]


@dataclass(frozen=True, kw_only=True)
class Target:
    """What of a file is lit.

    Parameters
    ----------
    contour
        Point array of which an isosurface is lit; otherwise the outer surface.
    level
        Value of the isosurface. Default: the middle of the range.
    warp
        Point array by which the points of a grid are raised, such as the elevation of a terrain.
    warp_factor
        Factor of that array's values. Default: 1.
    surface
        Take the surface of a volume; --no-surface lights all its points.
    """

    contour: str | None = None
    level: float | None = None
    warp: str | None = None
    warp_factor: float | None = None
    surface: bool = True


@dataclass(frozen=True, kw_only=True)
class Lamps:
    """Lights and material.

    Parameters
    ----------
    light
        Direction x,y,z toward a light at infinity; may be repeated. Default: over the left
        shoulder of the eye.
    lamp
        Position x,y,z of a light; may be repeated.
    headlight
        Add a light that follows the view; alone it takes the place of the default light.
    ambient
        Coefficient of the ambient term.
    diffuse
        Coefficient of the diffuse term.
    specular
        Coefficient of the specular term.
    shininess
        Power of the specular term.
    color
        Name of a colour or #rrggbb; the picture is then in colour.
    depth_cue
        Fade to half with depth.
    """

    light: Vectors | None = None
    lamp: Positions | None = None
    headlight: bool = False
    ambient: float = 0.1
    diffuse: float = 0.5
    specular: float = 0.4
    shininess: float = 20.0
    color: str | None = None
    depth_cue: bool = False


@dataclass(frozen=True, kw_only=True)
class Eye:
    """Camera.

    Parameters
    ----------
    view
        Direction x,y,z from the mesh toward the eye.
    up
        Direction that is up in the picture. Default: z.
    parallel
        Parallel projection.
    zoom
        Magnification; 2 shows half the width.
    """

    view: Vector = "1,1,1"
    up: Vector | None = None
    parallel: bool = False
    zoom: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Output:
    """Files and what is printed.

    Parameters
    ----------
    output
        A file: .png for the picture; .vtp, .vtu, .vtk, .vts, .vti or .vtr for the mesh; may be
        repeated. Default: NAME-lit.vtp and NAME-lit.png here.
    size
        Width and height of the picture in pixels.
    background
        Colour behind the mesh. Default: white, or black behind lines.
    line_width
        Width of lines, in pixels of a picture of twice the size, as it is drawn.
    backend
        Library that draws: egl (the default) or osmesa.
    explain
        Print what is computed and what is skipped.
    report
        Print the cost, and the error of a sample that is lit again in float64.
    progress
        Show a progress bar.
    """

    output: Outputs | None = None
    size: str = "1200x800"
    background: str | None = None
    line_width: float = 1.0
    backend: Backend | None = None
    explain: bool = False
    report: bool = False
    progress: bool = False


#: Types of the options of light on the command line; those that are not here stay in scripts.
SHOWN: Mapping[str, object] = {
    "tangents": str | None,
    "normals": str | None,
    "average_cells": bool,
    "conditioned": bool,
    "two_sided": bool,
    "flip_normals": bool,
    "compensate": bool,
    "model": Model,
    "terminator": float,
    "highlight_error": float,
    "tolerance": str,
    "components": bool,
    "precision": Precision | None,
    "name": str,
}


def _light_arguments() -> type:
    """Return a class of the fields of LightOptions, each with the first sentence on it."""
    texts = documented(LightOptions)
    defaults = {f.name: f.default for f in fields(LightOptions)} | {"tolerance": "0"}
    lines = []
    for name in SHOWN:
        text = " ".join(texts[name].partition("\n")[2].split()).replace("``", "")
        sentence = re.split(r"(?<=[.:])\s(?=[A-Z])", text)[0].rstrip(":")
        lines += [name, f"    {sentence}"]
    made = make_dataclass(
        "LightArguments",
        [(name, kind, field(default=defaults[name])) for name, kind in SHOWN.items()],
        frozen=True,
        kw_only=True,
    )
    made.__module__ = __name__
    made.__doc__ = "\n".join(["How it is lit.", "", "Parameters", "----------", *lines])
    return made


LightArguments = _light_arguments()


def light_options(arguments: object) -> LightOptions:
    """Return the options of light from those of the command line."""
    values = {name: getattr(arguments, name) for name in SHOWN}
    return LightOptions(**values | {"tolerance": fraction("tolerance", values["tolerance"])})


def vector(name: str, text: str, *, direction: bool = True) -> tuple[float, ...]:
    """Return three numbers x,y,z; a direction is not zero."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 3:
        raise ValueError(_check.message(f"--{name}", "three numbers x,y,z", repr(text)))
    if direction and not any(values):
        raise ValueError(_check.message(f"--{name}", "a direction x,y,z, not all zero", repr(text)))
    return values


def fraction(name: str, text: str) -> float:
    """Return a number that may be written as a fraction."""
    try:
        return float(Fraction(text))
    except (ValueError, ZeroDivisionError) as error:
        expected = "a number or a fraction such as 1/255"
        raise ValueError(_check.message(f"--{name}", expected, repr(text))) from error


def pixels(text: str) -> tuple[int, int]:
    """Return the width and the height of a picture."""
    from vizlight.pictures import render

    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise ValueError(_check.message("--size", "WIDTHxHEIGHT in pixels", repr(text)))
    columns, rows = render.pixels_of((int(width), int(height)))
    return columns, rows
