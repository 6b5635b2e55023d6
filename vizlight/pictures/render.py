"""Pictures of lit meshes, offscreen: the only owner of a plotter. No light is computed here."""

from __future__ import annotations

import contextlib
import functools
import math
import os
import subprocess
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.files import check_output, replace_file
from vizlight.mesh.blocks import leaves
from vizlight.mesh.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = [
    "BackendError",
    "Panel",
    "Probe",
    "camera_on",
    "choose_backend",
    "make_plotter",
    "over_shoulder",
    "pictures",
    "probe",
    "save_png",
]

Backend = Literal["egl", "osmesa"]
AntiAliasing = Literal["ssaa", "msaa", "fxaa"]

_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
_WINDOWS: dict[str, str] = {"egl": "vtkEGLRenderWindow", "osmesa": "vtkOSOpenGLRenderWindow"}
INSTALL: dict[str, str] = {
    "egl": "apt-get install -y libegl1 libgl1-mesa-dri",
    "osmesa": "apt-get install -y libosmesa6",
}

# Where no library is found VTK ends the process, so another process tries it.
_PROBE = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(8, 8)
window.Render()
lines = [line.partition(":") for line in window.ReportCapabilities().splitlines()]
driver = [value.strip() for name, _, value in lines if name == "OpenGL renderer string"]
assert driver and driver[0], "no OpenGL driver"
print(window.GetClassName(), driver[0], sep="\\t")
"""


#: Anti-aliasing draws at twice the size, and drivers end at 16384.
LARGEST_SIDE, LARGEST_AREA = 8192, 33_000_000


class BackendError(RuntimeError):
    """No OpenGL library is there to draw with; the message says how to install one."""


@dataclass(frozen=True)
class Probe:
    """What a try of a backend found."""

    backend: str
    works: bool
    detail: str


@functools.cache
def probe(backend: Backend) -> Probe:
    """Try a backend in another process and say whether it draws.

    Parameters
    ----------
    backend : {"egl", "osmesa"}

    Raises
    ------
    ValueError
        If the name is unknown.
    """
    if backend not in get_args(Backend):
        raise ValueError(_check.message("backend", "'egl' or 'osmesa'", repr(backend)))
    try:
        run = subprocess.run(
            [sys.executable, "-c", _PROBE],
            env={**os.environ, _VARIABLE: _WINDOWS[backend]},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Probe(backend, works=False, detail="no answer in 60 s")
    if run.returncode == 0:
        return Probe(backend, works=True, detail=run.stdout.strip().replace("\t", ", "))
    return Probe(backend, works=False, detail=f"not there (try: {INSTALL[backend]})")


def choose_backend(backend: Backend | None = None) -> Backend | None:
    """Return the backend to draw with: the one asked for, else EGL, else OSMesa.

    None, on a platform other than Linux or where the environment names a window class, leaves
    the choice to VTK.

    Parameters
    ----------
    backend : {"egl", "osmesa"}, optional

    Raises
    ------
    BackendError
        If none draws.
    """
    if backend is None and (not sys.platform.startswith("linux") or os.environ.get(_VARIABLE)):
        return None
    tries: tuple[Backend, ...] = ("egl", "osmesa") if backend is None else (backend,)
    for name in tries:
        if probe(name).works:
            return name
    remedy = " or ".join(f"{INSTALL[name]} ({name.upper()})" for name in tries)
    raise BackendError(f"no picture: no OpenGL library draws here; as root: {remedy}")


@contextlib.contextmanager
def _window_class(backend: Backend | None) -> Iterator[None]:
    """Have VTK make windows of a backend; the caller's own windows are made as before."""
    if backend is None:
        yield
        return
    before = os.environ.get(_VARIABLE)
    os.environ[_VARIABLE] = _WINDOWS[backend]
    try:
        yield
    finally:
        if before is None:
            del os.environ[_VARIABLE]
        else:
            os.environ[_VARIABLE] = before


@dataclass(frozen=True)
class Panel:
    """One of the pictures side by side: a mesh, the array that colours it, a title."""

    mesh: Any
    scalars: str = "luminance"
    title: str = ""


