"""Conversion of materials to and from VTK properties, and of VTK lights to lights."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Literal, TypeAlias, TypeGuard

import numpy as np

from vizlight import _check
from vizlight._types import Color, Keywords, Vector
from vizlight.scene.light import WHITE, Light, default_lights
from vizlight.scene.view import View, as_view, is_camera

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkCamera, vtkLight, vtkProperty

    AnyLight: TypeAlias = Light | vtkLight
    Lights: TypeAlias = AnyLight | Iterable[AnyLight] | None
    AnyView: TypeAlias = View | vtkCamera | None

ReflectionModel = Literal["phong", "blinn"]
#: Upper limit of the specular power in VTK.
LARGEST_POWER = 128.0
#: Lower limit for the cosine of half the angle between light and eye, where the half vector
#: vanishes.
LEAST_COSINE = 2.5e-4
#: Constant of an attenuation below which a lamp of VTK is taken to have this one: a point that
#: gets a thousand times the intensity of its lamp is white in any case.
LEAST_CONSTANT = 1e-3
#: Error of a highlight, in pixel values from 0 to 255, above which a warning is given.
VISIBLE_ERROR = 2.0


def vtk_model(lights: Sequence[Light]) -> ReflectionModel:
    """Return the reflection model of VTK: Blinn for a single headlight, Phong otherwise.

    A light of intensity 0 counts as a light, because VTK considers only the switch of a light.
    """
    return "blinn" if len(lights) == 1 and lights[0].is_headlight else "phong"


def to_property(values: Keywords, *, lights: Lights, view: AnyView, model: str) -> pv.Property:
    """Return the ``pyvista.Property`` of a material; see :meth:`vizlight.Material.to_property`."""
    import pyvista as pv

    lamps, view = _check_lights(lights, view), as_view(view)
    coefficients = {name: values[name] for name in ("ambient", "diffuse", "specular")}
    for name, value in coefficients.items():
        if value > 1:
            remedy = "make the lights brighter instead"
            raise _check.value_error(name, "at most 1, the limit of VTK", value, remedy)
    power = values["shininess"]
    # VTK takes its model from the lights and has no switch for it, so that the power must change.
    if _check_model(model) != vtk_model(lamps):
        power = _converted(power, _angle(lamps, view), model)
    shown = min(power, LARGEST_POWER)
    _warn_of_error(values["specular"], values["shininess"], lamps, view, model, shown)
    prop = pv.Property(
        **coefficients,
        specular_power=shown,
        # Here the name tells how normals are interpolated, not which model of reflection VTK takes.
        interpolation="phong",
        lighting=True,
    )
    # VTK's own setters, because PyVista's round colours to 8 bits.
    for set_color in (prop.SetAmbientColor, prop.SetDiffuseColor):
        set_color(*(values["color"] or WHITE))
    prop.SetSpecularColor(*(values["specular_color"] or WHITE))
    return prop


def property_values(source: vtkProperty, *, lights: Lights, view: AnyView, model: str) -> Keywords:
    """Return the fields of a property's material; see :meth:`vizlight.Material.from_property`."""
    if not hasattr(source, "GetSpecularPower"):
        raise _check.type_error("source", "a pyvista.Property or vtkProperty", source)
    lamps, view = _check_lights(lights, view), as_view(view)
    shown = power = float(source.GetSpecularPower())
    if _check_model(model) != vtk_model(lamps):
        # The other way round: VTK's is the model that the power comes from.
        power = _converted(power, _angle(lamps, view), "phong" if model == "blinn" else "blinn")
    _warn_of_error(source.GetSpecular(), power, lamps, view, model, shown)
    if tuple(source.GetAmbientColor()) != tuple(source.GetDiffuseColor()):
        _check.warn(
            "the ambient colour of the property differs from its diffuse colour, which is used "
            "for both"
        )
    return {
        "ambient": source.GetAmbient(),
        "diffuse": source.GetDiffuse(),
        "specular": source.GetSpecular(),
        "shininess": power,
        "color": _color(source.GetDiffuseColor()),
        "specular_color": _color(source.GetSpecularColor()),
    }


def _color(channels: Sequence[float]) -> Color | None:
    """Return the colour with given channels, or None for white, which is the default."""
    r, g, b = (float(channel) for channel in channels)
    return None if (r, g, b) == WHITE else (r, g, b)


