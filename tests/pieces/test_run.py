"""Pieces are lit as the whole, whatever the cut; finished ones are kept, faulty ones are named."""

import hashlib

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

import vizlight
from vizlight import DepthCue, Light, Scene, View, pieces, render
from vizlight.pieces.sources import FilePiece
from vizlight.vtk import normals as of_normals
from vizlight.vtk import sides

SCENE = Scene(
    lights=[Light(direction=(1, 0.5, 2)), Light(position=(9, 9, 9))],
    view=View(position=(20, 5, 9)),
    depth_cue=DepthCue(),
)
PLAIN = Scene(view=View(direction=(0, 0, 1)))
LEVEL = 1.2
#: Most pieces of the surfaces whose sides are found.
MOST = 5


@pytest.fixture
def light(tmp_path):
    """Return what lights a source into one file."""

    def call(source, scene=SCENE, *, out="lit.pvtp", **options):
        return pieces.light(source, scene, out=tmp_path / out, **options)

    return call


@pytest.fixture
def stored(image, tmp_path):
    """Return the file of the grid."""
    image.save(tmp_path / "grid.vti")
    return tmp_path / "grid.vti"


@pytest.fixture(scope="module")
def image():
    grid = pv.ImageData(dimensions=(21, 18, 23), spacing=(0.2,) * 3, origin=(5, 3, 2))
    x, y, z = np.asarray(grid.points).T
    middle = np.array(grid.center)[:, None]
    away = np.linalg.norm((np.array([x, y, z]) - middle) * [[1], [1.2], [0.9]], axis=0)
    grid["s"] = (away + 0.1 * np.sin(4 * x)).astype(np.float32)
    grid["V"] = np.stack([np.cos(3 * y), np.sin(2 * z), x], axis=1).astype(np.float32)
    return grid


def cut(grid, folder, labels, suffix):
    """Write the parts of a mesh by a label per cell."""
    folder.mkdir(exist_ok=True)
    for i in np.unique(labels):
        which = np.flatnonzero(labels == i)
        part = grid.extract_cells(which, pass_point_ids=False, pass_cell_ids=False)
        if suffix == "vtp":
            part = part.extract_surface(algorithm="geometry", pass_pointid=False, pass_cellid=False)
        part.save(folder / f"part{i:02d}.{suffix}")
    return str(folder / f"*.{suffix}")


def cuts(grid, seed):
    """Return labels of 12 parts: slabs, blocks, sectors, random blocks, and random cells."""
    rng = np.random.default_rng(seed)
    low, high = np.reshape(grid.bounds, (3, 2)).T
    share = np.clip((grid.cell_centers().points - low) / (high - low), 0, 1 - 1e-9)
    blocks = (share * [3, 2, 2]).astype(int) @ [4, 2, 1]
    angle = np.arctan2(*(share[:, :2] - 0.5).T)
    return {
        "slabs": (share[:, 2] * 12).astype(int),
        "blocks": blocks,
        "sectors": ((angle / np.pi + 1) * 5.999).astype(int),
        "random blocks": rng.integers(0, 12, (4, 4, 4))[tuple((share * 4).astype(int).T)],
        "random cells": rng.integers(0, 12, grid.n_cells),
    }


def assert_as_whole(lit, whole, limit=1e-6):
    """Assert that each point of the pieces has the light of the whole, and no cell is missing."""
    where = {tuple(p): i for i, p in enumerate(np.asarray(whole.points, dtype=np.float64).tolist())}
    cells = nowhere = 0
    for path in lit.files:
        part = pv.read(path)
        rows = np.flatnonzero(np.isfinite(part.points).all(axis=1))
        at = [where[tuple(p)] for p in np.asarray(part.points[rows], dtype=np.float64).tolist()]
        np.testing.assert_allclose(part["luminance"][rows], whole["luminance"][at], atol=limit)
        assert not set(part.cell_data) & {"vizlight_ghost", "vtkGhostType"}
        cells += part.n_cells
        nowhere += part.n_points - len(rows)
    assert cells == whole.n_cells == lit.cells
    assert (nowhere > 0) == (not np.isfinite(whole.points).all())


