"""Both sides of a flattened surface in one picture, with their names above them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight.draw.margins import LETTERS
from vizlight.looks.framing import Viewpoint, side_of
from vizlight.looks.steps import Step
from vizlight.mesh import brains

if TYPE_CHECKING:
    from vizlight._types import Keywords
    from vizlight.looks.wishes import Wishes

#: Words for the eye.
WORDS = "from both sides"
#: Words of the ends of a left hemisphere that is seen from the left.
ENDS = ["anterior", "posterior"]


class TwoSides(NamedTuple):
    """Two sides of a surface.

    Attributes
    ----------
    blocks : Step
        Step that makes them, as blocks with names.
    eye : Viewpoint
        Eye that sees both.
    captions : dict
        Keywords of ``render.captions``: words of the ends, and the unit of coordinates.
    """

    blocks: Step
    eye: Viewpoint
    captions: Keywords

    def layers(self) -> list[Step]:
        """Return the steps that take the blocks."""
        return [Step("", "[]", self.blocks, i) for i in range(2)]

    def camera_and_names(self, wishes: Wishes) -> tuple[Step, Step]:
        """Return the step of the camera on both sides, and the step that makes their names."""
        size = round(LETTERS * min(wishes.size), 1)
        height = round(wishes.room[1], 1)

        def names(camera: Step) -> Step:
            words: Keywords = {"size": size, **self.captions}
            return Step("captions", "render.captions", self.blocks, camera, height, **words)

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
    captions: Keywords = {}
    if side := brains.hemisphere(mesh):
        toward, up = (-1.0 if side == "left" else 1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
        eye = Viewpoint(toward, up, True, WORDS)
        names = [f"{side.title()} hemisphere, {view}" for view in ("lateral", "medial")]
        # The right hemisphere is seen from the right, its front at the right.
        lateral = ENDS if side == "left" else ENDS[::-1]
        captions = {"ends": [lateral, lateral[::-1]], "unit": "mm"}
    elif (seen := side_of(mesh, shown)) is not None:
        eye = Viewpoint(seen.toward, seen.up, True, WORDS)
        axis = int(np.argmax(np.abs(eye.toward)))
        signs = ("", "-") if eye.toward[axis] > 0 else ("-", "")
        names = [f"From {sign}{'xyz'[axis]}" for sign in signs]
    else:
        return None
    blocks = Step("sides", "render.both_sides", surface, eye.toward, up=eye.up, names=names)
    return TwoSides(blocks, eye, captions)
