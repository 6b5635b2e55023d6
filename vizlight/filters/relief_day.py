"""Cos-theta shadows at several hours of a day."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, FeatureAngle, Keywords, Raw
from vizlight.filters.relief_shadow import ReliefOptions, relief_shadow
from vizlight.geometry.relief import sun as sky
from vizlight.geometry.relief.height_field import Border
from vizlight.mesh import blocks, records
from vizlight.mesh.blocks import MeshT
from vizlight.scene import Light, Material, Scene
from vizlight.scene.keywords import named
from vizlight.shading.results import VALID, plain


@named
def relief_day(
    mesh: MeshT,
    /,
    *,
    latitude: float | None = None,
    day: float | None = None,
    hours: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    sun: ArrayLike | None = None,
    angular_diameter: float = 0.0,
    samples: int = 16,
    name: str = "t",
    depth: float | None = None,
    elevation: str | None = None,
    exaggeration: float = 1.0,
    border: Border = "extend",
    raster: float | None = None,
    thickness: float | None = None,
    feature_angle: FeatureAngle = None,
    occluders: pv.PolyData | Sequence[pv.PolyData] = (),
    progress_bar: bool = False,
) -> MeshT:
    """Return a mesh with its cos-theta shadow at several hours of a day.

    Parameters
    ----------
    mesh
        As for :func:`relief_shadow`; x is east, y north.
    latitude : float, optional
        Latitude in degrees, north positive.
    day : float, optional
        Day of the year, 1 for the first of January.
    hours : float or array_like, shape (H,), optional
        Hours of true solar time, 12 when the sun is highest. Default: each hour from 4 to 20.
    directions : array_like, shape (H, 3), optional
        Directions toward the sun, in place of latitude, day and hours.
    sun : array_like, shape (H, 2), optional
        Azimuth, clockwise from north, and altitude of the sun in degrees, in place of directions.
    angular_diameter, samples, name, depth, elevation, exaggeration, border, raster
        As for :func:`vizlight.relief_shadow`.
    thickness, feature_angle, occluders
        As for :func:`vizlight.relief_shadow`.
    progress_bar
        As for :func:`relief_shadow`.

    Returns
    -------
    pyvista.DataSet
        With the point array ``t`` of H components, 0 where the sun is below the horizon,
        ``t_mean``, their mean, which is active, and ``t_provenance``: its options make ``t`` again
        without its scene, ``relief_day(mesh, **p["options"])``.

    Raises
    ------
    TypeError, ValueError
        As :func:`relief_shadow` and :func:`vizlight.geometry.relief.sun.directions`.

    Warns
    -----
    UserWarning
        If the latitude may be in radians: it is beside the equator, at no more than pi/2.
    """
    options = locals()
    if isinstance(mesh, pv.MultiBlock):
        del options["mesh"]
        return blocks.each(mesh, lambda block: relief_day(block, **options))
    shadow_options = ReliefOptions.of(options)
    hour_options: Keywords = {
        "latitude": latitude,
        "day": day,
        "hours": hours,
        "directions": directions,
    }
    if sun is not None:
        if any(value is not None for value in hour_options.values()):
            expected = "sun alone, without directions, latitude, day and hours"
            raise _check.value_error("sun", expected, "both")
        directions = hour_options["directions"] = _from_angles(sun)
    toward = directions_of(hour_options)
    # A sun below the horizon lights nothing: its hours keep a column of 0.
    up = [way for way in toward if way[2] > 0]
    if not up:
        argument = "hours" if directions is None else "directions"
        raise _check.value_error(argument, "the sun above the horizon", "night")
    # Each hour with sun is one light of the scene; only t is asked for, in which a highlight has no
    # part.
    scene = Scene(lights=[Light(direction=way) for way in up], material=Material(specular=0.0))
    shadowed = relief_shadow(
        mesh, scene, progress_bar=progress_bar, **shadow_options.changed() | {"components": True}
    )
    name = shadow_options.name
    mean = f"{name}_mean"
    records.refuse_overwriting([(shadowed, "")], name, [mean])
    t = np.zeros((shadowed.n_points, len(toward)))
    for seen, hour in enumerate(np.flatnonzero(toward[:, 2] > 0)):
        t[:, hour] = shadowed.point_data[f"{name}_{seen}"]
    arrays: dict[str, Raw] = {name: t, mean: t.mean(axis=1)}
    if name + VALID in shadowed.point_data:
        arrays[name + VALID] = np.asarray(shadowed.point_data[name + VALID])
    record = records.provenance(shadowed, name)
    record["filter"] = "relief_day"
    # The record is a call of this filter, which has none of these options.
    for other in ("lit", "components", "occlusion"):
        del record["options"][other]
    record["options"] |= plain(hour_options)
    records.attach(shadowed, name, arrays, record)
    records.activate(shadowed, mean)
    return shadowed


def _from_angles(sun: ArrayLike) -> Array:
    """Return directions toward the sun from azimuths and altitudes in degrees."""
    angles = np.atleast_2d(_check.floats("sun", sun))
    if angles.ndim != 2 or angles.shape[1] != 2:
        expected = "pairs of azimuth and altitude in degrees"
        raise _check.value_error("sun", expected, _check.describe(sun))
    return sky.toward(angles[:, 0], angles[:, 1])


def directions_of(options: Keywords) -> Array:
    """Return the directions toward the sun, one row for each hour, by options or their record."""
    latitude, day, hours, directions = (
        options[name] for name in ("latitude", "day", "hours", "directions")
    )
    if directions is None:
        if latitude is None or day is None:
            expected = "both, or directions="
            raise _check.value_error("latitude, day", expected, (latitude, day))
        name, value = "hours", np.arange(4.0, 21.0) if hours is None else hours
        angle = math.radians(_check.number("latitude", latitude, low=-90.0, high=90.0))
        if 0 < abs(latitude) <= math.pi / 2:
            _check.warn(f"latitude: {latitude:g} is taken for degrees, not radians")
        toward: Array = np.atleast_2d(sky.directions(angle, day, value))
    elif latitude is not None or day is not None or hours is not None:
        expected = "directions alone, or latitude, day and hours"
        raise _check.value_error("directions", expected, "both")
    else:
        name, value = "directions", directions
        toward = np.atleast_2d(_check.vectors("directions", directions, n=3))
    if toward.ndim != 2 or not len(toward):
        raise _check.value_error(name, "a list of one or more", _check.describe(value))
    if directions is not None:
        for i, way in enumerate(toward):
            _check.vector(f"directions[{i}]", way, direction=True)
    return toward