def assert_alike(folder, whole, labels, view, **options):
    """Assert that a mesh in pieces by labels of its cells is lit as the whole."""
    scene = Scene(lights=SCENE.lights, view=view)
    suffix = "vtp" if isinstance(whole, pv.PolyData) else "vtu"
    files = cut(whole, folder, labels % MOST, suffix)
    lit = pieces.light(files, scene, out=folder / f"lit.p{suffix}", **options)
    assert_as_whole(lit, vizlight.illuminate(whole, scene, **options))


def test_arrays_of_the_user_with_names_of_vtk_are_kept(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ball = pv.Sphere()
    ball["vtkOriginalPointIds"] = np.asarray(ball.points)[:, 0]
    half = np.arange(ball.n_cells) < ball.n_cells // 2
    for i, which in enumerate((half, ~half)):
        ball.remove_cells(~which, pass_point_ids=False).save(f"half{i}.vtp")
    for path in pieces.light("half*.vtp", PLAIN).files:
        part = pv.read(path)
        np.testing.assert_array_equal(part["vtkOriginalPointIds"], np.asarray(part.points)[:, 0])


@pytest.mark.slow
@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("kind", "options"),
    [
        ("slabs", {}),
        ("blocks", {"normals": "gradient"}),
        ("sectors", {"tangents": "V", "conditioned": True}),
        ("random blocks", {}),
        ("random cells", {"normals": "gradient"}),
    ],
    ids=str,
)
def test_an_isosurface_in_12_pieces_is_lit_as_the_whole(image, tmp_path, light, kind, options):
    grid = image.cast_to_unstructured_grid()
    files = cut(grid, tmp_path, cuts(grid, 3)[kind], "vtu")
    lit = light(files, contour="s", level=LEVEL, **options)
    if "normals" in options:
        grid = grid.compute_derivative(scalars="s", gradient="gradient")
    whole = grid.contour([LEVEL], scalars="s")
    # The ends of the depth cue are found for pieces as for the whole.
    assert_as_whole(lit, vizlight.illuminate(whole, SCENE, **options))


def sheet(z):
    """Return a wavy height field about a height, small beside a ball."""
    x, y = np.meshgrid(np.linspace(-1, 1, 24), np.linspace(-1, 1, 20))
    return pv.StructuredGrid(x, y, z + 0.3 * np.sin(3 * x) * np.cos(2 * y))


def hollow():
    """Return cells that fill a ball but for a cavity."""
    grid = pv.ImageData(dimensions=(10, 10, 10), origin=(-4.5, -4.5, -4.5))
    away = np.linalg.norm(grid.cell_centers().points, axis=1)
    return grid.extract_cells(np.flatnonzero((away > 1.8) & (away < 4.6)))


def surface(kind):
    """Return a surface of one part or several, open and closed, wound outward or not."""
    ball = pv.Sphere(theta_resolution=24, phi_resolution=24)
    height = sheet(3).extract_surface(algorithm="geometry").triangulate()
    beside = [ball.translate((3, 0, 0)).flip_faces(), height.translate((3, 0, 0))]
    made = {
        "ball": lambda: ball,
        "sheet": lambda: height,
        "bowl": lambda: ball.clip("z", origin=(0, 0, 0.1), invert=False),
        "nearly closed": lambda: ball.clip("z", origin=(0, 0, 0.4)),
        "several": lambda: pv.merge([ball, height, *beside]),
        "solid": lambda: pv.ImageData(dimensions=(7, 6, 5)).cast_to_unstructured_grid(),
        "hollow": hollow,
    }[kind]()
    if kind not in ("solid", "hollow"):
        made = made.extract_surface(algorithm="geometry")
    made.clear_data()
    return made


