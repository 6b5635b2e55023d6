"""Vector graphics of plotters: exact colours, hidden faces, text, sizes, whole files."""

import itertools
import re
import shutil
import subprocess

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import Scene
from vizlight.draw.vector import figure
from vizlight.draw.vector.files import Fill, Sheet, Words, pdf_of, svg_of
from vizlight.draw.vector.lines import lines_of
from vizlight.draw.vector.samples import enlarged, samples_of
from vizlight.draw.vector.words import words_of
from vizlight.files import FileError

pytestmark = pytest.mark.opengl


@pytest.fixture
def plotter():
    """Return an empty plotter with a parallel camera above the origin."""
    plotter = pv.Plotter(off_screen=True, window_size=(150, 120))
    plotter.background_color = "white"
    plotter.enable_anti_aliasing("msaa", multi_samples=8)
    return plotter


def seen_from_above(plotter, scale=1.2):
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = scale


def drawn(path, size):
    """Return the picture of an independent renderer."""
    if shutil.which("rsvg-convert") is None:
        pytest.skip("no rsvg-convert of librsvg2-bin")
    png = path.with_suffix(".png")
    subprocess.run(["rsvg-convert", path, "-o", png], check=True)
    picture = np.asarray(Image.open(png).convert("RGB")).astype(int)
    assert picture.shape[:2] == size
    return picture


def fills(text):
    """Return the colours of faces, without the mean beneath and the background over them."""
    return re.findall(r'<path fill="(#\w+)"', text)[1:-1]


def test_a_cube_has_three_fills_of_its_exact_colours(plotter, tmp_path):
    plotter.add_mesh(pv.Cube(), color="white")
    plotter.view_isometric()
    picture = plotter.screenshot(return_img=True)
    text = plotter.vizlight.save_graphic(tmp_path / "cube.svg").read_text()
    flat, count = np.unique(picture.reshape(-1, 3), axis=0, return_counts=True)
    common = [bytes(color).hex() for color in flat[np.argsort(-count)[:4]]]
    expected = {f"#{color}" for color in common} - {"#ffffff"}
    assert set(fills(text)) == expected
    assert len(fills(text)) == 3
    assert len(text) < 3000


def test_what_is_hidden_has_no_path_and_the_plotter_is_as_before(plotter, tmp_path):
    plotter.add_mesh(pv.Plane(i_size=2, j_size=2), color=(0.0, 1.0, 0.0), lighting=False)
    plotter.add_mesh(
        pv.Plane(center=(0, 0, -1), i_size=1, j_size=1), color=(1.0, 0.0, 0.0), lighting=False
    )
    seen_from_above(plotter)
    before = plotter.screenshot(return_img=True)
    text = plotter.vizlight.save_graphic(tmp_path / "planes.svg").read_text()
    assert fills(text) == ["#00ff00"]
    assert np.array_equal(plotter.screenshot(return_img=True), before)
    assert plotter.window_size == [150, 120]


def test_lines_are_strokes_of_their_width_and_those_behind_end_at_the_halo(plotter, tmp_path):
    for ends, color in ((((-1, 0, 0), (1, 0, 0)), "red"), (((0, -1, 1), (0, 1, 1)), "blue")):
        line = pv.Line(*ends, resolution=20)
        line["c"] = np.tile(np.array(pv.Color(color).int_rgb, np.uint8), (line.n_points, 1))
        plotter.vizlight.add_mesh(line, scalars="c", rgb=True, line_width=4, halo=1.0)
    seen_from_above(plotter)
    text = plotter.vizlight.save_graphic(tmp_path / "lines.svg").read_text()
    strokes = re.findall(r'stroke="(#\w+)" stroke-width="([\d.]+)"[^>]* d="([^"]*)"', text)
    cores = [stroke for stroke in strokes if stroke[0] != "#ffffff"]
    assert [float(width) for _, width, _ in cores] == [40.0, 40.0]
    # The line behind is one path of two parts; the nearer one comes last and is whole.
    assert [path.count("M") for *_, path in cores] == [2, 1]
    assert cores[0][0] != cores[1][0]
    plotter.vizlight.add_mesh(line, scalars="c", rgb=True, line_width=4, halo="#008000")
    text = plotter.vizlight.save_graphic(tmp_path / "outlines.svg").read_text()
    assert "#008000" in re.findall(r'stroke="(#\w+)"', text)


