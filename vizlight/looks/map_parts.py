"""Parts of a map beside its data: coasts, and a frame of degrees or a bar of lengths."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.draw import isolines as iso
from vizlight.draw import ticks
from vizlight.draw.cameras import MARGIN
from vizlight.draw.map_frames import has_bar
from vizlight.draw.margins import LETTERS
from vizlight.looks.steps import Step
from vizlight.mesh import georeference, globes, meaning
from vizlight.vtk.cells import dimensions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.wishes import Wishes

#: Parts that ``map_parts`` names.
PARTS = ("coasts", "frame", "isolines")
#: Room that a frame takes at the left and below its map, in heights of letters: that of 60°N, and
#: of a line of words; and that of a bar below them.
ROOM, BAR = (3.2, 1.5), 1.6
#: More room at the left of and below a section, for the words of its axes.
TITLES = 1.4
#: Least extent in degrees of a map with coasts, which are right to some 0.1 degrees.
COASTS = 20.0
#: Most points of a map with isolines; most levels of these, the fewer first, which are drawn where
#: more are too dense; and their letters as a share of those of the frame.
MOST_POINTS, LEVELS, SMALL = 4_000_000, (8, 16), 0.7
#: Points along a side of a map from which on it is drawn as it is, and most steps between points.
FINE, MOST_FINER = 300, 16
#: Least distance between isolines, in heights of their letters, and the length of all that are
#: looked at, in that of lines at this distance.
SPARSE, ROOMY = 1.3, 2.0
#: Standard names of arrays whose highs and lows are marked.
WITH_EXTREMES = {
    "air_pressure_at_sea_level", "air_pressure_at_mean_sea_level", "geopotential_height",
}  # fmt: skip
#: Functions that draw a map in degrees on a projection, and that put it on a ball.
CHART = "vizlight.cartography.chart"
GLOBE = "vizlight.cartography.globe"
#: Method that draws a terrain as a map.
FLAT = ".project_points_to_plane"
#: Radii of the coasts of a ball of radius 1, and of the ball that hides its far side.
ABOVE_BALL, BELOW_BALL = 1.002, 0.97


def named(parts: object) -> tuple[str, ...]:
    """Return the names of parts of a map: of a sequence, or of a text such as "coasts,frame"."""
    names = parts.split(",") if isinstance(parts, str) else parts
    names = () if isinstance(parts, str) and parts == "none" else names
    if not isinstance(names, list | tuple) or not all(name in PARTS for name in names):
        expected = f"names of {', '.join(PARTS)}, or 'none'"
        raise _check.value_error("map_parts", expected, repr(parts))
    return tuple(names)


def is_of(part: str, mesh: Step) -> bool:
    """Return whether a step makes a part of a map, or one mesh of it."""
    return any(
        isinstance(step, Step) and step.path == f"vizlight.cartography.{part}"
        for step in (mesh, *mesh.arguments[:1])
    )


def frame(mesh: Step, wishes: Wishes, up: Sequence[float]) -> Step | None:
    """Return the step that makes the frame of a map, None if it gets none."""
    if not 0 < max(mesh.run().bounds_size[:2]) < np.inf:
        return None
    keywords: dict[str, object] = {"letters": letters(mesh.run(), wishes, up)}
    if not np.allclose(up, (0, 1)):
        keywords["up"] = tuple(up)
    step = Step("frame", "vizlight.cartography.frame", mesh, **keywords)
    return step if step.run().n_cells else None


def graticule(frame: Step) -> Step | None:
    """Return the step that makes the meridians and parallels within a frame, None without any."""
    name = "vizlight.cartography.graticule"
    step = Step("graticule", name, *frame.arguments, **frame.keywords)
    return step if step.run().n_cells else None


def letters(mesh: pv.DataSet, wishes: Wishes, up: Sequence[float]) -> float:
    """Return the height of letters in the unit of a map, by which they are as large as in keys."""
    room = np.array(wishes.room) / MARGIN
    pixels = LETTERS * min(wishes.size)
    sides: Array = np.asarray(mesh.bounds_size[:2], dtype=np.float64)
    if abs(up[0]) > abs(up[1]):
        sides = sides[::-1]
    # The data and the room of the frame are to fill the picture together.
    around = np.array([ROOM[0], ROOM[1] + BAR * has_bar(mesh)])
    around += TITLES * bool(meaning.of(mesh).section)
    scale = float(np.max(sides / (room - around * pixels)))
    zoom = _check.positive("zoom", wishes.eye.get("zoom", 1.0))
    return float(f"{pixels * scale / zoom:.4g}")


def isolines(
    mesh: Step,
    array: Named,
    ends: tuple[float, float],
    letters: float,
    coasts: Step | None,
    *,
    sparse: float = SPARSE,
    always: bool = False,
    edges: Sequence[float] = (),
) -> tuple[Step, list[float], float] | None:
    """Return the step that makes the isolines of a map, their levels as written, and their unit.

    None where the field is not smooth, as few lines tell. ``ends`` are those of the values in the
    unit of the array; ``letters`` is their height in the frame, in the unit of the map, and
    ``sparse`` the least distance between lines in such heights. Numbers keep clear of the lines
    ``coasts``; with ``always`` a field that is not smooth gets a few lines too. ``edges`` are
    values in even steps at which colours change, in the unit in which they are read, of which all,
    or every second one, are the levels, by default round values.
    """
    if mesh.run().n_points > MOST_POINTS:
        return None
    size = float(f"{SMALL * letters:.4g}")
    factor, _ = meaning.usual_unit(mesh.run(), array.name, max(map(abs, ends)))
    if len(edges) > 1:
        apart = edges[1] - edges[0]
        inner = [edge for edge in edges if ends[0] < factor * edge < ends[1]]
        round_levels = [
            [edge for edge in inner if round(edge / apart) % part == 0] for part in (2, 1)
        ]
    else:
        low, high = ends[0] / factor, ends[1] / factor
        round_levels = [ticks.even_levels(low, high, most) for most in LEVELS]
    choices = [
        {float(f"{factor * level:.12g}"): level for level in levels} for levels in round_levels
    ]
    levels = np.array(sorted({*choices[0], *choices[1]}))
    # With room to spare, since isolines of some levels are longer than those of others.
    x, y, _ = mesh.run().bounds_size
    room = math.inf if always else ROOMY * x * y / (sparse * size) * len(levels) / len(choices[0])
    pieces = iso.contoured(mesh.run(), array.name, levels, longest=room)
    smooth = itertools.takewhile(
        lambda levels: iso.are_smooth(mesh.run(), pieces, levels, size, sparse=sparse), choices
    )
    shown = next(reversed([*smooth]), choices[0] if always and pieces else None)
    if shown is None:
        return None
    words = ticks.numerals_of([*shown.values()])
    keywords: Keywords = {"letters": size, "words": words}
    if coasts is not None:
        keywords["clear_of"] = coasts
    standard = meaning.of(mesh.run()).arrays.get(array.name, {}).get("standard_name", "")
    unit = factor if standard in WITH_EXTREMES else None
    if unit is not None:
        keywords["extremes"] = unit
    name = "vizlight.cartography.isolines"
    step = Step("isolines", name, mesh, array.name, [*shown], **keywords)
    # Its lines are known from the choice of levels.
    shore = None if coasts is None else coasts.run()
    text_of = dict(zip(shown, words, strict=True))
    step.hold(iso.labelled(mesh.run(), array.name, pieces, size, text_of, shore, unit))
    return step, [*shown.values()], factor


def smoothed(mesh: Step, array: Named) -> Step | None:
    """Return the step that draws a grid of few points as smooth, None for others."""
    grid = mesh.run()
    sizes = [size for size in dimensions(grid) if size > 1]
    if len(sizes) != 2 or array.name not in grid.point_data:
        return None
    factor = min(FINE // max(sizes), MOST_FINER)
    is_known = np.isfinite(grid.point_data[array.name])
    if not is_known.all() and max(sizes) <= FINE:
        # Its edge is that of areas around points.
        factor = max(factor, 2)
    if factor < 2 or not is_known.any():
        return None
    return Step("smooth", "vizlight.cartography.smoothed", mesh, array.name, factor)


def before_chart(mesh: Step) -> Step:
    """Return the step before the one that bends rows or lays a surface flat for a map, else itself.

    That is a map in degrees of which the rows are bent, or a terrain.
    """
    source = mesh.arguments[0] if mesh.path in (CHART, FLAT) else None
    if isinstance(source, Step) and mesh.path == FLAT:
        return source
    if not isinstance(source, Step) or not isinstance(mesh.run(), pv.StructuredGrid):
        return mesh
    return mesh if globes.middle_of(source.run()) is None else source


def flat(mesh: Step) -> Step | None:
    """Return the step of the map that a step has put on a ball, None for other balls."""
    source = mesh.arguments[0] if mesh.path == GLOBE else None
    return source if isinstance(source, Step) else None


def degrees(wishes: Wishes) -> float:
    """Return the height of letters on a ball in degrees at its middle, as large as in keys."""
    radius = min(wishes.room) / MARGIN / 2
    return math.degrees(LETTERS * min(wishes.size) / radius)


def curves(ball: Step, array: Named, values: Sequence[float]) -> Step:
    """Return the step that makes isolines on a ball, without numbers, which its limb would bend."""
    contour = Step("", ".contour", ball, [*values], scalars=array.name)
    return Step("isolines", ".scale", contour, ABOVE_BALL)


def shore() -> Step:
    """Return the step that makes the coasts of a globe."""
    flat = Step("", "vizlight.cartography.coasts", (-180.0, 180.0, -90.0, 90.0))
    # Sides of cells are chords of the ball, which would hide lines on it.
    return Step("coasts", ".scale", Step("", GLOBE, flat), ABOVE_BALL)


def ball() -> Step:
    """Return the step that makes the ball below a globe."""
    return Step("ball", "pyvista.Icosphere", radius=BELOW_BALL, nsub=5)


def coasts(mesh: Step, *, least: float = COASTS) -> Step | None:
    """Return the step that makes the coasts of a map in degrees, None where they show nothing.

    ``least`` is the extent in degrees of a map that gets them.
    """
    degrees = max(mesh.run().bounds_size[:2])
    if not georeference.has_degrees(mesh.run()):
        degrees *= (meaning.metres(georeference.unit_of(mesh.run())) or 0.0) / georeference.METRES
    if degrees < least:
        return None
    step = Step("coasts", "vizlight.cartography.coasts", mesh)
    return step if step.run().n_cells else None
