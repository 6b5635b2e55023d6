"""Fur as numbers: where it stands, what attenuates it, what is told of it; illustration 3."""

import numpy as np
import pytest
import pyvista as pv
import vtk
from lamps import DEFAULT, HEADLIT, SHINY, far, shiny
from refusals import refusals
from vectors import unit

import vizlight
from studies import fur as study
from studies import peak_memory
from vizlight import Bundle, Light, Material, Scene, View, _pool, fur
from vizlight.mesh import meaning
from vizlight.model import cylinder

TOWARD, EYE = unit([(-1.0, -0.6, 0.9), (0.3, -1, 0.8)])
SCENE = far(TOWARD, EYE, Material(ambient=0.1, diffuse=0.9, specular=0.1))


def torus(n=48):
    return study.torus(n)


def strands(coat, segments=3):
    return np.asarray(coat["fibres"].points).reshape(-1, segments + 1, 3)


def ways(coat, segments=3):
    """Return the vectors from the roots of fibres to their tips."""
    along = strands(coat, segments)
    return along[:, -1] - along[:, 0]


def test_fibres_stand_on_the_surface_along_its_normals():
    mesh = torus(96)
    before = mesh.copy()
    coat = fur(mesh, SCENE, density=0.02, fibres=4000, length=0.2)
    root = strands(coat)[:, 0].astype(float)
    outward = root - 1.5 * unit(root * [1, 1, 0])
    np.testing.assert_allclose(np.linalg.norm(outward, axis=1), 0.75, atol=2e-3)
    np.testing.assert_allclose(np.linalg.norm(ways(coat), axis=1), 0.2, rtol=1e-5)
    assert np.sum(ways(coat) / 0.2 * unit(outward), axis=1).min() > 0.999
    assert mesh == before
    assert coat.keys() == ["fibres", "skin"]
    assert coat["fibres"].n_lines == 4000
    assert coat["fibres"].n_points == 16_000


def test_attenuation_is_the_closed_form_from_base_to_tip():
    """(1 - rho)^(h/sin a) in and out: base h = length, tip 0, between what stands above."""
    density, length = 0.6, 0.3
    mesh = torus()
    with_fur = fur(mesh, SCENE, density=density, fibres=2000, length=length)
    bare = fur(mesh, SCENE, absorption=0, fibres=2000, length=length)
    normal = ways(bare).astype(float) / length
    lit = (bare["fibres"]["luminance"].reshape(-1, 4) - 0.1).astype(float)
    thick = (with_fur["fibres"]["luminance"].reshape(-1, 4) - 0.1).astype(float)
    sine_in, sine_out = normal @ TOWARD, np.abs(normal @ EYE)
    seen = (sine_in > 0.05) & (sine_out > 0.05) & (lit[:, 0] > 0.01)
    assert seen.sum() > 300
    for j, remaining in enumerate(np.linspace(length, 0, 4)):
        expected = (1 - density) ** (remaining / sine_in[seen] + remaining / sine_out[seen])
        np.testing.assert_allclose(thick[seen, j] / lit[seen, j], expected, atol=2e-4)
    np.testing.assert_allclose(thick[:, 3], lit[:, 3], atol=1e-6)


def test_skin_is_attenuated_by_the_fur_above_it():
    density, length = 0.6, 0.3
    mesh = torus()
    coat = fur(mesh, SCENE, density=density, fibres=10, length=length)
    bare = vizlight.illuminate(mesh, SCENE)
    normal = np.asarray(mesh["Normals"], dtype=float)
    sine_in, sine_out = np.maximum(normal @ TOWARD, 1e-9), np.maximum(np.abs(normal @ EYE), 1e-9)
    remains = (1 - density) ** (length / sine_in + length / sine_out)
    expected = 0.1 + (bare["luminance"] - 0.1) * remains
    np.testing.assert_allclose(coat["skin"]["luminance"], expected, atol=2e-6)


