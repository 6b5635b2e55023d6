"""The outer surface of a mesh: which nodes of curved cells are on it."""

import numpy as np
import pytest
import pyvista as pv
from lamps import far
from vectors import unit
from vtkmodules.vtkFiltersSources import vtkCellTypeSource

import vizlight
from vizlight import Light, Material, Scene, View
from vizlight.vtk import hull, normals


def test_control_points_are_lit_where_their_parameters_are_on_the_surface():
    """A Bezier triangle passes through its corners, and half as high as the points between."""
    points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0.8], [1, 1, 0.8], [0, 1, 0.8]]
    mesh = pv.UnstructuredGrid({pv.CellType.BEZIER_TRIANGLE: np.arange(6)[None]}, np.array(points))
    toward = np.array([1, 2, 6]) / np.sqrt(41)
    scene = far(toward, (0, 0, 1), Material(ambient=0.1, diffuse=0.8, specular=0))
    lit = vizlight.illuminate(mesh, scene)
    assert lit["luminance"][3:].min() > 0.7
    # The flat triangles at the corners rise by 0.4 to the middles of the edges.
    normals = unit(np.array([[-0.4, -0.4, 1], [0.4, 0, 1], [0, 0.4, 1]]))
    np.testing.assert_allclose(lit["luminance"][:3], 0.1 + 0.8 * normals @ toward, rtol=1e-5)


def clouds():
    points = np.random.default_rng(1).normal(size=(20, 3)).astype(np.float32)
    grid = pv.UnstructuredGrid()
    grid.points = points
    return [grid, pv.PointSet(points), pv.PolyData(points)]


@pytest.mark.parametrize("cloud", clouds(), ids=lambda mesh: type(mesh).__name__)
def test_points_without_cells_are_lit_by_vectors_of_their_own(cloud):
    vectors = np.random.default_rng(2).normal(size=(20, 3))
    scene = Scene(lights=Light(direction=(0, 0, 1)), view=View(direction=(0, 0, 1)))
    points = np.asarray(cloud.points)
    lines = vizlight.illuminate(cloud, scene, tangents=vectors)
    expected = vizlight.engine.shade(points, vectors, scene)
    np.testing.assert_array_equal(lines["luminance"], expected.luminance)
    sheets = vizlight.illuminate(cloud, scene, normals=vectors, facing="as given")
    expected = vizlight.engine.shade(points, None, scene, normals=vectors)
    np.testing.assert_array_equal(sheets["luminance"], expected.luminance)
    with pytest.raises(ValueError, match="mesh: expected a surface with faces"):
        vizlight.isoluminance(cloud, scene)
    with pytest.raises(ValueError, match="mesh: expected faces or lines, got points alone"):
        vizlight.refine(cloud, scene, tangents=vectors)


@pytest.mark.parametrize("kind", ["surface", "grid", "image"])
def test_numbers_that_an_earlier_filter_left_are_not_taken_for_ours(kind):
    """VTK leaves a point array of numbers on the surfaces and cells that it takes from a mesh."""
    mesh = {
        "surface": pv.Sphere(theta_resolution=8, phi_resolution=8),
        "grid": pv.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid(),
        "image": pv.ImageData(dimensions=(4, 4, 4)),
    }[kind]
    left = np.arange(mesh.n_points)[::-1].copy()
    mesh["vtkOriginalPointIds"] = left
    surface, origin = hull.outer_surface(mesh)
    surface = pv.wrap(surface)
    np.testing.assert_array_equal(surface.points, np.asarray(mesh.points)[origin])
    np.testing.assert_array_equal(surface["vtkOriginalPointIds"], left[origin])


def curved(u, v, w, to_space, kind=np.float32):
    axes = np.meshgrid(u, v, w, indexing="ij")
    return pv.StructuredGrid(*(x.astype(kind) for x in to_space(*axes)))


def line(n):
    return np.linspace(-1, 1, n)


def circle(n, more=0):
    """Angles around a circle; the last one is the first, as are as many ``more``."""
    angles = np.linspace(0, 2 * np.pi, n)
    return np.concatenate([angles[:-1], angles[: more + 1]])


