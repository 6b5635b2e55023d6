"""One HTML file that shows lit meshes, with light in each fragment that follows the eye."""

from __future__ import annotations

import base64
import html
import io
import json
import string
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyvista as pv
from PIL import Image

from vizlight import _check, files
from vizlight.filters.key import TEXTS, key_picture, preset_of
from vizlight.mesh.blocks import all_blocks
from vizlight.mesh.polylines import backdrop
from vizlight.plotting.page import Page
from vizlight.scene import Scene, View

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import ColorLike
    from vizlight.plotting.live import LightAt, Live
    from vizlight.plotting.page import Shown

__all__ = ["live_html"]

#: File name extensions of a page.
SUFFIXES = (".html", ".htm")


def live_html(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    scene: Scene | None,
    path: str | Path,
    *,
    title: str = "",
    light: LightAt = "auto",
    scalars: str | None = None,
    camera: pv.Camera | None = None,
    background: ColorLike | None = None,
    panel: bool = True,
    key: bool = True,
    **options: Any,
) -> Path:
    """Write one HTML file that shows a mesh, whose light follows the eye of the reader.

    The file opens from disk and makes no network request. The light of each fragment is computed
    in the browser, by the same text as in a plotter; sliders change lights and material. The page
    turns by mouse, touch and arrow keys.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh, which is not changed. Each block has a name in the page and can be switched off.
    scene : Scene or None
        Lights, material and depth cue; the reader's eye takes the place of its view. None for the
        record of a lit mesh, otherwise PyVista's lights.
    path : path
        Path of the file, which ends in .html or .htm. An existing file is replaced.
    title : str, default: ""
        Title of the page.
    light : {"auto", "points", "fragments"}
        Place where the light is computed. Where the light of a fragment cannot be computed, and
        with "points", the colours of the points have ambient and diffuse light, which does not
        depend on the eye; a notice on the page and a warning say so. For an eye in *n*-space, which
        is not the reader's, they have the whole light.
    scalars : str, optional
        Name of the array that gives the colours, as for ``plotter.vizlight.add_mesh``.
    camera : pyvista.Camera, optional
        First camera. Default: one that shows the whole mesh.
    background : colour, optional
        Background colour. Default: black for lines alone, otherwise white.
    panel : bool, default: True
        Whether the panel of the sliders is open at first.
    key : bool, default: True
        Whether the key is shown where the light comes from a preset; scalar bars are shown always.
    **options
        As for ``plotter.vizlight.add_mesh``: options of :func:`vizlight.illuminate`, such as
        ``tangents=`` and ``conditioned=``, and keywords of ``pyvista.Plotter.add_mesh``, such as
        ``cmap``, ``clim``, ``opacity`` and ``line_width``.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, as for :func:`vizlight.illuminate`.
    FileError
        If the file cannot be written.

    Warns
    -----
    UserWarning
        If the light of a mesh does not follow the eye, with the reason.

    See Also
    --------
    vizlight.plotting.component.Component.export_html : The same for the meshes of a plotter.

    Notes
    -----
    The page is 0.43 MB and, before compression, 40 bytes for each point with position, normal,
    tangent and colour: positions in 24 bits from the centre of the scene, whose rounding is 6e-8 of
    their largest coordinate, directions in 16 bits, whose rounding is 3e-5. Differences from point
    to point are compressed, to about a third. Colours are mapped at the points. In Chromium the
    picture is within a mean of 1 of 255 of the light of the engine, 99 % of it within 4.
    """
    path = files.check_output(path, SUFFIXES)
    plotter: Any = pv.Plotter(off_screen=True, notebook=False)
    try:
        chosen = _check.color("background", background)
        plotter.vizlight.add_mesh(
            mesh, scene=scene, light=light, scalars=scalars, render=False, **options
        )
        plotter.background_color = chosen or backdrop(all_blocks(mesh))
        given: object = camera
        if given is not None and not isinstance(given, pv.Camera):
            got = _check.describe(given)
            raise TypeError(_check.message("camera", "a pyvista.Camera", got))
        if camera is not None:
            plotter.camera = camera.copy()  # type: ignore[no-untyped-call]
        return plotter.vizlight.export_html(path, title=title, panel=panel, key=key)  # type: ignore[no-any-return]
    finally:
        plotter.close()


def write_page(
    path: str | Path,
    shown: Sequence[Shown],
    plotter: pv.BasePlotter,
    *,
    title: str = "",
    panel: bool = True,
    key: bool = True,
) -> Path:
    """Write the page of meshes with live light.

    Parameters
    ----------
    path : path
    shown : sequence of Shown
    plotter : pyvista.Plotter
        Plotter with the camera and the lights.
    title : str
        Title of the page.
    panel : bool
        Whether the panel is open at first.
    key : bool
        Whether the key of a preset's light is shown.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    path = files.check_output(path, SUFFIXES)
    _check.text("title", title)
    panel, key = _check.boolean("panel", panel), _check.boolean("key", key)
    renderer = plotter.renderer
    page = Page(renderer)
    for one in shown:
        page.add(one)
    page.add_bars(plotter, shown)
    dark = sum(page.background) < 1.5
    channels = [round(255 * c) for c in page.background]
    text = string.Template(_web("page.html")).substitute(
        title=html.escape(title or "vizlight"),
        heading=html.escape(title),
        label=html.escape(title or "Scene", quote=True),
        scheme="dark" if dark else "light",
        background=f"rgb({', '.join(map(str, channels))})",
        open=" open" if panel else "",
        # A tag within the text would end the script.
        key=_key(shown[0].live, plotter) if key else "",
        scene=json.dumps(page.content(), allow_nan=False).replace("<", "\\u003c"),
        viewer=_web("viewer.min.js").replace("</script", "<\\/script"),
    )
    written = files.replace_file(path, lambda draft: Path(draft).write_text(text, "utf-8"))
    for notice in page.notices:
        _check.warn(notice)
    return written


def _key(live: Live, plotter: pv.BasePlotter) -> str:
    """Return the figure of a key where the light comes from a preset, with its words."""
    if live.scene is None or live.scalars is not None:
        return ""
    question = preset_of(live.scene)
    if question in (None, "value"):
        return ""
    scene = live.scene.replace(view=View.from_camera(plotter.camera))
    seen = key_picture(scene, question=question, exponent=live.source.options.exponent)
    file = io.BytesIO()
    Image.fromarray(seen).save(file, "PNG")
    data = base64.b64encode(file.getvalue()).decode()
    words = "".join(f"<span>{html.escape(word)}</span>" for word in TEXTS[question])
    alt = html.escape(f"Key: {' to '.join(TEXTS[question])}", quote=True)
    image = f'<img src="data:image/png;base64,{data}" alt="{alt}" width="{seen.shape[1] // 2}">'
    return f'<figure class="key">{image}<figcaption class="numbers">{words}</figcaption></figure>'


def _web(name: str) -> str:
    return resources.files("vizlight.plotting").joinpath("web", name).read_text("utf-8")