def test_illustration_3_as_numbers():
    """A: lit by the fibres alone. B: conditioned. C: conditioned and attenuated."""
    mesh = torus()
    options = {"fibres": 3000, "length": 0.3}
    a = fur(mesh, SCENE, conditioned=False, absorption=0, **options)["fibres"]
    b = fur(mesh, SCENE, absorption=0, **options)["fibres"]
    c = fur(mesh, SCENE, density=0.9, **options)["fibres"]
    np.testing.assert_array_equal(a.points, c.points)
    normal = ways({"fibres": a}).astype(float) / 0.3
    dark = np.repeat(normal @ TOWARD < -1e-3, 4)
    assert a["luminance"][dark].max() > 0.5
    for conditioned in (b, c):
        np.testing.assert_allclose(conditioned["luminance"][dark], 0.1, rtol=1e-6)
    by_height = c["luminance"].reshape(-1, 4)
    assert np.all(np.diff(by_height, axis=1) >= -1e-6)


@pytest.mark.parametrize("density", [0.0, 1.0])
def test_no_fur_and_opaque_fur(density):
    mesh = torus()
    coat = fur(mesh, SCENE, density=density, fibres=500, length=0.2)
    plain = fur(mesh, SCENE, absorption=0, fibres=500, length=0.2)
    light = coat["fibres"]["luminance"].reshape(-1, 4)
    free = plain["fibres"]["luminance"].reshape(-1, 4)
    np.testing.assert_array_equal(light[:, 3], free[:, 3])
    if density:
        np.testing.assert_allclose(light[:, :3], 0.1, rtol=1e-6)
        np.testing.assert_allclose(coat["skin"]["luminance"], 0.1, rtol=1e-6)
    else:
        np.testing.assert_array_equal(light, free)


@pytest.mark.parametrize("length", [0.0, 1e-20, 1e-7])
def test_bald_and_downy_skin_is_lit_like_long_hair(length):
    """A direction is not what is left of the difference of two points."""
    mesh = torus()
    mesh["way"] = np.asarray(mesh["Normals"]) + np.array([0, 0, 0.3], np.float32)
    for shape in ({}, {"tangents": "way"}, {"tangents": "way", "toward": (0, 0, -1), "bend": 0.5}):
        options = {"absorption": 0, "fibres": 400, **shape}
        coat = fur(mesh, SCENE, length=length, **options)
        long = fur(mesh, SCENE, length=0.3, **options)
        hair, down = (block["fibres"]["luminance"].reshape(-1, 4) for block in (long, coat))
        if "bend" in shape and length == 0:
            np.testing.assert_allclose(down[:, 0], hair[:, 0], atol=0.2)
        else:
            np.testing.assert_allclose(down, hair, atol=2e-6)


def test_lengths_by_point():
    mesh = torus()
    mesh["hair"] = np.where(np.asarray(mesh.points[:, 2]) > 0, 0.3, 0.1)
    coat = fur(mesh, SCENE, density=0.02, fibres=3000, length="hair")
    root, size = strands(coat)[:, 0], np.linalg.norm(ways(coat), axis=1)
    np.testing.assert_allclose(size[root[:, 2] > 0.1], 0.3, rtol=1e-5)
    np.testing.assert_allclose(size[root[:, 2] < -0.1], 0.1, rtol=1e-5)


def test_bent_and_curled_fibres_lean_where_they_are_told():
    mesh = torus()
    options = {"density": 0.02, "fibres": 500, "length": 0.2, "segments": 6}
    straight = strands(fur(mesh, SCENE, **options), 6)
    down = strands(fur(mesh, SCENE, toward=(0, 0, -1), bend=2.0, **options), 6)
    assert np.all(down[:, -1, 2] < straight[:, -1, 2] + 1e-6)
    np.testing.assert_array_equal(down[:, 0], straight[:, 0])
    mesh["field"] = np.tile([0, 0, -5.0], (mesh.n_points, 1))
    np.testing.assert_allclose(
        strands(fur(mesh, SCENE, toward="field", bend=2.0, **options), 6), down, atol=1e-6
    )
    curled = strands(fur(mesh, SCENE, curl=1.0, turns=2.0, **options), 6)
    assert np.linalg.norm(curled[:, -1] - straight[:, -1], axis=1).min() > 0.01
    # Each begins to curl in a direction of its own.
    ends = strands(fur(pv.Plane(), SCENE, curl=1.0, **options), 6)
    aside = (ends[:, -1] - ends[:, 0])[:, :2]
    assert np.linalg.norm(aside.mean(axis=0)) < 0.2 * np.linalg.norm(aside, axis=1).mean()


