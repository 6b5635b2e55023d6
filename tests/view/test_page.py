"""The page in Chromium, and the doors that stay shut."""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import io
import os
import shutil
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from vizlight import cli
from vizlight.data import example_path

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
NEEDED = ("trame", "trame_vtk", "trame_vuetify", "aiohttp")
MISSING = [name for name in NEEDED if importlib.util.find_spec(name) is None]
pytestmark = [
    pytest.mark.opengl,
    pytest.mark.skipif(bool(MISSING), reason=f"needs {', '.join(MISSING)}"),
    pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is sent by a signal"),
]
in_browser = pytest.mark.skipif(
    CHROMIUM is None or importlib.util.find_spec("playwright") is None,
    reason="needs playwright and chromium",
)
LIMIT = 30_000


def command(*arguments):
    """Start a command as a terminal does, in a group of its own that Ctrl-C reaches."""
    return subprocess.Popen(
        [sys.executable, "-m", "vizlight", "view", *arguments, "--no-browser"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


def interrupted(process):
    """Press Ctrl-C, and return the exit code and what was said."""
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=30)
    return process.returncode, out + err


def processes(group):
    """Return the processes of a group that are left."""
    left = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            fields = stat.read_text().rpartition(")")[2].split()
            if int(fields[2]) == group and fields[0] != "Z":
                left.append(stat)
    return left


@pytest.fixture(scope="module")
def address():
    process = command(str(example_path()))
    words = process.stdout.readline().split()
    assert words[:1] == ["page"], process.stderr.read()
    yield words[1]
    port = int(words[1].split(":")[2].split("/")[0])
    assert interrupted(process) == (0, "")
    assert processes(process.pid) == []
    with socket.socket() as again:
        # As servers do: connections that browsers closed may linger.
        again.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        again.bind(("127.0.0.1", port))


def status(url, **headers):
    """Return the status of an answer, and its text."""
    request = urllib.request.Request(
        url, headers={k.replace("_", "-"): v for k, v in headers.items()}
    )
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.status, answer.read().decode(errors="replace")
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode(errors="replace")


def test_only_its_own_files_are_served(address):
    root, token = address[: address.index("/", 8)], address.rstrip("/").rpartition("/")[2]
    code, text = status(address)
    assert code == 200
    assert "<html" in text
    outside = ["", "/", "/index.html", "/ws", "/etc/passwd", f"/{token[:-1]}/", f"/{'0' * 32}/ws"]
    outside += [f"/{token}/{path}" for path in (
        "..%2f..%2f..%2f..%2fetc/passwd", "%2e%2e/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
        "assets/../../vue3.py", "rotating_disk.vtu", "assets/", "__trame_vuetify/",
    )]  # fmt: skip
    for path in outside:
        code, text = status(root + path)
        assert code in (403, 404), path
        assert "root:" not in text
    raw = f"GET /{token}/../../../../etc/passwd HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode()
    with socket.create_connection(("127.0.0.1", int(root.rpartition(":")[2]))) as plain:
        plain.sendall(raw)
        assert b" 404 " in plain.recv(4096).partition(b"\r\n")[0]


def test_other_sites_and_names_are_refused(address):
    port = address.split(":")[2].split("/")[0]
    assert status(address, Host="evil.example")[0] == 403
    assert status(address, Host=f"evil.example:{port}")[0] == 403
    assert status(address, Origin="http://evil.example")[0] == 403
    assert status(address, Origin="null")[0] == 403
    assert status(address, Origin=f"http://127.0.0.1:{int(port) - 1}")[0] == 403
    assert status(address, Origin=f"http://127.0.0.1:{port}")[0] == 200
    assert status(address, Host=f"localhost:{port}")[0] == 200


def test_socket_wants_the_token_and_its_own_page(address):
    import aiohttp

    root = address[: address.index("/", 8)]

    async def connect(url, **headers):
        async with aiohttp.ClientSession() as session:
            try:
                async with session.ws_connect(url, headers=headers):
                    return 101
            except aiohttp.WSServerHandshakeError as error:
                return error.status

    async def every():
        return [
            await connect(f"{address}ws"),
            await connect(f"{address}ws", Origin=root),
            await connect(f"{address}ws", Origin="http://evil.example"),
            await connect(f"{address}ws", Host="evil.example"),
            await connect(f"{root}/ws"),
            await connect(f"{root}/{'0' * 32}/ws"),
        ]

    assert asyncio.run(every()) == [101, 101, 403, 403, 404, 404]


def test_only_this_machine_reaches_the_page(address):
    port = int(address.split(":")[2].split("/")[0])
    listening = [
        line.split()[1]
        for table in ("tcp", "tcp6")
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]
        if line.split()[3] == "0A" and line.split()[1].endswith(f":{port:04X}")
    ]
    assert listening == [f"0100007F:{port:04X}"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["missing.vtk"], "file: expected a file, got 'missing.vtk' (no such file)"),
        (["--port", "70000"], "--port: expected a number from 0 to 65535"),
        (["--port", "{taken}"], "--port: expected a port that can be listened on, got {taken}"),
    ],
)
def test_bad_input_is_one_line(arguments, words):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        given = [word.format(taken=port) for word in arguments]
        own = given if "missing.vtk" in given else [str(example_path()), *given]
        process = command(*own)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert out == ""
    assert err.startswith(f"vizlight: {words.format(taken=port)}")
    assert err.count("\n") == 1
    assert processes(process.pid) == []


