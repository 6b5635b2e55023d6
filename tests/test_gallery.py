"""The built pages: no dead link, no missing picture, no error in a browser, no blank scene.

The tests read the pages from the folder into which README's command builds them. Tests that need a
browser use Debian's ``chromium``. If ``VIZLIGHT_PAGES`` names the folder of the pages, a missing
page or browser is an error; otherwise the tests are skipped. Of the notebooks one is run, or all
if ``VIZLIGHT_NOTEBOOKS`` is "all", and of the scenes a third is drawn. ``VIZLIGHT_AXE`` names the
axe.min.js of axe-core, if any.
"""

from __future__ import annotations

import base64
import functools
import http.server
import io
import json
import os
import random
import re
import threading
import zlib
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import browsers
import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).parents[1]
PAGES = Path(os.environ.get("VIZLIGHT_PAGES", ROOT / "build" / "gallery"))
WANTED = "VIZLIGHT_PAGES" in os.environ

pytestmark = pytest.mark.skipif(
    not (PAGES / "index.html").exists() and not WANTED, reason=f"no pages in {PAGES}"
)
browser = pytest.mark.skipif(browsers.CHROMIUM is None and not WANTED, reason="no chromium here")


class _Links(HTMLParser):
    """Links of a page, and its anchors."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        for key in ("href", "src"):
            if given.get(key):
                self.targets.append(given[key])
        self.targets += [part.split()[0] for part in (given.get("srcset") or "").split(",") if part]


@functools.cache
def read(page):
    parser = _Links()
    parser.feed(page.read_text(encoding="utf-8"))
    return parser


def pages():
    return sorted(p for p in PAGES.rglob("*.html") if "_static" not in p.parts)


def broken_links(page):
    def works(target):
        parts = urlsplit(target)
        if parts.scheme or target.startswith("//"):
            return True
        place = (page.parent / unquote(parts.path)).resolve() if parts.path else page
        anchored = parts.fragment and place.suffix == ".html"
        return place.exists() and (not anchored or unquote(parts.fragment) in read(place).anchors)

    return [target for target in read(page).targets if not works(target)]


def test_every_link_and_picture_is_there():
    assert len(pages()) > 100
    broken = {page.name: found for page in pages() if (found := broken_links(page))}
    assert not broken


def test_a_broken_link_is_found(tmp_path):
    page = tmp_path / "a.html"
    page.write_text('<p id="x"><a href="#x">a</a><a href="#y">b</a><img src="no.png"></p>')
    assert broken_links(page) == ["#y", "no.png"]


def test_nothing_is_loaded_from_elsewhere():
    """The pages work from disk, without a network."""
    loaded = re.compile(r'<(?:script|img|iframe|link rel="stylesheet")[^>]*(?:src|href)="https?:')
    assert not [p.name for p in pages() if loaded.search(p.read_text(encoding="utf-8"))]


def test_every_script_has_a_page_a_picture_and_no_error():
    for script in sorted((ROOT / "gallery").glob("plot_*.py")):
        page = PAGES / "examples" / f"{script.stem}.html"
        text = page.read_text(encoding="utf-8")
        assert "Traceback (most recent call last)" not in text, script.stem
        assert re.search(rf"sphx_glr_{script.stem}_001\.(png|gif)", text), script.stem
        (thumbnail,) = (PAGES / "_images").glob(f"sphx_glr_{script.stem}_thumb.*")
        with Image.open(thumbnail) as picture:
            assert np.asarray(picture.convert("L")).std() > 5, script.stem


def test_pages_of_examples_are_light():
    """A page and its pictures; scenes are loaded when their tab is opened."""
    for page in [PAGES / "examples" / "index.html", *(PAGES / "examples").glob("plot_*.html")]:
        text = page.read_text(encoding="utf-8")
        pictures = {page.parent / unquote(u) for u in re.findall(r'<img[^>]* src="([^"]+)"', text)}
        size = len(text) + sum(picture.stat().st_size for picture in pictures)
        assert size < 1.5e6, (page.name, size)


def test_the_gallery_has_sections_of_described_pictures():
    text = (PAGES / "examples" / "index.html").read_text(encoding="utf-8")
    sections = re.split(r"<h2>", text)[1:]
    assert [section.partition("<")[0][-1] for section in sections] == ["?"] * len(sections)
    shown = [re.findall(r"sphx_glr_(plot_\w+)_thumb", section) for section in sections]
    scripts = sorted(script.stem for script in (ROOT / "gallery").glob("plot_*.py"))
    assert sorted(name for names in shown for name in names) == scripts
    assert all(shown)
    pictures = re.findall(r"<img[^>]*>", text)
    assert all(len(re.search(r'alt="([^"]*)"', picture)[1]) > 20 for picture in pictures)
    assert all('loading="lazy"' in picture for picture in pictures[1:])


def sample(paths, count):
    """Return some files; which depends on what all of them hold, and on nothing else."""
    paths = sorted(paths, key=lambda path: path.name)
    content = b"".join(path.read_bytes() for path in paths)
    return random.Random(zlib.crc32(content)).sample(paths, min(count, len(paths)))


def notebooks():
    every = [*(PAGES / "_downloads").rglob("plot_*.ipynb")]
    return sample(every, len(every) if os.environ.get("VIZLIGHT_NOTEBOOKS") == "all" else 1)


@pytest.mark.parametrize("path", notebooks(), ids=lambda path: path.stem)
def test_a_notebook_runs_in_an_empty_folder_and_shows_its_pictures(path, tmp_path):
    if not WANTED:
        pytest.importorskip("nbclient")
        pytest.importorskip("ipykernel")
    import nbclient
    import nbformat

    made = nbformat.read(path, as_version=4)
    where = {"metadata": {"path": tmp_path}}
    nbclient.NotebookClient(made, timeout=600, kernel_name="python3", resources=where).execute()
    for cell in made.cells:
        if cell.cell_type == "code":
            drawn = [o.data["image/png"] for o in cell.outputs if "image/png" in o.get("data", {})]
            assert len(drawn) >= len(re.findall(r"\.show\(", cell.source)), cell.source
            for picture in drawn:
                with Image.open(io.BytesIO(base64.b64decode(picture))) as opened:
                    assert np.asarray(opened.convert("L")).std() > 5
    assert not list(tmp_path.iterdir())


def test_notebooks_are_written_in_markdown():
    found = list((PAGES / "_downloads").rglob("plot_*.ipynb"))
    assert len(found) == len(list((ROOT / "gallery").glob("plot_*.py")))
    for path in found:
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            text = "".join(cell["source"])
            assert cell["cell_type"] == "code" or not re.search(r":\w+:`|^\.\. ", text, re.M), text


def test_every_public_name_has_a_page():
    import vizlight

    for name in vizlight.__all__:
        assert (PAGES / "api" / f"vizlight.{name}.html").exists(), name


#: Messages of the viewer that are not errors.
HARMLESS = re.compile(r"hashes,scene|GPU stall|GL Driver Message")


@pytest.fixture(scope="module")
def chromium():
    """A browser that pages are steered in."""
    driver = pytest.importorskip("playwright.sync_api", reason="pip install 'vizlight[docs]'")
    with driver.sync_playwright() as play:
        yield play.chromium.launch(executable_path=browsers.CHROMIUM, args=browsers.SOFTWARE)


class Handler(http.server.SimpleHTTPRequestHandler):
    """Serves the pages, and says nothing."""

    def __init__(self, *given):
        super().__init__(*given, directory=str(PAGES))

    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def site():
    """The address of the pages as readers meet them online."""
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def visit(context, name, site=None):
    """Open a page from disk or of a site; return it, the files it reads, and the errors it says."""
    page, read_files, said = context.new_page(), set(), []
    page.on("request", lambda request: read_files.add(request.url))
    page.on("console", lambda told: HARMLESS.search(told.text) or said.append(told.text))
    page.on("pageerror", lambda error: said.append(error.message))
    page.goto(f"{site}/{name}" if site else (PAGES / f"{name}.html").as_uri())
    return page, read_files, said


FIRST = (
    "index", "guide/index", "guide/direction", "examples/index", "formulas", "architecture", "api",
    "studies", "peers", "timed",
)  # fmt: skip
LONGEST = "api/vizlight.geometry.contours.isoluminance"


@browser
def test_pages_fit_and_load_nothing_from_elsewhere(chromium):
    """In a wide window by day and by night, and on a telephone."""
    with chromium.new_context() as context:
        for name in [*FIRST, LONGEST]:
            page, read_files, said = visit(context, name)
            for width, scheme in ((1280, "light"), (1280, "dark"), (400, "light")):
                page.set_viewport_size({"width": width, "height": 900})
                page.emulate_media(color_scheme=scheme)
                theme = "scheme => document.documentElement.dataset.theme === scheme"
                page.wait_for_function(theme, arg=scheme)
                # One row of the header; titles end within the page.
                assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), name
                assert page.evaluate("document.querySelector('.bd-header').offsetHeight") < 90, name
                titles = "[...document.querySelectorAll('h1')]"
                fit = f"{titles}.every(title => title.scrollWidth <= title.clientWidth)"
                assert page.evaluate(fit), name
                # Pictures have their own light in dark pages too.
                filters = "[...document.images].map(image => getComputedStyle(image).filter)"
                assert set(page.evaluate(filters)) <= {"none"}, name
            assert not said, name
            outside = [u for u in read_files if urlsplit(u).scheme not in ("file", "data", "blob")]
            assert not outside, name
            page.close()


@browser
@pytest.mark.skipif("VIZLIGHT_AXE" not in os.environ, reason="no axe.min.js of axe-core named")
def test_axe_finds_nothing(chromium):
    axe = Path(os.environ["VIZLIGHT_AXE"]).read_text(encoding="utf-8")
    example = sorted(path.stem for path in (PAGES / "examples").glob("plot_read_*.html"))[0]
    with chromium.new_context() as context:
        for name in [*FIRST, LONGEST, f"examples/{example}"]:
            page, _, _ = visit(context, name)
            page.evaluate(axe)
            found = page.evaluate("axe.run().then(made => made.violations.map(one => one.id))")
            assert not found, name
            page.close()


@browser
def test_the_first_page_is_light(chromium):
    with chromium.new_context() as context:
        page, read_files, _ = visit(context, "index")
        page.wait_for_selector(".divided iframe.ready")
        paths = {unquote(urlsplit(url).path) for url in read_files if url.startswith("file:")}
        # The scene comes after the page, in place of a picture.
        assert [Path(path).name for path in paths if "/scenes/" in path] == ["front.html"]
        paths = {path for path in paths if "/scenes/" not in path}
        assert sum(Path(path).stat().st_size for path in paths) < 1e6


@browser
@pytest.mark.parametrize("drawn", [True, False], ids=["WebGL", "no WebGL"])
def test_the_first_page_has_a_scene_in_place_of_a_picture(chromium, drawn):
    """Without WebGL the picture stays."""
    bare = chromium
    if not drawn:
        options = ["--no-sandbox", "--disable-3d-apis"]
        bare = chromium.browser_type.launch(executable_path=browsers.CHROMIUM, args=options)
    with bare.new_context() as context:
        page, _, _ = visit(context, "index")
        scene = page.locator(".divided iframe")
        scene.element_handle().content_frame().wait_for_selector("body[data-ready], [role=alert]")
        ready = "frame => frame.classList.contains('ready')"
        if drawn:
            page.wait_for_function(ready, arg=scene.element_handle())
        assert scene.is_visible() == scene.evaluate(ready) == drawn
        assert page.locator(".divided img").evaluate("picture => picture.naturalWidth") > 1000
    if not drawn:
        bare.close()


@browser
def test_keys_reach_the_content_and_the_search_finds(chromium, site):
    with chromium.new_context() as context:
        page, _, said = visit(context, "index.html", site)
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.textContent.trim()") == "Skip to main content"
        page.keyboard.press("Control+k")
        page.keyboard.type("streamlines")
        page.keyboard.press("Enter")
        page.wait_for_selector("#search-results li a")
        assert "streamlines" in page.inner_text("#search-results").lower()
        assert not said


#: Words of users, and the title of a page that has them.
WORDS = {
    "colorbar": "What value",
    "transparent": "What value",
    "tractography": "tractography",
    "opacity": "What value",
    "jagged": "How wrong",
    "dark": "Troubleshooting",
    "EGL": "Troubleshooting",
    "cell data": "What value",
}


@browser
def test_the_search_finds_the_words_of_users(chromium, site):
    """Served, as newer browsers let no script read the pages on a disk."""
    with chromium.new_context() as context:
        for word, title in WORDS.items():
            page, _, said = visit(context, f"search.html?q={word}", site)
            page.wait_for_selector("#search-results li a")
            found = "title => document.querySelector('#search-results').innerText.includes(title)"
            page.wait_for_function(found, arg=title)
            assert not said, word
            page.close()


def test_every_page_has_a_title_a_description_and_a_picture():
    raw = "https://raw.githubusercontent.com/vizlight/vizlight/main/"
    titles = {}
    for page in pages():
        text = page.read_text(encoding="utf-8")
        title = re.search(r"<title>([^<]+)</title>", text)[1].strip()
        assert titles.setdefault(title, page) is page, title
        if page.name in ("search.html", "genindex.html", "py-modindex.html"):
            continue
        for name in ('name="description"', 'property="og:description"', 'property="og:title"'):
            (content,) = re.findall(rf'<meta {name} content="([^"]+)"', text)
            assert len(content) > 2, page
        (picture,) = re.findall(r'<meta property="og:image" content="([^"]+)"', text)
        assert (ROOT / picture.removeprefix(raw)).is_file()


@browser
def test_views_of_a_scene_turn_together(chromium):
    """Each has its title, and those beside it take on its camera."""
    with chromium.new_context() as context:
        page, _, said = visit(context, "examples/plot_complex_curve")
        scene = page.locator("div.scene").first
        assert scene.locator("iframe[src]").count() == 0  # loaded when their tab is opened
        page.locator("label.sd-tab-label", has_text="Interactive scene").first.click()
        scene.scroll_into_view_if_needed()
        frames = [f.element_handle().content_frame() for f in scene.locator("iframe").all()]
        titles = ["turned by 0°: graph of Re w", *(f"turned by {a}°" for a in (20, 45, 70))]
        titles += ["turned by 90°: the inverse", "phase of w"]
        assert len(frames) == len(titles)
        for frame in frames:
            frame.frame_element().scroll_into_view_if_needed()
            frame.wait_for_function("() => window.vizlight")
        assert [f.inner_text("h1") for f in frames] == titles
        place = "JSON.stringify(window.vizlight.state.camera.position)"
        before = frames[0].evaluate(place)
        frames[1].focus("#canvas")
        page.keyboard.press("ArrowLeft")
        after = frames[1].evaluate(place)
        assert after != before
        for frame in frames:
            frame.wait_for_function(f"() => {place} === {after!r}")
        assert not said


def test_every_picture_has_a_description():
    """A name of a file is none. Thumbnails stand beside their titles and need none."""
    bare = re.compile(r'<img(?![^>]* alt=)[^>]*>|<img[^>]* alt="(?:plot )?\w+(?:\.\w+)?"')
    for page in pages():
        assert not bare.findall(page.read_text(encoding="utf-8")), page.name


def scenes():
    return [*(PAGES / "_static" / "scenes").glob("*.html")]


def test_most_examples_have_scenes():
    names = {re.match(r"sphx_glr_plot_[a-z_0-9]+?(?=_0\d\d_)", scene.stem) for scene in scenes()}
    assert len({name[0] for name in names if name}) >= 15


@browser
@pytest.mark.parametrize("half", [0, 1])
def test_scenes_are_not_blank(chromium, half):
    drawn_scenes = sample(scenes(), len(scenes()) // 3)[half::2]
    assert drawn_scenes
    with chromium.new_context(viewport={"width": 900, "height": 700}) as context:
        for scene in drawn_scenes:
            page, _, said = visit(context, f"_static/scenes/{scene.stem}")
            page.wait_for_selector("body[data-ready]")
            picture = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
            page.close()
            assert not said, scene.name
            drawn = np.any(np.abs(picture.astype(int) - picture[0, 0]) > 24, axis=-1)
            # The scene is drawn, in the middle of the page, and in many tones: it is lit.
            assert drawn.mean() > 0.01, scene.name
            assert drawn[200:500, 250:650].any(), scene.name
            assert len(np.unique(picture[drawn], axis=0)) > 50, scene.name


@browser
def test_the_browser_tests_can_fail(chromium, tmp_path):
    text = "<p>nothing</p><script>console.error('no'); nowhere()</script>"
    (tmp_path / "bad.html").write_text(text)
    with chromium.new_context() as context:
        _, _, said = visit(context, str(tmp_path / "bad"))
        assert len(said) == 2