def test_vectors_that_point_inward_are_reversed_and_counted():
    mesh = torus()
    mesh["up"] = np.tile([0, 0, 1.0], (mesh.n_points, 1))
    options = {"density": 0.02, "fibres": 1000, "tangents": "up", "length": 0.2}
    with pytest.warns(UserWarning, match=r"\d+ of 1000 fibres point into .* reversed") as caught:
        coat = fur(mesh, SCENE, **options)
    count = int(str(caught[0].message).split()[0])
    assert (ways(coat)[:, 2] > 0).sum() == 1000 - count
    assert 400 < count < 600


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_far_from_the_origin(kind):
    """Terrain in metres north of the equator has the light that it has at the origin."""
    offset = np.array([4e5, 5e6, 1e3])
    mesh = torus()
    near = pv.PolyData.from_regular_faces(
        (np.round(np.asarray(mesh.points, np.float64) * 256) * 4).astype(kind), mesh.regular_faces
    )
    far = near.copy()
    far.points = (np.asarray(near.points, np.float64) + offset).astype(kind)
    for block in (near, far):
        block["Normals"] = mesh["Normals"]
        block.point_data.active_normals_name = "Normals"
    light, eye = np.array([-2000.0, -1500, 1800]), np.array([500, -5000, 4000])
    cue = vizlight.DepthCue(back_scale=0.5)
    for view in ({"position": eye}, {"direction": (0.3, -1, 0.8)}):
        scene = Scene(
            lights=Light(position=light), view=View(**view), depth_cue=cue, material=SHINY
        )
        moved = scene.replace(lights=Light(position=light + offset))
        moved = scene.moved(offset) if "position" in view else moved
        options = {"density": 0.001, "fibres": 2000, "length": 100, "curl": 0.3}
        here, there = fur(near, scene, **options), fur(far, moved, **options)
        for one, other in zip(here, there, strict=True):
            np.testing.assert_allclose(other["luminance"], one["luminance"], atol=3e-4)
        places = np.asarray(there["fibres"].points)
        assert places.dtype == np.float64
        assert here["fibres"].points.dtype == kind
        np.testing.assert_allclose(places - offset, here["fibres"].points, atol=1e-3)


@pytest.mark.parametrize("segments", [1, 6])
@pytest.mark.parametrize("shape", [{"curl": 1.0}, {"bend": 2.0, "toward": (0, 0, -1)}])
def test_segments_are_lit_along_themselves(shape, segments):
    options = {"absorption": 0, "fibres": 500, "length": 0.2, "conditioned": False}
    coat = fur(torus(), SCENE, segments=segments, **shape, **options)
    again = vizlight.illuminate(coat["fibres"], SCENE, name="again")
    np.testing.assert_allclose(coat["fibres"]["luminance"], again["again"], atol=1e-4)


@pytest.mark.parametrize("scale", [1e-150, 1e-24, 1e20, 1e150, "mixed"])
def test_vectors_of_any_size(scale, random):
    mesh = torus()
    if scale == "mixed":
        scale = 10.0 ** random.uniform(-150, 150, (mesh.n_points, 1))
    mesh["way"] = unit(np.add(mesh["Normals"], (0, 0, 0.3)))
    options = {"density": 0.5, "fibres": 300, "bend": 1.0}
    expected = fur(mesh, SCENE, tangents="way", toward="way", **options)["fibres"]
    mesh["way"] = mesh["way"] * scale
    found = fur(mesh, SCENE, tangents="way", toward="way", **options)["fibres"]
    np.testing.assert_allclose(found.points, expected.points, atol=1e-6)
    np.testing.assert_allclose(found["luminance"], expected["luminance"], atol=1e-5)


