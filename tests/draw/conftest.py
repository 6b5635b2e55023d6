"""A browser for the tests of pages, and pages that are closed in the end."""

import browsers
import pytest

import vizlight


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


#: Leaves the picture alone in the window.
BARE = "body { grid-template: minmax(0, 1fr) 0 / minmax(0, 1fr) 0 !important }"
BARE += " main { --foot: 0px !important }"
BARE += " #panel, h1, #legend, #triad, #frames, #notice { display: none !important }"


@pytest.fixture
def opened(request):
    """Return what opens a page, by default without its panel, and closes it in the end.

    It returns the page, and what that has asked for and complained of.
    """
    browser, pages = request.getfixturevalue(getattr(request, "param", "browser")), []

    def call(path, *, bare=True, **options):
        options = {"viewport": {"width": 300, "height": 250}} | options
        page, seen = browsers.opened(browser, path, **options)
        pages.append(page)
        if bare:
            page.evaluate(
                """(text) => {
                const sheet = new CSSStyleSheet();
                sheet.replaceSync(text);
                document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
                }""",
                BARE,
            )
        return page, seen

    yield call
    for page in pages:
        page.close()


@pytest.fixture
def shown(opened, tmp_path):
    """Return what writes a page, black behind, and opens it: alone or beside its panel."""

    def call(mesh, scene, *, wide=False, **options):
        options = {"background": "black"} | options
        path = vizlight.live_html(mesh, tmp_path / "a.html", scene=scene, **options)
        page, _ = opened(path, bare=False, **browsers.WIDE) if wide else opened(path)
        return page

    return call