def camera_on(
    bounds: Any,
    direction: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    up: Sequence[float] | None = None,
    parallel: bool = False,
    zoom: float = 1.0,
    aspect: float = 1.0,
) -> Any:
    """Return a camera that sees all of a mesh or a bounding box; no OpenGL is needed for it.

    Parameters
    ----------
    bounds : (xmin, xmax, ymin, ymax, zmin, zmax), or mesh
        In the unit of the mesh. A box is seen whole from wherever it is turned to; a mesh fills the
        picture with its finite points as they are seen.
    direction : vector of 3 components
        From the box's centre toward the eye.
    up : vector of 3 components, optional
        Default: z, or y for a view along z.
    parallel : bool
    zoom : float
        Above 0; 2 shows half the width.
    aspect : float
        Width over height of the picture that a mesh is to fill.

    Raises
    ------
    TypeError, ValueError
        If a value does not fit.
    """
    aspect = _check.number("aspect", aspect, low=1e-3)
    toward = np.array(_check.vector("direction", direction, direction=True))
    if toward.size != 3:
        raise ValueError(_check.message("direction", "3 components", toward.size))
    toward /= np.linalg.norm(toward)
    if up is None:
        up = (0.0, 1.0, 0.0) if abs(toward[2]) > 0.999 else (0.0, 0.0, 1.0)
    if np.linalg.norm(np.cross(_check.vector("up", up, direction=True), toward)) < 1e-6:
        raise ValueError(_check.message("up", "a direction across the view", tuple(up)))
    zoom = _check.number("zoom", zoom, low=1e-6)
    seen = isinstance(bounds, pv.DataSet | pv.MultiBlock)
    corners = _check.floats("bounds", _box("bounds", [bounds]) if seen else bounds).astype(
        np.float64
    )
    if corners.shape != (6,) or not np.all(np.isfinite(corners)):
        expected = "a mesh or six finite numbers"
        raise ValueError(_check.message("bounds", expected, _check.describe(bounds)))
    box = corners.reshape(3, 2)
    centre = box.mean(axis=1)
    radius = 0.5 * float(np.linalg.norm(box[:, 1] - box[:, 0])) or 1.0
    distance, height = radius / math.sin(math.radians(15.0)), radius
    if seen:
        shift, distance, height = _fit(bounds, centre, toward, up, aspect)
        centre = centre + shift
    camera: Any = pv.Camera()  # type: ignore[no-untyped-call]
    camera.view_angle = 30.0
    distance /= zoom
    camera.focal_point = tuple(centre)
    camera.position = tuple(centre + distance * toward)
    camera.up = tuple(up)
    camera.parallel_projection = parallel
    camera.parallel_scale = height / zoom
    camera.clipping_range = (max(distance - 2 * radius, distance * 1e-3), distance + 2 * radius)
    return camera


def _fit(mesh: Any, centre: Any, toward: Any, up: Any, aspect: float) -> tuple[Any, float, float]:
    """Return how far to move the centre, and distance and height at which a mesh fills a view.

    A view of 30 degrees; all but a twentieth of the picture.
    """
    right = np.cross(up, toward)
    axes = np.stack([v / np.linalg.norm(v) for v in (right, np.cross(toward, right), toward)])
    parts = [np.asarray(leaf.points, dtype=np.float64) for leaf in leaves(mesh) if leaf.n_points]
    points = np.concatenate(parts)
    points = (points[np.all(np.isfinite(points), axis=1)] - centre) @ axes.T
    if not len(points):
        raise ValueError(_check.message("bounds", "a mesh with finite points", "none"))
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    middle[2] = 0
    across = np.maximum(np.abs(points[:, 0] - middle[0]) / aspect, np.abs(points[:, 1] - middle[1]))
    height = 1.05 * float(across.max())
    depth = float(np.ptp(points[:, 2]))
    distance = float(np.max(1.05 * across / math.tan(math.radians(15.0)) + points[:, 2]))
    # A mesh that is nothing but a point, or seen edge on, has no size.
    size = 0.05 * depth or (0.0 if height else 1.0)
    return middle @ axes, max(distance, float(points[:, 2].max()) + size), max(height, size)


def over_shoulder(camera: Any) -> tuple[float, float, float]:
    """Return the direction toward a light at infinity above the left shoulder of the eye.

    Parameters
    ----------
    camera : pyvista.Camera or vtkCamera

    Returns
    -------
    (float, float, float)
        Of any length.
    """
    back = -np.array(camera.GetDirectionOfProjection())
    right = np.cross(np.array(camera.GetViewUp()), back)
    right /= np.linalg.norm(right)
    x, y, z = back - 0.6 * right + 0.6 * np.cross(back, right)
    return float(x), float(y), float(z)


