"""Smaller views beside the main one."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.looks.framing import apart
from vizlight.mesh import meaning


def ball(values):
    mesh = pv.Sphere(theta_resolution=40, phi_resolution=40).scale((3, 2, 1.8))
    mesh["heat"] = values(*np.asarray(mesh.points, dtype=np.float64).T)
    return mesh


def block(values):
    mesh = pv.ImageData(
        dimensions=(21, 17, 13), spacing=(1.0, 1.0, 1.0)
    ).cast_to_unstructured_grid()
    rows = values(*np.asarray(mesh.points, dtype=np.float64).T)
    mesh["values"] = np.stack(rows, axis=1) if isinstance(rows, tuple) else rows
    return mesh


def shown(mesh, **options):
    """Return the names of insets, and the look."""
    look = vizlight.look(mesh, **options)
    strip = look.wishes.strip
    return [] if strip is None else [inset.name for inset in strip.insets], look


def test_the_far_side_of_a_body_is_shown_where_its_values_are_others():
    names, look = shown(ball(lambda x, y, z: x))
    assert len(names) == 1
    assert names[0].startswith("From b")
    # It is seen from where the main view sees nothing.
    (inset,) = look.wishes.strip.insets
    assert np.dot(inset.toward, look.drawing.camera.run().direction) > 0.5
    assert shown(ball(lambda x, y, z: x**2))[0] == []


@pytest.mark.parametrize("options", [{"view": "x"}, {"size": (400, 300)}, {"question": "shape"}])
def test_a_view_that_is_asked_for_stands_alone(options):
    question = options.pop("question", "auto")
    look = vizlight.look(ball(lambda x, y, z: x), question, **options)
    assert look.wishes.strip is None
    assert not look.drawing.insets


def test_a_flow_has_the_section_in_which_it_runs():
    x, y, z = 0.1, 1.0, 0.5
    turning = block(lambda px, py, pz: (x * pz, y * (pz - 6) + 0.3, z * (8 - py)))
    names, look = shown(turning)
    assert names == ["Section x = 10"]
    # The picture has room for it, pages and movies have the main view.
    assert look.view.focal_point != look.drawing.camera.run().focal_point
    assert not look.drawing.of_turns.insets
    paths = [layer.mesh.path for layer in look.drawing.insets]
    assert paths.count("render.inset") >= 2
    assert paths[-1] == "render.captions"
    # It is in front of nothing: insets lie outside of the room of the main view.
    camera = look.drawing.camera.run()
    ends = [layer.mesh.run() for layer in look.drawing.insets[:-1]]
    main = look.drawing.layers[-1].mesh.run()
    right = np.cross(camera.direction, camera.up)
    below = -np.asarray(camera.up)
    apart_by = max(
        min(np.min(np.asarray(mesh.points) @ way) for mesh in ends)
        - np.max(np.asarray(main.points) @ way)
        for way in (right, below)
    )
    assert apart_by > 0


def test_a_section_through_what_mostly_stands_still_is_not_shown():
    def in_vessel(x, y, z):
        inside = (y - 8) ** 2 + (z - 6) ** 2 < 0.5
        return inside * (8 - y), inside * (x - 10), 0.1 * inside

    assert shown(block(in_vessel))[0] == []


def test_a_flow_without_speeds_has_a_grey_section():
    around = block(lambda x, y, z: (8 - y, x - 10, 0.1 + 0 * z))
    around["values"] /= np.linalg.norm(around["values"], axis=1)[:, np.newaxis]
    names, look = shown(around)
    assert names == ["Section z = 6"]
    section = look.drawing.insets[0].keywords
    assert "color" in section
    assert "scalars" not in section


def test_a_solid_has_a_section_where_it_shows_other_values():
    pipe = pv.CylinderStructured(
        radius=np.linspace(0.1, 1, 8), height=5, theta_resolution=30, z_resolution=20
    ).cast_to_unstructured_grid()
    along, *across = np.asarray(pipe.points, dtype=np.float64).T
    for values, expected in (
        (along, []),
        (np.exp(-8 * np.square(across).sum(axis=0)), ["Section y = 0"]),
    ):
        pipe["stress"] = values
        names, look = shown(pipe)
        assert look.shown == "hull"
        assert names == expected


def test_strokes_that_would_be_crowded_are_left_out_of_a_small_view():
    globe = pv.Sphere(theta_resolution=60, phi_resolution=60)
    x, y, z = np.asarray(globe.points, dtype=np.float64).T
    globe["wind"] = (2 + 3 * x)[:, np.newaxis] * np.column_stack([-y, x, 0 * z])
    names, look = shown(globe)
    assert len(names) == 1
    drawn, small = look.drawing.layers, look.drawing.insets
    assert any("width" in layer.keywords for layer in drawn)
    assert not any("width" in layer.keywords for layer in small)


def test_kinds_in_another_one_have_no_section_with_it():
    mesh = block(lambda x, y, z: x).point_data_to_cell_data()
    places = mesh.cell_centers().points - np.asarray(mesh.center)
    mesh.cell_data["part"] = np.where(np.abs(places).max(axis=1) < 4, 1, 2)
    names, look = shown(mesh, array="part")
    assert names == []
    assert any("left out" in note for note in look.drawing.notes)


def test_a_bundle_in_a_body_is_shown_from_three_sides():
    turns = np.linspace(0, 3, 40)
    bundle = [
        pv.lines_from_points(
            np.stack([5 * np.cos(turns) + k, 30 * turns, 40 * np.sin(turns)], axis=1)
        )
        for k in range(8)
    ]
    lines = pv.merge(bundle, merge_points=False)
    assert shown(lines)[0] == []
    meaning.attach(lines, meaning.Meaning(axes=[*meaning.ANATOMY]))
    names, look = shown(lines)
    assert names == ["From the front", "From above"]
    # A front is seen with the left of the body at the right.
    assert [inset.ends for inset in look.wishes.strip.insets] == ["RL", "LR"]


def test_distributions_are_apart_by_the_share_that_is_elsewhere():
    values, ones = np.array([1.0, 2.0, 3.0, 4.0, np.nan]), np.ones(5)
    assert apart(values, ones, ones) == 0
    assert apart(values, np.array([1, 1, 0, 0, 1]), np.array([0, 0, 1, 1, 1])) == 1
    assert np.isclose(apart(values, np.array([1, 1, 1, 1, 0]), np.array([0, 0, 1, 1, 0])), 0.5)
