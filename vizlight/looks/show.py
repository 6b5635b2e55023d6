"""``mesh.vizlight.plot``: ``pyvista.plot`` with light that follows the camera."""

from __future__ import annotations

import inspect
from pathlib import Path

import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Foreign, Given, Keywords
from vizlight.draw import keywords
from vizlight.draw.live import LightAt
from vizlight.draw.render import IMAGES
from vizlight.filters.sky import SKY
from vizlight.looks.look import look
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, optional_scene
from vizlight.writing import check_output

__all__ = ["plot"]

#: Effects of a plotter, and keywords of ``pyvista.plot`` for them.
EFFECTS = {
    "eye_dome_lighting": ("eye_dome_lighting", "edl"),
    "parallel_projection": ("parallel_projection",),
    "ssao": ("ssao",),
}
#: Keywords of ``pyvista.plot`` that do not change the picture.
SHOWN = {"off_screen", "return_img", "interactive", "auto_close", "return_cpos"}
#: Keywords of ``pyvista.plot`` that its signature does not name.
_MORE = {"edl", "show_grid", "auto_close", "camera"}


@named
def plot(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    *,
    scene: AnyScene | None = None,
    light: LightAt = "auto",
    scalars: str | ArrayLike | None = None,
    camera: pv.Camera | None = None,
    window_size: tuple[int, int] | None = None,
    screenshot: str | Path | bool | None = None,
    jupyter_backend: str | None = None,
    sky: bool = False,
    **options: Given,
) -> object:
    """Show a mesh with light that follows the camera; by default as :func:`vizlight.look` decides.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that is lit and drawn; not changed.
    scene, light, scalars
        As for ``plotter.vizlight.add_mesh``.
    camera : pyvista.Camera, optional
        First camera. Default: ``cpos``, or one that shows the whole mesh.
    window_size : (int, int), optional
        Width and height in pixels.
    screenshot : path or bool, optional
        Path of a picture of the last view, or whether it is returned.
    jupyter_backend : str, optional
        Backend of a notebook; ``"html"`` shows the page of :func:`vizlight.live_html` in a frame.
    sky : bool, default: False
        Whether the ambient light comes from a sky: ``occlusion="sky"``.
    **options
        Keywords of ``pyvista.plot``, such as ``cpos``, ``zoom``, ``background``, ``off_screen`` and
        ``text``, and of ``plotter.vizlight.add_mesh``: options of :func:`vizlight.illuminate` and
        keywords of ``pyvista.Plotter.add_mesh``.

    Returns
    -------
    object
        Result of ``pyvista.plot``: the widget of a notebook, or the results of ``return_img`` and
        ``return_cpos``; otherwise None.

    Raises
    ------
    TypeError, ValueError
        As for ``plotter.vizlight.add_mesh``.

    Warns
    -----
    UserWarning
        If ``volume=True``: PyVista draws volumes with its own light.
    """
    if _check.boolean("sky", sky):
        options = {"occlusion": SKY} | options
    named = {*inspect.signature(pv.plot).parameters} - {"var_item", "kwargs"} | _MORE
    show_options = {name: options.pop(name) for name in [*options] if name in named}
    scene = optional_scene(scene)
    keywords.sorted_out("mesh.vizlight.plot", options, scene, more=named)
    size = None if window_size is None else _size(window_size)
    if camera is not None and not hasattr(camera, "GetPosition"):
        raise _check.type_error("camera", "a pyvista.Camera", camera)
    if isinstance(screenshot, str | Path):
        screenshot = check_output(screenshot, IMAGES, name="screenshot")
    if jupyter_backend is not None:
        _check.text("jupyter_backend", jupyter_backend)
    for name in ("off_screen", "notebook"):
        if show_options.get(name) is not None:
            _check.boolean(name, show_options[name])
    if (
        scene is None
        and scalars is None
        and light == "auto"
        and not (options or show_options.keys() - SHOWN)
    ):
        pixels = (1200, 800) if size is None else (size[0], size[1])
        shown = look(mesh, view=camera, size=pixels).plotter(
            off_screen=show_options.pop("off_screen", None)
        )
        backend = jupyter_backend if shown.notebook else None
        return shown.show(screenshot=screenshot or False, jupyter_backend=backend, **show_options)
    parameters = inspect.signature(pv.Plotter.__init__).parameters
    window = {name: show_options.pop(name) for name in [*show_options] if name in parameters}
    plotter: Foreign = pv.Plotter(window_size=size, **window)
    try:
        if show_options.pop("volume", False):
            _check.warn("volume=True: PyVista draws the volume with its own light")
            plotter.add_volume(mesh, scalars=scalars, **options)
        else:
            plotter.vizlight.add_mesh(mesh, scene=scene, light=light, scalars=scalars, **options)
        _furnish(plotter, show_options)
        if camera is not None:
            plotter.camera = camera.copy()  # type: ignore[no-untyped-call]
    except BaseException:
        plotter.close()
        raise
    # Outside a notebook PyVista warns that it ignores the backend.
    backend = jupyter_backend if plotter.notebook else None
    return plotter.show(screenshot=screenshot or False, jupyter_backend=backend, **show_options)


def _size(window_size: object) -> list[int]:
    sides = _check.vector("window_size", window_size)
    if len(sides) != 2 or not all(1 <= side <= 1 << 14 for side in sides):
        expected = "(width, height), each from 1 to 16384 pixels"
        raise _check.value_error("window_size", expected, sides)
    return [int(side) for side in sides]


def _furnish(plotter: Foreign, show_options: Keywords) -> None:
    """Apply the keywords of ``pyvista.plot`` that are for the plotter, and remove them."""
    background = show_options.pop("background", None)
    if isinstance(background, str | Path) and Path(background).is_file():
        plotter.add_background_image(background)
    elif background is not None:
        plotter.background_color = _check.color("background", background)
    axes, show_axes = plotter.theme.axes, show_options.pop("show_axes", None)
    if axes.show if show_axes is None else show_axes:
        (plotter.add_box_axes if axes.box else plotter.add_axes)()
    if text := show_options.pop("text", ""):
        plotter.add_text(text)
    grid, bounds = show_options.pop("show_grid", False), show_options.pop("show_bounds", False)
    if grid or bounds:
        (plotter.show_grid if grid else plotter.show_bounds)()
    cpos = show_options.pop("cpos", None)
    plotter.camera_position = plotter.get_default_cam_pos() if cpos is None else cpos
    plotter.camera_set = cpos is not None
    smooth = show_options.pop("anti_aliasing", None)
    if smooth is False:
        plotter.disable_anti_aliasing()
    elif smooth is not None:
        plotter.enable_anti_aliasing("msaa" if smooth is True else smooth)
    for effect, names in EFFECTS.items():
        asked_for = [show_options.pop(name, False) for name in names]
        if any(asked_for):
            getattr(plotter, f"enable_{effect}")()
    zoom = show_options.pop("zoom", None)
    if zoom is not None:
        plotter.camera.zoom(zoom)
