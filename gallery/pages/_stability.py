"""Print the table of errors against 50 digits that the tests of the model end with."""

import os
import subprocess
import sys
from pathlib import Path

root = Path(__file__).parents[2]
run = subprocess.run(
    [sys.executable, "-m", "pytest", "-q", "tests/model"],
    cwd=root,
    env={**os.environ, "COLUMNS": "100"},
    capture_output=True,
    text=True,
    check=False,
)
_, _, table = run.stdout.partition("largest errors against 50 digits, in eps")
rows = table.splitlines()[1:]
if run.returncode or not rows:
    sys.exit(run.stdout + run.stderr)
print("\n".join(row for row in rows if row and not row.startswith("=") and "passed" not in row))
