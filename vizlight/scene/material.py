"""How much light a manifold gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vizlight import _check
from vizlight.scene import vtk

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vizlight._types import Color, ColorLike
    from vizlight.scene.light import Light
    from vizlight.scene.view import View

__all__ = ["Material"]


@dataclass(frozen=True, init=False)
class Material:
    """How much light a manifold gives back.

    Parameters
    ----------
    ambient, diffuse, specular : float
        ka, kd and ks, unitless, from 0 to 1e9.
    shininess : float, default: 20.0
        The power of the specular term, from 0 to 1e9.
    color : (r, g, b) or str, optional
        Channels of the ambient and the diffuse light, one for each wavelength; with it the
        array ``rgb`` is made.
    specular_color : (r, g, b) or str, optional
        Channels of the highlight; white when not given.

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

    def __init__(
        self,
        *,
        ambient: float = 0.1,
        diffuse: float = 0.5,
        specular: float = 0.4,
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
        lights: Light | Iterable[Light] | None = None,
        view: View | None = None,
        model: str = "phong",
    ) -> Any:
        """Return the ``pyvista.Property`` with which VTK shows this material's highlight.

        Parameters
        ----------
        lights : Light or sequence of Light, optional
            Of the scene that VTK will light, all of them: they decide its law. Default: one
            headlight, as in :class:`Scene`.
        view : View, optional
            With a direction it tells the angle between light and eye, which an exchange between
            the laws depends on.
        model : {"phong", "blinn"}
            The law that ``shininess`` belongs to in vizlight.

        Returns
        -------
        pyvista.Property
            For surfaces; its power is exchanged where VTK's law is not the model's.

        Raises
        ------
        TypeError, ValueError
            If an argument does not fit, or a coefficient is above 1, which VTK clamps.

        Warns
        -----
        UserWarning
            If VTK's highlight can differ by more than 2 of 255: it has no law between, and
            clamps the power to 128.

        Notes
        -----
        What VTK 9 does: with exactly one light, a headlight at infinity, its specular term is
        ``(N . view axis)^power``, Blinn's; with any other lights, several headlights or a second
        light of intensity 0 among them, Phong's, and the eye is at the camera's position **also
        under a parallel projection**.
        The same scene here thus has a perspective view, or the camera is far away.
        """
        return vtk.to_property(
            ambient=self.ambient,
            diffuse=self.diffuse,
            specular=self.specular,
            shininess=self.shininess,
            color=self.color,
            specular_color=self.specular_color,
            lights=lights,
            view=view,
            model=model,
        )

    @classmethod
    def from_property(
        cls,
        source: Any,
        /,
        *,
        lights: Light | Iterable[Light] | None = None,
        view: View | None = None,
        model: str = "phong",
    ) -> Material:
        """Return the material of a ``pyvista.Property`` or ``vtkProperty``.

        Parameters
        ----------
        source : pyvista.Property or vtkProperty
        lights, view, model
            As for :meth:`to_property`, of which this is the inverse.

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
            If the ambient colour is not the diffuse one, which stands for both here.
        """
        return cls(**vtk.property_values(source, lights=lights, view=view, model=model))
