"""Damage small valid files at random and light them: ``python tests/mutate_files.py 2000``.

Each file is cut, or some of its bytes are flipped, repeated, set to zero, or a count in it is
changed. The command line may light what is left of it (exit code 0, a whole file with light) or
refuse it (2, one line). Never does it crash, hang, print a traceback, change its input or leave a
file. A file that is merely cut is lit only if the result is that of the whole file; formats without
counts are exempt, see ``UNCOUNTED``. What failed is kept in ``failed_files/``.
"""

import collections
import re
import shutil
from pathlib import Path

import numpy as np
from hostile import runner, seeds
from hostile.runner import ask

#: Formats that do not say how much they hold: lines of such a file are a whole file.
UNCOUNTED = (".obj", ".inp", ".bdf", ".mdpa", ".swc", ".xyz")
#: Where files that failed are kept.
KEPT = Path("failed_files")
#: Files of one process, and the least number of bytes that matter in a mutation.
BATCH = 200
NUMBERS = (0, 1, -1, 2**31 - 1, 2**31, 2**32 - 1, 10**12)


def cut(data, random):
    """Return the first part of some bytes."""
    return data[: int(random.integers(0, len(data)))]


def flip(data, random):
    """Return bytes with up to eight of them changed."""
    made = bytearray(data)
    for at in random.integers(0, len(data), random.integers(1, 9)):
        made[at] ^= int(random.integers(1, 256))
    return bytes(made)


def repeat(data, random):
    """Return bytes of which a part stands twice."""
    start, stop = np.sort(random.integers(0, len(data) + 1, 2))
    return data[:stop] + data[start:]


def zero(data, random):
    """Return bytes of which a part is zero."""
    start, stop = np.sort(random.integers(0, len(data) + 1, 2))
    return data[:start] + b"\0" * int(stop - start) + data[stop:]


def count(data, random):
    """Return bytes in which one integer is another, of text or of 4 or 8 bytes."""
    words = [found.span() for found in re.finditer(rb"(?<![\w.+-])\d+(?![\w.])", data[:4096])]
    if words and random.random() < 0.7:
        start, stop = words[int(random.integers(len(words)))]
        old = int(data[start:stop])
        new = int(random.choice([old - 1, old + 1, 2 * old, 1000 * old, *NUMBERS]))
        return data[:start] + str(new).encode() + data[stop:]
    size = int(random.choice([4, 8]))
    start = int(random.integers(0, max(min(len(data) - size, 1024), 1)))
    order = "<" if random.random() < 0.7 else ">"
    new = int(random.choice(NUMBERS)) % 2 ** (8 * size)
    return data[:start] + np.array(new, f"{order}u{size}").tobytes() + data[start + size :]


MUTATIONS = (cut, cut, flip, repeat, zero, count)


def lit(path):
    """Return points and light of a result, or the reason why it is none."""
    from vizlight import files

    mesh = files.read(path)
    if "luminance" not in mesh.point_data:
        return "no light"
    found = np.asarray(mesh.point_data["luminance"])
    if not np.isfinite(found).all():
        return "light that is no number"
    return np.asarray(mesh.points), found


def same(one, other):
    """Return whether two results have equal points and equal light."""
    return all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))


def fault(run, path, data, out, mutation, whole):
    """Return what is wrong with a run of the command line, an empty text if nothing is."""
    if (wrong := runner.fault(run, path, data, out)) or run.code:
        return wrong
    found = lit(out)
    if isinstance(found, str):
        return found
    stated = path.suffix not in UNCOUNTED and "may be cut" not in run.err
    if mutation is cut and stated and not same(found, whole):
        return "a cut file was lit as if it were whole"
    return ""


def run(total, seed, folder, say):
    """Light mutated files and return how many were refused, lit, and failed."""
    (folder / "whole").mkdir()
    whole = seeds.write(folder / "whole")
    outs = [folder / f"{path.name}.vtk" for path in whole]
    pairs = zip(whole, outs, strict=True)
    found = runner.run([["light", str(path), "-o", str(out)] for path, out in pairs])
    for path, own in zip(whole, found, strict=True):
        if own.code:
            raise SystemExit(f"{path.name}: {own}")
    results = [lit(out) for out in outs]
    counts = collections.Counter()
    for first in range(0, total, BATCH):
        jobs = []
        for i in range(first, min(first + BATCH, total)):
            random = np.random.default_rng([seed, i])
            source = i % len(whole)
            mutation = MUTATIONS[int(random.integers(len(MUTATIONS)))]
            data = mutation(whole[source].read_bytes(), random)
            place = folder / f"{i}"
            (place / "out").mkdir(parents=True)
            path = place / f"{i}-{mutation.__name__}-{whole[source].name}"
            path.write_bytes(data)
            jobs.append((path, data, place / "out" / "lit.vtk", mutation, source))
        runs = runner.run([["light", str(path), "-o", str(out)] for path, _, out, *_ in jobs])
        for own, (path, data, out, mutation, source) in zip(runs, jobs, strict=True):
            wrong = fault(own, path, data, out, mutation, results[source])
            counts["failed" if wrong else "refused" if own.code else "lit"] += 1
            if wrong:
                say(f"{path.name}: {wrong}")
                KEPT.mkdir(exist_ok=True)
                shutil.copy(path, KEPT)
            shutil.rmtree(path.parent)
    return counts


if __name__ == "__main__":
    ask(run, 200)
