"""Every filter takes what files hold: blocks, volumes, arrays of cells, cells of all kinds."""

import numpy as np
import pytest
import pyvista as pv
from fields import several_kinds

import vizlight
from vizlight import Scene, View, files
from vizlight.mesh import blocks

SCENE = Scene(view=View(direction=(1, 1, 1)))
#: Filters, and how each is called for a mesh with the vectors U and the values p.
FILTERS = {
    "illuminate": lambda mesh: vizlight.illuminate(mesh, SCENE),
    "refine": lambda mesh: vizlight.refine(mesh, SCENE, error=0.2),
    "fur": lambda mesh: vizlight.fur(mesh, SCENE, fibres=30, length="p"),
    "isoluminance": lambda mesh: vizlight.isoluminance(mesh, SCENE, levels=3),
    "relief_shadow": lambda mesh: vizlight.relief_shadow(mesh, SCENE),
    "relief_day": lambda mesh: vizlight.relief_day(mesh, sun=[(0, 40)]),
    "bas_relief": lambda mesh: vizlight.bas_relief(mesh, resolution=20),
    "streamlines": lambda mesh: vizlight.streamlines(mesh, SCENE, tangents="U", seeds=5),
    "tint": lambda mesh: vizlight.tint(vizlight.illuminate(mesh, SCENE), "p"),
    "surface_of": files.surface_of,
}


def volume():
    grid = pv.ImageData(dimensions=(5, 5, 5)).cast_to_unstructured_grid()
    grid["U"] = np.tile([1.0, 0.3, 0.1], (grid.n_points, 1))
    grid["p"] = 0.1 + 0.01 * grid.points[:, 0]
    return grid


def case():
    """Return blocks as a reader of OpenFOAM does: the cells, and the patches around them."""
    inner = volume()
    walls = pv.MultiBlock({"walls": inner.extract_surface(algorithm="geometry")})
    return pv.MultiBlock({"internalMesh": inner, "boundary": walls})


def of_cells():
    grid = volume()
    return grid.point_data_to_cell_data()


def cells_of_several_kinds():
    mesh, _ = several_kinds()
    mesh["U"] = np.tile([1.0, 0.3, 0.1], (mesh.n_points, 1))
    mesh["p"] = np.full(mesh.n_points, 0.1)
    return mesh


MESHES = {
    "volume": volume,
    "tetrahedra": lambda: volume().triangulate(),
    "case": case,
    "arrays of cells": of_cells,
    "cells of several kinds": cells_of_several_kinds,
}


@pytest.mark.parametrize("filter_", FILTERS)
@pytest.mark.parametrize("mesh", MESHES)
@pytest.mark.filterwarnings("ignore:.*(sharper than|could not be lit|no normal|shadows end within)")
def test_every_filter_takes_every_mesh(filter_, mesh):
    made = FILTERS[filter_](MESHES[mesh]())
    assert sum(block.n_points for block in blocks.all_blocks(made))
    lit = [block for block in blocks.all_blocks(made) if "luminance" in block.point_data]
    for block in lit:
        assert np.isfinite(block.point_data["luminance"]).all()
    assert lit or filter_ in {*FILTERS} - {"illuminate", "refine", "fur", "streamlines", "tint"}


def test_lines_in_a_case_are_those_in_its_cells():
    one = vizlight.streamlines(volume(), SCENE, tangents="U", seeds=9)
    other = vizlight.streamlines(case(), SCENE, tangents="U", seeds=9)
    np.testing.assert_allclose(one.points, other.points)


def test_a_field_of_heights_in_cells_casts_shadows():
    grid = pv.ImageData(dimensions=(9, 9, 1))
    grid["h"] = np.sin(grid.points[:, 0])
    of_cells = grid.point_data_to_cell_data()
    means = of_cells.cell_data_to_point_data()
    np.testing.assert_array_equal(
        vizlight.relief_shadow(of_cells, SCENE, elevation="h")["t"],
        vizlight.relief_shadow(means, SCENE, elevation="h")["t"],
    )


def test_the_remedy_for_a_partitioned_dataset_helps():
    parts = pv.PartitionedDataSet([pv.Sphere(), pv.Plane()])
    with pytest.raises(TypeError, match=r"pyvista\.MultiBlock\(list\(mesh\)\)"):
        vizlight.illuminate(parts)
    assert vizlight.illuminate(pv.MultiBlock(list(parts))).n_blocks == 2


@pytest.mark.parametrize("scale", [2.0, (3.0, 1.0, 0.5)])
def test_images_that_are_turned_move_like_their_points(scale):
    turned = pv.ImageData(dimensions=(3, 4, 2), origin=(1, 2, 3))
    turned.direction_matrix = pv.Transform().rotate_z(30).matrix[:3, :3]
    moved = blocks.moved(turned, np.array([5.0, 6, 7]), np.array(scale))
    np.testing.assert_allclose(
        moved.points, np.array(scale) * (turned.points + np.array([5, 6, 7]))
    )
