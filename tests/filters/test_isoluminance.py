"""Bands on meshes and solids: right, closed, the input untouched; errors that say what to do."""

import banded
import numpy as np
import pytest
import pyvista as pv
from lamps import far, shiny
from refusals import refusals
from scipy.spatial import cKDTree
from vectors import unit

import vizlight
from studies import fur
from vizlight import Block, Frustum, Light, Material, Scene, Sphere, View, isoluminance, render
from vizlight.geometry.contours import banding

TOWARD, EYE = unit([(1.0, -0.6, 0.8), (0.2, -1, 0.5)])
DULL = Scene(lights=Light(direction=TOWARD), material=shiny(diffuse=0.8, specular=0))
SHINY = far(TOWARD, EYE, Material(ambient=0.1, diffuse=0.5, specular=0.4, shininess=20))


def polygons(mesh):
    """Return bands as the helpers of other tests take them."""
    cells = mesh.GetPolys()
    offsets, corners = cells.GetOffsetsArray(), cells.GetConnectivityArray()
    return banding.Bands(
        np.asarray(mesh.points, dtype=float), pv.convert_array(offsets), pv.convert_array(corners),
        mesh["band"], mesh["luminance"], None, None, None, None, 0,
    )  # fmt: skip


def exact(normals, power=20):
    """The same scene for SHINY, written again: ambient, Lambert, Phong."""
    cosine = normals @ TOWARD
    mirror = np.maximum(2 * cosine * (normals @ EYE) - TOWARD @ EYE, 0)
    return 0.1 + np.where(cosine > 0, 0.5 * cosine + 0.4 * mirror**power, 0)


@pytest.mark.parametrize("levels", [8, 0.02, [0.2, 0.4, 0.6, 0.8]])
def test_a_shiny_sphere_is_right_everywhere(levels, random, claim):
    center, radius = random.uniform(-3, 3, 3), random.uniform(0.5, 4)
    sphere = isoluminance(Sphere(tuple(center), radius), SHINY, levels=levels)
    bands = sphere["bands"]
    assert bands.is_manifold
    place, polygon = banded.places(polygons(bands), random, 4)
    normal = unit(place - center)
    error = np.abs(exact(normal) - bands["luminance"][polygon])
    claimed = bands.field_data["luminance_error"][0]
    claim(np.quantile(error, 0.999), 1.1 * claimed)
    if isinstance(levels, float):
        assert claimed <= levels
    assert sphere["contours"].n_lines > 50


def test_closed_forms_and_halved_edges_agree():
    """A dull sphere and truncus have closed forms; with the least highlight they do not."""
    nearly = DULL.replace(material=shiny(diffuse=0.8, specular=1e-12), view=View(direction=EYE))
    levels = [0.2, 0.4, 0.6, 0.8]
    for solid in (Sphere(), Frustum(radii=(0.2, 0.6)), Frustum(radii=(0, 0.6))):
        closed, general = (isoluminance(solid, scene, levels=levels) for scene in (DULL, nearly))
        for level in levels:
            lengths = []
            for found in (closed, general):
                on = found["contours"]["luminance"] == level
                lines = found["contours"].extract_cells(np.flatnonzero(on))
                lengths.append(lines.compute_cell_sizes()["Length"].sum())
            assert lengths[0] == pytest.approx(lengths[1], rel=2e-2, abs=1e-9)


@pytest.mark.parametrize("model", ["phong", "blinn"])
def test_a_highlight_on_a_cylinder(model, random):
    """Far light and eye: the highlight's contours are rulings, by either law."""
    scene = SHINY.replace(material=Material(ambient=0.1, diffuse=0, specular=0.9, shininess=12))
    axis = unit(np.cross(TOWARD, EYE))
    found = isoluminance(Frustum(axis=axis), scene, levels=[0.3, 0.6], model=model)
    lines, bands = found["contours"], found["bands"]
    along = np.asarray(lines.points, float) @ axis
    normal = unit(lines.points - np.outer(along, axis))
    half = unit(TOWARD + EYE)
    mirror = 2 * (normal @ TOWARD) * (normal @ EYE) - TOWARD @ EYE
    value = 0.1 + 0.9 * np.maximum(mirror if model == "phong" else normal @ half, 0) ** 12
    start, stop = lines.lines.reshape(-1, 3)[:, 1:].T
    ruling = np.abs(along[start] - along[stop]) > 1e-3
    miss = np.abs(value[start] - lines["luminance"])[ruling & (lines["luminance"] > 0.1)]
    assert len(miss) >= 4
    assert miss.max() < 1e-6
    assert bands.is_manifold