@pytest.mark.sampled(4)
@pytest.mark.filterwarnings("ignore:.* of the edges are sharper")  # of the box, as a whole too
@pytest.mark.parametrize(
    "kind", ["ball", "sheet", "bowl", "nearly closed", "several", "solid", "hollow"]
)
@pytest.mark.parametrize("view", [SCENE.view, View(direction=(0.2, 0.1, -1)), None], ids=str)
def test_a_surface_in_pieces_has_the_sides_of_the_whole(tmp_path, kind, view):
    whole = surface(kind)
    label = {"sheet": "sectors", "several": "sectors", "hollow": "blocks"}.get(kind, "random cells")
    assert_alike(tmp_path, whole, cuts(whole, 5)[label], view)


def normals(mesh, sign=1):
    """Give a mesh normals that may look inward, by name; return their option."""
    made = mesh.compute_normals(split_vertices=False, cell_normals=False)
    mesh["N"] = sign * np.asarray(made.point_data["Normals"])
    return {"normals": "N"}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("kind", ["ball", "sheet", "apart"])
def test_given_normals_in_pieces_have_the_sides_of_the_whole(tmp_path, kind, sign):
    whole = surface("sheet" if kind == "apart" else kind)
    labels = cuts(whole, 5)["sectors"]
    if kind == "apart":
        whole = pv.merge([whole, surface("ball").translate((6, 0, 0))])
        labels = whole.cell_centers().points[:, 0] > 3
    options = normals(whole, sign)
    assert_alike(tmp_path, whole, labels, View(direction=(0.3, 0.2, sign)), **options)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("axis", ["z", "y", "oblique"])
def test_nearly_half_a_ball_in_pieces_is_a_height_field_as_the_whole(tmp_path, axis):
    """Also where it lies in one piece, beside another with a ball."""
    ball = pv.Sphere(theta_resolution=30, phi_resolution=25)
    for i, place in enumerate((-0.04, 0.02, 0.06, 0.075, 0.1)):
        if axis == "oblique":
            turned = ball.rotate_vector((1, 2, 3), 40)
            part = turned.clip((0.3, 0.5, 0.8), origin=(0, 0, place), invert=False)
            part = pv.merge([surface("ball").translate((4, 0, 0)), part.triangulate()])
        else:
            part = ball.clip(axis, origin=(place,) * 3, invert=False).triangulate()
        whole = part.extract_surface(algorithm="geometry")
        whole.clear_data()
        labels = np.arange(whole.n_cells) % 7 == 0
        if axis == "oblique":
            labels = whole.cell_centers().points[:, 0] > 2
        assert_alike(tmp_path / str(i), whole, labels, View(direction=(0.9, 0.3, -0.2)))


def test_normals_of_a_piece_are_computed_once_and_its_neighbours_read_once(
    tmp_path, light, monkeypatch
):
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12)
    ball.clear_data()
    folder = tmp_path / "ball"
    cut(ball, folder, np.digitize(ball.cell_centers().points[:, 0], [-0.2, 0.2]), "vtp")
    computed, ghosts = [], []
    wound, read = sides.wound_normals, FilePiece.read

    def counted(*args, **kwargs):
        computed.append(args)
        return wound(*args, **kwargs)

    def noted(piece, ghost):
        ghosts.append(ghost)
        return read(piece, ghost)

    for module in (sides, of_normals):
        monkeypatch.setattr(module, "wound_normals", counted)
    monkeypatch.setattr(FilePiece, "read", noted)
    lit = light(str(folder / "*.vtp"), PLAIN, feature_angle=None)
    assert len(computed) == len(lit.files) == 3
    # For its box, for the vote and for its light, of which the vote alone asks for other pieces.
    assert ghosts == [0] * 3 + [1] * 3 + [0] * 3
    assert_as_whole(lit, vizlight.illuminate(ball, PLAIN))


