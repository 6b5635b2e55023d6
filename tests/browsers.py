"""Chromium, drawn by software, for tests of pages; and what a page asks for and complains of."""

import importlib.util
import io
import shutil

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY
from PIL import Image

import vizlight
from vizlight import Light, Scene

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
SOFTWARE += ["--enable-unsafe-swiftshader"]
#: A window with its panel beside the picture.
WIDE = {"viewport": {"width": 1200, "height": 1000}}


def missing(*packages, **programs):
    """Return what is not there of packages, of programs with their paths, and of Chromium."""
    found = [name for name in packages if importlib.util.find_spec(name) is None]
    return found + [name for name, path in ({"chromium": CHROMIUM} | programs).items() if not path]


def needed(*packages, **programs):
    lacking = missing("playwright", *packages, **programs)
    return pytest.mark.skipif(bool(lacking), reason=f"needs {', '.join(lacking)}")


def opened(browser, path, **options):
    """Return a page that is ready, and what it has asked for and complained of."""
    page = browser.new_page(**options)
    seen = []
    page.on("request", lambda request: seen.append(request.url))
    page.on("console", lambda message: seen.append(message.text))
    page.on("pageerror", lambda error: seen.append(str(error)))
    page.on("dialog", lambda dialog: seen.append(dialog.message))
    page.goto(path.as_uri())
    page.wait_for_selector("body[data-ready]")
    return page, seen


def shot(page):
    """Return the picture of a page."""
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => done()))")
    page.evaluate("() => { vizlight.moving = false; vizlight.draw(); }")
    return np.array(Image.open(io.BytesIO(page.screenshot())).convert("RGB"), dtype=np.int16)


def turn(page, degrees):
    """Turn the mesh of a page about its axis."""
    page.evaluate(f"() => vizlight.orbit({-np.radians(degrees)}, 0)")


def plain_page(tmp_path, **options):
    """Write the page of a ball, black behind."""
    ball = pv.Sphere(theta_resolution=60, phi_resolution=60)
    scene = Scene(lights=Light(direction=(1, 0.2, 0.3)), material=SHINY)
    return vizlight.live_html(
        ball, tmp_path / "ball.html", scene=scene, background="black", **options
    )
