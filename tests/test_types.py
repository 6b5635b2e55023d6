"""What an editor that knows types says of scripts: nothing of README's, a line for each mistake.

``VIZLIGHT_PYRIGHT`` names the folder of pyright's commands, such as ``node_modules/.bin``, if any.
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import vizlight

ROOT = Path(__file__).parents[1]
#: A mistake per line; the last two are of methods of meshes and plotters, whose type is named.
MISTAKES = """
vizlight.no_such_name
vizlight.illuminate(mesh, scene, tangentz="V")
vizlight.illuminate(mesh, scene, model="flat")
Light(dirction=(0, 0, 1))
Material(ambient="bright")
View(position="there")
presets.directions()
render.make_plotter(mesh, sizes=(1, 2))
vizlight.streamlines(mesh, scene, vector="V")
Scene(light=1)
tools.illuminate(scene, tangentz="V")
component.add_keys()
"""
BEFORE = """
import pyvista as pv
import vizlight
from vizlight import Light, Material, Scene, View, presets, render
from vizlight.accessor import Accessor
from vizlight.draw.component import Component
mesh = pv.Sphere()
scene = Scene(lights=Light(direction=(0, 0, 1)))
tools: Accessor = mesh.vizlight
component: Component = pv.Plotter().vizlight
"""


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_mistakes_are_found_and_the_examples_of_the_readme_have_none(tmp_path):
    readme = (ROOT / "README.md").read_text("utf-8")
    (tmp_path / "mistakes.py").write_text(BEFORE.strip() + MISTAKES, "utf-8")
    for i, text in enumerate(re.findall(r"```python\n(.*?)```", readme, re.DOTALL)):
        (tmp_path / f"readme_{i}.py").write_text(text, "utf-8")
    command = [sys.executable, "-m", "mypy", "--config-file=", "--follow-imports=silent"]
    command += ["--ignore-missing-imports", f"--cache-dir={tmp_path}", *tmp_path.glob("*.py")]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    found = re.findall(r"(\w+)\.py:(\d+): error", run.stdout)
    first = len(BEFORE.strip().splitlines()) + 1
    lines = range(first, first + len(MISTAKES.strip().splitlines()))
    assert found == [("mistakes", str(line)) for line in lines], run.stdout


needs_pyright = pytest.mark.skipif(
    "VIZLIGHT_PYRIGHT" not in os.environ, reason="no folder of pyright named"
)


def pyright(name):
    return Path(os.environ["VIZLIGHT_PYRIGHT"]).resolve() / name


@pytest.mark.slow
@needs_pyright
def test_pyright_finds_the_mistakes_and_none_in_what_users_read(tmp_path):
    (tmp_path / "mistakes.py").write_text(BEFORE.strip() + MISTAKES, "utf-8")
    for path in (ROOT / "gallery" / "pages" / "guide").glob("*.rst"):
        found = re.findall(r"code-block:: python\n\n((?:   .*\n|\n)+)", path.read_text("utf-8"))
        code = "\n".join(map(textwrap.dedent, found))
        (tmp_path / f"guide_{path.stem}.py").write_text(code, "utf-8")
    for path in sorted((ROOT / "gallery").glob("plot_*.py"))[:10]:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    command = [pyright("pyright"), "--outputjson", "--pythonpath", sys.executable, tmp_path]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    told = json.loads(run.stdout)["generalDiagnostics"]
    of_mistakes = {
        one["range"]["start"]["line"] for one in told if one["file"].endswith("mistakes.py")
    }
    first = len(BEFORE.strip().splitlines())
    assert of_mistakes == {*range(first, first + len(MISTAKES.strip().splitlines()))}
    # PyVista's own types do not fit its scripts; names and keywords of vizlight do.
    ours = [
        f"{one['file']}: {one['message']}"
        for one in told
        if not one["file"].endswith("mistakes.py")
        and ("No parameter named" in one["message"] or "vizlight" in one["message"])
    ]
    assert ours == []


class Server:
    """A language server, as an editor asks it."""

    def __init__(self, folder):
        self.process = subprocess.Popen(
            [pyright("pyright-langserver"), "--stdio"], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )  # fmt: skip
        self.number, self.uri = 0, (folder / "script.py").as_uri()
        uri, settings = folder.as_uri(), {"configuration": True}
        folders = [{"uri": uri, "name": "scripts"}]
        self.ask(
            "initialize", processId=None, rootUri=uri, workspaceFolders=folders,
            capabilities={"workspace": settings},
        )  # fmt: skip
        self.send({"method": "initialized", "params": {}})

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def receive(self):
        size = 0
        while line := self.process.stdout.readline().strip():
            name, _, value = line.partition(b":")
            size = int(value) if name.lower() == b"content-length" else size
        return json.loads(self.process.stdout.read(size))

    def ask(self, method, **parameters):
        self.number += 1
        self.send({"id": self.number, "method": method, "params": parameters})
        while True:
            message = self.receive()
            if "method" in message and "id" in message:
                items = message.get("params", {}).get("items", [])
                own = [
                    {"pythonPath": sys.executable} if one.get("section") == "python" else {}
                    for one in items
                ]
                self.send({"id": message["id"], "result": own or None})
            elif message.get("id") == self.number:
                return message["result"]

    def at_the_end_of(self, text, method):
        """Return an answer for the last character of a script."""
        document = {"uri": self.uri, "languageId": "python", "version": self.number, "text": text}
        self.send({"method": "textDocument/didOpen", "params": {"textDocument": document}})
        lines = text.splitlines()
        place = {"line": len(lines) - 1, "character": len(lines[-1])}
        found = self.ask(method, textDocument={"uri": self.uri}, position=place)
        self.send(
            {"method": "textDocument/didClose", "params": {"textDocument": {"uri": self.uri}}}
        )
        return found


@pytest.mark.slow
@needs_pyright
def test_an_editor_completes_public_names_and_shows_their_documentation(tmp_path):
    server = Server(tmp_path)
    try:
        names = {}
        for owner in ("vizlight", "tools", "component"):
            text = f"{BEFORE.strip()}\n{owner}."
            items = server.at_the_end_of(text, "textDocument/completion")["items"]
            names[owner] = {one["label"] for one in items if not one["label"].startswith("_")}
        shown = server.at_the_end_of(f"{BEFORE.strip()}\ntools.illuminate", "textDocument/hover")
    finally:
        server.process.kill()
        server.process.communicate()
    assert names["vizlight"] <= {*vizlight.__all__, *dir(vizlight), "unlit_colors"}
    assert names["vizlight"] >= {*vizlight.__all__}
    assert {"illuminate", "plot", "sky", "streamlines"} <= names["tools"]
    assert {"add_mesh", "add_key"} <= names["component"]
    told = shown["contents"]["value"]
    assert 'name: str = "luminance"' in told.replace("'", '"')
    assert "Side of the surface that is lit" in told
