"""A point light, far away or near, given by plain values or read from a VTK light."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vizlight import _check
from vizlight.model import falloff

if TYPE_CHECKING:
    from vizlight._types import Color, ColorLike, Vector, VectorLike
    from vizlight.scene.view import View

__all__ = ["Light"]

WHITE = (1.0, 1.0, 1.0)
NO_ATTENUATION = (1.0, 0.0, 0.0)


@dataclass(frozen=True, init=False, repr=False)
class Light:
    """A point light, far away or near.

    Parameters
    ----------
    direction : vector of n components, optional
        Toward the light, for a light at infinity; any length but 0.
    position : vector of n components, optional
        Where the light stands, in the unit of the mesh.
    intensity : float, default: 1.0
        Unitless, from 0 to 1e9.
    attenuation : (c1, c2, c3), default: (1, 0, 0)
        Coefficients of ``min(1, 1/(c1 + c2 d + c3 d^2))``; only a positional light has a
        distance d. (Lecture, effect of distance.)
    color : (r, g, b) or str, optional
        Channels that scale the intensity in the array ``rgb``; luminance has no colour.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, or not exactly one of direction and position is given.

    See Also
    --------
    Light.headlight : a light that follows the view.
    """

    direction: Vector | None
    position: Vector | None
    intensity: float
    attenuation: tuple[float, float, float]
    color: Color | None
    follows_view: bool

    def __repr__(self) -> str:
        """Say what differs from the defaults."""
        shown = {"direction": self.direction, "position": self.position, "color": self.color}
        parts = [f"{name}={value}" for name, value in shown.items() if value is not None]
        if self.intensity != 1:
            parts.append(f"intensity={self.intensity:g}")
        if self.attenuation != NO_ATTENUATION:
            parts.append(f"attenuation={self.attenuation}")
        return f"Light{'.headlight' if self.follows_view else ''}({', '.join(parts)})"

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
            follows_view=bool(follows_view),
        )
        given = sum(x is not None for x in (self.direction, self.position))
        if given != (0 if self.follows_view else 1):
            raise ValueError(
                _check.message(
                    "Light",
                    "either direction= (toward the light) or position=",
                    "both" if given == 2 else "neither",
                    "Light.headlight() follows the view",
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

        Under a parallel view, or a perspective one with a known axis, it shines along that axis
        from infinity, as VTK's does; under any other perspective view it sits in the eye.
        """
        return cls(intensity=intensity, color=color, follows_view=True)

    def seen_from(self, view: View | None) -> Light:
        """Return the light with its place fixed: a headlight's is taken from the view."""
        if not self.follows_view:
            return self
        if view is None:
            raise ValueError(
                _check.message("view", "a View, which the headlight follows", None, "pass view=")
            )
        if view.direction is not None:
            place: dict[str, Any] = {"direction": view.direction}
        else:
            place = {"position": view.position}
        return dataclasses.replace(self, follows_view=False, **place)


def as_lights(lights: Any) -> tuple[Light, ...]:
    """Return one light or several as a tuple.

    Raises
    ------
    TypeError
        If something else is given.
    """
    if isinstance(lights, str) or not isinstance(lights, Light | Iterable):
        raise TypeError(
            _check.message("lights", "vizlight.Light or several", _check.describe(lights))
        )
    several = (lights,) if isinstance(lights, Light) else tuple(lights)
    for light in several:
        _check.instance("lights", light, Light, remedy="Light(direction=(1, 1, 1)) makes one")
    return several
