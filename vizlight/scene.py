"""What a picture is lit by: lights, material, view. Plain values, no VTK.

Directions point away from the lit point: toward the light, toward the eye.
"""

from __future__ import annotations

import dataclasses
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from vizlight import _check
from vizlight.model import falloff

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    VectorLike: TypeAlias = Sequence[float] | NDArray[np.floating[Any]]
    ColorLike: TypeAlias = str | VectorLike | Any

Vector = tuple[float, ...]
Color = tuple[float, float, float]
WHITE: Color = (1.0, 1.0, 1.0)
NO_ATTENUATION = (1.0, 0.0, 0.0)


def _set(instance: object, **values: object) -> None:
    """Set validated fields of a frozen dataclass."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)


def _instance(name: str, value: object, kind: type, *, optional: bool = False) -> None:
    if not (isinstance(value, kind) or (optional and value is None)):
        expected = f"a vizlight.{kind.__name__}" + (" or None" if optional else "")
        raise TypeError(_check.message(name, expected, _check.describe(value)))


def _vector(name: str, value: object, *, direction: bool = False) -> Vector | None:
    return None if value is None else _check.vector(name, value, direction=direction)


def _color(name: str, value: Any) -> Color | None:
    """Return three channels from numbers, a colour's name or hex, or a ``pyvista.Color``."""
    if value is None:
        return None
    if isinstance(value, str):
        import pyvista as pv

        try:
            value = pv.Color(value).float_rgb
        except ValueError as error:
            raise ValueError(
                _check.message(name, "a colour's name, '#rrggbb' or (r, g, b)", repr(value))
            ) from error
    return _check.rgb(name, getattr(value, "float_rgb", value))


