"""A page by itself shows the light of the engine as the eye moves, and says what it cannot."""

import base64
import functools
import http.server
import io
import json
import re
import threading
import zlib

import browsers
import firefox
import numpy as np
import pytest
import pyvista as pv
from fields import half_known, several_kinds, swatches
from lamps import HEADLIT, NEAR, SHINY, shiny
from PIL import Image
from shapes import torus, winding

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, presets
from vizlight._questions import QUESTIONS
from vizlight.draw import html
from vizlight.files import FileError
from vizlight.mesh.strokes import moved_widths

pytestmark = pytest.mark.opengl

SIZE = {"width": 300, "height": 250}
FAR = Light(direction=(1, 0.9, 0.5), intensity=0.8)
CUE = DepthCue(back_scale=0.3, cue=0.1, color=(0.3, 0.4, 1.0))


AWAY = (5e6, -5e6, 2e6)
CASES = {
    "lines": (winding, Scene(lights=FAR, material=SHINY), {}),
    "conditioned lines": (
        winding, Scene(lights=FAR, material=SHINY), {"conditioned": True, "normals": "n"}
    ),
    "surface with a field": (
        torus, Scene(lights=FAR, material=SHINY),
        {"tangents": "around", "conditioned": True, "normals": "n"},
    ),
    "compensated with colours": (torus, Scene(lights=FAR, material=SHINY), {"tangents": "around"}),
    "two lights, one near, in fog": (
        torus,
        Scene(lights=[FAR, NEAR], depth_cue=CUE, ambient_color=(0.7, 0.8, 1), material=SHINY),
        {"normals": "n", "model": "blinn"},
    ),
    "faces, lines and vertices": (
        lambda: several_kinds(120)[0], Scene(lights=[FAR, NEAR], material=SHINY), {}
    ),
    "far from the origin": (
        lambda: torus(centre=AWAY),
        Scene(lights=[FAR, Light(position=np.add(AWAY, (3, 4, 5)), intensity=0.2)], material=SHINY),
        {"normals": "n"},
    ),
}  # fmt: skip
COLORED = {"compensated with colours": {"scalars": "height", "cmap": "plasma"}}


@pytest.fixture(scope="module")
def fox():
    made = firefox.Firefox()
    yield made
    made.close()


def first_camera(centre=(0.0, 0.0, 0.0)):
    camera = pv.Camera()
    camera.position, camera.up = np.add(centre, (2.6, 1.6, 2.1)), (0, 0, 1)
    camera.focal_point, camera.view_angle = centre, 40
    return camera


def scene_in(path):
    text = path.read_text("utf-8")
    found = re.search(r'<script type="application/json" id="scene">(.*?)</script>', text, re.S)
    return text, found[1], json.loads(found[1])


def baked(path, colors):
    """Return the page with colours of the points in place of light that follows."""
    text, given, content = scene_in(path)
    data = base64.b64encode(zlib.compress(colors.tobytes())).decode()
    for mesh in content["meshes"]:
        mesh |= {"live": False, "colors": {"data": data, "kind": "u1"}, "color": [1, 1, 1]}
    made = path.with_name("baked.html")
    made.write_text(text.replace(given, json.dumps(content)), "utf-8")
    return made


def recolor(page, colors):
    """Give a baked page other colours."""
    page.evaluate(
        "(text) => vizlight.meshes[0].paint(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)))",
        base64.b64encode(colors.tobytes()).decode(),
    )


def engine_colors(mesh, scene, camera, options, colored):
    """Return the colours of the filters for an eye, in bytes."""
    seen = scene.replace(view=View.from_camera(camera))
    lit = vizlight.illuminate(mesh, seen, **options)
    if colored:
        found = vizlight.tint(lit, colored["scalars"], cmap=colored["cmap"])["rgb"]
        return np.column_stack([found[:, :3], np.full(len(found), 255, np.uint8)])
    rgb = lit["rgb"] if "rgb" in lit.point_data else np.repeat(lit["luminance"][:, None], 3, axis=1)
    return np.insert(np.clip(rgb, 0, 1) * 255 + 0.5, 3, 255, axis=1).astype(np.uint8)