def test_solids_with_several_lights(random):
    lights = [
        Light(direction=TOWARD, intensity=0.6), Light(position=(-3, 1, 2), intensity=0.5),
    ]  # fmt: skip
    scene = Scene(lights=lights, material=Material(ambient=0.05, diffuse=0.9, specular=0))
    found = isoluminance(Sphere(), scene, levels=10)["bands"]
    place, polygon = banded.places(polygons(found), random, 4)
    normal = unit(place)
    near = np.einsum("ij,ij->i", normal, unit(np.array([-3, 1, 2]) - normal))
    far = normal @ TOWARD
    expected = 0.05 + 0.9 * (0.6 * np.maximum(far, 0) + 0.5 * np.maximum(near, 0))
    error = np.abs(expected - found["luminance"][polygon])
    assert np.quantile(error, 0.999) <= 1.1 * found.field_data["luminance_error"][0]


def test_a_sharp_highlight_is_not_missed():
    """It is far smaller than the triangles that the search begins with."""
    scene = SHINY.replace(material=shiny(diffuse=0.5, specular=0.4, shininess=3000))
    found = isoluminance(Sphere(), scene, levels=8)["bands"]
    peak = np.max(exact(np.asarray(found.points), 3000))
    half = unit(TOWARD + EYE)
    assert exact(half[None], 3000)[0] - found["luminance"].max() < 0.08
    assert peak > 0.8


def test_a_machined_part():
    part = Frustum((0, 0, 0), (0, 0, 0.4), (1, 1)) | Block((0, 0, 0.4), (0.6, 0.6, 0.6))
    part = part - Frustum((0, 0, 0.3), (0, 0, 3), (0.2, 0.2))
    found = isoluminance(part, SHINY, levels=8, tolerance=5e-3)
    bands = found["bands"]
    assert bands.is_manifold
    expected = 0.4 * np.pi + 0.5 * 0.36 - np.pi * 0.04 * 0.9
    assert bands.triangulate().volume == pytest.approx(expected, rel=5e-3)
    assert len(np.unique(bands["patch"])) >= 8
    told = vizlight.provenance(bands)
    assert told["filter"] == "isoluminance"
    assert told["options"]["levels"] == 8


def sphere_mesh(n, radius=1.0):
    mesh = pv.Sphere(radius=radius, theta_resolution=n, phi_resolution=n + 1)
    mesh["Normals"] = np.asarray(mesh.points) / radius
    mesh.point_data.active_normals_name = "Normals"
    mesh["V"] = np.cross(mesh["Normals"], [0.3, 0.1, 1.0]) + np.array([1e-3, 0, 0])
    return mesh


def test_the_error_on_a_mesh_falls_with_subdivision():
    """Contour points on chords: second order in the edges, the terminator included."""
    worst = []
    for n in (32, 64, 128):
        lines = isoluminance(fur.torus(n), DULL, levels=6)["contours"]
        points = np.asarray(lines.points, float)
        normal = unit(points - 1.5 * unit(points * [1, 1, 0]))
        ends = lines.lines.reshape(-1, 3)[:, 1:]
        expected = 0.1 + 0.8 * np.maximum(normal[ends[:, 0]] @ TOWARD, 0)
        worst.append(np.sqrt(np.mean((expected - lines["luminance"]) ** 2)))
    order = np.log2(np.array(worst[:-1]) / worst[1:])
    np.testing.assert_allclose(order, 2, atol=0.2)
    # A ball's normals, interpolated and made unit, are exact: so are its contours.
    lines = isoluminance(sphere_mesh(24), DULL, levels=6)["contours"]
    normal = unit(np.asarray(lines.points, float))
    expected = 0.1 + 0.8 * np.maximum(normal[lines.lines[1::3]] @ TOWARD, 0)
    assert np.abs(expected - lines["luminance"]).max() < 1e-7


def test_both_sides_of_an_open_surface_face_the_eye():
    """Inside and outside of a bowl: each place has the light of the filter, to a step."""
    bowl = sphere_mesh(60).clip("z", origin=(0, 0, 0.2)).clean()
    bowl.point_data.clear()
    view = View(direction=(1, 0.2, 0.9))
    scene = Scene(view=view)
    found = isoluminance(bowl, scene, levels=10)["bands"]
    lit = vizlight.illuminate(bowl, scene)
    middle = found.cell_centers().points
    nearest = cKDTree(lit.points).query(middle)[1]
    off = np.abs(found.cell_data["luminance"] - lit["luminance"][nearest])
    area = found.compute_cell_sizes(length=False, volume=False)["Area"]
    inside = np.einsum("ij,j->i", middle, view.direction) < 0
    assert 0.2 < area[inside].sum() / area.sum() < 0.8
    assert (area * (off < 0.15)).sum() > 0.95 * area.sum()


