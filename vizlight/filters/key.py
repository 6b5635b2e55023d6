"""The key of a light: the meaning of its hues and its lightness, to be drawn beside a picture."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkStringArray

from vizlight import _check
from vizlight._questions import QUESTIONS, Question
from vizlight._types import Array, Exponent, Indices
from vizlight.filters.tint import RGB, ColorMap, color_table
from vizlight.geometry.nspace import lattice
from vizlight.mesh.blocks import polydata
from vizlight.scene import Scene, View
from vizlight.scene.presets import AnyScene, preset_of, required_scene
from vizlight.shading import engine
from vizlight.shading.display import LEAST, Bytes, displayable, numerals, on_colors

#: Name of the field array with the words that stand beside a key.
WORDS = "words"
#: Names of the field arrays with the range of a bar of values, its levels, and the names of kinds.
RANGE, LEVELS, NAMES = "range", "levels", "names"
#: Names of the field arrays that say that a bar is logarithmic, and whether values lie below and
#: above its ends.
SCALE, BEYOND = "logarithmic", "beyond"
#: Name of the field array with the title of the key.
TITLE = "title"
#: Inner radius of the disc of directions, whose centre has none.
HOLE = 0.3
#: Height of a bar as a share of its width.
BAR = 0.16
#: Numbers of rings, of points around, and of points along a bar.
RINGS, AROUND, ALONG = 24, 96, 97
#: Width of the swatch of values below a bar, which have a colour apart, and its distance from it.
SWATCH, GAP = 0.1, 0.03
#: Half of the width of a step of colours, as a share of half of a bar.
EDGE = 1e-3
#: Number of places along each side of a pixel of a key's picture.
FINE = 4


def key(
    scene: AnyScene,
    /,
    *,
    question: str | None = None,
    exponent: Exponent = "compensated",
    conditioned: bool = False,
    cmap: ColorMap = None,
    clim: Sequence[float] | None = None,
    levels: Sequence[float] = (),
    title: str = "",
) -> pv.PolyData:
    """Return the key of a scene's light as a mesh that faces the eye.

    Parameters
    ----------
    scene : Scene or str
        Scene that lights the data, all its lights at infinity, or a question of a preset.
    question : str, optional
        Question that the key answers. ``"direction"``: a disc of tangents that run from its centre.
        ``"slope"``: a bar of lines, from across the view to toward the eye. ``"heading"``: a disc
        where each point is the near end of a line from the centre. ``"shape"``: a ball.
        ``"value"``: a bar of the colours of data, below in the least light and above in full,
        with a swatch before it where a lookup table has a colour apart for values below its range.
        Default: the question of the preset with the light of the scene, otherwise ``"shape"``.
    exponent : float or "compensated"
        Exponent of the diffuse light of lines, as the data have it.
    conditioned : bool, default: False
        Whether tangents of the disc have the self-shadow of a surface that faces the eye.
    cmap : str or colour map, optional
        Colour map of ``"value"``, such as :func:`vizlight.unlit_colors` returns. Default:
        :data:`vizlight.maps.even`.
    clim : (float, float), optional
        Values at the ends of that map, which become its words. Default: the ends of a lookup table.
    levels : sequence of float, optional
        Values within ``clim`` that ascend, at which the colours of the map have steps and numbers
        stand. Default: some round numbers.
    title : str, optional
        Name of the values, or of what the light shows, with a unit in parentheses at its end. It
        stands above the data, and the unit above a bar.

    Returns
    -------
    pyvista.PolyData
        Disc of radius 1, or bar of width 2, about the origin of the xy plane: x to the right and y
        up on the screen. The point array ``rgb`` has its colours as bytes, and the field array
        ``words`` the few words that belong beside it.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or a light has a position.

    Examples
    --------
    >>> import vizlight
    >>> disc = vizlight.presets.key(vizlight.presets.direction())
    >>> str(disc.field_data["words"][0])
    'direction on the screen'
    """
    scene = required_scene(scene)
    topic = question_of(scene) if question is None else question
    steps: list[float] = []
    values = _check.coordinates("levels", levels).ravel()
    if len(values):
        low, high = _check.limits("clim", clim)
        if not low < high or np.any(np.diff(values) <= 0):
            expected = "numbers that ascend, of a range that is given by clim"
            raise _check.value_error("levels", expected, list(values))
        scale = np.log if isinstance(cmap, pv.LookupTable) and cmap.log_scale else np.asarray
        low, high, *places = scale([low, high, *values]).tolist()
        steps = [(place - low) / (high - low) for place in places]
    elif names := _names_of(cmap):
        steps = [i / len(names) for i in range(1, len(names))]
    facts = _question(topic)
    x, y, faces = _bar(steps) if facts.is_bar else _disc(HOLE * (facts.key == "disc"))
    mesh = polydata(np.stack([x, y, 0 * x], axis=1), faces)
    mesh[RGB] = colors_of(
        scene, x, y, question=topic, exponent=exponent, conditioned=conditioned, cmap=cmap
    )
    words = list(facts.words)
    if facts.key == "colors":
        if clim is None and isinstance(cmap, pv.LookupTable):
            clim = cmap.scalar_range
        names = _names_of(cmap)
        if names:
            _put_words(mesh, NAMES, names)
        elif isinstance(cmap, pv.LookupTable):
            beyond = (cmap.GetUseBelowRangeColor(), cmap.GetUseAboveRangeColor())
            if (apart := color_below(cmap)) is not None:
                mesh = _with_swatch(mesh, apart)
            mesh.field_data[SCALE], mesh.field_data[BEYOND] = [cmap.log_scale], beyond
        if clim is not None:
            ends = _check.limits("clim", clim)
            mesh.field_data[RANGE] = ends
            words = numerals(ends)
        if len(values):
            mesh.field_data[LEVELS] = values
    _put_words(mesh, WORDS, words)
    if title is not None and _check.text("title", title):
        _put_words(mesh, TITLE, [title])
    return mesh


def color_below(table: pv.LookupTable) -> Array | None:
    """Return the colour of values below a bar, None where it is that of the bar's end.

    It is red, green and blue, from 0 to 1.
    """
    color: Array = np.asarray(table.GetBelowRangeColor()[:3], dtype=np.float64)
    first = np.asarray(table.values)[0, :3] / 255
    is_apart = table.GetUseBelowRangeColor() and not np.allclose(color, first, atol=0.02)
    return color if is_apart else None


def _with_swatch(bar: pv.PolyData, color: Array) -> pv.PolyData:
    """Return a bar with a swatch before its lower end."""
    right = -1 - GAP
    x, y = np.array([right - SWATCH, right, right, right - SWATCH]), BAR * np.array([-1, -1, 1, 1])
    swatch = pv.PolyData(np.stack([x, y, 0 * x], axis=1), [4, 0, 1, 2, 3])
    swatch[RGB] = np.tile(np.rint(255 * color).astype(np.uint8), (4, 1))
    both: pv.PolyData = bar.append_polydata(swatch)
    return both


def _put_words(mesh: pv.PolyData, name: str, words: Sequence[str]) -> None:
    """Attach words in any letters, where PyVista takes those of ASCII alone."""
    array = vtkStringArray()
    array.SetName(name)
    for word in words:
        array.InsertNextValue(word)
    mesh.GetFieldData().AddArray(array)


def _names_of(cmap: ColorMap) -> list[str]:
    """Return the names of the kinds of a lookup table, in the order of their numbers."""
    return [name for _, name in annotated(cmap)]


def annotated(cmap: ColorMap) -> list[tuple[float, str]]:
    """Return the numbers and the names of the kinds of a lookup table, in their order."""
    if not isinstance(cmap, pv.LookupTable):
        return []
    count = cmap.GetNumberOfAnnotatedValues()
    # A table of names alone has no numbers, and PyVista's own look-up fails at it.
    names = cmap.GetAnnotations()
    if not count or names is None or names.GetNumberOfValues() < count:
        return []
    rows = range(count)
    return sorted((cmap.GetAnnotatedValue(i).ToDouble(), cmap.GetAnnotation(i)) for i in rows)


def _question(name: str) -> Question:
    """Return the facts on a question."""
    _check.choice("question", name, [*QUESTIONS])
    return QUESTIONS[name]


def question_of(scene: Scene) -> str:
    """Return the question of the preset with the light of a scene, ``"shape"`` for other light."""
    return preset_of(scene) or "shape"


def colors_of(
    scene: Scene,
    x: Array,
    y: Array,
    /,
    *,
    question: str,
    exponent: Exponent = "compensated",
    conditioned: bool = False,
    cmap: ColorMap = None,
) -> NDArray[np.uint8]:
    """Return the colours of a key at places of its plane; see :func:`key`.

    Places are of a disc of radius 1, or of a bar of width 2 and its height.
    """
    form = _question(question).key
    seen = _in_frame_of_eye(scene)
    if form == "colors":
        table = np.asarray(color_table([np.array([0.0, 1.0])], cmap=cmap).values)[:, :3]
        if annotated(cmap):
            # One swatch for each kind, whatever the gaps between their numbers.
            kinds = np.array([number for number, _ in annotated(cmap)])
            table = table[np.rint(kinds - cmap.scalar_range[0] - 0.5).astype(int)]
        at = np.minimum(((x + 1) / 2 * len(table)).astype(int), len(table) - 1)
        # The bar runs from the least light below to full light above.
        darkest = max(seen.material.ambient * seen.ambient_intensity, LEAST)
        return on_colors(table[at], darkest + (1 - darkest) * (y / BAR + 1) / 2)
    radius = np.hypot(x, y)
    # On a ball of radius 1, z = sqrt(1 - x^2 - y^2), a place and its normal are the same vector.
    depth = np.sqrt(np.maximum(1 - radius**2, 0.0))
    toward_eye = np.broadcast_to((0.0, 0.0, 1.0), (len(x), 3))
    vectors = np.stack([x, y, depth], axis=1)
    if form == "disc":
        # Tangents lie in the plane of the screen and run from the centre.
        vectors = np.stack([x, y, 0 * x], axis=1)
    elif form == "bar":
        # From 0, across the view, to 90 degrees, toward the eye.
        angle = (x + 1) * np.pi / 4
        vectors = np.stack([np.cos(angle), 0 * x, np.sin(angle)], axis=1)
    surface = form == "ball"
    # Lights and eye are at infinity: the place of a point is of no account.
    shading = engine.shade(
        np.zeros((len(x), 3)), None if surface else vectors, seen,
        normals=vectors if surface else toward_eye if conditioned else None,
        exponent=exponent, conditioned=conditioned,
    )  # fmt: skip
    light = shading.luminance[:, np.newaxis] if shading.rgb is None else shading.rgb
    return np.rint(255 * displayable(np.broadcast_to(light, (len(x), 3)))).astype(np.uint8)


def key_picture(
    scene: AnyScene,
    width: int = 240,
    /,
    *,
    question: str | None = None,
    exponent: Exponent = "compensated",
    conditioned: bool = False,
    cmap: ColorMap = None,
) -> Bytes:
    """Return the picture of a key, transparent around it.

    Parameters
    ----------
    scene : Scene
    width : int, default: 240
        Width in pixels, from 8 to 4096.
    question, exponent, conditioned, cmap
        As for :func:`key`.

    Returns
    -------
    ndarray of uint8, shape (H, width, 4)
        Red, green, blue and opacity, from the upper left.

    Raises
    ------
    TypeError, ValueError
        As :func:`key`.

    Examples
    --------
    >>> import vizlight
    >>> vizlight.presets.key_picture(vizlight.presets.shape(), 64).shape
    (64, 64, 4)
    """
    scene = required_scene(scene)
    width = _check.integer("width", width, low=8, high=4096)
    question = question_of(scene) if question is None else question
    facts = _question(question)
    bar = facts.is_bar
    fine = FINE * width
    across = (np.arange(fine) + 0.5) / fine * 2 - 1
    tall = FINE * max(round(width * BAR), 1) if bar else fine
    down = ((np.arange(tall) + 0.5) / tall * 2 - 1) * (BAR if bar else 1.0)
    # Rows of a picture run downward, and y upward.
    x, y = (part.ravel() for part in np.meshgrid(across, -down))
    radius = np.hypot(x, y)
    inside = np.ones(len(x), dtype=np.bool_) if bar else radius <= 1
    if facts.key == "disc":
        inside &= radius >= HOLE
    rgb = colors_of(
        scene, x[inside], y[inside], question=question, exponent=exponent,
        conditioned=conditioned, cmap=cmap,
    )  # fmt: skip
    seen = np.zeros((len(x), 4))
    seen[inside, :3], seen[inside, 3] = rgb, 1.0
    # Each pixel is the mean of what is within the key.
    blocks: Array = seen.reshape(tall // FINE, FINE, width, FINE, 4).sum(axis=(1, 3))
    share = blocks[..., 3:]
    blocks[..., :3] /= np.maximum(share, 1)
    blocks[..., 3:] = 255 * share / FINE**2
    return np.asarray(np.rint(blocks), dtype=np.uint8)


def _in_frame_of_eye(scene: Scene) -> Scene:
    """Return a scene seen along z from infinity, with its lights where the eye has them."""
    _check.instance("scene", scene, Scene)
    view = View.isometric() if scene.view is None else scene.view
    lights = []
    for light in scene.lights:
        if light.position is not None:
            expected, remedy = "lights at infinity for a key", "give them directions"
            raise _check.value_error("scene", expected, light, remedy)
        # A light that follows the view is given in the frame of the eye already.
        if not light.follows_view and light.direction is not None:
            unit = np.divide(light.direction, np.abs(light.direction).max())
            light = dataclasses.replace(light, direction=tuple(view.axes() @ unit))
        lights.append(light)
    # A flat key has no depth by which a cue could fade it.
    return scene.replace(lights=lights, view=View(direction=(0, 0, 1)), depth_cue=None)


def _disc(hole: float) -> tuple[Array, Array, Indices]:
    """Return places of a disc and its quadrilaterals, from a hole's radius to 1."""
    # Rings of a ball stand close where its normal turns fast.
    radii = np.sin(np.linspace(np.arcsin(hole), np.pi / 2, RINGS))
    angles = 2 * np.pi * np.arange(AROUND) / AROUND
    x, y = np.outer(radii, np.cos(angles)), np.outer(radii, np.sin(angles))
    return x.ravel(), y.ravel(), lattice.cells(x.shape, (False, True), by_rows=True)


def _bar(steps: Sequence[float]) -> tuple[Array, Array, Indices]:
    """Return places of a bar and its quadrilaterals, with columns at both sides of each step."""
    beside = [2 * step - 1 + side * EDGE for step in steps for side in (-1, 1)]
    columns = np.unique(np.clip([*np.linspace(-1, 1, ALONG), *beside], -1, 1))
    x, y = np.meshgrid(columns, np.linspace(-BAR, BAR, 9))
    return x.ravel(), y.ravel(), lattice.cells(x.shape, (False, False), by_rows=True)
