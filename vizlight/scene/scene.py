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
from vizlight.scene import vtk
from vizlight.scene.light import Light, as_lights
from vizlight.scene.material import Material
from vizlight.scene.view import DepthCue, View, is_camera

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Color, ColorLike

__all__ = ["Scene"]


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
        remedy = "View.from_camera(camera) makes one of it" if is_camera(view) else ""
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
        fields.setdefault("lights", list(vtk.lights_of(renderer.GetLights(), camera)))
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