def test_a_piece_of_lines_beside_one_of_faces_is_named(tmp_path, light):
    for name, mesh in (("ball", surface("ball")), ("line", pv.Line(resolution=9))):
        mesh.clear_data()
        mesh["V"] = np.tile([1.0, 0, 0], (mesh.n_points, 1))
        mesh.save(tmp_path / f"{name}.vtp")
    with pytest.raises(pieces.PieceError, match=r"line\.vtp: sources: expected faces as in .*ball"):
        light(f"{tmp_path}/*.vtp")
    assert len(light(f"{tmp_path}/*.vtp", tangents="V").files) == 2


def test_points_at_no_place_are_no_neighbours_of_any(tmp_path, light):
    whole = surface("ball")
    whole.points[[3, 40, 200]] = np.nan
    files = cut(whole, tmp_path, np.arange(whole.n_cells) % 4, "vtp")
    with pytest.warns(UserWarning, match="could not be lit"):
        lit = light(files)
    with pytest.warns(UserWarning, match="could not be lit"):
        assert_as_whole(lit, vizlight.illuminate(whole, SCENE))


@pytest.mark.slow
def test_a_sheet_in_slabs_is_lit_as_the_whole(tmp_path):
    """Points of borders count once, also where it is seen from the edge."""
    whole = sheet(0)
    whole.save(tmp_path / "sheet.vts")
    for view in (
        (0.2, 0.1, 1),
        (0.2, 0.1, -1),
        *((1, 0.3, z) for z in np.linspace(-0.03, 0.03, 7)),
    ):
        scene = Scene(view=View(direction=view))
        lit = pieces.light(tmp_path / "sheet.vts", scene, slab=0.002, out=tmp_path / "lit.pvts")
        assert len(lit.files) > 2
        assert_as_whole(lit, vizlight.illuminate(whole, scene))


def corners(mesh):
    """Return the light at the corners of each triangle, by the places of both."""
    places = np.asarray(mesh.points)[mesh.regular_faces]
    light = mesh["luminance"][mesh.regular_faces]
    keys = np.concatenate([np.repeat(places.mean(axis=1), 3, axis=0), places.reshape(-1, 3)], 1)
    return dict(zip(map(tuple, np.round(keys, 5).tolist()), light.ravel(), strict=True))


def test_names_with_dots_keep_the_pieces_apart(stored, tmp_path, light):
    plain, dotted = (
        vizlight.read(light(stored, contour="s", level=LEVEL, slab=0.05, out=out).path)
        for out in ("a.pvtp", "b.0.5.pvtp")
    )
    assert len(list((tmp_path / "b.0.5").iterdir())) > 1
    np.testing.assert_array_equal(dotted.points, plain.points)


@pytest.mark.parametrize("angle", [30, "auto"])
def test_creases_in_pieces_are_lit_as_the_whole(tmp_path, light, angle):
    box = pv.Cube(center=(0.01, 0, 0)).triangulate().subdivide(3).clean()
    box.clear_data()
    files = cut(box, tmp_path, np.random.default_rng(0).integers(0, 4, box.n_cells), "vtp")
    lit = light(files, feature_angle=angle)
    whole = corners(vizlight.illuminate(box, SCENE, feature_angle=angle))
    found = {}
    for path in lit.files:
        found |= corners(pv.read(path))
    assert found.keys() == whole.keys()
    assert max(abs(found[key] - whole[key]) for key in whole) < 1e-6


@pytest.mark.slow
def test_pieces_that_were_lit_are_lit_again_joined_or_not(balls):
    lit = run(balls)
    again = pieces.light(lit.path, SCENE, out=balls / "again.pvtp", feature_angle=80)
    assert again.points == lit.points
    joined = vizlight.read(lit.path)
    for mesh in (joined, joined.clean(), pv.merge([pv.read(path) for path in lit.files])):
        relit = vizlight.illuminate(mesh, SCENE)
        other = vizlight.illuminate(mesh, SCENE, name="other")
        np.testing.assert_array_equal(relit["luminance"], other["other"])
    own = pv.Sphere()
    own["luminance"] = np.zeros(own.n_points)
    with pytest.raises(ValueError, match="name: expected one under which the mesh has no array"):
        vizlight.illuminate(own, SCENE)