#: Firefox takes minutes.
FOX = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(firefox.MISSING), reason=f"needs {', '.join(firefox.MISSING)}"),
]
IN_FIREFOX = ("conditioned lines", "two lights, one near, in fog")


@pytest.mark.parametrize(
    ("case", "opened"),
    [(case, "browser") for case in CASES]
    + [pytest.param(case, "fox", marks=FOX) for case in IN_FIREFOX],
    indirect=["opened"],
)
def test_page_has_the_light_of_the_engine_before_and_after_turning(case, opened, tmp_path):
    """The browser draws both: the light that follows, and the numbers of the filters as colours.

    Another renderer's lines have other edges, whatever their light.
    """
    make, scene, options = CASES[case]
    mesh, colored = make(), COLORED.get(case, {})
    centre = AWAY if case == "far from the origin" else (0.0, 0.0, 0.0)
    camera = first_camera(centre)
    path = vizlight.live_html(
        mesh, tmp_path / "live.html", scene=scene, camera=camera, background="black", panel=False,
        line_width=2, **options, **colored,
    )  # fmt: skip
    live, seen = opened(path)
    other, _ = opened(baked(path, engine_colors(mesh, scene, camera, options, colored)))
    pictures = []
    for degrees in (0, 60):
        camera.azimuth += degrees
        browsers.turn(live, degrees)
        browsers.turn(other, degrees)
        recolor(other, engine_colors(mesh, scene, camera, options, colored))
        got, expected = browsers.shot(live), browsers.shot(other)
        pictures.append(got)
        error = np.abs(got - expected)
        assert expected.std() > 10
        assert error.mean() <= 1
        assert np.quantile(error.max(axis=-1)[expected.max(axis=-1) > 0], 0.99) <= 4
    assert not seen or seen == [path.as_uri()]
    assert np.abs(pictures[1] - pictures[0]).mean() > 1


def test_colours_of_data_in_bright_light_are_those_of_tint(shown):
    mesh = swatches()
    camera = vizlight.render.camera_on(mesh, (0, 0, 1))
    camera.parallel_projection = True
    bright = Material(ambient=0.4, diffuse=1.0, specular=0.5, shininess=3)
    scene = Scene(lights=Light(direction=(0.3, 0.2, 1)), material=bright)
    page = shown(mesh, scene, camera=camera, panel=False, scalars="value", cmap="turbo")
    colors = np.unique(browsers.shot(page).reshape(-1, 3), axis=0)
    seen = scene.replace(view=View.from_camera(camera))
    lit = vizlight.tint(vizlight.illuminate(mesh, seen), "value", cmap="turbo")
    expected = lit["rgb"][::4].astype(int)
    apart = np.abs(colors[:, None] - expected).max(axis=-1)
    assert len(np.unique(expected, axis=0)) > 40
    assert apart.min(axis=0).max() <= 1


