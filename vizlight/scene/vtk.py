"""A material as a VTK property and back: the same highlight where VTK's law allows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vizlight import _check
from vizlight.model import highlights
from vizlight.scene.light import WHITE, Light, as_lights
from vizlight.scene.view import View

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vizlight._types import Color, Vector

Law = Literal["phong", "blinn"]
#: VTK clamps the power to this.
LARGEST_POWER = 128.0
#: Of half the angle between light and eye: beyond, there is hardly a half vector.
LEAST_COSINE = 2.5e-4
#: A highlight that may be off by more than this many pixel values of 255 is worth a warning.
TELLING = 2.0


def vtk_law(lights: Sequence[Light]) -> Law:
    """Return the law of VTK's specular term: Blinn for one headlight alone, Phong otherwise.

    A light of intensity 0 counts: VTK asks only which lights are switched on.
    """
    return "blinn" if len(lights) == 1 and lights[0].follows_view else "phong"


def to_property(
    *,
    ambient: float,
    diffuse: float,
    specular: float,
    shininess: float,
    color: Color | None,
    specular_color: Color | None,
    lights: Any,
    view: View | None,
    model: str,
) -> Any:
    """Return the ``pyvista.Property`` of a material; see :meth:`vizlight.Material.to_property`."""
    import pyvista as pv

    given = _lights(lights)
    _check_view(view)
    coefficients = {"ambient": ambient, "diffuse": diffuse, "specular": specular}
    for name, value in coefficients.items():
        if value > 1:
            remedy = "make the lights brighter instead"
            raise ValueError(_check.message(name, "at most 1, as VTK has it", value, remedy))
    law, power = vtk_law(given), shininess
    if _law(model) != law:
        angle = _angle(given, view)
        power = _exchanged(power, angle, model)
    shown = min(power, LARGEST_POWER)
    _warn_of_error(specular, shininess, given, view, model, shown)
    made = pv.Property(
        **coefficients,
        specular_power=shown,
        interpolation="phong",
        lighting=True,
    )
    # VTK's own setters: PyVista's round colours to 8 bits.
    for paint in (made.SetAmbientColor, made.SetDiffuseColor):
        paint(*(color or WHITE))
    made.SetSpecularColor(*(specular_color or WHITE))
    return made


def property_values(source: Any, *, lights: Any, view: View | None, model: str) -> dict[str, Any]:
    """Return the material of a property, by name; see :meth:`vizlight.Material.from_property`."""
    if not hasattr(source, "GetSpecularPower"):
        raise TypeError(
            _check.message("source", "a pyvista.Property or vtkProperty", _check.describe(source))
        )
    given = _lights(lights)
    _check_view(view)
    power = float(source.GetSpecularPower())
    if _law(model) != vtk_law(given):
        power = _exchanged(power, _angle(given, view), "phong" if model == "blinn" else "blinn")
    own = (source.GetDiffuseColor, source.GetSpecularColor)
    colors = [tuple(float(channel) for channel in get()) for get in own]
    if tuple(source.GetAmbientColor()) != colors[0]:
        _check.warn("the property's ambient colour is not its diffuse one, which is kept for both")
    return {
        "ambient": source.GetAmbient(),
        "diffuse": source.GetDiffuse(),
        "specular": source.GetSpecular(),
        "shininess": power,
        "color": None if colors[0] == WHITE else colors[0],
        "specular_color": None if colors[1] == WHITE else colors[1],
    }


def _lights(lights: Any) -> tuple[Light, ...]:
    """Return the lights that are given, one headlight by default."""
    given = as_lights(Light.headlight() if lights is None else lights)
    for light in given:
        n = len(light.direction or light.position or ()) or 3
        if n != 3:
            raise ValueError(_check.message("lights", "vectors of 3 components, VTK's", n))
    return given


def _check_view(view: Any) -> None:
    _check.instance("view", view, View, optional=True)


def _law(model: str) -> str:
    if model not in ("phong", "blinn"):
        raise ValueError(
            _check.message("model", "'phong' or 'blinn', which VTK can come near", repr(model))
        )
    return model


def _angle(lights: Sequence[Light], view: View | None) -> float:
    """Return the angle from the eye to the brightest light, 0 where it is not known."""
    far = [light for light in lights if light.direction is not None]
    if not far or view is None or view.direction is None:
        return 0.0
    brightest = max(far, key=lambda light: light.intensity)
    a, b = (np.asarray(v, dtype=np.float64) for v in (brightest.direction, view.direction))
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    return 2 * float(np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)))


def _exchanged(power: float, angle: float, model: str) -> float:
    """Return the power of the other law for one of a model, rising with it and inverted by it.

    By :func:`highlights.simple_factor` corrected for Phong's power r, ``q = c (r + e)``, and
    below its range, r = 1/2, in proportion.
    """
    cosine = max(float(np.cos(angle / 2)), LEAST_COSINE)
    least, factor = 0.5, float(highlights.simple_factor(2 * np.arccos(cosine)))
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
    """Warn by how much VTK's highlight can be off, where that can be seen."""
    law = vtk_law(lights)
    if not lights or not specular or (law == model and shown == wanted):
        return
    remedy = ""
    if law != model:
        phong, blinn = (wanted, shown) if model == "phong" else (shown, wanted)
        if phong == 0:
            return
        angle = _angle(lights, view)
        error = abs(float(highlights.max_pixel_error(angle, phong, factor=blinn / phong).error))
        if law == "blinn":
            remedy = (
                "; VTK takes Blinn's law with exactly one light switched on, a headlight, and "
                "Phong's otherwise: a second light of intensity 0 is enough"
            )
    else:
        # The same law with a clamped power: x^a - x^b is largest where both slopes are equal.
        x = (shown / wanted) ** (1 / (wanted - shown))
        error = 255 * abs(x**wanted - x**shown)
    error *= specular * max(light.intensity for light in lights)
    if error > TELLING:
        _check.warn(
            f"VTK lights this scene by {law}'s law of power {shown:.4g}: its highlight can differ "
            f"by {error:.1f} of 255 from {model}'s of {wanted:g}{remedy}"
        )


