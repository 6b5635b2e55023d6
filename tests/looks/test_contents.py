"""What data hold: roles of arrays, and what is no datum."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.looks.contents import Contents, Named, kinds_of, sorted_arrays
from vizlight.mesh import georeference, meaning


def of(**arrays):
    mesh = pv.Sphere(theta_resolution=20, phi_resolution=20)
    for name, values in arrays.items():
        mesh[name] = values(mesh.n_points)
    return Contents(mesh)


def test_the_largest_kinds_are_those_of_the_largest_areas():
    # A plate of two triangles beside small balls of many.
    parts = [pv.Plane(i_size=50, j_size=50, i_resolution=1, j_resolution=1)]
    parts += [pv.Sphere(radius=1.0 + 0.1 * i) for i in range(3)]
    for kind, part in enumerate(parts):
        part.clear_data()
        part.cell_data["part"] = np.full(part.n_cells, kind)
    whole = pv.merge(parts, merge_points=False).extract_surface(algorithm="dataset_surface")
    assert kinds_of(whole, "part", 3) == [0, 2, 3]


def rising(n):
    return np.linspace(0, 1, n)


@pytest.mark.parametrize(
    ("name", "values", "role"),
    [
        ("p", rising, "values"),
        ("surface_height", rising, "heights"),
        ("V", lambda n: np.random.default_rng(0).normal(size=(n, 3)), "vectors"),
        ("skin", lambda n: np.arange(3 * n, dtype=np.uint8).reshape(n, 3), "colors"),
        ("part", lambda n: np.arange(n) % 3, "kinds"),
        ("counts", np.arange, "values"),
        ("far", lambda n: 1e6 * (np.arange(n) % 3), "values"),
    ],
)
def test_roles(name, values, role):
    (array,) = of(**{name: values}).arrays
    assert (array.name, array.role) == (name, role)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("GlobalNodeId", np.arange),
        ("NumIdCell", np.arange),
        ("ansys_node_num", np.arange),
        ("constant", np.ones),
        ("Unnamed_0", np.arange),
        ("latitude", rising),
        ("nothing", lambda n: np.full(n, np.nan)),
        ("vtkValidPointMask", lambda n: np.arange(n) % 2),
        ("no flow", lambda n: np.zeros((n, 3))),
        ("rgb", lambda n: np.tile([1.0, 0, 0.5], (n, 1))),
    ],
)
def test_what_is_no_datum(name, values):
    assert of(**{name: values}).arrays == ()


def test_rows_that_are_counted_and_normals_are_no_data_of_points():
    cloud = pv.PolyData(np.random.default_rng(0).random((40, 3)))
    # The numbers begin anew where tables are joined.
    cloud["row"] = np.r_[np.arange(25.0), np.arange(15)]
    cloud["NX"], cloud["NY"], cloud["NZ"] = cloud.points.T.copy()
    cloud["grade"] = cloud.points[:, 0] ** 2
    cloud["every second"] = 2 * np.arange(40)
    names = [array.name for array in Contents(cloud).arrays]
    assert names == ["grade", "every second"]
    assert Contents(cloud).named("row").role == "values"


def test_directions_platforms_and_places_of_stations_come_last():
    stations = pv.PolyData(np.random.default_rng(0).random((40, 3)) * [30, 20, 0])
    random = np.random.default_rng(1).random((6, 40))
    names = ("elevation", "heading", "DIR", "pitch", "salinity", "T")
    for name, values in zip(names, 300 * random, strict=True):
        stations[name] = values
    said = meaning.Meaning()
    said.add_array("heading", {"standard_name": "platform_orientation", "units": "degrees"})
    said.add_array("DIR", {"long_name": "wind direction", "units": "degrees"})
    said.add_array("pitch", {"standard_name": "platform_pitch_angle", "units": "degrees"})
    meaning.attach(stations, said)
    stations.field_data[georeference.UNIT] = [georeference.DEGREE]
    arrays = Contents(stations).arrays
    assert [array.name for array in arrays] == [
        "salinity",
        "T",
        "elevation",
        "heading",
        "DIR",
        "pitch",
    ]
    # A direction that is alone is shown.
    alone = of(DIR=rising)
    assert [array.name for array in alone.arrays] == ["DIR"]


def test_labels_are_kinds_and_scans_are_values():
    grid = pv.ImageData(dimensions=(40, 40, 40))
    x, y, z = grid.points.T
    grid["labels"] = (7 * (x // 10) + 31 * (y // 10) + 3 * (z // 20)).astype(np.int16) + 1
    noise = np.random.default_rng(0).integers(-3, 4, grid.n_points)
    grid["scan"] = (100 + 3 * x + noise).astype(np.int16)
    roles = {array.name: array.role for array in Contents(grid).arrays}
    assert roles == {"labels": "kinds", "scan": "values"}


def test_whole_numbers_of_cells_that_follow_one_another_are_those_of_parts():
    mesh = pv.ImageData(dimensions=(41, 41, 1))
    count = np.arange(1600)
    mesh.cell_data["solid"] = (count // 64).astype(np.int32)
    mesh.cell_data["steps"] = (count % 40).astype(np.int32)
    mesh.cell_data["solid_float"] = count // 64 + 0.0
    roles = {array.name: array.role for array in Contents(mesh).arrays}
    assert roles == {"solid": "kinds", "steps": "values", "solid_float": "values"}


def test_a_scan_with_even_parts_has_no_labels():
    """Its edges pass through the values between, of which each has a row."""
    x = np.arange(60**3) % 60
    scan = pv.ImageData(dimensions=(60, 60, 60))
    scan["scan"] = np.clip(11 * np.abs(x - 30) - 7 * (x // 2), 40, 200).astype(np.uint8)
    scan["scan"] += (np.arange(60**3) // 3600 % 11).astype(np.uint8)
    assert Contents(scan).arrays[0].role == "values"


def test_flat_sheets_and_slabs():
    assert Contents(pv.Plane()).flat_axis == 2
    assert Contents(pv.ImageData(dimensions=(200, 1, 150))).flat_axis == 1
    assert Contents(pv.ImageData(dimensions=(300, 400, 2))).flat_axis == 2
    assert Contents(pv.Sphere()).flat_axis is None
    assert Contents(pv.ImageData(dimensions=(9, 9, 9))).flat_axis is None


def test_tables_of_a_mesh_and_tangents_of_textures_are_no_data():
    mesh = pv.Plane(i_resolution=3, j_resolution=3)
    mesh.clear_data()
    rows = np.arange(mesh.n_points, dtype=float)
    for name in ("node_x", "cellsOnCell", "face_edge_connectivity", "Mesh2_face_links"):
        mesh[name] = rows
    mesh["TANGENT"] = np.tile((1.0, 0.0, 0.5), (mesh.n_points, 1)) * rows[:, np.newaxis]
    mesh["RGBA"] = np.full((mesh.n_points, 4), 200, np.uint8)
    mesh["secondary_structures_begin"], mesh["gmsh:dim_tags"] = rows, np.stack([rows, rows], axis=1)
    assert Contents(mesh).arrays == ()
    mesh["cell_area"], mesh["x"] = rows, rows
    assert [array.name for array in Contents(mesh).arrays] == ["cell_area", "x"]


def test_clouds_and_layers_are_no_ground():
    mesh = pv.Plane(i_resolution=3, j_resolution=3)
    mesh.clear_data()
    names = {"cloud_top_height": "values", "snow_depth": "values", "surface_height": "heights"}
    names |= {"geopotential_height": "values", "sea_surface_height": "values"}
    names |= {"surface_geopotential_height": "heights", "water_table_depth": "values"}
    names |= {"depth_of_90_percent_of_irradiance": "values"}
    for name in names:
        mesh[name] = np.linspace(0, 1, mesh.n_points) ** 2
    assert {array.name: array.role for array in Contents(mesh).arrays} == names


def test_parts_of_gmsh_are_kinds_and_components_of_a_displacement_are_loads():
    mesh = pv.Plane()
    mesh.clear_data()
    mesh.cell_data["gmsh:geometrical"] = np.arange(mesh.n_cells) % 99
    (array,) = Contents(mesh).arrays
    assert array.role == "kinds"
    for name in ("xdsp", "ydsp", "zdsp"):
        mesh.point_data[name] = np.linspace(0, 1, mesh.n_points)
    assert meaning.components(mesh) == [("xdsp", "ydsp", "zdsp")]
    assert Named("xdsp,ydsp,zdsp", "vectors", of_cells=False).is_load


def test_two_components_are_vectors_in_a_plane_alone():
    flat = pv.Plane(i_resolution=3, j_resolution=3)
    rows = np.asarray(flat.points)[:, :2]
    flat.point_data["flow"] = rows
    (array,) = Contents(flat).arrays
    assert (array.name, array.role) == ("flow", "vectors")
    assert of(flow=lambda n: np.ones((n, 2))).arrays == ()


def test_of_several_vectors_a_velocity_comes_first():
    plane = pv.Plane(i_resolution=3, j_resolution=3)
    for name, power in (("SV_BF_U", 1), ("SV_BF_V", 2), ("SV_U", 3), ("SV_V", 4)):
        plane[name] = 0.1 + np.arange(16.0) ** power
    assert vizlight.look(plane).array == "SV_U,SV_V"
    assert vizlight.look(plane).drawing.keys[0]["title"].startswith("speed")


def test_whole_percents_are_no_labels():
    mesh = pv.ImageData(dimensions=(9, 9, 1))
    mesh["ice"] = np.repeat(np.arange(0, 90, 10), 9)
    assert Contents(mesh).arrays[0].role == "kinds"
    meaning.attach(mesh, meaning.Meaning(arrays={"ice": {"units": "%"}}))
    assert Contents(mesh).arrays[0].role == "values"


def test_labels_may_be_floats_with_holes():
    image = pv.ImageData(dimensions=(80, 20, 1))
    labels = 7.0 * (np.arange(1600) % 80 // 4) + 300
    labels[:90] = np.nan
    image["basin"] = labels
    (array,) = Contents(image).arrays
    assert (array.role, array.distinct) == ("kinds", 20)


def test_an_only_array_of_numbers_of_regions_is_shown_on_a_map():
    image = pv.ImageData(dimensions=(80, 20, 1))
    image["NatIdGrid"] = np.float32(7) * (np.arange(1600) % 80 // 4)
    (array,) = Contents(image).arrays
    assert (array.name, array.role) == ("NatIdGrid", "kinds")
    image["t2m"] = np.sin(np.arange(1600))
    assert [array.name for array in Contents(image).arrays] == ["t2m"]
    image.clear_data()
    image["PointIds"] = np.arange(1600)
    assert not Contents(image).arrays


def test_tones_that_are_read_coarsely_are_no_labels():
    rng = np.random.default_rng(3)
    tones = np.repeat(np.cumsum(rng.integers(-9, 10, 800)) % 200 + 20, 2).astype(np.uint8)
    image = pv.ImageData(dimensions=(80, 20, 1))
    image["band"] = tones
    (array,) = Contents(image).arrays
    assert array.role == "values"


def test_labels_need_not_be_in_the_middle_of_an_image():
    image = pv.ImageData(dimensions=(60, 60, 60))
    labels = np.zeros(60**3, np.uint8)
    labels[:20_000] = 7 * (np.arange(20_000) // 1000) + 3
    image["tissue"] = labels
    assert Contents(image).arrays[0].role == "kinds"


def test_heights_in_kelvin_are_values():
    image = pv.ImageData(dimensions=(5, 5, 1))
    image["elevation"] = np.linspace(240, 310, 25)
    assert Contents(image).arrays[0].role == "heights"
    said = meaning.Meaning()
    said.add_array("elevation", {"units": "K"})
    meaning.attach(image, said)
    assert Contents(image).arrays[0].role == "values"


@pytest.mark.parametrize(("layers", "axis"), [(1, 2), (2, None)])
def test_one_layer_of_cells_is_flat_though_it_is_thick(layers, axis):
    grid = pv.ImageData(dimensions=(11, 11, layers + 1), spacing=(1, 1, 1.4 / layers))
    grid = grid.cast_to_unstructured_grid()
    assert Contents(grid).flat_axis == axis
    thicker = pv.ImageData(dimensions=(11, 11, 2), spacing=(1, 1, 2)).cast_to_unstructured_grid()
    assert Contents(thicker).flat_axis is None


def test_active_kinds_with_colours_of_their_own_come_first():
    line = pv.Line(resolution=3)
    line.clear_data()
    line["charge"] = [0.1, 0.2, 0.3, 0.5]
    line["element"] = [6, 6, 8, 8]
    line.set_active_scalars("element")
    assert [one.name for one in sorted_arrays(line)] == ["charge", "element"]
    said = meaning.Meaning()
    said.add_kinds("element", [(6, "C", (0.5, 0.5, 0.5)), (8, "O", (1, 0, 0))])
    meaning.attach(line, said)
    assert [one.name for one in sorted_arrays(line)] == ["element", "charge"]


def test_values_of_hidden_cells_are_not_seen():
    grid = pv.ImageData(dimensions=(4, 4, 1))
    grid.cell_data["q"] = np.arange(9) // 5 + 0.5
    assert [array.name for array in Contents(grid).arrays] == ["q"]
    grid.cell_data["vtkGhostType"] = 8 * (np.arange(9) >= 5).astype(np.uint8)
    assert Contents(grid).arrays == ()


def test_a_name_stands_for_one_array():
    grid = pv.ImageData(dimensions=(4, 4, 1))
    grid.point_data["ref"], grid.cell_data["ref"] = np.arange(16.0) / 3, np.arange(9) % 3
    assert [(array.name, array.of_cells) for array in Contents(grid).arrays] == [("ref", False)]


def test_lines_in_a_plane_are_flat():
    flat = pv.MultipleLines([[0.0, 0, 2], [1, 0, 2], [1, 3, 2]])
    assert Contents(flat).flat_axis == 2
    assert Contents(pv.MultipleLines([[0.0, 0, 2], [1, 0, 2], [1, 3, 4]])).flat_axis is None


def test_tones_of_an_image_without_a_place_are_no_kinds():
    image = pv.ImageData(dimensions=(20, 10, 1))
    image["tone"] = np.where(np.arange(200) % 7 < 3, 0, 255)
    assert Contents(image).first("kinds").name == "tone"
    meaning.attach(image, meaning.Meaning(axes=meaning.PAGE))
    assert [(array.name, array.role) for array in Contents(image, raster=True).arrays] == [
        ("tone", "values")
    ]
    image["tone"][image["tone"] == 255] = 3
    assert Contents(image).arrays[0].role == "kinds"


def test_arrays_of_which_nothing_can_be_shown_are_named():
    empty = {"gone": lambda n: np.full(n, np.nan), "same": lambda n: np.full(n, 3), "ids": rising}
    assert of(**empty).words_on_none() == "gone has no number, same is 3 everywhere"
    assert of(**empty, p=rising).words_on_none() == ""


@pytest.mark.parametrize(("spread", "shown"), [(20, False), (110, True)])
def test_much_the_same_greys_of_a_surface_in_space_are_no_datum(spread, shown):
    ball = pv.Sphere()
    greys = np.linspace(128 - spread, 128 + spread, ball.n_points).astype(np.uint8)
    ball["RGB"] = np.repeat(greys[:, np.newaxis], 3, axis=1)
    assert [each.name for each in Contents(ball).arrays] == ["RGB"] * shown
    ball["RGB"][0] = [9, 8, 7]
    assert Contents(ball).arrays[0].name == "RGB"


def test_parts_of_dates_and_what_most_points_lack_come_last():
    cloud = pv.PolyData(np.random.default_rng(0).random((20, 3)))
    for name in ("Day", "damage", "elevation", "deaths"):
        cloud[name] = np.random.default_rng(len(name)).permutation(np.arange(20.0))
    cloud["damage"][2:] = np.nan
    assert [array.name for array in sorted_arrays(cloud)] == [
        "elevation",
        "deaths",
        "Day",
        "damage",
    ]


def test_an_array_of_nearly_one_value_comes_last_and_von_mises_first():
    block = pv.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    block["pressure"] = np.where(np.arange(block.n_points) < 9, rising(block.n_points), 7.5)
    block["vonmises"], block["area"] = rising(block.n_points), rising(block.n_points)
    block.set_active_scalars(None)
    names = [array.name for array in Contents(block).arrays]
    assert (names[0], names[-1]) == ("vonmises", "pressure")
    # One that is active is chosen by someone.
    block.set_active_scalars("area")
    assert Contents(block).arrays[0].name == "area"


def test_errors_of_other_arrays_come_last():
    ball = pv.Sphere()
    for name in ("NormalizedSignalEstimationError", "EstimatedUncertainty", "RTOP1"):
        ball[name] = rising(ball.n_points)
    assert Contents(ball).first("values").name == "RTOP1"
    del ball.point_data["RTOP1"]
    assert Contents(ball).first("values").name == "NormalizedSignalEstimationError"


def test_arrays_that_tell_the_place_are_no_vectors_and_come_last():
    grid = pv.ImageData(dimensions=(9, 8, 7), spacing=(5, 5, 2)).cast_to_unstructured_grid()
    x, y, z = np.round(grid.cell_centers().points.T, 3)
    places = {"IX": x // 5, "IY": y // 5, "IZ": z // 2, "XC": x, "IJK": x // 5 + 8 * (y // 5)}
    for name, values in places.items():
        grid.cell_data[name] = values
    grid.cell_data["FROM"] = np.random.default_rng(1).random(grid.n_cells)
    grid.cell_data["__in"] = np.random.default_rng(0).random(grid.n_cells)
    grid.cell_data["Au"] = np.exp(-(((x - 20) / 9) ** 2))
    arrays = Contents(grid).arrays
    assert arrays[0].name == "Au"
    assert "vectors" not in {array.role for array in arrays}
    # Alone, such an array is shown.
    grid.clear_data()
    grid["height"] = grid.points[:, 2]
    assert [array.name for array in Contents(grid).arrays] == ["height"]


def test_complex_numbers_are_named():
    mesh = pv.Plane(i_resolution=9, j_resolution=9)
    assert not Contents(mesh).words_on_complex()
    mesh["psi"] = mesh.points[:, 0] + 1j * mesh.points[:, 1]
    (note,) = vizlight.look(mesh).notes
    assert note == "psi: complex numbers are not shown; take numpy.abs or numpy.angle"


def test_rounding_is_no_datum():
    mesh = pv.ParametricTorus(u_res=30, v_res=30, w_res=30)
    x, y, _ = np.asarray(mesh.points, dtype=np.float64).T
    noise = np.random.default_rng(3).normal(size=mesh.n_points)
    mesh["w"] = 1e-12 * noise
    mesh["pressure"] = 300 + x * y
    mesh["density"] = (1000 * (1 + 1e-7 * noise)).astype(np.float32)
    contents = Contents(mesh)
    assert [array.name for array in contents.arrays] == ["pressure", "w"]
    words = contents.words_on_rounding()
    assert "density is 1000 everywhere, but for rounding" in words
    assert "w, up to 3e-12, is taken for rounding of 0" in words
    assert "pressure" not in words
    look = vizlight.look(mesh)
    assert look.array == "pressure"
    assert words in look.notes
    # Small numbers are data where all are small, where they have one sign, or differ more.
    small = pv.ParametricTorus(u_res=30, v_res=30, w_res=30)
    small["charge"] = 1e-12 * noise
    small["permeability"] = 1e-12 * (2 + np.cos(x))
    small["mass"] = (1 + 1e-5 * noise).astype(np.float32)
    small["mass"] *= 1e-12
    assert not Contents(small).words_on_rounding()
    assert {array.name for array in Contents(small).arrays} == {"charge", "permeability", "mass"}
    # It is shown where somebody asks for it.
    assert vizlight.look(mesh, array="w").array == "w"


@pytest.mark.parametrize("of_cells", [False, True])
def test_values_hidden_in_a_box_of_cells_without_common_points_are_those_of_a_volume(of_cells):
    """As those of a discontinuous field: all of its points are on the faces of cells."""
    box = pv.ImageData(dimensions=(11, 11, 11)).cast_to_unstructured_grid()
    cells = box.separate_cells()
    assert cells.n_points == 8 * cells.n_cells
    places = cells.cell_centers().points if of_cells else cells.points
    blob = np.exp(-(np.linalg.norm(places - 5, axis=1) ** 2) / 4)
    loaded = places[:, 2] * (places[:, 0] - 5.0)
    for name, values, is_part in (("blob", blob, False), ("bending", loaded, True)):
        mesh = cells.copy()
        (mesh.cell_data if of_cells else mesh.point_data)[name] = values
        assert Contents(mesh).is_part is is_part