def test_the_page_reads_the_numbers_that_were_packed(shown):
    """Places to the rounding of float32, cells to the bit, and no place for what is not finite."""
    mesh = pv.Sphere(theta_resolution=20, phi_resolution=20)
    mesh["n"] = 2 * np.asarray(mesh.points)
    mesh = mesh.translate((3.0, -2.0, 1.0))
    mesh.points[7] = (np.nan, 1, 2)
    mesh.points[9] = (0, np.inf, 2)
    camera = first_camera((3.0, -2.0, 1.0))
    page = shown(mesh, Scene(lights=FAR), normals="n", camera=camera)
    read = """async () => {
        const { gl, places, batches: [{ order, buffers, count }], given } = vizlight.meshes[0];
        const normals = new Int16Array(places.length);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffers.vizNormalMC);
        gl.getBufferSubData(gl.ARRAY_BUFFER, 0, normals);
        const numbers = (list) => Array.from(list, (x) => (Number.isNaN(x) ? null : x));
        return [places, order, normals.map((x) => x)].map(numbers);
    }"""
    points, cells, normals = page.evaluate(read)
    places = np.array(points, dtype=float).reshape(-1, 3)
    expected = np.asarray(mesh.points, dtype=float) - camera.focal_point
    lost = ~np.all(np.isfinite(expected), axis=1)
    np.testing.assert_array_equal(np.flatnonzero(lost), [7, 9])
    np.testing.assert_array_equal(np.isnan(places).all(axis=1), lost)
    assert np.abs(places - expected)[~lost].max() <= 2.0**-23 * np.abs(expected[~lost]).max()
    np.testing.assert_array_equal(np.reshape(cells, (-1, 3)), mesh.regular_faces)
    rows = np.reshape(normals, (-1, 3))
    # Their length says how far they may lean away from the eye.
    rows = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    assert np.abs(rows - mesh["n"]).max() < 5e-5


@pytest.mark.parametrize("question", ["direction", "slope", "heading", "shape"])
def test_light_by_question_is_that_of_the_preset(question, shown):
    mesh, camera = torus(), first_camera()
    how = {"tangents": "around"} | ({"conditioned": True} if question == "shape" else {})
    expected = shown(mesh, getattr(presets, question)(), camera=camera, **how)
    how["conditioned"] = True
    page = shown(mesh, Scene(lights=FAR), camera=camera, **how)
    page.evaluate("(name) => vizlight.look(name)", question)
    np.testing.assert_allclose(browsers.shot(page), browsers.shot(expected), atol=1)
    assert page.evaluate("vizlight.page.looks")[question]["key"] == list(QUESTIONS[question].words)


def test_keys_of_a_page_are_the_figures_of_pictures(shown):
    page = shown(winding(), Scene(lights=FAR))
    read = "() => document.querySelector('canvas[data-ball=key]').toDataURL().split(',')[1]"
    for question in ("direction", "slope"):
        page.evaluate("(name) => { vizlight.look(name); vizlight.draw(); }", question)
        drawn = Image.open(io.BytesIO(base64.b64decode(page.evaluate(read))))
        wanted = vizlight.presets.key_picture(getattr(presets, question)(), 176).astype(int)
        # The style of the page turns a figure over, and makes a bar low.
        drawn = drawn.transpose(Image.Transpose.FLIP_TOP_BOTTOM).resize(wanted.shape[1::-1])
        got = np.asarray(drawn, dtype=int)
        assert np.mean((got[..., 3] > 128) != (wanted[..., 3] > 128)) < 0.01
        inside = (got[..., 3] > 250) & (wanted[..., 3] > 250)
        assert np.abs(got - wanted)[inside].mean() < 4


def test_questions_that_the_data_cannot_answer_are_not_offered(tmp_path):
    ball = pv.Sphere()
    lines = pv.lines_from_points([(0, 0, 0), (1, 1, 1)])
    for mesh, scalars, expected in (
        (ball, None, ["shape"]), (ball, "z", ["shape", "value"]),
        (lines, None, ["direction", "slope", "heading", "shape"]),
    ):  # fmt: skip
        mesh["z"] = mesh.points[:, 2] if scalars else np.zeros(mesh.n_points)
        path = vizlight.live_html(mesh, tmp_path / "a.html", scene=Scene(lights=FAR))
        assert list(scene_in(path)[2]["looks"]) == expected


def test_arrays_colour_the_mesh_as_in_the_plotter(shown):
    mesh, scene = torus(), presets.value()
    options = {"camera": first_camera(), "normals": "n"}
    expected = shown(mesh, scene, scalars="height", cmap="viridis", **options)
    page = shown(mesh, scene, **options)
    page.evaluate("() => vizlight.change({ color: 'height', cmap: 'viridis' })")
    error = np.abs(browsers.shot(page) - browsers.shot(expected))
    assert error.mean() < 0.5
    assert np.quantile(error, 0.99) <= 3
    page.evaluate("() => vizlight.change({ color: 'height', cmap: 'plasma' })")
    assert np.abs(browsers.shot(page) - browsers.shot(expected)).max() > 40