def sheet():
    mesh = curved(line(30), line(40), [0], lambda u, v, w: (u, v, w + np.sin(3 * u) * v))
    mesh.points[[0, 1, 2, 600]] = np.nan
    return mesh


def stairs():
    return curved(line(30), line(40), [0], lambda u, v, w: (u, v, w + np.floor(1.6 * u + v) / 3))


def ring(more=0, depth=1):
    """A wrapped grid, whose first and last columns coincide."""
    a, r, z = circle(40, more), np.linspace(1, 2, depth), line(20)
    return curved(a, r, z, lambda a, r, z: (r * np.cos(a), r * np.sin(a), z), np.float64)


def ball():
    def to_space(a, b, w):
        sine = np.where(b < 3.1, np.sin(b), 0)
        return sine * np.cos(a), sine * np.sin(a), w + np.cos(b)

    return curved(circle(30), np.linspace(0, np.pi, 20), [0], to_space)


def torus():
    """A grid that overlaps itself along both axes, so that no border is free."""

    def to_space(a, b, w):
        return (2 + np.cos(b)) * np.cos(a), (2 + np.cos(b)) * np.sin(a), w + np.sin(b)

    return curved(circle(30, 1), circle(20, 1), [0], to_space)


def slit():
    """A sheet one border of which is folded onto itself."""
    return curved(line(41), line(20), [0], lambda u, v, w: (np.abs(u) + v + w, u * (v + 1), v))


GRIDS = {
    "sheet": (sheet, True),
    "stairs": (stairs, True),
    "ring": (ring, True),
    "overlapping ring": (lambda: ring(more=1), True),
    "slit": (slit, True),
    "overlapping torus": (torus, False),
    "ball": (ball, False),
    "thick ring": (lambda: ring(depth=3), False),
    "box": (lambda: curved(line(9), line(8), line(12), lambda u, v, w: (u, v + u * w, w)), False),
    "slab": (lambda: pv.ImageData(dimensions=(40, 2, 30), spacing=(1, 2, 3)), False),
    "image": (lambda: pv.ImageData(dimensions=(1, 40, 30), origin=(5e5, 4e6, 0)), True),
    "rectilinear": (lambda: pv.RectilinearGrid(line(30) ** 3, [2.0], line(20)), True),
}


@pytest.fixture
def small_parts(monkeypatch):
    def apply(part=50):
        monkeypatch.setattr(hull, "PART", part)
        monkeypatch.setattr(hull, "FEW", 0)

    return apply


@pytest.mark.sampled(5)
@pytest.mark.parametrize("name", GRIDS)
@pytest.mark.parametrize(
    "view", [None, View(direction=(1, 2, 3)), View(position=(2, 3, -4))], ids=["", "far", "near"]
)
def test_parts_give_the_normals_of_the_whole(name, view, small_parts):
    make, is_open = GRIDS[name]
    mesh = make()
    assert not hull.in_parts(mesh)
    whole = normals.computed_normals(mesh, view=view)
    small_parts()
    assert hull.in_parts(mesh)
    assert len(list(hull.parts(mesh))) > 5
    found = normals.computed_normals(mesh, view=view)
    np.testing.assert_array_equal(found.vectors, whole.vectors)
    np.testing.assert_array_equal(found.lean, whole.lean)
    assert (found.sharp, found.inside) == (whole.sharp, int(whole.inside))
    assert (found.open > 0) is is_open
    assert np.any(whole.open) == is_open


@pytest.mark.parametrize("name", GRIDS)
def test_parts_give_given_normals_the_sides_of_the_whole(name, small_parts):
    mesh = GRIDS[name][0]()
    given = (np.asarray(mesh.points) - mesh.center) @ np.array([[1, 0, 0], [0, 1, 0], [0.1, 0, 1]])
    for own in (given, -given):
        grids_read = []
        for part in (10_000, 50):
            small_parts(part)
            grids_read.append(normals.sided_normals(mesh, own, 3, "auto"))
        whole, found = grids_read
        np.testing.assert_array_equal(found.vectors, whole.vectors)
        np.testing.assert_array_equal(np.broadcast_to(found.open, len(own)), whole.open)
        np.testing.assert_allclose(found.facts(), whole.facts(), atol=1e-6)


