"""The viewer of a page: its panel, lamps, sliders, and what keys, fingers and the mouse do."""

import base64
import io
import os
import re
from pathlib import Path

import browsers
import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, shiny
from PIL import Image
from shapes import torus

import vizlight
from vizlight import Light, Material, Scene, View, presets
from vizlight.draw import html

pytestmark = pytest.mark.opengl

#: The checker of the npm package axe-core, of the viewer's recipe or of a variable.
AXE = Path(vizlight.__file__).parent / "draw/web/node_modules/axe-core/axe.min.js"
AXE = Path(os.environ.get("VIZLIGHT_AXE", AXE))

FAR = Light(direction=(1, 0.9, 0.5), intensity=0.8)


def slide(page, label, value):
    page.get_by_label(label, exact=True).evaluate(
        """(input, x) => {
        input.value = x;
        ['input', 'change'].forEach((kind) => input.dispatchEvent(new Event(kind)));
        }""",
        value,
    )


def test_panel_moves_light_and_material_and_back(opened, tmp_path):
    page, seen = opened(
        browsers.plain_page(tmp_path, title="A <ball> & more"), bare=False, **browsers.WIDE
    )
    assert page.title() == "A <ball> & more"
    first = browsers.shot(page)
    for label, value in (
        ("Brightness", 0.3), ("Ambient", 0.6), ("Diffuse", 0.1), ("Highlight", 0), ("Sharpness", 3),
        ("Depth fade", 0.8),
    ):  # fmt: skip
        slide(page, label, value)
        page.mouse.move(5, 5)
        assert np.abs(browsers.shot(page) - first)[:, :400].max() > 15, label
        page.keyboard.press("Control+z")
        np.testing.assert_array_equal(browsers.shot(page)[:, :400], first[:, :400])
    page.keyboard.press("Control+y")
    assert np.abs(browsers.shot(page) - first)[:, :400].max() > 15
    page.keyboard.press("Control+z")
    page.get_by_role("radio", name="Eye").check()
    held = browsers.shot(page)
    np.testing.assert_allclose(held[:880, :400], first[:880, :400], atol=2)
    before = page.evaluate(
        "vizlight.draw(), vizlight.lightOf(vizlight.leader, []).numbers.vizLight0"
    )
    browsers.turn(page, 90)
    after = page.evaluate("vizlight.lightOf(vizlight.leader, []).numbers.vizLight0")
    np.testing.assert_allclose(after, before)
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save picture").click()
    picture = np.array(Image.open(saved.value.path()).convert("RGB"), dtype=np.int16)
    # The title stands above it.
    top = browsers.WIDE["viewport"]["height"] - len(picture)
    assert 20 < top < 60
    assert np.abs(picture[:, :400] - browsers.shot(page)[top:, :400]).mean() < 5
    assert seen == [(tmp_path / "ball.html").as_uri()]


def test_the_light_of_the_sky_is_switched_off_and_on(opened, tmp_path):
    ball = pv.Sphere(theta_resolution=60, phi_resolution=60)
    ball["sky"] = np.linspace(0.1, 0.7, ball.n_points)
    scene = Scene(lights=FAR, material=shiny(ambient=0.5))
    pages = {}
    for name, options in (("sky", {"occlusion": "sky"}), ("open", {})):
        command = ["a.vtp", "--occlusion=sky"] if options else ["a.vtp"]
        path = vizlight.live_html(
            ball, tmp_path / f"{name}.html", scene=scene, source=command, **options
        )
        pages[name], _ = opened(path, bare=False, **browsers.WIDE)
    page, switch = pages["sky"], pages["sky"].get_by_label("Light of the sky in hollows")
    assert pages["open"].get_by_label("Light of the sky in hollows").count() == 0
    first, free = (browsers.shot(pages[name])[:, :840].astype(int) for name in ("sky", "open"))
    assert np.abs(first - free).max() > 30
    read = "() => Object.values(vizlight.texts()).join('')"
    assert page.evaluate(read).count("sky") == 2 + page.evaluate(read).count("sky.")
    switch.uncheck()
    assert np.abs(browsers.shot(page)[:, :840] - free).max() <= 2
    assert page.evaluate(read).count("sky") == page.evaluate(read).count("sky.")
    page.keyboard.press("Control+z")
    np.testing.assert_array_equal(browsers.shot(page)[:, :840], first)


