"""Cos-theta shadows as point scalars: on height fields, on closed surfaces, over a day."""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check, _progress
from vizlight.filters.lighting import DEFAULT_NAME, VALID, attach, refuse_overwriting
from vizlight.geometry.relief import sun
from vizlight.mesh import point_arrays, records
from vizlight.mesh.casters import caster
from vizlight.scene import Light, Material, Scene
from vizlight.shading import engine
from vizlight.verify.report import note_ratio

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight.geometry.relief.height_field import Border
    from vizlight.geometry.relief.shadowing import Method


def relief_shadow(
    mesh: Any,
    /,
    scene: Scene,
    *,
    depth: float | None = None,
    elevation: str | None = None,
    factor: float = 1.0,
    base: float | None = None,
    border: Border = "extend",
    method: Method = "fast",
    thickness: float | None = None,
    occluders: Any = (),
    angular_diameter: float = 0.0,
    samples: int = 16,
    lit: bool = False,
    components: bool = False,
    threads: int | None = None,
    name: str = "t",
    inplace: bool = False,
    progress_bar: bool = False,
) -> Any:
    """Return a mesh with its cos-theta shadow: cosine, shadow and scattering in one number.

    Parameters
    ----------
    mesh : pyvista.ImageData, RectilinearGrid, StructuredGrid or PolyData
        A height field of one layer, its rows and columns straight and square to each other; or a
        closed surface. Not changed, unless ``inplace``.
    scene : Scene
        Its lights, at infinity or near, in the mesh's unit.
    depth : float, optional
        d of 0 or more, how far below the surface the light is gathered, in the mesh's unit: the
        deeper, the softer. Default: 0.01 of the diagonal of the faces, a field's in x and y.
    elevation : str, optional
        A point array of heights. Default: z of a StructuredGrid, else the active scalars. NaN
        is a hole.
    factor : float, default: 1.0
        By which heights are multiplied: height fields alone.
    base, border, method
        As for :func:`vizlight.geometry.relief.inside_length`: height fields alone.
    thickness : float, optional
        Light an open surface as a shell of that thickness below its normals.
    occluders : pyvista.PolyData or sequence of them
        Further closed surfaces that stand between a surface and the light.
    angular_diameter : float, default: 0.0
        Of the lights at infinity, in radians: the sun's 0.53 degrees are 0.00925.
    samples : int, default: 16
        Directions that stand for a light of some diameter, equal in area.
    lit : bool, default: False
        Add ``luminance``, and ``rgb`` where the scene has a colour: the engine's light with t in
        place of the cosine; a highlight keeps ``min(1, t / cos)``.
    components : bool, default: False
        Add ``t_0``, ``t_1``, ..., one for each light, and with ``lit`` the engine's terms.
    threads : int, optional
        Default: the processors that this process may use.
    name : str, default: "t"
    inplace, progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.DataSet
        With the point array ``t`` in [0, 1], the mean of all lights weighed by their intensity,
        and ``t_provenance``. ``t_valid`` marks points without height or normal, where t is 0.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit; if the mesh is open, a grid has several layers or one row,
        or a light is inside the solid.

    Warns
    -----
    UserWarning
        Once, with the count, if points have no height or no normal.

    Notes
    -----
    ``t = d / r``, r the length inside the solid of the segment from ``p' = p - d n`` to the
    light; 1 where r is less than d. A field of cells of size h errs by h^2 / d, in the mean
    where shadows begin. A closed surface is followed by VTK's StaticCellLocator in float64.
    Source: cos-theta, section 3, which prints ``t = r/d`` once; it is d/r.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> sun = vizlight.Scene(lights=vizlight.Light(direction=(0, 3, 4)))
    >>> flat = pv.ImageData(dimensions=(5, 5, 1))
    >>> flat["height"] = [0.0] * 25
    >>> round(float(vizlight.relief_shadow(flat, sun)["t"][7]), 9)
    0.8
    """
    options = dict(locals())
    for own in ("mesh", "scene", "threads", "inplace", "progress_bar"):
        del options[own]
    if isinstance(occluders, pv.DataObject):
        occluders = [occluders]
    if isinstance(occluders, str) or not isinstance(occluders, Iterable):
        expected = "closed surfaces, or one"
        raise TypeError(_check.message("occluders", expected, _check.describe(occluders)))
    options["occluders"] = occluders = list(occluders)
    lights = _lights(scene)
    shadow = caster(mesh, scene, options, occluders, threads)
    each = [f"{name}_{i}" for i in range(len(lights) if components else 0)]
    refuse_overwriting([(mesh, "")], name, components=False, colored=False)
    records.refuse_overwriting([(mesh, "")], name, each)
    if lit:
        refuse_overwriting([(mesh, "")], DEFAULT_NAME, components=components, colored=scene.colored)

    start = time.perf_counter()
    t = np.empty((len(shadow.points), len(lights)))
    discs = [_disc(light, angular_diameter, samples) for light in lights]
    with _progress.progress("shadow", len(lights), show=progress_bar) as report:
        for i, disc in enumerate(discs):
            t[:, i] = sum(shadow.of(one) for one in disc) / len(disc)
            report(i + 1)

    def again(point: int, light: int) -> float:
        return float(np.mean([shadow.again(point, one) for one in discs[light]]))

    size = t.itemsize * len(t) * (1 + len(lights) * components)
    effort = shadow.effort * max(map(len, discs))
    note_ratio(t, shadow.valid, time.perf_counter() - start, size, again, effort)
    weight = np.array([light.intensity for light in lights])
    told = records.tell(
        "relief_shadow", scene, options, precision="float64", points=len(t),
        invalid=int(np.count_nonzero(~shadow.valid)), depth=shadow.depth,
    )  # fmt: skip
    shading = None
    if lit:
        fixed = scene.replace(lights=lights)
        shading = engine.shade(
            shadow.points, None, fixed, normals=shadow.normals, shadow=t, threads=threads,
            components=components,
        )  # fmt: skip

    # Nothing is attached before all is computed: a failure leaves the mesh as it was.
    out = mesh if inplace else mesh.copy(deep=False)
    if shading is not None:
        record = records.record(shading, "relief_shadow", scene, options)
        attach(out, shading, DEFAULT_NAME, record)
    arrays: dict[str, NDArray[Any]] = {own: t[:, i].copy() for i, own in enumerate(each)}
    arrays[name] = t @ (weight / weight.sum())
    missing = int(np.count_nonzero(~shadow.valid))
    if missing:
        arrays[name + VALID] = shadow.valid
        _check.warn(
            f"{missing} of {len(t)} points have no height or no normal and t = 0; "
            f"the point array {name + VALID!r} marks them"
        )
    records.attach(out, name, arrays, told)
    if lit:
        point_arrays.activate(out, DEFAULT_NAME)
    return out


