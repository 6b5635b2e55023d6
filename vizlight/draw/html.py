"""One HTML file that shows lit meshes, with light in each fragment that follows the eye."""

from __future__ import annotations

import base64
import functools
import html
import io
import json
import string
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import pyvista as pv
from PIL import Image

from vizlight import _check
from vizlight.draw import backends
from vizlight.draw.keywords import is_cloud
from vizlight.draw.page import Page
from vizlight.files import check_output, replace_file
from vizlight.filters import relight
from vizlight.filters.key import TEXTS, preset_of
from vizlight.mesh import records
from vizlight.mesh.blocks import all_blocks
from vizlight.mesh.polylines import backdrop
from vizlight.scene import Scene
from vizlight.shading.results import DEFAULT_NAME
from vizlight.vtk.normals import is_scan

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import ColorLike, Foreign, Given, Keywords
    from vizlight.draw.live import LightAt, Live
    from vizlight.draw.page import Shown

__all__ = ["live_html"]

#: File name extensions of a page.
SUFFIXES = (".html", ".htm")
#: Parts of the script, in their order, and the name of its file beside a page.
SCRIPTS, SCRIPT = ("gl.js", "app.js", "copied.js", "panel.js"), "viewer.js"


def live_html(
    mesh: pv.DataSet | pv.MultiBlock | Mapping[float, pv.DataSet | pv.MultiBlock],
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
    frames: str = "frame",
    files: Literal[1, 2] = 1,
    source: Sequence[str] = (),
    **options: Given,
) -> Path:
    """Write one HTML file that shows a mesh, whose light follows the eye of the reader.

    The file opens from disk and makes no network request. The light of each fragment is computed
    in the browser, by the same text as in a plotter. A panel drags lamps over a lit ball, takes
    light by question, moves material, colours and a cut, goes back, and copies the picture as
    Python or as a command. The page turns by mouse, touch and arrow keys.

    Parameters
    ----------
    mesh : pyvista.DataSet, pyvista.MultiBlock or mapping
        Mesh, which is not changed. Each block has a name in the page and can be switched off. A
        mapping has a mesh for each number, such as the levels of an isosurface or the steps of a
        time: a slider shows one of them.
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
        First camera. Default: the view of the scene or of the mesh's record, otherwise one that
        shows the whole mesh.
    background : colour, optional
        Background colour. Default: black for lines or points alone, otherwise white.
    panel : bool, default: True
        Whether the panel is open at first.
    key : bool, default: True
        Whether the key is shown where the light comes from a preset; scalar bars are shown always.
    frames : str, default: "frame"
        What the numbers of a mapping are, such as ``"time in s"``.
    files : {1, 2}
        2 writes the script to ``viewer.js`` beside the page, for servers whose policy is
        ``script-src 'self'``.
    source : sequence of str, optional
        File that the mesh was read from and options of ``vizlight light`` that light it as here,
        for the texts that the page copies.
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
    vizlight.draw.component.Component.export_html : The same for the meshes of a plotter.

    Notes
    -----
    The page is 80 kB and, before compression, 40 bytes for each point with position, normal,
    tangent and colour: positions in 24 bits from the centre of the scene, whose rounding is 6e-8 of
    their largest coordinate, directions in 16 bits, whose rounding is 3e-5, and up to six arrays in
    16 bits of their range. Differences from point to point are compressed, to about a third. In
    Chromium the picture is within a mean of 1 of 255 of the light of the engine, 99 % of it within
    4. Where something draws, the page has a picture for browsers without WebGL 2.
    """
    path = check_output(path, SUFFIXES)
    given: object = camera
    if given is not None and not isinstance(given, pv.Camera):
        raise TypeError(_check.message("camera", "a pyvista.Camera", _check.describe(given)))
    _check.integer("files", files, low=1, high=2)
    _check.text("frames", frames)
    steps: dict[float, Foreign] = dict(mesh) if isinstance(mesh, Mapping) else {0.0: mesh}
    if not steps:
        raise ValueError(_check.message("mesh", "one mesh or more", "an empty mapping"))
    values = [_check.number("mesh", value) for value in steps]
    plotter: Foreign = pv.Plotter(off_screen=True, notebook=False)
    try:
        chosen = _check.color("background", background)
        owners: list[int | None] = []
        for number, step in enumerate(steps.values()):
            made = plotter.vizlight.add_mesh(
                step, scene=scene, light=light, scalars=scalars, render=False,
                **_lit_points(step) | options,
            )  # fmt: skip
            count = len(made) if isinstance(made, list) else 1
            owners += [number if len(steps) > 1 else None] * count
        every = [block for step in steps.values() for block in all_blocks(step)]
        plotter.background_color = chosen or backdrop(every)
        if camera is None:
            _look(plotter, next(iter(steps.values())), scene)
        else:
            plotter.camera = camera.copy()  # type: ignore[no-untyped-call]
        shown = plotter.vizlight.shown()
        if len(owners) == len(shown):
            shown = [one._replace(frame=frame) for one, frame in zip(shown, owners, strict=True)]
        label = (frames, values) if len(steps) > 1 else None
        return write_page(
            path, shown, plotter, title=title, panel=panel, key=key, frames=label, files=files,
            source=source, auto=chosen is None and plotter.background_color == "white",
        )  # fmt: skip
    finally:
        plotter.close()


def _lit_points(mesh: pv.DataSet | pv.MultiBlock) -> Keywords:
    """Return an option of light, its default, for points that PyVista alone would draw."""
    every = [*all_blocks(mesh)]
    clouds = [block for block in every if is_cloud(block, {})]
    alone = len(clouds) == len(every)
    return {"facing": "auto"} if clouds and (alone or all(map(is_scan, clouds))) else {}