def test_a_page_starts_at_the_view_of_its_scene(tmp_path):
    mesh = torus()
    for view in (View(direction=(0, -1, 0.4)), View(position=(3.0, 2.0, 1.5))):
        scene = Scene(lights=FAR, view=view)
        for shown, light in ((mesh, scene), (vizlight.illuminate(mesh, scene), None)):
            path = vizlight.live_html(shown, tmp_path / "a.html", scene=light)
            camera = scene_in(path)[2]["camera"]
            toward = np.subtract(camera["position"], camera["focal"])
            expected = view.direction or np.subtract(view.position, mesh.center)
            cosine = toward @ expected / np.linalg.norm(toward) / np.linalg.norm(expected)
            assert cosine > 0.9999


def test_page_without_webgl_shows_the_picture_and_says_so(chromium, tmp_path):
    path = browsers.plain_page(tmp_path)
    bare = chromium.launch(
        executable_path=browsers.CHROMIUM, args=["--no-sandbox", "--disable-3d-apis"]
    )
    page = bare.new_page(viewport=SIZE)
    page.goto(path.as_uri())
    assert "needs WebGL 2" in page.get_by_role("alert").inner_text()
    assert page.evaluate("document.getElementById('picture').naturalWidth") > 100
    seen = np.array(Image.open(io.BytesIO(page.screenshot())).convert("L"), dtype=int)
    assert seen.std() > 10
    bare.close()


def test_a_background_that_nobody_chose_is_dark_on_dark_pages_but_not_on_paper(opened, tmp_path):
    scene = Scene(lights=FAR)
    for options, corners in (({}, [22, 255, 255]), ({"background": "white"}, [255, 255, 255])):
        path = vizlight.live_html(pv.Sphere(), tmp_path / "a.html", scene=scene, **options)
        page, _ = opened(path)
        seen = []
        for media in (
            {"color_scheme": "dark"}, {"color_scheme": "light"},
            {"color_scheme": "dark", "media": "print"},
        ):  # fmt: skip
            page.emulate_media(**media)
            seen.append(int(browsers.shot(page)[3, 3, 0]))
        assert seen == corners


def test_two_files_serve_a_strict_policy(browser, tmp_path):
    path = browsers.plain_page(tmp_path, files=2)
    assert (tmp_path / "viewer.js").read_text("utf-8") == html.viewer()
    assert "<script>" not in path.read_text("utf-8")

    class Strict(http.server.SimpleHTTPRequestHandler):
        def end_headers(self):
            policy = "default-src 'none'; script-src 'self'; img-src 'self' data: blob:"
            self.send_header("Content-Security-Policy", policy)
            super().end_headers()

        def log_message(self, *_):
            """Say nothing."""

    handler = functools.partial(Strict, directory=tmp_path)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        page, said = browser.new_page(viewport=SIZE), []
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(f"http://127.0.0.1:{server.server_port}/ball.html")
        page.wait_for_selector("body[data-ready]")
        assert page.evaluate("getComputedStyle(document.getElementById('panel')).display") == "flex"
        assert browsers.shot(page).std() > 10
        page.close()
        server.shutdown()
        thread.join()
    assert said == []


def test_scans_are_points_in_the_page(tmp_path):
    scan = pv.PolyData(np.random.default_rng(0).normal(size=(500, 3)))
    for step in (scan, vizlight.illuminate(scan), pv.MultiBlock([scan, pv.Sphere()])):
        _, _, content = scene_in(vizlight.live_html(step, tmp_path / "scan.html"))
        assert all(mesh["live"] for mesh in content["meshes"])
        assert "verts" in content["meshes"][0]
        # White points show before black.
        dark = not isinstance(step, pv.MultiBlock)
        assert content["background"] == ("#000000" if dark else "#ffffff")
    with pytest.raises(ValueError, match="mesh: expected a surface, whose normals are lit"):
        vizlight.live_html(pv.PolyData(np.eye(3)), tmp_path / "few.html")


