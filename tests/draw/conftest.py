"""A browser for the tests of pages."""

import browsers
import pytest


@pytest.fixture(scope="module")
def chromium():
    if lacking := browsers.missing("playwright"):
        pytest.skip(f"needs {', '.join(lacking)}")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        yield play.chromium


@pytest.fixture(scope="module")
def browser(chromium):
    made = chromium.launch(executable_path=browsers.CHROMIUM, args=browsers.SOFTWARE)
    yield made
    made.close()
