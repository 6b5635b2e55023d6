"""Notebooks: the server keeps the light live, and the browser is not left to draw it."""

import io
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import browsers
import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY
from PIL import Image

import vizlight
from vizlight import Light, Scene, View
from vizlight.draw import component, notebook

pytestmark = pytest.mark.opengl

MISSING = browsers.missing("trame_pyvista", "nest_asyncio2", "playwright")
SCENE = Scene(lights=Light(direction=(1, 0.6, 0.5)), material=SHINY)

#: A notebook's kernel in small: an event loop, in which PyVista shows a plotter in its default way.
KERNEL = """
import asyncio, json, sys
import pyvista as pv
import vizlight.draw.component
from vizlight import Light, Material, Scene

async def kernel():
    plotter = pv.Plotter(notebook=True, off_screen=True, window_size=(400, 400))
    plotter.background_color = "black"
    ball = pv.Sphere(theta_resolution=90, phi_resolution=90)
    shiny = Material(ambient=0.1, diffuse=0.5, specular=0.4)
    scene = Scene(lights=Light(direction=(1, 0.6, 0.5)), material=shiny)
    plotter.vizlight.add_mesh(ball, scene=scene, light="points")
    plotter.view_vector((1, 0.2, 0.1))
    how = {"handler": lambda viewer, url, **_: url, "server_proxy_enabled": False}
    url = plotter.show(jupyter_backend="trame", return_viewer=True, jupyter_kwargs=how)
    print("URL", url, flush=True)
    loop = asyncio.get_running_loop()
    while await loop.run_in_executor(None, sys.stdin.readline):
        camera = plotter.camera
        print("CAMERA", json.dumps([camera.position, camera.focal_point, camera.up]), flush=True)

asyncio.run(kernel())
"""


def highlight(picture):
    """Return where the highlight of a ball is, from its centre in units of its radius."""
    bright = picture.astype(float).mean(axis=-1)
    rows, columns = np.nonzero(bright > 8)
    centre = np.array([columns.min() + columns.max(), rows.min() + rows.max()]) / 2
    rows, columns = np.nonzero(bright > 0.97 * bright.max())
    return (np.array([columns.mean(), rows.mean()]) - centre) / (
        np.ptp(np.nonzero(bright > 8)[1]) / 2
    )


def baked(camera, view):
    """Return PyVista's picture of a ball with the light of a view."""
    ball = pv.Sphere(theta_resolution=90, phi_resolution=90)
    lit = vizlight.illuminate(ball, SCENE.replace(view=view))
    plotter = pv.Plotter(off_screen=True, window_size=(400, 400))
    plotter.background_color = "black"
    plotter.add_mesh(
        lit, scalars="luminance", cmap="gray", clim=(0, 1), lighting=False, show_scalar_bar=False
    )
    plotter.camera = camera
    return np.array(plotter.screenshot(None, return_img=True))


def answer(process, word):
    """Return what a process prints after a word."""
    for line in process.stdout:
        if line.startswith(word):
            return line.removeprefix(word).strip()
    raise AssertionError(f"the kernel ended without {word}")


def dragged(url):
    """Return pictures of a page before and after a drag."""
    from playwright.sync_api import sync_playwright

    shots = []
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=browsers.CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 500, "height": 450})
        page.goto(url)
        for turn in range(2):
            picture, still = None, 0
            for _ in range(300):
                page.wait_for_timeout(100)
                last, picture = picture, shot(page)[70:]
                # The page fades in; a ball has its highlight and, once turned, another one.
                good = picture.max() > 200 and (not turn or np.any(picture != shots[0]))
                still = still + 1 if good and np.array_equal(picture, last) else 0
                if still == 4:
                    break
            shots.append(picture)
            if not turn:
                page.mouse.move(200, 200)
                page.mouse.down()
                for i in range(12):
                    page.mouse.move(200 + 10 * i, 200 + 3 * i)
                    page.wait_for_timeout(50)
                page.mouse.up()
        browser.close()
    return shots


