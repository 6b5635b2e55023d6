"""What a picture is lit by: lights, material, view. Plain values, no VTK.

Directions point away from the lit point: toward the light, toward the eye.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.light import Light, as_lights, from_vtk

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._check import Color, ColorLike, Vector, VectorLike

__all__ = ["DepthCue", "Material", "Scene", "View"]


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
        from vizlight._property import to_property

        return to_property(self, lights, view, model)

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
        from vizlight._property import from_property

        material: Material = from_property(cls, source, lights, view, model)
        return material


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
        if not _is_camera(camera):
            remedy = "pass its .camera" if _is_camera(getattr(camera, "camera", None)) else ""
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
        Ia of the Lecture, unitless, from 0 to 1e9.
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
        lights = as_lights(Light.headlight() if lights is None else lights)
        _check.instance("material", material, Material, optional=True)
        remedy = "View.from_camera(camera) makes one of it" if _is_camera(view) else ""
        _check.instance("view", view, View, optional=True, remedy=remedy)
        _check.instance("depth_cue", depth_cue, DepthCue, optional=True)
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

    def moved(self, offset: Sequence[float], /) -> Scene:
        """Return the scene with lights and eye moved by an offset; depths stay as they are."""
        lights = tuple(
            dataclasses.replace(light, position=tuple(np.add(light.position, offset)))
            if light.position is not None
            else light
            for light in self.lights
        )
        view = self.view
        if view is not None:
            position = offset if view.position is None else np.add(view.position, offset)
            view = View(position=position, direction=view.direction, parallel=view.parallel)
        return self.replace(lights=lights, view=view)

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as plain values that JSON can hold."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Scene:
        """Return the scene that :meth:`to_dict` wrote.

        Raises
        ------
        TypeError, ValueError
            If it is another dict, or the values are not those of a scene.
        """
        parts = _fields("values", values, cls)
        if parts.get("lights") is not None:
            lights = parts["lights"]
            if isinstance(lights, str | Mapping) or not isinstance(lights, Iterable):
                raise TypeError(
                    _check.message("lights", "a list of dicts", _check.describe(lights))
                )
            parts["lights"] = [Light(**_fields("lights", light, Light)) for light in lights]
        for name, kind in (("material", Material), ("view", View), ("depth_cue", DepthCue)):
            if parts.get(name) is not None:
                parts[name] = kind(**_fields(name, parts[name], kind))
        return cls(**parts)

    @classmethod
    def from_plotter(cls, plotter: Any, **fields: Any) -> Scene:
        """Return the scene of a PyVista plotter: its camera and its lights that are on.

        Camera lights and headlights with a position are fixed where they stand now; headlights
        at infinity go on following the view. A spotlight lights in all directions here, which a
        warning says.

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
        fields.setdefault("lights", list(from_vtk(renderer.GetLights(), camera)))
        return cls(**fields)


def _fields(name: str, values: Any, kind: Any) -> dict[str, Any]:
    """Return the fields of a class that :meth:`Scene.to_dict` wrote, by name."""
    known = [field.name for field in dataclasses.fields(kind)]
    expected = f"a dict of {', '.join(known)}"
    if not isinstance(values, Mapping):
        raise TypeError(_check.message(name, expected, _check.describe(values)))
    for key in values:
        if key not in known:
            raise ValueError(_check.message(name, expected, repr(key)))
    return dict(values)


def _is_camera(value: Any) -> bool:
    """Tell whether a value has what a view is made of."""
    names = ("GetPosition", "GetDirectionOfProjection", "GetParallelProjection")
    return all(hasattr(value, name) for name in names)
