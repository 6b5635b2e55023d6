"""Several views in one picture: those that are asked for, and both sides of a cortex."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.mesh import meaning
from vizlight.reading import brains


def cortex():
    mesh = pv.Icosphere(radius=1, nsub=5).scale((34, 85, 60)).translate((35, 0, 0))
    mesh["thickness"] = np.cos(np.asarray(mesh.points)[:, 1] / 9)
    return mesh


def shown(mesh, **options):
    drawing = vizlight.look(mesh, **options).drawing
    return [layer.mesh.path for layer in drawing.layers]


def test_a_view_or_a_turn_shows_one_side():
    mesh = cortex()
    assert shown(mesh, view="x") == ["-"]
    turned = vizlight.look(mesh).drawing.of_turns
    assert [layer.mesh.path for layer in turned.layers] == ["-"]
    assert turned.camera.run().focal_point == pytest.approx((35, 0, 0), abs=1e-3)


def test_a_hemisphere_of_the_cortex_has_named_sides_and_a_unit():
    mesh = cortex()
    assert brains.hemisphere(mesh) == "right"
    assert brains.hemisphere(mesh.translate((-70, 0, 0))) == "left"
    assert brains.hemisphere(mesh.translate((-35, 0, 0))) == ""
    assert brains.hemisphere(mesh.scale(0.1)) == ""
    # One that is inflated lies around the origin, and is larger.
    inflated = mesh.scale(1.4).translate(-1.4 * np.array(mesh.center))
    inflated.rename_array("thickness", "lh.thickness")
    assert brains.hemisphere(inflated) == "left"
    drawing = vizlight.look(mesh).drawing
    blocks = drawing.layers[0].mesh.arguments[0].run()
    assert blocks.keys() == ["Right hemisphere, lateral", "Right hemisphere, medial"]
    assert drawing.keys[0]["title"] == "cortical thickness (mm)"
    mesh["curv_left"] = mesh["thick_left"] = mesh["thickness"]
    assert vizlight.look(mesh, array="curv_left").key[0]["title"] == "curvature (1/mm)"
    assert vizlight.look(mesh, array="thick_left").key[0]["title"] == "cortical thickness (mm)"
    # Its front is at the right of the lateral side, which is the right one, toward x.
    captions = drawing.layers[-1].mesh
    assert captions.path == "render.captions"
    assert captions.keywords["ends"] == [["posterior", "anterior"], ["anterior", "posterior"]]
    assert captions.keywords["unit"] == "mm"
    assert drawing.layers[0].mesh.arguments[0].arguments[1][0] == (1.0, 0.0, 0.0)


def hemisphere(side):
    mesh = pv.Icosphere(radius=1, nsub=5).scale((34, 85, 60))
    mesh[f"{side[0]}h.thickness"] = np.cos(np.asarray(mesh.points)[:, 1] / 9)
    return mesh


def test_two_hemispheres_have_four_views_though_they_are_in_one_place():
    drawing = vizlight.look([hemisphere("left"), hemisphere("right")]).drawing
    blocks = [layer.mesh for layer in drawing.layers if layer.mesh.path == "[]"]
    names = [
        f"{side} hemisphere, {view}" for view in ("lateral", "medial") for side in ("Left", "Right")
    ]
    shown = [block.arguments[0].run().keys()[block.arguments[1]] for block in blocks]
    assert sorted(shown) == sorted(names)
    # Each has a place of its own, and words around all of them stand once.
    boxes = [np.reshape(block.run().bounds, (3, 2)) for block in blocks]
    for i, one in enumerate(boxes):
        for other in boxes[:i]:
            apart = (one[1:, 1] < other[1:, 0]) | (other[1:, 1] < one[1:, 0])
            assert apart.any()
    paths = [layer.mesh.path for layer in drawing.layers]
    assert paths.count("render.captions") == 1
    assert "see-through" not in " ".join(drawing.notes)


def test_a_picture_has_the_views_that_are_asked_for(tmp_path):
    part = pv.Box((0, 40, 0, 20, 0, 12)).triangulate()
    look = vizlight.look(part, view=["front", "side", (0, 0, 1)])
    first = look.drawing.layers[0].mesh.arguments[0].run()
    assert first.keys() == ["Front", "Side", "From (0, 0, 1)"]
    # Edges are turned like faces, and all are seen.
    blocks = [layer.mesh.run() for layer in look.drawing.layers if layer.mesh.path == "[]"]
    assert len(blocks) == 6
    camera = look.view
    assert camera.parallel_projection
    assert camera.direction == pytest.approx((0, 1, 0))
    for block in blocks:
        middle = np.subtract(block.center, camera.focal_point)
        assert np.abs(middle[2]) < camera.parallel_scale
    assert look.key[0]["title"] == "size 40 × 20 × 12"
    assert look.mesh.n_cells == part.n_cells
    for name in ("page.html", "turn.mp4"):
        with pytest.raises(ValueError, match="view: expected one view for"):
            look.save(tmp_path / name)
    with pytest.raises(ValueError, match="view: expected views that differ"):
        vizlight.look(part, view=["front", "-y"])
    with pytest.raises(ValueError, match="view: expected a direction"):
        vizlight.look(part, view=["front", "beside"])


def test_a_bar_of_lengths_stands_where_a_file_says_its_unit():
    vessels = pv.ParametricTorus()
    assert "render.captions" not in shown(vessels)
    vessels.field_data["unit"] = ["millimetre"]
    drawing = vizlight.look(vessels).drawing
    bar = drawing.layers[-1]
    assert bar.mesh.path == "render.captions"
    assert bar.mesh.keywords["unit"] == "mm"
    assert not bar.keywords["pickable"]
    assert "render.captions" not in [layer.mesh.path for layer in drawing.of_turns.layers]


def test_letters_of_a_body_stand_at_its_sides():
    vessels = pv.ParametricTorus().scale((60, 60, 60))
    meaning.attach(vessels, meaning.Meaning(axes=[*meaning.ANATOMY]))
    vessels.field_data["unit"] = ["millimetre"]
    look = vizlight.look(vessels, view="back")
    assert look.drawing.layers[-1].mesh.keywords["ends"] == [["R", "L"]]
    assert vizlight.look(vessels, view="right").drawing.layers[-1].mesh.keywords["ends"] == [
        ["P", "A"]
    ]
    assert "ends" not in vizlight.look(vessels, view="iso").drawing.layers[-1].mesh.keywords