def test_words_of_texts_keys_and_bars_are_text(plotter, tmp_path):
    ball = pv.Sphere()
    ball["height"] = ball.points[:, 2]
    plotter.add_mesh(ball, scalars="height", scalar_bar_args={"title": "height & depth"})
    plotter.add_text("above", position="upper_edge")
    plotter.vizlight.add_key("shape")
    path = plotter.vizlight.save_graphic(tmp_path / "words.svg", error=20)
    words = re.findall(r"<tspan[^>]*>([^<]*)</tspan>", path.read_text())
    assert {"height &amp; depth", "above", "-0.500", "0.500"} <= set(words)
    assert "the way it faces" in " ".join(words)


def test_a_colour_beyond_white_by_rounding_is_that_of_white():
    square = np.array([[1.0, 1], [9, 1], [9, 9], [1, 9]])
    for color in ((1.0 + 1e-7, 0.5, -1e-9), (1.0, 0.5, 0.0)):
        sheet = Sheet((10, 10), (1.0, 1.0, 1.0), {"fills": [Fill(color, [square])]}, "")
        assert 'fill="#ff8000"' in svg_of(sheet)
        assert pdf_of(sheet).startswith(b"%PDF")


def test_a_pdf_keeps_its_words_and_its_bytes(plotter, tmp_path):
    plotter.add_mesh(pv.Cube(), color="white")
    plotter.add_text("words", position=(10, 10), font_size=8)
    paths = [plotter.vizlight.save_graphic(tmp_path / name) for name in ("a.pdf", "b.pdf")]
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    assert b"/Subtype /Type0" in first or b"/Subtype /TrueType" in first
    assert b"/Subtype /Image" not in first


def test_a_grey_ball_is_drawn_within_its_error(plotter, tmp_path):
    ball = pv.Sphere(radius=1, theta_resolution=60, phi_resolution=60)
    plotter.vizlight.add_mesh(ball, scene=Scene())
    seen_from_above(plotter)
    picture = plotter.screenshot(return_img=True).astype(int)
    path = plotter.vizlight.save_graphic(tmp_path / "ball.svg", error=4)
    assert "within" in path.read_text()
    away = np.abs(drawn(path, picture.shape[:2]) - picture).max(axis=2)
    y, x = np.mgrid[:120, :150]
    radius = np.hypot(x - 74.5, y - 59.5)
    # Away from the edge, whose pixels are mixtures with the ground.
    assert np.mean(away[radius < 47] <= 5) > 0.995
    assert away[radius > 52].max() == 0


def test_many_colours_are_plates_within_the_error_and_a_page_of_its_own_size(plotter, tmp_path):
    ball = pv.Sphere(radius=1, theta_resolution=40, phi_resolution=40)
    ball["z"] = ball.points[:, 0]
    plotter.vizlight.add_mesh(ball, scalars="z", cmap="viridis", scene=Scene())
    plotter.remove_scalar_bar()
    seen_from_above(plotter)
    picture = plotter.screenshot(return_img=True).astype(int)
    path = plotter.vizlight.save_graphic(tmp_path / "ball.svg", error=5)
    text = path.read_text()
    assert text.count("mix-blend-mode:lighten") == 3
    # Each plate has one channel, and all have the same outline, so that no edge has a fringe.
    plates = text.split("<g style=")[1:]
    grounds = [re.findall(r'fill="#(\w+)" d="([^"]*)"', plate)[-1] for plate in plates]
    assert [color for color, _ in grounds] == ["ff0000", "00ff00", "0000ff"]
    assert len({outline for _, outline in grounds}) == 1
    away = np.abs(drawn(path, picture.shape[:2]) - picture).max(axis=2)
    y, x = np.mgrid[:120, :150]
    radius = np.hypot(x - 74.5, y - 59.5)
    assert np.mean(away[radius < 47] <= 6) > 0.995
    assert away[radius > 52].max() == 0
    few = plotter.vizlight.save_graphic(tmp_path / "few.svg", error=60).read_text()
    assert "mix-blend-mode" not in few