def test_a_part_has_the_faces_around_its_own_points():
    mesh = pv.ImageData(dimensions=(200, 300, 1))
    own = [part.origin[part.side == 0] for part in hull.parts(mesh)]
    assert len(own) > 2
    np.testing.assert_array_equal(np.sort(np.concatenate(own)), np.arange(mesh.n_points))
    assert all(part.surface.GetNumberOfPoints() < 1.2 * hull.PART for part in hull.parts(mesh))


def test_hidden_cells_and_thick_grids_are_read_as_a_whole():
    mesh = pv.ImageData(dimensions=(200, 300, 1))
    assert hull.in_parts(mesh)
    assert not hull.in_parts(pv.ImageData(dimensions=(60_000, 1, 1)))
    assert not hull.in_parts(pv.ImageData(dimensions=(110, 110, 110)))
    mesh.cell_data["vtkGhostType"] = np.zeros(mesh.n_cells, np.uint8)
    assert not hull.in_parts(mesh)


@pytest.mark.parametrize("flip", [False, True])
def test_walls_of_solid_cells_are_there_once_with_their_data(flip):
    solid = pv.ImageData(dimensions=(3, 4, 2)).cast_to_unstructured_grid()
    outside = solid.extract_surface(algorithm="dataset_surface")
    walls = outside.extract_cells(range(7)).extract_surface(algorithm="dataset_surface")
    walls = walls.flip_faces() if flip else walls
    solid.clear_data(), walls.clear_data()
    solid["ref"], walls["ref"] = np.zeros(solid.n_cells, int), np.arange(1, 8)
    lines = pv.Line((0, 0, 0), (1, 0, 0))
    lines["ref"] = [9]
    surface, _ = hull.outer_surface(pv.merge([lines, walls, solid]))
    found = pv.PolyData(surface)
    assert (found.n_lines, found.GetNumberOfPolys()) == (1, outside.n_cells)
    assert found.n_open_edges == 0
    assert sorted(found["ref"]) == [0] * (outside.n_cells - 7) + [*range(1, 8), 9]
    # All face outward, those of the walls too.
    assert pv.PolyData(found.points, found.faces).volume == pytest.approx(6)


def test_curved_walls_of_curved_solid_cells_are_there_once():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    points = np.concatenate([corners, [corners[list(edge)].mean(axis=0) for edge in edges]])
    cells = [10, *range(10), 6, 0, 1, 2, 4, 5, 6]
    grid = pv.UnstructuredGrid(cells, [24, 22], points)
    grid["ref"] = [1, 2]
    found = pv.PolyData(hull.outer_surface(grid)[0])
    assert found.n_cells == 16
    assert found.is_manifold
    assert sorted(found["ref"]) == [1] * 12 + [2] * 4
    assert found.volume == pytest.approx(1 / 6)


@pytest.mark.parametrize("kind", [24, 25, 26, 27, 29])
def test_the_faces_of_curved_cells_share_their_points_and_face_outward(kind):
    source = vtkCellTypeSource()
    source.SetCellType(kind)
    source.SetBlocksDimensions(2, 2, 2)
    source.Update()
    grid = source.GetOutput()
    surface, ids = hull.outer_surface(grid)
    found = pv.PolyData(surface)
    assert len(np.unique(ids)) == len(ids) == found.n_points
    np.testing.assert_array_equal(found.points, pv.wrap(grid).points[ids])
    middles = found.cell_centers().points - np.asarray(found.center)
    # Faces between cells of which VTK finds the two different do not count.
    outer = np.isclose(np.abs(middles).max(axis=1), np.abs(middles).max())
    assert outer.sum() > 20
    faces = found.regular_faces
    a, b, c = found.points[faces.T]
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), middles)
    assert (outward[outer] > 0).all()