def test_every_piece_has_the_mask_and_the_index_is_read_by_vtk(stored, light):
    lit = light(stored, PLAIN, contour="s", level=LEVEL, tangents="V", slab=0.05)
    assert len(lit.files) > 2
    index = lit.path.read_text()
    assert '<PPointData Scalars="luminance">' in index
    assert "<PCellData Scalars" not in index
    whole = vizlight.read(lit.path)
    assert whole.n_points < lit.points  # those along the seams are one
    assert whole.n_cells == lit.cells
    assert whole["luminance_valid"].all()
    assert lit.ranges["luminance"] == (whole["luminance"].min(), whole["luminance"].max())
    np.testing.assert_allclose(lit.bounds, whole.bounds)


def sources(image, folder, kind):
    """Return a grid as one kind of source."""
    if kind in ("vti", "vtr", "vts"):
        grid = {
            "vti": image, "vtr": image.cast_to_rectilinear_grid(),
            "vts": image.cast_to_structured_grid(),
        }[kind]  # fmt: skip
        grid.save(folder / f"grid.{kind}")
        return folder / f"grid.{kind}"
    if kind == "vtkhdf":
        if pv.vtk_version_info < (9, 5):
            pytest.skip("VTK 9.4 does not write images in this format")
        from vtkmodules.vtkIOHDF import vtkHDFWriter

        writer = vtkHDFWriter()
        writer.SetInputDataObject(image)
        writer.SetFileName(str(folder / "grid.vtkhdf"))
        writer.Write()
        return folder / "grid.vtkhdf"
    nodes = image.dimensions[::-1]
    s, v = np.asarray(image["s"]).reshape(nodes), np.asarray(image["V"]).reshape(*nodes, 3)
    if kind == "memmap":
        np.save(folder / "s.npy", s)
        np.save(folder / "V.npy", v)
        s, v = (np.load(folder / f"{name}.npy", mmap_mode="r") for name in "sV")
    elif kind == "zarr":
        zarr = pytest.importorskip("zarr")
        s, v = (zarr.array(a, chunks=(5, *a.shape[1:])) for a in (s, v))
    elif kind == "dask":
        array = pytest.importorskip("dask.array")
        s, v = array.from_array(s, chunks=7), array.from_array(v, chunks=7)
    return pieces.Slabs({"s": s, "V": v}, spacing=image.spacing, origin=image.origin)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", ["vti", "vtr", "vts", "vtkhdf", "array", "memmap", "zarr", "dask"])
def test_a_grid_is_lit_slab_by_slab(image, tmp_path, light, kind):
    source = sources(image, tmp_path, kind)
    lit = light(source, contour="s", level=LEVEL, normals="gradient", slab=0.05)
    assert len(lit.files) > 2
    if kind in ("vti", "vtr", "vts"):
        camera = pieces.camera_on(source, (1, 2, 3))
        expected = render.camera_on(image, (1, 2, 3))
        np.testing.assert_allclose(camera.position, expected.position, rtol=1e-5)
    whole = image.compute_derivative(scalars="s", gradient="gradient").contour([LEVEL], scalars="s")
    whole = vizlight.illuminate(whole, lit.scene, normals="gradient")
    assert lit.cells == whole.n_cells
    values = np.concatenate([pv.read(path)["luminance"] for path in lit.files])
    assert set(np.round(values, 5)) <= set(np.round(whole["luminance"], 5)) or kind != "vti"
    ends = values.min(), values.max()
    np.testing.assert_allclose(ends, whole.get_data_range("luminance"), atol=1e-5)


