"""Light in a pipeline of VTK and in ParaView, which need no PyVista."""

from vizlight.vtk.illuminate import Illuminate

__all__ = ["Illuminate"]