def test_vectors_that_are_not_finite_are_told_of():
    mesh = torus()
    mesh["way"] = np.array(mesh["Normals"])
    mesh["way"][:50] = np.nan
    with pytest.warns(UserWarning, match="50 of 2304 of the vectors are not finite"):
        fur(mesh, SCENE, density=0.5, fibres=10, tangents="way")


def test_zero_vectors_follow_the_normals():
    mesh = torus()
    mesh["none"] = np.zeros((mesh.n_points, 3))
    by_vectors = fur(mesh, SCENE, density=0.02, fibres=100, tangents="none")
    by_normals = fur(mesh, SCENE, density=0.02, fibres=100)
    np.testing.assert_array_equal(by_vectors["fibres"].points, by_normals["fibres"].points)


def test_reproducible_whatever_the_threads():
    mesh = torus()
    options = {"density": 0.5, "fibres": 70_000, "curl": 0.5}
    with _pool.threads(1):
        one = fur(mesh, SCENE, **options)["fibres"]
    with _pool.threads(3):
        two = fur(mesh, SCENE, **options)["fibres"]
    other = fur(mesh, SCENE, seed=1, **options)["fibres"]
    np.testing.assert_array_equal(one.points, two.points)
    np.testing.assert_allclose(one["luminance"], two["luminance"], atol=1e-6)
    assert not np.array_equal(one.points, other.points)


def test_memory_is_at_most_half_above_the_output():
    mesh = torus()
    options = {"density": 0.02, "fibres": 600_000, "length": 0.2, "segments": 3}
    fur(mesh, SCENE, density=0.02, fibres=1000)
    coat = fur(mesh, SCENE, **options)
    output = 1024 * sum(block.actual_memory_size for block in coat)
    assert peak_memory(lambda: fur(mesh, SCENE, **options)) <= 1.5 * output


def test_colour_name_and_provenance():
    scene = SCENE.replace(material=shiny(color="tan"))
    coat = fur(torus(), scene, density=0.02, fibres=10, name="x")
    for block in coat:
        assert {"x", "x_rgb"} <= set(block.point_data)
        told = vizlight.provenance(block, "x")
        assert told["filter"] == "fur"
        assert told["options"]["density"] == 0.02


def test_an_array_called_normals_that_is_none():
    mesh = torus()
    normals = np.array(mesh["Normals"])
    mesh.point_data.clear()
    mesh.point_data["Normals"] = np.tile([0.0, 0, 1], (mesh.n_points, 1))
    mesh.point_data["n"] = normals
    mesh.point_data.active_normals_name = "n"
    options = {"tangents": "Normals", "length": 0.1}
    with pytest.warns(UserWarning, match="fibres point into the surface and were reversed"):
        coat = fur(mesh, SCENE, density=0.02, fibres=100, **options)
    up = np.where(ways(coat)[:, 2:] > 0, 0.1, -0.1) * np.array([0, 0, 1])
    np.testing.assert_allclose(ways(coat), up, atol=1e-6)


def test_no_fibres():
    coat = fur(torus(), SCENE, density=0.02, fibres=0)
    assert coat["fibres"].n_points == 0
    assert "luminance" in coat["skin"].point_data
    red = SCENE.replace(material=shiny(color="red"))
    coat = fur(torus(), red, density=0.02, fibres=0)
    assert coat["fibres"].point_data["rgb"].shape == (0, 3)
    assert vizlight.illuminate(pv.PolyData(), red).n_points == 0


