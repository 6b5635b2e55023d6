"""Offscreen pictures of lit meshes; the light is computed beforehand by the filters."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Literal, TypedDict, get_args

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from typing_extensions import Unpack
from vtkmodules.vtkRenderingCore import vtkProp3D

from vizlight import _check
from vizlight._types import Array, ColorLike, Foreign, Keywords
from vizlight.draw import strokes
from vizlight.draw.backends import Backend, BackendError, Probe, choose_backend, probe, window_class
from vizlight.draw.box_axes import box_axes, box_edges, captions
from vizlight.draw.cameras import Mesh, camera_on, common_bounds, over_shoulder
from vizlight.draw.glsl import Stroke
from vizlight.draw.keywords import array_of
from vizlight.draw.margins import ink_on
from vizlight.draw.scalar_bars import LETTER, name_no_data
from vizlight.draw.several_views import beside, inset, several_views
from vizlight.filters.tint import RGB, unlit_colors
from vizlight.mesh import records
from vizlight.mesh.blocks import all_blocks, check
from vizlight.mesh.polylines import backdrop
from vizlight.shading.display import NO_DATA, displayable
from vizlight.shading.results import DEFAULT_NAME, VALID
from vizlight.vtk.polylines import has_lines_only
from vizlight.writing import check_output, replace_file

__all__ = [
    "Backend", "BackendError", "Panel", "PlotterKeywords", "Probe", "beside",
    "box_axes", "box_edges", "camera_on", "canvas", "captions", "choose_backend", "inset",
    "make_plotter", "over_shoulder", "pictures", "probe", "save", "save_png", "several_views",
]  # fmt: skip

AntiAliasing = Literal["auto", "ssaa", "msaa", "fxaa"]
PictureLight = Literal["auto", "points"]

#: Supersampling draws at twice the size, and drivers support at most 16384 pixels per side.
LARGEST_SIDE, LARGEST_AREA = 8192, 33_000_000
#: Whether VTK supersamples parts of a picture: older ones put all of them where the first one is.
SUPERSAMPLES_PARTS = pv.vtk_version_info >= (9, 7)
#: File name extensions of pictures that VTK writes.
IMAGES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")
#: Distance by which lines are drawn nearer to the eye than a surface on which they lie, as a share
#: of the size of what is drawn: enough for triangles not to hide the lines between them.
LIFT = 3e-3
#: Width of the column of a bar beside several panels, in that of a panel.
BAR_COLUMN = 0.3
#: Width of a key, as a share of the shorter side of the picture.
KEY_SIZE = 0.15


@dataclass(frozen=True)
class Panel:
    """One picture among others: a mesh, the name of the array that colours it, and a title."""

    mesh: Mesh
    scalars: str = "luminance"
    title: str = ""

    def __post_init__(self) -> None:
        _check.text("scalars", self.scalars, expected="the name of an array")
        _check.instance("title", self.title, str, "a string")


class PlotterKeywords(TypedDict, total=False):
    """Keyword options of :func:`make_plotter`."""

    camera: pv.Camera | None
    rows: int
    size: tuple[int, int]
    scalars: str
    cmap: str
    clim: tuple[float, float]
    bar: str
    background: ColorLike | None
    line_width: float
    line_diameter: float | None
    render_lines_as_tubes: bool
    halo: bool | float | str
    anti_aliasing: AntiAliasing | None
    backend: Backend | None
    light: PictureLight
    key: pv.PolyData | None


def make_plotter(
    panels: Mesh | Panel | Sequence[Mesh | Panel],
    /,
    *,
    camera: pv.Camera | None = None,
    rows: int = 1,
    size: tuple[int, int] = (1200, 800),
    scalars: str | None = None,
    cmap: str = "gray",
    clim: tuple[float, float] = (0.0, 1.0),
    bar: str = "",
    background: ColorLike | None = None,
    line_width: float = 1.0,
    line_diameter: float | None = None,
    render_lines_as_tubes: bool = False,
    halo: bool | float | str = False,
    anti_aliasing: AntiAliasing | None = "auto",
    backend: Backend | None = None,
    light: PictureLight = "auto",
    key: pv.PolyData | None = None,
) -> pv.Plotter:
    """Return an offscreen plotter that shows lit meshes on a grid of panels with one camera.

    Parameters
    ----------
    panels : mesh, Panel, or sequence of them
        Meshes to draw, from left to right.
    camera : pyvista.Camera, optional
        Camera of all panels. Default: :func:`camera_on` all the meshes.
    rows : int, default: 1
        Number of rows of panels, which are filled one after the other.
    size : (int, int), default: (1200, 800)
        Width and height of the whole picture in pixels, each at most 8192, with at most
        33 million pixels in all.
    scalars : str, optional
        Name of the point or cell array that colours a mesh given without a :class:`Panel`.
        Three components are taken as a colour. Default: the colours of a mesh that
        :func:`vizlight.tint` returned, otherwise ``"luminance"``.
    cmap : str, default: "gray"
        Name of the colour map for arrays of one component.
    clim : (float, float), default: (0.0, 1.0)
        Values at the two ends of the colour map.
    bar : str, optional
        Title of a scalar bar in the last panel, which should include the unit. Default: no bar.
    background : colour, optional
        Background colour. Default: black if all meshes consist of lines only, otherwise white.
    line_width : float, default: 1.0
        Width of lines in pixels of the picture, whatever the anti-aliasing. Beside surfaces lines
        are drawn nearer to the eye, by 0.3 % of the bounding box's diagonal and at the same pixels,
        so that a surface on which they lie does not hide them.
    line_diameter : float, optional
        Diameter of lines in the unit of the mesh, in place of ``line_width``: nearer lines are
        wider. They are bands that face the eye, at least half a pixel wide.
    render_lines_as_tubes : bool, default: False
        Whether lines wider than a pixel have the light of a cylinder across their width: its mean
        is that of ``model="cylinder"``. They keep their own light where it is not computed in each
        fragment, as with ``light="points"``, on a surface that conditions it, or in a bundle.
    halo : bool, float or str, default: False
        Band of the colour of the background on each side of lines, which tells the line in front
        where two cross, as for ``plotter.vizlight.add_mesh``: its width in widths of the line, or
        True for one width, at least 2 pixels, or a colour for an outline in it.
    anti_aliasing : {"auto", "ssaa", "msaa", "fxaa"} or None, default: "auto"
        Method of anti-aliasing: supersampling, multisampling, FXAA, or none. "auto" is
        supersampling for lines, which are then drawn narrower than a pixel, else multisampling,
        which takes a third of the time. VTK before 9.7 multisamples several panels.
    backend : {"egl", "osmesa"}, optional
        OpenGL library; see :func:`choose_backend`.
    light : {"auto", "points"}
        Kind of light: "points", the array as it is, interpolated between the points. "auto", the
        light of its record, computed in each fragment, where the array is a light that allows it
        (in gray from 0 to 1, or ``rgb``): it is right between the points too. A scene that is
        exported to a page needs "points", because the page has no such shaders.
    key : pyvista.PolyData, optional
        Key of the light, as :func:`vizlight.presets.key` returns it, in a margin of the last panel.

    Returns
    -------
    pyvista.Plotter
        Plotter, which the caller must close.

    Raises
    ------
    BackendError
        If no OpenGL library can draw here.
    TypeError, ValueError
        If nothing can be drawn, an array is missing, or an option does not fit.
    """
    shown = _check_panels(panels, scalars)
    clim = _check_options(camera, cmap, clim, anti_aliasing)
    _check.text("bar", bar, expected="a title")
    _check.choice("light", light, get_args(PictureLight))
    # A colour map of the light, or other limits, shows the numbers: no light in fragments then.
    fragments = light == "auto" and cmap == "gray" and clim == (0.0, 1.0) and not bar
    pixels = pixels_of(size)
    rows = min(_check.integer("rows", rows, low=1), len(shown))
    columns = math.ceil(len(shown) / rows)
    line_width = _check.number("line_width", line_width, low=0.1, high=1000.0)
    if line_diameter is not None:
        line_diameter = _check.positive("line_diameter", line_diameter)
    lines: Keywords = {"line_width": line_width, "line_diameter": line_diameter}
    tubes = _check.boolean("render_lines_as_tubes", render_lines_as_tubes)
    lines |= {"render_lines_as_tubes": tubes, "halo": strokes.check_halo(halo)}
    meshes = pv.MultiBlock([block for panel in shown for block in all_blocks(panel.mesh)])
    back = pv.Color(_check.color("background", background) or backdrop(meshes))
    if camera is None:
        _check.coordinates("panels", common_bounds("panels", [meshes]))
        # All panels have one size, with this aspect.
        camera = camera_on(meshes, aspect=pixels[0] * rows / (pixels[1] * columns))
    ink = ink_on(back)
    with window_class(choose_backend(backend)):
        # A bar beside several panels has a column of its own.
        beside = bool(bar) and len(shown) > 1
        weights: Foreign = [1.0] * columns + [BAR_COLUMN] * beside
        groups: Foreign = [(slice(None), columns)] if beside else None
        plotter = pv.Plotter(
            off_screen=True, window_size=pixels, border=False, shape=(rows, columns + beside),
            col_weights=weights, groups=groups,
        )  # fmt: skip
    em = max(10, pixels[0] // columns // 50)  # half the height of letters, readable in print
    if anti_aliasing == "auto":
        anti_aliasing = "ssaa" if any(map(has_lines_only, meshes)) else "msaa"
    if anti_aliasing == "ssaa" and len(shown) > 1 and not SUPERSAMPLES_PARTS:
        anti_aliasing = "msaa"
    try:
        for number, panel in enumerate(shown):
            plotter.subplot(*divmod(number, columns))
            plotter.background_color = back
            if anti_aliasing is not None:
                plotter.enable_anti_aliasing(anti_aliasing)
            else:  # PyVista's theme asks for several samples of a pixel all the same
                plotter.render_window.SetMultiSamples(0)  # type: ignore[union-attr]
            # PyVista supersamples for FXAA too where the driver lacks that.
            _draw(plotter, panel, cmap, clim, lines, camera, fragments=fragments)
            if panel.title:
                text = plotter.add_text(panel.title, position="upper_edge", font_size=em, color=ink)
                # VTK sets it so near to the edge that letters touch it.
                text.GetTextProperty().SetLineOffset(8)
                text.GetTextProperty().SetLineSpacing(1.3)
            # A copy for each panel: the clipping planes fit what it shows, and the caller's camera
            # stays as it was.
            plotter.camera = camera.copy()  # type: ignore[no-untyped-call]
            # What is drawn stands in the middle of the room below the title.
            band = 2.6 * em * len(panel.title.splitlines()) * rows / pixels[1]
            plotter.camera.SetWindowCenter(0, band)
            plotter.reset_camera_clipping_range()
        if key is not None:
            plotter.vizlight.show_key(key, size=KEY_SIZE, color=ink)
        if bar:
            mapper, width, left, room = plotter.mapper, 0.1, 0.82, 0.3
            if beside:
                plotter.subplot(0, columns)
                plotter.background_color = back
                width, left, room = 0.1 / BAR_COLUMN, 0.3, 0.9
            # Letters are as large as those of titles of panels, as far as there is room.
            room *= plotter.renderer.GetSize()[0] / LETTER / max(map(len, bar.splitlines()))
            letters = int(min(2 * em, room))
            scalar_bar = plotter.add_scalar_bar(  # type: ignore[call-arg]
                title=bar,
                mapper=mapper, color=ink, n_labels=3, fmt="%.1f", vertical=True,
                height=0.7, width=width, position_x=left, position_y=0.12,
                title_font_size=letters, label_font_size=letters, unconstrained_font_size=True,
            )  # fmt: skip
            if any(panel.scalars + VALID in mesh.point_data for mesh in all_blocks(panel.mesh)):
                name_no_data(scalar_bar)
            # With a gap between the title and the numbers.
            scalar_bar.SetTitle(f"{bar}\n")
    except BaseException:
        # A plotter that nobody gets would keep its window and the memory of its pictures.
        plotter.close()
        raise
    return plotter


def _default_scalars(mesh: object) -> str:
    """Return the array that colours a mesh: its tint, its exposed light, else its light."""
    parts = list(all_blocks(mesh)) if isinstance(mesh, Mesh) else []
    shown = [_has_colors(part) for part in parts]
    return RGB if shown and all(shown) else DEFAULT_NAME


def _has_colors(mesh: pv.DataSet) -> bool:
    """Return whether a mesh has colours that a filter made to be shown in place of its light."""
    if (records.read(mesh, RGB) or {}).get("filter") == "tint":
        return bool(mesh.point_data.active_scalars_name == RGB)
    scene: Foreign = (records.read(mesh, DEFAULT_NAME) or {}).get("scene") or {}
    return scene.get("exposure") is not None and RGB in records.made(mesh, DEFAULT_NAME)


def _check_panels(
    panels: Mesh | Panel | Sequence[Mesh | Panel], scalars: str | None
) -> list[Panel]:
    """Return the panels to draw, each with the array that colours it."""
    items: Sequence[Foreign] = panels if isinstance(panels, list | tuple) else [panels]
    shown = [
        item
        if isinstance(item, Panel)
        else Panel(item, _default_scalars(item) if scalars is None else scalars)
        for item in items
    ]
    if not shown:
        raise _check.value_error("panels", "one mesh or more", "none")
    for panel in shown:
        _check.instance("panels", panel.mesh, Mesh, "PyVista meshes or Panels")
        check(panel.mesh)
        for mesh in all_blocks(panel.mesh):
            array = array_of(mesh, panel.scalars)
            if array is None:
                names = ", ".join(map(repr, [*mesh.point_data, *mesh.cell_data])) or "none"
                expected = f"a point array or a cell array ({names})"
                lit = panel.scalars == DEFAULT_NAME
                remedy = "light the mesh first, by vizlight.illuminate" if lit else ""
                raise _check.value_error("scalars", expected, repr(panel.scalars), remedy)
            if array.dtype.kind not in "biuf" or array.shape[1:] not in ((), (1,), (3,), (4,)):
                expected = "real numbers of 1 component, or colours of 3 or 4"
                got = f"{panel.scalars!r} of shape {array.shape} and type {array.dtype}"
                raise _check.value_error("scalars", expected, got)
    return shown


def _check_options(
    camera: object, cmap: str, clim: object, anti_aliasing: object
) -> tuple[float, float]:
    """Check options that are passed on to PyVista, whose messages do not name them; return clim."""
    if camera is not None and not hasattr(camera, "GetPosition"):
        raise _check.type_error("camera", "a pyvista.Camera", camera)
    low, high = _check.limits("clim", clim)
    if low == high:
        raise _check.value_error("clim", "a lower and a higher number", clim)
    try:
        pv.LookupTable(cmap)
    except (TypeError, ValueError) as error:
        got = _check.describe(cmap)
        raise _check.value_error("cmap", "the name of a colour map", got) from error
    _check.choice("anti_aliasing", anti_aliasing, get_args(AntiAliasing), optional=True)
    return low, high


def save_png(
    panels: Mesh | Panel | Sequence[Mesh | Panel],
    path: str | Path,
    /,
    **options: Unpack[PlotterKeywords],
) -> Path:
    """Draw lit meshes offscreen with one camera and save the picture as a PNG file.

    Parameters
    ----------
    panels : mesh, Panel, or sequence of them
        Meshes to draw, from left to right.
    path : path
        Path of the picture, in an existing folder.
    **options
        Options of :func:`make_plotter`: camera, rows, size, scalars, cmap, clim, bar, background,
        line_width, line_diameter, render_lines_as_tubes, halo, anti_aliasing, backend, light, key.

    Returns
    -------
    pathlib.Path
        Path of the picture.

    Raises
    ------
    BackendError
        If no OpenGL library can draw here.
    TypeError, ValueError
        If an option does not fit, as in :func:`make_plotter`, or the file cannot be written. No
        partial file is left.
    """
    path = check_output(path, (".png",))
    with contextlib.closing(make_plotter(panels, **options)) as plotter:
        return replace_file(path, partial(save_seen, plotter, path), doing="draw")


def pictures(
    sequence: Iterable[Mesh | Panel | Sequence[Mesh | Panel]], /, **options: Unpack[PlotterKeywords]
) -> Iterator[NDArray[np.uint8]]:
    """Yield one picture after the other, all drawn with the same options.

    Parameters
    ----------
    sequence : iterable
        Panels of each picture, as :func:`make_plotter` takes them.
    **options
        Options of :func:`make_plotter`. With ``camera=`` the eye is the same in all pictures.

    Yields
    ------
    ndarray of uint8, shape (height, width, 3)

    Raises
    ------
    BackendError, TypeError, ValueError
        As for :func:`make_plotter`.
    """
    _check.iterable("sequence", sequence, "an iterable of meshes, Panels or lists of them")
    for panels in sequence:
        with contextlib.closing(make_plotter(panels, **options)) as plotter:
            picture = np.array(plotter.screenshot(return_img=True))
        yield picture


def pixels_of(size: object) -> list[int]:
    """Return width and height in pixels, if a picture of that size can be drawn."""
    if _check.reals("size", size).shape != (2,):
        raise _check.value_error("size", "(width, height) in pixels", _check.describe(size))
    sides = _check.vector("size", size)
    pixels = [_check.integer("size", int(p) if p == int(p) else p, low=1) for p in sides]
    if max(pixels) > LARGEST_SIDE or pixels[0] * pixels[1] > LARGEST_AREA:
        limit = f"at most {LARGEST_SIDE} pixels per side and {LARGEST_AREA // 10**6} million in all"
        raise _check.value_error("size", limit, f"{pixels[0]}x{pixels[1]}")
    return pixels


def _draw(
    plotter: pv.Plotter, panel: Panel, cmap: Foreign, clim: tuple[float, float],
    width: Keywords, camera: pv.Camera, *, fragments: bool,
) -> None:  # fmt: skip
    blocks = [mesh for mesh in all_blocks(panel.mesh) if mesh.n_points]
    of_lines = [has_lines_only(mesh) for mesh in blocks]
    size = LIFT * max((mesh.length for mesh in blocks), default=0.0)
    for mesh, lines in zip(blocks, of_lines, strict=True):
        # A shallow copy: the caller's mesh gets neither points nor arrays of ours.
        shown = mesh.copy(deep=False)
        if lines and not all(of_lines):
            # Assigning to shown.points would move the points that it shares with the mesh.
            shown.SetPoints(pv.vtk_points(_lifted(np.asarray(mesh.points), camera, size)))
        if fragments and _add_in_fragments(plotter, shown, panel.scalars, width):
            continue
        stroke = strokes.stroke_of(mesh, width | {"render_lines_as_tubes": False})
        if stroke != Stroke():
            # VTK hands a shader no other vector of lines than their normals.
            shown["vizlight along"] = strokes.directions(mesh).astype(np.float32)
            shown.point_data.active_normals_name = "vizlight along"
        of_points = panel.scalars in mesh.point_data
        values: Foreign = array_of(mesh, panel.scalars)
        colour = values.ndim == 2
        if colour and values.dtype != np.uint8:
            # VTK wraps around above 1, so a bright highlight would turn black.
            values = np.column_stack([displayable(values[:, :3]), np.clip(values[:, 3:], 0, 1)])
        light = DEFAULT_NAME if panel.scalars == RGB else panel.scalars
        if of_points and light + VALID in mesh.point_data and values.dtype != np.uint8:
            values = np.where(mesh[light + VALID], values.T, NO_DATA[0] if colour else np.nan).T
        actor = plotter.add_mesh(
            shown,
            scalars=values,
            preference="point" if of_points else "cell",
            rgb=colour,
            cmap=None if colour else cmap,
            clim=None if colour else clim,
            nan_color=NO_DATA,
            # The array is light already, which VTK's lamps would light once more.
            lighting=False,
            line_width=width["line_width"],
            show_scalar_bar=False,
        )
        if stroke != Stroke():
            strokes.widen(actor, stroke)
            strokes.adapt(actor, plotter.renderer, stroke, of_data=panel.scalars != DEFAULT_NAME)
        else:
            strokes.enlarge(actor, plotter.renderer)
        if (records.read(mesh, panel.scalars) or {}).get("filter") == "tint":
            # The colours are drawn as they are; a scalar bar shows those before they were lit.
            table = unlit_colors(mesh, panel.scalars)
            actor.mapper.lookup_table, actor.mapper.scalar_range = table, table.scalar_range


def _add_in_fragments(plotter: pv.Plotter, mesh: pv.DataSet, name: str, width: Keywords) -> bool:
    """Add a mesh with light computed in each fragment; lines that cannot be round are flat."""
    drawing = width | {"show_scalar_bar": False}
    flat = drawing | {"render_lines_as_tubes": False}
    from vizlight.draw.component import add_recorded

    return any(add_recorded(plotter, mesh, name, **options) for options in (drawing, flat))


def _lifted(points: Array, camera: pv.Camera, by: float) -> Foreign:
    """Return points that are nearer to the eye and stay at the same pixels."""
    eye = np.array(camera.position)
    toward = eye - np.asarray(points, dtype=np.float64)
    if camera.parallel_projection:
        # Parallel rays have one direction: to move along it changes no pixel.
        back = eye - np.array(camera.focal_point)
        return points + by * back / np.linalg.norm(back)
    distance = np.linalg.norm(toward, axis=1, keepdims=True)
    # No more than half the way, or points next to the eye would pass behind it.
    return points + toward * np.minimum(by / np.where(distance > 0, distance, 1), 0.5)


def canvas(
    size: tuple[int, int] = (1200, 800),
    /,
    *,
    background: ColorLike = "white",
    off_screen: bool = True,
    draws: bool = True,
    backend: Backend | None = None,
) -> pv.Plotter:
    """Return an empty plotter, such as a look fills.

    Parameters
    ----------
    size : (int, int), default: (1200, 800)
        Width and height in pixels.
    background : colour, default: "white"
        Colour behind the data.
    off_screen : bool, default: True
        Whether no window is shown.
    draws : bool, default: True
        Whether it must be able to draw; a page is written without an OpenGL library too.
    backend : {"egl", "osmesa"}, optional
        OpenGL library of an offscreen picture; see :func:`choose_backend`.

    Returns
    -------
    pyvista.Plotter
        Plotter, which the caller must close.

    Raises
    ------
    BackendError
        If no OpenGL library can draw here.
    TypeError, ValueError
        If an option does not fit.
    """
    pixels = pixels_of(size)
    back = pv.Color(_check.color("background", background) or "white")
    if not _check.boolean("off_screen", off_screen):
        plotter = pv.Plotter(window_size=pixels)
    else:
        must_draw = _check.boolean("draws", draws)
        window: contextlib.AbstractContextManager[None] = contextlib.nullcontext()
        try:
            window = window_class(choose_backend(backend))
        except BackendError:
            if must_draw:
                raise
        with window:
            plotter = pv.Plotter(off_screen=True, window_size=pixels, border=False)
    plotter.background_color = back
    strokes.lay_on_surfaces(plotter.renderer)
    # PyVista would look for the component among the entry points of all packages.
    from vizlight.draw import component  # noqa: F401

    # A key makes the data a part of the picture.
    if off_screen and SUPERSAMPLES_PARTS:
        plotter.enable_anti_aliasing("ssaa")
    else:
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
    return plotter


def save(plotter: pv.Plotter, path: str | Path, /) -> Path:
    """Save the picture of a plotter as a PNG or another image, and close the plotter.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter that draws offscreen.
    path : path
        Path of the picture, in an existing folder; its ending says the format.

    Returns
    -------
    pathlib.Path
        Path of the picture.

    Raises
    ------
    FileError
        If the file cannot be written. No partial file is left.
    """
    _check.instance("plotter", plotter, pv.BasePlotter, "a pyvista.Plotter")
    path = check_output(path, IMAGES)
    with contextlib.closing(plotter):
        plotter.reset_camera_clipping_range()
        return replace_file(path, partial(save_seen, plotter, path), doing="draw")


#: Share of a picture below which data are hardly seen: a line as long as the picture is 1 / 800.
HARDLY = 1e-3
#: Share of pixels unlike the background from which no key and no text can account for them.
PLAINLY = 0.25


def save_seen(plotter: pv.Plotter, path: Path, draft: str) -> None:
    """Save the picture of a plotter to a draft of a file, and warn where it hardly shows data.

    The path is that of the picture, for the warning; it is written to the draft first.
    """
    picture = np.asarray(plotter.screenshot(draft, return_img=True))
    corner = picture[0, 0].astype(np.int16)
    # A picture without any data is rendered only where there can be few of them in this one.
    if np.mean(np.any(picture != corner, axis=2)) >= PLAINLY:
        return
    share = share_of_data(plotter, picture)
    if share < HARDLY:
        _check.warn(
            f"data are hardly seen in '{path.name}': they change {share:.2%} of its pixels; they "
            "may be thin, narrow, seen along their plane, of the colour of the background, or "
            "beside the camera: take another view or zoom, or scale an axis of a long mesh"
        )


def share_of_data(plotter: pv.Plotter, picture: NDArray[np.uint8], /) -> float:
    """Return the share of the pixels of a picture that are others without the data."""
    shown = [
        actor
        for renderer in plotter.renderers
        for actor in renderer.actors.values()
        # Keys, bars and texts have places on the screen, not in space.
        if isinstance(actor, vtkProp3D) and actor.GetVisibility()
    ]
    for actor in shown:
        actor.SetVisibility(False)
    try:
        plotter.render()
        bare = np.array(plotter.screenshot(return_img=True))
    finally:
        for actor in shown:
            actor.SetVisibility(True)
    return float(np.mean(np.any(picture != bare, axis=2)))