def test_light_that_cannot_follow_is_fixed_and_said_to_be(tmp_path):
    mesh, scene = torus(), Scene(lights=FAR, material=SHINY)
    with pytest.warns(UserWarning, match="does not follow the eye, because .*cylinder.*ambient"):
        path = vizlight.live_html(
            mesh, tmp_path / "a.html", scene=scene, tangents="around", model="cylinder"
        )
    _, _, content = scene_in(path)
    assert "does not follow the eye" in content["notices"][0]
    assert not content["meshes"][0]["live"]
    with pytest.warns(UserWarning, match="does not follow the eye; ambient and diffuse"):
        path = vizlight.live_html(pv.Sphere(), path, scene=scene, light="points")
    _, _, content = scene_in(path)
    packed = content["meshes"][0]["colors"]["data"]
    colors = np.frombuffer(zlib.decompress(base64.b64decode(packed)), np.uint8).reshape(-1, 4)
    bare = Scene(lights=FAR, material=shiny(specular=0))
    expected = vizlight.illuminate(pv.Sphere(), bare)["luminance"]
    assert np.abs(colors[:, 0] - 255 * np.clip(expected, 0, 1)).max() <= 1


def test_plotter_writes_its_meshes_with_their_own_light(tmp_path):
    plotter = pv.Plotter(off_screen=True)
    with pytest.raises(ValueError, match="plotter: expected a mesh with live light"):
        plotter.vizlight.export_html(tmp_path / "a.html")
    # A frame without light would be all that is left of a lit cube.
    plotter.add_mesh(pv.Cube())
    plotter.add_mesh(pv.Disc(), lighting=False)
    with pytest.raises(ValueError, match="got none and 1 in the light of PyVista"):
        plotter.vizlight.export_html(tmp_path / "a.html")
    plotter.clear()
    plotter.vizlight.add_mesh(torus(), scene=Scene(lights=FAR, material=SHINY), scalars="height")
    plotter.vizlight.add_mesh(winding(), scene=Scene(**HEADLIT), line_width=3, name="coil")
    plotter.add_mesh(pv.Cube())
    with pytest.warns(UserWarning, match="1 actors in the light of PyVista are not"):
        path = plotter.vizlight.export_html(tmp_path / "a.html", title="Both")
    _, _, content = scene_in(path)
    assert [mesh["name"] for mesh in content["meshes"]] == ["mesh 1", "coil"]
    assert [light["eye"] for (light,) in content["lights"]] == [False, True]
    assert content["bars"][0]["title"] == "height"
    assert content["meshes"][1]["lineWidth"] == 3
    assert [mesh["free"] for mesh in content["meshes"]] == [False, False]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"path": "lit.png"}, "path: expected a name that ends in .html, .htm"),
        ({"path": "none/lit.html"}, "path: expected a folder that exists"),
        ({"tangents": "height"}, "tangents: expected .*'height'"),
        ({"scalars": "nothing"}, "scalars: expected .*'nothing'"),
        ({"files": 3}, "files: expected"),
        ({"title": 3}, "title: expected"),
        ({"frames": 3}, "frames: expected"),
    ],
)
def test_what_does_not_fit_is_refused_and_nothing_is_written(options, message, tmp_path):
    path = tmp_path / options.pop("path", "lit.html")
    with pytest.raises((FileError, TypeError, ValueError), match=message):
        vizlight.live_html(torus(), path, scene=Scene(lights=FAR, material=SHINY), **options)
    assert not list(tmp_path.iterdir())


def test_the_viewer_is_small_and_asks_for_nothing():
    text = html.viewer()
    assert len(text.encode()) < 80_000
    text = text.replace("http://www.w3.org/2000/svg", "")
    assert not re.search(r"https?:|fetch\(|XMLHttp|eval\(|innerHTML|document\.write", text)


