"""Point lights at a position or at infinity."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from vizlight import _check
from vizlight._types import Array, Color, ColorLike, Vector, VectorLike
from vizlight.model import falloff
from vizlight.scene.keywords import named
from vizlight.scene.view import View

__all__ = ["Light"]

WHITE = (1.0, 1.0, 1.0)
NO_ATTENUATION, INVERSE_SQUARE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@dataclass(frozen=True, init=False, repr=False)
class Light:
    """A point light at a position or at infinity.

    Parameters
    ----------
    direction : vector of n components, optional
        Direction toward a light at infinity, of any length except 0. With ``follows_view`` it is
        in the frame of the eye in 3-space: x to the right, y up, z toward the eye.
    position : vector of n components, optional
        Position of the light, in the unit of the mesh.
    intensity : float, default: 1.0
        Intensity, unitless, from 0 to 1e9.
    attenuation : (c1, c2, c3), default: (1, 0, 0)
        Coefficients of ``min(1, 1/(c1 + c2 d + c3 d^2))``, where d is the distance from the
        point to a light with a position (Lecture, effect of distance);
        :meth:`unclamped` is without the bound of 1.
    color : (r, g, b) or str, optional
        Channels that scale the intensity in the array ``rgb``. They do not affect luminance.
    follows_view : bool, default: False
        Whether the light turns with the eye, like a camera light of VTK:
        ``Light(direction=(-1, 1, 1), follows_view=True)`` shines over the left shoulder. Without
        a direction, or along ``(0, 0, 1)``, it is a headlight; see :meth:`headlight`.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, or not exactly one of direction and position is given. A
        light that follows the view has no position.

    See Also
    --------
    Light.headlight : Light in the direction of the eye.
    Light.unclamped : Lamp by ``1 / d^2`` itself, as VTK has it.
    Light.seen_from : Light where a view has it.
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
        if self.follows_view and not self.is_headlight:
            parts.append("follows_view=True")
        return f"Light{'.headlight' if self.is_headlight else ''}({', '.join(parts)})"

    @named
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
        if self.follows_view:
            self._check_following()
        elif (self.direction is None) == (self.position is None):
            expected, got = "either direction= (toward the light) or position=", "both"
            remedy = "Light.headlight() makes a light that follows the view"
            if self.direction is None:
                got = "neither"
            raise _check.value_error("Light", expected, got, remedy)
        if self.direction is not None and self.attenuation != NO_ATTENUATION:
            expected = "(1, 0, 0) for a light at infinity, which has no distance"
            remedy = "give the light a position="
            raise _check.value_error("attenuation", expected, self.attenuation, remedy)

    def _check_following(self) -> None:
        """Check a light that follows the view; a direction toward the eye makes a headlight."""
        if self.position is not None:
            expected = "no position with follows_view=True"
            remedy = "pass direction= in the frame of the eye: x right, y up, z toward the eye"
            raise _check.value_error("position", expected, self.position, remedy)
        if self.direction is None:
            return
        if len(self.direction) != 3:
            expected = "3 components with follows_view=True, in the frame of the eye"
            raise _check.value_error("direction", expected, len(self.direction))
        x, y, z = self.direction
        # z of the eye's frame is toward the eye: kept as None, a headlight has one form only.
        if x == y == 0 and z > 0:
            _check.set_fields(self, direction=None)

    @property
    def is_headlight(self) -> bool:
        """Whether the light shines from the eye, or from infinity in its direction."""
        return self.follows_view and self.direction is None

    @classmethod
    def headlight(cls, *, intensity: float = 1.0, color: ColorLike | None = None) -> Light:
        """Return a light that shines from the eye and follows the view.

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

    @classmethod
    def unclamped(
        cls,
        *,
        position: VectorLike,
        intensity: float = 1.0,
        attenuation: VectorLike = INVERSE_SQUARE,
        most: float = 1000.0,
        color: ColorLike | None = None,
    ) -> Light:
        """Return a lamp by ``1 / d^2``, brighter than its intensity where a point is near.

        The attenuation of a light is at most 1, also at a distance of 0, where ``1 / d^2`` has no
        bound. Here the bound is ``most``: the law holds at all distances where it is below that.

        Parameters
        ----------
        position : vector of n components
            Position of the light, in the unit of the mesh.
        intensity : float, default: 1.0
            Intensity, unitless: the light at a distance of 1 where the attenuation is ``1 / d^2``.
        attenuation : (c1, c2, c3), default: (0, 0, 1)
            Coefficients of ``min(most, 1/(c1 + c2 d + c3 d^2))``.
        most : float, default: 1000.0
            Bound, above 0. ``1 / d^2`` is below it at distances above ``1 / sqrt(most)``.
        color : (r, g, b) or str, optional
            Channels that scale the intensity in the array ``rgb``.

        Returns
        -------
        Light
            Light of the intensity ``most * intensity``, at most 1e9, with all coefficients times
            ``most``.

        Raises
        ------
        TypeError, ValueError
            If a value does not fit.

        Notes
        -----
        VTK and OpenGL have no bound: a plotter's lamps are read with one of 1000, or of ``1 / c1``.
        """
        most = _check.positive("most", most, high=_check.LARGEST)
        coefficients = np.multiply(falloff.attenuation("attenuation", attenuation), most)
        intensity = _check.number("intensity", intensity, low=0.0, high=_check.LARGEST / most)
        return cls(
            position=position, intensity=most * intensity, attenuation=coefficients, color=color
        )

    @classmethod
    def linear(
        cls,
        start: VectorLike,
        end: VectorLike,
        /,
        *,
        lamps: int = 6,
        intensity: float = 1.0,
        attenuation: VectorLike = NO_ATTENUATION,
        color: ColorLike | None = None,
    ) -> tuple[Light, ...]:
        """Return lamps that stand for a light that is a segment, such as a tube of neon.

        Parameters
        ----------
        start, end : vector of n components
            Ends of the segment, in the unit of the mesh.
        lamps : int, default: 6
            Number of lamps, from 1 to 64.
        intensity : float, default: 1.0
            Intensity of the whole segment, unitless.
        attenuation, color
            As for a light; the distance is that to a lamp.

        Returns
        -------
        tuple of Light
            Lights for ``Scene(lights=...)``: at the nodes of Gauss and Legendre on the segment, the
            weights of which share out the intensity.

        Raises
        ------
        TypeError, ValueError
            If a value does not fit.

        Notes
        -----
        Without attenuation, at distances from half the length on, the diffuse light of six lamps is
        within 1e-5 of the mean over the segment where all of it is above the horizon, and within
        0.01 where a part is below. Source: Isoluminance, footnote 1, which names linear lights
        without a formula.
        """
        count = _check.integer("lamps", lamps, low=1, high=64)
        intensity = _check.number("intensity", intensity, low=0.0, high=_check.LARGEST)
        first, last = (
            np.array(_check.vector(name, value)) for name, value in (("start", start), ("end", end))
        )
        if len(first) != len(last):
            expected = f"{len(first)} components, as start has"
            raise _check.value_error("end", expected, f"{len(last)}")
        places, weights = np.polynomial.legendre.leggauss(count)
        return tuple(
            cls(
                position=first * ((1 - place) / 2) + last * ((1 + place) / 2),
                intensity=intensity * weight / 2,
                attenuation=attenuation,
                color=color,
            )
            for place, weight in zip(places.tolist(), weights.tolist(), strict=True)
        )

    def seen_from(self, view: View | None, *, n: int = 3) -> Light:
        """Return the light with the fixed direction or position that it has in a view.

        Parameters
        ----------
        view : View or None
            View that the light follows. None: :meth:`View.isometric`. A light that does not follow
            the view is returned as it is.
        n : int, default: 3
            Dimension of the space of a headlight without a view.

        Returns
        -------
        Light

        Raises
        ------
        TypeError
            If the view is not a :class:`vizlight.View`.
        ValueError
            If a light beside the eye follows a view without a direction.
        """
        _check.instance("view", view, View, optional=True)
        if not self.follows_view:
            return self
        if view is None:
            view = View.isometric(n)
        direction = view.direction
        if self.direction is not None:
            # Scaled first, as products of huge components might leave float64.
            scale = max(map(abs, self.direction))
            direction = tuple(np.divide(self.direction, scale) @ view.axes())
        # A perspective view without a direction has no axis: its headlight is at the eye itself.
        position = view.position if direction is None else None
        return dataclasses.replace(self, follows_view=False, direction=direction, position=position)


#: Azimuth and altitude in the frame of the eye of the lamp over the left shoulder, in degrees, from
#: right toward up and toward the eye, and the intensities of it and of the lamp at the eye.
SHOULDER, KEY, FILL = (125.0, 45.0), 0.8, 0.3


def of_eye(azimuth: float, altitude: float) -> Array:
    """Return a unit direction of the eye's frame: x right, y up, z toward the eye.

    Its angles are in degrees: azimuth from right toward up, altitude toward the eye.
    """
    a, h = math.radians(azimuth), math.radians(altitude)
    return np.array([math.cos(h) * math.cos(a), math.cos(h) * math.sin(a), math.sin(h)])


def default_lights(view: View | None) -> tuple[Light, ...]:
    """Return the lights of a scene that names none: a lamp over the shoulder and one at the eye.

    No normal and no tangent has more than 1 of their diffuse light; the study of legibility
    measures its readers. A view without a direction has no shoulder: one lamp at the eye.
    """
    if view is not None and view.direction is None:
        return (Light.headlight(),)
    # sum(w |wi_N|) is at most sqrt(W sum(w |wi_N|^2)); of two lamps the least eigenvalue of
    # sum(w L L^T) is 0, for a tangent across both, so that the bound is W.
    white = KEY + FILL
    return (
        Light(direction=of_eye(*SHOULDER), follows_view=True, intensity=KEY / white),
        Light.headlight(intensity=FILL / white),
    )
