"""Meshes of netCDF files: one mesh, however its table of nodes is spelled."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refused

import vizlight

pytestmark = pytest.mark.usefixtures("without_trial")

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

EARTH = pv.Icosphere(nsub=3)
PLACES = np.asarray(EARTH.points) / np.linalg.norm(EARTH.points, axis=1)[:, np.newaxis]
LON = np.degrees(np.arctan2(PLACES[:, 1], PLACES[:, 0]))
LAT = np.degrees(np.arcsin(np.clip(PLACES[:, 2], -1, 1)))
FACES = EARTH.regular_faces
UGRID = {
    "cf_role": "mesh_topology", "topology_dimension": 2, "node_coordinates": "lon lat",
    "face_node_connectivity": "faces",
}  # fmt: skip


def written(folder, table, *, names=("lon", "lat"), scale=1.0, units="degrees", topology=None):
    """Write the globe with a value for each node and each face, and return the path."""
    x, y = names
    variables = {
        "warmth": (("time", "node"), np.stack([LAT, LON])),
        "rain": (("face", "level"), np.arange(2.0 * len(FACES)).reshape(-1, 2)),
        x: ("node", scale * LON, {"units": units}),
        y: ("node", scale * LAT, {"units": units}),
        "faces": table,
    }
    if topology is not None:
        variables["mesh"] = ((), 0, topology)
    path = folder / "mesh.nc"
    xr.Dataset(variables, coords={"time": ("time", [0.0, 6.0])}).to_netcdf(path)
    return path


TABLES = {
    "from 0": (("face", "three"), FACES),
    "from 1": (("face", "three"), FACES + 1),
    "by columns": (("three", "face"), FACES.T + 1),
    "of four": (("face", "four"), np.pad(FACES, ((0, 0), (0, 1)), constant_values=-1)),
    "repeated": (("face", "four"), np.pad(FACES, ((0, 0), (0, 1)), mode="edge")),
}


@pytest.mark.parametrize("table", TABLES.values(), ids=TABLES)
@pytest.mark.parametrize("topology", [None, UGRID])
def test_spellings(tmp_path, table, topology):
    path = written(tmp_path, table, topology=topology)
    mesh = vizlight.read(path, time="first")
    assert mesh.field_data["unit"][0] == "degree"
    # The whole map is covered once: faces across 180 degrees are cut, those at poles reach along.
    assert mesh.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 180, rel=1e-5)
    assert mesh.bounds[:4] == pytest.approx((-180, 180, -90, 90), abs=1e-4)
    np.testing.assert_allclose(mesh["warmth"], mesh.points[:, 1], atol=1e-4)
    rain = mesh.cell_data["rain"]
    np.testing.assert_array_equal(rain[: len(FACES)], 2.0 * np.arange(len(FACES)))
    lat = LAT[FACES].mean(axis=1)[(rain / 2).astype(int)]
    assert np.abs(mesh.cell_centers().points[:, 1] - lat).max() < 5
    assert "first of level" in mesh.field_data["meaning"][0]


def test_tables_of_a_mesh_are_no_data(tmp_path):
    path = written(tmp_path, TABLES["from 0"], topology=UGRID | {"edge_node_connectivity": "edges"})
    roles = {"face_edges": "face_edge_connectivity", "face_links": "face_face connectivity"}
    with xr.open_dataset(path) as file:
        data = file.load()
    for name, role in roles.items():
        data[name] = (("face", "three"), FACES.astype(float), {"cf_role": role})
    data["edges"] = (("face", "two"), FACES[:, :2])
    data.to_netcdf(tmp_path / "b.nc")
    mesh = vizlight.read(tmp_path / "b.nc")
    assert {*mesh.point_data, *mesh.cell_data} == {"warmth", "rain"}


def test_radians(tmp_path):
    path = written(
        tmp_path, TABLES["from 1"], names=("lonVertex", "latVertex"),
        scale=np.pi / 180, units="radian",
    )  # fmt: skip
    assert vizlight.read(path).bounds[2:4] == pytest.approx((-90, 90), abs=1e-3)


def test_places_beyond_the_poles_are_no_degrees(tmp_path):
    path = written(tmp_path, TABLES["from 0"], scale=1e4, units="", topology=UGRID)
    mesh = vizlight.read(path)
    assert mesh.bounds_size[1] > 1e6
    assert mesh.field_data.get("unit", [""])[0] != "degree"


def test_a_node_that_is_not_there(tmp_path):
    table = (("face", "three"), FACES + 2, {"start_index": 1})
    refused(written(tmp_path, table, topology=UGRID), "'faces' has the node 643 of 642")


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"face_node_connectivity": ""}, "the mesh 'mesh' of UGRID has no faces"),
        ({"face_node_connectivity": "cells"}, "names 'cells', which is not there"),
    ],
)
def test_a_topology_that_is_not_whole(tmp_path, change, reason):
    refused(written(tmp_path, TABLES["from 0"], topology=UGRID | change), reason)


def test_counts_on_a_grid_are_no_table(tmp_path):
    counts = np.arange(24).reshape(8, 3)
    data = xr.Dataset({"count": (("y", "x"), counts)}, coords={"y": np.arange(8.0), "x": [0, 1, 2]})
    data["lon"], data["lat"] = ("station", np.arange(30.0)), ("station", np.arange(30.0))
    data.to_netcdf(tmp_path / "a.nc")
    assert isinstance(vizlight.read(tmp_path / "a.nc"), pv.ImageData)


def test_a_table_alone_is_no_image(tmp_path):
    data = {"elements": TABLES["from 1"], "depth": ("node", LAT)}
    xr.Dataset(data).to_netcdf(tmp_path / "a.nc")
    refused(tmp_path / "a.nc", "'elements' seems a table of the nodes of faces")


def test_meshes_of_fewer_faces_than_corners():
    places = {"lon": ("node", [0.0, 1, 0, 1, 2]), "lat": ("node", [0.0, 0, 1, 1, 0])}
    table = {"ikle": (("face", "three"), [[0, 1, 2], [1, 4, 3]])}
    mesh = vizlight.read(xr.Dataset({"h": ("node", np.arange(5.0)), **table, **places}))
    assert mesh.n_cells == 2
    np.testing.assert_array_equal(mesh["h"], np.arange(5))
    table = {"nv": (("three", "nele"), np.array([[0, 1, 2], [1, 3, 2], [1, 4, 3], [2, 3, 0]]).T)}
    assert (
        vizlight.read(xr.Dataset({"h": ("node", np.arange(5.0)), **table, **places})).n_cells == 4
    )
    table = {"faces": (("face", "four"), [[0, 1, 3, 2], [1, 4, 3, -1]])}
    values = {"v": ("face", [5.0, 6]), "mesh": ((), 0, UGRID)}
    mesh = vizlight.read(xr.Dataset({**values, **table, **places}))
    np.testing.assert_allclose(mesh.compute_cell_sizes()["Area"], [1, 0.5])
    np.testing.assert_array_equal(mesh["v"], [5, 6])


def test_names_of_nodes_and_rows_that_0_fills(tmp_path):
    node = np.arange(4.0)
    data = {
        "grid_node_x": ("node", node % 2),
        "grid_node_y": ("node", node // 2),
        "quads": (("face", "corner"), np.array([[1, 2, 4, 3], [1, 2, 4, 0]])),
        "T": ("node", node),
    }
    xr.Dataset(data).to_netcdf(tmp_path / "a.nc")
    mesh = vizlight.read(tmp_path / "a.nc")
    assert [mesh.get_cell(i).n_points for i in range(2)] == [4, 3]
    assert mesh.area == pytest.approx(1.5)
    # A temperature T is no time.
    assert {"T"} == {*mesh.point_data}
    assert "TimeValue" not in mesh.field_data
    data["tets"] = data.pop("quads")
    xr.Dataset(data).to_netcdf(tmp_path / "b.nc")
    refused(tmp_path / "b.nc", "'tets' has the nodes of solids")


def test_a_mesh_of_esmf():
    data = {
        "nodeCoords": (("nodeCount", "coordDim"), np.stack([LON, LAT], 1), {"units": "degrees"}),
        "elementConn": (("elementCount", "maxNodePElement"), FACES + 1),
        "elementArea": ("elementCount", np.arange(float(len(FACES)))),
    }
    mesh = vizlight.read(xr.Dataset(data))
    assert mesh.field_data["unit"][0] == "degree"
    assert mesh.bounds[:4] == pytest.approx((-180, 180, -90, 90))
    whole = np.bincount(np.asarray(mesh["elementArea"], dtype=int), minlength=len(FACES))
    assert whole.min() == 1


def test_winds_at_the_nodes_of_a_mesh_turn_with_the_meridians():
    """Solid rotation is rotation at each point, at the poles and where faces are cut too."""
    about = np.array([0.3, -0.5, 0.8])

    def east_and_north(lon, lat):
        lon, lat = np.radians(lon), np.radians(lat)
        up = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
        east = np.stack([-np.sin(lon), np.cos(lon), 0 * lon], axis=-1)
        wind = np.cross(about, up)
        return (wind * east).sum(axis=-1), (wind * np.cross(up, east)).sum(axis=-1)

    u, v = east_and_north(LON, LAT)
    places = {"lon": ("node", LON, {"units": "degrees"}), "lat": ("node", LAT)}
    wind = {"u": ("node", u), "v": ("node", v)}
    mesh = vizlight.read(xr.Dataset({**wind, **places, "faces": (("face", "three"), FACES)}))
    right = east_and_north(*np.asarray(mesh.points, dtype=float).T[:2])
    assert np.abs(np.stack([mesh["u"], mesh["v"]]) - right).max() < 0.02


def test_rivers_beside_the_land(tmp_path):
    path = written(tmp_path, TABLES["from 0"], topology=UGRID)
    with xr.open_dataset(path) as file:
        land = file.load()
    ends = {"cf_role": "edge_node_connectivity"}
    role = {"cf_role": "mesh_topology", "node_coordinates": "rx ry"}
    rivers = {
        "channels": ((), 0, role | {"topology_dimension": 1, "edge_node_connectivity": "ends"}),
        "rx": ("bank", [0.0, 1, 2], {"units": "degrees_east"}),
        "ry": ("bank", [0.0, 0, 0], {"units": "degrees_north"}),
        "ends": (("river", "two"), [[0, 1], [1, 2]], ends),
        "flow": ("river", [1.0, 2], {"location": "edge"}),
    }
    mesh = vizlight.read(xr.Dataset(rivers).merge(land))
    np.testing.assert_array_equal(mesh["rain"], vizlight.read(path)["rain"])
    assert "left out, on edges: flow" in mesh.field_data["meaning"][0]


def test_values_without_their_mesh(tmp_path):
    path = written(tmp_path, TABLES["from 0"], topology=UGRID)
    with xr.open_dataset(path) as file:
        mesh, values = file.drop_vars(["warmth", "rain"]), file[["rain"]].load()
        with pytest.raises(ValueError, match="'rain' are values along 'face' without places"):
            vizlight.read(values)
        whole = vizlight.read(xr.merge([mesh, values]))
    np.testing.assert_array_equal(whole["rain"], vizlight.read(path)["rain"])
