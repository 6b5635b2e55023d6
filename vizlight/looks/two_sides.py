"""Both sides of a flattened surface in one picture, with their names above them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight.draw.margins import LETTERS
from vizlight.looks.framing import Viewpoint, side_of
from vizlight.looks.steps import Step
from vizlight.mesh import brains

if TYPE_CHECKING:
    from vizlight.looks.wishes import Wishes

#: Words for the eye.
WORDS = "from both sides"


class TwoSides(NamedTuple):
    """Two sides of a surface.

    Attributes
    ----------
    blocks : Step
        Step that makes them, as blocks with names.
    eye : Viewpoint
        Eye that sees both.
    """

    blocks: Step
    eye: Viewpoint

    def layers(self) -> list[Step]:
        """Return the steps that take the blocks."""
        return [Step("", "[]", self.blocks, i) for i in range(2)]

    def camera_and_names(self, wishes: Wishes) -> tuple[Step, Step]:
        """Return the step of the camera on both sides, and the step that makes their names."""
        size = round(LETTERS * min(wishes.size), 1)
        height = round(wishes.room[1], 1)

        def names(camera: Step) -> Step:
            return Step("names", "render.names_above", self.blocks, camera, height, size=size)

        alone = wishes.camera(self.blocks, self.eye)
        around = Step("", "pyvista.MultiBlock", [self.blocks, names(alone)])
        camera = wishes.camera(around, self.eye)
        return camera, names(camera)


def of_surface(surface: Step, shown: str) -> TwoSides | None:
    """Return the two sides of a surface on which values differ, None for other surfaces.

    A hemisphere of the cortex always shows both sides.

    Parameters
    ----------
    surface : Step
        Step of the surface.
    shown : str
        Name of a point array of values.
    """
    mesh = surface.run()
    if side := brains.hemisphere(mesh):
        toward, up = (-1.0 if side == "left" else 1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        eye = Viewpoint(toward, up, True, WORDS)
        names = [f"{side.title()} hemisphere, {view}" for view in ("lateral", "medial")]
    elif (seen := side_of(mesh, shown)) is not None:
        eye = Viewpoint(seen.toward, seen.up, True, WORDS)
        axis = int(np.argmax(np.abs(eye.toward)))
        signs = ("", "-") if eye.toward[axis] > 0 else ("-", "")
        names = [f"From {sign}{'xyz'[axis]}" for sign in signs]
    else:
        return None
    blocks = Step("sides", "render.both_sides", surface, eye.toward, up=eye.up, names=names)
    return TwoSides(blocks, eye)