@pytest.mark.parametrize(
    ("kind", "slab"),
    [("vti", 0.05), *((kind, 0.005) for kind in ("vti", "vtkhdf", "memmap", "zarr", "dask"))],
)
def test_a_grid_stays_a_grid(image, tmp_path, light, kind, slab):
    """Also where a slab is less than a layer of cells, and is cut across y too."""
    image = image.extract_subset((0, 20, 0, 17, 0, 3))
    lit = light(sources(image, tmp_path, kind), PLAIN, tangents="V", slab=slab, out="lit.pvti")
    assert len(lit.files) == (1 if slab == 0.05 else 6)
    whole = pv.read(lit.path)
    assert whole.dimensions == image.dimensions
    expected = vizlight.illuminate(image, PLAIN, tangents="V")["luminance"]
    np.testing.assert_array_equal(whole["luminance"], expected)


def test_partitions_of_a_file_and_indices_are_pieces(tmp_path, light):
    from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSet
    from vtkmodules.vtkIOHDF import vtkHDFWriter

    balls = [pv.Sphere(center=(i, 0, 0)).cast_to_unstructured_grid() for i in range(3)]
    parts = vtkPartitionedDataSet()
    for i, ball in enumerate(balls):
        parts.SetPartition(i, ball)
    writer = vtkHDFWriter()
    writer.SetInputDataObject(parts)
    writer.SetFileName(str(tmp_path / "balls.vtkhdf"))
    writer.Write()
    lit = light(tmp_path / "balls.vtkhdf", PLAIN, out="a.pvtu")
    # VTK 9.4 joins the partitions as it reads them.
    count = 3 if pv.vtk_version_info >= (9, 5) else 1
    assert len(lit.files) == count
    again = light(lit.path, PLAIN, out="b.pvtu", name="second")
    assert (again.points, len(again.files)) == (lit.points, count)
    pv.MultiBlock(balls).save(tmp_path / "balls.vtm")
    assert light(tmp_path / "balls.vtm", PLAIN, out="c.pvtu").points == lit.points


def test_streamlines_of_each_piece(stored, light):
    lit = light(stored, PLAIN, filter="streamlines", tangents="V", seeds=5, slab=0.1)
    assert lit.ranges["luminance"][1] > lit.ranges["luminance"][0]


@pytest.fixture
def balls(tmp_path):
    for i in range(4):
        ball = pv.Sphere(center=(0.9 * i, 0, 0))
        ball.clear_data()
        ball.save(tmp_path / f"ball{i}.vtp")
    return tmp_path


def run(folder, source=None, **options):
    source = str(folder / "ball*.vtp") if source is None else source
    options = {"out": folder / "lit.pvtp"} | options
    return pieces.light(source, options.pop("scene", PLAIN), **options)


def digests(lit):
    return [hashlib.sha256(path.read_bytes()).hexdigest() for path in lit.files]


def test_pieces_of_an_earlier_run_go_with_its_index(balls):
    first = run(balls)
    assert (len(first.files), first.empty) == (4, 0)
    (balls / "ball3.vtp").unlink()
    own = balls / "lit" / "lit_0007.vtp"
    own.write_bytes(first.files[0].read_bytes())
    assert len(run(balls, ghost=0).files) == 3
    assert {path.name for path in (balls / "lit").iterdir()} == {
        *(f"lit_000{i}.vtp" for i in range(3)), own.name,
    }  # fmt: skip


