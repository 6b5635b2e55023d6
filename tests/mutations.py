"""Mutations: break the package at random places, one at a time, and see whether a test fails.

``python tests/mutations.py 80`` draws 80 places, from all folders of the package alike: a
comparison, an operator, a number, a condition, a call whose result nobody takes. It breaks a copy
of the tree at one place after the other and runs the tests that mirror or name the file, then
those around it. It prints a line per mutation and a table per folder; what survives asks for an
assertion, or changes nothing that can be seen. ``--seed`` draws other places, ``--only WORD`` from
files whose
path has the word. A mutation takes some 15 s.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: What runs after the tests of the file and of its folder.
AROUND = [
    "tests/test_laws.py", "tests/shading/test_engine.py", "tests/filters/test_illuminate.py",
    "tests/stability/test_stability.py", "tests/shading/test_terms.py",
]  # fmt: skip
#: What stands in place of an operator; a comparison of numbers loses its boundary, or turns round.
OTHERS = {
    ast.Add: [ast.Sub], ast.Sub: [ast.Add], ast.Mult: [ast.Div], ast.Div: [ast.Mult],
    ast.Pow: [ast.Mult], ast.FloorDiv: [ast.Mult], ast.Mod: [ast.Mult], ast.And: [ast.Or],
    ast.Or: [ast.And], ast.BitAnd: [ast.BitOr], ast.BitOr: [ast.BitAnd], ast.Eq: [ast.NotEq],
    ast.NotEq: [ast.Eq], ast.Is: [ast.IsNot], ast.IsNot: [ast.Is], ast.In: [ast.NotIn],
    ast.NotIn: [ast.In], ast.Lt: [ast.LtE, ast.Gt], ast.LtE: [ast.Lt, ast.GtE],
    ast.Gt: [ast.GtE, ast.Lt], ast.GtE: [ast.Gt, ast.LtE],
}  # fmt: skip


def changes(node: ast.AST):
    """Yield for each mutation of a node the part of it that goes, and the text in its place."""
    if isinstance(node, ast.Compare):
        for new in OTHERS[type(node.ops[0])]:
            other = ast.Compare(node.left, [new(), *node.ops[1:]], node.comparators)
            yield node, f"({ast.unparse(other)})"
    elif isinstance(node, ast.BinOp | ast.BoolOp | ast.AugAssign):
        for new in OTHERS.get(type(node.op), ()):
            other = ast.unparse(type(node)(**{**vars(node), "op": new()}))
            yield node, other if isinstance(node, ast.AugAssign) else f"({other})"
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield node, str(not node.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        yield node, repr(1.5 * node.value if node.value % 1 else node.value + 1)
    elif isinstance(node, ast.If | ast.While | ast.IfExp):
        yield node.test, f"(not ({ast.unparse(node.test)}))"
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield node, "pass"


def places(tree: ast.AST):
    """Yield the nodes of a tree but those of types and texts."""
    for name, value in ast.iter_fields(tree):
        for node in value if isinstance(value, list) else [value]:
            types = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
            types |= name in {"annotation", "returns", "decorator_list"}
            if isinstance(node, ast.AST) and not isinstance(node, ast.JoinedStr) and not types:
                yield node
                yield from places(node)


def drawn(count: int, seed: int, word: str):
    """Return random mutations, from each folder alike: file, node to replace, text."""
    folders: dict[str, list] = {}
    for path in sorted((ROOT / "vizlight").rglob("*.py")):
        inside = path.relative_to(ROOT / "vizlight")
        # ParaView has a Python of its own.
        if word in str(inside) and not {"paraview", "_version.py"} & set(inside.parts):
            nodes = places(ast.parse(path.read_text(encoding="utf-8")))
            folder = folders.setdefault(str(inside.parent).partition("/")[0], [])
            folder += [(inside, *change) for node in nodes for change in changes(node)]
    chance = random.Random(seed)
    for found in folders.values():
        chance.shuffle(found)
    turns = [found[i] for i in range(count) for found in folders.values() if i < len(found)]
    return turns[:count]


def mutated(text: str, node: ast.AST, new: str) -> str:
    """Return a source with a node's text replaced."""
    lines = [line.encode() for line in text.splitlines(keepends=True)]
    start = sum(map(len, lines[: node.lineno - 1])) + node.col_offset
    end = sum(map(len, lines[: node.end_lineno - 1])) + node.end_col_offset
    whole = b"".join(lines)
    return (whole[:start] + new.encode() + whole[end:]).decode()


def tests_of(path: Path) -> list[list[Path]]:
    """Return the tests to try, in turn: those that mirror or name a file, then those around it."""
    folder = ROOT / "tests" / path.parent
    near = sorted(folder.glob("test_*.py"))
    own = [f for f in near if f.stem == f"test_{path.stem.lstrip('_')}"]
    own = own or [f for f in near if path.stem in f.read_text(encoding="utf-8")]
    around = [*(near if path.parent.name else []), *(ROOT / file for file in AROUND)]
    return [own, [file for file in around if file not in own]]


def survives(copy: Path, tests: list[Path]) -> bool:
    """Return whether tests pass on a copy; one that hangs fails."""
    command = [sys.executable, "-m", "pytest", "-qx", "--tb=no", "-m", "not slow"]
    command += [str(file.relative_to(ROOT)) for file in tests]
    env = {**os.environ, "PYTHONPATH": str(copy)}
    run = subprocess.run(command, cwd=copy, env=env, capture_output=True, check=False)
    # 5: all tests of a file are slow.
    return not tests or run.returncode in (0, 5)


def main() -> None:
    """Break, run, print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    table, options = Counter(), parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name)
        unread = shutil.ignore_patterns(".*", "build", "dist")
        shutil.copytree(ROOT, copy, dirs_exist_ok=True, ignore=unread)
        for i, (path, node, new) in enumerate(drawn(options.count, options.seed, options.only)):
            text = (ROOT / "vizlight" / path).read_text(encoding="utf-8")
            lived, file = True, copy / "vizlight" / path
            for source, ahead in ((mutated(text, node, new), 2 * i + 1), (text, 2 * i + 2)):
                file.write_text(source, encoding="utf-8")
                # A stamp of its own, by which Python and numba see that the file has changed.
                os.utime(file, (file.stat().st_atime, file.stat().st_mtime + ahead))
                if source != text:
                    lived = all(survives(copy, tests) for tests in tests_of(path))
            table[path.parts[0], lived] += 1
            line = f"{path}:{node.lineno}: {ast.unparse(node)} -> {new}"
            sys.stdout.write(f"{'SURVIVED' if lived else 'killed  '}  {line}\n")
    for (folder, lived), many in sorted(table.items()):
        sys.stdout.write(f"{folder:12} {'survived' if lived else 'killed'} {many}\n")


if __name__ == "__main__":
    main()