def relief_day(
    mesh: Any,
    /,
    *,
    latitude: float | None = None,
    day: float | None = None,
    hours: Any = None,
    directions: Any = None,
    name: str = "t",
    progress_bar: bool = False,
    **options: Any,
) -> Any:
    """Return a mesh with its cos-theta shadow at several hours of a day.

    Parameters
    ----------
    mesh
        As for :func:`relief_shadow`; x is east, y north.
    latitude : float, optional
        In radians, north positive.
    day : float, optional
        Of the year, 1 for the first of January.
    hours : float or array_like, shape (H,), optional
        Of true solar time, 12 when the sun is highest; default: each hour from 4 to 20.
    directions : array_like, shape (H, 3), optional
        Toward the sun, in place of latitude, day and hours.
    name : str, default: "t"
    progress_bar : bool, default: False
    **options
        Of :func:`relief_shadow`: depth, elevation, factor, angular_diameter and others.

    Returns
    -------
    pyvista.DataSet
        With the point array ``t`` of H components, 0 where the sun is below the horizon,
        ``t_mean``, their mean, which is active, and ``t_provenance``: its options make ``t`` again
        without its scene, ``relief_day(mesh, **p["options"])``.

    Raises
    ------
    TypeError, ValueError
        As :func:`relief_shadow` and :func:`vizlight.geometry.sun.directions`.
    """
    for other in ("scene", "lit", "components", "inplace"):
        if other in options:
            raise TypeError(
                _check.message(other, "no such option", _check.describe(options[other]))
            )
    own = {
        "latitude": latitude, "day": day, "hours": hours, "directions": directions,
    }  # fmt: skip
    if directions is None:
        if latitude is None or day is None:
            got = _check.message("latitude, day", "both, or directions=", (latitude, day))
            raise ValueError(got)
        hours = np.arange(4.0, 21.0) if hours is None else hours
        toward = np.atleast_2d(sun.directions(latitude, day, hours))
    elif latitude is not None or day is not None or hours is not None:
        expected = "directions alone, or latitude, day and hours"
        raise ValueError(_check.message("directions", expected, "both"))
    else:
        toward = np.atleast_2d(_check.vectors("directions", directions, n=3))
    given, value = ("hours", hours) if directions is None else ("directions", directions)
    if toward.ndim != 2 or not len(toward):
        raise ValueError(_check.message(given, "a list of one or more", _check.describe(value)))
    if directions is not None:
        for i, way in enumerate(toward):
            _check.vector(f"directions[{i}]", way, direction=True)
    up = [way for way in toward if way[2] > 0]
    if not up:
        raise ValueError(_check.message(given, "the sun above the horizon", "night"))
    scene = Scene(lights=[Light(direction=way) for way in up], material=Material(specular=0.0))
    found = relief_shadow(
        mesh, scene, name=name, components=True, progress_bar=progress_bar, **options
    )
    mean = f"{name}_mean"
    records.refuse_overwriting([(found, "")], name, [mean])
    t, seen = np.zeros((mesh.n_points, len(toward))), 0
    for hour, way in enumerate(toward):
        if way[2] > 0:
            t[:, hour] = found.point_data[f"{name}_{seen}"]
            seen += 1
    arrays: dict[str, NDArray[Any]] = {name: t, mean: t.mean(axis=1)}
    if name + VALID in found.point_data:
        arrays[name + VALID] = np.asarray(found.point_data[name + VALID])
    told = records.provenance(found, name)
    told["filter"] = "relief_day"
    for other in ("lit", "components"):
        del told["options"][other]
    told["options"] |= records.plain(own)
    records.attach(found, name, arrays, told)
    point_arrays.activate(found, mean)
    return found


def _lights(scene: Scene) -> list[Light]:
    """Return the lights that give light, fixed where they are."""
    _check.instance("scene", scene, Scene)
    lights = [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]
    if not lights:
        raise ValueError(_check.message("scene", "a light of intensity above 0", "none"))
    if scene.n != 3:
        raise ValueError(_check.message("scene", "vectors of 3 components", f"{scene.n}"))
    return lights


def _disc(light: Light, diameter: float, samples: int) -> list[Light]:
    """Return lights that stand for a disc of some angular diameter, of equal area each."""
    diameter = _check.number("angular_diameter", diameter, low=0.0, high=1.0)
    samples = _check.integer("samples", samples, low=1)
    if light.direction is None or diameter == 0 or samples == 1:
        return [light]
    return [
        Light(direction=way, intensity=light.intensity)
        for way in sun.disc(light.direction, diameter, samples)
    ]