def bad_input(options):
    mesh = torus()
    before = mesh.copy()
    try:
        fur(mesh, SCENE, **{"density": 0.02, "fibres": 10, **options})
    finally:
        assert mesh == before


test_bad_input = refusals(
    bad_input,
    ({"density": 1.5}, "density: expected a number from 0 to 1, got 1.5"),
    ({"density": -0.1}, "density: expected a number from 0 to 1"),
    ({"length": -0.1}, r"length: expected a number from 0 to 1e\+30, got -0.1"),
    ({"length": "hair"}, "length: expected a point array of one component"),
    ({"length": np.ones(3)}, "length: expected 2304 lengths of 0 or more"),
    ({"length": [[1.0, 2], [3]]}, "length: expected numbers in rows of equal length", TypeError),
    ({"absorption": 0.5}, "absorption, density: expected one of them"),
    ({"density": None, "absorption": 1.1}, "absorption: expected a number from 0 to 1"),
    ({"fibres": -1}, "fibres: expected an integer of at least 0"),
    ({"segments": 0}, "segments: expected an integer of at least 1"),
    ({"tangents": "U"}, "tangents: expected the name of a point array"),
    ({"bend": 1.0}, "toward: expected the direction of the bend"),
    ({"bend": 1.0, "toward": (0, 0, 0)}, "toward: expected a direction of non-zero"),
    ({"bend": 1.0, "toward": (0, 1)}, "toward: expected 3 components"),
    ({"seed": -1}, "seed: expected an integer of at least 0"),
    ({"tangents": np.ones((2304, 3))}, "tangents: expected the name of a point", TypeError),
    ({"curl": np.nan}, "curl: expected a number from"),
)


def huge():
    mesh = torus()
    mesh.points = np.asarray(mesh.points, float) * 1e100
    return mesh


def taken():
    mesh = torus()
    mesh["luminance"] = np.arange(mesh.n_points)
    return mesh


test_bad_surfaces_and_scenes = refusals(
    lambda mesh, scene: fur(mesh, scene, density=0.02, fibres=10),
    ([], SCENE, "surface: expected a PyVista surface, got list", TypeError),
    (pv.Line(), SCENE, "surface: expected a surface with faces"),
    (torus(), Scene(lights=Light(direction=(1, 0))), "scene: expected vectors of 3 .*, got 2"),
    (torus(), 3, r"scene: expected a vizlight\.Scene or None, got 3", TypeError),
    (huge(), SCENE, "surface: expected a size from 1e-30 to 1e30"),
    (taken(), SCENE, "name: expected one under which the mesh has no array"),
)


def test_fur_without_a_scene_is_seen_from_infinity():
    seen = Scene(
        lights=DEFAULT,
        view=View(direction=(1, 1, 1)),
        material=Material(ambient=0.4, diffuse=2.0, specular=0),
    )
    one, other = (fur(torus(), scene, density=0.2, fibres=50) for scene in (None, seen))
    for part in ("fibres", "skin"):
        np.testing.assert_allclose(one[part]["luminance"], other[part]["luminance"], atol=3e-6)


def test_surfaces_of_whole_numbers_have_fibres_between():
    places = vtk.vtkPoints()
    places.SetDataTypeToInt()
    for place in ((0, 0, 0), (9, 0, 0), (0, 9, 0)):
        places.InsertNextPoint(*place)
    mesh = pv.PolyData()
    mesh.SetPoints(places)
    mesh.faces = [3, 0, 1, 2]
    hair = fur(mesh, Scene(**HEADLIT, view=View(direction=(0, 0, 1))), density=0.1, fibres=5)[0]
    assert hair.points.dtype.kind == "f"
    assert np.any(hair.points % 1)


