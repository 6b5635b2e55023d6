"""Where the eye is, and how light fades with depth from there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vizlight import _check

if TYPE_CHECKING:
    from vizlight._types import Color, ColorLike, Vector, VectorLike

__all__ = ["DepthCue", "View"]


@dataclass(frozen=True, init=False)
class View:
    """Where the eye is.

    Parameters
    ----------
    position : vector of n components, optional
        The eye, in the unit of the mesh. Alone, or with a direction: a perspective view.
    direction : vector of n components, optional
        Toward the eye; any length but 0. Alone: a parallel view, depth measured from the origin.
        With a position: the axis along which depth is measured.
    parallel : bool, optional
        Default: whether no position is given. ``True`` with a position and a direction is a
        parallel view whose depth is measured from the position.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, or what the view needs is not given.
    """

    position: Vector | None
    direction: Vector | None
    parallel: bool

    def __init__(
        self,
        *,
        position: VectorLike | None = None,
        direction: VectorLike | None = None,
        parallel: bool | None = None,
    ) -> None:
        position = _check.optional_vector("position", position)
        direction = _check.optional_vector("direction", direction, direction=True)
        parallel = position is None if parallel is None else bool(parallel)
        if position is None and direction is None:
            raise ValueError(
                _check.message(
                    "View", "position= (perspective) or direction= (parallel)", "neither"
                )
            )
        if parallel and direction is None:
            raise ValueError(
                _check.message("direction", "the direction toward the eye of a parallel view", None)
            )
        if not parallel and position is None:
            raise ValueError(
                _check.message("position", "the eye's position of a perspective view", None)
            )
        if position is not None and direction is not None and len(position) != len(direction):
            raise ValueError(
                _check.message(
                    "direction", f"{len(position)} components, as position has", len(direction)
                )
            )
        _check.set_fields(self, position=position, direction=direction, parallel=parallel)

    @classmethod
    def from_camera(cls, camera: Any) -> View:
        """Return the view of a ``pyvista.Camera`` or ``vtkCamera``.

        Raises
        ------
        TypeError
            If it is not a camera.
        """
        if not is_camera(camera):
            remedy = "pass its .camera" if is_camera(getattr(camera, "camera", None)) else ""
            expected = "a pyvista.Camera or vtkCamera"
            raise TypeError(_check.message("camera", expected, _check.describe(camera), remedy))
        return cls(
            position=tuple(camera.GetPosition()),
            direction=tuple(-x for x in camera.GetDirectionOfProjection()),
            parallel=bool(camera.GetParallelProjection()),
        )


@dataclass(frozen=True, init=False)
class DepthCue:
    """Fade with depth: ``S I + (1 - S) Icue`` (Lecture, atmospheric attenuation).

    Parameters
    ----------
    front, back : float, optional
        Depths (distance from the eye, along the view's axis where it has one) between which
        the scale goes from ``front_scale`` to ``back_scale``. On a mesh they default to the
        nearest and farthest depth of its points.
    front_scale, back_scale : float
        The scale S at and beyond front and back, in [0, 1].
    cue : float, default: 0.0
        The intensity that fades in.
    color : (r, g, b) or str, optional
        Channels of the cue in ``rgb``; white when not given.
    smooth : bool, default: False
        A smooth step in place of a straight line.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.
    """

    front: float | None
    back: float | None
    front_scale: float
    back_scale: float
    cue: float
    color: Color | None
    smooth: bool

    def __init__(
        self,
        *,
        front: float | None = None,
        back: float | None = None,
        front_scale: float = 1.0,
        back_scale: float = 0.0,
        cue: float = 0.0,
        color: ColorLike | None = None,
        smooth: bool = False,
    ) -> None:
        _check.set_fields(
            self,
            front=None if front is None else _check.number("front", front),
            back=None if back is None else _check.number("back", back),
            front_scale=_check.number("front_scale", front_scale, low=0.0, high=1.0),
            back_scale=_check.number("back_scale", back_scale, low=0.0, high=1.0),
            cue=_check.number("cue", cue, low=0.0, high=_check.LARGEST),
            color=_check.color("color", color),
            smooth=bool(smooth),
        )
        if self.front is not None and self.front == self.back:
            raise ValueError(_check.message("front", "a depth other than back", self.front))


def is_camera(value: Any) -> bool:
    """Tell whether a value has what a view is made of."""
    names = ("GetPosition", "GetDirectionOfProjection", "GetParallelProjection")
    return all(hasattr(value, name) for name in names)