def test_pieces_of_a_line_have_their_exact_colour_one_halo_and_no_seams(plotter, tmp_path):
    plotter.set_background("white")
    line = pv.Line((-1, 0, 0), (1, 0, 0), resolution=40)
    line["c"] = np.linspace((200, 40, 0), (200, 180, 0), line.n_points).astype(np.uint8)
    scene = Scene(lights=(), material=vizlight.Material(ambient=1, diffuse=0, specular=0))
    options = {"scalars": "c", "rgb": True, "line_width": 4, "scene": scene}
    plotter.vizlight.add_mesh(line, halo="black", **options)
    seen_from_above(plotter)
    text = plotter.vizlight.save_graphic(tmp_path / "line.svg", error=8).read_text()
    strokes = re.findall(r'stroke="(#\w+)"[^>]* d="M(\d+) \d+l(\d+)', text)
    assert [color for color, *_ in strokes].count("#000000") == 1
    cores = [(color, int(x), int(x) + int(way)) for color, x, way in strokes[1:]]
    assert 8 < len(cores) < 16
    assert all(color[1:3] == "c8" and color[5:] == "00" for color, *_ in cores)
    # Each begins within the one before.
    cores.sort(key=lambda core: core[1])
    assert all(end > begin for (*_, end), (_, begin, _) in itertools.pairwise(cores))


def test_lines_of_changing_width_are_outlines(plotter, tmp_path):
    line = pv.Line((-1, 0, 0), (1, 0, 0), resolution=40)
    line["width"] = np.linspace(0, 1, line.n_points)
    plotter.vizlight.add_mesh(line, color="black", width="width", line_width=12, scene=Scene())
    seen_from_above(plotter)
    text = plotter.vizlight.save_graphic(tmp_path / "wedge.svg").read_text()
    outline = re.findall(r'<path fill="#0[01]0[01]0[01]" d="([^"]*)"', text)[-1]
    outline = outline.split("M")[-1]
    corners = np.cumsum(np.array(re.findall(r"-?\d+", outline), dtype=float).reshape(-1, 2), axis=0)
    assert np.ptp(corners[:, 1]) / 10 == pytest.approx(12, abs=0.3)
    # A wedge needs no more than its corners.
    assert len(corners) < 9


def test_lines_of_vtk_are_as_wide_as_in_a_supersampled_picture(plotter):
    plotter.enable_anti_aliasing("ssaa")
    plotter.add_mesh(pv.Line((-1, 0, 0), (1, 0, 0)), color="black", line_width=20)
    seen_from_above(plotter)
    picture = plotter.screenshot(return_img=True)
    (lines,) = lines_of(plotter, lambda _: None)
    assert lines.width == pytest.approx(np.count_nonzero(picture[:, 75, 0] < 128), abs=1)


def test_details_that_are_too_many_become_pixels_with_a_note(plotter, tmp_path, monkeypatch):
    monkeypatch.setattr(figure, "LARGEST", 20_000)
    plane = pv.Plane(i_size=2, j_size=2, i_resolution=60, j_resolution=60)
    colors = np.random.default_rng(3).integers(0, 255, (plane.n_cells, 3), dtype=np.uint8)
    plane.cell_data["c"] = colors
    plotter.add_mesh(plane, scalars="c", rgb=True, lighting=False)
    seen_from_above(plotter)
    with pytest.warns(UserWarning, match="'noise.svg' holds pixels"):
        text = plotter.vizlight.save_graphic(tmp_path / "noise.svg").read_text()
    assert "data:image/" in text