def make_plotter(
    panels: Any,
    /,
    *,
    camera: Any = None,
    rows: int = 1,
    size: tuple[int, int] = (1200, 800),
    scalars: str = "luminance",
    cmap: str = "gray",
    clim: tuple[float, float] = (0.0, 1.0),
    bar: str = "",
    background: Any = None,
    line_width: float = 1.0,
    anti_aliasing: AntiAliasing | None = "ssaa",
    backend: Backend | None = None,
) -> pv.Plotter:
    """Return an offscreen plotter with lit meshes side by side or in rows, seen by one camera.

    Parameters
    ----------
    panels : mesh, Panel, or sequence of them
        What to draw, from left to right.
    camera : pyvista.Camera, optional
        Default: :func:`camera_on` what is drawn.
    rows : int, default: 1
        In which the pictures stand, filled one row after the other.
    size : (int, int)
        Width and height in pixels, of all panels together; each at most 8192, 33 million in all.
    scalars : str
        For meshes given without a :class:`Panel`. Three components are taken as a colour.
    cmap : str
        Of arrays of one component.
    clim : (float, float)
        What the ends of the map stand for.
    bar : str
        Title of a scalar bar in the last picture, its unit told; default: no bar.
    background : colour, optional
        Default: white, or black behind meshes of lines.
    line_width : float
        In pixels; with "ssaa", which draws at twice the size, lines come out about half as wide.
    anti_aliasing : {"ssaa", "msaa", "fxaa"}, optional
    backend : {"egl", "osmesa"}, optional
        See :func:`choose_backend`.

    Returns
    -------
    pyvista.Plotter
        To be closed by the caller.

    Raises
    ------
    BackendError
        If no OpenGL library draws here.
    ValueError
        If there is nothing to draw or an array is missing.
    """
    items = list(panels) if isinstance(panels, list | tuple) else [panels]
    shown = [item if isinstance(item, Panel) else Panel(item, scalars) for item in items]
    if not shown:
        raise ValueError(_check.message("panels", "one mesh or more", "none"))
    for panel in shown:
        if not isinstance(panel.mesh, pv.DataSet | pv.MultiBlock):
            got = _check.describe(panel.mesh)
            raise TypeError(_check.message("panels", "PyVista meshes or Panels", got))
        if not isinstance(panel.title, str):
            raise TypeError(_check.message("title", "words", _check.describe(panel.title)))
        for mesh in leaves(panel.mesh):
            if panel.scalars not in mesh.point_data and panel.scalars not in mesh.cell_data:
                there = ", ".join(map(repr, [*mesh.point_data, *mesh.cell_data])) or "none"
                expected = f"a point array or a cell array ({there})"
                raise ValueError(_check.message("scalars", expected, repr(panel.scalars)))
    if camera is not None and not hasattr(camera, "GetPosition"):
        raise TypeError(_check.message("camera", "a pyvista.Camera", _check.describe(camera)))
    pixels = pixels_of(size)
    rows = min(_check.integer("rows", rows, low=1), len(shown))
    columns = math.ceil(len(shown) / rows)
    if camera is None:
        _box("panels", [panel.mesh for panel in shown])
        meshes = pv.MultiBlock([leaf for panel in shown for leaf in leaves(panel.mesh)])
        camera = camera_on(meshes, aspect=pixels[0] * rows / (pixels[1] * columns))
    ends = _check.vector("clim", clim)
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise ValueError(_check.message("clim", "a lower and a higher number", clim))
    try:
        pv.LookupTable(cmap)
    except ValueError as error:
        raise ValueError(_check.message("cmap", "a colour map's name", repr(cmap))) from error
    if anti_aliasing is not None and anti_aliasing not in get_args(AntiAliasing):
        kinds = "'ssaa', 'msaa', 'fxaa' or None"
        raise ValueError(_check.message("anti_aliasing", kinds, repr(anti_aliasing)))
    line_width = _check.number("line_width", line_width, low=0.1, high=1000.0)
    if background is None:
        background = (
            "black"
            if all(has_lines_only(mesh) for panel in shown for mesh in leaves(panel.mesh))
            else "white"
        )
    else:
        _check.color("background", background)
    ink = "black" if sum(pv.Color(background).float_rgb) > 1.2 else "white"
    with _window_class(choose_backend(backend)):
        plotter = pv.Plotter(
            off_screen=True, shape=(rows, columns), window_size=pixels, border=False
        )
    try:
        for number, panel in enumerate(shown):
            plotter.subplot(*divmod(number, columns))
            plotter.set_background(background)
            _draw(plotter, panel, cmap, clim, line_width)
            if panel.title:
                plotter.add_text(panel.title, position="upper_edge", font_size=10, color=ink)
            plotter.camera = camera.copy()
            plotter.reset_camera_clipping_range()
            if anti_aliasing is not None:
                plotter.enable_anti_aliasing(anti_aliasing)
        if bar:
            plotter.add_scalar_bar(  # type: ignore[call-arg]
                title=bar, color=ink, n_labels=3, fmt="%.1f", vertical=True, height=0.7, width=0.1,
                position_x=0.82, position_y=0.12,
            )  # fmt: skip
    except BaseException:
        plotter.close()
        raise
    return plotter


