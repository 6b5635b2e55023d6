"""What a map has beside its data: coasts, and a frame of degrees or a bar of lengths."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.draw import isolines as iso
from vizlight.draw import legends
from vizlight.draw.cameras import MARGIN
from vizlight.draw.render import KEY_SIZE
from vizlight.looks.steps import Step
from vizlight.observers import eye

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv

    from vizlight._types import Array, Given
    from vizlight.looks.contents import Named
    from vizlight.looks.wishes import Wishes

#: Room that a frame takes at the left and below its map, in heights of letters: that of 60°N, and
#: of a line of words.
ROOM = (3.2, 1.5)
#: Least extent in degrees of a map with coasts, which are right to some 0.1 degrees.
COASTS = 20.0
#: Most points of a map with isolines, most levels of these, and their letters as a share of those
#: of the frame.
MOST_POINTS, LEVELS, SMALL = 100_000, 8, 0.75
#: Parts of a colour map that have one ink, and the lightness in CIELAB from which on it is black:
#: white lines let more of the values be read, but are not seen on pale ground.
INKS, LIGHT = 16, 75.0
#: Radii of the coasts of a ball of radius 1, and of the ball that hides its far side.
ABOVE_BALL, BELOW_BALL = 1.002, 0.97


def frame(mesh: Step, wishes: Wishes, up: Sequence[float]) -> Step | None:
    """Return the step that makes what stands around a map, None where nothing is known of it."""
    if not 0 < max(mesh.run().bounds_size[:2]) < np.inf:
        return None
    keywords: dict[str, object] = {"letters": letters(mesh.run(), wishes, up)}
    if not np.allclose(up, (0, 1)):
        keywords["up"] = tuple(up)
    step = Step("frame", "vizlight.cartography.frame", mesh, **keywords)
    return step if step.run().n_cells else None


def letters(mesh: pv.DataSet, wishes: Wishes, up: Sequence[float]) -> float:
    """Return the height of letters in the unit of a map, by which they are as large as in keys."""
    share = (1.0, 1.0)
    if wishes.picture.get("key", True):
        share = legends.data_share(wishes.size, KEY_SIZE)
    room = np.array(wishes.size) * share / MARGIN
    pixels = legends.LETTERS * min(wishes.size)
    sides: Array = np.asarray(mesh.bounds_size[:2], dtype=np.float64)
    if abs(up[0]) > abs(up[1]):
        sides = sides[::-1]
    # The data and the room of the frame are to fill the picture together.
    scale = float(np.max(sides / (room - np.array(ROOM) * pixels)))
    zoom = _check.positive("zoom", wishes.eye.get("zoom", 1.0))
    return float(f"{pixels * scale / zoom:.4g}")


def isolines(mesh: Step, array: Named, ends: tuple[float, float], letters: float) -> Step | None:
    """Return the step that makes the isolines of a map, None where its field is not smooth."""
    if mesh.run().n_points > MOST_POINTS:
        return None
    levels = [level for level, _ in legends.even_numbers(*ends, most=LEVELS)]
    size = float(f"{SMALL * letters:.4g}")
    name = "vizlight.cartography.isolines"
    step = Step("isolines", name, mesh, array.name, levels, letters=size)
    return step if iso.are_smooth(mesh.run(), step.run()["lines"], size) else None


def inks(cmap: Given) -> list[str]:
    """Return black on light colours and white on others, for parts of a colour map in its order."""
    from pyvista.plotting.colors import get_cmap_safe

    shares = (np.arange(INKS) + 0.5) / INKS
    colors = np.asarray(get_cmap_safe(cmap)(shares))[:, :3]
    return ["black" if light > LIGHT else "white" for light in eye.lab(colors)[:, 0]]


def shore() -> Step:
    """Return the step that makes the coasts of a globe."""
    flat = Step("", "vizlight.cartography.coasts", (-180.0, 180.0, -90.0, 90.0))
    # Sides of cells are chords of the ball, which would hide lines on it.
    return Step("coasts", ".scale", Step("", "vizlight.cartography.globe", flat), ABOVE_BALL)


def ball() -> Step:
    """Return the step that makes the ball below a globe."""
    return Step("ball", "pyvista.Icosphere", radius=BELOW_BALL, nsub=5)


def coasts(mesh: Step) -> Step | None:
    """Return the step that makes the coasts of a map in degrees, None where they show nothing."""
    if max(mesh.run().bounds_size[:2]) < COASTS:
        return None
    step = Step("coasts", "vizlight.cartography.coasts", mesh)
    return step if step.run().n_cells else None
