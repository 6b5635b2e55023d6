"""The view of a scene, and the fading of light with depth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeGuard

import numpy as np

from vizlight import _check
from vizlight._types import Array, Color, ColorLike, Vector, VectorLike
from vizlight.scene.keywords import named

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkCamera

__all__ = ["DepthCue", "View"]

#: Component along z of a direction toward the eye, of length 1, from which y is up by default.
STEEP = 0.9
#: Sine of the angle between up and the direction toward the eye, up to which they are parallel.
LEAST_SINE = 1e-6


@dataclass(frozen=True, init=False)
class View:
    """Position and direction of the eye.

    Parameters
    ----------
    position : vector of n components, optional
        Position of the eye, in the unit of the mesh. A view with a position is a perspective
        view unless ``parallel=True``.
    direction : vector of n components, optional
        Direction toward the eye, of any length except 0. Without a position the view is parallel
        and depth is measured from the origin; with a position, depth is measured from it along this
        axis.
    parallel : bool, optional
        Whether the view is parallel. Default: True if no position is given, otherwise False.
    up : vector of n components, optional
        Direction that is up in the picture, of any length except 0, not parallel to ``direction``.
        Lights that follow the view turn with it. Default in 3-space: the z axis, or the y axis
        where the view is within 26 degrees of the z axis.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit, a parallel view has no direction, or a perspective view has no
        position.
    """

    position: Vector | None
    direction: Vector | None
    parallel: bool
    up: Vector | None

    @named
    def __init__(
        self,
        *,
        position: VectorLike | None = None,
        direction: VectorLike | None = None,
        parallel: bool | None = None,
        up: VectorLike | None = None,
    ) -> None:
        position = _check.optional_vector("position", position)
        direction = _check.optional_vector("direction", direction, direction=True)
        up = _check.optional_vector("up", up, direction=True)
        if parallel is None:
            parallel = position is None
        parallel = _check.boolean("parallel", parallel)
        if position is None and direction is None:
            expected = "position= (perspective) or direction= (parallel)"
            raise _check.value_error("View", expected, "neither")
        if parallel and direction is None:
            expected = "the direction toward the eye of a parallel view"
            raise _check.value_error("direction", expected, None)
        if not parallel and position is None:
            expected = "the eye's position of a perspective view"
            raise _check.value_error("position", expected, None)
        n = len(position or direction or ())
        for name, other in (("direction", direction), ("up", up)):
            if other is not None and len(other) != n:
                expected = f"{n} components like {'position' if position else 'direction'}"
                raise _check.value_error(name, expected, len(other))
        if up is not None and direction is not None and _parallel(up, direction):
            expected = "a direction that is not parallel to direction="
            raise _check.value_error("up", expected, up)
        _check.set_fields(self, position=position, direction=direction, parallel=parallel, up=up)

    @classmethod
    def isometric(cls, n: int = 3) -> View:
        """Return the view from infinity along (1, ..., 1), PyVista's isometric view.

        It stands in for the view of a scene that has none.

        Parameters
        ----------
        n : int, default: 3
            Dimension of the space.

        Returns
        -------
        View

        Raises
        ------
        TypeError, ValueError
            If n is no whole number of at least 2.
        """
        return cls(direction=(1.0,) * _check.integer("n", n, low=2))

    def axes(self) -> Array:
        """Return the frame of the eye.

        In n-space up is the third axis as far as it stands across the direction of the view, and
        right is in the space of the first three axes as far as it can. In the plane up is 0.

        Returns
        -------
        ndarray, shape (3, n)
            Unit vectors to the right, up and toward the eye, one per row, orthogonal within 4 eps.

        Raises
        ------
        ValueError
            If the view has no direction.
        """
        if self.direction is None:
            expected = "a view with a direction, by which a light beside the eye turns"
            remedy = "pass View(direction=), or View.from_camera(camera)"
            raise _check.value_error("view", expected, self, remedy)
        toward = unit(self.direction)
        n = len(toward)
        if n == 2:
            # Right is a quarter turn clockwise from the direction toward the eye.
            return np.stack([np.array([toward[1], -toward[0]]), np.zeros(2), toward])
        # Seen along z, z cannot be up: y takes its place.
        up = np.eye(n)[1 if abs(toward[2]) > STEEP else 2] if self.up is None else unit(self.up)
        if n == 3:
            # The two cross products remove the part of up that lies along the view.
            right = unit(_across(np.cross(up, toward), toward[np.newaxis]))
            return np.stack([right, np.cross(toward, right), toward])
        up = unit(_across(up, toward[np.newaxis]))
        # The axis with most left gives right, so that its digits do not cancel.
        sides = [_across(axis, np.stack([toward, up])) for axis in np.eye(n)[:3]]
        right = unit(max(sides, key=lambda side: float(np.linalg.norm(side))))
        # In the first three axes right, up and toward the eye are to be right-handed.
        turn = float(np.linalg.det(np.stack([right, up, toward])[:, :3]))
        return np.stack([-right if turn < 0 else right, up, toward])

    @classmethod
    def from_camera(cls, camera: vtkCamera) -> View:
        """Return the view of a camera.

        Parameters
        ----------
        camera : pyvista.Camera or vtkCamera
            Camera; its current position, direction and up are read.

        Returns
        -------
        View

        Raises
        ------
        TypeError
            If the argument is not a camera.
        ValueError
            If its eye is at its focal point, as far from the origin as float64 tells none apart.
        """
        if not is_camera(camera):
            raise TypeError(_no_camera("camera", "a pyvista.Camera or vtkCamera", camera))
        if not any(camera.GetDirectionOfProjection()):
            got, remedy = f"both at {camera.GetPosition()}", "move the mesh to the origin"
            raise _check.value_error("camera", "an eye away from its focal point", got, remedy)
        # VTK's direction goes from the eye into the scene, one of a view toward the eye.
        direction = tuple(-x for x in camera.GetDirectionOfProjection())
        up = tuple(camera.GetViewUp())
        return cls(
            position=tuple(camera.GetPosition()),
            direction=direction,
            parallel=bool(camera.GetParallelProjection()),
            # VTK keeps an up that has no meaning, and draws by another one.
            up=None if _parallel(up, direction) else up,
        )


@dataclass(frozen=True, init=False)
class DepthCue:
    """Fading of light with depth: ``S I + (1 - S) Icue`` (Lecture, atmospheric attenuation).

    Parameters
    ----------
    front, back : float, optional
        Depths between which the scale S goes from ``front_scale`` to ``back_scale``. Depth is
        the distance from the eye, along the direction of the view if it has one. Default: the
        smallest and largest depth of the points of the mesh.
    front_scale, back_scale : float, default: 1.0, 0.0
        Scale S at front and back, and beyond them, in [0, 1].
    cue : float, default: 0.0
        Intensity Icue that replaces the light as S decreases, from 0 to 1e9.
    color : (r, g, b) or str, optional
        Channels of the cue in the array ``rgb``. Default: white.
    smooth : bool, default: False
        Whether S follows a smooth step instead of a straight line.

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

    @named
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
            smooth=_check.boolean("smooth", smooth),
        )
        # The scale goes from one depth to the other, and is undefined where both are one.
        if self.front is not None and self.front == self.back:
            raise _check.value_error("front", "a depth other than back", self.front)


