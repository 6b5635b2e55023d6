"""Scripts that a real ParaView runs, in one process or as ranks of MPI."""

import contextlib
import os
import shutil
import subprocess

import pytest

TOOLS = {name: shutil.which(name) for name in ("pvpython", "pvbatch", "mpiexec", "Xvfb")}
needed = pytest.mark.skipif(
    not all(TOOLS.values()), reason=f"needs ParaView, MPI and X: {', '.join(TOOLS)}"
)


@contextlib.contextmanager
def screen():
    """Start an X server on a display that no other has, and yield its name."""
    told, tell = os.pipe()
    # A server that starts over when its last client leaves refuses the next one meanwhile.
    command = [TOOLS["Xvfb"], "-displayfd", str(tell), "-noreset", "-screen", "0", "640x480x24"]
    with subprocess.Popen(
        command, pass_fds=(tell,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as server:
        os.close(tell)
        try:
            with os.fdopen(told) as number:
                yield f":{number.readline().strip()}"
        finally:
            server.terminate()


def run(folder, script, *arguments, ranks=0, path=None):
    """Run the text of a script in a folder, and return what it prints and complains of.

    Without ranks it can draw; ``path`` is PYTHONPATH.
    """
    (folder / "script.py").write_text(script)
    command = [TOOLS["pvpython"]]
    if ranks:
        command = [TOOLS["mpiexec"], "-n", str(ranks), TOOLS["pvbatch"], "--sym"]
    space = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    # Open MPI refuses to start as root, and more ranks than there are processors.
    space |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    space |= {"OMPI_MCA_rmaps_base_oversubscribe": "1"}
    space |= {} if path is None else {"PYTHONPATH": str(path)}
    with contextlib.nullcontext("") if ranks else screen() as display:
        done = subprocess.run(
            [*command, "script.py", *map(str, arguments)],
            cwd=folder, env=space | {"DISPLAY": display}, capture_output=True, text=True,
            check=False, timeout=500,
        )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout + done.stderr
