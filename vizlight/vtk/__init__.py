"""Light in a pipeline of VTK and in ParaView, which need no PyVista.

The plugin for ParaView, 5.11 or newer with Python 3.10, NumPy 1.24 and SciPy 1.10, is the filter
*Vizlight Illuminate*: it has the light, the tangents (point arrays of 3 components), conditioning,
material and eye as properties. ``vizlight paraview`` prints the paths of its files::

    PYTHONPATH=FOLDER paraview

with the folder of these files lets ParaView find vizlight, by a ``sitecustomize.py`` that hides the
other packages of vizlight's own Python. Load ``FOLDER/vizlight_plugin.py`` in the plugin manager;
then run the script ``FOLDER/vizlight_eye.py``, which ties the eye of the filters to the active
view, so that light follows the camera. In a script of ``pvpython``:

.. code-block:: python

    LoadPlugin("FOLDER/vizlight_plugin.py", ns=globals())
    lit = VizlightIlluminate(Input=contour, Tangents="V", Conditioned=1, Light=[1, 0.9, 0.5])
    import vizlight_eye
    vizlight_eye.follow([lit], GetActiveView())

The light is a point array, on as many processes as ParaView has; :class:`Illuminate` says what
several pieces need. Without a plugin, :func:`vizlight.paraview.shader` lights each fragment.
"""

from vizlight.vtk.illuminate import Illuminate

__all__ = ["Illuminate"]