@pytest.mark.parametrize(("mesh", "colour"), [(pv.Line(), "#000000"), (pv.Plane(), "#ffffff")])
def test_lines_alone_stand_before_black(mesh, colour, tmp_path):
    path = vizlight.live_html(mesh, tmp_path / "a.html", scene=Scene(lights=FAR, material=SHINY))
    assert scene_in(path)[2]["background"] == colour


def test_the_bar_of_kinds_has_their_names(tmp_path):
    mesh = pv.Sphere()
    mesh["chain"] = (mesh.points[:, 2] > 0).astype(float)
    plotter = pv.Plotter(off_screen=True)
    for names in ({0: "A", 1: "<b>"}, {}):
        table = vizlight.maps.kinds(names or [0, 1])
        plotter.vizlight.add_mesh(mesh, scalars="chain", cmap=table, name="one")
        plotter.vizlight.export_html(tmp_path / "a.html")
        (bar,) = scene_in(tmp_path / "a.html")[2]["bars"]
        assert [word for _, word in bar["marks"]] == ([*names.values()] or ["0", "1"])


@pytest.mark.filterwarnings("ignore:.*could not be lit")
def test_what_is_not_data_is_grey_and_has_a_name(opened, tmp_path):
    camera = vizlight.render.camera_on((-0.5, 0.5, -0.5, 0.5, 0, 0), (0, 0, 1), parallel=True)
    camera.parallel_scale = 0.5
    path = vizlight.live_html(
        half_known(), tmp_path / "a.html",
        scene=Scene(lights=Light(direction=(1, 0, 1)), material=SHINY), camera=camera,
        tangents="V", scalars="height", panel=False,
    )  # fmt: skip
    page, _ = opened(path)
    picture = browsers.shot(page)
    np.testing.assert_array_equal(picture[80:170, 165:240], 128)
    missing, known = picture[30:100, 40:140], picture[160:220, 40:140]
    assert np.ptp(missing, axis=2).max() == 0
    assert np.ptp(known, axis=2).min() > 10
    bars = scene_in(path)[2]["bars"]
    assert [bar["title"] for bar in bars] == ["height", "no data"]
    assert bars[1]["colors"] == ["#808080"] * 2
    page, _ = opened(path, bare=False, viewport={"width": 400, "height": 300})
    (_, top, _, _), (_, other, wide, _) = page.evaluate(
        "[...document.querySelectorAll('.bar .strip')].map((one) => one.getBoundingClientRect())"
        ".map(({ left, top, width, height }) => [left, top, width, height])"
    )
    assert abs(top - other) < 2
    assert wide < 80  # beside the bar also on a telephone


def test_a_page_has_the_key_of_its_light(tmp_path):
    ball = pv.Sphere()
    ball["flow"] = np.cross((0.3, 0.2, 1.0), ball.points)
    ball["z"] = ball.points[:, 2]

    def key_of(scene, **options):
        path = vizlight.live_html(ball, tmp_path / "a.html", scene=scene, **options)
        return scene_in(path)[2]["key"]

    scene = presets.direction()
    assert key_of(scene, tangents="flow") == ["direction on the screen"]
    assert key_of(scene, tangents="flow", key=False) is None
    # The bar tells values, and hues of data hide those of the light.
    assert key_of(scene, tangents="flow", scalars="z") is None
    assert key_of(Scene(), scalars="z") is None
    assert key_of(Scene(lights=Light(direction=(1, 2, 3)))) is None


