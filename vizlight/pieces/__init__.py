"""Light of data in pieces: on one machine slab by slab, by processes, or on a cluster."""

from vizlight.pieces.drawing import pictures, save_png
from vizlight.pieces.kinds import PieceError, Slabs
from vizlight.pieces.run import Lit, light
from vizlight.pieces.survey import bounding_box, camera_on

__all__ = [
    "Lit", "PieceError", "Slabs", "bounding_box", "camera_on", "light", "pictures", "save_png",
]  # fmt: skip