def test_missing_extra_is_one_line_with_the_command(monkeypatch, capfd):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert cli.main(["view", str(example_path())]) == 2
    err = capfd.readouterr().err
    assert err.startswith("vizlight: view: expected the package trame, got none")
    assert err.endswith("pip install 'vizlight[view]'\n")


@pytest.fixture(scope="module")
def browser():
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        # Pictures come from the server: the page needs no WebGL.
        made = play.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-3d-apis"]
        )
        yield made
        made.close()


def opened(browser, address):
    """Open the page and wait for its controls."""
    page = browser.new_page(viewport={"width": 760, "height": 900})
    page.set_default_timeout(LIMIT)
    page.goto(address)
    page.wait_for_selector("text=Copy as Python")
    return page


def seen(page):
    """Return the pixels of the picture on the page."""
    box = page.locator("main").bounding_box()
    clip = {"x": box["x"] + 310, "y": 80, "width": 440, "height": 800}
    shot = page.screenshot(clip=clip)
    return np.array(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def settled(page, good):
    """Return the picture once nothing is computed, it is good and it stays."""
    last, still = None, 0
    for _ in range(LIMIT // 100):
        picture = seen(page)
        same = last is not None and np.abs(picture - last).mean() < 0.2
        still = still + 1 if same and page.locator(".busy").count() == 0 else 0
        if still >= 4 and good(picture):
            return picture
        last = picture
        page.wait_for_timeout(100)
    raise AssertionError("the picture does not settle")


def change(before):
    return lambda picture: np.abs(picture - before).mean() > 1


def like(expected):
    return lambda picture: np.abs(picture - expected).mean() < 1


def drag(page, name, by):
    box = page.locator(f".slider-{name} .v-slider-thumb").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for i in range(1, 6):
        page.mouse.move(x + by * i / 5, y)
        page.wait_for_timeout(30)
    page.mouse.up()


def choose(page, now, item):
    page.locator(".v-select:visible").filter(has_text=now).first.click()
    page.locator(".v-overlay .v-list-item").filter(has_text=item).first.click()


@in_browser
def test_tuning_by_eye(browser, address, tmp_path):
    page = opened(browser, address)
    first = settled(page, lambda picture: picture.std() > 10)
    # Light: at once, and no longer from over the shoulder.
    drag(page, "azimuth", 40)
    moved = settled(page, change(first))
    assert not page.get_by_label("follows the eye").is_checked()
    page.get_by_label("Undo").click()
    settled(page, like(first))
    page.get_by_label("Redo").click()
    settled(page, like(moved))
    # Another array: a new surface, lit by the flow and coloured.
    choose(page, "as a surface", "by V")
    flow = settled(page, change(moved))
    choose(page, "light alone", "Pres")
    settled(page, lambda picture: np.ptp(picture, axis=-1).max() > 60)
    page.locator(".number-level input").fill("500")
    page.locator(".number-level input").press("Enter")
    picture = settled(page, change(flow))
    # What does not fit is said, and the picture stays.
    page.locator(".number-level input").fill("1e9")
    page.locator(".number-level input").press("Enter")
    page.wait_for_selector(".notice >> text=level: expected a value between")
    controls, notice = (page.locator(x).bounding_box() for x in ("nav", ".notice"))
    assert notice["x"] >= controls["x"] + controls["width"]
    page.locator(".notice button").click()
    page.mouse.move(600, 500)
    page.mouse.down()
    page.mouse.move(650, 520, steps=4)
    page.mouse.up()
    picture = settled(page, change(picture))
    # The script makes this picture.
    page.get_by_text("Copy as Python").click()
    script = page.locator(".script").inner_text()
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True)
    made = np.array(Image.open(tmp_path / "rotating_disk.png").convert("RGB")).astype(int)
    page.get_by_role("button", name="Close").click()
    main = page.locator("main").bounding_box()
    box = page.locator("main canvas, main img").first.bounding_box() or main
    assert made.shape[:2] == (round(box["height"]), round(box["width"]))
    left, top = round(main["x"] + 310 - box["x"]), round(80 - box["y"])
    cut = made[top : top + 800, left : left + 440]
    picture = settled(page, lambda picture: True)
    off = np.abs(cut - picture).max(axis=-1)
    # The page's picture is a JPEG without smooth edges.
    assert np.percentile(off, 97) <= 8
    assert off.mean() < 3
    with page.expect_download(timeout=LIMIT) as saved:
        page.get_by_text("Save picture").click()
    kept = np.array(Image.open(saved.value.path()).convert("RGB")).astype(int)
    assert np.abs(kept - made).max() <= 1
    page.close()


@in_browser
def test_two_pages_show_the_same_and_one_that_leaves_loses_nothing(browser, address):
    one, other = opened(browser, address), opened(browser, address)
    other.get_by_label("Defaults").click()
    before = settled(other, lambda picture: picture.std() > 10)
    drag(other, "ambient", 20)
    after = settled(other, change(before))
    settled(one, like(after))
    value = one.locator(".slider-ambient").inner_text()
    assert value == other.locator(".slider-ambient").inner_text()
    other.close()
    one.close()
    again = opened(browser, address)
    assert again.locator(".slider-ambient").inner_text() == value
    settled(again, like(after))
    again.close()