@pytest.mark.skipif(not AXE.exists(), reason="npm's axe-core is not installed")
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(scheme, opened, tmp_path):
    mesh = torus()
    mesh["sky"] = np.ones(mesh.n_points)
    scene = presets.shape()
    for width, title, frames in ((1200, "", False), (400, "A ring", True)):
        meshes = {0.5: mesh, 1.5: torus(centre=(1, 0, 0))} if frames else mesh
        options = {} if frames else {"scalars": "height", "occlusion": "sky"}
        path = vizlight.live_html(meshes, tmp_path / "a.html", scene=scene, title=title, **options)
        look = {"viewport": {"width": width, "height": 900}, "color_scheme": scheme}
        page, _ = opened(path, bare=False, bypass_csp=True, **look)
        page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
        page.evaluate("document.body.classList.remove('folded')")  # as it is at first on telephones
        page.get_by_role("button", name="Copy as Python").click()
        for asked in ("dialog", "document"):
            page.evaluate(AXE.read_text("utf-8"))
            run = "axe.run().then((made) => made.violations.map((one) => one.id))"
            assert page.evaluate(run) == [], asked
            page.evaluate("document.querySelectorAll('dialog').forEach((one) => one.close())")


def test_lamps_are_dragged_over_the_ball_and_past_its_rim(opened, tmp_path):
    page, _ = opened(browsers.plain_page(tmp_path), bare=False, **browsers.WIDE)
    box = page.locator(".pad").bounding_box()
    middle = np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])
    read = "vizlight.seen(vizlight.lamps[0], [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])"
    page.get_by_role("radio", name="Eye").check()
    first = browsers.shot(page)
    page.mouse.move(*middle)
    page.mouse.down()
    for share, expected in ((0.95, -0.5), (0.0, 1.0), (0.5, None)):
        page.mouse.move(*(middle - (share * box["width"] / 2, 0)))
        x, y, z = page.evaluate(read)
        assert x <= 0.02
        assert abs(y) < 0.02
        assert expected is None or z * expected > 0.4
    page.mouse.up()
    assert np.abs(browsers.shot(page) - first)[:, :400].max() > 20
    assert page.evaluate("vizlight.state.look") == "*"
    page.locator(".lamp").focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate(read)[0] > x
    page.get_by_label("Add a lamp").click()
    assert page.locator(".lamp").count() == 2
    page.get_by_label("Remove the lamp").click()
    page.get_by_label("Remove the lamp").click()
    assert browsers.shot(page)[:, :400].min() >= 0


def test_the_panel_is_folded_on_a_telephone_at_first(opened, tmp_path):
    page, _ = opened(
        browsers.plain_page(tmp_path), bare=False, viewport={"width": 390, "height": 800}
    )
    assert page.evaluate("vizlight.canvas.clientHeight") > 700
    page.get_by_label("Show or hide the panel (H)").click()
    assert page.get_by_role("button", name="Save picture").is_visible()


def test_a_slider_shows_one_of_the_frames(shown):
    frames = {level: pv.Sphere(radius=level) for level in (0.5, 1.0, 2.0)}
    scene = Scene(lights=FAR, view=View(direction=(1, 0, 0)))
    page = shown(frames, scene, frames="level in m", wide=True)
    counts = []
    for i in range(3):
        slide(page, "level in m", i)
        counts.append(int((browsers.shot(page)[:, :600].max(axis=2) > 40).sum()))
    assert counts[0] > 0
    assert counts[1] > 3 * counts[0]
    assert counts[2] > 3 * counts[1]
    page.keyboard.press("Control+z")
    assert page.evaluate("vizlight.state.frame") == 1


def test_a_cut_leaves_one_side(opened, tmp_path):
    camera = vizlight.render.camera_on(pv.Sphere(), (0, 0, 1), parallel=True)
    page, _ = opened(browsers.plain_page(tmp_path, camera=camera))
    page.evaluate("() => vizlight.change({ cut: { axis: 0, at: 0.5, far: false } })")
    seen = browsers.shot(page).max(axis=2) > 0
    middle = {"width": 300, "height": 250}["width"] // 2
    assert seen[:, : middle - 1].sum() > 1000
    assert not seen[:, middle + 2 :].any()
    page.evaluate("() => vizlight.change({ cut: { axis: 0, at: 0.5, far: true } })")
    assert not (browsers.shot(page).max(axis=2) > 0)[:, : middle - 2].any()


def test_loops_of_the_mouse_leave_no_tilt(opened, tmp_path):
    eye = pv.Camera()
    # Upright to the axis of the view, as some programs write it.
    eye.position, eye.focal_point, eye.up = (0.5, -3, 3), (0.5, 0, 0), (0, 1, 1)
    page, _ = opened(browsers.plain_page(tmp_path, camera=eye))
    first = page.evaluate("vizlight.state.camera")
    assert first["up"] == [0, 0, 1]
    for _ in range(4):
        for step in ("0.4, 0", "0, 0.3", "-0.4, 0", "0, -0.3"):
            page.evaluate(f"vizlight.orbit({step})")
    last = page.evaluate("vizlight.state.camera")
    np.testing.assert_allclose(last["position"], first["position"], atol=1e-9)
    assert last["up"] == first["up"]
    # No drag passes the pole, beyond which the horizon would be upside down.
    page.evaluate("vizlight.orbit(0, 9)")
    x, y, z = page.evaluate("vizlight.state.camera.position")
    assert z > 20 * np.hypot(x, y)