def test_coarse_meshes_keep_the_allowed_error(random):
    """Triangles larger than the highlight are split: against interpolated normals, anywhere."""
    mesh = pv.Sphere(theta_resolution=12, phi_resolution=9)
    found = isoluminance(mesh, SHINY, levels=0.02)["bands"]
    normals = np.asarray(mesh.point_normals, dtype=float)
    place, polygon = banded.places(polygons(found), random, 2)
    some = random.choice(len(place), 3000, replace=False)
    place, polygon = place[some], polygon[some]
    corners = mesh.regular_faces[mesh.find_closest_cell(place)]
    basis = np.moveaxis(np.asarray(mesh.points, dtype=float)[corners], 1, 2)
    weight = np.linalg.solve(basis, place[:, :, np.newaxis])[..., 0]
    assert np.all((weight > -1e-6) & (np.abs(weight.sum(axis=1, keepdims=True) - 1) < 1e-6))
    normal = unit(np.einsum("mc,mcn->mn", weight, normals[corners]))
    error = np.abs(exact(normal) - found["luminance"][polygon])
    assert error.max() <= 1.02 * found.field_data["luminance_error"][0] <= 1.02 * 0.02
    assert found["luminance"].max() > 0.85


def test_colour_goes_with_the_bands():
    scene = DULL.replace(material=Material(ambient=0.1, diffuse=0.8, specular=0, color="orange"))
    tint = np.array(pv.Color("orange").float_rgb)
    for shape in (pv.Sphere(), Sphere(), Sphere() - Block((0, 0, 1))):
        bands = isoluminance(shape, scene, levels=5)["bands"]
        # The source may be as bright as its tint; what counts is one colour per band.
        expected = tint * bands["luminance"][:, np.newaxis]
        scale = bands["rgb"].max() / expected.max()
        np.testing.assert_allclose(bands["rgb"], scale * expected, atol=1e-6)
    assert "rgb" not in isoluminance(Sphere(), DULL)["bands"].cell_data


def test_colour_goes_with_bands_of_tangents():
    mesh = sphere_mesh(20)
    lights = Light(direction=TOWARD, color="red"), Light(direction=-TOWARD, color="blue")
    scene = SHINY.replace(lights=lights)
    bands = isoluminance(mesh, scene, levels=9, tangents="V")["bands"]
    lit = vizlight.illuminate(mesh, scene, tangents="V", precision="float64")
    middles = np.array([cell.points.mean(axis=0) for cell in bands.cell])
    corners = mesh.regular_faces[mesh.find_closest_cell(middles)]
    edges = np.moveaxis(np.asarray(mesh.points, dtype=float)[corners], 1, 2)
    share = (np.linalg.pinv(edges) @ middles[:, :, np.newaxis])[..., 0]
    rgb, value = (np.einsum("ij,ij...->i...", share, lit[k][corners]) for k in ("rgb", "luminance"))
    expected = rgb * (bands["luminance"] / value)[:, np.newaxis]
    np.testing.assert_allclose(bands["rgb"], expected, atol=1e-4)
    assert np.ptp(bands["rgb"], axis=0)[[0, 2]].min() > 0.2
    plain = isoluminance(mesh, SHINY, levels=9, tangents="V")["bands"]
    assert "rgb" not in plain.cell_data


@pytest.mark.parametrize("empty", [pv.PolyData, pv.UnstructuredGrid, pv.MultiBlock])
def test_an_empty_mesh_has_no_bands(empty):
    found = isoluminance(empty(), DULL)
    assert found["bands"].n_cells == found["contours"].n_cells == 0
    assert found["bands"].field_data["luminance_error"] == [0]