def all_lights(lights: Lights, view: AnyView) -> tuple[Light, ...]:
    """Return lights, or the default ones; lights of VTK and PyVista are converted."""
    if lights is None:
        return default_lights(as_view(view))
    # An array of NumPy without dimensions has the method of an iterable, but cannot be iterated.
    several = isinstance(lights, Iterable) and getattr(lights, "ndim", 1) > 0
    if isinstance(lights, str) or not (several or isinstance(lights, Light) or _is_vtk(lights)):
        expected = "a vizlight.Light, a pyvista.Light or a sequence of them"
        raise _check.type_error("lights", expected, lights)
    converted: list[Light] = []
    for light in lights if isinstance(lights, Iterable) else [lights]:
        if _is_vtk(light):
            converted += _fixed(light, view)
        else:
            _check.instance("lights", light, Light, remedy="Light(direction=(1, 1, 1)) makes one")
            assert isinstance(light, Light)
            converted.append(light)
    return tuple(converted)


def _fixed(light: vtkLight, view: AnyView) -> tuple[Light, ...]:
    """Return a light of VTK as one of this package, none if it is switched off."""
    # At infinity such a light follows any view; where a lamp is only the camera itself tells.
    moves = light.LightTypeIsCameraLight() or light.LightTypeIsHeadlight()
    if moves and light.GetPositional() and not is_camera(view):
        expected, got = "a pyvista.Camera as view= beside a lamp that moves with it", view
        remedy = "or take both by Scene.from_plotter(plotter)"
        raise _check.value_error("lights", expected, got, remedy)
    return tuple(lights_of([light], view if is_camera(view) else None))


def _is_vtk(light: object) -> TypeGuard[vtkLight]:
    """Return whether something is a light of VTK, such as a pyvista.Light."""
    return hasattr(light, "LightTypeIsHeadlight") and hasattr(light, "GetSwitch")


def _check_lights(lights: Lights, view: AnyView) -> tuple[Light, ...]:
    """Return the lights, or the default ones, after checking that they are in 3-space."""
    lamps = all_lights(lights, view)
    for light in lamps:
        # A headlight has neither, and is in any space.
        n = len(light.direction or light.position or ()) or 3
        if n != 3:
            raise _check.value_error("lights", "vectors of 3 components, as in VTK", n)
    return lamps


def _check_model(model: str) -> str:
    if not (isinstance(model, str) and model in ("phong", "blinn")):
        expected = "'phong' or 'blinn', which VTK can approximate"
        raise _check.value_error("model", expected, _check.describe(model))
    return model


def _angle(lights: Sequence[Light], view: View | None) -> float:
    """Return the angle between the eye and the brightest light at infinity, or 0 if unknown."""
    if view is None or view.direction is None:
        return 0.0
    # A headlight has the angle 0, and a lamp at a place a different one at each point.
    beside = [light.seen_from(view) for light in lights if not light.is_headlight]
    distant = [light for light in beside if light.direction is not None]
    if not distant:
        return 0.0
    brightest = max(distant, key=lambda light: light.intensity)
    a, b = (np.asarray(v, dtype=np.float64) for v in (brightest.direction, view.direction))
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    # An arccos would lose half of the digits near 0 and pi.
    return 2 * float(np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)))


def _converted(power: float, angle: float, model: str) -> float:
    """Convert a power of one reflection model to the other; increasing, and exactly invertible.

    :func:`highlights.simple_factor`, corrected for Phong's power r, gives ``q = c (r + e)``.
    Below the validity of the correction, r = 1/2, the conversion is proportional.
    """
    from vizlight.model import highlights

    # Half the angle between light and eye is beta, for which the factor is 4 cos(beta).
    cosine = max(float(np.cos(angle / 2)), LEAST_COSINE)
    least, factor = 0.5, float(highlights.simple_factor(2 * np.arccos(cosine)))
    # Blinn's power where Phong's is 1/2: both parts of the conversion meet there.
    low = least * float(highlights.simple_factor(2 * np.arccos(cosine), least))
    if model == "phong":
        return low + factor * (power - least) if power > least else power * low / least
    return least + (power - low) / factor if power > low else power * least / low


def _warn_of_error(
    specular: float,
    wanted: float,
    lights: Sequence[Light],
    view: View | None,
    model: str,
    shown: float,
) -> None:
    """Warn if the highlight of VTK can differ visibly, and say by how much."""
    from vizlight.model import highlights

    used = vtk_model(lights)
    if not lights or not specular or (used == model and shown == wanted):
        return
    if used == model:
        # Only the power differs, and x^a - x^b is largest where both slopes are equal.
        x = (shown / wanted) ** (1 / (wanted - shown))
        error = 255 * abs(x**wanted - x**shown)
    else:
        phong, blinn = (wanted, shown) if model == "phong" else (shown, wanted)
        # Both powers are 0 then, and the term is a constant in either model.
        if phong == 0:
            return
        bound = highlights.max_pixel_error(_angle(lights, view), phong, factor=blinn / phong)
        error = abs(float(bound.error))
    # Errors so far are for a coefficient and an intensity of 1.
    error *= specular * max(light.intensity for light in lights)
    if error <= VISIBLE_ERROR:
        return
    remedy = ""
    if used != model and used == "blinn":
        remedy = (
            "; VTK uses the Blinn model if exactly one light is switched on and it is a "
            "headlight, otherwise the Phong model; add a second light of intensity 0, or light "
            "by model='blinn'"
        )
    _check.warn(
        f"VTK lights this scene with the {used.capitalize()} model and power {shown:.4g}; its "
        f"highlight can differ by {error:.1f} of 255 from the highlight of the "
        f"{model.capitalize()} model with power {wanted:g}{remedy}"
    )


