"""A project of its own takes the fixture by one line of its conftest.py."""

import numpy as np
import pytest
from PIL import Image

pytest_plugins = ["pytester"]

TEST = """
    import numpy as np
    import pytest

    @pytest.mark.parametrize("kind", ["a/b"])
    def test_disc(same_picture, kind):
        y, x = np.mgrid[:60, :90]
        disc = 200 * (np.hypot(x - 45, y - 30) < 20) + {added}
        picture = np.repeat(disc[..., None], 3, axis=2).astype(np.uint8)
        assert same_picture(picture).block == 0
        same_picture(picture, "again", {limits})
"""
KEPT = "pictures/test_flow/test_disc-a-b.png", "pictures/test_flow/test_disc-a-b-again.png"


@pytest.fixture
def project(pytester):
    """Return a run of the tests of a foreign project, whose picture may have grown brighter."""
    pytester.makeconftest('pytest_plugins = ["vizlight.draw.snapshots"]')

    def run(*options, added=0, limits=""):
        pytester.makepyfile(test_flow=TEST.format(added=added, limits=limits))
        return pytester.runpytest_inprocess("-p", "no:pytest-pyvista", *options)

    return run


def test_a_missing_picture_is_asked_for_stored_and_compared(project, pytester):
    missing = project()
    missing.assert_outcomes(failed=1)
    missing.stdout.fnmatch_lines(["*does not exist; store it with*pytest --add-missing*"])
    assert not (pytester.path / "pictures").exists()
    stored = project("--add-missing")
    stored.assert_outcomes(passed=1)
    stored.stdout.fnmatch_lines([f"stored *{name}; inspect it" for name in KEPT])
    assert [(pytester.path / name).is_file() for name in KEPT] == [True, True]
    again = project("--add-missing")
    again.assert_outcomes(passed=1)
    again.stdout.no_fnmatch_line("*inspect it*")


def test_a_failure_shows_the_test_and_leaves_pictures_of_its_name(project, pytester):
    project("--add-missing")
    got = project(added=10)
    got.assert_outcomes(failed=1)
    got.stdout.no_fnmatch_line("*testing.py*")
    got.stdout.no_fnmatch_line("*snapshots.py*")
    got.stdout.fnmatch_lines([">*same_picture(picture).block == 0", "*difference times 25"])
    failed = pytester.path / "failed_pictures" / "test_flow"
    names = {f"test_disc-a-b-{kind}.png" for kind in ("got", "expected", "difference")}
    assert {path.name for path in failed.iterdir()} == names
    with Image.open(failed / "test_disc-a-b-difference.png") as difference:
        assert np.unique(np.asarray(difference)).tolist() == [250]


def test_limits_and_their_errors_reach_the_comparison(project):
    project("--add-missing")
    project(limits="block=3.0, background='black'").assert_outcomes(passed=1)
    wrong = project(limits="block='a lot'")
    wrong.assert_outcomes(failed=1)
    wrong.stdout.fnmatch_lines(["E *block: expected *", "test_flow.py:*"])
    wrong.stdout.no_fnmatch_line("*_check.py*")