def test_areas_of_bands_against_vtk():
    """With tangents the luminance itself is interpolated, as VTK's banded contours do."""
    mesh = sphere_mesh(40)
    found = isoluminance(mesh, SHINY, levels=7, tangents="V")["bands"]
    lit = vizlight.illuminate(mesh, SHINY, tangents="V", precision="float64")
    low, high = lit["luminance"].min(), lit["luminance"].max()
    vtk = lit.contour_banded(8, rng=(low, high), scalars="luminance")[0].compute_cell_sizes()
    vtk_band = vtk.cell_data["Scalars"]
    own = found.compute_cell_sizes()
    theirs = np.bincount(np.unique(vtk_band, return_inverse=True)[1].ravel(), vtk["Area"])
    ours = np.bincount(np.maximum(own["band"], 1) - 1, own["Area"])
    np.testing.assert_allclose(ours, theirs, rtol=2e-3, atol=1e-3)


def test_a_closed_mesh_stays_closed():
    for mesh in (pv.Sphere().clean(), pv.ParametricTorus().clean(), pv.Cube().clean()):
        found = isoluminance(mesh, DULL, levels=9)["bands"]
        assert found.is_manifold == mesh.is_manifold
        assert found.compute_cell_sizes()["Area"].sum() == pytest.approx(mesh.area, rel=1e-5)


@pytest.mark.parametrize(
    "mesh",
    [
        pv.ImageData(dimensions=(4, 5, 6)),
        pv.Sphere().cast_to_unstructured_grid(),
        pv.MultiBlock([pv.Sphere(), None, pv.Sphere(center=(3, 0, 0))]),
        pv.Cube(),
        pv.Sphere().strip(),
    ],
)
def test_kinds_of_meshes(mesh):
    # The hull of a grid has the sharp edges of a box.
    angle = 30 if isinstance(mesh, pv.ImageData) else None
    found = isoluminance(mesh, DULL, levels=5, feature_angle=angle)
    assert found.keys() == ["bands", "contours"]
    assert found["bands"].n_cells > 0
    assert np.isfinite(found["bands"]["luminance"]).all()


def test_the_bands_are_what_a_plotter_shows():
    sphere = pv.Sphere()
    sphere["height"] = sphere.points[:, 2]
    bands = vizlight.isoluminance(sphere, levels=4)["bands"]
    assert "height" in bands.point_data
    assert bands.active_scalars_info.association is pv.FieldAssociation.CELL
    assert bands.active_scalars_name == "luminance"


def test_names_and_the_accessor():
    found = pv.Sphere().vizlight.isoluminance(DULL, levels=4, name="glow")
    assert {"glow", "glow_band"} <= set(found["bands"].cell_data)
    assert vizlight.provenance(found["bands"], "glow")["options"]["name"] == "glow"


def test_float32_far_from_the_origin():
    mesh = sphere_mesh(30)
    far = mesh.translate((5e6, 0, 0))
    scene = DULL.replace(lights=Light(position=(5e6 + 2, 0, 0)))
    near = DULL.replace(lights=Light(position=(2, 0, 0)))
    a, b = isoluminance(far, scene, levels=5)["bands"], isoluminance(mesh, near, levels=5)["bands"]
    assert a["luminance"].max() == pytest.approx(b["luminance"].max(), abs=0.1)


def test_points_that_are_not_finite_or_have_no_normal():
    mesh = pv.Sphere()
    points = np.array(mesh.points)
    points[7] = np.nan
    mesh.points = points
    found = isoluminance(mesh, DULL, levels=4)
    assert np.isfinite(found["bands"].points).all()
    assert np.isfinite(found["bands"]["luminance"]).all()
    flat = pv.Sphere()
    flat["N"] = np.where(np.arange(flat.n_points)[:, None] % 5, np.asarray(flat.points), 0)
    with pytest.warns(UserWarning, match="could not be lit"):
        found = isoluminance(flat, DULL, levels=4, normals="N")
    assert found["bands"]["luminance"].min() == pytest.approx(0.1)


def test_points_that_no_face_uses_are_not_reported():
    mesh = pv.Icosphere(nsub=2)
    found = isoluminance(mesh + pv.Line(), DULL, levels=4)["bands"]
    np.testing.assert_allclose(found["luminance"].max(), 0.9, atol=0.2)
    bent = mesh + pv.Line()
    bent["N"] = np.array(bent.points)
    # One point of the faces, and the points of the line, which VTK 9.4 puts first.
    bent["N"][bent.find_closest_point(mesh.points[5])] = 0
    bent["N"][np.linalg.norm(bent.points, axis=1) < 0.9] = 0
    with pytest.warns(UserWarning, match=r"1 of 162 points could not be lit") as caught:
        isoluminance(bent, DULL, levels=4, normals="N")
    assert "array" not in str(caught[0].message)