def halves(picture):
    """Return the first column in which the colours of the right are, and those of both sides."""
    row = picture[len(picture) // 4].astype(int)
    apart = np.abs(row - row[0]).max(axis=1) > 60
    return int(np.argmax(apart)), row[0], row[-1]


def test_a_divider_parts_two_frames(opened, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(300, 250))
    even = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
    for color in ("red", "blue"):
        plotter.vizlight.add_mesh(pv.Plane(i_size=4, j_size=4), scene=even, color=color)
    plotter.view_xy()
    plotter.camera.zoom(4)
    shown = [mesh._replace(frame=i) for i, mesh in enumerate(plotter.vizlight.shown())]
    names = ("Red | blue", ("Red", "blue"))
    path = html.write_page(tmp_path / "split.html", shown, plotter, frames=names)
    page, seen = opened(path, bare=False)
    still = re.search(r'id="picture"[^>]*base64,([^"]+)', path.read_text("utf-8"))[1]
    for picture in (np.array(Image.open(io.BytesIO(base64.b64decode(still)))), browsers.shot(page)):
        middle, left, right = halves(picture)
        assert abs(middle - 150) < 4
        assert left[0] > left[2] + 200
        assert right[2] > right[0] + 200
    line = page.get_by_role("slider", name="Red | blue")
    assert line.get_attribute("aria-valuetext") == "50 % Red"
    line.focus()
    page.keyboard.press("ArrowLeft")
    assert abs(halves(browsers.shot(page))[0] - 147) < 4
    page.mouse.move(147, 60)
    page.mouse.down()
    page.mouse.move(60, 60)
    page.mouse.up()
    assert abs(halves(browsers.shot(page))[0] - 60) < 4
    before = page.evaluate("vizlight.state.camera.position")
    page.mouse.move(200, 200)
    page.mouse.down()
    page.mouse.move(230, 200)
    page.mouse.up()
    assert page.evaluate("vizlight.state.camera.position") != before
    assert page.locator("#panel").count() == 0
    assert seen == [path.as_uri()]


def test_keys_and_fingers_turn_the_page(opened, tmp_path):
    page, _ = opened(browsers.plain_page(tmp_path), has_touch=True)
    where = """() => {
        const { position, focal } = vizlight.state.camera;
        return [position, Math.hypot(...position.map((x, i) => x - focal[i]))];
    }"""
    first, far = page.evaluate(where)
    page.keyboard.press("Tab")
    page.keyboard.press("ArrowLeft")
    turned, same = page.evaluate(where)
    assert np.linalg.norm(np.subtract(turned, first)) > 0.02 * far
    assert same == pytest.approx(far)
    page.keyboard.press("+")
    assert page.evaluate(where)[1] == pytest.approx(far / 1.1)
    page.keyboard.press("r")
    assert page.evaluate(where)[0] == pytest.approx(first)
    wire = page.context.new_cdp_session(page)

    def touch(kind, *points):
        rows = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        wire.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": rows})

    touch("touchStart", (100, 150))
    for i in range(10):
        touch("touchMove", (100 + 8 * i, 150))
    touch("touchEnd")
    turned, same = page.evaluate(where)
    assert np.linalg.norm(np.subtract(turned, first)) > 0.1 * far
    assert same == pytest.approx(far)
    touch("touchStart", (150, 150), (200, 150))
    for i in range(10):
        touch("touchMove", (150 - 5 * i, 150), (200 + 5 * i, 150))
    touch("touchEnd")
    assert page.evaluate(where)[1] < 0.8 * far


def test_several_meshes_can_be_switched_off_each(shown):
    both = pv.MultiBlock({"ball": pv.Sphere(), "ring": torus().translate((0, 0, 1))})
    page = shown(both, Scene(lights=FAR, material=SHINY), wide=True)
    every = browsers.shot(page)[60:880, :840]
    for name in ("ball", "ring"):
        page.get_by_role("checkbox", name=name).uncheck()
        seen = browsers.shot(page)[60:880, :840]
        assert np.abs(seen - every).max() > 30
    assert seen.max() == 0


def test_many_meshes_stand_in_a_closed_list_after_the_sliders(shown):
    many = pv.MultiBlock({f"ball {i}": pv.Sphere(radius=0.1, center=(i, 0, 0)) for i in range(12)})
    page = shown(many, Scene(lights=FAR, material=SHINY), wide=True)
    meshes = page.locator("details", has_text="Meshes (12)")
    assert not meshes.evaluate("(list) => list.open")
    meshes.locator("summary").focus()
    page.keyboard.press("Enter")
    page.get_by_label("ball 7", exact=True).uncheck()
    every = page.get_by_label("All", exact=True)
    assert every.evaluate("(box) => box.indeterminate")
    every.check()
    assert browsers.shot(page)[60:880, :840].max() > 30
    every.uncheck()
    assert browsers.shot(page)[60:880, :840].max() == 0


def test_pages_show_what_the_picture_shows_without_light(opened, tmp_path):
    """Lines, balls in the lamps of the plotter, and sheets in colours of their own."""
    plotter = pv.Plotter(off_screen=True, window_size=(300, 250))
    line = pv.Line((-1, 0.6, 0), (1, 0.6, 0))
    plotter.add_mesh(line, color="red", line_width=8, lighting=False)
    balls = pv.PolyData([(-0.6, -0.5, 0.0), (0.2, -0.5, 0.0)])
    style = {"point_size": 60, "render_points_as_spheres": True}
    plotter.add_mesh(balls, color="#80c0c0", **style)
    sheet = pv.Plane(center=(0.9, -0.5, 0), i_size=0.5, j_size=0.6, i_resolution=2, j_resolution=1)
    sheet.cell_data["kind"] = [0.0, 1.0]
    plotter.add_mesh(sheet, lighting=False, cmap=["#205080", "#e0a030"], show_scalar_bar=False)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    expected = np.asarray(plotter.screenshot(return_img=True), dtype=np.int16)
    page, seen = opened(plotter.vizlight.export_html(tmp_path / "plain.html"))
    assert np.mean(np.abs(browsers.shot(page) - expected).max(axis=2) > 40) < 0.01
    assert (expected < 250).any(axis=2).mean() > 0.1
    assert len(seen) == 1


def test_pages_have_the_title_and_the_bar_of_the_margin(opened, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(300, 250))
    scene = Scene(lights=FAR)
    plotter.vizlight.add_mesh(pv.Sphere(), scene=scene)
    colors = pv.LookupTable("viridis", scalar_range=(0, 40))
    title = "sea_temperature (K); a month"
    plotter.vizlight.add_key(scene, question="value", cmap=colors, title=title)
    path = plotter.vizlight.export_html(tmp_path / "bar.html")
    page, _ = opened(path, bare=False, viewport={"width": 900, "height": 700})
    assert page.get_by_role("heading", level=1).inner_text() == "Sea temperature; a month"
    bar = page.locator(".bar")
    assert bar.locator("figcaption").inner_text() == "K"
    ticks = bar.locator(".ticks span")
    left, _, wide, _ = bar.locator(".strip").bounding_box().values()
    for i, word in enumerate(("0", "10", "20", "30", "40")):
        assert ticks.nth(i).inner_text() == word
        x, _, width, _ = ticks.nth(i).bounding_box().values()
        assert abs(x + width / 2 - (left + wide * i / 4)) < 1
    # Beside the data, not on them.
    canvas, legend = page.locator("#canvas").bounding_box(), bar.bounding_box()
    assert canvas["y"] + canvas["height"] <= legend["y"]
    path = plotter.vizlight.export_html(tmp_path / "bare.html", key=False)
    page, _ = opened(path, bare=False)
    assert not page.locator(".bar").count()


def test_a_map_is_tilted_and_turned_about_its_up(opened, tmp_path):
    sheet = pv.Plane(i_size=4, j_size=3, i_resolution=8, j_resolution=6)
    camera = vizlight.render.camera_on(sheet, (0, 0, 1), parallel=True)
    path = vizlight.live_html(
        sheet, tmp_path / "map.html", scene=Scene(lights=FAR), camera=camera, panel=False
    )
    page, _ = opened(path)
    first = browsers.shot(page)
    page.mouse.move(150, 125)
    page.mouse.down()
    for x, y in ((200, 90), (150, 200), (100, 60), (150, 125)):
        page.mouse.move(x, y)
    page.mouse.up()
    # From above as at first, though some of the loop was beyond the end.
    assert np.mean(np.abs(browsers.shot(page) - first).max(axis=2) > 60) < 0.02
    page.mouse.down()
    page.mouse.move(190, 85, steps=4)
    page.mouse.up()
    camera = page.evaluate("vizlight.state.camera")
    assert camera["up"] == [0, 0, 1]
    away = np.subtract(camera["position"], camera["focal"])
    assert 0.05 < abs(away[2]) / np.linalg.norm(away) < 0.9
    page.keyboard.press("r")
    # Within the ring of the focus.
    np.testing.assert_array_equal(browsers.shot(page)[5:-5, 5:-5], first[5:-5, 5:-5])
