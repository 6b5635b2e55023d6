"""Sweeps of a weather radar in files of CfRadial: a map around the radar, or a section above it."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np
import pyvista as pv

from vizlight._types import Array, Foreign
from vizlight.mesh import fills, georeference, meaning, projections
from vizlight.reading import series

#: Variables by which a file is one of CfRadial: of its rays, and of its sweeps.
_ANGLES, _OTHERS = ("azimuth", "elevation"), ("range", "sweep_start_ray_index")
#: Radius of the earth in which rays that air bends are straight, as a multiple of its own.
BENT = 4 / 3
#: Least elevation in degrees of the rays of a radar that looks up.
ZENITH = 89.0
#: Largest gap, in mean distances of rays, across which a sweep is closed to a circle.
_GAP = 2.0


def is_radar(data: Foreign) -> bool:
    """Return whether a dataset of xarray has sweeps of a radar."""
    return all(name in data.variables for name in (*_ANGLES, *_OTHERS))


def grid(
    data: Foreign, at: Mapping[str, object], nodata: float | None, source: str
) -> pv.StructuredGrid:
    """Return one sweep: x east and y north of the radar, or x along the ground and y up.

    Rays of a radar that looks up are beside each other by their times.

    Places are those of rays in an atmosphere that bends them as if the earth had 4/3 of its radius
    (Doviak and Zrnic, Doppler Radar and Weather Observations, 1993, equations 2.28b and 2.28c).

    The data are a file of CfRadial, its times numbers; ``at`` has the angle or the number of a
    ``sweep``, by default the first. ``nodata`` is as for :func:`.fills.without_missing`.
    """
    if others := {*at} - {"sweep"}:
        raise ValueError(f"at: no axis {min(others)!r} in a file of a radar, but sweep")
    firsts, lasts = (np.ravel(data[f"sweep_{end}_ray_index"].values) for end in ("start", "end"))
    angles = [*range(len(firsts))]
    if "fixed_angle" in data.variables:
        angles = np.round(np.ravel(data["fixed_angle"].values).astype(np.float64), 2).tolist()
    sweep = series.chosen(angles, at.get("sweep", "first"), "at, along sweep")
    is_upward = bool(np.all(data["elevation"].values > ZENITH)) and "time" in data.variables
    # Each ray of a radar that looks up is a sweep, or all are one.
    rays = slice(None) if is_upward else slice(int(firsts[sweep]), int(lasts[sweep]) + 1)
    azimuth, elevation = (np.radians(data[name].values[rays].astype(float)) for name in _ANGLES)
    turned = np.unwrap(azimuth)
    # A second turn would lie over the first.
    order = np.flatnonzero(is_upward | (np.abs(turned - turned[0]) < 2 * np.pi))
    unit = meaning.metres(str(data["range"].attrs.get("units", "m"))) or 1.0
    distance, height = _places(unit * np.ravel(data["range"].values).astype(float), elevation)
    said = meaning.Meaning()
    if is_upward:
        what, angle = "elevation", 90.0
        x = np.broadcast_to(data["time"].values.astype(float)[:, np.newaxis], height.shape)
        y, clock = height + _of_radar(data, "altitude"), str(data["time"].attrs.get("units", ""))
        said.axes = ["x time", "y height in m"]
        said.scales = [meaning.AxisScale("time", clock), meaning.AxisScale("height", "m")]
    elif np.ptp(elevation) > np.ptp(turned):
        what, angle = "azimuth", float(np.median(np.degrees(turned))) % 360
        x, y = distance, height + _of_radar(data, "altitude")
        said.axes = ["x distance from the radar in m", "y height in m"]
        said.scales = [meaning.AxisScale("distance", "m"), meaning.AxisScale("height", "m")]
    else:
        what, angle = "elevation", float(np.median(np.degrees(elevation)))
        x, y = distance * np.sin(azimuth)[:, None], distance * np.cos(azimuth)[:, None]
        said.axes = ["x east of the radar in m", "y north of it in m"]
        once = np.ptp(turned[order])
        if (2 * np.pi - once) * (len(order) - 1) < _GAP * once:
            order = np.append(order, 0)
    said.level = f"{what} {round(angle, 2):g}°"
    if len(firsts) > 1 and not is_upward:
        listed = ", ".join(f"{each:g}" for each in angles)
        said.notes.append(f"the sweep {angles[sweep]:g} of {listed}; --at sweep= takes another")
    # The rays run fastest, so that a whole turn is closed along its rows.
    mesh = pv.StructuredGrid(x[order], y[order], 0 * x[order])
    words = []
    # Rain is seen by how much it reflects, which files have among signals and shares of noise.
    for name, values in sorted(data.data_vars.items(), key=_is_no_reflectivity):
        if values.dims == (*data["azimuth"].dims, *data["range"].dims):
            said.add_array(str(name), values.attrs)
            rows, missing = fills.without_missing(str(name), values.values[rays], nodata)
            words += [missing] if missing else []
            mesh.point_data[str(name)] = rows[order].ravel(order="F")
    if not mesh.point_data:
        raise ValueError("no variable along the rays of its sweeps")
    said.notes += fills.say(source, words)
    if not said.scales:
        lat, lon = _of_radar(data, "latitude"), _of_radar(data, "longitude")
        mesh.field_data[georeference.UNIT] = ["metre"]
        mesh.field_data["crs"] = [f"+proj=aeqd +lat_0={lat:.9g} +lon_0={lon:.9g} +datum=WGS84"]
    if "time" in data.variables:
        said.time = str(data["time"].attrs.get("units", ""))
        mesh = series.marked(mesh, [float(data["time"].values[rays].min())], 0)
    return meaning.attach(mesh, said)


def _places(ranges: Array, elevation: Array) -> tuple[Array, Array]:
    """Return distances along the ground and heights above the radar, shape (rays, gates)."""
    radius = BENT * projections.RADIUS
    sine, cosine = np.sin(elevation)[:, np.newaxis], np.cos(elevation)[:, np.newaxis]
    height = np.sqrt(ranges**2 + radius**2 + 2 * ranges * radius * sine) - radius
    return radius * np.arcsin(ranges * cosine / (radius + height)), height


def _is_no_reflectivity(variable: tuple[Foreign, Foreign]) -> bool:
    """Return whether neither the name nor the words of a variable are those of reflectivity."""
    name, values = variable
    words = (name, values.attrs.get("standard_name", ""), values.attrs.get("long_name", ""))
    return (
        re.search(r"\bdbz|(?<!differential[ _])reflectivity", " ".join(map(str, words)).lower())
        is None
    )


def _of_radar(data: Foreign, name: str) -> float:
    """Return a coordinate of a radar, the first where it moves, 0 where it is not said."""
    return float(np.ravel(data[name].values)[0]) if name in data.variables else 0.0
