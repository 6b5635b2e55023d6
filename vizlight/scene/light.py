"""Point lights at a position or at infinity."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vizlight import _check
from vizlight.model import falloff
from vizlight.scene.keywords import keywords_only
from vizlight.scene.view import View

if TYPE_CHECKING:
    from vizlight._types import Color, ColorLike, Vector, VectorLike

__all__ = ["Light"]

WHITE = (1.0, 1.0, 1.0)
NO_ATTENUATION = (1.0, 0.0, 0.0)


@dataclass(frozen=True, init=False, repr=False)
class Light:
    """A point light at a position or at infinity.

    Parameters
    ----------
    direction : vector of n components, optional
        Direction toward a light at infinity, of any length except 0.
    position : vector of n components, optional
        Position of the light, in the unit of the mesh.
    intensity : float, default: 1.0
        Intensity, unitless, from 0 to 1e9.
    attenuation : (c1, c2, c3), default: (1, 0, 0)
        Coefficients of ``min(1, 1/(c1 + c2 d + c3 d^2))``, where d is the distance from the
        point to a light with a position. (Lecture, effect of distance.)
    color : (r, g, b) or str, optional
        Channels that scale the intensity in the array ``rgb``. They do not affect luminance.
    follows_view : bool, default: False
        Whether the light is a headlight, which takes its direction or position from the view;
        see :meth:`headlight`.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, or not exactly one of direction and position is given. A
        headlight has neither.

    See Also
    --------
    Light.headlight : Light that follows the view.
    """

    direction: Vector | None
    position: Vector | None
    intensity: float
    attenuation: tuple[float, float, float]
    color: Color | None
    follows_view: bool

    def __repr__(self) -> str:
        """Return the call that creates the light, without default values."""
        shown = {"direction": self.direction, "position": self.position, "color": self.color}
        parts = [f"{name}={value}" for name, value in shown.items() if value is not None]
        if self.intensity != 1:
            parts.append(f"intensity={self.intensity:g}")
        if self.attenuation != NO_ATTENUATION:
            parts.append(f"attenuation={self.attenuation}")
        return f"Light{'.headlight' if self.follows_view else ''}({', '.join(parts)})"

    @keywords_only
    def __init__(
        self,
        *,
        direction: VectorLike | None = None,
        position: VectorLike | None = None,
        intensity: float = 1.0,
        attenuation: VectorLike = NO_ATTENUATION,
        color: ColorLike | None = None,
        follows_view: bool = False,
    ) -> None:
        _check.set_fields(
            self,
            direction=_check.optional_vector("direction", direction, direction=True),
            position=_check.optional_vector("position", position),
            intensity=_check.number("intensity", intensity, low=0.0, high=_check.LARGEST),
            attenuation=falloff.attenuation("attenuation", attenuation),
            color=_check.color("color", color),
            follows_view=_check.boolean("follows_view", follows_view),
        )
        given = sum(x is not None for x in (self.direction, self.position))
        if given != (0 if self.follows_view else 1):
            raise ValueError(
                _check.message(
                    "Light",
                    "neither direction= nor position= with follows_view=True"
                    if self.follows_view
                    else "either direction= (toward the light) or position=",
                    ("neither", "one of them", "both")[given],
                    "Light.headlight() makes a light that follows the view",
                )
            )
        if self.direction is not None and self.attenuation != NO_ATTENUATION:
            raise ValueError(
                _check.message(
                    "attenuation",
                    "(1, 0, 0) for a light at infinity, which has no distance",
                    self.attenuation,
                    "give the light a position=",
                )
            )

    @classmethod
    def headlight(cls, *, intensity: float = 1.0, color: ColorLike | None = None) -> Light:
        """Return a light that follows the view.

        In a view with a direction it is at infinity in that direction, as in VTK. In a
        perspective view without a direction it is at the position of the eye.

        Parameters
        ----------
        intensity : float, default: 1.0
            Intensity, unitless, from 0 to 1e9.
        color : (r, g, b) or str, optional
            Channels that scale the intensity in the array ``rgb``.

        Returns
        -------
        Light
        """
        return cls(intensity=intensity, color=color, follows_view=True)

    def seen_from(self, view: View | None) -> Light:
        """Return the light with a fixed direction or position, which a headlight has from a view.

        Parameters
        ----------
        view : View or None
            View that a headlight follows. A light that is not a headlight does not need it.

        Returns
        -------
        Light

        Raises
        ------
        TypeError
            If the view is not a :class:`vizlight.View`.
        ValueError
            If the light is a headlight and there is no view.
        """
        _check.instance("view", view, View, optional=True)
        if not self.follows_view:
            return self
        if view is None:
            raise ValueError(
                _check.message("view", "a View, which the headlight follows", None, "pass view=")
            )
        position = view.position if view.direction is None else None
        return dataclasses.replace(
            self, follows_view=False, direction=view.direction, position=position
        )


def as_lights(lights: object) -> tuple[Light, ...]:
    """Return one light or several lights as a tuple.

    Raises
    ------
    TypeError
        If the argument is neither a light nor a sequence of lights.
    """
    if isinstance(lights, str) or not isinstance(lights, Light | Iterable):
        raise TypeError(
            _check.message(
                "lights",
                "a vizlight.Light, a pyvista.Light or a sequence of them",
                _check.describe(lights),
            )
        )
    several = (lights,) if isinstance(lights, Light) else tuple(lights)
    for light in several:
        _check.instance("lights", light, Light, remedy="Light(direction=(1, 1, 1)) makes one")
    return several
