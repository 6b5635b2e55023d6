"""The public meter: how much a reader can read back from a picture of a mesh."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.draw.backends import choose_backend, window_class
from vizlight.draw.glsl import Stroke
from vizlight.draw.render import LARGEST_SIDE
from vizlight.draw.sources import with_sharp_edges
from vizlight.draw.strokes import SUPERSAMPLED, stroke_of
from vizlight.filters.tint import color_table, values_of_blocks
from vizlight.mesh import blocks
from vizlight.mesh.polylines import backdrop
from vizlight.observers.eye import MM_PER_INCH, NOISE
from vizlight.observers.figures import Legibility
from vizlight.observers.measure import measure
from vizlight.observers.samples import WHOLE, are_of_cells, camera_of, is_large, is_solid, part_on
from vizlight.observers.whole import PRINT, read_picture, reading
from vizlight.scene import Light, Scene, View
from vizlight.scene.presets import required_scene
from vizlight.scene.view import is_camera
from vizlight.shading.options import LightOptions
from vizlight.vtk.arrays import is_of_cells
from vizlight.vtk.hull import outer_faces
from vizlight.vtk.parts import uses_normals
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

    from vizlight._types import Exponent, Foreign, Given, Keywords, Model, Raw
    from vizlight.filters.tint import ColorMap
    from vizlight.observers.samples import SeenMesh
    from vizlight.scene.conversion import AnyView
    from vizlight.scene.presets import AnyScene

__all__ = ["Legibility", "legibility"]

#: Size in pixels of a picture that is drawn for a screen, and width over height of any.
ON_SCREEN, ASPECT = (1200, 800), 1.5
#: Options of light that a record of the mesh gives unless they are others.
DEFAULTS: Keywords = {"conditioned": False, "exponent": "compensated", "model": "phong"}
#: Names of the options of light among those of drawing.
LIGHT = frozenset(LightOptions.__dataclass_fields__)


def legibility(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    scene: AnyScene | None = None,
    *,
    tangents: str | ArrayLike | None = None,
    scalars: str | ArrayLike | None = None,
    cmap: ColorMap = None,
    clim: Sequence[float] | float | None = None,
    conditioned: bool = False,
    exponent: Exponent = "compensated",
    model: Model = "phong",
    view: AnyView = None,
    picture: str | Path | ArrayLike | None = None,
    camera: pv.Camera | None = None,
    key: Foreign = None,
    size_mm: float | None = None,
    dpi: float = PRINT[1],
    distance_mm: float | None = None,
    screen: float | None = None,
    noise: float = NOISE,
    samples: int = 4096,
    seed: int = 0,
    **options: Given,
) -> Legibility:
    """Measure how much a reader can read back from a picture of a mesh.

    The mesh is drawn as ``plotter.vizlight.add_mesh`` draws it, or ``picture`` is taken. The
    picture passes an eye at some distance: details too fine or too pale for it are gone. A reader
    then matches the colours of single places with the key of the picture, and the answers are
    compared with the data. A question that the reader cannot answer is "unreadable", and its error
    is that of chance.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh as the picture shows it: surfaces, lines, points, or blocks of them.
    scene : Scene or str, optional
        Lights and material that the mesh is drawn in. Needed without ``picture``.
    tangents : str or array_like, optional
        Name of a point array of 3 or 6 components, or its values, as for
        :func:`vizlight.illuminate`.
    scalars : str or array_like, optional
        Array of values that colour the picture, as for :func:`vizlight.tint`, but of cells each has
        one colour. Default: none.
    cmap : str, list, matplotlib colormap or pyvista.LookupTable, optional
        Colour map of the values. Default: as for :func:`vizlight.tint`.
    clim : (float, float) or float, optional
        Values at the ends of the colour map. Default: smallest and largest value.
    conditioned, exponent, model
        As for :func:`vizlight.illuminate`.
    view : View or pyvista.Camera, optional
        Eye of the picture that is drawn. Default: the view of the scene, else the isometric view
        that shows the whole mesh. A camera is taken as it is.
    picture : array_like of shape (H, W, 3), or path, optional
        Picture of the mesh, by any program, in bytes or from 0 to 1 (1e-5 beyond is taken for
        rounding), or its file.
    camera : pyvista.Camera, optional
        Camera of ``picture``, which fills it: of a picture with a margin for its key, such as that
        of a look, pass the part without it, or read the plotter itself.
    key : Scene, (cmap, clim), or list of both, optional
        Meaning of the colours of ``picture``: light of a scene (direction, slope, heading, shape),
        or values of ``scalars`` on a colour map with limits. With an empty list colours mean
        nothing. Without a scene marks are read by their form: lines, glyphs (``mesh`` is the result
        of ``glyph``), and on a surface with ``tangents`` any texture, such as line integral
        convolution.
    size_mm : float, optional
        Width of the picture in print. Default: 85 mm, a column.
    dpi : float, default: 300
        Pixels per inch of a picture that is drawn.
    distance_mm : float, optional
        Distance of the eye. Default: 400 mm for print, 600 mm for a screen.
    screen : float, optional
        Pixels per inch of a screen that shows the picture pixel by pixel, in place of ``size_mm``.
    noise : float, default: 2.3
        Standard deviation of the noise of the eye in CIELAB: the difference that an eye just tells
        apart (Mahy, Van Eycken and Oosterlinck 1994).
    samples : int, default: 4096
        Largest number of pixels that are read.
    seed : int, default: 0
        Seed of the drawing of pixels and of the noise.
    **options
        Further options of ``plotter.vizlight.add_mesh``, such as ``occlusion="sky"``, ``bundle``,
        ``feature_angle``, ``line_width`` and ``line_diameter``. Of a ``picture`` they say how it
        shows the mesh;
        ``feature_angle=None`` is for edges that are smooth.

    Returns
    -------
    Legibility
        Figures of ``direction``, ``slope``, ``heading``, ``sense``, ``order``, ``shape``,
        ``value``, ``speed`` and ``scale``, each None where the data have no such question. It
        prints as a table.

    Raises
    ------
    BackendError
        If no OpenGL library can draw here.
    TypeError, ValueError
        If an argument does not fit, an array is missing, no point is visible, or scene and mesh
        are not in 3-space.

    Notes
    -----
    *Eye*: S-CIELAB (Zhang and Wandell 1997). Linear light in three opponent channels, of which gray
    has but the first, each filtered by its contrast sensitivity, then CIELAB: stripes of one arc
    minute keep less than 1 % of their contrast, and colours go sooner than lightness. The filters
    are the window of a reader: 2.8 arc minutes wide for lightness, 3.9 for red and green, 5.4 for
    blue and yellow, at half height. Of the contrast of a line of 1 pixel at 300 dpi a quarter is
    left, 3.2 times less than of one of 4 pixels; thresholds of lines as long as a degree differ by
    3.4 (Watson and Ahumada, J. Vision 5, 2005). Stripes of 2 arc minutes and less are weaker than
    for a good eye.

    *direction*: hues of a disc that faces the eye and has tangents in all directions; tangents
    that run toward the eye are left out. Lines, glyphs and textures tell it by their grain: across
    it the colours of a window of 8 arc minutes change most, of glyphs those of the whole, in a
    channel for fine or in one for coarse marks. *slope*:
    lightness ranks steepness. *heading*: a key of all directions of lines, in one share of its
    light for all of the picture, since smoothed edges and halos darken lines. *shape*: a ball in
    the same light; with tangents, which are unknown, 72 of them for each normal. *value*: colours
    of the bar or their lightness, as they are or in some light, whichever tells most of the whole
    picture. *speed*: lightness,
    chroma, or the lengths of glyphs rank the lengths of vectors. *scale*: the finest structure at
    which half of the answers are right beyond chance. *order*: at crossings the borders of the
    nearer line, darker ones inside it too, or gaps beside it, differ by 3 deviations of the noise
    (Rose 1948), on both sides and by more than those of the other; crossings with a third line
    within 5.5 pixels are left out. Of two narrow lines of 3 pixels on black without halos the
    darker one is read as the nearer. *sense*: a reader sees which end of a stroke is ahead where
    its outer thirds differ by 3 deviations of the noise in lightness. It needs lines that have
    ``tangents``, or VTK's ``IntegrationTime``. For a glyph, and for a stroke that has widths, the
    pixels that it covers are compared with those that it would cover if it were turned round: the
    sense is right where the former stand out more. Each counts by the pixels that show it.

    A reader of a surface with lines on it looks between them, as far as 10 arc minutes away. Of a
    large surface normals are computed near the places that are read, and ``feature_angle="auto"``
    looks for creases there.

    Bits are the logarithmic score of the reader's belief, ``log2(A) + E[log2 q]`` for A
    candidates, at the best share of lapses, less the score of the same answers about other places
    at random: a property that all of the data share is not read. Of order and sense they are those
    of a yes or no, 1 at most. The most that are possible, ``log2(A)``, are printed beside them, and
    ``score`` divides them by those of an answer within 15 degrees of a direction, 20 of a normal, a
    tenth of a bar or 0.15 of all ranks. Below 0.3 bits a question is unreadable.

    Examples
    --------
    >>> import vizlight
    >>> ball = vizlight.legibility(pv.Sphere(), vizlight.presets.shape(), samples=256)
    >>> ball.shape.median < 20
    True
    >>> ball.direction is None
    True
    """
    blocks.check(mesh)
    if scalars is None and (cmap is not None or clim is not None):
        name = "cmap" if cmap is not None else "clim"
        raise ValueError(_check.message(name, "scalars= beside it", "none"))
    drawing: Keywords = {"conditioned": _check.boolean("conditioned", conditioned)}
    drawing |= {"exponent": exponent, "model": model}
    drawing = {
        name: value for name, value in drawing.items() if np.any(value != DEFAULTS[name])
    } | options
    if tangents is not None:
        drawing["tangents"] = tangents
    how: Keywords = {"distance_mm": distance_mm, "screen": screen, "noise": noise}
    how |= {"samples": samples, "seed": seed}
    if picture is not None:
        rgb = read_picture(picture)
        if camera is None or not is_camera(camera):
            remedy = "pass plotter.camera of the picture"
            got = _check.describe(camera)
            raise TypeError(_check.message("camera", "a pyvista.Camera", got, remedy))
        checked = reading(rgb.shape[1], size_mm, distance_mm, screen, noise, samples, seed)
        eye = camera_of(mesh, None, camera, 1.0)
        return measure(rgb, _parts(mesh, key, drawing, scalars, eye), eye, **checked)
    if cmap is not None:
        color_table([], cmap=cmap)
    for name, value in (("key", key), ("camera", camera)):
        if value is not None:
            raise ValueError(_check.message(name, "picture= beside it", "none"))
    scene = required_scene(scene)
    dpi = _check.number("dpi", dpi, low=10.0, high=2400.0)
    size = ON_SCREEN
    if screen is None:
        most = LARGEST_SIDE / dpi * MM_PER_INCH
        across = PRINT[0] if size_mm is None else _check.positive("size_mm", size_mm, high=most)
        wide = round(across / MM_PER_INCH * dpi)
        size = max(wide, 8), max(round(wide / ASPECT), 8)
    reading(size[0], size_mm, **how)
    eye = camera_of(mesh, scene, view, size[0] / size[1])
    plotter = _plotter(mesh, size)
    try:
        if scalars is not None:
            drawing |= {"scalars": scalars, "cmap": cmap, "show_scalar_bar": False}
            drawing |= {} if clim is None else {"clim": _check.limits("clim", clim)}
        strokes = [stroke_of(block, {"halo": None} | drawing) for block in blocks.all_blocks(mesh)]
        is_plain = _of_lines(mesh) and not any(stroke != Stroke() for stroke in strokes)
        pixel = SUPERSAMPLED if is_plain else 1.0
        drawing["line_width"] = pixel * drawing.get("line_width", 1.0)
        component: Foreign = plotter.vizlight
        component.add_mesh(mesh, scene=scene, render=False, **drawing)
        plotter.camera = eye
        plotter.reset_camera_clipping_range()
        figures: Legibility = component.legibility(size_mm=size_mm, **how)
        return figures
    finally:
        plotter.close()


def _of_lines(mesh: pv.DataSet | pv.MultiBlock) -> bool:
    return all(has_lines_only(block) for block in blocks.all_blocks(mesh) if block.n_points)


def _plotter(mesh: pv.DataSet | pv.MultiBlock, size: tuple[int, int]) -> pv.Plotter:
    """Return an offscreen plotter with the background and the anti-aliasing of pictures."""
    with window_class(choose_backend()):
        plotter = pv.Plotter(off_screen=True, window_size=list(size), border=False)
    plotter.background_color = pv.Color(backdrop(blocks.all_blocks(mesh)))
    plotter.enable_anti_aliasing("ssaa" if _of_lines(mesh) else "msaa")
    return plotter


def _split(mesh: pv.DataSet, options: LightOptions) -> pv.DataSet:
    """Return a mesh with split sharp edges unless it is large; of many solid cells the surface."""
    by_name = all(isinstance(x, str | None) for x in (options.tangents, options.normals))
    many = isinstance(mesh, pv.UnstructuredGrid) and mesh.n_cells > WHOLE
    if not (many and by_name and is_solid(mesh)):
        return mesh if is_large(mesh) else with_sharp_edges(mesh, options)
    of_cells = are_of_cells(mesh, options)
    if of_cells and not uses_normals(mesh, options):
        return mesh
    surface = pv.wrap(outer_faces(mesh)[0])
    if is_large(surface) and not of_cells:
        return surface
    # Means of cells at points that are split are those of the faces around, at others of all cells.
    split = with_sharp_edges(surface, options)
    return mesh if of_cells and split is surface else split


def _parts(
    mesh: pv.DataSet | pv.MultiBlock,
    key: Foreign,
    drawing: Keywords,
    scalars: str | ArrayLike | None,
    camera: pv.Camera,
) -> list[SeenMesh]:
    """Return the meshes of a picture with the meaning of their colours by a key."""
    keys = key if isinstance(key, list) else [key]
    scene, bar = None, None
    for meaning in keys:
        if isinstance(meaning, Scene | str):
            scene = required_scene(meaning)
        elif isinstance(meaning, tuple) and len(meaning) == 2:
            bar = meaning
        else:
            expected = "a vizlight.Scene, a pair (cmap, clim), or a list of both"
            raise TypeError(_check.message("key", expected, _check.describe(meaning)))
    view = View.from_camera(camera)
    lit = scene is not None
    scene = Scene(lights=Light.headlight()) if scene is None else scene
    light: Keywords = {"feature_angle": "auto"}
    light |= {name: value for name, value in drawing.items() if name in LIGHT}
    options = LightOptions(**light)
    shown = [(block, path) for block, path in blocks.check(mesh) if block.n_points]
    smooth = dataclasses.replace(options, feature_angle=None)
    # Rows of values that are no array of the mesh do not fit points that are split.
    if lit and isinstance(scalars, str | None):
        # The edges of a large surface are looked for near the places that are read.
        shown = [(_split(block, options), path) for block, path in shown]
    else:
        options = smooth
    values: list[Raw | None] = [None] * len(shown)
    table = None
    if bar is not None:
        if scalars is None:
            raise ValueError(_check.message("scalars", "the array that colours show", None))
        some = values_of_blocks([block for block, _ in shown], scalars, flat=True)
        table = color_table(some, cmap=bar[0], clim=bar[1])
        values = list(some)
    width = float(drawing.get("line_width", 1.0))
    return [
        part_on(
            block, scene.replace(view=view), options if is_large(block) else smooth, path,
            lit=lit, values=array, table=table, width=width,
            flat=isinstance(scalars, str) and is_of_cells(block, scalars),
            diameter=stroke_of(block, {"line_width": width} | drawing).diameter,
        )
        for (block, path), array in zip(shown, values, strict=True)
    ]  # fmt: skip