@dataclass(frozen=True, init=False)
class Light:
    """A point light, far away or near.

    Parameters
    ----------
    direction : vector of n components, optional
        Toward the light, for a light at infinity; any length but 0.
    position : vector of n components, optional
        Where the light stands, in the unit of the mesh.
    intensity : float, default: 1.0
        Unitless, 0 or more.
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
        _set(
            self,
            direction=_vector("direction", direction, direction=True),
            position=_vector("position", position),
            intensity=_check.number("intensity", intensity, low=0.0),
            attenuation=falloff.attenuation("attenuation", attenuation),
            color=_color("color", color),
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


@dataclass(frozen=True, init=False)
class Material:
    """How much light a manifold gives back.

    Parameters
    ----------
    ambient, diffuse, specular : float
        ka, kd and ks, unitless, 0 or more.
    shininess : float, default: 20.0
        The power of the specular term, 0 or more.
    color : (r, g, b) or str, optional
        Channels of the ambient and diffuse light (Od of the Lecture's wavelengths); with it
        the array ``rgb`` is made.
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
        _set(
            self,
            ambient=_check.number("ambient", ambient, low=0.0),
            diffuse=_check.number("diffuse", diffuse, low=0.0),
            specular=_check.number("specular", specular, low=0.0),
            shininess=_check.number("shininess", shininess, low=0.0),
            color=_color("color", color),
            specular_color=_color("specular_color", specular_color),
        )


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
        position = _vector("position", position)
        direction = _vector("direction", direction, direction=True)
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
        _set(self, position=position, direction=direction, parallel=parallel)

    @classmethod
    def from_camera(cls, camera: Any) -> View:
        """Return the view of a ``pyvista.Camera`` or ``vtkCamera``.

        Raises
        ------
        TypeError
            If it is not a camera.
        """
        for name in ("GetPosition", "GetDirectionOfProjection", "GetParallelProjection"):
            if not hasattr(camera, name):
                raise TypeError(
                    _check.message(
                        "camera", "a pyvista.Camera or vtkCamera", _check.describe(camera)
                    )
                )
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
        nearest and farthest depth of its bounding box.
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
        _set(
            self,
            front=None if front is None else _check.number("front", front),
            back=None if back is None else _check.number("back", back),
            front_scale=_check.number("front_scale", front_scale, low=0.0, high=1.0),
            back_scale=_check.number("back_scale", back_scale, low=0.0, high=1.0),
            cue=_check.number("cue", cue, low=0.0),
            color=_color("color", color),
            smooth=bool(smooth),
        )
        if self.front is not None and self.front == self.back:
            raise ValueError(_check.message("front", "a depth other than back", self.front))


@dataclass(frozen=True, init=False)
class Scene:
    """Lights, material and view of one picture.

    Parameters
    ----------
    lights : Light or sequence of Light, optional
        Default: one headlight.
    material : Material, optional
    view : View, optional
        Needed for the specular term, a headlight and a depth cue.
    ambient_intensity : float, default: 1.0
        Ia of the Lecture, unitless, 0 or more.
    ambient_color : (r, g, b) or str, optional
        Channels of the ambient light in ``rgb``.
    depth_cue : DepthCue, optional

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

    def __init__(
        self,
        *,
        lights: Light | Iterable[Light] | None = None,
        material: Material | None = None,
        view: View | None = None,
        ambient_intensity: float = 1.0,
        ambient_color: ColorLike | None = None,
        depth_cue: DepthCue | None = None,
    ) -> None:
        lights = Light.headlight() if lights is None else lights
        lights = (lights,) if isinstance(lights, Light) else tuple(lights)
        for light in lights:
            _instance("lights", light, Light)
        _instance("material", material, Material, optional=True)
        _instance("view", view, View, optional=True)
        _instance("depth_cue", depth_cue, DepthCue, optional=True)
        _set(
            self,
            lights=lights,
            material=Material() if material is None else material,
            view=view,
            ambient_intensity=_check.number("ambient_intensity", ambient_intensity, low=0.0),
            ambient_color=_color("ambient_color", ambient_color),
            depth_cue=depth_cue,
        )
        sizes = {
            len(v)
            for owner in (*lights, view)
            if owner is not None
            for v in (owner.position, owner.direction)
            if v is not None
        }
        if len(sizes) > 1:
            raise ValueError(
                _check.message("Scene", "vectors of one space", f"{sorted(sizes)} components")
            )

    @property
    def n(self) -> int | None:
        """The dimension of the space that lights and view live in, None where nothing says."""
        for owner in (*self.lights, self.view):
            for v in (owner.position, owner.direction) if owner is not None else ():
                if v is not None:
                    return len(v)
        return None

    @property
    def colored(self) -> bool:
        """Whether anything in the scene has a colour."""
        owners = (self.material, *self.lights, self.depth_cue)
        return (
            self.ambient_color is not None
            or self.material.specular_color is not None
            or any(getattr(owner, "color", None) is not None for owner in owners)
        )

    def replace(self, **changes: Any) -> Scene:
        """Return a scene with some fields changed."""
        return dataclasses.replace(self, **changes)

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as plain values that JSON can hold."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Scene:
        """Return the scene that :meth:`to_dict` wrote."""
        view, cue = values["view"], values["depth_cue"]
        return cls(
            **{
                **values,
                "lights": [Light(**light) for light in values["lights"]],
                "material": Material(**values["material"]),
                "view": None if view is None else View(**view),
                "depth_cue": None if cue is None else DepthCue(**cue),
            }
        )

    @classmethod
    def from_plotter(cls, plotter: Any, **fields: Any) -> Scene:
        """Return the scene of a PyVista plotter: its camera and its lights that are on.

        Camera lights are fixed where they stand now; headlights go on following the view. A
        spotlight lights in all directions here, which a warning says.

        Parameters
        ----------
        plotter : pyvista.Plotter
            Its active renderer is read. A camera that was not set yet is set as ``show`` would.
        **fields
            Further fields of the scene, ``material=`` among them.

        Raises
        ------
        TypeError
            If it is not a plotter.
        """
        renderer = getattr(plotter, "renderer", None)
        if renderer is None or not hasattr(renderer, "GetLights"):
            raise TypeError(
                _check.message("plotter", "a pyvista.Plotter", _check.describe(plotter))
            )
        camera = plotter.camera
        fields.setdefault("view", View.from_camera(camera))
        fields.setdefault("lights", list(_lights_of(renderer.GetLights(), camera)))
        return cls(**fields)


def _lights_of(lights: Iterable[Any], camera: Any) -> Iterable[Light]:
    for light in lights:
        if not light.GetSwitch():
            continue
        channels = tuple(light.GetDiffuseColor())
        common: dict[str, Any] = {
            "intensity": light.GetIntensity(),
            "color": None if channels == WHITE else channels,
        }
        if light.LightTypeIsHeadlight():
            yield Light.headlight(**common)
            continue
        if light.LightTypeIsCameraLight():
            matrix = camera.GetCameraLightTransformMatrix()
            position = _transform(matrix, light.GetPosition())
            target = _transform(matrix, light.GetFocalPoint())
        else:
            position = tuple(light.GetTransformedPosition())
            target = tuple(light.GetTransformedFocalPoint())
        if light.GetPositional():
            if light.GetConeAngle() < 90:
                warnings.warn(
                    f"a spotlight of cone angle {light.GetConeAngle():g} degrees lights in all "
                    "directions in vizlight",
                    stacklevel=4,
                )
            yield Light(position=position, attenuation=light.GetAttenuationValues(), **common)
        else:
            toward = tuple(p - t for p, t in zip(position, target, strict=True))
            yield Light(direction=toward, **common)


def _transform(matrix: Any, point: Vector) -> Vector:
    x = (*point, 1.0)
    rows = [sum(matrix.GetElement(i, j) * x[j] for j in range(4)) for i in range(4)]
    return tuple(row / rows[3] for row in rows[:3])
