"""Light of data in pieces: slab by slab, by processes, or on a cluster that the user brings."""

from vizlight.pieces.run import Lit, camera_on, light
from vizlight.pieces.sources import PieceError, Slabs
from vizlight.pieces.workers import Processes

__all__ = ["Lit", "PieceError", "Processes", "Slabs", "camera_on", "light"]
