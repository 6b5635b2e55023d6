"""Streamlines, free or confined to a surface, lit and conditioned."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters import _lines, _mesh, _surface
from vizlight.filters._illuminate import illuminate
from vizlight.scene import Scene


def streamlines(
    mesh: Any,
    /,
    scene: Scene,
    *,
    vectors: str | None = None,
    surface: Any = None,
    confined: bool | None = None,
    conditioned: bool | None = None,
    seeds: Any = 200,
    seed: int = 0,
    step: float = 0.3,
    max_length: float | None = None,
    max_steps: int = 4000,
    **options: Any,
) -> Any:
    """Integrate streamlines by VTK's tracer, light them, condition them by a surface.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Carries the vectors; not changed.
    scene : Scene
    vectors : str, optional
        A point array of 3 components; default the active vectors.
    surface : pyvista.PolyData, optional
        Its normals condition the light of lines near it (Banks 6); confined lines stay on it.
        Default for a mesh that is a surface: the mesh itself.
    confined : bool, optional
        Keep the lines on the surface: the tangential part of the vectors is integrated.
        Default: whether the mesh itself is a surface and no other is given.
    conditioned : bool, optional
        Default: whether there is a surface.
    seeds : int or array_like, shape (M, 3), or mesh, default: 200
        Where lines start; a number is of points of the mesh (of the surface for confined
        lines), drawn without repetition.
    seed : int, default: 0
        Of the drawing.
    step : float, default: 0.3
        Largest step of the integration, in cell lengths.
    max_length : float, optional
        Of a line, in the unit of the mesh; default four diagonals of the bounding box.
    max_steps : int, default: 4000
        Of a line.
    **options
        Of :func:`vizlight.illuminate`, ``tangents=`` to light by another array than the lines'
        own tangents.

    Returns
    -------
    pyvista.PolyData
        The lines that left their seed, with the point array ``luminance`` and the tracer's own
        arrays; with a surface ``Normals``; for confined lines the field array ``drift``, the
        largest distance from the surface before they were put back on it.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or no line could be traced.

    Notes
    -----
    Confined lines are moved to the closest point of the surface after tracing, so that they lie
    on its triangles to rounding: 1e-6 of the surface's size in float32. Sources: Banks 4.1 and
    (6).

    Examples
    --------
    >>> import vizlight
    >>> flow = vizlight.load_example()
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(1, 1, 1)))
    >>> lines = vizlight.streamlines(flow, scene, vectors="V", seeds=20)
    >>> "luminance" in lines.point_data
    True
    """
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message("mesh", "a PyVista dataset", type(mesh).__name__))
    _check.instance("scene", scene, Scene)
    vectors = _vectors_name(mesh, vectors)
    is_surface = isinstance(mesh, pv.PolyData) and bool(
        mesh.GetNumberOfPolys() or mesh.GetNumberOfStrips()
    )
    if confined is None:
        confined = is_surface and surface is None
    if surface is None and is_surface:
        surface = mesh
    if surface is None and (confined or conditioned):
        what = "confined" if confined else "conditioned"
        raise ValueError(_check.message("surface", f"a surface for {what} lines", None))
    carrier = mesh
    if surface is not None:
        surface = _surface.with_normals(surface, scene.view)
        if confined:
            surface = carrier = _tangential(surface, mesh, vectors)
    carrier = _traceable(carrier)
    lines = carrier.streamlines_from_source(
        _seeds(carrier, seeds, seed),
        vectors=vectors,
        surface_streamlines=confined,
        integration_direction="both",
        initial_step_length=_check.number("step", step, low=1e-6),
        max_step_length=step,
        min_step_length=min(0.01, step),
        max_steps=int(_check.number("max_steps", max_steps, low=1, high=1e9)),
        max_length=_max_length(carrier, max_length),
        terminal_speed=1e-6 * _largest(carrier, vectors),
        compute_vorticity=False,
    )
    lines = _lines.without_degenerate(lines)
    if not lines.n_points:
        raise ValueError(
            _check.message(
                "seeds", "points inside the mesh where the vectors are not zero", "no line"
            )
        )
    if surface is not None:
        places, normals = _surface.closest(surface, np.asarray(lines.points))
        if confined:
            drift = np.linalg.norm(places - lines.points, axis=1).max()
            lines.points = places.astype(lines.points.dtype)
            lines.field_data["drift"] = [drift]
        lines.point_data["Normals"] = normals.astype(lines.points.dtype)
    if conditioned is None:
        conditioned = surface is not None
    if conditioned:
        options.setdefault("normals", "Normals")
    return illuminate(lines, scene, conditioned=conditioned, inplace=True, **options)


def _vectors_name(mesh: pv.DataSet, vectors: str | None) -> str:
    if vectors is None:
        vectors = mesh.point_data.active_vectors_name
        if vectors is None:
            there = ", ".join(repr(key) for key in mesh.point_data) or "none"
            raise ValueError(
                _check.message("vectors", f"the name of a point array ({there})", None)
            )
    _mesh.vectors_of(mesh, "vectors", vectors, 3)
    return vectors


def _tangential(surface: pv.PolyData, mesh: pv.DataSet, vectors: str) -> pv.PolyData:
    """Return the surface with the tangential part of the vectors, sampled where it lacks them."""
    if vectors not in surface.point_data:
        field = pv.PolyData(surface.points).sample(mesh)
        surface.point_data[vectors] = np.asarray(field.point_data[vectors])
    array = np.asarray(surface.point_data[vectors], dtype=np.float64)
    normal = np.asarray(surface.point_data["Normals"], dtype=np.float64)
    along = array - np.einsum("ij,ij->i", array, normal)[:, np.newaxis] * normal
    surface.point_data[vectors] = along
    return surface


def _traceable(mesh: Any) -> Any:
    """Return a mesh that the tracer may change, without arrays of words, which end its process."""
    bare = mesh.copy(deep=False)
    for key in list(bare.point_data):
        if np.asarray(bare.point_data[key]).dtype.kind not in "biuf":
            del bare.point_data[key]
    return bare


def _largest(mesh: pv.DataSet, vectors: str) -> float:
    """Return the largest speed: below a millionth of it a line has come to rest."""
    speed = np.linalg.norm(mesh.point_data[vectors], axis=1)
    return float(np.max(speed, initial=0.0, where=np.isfinite(speed)))


def _seeds(mesh: pv.DataSet, seeds: Any, seed: int) -> pv.PolyData:
    if isinstance(seeds, pv.DataSet):
        return pv.PolyData(np.asarray(seeds.points))
    if np.ndim(seeds) == 0:
        count = min(_check.integer("seeds", seeds, low=1), mesh.n_points)
        chosen = np.random.default_rng(seed).choice(mesh.n_points, count, replace=False)
        return pv.PolyData(np.asarray(mesh.points)[np.sort(chosen)])
    points = _check.vectors("seeds", seeds, n=3)
    if points.ndim != 2:
        raise ValueError(_check.message("seeds", "shape (M, 3)", _check.describe(points)))
    return pv.PolyData(points)


def _max_length(mesh: pv.DataSet, max_length: float | None) -> float:
    if max_length is None:
        return 4 * float(mesh.length)
    return _check.number("max_length", max_length, low=np.finfo(float).tiny)
