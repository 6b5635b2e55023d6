"""OpenGL libraries that VTK can draw with offscreen: which of them work here."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast, get_args

from vizlight import _cache, _check

Backend = Literal["egl", "osmesa"]

_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
_WINDOWS: dict[str, str] = {"egl": "vtkEGLRenderWindow", "osmesa": "vtkOSOpenGLRenderWindow"}
_INSTALL: dict[str, str] = {
    "egl": "apt-get install -y libegl1 libgl1-mesa-dri",
    "osmesa": "apt-get install -y libosmesa6",
}

#: What decides which libraries and devices there are: variables, and files that change with them.
_VARIABLES = (
    "CUDA_", "DISPLAY", "EGL", "GALLIUM", "GBM", "LD_", "LIBGL", "MESA", "NVIDIA", "VTK", "WAYLAND",
    "__EGL", "__GL",
)  # fmt: skip
_PLACES = (
    "/etc/ld.so.cache", "/dev/dri", "/dev/nvidiactl", "/etc/glvnd/egl_vendor.d",
    "/usr/share/glvnd/egl_vendor.d", "/usr/lib/x86_64-linux-gnu/dri",
    "/usr/lib/aarch64-linux-gnu/dri", "/usr/lib64/dri",
)  # fmt: skip
# VTK ends the process if the library is missing, so the probe runs in a process of its own.
_PROBE = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(8, 8)
window.Render()
lines = [line.partition(":") for line in window.ReportCapabilities().splitlines()]
driver = [value.strip() for name, _, value in lines if name == "OpenGL renderer string"]
assert driver and driver[0], "no OpenGL driver"
print(window.GetClassName(), driver[0], sep="\\t")
"""


class BackendError(RuntimeError):
    """No OpenGL library can draw here; the message says how to install one."""


@dataclass(frozen=True)
class Probe:
    """Result of probing a backend: whether it works, and the driver or the remedy."""

    backend: str
    works: bool
    detail: str


def probe(backend: Backend) -> Probe:
    """Test in a separate process whether a backend can draw.

    Parameters
    ----------
    backend : {"egl", "osmesa"}
        Name of the backend.

    Returns
    -------
    Probe

    Raises
    ------
    ValueError
        If the name is unknown.
    """
    _check.choice("backend", backend, get_args(Backend))
    remedy = f"try: {_INSTALL[backend]}"
    result = _probe_window(backend, _WINDOWS[backend], remedy)
    # VTK may have drawn with another class, which tells nothing of the one that was asked for.
    if result.works and _class_of(result) != _WINDOWS[backend]:
        return Probe(backend, works=False, detail=f"not available ({remedy})")
    return result


def _drew_before(backend: Backend) -> bool:
    """Return whether a backend is known to draw, or does so now; a file keeps the answer."""
    folder = _cache.folder("windows")
    kept = None if folder is None else folder / _setting(backend)
    # A probe starts a Python that loads VTK: what has drawn once is taken to do so again.
    if kept is not None and kept.exists():
        return True
    # What does not draw is tried again each time, as the library may have been installed since.
    works = probe(backend).works
    if works and kept is not None:
        # Without the file it is found out again.
        with contextlib.suppress(OSError):
            kept.touch()
    return works


def _setting(backend: str) -> str:
    """Return a name for all facts on which it depends whether a backend draws."""
    from vtkmodules.vtkCommonCore import vtkVersion

    facts = [
        backend, vtkVersion.GetVTKVersionFull(), _PROBE,
        sys.executable, sys.version, platform.node(),
    ]  # fmt: skip
    facts += [f"{k}={v}" for k, v in sorted(os.environ.items()) if k.startswith(_VARIABLES)]
    for path in _PLACES:
        with contextlib.suppress(OSError):
            status = Path(path).stat()
            facts.append(f"{path} {status.st_mtime_ns} {status.st_size}")
    return hashlib.sha256("\0".join(facts).encode()).hexdigest()[:32]


def _class_of(probed: Probe) -> str:
    """Return the window class that draws: VTK takes another one for a class that cannot."""
    return probed.detail.partition(",")[0]


@functools.cache
def _probe_window(name: str, window: str, remedy: str) -> Probe:
    """Test whether VTK can draw with a window class, once for each."""
    try:
        run = subprocess.run(
            [sys.executable, "-c", _PROBE],
            env={**os.environ, _VARIABLE: window},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Probe(name, works=False, detail="no answer within 60 s")
    if run.returncode == 0:
        return Probe(name, works=True, detail=run.stdout.strip().replace("\t", ", "))
    return Probe(name, works=False, detail=f"not available ({remedy})")


def _named(window: str) -> Backend | None:
    """Return the backend that VTK takes for a window class that the environment names, if another.

    Named itself it draws without VTK's warnings about the class that cannot.
    """
    probed = _probe_window(_VARIABLE, window, f"try: unset {_VARIABLE}")
    if not probed.works:
        raise BackendError(f"no picture: {_VARIABLE}={window} is {probed.detail}")
    taken = _class_of(probed)
    others = (name for name, drawn in _WINDOWS.items() if drawn == taken != window)
    return cast("Backend | None", next(others, None))


def choose_backend(backend: Backend | None = None) -> Backend | None:
    """Return the backend to draw with: the requested one, otherwise EGL, otherwise OSMesa.

    Parameters
    ----------
    backend : {"egl", "osmesa"}, optional
        Requested backend.

    Returns
    -------
    {"egl", "osmesa"} or None
        None leaves the choice to VTK: on a platform other than Linux, or if the environment
        variable ``VTK_DEFAULT_OPENGL_WINDOW`` names a window class that can draw. For one that
        cannot it is the backend that VTK takes in its place.

    Raises
    ------
    BackendError
        If no backend can draw, or the class that the variable names cannot.
    """
    _check.choice("backend", backend, get_args(Backend), optional=True)
    if backend is None and (window := os.environ.get(_VARIABLE)):
        return _named(window)
    if backend is None and not sys.platform.startswith("linux"):
        return None
    candidates: tuple[Backend, ...] = ("egl", "osmesa") if backend is None else (backend,)
    for name in candidates:
        if _drew_before(name):
            return name
    remedy = " or ".join(f"{_INSTALL[name]} ({name.upper()})" for name in candidates)
    raise BackendError(f"no picture: no OpenGL library can draw here; as root: {remedy}")


@contextlib.contextmanager
def window_class(backend: Backend | None) -> Iterator[None]:
    """Make VTK create windows of a backend within this context only."""
    if backend is None:
        yield
        return
    # VTK reads the variable whenever it makes a window.
    before = os.environ.get(_VARIABLE)
    os.environ[_VARIABLE] = _WINDOWS[backend]
    try:
        yield
    finally:
        if before is None:
            del os.environ[_VARIABLE]
        else:
            os.environ[_VARIABLE] = before