@pytest.mark.parametrize(("kind", "polygons"), [(12, 24), (22, 0), (21, 0)])
def test_curved_cells_beside_others_face_outward_and_keep_the_active_array(kind, polygons):
    grids = []
    for each, step in ((24, 0.0), (kind, 5.0)):
        source = vtkCellTypeSource()
        source.SetCellType(each)
        source.SetBlocksDimensions(2, 2, 2)
        source.Update()
        grids.append(pv.wrap(source.GetOutput()).translate((step, 0, 0)))
    grid = grids[0].merge(grids[1], merge_points=False)
    grid["v"] = np.arange(grid.n_points, dtype=float)
    grid.set_active_scalars("v")
    surface, ids = hull.outer_surface(grid)
    found = pv.PolyData(surface)
    assert found.active_scalars_name == "v"
    np.testing.assert_array_equal(found["v"], ids)
    sizes = [len(found.get_cell(i).point_ids) for i in range(found.n_cells)]
    assert sizes.count(4) == polygons
    # The curved cells fill a cube, whose middle is one away from its faces.
    outward = []
    for i in range(found.n_cells):
        corners = found.get_cell(i).points
        middle = corners.mean(axis=0) - 1
        if corners[:, 0].max() <= 2 and np.isclose(np.abs(middle).max(), 1):
            across = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            outward.append(np.dot(across, middle) > 0)
    assert len(outward) > 20
    assert all(outward)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("block", [160, 1500, 1 << 20])
def test_the_surface_of_many_cells_is_found_by_blocks(block, monkeypatch):
    monkeypatch.setattr(hull, "BLOCK", block)
    image = pv.ImageData(dimensions=(7, 9, 8))
    order = np.random.default_rng(0).permutation(image.n_cells)
    hexahedra, tetrahedra = image.cast_to_unstructured_grid(), image.to_tetrahedra(5)
    for grid in (hexahedra, tetrahedra, hexahedra.merge(tetrahedra.translate((6, 0, 0)))):
        for mesh in (grid, grid.extract_cells(order)):
            mesh["v"] = np.arange(mesh.n_points)
            mesh.point_data["n"] = np.asarray(mesh.points)
            mesh.point_data.active_normals_name = "n"
            found, whole = (
                {tuple(origin[face]) for face in pv.wrap(surface).irregular_faces}
                for surface, origin, *_ in (hull.outer_faces(mesh), hull.outer_surface(mesh))
            )
            # The first corner counts: quadrilaterals are halved from it.
            assert found == whole
            mesh.cell_data["c"] = np.arange(mesh.n_cells)
            surface, origin, cells = hull.outer_faces(mesh)
            np.testing.assert_array_equal(pv.wrap(surface).cell_data["c"], cells)
            for face, cell in zip(pv.wrap(surface).irregular_faces, cells, strict=True):
                assert set(origin[face]) <= set(mesh.get_cell(int(cell)).point_ids)
            surface = pv.wrap(surface)
            np.testing.assert_array_equal(surface["v"], origin)
            np.testing.assert_array_equal(surface.points, mesh.points[origin])
            assert surface.point_data.active_normals_name == "n"


def polyhedra(grid, chosen):
    """Return hexahedra, some of them as polyhedra."""
    voxels = grid.cells.reshape(-1, 9)[:, 1:]
    sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
    cells, kinds = [], []
    for voxel, is_chosen in zip(voxels, chosen, strict=True):
        faces = [[4, *voxel[side]] for side in sides]
        cells += [31, 6, *np.ravel(faces)] if is_chosen else [8, *voxel]
        kinds.append(42 if is_chosen else 11)
    return pv.UnstructuredGrid(np.array(cells), np.array(kinds, np.uint8), grid.points)


def solids_with_walls():
    random = np.random.default_rng(4)
    grid = pv.ImageData(dimensions=(5, 6, 5)).cast_to_unstructured_grid()
    # Two layers of walls, one of them outside.
    plane = pv.ImageData(dimensions=(5, 6, 1)).cast_to_unstructured_grid()
    inside = plane.translate((0, 0, 2)).extract_cells(range(3, 17))
    line = pv.Line((0, 0, 0), (0, 0, 4)).cast_to_unstructured_grid()
    mixed = pv.merge([plane, line, polyhedra(grid, random.random(grid.n_cells) < 0.5), inside])
    mixed.clear_data()
    # The last point is inside.
    step = grid.n_points - 1 - grid.find_closest_point((2, 2, 2))
    voxels = (grid.cells.reshape(-1, 9)[:, 1:] + step) % grid.n_points
    rolled = pv.UnstructuredGrid({pv.CellType.VOXEL: voxels}, np.roll(grid.points, step, axis=0))
    return {
        "rolled": rolled,
        "polyhedra": polyhedra(grid, np.ones(grid.n_cells, np.bool_)),
        "walls": mixed,
        "order": mixed.extract_cells(random.permutation(mixed.n_cells)),
    }