def test_fur_of_thin_cylinders_stands_on_a_skin_of_blinns():
    """Each fibre has the exact line light along itself, the skin the same highlight's power."""
    mesh, still = torus(), {"conditioned": False, "absorption": 0}
    coat = fur(mesh, SCENE, fibres=400, length=0.2, model="cylinder", **still)
    way = np.repeat(ways(coat).astype(float), 4, axis=0)
    shine = cylinder.specular(TOWARD, EYE, way, shininess=SCENE.material.shininess)
    light = 0.1 + 0.9 * cylinder.diffuse(TOWARD, EYE, way) + 0.1 * shine
    np.testing.assert_allclose(coat["fibres"]["luminance"], light, atol=2e-5)
    skin = vizlight.illuminate(mesh, SCENE, model="blinn")["luminance"]
    np.testing.assert_allclose(coat["skin"]["luminance"], skin, atol=1e-6)
    by_phong = vizlight.illuminate(mesh, SCENE)["luminance"]
    assert np.abs(coat["skin"]["luminance"] - by_phong).max() > 0.01


@pytest.mark.parametrize("scale", [1.0, 0.0385, 38.5])
def test_fur_looks_the_same_on_a_mesh_of_any_size(scale):
    """The defaults are in the mesh's own measure: light is the same, lengths are scaled."""
    mesh = torus()
    sized = mesh.copy()
    sized.points = (np.asarray(mesh.points, dtype=float) * scale).astype(np.float32)
    expected, found = fur(mesh, SCENE, fibres=2000), fur(sized, SCENE, fibres=2000)
    for part in ("fibres", "skin"):
        np.testing.assert_allclose(found[part]["luminance"], expected[part]["luminance"], atol=2e-4)
    length = [np.linalg.norm(ways(coat), axis=1).mean() for coat in (expected, found)]
    assert length[0] == pytest.approx(0.03 * mesh.length, rel=1e-5)
    assert length[1] == pytest.approx(scale * length[0], rel=1e-4)


@pytest.mark.parametrize("absorption", [0.0, 0.2, 0.9, 1.0])
def test_absorption_is_the_share_lost_over_the_own_length(absorption):
    """As the source's density per unit, where one can be expressed."""
    mesh, length = torus(), 0.25
    density = 1 - (1 - absorption) ** (1 / length)
    for options in ({}, {"bend": 0.5, "toward": (0, 0, -1)}):
        options = {"fibres": 1000, "length": length, **options}
        one = fur(mesh, SCENE, absorption=absorption, **options)
        other = fur(mesh, SCENE, density=density, **options)
        for part in ("fibres", "skin"):
            np.testing.assert_allclose(one[part]["luminance"], other[part]["luminance"], atol=2e-5)


def test_absorption_where_lengths_vary_is_that_of_the_mean_length():
    mesh = torus()
    mesh["hair"] = np.linspace(0.1, 0.3, mesh.n_points)
    density = 1 - (1 - 0.6) ** (1 / 0.2)
    one = fur(mesh, SCENE, absorption=0.6, fibres=500, length="hair")
    other = fur(mesh, SCENE, density=density, fibres=500, length="hair")
    np.testing.assert_allclose(one["fibres"]["luminance"], other["fibres"]["luminance"], atol=2e-5)
    assert np.all(np.isfinite(fur(mesh, SCENE, fibres=50, length=0.0)["skin"]["luminance"]))


def test_points_of_the_skin_are_split_at_sharp_edges():
    box = pv.Cube().triangulate().subdivide(3).clean()
    box.clear_data()
    box["long"] = np.full(box.n_points, 0.1)
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(1, 1, 1)), material=SHINY)
    with pytest.warns(UserWarning, match="8% of the edges are sharper than 30 degrees"):
        fur(box, scene, fibres=10)
    found = fur(box, scene, fibres=600, feature_angle=30, length="long")
    # Each face has its own points, and fibres stand square on it.
    assert found["skin"].n_points == 6 * 81
    assert box.n_points == 386
    np.testing.assert_allclose(np.abs(ways(found)).max(axis=1), 0.1, rtol=1e-5)
    np.testing.assert_allclose(np.abs(ways(found)).sum(axis=1), 0.1, rtol=1e-5)
    assert np.all(np.abs(found["skin"].points).max(axis=1) > 0.4999)
    with pytest.raises(TypeError, match="length: expected the name of a point array beside"):
        fur(box, scene, feature_angle=30, length=np.full(box.n_points, 0.1))
    with pytest.raises(ValueError, match="feature_angle: expected a number of degrees"):
        fur(box, scene, feature_angle="sharp")