def as_view(view: View | vtkCamera | None) -> View | None:
    """Return a view or None as it is, or the view of a camera."""
    if view is None or isinstance(view, View):
        return view
    if is_camera(view):
        return View.from_camera(view)
    raise TypeError(_no_camera("view", "a vizlight.View, a camera or None", view))


def _no_camera(name: str, expected: str, value: object) -> str:
    """Return the message for a value that is no camera; a plotter has one."""
    remedy = "pass its .camera" if is_camera(getattr(value, "camera", None)) else ""
    return _check.message(name, expected, _check.describe(value), remedy)


def is_camera(value: object) -> TypeGuard[vtkCamera]:
    """Return whether a value has the methods of a VTK camera that a view needs."""
    names = ("GetPosition", "GetDirectionOfProjection", "GetParallelProjection", "GetViewUp")
    return all(hasattr(value, name) for name in names)


def unit(vector: VectorLike) -> Array:
    """Return a vector other than 0 with length 1, whatever its size."""
    v = np.asarray(vector, dtype=np.float64)
    # Squares of tiny or huge components would leave float64.
    v = v / np.abs(v).max()
    return np.asarray(v / np.linalg.norm(v))


def _across(vector: Array, rows: Array) -> Array:
    """Return the part of a vector across orthonormal rows."""
    # Twice, since cancellation lays bare a rest along the rows.
    for _ in range(2):
        vector = vector - rows.T @ (rows @ vector)
    return vector


def _parallel(a: Vector, b: Vector) -> bool:
    """Return whether two directions other than 0 lie on one line, within rounding."""
    u, v = unit(a), unit(b)
    return bool(np.linalg.norm(u - (u @ v) * v) < LEAST_SINE)
