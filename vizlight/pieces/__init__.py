"""Light of data in pieces: slab by slab, by processes, or on a cluster that the user brings."""

from vizlight.pieces.kinds import PieceError, Slabs
from vizlight.pieces.run import Lit, light
from vizlight.pieces.survey import camera_on
from vizlight.pieces.workers import Processes

__all__ = ["Lit", "PieceError", "Processes", "Slabs", "camera_on", "light"]
