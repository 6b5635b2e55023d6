"""Light by question: scenes by which a reader reads one thing back, and their keys.

==========================  ===============================================================
``presets.direction``       which way does the field run? Hue is its direction on the screen
``presets.slope``           how steep are lines toward the eye? Dark lines run toward it
``presets.heading``         and which end is near? Hue tells it
``presets.shape``           what is the shape? Hue and lightness are the normal
``presets.value``           what is the value? Colours of data read by their bar
==========================  ===============================================================

Their lamps turn with the eye, and options of filters keep their defaults, except that tangents on
a surface need ``conditioned=True`` with ``shape`` and ``value``. :func:`key` draws what the colours
mean, and :func:`key_picture` as an array of pixels; ``plotter.vizlight.add_key()`` puts it in a
corner of the picture.
"""

from vizlight.filters.key import key, key_picture
from vizlight.scene.presets import direction, heading, shape, slope, value

__all__ = ["direction", "heading", "key", "key_picture", "shape", "slope", "value"]