def test_lines_of_a_page_have_the_halos_and_widths_of_the_picture(opened, tmp_path):
    plotter = pv.Plotter(off_screen=True, window_size=(300, 250))
    scene = Scene(material=Material(ambient=0.4, diffuse=0, specular=0))
    front, back = pv.Line((-1, 0, 0), (1, 0, 0)), pv.Line((0, -0.6, -1), (0, 0.6, -1))
    back["share"], front["share"] = [1.0, 1.0], [0.2, 1.0]
    for line in (front, back):
        plotter.vizlight.add_mesh(line, scene=scene, line_width=16, width="share")
    outlined = pv.Line((-1, 0.4, 0.5), (1, 0.4, 0.5), resolution=9)
    plotter.vizlight.add_mesh(outlined, scene=scene, line_width=12, halo="red")
    plotter.view_xy()
    plotter.enable_parallel_projection()
    expected = np.asarray(plotter.screenshot(return_img=True), dtype=np.int16)
    path = plotter.vizlight.export_html(tmp_path / "lines.html", key=False)
    page, _ = opened(path)
    # The gaps of the halo are 0.7 % of the picture.
    assert np.mean(np.abs(browsers.shot(page) - expected).max(axis=2) > 60) < 0.003


def test_strokes_behind_the_border_of_their_surface_do_not_stand_out(opened, tmp_path):
    ball = pv.Sphere(theta_resolution=60, phi_resolution=60)
    ball["V"] = np.cross((0, 0, 1.0), ball.points)
    even = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
    lines = vizlight.streamlines(ball, even, tangents="V", spacing=0.06, stroke_length=0.3)
    plotter = pv.Plotter(off_screen=True, window_size=(300, 250))
    plotter.background_color = "red"
    plotter.vizlight.add_mesh(ball, scene=even)
    thick = {"color": "black", "width": "width", "line_width": 4, "halo": False}
    plotter.vizlight.add_mesh(lines, scene=even, **thick)
    plotter.view_vector((1, 0.2, 0.6))
    page, _ = opened(plotter.vizlight.export_html(tmp_path / "strokes.html", key=False))
    drawn = browsers.shot(page)
    page.evaluate("vizlight.change({ hidden: ['mesh 2'] })")
    bare = browsers.shot(page)
    outside = (bare == (255, 0, 0)).all(axis=2)
    assert (np.abs(drawn - bare).max(axis=2) > 100).sum() > 1500
    assert not (np.abs(drawn - bare).max(axis=2) > 100)[outside].any()


def test_strokes_of_a_page_move_as_those_of_a_movie(opened, tmp_path):
    sheet = pv.Plane(i_size=4, j_size=1, i_resolution=40, j_resolution=10)
    sheet["V"] = np.tile([2.0, 0, 0], (sheet.n_points, 1))
    scene = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
    lines = vizlight.streamlines(
        sheet, scene, tangents="V", seeds=[(-2, 0, 0)], stroke_length=0.8, travel=1.0
    )
    plotter = pv.Plotter(off_screen=True, window_size=(300, 250))
    plotter.vizlight.add_mesh(lines, scene=scene, color="black", width="width", line_width=12)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    path = plotter.vizlight.export_html(tmp_path / "moving.html", key=False)
    page, _ = opened(path)
    page.evaluate("() => vizlight.play(false)")
    shares, movie = (0.0, 0.3), []
    for share in shares:
        lines["width"] = moved_widths(lines, share)
        plotter.render()
        movie.append(np.asarray(plotter.screenshot(return_img=True), dtype=np.int16))
    for share, own, other in zip(shares, movie, movie[::-1], strict=True):
        page.evaluate(f"() => {{ vizlight.meshes[0].move({share}); vizlight.draw(); }}")
        # The borders are smooth.
        assert len(np.unique(browsers.shot(page)[90:160])) > 3
        # The button is above the strokes. Borders differ by their smoothing, a fifth of the ink.
        seen = browsers.shot(page)[90:160]
        apart, moved = (np.mean(np.abs(seen - each[90:160]) > 60) for each in (own, other))
        assert apart < 0.015
        assert moved > 4 * apart
    page.evaluate("() => vizlight.play(true)")
    before = page.evaluate("() => vizlight.time || 0")
    page.wait_for_timeout(500)
    assert page.evaluate("() => vizlight.time") > before
