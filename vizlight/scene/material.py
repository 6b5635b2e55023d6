"""Materials: the coefficients and colours of reflected light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vizlight import _check
from vizlight._types import Color, ColorLike
from vizlight.scene import conversion
from vizlight.scene.keywords import named

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkProperty

__all__ = ["Material"]


@dataclass(frozen=True, init=False)
class Material:
    """Coefficients and colours of the light that a manifold reflects.

    Parameters
    ----------
    ambient, diffuse, specular : float, default: 0.3, 0.7, 0.0
        Coefficients ka, kd and ks, unitless, from 0 to 1e9. White highlights hide colours below
        them, so the default is none; the study of legibility measures both.
    shininess : float, default: 20.0
        Power of the specular term, from 0 to 1e9.
    color : (r, g, b) or str, optional
        Channels of the ambient and diffuse light. A material with a colour adds the array
        ``rgb`` to the result.
    specular_color : (r, g, b) or str, optional
        Channels of the highlight. Default: white.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.
    """

    ambient: float
    diffuse: float
    specular: float
    shininess: float
    color: Color | None
    specular_color: Color | None

    @named
    def __init__(
        self,
        *,
        ambient: float = 0.3,
        diffuse: float = 0.7,
        specular: float = 0.0,
        shininess: float = 20.0,
        color: ColorLike | None = None,
        specular_color: ColorLike | None = None,
    ) -> None:
        _check.set_fields(
            self,
            ambient=_check.number("ambient", ambient, low=0.0, high=_check.LARGEST),
            diffuse=_check.number("diffuse", diffuse, low=0.0, high=_check.LARGEST),
            specular=_check.number("specular", specular, low=0.0, high=_check.LARGEST),
            shininess=_check.number("shininess", shininess, low=0.0, high=_check.LARGEST),
            color=_check.color("color", color),
            specular_color=_check.color("specular_color", specular_color),
        )

    def to_property(
        self,
        *,
        lights: conversion.Lights = None,
        view: conversion.AnyView = None,
        model: str = "phong",
    ) -> pv.Property:
        """Return the ``pyvista.Property`` with which VTK shows the highlight of this material.

        Parameters
        ----------
        lights : Light or sequence of Light, optional
            All lights of the scene that VTK will render; they determine the reflection model of
            VTK. Default: those of :class:`Scene`.
        view : View, optional
            View of the scene. Its direction determines the angle between light and eye, on which
            the conversion between the reflection models depends.
        model : {"phong", "blinn"}, default: "phong"
            Reflection model of vizlight to which ``shininess`` belongs.

        Returns
        -------
        pyvista.Property
            Property of a surface. Its power is converted if VTK uses the other reflection model.

        Raises
        ------
        TypeError, ValueError
            If an argument does not fit, or a coefficient exceeds 1, the upper limit of VTK.

        Warns
        -----
        UserWarning
            If VTK's highlight can differ by more than 2 of 255, because the conversion is
            approximate or because VTK limits the power to 128.

        Notes
        -----
        With exactly one light that is a headlight at infinity, VTK 9 uses the Blinn model: its
        specular term is ``(N . view axis)^power``. With any other lights, such as several
        headlights, or a headlight and a light of intensity 0, it uses the Phong model, and takes
        the eye to be at the position of the camera **even in parallel projection**. The
        equivalent scene in vizlight then has a perspective view, or the camera is far away.
        """
        return conversion.to_property(vars(self), lights=lights, view=view, model=model)

    @classmethod
    def from_property(
        cls,
        source: vtkProperty,
        /,
        *,
        lights: conversion.Lights = None,
        view: conversion.AnyView = None,
        model: str = "phong",
    ) -> Material:
        """Return the material of a VTK property; the inverse of :meth:`to_property`.

        Parameters
        ----------
        source : pyvista.Property or vtkProperty
            Property to read.
        lights, view, model
            Lights, view and reflection model, as for :meth:`to_property`.

        Returns
        -------
        Material

        Raises
        ------
        TypeError, ValueError
            If an argument does not fit.

        Warns
        -----
        UserWarning
            If the ambient and diffuse colours differ; the diffuse colour is used for both.
        """
        return cls(**conversion.property_values(source, lights=lights, view=view, model=model))