def lights_of(lights: Iterable[Any], camera: Any) -> Iterable[Light]:
    """Yield the VTK lights that are on; what moves with the camera stays where it is now.

    Only headlights at infinity go on following the view.
    """
    for light in lights:
        if not light.GetSwitch():
            continue
        channels = tuple(light.GetDiffuseColor())
        common: dict[str, Any] = {
            "intensity": light.GetIntensity(),
            "color": None if channels == WHITE else channels,
        }
        if light.LightTypeIsHeadlight() and not light.GetPositional():
            yield Light.headlight(**common)
            continue
        if light.LightTypeIsHeadlight():
            position, target = tuple(camera.GetPosition()), tuple(camera.GetFocalPoint())
        elif light.LightTypeIsCameraLight():
            matrix = camera.GetCameraLightTransformMatrix()
            position = _transform(matrix, light.GetPosition())
            target = _transform(matrix, light.GetFocalPoint())
        else:
            position = tuple(light.GetTransformedPosition())
            target = tuple(light.GetTransformedFocalPoint())
        if light.GetPositional():
            if light.GetConeAngle() < 90:
                _check.warn(
                    f"a spotlight of cone angle {light.GetConeAngle():g} degrees lights in all "
                    "directions in vizlight"
                )
            yield Light(position=position, attenuation=light.GetAttenuationValues(), **common)
        else:
            toward = tuple(p - t for p, t in zip(position, target, strict=True))
            if any(toward):
                yield Light(direction=toward, **common)
            else:
                _check.warn(
                    f"a light at {position} whose focal point is its position shines nowhere"
                )


def _transform(matrix: Any, point: Vector) -> Vector:
    x = (*point, 1.0)
    rows = [sum(matrix.GetElement(i, j) * x[j] for j in range(4)) for i in range(4)]
    return tuple(row / rows[3] for row in rows[:3])
