"""The doctor reports versions, extras, data and what draws."""

from __future__ import annotations

from importlib.metadata import version

from vizlight import doctor, render
from vizlight.cli import main


def test_findings():
    found = dict(doctor.findings())
    assert found["vtk"] == version("vtk")
    assert found["pytest [test]"] == version("pytest")
    assert found["draws by egl"] == render.probe("egl").detail
    assert found["data"].endswith("rotating_disk.vtu")
    assert len(found) == len(doctor.findings())


def test_a_missing_package_is_reported_with_its_remedy(monkeypatch):
    monkeypatch.setattr(doctor, "PACKAGES", ("no-such-package",))
    monkeypatch.setattr(doctor, "OPTIONAL", (("films", "no-such-camera", "movie"),))
    found = dict(doctor.findings())
    assert found["no-such-package"] == "missing (try: pip install no-such-package)"
    assert found["no-such-camera [movie]"] == (
        "missing; needed for films (try: pip install 'vizlight[movie]')"
    )


def test_the_remedy_is_printed_with_the_name_of_the_extra(monkeypatch, capfd):
    monkeypatch.setattr(doctor, "OPTIONAL", (("films", "no-such-camera", "movie"),))
    main(["doctor"])
    out = capfd.readouterr().out
    assert "no-such-camera [movie]" in out
    assert "pip install 'vizlight[movie]'" in out
