"""Pages in Firefox, steered by WebDriver BiDi with the few methods of Playwright that tests use."""

from __future__ import annotations

import base64
import importlib.util
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

FIREFOX = shutil.which("firefox-esr") or shutil.which("firefox")
#: A window that no one sees: without any Firefox has no WebGL.
XVFB = shutil.which("xvfb-run")
MISSING = [name for name, path in (("firefox", FIREFOX), ("xvfb", XVFB)) if path is None]
MISSING += [name for name in ("websocket",) if importlib.util.find_spec(name) is None]


class Firefox:
    """A browser whose pages are tabs."""

    def __init__(self) -> None:
        import websocket

        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        folder = Path(self._profile.name)
        (folder / "user.js").write_text('user_pref("webgl.force-enabled", true);\n')
        command = [XVFB, "-a", FIREFOX, "--no-remote", "--profile", folder]
        said, address = folder / "said.txt", None
        with said.open("w") as file:
            self._process = subprocess.Popen(
                [*command, "--remote-debugging-port", "0"], stdout=file, stderr=file,
                env=os.environ | {"LIBGL_ALWAYS_SOFTWARE": "1"},
            )  # fmt: skip
        while address is None:
            assert self._process.poll() is None, said.read_text()
            time.sleep(0.05)
            address = re.search(r"WebDriver BiDi listening on (ws://\S+)", said.read_text())
        self._socket = websocket.create_connection(
            f"{address[1]}/session", timeout=120, suppress_origin=True
        )
        self._count = 0
        self.send("session.new", capabilities={})

    def send(self, method: str, **params: object) -> dict:
        """Return the answer to a command."""
        self._count += 1
        request = {"id": self._count, "method": method, "params": params}
        self._socket.send(json.dumps(request))
        while (answer := json.loads(self._socket.recv())).get("id") != self._count:
            pass
        assert "result" in answer, answer
        return answer["result"]

    def new_page(self, viewport: dict[str, int]) -> Page:
        """Return a tab of a size."""
        tab = self.send("browsingContext.create", type="tab")["context"]
        self.send("browsingContext.setViewport", context=tab, viewport=viewport)
        return Page(self, tab)

    def close(self) -> None:
        """End the browser."""
        self.send("browser.close")
        self._socket.close()
        self._process.wait(timeout=30)
        self._profile.cleanup()


class Page:
    """A tab."""

    def __init__(self, browser: Firefox, tab: str) -> None:
        self.browser, self.tab = browser, tab

    def goto(self, address: str) -> None:
        """Load an address."""
        given = {"context": self.tab, "url": address, "wait": "complete"}
        self.browser.send("browsingContext.navigate", **given)

    def evaluate(self, text: str, argument: object = None) -> object:
        """Return the value of an expression, or of a function of the argument."""
        value = f"(async () => {{ const made = ({text}); const given = {json.dumps(argument)};"
        value += (
            " return JSON.stringify(await (made instanceof Function ? made(given) : made)); })()"
        )
        answer = self.browser.send(
            "script.evaluate", expression=value, target={"context": self.tab}, awaitPromise=True
        )
        assert answer["type"] == "success", answer
        found = answer["result"].get("value")
        return None if found is None else json.loads(found)

    def wait_for_selector(self, selector: str) -> None:
        """Wait until there is an element."""
        self.evaluate(
            """async (selector) => {
            while (!document.querySelector(selector)) await new Promise((go) => setTimeout(go, 20));
            }""",
            selector,
        )

    def on(self, event: str, function: object) -> None:
        """Listen to nothing: a page that fails is seen by what it shows."""

    def screenshot(self) -> bytes:
        """Return what the canvas of a page holds: pictures of a tab are of earlier frames."""
        text = str(self.evaluate("document.querySelector('canvas').toDataURL()"))
        return base64.b64decode(text.partition(",")[2])

    def close(self) -> None:
        """Close the tab."""
        self.browser.send("browsingContext.close", context=self.tab)
