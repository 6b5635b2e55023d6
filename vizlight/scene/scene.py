"""The scene of one picture."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypedDict

import numpy as np

from vizlight import _check
from vizlight._types import Color, ColorLike, Keywords, VectorLike
from vizlight.scene import conversion
from vizlight.scene.keywords import named
from vizlight.scene.light import Light
from vizlight.scene.material import Material
from vizlight.scene.view import DepthCue, View, as_view

if TYPE_CHECKING:
    import pyvista as pv
    from typing_extensions import Unpack

__all__ = ["Scene"]


class SceneKeywords(TypedDict, total=False):
    """The fields of a scene, as its keyword arguments."""

    lights: conversion.Lights
    material: Material | None
    view: conversion.AnyView
    ambient_intensity: float
    ambient_color: ColorLike | None
    depth_cue: DepthCue | None
    exposure: float | None


@dataclass(frozen=True, init=False)
class Scene:
    """Lights, material, view and depth cue of one picture.

    Parameters
    ----------
    lights : Light or sequence of Light, optional
        Lights of the scene. Default: a white lamp over the left shoulder and a weaker one at the
        eye, which turn with the view, as of :func:`vizlight.presets.value`. A ``pyvista.Light``
        is taken as a Light; one that has a position and moves with the camera needs that camera
        as ``view``.
    material : Material, optional
        Material of the lit manifold. Default: ``Material()``.
    view : View or pyvista.Camera, optional
        View of the scene, required for a depth cue. Without a view the highlight is left out, and
        anything else that depends on the eye, such as lights that follow the view, is as from
        :meth:`View.isometric`.
    ambient_intensity : float, default: 1.0
        Intensity Ia of the ambient light (Lecture), unitless, from 0 to 1e9. ``occlusion=`` of
        :func:`vizlight.illuminate` varies it with the place.
    ambient_color : (r, g, b) or str, optional
        Channels of the ambient light in the array ``rgb``. Default: white.
    depth_cue : DepthCue, optional
        Fading of the light with depth. Default: none.
    exposure : float, optional
        Factor of the light that is shown, above 0 and up to 1e9. With it the result has the array
        ``rgb`` of the exposed light: the factor times the light up to 0.8, above that with a soft
        knee that stays below 1, with the same chromaticity. ``luminance`` and the terms stay as
        they are. :func:`vizlight.shading.display.exposure_of` returns a factor. Default: none, the
        light is shown as it is.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, or vectors differ in their number of components.
    """

    lights: tuple[Light, ...]
    material: Material
    view: View | None
    ambient_intensity: float
    ambient_color: Color | None
    depth_cue: DepthCue | None
    exposure: float | None

    @named
    def __init__(
        self,
        *,
        lights: conversion.Lights = None,
        material: Material | None = None,
        view: conversion.AnyView = None,
        ambient_intensity: float = 1.0,
        ambient_color: ColorLike | None = None,
        depth_cue: DepthCue | None = None,
        exposure: float | None = None,
    ) -> None:
        # Lights first: a lamp that moves with a camera needs it as given, not the view made of it.
        lights, view = conversion.all_lights(lights, view), as_view(view)
        _check.instance("material", material, Material, optional=True)
        _check.instance("depth_cue", depth_cue, DepthCue, optional=True)
        if exposure is not None:
            exposure = _check.positive("exposure", exposure, high=_check.LARGEST)
        _check.set_fields(
            self,
            lights=lights,
            material=Material() if material is None else material,
            view=view,
            ambient_intensity=_check.number(
                "ambient_intensity", ambient_intensity, low=0.0, high=_check.LARGEST
            ),
            ambient_color=_check.color("ambient_color", ambient_color),
            depth_cue=depth_cue,
            exposure=exposure,
        )
        # Light is computed from products of these vectors, which must be of one space.
        sizes = _sizes(lights, view)
        if len(sizes) > 1:
            raise _check.value_error("Scene", "vectors of one space", f"{sorted(sizes)} components")

    @property
    def n(self) -> int | None:
        """Dimension of the space of lights and view, or None if no vector determines it."""
        return next(iter(_sizes(self.lights, self.view)), None)

    @property
    def colored(self) -> bool:
        """Whether any part of the scene has a colour, or the scene an exposure."""
        owners = (self.material, *self.lights, self.depth_cue)
        return (
            self.exposure is not None
            or self.ambient_color is not None
            or self.material.specular_color is not None
            or any(getattr(owner, "color", None) is not None for owner in owners)
        )

    def replace(self, **changes: Unpack[SceneKeywords]) -> Scene:
        """Return a copy of the scene with some fields changed."""
        return Scene(**{**vars(self), **changes})

    def moved(self, offset: VectorLike, /) -> Scene:
        """Return the scene translated by an offset; depths from the eye do not change.

        Raises
        ------
        TypeError, ValueError
            If the offset is not one finite vector with as many components as the scene's vectors.
        """
        offset = _check.vector("offset", offset)
        if self.n not in (None, len(offset)):
            expected = f"{self.n} components, as the vectors of the scene have"
            raise _check.value_error("offset", expected, len(offset))
        # A light at infinity has no place that could move.
        lights = tuple(
            dataclasses.replace(light, position=tuple(np.add(light.position, offset)))
            if light.position is not None
            else light
            for light in self.lights
        )
        view = self.view
        if view is not None:
            # A view without a position measures depth from the origin, which moves along.
            position = offset if view.position is None else np.add(view.position, offset)
            view = dataclasses.replace(view, position=tuple(position))
        return self.replace(lights=lights, view=view)

    def to_dict(self) -> dict[str, object]:
        """Return the scene as nested dicts and tuples of plain values, for JSON."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, object]) -> Scene:
        """Return the scene that :meth:`to_dict` returned as a dict.

        Parameters
        ----------
        values : dict
            Fields of the scene, as returned by :meth:`to_dict`. Lists may replace tuples.

        Returns
        -------
        Scene

        Raises
        ------
        TypeError, ValueError
            If a key is unknown, or a value does not fit.
        """
        parts = _fields("values", values, cls)
        if parts.get("lights") is not None:
            lights = parts["lights"]
            # The first two can be iterated as well, by letters and by keys.
            if isinstance(lights, str | Mapping) or not isinstance(lights, Iterable):
                expected, got = "a list of dicts", _check.describe(lights)
                raise TypeError(_check.message("values, lights", expected, got))
            parts["lights"] = [Light(**_fields("lights", light, Light)) for light in lights]
        kinds: dict[str, type[Material] | type[View] | type[DepthCue]] = {
            "material": Material, "view": View, "depth_cue": DepthCue,
        }  # fmt: skip
        for name, kind in kinds.items():
            if parts.get(name) is not None:
                parts[name] = kind(**_fields(name, parts[name], kind))
        return cls(**parts)

    @classmethod
    def from_plotter(
        cls,
        plotter: pv.Plotter,
        *,
        actor: pv.Actor | None = None,
        model: str = "phong",
        **fields: Unpack[SceneKeywords],
    ) -> Scene:
        """Return the scene of a PyVista plotter: its camera and the lights that are switched on.

        Headlights and camera lights at infinity continue to follow the view. Other lights that
        move with the camera are fixed at their current position. A spotlight becomes a light that
        shines in all directions, with a warning.

        Parameters
        ----------
        plotter : pyvista.Plotter
            Plotter; its active renderer is read. If its camera is not set yet, it is set as
            ``show`` would set it.
        actor : pyvista.Actor, optional
            Actor of the plotter that gives the scene its material; its light then matches VTK's
            within 3 of 255 under perspective. VTK computes the highlight of a lone headlight as if
            the eye were at infinity: the view of the scene is then parallel. An actor that is
            coloured by data gives no colour of the material: its picture is the data colours times
            the light without highlight, plus the highlight.
        model : {"phong", "blinn"}, default: "phong"
            Reflection model by which the actor's mesh will be lit; VTK's is Blinn's with a single
            headlight, else Phong's, see :meth:`Material.to_property`. A warning is given if the
            highlight of VTK differs visibly in this model.
        **fields
            Further fields of the scene, such as ``material=``.

        Returns
        -------
        Scene

        Raises
        ------
        TypeError, ValueError
            If the argument is not a plotter, the actor has no property, or both actor and material
            are given.

        Notes
        -----
        In parallel projection VTK computes highlights as if the eye were at the position of the
        camera, except the highlight of a lone headlight. The scene has the eye at infinity, as the
        picture shows it, and highlights of other lights differ from VTK's.
        """
        renderer = getattr(plotter, "renderer", None)
        if renderer is None or not hasattr(renderer, "GetLights"):
            raise _check.type_error("plotter", "a pyvista.Plotter", plotter)
        # To read it makes PyVista set a camera that is not set yet, as its show does.
        camera, own_view = plotter.camera, "view" not in fields
        seen = View.from_camera(camera)
        fields.setdefault("view", seen)
        fields.setdefault("lights", list(conversion.lights_of(renderer.GetLights(), camera)))
        if actor is not None:
            if "material" in fields:
                raise _check.value_error("material", "an actor alone", "both")
            lights, view = fields["lights"], fields["view"]
            fields["material"] = _of_actor(actor, lights, view, model)
            # A lone headlight's highlight is as from an eye at infinity in VTK.
            if own_view and conversion.vtk_model(conversion.all_lights(lights, view)) == "blinn":
                fields["view"] = dataclasses.replace(seen, parallel=True)
        return cls(**fields)


