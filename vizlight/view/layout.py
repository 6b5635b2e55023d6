"""The widgets of the page, in the order in which they are needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import client, html, vtk
from trame.widgets import vuetify3 as v3

from vizlight.shading.options import Model
from vizlight.view.page import LEVELS
from vizlight.view.state import COLOR_MAPS, RANGES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight.view.page import Page

__all__ = ["lay_out"]

#: What a kind of picture is called.
SHOWN = {"surface": "the surface", "isosurface": "an isosurface", "streamlines": "streamlines"}
SMALL = {"density": "compact", "hide_details": True}
#: Most streamlines of the slider.
MOST_LINES = 2000


def lay_out(page: Page) -> None:
    """Make the widgets of a page.

    Parameters
    ----------
    page : Page
        Page, whose functions the widgets call.
    """
    server, name = page.server, page.worker.file.name
    server.state.trame__title = f"{name} - vizlight"
    with VAppLayout(server):
        with v3.VAppBar(density="compact"):
            v3.VAppBarTitle(name)
            _buttons(page)
        with v3.VNavigationDrawer(width=300, permanent=True):
            _controls(page)
        whole = "position: relative; width: 100%; height: 100%"
        with v3.VMain(style="height: 100vh"), html.Div(style=whole):
            # Beside the controls, not under them.
            _messages(page)
            view = vtk.VtkRemoteView(
                page.stage.plotter.render_window, interactive_ratio=1, still_ratio=1,
                interactive_quality=70, still_quality=95,
            )  # fmt: skip
        # In a second window of another shape the picture is not stretched.
        client.Style("main canvas, main img { object-fit: contain; }")
        page.redraw = view.update
        _script(name)


def _buttons(page: Page) -> None:
    def button(icon: str, text: str, **options: Any) -> None:
        named = [f'title="{text}"', f'aria-label="{text}"']
        v3.VBtn(icon=f"mdi-{icon}", size="small", raw_attrs=named, **options)

    button("undo", "Undo", click=page.undo, disabled=("!can_undo",))
    button("redo", "Redo", click=page.redo, disabled=("!can_redo",))
    button("restore", "Defaults", click=page.defaults)
    button("fit-to-screen-outline", "Show all", click=page.frame_all)
    get = page.server.trigger_name(page.picture)
    png = f"{page.worker.file.stem}.png".replace("'", "_")
    save = f"trigger('{get}').then((p) => p && utils.download('{png}', p, 'image/png'))"
    v3.VBtn("Save picture", click=save, disabled=("!!busy",), prepend_icon="mdi-download")
    v3.VBtn("Copy as Python", click=page.copy, prepend_icon="mdi-language-python")


def _messages(page: Page) -> None:
    top = "position: absolute; z-index: 2; left: 0; right: 0"
    with html.Div(style=top):
        with html.Div(v_if=("!!busy",), classes="busy d-flex align-center bg-surface"):
            v3.VProgressLinear(indeterminate=True, color="primary", height=6)
            html.Span("{{ busy }} …", classes="px-3 text-no-wrap text-caption")
            v3.VBtn("Stop", click=page.stop, size="small", variant="text")
        v3.VAlert(
            "{{ notice }}", v_if=("!!notice",), type="warning", closable=True, density="compact",
            update_modelValue="notice = ''", classes="notice",
        )  # fmt: skip


def _script(name: str) -> None:
    with (
        v3.VDialog(
            model_value=("!!script",),
            update_modelValue="script = ''",
            max_width=860,
        ),  # fmt: skip
        v3.VCard(title=f"The picture of {name} as a Python script"),
    ):
        style = "padding: 0 24px; overflow: auto; font-size: 13px"
        html.Pre("{{ script }}", classes="script", style=style)
        with v3.VCardActions():
            v3.VSpacer()
            v3.VBtn("Copy", click="window.navigator.clipboard.writeText(script)")
            v3.VBtn("Close", click="script = ''")


def _controls(page: Page) -> None:
    facts = page.facts
    _heading("What")
    if len(facts.shows) > 1:
        _select("show", "Show", [(SHOWN[kind], kind) for kind in facts.shows])
    iso = "show == 'isosurface'"
    if "isosurface" in facts.shows:
        _select("array", "of", _named(list(facts.scalars)), v_show=(iso,))
        _slider("level_at", "level", (0, LEVELS), 1, shown="level", v_show=(iso,))
        _number("level", "exact level", v_show=(iso,))
    if facts.flat and facts.scalars:
        _select("heights", "Heights", [("flat", ""), *_named(list(facts.scalars))])
        _number("factor", "exaggeration", v_show=("!!heights",))
    lines = "show == 'streamlines'"
    if "streamlines" in facts.shows:
        _select("vectors", "along", _named(facts.vectors), v_show=(lines,))
        _slider("lines", "lines", (20, MOST_LINES), 20, v_show=(lines,))
    if facts.vectors and facts.dimension > 1:
        plain = [("as a surface", ""), *[(f"by {name}", name) for name in facts.vectors]]
        _select("tangents", "Lit", plain, v_show=(f"!({lines})",))
        v3.VCheckbox(
            v_model=("conditioned",), label="conditioned by the surface", **SMALL,
            v_show=(f"!!tangents && !({lines})",),
        )  # fmt: skip
    _slider("line_width", "line width", (0.5, 6), 0.5, v_show=("lined",))
    arrays = [*facts.scalars, *facts.vectors]
    if arrays:
        _heading("Colour")
        items = [("light alone", ""), *_named(arrays)]
        page.server.state.colors = [{"title": title, "value": value} for title, value in items]
        # An isosurface is not coloured by its own constant.
        offered = f"colors.filter((c) => !({iso}) || c.value != array)"
        v3.VSelect(v_model=("color",), items=(offered,), label="Colour by", **SMALL)
        _select("cmap", "Map", _named(COLOR_MAPS), v_show=("!!color",))
    _heading("Light")
    v3.VCheckbox(v_model=("shoulder",), label="follows the eye", **SMALL)
    for name in ("azimuth", "altitude"):
        _slider(name, name, RANGES[name], 1)
    _slider("fill", "fill light", (0, 1), 0.01)
    _select("model", "Reflection", _named(get_args(Model)[:2]), v_show=("!lined",))
    _select("model", "Reflection", _named(get_args(Model)), v_show=("lined",))
    _heading("Material")
    for name, high in (("ambient", 1), ("diffuse", 2), ("specular", 2)):
        _slider(name, name, (0, high), 0.01)
    _slider("shininess", "shininess", RANGES["shininess"], 1)
    _heading("Depth cue")
    _slider("cue", "fade", (0, 1), 0.05)


def _heading(text: str) -> None:
    html.Div(text, classes="text-overline px-4 pt-2")


def _named(names: Sequence[str]) -> list[tuple[str, str]]:
    return [(name, name) for name in names]


def _select(name: str, label: str, items: Sequence[tuple[str, str]], **options: Any) -> None:
    offered = [{"title": title, "value": value} for title, value in items]
    v3.VSelect(
        v_model=(name,), items=(f"{name}_of_{len(items)}", offered), label=label, **SMALL,
        **options,
    )  # fmt: skip


def _slider(
    name: str, label: str, ends: tuple[float, float], step: float, shown: str = "", **options: Any
) -> None:
    with v3.VSlider(
        v_model=(name,), min=ends[0], max=ends[1], step=step, classes=f"px-3 slider-{name}",
        color="primary", thumb_size=14, **SMALL, **options,
    ):  # fmt: skip
        with v3.Template(v_slot_prepend=True):
            html.Span(label, classes="text-caption", style="width: 84px")
        with v3.Template(v_slot_append=True):
            html.Span(f"{{{{ {shown or name} }}}}", classes="text-caption", style="width: 40px")


def _number(name: str, label: str, **options: Any) -> None:
    v3.VTextField(
        model_value=(name,), label=label, type="number", variant="underlined",
        classes=f"px-4 pt-2 number-{name}", **SMALL, **options,
        change=f"{name} = Number($event.target.value)",
    )  # fmt: skip