test_bad_input = refusals(
    lambda mesh, options: isoluminance(mesh, **{"scene": DULL} | options),
    (3, {}, "mesh: expected a PyVista mesh or a solid", TypeError),
    (pv.PolyData(np.zeros((3, 3))), {}, "mesh: expected a surface"),
    (pv.Sphere(), {"levels": 0}, "levels: expected"),
    (pv.Sphere(), {"name": ""}, "name: expected"),
    (pv.Sphere(), {"tangents": "V"}, "tangents: expected"),
    (Sphere(), {"tangents": "V"}, "tangents: expected None for a solid"),
    (Sphere() | Block(), {"tolerance": 1}, "tolerance: expected"),
    (Sphere(), {"scene": "bright"}, "scene: expected", ValueError),
    (pv.Cube(), {"feature_angle": 200}, "feature_angle: expected"),
)


@pytest.mark.opengl
def test_picture_of_bands(verify_image_cache):
    """Limits: edges of bands move by a pixel between drivers; a wrong band is far above."""
    verify_image_cache.high_variance_test = False
    part = Sphere() - Frustum((0, 0, 0), (0, 0, 3), (0.5, 0.5))
    camera = render.camera_on((-1, 1, -1, 1, -1, 1), (0.4, -1, 0.9))
    found = isoluminance(part, SHINY.replace(view=View.from_camera(camera)), levels=8)
    plotter = render.make_plotter(found["bands"], camera=camera, size=(300, 300), cmap="cividis")
    plotter.show()


@pytest.mark.parametrize("color", [None, "tomato"])
def test_nothing_of_a_solid_is_left(color):
    scene = Scene(lights=Light(direction=(0, 0, 1)), material=shiny(specular=0, color=color))
    nothing = isoluminance(Sphere() - Sphere(radius=2), scene)
    assert [block.n_cells for block in nothing] == [0, 0]


@pytest.mark.parametrize("grid", [False, True])
def test_a_box_has_one_band_per_face(grid):
    cube = pv.Cube().triangulate()
    cube.clear_data()
    cube = cube.clean()
    mesh = pv.ImageData(dimensions=(2, 2, 2)) if grid else cube
    scene = Scene(lights=Light(direction=(1, 2, 3)), material=shiny(specular=0))
    for angle in (30, "auto"):
        found = isoluminance(mesh, scene, levels=[0.2, 0.35, 0.5], feature_angle=angle)
        bands = found["bands"]
        areas = bands.compute_cell_sizes()["Area"]
        inside = [areas[bands["band"] == i].sum() for i in np.unique(bands["band"])]
        np.testing.assert_allclose(inside, [3, 1, 1, 1], atol=1e-6)


@pytest.mark.parametrize("tangents", [None, "way"])
def test_point_data_are_carried_onto_bands(tangents):
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    ball["height"] = ball.points[:, 2].astype(np.float32)
    ball["place"] = ball.points.astype(np.float64)
    ball["label"] = np.arange(ball.n_points)
    ball["way"] = np.cross(ball.points, [0.3, 0.1, 1.0])
    before = ball.copy()
    scene = Scene(lights=Light(direction=(1, 0, 0.5)), material=shiny(specular=0))
    bands = isoluminance(ball, scene, levels=6, tangents=tangents)["bands"]
    # Positions are interpolated like the points themselves.
    np.testing.assert_allclose(bands["place"], bands.points, atol=1e-6)
    np.testing.assert_allclose(bands["height"], bands.points[:, 2], atol=1e-6)
    assert bands["height"].dtype == np.float32
    assert "label" not in bands.point_data
    assert ball == before


def test_normals_of_a_volume_are_those_of_its_surface():
    """Values per point of the volume are taken at the points that its surface has."""
    volume = pv.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid()
    volume.clear_data()
    rows = np.asarray(volume.points) - 1.4
    surface, scene = volume.extract_surface(algorithm="geometry"), DULL
    at = cKDTree(volume.points).query(surface.points)[1]
    found = isoluminance(volume, scene, levels=6, normals=rows)
    expected = isoluminance(surface, scene, levels=6, normals=rows[at])
    assert found["bands"].n_cells == expected["bands"].n_cells
    lit = [np.sort(mesh["bands"]["luminance"]) for mesh in (found, expected)]
    np.testing.assert_allclose(*lit)
    areas = [mesh["bands"].compute_cell_sizes()["Area"].sum() for mesh in (found, expected)]
    assert areas[0] == pytest.approx(areas[1])
