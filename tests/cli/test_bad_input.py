"""Bad input is one line on standard error that says what was expected, and leaves nothing."""

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("light no.vtp", "file: expected a file, got 'no.vtp' (no such file)"),
        ("light .", "file: expected a file, got '.' (a folder)"),
        ("light flow.vti -o flow.vti --no-surface", "another file than the input"),
        ("light flow.vti --level 3", "level: expected contour with it"),
        ("light flow.vti --background nocolor", "background: expected a colour's name"),
        ("light flow.vti --line-width -1", "--line-width: expected a number from 0.1"),
        ("light flow.vti --size 9000x100", "size: expected at most 8192 pixels per side"),
        ("light flow.vti --view 0,0,1 --up 0,0,2", "up: expected a direction across"),
        ("light bad.vtp", "file: expected a mesh that PyVista reads"),
        # It has a line more than it states, which is a note of a file that is lit.
        pytest.param(
            "light more.ply -o a.vti",
            "output: expected a name that ends in .vtp",
            marks=pytest.mark.filterwarnings("default"),
        ),
        ("light", "requires an argument"),
        ("light flow.vti --tangents U", "tangents: expected the name of an array, one of"),
        ("light flow.vti --tangents r", "tangents: expected vectors"),
        ("light flow.vti --no-surface -o x.vti --normals C", "got the cell array 'C'"),
        ("light flow.vti --contour V", "contour: expected an array of one"),
        ("light flow.vti --contour r --level 99", "level: expected a value between"),
        ("light flow.vti -o x.xyz", "output: expected a name that ends in"),
        ("light flow.vti -o none/x.vtp", "output: expected a folder that exists"),
        ("light flow.vti --array r -o x.vti", "output: expected a name that ends in .vtp"),
        ("light flow.vti --light 0,0,0", "--light: expected a direction x,y,z, not all zero"),
        ("light flow.vti --light 1", "--light: expected three numbers x,y,z"),
        ("light flow.vti --color nothing", "color: expected a colour's name"),
        ("light flow.vti --size big", "--size: expected WIDTHxHEIGHT"),
        ("light flow.vti --size 0x5", "size: expected an integer of at least 1"),
        ("light flow.vti --shininess -1", "shininess: expected"),
        ("light flow.vti --shininess x", "--shininess"),
        ("light flow.vti --model x", "--model"),
        ("light flow.vti --bogus", "--bogus"),
        ("demo --out bad.vtp", "out: expected a folder that can be made"),
        ("nothing", "nothing"),
        ("streamlines flow.vti --tangents U", "tangents: expected the name of an array, one of"),
        ("streamlines flow.vti --step 0", "step: expected"),
        ("streamlines flow.vti --seeds x", "--seeds"),
        ("streamlines flow.vti --tangents V --confined", "surface: expected a surface"),
        ("streamlines flow.vti --seeds 9 -o a.vti", "ends in .vtp, .vtk, .vtu, .stl for PolyDat"),
        ("relief torus.vtp --depth -1", "depth: expected"),
        ("relief terrain.vti -o a.vtp", "ends in .vti, .vtk, .stl for ImageData"),
        ("fur flow.vti --contour r --density 0.1 --absorption 0.2", "absorption, density: exp"),
        ("fur flow.vti --contour r --density 2", "density: expected a number from 0 to 1"),
        ("fur flow.vti --contour r --density 0.1 --toward up --bend 1", "toward: expected"),
        ("contours flow.vti --levels much", "--levels: expected a number"),
        ("contours flow.vti --levels 0", "levels: expected"),
        ("project torus.vtp --rotation xw", "--rotation: expected PLANE:ANGLE"),
        ("project torus.vtp --rotation xq:1", "expected"),
        ("project torus.vtp --hyperplane 1,2", "--hyperplane: expected NORMAL:OFFSET"),
        ("project torus.vtp --light 1,2,3,4,5", "--light: expected three numbers x,y,z or 4"),
        ("project torus.vtp --view 1,2,3,4,5", "view: expected three numbers x,y,z or 4"),
        ("light flow.vti --light 10,95", "altitude: expected degrees from -90 to 90"),
        ("light flow.vti --light nan,1,2", "--light: expected three numbers"),
        ("light flow.vti --slice 1,2", "slice: expected NORMAL:OFFSET"),
        ("light flow.vti --slice x:1 --contour r", "slice: expected no contour beside it"),
        ("light flow.vti --clip 0,0,0:1", "clip: expected NORMAL:OFFSET"),
        ("light flow.vti --clip x:-9", "clip: expected a value that leaves points"),
        ("light flow.vti --slice x:99", "slice: expected a value that leaves points"),
        ("light flow.vti --threshold r", "threshold: expected NAME:LOW:HIGH"),
        ("light flow.vti --threshold r:3:1", "threshold: expected NAME:LOW:HIGH"),
        ("light flow.vti --threshold q:3:4", "threshold: expected the name of an array, one of"),
        ("light flow.vti --threshold r:99:", "threshold: expected a value that leaves"),
        ("light flow.vti --scalars U", "scalars: expected the name of an array, one of"),
        ("light flow.vti --scalars r --cmap no", "cmap: expected a colour map or colours that"),
        ("light flow.vti --scene no.json", "--scene: expected a JSON file, got 'no.json' (No such"),
        ("light flow.vti --scene flow.vti", "--scene: expected a JSON file"),
        ("light flow.vti --scene list.json", "--scene 'list.json': values: expected a dict of"),
        ("light flow.vti --for shape --headlight", "--for: expected lights of its own, got --head"),
        ("light flow.vti --view 0,0,0", "--view: expected one of x, -x"),
        ("light flow.vti --contour r --scalars r --for shape", "--for shape: expected no --scalar"),
        ("light flow.vti --view list.json", "--view: expected a JSON list of the camera's"),
        ("light flow.vti --view no.json", "--view: expected a JSON file"),
        ("light flow.vti --view up", "--view: expected one of x, -x"),
        ("light flow.vti flow.vti", "file: expected files of different names"),
        ("light flow.vti torus.vtp -o a.png --times all", "one time for several files"),
        ("light flow.vti -o none/a.png", "output: expected a folder that exists, got 'none'"),
        ("light flow.vti --array r -o a.vtm", "it is one mesh, which has no blocks"),
        ("light flow.vti --tangents r,q", "tangents: expected the name of an array, one of"),
        ("light terrain.vti --for slope", "expected vectors for 'slope', got"),
        ("light scan.vtp --for slope", "take --for shape"),
        ("fur scan.vtp", "mesh: expected a surface with faces, got a PolyData mesh without"),
        ("view none.vtp", "no such file"),
        ("view torus.vtp -o page.png", "ends in .html"),
        ("view torus.vtp --tangents W", "tangents"),
        ("view torus.vtp --port 80", "--port"),
        ("light flow.vti -o no.vtp --refine 1e-9", "--refine: expected a number of at least 1e-05"),
        (
            "light flow.vti -o no.pvtp --refine 0.01",
            "expected one mesh, got pieces; refine their uni",
        ),
        (
            "light flow.vti -o no.pvtp --legibility",
            "--legibility: expected one mesh, lit as a whole",
        ),
        ("light torus.vtp -o no.vtp --bundle", "bundle: expected a mesh with lines"),
        ("light flow.vti -o a.vtp --workers 2", "an output that ends in .pvtp"),
        ("light flow.vti -o a.html --workers 2", "of pieces, beside --workers, got a.html"),
        ("light flow.vti -o a.pvtp -o a.html", "by 'vizlight light a.pvtp -o a.html'"),
        ("light flow.vti -o a.pvtp -o b.pvtp", "one index of pieces"),
        ("light flow.vti -o a.pvtp --workers 0", "--workers: expected an integer of at least 1"),
        ("light flow.vti -o a.pvtp --workers 2 --scheduler x", "--workers or --scheduler"),
        ("light flow.vti -o a.pvtp --clip x:2", "--clip: expected no such option for pieces"),
        ("light flow.vti -o a.pvtp --contour s", "contour: expected a point array of one compo"),
        ("light flow.vti -o a.pvtp --contour r --level 99", "level: expected a value between"),
        ("light flow.vti -o a.pvtp --up 1,1,1", "up: expected a direction across the view"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(line, words, folder, monkeypatch, refused):
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    Path("list.json").write_text("[1, 2]")
    Path("bad.vtp").write_text("garbage")
    pv.Triangle().save("more.ply", binary=False)
    Path("more.ply").write_text(f"{Path('more.ply').read_text()}1 2 3\n")
    pv.PolyData(np.random.default_rng(0).random((30, 3))).save("scan.vtp")
    before = sorted(folder.iterdir())
    err = refused(line)
    assert err.startswith("vizlight: ")
    assert words in err
    assert err.count("\n") == 1
    assert sorted(folder.iterdir()) == before
