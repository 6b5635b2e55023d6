"""Parts of a map beside its data, each as a mesh that can be drawn with it.

==========================  ===============================================================
``cartography.chart``       map in the plane of a projection, in metres
``cartography.coasts``      coasts of the earth, as lines
``cartography.isolines``    lines of equal values, with their numbers
``cartography.globe``       map on the unit sphere
``cartography.in_degrees``  mesh that says that its x and y are degrees
``cartography.frame``       degrees around a map, and a bar of lengths below it
``cartography.graticule``   meridians and parallels of a map in lengths
``cartography.smoothed``    map with more points, between which values run smoothly
==========================  ===============================================================

:func:`vizlight.look` adds them to the maps that it draws.
"""

from vizlight.draw.isolines import isolines
from vizlight.draw.map_frames import frame, graticule
from vizlight.mesh.charts import chart
from vizlight.mesh.coasts import coasts
from vizlight.mesh.georeference import in_degrees
from vizlight.mesh.globes import globe
from vizlight.mesh.smooth_maps import smoothed

__all__ = [
    "chart", "coasts", "frame", "globe", "graticule", "in_degrees", "isolines", "smoothed",
]  # fmt: skip
