"""Compiled functions: what they need, when they pay, and where they are kept."""

import importlib.util
import subprocess
import sys
import warnings

import numpy as np
import pytest

from vizlight import _compiled

#: A module with two kernels, one of which calls the other.
MODULE = """
from vizlight import _compiled

@_compiled.kernel(inline=True)
def twice(x):
    return FACTOR * x

@_compiled.kernel()
def total(values):
    found = 0.0
    for i in range(values.shape[0]):
        found += twice(values[i])
    return found
"""
#: Loads that module and prints a sum.
RUN = """
import sys; sys.path.insert(0, {folder!r})
import numpy as np, doubled
print(doubled.total(np.arange(4.0)))
"""


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A folder for caches of its own, with compiled code where it pays."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("VIZLIGHT_FAST", raising=False)
    pytest.importorskip("numba")
    return tmp_path


def module(folder, factor="2.0"):
    (folder / "doubled.py").write_text(f"FACTOR = {factor}\n{MODULE}")


def start(folder):
    command = [sys.executable, "-c", RUN.format(folder=str(folder))]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def outcome(process):
    out, _ = process.communicate(timeout=120)
    assert process.returncode == 0
    return float(out)


def loaded(folder):
    """Return a sum by the module, loaded anew, and whether it came from the disk."""
    _compiled._text.cache_clear()
    spec = importlib.util.spec_from_file_location("doubled", folder / "doubled.py")
    made = importlib.util.module_from_spec(spec)
    # numba looks for the module of a function by its name.
    sys.modules["doubled"] = made
    try:
        spec.loader.exec_module(made)
        kept = [*made.total._folder().rglob("*.nbi")] if made.total._folder() else []
        return made.total(np.arange(4.0)), bool(kept)
    finally:
        del sys.modules["doubled"]


@pytest.mark.slow
def test_a_kernel_is_kept_until_it_is_damaged_or_its_source_changes(home, monkeypatch):
    """Also by two processes at once; a cache that cannot be written is none."""
    module(home)
    both = [start(home), start(home)]
    assert [outcome(process) for process in both] == [12, 12]
    assert loaded(home) == (12, True)
    for path in (home / "cache").rglob("*.nb?"):
        path.write_bytes(path.read_bytes()[:-9])
    assert loaded(home) == (12, True)
    module(home, "3.0")
    assert loaded(home) == (18, False)
    (home / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(home / "file"))
    assert loaded(home) == (18, False)


def triple(values):
    return 3 * values[0]


def test_a_kernel_pays_once_it_has_missed_half_of_its_start_up(home):
    """A first call then takes at most twice the time of NumPy."""
    kernel = _compiled.Kernel(triple)
    assert not kernel.pays(0.4 * _compiled.START_UP)
    assert kernel.pays(0.2 * _compiled.START_UP)
    assert kernel(np.array([2.0])) == 6
    assert kernel.pays(0.0)


def test_settings(home, monkeypatch):
    kernel = _compiled.Kernel(triple)
    monkeypatch.setenv("VIZLIGHT_FAST", "1")
    assert kernel.pays(0.0)
    assert _compiled.status().startswith("on (always)")
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    assert not kernel.pays(1e9)
    assert "VIZLIGHT_FAST=0" in _compiled.status()
    monkeypatch.setenv("VIZLIGHT_FAST", "yes")
    with pytest.raises(ValueError, match=r"VIZLIGHT_FAST: expected 0 \(off\), 1 .*, got 'yes'"):
        _compiled.active()


@pytest.mark.parametrize(
    ("found", "words"), [("", "not installed"), ("0.58.1", "0.58.1 is older than 0.59")]
)
def test_a_missing_or_old_numba_is_named(monkeypatch, found, words):
    def version(name):
        if not found:
            raise _compiled.PackageNotFoundError(name)
        return found

    monkeypatch.delenv("VIZLIGHT_FAST", raising=False)
    monkeypatch.setattr(_compiled, "version", version)
    _compiled._missing.cache_clear()
    try:
        assert words in _compiled.why_not()
        assert "vizlight[fast]" in _compiled.why_not()
        assert not _compiled.Kernel(triple).pays(1e9)
        with pytest.raises(RuntimeError, match="triple: expected numba"):
            _compiled.Kernel(triple)(np.array([2.0]))
    finally:
        _compiled._missing.cache_clear()


def test_a_numba_that_refuses_numpy_is_named(home, monkeypatch):
    monkeypatch.setattr(_compiled, "_BROKEN", [])
    monkeypatch.setitem(sys.modules, "numba", None)
    with (
        pytest.warns(RuntimeWarning, match="numba failed with triple: .*NumPy computes the same"),
        pytest.raises(_compiled.FailedError),
    ):
        _compiled.Kernel(triple)(np.array([2.0]))
    assert _compiled.why_not().startswith("numba failed with triple: ModuleNotFoundError")
    assert not _compiled.Kernel(triple).pays(1e9)


def unknown(values):
    return no_such_name(values)  # noqa: F821


@pytest.mark.parametrize("fault", ["type", "llvm", "run"])
def test_a_kernel_that_fails_switches_compiled_code_off(home, monkeypatch, fault):
    """By a function that numba refuses, a compiler that breaks down, and one that fails later."""
    monkeypatch.setattr(_compiled, "_BROKEN", [])
    kernel, other = (_compiled.Kernel(f) for f in (unknown if fault == "type" else triple, triple))

    def broken(*_):
        raise RuntimeError("LLVM ERROR: out of registers\nmore")

    if fault == "run":
        assert kernel(np.array([2.0])) == 6
        monkeypatch.setattr(kernel, "_compiled", broken)
    elif fault == "llvm":
        monkeypatch.setattr(kernel, "_compile", lambda folder: broken)

    def call(values):
        with pytest.raises(
            _compiled.FailedError, match=r"a function that numba compiles|numba, see"
        ):
            kernel(values)

    with pytest.warns(RuntimeWarning, match="slower for many points") as caught:
        call(np.array([2.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        call(np.array([2.0]))
    assert len(caught) == 1
    words = "TypingError" if fault == "type" else "RuntimeError: LLVM ERROR: out of registers"
    assert f"numba failed with {kernel.function.__name__}: {words}" in _compiled.status()
    assert not other.pays(1e9)


def test_the_doctor_tries_it_out(home, monkeypatch):
    from vizlight import doctor

    def broken(*_):
        raise RuntimeError("LLVM ERROR: no such processor")

    monkeypatch.setattr(_compiled, "_BROKEN", [])
    monkeypatch.setattr(
        doctor.render, "probe", lambda backend: doctor.render.Probe(backend, works=True, detail="")
    )
    assert dict(doctor.findings())["compiled code"].startswith("on (where it pays)")
    monkeypatch.setattr(_compiled.Kernel, "_first", broken)
    assert "LLVM ERROR: no such" in dict(doctor.findings())["compiled code"]


def test_a_disk_that_fills_costs_the_cache_alone(home, monkeypatch):
    from numba.core.caching import IndexDataCacheFile

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_compiled, "_BROKEN", [])
    monkeypatch.setattr(IndexDataCacheFile, "save", full)
    kernel = _compiled.Kernel(triple)
    assert kernel(np.array([2.0])) == 6
    assert _compiled.active()
