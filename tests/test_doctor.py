"""The doctor reports versions, extras, data and what draws."""

from importlib.metadata import version

from vizlight import doctor, render
from vizlight.cli import main


def test_findings():
    found = dict(doctor.findings())
    assert found["vtk"] == version("vtk")
    assert found["pytest [test]"] == version("pytest")
    assert found["draws by egl"] == render.probe("egl").detail
    assert found["data"].endswith("rotating_disk.vtu")


def test_a_missing_package_is_reported_with_its_remedy(monkeypatch, capfd):
    monkeypatch.setattr(doctor, "PACKAGES", ("no-such-package",))
    monkeypatch.setattr(doctor, "OPTIONAL", (("films", "no-such-camera", "movie"),))
    found = dict(doctor.findings())
    assert found["no-such-package"] == "missing (try: pip install no-such-package)"
    missing = "missing; needed for films (try: pip install 'vizlight[movie]')"
    assert found["no-such-camera [movie]"] == missing
    assert main(["doctor"]) == (not any(render.probe(name).works for name in ("egl", "osmesa")))
    # Brackets are no markup.
    out = capfd.readouterr().out
    assert "no-such-camera [movie]" in out
    assert missing in out
    for part in ("python", "egl", "osmesa"):
        assert part in out
