"""Scenes by which a reader reads one thing back: direction, slope, heading, shape or value.

Their lamps turn with the eye, so that a colour means the same from all sides. Colours of lamps have
one luma, and their mean is white: hue and lightness tell different things.
:func:`vizlight.presets.key` draws their meaning.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias, cast

import numpy as np

from vizlight import _check
from vizlight._questions import QUESTIONS
from vizlight._types import Array
from vizlight.model.formulas import LUMA
from vizlight.scene.light import Light, of_eye
from vizlight.scene.material import Material
from vizlight.scene.scene import Scene
from vizlight.scene.view import View, as_view

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkCamera

    Eye: TypeAlias = View | vtkCamera | pv.BasePlotter | None

#: What stands for a scene: one, or the question of its preset.
AnyScene: TypeAlias = Scene | str

#: Ambient light of data without colours.
AMBIENT = 0.08
#: Hue of the first lamp, in degrees in the plane of equal luma, and azimuth of the first lamp, in
#: degrees from right toward up.
FIRST_HUE, FIRST_AZIMUTH = 60.0, 90.0


def direction(view: Eye = None, /) -> Scene:
    """Return a scene in which hue tells the direction of tangents on the screen.

    Three lamps in the picture plane have hues of equal luma, and a weaker white one is at the eye.
    A lamp in the picture plane sees ``cos(slope) cos(angle on the screen)`` of a tangent. With
    ``exponent=2`` hue is twice the angle on the screen exactly, however the tangent lies, but
    readers without green cones tell fewer angles apart; with the usual exponent a tangent that
    leaves the screen by 45 degrees or more shifts the answer by the disc by 5 degrees in the
    median, 11 at most. For lines, and for tangents on a surface without ``conditioned``:
    self-shadow spoils it.

    Parameters
    ----------
    view : View, pyvista.Camera or pyvista.Plotter, optional
        View of the scene. Without it the scene has none, as :class:`vizlight.Scene`.

    Returns
    -------
    Scene
        Scene in which no tangent is brighter than white, in any channel of ``rgb``, for any
        exponent of at least 1.

    Raises
    ------
    TypeError
        If the argument is none of these.

    Examples
    --------
    >>> import vizlight
    >>> [light.follows_view for light in vizlight.presets.direction().lights]
    [True, True, True, True]
    """
    return _of_lines(_ring(0.0, 0.6, 0.4), view)


def slope(view: Eye = None, /) -> Scene:
    """Return a scene in which lightness tells how steeply lines run toward the eye.

    A lone headlight: a line across the view is white, one along it dark. Which end is nearer is
    not told; :func:`heading` tells that too.

    Parameters
    ----------
    view : View, pyvista.Camera or pyvista.Plotter, optional
        View of the scene, as for :func:`direction`.

    Returns
    -------
    Scene

    Raises
    ------
    TypeError
        If the argument is none of these.
    """
    return _of_lines([(np.array([0.0, 0.0, 1.0]), np.ones(3))], view)


def heading(view: Eye = None, /) -> Scene:
    """Return a scene in which lightness tells the slope of lines, and hue which end is nearer.

    The hues of :func:`direction`, 65 degrees above the picture plane, and a white lamp at the eye.

    Parameters
    ----------
    view : View, pyvista.Camera or pyvista.Plotter, optional
        View of the scene, as for :func:`direction`.

    Returns
    -------
    Scene

    Raises
    ------
    TypeError
        If the argument is none of these.
    """
    return _of_lines(_ring(65.0, 0.6, 0.5), view)


def shape(view: Eye = None, /) -> Scene:
    """Return a scene in which hue and lightness tell the normal of a surface.

    The hues of :func:`direction` as strong as they are without a negative channel, 48 degrees above
    the picture plane, so that a surface that faces the eye is white. Of equal hues at heights of 35
    to 65 degrees, with white lamps at the eye or without, these leave a reader of colours the least
    error of the normals of a sphere, 6 degrees in the median. For surfaces; tangents of a surface
    need ``conditioned=True``. To an eye that does not read them the hues look like data:
    :func:`vizlight.look` takes lamps of a room where nobody asks for the shape.

    Parameters
    ----------
    view : View, pyvista.Camera or pyvista.Plotter, optional
        View of the scene, as for :func:`direction`.

    Returns
    -------
    Scene
        Scene in which no normal is brighter than white, in any channel of ``rgb``.

    Raises
    ------
    TypeError
        If the argument is none of these.
    """
    lamps = _ring(48.0, 1.0)
    return _scene(lamps, brightest_normal(lamps), view)


def value(view: Eye = None, /) -> Scene:
    """Return a scene in which colours of data stay readable by their scalar bar.

    The default of :class:`vizlight.Scene`: a white lamp over the left shoulder and a weaker one at
    the eye, no highlight, and never less than 0.3 of the light. Colours of one lightness,
    :data:`vizlight.maps.even`, read best.

    Parameters
    ----------
    view : View, pyvista.Camera or pyvista.Plotter, optional
        View of the scene, as for :func:`direction`.

    Returns
    -------
    Scene
        Scene in which neither normals nor tangents are brighter than white.

    Raises
    ------
    TypeError
        If the argument is none of these.
    """
    return Scene(view=_view(view))


#: The presets by the names of their questions.
PRESETS = {name: globals()[name] for name in QUESTIONS}


def preset_of(scene: Scene) -> str | None:
    """Return the question of the preset with the light of a scene, None for other light."""
    _check.instance("scene", scene, Scene)
    material = scene.material
    for name in QUESTIONS:
        preset = PRESETS[name]()
        preset_material = preset.material
        # Without a highlight its colour and its power are of no account.
        alike = (preset_material.ambient, preset_material.diffuse, preset_material.specular) == (
            material.ambient, material.diffuse, material.specular,
        )  # fmt: skip
        if preset.lights == scene.lights and alike:
            return name
    return None


def optional_scene(scene: AnyScene | None) -> Scene | None:
    """Return the scene that is meant: itself, the preset of a question, or None for None."""
    if isinstance(scene, str):
        if scene not in PRESETS:
            expected = f"a vizlight.Scene, or {', '.join(map(repr, PRESETS))}"
            raise _check.value_error("scene", expected, repr(scene))
        preset: Scene = PRESETS[scene]()
        return preset
    _check.instance("scene", scene, Scene, optional=True)
    return scene


def required_scene(scene: AnyScene | None) -> Scene:
    """Return the scene that is meant."""
    if scene is None:
        _check.instance("scene", scene, Scene)
    return as_scene(scene)


def as_scene(scene: AnyScene | None) -> Scene:
    """Return the scene that is meant, for None the default one."""
    return optional_scene(scene) or Scene()


#: A lamp: the direction toward it in the frame of the eye, of length 1, and its channels.
Lamp = tuple["Array", "Array"]


def brightest_normal(lamps: Sequence[Lamp]) -> float:
    """Return the largest channel of any normal's diffuse light, for a coefficient of 1.

    ``sum(w max(0, N . L))`` is the largest ``N . sum(w L)`` over all sets of lamps, and the largest
    of that over N is the length of the sum: exact to rounding.
    """
    sets = itertools.product((False, True), repeat=len(lamps))
    sums = [
        np.linalg.norm(sum(w[channel] * d for (d, w), on in zip(lamps, chosen, strict=True) if on))
        for chosen in sets
        for channel in range(3)
        if any(chosen)
    ]
    return float(max(sums))


def brightest_tangent(lamps: Sequence[Lamp]) -> float:
    """Return a bound of the largest channel of any tangent's diffuse light, for a coefficient of 1.

    ``sum(w |wi_N|^p) <= sum(w |wi_N|)`` for exponents p of at least 1. As the root is concave, that
    is at most ``sqrt(W sum(w |wi_N|^2))`` with W the sum of w, and ``sum(w |wi_N|^2)`` is W less
    the value of the form ``sum(w L L^T)`` at the tangent, at least its least eigenvalue.
    """
    bounds = []
    for channel in range(3):
        total = sum(w[channel] for _, w in lamps)
        form = np.sum([w[channel] * np.outer(d, d) for d, w in lamps], axis=0)
        # A sum of squares has no eigenvalue below 0, but rounding may give one.
        least = max(float(np.linalg.eigvalsh(form)[0]), 0.0)
        bounds.append(float(np.sqrt(total * (total - least))))
    return max(bounds)


def hues(count: int, saturation: float) -> Array:
    """Return colours of luma 1 with white as their mean, as (count, 3), channels from 0.

    Hue is an angle in the plane of no luma; with a saturation of 1 a channel of some hue is 0.
    """
    _, green, least = LUMA
    # Across the vector of luma, so that hues change no luma; red is across both.
    blue = np.array([0.0, -least, green])
    blue /= np.linalg.norm(blue)
    red = np.cross(blue, np.divide(LUMA, np.linalg.norm(LUMA)))
    # Even angles around a circle have the mean 0, and so the colours' mean is white.
    angles = np.radians(FIRST_HUE) + 2 * np.pi * np.arange(count) / count
    ways = np.cos(angles)[:, np.newaxis] * red + np.sin(angles)[:, np.newaxis] * blue
    # With a saturation of 1 the channel that goes farthest below white becomes 0.
    return np.asarray(1 + saturation * ways / np.abs(np.minimum(ways, 0)).max())


def _ring(height: float, saturation: float, head: float = 0.0) -> list[Lamp]:
    """Return three lamps of equal luma around the eye, and a white one at it if it has light."""
    # Lamps are as far apart as their hues, so that hue goes once around with the azimuth.
    lamps = [
        (of_eye(FIRST_AZIMUTH + 120.0 * i, height), color)
        for i, color in enumerate(hues(3, saturation))
    ]
    if head > 0:
        lamps.append((np.array([0.0, 0.0, 1.0]), np.full(3, head)))
    return lamps


def _of_lines(lamps: Sequence[Lamp], view: Eye) -> Scene:
    return _scene(lamps, brightest_tangent(lamps), view)


def _scene(lamps: Sequence[Lamp], brightest: float, view: Eye) -> Scene:
    """Return the scene of lamps; their brightest light becomes white."""
    lights = []
    for toward, channels in lamps:
        # The largest channel is in the intensity, since a colour ends at 1.
        most = float(channels.max())
        color = None if np.ptp(channels) == 0 else tuple((channels / most).tolist())
        lights.append(
            # A lamp at the eye is a headlight. Of all together nothing has more than 1.
            Light(
                direction=None if toward[2] == 1 else toward, follows_view=True, color=color,
                intensity=most / brightest,
            )
        )  # fmt: skip
    # Ambient and diffuse light are at most 1 together, so that no colour is clipped.
    material = Material(ambient=AMBIENT, diffuse=1 - AMBIENT, specular=0.0)
    return Scene(lights=lights, material=material, view=_view(view))


def _view(eye: Eye) -> View | None:
    """Return a view or None as it is, or the view of a camera or of a plotter's camera."""
    # A plotter has a camera; a view or a camera has none.
    of_plotter: vtkCamera | None = getattr(eye, "camera", None)
    try:
        return as_view(cast("vtkCamera", eye) if of_plotter is None else of_plotter)
    except TypeError:
        expected = "a vizlight.View, a pyvista.Camera, a pyvista.Plotter or None"
        raise _check.type_error("view", expected, eye) from None
