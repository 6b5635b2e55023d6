"""Light in a pipeline of VTK and in ParaView, which need no PyVista.

The plugin for ParaView, 5.11 or newer with Python 3.10, NumPy 1.24 and SciPy 1.10, is the filter
*Vizlight Illuminate*. Its properties are the light, the tangents (point arrays of 3 components),
conditioning, the material and the eye. ``vizlight paraview`` prints the paths of its files and how
to start ParaView with their folder on PYTHONPATH: its ``sitecustomize.py`` lets ParaView's
Python find vizlight, and none of the packages beside it::

    PYTHONPATH=FOLDER paraview

Load ``FOLDER/vizlight_plugin.py`` in the plugin manager. The script ``FOLDER/vizlight_eye.py`` ties
the eye of the filters to the active view, so that the light follows the camera. Colour the result
by ``luminance`` from 0 to 1 with the preset *Grayscale*, and switch ParaView's own light off by
Ambient 1 and Diffuse 0. In a script of ``pvpython``:

.. code-block:: python

    LoadPlugin("FOLDER/vizlight_plugin.py", ns=globals())
    lit = VizlightIlluminate(Input=contour, Tangents="V", Conditioned=1, Light=[1, 0.9, 0.5])
    import vizlight_eye
    vizlight_eye.follow([lit], GetActiveView())

On several processes light is the same as on one; where it depends on the normals of faces, put the
filter *Ghost Cells* before the contour, as :class:`Illuminate` explains. Without a plugin,
:func:`vizlight.draw.paraview.shader` lights each fragment.
"""

from vizlight.vtk.illuminate import Illuminate

__all__ = ["Illuminate"]