def is_light_kit(lights: Iterable[vtkLight], /) -> bool:
    """Return whether lights are VTK's light kit as it is, with which PyVista's plotters begin."""
    from vtkmodules.vtkRenderingCore import vtkLight, vtkLightKit, vtkRenderer

    # VTK itself makes the kit, so that its numbers are not copied here.
    renderer = vtkRenderer()
    vtkLightKit().AddLightsToRenderer(renderer)
    kit = renderer.GetLights()
    every = (vtkLight.SafeDownCast(kit.GetItemAsObject(i)) for i in range(kit.GetNumberOfItems()))
    return sorted(map(_kind, lights)) == sorted(map(_kind, every))


def _kind(light: vtkLight) -> tuple[float, ...]:
    """Return the kind of a light in numbers; a headlight is at the eye wherever it was last put."""
    place = () if light.LightTypeIsHeadlight() else (*light.GetPosition(), *light.GetFocalPoint())
    numbers = (
        light.GetLightType(), light.GetSwitch(), light.GetPositional(), light.GetIntensity(),
        *light.GetDiffuseColor(), *place,
    )  # fmt: skip
    # PyVista keeps colours as bytes.
    return tuple(round(float(x), 2) for x in numbers)


def lights_of(lights: Iterable[vtkLight], camera: vtkCamera | None) -> Iterator[Light]:
    """Yield the VTK lights that are switched on.

    Headlights and camera lights at infinity continue to follow the view. Other lights that move
    with the camera are fixed at their current position.
    """
    for light in lights:
        if not light.GetSwitch():
            continue
        # Of a light's three colours VTK's shaders take the diffuse one.
        intensity, color = light.GetIntensity(), _color(light.GetDiffuseColor())
        if light.LightTypeIsHeadlight() and not light.GetPositional():
            yield Light.headlight(intensity=intensity, color=color)
            continue
        follows = bool(light.LightTypeIsCameraLight() and not light.GetPositional())
        if follows:
            # What VTK transforms is in the frame of the camera.
            position, target = tuple(light.GetPosition()), tuple(light.GetFocalPoint())
        else:
            position, target = _position_and_target(light, camera)
        # VTK's light shines from its position to its focal point; a direction here goes toward the
        # light.
        toward = tuple(p - t for p, t in zip(position, target, strict=True))
        if light.GetPositional():
            # From 90 degrees on VTK draws a positional light without a cone.
            if light.GetConeAngle() < 90:
                _check.warn(
                    f"vizlight takes a spotlight of cone angle {light.GetConeAngle():g} degrees as "
                    "a light that shines in all directions"
                )
            coefficients = light.GetAttenuationValues()
            # VTK does not clamp its attenuation, which is at most 1 / c1.
            most = 1 / min(max(coefficients[0], LEAST_CONSTANT), 1.0)
            yield Light.unclamped(
                position=position, attenuation=coefficients, most=most, intensity=intensity,
                color=color,
            )  # fmt: skip
        elif any(toward):
            yield Light(direction=toward, intensity=intensity, color=color, follows_view=follows)
        else:
            _check.warn(
                f"a light at {position} is left out, because its focal point is its position and "
                "so it has no direction"
            )


def _position_and_target(light: vtkLight, camera: vtkCamera | None) -> tuple[Vector, Vector]:
    """Return the position and the focal point of a light in the coordinates of the scene."""
    from vtkmodules.vtkRenderingCore import vtkLight

    # A headlight is at the camera, wherever the light says that it was put.
    if camera is not None and light.LightTypeIsHeadlight():
        return tuple(camera.GetPosition()), tuple(camera.GetFocalPoint())
    if camera is not None and light.LightTypeIsCameraLight():
        # VTK turns a light with the camera when it draws; a copy does not have to wait for it.
        placed = vtkLight()
        placed.DeepCopy(light)
        placed.SetTransformMatrix(camera.GetCameraLightTransformMatrix())
        light = placed
    return tuple(light.GetTransformedPosition()), tuple(light.GetTransformedFocalPoint())