def _sizes(lights: Iterable[Light], view: View | None) -> set[int]:
    """Return the numbers of components of vectors of a space; the frame of the eye is none."""
    # A direction in the frame of the eye says nothing about the space of the mesh.
    owners = [*(light for light in lights if not light.follows_view), view]
    return {
        len(v)
        for owner in owners
        if owner is not None
        for v in (owner.position, owner.direction)
        if v is not None
    }


def _of_actor(
    actor: pv.Actor, lights: conversion.Lights, view: conversion.AnyView, model: str
) -> Material:
    """Return the material of an actor; where data colour it, without a colour of its own."""
    mapper = actor.GetMapper() if hasattr(actor, "GetMapper") else None
    if mapper is None or not hasattr(actor, "GetProperty"):
        raise _check.type_error("actor", "a pyvista.Actor", actor)
    actor_property = drawn = actor.GetProperty()
    if mapper.GetScalarVisibility():
        drawn = type(actor_property)()
        drawn.DeepCopy(actor_property)
        # Where data colour an actor its own colour is not drawn; SetColor sets all of its colours,
        # so the highlight's is put back.
        drawn.SetColor(1.0, 1.0, 1.0)
        drawn.SetSpecularColor(*actor_property.GetSpecularColor())
    return Material.from_property(drawn, lights=lights, view=view, model=model)


def _fields(
    name: str,
    values: object,
    kind: type[Scene] | type[Light] | type[Material] | type[View] | type[DepthCue],
) -> Keywords:
    """Return the keyword arguments of a class, which validates their values, from a dict."""
    names = [field.name for field in dataclasses.fields(kind)]
    expected = f"a dict of {', '.join(names)}"
    if not isinstance(values, Mapping):
        raise _check.type_error(name, expected, values)
    for key in values:
        if key not in names:
            raise _check.value_error(name, expected, repr(key))
    return dict(values)
