"""Chromium, drawn by software, for tests of pages; and what a page asks for and complains of."""

import importlib.util
import shutil

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
SOFTWARE += ["--enable-unsafe-swiftshader"]


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