def test_a_damaged_piece_is_named_and_an_earlier_result_stays(balls):
    whole = (balls / "ball2.vtp").read_bytes()
    (balls / "ball2.vtp").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(pieces.PieceError, match=r"piece .*ball2\.vtp: "):
        run(balls)
    assert not (balls / "lit.pvtp").exists()
    assert not (balls / "lit").exists()
    (balls / "ball2.vtp").write_bytes(whole)
    first = run(balls)
    mesh = pv.read(balls / "ball3.vtp")
    mesh.points[0] = np.nan
    mesh["V"] = np.zeros((mesh.n_points, 3))
    before = digests(first)
    mesh.save(balls / "ball4.vtp")
    with pytest.raises(pieces.PieceError, match=r"piece .*ball4\.vtp: .*no point array 'V'"):
        run(balls)
    assert digests(first) == before
    assert not list((balls / "lit").glob(".*"))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda ball: ball.cast_to_unstructured_grid(), "the type of PolyData as in .*ball0"),
        (lambda ball: pv.PolyData(np.asarray(ball.points, float), ball.faces), "points of float32"),
        (lambda ball: ball.compute_normals(), "no point array 'Normals' as in .*ball0"),
    ],
)  # fmt: skip
def test_pieces_of_another_kind_are_named(balls, change, message):
    other = change(pv.read(balls / "ball1.vtp"))
    suffix = "vtp" if isinstance(other, pv.PolyData) else "vtu"
    other.save(balls / f"other.{suffix}")
    with pytest.raises(pieces.PieceError, match=rf"piece .*other\.{suffix}: sources: .*{message}"):
        run(balls, [balls / "ball0.vtp", balls / f"other.{suffix}"])


@pytest.mark.parametrize("what", ["grid", "array"])
def test_boxes_of_another_grid_are_named(image, tmp_path, light, what):
    image.save(tmp_path / "a.vti")
    other = image.copy()
    other.origin = (0, 0, 0) if what == "grid" else other.origin
    if what == "array":
        other["W"] = other["s"]
    other.save(tmp_path / "b.vti")
    both = [tmp_path / "a.vti", tmp_path / "b.vti"]
    words = {"grid": "the Origin of", "array": "no point array 'W'"}[what]
    message = rf"piece .*b\.vti\[0:22\]: sources: expected {words}"
    with pytest.raises(pieces.PieceError, match=message):
        light(both, PLAIN, tangents="V", out="lit.pvti")
    assert not (tmp_path / "lit.pvti").exists()
    text = (tmp_path / "a.vti").read_bytes()
    (tmp_path / "none.vti").write_bytes(text.replace(b'"0 20 0 17 0 22"', b'"0 -1 0 -1 0 -1"'))
    with pytest.raises(pieces.PieceError, match=r"expected a grid with nodes, got '.*none\.vti'"):
        light(tmp_path / "none.vti", PLAIN, out="lit.pvti")


def test_sources_are_given_once_and_never_replaced(balls):
    both = [str(balls / "ball*.vtp"), balls / "." / "ball1.vtp"]
    with pytest.raises(pieces.PieceError, match=r"each file once, got '.*ball1\.vtp' twice"):
        run(balls, both)
    first = run(balls)
    before = digests(first)
    for source in (first.path, *first.files):
        with pytest.raises(pieces.PieceError, match="out: expected another name than the sources'"):
            run(balls, source, name="second")
    assert digests(first) == before


def test_a_level_outside_is_told_with_the_range(image, stored, light):
    low, high = image.get_data_range("s")
    words = f"level: expected a value between {low:g} and {high:g}, got 99"
    for work in (pieces.camera_on, light):
        with pytest.raises(pieces.PieceError, match=words):
            work(stored, contour="s", level=99, slab=0.05)
    with pytest.raises(ValueError, match=r"contour: .* one of \['s'\], got 'W'"):
        pieces.camera_on(stored, contour="W")


def test_lines_in_pieces_are_lit_as_the_whole(tmp_path):
    whole = pv.lines_from_points(np.random.default_rng(2).random((20, 3)))
    whole.save(tmp_path / "a.vtp")
    lit = run(tmp_path, tmp_path / "a.vtp")
    expected = vizlight.illuminate(whole, PLAIN)["luminance"]
    np.testing.assert_array_equal(pv.read(lit.files[0])["luminance"], expected)


