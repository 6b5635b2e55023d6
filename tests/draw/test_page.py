"""No name or text of a page is read as HTML, script or command, and what is copied draws it."""

import ast
import base64
import io
import json
import shutil
import subprocess
from pathlib import Path

import browsers
import numpy as np
import pytest
import pyvista as pv
from lamps import NEAR
from PIL import Image
from shapes import torus

import vizlight
from vizlight import Light, Material, Scene, View, cli

BASH = shutil.which("bash")
pytestmark = [pytest.mark.opengl, browsers.needed(bash=BASH)]
PANEL = {"bare": False, "viewport": {"width": 900, "height": 600}}

#: Texts that would run as HTML, as script, as Python or in a shell where one is not escaped.
PAYLOADS = (
    "</script><script>window.hit=1</script>",
    "<img src=x onerror=window.hit=1>",
    "\"><svg onload=window.hit=1>",
    "'><iframe srcdoc='<script>top.hit=1</script>'>",
    "javascript:window.hit=1",
    "<!--<script>window.hit=1//-->",
    "]]><script>window.hit=1</script>",
    "</title><script>window.hit=1</script>",
    "</style><script>window.hit=1</script>",
    "&lt;script&gt;window.hit=1&lt;/script&gt;",
    "${window.hit=1}",
    "`${window.hit=1}`",
    "{{constructor.constructor('window.hit=1')()}}",
    "'; touch hit; '",
    "$(touch hit)`touch hit`",
    "a\nEND\ntouch hit\n",
    "; touch hit #",
    "| touch hit",
    "> hit",
    "*?[a-z]{a,b}~",
    "!! \\\\ $HOME %PATH%",
    '"""); open("hit", "w")  # \\',
    "'''); open('hit', 'w')  # \\'",
    "\\\"); open('hit', 'w')  #",
    "-o hit",
    "--output=hit",
    "__proto__",
    "constructor",
    "$scene $script $& $` $'",
    "\u202e\u2028\u2029<\u00e9\u6f22\U0001f642",
)  # fmt: skip


def hostile(text, path):
    """Write a page with a text in every place that takes one."""
    mesh = pv.Sphere(theta_resolution=6, phi_resolution=6)
    mesh[text] = np.asarray(mesh.points)[:, 2]
    mesh[f"field {text}"] = np.tile((1.0, 0.2, 0.1), (mesh.n_points, 1))
    blocks = pv.MultiBlock({text: mesh, f"2 {text}": mesh.translate((1, 0, 0))})
    words = ["--tangents", f"field {text}", "--threshold", f"{text}:0:1"]
    return vizlight.live_html(
        {0.0: blocks, 1.0: blocks}, path, scene=Scene(lights=Light(direction=(1, 0, 1))),
        title=text, tangents=f"field {text}", scalars=text, frames=text, source=[text, *words],
    ), words  # fmt: skip


@pytest.mark.sampled(6)
@pytest.mark.parametrize("number", range(len(PAYLOADS)))
def test_no_text_is_read_as_anything_else(number, opened, tmp_path):
    text = PAYLOADS[number]
    path, words = hostile(text, tmp_path / "page.html")
    page, seen = opened(path, **PANEL)
    title = page.evaluate("document.querySelector('h1').textContent")
    assert title == text
    copied = page.evaluate("vizlight.texts()")
    page.evaluate("() => vizlight.look('shape')")
    page.evaluate("(name) => vizlight.change({ color: name, look: '' })", text)
    again = page.evaluate("vizlight.texts()")
    page.get_by_role("button", name="Copy as Python").click()
    page.wait_for_timeout(30)
    strange = "main img, main script, aside img, aside script, iframe, object, h1 *, dialog pre *"
    assert page.evaluate(f"document.querySelectorAll({json.dumps(strange)}).length") == 0
    assert page.evaluate("window.hit") is None
    assert seen == [path.as_uri()]
    for python in (copied["python"], again["python"]):
        strings = {node.value for node in ast.walk(ast.parse(python)) if _is_string(node)}
        assert text in strings
        assert f"field {text}" in strings
    for command in (copied["command"], again["command"]):
        first, file, *rest = words_of(command, tmp_path)
        assert (first, file) == ("light", f"./{text}" if text.startswith("-") else text)
        assert rest[: len(words)] == words
        assert {p.name for p in tmp_path.iterdir()} == {
            "page.html", "page.scene.json", "page.view.json",
        }  # fmt: skip
    assert rest[rest.index("--scalars") + 1] == text


def words_of(command, folder):
    """Return the words that the shell gives to ``vizlight`` in a command."""
    run = subprocess.run(
        [BASH, "-c", f"vizlight() {{ printf '%s\\0' \"$@\"; }}\n{command}"],
        cwd=folder, capture_output=True, check=True,
    )  # fmt: skip
    return run.stdout.decode().split("\0")[:-1]


def _is_string(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


#: What is done to a page before its program and its command are copied.
ACTS = {
    "first": "app.draw()",
    "lamp": "app.put(app.lamps[0], [0.6, 0, 0.8]); app.change({ fade: 0.5 })",
    "question": "app.look('shape')",
    "near side": "app.change({ cut: { axis: 2, at: 0.4, far: false } })",
    "far side": "app.change({ cut: { axis: 0, at: 0.4, far: true } })",
    "parallel": "app.state.camera.parallel = true; app.orbit(0.3, 0.2); app.change({})",
    "colours": "app.change({ color: 'height', cmap: 'plasma' })",
}


@pytest.mark.parametrize("act", ACTS)
def test_what_is_copied_draws_the_picture(act, opened, tmp_path, monkeypatch):
    """The command, in the words of a shell, and the program draw what the page shows."""
    monkeypatch.setattr(pv, "OFF_SCREEN", True)
    monkeypatch.chdir(tmp_path)
    mesh = torus()
    del mesh.point_data["n"]
    mesh.save("ring.vtp")
    scene = Scene(
        lights=[Light(direction=(1, 0.9, 0.5), intensity=0.8), NEAR],
        view=View(direction=(1, 0.6, 0.8)),
        material=Material(ambient=0.2, diffuse=0.6, specular=0.2),
    )
    path = vizlight.live_html(
        pv.read("ring.vtp"),
        tmp_path / "a.html",
        scene=scene,
        background="black",
        source=["ring.vtp"],
    )
    page, _ = opened(path, **PANEL)
    page.evaluate(f"() => {{ const app = vizlight; {ACTS[act]}; app.moving = false; app.draw(); }}")
    data = page.evaluate("vizlight.canvas.toDataURL().split(',')[1]")
    texts = page.evaluate("vizlight.texts()")
    seen = np.array(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))
    words = words_of(texts["command"], tmp_path)
    program = texts["python"].replace("clim=", "show_scalar_bar=False, clim=")
    for draw in (
        lambda: cli.main(words),
        lambda: exec(compile(program, "copied", "exec"), {}),
    ):
        draw()
        drawn = np.array(Image.open("a.png").convert("RGB"), dtype=np.int16)
        Path("a.png").unlink()
        error = np.abs(seen - drawn)
        assert drawn.std() > 10
        assert error.mean() <= 1.5
        assert np.quantile(error.max(axis=-1), 0.97) <= 6
