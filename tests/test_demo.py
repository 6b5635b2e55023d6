"""The demo's light is light on a flow: its highlight lies where the mirror direction says."""

from __future__ import annotations

import numpy as np
import pytest

from vizlight import demo, engine


@pytest.fixture(scope="module")
def made():
    return demo.light_flow()


def test_errors_of_the_table(made):
    _, _, rows, _ = made
    assert [row.light for row in rows] == ["as a surface", "by the flow"]
    for row in rows:
        assert 0 < row.error < 2e-6
        assert row.points == 11209
        assert row.terms == "ambient + diffuse + specular"


def test_the_highlight_of_the_flow_is_on_the_cone_of_reflection():
    surface = demo.flow_surface()
    scene, _ = demo.flow_scene(surface.bounds)
    points, flow = np.asarray(surface.points, float), np.asarray(surface["V"], float)
    shaded = engine.shade(points, flow, scene, components=True)
    tangent = flow / np.linalg.norm(flow, axis=1, keepdims=True)
    wi = np.array(demo.TOWARD_LIGHT) / np.linalg.norm(demo.TOWARD_LIGHT)
    wo = scene.view.position - points
    wo /= np.linalg.norm(wo, axis=1, keepdims=True)
    # Light and eye make supplementary angles with the line where the cone meets the eye.
    miss = np.abs(np.arccos(tangent @ wi) + np.arccos(np.sum(tangent * wo, axis=1)) - np.pi)
    assert miss[np.argmax(shaded.specular)] < 0.01
    assert np.argmin(miss) in np.argsort(shaded.specular)[-50:]
    order = np.argsort(miss)
    assert np.all(np.diff(shaded.specular[order]) < 1e-6)


def test_the_surface_faces_outward(made):
    lit = made[0]
    outward = lit.points - np.array(lit.center)
    outward[:, 2] = 0
    side = np.linalg.norm(outward, axis=1) > 3
    assert np.einsum("ij,ij->i", lit["Normals"], outward)[side].mean() > 0


def test_flow_and_surface_are_different_light(made):
    lit = made[0]
    assert np.corrcoef(lit["surface_light"], lit["flow_light"])[0, 1] < 0.9
    assert lit["flow_light"].max() <= 1.0