@pytest.mark.slow
def test_pixels_that_do_not_fit_as_png_are_jpeg(plotter, tmp_path, monkeypatch):
    monkeypatch.setattr(figure, "LARGEST", 40_000)
    rough = np.random.default_rng(3).normal(size=(300, 300, 1))
    field = pv.ImageData(dimensions=(300, 300, 1), spacing=(0.01, 0.01, 1), origin=(-1.5, -1.5, 0))
    field["c"] = np.cumsum(rough, axis=0).ravel()
    plotter.add_mesh(field, scalars="c", cmap="viridis", lighting=False, show_scalar_bar=False)
    seen_from_above(plotter)
    with pytest.warns(UserWarning, match="'rough.svg' holds pixels and words, in"):
        path = plotter.vizlight.save_graphic(tmp_path / "rough.svg")
    assert "data:image/jpeg;base64," in path.read_text()
    assert path.stat().st_size <= 40_000
    # Where nothing fits, exact colours are worth twice the size of paths.
    monkeypatch.setattr(figure, "LARGEST", 10_000)
    with pytest.warns(UserWarning, match="'rough.pdf' holds pixels and words, in"):
        plotter.vizlight.save_graphic(tmp_path / "rough.pdf")


def test_words_of_keys_are_not_drawn_beside_their_text(plotter):
    ball = pv.Sphere()
    ball["height"] = ball.points[:, 2]
    plotter.vizlight.add_mesh(ball, scalars="height", scene=Scene(), show_scalar_bar=False)
    plotter.vizlight.add_key()
    plotter.screenshot(return_img=True)
    words, props = words_of(plotter)
    places = [(*word.place, word.size) for word in words if isinstance(word, Words)]
    assert len(places) > 3
    # The margin is laid out anew for the larger picture.
    with enlarged(plotter, 2, props):
        plotter.render()
        picture = samples_of(plotter).colors
    for x, y, size in np.rint(2 * np.array(places)).astype(int):
        around = picture[max(y - size // 2, 0) : y + size // 2, x : x + size]
        assert np.ptp(around, axis=(0, 1)).max() == 0


def test_the_error_falls_until_the_file_fits_and_is_told(plotter, tmp_path, monkeypatch):
    monkeypatch.setattr(figure, "LARGEST", 12_000)
    plotter.add_mesh(pv.Sphere(theta_resolution=60, phi_resolution=60), smooth_shading=True)
    with pytest.warns(UserWarning, match="within .* of 255, so that it has at most 12 kB"):
        path = plotter.vizlight.save_graphic(tmp_path / "ball.svg")
    assert path.stat().st_size <= 12_000
    with pytest.warns(UserWarning, match="kB at an error of .* of 255"):
        plotter.vizlight.save_graphic(tmp_path / "ball.svg", error=1)


@pytest.mark.parametrize(
    ("name", "error", "match"),
    [("a.eps", None, "ends in .svg, .pdf"), ("no/a.svg", None, "a folder that exists")],
)
def test_bad_paths(plotter, tmp_path, name, error, match):
    plotter.add_mesh(pv.Cube())
    with pytest.raises(FileError, match=match):
        plotter.vizlight.save_graphic(tmp_path / name, error=error)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("error", [0.0, 200.0, np.nan])
def test_bad_errors(plotter, tmp_path, error):
    plotter.add_mesh(pv.Cube())
    with pytest.raises(ValueError, match="error: expected"):
        plotter.vizlight.save_graphic(tmp_path / "a.svg", error=error)


def test_looks_save_vector_graphics_and_say_so_in_their_script(tmp_path):
    look = vizlight.look(pv.Cube(), "shape", size=(120, 90))
    assert look.save(tmp_path / "cube.svg").read_text().startswith("<svg")
    assert 'plotter.vizlight.save_graphic("cube.pdf")' in look.script("cube.pdf")
