"""The doctor tells versions, data and what draws."""

from __future__ import annotations

from importlib.metadata import version

from vizlight import doctor, render


def test_findings():
    found = dict(doctor.findings())
    assert found["vtk"] == version("vtk")
    assert found["draws by egl"] == render.probe("egl").detail
    assert found["data"].endswith("rotating_disk.vtu")


def test_a_missing_package_is_told_with_its_remedy(monkeypatch):
    monkeypatch.setattr(doctor, "PACKAGES", ("no-such-package",))
    assert dict(doctor.findings())["no-such-package"] == (
        "missing (try: pip install no-such-package)"
    )