def save_png(panels: Any, path: str | Path, /, **options: Any) -> Path:
    """Draw lit meshes side by side, offscreen, with one camera, to a PNG file.

    Parameters
    ----------
    panels : mesh, Panel, or sequence of them
        What to draw, from left to right.
    path : path
        The picture; its folder must exist.
    **options
        Of :func:`make_plotter`: camera, rows, size, scalars, cmap, clim, bar, background,
        line_width, anti_aliasing, backend.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    BackendError
        If no OpenGL library draws here.
    ValueError
        As :func:`make_plotter`, or if the file cannot be written; no partial file is left.
    """
    path = check_output(path, (".png",))
    plotter = make_plotter(panels, **options)
    try:
        return replace_file(path, plotter.screenshot)
    finally:
        plotter.close()


def pictures(sequence: Iterable[Any], /, **options: Any) -> Iterator[NDArray[np.uint8]]:
    """Yield pictures, one after the other, all drawn alike.

    Parameters
    ----------
    sequence : iterable
        Of what :func:`make_plotter` draws.
    **options
        Of :func:`make_plotter`; with ``camera=`` the eye stays where it is.

    Yields
    ------
    ndarray of uint8, shape (height, width, 3)

    Raises
    ------
    BackendError, ValueError
        As :func:`make_plotter`.
    """
    for panels in sequence:
        plotter = make_plotter(panels, **options)
        try:
            picture = np.array(plotter.screenshot(return_img=True))
        finally:
            plotter.close()
        yield picture


def pixels_of(size: Any) -> list[int]:
    """Return width and height, if a picture of that size can be drawn with anti-aliasing."""
    if np.shape(size) != (2,):
        raise ValueError(_check.message("size", "(width, height) in pixels", size))
    sides = _check.vector("size", size)
    pixels = [_check.integer("size", int(p) if p == int(p) else p, low=1) for p in sides]
    if max(pixels) > LARGEST_SIDE or pixels[0] * pixels[1] > LARGEST_AREA:
        limit = f"at most {LARGEST_SIDE} pixels a side and {LARGEST_AREA // 10**6} million in all"
        raise ValueError(_check.message("size", limit, f"{pixels[0]}x{pixels[1]}"))
    return pixels


def _draw(
    plotter: Any, panel: Panel, cmap: str, clim: tuple[float, float], line_width: float
) -> None:
    for mesh in leaves(panel.mesh):
        if not mesh.n_points:
            continue
        of_points = panel.scalars in mesh.point_data
        values = np.asarray((mesh.point_data if of_points else mesh.cell_data)[panel.scalars])
        colour = values.ndim == 2
        if colour:
            # VTK wraps around above 1, so a bright highlight would turn black.
            values = np.clip(values, 0, 1)
        plotter.add_mesh(
            mesh.copy(deep=False),
            scalars=values,
            preference="point" if of_points else "cell",
            rgb=colour,
            cmap=None if colour else cmap,
            clim=None if colour else clim,
            lighting=False,
            line_width=line_width,
            show_scalar_bar=False,
        )


def _box(name: str, meshes: Sequence[Any]) -> list[float]:
    parts = [part for mesh in meshes for part in leaves(mesh)]
    boxes = np.array([part.bounds for part in parts if part.n_points])
    if not boxes.size:
        raise ValueError(_check.message(name, "a mesh with points", "empty meshes"))
    low, high = boxes[:, ::2].min(axis=0), boxes[:, 1::2].max(axis=0)
    return [float(x) for pair in zip(low, high, strict=True) for x in pair]
