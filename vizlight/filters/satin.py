"""Satin: a surface covered by fibres, in the four ways to light it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import ClassVar

import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Exponent, Facing, FeatureAngle, Model, Precision
from vizlight.filters.illuminate import light_mesh
from vizlight.filters.streamlines import StreamlineOptions, light_lines
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene
from vizlight.shading.options import Bundle, LightOptions
from vizlight.vtk.arrays import is_of_cells, tangents_of, vectors_of


@dataclass(frozen=True, kw_only=True)
class SatinOptions(StreamlineOptions):
    """Options of the curves of satin, and of the light of all panels.

    The fields are keywords of :func:`vizlight.satin`.
    """

    DECIDED: ClassVar = frozenset(
        {"conditioned", "surface", "confined", "stroke_length", "min_length", "travel"}
    )
    tangents: str | None = None
    seeds: int | ArrayLike | pv.DataSet = 300


@named
def satin(
    surface: pv.PolyData,
    /,
    scene: AnyScene | None = None,
    *,
    seeds: int | ArrayLike | pv.DataSet = 300,
    line_field: bool = False,
    seed: int = 0,
    spacing: float | None = None,
    step: float = 0.3,
    max_length: float | None = None,
    tangents: str | None = None,
    positions: str | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    feature_angle: FeatureAngle = None,
    bundle: bool | Bundle = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    progress_bar: bool = False,
) -> pv.MultiBlock:
    """Light a surface with a tangent field in four ways: the panels of Banks' illustration 2.

    Parameters
    ----------
    surface : pyvista.PolyData
        Surface that is lit; not changed. ``tangents`` names its point array of 3 components,
        tangent to it, or its cell array; it must be given.
    scene : Scene or str, optional
        Lights, material and view, by default ``Scene()``. Banks' material is
        ``Material(ambient=0.1, diffuse=0.5, specular=1.0, color=(1.0, 0.25, 0.30))``, and his
        panels have ``exponent=1``.
    seeds : int or array_like, shape (M, 3), or mesh, default: 300
        Points at which curves start; a number stands for places on the surface, uniform in area.
    line_field, seed, spacing, step, max_length
        As for :func:`vizlight.streamlines`.
    tangents, positions, normals, facing, feature_angle, bundle, occlusion, name, exponent
        As for :func:`vizlight.illuminate`.
    model, components, precision
        As for :func:`vizlight.illuminate`.
    progress_bar
        As for :func:`vizlight.illuminate`.

    Returns
    -------
    pyvista.MultiBlock
        ``curves``: integral curves, lit as lines without self-shadow (A). ``surface``: lit by its
        normals (B). ``field``: the surface lit by the field alone (C). ``conditioned``: by the
        field, with the self-shadow of the surface (D, Banks 6). Each panel takes the options that
        apply to it; with ``model="cylinder"`` the highlight of the surface is Blinn's.

    Raises
    ------
    TypeError, ValueError
        As :func:`vizlight.illuminate` and :func:`vizlight.streamlines`.
    """
    options = SatinOptions.of(locals() | {"surface": None})
    if options.tangents is None:
        raise _check.value_error("tangents", "the name of a point array", None)
    traced, averaged = surface, False
    if isinstance(surface, pv.DataSet):
        name = str(options.tangents)
        averaged = is_of_cells(surface, name)
        if averaged:
            # Means over cells have no sign.
            rows = tangents_of(surface, name, 3)
            traced = surface.copy(deep=False)
            traced.point_data[name] = rows
        # Components are checked where they are traced.
        if "," not in name or name in traced.point_data:
            vectors_of(traced, "tangents", name, 3)
    field = LightOptions.of(vars(options) | {"conditioned": False})
    panels = {
        "surface": dataclasses.replace(field, tangents=None, model=field.for_surface().model),
        # Beside tangents without a self-shadow normals and sides would be refused.
        "field": dataclasses.replace(field, normals=None, facing="auto"),
        "conditioned": dataclasses.replace(field, conditioned=True),
    }
    # Options of streamlines, which the record of the curves names.
    lines = StreamlineOptions.of(
        vars(options)
        | {
            "line_field": options.line_field or averaged,
            "conditioned": False,
            "normals": None,
            "facing": "auto",
        }
    )
    curves = light_lines(traced, scene, lines, progress_bar=progress_bar, argument="surface")
    lit_panels = {
        name: light_mesh(surface, scene, panel, progress_bar=progress_bar)
        for name, panel in panels.items()
    }
    return pv.MultiBlock({"curves": curves, **lit_panels})