@pytest.mark.slow
@pytest.mark.parametrize("origin", [(0, 0, 0), (4e5, 5e6, 100)])
def test_fibres_dim_one_another_and_the_skin_as_a_bundle(origin):
    ball = pv.Sphere(radius=1.0, theta_resolution=30, phi_resolution=30)
    ball.points = np.asarray(ball.points, float) + np.array(origin)
    scene = far((0, 0, 1), (0, -1, 0.4))
    asked = Bundle(diameter=0.01, grid=48)
    coat = fur(ball, scene, fibres=4000, length=0.3, bundle=asked)
    fibres, skin = coat["fibres"], coat["skin"]
    height = np.asarray(skin.points, float)[:, 2] - origin[2]
    top = height > 0.5
    # Fibres that point at the light take less of it than those across it.
    depth = np.asarray(-np.log(skin["transmittance"]))
    assert 0 < np.median(depth[height > 0.98]) < np.median(depth[np.abs(height - 0.5) < 0.1])
    tips = np.asarray(fibres["transmittance"]).reshape(-1, 4)
    lit = (np.asarray(fibres.points, float)[:, 2] - origin[2]).reshape(-1, 4)[:, 0] > 0.3
    assert tips[lit, 3].mean() > tips[lit, 0].mean() + 0.2
    bare = fur(ball, scene.replace(lights=[]), fibres=4000, length=0.3, bundle=asked)["skin"]
    assert np.asarray(bare["luminance"])[top].mean() < 0.7 * scene.material.ambient
    # The same as light among the finished fibres.
    again = vizlight.illuminate(fibres, scene, bundle=asked)
    np.testing.assert_allclose(again["transmittance"], fibres["transmittance"], atol=0.02)
    plain = fur(ball, scene, fibres=4000, length=0.3, absorption=0)
    assert (fibres["luminance"] <= plain["fibres"]["luminance"] + 1e-6).all()


test_what_does_not_go_with_a_bundle = refusals(
    lambda options: fur(
        pv.Sphere(), Scene(**HEADLIT, view=View(direction=(0, 0, 1))), **{"bundle": True} | options
    ),
    ({"density": 0.3}, "bundle: expected no absorption or density"),
    ({"bundle": 3}, "bundle: expected True, False"),
    ({"bundle": Bundle(lines=pv.Line())}, r"Bundle\(lines=\): expected the fibres"),
    kind=(TypeError, ValueError),
)


def test_a_closed_surface_is_covered_on_its_outer_side():
    ball = pv.Sphere()
    ball.point_data["Normals"] *= -1
    tips = vizlight.fur(ball, length=0.2, fibres=200)["fibres"].points
    assert np.linalg.norm(tips, axis=1).max() > 0.6


def test_what_is_made_of_a_map_lies_on_it():
    grid = pv.ImageData(dimensions=(9, 8, 1))
    grid["v"] = np.tile([1.0, 0.2, 0.0], (grid.n_points, 1))
    grid.field_data["unit"], grid.field_data["meaning"] = ["metre"], ['{"axes": ["x east"]}']
    lines = vizlight.streamlines(grid, Scene(), tangents="v", seeds=3)
    *_, paths = vizlight.pathlines([grid, grid], times=[0, 1], tangents="v", seeds=[[2.0, 3, 0]])
    bands = vizlight.isoluminance(grid, Scene(), levels=3)
    for mesh in (lines, paths, *bands, *vizlight.fur(grid, Scene(), fibres=5)):
        assert mesh.field_data["unit"][0] == "metre"
        assert meaning.of(mesh).axes == ["x east"]
