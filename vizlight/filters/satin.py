"""Satin: a surface covered by fibres, in the four ways to light it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyvista as pv

from vizlight import _check
from vizlight.filters.illuminate import illuminate
from vizlight.filters.streamlines import streamlines
from vizlight.mesh import point_arrays
from vizlight.shading.options import surface_model

if TYPE_CHECKING:
    from vizlight.scene import Scene
    from vizlight.shading.options import Model


#: Options of the integral curves alone, and of the panels that have sides.
TRACED = ("step", "max_length", "max_steps")
SIDES = ("normals", "two_sided", "flip_normals")
ENDS = ("terminator",)


def satin(
    surface: Any,
    /,
    scene: Scene,
    *,
    tangents: str,
    seeds: Any = 300,
    seed: int = 0,
    compensate: bool = True,
    model: Model = "phong",
    **options: Any,
) -> Any:
    """Light a surface with a tangent field in four ways: the panels of Banks' illustration 2.

    Parameters
    ----------
    surface : pyvista.PolyData
        Not changed.
    scene : Scene
        Banks' material is ``Material(ambient=0.1, diffuse=0.5, specular=1.0,
        color=(1.0, 0.25, 0.30))``.
    tangents : str
        A point array of 3 components, tangent to the surface.
    seeds, seed
        Of the integral curves, as in :func:`vizlight.streamlines`.
    compensate : bool, default: True
        Diffuse with the exponent p(k, n); Banks' panels are without.
    model : {"phong", "blinn", "cylinder"}
        As for :func:`vizlight.illuminate`; with ``"cylinder"`` the surface's law is Blinn's.
    **options
        Of :func:`vizlight.illuminate`, for all panels that they fit; step, max_length and
        max_steps of :func:`vizlight.streamlines`.

    Returns
    -------
    pyvista.MultiBlock
        ``curves``: integral curves, lit as lines without self-shadow (A). ``surface``: lit by its
        normals (B). ``field``: the surface lit by the field alone (C). ``conditioned``: by the
        field, with the surface's self-shadow (D, Banks 6).

    Raises
    ------
    TypeError, ValueError
        As :func:`vizlight.illuminate` and :func:`vizlight.streamlines`.
    """
    for own in ("conditioned", "inplace", "vectors"):
        if own in options:
            remedy = "the four panels differ in it" if own == "conditioned" else "leave it out"
            raise TypeError(_check.message(own, "no such option", repr(options[own]), remedy))
    if isinstance(surface, pv.DataSet):
        point_arrays.refuse_unnamed("tangents", tangents)
        point_arrays.vectors_of(surface, "tangents", tangents, 3)
    traced, sides, ends = (
        {key: options.pop(key) for key in names if key in options}
        for names in (TRACED, SIDES, ENDS)
    )
    options["compensate"] = compensate
    own_light: dict[str, Any] = {"tangents": tangents, "model": model, **options}
    curves = streamlines(
        surface,
        scene,
        vectors=tangents,
        conditioned=False,
        seeds=seeds,
        seed=seed,
        model=model,
        **traced,
        **options,
    )
    return pv.MultiBlock(
        {
            "curves": curves,
            "surface": illuminate(
                surface, scene, model=surface_model(model), **sides, **ends, **options
            ),
            "field": illuminate(surface, scene, **own_light),
            "conditioned": illuminate(surface, scene, conditioned=True, **sides, **own_light),
        }
    )