@pytest.mark.skipif(bool(MISSING), reason=f"needs {', '.join(MISSING)}")
def test_highlight_follows_a_drag_in_the_browser():
    process = subprocess.Popen(
        [sys.executable, "-c", KERNEL],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    )  # fmt: skip
    try:
        url = answer(process, "URL")
        # A driver of another test may have the loop of this thread.
        with ThreadPoolExecutor(1) as pool:
            shots = pool.submit(dragged, url).result(300)
        process.stdin.write("camera\n")
        process.stdin.flush()
        position, focal, up = json.loads(answer(process, "CAMERA"))
    finally:
        process.stdin.close()
        process.wait(20)
        process.stdout.close()
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = position, focal, up
    first = View(position=tuple(np.linalg.norm(position) * np.array((1, 0.2, 0.1)) / 1.0247))
    seen = highlight(shots[1])
    assert np.abs(seen - highlight(shots[0])).max() > 0.2
    np.testing.assert_allclose(seen, highlight(baked(camera, View.from_camera(camera))), atol=0.04)
    stale = highlight(baked(camera, first))
    assert np.abs(seen - stale).max() > 0.08


def live_plotter(**options):
    plotter = pv.Plotter(off_screen=True, window_size=(40, 40), **options)
    assert isinstance(plotter.vizlight, component.Component)
    plotter.vizlight.add_mesh(pv.Sphere(), scene=SCENE)
    return plotter


def test_browser_is_not_left_to_draw_live_light():
    shown = notebook.Guarded("client", lambda plotter, **options: options)
    plotter = live_plotter()
    with pytest.raises(ValueError, match="jupyter_backend: expected 'html', or server rendering"):
        shown(plotter)
    plotter.clear_actors()
    assert shown(plotter, screenshot=None) == {"screenshot": None}


def test_default_backend_draws_live_light_on_the_server():
    shown = notebook.Guarded("trame", lambda plotter, **options: options)
    plotter = live_plotter()
    assert shown(plotter) == {"mode": "server"}
    with pytest.raises(ValueError, match="got 'client'"):
        shown(plotter, mode="client")


@pytest.mark.parametrize("registered", [True, False])
def test_the_page_is_a_frame_of_the_notebook(registered, monkeypatch):
    from pyvista.jupyter import _custom_backends

    if not registered:
        monkeypatch.delitem(_custom_backends, "html", raising=False)
    mesh = pv.Sphere()
    frame = mesh.vizlight.plot(
        scene=SCENE, off_screen=True, notebook=True, jupyter_backend="html", return_viewer=True
    )
    text = frame._repr_html_()
    assert text.startswith('<iframe srcdoc="&lt;!doctype html&gt;')
    assert "allow-same-origin" not in text
    assert frame.text.count("<script>") == 1


def shot(page):
    return np.array(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)


def test_an_exported_notebook_stays_interactive(browser, tmp_path):
    plotter = live_plotter()
    shown = notebook.Guarded("html", lambda plotter, **options: options)(plotter)
    path = tmp_path / "notebook.html"
    path.write_text(f"<html><body>{shown._repr_html_()}{shown._repr_html_()}</body></html>")
    page = browser.new_page(viewport={"width": 800, "height": 900})
    page.goto(path.as_uri())
    for frame in page.frames[1:]:
        frame.wait_for_selector("body[data-ready]")
    first = shot(page)
    page.mouse.move(300, 200)
    page.mouse.down()
    page.mouse.move(450, 260, steps=5)
    page.mouse.up()
    page.wait_for_timeout(400)
    assert np.abs(shot(page) - first)[:420].max() > 30
    page.close()


EXPORTS = ["export_html", "export_vtksz", "export_gltf", "export_obj", "export_vrml"]


@pytest.mark.parametrize("light", ["points", "fragments"])
def test_exported_scenes_are_refused_while_there_is_live_light(light, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(40, 40))
    plotter.vizlight.add_mesh(pv.Sphere(), scene=SCENE, light=light)
    for name in EXPORTS:
        with pytest.raises(ValueError, match=f"{name}: expected .* plotter.add_mesh"):
            getattr(plotter, name)(tmp_path / "scene")
    plotter.clear_actors()
    plotter.add_mesh(pv.Sphere())
    plotter.export_obj(tmp_path / "ball.obj")
    assert (tmp_path / "ball.obj").stat().st_size > 1000


@pytest.mark.skipif("trame_pyvista" in MISSING, reason="needs trame_pyvista")
def test_gallery_of_pyvista_keeps_the_picture_of_live_light(monkeypatch):
    plotter = live_plotter()
    with pytest.raises(ValueError, match="export_vtksz"):
        plotter.trame.export_vtksz(filename=None)
    monkeypatch.setattr(pv, "BUILDING_GALLERY", True)
    plotter.show(auto_close=False)
    assert plotter.last_vtksz is None
    assert plotter.last_image.max() > 50