def test_pieces_without_points_pass_as_parallel_writers_make_them(balls):
    first = run(balls)
    text = first.path.read_text(encoding="utf-8")
    pv.PolyData().save(balls / "empty.vtp")
    lit = run(balls, [balls / "ball0.vtp", balls / "empty.vtp"], out=balls / "two.pvtp")
    assert (len(lit.files), lit.empty) == (1, 0)
    piece = '<Piece Source="empty.vtp" />'
    index = balls / "with_empty.pvtp"
    index.write_text(text.replace("</PPolyData>", piece + "</PPolyData>"), encoding="utf-8")
    assert len(run(balls, index, out=balls / "again.pvtp", name="second").files) == 4
    with pytest.raises(pieces.PieceError, match="sources: expected pieces with points, got none"):
        run(balls, balls / "empty.vtp", out=balls / "none.pvtp")
    (balls / "empty.vtp").unlink()
    with pytest.raises(pieces.PieceError, match=r"with_empty.* names .*empty\.vtp"):
        run(balls, index)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"source": "no/*.vtp"}, r"sources: expected a pattern that files match"),
        ({"source": "no.vtp"}, r"sources: expected a file, got 'no.vtp' \(no such file\)"),
        ({"source": "."}, r"sources: expected a file, got '\.' \(a folder\); name its files, as"),
        ({"source": []}, r"sources: expected at least one piece"),
        ({"source": 3}, r"sources: expected paths"),
        ({"source": [3]}, r"sources: expected a path"),
        ({"source": {"a": 3}}, r"sources: expected paths, patterns"),
        ({"scene": 3}, r"scene: expected"),
        ({"facing": "outward"}, r"facing: expected 'auto', 'eye' or 'as given'"),
        ({"bundle": True}, r"bundle: expected no such option"),
        ({"tangets": "V"}, r"tangets: expected an option of illuminate.*tangents"),
        ({"tangents": np.zeros((3, 3))}, r"tangents: expected the name of a point array"),
        ({"tangents": "W"}, r"piece .*: tangents: expected the name of a point array"),
        ({"contour": "W"}, r"contour: expected a point array"),
        ({"contour": 3}, r"contour: expected the name of a point array"),
        ({"level": 1.0}, r"level: expected contour= beside it"),
        ({"ghost": -1}, r"ghost: expected an integer"),
        ({"contour": "s", "normals": "gradient", "ghost": 0}, r"ghost: expected 1 at least"),
        ({"map": 2}, r"map: expected map, an executor or a client of Dask, got 2"),
        ({"slab": 0}, r"slab: expected a number above 0"),
        ({"retries": -1}, r"retries: expected"),
        ({"filter": "fur"}, r"filter: expected 'illuminate' or 'streamlines'"),
        ({"out": "lit.vtp"}, r"out: expected a name that ends in \.pvtp"),
        ({"out": "no/lit.pvtp"}, r"out: expected a folder that exists"),
        ({"out": "lit.pvtu"}, r"piece .*ball0\.vtp: out: expected a name that ends in \.pvtp"),
    ],
    ids=str,
)
def test_bad_input(balls, options, message):
    with pytest.raises((ValueError, TypeError), match=message):
        run(balls, **options)
    assert {path.suffix for path in balls.iterdir()} == {".vtp"}


test_bad_slabs = refusals(
    lambda arrays, options: pieces.Slabs(arrays, **options),
    ({}, {}, "arrays: expected a dict"),
    ({"a": np.zeros(3)}, {}, r"arrays: expected an array of shape \(nz, ny, nx\)"),
    ({"a": [1]}, {}, r"arrays: expected an array of shape"),
    ({"a": np.zeros((2, 2, 2)), "b": np.zeros((2, 2, 3))}, {}, "arrays: expected one number"),
    ({"a": np.zeros((2, 2, 2))}, {"spacing": (0, 1, 1)}, "spacing: expected a number above 0"),
    ({"a": np.zeros((2, 2, 2))}, {"origin": "x"}, "origin: expected"),
    kind=(ValueError, TypeError),
)