def _look(plotter: Foreign, mesh: pv.DataSet | pv.MultiBlock, scene: Scene | None) -> None:
    """See all that is drawn from where the view of a scene, or of the mesh's record, is."""
    if scene is None and relight.is_lit(mesh):
        scene = Scene.from_dict(records.provenance(mesh, DEFAULT_NAME)["scene"])
    view = None if scene is None or scene.n not in (None, 3) else scene.view
    if view is None:
        plotter.view_isometric(render=False)
        return
    middle = np.reshape(plotter.bounds, (3, 2)).mean(axis=1)
    toward = view.direction or np.subtract(view.position or middle, middle).tolist()
    up = view.up or ((0.0, 1.0, 0.0) if not np.any(toward[:2]) else (0.0, 0.0, 1.0))
    plotter.camera.parallel_projection = view.parallel
    plotter.view_vector(toward, up, render=False)
    if view.position is not None:
        plotter.camera.position, plotter.camera.focal_point = view.position, middle.tolist()


def write_page(
    path: str | Path,
    shown: Sequence[Shown],
    plotter: pv.BasePlotter,
    *,
    files: Literal[1, 2] = 1,
    **content: Given,
) -> Path:
    """Write the page of meshes with live light; see :func:`page_text`.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    path = check_output(path, SUFFIXES)
    beside = path.with_name(SCRIPT)
    text = page_text(shown, plotter, stem=path.stem, script=SCRIPT if files == 2 else "", **content)
    if files == 2:
        replace_file(beside, lambda draft: Path(draft).write_text(viewer(), "utf-8"))
    return replace_file(path, lambda draft: Path(draft).write_text(text, "utf-8"))


def page_text(
    shown: Sequence[Shown],
    plotter: pv.BasePlotter,
    *,
    stem: str = "scene",
    title: str = "",
    panel: bool = True,
    key: bool = True,
    frames: tuple[str, Sequence[float]] | None = None,
    source: Sequence[str] = (),
    auto: bool = False,
    script: str = "",
) -> str:
    """Return the text of a page of meshes with live light.

    Parameters
    ----------
    shown : sequence of Shown
    plotter : pyvista.Plotter
        Plotter with the camera and the lights.
    stem : str
        Name of the pictures that a reader saves.
    title : str
        Title of the page.
    panel, key : bool
        Whether the panel is open at first, and whether the key of a preset's light is shown.
    frames : (str, sequence of float), optional
        What the numbers of the frames are, and the numbers.
    source : sequence of str
        File, and options of the command that lights it alike.
    auto : bool
        Whether nobody chose the background, which is dark then on dark pages.
    script : str
        File of the script; empty for one within the page.

    Returns
    -------
    str
    """
    _check.text("title", title)
    panel, key = _check.boolean("panel", panel), _check.boolean("key", key)
    page = Page(plotter.renderer)
    for one in shown:
        page.add(one)
    page.add_values(shown)
    page.add_bars(plotter, shown)
    if source:
        file, *words = [str(word) for word in source]
        page.recipe |= {"file": file, "command": words}
    content = page.content() | {
        "name": title or stem, "stem": stem, "panel": panel, "frame": 0,
        "frames": None if frames is None else {"label": frames[0], "values": list(frames[1])},
        "key": _key_words(shown[0].live) if key else None, "auto": auto,
    }  # fmt: skip
    text = string.Template(_web("page.html")).substitute(
        title=html.escape(title or "vizlight"),
        heading=html.escape(title or "Scene"),
        # For readers of the screen alone.
        unseen="" if title else ' class="unseen"',
        label=html.escape(title or "Scene", quote=True),
        policy="'self'" if script else "'unsafe-inline'",
        picture=_picture(plotter),
        # A tag within the text would end the script.
        scene=json.dumps(content, allow_nan=False).replace("<", "\\u003c"),
        script=f'<script src="{script}"></script>' if script else f"<script>{viewer()}</script>",
    )
    for notice in page.notices:
        _check.warn(notice)
    return text


@functools.cache
def viewer() -> str:
    """Return the script of all pages, without comments and indentation."""
    parts = [f"const STYLE = {json.dumps(_bare(_web('page.css')))};", *map(_web, SCRIPTS)]
    text = _bare("\n".join(parts)).replace("</script", "<\\/script")
    return f"'use strict';\n(() => {{\n{text}\n}})();\n"


def _bare(text: str) -> str:
    """Return a text without comments of whole lines and without indentation."""
    lines = (line.strip() for line in text.splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("// "))


def _picture(plotter: pv.BasePlotter) -> str:
    """Return an element with the picture of a plotter, empty where nothing draws yet."""
    try:
        backends.choose_backend()
        seen = plotter.screenshot(None, return_img=True)
    except (backends.BackendError, AttributeError):
        # A plotter with a window on a screen has no picture before it is shown.
        return ""
    file = io.BytesIO()
    Image.fromarray(np.asarray(seen)[..., :3]).convert("RGB").save(file, "JPEG", quality=70)
    data = base64.b64encode(file.getvalue()).decode()
    return f'<img id="picture" alt="The scene" src="data:image/jpeg;base64,{data}">'


def _key_words(live: Live) -> list[str] | None:
    """Return the words of the key where the light comes from a preset."""
    if live.scene is None or live.scalars is not None:
        return None
    question = preset_of(live.scene)
    return None if question in (None, "value") else list(TEXTS[question])


def _web(name: str) -> str:
    return resources.files("vizlight.draw").joinpath("web", name).read_text("utf-8")