SOLIDS = solids_with_walls()


@pytest.mark.parametrize("marked", ["", "cells", "points", "a whole block"])
@pytest.mark.parametrize("name", SOLIDS)
def test_blocks_of_marked_cells_walls_and_polyhedra_have_the_surface_of_the_whole(
    name, marked, monkeypatch
):
    mesh, random = SOLIDS[name].copy(), np.random.default_rng(1)
    mesh.clear_data()
    if marked == "points":
        mesh.point_data["vtkGhostType"] = random.choice([0] * 20 + [1, 2, 3], mesh.n_points)
    elif marked:
        of_cells = random.choice([0] * 9 + [1, 2, 4, 8, 32, 33, 41], mesh.n_cells)
        of_cells[:30] = 32 if marked == "a whole block" else of_cells[:30]
        mesh.cell_data["vtkGhostType"] = of_cells
    for data in (mesh.point_data, mesh.cell_data):
        if "vtkGhostType" in data:
            data["vtkGhostType"] = data["vtkGhostType"].astype(np.uint8)
    mesh.cell_data["c"] = np.arange(mesh.n_cells)
    found = []
    for block in (1 << 20, 150):
        monkeypatch.setattr(hull, "BLOCK", block)
        surface, origin, cells = hull.outer_faces(mesh)
        surface = pv.wrap(surface)
        first = surface.n_verts + surface.n_lines
        faces = [tuple(origin[face]) for face in surface.irregular_faces]
        np.testing.assert_array_equal(surface["c"], cells)
        np.testing.assert_array_equal(surface.points, mesh.points[origin])
        found.append(sorted(zip(faces, cells[first:], strict=True)))
    assert len(found[0]) > 20
    assert found[0] == found[1]


def test_strips_beside_solid_cells_stay_on_their_surface(monkeypatch):
    monkeypatch.setattr(hull, "BLOCK", 150)
    grid = pv.ImageData(dimensions=(5, 6, 5)).cast_to_unstructured_grid()
    strip = pv.UnstructuredGrid([4, 0, 1, 2, 3], [6], grid.points[:4])
    surface = pv.wrap(hull.outer_faces(grid.merge(strip))[0])
    assert surface.n_strips == 1
    assert surface.GetNumberOfPolys() == 2 * (4 * 5 + 5 * 4 + 4 * 4)


@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 2, 0), (2, 0, 1)])
def test_curved_faces_are_cut_along_their_curve(axes):
    """No edge of a bent brick spans more of its angle than two neighbouring nodes do."""
    cell = pv.UnstructuredGrid(
        np.append(20, np.arange(20)), [pv.CellType.QUADRATIC_HEXAHEDRON], np.zeros((20, 3))
    ).GetCell(0)
    radius, turn, height = np.reshape(cell.GetParametricCoords(), (20, 3))[:, axes].T
    radius, turn = 1 + radius, np.radians(60) * turn
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    mesh = pv.UnstructuredGrid(
        np.append(20, np.arange(20)), [pv.CellType.QUADRATIC_HEXAHEDRON], points
    )
    surface, origin = hull.outer_surface(mesh)
    faces = origin[pv.wrap(surface).regular_faces]
    assert len(faces) == 36
    outer = faces[np.all(radius[faces] == 2, axis=1)]
    assert len(outer) == 6
    for start, end in ((0, 1), (1, 2), (2, 0)):
        middles = points[outer[:, start]] / 2 + points[outer[:, end]] / 2
        assert np.hypot(*middles[:, :2].T).min() > 2 * np.cos(np.radians(15)) - 1e-9
    # The area of each side is that of its flat triangles, seen from outside.
    assert pv.wrap(surface).volume == pytest.approx(1.5 * 2 * np.sin(np.radians(30)))
