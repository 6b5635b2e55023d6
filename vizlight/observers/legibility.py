"""The public meter: what a reader can read back from a lit picture of a mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.filters import lighting
from vizlight.filters.tint import color_table
from vizlight.mesh import blocks
from vizlight.observers.record import Legibility, of_direction, of_shape, of_slope, of_value
from vizlight.observers.samples import parts_of, places_of, seen_from
from vizlight.scene import Scene
from vizlight.shading.options import LightOptions

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv
    from numpy.typing import ArrayLike

    from vizlight.filters.tint import ColorMap
    from vizlight.scene.vtk import AnyView
    from vizlight.shading.options import Exponent, Model

#: Standard deviation of the noise of each channel.
NOISE = 2 / 255


def legibility(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    scene: Scene,
    *,
    tangents: str | ArrayLike | None = None,
    scalars: str | ArrayLike | None = None,
    cmap: ColorMap = None,
    clim: Sequence[float] | float | None = None,
    conditioned: bool = False,
    exponent: Exponent = "compensated",
    model: Model = "phong",
    view: AnyView = None,
    noise: float = NOISE,
    samples: int = 4096,
    seed: int = 0,
) -> Legibility:
    """Measure what a reader can read back from a lit picture.

    An offscreen picture finds the visible pixels. Each of a random sample of them is lit for the
    data that are there and for every other answer to a question, and an *ideal observer*, who
    knows the lamps, the material and how light is computed, tells by the noisy colour which
    answer is likeliest. No person reads a picture as well: its figures are an **upper bound** of
    what a person can read, and what it cannot read is not in the picture. The errors by the key,
    of ``direction``, and the errors of ``value`` belong to readers who know nothing but what stands
    beside the picture.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh as the picture shows it: surfaces, lines, points, or blocks of them.
    scene : Scene
        Lights, material and view, in the unit of the mesh.
    tangents : str or array_like, optional
        Name of a point array of 3 or 6 components, or its values, as for
        :func:`vizlight.illuminate`.
    scalars : str or array_like, shape (N,) or (N, c), optional
        Point array whose values colour the picture, as for :func:`vizlight.tint`. Default: none,
        and no figures of ``value``.
    cmap : str, list, matplotlib colormap or pyvista.LookupTable, optional
        Colour map of the values. Default: as for :func:`vizlight.tint`.
    clim : (float, float) or float, optional
        Values at the ends of the colour map. Default: smallest and largest value.
    conditioned : bool, default: False
        Whether tangents inherit the self-shadow of the surface (Banks 6).
    exponent : float or "compensated"
        Exponent of the diffuse term, as for :func:`vizlight.illuminate`.
    model : {"phong", "blinn", "cylinder"}
        Reflection model of the highlight.
    view : View or pyvista.Camera, optional
        Eye. Default: the view of the scene, else the isometric view that shows the whole mesh. A
        view with a direction alone shows the whole mesh; a perspective one has an angle of 30
        degrees; a camera is taken as it is.
    noise : float, default: 2/255
        Standard deviation of the noise in each channel that the observers of direction, slope and
        shape get, beside rounding to bytes. Values are read off the bytes of the picture.
    samples : int, default: 4096
        Largest number of pixels that are measured.
    seed : int, default: 0
        Seed of the drawing of pixels and of the noise.

    Returns
    -------
    Legibility
        Figures of ``direction``, ``slope``, ``shape`` and ``value``, each None where the data have
        no such question. It prints as a table.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, an array is missing, no point is visible, or scene and mesh
        are not in 3-space.

    Notes
    -----
    *direction*: the candidates for a tangent are the 180 directions in the tangent plane, which is
    known; for a point without normal those about the line of sight. The reader by the key knows no
    normal: he finds the hue of a pixel on a small disc that faces the eye and has tangents in all
    directions, and takes the direction there; tangents that run toward the eye are not asked for.
    Under a single hue he always takes one direction, which is right where the data have one.
    *slope*: rank correlation and information use CIELAB's lightness alone; an ideal observer
    who knows the course of a line in the picture tells its direction in space.
    *shape*: 900 normals; where there are tangents, which are unknown, 300 with 72 tangents each.
    *value*: the nearest colour of the bar in CIELAB, and the nearest chromaticity.

    The meter is held by cases with known answers. A plane that faces the eye under one oblique
    white lamp leaves the mirror image as likely as the truth: 0.56 of the directions are within 10
    degrees. Two colours 60 degrees apart resolve it; 90 degrees apart they do not, since they are
    mirror images again. A headlight on such a plane tells nothing: 45 degrees, 1/9, 0 bits. The
    light of a cylinder under a headlight falls with the slope, rank correlation -1, but which end
    of a line is near stays unknown. Three lamps at right angles in red, green and blue solve for
    the normal of a ball (photometric stereo, Woodham 1980). Unlit colours are read to half a step
    of the bar, and colours of other values at random, 0.29 of the range.

    A million points take about 6 s of processor time, including 2 s for the picture and 2 s for the
    normals of the surface. Beside what these two need, and the tangents, memory does not depend on
    the number of points; it is up to 200 MB.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> ball = pv.Sphere()
    >>> lamps = [
    ...     vizlight.Light(direction=way, color=color)
    ...     for way, color in [((1, 0, 0), "red"), ((0, 1, 0), "lime"), ((0, 0, 1), "blue")]
    ... ]
    >>> scene = vizlight.Scene(lights=lamps, material=vizlight.Material(specular=0))
    >>> found = vizlight.legibility(ball, scene, samples=256)
    >>> found.shape.median < 5
    True
    >>> found.direction is None
    True
    """
    _check.instance("scene", scene, Scene)
    noise = _check.number("noise", noise, low=0.0, high=1.0)
    samples = _check.integer("samples", samples, low=1, high=1 << 24)
    seed = _check.integer("seed", seed, low=0)
    if scalars is None and (cmap is not None or clim is not None):
        name = "cmap" if cmap is not None else "clim"
        raise ValueError(_check.message(name, "scalars= beside it", "none"))
    conditioned = _check.boolean("conditioned", conditioned)
    options = LightOptions(
        tangents=tangents, conditioned=conditioned, exponent=exponent, model=model
    )
    blocks.check(mesh)
    camera, scene = seen_from(mesh, scene, view)
    parts = parts_of(mesh, scene, options, scalars)
    scene = lighting.fit_depth_cue(scene, [part.inputs for part in parts])
    taken, pixels, drawn = places_of(parts, camera, scene, samples, np.random.default_rng(seed))
    notes: list[str] = []
    lamps = any(light.intensity > 0 for light in scene.lights)
    if not lamps:
        notes.append("the scene has no lamp: light tells no direction, slope or shape")
    asked = [one for one, _ in taken] if lamps else []
    table = None
    if scalars is not None:
        values = [np.asarray(part.values) for part in parts]
        if any(own.ndim == 2 for own in values):
            got, remedy = "colours of three or four bytes", "name the array that they show"
            raise ValueError(_check.message("scalars", "values to read", got, remedy))
        table = color_table(values, cmap=cmap, clim=clim)
    toward = -np.array(camera.GetDirectionOfProjection())
    return Legibility(
        direction=of_direction(asked, seed, noise, notes),
        slope=of_slope(asked, seed, noise, notes),
        shape=of_shape(asked, seed, noise, notes),
        value=None if table is None else of_value(taken, table, notes),
        pixels=pixels,
        drawn=drawn,
        toward_eye=(float(toward[0]), float(toward[1]), float(toward[2])),
        noise=noise,
        seed=seed,
        notes=tuple(notes),
    )
